"""Base class of output functions, and the quantities of a system that they may use.

A function has names, arguments, a unit, its value, and a second way to it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import StrEnum
from typing import Any, Protocol

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import Leaf
from eomgen.model.quantities import Unit
from eomgen.model.shapes import MassProperties
from eomgen.symbolic.expression import Call, Expression, Matrix, Reference, Scalar, Vector, parse

# -------- context ---------------------------------------------------------------------------------------------
# Interfaces for output functions: a system over the graph, and the same system in numbers for the second way.


GROUND = "ground"


class Reactions(Protocol):
    """The balance of every body, solved."""

    def component(self, what: str, k: int, owner: str, side: str = "", frame: str = "") -> Scalar: ...
    def normal(self, owner: str) -> Scalar: ...
    def friction(self, owner: str, along: str = "t") -> Scalar: ...
    def friction_of_joint(self, joint: str) -> Scalar: ...
    def member(self, truss: str, first: str, second: str) -> Scalar: ...
    def tension(self, owner: str, strand: int | None = None) -> Scalar: ...
    def multiplier(self, owner: str) -> Scalar: ...
    def labels(self, owner: str) -> list[str]: ...


class Section(Protocol):
    """The section forces along one body."""

    def value(self, kind: str, x: Scalar, side: str = "") -> Scalar: ...


class PartsOfMotion(Protocol):
    """The parts of the motion of a point relative to a moving body, ground axes."""

    @property
    def transport_velocity(self) -> Vector: ...
    @property
    def transport_acceleration(self) -> Vector: ...
    @property
    def coriolis(self) -> Vector: ...
    @property
    def euler(self) -> Vector: ...
    @property
    def centripetal(self) -> Vector: ...


class OutputContext(Protocol):
    """A system: its scalars are functions of q, u, a, t, lam and the parameters; vectors are in ground axes.

    Velocities come from places by `rate`, accelerations from velocities by `acceleration`; `placed` puts in the state,
    where one is given, `here` makes that readable too. What follows are laws that others need too, and that therefore
    stand in mechanics.
    """

    @property
    def is_plane(self) -> bool: ...
    @property
    def bodies(self) -> tuple[str, ...]: ...
    @property
    def names(self) -> Mapping[str, Scalar]: ...
    def position(self, point: str) -> Vector: ...
    def body_of(self, point: str) -> str: ...
    def origin(self, body: str) -> Vector: ...
    def axes(self, body: str) -> Matrix: ...
    def angle(self, body: str) -> Scalar: ...
    def spin(self, body: str) -> Vector: ...
    def rate(self, place: Vector) -> Vector: ...
    def acceleration(self, velocity: Vector) -> Vector: ...
    def placed(self, *vectors: Vector) -> tuple[Vector, ...]: ...
    def here(self, *vectors: Vector) -> tuple[Vector, ...]: ...

    def parts_of_motion(self, point: str, body: str) -> PartsOfMotion: ...
    def rotation_center(self, body: str, other: str) -> Vector: ...
    def acceleration_pole(self, body: str) -> Vector: ...
    def least_speed(self, body: str, start: Vector, end: Vector) -> Scalar: ...

    def mass(self, body: str) -> MassProperties: ...
    def mass_of_part(self, body: str, number: int) -> Scalar: ...
    def parts(self, body: str) -> int | None: ...
    def without_inertia(self, bodies: Sequence[str]) -> tuple[str, ...]: ...
    def known_about_z(self, bodies: Sequence[str]) -> tuple[str, ...]: ...
    def tensor(self, point: Vector, bodies: Sequence[str]) -> Matrix: ...
    def principal_moments(self, tensor: Matrix) -> tuple[Scalar, ...]: ...
    def angular_momentum(self, point: Vector, bodies: Sequence[str]) -> Vector: ...
    def kinetic_energy(self, body: str | None = None) -> Scalar: ...
    def potential_energy(self, name: str | None = None) -> Scalar: ...
    def power(self, name: str | None = None) -> Scalar: ...
    def effort(self, force: str) -> Scalar: ...
    def generalized_force(self, coordinate: str) -> Scalar: ...
    def momentum(self, coordinate: str) -> Scalar: ...

    @property
    def reactions(self) -> Reactions: ...
    def is_truss(self, name: str) -> bool: ...
    def multiplier(self, constraint: str) -> Scalar: ...
    def drive(self, coordinate: str) -> Scalar: ...
    def impulse(self, owner: str, along: int | None = None) -> Scalar: ...
    def section(self, body: str) -> Section: ...


class Trial(Protocol):
    """The system at a state, in numbers of 50 digits, for the second way to an output's value.

    It uses poses and masses; their rates come from central differences along the motionalone.
    """

    @property
    def scene(self) -> OutputContext: ...
    @property
    def step(self) -> Any:
        """Time step of the differences [s]."""

    def along(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """Values of functions of q and t, and their first and second rates."""

    def around(self, place: Vector) -> tuple[Vector, Vector, Vector]:
        """A place a moment before, now, and a moment later."""

    def particles(self, body: str, *, still: bool = False) -> list[tuple[Any, Vector, Vector]]:
        """(m, r, v) of particles that have together the body's mass, mass centre and inertia, v by differences.

        Args:
            still: rotors in its joint do not count.
        Raises:
            NoValue: they count, and there are some.
        """

    def given_energy(self) -> Any:
        """The kinetic energies that the model gives by expressions, the rates in them by differences."""

    def worked(self, body: str | None = None) -> Any:
        """Power of everything applied, or of what is applied to one body: forces and couples on differences of poses.

        Raises:
            NoValue: something has no point of application.
        """

    def acting(self, force: str) -> Any:
        """k (l - l_0) + c l' + f(l, l') of what is declared between two points, the same of an angle between bodies."""

    def demanded(self, coordinate: str) -> Any:
        """Force along a driven coordinate that the motion requires, by Newton and Euler for each free body.

        Raises:
            NoValue: a constraint drives it; there is friction.
        """

    def held(self, constraint: str) -> Any:
        """The multiplier of a constraint of one row with which all constraints hold the free bodies, each by Newton
        and Euler.

        Raises:
            NoValue: it shares its force with others; there is friction.
        """

    def struck(self, owner: str, axis: int | None = None) -> Any:
        """Impulse of a contact that closes, along an axis of a joint, by the energy of the bodies and the rates of
        gaps at several speeds.

        Raises:
            NoValue: a row in it has no gap.
        """

    def faster(self, speed: str, by: float) -> Trial:
        """The same with one speed larger.

        Raises:
            NoValue: it is no speed of the system.
        """

    def root(self, x: Any) -> Any:
        """Square root of a number."""

    def eigenvalues(self, rows: Sequence[Sequence[Any]]) -> list[Any]:
        """Eigenvalues of a symmetric matrix, ascending."""


# -------- base ------------------------------------------------------------------------------------------------


AXES = {"x": 0, "y": 1, "z": 2}
SIDES = ("before", "after")
DRY_JOINT = "joint with friction"  # kind of an argument


class OutputSource(StrEnum):
    """Source of an output function: what it needs beside the motion."""

    STATE = ""
    BALANCE = "balance of the bodies"
    MASSES = "distribution of mass"
    SMALL_MOTIONS = "small motions"
    OF_A_RUN = "a run"


ValueOf = Callable[[OutputContext, Call], Scalar]
SecondOf = Callable[[Trial, Call], Any]


def _none(catalog: Catalog, leaf: Leaf, call: Call) -> Iterator[Diagnostic]:
    return iter(())


@dataclass(frozen=True, kw_only=True)
class OutputFunction:
    """One function of the motion, or the components of one vector.

    Args:
        names: as a file calls it.
        kinds: of its arguments, of which `least` are needed; `more` is the kind of any number of further ones.
        unit: SI.
        per: the arguments by whose unit it is divided: a coordinate's, the rate's of a "coordinate or speed", the
            gap's of a constraint.
        like: the argument whose unit it has.
        gives: what, in docs/reference/outputs.md.
        value: in q, u, a, lam, t and the parameters.
        second: its value in numbers, by a way that shares only poses and masses with `value`; None: there is none here,
            and `source` says what proves it.
        source: the data that it is found from.
        moves: True if velocities or accelerations stand in it.
        shown: its arguments as docs/reference/outputs.md writes them, where the kinds do not say it.
        diagnostics: what else is wrong with a call of it.
    """

    names: tuple[str, ...]
    kinds: tuple[str, ...]
    least: int
    more: str = ""
    unit: str
    per: tuple[int, ...] = ()
    like: int | None = None
    gives: str
    value: ValueOf
    second: SecondOf | None = None
    source: OutputSource = OutputSource.STATE
    moves: bool = False
    shown: str = ""
    diagnostics: Callable[[Catalog, Leaf, Call], Iterator[Diagnostic]] = _none

    @property
    def arguments(self) -> str:
        """(point[, body[, body]])"""
        if self.shown:
            return self.shown
        optional = [*self.kinds[self.least :], *([f"{self.more}, ..."] if self.more else [])]
        text = ", ".join(self.kinds[: self.least])
        for kind in optional:
            text += f"[, {kind}" if text else f"[{kind}"
        return f"({text}{']' * len(optional)})"

    @property
    def is_along_degrees_of_freedom(self) -> bool:
        """True if it depends on which coordinates are free: dT/dq' changes where fewer are."""
        return any(kind.startswith("coordinate") for kind in self.kinds)

    @property
    def in_unit(self) -> str:
        """The unit of its value in words: J per coordinate."""
        if self.per:
            return f"{self.unit} per {' and '.join(self.kinds[k] for k in self.per)}"
        return "of the formula" if self.like is not None else self.unit

    @property
    def row(self) -> str:
        """Its line in the table of docs/reference/outputs.md."""
        return f"| `{' '.join(self.names)}` {self.arguments} | {self.gives} | {self.in_unit} |"

    @property
    def dimension(self) -> Unit:
        """Dimension of its unit; of what is `per` an argument without that argument's share."""
        return Unit.parse(self.unit)


def along(*names: str) -> tuple[str, ...]:
    """The names, each with x, y and z in place of its star."""
    return tuple(name.replace("*", axis) for name in names for axis in AXES)


def component(call: Call) -> int:
    """Component in which a name ends: 0 of vx, 2 of omega_z."""
    return AXES[call.name[-1]]


def formula_at(call: Call, k: int) -> Expression:
    """The argument k of a call, a formula; a lone name or member reads like a reference."""
    argument = call.args[k]
    return parse(argument.name, references=True) if isinstance(argument, Reference) else argument


def number_at(call: Call, k: int, most: int) -> int:
    """The argument k of a call, a whole number from 1 on.

    Raises:
        DerivationError: it is none.
    """
    argument = call.args[k]
    number = argument.literal if isinstance(argument, Expression) else None
    if not isinstance(number, int) or not 1 <= number <= most:
        raise DerivationError(
            f"'{call}': a number from 1 to {most} is needed, not '{argument}'", fix="give a whole number"
        )
    return number
