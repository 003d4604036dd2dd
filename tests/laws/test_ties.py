"""Ties against the textbook: what they let move, and the forces that they carry, signs included."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from moving import at, moved, rate, solved, state_of, written

import eomgen
from eomgen.mechanics.system import System, system_of
from eomgen.symbolic.evaluation import evaluate, fifty_digits
from eomgen.symbolic.graph import Scalar

m, g, R, l = 2.0, 10.0, 0.5, 0.7  # the parameters of every model here
GIVEN = {"m": m, "g": g, "R": R, "l": l}
HEAD = """
[parameters]
m = 2
g = 10
R = 0.5
l = 0.7
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def system_with(text: str, **coordinates: object) -> System:
    """The parameters, the weight, the coordinates with their starts, and the text."""
    starts = "\n".join(f"{name} = {start}" for name, start in coordinates.items())
    return written(f"{HEAD}\n[coordinates]\n{starts}\n{text}")


def block(name: str, x: str, y: str, angle: str, mass: str = "m") -> str:
    """A body with inertia m l^2 that is free in the plane, its coordinates named, with a point P beside its centre."""
    return f"""
[bodies.{name}]
mass = "{mass}"
inertia = "m*l^2"
points = {{ P = ["-l", 0] }}
joint = {{ kind = "free", x = "{x}", y = "{y}", angle = "{angle}" }}
"""


def particle(name: str, x: str, y: str, mass: str = "m") -> str:
    shape = f'shape = {{ kind = "particle", mass = "{mass}" }}'
    return f'[bodies.{name}]\n{shape}\njoint = {{ kind = "placed", at = ["{x}", "{y}"] }}\n'


def disc(name: str, joint: str, mass: str = "m", radius: str = "R") -> str:
    return f'[bodies.{name}]\nshape = {{ kind = "disc", mass = "{mass}", radius = "{radius}" }}\njoint = {{ {joint} }}\n'


def tie(kind: str, fields: str, name: str = "tie") -> str:
    return f'[constraints.{name}]\nkind = "{kind}"\n{fields}\n'


def accelerations(system: System, **values: float) -> tuple[dict[str, float], dict[str, float]]:
    """Accelerations by the names of the coordinates and multipliers by their labels, at a state."""
    a, lam = solved(system, GIVEN | values)
    names = [q.name for q in system.symbols.q]
    return dict(zip(names, a, strict=True)), {r.label[4:-1]: x for r, x in zip(system.ties.closing, lam, strict=True)}


def test_a_wire_holds_the_weight_that_hangs_on_it():
    """At rest T = m g > 0; with speed v at the lowest point T = m (g + v^2/l)."""
    system = system_with("[points]\nO = [0, 0]\n" + particle("bob", "x", "y")
                         + tie("link", 'points = ["O", "bob.origin"]'), x=0, y='"-l"')  # fmt: skip
    at_rest, lam = accelerations(system, y=-l)
    assert lam["tie, 1"] == pytest.approx(m * g) and at_rest == pytest.approx({"x": 0, "y": 0})
    with_speed, lam = accelerations(system, y=-l, **{"x'": 3})
    assert lam["tie, 1"] == pytest.approx(m * (g + 9 / l)) and with_speed["y"] == pytest.approx(9 / l)


@pytest.mark.parametrize("ends", ['["O", "bob.origin"]', '["bob.origin", "O"]'])
def test_a_strut_is_pressed_whichever_end_is_named_first(ends):
    """A rod that holds a weight from below has T = - m g."""
    system = system_with("[points]\nO = [0, 0]\n" + particle("bob", "x", "y")
                         + tie("link", f'points = {ends}\nlength = "l"'), x=0, y='"l"')  # fmt: skip
    assert accelerations(system, y=l)[1]["tie, 1"] == pytest.approx(-m * g)


def test_a_link_without_a_length_at_the_start_is_refused():
    """Its length would be the distance at the start, which is 0."""
    with pytest.raises(eomgen.ModelError, match=r"'O' and 'bob.origin' are at one place at the start") as caught:
        system_with("[points]\nO = [0, 0]\n" + particle("bob", "x", "y")
                    + tie("link", 'points = ["O", "bob.origin"]'), x=0, y=0)  # fmt: skip
    assert caught.value.problems[0].where == "constraints.tie" and "length" in caught.value.problems[0].mend


def test_a_clamp_carries_the_weight_and_its_moment():
    """Built in at P, left of the mass centre by l: R_y = m g, couple m g l counter-clockwise on the body."""
    system = system_with(block("beam", "x", "y", "a") + tie("clamp", 'point = "beam.P"'), x=1, y=2, a=0)
    _, lam = accelerations(system, x=1, y=2)
    assert list(lam.values()) == pytest.approx([0, m * g, m * g * l])
    assert [row.component for row in system.ties.rows] == ["x", "y", "couple"]


def test_a_weld_of_two_bodies_acts_on_the_first_named():
    """One beam built in, a second welded to it at its P: the second's weight and moment pass through the weld."""
    bodies = block("beam", "x", "y", "a") + block("other", "z", "r", "b")
    system = system_with(bodies + tie("clamp", 'point = "beam.P"', "wall")
                         + tie("clamp", 'points = ["beam.origin", "other.P"]', "weld"), x=0, y=0, a=0, z='"l"', r=0, b=0)  # fmt: skip
    _, lam = accelerations(system, z=l)
    assert list(lam.values()) == pytest.approx([0, 2 * m * g, 3 * m * g * l, 0, -m * g, -m * g * l])


def test_a_guide_lets_a_body_slide_without_turning():
    """Along a slope of 3:4 it slides down with g 3/5; N = 4/5 m g, and the couple takes the moment of N about C."""
    system = system_with(block("sled", "x", "y", "a") + tie("guide", 'point = "sled.P"\nalong = [4, 3]'), x=0, y=0, a=0)
    a, lam = accelerations(system)
    assert [a["x"], a["y"], a["a"]] == pytest.approx([-g * 3 / 5 * 4 / 5, -g * 3 / 5 * 3 / 5, 0])
    N = m * g * 4 / 5
    assert list(lam.values()) == pytest.approx([N, N * 4 / 5 * l])  # M + (P - C) x N = 0
    assert [row.component for row in system.ties.rows] == ["n", "couple"]


COLLAR = '[bodies.bar]\nmass = "m"\ninertia = 1\npoints = { A = [0, "l"], B = ["2*l", "l"] }\nline = ["A", "B"]\n'


def test_a_collar_on_a_turning_bar_is_carried_with_coriolis_force():
    """On a bar driven with w: N = 2 m r' w + m g cos(angle), to the left of A -> B, on the collar."""
    text = COLLAR.replace('"l"]', "0]") + 'joint = { kind = "revolute", angle = "2*t" }\n'
    system = system_with(text + particle("collar", "x", "y") + tie("slider", 'point = "collar.origin"\non = "bar"'),
                         x=1, y=0)  # fmt: skip
    a, lam = accelerations(system, x=1, **{"x'": 0.3, "y'": 2.0})  # r' = 0.3, on the line: y' = w r
    assert lam["tie, 1"] == pytest.approx(m * g + 2 * m * 0.3 * 2)
    assert a["x"] == pytest.approx(0)  # r'' - r w^2 = 0 in turning axes


def test_a_point_of_the_ground_pushes_the_bar_that_slides_over_it():
    """A free bar on a fixed peg below its centre: the peg pushes the bar to the left of A -> B, here up, with m g."""
    bar = COLLAR.replace("[0, \"l\"]", '["-l", 0]').replace('["2*l", "l"]', '["l", 0]')
    bar += 'joint = { kind = "free", x = "x", y = "y", angle = "a" }\n'
    system = system_with("[points]\nG = [0, 0]\n" + bar + tie("slider", 'point = "G"\non = "bar"'), x=0, y=0, a=0)
    a, lam = accelerations(system)
    assert lam["tie, 1"] == pytest.approx(m * g) and a == pytest.approx({"x": 0, "y": 0, "a": 0})


FREE = 'kind = "free", x = "x", y = "y", angle = "a"'


@pytest.mark.parametrize("fixed_in", ["", 'on = "table"\n'])
def test_a_disc_rolls_down_a_slope(fixed_in):
    """a = 2/3 g sin, N = m g cos, friction m g sin / 3 up the slope: against t = n turned clockwise, here downhill."""
    table = '[bodies.table]\nmass = 1\njoint = { kind = "fixed", at = [0, 0] }\n'
    rolls = tie("rolling", f'body = "wheel"\n{fixed_in}line = {{ at = [0, 0], normal = [3, 4] }}')
    system = system_with(table + disc("wheel", FREE) + rolls, x='"R*3/5"', y='"R*4/5"', a=0)
    a, lam = accelerations(system, x=R * 3 / 5, y=R * 4 / 5)
    assert list(lam.values()) == pytest.approx([m * g * 4 / 5, -m * g * 3 / 5 / 3])
    assert a["x"] * 4 / 5 - a["y"] * 3 / 5 == pytest.approx(2 / 3 * g * 3 / 5)
    assert a["a"] == pytest.approx(-2 / 3 * g * 3 / 5 / R)
    assert [(row.component, row.gap is None) for row in system.ties.rows] == [("n", False), ("t", True)]


def test_a_disc_that_slips_keeps_its_spin():
    """slip: the normal row alone, with the direction along which friction would act."""
    slides = tie("rolling", 'body = "wheel"\nline = { at = [0, 0], normal = [3, 4] }\nslip = true')
    system = system_with(disc("wheel", FREE) + slides, x='"R*3/5"', y='"R*4/5"', a=0)
    a, lam = accelerations(system, x=R * 3 / 5, y=R * 4 / 5)
    assert list(lam.values()) == pytest.approx([m * g * 4 / 5]) and a["a"] == pytest.approx(0)
    state = state_of(system)
    speeds = [state[u] for u in system.symbols.u]
    radius = state[system.symbols.parameters["R"]]
    assert at((system.ties.rows[0].sliding,), state)[0] == pytest.approx(
        float(speeds[0] * 4 / 5 - speeds[1] * 3 / 5 + radius * speeds[2]))  # fmt: skip


@pytest.mark.parametrize(("inside", "distance", "spin"), [("false", 2 * l + R, -1), ("true", 2 * l - R, 1)])
def test_a_disc_rolls_on_a_circle_outside_and_inside(inside, distance, spin):
    """(r + R) phi' = R w outside, (r - R) phi' = - R w inside; N pushes it off the circle."""
    rolls = tie("rolling", f'body = "wheel"\ncircle = {{ at = [0, 0], radius = "2*l", inside = {inside} }}')
    system = system_with(disc("wheel", FREE) + rolls, x=0, y=-distance, a=0)
    state = state_of(system) | {q: fifty_digits().number(0) for q in system.symbols.q}
    p = system.symbols.parameters
    state |= {p[name]: fifty_digits().number(1) * value for name, value in GIVEN.items()}
    state[system.symbols.q[1]] = fifty_digits().number(1) * -distance  # below the centre: phi' = x'/distance
    J = np.array([at(row, state) for row in system.ties.J])
    assert J @ [distance, 0, -spin * distance / R] == pytest.approx([0, 0], abs=1e-14)
    a, lam = accelerations(system, y=-distance)
    if inside == "true":
        assert lam["tie, 1"] == pytest.approx(m * g) and a["y"] == pytest.approx(0)  # it lies at the bottom
    else:
        assert lam["tie, 1"] == pytest.approx(-m * g)  # it would have to hang


def test_a_disc_on_a_disc_turns_against_it():
    """Two wheels on fixed axles: R1 w1 = - R2 w2, and the friction of one is minus that of the other."""
    wheels = disc("one", 'kind = "revolute", angle = "a"') + disc("two", 'kind = "revolute", at = ["3*R", 0], angle = "b"',
                                                                   radius="2*R")  # fmt: skip
    system = system_with(wheels + tie("rolling", 'body = "two"\non = "one"'), a=0, b=0)
    normal, along = system.ties.rows
    assert normal.identical and not along.identical
    (J,) = (at(row, state_of(system)) for row in system.ties.J)
    assert J[0] / J[1] == pytest.approx(1 / 2)


def test_a_hoop_that_moves_carries_the_disc_inside_it():
    """Contact velocities are those of the bodies' material points, by differences of poses with the point frozen."""
    hoop = disc("hoop", 'kind = "planar", x = "s", y = "r", angle = "b"', radius="3*R")
    rolls = tie("rolling", 'body = "wheel"\non = "hoop"\ncircle = { at = [0, 0], radius = "3*R", inside = true }')
    system = system_with(hoop + disc("wheel", FREE) + rolls, x=0, y='"-2*R"', a=0, s=0, r=0, b=0)
    state = state_of(system)
    centers = [at(system.motion.link(body).pose.p, state) for body in ("hoop", "wheel")]
    radius = float(state[system.symbols.parameters["R"]])
    n = (centers[0] - centers[1]) / (2 * radius)
    touch = centers[1] - radius * n
    v = [frozen_velocity(system, body, touch, state) for body in ("wheel", "hoop")]
    t = np.array([n[1], -n[0], 0])
    rows = at([row.velocity for row in system.ties.rows], state)
    assert rows == pytest.approx([n @ (v[0] - v[1]), t @ (v[0] - v[1])], rel=1e-12)


def frozen_velocity(system: System, body: str | None, place: np.ndarray, state) -> np.ndarray:
    """Velocity of the material point of a body that is at a place of the ground, by differences of poses."""
    if body is None:
        return np.zeros(3)
    pose = system.motion.link(body).pose
    flat = [*pose.p, *(x for line in pose.R for x in line)]
    values = at(flat, state)
    p, turned = values[:3], values[3:].reshape(3, 3)
    rates = rate(system, flat, state)
    return rates[:3] + rates[3:].reshape(3, 3) @ (turned.T @ (place - p))


AXLE = 'kind = "revolute", angle = "a"'


@pytest.mark.parametrize("strands", ['\nstrands = ["up", "down"]', ""])
def test_a_massive_pulley_has_different_tensions_on_its_sides(strands):
    """ch18-p1: 2 m and m over a disc of 6 m: the heavy side descends with g/6, T = 5/3 m g and 7/6 m g."""
    system = system_with(
        disc("pulley", AXLE, "6*m") + particle("P", "-R", "p", "2*m") + particle("Q", "R", "q")
        + tie("string", 'path = ["P.origin", { body = "pulley", turn = "cw" }, "Q.origin"]' + strands),
        p=-1, q=-2, a=0,
    )  # fmt: skip
    a, lam = accelerations(system, p=-1, q=-2)
    assert a == pytest.approx({"p": -g / 6, "q": g / 6, "a": g / 6 / R})
    assert list(lam.values()) == pytest.approx([5 / 3 * m * g, 7 / 6 * m * g])
    assert [row.component for row in system.ties.rows] == ["tension", "tension"]


def test_a_string_that_slips_has_one_tension_and_leaves_the_pulley_at_rest():
    """Atwood's machine over a smooth drum: a = g/3, T = 4/3 m g."""
    system = system_with(
        disc("pulley", AXLE, "6*m") + particle("P", "-R", "p", "2*m") + particle("Q", "R", "q")
        + tie("string", 'path = ["P.origin", { body = "pulley", turn = "cw", slip = true }, "Q.origin"]'),
        p=-1, q=-2, a=0,
    )  # fmt: skip
    a, lam = accelerations(system, p=-1, q=-2)
    assert a == pytest.approx({"p": -g / 3, "q": g / 3, "a": 0}) and list(lam.values()) == pytest.approx([4 / 3 * m * g])
    assert system.scope.model.constraints["tie"].strand_rows() == (1, 1)


def test_a_disc_unrolls_from_a_string():
    """ch20-p1: a_C = 2g/3, T = m g / 3; the string leaves it on its left."""
    text = "[points]\nA = [0, 0]\n" + disc("spool", FREE)
    path = 'path = ["A", { body = "spool", turn = "ccw" }]\nstrands = ["down"]'
    system = system_with(text + tie("string", path), x='"R"', y=-1, a=0)
    a, lam = accelerations(system, x=R, y=-1)
    assert a == pytest.approx({"x": 0, "y": -2 / 3 * g, "a": -2 / 3 * g / R}, abs=1e-12)
    assert lam == pytest.approx({"tie, 1": m * g / 3, "tie, 2": 0}, abs=1e-12)
    assert [row.component for row in system.ties.rows] == ["tension", "n"]  # the strand stays vertical: no pendulum


def test_a_disc_hangs_in_a_loop_of_two_drums():
    """ch20-p3: a_P = g/14, phi'' = 5g/7R, tensions 13/14 m g and 5/7 m g, the disc falls with 9g/14."""
    system = system_with(
        disc("drum", AXLE, "6*m", "2*R") + particle("P", "-2*R", "p")
        + disc("C", 'kind = "placed", at = ["3*R", "c"], angle = "b"', "2*m")
        + tie("string", 'path = ["P.origin", { body = "drum", turn = "cw" }, { body = "C", turn = "ccw" }]\n'
                        'strands = ["up", "down"]'),
        p=-1, c=-3, a=0, b=0,
    )  # fmt: skip
    a, lam = accelerations(system, p=-1, c=-3)
    assert a["a"] == pytest.approx(g / (28 * R)) and a["b"] == pytest.approx(-5 / 7 * g / R)
    assert (a["p"], a["c"]) == pytest.approx((-g / 14, -9 / 14 * g))
    assert list(lam.values()) == pytest.approx([13 / 14 * m * g, 5 / 7 * m * g])


def test_a_stepped_drum_lifts_a_disc_in_the_loop():
    """ch22-p4: as the drum turns by 1 clockwise, P sinks by 2 R, the disc rises by R/2 and turns by 1/2."""
    system = system_with(
        '[points]\nceiling = ["-3*R", 0]\n'
        + '[bodies.drum]\nmass = "4*m"\ninertia = "6*m*R^2"\njoint = { kind = "revolute", angle = "a" }\n'
        + particle("P", "2*R", "p", "4*m")
        + disc("C", 'kind = "placed", at = ["-2*R", "c"], angle = "b"', "2*m")
        + tie("string", 'path = [{ body = "drum", radius = "2*R", turn = "cw" }, "P.origin"]', "outer")
        + tie("string", 'path = [{ body = "drum", radius = "R", turn = "ccw" }, { body = "C", turn = "cw" }, "ceiling"]\n'
                        'strands = ["down", "up"]', "inner"),
        a=0, p=-1, c=-1, b=0,
    )  # fmt: skip
    J = np.array([at(row, state_of(system)) for row in system.ties.J])
    radius = float(state_of(system)[system.symbols.parameters["R"]])
    assert J @ [-1, -2 * radius, radius / 2, 0.5] == pytest.approx([0, 0, 0], abs=1e-13)
    assert np.linalg.matrix_rank(J) == 3


def test_a_pulley_that_a_body_carries_doubles_the_force():
    """A load 3 m hangs in a smooth loop, m on the free end: a_load = (3 - 2) g / (3 + 4), one tension through all."""
    system = system_with(
        '[points]\nceiling = ["-2*R", 0]\n'
        + disc("hook", 'kind = "placed", at = ["-R", "y"]', "3*m") + particle("Q", "2*R", "q")
        + tie("string", 'path = ["ceiling", { body = "hook", turn = "ccw", slip = true }, '
                        '{ at = ["R", 0], radius = "R", turn = "cw", slip = true }, "Q.origin"]\n'
                        'strands = ["down", "up", "down"]'),
        y=-1, q=-1,
    )  # fmt: skip
    a, lam = accelerations(system, y=-1, q=-1)
    assert (a["y"], a["q"]) == pytest.approx((-g / 7, 2 * g / 7))
    assert list(lam.values()) == pytest.approx([m * (g + 2 * g / 7)])


def test_a_string_over_a_peg_gives_way_as_its_other_side_grows():
    """ch18-p5: a bar's end A, a smooth peg, a weight below it: y_Q = y_peg - (L - |A - peg|), exactly, with a gap."""
    bar = '[bodies.bar]\nshape = { kind = "rod", mass = "3*m", length = "2*l" }\n'
    bar += 'joint = { kind = "revolute", angle = "a" }\n'
    rope = tie("string", 'path = ["bar.end", { at = [0, "2*l"], radius = 0, turn = "cw", slip = true }, "Q.origin"]')
    system = system_with(bar + particle("Q", "0", "y") + rope, a=0.3, y='"-l"')
    (row,) = system.ties.rows
    state = state_of(system)
    angle, y, length = (state[s] for s in (*system.symbols.q, system.symbols.parameters["l"]))
    used = 2 * length * (2 * (1 - fifty_digits().functions["sin"](angle))) ** 0.5 + 2 * length - y
    start = 2 * length * (2 * (1 - fifty_digits().functions["sin"](fifty_digits().number(3) / 10))) ** 0.5 + 3 * length
    assert at((row.gap,), state)[0] == pytest.approx(float(start - used), rel=1e-12)


ROPES = {
    "two points, a smooth wheel": '["P.P", { body = "wheel", turn = "cw", slip = true }, "Q.P"]',
    "crossed, open, crossed": '["P.P", { body = "wheel", turn = "ccw", slip = true }, '
                              '{ body = "pulley", turn = "cw", slip = true }, "Q.P"]',
    "wheel, peg": '["G", { body = "wheel", turn = "cw", slip = true }, '
                  '{ at = [9, 8], radius = "R", turn = "cw", slip = true }, "Q.P"]',
    "no slip": '["P.P", { body = "wheel", turn = "cw" }, { body = "pulley", turn = "ccw" }, "Q.P"]',
    "wound at both ends": '[{ body = "wheel", turn = "ccw" }, { body = "pulley", turn = "cw" }]',
    "a peg between": '[{ body = "wheel", turn = "cw" }, { at = [9, 8], radius = "R", turn = "cw", slip = true }, "Q.P"]',
}  # fmt: skip
MOVERS = (
    "[points]\nG = [-5, 7]\n"
    + block("P", "x", "y", "a") + block("Q", "z", "r", "b")
    + disc("wheel", 'kind = "planar", x = "s", y = "5 + d", angle = "e"')
    + disc("pulley", 'kind = "planar", x = "7 + c", y = "k", angle = "h"', radius="R/3")
)  # fmt: skip
STARTS = dict.fromkeys("xyazrbsdeckh", 0.1) | {"x": -6, "z": 12}


def numbers(system: System, x: Scalar, state):
    return evaluate((x,), state, fifty_digits())[0]


def stops_of(system: System, state) -> list[tuple]:
    """(body, centre as a complex number, signed offset, slips) of every item of the path, at 50 digits."""
    found = []
    for item in system.scope.model.constraints["tie"].path:
        if isinstance(item, str):
            place, offset = system.motion.place(item), 0
        else:
            place = (item.body, (0, 0, 0)) if item.body else (None, system.scope.vector(item.at))
            shape = item.radius if item.radius is not None else system.scope.model.bodies[item.body].shape.radius
            offset = numbers(system, system.scope.value(shape), state) * (1 if item.turn == "cw" else -1)
        x, y, _ = (numbers(system, c, state) for c in system.motion.position(place))
        found.append((place[0], x, y, offset))
    return found


def tangents(stops: list[tuple]) -> list[tuple]:
    """(angle of travel, length) of every strand: sin(alpha - delta) = h / |D|, by angles alone."""
    f = fifty_digits().functions
    found = []
    for (_, x1, y1, a1), (_, x2, y2, a2) in zip(stops, stops[1:], strict=False):
        span = f["sqrt"]((x2 - x1) ** 2 + (y2 - y1) ** 2)
        delta = f["atan2"](y2 - y1, x2 - x1) - f["asin"]((a1 - a2) / span)
        found.append((delta, span * f["cos"](f["asin"]((a1 - a2) / span))))
    return found


def near_the_start(system: System):
    """A state near the start, at speeds of order 1."""
    state = state_of(system)
    by_name = {q.name: q for q in system.symbols.q}
    state |= {by_name[name]: fifty_digits().number(1) * value + state[by_name[name]] / 20 for name, value in STARTS.items()}
    p = system.symbols.parameters
    return state | {p[name]: fifty_digits().number(1) * value for name, value in GIVEN.items()}


@pytest.mark.parametrize("path", ROPES.values(), ids=list(ROPES))
def test_strands_pull_along_the_common_tangents_of_what_they_touch(path):
    """J u + sigma = d . (v_1 - v_2) of the material points at the tangent points, summed over what slips."""
    system = system_with(MOVERS + tie("string", f"path = {path}"), **STARTS)
    state = near_the_start(system)
    stops = stops_of(system, state)
    expected: dict[int, float] = {}
    numbered = system.scope.model.constraints["tie"].strand_rows()
    for number, (first, second), (delta, _) in zip(numbered, zip(stops, stops[1:], strict=False), tangents(stops), strict=True):
        d = np.array([cos(delta), sin(delta), 0])
        across = np.array([-d[1], d[0], 0])
        v = [frozen_velocity(system, body, np.array([float(x), float(y), 0]) + float(a) * across, state)
             for body, x, y, a in (first, second)]  # fmt: skip
        expected[number] = expected.get(number, 0) + d @ (v[0] - v[1])
    assert at([row.velocity for row in system.ties.rows], state) == pytest.approx(list(expected.values()), rel=1e-11)


@pytest.mark.parametrize("path", [p for p in ROPES.values() if p.count("slip") == p.count("turn")])
def test_the_row_of_a_smooth_string_is_the_rate_of_its_whole_length(path):
    """J u + sigma = - d/dt (straight pieces + r * angle wrapped), by differences of lengths found by angles."""
    system = system_with(MOVERS + tie("string", f"path = {path}"), **STARTS)
    state = near_the_start(system)
    h = fifty_digits().number(1) / 10**15
    late, early = (whole_length(system, moved(system, state, sign * h)) for sign in (1, -1))
    (row,) = system.ties.rows
    assert at((row.velocity,), state)[0] == pytest.approx(float((early - late) / (2 * h)), rel=1e-12)


def whole_length(system: System, state):
    stops = stops_of(system, state)
    ways = tangents(stops)
    total = sum(length for _, length in ways)
    for (_, _, _, offset), (before, _), (after, _) in zip(stops[1:], ways, ways[1:], strict=False):
        total += offset * (before - after)  # clockwise the heading falls
    return total


def test_a_strand_that_is_said_to_stay_vertical_forbids_the_pendulum():
    """A load on a vertical strand cannot swing: the strand's own row, and one across it with no force at rest."""
    text = "[points]\nA = [0, 0]\n" + particle("P", "x", "y")
    system = system_with(text + tie("string", 'path = ["A", "P.origin"]\nstrands = ["down"]'), x=0, y=-1)
    a, lam = accelerations(system, y=-1)
    assert lam == pytest.approx({"tie, 1": m * g, "tie, 2": 0}) and a == pytest.approx({"x": 0, "y": 0})


BESIDE = "[points]\nA = [0, 0]\n" + particle("P", "R", "y")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('path = ["A", "P.origin"]\nstrands = ["down"]', "between the ground and 'P' cannot have the direction given"),
        ('path = [{ at = [0, 0], radius = "R", turn = "cw" }, "P.origin"]\nstrands = ["up"]', "runs against the direction"),
        ('path = [{ at = ["R", -1], radius = "2*R", turn = "cw" }, "P.origin"]', "there is no straight strand between"),
    ],
)
def test_a_strand_that_cannot_be_is_refused_by_name(text, message):
    """Where, what, and a mend."""
    with pytest.raises(eomgen.ModelError, match=message) as caught:
        system_with(BESIDE + tie("string", text), y=-1)
    assert caught.value.problems[0].where == "constraints.tie" and caught.value.problems[0].mend


@pytest.mark.parametrize(
    ("kind", "fields", "message"),
    [
        ("string", 'path = ["A", { at = [1, 0], radius = 0, turn = "cw", slip = true }, "O"]', "has nothing on it"),
        ("string", 'path = ["bar.start", "bar.end"]', "has nothing on it"),
        ("string", 'path = [{ body = "wheel", turn = "cw", slip = true }, "bar.end"]', "where it cannot slip"),
        ("link", 'points = ["bar.start", "bar.end"]', "joins body 'bar' to itself"),
        ("link", 'points = ["A", "O"]', "joins the ground to itself"),
        ("pin", 'points = ["bar.end", "bar.end"]', "joins body 'bar' to itself"),
        ("clamp", 'point = "A"', "holds 'A', a point of the ground"),
        ("gear", 'bodies = ["bar", "bar"]\nratio = 2', "gears body 'bar' with itself"),
        ("slider", 'point = "bar.end"\non = "bar"', "on the body along which it should slide"),
        ("rolling", 'body = "wheel"\non = "bar"', "rolls on body 'bar', which is not round"),
        ("rolling", 'body = "wheel"\nline = { at = [0, 0], normal = [0, 0] }', "direction cannot be zero"),
        ("rolling", 'body = "wheel"\non = "bar"\nline = { at = "A", normal = [0, 1] }', "a point of the ground, but the track"),
        ("rolling", 'body = "wheel"\nline = { at = [0, 0], normal = [0, 1] }\naxis = [0, 0, 1]', "is for space"),
        ("support", 'point = "bar.end"', "has no 'normal'"),
        ("skate", 'point = "bar.end"\nalong = [0, 0]', "direction cannot be zero"),
    ],
)
def test_a_tie_that_ties_nothing_is_refused_when_it_is_read(kind, fields, message):
    """Exit 1 with the place, before anything is derived."""
    bar = '[bodies.bar]\nshape = { kind = "rod", mass = "m", length = "l" }\nline = ["start", "end"]\n'
    bar += 'joint = { kind = "revolute", angle = "a" }\n'
    text = "[points]\nA = [0, 0]\nO = [2, 0]\n" + bar + disc("wheel", 'kind = "revolute", at = [3, 0], angle = "b"')
    with pytest.raises(eomgen.ModelError, match=message):
        system_with(text + tie(kind, fields), a=0, b=0)


def test_a_disc_does_not_roll_in_a_circle_of_its_own_size():
    """r = R leaves no room: D = r - R = 0."""
    with pytest.raises(eomgen.ModelError, match="as large as the circle"):
        system_with(disc("wheel", FREE) + tie("rolling", 'body = "wheel"\ncircle = { at = [0, 0], radius = "R", inside = true }'),
                    x=0, y=0, a=0)  # fmt: skip


def test_gears_share_their_couple_in_the_ratio():
    """w1 = ratio w2: a couple lam on the first, - ratio lam on the second, J^T lam of an ideal transmission."""
    wheels = disc("one", AXLE) + disc("two", 'kind = "revolute", at = [3, 0], angle = "b", torque = 6')
    system = system_with(wheels + tie("gear", 'bodies = ["one", "two"]\nratio = -3'), a=0, b=0)
    a, lam = accelerations(system)
    assert a["a"] == pytest.approx(-3 * a["b"])
    inertia = m * R * R / 2
    assert lam["tie, 1"] == pytest.approx(inertia * a["a"]) and 6 + 3 * lam["tie, 1"] == pytest.approx(inertia * a["b"])


def test_a_driven_coordinate_needs_its_driving_force():
    """x = l sin(w t) by a tie: lam = m x'' along x."""
    cart = '[bodies.cart]\nmass = "m"\njoint = { kind = "prismatic", axis = [1, 0], displacement = "x" }\n'
    system = system_with(cart + tie("motion", 'coordinate = "x"\nvalue = "l*t^2"'), x=0)
    a, lam = accelerations(system)
    assert (a["x"], lam["tie, 1"]) == pytest.approx((2 * l, 2 * m * l))


def test_a_blade_lets_go_along_itself_and_holds_across():
    """Chaplygin's sleigh, blade at the centre: N = m v w to the left where it runs ahead and turns left, w' = 0."""
    system = system_with(block("sled", "x", "y", "a") + tie("skate", 'point = "sled.origin"\nalong = [1, 0]'), x=0, y=0, a=0)
    a, lam = accelerations(system, **{"g": 0, "x'": 3, "a'": 2})
    assert lam["tie, 1"] == pytest.approx(m * 3 * 2) and a == pytest.approx({"x": 0, "y": 6, "a": 0})


PATH = """
[bodies.P]
shape = { kind = "particle", mass = "m" }
joint = { kind = "path", along = "s", at = [1, 2], heading = "-pi/6", pieces = [
    { name = "plane", line = 5 }, { arc = "R", turn = "ccw", angle = "2*pi/3" }, { arc = "l", turn = "cw", angle = 1 }] }
"""


def position(joint, s: float) -> np.ndarray:
    """Where a path is at s, in floats."""
    value = {**GIVEN, "pi": pi}
    return np.array(joint.pose((s,), lambda e: e.evaluate(value)).p, dtype=float)


def test_a_path_goes_on_without_corner_and_with_unit_speed():
    """p and the heading are continuous where pieces meet; |dp/ds| = 1."""
    joint = system_with(PATH, s=0).scope.model.bodies["P"].joint
    ends = [float(end.evaluate({**GIVEN, "pi": pi})) for _, end in joint.bounds()]
    assert ends == pytest.approx([5, 5 + R * 2 * pi / 3, 5 + R * 2 * pi / 3 + l])
    for s in (*ends, 1.0, 5.3):
        before, here, after = (position(joint, s + d) for d in (-1e-6, 0, 1e-6))
        assert np.linalg.norm(after - here) == pytest.approx(1e-6, rel=1e-6)
        assert (after - here) @ (here - before) == pytest.approx(1e-12, rel=1e-5)
    assert position(joint, ends[1])[:2] == pytest.approx(  # plane down 30 degrees, then a quarter and 30 degrees to the left
        [5 * cos(pi / 6) + R * (sin(pi / 2) + sin(pi / 6)), -5 * sin(pi / 6) + R * cos(pi / 6)])  # fmt: skip


@pytest.mark.parametrize("number", [0, 1, 2])
def test_one_piece_of_a_path_is_the_path_there(number):
    """piece(k) has the whole path's place and direction between its bounds, with `along` counted from its beginning."""
    joint = system_with(PATH, s=0).scope.model.bodies["P"].joint
    value = {**GIVEN, "pi": pi}
    low, high = (float(x.evaluate(value)) for x in joint.bounds()[number])
    piece = joint.piece(number)
    for s in (low + 1e-9, (low + high) / 2, high - 1e-9):
        own = float(piece.along.evaluate({**value, "s": s}))
        assert own == pytest.approx(s - low)
        assert position(piece, own) == pytest.approx(position(joint, s))


def test_a_bead_on_an_arc_is_pushed_to_its_centre():
    """N = m v^2/R + the weight's share: at the lowest point of a quarter to the left, 1/m J^T lam is v^2/R upward."""
    arc = PATH.replace("-pi/6", "-pi/2").replace('{ name = "plane", line = 5 }, ', "").replace(
        ', { arc = "l", turn = "cw", angle = 1 }', "")  # fmt: skip
    system = system_with(arc, s=0)
    state = {x: fifty_digits().number(0) for x in (*system.symbols.q, *system.symbols.u, system.symbols.t)}
    state |= {system.symbols.parameters[name]: fifty_digits().number(1) * value for name, value in GIVEN.items()}
    state[system.symbols.q[0]], state[system.symbols.u[0]] = fifty_digits().functions["pi"]() / 2 * R, 3
    motion = system.scope.time_derivative(system.scope.time_derivative(system.motion.link("P").pose.p))
    assert at(motion, state) == pytest.approx([0, 9 / R, 0], abs=1e-12)
    W = system.motion.link("P").joint.complement(system.motion.link("P").s, system.scope.value)
    assert at(W[0], state) == pytest.approx([0, 0, 0, 0, 1, 0], abs=1e-12)  # the left normal of travel comes first
