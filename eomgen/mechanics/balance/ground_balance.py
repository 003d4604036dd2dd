"""Balance -> the force equations of bodies that no joint holds, along the ground's axes.

The axes of a body spin with it. Where ties alone push it, along directions that do not, its force equations are short
in the ground's axes, R (sum of forces) = R m a, and their solutions divide by nothing that vanishes as the body turns.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from eomgen.mechanics.balance.balance import Balance
from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.symbolic.exact.normal_form import readable_all
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.node import SparseRow
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.numeric.work import Work


def along_ground(balance: Balance, rows: list[SparseRow], needed: list[Scalar]) -> tuple[list[SparseRow], list[Scalar]]:
    """(coefficients, what they have to make up), force equations turned where that makes them shorter."""
    rows, needed = list(rows), list(needed)
    if balance.system.scope.model.space == "plane" or any(c.frictional for c in balance.components):
        return rows, needed
    for i, link in enumerate(balance.system.motion.links):
        if not _held_by_ties_alone(balance, i):
            continue
        three = [n for n, e in enumerate(balance.equations) if e.body == link.name and e.direction < 3]
        if len(three) == 3:
            _turn(link, three, rows, needed)
    return rows, needed


def _held_by_ties_alone(balance: Balance, i: int) -> bool:
    kinds = {c.kind for c in balance.components if any(effect.link == i for effect in c.effects)}
    return kinds == {"tie"}


def _turn(link: BodyLink, three: Sequence[int], rows: list[SparseRow], needed: list[Scalar]) -> None:
    """The three equations times R, where the coefficients then take fewer operations."""
    own = sorted({j for n in three for j in rows[n]})
    columns = {j: [rows[n].get(j, 0) for n in three] for j in own}
    turned = [
        dict(zip(own, readable_all(tuple(inner(r, c) for c in columns.values()), Work.VALUE), strict=True))
        for r in link.pose.R
    ]
    if _work(x for row in turned for x in row.values()) >= _work(x for c in columns.values() for x in c):
        return
    right = readable_all(tuple(inner(r, [needed[n] for n in three]) for r in link.pose.R), Work.VALUE)
    for n, row, value in zip(three, turned, right, strict=True):
        rows[n], needed[n] = {j: x for j, x in row.items() if not is_zero(x)}, value


def _work(scalars: Iterable[Scalar]) -> int:
    return operations(tuple(scalars)).total
