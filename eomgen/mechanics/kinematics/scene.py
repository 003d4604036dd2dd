"""Motion -> SystemScene: quantities of a system for force laws and constraints, in a given mode of its contacts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from itertools import pairwise
from typing import Any

from eomgen.errors import DerivationError, ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.motion import GROUND, BodyLink, Motion
from eomgen.mechanics.kinematics.symbols import Scope, parameters_of_zero, primitive
from eomgen.model import (
    BodyPoint,
    ConstraintRow,
    Contact,
    JointFriction,
    Resistance,
    Stop,
    Strand,
)
from eomgen.symbolic.exact import equal_at_random_states, readable_all
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Matrix,
    Node,
    Scalar,
    Vector,
    depends_on,
    function,
    gradient,
    is_zero,
    over,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, Work, evaluate

# -------- pushes along joints ---------------------------------------------------------------------------------


# -------- system scene ----------------------------------------------------------------------------------------
# Motion -> SystemScene: what force laws and constraints ask of a system; where coordinates start.


@dataclass(frozen=True)
class SystemScene:
    """Quantities of a system in motion from which force laws and constraints are built.

    Args:
        where: the part that uses them, for messages.
        begun: start values of the coordinates whose start is not the declared one.
    """

    motion: Motion
    where: str = ""
    begun: Mapping[Node, Scalar] = field(default_factory=dict)

    @staticmethod
    def motion_of(scope: Scope) -> Motion:
        """Poses and twists of all bodies, and the rates of the states that forces bring along, which follow from them.

        Raises:
            DerivationError: a joint whose place depends on an input.
            NotYet: a joint kind that this version does not derive.
        """
        motion, rates = Motion.of(scope), dict[str, Scalar]()
        for name, force in scope.model.forces.items():
            if force.own_states:
                found = force.state_rates(SystemScene(motion, f"forces.{name}"))
                rates |= {f"{name}_{own.name}'": rate for own, rate in zip(force.own_states, found, strict=True)}
        return Motion(scope.with_states_named(rates), motion.links) if rates else motion

    def value(self, expression: Expression) -> Scalar:
        return self.motion.scope.value(expression)

    def value_at(self, expression: Expression, also: dict[str, Scalar]) -> Scalar:
        """An expression in which further names stand for given scalars (they win over the model's)."""
        return expression.evaluate({**self.motion.scope.names, **also})

    def primitive(self, expression: Expression, name: str, at: Scalar) -> Scalar | None:
        """The integral of an expression over one name, at a value of it.

        None where it holds anything but that name and parameters, or has no closed form.
        """
        scope = self.motion.scope
        if any(other != name and other not in (*scope.symbols.parameters, "pi") for other in expression.names):
            return None
        variable = scope.graph.symbol(f"({name})")  # no name of a model has parentheses
        F = primitive(self.value_at(expression, {name: variable}), variable, parameters_of_zero(scope.model))
        return None if F is None else substituted((F,), {variable: at})[0]

    def vector(self, expressions: tuple[Expression, ...] | None) -> Vector:
        return self.motion.scope.vector(expressions)

    def ground_place(self, at: Sequence[Expression] | str) -> Vector:
        return self.motion.scope.ground_place(at)

    @property
    def plane(self) -> bool:
        return self.motion.scope.model.space == "plane"

    def place(self, point: str) -> BodyPoint:
        body, r = self.motion.place(point)
        return (body, r)

    def position(self, place: BodyPoint) -> Vector:
        return self.motion.position(place)

    def velocity(self, place: BodyPoint) -> Vector:
        """d/dt of the position [m/s]."""
        return self.motion.scope.rate_of(self.position(place))

    def orientation(self, body: str) -> Matrix:
        """R of the body in the ground."""
        return self.motion.link(body).pose.R

    def carrier_of(self, first: str | None, second: str | None) -> str | None:
        """The nearest body that carries both, itself among those that carry it; None: only the ground does."""
        return self.motion.carrier_of(first, second)

    def seen_from(self, body: str | None) -> SystemScene:
        """The scene seen from a body that carries the part: its axes stand for the ground's."""
        return self if body is None else SystemScene(self.motion.seen_from(body), self.where, self.begun)

    def angle(self, body: str) -> Scalar:
        angle = self.motion.link(body).angle
        if angle is None:
            raise DerivationError(
                f"body '{body}' has no single angle in space",
                f"bodies.{body}",
                "put the spring or damper into the joint",
            )
        return angle

    def spin(self, body: str) -> Vector:
        """Angular velocity of the body, in its axes, by the rates of its axes [rad/s]."""
        return self.motion.spin(self.motion.link(body))

    def angle_rate(self, body: str) -> Scalar:
        return self.motion.scope.time_derivative((self.angle(body),))[0]

    def slopes(self, law: Expression, values: Mapping[Call, Scalar | None]) -> tuple[Scalar, tuple[Scalar, ...]]:
        """(value, derivatives by the functions of the motion in it) of a law; None: it is linear in that, taken as 0.

        Raises:
            ModelError: it is not linear there.
        """
        value, symbols = self._open(law, values)
        slopes = gradient(value, tuple(symbols.values()))
        linear = [k for k, at in enumerate(values.values()) if at is None]
        if any(depends_on(slopes[k], [tuple(symbols.values())[j]]) for k in linear for j in linear):
            raise ModelError(
                f"'{law.text}' is not linear in the velocities",
                self.where,
                "write it as a sum of velocities, each times a function of the configuration",
            )
        at = {symbol: 0 if (x := values[call]) is None else x for call, symbol in symbols.items()}
        found = substituted((value, *slopes), at)
        return found[0], found[1:]

    def held_rate(self, law: Expression, values: Mapping[Call, Scalar]) -> Scalar:
        """d/dt of a law while the functions of the motion in it stay as they are."""
        value, symbols = self._open(law, values)
        rate = self.motion.scope.time_derivative((value,))
        return substituted(rate, {symbol: values[call] for call, symbol in symbols.items()})[0]

    def _open(self, law: Expression, calls: Iterable[Call]) -> tuple[Scalar, dict[Call, Node]]:
        """A law over symbols for the functions in it."""
        scope = self.motion.scope
        symbols = {call: scope.graph.symbol(f"({call})") for call in calls}
        return law.evaluate(scope.names, symbols.__getitem__), symbols

    def turn_of_joint(self, body: str) -> tuple[Scalar, Vector, str | None]:
        """(angle, unit axis in the body's axes, parent) of the joint that turns a body about one axis."""
        link = self.motion.link(body)
        turning = [(s, w) for s, (w, _) in zip(link.s, link.S, strict=False) if not all(map(is_zero, w))]
        if len(turning) != 1:
            raise DerivationError(
                f"the joint of body '{body}' has no single angle",
                self.where,
                "hang it on a revolute, cylindrical or screw joint",
            )
        parent = None if link.parent == GROUND else self.motion.links[link.parent].name
        return *turning[0], parent

    def along_joint(self, body: str, variable: int) -> tuple[Scalar, Vector, Vector, BodyPoint, BodyPoint, Vector]:
        """(s, force and couple of the unit push along it on the body, where on it, a place of its parent, the arm
        from there), of a variable of the body's joint, ground axes."""
        link = self.motion.link(body)
        force, couple = link.pushed_along(variable, 1)
        R, (seat, slid) = link.pose.R, (link.before.p, link.local.p)
        name, R_parent = None, Matrix.IDENTITY
        if link.parent != GROUND:
            parent = self.motion.links[link.parent]
            name, R_parent = parent.name, parent.pose.R
        arm = R_parent @ (slid - seat)
        return link.s[variable], R @ force, R @ couple, (body, link.point), (name, seat), arm

    def slip(self, contact: Contact) -> Scalar:
        """Rate along which a joint or a force rubs: s' of a joint's variable, of a force the power of its unit."""
        if contact.of_force:
            return self.motion.power(self.motion.scope.model.forces[contact.name].pushes(self))
        return self.motion.link(contact.body).s_rate[contact.variable]

    def masses(self, bodies: tuple[str, ...] | None) -> tuple[tuple[BodyPoint, Scalar], ...]:
        """(mass centre, mass) of the named bodies, or of all, that have mass."""
        names = [link.name for link in self.motion.links] if bodies is None else bodies
        rows = []
        for name in names:
            body = self.motion.scope.mass_properties(name)
            if not is_zero(body.m):
                rows.append(((name, body.com), body.m))
        return tuple(rows)

    def rate(self, scalar: Scalar) -> Scalar:
        """d/dt of a function of the places and t."""
        return self.motion.scope.time_derivative((scalar,))[0]

    def strands(self, path: tuple[Any, ...]) -> tuple[Strand, ...]:
        """The straight pieces from stop to stop of a path over points and wraps."""
        return tuple(Strand.between(self, *pair) for pair in pairwise([Stop.of(self, item) for item in path]))

    def unsaid_rate(self, body: str) -> Scalar:
        """Rate of a body's mass less what the flows with a rate of their own bring [kg/s]."""
        return self.motion.scope.unsaid_rate(body)

    def start(self, scalar: Scalar) -> Scalar:
        """The scalar where the coordinates start and t = 0."""
        scope = self.motion.scope
        at = {**scope.with_unit_quaternions(scope.start_values()), **self.begun}
        return substituted((scalar,), {**at, scope.symbols.t: 0})[0]

    def own_place(self, body: str, point: str | None) -> BodyPoint:
        """A body's own point; None: its origin."""
        return (body, self.motion.points[body][(point or "origin").rpartition(".")[2]])

    def line(self, body: str) -> tuple[BodyPoint, BodyPoint]:
        """The two points of a body's line."""
        line = self.motion.scope.model.bodies[body].line
        assert line is not None, "checked when the model was read"
        return self.own_place(body, line[0]), self.own_place(body, line[1])

    def radius(self, body: str) -> Scalar:
        """Radius of the body's round shape [m]."""
        shape: Any = self.motion.scope.model.bodies[body].shape
        return self.value(shape.radius)

    def shape(self, body: str) -> Any:
        """The body's shape, as the model declares it; None where it has none."""
        return self.motion.scope.model.bodies[body].shape

    def moves(self, scalars: tuple[Scalar, ...]) -> bool:
        return self.motion.moves(scalars)

    def vanishes(self, scalar: Scalar) -> bool:
        """True if the scalar is zero whatever the values of its symbols."""
        return scalar == 0 if type(scalar) is not Node else equal_at_random_states([(scalar, 0)]).equal

    def readable(self, scalars: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
        """The scalars multiplied out, roots of squares of positive parameters taken."""
        return readable_all(scalars, Work.ENTRY, self.motion.scope.positive)

    def value_at_start(self, scalar: Scalar) -> float | None:
        """The value of the scalar at the start, with the model's values; None where some are missing."""
        scope = self.motion.scope
        if type(scalar) is Node:
            self.motion.decided[scalar] = None
        known = scope.model.exact_parameters()
        values = {node: known[name] for name, node in scope.symbols.parameters.items() if name in known}
        at_start = self.start(scalar)
        if not set(symbols_of((at_start,))) <= values.keys():
            return None
        return float(evaluate((at_start,), {node: float(x) for node, x in values.items()}, FLOAT)[0])


# -------- contact modes ---------------------------------------------------------------------------------------
# Contacts: constraints and paths that can end, slide or stick. A mode says how each of them is in one phase of the
# motion.
#
# Coulomb:  friction = -mu |N| sign(v) along the contact, N the contact's own reaction, v its sliding velocity;
# viscous:  -c |N| v.  While a contact sticks, its sliding velocity is held at 0 by a row of its own.


@dataclass(frozen=True)
class ContactMode:
    """State of one contact.

    Args:
        closed: False: the contact is open, the string slack.
        sense: of the sliding, +1 or -1 along the contact's tangent; 0: it sticks; None: the law, with sign(v) in it.
        push: the sign of N, for contacts that hold both ways.
    """

    closed: bool = True
    sense: int | None = None
    push: int = 1

    def rows_of(self, constraint: Any, rows: tuple[ConstraintRow, ...]) -> tuple[ConstraintRow, ...]:
        """The rows that a constraint has: none while it is open, one more while it sticks (on a surface two)."""
        if not self.closed:
            return ()
        law = getattr(constraint, "friction", None)
        if law is None or self.sense != 0 or law.coulomb is None:
            return rows
        with_friction = [row for row in rows if row.tangent]
        pairs = (
            (name, row, push) for row in with_friction for name, push in (("t", row.tangent), ("s", row.cross_tangent))
        )
        held = (ConstraintRow(push, None, component=name, material=row.material) for name, row, push in pairs if push)
        return (*rows, *held)

    def friction_factor(self, law: Resistance | None, value: Callable[[Any], Scalar], sliding: Scalar) -> Scalar | None:
        """The friction of a unit of N along the tangent; None without friction, or while it sticks."""
        if law is None:
            return None
        if law.coulomb is None:
            return -self.push * value(law.viscous) * sliding
        if self.sense == 0:
            return None
        sense = function("sign", sliding) if self.sense is None else self.sense
        return -self.push * value(law.coulomb) * sense

    @staticmethod
    def rubbed_along(motion: Motion, link: BodyLink, variable: int) -> tuple[Vector, Vector]:
        """(force, couple) of the friction along a joint's variable that does the work s', child's axes.

        Of a thread it is along that at its mean radius r: a couple r^2 n/(r^2 + h^2) and a force h n/(r^2 + h^2).
        """
        radius = getattr(getattr(link.joint, "friction", None), "radius", None)
        w, v = link.S[variable]
        if radius is None or all(map(is_zero, v)):
            return link.pushed_along(variable, 1)
        r = motion.scope.value(radius)
        square = r * r + v @ v
        return over(1, square) * v, over(r * r, square) * w

    @staticmethod
    def size_of(scope: Scope, size: Expression) -> Scalar:
        """The value of a declared size of dry friction: max(0, T) where T may fall below 0 in the motion."""
        return _not_below_zero(scope, scope.value(size))

    def joint_factor(self, law: JointFriction, value: Callable[[Any], Scalar], rate: Scalar) -> Scalar:
        """- sign(s') of what is dry in a joint, smooth - tanh(s'/v); 0 while it sticks."""
        if law.smooth is not None:
            return -function("tanh", over(rate, value(law.smooth)))
        return -function("sign", rate) if self.sense is None else -self.sense


def _not_below_zero(scope: Scope, x: Scalar) -> Scalar:
    """max(0, x), factors that are never negative before it; x where it is never negative."""
    if _never_below_zero(scope, x):
        return x
    if type(x) is Node and x.op == "mul":
        kept, other = sorted(x.args, key=lambda arg: not _never_below_zero(scope, arg))
        if _never_below_zero(scope, kept):
            product: Scalar = kept * _not_below_zero(scope, other)
            return product
    return function("max", 0, x)


def _never_below_zero(scope: Scope, x: Scalar) -> bool:
    """True if its form shows that a formula is never negative; parameters have the sign of their value, or are not."""
    if type(x) is not Node:
        return bool(x >= 0)
    if x.op == "symbol":
        return x in scope.symbols.parameters.values() and scope.model.exact_parameters().get(x.name, 0) >= 0
    if x.op in ("abs", "exp", "sqrt", "pi") or (x.op == "pow" and type(x.args[1]) is int and x.args[1] % 2 == 0):
        return True
    if x.op == "max":
        return any(_never_below_zero(scope, arg) for arg in x.args)
    same_sign = ("add", "mul", "div", "min", "tanh", "pow")
    return x.op in same_sign and all(_never_below_zero(scope, arg) for arg in x.args)


ContactModes = Mapping[str, ContactMode]
"""By the name of the constraint, or of the body on a path. What is not named is closed and slides by the law."""
