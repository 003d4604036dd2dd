"""Model, contacts that close -> ImpactEquations: the jump of the speeds as equations, solved for impulses and speeds.

    M (u+ - u-) = J^T Lam,   J u+ + sigma = - e (J u- + sigma) of what closes,   J u+ + sigma = 0 of what holds

Contacts that close push: Lam > 0 says that the others are right to hold. The kinetic energy lost, where nothing is
given a speed:  T- - T+ = - sum Lam (v+ + v-)/2.

A contact that rubs, in the plane and hit alone, as long as it slides on: its push is along n - mu sign(v_t) t, and the
laws of Newton, Poisson and Stronge are one. Where sliding ends in the impact it sticks or slides back from there: each
is a case with formulas of its own and the bounds within which it is the one (`Cases`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank, Row, holds_identically
from eomgen.mechanics.dynamics import System, assembled_by_recursion
from eomgen.mechanics.free_bodies import Reactions
from eomgen.mechanics.impacts.friction import ENERGETIC, NEWTON, SLIDES_BACK, SLIDES_ON, STICKS
from eomgen.mechanics.impacts.law import Hit, ImpactLaw, Jump
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
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import FLOAT, Work, evaluate, tolerances, transplanted
from eomgen.symbolic.print import to_text

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
        course: of a contact that rubs the case whose formulas they are, in which friction has an impulse of its own;
            None: it slides on.
        slides: of a course those of the same impact as long as it slides on.
    """

    system: System
    contacts: tuple[str, ...]
    rows: tuple[ImpactRow, ...]
    after: tuple[Node, ...]
    course: ImpactCourse | None = None
    slides: ImpactEquations | None = None

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

    @property
    def balances(self) -> tuple[tuple[Scalar, Scalar], ...]:
        """(left, right) of M (u+ - u-) = J^T Lam, one for each speed."""
        changes = [later - before for later, before in zip(self.after, self.u, strict=True)]
        left = [inner(row, changes) for row in self.M]
        impulses = [row.impulse for row in self.rows]
        right = [inner([row.push[k] for row in self.rows], impulses) for k in range(len(self.u))]
        return tuple(zip(left, right, strict=True))

    @property
    def conditions(self) -> tuple[tuple[Scalar, Scalar], ...]:
        """(left, right) of v+ = - e v-, of what holds v+ = 0, one for each row; of a course its two impulses first."""
        found: list[tuple[Scalar, Scalar]] = []
        if self.course is not None:
            found += [(row.impulse, self.solution[row.impulse]) for row in self.rows[:2]]
        for row in self.rows[len(found) :]:
            before, later = (inner(row.J, speeds) + row.sigma for speeds in (self.u, self.after))
            found.append((later, 0 if row.e is None else -row.e * before))
        return tuple(found)

    @cached_property
    def solution(self) -> dict[Node, Scalar]:
        """Speeds after it and impulses.

        Raises:
            DerivationError: too many unknowns hang together.
        """
        if self.slides is not None and self.course is not None:
            return self.slides._solution_of(self.course, self)
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
        if self.slides is not None and self.course is not None:
            twice = [u + self.solution[x] for u, x in zip(self.u, self.after, strict=True)]
            lost = -over(sum((self.solution[x.impulse] * inner(x.J, twice) for x in self.rows), start=lost), 2)
            return book_form(lost, Work.ANSWER) if self.slides.cases.short else lost
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
        if self.rubbing or self.course is not None:
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

    # -- cases of a contact that rubs ------------------------------------------------------------

    @cached_property
    def cases(self) -> Cases:
        """The courses that the impact of a contact that rubs can take; of any other none."""
        if not self.rubbing:
            return Cases(())
        row, responses = self.rows[0], self._responses()
        rubs, e = row.rubs, 0 if row.e is None else row.e
        assert rubs is not None, "asked of a contact that rubs"
        before = [u + x[2] for u, x in zip(self.u, responses, strict=False)]
        v_n, v_t = (book_form(inner(own.J, before) + own.sigma, Work.ANSWER) for own in (row, rubs))
        pairs = ((row.J, 0), (rubs.J, 0), (rubs.J, 1))
        D_nn, D_nt, D_tt = (
            book_form(inner(J, [each[k] for each in responses[: len(self.u)]]), Work.ANSWER) for J, k in pairs
        )
        if holds_identically(D_nt):
            return self._with_cases(_short_cases((v_n, v_t), (D_nn, D_tt), rubs.mu, e), (), responses)
        known, graph = self.system.scope.names, self.u[0].graph
        letters: dict[str, Node] = {}
        formulas: list[tuple[Node, Scalar]] = []

        def named(name: str, x: Scalar) -> Node:
            letters[name] = graph.symbol(name if name not in known else f"{name}_{self.contacts[0]}")
            formulas.append((letters[name], x))
            return letters[name]

        n, t = named("v_n", v_n), named("v_t", v_t)
        nn, nt, tt = named("D_nn", D_nn), named("D_nt", D_nt), named("D_tt", D_tt)
        s = named("s", function("sign", t))
        a_n, a_t = named("a_n", nn - rubs.mu * s * nt), named("a_t", s * nt - rubs.mu * tt)
        named("v_s", n + a_n * named("p_s", -function("abs", t) / a_t))
        named("a_s", nn - nt**2 / tt)
        named("a_b", nn - rubs.mu * function("abs", nt))
        courses = tuple(_courses(letters, row.impulse, (rubs.mu, e, self.law)))
        return self._with_cases(courses, tuple(formulas), responses)

    @property
    def own_course(self) -> ImpactCourse | None:
        """The course whose formulas they are; None where friction has no part."""
        return self.course or next(iter(self.cases.courses), None)

    @property
    def counts(self) -> Scalar:
        """1 within the bounds of the own course, 0 outside: (1 + sign(b - a))/2 of each a <= b; 1 where none is."""
        count: Scalar = 1
        for a, b in () if self.own_course is None else self.own_course.bounds:
            count = count * over(1 + function("sign", self.all_cases.written_out(b - a)), 2)
        return count

    @property
    def all_cases(self) -> Cases:
        """The courses of the impact, whichever of them this is."""
        return (self.slides or self).cases

    @property
    def law(self) -> str:
        """The law by which restitution ends."""
        return ImpactLaw.of(self.system.scope.model.impact, bool(self.rubbing) or self.course is not None).law

    @property
    def along(self) -> dict[Node, Scalar]:
        """{the impulse of friction: -mu sign(v_t) times the normal one}, of a contact that slides on."""
        rows = ((row.impulse, row.rubs) for row in self.rows)
        return {x.graph.symbol(f"{x.name}_t"): rubs.factor * x for x, rubs in rows if rubs is not None}

    @property
    def others(self) -> tuple[ImpactEquations, ...]:
        """Equations of the courses in which it does not slide on: friction has an impulse of its own."""
        return self.cases.others

    def _with_cases(
        self,
        courses: tuple[ImpactCourse, ...],
        letters: tuple[tuple[Node, Scalar], ...],
        responses: tuple[ScalarRow, ...],
    ) -> Cases:
        """The cases, each with its equations."""
        row, rubs = self.rows[0], self.rows[0].rubs
        assert rubs is not None, "asked of a contact that rubs"
        motion = self.system.motion
        pushes = tuple(each for each in map(motion.body_wrench, row.row.tangent) if each is not None)
        along = replace(row.row, wrenches=pushes, velocity=row.row.sliding, gap=None, component="t")
        (impulse,) = self.along
        rows = (
            replace(row, push=row.J, rubs=None),
            ImpactRow(f"{row.name} t", None, rubs.J, rubs.sigma, impulse, along, rubs.J),
            *self.rows[1:],
        )
        others = tuple(replace(self, rows=rows, course=each, slides=self) for each in courses[1:])
        return Cases(courses, letters, others, responses)

    def _responses(self) -> tuple[ScalarRow, ...]:
        """Changes by a unit impulse along n, one along t, and by the rows that hold: of speeds and impulses, 3 columns.

        M w - H^T x = n, t, 0,   H w = 0, 0, -(H u + sigma)
        """
        (first, *held), n = self.rows, len(self.u)
        assert first.rubs is not None, "asked of a contact that rubs"
        rows: list[dict[int, Scalar]] = [_entries(row) for row in self.M]
        for m, row in enumerate(held):
            for k, x in _entries(row.J).items():
                rows[k][n + m] = -x
        right: list[tuple[Scalar, ...]] = [(a, b, 0) for a, b in zip(first.J, first.rubs.J, strict=True)]
        rows += [_entries(row.J) for row in held]
        right += [(0, 0, -(inner(row.J, self.u) + row.sigma)) for row in held]
        found = cramer.solution_by_minors(rows, right)[0]
        return tuple(tuple(book_form(x, Work.ANSWER) for x in each) for each in found)

    def changed(self, impulses: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Speeds after it, and impulses of what holds, by the impulses (normal, friction) of a contact that rubs."""
        known: tuple[Scalar, ...] = (*self.u, *(0 for _ in self.rows[1:]))
        pairs = zip(known, self.cases.responses, strict=True)
        return tuple(x + inner(each, (*impulses, 1)) for x, each in pairs)

    @property
    def loss_in_letters(self) -> tuple[Scalar, ...]:
        """The loss by the letters of the cases, where nothing is given a speed; () elsewhere.

        -(v_n p + v_t p_t) - (D_nn p^2 + 2 D_nt p p_t + D_tt p_t^2)/2
        """
        if self._is_driven or not self.cases.letters or any(not is_zero(row.sigma) for row in self.others[0].rows):
            return ()
        v_n, v_t, D_nn, D_nt, D_tt = (x for x, _ in self.cases.letters[:5])
        p, along = (row.impulse for row in self.others[0].rows[:2])
        squares = D_nn * p**2 + D_tt * along**2
        return (-v_n * p - v_t * along - over(squares, 2) - D_nt * p * along,)

    def course_at(self, values: Mapping[str, float]) -> str:
        """Name of the course within whose bounds a state is, by numbers; "" where it has none.

        Args:
            values: coordinates and speeds, and the time t, by name.
        """
        symbols = self.system.symbols
        state: dict[Node, Any] = {**self.system.scope.known_parameters, symbols.t: values.get("t", 0.0)}
        state |= {x: values[x.name] for x in symbols.x if x.name in values}
        for course in self.cases.courses:
            bounds = tuple(self.cases.written_out(a - b) for a, b in course.bounds)
            if all(x <= tolerances.COMPUTED for x in evaluate(bounds, state, FLOAT)):
                return course.name
        return ""

    def _solution_of(self, course: ImpactCourse, found: ImpactEquations) -> dict[Node, Scalar]:
        """Speeds after it and impulses of one course."""
        p, along = course.impulses
        (along,) = substituted((along,), {self.rows[0].impulse: p})
        own = tuple(self.cases.written_out(x) for x in (p, along))
        n, values = len(self.u), self.changed(own)
        values = (*values[:n], *own, *values[n:])
        if self.cases.short:
            values = tuple(book_form(x, Work.ANSWER) for x in values)
        return dict(zip((*found.after, *(row.impulse for row in found.rows)), values, strict=True))

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


# -------- cases -----------------------------------------------------------------------------------------------
# A contact that rubs, hit alone in the plane with v_n < 0: Routh's graph in formulas. D is what unit impulses change of
# (v_n, v_t), p the normal impulse. While it slides, s = sign(v_t),
#
#     v_n' = a_n = D_nn - mu s D_nt,     |v_t|' = a_t = s D_nt - mu D_tt     by p,
#
# so that sliding ends at p_s = -|v_t|/a_t, and compression, if it slides so long, at -v_n/a_n. From p_s on it sticks,
# with the friction -D_nt/D_tt for a unit of p, where that is at most mu, or slides back, with -mu sign(D_nt): from v_s
# on v_n' = a_s = D_nn - D_nt^2/D_tt, or a_b = D_nn - mu |D_nt|. Where D_nt = 0, as of a ball, v_n' stays the same, and
# all laws are one.
#
# Source: Stronge, Impact Mechanics (2000), ch. 3; Brach, Mechanical Impact Dynamics (1991), ch. 2.


@dataclass(frozen=True)
class ImpactCourse:
    """One course of an impact that rubs.

    Args:
        name: "slides on", "sticks", "slides back from the compression on".
        impulses: the normal one, and with it that of friction, in the letters of the cases.
        bounds: (left, right): it is this one where each left <= right.
    """

    name: str
    impulses: tuple[Scalar, Scalar]
    bounds: tuple[tuple[Scalar, Scalar], ...]

    @property
    def within(self) -> tuple[str, ...]:
        """The bounds as texts: a <= b."""
        return tuple(f"{to_text(a)} <= {to_text(b)}" for a, b in self.bounds)


@dataclass(frozen=True)
class Cases:
    """The courses that an impact can take: it slides on first.

    Args:
        letters: (letter, its formula, in those before it); (): all stands in the symbols of the model.
        others: of each course but the first the equations.
        responses: what a unit impulse along n, one along t, and the rows that hold change: of speeds, then impulses.
    """

    courses: tuple[ImpactCourse, ...]
    letters: tuple[tuple[Node, Scalar], ...] = ()
    others: tuple[ImpactEquations, ...] = ()
    responses: tuple[ScalarRow, ...] = ()

    @property
    def short(self) -> bool:
        """True if the formulas are those of the model, without letters."""
        return not self.letters

    def written_out(self, x: Scalar) -> Scalar:
        """A formula without letters."""
        for letter, formula in reversed(self.letters):
            (x,) = substituted((x,), {letter: formula})
        return x


def _short_cases(v: ScalarRow, D: tuple[Scalar, Scalar], mu: Scalar, e: Scalar) -> tuple[ImpactCourse, ...]:
    """The two courses where D_nt = 0:  it sticks where |v_t| <= -(1 + e) mu v_n D_tt/D_nn."""
    (v_n, v_t), (D_nn, D_tt) = v, D
    p = over(-(1 + e) * v_n, D_nn)
    slip, most = function("abs", v_t), book_form(over(mu * p * D_tt, 1), Work.ANSWER)
    return (
        ImpactCourse(SLIDES_ON, (p, -mu * function("sign", v_t) * p), ((most, slip),)),
        ImpactCourse(STICKS, (p, -over(v_t, D_tt)), ((slip, most),)),
    )


def _courses(x: Mapping[str, Any], impulse: Node, of: tuple[Any, Any, str]) -> Iterator[ImpactCourse]:
    """The courses in letters.

    Args:
        impulse: the symbol of the normal one.
        of: mu, e, and the law.
    """
    (mu, e, law), s, v_n, p_s, D_nt = of, x["s"], x["v_n"], x["p_s"], x["D_nt"]
    p, size, most = -(1 + e) * v_n / x["a_n"], function("abs", D_nt), mu * x["D_tt"]
    slip, ends = function("abs", x["v_t"]) * x["a_n"], v_n * x["a_t"]
    yield ImpactCourse(SLIDES_ON, (p, -mu * s * impulse), ((0, x["a_n"]), ((1 + e) * ends, slip)))
    ways = {
        STICKS: (-D_nt / x["D_tt"], x["a_s"], ((size, most),)),
        SLIDES_BACK: (-mu * function("sign", D_nt), x["a_b"], ((most, size), (0, x["a_b"]))),
    }
    begins = {"compression": ((x["a_t"], 0), (slip, ends)), "restitution": ((ends, slip), (slip, (1 + e) * ends))}
    for name, (F, a, held) in ways.items():
        for phase, bounds in begins.items() if not is_zero(e) else list(begins.items())[:1]:
            p = _end(law, e, (v_n, x["v_s"]), (x["a_n"], a), p_s, pressed=phase == "compression")
            yield ImpactCourse(f"{name} from the {phase} on", (p, F * (impulse - p_s) - mu * s * p_s), (*bounds, *held))


def _end(law: str, e: Any, speeds: tuple[Any, Any], slopes: tuple[Any, Any], p_s: Any, *, pressed: bool) -> Any:
    """Normal impulse where restitution ends, of what slid up to p_s.

    Args:
        speeds: v_n before the impact, and at p_s.
        slopes: its growth by p up to p_s, and from there on.
        pressed: sliding ends in the compression.
    """
    (v_n, v), (a_n, a) = speeds, slopes
    if law == NEWTON:
        return p_s - (e * v_n + v) / a
    p_c = p_s - v / a if pressed else -v_n / a_n
    if law != ENERGETIC:
        return (1 + e) * p_c
    if pressed:
        return p_c + e * sqrt((v**2 / a - (v_n + v) * p_s) / a)
    return p_s + (sqrt(v**2 + a * (e**2 * v_n**2 - v**2) / a_n) - v) / a


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
