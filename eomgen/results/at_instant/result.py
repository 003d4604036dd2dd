"""Model -> Kinematics: the motion at one instant: step by step, as JSON entries, drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.documents import Cell, Document, Law, Picture, Piece, Prose, Quantity, Result, Step, data_step, document_of
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import Kinds, KinematicState, RotationCenter, body_motions
from eomgen.model import ModelOrPath, Values, WrittenEquation, model_at
from eomgen.proof import Certificate, certify, instant_checks
from eomgen.resources import doing
from eomgen.results.at_instant.steps import (
    cell,
    field_payload,
    field_steps,
    how_found,
    in_numbers,
    kinds_step,
    mechanism_steps,
    particles_of,
    relative_payload,
    relative_steps,
)
from eomgen.study import kinematic_state
from eomgen.symbolic.expression import Node, Scalar, Vector
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
        bodies = body_motions(state.system, state.state, self.kinds) if state.accelerated and state.is_short else ()
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
        motions = body_motions(system, self.state.moving, self.kinds)
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
        from eomgen.results.at_instant.plots import mechanism_picture

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
            "centers": [] if mechanism is None else [self._center(c) for c in mechanism.centers.values()],
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

    def _center(self, center: RotationCenter) -> dict[str, Any]:
        x, y, _ = center.point
        place = [self._value(x), self._value(y)]
        found = self.state.found.get(center.pair)
        return {
            "bodies": list(center.pair),
            "kind": "infinite" if center.at_infinity else "finite",
            "place": None if center.at_infinity else place,
            "direction": place if center.at_infinity else None,
            "found": None if found is None else how_found(self.state, found),
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
