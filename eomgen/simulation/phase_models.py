"""Model -> PhaseModels: the phase of every configuration of its contacts, derived and compiled once."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank, Row, holds_identically
from eomgen.mechanics.dynamics import EquationsOfMotion, System, assembled_by_recursion
from eomgen.mechanics.free_bodies import equations_of_motion, with_friction
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.kinematics import GROUND, BodyLink, ContactMode, ContactModes
from eomgen.model import Contact, Coordinate, Model, PointForce, Table
from eomgen.simulation.contacts import Configuration, ContactEvents, bounds_of, changed, on_pieces
from eomgen.simulation.impacts import WithoutContacts
from eomgen.simulation.phase_model import Fed, PhaseModel, Values
from eomgen.symbolic.exact import readable_all
from eomgen.symbolic.expression import (
    Expression,
    Node,
    Scalar,
    Vector,
    as_expression,
    is_zero,
    over,
    symbols_of,
)
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import to_text

OPEN = ContactMode(closed=False)
MOST_COMPILED = 64  # configurations up to which each is compiled when it first comes; of more those that come again


def integrated_system(system: System) -> System:
    """The system that is integrated: every coordinate with a rate of its own, where `dependent` rates may be 0/0.

    At a dead centre of the dependent coordinates u_d = A u_i + b divides by 0; M a + c = Q + J^T lam, J a + gamma = 0
    over all rates does not, as long as the rows of J are independent. Speeds that the model declares stay as they are.
    """
    if system.free is None or system.scope.model.speeds:
        return system
    return Quantities.put_into_rates(system.free) if system.singular_blocks else system


@dataclass(frozen=True)
class Slides:
    """The contacts of a system that have Coulomb friction, as they slide.

    Args:
        p: the parameters' values.
    """

    system: System
    contacts: tuple[Contact, ...]
    p: np.ndarray

    def with_parameters(self, p: np.ndarray) -> Slides:
        """The same at other values of the parameters."""
        found = replace(self, p=p)
        vars(found)["velocities"] = self.velocities
        return found

    def at(self, t: float, values: Values) -> dict[str, float]:
        """The sliding velocity of each contact."""
        x = np.array([values.get(node.name, 0.0) for node in self.system.symbols.x])
        found = self.velocities.many(np.array([t]), x[None, :], self.p)[0]
        return {contact.name: float(v) for contact, v in zip(self.contacts, found, strict=True)}

    @cached_property
    def velocities(self) -> RightHandSide:
        """Function of them."""
        scalars = tuple(self.system.sliding_velocity(contact) for contact in self.contacts)
        return RightHandSide.of(Program.of(scalars, self.system.symbols, inputs=self.system.inputs), "numpy")


class PhaseModels:
    """The phases of a model.

    Args:
        model: whose contacts change.
        p: the values of its parameters.
        target: of the emitted code.
        rates: alpha and beta of Baumgarte's rows; None: they do not pull.
        derived: the equations of the one phase of a model that has no other, where they are known.
        origin: the same at other values of the parameters, whose phases these are, and the function for new values.
    """

    def __init__(
        self,
        model: Model,
        p: np.ndarray,
        target: str | None,
        rates: tuple[float, float] | None = None,
        derived: EquationsOfMotion | None = None,
        origin: tuple[PhaseModels, Fed | None] | None = None,
    ) -> None:
        self.model, self.p, self.target, self.rates = model, p, target, rates
        self._derived = None if model.has_phases else derived
        self._origin = origin
        self._made: dict[Configuration, PhaseModel] = {}
        self._last: tuple[Configuration, PhaseModel] | None = None
        # by what they were found from; configurations that a run has come to, or asked for
        self.known: dict[str, dict[Hashable, Any]] = {"starts": {}, "in C": {}, "come to": {}, "asked for": {}}
        self.known["changes"] = {}
        self._slides: dict[Configuration, Slides] = {}

    @staticmethod
    def one_phase(
        declared: System, equations: EquationsOfMotion, p: np.ndarray, target: str | None = None
    ) -> PhaseModel:
        """Equations of motion as the one phase of a motion in which no contact changes."""
        system = integrated_system(declared)
        if system is not declared:
            equations = equations_of_motion(system)
        return PhaseModel(ContactEvents(Configuration(), (), {}, system), declared, equations, p, target)

    def at(self, p: np.ndarray, fed: Fed | None = None) -> PhaseModels:
        """The same at other values of the parameters, at which the same is derived: no phase is made twice.

        Args:
            fed: as of PhaseModel.
        """
        return PhaseModels(self.model, p, self.target, self.rates, self._derived, (self, fed))

    @property
    def origin(self) -> PhaseModels | None:
        """The same at the values at which its phases were derived; None of those themselves."""
        return None if self._origin is None else self._origin[0]

    @property
    def is_fed(self) -> bool:
        """True if a Python function changes the parameters along the run."""
        return self._origin is not None and self._origin[1] is not None

    @property
    def only(self) -> PhaseModel:
        """The one phase of a model whose contacts do not change."""
        return self.of(Configuration())

    def of(self, configuration: Configuration) -> PhaseModel:
        """The phase of a configuration.

        Raises:
            DerivationError: a contact ends and nothing can leave it.
        """
        if self._last is None or self._last[0] is not configuration:
            if configuration not in self._made:
                made = self._phase(configuration) if self._origin is None else self._origin[0].of(configuration)
                self._made[configuration] = made if self._origin is None else made.at(self.p, self._origin[1])
            self._last = configuration, self._made[configuration]
        return self._last[1]

    def comes_again(self, configuration: Configuration, how: str = "come to") -> bool:
        """True if a phase is worth a compiler: of a model with few, the first of a run, or one that was there before.

        Args:
            how: a run has "come to" it, or it was "asked for", of several of which one agrees.
        """
        if self._origin is not None:
            return self._origin[0].comes_again(configuration, how)
        before = {**self.known["come to"], **(self.known[how])}
        self.known[how][configuration] = True
        return self.target is not None or not self._is_many or not before or configuration in before

    @property
    def _is_many(self) -> bool:
        """True if the contacts have more configurations than are compiled one and all."""
        found = 1
        for contact in self.model.contacts:
            found *= (3 if contact.dry else 1) + contact.unilateral
        return found > MOST_COMPILED

    def changes(self, before: Configuration, after: Configuration) -> tuple[str, ...]:
        """Changes from one configuration to another, as of `changed`, said once."""
        if self._origin is not None:
            return self._origin[0].changes(before, after)
        known, key = self.known["changes"], (id(before), id(after))
        if key not in known:
            known[key] = before, after, changed(self.model, before, after)  # both are kept: an id stays theirs
        found: tuple[str, ...] = known[key][2]
        return found

    def slides(self, configuration: Configuration) -> Slides:
        """The sliding velocities of a configuration, for which no force needs to be known."""
        if configuration not in self._slides and self._origin is not None:
            self._slides[configuration] = self._origin[0].slides(configuration).with_parameters(self.p)
        if configuration not in self._slides:
            model = on_pieces(self.model, configuration.pieces)
            with_friction = [c for c in model.contacts if c.dry and configuration.modes[c.name].closed]
            self._slides[configuration] = Slides(self._system(model, configuration), tuple(with_friction), self.p)
        return self._slides[configuration]

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """The times of the samples of every motion and input [s]."""
        return self.model.breakpoints

    @cached_property
    def without_contacts(self) -> WithoutContacts:
        """The model without the contacts that can end.

        Raises:
            DerivationError: as `of`.
        """
        if self._origin is not None:
            return replace(self._origin[0].without_contacts, p=self.p)
        return WithoutContacts(_opened(self.model, dict.fromkeys(self.ends, OPEN)), self.ends, self.p)

    @property
    def ends(self) -> tuple[str, ...]:
        """The contacts that can end."""
        return tuple(contact.name for contact in self.model.contacts if contact.unilateral)

    def _phase(self, configuration: Configuration) -> PhaseModel:
        model = on_pieces(self.model, configuration.pieces)
        if self._derived is None:
            declared = Quantities.put_into_rates(self._system(model, configuration))
        else:
            declared = self._derived.system
        system = integrated_system(declared)
        equations = self._equations(system)
        lengths = {body: self._length(system, body, k) for body, k in configuration.pieces.items()}
        watch = ContactEvents(configuration, model.contacts, lengths, system)
        return PhaseModel(watch, declared, equations, self.p, self.target)

    def _equations(self, system: System) -> EquationsOfMotion:
        """The equations of motion, friction and Baumgarte's rows included."""
        if self._derived is not None and self._derived.system is system and self.rates is None:
            return self._derived
        equations = assembled_by_recursion(system)
        return with_friction(equations if self.rates is None else equations.stabilized(self.rates))

    def _system(self, model: Model, configuration: Configuration) -> System:
        """The system of a configuration.

        Where a body leaves one contact along another direction than this contact's own, the displacements of two
        contacts are not those of each alone. Then all that can end are released together, and those that hold close.
        """
        if not configuration.open or self._straight:
            return _opened(model, configuration.modes)
        all_open = {**configuration.modes, **dict.fromkeys(self.ends, OPEN)}
        released = _opened(model, all_open)
        return System.of(released.scope.model, configuration.modes, begun_as=released)

    @property
    def _straight(self) -> bool:
        system = System.of(self.model)
        return all(stays_straight(system, constraint) for constraint in self.ends)

    def _length(self, system: System, body: str, k: int) -> tuple[bool, Scalar | None]:
        bounds = bounds_of(self.model, body)
        start, end = bounds[k]
        return k > 0, system.scope.value(end - start) if k + 1 < len(bounds) else None


def _opened(model: Model, modes: ContactModes) -> System:
    """The system with its contacts in these modes: those that are open released, one after the other.

    Raises:
        DerivationError: nothing can leave a contact that has ended.
    """
    closed: Mapping[str, ContactMode] = {name: mode for name, mode in modes.items() if mode.closed}
    system = System.of(model, closed)
    for name, mode in modes.items():
        if not mode.closed:
            system = _released(system, name)
    return system


def _released(system: System, constraint: str) -> System:
    """The system without a constraint: where its rows only close, they are left out and nothing else changes.

    Raises:
        DerivationError: coordinates that satisfy the constraint by themselves cannot leave it.
    """
    model, modes = released(system, constraint)
    after = System.of(model, modes, begun_as=system)
    rows = [row for row in system.constraints.rows if row.constraint == constraint]
    if all(row.status == "closing" for row in rows):
        return after
    dependent = {(row.constraint, row.number) for row in Rank(system.constraints).redundant()}
    held = [row for row in rows if (row.constraint, row.number) not in dependent]
    if Rank(after.constraints).degrees_of_freedom() < Rank(system.constraints).degrees_of_freedom() + len(held):
        raise DerivationError(
            f"'{constraint}' ends, and what it held does not become free",
            f"constraints.{constraint}",
            "place the body by coordinates that can leave the contact",
        )
    return after


# -------- derived at ------------------------------------------------------------------------------------------
# System, values of many runs -> which of these have the equations that were derived at the values of one.
#
# What is derived holds for all values of the parameters, but for what numbers have decided on the way:
#
#     signs        of the parameters, and of values at the start that decided the form of loads and constraints
#     dependence   which rows of the constraints follow from others: as before where no parameter in them has another
# value,
#         and
#                  where all rows are independent, rank J = k at a state in which they hold: it is so nearly everywhere


@dataclass(frozen=True)
class DerivedAt:
    """A system that was derived at values of its parameters.

    Args:
        system: it.
        p: the values.
        changes: it is only one of the phases of a model.
    """

    system: System
    p: np.ndarray
    changes: bool

    def holds(self, p: np.ndarray, q: np.ndarray) -> np.ndarray:
        """True for each of n runs with the same equations, as far as that is known without closing the constraints.

        Args:
            p: n x parameters.
            q: the declared start of the coordinates, n x coordinates.
        """
        found = np.all(np.sign(p) == np.sign(self.p), axis=1)
        if self._decided:
            own = self._signs(self.p[None, :], self.declared.many(0.0, self._still(1), self.p))
            found &= np.all(self._signs(p, q) == own, axis=1)
        return np.asarray(found & (~self.requests(p) | self._is_independent))

    def requests(self, p: np.ndarray) -> np.ndarray:
        """True for each of n runs in which a parameter of the constraints has another value."""
        return np.asarray(np.any((p != self.p)[:, self._in_constraints], axis=1))

    def is_regular(self, p: np.ndarray, x: np.ndarray) -> np.ndarray:
        """True for each of n runs whose rows have their usual rank at states (q, u) in which they hold.

        Rows that the coordinates were found to satisfy by themselves must hold there too.
        """
        free, n = self._free, len(x)
        J = self._rows.many(0.0, self._of_free(x), p)
        known = np.all(np.isfinite(J), axis=1)
        gaps, J = np.split(np.where(known[:, None], J, 0.0), [len(self._given)], axis=1)
        J = J.reshape(n, len(free.constraints.closing), len(free.symbols.u))
        found = known & np.all(np.abs(gaps) <= tolerances.COMPUTED, axis=1)
        found &= _singular_value(J, self._rank) > tolerances.NEARLY_SINGULAR
        rows, speeds = self._determining
        found &= _singular_value(J[:, rows][:, :, speeds], len(rows)) > tolerances.NEARLY_SINGULAR
        return np.asarray(found)

    @property
    def _free(self) -> System:
        return self.system.free or self.system

    @cached_property
    def _decided(self) -> tuple[Node, ...]:
        found = {**self._free.motion.decided, **self.system.motion.decided}
        symbols = self.system.symbols
        places = {*symbols.q, *symbols.parameters.values(), symbols.t}
        return tuple(x for x in found if set(symbols_of((x,))) <= places)

    @cached_property
    def _in_constraints(self) -> list[int]:
        """The places of the parameters that stand in the constraints, closed or open."""
        motion = self._free.motion
        rows = [row for name in motion.scope.model.constraints for row in Row.of_constraint(motion, name)]
        entries = (*self._free.constraints.rows, *rows)
        used = set(symbols_of([x for row in entries for x in (row.velocity, 0 if row.gap is None else row.gap)]))
        return [k for k, x in enumerate(self.system.symbols.parameters.values()) if x in used]

    @property
    def _is_independent(self) -> bool:
        return not self.changes and self._rank == len(self._free.constraints.closing)

    @cached_property
    def _rank(self) -> int:
        return Rank(self._free.constraints).rank()

    @property
    def _determining(self) -> tuple[list[int], list[int]]:
        """(the rows by which dependent coordinates are eliminated, their speeds)."""
        used = {} if self.system.elimination is None else self.system.elimination.used
        names = self._free.scope.dependent
        rows = [i for i, row in enumerate(self._free.constraints.closing) if used.get((row.constraint, row.number))]
        return rows, [k for k, u in enumerate(self._free.symbols.u) if u.name[:-1] in names]

    @property
    def _given(self) -> tuple[Scalar, ...]:
        """The gaps of rows that the coordinates were found to satisfy by themselves."""
        return tuple(row.gap for row in self._free.constraints.rows if row.identical and type(row.gap) is Node)

    @cached_property
    def _rows(self) -> RightHandSide:
        return self._of(self._free, (*self._given, *(x for row in self._free.constraints.J for x in row)))

    @cached_property
    def declared(self) -> RightHandSide:
        """Function of the parameters that gives the declared start of the coordinates."""
        scope = self.system.scope
        return self._of(self.system, tuple(scope.with_unit_quaternions(scope.start_values()).values()))

    @cached_property
    def _requested(self) -> RightHandSide:
        return self._of(self.system, self._decided)

    def _signs(self, p: np.ndarray, q: np.ndarray) -> np.ndarray:
        x = self._still(len(q))
        x[:, : q.shape[1]] = q
        return np.asarray(np.sign(self._requested.many(0.0, x, p)))

    def _still(self, n: int) -> np.ndarray:
        return np.zeros((n, len(self.system.symbols.x)))

    def _of_free(self, x: np.ndarray) -> np.ndarray:
        """States of the free system at the places of these; rows do not depend on its speeds."""
        symbols = self._free.symbols
        found = np.zeros((len(x), len(symbols.x)))
        found[:, : len(symbols.q)] = x[:, : len(symbols.q)]
        return found

    def _of(self, system: System, scalars: tuple[Scalar, ...]) -> RightHandSide:
        return RightHandSide.of(Program.of(scalars, system.symbols, inputs=system.inputs), "numpy")


def _singular_value(J: np.ndarray, rank: int) -> np.ndarray:
    """The rank-th singular value of each matrix, its rows scaled to length 1; 1 where the rank is 0."""
    if not rank:
        return np.ones(len(J))
    if rank > min(J.shape[1:]):
        return np.zeros(len(J))
    lengths = np.linalg.norm(J, axis=2, keepdims=True)
    longest = np.max(lengths, axis=1, keepdims=True)
    unit = J / np.where(lengths > tolerances.ROUNDING * longest, lengths, np.inf)
    return np.asarray(np.linalg.svd(unit, compute_uv=False)[:, rank - 1])


# -------- release of a constraint -----------------------------------------------------------------------------
# System, constraint -> Model without it: the next phase of a motion in which a contact has ended.
#
# Where the coordinates satisfy the constraint by themselves they cannot describe the next phase. Then the body that the
# constraint held, which stands where it is `placed`, is freed along the constraint's push: a new coordinate, the
# displacement from the contact.


DISPLACEMENTS = {"n": "gap", "tension": "gap", "t": "slip", "s": "slip"}
"""What a body can do along a row of forces that has ended."""


def released(system: System, constraint: str) -> tuple[Model, ContactModes]:
    """The model and the modes of the phase after the constraint has ended; the coordinates keep their names.

    The constraint stays in the model, open. New coordinates, if they are needed, start at 0 and stand last.

    Raises:
        DerivationError: nothing that is `placed` can be freed from the constraint.
    """
    rows = [row for row in system.constraints.rows if row.constraint == constraint]
    model = _with_free_coordinates(system.scope.model, [row.eliminates for row in rows if row.eliminates])
    for row in rows:
        if row.identical and row.component in DISPLACEMENTS:
            model = _freed(system, model, row)
    modes = {name: mode for name, mode in system.modes.items() if name != constraint}
    return model, {**modes, constraint: ContactMode(closed=False)}


def _with_free_coordinates(model: Model, names: list[str]) -> Model:
    """The model with dependent coordinates free that only the ended constraint determined."""
    table = {name: part.altered(dependent=False) if name in names else part for name, part in model.coordinates.items()}
    return model.altered(coordinates=Table(table)) if names else model


def stays_straight(system: System, constraint: str) -> bool:
    """True if each displacement that releases the constraint is along its own push, whatever else is released."""
    rows = [
        row
        for row in system.constraints.rows
        if row.constraint == constraint and row.identical and row.component in DISPLACEMENTS
    ]
    return all(_placed(system, row).straight for row in rows)


@dataclass(frozen=True)
class Leave:
    """Displacement of a placed body that releases a row.

    Args:
        link: the placed body.
        direction: of its displacement for a unit of the new coordinate, parent's axes.
        straight: True if that is the push of the row itself.
        turns: True if it must turn as well.
    """

    link: BodyLink
    direction: Vector
    straight: bool
    turns: bool = False


def _freed(system: System, model: Model, row: Row) -> Model:
    """The model in which the body that the row pushes may be displaced along the direction that the row alone held."""
    leave = _placed(system, row)
    model, name = _with_coordinate(model, row.constraint, DISPLACEMENTS[row.component])
    joint: Any = model.bodies[leave.link.name].joint
    at = joint.at or (Expression.number(0),) * (2 if model.space == "plane" else 3)
    changes: dict[str, Any] = {
        "at": tuple(
            place if is_zero(n) else as_expression(f"({place.text}) + {name}*({to_text(n)})")
            for place, n in zip(at, leave.direction, strict=False)
        )
    }
    if leave.turns:
        model, turn = _with_coordinate(model, row.constraint, "turn")
        changes["angle"] = as_expression(turn if joint.angle is None else f"({joint.angle.text}) + {turn}")
    body = model.bodies[leave.link.name].altered(joint=joint.altered(**changes))
    return model.altered(bodies=Table({**model.bodies, leave.link.name: body}))


def _with_coordinate(model: Model, constraint: str, what: str) -> tuple[Model, str]:
    """The model with a displacement from a contact that has ended, and its name."""
    taken = {*model.parameters, *model.coordinates, *model.speeds, *model.states, *model.inputs, *model.unknowns}
    name = f"{constraint}_{what}"
    while name in taken:
        name += "_"
    zero = Expression.number(0)
    displaced = Coordinate(start=zero, speed=zero, about=f"displacement from {constraint}, which has ended")
    return model.altered(coordinates=Table({**model.coordinates, name: displaced})), name


def _placed(system: System, row: Row) -> Leave:
    """The placed body by which the row can be opened, and its displacement.

    d is the push n of the row less its part along what else holds the body identically, with n . d = 1. Where nothing
    of it is left (two parallel wires) the body goes along n and turns, and the other constraints hold it by
    multipliers.
    """
    pushed = _pushed(system, row)
    for link, n in pushed:
        others = [
            m
            for other in system.constraints.rows
            if other.identical and other.constraint != row.constraint
            for on, m in _pushed(system, other)
            if on is link
        ]
        d = _across(n, others)
        along = readable_all((n @ d,))[0]
        if not holds_identically(along):
            straight = all(holds_identically(a - b) for a, b in zip(n, d, strict=True))
            return Leave(link, Vector(readable_all(tuple(over(x, along) for x in d))), straight)
    for link, n in pushed:
        if system.scope.model.space == "plane":
            return Leave(link, Vector(readable_all(n)), straight=False, turns=True)
    raise DerivationError(
        f"'{row.constraint}' ends, and no body can leave it: the coordinates describe contact only",
        f"constraints.{row.constraint}",
        "place the body by coordinates that can leave the contact",
    )


def _pushed(system: System, row: Row) -> list[tuple[BodyLink, Vector]]:
    """The placed bodies that the row pushes, or that carry those, and the forces on them, their parents' axes."""
    found = []
    for push in row.pushes:
        if not isinstance(push, PointForce) or push.place[0] is None:
            continue
        link = _root(system, system.motion.link(push.place[0]))
        if link is None:
            continue
        force = push.force if push.axes is None else system.motion.link(push.axes).pose.R @ push.force
        if link.parent != GROUND:
            force = system.motion.links[link.parent].pose.R.T @ force
        found.append((link, force))
    return found


def _across(n: Vector, others: list[Vector]) -> Vector:
    """n less its part in the span of the others, by Gram and Schmidt."""
    basis: list[Vector] = []
    for vector in (*others, n):
        for e in basis:
            vector = vector - over(vector @ e, e @ e) * e
        if all(holds_identically(x) for x in vector):
            vector = Vector.ZERO
        else:
            basis.append(vector)
    return vector


def _root(system: System, link: BodyLink) -> BodyLink | None:
    """The body itself, or the nearest one that carries it, that is placed by expressions."""
    current: BodyLink | None = link
    while current is not None:
        if current.joint is not None and not current.joint.carries_reaction:
            return current
        current = None if current.parent == GROUND else system.motion.links[current.parent]
    return None
