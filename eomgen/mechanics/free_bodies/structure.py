"""System, a configuration -> Structure: the reactions that hold the bodies there, and the motions left to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.balance import Balance, slope
from eomgen.mechanics.free_bodies.velocity_plan import (
    MOST_MOTIONS,
    VelocityPlan,
)
from eomgen.mechanics.free_bodies.wrenches import Axes, Component, Effect
from eomgen.mechanics.start import ExactStart
from eomgen.model import BodyPoint, declared_at
from eomgen.symbolic.exact import LinearSystem, Pivots, Solution, readable_all
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRow,
    State,
    Vector,
    derivative,
    is_zero,
    substituted,
    tangent,
    tangents,
)
from eomgen.symbolic.numeric import Work, evaluate, fifty_digits, sparse_rank

# -------- structure -------------------------------------------------------------------------------------------
# System, a configuration -> Structure: the reactions that hold the bodies there, and the motions left to them.
#
# The equations of the bodies at rest are  G rho + applied = 0:  a column a reaction, a row a direction in which a
# body may move. Read the other way they are the velocities that the reactions forbid:
#
#     G^T xi = 0        xi: velocity of the mass centre and spin of every body
#
# so that   mobility = rows - rank,   degree of indeterminacy = columns - rank.   With one reaction released, G^T xi =
# its unit vector, the bodies have one motion left: the mechanism of the principle of virtual work. A force that is
# sought ([unknowns]) holds the bodies like a reaction.


UnknownColumn = tuple[int, int]
"""(index of the body, direction in DIRECTIONS): one velocity."""


@dataclass(frozen=True)
class Structure:
    """Bodies and the reactions on them, at one configuration.

    Args:
        balance: the equations of the bodies.
        at: what stands in place of coordinates, speeds, accelerations, inputs and time.
        columns: the velocities that bodies have.
        rows: of every component, and then of every unknown of the loads, {index of the column: coefficient}.
    """

    balance: Balance
    at: State
    columns: tuple[UnknownColumn, ...]
    rows: tuple[dict[int, Scalar], ...]

    @property
    def system(self) -> System:
        return self.balance.system

    @property
    def components(self) -> tuple[Component, ...]:
        return self.balance.components

    @property
    def names(self) -> tuple[str, ...]:
        """Name of every row: reaction_x(B), or the unknown."""
        return self.balance.names

    @property
    def unknowns(self) -> tuple[Node, ...]:
        """Unknowns of the loads."""
        return self.balance.unknowns

    @cached_property
    def pushes(self) -> tuple[tuple[str, tuple[Effect, ...]], ...]:
        """(owner, effects of a unit) of every row; of an unknown of the loads its derivative, on the bodies."""
        axes = Axes(self.system.motion)
        given = [e for load in self.system.loads.placed for e in axes.effects_of(load)]
        given += [*Effect.of_joints(self.system), *Effect.of_fluids(self.system).values()]
        own = [(component.owner, component.effects) for component in self.components]
        return (*own, *((p.name, tuple(filter(None, (_slope_of(e, p) for e in given)))) for p in self.unknowns))

    # -- counts ------------------------------------------------------------------------------------

    @property
    def rank(self) -> int:
        """Number of independent reactions, at the model's values of the parameters."""
        return self._ranks[0]

    @property
    def mobility(self) -> int:
        """Number of independent motions of the bodies."""
        return len(self.columns) - self.rank

    @property
    def indeterminacy(self) -> int:
        """Degree of static indeterminacy: the number of redundant reactions."""
        return len(self.rows) - self.rank

    @property
    def is_special(self) -> bool:
        """True if its rank is less than that of structures with other values of the parameters."""
        return self.rank < self._ranks[1]

    # -- motions -----------------------------------------------------------------------------------

    @cached_property
    def loose(self) -> tuple[VelocityPlan, ...]:
        """Independent motions that nothing resists; () where the bodies are held."""
        plans = []
        for f in self._solved.solution.free:
            shares = self._solved.solution.shares
            xi: list[Scalar] = [0] * len(self.columns)
            xi[f] = 1
            for j, share in shares.items():
                xi[j] = -share.get(f, 0)
            plans.append(self._plan(xi))
        return tuple(plans)

    @property
    def turns_idly(self) -> bool:
        """True if the only motions left are straight bodies turning about their own lines, without work of loads."""
        return bool(self.loose) and all(self._is_idle(plan) for plan in self.loose)

    @property
    def is_in_balance(self) -> bool:
        """True if the loads do no work in any motion that nothing resists."""
        return all(plan.vanishes((self._work(plan),)) for plan in self.loose)

    def _is_idle(self, plan: VelocityPlan) -> bool:
        points = self.system.motion.points
        moved = [x for body in plan.moving for r in points[body].values() for x in plan.raw_velocity((body, r))]
        return plan.vanishes((*moved, self._work(plan)))

    def _work(self, plan: VelocityPlan) -> Scalar:
        """Power of all known loads in a motion; unknown loads do no work in a motion that nothing resists."""
        velocities = (plan.velocities[body][direction] for body, direction in self.columns)
        return sum((f * v for f, v in zip(self.loads, velocities, strict=True)), start=0)

    @property
    def loads(self) -> ScalarRow:
        """Known loads along every column, what they are with all reactions and unknown loads at 0."""
        applied = {(self.system.motion.index[e.body], e.direction): e.applied for e in self.balance.equations}
        given = {**self.at, **dict.fromkeys(self.unknowns, 0)}
        return tuple(substituted(tuple(applied.get(column, 0) for column in self.columns), given))

    @cached_property
    def stresses(self) -> tuple[dict[int, Scalar], ...]:
        """Self-stresses: reactions {row: share} that are in balance without any load."""
        found = []
        for left in self._solved.solution.left:
            shares = self._readable([derivative(left, d) for d in self._solved.deltas])
            kept = {k: x for k, x in enumerate(shares) if not is_zero(x)}
            if kept:
                found.append(kept)
        return tuple(found)

    def determines(self, combination: Mapping[int, Scalar]) -> bool:
        """True if the balance gives sum of k_j rho_j a single value."""
        works = (sum((k * stress.get(j, 0) for j, k in combination.items()), start=0) for stress in self.stresses)
        return all(is_zero(x) or holds_identically(x) for x in works)

    def released(self, row: int | Mapping[int, Scalar]) -> VelocityPlan:
        """The motion that one released reaction leaves: a velocity 1 along it, 0 along all others.

        Where the bodies have degrees of freedom besides, these stand still. A combination k of reactions is released
        as one:
        velocities k along them.

        Raises:
            DerivationError: the others hold the bodies without it: it is statically indeterminate.
        """
        combination = {row: 1} if isinstance(row, int) else dict(row)
        if not self.determines(combination):
            names = ", ".join(self.names[j] for j in combination)
            raise DerivationError(
                f"{names} released, nothing can move: the other reactions hold the bodies without it",
                fix="take a redundant constraint away",
            )
        if [*combination.values()] == [1]:
            return self._plan(self._columns[next(iter(combination))])
        deltas = self._solved.deltas
        return self._plan(tangent(self._solved.velocities, {deltas[j]: k for j, k in combination.items()}))

    def index(self, name: str) -> int:
        """The row of a reaction or unknown by its name.

        Raises:
            KeyError: there is none of this name.
        """
        return {own: j for j, own in reversed(list(enumerate(self.names)))}[name]

    def _plan(self, xi: Sequence[Scalar]) -> VelocityPlan:
        velocities: list[list[Scalar]] = [[0] * 6 for _ in self.system.motion.links]
        for (body, direction), value in zip(self.columns, self._readable(xi), strict=True):
            velocities[body][direction] = value
        rows = tuple(tuple(six) for six in velocities)
        return VelocityPlan(self.system, self.at, self._solved.parameters, rows, self._places, self._known)

    @cached_property
    def _columns(self) -> tuple[ScalarRow, ...]:
        """Velocities of the bodies for each row, with a velocity 1 along it and 0 along the others."""
        return tangents(self._solved.velocities, self._solved.deltas)

    @cached_property
    def _places(self) -> dict[BodyPoint, Vector]:
        return {}

    @cached_property
    def _known(self) -> dict[Scalar, Any]:
        return {}

    def _readable(self, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return readable_all(tuple(scalars), Work.ANSWER, self.system.scope.positive)

    # -- the solution of G^T xi = delta --------------------------------------------------------------

    @cached_property
    def _ranks(self) -> tuple[int, int]:
        """Ranks at the model's own parameters, and at perturbed ones."""
        own, others = (self._numbers(self._parameters(shaken=shaken)) for shaken in (False, True))
        return sparse_rank(own), sparse_rank(others)

    def _numbers(self, parameters: State) -> list[dict[int, Any]]:
        """The rows in numbers of 50 digits."""
        flat = iter(evaluate([x for row in self.rows for x in row.values()], parameters, fifty_digits()))
        return [{k: next(flat) for k in row} for row in self.rows]

    @cached_property
    def _solved(self) -> _Solved:
        """General solution of G^T xi = delta.

        The pivots do not vanish at perturbed parameters, or, where the model's own are special, at these.
        """
        graph = self.system.scope.graph
        parameters = self._parameters(shaken=not self.is_special)
        deltas = tuple(graph.symbol(f"(delta {k})") for k in range(len(self.rows)))
        sure = () if self.is_special else tuple(self.system.symbols.parameters.values())
        equations = LinearSystem(
            self.rows, deltas, len(self.columns), partial(evaluate, values=parameters, arithmetic=fifty_digits())
        )
        solution = equations.solution(Pivots(factors=sure))
        return _Solved(solution, deltas, len(self.columns), parameters)

    def _parameters(self, *, shaken: bool) -> State:
        """The model's own, or the first generic ones at which all entries have a value."""
        return self.system.scope.values_for([x for row in self.rows for x in row.values()], shaken=shaken)

    def refuse_loose(self, degrees_of_freedom: int = 0) -> None:
        """Refuse bodies that would move in a way that no coordinate describes.

        Args:
            degrees_of_freedom: the number of motions that coordinates describe.
        Raises:
            DerivationError: which bodies can move, and how.
        """
        if self.mobility <= degrees_of_freedom or stays(self):
            return
        reported = [plan.in_words for plan in self.loose[:MOST_MOTIONS]]
        more = len(self.loose) - len(reported)
        enough = self.indeterminacy + degrees_of_freedom >= self.mobility
        kind = "infinitesimally movable" if enough else "unstable"
        what = f"the structure is {kind}: {'; '.join(reported)}{f'; and {more} more' if more else ''}"
        if degrees_of_freedom:
            what += (
                f" ({degrees_of_freedom} of these motions {'is' if degrees_of_freedom == 1 else 'are'} a coordinate's)"
            )
        if enough:
            what += f"; its {len(self.rows)} reactions are not independent there"
        raise DerivationError(what, declared_at(_culprit(self.loose[0])), _fix(self, enough))

    @staticmethod
    def of(system: System, at: Mapping[Node, Scalar] | None = None) -> Structure:
        """The structure at a configuration, at rest.

        Args:
            at: exact scalars in place of coordinates; None: the start.
        Raises:
            DerivationError: there is no body; a force, an energy or a constraint that acts at no place; constraints
                that do not close; loads that are not linear in an unknown.
        """
        if not system.motion.links:
            raise DerivationError("the model has no body: nothing is to be held", "bodies", "declare [bodies.NAME]")
        balance = Balance.of(system)
        state = ExactStart.values_at_rest(system, at)
        unknowns = balance.unknowns
        table = {(system.motion.index[e.body], e.direction): e for e in balance.equations}
        columns = tuple(c for c in _directions(system) if c in table or not _is_point_that_turns(system, c))
        rows: list[dict[int, Scalar]] = [{} for _ in (*balance.components, *unknowns)]
        for k, column in enumerate(columns):
            equation = table.get(column)
            for j, x in ({} if equation is None else equation.coefficients).items():
                rows[j][k] = x
            for j, unknown in enumerate(unknowns, start=len(balance.components)):
                rows[j][k] = 0 if equation is None else slope(balance, equation, unknown)
        return Structure(balance, state, columns, _placed(system, rows, state))


@dataclass(frozen=True)
class _Solved:
    """G^T xi = delta, solved for xi."""

    solution: Solution
    deltas: tuple[Node, ...]
    size: int
    parameters: State

    @property
    def velocities(self) -> tuple[Scalar, ...]:
        """xi as functions of delta; those that stay free are 0."""
        return tuple(self.solution.constants.get(j, 0) for j in range(self.size))


def _placed(system: System, rows: Sequence[Mapping[int, Scalar]], state: State) -> tuple[dict[int, Scalar], ...]:
    """The rows at the configuration, zeros left out."""
    entries = substituted(tuple(x for row in rows for x in row.values()), state)
    flat = iter(readable_all(entries, Work.ANSWER, system.scope.positive))
    placed = [{k: next(flat) for k in row} for row in rows]
    return tuple({k: x for k, x in row.items() if not is_zero(x)} for row in placed)


def _directions(system: System) -> list[UnknownColumn]:
    axes = Axes(system.motion)
    return [(i, d) for i in range(len(system.motion.links)) for d in axes.rows]


def _is_point_that_turns(system: System, column: UnknownColumn) -> bool:
    """True if the column is the rotation of a node or point mass, which is no motion of its own."""
    body, direction = column
    part = system.scope.model.bodies.get(system.motion.links[body].name)
    point = part is None or (part.shape is not None and part.shape.is_point)
    return point and direction > 2


def _slope_of(effect: Effect, unknown: Node) -> Effect | None:
    """Derivative of an effect with respect to an unknown load; None where it does not occur in the effect."""
    force, couple = (tuple(derivative(x, unknown) for x in v) for v in (effect.force, effect.couple))
    if all(map(is_zero, (*force, *couple))):
        return None
    return Effect(effect.link, Vector(force), Vector(couple), effect.arm, effect.place, effect.beyond)


# -------- loose motion ----------------------------------------------------------------------------------------
# Structure -> True if bodies that nothing holds stay in place, and what would hold them.


def stays(structure: Structure) -> bool:
    """True if the bodies stay in place although nothing resists some of their motions.

    So it is where only straight bodies could turn about their own lines, or where the loads do no work and the moving
    bodies hang on strings, or an unknown load is sought.
    """
    if structure.turns_idly:
        return True
    kept = bool(structure.unknowns) or all(_hangs(structure, plan) for plan in structure.loose)
    return kept and structure.is_in_balance


def _hangs(structure: Structure, plan: VelocityPlan) -> bool:
    """True if a string pulls every body that moves in the plan."""
    system = structure.system
    constraints = system.scope.model.constraints
    ropes = [
        row for row in system.constraints.rows if row.component == "tension" and constraints[row.constraint].only_pulls
    ]
    pulled = {body for row in ropes for body, _ in row.wrenches}
    return set(plan.moving) <= pulled


def _culprit(plan: VelocityPlan) -> str:
    """A body or node that moves."""
    blocks = plan.blocks
    named = [name for block in blocks for name in block.bodies]
    return named[0] if named else plan.moving[0]


def _fix(structure: Structure, enough: bool) -> str:
    if structure.is_special:
        return "at other values of the parameters it is held: change these, or turn a support"
    if enough:
        return "turn or move a support or hinge, so that it stands across this motion"
    held = "hold it against this motion by a further support, hinge, clamp or member"
    model = structure.system.scope.model
    if not model.coordinates and any(force.elastic for force in model.forces.values()):
        held += "; a spring holds only what a coordinate moves: name the angle or displacement in the body's joint"
    balanced = "; its loads are in balance even so, what they need then `eomgen reactions` gives"
    return held + (balanced if structure.is_in_balance else "")
