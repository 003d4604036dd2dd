"""System -> Static equations: the expressions that vanish at an equilibrium."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Constraints
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.kinematics import Loads, Scope, SystemInertia, SystemScene
from eomgen.mechanics.state import Doubles
from eomgen.model import Table
from eomgen.symbolic.exact import readable_all, simplest, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    State,
    depends_on,
    is_zero,
    order,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import NoValue, Work, evaluate, fifty_digits, tolerances

# -------- static equations ------------------------------------------------------------------------------------
# System -> Static equations: the expressions that vanish at an equilibrium.
#
#     Q + J^T lam = 0,   phi = 0,   sigma = 0,   z' = 0        at u = 0, t = 0, driven coordinates held where they start
#
# over all coordinates that are not driven, dependent ones among them. sigma is what a velocity row J u + sigma = 0
# demands at rest: of z' = r - x that x = r. Relations between positions that a velocity row gives by itself (a wheel
# that rolls) are taken from the start. States of first order are sought with the coordinates: the rate of each stands
# where the force along it would, for neither need be solvable without the other. The norm of a quaternion, e . e = 1,
# is one more constraint.


MOST_TERMS = 1000  # of all forces together, when they are written out: they share their parts as they come


@dataclass(frozen=True)
class StaticEquations:
    """The balance of a system at rest.

    Args:
        system: of the model, its drives held.
        held: the driven coordinates that the model moves, and that stand still here.
        q: the coordinates sought, and the states of first order after them.
        given: what stands in place of speeds, time, inputs and driven coordinates.
        Q: generalized force along each of q, of a state its rate; `unbalanced` the part that has no potential.
        J: of each constraint row its coefficients, lam its multiplier.
        phi: relations between the coordinates.
        sigma: what remains of the velocity rows at zero speed; it vanishes at rest.
        norms: how many of the rows of J, the last ones, are those of the norms of quaternions.
        beside: the forces along coordinates that need not be sought, as no equation depends on them; they vanish too.
        nowhere: (coordinate, force along it) of the forces that the values of the parameters make vanish everywhere.
    """

    system: System
    held: tuple[str, ...]
    q: tuple[Node, ...]
    given: Mapping[Node, Scalar]
    Q: ScalarRow
    unbalanced: ScalarRow
    J: tuple[ScalarRow, ...]
    lam: tuple[Node, ...]
    phi: ScalarRow
    sigma: ScalarRow = ()
    norms: int = 0
    beside: ScalarRow = ()
    nowhere: tuple[tuple[Node, Scalar], ...] = ()

    @cached_property
    def forces(self) -> ScalarRow:
        """Q + J^T lam."""
        return tuple(
            sum((row[k] * lam for row, lam in zip(self.J, self.lam, strict=True)), start=force)
            for k, force in enumerate(self.Q)
        )

    @property
    def equations(self) -> ScalarRow:
        """All expressions that vanish: forces, relations and sigma, those of coordinates not sought included."""
        return (*self.forces, *self.beside, *self.phi, *self.sigma)

    @property
    def unknowns(self) -> tuple[Node, ...]:
        return (*self.q, *self.lam)

    @property
    def indifferent(self) -> tuple[Node, ...]:
        """Coordinates on which no equation depends: they may have any value."""
        held = frozenset(symbols_of(self.equations))
        return tuple(q for q in self.q if q not in held)

    @property
    def loaded(self) -> tuple[Node, ...]:
        """The unknowns of the model that occur in the forces."""
        held = frozenset(symbols_of(self.Q))
        return tuple(x for x in self.system.symbols.unknowns.values() if x in held)

    def at_the_values(self) -> StaticEquations:
        """The same where a force is 0 that vanishes everywhere for the model's values of the parameters."""
        scope = self.system.scope
        known = {scope.symbols.parameters[name]: x for name, x in scope.model.exact_parameters().items()}
        values = {node: Fraction(x) for node, x in known.items() if isinstance(x, Fraction | int)}
        sought = [k for k, force in enumerate(self.Q) if not is_zero(force) and depends_on(force, values)]
        digits, rng = fifty_digits(), Random(5)
        there = {x: digits.number(Fraction(rng.randint(50, 99), 97)) for x in symbols_of(self.Q)}
        try:  # what has a value at one place does not vanish everywhere
            at = evaluate(self.Q, there | {x: digits.number(v) for x, v in values.items()}, digits)
        except (NoValue, ZeroDivisionError):
            at = [0] * len(self.Q)
        sought = [k for k in sought if abs(at[k]) <= tolerances.ZERO_AT_50]
        empty = [k for k in sought if is_zero(simplest(substituted((self.Q[k],), values)[0], Work.VALUE))]
        Q = tuple(0 if k in empty else force for k, force in enumerate(self.Q))
        return replace(self, Q=Q, nowhere=tuple((self.q[k], self.Q[k]) for k in empty)) if empty else self

    def without(self, dropped: Collection[Node]) -> StaticEquations:
        """The same over the other coordinates, which alone stand in the equations.

        Raises:
            DerivationError: a force along one of those dropped, which nothing balances.
        """
        beside = []
        for q, force in zip(self.q, self.forces, strict=True):
            if q in dropped and not is_zero(force) and not vanishes(force):
                if not depends_on(force, self.unknowns):
                    raise self._unbalanced_along(q)
                beside.append(force)
        kept = [k for k, q in enumerate(self.q) if q not in dropped]

        def of(row: tuple[Any, ...]) -> tuple[Any, ...]:
            return tuple(row[k] for k in kept)

        return replace(
            self,
            q=of(self.q),
            Q=of(self.Q),
            unbalanced=of(self.unbalanced),
            J=tuple(map(of, self.J)),
            beside=(*self.beside, *beside),
        )

    def _unbalanced_along(self, q: Node) -> DerivationError:
        if q in self.system.symbols.z:
            what = f"the state '{q.name}' changes wherever the system stands: there is no equilibrium"
            return DerivationError(what, f"states.{q.name}", "let its rate vanish somewhere, or run the motion")
        return DerivationError(
            f"nothing balances the force along '{q.name}': there is no equilibrium",
            f"coordinates.{q.name}",
            "hold it by a spring or a constraint, or take away what pushes it",
        )

    def holding(self, at: State) -> StaticEquations:
        """The same over the other coordinates, those named held at a place; the forces along them balance too."""
        kept = [k for k, q in enumerate(self.q) if q not in at]
        beside = [force for q, force in zip(self.q, self.forces, strict=True) if q in at]
        Q, unbalanced, phi, sigma, others = (
            substituted(x, at) for x in (self.Q, self.unbalanced, self.phi, self.sigma, self.beside)
        )
        rows = [substituted(row, at) for row in self.J]
        more = tuple(x for x in substituted(tuple(beside), at) if not is_zero(x))
        return replace(
            self,
            q=tuple(self.q[k] for k in kept),
            Q=tuple(Q[k] for k in kept),
            unbalanced=tuple(unbalanced[k] for k in kept),
            phi=phi,
            sigma=sigma,
            beside=(*others, *more),
            J=tuple(tuple(row[k] for k in kept) for row in rows),
        )

    def measured(self, unit: State) -> StaticEquations:
        """The same where each of these coordinates stands for itself over its unit."""
        at = {q: q * x for q, x in unit.items()}
        Q, unbalanced, phi, sigma, beside = (
            substituted(x, at) for x in (self.Q, self.unbalanced, self.phi, self.sigma, self.beside)
        )
        rows = tuple(substituted(row, at) for row in self.J)
        return replace(self, Q=Q, unbalanced=unbalanced, phi=phi, sigma=sigma, beside=beside, J=rows)

    def slopes(self, rows: Sequence[ScalarRow], q: np.ndarray, values: Mapping[Node, float]) -> np.ndarray:
        """Entries as numbers at a place."""
        state = {**values, **dict(zip(self.q, map(float, q), strict=True))}
        return Doubles(state).array(rows, len(rows[0]) if rows else len(self.q))

    def states_beside(self, state: Mapping[Node, Any]) -> Iterator[dict[Node, Any]]:
        """States near a place: terms that do not vanish there are almost the same, and those that vanish are not 0.

        Args:
            state: values of everything, with 50 digits.
        """
        for share in (-tolerances.BESIDE_A_PLACE, 0.7 * tolerances.BESIDE_A_PLACE):
            yield {**state, **{q: state[q] + share * max(1, abs(state[q])) for q in self.q}}

    @classmethod
    def of(cls, system: System) -> StaticEquations:
        """The equations of the system at rest, its drives held.

        Raises:
            DerivationError: dry friction, with which rest is possible in many places; a drive that turns steadily; a
                velocity constraint that no place satisfies at rest.
        """
        _refuse_dry_friction(system)
        system, held = system.with_drives_held()
        system = Quantities.put_into_rates(system)
        free = system.free or system
        scope = free.scope
        driven = [q for q in scope.symbols.q if scope.model.coordinates[q.name].driven]
        q = tuple(x for x in scope.symbols.q if x not in driven)
        given = _given(free, driven)
        z = free.symbols.z
        rows = [(*readable_all(substituted(row, given), Work.FORMULA), *(0 for _ in z)) for row in free.constraints.J]
        standing = StaticEquations.standing(free)  # a damper at a seat that moves with t has no force at rest
        loads = (standing.free or standing).loads
        streams = SystemInertia((standing.free or standing).motion).given_bias  # what flows past pushes at rest
        forces = tuple(Q - x for Q, x in zip(loads.generalized_forces, streams, strict=True))
        _refuse_signs_of_rates(forces, free)
        holds_reactions = standing.scope.reactions_in_rates  # those are of the reduced system
        at_rest = standing if holds_reactions else standing.free or standing
        rates = _rates_at_rest(at_rest, {**given, **at_rest.still})
        Q = (*_at_rest(forces, given, free), *rates)
        powered = tuple(Q - x for Q, x in zip(loads.powered_forces, streams, strict=True))
        unbalanced = (*substituted(powered, given), *rates)
        phi = _relations(system, given, q)
        sigma = _left_at_rest(free, given, q)
        Q, unbalanced, phi, sigma = (
            readable_all(x, Work.FORMULA, most=MOST_TERMS) if x else () for x in (Q, unbalanced, phi, sigma)
        )
        lam = free.symbols.lam
        kept = [i for i, row in enumerate(rows) if not all(map(is_zero, row))]
        statics = cls(
            system,
            held,
            (*q, *z),
            given,
            Q,
            unbalanced,
            tuple(rows[i] for i in kept),
            tuple(lam[i] for i in kept),
            tuple(x for x in phi if not is_zero(x)),
            tuple(x for x in sigma if not is_zero(x)),
        )
        return with_norms(statics)

    @staticmethod
    def over_rates(system: System) -> System:
        """The system over its rates, where a declared speed is not 0 at rest; else as it is."""
        scope = system.scope
        given = (scope.model.coordinates[q.name].driven for q in scope.symbols.q)
        moving = any(not is_zero(x) and not driven for x, driven in zip(scope.nu, given, strict=True))
        if system.free is None or not scope.combines or not moving:
            return system
        return Quantities.put_into_rates(_made_of(system.free, system.free.scope))

    @property
    def still(self) -> System:
        """The system of it with everything held that moves with t."""
        return StaticEquations.standing(self.system)

    @staticmethod
    def standing(system: System) -> System:
        """The system of `over_rates`, with everything that moves with t held where it is at t = 0."""
        system = StaticEquations.over_rates(system)
        free = system.free or system
        scope, t = free.scope, (free.scope.symbols.t,)
        places = [x for link in free.motion.links for x in (*link.pose.p, *(y for row in link.pose.R for y in row))]
        given = (scope.model.coordinates[q.name].driven for q in scope.symbols.q)
        biases = [x for x, driven in zip(scope.nu, given, strict=True) if not driven]
        if not depends_on((*places, *biases, *(row.velocity for row in free.constraints.rows)), t):
            return system
        names = {name: substituted((x,), {t[0]: 0})[0] if type(x) is Node else x for name, x in scope.names.items()}
        return Quantities.put_into_rates(_made_of(free, replace(scope, names=names)))


def with_norms(statics: StaticEquations) -> StaticEquations:
    """The equations with a constraint for the norm of each quaternion that something holds: Q + 2 e lam = 0, e . e =
    1."""
    scope, indifferent = statics.system.scope, statics.indifferent
    turning = [
        (four, part)
        for four, part in zip(scope.quaternions, scope.model.quaternions, strict=True)
        if not all(e in indifferent for e in four)
    ]
    rows = tuple(tuple(2 * q if q in four else 0 for q in statics.q) for four, _ in turning)
    lam = tuple(scope.graph.symbol(f"lam(norm of {part.body}, 1)") for _, part in turning)
    phi = tuple(sum((e * e for e in four), start=-1) for four, _ in turning)
    return replace(statics, J=(*statics.J, *rows), lam=(*statics.lam, *lam), phi=(*statics.phi, *phi), norms=len(rows))


def _given(free: System, driven: Sequence[Node]) -> dict[Node, Scalar]:
    """Values of speeds, time, inputs and driven coordinates at rest, at t = 0."""
    return free.standing(free.scope.start_values(driven))


def _relations(system: System, given: Mapping[Node, Scalar], q: Sequence[Node]) -> ScalarRow:
    """Relations between positions from the constraints; constants that only the start fixes are taken from it."""
    from eomgen.mechanics.integrals import position_equations

    found = substituted(tuple(position_equations(system, system.scope.start_values())), given)
    return tuple(x for x in found if depends_on(x, q))


def _left_at_rest(free: System, given: Mapping[Node, Scalar], q: Sequence[Node]) -> ScalarRow:
    """sigma of the velocity rows at rest.

    Raises:
        DerivationError: a row that no place satisfies at rest.
    """
    rows = [row for row in free.constraints.closing if row.gap is None]
    left = substituted(tuple(row.velocity for row in rows), given)
    for row, x in zip(rows, left, strict=True):
        if not depends_on(x, q) and not is_zero(x) and not vanishes(x):
            what = f"'{row.constraint}' demands a velocity at every place: there is no equilibrium"
            raise DerivationError(
                what, f"constraints.{row.constraint}", "seek a steady motion: linearize --about steady"
            )
    return tuple(x for x in left if depends_on(x, q))


# -- what is held ------------------------------------------------------------------------------------


def _refuse_dry_friction(system: System) -> None:
    """Refuses Coulomb's friction, which holds a system at rest in a range of places.

    Raises:
        DerivationError: the contact is named.
    """
    rough = system.scope.model.rough_contacts
    if rough:
        what = f"'{rough[0].name}' has friction: it rests in a range of places, not in single ones"
        raise DerivationError(
            what, rough[0].declared_at, "leave the friction out, or ask at an instant which force it takes"
        )


def _at_rest(forces: ScalarRow, given: State, free: System) -> ScalarRow:
    """Forces with all speeds 0.

    Raises:
        DerivationError: one divides by a speed: it is named.
    """
    try:
        return substituted(forces, given)
    except DerivationError as error:

        def has_none(row: ScalarRow) -> bool:
            try:
                substituted(row, given)
            except DerivationError:
                return True
            return False

        what = f"{free.loads.acting(has_none) or 'a force'} has no value where nothing moves: {error.what}"
        fix = "write it so that it has one at rest: w/sqrt(w^2 + eps^2) in place of w/abs(w)"
        raise DerivationError(what, fix=fix) from error


def _rates_at_rest(standing: System, given: State) -> ScalarRow:
    """z' of the states of first order with all speeds and accelerations 0.

    Raises:
        DerivationError: one divides by a speed: it is named.
    """
    found: list[Scalar] = []
    for z, rate in zip(standing.symbols.z, standing.scope.state_rates, strict=True):
        try:
            found += substituted((rate,), given)
        except DerivationError as error:
            what = f"the rate of '{z.name}' has no value where nothing moves: {error.what}"
            raise DerivationError(what, f"states.{z.name}", "write it so that it has one at rest") from error
    return tuple(found)


def _refuse_signs_of_rates(Q: ScalarRow, free: System) -> None:
    """Refuses dry friction that is written as a force: -c*sign(x')."""
    u = free.symbols.u
    for node in order(Q):
        if node.op == "sign" and any(depends_on(a, u) for a in node.args):
            raise DerivationError(
                "a force jumps with the sign of a rate: at rest it may have any value in between",
                fix="leave it out where rest is sought",
            )


# -------- standing --------------------------------------------------------------------------------------------
# System -> the same as it stands at rest: over its rates alone, and its explicit times held at 0.
#
# At rest all rates are 0. A declared speed w = Y q' + y(q, t) is then y, and need not be constant: where y is not 0,
# rest means zero rates. A surface or a seat that moves with t stands where it is at t = 0, as the forces do.


def _made_of(free: System, scope: Scope) -> System:
    """The system of another scope over the rates, dependent coordinates eliminated."""
    scope = replace(scope, model=scope.model.altered(speeds=Table({})))
    motion = SystemScene.motion_of(scope)
    made = System(
        motion, Loads.of(motion, free.loads.begun, free.modes), Constraints.of(motion, modes=free.modes), free.modes
    )
    return made.reduced() if scope.dependent else made
