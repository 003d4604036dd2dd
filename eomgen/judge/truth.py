"""Decision whether an equation is right: of motion, at rest, along the motion, of small motions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from itertools import islice, product
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.comparison import Comparison, is_linear, linearized
from eomgen.judge.decision import combination, is_zero_everywhere, linear_row, states_of, vanish_nearly
from eomgen.judge.diagnosis import PLAINEST, SHORTER, TERMS, Explanation, Mistake, Share
from eomgen.judge.mistakes import ModelEdits
from eomgen.judge.reading import HandEquation
from eomgen.mechanics.dynamics import Extent
from eomgen.model import AtRest, WrittenEquation
from eomgen.symbolic.expression import (
    Call,
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    depends_on,
    derivative,
    gradient,
    is_zero,
    order,
    over,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import ARRAYS, FLOAT, NoValue, evaluate, tolerances
from eomgen.symbolic.print import readable_text

# -------- right -----------------------------------------------------------------------------------------------
# An equation over the symbols of a case -> whether it is right, and up to what.


SIDED = ("abs", "sqrt", "sign", "min", "max", "asin", "acos", "atan", "atan2")  # of one side of their domain alone
MOST_SIZES = 2  # sizes |x| of which either sign is tried
EVERY_PIECE = ("motion", "acceleration")  # kinds of equations that must hold in every piece
IDENTITY, CONSTANT, SIGNLESS = "identity", "constant", "signless"
MOST_SOLVED = 24  # changed models that the solver of outputs answers: each takes it a tenth of a second
OF_ENERGIES = ("", "the constraints", "a constant of the potential energy")  # up to what an energy is the model's


@dataclass(frozen=True)
class Decided:
    """The decision on an equation.

    Args:
        holds: yes, no, or None: nothing decided it.
        up_to: what had to be used, in words; "" where nothing.
        why: of what is not right: IDENTITY, CONSTANT, SIGNLESS, "" else.
    """

    holds: bool | None
    up_to: str = ""
    why: str = ""


def truth_of(case: Case, scalar: Scalar, kind: str, *, to_a_constant: bool = True) -> Decided:
    """The decision whether a scalar vanishes in every motion of the case, with what had to be used to see it.

    Args:
        to_a_constant: of energies a constant may be left, as of a potential one.
    """
    found = is_zero_everywhere(case.system, scalar)
    if found.holds:
        if kind == "motion":
            return Decided(False, why=IDENTITY)
        return Decided(True, "the constraints" if found.on_constraints else "")
    undecided = found.holds is None
    if kind == "energy" and to_a_constant and _is_constant_of_potential(case, scalar):
        return Decided(True, OF_ENERGIES[-1])
    if (of_positions := _integral_of_positions(case, scalar)) is not None:
        return of_positions
    if case.parts.equations is None:
        return Decided(None if undecided else False)
    if depends_on(scalar, case.forced):
        follows = case.follows(scalar)
        if follows.holds:
            return _reported(case, scalar, kind, follows.rows, follows.on_constraints)
        undecided = undecided or follows.holds is None
    if kind in ("law", "energy") and (integral := _integral(case, scalar)):
        return integral
    moving = (*case.system.symbols.u, *case.system.symbols.a)
    if depends_on(scalar, moving):
        reported, held = _by_integrals(case, scalar, {})
        if held.everywhere or (held and kind not in EVERY_PIECE):
            return Decided(True, f"{reported} from the start{while_(held)}")
    return Decided(None if undecided else False)


def is_right(case: Case, written: HandEquation, kind: str, at: WrittenEquation | AtRest | None) -> bool:
    """True if an equation is right for a case, by whatever decides one of its kind; False also where nothing does.

    Raises:
        EomgenError: it has no value there.
    """
    if _is_solved(kind, at):
        left, right = (case.exact(each) for each in case.sides(written, at))
        return left is not None and right is not None and bool(is_zero_everywhere(case.system, left - right).holds)
    course = course_of(case, written, {})
    if course is not None:
        return bool(course.holds and course.begins)
    scalar = case.value(written.difference)
    if kind in ("law", "energy"):
        if kind == "law" and case.begins_otherwise(scalar):
            return False
        found = truth_of(case, scalar, kind)
        return bool(found.holds) and (kind == "law" or found.up_to in OF_ENERGIES)
    if kind == "equilibrium":
        return bool(is_of_rest(case, scalar))
    if depends_on(scalar, case.forced):
        follows = case.follows(scalar)
        return bool(follows.holds) and any(k < len(case.rows) for k in follows.rows)
    return kind != "motion" and bool(is_zero_everywhere(case.system, scalar).holds)


def _is_solved(kind: str, at: WrittenEquation | AtRest | None) -> bool:
    """True if the solver of outputs answers both sides: instants, equilibria, small motions, structures."""
    return at is not None or kind in ("frequency", "statics")


def other_models(case: Case, written: HandEquation, kind: str, at: WrittenEquation | AtRest | None) -> ModelEdits:
    """The changes of the model file with which an equation would be right; none explains what has no dimension."""
    most = MOST_SOLVED if _is_solved(kind, at) else None
    return ModelEdits(
        lambda: () if case.clash(written) else case.edited[:most],
        written.names,
        lambda model: is_right(replace(case, model=model), written, kind, at),
    )


def _by_integrals(case: Case, scalar: Scalar, known: Mapping[Node, Scalar]) -> tuple[str, Extent]:
    """(by which integrals from the start a scalar vanishes where nodes are replaced, in words, where it does)."""
    if depends_on(scalar, case.system.symbols.lam):
        return "", Extent(False)
    for reported in ("the momenta", "the energy theorem and the momenta"):
        by_integrals = case.by_momenta if reported == "the momenta" else case.speeds
        if not by_integrals:
            continue
        speeds, held = by_integrals
        started = substituted((case.phase.eliminated(scalar),), {**speeds, **known})
        if not case.starts_exactly:
            if held.everywhere and vanish_nearly(case.system, started):
                return reported, Extent(True)
            continue
        of_forces = depends_on(scalar, case.system.symbols.a)  # equations of motion hold in every piece
        found = combination(case.system, started, (), within=not of_forces)
        if found.holds:
            return reported, held
        if found.held and (both := held & found.held):
            return reported, both
    return "", Extent(False)


def while_(held: Extent) -> str:
    """ ", while y >= 0" of what holds in some pieces alone."""
    return "" if held.everywhere else f", while {held.text}"


def in_its_piece(case: Case, scalar: Scalar) -> str:
    """ "while y >= 0", where an equation of motion holds in the piece of the start and not in all; "": in neither."""
    follows = case.follows(scalar, within=True) if depends_on(scalar, case.forced) else None
    return f"while {follows.held.text}" if follows is not None and follows.held else ""


def says_nothing(case: Case, written: HandEquation) -> bool:
    """True if it holds whatever its names mean, functions of the motion included: 0 = 0."""
    graph, known = case.system.scope.graph, dict[str, Node]()

    def opaque(call: Call) -> Node:
        return known.setdefault(str(call), graph.symbol(f"({call})"))

    own = case.system.scope.names
    plain = {name for name, x in own.items() if type(x) is Node and x.op == "symbol" and x.name == name}
    names = {name: graph.symbol(f"({name})") for name in written.names - plain - {"t", "pi"}}
    scalar = case.evaluated(written.difference, {**own, **names}, opaque)
    found = is_zero_everywhere(case.system, scalar)
    return bool(found.holds) and not found.on_constraints


def _is_constant_of_potential(case: Case, scalar: Scalar) -> bool:
    symbols = case.system.symbols
    slopes = gradient(scalar, (symbols.t, *symbols.x))
    return bool(is_zero_everywhere(case.system, *slopes).holds)


def _reported(case: Case, scalar: Scalar, kind: str, rows: Sequence[int], on_constraints: bool) -> Decided:
    """The decision with the equations of motion that were used, in words; wrong if others than they satisfy it."""
    n = len(case.rows)
    if kind == "motion" and (why := _has_other_solutions(case, scalar)) is not None:
        return why
    names = [case.system.symbols.u[k].name.removesuffix("'") for k in rows if k < n]
    found = []
    if kind != "motion":
        found.append("the equations of motion")
    elif len(names) > 1:
        found.append(f"a combination of the equations of {', '.join(names)}")
    elif names:
        constrained = on_constraints or any(k >= n for k in rows)
        factor = _factor(case, scalar, next(k for k in rows if k < n), case.closing if constrained else ())
        found += [f"the factor {factor}"] if factor else []
    if on_constraints or any(k >= n for k in rows):
        found.append("the constraints")
    return Decided(True, " and ".join(found))


def _has_other_solutions(case: Case, scalar: Scalar) -> Decided | None:
    """The decision on what is not linear in accelerations; None where it fixes them all the same.

    A function f with 2 f' f''' = 3 f''^2 is a fraction of two linear ones: it vanishes in one place alone.
    """
    slopes = gradient(scalar, case.forced)
    if not any(depends_on(slope, case.forced) for slope in slopes):
        return None
    opposite = {x: -y for x, y in case.phase.unknowns.items()}
    if is_zero_everywhere(case.system, *substituted((scalar,), opposite)).holds:
        return Decided(False, why=SIGNLESS)
    for a, first in zip(case.forced, slopes, strict=True):
        second = derivative(first, a)
        if not is_zero_everywhere(case.system, 2 * first * derivative(second, a) - 3 * second * second).holds:
            return Decided(
                None, "it follows from the equations of motion, but accelerations may satisfy it that do not"
            )
    return None


def _factor(case: Case, scalar: Scalar, row: int, closing: ScalarRow) -> str:
    """The factor by which the author multiplied the equation; "" where that is 1.

    Args:
        closing: rows of the constraints that were added to it: of what stands in none of them the slopes are compared.
    """
    x = case.leading(case.rows[row], closing)
    if x is None:
        return ""
    quotient = over(derivative(scalar, x), derivative(case.rows[row], x))
    (factor,) = case.edits.written((quotient,))
    return "" if type(factor) is not Node and factor == 1 else readable_text(factor) or "of the state"


def _integral(case: Case, scalar: Scalar) -> Decided | None:
    """The decision on what stays constant along the motion; None: it does not."""
    held = stays_constant(case, scalar)
    if not held:
        return None
    symbols = case.system.symbols
    constants = [x for x in (symbols.unknowns or {}).values() if depends_on(scalar, (x,))]
    if constants:
        return Decided(True, f"a first integral of the motion{while_(held)}")
    begins = case.starts_at_zero(scalar)
    if begins is None:
        return Decided(None, "it stays constant along the motion, but where this starts is not known")
    if begins:
        return Decided(True, f"the first integral from the start{while_(held)}")
    return Decided(False, while_(held).removeprefix(", "), CONSTANT)


def _integral_of_positions(case: Case, scalar: Scalar) -> Decided | None:
    """The decision on a function of positions and time whose rate vanishes by the constraints; None: it is none."""
    symbols = case.system.symbols
    if not depends_on(scalar, symbols.q) or depends_on(scalar, (*symbols.u, *case.forced)):
        return None
    try:
        (rate,) = case.system.scope.time_derivative((scalar,))
    except DerivationError:
        return None
    if not is_zero_everywhere(case.system, rate).holds or not case.starts_at_zero(scalar):
        return None
    return Decided(True, "the constraints, integrated from the start")


def stays_constant(case: Case, scalar: Scalar) -> Extent:
    """The pieces in which a scalar with speeds in it is a first integral."""
    speeds = case.system.symbols.u
    if not depends_on(scalar, speeds) or is_zero_everywhere(case.system, *gradient(scalar, speeds)).holds:
        return Extent(False)
    try:
        (rate,) = case.system.scope.with_accelerations((scalar,))
    except DerivationError:
        return Extent(False)
    follows = case.follows(rate, within=True)
    return Extent(True) if follows.holds else follows.held


# -- what the file has beside its symbols --------------------------------------------------------------


def with_values_of_file(case: Case, written: HandEquation, kind: str, scalar: Scalar) -> Decided | None:
    """Right where the numbers in it are values of the file: of parameters that it does not name; if not of these alone
    of all, where it speaks in numbers."""
    scalars = (scalar, *case.rows)
    for known in (case.meant_by_numbers(written, scalars), case.meant_as_a_whole(written, scalars)):
        if known and (found := _holds_with(case, kind, scalar, known)) is not None:
            return Decided(True, f"{found.from_start}{values_reported(known)}{while_(found.held)}")
    return None


def values_reported(values: Mapping[Node, Scalar]) -> str:
    """the values of the file: m = 1, g = 9.81"""
    return "the values of the file: " + ", ".join(f"{x.name} = {readable_text(value)}" for x, value in values.items())


def with_definitions(case: Case, kind: str, scalar: Scalar) -> Decided | None:
    """Right where parameters are replaced by the formulas that the file gives for them."""
    known = case.definitions
    used = [x for x in known if any(depends_on(y, (x,)) for y in (scalar, *case.rows))]
    found = _holds_with(case, kind, scalar, known) if used else None
    if found is None:
        return None
    return Decided(
        True, f"{found.from_start}what the file says of {', '.join(x.name for x in used)}{while_(found.held)}"
    )


def by_balance(case: Case, kind: str, scalar: Scalar) -> Decided | None:
    """Right where the unknowns of the model are what balance makes them."""
    held = [name for name, x in case.system.symbols.unknowns.items() if depends_on(scalar, (x,))]
    with suppress(DerivationError):
        if held and truth_of(case, case.solved(scalar), kind).holds:
            return Decided(True, f"what balance says of {', '.join(held)}")
    return None


def by_what_is_given(case: Case, written: HandEquation) -> Decided | None:
    """Right where it follows from the constraints, or from given motions, of coordinates that hang on others or on
    time."""
    parts = {name.rstrip("'"): case.model.coordinates.get(name.rstrip("'")) for name in written.names}
    given = [f"the given motion of {name}" for name, part in parts.items() if part is not None and part.driven]
    constrained = ["the constraints"] if any(part is not None and part.dependent for part in parts.values()) else []
    return Decided(True, " and ".join([*constrained, *given])) if constrained or given else None


@dataclass(frozen=True)
class HoldsWith:
    """The extent in which an equation holds with nodes replaced.

    Args:
        held: in which pieces.
        from_start: "the motion from the start, with " where it does in that motion alone, else "".
    """

    held: Extent = Extent(True)
    from_start: str = ""


FROM_START = "the motion from the start, with "


def _holds_with(case: Case, kind: str, scalar: Scalar, known: Mapping[Node, Scalar]) -> HoldsWith | None:
    """The extent in which it holds with nodes replaced, in the equations of the case too; None: it does not hold.

    Args:
        kind: that of the equation, or "rate": of a scalar that stays constant, in whichever pieces it does.
    """
    (plain, *rows) = substituted((scalar, *case.rows, *case.closing), known)
    if is_zero_everywhere(case.system, plain).holds:
        return None if kind in ("motion", "rate") else HoldsWith()
    n = len(case.rows)
    own, closing = ([linear_row(x, case.forced)[0] for x in some] for some in (rows[:n], rows[n:]))
    row, linear = linear_row(plain, case.forced)
    if rows and linear:
        found = combination(case.system, row, own, closing, within=kind == "rate")
        if found.holds or found.held:
            return HoldsWith(Extent(True) if found.holds else found.held)
    held = _by_integrals(case, scalar, known)[1] if kind in ("motion", "rate") else Extent(False)
    if held.everywhere or (held and kind not in EVERY_PIECE):
        return HoldsWith(held, FROM_START)
    if kind not in ("law", "energy") or not case.start or not depends_on(scalar, case.system.symbols.u):
        return None
    try:
        (rate,) = case.system.scope.with_accelerations((plain,))
    except DerivationError:
        return None
    steady = _holds_with(case, "rate", rate, known) if case.starts_at_zero(plain) else None
    return None if steady is None else HoldsWith(steady.held, FROM_START)


def on_one_side(case: Case, written: HandEquation, kind: str, scalar: Scalar) -> Decided | None:
    """Right where sizes |x| of the model, which the author wrote as x or -x, have that sign; None: that is not so."""
    sizes = sizes_in(case, written, scalar)
    if not sizes or len(sizes) > MOST_SIZES:
        return None
    for signs in product(*(_signs(case, inside) for inside in sizes.values())):
        known = {x: sign * inside for (x, inside), sign in zip(sizes.items(), signs, strict=True)}
        if found := _holds_with(case, kind, scalar, known):
            reported = dict.fromkeys(
                f"{readable_text(inside)} {'>' if sign > 0 else '<'} 0"
                for inside, sign in zip(sizes.values(), signs, strict=True)
            )
            up_to = f"{found.from_start}what holds where {' and '.join(reported)}"
            return Decided(True, up_to if found.held.everywhere else f"{up_to} and {found.held.text}")
    return None


def sizes_in(case: Case, written: HandEquation, scalar: Scalar) -> dict[Node, Scalar]:
    """Sizes of the model, |x| and sqrt(x^2), by what they are of; {} where the author writes roots and sizes himself.

    The author's own are as they are written: of them no sign is chosen.
    """
    scope = case.system.scope
    graph, rates = scope.graph, {f"{z.name}'" for z in scope.symbols.z}
    meant = {name: x for name, x in scope.names.items() if name not in rates}
    own = case.evaluated(
        written.difference,
        {**{name: graph.symbol(f"({name})") for name in written.names}, **meant},
        lambda call: graph.symbol(f"({call})"),
    )
    if any(x.op in SIDED and symbols_of((x,)) for x in order((own,))):
        return {}
    found: dict[Node, Scalar] = {}
    for x in order((scalar, *case.rows)):
        form = x if x.op == "abs" else case.edits.written((x,))[0] if x.op == "sqrt" else 0
        sizes = [y for y in order((form,)) if y.op in ("abs", "sqrt")]
        if sizes and all(y.op == "abs" for y in sizes):
            found[x] = substituted((form,), {y: y.args[0] for y in sizes})[0]
    return found


def signs_at_start(case: Case, sizes: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """The sizes whose sign the start decides, with it."""
    signs = {x: _signs(case, inside) for x, inside in sizes.items()}
    return {x: signs[x][0] * inside for x, inside in sizes.items() if len(signs[x]) == 1}


def directions_at_start(case: Case, written: HandEquation) -> dict[Node, Scalar]:
    """sign(x) in the equations of motion, which the author does not write, as it is at the start."""
    own = {what[0] for side in (written.left, written.right) for kind, what in side.code if kind == "function"}
    found: dict[Node, Scalar] = {}
    for x in order(case.rows) if "sign" not in own else ():
        if x.op == "sign":
            signs = _signs(case, substituted((x.args[0],), case.start)[0])
            found |= {x: signs[0]} if len(signs) == 1 else {}
    return found


def _signs(case: Case, inside: Scalar) -> tuple[int, ...]:
    """The sign of x at the start, where coordinates and values decide it; else either."""
    if depends_on(inside, (*case.system.symbols.u, *case.system.symbols.a)):
        return (1, -1)
    values = {case.system.symbols.parameters[n]: float(x) for n, x in case.model.exact_parameters().items()}
    try:
        (value,) = evaluate(substituted((inside,), case.start), values, FLOAT)
    except (NoValue, ZeroDivisionError, DerivationError):
        return (1, -1)
    return (1,) if value > 0 else (-1,) if value < 0 else (1, -1)


# -------- rest ------------------------------------------------------------------------------------------------
# An equation of one coordinate alone -> whether all places that satisfy it are equilibria.
#
# Rest of what is free: driven coordinates go on as they are driven. The roots of the equation are sought in numbers,
# at several values of the parameters, and at each of them the forces must balance.


GRID, BISECTED, VALUES = 400, 60, 3
WIDEST = 3.5  # times the size of a coordinate at the start: as far as roots are sought


def balance_at_rest(case: Case, scalar: Scalar) -> tuple[Node, Scalar] | None:
    """(the coordinate, its equation of motion at rest); None where there are several, constraints, or time stands in
    it."""
    symbols = case.system.symbols
    if len(case.rows) != 1 or case.closing or symbols.lam or case.system.free is not None:
        return None
    free = [q for q in symbols.q if not case.model.coordinates[q.name].driven]
    still = dict.fromkeys((*symbols.u, *symbols.a), 0)
    (row,) = substituted(case.rows, still)
    others = [x for x in (symbols.t, *symbols.q) if x not in free]
    if len(free) != 1 or depends_on(scalar, others) or not depends_on(scalar, free):
        return None
    if depends_on(row, others):  # cos(psi)^2 + sin(psi)^2 does not
        if not is_zero_everywhere(case.system, *gradient(row, others)).holds:
            return None
        (row,) = substituted((row,), dict.fromkeys(others, 0))
    return free[0], row


def is_of_rest(case: Case, scalar: Scalar) -> bool | None:
    """True if every place that satisfies scalar = 0 is an equilibrium; None: it is not decided so."""
    found = balance_at_rest(case, scalar)
    if found is None:
        return None
    q, row = found
    seen = 0
    for state in islice(states_of(case.system, (scalar, row), on_constraints=True), VALUES):
        values = {x: float(value) for x, value in state.items()}
        for root in sign_changes(scalar, q, values):
            near = _at((row,), q, values, np.array([root]))[0, 0]
            size = np.nanmax(np.abs(_at((row,), q, values, _grid(values[q]))))
            if not abs(near) <= tolerances.SAME_EIGENVALUE * size:
                return None if case.system.symbols.z else False  # states may be such that it balances there
            seen += 1
    return True if seen else None


def sign_changes(scalar: Scalar, q: Node, values: dict[Node, float]) -> list[float]:
    """Places at which it changes its sign by going through zero, the nearest to the value of q first."""
    grid = _grid(values[q])
    (height,) = _at((scalar,), q, values, grid)
    found = []
    places = [(a, b) for a, b, x, y in zip(grid, grid[1:], height, height[1:], strict=False) if x * y <= 0]
    for low, high in places:
        (first,) = _at((scalar,), q, values, np.array([low]))[0]
        for _ in range(BISECTED):
            middle = (low + high) / 2
            (x,) = _at((scalar,), q, values, np.array([middle]))[0]
            low, high, first = (middle, high, x) if x * first > 0 else (low, middle, first)
        (left,) = _at((scalar,), q, values, np.array([(low + high) / 2]))[0]
        if abs(left) <= tolerances.CARRIED * np.nanmax(np.abs(height)):
            found.append((low + high) / 2)
    return sorted(found, key=lambda root: abs(root - values[q]))


def _grid(near: float) -> Any:
    """Places on both sides of zero, none of them round."""
    wide = WIDEST * max(1.0, abs(near))
    return np.linspace(-wide - 0.0137, wide + 0.0271, GRID)


def _at(scalars: tuple[Scalar, ...], q: Node, values: dict[Node, float], places: Any) -> Any:
    with np.errstate(all="ignore"):
        found = evaluate(scalars, {**{x: np.float64(y) for x, y in values.items()}, q: places}, ARRAYS)
    return np.array([np.broadcast_to(np.asarray(x, dtype=float), places.shape) for x in found])


# -------- course ----------------------------------------------------------------------------------------------
# A coordinate, or its rate, as a function of time -> whether the equations of motion hold with it, and the start.


MOST_PLACES = 14  # of a course that are changed


@dataclass(frozen=True)
class Course:
    """A coordinate q = f(t) put into the equations of motion, or a state into its rate.

    Args:
        known: q and its rates, or the state, as functions of time.
        left: what is left of the equations of motion, or of the rate of the state, that know nothing else.
        holds: whether that is nothing; None: undecided, or they do not decide it alone.
        begins: whether it starts as the model does; None: where that starts is not known.
        held: in which pieces it holds.
        values: of the file, that its numbers are: it holds with these.
        state: into whose rate it is put; "": into the equations of motion.
    """

    known: Mapping[Node, Scalar]
    left: ScalarRow
    holds: bool | None
    begins: bool | None
    held: Extent = Extent(True)
    values: Mapping[Node, Scalar] = field(default_factory=dict)
    state: str = ""


def course_of(case: Case, written: HandEquation, constants: Mapping[str, Scalar]) -> Course | None:
    """The course that an equation gives; None: it gives none.

    Args:
        constants: names of the author's own: where there are some, any start will do.
    """
    name = written.left.code[0][1] if len(written.left.code) == 1 and written.left.code[0][0] == "name" else ""
    coordinates, states = case.model.coordinates, case.model.states
    moving = {*coordinates, *(f"{q}'" for q in coordinates), *(f"{q}''" for q in coordinates), *case.model.speeds}
    moving |= {*states, *(f"{z}'" for z in states)}
    of = name.removesuffix("'")
    if of not in (*coordinates, *states) or "t" not in written.right.names or written.right.names & moving:
        return None
    if of in coordinates and coordinates[of].driven:
        return None
    x = case.value(written.right, constants)
    found = _put_in(case, name, x, any_start=bool(constants))
    if found is None or (found.holds and found.begins is not False):
        return found
    values = case.meant_by_numbers(written, (x, *case.rows, *case.start.values()))
    other = _put_in(case, name, x, any_start=bool(constants), values=values) if values else None
    return other if other is not None and other.holds and other.begins else found


def _put_in(
    case: Case, name: str, x: Scalar, *, any_start: bool, values: Mapping[Node, Scalar] | None = None
) -> Course | None:
    """A coordinate or its rate, by its name, as a function of time put into the equations of motion.

    Args:
        values: of parameters, put in too.
    """
    values = values or {}
    (x,) = substituted((x,), values)
    symbols, scope, known = case.system.symbols, case.system.scope, dict[Node, Scalar]()
    if name.removesuffix("'") in case.model.states:
        put_in, rest, begin, alone = case.put_into_rate(name, x, values)
        begins = True if any_start else case.starts_at_zero(begin)
        holds = is_zero_everywhere(case.system, rest).holds if alone else None
        return Course(put_in, (rest,), holds, begins, values=values, state=name.removesuffix("'"))
    for rate in (name, f"{name}'", f"{name}''")[: 3 - name.count("'")]:
        node = scope.names[rate]
        if type(node) is Node and node.op == "symbol":
            known[node] = x
        x = derivative(x, symbols.t)
    given = tuple(scope.names[x.name] - value for x, value in known.items() if not x.name.endswith("''"))
    given = substituted(substituted(given, case.start), values) if values else given
    begins = True if any_start else case.starts_at_zero(*given)
    others = [x for x in symbols.x if x not in known]
    if not case.rows:
        return None
    left = [row for row in substituted(case.rows, {**known, **values}) if not depends_on(row, (*others, *case.forced))]
    a = scope.names[name.removesuffix("'") + "''"]
    if not left and type(a) is Node and a in known:  # the others move with it: what is left of all equations together
        (found,) = substituted((known[a] - case.phase.eliminated(a),), {**known, **values})
        left = [] if depends_on(found, others) else [found]
    inputs = {node: case.system.inputs[n] for n, node in symbols.inputs.items()}
    mine = substituted(tuple(left), inputs)
    if not mine and name.endswith("'") and not symbols.z:
        return None  # its coordinate stands in the equations: this is no course
    if not mine:
        return Course(known, mine, None, begins, values=values)
    follows = combination(case.system, mine, (), within=True)
    if follows.holds is False and follows.held:  # friction has its direction as long as the body slides on
        return Course(known, mine, True, begins, follows.held, values)
    return Course(known, mine, follows.holds, begins, values=values)


def _constants(case: Case) -> tuple[Node, ...]:
    return (*case.system.symbols.parameters.values(), case.system.symbols.t)


# -------- small -----------------------------------------------------------------------------------------------
# An equation of small motions -> the model's equations, linearized about the same place: beside what it is wrong.
#
#     E = E_0 + dE/dq (q - q_0) + dE/du u + dE/da a
#
# Who linearizes before he makes another mistake has left out nothing of that mistake beyond the first order, either.


NAME = "the whole equation"
MOST_DEGREES_OF_FREEDOM = 4  # of a system whose equations are linearized with all that may be wrong in them
RANK = TERMS + 2 * SHORTER


@dataclass(frozen=True)
class InSmallMotions:
    """A comparison with the linearized equations.

    Args:
        whole: the comparison with the equations themselves.
        near: the same with the linearized ones.
    """

    whole: Comparison
    near: Comparison

    def explained(self, number: int) -> list[Explanation]:
        """Explanations by `number` mistakes, of which linearization is one: alone, or with number - 1 others."""
        rows = tuple(x - y for x, y in zip(self.near.rows, self.whole.rows, strict=True))
        text = "sines, cosines and products of speeds are those of a small motion: the equation is linearized"
        share = Share(Mistake(NAME, "approximation", rows, RANK, open=False, text=text), Fraction(1))
        cost = PLAINEST + RANK
        if number == 1:
            alone = Explanation((share,), 0, cost)
            return [alone] if self.whole.proves(alone) else []
        found = self.near.explained(number - 1)
        return [Explanation((share, *each.shares), each.row, cost + each.cost, each.scale) for each in found]

    def difference(self, explanation: Explanation) -> str:
        """The excess in the equation."""
        return self.whole.difference(explanation)


def small_motions(whole: Comparison) -> Iterator[InSmallMotions]:
    """The comparisons with linearized equations of an equation that is linear, where the model's are not."""
    symbols = whole.case.system.symbols
    moving = (*symbols.x, *symbols.a)
    if whole.what != "motion" or whole.case.closing or len(whole.rows) > MOST_DEGREES_OF_FREEDOM or whole.is_long:
        return
    if not is_linear((whole.scalar,), moving) or is_linear(whole.rows, moving):
        return
    still = dict.fromkeys(moving, 0)
    places = [{**still, **place} for place in ({}, *whole.case.places_of_rest)]
    for place in [place for k, place in enumerate(places) if place not in places[:k]]:
        try:
            rows = linearized(whole.rows, place)
        except DerivationError:
            continue  # it has no value there
        if not any(map(is_zero, rows)):
            yield InSmallMotions(whole, replace(whole, rows=rows, near=place))
