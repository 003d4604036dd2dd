"""System at the start, with unknowns in its loads -> the unknowns that hold it there, by virtual work.

Q_k + (J^T lam)_k = 0        linear in the unknowns and the multipliers
"""

from __future__ import annotations

from collections.abc import Mapping
from random import Random

from eomgen.errors import DerivationError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equilibria.static_equations import StaticEquations, static_equations
from eomgen.mechanics.initial_state.values_at_rest import values_of_parameters, values_where_at_rest
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import readable_all, simplest
from eomgen.symbolic.expression.derivative import depends_on, jacobian, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import digits_at
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.linear_systems import LinearSystem, Solution, general_solution
from eomgen.symbolic.solve.solving import vanishes


@dataclass(frozen=True)
class Holding:
    """What holds a system where it starts.

    Args:
        statics: the equations of rest.
        place: every coordinate at the start, exact.
        unknowns: the value of each unknown of the loads.
        lam: the multipliers of closing ties that have a single value.
    """

    statics: StaticEquations
    place: Mapping[Node, Scalar]
    unknowns: Mapping[Node, Scalar]
    lam: Mapping[Node, Scalar]


def holding_of(system: System) -> Holding:
    """The unknowns of the loads for which the system is at rest where it starts.

    Raises:
        DerivationError: no unknown of the loads does work; they are not determined, or cannot hold it; the start has no
            closed form.
    """
    statics = static_equations(system)
    if not statics.loaded:
        raise DerivationError(
            "no unknown load does work when the system moves: none can hold it",
            mend="write one of [unknowns] into a force on what moves",
        )
    state = values_where_at_rest(statics.system)
    place = {q: state[q] for q in statics.system.symbols.q}
    solution = _solved(statics, place)
    _refuse_undetermined(statics, solution)
    positive = statics.system.scope.positive
    found = {
        node: simplest(solution.constants[j], Work.VALUE, positive)
        for j, node in enumerate((*statics.loaded, *statics.lam))
        if solution.determined(j)
    }
    return Holding(
        statics, place, {p: found[p] for p in statics.loaded}, {lam: found[lam] for lam in statics.lam if lam in found}
    )


def _solved(statics: StaticEquations, place: Mapping[Node, Scalar]) -> Solution:
    """The balance along every coordinate, for the unknowns and the multipliers."""
    sought = (*statics.loaded, *statics.lam)
    slopes = jacobian(statics.forces, sought)
    for row in slopes:
        for p, slope in zip(sought, row, strict=True):
            if depends_on(slope, statics.loaded):
                raise DerivationError(
                    f"the balance is not linear in the unknown '{p.name}'",
                    f"unknowns.{p.name}",
                    "let it stand alone, times what is known",
                )
    right = [-x for x in substituted(substituted(statics.forces, dict.fromkeys(sought, 0)), place)]
    flat = iter(readable_all(substituted([x for row in slopes for x in row], place), Work.VALUE))
    rows = [{j: next(flat) for j in range(len(sought))} for _ in slopes]
    readable_right = readable_all(right, Work.VALUE)
    own, shaken = (
        general_solution(LinearSystem(rows, readable_right, len(sought), digits_at(values)))
        for values in (values_of_parameters(statics.system.scope, Random(3), shaken=each) for each in (False, True))
    )
    return shaken if len(shaken.free) == len(own.free) else own  # m1 - m2 is 0 at m1 = m2 alone


def _refuse_undetermined(statics: StaticEquations, solution: Solution) -> None:
    open_ = [p.name for j, p in enumerate(statics.loaded) if not solution.determined(j)]
    if open_:
        raise DerivationError(
            f"rest does not determine '{open_[0]}': there are more unknowns than freedoms",
            f"unknowns.{open_[0]}",
            "give a value to some of them",
        )
    if not all(is_zero(x) or vanishes(x) for x in solution.left):
        names = ", ".join(f"'{p.name}'" for p in statics.loaded)
        freedoms = ", ".join(u.name.removesuffix("'") for u in statics.system.symbols.u)
        raise DerivationError(
            f"{names} alone cannot hold the system where it starts: something moves on",
            mend=f"the freedoms are {freedoms}; let an unknown act on each",
        )
