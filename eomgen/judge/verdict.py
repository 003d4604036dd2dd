"""What the judge says of one equation: right, wrong or undecided, up to what, and why."""

from __future__ import annotations

import html
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Any

from eomgen.documents.document import Document
from eomgen.documents.statements import Lines, Step
from eomgen.records import dataclass

RIGHT, WRONG, UNDECIDED = "right", "wrong", "undecided"
EXIT_CODES = {RIGHT: 0, WRONG: 5, UNDECIDED: 3}
UNREADABLE = 2  # an equation that cannot be read, or whose names mean nothing
LEVELS = (1, 2, 3)


@dataclass(frozen=True)
class Cause:
    """One mistake.

    Args:
        kind: missing_term, extra_term, sign, factor, wrong_axis, wrong_point, coriolis, constraint_force, unit,
            wrong_quantity (another one in its place), approximation, wrong_formula; other: unexplained.
        text: the sentence.
        term: what it concerns, as a formula, "".
        body, force: whose it is, "".
        quantity: what it concerns, in words: for a hint that does not tell all.
        others: kinds that would explain it as well.
        or_else: another sentence that would, and is believed nearly as readily; "".
    """

    kind: str
    text: str
    term: str = ""
    body: str = ""
    force: str = ""
    quantity: str = ""
    others: tuple[str, ...] = ()
    or_else: str = ""

    def as_dict(self) -> dict[str, Any]:
        return {
            "kind": self.kind,
            "term": self.term or None,
            "body": self.body or None,
            "force": self.force or None,
            "text": self.text,
            "other_kinds": list(self.others),
            "or_else": self.or_else or None,
        }

    @property
    def lines(self) -> tuple[str, ...]:
        """The sentence, and the other one."""
        return (self.text, f"or else: {self.or_else}") if self.or_else else (self.text,)

    def hint(self, level: int) -> str:
        """1: where to look; 2: which quantity; 3: all of it."""
        if level >= 3:
            return " ".join(self.lines)
        place = self.body or self.force
        if level == 2:
            return (
                f"Look at {self.quantity or 'the terms'}{f', {place}' if place and place not in self.quantity else ''}."
            )
        return f"Look at {place}." if place else f"Look at {AREAS.get(self.kind, 'the terms one by one')}."


AREAS = {
    "sign": "the signs",
    "factor": "the numbers before the terms",
    "missing_term": "what may be missing",
    "extra_term": "what there is too much",
    "wrong_axis": "the angles, and from where they are counted",
    "wrong_point": "the points: where things act and turn",
    "coriolis": "the products of speeds",
    "constraint_force": "which forces do work",
    "unit": "the units",
    "wrong_quantity": "which quantity stands where",
    "approximation": "what is taken as small",
    "wrong_formula": "which formula holds here",
}


@dataclass(frozen=True, repr=False)
class Verdict:
    """What the judge says of one equation.

    Args:
        given: as it was written.
        kind: motion, energy, force, reaction, velocity, acceleration, inertia, frequency, equilibrium, statics or law.
        verdict: "right", "wrong" or "undecided".
        up_to: what had to be used to see that it is right, in words; of what is wrong in some pieces of the model
            alone, in which it is right: "while y >= 0"; "" where nothing.
        substitution: what names had to be replaced by, {theta: "phi - pi/2"}.
        difference: left minus right that is too much, in the names of the model; "".
        causes: why it is wrong.
        reason: why it is undecided, in words.
        unknown: names in it that mean nothing; where there are some it is undecided.
    """

    given: str
    kind: str
    verdict: str
    up_to: str = ""
    substitution: Mapping[str, str] = field(default_factory=dict)
    difference: str = ""
    causes: tuple[Cause, ...] = ()
    reason: str = ""
    unknown: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return self.verdict == RIGHT

    def __repr__(self) -> str:
        return "\n".join(self.lines())

    def _repr_html_(self) -> str:
        """As the command line tells it."""
        return f"<pre>{html.escape(repr(self))}</pre>"

    @property
    def exit_code(self) -> int:
        return UNREADABLE if self.unknown else EXIT_CODES[self.verdict]

    def in_letters(self, letters: Mapping[str, str]) -> Verdict:
        """The same, functions by the letters that the author has for them: N_B for reaction_n(B).

        Where a letter does not say of what it is, the first in a sentence does: the tension S (cable).
        """

        def told(text: str) -> str:
            for function, letter in letters.items():
                of = "" if "/" in letter else function.partition("(")[2].removesuffix(")")
                whole = letter if of in letter else f"{letter} ({of})"
                text = text.replace(f" {function}", f" {whole}", 1).replace(function, letter)
            return text

        causes = (replace(x, text=told(x.text), term=told(x.term), or_else=told(x.or_else)) for x in self.causes)
        causes = (replace(x, quantity=told(x.quantity)) for x in causes)
        return replace(self, difference=told(self.difference), causes=tuple(causes)) if letters else self

    def hint(self, level: int = 3) -> str:
        """What helps the author: 1 where to look, 2 at which quantity, 3 the cause."""
        return " ".join(dict.fromkeys(cause.hint(level) for cause in self.causes))

    def as_dict(self, hint: int | None = None) -> dict[str, Any]:
        """For machines; with a hint only what that level tells."""
        told = {
            "given": self.given,
            "kind": self.kind,
            "verdict": self.verdict,
            "up_to": [self.up_to] if self.up_to else [],
            "substitution": dict(self.substitution) or None,
            "difference": self.difference or None,
            "causes": [cause.as_dict() for cause in self.causes],
            "hint": self.hint(hint or 3) or None,
        }
        if hint is not None and hint < 3 and self.verdict == WRONG:
            told |= {"difference": None, "causes": []}
        more: dict[str, Any] = {"unknown": list(self.unknown)} if self.unknown else {}
        return told | more | ({"reason": self.reason} if self.reason else {})

    def lines(self, hint: int | None = None) -> tuple[str, ...]:
        """As people read it."""
        found = [f"{self.verdict}: {self.given}"]
        if self.up_to:
            found.append(f"    {'right' if self.verdict == WRONG else 'up to'} {self.up_to}")
        found += [f"    with {name} = {value}" for name, value in self.substitution.items()]
        if self.reason:
            found.append(f"    {self.reason}")
        if hint is None or hint >= 3:
            found += [f"    {line}" for cause in self.causes for line in cause.lines]
            if self.difference:
                found.append(f"    too much on the left: {self.difference}")
        elif self.causes:
            found.append(f"    {self.hint(hint)}")
        return tuple(found)

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def document(self, title: str) -> Document:
        return Document(title, steps=(Step("", "", (Lines(self.lines()),)),), entries=self.as_dict)
