"""Machines of rigid bodies in space, each body free, joints and constraints as rows between them: an oracle in
floating point.

    M a = F + C^T lam,   C a = -C' v       for a = (dv, dw) of every mass centre, ground axes

lam of least norm, so that rows which follow from others, at a state or everywhere, do no harm. C' v by central
differences along the motion v. Nothing of eomgen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Vector = Sequence[float]
Frames = dict[str, tuple[np.ndarray, np.ndarray]]
GROUND = "ground"
STEP = 1e-5


@dataclass(frozen=True)
class Part:
    """A body on the one before it in the tree.

    Args:
        on, at: the body that carries the joint, and the joint's place in its axes.
        kind: "revolute" or "prismatic", of one coordinate; "spherical" turns by x, y', z''; "free" moves and turns so.
        axis: of the joint, axes of the carrier.
        point: the joint's place in the body's own axes.
        m, inertia, com: principal moments about the mass centre, which lies at com, body axes.
        more: further fields of the joint in a model file, which `efforts` of the machine must follow.
    """

    on: str
    at: Vector
    kind: str
    axis: Vector
    m: float
    inertia: Vector
    point: Vector = (0, 0, 0)
    com: Vector = (0, 0, 0)
    more: str = ""

    @property
    def degrees_of_freedom(self) -> int:
        return {"revolute": 1, "prismatic": 1, "spherical": 3, "free": 6}[self.kind]


@dataclass(frozen=True)
class Closure:
    """Two places, (body, place in its axes), are one; with an axis of the first body it is a hinge."""

    first: tuple[str, Vector]
    second: tuple[str, Vector]
    axis: Vector | None = None


@dataclass(frozen=True)
class Machine:
    """Bodies in a tree, and what closes it.

    Args:
        parts: by name, carriers first; their coordinates in that order.
        closures: of the loops.
        gravity: acceleration, ground axes.
        efforts: (q, u) -> the force or moment along each coordinate of a joint of one.
    """

    parts: dict[str, Part]
    closures: Sequence[Closure]
    gravity: Vector = (0, 0, -9.81)
    efforts: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None

    def frames(self, q: np.ndarray) -> Frames:
        """(R, origin) of every body."""
        found: Frames = {GROUND: (np.eye(3), np.zeros(3))}
        for (name, part), own in zip(self.parts.items(), self._own(q), strict=True):
            R, p = found[part.on]
            place, turned = p + R @ np.array(part.at, float), R
            if part.kind == "revolute":
                turned = R @ turn(part.axis, own[0])
            elif part.kind == "prismatic":
                place = place + R @ unit(part.axis) * own[0]
            elif part.kind == "spherical":
                turned = R @ turned_by(own)
            else:
                place, turned = place + R @ np.array(own[:3]), R @ turned_by(own[3:])
            found[name] = turned, place - turned @ np.array(part.point, float)
        return found

    def velocities(self, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        """(v, w) of every mass centre, one after the other, for the rates u of q."""
        before, after = (self.frames(q + sign * STEP * u) for sign in (-1, 1))
        found = []
        for name, part in self.parts.items():
            c = [p + R @ np.array(part.com, float) for R, p in (before[name], after[name])]
            W = (after[name][0] - before[name][0]) / (2 * STEP) @ self.frames(q)[name][0].T
            found += [*(c[1] - c[0]) / (2 * STEP), W[2, 1], W[0, 2], W[1, 0]]
        return np.array(found)

    def rows(self, frames: Frames) -> np.ndarray:
        """C, joints first."""
        found: list[np.ndarray] = []
        for name, part in self.parts.items():
            found += self._joint(frames, name, part)
        for closure in self.closures:
            found += self._together(frames, closure.first, closure.second)
            if closure.axis is not None:
                found += self._turning(frames, closure.first[0], closure.second[0], across(closure.axis))
        return np.array(found)

    def accelerations(self, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        """(dv, dw) of every mass centre at a state in which the loops are closed."""
        v, C = self.velocities(q, u), self.rows(self.frames(q))
        late, early = (self.rows(self.frames(q + sign * STEP * u)) for sign in (1, -1))
        gamma = (late - early) @ v / (2 * STEP)
        mass, force = self._newton(q, u, v)
        K = np.block([[mass, C.T], [C, np.zeros((len(C), len(C)))]])
        return np.linalg.lstsq(K, np.concatenate([force, -gamma]), rcond=1e-10)[0][: len(v)]

    def rates_of_rates(self, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        """q'' of all coordinates: the velocities' derivative is that of the free bodies."""
        a, n = self.accelerations(q, u), len(q)
        B = np.array([self.velocities(q, e) for e in np.eye(n)]).T
        h = 1e-4
        bias = (self.velocities(q + h * u, u) - self.velocities(q - h * u, u)) / (2 * h)
        return np.linalg.lstsq(B, a - bias, rcond=1e-10)[0]

    def _own(self, q: np.ndarray) -> list[np.ndarray]:
        found, first = [], 0
        for part in self.parts.values():
            found.append(q[first : first + part.degrees_of_freedom])
            first += part.degrees_of_freedom
        return found

    def _velocity_of(self, frames: Frames, body: str, place: np.ndarray) -> np.ndarray:
        """3 x 6 n: of a place, ground axes from the ground's origin, of a body."""
        row = np.zeros((3, 6 * len(self.parts)))
        if body != GROUND:
            i, (R, p) = list(self.parts).index(body), frames[body]
            row[:, 6 * i : 6 * i + 3] = np.eye(3)
            row[:, 6 * i + 3 : 6 * i + 6] = -tilde(place - p - R @ np.array(self.parts[body].com, float))
        return row

    def _spin_of(self, body: str) -> np.ndarray:
        row = np.zeros((3, 6 * len(self.parts)))
        if body != GROUND:
            i = list(self.parts).index(body)
            row[:, 6 * i + 3 : 6 * i + 6] = np.eye(3)
        return row

    def _together(self, frames: Frames, first: tuple[str, Vector], second: tuple[str, Vector]) -> list[np.ndarray]:
        places = [frames[b][1] + frames[b][0] @ np.array(r, float) for b, r in (first, second)]
        return list(self._velocity_of(frames, first[0], places[0]) - self._velocity_of(frames, second[0], places[1]))

    def _turning(self, frames: Frames, first: str, second: str, held: Sequence[np.ndarray]) -> list[np.ndarray]:
        """No spin of the second against the first along directions of the first."""
        return [(frames[first][0] @ d) @ (self._spin_of(second) - self._spin_of(first)) for d in held]

    def _joint(self, frames: Frames, name: str, part: Part) -> list[np.ndarray]:
        R, p = frames[part.on]
        seat = p + R @ np.array(part.at, float)
        own = frames[name][1] + frames[name][0] @ np.array(part.point, float)
        if part.kind == "free":
            return []
        if part.kind == "prismatic":
            moved = self._velocity_of(frames, name, own) - self._velocity_of(frames, part.on, own)
            held = self._turning(frames, part.on, name, list(np.eye(3)))
            return [*held, *((R @ d) @ moved for d in across(part.axis))]
        found = self._together(frames, (part.on, part.at), (name, part.point))
        assert np.allclose(seat, own)
        return found if part.kind == "spherical" else [*found, *self._turning(frames, part.on, name, across(part.axis))]

    def _newton(self, q: np.ndarray, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        n, frames = len(self.parts), self.frames(q)
        mass, force = np.zeros((6 * n, 6 * n)), np.zeros(6 * n)
        for k, (name, part) in enumerate(self.parts.items()):
            R = frames[name][0]
            I = R @ np.diag(part.inertia) @ R.T
            own, w = slice(6 * k, 6 * k + 6), v[6 * k + 3 : 6 * k + 6]
            mass[own, own] = np.block([[part.m * np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), I]])
            force[own] = [*(part.m * np.array(self.gravity)), *(-np.cross(w, I @ w))]
        if self.efforts is not None:
            force += self._along_joints(q, self.efforts(q, u))
        return mass, force

    def _along_joints(self, q: np.ndarray, efforts: np.ndarray) -> np.ndarray:
        """The forces and moments of efforts along coordinates of joints of one."""
        frames, total, first = self.frames(q), np.zeros(6 * len(self.parts)), 0
        for name, part in self.parts.items():
            if part.degrees_of_freedom == 1:
                n = frames[part.on][0] @ unit(part.axis)
                own = frames[name][1] + frames[name][0] @ np.array(part.point, float)
                if part.kind == "revolute":
                    row = n @ (self._spin_of(name) - self._spin_of(part.on))
                else:
                    row = n @ (self._velocity_of(frames, name, own) - self._velocity_of(frames, part.on, own))
                total += efforts[first] * row
            first += part.degrees_of_freedom
        return total


def unit(v: Vector) -> np.ndarray:
    return np.array(v, float) / np.linalg.norm(v)


def tilde(a: np.ndarray) -> np.ndarray:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def turn(axis: Vector, angle: float) -> np.ndarray:
    """Rodrigues' formula."""
    K = tilde(unit(axis))
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def turned_by(angles: np.ndarray) -> np.ndarray:
    """About x, then the new y, then the new z."""
    x, y, z = np.eye(3)
    return turn(x, angles[0]) @ turn(y, angles[1]) @ turn(z, angles[2])


def across(n: Vector) -> list[np.ndarray]:
    """Two directions that with n span space."""
    a = unit(n)
    e = np.eye(3)[int(np.argmin(abs(a)))]
    b = unit(np.cross(a, e))
    return [b, np.cross(a, b)]


def closed(machine: Machine, q: np.ndarray, kept: Sequence[int]) -> np.ndarray:
    """q at which the loops close, the kept coordinates as they are: Newton's method on what the closures leave open."""
    q = np.array(q, float)
    moved = [k for k in range(len(q)) if k not in kept]
    for _ in range(50):
        gap = _open(machine, q)
        if np.max(abs(gap)) < 1e-13:
            return q
        slopes = [(_open(machine, q + h) - _open(machine, q - h)) / 2e-6 for h in 1e-6 * np.eye(len(q))[moved]]
        step = np.zeros(len(q))
        step[moved] = np.linalg.lstsq(np.array(slopes).T, gap, rcond=1e-8)[0]
        lengths = 0.5 ** np.arange(20)  # the longest of them that brings the ends nearer: a whole step may lose the way
        nearer = (x for x in lengths if np.linalg.norm(_open(machine, q - x * step)) < np.linalg.norm(gap))
        q -= next(nearer, 1.0) * step
    raise AssertionError("the loops do not close")


def rates_that_stay(machine: Machine, q: np.ndarray, wanted: np.ndarray, kept: Sequence[int]) -> np.ndarray:
    """u with which the loops stay closed, the kept rates as they are wanted."""
    slopes = np.array([(_open(machine, q + h) - _open(machine, q - h)) / 2e-5 for h in 1e-5 * np.eye(len(q))]).T
    moved, u = [k for k in range(len(q)) if k not in kept], np.array(wanted, float)
    u[moved] = 0.0
    u[moved] = np.linalg.lstsq(slopes[:, moved], -slopes @ u, rcond=1e-8)[0]
    return u


def _open(machine: Machine, q: np.ndarray) -> np.ndarray:
    frames, found = machine.frames(q), []
    for closure in machine.closures:
        (A, r), (B, s) = closure.first, closure.second
        found += [
            *(frames[A][1] + frames[A][0] @ np.array(r, float) - frames[B][1] - frames[B][0] @ np.array(s, float))
        ]
        if closure.axis is not None:
            found += [(frames[A][0] @ d) @ (frames[B][0] @ unit(closure.axis)) for d in across(closure.axis)]
    return np.array(found)


def text_of(machine: Machine, names: Sequence[str], start: np.ndarray, dependent: Sequence[str] = ()) -> str:
    """The machine as a model file, a hinge's axis being the third of both bodies at rest.

    Args:
        names: of the coordinates, in order.
        start: of the coordinates: of the dependent ones a guess.
        dependent: the names of those.
    """
    lines = ["eomgen = 1", 'name = "machine"', 'space = "space"', "[coordinates]"]
    for name, value in zip(names, start.tolist(), strict=True):
        lines.append(
            f"{name} = {{ dependent = true, near = {value!r} }}" if name in dependent else f"{name} = {value!r}"
        )
    first = 0
    for body, part in machine.parts.items():
        own, first = list(names[first : first + part.degrees_of_freedom]), first + part.degrees_of_freedom
        on = "" if part.on == GROUND else f'on = "{part.on}", '
        angles = ", ".join(f'"{name}"' for name in own[-3:])
        fields = {
            "revolute": f'axis = {_list(part.axis)}, angle = "{own[0]}"',
            "prismatic": f'axis = {_list(part.axis)}, displacement = "{own[0]}"',
            "spherical": f'orientation = "xyz", angles = [{angles}]',
            "free": f"position = [{', '.join(f'{chr(34)}{name}{chr(34)}' for name in own[:3])}], "
            f'orientation = "xyz", angles = [{angles}]',
        }[part.kind]
        seat = "" if part.kind == "free" else f'{on}at = {_list(part.at)}, point = "seat", '
        lines += [
            f"[bodies.{body}]",
            f"mass = {part.m}",
            f"inertia = {_list(part.inertia)}",
            f"center = {_list(part.com)}",
        ]
        points = {"seat": part.point} | {
            f"c{k}": r for k, c in enumerate(machine.closures) for b, r in (c.first, c.second) if b == body
        }
        lines.append("points = { " + ", ".join(f"{name} = {_list(r)}" for name, r in points.items()) + " }")
        lines.append(f'joint = {{ kind = "{part.kind}", {seat}{fields}{part.more} }}')
    for k, closure in enumerate(machine.closures):
        lines += [
            f"[constraints.C{k}]",
            'kind = "pin"',
            f'points = ["{closure.first[0]}.c{k}", "{closure.second[0]}.c{k}"]',
        ]
        if closure.axis is not None:
            frames = machine.frames(start)
            lines.append(f"axis = {_list(frames[closure.first[0]][0] @ unit(closure.axis))}")
    return "\n".join([*lines, "[forces.weight]", 'kind = "gravity"', f"acceleration = {_list(machine.gravity)}", ""])


def _list(v: Vector) -> str:
    return f"[{', '.join(repr(float(x)) for x in v)}]"
