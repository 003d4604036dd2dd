"""Which bodies a function of masses is asked of, and whether enough is known of them."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import name_at
from eomgen.model.outputs.context import OutputContext
from eomgen.symbolic.expression.expressions import Call


def bodies_from(scene: OutputContext, call: Call, first: int) -> tuple[str, ...]:
    """The bodies from the argument `first` on; without any, all of them."""
    named = tuple(name_at(call, k) for k in range(first, len(call.args)))
    if len(set(named)) < len(named):
        raise DerivationError(f"'{call}' names a body twice", mend="name each once")
    if "ground" in named:
        raise DerivationError(f"'{call}': the ground has no mass", mend="name bodies")
    return named or scene.bodies


def refuse_unknown(scene: OutputContext, call: Call, bodies: Sequence[str], *, about_z: bool) -> None:
    """What is asked must be known of the bodies.

    Args:
        about_z: the moments about z are enough.
    Raises:
        DerivationError: naming a body of which it is not known.
    """
    if unknown := scene.without_inertia(bodies):
        raise DerivationError(
            f"'{call}': body '{unknown[0]}' has a mass and no inertia",
            f"bodies.{unknown[0]}",
            "give 'inertia' (0 for a point), or a shape",
        )
    if not about_z and (unknown := scene.known_about_z(bodies)):
        what = f"'{call}': of body '{unknown[0]}' only the moment about z is known, its 'inertia'"
        raise DerivationError(what, f"bodies.{unknown[0]}", "give it a shape, or parts")
