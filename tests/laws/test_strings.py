"""Strings against the textbook, and against the geometry of tangents found by angles alone."""

from __future__ import annotations

import warnings
from itertools import pairwise
from math import cos, sin

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
    m,
    particle,
    system_with,
)
from each import each
from moving import at, moved, state_of

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits


@each("strands", ['\nstrands = ["up", "down"]', ""])
def test_a_massive_pulley_has_different_tensions_on_its_sides(strands):
    """ch18-p1: 2 m and m over a disc of 6 m: the heavy side descends with g/6, T = 5/3 m g and 7/6 m g."""
    system = system_with(
        disc("pulley", AXLE, "6*m")
        + particle("P", "-R", "p", "2*m")
        + particle("Q", "R", "q")
        + constraint("string", 'path = ["P.origin", { body = "pulley", turn = "cw" }, "Q.origin"]' + strands),
        p=-1,
        q=-2,
        a=0,
    )
    a, lam = accelerations(system, p=-1, q=-2)
    assert a == pytest.approx({"p": -g / 6, "q": g / 6, "a": g / 6 / R})
    assert list(lam.values()) == pytest.approx([5 / 3 * m * g, 7 / 6 * m * g])
    assert [row.component for row in system.constraints.rows] == ["tension", "tension"]


def test_a_string_that_slips_has_one_tension_and_leaves_the_pulley_at_rest():
    """Atwood's machine over a smooth drum: a = g/3, T = 4/3 m g."""
    system = system_with(
        disc("pulley", AXLE, "6*m")
        + particle("P", "-R", "p", "2*m")
        + particle("Q", "R", "q")
        + constraint("string", 'path = ["P.origin", { body = "pulley", turn = "cw", slip = true }, "Q.origin"]'),
        p=-1,
        q=-2,
        a=0,
    )
    a, lam = accelerations(system, p=-1, q=-2)
    assert a == pytest.approx({"p": -g / 3, "q": g / 3, "a": 0})
    assert list(lam.values()) == pytest.approx([4 / 3 * m * g])
    assert system.scope.model.constraints["constraint"].strand_rows() == (1, 1)


def test_a_disc_unrolls_from_a_string():
    """ch20-p1: a_C = 2g/3, T = m g / 3; the string leaves it on its left."""
    text = "[points]\nA = [0, 0]\n" + disc("spool", FREE)
    path = 'path = ["A", { body = "spool", turn = "ccw" }]\nstrands = ["down"]'
    system = system_with(text + constraint("string", path), x='"R"', y=-1, a=0)
    a, lam = accelerations(system, x=R, y=-1)
    assert a == pytest.approx({"x": 0, "y": -2 / 3 * g, "a": -2 / 3 * g / R}, abs=1e-12)
    assert lam == pytest.approx({"constraint, 1": m * g / 3, "constraint, 2": 0}, abs=1e-12)
    assert [row.component for row in system.constraints.rows] == [
        "tension",
        "n",
    ]  # the strand stays vertical: no pendulum


def test_a_disc_hangs_in_a_loop_of_two_drums():
    """ch20-p3: a_P = g/14, phi'' = 5g/7R, tensions 13/14 m g and 5/7 m g, the disc falls with 9g/14."""
    system = system_with(
        disc("drum", AXLE, "6*m", "2*R")
        + particle("P", "-2*R", "p")
        + disc("C", 'kind = "placed", at = ["3*R", "c"], angle = "b"', "2*m")
        + constraint(
            "string",
            'path = ["P.origin", { body = "drum", turn = "cw" }, { body = "C", turn = "ccw" }]\n'
            'strands = ["up", "down"]',
        ),
        p=-1,
        c=-3,
        a=0,
        b=0,
    )
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
        + constraint("string", 'path = [{ body = "drum", radius = "2*R", turn = "cw" }, "P.origin"]', "outer")
        + constraint(
            "string",
            'path = [{ body = "drum", radius = "R", turn = "ccw" }, { body = "C", turn = "cw" }, '
            '"ceiling"]\nstrands = ["down", "up"]',
            "inner",
        ),
        a=0,
        p=-1,
        c=-1,
        b=0,
    )
    J = np.array([at(row, state_of(system)) for row in system.constraints.J])
    radius = float(state_of(system)[system.symbols.parameters["R"]])
    assert J @ [-1, -2 * radius, radius / 2, 0.5] == pytest.approx([0, 0, 0], abs=1e-13)
    assert np.linalg.matrix_rank(J) == 3


def test_a_pulley_that_a_body_carries_doubles_the_force():
    """A load 3 m hangs in a smooth loop, m on the free end: a_load = (3 - 2) g / (3 + 4), one tension through all."""
    system = system_with(
        '[points]\nceiling = ["-2*R", 0]\n'
        + disc("hook", 'kind = "placed", at = ["-R", "y"]', "3*m")
        + particle("Q", "2*R", "q")
        + constraint(
            "string",
            'path = ["ceiling", { body = "hook", turn = "ccw", slip = true }, '
            '{ at = ["R", 0], radius = "R", turn = "cw", slip = true }, "Q.origin"]\n'
            'strands = ["down", "up", "down"]',
        ),
        y=-1,
        q=-1,
    )
    a, lam = accelerations(system, y=-1, q=-1)
    assert (a["y"], a["q"]) == pytest.approx((-g / 7, 2 * g / 7))
    assert list(lam.values()) == pytest.approx([m * (g + 2 * g / 7)])


def test_a_string_over_a_peg_gives_way_as_its_other_side_grows():
    """ch18-p5: a bar's end A, a smooth peg, a weight below it: y_Q = y_peg - (L - |A - peg|), exactly, with a gap."""
    bar = '[bodies.bar]\nshape = { kind = "rod", mass = "3*m", length = "2*l" }\n'
    bar += 'joint = { kind = "revolute", angle = "a" }\n'
    rope = constraint(
        "string", 'path = ["bar.end", { at = [0, "2*l"], radius = 0, turn = "cw", slip = true }, "Q.origin"]'
    )
    system = system_with(bar + particle("Q", "0", "y") + rope, a=0.3, y='"-l"')
    (row,) = system.constraints.rows
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
    "a peg between": '[{ body = "wheel", turn = "cw" }, '
    '{ at = [9, 8], radius = "R", turn = "cw", slip = true }, "Q.P"]',
}
MOVERS = (
    "[points]\nG = [-5, 7]\n"
    + block("P", "x", "y", "a")
    + block("Q", "z", "r", "b")
    + disc("wheel", 'kind = "planar", x = "s", y = "5 + d", angle = "e"')
    + disc("pulley", 'kind = "planar", x = "7 + c", y = "k", angle = "h"', radius="R/3")
)
STARTS = dict.fromkeys("xyazrbsdeckh", 0.1) | {"x": -6, "z": 12}


def numbers(system: System, x: Scalar, state):
    return evaluate((x,), state, fifty_digits())[0]


def stops_of(system: System, state) -> list[tuple]:
    """(body, centre as a complex number, signed offset, slips) of every item of the path, at 50 digits."""
    found = []
    for item in system.scope.model.constraints["constraint"].path:
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
    for (_, x1, y1, a1), (_, x2, y2, a2) in pairwise(stops):
        span = f["sqrt"]((x2 - x1) ** 2 + (y2 - y1) ** 2)
        delta = f["atan2"](y2 - y1, x2 - x1) - f["asin"]((a1 - a2) / span)
        found.append((delta, span * f["cos"](f["asin"]((a1 - a2) / span))))
    return found


def near_the_start(system: System):
    """A state near the start, at speeds of order 1."""
    state, one = state_of(system), fifty_digits().number(1)
    by_name = {q.name: q for q in system.symbols.q}
    state |= {by_name[name]: one * value + state[by_name[name]] / 20 for name, value in STARTS.items()}
    p = system.symbols.parameters
    return state | {p[name]: one * value for name, value in GIVEN.items()}


@each("path", ROPES.values())
def test_strands_pull_along_the_common_tangents_of_what_they_touch(path):
    """J u + sigma = d . (v_1 - v_2) of the material points at the tangent points, summed over what slips."""
    system = system_with(MOVERS + constraint("string", f"path = {path}"), **STARTS)
    state = near_the_start(system)
    stops = stops_of(system, state)
    expected: dict[int, float] = {}
    numbered = system.scope.model.constraints["constraint"].strand_rows()
    for number, (first, second), (delta, _) in zip(numbered, pairwise(stops), tangents(stops), strict=True):
        d = np.array([cos(delta), sin(delta), 0])
        across = np.array([-d[1], d[0], 0])
        v = [
            frozen_velocity(system, body, np.array([float(x), float(y), 0]) + float(a) * across, state)
            for body, x, y, a in (first, second)
        ]
        expected[number] = expected.get(number, 0) + d @ (v[0] - v[1])
    assert at([row.velocity for row in system.constraints.rows], state) == pytest.approx(
        list(expected.values()), rel=1e-11
    )


@each("path", [p for p in ROPES.values() if p.count("slip") == p.count("turn")])
def test_the_row_of_a_smooth_string_is_the_rate_of_its_whole_length(path):
    """J u + sigma = - d/dt (straight pieces + r * angle wrapped), by differences of lengths found by angles."""
    system = system_with(MOVERS + constraint("string", f"path = {path}"), **STARTS)
    state = near_the_start(system)
    h = fifty_digits().number(1) / 10**15
    late, early = (whole_length(system, moved(system, state, sign * h)) for sign in (1, -1))
    (row,) = system.constraints.rows
    assert at((row.velocity,), state)[0] == pytest.approx(float((early - late) / (2 * h)), rel=1e-12)


def whole_length(system: System, state):
    stops = stops_of(system, state)
    ways = tangents(stops)
    total = sum(length for _, length in ways)
    for (_, _, _, offset), (before, _), (after, _) in zip(stops[1:-1], ways[:-1], ways[1:], strict=True):
        total += offset * (before - after)  # clockwise the heading falls
    return total


def test_a_strand_that_is_said_to_stay_vertical_forbids_the_pendulum():
    """A load on a vertical strand cannot swing: the strand's own row, and one across it with no force at rest."""
    text = "[points]\nA = [0, 0]\n" + particle("P", "x", "y")
    system = system_with(text + constraint("string", 'path = ["A", "P.origin"]\nstrands = ["down"]'), x=0, y=-1)
    a, lam = accelerations(system, y=-1)
    assert lam == pytest.approx({"constraint, 1": m * g, "constraint, 2": 0}) and a == pytest.approx({"x": 0, "y": 0})


BESIDE = "[points]\nA = [0, 0]\n" + particle("P", "R", "y")


@each(
    "text, message",
    [
        ('path = ["A", "P.origin"]\nstrands = ["down"]', "between the ground and 'P' cannot have the direction given"),
        ('path = [{ at = [0, 0], radius = "R", turn = "cw" }, "P.origin"]\nstrands = ["up"]', "runs against the direc"),
        ('path = [{ at = ["R", -1], radius = "2*R", turn = "cw" }, "P.origin"]', "there is no straight strand between"),
    ],
)
def test_a_strand_that_cannot_be_is_refused_by_name(text, message):
    """Where, what, and a fix."""
    with pytest.raises(eomgen.ModelError, match=message) as caught:
        system_with(BESIDE + constraint("string", text), y=-1)
    assert caught.value.problems[0].where == "constraints.constraint" and caught.value.problems[0].fix


@each("time, passes", [(0.5, False), (1.2, True)])
def test_a_run_in_which_a_load_passes_its_pulley_is_warned_of(time, passes):
    """a = g/3 up from 1 m below the axle: nothing is left of the strand at t = sqrt(6 m / g) = 0.782 s."""
    model = eomgen.loads(ATWOOD)
    with warnings.catch_warnings(record=True) as reported:
        warnings.simplefilter("always")
        eomgen.simulate(model, time=time, samples=400, target="numpy")
    said = [str(x.message) for x in reported if "nothing is left of strand 2 of 'rope'" in str(x.message)]
    assert len(said) == passes
    assert all("at t = 0.78" in x for x in said)


ATWOOD = """
eomgen = 1
name = "Atwood"
space = "plane"
parameters = { m = 1, R = 0.2 }

[coordinates]
p = -3
q = -1

[bodies.P]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "prismatic", at = ["-R", 0], axis = [0, 1], displacement = "p" }

[bodies.Q]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", at = ["R", 0], axis = [0, 1], displacement = "q" }

[constraints.rope]
kind = "string"
path = ["P.origin", { at = [0, 0], radius = "R", turn = "cw", slip = true }, "Q.origin"]

[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
