"""One test that asks each of many cases, as `pytest.mark.parametrize` does, and tells all that fail, not the first.

For cases that are quick: an id of their own costs more than they do. What the slow run alone asks: `slow_run`.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any

import pytest


def each(names: str, cases: Iterable[Any], *, by: str = "") -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The test asks every case, and fails with all failures of them, each under the case that it is of.

    With `by`, one of the names, it is one test for each value of this one, which asks the cases of that value.
    """
    arguments = tuple(name.strip() for name in names.split(","))
    given = [tuple(case) if len(arguments) > 1 else (case,) for case in cases]
    assert given and all(len(case) == len(arguments) for case in given), f"no cases, or not of {names}"

    def decorated(test: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(test)
        def every(**others: Any) -> None:
            which = others.get(by)
            failures: list[BaseException] = []
            skipped: list[BaseException] = []
            requested = [case for case in given if not by or case[arguments.index(by)] == which]
            for case in requested:
                try:
                    test(**{**others, **dict(zip(arguments, case, strict=True))})
                except pytest.skip.Exception as reason:
                    skipped.append(reason)
                except (Exception, pytest.fail.Exception) as failure:
                    failure.add_note(f"of {', '.join(f'{k}={x!r}' for k, x in zip(arguments, case, strict=True))}")
                    failures.append(failure)
            if failures:
                raise BaseExceptionGroup(f"{len(failures)} of {len(requested)} cases", failures)
            if skipped and len(skipped) == len(requested):
                raise skipped[0]

        signature = inspect.signature(test)
        rest = [x for name, x in signature.parameters.items() if name not in arguments or name == by]
        every.__signature__ = signature.replace(parameters=rest)  # type: ignore[attr-defined]
        if not by:
            return every
        values = list(dict.fromkeys(case[arguments.index(by)] for case in given))
        ids = [getattr(x, "stem", None) or getattr(x, "name", None) or str(x) for x in values]
        return pytest.mark.parametrize(by, values, ids=ids)(every)

    return decorated
