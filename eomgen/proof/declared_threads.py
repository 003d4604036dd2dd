"""Strings, links and elastic ropes at a state -> whether they run and pull as they are declared, in numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import SystemScene
from eomgen.model import Act
from eomgen.proof.states import InNumbers, Pushes, add_push, direction_at, pushed_otherwise, pushes_of, refuse_open
from eomgen.symbolic.expression import Fraction, State, Vector
from eomgen.symbolic.numeric import NoValue, fifty_digits, tolerances

STRUNG = "strings and links touch their guides, keep their length and pull along it"

# -------- strands ---------------------------------------------------------------------------------------------
# System, state -> whether strings and links run and pull as they are declared, in numbers.
#
#     D = c_2 - c_1,   h = a_1 - a_2:   d is D turned by - asin(h / |D|) about n,   touching at c + a n x d
#
# a is the radius where one travels round clockwise about n, minus the radius counter-clockwise, 0 of a point. A unit
# of tension pulls + d where a strand begins and - d where it ends, through eyelets and what slips in the strands
# beyond; the string stays as long as it is, - sum d . (v_2 - v_1) = 0 of the material that it touches; a link is as
# long as it says.


def has_threads(system: System) -> bool:
    """True if a string or link is closed."""
    return any(True for _ in _threads(system, {}))


def _threads(system: System, state: State) -> Iterator[_Strung]:
    """Strings and links that are closed, at a state."""
    closed = {row.constraint for row in system.constraints.rows}
    for name, constraint in system.scope.model.constraints.items():
        thread = constraint.thread() if name in closed else None
        if thread is not None:
            yield _Strung(system, state, name, thread.stops, thread.ways, thread.length)


def strung_otherwise(system: System, state: State) -> str:
    """Message that names a string or link which runs or pulls otherwise than it is declared; "".

    Raises:
        NoValue: something has no value there, or the constraints do not hold.
    """
    refuse_open(system, state)
    for strung in _threads(system, state):
        if wrong := strung.wrong:
            return f"'{strung.name}' {wrong}"
    return ""


@dataclass(frozen=True)
class _Stop:
    """Stop of a thread: its place over the graph; the centre, the radius a (0 for a point) and the axis in numbers."""

    body: str | None
    place: Vector
    center: Vector
    a: Any
    axis: Vector
    passes: bool

    def touched(self, d: Vector) -> Vector:
        touched: Vector = self.center + self.axis.cross(d) * self.a
        return touched


@dataclass(frozen=True)
class _Strung(InNumbers):
    """A string, link or rope along its stops; of a string directions of strands, of a link its length may be given."""

    name: str
    stops: tuple[Any, ...]
    ways: tuple[Any, ...] | None = None
    length: Any = None

    @property
    def wrong(self) -> str:
        rows = [
            row for row in self.system.constraints.rows if row.constraint == self.name and row.component == "tension"
        ]
        if len(rows) != len(self._ropes):
            return f"has {len(rows)} tensions for {len(self._ropes)}"
        for row, rope in zip(rows, self._ropes, strict=True):
            due: Pushes = {}
            for first, second, d in rope:
                add_push(due, first.body, first.touched(d).cross(d), d)
                add_push(due, second.body, second.touched(d).cross(-d), -d)
            size = 1 + max(first.center.largest for first, *_ in rope)
            stated = pushes_of(self.motion, self.state, row.pushes)
            if body := pushed_otherwise(stated, due, size):
                return f"pulls '{body}' otherwise than it runs"
            given_out: Any = sum((self._lengthening(*strand) for strand in rope), start=-self._paid_out)
            if self._rigid and row.pushes and abs(given_out + self.one(row.velocity)) > tolerances.ZERO_AT_50 * size:
                return "does not stay as long as it is"
        return self._wrong_length

    @property
    def _paid_out(self) -> Any:
        """Rate of the declared length, by the difference of two instants."""
        if self.length is None:
            return 0
        length, t = self._scene.value(self.length), self.system.symbols.t
        step = fifty_digits().number(Fraction(1, 10**15))
        before, after = (
            replace(self, state={**self.state, t: self.one(t) + sign * step}).one(length) for sign in (-1, 1)
        )
        return (after - before) / (2 * step)

    @property
    def _wrong_length(self) -> str:
        """Message if the length is not the declared one; ""."""
        if self.length is None:
            return ""
        declared = self.one(self._scene.value(self.length))
        first, second = (stop.center for stop in self._stops)
        apart: Vector = second - first
        square: Any = apart @ apart
        wrong = abs(square - declared**2) > tolerances.COMPUTED * (1 + square)
        return f"is {float(square) ** 0.5:.10g} long for {float(declared):.10g}" if wrong else ""

    @property
    def strands(self) -> list[tuple[_Stop, _Stop, Vector]]:
        """All strands: (from, to, direction)."""
        return [strand for rope in self._ropes for strand in rope]

    @property
    def reach(self) -> Any:
        """sum d . (r_2 - r_1) + a_1 theta_1 - a_2 theta_2 of all strands, theta the turns of the drums in the plane."""
        found: Any = 0
        for first, second, d in self.strands:
            found += d @ (second.touched(d) - first.touched(d)) + self._wound(first) - self._wound(second)
        return found

    def _wound(self, stop: _Stop) -> Any:
        return 0 if stop.a == 0 or stop.body is None else stop.a * self.one(self._scene.angle(stop.body))

    @property
    def given_out(self) -> Any:
        """Rate of that, by the material that the strands touch, less the rate of the declared length."""
        return sum((self._lengthening(*strand) for strand in self.strands), start=-self._paid_out)

    @cached_property
    def _ropes(self) -> list[list[tuple[_Stop, _Stop, Vector]]]:
        """The strands of one tension each: (from, to, direction)."""
        ways = self.ways or (None,) * (len(self._stops) - 1)
        ropes: list[list[tuple[_Stop, _Stop, Vector]]] = []
        for (first, second), way in zip(pairwise(self._stops), ways, strict=True):
            strand = (first, second, self._direction(first, second) if way is None else self._typed(way))
            if ropes and first.passes:
                ropes[-1].append(strand)
            else:
                ropes.append([strand])
        return ropes

    def _direction(self, first: _Stop, second: _Stop) -> Vector:
        """Direction of the line that is tangent to both stops."""
        D: Vector = second.center - first.center
        self._refuse_turned_over(first, second, D)
        along = direction_at(D)
        n = first.axis if first.a != 0 else second.axis
        same: Any = n @ second.axis
        offset: Any = first.a - (same if second.a != 0 else 0) * second.a
        distance: Any = D @ along
        if abs(offset) > distance:
            raise NoValue("one wrap lies within the other")
        functions = fifty_digits().functions
        lean = -functions["asin"](offset / distance)
        direction: Vector = along * functions["cos"](lean) + n.cross(along) * functions["sin"](lean)
        return direction

    def _refuse_turned_over(self, first: _Stop, second: _Stop, D: Vector) -> None:
        """Raises NoValue where a strand runs backwards: a line along an axis has the sense that it has at the start."""
        at_start = [self._scene.value_at_start(x) for x in second.place - first.place]
        here: list[Any] = list(D)
        if sum(float(x) * (y or 0.0) for x, y in zip(here, at_start, strict=True)) < 0:
            raise NoValue("a strand runs the other way than at the start")

    def _typed(self, way: Any) -> Vector:
        """A direction that is given, of length 1."""
        named = {"up": (0, 1, 0), "down": (0, -1, 0), "left": (-1, 0, 0), "right": (1, 0, 0)}
        return self.vector(named[way]) if isinstance(way, str) else direction_at(self.vector(self._scene.vector(way)))

    def _lengthening(self, first: _Stop, second: _Stop, d: Vector) -> Any:
        """Relative velocity d . (v_2 - v_1) of the two surfaces."""
        return d @ (self.velocity(second.body, second.touched(d)) - self.velocity(first.body, first.touched(d)))

    # -- as it is declared -----------------------------------------------------------------------------------

    @property
    def _scene(self) -> SystemScene:
        return SystemScene(self.motion, f"constraints.{self.name}")

    @cached_property
    def _stops(self) -> list[_Stop]:
        return list(self._declared())

    def _declared(self) -> Iterator[_Stop]:
        scene, z = self._scene, self.vector((0, 0, 1))
        for item in self.stops:
            if isinstance(item, str):
                body, _ = place = scene.place(item)
                r = scene.position(place)
                yield _Stop(body, r, self.vector(r), 0, z, True)
                continue
            fixed = item.body is None
            r = scene.ground_place(item.at) if fixed else scene.position(scene.own_place(item.body, None))
            radius = scene.radius(item.body) if item.radius is None else scene.value(item.radius)
            axis = z if item.axis is None else direction_at(self.vector(scene.vector(item.axis)))
            if not (fixed or scene.plane):
                axis = Vector(self.vector(row) @ axis for row in scene.orientation(item.body))
            a = self.one(radius)
            yield _Stop(item.body, r, self.vector(r), -a if item.turn == "ccw" else a, axis, bool(item.slip))

    @property
    def _rigid(self) -> bool:
        """True if all stops are fixed in their bodies."""
        named = [self._scene.place(item) for item in self.stops if isinstance(item, str)]
        named += [self._scene.own_place(x.body, None) for x in self.stops if not isinstance(x, str) and x.body]
        return not any(self.motion.moves(place) for _, place in named)


# -------- ropes -----------------------------------------------------------------------------------------------
# An elastic rope at a state -> its tension on what it leaves and reaches: strands as those of strings, and
#
#     s = sum d . (r_2 - r_1) + a_1 theta_1 - a_2 theta_2 - l_0,   s' by the material that it touches


@dataclass(frozen=True)
class RopeInNumbers(InNumbers):
    """An elastic rope at a state; `slack` is its length without tension, or "start"."""

    stops: tuple[Any, ...]
    slack: Any

    def pulled(self, tension: Any) -> Iterator[Act]:
        """Forces of a tension at both ends of every strand, on the stops, by their moments where the rope touches."""
        for first, second, d in self._strung.strands:
            for stop, pull in ((first, tension * d), (second, -tension * d)):
                arm = stop.touched(d) - stop.center
                yield Act(stop.body, stop.place, pull, arm.cross(pull))

    @property
    def stretch(self) -> Any:
        begun = isinstance(self.slack, str)
        return self._strung.reach - (self._begun if begun else self.one(self.system.scope.value(self.slack)))

    @property
    def rate(self) -> Any:
        return self._strung.given_out

    @cached_property
    def _strung(self) -> _Strung:
        length = None if isinstance(self.slack, str) else self.slack
        return _Strung(self.system, self.state, "", self.stops, length=length)

    @property
    def _begun(self) -> Any:
        """Length where the motion starts."""
        symbols, scene = self.system.symbols, SystemScene(self.motion, begun=self.system.loads.begun)
        begun = dict(zip(symbols.q, self.at([scene.start(q) for q in symbols.q]), strict=True))
        state = {**self.state, **begun, symbols.t: 0 * self.state[symbols.t]}
        return replace(self._strung, state=state).reach
