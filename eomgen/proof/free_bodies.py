"""System, state -> residual of the equations of its free bodies, at any accelerations: Newton and Euler, in numbers.

    outward:   w = E w_p + s,   wd = E wd_p + s' + E w_p x s,
               acc = E (acc_p + wd_p x r + w_p x (w_p x r) + 2 w_p x r' + r'')
    inward:    F = inertia - applied - W lam,   carried to the parent
    r_k        = C_k . F + rotors - forces without a place:   M a + c - Q - J^T lam

s is the spin of a body against its parent and r its place there; their rates along a motion with the accelerations a
are differences of numbers. No B, no energy, no derivative of a twist is used, and no equation is solved: r is compared
at accelerations and multipliers that are as free as the coordinates. Dependent coordinates are free bodies' coordinates
here, and every constraint that closes them pushes with a lam of its own, which must do no work: so the elimination is
checked.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import (
    Balance,
    Effect,
    NamedReaction,
    Reactions,
    SystemFriction,
)
from eomgen.mechanics.kinematics import BodyLink, SystemInertia
from eomgen.proof.declared_loads import fluids_carried
from eomgen.proof.states import STEP, InNumbers, Way, way_through
from eomgen.symbolic.expression import Matrix, Node, Scalar, State, Vector, Wrench, gradient, symbols_of
from eomgen.symbolic.numeric import NoValue, balanced, evaluate, fifty_digits, rank, tolerances

PARTS = 18  # numbers of a joint: E^T, r, r', s

ELSEWHERE = "motions at another closed state"


@dataclass(frozen=True)
class Demand:
    """Residual of the equations of the free bodies, and rates of constraints.

    Args:
        forces: M a + c - Q - J^T lam, one a speed.
        sizes: of each the sum of the sizes of its terms.
        rates: d/dt (J u + sigma) of every constraint row, by (constraint, number).
    """

    forces: list[Any]
    sizes: list[Any]
    rates: dict[tuple[str, int], Any]


def demand_of(system: System, state: State, h: Any = STEP) -> Demand:
    """Residual of the equations of the free bodies at a state, which gives all symbols, accelerations and lam too.

    Args:
        h: the step of differences [s].
    Raises:
        NoValue: something has no value there.
    """
    if system.free is None:
        return _demand(system, state, h)
    free, u = system.free, system.scope.symbols.u
    found = _demand(free, _with_free_motion(system, free, state, h), h)
    shares = tuple(system.scope.graph.symbol(f"(r{k})") for k in range(len(found.forces)))
    rates = system.free_rates(free)
    rows = gradient(sum((k * rate for k, rate in zip(shares, rates, strict=True)), start=0), u)
    forces = evaluate(rows, state | dict(zip(shares, found.forces, strict=True)), fifty_digits())
    slopes = evaluate([x for row in rows for x in gradient(row, shares)], state, fifty_digits())
    steepest = max(map(abs, slopes), default=0)  # near a dead centre dependent rates are many times those of the speeds
    return Demand(forces, [max(found.sizes, default=0) * max(1, steepest)] * len(u), found.rates)


def multipliers_demanded(system: System, state: State, friction: Sequence[Any] = ()) -> dict[tuple[str, int], float]:
    """lam of every closing and eliminated row, by (constraint, number), with which the free bodies are in equilibrium.

    The residual is linear in lam: it is found without any, and with each alone. Rows that share a force are left out.

    Args:
        friction: that of the contacts along the speeds; () where there is none.
    Raises:
        NoValue: no lam leave nothing; friction along speeds of which rows were eliminated.
    """
    if friction and system.free is not None:
        raise NoValue("there is friction")
    free = system.free or system
    known = _with_free_motion(system, free, state)
    closing, none = free.constraints.closing, dict.fromkeys(free.symbols.lam, fifty_digits().number(0))
    still = _demand(free, known | none)
    alone = [_demand(free, known | none | {lam: fifty_digits().number(1)}).forces for lam in free.symbols.lam]
    known_forces = friction or [0] * len(still.forces)
    right = np.array([float(x - f) for x, f in zip(still.forces, known_forces, strict=True)])
    A = np.array([[float(x - y) for x, y in zip(still.forces, one, strict=True)] for one in alone]).T
    _, rows, columns = balanced(A)
    A, right = rows[:, None] * A * columns, rows * right
    lam = np.linalg.lstsq(A, right, rcond=tolerances.RANK)[0]
    if np.any(
        abs(A @ lam - right) > tolerances.COMPUTED * (abs(rows * [float(x) for x in still.sizes]) + abs(A) @ abs(lam))
    ):
        raise NoValue("the forces of the constraints do not balance the free bodies")
    single = [rank(np.delete(A, k, axis=1)) < rank(A) for k in range(len(closing))]
    values = zip(closing, columns * lam, single, strict=True)
    return {(row.constraint, row.number): float(x) for row, x, has_one in values if has_one}


def drive_demanded(system: System, coordinate: str, known: State) -> tuple[Any, Any]:
    """(M a + c - Q - J^T lam of a driven coordinate that is freed, at the motion as given; the size of its terms).

    Raises:
        NoValue: a constraint drives it; there is friction; constraints follow from others only while it is driven.
    """
    if not system.scope.model.coordinates[coordinate].driven:
        raise NoValue("a constraint drives it")
    if SystemFriction(system).named:  # of what is driven alone too, where no equation of motion holds it
        raise NoValue("there is friction")
    free = system.let_go(coordinate)
    own = {**system.scope.names, **{lam.name: lam for lam in system.symbols.lam}}
    symbols = free.symbols
    moving = (*symbols.x, *symbols.a, *symbols.lam, *symbols.inputs.values(), symbols.t)
    nodes = (*symbols.parameters.values(), *moving)
    if not {x.name for x in nodes} <= {*own}:
        raise NoValue("constraints that follow from others do not without the drive")
    there = dict(zip(nodes, evaluate([own[x.name] for x in nodes], known, fifty_digits()), strict=True))
    demand, k = demand_of(free, there), [u.name for u in symbols.u].index(f"{coordinate}'")
    return demand.forces[k], demand.sizes[k]


def moved_otherwise(
    system: System, state: State, friction: Sequence[Any] = (), *, regular: float = tolerances.NEARLY_SINGULAR
) -> str:
    """Message if the accelerations of a state violate the equations of the free bodies, for any constraint forces; "".

        z . (M a + c - Q) = 0  for every z with J z = 0,      d/dt (J u + sigma) = 0

    J holds every row of every constraint that closes, those too that determine dependent coordinates or follow from
    others:
    its rank is that at the state, and no row is chosen. So a is that of the bodies with multipliers of least norm.

    Args:
        state: one in which the constraints hold, positions and speeds, at 50 digits, accelerations included.
        friction: that of the contacts along the speeds; () where there is none.
        regular: how independent rows must be, or not at all.
    Raises:
        NoValue: next to a singular position; friction along speeds of which rows were eliminated.
    """
    free = system.free or system
    if friction and free is not system:
        raise NoValue("there is friction")
    known = _of_all_rates(system, free, state)
    needed, J = _demand(free, known), Closure(free.constraints).rows_at(known)
    held = np.vstack([J, *_unit_lengths(free, known)])
    turning = (float(known[x]) ** 2 for x in free.scope.symbols.u)  # terms of the rate of J are of the size J u^2
    a = np.abs([float(known[x]) for x in free.scope.symbols.a]) + np.fromiter(turning, float)
    for row, line in zip(free.constraints.closing, J, strict=True):
        if abs(needed.rates[row.constraint, row.number]) > tolerances.COMPUTED * (1 + abs(line) @ a):
            return f"row {row.number} of '{row.constraint}' is torn open"
    own = [float(x) for x in friction] or [0.0] * len(needed.forces)
    forces = np.array([float(x) - y for x, y in zip(needed.forces, own, strict=True)])
    sizes = np.array([float(x) + abs(y) for x, y in zip(needed.sizes, own, strict=True)])
    allowed = _allowed(held, regular)
    if free is not system and allowed.shape[1] > _motions_elsewhere(free, known, regular):
        raise NoValue("in a singular position, where more may move than elsewhere")
    for z in allowed.T:
        if abs(z @ forces) > abs(z) @ (tolerances.COMPUTED * sizes + tolerances.ZERO_AT_50) + abs(
            z @ _rounded(system, free, state, needed)
        ):
            most = free.scope.symbols.u[int(np.argmax(abs(z) * sizes))]
            return f"the bodies are not in equilibrium along {most.name}"
    return ""


def _of_all_rates(system: System, free: System, state: State) -> State:
    """The state of the free system, where nothing pushes along its rows."""
    known = state if free is system else _with_free_motion(system, free, state)
    return known | dict.fromkeys(free.symbols.lam, fifty_digits().number(0))


def _rounded(system: System, free: System, state: State, needed: Demand) -> np.ndarray:
    """Change of the forces with a relative change COMPUTED of accelerations: s2'' = u1' - u2' may be rounding alone."""
    rng, a = Random(1), system.symbols.a
    shaken = {x: state[x] * (1 + tolerances.COMPUTED * rng.choice((-1, 1)) * rng.uniform(0.5, 1)) for x in a}
    there = _demand(free, _of_all_rates(system, free, state | shaken))
    return np.array([float(x - y) for x, y in zip(there.forces, needed.forces, strict=True)])


def _motions_elsewhere(free: System, state: State, regular: float) -> float:
    """Number of motions that the constraints allow at another state where they hold; infinite where none is found."""
    if ELSEWHERE not in free.found:
        try:
            there = state | Closure(free.constraints).generic(1)
            held = np.vstack([Closure(free.constraints).rows_at(there), *_unit_lengths(free, there)])
            free.found[ELSEWHERE] = _allowed(held, regular).shape[1]
        except (DerivationError, ModelError, NoValue):
            free.found[ELSEWHERE] = np.inf
    found: float = free.found[ELSEWHERE]
    return found


def _unit_lengths(free: System, state: State) -> list[np.ndarray]:
    """e . e' = 0 of every quaternion among rates: along e nothing moves."""
    rates = [u.name for u in free.scope.symbols.u]
    rows = []
    for four in free.scope.quaternions:
        row = np.zeros((1, len(rates)))
        for e in four:
            if f"{e.name}'" in rates:
                row[0, rates.index(f"{e.name}'")] = float(state[e])
        rows += [row] if row.any() else []
    return rows


def _allowed(J: np.ndarray, regular: float) -> np.ndarray:
    """The z with J z = 0, in columns.

    Raises:
        NoValue: whether rows depend on one another is not sure.
    """
    scaled, _, columns = balanced(J)
    _, values, directions = np.linalg.svd(scaled)
    if np.any((values > tolerances.SUMMED) & (values < regular)):
        raise NoValue("next to a singular position")
    free: np.ndarray = columns[:, None] * directions[int(np.sum(values >= regular)) :].T
    return free


def _with_free_motion(system: System, free: System, state: State, h: Any = STEP) -> State:
    """The state of the free system: its speeds and accelerations, and a lam of every row that determines a rate."""
    speeds, a = _Bodies(system, state, h).along_motion(system.free_rates(free))
    symbols = free.scope.symbols
    motion = dict(zip(symbols.u, speeds, strict=True)) | dict(zip(symbols.a, a, strict=True))
    pushing = {(row.constraint, row.number) for row in system.constraints.rows if row.eliminates}
    rows = zip(free.constraints.closing, free.symbols.lam, strict=True)
    lam = {x: fifty_digits().number(int((row.constraint, row.number) in pushing)) for row, x in rows}
    return lam | state | motion


def _demand(system: System, state: State, h: Any = STEP) -> Demand:
    """Residual for a system in which every closing constraint has its multipliers."""
    closing, bodies = system.constraints.closing, _Bodies(system, state, h)
    forces = bodies.at(bodies.formulas.direct)
    sizes = [abs(x) for x in forces]
    others = ((k, x, abs(x)) for k, x in (*bodies.of_rotors(), *bodies.of_equations()))
    for k, x, size in (*bodies.along_joints(), *others):
        forces[k], sizes[k] = forces[k] + x, sizes[k] + size
    _, rates = bodies.along_motion(bodies.formulas.rates)
    return Demand(forces, sizes, {(r.constraint, r.number): x for r, x in zip(closing, rates, strict=True)})


@dataclass(frozen=True)
class _Formulas:
    """Scalars of a system that are evaluated at every state, built once."""

    system: System

    @cached_property
    def _by_joints(self) -> list[tuple[Scalar, ...]]:
        """Pose and motion of every joint: E^T by rows, r and r' in the parent's axes, s in the body's."""
        found = []
        for link in self.system.motion.links:
            r = link.local.point(-link.point)
            spin = Vector.ZERO
            for rate, (w, _) in zip(link.s_rate, link.S, strict=True):
                spin = spin + rate * w
            rows = (x for row in link.local.R for x in row)
            found.append((*rows, *r, *self.system.scope.time_derivative(r), *spin))
        return found

    @property
    def joints(self) -> tuple[Scalar, ...]:
        return tuple(x for joint in self._by_joints for x in joint)

    @property
    def speeds(self) -> list[list[Node]]:
        """Speeds on which r' and s of every joint depend."""
        place = frozenset(self.system.scope.symbols.u)
        return [[x for x in symbols_of(joint[12:]) if x in place] for joint in self._by_joints]

    @property
    def columns(self) -> tuple[Scalar, ...]:
        """Derivatives of r' and s by these speeds, entry by entry."""
        pairs = zip(self._by_joints, self.speeds, strict=True)
        return tuple(x for joint, own in pairs for y in joint[12:] for x in gradient(y, own))

    @cached_property
    def masses(self) -> tuple[Scalar, ...]:
        """m, c and I of every body."""
        masses = [self.system.scope.mass_properties(link.name) for link in self.system.motion.links]
        return tuple(x for mass in masses for x in (mass.m, *mass.com, *(y for row in mass.I for y in row)))

    @cached_property
    def pushes(self) -> list[tuple[str, Wrench, Node | None]]:
        """(body, wrench about its origin in its axes, its lam): loads and weights, then constraint rows."""
        constraints, loads = self.system.constraints, self.system.loads
        found = [self.system.motion.body_wrench(load) for load in (*loads.placed, *loads.weights)]
        rows = zip(constraints.closing, self.system.symbols.lam, strict=True)
        of_rows = [(body, wrench, lam) for row, lam in rows for body, wrench in row.wrenches]
        return [*((*pair, None) for pair in found if pair is not None), *of_rows]

    @cached_property
    def direct(self) -> tuple[Scalar, ...]:
        """Bias of rotors along every speed, less the generalized forces without a place."""
        loads = self.system.loads
        acting = [x + y for x, y in zip(loads.joint_forces, loads.placeless_forces, strict=True)]
        _, rotors = SystemInertia(self.system.motion).beside_bodies()
        return tuple(y - x for x, y in zip(acting, rotors, strict=True))

    @property
    def rates(self) -> tuple[Scalar, ...]:
        """Velocities of constraint rows."""
        return tuple(row.velocity for row in self.system.constraints.closing)

    @property
    def slopes(self) -> tuple[Scalar, ...]:
        """Derivatives by every speed of the parts of constraint rows that are not functions of twists."""
        u = self.system.scope.symbols.u
        return tuple(x for row in self.system.constraints.closing for x in gradient(row.direct, u))


@dataclass(frozen=True)
class _Bodies(InNumbers):
    """The free bodies of a system at a state; h is the step of differences."""

    h: Any = STEP

    @cached_property
    def formulas(self) -> _Formulas:
        if _Formulas not in self.system.found:
            self.system.found[_Formulas] = _Formulas(self.system)
        found: _Formulas = self.system.found[_Formulas]
        return found

    @property
    def links(self) -> tuple[BodyLink, ...]:
        return self.system.motion.links

    def along_motion(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any]]:
        """(values, rates along the motion with the accelerations of the state), these by differences."""
        return self.at(scalars), self._way.rates(scalars)

    @cached_property
    def _way(self) -> Way:
        return way_through(self.system, self.state, self.h)

    @cached_property
    def _moving(self) -> tuple[list[list[Any]], list[list[Any]]]:
        """(values, rates) of every joint."""
        values, rates = self.along_motion(self.formulas.joints)
        return _in_parts(values, PARTS), _in_parts(rates, PARTS)

    @cached_property
    def _motions(self) -> list[tuple[Vector, Vector, Vector]]:
        """(w, wd, acceleration of its origin) of every body in its axes, outward from the ground."""
        found: list[tuple[Vector, Vector, Vector]] = []
        for link, own, rate in zip(self.links, *self._moving, strict=True):
            E = _turn(own).T
            r, velocity, s = (Vector(own[k : k + 3]) for k in (9, 12, 15))
            w_p, wd_p, acc_p = found[link.parent] if link.parent >= 0 else (Vector.ZERO, Vector.ZERO, Vector.ZERO)
            carried = E @ w_p
            acc = acc_p + (wd_p.cross(r) + w_p.cross(w_p.cross(r) + 2 * velocity))
            wd = E @ wd_p + Vector(rate[15:18]) + carried.cross(s)
            found.append((carried + s, wd, E @ (acc + Vector(rate[12:15]))))
        return found

    @property
    def _inertia(self) -> list[Wrench]:
        """Inertia wrench of every body and the fluid that moves with it, about its origin in its axes."""
        found = [_taken(mass, *motion) for mass, motion in zip(self._masses, self._motions, strict=True)]
        for k, taken in self._fluids:
            found[k] = found[k].plus(taken)
        return found

    @property
    def _fluids(self) -> list[tuple[int, Wrench]]:
        """(body, what its fluid takes): p' and L' + v x p about the place, by differences in ground axes."""
        found = []
        for fluid in fluids_carried(self.system).values():
            link = self.motion.link(fluid.body)
            arm, *others = (self.vector(x) for x in (fluid.place - link.pose.p, fluid.v, fluid.p))
            rates = self._way.rates((*fluid.p, *fluid.L))
            f, turning = Vector(rates[:3]), Vector(rates[3:])
            R = Matrix.of(tuple(self.vector(row) for row in link.pose.R)).T
            tau = turning + others[0].cross(others[1]) + arm.cross(f)
            found.append((self.motion.index[fluid.body], Wrench(R @ tau, R @ f)))
        return found

    @cached_property
    def _masses(self) -> list[list[Any]]:
        """m, c and I of every body."""
        return _in_parts(self.at(self.formulas.masses), 13)

    @property
    def _inertia_sizes(self) -> list[tuple[Any, Any]]:
        """Sizes of force and moment: sums of the absolute values of their terms, so that cancellation is seen."""
        found, of_origins = [], list[tuple[Any, Any]]()  # (|wd|, |acc|) of every body
        for link, own, rate, (w, _, _), mass in zip(
            self.links, *self._moving, self._motions, self._masses, strict=True
        ):
            r, v, s = (_size(own[k : k + 3]) for k in (9, 12, 15))
            wd_p, acc_p = of_origins[link.parent] if link.parent >= 0 else (0, 0)
            w_p = _size(self._motions[link.parent][0]) if link.parent >= 0 else 0
            wd = wd_p + _size(rate[15:18]) + w_p * s
            acc = acc_p + wd_p * r + w_p * w_p * r + 2 * w_p * v + _size(rate[12:15])
            of_origins.append((wd, acc))
            m, c, I, spin = mass[0], _size(mass[1:4]), _size(mass[4:13]), _size(w)
            force = m * (acc + wd * c + spin * spin * c)
            found.append((force, I * wd + spin * spin * I + c * force))
        for k, taken in self._fluids:
            found[k] = found[k][0] + _size(taken.f), found[k][1] + _size(taken.tau)
        return found

    @cached_property
    def _pushes(self) -> list[tuple[str, Wrench]]:
        """(body, load, weight or push of a constraint row on it, about its origin in its axes)."""
        pushes = self.formulas.pushes
        values = _in_parts(self.at([x for _, wrench, _ in pushes for x in (*wrench.tau, *wrench.f)]), 6)
        sizes = [1 if lam is None else self.state[lam] for *_, lam in pushes]
        return [
            (body, Wrench(size * Vector(x[:3]), size * Vector(x[3:])))
            for (body, *_), size, x in zip(pushes, sizes, values, strict=True)
        ]

    @property
    def _applied(self) -> list[Wrench]:
        """All of them together on every body."""
        total = {link.name: Wrench(Vector.ZERO, Vector.ZERO) for link in self.links}
        for body, push in self._pushes:
            total[body] = total[body].plus(push)
        return list(total.values())

    @property
    def _through_joints(self) -> list[Wrench]:
        """Wrench that every body needs through its joint, about its origin in its axes; leaves pass theirs on."""
        found = [
            Wrench(taken.tau - given.tau, taken.f - given.f)
            for taken, given in zip(self._inertia, self._applied, strict=True)
        ]
        for i in reversed(range(len(found))):
            parent, own = self.links[i].parent, self._moving[0][i]
            if parent >= 0:
                carried = found[i].turned(_turn(own)).moved(Vector(own[9:12]))
                found[parent] = found[parent].plus(carried)
        return found

    @property
    def _sizes(self) -> list[tuple[Any, Any]]:
        """(force, moment) of all that adds up to it, without signs: of one that cancels only rounding is left."""
        found = dict(zip((link.name for link in self.links), self._inertia_sizes, strict=True))
        for body, push in self._pushes:
            f, tau = found[body]
            found[body] = f + _size(push.f), tau + _size(push.f) + _size(push.tau)
        sizes = list(found.values())
        for i in reversed(range(len(sizes))):
            parent, arm = self.links[i].parent, _size(self._moving[0][i][9:12])
            if parent >= 0:
                sizes[parent] = sizes[parent][0] + sizes[i][0], sizes[parent][1] + sizes[i][1] + arm * sizes[i][0]
        return sizes

    def along_joints(self) -> Iterator[tuple[int, Any, Any]]:
        """(speed, force of a joint along it, its size), by the columns of s and r' for each speed, on its wrench."""
        place = {symbol: k for k, symbol in enumerate(self.system.scope.symbols.u)}
        values = iter(self.at(self.formulas.columns))
        for own, joint, wrench, (f, tau) in zip(
            self.formulas.speeds, self._moving[0], self._through_joints, self._sizes, strict=True
        ):
            for k, y in enumerate((*(_turn(joint) @ wrench.f), *wrench.tau)):
                for symbol in own:
                    value = next(values)
                    yield place[symbol], value * y, abs(value) * (f if k < 3 else tau)

    def of_rotors(self) -> Iterator[tuple[int, Any]]:
        """Rotors behind gears: armature D_k D_l a_l."""
        (found, _), a = SystemInertia(self.system.motion).beside_bodies(), self.system.scope.symbols.a
        values = self.at([value for _, _, value in found])
        return ((i, value * self.state[a[j]]) for (i, j, _), value in zip(found, values, strict=True))

    def of_equations(self) -> Iterator[tuple[int, Any]]:
        """-lam of every row along what no twist sees: the slide of points in their bodies, constraints of
        coordinates."""
        slopes = _in_parts(self.at(self.formulas.slopes), len(self.system.scope.symbols.u) or 1)
        for lam, slope in zip(self.system.symbols.lam, slopes, strict=False):
            yield from ((k, -x * self.state[lam]) for k, x in enumerate(slope))
        yield from self._of_fluids_that_slide()

    def _of_fluids_that_slide(self) -> Iterator[tuple[int, Any]]:
        """p' . d(R r')/du of fluids whose place a coordinate moves in its body."""
        u, taken = self.system.scope.symbols.u, (wrench for _, wrench in self._fluids)
        for (_, place, *_), wrench in zip(SystemInertia(self.system.motion).fluids, taken, strict=True):
            own = self.motion.link(place[0] or "").pose.R.T @ self.motion.slide(place)
            columns = zip(*(gradient(x, u) for x in own), strict=True) if self.motion.moves(place[1]) else ()
            yield from ((k, wrench.f @ self.vector(column)) for k, column in enumerate(columns))


def _taken(mass: Sequence[Any], w: Vector, wd: Vector, acc: Vector) -> Wrench:
    """Moment I wd + w x I w + c x f and force f = m (acc + wd x c + w x (w x c))."""
    m, c, I = mass[0], Vector(mass[1:4]), Matrix.of((mass[4:7], mass[7:10], mass[10:13]))
    f = m * (acc + (wd.cross(c) + w.cross(w.cross(c))))
    return Wrench(I @ wd + w.cross(I @ w) + c.cross(f), f)


def _size(vector: Sequence[Any]) -> Any:
    return sum(map(abs, vector))


def _turn(joint: Sequence[Any]) -> Matrix:
    """Rotation matrix from the child's axes to the parent's."""
    return Matrix.of((joint[0:3], joint[3:6], joint[6:9]))


def _in_parts(values: Sequence[Any], length: int) -> list[list[Any]]:
    return [list(values[k : k + length]) for k in range(0, len(values), length)]


# -------- named axes ------------------------------------------------------------------------------------------
# Balance, state -> check that reactions have the meaning of their names, in numbers.
#
#     reaction_x|y|z(owner) = R f,   reaction_couple_x|y|z(owner) = R n,      R and the sums of f and n of one body
#     drive(q) = (M a + c - Q - J^T lam)_q,   by the free bodies, with q released
#
# Components take random values: a name is linear in them. R is that of the pose of the body at the state; the wrench of
# a component on a body is in the axes of its equations, which the equilibrium of the whole in ground axes checks.


ALONG = {f"reaction_{couple}{axis}": (couple, k) for couple in ("", "couple_") for k, axis in enumerate("xyz")}


def named_otherwise(balance: Balance, state: State) -> str:
    """Message that names a reaction which is not along the ground axis of its name; "".

    Raises:
        NoValue: something has no value there.
    """
    proof = _Named(balance.system, state, balance)
    for named in NamedReaction.all_of(balance):
        function, _, rest = named.name.partition("(")
        if function in ALONG and named.combination:
            couple, k = ALONG[function]
            stated, size = proof.stated(named)
            due = proof.due(named.owner, rest.removesuffix(")"), couple)
            if due is not None and abs(stated - due[k]) > tolerances.ZERO_AT_50 * (1 + size + sum(map(abs, due))):
                return f"{named.name} is not along the ground's {'xyz'[k]}"
    return ""


def drives_beside(reactions: Reactions) -> dict[str, str]:
    """{name of a drive: its coordinate}, of drives by the model's [coordinates], without friction in the system."""
    system = reactions.balance.system
    if SystemFriction(system).named:
        return {}
    driven = system.scope.model.coordinates
    return {c.name: c.side for c in reactions.components if c.kind == "drive" and c.side and driven[c.side].driven}


def driven_otherwise(reactions: Reactions, state: State) -> str:
    """Message that names a drive which is not the force that the free bodies need along its released coordinate; "".

    Raises:
        NoValue: none is determinate with another way.
    """
    sides, found = drives_beside(reactions), 0
    for named in (named for named in NamedReaction.all_of(reactions.balance) if named.name in sides):
        try:
            due, size = drive_demanded(reactions.balance.system, sides[named.name], state)
            value = reactions.combined(named.combination, named.name) + named.given
        except (NoValue, DerivationError):  # it has no single value
            continue
        (stated,) = evaluate((value,), state, fifty_digits())
        if abs(stated - due) > tolerances.COMPUTED * (size + abs(stated)):
            return f"{named.name} = {float(stated):.10g}, and the bodies ask for {float(due):.10g}"
        found += 1
    if not found:
        raise NoValue("no drive is determinate, or constraints follow from others only while it drives")
    return ""


@dataclass(frozen=True)
class _Named(InNumbers):
    balance: Balance

    @cached_property
    def values(self) -> list[Any]:
        """Random values of every component."""
        rng = Random(17)
        return [fifty_digits().number(rng.randint(20, 90)) / 7 for _ in self.balance.components]

    def stated(self, named: NamedReaction) -> tuple[Any, Any]:
        """(value of a named reaction, size of its terms)"""
        *factors, given = self.at((*named.combination.values(), named.given))
        x = self.values
        terms = [given, *(k * x[j] for j, k in zip(named.combination, factors, strict=True))]
        return sum(terms, start=0), sum(map(abs, terms))

    def due(self, owner: str, place: str, couple: str) -> Any:
        """The force, or couple, on the body of which the name speaks, ground axes; None where it speaks of none."""
        mine = [(j, c) for j, c in enumerate(self.balance.components) if c.owner == owner]
        held = [c for _, c in mine if c.kind != "drive"]
        side = place.removeprefix(owner).removeprefix(".")
        if not held:
            return None
        links = self.motion.index
        on = links[side] if side else held[0].effects[0].link
        total: Any = (0, 0, 0)
        for j, component in mine:
            effects = (*component.effects, *component.friction_effects)
            total = tuple(x + y for x, y in zip(total, self._turned(on, effects, couple, self.values[j]), strict=True))
        efforts = Effect.of_joint(self.system, owner) if owner in links and not side else []
        return tuple(x + y for x, y in zip(total, self._turned(on, efforts, couple, 1), strict=True))

    def _turned(self, on: int, effects: Iterable[Effect], couple: str, share: Any) -> Any:
        """Part of the wrench of effects on one body, turned by the pose of the body."""
        total = [0 * fifty_digits().number(1)] * 3
        for effect in (each for each in effects if each.link == on):
            own = self.at(effect.couple if couple else effect.force)
            total = [x + share * y for x, y in zip(total, own, strict=True)]
        if self.system.scope.model.space == "plane":
            return tuple(total)
        return self.carried(self.motion.links[on].name, Vector((total[0], total[1], total[2])), direction=True)
