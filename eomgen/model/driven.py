"""Model -> the coordinates that move as functions of time: driven by themselves, or by a tie that says so."""

from __future__ import annotations

from eomgen.model.parts import Model


def driving_ties(model: Model) -> dict[str, tuple[str, ...]]:
    """{coordinate: the ties that give it as a function of time}, of those that have one."""
    found: dict[str, tuple[str, ...]] = {}
    for name, tie in model.constraints.items():
        if coordinate := tie.drives():
            found[coordinate] = (*found.get(coordinate, ()), name)
    return found


def driven_coordinates(model: Model) -> frozenset[str]:
    """The names of all of them."""
    own = (name for name, part in model.coordinates.items() if part.driven)
    return frozenset((*own, *driving_ties(model)))
