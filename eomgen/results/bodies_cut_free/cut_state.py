"""Model, instant -> CutState: the balance of the bodies, with numbers for every reaction and all that acts.

In motion the accelerations are those of the equations of motion, and the reactions follow from the equations of the
bodies with them; at rest both follow from the balance alone, unknown loads too. A parameter without a value is taken
as 1: places and directions are then drawn for that ratio of lengths, and no value leaves.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide, compiled
from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Balance, NamedReaction
from eomgen.model import AtRest, Model, WrittenEquation
from eomgen.scene import DrawnState, drawn_start
from eomgen.simulation import ReactionColumns
from eomgen.study import MotionFromStart, StateAtInstant, Study, study_at_rest, study_of, study_of_modes
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.numeric import FLOAT, evaluate, numbers_of


@dataclass(frozen=True)
class CutState:
    """The bodies of a model at one instant.

    Args:
        study: of the contacts as they are then.
        drawn: t, q, u, z and the parameters in numbers; those without a value are 1.
        when: the instant in words.
        rests: nothing moves, and the balance alone gives all reactions.
    """

    study: Study
    drawn: DrawnState
    when: str
    rests: bool

    @property
    def system(self) -> System:
        return self.study.system

    @cached_property
    def balance(self) -> Balance:
        """The equations of the bodies.

        Raises:
            DerivationError: something acts at no place.
        """
        return self.study.reactions.balance

    @cached_property
    def begun(self) -> dict[Node, float]:
        """Values of t, q, u and the parameters."""
        symbols = self.system.symbols
        x = dict(zip(symbols.x, map(float, self.drawn.x), strict=True))
        p = dict(zip(symbols.parameters.values(), map(float, self.drawn.p), strict=True))
        return {symbols.t: self.drawn.t, **x, **p}

    @cached_property
    def known(self) -> dict[Node, float]:
        """The same with inputs, accelerations, and the unknowns of loads."""
        symbols, values = self.system.symbols, dict(self.begun)
        inputs = {node: self.system.inputs[name] for name, node in symbols.inputs.items()}
        values |= _numbers(inputs, values)
        if not self.rests:
            return values | dict(zip(symbols.a, self._accelerations, strict=True))
        reactions = self.study.reactions
        values |= dict.fromkeys((*symbols.u, *symbols.a), 0.0)
        values |= _numbers({x: y for x, y in reactions.at.items() if x not in symbols.parameters.values()}, values)
        return values | _numbers(reactions.unknowns, values)

    @property
    def begun_with_unknowns(self) -> dict[Node, float]:
        """Values of t, q, u, the parameters and the unknowns of loads."""
        return {**self.begun, **{x: self.known[x] for x in self.system.symbols.unknowns.values() if x in self.known}}

    @cached_property
    def components(self) -> tuple[float | None, ...]:
        """Every component of the reactions; None of one that has no single value."""
        reactions = self.study.reactions
        count, solution = len(reactions.components), reactions.solution
        single = [solution.determined(j) for j in range(count)]
        if self.rests:
            found = _numbers({j: solution.constants[j] for j in range(count) if single[j]}, self.known)
            return tuple(found.get(j) for j in range(count))
        given = tuple(NamedReaction(c.name, c.owner, c.unit, {j: 1}) for j, c in enumerate(reactions.components))
        columns = ReactionColumns(reactions, self._right_hand_side, given)
        t, x, p = np.array([self.drawn.t]), self.drawn.x[None, :], self.drawn.p
        values = columns.along(t, x, p)[0] if given else np.zeros(0)
        return tuple(float(v) if one and np.isfinite(v) else None for v, one in zip(values, single, strict=True))

    def numbers(self, scalars: Sequence[Scalar]) -> list[float]:
        """Values of scalars there."""
        return numbers_of(scalars, self.known)

    @cached_property
    def _right_hand_side(self) -> RightHandSide:
        return compiled(self.study.program, "numpy")

    @property
    def _accelerations(self) -> Iterable[float]:
        symbols = self.system.symbols
        if not symbols.u:
            return ()
        rates = self._right_hand_side(self.drawn.t, self.drawn.x, self.drawn.p)
        return [float(x) for x in rates[len(symbols.q) :][: len(symbols.u)]]


def _numbers(scalars: Mapping[Any, Scalar], known: Mapping[Node, float]) -> dict[Any, float]:
    return dict(zip(scalars, map(float, evaluate(tuple(scalars.values()), known, FLOAT)), strict=True))


def cut_state(model: Model, at: WrittenEquation | AtRest | None = None) -> CutState:
    """The bodies of a model at its start, where an equation is first met, or in equilibrium.

    Raises:
        MissingValues: an instant of a model whose parameters have no values.
        DerivationError, RunFailed: there is no such instant.
    """
    if model.unknowns_in_loads():
        study = study_of_modes(model)
        return CutState(study, drawn_start(study.system), "at rest", True)
    if at is None:
        return _at_start(model)
    if isinstance(at, AtRest):
        moment, when = StateAtInstant.resting(study_at_rest(model)), "in equilibrium"
    else:
        moment, when = MotionFromStart(model, at_rest=False).until(at), f"when {at.text}"
    system, missing = moment.phase.system, [name for name in model.parameters if name not in model.exact_parameters()]
    if missing or not moment.numbers:
        raise MissingValues(tuple(missing) or ("the parameters",))
    x = [float(moment.numbers[node]) for node in system.symbols.x]
    values = model.exact_parameters()
    p = np.array([float(values[name]) for name in system.symbols.parameters])
    return CutState(moment.phase, DrawnState(float(moment.numbers[system.symbols.t]), np.array(x), p), when, False)


def _at_start(model: Model) -> CutState:
    missing = any(name not in model.exact_parameters() for name in model.parameters)
    study = study_of(model) if missing or not model.has_phases else MotionFromStart(model, at_rest=False).phase
    driven = any(part.driven for part in model.coordinates.values()) or bool(model.driving_constraints)
    rests = not study.system.symbols.u and not driven
    if not rests and not driven:
        rests = _stands(study.system)
    return CutState(study, drawn_start(study.system), "at rest" if rests else "at the start", rests)


def _stands(system: System) -> bool:
    """True if the constraints leave no degree of freedom."""
    try:
        return not system.has_degrees_of_freedom
    except (DerivationError, MissingValues):
        return False
