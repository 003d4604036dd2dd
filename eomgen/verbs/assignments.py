"""Values typed on the command line: NAME=VALUE and equations, in the units of the file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from eomgen.documents import listed, nearest_name
from eomgen.errors import ExpressionError, UsageError
from eomgen.model import AtRest, Model, Taken, Valued, equation_typed, with_values

OPTIONS = {"set_": "--set", "start": "--start", "from_rest": "--from-rest", "at": "--at", "until": "--until"}
OPTIONS |= {"given": "--given"}
"""The options whose values have units, by the names of their arguments."""
EXAMPLES = {"--set": "--set m=2", "--start": "--start theta=1", "--from-rest": '--from-rest "theta=0"'}


def typed(model: Model, options: Mapping[str, Any]) -> tuple[Valued, dict[str, Any]]:
    """The model with the values that were typed, and their record; the other options, equations in SI.

    Raises:
        UsageError: a name that there is not; a value, a unit or an equation that is none.
    """
    left = {name: value for name, value in options.items() if name not in ("set_", "start")}
    given, start = (dict(assignments(options.get(name, ()), EXAMPLES[OPTIONS[name]])) for name in ("set_", "start"))
    valued = with_values(model, given, start, options=("--set", "--start"), declared=True)
    taken = list(valued.taken)
    if left.get("from_rest"):
        rest = dict(assignments(split_words(left["from_rest"]), EXAMPLES["--from-rest"]))
        refuse_no_place(model, rest)
        placed = with_values(valued.model, None, rest, options=("--set", "--from-rest"), declared=True)
        left["from_rest"] = {name: placed.model.coordinates[name].start for name in rest}
        taken += placed.taken
    for name in ("at", "until"):
        if left.get(name) is not None and not isinstance(left[name], AtRest):
            left[name], found = _equation(valued.model, left[name], OPTIONS[name])
            taken += found
    if left.get("given"):
        pairs = [_equation(valued.model, text, OPTIONS["given"]) for text in left["given"]]
        left["given"] = tuple(equation for equation, _ in pairs)
        taken += [each for _, found in pairs for each in found]
    return Valued(valued.model, tuple(taken)), left


def split_words(given: Iterable[str]) -> list[str]:
    """Assignments that stand in one word, "theta=0, phi=1", one by one."""
    return [word for text in given for word in re.split(r",(?=[^()]*=)", text)]


def refuse_no_place(model: Model, names: Iterable[str]) -> None:
    """Refuses a start from rest of a name that is no free coordinate.

    Raises:
        UsageError: it is named.
    """
    for name in names:
        if name not in model.coordinates:
            what = f"--from-rest: there is no coordinate '{name}'"
            raise UsageError(what, fix=nearest_name(name, model.coordinates))
        if model.coordinates[name].driven:
            free = listed(q for q, part in model.coordinates.items() if not part.driven)
            raise UsageError(f"--from-rest: '{name}' is driven, it moves as given", fix=f"there are {free}")


def _equation(model: Model, text: str, option: str) -> tuple[Any, tuple[Taken, ...]]:
    if text.strip() == AtRest.text and option == "--at":
        return AtRest(), ()
    try:
        return equation_typed(model, text, declared=True)
    except ExpressionError as error:
        raise UsageError(f"{option} {text}: {error.what}", fix=error.fix or f'write {option} "theta = pi/2"') from error


def assignments(given: Iterable[str], example: str) -> list[tuple[str, str]]:
    """(name, text) of each NAME=VALUE.

    Raises:
        UsageError: a word that is no assignment; `example` is its fix.
    """
    pairs = []
    for word in given:
        name, sign, text = word.partition("=")
        if not sign or not name.strip() or not text.strip():
            raise UsageError(f"'{word}' is no assignment", fix=f"write {example}")
        pairs.append((name.strip(), text.strip()))
    return pairs
