"""Exact numbers are written so that they read well, and read back as themselves."""

from __future__ import annotations

from fractions import Fraction

from each import each
from hypothesis import given
from hypothesis import strategies as st

from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.print.layout import decimal_of, number_text


@each(
    "number, text",
    [
        (4, "4"),
        (Fraction(27, 2), "27/2"),
        (Fraction(-1, 12), "-1/12"),
        (Fraction(3, 8), "3/8"),
        (Fraction(3, 80), "3/80"),  # of a cone
        (Fraction(1, 128), "1/128"),
        (Fraction(83, 320), "83/320"),  # of a hemisphere
        (Fraction(127, 128), "127/128"),
        (Fraction(3, 160), "3/160"),
        (Fraction(1234567, 160), "7716.04375"),  # its fraction is longer
        (Fraction(1, 25), "0.04"),
        (Fraction(33, 400), "0.0825"),
        (Fraction(-33, 400), "-0.0825"),
        (Fraction(529, 4000000), "0.00013225"),
        (Fraction(529, 625000000), "8.464e-7"),
        (Fraction(1, 100000), "1e-5"),
        (Fraction(5001, 50), "100.02"),
        (Fraction(49, 120000), "49/120000"),  # no end
        (Fraction(123456789, 10**12), "0.000123456789"),
        (Fraction(49886778961576569, 10**18), "0.049886778961576569"),  # of a file of another program
        (Fraction(1, 2**30), "1/1073741824"),  # its decimal is longer
    ],
)
def test_a_number_is_a_decimal_where_that_is_short_and_its_fraction_is_not(number, text):
    """33/400 = 0.0825"""
    assert number_text(number) == text


digits, places = st.integers(-(10**8), 10**8), st.integers(0, 12)
decimals = st.builds(lambda numerator, place: Fraction(numerator, 10**place), digits, places)


@given(st.fractions() | decimals)
def test_every_number_reads_back_as_itself(number):
    """parse(number_text(c)) = c"""
    assert parse(number_text(number)).evaluate({}) == number


@given(st.integers(1, 10**8 - 1), st.integers(1, 12))
def test_digits_times_the_power_of_ten_are_the_number(numerator, places):
    """c = digits * 10^power"""
    number = Fraction(numerator, 10**places)
    found = decimal_of(number)
    if found is not None:
        assert Fraction(found[0]) * Fraction(10) ** found[1] == number
