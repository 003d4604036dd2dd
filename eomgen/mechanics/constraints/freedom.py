"""Model -> Freedom: the degrees of freedom by rank, beside the count by formula; redundant ties by name.

By rank:     f = nu - rank J  at a generic configuration in which the ties hold; of a quaternion's four rates its norm
             takes one.
By formula:  f = 3 Nb + 2 Np - sum of the components of joints, ties and given motions
             (in space 6 Nb + 3 Np); it counts redundant components too, and then says too little.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eomgen.errors import DerivationError, MissingValues, NotYet
from eomgen.mechanics.bodies.contact_modes import ContactModes
from eomgen.mechanics.bodies.kinematics import BodyLink, Motion, motion_of
from eomgen.mechanics.bodies.scope import scope_of
from eomgen.mechanics.constraints.closure import generic_state, rows_where_closed
from eomgen.mechanics.constraints.elimination import dependent_coordinates, elimination_of
from eomgen.mechanics.constraints.integrability import Integrability, integrability_of
from eomgen.mechanics.constraints.ties import Ties, ties_of
from eomgen.mechanics.constraints.ways_of_bodies import is_placed, powers_of_rows
from eomgen.model.reader import ModelOrPath, model_at
from eomgen.model.replaced import Values
from eomgen.model.unbuilt import unbuilt_ties
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.dense import closed_entries, independent_rows
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY, SHARE

LONGER = 1e3  # times the length of another row: of another kind, as force and couple at a mechanism of micrometres
TwistColumns = tuple[tuple[Vector, Vector], ...]
RowName = tuple[str, int]  # of a tie, from 1


@dataclass(frozen=True)
class Redundant:
    """A row that holds what others hold already.

    Args:
        tie, number: the row, from 1.
        others: the other ties from which it follows.
        by_joints: whether joints alone hold it, and no tie.
    """

    tie: str
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
        redundant: closing rows that follow from those declared before them; then rows that only react, and hold what
            joints or other ties hold already.
        identical_rows: what the coordinates satisfy by themselves: it only carries a reaction.
        closing_rows: the others.
        not_counted: why not, or "".
        integrability: what the rows of velocities alone are, None where there are none; freedoms in position may be
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
        """The ties with rows that only carry a reaction."""
        return tuple(dict.fromkeys(tie for tie, _ in self.identical_rows))

    @property
    def closing(self) -> tuple[str, ...]:
        """The ties with rows that close."""
        return tuple(dict.fromkeys(tie for tie, _ in self.closing_rows))


def freedom_of(
    model: ModelOrPath,
    modes: ContactModes | None = None,
    *,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Freedom:
    """The degrees of freedom of a model, where its kinds are built; ties that move dependent coordinates close.

    Args:
        modes: how contacts are that can end; what is not named is closed.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        DerivationError: a tie that cannot hold; a dependent coordinate that no tie determines.
    """
    model = model_at(model, parameters, start)
    waiting = dict.fromkeys(kind for _, kind in unbuilt_ties(model))
    if waiting:
        return Freedom(not_counted=", ".join(waiting))
    try:
        ties = ties_of(motion_of(scope_of(model)), modes=modes)
    except NotYet as error:
        return Freedom(not_counted=error.what)
    if dependent_coordinates(ties.motion.scope):
        elimination_of(ties)
    count, formula = counted(ties)
    identical = tuple((row.tie, row.number) for row in ties.rows if row.identical)
    closing = tuple((row.tie, row.number) for row in ties.closing)
    try:
        state = generic_state(ties)
        redundant, integrability = redundant_rows(ties, state), integrability_of(ties)
        shared = rows_held_twice(ties, redundant, state)
    except (DerivationError, MissingValues) as error:
        return Freedom(None, count, formula, (), identical, closing, error.what)
    scope = ties.motion.scope
    speeds = len(scope.symbols.u) - len(scope.quaternions)
    by_rank = speeds - len(ties.closing) + len(redundant)
    return Freedom(by_rank, count, formula, (*redundant, *shared), identical, closing, integrability=integrability)


# -- by formula ------------------------------------------------------------------------------------


def counted(ties: Ties) -> tuple[int, str]:
    """3 Nb + 2 Np - sum of components (in space 6 Nb + 3 Np), as a number and as text."""
    motion = ties.motion
    of_body, of_particle = (3, 2) if motion.scope.model.space == "plane" else (6, 3)
    particles = [link for link in motion.links if is_particle(motion, link)]
    bodies = [link for link in motion.links if link not in particles]
    free = [(of_body, len(bodies), "bodies"), (of_particle, len(particles), "particles")]
    joints = sum(_components(ties, link, of_body, link.S) for link in bodies)
    joints += sum(_components(ties, link, of_particle, _sliding(link.S)) for link in particles)
    driven = sum(coordinate.driven for coordinate in motion.scope.model.coordinates.values())
    taken = [(joints, "joints"), (len(ties.rows), "ties"), (driven, "given motions")]
    total = sum(each * many for each, many, _ in free) - sum(value for value, _ in taken)
    text = " + ".join(f"{each}*{many} ({what})" for each, many, what in free if many)
    return total, text + "".join(f" - {value} ({what})" for value, what in taken if value)


def is_particle(motion: Motion, link: BodyLink) -> bool:
    """A point mass that its joint does not turn."""
    shape = motion.scope.model.bodies[link.name].shape
    turns = any(not is_zero(x) for w, _ in _ways(motion, link) for x in w)
    return shape is not None and shape.is_point and (is_placed(link) or not turns)


def _components(ties: Ties, link: BodyLink, free: int, columns: TwistColumns) -> int:
    """How many components of motion the joint takes; what is placed, or has no joint, keeps all.

    A variable that is a constant (`angle = 0`) is one more, unless a tie that this satisfies is counted for it.
    """
    if is_placed(link):
        return 0
    constant = sum(column not in _ways(ties.motion, link) for column in columns)
    satisfied = sum(row.identical and link.name in dict(row.wrenches) for row in ties.rows)
    return free - len(columns) + max(0, constant - satisfied)


def _ways(motion: Motion, link: BodyLink) -> TwistColumns:
    """The columns of S along which the joint moves."""
    if len(link.S) != len(link.s):  # of a quaternion
        return link.S
    return tuple(column for column, s in zip(link.S, link.s, strict=True) if motion.moves((s,)))


def _sliding(columns: TwistColumns) -> TwistColumns:
    """Those that turn nothing."""
    return tuple((w, v) for w, v in columns if all(is_zero(x) for x in w))


# -- by rank ---------------------------------------------------------------------------------------


def freedoms(ties: Ties, state: State | None = None) -> int:
    """nu - rank J; the state and the errors are those of `redundant_rows`."""
    scope = ties.motion.scope
    turning = sum(f"{four[0].name}'" in {u.name for u in scope.symbols.u} for four in scope.quaternions)
    return len(scope.symbols.u) - turning - rank_of_ties(ties, state)


def rank_of_ties(ties: Ties, state: State | None = None) -> int:
    """rank J, how many closing rows are independent; the state and the errors are those of `redundant_rows`."""
    return len(ties.closing) - len(redundant_rows(ties, state))


def redundant_rows(ties: Ties, state: State | None = None) -> tuple[Redundant, ...]:
    """The closing rows that follow from those before them, at a generic configuration in which the ties hold.

    Args:
        state: such a configuration, where one is known already.
    Raises:
        MissingValues: the ties cannot be closed without values for the parameters.
        DerivationError: they do not close near the start.
    """
    closing = ties.closing
    if not closing:
        return ()
    J = rows_where_closed(ties, state or generic_state(ties))
    kept = independent_rows(J, RANK_NEARBY)
    return tuple(
        Redundant(row.tie, row.number, _others(row.tie, J[i], [(closing[k].tie, J[k]) for k in kept if k < i]))
        for i, row in enumerate(closing)
        if i not in kept
    )


def rows_alike(ties: Ties) -> tuple[int, ...]:
    """Of each closing row a number that it has together with those with which it shares what it holds.

    Which of them is the one that follows may change along a motion: d cos q = 0 and d sin q = 0 hold d in turns. Rows
    are of one kind where their lengths are, at a generic state, within LONGER of one another.
    """
    own = tuple(range(len(ties.closing)))
    if len(own) < 2:
        return own
    try:
        J = rows_where_closed(ties, generic_state(ties))
    except (DerivationError, MissingValues, NoValue):
        return own
    kept, lengths, found = independent_rows(J, RANK_NEARBY), np.linalg.norm(J, axis=1), list(own)
    for i in own:
        if i in kept or not lengths[i]:
            continue
        shares = np.linalg.lstsq(J[kept].T, J[i], rcond=None)[0] * lengths[kept] / lengths[i]
        near = (lengths[kept] < LONGER * lengths[i]) & (LONGER * lengths[kept] > lengths[i])
        sharing = {found[k] for k, share, one in zip(kept, shares, near, strict=True) if one and abs(share) > SHARE}
        found = [min(sharing | {i}) if number in sharing | {i} else number for number in found]
    return tuple(found)


def rows_held_twice(ties: Ties, redundant: Sequence[Redundant], state: State) -> tuple[Redundant, ...]:
    """The rows that the coordinates satisfy and that joints, closing rows or such rows before them hold already.

    W^T xi of such a row depends on those of the others in all ways that the joints leave the bodies: where it carries
    a reaction, they share it.

    Args:
        redundant: closing rows that follow from others.
        state: a generic configuration in which the ties hold.
    """
    dropped = {(row.tie, row.number) for row in redundant}
    closing = [row for row in ties.closing if row.wrenches and (row.tie, row.number) not in dropped]
    reacting = [row for row in ties.rows if row.identical and row.wrenches and is_zero(row.direct)]
    if not reacting:
        return ()
    rows = [*closing, *reacting]
    touched = {body for row in reacting for body, _ in row.wrenches}
    lines = closed_entries(powers_of_rows(ties.motion, rows, state, touched))
    kept = independent_rows(lines, RANK_NEARBY)
    found = []
    for i in range(len(closing), len(rows)):
        if i not in kept:
            before = [(rows[k].tie, lines[k]) for k in kept if k < i]
            alone = not np.any(lines[i])
            found.append(
                Redundant(rows[i].tie, rows[i].number, () if alone else _others(rows[i].tie, lines[i], before), alone)
            )
    return tuple(found)


def _others(tie: str, line: np.ndarray, kept: list[tuple[str, np.ndarray]]) -> tuple[str, ...]:
    """The ties that make up a redundant row."""
    if not kept:
        return ()
    shares = np.linalg.lstsq(np.array([row for _, row in kept]).T, line, rcond=None)[0]
    names = (name for (name, _), share in zip(kept, shares, strict=True) if abs(share) > SHARE)
    return tuple(name for name in dict.fromkeys(names) if name != tie)
