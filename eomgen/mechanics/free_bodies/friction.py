"""Equations of motion -> the same with friction, the contacts' own reactions solved together with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial, reduce
from operator import add, sub
from typing import Any

from eomgen.errors import DerivationError, ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank, holds_identically
from eomgen.mechanics.dynamics import (
    EquationsOfMotion,
    Explicit,
    Extent,
    System,
    WellPosed,
    assembled_by_recursion,
    division_of,
)
from eomgen.mechanics.free_bodies.balance import Balance
from eomgen.mechanics.free_bodies.solution import (
    combined_reaction,
    friction_as_load,
    solution_of_balance,
    values_at_a_state,
)
from eomgen.mechanics.free_bodies.wrenches import (
    Component,
    Ends,
    ends_of_round,
    is_of_whole_force,
    joint_friction,
    load_of,
    size_of_parts,
    sliding_friction,
)
from eomgen.symbolic.exact import LinearSystem, Solution, ValuesAt, components, cramer
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    function,
    gradient,
    inner,
    is_zero,
    over,
    selected,
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import has_pieces, tolerances

# -------- friction --------------------------------------------------------------------------------------------
# Equations of motion -> the same with friction: the contacts' own reactions solved together with the accelerations.
#
#     M a + c = Q + J^T lam + sum f_r |N_r|,   J a + gamma = 0,   f_r = factor_r dv_r/du
#
# N_r of a constraint row is its multiplier; of one that only reacts it follows from the equilibrium of the bodies
# across what the coordinates allow, friction a load of it: N_r = n_r + m_r a + sum k_rs N_s. A bilateral contact on a
# line has |N_r| = sqrt(N_1^2 + N_2^2), a guide the sum of those of its ends, in which the equations are not linear (see
# `round_contacts`). What comes out is friction as a generalized force of q, u and t.


@dataclass(frozen=True)
class FrictionContact:
    """A contact with friction.

    Args:
        name: the constraint, or the body on a path.
        component: index of its normal reaction among the components of the reactions; of a
            bilateral contact that of its friction.
        along: generalized force for a unit of friction, dv/du.
        factor: the friction along the contact's tangent for a unit of N, or of |N|, for instance -mu sign(v).
        ends: of a bilateral contact the forces by which it rubs, as combinations of the components.
    """

    name: str
    component: int
    along: ScalarRow
    factor: Scalar
    ends: Ends = ()

    @property
    def force(self) -> ScalarRow:
        """Generalized force for a unit of N, or of |N|."""
        return tuple(self.factor * d for d in self.along)

    def load(self, components: Sequence[Scalar]) -> Scalar:
        """The sum of the sizes of its forces, of the values of all components."""
        each = ([sum((k * components[j] for j, k in part), start=0) for part in parts] for parts in self.ends)
        return sum(map(size_of_parts, each), start=0)


def equations_of_motion(system: System) -> EquationsOfMotion:
    """The equations of motion of a system in their shortest form, friction in Q and forcing.

    Raises:
        DerivationError: as `with_friction`.
    """
    return with_friction(assembled_by_recursion(system))


def where_in_pieces(
    system: System,
    scalars: Sequence[Scalar],
    decide: Callable[[Sequence[Scalar], Mapping[Node, Any]], bool],
) -> Extent | None:
    """Extent of a property of scalars, by their form in each piece and a state there.

    None where they have no pieces, or not all are known: the equations of the system say where each is.
    """
    if not any(map(has_pieces, scalars)):
        return None
    key = (system.symbols.u, system.constraints.J, system.constraints.sigma)
    known = system.scope.graph.found(where_in_pieces)
    try:
        if key not in known:
            known[key] = equations_of_motion(system)
        division = division_of(known[key], scalars)
    except (DerivationError, ModelError):
        return None
    return None if division is None or not division.found else division.where_holds(scalars, decide)


def with_friction(equations: EquationsOfMotion) -> EquationsOfMotion:
    """The equations of motion, friction in Q and forcing, and the accelerations explicit; the same without friction.

    Raises:
        DerivationError: the normal reaction of a contact with friction is indeterminate.
    """
    if not SystemFriction(equations.system).exists:
        return equations
    solved = _WithFriction(equations)
    a, forces = solved.accelerations, solved.normals
    friction = tuple(
        sum((contact.force[k] * N for contact, N in zip(solved.found, forces, strict=True)), start=0)
        for k in range(len(equations.M))
    )
    return replace(
        equations,
        Q=tuple(x + f for x, f in zip(equations.Q, friction, strict=True)),
        forcing=tuple(x + f for x, f in zip(equations.forcing, friction, strict=True)),
        friction=friction,
        accelerations=a,
    )


@dataclass(frozen=True)
class SystemFriction:
    """Friction of a system that depends on its own reactions."""

    system: System

    def push_sizes(self) -> dict[str, Scalar]:
        """|N| of every bilateral contact with friction, as a function of q, u and t; {} where there is none.

        Raises:
            DerivationError: as `with_friction`.
        """
        if not self.round_symbols:
            return {}
        solved = _WithFriction(assembled_by_recursion(self.system))
        pairs = zip(solved.found, solved.normals, strict=True)
        return {contact.name: N for contact, N in pairs if contact.ends}

    def feedback(self) -> dict[str, dict[str, Scalar]]:
        """D_rs: how much the force on which the friction of r depends grows with |N| of s; {} without such friction.

        The friction has one value while the spectral radius of D is below 1.
        Raises:
            DerivationError: as `with_friction`.
        """
        return _WithFriction(assembled_by_recursion(self.system)).feedback if self.round_symbols else {}

    def with_rest(self, scalars: Sequence[Scalar]) -> ScalarRow:
        """Scalars in which Coulomb's friction on surfaces, v/|v|, is 0 where v is, as sign(v) along a line is."""
        rows = [row for row in self.system.constraints.rows if row.shares and row.friction is not None]
        speeds = [row.sliding for row in rows if type(row.sliding) is Node and row.sliding.op == "sqrt"]
        return substituted(tuple(scalars), {v: function("max", v, LEAST) for v in speeds}) if speeds else tuple(scalars)

    @property
    def exists(self) -> bool:
        """True if any contact has friction."""
        return bool(self.named)

    @property
    def named(self) -> list[tuple[str, Scalar, Scalar]]:
        """(contact, the friction of a unit of N, the sliding velocity) of every contact with friction."""
        found = [(row.constraint, row.friction, row.sliding) for row in self.system.constraints.rows]
        for link in self.system.motion.links:
            found.append((link.name, joint_friction(self.system, link), link.s_rate[0] if link.s_rate else 0))
        return [(name, factor, sliding) for name, factor, sliding in found if factor is not None]

    def contacts(self, components: Sequence[Component]) -> list[FrictionContact]:
        """Every contact with friction, in the order of the components."""
        u = self.system.symbols.u
        found = []
        for j, component in enumerate(components):
            if not component.frictional:
                continue
            factor, sliding = sliding_friction(self.system, component)
            one_way = component.bilateral_friction is None
            ends = () if one_way else ends_of_round(self.system.motion, components, component)
            found.append(FrictionContact(component.owner, j, gradient(sliding, u), factor, ends))
        return found

    @property
    def round_symbols(self) -> dict[str, Node]:
        """A symbol for |N| of every bilateral contact with friction, by its name."""
        on_lines = [row.constraint for row in self.system.constraints.rows if row.round and row.friction is not None]
        motion = self.system.motion
        whole = [link for link in motion.links if is_of_whole_force(motion, link)]
        on_lines += [link.name for link in whole if joint_friction(self.system, link) is not None]
        return {name: self.system.scope.graph.symbol(f"|N|({name})") for name in on_lines}


@dataclass(frozen=True)
class _WithFriction:
    """The equations of motion with friction; first with |N| of bilateral contacts left open."""

    equations: EquationsOfMotion

    @property
    def accelerations(self) -> ScalarRow:
        """a as a function of q, u and t."""
        return substituted(self._values[: len(self.equations.M)], self._sizes)

    @property
    def normals(self) -> ScalarRow:
        """N of every contact with friction, or |N|."""
        single = iter(substituted(self._values[len(self._values) - len(self._single) :], self._sizes))
        return tuple(
            self._sizes[self._symbols[contact.name]] if contact.ends else next(single) for contact in self.found
        )

    @cached_property
    def found(self) -> list[FrictionContact]:
        return SystemFriction(self.equations.system).contacts(self._balance.components)

    @property
    def _single(self) -> list[FrictionContact]:
        return [contact for contact in self.found if not contact.ends]

    @property
    def _symbols(self) -> dict[str, Node]:
        return SystemFriction(self.equations.system).round_symbols

    @property
    def _normals(self) -> dict[int, Node]:
        """A symbol for N of every contact with friction that has one, by its component."""
        graph = self.equations.system.scope.graph
        return {each.component: graph.symbol(f"N({each.name}, {each.component})") for each in self._single}

    @cached_property
    def _balance(self) -> Balance:
        return Balance.of(self.equations.system, self._symbols)

    @cached_property
    def _solution(self) -> Solution:
        """Solution of the balance with friction as a load: the row along the motion would only repeat M a."""
        return solution_of_balance(friction_as_load(self._balance, self._normals), {})

    @cached_property
    def _sizes(self) -> dict[Node, Scalar]:
        """|N| of bilateral contacts, by its symbol."""
        pairs = self._pairs
        return sizes(pairs, self._values_at_a_state(pairs))

    @property
    def _pairs(self) -> dict[Node, EqualPushes]:
        """The forces N of each bilateral contact, linear in |N| of all, by the symbol of its |N|."""
        known = dict(zip(self.equations.symbols.a, self._values, strict=False)) | dict(
            zip(self._normals.values(), self._values[len(self._values) - len(self._single) :], strict=True)
        )
        return {
            self._symbols[contact.name]: tuple(
                tuple(sum((k * self._component(contact.name, j, known) for j, k in part), start=0) for part in end)
                for end in contact.ends
            )
            for contact in self.found
            if contact.ends
        }

    def _values_at_a_state(self, pairs: Mapping[Node, EqualPushes]) -> ValuesAt:
        entries = [N for ends in pairs.values() for parts in ends for N in parts]
        found: ValuesAt = values_at_a_state(self.equations.system, substituted(entries, dict.fromkeys(pairs, 0)))
        return found

    @property
    def feedback(self) -> dict[str, dict[str, Scalar]]:
        """D_rs = |dN_r/dP_s|, of a guide the sum over its ends, by the names of the contacts."""
        pairs = self._pairs
        names = {symbol: name for name, symbol in self._symbols.items()}
        G = _slopes(pairs, tuple(pairs), self._values_at_a_state(pairs))
        return {
            names[r]: {
                names[s]: sum((sqrt(inner(g, g)) for g in ends), start=0) for s, ends in zip(pairs, row, strict=True)
            }
            for r, row in zip(pairs, G, strict=True)
        }

    def _component(self, name: str, j: int, known: dict[Node, Scalar]) -> Scalar:
        """A normal reaction, linear in |N| of all."""
        m = self._multiplier(j, name)
        if m is not None:
            return self._values[len(self.equations.M) + m]
        return substituted((self._by_balance(j),), known)[0]

    def _multiplier(self, j: int, name: str) -> int | None:
        return _multiplier(self.equations.system, self._balance.components[j], name, self._kept)

    @property
    def _kept(self) -> list[int]:
        return Rank(self.equations.system.constraints).regular()

    @cached_property
    def _values(self) -> ScalarRow:
        """a, lam of the rows that do not follow from others, N of every contact with friction that has one.

        Raises:
            DerivationError: the normal reaction of a contact is indeterminate.
            ModelError: a free coordinate moves no mass.
        """
        if len(self.equations.M) + len(self._kept) + len(self._single) > cramer.LARGEST_BLOCK:
            return self._by_factors()
        try:
            return tuple(_solved(self.equations.system, *self._bordered()))
        except DerivationError:
            WellPosed(self.equations).refuse_massless()
            raise

    def _bordered(self) -> tuple[list[dict[int, Scalar]], list[Scalar]]:
        """(rows, right side) for a, lam and N at once."""
        rows, right = Explicit(self._loaded).bordered(self._kept)
        n, first = len(self.equations.M), len(right)
        for k, contact in enumerate(self._single):
            multiplier = self._multiplier(contact.component, contact.name)
            normal = first + k if multiplier is None else n + multiplier
            for row, force in zip(rows[:n], contact.force, strict=True):
                row[normal] = row.get(normal, 0) - force
            known, value = self._normal(contact, first)
            rows.append(known | {first + k: 1 + known.get(first + k, 0)})
            right.append(value)
        return rows, right

    def _by_factors(self) -> ScalarRow:
        """Solution for many unknowns: a and lam for each N by the factors of M and J M^-1 J^T, then N alone."""
        try:
            parts = Explicit(self._loaded).by_factors(self._kept, [contact.force for contact in self._single])
        except DerivationError:
            WellPosed(self.equations).refuse_massless()
            raise
        columns = [[*a, *lam] for a, lam in parts]
        first, rows, right = len(columns[0]), [], []
        for k, contact in enumerate(self._single):
            known, value = self._normal(contact, first)
            share = [sum((x * column[j] for j, x in known.items() if j < first), start=0) for column in columns]
            row = {i: share[1 + i] + known.get(first + i, 0) + int(i == k) for i in range(len(self._single))}
            rows.append({i: x for i, x in row.items() if not is_zero(x)})
            right.append(value - share[0])
        N = _solved(self.equations.system, rows, right) if rows else []
        moved = [sum((column[j] * f for column, f in zip(columns[1:], N, strict=True)), start=0) for j in range(first)]
        return (*(x + d for x, d in zip(columns[0], moved, strict=True)), *N)

    @property
    def _loaded(self) -> EquationsOfMotion:
        """The equations with the friction of bilateral contacts, |N| left open, in the forcing."""
        forcing = self.equations.forcing
        for contact in self.found:
            if contact.ends:
                size = self._symbols[contact.name]
                forcing = tuple(b + force * size for b, force in zip(forcing, contact.force, strict=True))
        return replace(self.equations, forcing=forcing)

    def _normal(self, contact: FrictionContact, first: int) -> tuple[dict[int, Scalar], Scalar]:
        """Row over a, lam and N, and a constant, that give N: its multiplier, or by the balance."""
        multiplier = self._multiplier(contact.component, contact.name)
        if multiplier is None:
            return self._linear(contact.component, first)
        return {len(self.equations.M) + multiplier: -1}, 0

    def _by_balance(self, j: int) -> Scalar:
        """Component j, linear in the accelerations."""
        return combined_reaction(self._balance, self._solution, {j: 1}, self._balance.components[j].name)

    def _linear(self, j: int, first: int) -> tuple[dict[int, Scalar], Scalar]:
        """(-m, -k; n) of N_j = n + m a + k N: coefficients of the unknowns, N from `first` on, and the right side."""
        names = (*self.equations.symbols.a, *self._normals.values())
        places = (*range(len(self.equations.symbols.a)), *range(first, first + len(self._normals)))
        value = self._by_balance(j)
        slopes = gradient(value, names)
        known = {place: -slope for place, slope in zip(places, slopes, strict=True)}
        return known, substituted((value,), dict.fromkeys(names, 0))[0]


def _multiplier(system: System, component: Component, name: str, kept: Sequence[int]) -> int | None:
    """Index of the kept row whose multiplier is the normal reaction; None where it follows from the balance.

    Raises:
        DerivationError: its row follows from others, so that it is indeterminate.
    """
    closing, label = system.constraints.closing, (component.owner, component.number)
    rows = [
        i for i, row in enumerate(closing) if component.kind == "constraint" and (row.constraint, row.number) == label
    ]
    if not rows:
        return None
    if rows[0] not in kept:
        raise DerivationError(
            f"the normal reaction of '{name}', which has friction, is indeterminate",
            fix="take a redundant constraint away, or its friction",
        )
    return kept.index(rows[0])


def _solved(system: System, rows: list[dict[int, Scalar]], right: list[Scalar]) -> list[Scalar]:
    """The unknowns: by determinants where they are few, else by elimination."""
    entries = [x for row in rows for x in row.values()]
    equations = LinearSystem(rows, right, len(right), values_at_a_state(system, entries))
    return list(equations.unique_solution(vanishes=holds_identically))


# -------- round contacts --------------------------------------------------------------------------------------
# Normal reactions linear in the frictions -> |N| of contacts that hold on all sides of a line in space, or at two ends.
#
#     N_re = n_re + sum over s of G_res P_s,   P_r = sum over its ends of |N_re|,   |N| = sqrt(N_1^2 + N_2^2)
#
# All have one end but a guide with a length. A contact that no other one feeds back on has a quadratic equation, with
# one positive root as long as |G_rr| < 1, beyond which rigid bodies may jam:
# P = (n.g + sqrt(1 - g^2) sqrt(n^2 + (n.g)^2/(1 - g^2)))/(1 - g^2), without a value there. Of a guide in the plane
# abs(N_1) + abs(N_2) is the larger of abs(N_1 + N_2) and abs(N_1 - N_2), each of which has one such root. Contacts that
# press one another, and guides in space, are solved by Newton's steps, as many as leave rounding alone; what they do
# not reach has no value.


STEPS = 6  # of Newton's method; each doubles the number of right digits
REACHED = Fraction(1, 10**9)  # of all |N|, by which one may be off; what converges is off by rounding
LEAST = Fraction(1, 10**30)  # an N below it is none [N]

Parts = tuple[Scalar, ...]  # of one force
EqualPushes = tuple[Parts, ...]  # the forces of one contact


@dataclass(frozen=True)
class _Pressed:
    """Contacts that press one another: N_re = n_re + sum G_res P_s."""

    n: tuple[EqualPushes, ...]
    G: tuple[tuple[EqualPushes, ...], ...]

    def normals(self, P: Sequence[Scalar]) -> list[EqualPushes]:
        return [_carried(n, zip(row, P, strict=True)) for n, row in zip(self.n, self.G, strict=True)]


def sizes(pairs: Mapping[Node, EqualPushes], values: ValuesAt) -> dict[Node, Scalar]:
    """The value of each |N|, by its symbol.

    Args:
        pairs: the forces of each contact, linear in the symbols of all.
        values: of scalars at one generic state, in an arithmetic of many digits.
    """
    symbols = tuple(pairs)
    none = dict.fromkeys(symbols, 0)
    n = [tuple(substituted(parts, none) for parts in ends) for ends in pairs.values()]
    G = _slopes(pairs, symbols, values)
    needs = [[s for s, g in enumerate(row) if not _vanish(g)] for row in G]
    found: dict[int, Scalar] = {}
    for group in components(needs):
        given = tuple(_carried(n[r], ((G[r][s], P) for s, P in found.items())) for r in group)
        pressed = _Pressed(given, tuple(tuple(G[r][s] for s in group) for r in group))
        found |= zip(group, _together(pressed), strict=True)
    return {symbol: found[r] for r, symbol in enumerate(symbols)}


def _slopes(pairs: Mapping[Node, EqualPushes], symbols: tuple[Node, ...], values: ValuesAt) -> list[list[EqualPushes]]:
    """G_rs, what vanishes at a generic state left out."""
    rows = [[[gradient(N, symbols) for N in parts] for parts in ends] for ends in pairs.values()]
    flat = [abs(x) for x in values([g for ends in rows for parts in ends for slopes in parts for g in slopes])]
    least, sizes = tolerances.ZERO_AT_50 * max(flat, default=0), iter(flat)
    kept = [
        [[[g if next(sizes) > least else 0 for g in slopes] for slopes in parts] for parts in ends] for ends in rows
    ]
    return [
        [tuple(tuple(slopes[s] for slopes in parts) for parts in ends) for s in range(len(symbols))] for ends in kept
    ]


def _vanish(g: EqualPushes) -> bool:
    return all(is_zero(x) for parts in g for x in parts)


def _carried(n: EqualPushes, shares: Any) -> EqualPushes:
    """n + sum g P"""
    for g, P in shares:
        n = tuple(
            tuple(x if is_zero(y) else x + y * P for x, y in zip(*parts, strict=True))
            for parts in zip(n, g, strict=True)
        )
    return n


def _alone(n: EqualPushes, g: EqualPushes) -> Scalar:
    """P = sum |n_e + g_e P|, of two ends the larger of |N_1 + N_2| and |N_1 - N_2|: in the plane that is P, in space
    it is below P; no value where sum |g_e| >= 1."""
    if len(n) == 1:
        return _of_one(n[0], g[0])
    if _vanish(g):
        return load_of(n)
    ways = [[tuple(map(op, *x)) for x in (n, g)] for op in (add, sub)]
    pushed = [_of_one(*way) for way in ways if not _vanish(tuple(way))]
    return reduce(partial(function, "max"), pushed)


def _of_one(n: Parts, g: Parts) -> Scalar:
    """P = |n + g P|; no value where |g| >= 1."""
    square, along, rest = inner(n, n), inner(n, g), 1 - inner(g, g)
    if is_zero(along):
        return sqrt(over(square, rest))
    return over(along + sqrt(rest) * sqrt(square + over(along * along, rest)), rest)


def _together(pressed: _Pressed) -> list[Scalar]:
    """P_r = sum |n_re + sum G_res P_s|, by Newton's method from the roots of each alone."""
    each = range(len(pressed.n))
    P = [_alone(pressed.n[r], pressed.G[r][r]) for r in each]
    if len(P) == 1 and _is_exact(pressed.n[0], pressed.G[0][0]):
        return P
    for _ in range(STEPS):
        N = pressed.normals(P)
        length = [[sqrt(inner(x, x)) for x in ends] for ends in N]
        safe = [[function("max", x, LEAST) for x in ends] for ends in length]
        rows = [[int(r == s) - _slope(N[r], pressed.G[r][s], safe[r]) for s in each] for r in each]
        step = _solved_near_unit(rows, [sum(x, start=0) - p for x, p in zip(length, P, strict=True)])
        P = [p + d for p, d in zip(P, step, strict=True)]
    return _reached(pressed, P)


def _slope(N: EqualPushes, g: EqualPushes, size: Sequence[Scalar]) -> Scalar:
    """sum N_e.g_e/|N_e|"""
    return sum((over(inner(x, y), z) for x, y, z in zip(N, g, size, strict=True)), start=0)


def _is_exact(n: EqualPushes, g: EqualPushes) -> bool:
    """True if a contact alone has a closed form."""
    return len(n) == 1 or _vanish(g) or all(len(parts) == 1 for parts in n)


def _solved_near_unit(rows: Sequence[Sequence[Scalar]], right: Sequence[Scalar]) -> list[Scalar]:
    """Solution of equations whose matrix is near the unit matrix, by elimination in their order."""
    if not rows:
        return []
    (first, *_), *_ = rows
    shares = [over(row[0], first) for row in rows[1:]]
    below = [
        [x - k * y for x, y in zip(row[1:], rows[0][1:], strict=True)] for k, row in zip(shares, rows[1:], strict=True)
    ]
    others = _solved_near_unit(below, [b - k * right[0] for k, b in zip(shares, right[1:], strict=True)])
    return [over(right[0] - inner(rows[0][1:], others), first), *others]


def _reached(pressed: _Pressed, P: Sequence[Scalar]) -> list[Scalar]:
    """The values where they are |N|; elsewhere they are divided by 0, and there are none."""
    allowed = REACHED * sum((function("abs", p) for p in P), start=LEAST)
    reached = [sum((sqrt(inner(N, N)) for N in ends), start=0) for ends in pressed.normals(P)]
    off = [function("abs", p - x) for p, x in zip(P, reached, strict=True)]
    return [over(p, selected(x, allowed, 1, 0)) for p, x in zip(P, off, strict=True)]
