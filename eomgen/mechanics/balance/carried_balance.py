"""Balance -> the equations of each body together with all that it carries, about the point of its joint.

    F_i = f_i + sum of R_j F_j,    N_i = n_i - arm x f_i + sum of (R_j N_j + p_j x R_j F_j)      j: the bodies on i

In these what acts between bodies that are carried is absent: a joint's own reaction stands there alone, along axes that
do not turn against it, beside ties with other bodies. So elimination finds numbers where the equations of single bodies
have sines and cosines, which vanish at some state.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from eomgen.mechanics.balance.balance import Balance
from eomgen.mechanics.balance.components import Component, seen_by_carriers
from eomgen.mechanics.balance.unit_wrenches import Axes
from eomgen.mechanics.bodies.kinematics import GROUND, BodyLink
from eomgen.mechanics.constraints.ties import holds_identically
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.node import SparseRow
from eomgen.symbolic.expression.spatial import Matrix, Vector, apply, cross, minus, plus, vector_of
from eomgen.symbolic.solve.linear import Solution

NOTHING: tuple[Scalar, ...] = (0,) * 6
RIGHT = -1  # among the numbers of components: the right side
Turned = list[tuple[tuple[int, ...], Matrix]]  # the components of a hinge, and the axes that they were seen in


def with_what_is_carried(
    balance: Balance, rows: Sequence[SparseRow], needed: Sequence[Scalar]
) -> tuple[list[SparseRow], list[Scalar]]:
    """(coefficients, what they have to make up) of each equation of the balance, put together from the leaves inwards.

    Args:
        rows, needed: the same of the single bodies.
    """
    axes, links = Axes(balance.system.motion), balance.system.motion.links
    within = _carried(links)
    sides = [{**row, RIGHT: value} for row, value in zip(rows, needed, strict=True)]
    sixes = [_by_component(balance, link, sides) for link in links]
    for i in reversed(range(len(links))):
        arm = axes.arm(i, links[i].point)
        own = {j: _about_joint(arm, six) for j, six in sixes[i].items()}
        for k, link in enumerate(links):
            if link.parent == i:
                for j, six in sixes[k].items():
                    own[j] = _added(own.get(j, NOTHING), _seen_by_parent(axes, link, arm, six))
        sixes[i] = {j: six for j, six in own.items() if not _is_inside(balance, j, within[i])}
    found = [_row(sixes[balance.system.motion.index[e.body]], e.direction) for e in balance.equations]
    return [{j: x for j, x in row.items() if j != RIGHT} for row in found], [row.get(RIGHT, 0) for row in found]


def _by_component(balance: Balance, link: BodyLink, sides: Sequence[SparseRow]) -> dict[int, tuple[Scalar, ...]]:
    """{component: force and moment on one body}"""
    found: dict[int, list[Scalar]] = {}
    for equation, side in zip(balance.equations, sides, strict=True):
        if equation.body == link.name:
            for j, x in side.items():
                found.setdefault(j, [0] * 6)[equation.direction] = x
    return {j: tuple(six) for j, six in found.items()}


def _about_joint(arm: Vector, six: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """Force and moment about the joint's point, of those about the mass centre."""
    f, n = vector_of(six[:3]), vector_of(six[3:])
    return (*f, *minus(n, cross(arm, f)))


def _seen_by_parent(axes: Axes, link: BodyLink, arm: Vector, six: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """The force and moment about a body's joint, in the axes of its parent's equations and about the parent's joint."""
    f, n = vector_of(six[:3]), vector_of(six[3:])
    if not axes.plane:
        f, n = apply(link.local.R, f), apply(link.local.R, n)
    return (*f, *plus(n, cross(minus(axes.arm(link.parent, link.local.p), arm), f)))


def _added(a: Sequence[Scalar], b: Sequence[Scalar]) -> tuple[Scalar, ...]:
    return tuple(x + y for x, y in zip(a, b, strict=True))


def _row(sixes: dict[int, tuple[Scalar, ...]], direction: int) -> SparseRow:
    return {j: six[direction] for j, six in sixes.items() if not is_zero(six[direction])}


def _carried(links: Sequence[BodyLink]) -> list[frozenset[int]]:
    """Of each body itself and all that hang on it."""
    found: list[frozenset[int]] = [frozenset((i,)) for i in range(len(links))]
    for i in reversed(range(len(links))):
        if links[i].parent != GROUND:
            found[links[i].parent] |= found[i]
    return found


def _is_inside(balance: Balance, j: int, bodies: Iterable[int]) -> bool:
    """Whether a joint's component acts between two of these bodies: with one another it has no force and no moment."""
    if not 0 <= j < len(balance.components) or balance.components[j].kind == "tie":
        return False
    touched = {effect.link for effect in balance.components[j].effects}
    return len(touched) == 2 and touched <= {*bodies}


# -- hinges along the axes of the body that carries them -------------------------------------------


def along_carriers(balance: Balance, rows: Sequence[SparseRow]) -> tuple[list[SparseRow], Turned]:
    """The coefficients for forces of hinges along the axes of the body that carries both, and how these lie.

    What a plane loop leaves open lies along one of these, and not in between as in ground axes.
    """
    motion, seen = balance.system.motion, seen_by_carriers(balance.system)
    groups: dict[tuple[str, str, str], list[int]] = {}
    for j, (carrier, component) in seen.items():
        groups.setdefault((component.owner, component.side, carrier), []).append(j)
    hinges = {key: tuple(group) for key, group in groups.items() if len(group) == 3}
    own = {j: seen[j][1] for group in hinges.values() for j in group}
    found = [{**row, **_of_hinges(balance, n, row, own)} for n, row in enumerate(rows)]
    return found, [(group, motion.link(carrier).pose.R) for (_, _, carrier), group in hinges.items()]


def _of_hinges(balance: Balance, n: int, row: SparseRow, own: Mapping[int, Component]) -> SparseRow:
    """What a unit of each of these components gives to one equation."""
    equation = balance.equations[n]
    i = balance.system.motion.index[equation.body]
    six = {j: [e.six[equation.direction] for e in c.effects if e.link == i] for j, c in own.items()}
    return {j: sum(values, start=0) for j, values in six.items() if values or j in row}


def along_ground_again(solution: Solution, turned: Turned) -> Solution:
    """Forces of these hinges along the ground's axes: r = R r_C. A free one keeps its number, along its own axis."""
    constants, shares = dict(solution.constants), dict(solution.shares)
    for group, R in turned:
        own = [(solution.constants.get(j, 0), solution.shares.get(j, {j: -1})) for j in group]
        for j, row in zip(group, R, strict=True):
            constants[j] = sum((k * value for k, (value, _) in zip(row, own, strict=True)), start=0)
            total: SparseRow = {}
            for k, (_, share) in zip(row, own, strict=True):
                for f, x in share.items():
                    total[f] = total.get(f, 0) + k * x
            shares[j] = {f: x for f, x in total.items() if not is_zero(x) and not holds_identically(x)}
    return replace(solution, constants=constants, shares=shares)
