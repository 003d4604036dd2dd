"""Forces and couples -> what they do to every body: moment about the ground's origin and force, in numbers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.bodies.loads import in_ground_axes
from eomgen.model.forces.load import Couple, PointForce
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import ZERO, Numbers, cross, dot, plus, times, vector_of
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50

Pushes = dict[str, tuple[Numbers, Numbers]]
"""Of each body (moment about the ground's origin, force), ground axes."""


def pushes_of(motion: Motion, state: State, loads: Iterable[Any]) -> Pushes:
    """By what loads and rows say; what acts at no place is none."""
    found: Pushes = {}
    for load in loads:
        if isinstance(load, PointForce):
            scalars = (*motion.position(load.place), *in_ground_axes(motion, load.force, load.axes))
            values = evaluate(scalars, state, fifty_digits())
            add_push(found, load.place[0], cross(vector_of(values[:3]), vector_of(values[3:])), vector_of(values[3:]))
        elif isinstance(load, Couple):
            couple = evaluate(in_ground_axes(motion, load.couple, load.axes), state, fifty_digits())
            add_push(found, load.body, vector_of(couple), ZERO)
    return found


def add_push(pushes: Pushes, body: str | None, moment: Numbers, force: Numbers) -> None:
    """One more push; the ground bears all."""
    if body is not None:
        tau, f = pushes.get(body, (ZERO, ZERO))
        pushes[body] = plus(tau, moment), plus(f, force)


def pushed_otherwise(found: Pushes, due: Pushes, size: Any) -> str:
    """The first body that is pushed otherwise than is due, where forces times arms are of some size; ""."""
    nothing = (ZERO, ZERO)
    for body in dict.fromkeys((*found, *due)):
        pairs = zip(found.get(body, nothing), due.get(body, nothing), strict=True)
        apart: list[Any] = [x - y for a, b in pairs for x, y in zip(a, b, strict=True)]
        if any(abs(x) > ZERO_AT_50 * size for x in apart):
            return body
    return ""


def direction_at(v: Numbers) -> Numbers:
    """v over its length.

    Raises:
        NoValue: it has none.
    """
    size = fifty_digits().functions["sqrt"](dot(v, v))
    if size == 0:
        raise NoValue("two points at one place have no line")
    return times(1 / size, v)
