"""Model -> Freedom: the degrees of freedom by rank; the integrability of velocity constraints."""

from __future__ import annotations

from collections.abc import Container, Sequence
from itertools import combinations_with_replacement
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues, NotYet
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints.closure import Closure
from eomgen.mechanics.constraints.elimination import Elimination
from eomgen.mechanics.constraints.rows import Constraints, Row, holds_identically
from eomgen.mechanics.kinematics import (
    GROUND,
    BodyLink,
    ContactModes,
    Motion,
    Scope,
    SystemScene,
    primitive,
)
from eomgen.mechanics.state import Numbers
from eomgen.model import Model
from eomgen.symbolic.exact import LinearSystem, Pivots, simplest
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    State,
    Vector,
    depends_on,
    gradient,
    is_zero,
    jacobian,
    over,
    substituted,
    tangent,
)
from eomgen.symbolic.numeric import (
    NoValue,
    Work,
    closed_entries,
    evaluate,
    fifty_digits,
    independent_rows,
    lengths_of,
    tolerances,
)
from eomgen.symbolic.print import text_size

# -------- freedom ---------------------------------------------------------------------------------------------
# Model -> Freedom: the degrees of freedom by rank and by the count of formulas; redundant constraints by name.
#
# By rank:     f = nu - rank J  at a generic configuration in which the constraints hold; the norm of a quaternion
#              takes one of its four rates.
# By formula:  f = 3 Nb + 2 Np - sum of the components of joints, constraints and given motions
#              (in space 6 Nb + 3 Np); it counts redundant components too, and then says too little.


LONGER = 1e3  # times the length of another row: of another kind, as force and couple at a mechanism of micrometres
TwistColumns = tuple[tuple[Vector, Vector], ...]
RowName = tuple[str, int]  # of a constraint, from 1


@dataclass(frozen=True)
class Redundant:
    """A row that holds what others hold already.

    Args:
        constraint, number: the row, from 1.
        others: the other constraints from which it follows.
        by_joints: whether joints alone hold it, and no constraint.
    """

    constraint: str
    number: int
    others: tuple[str, ...]
    by_joints: bool = False


@dataclass(frozen=True)
class Freedom:
    """Degrees of freedom of a model.

    Args:
        by_rank: nu - rank J, None where it was not counted.
        by_formula: 3 Nb + 2 Np - the components, None where it was not counted.
        formula: the same as text.
        redundant: constraint rows that follow from those declared before them; then rows that only react, and hold what
            joints or other constraints hold already.
        identical_rows: rows that the coordinates satisfy by themselves: they only carry a reaction.
        closing_rows: the others.
        not_counted: why not, or "".
        integrability: of the rows of velocities alone, None where there are none; degrees of freedom in position may be
            more than those in velocity.
    """

    by_rank: int | None = None
    by_formula: int | None = None
    formula: str = ""
    redundant: tuple[Redundant, ...] = ()
    identical_rows: tuple[RowName, ...] = ()
    closing_rows: tuple[RowName, ...] = ()
    not_counted: str = ""
    integrability: Integrability | None = None

    @property
    def identical(self) -> tuple[str, ...]:
        """The constraints with rows that only carry a reaction."""
        return tuple(dict.fromkeys(constraint for constraint, _ in self.identical_rows))

    @property
    def closing(self) -> tuple[str, ...]:
        """The constraints with rows that close."""
        return tuple(dict.fromkeys(constraint for constraint, _ in self.closing_rows))

    @classmethod
    def of(cls, model: Model, modes: ContactModes | None = None) -> Freedom:
        """The degrees of freedom of a model, where its kinds are built.

        Constraints that move dependent coordinates close.

        Args:
            modes: how contacts are that can end; what is not named is closed.
        Raises:
            DerivationError: a constraint that cannot hold; a dependent coordinate that no constraint determines.
        """
        waiting = dict.fromkeys(kind for _, kind in model.unbuilt_constraints)
        if waiting:
            return cls(not_counted=", ".join(waiting))
        try:
            constraints = Constraints.of(Motion.of(Scope.of(model)), modes=modes)
        except NotYet as error:
            return cls(not_counted=error.what)
        if constraints.motion.scope.dependent:
            Elimination.of(constraints)
        count, formula = Rank(constraints).counted()
        identical = tuple((row.constraint, row.number) for row in constraints.rows if row.identical)
        closing = tuple((row.constraint, row.number) for row in constraints.closing)
        try:
            state = Closure(constraints).generic()
            redundant, integrability = Rank(constraints).redundant(state), Rank(constraints).integrability
            shared = rows_held_twice(constraints, redundant, state)
        except (DerivationError, MissingValues) as error:
            return cls(None, count, formula, (), identical, closing, error.what)
        scope = constraints.motion.scope
        speeds = len(scope.symbols.u) - len(scope.quaternions)
        by_rank = speeds - len(constraints.closing) + len(redundant)
        return cls(by_rank, count, formula, (*redundant, *shared), identical, closing, integrability=integrability)


# -- by formula ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Rank:
    """Independence of constraint rows, at a generic configuration in which the constraints hold."""

    constraints: Constraints

    def counted(self) -> tuple[int, str]:
        """3 Nb + 2 Np - sum of components (in space 6 Nb + 3 Np), as a number and as text."""
        motion = self.constraints.motion
        of_body, of_particle = (3, 2) if motion.scope.model.space == "plane" else (6, 3)
        particles = [link for link in motion.links if motion.is_particle(link)]
        bodies = [link for link in motion.links if link not in particles]
        free = [(of_body, len(bodies), "bodies"), (of_particle, len(particles), "particles")]
        joints = sum(_components(self.constraints, link, of_body, link.S) for link in bodies)
        joints += sum(_components(self.constraints, link, of_particle, _sliding(link.S)) for link in particles)
        driven = sum(coordinate.driven for coordinate in motion.scope.model.coordinates.values())
        taken = [(joints, "joints"), (len(self.constraints.rows), "constraints"), (driven, "given motions")]
        total = sum(each * many for each, many, _ in free) - sum(value for value, _ in taken)
        text = " + ".join(f"{each}*{many} ({what})" for each, many, what in free if many)
        return total, text + "".join(f" - {value} ({what})" for value, what in taken if value)

    def redundant(self, state: State | None = None) -> tuple[Redundant, ...]:
        """The constraint rows that follow from those before them, at a configuration in which the constraints hold.

        Args:
            state: a generic one, where it is known already.
        Raises:
            MissingValues: the constraints cannot be closed without values for the parameters.
            DerivationError: they do not close near the start.
        """
        closing = self.constraints.closing
        if not closing:
            return ()
        J = Closure(self.constraints).rows_at(state or Closure(self.constraints).generic())
        kept = independent_rows(J, tolerances.RANK_NEARBY)
        return tuple(
            Redundant(
                row.constraint,
                row.number,
                _others(row.constraint, J[i], [(closing[k].constraint, J[k]) for k in kept if k < i]),
            )
            for i, row in enumerate(closing)
            if i not in kept
        )

    def regular(self) -> list[int]:
        """The constraint rows that do not follow from others."""
        dropped = {(row.constraint, row.number) for row in self.redundant()}
        closing = self.constraints.closing
        return [i for i, row in enumerate(closing) if (row.constraint, row.number) not in dropped]

    def rank(self, state: State | None = None) -> int:
        """rank J, how many constraint rows are independent; the state and the errors are those of `redundant`."""
        return len(self.constraints.closing) - len(self.redundant(state))

    def degrees_of_freedom(self, state: State | None = None) -> int:
        """nu - rank J; the state and the errors are those of `redundant`."""
        scope = self.constraints.motion.scope
        turning = sum(f"{four[0].name}'" in {u.name for u in scope.symbols.u} for four in scope.quaternions)
        return len(scope.symbols.u) - turning - self.rank(state)

    @property
    def alike(self) -> tuple[int, ...]:
        """Number of the group of each constraint row; rows of one group depend linearly on one another.

        The row of a group that is redundant may change along a motion: d cos q = 0, d sin q = 0 determine d in turns.
        Rows are of one kind where their lengths are, at a generic state, within LONGER of one another.
        """
        own = tuple(range(len(self.constraints.closing)))
        if len(own) < 2:
            return own
        try:
            J = Closure(self.constraints).rows_at(Closure(self.constraints).generic())
        except (DerivationError, MissingValues, NoValue):
            return own
        kept, lengths, found = independent_rows(J, tolerances.RANK_NEARBY), lengths_of(J, 1), list(own)
        for i in own:
            if i in kept or not lengths[i]:
                continue
            shares = np.linalg.lstsq(J[kept].T, J[i], rcond=None)[0] * lengths[kept] / lengths[i]
            near = (lengths[kept] < LONGER * lengths[i]) & (LONGER * lengths[kept] > lengths[i])
            sharing = {
                found[k]
                for k, share, one in zip(kept, shares, near, strict=True)
                if one and abs(share) > tolerances.SHARE
            }
            found = [min(sharing | {i}) if number in sharing | {i} else number for number in found]
        return tuple(found)

    @property
    def integrability(self) -> Integrability | None:
        """Integrability of the constraint rows of velocities alone, over the rates; None where there are none.

        Raises:
            MissingValues, DerivationError: the constraints cannot be satisfied near the start.
        """
        moving = tuple(row for row in self.constraints.closing if row.gap is None)
        if not moving:
            return None
        forms = _forms_of(self.constraints, Closure(self.constraints).generic())
        together = forms.allowed([form for _, form in forms.moving])
        complete = all(forms.closes(form, together) for _, form in forms.moving)
        rows = [_judged(forms, row, form, complete) for row, form in forms.moving]
        reached = together.shape[1] if complete else _reached(forms)
        return Integrability(tuple(rows), reached - 1)


def _components(constraints: Constraints, link: BodyLink, free: int, columns: TwistColumns) -> int:
    """Number of components of motion that the joint takes away; 0 for a placed body or one without a joint.

    A variable that is a constant (`angle = 0`) is one more, unless a constraint that this satisfies is counted for it.
    """
    if link.is_placed:
        return 0
    constant = sum(column not in constraints.motion.joint_columns(link) for column in columns)
    satisfied = sum(row.identical and link.name in dict(row.wrenches) for row in constraints.rows)
    return free - len(columns) + max(0, constant - satisfied)


def _sliding(columns: TwistColumns) -> TwistColumns:
    """The columns without a rotation."""
    return tuple((w, v) for w, v in columns if all(is_zero(x) for x in w))


# -- by rank ---------------------------------------------------------------------------------------


def rows_held_twice(constraints: Constraints, redundant: Sequence[Redundant], state: State) -> tuple[Redundant, ...]:
    """The rows that the coordinates satisfy and that joints, constraint rows or such rows before them hold already.

    W^T xi of such a row depends on those of the others in all ways that the joints leave the bodies: where it carries
    a reaction, they share it.

    Args:
        redundant: constraint rows that follow from others.
        state: a generic configuration in which the constraints hold.
    """
    dropped = {(row.constraint, row.number) for row in redundant}
    closing = [row for row in constraints.closing if row.wrenches and (row.constraint, row.number) not in dropped]
    reacting = [row for row in constraints.rows if row.identical and row.wrenches and is_zero(row.direct)]
    if not reacting:
        return ()
    rows = [*closing, *reacting]
    touched = {body for row in reacting for body, _ in row.wrenches}
    lines = closed_entries(powers_of_rows(constraints.motion, rows, state, touched))
    kept = independent_rows(lines, tolerances.RANK_NEARBY)
    found = []
    for i in range(len(closing), len(rows)):
        if i not in kept:
            before = [(rows[k].constraint, lines[k]) for k in kept if k < i]
            alone = not np.any(lines[i])
            found.append(
                Redundant(
                    rows[i].constraint,
                    rows[i].number,
                    () if alone else _others(rows[i].constraint, lines[i], before),
                    alone,
                )
            )
    return tuple(found)


def _others(constraint: str, line: np.ndarray, kept: list[tuple[str, np.ndarray]]) -> tuple[str, ...]:
    """The constraints that make up a redundant row."""
    if not kept:
        return ()
    shares = np.linalg.lstsq(np.array([row for _, row in kept]).T, line, rcond=None)[0]
    names = (name for (name, _), share in zip(kept, shares, strict=True) if abs(share) > tolerances.SHARE)
    return tuple(name for name in dict.fromkeys(names) if name != constraint)


# -------- ways of bodies --------------------------------------------------------------------------------------
# Motion, a state -> the twists of every body for each way in which the joints alone let it move, in numbers.
#
#     xi_i = Ad(parent -> i) xi_parent + S_i w_i,   w_i free;   of a body that is placed, all six of xi_i free
#
# Coordinates that move several joints together, and constraints, are left out of it: a row of a constraint whose
# wrenches do no work on any of these ways is held by joints alone.


def powers_of_rows(motion: Motion, rows: Sequence[Row], state: State, loose: Container[str]) -> np.ndarray:
    """The power of a unit of each row on each way, rows x ways.

    Args:
        loose: bodies whose joints are counted with the variables that are constants in them.
    """
    B = _twists(motion, state, loose)
    found = np.zeros((len(rows), B.shape[2]))
    for i, row in enumerate(rows):
        for body, W in row.wrenches:
            found[i] += _numbers((*W.tau, *W.f), state) @ B[motion.index[body]]
    return found


def _twists(motion: Motion, state: State, loose: Container[str]) -> np.ndarray:
    """Bodies x 6 x ways: (w, v) of each body's origin, body axes."""
    own = [_own_ways(motion, link, state, loose) for link in motion.links]
    total, first = sum(columns.shape[1] for columns in own), 0
    B = np.zeros((len(own), 6, total))
    for i, (link, columns) in enumerate(zip(motion.links, own, strict=True)):
        if link.parent != GROUND:
            B[i] = _carried(link, state) @ B[link.parent]
        B[i, :, first : first + columns.shape[1]] += columns
        first += columns.shape[1]
    return B


def _own_ways(motion: Motion, link: BodyLink, state: State, loose: Container[str]) -> np.ndarray:
    if link.is_placed:
        return np.eye(6) if motion.scope.model.space == "space" else np.eye(6)[:, 2:5]
    driven = [q for q in motion.scope.symbols.q if motion.scope.model.coordinates[q.name].driven]
    free = [q for q in motion.scope.symbols.q if q not in driven]
    moving = len(link.S) != len(link.s) or None
    kept = [
        column
        for k, column in enumerate(link.S)
        if moving or depends_on(link.s[k], free) or (link.name in loose and not motion.moves((link.s[k],)))
    ]
    S = _numbers([x for w, v in kept for x in (*w, *v)], state).reshape(-1, 6).T
    return _shifted(-_numbers(link.point, state)) @ S if kept else np.zeros((6, 0))


def _carried(link: BodyLink, state: State) -> np.ndarray:
    """Matrix from the parent's twist to that of a child fixed to it, at the child's origin."""
    R = _numbers([x for row in link.local.R for x in row], state).reshape(3, 3).T
    turned = np.block([[R, np.zeros((3, 3))], [np.zeros((3, 3)), R]])
    found: np.ndarray = _shifted(-_numbers(link.point, state)) @ turned @ _shifted(_numbers(link.local.p, state))
    return found


def _shifted(r: np.ndarray) -> np.ndarray:
    """(w, v) -> (w, v + w x r)"""
    x, y, z = r
    return np.block([[np.eye(3), np.zeros((3, 3))], [np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]]), np.eye(3)]])


def _numbers(scalars: Sequence[Scalar], state: State) -> np.ndarray:
    return np.array(Numbers(state).of(scalars))


# -------- integrability ---------------------------------------------------------------------------------------
# Constraints -> integrability of the rows of velocities alone, and the number of degrees of freedom in position.
#
# Over y = (q, t) a row J q' + sigma = 0 is a form w = J dq + sigma dt; rows with a gap, the norms of quaternions and
# driven coordinates are others, each of them integrable. By Frobenius a row can be integrated together with these
# where
#
#     dw(X, Y) = X^T (dw_b/dy_a - dw_a/dy_b) Y = 0   for all X, Y that all of them allow.
#
# The reachable directions are spanned by the fields X and their Lie brackets [X, Y] = (dY/dy) X - (dX/dy) Y, taken
# until nothing new comes: their dimension, less one for t, is the number of degrees of freedom in position
# (Rashevskii, Chow).
# Source: Bloch, Nonholonomic Mechanics and Control, 2nd ed., sections 2.2 and 4.1.


LONGEST = 400  # characters of a form that is integrated in closed form

DifferentialForm = tuple[Scalar, ...]


@dataclass(frozen=True)
class VelocityRow:
    """A row of velocities alone.

    Args:
        constraint, number: the row, from 1.
        integrable: it says the same as a gap.
        integral: phi(q, t), 0 at the start, that it keeps at zero, where it was found in closed form; else None.
    """

    constraint: str
    number: int
    integrable: bool
    integral: Scalar | None = None


@dataclass(frozen=True)
class Integrability:
    """Integrability of the rows of velocities alone.

    Args:
        rows: each of them.
        positions: the degrees of freedom in position; those in velocity are fewer where rows are not integrable.
    """

    rows: tuple[VelocityRow, ...]
    positions: int


@dataclass(frozen=True)
class _Forms:
    """The rows as forms over y = (q, t).

    Args:
        y: the coordinates, then t.
        held: of the rows that are integrable by what they are.
        moving: (row, form) of those of velocities alone.
        state: a generic one in which the constraints hold.
    """

    constraints: Constraints
    y: tuple[Node, ...]
    held: tuple[DifferentialForm, ...]
    moving: tuple[tuple[Row, DifferentialForm], ...]
    state: State

    def values(self, scalars: Sequence[Scalar]) -> list[Any]:
        return evaluate(scalars, self.state, fifty_digits())

    def numbers(self, scalars: Sequence[Scalar]) -> np.ndarray:
        return _numbers(scalars, self.state)

    def allowed(self, forms: Sequence[DifferentialForm]) -> np.ndarray:
        """A basis of what these forms and the held ones allow, one in each column."""
        rows = [self.numbers(form) for form in (*self.held, *forms)]
        A = np.array([row / (lengths_of(row) or 1) for row in rows])
        _, sizes, V = np.linalg.svd(A)
        return V[int(np.sum(sizes > tolerances.RANK)) :].T

    def closes(self, form: DifferentialForm, allowed: np.ndarray) -> bool:
        """dw(X, Y) = 0 of all that is allowed."""
        n = len(self.y)
        slopes = self.numbers([x for row in jacobian(form, self.y) for x in row]).reshape(n, n)
        turning = slopes.T - slopes  # entry (a, b): dw_b/dy_a - dw_a/dy_b
        size = max(1.0, float(np.abs(turning).max(initial=0)))
        return bool(np.abs(allowed.T @ turning @ allowed).max(initial=0) < tolerances.RANK * size)


def _judged(forms: _Forms, row: Row, form: DifferentialForm, complete: bool) -> VelocityRow:
    alone = forms.closes(form, forms.allowed([form]))
    return VelocityRow(
        row.constraint, row.number, alone or complete, integral_of(forms.constraints, form) if alone else None
    )


def _forms_of(constraints: Constraints, state: State) -> _Forms:
    scope = constraints.motion.scope
    q, t = scope.symbols.q, scope.symbols.t
    free = [k for k, x in enumerate(q) if not scope.model.coordinates[x.name].driven]

    def form(entries: dict[int, Scalar], at_rest: Scalar) -> DifferentialForm:
        written = (*(entries.get(k, 0) for k in range(len(q))), at_rest)
        return substituted(written, scope.laws) if scope.laws else written  # a name hides the time in a given rate

    rows = [
        (row, form(dict(zip(free, J, strict=True)), sigma))
        for row, J, sigma in zip(constraints.closing, constraints.J, constraints.sigma, strict=True)
    ]
    driven = [form({k: 1}, -nu) for k, nu in enumerate(scope.nu) if k not in free]
    norms = [form({q.index(e): e for e in four}, 0) for four in scope.quaternions]
    held = (*(w for row, w in rows if row.gap is not None), *driven, *norms)
    return _Forms(constraints, (*q, t), held, tuple((row, w) for row, w in rows if row.gap is None), state)


# -- what is reached -------------------------------------------------------------------------------


def _reached(forms: _Forms) -> int:
    """The dimension that the allowed fields and their brackets span."""
    first = _fields(forms)
    found = [(X, forms.numbers(X)) for X in first]
    most, newest = len(forms.y) - _rank([forms.numbers(w) for w in forms.held]), first
    while newest and len(found) < most:
        brackets = [_bracket(forms.y, X, Y) for X in first for Y in newest]
        newest = []
        for field in brackets:
            value = forms.numbers(field)
            if np.linalg.norm(value) > tolerances.CERTAIN_AT_50 and _rank([*(v for _, v in found), value]) > len(found):
                found.append((field, value))
                newest.append(field)
    return len(found)


def _fields(forms: _Forms) -> list[DifferentialForm]:
    """Fields that span what all rows allow, as functions of y."""
    n = len(forms.y)
    rows = [{k: x for k, x in enumerate(w) if not is_zero(x)} for w in (*forms.held, *(w for _, w in forms.moving))]
    solution = LinearSystem(rows, [0] * len(rows), n, forms.values).solution(Pivots(last=(n - 1,)))
    return [
        tuple(1 if k == f else -solution.shares[k].get(f, 0) if k in solution.shares else 0 for k in range(n))
        for f in solution.free
    ]


def _bracket(y: Sequence[Node], X: DifferentialForm, Y: DifferentialForm) -> DifferentialForm:
    """[X, Y] = (dY/dy) X - (dX/dy) Y"""
    along_X, along_Y = tangent(Y, dict(zip(y, X, strict=True))), tangent(X, dict(zip(y, Y, strict=True)))
    return tuple(a - b for a, b in zip(along_X, along_Y, strict=True))


def _rank(rows: Sequence[np.ndarray]) -> int:
    scaled = [row / (lengths_of(row) or 1) for row in rows]
    return int(np.linalg.matrix_rank(np.array(scaled), tol=tolerances.RANK)) if scaled else 0


# -- in closed form --------------------------------------------------------------------------------


def integral_of(constraints: Constraints, form: DifferentialForm) -> Scalar | None:
    """phi(q, t), 0 at the start, with dphi = k w for a factor k among 1, 1/w_i and 1/(w_i w_j); None: none found."""
    scope = constraints.motion.scope
    y = (*scope.symbols.q, scope.symbols.t)
    positive = scope.positive
    entries = [simplest(x, Work.FORMULA, positive) for x in form]
    if sum(text_size(x) for x in entries) > LONGEST:
        return None
    for factor in _factors(entries, y):
        try:
            found = _potential([simplest(x * factor, Work.FORMULA, positive) for x in entries], y)
        except (DerivationError, NoValue, ZeroDivisionError):  # no closed form
            found = None
        if found is not None:
            return simplest(found - SystemScene(constraints.motion).start(found), Work.FORMULA, positive)
    return None


def _factors(entries: Sequence[Scalar], y: Sequence[Node]) -> list[Scalar]:
    """1, and what is no constant of the others: a constant times an integral is one."""
    own = [x for x in entries if depends_on(x, y)]
    return [1, *(over(1, x) for x in own), *(over(1, a * b) for a, b in combinations_with_replacement(own, 2))]


def _potential(form: Sequence[Scalar], y: Sequence[Node]) -> Scalar | None:
    """phi with dphi/dy_k = w_k, one variable after the other; None where the form is not exact, or none is found."""
    slopes = jacobian(form, y)
    if any(not holds_identically(slopes[a][b] - slopes[b][a]) for a in range(len(y)) for b in range(a)):
        return None
    phi: Scalar = 0
    for k, w in enumerate(form):
        rest = w - (gradient(phi, y)[k] if type(phi) is Node else 0)
        if is_zero(rest) or holds_identically(rest):
            continue
        gained = primitive(simplest(rest, Work.FORMULA), y[k])
        if gained is None:
            return None
        phi = phi + gained
    return phi if all(holds_identically(a - b) for a, b in zip(gradient(phi, y), form, strict=True)) else None
