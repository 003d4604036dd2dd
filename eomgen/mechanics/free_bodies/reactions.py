"""Balance -> Reactions: every reaction of every joint and constraint, as functions of q, u and the accelerations.

The equations of the bodies hold more rows than there are reactions: those left over are the equations of motion. Where
they hold fewer independent ones, some reactions are indeterminate, and the null space says how they may be shared.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, Rank, holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.balance import (
    DIRECTIONS,
    Balance,
    balances_of_nodes,
    is_balanced,
    refuse_friction,
    unbalanced,
)
from eomgen.mechanics.free_bodies.friction import SystemFriction
from eomgen.mechanics.free_bodies.names_of_reactions import NamedReaction
from eomgen.mechanics.free_bodies.solution import (
    SURE,
    Combination,
    Indeterminate,
    combined_reaction,
    solution_of_balance,
)
from eomgen.mechanics.free_bodies.structure import Structure
from eomgen.mechanics.free_bodies.wrenches import Component, Effect, ends_of_joint, load_of
from eomgen.mechanics.kinematics import Motion
from eomgen.mechanics.start import ExactStart
from eomgen.mechanics.state import Numbers
from eomgen.model import called, declared_at
from eomgen.symbolic.exact import Solution
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Scalar,
    Vector,
    depends_on,
    derivative,
    is_zero,
    over,
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import Work, tolerances


@dataclass(frozen=True)
class Reactions:
    """All reactions of a system.

    Args:
        balance: the equations of the bodies.
        solution: of them, for the components.
        at: what stands in place of coordinates, speeds and accelerations, {} where they are left as symbols.
    """

    balance: Balance
    solution: Solution
    at: Mapping[Node, Scalar]

    def __repr__(self) -> str:
        names = ", ".join(component.name for component in self.components)
        return f"<reactions of {self.balance.system.scope.model.name!r}: {names or 'none'}>"

    @property
    def components(self) -> tuple[Component, ...]:
        return self.balance.components

    @cached_property
    def by_components(self) -> tuple[Reactions, tuple[Node, ...]]:
        """(the reactions as functions of the components, the symbols of these), linear in them."""
        graph, names = self.balance.system.scope.graph, self.balance.names
        symbols = tuple(graph.symbol(f"component {j} of the balance") for j in range(len(names)))
        constants: dict[int, Scalar] = dict(enumerate(symbols))
        return replace(self, solution=Solution(constants, {j: {} for j in constants}, (), ())), symbols

    def together(self, scalar: Scalar) -> tuple[Combination, Scalar] | None:
        """({component: factor}, the rest) of a scalar over the symbols of `by_components`; None: it is not linear in
        what has no single value."""
        symbols = self.by_components[1]
        known = {symbols[j]: x for j, x in self.solution.constants.items() if self.solution.determined(j)}
        (scalar,) = substituted((scalar,), known)
        factors = {j: derivative(scalar, x) for j, x in enumerate(symbols) if depends_on(scalar, (x,))}
        if any(depends_on(k, symbols) for k in factors.values()):
            return None
        (rest,) = substituted((scalar,), dict.fromkeys(symbols, 0))
        return factors, rest

    @property
    def indeterminate(self) -> tuple[Component, ...]:
        """The components that have no single value."""
        return tuple(c for j, c in enumerate(self.components) if not self.solution.determined(j))

    @property
    def null_space(self) -> tuple[dict[str, Scalar], ...]:
        """Self-stresses, one for each free component: shares, by name, that may be added without a change of motion."""
        found = []
        for f in self.solution.free:
            row: dict[str, Scalar] = {self.balance.names[f]: 1}
            row |= {self.balance.names[j]: -s[f] for j, s in self.solution.shares.items() if f in s}
            found.append(row)
        return tuple(found)

    @cached_property
    def unknowns(self) -> dict[Node, Scalar]:
        """Values of the unknowns of the loads at rest, of those that have a single one."""
        first = len(self.components)
        pairs = enumerate(self.balance.unknowns, start=first)
        return {p: self.solution.constants[j] for j, p in pairs if self.solution.determined(j)}

    def unknown(self, name: str) -> Scalar:
        """An unknown of the loads.

        Raises:
            DerivationError: it occurs in no load.
            Indeterminate: the balance at rest leaves it open.
        """
        if name not in self.balance.names[len(self.components) :]:
            raise DerivationError(
                f"the unknown '{name}' stands in no load and in no equation of [given]",
                f"unknowns.{name}",
                "write it where it is meant",
            )
        return self.combined({self.balance.names.index(name, len(self.components)): 1}, name)

    def value(self, j: int) -> Scalar:
        """Component j.

        Raises:
            Indeterminate: it has no single value.
        """
        return self.combined({j: 1}, self.components[j].name)

    @property
    def values(self) -> tuple[Scalar | None, ...]:
        """Every component, None for those that are indeterminate."""
        return tuple(
            self.solution.constants[j] if self.solution.determined(j) else None for j in range(len(self.components))
        )

    def force(self, owner: str, side: str = "", frame: str = "") -> Vector:
        """Force of a joint on its child, of a constraint on its first-named body or on `side`; ground axes or
        `frame`'s.

        Raises:
            DerivationError: there is no such reaction, or it is indeterminate.
        """
        return Vector(self.component("force", k, owner, side, frame) for k in range(3))

    def couple(self, owner: str, side: str = "", frame: str = "") -> Vector:
        """Couple, as `force`, about the point of the joint or constraint."""
        return Vector(self.component("couple", k, owner, side, frame) for k in range(3))

    def component(self, what: str, k: int, owner: str, side: str = "", frame: str = "") -> Scalar:
        """Component k of the "force" or "couple"; the others may be indeterminate."""
        if self.is_open(owner):
            return 0
        combinations, given = self._sums(what, owner, side, frame)
        given = Vector(substituted(given, self.unknowns)) if self.unknowns else given
        place = f"{owner}.{side}" if side else owner
        plane = self.balance.system.scope.model.space == "plane"
        along = "xyz"[k] if what == "force" else "couple" if plane else f"couple_{'xyz'[k]}"
        name = f"reaction_{along}({place})"
        found: Scalar = given[k] + self.combined(combinations[k], name)
        return found

    def is_open(self, owner: str) -> bool:
        """True if a contact has ended: its reaction is 0."""
        mode = self.balance.system.modes.get(owner)
        return mode is not None and not mode.closed

    def normal(self, owner: str) -> Scalar:
        """The normal reaction, positive along the constraint's normal; without friction; of a hinge's stop a couple.

        Of a capstan the mean of its tensions, by which it rubs.

        Of a bilateral contact on a line in space sqrt(N_1^2 + N_2^2).
        """
        if self.is_open(owner):
            return 0
        signed = any((c.owner, c.label) == (owner, "n") for c in self.components)  # of a slide in the plane
        if owner in self.balance.sizes and not signed:
            found: Scalar = self._replaced(Vector((self.balance.sizes[owner], 0, 0)))[0]
            return found
        several = [j for j, c in enumerate(self.components) if c.owner == owner and c.label.startswith("n ")]
        if several:
            return sqrt(sum((x * x for x in map(self.value, several)), start=0))
        constraint = self.balance.system.scope.model.constraints.get(owner)
        if constraint is not None and constraint.exponent is not None:
            return self.tension(owner)
        labels = {c.label for c in self.components if c.owner == owner and c.kind == "constraint"}
        return self._labelled(owner, "couple" if labels == {"couple"} else "n", "normal reaction")

    def friction(self, owner: str, along: str = "t") -> Scalar:
        """Friction, sliding or sticking: the force along the contact, positive along the normal turned clockwise.

        In space it has two components, along "t" and "s".
        """
        if self.is_open(owner):
            return 0
        name = f"reaction_{along}({owner})"
        for named in NamedReaction.all_of(self.balance):
            if named.name == name:
                return self.combined(
                    {j: self._replaced(Vector((k, 0, 0)))[0] for j, k in named.combination.items()}, name
                )
        return self._labelled(owner, along, "friction")

    def load(self, body: str) -> Scalar:
        """The load by which a joint rubs: the size of its force, of a guide with a length of both at its ends.

        Of a slide or path in the plane its force with its sign.
        Raises:
            Indeterminate: a force has no single value.
        """
        ends = ends_of_joint(self.balance.system.motion, self.components, body)
        return load_of([[self.combined(dict(part), self._name_of(part)) for part in parts] for parts in ends])

    def _name_of(self, part: tuple[tuple[int, Scalar], ...]) -> str:
        """reaction_n(B), of several components the force of their joint at its ends."""
        first = self.components[part[0][0]]
        return first.name if len(part) == 1 else f"the force at the ends of the guide of '{first.owner}'"

    def friction_of_joint(self, joint: str) -> Scalar:
        """Dry friction along a variable of a joint, sliding or sticking, on the body.

        Raises:
            DerivationError: the joint has none; it is indeterminate.
        """
        for named in NamedReaction.all_of(self.balance):
            if named.name == f"friction({joint})":
                given = self._replaced(Vector((named.given, 0, 0)))[0]
                total: Scalar = given + self.combined(named.combination, named.name)
                return total
        raise DerivationError(f"the joint '{joint}' has no dry friction", fix="name a joint with `friction`")

    def member(self, truss: str, first: str, second: str) -> Scalar:
        """Tension of the member of a truss between two nodes.

        Raises:
            DerivationError: there is none.
        """
        members = {c.side: j for j, c in enumerate(self.components) if c.owner == truss}
        found = [j for member, j in members.items() if set(member.split("-")) == {first, second}]
        if not found:
            raise DerivationError(
                f"truss '{truss}' has no member between '{first}' and '{second}'",
                fix=f"its members: {', '.join(members)}",
            )
        return self.value(found[0])

    def tension(self, owner: str, strand: int | None = None) -> Scalar:
        """Tension of a link, or of a strand of a string (None: the first); of a capstan the mean, or that of a side."""
        if self.is_open(owner):
            return 0
        constraint = self.balance.system.scope.model.constraints.get(owner)
        if strand in (1, 2) and constraint is not None and constraint.exponent is not None:
            return self.tension(owner) + Fraction(2 * strand - 3, 2) * self.friction(owner)
        strand = 1 if strand is None else strand
        numbers = () if constraint is None else constraint.strand_rows()
        if numbers and not 1 <= strand <= len(numbers):
            raise DerivationError(
                f"tension({owner}, {strand}): the string has {len(numbers)} strands",
                fix="strands are numbered from 1 along the points",
            )
        number = numbers[strand - 1] if numbers else strand
        found = [
            j
            for j, c in enumerate(self.components)
            if c.owner == owner and c.kind == "constraint" and c.label == "tension" and c.number == number
        ]
        if not found:
            raise DerivationError(
                f"tension({owner}): '{owner}' has no tension there, it pulls on no body",
                fix="name a string or a link that holds a body",
            )
        return self.value(found[0])

    def multiplier(self, owner: str) -> Scalar:
        """The multiplier of a constraint of one row."""
        if self.is_open(owner):
            return 0
        found = [j for j, c in enumerate(self.components) if c.owner == owner and c.kind == "constraint"]
        if len(found) != 1:
            raise DerivationError(
                f"multiplier({owner}): '{owner}' has {len(found)} components; name one of them",
                fix=f"reaction({owner}, LABEL)",
            )
        return self.value(found[0])

    def labels(self, owner: str) -> list[str]:
        """Labels of the components of one constraint or joint."""
        return [c.label for c in self.components if c.owner == owner]

    def _labelled(self, owner: str, label: str, words: str) -> Scalar:
        found = [j for j, c in enumerate(self.components) if c.owner == owner and c.label == label]
        if len(found) != 1:
            others = ", ".join(c.name for c in self.components if c.owner == owner) or "none"
            raise DerivationError(f"'{owner}' has no {words}", fix=f"its reactions: {others}")
        return self.value(found[0])

    def _sums(self, what: str, owner: str, side: str, frame: str) -> tuple[list[Combination], Vector]:
        """Force or couple on one body as combinations of the owner's components, and what its drive and spring add."""
        motion = self.balance.system.motion
        mine = {j: c for j, c in enumerate(self.components) if c.owner == owner}
        efforts = Effect.of_joint(self.balance.system, owner)
        if not mine and not efforts:
            driven = next(
                (q for q, constraints in motion.scope.model.driving_constraints.items() if owner in constraints), ""
            )
            fix = f"ask drive({driven})" if driven else "what is placed carries none: name the constraint"
            raise DerivationError(f"'{owner}' carries no reaction", fix=fix)
        on = self._side(owner, side, [e for c in mine.values() for e in c.effects] or efforts)
        vectors = {j: self._on(c, on, what) for j, c in mine.items()}
        given = Vector.ZERO
        for effect in efforts:
            given = given + getattr(effect, what) if effect.link == on else given
        R = self._turning(on, frame, motion)
        turned = {j: self._replaced(vector if R is None else R @ vector) for j, vector in vectors.items()}
        combinations = [{j: v[k] for j, v in turned.items() if not is_zero(v[k])} for k in range(3)]
        return combinations, self._replaced(given if R is None else R @ given)

    def _turning(self, on: int, frame: str, motion: Motion) -> Matrix | None:
        """Rotation from the axes of a body's equations to the ground's, or to those of `frame`; None: no rotation."""
        R = None if motion.scope.model.space == "plane" or on < 0 else motion.links[on].pose.R
        if not frame or frame == "ground":
            return R
        to_frame = motion.link(frame).pose.R.T
        return to_frame if R is None else to_frame @ R

    def _on(self, component: Component, on: int, what: str) -> Vector:
        """Force or couple of a unit of the component on one body; on the ground (-1) the opposite of that on all."""
        total = Vector.ZERO
        for effect in (*component.effects, *component.friction_effects):
            if effect.link == on or on < 0:
                total = total + getattr(effect, what)
        return total if on >= 0 else -total

    def _side(self, owner: str, side: str, effects: Sequence[Effect]) -> int:
        """Index of the body on which the reaction is requested, -1 for the ground."""
        motion = self.balance.system.motion
        if not side:
            return effects[0].link
        if side == "ground":
            return -1
        index = motion.index[side]
        if all(effect.link != index for effect in effects):
            raise DerivationError(f"'{owner}' does not act on body '{side}'", fix="name a body that it touches")
        return index

    def _replaced(self, vector: Vector) -> Vector:
        return Vector(substituted(tuple(vector), self.at)) if self.at else vector

    def combined(self, combination: Combination, name: str) -> Scalar:
        """sum of k_j x_j.

        Raises:
            Indeterminate: it has no single value; `name` says what it is.
        """
        return combined_reaction(self.balance, self.solution, combination, name)

    @staticmethod
    def of(
        system: System,
        at: Mapping[Node, Scalar] | None = None,
        *,
        short: bool = False,
        work: int = Work.ANSWER,
        as_taken: bool = False,
    ) -> Reactions:
        """Every reaction, linear in the accelerations; or at one configuration, for which everything is solved anew.

        Friction of what others hold at rest is one that holds, and has no single value.

        From as few equations as can be and from sure pivots alone is the same elimination, where all pivots are sure.

        Args:
            at: exact scalars in place of coordinates, speeds, accelerations and t.
            short: from as few equations as can be: formulas for a reader, which may divide by what vanishes at some
                states.
            work: products of terms by which one coefficient is made readable at a configuration.
            as_taken: what others hold at rest has its friction of sliding, as it is taken in the equations of motion.
        Raises:
            DerivationError: a body is unsupported; a force acts at no place.
        """
        if not as_taken and (held := system.held_by_others()) is not system:
            return Reactions.of(held, at, short=short, work=work)
        if at or work != Work.ANSWER:
            return _found(system, at or {}, short, work)
        if (key := (Reactions.of, short)) not in system.found:
            other: Reactions | None = system.found.get((Reactions.of, not short))
            alike = other is not None and other.solution.worst is not None and other.solution.worst <= SURE
            system.found[key] = other if alike else _found(system, {}, short, work)
        found: Reactions = system.found[key]
        return found

    def determinate(self) -> dict[str, Scalar]:
        """{name as in an output: value in q, u and the accelerations}; without those that have no single value."""
        found: dict[str, Scalar] = {}
        for named in NamedReaction.all_of(self.balance):
            try:
                found[named.name] = self.combined(named.combination, named.name) + named.given
            except Indeterminate:
                continue
        return found

    @staticmethod
    def determinate_sums(stresses: Sequence[Mapping[Any, Scalar]]) -> list[dict[Any, Scalar]]:
        """Sums of indeterminate reactions that have a single value: sum of k_i r_i with sum of k_i s_i = 0.

        That holds for each of the self-stresses s, which may be added to the reactions. For each stress one reaction
        that belongs to it alone is chosen as its measure; there is one sum for each of the other reactions.

        Args:
            stresses: {reaction: share} of each.
        """
        names = dict.fromkeys(name for stress in stresses for name in stress)
        alone: list[Any] = []
        for stress in stresses:
            own = [name for name in stress if sum(name in other for other in stresses) == 1]
            alone.append(min(own, key=lambda name: type(stress[name]) is Node, default=None))
        found = []
        for name in names:
            beside = [(stress, own) for stress, own in zip(stresses, alone, strict=True) if name in stress]
            if name not in alone and all(own is not None for _, own in beside):
                found.append({name: 1} | {own: over(-stress[name], stress[own]) for stress, own in beside})
        return found


def _found(system: System, at: Mapping[Node, Scalar], short: bool, work: int) -> Reactions:
    sizes = SystemFriction(system).push_sizes()
    balance = Balance.of(system, sizes)
    if balance.unknowns:
        return _at_rest(balance, at, work)
    if at:
        solution = _with_sizes(system, at, sizes, work) if sizes else solution_of_balance(balance, at, work=work)
    else:
        solution = solution_of_balance(balance, {}, sure=None if short else SURE)
    refuse_unheld(balance, solution, at)
    return Reactions(balance, solution, at)


def _with_sizes(system: System, at: Mapping[Node, Scalar], sizes: Mapping[str, Scalar], work: int) -> Solution:
    """The reactions at a configuration, |N| of bilateral contacts put in at last: multiplied out it is long."""
    symbols = SystemFriction(system).round_symbols
    solution = solution_of_balance(Balance.of(system, symbols), at, work=work)
    names, values = list(solution.constants), tuple(solution.constants.values())
    known = dict(zip((symbols[name] for name in sizes), substituted(tuple(sizes.values()), at), strict=True))
    return replace(solution, constants=dict(zip(names, substituted(values, known), strict=True)))


def _at_rest(balance: Balance, at: Mapping[Node, Scalar], work: int) -> Reactions:
    """Reactions and unknown loads where nothing moves: as functions of the coordinates, or at the start alone.

    Raises:
        DerivationError: the loads are not in balance there, whatever the unknowns are.
    """
    refuse_friction(balance)
    state = {**at, **balance.system.still}
    solution = solution_of_balance(balance, state, work=work)
    if not is_balanced(balance, solution):
        state = {**ExactStart.values_at_rest(balance.system), **at}
        solution = solution_of_balance(balance, state, work=work)
        if not is_balanced(balance, solution):
            raise unbalanced(balance, solution)
    return Reactions(balance, solution, state)


# -------- unheld ----------------------------------------------------------------------------------------------
# Balance, Solution -> refusal of a motion of bodies that no reaction resists and no coordinate describes.
#
# The rows that the reactions leave over are the equations of motion: one for each degree of freedom. Where there are
# more, no reaction resists some virtual motion, and it is none of the coordinates'.


def refuse_unheld(balance: Balance, solution: Solution, at: Mapping[Node, Scalar]) -> None:
    """Refuse a motion of bodies that no reaction resists and no coordinate describes.

    Args:
        at: the configuration at which the solution was found, {} where it is a function of the coordinates.
    Raises:
        DerivationError: the body that moves most in it, and the direction.
    """
    system, left = balance.system, solution.left
    if at:
        if not system.symbols.u or all(map(holds_identically, left)):  # residuals at rest are tested elsewhere
            return
    else:
        motions = Rank(system.constraints).degrees_of_freedom()
        if len(left) <= motions or sum(not holds_identically(x) for x in left) <= motions:
            return
        if not system.symbols.u:
            return Structure.of(system).refuse_loose()
    key = (refuse_unheld, bool(at))
    if key not in system.found:
        system.found[key] = _unheld(balance, touched=bool(at))
    if system.found[key] is not None:
        raise system.found[key]


def _unheld(balance: Balance, *, touched: bool) -> DerivationError | None:
    """Error that names the body that moves most in a motion without reaction and coordinate, and the direction.

    Args:
        touched: only of directions along which some reaction acts: no number follows from the others.
    """
    free, allowed = _virtual_motions(balance)
    if not free.size:  # the friction of a joint holds it too, where that goes by its reaction
        return None
    Q = np.linalg.qr(allowed)[0] if allowed.size else np.zeros((free.shape[0], 0))
    unheld = free - Q @ (Q.T @ free)
    joined = _joined_by_a_coordinate(balance.system) or _placed_together(balance, unheld)
    if touched:
        unheld[[not e.coefficients for e in balance.equations]] = 0
    worst = int(np.argmax(np.max(np.abs(unheld), axis=1)))
    if np.max(np.abs(unheld)) < tolerances.RANK_NEARBY:
        return None
    equation = balance.equations[worst]
    direction = DIRECTIONS[equation.direction]
    turning = direction.startswith("moment")
    what = "unsupported against rotation" if turning else f"unsupported along {direction}"
    fix = (
        f"{joined}, and nothing named joins them: name the constraint that does"
        if joined
        else "a placed body carries no reaction: name the constraint that holds it, or connect it by joints"
    )
    return DerivationError(f"{called(equation.body)} is {what}", declared_at(equation.body), fix)


def _joined_by_a_coordinate(system: System) -> str:
    """Sentence that one free coordinate moves several joints, or one joint in two ways; "" where none does."""
    given = system.scope.model.driven_coordinates
    joints = [link for link in system.motion.links if link.joint is not None and link.joint.carries_reaction]
    for q in system.symbols.q:
        moved = [link.name for link in joints for s in link.s if depends_on(s, (q,))]
        if len(moved) > 1 and q.name not in given:
            names = [f"'{name}'" for name in dict.fromkeys(moved)]
            which = "the joints of " if len(names) > 1 else "in two ways the joint of "
            return f"'{q.name}' moves {which}{' and '.join(names)}"
    return ""


def _placed_together(balance: Balance, unheld: np.ndarray) -> str:
    """Sentence that one free coordinate moves several placed bodies, where each alone is held; "" elsewhere.

    Args:
        unheld: motions along the rows without reaction and coordinate, one a column.
    """
    U, sizes, _ = np.linalg.svd(unheld, full_matrices=False)
    basis = U[:, sizes > tolerances.RANK_NEARBY]
    bodies = list(dict.fromkeys(e.body for e in balance.equations))
    parts = {body: basis[[e.body == body for e in balance.equations]] for body in bodies}
    share = {body: float(np.linalg.norm(part, 2)) if part.size else 0.0 for body, part in parts.items()}
    if any(x > 1 - tolerances.RANK_NEARBY for x in share.values()):  # it moves by itself
        return ""
    system, given = balance.system, balance.system.scope.model.driven_coordinates
    links = [link for link in system.motion.links if share.get(link.name, 0.0) > tolerances.RANK_NEARBY]
    for q in system.symbols.q:
        moved = [f"'{link.name}'" for link in links if depends_on(link.s, (q,))]
        if len(moved) > 1 and q.name not in given:
            return f"'{q.name}' moves {' and '.join(moved)}"
    return ""


def _virtual_motions(balance: Balance) -> tuple[np.ndarray, np.ndarray]:
    """Velocities along the rows: a basis of those that no reaction resists, and those of the coordinates."""
    system = balance.system
    rows, columns = len(balance.equations), len(balance.components)
    state = Closure(system.constraints).generic()

    numbers = Numbers(state).of
    G = np.zeros((rows, columns))
    for i, e in enumerate(balance.equations):
        if e.coefficients:
            G[i, list(e.coefficients)] = numbers(list(e.coefficients.values()))
    U, sizes, _ = np.linalg.svd(G)
    free = U[:, int(np.sum(sizes > tolerances.RANK_NEARBY * max(sizes, default=1.0))) :]
    return free, _allowed(balance, numbers)


def _allowed(balance: Balance, numbers: Any) -> np.ndarray:
    """Velocity of mass centre and spin along each row of the balance, per unit of every speed that the constraints
    allow.

    Nodes that follow from their own balance may move: the forces on them are in balance along these motions too.
    """
    free = balance.system.free or balance.system
    nodes = balances_of_nodes(free)
    system = free if nodes else balance.system
    kept = [
        line
        for row, line in zip(system.constraints.closing, system.constraints.J, strict=True)
        if row.label not in nodes
    ]
    motion = system.motion
    plane = motion.scope.model.space == "plane"
    columns = []
    for e in balance.equations:
        i = motion.index[e.body]
        link, com = motion.links[i], motion.scope.mass_properties(e.body).com
        B = np.array(numbers([x for row in motion.B[i] for x in row])).reshape(6, -1)
        r = np.array(numbers(com))
        R = np.array(numbers([x for row in link.pose.R for x in row])).reshape(3, 3) if plane else np.eye(3)
        v = R @ (B[3:] + np.cross(B[:3].T, r).T)
        columns.append(np.vstack([v, R @ B[:3]])[e.direction])
    moved = np.array(columns)
    if not kept:
        return moved
    J = np.array(numbers([x for row in kept for x in row])).reshape(len(kept), -1)
    _, sizes, V = np.linalg.svd(J)
    return np.asarray(moved @ V[int(np.sum(sizes > tolerances.RANK_NEARBY * max(sizes, default=1.0))) :].T)
