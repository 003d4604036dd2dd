"""Structures and composite bodies: all reactions and moments of inertia, side by side with sympy in one run.

    python benchmarks/instants.py [-o benchmarks/instants.md]

The clock starts at the frozen Model here, at the made object there; dimensions and loads are symbols on both sides.
The table stands in benchmarks/instants.md.
"""

from __future__ import annotations

import argparse
import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import sympy
from sympy.physics.continuum_mechanics.beam import Beam
from sympy.physics.continuum_mechanics.truss import Truss
from sympy.physics.mechanics import Dyadic, Point, ReferenceFrame, RigidBody, inertia

import eomgen

Place = tuple[str, int, int]  # name, and how many panels to the right and heights up


def best(work: Callable[[], Any], runs: int = 3) -> float:
    """The shortest of several runs [s]."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def truss(panels: int) -> tuple[list[Place], list[tuple[str, str]]]:
    """A Pratt truss: nodes and 4 panels - 3 members."""
    nodes = [(f"L{i}", i, 0) for i in range(panels + 1)] + [(f"U{i}", i, 1) for i in range(1, panels)]
    chords = [(f"L{i}", f"L{i + 1}") for i in range(panels)] + [(f"U{i}", f"U{i + 1}") for i in range(1, panels - 1)]
    posts = [(f"L{i}", f"U{i}") for i in range(1, panels)]
    half = panels // 2
    braces = [(f"U{i}", f"L{i + 1}") if i < half else (f"L{i}", f"U{i + 1}") for i in range(1, panels - 1)]
    return nodes, [*chords, *posts, *braces, ("L0", "U1"), (f"U{panels - 1}", f"L{panels}")]


def truss_model(panels: int) -> eomgen.Model:
    """The truss with panels a, height h and P down at every lower node."""
    nodes, members = truss(panels)
    loads = {f"F{i}": {"kind": "force", "point": f"T.L{i}", "force": [0, "-P"]} for i in range(1, panels)}
    return eomgen.Model(
        space="plane",
        parameters={"a": {"positive": True}, "h": {"positive": True}, "P": {}},
        trusses={
            "T": {"nodes": {n: [f"{x}*a", f"{y}*h"] for n, x, y in nodes}, "members": [f"{i}-{j}" for i, j in members]}
        },
        constraints={
            "A": {"kind": "pin", "points": ["T.L0"]},
            "B": {"kind": "support", "point": f"T.L{panels}", "normal": [0, 1]},
        },
        forces=loads,
        outputs={f"N{k}": f"tension(T, {i}-{j})" for k, (i, j) in enumerate(members)},
    )


def solved_truss(panels: int) -> Truss:
    """The same truss, solved by sympy."""
    a, h, P = sympy.symbols("a h P", positive=True)
    nodes, members = truss(panels)
    t = Truss()
    t.add_node(*((name, x * a, y * h) for name, x, y in nodes))
    t.add_member(*((f"{i}_{j}", i, j) for i, j in members))
    t.apply_support(("L0", "pinned"), (f"L{panels}", "roller"))
    for i in range(1, panels):
        t.apply_load((f"L{i}", P, 270))
    t.solve()
    return t


def beam_model(spans: int) -> eomgen.Model:
    """A Gerber beam: a part with two supports, then parts hinged to the one before, a support in their middle."""
    stands = ["3*a/4", *(f"{i}*a + a/2" for i in range(1, spans))]
    bodies = {
        f"b{i}": {"points": {"A": [f"{i}*a", 0], "B": [f"{i + 1}*a", 0], "S": [at, 0]}} for i, at in enumerate(stands)
    }
    constraints: dict[str, Any] = {"A": {"kind": "pin", "points": ["b0.A"]}}
    constraints |= {f"S{i}": {"kind": "support", "point": f"b{i}.S", "normal": [0, 1]} for i in range(spans)}
    constraints |= {f"H{i}": {"kind": "pin", "points": [f"b{i - 1}.B", f"b{i}.A"]} for i in range(1, spans)}
    loads = {
        f"q{i}": {"kind": "distributed", "body": f"b{i}", "between": ["A", "B"], "intensity": [0, "-p"]}
        for i in range(spans)
    }
    return eomgen.Model(
        space="plane",
        parameters={"a": {"positive": True}, "p": {}},
        bodies=bodies,
        constraints=constraints,
        forces=loads,
        outputs={f"R{i}": f"reaction_n(S{i})" for i in range(spans)},
    )


def solved_beam(spans: int) -> Beam:
    """The same beam, solved by sympy (with its deflections: it gives the reactions in no other way)."""
    a, p, E, I = sympy.symbols("a p E I", positive=True)
    beam = Beam(spans * a, E, I)
    reactions = [beam.apply_support(0, "pin"), beam.apply_support(3 * a / 4, "roller")]
    for i in range(1, spans):
        beam.apply_rotation_hinge(i * a)
        reactions.append(beam.apply_support(i * a + a / 2, "roller"))
    beam.apply_load(-p, 0, 0, end=spans * a)
    beam.solve_for_reaction_loads(*reactions)
    return beam


def composite_model(parts: int) -> eomgen.Model:
    """Boxes side by side, each with its own mass: about the origin."""
    pieces = [
        {"kind": "box", "size": ["a", "b", "c"], "mass": "m", "at": [f"{k}*a", f"{k % 3}*b", f"{k % 5}*c"]}
        for k in range(parts)
    ]
    names = {name: {"positive": True} for name in "abcm"}
    axes = [(i, j) for i in "xyz" for j in "xyz" if i <= j]
    return eomgen.Model(
        space="space",
        parameters=names,
        points={"O": [0, 0, 0]},
        bodies={"B": {"parts": pieces}},
        outputs={f"I_{i}{j}": f"inertia_tensor(O, {i}, {j})" for i, j in axes},
    )


def solved_composite(parts: int) -> Any:
    """The same tensor by sympy, its entries multiplied out."""
    a, b, c, m = sympy.symbols("a b c m", positive=True)
    frame, origin, total = ReferenceFrame("N"), Point("O"), Dyadic(0)
    for k in range(parts):
        center = origin.locatenew(f"C{k}", k * a * frame.x + (k % 3) * b * frame.y + (k % 5) * c * frame.z)
        own = inertia(frame, *(m * (u**2 + v**2) / 12 for u, v in ((b, c), (a, c), (a, b))))
        total += RigidBody(f"B{k}", center, frame, m, (own, center)).parallel_axis(origin, frame)
    return total.to_matrix(frame).applyfunc(sympy.expand)


def solved(model: eomgen.Model) -> None:
    """Every output, exactly."""
    for answer in eomgen.solve(model).values():
        if answer.exact is None:
            raise SystemExit(f"no answer: {answer.message}")


COLUMNS = ("system", "solve [s]", "statics, both ways, with report [s]", "sympy [s]", "sympy/solve")


def row(name: str, model: eomgen.Model, peer: Callable[[], Any] | None, both: bool = True) -> str:
    """One line of the table."""
    own = best(lambda: solved(model))
    two = f"{best(lambda: str(eomgen.statics(model)), 1):.3g}" if both else "-"
    theirs = None if peer is None else best(peer, 1)
    peers = ("-", "-") if theirs is None else (f"{theirs:.3g}", f"{theirs / own:.0f}")
    return "| " + " | ".join((name, f"{own:.3g}", two, *peers)) + " |"


def table() -> list[str]:
    """Every measurement."""
    return [
        row("Pratt truss, 13 members", truss_model(4), lambda: solved_truss(4)),
        row("Pratt truss, 29 members", truss_model(8), None),  # sympy: minutes
        row("Pratt truss, 61 members", truss_model(16), None),
        row("Pratt truss, 101 members", truss_model(26), None),
        row("Gerber beam, 2 spans", beam_model(2), lambda: solved_beam(2)),
        row("Gerber beam, 4 spans", beam_model(4), lambda: solved_beam(4)),
        row("Gerber beam, 30 spans", beam_model(30), None),
        row("40 boxes, tensor about a point", composite_model(40), lambda: solved_composite(40), both=False),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, help="write the section there instead of to stdout")
    arguments = parser.parse_args()
    page = "\n".join(
        (
            "# Structures and composites, side by side with sympy",
            "",
            f"Made by `python benchmarks/instants.py` on Python {platform.python_version()}, "
            f"sympy {sympy.__version__}, {platform.machine()}.",
            "All dimensions and loads are symbols. `solve` is every tension, reaction or moment, exactly; `statics`",
            "adds virtual work, with the released mechanism of each reaction, and the whole report. `-`: not run.",
            "",
            "| " + " | ".join(COLUMNS) + " |",
            "|" + "---|" * len(COLUMNS),
            *table(),
            "",
        )
    )
    if arguments.output is None:
        print(page, end="")
    else:
        arguments.output.write_text(page)


if __name__ == "__main__":
    main()
