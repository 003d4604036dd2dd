"""A sum as a list of parts, each a number times powers: what they have in common, and how they are grouped.

part = c * product of base^exponent,   base: an atom of an expansion, or the sine or cosine of an angle
"""

from __future__ import annotations

from collections.abc import Callable

from eomgen.symbolic.exact.terms import AngleSum, common_number
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.print.decimals import decimal_of

Base = int | tuple[str, AngleSum]  # an atom, or the sine or cosine of an angle
Powers = tuple[tuple[Base, int], ...]  # in the order in which they were met; exponents may be negative
SumPart = tuple[Number, Powers]
SumParts = list[SumPart]


def doubled(c: Number, powers: Powers) -> SumPart | None:
    """c*sin(a)^n*cos(a)^n as c/2^n*sin(2*a)^n; None where no angle has both."""
    exponents = dict(powers)
    for (kind, angle), e in ((base, e) for base, e in powers if not isinstance(base, int)):
        if kind == "sin" and e > 0 and exponents.get(("cos", angle)) == e:
            twice: Base = ("sin", tuple((a, 2 * k) for a, k in angle))
            rest = times_powers(powers, ((("sin", angle), -e), (("cos", angle), -e), (twice, e)))
            return tidy(Fraction(c) / 2**e), rest
    return None


def is_negative(parts: SumParts) -> bool:
    """Whether every part has a minus."""
    return all(c < 0 for c, _ in parts)


def negated(parts: SumParts) -> SumParts:
    """Minus the sum."""
    return [(-c, powers) for c, powers in parts]


def grouped_by(parts: SumParts, chosen: Callable[[Base], bool]) -> dict[Powers, SumParts]:
    """The terms by the product of their chosen bases, without it; in the order in which it is first met."""
    groups: dict[Powers, SumParts] = {}
    for c, powers in parts:
        key = tuple([item for item in powers if chosen(item[0])])
        rest = tuple([item for item in powers if item not in key]) if key else powers
        groups.setdefault(tuple(sorted(key, key=repr)) if len(key) > 1 else key, []).append((c, rest))
    return groups


def times_powers(a: Powers, b: Powers) -> Powers:
    """a b, without what cancels."""
    if not b:
        return a
    exponents = dict(a)
    for base, e in b:
        exponents[base] = exponents.get(base, 0) + e
    return tuple((base, e) for base, e in exponents.items() if e)


def without_common(parts: SumParts) -> tuple[Number, Powers, SumParts]:
    """(number, powers, rest): what all terms hold, and what is left of them; a negative number if all are."""
    number: Number = common_number(c for c, _ in parts)
    if decimal_of(number) is not None and any(abs(Fraction(c)) != number for c, _ in parts):
        number = 1  # of 0.00018125 and 0.000161 nobody takes out 2.5e-7
    number = -number if is_negative(parts) else number
    lowest: dict[Base, int] = {}
    terms: dict[Base, int] = {}  # that hold the base
    for _, powers in parts:
        for base, e in powers:
            lowest[base] = min(lowest.get(base, e), e)
            terms[base] = terms.get(base, 0) + 1
    lowest = {base: e if terms[base] == len(parts) else min(e, 0) for base, e in lowest.items()}
    # the root of a number has no inverse that is one
    common = tuple((base, e) for base, e in lowest.items() if e and not (isinstance(base, int) and base < 0))
    inverted = tuple((base, -e) for base, e in common)
    rest = [
        (c if number == 1 else tidy(Fraction(c) / Fraction(number)), times_powers(powers, inverted))
        for c, powers in parts
    ]
    return tidy(number), common, rest


def in_tangents_of(parts: SumParts, angle: AngleSum) -> SumParts:
    """sin(x)^i*cos(x)^j as tan(x)^i, in each of the terms."""
    as_tangent: dict[Base, Base] = {("sin", angle): ("tan", angle)}
    return [
        (c, tuple((as_tangent.get(base, base), e) for base, e in powers if base != ("cos", angle)))
        for c, powers in parts
    ]
