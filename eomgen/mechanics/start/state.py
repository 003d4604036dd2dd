"""System -> the state at the start: dependent coordinates where the constraints put them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, partial
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues, OpenConstraints, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Assembly, Closure, Fork, Row, open_by
from eomgen.mechanics.dynamics import System, Valueless, mass
from eomgen.mechanics.state import Doubles, Numbers
from eomgen.model import (
    Model,
    PointForce,
)
from eomgen.symbolic.expression import Node, Scalar, State, depends_on, jacobian, substituted, symbols_of
from eomgen.symbolic.numeric import (
    FLOAT,
    NoValue,
    all_roots,
    evaluate,
    fifty_digits,
    least_left,
    tolerances,
)

# -------- initial state ---------------------------------------------------------------------------------------
# System -> the state at the start: dependent coordinates where the constraints put them, and the constraints found to
# hold.
#
# Of the dependent coordinates those that position constraints fix are sought from `near`, else from `start`; those
# that only velocity constraints move really start at `start`. Other coordinates and speeds stay as given where the
# constraints hold there. Where these do not, the nearest values are taken at which they do (`consistency`), and the
# changes are reported.


@dataclass(frozen=True)
class Change:
    """A coordinate or speed that does not start as it was written.

    Args:
        given: whether somebody gave it; else it is a guess, or 0.
        words: as its user writes it, in his unit.
    """

    name: str
    before: float
    after: float
    given: bool
    words: str

    def __str__(self) -> str:
        return self.words


@dataclass(frozen=True)
class Start:
    """Start of a motion in numbers, and the changes that the constraints made necessary.

    Args:
        values: of every coordinate and independent speed; all constraints hold.
        changes: of those that are not dependent, so that the constraints hold.
        constraints: the names of the constraints that did not hold at the values given.
        fork: that of the branches that meet there; None where none do.
        hit: the one-sided constraints into which the given speeds lead: an impact without rebound, M (u+ - u-) = J^T
            Lam.
    """

    values: dict[str, float]
    changes: tuple[Change, ...] = ()
    constraints: tuple[str, ...] = ()
    fork: Fork | None = None
    hit: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """Sentence that says which start values were changed or completed, and why; "" where none were."""
        if not self.changes:
            return ""
        if self.hit:
            changes = ", ".join(map(str, self.changes))
            return f"changed by an impact without rebound on {quoted_names(self.hit)}: {changes}"
        names, how = (
            quoted_names(self.constraints),
            "changed" if any(change.given for change in self.changes) else "completed",
        )
        hold = "holds" if len(self.constraints) == 1 else "hold"
        return f"{how} so that {names} {hold} at the start: {', '.join(map(str, self.changes))}"

    @staticmethod
    def of(
        system: System, parameters: Mapping[str, Any] | None = None, start: Mapping[str, float] | None = None
    ) -> Start:
        """Every coordinate and independent speed at the start, at which all constraints hold.

        Args:
            parameters: values in place of the model's own.
            start: values of coordinates and speeds in place of the model's own; of dependent ones the first guess.
        Raises:
            UsageError: a name in `start` that is no coordinate and no speed.
            MissingValues: a start value, or a constraint, needs parameters without values.
            DerivationError: a constraint that does not close near there.
        """
        values = _given(system, parameters, start or {})
        if all(row.identical for row in system.constraints.rows):
            return Start(values)
        before = _numbers(system, values, parameters)
        sought = system.constraints.fixed_by_position
        state = (Closure(system.constraints).closed(before, sought) or before) if sought else before
        called = _called(system, start or {})
        state, open_gaps = Assembly(system.constraints).with_gaps_closed(state, called)
        refuse_open_gaps(system, state)
        state, open_rates = _with_rates_closed(system, state, called, parameters)
        state, hit = _after_impact(system, state, parameters)
        refuse_open_rates(system, state)
        state, fork, turned = _along_a_branch(system, state, called)
        names = tuple(dict.fromkeys((*open_gaps, *open_rates, *hit, *turned)))
        found = {node.name: _rounded(state[node], values[node.name]) for node in system.symbols.x}
        return Start(found, _changes(system, values, found, called) if names else (), names, fork, hit)

    @staticmethod
    def begun(system: System) -> State:
        """A value of every symbol that stands in the constraints, at the start, with 50 digits."""
        return _numbers(system, Start.of(system).values, None)

    @staticmethod
    def refuse_lost(places: Mapping[Node, Any]) -> None:
        """Refuses coordinates of which so few digits are left that a step or a difference is lost.

        Raises:
            DerivationError: the first of them is named.
        """
        for node, x in places.items():
            if abs(x) > tolerances.LARGEST_AT_50:
                what = f"'{node.name}' is at {float(x):.6g}, where no digit is left of a small motion"
                raise DerivationError(what, f"coordinates.{node.name}", "start nearer to 0, an angle less whole turns")

    @staticmethod
    def speeds_of(system: System) -> dict[Node, Scalar]:
        """Every speed at the start, as functions of the parameters and of where it starts.

        Where no declared speed of the same rates has a start, the start speeds of the coordinates make them.
        """
        scope, begun = system.scope, system.scope.model.begun_speeds
        model = scope.model
        found: dict[Node, Scalar] = {}
        rates = {f"{name}'": scope.value(part.speed) for name, part in model.coordinates.items() if not part.driven}
        for u in scope.symbols.u:
            if u.name in rates:
                found[u] = rates[u.name]
            elif u.name in begun:
                found[u] = scope.value(model.speeds[u.name].start)
            else:
                found[u] = _by_rates(system, u.name, rates)
        return found


# -- values at which the constraints hold -------------------------------------------------------------------


def _with_rates_closed(
    system: System, state: State, called: frozenset[str], parameters: Mapping[str, Any] | None
) -> tuple[State, tuple[str, ...]]:
    """(the nearest state in which speeds agree with the constraints, the constraints that did not hold)."""
    pairs = ((row, row.velocity) for row in system.constraints.closing)
    constraints, opened = Assembly(system.constraints).opened(pairs, system.symbols.u, state)
    if not opened:
        return state, ()
    M = _inertia(system, state, parameters)
    return Closure(constraints).nearest_speeds(state, _tiers(system, called), M) or state, opened


def _tiers(system: System, called: frozenset[str]) -> tuple[list[Node], ...]:
    """Speeds in the order in which they are changed: those that follow from the others first."""
    follow = following_rates(system)
    return follow, *Assembly(system.constraints).tiers([u for u in system.symbols.u if u not in follow], called)


def following_rates(system: System) -> list[Node]:
    """The speeds of a system over all rates that are those of dependent coordinates."""
    names = {f"{q}'" for q in system.scope.dependent}
    return [u for u in system.symbols.u if u.name in names]


def _after_impact(system: System, state: State, parameters: Mapping[str, Any] | None) -> tuple[State, tuple[str, ...]]:
    """(the state after the impact on one-sided constraints into which its speeds lead, these constraints); as it is
    without one.

    M (u+ - u-) = J^T Lam with J u+ + sigma = 0 of all that holds and Lam >= 0 of what can only push, or pull.
    """
    one_sided = {contact.name for contact in system.scope.model.contacts if contact.unilateral}
    rows = [
        (k, row) for k, row in enumerate(system.constraints.closing) if row.constraint in one_sided and row.number == 1
    ]
    u = system.symbols.u
    broken = [row for _, row in rows if open_by(row.velocity, u, state)]
    hit = tuple(row.constraint for row in broken if evaluate((row.velocity,), state, fifty_digits())[0] < 0)
    M = _inertia(system, state, parameters) if hit and len(hit) == len(broken) else None
    after = None if M is None else Closure(system.constraints).nearest_speeds(state, [(), u], M)
    if M is None or after is None:
        return state, ()
    J = Numbers(state).array(system.constraints.J, len(u))
    moved = M @ np.array([float(after[x] - state[x]) for x in u])
    impulses = np.linalg.lstsq(J.T, moved, rcond=None)[0]
    if any(
        impulses[k] < -tolerances.COMPUTED * np.max(np.abs(impulses)) for k, _ in rows
    ):  # another one would have to hold on
        return state, ()
    return after, hit


def _inertia(system: System, state: State, parameters: Mapping[str, Any] | None) -> np.ndarray | None:
    """M at a state; None where a mass has no value."""
    known = system.scope.model.exact_parameters(parameters)
    values = {node: float(known[name]) for name, node in system.symbols.parameters.items() if name in known}
    values |= {node: float(x) for node, x in state.items()}
    rows = mass(system.motion)
    entries = [x for row in rows for x in row]
    if not set(symbols_of(entries)) <= values.keys():
        return None
    M = Doubles(values).array(rows, len(rows))
    return M if np.all(np.isfinite(M)) else None


def _along_a_branch(system: System, state: State, called: frozenset[str]) -> tuple[State, Fork | None, tuple[str, ...]]:
    """(the nearest state whose speeds lead along a branch, where branches meet, the constraints that they did not
    keep).

    Raises:
        DerivationError: they lead along none.
    """
    try:
        fork = Assembly(system.constraints).fork_at(state)
    except (DerivationError, MissingValues):  # the constraints close nowhere near: there is but this place
        return state, None, ()
    if (
        fork is None
        or Assembly(system.constraints).is_at_rest(state)
        or Assembly(system.constraints).leads_on(fork, state)
    ):
        return state, fork, ()
    found = Assembly(system.constraints).speeds_along(fork, state, _tiers(system, called))
    if found is None:
        what = f"the start lies in {fork.words}, and no motion continues from it with its speeds"
        raise DerivationError(
            what, f"constraints.{fork.constraints[0]}", "give other speeds, or start near that position"
        )
    return found, fork, fork.constraints


def _called(system: System, start: Mapping[str, float]) -> frozenset[str]:
    """The coordinates and speeds whose start a person typed, or a caller gave: these are changed last."""
    names = (node.name for node in system.symbols.x)
    return frozenset(name for name in names if name in start or system.scope.model.is_typed(name))


def _changes(
    system: System, before: Mapping[str, float], after: Mapping[str, float], called: frozenset[str]
) -> tuple[Change, ...]:
    """Changes between two starts, without those of dependent coordinates."""
    follow = {*system.scope.dependent, *(u.name for u in following_rates(system))}
    own = [x for x in system.symbols.x if x.name not in follow]
    return tuple(
        _change(system.scope.model, x.name, (before[x.name], after[x.name]), x.name in called)
        for x in own
        if abs(after[x.name] - before[x.name]) > tolerances.COMPUTED * (1 + abs(before[x.name]))
    )


def _change(model: Model, name: str, values: tuple[float, float], called: bool) -> Change:
    """A change from the first of two values to the second."""
    before, after = values
    given = called or not model.is_guess(name)
    was = f" (not {model.in_own_unit(name, before, 6)})" if given else ""
    return Change(name, before, after, given, f"{name} = {model.in_own_unit(name, after)}{was}")


def _rounded(x: Any, given: float) -> float:
    """A number of 50 digits as a float; 0 where it is rounding, and not given."""
    return 0.0 if abs(x) < tolerances.COORDINATE_AT_50 and float(x) != given else float(x)


def _by_rates(system: System, speed: str, rates: Mapping[str, Scalar]) -> Scalar:
    """A declared speed at given rates, those of dependent coordinates as the constraints make them, at t = 0."""
    free = system.free
    assert free is not None, "declared speeds leave the system over the rates behind"
    scope = free.scope if system.elimination is None else system.elimination.scope
    known: dict[Node, Scalar] = {u: rates[u.name] for u in scope.symbols.u}
    return substituted((scope.names[speed],), {**known, scope.symbols.t: 0})[0]


def _given(system: System, parameters: Mapping[str, Any] | None, start: Mapping[str, float]) -> dict[str, float]:
    """The start values as they are written, and those in their place."""
    names = [node.name for node in system.symbols.x]
    unknown = [name for name in start if name not in names]
    if unknown:
        raise UsageError(f"no coordinate or speed '{unknown[0]}'", fix=f"one of {', '.join(names)}")
    q, u = system.scope.model.start_values(parameters)
    guesses = system.scope.model.first_guesses(parameters)
    sought = {node.name for node in system.constraints.fixed_by_position}
    values = {**q, **u, **{name: x for name, x in guesses.items() if name in sought}, **start}
    values |= _normed(system, values)
    values |= {name: x for name, x in _by_coordinates(system, values, parameters).items() if name not in start}
    return {name: float(values[name]) for name in names}


def _normed(system: System, values: Mapping[str, float]) -> dict[str, float]:
    """The coordinates of quaternions over their norm."""
    found: dict[str, float] = {}
    for four in system.scope.quaternions:
        norm = math.hypot(*(values[e.name] for e in four))
        if norm == 0:
            raise UsageError(
                f"the quaternion {', '.join(e.name for e in four)} cannot start at 0", fix="1, 0, 0, 0 is not turned"
            )
        found |= {e.name: values[e.name] / norm for e in four}
    return found


def _by_coordinates(
    system: System, values: Mapping[str, float], parameters: Mapping[str, Any] | None
) -> dict[str, float]:
    """The declared speeds by the start speeds of the coordinates, where none of the same rates has a start."""
    model, symbols = system.scope.model, system.symbols
    begun = model.begun_speeds
    silent = [u for u in symbols.u if u.name in model.speeds and u.name not in begun]
    formulas = Start.speeds_of(system) if silent else {}
    requested = tuple(formulas[u] for u in silent)
    used = set(symbols_of(requested))
    p = model.numeric_parameters(parameters, needed=[name for name, x in symbols.parameters.items() if x in used])
    state = {symbols.parameters[name]: value for name, value in p.items()}
    state |= {q: values[q.name] for q in symbols.q}
    return {u.name: float(x) for u, x in zip(silent, evaluate(requested, state, FLOAT), strict=True)}


def _numbers(system: System, values: Mapping[str, float], parameters: Mapping[str, Any] | None) -> State:
    """A value of every symbol that may stand in a constraint, at t = 0, with 50 digits; what is not needed may be
    missing."""
    symbols = system.symbols
    rows = [row for row in system.constraints.rows if not row.identical]
    used = set(symbols_of([x for row in rows for x in (row.velocity, 0 if row.gap is None else row.gap)]))
    used |= set(symbols_of(system.inputs.values()))
    needed = [name for name, node in symbols.parameters.items() if node in used]
    p = system.scope.model.numeric_parameters(parameters, needed=needed)
    state = {symbols.parameters[name]: fifty_digits().number(value) for name, value in p.items()} | {
        symbols.t: fifty_digits().number(0)
    }
    state |= {node: fifty_digits().number(values[node.name]) for node in symbols.x}
    for name, node in symbols.inputs.items():
        state[node] = evaluate((system.inputs[name],), state, fifty_digits())[0]
    return state


# -------- open constraints -------------------------------------------------------------------------------------------
# System, a state -> whether its constraints hold there: more than rounding apart, they are refused by name.


def refuse_open_gaps(system: System, state: State) -> None:
    """Raises OpenConstraints for the constraint that is open by most, DerivationError where its gap has no value."""
    q = system.symbols.q
    gaps = [(row, row.gap) for row in system.constraints.rows if row.gap is not None and not row.identical]
    found = _worst(gaps, q, state)
    if found is None:
        return
    row, gap, size = found
    if size == float("inf"):
        raise DerivationError(
            f"'{row.constraint}' (row {row.number}) {_lacking(gap, state) or 'has no value at the start'}",
            f"constraints.{row.constraint}",
            "give start values at which its roots and quotients have one",
        )
    size = _in_full(system, row, size, state)
    passed = [c.is_passed for c in system.scope.model.contacts if c.name == row.constraint and c.unilateral]
    if passed and evaluate((gap,), state, fifty_digits())[0] < 0:
        what = f"{passed[0]}, by {size:.3g}"
    else:
        what = f"'{row.constraint}' (row {row.number}) does not close at the start: it is open by {size:.3g}"
    raise OpenConstraints(what, f"constraints.{row.constraint}", _fix(system, gap), partial(_nearest, system, state))


def _lacking(gap: Scalar, state: State) -> str:
    """Reason why a gap has no value: " is 0/0 at x = 0, where it starts"."""
    found = Valueless.reason(gap, {node: float(x) for node, x in state.items()})
    return f"{found}, where it starts" if found else ""


def _nearest(system: System, state: State) -> str:
    """Clause that says how nearly the constraints can be satisfied, and where."""
    miss = nearest_miss(system, state)
    if miss is None:
        return ""
    model = system.scope.model
    there = ", ".join(f"{name} = {model.in_own_unit(name, x, 6)}" for name, x in miss.values.items())
    if not miss.open:
        return f"; all constraints close at {there}, farther than a start is moved"
    stay = f"{quoted_names(miss.constraints)} {'stays' if len(miss.constraints) == 1 else 'stay'} open"
    left = state | {q: fifty_digits().number(miss.values[q.name]) for q in system.symbols.q if q.name in miss.values}
    rows = [row for row in system.constraints.rows if row.gap is not None and row.constraint in miss.constraints]
    gaps = evaluate([row.gap for row in rows if row.gap is not None], left, fifty_digits())
    size = max((_in_full(system, row, abs(float(x)), left) for row, x in zip(rows, gaps, strict=True)), default=0)
    return f"; wherever the coordinates go, {stay}: by {size:.3g} at {there}, the least that was found"


def _in_full(system: System, row: Row, size: float, state: State) -> float:
    """Amount by which a row is open; of a link, whose gap g = (L - r.r/L)/2 is a length to first order, |L - |r||.

    L = g + sqrt(g^2 + r.r)
    """
    constraint = system.scope.model.constraints.get(row.constraint)
    if row.gap is None or constraint is None or not constraint.by_squares:
        return size
    first, second = (system.motion.position(push.place) for push in row.pushes if isinstance(push, PointForce))
    (g, *r), digits = evaluate((row.gap, *(second - first)), state, fifty_digits()), fifty_digits()
    root = digits.functions["sqrt"]
    square = sum(x * x for x in r)
    return float(abs(g + root(g * g + square) - root(square)))


def _fix(system: System, gap: Scalar) -> str:
    """Advice to close a gap: another guess, a coordinate marked dependent, other start values."""
    dependent = system.scope.dependent
    standing = [q.name for q in system.symbols.q if depends_on(gap, (q,))]
    sought = [name for name in standing if name in dependent]
    if sought:
        return f"give start values at which it can close, or another guess: `near` of {quoted_names(sought)}"
    free = [name for name in standing if not system.scope.model.coordinates[name].driven]
    if not free:
        return "change the given motions"
    return f"give start values that close it, or mark a coordinate as `dependent`: {quoted_names(free)}"


def quoted_names(names: Sequence[str]) -> str:
    """Names in a sentence: 'pin', 'rod'."""
    return ", ".join(f"'{name}'" for name in names)


def refuse_open_rates(system: System, state: State) -> None:
    """Raises DerivationError for the closing constraint whose velocity row is off by most."""
    u = system.symbols.u
    found = _worst(((row, row.velocity) for row in system.constraints.closing), u, state)
    if found is None:
        return
    row, _, size = found
    speeds = [node.name for node in u if depends_on(row.velocity, (node,))]
    what = f"the speeds at the start break '{row.constraint}' (row {row.number}): it opens at {size:.3g} a second"
    raise DerivationError(
        what, f"constraints.{row.constraint}", f"give start speeds that keep it: {quoted_names(speeds)}"
    )


def _worst(
    pairs: Iterable[tuple[Row, Scalar]], symbols: Sequence[Node], state: State
) -> tuple[Row, Scalar, float] | None:
    """(row, scalar, size) of the largest scalar that ought to be zero and is not; None where all are."""
    found = [(row, x, open_by(x, symbols, state)) for row, x in pairs]
    return max((each for each in found if each[2]), key=lambda each: each[2], default=None)


# -------- nearest miss ----------------------------------------------------------------------------------------
# System, a place where constraints are open -> how near they come to closing, wherever the coordinates go.
#
# min |phi(q)|^2    over the coordinates that are not driven, by Levenberg and Marquardt from several places


TRIES = 12
REACH = 1.5  # how far from the place others are tried [rad, m]
FAILED = 1e6  # stands for a gap that has no value


@dataclass(frozen=True)
class Miss:
    """The place where the constraints are open by least.

    Args:
        values: of the coordinates that stand in gaps.
        open: the largest |phi|; 0 where they close.
        constraints: that stay open.
    """

    values: Mapping[str, float]
    open: float
    constraints: tuple[str, ...]


def nearest_miss(system: System, state: Mapping[Node, Any]) -> Miss | None:
    """The place where the gaps are least, of those that close the nearest; None where nothing moves them."""
    gaps = system.constraints.gaps
    standing = set(symbols_of(gaps))
    free = [q for q in system.constraints.movable if q in standing]
    if not free:
        return None
    search = _Search(system, {node: float(x) for node, x in state.items()}, tuple(free))
    here = np.array([search.known[q] for q in free])
    rng = Random(1)
    starts = [here, *(here + np.array([rng.uniform(-REACH, REACH) for _ in free]) for _ in range(TRIES))]
    best, *_ = all_roots(
        search.least,
        starts,
        lambda place: (round(search.size(place) / tolerances.COMPUTED), float(np.linalg.norm(place - here))),
    )
    values = search.at(best)[: len(gaps)]
    size = float(np.max(np.abs(values), initial=0.0))
    rows = [row for row in system.constraints.rows if row.gap is not None and not row.identical]
    named = [row.constraint for row, x in zip(rows, values, strict=False) if abs(x) > tolerances.OPEN_GAP * size]
    places = {q.name: float(x) if abs(x) > tolerances.SAME_PLACE else 0.0 for q, x in zip(free, best, strict=True)}
    shut = size <= tolerances.COMPUTED and (
        size <= tolerances.SUMMED or _closes(system, state, dict(zip(free, best, strict=True)))
    )
    return Miss(places, 0.0, ()) if shut else Miss(places, size, tuple(dict.fromkeys(named)))


def _closes(system: System, state: Mapping[Node, Any], place: Mapping[Node, float]) -> bool:
    """True if all constraints can be satisfied near a place to 50 digits."""
    there = {node: fifty_digits().number(float(x)) for node, x in {**state, **place}.items()}
    return Closure(system.constraints).closed(there, system.constraints.movable) is not None


@dataclass(frozen=True)
class _Search:
    system: System
    known: dict[Node, float]
    free: tuple[Node, ...]

    @cached_property
    def gaps(self) -> tuple[Scalar, ...]:
        """phi, and e . e - 1 of each quaternion."""
        return (*self.system.constraints.gaps, *self.system.constraints.norms)

    @cached_property
    def slopes(self) -> tuple[Scalar, ...]:
        """The derivatives of the gaps, row by row."""
        return tuple(x for row in jacobian(self.gaps, self.free) for x in row)

    def at(self, place: np.ndarray) -> np.ndarray:
        """The gaps as numbers."""
        return self._numbers(self.gaps, place)

    def size(self, place: np.ndarray) -> float:
        return float(np.max(np.abs(self.at(place)), initial=0.0))

    def least(self, start: np.ndarray) -> np.ndarray:
        return least_left(self.at, start, self._slopes_at).x

    def _slopes_at(self, place: np.ndarray) -> np.ndarray:
        return self._numbers(self.slopes, place).reshape(len(self.gaps), -1)

    def _numbers(self, scalars: tuple[Scalar, ...], place: np.ndarray) -> np.ndarray:
        state = self.known | dict(zip(self.free, place.tolist(), strict=True))
        try:
            values = np.array(evaluate(scalars, state, FLOAT), dtype=float)
        except (NoValue, ZeroDivisionError, OverflowError):
            return np.full(len(scalars), FAILED)
        return np.asarray(np.nan_to_num(values, nan=FAILED, posinf=FAILED, neginf=-FAILED))
