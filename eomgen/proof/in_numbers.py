"""System, state -> scalars, vectors, forces on bodies and rates in numbers: 50 digits, ground axes, differences.

q(t +- h) = q +- h q' + h^2 q''/2,   u +- h u',   t +- h;     x' = (x+ - x-)/2h,   x'' = (x+ - 2 x + x-)/h^2
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import Motion
from eomgen.model import Couple, PointForce, in_order
from eomgen.symbolic.expression import Graph, Matrix, Scalar, State, Vector
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

SAMPLES = "times of samples"
STEP = fifty_digits().number(1) / 10**15  # of a central difference, whose error is its square
FINER_STEP = STEP / 10**4  # where the way bends sharply
SECOND_STEP = fifty_digits().number(1) / 10**12  # [s] of first and second differences: both are sure to 20 digits


def direction_at(v: Vector) -> Vector:
    """v over its length.

    Raises:
        NoValue: it has none.
    """
    size = fifty_digits().functions["sqrt"](v @ v)
    if size == 0:
        raise NoValue("a direction of length 0")
    unit: Vector = v * (1 / size)
    return unit


def with_inputs(system: System, known: State) -> State:
    """A state with those of the model's inputs that it does not give."""
    own = {node: system.inputs[name] for name, node in system.symbols.inputs.items() if node not in known}
    return {**known, **dict(zip(own, evaluate(tuple(own.values()), known, fifty_digits()), strict=True))}


def declared_state_rates(system: System, known: State) -> dict[str, Any]:
    """{state: z'} of the states of first order at a state with its accelerations, by the file's own texts.

    Each name in a text is put in as a number, the rate of another state by its own text: nothing of the system's graph
    stands between.
    """
    names = system.scope.names
    laws = {f"{name}'": part.rate for name, part in system.scope.model.states.items()}
    standing = frozenset[str]().union(*(law.names for law in laws.values())) - {"pi"}
    needed = tuple(standing & names.keys() - laws.keys())
    graph, digits = Graph(), fifty_digits()
    own = {name: graph.symbol(name) for name in standing}
    values = dict(zip((own[x] for x in needed), evaluate([names[x] for x in needed], known, digits), strict=True))
    found: dict[str, Any] = {}
    for name in in_order(laws)[0]:
        scalar = laws[name].evaluate({**own, "pi": graph.pi})
        found[name[:-1]] = evaluate((scalar,), values, digits)[0]
        if name in own:
            values[own[name]] = found[name[:-1]]
    return {name: found[name] for name in system.scope.model.states}


def mass_that_enters(system: System, known: State, body: str) -> Any:
    """Mass that enters a body per second by flows that do not say it: the rate of its mass less what is said of others.

    That rate is a central difference of the declared mass, along t and the states of first order.
    """
    scope, symbols, digits = system.scope, system.symbols, fifty_digits()
    moving = declared_state_rates(system, known)
    steps = {symbols.t: 1, **{z: moving[z.name] for z in symbols.z}}
    ways = [{x: known[x] + h * rate for x, rate in steps.items()} for h in (-STEP, STEP)]
    m = scope.mass_properties(body).m
    early, late = (evaluate((m,), {**known, **way}, digits)[0] for way in ways)
    said = (force.flow for force in scope.model.forces.values())
    others = [scope.value(x[1]) for x in said if x is not None and x[0] == body and x[1] is not None]
    return (late - early) / (2 * STEP) - sum(evaluate(others, known, digits), start=0)


@dataclass(frozen=True)
class InNumbers:
    """System at a state; its quantities have a value there, or NoValue is raised."""

    system: System
    state: State

    @property
    def motion(self) -> Motion:
        return self.system.motion

    def at(self, scalars: Sequence[Scalar]) -> list[Any]:
        return evaluate(tuple(scalars), self.state, fifty_digits())

    def one(self, x: Scalar) -> Any:
        return self.at((x,))[0]

    def vector(self, v: Sequence[Scalar]) -> Vector:
        return Vector(self.at(v))

    def carried(self, body: str | None, place: Vector, *, direction: bool = False) -> Vector:
        """Place or direction of a body in ground axes."""
        if body is None:
            return place
        R, p = self._stand(body)
        turned = R @ place
        return turned if direction else p + turned

    @cached_property
    def _stands(self) -> dict[str, tuple[Matrix, Vector]]:
        return {}

    def _stand(self, body: str) -> tuple[Matrix, Vector]:
        """R and p of a body, worked once."""
        if body not in self._stands:
            pose = self.motion.link(body).pose
            own = self.at([*(x for row in pose.R for x in row), *pose.p])
            self._stands[body] = Matrix.of((own[0:3], own[3:6], own[6:9])), Vector(own[9:12])
        return self._stands[body]

    def velocity(self, body: str | None, P: Vector) -> Vector:
        """Velocity of the material point of a body at P: R (v + w x R^T (P - p))."""
        if body is None:
            return Vector.ZERO
        (R, p), twist = self._stand(body), self.motion.link(body).twist
        own = self.at((*twist.w, *twist.v))
        w, v = Vector(own[:3]), Vector(own[3:])
        return R @ (v + w.cross(R.T @ (P - p)))


Pushes = dict[str, tuple[Vector, Vector]]
"""(moment about the ground's origin, force) on each body, in ground axes."""


def pushes_of(motion: Motion, state: State, loads: Iterable[Any]) -> Pushes:
    """Wrench of each load and row on each body; a load without a place is left out."""
    found: Pushes = {}
    for load in loads:
        if isinstance(load, PointForce):
            scalars = (*motion.position(load.place), *motion.in_ground_axes(load.force, load.axes))
            values = evaluate(scalars, state, fifty_digits())
            add_push(found, load.place[0], Vector(values[:3]).cross(Vector(values[3:])), Vector(values[3:]))
        elif isinstance(load, Couple):
            couple = evaluate(motion.in_ground_axes(load.couple, load.axes), state, fifty_digits())
            add_push(found, load.body, Vector(couple), Vector.ZERO)
    return found


def add_push(pushes: Pushes, body: str | None, moment: Vector, force: Vector) -> None:
    """One more push; the ground bears all."""
    if body is not None:
        tau, f = pushes.get(body, (Vector.ZERO, Vector.ZERO))
        pushes[body] = tau + moment, f + force


def pushed_otherwise(found: Pushes, due: Pushes, size: Any) -> str:
    """First body on which a wrench differs from the due one, relative to the size of forces times arms; ""."""
    nothing = (Vector.ZERO, Vector.ZERO)
    for body in dict.fromkeys((*found, *due)):
        pairs = zip(found.get(body, nothing), due.get(body, nothing), strict=True)
        apart: list[Any] = [x - y for a, b in pairs for x, y in zip(a, b, strict=True)]
        if any(abs(x) > tolerances.ZERO_AT_50 * size for x in apart):
            return body
    return ""


@dataclass(frozen=True)
class Way:
    """The states of a motion a step h before an instant, at it, and a step after.

    Args:
        side: 1 or -1: at it, and one, two and three steps after or before, where a given function has a corner there.
    """

    states: tuple[State, ...]
    h: Any
    side: int = 0

    @property
    def now(self) -> State:
        return self.states[0 if self.side else 1]

    def along(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """(values, rates, second rates), these of a way to second order."""
        if self.side:
            return self._beside(scalars)
        early, now, late = (evaluate(tuple(scalars), state, fifty_digits()) for state in self.states)
        second = [(a - 2 * x + b) / self.h**2 for a, x, b in zip(early, now, late, strict=True)]
        return now, [(b - a) / (2 * self.h) for a, b in zip(early, late, strict=True)], second

    def _beside(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """The same to second order by values on one side: (-3 f0 + 4 f1 - f2)/2h, (2 f0 - 5 f1 + 4 f2 - f3)/h^2."""
        found = [evaluate(tuple(scalars), state, fifty_digits()) for state in self.states]
        rates = [self.side * (4 * b - 3 * a - c) / (2 * self.h) for a, b, c, _ in zip(*found, strict=True)]
        second = [(2 * a - 5 * b + 4 * c - d) / self.h**2 for a, b, c, d in zip(*found, strict=True)]
        return found[0], rates, second

    def rates(self, scalars: Sequence[Scalar]) -> list[Any]:
        if self.side:
            return self._beside(scalars)[1]
        early, late = (evaluate(tuple(scalars), state, fifty_digits()) for state in self.states[::2])
        return [(b - a) / (2 * self.h) for a, b in zip(early, late, strict=True)]


def way_through(system: System, state: State, h: Any = STEP, *, order: int = 1) -> Way:
    """Motion through a state with given accelerations, to first or second order in q."""
    symbols, scope = system.symbols, system.scope
    first = evaluate(scope.rates, state, fifty_digits())
    second = evaluate(scope.with_accelerations(scope.rates), state, fifty_digits()) if order == 2 else [0] * len(first)

    def later(t: Any) -> State:
        moved = {q: state[q] + t * v + t * t / 2 * a for q, v, a in zip(symbols.q, first, second, strict=True)}
        moved |= {u: state[u] + t * state[a] for u, a in zip(symbols.u, symbols.a, strict=True) if a in state}
        return {**state, **moved, symbols.t: state[symbols.t] + t}

    if side := _side(system, state):
        return Way(tuple(later(side * k * h) for k in range(4)), h, side)
    return Way((later(-h), state, later(h)), h)


def _times_of_samples(system: System) -> set[tuple[Any, ...]]:
    """Times of the samples of each function that is given by samples."""
    if SAMPLES not in system.found:
        system.found[SAMPLES] = {given.times for _, _, given in system.scope.model.given_samples}
    found: set[tuple[Any, ...]] = system.found[SAMPLES]
    return found


def instant_of(system: System, t: float) -> Any:
    """A time of doubles with 50 digits; that of a sample where it is the double next to it.

    0.3 is less than 3/10: read as it stands it would lie before the sample at which code takes the piece after.
    """
    number = fifty_digits().number
    at = (number(x) for times in _times_of_samples(system) for x in times if float(x) == t)
    return next(at, number(t))


def _side(system: System, state: State) -> int:
    """1 or -1 at the first or last sample of a given function, to differentiate inside the samples; 0 elsewhere."""
    t, knots = state.get(system.symbols.t, 0), _times_of_samples(system)
    if not any(abs(x - t) < tolerances.ZERO_AT_50 for times in knots for x in map(fifty_digits().number, times)):
        return 0
    return -1 if any(abs(fifty_digits().number(times[-1]) - t) < tolerances.ZERO_AT_50 for times in knots) else 1
