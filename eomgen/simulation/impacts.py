"""The impact of a motion: a model without its contacts that can end, their gaps, and what jumps where they close.

    M (u+ - u-) = J^T Lam,   J u+ + sigma = 0 of the constraints,   v+ >= - e v-, 0 <= Lam of the contacts

The laws stand in `mechanics.impacts`; without a coefficient of restitution e a contact that closes does not rebound.
Contacts that rebound without end come to rest at the limit instant: the k-th flight lasts 2 e^k v/g_n, where g_n does
not change, and all of them

    t + 2 v/(g_n (1 - e))

A flight lower than can be told from rounding is not followed: from there on the contact is closed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import System, assembled_by_recursion
from eomgen.mechanics.impacts import Hit, ImpactLaw, Jump
from eomgen.mechanics.kinematics import GROUND, SystemInertia
from eomgen.model import Contact
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.simulation.result import Impact
from eomgen.symbolic.expression import Expression, Scalar, Wrench, is_zero, jacobian, substituted
from eomgen.symbolic.numeric import tolerances


@dataclass(frozen=True)
class WithoutContacts:
    """A model without the contacts that can end.

    Args:
        system: it; the coordinates are those of every phase.
        contacts: the names of the constraints taken away.
        p: the parameters' values.
        made: objects that were made of it, which do not depend on these.
    """

    system: System
    contacts: tuple[str, ...]
    p: np.ndarray
    made: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    def gaps(self, t: float, values: Values) -> dict[str, tuple[float, float]]:
        """(gap, its rate) of every contact that can end; positive where it is open, and opening."""
        found = iter(self._gaps.many(t, self._x(values)[None, :], self.p)[0].tolist())
        gaps = {}
        for name, rows in self.rows.items():
            gap = values.get(PhaseModel.slack_name(name), 0.0) if rows[0].gap is None else next(found)
            gaps[name] = (gap, next(found))
        return gaps

    def after_impact(
        self, t: float, values: Values, touching: Sequence[str], resting: frozenset[str] = frozenset()
    ) -> tuple[dict[str, float], Impact]:
        """(the values after an impact of all contacts that touch: rates changed, places as they were; its record).

        Args:
            resting: contacts that touch and are at rest from here on: they hold.
        Raises:
            DerivationError: no impulses satisfy the law.
        """
        x, nu = self._x(values), len(self.system.symbols.u)
        found = self._matrices.many(t, x[None, :], self.p)[0]
        M, rows = found[: nu * nu].reshape(nu, nu), found[nu * nu :].reshape(-1, nu + 1)
        k = len(self.system.constraints.closing)
        of_contact, first = {}, k
        for name, own in self.rows.items():
            of_contact[name], first = rows[first : first + len(own)], first + len(own)
        e, mu = self.restitutions, self._frictions
        along = 2 if self._in_space else 1
        tangents = {name: rows[first + along * i : first + along * (i + 1)] for i, name in enumerate(mu)}
        hits = [
            Hit(name, of_contact[name], e.get(name, 0.0), name in resting, mu.get(name, 0.0), tangents.get(name))
            for name in touching
        ]
        u = x[len(self.system.symbols.q) :][:nu]
        rough = any(hit.mu and not hit.rests for hit in hits)
        after = Jump.of(M, rows[:k], hits, u, ImpactLaw.of(self.system.scope.model.impact, rough))
        size = tolerances.COMPUTED * max(1.0, float(np.max(np.abs(u), initial=0.0)))
        approached = [hit.name for hit in hits if hit.speed(u) < -size]
        impulses = {**self._named(after), **self.of_joints(t, values, after)}
        self._refuse_rubbing_joints(impulses)
        impact = Impact(t, ", ".join(approached), impulses, self._lost(t, x, after.u))
        rates = self._rates.many(t, self._with_speeds(x, after.u)[None, :], self.p)[0]
        changed = {f"{q.name}'": float(v) for q, v in zip(self.system.symbols.q, rates, strict=True)}
        speeds = {node.name: float(v) for node, v in zip(self.system.symbols.u, after.u, strict=True)}
        return {**values, **changed, **speeds}, impact

    def _refuse_rubbing_joints(self, impulses: Mapping[str, float]) -> None:
        """Refuses an impact that presses a joint whose friction goes by its force: an impulse there would rub too.

        A stop along a slide presses it by no impulse.
        Raises:
            DerivationError: the joint is named.
        """
        least = tolerances.COMPUTED * max(map(abs, impulses.values()), default=0.0)
        for body, part in self.system.scope.model.bodies.items():
            laws = [law for _, _, law in part.joint.frictions] if part.joint is not None else []
            if part.joint is not None and any(law.coulomb is not None for law in laws):
                turning = ("couple", "couple_x", "couple_y", "couple_z") if any(law.guide for law in laws) else ()
                pressed = [impulses.get(f"impulse_{k}({body})") for k in ("x", "y", "z", "n", *turning)]
                known = [x for x in pressed if x is not None]
                if part.joint.kind == "screw" or not known or max(map(abs, known)) > least:
                    what = f"the friction of '{body}' goes by the force in its joint: an impulse there would rub too"
                    raise DerivationError(what, f"bodies.{body}.joint", "give it a constant size")

    @property
    def restitutions(self) -> dict[str, float]:
        """The coefficient of restitution of each contact that has one.

        Raises:
            DerivationError: one is not between 0 and 1.
        """
        found = self._restitutions.many(0.0, np.zeros((1, len(self.system.symbols.x))), self.p)[0]
        for name, e in zip(self.rebounding, found.tolist(), strict=True):
            if not 0 <= e <= 1:
                what = f"the restitution of '{name}' is {e:.6g}"
                raise DerivationError(what, f"constraints.{name}", "between 0 (no rebound) and 1 (no loss)")
        return dict(zip(self.rebounding, found.tolist(), strict=True))

    @property
    def rebounding(self) -> dict[str, Expression]:
        """The contacts with a coefficient of restitution, and what is declared."""
        return {c.name: c.restitution for c in self.system.scope.model.contacts if c.restitution is not None}

    @property
    def _restitutions(self) -> RightHandSide:
        value = self.system.scope.value
        return self._function("restitutions", lambda: tuple(value(e) for e in self.rebounding.values()))

    def functions(self) -> dict[str, RightHandSide]:
        """Functions of the state that an impact needs: gaps with their rates, M with the rows, T, q', every e."""
        return {
            "gaps": self._gaps,
            "matrices": self._matrices,
            "energy": self._energy,
            "rates": self._rates,
            "restitutions": self._restitutions,
        }

    @property
    def _in_space(self) -> bool:
        return self.system.scope.model.space == "space"

    @property
    def rough(self) -> tuple[Contact, ...]:
        """The contacts whose friction has a part in their impacts: with a restitution, or under a declared law."""
        model = self.system.scope.model
        ending = [c for c in model.contacts if c.unilateral and c.mu is not None]
        return tuple(c for c in ending if c.restitution is not None or model.impact is not None)

    @property
    def _frictions(self) -> dict[str, float]:
        """The coefficient of friction of each of them."""
        value = self.system.scope.value
        function = self._function("frictions", lambda: tuple(value(c.mu) for c in self.rough))
        found = function.many(0.0, np.zeros((1, len(self.system.symbols.x))), self.p)[0]
        return dict(zip((c.name for c in self.rough), found.tolist(), strict=True))

    def _named(self, after: Jump) -> dict[str, float]:
        """The impulses by name: of a contact's first row its own."""
        found: dict[str, float] = {}
        for name, values in after.impulses.items():
            rows = self.rows[name]
            found |= {name if k == 0 else f"{name} {rows[k].component}": float(x) for k, x in enumerate(values)}
        for name, along in after.friction.items():
            labels = [f"{name} t"] if len(along) == 1 else [f"{name} t{k + 1}" for k in range(len(along))]
            found |= dict(zip(labels, along.tolist(), strict=True))
        return found | self.named_held(after.held.tolist())

    def named_held(self, impulses: Sequence[float]) -> dict[str, float]:
        """The impulses of the constraints that stay, by name."""
        several = [row.constraint for row in self.system.constraints.rows]
        found = {}
        for row, x in zip(self.system.constraints.closing, impulses, strict=True):
            alone = several.count(row.constraint) == 1 or not row.component
            found[row.constraint if alone else f"{row.constraint} {row.component}"] = x
        return found

    def of_joints(self, t: float, values: Values, after: Jump) -> dict[str, float]:
        """The impulses of the joints, each on its body: impulse_x(rod), of what holds it from turning impulse_couple.

        What the momenta of all that a joint carries gain, less the impulses of contacts and constraints on it:
        sum (m dv, d(I w) + r x m dv) - sum Lam W, about its place. A joint whose share is not determined is left out.
        """
        system = self.system
        given = any(force.placeless and force.moving for force in system.scope.model.forces.values())
        if given or any(not row.wrenches for row in system.constraints.rows):
            return {}  # what acts on coordinates acts on no body
        x, (acting, unknown) = self._x(values), self._acting(after)
        links, n = system.motion.links, len(system.motion.links)
        states = np.vstack([x, self._with_speeds(x, after.u)])
        before, later = (each.reshape(n, 9) for each in self._momenta.many(t, states, self.p))
        gained = later[:, :6] - before[:, :6]
        wrenches = iter(self._wrenches.many(t, x[None, :], self.p)[0].reshape(-1, 6))
        names = [link.name for link in links]
        for _, pushed in self._pushing:
            for body in pushed:
                gained[names.index(body)] -= acting.get(id(pushed), 0.0) * next(wrenches)
        carried = {k: {k} for k in range(n)}
        for k in reversed(range(n)):
            if links[k].parent != GROUND:
                gained[links[k].parent] += gained[k]
                carried[links[k].parent] |= carried[k]
        found: dict[str, float] = {}
        for k, components in self._held_by_joints.items():
            own = {names[j] for j in carried[k]}
            if all(own.isdisjoint(pushed) or (len(pushed) > 1 and own.issuperset(pushed)) for pushed in unknown):
                force, place = gained[k, :3], before[k, 6:]
                whole = np.concatenate([force, gained[k, 3:] - np.cross(place, force)])
                found |= {f"{label}({names[k]})": float(whole[i]) for label, i in components.items()}
        return found

    def _acting(self, after: Jump) -> tuple[dict[int, float], list[tuple[str, ...]]]:
        """({what pushes: its impulse}, the bodies on which impulses act that have no one value)."""
        closing = self.system.constraints.closing
        values: dict[tuple[str, Any], float] = {
            (name, k): x for name, own in after.impulses.items() for k, x in enumerate(own.tolist())
        }
        values |= {(name, f"t{k}"): x for name, own in after.friction.items() for k, x in enumerate(own.tolist())}
        values |= {(row.constraint, row): x for row, x in zip(closing, after.held.tolist(), strict=True)}
        known = {id(pushed): values.get(key, 0.0) for key, pushed in self._pushing}
        unknown = [tuple(pushed) for _, pushed in self._pushing if not np.isfinite(known[id(pushed)])]
        further = (row for row in self.system.constraints.rows if row.status != "closing")
        unknown += [tuple(dict(row.wrenches)) for row in further if row.wrenches]
        return {key: x for key, x in known.items() if np.isfinite(x)}, unknown

    @property
    def _pushing(self) -> list[tuple[tuple[str, Any], dict[str, Wrench]]]:
        """((whose, which of its rows), the wrench on each body for a unit of its impulse)."""
        closing, along = self.system.constraints.closing, range(2 if self._in_space else 1)
        found: list[tuple[tuple[str, Any], dict[str, Wrench]]] = self._once(
            "pushing",
            lambda: [
                *(((row.constraint, row), _summed(row.wrenches)) for row in closing),
                *(((name, k), _summed(row.wrenches)) for name, own in self.rows.items() for k, row in enumerate(own)),
                *(((contact.name, f"t{k}"), self._along(contact.name, k)) for contact in self.rough for k in along),
            ],
        )
        return found

    def _along(self, contact: str, k: int) -> dict[str, Wrench]:
        """The wrench on each body for a unit of the impulse along one tangent of a contact."""
        row = self.rows[contact][0]
        pushed = (self.system.motion.body_wrench(push) for push in (row.tangent, row.cross_tangent)[k])
        return _summed([each for each in pushed if each is not None])

    @property
    def _held_by_joints(self) -> dict[int, dict[str, int]]:
        """{number of a link: {impulse of its joint: place in (force, couple)}}, of joints that carry something."""
        found: dict[int, dict[str, int]] = {}
        forces, couples = ("impulse_x", "impulse_y", "impulse_z"), [f"impulse_couple_{axis}" for axis in "xyz"]
        for k, link in enumerate(self.system.motion.links):
            joint = link.joint
            columns = () if joint is None or not joint.carries_reaction else joint.complement(link.s, self._value)
            held = [any(not is_zero(column[i]) for column in columns) for i in range(6)]
            if self._in_space:
                turns, slides = any(held[:3]), any(held[3:])
                found[k] = dict(zip(forces, range(3), strict=True)) if slides else {}
                found[k] |= dict(zip(couples, range(3, 6), strict=True)) if turns else {}
            else:
                found[k] = {"impulse_x": 0, "impulse_y": 1} if any(held[3:5]) else {}
                found[k] |= {"impulse_couple": 5} if held[2] else {}
        return found

    @property
    def _value(self) -> Callable[[Any], Scalar]:
        return self.system.scope.value

    @property
    def _momenta(self) -> RightHandSide:
        """Momentum of each body, its moment about the origin, and the place of its joint, ground axes."""

        def entries() -> tuple[Scalar, ...]:
            motion, found = self.system.motion, list[Scalar]()
            fluids = [(*place, momentum) for _, place, _, momentum in SystemInertia(motion).fluids]
            for link in motion.links:
                mass = self.system.scope.mass_properties(link.name)
                P = mass.m * motion.velocity((link.name, mass.com))
                turning = link.pose.R @ (mass.I @ link.twist.w) + link.pose.point(mass.com).cross(P)
                for _, place, momentum in (fluid for fluid in fluids if fluid[0] == link.name):
                    own = momentum.turned(link.pose.R).moved(link.pose.point(place))
                    P, turning = P + own.f, turning + own.tau
                found += [*P, *turning, *link.pose.point(link.point)]
            return tuple(found)

        return self._function("momenta", entries)

    @property
    def _wrenches(self) -> RightHandSide:
        """Force and couple about the origin of each push, ground axes."""

        def entries() -> tuple[Scalar, ...]:
            found: list[Scalar] = []
            for _, pushed in self._pushing:
                for body, W in pushed.items():
                    pose = self.system.motion.link(body).pose
                    moved = W.turned(pose.R).moved(pose.p)
                    found += [*moved.f, *moved.tau]
            return tuple(found)

        return self._function("wrenches", entries)

    def _lost(self, t: float, x: np.ndarray, u: np.ndarray) -> float:
        """T before less T after."""
        T = self._energy.many(t, np.vstack([x, self._with_speeds(x, u)]), self.p)[:, 0]
        return float(T[0] - T[1])

    def _with_speeds(self, x: np.ndarray, u: np.ndarray) -> np.ndarray:
        """The state with other speeds."""
        q = len(self.system.symbols.q)
        return np.concatenate([x[:q], u, x[q + len(u) :]])

    def _x(self, values: Values) -> np.ndarray:
        symbols = self.system.symbols
        return np.array([values.get(node.name, 0.0) for node in symbols.x])

    def _once(self, key: str, make: Callable[[], Any]) -> Any:
        if key not in self.made:
            self.made[key] = make()
        return self.made[key]

    @property
    def rows(self) -> dict[str, tuple[Row, ...]]:
        """The rows of every contact that can end, the one that can end first."""
        found: dict[str, tuple[Row, ...]] = self._once(
            "rows", lambda: {name: Row.of_constraint(self.system.motion, name) for name in self.contacts}
        )
        return found

    @property
    def _gaps(self) -> RightHandSide:
        return self._function("gaps", self._open)

    @property
    def _energy(self) -> RightHandSide:
        return self._function("energy", lambda: (SystemInertia(self.system.motion).kinetic_energy,))

    @property
    def _rates(self) -> RightHandSide:
        return self._function("rates", lambda: self.system.scope.rates)

    @property
    def _matrices(self) -> RightHandSide:
        return self._function("matrices", self._entries)

    def _open(self) -> tuple[Scalar, ...]:
        requested: list[Scalar] = []
        for first, *_ in self.rows.values():
            requested += [first.velocity] if first.gap is None else [first.gap, first.velocity]
        return tuple(requested)

    def _entries(self) -> tuple[Scalar, ...]:
        """M, the rows (J, sigma) of the constraints that stay, of the contacts, and of sliding velocities."""
        M = tuple(x for row in assembled_by_recursion(self.system).M for x in row)
        rows = (*self.system.constraints.closing, *(row for own in self.rows.values() for row in own))
        touched = (self.rows[contact.name][0] for contact in self.rough)
        tangents = [v for row in touched for v in (row.sliding, row.across) if v is not None]
        return (*M, *self._with_bias([*(row.velocity for row in rows), *tangents]))

    def _with_bias(self, velocities: Sequence[Scalar]) -> list[Scalar]:
        """(J, sigma) of each row, J u + sigma its velocity."""
        u = self.system.symbols.u
        J = jacobian(tuple(velocities), u) if velocities else ()
        sigma = substituted(tuple(velocities), {node: 0 for node in u})
        return [x for row, bias in zip(J, sigma, strict=True) for x in (*row, bias)]

    def _function(self, key: str, scalars: Callable[[], tuple[Scalar, ...]]) -> RightHandSide:
        found: RightHandSide = self._once(
            key,
            lambda: RightHandSide.of(Program.of(scalars(), self.system.symbols, inputs=self.system.inputs), "numpy"),
        )
        return found


def _summed(wrenches: Sequence[tuple[str, Wrench]]) -> dict[str, Wrench]:
    """The sum of the wrenches on each body."""
    found: dict[str, Wrench] = {}
    for body, W in wrenches:
        found[body] = W if body not in found else found[body].plus(W)
    return found
