"""What was checked of a result, by which arithmetic, and whether it holds: a proof is a list of checks."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

from eomgen.records import dataclass

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


@dataclass(frozen=True)
class Certificate:
    """The proof that comes with a result."""

    checks: tuple[Check, ...]

    def __repr__(self) -> str:
        return f"<certificate: {self._headline}>"

    @property
    def ok(self) -> bool | None:
        """False: something contradicts the result. True: what was checked holds. None: nothing could be checked."""
        states = {check.status for check in self.checks}
        return False if "fails" in states else True if "holds" in states else None

    def __bool__(self) -> bool:
        return self.ok is True

    def __add__(self, more: Iterable[Check]) -> Certificate:
        return Certificate((*self.checks, *more))

    def __str__(self) -> str:
        lines = [f"certificate: {self._headline}"]
        for check in self.checks:
            lines.append(
                f"  {MARKS[check.status]} {check.name} [{check.how}]" + (f": {check.detail}" if check.detail else "")
            )
        return "\n".join(lines)

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
        """For `--json`."""
        rows = [{"name": c.name, "status": c.status, "ok": c.ok, "how": c.how, "detail": c.detail} for c in self.checks]
        return {"ok": self.ok, "checks": rows}
