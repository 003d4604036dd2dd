"""Model, [given] -> InstantKinematics: velocities and accelerations of all bodies at one configuration.

    J u + sigma = 0,   J a + gamma = 0        the constraints, bodies that only constraints hold displaced (`loose`)
    left - right = 0                          what is given, linear in u or in a and in the unknowns

Both are solved exactly at the configuration. What they leave free stays as a symbol, so that whatever does not depend
on it (a ratio of two spins, a centre of rotation) has its answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property, partial
from random import Random

import numpy as np

from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant.quantities import Quantities
from eomgen.mechanics.start import ExactStart, Start
from eomgen.model import Model, WrittenEquation, freed, is_node
from eomgen.symbolic.exact import LinearSystem, Pivots, collected_in, legible, readable_all
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Scalar,
    State,
    depends_on,
    is_zero,
    parse,
    substituted,
)
from eomgen.symbolic.numeric import Work, evaluate, fifty_digits, independent_rows, lengths_of, tolerances
from eomgen.symbolic.print import text_size

SHORT = 80  # characters of where a coordinate is that stands for it in formulas
LONG = 400  # characters from which a value is no easier to read than it came


class Undetermined(DerivationError):
    """A value that the constraints and what is given leave open."""


@dataclass(frozen=True)
class Known:
    """Solution of the equations of one order: velocities, or accelerations.

    Args:
        values: of the velocities (or accelerations) and unknowns, in terms of those that stay free.
        free: those that stay free.
        degrees_of_freedom: their number under the constraints alone.
        unknowns: the number of unknowns in the given equations.
        given: the number of degrees of freedom and unknowns that the given equations determine.
    """

    values: State
    free: tuple[Node, ...]
    degrees_of_freedom: int
    unknowns: int
    given: int

    @property
    def missing(self) -> int:
        """Number of equations still needed to determine the rest."""
        return self.degrees_of_freedom + self.unknowns - self.given


@dataclass(frozen=True)
class InstantKinematics:
    """A system at one configuration.

    Args:
        system: of the freed model, dependent coordinates as free as others.
        places: the configuration: exact scalars of the parameters in place of q, t and inputs.
        velocity, acceleration: the given equations.
        speeds: the start speeds of the model's own coordinates that are given, too.
        assumed: a velocity that is taken to be a symbol: {text: symbol}.
        exact: True if the places are exact; else they are numbers.
        located: numbers for the coordinates that stay symbols, as their closed form would be long.
    """

    system: System
    places: State
    velocity: tuple[WrittenEquation, ...] = ()
    acceleration: tuple[WrittenEquation, ...] = ()
    speeds: Mapping[str, Expression] = field(default_factory=dict)
    assumed: Mapping[str, Node] = field(default_factory=dict)
    exact: bool = True
    located: Mapping[Node, float] = field(default_factory=dict)

    # -- what is known -----------------------------------------------------------------------------

    @cached_property
    def velocities(self) -> Known:
        """u, and the unknowns among the velocities.

        Raises:
            DerivationError: given velocities that contradict one another or the constraints.
        """
        symbols = self.system.symbols
        constraints = constraint_lines(self.system, self.places)
        given = speed_lines(self.system, self.speeds, self.places)
        given += given_lines(self.system, self.places, self.velocity, symbols.u, "velocity")
        for text, symbol in self.assumed.items():
            gap = self._at(parse(text, references=True), self.places) - symbol
            given.append(linear_line(f"'{text}'", gap, symbols.u, "given"))
        return self._known(constraints, given, symbols.u, self.places)

    @cached_property
    def accelerations(self) -> Known:
        """a, and the unknowns among the accelerations, the velocities put in.

        Raises:
            DerivationError: given accelerations that contradict one another or the constraints.
        """
        symbols, state = self.system.symbols, self.moving
        given = given_lines(self.system, state, self.acceleration, symbols.a, "acceleration")
        return self._known(self._bending, given, symbols.a, state)

    @cached_property
    def moving(self) -> State:
        """Places and velocities."""
        return {**self.places, **self.velocities.values}

    @cached_property
    def state(self) -> State:
        """Places, velocities and accelerations."""
        return {**self.moving, **self.accelerations.values}

    def _known(self, constraints: list[GivenRow], given: list[GivenRow], rates: Sequence[Node], state: State) -> Known:
        unknowns = [x for x in self.system.symbols.unknowns.values() if x not in state]
        standing = [x for x in unknowns if any(x in line.entries for line in given)]
        solution, ranks = solution_of(self.system, constraints, given, (*rates, *standing), self._near)
        values = {node: self.simple(x) for node, x in solution.items()}
        free = tuple(node for node in (*rates, *standing) if node not in values)
        return Known(values, free, len(rates) - ranks[0], len(standing), ranks[1] - ranks[0])

    @property
    def _near(self) -> Mapping[Node, float] | None:
        """Numbers for the coordinates that are not known in closed form; None where all are exact."""
        return None if self.exact and not self.located else self.located

    # -- values ------------------------------------------------------------------------------------

    def value(self, formula: Expression) -> Scalar:
        """A formula of the model here, as a function of the parameters.

        Raises:
            Undetermined: it depends on what constraints and given equations leave open.
            DerivationError: it has no value here.
        """
        scalar = self.raw(formula)
        self.refuse_open(scalar)
        self.refuse_impossible()
        return scalar

    def raw(self, formula: Expression) -> Scalar:
        """A formula here in which the velocities and accelerations that are left open may stand."""
        symbols, scalar = self.system.symbols, self._at(formula, self.moving)
        later = (*symbols.a, *(x for x in symbols.unknowns.values() if x not in self.moving))
        return self._at(formula, self.state) if depends_on(scalar, later) else scalar

    def _at(self, formula: Expression, state: State) -> Scalar:
        quantities = Quantities(self.system, state)
        scalar = formula.evaluate(self.system.scope.names, quantities.value)
        return self.simple(substituted((scalar,), state)[0])

    def simple(self, x: Scalar) -> Scalar:
        """A scalar as a person writes it; as it came where multiplying out made it longer still."""
        return legible(x, Work.ANSWER, self.system.scope.positive, LONG)

    def refuse_impossible(self) -> None:
        """Refuse velocities that redundant constraints allow to first order, as at a change point, and no motion has.

        Raises:
            DerivationError: J a + gamma = 0 has no solution.
        """
        symbols, known = self.system.symbols, self.velocities
        rank = len(symbols.u) - known.degrees_of_freedom
        if rank < len(self._bending) and not known.free:
            solution_of(self.system, self._bending, (), symbols.a, self._near)

    @cached_property
    def _bending(self) -> list[GivenRow]:
        return constraint_lines(self.system, self.moving, accelerations=True)

    # -- what is left open ---------------------------------------------------------------------------

    def refuse_open(self, scalar: Scalar) -> None:
        """Refuse a value in which something stands that is left open.

        Raises:
            Undetermined: says how many equations are missing, and offers one.
        """
        symbols = self.system.symbols
        if depends_on(scalar, symbols.u):
            raise self._open(self.velocities, "velocity", "rate")
        if depends_on(scalar, symbols.a):
            raise self._open(self.accelerations, "acceleration", "acceleration")
        for name, node in symbols.unknowns.items():
            if depends_on(scalar, (node,)) and node in self.velocities.free:
                raise self._open(self.velocities, "velocity", "rate")
            if depends_on(scalar, (node,)) and node in self.accelerations.free:
                raise self._open(self.accelerations, "acceleration", "acceleration")
            if depends_on(scalar, (node,)):
                raise Undetermined(
                    f"the unknown '{name}' is not determined by what is given",
                    f"unknowns.{name}",
                    "let it stand in an equation of [given], or in a load",
                )

    def _open(self, known: Known, order: str, noun: str) -> Undetermined:
        many = f"{known.degrees_of_freedom} degree{'s' if known.degrees_of_freedom != 1 else ''} of freedom"
        if known.unknowns:
            many += f" and {known.unknowns} unknown{'s' if known.unknowns > 1 else ''}"
            noun = "equation"
        rates = f"{known.given} {noun}{'s' if known.given != 1 else ''} given"
        more = "one more" if known.given else "one" if known.missing == 1 else f"{known.missing}"
        offer = self._offered(known, order)
        return Undetermined(
            f"it is not determined: {many}, {rates}", "given", f'give {more} in [given]: {order} = ["{offer} = ..."]'
        )

    def _offered(self, known: Known, order: str) -> str:
        """A quantity that is still open: the spin of a body, or the velocity of a point."""
        state = self.moving if order == "velocity" else self.state
        for requested in self._quantities(order):
            if depends_on(self._at(parse(requested, references=True), state), known.free):
                return requested
        return "omega(...)" if order == "velocity" else "epsilon(...)"

    def _quantities(self, order: str) -> Iterator[str]:
        """Spins of bodies and velocities of points (or their rates), as one would give them."""
        plane = self.system.scope.model.space == "plane"
        turn, along = ("omega", "v") if order == "velocity" else ("epsilon", "a")
        for name in self.system.motion.index:
            if not is_node(name):
                yield from [f"{turn}({name})"] if plane else [f"{turn}_{axis}({name})" for axis in "xyz"]
            point = name if is_node(name) else f"{name}.origin"
            yield from (f"{along}{axis}({point})" for axis in ("xy" if plane else "xyz"))

    @property
    def open_rate(self) -> str:
        """A velocity that the constraints and what is given leave open; "" where there is none."""
        return self._offered(self.velocities, "velocity") if self.velocities.free else ""

    def assuming(self, rate: str, symbol: Node) -> InstantKinematics:
        """The same with a velocity that is this symbol."""
        return replace(self, assumed={**self.assumed, rate: symbol})

    def refuse_several(self) -> None:
        """Refuse more than one rate that is left open.

        Raises:
            Undetermined: says what to give.
        """
        if self.velocities.missing > 1:
            raise self._open(self.velocities, "velocity", "rate")

    @staticmethod
    def of(model: Model, *, by_coordinates: bool = False) -> InstantKinematics:
        """The model at its start, with what it gives of velocities and accelerations.

        Start speeds that the model says count as given.

        Args:
            by_coordinates: coordinates that the constraints place in no short closed form stay symbols; else they are
                numbers.
        Raises:
            DerivationError: constraints that do not close at the start.
        """
        free = System.free_of(freed(model))
        places, numbers = _places(free)
        located = {q: numbers[q.name] for q in free.constraints.fixed_by_position if numbers and q not in places}
        exact = by_coordinates or not located
        still = (
            _still(free, ExactStart.values_at_rest(free, {**{q: q for q in located}, **places}))
            if exact
            else _in_numbers(free, numbers)
        )
        if not located:
            open_gaps(free, still)
        given = model.given
        speeds = {
            f"{name}'": part.speed
            for name, part in model.coordinates.items()
            if part.speed is not None and not part.driven
        }
        speeds |= {name: part.start for name, part in model.speeds.items() if part.start is not None}
        velocity, acceleration = (given and given.velocity) or (), (given and given.acceleration) or ()
        return InstantKinematics(
            free, still, velocity, acceleration, speeds, exact=exact, located=located if exact else {}
        )


def _places(free: System) -> tuple[State, Mapping[str, float]]:
    """(dependent coordinates in short closed form, {} or, where that is not all of them, the start in numbers)."""
    system = free.reduced()
    sought, found = system.constraints.fixed_by_position, State()
    if not sought:
        return {}, {}
    try:
        found = ExactStart.values_at_rest(system)
    except DerivationError:
        Start.of(system)
    short = {q: found[q] for q in sought if q in found and text_size(found[q]) <= SHORT}
    try:
        return short, {} if len(short) == len(sought) else Start.of(system).values
    except MissingValues:
        return {q: found[q] for q in sought}, {}


def _in_numbers(free: System, start: Mapping[str, float]) -> State:
    """Coordinates, and the parameters that have values, as the exact numbers that these doubles are."""
    symbols, values = free.symbols, free.scope.model.exact_parameters()
    parameters = {symbols.parameters[name]: Fraction(x) for name, x in values.items()}
    places = {q: Fraction(start[q.name]) for q in symbols.q}
    still = _still(free, ExactStart.values_at_rest(free, places))
    return {node: substituted((x,), parameters)[0] for node, x in still.items()} | parameters


def _still(system: System, state: State) -> State:
    """A state without its velocities and accelerations, which are 0 there."""
    moving = {*system.symbols.u, *system.symbols.a}
    return {node: x for node, x in state.items() if node not in moving}


# -------- given rows ------------------------------------------------------------------------------------------
# System, [given] -> the linear equations of velocities or accelerations at one configuration, and their solution.


UNSAID = ""  # what nobody wrote, as the norm of a quaternion


@dataclass(frozen=True)
class GivenRow:
    """One equation: sum of entries * unknowns = right.

    Args:
        said: how a message calls it.
        entries: {velocity or acceleration or unknown: coefficient}, zeros left out.
    """

    said: str
    entries: dict[Node, Scalar]
    right: Scalar


# -- the equations -----------------------------------------------------------------------------------


def constraint_lines(system: System, state: Mapping[Node, Scalar], *, accelerations: bool = False) -> list[GivenRow]:
    """J u = - sigma, or J a = - gamma, of every constraint row at a state."""
    constraints, symbols = system.constraints, system.symbols
    rates, right = (symbols.a, constraints.gamma) if accelerations else (symbols.u, constraints.sigma)
    width = len(rates)
    placed = substituted((*(x for row in constraints.J for x in row), *right), state)
    flat = readable_all(placed, Work.ANSWER, system.scope.positive)
    lines = []
    for k, row in enumerate(constraints.closing):
        entries = zip(rates, flat[k * width : (k + 1) * width], strict=True)
        kept = {node: x for node, x in entries if not is_zero(x)}
        lines.append(GivenRow(f"the constraint '{row.constraint}'", kept, -flat[len(constraints.closing) * width + k]))
    return [*_norm_lines(system, state, accelerations=accelerations), *lines]


def _norm_lines(system: System, state: Mapping[Node, Scalar], *, accelerations: bool) -> Iterator[GivenRow]:
    """e . e' = 0, or e . e'' = - e' . e', of every quaternion; nobody wrote them, so no message names them."""
    scope, rates = system.scope, system.symbols.a if accelerations else system.symbols.u
    for four in scope.quaternions:
        gap = sum((e * scope.names[e.name + "'"] for e in four), start=0)
        gap = scope.with_accelerations((gap,))[0] if accelerations else gap
        (placed,) = readable_all(substituted((gap,), state), Work.ANSWER, scope.positive)
        yield linear_line(UNSAID, placed, rates, "")


def speed_lines(system: System, speeds: Mapping[str, Expression], state: Mapping[Node, Scalar]) -> list[GivenRow]:
    """The start speeds of coordinates, and of declared speeds, as equations."""
    scope, u = system.scope, system.symbols.u
    gaps = substituted([scope.names[name] - scope.value(speed) for name, speed in speeds.items()], state)
    return [linear_line(f"the start speed {name}", gap, u, "speeds") for name, gap in zip(speeds, gaps, strict=True)]


def given_lines(
    system: System,
    state: Mapping[Node, Scalar],
    equations: Sequence[WrittenEquation],
    rates: Sequence[Node],
    order: str,
) -> list[GivenRow]:
    """Given equations at a state, linear in the rates and the unknowns.

    Args:
        order: "velocity" or "acceleration".
    Raises:
        DerivationError: one is not linear in them, or says nothing of them.
    """
    quantities, symbols = Quantities(system, state), system.symbols
    lines = []
    for number, equation in enumerate(equations):
        where = f"given.{order}.{number}"
        sides = (equation.left, equation.right)
        left, right = (side.evaluate(system.scope.names, quantities.value) for side in sides)
        _refuse_other_order(system, equation, left - right, order, where)
        (gap,) = substituted((left - right,), state)
        if order == "velocity" and depends_on(gap, symbols.a):
            raise DerivationError(f"'{equation.text}' holds an acceleration", where, "put it under `acceleration`")
        lines.append(linear_line(f"'{equation.text}'", gap, (*rates, *symbols.unknowns.values()), where))
    return lines


def _refuse_other_order(system: System, equation: WrittenEquation, gap: Scalar, order: str, where: str) -> None:
    """Refuse an equation that says nothing of its order: of places, or of velocities under `acceleration`.

    Raises:
        DerivationError: the equation is named.
    """
    symbols = system.symbols
    unknowns = tuple(symbols.unknowns.values())
    if depends_on(gap, (*symbols.a, *unknowns, *(symbols.u if order == "velocity" else ()))):
        return
    if depends_on(gap, (*symbols.u, *symbols.q)):
        fix = "put it under `velocity`" if depends_on(gap, symbols.u) else "places are where points and starts are"
        requested = "velocities" if order == "velocity" else "accelerations"
        raise DerivationError(f"'{equation.text}' says nothing of {requested}", where, fix)


def linear_line(text: str, gap: Scalar, unknowns: Sequence[Node], where: str) -> GivenRow:
    """gap = 0 as an equation of the unknowns.

    Raises:
        DerivationError: it is not linear in them.
    """
    try:
        parts = collected_in(gap, unknowns)
    except DerivationError:
        raise DerivationError(
            f"{text} is not linear in what it gives", where, "give components: vx(...), vy(...), omega(...)"
        ) from None
    entries = {node: x for node, x in parts.items() if node is not None}
    return GivenRow(text, entries, -parts.get(None, 0))


def open_gaps(system: System, places: Mapping[Node, Scalar]) -> None:
    """Refuse constraints whose points do not meet at a configuration.

    Raises:
        DerivationError: the constraint is named.
    """
    rows = [(row, row.gap) for row in system.constraints.closing if row.gap is not None]
    gaps = substituted([gap for _, gap in rows], places)
    for (row, _), gap in zip(rows, gaps, strict=True):
        if not holds_identically(gap) and abs(value := _at_own_values(system, gap)) > tolerances.COMPUTED:
            along = f" along {row.component}" if row.component in ("x", "y", "z") else ""
            raise DerivationError(
                f"'{row.constraint}' does not close at the start: it is open by {value:.4g}{along}",
                f"constraints.{row.constraint}",
                "put its points where they meet",
            )


def _at_own_values(system: System, x: Scalar) -> float:
    return float(evaluate((x,), system.scope.values_of_parameters(Random(1)), fifty_digits())[0])


# -- their solution ----------------------------------------------------------------------------------


def solution_of(
    system: System,
    constraints: Sequence[GivenRow],
    given: Sequence[GivenRow],
    unknowns: Sequence[Node],
    near: Mapping[Node, float] | None = None,
) -> tuple[dict[Node, Scalar], tuple[int, int]]:
    """(each unknown that the equations determine, with the free ones in it; ranks of the constraints and of all).

    Args:
        near: where symbols of the configuration are, in rounded numbers: what nearly vanishes there does.
    Raises:
        DerivationError: equations that contradict one another.
    """
    lines = [*constraints, *given]
    scalars = [x for line in lines for x in (*line.entries.values(), line.right)]
    own, shaken = (system.scope.values_for(scalars, near, shaken=shaken) for shaken in (False, True))
    matrix = _matrix(lines, unknowns, own)
    _refuse_contradiction(lines, matrix, len(constraints))
    rank = _rank(matrix)
    values = shaken if near is None and _rank(_matrix(lines, unknowns, shaken)) == rank else own
    index = {node: j for j, node in enumerate(unknowns)}
    rows = [{index[node]: x for node, x in line.entries.items()} for line in lines]
    found = LinearSystem(
        rows, [line.right for line in lines], len(unknowns), partial(evaluate, values=values, arithmetic=fifty_digits())
    ).solution(
        Pivots(tolerance=tolerances.ELIMINATED_AT_50 if near is None else tolerances.RANK),
    )
    result = {}
    for j, constant in found.constants.items():
        shares = [share * unknowns[f] for f, share in found.shares[j].items()]
        result[unknowns[j]] = constant - sum(shares, start=0)
    return result, (_rank(matrix[: len(constraints)]), rank)


def _matrix(lines: Sequence[GivenRow], unknowns: Sequence[Node], values: State) -> np.ndarray:
    """[A | b], rows of unit length in A."""
    index = {node: j for j, node in enumerate(unknowns)}
    matrix = np.zeros((len(lines), len(unknowns) + 1))
    for i, line in enumerate(lines):
        numbers = evaluate((*line.entries.values(), line.right), values, fifty_digits())
        for node, x in zip(line.entries, numbers, strict=False):
            matrix[i, index[node]] = float(x)
        matrix[i, -1] = float(numbers[-1])
        size = lengths_of(matrix[i, :-1])
        matrix[i] /= size if size else 1.0
    return matrix


def _rank(matrix: np.ndarray) -> int:
    """Rank of A in the augmented matrix [A | b]."""
    return len(independent_rows(matrix[:, :-1], tolerances.RANK))


def _refuse_contradiction(lines: Sequence[GivenRow], matrix: np.ndarray, constraints: int) -> None:
    """Refuse equations of which one contradicts others.

    Args:
        constraints: how many of them are constraints.
    Raises:
        DerivationError: all of them are named.
    """
    kept = independent_rows(matrix[:, :-1], tolerances.RANK)
    basis = matrix[kept]
    for i, line in enumerate(lines):
        if i in kept:
            continue
        before = [k for k in range(len(kept)) if kept[k] < i]
        shares = np.linalg.lstsq(basis[before][:, :-1].T, matrix[i, :-1], rcond=None)[0] if before else np.zeros(0)
        rest = matrix[i, -1] - shares @ basis[before][:, -1]
        if abs(rest) > tolerances.RANK * max(1.0, float(np.max(np.abs(matrix[:, -1])))):
            others = dict.fromkeys(
                lines[kept[k]].said
                for k, share in zip(before, shares, strict=True)
                if abs(share) > tolerances.RANK and lines[kept[k]].said != UNSAID
            )
            against = f" contradicts {', '.join(others)}" if others else " cannot hold: nothing there can move so"
            if i < constraints:
                raise DerivationError(
                    f"no motion has these velocities: {line.said}{against}",
                    "given",
                    "the bodies lock there, or their motion branches: give other velocities",
                )
            raise DerivationError(f"{line.said}{against}", "given", "leave one of them out, or change its value")
