"""How work grows with the number of bodies: python benchmarks/growth.py [--quick]

Chains, trees and loops of n bodies: CPU seconds from Model to the graph of the equations, of their linearization and
of their proof, operations of the right-hand side; beside them what peers need for the chain. The exponent is the slope
of log(work) over log(n), by least squares over the sizes shown.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from time import process_time

sys.path.insert(0, str(Path(__file__).parents[1] / "models"))
sys.path.insert(0, str(Path(__file__).parent))

import numpy as np
from certificates import measured
from chain import chain
from derivation import peer
from four_bars import four_bars
from space import tree

import eomgen

CALLS = 2000  # of a compiled peer
Measured = Callable[[int], float]


def tree_of(n: int) -> str:
    """n hinged bodies in space, every third on a body of its own choice."""
    return tree(n, ("revolute",), 1 / 3)


SYSTEMS: dict[str, Callable[[int], str]] = {"chain": chain, "tree": tree_of, "row of four-bars": four_bars}


def spent(work: Callable[[], object]) -> float:
    """The less CPU time of two runs [s]."""
    took = []
    for _ in range(2):
        begun = process_time()
        work()
        took.append(process_time() - begun)
    return min(took)


def deriving(make: Callable[[int], str]) -> Measured:
    """n -> seconds from Model to equations on the graph."""

    def of(n: int) -> float:
        model = eomgen.loads(make(n))
        return spent(lambda: eomgen.derive(model))

    return of


def operating(make: Callable[[int], str]) -> Measured:
    """n -> operations of the right-hand side."""
    return lambda n: eomgen.derive(eomgen.loads(make(n))).program.count.total


def linearizing(make: Callable[[int], str]) -> Measured:
    """n -> seconds of M, C, K and modes at rest."""

    def of(n: int) -> float:
        model = eomgen.loads(make(n))
        return spent(lambda: eomgen.linearize(model).A)

    return of


def proving(make: Callable[[int], str]) -> Measured:
    """n -> seconds of the proof of the equations and of their numpy code."""
    return lambda n: measured(make(n))[1]


# -- peers ---------------------------------------------------------------------------------------------------


def by_sympy(method: str) -> Measured:
    """n -> seconds of one of sympy's methods for a chain."""
    return lambda n: peer(method, n).seconds or float("nan")


def by_casadi(n: int) -> float:
    """Operations of the right-hand side of a chain: M and the rest from T and V by derivatives, M factored."""
    import casadi as ca

    q, u = ca.SX.sym("q", n), ca.SX.sym("u", n)
    x = y = vx = vy = T = V = ca.SX(0)
    angle = rate = ca.SX(0)
    for k in range(n):
        angle, rate = angle + q[k], rate + u[k]
        s, c = ca.sin(angle), ca.cos(angle)
        T += ((vx + c * rate / 4) ** 2 + (vy + s * rate / 4) ** 2) / 2 + rate**2 / 96
        V += 9.81 * (y - c / 4)
        x, y, vx, vy = x + s / 2, y - c / 2, vx + c * rate / 2, vy + s * rate / 2
    momentum = ca.gradient(T, u)
    M = ca.jacobian(momentum, u)
    force = ca.gradient(T, q) - ca.gradient(V, q) - ca.jtimes(momentum, q, u)
    D, L, p = ca.ldl(M)
    f = ca.Function("f", [q, u], [ca.ldl_solve(force, D, L, p)])
    return float(f.n_instructions())


def by_pinocchio(n: int) -> float:
    """Seconds of one call of the articulated body algorithm for a chain."""
    import pinocchio as pin

    model, parent = pin.Model(), 0
    for k in range(n):
        place = pin.SE3(np.eye(3), np.array([0, 0, -0.5 * (k > 0)]))
        parent = model.addJoint(parent, pin.JointModelRY(), place, f"q{k}")
        model.appendBodyToJoint(parent, pin.Inertia(1.0, np.array([0, 0, -0.25]), np.eye(3) / 48), pin.SE3.Identity())
    data, q, v = model.createData(), np.full(n, 0.1), np.full(n, 0.2)

    def calls() -> None:
        for _ in range(CALLS):
            pin.aba(model, data, q, v, v)

    return spent(calls) / CALLS


Row = tuple[str, str, Measured, Sequence[int], str]
"""(what, of what system, n -> work, sizes, its unit)"""


def rows_of_work(quick: bool) -> Iterator[Row]:
    """Everything that is measured."""
    some = 3 if quick else 4
    for name, make in SYSTEMS.items():
        yield "equations on the graph", name, deriving(make), (10, 20, 40, 80)[:some], "s"
        yield "operations of the right-hand side", name, operating(make), (10, 20, 40, 80)[:some], ""
        yield "linearization", name, linearizing(make), (4, 8, 16), "s"
        yield "proof", name, proving(make), (10, 20, 40)[:some], "s"
    yield "equations, sympy KanesMethod", "chain", by_sympy("kane"), (5, 8) if quick else (5, 10, 15), "s"
    yield "equations, sympy LagrangesMethod", "chain", by_sympy("lagrange"), (2, 4) if quick else (3, 5, 8), "s"
    yield "operations, CasADi (derivatives of T and V)", "chain", by_casadi, (10, 20, 40), ""
    yield "a call, Pinocchio ABA (from Python)", "chain", by_pinocchio, (10, 20, 40, 80)[:some], "s"


def exponent(sizes: Sequence[int], work: Sequence[float]) -> float:
    """The slope of log(work) over log(n)."""
    return float(np.polyfit(np.log(sizes), np.log(work), 1)[0])


NEEDS = {by_casadi: "casadi", by_pinocchio: "pinocchio"}


def table(quick: bool) -> Iterator[str]:
    """The lines of the table, one after the other."""
    yield "| work | system | n | measured | exponent |"
    yield "|---|---|---|---|---|"
    for what, name, work, sizes, unit in rows_of_work(quick):
        try:
            import_module(NEEDS.get(work, "eomgen"))
        except ImportError:
            yield f"| {what} | {name} | | missing here | |"
            continue
        found = [work(n) for n in sizes]
        reported = ", ".join(f"{x:.3g} {unit}".strip() if unit else f"{x:.0f}" for x in found)
        yield f"| {what} | {name} | {', '.join(map(str, sizes))} | {reported} | {exponent(sizes, found):.2f} |"


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--quick", action="store_true", help="smaller sizes")
    for line in table(words.parse_args().quick):
        print(line, flush=True)


if __name__ == "__main__":
    main()
