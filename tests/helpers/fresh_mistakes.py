"""Mistakes in models that the judge had not seen, made without a look at what it knows: how it fares with them.

Beside each model of `fresh_mistakes/` stands a file of lines: the kind of the mistake, or `right`; the equation; of a
mistake the words of which one of each group (`a,b+c,d`) must be told; options of `verify`. Those of odd numbers were
looked at when the judge was fixed afterwards (2026-11-23), of those of even numbers hardly any.

    python tests/helpers/fresh_mistakes.py                     # of all; or: odd, even
    python tests/helpers/fresh_mistakes.py all textbook_mistakes    # of another folder: 60 of textbooks, 2026-11-26
    python tests/helpers/fresh_mistakes.py all cut_mistakes         # 210 in balances of what is cut free, 2026-11-27
    python tests/helpers/fresh_mistakes.py odd unseen_mistakes      # 150 of a stranger, 2026-11-27; even: 150 more
    python tests/helpers/fresh_mistakes.py even blind_mistakes      # 125 of two more, first judged at the end of all
    python tests/helpers/fresh_mistakes.py even sheet_mistakes    # 100 lines of new sheets, right and wrong, 2026-11-30
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import eomgen
from eomgen.errors import EomgenError
from eomgen.judge.case import Case
from eomgen.judge.judge import Judge

HERE = Path(__file__).parent
PARTS = {"odd": (1,), "even": (0,), "all": (0, 1)}


def lines(path: Path) -> Iterator[tuple[str, str, list[list[str]], dict[str, str]]]:
    """(kind, equation, groups of words, options) of each line."""
    for line in path.read_text().splitlines():
        kind, text, *rest = (x.strip() for x in line.split(" | "))
        words = rest.pop(0) if rest and (kind != "right" or rest[0] == "-") else ""
        groups = [[word.strip() for word in group.split(",")] for group in words.split("+")] if words else []
        yield kind, text, groups, dict(option.split(":", 1) for option in rest)


def reported(judge: Judge, text: str, options: dict[str, str]) -> tuple[str, str]:
    """(verdict, the causes that are named, and what would explain it as well); `refused` where there is no verdict."""
    if "from_rest" in options or "to_first_order" in options:
        judge = Judge(Case(judge.case.model, at_rest="from_rest" in options), "to_first_order" in options)
    try:
        found = judge.verdict(text, **{name: x for name, x in options.items() if name in ("at", "kind")})
    except EomgenError as error:
        return "refused", str(error)
    named = [cause for cause in found.causes if cause.kind != "other"]
    texts = [f"[{x.kind}] {x.text} ({x.term})" for x in named] + [f"or else: {x.or_else}" for x in named if x.or_else]
    return found.verdict, "; ".join(texts)


def is_named(causes: str, groups: list[list[str]]) -> bool:
    """Whether a word of each group is told; `-` stands for what nobody could say.

    Words without capitals are looked for in any: R - r is meant by r - r, Steiner by steiner.
    """
    if not any(c.isupper() for group in groups for word in group for c in word):
        causes = f"{causes} {causes.lower()}"
    return causes != "" and groups not in ([], [["-"]]) and all(any(w in causes for w in g) for g in groups)


def main(part: str = "all", folder: str = "fresh_mistakes") -> int:
    count: Counter[str] = Counter()
    for path in sorted((HERE / folder).glob("*.toml")):
        if int(path.stem[:2]) % 2 not in PARTS[part]:
            continue
        judge = Judge(Case(eomgen.load(path)))
        for kind, text, groups, options in lines(path.with_suffix(".eq")):
            verdict, causes = reported(judge, text, options)
            named = kind != "right" and verdict == "wrong" and is_named(causes, groups)
            first = named and is_named(causes.partition("; or else: ")[0], groups)
            if kind == "right":
                count["right"] += 1
                count["accepted"] += verdict == "right"
            else:
                count["mistakes"] += 1
                count["told wrong"] += verdict == "wrong"
                count["taken for right"] += verdict == "right"
                count["cause named"] += named
                count["in the first sentence"] += first
                count["another cause told"] += verdict == "wrong" and causes != "" and not named
            sought = "" if named or kind == "right" else f"\n    not named: {' + '.join(map(' or '.join, groups))}"
            print(f"{verdict:10} {path.stem} [{kind}] {text}\n    {causes}{sought}", flush=True)
    print(", ".join(f"{name}: {n}" for name, n in count.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
