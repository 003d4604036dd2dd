"""Checks of a result, with the arithmetic and the outcome of each; a certificate is a list of checks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import field
from typing import Any, Literal

from eomgen.errors import EomgenError
from eomgen.frozen import dataclass
from eomgen.symbolic.numeric import NoValue, tolerances

Status = Literal["holds", "fails", "unchecked"]
MARKS: dict[Status, str] = {"holds": "ok  ", "fails": "FAIL", "unchecked": "?   "}
SIGNS: dict[Status, str] = {"holds": "✓", "fails": "✗", "unchecked": "?"}
WORDS = {True: "holds", False: "FAILS", None: "nothing could be checked"}


@dataclass(frozen=True)
class Check:
    """One thing that was checked.

    Args:
        name: what must hold, in words.
        status: whether it does; "unchecked" where no state has the values that it takes. Only a contradiction fails.
        how: by which arithmetic ("prime field" is exact; "50 digits"; "floating point").
        detail: what differs, or why it could not be checked, or "".
    """

    name: str
    status: Status
    how: str
    detail: str = ""

    @property
    def ok(self) -> bool | None:
        """True, False; None: it could not be checked."""
        return None if self.status == "unchecked" else self.status == "holds"


def checked(name: str, wrong: str, how: str) -> Check:
    """A check that holds where nothing is wrong; `wrong` says what differs, or is ""."""
    return Check(name, "fails" if wrong else "holds", how, wrong)


def unchecked(name: str, why: str, how: str) -> Check:
    """A check for which there is no state, no value or no time."""
    return Check(name, "unchecked", how, why)


def attempted(name: str, how: str, wrong: Callable[[], str]) -> Check:
    """A check that could not be made where its quantities have no value."""
    try:
        return checked(name, wrong(), how)
    except (NoValue, ZeroDivisionError) as error:
        return unchecked(name, str(error) or "no value", how)


def differing(found: float, right: float, share: float = tolerances.COMPUTED) -> str:
    """Difference of two numbers in words, where it is more than a share of the larger; ""."""
    if abs(found - right) <= share * max(abs(found), abs(right)) + tolerances.SOLVED:
        return ""
    return f"{found:.10g} for {right:.10g}"


def first_wrong(found: Iterable[str]) -> str:
    """The first thing that is wrong, or ""."""
    return next(filter(None, found), "")


def _line(check: Check) -> str:
    return f"  {MARKS[check.status]} {check.name} [{check.how}]" + (f": {check.detail}" if check.detail else "")


@dataclass(frozen=True)
class Certificate:
    """The proof that comes with a result."""

    checks: tuple[Check, ...]

    def __repr__(self) -> str:
        return f"<certificate: {self._headline}>"

    @property
    def ok(self) -> bool | None:
        """False if something contradicts the result, True if the checks made hold, None if nothing could be checked."""
        states = {check.status for check in self.checks}
        return False if "fails" in states else True if "holds" in states else None

    def __bool__(self) -> bool:
        return self.ok is True

    def __add__(self, more: Iterable[Check]) -> Certificate:
        return Certificate((*self.checks, *more))

    def __str__(self) -> str:
        return "\n".join([f"certificate: {self._headline}", *map(_line, self.checks)])

    @property
    def brief(self) -> str:
        """One line; where it fails, what fails below it."""
        failed = [check for check in self.checks if check.status == "fails"]
        count = sum(check.status != "unchecked" for check in self.checks)
        if self.ok is None:
            return f"certificate: unchecked ({len(self.checks)})"
        if not failed:
            return f"certificate: holds ({count} check{'s' * (count != 1)})"
        return "\n".join([f"certificate: FAILS ({len(failed)} of {count})", *map(_line, failed)])

    @property
    def _headline(self) -> str:
        count = sum(check.status != "unchecked" for check in self.checks)
        left = len(self.checks) - count
        return f"{WORDS[self.ok]} ({count} check{'s' * (count != 1)}{f', {left} not possible' if left else ''})"

    def _repr_markdown_(self) -> str:
        rows = [f"| {SIGNS[c.status]} | {c.name} | {c.how} | {c.detail} |" for c in self.checks]
        head = f"**Certificate: {WORDS[self.ok]}**\n\n| | what | how | |\n|---|---|---|---|"
        return "\n".join([head, *rows])

    def as_dict(self) -> dict[str, Any]:
        """Content for `--json`."""
        rows = [{"name": c.name, "status": c.status, "ok": c.ok, "how": c.how, "detail": c.detail} for c in self.checks]
        return {"ok": self.ok, "checks": rows}


@dataclass
class Tally:
    """Count of comparisons made so far, with their outcomes.

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
        """Adds one comparison, which gives the difference in words, or ""; one without a value is left unchecked."""
        try:
            found = compared()
        except (NoValue, ZeroDivisionError) as error:
            self.left[what] = str(error) or "no value"
        except EomgenError as error:  # an error of the model or of the derivation makes the comparison unchecked
            self.left[what] = error.what
        else:
            self.held += not found
            self.wrong += [f"{what}: {found}"] if found else []

    def checks(self) -> Iterator[Check]:
        """One check of the comparisons made, then those of the comparisons that could not be made."""
        if self.wrong:
            yield checked(self.name, "; ".join(self.wrong[:3]), self.how)
        elif self.held:
            yield Check(self.name, "holds", self.how, f"of {self.held}")
        for why in dict.fromkeys(self.left.values()):
            names = ", ".join(what for what, reason in self.left.items() if reason == why)
            yield unchecked(self.name, f"{names}: {why}", self.how)
