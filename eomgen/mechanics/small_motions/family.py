"""The family of steady motions that one belongs to: top, governor, rolling disc in a circle."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State


@dataclass(frozen=True)
class Family:
    """The steady motions that one belongs to.

    Args:
        held: coordinates and speeds that say which of them it is.
        following: those that follow from these.
        conditions: what vanishes, of both.
        formulas: those that follow, as functions of the held; {}: no closed form.
        state: everything in closed form at the values of the start; {}: not known so.
        zeros: coordinates that are held at 0, by which other conditions are kept.
        others: those that follow, in all the motions with the same values held that were found, this one first.
        closed: the same as functions of the held; {} for one that has no closed form.
        complete: whether there are no others, where `where` says.
    """

    held: tuple[Node, ...]
    following: tuple[Node, ...]
    conditions: tuple[Scalar, ...]
    formulas: State
    state: State
    zeros: tuple[Node, ...] = ()
    others: tuple[Mapping[Node, float], ...] = ()
    closed: tuple[State, ...] = ()
    complete: bool = False
    where: str = ""
