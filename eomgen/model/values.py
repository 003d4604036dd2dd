"""Model -> numbers: the values of its parameters and the start values of its coordinates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from eomgen.errors import ExpressionError, MissingValues, ModelError
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import nearest
from eomgen.model.fields import Table
from eomgen.model.parts import Body, Coordinate, Parameter, Speed, StateVariable
from eomgen.symbolic.expression import Expression, Fraction, Graph, as_expression


class Numbers:
    """Values of the parameters and of the start that a model declares: a base of `Model`."""

    parameters: Table[Parameter]
    coordinates: Table[Coordinate]
    speeds: Table[Speed]
    states: Table[StateVariable]
    bodies: Table[Body]

    def exact_parameters(self, overrides: Mapping[str, Any] | None = None) -> dict[str, AnyNumber]:
        """The parameters that have values: exact where they can be, a float where pi or a root comes in.

        Raises:
            ModelError: an expression without a value (1/0), an override that names no parameter or is no number.
        """
        given = {name: part.value for name, part in self.parameters.items() if part is not None}
        given |= self._overridden(overrides or {})
        plain = {name: x.literal for name, x in given.items() if x is not None}
        values: dict[str, AnyNumber] = {"pi": math.pi, **{name: x for name, x in plain.items() if x is not None}}
        others = {name: x for name, x in given.items() if x is not None and name not in values}
        for name in in_order(others)[0]:
            if others[name].names <= values.keys():
                values[name] = _value(others[name], values, f"parameters.{name}")
        del values["pi"]
        return values

    def constant_parameters(self, graph: Graph) -> dict[str, Any]:
        """The parameters that have values, each as an exact constant: 1/3, pi/6, sqrt(2); nothing is rounded.

        Raises:
            ModelError: as of `exact_parameters`.
        """
        values = self.exact_parameters()
        found: dict[str, Any] = {}
        for name, value in values.items():  # those that another needs come before it
            part = self.parameters[name]
            formula = None if part is None or not isinstance(value, float) else part.value
            found[name] = value if formula is None else formula.evaluate({**found, "pi": graph.pi})
        return found

    def numeric_parameters(
        self, overrides: Mapping[str, Any] | None = None, *, needed: Iterable[str] | None = None
    ) -> dict[str, float]:
        """The value of each parameter, in the model's order, as floats.

        Args:
            overrides: values in place of the model's own: numbers or expressions.
            needed: the parameters that must have one (None: all).
        Raises:
            MissingValues: some have none; names them all.
            ModelError: as of `exact_parameters`.
        """
        values = self.exact_parameters(overrides)
        wanted = set(self.parameters) if needed is None else set(needed)
        missing = tuple(name for name in self.parameters if name in wanted and name not in values)
        if missing:
            raise MissingValues(missing)
        return {name: float(values[name]) for name in self.parameters if name in values}

    def start_values(self, parameters: Mapping[str, Any] | None = None) -> tuple[dict[str, float], dict[str, float]]:
        """Coordinates, rates, declared speeds and states at the start; what is not given is 0.

        A dependent coordinate without `start` begins at `near`. A driven one begins where its law says: f(0) for
        `motion`, f(0) as rate for `rate`.

        Args:
            parameters: values in place of the model's own (None: those).
        Returns:
            {"theta": value} of the coordinates; {"theta'": rate, "w1": value, "i": value} of their rates, the declared
            speeds and the states of first order.
        Raises:
            MissingValues: a start needs parameters without values.
        """
        lookup = {**self.exact_parameters(parameters), "t": 0, "pi": math.pi}
        q: dict[str, float] = {}
        u: dict[str, float] = {}
        for name, part in self.coordinates.items():
            where = f"coordinates.{name}"
            at = part.motion if part.motion is not None else part.start if part.start is not None else part.near
            q[name] = _float(at, lookup, where)
            rate = part.rate if part.rate is not None else part.speed
            u[name + "'"] = _float(rate, lookup, where) if part.motion is None else _slope(part.motion, lookup, where)
        for name, speed in self.speeds.items():
            u[name] = _float(speed.start, lookup, f"speeds.{name}")
        u |= {name: _float(state.start, lookup, f"states.{name}") for name, state in self.states.items()}
        for each in self.quaternions:
            q |= dict(zip(each.coordinates, _normed([q[name] for name in each.coordinates], each), strict=True))
        return q, u

    def first_guesses(self, parameters: Mapping[str, Any] | None = None) -> dict[str, float]:
        """Start of the search for each dependent coordinate that gives one by `near`.

        Raises:
            MissingValues: a guess needs parameters without values.
        """
        guessed = {
            name: part.near for name, part in self.coordinates.items() if part.dependent and part.near is not None
        }
        lookup = {**self.exact_parameters(parameters), "pi": math.pi} if guessed else {}
        return {name: _float(near, lookup, f"coordinates.{name}.near") for name, near in guessed.items()}

    @property
    def quaternions(self) -> tuple[Quaternion, ...]:
        """The quaternions of the joints that have one, in the model's order."""
        joints = ((name, body.joint) for name, body in self.bodies.items() if body.joint is not None)
        return tuple(
            Quaternion(name, tuple(e.text for e in joint.turns()), joint.spins) for name, joint in joints if joint.spins
        )

    def _overridden(self, overrides: Mapping[str, Any]) -> dict[str, Expression]:
        read = {}
        for name, value in overrides.items():
            if name not in self.parameters:
                raise ModelError(f"there is no parameter '{name}'", "parameters", nearest(name, self.parameters))
            try:
                read[name] = as_expression(value.item() if hasattr(value, "item") else value)
            except ExpressionError as error:
                raise ModelError(error.what, f"parameters.{name}", error.fix) from error
        return read


def _normed(e: list[float], quaternion: Quaternion) -> list[float]:
    """A quaternion over its norm.

    Raises:
        ModelError: it is 0.
    """
    norm = math.hypot(*e)  # squares of large ones are beyond doubles
    if norm == 0:
        raise quaternion.no_orientation()
    return [x / norm for x in e]


def _value(expression: Expression, values: Mapping[str, Any], where: str) -> AnyNumber:
    try:
        found: AnyNumber = expression.evaluate(values)
        return found
    except ExpressionError as error:
        raise ModelError(f"'{expression.text}': {error.what}", where, error.fix) from error


def _float(expression: Expression | None, values: Mapping[str, Any], where: str) -> float:
    if expression is None:
        return 0.0
    missing = tuple(sorted(expression.names - values.keys()))
    if missing:
        raise MissingValues(missing, where)
    return float(_value(expression, values, where))


def _slope(motion: Expression, values: Mapping[str, Any], where: str) -> float:
    """f'(0) of a given motion, by the exact derivative."""
    from eomgen.symbolic.expression import derivative
    from eomgen.symbolic.numeric import FLOAT, evaluate

    _float(motion, values, where)
    graph = Graph()
    symbols = {name: graph.symbol(name) for name in motion.names if name != "pi"}
    rate = derivative(motion.evaluate({**symbols, "pi": graph.pi}), graph.symbol("t"))
    numbers = {node: float(values[name]) for name, node in symbols.items()}
    return float(evaluate((rate,), numbers, FLOAT)[0])


# -------- quaternions -----------------------------------------------------------------------------------------
# Model -> its unit quaternions: the four coordinates and the three speeds of each.


@dataclass(frozen=True)
class Quaternion:
    """Orientation of one body relative to its parent by a unit quaternion.

    Args:
        body: its name.
        coordinates: e0, e1, e2, e3.
        speeds: its angular velocity against the parent, its own axes.
    """

    body: str
    coordinates: tuple[str, ...]
    speeds: tuple[str, ...]

    def no_orientation(self) -> ModelError:
        """The error of a quaternion that is 0 at the start."""
        return ModelError(
            f"the quaternion of body '{self.body}' starts at 0",
            f"bodies.{self.body}.joint.quaternion",
            "start = 1 of its first coordinate: no turn",
        )


# -------- arithmetic -------------------------------------------------------------------------------------------
# Expressions of parameters -> numbers: the order in which parameters follow from one another, and their values.

AnyNumber = int | Fraction | float


def in_order(parameters: Mapping[str, Expression | None]) -> tuple[list[str], list[list[str]]]:
    """The parameters, each after those in its expression; and the rings of those that need one another."""
    ordered: dict[str, None] = {}
    rings: list[list[str]] = []
    for first in parameters:
        trail = {} if first in ordered else {first: _needed(parameters, first)}
        while trail:
            name, needed = next(reversed(trail.items()))
            other = next((n for n in needed if n not in ordered), None)
            if other is None:
                ordered[name] = None
                del trail[name]
            elif other in trail:
                names = list(trail)
                rings.append(names[names.index(other) :])
                ordered |= dict.fromkeys(names)
                break
            else:
                trail[other] = _needed(parameters, other)
    return list(ordered), rings


def _needed(parameters: Mapping[str, Expression | None], name: str) -> Iterator[str]:
    value = parameters[name]
    return iter(sorted(value.names & parameters.keys())) if value is not None else iter(())
