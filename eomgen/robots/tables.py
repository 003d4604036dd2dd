"""Shared parts of the readers of robot files: names, numbers, tables, text."""

from __future__ import annotations

import json
import re
import sys
import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from decimal import Context, Decimal, localcontext
from typing import Any

from eomgen.errors import HIDDEN, visible
from eomgen.frozen import dataclass
from eomgen.model import Model, UnitQuaternion, tables_read
from eomgen.resources import check_patience
from eomgen.symbolic.expression import Fraction, Matrix, Vector
from eomgen.symbolic.numeric import fifty_digits, tolerances

# -------- numbers ---------------------------------------------------------------------------------------------
# Decimals of robot files: places, turns and inertias by 40 digits, written with 17; angles that are parts of pi.


DIGITS = 40
WRITTEN = 17  # digits of a computed number: those of a double
SURE = 13  # digits by which a decimal is taken for a part of pi
PARTS = 24  # of pi, that people write

ZERO = Decimal(0)
ORIGIN = Vector((ZERO, ZERO, ZERO))
EXACTLY = Context(prec=DIGITS)
"""in which robots are read"""
FUNCTIONS = fifty_digits().functions
PI = FUNCTIONS["pi"]()


def in_digits(x: Decimal) -> Any:
    """A decimal with 50 digits."""
    return fifty_digits().number(Fraction(x))


def decimals(values: Iterable[Any]) -> Vector:
    """Three decimals."""
    return Vector(Decimal(value) for value in values)


def decimal_of_double(x: float) -> Decimal:
    """Decimal of a double: short, where one of less than 12 digits is nearly the same double, else exact."""
    short, close = Decimal(f"{x:.15g}"), 2 * sys.float_info.epsilon * abs(x)
    return short if len(short.as_tuple().digits) < 12 and abs(float(short) - x) <= close else Decimal(repr(float(x)))


def computed(x: Decimal) -> Decimal:
    """Computed number, rounded to the digits that are written; a rounding error is 0."""
    if abs(x) < tolerances.ROUNDED_AWAY:
        return ZERO
    return Context(prec=WRITTEN).plus(x).normalize()


def part_of_pi(angle: Decimal) -> Fraction | None:
    """Rational part of pi that an angle is, if all its digits agree and are enough; None."""
    if angle == 0:
        return Fraction(0)
    part = Fraction(round(in_digits(angle) / PI * PARTS), PARTS)
    exact = (PI * part).decimal(DIGITS)
    digits = len(angle.as_tuple().digits)
    unit = Decimal(1).scaleb(int(angle.as_tuple().exponent))
    return part if part and digits >= SURE and abs(angle - exact) <= 2 * unit else None


def angle_text(angle: Decimal) -> Decimal | str:
    """An angle as a person writes it: pi/2, -2*pi/3, or its decimals."""
    part = part_of_pi(angle)
    if not part:
        return angle
    top = {1: "pi", -1: "-pi"}.get(part.numerator, f"{part.numerator}*pi")
    return top if part.denominator == 1 else f"{top}/{part.denominator}"


def sine_cosine(angle: Decimal) -> tuple[Any, Any]:
    """(sin, cos) of an angle, by DIGITS; of a part of pi exactly that part's."""
    part = part_of_pi(angle)
    x = in_digits(angle) if part is None else PI * part
    pair = [FUNCTIONS[op](x).decimal(DIGITS) for op in ("sin", "cos")]
    sine, cosine = (ZERO if abs(y) < tolerances.ROUNDED_AWAY else y for y in pair)
    return sine, cosine


def turning(axis: Sequence[Decimal], angle: Decimal) -> Matrix:
    """The rotation by an angle about an axis of any length."""
    sine, cosine = sine_cosine(angle)
    with localcontext(EXACTLY):
        length = sum((x * x for x in axis), ZERO).sqrt()
        n: Any = tuple(x / length for x in axis)
        return Matrix.rotation(n, cosine, sine)


def roll_pitch_yaw(angles: Vector) -> tuple[Matrix, list[dict[str, Any]]]:
    """R = Rz(yaw) Ry(pitch) Rx(roll), and the turns of a model file that make it, those by 0 left out."""
    R, turns = Matrix.IDENTITY, []
    for axis, angle in zip(((0, 0, 1), (0, 1, 0), (1, 0, 0)), reversed(angles), strict=True):
        if angle != 0:
            R = R @ turning(decimals(axis), angle)
            turns.append({"axis": list(axis), "angle": angle_text(angle)})
    return R, turns


def in_radians(degrees: Decimal) -> Decimal:
    """An angle, by DIGITS."""
    radians: Decimal = (in_digits(degrees) * PI / 180).decimal(DIGITS)
    return radians


def turned_by(quaternion: Sequence[Decimal]) -> Matrix:
    """The rotation of a quaternion of any length, scalar first."""
    length = sum((x * x for x in quaternion), ZERO).sqrt()
    R: Matrix = UnitQuaternion(*(x / length for x in quaternion)).rotation
    return R


def quaternion_of(R: Matrix) -> tuple[Decimal, Decimal, Decimal, Decimal]:
    """The quaternion of a rotation, scalar first, from its largest component."""
    with localcontext(EXACTLY):
        d = [R[i][i] for i in range(3)]
        squares = [1 + d[0] + d[1] + d[2], *(1 + 2 * d[i] - d[0] - d[1] - d[2] for i in range(3))]
        k = max(range(4), key=lambda i: squares[i])
        s = Decimal(squares[k]).sqrt()
        skew = [R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]]
        if k == 0:
            e = [s, *(x / s for x in skew)]
        else:
            i, j = k % 3, (k + 1) % 3
            e = [ZERO] * 4
            e[0], e[k] = skew[k - 1] / s, s
            e[1 + i], e[1 + j] = (R[k - 1][i] + R[i][k - 1]) / s, (R[k - 1][j] + R[j][k - 1]) / s
        return e[0] / 2, e[1] / 2, e[2] / 2, e[3] / 2


def turn_of(quaternion: Sequence[Decimal]) -> list[dict[str, Any]]:
    """The turn of a model file that a quaternion is, scalar first: [] for none, else one about an axis."""
    with localcontext(EXACTLY):
        w, *v = quaternion
        length = sum((x * x for x in v), ZERO).sqrt()
        if length < tolerances.SAME_TURN:
            return []
        largest = max(v, key=abs)
        axis = [_plain(x / abs(largest)) for x in v]
        sign = -1 if largest < 0 and sum(map(bool, axis)) == 1 else 1
        angle = 2 * FUNCTIONS["atan2"](in_digits(length), in_digits(w))
        if angle > PI:
            angle -= 2 * PI
        decimal = (sign * angle).decimal(14)
        full = (sign * angle).decimal(WRITTEN).normalize()
    text = angle_text(decimal)
    return [{"axis": [sign * x for x in axis], "angle": text if isinstance(text, str) else full}]


def _plain(x: Decimal) -> Decimal:
    """Decimal with 6 digits where that is right to 14 digits; else as `computed`."""
    short = Context(prec=6).plus(x)
    return short.normalize() if abs(short - x) < tolerances.SAME_TURN else computed(x)


def inertia_in(R: Matrix, tensor: Matrix) -> Matrix:
    """R I R^T."""
    return R @ tensor @ R.T


def six(I: Matrix) -> list[Decimal]:
    """xx, yy, zz, xy, yz, zx of a tensor; of a diagonal one three."""
    found = [computed(x) for x in (I[0][0], I[1][1], I[2][2], I[0][1], I[1][2], I[0][2])]
    return found if any(found[3:]) else found[:3]


# -------- drawn up --------------------------------------------------------------------------------------------
# Shared by the readers of robot files: legal names, joints in a row, parts left out; tables of a model file.


RESERVED = ("t", "pi", "nan", "inf", "infinity", "ground")
ILLEGAL = re.compile(r"[^A-Za-z0-9_]+")
UNLIMITED = "1e9"  # written by an export where a format needs a limit and there is none
_FIGURE = r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)"
REMARKS = {  # written by an import into the remark of a coordinate or a body, and read there by an export
    "name": r"^(?:joint|link) (.+?)(?=, from |, at most |$)",
    "lower": rf"\bfrom {_FIGURE} to \S+ (?:rad|m)\b",
    "upper": rf"\bfrom \S+ to {_FIGURE} (?:rad|m)\b",
    "effort": rf"\bat most {_FIGURE} N(?:\*m)?(?=,|$)",
    "velocity": rf"\bat most {_FIGURE} (?:rad|m)/s",
}
Entries = dict[str, Any]
NO_COUNTERPART = "eomgen has no counterpart"
SLIDING = 'torque or force of the joint, with "- f*tanh(rate/small)": it slides, and creeps where it would stick'
IN_SPACE = "a [forces] `couple` in axes of the body, by its quaternion and `omega`"
STARTS_BEYOND = "start beyond limits"
FOLLOWS = "limits of joints that follow others"
NO_RANGE = "limits that leave no range"
LAW = "a formula with max and min in the motor's force"
NEAREST = {  # nearest counterpart in a model of a thing that changes the motion and cannot be imported
    "collision": "`rolling` or `support` in [constraints]; a push by max(0, depth) in [forces]",
    "geoms that touch": "`rolling` or `support` in [constraints]; a push by max(0, depth) in [forces]",
    "pairs of geoms that touch": "`rolling` or `support` in [constraints]; a push by max(0, depth) in [forces]",
    "friction": SLIDING,
    "softness of frictionloss": "the joint's `friction`, with `smooth`",
    "softness of limits": "`stop = { stiffness, damping }` of the joint",
    "motion of a mocap body": "a `motion` of coordinates of a joint",
    "springs and dampers that are not linear": "the law as the joint's torque or force",
    "yielding springs of free and ball joints": IN_SPACE,
    "springs that yield": "the law as the joint's torque or force",
    "friction of free and ball joints": IN_SPACE,
    "limits of free and ball joints": IN_SPACE,
    "dampers that are not linear of free and ball joints": IN_SPACE,
    "limits of motors": LAW,
    "limits of tendons": "a `potential` of max(0, length - limit)^2",
    STARTS_BEYOND: "--start; `limits` of the joint, and a start between them",
    FOLLOWS: "`limits` of the joint",
    NO_RANGE: "a joint of the kind `fixed`",
    "filters of motors": "an activation that the caller computes; a coordinate with its own rate",
    "delays of motors": "an input that comes later",
    "inputs of motors": "none is needed",
    "motors that are no linear laws": "the law as a force in [forces], with an input of [inputs]",
    "motors by plugins": "the law as a force in [forces], with an input of [inputs]",
    "tendons through places": "`spring`, `link`, `string` between points",
    "fluid": "`drag`, `plate`, `buoyancy`, `added_mass` in [forces]",
    "softness of equalities": "a `spring` and a `damper` in place of the constraint",
    "welds that cannot close": "a `clamp` from a start at which the bodies stand as they are welded",
    "start where constraints gape": "--start; a `spring` and a `damper` in place of the constraint",
    "motors that are switched off": "none is needed",
    "motors on other things than joints, tendons between two places, and sites": "a `force` or `couple` in [forces]",
    "motors on the ground": "none is needed",
    "armature of tendons between places": "a `kinetic` energy by the coordinates in [forces]",
    "friction, bent springs and dampers of tendons": "a `between` law of r and r' in [forces]",
    "equalities that are switched off": "none is needed",
    "equalities of other kinds": "an `equation` between coordinates and places in [constraints]",
    "flexible bodies": "bodies on joints with stiffness",
    "plugin": "the law as a force in [forces]",
    "plugins": "the law as a force in [forces]",
    "model": "eomgen import FILE --model NAME",
    "include": "put the file next to this one, and import again",
    "joint": "both models within one <model>",
    "fluid_added_mass": "an `added_mass` in [forces]",
    "drake:rotor_inertia": "the `armature` of a joint, ratio^2*J",
    "joint of <mimic>": "an `equation` in [constraints]",
    "drake:joint": "a joint in the body's table",
    "mimic": "an `equation` in [constraints]",
    "transmission": "the joint's `armature` and input",
}


@dataclass(frozen=True)
class LeftOut:
    """Things of one sort in a file that a model has no counterpart for.

    Args:
        what: their kind: "collision".
        where: each of them.
        why: why there is none, or how a model says it.
        nearest: nearest counterpart in a model; None where no motion depends on it.
    """

    what: str
    where: tuple[str, ...]
    why: str
    nearest: str | None = None

    def __str__(self) -> str:
        listed = ", ".join(dict.fromkeys(self.where))
        reported = f"{self.what} ({self.why}): {listed}" if listed else f"{self.what} ({self.why})"
        return f"{reported}; nearest: {self.nearest}" if self.nearest else reported

    def as_dict(self) -> dict[str, Any]:
        return {"what": self.what, "where": list(self.where), "why": self.why, "nearest": self.nearest}


def reported_left(what: str, where: Iterable[str], why: str = NO_COUNTERPART) -> LeftOut:
    """Thing of a robot's file that is left out, with its nearest counterpart in a model."""
    return LeftOut(what, tuple(where), why, NEAREST.get(what))


def add_left_out(reported: list[LeftOut], what: str, where: Sequence[str], why: str) -> None:
    """Adds a thing that is left out, where there is one."""
    if where:
        reported.append(reported_left(what, where, why))


@dataclass(frozen=True)
class Imported:
    """A robot file as the tables of a model file.

    Args:
        tables: tables as a TOML reader would give them.
        left_out: parts without a counterpart.
    """

    tables: Entries
    left_out: tuple[LeftOut, ...] = ()


@dataclass
class LegalNames:
    """Legal names, each given once, like those that the file uses."""

    given: set[str] = field(default_factory=lambda: set(RESERVED))

    def new(self, wanted: str, otherwise: str = "x") -> str:
        """The name nearest to the one wanted that is legal and free."""
        plain = ILLEGAL.sub("_", wanted).strip("_") or otherwise
        if not plain[0].isalpha():
            plain = f"{otherwise}_{plain}"
        name, k = plain, 1
        while name in self.given:
            k += 1
            name = f"{plain}_{k}"
        self.given.add(name)
        return name


@dataclass(frozen=True)
class Seat:
    """Seat of a joint: a body, a place on it and axes.

    Args:
        turns: the rotation R as turns of a model file.
    """

    on: str | None
    at: Vector = ORIGIN
    R: Matrix = Matrix.IDENTITY
    turns: Sequence[Entries] = ()

    def fields(self, beyond: Vector = ORIGIN) -> Entries:
        """The keys of a joint there, `beyond` further on in the turned axes."""
        at = self.at + self.R @ beyond if any(beyond) else self.at
        found: Entries = {} if self.on is None else {"on": self.on}
        if any(at):
            found["at"] = in_file(at)
        if self.turns:
            found["turned"] = self.turns[0] if len(self.turns) == 1 else list(self.turns)
        return found


@dataclass(frozen=True)
class Moved:
    """One joint: its keys in addition to those of its seat, and the point of the body at which it sits, body axes."""

    keys: Entries
    pivot: Vector = ORIGIN
    name: str = ""


def hung(name: str, body: Entries, seat: Seat, joints: Sequence[Moved], names: LegalNames) -> dict[str, Entries]:
    """A body on its joints, one after the other; between them frames without mass.

    Each but the first sits at its pivot in the axes of the frame before, which are the body's own where it is at rest.
    """
    check_patience()
    if not joints:
        return {name: {**body, "joint": {"kind": "fixed", **seat.fields()}}}
    found: dict[str, Entries] = {}
    for k, joint in enumerate(joints):
        last = k == len(joints) - 1
        own: Entries = dict(body) if last else {"about": f"between the joints of {name}"}
        where = seat.fields(joint.pivot)
        if any(joint.pivot):
            pivot = "pivot" if last and "pivot" not in own.get("points", {}) else "joint"
            own["points"] = {**own.get("points", {}), pivot: in_file(joint.pivot)}
            where["point"] = pivot
        own["joint"] = {"kind": joint.keys["kind"], **where, **joint.keys}
        frame = name if last else names.new(f"{name}_{joint.name}")
        found[frame] = own
        seat = Seat(frame)
    return found


@dataclass(frozen=True)
class Range:
    """The values of a joint's variable between rigid stops; None where there is none."""

    low: Decimal | None = None
    high: Decimal | None = None

    @property
    def ends(self) -> bool:
        return self.low is not None or self.high is not None

    @property
    def empty(self) -> bool:
        return self.low is not None and self.high is not None and not self.low < self.high

    def holds(self, x: Decimal) -> bool:
        """True if x is between the stops, and at none."""
        return (self.low is None or self.low < x) and (self.high is None or x < self.high)

    @property
    def middle(self) -> Decimal:
        """A value between the stops."""
        if self.low is not None and self.high is not None:
            return (self.low + self.high) / 2
        return self.low + 1 if self.low is not None else ZERO if self.high is None else self.high - 1

    def moved(self, shift: Decimal) -> Range:
        """Range of a variable that is larger by so much."""
        return Range(*(None if x is None else x + shift for x in (self.low, self.high)))

    def within(self, other: Range, factor: Decimal) -> bool:
        """True if factor times each value of another range is in this one."""
        ends = [(x.low, x.high) for x in (self, other)]
        (low, high), (least, most) = ends if factor > 0 else [ends[0], ends[1][::-1]]
        above = low is None or (least is not None and low <= factor * least)
        return above and (high is None or (most is not None and factor * most <= high))

    def limits(self) -> Entries:
        """The field of a joint."""
        ends = ["-inf" if self.low is None else self.low, "inf" if self.high is None else self.high]
        return {"limits": ends} if self.ends and not self.empty else {}

    def remark(self, unit: str) -> list[str]:
        """The words for a coordinate whose joint has no `limits`."""
        low, high = (
            f"{sign}{UNLIMITED}" if x is None else decimal_text(x) for x, sign in ((self.low, "-"), (self.high, ""))
        )
        return [f"from {low} to {high} {unit}"] if self.ends else []


def started_within(
    found: Entries, left: Callable[..., None], ranges: Mapping[str, Range], follows: Mapping[str, Mimic]
) -> None:
    """Starts of coordinates strictly between their limits, others follow; what follows another has no stops of its own.

    Args:
        left: takes what is told, where and why.
    """
    moved = [q for q, own in ranges.items() if q not in follows and own.ends and not own.empty and not own.holds(ZERO)]
    for q in moved:
        found[q] = {**found[q], "start": ranges[q].middle}
    for _ in follows:  # what follows a follower comes after it
        for q, mimic in follows.items():
            start = mimic.offset + mimic.factor * found[mimic.leader].get("start", ZERO)
            if start or "start" in found[q]:
                found[q] = {**found[q], "start": start}
    left(STARTS_BEYOND, moved, "0 is on or beyond a limit: it starts between them")
    tighter = [q for q, x in follows.items() if not ranges[q].moved(-x.offset).within(ranges[x.leader], x.factor)]
    left(FOLLOWS, tighter, "the joint that it follows has the stops")
    left(NO_RANGE, [q for q, own in ranges.items() if own.empty], "the upper one is not above the lower one")


@dataclass(frozen=True)
class Mimic:
    """A coordinate that follows another one: factor times it, and an offset."""

    leader: str
    factor: Decimal
    offset: Decimal


def remarked(about: str | None) -> dict[str, str]:
    """Data of a remark written by an import: another program's name, limits."""
    found = {key: re.search(pattern, about or "") for key, pattern in REMARKS.items()}
    return {key: match[1] for key, match in found.items() if match}


def in_file(v: Iterable[Any]) -> list[Decimal]:
    """A vector as it stands in a model file."""
    return [computed(x) for x in v]


def signed_sum(terms: Iterable[tuple[Decimal, str]], constant: Decimal = ZERO, *, weighed: bool = False) -> str:
    """The sum of numbers times names, and a constant, as a person writes it; 1*name where the numbers have a unit."""
    pieces: list[str] = []
    for factor, name in (*terms, (constant, "")):
        if factor == 0 and (name or pieces):
            continue
        size = decimal_text(abs(factor))
        shown = name if name and abs(factor) == 1 and not weighed else f"{size}*{name}" if name else size
        sign = "-" if factor < 0 else "+"
        pieces.append(f"{sign} {shown}" if pieces else f"-{shown}" if sign == "-" else shown)
    return " ".join(pieces) or "0"


def gap(one: str, terms: Iterable[tuple[Decimal, str]], constant: Decimal = ZERO, *, weighed: bool = False) -> str:
    """one + terms + constant, which a constraint holds at 0; `weighed` where not all have one unit: q - 1*s for 1
    rad/m."""
    rest = signed_sum(terms, constant, weighed=weighed)
    return one if rest == "0" else f"{one} - {rest[1:]}" if rest[0] == "-" else f"{one} + {rest}"


def without_empty(tables: Mapping[str, Any]) -> Entries:
    """The tables that hold something."""
    return {key: value for key, value in tables.items() if value not in ({}, None, [])}


# -------- toml text -------------------------------------------------------------------------------------------
# Tables of a model file -> its text, as a person lays it out.


BARE = re.compile(r"[A-Za-z0-9_-]+")
WIDTH = 118  # of a remark
SHORT = ("parameters", "coordinates", "speeds", "inputs", "points", "outputs")  # tables of one line an entry


def toml_text(tables: Mapping[str, Any], before: Sequence[str] = (), after: Sequence[str] = ()) -> str:
    """The text of a model file; remarks stand before and after it."""
    lines = [*_remarks(before), *(f"{_key(k)} = {_value(v)}" for k, v in tables.items() if not isinstance(v, Mapping))]
    for name, table in tables.items():
        if not isinstance(table, Mapping):
            continue
        if name in SHORT or not all(isinstance(part, Mapping) for part in table.values()):
            lines += ["", f"[{_key(name)}]", *(f"{_key(key)} = {_entry(value)}" for key, value in table.items())]
            continue
        for key, part in table.items():
            lines += ["", f"[{_key(name)}.{_key(key)}]", *(f"{_key(k)} = {_value(v)}" for k, v in part.items())]
    return "\n".join([*lines, *([""] if after else []), *_remarks(after), ""])


def expanded_text(model: Model, data: bytes) -> str:
    """The file of a model as it is read: what repeats, and the parts of other files, written out.

    Args:
        data: the file.
    """
    return data.decode("utf-8-sig") if model.repeat is None else toml_text(tables_read(model))


def _remarks(remarks: Sequence[str]) -> list[str]:
    return [
        line
        for remark in remarks
        for line in textwrap.wrap(
            visible(remark), WIDTH, initial_indent="# ", subsequent_indent="#   ", break_on_hyphens=False
        )
    ]


def _key(name: str) -> str:
    return name if BARE.fullmatch(name) else _text(name)


def _entry(value: Any) -> str:
    """An entry of a short table: a table of one start or value is that alone."""
    if isinstance(value, Mapping) and len(value) == 1 and next(iter(value)) in ("start", "value"):
        return _value(next(iter(value.values())))
    return _value(value)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }" if value else "{}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Decimal):
        return decimal_text(value)
    return str(value) if isinstance(value, int) else _text(value)


def _text(text: str) -> str:
    """Text in quotes; control characters, of terminals and of TOML, as escapes."""
    return HIDDEN.sub(lambda found: f"\\U{ord(found[0]):08X}", json.dumps(text, ensure_ascii=False))


def decimal_text(value: Decimal) -> str:
    """Number as written by people: no trailing zeros, a power of ten only where it is short."""
    value = value.normalize() if value else Decimal(0)
    exponent = value.adjusted()
    if -6 < exponent < 12:
        return f"{value:f}"
    sign, digits, power = value.as_tuple()
    assert isinstance(power, int)
    mantissa = "".join(map(str, digits))
    point = f"{mantissa[0]}.{mantissa[1:]}" if len(mantissa) > 1 else mantissa
    return f"{'-' if sign else ''}{point}e{exponent}"
