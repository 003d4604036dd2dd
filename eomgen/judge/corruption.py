"""One thing that may have gone wrong in an equation, and how readily it is believed."""

from __future__ import annotations

from eomgen.records import dataclass
from eomgen.symbolic.expression.node import ScalarRow

# how readily a mistake is believed, the smaller the sooner
PLAIN, PLACED, SHARED, PIECES, TERMS, EXCHANGED, ODD = range(7)
SHORTER = 0.3  # of what a shorter name tells as well


@dataclass(frozen=True)
class Corruption:
    """One thing that may have gone wrong.

    Args:
        name: what it concerns, in words; of a wrong factor the contribution.
        kind: of the cause: "factor" where the factor is open, else as in `AREAS`.
        rows: what one unit of it adds to each equation.
        rank: how readily it is believed.
        body, force: whose it is.
        open: whether any simple factor is possible; else it is there once.
        text: the sentence, of what is there once.
        squares: it is made of squares of speeds, of which nobody takes the wrong sign.
    """

    name: str
    kind: str
    rows: ScalarRow
    rank: float
    body: str = ""
    force: str = ""
    open: bool = True
    text: str = ""
    squares: bool = False
