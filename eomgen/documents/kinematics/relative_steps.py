"""Composition -> the steps about the motion of a point on a moving body, and of a particle in a moving frame.

v = v_t + v_r,   a = a_t + a_r + a_C;      m a_r = F - m a_t - m a_C
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eomgen.documents.bounded import tabled
from eomgen.documents.motion_steps import axes
from eomgen.documents.statements import Grid, Law, Prose, Statement, Step, prose
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.loads import body_wrench, joint_wrenches, weights
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.relative_motion import composition_of
from eomgen.mechanics.instant.body_motion import Readable, readable_at
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, dot, plus, times, transposed
from eomgen.symbolic.print.text import to_text

VELOCITY = Law("v = v_t + v_r, v_t = v_O + omega x r", r"v = v_{t} + v_{r}, \quad v_{t} = v_{O} + \omega \times r")
ACCELERATION = Law(
    "a = a_t + a_r + a_C, a_t = a_O + epsilon x r + omega x (omega x r), a_C = 2*omega x v_r",
    r"a = a_{t} + a_{r} + a_{C}, \quad a_{t} = a_{O} + \varepsilon \times r + \omega \times (\omega \times r), \quad "
    r"a_{C} = 2 \omega \times v_{r}",
)
IN_FRAME = Law("m*a_r = F - m*a_t - m*a_C", r"m a_{r} = F - m a_{t} - m a_{C}")

NAMES = {
    "transport_velocity": Law("v_t", "v_{t}"),
    "relative_velocity": Law("v_r", "v_{r}"),
    "velocity": Law("v", "v"),
    "origin": Law("a_O", "a_{O}"),
    "euler": Law("epsilon x r", r"\varepsilon \times r"),
    "centripetal": Law("omega x (omega x r)", r"\omega \times (\omega \times r)"),
    "transport_acceleration": Law("a_t", "a_{t}"),
    "relative_acceleration": Law("a_r", "a_{r}"),
    "coriolis": Law("a_C", "a_{C}"),
    "acceleration": Law("a", "a"),
}
FORCES = {"m*a_r": Law("m*a_r", "m a_{r}"), "-m*a_O": Law("-m*a_O", "-m a_{O}")}
VELOCITIES = ("transport_velocity", "relative_velocity", "velocity")
ACCELERATIONS = (
    "origin",
    "euler",
    "centripetal",
    "transport_acceleration",
    "relative_acceleration",
    "coriolis",
    "acceleration",
)
TRANSPORT = "the transport part is that of the point of the body which is passed, O the origin of the body"


def relative_steps(system: System, point: str, body: str, state: Mapping[Node, Scalar]) -> tuple[Step, ...]:
    """The motion of a point in its parts, seen from a body, and a particle's equation of motion in the body's frame.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {}: as functions of them.
    """
    readable, letters = readable_at(system, state), axes(system)
    parts = velocity_parts(system, point, body, readable)
    title = f"{point}, seen from {body}"
    steps = (
        Step(
            "relative velocity",
            f"Velocity of {title}",
            (
                prose(f"In the axes of {body}, ", VELOCITY, f"; {TRANSPORT}:"),
                *_table(parts, VELOCITIES, letters, readable),
            ),
        ),
        Step(
            "relative acceleration",
            f"Acceleration of {title}",
            (
                prose(f"In the axes of {body}, ", ACCELERATION, ":"),
                *_table(parts, ACCELERATIONS, letters, readable),
            ),
        ),
    )
    owner, _ = system.motion.place(point)
    return (*steps, *_in_frame(system, str(owner), body, readable)) if _is_particle(system, owner, point) else steps


def relative_payload(system: System, point: str, body: str, state: Mapping[Node, Scalar]) -> dict[str, Any]:
    """The parts as texts, axes of the body."""
    parts = velocity_parts(system, point, body, readable_at(system, state))
    return {"point": point, "body": body, **{name: [to_text(x) for x in vector] for name, vector in parts.items()}}


def velocity_parts(system: System, point: str, body: str, readable: Readable) -> dict[str, Vector]:
    """The parts of velocity and acceleration by name, axes of the body, readable."""
    parts = composition_of(system.motion, point, body)
    own = {"relative_velocity": parts.relative[1], "relative_acceleration": parts.relative[2]}
    ground = {name: getattr(parts, name) for name in NAMES if name != "origin"} | {"origin": parts.carrier.a}
    seen = {name: apply(transposed(parts.R), x) for name, x in ground.items()} | own
    return {name: readable.vector(seen[name]) for name in NAMES}


def _table(
    parts: Mapping[str, Vector], names: tuple[str, ...], letters: str, readable: Readable
) -> tuple[Statement, ...]:
    """The components and the magnitude of each part; beside one another where there is room."""
    sizes = {name: readable.scalar(sqrt(dot(parts[name], parts[name]))) for name in names}
    together = tabled(("", *letters, "magnitude"), [(NAMES[n], *parts[n][: len(letters)], sizes[n]) for n in names])
    if isinstance(together[0], Grid):
        return together
    components = tabled(("", *letters), [(NAMES[n], *parts[n][: len(letters)]) for n in names])
    return (*components, *tabled(("", "magnitude"), [(NAMES[n], sizes[n]) for n in names]))


# -- a particle in a moving frame ------------------------------------------------------------------


def _is_particle(system: System, owner: str | None, point: str) -> bool:
    """Whether the point is the mass centre of a particle of the model."""
    part = None if owner is None else system.scope.model.bodies.get(owner)
    if part is None or part.shape is None or not part.shape.is_point:
        return False
    return point.endswith((".center", ".origin")) and not is_zero(mass_properties(system.scope, str(owner)).m)


def _in_frame(system: System, particle: str, body: str, readable: Readable) -> tuple[Step, ...]:
    """m a_r = F - m a_t - m a_C in the axes of the body; F: what is applied, and reactions."""
    parts = composition_of(system.motion, f"{particle}.origin", body)
    m, letters = mass_properties(system.scope, particle).m, axes(system)
    ground = {
        "applied": applied_force(system, particle),
        "-m*a_O": times(-m, parts.carrier.a),
        "Euler": times(-m, parts.euler),
        "centrifugal": times(-m, parts.centripetal),
        "Coriolis": times(-m, parts.coriolis),
    }
    forces = {"m*a_r": times(m, parts.relative[2])}
    forces |= {name: apply(transposed(parts.R), x) for name, x in ground.items()}
    rows = [(FORCES.get(name, name), *readable.vector(x)[: len(letters)]) for name, x in forces.items()]
    words = (
        f"In the axes of {body}, ",
        IN_FRAME,
        ": F is what is applied, and the reactions of joints and ties; "
        "of the rest, transport brings the Euler and the centrifugal force.",
    )
    statements: tuple[Statement, ...] = (Prose(words), *tabled(("force", *letters), rows))
    return (Step("moving frame", f"Equation of motion of {particle} in the frame of {body}", statements),)


def applied_force(system: System, body: str) -> Vector:
    """The sum of what is applied to a body, drives and springs of its joint included, ground axes."""
    motion, loads = system.motion, system.loads
    found = [body_wrench(motion, load) for load in (*loads.placed, *weights(loads))]
    found += [pair for effort in loads.efforts for pair in joint_wrenches(motion, effort)]
    total: Vector = ZERO
    for each in found:
        if each is not None and each[0] == body:
            total = plus(total, each[1].f)
    return apply(motion.link(body).pose.R, total)
