"""Many comparisons of one kind -> one check of those that could be made, one of those that could not."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import field

from eomgen.errors import EomgenError
from eomgen.proof.check import Check, checked, unchecked
from eomgen.records import dataclass
from eomgen.symbolic.numeric.evaluation import NoValue


@dataclass
class Tally:
    """What was compared so far, and with what outcome.

    Args:
        name, how: of the check.
        held: how many hold.
        wrong: what differs, in words.
        left: {what could not be compared: why}.
    """

    name: str
    how: str
    held: int = 0
    wrong: list[str] = field(default_factory=list)
    left: dict[str, str] = field(default_factory=dict)

    def add(self, what: str, compared: Callable[[], str]) -> None:
        """One comparison: what differs in words, or ""; what has no value or is not derived is left."""
        try:
            found = compared()
        except (NoValue, ZeroDivisionError) as error:
            self.left[what] = str(error) or "no value"
        except EomgenError as error:  # the edge of a proof: whatever refuses is said to be unchecked
            self.left[what] = error.what
        else:
            self.held += not found
            self.wrong += [f"{what}: {found}"] if found else []

    def checks(self) -> Iterator[Check]:
        """Of what was compared, then of what could not be."""
        if self.wrong:
            yield checked(self.name, "; ".join(self.wrong[:3]), self.how)
        elif self.held:
            yield Check(self.name, "holds", self.how, f"of {self.held}")
        for why in dict.fromkeys(self.left.values()):
            names = ", ".join(what for what, reason in self.left.items() if reason == why)
            yield unchecked(self.name, f"{names}: {why}", self.how)
