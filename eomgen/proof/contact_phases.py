"""Contacts along a run, and the laws of friction.

The phases of a run -> checks: the contacts in each, and the changes of momentum between them by impulses alone.

    closed, can end or slide  push N >= 0             open     gap >= 0
    sticks                     |F| <= mu |N|           slides   sense v >= 0
    from phase to phase        dP_k = sum_b m dv . dv/du_k + I dw . dw/du_k + armature ds' ds'/du_k
                               dP in span(constraints) + cone(contacts that touch, with v+ = - e min(v-, 0) after),
                               v+ >= - e min(v-, 0),   v = J u + sigma

The momenta are those of the bodies, by their twists; M, the impulses and the functions that end a phase are not used.
N and F are the columns of reactions. Where no restitution is declared e = 0. A contact whose next flight would be lower
than can be told from rounding need not rebound.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import pairwise
from typing import Any, Protocol

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.free_bodies import Reactions, SystemFriction
from eomgen.mechanics.kinematics import ContactMode, SystemInertia
from eomgen.mechanics.start import Start
from eomgen.model import Contact
from eomgen.proof.check import Check, Tally
from eomgen.proof.impacts import Touched, after_impact, around
from eomgen.proof.posed_model import misplaced
from eomgen.proof.states import InNumbers, own_start
from eomgen.simulation import Phase, PhaseModel, ReactionColumns
from eomgen.symbolic.expression import Scalar, State, is_zero
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

STATES = 100  # of a phase that are looked at
MOST_IMPULSES = 20  # of joints that are looked at
STEPPED = 0.01  # of the speeds before: so far the result of small steps may be off
LOW = 1e2 * tolerances.COMPUTED  # [of the coordinates] a flight that need not be followed


# -- within a phase --------------------------------------------------------------------------------


def contacts_do_as_assumed(phases: Sequence[Phase]) -> Iterator[Check]:
    """Check that each contact presses, grips, slides or is open as its phase assumes; none without contacts."""
    tally = Tally("contacts press, grip, slide or are open as their phase assumes", "reactions of the bodies")
    for phase in phases:
        seen = _Seen(phase)
        for contact in phase.model.contacts:
            tally.add(f"{contact.words} from {phase.start:.6g} s", partial(seen.wrong, contact))
    return tally.checks()


@dataclass(frozen=True)
class _Seen:
    """States of one phase."""

    phase: Phase

    @property
    def model(self) -> PhaseModel:
        found: PhaseModel = self.phase.model
        return found

    @cached_property
    def track(self) -> tuple[np.ndarray, np.ndarray]:
        assert self.phase.track is not None
        t, x = self.phase.track
        places = np.unique(np.linspace(0, len(t) - 1, STATES).astype(int))
        return t[places], x[places]

    def wrong(self, contact: Contact) -> str:
        """Message if a contact does otherwise than its phase assumes; "".

        Raises:
            NoValue: its forces have no single value.
        """
        mode = self.model.watch.mode(contact)
        if not mode.closed:
            return self._least("it is passed through by", self._gap(contact), self._size("places"), "m")
        normals = self._normals(contact)
        signed = contact.unilateral or (mode.sense != 0 and contact.holds_both_ways)
        pressed = mode.push * normals if signed else normals[:0]
        wrong = self._least("it would have to pull by", pressed, self._most, "N")
        if contact.grip is None or wrong:
            return wrong
        system = self.model.system
        if mode.sense == 0:
            whole = np.hypot.reduce(normals, axis=0) if len(normals) else 1.0
            grip = self._along(system.scope.value(contact.grip)) * whole
            held = np.hypot.reduce(self._forces(contact, ("t", "s", "friction")), axis=0)
            return self._least("it sticks beyond its grip by", grip - held, self._most, "N")
        v = (mode.sense or 0) * self._along(system.sliding_velocity(contact))
        return self._least("it slides against its sense by", v, self._size("rates"), "m/s")

    def _least(self, what: str, values: np.ndarray, size: float, unit: str) -> str:
        least = float(np.nanmin(values, initial=0.0))
        return f"{what} {-least:.3g} {unit}" if least < -tolerances.OPEN_GAP * size else ""

    def _along(self, scalar: Scalar) -> np.ndarray:
        t, x = self.track
        functions = self.model.functions
        return functions.kinematic((scalar,)).many(t, functions.inner(x), self.model.p)[:, 0]

    def _gap(self, contact: Contact) -> np.ndarray:
        gap = Row.of_constraint(self.model.system.motion, contact.name)[0].gap
        if gap is not None:
            return self._along(gap)
        return self.model.functions.slacks(self.track[1])[:, self.model.loose.index(contact.name)]

    def _size(self, what: str) -> float:
        n, k = self.model.functions.places, len(self.model.equations.symbols.u)
        x = self.track[1]
        return max(1.0, float(np.max(np.abs(x[:, :n] if what == "places" else x[:, n : n + k]), initial=0.0)))

    @cached_property
    def _columns(self) -> tuple[tuple[str, ...], np.ndarray]:
        t, x = self.track
        columns = ReactionColumns(self.model.reactions, self.model.functions.rhs)
        return columns.names, columns.along(t, self.model.functions.inner(x), self.model.p)

    @property
    def _most(self) -> float:
        """The largest force or couple of the phase; of what moves freely T over 1 rad or 1 m."""
        t, x = self.track
        T = self.model.functions.energies.many(t, self.model.functions.inner(x), self.model.p)[:, 0]
        return max(float(np.nanmax(np.abs(self._columns[1]), initial=0.0)), float(np.max(T, initial=0.0)))

    def _normals(self, contact: Contact) -> np.ndarray:
        """Components of the normal force, k x n; none of a joint with friction of constant size."""
        if contact.size is not None:
            return np.zeros((0, len(self.track[0])))
        labels = {c.label for c in self.model.reactions.components if c.owner == contact.body}
        if "wrench 1" in labels:
            return self._on_flanks(contact)
        if contact.guide is not None or "n 1" in labels:
            return self._at_ends(contact)
        return self._forces(contact, ("n", "n 1", "n 2", "tension", "couple", *("xyz" if contact.of_joint else "")))

    def _on_flanks(self, contact: Contact) -> np.ndarray:
        """The force of a thread's flanks as it is felt along the axis, 1 x n: all of R along it, less what friction
        takes of that, h/(r^2 + h^2) of the friction along the angle."""
        link, value = self.model.system.motion.link(contact.body), self.model.system.scope.value
        axis = np.array([self._along(x) for x in link.pose.R @ link.S[contact.variable][0]])
        h, r = (self._along(value(x)) for x in (link.joint.pitch, link.joint.friction.radius))
        names, found = self._columns
        R = found[:, [names.index(f"reaction_{k}({contact.body})") for k in "xyz"]].T
        F = self._forces(contact, ("friction",))[0] if self.model.watch.mode(contact).sense == 0 else 0.0
        return np.asarray((np.sum(R * axis, axis=0) - F * h / (r * r + h * h))[None, :])

    def _at_ends(self, contact: Contact) -> np.ndarray:
        """Load of a slide or path across its way, 1 x n: |F|, of a guide |F/2 + M x n/L| + |F/2 - M x n/L|."""
        columns = dict(zip(self._columns[0], self._columns[1].T, strict=True))
        plane = self.model.system.scope.model.space == "plane"
        labels = (["n"], ["couple"]) if plane else ([*"xyz"], ["couple_x", "couple_y", "couple_z"])
        none = np.zeros(len(self.track[0]))  # what is not reported is not carried
        F, M = (np.array([columns.get(f"reaction_{x}({contact.body})", none) for x in each]) for each in labels)
        if not plane:  # both turned about the way by a quarter
            link = self.model.system.motion.link(contact.body)
            way = np.array([self._along(x) for x in link.pose.R @ link.S[contact.variable][1]])
            n = way / np.linalg.norm(way, axis=0)
            F, M = np.cross(F, n, axis=0), np.cross(n, np.cross(M, n, axis=0), axis=0)
        if np.isnan(F).all():
            raise NoValue("its force has no single value")
        if contact.guide is None:
            return np.asarray([np.linalg.norm(F, axis=0)])
        F, M = F / 2, M / self._along(self.model.system.scope.value(contact.guide))
        return np.asarray([np.linalg.norm(F + M, axis=0) + np.linalg.norm(F - M, axis=0)])

    def _forces(self, contact: Contact, labels: tuple[str, ...]) -> np.ndarray:
        """Components of a contact's force, k x n; nan where it has no single value."""
        kind = "joint" if contact.of_joint and labels[0] == "n" else "constraint"
        owner = contact.body if kind == "joint" else contact.name
        mine = [c for c in self.model.reactions.components if c.owner == owner and c.kind == kind]
        names, found = self._columns
        requested = [names.index(c.name) for c in mine if c.label in labels]
        if not requested or np.isnan(found[:, requested]).all():
            raise NoValue("its force has no single value")
        return found[:, requested].T


def bodies_stand_as_reported(phases: Sequence[Phase], apart: System) -> Iterator[Check]:
    """Check that bodies stand in every phase where the whole model has them, and where their joints say.

    Args:
        apart: the model without its contacts that can end, all pieces of its paths in it.
    """
    tally = Tally("bodies stand in every phase as their joints are declared", "50 digits")
    for phase in phases:
        tally.add(f"from {phase.start:.6g} s", partial(_misplaced, phase, apart))
    return tally.checks()


def _misplaced(phase: Phase, apart: System) -> str:
    """Message if a body stands elsewhere at the beginning, the middle or the end of a phase; ""."""
    assert phase.track is not None
    own: System = phase.model.system
    for row in sorted({0, len(phase.track[0]) // 2, len(phase.track[0]) - 1}):
        t, x = float(phase.track[0][row]), phase.track[1][row]
        values = phase.model.values(t, x)
        known, here = (_state(system, values, phase.model.p, t) for system in (apart, own))
        if wrong := misplaced(apart, known):
            return wrong
        for link in own.motion.links:
            there = evaluate(apart.motion.link(link.name).pose.p, known, fifty_digits())
            gap = max(abs(x - y) for x, y in zip(evaluate(link.pose.p, here, fifty_digits()), there, strict=True))
            if gap > tolerances.OPEN_GAP * (1 + max(map(abs, there))):
                return f"'{link.name}' is {float(gap):.3g} m from where it is in all phases"
    return ""


def _state(system: System, values: Mapping[str, float], p: np.ndarray, t: float) -> State:
    """State of the run with 50 digits; quaternions of doubles are normalized, as their norm is off by 1e-16."""
    symbols = system.symbols
    known = {node: fifty_digits().number(values.get(node.name, 0.0)) for node in symbols.x}
    known |= system.scope.on_unit_norms(known)
    given = zip(symbols.parameters.values(), p, strict=True)
    return {**known, symbols.t: fifty_digits().number(t)} | {node: fifty_digits().number(float(x)) for node, x in given}


# -- from phase to phase ---------------------------------------------------------------------------


class Reported(Protocol):
    """An impact as it is reported: impulses by name, the kinetic energy lost [J]."""

    @property
    def impulses(self) -> dict[str, float]: ...

    @property
    def loss(self) -> float: ...


def changes_follow_impulses(
    phases: Sequence[Phase],
    apart: System,
    contacts: Sequence[str],
    impacts: Mapping[float, Reported],
) -> Iterator[Check]:
    """Check that only constraints, and contacts that touch, change the momentum between phases; none with one phase.

    Args:
        apart: the model without its contacts that can end.
        contacts: their names.
        impacts: by their instants, as they are reported: their impulses and losses are held against the momenta and
            the energies of the bodies.
    """
    tally = Tally("changes of contact follow impulses that only push", "momenta of the bodies")
    joints = Tally("impulses of joints change the momenta of the bodies", "momenta of the bodies")
    reported = Tally("impulses and losses of impacts are those of their speeds", "momenta and energies of the bodies")
    for before, after in pairwise(phases):
        bodies, impact = _Bodies(apart, tuple(contacts), before, after), impacts.get(after.start)
        own = {} if impact is None else impact.impulses
        tally.add(f"t = {after.start:.6g} s", bodies.wrong)
        if impact is not None:
            reported.add(f"t = {after.start:.6g} s", partial(bodies.reported_otherwise, impact))
        for body in bodies.on_joints_alone(own) if joints.held < MOST_IMPULSES else ():
            joints.add(f"{body}, t = {after.start:.6g} s", partial(bodies.gains_otherwise, body, own))
    yield from (*tally.checks(), *reported.checks(), *joints.checks())


@dataclass(frozen=True)
class _Bodies:
    """The bodies at one change of phase, their contacts taken away."""

    system: System
    contacts: tuple[str, ...]
    before: Phase
    after: Phase

    def wrong(self) -> str:
        """Message if the change of state violates the law of impact; ""."""
        q = len(self.system.symbols.q)
        early, late = self._state(self._end), self._state(self._begin)
        size = max(1.0, float(np.max(np.abs([early, late]))))
        if np.max(np.abs(early[:q] - late[:q]), initial=0.0) > tolerances.OPEN_GAP * size:
            return "a coordinate jumps"
        pushes, frees = [], [J for J, _ in self._rows_at(self.system.constraints.closing, late)]
        still = np.array_equal(early, late)
        e, mu, exactly, rubs = self._restitutions, self._frictions, self._rebounds_exactly, False
        for name, rows in self._rows.items():
            found = self._rows_at(rows, late)
            speeds = [v for _, v in found]
            if not self._touches(name, rows) or (still and self._stays_open(name)):
                continue
            approach = self._rows_at(rows[:1], early)[0][1]
            due = -e.get(name, 0.0) * min(approach, 0.0) * (exactly and name not in mu)
            rests = abs(speeds[0]) <= tolerances.OPEN_GAP * size and name not in self.after.model.configuration.open
            if rests and self._is_low(rows[0], early, max(due, abs(approach))):  # it holds on, where it would bounce on
                frees.append(found[0][0])
                due = 0.0
            if speeds[0] - due < -tolerances.OPEN_GAP * size:
                wrong = "is still approached with" if speeds[0] < 0 and not due else "rebounds too slowly, by"
                return f"'{name}' {wrong} {due - speeds[0]:.3g} m/s"
            if name in mu:
                along, n = [t for t, _ in self._sliding_rows(rows[0], late)], found[0][0]
                pushes += [n + mu[name] * t for t in around(along)]
                rubs = True
            elif speeds[0] - due <= tolerances.OPEN_GAP * size or not exactly:
                pushes.append(found[0][0])
                frees += [J for J, v in found[1:] if abs(v) <= tolerances.OPEN_GAP * size]
        otherwise = self._otherwise_by_iteration(early, late) if rubs else ""
        return otherwise or self._left(pushes, frees, early, late)

    def reported_otherwise(self, impact: Reported) -> str:
        """Message if the reported impulses do not change the momenta to those of the speeds, or the loss is another.

        M (u+ - u-) = J^T Lam,   T- - T+ = loss

        Raises:
            NoValue: impulses have no single values.
        """
        early, late = self._state(self._end), self._state(self._begin)
        n = len(self.system.symbols.u)
        units = self._momenta(late, [*np.eye(n), np.zeros(n)])
        M, (before, after) = units[:-1] - units[-1], (x[len(self.system.symbols.q) :][:n] for x in (early, late))
        T = SystemInertia(self.system.motion).kinetic_energy
        lost = float(np.diff(self._numbers((T,), np.array([late, early]))[:, 0])[0])
        if abs(lost - impact.loss) > tolerances.CARRIED * (1 + abs(lost) + float(before @ M @ before)):
            return f"{lost:.6g} J of kinetic energy are lost, and {impact.loss:.6g} J are reported"
        pushed, pushes = np.zeros(n), self._reported_pushes(late)
        for name, x in impact.impulses.items():
            if name in pushes and not np.isfinite(x):
                raise NoValue("impulses have no single values")
            pushed = pushed + x * pushes.get(name, np.zeros(n))
        gained = M @ (after - before)
        if np.max(np.abs(gained - pushed), initial=0.0) > tolerances.OPEN_GAP * (1 + float(np.max(np.abs(gained)))):
            k = int(np.argmax(np.abs(gained - pushed)))
            along = self.system.symbols.u[k].name
            return f"along {along} the momentum changes by {gained[k]:.6g}, the reported impulses give {pushed[k]:.6g}"
        return ""

    def _reported_pushes(self, state: np.ndarray) -> dict[str, np.ndarray]:
        """J of each impulse by the name under which it is reported."""
        found: dict[str, np.ndarray] = {}
        for name, rows in self._rows.items():
            for k, (row, (J, _)) in enumerate(zip(rows, self._rows_at(rows, state), strict=True)):
                found[name if k == 0 else f"{name} {row.component}"] = J
            along = [J for J, _ in self._sliding_rows(rows[0], state)] if name in self._frictions else []
            labels = [f"{name} t"] if len(along) == 1 else [f"{name} t{k}" for k in range(1, len(along) + 1)]
            found |= dict(zip(labels, along, strict=True))
        closing, several = self.system.constraints.closing, [row.constraint for row in self.system.constraints.rows]
        for row, (J, _) in zip(closing, self._rows_at(closing, state), strict=True):
            alone = several.count(row.constraint) == 1 or not row.component
            found[row.constraint if alone else f"{row.constraint} {row.component}"] = J
        return found

    def on_joints_alone(self, impulses: Mapping[str, float]) -> list[str]:
        """The bodies on which joints act in an impact, all with their impulses, and no force of anything else."""
        rows = (*self.system.constraints.rows, *(row for own in self._rows.values() for row in own))
        pushed = {name for row in rows for name, W in row.wrenches if any(not is_zero(x) for x in W.f)}
        joints = (name for name in self._joints_at if name not in pushed)
        return [name for name in joints if all(f"impulse_x({x})" in impulses for x in self._joints_at[name])]

    @property
    def _joints_at(self) -> dict[str, list[str]]:
        """Joint of each body and those that it carries, by their bodies."""
        links = self.system.motion.links
        carried = {link.name: [x.name for x in links if x.parent == k] for k, link in enumerate(links)}
        return {name: [name, *others] for name, others in carried.items()}

    def gains_otherwise(self, body: str, impulses: Mapping[str, float]) -> str:
        """Message if m (v+ - v-) of a body's mass centre is not its joint's impulse less those that it carries; ""."""
        mass = self.system.scope.mass_properties(body)
        momentum = tuple(mass.m * x for x in self.system.motion.velocity((body, mass.com)))
        early, late = self._numbers(momentum, np.array([self._state(self._end), self._state(self._begin)]))
        own, *carried = self._joints_at[body]
        for axis, change in zip("xyz", (late - early).tolist(), strict=True):
            parts = [impulses.get(f"impulse_{axis}({own})", 0.0)]
            parts += [-impulses.get(f"impulse_{axis}({name})", 0.0) for name in carried]
            if abs(change - sum(parts)) > tolerances.OPEN_GAP * (1 + sum(map(abs, parts))):
                return f"along {axis} its momentum changes by {change:.6g}, its joints give {sum(parts):.6g}"
        return ""

    def _left(self, pushes: list[np.ndarray], frees: list[np.ndarray], early: np.ndarray, late: np.ndarray) -> str:
        """Message if no impulses give the change of momentum: min |J^T Lam - dP|, in units of sqrt(J); ""."""
        from scipy.optimize import nnls

        n = len(self.system.symbols.u)
        units = self._momenta(late, [*np.eye(n), np.zeros(n)])
        speeds = [state[len(self.system.symbols.q) :][:n] for state in (early, late)]
        P = self._momenta(late, speeds)
        M = units[:-1] - units[-1]
        gained = float((speeds[1] @ M @ speeds[1] - speeds[0] @ M @ speeds[0]) / 2)
        least = tolerances.UNBALANCED * float(speeds[0] @ M @ speeds[0])
        judged = self._frictions or not self._rebounds_exactly
        if judged and gained > least and not np.any(self._biases(late)):
            return f"the impact gains {gained:.3g} J"
        found, V = np.linalg.eigh((M + M.T) / 2)
        held = found > tolerances.SUMMED * max(found, default=0.0)
        whiten = (V[:, held] / np.sqrt(found[held])).T
        rows = [*pushes, *frees, *(-J for J in frees)]
        columns = np.array(rows).reshape(len(rows), n) @ whiten.T
        change = whiten @ (P[1] - P[0])
        left = nnls(columns.T, change)[1] if len(columns) else float(np.linalg.norm(change))
        fastest = max(1.0, float(np.max(np.abs(speeds), initial=0.0)))
        if left > tolerances.UNBALANCED * fastest * float(np.sqrt(np.trace(M))):
            return f"no impulses that only push give the change of momentum: {left:.3g} sqrt(J) are left"
        return ""

    @property
    def _rebounds_exactly(self) -> bool:
        """True if each contact leaves with e times its approach: Newton's law, all at once."""
        rules = self.system.scope.model.impact
        return rules is None or (rules.law in (None, "newton") and rules.order == "simultaneous")

    def _biases(self, state: np.ndarray) -> np.ndarray:
        """sigma of every row: the speeds that are given."""
        rows = (*self.system.constraints.closing, *(row for own in self._rows.values() for row in own))
        still = self._with(state, [np.zeros(len(self.system.symbols.u))])
        return self._numbers(tuple(row.velocity for row in rows), still)[0] if rows else np.zeros(0)

    def _sliding_rows(self, row: Row, state: np.ndarray) -> list[tuple[np.ndarray, float]]:
        """(J, J u + sigma) of the sliding velocity of a contact, in space along two directions."""
        n = len(self.system.symbols.u)
        along = tuple(v for v in (row.sliding, row.across) if v is not None)
        found = self._numbers(along, self._with(state, [*np.eye(n), np.zeros(n)]))
        return list(zip((found[:-1] - found[-1]).T, self._numbers(along, state[None])[0].tolist(), strict=True))

    @property
    def _frictions(self) -> dict[str, float]:
        """mu of each contact whose friction has a part in its impacts: with a restitution, or under a declared law."""
        model = self.system.scope.model
        rough = [c for c in model.contacts if c.unilateral and c.mu is not None]
        declared = {
            c.name: self.system.scope.value(c.mu)
            for c in rough
            if c.restitution is not None or model.impact is not None
        }
        found = self._numbers(tuple(declared.values()), self._state(self._end)[None])[0] if declared else ()
        return dict(zip(declared, map(float, found), strict=True))

    def _otherwise_by_iteration(self, early: np.ndarray, late: np.ndarray) -> str:
        """Message if small steps of the impulse, of several contacts iterated impulses, give other speeds; "".

        Of several that are hit one after the other momentum and energy are looked at alone.
        """
        rules = self.system.scope.model.impact
        names = [name for name, own in self._rows.items() if self._touches(name, own)]
        found = [self._speeds_of(name, early) for name in names]
        v, there = (np.concatenate([x for x, _ in each]) for each in (found, [self._speeds_of(n, late) for n in names]))
        approach = {name: -float(x[0]) for name, (x, _) in zip(names, found, strict=True)}
        low = (x > 0 and self._is_low(self._rows[name][0], early, x) for name, x in approach.items())
        if any(low) or (len(names) > 1 and rules is not None and rules.order == "sequential"):
            return ""
        law = "poisson" if rules is None or rules.law is None else rules.law
        kinds = [Touched(self._frictions.get(name, 0.0), self._restitutions.get(name, 0.0), len(x))
                 for name, (x, _) in zip(names, found, strict=True)]  # fmt: skip
        D = self._for_impulses(late, tuple(row for _, rows in found for row in rows))
        due = after_impact(D, v, kinds, law)
        if due is not None and np.max(np.abs(due - there)) > STEPPED * np.sum(np.abs(v)):
            said, iterated = (", ".join(f"{x:.4g}" for x in each) for each in (there, due))
            return f"{', '.join(names)}: normal and sliding speeds are {said} m/s, by iteration {iterated}"
        return ""

    def _speeds_of(self, name: str, state: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """((v_n, v_t) of a contact, the rows of these)."""
        row = self._rows[name][0]
        along = self._sliding_rows(row, state) if name in self._frictions else []
        pairs = [*self._rows_at((row,), state), *along]
        return np.array([v for _, v in pairs]), [J for J, _ in pairs]

    def _for_impulses(self, state: np.ndarray, rows: tuple[np.ndarray, ...]) -> np.ndarray:
        """Changes of (v_n, v_t) for unit impulses along n and the tangents, the constraints held."""
        n = len(self.system.symbols.u)
        units = self._momenta(state, [*np.eye(n), np.zeros(n)])
        held = np.array([J for J, _ in self._rows_at(self.system.constraints.closing, state)]).reshape(-1, n)
        matrix = np.block([[units[:-1] - units[-1], held.T], [held, np.zeros((len(held), len(held)))]])
        along = np.array(rows)
        right = np.vstack([along.T, np.zeros((len(held), len(rows)))])
        return np.asarray(along @ np.linalg.lstsq(matrix, right, rcond=None)[0][:n])

    @property
    def _restitutions(self) -> dict[str, float]:
        """The declared coefficient of each contact that has one."""
        contacts = self.system.scope.model.contacts
        declared = {c.name: self.system.scope.value(c.restitution) for c in contacts if c.restitution is not None}
        found = self._numbers(tuple(declared.values()), self._state(self._end)[None])[0] if declared else ()
        return dict(zip(declared, map(float, found), strict=True))

    def _is_low(self, row: Row, early: np.ndarray, due: float) -> bool:
        """True if a flight begun with this speed would be lower than can be told from rounding: v^2 <= 2 |g_n| h."""
        assert self.before.track is not None
        t, x = (values[-1] for values in self.before.track)
        later = x - tolerances.SOON * self.before.model.rate(float(t), x)
        state = self._state(self.before.model.values(float(t), later))
        rows = [row, *(own[0] for own in self._rows.values())]  # where others close too it falls as fast as these
        pairs = zip(self._rows_at(rows, early), self._rows_at(rows, state), strict=True)
        fastest = max(abs(v - earlier) for (_, v), (_, earlier) in pairs)
        height = LOW * max(1.0, float(np.max(np.abs(early), initial=0.0)))
        return due * due <= 2 * fastest / tolerances.SOON * height

    @property
    def _end(self) -> Mapping[str, float]:
        return self._values(self.before, -1)

    @property
    def _begin(self) -> Mapping[str, float]:
        return self._values(self.after, 0)

    def _values(self, phase: Phase, row: int) -> Mapping[str, float]:
        assert phase.track is not None
        t, x = phase.track
        found: Mapping[str, float] = phase.model.values(float(t[row]), x[row])
        return found

    def _state(self, values: Mapping[str, float]) -> np.ndarray:
        symbols = self.system.symbols
        return np.array([values.get(node.name, 0.0) for node in symbols.x])

    @cached_property
    def _rows(self) -> dict[str, tuple[Row, ...]]:
        return {name: Row.of_constraint(self.system.motion, name) for name in self.contacts}

    def _stays_open(self, name: str) -> bool:
        return all(name in phase.model.configuration.open for phase in (self.before, self.after))

    def _touches(self, name: str, rows: Sequence[Row]) -> bool:
        """True if a contact is closed before or after, or its gap is 0."""
        if any(name not in phase.model.configuration.open for phase in (self.before, self.after)):
            return True
        gap = self._end.get(PhaseModel.slack_name(name), 0.0)
        if rows[0].gap is not None:
            gap = float(self._numbers((rows[0].gap,), self._state(self._end)[None])[0, 0])
        if name in self._restitutions:  # its flights are followed down to these
            return abs(gap) <= 10 * tolerances.LOWEST_FLIGHT * max(1.0, float(np.max(np.abs(self._state(self._end)))))
        return abs(gap) <= tolerances.OPEN_GAP

    def _rows_at(self, rows: Sequence[Row], state: np.ndarray) -> list[tuple[np.ndarray, float]]:
        """(J, J u + sigma) of each row."""
        if not rows:
            return []
        n = len(self.system.symbols.u)
        found = self._numbers(tuple(row.velocity for row in rows), self._with(state, [*np.eye(n), np.zeros(n)]))
        now = self._numbers(tuple(row.velocity for row in rows), state[None])[0]
        return list(zip((found[:-1] - found[-1]).T, map(float, now), strict=True))

    def _momenta(self, state: np.ndarray, speeds: Sequence[np.ndarray]) -> np.ndarray:
        """sum_b m v . dv/du_k + I w . dw/du_k + armature s' ds'/du_k with some speeds, one row each."""
        n = len(self.system.symbols.u)
        found = self._numbers(self._moving, self._with(state, [*speeds, *np.eye(n), np.zeros(n)]))
        motions, pushes = found[:, : len(self._moving) // 2], found[: len(speeds), len(self._moving) // 2 :]
        return np.asarray(pushes @ (motions[len(speeds) : -1] - motions[-1]).T)

    @cached_property
    def _moving(self) -> tuple[Scalar, ...]:
        """v, w, s' of everything that has mass, and then its momenta in the same order."""
        motions: list[Scalar] = []
        momenta: list[Scalar] = []
        for link in self.system.motion.links:
            mass = self.system.scope.mass_properties(link.name)
            v = self.system.motion.velocity((link.name, mass.com))
            motions += [*v, *link.twist.w]
            momenta += [mass.m * x for x in v] + list(mass.I @ link.twist.w)
        for link, k, armature in SystemInertia(self.system.motion).rotors:
            motions.append(link.s_rate[k])
            momenta.append(armature * link.s_rate[k])
        motions += self.system.scope.rates
        momenta += SystemInertia(self.system.motion).given_momenta
        return (*motions, *momenta)

    def _with(self, state: np.ndarray, speeds: Sequence[np.ndarray]) -> np.ndarray:
        """The state with other speeds, one row each."""
        q = len(self.system.symbols.q)
        return np.array([[*state[:q], *u, *state[q + len(u) :]] for u in speeds])

    def _numbers(self, scalars: tuple[Scalar, ...], x: np.ndarray) -> np.ndarray:
        function: RightHandSide = RightHandSide.of(
            Program.of(scalars, self.system.symbols, inputs=self.system.inputs), "numpy"
        )
        return function.many(self.after.start, x, self.after.model.p)


# -------- friction laws ---------------------------------------------------------------------------------------
# Equations, state -> whether friction is that of the declared coefficients, and contacts are as they start.
#
# |F| = mu |N|, or c |N| |v|;    a contact that holds both ways pushes at the start as its friction takes it to; one
# that can end and is closed does not open there:   gap' <= 0 at the speeds of the start, such contacts open


OPEN = ContactMode(closed=False)


def other_friction(system: System, state: State) -> str:
    """Message that names a contact whose friction is not of a coefficient declared for it; "".

    Raises:
        NoValue: something has no value there.
    """
    proof, surfaces = InNumbers(system, state), {row.constraint for row in system.constraints.rows if row.shares}
    for name, factor, sliding in SystemFriction(system).named:
        found, v = proof.at((factor, sliding))
        along = 1 if name in surfaces else abs(v)  # on a surface viscous friction is for a unit of v
        slides = (
            bool(system.modes.get(name, ContactMode()).sense) or along != 0
        )  # in a phase it slides one way, also from rest
        due = [*_declared(proof, name, along, slides)]
        due = [_by_euler(proof, rope) * slides] if (rope := _rope(system, name)) is not None else due
        if all(abs(abs(found) - x) > tolerances.ZERO_AT_50 * (1 + x) for x in due):
            return f"the friction of '{name}' is {float(abs(found)):.10g} times its normal force, not as declared"
    return ""


def _rope(system: System, name: str) -> Any:
    """A rope on a drum by its name; None of another contact."""
    constraint = system.scope.model.constraints.get(name)
    return constraint if constraint is not None and constraint.exponent is not None else None


def _by_euler(proof: InNumbers, rope: Any) -> Any:
    """|F|/T with T_1 = e^(mu phi) T_2, F = T_1 - T_2, T = (T_1 + T_2)/2."""
    mu, phi = proof.at(tuple(map(proof.system.scope.value, (rope.coefficient, rope.angle))))
    ratio = fifty_digits().functions["exp"](mu * phi)
    return 2 * (ratio - 1) / (ratio + 1)


def _declared(proof: InNumbers, name: str, speed: Any, slides: bool) -> Iterator[Any]:
    """|F|/|N| by the friction laws of a constraint, or of the pieces of a path; 0 without one."""
    model, scope = proof.system.scope.model, proof.system.scope
    if name in model.constraints:
        laws: list[Any] = [getattr(model.constraints[name], "friction", None)]
    else:
        joint: Any = model.bodies[name].joint
        laws = [piece.friction for piece in getattr(joint, "pieces", ())] + [law for _, _, law in joint.frictions]
    for law in laws:
        smooth, own = getattr(law, "smooth", None), [getattr(law, x, None) for x in ("coefficient", "radius")]
        if law is None:
            yield 0
        elif law.coulomb is None:
            yield abs(proof.one(scope.value(law.viscous))) * speed
        else:  # of a joint: mu, and of a hinge r
            sizes = [proof.one(scope.value(x)) for x in (own if own[0] is not None else [law.coulomb]) if x]
            tanh = fifty_digits().functions["tanh"]
            yield abs(math.prod(sizes)) * (slides if smooth is None else tanh(speed / proof.one(scope.value(smooth))))


def leaving_at_start(equations: EquationsOfMotion) -> str:
    """Message that names a closed contact, of those that can end, which leaves its surface at the start; "".

    Raises:
        NoValue: the start is not known in numbers, or something has no value there.
    """
    system = equations.system
    model, modes = system.scope.model, system.modes
    ending = [c.name for c in model.contacts if c.unilateral and modes.get(c.name, ContactMode()) == ContactMode()]
    if not ending or not model.coordinates or len(model.exact_parameters()) < len(model.parameters):
        return ""
    try:
        free = System.of(model, {**modes, **dict.fromkeys(ending, OPEN)})
        start = Start.of(free)
    except (DerivationError, ModelError, UsageError) as error:
        raise NoValue(str(error).splitlines()[0]) from None
    given = {x.name for x in free.symbols.q}
    if any(change.name in given for change in start.changes):
        return ""  # positions are guesses that the contacts complete
    known = own_start(free)
    if known is None:
        return ""
    rows = {name: Row.of_constraint(free.motion, name)[0] for name in ending}
    gaps = [row.gap for row in rows.values() if row.gap is not None]
    if any(abs(x) > tolerances.CARRIED for x in evaluate(gaps, known, fifty_digits())):
        return ""  # it does not begin in contact: another check says where it does
    rates = evaluate([row.velocity for row in rows.values()], known, fifty_digits())
    for name, rate in zip(rows, rates, strict=True):
        if rate > tolerances.CARRIED * (1 + max(map(abs, rates))):
            return f"'{name}' is closed, and opens with {float(rate):.6g} m/s where the motion starts"
    return ""


def pushing_otherwise(equations: EquationsOfMotion, start: State, moving: Callable[[State], State]) -> str:
    """Message that names a bilateral contact whose force at the start has not the sign of its friction; "".

    Args:
        start: the model's own.
        moving: it with the accelerations of the equations of motion.
    Raises:
        NoValue: something has no value there.
    """
    system = equations.system
    named = [c.name for c in system.scope.model.contacts if c.holds_both_ways]
    modes = {name: system.modes.get(name, ContactMode()) for name in named}
    for name, mode in modes.items():
        if not mode.closed or mode.sense is not None:  # a phase of a motion: its own start is another
            continue
        try:
            normal = Reactions.of(system).normal(name)
        except DerivationError:
            continue
        (N,) = evaluate((normal,), moving(start), fifty_digits())
        if mode.push * N < -tolerances.CARRIED * (1 + abs(N)):
            return f"'{name}' pushes with {float(N):.6g} at the start, and its friction is that of the other sign"
    return ""
