"""Model, contacts that close -> ImpactEquations: the jump of the speeds as equations, solved for impulses and speeds.

    M (u+ - u-) = J^T Lam,   J u+ + sigma = - e (J u- + sigma) of what closes,   J u+ + sigma = 0 of what holds

Contacts that close push: Lam > 0 says that the others are right to hold. The kinetic energy lost, where nothing is
given a speed:  T- - T+ = - sum Lam (v+ + v-)/2.

A contact that rubs, in the plane and hit alone, as long as it slides on: its push is along n - mu sign(v_t) t, and the
laws of Newton, Poisson and Stronge are one. Where sliding stops in the impact the laws part, and no one formula holds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank, Row, holds_identically
from eomgen.mechanics.dynamics import System, assembled_by_recursion
from eomgen.mechanics.free_bodies import Reactions
from eomgen.mechanics.impacts.law import Hit, Jump
from eomgen.mechanics.kinematics import ContactMode, SystemInertia
from eomgen.model import Contact, Model
from eomgen.symbolic.exact import book_form, cramer
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRow,
    Vector,
    function,
    inner,
    is_zero,
    jacobian,
    over,
    substituted,
)
from eomgen.symbolic.numeric import Work, transplanted

MOST_JOINTS = 6  # whose impulses are written out for a reader
OPEN = ContactMode(closed=False)


@dataclass(frozen=True)
class Rubs:
    """Friction of a contact in an impact, as long as it slides on.

    Args:
        mu: its coefficient.
        J, sigma: its sliding velocity v_t = J u + sigma.
        factor: the friction along it for a unit of the normal impulse: -mu sign(v_t).
    """

    mu: Scalar
    J: ScalarRow
    sigma: Scalar
    factor: Scalar


@dataclass(frozen=True)
class ImpactRow:
    """One scalar row that takes part in an impact.

    Args:
        name: of its impulse: floor, or of a constraint with more rows "A x".
        e: its restitution; None: it holds.
        J, sigma: its velocity J u + sigma.
        push: along which its impulse acts: J, with friction J - mu sign(v_t) J_t.
        impulse: the symbol of its impulse [N s, of couples N m s].
        row: from which it was made.
        rubs: its friction; None: it has none.
    """

    name: str
    e: Scalar | None
    J: ScalarRow
    sigma: Scalar
    impulse: Node
    row: Row
    push: ScalarRow
    rubs: Rubs | None = None

    @property
    def unit(self) -> str:
        """N s, of a couple alone N m s; of a row of coordinates that of its generalized impulse."""
        if not self.row.wrenches:
            return ""
        return "N*s" if any(not is_zero(x) for _, wrench in self.row.wrenches for x in wrench.f) else "N*m*s"


@dataclass(frozen=True)
class ImpactEquations:
    """The jump where contacts close, at any state.

    Args:
        system: with every contact that can end open; u are the speeds before.
        contacts: what closes.
        rows: of these, of contacts that stay closed, and of the constraints.
        after: the speeds after it, as symbols.
    """

    system: System
    contacts: tuple[str, ...]
    rows: tuple[ImpactRow, ...]
    after: tuple[Node, ...]

    @property
    def touching(self) -> tuple[str, ...]:
        """The contacts that take part."""
        own = {row.row.constraint for row in self.rows}
        return tuple(name for name in self.system.modes if name in own)

    @cached_property
    def M(self) -> tuple[ScalarRow, ...]:
        return tuple(tuple(row) for row in assembled_by_recursion(self.system).M)

    @property
    def u(self) -> tuple[Node, ...]:
        return self.system.symbols.u

    def jumped(
        self,
        M: np.ndarray,
        rows: np.ndarray,
        u: np.ndarray,
        *,
        e: Sequence[float | None],
        rub: tuple[float, np.ndarray] | None,
    ) -> np.ndarray | None:
        """Speeds after it by the law in numbers; None where a contact is not approached.

        Args:
            rows: (J, sigma) of its rows, k x (n + 1).
            e: coefficients of restitution of these, None of what holds.
            rub: mu, and (J, sigma) of the sliding velocities, of a contact that closes alone and rubs.
        """
        held = rows[[k for k, each in enumerate(e) if each is None]]
        touching = ((k, x.name, each) for k, (x, each) in enumerate(zip(self.rows, e, strict=True)))
        mu, tangents = rub or (0.0, None)
        hits = [
            Hit(name, rows[k][None], each, mu=mu, tangents=tangents) for k, name, each in touching if each is not None
        ]
        return None if any(hit.speed(u) >= 0 for hit in hits) else Jump.of(M, held, hits, u).u

    @cached_property
    def balances(self) -> tuple[tuple[Scalar, Scalar], ...]:
        """(left, right) of M (u+ - u-) = J^T Lam, one for each speed."""
        changes = [later - before for later, before in zip(self.after, self.u, strict=True)]
        left = [inner(row, changes) for row in self.M]
        impulses = [row.impulse for row in self.rows]
        right = [inner([row.push[k] for row in self.rows], impulses) for k in range(len(self.u))]
        return tuple(zip(left, right, strict=True))

    @cached_property
    def conditions(self) -> tuple[tuple[Scalar, Scalar], ...]:
        """(left, right) of v+ = - e v-, of what holds v+ = 0, one for each row."""
        found = []
        for row in self.rows:
            before, later = (inner(row.J, speeds) + row.sigma for speeds in (self.u, self.after))
            found.append((later, 0 if row.e is None else -row.e * before))
        return tuple(found)

    @cached_property
    def solution(self) -> dict[Node, Scalar]:
        """Speeds after it and impulses.

        Raises:
            DerivationError: too many unknowns hang together.
        """
        n = len(self.u)
        rows: list[dict[int, Scalar]] = [_entries(row) for row in self.M]
        right: list[Scalar] = [0] * n
        for m, row in enumerate(self.rows):
            for k, x in enumerate(row.push):
                if not is_zero(x):
                    rows[k][n + m] = -x
            before = inner(row.J, self.u) + row.sigma
            rows.append(_entries(row.J))
            right.append(-before if row.e is None else -(1 + row.e) * before)
        values = [x for (x,) in cramer.solution_by_minors(rows, [(x,) for x in right])[0]]
        short = [book_form(x, Work.ANSWER) for x in values]
        later = [u + change for u, change in zip(self.u, short, strict=False)]
        unknowns = (*self.after, *(row.impulse for row in self.rows))
        return dict(zip(unknowns, (*(book_form(x, Work.ANSWER) for x in later), *short[n:]), strict=True))

    @property
    def kinetic_energy(self) -> Scalar:
        """T before the impact."""
        return SystemInertia(self.system.motion).kinetic_energy

    @property
    def impulses(self) -> dict[str, Scalar]:
        """The impulse of each row, by name."""
        return {row.name: self.solution[row.impulse] for row in self.rows}

    @cached_property
    def loss(self) -> Scalar:
        """Kinetic energy that is lost: T before less T after."""
        if any(not is_zero(row.sigma) for row in self.rows) or self._is_driven:
            T = self.kinetic_energy
            later = substituted((T,), {u: self.solution[x] for u, x in zip(self.u, self.after, strict=True)})[0]
            return book_form(T - later, Work.ANSWER)
        lost: Scalar = 0
        for row in self.rows:
            if row.e is not None:  # v+ + v- = (1 - e) v-
                rate = (1 - row.e) * inner(row.J, self.u)
                if row.rubs is not None:
                    rate = rate + row.rubs.factor * sum(self.slides_on[row.name], start=0)
                lost = lost - self.solution[row.impulse] * rate
        return book_form(over(lost, 2), Work.ANSWER)

    @property
    def rubbing(self) -> dict[str, Rubs]:
        """The contacts that slide on in the impact, with their friction."""
        return {row.name: row.rubs for row in self.rows if row.rubs is not None}

    @property
    def slides_on(self) -> dict[str, tuple[Scalar, Scalar]]:
        """(v_t before, v_t after) of each of them: with these signs alike the equations hold."""
        found = {}
        for name, own in self.rubbing.items():
            later = inner(own.J, [self.solution[x] for x in self.after]) + own.sigma
            found[name] = (inner(own.J, self.u) + own.sigma, book_form(later, Work.ANSWER))
        return found

    @cached_property
    def of_joints(self) -> dict[str, Vector]:
        """Impulse of each joint on its child, ground axes, of up to MOST_JOINTS bodies; {} where they do not follow."""
        if self.rubbing:
            return {}
        links = [link for link in self.system.motion.links if link.joint is not None and link.joint.carries_reaction]
        axes = range(2 if self.system.scope.model.space == "plane" else 3)
        if len(links) > MOST_JOINTS:
            return {}
        found: dict[str, Vector] = {}
        for link in links:
            try:
                x, y, *z = (self.impulse_along(link.name, axis) for axis in axes)
            except DerivationError:  # it carries no force, or is not determined
                continue
            found[link.name] = Vector((x, y, *(z or (0,))))
        return found

    def impulse_along(self, owner: str, axis: int) -> Scalar:
        """Impulse of a joint or constraint along an axis of the ground, on its child.

        The balance of the bodies is linear in accelerations and multipliers: the part of a reaction that they make,
        with the jump of the speeds and the impulses in their place.

        Raises:
            DerivationError: with the contacts closed the model has other speeds; there is no such reaction.
        """
        away = {name: mode for name, mode in self.system.modes.items() if name not in self.touching}
        closed = System.of(self.system.scope.model, away)
        symbols = closed.symbols
        if [x.name for x in symbols.u] != [x.name for x in self.u]:
            what = f"the impulse of '{owner}' does not follow: in contact the model has other speeds"
            raise DerivationError(what, fix="coordinates that are free of the contact")
        reaction = Reactions.of(closed).component("force", axis, owner)
        still: dict[Node, Scalar] = dict.fromkeys((*symbols.a, *symbols.lam), 0)
        values: dict[str, Scalar] = {x.name: x for x in (*symbols.x, symbols.t)}
        values |= {name: node for name, node in symbols.parameters.items()}
        known = transplanted(tuple(self.solution.values()), closed.scope.graph, values)
        solution = dict(zip(self.solution, known, strict=True))
        moved: dict[Node, Scalar] = {}
        for a, u, later in zip(symbols.a, symbols.u, self.after, strict=True):
            moved[a] = solution[later] - u
        by_row = {(row.row.constraint, row.row.number): solution[row.impulse] for row in self.rows}
        for lam, row in zip(symbols.lam, closed.constraints.closing, strict=True):
            moved[lam] = by_row.get((row.constraint, row.number), 0)
        struck, resting = (substituted((reaction,), known)[0] for known in (moved, still))
        own = self.system.symbols
        here: dict[str, Scalar] = {x.name: x for x in (*own.x, own.t, *own.parameters.values())}
        return transplanted((book_form(struck - resting, Work.ANSWER),), self.system.scope.graph, here)[0]

    @property
    def _is_driven(self) -> bool:
        return bool(self.system.scope.model.driven_coordinates)

    @classmethod
    def of(
        cls, model: Model, contacts: Sequence[str] = (), closed: Sequence[str] = (), *, slides: bool = False
    ) -> ImpactEquations:
        """The equations of the impact in which contacts close.

        Args:
            contacts: what closes; (): the one contact that can end.
            closed: contacts that are closed already, and stay so.
            slides: a contact that rubs slides on, in the plane and hit alone; False: it is refused.
        Raises:
            UsageError: no such contact, or none is named and there are several.
            DerivationError: the coordinates cannot leave a contact, or friction has a part in the impact.
        """
        ending = {contact.name: contact for contact in model.contacts if contact.unilateral}
        names = _named(ending, contacts)
        rough = [name for name in names if _rubs(model, ending[name])]
        for name in rough:
            if not slides or model.space == "space" or len(names) > 1 or set(closed) - {name}:
                raise _undecided(ending[name])
        if len(names) > 1 and model.impact is not None and model.impact.order == "sequential":
            what = "contacts that are hit one after the other have no one set of equations"
            raise DerivationError(what, "impact", f"name one: --impact {names[0]}")
        system = System.of(model, dict.fromkeys(ending, OPEN))
        staying = [name for name in closed if name in ending and name not in names]
        own = {name: Row.of_constraint(system.motion, name) for name in (*names, *staying)}
        symbol = system.symbols.u[0].graph.symbol
        found = []
        for name, rows in own.items():
            for k, row in enumerate(rows):
                e = system.scope.value(ending[name].restitution) if ending[name].restitution is not None else 0
                label = name if k == 0 else f"{name} {row.component}"
                made = _row(system, row, label, e if name in names and k == 0 else None)
                found.append(_rubbing(system, made, ending[name]) if name in rough and k == 0 else made)
        redundant = {(row.constraint, row.number) for row in Rank(system.constraints).redundant()}
        several = [row.constraint for row in system.constraints.rows]
        for row in system.constraints.closing:
            if (row.constraint, row.number) not in redundant:
                alone = several.count(row.constraint) == 1 or not row.component
                found.append(_row(system, row, row.constraint if alone else f"{row.constraint} {row.component}", None))
        after = tuple(symbol(_after(u.name)) for u in system.symbols.u)
        return cls(system, names, tuple(found), after)


def _entries(row: ScalarRow) -> dict[int, Scalar]:
    return {k: x for k, x in enumerate(row) if not is_zero(x)}


def _named(ending: Mapping[str, Contact], contacts: Sequence[str]) -> tuple[str, ...]:
    if not ending:
        raise UsageError(
            "no contact of the model can close", fix="unilateral = true of a constraint, or limits of a joint"
        )
    for name in contacts:
        if name not in ending:
            raise UsageError(f"'{name}' is no contact that can close", fix=f"one of {', '.join(ending)}")
    if not contacts and len(ending) > 1:
        what = f"several contacts can close: {', '.join(ending)}"
        raise UsageError(what, fix=f"name those that do: --impact {next(iter(ending))}")
    return tuple(contacts) or tuple(ending)


def _rubs(model: Model, contact: Contact) -> bool:
    return contact.mu is not None and (contact.restitution is not None or model.impact is not None)


def _undecided(contact: Contact) -> DerivationError:
    what = f"friction has a part in the impact of '{contact.name}': whether it slides, sticks or slides back decides"
    return DerivationError(
        f"{what} its equations",
        contact.declared_at,
        "`simulate` follows it; `derive --impact` has it in the plane, hit alone, as long as it slides on; without "
        "`friction`, or without `restitution` and [impact], it has none",
    )


def _row(system: System, row: Row, name: str, e: Scalar | None) -> ImpactRow:
    u = system.symbols.u
    (J,) = jacobian((row.velocity,), u)
    (sigma,) = substituted((row.velocity,), dict.fromkeys(u, 0))
    if all(holds_identically(x) for x in J):
        raise DerivationError(
            f"the coordinates satisfy '{row.constraint}' by themselves, and its impulse does not follow",
            f"constraints.{row.constraint}",
            "place the body by coordinates that can leave the contact",
        )
    J, sigma = tuple(book_form(x, Work.ANSWER) for x in J), book_form(sigma, Work.ANSWER)
    return ImpactRow(name, e, J, sigma, u[0].graph.symbol(f"Lambda_{name.replace(' ', '_')}"), row, J)


def _rubbing(system: System, made: ImpactRow, contact: Contact) -> ImpactRow:
    """The row with the friction of its contact, which slides on."""
    u, mu = system.symbols.u, system.scope.value(contact.mu)
    (J,) = jacobian((made.row.sliding,), u)
    (sigma,) = substituted((made.row.sliding,), dict.fromkeys(u, 0))
    J, sigma = tuple(book_form(x, Work.ANSWER) for x in J), book_form(sigma, Work.ANSWER)
    factor = -mu * function("sign", inner(J, u) + sigma)
    push = tuple(a + factor * b for a, b in zip(made.J, J, strict=True))
    return replace(made, push=push, rubs=Rubs(mu, J, sigma, factor))


def _after(name: str) -> str:
    """y_after' for y'."""
    primes = len(name) - len(name.rstrip("'"))
    return f"{name.rstrip(chr(39))}_after{chr(39) * primes}"
