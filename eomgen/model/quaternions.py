"""Model -> its unit quaternions: the four coordinates and the three speeds of each."""

from eomgen.model.parts import Model
from eomgen.records import dataclass


@dataclass(frozen=True)
class Quaternion:
    """How one body turns against its parent.

    Args:
        body: its name.
        coordinates: e0, e1, e2, e3.
        speeds: its angular velocity against the parent, its own axes.
    """

    body: str
    coordinates: tuple[str, ...]
    speeds: tuple[str, ...]


def quaternions_of(model: Model) -> tuple[Quaternion, ...]:
    """Of every joint that turns by one, in the model's order."""
    joints = ((name, body.joint) for name, body in model.bodies.items() if body.joint is not None)
    return tuple(
        Quaternion(name, tuple(e.text for e in joint.turns()), joint.spins) for name, joint in joints if joint.spins
    )
