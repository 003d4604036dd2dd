"""One derivation by sympy.physics.mechanics, timed, as one line of JSON: python benchmarks/peers.py kane 10

Each method has the coordinates that suit it best: angles from the vertical, every frame turned straight from the
ground's. The clock runs from the declaration to the symbolic mass matrix and forcing; importing sympy is not counted.
"""

from __future__ import annotations

import json
import sys
import time
import tomllib
from pathlib import Path

import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Lagrangian,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

MODELS = Path(__file__).parent.parent / "models"


def operations(expressions) -> int:
    """Operations after cse by the rule of eomgen: each + - * / power and function once, signs and constants free."""
    replacements, reduced = sp.cse(list(expressions))
    total = 0
    for e in [e for _, e in replacements] + list(reduced):
        for node in sp.preorder_traversal(e):
            if node.is_Add:
                total += len(node.args) - 1
            elif node.is_Mul:
                total += len([a for a in node.args if a != -1]) - 1
            elif node.is_Pow:  # 1/x within a product is its division, counted there
                total += node.exp != -1
            elif node.is_Function and not isinstance(node, sp.core.function.AppliedUndef):
                total += 1
    return total


def chain_bodies(n, q, N, rates=None):
    """The n rods, their weights, and the potential energy, for angles q from the vertical."""
    m, l, g = sp.symbols(f"m1:{n + 1}"), sp.symbols(f"l1:{n + 1}"), sp.symbols("g")
    O = Point("O")
    O.set_vel(N, 0)
    bodies, loads, joint = [], [], O
    for i in range(n):
        A = N.orientnew(f"A{i}", "Axis", (q[i], N.z))
        if rates is not None:
            A.set_ang_vel(N, rates[i] * N.z)
        C = joint.locatenew(f"C{i}", -l[i] / 2 * A.y)
        C.v2pt_theory(joint, N, A)
        end = joint.locatenew(f"P{i}", -l[i] * A.y)
        end.v2pt_theory(joint, N, A)
        body = RigidBody(f"rod{i}", C, A, m[i], (inertia(A, 0, 0, m[i] * l[i] ** 2 / 12), C))
        body.potential_energy = m[i] * g * C.pos_from(O).dot(N.y)
        bodies.append(body)
        loads.append((C, -m[i] * g * N.y))
        joint = end
    return bodies, loads


def lagrange_chain(n: int):
    """M and forcing of the chain by LagrangesMethod."""
    q, N = dynamicsymbols(f"q1:{n + 1}"), ReferenceFrame("N")
    bodies, _ = chain_bodies(n, q, N)
    method = LagrangesMethod(Lagrangian(N, *bodies), list(q))
    method.form_lagranges_equations()
    return method.mass_matrix, method.forcing


def kane_chain(n: int):
    """M and forcing of the chain by KanesMethod."""
    q, u, N = dynamicsymbols(f"q1:{n + 1}"), dynamicsymbols(f"u1:{n + 1}"), ReferenceFrame("N")
    bodies, loads = chain_bodies(n, q, N, rates=u)
    return kane(N, q, u, bodies, loads)


def kane_arm(n: int):
    """M and forcing of the first n axes of models/arm7.toml by KanesMethod."""
    table = tomllib.loads((MODELS / "arm7.toml").read_text())
    q, u, N = dynamicsymbols(f"q1:{n + 1}"), dynamicsymbols(f"u1:{n + 1}"), ReferenceFrame("N")
    g, O = sp.symbols("g"), Point("O")
    O.set_vel(N, 0)
    frame, origin, bodies, loads = N, O, [], []
    for i, body in enumerate(list(table["bodies"].values())[:n]):
        joint = body["joint"]
        turned = sp.pi / 2 * {"pi/2": 1, "-pi/2": -1, None: 0}[joint.get("turned", {}).get("angle")]
        fixed = frame.orientnew(f"F{i}", "Axis", (turned, frame.x))
        A = fixed.orientnew(f"A{i}", "Axis", (q[i], fixed.z))
        A.set_ang_vel(fixed, u[i] * fixed.z)
        x, y, z = (sp.Rational(str(value)) for value in joint["at"])
        P = origin.locatenew(f"P{i}", x * frame.x + y * frame.y + z * frame.z)
        P.v2pt_theory(origin, N, frame)
        m, (cx, cy, cz) = sp.Symbol(body["mass"]), map(sp.Symbol, body["center"])
        C = P.locatenew(f"C{i}", cx * A.x + cy * A.y + cz * A.z)
        C.v2pt_theory(P, N, A)
        bodies.append(RigidBody(f"link{i}", C, A, m, (inertia(A, *map(sp.Symbol, body["inertia"])), C)))
        loads.append((C, -m * g * N.z))
        frame, origin = A, P
    return kane(N, q, u, bodies, loads)


def kane(N, q, u, bodies, loads):
    """M and forcing of KanesMethod with u = q'."""
    kinematic = [rate - coordinate.diff() for rate, coordinate in zip(u, q, strict=True)]
    method = KanesMethod(N, list(q), list(u), kinematic)
    method.kanes_equations(bodies, loads)
    return method.mass_matrix, method.forcing


PEERS = {"lagrange": lagrange_chain, "kane": kane_chain, "kane-arm": kane_arm}

if __name__ == "__main__":
    peer, size = sys.argv[1], int(sys.argv[2])
    start = time.process_time()
    M, forcing = PEERS[peer](size)
    seconds = time.process_time() - start
    entries = [M[i, j] for i in range(M.rows) for j in range(i, M.cols)] + list(forcing)
    print(json.dumps({"seconds": seconds, "operations": operations(entries)}))
