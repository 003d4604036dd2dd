"""Text -> Unit, and what a person types with one: `45 deg`, `300 rpm`.

Text -> Unit: an exact factor to SI and the dimension (m, kg, s, A, K); the radian is one, and remembered.

deg = pi/180 rad,  rev = 2 pi rad,  kN = 1000 kg m/s^2
"""

from __future__ import annotations

import difflib
import math
import re
from typing import Any

from eomgen.errors import ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Expression, Fraction, as_expression, fraction_of, over, parse, parse_equation

LONGEST = 80  # characters
LARGEST_EXPONENT = 9


@dataclass(frozen=True)
class Unit:
    """factor * pi^pi_power, in units of SI.

    Args:
        text: as written (not compared: that is `fits`).
        factor: exact, positive.
        pi_power: of the pi in an angle: 1 for deg, -1 for 1/deg.
        length, mass, time: exponents of m, kg, s; current, temperature: of A, K.
        angle: exponent of rad, which is 1 but distinguishes rad/s from 1/s.
        cycles: exponent of the Hz in it: a frequency counts cycles, an angular velocity radians.
    """

    text: str
    factor: Fraction = Fraction(1)
    pi_power: int = 0
    length: int = 0
    mass: int = 0
    time: int = 0
    angle: int = 0
    cycles: int = 0
    current: int = 0
    temperature: int = 0

    @classmethod
    def parse(cls, text: str) -> Unit:
        """The unit that a text writes: `kg*m^2`, `m/s^2`, `kg m^2`, `N/(m*s)`; `1` is the plain number.

        Raises:
            ExpressionError: there is no such unit; column and length say where, fix offers the nearest.
        """
        if not text.strip() or len(text) > LONGEST:
            raise ExpressionError(
                "a unit is missing" if not text.strip() else "the unit is too long", fix="write kg*m^2"
            )
        total, opened, group, direction, needed = Unit(text), -1, 1, 1, True
        position = 0
        while position < len(text):
            character = text[position]
            if character.isspace():
                pass
            elif needed and character == "(" and opened < 0:
                opened, group, direction = position, direction, 1
            elif not needed and character == ")" and opened >= 0:
                opened, group = -1, 1
            elif not needed and character in "*·/":
                needed, direction = True, -1 if character == "/" else 1
            elif piece := _PIECE.match(text, position):
                total = total.times(_unit_of(piece).raised(group * direction * _power_of(piece)))
                needed, direction, position = False, 1, piece.end() - 1
            else:
                raised = position and text[position - 1].isalpha() and character.isdigit()
                fix = f"write {text[:position]}^{text[position:]}" if raised else "write kg*m^2"
                raise ExpressionError(f"{character!r} has no place in the unit '{text}'", position, fix)
            position += 1
        if needed or opened >= 0:
            what = "'(' is never closed" if opened >= 0 else "a unit is missing at the end"
            raise ExpressionError(what, max(opened, 0) if opened >= 0 else len(text) - 1)
        return total

    def __str__(self) -> str:
        return self.text

    @property
    def dimension(self) -> tuple[int, int, int, int, int]:
        """The exponents of m, kg, s, A, K."""
        return self.length, self.mass, self.time, self.current, self.temperature

    def fits(self, other: Unit) -> bool:
        """True where a value in this unit can be given in the other.

        Angles are numbers (rad/s fits 1/s), but Hz does not fit rad/s: between them lies 2 pi.
        """
        hertz_for_radians = self.cycles != other.cycles and (self.angle or other.angle)
        return self.dimension == other.dimension and not hertz_for_radians

    def to_si(self, value: Any, pi: Any) -> Any:
        """A value in this unit, in SI; in the arithmetic of value and pi."""
        return value * self._size(pi)

    def from_si(self, value: Any, pi: Any) -> Any:
        """A value in SI, in this unit; in the arithmetic of value and pi."""
        return over(value, self._size(pi))

    @property
    def size(self) -> float:
        """Value of one such unit in SI."""
        return float(self._size(math.pi))

    def _size(self, pi: Any) -> Any:
        factor = self.factor.numerator if self.factor.denominator == 1 else self.factor
        return factor * pi**self.pi_power if self.pi_power else factor

    @property
    def si(self) -> str:
        """The SI unit of the same kind, as text: m for cm, rad/s for deg/s."""
        if self.factor == 1 and not self.pi_power:
            return self.text
        if self.dimension in _SI_NAMES:
            return _SI_NAMES[self.dimension]
        powers = (
            ("rad", min(self.angle, 1)),
            ("kg", self.mass),
            ("m", self.length),
            ("s", self.time),
            ("A", self.current),
            ("K", self.temperature),
        )
        above = [name if n == 1 else f"{name}^{n}" for name, n in powers if n > 0]
        below = [name if n == -1 else f"{name}^{-n}" for name, n in powers if n < 0]
        under = f"/({'*'.join(below)})" if len(below) > 1 else f"/{below[0]}" if below else ""
        return ("*".join(above) or "1") + under

    @property
    def rate(self) -> Unit:
        """This unit per second."""
        text = f"{self.text}/s" if "/" not in self.text else f"({self.text})/s"
        return Unit(text, self.factor, *(e - (k == 3) for k, e in enumerate(self._exponents())))

    def expression_in_si(self, expression: Expression) -> Expression:
        """An expression written in this unit, in SI: 40 cm is 2/5, 90 deg is 1/2*pi."""
        return expression.scaled(self.factor, self.pi_power)

    def raised(self, n: int) -> Unit:
        """The n-th power."""
        return self._made(self.factor**n, *(n * e for e in self._exponents()))

    def times(self, other: Unit) -> Unit:
        """The product."""
        return self._made(
            self.factor * other.factor, *(a + b for a, b in zip(self._exponents(), other._exponents(), strict=True))
        )

    def _exponents(self) -> tuple[int, ...]:
        return (*(self.pi_power, self.length, self.mass, self.time, self.angle), self.cycles, *self.dimension[3:])

    def _made(self, factor: Fraction, *exponents: int) -> Unit:
        return Unit(self.text, factor, *exponents)


_SI_NAMES = {(1, 1, -2, 0, 0): "N", (2, 1, -3, 0, 0): "W", (-1, 1, -2, 0, 0): "Pa"}
_SI_NAMES |= {(2, 1, -3, -1, 0): "V", (2, 1, -3, -2, 0): "ohm", (2, 1, -2, -2, 0): "H", (-2, -1, 4, 2, 0): "F"}
_SI_NAMES |= {(2, 1, -2, -1, 0): "Wb", (0, 1, -2, -1, 0): "T", (0, 0, 1, 1, 0): "C"}


def _table() -> dict[str, Unit]:
    def unit(
        name: str, factor: str | int = 1, m: int = 0, kg: int = 0, s: int = 0, A: int = 0, K: int = 0
    ) -> tuple[str, Unit]:
        return name, Unit(name, fraction_of(str(factor)), 0, m, kg, s, current=A, temperature=K)

    entries = [
        unit("1"),
        *(unit(n, f, m=1) for n, f in (("m", 1), ("km", 1000), ("dm", "0.1"), ("cm", "0.01"), ("mm", "0.001"))),
        *(unit(n, f, m=1) for n, f in (("um", "1e-6"), ("in", "0.0254"), ("ft", "0.3048"))),
        *(unit(n, f, kg=1) for n, f in (("kg", 1), ("g", "0.001"), ("mg", "1e-6"), ("t", 1000), ("lb", "0.45359237"))),
        *(unit(n, f, s=1) for n, f in (("s", 1), ("ms", "0.001"), ("us", "1e-6"), ("min", 60), ("h", 3600))),
        *(unit(n, f, 1, 1, -2) for n, f in (("N", 1), ("mN", "0.001"), ("kN", 1000), ("MN", 10**6))),
        *(unit(n, f, 2, 1, -2) for n, f in (("J", 1), ("mJ", "0.001"), ("kJ", 1000), ("MJ", 10**6))),
        *(unit(n, f, 2, 1, -3) for n, f in (("W", 1), ("mW", "0.001"), ("kW", 1000), ("MW", 10**6))),
        *(unit(n, f, -1, 1, -2) for n, f in (("Pa", 1), ("kPa", 1000), ("MPa", 10**6), ("GPa", 10**9), ("bar", 10**5))),
        *(unit(n, f, -1, 1, -2) for n, f in (("mbar", 100), ("hPa", 100))),
        *(unit(n, f, m=3) for n, f in (("l", "0.001"), ("L", "0.001"), ("ml", "1e-6"), ("mL", "1e-6"))),
        *(unit(n, f, A=1) for n, f in (("A", 1), ("mA", "0.001"), ("uA", "1e-6"), ("kA", 1000))),
        *(unit(n, f, s=1, A=1) for n, f in (("C", 1), ("mC", "0.001"), ("uC", "1e-6"))),
        *(unit(n, f, 2, 1, -3, -1) for n, f in (("V", 1), ("mV", "0.001"), ("uV", "1e-6"), ("kV", 1000))),
        *(unit(n, f, 2, 1, -3, -2) for n, f in (("ohm", 1), ("mohm", "0.001"), ("kohm", 1000), ("Mohm", 10**6))),
        *(unit(n, f, -2, -1, 3, 2) for n, f in (("S", 1), ("mS", "0.001"))),
        *(unit(n, f, 2, 1, -2, -2) for n, f in (("H", 1), ("mH", "0.001"), ("uH", "1e-6"))),
        *(
            unit(n, f, -2, -1, 4, 2)
            for n, f in (("F", 1), ("mF", "0.001"), ("uF", "1e-6"), ("nF", "1e-9"), ("pF", "1e-12"))
        ),
        *(unit(n, f, 2, 1, -2, -1) for n, f in (("Wb", 1), ("mWb", "0.001"))),
        *(unit(n, f, 0, 1, -2, -1) for n, f in (("T", 1), ("mT", "0.001"))),
        *(unit(n, f, K=1) for n, f in (("K", 1), ("mK", "0.001"))),
    ]
    table = dict(entries)
    for name, factor in (("Hz", 1), ("kHz", 1000)):
        table[name] = Unit(name, Fraction(factor), time=-1, cycles=1)
    angles: tuple[tuple[str, str | int, int, int], ...] = (
        ("rad", 1, 0, 0),
        ("mrad", "0.001", 0, 0),
        ("deg", "1/180", 1, 0),
        ("rev", 2, 1, 0),
        ("rpm", "1/30", 1, -1),
    )
    for name, size, pi_power, time in angles:
        table[name] = Unit(name, fraction_of(str(size)), pi_power, time=time, angle=1)
    return table


UNITS = _table()
"""Every unit by its name."""

_ALIASES = [("°", "deg"), ("\u2126", "ohm")]
_ALIASES += [(f"{prefix}Ω", f"{prefix}ohm") for prefix in ("", "k", "m", "M")]
_ALIASES += [(micro + unit, f"u{unit}") for unit in "m s A C V H F".split() for micro in "µμ"]
for _alias, _name in _ALIASES:
    UNITS[_alias] = UNITS[_name]

_SPOKEN = {"sec": "s", "second": "s", "meter": "m", "metre": "m", "degree": "deg", "degrees": "deg", "radian": "rad"}
_SPOKEN |= {
    "volt": "V",
    "volts": "V",
    "ampere": "A",
    "amps": "A",
    "amp": "A",
    "henry": "H",
    "farad": "F",
    "weber": "Wb",
}
_SPOKEN |= {"tesla": "T", "kelvin": "K", "liter": "l", "litre": "l", "liters": "l", "litres": "l", "lpm": "l/min"}
_SPOKEN |= {"radians": "rad", "newton": "N", "kilogram": "kg", "hr": "h", "hour": "h", "rps": "rev/s"}
_PIECE = re.compile(
    r"(?P<unit>[^\W\d_²³¹⁰⁴-⁹]+|°|1(?![0-9.]))"
    r"(?:\s*(?:\^|\*\*)\s*(?P<power>[-+]?[0-9]+|\([-+]?[0-9]+\))|(?P<raised>⁻?[¹²³⁴]))?"
)
_RAISED = str.maketrans("⁻¹²³⁴", "-1234")


def _unit_of(piece: re.Match[str]) -> Unit:
    name = piece.group("unit")
    if name not in UNITS:
        raise ExpressionError(f"there is no unit '{name}'", piece.start("unit"), _nearest(name), len(name))
    return UNITS[name]


def _power_of(piece: re.Match[str]) -> int:
    written = piece.group("power") or (piece.group("raised") or "1").translate(_RAISED)
    power = int(written.strip("()")) if len(written) <= 4 else LARGEST_EXPONENT + 1
    if abs(power) > LARGEST_EXPONENT:
        what = f"the exponent {written} is too large"
        raise ExpressionError(what, piece.start("power"), length=len(written))
    return power


def _nearest(name: str) -> str:
    same = [known for known in UNITS if known.lower() == name.lower()]
    halves = [(name[:i], name[i:]) for i in range(1, len(name)) if name[:i] in UNITS and name[i:] in UNITS]
    product = [f"{a}*{b}" for a, b in halves if UNITS[a]._exponents() != UNITS[b]._exponents()]  # cmm is not cm*m
    spoken = [_SPOKEN[name.lower()]] if name.lower() in _SPOKEN else []
    many = [name[:-1]] if len(name) > 2 and name.endswith("s") and name[:-1] in UNITS else []  # kgs
    near = spoken or same or many or product or difflib.get_close_matches(name, UNITS, n=1, cutoff=0.5)
    return f"did you mean '{near[0]}'?" if near else ""


# -------- typed -----------------------------------------------------------------------------------------------
# What a person types -> an expression and its unit: `45 deg`, `300 rpm`, `pi/4 rad`, `2*l`; a time.


_BEFORE_UNIT = re.compile(r"(?<=[\d.)])\s*(?=[^\W\d]|°)|\s+(?=[^\W\d]|°|1/)")


Typed = Any
"""A number, a text, (number, unit), a quantity of pint."""
EXACT_INTEGER = 53  # bits of a whole number that a double holds
_OF_PINT = {"[length]": "m", "[mass]": "kg", "[time]": "s", "[current]": "A", "[temperature]": "K"}


def seconds(typed: Any) -> float:
    """A time [s]: a number, "500 ms", (500, "ms"), a quantity of pint; a plain number is in seconds.

    Raises:
        UsageError: it is none.
    """
    if (type(typed) is float and math.isfinite(typed)) or (type(typed) is int and typed.bit_length() < EXACT_INTEGER):
        return float(typed)
    refused = UsageError(f"{typed!r} is no time", fix="write 5, or '5 s'")
    try:
        value, unit = read_typed(typed)
        if not value.is_plain or not (unit is None or unit.fits(Unit.parse("s"))):
            raise refused
        found = float((value if unit is None else unit.expression_in_si(value)).evaluate({"pi": math.pi}))
    except (ExpressionError, TypeError, ValueError, ArithmeticError):
        raise refused from None
    if not math.isfinite(found):
        raise refused
    return found


def read_typed(typed: Any) -> tuple[Expression, Unit | None]:
    """(the expression, its own unit or None) of a number, a text, (number, unit), a quantity of pint.

    Raises:
        ExpressionError: it is none of them.
    """
    if isinstance(typed, str):
        return parse_typed(typed)
    if isinstance(typed, tuple) and len(typed) == 2 and isinstance(typed[1], str):
        return as_expression(_plain(typed[0])), Unit.parse(typed[1])
    if hasattr(typed, "to_base_units") and hasattr(typed, "dimensionality"):
        base = typed.to_base_units()
        if not base.dimensionality.keys() <= _OF_PINT.keys():
            raise ExpressionError(f"'{typed}' is in units that mechanics does not have", fix="use m, kg, s, A, K, rad")
        powers = (f"{_OF_PINT[kind]}^{int(power)}" for kind, power in base.dimensionality.items())
        return as_expression(_plain(base.magnitude)), Unit.parse("*".join(powers) or "1")
    return as_expression(_plain(typed)), None


def _plain(value: Any) -> Any:
    """A number of an array as Python's own."""
    return value.item() if hasattr(value, "item") else value


def parse_typed(text: str, *, references: bool = False, start: int = 0) -> tuple[Expression, Unit | None]:
    """(the expression, the unit behind it, or None).

    Args:
        references: functions of the outputs are allowed, as calls.
        start: the column at which the text begins; columns count from there.
    Raises:
        ExpressionError: it is neither; the unit is none; names stand in front of a unit.
    """
    try:
        return _padded(text, references, start), None
    except ExpressionError as error:
        failure = error
    for gap in _BEFORE_UNIT.finditer(text):
        try:
            expression = _padded(text[: gap.start()], references, start)
        except ExpressionError:
            continue
        try:
            unit = Unit.parse(text[gap.end() :])
        except ExpressionError as error:
            if expression.names <= {"pi"} and text[gap.end() :].strip().isalpha():
                raise ExpressionError(error.what, start + gap.end(), error.fix, error.length) from None
            continue
        if not expression.names <= {"pi"} or expression.calls:
            what = f"names are in SI, but '{expression.text}' has the unit '{unit.text}'"
            raise ExpressionError(what, start + gap.end(), f"write {expression.text}", len(unit.text))
        return expression, unit
    raise failure


def parse_typed_equation(text: str) -> tuple[tuple[Expression, Unit | None], tuple[Expression, Unit | None]]:
    """Both sides of `left = right`, each with its unit.

    Raises:
        ExpressionError: it is no equation; column and length say where.
    """
    if not isinstance(text, str):
        raise ExpressionError(f"{text!r} is no equation", fix='write it as a text: "theta = pi/2"')
    left, sign, right = text.partition("=")
    if not sign or not right.strip():
        parse_equation(text)
    return parse_typed(left, references=True), parse_typed(right, references=True, start=len(left) + 1)


def unit_for_name(name: str, expression: Expression) -> str:
    """The fix of `5*m` or `45*deg` where the name was meant as a unit, "write 5 m"; "" where the name is no unit."""
    factor = expression.text.replace(" ", "").removesuffix(f"*{name}")
    return f"write {factor} {name}" if name in UNITS and factor != expression.text.replace(" ", "") else ""


def _padded(text: str, references: bool, start: int) -> Expression:
    return parse(" " * start + text, references=references)
