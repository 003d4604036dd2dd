"""Motion -> Constraints: the rows of the constraints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

from eomgen.errors import DerivationError, ModelError, NotYet
from eomgen.frozen import RECALLED, dataclass
from eomgen.mechanics.kinematics import (
    GROUND,
    ContactMode,
    ContactModes,
    Motion,
    SystemScene,
)
from eomgen.model import ConstraintRow, Contact, Couple, JointFriction, PointForce, Push
from eomgen.symbolic.exact import Equality, equal_at_random_states, equal_at_real_states, equal_in_field, readable
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    Wrench,
    depends_on,
    is_zero,
    jacobian,
    operations,
    over,
    sqrt,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import PRIME_FIELD, Work, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import text_size, to_text

# -------- constraints ------------------------------------------------------------------------------------------------
# Motion -> Constraints: the rows of the constraints.
#
# A row holds a wrench on each body that it touches; the motion that it forbids is the dual:
#
#     W^T xi + s_t = 0,   J = W^T B,   sigma = W^T beta + s_t,   J u + sigma = 0,   J a + gamma = 0
#
# A row without bodies (`equation`) gives dphi/dq, or its row in the rates, directly.


Wrenches = tuple[tuple[str, Wrench], ...]
LONG = 60  # characters of a gap that is not printed


@dataclass(frozen=True)
class Row:
    """One scalar row of a constraint.

    Args:
        constraint, number: its name and place in the constraint, from 1.
        wrenches: (body, W) for a unit lam, body axes, at the body's origin; empty for an equation. Seen from a body
            that carries all that is held, that body takes what makes their sum 0, which it is where the constraint
            holds.
        direct: s_t, the part that no twist sees: the slide of points in their bodies; of an equation all of it.
        velocity: W^T xi + s_t as a function of q, u, t: zero when the constraint holds.
        gap: phi(q, t), or None where only the velocity row is given.
        status: "identical": the coordinates satisfy the row by themselves; "eliminated": it determines a dependent
            coordinate; both only carry a reaction. "closing": it restricts the speeds, by a multiplier.
        component: "x", "y", "z", "n", "t", "couple", "tension", "friction" (of a joint), or "".
        pushes: the forces and couples behind `wrenches`, as the constraint gave them.
        tangent: of a contact that has friction, the forces and couples for a unit of friction along it.
        sliding: the sliding velocity dual to it [m/s]; on a surface, with Coulomb's friction, its magnitude.
        friction: None, or the friction of a unit of lam along `tangent`, for instance -mu sign(v).
        eliminates: the dependent coordinate that an "eliminated" row determines, or "".
        part: what of the constraint it belongs to, by name: the member of a truss; "" elsewhere.
        cross_tangent, across: of a contact on a surface the second direction in which it can slide, and that velocity.
        shares: of `friction` along both, v/|v| of Coulomb's, v of viscous friction; () where there is one direction.
        round: of a bilateral contact on a line: its friction is for a unit of |N|, of which this row's
            multiplier is one component and those of the rows before are the others.
        carrier: the body in whose axes the row is written, which carries all that it holds; None: the ground.
    """

    STILL = Fraction(1, 10**8)  # a sliding velocity that is none [m/s]

    constraint: str
    number: int
    wrenches: tuple[tuple[str, Wrench], ...]
    direct: Scalar
    velocity: Scalar
    gap: Scalar | None
    status: str
    component: str = ""
    pushes: tuple[Push, ...] = ()
    tangent: tuple[Push, ...] = ()
    sliding: Scalar = 0
    friction: Scalar | None = None
    eliminates: str = ""
    part: str = ""
    cross_tangent: tuple[Push, ...] = ()
    across: Scalar | None = None
    shares: tuple[Scalar, ...] = ()
    round: bool = False
    carrier: str | None = None

    @property
    def identical(self) -> bool:
        return self.status == "identical"

    @property
    def label(self) -> str:
        return f"lam({self.constraint}, {self.number})"

    @staticmethod
    def of_constraint(motion: Motion, name: str) -> tuple[Row, ...]:
        """The rows that a constraint has while it is closed, even if it is open: how far it is."""
        constraint = motion.scope.model.constraints[name]
        rows = constraint.rows(SystemScene(motion, f"constraints.{name}"))
        return tuple(_row(motion, name, number, row, used=False) for number, row in enumerate(rows, start=1))


@dataclass(frozen=True)
class Constraints:
    """All rows of all constraints, and the matrices of those that close."""

    motion: Motion
    rows: tuple[Row, ...]

    def __getstate__(self) -> dict[str, Any]:
        """State to be pickled, without the cached results."""
        return {name: value for name, value in self.__dict__.items() if name != RECALLED}

    @property
    def closing(self) -> tuple[Row, ...]:
        return tuple(row for row in self.rows if row.status == "closing")

    @cached_property
    def J(self) -> tuple[tuple[Scalar, ...], ...]:
        """J u + sigma = 0: one row for each constraint row."""
        velocities = tuple(row.velocity for row in self.closing)
        return jacobian(velocities, self.motion.scope.symbols.u) if velocities else ()

    @cached_property
    def sigma(self) -> tuple[Scalar, ...]:
        still = {u: 0 for u in self.motion.scope.symbols.u}
        return substituted(tuple(row.velocity for row in self.closing), still)

    @property
    def gamma(self) -> tuple[Scalar, ...]:
        """J a + gamma = 0: the total derivative of the velocity row at a = 0."""
        return self.motion.scope.time_derivative(tuple(row.velocity for row in self.closing))

    @property
    def phi(self) -> tuple[Scalar | None, ...]:
        return tuple(row.gap for row in self.closing)

    @property
    def movable(self) -> list[Node]:
        """The coordinates that are not driven."""
        scope = self.motion.scope
        return [q for q in scope.symbols.q if not scope.model.coordinates[q.name].driven]

    @property
    def gaps(self) -> tuple[Scalar, ...]:
        """phi of every row that the coordinates do not satisfy by themselves, where it has one."""
        return tuple(row.gap for row in self.rows if row.gap is not None and not row.identical)

    @property
    def norms(self) -> tuple[Scalar, ...]:
        """e . e - 1 of every quaternion."""
        return tuple(sum((e * e for e in four), start=-1) for four in self.motion.scope.quaternions)

    @property
    def fixed_by_position(self) -> list[Node]:
        """The dependent coordinates that stand in a gap."""
        scope, standing = self.motion.scope, set(symbols_of(self.gaps))
        names = scope.dependent
        return [q for q in scope.symbols.q if q.name in names and q in standing]

    @staticmethod
    def of(
        motion: Motion, used: Mapping[tuple[str, int], str] | None = None, modes: ContactModes | None = None
    ) -> Constraints:
        """The rows of every constraint of the model.

        Args:
            used: {(constraint, number): coordinate} of the rows through which dependent coordinates were eliminated.
            modes: how contacts are that can end, slide or stick.
        Raises:
            NotYet: a kind whose rows this version does not build.
        """
        for where, what in motion.scope.model.unbuilt_constraints:
            raise NotYet(
                f"the rows of '{what}' are not built yet",
                where,
                fix="declare it by constraints that are: see eomgen schema",
            )
        rows = []
        for name, constraint in motion.scope.model.constraints.items():
            scene = SystemScene(motion, f"{constraint.table}.{name}")
            mode = (modes or {}).get(name, ContactMode())
            for number, constraint_row in enumerate(mode.rows_of(constraint, constraint.rows(scene)), start=1):
                label = (name, number)
                row = _row(motion, name, number, constraint_row, used=label in (used or {}))
                row = replace(row, eliminates=(used or {}).get(label, ""))
                rows.append(_with_friction(scene, constraint, row, mode))
        rough = [c for c in motion.scope.model.rough_contacts if c.of_joint or c.of_force]
        held = [c for c in rough if c.name in (modes or {})]
        stuck = [contact for contact in held if (modes or {})[contact.name].sense == 0]
        rows += [_row(motion, contact.name, 1, _held_in_joint(motion, contact), used=False) for contact in stuck]
        return Constraints(motion, tuple(rows))


def _held_in_joint(motion: Motion, contact: Contact) -> ConstraintRow:
    """The row of what sticks on a path, in a joint, in a force of dry friction: no velocity along it."""
    if contact.of_force:
        pushes = motion.scope.model.forces[contact.name].pushes(SystemScene(motion, f"forces.{contact.name}"))
        return ConstraintRow(pushes, None, component="friction", material=True)
    link = motion.link(contact.body)
    force, couple = (link.pose.R @ x for x in ContactMode.rubbed_along(motion, link, contact.variable))
    places = (
        (link.name, link.point),
        (None if link.parent == GROUND else motion.links[link.parent].name, link.local.p),
    )
    pushes, on_both = (), tuple(zip(places, (1, -1), strict=True))
    if any(not is_zero(x) for x in force):
        pushes = tuple(PointForce(place, sign * force) for place, sign in on_both)
    if any(not is_zero(x) for x in couple):
        pushes += tuple(Couple(at[0], sign * couple, place=at) for at, sign in on_both if at[0] is not None)
    label = "friction" if isinstance(contact.friction, JointFriction) else "t"
    return ConstraintRow(pushes, None, component=label, material=True)


def _dragged(name: str) -> DerivationError:
    """Error: a contact that was to stick is made to slide by a drive."""
    what = f"'{name}' cannot stick: a drive makes it slide, and no free coordinate moves it"
    fix = "at rest its friction and the drive share one force: leave the friction out, or use `solve`, where it slides"
    return DerivationError(what, f"constraints.{name}", fix)


def _row(motion: Motion, name: str, number: int, row: ConstraintRow, *, used: bool) -> Row:
    seen, pushes = (motion, row.pushes) if row.carrier is None else (motion.seen_from(row.carrier), row.carried)
    wrenches = _wrenches(seen, pushes)
    if row.pushes:
        direct = 0 if row.material else _slide(seen, pushes)
        direct = direct if row.rate is None else direct + row.rate
    elif row.rate is not None:
        direct = _linear(motion, name, row.rate)
    else:
        assert row.gap is not None, "a row without pushes and rate is the rate of its gap"
        direct = motion.scope.time_derivative((row.gap,))[0]
    velocity = _power(seen, wrenches, direct)
    if row.carrier is not None:
        wrenches = _in_balance(seen, row.carrier, wrenches)
    if row.pushes and row.rate is not None:
        _linear(motion, name, velocity)
    if row.pushes and motion.scope.model.space == "space":
        velocity = shorter_row(velocity)
    sliding = _dual(motion, row, row.tangent) if row.tangent else 0
    across = _dual(motion, row, row.cross_tangent) if row.cross_tangent else None
    status = "eliminated" if used else _status(motion, velocity, row.gap)
    if status == "closing" and not depends_on(velocity, motion.scope.symbols.u):
        if row.gap is None and row.rate is None:
            raise _dragged(name)
        what = "no free coordinate moves it"
        fix = "put its points where they meet, or give the bodies more degrees of freedom"
        off = "" if row.gap is None or text_size(row.gap) > LONG else f" (it is {to_text(row.gap)} off)"
        raise DerivationError(f"row {number} of '{name}' cannot hold: {what}{off}", f"constraints.{name}", fix)
    return Row(
        name,
        number,
        wrenches,
        direct,
        velocity,
        row.gap,
        status,
        row.component,
        row.pushes,
        row.tangent,
        sliding,
        part=row.part,
        across=across,
        cross_tangent=row.cross_tangent,
        round=row.round,
        carrier=row.carrier,
    )


def _dual(motion: Motion, row: ConstraintRow, pushes: tuple[Push, ...]) -> Scalar:
    """The velocity that is dual to pushes of a row."""
    return motion.power(pushes, material=row.material)


def _with_friction(scene: SystemScene, constraint: Any, row: Row, mode: ContactMode) -> Row:
    """The row with its friction, where it has any."""
    law = getattr(constraint, "friction", None)
    if law is None or not row.tangent:
        return row
    if row.across is not None:
        if law.coulomb is not None and mode.sense == 0:
            return row
        row = _on_surface(row, viscous=law.coulomb is None, still=mode.sense is not None)
        return replace(row, friction=-mode.push * scene.value(law.viscous if law.coulomb is None else law.coulomb))
    return replace(row, friction=mode.friction_factor(law, scene.value, row.sliding))


def _on_surface(row: Row, *, viscous: bool, still: bool) -> Row:
    """A contact on a surface that slides with v = (v_1, v_2) along its tangents, its friction along v / |v|.

    Of viscous friction, which is along v itself, the unit is v, and v . v / 2 has the derivatives dual to it. In a
    phase that may begin at rest, where v has no direction, |v| is sqrt(v . v + STILL^2).
    """
    assert row.across is not None, "asked of a contact on a surface"
    pair = (row.sliding, row.across)
    square = pair[0] * pair[0] + pair[1] * pair[1]
    speed = sqrt(square + Row.STILL * Row.STILL if still else square)
    shares = pair if viscous else tuple(over(v, speed) for v in pair)
    return replace(row, shares=shares, sliding=Fraction(1, 2) * square if viscous else speed)


def _status(motion: Motion, velocity: Scalar, gap: Scalar | None) -> str:
    holds = _holds(motion, velocity) and (gap is None or _holds(motion, gap) or _is_met(motion, gap))
    return "identical" if holds else "closing"


def _holds(motion: Motion, scalar: Scalar) -> bool:
    """True if the scalar is zero in every motion; of roots and absolute values, on the branch of the start.

    L - |L - x| - x is zero wherever x < L, as at the start, and not for all x and L.
    """
    if type(scalar) is int:
        return scalar == 0
    verdict = equal_at_random_states([(scalar, 0)])
    if verdict.equal or verdict.arithmetic == PRIME_FIELD.name:
        return verdict.equal
    here = equal_at_real_states([(scalar, 0)], states=0, given=[[state] for state in _around_start(motion)])
    return here.equal and here.states > 0


def _around_start(motion: Motion) -> Iterator[dict[Node, Any]]:
    """States near the start, at parameters near the model's; none where a value is missing."""
    scope, rng, digits = motion.scope, Random(5), fifty_digits()
    known = scope.model.exact_parameters()
    symbols = scope.symbols
    if known.keys() < symbols.parameters.keys():
        return
    for _ in range(3):
        state = {p: digits.number(Fraction(known[name]) * (1 + _aside(rng))) for name, p in symbols.parameters.items()}
        starts = tuple(scope.start_values().values())
        state |= {
            q: x + digits.number(_aside(rng)) for q, x in zip(symbols.q, evaluate(starts, state, digits), strict=True)
        }
        state |= {x: digits.number(_aside(rng)) for x in (*symbols.u, *symbols.a, *symbols.inputs.values(), symbols.t)}
        yield state | dict(zip(scope.laws, evaluate(tuple(scope.laws.values()), state, digits), strict=True))


def _aside(rng: Random) -> Fraction:
    return Fraction(rng.randint(-1000, 1000), 100_000)


def _is_met(motion: Motion, gap: Scalar) -> bool:
    """True if the gap of bodies that all stand still vanishes at the model's own values: 0.2 and r with r = 0.2."""
    value = None if motion.scope.symbols.u else SystemScene(motion).value_at_start(gap)
    return value is not None and abs(value) < tolerances.SOLVED


def _wrenches(motion: Motion, pushes: tuple[Push, ...]) -> tuple[tuple[str, Wrench], ...]:
    return tuple(found for push in pushes if (found := motion.body_wrench(push)) is not None)


def _in_balance(seen: Motion, carrier: str, wrenches: Wrenches) -> Wrenches:
    """The wrenches, with that on the carrier which makes their sum 0: no work as they move with it."""
    found = [(body, W) for body, W in wrenches if body != carrier]
    total = Wrench()
    for body, W in found:
        pose = seen.link(body).pose
        total = total.plus(W.turned(pose.R).moved(pose.p))
    return (*found, (carrier, Wrench(-total.tau, -total.f)))


def _power(motion: Motion, wrenches: tuple[tuple[str, Wrench], ...], direct: Scalar) -> Scalar:
    return sum((motion.link(b).twist.power(W) for b, W in wrenches), start=direct)


def _slide(motion: Motion, pushes: tuple[Push, ...]) -> Scalar:
    """Power that pushes have from points that move in their bodies."""
    return sum((motion.slide_power(push) for push in pushes if isinstance(push, PointForce)), start=0)


def _linear(motion: Motion, name: str, rate: Scalar) -> Scalar:
    """The row of an equation in the rates, which must be linear in them: J u + sigma = 0."""
    speeds = motion.scope.symbols.u
    if speeds and any(depends_on(entry, speeds) for row in jacobian((rate,), speeds) for entry in row):
        raise ModelError(
            f"the rate of '{name}' is not linear in the rates",
            f"constraints.{name}.rate",
            "write it as a sum of rates, each times a function of the coordinates",
        )
    return rate


def holds_identically(scalar: Scalar) -> bool:
    """True if the scalar is zero at all values of its symbols (exactly, at random states)."""
    return hold_identically((scalar,))[0]


def hold_identically(scalars: Sequence[Scalar]) -> list[bool]:
    """True for each scalar that is zero at all values of its symbols; shared parts are evaluated once."""
    groups = [[(x, 0)] for x in scalars if type(x) is Node]
    verdicts = iter(equal_in_field(groups) if groups else ())
    return [_settled(x, next(verdicts)) if type(x) is Node else is_zero(x) for x in scalars]


def _settled(x: Scalar, verdict: Equality | None) -> bool:
    return (equal_at_real_states([(x, 0)]) if verdict is None else verdict).equal


# -------- edges -----------------------------------------------------------------------------------------------
# Motion -> Edges: the limits of a constraint, at which it no longer determines where it acts (a wheel that lies flat).
#
# Beyond its limits a constraint continues as it was although its physical meaning ends: a run that passes them reports
# it.


MOST_SYMBOLS = 18  # in a velocity row that is multiplied out
LONGEST_ROW = 2000  # characters of a velocity row that is multiplied out


def shorter_row(x: Scalar) -> Scalar:
    """A velocity multiplied out, where that halves its operations: cos^2 + sin^2 of a spin that no contact sees."""
    if type(x) is not Node or text_size(x) > LONGEST_ROW or len(symbols_of((x,))) > MOST_SYMBOLS:
        return x
    short = readable(x, Work.ENTRY)
    return short if 2 * operations((short,)).total <= operations((x,)).total else x
