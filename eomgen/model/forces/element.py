"""What a spring, a damper or a pull between two things is, as it is declared: fields and names alone, no formulas.

Proofs look at it.
"""

from eomgen.records import dataclass
from eomgen.symbolic.expression.formula import Expression


@dataclass(frozen=True)
class Element:
    """What acts between two points, or turns two bodies against one another.

    Args:
        points: its ends; () for what turns bodies.
        bodies: the first and the second; None: the ground.
        along: a fixed direction along which its length is measured; None: from end to end.
        stiffness, damping: of length and its rate, of angle and its rate; None: 0.
        slack: the length, or angle, at which a spring pulls nothing, or "start"; None: 0.
        pull: a law of the length `r` and its rate `r'`; None: 0.
    """

    points: tuple[str, ...] = ()
    bodies: tuple[str | None, ...] = ()
    along: tuple[Expression, ...] | None = None
    stiffness: Expression | None = None
    damping: Expression | None = None
    slack: Expression | str | None = None
    pull: Expression | None = None
