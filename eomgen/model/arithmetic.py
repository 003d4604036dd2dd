"""Expressions of parameters -> numbers: the order in which parameters follow from one another, and their values."""

from collections.abc import Iterator, Mapping

from eomgen.symbolic.expression import Expression, Fraction

AnyNumber = int | Fraction | float


def in_order(parameters: Mapping[str, Expression | None]) -> tuple[list[str], list[list[str]]]:
    """The parameters, each after those in its expression; and the rings of those that need one another."""
    ordered: dict[str, None] = {}
    rings: list[list[str]] = []
    for first in parameters:
        trail = {} if first in ordered else {first: _needed(parameters, first)}
        while trail:
            name, needed = next(reversed(trail.items()))
            other = next((n for n in needed if n not in ordered), None)
            if other is None:
                ordered[name] = None
                del trail[name]
            elif other in trail:
                names = list(trail)
                rings.append(names[names.index(other) :])
                ordered |= dict.fromkeys(names)
                break
            else:
                trail[other] = _needed(parameters, other)
    return list(ordered), rings


def _needed(parameters: Mapping[str, Expression | None], name: str) -> Iterator[str]:
    value = parameters[name]
    return iter(sorted(value.names & parameters.keys())) if value is not None else iter(())
