"""Model -> the kinds in it that are read and checked but that this version does not derive yet."""

from eomgen.model.parts import Model


def unbuilt(model: Model) -> tuple[tuple[str, str], ...]:
    """(where, kind) of every joint, tie, force and table that waits for a later version, in the model's order."""
    return (*unbuilt_bodies(model), *unbuilt_ties(model), *_unbuilt_forces(model))


def unbuilt_bodies(model: Model) -> tuple[tuple[str, str], ...]:
    """Joints among them."""
    waiting = []
    for name, body in model.bodies.items():
        if body.joint is not None and not body.joint.works_in(model.space):
            waiting.append((f"bodies.{name}.joint", f"{body.joint.kind} joint"))
    return tuple(waiting)


def unbuilt_ties(model: Model) -> tuple[tuple[str, str], ...]:
    """Constraints among them: what cannot be counted in the degrees of freedom."""
    ties = model.constraints.items()
    return tuple((f"constraints.{name}", tie.kind) for name, tie in ties if not tie.works_in(model.space))


def _unbuilt_forces(model: Model) -> tuple[tuple[str, str], ...]:
    return tuple((f"forces.{name}", force.kind) for name, force in model.forces.items() if not force.works)
