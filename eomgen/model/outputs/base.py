"""What an output function says of itself: its names, arguments, unit, its value, and a second way to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.catalog import Catalog
from eomgen.model.fields import Leaf
from eomgen.model.findings import Finding
from eomgen.model.outputs.context import OutputContext, Trial
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Call, Expression, Reference, parse
from eomgen.symbolic.expression.spatial import AnyScalar
from eomgen.symbolic.expression.units import Unit, parse_unit

AXES = {"x": 0, "y": 1, "z": 2}
SIDES = ("before", "after")

STATE = ""
BALANCE = "balance of the bodies"
MASSES = "distribution of mass"
SMALL_MOTIONS = "small motions"
OF_A_RUN = "a run"

ValueOf = Callable[[OutputContext, Call], AnyScalar]
SecondOf = Callable[[Trial, Call], Any]


def _none(catalog: Catalog, leaf: Leaf, call: Call) -> Iterator[Finding]:
    return iter(())


@dataclass(frozen=True, kw_only=True)
class OutputFunction:
    """One function of the motion, or the components of one vector.

    Args:
        names: as a file calls it.
        kinds: of its arguments, of which `least` are needed; `more` is the kind of any number of further ones.
        unit: SI.
        per: the arguments by whose unit it is divided: a coordinate's, the rate's of a "coordinate or speed", the
            gap's of a tie.
        like: the argument whose unit it has.
        gives: what, in models/README.md.
        value: in q, u, a, lam, t and the parameters.
        second: what it is worth in numbers, by a way that shares only poses and masses with `value`; None: there is
            none here, and what proves it is said where `source` is asked.
        source: what it is found from: STATE, BALANCE, MASSES, SMALL_MOTIONS or OF_A_RUN.
        moves: whether velocities or accelerations stand in it.
        shown: its arguments as models/README.md writes them, where the kinds do not say it.
        findings: what else is wrong with a call of it.
    """

    names: tuple[str, ...]
    kinds: tuple[str, ...]
    least: int
    more: str = ""
    unit: str
    per: tuple[int, ...] = ()
    like: int | None = None
    gives: str
    value: ValueOf
    second: SecondOf | None = None
    source: str = STATE
    moves: bool = False
    shown: str = ""
    findings: Callable[[Catalog, Leaf, Call], Iterator[Finding]] = _none

    @property
    def arguments(self) -> str:
        """(point[, body[, body]])"""
        if self.shown:
            return self.shown
        optional = [*self.kinds[self.least :], *([f"{self.more}, ..."] if self.more else [])]
        text = ", ".join(self.kinds[: self.least])
        for kind in optional:
            text += f"[, {kind}" if text else f"[{kind}"
        return f"({text}{']' * len(optional)})"

    @property
    def is_along_freedoms(self) -> bool:
        """Whether it depends on which coordinates are free: dT/dq' is another one where fewer are."""
        return any(kind.startswith("coordinate") for kind in self.kinds)

    @property
    def row(self) -> str:
        """Its line in the table of models/README.md."""
        unit = "of the formula" if self.like is not None else self.unit
        unit = unit if not self.per else f"{self.unit} per {' and '.join(self.kinds[k] for k in self.per)}"
        return f"| `{' '.join(self.names)}` {self.arguments} | {self.gives} | {unit} |"

    @property
    def dimension(self) -> Unit:
        """That of its unit; of what is `per` an argument without that argument's share."""
        return parse_unit(self.unit)


def along(*names: str) -> tuple[str, ...]:
    """Each name with x, y and z in place of its star."""
    return tuple(name.replace("*", axis) for name in names for axis in AXES)


def component(call: Call) -> int:
    """Which component a name ends in: 0 of vx, 2 of omega_z."""
    return AXES[call.name[-1]]


def names_of(call: Call) -> tuple[str, ...]:
    """The arguments of a call, all of them names.

    Raises:
        DerivationError: one is none.
    """
    return tuple(name_at(call, k) for k in range(len(call.args)))


def name_at(call: Call, k: int) -> str:
    """The argument k of a call, a name.

    Raises:
        DerivationError: it is none.
    """
    argument = call.args[k]
    if not isinstance(argument, Reference):
        raise DerivationError(f"'{call}': names are needed as arguments", mend="give names of the model, not formulas")
    return argument.name


def formula_at(call: Call, k: int) -> Expression:
    """The argument k of a call, a formula; a lone name or member reads like a reference."""
    argument = call.args[k]
    return parse(argument.name, references=True) if isinstance(argument, Reference) else argument


def number_at(call: Call, k: int, most: int) -> int:
    """The argument k of a call, a whole number from 1 on.

    Raises:
        DerivationError: it is none.
    """
    argument = call.args[k]
    number = argument.literal if isinstance(argument, Expression) else None
    if not isinstance(number, int) or not 1 <= number <= most:
        raise DerivationError(
            f"'{call}': a number from 1 to {most} is needed, not '{argument}'", mend="give a whole number"
        )
    return number
