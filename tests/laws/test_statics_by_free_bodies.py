"""Beams, frames, trusses and machines of the classics against the equilibrium of their bodies in floats.

The models of models/ at their own numbers and at others; then structures that are loose or redundant, each recognised.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import cos, pi, sin, sqrt
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from each import each
from float_statics import Numbers, Structure

import eomgen
from eomgen.symbolic.expression.text import as_expression

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
KNOWN: dict[str, Callable[[Numbers], Numbers]] = {}


def known(function: Callable[[Numbers], Numbers]) -> Callable[[Numbers], Numbers]:
    """Puts a structure into KNOWN under the name of its model file."""
    KNOWN[function.__name__] = function
    return function


# -- beams and frames ----------------------------------------------------------------------------------------------


@known
def beam_with_overhang(n: Numbers) -> Numbers:
    q, F, L, c = (n[x] for x in ("q", "F", "L", "c"))
    s = Structure()
    s.pin("A", (0, 0), "beam")
    s.put("B", "beam", (L, 0), (0, 1))
    s.spread("beam", (0, 0), (L, 0), (0, 0), (0, -q))
    s.load("beam", (L + c, 0), (0, -F))
    s.load("beam", (0, 0), couple=(0, 0, -F * c))
    r = s.solved()
    return {"A_x": r["A_x"], "A_y": r["A_y"], "B_y": r["B"], "M_B": r["A_y"] * L - q * L**2 / 6}


@known
def cantilever(n: Numbers) -> Numbers:
    F, M0, q, l = (n[x] for x in ("F", "M0", "q", "l"))
    e = np.array([cos(pi / 6), sin(pi / 6)])
    s = Structure()
    s.clamp("A", (0, 0), "beam")
    s.load("beam", l * e, (F * e[1], -F * e[0]))
    s.load("beam", (0, 0), couple=(0, 0, M0))
    s.spread("beam", l / 2 * e, l * e, (0, -q))
    r = s.solved()
    A = np.array([r["A_x"], r["A_y"]])
    turned = {"along": float(A @ e), "across": float(A @ (-e[1], e[0]))}
    return {"A_x": r["A_x"], "A_y": r["A_y"], "M_A": r["A_couple"]} | turned


@known
def strut_frame(n: Numbers) -> Numbers:
    P, w, a = (n[x] for x in ("P", "w", "a"))
    s = Structure()
    s.pin("A", (0, 0), "frame")
    s.put("B_n", "frame", (6 * a, a), (-(0.5**0.5), 0.5**0.5))
    s.pin("C", (0, 4 * a), "bracket", "frame")
    s.bar("N", ("frame", (0, a)), ("bracket", (-3 * a, 4 * a)))
    s.load("bracket", (-4 * a, 4 * a), (0, -P))
    s.spread("frame", (0, 0), (0, 4 * a), (w, 0))
    return s.solved()


@known
def a_frame(n: Numbers) -> Numbers:
    s = Structure()
    s.pin("A", (-3, 0), "left")
    s.put("B_y", "right", (3, 0), (0, 1))
    s.pin("C", (0, 4), "left", "right")
    s.pin("D", (-1.5, 2), "bar", "left")
    s.pin("E", (1.5, 2), "bar", "right")
    s.load("left", (-1.5, 2), (0, -n["m"] * n["g"]))
    s.load("right", (1.5, 2), (0, -n["m"] * n["g"]))
    s.load("bar", (0.5, 2), (0, -n["P"]))
    return s.solved()


@known
def three_hinged_arch(n: Numbers) -> Numbers:
    q, w, a = (n[x] for x in ("q", "w", "a"))
    A, B, C = (0, 0), (8 * a, -a), (4 * a, 3 * a)
    s = Structure()
    s.pin("A", A, "left")
    s.pin("B", B, "right")
    s.pin("C", C, "left", "right")
    s.spread("left", A, C, (0, -q))
    s.spread("right", C, B, (-w / sqrt(2), -w / sqrt(2)))
    r = s.solved()
    e, half = np.array([0.8, 0.6]), 2.5 * a
    at_A = np.array([r["A_x"], r["A_y"]])
    across = float(at_A @ (-e[1], e[0]))
    return r | {"N_A": -float(at_A @ e), "M_half": across * half - q * e[0] * half**2 / 2}


@known
def gerber_frame(n: Numbers) -> Numbers:
    q, F, a = (n[x] for x in ("q", "F", "a"))
    s = Structure()
    s.clamp("A", (0, 0), "stem")
    s.pin("B", (2 * a, 3 * a), "beam", "stem")
    s.put("C_n", "beam", (6 * a, 3 * a), (0, 1))
    s.put("C_n", "left", (6 * a, 3 * a), (0, -1))
    s.pin("D", (7 * a, 0), "left")
    s.pin("G", (9 * a, 4 * a), "left", "right")
    s.pin("E", (11 * a, -a), "right")
    s.spread("beam", (2 * a, 3 * a), (6 * a, 3 * a), (0, -q), (0, -2 * q))
    s.load("stem", (0, 3 * a), (F, 0))
    s.spread("right", (11 * a, 3 * a), (11 * a, -a), (-q, 0))
    s.load("left", (7 * a, 3 * a), (0, -F))
    r = s.solved()
    return {k: r[k] for k in ("A_x", "A_y", "B_y", "C_n", "D_x", "D_y", "E_x", "E_y", "G_x")} | {"M_A": r["A_couple"]}


@known
def bolt_cutter(n: Numbers) -> Numbers:
    """The hands' force is one more unknown."""
    Q, a, b, c, d, e, l = (n[x] for x in ("Q", "a", "b", "c", "d", "e", "l"))
    s = Structure()
    s.bar("T", ("upper_jaw", (0, c)), ("lower_jaw", (0, -c)))
    for half, sign in (("upper", 1), ("lower", -1)):
        s.pin(half, (b, sign * e), f"{half}_jaw", f"{half}_handle")
        s.put("P", f"{half}_handle", (b + d + l, sign * 2 * e), (0, -sign))
        s.load(f"{half}_jaw", (-a, sign * c), (0, sign * Q))
    s.pin("M", (b + d, 0), "upper_handle", "lower_handle")
    s.put("symmetry", "upper_handle", (b + d, 0), (0, 1))
    s.pin("stay", (0, c), "upper_jaw")
    s.put("straight", "lower_jaw", (0, -c), (1, 0))
    r = s.solved()
    return {"P": r["P"], "T": r["T"], "H_y": r["upper_y"], "M_y": r["M_y"]}


# -- trusses -------------------------------------------------------------------------------------------------------


def plane_truss(nodes: dict[Any, Any], members: list[str], loads: dict[Any, Any], pin: Any, roller: Any) -> Numbers:
    s = Structure(joints=tuple(nodes))
    for member in members:
        i, j = member.split("-")
        s.bar(member, (i, nodes[i]), (j, nodes[j]))
    s.pin("pin", nodes[pin], pin)
    s.put("roller", roller, nodes[roller], (0, 1))
    for node, force in loads.items():
        s.load(node, nodes[node], force)
    return s.solved()


@known
def fink_truss(n: Numbers) -> Numbers:
    """Built from its geometry: the rafter's quarters, struts across it, the constraint's joints by equal angles."""
    P, W, a = (n[x] for x in ("P", "W", "a"))
    rise = 1 / sqrt(3)
    left = {f"n{k}": (k * a, k * a * rise) for k in (1, 2, 3)}
    left |= {"A": (0, 0), "G": (4 / 3 * a, 0), "L": (8 / 3 * a, 0), "K": (10 / 3 * a, 2 * a * rise)}
    mirrored = {"n1": "n4", "n2": "n5", "n3": "n6", "A": "B", "G": "H", "L": "R", "K": "M"}
    nodes = left | {mirrored[k]: (8 * a - x, y) for k, (x, y) in left.items()} | {"T": (4 * a, 4 * a * rise)}
    half = "A-n1 n1-n2 n2-n3 n3-T A-G G-L n1-G n2-G n2-L n2-K n3-K K-L K-T".split()
    other = ["-".join(mirrored.get(k, k) for k in member.split("-")) for member in half]
    loads = {k: np.array([0, -P]) for k in ("n1", "n2", "n3", "T", "n4", "n5", "n6")}
    for k in ("n1", "n2", "n3"):
        loads[k] = loads[k] + W * np.array([sin(pi / 6), -cos(pi / 6)])
    r = plane_truss(nodes, [*half, *other, "L-R"], loads, "A", "B")
    return {"tie": r["L-R"], "strut": r["n2-L"], "hanger": r["K-T"], "foot": r["A-n1"], "B_y": r["roller"]}


@known
def k_truss(n: Numbers) -> Numbers:
    P, a = n["P"], n["a"]
    nodes = {f"b{k}": (k * a, 0) for k in range(9)} | {f"t{k}": (k * a, 2 * a) for k in range(1, 8)}
    nodes |= {f"m{k}": (k * a, a) for k in (1, 2, 3, 5, 6, 7)}
    members = [f"b{k}-b{k + 1}" for k in range(8)] + [f"t{k}-t{k + 1}" for k in range(1, 7)]
    members += ["b0-t1", "b8-t7", "b4-t4"]
    for k in (1, 2, 3, 5, 6, 7):
        inner = k + 1 if k < 4 else k - 1
        members += [f"b{k}-m{k}", f"m{k}-t{k}", f"m{k}-b{inner}", f"m{k}-t{inner}"]
    r = plane_truss(nodes, members, {"b2": (0, -3 * P), "b5": (0, -2 * P), "t1": (P, 0)}, "b0", "b8")
    requested = {"K_up": "m2-t3", "K_down": "m2-b3", "post": "m2-t2", "chord": "b3-b4", "end": "b0-t1"}
    return {name: r[member] for name, member in requested.items()}


def legs(nodes: dict[str, Any], loads: list[Any], top: str) -> Numbers:
    """A joint in space on bars that stand on the ground."""
    s = Structure(space=True, joints=tuple(nodes))
    for foot in nodes.keys() - {top}:
        s.bar(foot, (foot, nodes[foot]), (top, nodes[top]))
        s.pin(foot, nodes[foot], foot)
    for force in loads:
        s.load(top, nodes[top], force)
    return s.solved()


@known
def tripod(n: Numbers) -> Numbers:
    P, H, a = n["P"], n["H"], n["a"]
    nodes = {"A": (2 * a, 0, 0), "B": (-a, 2 * a, 0), "C": (-a, -2 * a, 0), "top": (0, 0, 4 * a)}
    r = legs(nodes, [(0, 0, -P), (H, 0, 0)], "top")
    return {f"N_{k}": r[k] for k in "ABC"} | {k: r[k] for k in ("A_x", "B_y", "C_z")}


@known
def shear_legs(n: Numbers) -> Numbers:
    P, b, c, h, d = (n[x] for x in ("P", "b", "c", "h", "d"))
    r = legs({"L": (0, b, 0), "R": (0, -b, 0), "anchor": (-d, 0, 0), "top": (c, 0, h)}, [(0, 0, -P)], "top")
    return {"guy": r["anchor"], "spar": r["L"], "L_y": r["L_y"], "L_z": r["L_z"], "anchor_z": r["anchor_z"]}


@known
def trapdoor(n: Numbers) -> Numbers:
    m, g, b, a = (n[x] for x in ("m", "g", "b", "a"))
    up = np.array([cos(pi / 3), 0, sin(pi / 3)])
    s = Structure(space=True)
    s.pin("A", (0, b / 4, 0), "door")
    s.put("B_x", "door", (0, -b / 4, 0), (1, 0, 0))
    s.put("B_z", "door", (0, -b / 4, 0), (0, 0, 1))
    s.bar("T", ("door", a * up - np.array([0, b / 2, 0])), (None, (0, b / 2, 2 * a)))
    s.load("door", a / 2 * up, (0, 0, -m * g))
    return s.solved()


# -- the models against them -----------------------------------------------------------------------------------------


def model_of(name: str, other: bool) -> eomgen.Model:
    """The model file; or the same with every parameter another number."""
    model = eomgen.load(MODELS / f"{name}.toml")
    if not other:
        return model
    rng = Random(name)
    numbers = {x: Fraction(p.value.literal) * Fraction(rng.randint(60, 160), 100) for x, p in model.parameters.items()}
    changed = {x: replace(model.parameters[x], value=as_expression(str(value))) for x, value in numbers.items()}
    return replace(model, parameters=dict(model.parameters) | changed)


@cache
def answers(name: str, other: bool = False) -> dict[str, Any]:
    return eomgen.solve(model_of(name, other))


@each("other", [False, True])
@each("name", KNOWN)
def test_a_structure_of_the_classics_balances(name, other):
    """Every output that equilibrium knows, at two sets of numbers; all of them exact."""
    model = model_of(name, other)
    expected, found = KNOWN[name](model.numeric_parameters()), answers(name, other)
    requested = {output: expected[output] for output in model.outputs}
    assert all(found[output].exact is not None for output in requested)
    scale = max(map(abs, requested.values()))
    assert {output: found[output].value for output in requested} == pytest.approx(requested, rel=1e-9, abs=1e-9 * scale)


@each("name", KNOWN)
def test_virtual_work_and_equilibrium_agree(name):
    """Each reaction from its released mechanism alone is that of the balance of the bodies."""
    found = eomgen.statics(model_of(name, False)).found
    assert found.reactions and not found.disagreeing
    assert all(reaction.agree for reaction in found.reactions)


# -- loose and redundant structures ----------------------------------------------------------------------------------

PLANE = 'eomgen = 1\nspace = "plane"\nparameters = { P = 1, a = 1 }\n'
ONE_BEAM = (
    PLANE
    + """
[bodies.beam]
points = { A = [0, 0], B = ["2*a", 0], C = ["5*a", 0], D = ["a", 0], E = ["a", "-a"] }
[forces]
load = { kind = "force", point = "beam.B", force = [0, "-P"] }
[constraints]
"""
)
TWO_BARS = (
    PLANE
    + """
[bodies.I]
points = { A = [0, 0], C = ["2*a", "a"] }
[bodies.II]
points = { C = ["2*a", "a"], B = ["6*a", "3*a"] }
[forces]
load = { kind = "force", point = "I.C", force = ["P", 0] }
[constraints]
A = { kind = "pin", points = ["I.A"] }
C = { kind = "pin", points = ["I.C", "II.C"] }
"""
)
SQUARE = (
    PLANE
    + """
[trusses.T]
nodes = { A = [0, 0], B = ["a", 0], C = ["a", "a"], D = [0, "a"], E = ["2*a", 0] }
members = ["A-B", "B-C", "C-D", "D-A", "B-E", "C-E"MORE]
[constraints]
A = { kind = "pin", points = ["T.A"] }
D = { kind = "support", point = "T.D", normal = [1, 0] }
[forces]
load = { kind = "force", point = "T.E", force = [0, "-P"] }
"""
)
FOUR_BAR = (
    PLANE
    + """
[bodies.I]
points = { O = [0, 0], A = ["3*a", "4*a"] }
[bodies.II]
points = { A = ["3*a", "4*a"], B = ["9*a", "4*a"] }
[bodies.III]
points = { B = ["9*a", "4*a"], C = ["9*a", 0] }
[constraints]
O = { kind = "pin", points = ["I.O"] }
A = { kind = "pin", points = ["I.A", "II.A"] }
B = { kind = "pin", points = ["II.B", "III.B"] }
C = { kind = "pin", points = ["III.C"] }
[forces]
load = { kind = "force", point = "II.A", force = [0, "-P"] }
"""
)


def roller(name: str, normal: str, point: str | None = None) -> str:
    return f'{name} = {{ kind = "support", point = "beam.{point or name}", normal = {normal} }}\n'


LOOSE = {
    "three parallel rollers": (
        ONE_BEAM + roller("A", "[0, 1]") + roller("B", "[0, 1]") + roller("C", "[0, 1]"),
        "body 'beam' can slide along x",
    ),
    "three supports through one point": (
        ONE_BEAM + roller("A", "[1, 1]") + roller("B", "[-1, 1]") + roller("D", "[0, 1]"),
        "body 'beam' can turn about (a, a)",
    ),
    "two rollers": (ONE_BEAM + roller("A", "[0, 1]") + roller("B", "[1, 1]"), "body 'beam' can turn about (0, -2*a)"),
    "three hinges in line": (
        TWO_BARS + 'B = { kind = "pin", points = ["II.B"] }',
        "body 'I' can turn about (0, 0), with it body 'II' turning about (6*a, 3*a)",
    ),
    "a four-bar linkage": (
        FOUR_BAR,
        "body 'I' can turn about (0, 0), with it body 'II' turning about (9*a, 12*a)",
    ),
    "a truss with an empty panel": (SQUARE.replace("MORE", ""), "member 'A-B' can turn about (0, 0)"),
}
REDUNDANT = {  # the model, degree, {reaction: its value, None where it is open}
    "a propped cantilever": (
        ONE_BEAM + 'A = { kind = "clamp", point = "beam.A" }\n' + roller("C", "[0, 1]"),
        1,
        {"reaction_x(A)": "0", "reaction_y(A)": None, "reaction_couple(A)": None, "reaction_n(C)": None},
    ),
    "a beam on three rollers and a guide": (
        ONE_BEAM + roller("A", "[0, 1]") + roller("B", "[0, 1]") + roller("C", "[0, 1]") + roller("D", "[1, 0]"),
        1,
        {"reaction_n(A)": None, "reaction_n(B)": None, "reaction_n(C)": None, "reaction_n(D)": "0"},
    ),
    "a panel with both diagonals": (
        SQUARE.replace("MORE", ', "A-C", "B-D"'),
        1,
        {
            "tension(T, A-C)": None,
            "tension(T, B-D)": None,
            "tension(T, B-E)": "-P",
            "tension(T, C-E)": "sqrt(2)*P",
            "reaction_x(A)": "2*P",
            "reaction_n(D)": "-2*P",
        },
    ),
}


@each("name", LOOSE)
def test_a_loose_structure_is_refused_with_the_motion_named(name):
    """The rank of the equations of equilibrium is less than their number: some bodies can move."""
    text, motion = LOOSE[name]
    with pytest.raises(eomgen.DerivationError) as refused:
        eomgen.statics(eomgen.loads(text))
    assert motion in str(refused.value), str(refused.value)
    assert "fix:" in str(refused.value)


@each("name", REDUNDANT)
def test_a_redundant_structure_keeps_its_determinate_forces(name):
    """Degree = reactions - rank; what no self-stress reaches has a value, by both ways."""
    text, degree, expected = REDUNDANT[name]
    found = eomgen.statics(eomgen.loads(text))
    assert found.found.structure.indeterminacy == degree
    assert found.ok
    assert {reaction: found.exact[reaction] for reaction in expected} == expected
