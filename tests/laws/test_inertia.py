"""Moments of inertia: composites against integrals taken anew, parallel axes, rotation, invariants, principal axes."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest
from scipy.integrate import dblquad

import eomgen
from eomgen.documents.json_form import as_dict
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.kinematics.inertia import SystemInertia
from eomgen.mechanics.kinematics.principal_axes import Principal
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow


def answers(**tables) -> dict[str, float]:
    """The values of a model's outputs."""
    found = eomgen.solve(eomgen.Model(**tables))
    assert {name: a.message for name, a in found.items() if a.message} == {}
    return {name: answer.value for name, answer in found.items()}


def exact(**tables) -> dict[str, str | None]:
    return {name: answer.exact for name, answer in eomgen.solve(eomgen.Model(**tables)).items()}


def number(x: float) -> str:
    return f"{x:.6f}"


# -- composites against the integral over their area ------------------------------------------------


def random_plate(rng: Random) -> list[dict]:
    """A rectangle with a triangle beside it and a round hole well inside, all turned and shifted."""
    a, b = rng.uniform(1, 2), rng.uniform(1, 2)
    turn, x, y = rng.uniform(-3, 3), rng.uniform(-1, 1), rng.uniform(-1, 1)

    def placed(u: float, v: float) -> list[str]:
        c, s = math.cos(turn), math.sin(turn)
        return [number(x + c * u - s * v), number(y + s * u + c * v)]

    return [
        {"kind": "rectangle", "width": number(a), "height": number(b), "at": placed(0, 0), "angle": number(turn)},
        {
            "kind": "triangle",
            "width": number(a / 3),
            "height": number(b / 2),
            "at": placed(a / 2, -b / 4),
            "angle": number(turn),
        },
        {"kind": "disc", "radius": number(min(a, b) / 5), "at": placed(a / 9, b / 8), "angle": "0", "hole": True},
    ]


def grid_moments(pieces: list[dict], m: float, points: int = 900) -> np.ndarray:
    """m, first and second moments by a fine grid of points, each of them in the plate or not."""
    xs, ys = np.meshgrid(np.linspace(-4, 4, points), np.linspace(-4, 4, points))
    held = np.zeros_like(xs)
    for piece in pieces:
        angle, (px, py) = float(piece["angle"]), map(float, piece["at"])
        u = math.cos(angle) * (xs - px) + math.sin(angle) * (ys - py)
        v = math.cos(angle) * (ys - py) - math.sin(angle) * (xs - px)
        if piece["kind"] == "rectangle":
            mine = (abs(u) <= float(piece["width"]) / 2) & (abs(v) <= float(piece["height"]) / 2)
        elif piece["kind"] == "triangle":
            mine = (u >= 0) & (v >= 0) & (u / float(piece["width"]) + v / float(piece["height"]) <= 1)
        else:
            mine = np.hypot(u, v) <= float(piece["radius"])
        held += np.where(mine, -1 if piece.get("hole") else 1, 0)
    density = m / held.sum()
    return density * np.array([(held * f).sum() for f in (xs, ys, ys * ys, xs * xs, xs * ys)])


OUTPUTS = {
    "x": "x(b.center)",
    "y": "y(b.center)",
    "J_x": "inertia_axis(O, x)",
    "J_y": "inertia_axis(O, y)",
    "J_xy": "inertia_product(O, x, y)",
    "J_O": "inertia_point(O)",
    "P_x": "inertia_plane(O, x)",
}


@pytest.mark.parametrize("seed", range(2))
def test_a_plate_with_a_hole_agrees_with_the_integral_over_its_area(seed):
    """m, C and the moments about O of a composite whose mass is given for the net whole (to a part in 200)."""
    pieces = random_plate(Random(seed))
    body = {"mass": 7, "parts": pieces}
    found = answers(space="plane", points={"O": [0, 0]}, bodies={"b": body}, outputs=OUTPUTS)
    mx, my, xx, yy, xy = grid_moments(pieces, 7)
    expected = {"x": mx / 7, "y": my / 7, "J_x": xx, "J_y": yy, "J_xy": xy, "J_O": xx + yy, "P_x": yy}
    assert found == pytest.approx(expected, abs=0.04)


@pytest.mark.parametrize("turn", [1, -1])
def test_a_plate_with_a_notch_is_its_triangles_together(turn):
    """A non-convex polygon, either way round, against the integral over a triangulation."""
    corners = [(0, 0), (4, 0), (4, 3), (2, 1), (0, 3)]
    model = {"bodies": {"b": {"shape": {"kind": "polygon", "mass": 2, "vertices": corners[::turn]}}}}
    found = answers(space="plane", points={"O": [0, 0]}, outputs=OUTPUTS, **model)

    def integral(f):
        left = dblquad(lambda y, x: f(x, y), 0, 2, 0, lambda x: 3 - x)[0]
        return left + dblquad(lambda y, x: f(x, y), 2, 4, 0, lambda x: x - 1)[0]

    density = 2 / integral(lambda x, y: 1)
    assert found["x"] == pytest.approx(density / 2 * integral(lambda x, y: x))
    assert found["J_x"] == pytest.approx(density * integral(lambda x, y: y * y))
    assert found["J_y"] == pytest.approx(density * integral(lambda x, y: x * x))
    assert found["J_xy"] == pytest.approx(density * integral(lambda x, y: x * y))


def test_a_hole_can_be_cut_again_out_of_what_it_was_cut_from():
    """A plate less a piece, and that piece: the plate. An annulus is a disc less a disc; a tube a bar less a bar."""
    pairs = [
        (
            "plane",
            [{"kind": "disc", "radius": 2}, {"kind": "disc", "radius": 1, "hole": True}],
            {"kind": "annulus", "radius": 2, "inner": 1},
        ),
        (
            "space",
            [
                {"kind": "cylinder", "radius": 2, "length": 3},
                {"kind": "cylinder", "radius": 1, "length": 3, "hole": True},
            ],
            {"kind": "tube", "radius": 2, "inner": 1, "length": 3},
        ),
        (
            "space",
            [{"kind": "sphere", "radius": 2}, {"kind": "sphere", "radius": 1, "hole": True}],
            {"kind": "hollow_sphere", "radius": 2, "inner": 1},
        ),
        (
            "space",
            [
                {"kind": "hemisphere", "radius": 2},
                {"kind": "hemisphere", "radius": 2, "axis": [1, 0, 0], "angle": "pi"},
            ],
            {"kind": "sphere", "radius": 2},
        ),
        (
            "plane",
            [
                {"kind": "sector", "radius": 2, "opening": "pi/3", "angle": "pi/6"},
                {"kind": "sector", "radius": 2, "opening": "5*pi/3", "angle": "7*pi/6"},
            ],
            {"kind": "disc", "radius": 2},
        ),
        (
            "plane",
            [
                {"kind": "arc", "radius": 2, "opening": "pi", "angle": "pi/2"},
                {"kind": "arc", "radius": 2, "opening": "pi", "angle": "-pi/2"},
            ],
            {"kind": "ring", "radius": 2},
        ),
    ]
    for space, parts, shape in pairs:
        outputs = {f"{i}{j}": f"inertia_tensor(O, {i}, {j})" for i in "xyz" for j in "xyz"}
        common = {"space": space, "points": {"O": [1, 2] if space == "plane" else [1, 2, 3]}, "outputs": outputs}
        made = answers(**common, bodies={"b": {"mass": 5, "parts": parts}})
        assert made == pytest.approx(answers(**common, bodies={"b": {"shape": {**shape, "mass": 5}}}))


def test_a_piece_may_be_turned_any_way_in_space():
    """A rod along the diagonal: `turned` about z and y, or `angle` about the axis across; m l^2/12 across it."""
    diagonal = {"turned": [{"angle": "pi/4"}, {"axis": [0, 1, 0], "angle": "-atan(1/sqrt(2))"}]}
    about_one = {"axis": [0, -1, 1], "angle": "acos(1/sqrt(3))"}
    for way in (diagonal, about_one):
        parts = [{"kind": "rod", "length": "sqrt(3)", **way}]
        found = answers(
            space="space",
            bodies={"b": {"mass": 12, "parts": parts}},
            points={"O": [0, 0, 0], "Q": [1, 1, 1]},
            outputs={
                "along": "inertia_axis(O, Q)",
                "x": "x(b.center)",
                "y": "y(b.center)",
                "z": "z(b.center)",
                "across": "principal_moment(b.center, 3)",
            },
        )
        expected = {"along": 0, "x": 0.5, "y": 0.5, "z": 0.5, "across": 3}
        assert found == pytest.approx(expected, abs=1e-12)


# -- who weighs what --------------------------------------------------------------------------------


def masses(body: dict) -> list[float]:
    count = len(body["parts"])
    outputs = {"whole": "mass_of(b)", **{f"m{k}": f"mass_of(b, {k})" for k in range(1, count + 1)}}
    return list(answers(space="plane", bodies={"b": body}, outputs=outputs).values())


def test_masses_are_shared_by_area_and_the_net_whole_is_what_was_given():
    """density = (M - those given) / (areas - holes); a hole's mass is what it takes away."""
    plate = {"kind": "rectangle", "width": 4, "height": 2}
    hole = {"kind": "rectangle", "width": 1, "height": 1, "hole": True}
    rod = {"kind": "rod", "length": 1, "mass": 3}
    assert masses({"mass": 14, "parts": [plate, hole]}) == [14, 16, 2]
    assert masses({"mass": 17, "parts": [plate, hole, rod]}) == [17, 16, 2, 3]
    assert masses({"parts": [{**plate, "mass": 16}, hole, rod]}) == [17, 16, 2, 3]
    assert masses({"parts": [{**plate, "mass": 16}, {**hole, "mass": 1}]}) == [15, 16, 1]
    assert masses({"mass": 17, "parts": [{**plate, "mass": 16}, hole, rod]}) == [17, 16, 2, 3]


# -- laws of the tensor -----------------------------------------------------------------------------


def assembled(seed: int) -> System:
    """Three bodies welded and turned at random in space, one of them made of parts, and points of the ground."""
    rng = Random(seed)

    def some() -> list[str]:
        return [number(rng.uniform(-2, 2)) for _ in range(3)]

    def hung(on: str | None) -> dict:
        joint = {"kind": "fixed", "at": some(), "axis": some(), "angle": number(rng.uniform(-3, 3))}
        return joint if on is None else {**joint, "on": on}

    return System.of(
        eomgen.Model(
            space="space",
            points={"P": some(), "O": [0, 0, 0]},
            bodies={
                "box": {"shape": {"kind": "box", "mass": 2, "size": [1, 2, 3]}, "joint": hung(None)},
                "cone": {"shape": {"kind": "cone", "mass": 1, "radius": 1, "height": 2}, "joint": hung("box")},
                "made": {
                    "mass": 3,
                    "joint": hung("cone"),
                    "parts": [
                        {"kind": "rod", "length": 2, "mass": 1, "axis": some(), "angle": number(rng.uniform(-3, 3))},
                        {"kind": "sphere", "radius": 1, "at": some()},
                    ],
                },
            },
        )
    )


def matrix(I) -> np.ndarray:
    return np.array(evaluate([x for row in I for x in row], {}, FLOAT)).reshape(3, 3)


def vector(v) -> np.ndarray:
    return np.array(evaluate(tuple(v), {}, FLOAT))


@pytest.mark.parametrize("seed", range(3))
def test_parallel_axes_rotation_and_addition_hold_for_any_bodies(seed):
    """I_P = I_C + m (d.d 1 - d d^T), I in ground axes R I R^T, the whole is the sum of the bodies."""
    motion = assembled(seed).motion
    P, names = (motion.position(motion.place("P")), list(motion.index))
    total = np.zeros((3, 3))
    for name in names:
        mass, R = SystemInertia(motion).in_ground(name), matrix(motion.link(name).pose.R)
        d, m, I = vector(mass.com) - vector(P), float(evaluate((mass.m,), {}, FLOAT)[0]), matrix(mass.I)
        assert np.linalg.norm(R.T @ R - np.eye(3)) < 1e-12
        about_P = I + m * (d @ d * np.eye(3) - np.outer(d, d))
        assert matrix(SystemInertia(motion).about(P, [name])) == pytest.approx(about_P, abs=1e-9)
        total += about_P
    assert matrix(SystemInertia(motion).about(P, names)) == pytest.approx(total, abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_principal_axes_are_the_rows_of_a_rotation_that_makes_the_tensor_diagonal(seed):
    """R I R^T = diag(J_1, J_2, J_3), ascending; trace and determinant stay; no closed axes, none given."""
    system = assembled(seed)
    motion = system.motion
    I = SystemInertia(motion).about(motion.position(motion.place("P")), list(motion.index))
    found = Principal.of(I, system.scope)
    moments = system.scope.numbers(found.moments)
    assert moments is not None and found.sorted
    assert moments == pytest.approx(list(np.linalg.eigvalsh(matrix(I))), rel=1e-9)
    assert sum(moments) == pytest.approx(np.trace(matrix(I)))
    assert math.prod(moments) == pytest.approx(np.linalg.det(matrix(I)))


CUBE = {
    "space": "space",
    "parameters": {"m": {}, "a": {}},
    "bodies": {"c": {"shape": {"kind": "box", "mass": "m", "size": ["a", "a", "a"]}}},
    "points": {"corner": ["-a/2", "-a/2", "-a/2"], "along": ["a/2", "-a/2", "-a/2"], "far": ["a/2", "a/2", "a/2"]},
}
PLATE = {
    "space": "plane",
    "parameters": {"m": {}, "a": {}, "b": {}},
    "bodies": {"p": {"shape": {"kind": "rectangle", "mass": "m", "width": "a", "height": "b"}}},
    "points": {"corner": ["-a/2", "-b/2"]},
}
PLACES = (("p", "m", ["a", "a", 0]), ("q", "2*m", [0, "a", "a"]), ("r", "m", ["a", 0, "a"]))
PARTICLES = {
    "space": "space",
    "parameters": {"m": {}, "a": {}},
    "points": {"O": [0, 0, 0]},
    "bodies": {
        name: {"shape": {"kind": "particle", "mass": mass}, "joint": {"kind": "fixed", "at": at}}
        for name, mass, at in PLACES
    },
}
EXACT_AXES = [(CUBE, "corner"), (PLATE, "corner"), (PARTICLES, "O")]


@pytest.mark.parametrize(("tables", "point"), EXACT_AXES)
def test_closed_axes_are_orthonormal_right_handed_and_principal(tables, point):
    """R R^T = 1, det R = 1, R I R^T = diag, at a state of the parameters."""
    system = System.of(eomgen.Model(**tables))
    motion, symbols = system.motion, system.scope.symbols.parameters
    I = SystemInertia(motion).about(motion.position(motion.place(point)), list(motion.index))
    found = Principal.of(I, system.scope)
    assert found.axes is not None
    state = dict(zip(symbols.values(), (1.7, 2.3, 1.1), strict=False))
    flat = evaluate([x for M in (I, found.axes) for row in M for x in row] + list(found.moments), state, FLOAT)
    tensor, R, moments = np.reshape(flat[:9], (3, 3)), np.reshape(flat[9:18], (3, 3)), flat[18:]
    assert R @ R.T == pytest.approx(np.eye(3), abs=1e-12) and np.linalg.det(R) == pytest.approx(1)
    assert R @ tensor @ R.T == pytest.approx(np.diag(moments), abs=1e-9)
    assert moments == sorted(moments)


def test_a_cube_about_an_edge_its_diagonal_and_its_corner():
    """2/3 m a^2, 1/6 m a^2 through the centre whatever the axis; about the corner 1/6, 11/12, 11/12."""
    outputs = {
        "edge": "inertia_axis(corner, along)",
        "diagonal": "inertia_axis(corner, far)",
        "any": "inertia_axis(c.center, y)",
        "product": "inertia_product(corner, x, y)",
        "tensor": "inertia_tensor(corner, x, y)",
        **{f"J{k}": f"principal_moment(corner, {k})" for k in (1, 2, 3)},
    }
    assert exact(**CUBE, outputs=outputs) == {
        "edge": "2/3*m*a^2",
        "diagonal": "1/6*m*a^2",
        "any": "1/6*m*a^2",
        "product": "1/4*m*a^2",
        "tensor": "-1/4*m*a^2",
        "J1": "1/6*m*a^2",
        "J2": "11/12*m*a^2",
        "J3": "11/12*m*a^2",
    }


def test_discrete_masses_have_the_tensor_of_their_sum_and_its_surds():
    """I of m at (a,a,0), 2m at (0,a,a), m at (a,0,a): the principal moments (9 -+ sqrt(17)) m a^2/2 and 7 m a^2."""
    outputs = {
        "xx": "inertia_tensor(O, x, x)",
        "xy": "inertia_tensor(O, x, y)",
        "J1": "principal_moment(O, 1)",
        "J2": "principal_moment(O, 2)",
        "J3": "principal_moment(O, 3)",
        "only": "inertia_point(O, q)",
    }
    assert exact(**PARTICLES, outputs=outputs) == {
        "xx": "6*m*a^2",
        "xy": "-m*a^2",
        "J1": "1/2*m*a^2*(9 - sqrt(17))",
        "J2": "1/2*m*a^2*(9 + sqrt(17))",
        "J3": "7*m*a^2",
        "only": "4*m*a^2",
    }


def test_the_perpendicular_axes_of_a_plate_and_the_sums_over_planes():
    """J_z = J_x + J_y = J_O; the planes' sum is the point; the axes' half sum too."""
    outputs = {k: f"inertia_axis(corner, {k})" for k in "xyz"} | {f"P{k}": f"inertia_plane(corner, {k})" for k in "xyz"}
    found = exact(**PLATE, outputs={**outputs, "O": "inertia_point(corner)"})
    assert found["x"] == "1/3*m*b^2" and found["y"] == "1/3*m*a^2" and found["O"] == found["z"] == "1/3*m*(a^2 + b^2)"
    assert (found["Px"], found["Py"], found["Pz"]) == (found["y"], found["x"], "0")


def test_a_plate_of_unknown_sides_has_its_moments_in_order():
    """J_z of a thin plate is the largest; of the two in its plane min and max tell, where the sides do not."""
    outputs = {f"J{k}": f"principal_moment(p.center, {k})" for k in (1, 2, 3)}
    for a, b in ((2, 3), (3, 2)):
        model = eomgen.Model(**{**PLATE, "parameters": {"m": 12, "a": a, "b": b}}, outputs=outputs)
        assert [answer.value for answer in eomgen.solve(model).values()] == [4, 9, 13]
    found = exact(**PLATE, outputs=outputs)
    assert "min" in found["J1"] and found["J3"] == "1/12*m*(a^2 + b^2)"


# -- angular momentum -------------------------------------------------------------------------------


def test_angular_momentum_is_the_tensor_times_the_angular_velocity_about_a_fixed_point():
    """L_O = I_O w and T = w.I w / 2 of a body that turns about O; about any P, L_P = L_C + m (C - P) x v_C."""
    outputs = {
        "L": "angular_momentum_z(O)",
        "Iw": "inertia_axis(O, z)*omega(b)",
        "T": "kinetic_energy()",
        "half": "inertia_axis(O, z)*omega(b)^2/2",
        "P": "angular_momentum_z(P)",
        "moved": "angular_momentum_z(b.center) + 3*((x(b.center) - 2)*vy(b.center) - (y(b.center) - 1)*vx(b.center))",
    }
    found = answers(
        space="plane",
        coordinates={"q": {"start": 0.7, "speed": 1.3}},
        points={"O": [0, 0], "P": [2, 1]},
        bodies={
            "b": {
                "parts": [
                    {"kind": "rod", "length": 2, "mass": 1},
                    {"kind": "disc", "radius": 1, "mass": 2, "at": [3, 0]},
                ],
                "joint": {"kind": "revolute", "angle": "q"},
            }
        },
        outputs=outputs,
    )
    assert found["L"] == pytest.approx(found["Iw"]) and found["T"] == pytest.approx(found["half"])
    assert found["P"] == pytest.approx(found["moved"])


def test_the_angular_momentum_of_particles_is_that_of_their_tensor():
    """Turned as one about the z axis: L = I (0, 0, w)."""
    bodies = {
        name: {**body, "joint": {"kind": "fixed", "on": "hub", "at": body["joint"]["at"]}}
        for name, body in PARTICLES["bodies"].items()
    }
    hub = {"hub": {"joint": {"kind": "revolute", "angle": "q"}}}
    system = System.of(
        eomgen.Model(
            space="space",
            parameters=PARTICLES["parameters"],
            points=PARTICLES["points"],
            coordinates={"q": {"speed": 1}},
            bodies={**hub, **bodies},
        )
    )
    motion, symbols = system.motion, system.scope.symbols
    O = motion.position(motion.place("O"))
    L, I = (
        SystemInertia(motion).angular_momentum(O, list(motion.index)),
        SystemInertia(motion).about(O, list(motion.index)),
    )
    state = {**dict(zip(symbols.parameters.values(), (2.0, 3.0), strict=True)), symbols.q[0]: 0.4, symbols.u[0]: 1.5}
    found, tensor = evaluate(L, state, FLOAT), evaluate([x for row in I for x in row], state, FLOAT)
    assert found == pytest.approx([1.5 * tensor[2], 1.5 * tensor[5], 1.5 * tensor[8]])


# -- in every verb ----------------------------------------------------------------------------------


def test_a_body_of_parts_swings_like_the_same_body_by_its_numbers():
    """A physical pendulum: I_O q'' = -m g h sin q, from parts and from m, C and I."""
    parts = [
        {"kind": "rod", "length": "l", "mass": "m"},
        {"kind": "disc", "radius": "l/4", "mass": "4*m", "at": ["l", 0]},
        {"kind": "disc", "radius": "l/8", "mass": "m", "at": ["l", 0], "hole": True},
    ]
    common = {
        "space": "plane",
        "parameters": {"m": {}, "l": {}, "g": {}},
        "coordinates": {"q": 0.1},
        "forces": {"weight": {"kind": "gravity", "acceleration": [0, "-g"]}},
    }
    joint = {"kind": "revolute", "angle": "q - pi/2"}
    made = eomgen.derive(eomgen.Model(**common, bodies={"b": {"parts": parts, "joint": joint}}))
    I = "1/3*m*l^2 + 4*m*(l^2/32 + l^2) - m*(l^2/128 + l^2) - 4*m*(7/8*l)^2"
    given = {"mass": "4*m", "center": ["7/8*l", 0], "inertia": I, "joint": joint}
    reported = eomgen.derive(eomgen.Model(**common, bodies={"b": given}))
    assert made.certify().ok
    assert (made.M - reported.M).expand().is_zero_matrix and (made.forcing - reported.forcing).expand().is_zero_matrix


# -- the report -------------------------------------------------------------------------------------

CH13 = {
    "space": "plane",
    "parameters": {"a": "0.2"},
    "points": {"O": [0, 0], "D": ["6*a", "-12*a"]},
    "bodies": {
        "plate": {
            "mass": 87,
            "parts": [
                {"kind": "rectangle", "width": "6*a", "height": "12*a", "at": ["3*a", "-6*a"]},
                {"kind": "triangle", "width": "12*a", "height": "3*a", "at": ["6*a", 0], "angle": "-pi/2"},
                {"kind": "disc", "radius": "a", "at": ["3*a", "-3*a"], "hole": True},
            ],
        }
    },
}


def test_the_report_gives_what_the_outputs_give_in_both_conventions():
    """J_axis of a plate with a hole; J_xy = -I_xy; results are exact texts with their numbers."""
    found = eomgen.inertia(eomgen.Model(**CH13), about="O", axis="O,D")
    assert found["J_axis(O)"].value == pytest.approx(30.0312653)
    assert found["J_xy(O)"].value == pytest.approx(-70.2633804) == -found["I_xy(O)"].value
    assert found["m(plate)"].exact == "87"
    xx, xy, yy = (found[f"I_{pair}(plate)"].value for pair in ("xx", "xy", "yy"))
    principal = list(np.linalg.eigvalsh([[xx, xy], [xy, yy]]))
    assert [found["I_1(plate)"].value, found["I_2(plate)"].value] == pytest.approx(principal)
    for format in ("text", "latex", "markdown", "json"):
        assert "parallel axes" in found.render(format)


def test_impossible_bodies_are_told_with_their_culprit():
    """Holes that are larger or heavier than the rest, or outside; masses that do not add up; densities of two kinds."""
    plate, hole = {"kind": "rectangle", "width": 1, "height": 1}, {"kind": "disc", "radius": "0.1", "hole": True}
    wrong = [
        ({"mass": 1, "parts": [plate, {**hole, "radius": 1}]}, "the holes of body 'b' are as large as its parts"),
        ({"parts": [{**plate, "mass": 1}, {**hole, "mass": 2}]}, "the mass of body 'b' is negative"),
        ({"parts": [{**plate, "mass": 3}, {**hole, "mass": 2, "at": [5, 0]}]}, "breaks the triangle inequality"),
        ({"mass": 9, "parts": [{**plate, "mass": 4}, {**plate, "mass": 4}]}, "weigh 8 kg, its 'mass' is 9 kg"),
        ({"mass": 9, "parts": [plate, {"kind": "rod", "length": 1}]}, "no common density: rod"),
        ({"parts": [plate]}, "part 1 of body 'b' has no 'mass'"),
        ({"shape": {"kind": "annulus", "mass": 1, "radius": 1, "inner": 2}}, "'inner' is not smaller than 'radius'"),
        ({"shape": {"kind": "polygon", "mass": 1, "vertices": [[0, 0], [1, 1], [1, 0], [0, 1]]}}, "edges cross"),
    ]
    for body, words in wrong:
        with pytest.raises(eomgen.ModelError) as error:
            eomgen.Model(space="plane", bodies={"b": body})
        assert words in str(error.value)


def test_what_is_not_known_of_a_body_of_the_plane_is_not_answered():
    """A body given by its moment about z has no known moment about x; about z, and about the point, it has."""
    outputs = {"x": "inertia_axis(O, x)", "z": "inertia_axis(O, z)", "O": "inertia_point(O)"}
    body = {"mass": 2, "inertia": 3, "center": [1, 0]}
    found = eomgen.solve(eomgen.Model(space="plane", points={"O": [0, 0]}, bodies={"b": body}, outputs=outputs))
    assert found["x"].exact is None and "only the moment about z is known" in found["x"].message
    assert (found["z"].exact, found["O"].exact) == ("5", "5")


def test_the_verb_draws_a_plate_and_writes_it_for_machines(tmp_path):
    """--plot makes a picture; JSON has every result by name; without values nothing is drawn."""
    from eomgen.documents.proven_documents import shown

    picture = tmp_path / "plate.png"
    found = as_dict(shown(eomgen.inertia(eomgen.Model(**CH13), about="O"), plot=str(picture)))
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert found["results"]["m(plate)"] == {"exact": "87", "value": 87.0, "unit": "kg"}
    assert found["principal_axes"].keys() == {"plate", "O"}
    with pytest.raises(eomgen.MissingValues, match=r"parameter 'm'(.|\n)*parameter 'a'"):
        shown(eomgen.inertia(eomgen.Model(**CUBE)), plot=str(picture))


# -- the report of what moves, and of what says nothing of its inertia ------------------------------


def test_moving_bodies_together_have_their_numbers_at_the_start():
    """J_O of two hinged rods at q1, q2 at the start: m l^2/3 + m (l^2/12 + d.d), d to the second mass centre."""
    q1, q2 = 0.3, 1.1
    rod = {"kind": "rod", "mass": "m", "length": "l"}
    found = eomgen.inertia(
        eomgen.Model(
            space="plane",
            parameters={"m": 2, "l": 3},
            coordinates={"q1": q1, "q2": q2},
            points={"O": [0, 0]},
            bodies={
                "a": {"shape": rod, "joint": {"kind": "revolute", "angle": "q1"}},
                "b": {"shape": rod, "joint": {"kind": "revolute", "on": "a.end", "angle": "q2"}},
            },
        ),
        about="O",
    )
    x, y = (3 * f(q1) + 1.5 * f(q1 + q2) for f in (math.cos, math.sin))
    assert found["J_P(O)"].value == pytest.approx(2 * 9 / 3 + 2 * (9 / 12 + x * x + y * y))
    assert "Numbers at the start: q1 = 0.3, q2 = 1.1." in str(found)


ABOVE = """
eomgen = 1
name = "A body turned by a quaternion beside a particle above the floor"
space = "space"
parameters = { m = 2, M = 3 }
coordinates = { e0 = 0.9, e1 = 0.3, e2 = -0.2, e3 = 0.25, x = { start = 0.4 }, z = { start = 0.06 } }
speeds = { w1 = {}, w2 = {}, w3 = {} }

[bodies.top]
shape = { kind = "tetrahedron", mass = "M", vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.5]] }

[bodies.top.joint]
kind = "spherical"
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]

[bodies.puck]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", 0, "z"] }

[constraints.floor]
kind = "support"
point = "puck.center"
at = [0, 0, 0]
normal = [0, 0, 1]
unilateral = true
"""


def test_the_start_of_an_open_contact_is_where_moments_are_taken():
    """z = 0.06 at the start, whatever is declared to be a floor."""
    found = eomgen.inertia(eomgen.loads(ABOVE))
    assert found.start and found.certify().ok
    assert "z = 0.06" in str(found)


def test_moments_are_proven_where_no_start_is_known():
    """At some orientation: a quaternion of norm 1, as the printed formulas have it."""
    unknown = ABOVE.replace("m = 2", 'm = 2, a = { unit = "m" }').replace('"z"]', '"z - a"]')
    found = eomgen.inertia(eomgen.loads(unknown))
    assert not found.start and found.certify().ok


def test_a_mass_without_inertia_leaves_the_other_bodies_their_moments():
    """A cart that only slides needs no inertia: m and the mass centre are known, of both too; a moment of it is not."""
    model = eomgen.Model(
        space="plane",
        parameters={},
        coordinates={"x": 0},
        points={"O": [0, 0]},
        bodies={
            "cart": {"mass": 3, "joint": {"kind": "prismatic", "axis": [1, 0], "displacement": "x"}},
            "disc": {"shape": {"kind": "disc", "mass": 1, "radius": 2}, "joint": {"kind": "fixed", "at": [4, 0]}},
        },
    )
    found = eomgen.inertia(model)
    assert (found["I_zz(disc)"].exact, found["m"].exact) == ("2", "4")
    assert found["x_C"].value == pytest.approx(1)
    assert not {"I_zz(cart)", "I_zz"} & set(found.results)
    assert "of the inertia of 'cart' the model says nothing" in str(found)
    with pytest.raises(eomgen.ModelError, match="body 'cart' has a mass and no inertia"):
        eomgen.inertia(model, about="O")


def test_parts_turned_by_many_angles_stay_quick_and_right():
    """Boxes turned by angles without a common measure: no search for a short form of what nobody can read.

    tr(I_O)/2 = sum m (r.r + (a^2 + b^2 + c^2)/12) does not depend on how they are turned.
    """
    parts = [
        {"kind": "box", "size": [1, 2, 3], "mass": 1, "at": [k, 0, 1], "axis": [1, k, 2], "angle": f"{k + 1}/7"}
        for k in range(8)
    ]
    bodies, outputs = {"b": {"parts": parts}}, {"J": "inertia_point(O)", "J_1": "principal_moment(O, 1)"}
    found = eomgen.solve(eomgen.Model(space="space", points={"O": [0, 0, 0]}, bodies=bodies, outputs=outputs))
    values = {name: answer.value for name, answer in found.items()}
    assert values["J"] == pytest.approx(sum(k * k + 1 + 14 / 12 for k in range(8)))
    assert 0 < values["J_1"] < values["J"]


def test_a_misspelt_key_of_a_piece_is_offered_the_nearest():
    """The keys of a piece and those of its shape stand in one table."""
    with pytest.raises(eomgen.ModelError, match=r"(?s)unknown key 'att'.*did you mean 'at'"):
        eomgen.loads(
            'eomgen = 1\nspace = "plane"\n[bodies.b]\nmass = 1\nparts = [{ kind = "disc", radius = 1, att = [0, 1] }]'
        )
