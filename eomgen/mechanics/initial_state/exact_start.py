"""System -> ExactStart: the one start that every verb takes, in closed form where it has one, in numbers else.

Where the ties move nothing the start is what the file says. Coordinates that they place, or move, are roots of the
gaps; speeds that they complete or change follow from the same least change as in `start_of_motion`, by exact equations:

    J d + (J u + sigma) = 0,   W d = J^T y      W: how far each speed moves the gaps, or M

What does not agree with the numbers of `start_of_motion` is no closed form: these serve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.bodies.system_scene import start_values, with_unit_quaternions
from eomgen.mechanics.bodies.tree import branches_of
from eomgen.mechanics.constraints.assembly import SEEDS, fixed_by_position
from eomgen.mechanics.constraints.closure import of_50_digits
from eomgen.mechanics.constraints.consistency import is_guess
from eomgen.mechanics.constraints.ties import hold_identically
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.initial_state.initial_state import (
    Start,
    following_rates,
    start_of_motion,
    start_speeds,
)
from eomgen.mechanics.initial_state.values_at_rest import speeds_near
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, jacobian, substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, RANK
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.linear_systems import LinearSystem, unique_solution

MOST_UNKNOWNS = 8  # speeds and multipliers of speeds that are sought in closed form


@dataclass(frozen=True)
class ExactStart:
    """Where a motion begins; what is not asked is not sought.

    Args:
        system: of which.
        at_rest: all speeds are 0, whatever the model says.
    """

    system: System
    at_rest: bool = False

    @cached_property
    def begun(self) -> Start:
        """q and u in numbers, and what was changed so that the ties hold; parameters without a value are drawn.

        Raises:
            UsageError, DerivationError: as of `start_of_motion`.
        """
        return self._sought[0].begun

    @property
    def is_drawn(self) -> bool:
        """Whether a parameter has no value."""
        return bool(self._sought[0].drawn)

    @cached_property
    def moved(self) -> frozenset[str]:
        """The coordinates and speeds that do not start as they are written, those that the ties place left out."""
        return frozenset(change.name for change in self.begun.changes)

    @cached_property
    def numbers(self) -> dict[Node, float]:
        """t, q and u as numbers; {} where a parameter has no value."""
        if self.is_drawn:
            return {}
        symbols, values = self.system.symbols, self.begun.values
        return {symbols.t: 0.0} | {x: values[x.name] for x in (*symbols.q, *symbols.u)}

    @cached_property
    def exact(self) -> dict[Node, Scalar]:
        """t, q and u as scalars of the parameters, those that have a closed form."""
        sought, *others = self._sought
        if not self.is_drawn:
            return sought.exact
        try:
            found = {x: y for x, y in sought.exact.items() if all(each.located.agrees(y, x) for each in others)}
            return found | self._beside_what_is_drawn(found)
        except DerivationError:  # lengths drawn at random need not close: nothing is known of the start
            return {}

    def _beside_what_is_drawn(self, found: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """Speeds that do not hang on the parameters without a value, next to their numbers; {} where one does."""
        symbols, (first, second) = self.system.symbols, (each.begun.values for each in self._sought)
        open_ = [u for u in symbols.u if u not in found]
        steady = all(abs(first[u.name] - second[u.name]) <= COMPUTED * (1 + abs(first[u.name])) for u in open_)
        if not open_ or not steady or any(q not in found for q in symbols.q):
            return {}
        places = {x: y for x, y in found.items() if x not in symbols.u}
        return dict(speeds_near(self.system, places, {u: first[u.name] for u in symbols.u}))

    @property
    def is_exact(self) -> bool:
        """Whether everything has a closed form."""
        return all(x in self.exact for x in (*self.system.symbols.q, *self.system.symbols.u))

    @cached_property
    def values(self) -> dict[Node, Scalar]:
        """t, q and u as scalars, a number where there is no closed form; {} where one has neither."""
        if self.is_exact:
            return self.exact
        return {x: Fraction(f"{number:.14e}") for x, number in self.numbers.items()} | (
            self.exact if self.numbers else {}
        )

    @cached_property
    def _sought(self) -> tuple[_Sought, ...]:
        return tuple(_Sought(self.system, self.at_rest, _drawn(self.system, seed)) for seed in SEEDS)


def known_start(system: System) -> dict[Node, Scalar] | None:
    """t, q and u at the start, a number where there is no closed form; None where it is not known."""
    try:
        return ExactStart(system).values or None
    except DerivationError:  # the ties do not close there: whoever needs a state says so
        return None


def declared_start(system: System, *, at_rest: bool = False) -> dict[Node, Scalar]:
    """The start as it is written, as scalars of the parameters: t, coordinates that no ties place, and speeds.

    Args:
        at_rest: all speeds are 0, whatever the model says.
    """
    scope, sought = system.scope, set(fixed_by_position(system.ties))
    given = {scope.symbols.t: 0} | start_values(scope, (q for q in scope.symbols.q if q not in sought))
    start = with_unit_quaternions(scope, given)
    speeds = dict.fromkeys(scope.symbols.u, 0) if at_rest else start_speeds(system)
    return start | dict(zip(scope.symbols.u, substituted(tuple(speeds.values()), start), strict=True))


def _without_zeros(row: ScalarRow) -> ScalarRow:
    """The row, 0 for what is so in another form: a column of these alone changes nothing."""
    return tuple(0 if zero else x for x, zero in zip(row, hold_identically(row), strict=True))


def _drawn(system: System, seed: int) -> dict[str, float]:
    """Values of the parameters that have none."""
    rng, known = Random(seed), exact_parameters(system.scope.model)
    return {name: rng.uniform(0.7, 1.3) for name in system.symbols.parameters if name not in known}


@dataclass(frozen=True)
class _Sought:
    """The start at some values of the parameters; the arguments are those of `exact_start`.

    Args:
        drawn: of the parameters that have none.
    """

    system: System
    at_rest: bool
    drawn: Mapping[str, float]

    @cached_property
    def begun(self) -> Start:
        given = {u.name: 0.0 for u in self.system.symbols.u} if self.at_rest else {}
        return start_of_motion(self.system, self.drawn, given)

    @cached_property
    def declared(self) -> dict[Node, Scalar]:
        return declared_start(self.system, at_rest=self.at_rest)

    @cached_property
    def located(self) -> Located:
        """The numbers, by which closed forms are recognised."""
        symbols, known = self.system.symbols, exact_parameters(self.system.scope.model, self.drawn)
        numbers = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
        numbers |= {x: self.begun.values[x.name] for x in (*symbols.q, *symbols.u)} | {symbols.t: 0.0}
        return Located(numbers, self.system.scope.positive)

    @cached_property
    def exact(self) -> dict[Node, Scalar]:
        """What has a closed form."""
        symbols, moved = self.system.symbols, {change.name for change in self.begun.changes}
        moved |= {u.name for u in following_rates(self.system)}
        known = {x: value for x, value in self.declared.items() if x.name not in moved}
        places = [q for q in symbols.q if q not in known]
        known |= self._places(known, places) if places else {}
        open_ = [q for q in symbols.q if q not in known]
        known = {x: value for x, value in known.items() if not depends_on(value, open_)}
        known = dict(zip(known, substituted(tuple(known.values()), known), strict=True))
        speeds = [u for u in symbols.u if u.name in moved]
        known |= self._speeds(known, speeds) if speeds and not open_ else {}
        return {x: value for x, value in known.items() if x is symbols.t or self.located.agrees(value, x)}

    def _places(self, known: Mapping[Node, Scalar], unknown: Sequence[Node]) -> dict[Node, Scalar]:
        """The coordinates that the ties place, or move; none where these are fewer than all coordinates."""
        gaps = [row.gap for row in self.system.ties.rows if row.gap is not None and not row.identical]
        if not gaps or len(gaps) < len(unknown) == len(self.system.symbols.q):
            return {}  # nothing to begin with
        equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
        return places_of(equations, unknown, self.located)

    def _speeds(self, known: Mapping[Node, Scalar], moved: Sequence[Node]) -> dict[Node, Scalar]:
        """The speeds that the ties complete or change; those of which the least change has no closed form are left."""
        u, place = self.system.symbols.u, {**known, self.system.symbols.t: 0}
        written = {x: self.declared[x] for x in moved}
        closing = self.system.ties.closing
        left = substituted(substituted(tuple(row.velocity for row in closing), {**known, **written}), place)
        rows = jacobian(tuple(row.velocity for row in closing), u)
        J = [_without_zeros(substituted(row, place)) for row in rows]
        for along, W in self._ways(J, place, moved):
            found = self._least([[row[u.index(x)] for x in along] for row in J], left, W)
            values = {x: written.get(x, known.get(x, 0)) + d for x, d in zip(along, found, strict=False)}
            values = {x: simplest(y, Work.VALUE, self.system.scope.positive) for x, y in values.items() if x in moved}
            if values.keys() >= {*moved} and all(self.located.agrees(y, x) for x, y in values.items()):
                return values
        return {}

    def _ways(
        self, J: Sequence[Sequence[Scalar]], place: Mapping[Node, Scalar], moved: Sequence[Node]
    ) -> list[tuple[list[Node], list[list[Scalar]]]]:
        """(the speeds that change, W): the ties alone say what they are, then the least change by either measure."""
        u, model = self.system.symbols.u, self.system.scope.model
        silent = [x for x in u if is_guess(model, x.name) and not self.at_rest]
        ways: list[tuple[list[Node], list[list[Scalar]]]] = [(list(moved), [])]
        if {*moved} <= {*silent}:
            columns = [[row[u.index(x)] for row in J] for x in silent]
            along = [(x, column) for x, column in zip(silent, columns, strict=True) if not all(map(is_zero, column))]
            squares = [sum((e * e for e in column), start=0) for _, column in along]
            W = [[squares[i] if i == j else 0 for j in range(len(along))] for i in range(len(along))]
            ways.append(([x for x, _ in along], W))
        elif not {*moved} & {*silent}:
            given = [x for x in u if x not in silent]
            mass = recursive.mass(self.system.motion, branches_of(self.system.motion))
            M = [[mass[u.index(x)][u.index(y)] for y in given] for x in given]
            ways.append((given, [list(substituted(row, place)) for row in M]))
        return ways

    def _least(
        self, J: Sequence[Sequence[Scalar]], left: Sequence[Scalar], W: Sequence[Sequence[Scalar]]
    ) -> tuple[Scalar, ...]:
        """d with J d + left = 0 and W d = J^T y; without W of what the rows fix alone; () where there is none."""
        kept = self._independent(J)
        n, k = len(J[0]) if J else 0, len(kept)
        if not kept or n + k > MOST_UNKNOWNS or (not W and n != k):
            return ()
        rows = [{j: e for j, e in enumerate(J[i]) if not is_zero(e)} for i in kept]
        right = [-left[i] for i in kept]
        for i, line in enumerate(W):
            forces = {n + m: -J[r][i] for m, r in enumerate(kept) if not is_zero(J[r][i])}
            rows.append({j: e for j, e in enumerate(line) if not is_zero(e)} | forces)
            right.append(0)
        try:
            return unique_solution(LinearSystem(rows, right, n + (k if W else 0), self._digits))[:n]
        except DerivationError:
            return ()

    def _digits(self, scalars: Sequence[Scalar]) -> Any:
        """Scalars of the parameters with 50 digits."""
        return evaluate(scalars, {x: of_50_digits(value) for x, value in self.located.numbers.items()}, fifty_digits())

    def _independent(self, J: Sequence[Sequence[Scalar]]) -> list[int]:
        """The rows that say something of these speeds, each beside those before it."""
        flat = [e for row in J for e in row]
        if not flat or not set(symbols_of(flat)) <= self.located.numbers.keys():
            return []
        try:
            values = np.array(evaluate(flat, self.located.numbers, FLOAT), dtype=float).reshape(len(J), -1)
        except (NoValue, ZeroDivisionError):
            return []
        kept: list[int] = []
        size = float(np.max(np.abs(values), initial=0.0))
        for i in range(len(J)):
            if size and np.linalg.matrix_rank(values[[*kept, i]], tol=RANK * size) > len(kept):
                kept.append(i)
        return kept
