"""What is found of an output, and how it is told: exact, as a number, by which way; else what is missing."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Answer:
    """One output's result.

    Args:
        exact: text of the grammar with every parameter as a symbol, or None.
        value: a number, parameters and start (or instant) put in, or None.
        unit: of both; "" for SI.
        method: how it was found.
        message: what is missing, or None.
    """

    exact: str | None = None
    value: float | None = None
    unit: str = ""
    method: str = ""
    message: str | None = None

    @property
    def answered(self) -> bool:
        return self.exact is not None or self.value is not None

    @property
    def lines(self) -> list[str]:
        """A line for each thing that is known of it."""
        if not self.answered:
            return [f"not answered: {self.message}"]
        found = [f"= {part}" for part in (self.exact, self._number) if part]
        found[-1] += f"   [{self.method}]"
        return [*found, f"({self.message})"] if self.message else found

    def as_dict(self) -> dict[str, Any]:
        """For `--json`."""
        return asdict(self)

    @property
    def _number(self) -> str:
        if self.value is None:
            return ""
        shown = f"{self.value:.10g}"
        return f"{shown} {self.unit}" if self.unit else shown

    def _repr_markdown_(self) -> str:
        parts = [f"`{self.exact}`" if self.exact is not None else "", self._number]
        return " = ".join(part for part in parts if part) or (self.message or "")


def table(answers: dict[str, Answer]) -> str:
    """The answers as text: exact, then the number and the way to it."""
    width = max((len(name) for name in answers), default=0)
    shown = []
    for name, answer in answers.items():
        first, *more = answer.lines
        shown.append(f"{name:<{width}}  {first}")
        shown += [f"{'':<{width}}  {line}" for line in more]
    return "".join(f"{line}\n" for line in shown)
