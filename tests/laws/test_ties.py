"""Constraints against the textbook: what they let move, and the forces that they carry, signs included."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from constrained import (
    AXLE,
    FREE,
    GIVEN,
    R,
    accelerations,
    block,
    constraint,
    disc,
    frozen_velocity,
    g,
    l,
    m,
    particle,
    system_with,
)
from moving import at, state_of, written

import eomgen
from eomgen.symbolic.numeric.evaluation import fifty_digits


def test_a_wire_holds_the_weight_that_hangs_on_it():
    """At rest T = m g > 0; with speed v at the lowest point T = m (g + v^2/l)."""
    system = system_with(
        "[points]\nO = [0, 0]\n" + particle("bob", "x", "y") + constraint("link", 'points = ["O", "bob.origin"]'),
        x=0,
        y='"-l"',
    )
    at_rest, lam = accelerations(system, y=-l)
    assert lam["constraint, 1"] == pytest.approx(m * g) and at_rest == pytest.approx({"x": 0, "y": 0})
    with_speed, lam = accelerations(system, y=-l, **{"x'": 3})
    assert lam["constraint, 1"] == pytest.approx(m * (g + 9 / l)) and with_speed["y"] == pytest.approx(9 / l)


@pytest.mark.parametrize("ends", ['["O", "bob.origin"]', '["bob.origin", "O"]'])
def test_a_strut_is_pressed_whichever_end_is_named_first(ends):
    """A rod that holds a weight from below has T = - m g."""
    system = system_with(
        "[points]\nO = [0, 0]\n" + particle("bob", "x", "y") + constraint("link", f'points = {ends}\nlength = "l"'),
        x=0,
        y='"l"',
    )
    assert accelerations(system, y=l)[1]["constraint, 1"] == pytest.approx(-m * g)


def test_a_link_without_a_length_at_the_start_is_refused():
    """Its length would be the distance at the start, which is 0."""
    with pytest.raises(eomgen.ModelError, match=r"'O' and 'bob.origin' are at one place at the start") as caught:
        system_with(
            "[points]\nO = [0, 0]\n" + particle("bob", "x", "y") + constraint("link", 'points = ["O", "bob.origin"]'),
            x=0,
            y=0,
        )
    assert caught.value.problems[0].where == "constraints.constraint" and "length" in caught.value.problems[0].fix


def test_a_clamp_carries_the_weight_and_its_moment():
    """Built in at P, left of the mass centre by l: R_y = m g, couple m g l counter-clockwise on the body."""
    system = system_with(block("beam", "x", "y", "a") + constraint("clamp", 'point = "beam.P"'), x=1, y=2, a=0)
    _, lam = accelerations(system, x=1, y=2)
    assert list(lam.values()) == pytest.approx([0, m * g, m * g * l])
    assert [row.component for row in system.constraints.rows] == ["x", "y", "couple"]


def test_a_weld_of_two_bodies_acts_on_the_first_named():
    """One beam built in, a second welded to it at its P: the second's weight and moment pass through the weld."""
    text = (
        block("beam", "x", "y", "a") + block("other", "z", "r", "b") + constraint("clamp", 'point = "beam.P"', "wall")
    )
    weld = constraint("clamp", 'points = ["beam.origin", "other.P"]', "weld")
    system = system_with(text + weld, x=0, y=0, a=0, z='"l"', r=0, b=0)
    _, lam = accelerations(system, z=l)
    assert list(lam.values()) == pytest.approx([0, 2 * m * g, 3 * m * g * l, 0, -m * g, -m * g * l])


def test_a_weld_in_space_leaves_nothing_free():
    """Three forces and three couples about x, y and z: rank J = 6 where the bodies stand, each couple of unit size."""
    system = written(
        """
[coordinates]
x = 0
y = 0
z = 0
a = 0.1
b = 0.2
c = 0.3
[bodies.block]
mass = 1
inertia = [1, 2, 3]
joint = { kind = "placed", at = ["x", "y", "z"], orientation = "xyz", angles = ["a", "b", "c"] }
[constraints.weld]
kind = "clamp"
point = "block.origin"
""",
        "space",
    )
    start = dict(zip(system.symbols.q, (0, 0, 0, "1/10", "1/5", "3/10"), strict=True))
    state = {q: fifty_digits().number(Fraction(x)) for q, x in start.items()}
    couples = [(row.wrenches[0][1], row.component) for row in system.constraints.rows[3:]]
    R = at([x for line in system.motion.link("block").pose.R for x in line], state).reshape(3, 3)
    assert [R @ at(wrench.tau, state) for wrench, _ in couples] == [pytest.approx(e, abs=1e-15) for e in np.eye(3)]
    assert np.linalg.matrix_rank(np.array([at(row, state) for row in system.constraints.J])) == 6
    assert at(system.constraints.phi, state) == pytest.approx([0] * 6, abs=1e-15)


def test_a_guide_lets_a_body_slide_without_turning():
    """Along a slope of 3:4 it slides down with g 3/5; N = 4/5 m g, and the couple takes the moment of N about C."""
    system = system_with(
        block("sled", "x", "y", "a") + constraint("guide", 'point = "sled.P"\nalong = [4, 3]'), x=0, y=0, a=0
    )
    a, lam = accelerations(system)
    assert [a["x"], a["y"], a["a"]] == pytest.approx([-g * 3 / 5 * 4 / 5, -g * 3 / 5 * 3 / 5, 0])
    N = m * g * 4 / 5
    assert list(lam.values()) == pytest.approx([N, N * 4 / 5 * l])  # M + (P - C) x N = 0
    assert [row.component for row in system.constraints.rows] == ["n", "couple"]


COLLAR = '[bodies.bar]\nmass = "m"\ninertia = 1\npoints = { A = [0, "l"], B = ["2*l", "l"] }\nline = ["A", "B"]\n'


def test_a_collar_on_a_turning_bar_is_carried_with_coriolis_force():
    """On a bar driven with w: N = 2 m r' w + m g cos(angle), to the left of A -> B, on the collar."""
    text = COLLAR.replace('"l"]', "0]") + 'joint = { kind = "revolute", angle = "2*t" }\n'
    system = system_with(
        text + particle("collar", "x", "y") + constraint("slider", 'point = "collar.origin"\non = "bar"'), x=1, y=0
    )
    a, lam = accelerations(system, x=1, **{"x'": 0.3, "y'": 2.0})  # r' = 0.3, on the line: y' = w r
    assert lam["constraint, 1"] == pytest.approx(m * g + 2 * m * 0.3 * 2)
    assert a["x"] == pytest.approx(0)  # r'' - r w^2 = 0 in turning axes


def test_a_point_of_the_ground_pushes_the_bar_that_slides_over_it():
    """A free bar on a fixed peg below its centre: the peg pushes the bar to the left of A -> B, here up, with m g."""
    bar = COLLAR.replace('[0, "l"]', '["-l", 0]').replace('["2*l", "l"]', '["l", 0]')
    bar += 'joint = { kind = "free", x = "x", y = "y", angle = "a" }\n'
    system = system_with(
        "[points]\nG = [0, 0]\n" + bar + constraint("slider", 'point = "G"\non = "bar"'), x=0, y=0, a=0
    )
    a, lam = accelerations(system)
    assert lam["constraint, 1"] == pytest.approx(m * g) and a == pytest.approx({"x": 0, "y": 0, "a": 0})


@pytest.mark.parametrize("fixed_in", ["", 'on = "table"\n'])
def test_a_disc_rolls_down_a_slope(fixed_in):
    """a = 2/3 g sin, N = m g cos, friction m g sin / 3 up the slope: against t = n turned clockwise, here downhill."""
    table = '[bodies.table]\nmass = 1\njoint = { kind = "fixed", at = [0, 0] }\n'
    rolls = constraint("rolling", f'body = "wheel"\n{fixed_in}line = {{ at = [0, 0], normal = [3, 4] }}')
    system = system_with(table + disc("wheel", FREE) + rolls, x='"R*3/5"', y='"R*4/5"', a=0)
    a, lam = accelerations(system, x=R * 3 / 5, y=R * 4 / 5)
    assert list(lam.values()) == pytest.approx([m * g * 4 / 5, -m * g * 3 / 5 / 3])
    assert a["x"] * 4 / 5 - a["y"] * 3 / 5 == pytest.approx(2 / 3 * g * 3 / 5)
    assert a["a"] == pytest.approx(-2 / 3 * g * 3 / 5 / R)
    assert [(row.component, row.gap is None) for row in system.constraints.rows] == [("n", False), ("t", True)]


def test_a_disc_that_slips_keeps_its_spin():
    """slip: the normal row alone, with the direction along which friction would act."""
    slides = constraint("rolling", 'body = "wheel"\nline = { at = [0, 0], normal = [3, 4] }\nslip = true')
    system = system_with(disc("wheel", FREE) + slides, x='"R*3/5"', y='"R*4/5"', a=0)
    a, lam = accelerations(system, x=R * 3 / 5, y=R * 4 / 5)
    assert list(lam.values()) == pytest.approx([m * g * 4 / 5]) and a["a"] == pytest.approx(0)
    state = state_of(system)
    speeds = [state[u] for u in system.symbols.u]
    radius = state[system.symbols.parameters["R"]]
    assert at((system.constraints.rows[0].sliding,), state)[0] == pytest.approx(
        float(speeds[0] * 4 / 5 - speeds[1] * 3 / 5 + radius * speeds[2])
    )


@pytest.mark.parametrize(("inside", "distance", "spin"), [("false", 2 * l + R, -1), ("true", 2 * l - R, 1)])
def test_a_disc_rolls_on_a_circle_outside_and_inside(inside, distance, spin):
    """(r + R) phi' = R w outside, (r - R) phi' = - R w inside; N pushes it off the circle."""
    rolls = constraint("rolling", f'body = "wheel"\ncircle = {{ at = [0, 0], radius = "2*l", inside = {inside} }}')
    system = system_with(disc("wheel", FREE) + rolls, x=0, y=-distance, a=0)
    state = state_of(system) | {q: fifty_digits().number(0) for q in system.symbols.q}
    p = system.symbols.parameters
    state |= {p[name]: fifty_digits().number(1) * value for name, value in GIVEN.items()}
    state[system.symbols.q[1]] = fifty_digits().number(1) * -distance  # below the centre: phi' = x'/distance
    J = np.array([at(row, state) for row in system.constraints.J])
    assert J @ [distance, 0, -spin * distance / R] == pytest.approx([0, 0], abs=1e-14)
    a, lam = accelerations(system, y=-distance)
    if inside == "true":
        assert lam["constraint, 1"] == pytest.approx(m * g) and a["y"] == pytest.approx(0)  # it lies at the bottom
    else:
        assert lam["constraint, 1"] == pytest.approx(-m * g)  # it would have to hang


def test_a_disc_on_a_disc_turns_against_it():
    """Two wheels on fixed axles: R1 w1 = - R2 w2, and the friction of one is minus that of the other."""
    second = disc("two", 'kind = "revolute", at = ["3*R", 0], angle = "b"', radius="2*R")
    wheels = disc("one", AXLE) + second
    system = system_with(wheels + constraint("rolling", 'body = "two"\non = "one"'), a=0, b=0)
    normal, along = system.constraints.rows
    assert normal.identical and not along.identical
    (J,) = (at(row, state_of(system)) for row in system.constraints.J)
    assert J[0] / J[1] == pytest.approx(1 / 2)


def test_a_hoop_that_moves_carries_the_disc_inside_it():
    """Contact velocities are those of the bodies' material points, by differences of poses with the point frozen."""
    hoop = disc("hoop", 'kind = "planar", x = "s", y = "r", angle = "b"', radius="3*R")
    rolls = constraint(
        "rolling", 'body = "wheel"\non = "hoop"\ncircle = { at = [0, 0], radius = "3*R", inside = true }'
    )
    system = system_with(hoop + disc("wheel", FREE) + rolls, x=0, y='"-2*R"', a=0, s=0, r=0, b=0)
    state = state_of(system)
    centers = [at(system.motion.link(body).pose.p, state) for body in ("hoop", "wheel")]
    radius = float(state[system.symbols.parameters["R"]])
    n = (centers[0] - centers[1]) / (2 * radius)
    touch = centers[1] - radius * n
    v = [frozen_velocity(system, body, touch, state) for body in ("wheel", "hoop")]
    t = np.array([n[1], -n[0], 0])
    rows = at([row.velocity for row in system.constraints.rows], state)
    assert rows == pytest.approx([n @ (v[0] - v[1]), t @ (v[0] - v[1])], rel=1e-12)


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
        ("rolling", 'body = "wheel"\non = "bar"\nline = { at = "A", normal = [0, 1] }', "a point of the ground, but"),
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
        system_with(text + constraint(kind, fields), a=0, b=0)


def test_a_disc_does_not_roll_in_a_circle_of_its_own_size():
    """r = R leaves no room: D = r - R = 0."""
    rolls = constraint("rolling", 'body = "wheel"\ncircle = { at = [0, 0], radius = "R", inside = true }')
    with pytest.raises(eomgen.ModelError, match="as large as the circle"):
        system_with(disc("wheel", FREE) + rolls, x=0, y=0, a=0)


def test_gears_share_their_couple_in_the_ratio():
    """w1 = ratio w2: a couple lam on the first, - ratio lam on the second, J^T lam of an ideal transmission."""
    wheels = disc("one", AXLE) + disc("two", 'kind = "revolute", at = [3, 0], angle = "b", torque = 6')
    system = system_with(wheels + constraint("gear", 'bodies = ["one", "two"]\nratio = -3'), a=0, b=0)
    a, lam = accelerations(system)
    assert a["a"] == pytest.approx(-3 * a["b"])
    inertia = m * R * R / 2
    assert lam["constraint, 1"] == pytest.approx(inertia * a["a"]) and 6 + 3 * lam["constraint, 1"] == pytest.approx(
        inertia * a["b"]
    )


def test_a_driven_coordinate_needs_its_driving_force():
    """x = l sin(w t) by a constraint: lam = m x'' along x."""
    cart = '[bodies.cart]\nmass = "m"\njoint = { kind = "prismatic", axis = [1, 0], displacement = "x" }\n'
    system = system_with(cart + constraint("motion", 'coordinate = "x"\nvalue = "l*t^2"'), x=0)
    a, lam = accelerations(system)
    assert (a["x"], lam["constraint, 1"]) == pytest.approx((2 * l, 2 * m * l))


def test_a_blade_lets_go_along_itself_and_holds_across():
    """Chaplygin's sleigh, blade at the centre: N = m v w to the left where it runs ahead and turns left, w' = 0."""
    blade = constraint("skate", 'point = "sled.origin"\nalong = [1, 0]')
    system = system_with(block("sled", "x", "y", "a") + blade, x=0, y=0, a=0)
    a, lam = accelerations(system, **{"g": 0, "x'": 3, "a'": 2})
    assert lam["constraint, 1"] == pytest.approx(m * 3 * 2) and a == pytest.approx({"x": 0, "y": 6, "a": 0})
