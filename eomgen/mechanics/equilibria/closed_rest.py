"""A place of rest in numbers -> the same in closed form, where the equations hold there exactly.

Tried are round places (quarter turns, zeros, the start), then what the ties and the balance say of the other
coordinates. What is found is taken only where all equations hold at it as functions of the parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.bodies.system_scene import start_value
from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import readable_all, simplest
from eomgen.symbolic.expression.derivative import depends_on, gradient, jacobian, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import Owner, ScalarRow, State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import NoValue, digits_at
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size
from eomgen.symbolic.solve.linear_systems import LinearSystem, Solution, general_solution
from eomgen.symbolic.solve.solving import vanishes

MOST_EXACT = 2  # coordinates of equations that are solved in closed form, those left out that ties give at once
LONGEST = 600  # characters of these equations
PATIENCE = 2  # places without a closed form, before equations are no more tried at others
HALF = Fraction(1, 2)


@dataclass(frozen=True)
class Held:
    """A place at which all equations hold exactly.

    Args:
        state: coordinates, and the multipliers that have a single value.
        particular: values of all multipliers that hold it, those that may be chosen 0.
    """

    state: State
    particular: State


@dataclass(frozen=True)
class ClosedForms:
    """The places of rest of a system in closed form.

    Args:
        statics: the equations.
        values: of the parameters, with 50 digits.
        turning: the coordinates for which a whole turn changes nothing.
    """

    statics: StaticEquations
    values: Mapping[Node, Any]
    turning: frozenset[Node]

    def at(self, located: Located) -> Held | None:
        """Coordinates and multipliers as scalars of the parameters; None where the place has no closed form."""
        simple = self._simple(located)
        if len(simple) == len(self.statics.q) and (held := self._held(simple)) is not None:
            return held
        if len(simple) == len(self.statics.q):
            simple = self._simple(located, starts=False)
        for equations, unknowns, known in self._closed_ways(simple):
            way = (equations, unknowns, tuple(known.values()))
            if self._vain.get(way, 0) >= PATIENCE:
                continue
            try:
                found = {**known, **places_of(substituted(equations, known), unknowns, located)}
            except DerivationError:  # too large, or a value that is not real
                found = {}
            if all(q in found for q in self.statics.q):
                place = {q: _short_turn(found[q], located.value(found[q]), q in self.turning) for q in self.statics.q}
                if (held := self._held(place)) is not None:
                    return held
            self._vain[way] = self._vain.get(way, 0) + 1
        return None

    @cached_property
    def _vain(self) -> dict[tuple[Any, ...], int]:
        """How many places equations had no closed form for."""
        return {}

    def _closed_ways(
        self, simple: Mapping[Node, Scalar]
    ) -> Iterator[tuple[ScalarRow, tuple[Node, ...], Mapping[Node, Scalar]]]:
        """(equations, unknowns, what is known): the ties from coordinates at simple places, or all equations."""
        statics = self.statics
        left = tuple(q for q in statics.q if q not in simple)
        relations = (*statics.phi, *statics.sigma)
        if simple and relations and len(left) <= len(relations):
            yield relations, left, simple
        size = sum(text_size(x) for x in statics.equations)
        if simple and len(left) <= MOST_EXACT and size <= LONGEST:
            yield statics.equations, (*left, *statics.lam), simple
        linear = sum(any(_is_number(d) for d in gradient(x, statics.q)) for x in relations)
        if _entangled(statics) - linear <= MOST_EXACT and size <= LONGEST:
            yield statics.equations, statics.unknowns, {}

    def _simple(self, located: Located, *, starts: bool = True) -> dict[Node, Scalar]:
        """Quarter turns, zeros and start values that coordinates are near to; whether these hold is to be seen."""
        scope, found = self.statics.system.scope, dict[Node, Scalar]()
        turning = {e for four in scope.quaternions for e in four}
        for q in self.statics.q:
            number = located.numbers[q]
            quarters = round(number / (np.pi / 2))
            candidates: list[Scalar] = [0 if quarters == 0 else Fraction(quarters, 2) * q.graph.pi]
            if q in turning:
                candidates = [sign * x for x in _round_components(q.graph) for sign in (1, -1)]
            candidates += [start_value(scope, q)] * starts
            near = [x for x in candidates if abs(located.value(x) - number) <= COMPUTED * (1 + abs(number))]
            if near:
                found[q] = near[0]
        return found

    def _held(self, q: Mapping[Node, Scalar]) -> Held | None:
        """The state with its multipliers where all equations hold there exactly; None where they do not."""
        statics = self.statics
        try:
            relations = substituted((*statics.phi, *statics.sigma), q)
            rows = [substituted(tuple(row[k] for row in statics.J), q) for k in range(len(statics.q))]
            rows += [substituted(row, q) for row in jacobian(statics.beside, statics.lam)]
            alone = substituted(statics.beside, dict.fromkeys(statics.lam, 0))
            right = tuple(-x for x in substituted((*statics.Q, *alone), q))
            if not all(map(_is_nothing, relations)):
                return None
            entries = readable_all([x for row in rows for x in row], Work.VALUE) if rows and statics.lam else ()
            n = len(statics.lam)
            lines = [{j: entries[n * k + j] for j in range(n)} for k in range(len(rows))]
            values = digits_at(self.values)
            solution = general_solution(LinearSystem(lines, readable_all(right, Work.VALUE), n, values))
        except (DerivationError, NoValue, ZeroDivisionError):
            return None
        if not all(map(_is_nothing, solution.left)) or not _satisfied(lines, right, solution):
            return None
        positive = self.statics.system.scope.positive
        lam = {statics.lam[j]: simplest(x, Work.VALUE, positive) for j, x in solution.constants.items()}
        single = {statics.lam[j] for j in solution.constants if solution.determined(j)}
        place = {node: simplest(x, Work.VALUE, positive) for node, x in q.items()}
        return Held(
            {**place, **{node: x for node, x in lam.items() if node in single}},
            {**dict.fromkeys(statics.lam, 0), **lam},
        )


def _satisfied(lines: Sequence[Mapping[int, Scalar]], right: Sequence[Scalar], solution: Solution) -> bool:
    """Whether the rows hold as functions of the parameters, free unknowns 0.

    An entry that vanishes at the model's own parameters alone counts as 0 in the solution: sin(pi*q) at q = 3.
    """
    known = solution.constants
    left = (sum((x * known.get(j, 0) for j, x in line.items()), start=-b) for line, b in zip(lines, right, strict=True))
    return all(map(_is_nothing, left))


def _round_components(graph: Owner) -> tuple[Scalar, ...]:
    """Components of quaternions that turn by 0, 60, 90, 120 or 180 degrees."""
    return (0, 1, HALF, HALF * graph.sqrt(2), HALF * graph.sqrt(3))


def _entangled(statics: StaticEquations) -> int:
    """The most coordinates that equations hold together."""
    groups: list[set[Node]] = []
    for x in statics.equations:
        held = {node for node in statics.unknowns if depends_on(x, (node,))}
        joined = [group for group in groups if group & held]
        groups = [group for group in groups if not group & held] + [held.union(*joined)]
    return max((sum(q in group for q in statics.q) for group in groups), default=0)


def _is_number(x: Scalar) -> bool:
    return type(x) is not Node and x != 0


def _is_nothing(x: Scalar) -> bool:
    return is_zero(x) or vanishes(x)


def _short_turn(x: Scalar, number: float, turning: bool) -> Scalar:
    """An angle of (-pi, pi] where whole turns do not matter."""
    turns = -round(number / (2 * np.pi)) if turning else 0
    return x + turns * 2 * x.graph.pi if turns and type(x) is Node else x
