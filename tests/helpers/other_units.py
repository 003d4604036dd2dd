"""By how much a number grows where mass, length and time have other units; no unit of eomgen is used here."""

from __future__ import annotations

from fractions import Fraction

GROWN = {"kg": Fraction(13, 10), "m": Fraction(7, 5), "s": Fraction(17, 10)}
GROWN |= {"1": Fraction(1), "rad": Fraction(1), "cm": GROWN["m"], "N": GROWN["kg"] * GROWN["m"] / GROWN["s"] ** 2}
GROWN |= {"J": GROWN["N"] * GROWN["m"]}


def grown(unit: str) -> Fraction:
    """Of a quantity in a unit such as kg*m^2/s, "" a number: kg m^2 s^-1 of the factors."""
    over, *under = unit.split("/")
    found = Fraction(1)
    for power, pieces in [(1, over), *((-1, each) for each in under)]:
        for piece in pieces.split("*"):
            name, _, exponent = piece.partition("^")
            found *= GROWN[name or "1"] ** (power * int(exponent or 1))
    return found
