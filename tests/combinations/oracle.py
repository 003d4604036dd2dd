"""The oracle: accelerations, reactions, energies of a model by maximal coordinates, in numpy.

Every body has six accelerations of its own, every coordinate one; each joint is six equations between two bodies and
the coordinates, each constraint its rows, each drive one:

    M z'' = F + J^T lam,        J z'' + gamma = 0,        z = (mass centres, turns, coordinates)

solved by least squares, so that rows that follow from others do no harm. The velocities' parts come from Taylor
coefficients along the motion, never from derivatives of formulas. Imports nothing of eomgen.
"""

from __future__ import annotations

import itertools
import re
from dataclasses import dataclass, field, replace

import laws
import numpy as np
import taylor as ty
from declared import Declared, Moving
from taylor import Jet, jet

SMALL = 1e-9


class NoAnswer(Exception):
    """The oracle does not know: what it says is why."""


@dataclass
class State:
    """A state: time, coordinates and their rates, driven ones too, and states of first order."""

    t: float
    q: np.ndarray
    v: np.ndarray
    z: np.ndarray = field(default_factory=lambda: np.zeros(0))


@dataclass
class Row:
    """One row of a joint, constraint or drive along all curves.

    Args:
        owner: the body of a joint, the name of a constraint, or "drive q".
        jet: the gap, or (`rate`) what must vanish of velocities.
        role: n, t, s, x, ... what its multiplier is called.
    """

    owner: str
    jet: Jet
    rate: bool = False
    role: str = ""

    def parts(self) -> tuple[np.ndarray, float, float]:
        """(J, gamma, what is left open of the velocity)."""
        c = self.jet.c
        if c.shape[-1] == 1:
            raise NoAnswer("a row that nothing moves")
        if self.rate:
            return c[0][2:] - c[0][1], float(c[1][0]), float(c[0][0])
        return c[1][2:], float(2 * c[2][0]), float(c[1][0])


@dataclass
class Solved:
    """What the oracle says at a state."""

    a: np.ndarray  # q'' of all coordinates
    sure: np.ndarray  # which of them have one value
    rows: list[Row]
    lam: np.ndarray
    J: np.ndarray
    M: np.ndarray
    F: np.ndarray
    z: np.ndarray
    now: Moving
    closed: dict[str, bool] = field(default_factory=dict)
    pressed: dict[str, float] = field(default_factory=dict)  # |N| of what rubs

    @property
    def sticks(self) -> bool:
        """Whether friction holds some contact at rest."""
        return any(row.role.startswith("stick") for row in self.rows)


class Oracle:
    """The oracle of one model file."""

    def __init__(self, text: str, start: np.ndarray | None = None) -> None:
        """start: q at t = 0, which says where constraints that hold things as they stand hold them."""
        self.model = Declared(text)
        self.names = list(self.model.coordinates)
        self.bodies = self.model.order
        self.start: Moving | None = None
        self.lengths: dict[str, float] = {}
        if start is not None:
            self.begin(start)

    def begin(self, q: np.ndarray) -> None:
        self.start = self._frozen(0.0, q)
        self.modes = {name: True for name, constraint in self.model.constraints.items() if constraint.get("unilateral")}

    def _frozen(self, t: float, q: np.ndarray) -> Moving:
        one = np.zeros((3, 1))
        one[0] = t
        values = {name: Jet(np.array([[x], [0.0], [0.0]])) for name, x in zip(self.names, q, strict=True)}
        return self.placed(Moving(self.model, Jet(one), values))

    def placed(self, now: Moving) -> Moving:
        """The poses of all bodies as their joints say, from the coordinates."""
        for name in self.bodies:
            now.poses[name] = laws.pose(now, self.model.bodies[name])
        return now

    # curves

    def _time(self, t: float, n: int) -> Jet:
        """The curve of the time, at which masses that change are weighed."""
        self.model.weigh(t)
        c = np.zeros((3, n))
        c[0] = t
        c[1, 0] = 1.0
        return Jet(c)

    def reduced(self, s: State, a: np.ndarray | None = None) -> Moving:
        """Curves in the coordinates: the motion, the state that stands, a unit of each coordinate."""
        n = 2 + len(self.names)
        q = {}
        for k, name in enumerate(self.names):
            c = np.zeros((3, n))
            c[0] = s.q[k]
            c[1, 0] = s.v[k]
            c[2, 0] = 0.0 if a is None else a[k] / 2
            c[1, 2 + k] = 1.0
            q[name] = Jet(c)
        return self.placed(Moving(self.model, self._time(s.t, n), q, states=self._states(s)))

    def _states(self, s: State) -> dict[str, float]:
        return dict(zip(self.model.states, s.z, strict=False))

    def maximal(self, s: State) -> Moving:
        """Curves in z: the motion without accelerations, the state that stands, a unit of each entry of z."""
        at = self.reduced(s)
        nb, nq = len(self.bodies), len(self.names)
        n = 2 + 6 * nb + nq
        q = {}
        for k, name in enumerate(self.names):
            c = np.zeros((3, n))
            c[0] = s.q[k]
            c[1, 0] = s.v[k]
            c[1, 2 + 6 * nb + k] = 1.0
            q[name] = Jet(c)
        now = Moving(self.model, self._time(s.t, n), q, states=self._states(s))
        for i, name in enumerate(self.bodies):
            p, R = at.poses[name]
            center = p + ty.matmul(R, ty.vector(self.model.mass[name][1]))
            R0 = R.c[0][..., 0]
            w = ty.vee(ty.matmul(ty.transpose(R), R.rate())).c[0][:, 0]
            c = np.zeros((3, 3, n))
            c[0] = center.c[0][:, :1]
            c[1][:, 0] = center.c[1][:, 0]
            turning = np.zeros((3, 3, 3, n))
            turning[0] = R0[:, :, None]
            turning[1][:, :, 0] = R0 @ tilde(w)
            turning[2][:, :, 0] = R0 @ tilde(w) @ tilde(w) / 2
            for k in range(3):
                c[1][k, 2 + 6 * i + k] = 1.0
                turning[1][:, :, 2 + 6 * i + 3 + k] = R0 @ tilde(np.eye(3)[k])
            frame = Jet(turning)
            now.poses[name] = (Jet(c) - ty.matmul(frame, ty.vector(self.model.mass[name][1])), frame)
        return now

    # rows

    def constraint_rows(self, now: Moving, closed: dict[str, bool] | None = None) -> list[Row]:
        found = []
        for name, constraint in self.model.constraints.items():
            if closed is not None and not closed.get(name, True):
                continue
            found += [Row(name, *row) for row in laws.constraint_rows(name, constraint, now, self)]
        for body in self.model.bodies.values():
            four = body.get("joint", {}).get("quaternion")
            if four:
                norm = sum((now.q[e] * now.q[e] for e in four), jet(-1.0))
                found.append(Row(f"norm of {body['name']}", norm * 0.5))
        return found

    def joint_rows(self, now: Moving) -> list[Row]:
        """Six rows of each body: it stands against its parent as the joint says."""
        found = []
        for name in self.bodies:
            p, R = now.poses[name]
            p_said, R_said = laws.pose(now, self.model.bodies[name])
            turn = ty.vee(ty.matmul(ty.transpose(R_said), R))
            gap = p - p_said
            found += [Row(name, ty.component(gap, k), role="xyz"[k]) for k in range(3)]
            found += [Row(name, ty.component(turn, k), role="abc"[k]) for k in range(3)]
        return found

    # states

    def drives(self, t: float) -> dict[str, np.ndarray]:
        return {q: self.model.driven_at(q, t) for q in self.model.driven}

    def closed_at_start(self) -> dict[str, bool]:
        return dict(self.modes)

    def consistent(self, t: float, q: np.ndarray, v: np.ndarray, closed: dict[str, bool] | None = None) -> State:
        """The state near (q, v) at which every gap is closed and every row of velocities holds."""
        q = np.array(q, dtype=float)
        drives = self.drives(t)
        free = np.array([name not in drives for name in self.names])
        for k, name in enumerate(self.names):
            if name in drives:
                q[k] = drives[name][0]
        for _ in range(50):
            s = State(t, q, np.zeros(len(q)))
            rows = [r for r in self.constraint_rows(self.reduced(s), closed) if not r.rate]
            if not rows or not free.any():
                break
            gap = np.array([float(r.jet.c[0][0]) for r in rows])
            if np.max(np.abs(gap)) < 1e-13:
                break
            J = np.array([r.jet.c[1][2:] if r.jet.c.shape[-1] > 1 else np.zeros(len(q)) for r in rows])[:, free]
            step = np.linalg.lstsq(J, -gap, rcond=1e-9)[0]
            size = np.linalg.norm(step)
            q[free] += step * min(1.0, 0.5 / size) if size > 0 else 0
            if size < 1e-15:
                break
        s = State(t, q, np.zeros(len(q)))
        rows = self.constraint_rows(self.reduced(s), closed)
        open_by = max((abs(float(r.jet.c[0][0])) for r in rows if not r.rate), default=0.0)
        if open_by > 1e-9:
            raise NoAnswer(f"constraints stay open by {open_by:.1e}")
        v = np.array(v, dtype=float)
        for k, name in enumerate(self.names):
            if name in drives:
                v[k] = drives[name][1]
        return self.with_rates(State(t, q, v), closed)

    def consistent_or_not(self, q: np.ndarray) -> State:
        """The place q at rest, whatever it leaves open."""
        return State(0.0, np.array(q, dtype=float), np.zeros(len(q)))

    def with_rates(self, s: State, closed: dict[str, bool] | None = None) -> State:
        """The nearest rates of what is free that the rows of velocities allow."""
        drives = self.drives(s.t)
        free = np.array([name not in drives for name in self.names])
        J, sigma = self._velocity_rows(State(s.t, s.q, s.v * 0), closed)
        v = s.v.copy()
        for k, name in enumerate(self.names):
            if name in drives:
                v[k] = drives[name][1]
        if len(J):
            left = -(sigma + J @ v)
            v[free] += np.linalg.lstsq(J[:, free], left, rcond=1e-9)[0]
            if np.max(np.abs(sigma + J @ v)) > 1e-8 * (1 + np.max(np.abs(v))):
                raise NoAnswer("no rates keep the constraints")
        return State(s.t, s.q, v)

    def _velocity_rows(self, s: State, closed: dict[str, bool] | None) -> tuple[np.ndarray, np.ndarray]:
        """(J, sigma) with J v + sigma = 0, in the coordinates."""
        rows = self.constraint_rows(self.reduced(s), closed)
        J, sigma = [], []
        for r in rows:
            c = r.jet.c
            if c.shape[-1] == 1:
                continue
            J.append(c[0][2:] - c[0][1] if r.rate else c[1][2:])
            sigma.append(c[0][0] if r.rate else c[1][0])
        return np.array(J), np.array(sigma)

    def of_all_rates(self, t: float, q: np.ndarray, speeds: tuple[str, ...], u: np.ndarray) -> State:
        """As `of_speeds`, whichever contacts are closed."""
        return self.of_speeds(t, q, speeds, u, loose=1e-5, closed=dict.fromkeys(self.modes, False))

    def of_speeds(
        self,
        t: float,
        q: np.ndarray,
        speeds: tuple[str, ...],
        u: np.ndarray,
        *,
        loose: float = 1e-7,
        closed: dict[str, bool] | None = None,
    ) -> State:
        """The state of given speeds: rates, declared speeds, and the constraints' rows, solved together.

        Behind the speeds u has the states of first order.
        """
        u, z = u[: len(speeds)], np.array(u[len(speeds) :], dtype=float)
        drives = self.drives(t)
        zero = State(t, np.array(q, dtype=float), np.zeros(len(q)))
        closed = self.closed_at_start() if closed is None else closed
        J, sigma = self._velocity_rows(zero, closed)
        A, b = [*J], [*(-sigma)] if len(J) else []
        at = self.reduced(zero)
        for name, x in zip(speeds, u, strict=True):
            if name.endswith("'"):
                A.append(np.eye(len(q))[self.names.index(name[:-1])])
                b.append(x)
            else:
                c = jet(at.speed(name)).c
                A.append(c[0][2:] - c[0][1])
                b.append(x - c[0][0])
        for name, (_, rate, _) in drives.items():
            A.append(np.eye(len(q))[self.names.index(name)])
            b.append(rate)
        A, b = np.array(A), np.array(b)
        v = np.linalg.lstsq(A, b, rcond=1e-10)[0]
        if np.max(np.abs(A @ v - b)) > loose * (1 + np.max(np.abs(b))):
            raise NoAnswer("these speeds break the constraints")
        return State(t, np.array(q, dtype=float), v, z)

    def state_rates(self, s: State, a: np.ndarray) -> np.ndarray:
        """z' of the states at a state with accelerations."""
        now = self.reduced(s, a)
        laws_of = ((laws.STATES[z.get("law", "rate")], self._with_reactions(z, s)) for z in self.model.states.values())
        return np.array([law(now, z) for law, z in laws_of])

    def _with_reactions(self, declared: dict, s: State) -> dict:
        """A state in whose rate the reactions are numbers, those of the state's own accelerations."""
        calls = re.findall(r"reaction_\w+\(\w+\)", str(declared.get("rate", "")))
        if not calls:
            return declared
        found, rate = self.reactions(self.solve(s), s), declared["rate"]
        for call in calls:
            if call not in found:
                raise NoAnswer(f"{call} has no single value")
            rate = rate.replace(call, f"({found[call]!r})")
        return declared | {"rate": rate}

    def speeds_of(
        self, s: State, speeds: tuple[str, ...], a: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """(u, u') of speeds at a state with accelerations."""
        now = self.reduced(s, a)
        found = [jet(now.q[n[:-1]].rate() if n.endswith("'") else now.speed(n)).c for n in speeds]
        return np.array([c[0][0] for c in found]), np.array([c[1][0] for c in found])

    # equations

    def solve(self, s: State, closed: dict[str, bool] | None = None) -> Solved:
        """Accelerations and multipliers at a state; contacts as `closed` says, by default as they are at the start.

        Friction is an applied force mu |N|: N is found for none and for 1 N of each, and so, N being affine in it, for
        itself, by trying the signs.
        """
        closed = self.closed_at_start() if closed is None else closed
        now = self.maximal(s)
        drives = self.drives(s.t)
        rows = self.joint_rows(now) + self.constraint_rows(now, closed)
        rows += [Row(name, slip, True, f"stick {role}") for name, slip, role in laws.sticking(self, now, rows)]
        first = 6 * len(self.bodies)
        rows += [Row(f"drive {name}", now.q[name], role="drive") for name in drives]
        parts = [row.parts() for row in rows]
        J = np.array([p[0] for p in parts])
        gamma = np.array([p[1] for p in parts])
        for i, row in enumerate(rows):
            if row.owner.startswith("drive "):
                gamma[i] = -drives[row.owner[6:]][2]
        M, F = self._masses(now, s)
        rubbing = [*laws.frictions(self, now, rows), *laws.at_ends(self, now, s)]

        def found(extra: np.ndarray) -> Solved:
            lam, z, sure = self._kkt(M, F + extra, J, J.T, gamma)
            return Solved(z[first:], sure[first:], rows, lam, J, M, F + extra, z, now, closed)

        bare = found(np.zeros(len(F)))
        if not rubbing:
            return self._held(bare)
        N0 = self._pressed(bare, rubbing, s)
        A = np.array([self._pressed(found(column), rubbing, s) - N0 for _, column in rubbing]).T
        kept = []
        for signs in itertools.product([1.0, -1.0], repeat=len(rubbing)):
            D = np.eye(len(rubbing)) - A * np.array(signs)
            if abs(np.linalg.det(D)) < 1e-9:
                continue
            N = np.linalg.solve(D, N0)
            if np.all(N * signs >= -1e-12):
                kept.append(np.abs(N))
        if not kept or any(not np.allclose(kept[0], x) for x in kept):
            raise NoAnswer(f"friction has {len(kept)} answers")
        solved = found(sum(P * column for P, (_, column) in zip(kept[0], rubbing, strict=True)))
        for P, (i, _) in zip(kept[0], rubbing, strict=True):
            owner = rows[i].owner if isinstance(i, int) else f"guide {i[0]}"
            solved.pressed[owner] = solved.pressed.get(owner, 0.0) + P
        return self._held(solved)

    def _held(self, solved: Solved) -> Solved:
        if not laws.holds(self, solved):
            raise NoAnswer("a contact that would stick is held by too little")
        return solved

    def _pressed(self, solved: Solved, rubbing: list, s: State) -> np.ndarray:
        """The normal forces of the rows, and of the ends of guides, that rub."""
        push, lam, null = laws.holding(self, solved)
        found = []
        for i, _ in rubbing:
            if not isinstance(i, int):
                found.append(laws.end_of_guide(self, solved, s, *i, push, lam))
                continue
            k = push.index(i)
            if null.size and np.max(np.abs(null[:, k])) > 1e-7:
                raise NoAnswer("a normal force that has no single value rubs")
            found.append(lam[k])
        return np.array(found)

    def _kkt(self, M: np.ndarray, F: np.ndarray, J: np.ndarray, push: np.ndarray, gamma: np.ndarray) -> tuple:
        n, k = len(F), len(gamma)
        A = np.block([[M, -push], [J, np.zeros((k, k))]])
        b = np.concatenate([F, -gamma])
        x, null = least_squares(A, b)
        sure = np.all(np.abs(null) < 1e-6, axis=0) if len(null) else np.ones(n + k, bool)
        left = A @ x - b
        if np.max(np.abs(left)) > 1e-7 * (1 + np.max(np.abs(b)) + np.max(np.abs(x))):
            raise NoAnswer(f"the rows contradict one another by {np.max(np.abs(left)):.1e}")
        return x[n:], x[:n], sure[:n]

    def _masses(self, now: Moving, s: State) -> tuple[np.ndarray, np.ndarray]:
        n = 6 * len(self.bodies) + len(self.names)
        M, F = np.zeros((n, n)), np.zeros(n)
        for i, name in enumerate(self.bodies):
            m, _, inertia = self.model.mass[name]
            R = now.poses[name][1]
            w = ty.vee(ty.matmul(ty.transpose(R), R.rate())).c[0][:, 0]
            here = slice(6 * i, 6 * i + 3)
            turn = slice(6 * i + 3, 6 * i + 6)
            M[here, here] = m * np.eye(3)
            M[turn, turn] = inertia
            F[turn] -= np.cross(w, inertia @ w)
        for load in laws.loads(self, now, s):
            F += load.on(self, now)
        for own, bias in laws.inertias(self, now, s):
            M += own
            F -= bias
        return M, F

    # what is asked

    def energy(self, s: State) -> tuple[float, float | None]:
        """(T, V); V is None where a force has no potential that the oracle knows."""
        now = self.maximal(s)
        T = 0.0
        for name in self.bodies:
            m, com, inertia = self.model.mass[name]
            p, R = now.poses[name]
            v = (p + ty.matmul(R, ty.vector(com))).c[1][:, 0]
            w = ty.vee(ty.matmul(ty.transpose(R), R.rate())).c[0][:, 0]
            T += m * v @ v / 2 + w @ inertia @ w / 2
        T += laws.own_kinetic(self, now)
        return T, laws.potential(self, now)

    def power(self, s: State) -> dict[str, float]:
        """Power of each force [W], what the joints carry among them."""
        now = self.maximal(s)
        velocity = self._z_rate(now)
        found: dict[str, float] = {}
        for load in laws.loads(self, now, s):
            found[load.name] = found.get(load.name, 0.0) + float(load.on(self, now) @ velocity)
        return found

    def _z_rate(self, now: Moving) -> np.ndarray:
        found = []
        for name in self.bodies:
            p, R = now.poses[name]
            found += [*(p + ty.matmul(R, ty.vector(self.model.mass[name][1]))).c[1][:, 0]]
            found += [*ty.vee(ty.matmul(ty.transpose(R), R.rate())).c[0][:, 0]]
        return np.array(found + [now.q[q].c[1][0] for q in self.names])

    def other_accelerations(self, s: State, solved: Solved) -> tuple[np.ndarray, list[str]]:
        """(accelerations beside those of the motion that keep the constraints and drives, the coordinates free by
        these)."""
        free = [k for k, name in enumerate(self.names) if name not in self.model.driven]
        J, _ = self._velocity_rows(s, self.closed_at_start())
        J = J[:, free] if len(J) else np.zeros((0, len(free)))
        along = np.array([0.3 + 0.1 * k for k in free])
        a = solved.a.copy()
        a[free] += along - np.linalg.pinv(J, rcond=1e-9) @ (J @ along)
        dependent = _pivots(J) if len(J) else []
        return a, [self.names[k] for i, k in enumerate(free) if i not in dependent]

    def wanted(self, s: State, a: np.ndarray, actuated: list[str]) -> dict[str, float]:
        """The forces along actuated coordinates that the accelerations a take, where they have one value."""
        now = self.maximal(s)
        M, F = self._masses(now, s)
        B, z = self._columns(s, a)
        need = B.T @ (M @ z - F)
        J, _ = self._velocity_rows(s, self.closed_at_start())
        free = [k for k, name in enumerate(self.names) if name not in self.model.driven]
        E = np.eye(len(self.names))[:, [self.names.index(q) for q in actuated]]
        A = np.hstack([E, J.T])[free] if len(J) else E[free]
        x, null = least_squares(A, need[free])
        if np.max(np.abs(A @ x - need[free]), initial=0.0) > 1e-7 * (1 + np.max(np.abs(need))):
            raise NoAnswer("these accelerations take forces along what is not actuated")
        return {q: float(x[k]) for k, q in enumerate(actuated) if not len(null) or np.max(np.abs(null[:, k])) < 1e-7}

    def _columns(self, s: State, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(B, z'') of z' = B q' + ...: from the joints as functions of the coordinates."""
        now = self.reduced(s, a)
        B, acc = [], []
        for name in self.bodies:
            p, R = now.poses[name]
            center = p + ty.matmul(R, ty.vector(self.model.mass[name][1]))
            w = ty.vee(ty.matmul(ty.transpose(R), R.rate()))
            center, w = (Jet(np.broadcast_to(x.c, (3, 3, 2 + len(self.names)))) for x in (center, w))
            B += [*center.c[1][:, 2:], *w.c[0][:, 2:]]
            acc += [*(2 * center.c[2][:, 0]), *w.c[1][:, 0]]
        return np.array([*B, *np.eye(len(self.names))]), np.array([*acc, *a])

    def stands(self) -> bool:
        """Whether all that is driven stays where it is."""
        return all(np.max(np.abs(x[1:])) < 1e-12 for t in (0.0, 0.31, 1.7) for x in self.drives(t).values())

    def small(self, q: np.ndarray, z: np.ndarray, h: float = 1e-5) -> np.ndarray:
        """A of x' = A x about rest at q and z, x = independent coordinates, their rates, states, by differences.

        The constraints are positions alone; the rest follows from the independent ones, which the rows of J choose.
        """
        J = self._velocity_rows(State(0.0, q, np.zeros(len(q))), None)[0]
        free = [k for k, name in enumerate(self.names) if name not in self.model.driven]
        dependent = [free[k] for k in _pivots(J[:, free])] if len(J) else []
        own = [k for k, name in enumerate(self.names) if k not in dependent and name not in self.model.driven]

        def slope(x: np.ndarray) -> np.ndarray:
            places, rates = np.array(q, dtype=float), np.zeros(len(q))
            places[own], rates[own] = q[own] + x[: len(own)], x[len(own) : 2 * len(own)]
            s = replace(self._closed_by(places, rates, dependent), z=z + x[2 * len(own) :])
            a = self.solve(s).a
            return np.concatenate([s.v[own], a[own], self.state_rates(s, a)])

        n = 2 * len(own) + len(z)
        return np.array([(slope(h * e) - slope(-h * e)) / (2 * h) for e in np.eye(n)]).T

    def _closed_by(self, q: np.ndarray, v: np.ndarray, dependent: list[int]) -> State:
        """The state in which the dependent coordinates and rates close the constraints."""
        if dependent:
            for _ in range(20):
                rows = self.constraint_rows(self.reduced(State(0.0, q, np.zeros(len(q)))))
                gap = np.array([float(r.jet.c[0][0]) for r in rows])
                J = np.array([r.jet.c[1][2:] if r.jet.c.shape[-1] > 1 else np.zeros(len(q)) for r in rows])
                q[dependent] += np.linalg.lstsq(J[:, dependent], -gap, rcond=1e-9)[0]
                if np.max(np.abs(gap)) < 1e-13:
                    break
            J, sigma = self._velocity_rows(State(0.0, q, np.zeros(len(q))), None)
            v[dependent] += np.linalg.lstsq(J[:, dependent], -(sigma + J @ v), rcond=1e-9)[0]
        return State(0.0, q, v)

    def reactions(self, solved: Solved, s: State) -> dict[str, float]:
        return laws.reactions(self, solved, s)

    def contacts(self, s: State) -> Solved:
        """As `solve`, with those contacts closed that are pressed: the one choice that contradicts nothing."""
        touching = [name for name in self.modes if laws.touches(name, self, s)]
        fixed = {name: False for name in self.modes if name not in touching}
        kept: list[Solved] = []
        for choice in itertools.product([True, False], repeat=len(touching)):
            closed = fixed | dict(zip(touching, choice, strict=True))
            try:
                solved = self.solve(s, closed)
            except NoAnswer:
                continue
            if all(laws.agrees(name, self, s, solved) for name in touching):
                kept.append(solved)
        if len(kept) != 1:
            raise NoAnswer(f"{len(kept)} states of the contacts agree with the forces")
        return kept[0]


def _pivots(J: np.ndarray) -> list[int]:
    """Columns of J by which its rows are solved, the largest first (Gauss, both pivots)."""
    A, found = J.copy(), []
    for _ in range(min(A.shape)):
        i, k = np.unravel_index(int(np.argmax(np.abs(A))), A.shape)
        if abs(A[i, k]) < 1e-8:
            break
        found.append(int(k))
        A = A - np.outer(A[:, k], A[i]) / A[i, k]
    return found


def tilde(a: np.ndarray) -> np.ndarray:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def least_squares(A: np.ndarray, b: np.ndarray, smallest: float = SMALL) -> tuple[np.ndarray, np.ndarray]:
    """(x of least norm, what may be added to it: rows of a basis), after both sides are scaled."""
    scale_r = np.max(np.abs(A), axis=1)
    scale_r[scale_r < 1e-13] = 1.0
    S = A / scale_r[:, None]
    scale_c = np.max(np.abs(S), axis=0, initial=0.0)
    scale_c[scale_c < 1e-13] = 1.0
    S = S / scale_c
    U, d, Vt = np.linalg.svd(S, full_matrices=True)
    rank = int(np.sum(d > smallest * d[0])) if len(d) else 0
    x = Vt[:rank].T @ ((U[:, :rank].T @ (b / scale_r)) / d[:rank])
    return x / scale_c, Vt[rank:] / scale_c
