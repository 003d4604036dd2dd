"""The steps about the motion of bodies and of points on them: what they say, in every format."""

from __future__ import annotations

from pathlib import Path

import pytest

import eomgen
from eomgen import documents
from eomgen.documents.document import Document
from eomgen.documents.result import ALL as FORMATS
from eomgen.mechanics.instant.motion_kind import Kinds
from eomgen.results.at_instant.result import centrode_panel
from eomgen.results.at_instant.steps import field_payload, field_steps, relative_payload, relative_steps
from eomgen.study import CentrodeCurves, MotionFromStart, Study
from eomgen.symbolic.exact.normal_forms import equal
from eomgen.symbolic.expression.text import parse

TURNTABLE = """
eomgen = 1
space = "plane"
[parameters]
m = 0.2
Omega = 2
g = 9.81
[coordinates]
theta = { rate = "Omega*t" }
x = 0.3
y = 0
[bodies.table]
joint = { kind = "revolute", angle = "theta" }
[bodies.puck]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", on = "table", x = "x", y = "y", angle = 0 }
[forces.push]
kind = "force"
point = "puck.center"
force = [3, 0]
axes = "table"
"""
LADDER = """
eomgen = 1
space = "plane"
parameters = { l = 2 }
coordinates = { theta = 0.3 }
bodies.rod.points = { A = ["l", 0], B = [0, 0] }
bodies.rod.line = ["B", "A"]
bodies.rod.joint = { kind = "placed", at = [0, "l*sin(theta)"], angle = "-theta" }
"""


def rows_of(steps, key: str) -> dict[str, tuple[str, ...]]:
    """The rows of the tables of a step, by their first cells, as text."""
    (step,) = (step for step in documents.json_form.steps(derivation(steps)) if step["key"] == key)
    grids = [statement for statement in step["statements"] if statement["kind"] == "grid"]
    return {row[0]: tuple(row[1:]) for grid in grids for row in grid["rows"]}


def same(phase: Study, *texts: str) -> bool:
    """Whether two texts are one function."""
    first, second = (parse(text).evaluate(phase.system.scope.names) for text in texts)
    return equal(first, second)


def derivation(steps) -> Document:
    return Document("test", "", "", "plane", "kinematics", tuple(steps))


def journey_of(text: str) -> MotionFromStart:
    return MotionFromStart(eomgen.loads(text), False)


def test_forces_of_a_turning_frame_stand_in_its_equation_of_motion():
    """m a_r = F - m epsilon x r - m omega x (omega x r) - 2 m omega x v_r, each in the axes of the table."""
    phase = journey_of(TURNTABLE).phase
    rows = rows_of(relative_steps(phase.system, "puck.center", "table", {}), "moving frame")
    true = {
        "applied": ("3", "0"),
        "Euler": ("m*Omega*y", "-m*Omega*x"),
        "centrifugal": ("m*(Omega*t)^2*x", "m*(Omega*t)^2*y"),
        "Coriolis": ("2*m*Omega*t*y'", "-2*m*Omega*t*x'"),
    }
    for name, row in true.items():
        assert all(same(phase, *pair) for pair in zip(rows[name], row, strict=True)), name


def test_the_moving_frames_equation_is_the_equation_of_motion():
    """Put the accelerations in: m a_r is the sum of the other rows."""
    phase = journey_of(TURNTABLE).phase
    rows = rows_of(relative_steps(phase.system, "puck.center", "table", {}), "moving frame")
    names = phase.system.scope.names
    for axis in range(2):
        left = parse(rows["m*a_r"][axis]).evaluate(names)
        right = sum(parse(row[axis]).evaluate(names) for name, row in rows.items() if name not in ("m*a_r", "force"))
        assert phase.simple(phase.eliminated(left - right)) == 0


def test_parts_of_velocity_add_up_in_the_report():
    """v = v_t + v_r, a = a_t + a_r + a_C as printed."""
    phase = journey_of(TURNTABLE).phase
    found = relative_payload(phase.system, "puck.center", "table", {})
    names = phase.system.scope.names

    def total(*parts: str) -> list:
        columns = zip(*(found[part] for part in parts), strict=True)
        return [phase.simple(sum(parse(x).evaluate(names) for x in column)) for column in columns]

    assert total("velocity") == total("transport_velocity", "relative_velocity")
    assert total("acceleration") == total("transport_acceleration", "relative_acceleration", "coriolis")
    assert total("transport_acceleration") == total("origin", "euler", "centripetal")


def test_the_ladders_field_and_centrodes_are_told():
    """Kind, centre, pole, slowest point; the circles as such."""
    motion = journey_of(LADDER)
    system = motion.phase.system
    kinds = Kinds(system, motion.start)
    text = documents.rendered(derivation(field_steps(system, {}, kinds)), "text")
    assert "rod: plane motion; rotation at this instant." in text
    assert "a circle about (0, 0), radius" in text
    payload = field_payload(system, {}, kinds)["rod"]
    assert payload["at_instant"] == "rotation"
    moving = ("l*cos(theta)^2", "l*cos(theta)*sin(theta)", "0")
    fixed = ("l*cos(theta)", "l*sin(theta)", "0")
    for found, true in ((payload["center"], fixed), (payload["centrodes"]["moving"], moving)):
        assert all(same(motion.phase, *pair) for pair in zip(found, true, strict=True))


@pytest.mark.parametrize("name", [member.name for member in FORMATS])
def test_steps_are_set_in_every_format(name):
    """No format leaves a table or a formula out."""
    motion = journey_of(TURNTABLE)
    system = motion.phase.system
    steps = field_steps(system, {}, Kinds(system, motion.start))
    steps = (*steps, *relative_steps(system, "puck.center", "table", {}))
    shown = documents.rendered(derivation(steps), name)
    assert all(word in shown for word in ("rotation about a fixed axis", "Coriolis", "centrifugal"))


def test_a_centrode_is_drawn_where_the_centre_runs():
    """The fixed one about the corner with the ladder's length as radius; the moving one lies with it at the centre."""
    from matplotlib.figure import Figure

    motion = journey_of(LADDER)
    system = motion.phase.system
    (found,) = Kinds(system, motion.start).centrodes()
    panel = Figure().subplots()
    centrode_panel(panel, CentrodeCurves.of(system, found, {**motion.phase.numeric_parameters, **motion.numbers}))
    fixed, moving, now = (line.get_xydata() for line in panel.get_lines())
    assert abs((fixed**2).sum(axis=1) ** 0.5 - 2).max() < 1e-9
    assert abs(((moving - now / 2) ** 2).sum(axis=1) ** 0.5 - 1).max() < 1e-9


def test_the_radius_of_a_centrode_is_a_short_formula():
    """Of a planet its centrodes are circles: their radii are lengths of vectors whose components are short."""
    text = " ".join(eomgen.kinematics(Path(__file__).parent.parent / "models" / "epicyclic_gear.toml").render().split())
    assert "a circle about (0, 0), radius (a + b)*b*abs(w_arm/(w_arm*a - w_sun*a + w_arm*b))." in text
