"""A System of sympy whose bodies hang on joints -> the tables of a model file.

The axes of a body are those of its side of the joint (sympy's child_interframe), its origin is the joint's point of it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Container, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from decimal import Decimal
from functools import cached_property
from random import Random
from typing import Any

import sympy
from sympy.physics.mechanics import (
    CylindricalJoint,
    Force,
    LagrangesMethod,
    Lagrangian,
    LinearDamper,
    LinearPathway,
    LinearSpring,
    Particle,
    PinJoint,
    PlanarJoint,
    PrismaticJoint,
    SphericalJoint,
    TorqueActuator,
    WeldJoint,
    find_dynamicsymbols,
)
from sympy.physics.vector import dynamicsymbols

from eomgen.errors import DerivationError, ExpressionError
from eomgen.frozen import dataclass
from eomgen.robots.tables import Entries, LegalNames, without_empty
from eomgen.symbolic.exact import simplest
from eomgen.symbolic.expression import (
    LONGEST,
    LONGEST_WITH_PARTS,
    Fraction,
    Graph,
    Node,
    Scalar,
    fraction_of,
    parse,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate, tolerances
from eomgen.symbolic.print import scalar_from_sympy, text_size, to_text, with_definitions


class _NoBodies(Exception):
    """Signal that the system has parts that only energies describe."""


@dataclass(frozen=True)
class BodyAxes:
    """A body of sympy as one of the model: its name, axes and origin; the ground has no name."""

    name: str | None
    frame: Any
    origin: Any
    body: Any = None


def lagrangian_method(system: Any) -> Any:
    """LagrangesMethod of a system that is formed by it, or has no speeds; else None."""
    if isinstance(system.eom_method, LagrangesMethod):
        return system.eom_method
    if len(system.u) or not len(system.q):
        return None
    loads = [*system.loads, *(load for each in system.actuators for load in each.to_loads())]
    gaps, rows = list(system.holonomic_constraints), list(system.nonholonomic_constraints)
    L = Lagrangian(system.frame, *system.bodies)
    return LagrangesMethod(L, system.q, loads or None, system.bodies, system.frame, gaps or None, rows or None)


def tables_of_joints(system: Any) -> Entries | None:
    """Tables of a model file; None where bodies do not hang on joints, or an actuator has no counterpart."""
    try:
        return _Joints(system).tables()
    except _NoBodies:
        return None


@dataclass
class _Joints:
    """System of sympy, and the tables that are made of it."""

    system: Any
    bodies: LegalNames = field(default_factory=LegalNames)
    placed: dict[Any, BodyAxes] = field(default_factory=dict)
    found: Entries = field(default_factory=dict)
    points: dict[Any, Entries] = field(default_factory=dict)
    forces: LegalNames = field(default_factory=LegalNames)
    frames: dict[Any, BodyAxes] = field(default_factory=dict)

    def tables(self) -> Entries:
        system = self.system
        rates = speeds_as_rates(system.q, system.u, system.kdes)
        if not system.joints or len(rates) != len(system.u) or len(system.q) != len(system.u):
            raise _NoBodies
        self.words = Words(tuple(system.q), tuple(system.u), rates)
        self._place()
        for joint in system.joints:
            self.found |= self._hung(joint)
        forces = self._forces()
        for key, own in self.points.items():
            if key is not None:
                self.found[key]["points"] = {**self.found[key].get("points", {}), **own}
        words = self.words
        gaps, rows = list(system.holonomic_constraints), list(system.nonholonomic_constraints)
        constraints = [{"kind": "equation", "gap": x} for x in words.texts(gaps)]
        constraints += [{"kind": "equation", "rate": x} for x in words.texts(rows)]
        coordinates = {words.of(q): {"start": 0} for q in system.q}
        return without_empty(
            {
                "parameters": {name: {} for name in words.parameters.values()},
                "coordinates": coordinates,
                "inputs": {name: {"value": 0} for name in words.inputs.values()},
                "points": self.points.get(None, {}),
                "bodies": self.found,
                "constraints": {f"tie{k}": constraint for k, constraint in enumerate(constraints, 1)},
                "forces": forces,
            }
        )

    def _place(self) -> None:
        """The axes and the origin of every body.

        Raises:
            _NoBodies: a body on no joint, or on several, that is not the ground.
        """
        system, own = self.system, [joint.child for joint in self.system.joints]
        ground = BodyAxes(None, system.frame, system.fixed_point)
        for body in {joint.parent: None for joint in system.joints if joint.parent not in own}:
            if not _stands(body, system):
                raise _NoBodies
            self.placed[body] = ground
        for joint in system.joints:
            if joint.child in self.placed:
                raise _NoBodies
            name = self.bodies.new(joint.child.name, "body")
            self.placed[joint.child] = BodyAxes(name, joint.child_interframe, joint.child_point, joint.child)
        if any(body not in self.placed and not _stands(body, system) for body in system.bodies):
            raise _NoBodies
        self.frames = {body.frame: at for body, at in self.placed.items() if hasattr(body, "frame")}

    # bodies on their joints

    def _hung(self, joint: Any) -> dict[str, Entries]:
        above, own = self.placed[joint.parent], self.placed[joint.child]
        R = above.frame.dcm(joint.parent_interframe)
        at = self._vector(joint.parent_point.pos_from(above.origin), above.frame)
        seat: Entries = {} if above.name is None else {"on": above.name}
        seat |= {"at": at} if any(x != 0 for x in at) else {}
        seat |= {} if R == sympy.eye(3) else {"turned": self._turn(R)}
        assert own.name is not None
        found: dict[str, Entries] = {}
        *before, last = self._moves(joint)
        for move in before:  # frames without mass between its degrees of freedom
            frame = self.bodies.new(f"{own.name}_{next(reversed(move.values()))}")
            found[frame] = {
                "about": f"between the joints of {own.name}",
                "joint": {"kind": move["kind"], **seat, **move},
            }
            seat = {"on": frame}
        return found | {own.name: {**self._body(own), "joint": {"kind": last["kind"], **seat, **last}}}

    def _turn(self, R: Any) -> Entries:
        """The turn about an axis that a constant rotation is.

        Raises:
            _NoBodies: it is none in closed form.
        """
        R = sympy.simplify(R)
        cosine = sympy.simplify((R.trace() - 1) / 2)
        axis = [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
        if cosine == -1:
            k = max(range(3), key=lambda i: sympy.Abs(R[i, i] + 1).evalf() if (R[i, i]).is_number else 0)
            axis = [R[i, k] + (i == k) for i in range(3)]
        if find_dynamicsymbols(R) or all(sympy.simplify(x) == 0 for x in axis):
            raise _NoBodies
        size = max(map(sympy.Abs, axis), key=lambda x: x.evalf() if x.is_number else 0)
        axis = [sympy.simplify(x / size) for x in axis]
        return {"axis": self.words.texts(axis), "angle": self.words.text(sympy.acos(cosine))}

    def _body(self, at: BodyAxes) -> Entries:
        body, words = at.body, self.words
        found: Entries = {} if body.name == at.name else {"about": str(body.name)}
        if body.mass != 0:
            found["mass"] = words.text(body.mass)
            center = self._vector(body.masscenter.pos_from(at.origin), at.frame)
            found |= {"center": center} if any(x != 0 for x in center) else {}
            if not isinstance(body, Particle):
                I = body.central_inertia.to_matrix(at.frame)
                six = words.texts([I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[1, 2], I[0, 2]])
                found["inertia"] = six if any(x != 0 for x in six[3:]) else six[:3]
                if sum(x == 0 for x in six) == 5:  # of a plane system people give one moment alone
                    found["measured"] = True
            else:
                found["inertia"] = [0, 0, 0]
        return found

    def _vector(self, vector: Any, frame: Any) -> list[Any]:
        """A vector in a frame, as it stands in a file."""
        return [0, 0, 0] if vector == 0 else list(self.words.texts(vector.to_matrix(frame)))

    def _moves(self, joint: Any) -> list[Entries]:
        """Joint of a model file for a joint of sympy, or several in a row.

        Raises:
            _NoBodies: a kind of joint that no model has.
        """
        own = joint.parent_interframe
        q = [self.words.of(x) if x in self.words.moving else self.words.text(x) for x in joint.coordinates]
        if isinstance(joint, WeldJoint):
            return [{"kind": "fixed"}]
        if isinstance(joint, PinJoint):
            return [{"kind": "revolute", "axis": self._vector(joint.joint_axis, own), "angle": q[0]}]
        if isinstance(joint, PrismaticJoint):
            return [{"kind": "prismatic", "axis": self._vector(joint.joint_axis, own), "displacement": q[0]}]
        if isinstance(joint, CylindricalJoint):
            return [
                {
                    "kind": "cylindrical",
                    "axis": self._vector(joint.joint_axis, own),
                    "angle": q[0],
                    "displacement": q[1],
                }
            ]
        if isinstance(joint, PlanarJoint):
            slides = zip(joint.planar_vectors, q[1:], strict=True)
            found: list[Entries] = [
                {"kind": "prismatic", "axis": self._vector(v, own), "displacement": x} for v, x in slides
            ]
            return [*found, {"kind": "revolute", "axis": self._vector(joint.rotation_axis, own), "angle": q[0]}]
        if isinstance(joint, SphericalJoint):
            amounts = joint._amounts or joint.coordinates
            return [{"kind": "spherical", **self._sequence(joint, self.words.texts(amounts))}]
        raise _NoBodies

    def _sequence(self, joint: Any, angles: list[Any]) -> Entries:
        """Three rotations about axes of the body; about axes of the parent in the opposite order."""
        letters = "".join("xyz"[int(x) - 1] if x.isdigit() else x for x in str(joint._rot_order).lower())
        if joint._rot_type.upper() == "SPACE":
            letters, angles = letters[::-1], angles[::-1]
        return {"orientation": letters, "angles": angles}

    # loads

    def _forces(self) -> Entries:
        found: Entries = {}
        loads = list(self._weights(found))
        for each in self.system.actuators:
            if not self._spring(each, found) and not self._motor(each):
                loads += each.to_loads()
        for load in loads:
            self._load(load, found)
        if lagrangian_method(self.system) is not None:  # Kane's method uses no potential energy of a body
            energies = [body.potential_energy for body in self.system.bodies]
            for k, text in enumerate(self.words.texts([x for x in energies if x != 0])):
                found[self.forces.new(f"V{k + 1}")] = {"kind": "potential", "energy": text}
        return found

    def _weights(self, found: Entries) -> Iterator[Any]:
        """The loads that are no weights; weights become gravity, one for each field."""
        ground, fields = self.system.frame, dict[Any, list[str]]()
        places = {at.body.masscenter: at for at in self.placed.values() if at.body is not None and at.body.mass != 0}
        for load in self.system.loads:
            at = places.get(load.location) if isinstance(load, Force) else None
            if at is None or at.name is None:
                yield load
                continue
            field = with_rationals(load.vector.to_matrix(ground) / at.body.mass).applyfunc(sympy.simplify)
            if find_dynamicsymbols(field) or field.free_symbols & sympy.sympify(at.body.mass, strict=True).free_symbols:
                yield load
            else:
                fields.setdefault(sympy.ImmutableMatrix(field), []).append(at.name)
        everyone = [at.name for at in places.values() if at.name is not None]
        for acceleration, names in fields.items():
            weight: Entries = {"kind": "gravity", "acceleration": list(self.words.texts(acceleration))}
            if sorted(names) != sorted(everyone):
                if len(set(names)) < len(names):
                    raise _NoBodies
                weight["bodies"] = names
            found[self.forces.new("weight")] = weight

    def _spring(self, actuator: Any, found: Entries) -> bool:
        """Reads a spring or damper between two points; False for another actuator."""
        pathway = getattr(actuator, "pathway", None)
        if type(actuator) not in (LinearSpring, LinearDamper) or not isinstance(pathway, LinearPathway):
            return False
        points = [self._point(x) for x in pathway.attachments]
        if type(actuator) is LinearSpring:
            own = {"stiffness": actuator.stiffness, "length": actuator.equilibrium_length}
            kind = "spring"
        else:
            own, kind = {"damping": actuator.damping}, "damper"
        if any(find_dynamicsymbols(sympy.sympify(x, strict=True)) for x in own.values()):
            return False
        found[self.forces.new(kind)] = {"kind": kind, "points": points} | {
            k: self.words.text(x) for k, x in own.items()
        }
        return True

    def _motor(self, actuator: Any) -> bool:
        """True if the actuator turns the child of a hinge against the parent, about its axis: the joint then has it."""
        frames = [self.frames.get(getattr(actuator, key, None)) for key in ("target_frame", "reaction_frame")]
        for joint in (each for each in self.system.joints if isinstance(each, PinJoint)):
            ends = [self.placed[joint.child], self.placed[joint.parent]]
            if (
                type(actuator) is not TorqueActuator
                or None in frames
                or sorted(map(id, frames)) != sorted(map(id, ends))
            ):
                continue
            along = sympy.simplify(actuator.axis.normalize().dot(joint.joint_axis.normalize()))
            own = self.found[ends[0].name or ""]["joint"]
            if along in (1, -1) and "torque" not in own:
                own["torque"] = self.words.text(along * actuator.torque * (1 if frames[0] is ends[0] else -1))
                return True
        return False

    def _load(self, load: Any, found: Entries) -> None:
        """A force at a point, or a couple on a body.

        Raises:
            _NoBodies: at a point that is fixed in no body.
        """
        if load.vector == 0:
            return
        if isinstance(load, Force):
            at, _ = self._whose(load.location)
            if at.name is not None:
                force = {"kind": "force", "point": self._point(load.location)}
                found[self.forces.new("force")] = force | self._components("force", load.vector, at)
            return
        frame = load.location
        candidates = (x for x in self.placed.values() if not find_dynamicsymbols(frame.dcm(x.frame)))
        held = self.frames.get(frame) or next(candidates, None)
        if held is None:
            raise _NoBodies
        if held.name is not None:
            couple = {"kind": "couple", "body": held.name} | self._components("couple", load.vector, held)
            found[self.forces.new("couple")] = couple

    def _components(self, key: str, vector: Any, at: BodyAxes) -> Entries:
        """A vector in the ground's axes, or in those of its body where that is shorter."""
        own, ground = (self._vector(vector, frame) for frame in (at.frame, self.system.frame))
        return {key: ground} if len(str(ground)) <= len(str(own)) else {key: own, "axes": at.name}

    def _whose(self, point: Any) -> tuple[BodyAxes, Any]:
        """(the body that a point is fixed in, where it is in that).

        Raises:
            _NoBodies: none.
        """
        for shorter in (sympy.sympify, sympy.trigsimp):  # most need none, and it takes long
            for at in self.placed.values():
                vector = point.pos_from(at.origin)
                place = sympy.zeros(3, 1) if vector == 0 else vector.to_matrix(at.frame).applyfunc(shorter)
                if not find_dynamicsymbols(place):
                    return at, place
        raise _NoBodies

    def _point(self, point: Any) -> str:
        """The name of a point of the body that it is fixed in."""
        at, place = self._whose(point)
        if at.body is not None and at.body.mass != 0 and point is at.body.masscenter:
            return f"{at.name}.center"
        own, value = self.points.setdefault(at.name, {}), self.words.texts(place)
        known = next((name for name, x in own.items() if x == value), None)
        name = known or LegalNames({*own, "origin", "center"}).new(point.name, "P")
        own[name] = value
        return name if at.name is None else f"{at.name}.{name}"


def _stands(body: Any, system: Any) -> bool:
    """True if a body is the ground: its frame and its mass centre do not move."""
    frame = getattr(body, "frame", system.frame)
    try:
        still = frame.dcm(system.frame) == sympy.eye(3) and body.masscenter.pos_from(system.fixed_point) == 0
    except ValueError:  # raised by sympy where nothing connects them
        return False
    return bool(still)


# -------- sympy words -----------------------------------------------------------------------------------------
# sympy's functions of time -> names of a model and texts of its grammar.


NAMED_PART = 400  # characters of a part that gets a name of its own
PLAIN = re.compile(r"[{}\\^]")  # of sympy's names, as in \dot{q}


@dataclass
class Words:
    """The names that sympy's symbols get, each the nearest that is legal.

    Args:
        q, u: coordinates and speeds, functions of time; a speed that is a rate is called as that.
        rates: {u: its coordinate} of speeds that are rates.
    """

    q: Sequence[Any]
    u: Sequence[Any] = ()
    rates: Mapping[Any, Any] = field(default_factory=dict)
    names: LegalNames = field(default_factory=LegalNames)
    parameters: dict[Any, str] = field(default_factory=dict)
    inputs: dict[Any, str] = field(default_factory=dict)
    graph: Graph = field(default_factory=Graph)

    @cached_property
    def moving(self) -> dict[Any, str]:
        """The names of q, q', q'', u and u'."""
        t = dynamicsymbols._t
        own = {q: self.names.new(_plain(q), "q") for q in self.q}
        found = {q.diff(t, k): name + k * "'" for q, name in own.items() for k in range(3)}
        for u in self.u:
            name = f"{own[self.rates[u]]}'" if u in self.rates else self.names.new(_plain(u), "u")
            found |= {u: name, u.diff(t): f"{name}'"}
        return found

    def of(self, symbol: Any) -> str:
        """The name of a coordinate, rate or speed."""
        return self.moving[symbol]

    @cached_property
    def nodes(self) -> dict[str, Node]:
        """The symbols of the graph by name; parameters and inputs come as they are met."""
        return {name: self.graph.symbol(name) for name in ("t", *self.moving.values())}

    def scalar(self, expression: Any) -> Scalar:
        """An expression in the symbols of the graph.

        Raises:
            DerivationError: a model has no counterpart for it.
        """
        t = dynamicsymbols._t
        expression = sympy.sympify(expression, strict=True)
        moving = {x: sympy.Symbol(name) for x, name in self.moving.items()} | {t: sympy.Symbol("t")}
        standing = expression.xreplace(moving)
        for rate in sorted(standing.atoms(sympy.Derivative), key=str):
            what = f"the rate {rate} of a given function of time stands in the equations"
            raise DerivationError(what, fix="make it a coordinate, and give that its `motion` in the model")
        functions = expression.atoms(sympy.core.function.AppliedUndef) - moving.keys()
        known = moving | {x: sympy.Symbol(self._input(x)) for x in _sorted(functions)}
        parameters = expression.free_symbols - {t}  # before anything else is called as they are
        known |= {x: sympy.Symbol(self._parameter(x)) for x in _sorted(parameters)}
        return scalar_from_sympy(with_rationals(expression.xreplace(known)), self.nodes)

    def _input(self, function: Any) -> str:
        """Raises: DerivationError: it is no function of time alone."""
        if function.args != (dynamicsymbols._t,):
            raise DerivationError(f"{function} is a function that sympy does not know", fix="put its formula in")
        if function not in self.inputs:
            self.inputs[function] = self._new(_plain(function), "input")
        return self.inputs[function]

    def _parameter(self, symbol: Any) -> str:
        if symbol not in self.parameters:
            self.parameters[symbol] = self._new(_plain(symbol), "p")
        return self.parameters[symbol]

    def _new(self, wanted: str, otherwise: str) -> str:
        name = self.names.new(wanted, otherwise)
        self.nodes[name] = self.graph.symbol(name)
        return name

    def texts(self, expressions: Sequence[Any]) -> list[Any]:
        """Expressions as they stand in a model file, each in its shorter form."""
        return file_texts([self.scalar(x) for x in expressions])

    def text(self, expression: Any) -> Any:
        return self.texts([expression])[0]


def with_rationals(expression: Any) -> Any:
    """An expression or matrix in which decimals are the numbers that are written."""
    return expression.xreplace({x: sympy.Rational(str(x)) for x in expression.atoms(sympy.Float)})


def file_texts(scalars: Sequence[Scalar], taken: Container[str] = ()) -> list[Any]:
    """Scalars as they stand in a model file, numbers as decimals where they end.

    A formula that would be too long gets names for its parts: "z1 = sin(q); z1^2 + z1".

    Args:
        taken: names that no part may have.
    Raises:
        DerivationError: one is longer than a model file may have it even so.
    """
    shortest = [min((simplest(x, Work.FORMULA), x), key=text_size) for x in scalars]
    found = [_written(x, taken) if (value := _decimal(x)) is None else value for x in shortest]
    _refuse_misread(scalars, found)
    return found


def _refuse_misread(scalars: Sequence[Scalar], found: Sequence[Any]) -> None:
    """Refuses texts that, read back by the grammar, have other values than their scalars.

    Raises:
        DerivationError: one is.
    """
    rng, symbols = Random(41), symbols_of(scalars)
    state = {x: rng.uniform(0.5, 1.0) for x in sorted(symbols, key=lambda x: x.name)}
    names = {x.name: value for x, value in state.items()} | {"pi": math.pi}
    for x, text in zip(scalars, found, strict=True):
        if not isinstance(text, str):
            continue
        with suppress(NoValue, ExpressionError, ArithmeticError, ValueError):  # a root of a negative number there
            (due,) = evaluate((x,), state, FLOAT)
            read = float(parse(text, longest=LONGEST_WITH_PARTS).evaluate(names))
            if abs(read - due) > tolerances.COMPUTED * (1 + abs(due)):
                what = f"a formula of sympy is written as another one, {read:.9g} for {due:.9g}: {text[:60]}"
                raise DerivationError(what, fix="this is a mistake of eomgen: please report it")


def _written(x: Scalar, taken: Container[str]) -> str:
    if text_size(x) <= LONGEST:
        return to_text(x)
    definitions, (text,) = with_definitions([x], NAMED_PART, taken)
    found = "; ".join([*(f"{name} = {part}" for name, part in definitions), text])
    if len(found) > LONGEST_WITH_PARTS:
        what = f"an energy or a force takes {len(found)} characters to write"
        fix = "give sympy's System its joints, or sympy shorter frames and velocities"
        raise DerivationError(f"{what}, of which a model file may have {LONGEST_WITH_PARTS}", fix=fix)
    return found


def _decimal(x: Scalar) -> Decimal | None:
    """A number whose decimals end."""
    if type(x) is Node:
        return None
    found = Decimal(int(Fraction(x).numerator)) / Decimal(int(Fraction(x).denominator))
    return found if fraction_of(str(found)) == x else None


def speeds_as_rates(q: Sequence[Any], u: Sequence[Any], kinematic: Sequence[Any]) -> dict[Any, Any]:
    """{speed: coordinate} of the speeds that are rates, by the kinematic equations in q' and u."""
    t = dynamicsymbols._t
    found = {x.diff(t): x for x in q if x.diff(t) in list(u)}  # a rate that was given for the speed
    for x in kinematic:
        for coordinate in (each for each in q if x.has(each.diff(t))):
            for speed in (each for each in u if x.has(each)):
                if (difference := (coordinate.diff(t) - speed)) in (x, -x) or sympy.expand(x**2 - difference**2) == 0:
                    found[speed] = coordinate
    return found


def _plain(symbol: Any) -> str:
    name = symbol.name if isinstance(symbol, sympy.Symbol) else symbol.func.__name__
    return PLAIN.sub("", name)


def _sorted(symbols: Any) -> list[Any]:
    return sorted(symbols, key=lambda x: (str(x), sympy.default_sort_key(x)))
