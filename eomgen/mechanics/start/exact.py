"""System -> ExactStart: the start of a motion for every verb, in closed form where it has one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, partial
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Assembly, hold_identically
from eomgen.mechanics.dynamics import System, mass
from eomgen.mechanics.kinematics import Located, Scope
from eomgen.mechanics.start.state import Start, following_rates
from eomgen.mechanics.state import Doubles, Numbers, Split
from eomgen.symbolic.exact import LinearSystem, simplest
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    State,
    depends_on,
    is_zero,
    jacobian,
    substituted,
    symbols_of,
    tangent,
)
from eomgen.symbolic.numeric import NoValue, Work, evaluate, fifty_digits, number_of, numbers_of, tolerances

# -------- exact start -----------------------------------------------------------------------------------------
# System -> ExactStart: the one start that every verb takes, in closed form where it has one, in numbers else.
#
# Where the constraints move nothing the start is what the file says. Coordinates that they place, or move, are roots of
# the gaps; speeds that they complete or change follow from the same least change as in `Start.of`, by exact
# equations:
#
#     J d + (J u + sigma) = 0,   W d = J^T y      W: how far each speed moves the gaps, or M
#
# What does not agree with the numbers of `Start.of` is no closed form: these serve.


MOST_UNKNOWNS = 8  # speeds and multipliers of speeds that are sought in closed form


@dataclass(frozen=True)
class ExactStart:
    """Start of a motion; each result is computed at its first use.

    Args:
        system: the system that moves.
        at_rest: True if all speeds are 0, whatever the model says.
    """

    system: System
    at_rest: bool = False

    @property
    def begun(self) -> Start:
        """q and u in numbers, with the changes that satisfy the constraints; parameters without a value are drawn.

        Raises:
            UsageError, DerivationError: as of `Start.of`.
        """
        return self._sought[0].begun

    @property
    def is_drawn(self) -> bool:
        """True if a parameter has no value and is drawn at random."""
        return bool(self._sought[0].drawn)

    @property
    def moved(self) -> frozenset[str]:
        """The coordinates and speeds that do not start as they are written, those that the constraints place left
        out."""
        return frozenset(change.name for change in self.begun.changes)

    @property
    def numbers(self) -> dict[Node, float]:
        """t, q and u as numbers; {} where a parameter has no value."""
        if self.is_drawn:
            return {}
        symbols, values = self.system.symbols, self.begun.values
        return {symbols.t: 0.0} | {x: values[x.name] for x in symbols.x}

    @cached_property
    def exact(self) -> dict[Node, Scalar]:
        """t, q and u as scalars of the parameters, those that have a closed form."""
        sought, *others = self._sought
        if not self.is_drawn:
            return sought.exact
        try:
            located = [each.located for each in others]
            found = {x: y for x, y in sought.exact.items() if all(each.agrees(y, x) for each in located)}
            return found | self._beside_what_is_drawn(found)
        except DerivationError:  # lengths drawn at random need not close: nothing is known of the start
            return {}

    def _beside_what_is_drawn(self, found: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """Speeds that do not depend on parameters without a value, next to their numbers; {} where one does."""
        symbols, (first, second) = self.system.symbols, (each.begun.values for each in self._sought)
        open_ = [u for u in symbols.u if u not in found]
        steady = all(
            abs(first[u.name] - second[u.name]) <= tolerances.COMPUTED * (1 + abs(first[u.name])) for u in open_
        )
        if not open_ or not steady or any(q not in found for q in symbols.q):
            return {}
        places = {x: y for x, y in found.items() if x not in symbols.u}
        return dict(speeds_near(self.system, places, {u: first[u.name] for u in symbols.u}))

    @property
    def is_exact(self) -> bool:
        """True if all coordinates and speeds have a closed form."""
        return all(x in self.exact for x in self.system.symbols.x)

    @property
    def values(self) -> dict[Node, Scalar]:
        """t, q and u as scalars, a number where there is no closed form; {} where one has neither."""
        if self.is_exact:
            return self.exact
        return {x: Fraction(f"{number:.14e}") for x, number in self.numbers.items()} | (
            self.exact if self.numbers else {}
        )

    @cached_property
    def _sought(self) -> tuple[_Sought, ...]:
        return tuple(_Sought(self.system, self.at_rest, _drawn(self.system, seed)) for seed in Assembly.SEEDS)

    @property
    def known(self) -> dict[Node, Scalar] | None:
        """t, q and u at the start, a number where there is no closed form; None where it is not known."""
        try:
            return self.values or None
        except DerivationError:  # the constraints do not close there: whoever needs a state says so
            return None

    @staticmethod
    def values_at_rest(system: System, places: Mapping[Node, Scalar] | None = None) -> State:
        """Values of t, q, u, a at rest at the start: exact scalars of the parameters.

        Args:
            places: coordinates that are elsewhere than at the start.
        Raises:
            DerivationError: the constraints do not close at the start, or not in closed form.
        """
        symbols, scope = system.symbols, system.scope
        sought = system.constraints.fixed_by_position
        given = scope.with_unit_quaternions(scope.start_values(q for q in symbols.q if q not in sought))
        state = system.standing({**given, **scope.start_values(symbols.z), **(places or {})})
        left = [q for q in sought if q not in state]
        return state | (_closed_in(system, state, left) if left else {})

    @staticmethod
    def derivatives(system: System, numbers: Mapping[Node, Any], seeds: Seeds, own: str = "") -> dict[Node, Fraction]:
        """Derivatives of what starts (q, u, z) with respect to parameters, or to the start of one of them.

        Args:
            numbers: t, parameters, inputs, q and u at the start, with 50 digits.
            seeds: the changes of parameters and inputs.
            own: the coordinate, speed or state whose start is changed; "" of none.
        Raises:
            DerivationError: the constraints do not determine them.
        """
        scope, symbols = system.scope, system.symbols

        def at(scalars: Sequence[Scalar], along: Seeds) -> list[float]:
            return Numbers(numbers).of(tangent(tuple(scalars), along))

        begun = scope.with_unit_quaternions(scope.start_values())
        dq = dict(zip(symbols.q, map(Fraction, at([begun[q] for q in symbols.q], seeds)), strict=True))
        dq |= {q: Fraction(1) for q in symbols.q if q.name == own}
        rows = [row for row in system.constraints.rows if row.gap is not None and not row.identical]
        gaps = [row.gap for row in rows if row.gap is not None]
        sought = system.constraints.fixed_by_position
        given = {q for q in symbols.q if scope.model.coordinates[q.name].driven}
        silent = [q for q in symbols.q if q in sought or (q.name != own and scope.model.is_guess(q.name))]
        silent = [q for q in silent if q not in given]
        what = own or "the parameter"
        dq = _kept(gaps, at(gaps, {**seeds, **dq}), silent, dq, numbers, what, _moved(begun, symbols.q, numbers))
        speeds = Start.speeds_of(system)
        du = dict(zip(symbols.u, map(Fraction, at([speeds[u] for u in symbols.u], {**seeds, **dq})), strict=True))
        du |= {u: Fraction(1) for u in symbols.u if u.name == own}
        rates = [row.velocity for row in system.constraints.closing]
        silent = [u for u in symbols.u if u.name != own and scope.model.is_guess(u.name)]
        left = at(rates, {**seeds, **dq, **du})
        du = _kept(rates, left, silent, du, numbers, what, _moved(speeds, symbols.u, numbers))
        states = scope.start_values(symbols.z)
        dz = dict(zip(symbols.z, map(Fraction, at([states[z] for z in symbols.z], seeds)), strict=True))
        return dq | du | dz | {z: Fraction(1) for z in symbols.z if z.name == own}


def declared_start(system: System, *, at_rest: bool = False) -> dict[Node, Scalar]:
    """The start as it is written, as scalars of the parameters: t, coordinates that no constraints place, and speeds.

    Args:
        at_rest: all speeds are 0, whatever the model says.
    """
    scope, sought = system.scope, set(system.constraints.fixed_by_position)
    given = {scope.symbols.t: 0} | scope.start_values(q for q in scope.symbols.q if q not in sought)
    start = scope.with_unit_quaternions(given)
    speeds = dict.fromkeys(scope.symbols.u, 0) if at_rest else Start.speeds_of(system)
    start |= scope.start_values(scope.symbols.z)
    return start | dict(zip(scope.symbols.u, substituted(tuple(speeds.values()), start), strict=True))


def _without_zeros(row: ScalarRow) -> ScalarRow:
    """The row with 0 for entries that are 0 in another form: a column of these alone changes nothing."""
    return tuple(0 if zero else x for x, zero in zip(row, hold_identically(row), strict=True))


def _drawn(system: System, seed: int) -> dict[str, float]:
    """Values of the parameters that have none."""
    rng, known = Random(seed), system.scope.model.exact_parameters()
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
        return Start.of(self.system, self.drawn, given)

    @property
    def declared(self) -> dict[Node, Scalar]:
        return declared_start(self.system, at_rest=self.at_rest)

    @property
    def located(self) -> Located:
        """The numbers, by which closed forms are recognised."""
        symbols, known = self.system.symbols, self.system.scope.model.exact_parameters(self.drawn)
        numbers = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
        numbers |= {x: self.begun.values[x.name] for x in symbols.x} | {symbols.t: 0.0}
        return Located(numbers, self.system.scope.positive)

    @cached_property
    def exact(self) -> dict[Node, Scalar]:
        """Closed forms of t, coordinates and speeds, of those that have one."""
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
        located = self.located
        agreeing = {x: value for x, value in known.items() if x is symbols.t or located.agrees(value, x)}
        return {x: value for x, value in agreeing.items() if self._is_defined(value)}

    def _is_defined(self, form: Scalar) -> bool:
        """False if a form has no value at the exact values of the parameters: tan(alpha) at pi/2 has one in doubles."""
        try:
            substituted((form,), self.system.scope.known_exactly)
        except DerivationError:
            return False
        return True

    def _places(self, known: Mapping[Node, Scalar], unknown: Sequence[Node]) -> dict[Node, Scalar]:
        """The coordinates that the constraints place, or move; none where these are fewer than all coordinates."""
        gaps = [row.gap for row in self.system.constraints.rows if row.gap is not None and not row.identical]
        if not gaps or len(gaps) < len(unknown) == len(self.system.symbols.q):
            return {}  # nothing to begin with
        equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
        return self.located.places(equations, unknown)

    def _speeds(self, known: Mapping[Node, Scalar], moved: Sequence[Node]) -> dict[Node, Scalar]:
        """The speeds that the constraints complete or change; those of which the least change has no closed form are
        left."""
        u, place = self.system.symbols.u, {**known, self.system.symbols.t: 0}
        written = {x: self.declared[x] for x in moved}
        closing = self.system.constraints.closing
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
        """(the speeds that change, W): the constraints alone say what they are, then the least change by either
        measure."""
        u, model = self.system.symbols.u, self.system.scope.model
        silent = [x for x in u if model.is_guess(x.name) and not self.at_rest]
        ways: list[tuple[list[Node], list[list[Scalar]]]] = [(list(moved), [])]
        if {*moved} <= {*silent}:
            columns = [[row[u.index(x)] for row in J] for x in silent]
            along = [(x, column) for x, column in zip(silent, columns, strict=True) if not all(map(is_zero, column))]
            squares = [sum((e * e for e in column), start=0) for _, column in along]
            W = [[squares[i] if i == j else 0 for j in range(len(along))] for i in range(len(along))]
            ways.append(([x for x, _ in along], W))
        elif not {*moved} & {*silent}:
            given = [x for x in u if x not in silent]
            masses = mass(self.system.motion)
            M = [[masses[u.index(x)][u.index(y)] for y in given] for x in given]
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
            return LinearSystem(rows, right, n + (k if W else 0), self._digits).unique_solution()[:n]
        except DerivationError:
            return ()

    def _digits(self, scalars: Sequence[Scalar]) -> Any:
        """Scalars of the parameters with 50 digits."""
        return evaluate(
            scalars, {x: fifty_digits().number(value) for x, value in self.located.numbers.items()}, fifty_digits()
        )

    def _independent(self, J: Sequence[Sequence[Scalar]]) -> list[int]:
        """Indices of the rows of J that are independent of those before them."""
        flat = [e for row in J for e in row]
        if not flat or not set(symbols_of(flat)) <= self.located.numbers.keys():
            return []
        try:
            values = Doubles(self.located.numbers).array(J, len(J[0]))
        except (NoValue, ZeroDivisionError):
            return []
        return [*Split.of(values).rows]


# -------- start slopes ----------------------------------------------------------------------------------------
# System, what changes -> how all parameters and the start follow: dependent ones by the constraints that they keep
# closed.
#
# phi_q dq + phi_p dp = 0,    J du + d(J u + sigma) = 0 along (dq, dp)


Seeds = Mapping[Node, Scalar]
"""how symbols change: their derivatives, by what is changed"""


def _kept(
    scalars: Sequence[Scalar],
    left: Sequence[float],
    silent: Sequence[Node],
    seeds: dict[Node, Fraction],
    numbers: Mapping[Node, Any],
    what: str,
    moved: Sequence[Node],
) -> dict[Node, Fraction]:
    """The changes with which scalars stay 0: values that are not given follow.

    Args:
        moved: what stands elsewhere than it was said to, so that the scalars are 0: it must be what follows.
    Raises:
        DerivationError: these do not do, or may do so in several ways.
    """
    if not moved and not np.any(np.abs(left) > tolerances.CARRIED):
        return seeds
    A = Numbers(numbers).array(jacobian(scalars, silent), len(silent))
    step, _, rank, _ = np.linalg.lstsq(A, -np.array(left), rcond=tolerances.RANK)
    several = rank < np.count_nonzero(np.any(A, axis=0)) or not {*moved} <= {*silent}
    if several or np.max(abs(A @ step + left)) > tolerances.CARRIED * max(1.0, np.max(np.abs(left))):
        names = ", ".join(f"'{x.name}'" for x in silent or moved)
        raise DerivationError(
            f"the constraints do not determine how the start changes with {what}{f': of {names}' if names else ''}",
            fix="declare the coordinates that follow from the constraints as dependent",
        )
    return seeds | {x: seeds[x] + Fraction(d) for x, d in zip(silent, step.tolist(), strict=True)}


def _moved(said: Mapping[Node, Scalar], variables: Sequence[Node], numbers: Mapping[Node, Any]) -> list[Node]:
    """Variables whose start the constraints move away from the value that the model says."""
    found = Numbers(numbers).of([said[x] for x in variables])
    own = [float(numbers[x]) for x in variables]
    return [
        x for x, a, b in zip(variables, found, own, strict=True) if abs(a - b) > tolerances.CARRIED * max(1.0, abs(b))
    ]


# -------- values at rest --------------------------------------------------------------------------------------
# System -> its configuration at rest: coordinates at the start, exact; speeds, accelerations and time 0.


DIGITS = 12  # of a speed that a start was given by its constraints


def _closed_in(system: System, state: State, sought: list[Node]) -> State:
    """The dependent coordinates that the constraints place, in closed form."""
    numbers: dict[Node, float] = {node: float(x) for node, x in system.scope.values_of_parameters(None).items()}
    numbers |= {node: value for node, value in zip(system.symbols.x, Start.of(system).values.values(), strict=True)}
    located = Located(numbers, system.scope.positive)
    found = located.places(substituted(system.constraints.gaps, state), sought)
    missing = [q.name for q in sought if q not in found]
    if missing:
        raise DerivationError(
            f"where the constraints place '{missing[0]}' has no closed form here",
            f"coordinates.{missing[0]}",
            "give start values at which it has one",
        )
    return found


def speeds_near(system: System, places: State, numbers: Mapping[Node, float]) -> State:
    """Exact speeds at exact places, for which J u + sigma = 0, next to those of a start that was put together.

    Args:
        numbers: of all speeds; as many as the rows determine follow from the others, which are rounded.
    """
    u = system.symbols.u
    rows = substituted(tuple(row.velocity for row in system.constraints.closing), places | {system.symbols.t: 0})
    still = substituted(rows, dict.fromkeys(u, 0))
    lines = [{j: x for j, x in enumerate(row) if not is_zero(x)} for row in jacobian(rows, u)]
    values = partial(evaluate, values=system.scope.values_of_parameters(Random(3)), arithmetic=fifty_digits())
    solution = LinearSystem(lines, [-x for x in still], len(u), values).solution()
    known = {j: Fraction(f"{numbers[u[j]]:.{DIGITS}g}") for j in solution.free}
    found: dict[Node, Scalar] = {u[j]: x for j, x in known.items()}
    for j, x in solution.constants.items():
        found[u[j]] = x - sum((share * known[f] for f, share in solution.shares[j].items()), start=0)
    return found


# -------- numeric value ---------------------------------------------------------------------------------------
# Scope -> ScalarValues: values of scalars at the model's parameters, with 50 digits, and a test if they vanish there.
#
# Parameters without a value, and symbols that were left free, have random values.


def shown_numbers(scalars: Sequence[Scalar | None], values: Mapping[Node, Scalar | float]) -> list[float | None]:
    """The scalars as numbers, None where something in one has no value; nan where it has none itself."""
    ready = [x is not None and set(symbols_of((x,))) <= values.keys() for x in scalars]
    known = [x for x, is_ready in zip(scalars, ready, strict=True) if is_ready and x is not None]
    found = iter(numbers_of(known, values))
    return [next(found) if is_ready else None for is_ready in ready]


@dataclass(frozen=True)
class ScalarValues:
    """Values of scalars at the model's parameters.

    Args:
        scope: of the model.
        tolerance: absolute value below which a scalar counts as zero.
    """

    scope: Scope
    tolerance: float = tolerances.ZERO_AT_50

    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        """The values, with 50 digits."""
        wanted, values, rng = tuple(scalars), self._values, Random(2)
        for x in symbols_of(wanted):
            if x not in values:
                values[x] = fifty_digits().number(Fraction(rng.randint(20, 60), 40))
        return evaluate(wanted, values, fifty_digits())

    def vanish(self, scalars: Iterable[Scalar]) -> bool:
        """True if all scalars are zero."""
        return all(abs(x) < self.tolerance for x in self.of(scalars))

    def number(self, x: Scalar) -> float | None:
        """A scalar as a number; None where something in it has no value."""
        if any(symbol not in self._known for symbol in symbols_of((x,))):
            return None
        found = number_of(x, self._known)
        return None if math.isnan(found) else found

    @cached_property
    def _values(self) -> dict[Node, Any]:
        return self.scope.values_of_parameters(Random(1))

    @cached_property
    def _known(self) -> dict[Node, Scalar]:
        return self.scope.known_exactly
