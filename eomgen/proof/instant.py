"""Velocities, accelerations and output functions at one instant, by their second definitions.

KinematicState -> checks of velocities, accelerations and centres at one instant, against differences of places.

The motion through the state, to second order: q(t + h) = q + h q' + h^2/2 q''. Places and axes of the bodies at t - h,
t and t + h, with 50 digits, give every velocity and acceleration again; no rate of a twist, no field and no law of
relative motion is used. Shared: the poses as functions of q and t, and q' = N u + nu (both proven with the equations).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import combinations
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant import BodyMotion, KinematicState, Quantities
from eomgen.mechanics.kinematics import SystemInertia
from eomgen.model import FUNCTIONS, PointForce
from eomgen.proof.at_a_state import NumericState
from eomgen.proof.check import Check, checked, differing, unchecked
from eomgen.proof.declared_loads import Declared, acting
from eomgen.proof.degrees_of_freedom import Nearby
from eomgen.proof.free_bodies import drive_demanded, multipliers_demanded
from eomgen.proof.impacts import struck
from eomgen.proof.states import SECOND_STEP, Pushes, Way, add_push, closed_state, pushes_of, way_through, with_inputs
from eomgen.symbolic.expression import Call, Matrix, Node, Scalar, Vector, is_zero, parse, symbols_of
from eomgen.symbolic.numeric import NoValue, eigenpairs_in_digits, evaluate, fifty_digits, rank, tolerances

DIFFERENCES = "differences at 50 digits"
MOST_TRIPLES = 60  # of bodies whose three centres are looked at


def instant_checks(
    state: KinematicState, motions: Sequence[BodyMotion] = (), relative: Sequence[tuple[str, str]] = ()
) -> Iterator[Check]:
    """Checks of a printed kinematic state.

    Args:
        motions: of the bodies, as they are printed.
        relative: (point, body): the points that are seen from bodies.
    """
    proof = _Proof(state)
    checks = [
        ("the degrees of freedom are those that the gaps of the constraints leave", proof.wrong_degrees_of_freedom),
        ("the constraints are satisfied along the motion", proof.wrong_constraints),
        ("given velocities and accelerations hold", proof.wrong_given),
        ("velocities and accelerations of points are the differences of their places", proof.wrong_points),
        ("spins and angular accelerations are the differences of the bodies' axes", proof.wrong_fields),
        ("centres of rotation have no velocity against each other", proof.wrong_centers),
        ("any three centres are on one line (Kennedy)", proof.wrong_lines),
        ("centres by drawing and by velocities agree", lambda: state.disagreement),
        ("poles, inflection circles and slowest points are such", lambda: proof.wrong_motions(motions)),
        ("kinds of motion are those of the spins and velocities", lambda: proof.wrong_kinds(motions)),
        ("v = v_t + v_r, a = a_t + a_r + a_C, each found by itself", lambda: proof.wrong_relative(relative)),
        ("accelerations satisfy the equations of motion", proof.wrong_accelerations),
    ]
    for name, wrong in checks:
        try:
            found = wrong()
        except (NoValue, ZeroDivisionError) as error:
            yield unchecked(name, str(error) or "no value there", DIFFERENCES)
            continue
        if found is not None:
            yield checked(name, found, DIFFERENCES)


def values_of(state: KinematicState) -> Mapping[Node, Any]:
    """Every symbol at the instant, with 50 digits; parameters and rates that have no value are something."""
    rng = Random(3)
    known: dict[Node, Any] = state.system.scope.values_of_parameters(rng)
    scalars = tuple(state.state.values())
    for x in symbols_of(scalars):
        if x not in known:
            known[x] = fifty_digits().number(rng.randint(50, 90)) / 60
    found = dict(zip(state.state, evaluate(scalars, known, fifty_digits()), strict=True))
    return {**known, **found}


@dataclass(frozen=True)
class Seen:
    """A rigid body by differences of its poses, ground axes.

    Args:
        p, v, a: of its origin.
        R: its axes.
        R1, R2: the rates of these.
        w, e: spin and angular acceleration.
    """

    p: Vector
    v: Vector
    a: Vector
    R: Matrix
    R1: Matrix
    R2: Matrix
    w: Vector
    e: Vector

    def velocity(self, place: Vector) -> Vector:
        return self.v + self.w.cross(place - self.p)

    def acceleration(self, place: Vector) -> Vector:
        r = place - self.p
        return self.a + (self.e.cross(r) + self.w.cross(self.w.cross(r)))


NONE = Matrix((Vector.ZERO, Vector.ZERO, Vector.ZERO))
REST = Seen(Vector.ZERO, Vector.ZERO, Vector.ZERO, Matrix.IDENTITY, NONE, NONE, Vector.ZERO, Vector.ZERO)


@dataclass(frozen=True)
class _Proof:
    """Tests of a kinematic state; each gives what is wrong in words, "", or None where there is nothing to check.

    Args:
        state: the printed state.
    """

    state: KinematicState

    # -- the motion ------------------------------------------------------------------------------------------

    @cached_property
    def values(self) -> Mapping[Node, Any]:
        return values_of(self.state)

    @property
    def accelerated(self) -> bool:
        return bool(self.state.accelerated)

    @cached_property
    def way(self) -> Way:
        """The motion through the state, to second order."""
        system = self.state.system
        found = way_through(system, {**dict.fromkeys(system.symbols.a, 0), **self.values}, SECOND_STEP, order=2)
        _, first, second = found.along(system.symbols.q)
        if any(abs(x) > tolerances.LARGEST_AT_50 for x in (*first, *second)):
            raise NoValue("too fast for differences")
        return found

    def along(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """(scalars, their first and second rates) by differences.

        Raises:
            NoValue: they are so large that no digits are left for differences.
        """
        now, first, second = self.way.along(scalars)
        if any(abs(x) > tolerances.LARGEST_AT_50 for x in now):
            raise NoValue("too far from the origin for differences")
        return now, first, second

    def wrong_degrees_of_freedom(self) -> str | None:
        """Message if the degrees of freedom are not those by the rank of the gradients of the gaps; "".

        In a singular position those of another position count too. None: there are no constraints.
        """
        system, reported = self.state.system, self.state.degrees_of_freedom
        if not system.symbols.u or all(row.identical for row in system.constraints.rows):
            return None
        left = _degrees_of_freedom_left(system, self.values)
        if reported != left and _degrees_of_freedom_left(system, closed_state(system, Random(8))[0]) != reported:
            return f"{reported} for {left}"
        return ""

    def here(self, scalars: Sequence[Scalar]) -> Vector:
        return Vector(evaluate(tuple(scalars), self.way.now, fifty_digits()))

    def one(self, x: Scalar) -> Any:
        return evaluate((x,), self.way.now, fifty_digits())[0]

    @cached_property
    def bodies(self) -> dict[str, Seen]:
        """Every body by differences."""
        fixed = {} if self.state.mechanism is None else {self.state.mechanism.FIXED: REST}
        return {link.name: self._seen(link.pose) for link in self.state.system.motion.links} | fixed

    def _seen(self, pose: Any) -> Seen:
        now, first, second = self.along([*pose.p, *(x for row in pose.R for x in row)])
        R, R1, R2 = (Matrix.of((x[3:6], x[6:9], x[9:12])) for x in (now, first, second))
        p, v, a = (Vector(x[:3]) for x in (now, first, second))
        return Seen(p, v, a, R, R1, R2, _turning(R1, R), _turning(R2, R))

    @cached_property
    def size(self) -> tuple[Any, Any]:
        """Largest velocity and largest acceleration of the bodies."""
        speeds = [x.largest for body in self.bodies.values() for x in (body.v, body.w)]
        rates = [x.largest for body in self.bodies.values() for x in (body.a, body.e)]
        return max(speeds, default=0), max(rates, default=0)

    def differs(self, stated: Sequence[Any], found: Sequence[Any], order: int, tolerance: float = 0.0) -> bool:
        """True if velocities (order 1) or accelerations (2) differ.

        A quaternion of doubles turns as its length allows, which is 1 to their digits only.
        """
        tolerance = tolerance or (
            self.tolerance if self.state.system.scope.quaternions else tolerances.DIFFERENCE_AT_50
        )
        size = self.size[order - 1] + max(map(abs, found), default=0)
        floor = tolerances.DIFFERENCE_AT_50 * max(map(abs, (self.size[0], 1)))
        return any(abs(x - y) > tolerance * size + floor for x, y in zip(stated, found, strict=True))

    @property
    def tolerance(self) -> float:
        """Tolerance of the state's equations; the state may be known in doubles only."""
        return tolerances.DIFFERENCE_AT_50 if self.state.exact and not self.state.rounded else tolerances.COMPUTED

    # -- constraints and given equations ----------------------------------------------------------------------------

    def wrong_constraints(self) -> str | None:
        """phi stays 0: its first and second differences; of velocity rows W^T xi + s_t and its difference."""
        rows = self.state.system.constraints.rows
        gaps = [row for row in rows if row.gap is not None]
        _, first, second = self.along([row.gap for row in gaps if row.gap is not None])
        rolling = [row for row in rows if row.gap is None]
        slip, rate, _ = self.along([row.velocity for row in rolling])
        for row, v, a in [*zip(gaps, first, second, strict=True), *zip(rolling, slip, rate, strict=True)]:
            if self.differs((v,), (0,), 1, self.tolerance):
                return f"'{row.constraint}' opens at {float(v):.3g} m/s"
            if self.accelerated and self.differs((a,), (0,), 2, self.tolerance):
                return f"'{row.constraint}' opens at {float(a):.3g} m/s^2"
        return "" if rows else None

    def wrong_given(self) -> str | None:
        """left = right at the state."""
        if not self.state.given:
            return None
        quantities = Quantities(self.state.system, self.state.state)
        names = self.state.system.scope.names
        for text in self.state.given:
            typed = (parse(side, references=True) for side in text.split("="))
            sides = [side.evaluate(names, quantities.value) for side in typed]
            left, right = evaluate(sides, self.way.now, fifty_digits())
            if abs(left - right) > self.tolerance * (abs(left) + abs(right) + self.size[0]):
                return f"{text}: {float(left):.10g} and {float(right):.10g}"
        return ""

    # -- points and bodies -----------------------------------------------------------------------------------

    def wrong_points(self) -> str | None:
        motion = self.state.system.motion
        for names, r, v, a in self.state.points:
            for name in names.split(", "):
                place, first, second = self.along(motion.position(motion.place(name)))
                held = self.tolerance if "," in names else 0.0  # constraints that close in doubles hold them together
                if self.differs(self.here(r), place, 1, self.tolerance) or self.differs(self.here(v), first, 1, held):
                    return f"velocity of {name}"
                if a is not None and self.differs(self.here(a), second, 2, held):
                    return f"acceleration of {name}"
        return "" if self.state.points else None

    def wrong_fields(self) -> str | None:
        for name, field in self.state.fields.items():
            seen = self.bodies[name]
            if self.differs(self.here(field.w), seen.w, 1) or self.differs(self.here(field.v), seen.v, 1):
                return f"'{name}'"
            if self.accelerated and self.differs((*self.here(field.e), *self.here(field.a)), (*seen.e, *seen.a), 2):
                return f"'{name}': accelerations"
        return "" if self.state.fields else None

    # -- centres ---------------------------------------------------------------------------------------------

    def wrong_centers(self) -> str | None:
        """Message if a centre is wrong: v_i = v_j there, at infinity w_i = w_j and v_j - v_i normal to it; ""."""
        mechanism = self.state.mechanism
        if mechanism is None or not mechanism.centers:
            return None
        for pair, center in mechanism.centers.items():
            i, j = (self.bodies[body] for body in pair)
            point = self.here(center.point)
            if center.at_infinity:
                apart = j.velocity(i.p) - i.velocity(i.p)
                left: tuple[Any, ...] = (j.w[2] - i.w[2], apart @ point / _size(point))
            else:
                place = Vector((point[0], point[1], 0))
                left = (j.velocity(place) - i.velocity(place))[:2]
            if self.differs(left, (0,) * len(left), 1, self.tolerance * (1 + point.largest)):
                return center.name
        return ""

    def wrong_lines(self) -> str | None:
        """det(c_ij, c_jk, c_ik) = 0"""
        mechanism = self.state.mechanism
        if mechanism is None or len(mechanism.blocks) < 3:
            return None
        for three in list(combinations(mechanism.blocks, 3))[:MOST_TRIPLES]:
            points = [_unit(self.here(mechanism.centers[pair].point)) for pair in combinations(three, 2)]
            volume: Any = points[0] @ points[1].cross(points[2])
            if abs(volume) > self.tolerance:
                return f"those of {', '.join(three)}"
        return ""

    # -- bodies, further -------------------------------------------------------------------------------------

    def wrong_motions(self, motions: Sequence[BodyMotion]) -> str | None:
        looked = False
        for motion in motions:
            seen = self.bodies[motion.body]
            for what, left, order in self._points_of(motion, seen):
                looked = True
                if self.differs(left, (0,) * len(left), order, self.tolerance):
                    return f"{what} of '{motion.body}'"
        return "" if looked else None

    def _points_of(self, motion: BodyMotion, seen: Seen) -> Iterator[tuple[str, Sequence[Any], int]]:
        """(name, vector that vanishes there, order of its derivative)."""
        if motion.center is not None:
            yield "the centre", seen.velocity(self.here(motion.center)), 1
        if motion.pole is not None and self.accelerated:
            yield "the pole", seen.acceleration(self.here(motion.pole)), 2
        if motion.inflection is not None and self.accelerated:
            (x, y, _), radius = self.here(motion.inflection[0]), self.one(motion.inflection[1])
            for c, s in ((5, 0), (-3, 4)):
                place = Vector((x + c * radius / 5, y + s * radius / 5, 0))
                v = seen.velocity(place)
                if (size := _size(v)) > tolerances.COMPUTED * self.size[0]:  # not the centre of rotation itself
                    yield "the inflection circle", (v.cross(seen.acceleration(place))[2] / size,), 2
        if motion.slowest is not None:
            first, last, least = motion.slowest
            ends = [seen.velocity(self.here(place)) for _, place in motion.ends]
            yield f"the least speed between {first} and {last}", (self.one(least) - _least(*ends),), 1

    def wrong_kinds(self, motions: Sequence[BodyMotion]) -> str | None:
        """Message if a body's kind of motion at the instant, or in the long run, is wrong; ""."""
        for motion in motions:
            seen, still = self.bodies[motion.body], (0, 0, 0)
            turns, moves = (self.differs(still, x, 1, self.tolerance) for x in (seen.w, seen.velocity(Vector.ZERO)))
            slides = turns and self.differs(
                (0,), (seen.w @ seen.velocity(Vector.ZERO) / _size(seen.w),), 1, self.tolerance
            )
            word = ("helical motion" if slides else "rotation") if turns else "translation" if moves else "rest"
            if motion.now != word:
                return f"'{motion.body}' is said to be in {motion.now}, and is in {word}"
            if motion.kind is not None and (wrong := self._against_kind(motion, seen, turns=turns, moves=moves)):
                return f"'{motion.body}', {motion.kind.name}: {wrong}"
        return "" if motions else None

    def _against_kind(self, motion: BodyMotion, seen: Seen, *, turns: bool, moves: bool) -> str:
        """Message if the kind of motion does not allow what is seen; ""."""
        assert motion.kind is not None
        name, at = motion.kind.name, motion.kind.at
        still = name == "rest" or "translation" in name
        if (still and turns) or (name == "rest" and moves):
            return "it turns, or moves"
        if at is not None and name in ("rotation about a fixed axis", "rotation about a fixed point"):
            return "its fixed point moves" if self.differs((0, 0, 0), seen.velocity(self.here(at)), 1) else ""
        return ""

    # -- relative motion -------------------------------------------------------------------------------------

    def wrong_relative(self, relative: Sequence[tuple[str, str]]) -> str | None:
        for point, body in relative:
            stated = Quantities(self.state.system).parts_of_motion(point, body)
            for what, order, found in self._parts(point, body):
                if order == 2 and not self.accelerated:
                    continue
                if self.differs(self.here(getattr(stated, what)), found, order):
                    return f"{what.replace('_', ' ')} of {point} in {body}"
        return "" if relative else None

    def _parts(self, point: str, body: str) -> Iterator[tuple[str, int, Vector]]:
        """(part of a `Composition`, its order, the part by differences)."""
        system = self.state.system
        motion, carrier = system.motion, self.bodies[body]
        pose = motion.link(body).pose
        place = motion.position(motion.place(point))
        r, v, a = map(Vector, self.along(place))
        _, v_r, a_r = map(Vector, self.along(pose.R.T @ (place - pose.p)))
        v_r, a_r = carrier.R @ v_r, carrier.R @ a_r
        arm = carrier.R.T @ (r - carrier.p)
        v_t, a_t = carrier.v + carrier.R1 @ arm, carrier.a + carrier.R2 @ arm
        yield from (("velocity", 1, v), ("relative_velocity", 1, v_r), ("transport_velocity", 1, v_t))
        yield from (("acceleration", 2, a), ("relative_acceleration", 2, a_r), ("transport_acceleration", 2, a_t))
        yield "coriolis", 2, a - (a_t + a_r)
        outwards = r - carrier.p
        yield "euler", 2, carrier.e.cross(outwards)
        yield "centripetal", 2, carrier.w.cross(carrier.w.cross(outwards))

    # -- the law ---------------------------------------------------------------------------------------------

    def wrong_accelerations(self) -> str | None:
        """M a = forcing + J^T lam, J a + gamma = 0, where the motion follows from forces."""
        system, equations = self.state.system, self.state.equations
        if equations is None or not self.accelerated:
            return None
        known = with_inputs(system, self.way.now)
        free = Nearby(equations, (), known, system.symbols.q, system.symbols.u).going(known)
        for u, a in zip(system.symbols.u, system.symbols.a, strict=True):
            if self.differs((known[a],), (free.a[u],), 2, self.tolerance):
                return f"{a.name} is {float(known[a]):.10g} against {float(free.a[u]):.10g}"
        return ""


def _turning(rate: Matrix, R: Matrix) -> Vector:
    """Angular velocity by the skew part of R' R^T, and angular acceleration by that of R'' R^T."""
    A = rate @ R.T
    half = fifty_digits().number(1) / 2
    turning: Vector = Vector((A[2][1] - A[1][2], A[0][2] - A[2][0], A[1][0] - A[0][1])) * half
    return turning


def _size(v: Vector) -> Any:
    square: Any = v @ v
    return square**0.5


def _unit(v: Vector) -> Vector:
    unit: Vector = v * (1 / _size(v))
    return unit


def _least(start: Vector, end: Vector) -> Any:
    """The least size of v between two values, on the way from the one to the other."""
    step: Vector = end - start
    square: Any = step @ step
    along: Any = start @ step
    part = min(max(-along / square, 0), 1) if square else 0
    v: Vector = start + part * step
    return _size(v)


def _degrees_of_freedom_left(system: System, values: Mapping[Node, Any]) -> int:
    """Degrees of freedom: by differences of the gaps of the constraints along each speed, else by their rates."""
    symbols, scope, digits = system.symbols, system.scope, fifty_digits()
    rows = [row for row in system.constraints.rows if not row.identical]
    speeds = {u.name for u in symbols.u}
    norms = [sum((e * e for e in four), start=0) for four in scope.quaternions if f"{four[0].name}'" in speeds]
    gaps, rates = (
        [*norms, *(row.gap for row in rows if row.gap is not None)],
        [r.velocity for r in rows if r.gap is None],
    )
    still = {**values, **dict.fromkeys(symbols.u, digits.number(0))}
    drift = evaluate((*scope.rates, *rates), still, digits)
    columns = []
    for u in symbols.u:
        going = evaluate((*scope.rates, *rates), {**still, u: digits.number(1)}, digits)
        along = [x - y for x, y in zip(going, drift, strict=True)]
        step = dict(zip(symbols.q, along, strict=False))
        aside = ({**still, **{q: still[q] + h * x for q, x in step.items()}} for h in (SECOND_STEP, -SECOND_STEP))
        late, early = (evaluate(gaps, place, digits) for place in aside)
        opened = [(x - y) / (2 * SECOND_STEP) for x, y in zip(late, early, strict=True)]
        columns.append([*opened, *along[len(symbols.q) :]])
    slopes = np.array(columns, dtype=float).T
    return len(symbols.u) - rank(np.where(abs(slopes) > tolerances.DIFFERENCE_AT_50, slopes, 0.0))


# -------- second definitions ----------------------------------------------------------------------------------
# A system at a state in numbers -> values of output functions there by their second definitions.
#
# Poses and masses alone are evaluated, at the state and a moment before and after it, with 50 digits:
#
#     q +- h q' + h^2 q''/2,  t +- h;     r' = (r+ - r-)/2h,  r'' = (r+ - 2 r + r-)/h^2


UNIT = Matrix.IDENTITY


@dataclass(frozen=True)
class NearbyStates:
    """The trial of output functions: the system at a state, a moment before it and a moment after."""

    state: NumericState

    @cached_property
    def scene(self) -> Quantities:
        return Quantities(self.state.equations.system)

    @property
    def step(self) -> Any:
        return SECOND_STEP

    @cached_property
    def _way(self) -> Way:
        system, zero = self.state.equations.system, fifty_digits().number(0)
        known = {**self.state.values, **dict.fromkeys(system.symbols.a, zero), **(self._accelerations or {})}
        return way_through(system, known, SECOND_STEP, order=2)

    @cached_property
    def _accelerations(self) -> dict[Node, Any] | None:
        """None where they are not determined: first rates do not need them, second ones are nan."""
        try:
            return self.state.unknowns
        except (NoValue, DerivationError):
            return None

    def along(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """Values of functions of q and t, and their first and second time derivatives."""
        now, first, second = self._way.along(scalars)
        return now, first, second if self._accelerations is not None else [math.nan] * len(now)

    def around(self, place: Vector) -> tuple[Vector, Vector, Vector]:
        """A place a moment before, now, and a moment later."""
        now, first, second = map(Vector, self._way.along(place))
        moved, bent = SECOND_STEP * first, SECOND_STEP**2 / 2 * second
        return now + bent - moved, now, now + bent + moved

    def particles(self, body: str, *, still: bool = False) -> list[tuple[Any, Vector, Vector]]:
        """(m, r, v): with P the integral of d d^T dm about the mass centre C, at C +- e_i and C +- (e_i + e_j)

            m_i = (P_ii - sum_j P_ij)/2,     m_ij = P_ij/2,     and at C the rest of m.

        Some of these masses are negative; energy, momentum and moments of inertia are linear in them.
        """
        motion = self.state.equations.system.motion
        if not still and not is_zero(SystemInertia(motion).rotor_energy(motion.link(body))):
            raise NoValue("rotors in a joint are no particles of the body")
        mass = self.scene.mass(body)
        P = self._second_moments(body, mass.I)
        arms = [(1 * UNIT[i], (P[i][i] - sum(P[i][j] for j in range(3) if j != i)) / 2) for i in range(3)]
        arms += [(UNIT[i] + UNIT[j], P[i][j] / 2) for i, j in ((0, 1), (0, 2), (1, 2))]
        ends = [(end, m) for arm, m in arms if m for end in (arm, Vector.ZERO - arm)]
        (whole,) = self.along((mass.m,))[0]
        held = [(Vector.ZERO, whole - sum(m for _, m in ends)), *ends]
        origin, R = self.scene.origin(body), self.scene.axes(body)
        places = [origin + R @ (mass.com + arm) for arm, _ in held]
        now, rates, _ = self.along([x for place in places for x in place])
        return [(m, Vector(now[3 * k : 3 * k + 3]), Vector(rates[3 * k : 3 * k + 3])) for k, (_, m) in enumerate(held)]

    def _second_moments(self, body: str, I: Matrix) -> list[list[Any]]:
        """P = tr(I)/2 - I in body axes; a body of which the moment about z alone is known is thin."""
        flat = self.along([x for row in I for x in row])[0]
        if self.scene.known_about_z((body,)):
            return [[flat[8] / 2 if i == j < 2 else 0 * flat[8] for j in range(3)] for i in range(3)]
        half = (flat[0] + flat[4] + flat[8]) / 2
        return [[(half if i == j else 0) - flat[3 * i + j] for j in range(3)] for i in range(3)]

    def given_energy(self) -> Any:
        """The expressions of the file, coordinates' rates as differences say."""
        scope = self.state.equations.system.scope
        q = scope.symbols.q
        names = {f"{x.name}'": scope.graph.symbol(f"(difference of {x.name})") for x in q}
        known = {**self._way.now, **dict(zip(names.values(), self.along(q)[1], strict=True))}
        stated = [force.kinetic for force in scope.model.forces.values() if force.kinetic is not None]
        given = [formula.evaluate({**scope.names, **names}) for formula in stated]
        proof = Declared(self.state.equations.system, known)
        others = (force.acts(proof) for force in scope.model.forces.values() if force.moving and not force.kinetic)
        given += [act.kinetic for acts in others for act in acts if act.kinetic is not None]
        return sum(evaluate(given, known, fifty_digits()), start=0 * SECOND_STEP)

    def worked(self, body: str | None = None) -> Any:
        """Power: F . v + tau . w of every body, and s' times the effort of every joint."""
        system = self.state.equations.system
        loads, known = system.loads, dict(self._way.now)
        if any(force.is_along_coordinate for force in loads.applied):
            raise NoValue("something acts at no place")
        placed = [load for force in loads.applied for load in force.loads]
        if system.motion.moves(tuple(x for load in placed if isinstance(load, PointForce) for x in load.place[1])):
            raise NoValue("a force acts at a place that slides in its body")
        energies = tuple(f.potential for f in loads.applied if f.placeless and f.potential is not None and body is None)
        if system.symbols.t in symbols_of(energies):
            raise NoValue("a potential depends on time")
        total = 0 * SECOND_STEP - sum(self.along(energies)[1])
        pushes = pushes_of(system.motion, known, (*placed, *loads.weights))
        if body is not None:
            self._add_efforts(pushes)
        for name, (moment, force) in pushes.items():
            if body in (None, name):
                rates = Vector(self.along(self.scene.origin(name))[1])
                flat = self.along([x for row in self.scene.axes(name) for x in row])
                W = _rows(flat[1]) @ _rows(flat[0]).T
                w = Vector((W[2][1], W[0][2], W[1][0]))
                arm = Vector(self.along(self.scene.origin(name))[0])
                total = total + force @ rates + (moment - arm.cross(force)) @ w
        for effort in loads.efforts if body is None else ():
            link = system.motion.link(effort.body)
            (push,) = evaluate((effort.effort,), known, fifty_digits())
            total = total + push * self.along((link.s[effort.variable],))[1][0]
        return total

    def _add_efforts(self, pushes: Pushes) -> None:
        """A couple about the axis, or a force along it at the joint, on the child; the opposite on the parent."""
        system = self.state.equations.system
        for effort in system.loads.efforts:
            link = system.motion.link(effort.body)
            turn, slide = link.S[effort.variable]
            if not (all(map(is_zero, turn)) or all(map(is_zero, slide))):
                raise NoValue("a joint that turns and slides at once")
            along = link.pose.R @ (slide if all(map(is_zero, turn)) else turn)
            flat = self.along((effort.effort, *along, *link.pose.point(link.point)))[0]
            push, place = flat[0] * Vector(flat[1:4]), Vector(flat[4:7])
            parent = None if link.parent < 0 else system.motion.links[link.parent].name
            for name, sign in ((effort.body, 1), (parent, -1)):
                own: Vector = sign * push
                add_push(pushes, name, *((own, Vector.ZERO) if all(map(is_zero, slide)) else (place.cross(own), own)))

    def acting(self, force: str) -> Any:
        """Force of an element between two points, or moment between two bodies, by its declaration."""
        return acting(self.state.equations.system, self.state.values, force)

    def demanded(self, coordinate: str) -> Any:
        """M a + c - Q - J^T lam of the freed coordinate, by the free bodies, at the motion as it is given."""
        return drive_demanded(self.state.equations.system, coordinate, self.state.values | self.state.unknowns)[0]

    def held(self, constraint: str) -> Any:
        """lam of a constraint of one row, by the free bodies, on which all constraints act."""
        equations, known = self.state.equations, self.state.values | self.state.unknowns
        friction = evaluate(equations.friction or (), known, fifty_digits())
        found = multipliers_demanded(equations.system, known, friction)
        if (constraint, 1) not in found:
            raise NoValue("it shares its force with other constraints")
        return found[constraint, 1]

    def struck(self, owner: str, axis: int | None = None) -> Any:
        """Impulse by M and J of differences: T of the bodies' particles and rates of gaps, at speeds one larger."""
        return struck(self, self.state.equations.system, owner, axis)

    def root(self, x: Any) -> Any:
        """Square root."""
        return fifty_digits().functions["sqrt"](x)

    def eigenvalues(self, rows: Sequence[Sequence[Any]]) -> list[Any]:
        """Eigenvalues of a symmetric matrix, ascending."""
        return list(eigenpairs_in_digits(rows, Matrix.IDENTITY)[0])

    def faster(self, speed: str, by: float) -> NearbyStates:
        """The same with one speed larger.

        Raises:
            NoValue: it is no speed of the system.
        """
        found = [u for u in self.state.equations.symbols.u if u.name == speed]
        if not found:
            raise NoValue(f"'{speed}' is no speed of these equations")
        numbers = {**self.state.numbers, found[0]: self.state.numbers[found[0]] + by}
        return NearbyStates(replace(self.state, numbers=numbers))


def _rows(flat: Sequence[Any]) -> Matrix:
    return Matrix.of((flat[0:3], flat[3:6], flat[6:9]))


def second_definition(state: NumericState, call: Call) -> str:
    """Message if the value of a function of the motion differs from that of its second definition; "".

    Raises:
        NoValue: it has no value by one of the two.
        DerivationError: it has no meaning there.
    """
    second = FUNCTIONS[call.name].second
    assert second is not None, "only for functions that have one"
    if any(abs(x) > tolerances.LARGEST_AT_50 for x in state.numbers.values()):
        raise NoValue("coordinates or speeds too large for differences")
    found = state.number(Quantities(state.equations.system).value(call))
    right = float(second(NearbyStates(state), call))
    if math.isnan(right):
        raise NoValue("accelerations are not determined there")
    return differing(found, right)
