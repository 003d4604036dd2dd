"""Model -> Inertia: masses, mass centres, tensors, principal axes, drawn.

Model -> Inertia: masses, mass centres, tensors, principal axes of its bodies, about points and axes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np

from eomgen.documents import (
    Document,
    Law,
    Picture,
    Prose,
    Quantity,
    Result,
    Sketch,
    Statement,
    Step,
    data_step,
    document_of,
    draw_model,
    name_beside,
    picture_of_scene,
    prose,
)
from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import InertiaSum, SystemInertia
from eomgen.mechanics.start import Start
from eomgen.model import ModelOrPath, Values, model_at, nearest
from eomgen.proof import Certificate, Stated, mass_checks
from eomgen.resources import doing
from eomgen.results.mass_properties.steps import (
    LONGEST,
    InertiaEntry,
    Section,
    axis_results,
    conventions_grid,
    line,
    mass_results,
    masses_grid,
    moments_grid,
    named_results,
    polar_results,
    principal_statements,
    tensor_results,
)
from eomgen.scene import scene_of_inertia
from eomgen.study import study_of
from eomgen.symbolic.expression import Matrix, Node, State, Vector, is_zero, symbols_of
from eomgen.symbolic.print import readable_text, text_size

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
        moving = set(self.system.scope.symbols.q) & set(symbols_of((*section.point, *chain(*section.tensor))))
        if moving and self.start:
            where = ", ".join(f"{q.name} = {self.start[q]:.6g}" for q in self.system.scope.symbols.q if q in moving)
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
            whole = InertiaSum.of_bodies(self.system.motion, bodies, self.start)
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
        return self._centroidal(InertiaSum.of_body(self.system.motion, body, self.start), body, (body,))

    def _centroidal(self, sum: InertiaSum, of: str, bodies: tuple[str, ...]) -> Section:
        motion = self.system.motion
        return Section(
            sum,
            sum.com,
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
        self.stated.append(Stated(section.of, section.bodies, in_ground, section.point, values, rows, axis))

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
        section = Section(
            InertiaSum.of_bodies(self.system.motion, bodies, self.start), point, name, flat, False, (), bodies
        )
        title = f"About {name}, ground axes" + (f", and about the axis {self.axis}" if self.axis else "")
        return self._step(title, "inertia_about", section, axis)

    def _point_and_axis(self) -> tuple[Vector, str, tuple[Vector, Vector] | None]:
        """The point, its name, and the axis: a point on it, and its direction."""
        if self.axis is None or self.axis in ("x", "y", "z"):
            if self.about is None:
                raise UsageError(f"the axis {self.axis} goes through what point?", fix="write --about POINT")
            point = self._place(self.about)
            return point, self.about, None if self.axis is None else (point, Matrix.IDENTITY["xyz".index(self.axis)])
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
    return InertiaSum.of_body(system.motion, body, {}).m


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


CENTER, AXIS = "#b03a2e", "#2e7d4f"


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
    sketch = Sketch(system, values_at_start(system))

    def fill(figure: Any) -> None:
        panel = figure.subplots()
        draw_model(panel, sketch)
        for body, rows in axes.items():
            if body in system.motion.index:
                _body(panel, sketch, body, np.array(rows))

    return Picture((8, 6), fill, model.name)


def values_at_start(system: System) -> dict[Node, float]:
    """Parameters, coordinates and time at the start."""
    symbols, numbers = system.scope.symbols, system.scope.model.numeric_parameters()
    state = Start.of(system).values if symbols.q else {}
    moving = {q: state[q.name] for q in symbols.q}
    return {symbols.t: 0.0} | moving | {node: numbers[name] for name, node in symbols.parameters.items()}


def _body(panel: Any, sketch: Sketch, body: str, rows: np.ndarray) -> None:
    """The mass centre as a cross, the principal axes in the plane as dashed lines."""
    center = sketch.place(SystemInertia(sketch.system.motion).in_ground(body).com)
    pose = sketch.system.motion.link(body).pose
    turn = np.array([sketch.numbers(row[:2]) for row in pose.R[:2]])
    for number, row in enumerate(rows, start=1):
        along = turn @ row[:2]
        if np.linalg.norm(along) > 0.5:
            ends = np.array([center - 0.45 * sketch.extent * along, center + 0.45 * sketch.extent * along])
            panel.plot(*ends.T, color=AXIS, linewidth=1.0, linestyle=(0, (6, 3)), zorder=4)
            name_beside(panel, str(number), (float(ends[1, 0]), float(ends[1, 1])), AXIS)
    panel.plot(*center, marker="x", markersize=7, markeredgewidth=2, color=CENTER, zorder=7)
    name_beside(panel, "C", center, CENTER)
