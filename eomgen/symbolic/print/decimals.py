"""Exact numbers -> how they are written: 27/2 as a fraction, 0.0825 as the decimal that it is exactly."""

from __future__ import annotations

import math
from functools import lru_cache

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.exact_numbers import Number

MOST_DIGITS = 8  # of a decimal that may be longer than its fraction
LONGEST_FRACTION = 100  # the smallest denominator of a fraction that reads worse than its decimal
MUCH_LONGER = 2  # characters by which a decimal may be longer than its fraction
MOST_PRINTED = 4000  # digits of a whole number: Python prints 4300
BITS = math.log2(10)  # of a digit
KEPT = 1000  # numbers whose decimals are kept
SMALLEST = -4  # power of ten below which a decimal is written with its exponent: 8.464e-7


def number_text(c: Number) -> str:
    """c as text that is read back as c: 4, -27/2, 0.0825, 8.464e-7.

    Raises:
        DerivationError: it has more digits than can be printed.
    """
    if _is_long(c):
        raise DerivationError(
            f"a number of {number_length(c)} digits came up, which is too long to print",
            mend="scale the parameters: other units, or numbers nearer to 1",
        )
    decimal = decimal_of(c)
    if decimal is None:
        return str(c)
    digits, power = decimal
    return f"{digits}e{power}" if power else digits


def number_length(c: Number) -> int:
    """How long the text of c is; of a very long one nearly."""
    return int((c.numerator.bit_length() + c.denominator.bit_length()) / BITS) if _is_long(c) else len(number_text(c))


def _is_long(c: Number) -> bool:
    return max(c.numerator.bit_length(), c.denominator.bit_length()) > BITS * MOST_PRINTED


@lru_cache(maxsize=KEPT)
def decimal_of(c: Number) -> tuple[str, int] | None:
    """(digits, power of ten) with c = digits * 10^power exactly; None where a fraction or a whole number reads better.

    33/400 is 0.0825 and 1/25 is 0.04; 1/12, 27/2, 3/80 and 1/128 stay fractions. One of many digits, as a file of
    another program has it, is the decimal that it was where that is shorter.
    """
    if _is_long(c) or (c.denominator < LONGEST_FRACTION and c.denominator % 25):
        return None
    places = _places(c.denominator)
    digits = "" if places is None else str(abs(c.numerator) * 10**places // c.denominator)
    if places is None:
        return None
    text, power = _placed(digits, places)
    longer = MUCH_LONGER if len(digits) <= MOST_DIGITS else -1
    if len(text) + (len(f"e{power}") if power else 0) > len(str(abs(c))) + longer:
        return None
    return ("-" if c < 0 else "") + text, power


def _places(denominator: int) -> int | None:
    """How many places after the point 1/denominator has; None where they never end."""
    powers = []
    for prime in (2, 5):
        count = 0
        while denominator % prime == 0:
            denominator //= prime
            count += 1
        powers.append(count)
    return max(powers) if denominator == 1 else None


def _placed(digits: str, places: int) -> tuple[str, int]:
    """The digits with their point: at its place, or after the first digit and with a power of ten."""
    power = len(digits) - 1 - places
    if power < SMALLEST:
        return digits[0] + (f".{digits[1:]}" if digits[1:] else ""), power
    digits = digits.rjust(places + 1, "0")
    return f"{digits[:-places]}.{digits[-places:]}", 0
