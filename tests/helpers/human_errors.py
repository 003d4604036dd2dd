"""Equations that people get wrong, and right ones as they write them: how the judge fares.

`human_errors.txt` holds mistakes from the literature on misconceptions (the square of a relative velocity without its
product, Steiner's distance, moment arms, follower loads, rest lengths, absolute for relative damping, gears inverted,
N = m g on an incline, ...) in every kind of equation; `nearly_right.txt` what is wrong by little, or right in one place
alone; `right_disguises.txt` right ones from papers, notes and programs.

    python tests/helpers/human_errors.py                       # all tables
    python tests/helpers/human_errors.py first third           # those parts of the mistakes
"""

from __future__ import annotations

import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import eomgen
from eomgen.errors import EomgenError
from eomgen.judge.case import Case
from eomgen.judge.judge import Judge

HERE = Path(__file__).parent
OTHER = ("other", "wrong_quantity", "approximation", "wrong_formula", "factor")  # what `other` in the tables stands for
MODELS = HERE.parent.parent / "models"


@dataclass(frozen=True)
class Answer:
    """What somebody wrote.

    Args:
        kind: of the mistake; "" of what is right.
        causes, words: kinds of causes that name it, and words of which one must be told.
        part: the part of the file that it stands in.
        options: of `verify`.
    """

    model: str
    text: str
    options: tuple[tuple[str, str], ...] = ()
    kind: str = ""
    causes: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    part: str = ""

    def verdict(self) -> eomgen.Verdict:
        return _judge(self.model).verdict(self.text, **dict(self.options))

    def is_named(self, verdict: eomgen.Verdict) -> bool:
        """Whether one cause is told, and it is the mistake."""
        if verdict.verdict != "wrong" or len(verdict.causes) != (2 if self.kind == "two errors" else 1):
            return False
        reported = " ".join(f"{x.text} {x.term} {x.body} {x.force}" for x in verdict.causes)
        kinds = (*self.causes, *(OTHER if "other" in self.causes else ()))
        return verdict.causes[0].kind in kinds and (not self.words or any(word in reported for word in self.words))


@cache
def _judge(name: str) -> Judge:
    folder = HERE / "hand_models" if name.startswith("~") else MODELS
    return Judge(Case(eomgen.load(folder / f"{name.removeprefix('~')}.toml")))


def _lines(name: str) -> Iterator[tuple[str, list[str]]]:
    part = ""
    for line in (HERE / name).read_text().splitlines():
        if line.startswith("# -- "):
            part = line.split()[2]
        elif line.strip() and not line.startswith("#"):
            yield part, [x.strip() for x in line.split(" | ")]


def _options(given: list[str]) -> tuple[tuple[str, str], ...]:
    return tuple((name, value) for name, _, value in (each.partition(":") for each in given if each))


def wrong_answers() -> list[Answer]:
    """Every wrong one."""
    return [
        Answer(model, text, _options(more[1:]), kind, tuple(causes.split(",")), _words(more), part)
        for part, (kind, model, text, causes, *more) in _lines("human_errors.txt")
    ]


def _words(more: list[str]) -> tuple[str, ...]:
    return tuple(word for word in (more[0].split(",") if more else ()) if word not in ("", "-"))


def right_answers() -> list[Answer]:
    """Every right one."""
    return _answers("right_disguises.txt")


def nearly_right_answers() -> list[Answer]:
    """Every one that is wrong by little."""
    return _answers("nearly_right.txt")


def _answers(name: str) -> list[Answer]:
    return [Answer(model, text, _options(more)) for _, (model, text, *more) in _lines(name)]


def main(parts: Sequence[str]) -> None:
    wrong = [each for each in wrong_answers() if not parts or each.part in parts]
    more = [] if parts else [("wrong", nearly_right_answers()), ("right", right_answers())]
    for title, some in (("wrong", wrong), *more):
        table: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
        for each in some:
            row = table[each.part, each.kind]
            try:
                found = each.verdict()
                reported = "; ".join(f"[{x.kind}] {x.text}" for x in found.causes)
                row.update({"all": 1, found.verdict: 1, "named": each.is_named(found)})
            except EomgenError as error:
                found, reported = None, error.what
                row.update({"all": 1, "error": 1})
            if found is None or found.verdict != title or (each.causes and not each.is_named(found)):
                label = " ".join((found.verdict if found else "error", each.part, each.kind, each.model))
                print(f"{label}: {each.text}\n    {reported}")
        for (_, kind), row in sorted(table.items()):
            print(f"    {kind:16} {dict(row)}")
        for part in dict.fromkeys(each.part for each in some):
            print(f"  {part:18} {dict(sum((row for (of, _), row in table.items() if of == part), Counter()))}")
        models = len({each.model for each in some})
        total = sum(table.values(), Counter())
        print(f"{title}: {dict(total)}, {models} models, {time.process_time():.0f} s CPU\n")


if __name__ == "__main__":
    main(sys.argv[1:])
