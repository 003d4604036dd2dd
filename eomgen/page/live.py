"""Phase, Scene -> Live: a model that a page can move by itself: its programs, and the places of their numbers.

begin(p)        parameters that follow from others, start and first guess of each coordinate, start of each speed
start, constraints     phi, J u + sigma and their slopes, of the system as it is declared and as it is integrated
inertia         M of the declared system, by which start speeds are brought onto the constraints
turned(x)       the rates of the coordinates by the declared speeds
rate(t, x)      x' = (N u + nu, a)
frame(t, x)     the scene's slots, T, V, the rates of the coordinates, the reactions
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from eomgen.codegen import Program
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System, mass
from eomgen.mechanics.kinematics import Scope
from eomgen.mechanics.start import Start
from eomgen.model import Coordinate, Model, in_order
from eomgen.resources import growing
from eomgen.scene import Scene
from eomgen.simulation import PhaseModel
from eomgen.study import Study
from eomgen.symbolic.expression import Node, Scalar, is_zero, jacobian, substituted, symbols_of

Slopes = list[tuple[int, int]]


@dataclass(frozen=True)
class ConstraintRows:
    """The constraints of one system, as numbers of (t, x, p).

    Args:
        gaps, rates: phi of the constraints that have one, J u + sigma of those that close.
        speeds: J.
    """

    system: System
    gaps: tuple[Scalar, ...]
    rates: tuple[Scalar, ...]
    speeds: tuple[tuple[Scalar, ...], ...]

    @cached_property
    def program(self) -> Program:
        slopes = [x for rows in (self._positions, self.speeds) for row in rows for x in row if not is_zero(x)]
        return Program.of((*self.gaps, *self.rates, *slopes), self.system.symbols, inputs=self.system.inputs)

    @cached_property
    def _positions(self) -> tuple[tuple[Scalar, ...], ...]:
        """dphi/dq"""
        return tuple(map(tuple, jacobian(self.gaps, self.system.symbols.q)))

    def reported(self) -> dict[str, Any]:
        """Places of the numbers in the results of the program, for the page."""
        symbols, model = self.system.symbols, self.system.scope.model
        return {
            "coordinates": len(symbols.q),
            "speeds": len(symbols.u),
            "gaps": len(self.gaps),
            "rates": len(self.rates),
            "positionSlopes": _places(self._positions),
            "speedSlopes": _places(self.speeds),
            "fixed": [k for k, q in enumerate(symbols.q) if model.coordinates[q.name].driven],
            "spheres": self.program.unit_quaternions,
        }


def constraint_rows(system: System) -> ConstraintRows:
    """Constraint rows of a system: the gaps of all constraints, also of those satisfied by elimination, and the rows
    that close."""
    free = system if system.elimination is None else system.free or system
    closing = system.constraints.closing
    J = tuple(map(tuple, system.constraints.J)) if closing and system.symbols.u else ()
    rates = tuple(row.velocity for row in closing) if J else ()
    return ConstraintRows(system, free.constraints.gaps, rates, J)


def _places(rows: Sequence[Sequence[Scalar]]) -> Slopes:
    return [(i, j) for i, row in enumerate(rows) for j, x in enumerate(row) if not is_zero(x)]


@dataclass(frozen=True)
class Live:
    """A model that a page can move by itself.

    Args:
        phase: the one phase of a model whose contacts do not change.
        study: what is derived of the system of this phase.
        scene: its drawable elements.
        start, constraints: the constraints of the system as it is declared, and as it is integrated.
    """

    phase: PhaseModel
    study: Study
    scene: Scene
    start: ConstraintRows
    constraints: ConstraintRows

    @property
    def model(self) -> Model:
        return self.study.model

    @cached_property
    def programs(self) -> dict[str, Program]:
        """Programs by name; one that is the same as another, or has no results, is left out."""
        declared, system = self.phase.declared, self.phase.system
        with growing():
            equations = self.study.explicit_while_sliding
            found = {
                "begin": self._begin(),
                "rate": Program.right_hand_side(equations),
                "frame": Program.in_motion(self._frame(), equations),
            }
            if self.start.gaps or self.start.rates:
                found["start"] = self.start.program
            if self.start.rates:
                found["inertia"] = _inertia(declared)
            if system is not declared:
                found["ties"] = self.constraints.program
                found["turned"] = Program.of(declared.scope.rates, system.symbols, inputs=system.inputs)
            if self.phase.edges:
                found["edges"] = Program.of(
                    tuple(edge.left for edge in self.phase.edges), system.symbols, inputs=system.inputs
                )
        return found

    def _frame(self) -> tuple[Scalar, ...]:
        equations = self.study.derived
        rates = equations.kinematic_rates
        return (*self.scene.values, equations.T, equations.V, *rates, *self.reactions.values())

    @property
    def derived(self) -> tuple[str, ...]:
        """The parameters whose values are expressions of others, each after those in its own."""
        given = {name: None if part is None else part.value for name, part in self.model.parameters.items()}
        return tuple(name for name in in_order(given)[0] if (x := given[name]) is not None and x.names - {"pi"})

    def _begin(self) -> Program:
        """The derived parameters; start, then first guess of each coordinate; start of each speed and state."""
        system = self.phase.declared
        scope, symbols = system.scope, system.symbols
        known: dict[Node, Scalar] = {symbols.t: 0}
        derived = self.derived
        for name in derived:
            part = self.model.parameters[name]
            own = scope.value(part.value if part is not None else None)
            known[symbols.parameters[name]] = substituted((own,), known)[0]
        parts = self.model.coordinates
        q = [_begun(scope, part) for part in parts.values()]
        guesses = [scope.value(part.near) for part in parts.values()]
        speeds = Start.speeds_of(system)
        states = (scope.value(part.start) for part in self.model.states.values())
        begun = (*(symbols.parameters[name] for name in derived), *q, *guesses, *speeds.values(), *states)
        return Program.of(substituted(begun, known), symbols, inputs=system.inputs)

    @property
    def reactions(self) -> dict[str, Scalar]:
        """The reactions that have a single value, by name."""
        return single_reactions(self.study)

    @property
    def columns(self) -> dict[str, tuple[str, int]]:
        """{name: place of the number}: ("x", place) in the state, ("frame", place) in the frame."""
        phase, first = self.phase, len(self.scene.values)
        found = {"T": ("frame", first), "V": ("frame", first + 1)}
        found |= {f"{q}'": ("frame", first + 2 + k) for k, q in enumerate(phase.coordinates)}
        found |= {name: ("x", k) for k, name in enumerate(phase.moving)}
        place = first + 2 + len(phase.coordinates)
        return found | {name: ("frame", place + k) for k, name in enumerate(self.reactions)}

    def reported(self) -> dict[str, Any]:
        """Description of the programs for the page, to which a state of first order is one more speed."""
        declared, model = self.phase.declared, self.model
        q, u, parts = declared.symbols.q, declared.symbols.u + declared.symbols.z, model.coordinates
        standing = set(symbols_of(declared.constraints.gaps))
        sought = declared.constraints.fixed_by_position
        return {
            "parameters": list(declared.symbols.parameters),
            "derived": list(self.derived),
            "coordinates": [x.name for x in q],
            "speeds": [x.name for x in u],
            "phase": {"coordinates": self.phase.coordinates, "speeds": self.phase.speeds + self.phase.states},
            "start": self.start.reported(),
            "ties": self.constraints.reported(),
            "sought": [k for k, x in enumerate(q) if x in sought],
            "gapTies": [
                row.constraint for row in declared.constraints.rows if row.gap is not None and not row.identical
            ],
            "near": [k for k, x in enumerate(q) if x in sought and parts[x.name].near is not None],
            "own": [k for k, x in enumerate(q) if x in standing and x not in sought and not parts[x.name].driven],
            "guesses": [x.name for x in (*q, *u) if model.is_guess(x.name)],
            "typed": [x.name for x in (*q, *u) if model.is_typed(x.name)],
            "breaks": model.breakpoints,
            "edges": [edge.words for edge in self.phase.edges],
            "columns": self.columns,
            "slots": len(self.scene.values),
            "conservative": self.phase.conservative,
        }


def live_of(phase: PhaseModel, study: Study, scene: Scene) -> Live:
    """The model of a phase, as a page moves it.

    Args:
        study: of the system of the phase.
    """
    start = constraint_rows(phase.declared)
    return Live(phase, study, scene, start, start if phase.system is phase.declared else constraint_rows(phase.system))


def single_reactions(study: Study) -> dict[str, Scalar]:
    """The reactions that have a single value, by name; {} where a body is unsupported."""
    try:
        return study.reaction_values
    except DerivationError:
        return {}


def _begun(scope: Scope, part: Coordinate) -> Scalar:
    """A coordinate at the start, as `start_values` has it."""
    first = part.motion if part.motion is not None else part.start if part.start is not None else part.near
    return scope.value(first)


def _inertia(system: System) -> Program:
    M = mass(system.motion)
    return Program.of(tuple(x for row in M for x in row), system.symbols, inputs=system.inputs)
