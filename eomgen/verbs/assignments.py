"""Values typed on the command line: NAME=VALUE and equations, in the units of the file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eomgen.errors import ExpressionError, UsageError
from eomgen.model import AtRest, Model, Requests, Taken, Valued, assignments
from eomgen.questions import positions_at_rest, variant_of

OPTIONS = {"set_": "--set", "start": "--start", "from_rest": "--from-rest", "at": "--at", "until": "--until"}
OPTIONS |= {"given": "--given"}
"""The options whose values have units, by the names of their arguments."""
EXAMPLES = {"--set": "--set m=2", "--start": "--start theta=1", "--from-rest": '--from-rest "theta=0"'}


def typed(model: Model, options: Mapping[str, Any]) -> tuple[Valued, dict[str, Any]]:
    """The model with the values that were typed, and their record; the other options, equations in SI.

    Raises:
        UsageError: a name that there is not; a value, a unit or an equation that is none.
    """
    left = {name: value for name, value in options.items() if name not in ("set_", "start", "variant")}
    number = options.get("variant")
    drawn = Valued(model) if number is None else variant_of(model, number)
    model = drawn.model
    given, start = (dict(assignments(options.get(name, ()), EXAMPLES[OPTIONS[name]])) for name in ("set_", "start"))
    valued = Valued.of(model, given, start, options=("--set", "--start"), declared=True)
    taken = [*drawn.taken, *valued.taken]
    if left.get("from_rest"):
        rest = positions_at_rest(model, left["from_rest"], EXAMPLES["--from-rest"])
        placed = Valued.of(valued.model, None, rest, options=("--set", "--from-rest"), declared=True)
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


def _equation(model: Model, text: str, option: str) -> tuple[Any, tuple[Taken, ...]]:
    if text.strip() == AtRest.text and option == "--at":
        return AtRest(), ()
    try:
        return Requests(model).equation_taken(text, declared=True)
    except ExpressionError as error:
        raise UsageError(f"{option} {text}: {error.what}", fix=error.fix or f'write {option} "theta = pi/2"') from error
