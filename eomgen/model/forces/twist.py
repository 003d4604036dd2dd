"""The angle of one body against another, or against the ground, and couples that act on it."""

from __future__ import annotations

from collections.abc import Callable

from eomgen.model.forces.load import Couple, Load
from eomgen.symbolic.expression.spatial import AnyScalar


def relative(bodies: tuple[str, ...] | None, body: str | None, of: Callable[[str], AnyScalar]) -> AnyScalar:
    """An angle, or its rate, of the second body against the first; of `body` alone against the ground."""
    if bodies is None:
        assert body is not None
        return of(body)
    return of(bodies[1]) - of(bodies[0])


def turned(bodies: tuple[str, ...] | None, body: str | None, couple: AnyScalar) -> tuple[Load, ...]:
    """A couple about z on the second body and its opposite on the first; on `body` alone [N m]."""
    if bodies is None:
        assert body is not None
        return (Couple(body, (0, 0, couple)),)
    return (Couple(bodies[1], (0, 0, couple)), Couple(bodies[0], (0, 0, -couple)))
