"""Functions by cases that a language lacks, or where its own drops a NaN: written once, printed by its words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

CASES = {  # arguments, (condition, value) ..., the value where none holds
    "sign": ("a", (("a > 0", "1"), ("a < 0", "-1")), "a"),
    "min": ("a, b", (("a < b || a != a", "a"),), "b"),
    "max": ("a, b", (("a > b || a != a", "a"),), "b"),
    "less": ("a, b", (("a < b", "1"), ("a >= b", "0")), "nan"),
    "less_equal": ("a, b", (("a <= b", "1"), ("a > b", "0")), "nan"),
    "select": ("given, a, b", (("given == 0", "b"), ("given == given", "a")), "given"),
}


def by_cases(
    form: str,
    choice: str = "{condition} ? {value} : {otherwise}",
    *,
    argument: str = "{name}",
    number: str = "{value}",
    ends: str = "{value}",
    words: Mapping[str, str] = {},
    only: Iterable[str] = CASES,
) -> dict[str, str]:
    """The definition of each op.

    Args:
        form: of one, with {name}, {arguments} and {value}.
        choice: of two values by a condition; ends: what stands where no condition is left.
        argument, number: how an argument is declared, and a number written that is a value.
        words: of the language, for "nan", other names, parts of conditions.
        only: which ops.
    """
    known = re.compile("|".join(rf"(?<![\w.]){re.escape(word)}(?![\w.])" for word in words) or "(?!)")

    def said(text: str) -> str:
        return known.sub(lambda found: words[found[0]], text)

    def valued(text: str) -> str:
        return number.format(value=text) if text.lstrip("-").isdigit() else said(text)

    def defined(op: str) -> str:
        arguments, cases, last = CASES[op]
        value = ends.format(value=valued(last))
        for condition, one in reversed(cases):
            value = choice.format(condition=said(condition), value=valued(one), otherwise=value)
        declared = ", ".join(argument.format(name=name) for name in arguments.split(", "))
        return form.format(name=said(op), arguments=declared, value=value)

    return {op: defined(op) for op in only}
