"""Units: exact factors, dimensions, and what is refused."""

from __future__ import annotations

import math

import pytest
from each import each

from eomgen.errors import ExpressionError
from eomgen.model.quantities import UNITS, Unit
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.text import parse


@each(
    "text, value, si",
    [
        ("cm", 40, Fraction(2, 5)),
        ("kg*cm^2", 5, Fraction(1, 2000)),
        ("km/h", 36, 10),
        ("kN*m", 3, 3000),
        ("N/mm^2", 1, 10**6),
        ("MPa", 1, 10**6),
        ("g", 250, Fraction(1, 4)),
        ("min", 2, 120),
        ("N/(m*s)", 7, 7),
        ("t", 2, 2000),
        ("1", 3, 3),
        ("s^-2", 3, 3),
        ("m·s⁻²", 3, 3),
    ],
)
def test_a_value_with_a_unit_is_its_value_in_si_exactly(text, value, si):
    """value * factor, no float in between."""
    assert Unit.parse(text).expression_in_si(parse(str(value))).literal == si
    assert Unit.parse(text).to_si(value, None) == si
    assert Unit.parse(text).from_si(si, None) == value


@each(
    "text, per_pi",
    [
        ("deg", Fraction(1, 180)),
        ("rev", 2),
        ("rpm", Fraction(1, 30)),
        ("°", Fraction(1, 180)),
        ("rev/min", Fraction(1, 30)),
        ("deg/s", Fraction(1, 180)),
    ],
)
def test_an_angle_is_a_multiple_of_pi_exactly(text, per_pi):
    """deg = pi/180, rev = 2 pi, rpm = pi/30 rad/s; on the graph pi stays pi."""
    graph = Graph()
    assert Unit.parse(text).to_si(1, graph.pi) is per_pi * graph.pi
    assert Unit.parse(text).to_si(1, math.pi) == pytest.approx(float(per_pi) * math.pi)
    assert Unit.parse(text).from_si(per_pi * graph.pi, graph.pi) == 1
    assert Unit.parse(text).expression_in_si(parse("3")).evaluate({"pi": graph.pi}) is 3 * per_pi * graph.pi


@each(
    "one, other",
    [
        ("N", "kg*m/s^2"),
        ("J", "N*m"),
        ("W", "J/s"),
        ("Pa", "N/m^2"),
        ("rad/s", "1/s"),
        ("Hz", "1/s"),
        ("kg m^2", "N*m*s^2"),
        ("rpm", "rad/s"),
        ("deg", "1"),
        ("N/(m*s)", "N/m/s"),
    ],
)
def test_units_of_one_dimension_fit(one, other):
    """m, kg, s to the same powers; the radian is a number."""
    assert Unit.parse(one).fits(Unit.parse(other)) and Unit.parse(other).fits(Unit.parse(one))


@each("one, other", [("m", "kg"), ("deg", "kg"), ("N", "N*m"), ("m/s", "m/s^2"), ("Hz", "rad/s"), ("1", "m")])
def test_units_of_different_dimensions_do_not_fit(one, other):
    """Nor do Hz and rad/s: between them lies 2 pi, silently."""
    assert not Unit.parse(one).fits(Unit.parse(other)) and not Unit.parse(other).fits(Unit.parse(one))


@each(
    "text, what, column, fix",
    [
        ("Nm", "there is no unit 'Nm'", 0, "did you mean 'N*m'?"),
        ("cmm", "there is no unit 'cmm'", 0, "did you mean 'mm'?"),
        ("m/Kg", "there is no unit 'Kg'", 2, "did you mean 'kg'?"),
        ("sec", "there is no unit 'sec'", 0, "did you mean 's'?"),
        ("furlong", "there is no unit 'furlong'", 0, ""),
        ("m^", "'^' has no place in the unit 'm^'", 1, "write kg*m^2"),
        ("m^99", "the exponent 99 is too large", 2, ""),
        ("m^999999999", "the exponent 999999999 is too large", 2, ""),
        ("m/", "a unit is missing at the end", 1, ""),
        ("N/(m*s", "'(' is never closed", 2, ""),
        ("", "a unit is missing", 0, "write kg*m^2"),
        ("m*" * 100, "the unit is too long", 0, "write kg*m^2"),
        ("2", "'2' has no place in the unit '2'", 0, "write kg*m^2"),
    ],
)
def test_an_unknown_unit_is_an_error_with_its_mend(text, what, column, fix):
    """STYLE 6: culprit, column, the nearest right thing."""
    with pytest.raises(ExpressionError) as caught:
        Unit.parse(text)
    assert (caught.value.what, caught.value.column, caught.value.fix) == (what, column, fix)


def test_every_named_unit_is_read_and_positive():
    """The table reads itself; no factor is a float or zero."""
    for name, unit in UNITS.items():
        assert Unit.parse(name).fits(unit) and Unit.parse(name).factor == unit.factor > 0
        assert isinstance(unit.factor, Fraction)


def test_an_expression_with_a_unit_becomes_one_in_si():
    """(a + b) cm = 1/100*(a + b) m."""
    assert Unit.parse("cm").expression_in_si(parse("a + b")).evaluate({"a": 30, "b": 10}) == Fraction(2, 5)
