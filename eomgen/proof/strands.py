"""System, state -> whether strings and links run and pull as they are declared, in numbers.

    D = c_2 - c_1,   h = a_1 - a_2:   d is D turned by - asin(h / |D|) about n,   touching at c + a n x d

a is the radius where one travels round clockwise about n, minus the radius counter-clockwise, 0 of a point. A unit of
tension pulls + d where a strand begins and - d where it ends, through eyelets and what slips in the strands beyond; the
string stays as long as it is, - sum d . (v_2 - v_1) = 0 of the material that it touches; a link is as long as it says.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import Any

from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.constraints.meeting import Thread
from eomgen.proof.in_numbers import InNumbers, Pushes, add_push, direction_at, pushed_otherwise, pushes_of
from eomgen.proof.states import refuse_open
from eomgen.records import dataclass
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Numbers, Vector, cross, dot, minus, plus, times, vector_of
from eomgen.symbolic.numeric.evaluation import NoValue, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, ZERO_AT_50


def threads_of(system: System) -> dict[str, Thread]:
    """What runs straight from point to point, by its tie, where that is closed."""
    closed = {row.tie for row in system.ties.rows}
    threads = {name: tie.thread() for name, tie in system.scope.model.constraints.items() if name in closed}
    return {name: thread for name, thread in threads.items() if thread is not None}


def strung_otherwise(system: System, state: State) -> str:
    """Which string or link runs or pulls otherwise than it is declared; "" where none does.

    Raises:
        NoValue: something has no value there, or the ties do not hold.
    """
    refuse_open(system, state)
    for name, thread in threads_of(system).items():
        if wrong := _Strung(system, state, name, thread).wrong:
            return f"'{name}' {wrong}"
    return ""


@dataclass(frozen=True)
class _Stop:
    """Where a thread is led: its place over the graph; the centre, a (0 of a point) and the axis in numbers."""

    body: str | None
    place: Vector
    center: Numbers
    a: Any
    axis: Numbers
    passes: bool

    def touched(self, d: Numbers) -> Numbers:
        return plus(self.center, times(self.a, cross(self.axis, d)))


@dataclass(frozen=True)
class _Strung(InNumbers):
    name: str
    thread: Thread

    @property
    def wrong(self) -> str:
        rows = [row for row in self.system.ties.rows if row.tie == self.name and row.component == "tension"]
        if len(rows) != len(self._ropes):
            return f"has {len(rows)} tensions for {len(self._ropes)}"
        for row, rope in zip(rows, self._ropes, strict=True):
            due: Pushes = {}
            for first, second, d in rope:
                add_push(due, first.body, cross(first.touched(d), d), d)
                add_push(due, second.body, cross(second.touched(d), times(-1, d)), times(-1, d))
            size = 1 + max(abs(x) for first, *_ in rope for x in first.center)
            stated = pushes_of(self.motion, self.state, row.pushes)
            if body := pushed_otherwise(stated, due, size):
                return f"pulls '{body}' otherwise than it runs"
            given_out: Any = sum((self._lengthening(*strand) for strand in rope), start=0)
            if self._rigid and row.pushes and abs(given_out + self.one(row.velocity)) > ZERO_AT_50 * size:
                return "does not stay as long as it is"
        return self._wrong_length

    @property
    def _wrong_length(self) -> str:
        """Of what says how long it is."""
        if self.thread.length is None:
            return ""
        declared = self.one(self._scene.value(self.thread.length))
        first, second = (stop.center for stop in self._stops)
        apart: Numbers = minus(second, first)
        square: Any = dot(apart, apart)
        wrong = abs(square - declared**2) > COMPUTED * (1 + square)
        return f"is {float(square) ** 0.5:.10g} long for {float(declared):.10g}" if wrong else ""

    @cached_property
    def _ropes(self) -> list[list[tuple[_Stop, _Stop, Numbers]]]:
        """The strands of one tension each: (from, to, direction)."""
        ways = self.thread.ways or (None,) * (len(self._stops) - 1)
        ropes: list[list[tuple[_Stop, _Stop, Numbers]]] = []
        for (first, second), way in zip(pairwise(self._stops), ways, strict=True):
            strand = (first, second, self._direction(first, second) if way is None else self._typed(way))
            if ropes and first.passes:
                ropes[-1].append(strand)
            else:
                ropes.append([strand])
        return ropes

    def _direction(self, first: _Stop, second: _Stop) -> Numbers:
        """Of the line that touches both."""
        D: Numbers = minus(second.center, first.center)
        self._refuse_turned_over(first, second, D)
        along = direction_at(D)
        n = first.axis if first.a != 0 else second.axis
        same: Any = dot(n, second.axis)
        offset: Any = first.a - (same if second.a != 0 else 0) * second.a
        distance: Any = dot(D, along)
        if abs(offset) > distance:
            raise NoValue("one wrap lies within the other")
        functions = fifty_digits().functions
        lean = -functions["asin"](offset / distance)
        return plus(times(functions["cos"](lean), along), times(functions["sin"](lean), cross(n, along)))

    def _refuse_turned_over(self, first: _Stop, second: _Stop, D: Numbers) -> None:
        """Raises NoValue where a strand runs backwards: a line along an axis has the sense that it has at the start."""
        at_start = [self._scene.worth(x) for x in minus(second.place, first.place)]
        if sum(float(x) * (y or 0.0) for x, y in zip(D, at_start, strict=True)) < 0:
            raise NoValue("a strand runs the other way than at the start")

    def _typed(self, way: Any) -> Numbers:
        """A direction that is given, of length 1."""
        named = {"up": (0, 1, 0), "down": (0, -1, 0), "left": (-1, 0, 0), "right": (1, 0, 0)}
        return self.vector(named[way]) if isinstance(way, str) else direction_at(self.vector(self._scene.vector(way)))

    def _lengthening(self, first: _Stop, second: _Stop, d: Numbers) -> Any:
        """d . (v_2 - v_1) of what it touches."""
        return dot(d, minus(*(self.velocity(stop.body, stop.touched(d)) for stop in (second, first))))

    # -- as it is declared -----------------------------------------------------------------------------------

    @cached_property
    def _scene(self) -> SystemScene:
        return SystemScene(self.motion, f"constraints.{self.name}")

    @cached_property
    def _stops(self) -> list[_Stop]:
        return list(self._declared())

    def _declared(self) -> Iterator[_Stop]:
        scene, z = self._scene, self.vector((0, 0, 1))
        for item in self.thread.stops:
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
                axis = vector_of(dot(self.vector(row), axis) for row in scene.orientation(item.body))
            a = self.one(radius)
            yield _Stop(item.body, r, self.vector(r), -a if item.turn == "ccw" else a, axis, bool(item.slip))

    @property
    def _rigid(self) -> bool:
        """Whether it is led over places that are fixed in their bodies."""
        named = [self._scene.place(item) for item in self.thread.stops if isinstance(item, str)]
        named += [self._scene.own_place(x.body, None) for x in self.thread.stops if not isinstance(x, str) and x.body]
        return not any(self.motion.moves(place) for _, place in named)
