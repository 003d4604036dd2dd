"""System -> the state at the start: dependent coordinates where the ties put them, and the ties found to hold.

Of the dependent coordinates those that position ties fix are sought from `near`, else from `start`; those that only
velocity ties move really start at `start`. Other coordinates and speeds stay as given where the ties hold there. Where
these do not, the nearest values are taken at which they do (`consistency`), and what has changed is told.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues, UsageError
from eomgen.mechanics.bodies.tree import branches_of
from eomgen.mechanics.constraints.assembly import (
    fixed_by_position,
    open_at,
    open_by,
    that_stay,
    tiers_of,
    with_gaps_closed,
)
from eomgen.mechanics.constraints.bifurcations import Fork, fork_at, is_at_rest, leads_on, speeds_along
from eomgen.mechanics.constraints.closure import closed, of_50_digits
from eomgen.mechanics.constraints.consistency import is_guess, is_typed, nearest_speeds
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.initial_state.open_ties import quoted_names, refuse_open_gaps, refuse_open_rates
from eomgen.model.begun_speeds import begun_speeds
from eomgen.model.contacts import contacts_of
from eomgen.model.own_units import in_own_unit
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters, first_guesses, numeric_parameters, start_values
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, COORDINATE_AT_50, LARGEST_AT_50


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
    """Where a motion begins.

    Args:
        values: of every coordinate and independent speed; all ties hold.
        changes: of those that are not dependent, so that the ties hold.
        ties: the names of the ties that did not hold at the values given.
        fork: where branches meet there.
        hit: the one-sided ties into which the given speeds lead: an impact without rebound, M (u+ - u-) = J^T Lam.
    """

    values: dict[str, float]
    changes: tuple[Change, ...] = ()
    ties: tuple[str, ...] = ()
    fork: Fork | None = None
    hit: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """What was changed, or only found where nobody gave it, and why; "" where nothing was."""
        if not self.changes:
            return ""
        if self.hit:
            changes = ", ".join(map(str, self.changes))
            return f"changed by an impact without rebound on {quoted_names(self.hit)}: {changes}"
        names, how = quoted_names(self.ties), "changed" if any(change.given for change in self.changes) else "completed"
        hold = "holds" if len(self.ties) == 1 else "hold"
        return f"{how} so that {names} {hold} at the start: {', '.join(map(str, self.changes))}"


def refuse_lost(places: Mapping[Node, Any]) -> None:
    """Refuses coordinates of which so few digits are left that a step or a difference is lost.

    Raises:
        DerivationError: the first of them is named.
    """
    for node, x in places.items():
        if abs(x) > LARGEST_AT_50:
            what = f"'{node.name}' is at {float(x):.6g}, where no digit is left of a small motion"
            raise DerivationError(what, f"coordinates.{node.name}", "start nearer to 0, an angle less whole turns")


def start_state(
    system: System, parameters: Mapping[str, Any] | None = None, start: Mapping[str, float] | None = None
) -> dict[str, float]:
    """The values of `start_of_motion`, with its arguments and errors."""
    return start_of_motion(system, parameters, start).values


def begun_state(system: System) -> State:
    """A value of every symbol that stands in the ties, at the start, with 50 digits."""
    return _numbers(system, start_state(system), None)


def start_of_motion(
    system: System, parameters: Mapping[str, Any] | None = None, start: Mapping[str, float] | None = None
) -> Start:
    """Every coordinate and independent speed at the start, at which all ties hold.

    Args:
        parameters: values in place of the model's own.
        start: values of coordinates and speeds in place of the model's own; of a dependent coordinate the first guess.
    Raises:
        UsageError: a name in `start` that is no coordinate and no speed.
        MissingValues: a start value, or a tie, needs parameters without values.
        DerivationError: a tie that does not close near there.
    """
    values = _given(system, parameters, start or {})
    if all(row.identical for row in system.ties.rows):
        return Start(values)
    before = _numbers(system, values, parameters)
    sought = fixed_by_position(system.ties)
    state = (closed(system.ties, before, sought) or before) if sought else before
    called = _called(system, start or {})
    state, open_gaps = with_gaps_closed(system.ties, state, called)
    refuse_open_gaps(system, state)
    state, open_rates = _with_rates_closed(system, state, called, parameters)
    state, hit = _after_impact(system, state, parameters)
    refuse_open_rates(system, state)
    state, fork, turned = _along_a_branch(system, state, called)
    names = tuple(dict.fromkeys((*open_gaps, *open_rates, *hit, *turned)))
    found = {node.name: _rounded(state[node], values[node.name]) for node in (*system.symbols.q, *system.symbols.u)}
    return Start(found, _changes(system, values, found, called) if names else (), names, fork, hit)


# -- values at which the ties hold -------------------------------------------------------------------


def _with_rates_closed(
    system: System, state: State, called: frozenset[str], parameters: Mapping[str, Any] | None
) -> tuple[State, tuple[str, ...]]:
    """(the nearest state in which speeds agree with the ties, the ties that did not hold)."""
    apart = open_at(((row, row.velocity) for row in system.ties.closing), system.symbols.u, state)
    ties = that_stay(system.ties, apart)
    opened = tuple(name for name in apart if any(row.tie == name for row in ties.rows))
    if not opened:
        return state, ()
    M = _inertia(system, state, parameters)
    return nearest_speeds(ties, state, _tiers(system, called), M) or state, opened


def _tiers(system: System, called: frozenset[str]) -> tuple[list[Node], ...]:
    """Speeds in the order in which they are changed: those that follow from the others first."""
    follow = following_rates(system)
    return follow, *tiers_of(system.scope.model, [u for u in system.symbols.u if u not in follow], called)


def following_rates(system: System) -> list[Node]:
    """The speeds of a system over all rates that are those of dependent coordinates."""
    names = {f"{q}'" for q in dependent_coordinates(system.scope)}
    return [u for u in system.symbols.u if u.name in names]


def _after_impact(system: System, state: State, parameters: Mapping[str, Any] | None) -> tuple[State, tuple[str, ...]]:
    """(the state after the impact on one-sided ties into which its speeds lead, these ties); as it is without one.

    M (u+ - u-) = J^T Lam with J u+ + sigma = 0 of all that holds and Lam >= 0 of what can only push, or pull.
    """
    one_sided = {contact.name for contact in contacts_of(system.scope.model) if contact.unilateral}
    rows = [(k, row) for k, row in enumerate(system.ties.closing) if row.tie in one_sided and row.number == 1]
    u = system.symbols.u
    broken = [row for _, row in rows if open_by(row.velocity, u, state)]
    hit = tuple(row.tie for row in broken if evaluate((row.velocity,), state, fifty_digits())[0] < 0)
    M = _inertia(system, state, parameters) if hit and len(hit) == len(broken) else None
    after = None if M is None else nearest_speeds(system.ties, state, [(), u], M)
    if M is None or after is None:
        return state, ()
    J = np.array([[float(x) for x in evaluate(row, state, fifty_digits())] for row in system.ties.J])
    moved = M @ np.array([float(after[x] - state[x]) for x in u])
    impulses = np.linalg.lstsq(J.T, moved, rcond=None)[0]
    if any(impulses[k] < -COMPUTED * np.max(np.abs(impulses)) for k, _ in rows):  # another one would have to hold on
        return state, ()
    return after, hit


def _inertia(system: System, state: State, parameters: Mapping[str, Any] | None) -> np.ndarray | None:
    """M at a state; None where a mass has no value."""
    known = exact_parameters(system.scope.model, parameters)
    values = {node: float(known[name]) for name, node in system.symbols.parameters.items() if name in known}
    values |= {node: float(x) for node, x in state.items()}
    rows = recursive.mass(system.motion, branches_of(system.motion))
    entries = [x for row in rows for x in row]
    if not set(symbols_of(entries)) <= values.keys():
        return None
    M = np.array(evaluate(entries, values, FLOAT)).reshape(len(rows), -1)
    return M if np.all(np.isfinite(M)) else None


def _along_a_branch(system: System, state: State, called: frozenset[str]) -> tuple[State, Fork | None, tuple[str, ...]]:
    """(the nearest state whose speeds lead along a branch, where branches meet, the ties that they did not keep).

    Raises:
        DerivationError: they lead along none.
    """
    try:
        fork = fork_at(system.ties, state)
    except (DerivationError, MissingValues):  # the ties close nowhere near: there is but this place
        return state, None, ()
    if fork is None or is_at_rest(system.ties, state) or leads_on(system.ties, fork, state):
        return state, fork, ()
    found = speeds_along(system.ties, fork, state, _tiers(system, called))
    if found is None:
        what = f"the start lies in {fork.words}, and no motion goes on with its speeds"
        raise DerivationError(what, f"constraints.{fork.ties[0]}", "give other speeds, or start beside that position")
    return found, fork, fork.ties


def _called(system: System, start: Mapping[str, float]) -> frozenset[str]:
    """The coordinates and speeds whose start a person typed, or a caller gave: these are changed last."""
    names = (node.name for node in (*system.symbols.q, *system.symbols.u))
    return frozenset(name for name in names if name in start or is_typed(system.scope.model, name))


def _changes(
    system: System, before: Mapping[str, float], after: Mapping[str, float], called: frozenset[str]
) -> tuple[Change, ...]:
    """What differs, dependent coordinates left out."""
    follow = {*dependent_coordinates(system.scope), *(u.name for u in following_rates(system))}
    own = [x for x in (*system.symbols.q, *system.symbols.u) if x.name not in follow]
    return tuple(
        _change(system.scope.model, x.name, (before[x.name], after[x.name]), x.name in called)
        for x in own
        if abs(after[x.name] - before[x.name]) > COMPUTED * (1 + abs(before[x.name]))
    )


def _change(model: Model, name: str, values: tuple[float, float], called: bool) -> Change:
    """A change from the first of two values to the second."""
    before, after = values
    given = called or not is_guess(model, name)
    was = f" (not {in_own_unit(model, name, before, 6)})" if given else ""
    return Change(name, before, after, given, f"{name} = {in_own_unit(model, name, after)}{was}")


def _rounded(x: Any, given: float) -> float:
    """A number of 50 digits as a float; 0 where it is rounding, and not given."""
    return 0.0 if abs(x) < COORDINATE_AT_50 and float(x) != given else float(x)


def start_speeds(system: System) -> dict[Node, Scalar]:
    """Every speed at the start, as functions of the parameters and of where it starts.

    Where no declared speed of the same rates has a start, they are what the start speeds of the coordinates make them.
    """
    scope, begun = system.scope, begun_speeds(system.scope.model.speeds)
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


def _by_rates(system: System, speed: str, rates: Mapping[str, Scalar]) -> Scalar:
    """A declared speed at given rates, those of dependent coordinates as the ties make them, at t = 0."""
    free = system.free
    assert free is not None, "declared speeds leave the system over the rates behind"
    scope = free.scope if system.elimination is None else system.elimination.scope
    known: dict[Node, Scalar] = {u: rates[u.name] for u in scope.symbols.u}
    return substituted((scope.names[speed],), {**known, scope.symbols.t: 0})[0]


def _given(system: System, parameters: Mapping[str, Any] | None, start: Mapping[str, float]) -> dict[str, float]:
    """The start values as they are written, and those in their place."""
    names = [node.name for node in (*system.symbols.q, *system.symbols.u)]
    unknown = [name for name in start if name not in names]
    if unknown:
        raise UsageError(f"no coordinate or speed '{unknown[0]}'", mend=f"one of {', '.join(names)}")
    q, u = start_values(system.scope.model, parameters)
    guesses = first_guesses(system.scope.model, parameters)
    sought = {node.name for node in fixed_by_position(system.ties)}
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
                f"the quaternion {', '.join(e.name for e in four)} cannot start at 0", mend="1, 0, 0, 0 is not turned"
            )
        found |= {e.name: values[e.name] / norm for e in four}
    return found


def _by_coordinates(
    system: System, values: Mapping[str, float], parameters: Mapping[str, Any] | None
) -> dict[str, float]:
    """The declared speeds by the start speeds of the coordinates, where none of the same rates has a start."""
    model, symbols = system.scope.model, system.symbols
    begun = begun_speeds(model.speeds)
    silent = [u for u in symbols.u if u.name in model.speeds and u.name not in begun]
    formulas = start_speeds(system) if silent else {}
    asked = tuple(formulas[u] for u in silent)
    used = set(symbols_of(asked))
    p = numeric_parameters(model, parameters, needed=[name for name, x in symbols.parameters.items() if x in used])
    state = {symbols.parameters[name]: value for name, value in p.items()}
    state |= {q: values[q.name] for q in symbols.q}
    return {u.name: float(x) for u, x in zip(silent, evaluate(asked, state, FLOAT), strict=True)}


def _numbers(system: System, values: Mapping[str, float], parameters: Mapping[str, Any] | None) -> State:
    """A value of every symbol that may stand in a tie, at t = 0, with 50 digits; what is not needed may be missing."""
    symbols = system.symbols
    rows = [row for row in system.ties.rows if not row.identical]
    used = set(symbols_of([x for row in rows for x in (row.velocity, 0 if row.gap is None else row.gap)]))
    used |= set(symbols_of(system.inputs.values()))
    needed = [name for name, node in symbols.parameters.items() if node in used]
    p = numeric_parameters(system.scope.model, parameters, needed=needed)
    state = {symbols.parameters[name]: of_50_digits(value) for name, value in p.items()} | {symbols.t: of_50_digits(0)}
    state |= {node: of_50_digits(values[node.name]) for node in (*symbols.q, *symbols.u)}
    for name, node in symbols.inputs.items():
        state[node] = evaluate((system.inputs[name],), state, fifty_digits())[0]
    return state
