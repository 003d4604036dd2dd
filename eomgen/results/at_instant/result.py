"""Model -> Kinematics: the motion at one instant: step by step, as JSON entries, drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import (
    Cell,
    Document,
    Law,
    PagePoint,
    Picture,
    Piece,
    Prose,
    Quantity,
    Result,
    Sketch,
    Step,
    data_step,
    document_of,
)
from eomgen.errors import MissingValues, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import BodyMotion, Centrodes, Kinds, KinematicState, Mechanism
from eomgen.model import ModelOrPath, Values, WrittenEquation, model_at
from eomgen.proof import Certificate, certify, instant_checks
from eomgen.resources import doing
from eomgen.results.at_instant.steps import (
    cell,
    field_payload,
    field_steps,
    in_numbers,
    kinds_step,
    mechanism_steps,
    particles_of,
    relative_payload,
    relative_steps,
)
from eomgen.scene import DrawnArrow, arrow_marks, center_marks
from eomgen.study import CentrodeCurves, kinematic_state
from eomgen.symbolic.expression import Node, Scalar, Vector, substituted, symbols_of
from eomgen.symbolic.print import readable_text, text_size

LINE = 80  # characters of a formula among the fields


@dataclass(frozen=True)
class Kinematics(Result):
    """Velocities, accelerations and centres of rotation at one instant.

    Args:
        state: the motion.
        kinds: of the motions of which it is an instant; None where only the instant is known.
        relative: (point, body) that are requested besides: the point as it is seen from the body.
    """

    state: KinematicState
    kinds: Kinds | None = None
    relative: tuple[tuple[str, str], ...] = ()

    def __repr__(self) -> str:
        return f"<kinematics of {self.state.system.scope.model.name!r} at one instant: {', '.join(self.state.fields)}>"

    @property
    def failed(self) -> str:
        """The centres that a drawing finds elsewhere than the velocities; "" as it must be."""
        wrong = self.state.disagreement
        return f"the centres by drawing and by velocities do not agree: {wrong}" if wrong else ""

    def certify(self) -> Certificate:
        """Check the equations of motion where the motion follows them, and all velocities by differences of places."""
        state = self.state
        base = Certificate(()) if state.equations is None else certify(state.equations)
        bodies = (
            BodyMotion.all_of(state.system, state.state, self.kinds) if state.accelerated and state.is_short else ()
        )
        return base + instant_checks(state, bodies, self.relative)

    @cached_property
    def derivation(self) -> Document:
        """Step by step."""
        model, system = self.state.system.scope.model, self.state.system
        data = (data_step(system),) if system.symbols.parameters else ()
        kinds = self._kinds() if self.state.fields else ()
        more = (*kinds, *self._seen())
        more = more if self.state.exact else tuple(in_numbers(self.state, step) for step in more)
        steps = (*data, *mechanism_steps(self.state), *more)
        return document_of(model, "kinematics", steps)

    def _kinds(self) -> tuple[Step, ...]:
        """Kinds of motion; spins, poles and centrodes where the accelerations are known exactly."""
        system, state = self.state.system, self.state.state
        if self.state.accelerated and self.state.is_short:
            kinds, *fields = field_steps(system, state, self.kinds, self._shown)
            return (self._within_lines(kinds), *fields)
        motions = BodyMotion.all_of(system, self.state.moving, self.kinds)
        return (self._within_lines(kinds_step(motions, particles_of(system))),)

    def _within_lines(self, step: Step) -> Step:
        """The sentences with numbers in place of formulas that are longer than a line."""
        statements = tuple(
            Prose(tuple(self._within_line(piece) for piece in each.pieces)) if isinstance(each, Prose) else each
            for each in step.statements
        )
        return replace(step, statements=statements)

    def _within_line(self, piece: Piece) -> Piece:
        if not isinstance(piece, Node) or text_size(piece) <= LINE:
            return piece
        number = self.state.number(piece)
        return "..." if number is None else f"{number:.6g}"

    def _shown(self, x: Scalar) -> Cell:
        """A value of the fields: a number where its formula is longer than a line."""
        written = x if text_size(x) <= LINE else cell(self.state, x)
        return Law(written, written) if isinstance(written, str) else written

    def _seen(self) -> tuple[Step, ...]:
        return tuple(
            step
            for point, body in self.relative
            for step in relative_steps(self.state.system, point, body, self.state.state)
        )

    @property
    def picture(self) -> Picture:
        """The mechanism with its centres and velocities.

        Raises:
            RunFailed: it is in space.
            MissingValues: parameters without a value.
        """
        return mechanism_picture(self.state, () if self.kinds is None else self.kinds.centrodes())

    # -- for machines --------------------------------------------------------------------------------

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        state = self.state
        mechanism = state.mechanism
        return {
            "name": state.system.scope.model.name,
            "when": state.when,
            "freedoms": {
                "by_rank": state.degrees_of_freedom,
                "by_formula": state.formula[0],
                "formula": state.formula[1],
            },
            "given": list(state.given),
            "rate": None if state.symbol is None else {"symbol": state.symbol.name, "of": state.rate},
            "exact": state.exact,
            "blocks": {} if mechanism is None else {name: list(bodies) for name, bodies in mechanism.blocks.items()},
            "centers": [] if mechanism is None else list(self._centers(mechanism)),
            "angular_velocities": {name: self._turn(field.w) for name, field in state.turning.items()},
            "velocities": {names: self._vector(v) for names, _, v, _ in state.points},
            **self._accelerations(),
            "bodies": field_payload(state.system, state.state, self.kinds) if self._has_bodies else {},
            "relative": [relative_payload(state.system, p, b, state.state) for p, b in self.relative],
        }

    @property
    def _has_bodies(self) -> bool:
        return bool(self.state.accelerated) and self.state.is_short

    def _accelerations(self) -> Mapping[str, Any]:
        if not self.state.accelerated:
            return {"angular_accelerations": None, "accelerations": None}
        exact = not self.state.rounded
        return {
            "angular_accelerations": {name: self._turn(field.e, exact) for name, field in self.state.turning.items()},
            "accelerations": {names: self._vector(a, exact) for names, _, _, a in self.state.points if a is not None},
        }

    def _centers(self, mechanism: Mechanism) -> Iterator[dict[str, Any]]:
        for center in mechanism.centers.values():
            x, y, _ = center.point
            place = [self._value(x), self._value(y)]
            found = self.state.found.get(center.pair)
            yield {
                "bodies": list(center.pair),
                "kind": "infinite" if center.at_infinity else "finite",
                "place": None if center.at_infinity else place,
                "direction": place if center.at_infinity else None,
                "found": None if found is None else found.in_words(self.state.system.scope.model.constraints),
            }

    def _turn(self, w: Vector, exact: bool = True) -> Any:
        return self._value(w[2], exact) if self.state.plane else self._vector(w, exact)

    def _vector(self, v: Vector, exact: bool = True) -> dict[str, Any]:
        axes = "xy" if self.state.plane else "xyz"
        parts = {axis: self._value(x, exact) for axis, x in zip(axes, v, strict=False)}
        return {**parts, "magnitude": self._value(self.state.size(v), exact)}

    def _value(self, x: Scalar, exact: bool = True) -> Quantity:
        shown = self.state.put((x, 0, 0))[0]
        written = readable_text(shown) if exact and self.state.exact else None
        return Quantity(written, self.state.number(shown), unit=None)


@doing("the velocities")
def kinematics(
    model: ModelOrPath,
    at: WrittenEquation | str | None = None,
    *,
    given: Sequence[WrittenEquation | str] = (),
    relative: Sequence[tuple[str, str]] = (),
    parameters: Values | None = None,
    start: Values | None = None,
) -> Kinematics:
    """Velocities, accelerations, centres of rotation and kinds of motion at one instant.

    Args:
        at: the instant: an equation that is first met then; None: the start, or the one configuration.
        given: velocities in addition to those of the model: "omega(crank) = 2".
        relative: (point, body) pairs: the motion of the point relative to the body.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        ExpressionError: a text is no equation.
        ModelError: an equation contains unknown names.
        DerivationError: nothing can move; too few or too many velocities are given.
    """
    model = model_at(model, parameters, start)
    state = kinematic_state(model, at, given)
    moves = model.given is None and not given and bool(model.coordinates)
    kinds = Kinds(state.system, {} if state.symbol is not None else state.moving) if moves else None
    return Kinematics(state, kinds, tuple(relative))


# -------- the mechanism, drawn --------------------------------------------------------------------------------


# -------- centrode plot ---------------------------------------------------------------------------------------
# Centrodes, an instant -> a panel: the curve in the ground, and the body's own that rolls on it, as it lies then.


FAR = 8.0  # sizes of the mechanism beyond which a centre is not drawn
FIXED_CURVE, MOVING = "#2f5d8a", "#b03a2e"


def centrode_panel(panel: Any, curves: CentrodeCurves) -> None:
    """Draw both centrodes of a body on matplotlib axes."""
    fixed, moving = (_cut(places, curves.size) for places in (curves.fixed, curves.moving))
    panel.plot(*fixed.T, color=FIXED_CURVE, linewidth=1.6, label="fixed centrode")
    panel.plot(*moving.T, color=MOVING, linewidth=1.3, linestyle="--", label="moving centrode")
    if np.all(np.isfinite(curves.now)):
        panel.plot(*curves.now, "o", color="black", markersize=4)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_title(f"centrodes of {curves.body}".replace("$", r"\$"), fontsize=10)
    panel.legend(fontsize=8)


def _cut(places: np.ndarray, size: float) -> np.ndarray:
    """Places of a line with nan for those too far away, so that the line breaks there."""
    near = places[np.isfinite(places).all(axis=1)]
    middle = np.median(near, axis=0) if len(near) else np.zeros(2)
    far = ~np.isfinite(places).all(axis=1) | (np.abs(places - middle).max(axis=1) > FAR * size)
    return np.where(far[:, None], np.nan, places)


# -------- mechanism plot --------------------------------------------------------------------------------------
# KinematicState -> a picture: the mechanism with velocities and centres of rotation, and the diagrams of projections.
#
# In a plane motion v_x of the points of a body changes along y alone, v_y along x alone:
#
#     v_x = - w (y - y_c),   v_y = w (x - x_c)
#
# so that over the lines on which the mechanism is projected each body has a straight piece, which is zero at its
# centre.


SIZE, BELOW = (11.0, 8.0), 4.5  # of the mechanism, and the height of a row of centrodes below it [inches]
MOST_CENTRODES = 6
COLORS = ("#2f5d8a", "#b03a2e", "#2e7d4f", "#8e5ea2", "#c77c11", "#3b8ea5", "#7a5c3e", "#5a5a5a")
FAR_OUT = 1.6  # how far outside the mechanism a centre is still drawn, of its extent


def mechanism_picture(state: KinematicState, centrodes: Sequence[Centrodes] = ()) -> Picture:
    """A plane mechanism; a rate that was left as a symbol is 1 there.

    Args:
        centrodes: drawn below it, a panel each.
    Raises:
        RunFailed: it is in space.
        MissingValues: parameters without a value.
    """
    if state.mechanism is None:
        raise RunFailed("only plane mechanisms are drawn", fix="ask for the pages of a run: eomgen animate, or play")
    shown = tuple(centrodes[:MOST_CENTRODES])
    size = (SIZE[0], SIZE[1] + BELOW * ((len(shown) + 1) // 2))
    return Picture(size, _Panels(state, state.mechanism, shown).fill, state.system.scope.model.name)


class _Panels:
    """The numbers of a picture, and its panels."""

    def __init__(self, state: KinematicState, mechanism: Mechanism, centrodes: Sequence[Centrodes]) -> None:
        self.state, self.mechanism, self.centrodes = state, mechanism, centrodes
        self.one: Mapping[Node, Scalar] = {} if state.symbol is None else {state.symbol: 1}
        symbols = state.system.symbols
        places = {node: self.number(state.moving.get(node, 0)) for node in (*symbols.q, symbols.t)}
        known = {node: self.number(node) for node in symbols.parameters.values()}
        self.points = [(names, self.numbers(r), self.numbers(v)) for names, r, v, _ in state.points]
        colors = {body: color for color, _, bodies in self._blocks() for body in bodies}
        bare = Sketch(state.system, {**places, **known}, colors=colors)
        near, self.far = self._centers(bare.extent)
        velocities = (DrawnArrow(names, at, v, "velocity", outward=True, unit="m/s") for names, at, v in self.points)
        self.sketch = replace(bare, more=(*arrow_marks(velocities), *center_marks(near.items())))

    def number(self, x: Scalar) -> float:
        """A scalar as a number, the rate that was left open being 1."""
        found = self.state.number(substituted((x,), self.one)[0])
        if found is None:
            parameters = self.state.system.symbols.parameters
            known = self.state.number
            raise MissingValues(tuple(n for n, p in parameters.items() if p in symbols_of((x,)) and known(p) is None))
        return found

    def numbers(self, v: Sequence[Scalar]) -> PagePoint:
        return self.number(v[0]), self.number(v[1])

    # -- panels --------------------------------------------------------------------------------------

    def fill(self, figure: Any) -> None:
        rooms, ratios = [["mechanism", "x"], ["y", "words"]], (2.2, 1)
        if self.centrodes:
            figure, below = figure.subfigures(2, 1, height_ratios=(SIZE[1], BELOW * ((len(self.centrodes) + 1) // 2)))
            self._centrodes(below)
        panels = figure.subplot_mosaic(rooms, width_ratios=ratios, height_ratios=ratios)
        main = panels["mechanism"]
        self.sketch.draw(main)
        main.set_adjustable("datalim")  # the projections stand exactly below it and to its side
        figure.canvas.draw()
        self._along_x(panels["y"], main.get_xlim())
        self._along_y(panels["x"], main.get_ylim())
        self._words(panels["words"])

    def _centrodes(self, figure: Any) -> None:
        """The curves of the centres of rotation, two in a row."""
        system, symbols = self.state.system, self.state.system.symbols
        speeds = {node: self.number(self.state.moving.get(node, 0)) for node in symbols.u}
        panels = list(figure.subplots((len(self.centrodes) + 1) // 2, 2, squeeze=False).flat)
        for panel, centrodes in zip(panels, self.centrodes, strict=False):
            centrode_panel(panel, CentrodeCurves.of(system, centrodes, {**self.sketch.values, **speeds}))
        for panel in panels[len(self.centrodes) :]:
            panel.axis("off")

    def _centers(self, extent: float) -> tuple[dict[str, PagePoint], list[str]]:
        """(the places of centres in sight by their names together, words on the others)"""
        places: dict[PagePoint, list[str]] = {}
        far = []
        for center in self.mechanism.centers.values():
            x, y = self.numbers(center.point)
            if center.at_infinity:
                far.append(f"{center.name}: at infinity along ({x:.4g}, {y:.4g})")
            elif self._is_far((x, y), extent):
                far.append(f"{center.name}: ({x:.4g}, {y:.4g})")
            else:
                places.setdefault((round(x, 9), round(y, 9)), []).append(center.name)
        return {" ".join(names): place for place, names in places.items()}, far

    def _is_far(self, place: PagePoint, extent: float) -> bool:
        """True if a place is well outside the mechanism."""
        corners = np.array([at for _, at, _ in self.points])
        low, high = corners.min(axis=0), corners.max(axis=0)
        reach = FAR_OUT * extent
        return bool(np.any(np.array(place) < low - reach) or np.any(np.array(place) > high + reach))

    def _along_x(self, panel: Any, limits: tuple[float, float]) -> None:
        """v_y of every body over x; thin to where it is zero."""
        for color, (start, end), slope, offset in self._pieces(axis=0):
            for ends, style in ((_to_zero(start, end, slope, offset, limits), ":"), ((start, end), "-")):
                _line(panel, ends, [slope * x + offset for x in ends], color, style)
        panel.axhline(0, color="#505050", linewidth=0.8)
        panel.set(xlim=limits, xlabel="x [m]", ylabel="$v_y$ [m/s]")

    def _along_y(self, panel: Any, limits: tuple[float, float]) -> None:
        """v_x of every body over y, y upwards; thin to where it is zero."""
        for color, (start, end), slope, offset in self._pieces(axis=1):
            for ends, style in ((_to_zero(start, end, slope, offset, limits), ":"), ((start, end), "-")):
                _line(panel, [slope * y + offset for y in ends], ends, color, style)
        panel.axvline(0, color="#505050", linewidth=0.8)
        panel.set(ylim=limits, ylabel="y [m]", xlabel="$v_x$ [m/s]")

    def _pieces(self, axis: int) -> list[tuple[str, PagePoint, float, float]]:
        """(colour, extent along the axis, slope, value at 0) of the velocity across the axis, of every moving block."""
        found = []
        for color, block, bodies in self._blocks():
            places = [
                at[axis]
                for names, at, _ in self.points
                if any(each.partition(".")[0] in bodies for each in names.split(", "))
            ]
            c = self.mechanism.fields[block]
            w = self.number(c[2])
            line = (-w, self.number(c[1])) if axis else (w, -self.number(c[0]))
            found.append((color, (min(places), max(places)), *line))
        return found

    def _blocks(self) -> list[tuple[str, str, tuple[str, ...]]]:
        """(colour, name, bodies) of the moving blocks."""
        moved = [(name, bodies) for name, bodies in self.mechanism.blocks.items() if name != Mechanism.FIXED]
        return [(COLORS[k % len(COLORS)], name, bodies) for k, (name, bodies) in enumerate(moved)]

    def _words(self, panel: Any) -> None:
        """The legend, centres out of sight, the unit rate."""
        panel.axis("off")
        for color, name, _ in self._blocks():
            panel.plot([], [], color=color, linewidth=2, label=name.replace("$", r"\$"))
        if self.mechanism.moved:
            panel.legend(loc="upper left", ncols=2, fontsize=9)
        rate = [] if self.state.symbol is None else [f"for {self.state.rate} = 1"]
        lines = [*rate, *(["centres out of sight:", *self.far] if self.far else [])]
        panel.text(0.02, 0.05, "\n".join(lines).replace("$", r"\$"), fontsize=8, va="bottom", transform=panel.transAxes)


def _line(panel: Any, x: Sequence[float], y: Sequence[float], color: str, style: str) -> None:
    """The velocities of a body; of one that is a point in this direction, a dot."""
    dot = "o" if style == "-" and x[0] == x[1] and y[0] == y[1] else ""
    panel.plot(x, y, color=color, linestyle=style, linewidth=1.8, marker=dot, markersize=6)


def _to_zero(start: float, end: float, slope: float, offset: float, limits: tuple[float, float]) -> tuple[float, ...]:
    """Line from a piece to its zero, where that lies within the limits; () where it does not."""
    zero = -offset / slope if slope else float("inf")
    if not limits[0] <= zero <= limits[1] or start <= zero <= end:
        return ()
    return (zero, start if zero < start else end)
