"""Relations, start -> the one free speed u_s as a function of the coordinates, without time.

The energy is a quadratic function of it,

    A u_s^2 + B u_s + C = 0,   A > 0,   u_s = (sense sqrt(B^2 - 4 A C) - B) / 2 A,   sense = sign(2 A u_s + B).

Where energy is lost, but a_s = F0(q_s) + F2(q_s) u_s^2, y = u_s^2 is the solution of dy/dq_s = 2 F0 + 2 F2 y.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from eomgen.mechanics.bodies.scope import primitive, primitive_over_bends
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.pieces import EVERYWHERE, Extent
from eomgen.mechanics.first_integrals.integrals import energy_integral
from eomgen.mechanics.first_integrals.linear_motion import LinearEquation, MotionConstants, particular
from eomgen.mechanics.first_integrals.speeds_from_momenta import Relations, value_at_start
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.exact.signs import sign_of_terms
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted
from eomgen.symbolic.expression.functions import function, over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero, linear_terms
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.pieces import PIECEWISE
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.solving import vanishes


@dataclass(frozen=True)
class FreeSpeed:
    """What the free speed follows from.

    Args:
        equations: the equations of motion.
        relations: every speed by the free one.
        start: q and u at the start, scalars of the parameters.
        there: a state of the motion in numbers, parameters included, which says in which sense it goes.
        accelerations: a as expressions, where they are known.
        at: coordinates whose values are put in.
    """

    equations: EquationsOfMotion
    relations: Relations
    start: Mapping[Node, Scalar]
    there: Mapping[Node, float]
    accelerations: Sequence[Scalar] | None
    at: Mapping[Node, Scalar]

    def value(self) -> tuple[Scalar, Extent] | None:
        """(u_s as a function of the coordinates that are not in `at`, where that holds); None where nothing gives it.

        By the energy where it stays; else along the path, where it is lost or stored without a potential; else by the
        energy in the piece in which it stays.
        """
        energies = energy_integral(self.equations)
        if not any(energy.held.everywhere for energy in energies):
            square = self._square_by_path()
            if square is not None:
                root = function("sqrt", self._simple(substituted((square,), self.at)[0]))
                return self._sense(self._speed) * root, EVERYWHERE
        for energy in energies:
            difference = energy.expression - value_at_start(energy.expression, self.start, self.equations.symbols)
            return self._root_of_energy(substituted((difference,), self.relations.speeds)[0]), energy.held
        return None

    @property
    def _speed(self) -> Node:
        assert self.relations.speed is not None
        return self.relations.speed

    def _simple(self, x: Scalar) -> Scalar:
        return simplest(x, Work.VALUE, self.equations.system.scope.positive)

    # -- in which sense ---------------------------------------------------------------------------

    def _sense(self, slope: Scalar) -> int:
        """The sign of 2 A u_s + B there; at rest the one that it takes as the motion goes on; 1 where it stays at rest.

        Args:
            slope: 2 A u_s + B as it depends on u_s, or u_s itself.
        """
        (bias,) = substituted((slope,), {self._speed: 0})
        found, own = self._number(slope), self._number(bias)
        if abs(found) <= COMPUTED * (abs(found - own) + abs(own)):
            found = 0.0 if self.accelerations is None else self._number(self._acceleration)
        return -1 if found < 0 else 1

    def _number(self, x: Scalar) -> float:
        """A scalar's value there."""
        return float(evaluate((x,), self.there, FLOAT)[0])

    @property
    def _acceleration(self) -> Scalar:
        """Of the free speed, with the model's own inputs."""
        assert self.accelerations is not None
        inputs = {node: self.equations.inputs[name] for name, node in self.equations.symbols.inputs.items()}
        return substituted((self.accelerations[self.equations.symbols.u.index(self._speed)],), inputs)[0]

    # -- by the energy ----------------------------------------------------------------------------

    def _root_of_energy(self, energy: Scalar) -> Scalar:
        """u_s of A u_s^2 + B u_s + C = 0."""
        s = self._speed
        slope = derivative(energy, s)
        sense = self._sense(slope)
        energy, slope = substituted((energy, slope), self.at)
        C, B = substituted((energy, slope), {s: 0})
        A = over(derivative(slope, s), 2)
        if vanishes(B):
            return 0 if vanishes(C) else sense * function("sqrt", self._simple(over(-C, A)))
        inside = self._simple(B * B - 4 * A * C)
        return self._simple(over(sense * function("sqrt", inside) - B, 2 * A))

    # -- along the path, where energy is lost -----------------------------------------------------

    def _square_by_path(self) -> Scalar | None:
        """y = u_s^2 as a function of q_s, from dy/dq_s = 2 F0 + 2 F2 y."""
        symbols, s = self.equations.symbols, self._speed
        q = next((q for q in symbols.q if q.name + "'" == s.name), None)
        if q is None or self.accelerations is None:
            return None
        (F,) = substituted((self.accelerations[symbols.u.index(s)],), self.relations.speeds)  # of all q: `at` is later
        F = self._in_sense(F)
        if depends_on(F, (symbols.t, *symbols.inputs.values())) or self._has_pieces_of_speed(F):
            return None
        F = simplest(F, Work.VALUE)
        F0, F2 = substituted((F, over(derivative(derivative(F, s), s), 2)), {s: 0})
        others = tuple(x for x in symbols.q if x is not q)
        if depends_on(F0, others) or depends_on(F2, others) or not vanishes(F - F0 - F2 * s * s):
            return None
        solution = _of_first_order(2 * self._simple(F0), 2 * self._simple(F2), q)
        if solution is None:
            return None
        growth, own = solution
        at, first = substituted((own, growth), {q: self.start[q]})
        return own + over(growth, first) * (self.start[s] * self.start[s] - at)

    def _has_pieces_of_speed(self, F: Scalar) -> bool:
        """Whether something in it changes its form with the speed: max(0, -y'), which is no square of it."""
        return any(depends_on(x, (self._speed,)) for x in order((F,)) if x.op in PIECEWISE)

    def _in_sense(self, F: Scalar) -> Scalar:
        """F with sign(k u_s) replaced by what it is in this sense, for every k that has a sign of its own."""
        s, sense = self._speed, self._sense(self._speed)
        known: dict[Node, Scalar] = {}
        for node in order((F,)):
            if node.op != "sign":
                continue
            k = self._simple(derivative(node.args[0], s))
            sign = sign_of_terms(k, self.equations.system.scope.positive)
            if sign and vanishes(node.args[0] - k * s):
                known[node] = sense * sign
        return substituted((F,), known)[0] if known else F


def _of_first_order(f: Scalar, k: Scalar, q: Node) -> tuple[Scalar, Scalar] | None:
    """(g, y): solutions of g' = k g and y' = k y + f; None where they have no closed form."""
    power = 0 if is_zero(k) else primitive(k, q)
    if power is None:
        return None
    growth = exponential_of(power)
    if not is_zero(k) and not depends_on(k, (q,)):
        constants = MotionConstants(q, lambda x: None, lambda x: simplest(x, Work.VALUE))
        second = particular(LinearEquation(0, k, f), constants)  # of Y'' = k Y' + f, y = Y'
        return None if second is None else (growth, derivative(second, q))
    gained = primitive_over_bends(over(f, growth), q)
    return None if gained is None else (growth, growth * gained)


def exponential_of(x: Scalar) -> Scalar:
    """exp(x), with f^c for each term c log(f) of x."""
    product: Scalar = 1
    rest: Scalar = 0
    for atom, c in linear_terms(x).items():
        if atom is not None and atom.op == "log":
            product = product * atom.graph.pow(atom.args[0], c)
        else:
            rest = rest + c * (1 if atom is None else atom)
    return product * function("exp", rest)
