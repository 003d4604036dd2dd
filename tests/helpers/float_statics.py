"""Structures in floats: what the equilibrium of every body and joint says; nothing of eomgen is used here.

The unknown forces and couples are put on the bodies one by one; all of sum F = 0 and sum M_O = 0 together have one
solution, or the structure is loose or indeterminate.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Vector = np.ndarray
Numbers = dict[str, float]
End = tuple[str | None, Sequence[float]]


def three(values: Sequence[float]) -> Vector:
    """A vector of the plane or of space as one of space."""
    return np.array([*values, 0.0][:3], dtype=float)


def the_solution(rows: Sequence[Vector], right: Sequence[float]) -> Vector:
    """The one solution of linear equations, of which there may be more than unknowns.

    Raises:
        AssertionError: there is none, or more than one.
    """
    A, b = np.array(rows, dtype=float), np.array(right, dtype=float)
    found, _, rank, _ = np.linalg.lstsq(A, b, rcond=1e-12)
    assert rank == A.shape[1], "more than one solution"
    assert np.allclose(A @ found, b, atol=1e-10 * max(1.0, abs(b).max())), "no solution"
    return found


class Structure:
    """Unknown forces and couples on bodies and joints, and their loads.

    Args:
        space: six equations a body; else three of the plane.
        joints: points without moments to balance.
    """

    def __init__(self, space: bool = False, joints: Sequence[object] = ()) -> None:
        self.axes = range(3) if space else range(2)
        self.kept = range(6) if space else (0, 1, 5)
        self.joints = {str(joint) for joint in joints}
        self.units: dict[str, dict[str, Vector]] = {}
        self.loads: dict[str, Vector] = {}

    def put(self, unknown: str, body: str, at, force=(0, 0), couple=(0, 0, 0)) -> None:
        """A unit of the unknown acts so on the body."""
        of = self.units.setdefault(body, {})
        of[unknown] = of.get(unknown, 0) + six(at, force, couple)

    def load(self, body: str, at, force=(0, 0), couple=(0, 0, 0)) -> None:
        self.loads[body] = self.loads.get(body, 0) + six(at, force, couple)

    def spread(self, body: str, start, end, first, last=None) -> None:
        """A load along a line, from `first` to `last` a unit of length: two Gauss points integrate q(s) r(s)."""
        a, b, q0 = three(start), three(end), three(first)
        q1 = q0 if last is None else three(last)
        for s in ((1 - 3**-0.5) / 2, (1 + 3**-0.5) / 2):
            self.load(body, a + s * (b - a), np.linalg.norm(b - a) / 2 * (q0 + s * (q1 - q0)))

    def pin(self, name: str, at, body: str, other: str | None = None) -> None:
        """A hinge (in space a ball joint) on the ground or on another body: its force on the first."""
        for k in self.axes:
            unit = np.eye(3)[k]
            self.put(f"{name}_{'xyz'[k]}", body, at, unit)
            if other is not None:
                self.put(f"{name}_{'xyz'[k]}", other, at, -unit)

    def clamp(self, name: str, at, body: str) -> None:
        self.pin(name, at, body)
        self.put(f"{name}_couple", body, at, couple=(0, 0, 1))

    def bar(self, name: str, one: End, other: End) -> None:
        """A two-force bar or a wire between two places of bodies (None: of the ground), tension positive."""
        e = three(other[1]) - three(one[1])
        for (body, at), sense in ((one, 1), (other, -1)):
            if body is not None:
                self.put(name, body, at, sense * e / np.linalg.norm(e))

    def truss(self, nodes: dict[int, Sequence[float]], members: str) -> None:
        """The members "1-2" between joints called by their numbers."""
        for member in members.split():
            i, j = (int(k) for k in member.split("-"))
            self.bar(member, (str(i), nodes[i]), (str(j), nodes[j]))

    def equations(self) -> tuple[list[str], Vector, Vector]:
        """The unknowns, and G rho = -loads of all bodies."""
        names = sorted({unknown for of in self.units.values() for unknown in of})
        rows, right = [], []
        for body, of in self.units.items():
            for k in self.axes if body in self.joints else self.kept:
                rows.append([of[u][k] if u in of else 0.0 for u in names])
                right.append(-self.loads.get(body, np.zeros(6))[k])
        return names, np.array(rows), np.array(right)

    def solved(self) -> Numbers:
        """Every unknown of a determinate structure."""
        names, G, right = self.equations()
        return dict(zip(names, (float(x) for x in the_solution(G, right)), strict=True))


def six(at, force, couple) -> Vector:
    """Force and moment about the origin."""
    force = three(force)
    return np.concatenate([force, np.cross(three(at), force) + np.array(couple, dtype=float)])
