"""Bodies and their pieces -> the steps of a report of inertia.

Sums of rows -> the steps of a report of inertia: masses, parallel axes, both conventions, principal axes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from eomgen.documents import Cell, Formula, Grid, Law, Omitted, Side, Statement, prose
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import InertiaSum, Principal
from eomgen.model import about_axis, polar, second_moments
from eomgen.symbolic.expression import (
    Matrix,
    Node,
    Scalar,
    Vector,
    holds_many_digits,
    is_zero,
    order,
    over,
    sqrt,
    symbols_of,
)
from eomgen.symbolic.print import text_size

AXES = "xyz"
LONGEST = 24  # characters of an exact entry of a table; where one is longer, all are numbers
LONGEST_LINE = 300  # of an exact side of a formula, where it has a number too; of a formula in a table
MOST_PRINTED = 4000  # of one without a number; of a longer one its size is stated, the JSON entries hold it whole
PRODUCTS = ((0, 1), (1, 2), (2, 0))


@dataclass(frozen=True)
class InertiaEntry:
    """One result by name: its printed label and its value."""

    name: str
    label: Law
    value: Scalar
    unit: str


@dataclass(frozen=True)
class Section:
    """A sum about one point.

    Args:
        sum: the rows, in one set of axes.
        point: about which.
        of: the part of the results' names in parentheses: "plate", "plate, O", "O".
        flat: only the moment about z is known.
        centroidal: the point is the mass centre.
        silent: bodies that have a mass and say nothing of their inertia: no moments are known.
        bodies: whose rows they are.
    """

    sum: InertiaSum
    point: Vector
    of: str
    flat: bool
    centroidal: bool
    silent: tuple[str, ...] = ()
    bodies: tuple[str, ...] = ()

    @property
    def plane(self) -> bool:
        return self.sum.motion.scope.model.space == "plane"

    @cached_property
    def tensor(self) -> Matrix:
        return self.sum.tensor(self.point)

    def named(self, letter: str, index: str, value: Scalar, unit: str) -> InertiaEntry:
        text = f"{letter}_{index}" if index else letter
        latex = f"{letter}_{{{index}}}" if index else letter
        whose = f"({self.of})" if self.of else ""
        return InertiaEntry(text + whose, Law(text, latex), value, unit)


def number(section: Section, x: Scalar) -> str:
    """The value as text; "" where it holds what has none."""
    values = section.sum.numbers((x,))
    return "" if values is None else f"{values[0] + 0.0:.6g}"


def grid(section: Section, head: tuple[Cell, ...], rows: Sequence[Sequence[str | Law | Scalar]]) -> Grid:
    """A table of scalars and words: exact where all are short or one has no value, else in numbers.

    What is longer than a line, and has no number, stands there by its size.
    """
    scalars = [x for row in rows for x in row if not isinstance(x, str | Law)]
    valued = section.sum.numbers(scalars) is not None
    in_numbers = valued and any(text_size(section.sum.short(x)) > LONGEST for x in scalars)

    def cell(x: str | Law | Scalar) -> Cell:
        if isinstance(x, str | Law):
            return x
        return number(section, x) if in_numbers else _bounded(section.sum.short(x), LONGEST_LINE)

    return Grid(head, tuple(tuple(map(cell, row)) for row in rows))


def _bounded(x: Scalar, most: int) -> Scalar | Omitted:
    """A formula of at most so many characters; of a longer one its size."""
    return x if text_size(x) <= most else Omitted(((x,),))


def line(section: Section, result: InertiaEntry) -> Formula:
    """name = exact = number."""
    sides: list[Side] = [result.label]
    value = number(section, result.value)
    of_digits = type(result.value) is Node and not symbols_of((result.value,)) and holds_many_digits(result.value)
    if (text_size(result.value) <= LONGEST_LINE and not of_digits) or not value:
        sides.append(_bounded(result.value, MOST_PRINTED))
    if value and (of_digits or text_size(result.value) > len(value)):
        sides.append(Law(value, value))
    return Formula(tuple(sides))


# -- mass and mass centre ---------------------------------------------------------------------------


def mass_results(section: Section) -> list[InertiaEntry]:
    """Mass and mass centre."""
    count = 2 if section.plane else 3
    places = zip(AXES[:count], section.sum.com, strict=False)
    return [section.named("m", "", section.sum.m, "kg"), *(section.named(x, "C", c, "m") for x, c in places)]


def masses_grid(section: Section) -> Iterator[Statement]:
    """Table of the pieces with their masses and mass centres."""
    if len(section.sum.rows) == 1:
        return
    count = 2 if section.plane else 3
    head: tuple[Cell, ...] = ("", Law.of_letter("m"), *(Law.of_letter(f"{axis}_C") for axis in AXES[:count]))
    rows = [(row.label, row.sign * row.mass.m, *row.mass.com[:count]) for row in section.sum.rows]
    yield grid(section, head, rows)


# -- moments ----------------------------------------------------------------------------------------


def moments_grid(section: Section) -> Iterator[Statement]:
    """Table of each row's own moments and its parallel-axis terms; products of inertia have the textbook's plus."""
    columns = _columns(section)
    if all(is_zero(x) for row in section.sum.rows for line in row.shift(section.point) for x in line):
        return
    rows: list[tuple[str | Scalar, ...]] = []
    for row in section.sum.rows:
        for what, part in (("own", row.own()), ("parallel axes", row.shift(section.point))):
            rows.append((f"{row.label}, {what}", *(_plus(part, i, j) for i, j in columns)))
    rows.append(("sum", *(_plus(section.tensor, i, j) for i, j in columns)))
    yield prose("Own moments, and with d from the point to the mass centre, ", STEINER, ":")
    yield grid(section, ("", *(Law.of_letter(f"J_{AXES[i]}{'' if i == j else AXES[j]}") for i, j in columns)), rows)


def _plus(I: Matrix, i: int, j: int) -> Scalar:
    """A moment, or a product with the textbook's plus."""
    entry: Scalar = I[i][j] if i == j else -I[i][j]
    return entry


STEINER = Law(
    "J_x + m (d_y^2 + d_z^2), J_xy + m d_x d_y, and so on",
    r"J_{x} + m (d_{y}^{2} + d_{z}^{2}),\ J_{xy} + m d_{x} d_{y}, \dots",
)


def _columns(section: Section) -> list[tuple[int, int]]:
    if section.flat:
        return [(2, 2)]
    return [(0, 0), (1, 1), (2, 2), *(PRODUCTS[:1] if section.plane else PRODUCTS)]


def tensor_results(section: Section) -> list[InertiaEntry]:
    """The entries of the tensor, and the textbook's products."""
    I = section.tensor
    found = [section.named("I", AXES[i] + AXES[j], I[i][j], "kg*m^2") for i, j in _columns(section)]
    products = [(i, j) for i, j in _columns(section) if i != j]
    textbook = (section.sum.short(_plus(I, i, j)) for i, j in products)
    named = (section.named("J", AXES[i] + AXES[j], x, "kg*m^2") for (i, j), x in zip(products, textbook, strict=True))
    return [*found, *named]


def conventions_grid(section: Section) -> Grid:
    """Tensor and textbook side by side."""
    I = section.tensor
    rows: list[tuple[Law | Scalar, ...]] = []
    for i, j in _columns(section):
        pair = AXES[i] + AXES[j]
        other = AXES[i] if i == j else pair
        textbook = Law(f"J_{other}", f"J_{{{other}}}")
        rows.append((Law(f"I_{pair}", f"I_{{{pair}}}"), I[i][j], textbook, _plus(I, i, j)))
    return grid(section, ("tensor (products with -)", "kg*m^2", "textbook (products with +)", "kg*m^2"), rows)


def polar_results(section: Section) -> list[InertiaEntry]:
    """About the point itself, and about the planes through it."""
    if section.flat:
        return []
    P = second_moments(section.tensor)
    count = 2 if section.plane else 3
    planes = [section.named("P", AXES[k], section.sum.short(P[k][k]), "kg*m^2") for k in range(count)]
    return [section.named("J", "P", section.sum.short(polar(section.tensor)), "kg*m^2"), *planes]


def axis_results(section: Section, point: Vector, along: Vector) -> list[InertiaEntry]:
    """About the axis through a point."""
    value = section.sum.short(about_axis(section.sum.tensor(point), along))
    return [section.named("J", "axis", value, "kg*m^2")]


# -- principal axes ---------------------------------------------------------------------------------


def principal_statements(section: Section) -> tuple[list[Statement], list[InertiaEntry], list[list[float]] | None]:
    """The principal moments, radii of gyration and axes; the rows of R as numbers too, where they have values."""
    if section.flat:
        return [], [], None
    found = Principal.of(section.tensor, section.sum.motion.scope)
    results = [section.named("I", str(k), x, "kg*m^2") for k, x in enumerate(found.moments, start=1)]
    if not is_zero(section.sum.m):
        radii = (_radius(section.sum, x) for x in found.moments)
        results += [section.named("k", str(k), x, "m") for k, x in enumerate(radii, start=1)]
    rows = axes_in_numbers(section, found)
    statements: list[Statement] = [prose(_words(found)), *(line(section, result) for result in results)]
    return [*statements, *_axes_grid(section, found, rows)], results, rows


def _radius(sum: InertiaSum, moment: Scalar) -> Scalar:
    """k = sqrt(I/m), short where the moment is."""
    if text_size(moment) > LONGEST_LINE:
        root: Scalar = sqrt(over(moment, sum.m))
        return root
    return sum.short(sqrt(sum.short(over(moment, sum.m))))


def _words(found: Principal) -> str:
    words = "Principal moments, and radii of gyration k = sqrt(I/m)"
    if not found.sorted:
        words += " (which is the largest depends on the values)"
    if len(found.equal) == 3:
        return words + ". All are equal: every axis is principal:"
    if found.equal:
        k, n = found.equal[0]
        return words + f". I_{k + 1} = I_{n + 1}: every axis in the plane of axes {k + 1} and {n + 1} is principal:"
    return words + ":"


def _axes_grid(section: Section, found: Principal, rows: list[list[float]] | None) -> Iterator[Statement]:
    head: tuple[Cell, ...] = ("axis", *map(Law.of_letter, AXES))
    words = "The rows of R are the principal axes, right-handed: R I R^T is diagonal."
    longest = LONGEST if rows is not None else LONGEST_LINE
    if found.axes is not None and all(text_size(x) <= longest for row in found.axes for x in row):
        yield prose(words)
        yield Grid(head, tuple((str(k), *row) for k, row in enumerate(found.axes, start=1)))
    elif rows is not None:
        yield prose(f"{words} In numbers, the closed form is long:")
        yield Grid(head, tuple((str(k), *(f"{x + 0.0:.6f}" for x in row)) for k, row in enumerate(rows, start=1)))
    else:
        yield prose("The principal axes have no short closed form; give the parameters values to see them.")


def axes_in_numbers(section: Section, found: Principal) -> list[list[float]] | None:
    """The rows of R in floating point: the exact ones; eigenvectors of the tensor where these have no value, as where
    a product vanishes in the state alone."""
    if found.axes is not None and len(order([x for row in found.axes for x in row])) < 5000:
        flat = section.sum.numbers([x for row in found.axes for x in row])
        if flat is not None and np.allclose(np.reshape(flat, (3, 3)) @ np.reshape(flat, (3, 3)).T, np.eye(3)):
            return [list(row) for row in np.reshape(flat, (3, 3))]
    entries, moments = (section.sum.numbers(x) for x in ([x for row in section.tensor for x in row], found.moments))
    if entries is None or moments is None:
        return None
    axes = np.linalg.eigh(np.reshape(entries, (3, 3)))[1].T[np.argsort(np.argsort(moments))]
    axes[2] = np.cross(axes[0], axes[1])
    return [list(map(float, row)) for row in axes]


def named_results(results: Sequence[InertiaEntry]) -> dict[str, InertiaEntry]:
    """The results by name."""
    return {result.name: result for result in results}
