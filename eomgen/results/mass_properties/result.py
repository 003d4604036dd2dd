"""Model -> Inertia: masses, mass centres, tensors, principal axes, drawn.

Model -> Inertia: masses, mass centres, tensors, principal axes of its bodies, about points and axes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np

from eomgen.documents import (
    Cell,
    Document,
    Formula,
    Grid,
    Law,
    Omitted,
    Picture,
    Prose,
    Quantity,
    Result,
    Side,
    Sketch,
    Statement,
    Step,
    data_step,
    document_of,
    picture_of_scene,
    prose,
)
from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import InertiaAbout, SystemInertia
from eomgen.mechanics.start import Start
from eomgen.model import ModelOrPath, Values, model_at, nearest
from eomgen.proof import Certificate, Stated, mass_checks
from eomgen.resources import doing
from eomgen.scene import Mark, axis_marks, center_marks, scene_of_inertia
from eomgen.study import study_of
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    State,
    Vector,
    holds_many_digits,
    is_zero,
    symbols_of,
)
from eomgen.symbolic.print import readable_text, text_size

# -------- steps ------------------------------------------------------------------------------------------------
# Bodies and their pieces -> the steps of a report of inertia.
#
# Sums of rows -> the steps of a report of inertia: masses, parallel axes, both conventions, principal axes.

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
        about: the rows, in one set of axes, and the point.
        of: the part of the results' names in parentheses: "plate", "plate, O", "O".
        flat: only the moment about z is known.
        centroidal: the point is the mass centre.
        silent: bodies that have a mass and say nothing of their inertia: no moments are known.
        bodies: whose rows they are.
    """

    about: InertiaAbout
    of: str
    flat: bool
    centroidal: bool
    silent: tuple[str, ...] = ()
    bodies: tuple[str, ...] = ()

    @property
    def plane(self) -> bool:
        return self.about.sum.motion.scope.model.space == "plane"

    def named(self, letter: str, index: str, value: Scalar, unit: str) -> InertiaEntry:
        text = f"{letter}_{index}" if index else letter
        latex = f"{letter}_{{{index}}}" if index else letter
        whose = f"({self.of})" if self.of else ""
        return InertiaEntry(text + whose, Law(text, latex), value, unit)


def number(section: Section, x: Scalar) -> str:
    """The value as text; "" where it holds what has none."""
    values = section.about.sum.numbers((x,))
    return "" if values is None else f"{values[0] + 0.0:.6g}"


def grid(section: Section, head: tuple[Cell, ...], rows: Sequence[Sequence[str | Law | Scalar]]) -> Grid:
    """A table of scalars and words: exact where all are short or one has no value, else in numbers.

    What is longer than a line, and has no number, stands there by its size.
    """
    scalars = [x for row in rows for x in row if not isinstance(x, str | Law)]
    valued = section.about.sum.numbers(scalars) is not None
    in_numbers = valued and any(text_size(section.about.sum.short(x)) > LONGEST for x in scalars)

    def cell(x: str | Law | Scalar) -> Cell:
        if isinstance(x, str | Law):
            return x
        return number(section, x) if in_numbers else _bounded(section.about.sum.short(x), LONGEST_LINE)

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
    places = zip(AXES[:count], section.about.sum.com, strict=False)
    return [section.named("m", "", section.about.sum.m, "kg"), *(section.named(x, "C", c, "m") for x, c in places)]


def masses_grid(section: Section) -> Iterator[Statement]:
    """Table of the pieces with their masses and mass centres."""
    if len(section.about.sum.rows) == 1:
        return
    count = 2 if section.plane else 3
    head: tuple[Cell, ...] = ("", Law.of_letter("m"), *(Law.of_letter(f"{axis}_C") for axis in AXES[:count]))
    rows = [(row.label, row.sign * row.mass.m, *row.mass.com[:count]) for row in section.about.sum.rows]
    yield grid(section, head, rows)


# -- moments ----------------------------------------------------------------------------------------


def moments_grid(section: Section) -> Iterator[Statement]:
    """Table of each row's own moments and its parallel-axis terms; products of inertia have the textbook's plus."""
    columns = _columns(section)
    point, tensor = section.about.point, section.about.tensor
    if all(is_zero(x) for row in section.about.sum.rows for line in row.shift(point) for x in line):
        return
    rows: list[tuple[str | Scalar, ...]] = []
    for row in section.about.sum.rows:
        for what, part in (("own", row.own()), ("parallel axes", row.shift(point))):
            rows.append((f"{row.label}, {what}", *(part[i][j] if i == j else -part[i][j] for i, j in columns)))
    rows.append(("sum", *(tensor[i][j] if i == j else -tensor[i][j] for i, j in columns)))
    yield prose("Own moments, and with d from the point to the mass centre, ", STEINER, ":")
    yield grid(section, ("", *(Law.of_letter(f"J_{AXES[i]}{'' if i == j else AXES[j]}") for i, j in columns)), rows)


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
    columns, about = _columns(section), section.about
    found = [section.named("I", AXES[i] + AXES[j], about.tensor[i][j], "kg*m^2") for i, j in columns]
    products = [(i, j) for i, j in columns if i != j]
    return [*found, *(section.named("J", AXES[i] + AXES[j], about.product(i, j), "kg*m^2") for i, j in products)]


def conventions_grid(section: Section) -> Grid:
    """Tensor and textbook side by side."""
    I = section.about.tensor
    rows: list[tuple[Law | Scalar, ...]] = []
    for i, j in _columns(section):
        pair = AXES[i] + AXES[j]
        other = AXES[i] if i == j else pair
        textbook = Law(f"J_{other}", f"J_{{{other}}}")
        rows.append((Law(f"I_{pair}", f"I_{{{pair}}}"), I[i][j], textbook, I[i][j] if i == j else -I[i][j]))
    return grid(section, ("tensor (products with -)", "kg*m^2", "textbook (products with +)", "kg*m^2"), rows)


def polar_results(section: Section) -> list[InertiaEntry]:
    """About the point itself, and about the planes through it."""
    if section.flat:
        return []
    planes = zip(AXES[: 2 if section.plane else 3], section.about.planar, strict=False)
    of_planes = [section.named("P", axis, x, "kg*m^2") for axis, x in planes]
    return [section.named("J", "P", section.about.polar, "kg*m^2"), *of_planes]


def axis_results(section: Section, point: Vector, along: Vector) -> list[InertiaEntry]:
    """About the axis through a point."""
    return [section.named("J", "axis", replace(section.about, point=point).axial(along), "kg*m^2")]


# -- principal axes ---------------------------------------------------------------------------------


def principal_statements(section: Section) -> tuple[list[Statement], list[InertiaEntry], list[list[float]] | None]:
    """The principal moments, radii of gyration and axes; the rows of R as numbers too, where they have values."""
    if section.flat:
        return [], [], None
    about, found = section.about, section.about.principal
    results = [section.named("I", str(k), x, "kg*m^2") for k, x in enumerate(found.moments, start=1)]
    if not is_zero(section.about.sum.m):
        radii = map(about.radius, found.moments)
        results += [section.named("k", str(k), x, "m") for k, x in enumerate(radii, start=1)]
    rows = about.axes_in_numbers()
    words = _words(found.equal, of_order=found.sorted)
    statements: list[Statement] = [prose(words), *(line(section, result) for result in results)]
    return [*statements, *_axes_grid(found.axes, rows)], results, rows


def _words(equal: Sequence[tuple[int, int]], *, of_order: bool) -> str:
    words = "Principal moments, and radii of gyration k = sqrt(I/m)"
    if not of_order:
        words += " (which is the largest depends on the values)"
    if len(equal) == 3:
        return words + ". All are equal: every axis is principal:"
    if equal:
        k, n = equal[0]
        return words + f". I_{k + 1} = I_{n + 1}: every axis in the plane of axes {k + 1} and {n + 1} is principal:"
    return words + ":"


def _axes_grid(exact: Sequence[Vector] | None, rows: list[list[float]] | None) -> Iterator[Statement]:
    head: tuple[Cell, ...] = ("axis", *map(Law.of_letter, AXES))
    words = "The rows of R are the principal axes, right-handed: R I R^T is diagonal."
    longest = LONGEST if rows is not None else LONGEST_LINE
    if exact is not None and all(text_size(x) <= longest for row in exact for x in row):
        yield prose(words)
        yield Grid(head, tuple((str(k), *row) for k, row in enumerate(exact, start=1)))
    elif rows is not None:
        yield prose(f"{words} In numbers, the closed form is long:")
        yield Grid(head, tuple((str(k), *(f"{x + 0.0:.6f}" for x in row)) for k, row in enumerate(rows, start=1)))
    else:
        yield prose("The principal axes have no short closed form; give the parameters values to see them.")


def named_results(results: Sequence[InertiaEntry]) -> dict[str, InertiaEntry]:
    """The results by name."""
    return {result.name: result for result in results}


TENSOR = Law(
    "I_xx = integral (y^2 + z^2) dm, I_xy = - integral x y dm",
    r"I_{xx} = \int (y^{2} + z^{2})\,dm,\ I_{xy} = -\int x y\,dm",
)
POLAR = Law("J_P = integral r^2 dm", r"J_{P} = \int r^{2}\,dm")
PLANAR = Law("P_x = integral x^2 dm", r"P_{x} = \int x^{2}\,dm")
TEXTBOOK = Law("J_xy = + integral x y dm", r"J_{xy} = +\int x y\,dm")


@dataclass(frozen=True)
class Inertia(Result):
    """Masses, mass centres and tensors of inertia of a model's bodies.

    Args:
        system: whose bodies they are.
        results: by name: m(plate), x_C(plate), I_xx(plate), J_xy(plate), I_1(plate), k_1(plate), I_xx(O), J_P(O), ...
        axes: the principal axes in numbers, the rows of R, by "plate" or "O".
        steps: the derivation of the results.
        stated: all stated values, with the bodies to which they belong.
        start: the state of moving bodies in the numbers; {}: parameters or the start have none.
    """

    system: System
    results: dict[str, Quantity]
    axes: dict[str, list[list[float]]]
    steps: tuple[Step, ...]
    stated: tuple[Stated, ...] = ()
    start: State = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<inertia of {self.system.scope.model.name!r}>"

    def __getitem__(self, name: str) -> Quantity:
        return self.results[name]

    @property
    def derivation(self) -> Document:
        """Document with the steps by which the results are found."""
        return document_of(self.system.scope.model, "inertia", self.steps)

    @property
    def picture(self) -> Picture:
        """The bodies with mass centres and principal axes, in space with the ellipsoid of inertia.

        Raises:
            MissingValues: parameters without a value.
        """
        return inertia_picture(self.system, self.axes, self.moments)

    @property
    def moments(self) -> dict[str, list[float]]:
        """The three principal moments in numbers, by "plate" or "O", of the bodies that have them [kg m^2]."""
        found = {of: [self.results.get(f"I_{k}({of})") for k in (1, 2, 3)] for of in self.axes}
        known = {of: [x.value for x in each if x is not None and x.value is not None] for of, each in found.items()}
        return {of: each for of, each in known.items() if len(each) == 3}

    def certify(self) -> Certificate:
        """Check shapes, parts and all that is stated of them against quadratures over the volumes of the shapes."""
        return Certificate(()) + mass_checks(self.system.motion, self.stated, self.start)

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        return {"name": self.system.scope.model.name, "results": self.results, "principal_axes": self.axes}


@doing("masses and inertia")
def inertia(
    model: ModelOrPath,
    bodies: Sequence[str] = (),
    *,
    about: str | None = None,
    axis: str | None = None,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Inertia:
    """Mass, mass centre, tensor, principal moments and axes of bodies, each about its mass centre in its own axes.

    Several bodies are taken together too, in ground axes where they stand.

    Args:
        bodies: by name; none: all.
        about: a point, "O" or "arm.end", about which they are taken together too.
        axis: "A,B": the axis through two points; or x, y, z through `about`.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: no such body, point or axis.
        DerivationError: a model without bodies.
    """
    model = model_at(model, parameters, start)
    return _Report(study_of(model).system, tuple(bodies), about, axis).made()


@dataclass(frozen=True)
class _Report:
    """The steps of one report."""

    system: System
    named: tuple[str, ...]
    about: str | None
    axis: str | None

    @cached_property
    def stated(self) -> list[Stated]:
        """Values stated so far, for the proof."""
        return []

    @cached_property
    def start(self) -> State:
        """State of moving bodies in the numbers; empty where the start is not known."""
        try:
            return values_at_start(self.system)
        except (MissingValues, DerivationError):
            return {}

    def _when(self, section: Section) -> Iterable[Statement]:
        """Sentence that names the state of the numbers, if the requested bodies move."""
        about, q = section.about, self.system.scope.symbols.q
        moving = set(q) & set(symbols_of((*about.point, *chain(*about.tensor))))
        if moving and self.start:
            where = ", ".join(f"{x.name} = {self.start[x]:.6g}" for x in q if x in moving)
            yield prose(f"Numbers at the start: {where}.")

    @property
    def bodies(self) -> tuple[str, ...]:
        """The bodies that are meant, with a mass.

        Raises:
            UsageError, DerivationError: there is no such body; none of them has a mass.
        """
        model = self.system.scope.model
        for name in self.named:
            if name not in model.bodies:
                raise UsageError(f"there is no body '{name}'", fix=nearest(name, model.bodies))
        names = self.named or tuple(link.name for link in self.system.motion.links if link.name in model.bodies)
        heavy = tuple(name for name in names if not is_zero(together_mass(self.system, name)))
        if not heavy:
            raise DerivationError("no body has a mass", fix="give a body a shape, or 'mass' and 'inertia'")
        return heavy

    def made(self) -> Inertia:
        bodies = self.bodies
        sections = [self._own(body) for body in bodies]
        made = [self._step(f"Body '{s.of}'", f"inertia_{s.of}", s) for s in sections]
        if len(bodies) > 1:
            whole = InertiaAbout.of_bodies(self.system.motion, bodies, self.start)
            section = self._centroidal(whole, "", bodies)
            made.append(self._step("The bodies together, ground axes", "inertia_together", section))
        if self.about is not None or self.axis is not None:
            made.append(self._about(bodies))
        results = [result for _, found, _ in made for result in found]
        axes = {key or "together": rows for _, _, (key, rows) in made if rows is not None}
        steps = (data_step(self.system), _conventions(), *(step for step, _, _ in made))
        return Inertia(
            self.system, self._quantities(named_results(results)), axes, steps, tuple(self.stated), self.start
        )

    def _quantities(self, entries: Mapping[str, InertiaEntry]) -> dict[str, Quantity]:
        """Each with its number: all in one go, or each by itself where some have none."""
        scalars = [entry.value for entry in entries.values()]
        whole = self.system.scope.numbers(scalars, self.start)
        single = (self.system.scope.numbers((x,), self.start) for x in scalars)
        numbers: Sequence[float | None] = whole or [None if each is None else each[0] for each in single]
        return {
            name: Quantity(readable_text(entry.value), None if x is None else x + 0.0, entry.unit)
            for (name, entry), x in zip(entries.items(), numbers, strict=True)
        }

    def _own(self, body: str) -> Section:
        return self._centroidal(InertiaAbout.of_body(self.system.motion, body, self.start), body, (body,))

    def _centroidal(self, about: InertiaAbout, of: str, bodies: tuple[str, ...]) -> Section:
        motion = self.system.motion
        return Section(
            about,
            of,
            bool(SystemInertia(motion).flat(bodies)),
            True,
            SystemInertia(motion).shapeless(bodies),
            bodies,
        )

    def _step(self, title: str, key: str, section: Section, axis: tuple[Vector, Vector] | None = None) -> Any:
        """A section as a step, its results, and its principal axes in numbers."""
        masses, tensor = mass_results(section), tensor_results(section)
        statements: list[Statement] = [*self._when(section)]
        if section.centroidal:
            statements += [*masses_grid(section), *(line(section, result) for result in masses)]
        if section.silent:
            silent = ", ".join(f"'{body}'" for body in section.silent)
            words = f"No moments: of the inertia of {silent} the model says nothing."
            self._state(section, masses, None, None)
            return Step(key, title, (*statements, prose(words))), masses, (section.of, None)
        statements += [*moments_grid(section), conventions_grid(section)]
        if any(text_size(result.value) > LONGEST for result in tensor):  # the table then holds numbers
            statements += [line(section, result) for result in tensor]
        more = [] if section.centroidal else polar_results(section)
        more += axis_results(section, *axis) if axis is not None else []
        statements += [line(section, result) for result in more]
        principal, moments, rows = principal_statements(section)
        results = [*(masses if section.centroidal else []), *tensor, *more, *moments]
        self._state(section, results, rows, axis)
        return Step(key, title, (*statements, *principal)), results, (section.of, rows)

    def _state(self, section: Section, results: Sequence[InertiaEntry], rows: Any, axis: Any) -> None:
        """Records the values that a section states, for its proof."""
        values = {result.name.partition("(")[0]: result.value for result in results}
        in_ground = not (section.centroidal and section.of)
        self.stated.append(Stated(section.of, section.bodies, in_ground, section.about.point, values, rows, axis))

    def _about(self, bodies: tuple[str, ...]) -> Any:
        """The bodies together about a point, and about an axis through it."""
        point, name, axis = self._point_and_axis()
        if silent := SystemInertia(self.system.motion).shapeless(bodies):
            raise ModelError(
                f"body '{silent[0]}' has a mass and no inertia",
                f"bodies.{silent[0]}",
                "give 'inertia' (0 for a point), or a shape; or leave it out: --body",
            )
        flat = bool(SystemInertia(self.system.motion).flat(bodies))
        whole = InertiaAbout.of_bodies(self.system.motion, bodies, self.start, point)
        section = Section(whole, name, flat, False, (), bodies)
        title = f"About {name}, ground axes" + (f", and about the axis {self.axis}" if self.axis else "")
        return self._step(title, "inertia_about", section, axis)

    def _point_and_axis(self) -> tuple[Vector, str, tuple[Vector, Vector] | None]:
        """The point, its name, and the axis: a point on it, and its direction."""
        if self.axis is None or self.axis in ("x", "y", "z"):
            if self.about is None:
                raise UsageError(f"the axis {self.axis} goes through what point?", fix="write --about POINT")
            point = self._place(self.about)
            along = Vector(int(axis == self.axis) for axis in AXES)
            return point, self.about, None if self.axis is None else (point, along)
        first, comma, second = (part.strip() for part in self.axis.partition(","))
        if not comma:
            raise UsageError(f"'{self.axis}' is no axis", fix='write x, y or z, or two points: "A,B"')
        point, other = self._place(first), self._place(second)
        along = other - point
        if all(is_zero(x) for x in along):
            raise UsageError(
                f"'{first}' and '{second}' are in one place, so they are on no single axis",
                fix="name two points that are apart",
            )
        if self.about is not None and self.about != first:
            return self._place(self.about), self.about, (point, along)
        return point, first, (point, along)

    def _place(self, name: str) -> Vector:
        """Position of a named point, ground axes."""
        known = self.system.scope.model.named_points
        if name not in known:
            raise UsageError(f"there is no point '{name}'", fix=nearest(name, known))
        return self.system.motion.position(self.system.motion.place(name))


def together_mass(system: System, body: str) -> Any:
    """The mass of a body, its pieces added up."""
    return InertiaAbout.of_body(system.motion, body, {}).sum.m


def _conventions() -> Step:
    words: Iterable[Any] = (
        "I is the inertia tensor, ",
        TENSOR,
        ". The product of inertia of the textbooks has the other sign, ",
        TEXTBOOK,
        "; ",
        Law("J_x = I_xx", "J_{x} = I_{xx}"),
        " is the moment about x, ",
        POLAR,
        " that about the point, ",
        PLANAR,
        " that about the plane across x. In SI units.",
    )
    return Step("conventions", "Conventions", (Prose(tuple(words)),))


# -------- picture ---------------------------------------------------------------------------------------------
# System, principal axes -> a picture: bodies, mass centres, principal axes, in space the ellipsoid of inertia.


def inertia_picture(
    system: System, axes: Mapping[str, Sequence[Sequence[float]]], moments: Mapping[str, Sequence[float]]
) -> Picture:
    """The bodies where they start, each with its mass centre and its principal axes.

    Args:
        axes: the principal axes in numbers, the rows of R, by the body's name.
        moments: the principal moments in their order [kg m^2], by the body's name.
    Raises:
        MissingValues: a parameter has none.
    """
    model = system.scope.model
    if model.space == "space":
        return picture_of_scene(scene_of_inertia(system, values_at_start(system), axes, moments))
    bare = Sketch(system, values_at_start(system))
    known = {body: rows for body, rows in axes.items() if body in system.motion.index}
    marks = (mark for body, rows in known.items() for mark in _axes(bare, body, np.array(rows)))
    sketch = replace(bare, more=tuple(marks))
    return Picture((8, 6), lambda figure: sketch.draw(figure.subplots()), model.name)


def values_at_start(system: System) -> dict[Node, float]:
    """Parameters, coordinates and time at the start."""
    symbols, numbers = system.scope.symbols, system.scope.model.numeric_parameters()
    state = Start.of(system).values if symbols.q else {}
    moving = {q: state[q.name] for q in symbols.q}
    return {symbols.t: 0.0} | moving | {node: numbers[name] for name, node in symbols.parameters.items()}


def _axes(sketch: Sketch, body: str, rows: np.ndarray) -> Iterator[Mark]:
    """The mass centre, and the principal axes in the plane through it."""
    center = sketch.spot(SystemInertia(sketch.system.motion).in_ground(body).com)
    pose = sketch.system.motion.link(body).pose
    turn = np.array([sketch.numbers(row[:2]) for row in pose.R[:2]])
    seen = {str(k): turn @ row[:2] for k, row in enumerate(rows, start=1)}
    half = {name: 0.45 * sketch.extent * along for name, along in seen.items() if np.linalg.norm(along) > 0.5}
    yield from axis_marks(body, center, half, 0)
    yield from center_marks([("C", center)], body)
