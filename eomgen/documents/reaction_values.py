"""System -> every reaction in its shortest readable form, with the accelerations in it and without them.

A body held by more equations than it has unknowns gives a reaction in several ways that agree on every motion: from as
few equations as can be, or by all of them, projected on the reaction. The shorter one is read.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

from eomgen.documents.reading import TRIED, Reader, conditions_in, readable_value
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Combination
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.explicit_accelerations import short_accelerations
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.reactions import Reactions, reactions_of
from eomgen.mechanics.reactions.sides import reactions_by_sides
from eomgen.records import dataclass
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.exact.signs import never_vanishes
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import holds_op
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.length import length_of
from eomgen.symbolic.print.text import text_size

LONGEST = 3000  # characters of accelerations that are put into reactions
TOO_MANY = 2000  # components times equations, from which on one way must do


@dataclass(frozen=True)
class Readings:
    """The reactions of a system for a reader.

    Args:
        system: over its independent speeds.
        shown: the same, or with its dependent coordinates free: shorter, with their accelerations.
        reader: of formulas.
        accelerations: of the independent speeds as functions of q and u, {} where they are long.
    """

    system: System
    shown: System
    reader: Reader
    accelerations: Mapping[Node, Scalar]

    @cached_property
    def ways(self) -> tuple[Reactions, ...]:
        """Of the shown system, the one from few equations first."""
        return _ways(self.shown)

    @cached_property
    def sides(self) -> dict[int, Scalar]:
        """Of the shown system, the components that the balance of one side of their joint gives."""
        return reactions_by_sides(self.ways[0].balance)

    @cached_property
    def own_sides(self) -> dict[int, Scalar]:
        return self.sides if self.shown is self.system else reactions_by_sides(self.own_ways[0].balance)

    @cached_property
    def own_ways(self) -> tuple[Reactions, ...]:
        return self.ways if self.shown is self.system else _ways(self.system)

    def with_accelerations(self, combination: Combination, given: Scalar = 0) -> Scalar:
        """sum of combination * components + given, linear in the accelerations.

        Raises:
            Indeterminate: it has no single value.
        """
        by_side = _by_sides(self.sides, combination)
        values = [*([] if by_side is None else [by_side]), *(way.combined(combination, "") for way in self.ways)]
        return self._shortest([x + given for x in values])

    def without(self, combination: Combination, given: Scalar = 0) -> Scalar | None:
        """The same by the equations of motion; None where nothing accelerates in it, or that is long."""
        by_side = _by_sides(self.own_sides, combination)
        found_ways = [*([] if by_side is None else [by_side]), *(w.combined(combination, "") for w in self.own_ways)]
        values = [x + given for x in found_ways]
        if not self.accelerations or not all(depends_on(x, tuple(self.accelerations)) for x in values):
            return None
        found = self.replaced(values, lambda x: substituted((x,), self.accelerations)[0])
        return None if found is None or text_size(found) > TRIED else found

    def replaced(self, values: list[Scalar], by: Callable[[Scalar], Scalar]) -> Scalar | None:
        """The shortest of the values after a replacement; None where all of them are long."""
        short = [
            book_form(y, Work.ENTRY, self.system.scope.positive) if not conditions_in(y) else y
            for x in values
            if text_size(x) <= TRIED and text_size(y := by(x)) <= TRIED
        ]
        return self._shortest(short) if short else None

    def _shortest(self, values: list[Scalar]) -> Scalar:
        """The shortest; of those, where there are any, that divide by nothing that may vanish but as the loads do."""
        forms = list(dict.fromkeys(self.forms(values)))
        if len(forms) == 1:
            return forms[0]
        divisors = {x: vanishing_divisors(x) for x in forms}
        own = self._divisors_of_loads if all(divisors.values()) else frozenset()
        return min(forms, key=lambda x: (not divisors[x] <= own, length_of(x)))

    @cached_property
    def _divisors_of_loads(self) -> frozenset[Node]:
        """What the forces on the bodies divide by themselves, as a spring by its length."""
        loads = [e.needed for e in self.ways[0].balance.equations if holds_op(e.needed, "div")]
        return frozenset().union(*(vanishing_divisors(x) for x in self.forms(loads)))

    def forms(self, values: Sequence[Scalar]) -> list[Scalar]:
        """The values in readable form; without those that divide by zero in one of their cases.

        Raises:
            DerivationError: all of them do.
        """
        found: list[Scalar] = []
        failed: DerivationError | None = None
        for x in values:
            try:
                found.append(readable_value(self.reader, x, self.system.scope.positive))
            except DerivationError as error:
                failed = error
        if failed is not None and not found:
            raise failed
        return found


def readings_of(equations: EquationsOfMotion, reader: Reader, *, free: bool = False) -> Readings:
    """The reactions of a system for a reader.

    Args:
        free: dependent coordinates have accelerations of their own in the form with accelerations.
    Raises:
        DerivationError: a body is held by nothing; a force acts at no place.
    """
    system = equations.system
    found = short_accelerations(equations)
    long = found is None or sum(map(text_size, found)) > LONGEST
    accelerations = {} if found is None or long else dict(zip(equations.symbols.a, found, strict=True))
    return Readings(system, shown_system(system) if free else system, reader, accelerations)


def shown_system(system: System) -> System:
    """The system whose reactions are shown: dependent coordinates free, which is shorter; declared speeds stay."""
    return system if system.free is None or system.scope.model.speeds else system.free


def _by_sides(sides: Mapping[int, Scalar], combination: Combination) -> Scalar | None:
    """sum of combination * components; None where one of them is not known by its side."""
    if not combination.keys() <= sides.keys():
        return None
    total: Scalar = 0
    for j, k in combination.items():
        total = total + k * sides[j]
    return total


def vanishing_divisors(x: Scalar) -> frozenset[Node]:
    """The factors that x divides by and that vanish for some angles or at some places: sin(alpha)."""
    if not holds_op(x, "div"):
        return frozenset()
    pending = [node.args[1] for node in order((x,)) if node.op == "div"]
    factors = set()
    while pending:
        d = pending.pop()
        if type(d) is Node and d.op == "mul":
            pending += d.args
        elif type(d) is Node:
            factors.add(d)
    return frozenset(d for d in factors if not never_vanishes(d))


def _ways(system: System) -> tuple[Reactions, ...]:
    few = reactions_of(system, short=True)
    size = len(few.balance.equations) * len(few.components)
    return (few,) if size > TOO_MANY else (few, reactions_of(system))
