"""Equations of small motions as a person writes them, from what `linearize` gives; and the same with a mistake."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

FACTOR = "5/4"  # of a stiffness that is wrong


def linear_lines(found: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
    """(equation, the same with another stiffness, place) of each row of M q'' + C q' + K q = 0 that accelerates.

    Args:
        found: the JSON of a linearization in exact formulas about an equilibrium, whose speeds are rates.
    """
    names = found["coordinates"]
    plain = found["about"] == "equilibrium" and found["exact"] and not found["states"] and found["second_order"]
    if not plain or found["speeds"] != [f"{name}'" for name in names] or found["inputs"] or found["left_out"]:
        return
    place = {name: found["state"][name]["exact"] for name in names}
    if not all(place.values()):
        return
    M, C, K = (found[name]["exact"] for name in ("mass", "rates", "stiffness"))
    about = ", ".join(f"{name}={at}" for name, at in place.items())
    for mass, rate, stiffness in zip(M, C, K, strict=True):
        terms = [f"({m})*{name}''" for name, m in zip(names, mass, strict=True) if m != "0"]
        terms += [f"({c})*{name}'" for name, c in zip(names, rate, strict=True) if c != "0"]
        held = [f"({k})*({name} - ({place[name]}))" for name, k in zip(names, stiffness, strict=True) if k != "0"]
        if any("''" in term for term in terms) and held:
            wrong = [f"{FACTOR}*{held[0]}", *held[1:]]
            yield " + ".join([*terms, *held]) + " = 0", " + ".join([*terms, *wrong]) + " = 0", about
