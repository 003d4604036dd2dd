"""Trusses: nodes in balance, members by the method of joints, exact surds; nodes hinged to bodies and to one another.

At every node  sum of S_k e_k + F = 0,  S_k the tension of a member, e_k along it away from the node.
"""

from __future__ import annotations

from math import hypot, sqrt
from pathlib import Path
from random import Random

import numpy as np
import pytest
from float_statics import Structure

import eomgen

TRIANGLE = Path(__file__).parents[1] / "helpers" / "truss.toml"

Nodes = dict[str, tuple[float, ...]]


def model(nodes: Nodes, members: list[str], rest: str, *, space: str = "plane", parameters: str = "") -> eomgen.Model:
    """A truss T with supports and loads."""
    written = ", ".join(f"{name} = [{', '.join(map(str, at))}]" for name, at in nodes.items())
    listed = ", ".join(f'"{member}"' for member in members)
    return eomgen.loads(
        f'eomgen = 1\nname = "truss"\nspace = "{space}"\n[parameters]\n{parameters}\n'
        f"[trusses.T]\nnodes = {{ {written} }}\nmembers = [{listed}]\n{rest}"
    )


def requested(members: list[str]) -> str:
    return "[outputs]\n" + "".join(f'"{m.replace("-", "_")}" = "tension(T, {m})"\n' for m in members)


def answers(found: eomgen.Model) -> dict[str, float]:
    solved = eomgen.solve(found)
    assert {name: a.message for name, a in solved.items() if a.value is None} == {}
    return {name: float(a.value) for name, a in solved.items()}


def grown(rng: Random, count: int) -> tuple[Nodes, list[str]]:
    """A simple truss: a triangle, then node after node with two members, each wide enough apart."""
    nodes: Nodes = {"n0": (0, 0), "n1": (rng.randint(2, 5), rng.randint(-1, 1)), "n2": (rng.randint(1, 3), 3)}
    members = ["n0-n1", "n1-n2", "n0-n2"]
    while len(nodes) < count:
        a, b = rng.sample(sorted(nodes), 2)
        at = (rng.randint(-6, 9), rng.randint(-6, 9))
        (ax, ay), (bx, by) = nodes[a], nodes[b]
        area = (ax - at[0]) * (by - at[1]) - (ay - at[1]) * (bx - at[0])
        if abs(area) >= 3 and at not in nodes.values():
            name = f"n{len(nodes)}"
            nodes[name] = at
            members += [f"{a}-{name}", f"{name}-{b}"]
    return nodes, members


@pytest.mark.parametrize("seed", range(4))
def test_members_are_those_of_the_method_of_joints(seed):
    """Against the balance of all nodes in floats; the supports at random nodes, one of them inclined."""
    rng = Random(seed)
    nodes, members = grown(rng, 7)
    held, rolled = rng.sample(sorted(nodes), 2)
    loads = {name: (rng.randint(-5, 5), rng.randint(-5, 5)) for name in rng.sample(sorted(nodes), 4)}
    r = np.subtract(nodes[rolled], nodes[held])
    normal = (-int(r[1]) + 1, int(r[0]) + 1)  # not through the hinge
    rest = f'[constraints]\nA = {{ kind = "pin", points = ["T.{held}"] }}\n'
    rest += f'B = {{ kind = "support", point = "T.{rolled}", normal = [{normal[0]}, {normal[1]}] }}\n[forces]\n'
    rest += "".join(
        f'f{k} = {{ kind = "force", point = "T.{n}", force = [{x}, {y}] }}\n'
        for k, (n, (x, y)) in enumerate(loads.items())
    )
    found = answers(model(nodes, members, rest + requested(members) + 'A_x = "reaction_x(A)"\nB = "reaction_n(B)"\n'))
    structure = Structure(joints=nodes)
    for member in members:
        i, j = member.split("-")
        structure.bar(member.replace("-", "_"), (i, nodes[i]), (j, nodes[j]))
    structure.pin("A", nodes[held], held)
    structure.put("B", rolled, nodes[rolled], np.array(normal) / hypot(*normal))
    for name, force in loads.items():
        structure.load(name, nodes[name], force)
    expected = structure.solved()
    assert found == pytest.approx({name: expected[name] for name in found}, abs=1e-9)


def test_lengths_with_roots_stay_exact():
    """At the top of a triangle 6 a wide and a high: 2 S/sqrt(10) = -P, S = -sqrt(10)/2 P; the constraint carries 3/2
    P."""
    nodes: Nodes = {"n1": (0, 0), "n2": ('"6*a"', 0), "n3": ('"3*a"', '"a"')}  # type: ignore[dict-item]
    rest = '[constraints]\nA = { kind = "pin", points = ["T.n1"] }\n'
    rest += 'B = { kind = "support", point = "T.n2", normal = [0, 1] }\n'
    rest += '[forces.f]\nkind = "force"\npoint = "T.n3"\nforce = [0, "-P"]\n'
    members = ["n1-n2", "n2-n3", "n1-n3"]
    found = eomgen.solve(model(nodes, members, rest + requested(members), parameters="P = {}\na = { positive = true }"))
    assert [a.exact for a in found.values()] == ["3/2*P", "-1/2*sqrt(10)*P", "-1/2*sqrt(10)*P"]


def test_a_member_is_asked_in_either_order_and_by_its_two_nodes():
    """tension(T, n1-n2) = tension(T, n2-n1) = tension(T, n1, n2)"""
    text = TRIANGLE.read_text() + 'back = "tension(T, n2 - n1)"\napart = "tension(T, n2, n1)"\n'
    assert {a.exact for a in eomgen.solve(eomgen.loads(text)).values()} == {"1/2*P"}


def test_symbolic_panels_and_heights_stay_short_in_long_trusses():
    """A parallel truss of n panels a wide and h high under P: the first bottom chord carries a/h times its support."""
    n = 12
    nodes: Nodes = {f"b{k}": (f'"{k}*a"', 0) for k in range(n + 1)}  # type: ignore[misc]
    nodes |= {f"t{k}": (f'"{k}*a"', '"h"') for k in range(1, n)}  # type: ignore[misc]
    members = [f"b{k}-b{k + 1}" for k in range(n)] + [f"t{k}-t{k + 1}" for k in range(1, n - 1)]
    members += [f"b{k}-t{k}" for k in range(1, n)] + ["b0-t1", f"b{n}-t{n - 1}"]
    members += [f"t{k}-b{k + 1}" if k < n // 2 else f"b{k}-t{k + 1}" for k in range(1, n - 1)]
    rest = '[constraints]\nA = { kind = "pin", points = ["T.b0"] }\n'
    rest += f'B = {{ kind = "support", point = "T.b{n}", normal = [0, 1] }}\n'
    rest += '[forces.f]\nkind = "force"\npoint = "T.b3"\nforce = [0, "-P"]\n'
    rest += '[outputs]\nchord = "tension(T, b0-b1)"\nfirst = "tension(T, b0-t1)"\npost = "tension(T, b1-t1)"\n'
    found = eomgen.solve(model(nodes, members, rest, parameters="P = {}\na = { positive = true }\nh = {}"))
    assert {name: a.exact for name, a in found.items()} == {
        "chord": "3*P*a/(4*h)",
        "first": "-3*P*sqrt(a^2 + h^2)/(4*h)",
        "post": "0",
    }


def test_a_truss_in_space_is_in_balance_at_every_node():
    """A tripod under F: sum of S_k e_k + F = 0, three rows a node."""
    feet = {"a": (2.0, 0.0, 0.0), "b": (-1.0, 2.0, 0.5), "c": (-2.0, -1.0, -1.0)}
    top, F = np.array([0.5, 0.25, 3.0]), np.array([1.0, -2.0, -5.0])
    rest = "[constraints]\n" + "".join(f'{k} = {{ kind = "pin", points = ["T.{k}"] }}\n' for k in feet)
    rest += f'[forces.f]\nkind = "force"\npoint = "T.top"\nforce = {F.tolist()}\n'
    members = [f"top-{k}" for k in feet]
    nodes: Nodes = {"top": tuple(top), **feet}
    outputs = requested(members) + "".join(f'R{k}{x} = "reaction_{x}({k})"\n' for k in feet for x in "xyz")
    found = answers(model(nodes, members, rest + outputs, space="space"))
    arms = {k: (np.array(at) - top) / np.linalg.norm(np.array(at) - top) for k, at in feet.items()}
    assert sum(found[f"top_{k}"] * e for k, e in arms.items()) + F == pytest.approx(np.zeros(3), abs=1e-9)
    for k, e in arms.items():
        assert [found[f"R{k}{x}"] for x in "xyz"] == pytest.approx(found[f"top_{k}"] * e, abs=1e-9)


JOINED = """
eomgen = 1
name = "a beam on two trusses, one beside the other"
space = "plane"
[trusses.T]
nodes = { a = [0, 0], b = [2, 0], c = [1, 1] }
members = ["a-b", "b-c", "a-c"]
[trusses.U]
nodes = { a = [2, 0], b = [4, 0], c = [3, 2] }
members = ["b-c", "a-c"]
[bodies.beam]
points = { left = [1, 1], right = [3, 2], middle = [2, 1.5] }
[constraints]
A = { kind = "pin", points = ["T.a"] }
both = { kind = "pin", points = ["T.b", "U.a"] }
C = { kind = "pin", points = ["U.b"] }
on_T = { kind = "pin", points = ["beam.left", "T.c"] }
on_U = { kind = "pin", points = ["beam.right", "U.c"] }
[forces.f]
kind = "force"
point = "beam.middle"
force = [0, -6]
"""


def test_nodes_are_hinged_to_bodies_and_to_nodes_of_other_trusses():
    """A beam from T.c to U.c by hinges is a bar more between them: its load goes half to each end."""
    text = JOINED + '[outputs]\nab = "tension(T, a-b)"\nbc = "tension(T, b-c)"\nac = "tension(T, a-c)"\n'
    text += 'u_ac = "tension(U, a-c)"\nu_bc = "tension(U, b-c)"\n'
    text += 'left = "reaction_y(on_T)"\nnode = "reaction_y(on_T.T.c)"\nshared = "reaction_x(both.U.a)"\n'
    found = answers(eomgen.loads(text))
    assert found["left"] + found["node"] == pytest.approx(0)  # action and reaction
    assert found["shared"] == pytest.approx(-found["u_ac"] / sqrt(5))  # U.a: x of its one member and of the hinge
    structure = Structure(joints=("a", "b", "c", "d", "e"))  # T.a, T.b = U.a, T.c, U.b, U.c
    places = {"a": (0, 0), "b": (2, 0), "c": (1, 1), "d": (4, 0), "e": (3, 2)}
    for name, (i, j) in {"ab": "ab", "bc": "bc", "ac": "ac", "u_ac": "be", "u_bc": "de"}.items():
        structure.bar(name, (i, places[i]), (j, places[j]))
    structure.pin("A", places["a"], "a")
    structure.pin("C", places["d"], "d")
    structure.pin("on_T", places["c"], "beam", "c")
    structure.pin("on_U", places["e"], "beam", "e")
    structure.load("beam", (2, 1.5), (0, -6))
    expected = structure.solved()
    assert found["left"] == pytest.approx(expected["on_T_y"])
    assert found == pytest.approx({**found, **{k: expected[k] for k in ("ab", "bc", "ac", "u_ac", "u_bc")}})


WRONG = {
    "no length": ('n3 = ["a", "a"]', "n3 = [0, 0]", "member 'n1-n3' of truss 'T' has no length"),
    "an unknown node": ('"n2-n3"', '"n2-n4"', "truss 'T' has no node 'n4'"),
    "twice": ('"n1-n3"]', '"n1-n3", "n3-n1"]', "member 'n3-n1' of truss 'T' stands there twice"),
    "one node": ('"n2-n3"', '"n2-n2"', "'n2-n2' is no member"),
    "an idle node": ('n3 = ["a", "a"] }', 'n3 = ["a", "a"], n4 = [9, 9] }', "node 'n4' of truss 'T' has no member"),
    "no such member": ("tension(T, n1-n2)", "tension(T, n1-n5)", "truss 'T' has no member 'n1-n5'"),
    "no member": ("tension(T, n1-n2)", "tension(T)", "'tension(T)' names no member"),
}


@pytest.mark.parametrize(("old", "new", "reported"), WRONG.values(), ids=WRONG)
def test_a_wrong_truss_is_refused_by_name(old, new, reported):
    """What, where, fix."""
    text = TRIANGLE.read_text()
    assert old in text
    with pytest.raises(eomgen.EomgenError, match=reported.replace("(", r"\(").replace(")", r"\)")):
        eomgen.derive(eomgen.loads(text.replace(old, new)))


def test_a_loose_member_is_named():
    """Without the member n2-n3 nothing keeps n1-n3 from turning about n1."""
    loose = eomgen.loads(TRIANGLE.read_text().replace('"n2-n3", ', ""))
    (answer,) = eomgen.solve(loose).values()
    assert answer.value is None and "member 'n1-n3' can turn about (0, 0)" in answer.message
