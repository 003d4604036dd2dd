"""System, condition, its place in numbers -> the state at an instant in closed form.

By the laws of motion: the condition is an equation in t. By the integrals: speeds are functions of the coordinates, and
the condition with the ties is a set of equations between coordinates. What is found is taken only where it agrees with
the numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from eomgen.errors import DerivationError
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.integrals import rates_of, relations_of
from eomgen.mechanics.laws import laws_of_motion
from eomgen.mechanics.places import Located, places_of
from eomgen.mechanics.scope import primitive
from eomgen.mechanics.system import System
from eomgen.symbolic.derivative import depends_on, gradient, substituted
from eomgen.symbolic.graph import Node, Scalar, is_zero
from eomgen.symbolic.normal_form import simplest

LIMIT = 50_000  # products of terms for one value

State = dict[Node, Scalar]


@dataclass(frozen=True)
class ClosedInstant:
    """What is asked: the state at which the condition holds.

    Args:
        system, assembly, accelerations: the equations of motion.
        condition: of q, u, t and parameters; it vanishes.
        start: t, q and u at the start, scalars of the parameters.
        located: the state asked, in numbers.
    """

    system: System
    assembly: Assembly
    accelerations: Sequence[Scalar]
    condition: Scalar
    start: Mapping[Node, Scalar]
    located: Located

    def by_laws(self) -> State:
        """t, and q(t), u(t) of every coordinate that has a law; {} where the condition has no root in closed form."""
        t = self.system.symbols.t
        laws = laws_of_motion(self.system, self.accelerations, self.start)
        (equation,) = substituted((self.condition,), laws)
        if depends_on(equation, self._moving):
            return {}
        instant = self.located.root(simplest(equation, LIMIT, self.located.positive), t)
        if instant is None:
            return {}
        state = dict(zip(laws, substituted(tuple(laws.values()), {t: instant}), strict=True))
        return self._agreeing({t: instant, **state})

    def by_integrals(self) -> State:
        """Coordinates by the condition and the ties, speeds by the integrals; those that have a closed form."""
        speeds = self._rates({})
        equations = list(substituted((self.condition,), speeds))
        equations += position_equations(self.system, self.start)
        others = (*self.system.symbols.u, self.system.symbols.t)
        equations = [x for x in equations if not depends_on(x, others)]
        places = self._agreeing(places_of(equations, self.system.symbols.q, self.located))
        rates = self._rates(places)
        return {**places, **self._agreeing(rates)}

    def _rates(self, at: State) -> State:
        """The speeds as functions of the coordinates that are not in `at`."""
        try:
            relations = relations_of(self.system, self.assembly, self.start, at)
            if relations is None:
                return {}
            sense = 1
            if relations.speed is not None and self.located.numbers.get(relations.speed, 1.0) < 0:
                sense = -1
            found = rates_of(self.system, self.assembly, self.start, sense, accelerations=self.accelerations, at=at)
            return dict(zip(found, substituted(tuple(found.values()), at), strict=True)) if found else {}
        except DerivationError:  # a division by 0 at this place
            return {}

    def _agreeing(self, state: State) -> State:
        """Those values that hold parameters only and are the located numbers."""
        found = {}
        for node, x in state.items():
            if not depends_on(x, (*self._moving, self.system.symbols.t)):
                x = simplest(x, LIMIT, self.located.positive)
                if self.located.agrees(x, node):
                    found[node] = x
        return found

    @property
    def _moving(self) -> tuple[Node, ...]:
        return (*self.system.symbols.q, *self.system.symbols.u)


def position_equations(system: System, start: Mapping[Node, Scalar]) -> list[Scalar]:
    """What ties say of positions: gaps, and rates that can be integrated from the start."""
    rows = [row for row in system.ties.rows if not row.identical]
    return [row.gap for row in rows if row.gap is not None] + _integrated_rates(system, start)


def _integrated_rates(system: System, start: Mapping[Node, Scalar]) -> list[Scalar]:
    """q - q0 - sum of A_k (q_k - q_k0) of q' = sum of A_k q_k' with numbers A_k, or one A_k that is a function of q_k.

    Of closing rows J u = 0 without a gap, with a J that does not move, J (q - q0).
    """
    symbols, scope = system.symbols, system.scope
    own = {u: q for q, rate in zip(symbols.q, scope.rates, strict=True) for u in symbols.u if rate is u}
    moving = (*symbols.q, symbols.t)
    found: list[Scalar] = []
    rows = [(q, row) for q, row, bias in zip(symbols.q, scope.N, scope.nu, strict=True) if is_zero(bias)]
    combinations = [(q - start[q], row) for q, row in rows if q not in own.values() and q in start]
    closing = [row for row in system.ties.closing if row.gap is None and not depends_on(row.velocity, moving)]
    combinations += [(0, gradient(row.velocity, symbols.u)) for row in closing]
    for left, row in combinations:
        gained = [_gained(a, own.get(u), start, moving) for a, u in zip(row, symbols.u, strict=True) if not is_zero(a)]
        if gained and all(x is not None for x in gained):
            found.append(left - sum((x for x in gained if x is not None), start=0))
    return found


def _gained(a: Scalar, q: Node | None, start: Mapping[Node, Scalar], moving: Sequence[Node]) -> Scalar | None:
    """The integral of a over q from the start; None where a holds other coordinates, or there is no closed form."""
    if q is None or q not in start or depends_on(a, [x for x in moving if x is not q]):
        return None
    integral = primitive(a, q)
    return None if integral is None else integral - substituted((integral,), {q: start[q]})[0]
