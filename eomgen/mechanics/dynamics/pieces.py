"""Equations of motion -> the pieces of which they are made, and forces that jump between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from random import Random
from typing import Any, ClassVar

from eomgen.errors import DerivationError, MissingValues, ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics.accelerations import exact_accelerations
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System
from eomgen.resources import check_patience
from eomgen.symbolic.exact import readable, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Sampled,
    Scalar,
    State,
    depends_on,
    function,
    is_zero,
    linear_terms,
    order,
    substituted,
)
from eomgen.symbolic.numeric import (
    Choices,
    NoValue,
    PiecewiseNodes,
    Switch,
    Work,
    evaluate,
    fifty_digits,
    has_pieces,
    switches_of,
    tolerances,
)
from eomgen.symbolic.print import to_text

# -------- pieces ----------------------------------------------------------------------------------------------
# Equations of motion, scalars -> the pieces of which these are made, and in which of them something holds.
#
# What is made of min, max, abs, sign, cases and samples is one formula in each piece: with all choices made it has
# none, and algebra says there what it is. Pieces are found from states: the model's own start, states along its own
# motion, states around, and from each of them by Newton's method over every switch into the next.


MOST = 64  # pieces that are distinguished
MOST_OF_ONE = 12  # pieces of one quantity that are entered, evenly spread: a road of 100 arcs is one formula in each
ROUNDS = 3  # of entering pieces from those found
STEPS, LONG = 24, 0.1  # steps along the own motion, and of how many seconds
AROUND = (0.1, 1.0, 3.0)  # of the size of a coordinate and 1: how far from the start states are drawn
DRAWN = 4  # at each of these distances
# draws that close no constraints, after which those that do not close at the start are left
OPEN = 2


@dataclass(frozen=True)
class Condition:
    """A comparison of two sides, what moves on the left one.

    Args:
        relation: "<=" or ">=".
    """

    left: Scalar
    relation: str
    right: Scalar


@dataclass(frozen=True)
class Extent:
    """Extent of a property: everywhere, under conditions, or nowhere.

    Args:
        everywhere: True if it holds in every piece.
        within: if not everywhere, the conditions under which it holds, satisfied at the start; () nowhere.
    """

    everywhere: bool
    within: tuple[Condition, ...] = ()

    def __bool__(self) -> bool:
        return self.everywhere or bool(self.within)

    def __and__(self, other: Extent) -> Extent:
        """Extent in which both properties hold."""
        if not self or not other or (self.everywhere and other.everywhere):
            return Extent(True) if self.everywhere and other.everywhere else Extent(False)
        return Extent(False, tuple(dict.fromkeys((*self.within, *other.within))))

    @property
    def text(self) -> str:
        """The conditions in words: "y >= 0 and t <= t0"; "" where it holds everywhere."""
        return " and ".join(f"{to_text(x.left)} {x.relation} {to_text(x.right)}" for x in self.within)

    @property
    def limits(self) -> tuple[Scalar, ...]:
        """Scalars that are negative inside the pieces in which the property holds."""
        return tuple(x.left - x.right if x.relation == "<=" else x.right - x.left for x in self.within)


@dataclass(frozen=True)
class Division:
    """The pieces of some scalars, searched at their first use.

    Args:
        system: whose they are.
        nodes: what has pieces.
        search: what finds them.
    """

    system: System
    nodes: tuple[Node, ...]
    search: _Search

    @property
    def found(self) -> Mapping[Choices, State]:
        """Every piece that a state was found in, with that state; {} where they are too many."""
        return self.search.found

    @property
    def start(self) -> Choices | None:
        """The piece in which the motion starts; None where it is not known."""
        return self.search.start

    def where(self, decide: Callable[[Choices], bool]) -> Extent:
        """Extent of a property that is decided piece by piece; nowhere if it fails in the piece of the start."""
        if self.start is not None and not self._decided(decide, self.start):
            return Extent(False)
        if not self.found:
            return Extent(False)
        good = {piece: piece == self.start or self._decided(decide, piece) for piece in self.found}
        if all(good.values()):
            return Extent(True)
        if self.start is None:
            return Extent(False)
        literals = self._literals([piece for piece, yes in good.items() if not yes])
        within = dict.fromkeys(c for node, choice in literals for c in self.conditions(node, choice))
        return Extent(False, tuple(within))

    def chosen(self, scalars: Sequence[Scalar], piece: Choices) -> tuple[Scalar, ...]:
        """The scalars as they are in a piece.

        Raises:
            DerivationError: they divide by zero there.
        """
        return PiecewiseNodes(self.nodes).chosen(scalars, piece)

    def where_holds(self, scalars: Sequence[Scalar], decide: Callable[[tuple[Scalar, ...], State], bool]) -> Extent:
        """Extent of a property of scalars; `decide` is called with their form in each piece, and a state there."""
        return self.where(lambda piece: decide(self.chosen(scalars, piece), self.found[piece]))

    def _decided(self, decide: Callable[[Choices], bool], piece: Choices) -> bool:
        try:
            return decide(piece)
        except DerivationError:  # a division by zero: no motion goes there, but nothing is known
            return False

    def _literals(self, bad: Sequence[Choices]) -> list[tuple[Node, int]]:
        """The fewest choices of the start's piece that no piece makes in which it does not hold."""
        assert self.start is not None
        kept = [k for k, choice in enumerate(self.start) if choice or self.nodes[k].op == "sampled"]
        for k in reversed(kept):  # what is made of others first: abs(y) <= L0 says more than max(0, abs(y) - L0) = 0
            rest = [j for j in kept if j != k]
            if not any(all(piece[j] == self.start[j] for j in rest) for piece in bad):
                kept = rest
        return [(self.nodes[k], self.start[k]) for k in kept]

    def conditions(self, x: Node, choice: int) -> Iterator[Condition]:
        """Conditions under which a node makes this choice."""
        if x.op == "sampled":
            ends = Sampled.of(x.args[1]).ends(x.graph.pi)
            if choice > 0:
                yield self._condition(ends[choice - 1] - x.args[0])
            if choice < len(ends):
                yield self._condition(x.args[0] - ends[choice])
        else:
            a, b = PiecewiseNodes.compared_sides(x)
            yield self._condition(-choice * (a - b))

    def _condition(self, below: Scalar) -> Condition:
        """below <= 0, without factors that are positive, what moves on the left side."""
        sign = readable(function("sign", below), Work.ENTRY, self.system.scope.positive)
        inside = {x.args[0] for x in order((sign,)) if x.op == "sign"}
        if len(inside) == 1 and type(sign) is Node and sign.op in ("sign", "neg"):
            (x,) = inside
            below = x if sign.op == "sign" else -x
        moving = tuple(moving_symbols(self.system))
        parts = [(c, 1 if y is None else y) for y, c in linear_terms(below).items()]
        moves = [(c, y) for c, y in parts if depends_on(y, moving)]
        sense = -1 if all(c < 0 for c, _ in moves) else 1
        left = sum((sense * c * y for c, y in moves), start=0)
        right = sum((-sense * c * y for c, y in parts if not depends_on(y, moving)), start=0)
        return Condition(left, "<=" if sense > 0 else ">=", right)


def moving_symbols(system: System) -> frozenset[Node]:
    """Symbols that change along a motion: t, q, u, a, lam and the inputs."""
    symbols = system.symbols
    return frozenset((symbols.t, *symbols.x, *symbols.a, *symbols.lam, *symbols.inputs.values()))


def division_of(equations: EquationsOfMotion, scalars: Sequence[Scalar]) -> Division | None:
    """The pieces of the scalars; None where they have none."""
    if not any(map(has_pieces, scalars)):
        return None
    moving = moving_symbols(equations.system)
    nodes = PiecewiseNodes.of(scalars, moving).nodes
    if not nodes:
        return None
    known, key = equations.symbols.graph.found(division_of), (equations.system.scope.model, moving, nodes)
    if key not in known:  # whatever they stand in, the same choices have the same pieces
        known[key] = Division(equations.system, nodes, _Search(equations, tuple(scalars), nodes))
    found: Division = known[key]
    return found


def where_holds(
    equations: EquationsOfMotion, scalars: Sequence[Scalar], decide: Callable[[tuple[Scalar, ...]], bool]
) -> Extent:
    """Extent of a property of scalars; `decide` is called with the form that they have in each piece."""
    division = division_of(equations, scalars)
    if division is None:
        return Extent(True) if decide(tuple(scalars)) else Extent(False)
    return division.where(lambda piece: decide(division.chosen(scalars, piece)))


def where_continuous(equations: EquationsOfMotion, x: Scalar) -> Extent:
    """Extent in which a function of the motion does not jump: everywhere, or the piece of the start alone."""
    division = division_of(equations, (x,))
    if division is None:
        return Extent(True)
    moving, near = moving_symbols(equations.system), fifty_digits().number(tolerances.DIFFERENCE_AT_50)
    for switch in switches_of((x,), moving):
        for state in division.found.values():
            try:
                for end in switch.places(state):
                    sides = [switch.moved(state, end + sign * near, moving) for sign in (-1, 1)]
                    values = [evaluate((x,), side, fifty_digits())[0] for side in sides if side is not None]
                    if len(values) == 2 and abs(values[0] - values[1]) > tolerances.COMPUTED * (1 + abs(values[0])):
                        return division.where(lambda piece: piece == division.start)
            except (NoValue, ZeroDivisionError):
                continue
    return Extent(True)


@dataclass(frozen=True)
class _Search:
    """The search for pieces."""

    equations: EquationsOfMotion
    scalars: tuple[Scalar, ...]
    nodes: tuple[Node, ...]

    @cached_property
    def start(self) -> Choices | None:
        """The piece of the model's start, or of what comes soon after where that lies between two."""
        begun = self._begun
        if begun is None:
            return None
        return self._choices(begun) or next(
            (c for state in self._soon(begun) if (c := self._choices(state)) is not None), None
        )

    @cached_property
    def found(self) -> Mapping[Choices, State]:
        """Every piece, with a state in it; {} where they are too many."""
        found: dict[Choices, State] = {}
        for state in self._seeds():
            choices = self._choices(state)
            if choices is not None:
                found.setdefault(choices, state)
        if self._begun is not None and self.start is not None:
            found.setdefault(self.start, self._begun)
        rng, entered = Random(9), set[Choices]()
        for _ in range(ROUNDS):
            for choices, state in list(found.items()):
                if choices in entered or len(found) > MOST:
                    continue
                entered.add(choices)
                for beside in self._beside(state, rng):
                    check_patience()
                    if (there := self._choices(beside)) is not None:
                        found.setdefault(there, beside)
        return found if len(found) <= MOST else {}

    def _choices(self, state: State) -> Choices | None:
        try:
            return PiecewiseNodes(self.nodes).choices_at(state)
        except (NoValue, ZeroDivisionError):
            return None

    # -- states ------------------------------------------------------------------------------------

    @property
    def _system(self) -> System:
        return self.equations.system

    @cached_property
    def _begun(self) -> State | None:
        """The model's own start, its constraints closed; None where it has none."""
        try:
            return Closure(self._system.constraints).begun()
        except (DerivationError, MissingValues, ModelError, NoValue, ZeroDivisionError):
            return None

    def _seeds(self) -> Iterator[State]:
        """The start, states along the own motion, states around."""
        begun = self._begun
        if begun is not None:
            yield begun
            yield from self._along(begun, LONG)
        rng, failed, closes = Random(8), 0, begun is not None
        for spread in AROUND:
            for _ in range(DRAWN):
                state = self._around(begun, spread, rng)
                if state is not None:
                    closes = True
                    yield state
                failed += state is None
                if failed == OPEN and not closes:
                    return

    def _around(self, begun: State | None, spread: float, rng: Random) -> State | None:
        constraints, symbols = self._system.constraints, self._system.symbols
        try:
            if begun is None:
                return Closure(constraints).generic(rng)
            moved = {
                x: begun[x] + fifty_digits().number(spread * rng.uniform(-1, 1)) * (1 + abs(begun[x]))
                for x in symbols.q
            }
            moved |= {
                u: begun[u] + fifty_digits().number(spread * rng.uniform(-1, 1)) * (1 + abs(begun[u]))
                for u in symbols.u
            }
            moved |= {symbols.t: begun[symbols.t] + fifty_digits().number(spread * rng.uniform(0, 1))}
            moved |= {x: fifty_digits().number(spread * rng.uniform(-1, 1)) for x in symbols.inputs.values()}
            return self._closed(begun | moved)
        except (DerivationError, MissingValues, ModelError, NoValue, ZeroDivisionError):
            return None

    def _closed(self, state: State) -> State | None:
        constraints = self._system.constraints
        state = state | self._system.scope.on_unit_norms(state)
        return (
            state
            if all(row.identical for row in constraints.rows)
            else Closure(constraints).closed(state, constraints.movable)
        )

    def _along(self, state: State, step: float) -> Iterator[State]:
        """States along the motion, by the midpoint rule."""
        for _ in range(STEPS):
            middle = self._moved(state, state, step / 2)
            later = None if middle is None else self._moved(state, middle, step)
            if later is None:
                return
            yield (state := later)

    def _soon(self, state: State) -> Iterator[State]:
        """States just after one."""
        for step in (tolerances.SOON, 10 * tolerances.SOON, 100 * tolerances.SOON):
            middle = self._moved(state, state, step / 2)
            later = None if middle is None else self._moved(state, middle, step)
            if later is not None:
                yield later

    def _moved(self, state: State, slopes_at: State, step: float) -> State | None:
        """The state moved on for a while with the rates of another."""
        symbols, scope = self._system.symbols, self._system.scope
        try:
            a = exact_accelerations(self.equations, slopes_at)
            rates = evaluate(scope.rates, slopes_at, fifty_digits())
            later = {x: state[x] + fifty_digits().number(step) * r for x, r in zip(symbols.q, rates, strict=True)}
            later |= {u: state[u] + fifty_digits().number(step) * r for u, r in zip(symbols.u, a, strict=True)}
            later[symbols.t] = state[symbols.t] + fifty_digits().number(step)
            known = state | later
            own = {x: self._system.inputs[name] for name, x in symbols.inputs.items()}
            return known | dict(zip(own, evaluate(tuple(own.values()), known, fifty_digits()), strict=True))
        except (NoValue, ZeroDivisionError, ArithmeticError, DerivationError):
            return None

    def _beside(self, state: State, rng: Random) -> Iterator[State]:
        """States in the pieces next to one, over every switch."""
        moving = moving_symbols(self._system)
        shaken = state | {u: state[u] + fifty_digits().number(rng.uniform(-0.5, 0.5)) for u in self._system.symbols.u}
        for switch in self._switches:
            try:
                targets = switch.targets(state)
                now = switch.piece(state)
            except (NoValue, ZeroDivisionError):
                continue
            for k in _spread(len(targets)):
                if k == now:
                    continue
                for target in targets[k]:
                    found = self._entered(switch, shaken, target, moving)
                    if found is not None:
                        yield found

    def _entered(self, switch: Switch, state: State, target: Any, moving: frozenset[Node]) -> State | None:
        try:
            found = switch.moved(state, target, moving)
            return None if found is None else self._closed(found)
        except (NoValue, ZeroDivisionError):
            return None

    @cached_property
    def _switches(self) -> tuple[Switch, ...]:
        return switches_of(self.scalars, moving_symbols(self._system))


def _spread(count: int) -> list[int]:
    """Indices of at most MOST_OF_ONE of `count` pieces, evenly spread, with the first and the last."""
    many = min(count, MOST_OF_ONE)
    return sorted({round(i * (count - 1) / (many - 1)) for i in range(many)}) if many > 1 else [0]


# -------- jumps -----------------------------------------------------------------------------------------------
# Forces, a state -> True if a force jumps there: dry friction that is written as -c*sign(x'), where nothing slides.
#
# At rest such a force may have any value in between, and the equations of motion do not say if it holds.


@dataclass(frozen=True)
class ForceJumps:
    """Forces of a system that jump with the sign of a rate."""

    system: System
    SMOOTH: ClassVar[str] = (
        "tanh(w/eps) in place of sign(w) runs, and creeps where dry friction sticks: the slower, the smaller eps is"
    )

    @property
    def signs(self) -> tuple[Scalar, ...]:
        """Arguments of sign(...) in the forces that depend on speeds."""
        found, system = self.system.found, self.system
        if ForceJumps not in found:
            given = [node.args[0] for node in order(system.loads.generalized_forces) if node.op == "sign"]
            found[ForceJumps] = tuple(x for x in given if depends_on(x, system.symbols.u))
        signs: tuple[Scalar, ...] = found[ForceJumps]
        return signs

    def refuse(self, state: Mapping[Node, Any]) -> None:
        """Refuse a state at which a force jumps.

        Raises:
            DerivationError: the rate is 0 there, with the values that parameters and inputs have.
        """
        signs, system = self.signs, self.system
        known = system.scope.model.exact_parameters() if signs else {}
        inputs = {node: system.inputs[name] for name, node in system.symbols.inputs.items()}
        values = {system.symbols.parameters[name]: Fraction(x) for name, x in known.items()}
        for x in signs:
            (there,) = substituted(substituted(substituted((x,), inputs), state), values)
            if is_zero(there) or vanishes(there):
                what = f"a force jumps with the sign of {to_text(x)}, which is 0 there: dry friction may hold it or not"
                raise DerivationError(what, fix=self.SMOOTH)
