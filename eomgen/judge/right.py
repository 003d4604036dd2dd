"""An equation over the symbols of a case -> whether it is right, and up to what."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import product

from eomgen.errors import DerivationError
from eomgen.judge.case import Case
from eomgen.judge.decision import combination, is_zero_everywhere, linear_row, vanish_nearly
from eomgen.judge.reading import HandEquation
from eomgen.judge.terms import LONG
from eomgen.mechanics.equations.pieces import EVERYWHERE, NOWHERE, Extent
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import depends_on, derivative, gradient, substituted, symbols_of
from eomgen.symbolic.expression.exact_numbers import exact
from eomgen.symbolic.expression.formula import Call
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import readable_text

SIDED = ("abs", "sqrt", "sign", "min", "max", "asin", "acos", "atan", "atan2")  # of one side of their domain alone
MOST_SIZES = 2  # sizes |x| of which either sign is tried

EVERY_PIECE = ("motion", "acceleration")  # kinds of equations that must hold in every piece
IDENTITY, CONSTANT, SIGNLESS = "identity", "constant", "signless"


@dataclass(frozen=True)
class Decided:
    """Whether an equation is right.

    Args:
        holds: yes, no, or None: nothing decided it.
        up_to: what had to be used, in words; "" where nothing.
        why: of what is not right: IDENTITY, CONSTANT, SIGNLESS, "" else.
    """

    holds: bool | None
    up_to: str = ""
    why: str = ""


def truth_of(case: Case, scalar: Scalar, kind: str) -> Decided:
    """Whether a scalar vanishes in every motion of the case, and what had to be used to see it."""
    found = is_zero_everywhere(case.system, scalar)
    if found.holds:
        if kind == "motion":
            return Decided(False, why=IDENTITY)
        return Decided(True, "the ties" if found.on_ties else "")
    undecided = found.holds is None
    if kind == "energy" and _is_constant_of_potential(case, scalar):
        return Decided(True, "a constant of the potential energy")
    if case.equations is None:
        return Decided(None if undecided else False)
    if depends_on(scalar, case.forced):
        follows = case.follows(scalar)
        if follows.holds:
            return _told(case, scalar, kind, follows.rows, follows.on_ties)
        undecided = undecided or follows.holds is None
    if kind in ("law", "energy") and (integral := _integral(case, scalar)):
        return integral
    moving = (*case.system.symbols.u, *case.system.symbols.a)
    if depends_on(scalar, moving):
        told, held = _by_integrals(case, scalar, {})
        if held.everywhere or (held and kind not in EVERY_PIECE):
            return Decided(True, f"{told} from the start{while_(held)}")
    return Decided(None if undecided else False)


def _by_integrals(case: Case, scalar: Scalar, known: Mapping[Node, Scalar]) -> tuple[str, Extent]:
    """(by which integrals from the start a scalar vanishes where nodes are replaced, in words, where it does)."""
    if depends_on(scalar, case.system.symbols.lam):
        return "", NOWHERE
    for told in ("the momenta", "the energy theorem and the momenta"):
        by_integrals = case.by_momenta if told == "the momenta" else case.speeds
        if not by_integrals:
            continue
        speeds, held = by_integrals
        started = substituted((case.phase.eliminated(scalar),), {**speeds, **known})
        if not case.starting.is_exact:
            if held.everywhere and vanish_nearly(case.system, started):
                return told, EVERYWHERE
            continue
        of_forces = depends_on(scalar, case.system.symbols.a)  # equations of motion hold in every piece
        found = combination(case.system, started, (), within=not of_forces)
        if found.holds:
            return told, held
        if found.held and (both := held & found.held):
            return told, both
    return "", NOWHERE


def while_(held: Extent) -> str:
    """ ", while y >= 0" of what holds in some pieces alone."""
    return "" if held.everywhere else f", while {held.text}"


def in_its_piece(case: Case, scalar: Scalar) -> str:
    """ "while y >= 0", where an equation of motion holds in the piece of the start and not in all; "": in neither."""
    follows = case.follows(scalar, within=True) if depends_on(scalar, case.forced) else None
    return f"while {follows.held.text}" if follows is not None and follows.held else ""


def says_nothing(case: Case, written: HandEquation) -> bool:
    """Whether it holds whatever its names mean, functions of the motion included: 0 = 0."""
    graph, known = case.system.scope.graph, dict[str, Node]()

    def opaque(call: Call) -> Node:
        return known.setdefault(str(call), graph.symbol(f"({call})"))

    own = case.system.scope.names
    plain = {name for name, x in own.items() if type(x) is Node and x.op in ("symbol", "pi")}
    names = {name: graph.symbol(f"({name})") for name in written.names - plain - {"t", "pi"}}
    scalar = case.evaluated(written.difference, {**own, **names}, opaque)
    found = is_zero_everywhere(case.system, scalar)
    return bool(found.holds) and not found.on_ties


def _is_constant_of_potential(case: Case, scalar: Scalar) -> bool:
    symbols = case.system.symbols
    slopes = gradient(scalar, (symbols.t, *symbols.q, *symbols.u))
    return bool(is_zero_everywhere(case.system, *slopes).holds)


def _told(case: Case, scalar: Scalar, kind: str, rows: Sequence[int], on_ties: bool) -> Decided:
    """What was used of the equations of motion, in words; whether they alone satisfy it."""
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
        tied = on_ties or any(k >= n for k in rows)
        factor = _factor(case, scalar, next(k for k in rows if k < n), case.closing if tied else ())
        found += [f"the factor {factor}"] if factor else []
    if on_ties or any(k >= n for k in rows):
        found.append("the ties")
    return Decided(True, " and ".join(found))


def _has_other_solutions(case: Case, scalar: Scalar) -> Decided | None:
    """Of what is not linear in accelerations: None where it fixes them all the same.

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
    """What the author multiplied the equation by; "" where that is 1.

    Args:
        closing: rows of the ties that were added to it: of what stands in none of them the slopes are compared.
    """
    x = case.leading(case.rows[row], closing)
    if x is None:
        return ""
    quotient = over(derivative(scalar, x), derivative(case.rows[row], x))
    factor = legible(quotient, Work.FORMULA, case.system.scope.positive, LONG)
    return "" if type(factor) is not Node and factor == 1 else readable_text(factor) or "of the state"


def _integral(case: Case, scalar: Scalar) -> Decided | None:
    """Of what stays constant along the motion: whether it is right; None: it does not."""
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


def stays_constant(case: Case, scalar: Scalar) -> Extent:
    """Where a scalar with speeds in it is a first integral."""
    speeds = case.system.symbols.u
    if not depends_on(scalar, speeds) or is_zero_everywhere(case.system, *gradient(scalar, speeds)).holds:
        return NOWHERE
    try:
        (rate,) = case.system.scope.with_accelerations((scalar,))
    except DerivationError:
        return NOWHERE
    follows = case.follows(rate, within=True)
    return EVERYWHERE if follows.holds else follows.held


# -- what the file has beside its symbols --------------------------------------------------------------


def with_values_of_file(case: Case, written: HandEquation, kind: str, scalar: Scalar) -> Decided | None:
    """Right where the numbers in it are values of the file: of parameters that it does not name."""
    missing = meant_by_numbers(case, written, (scalar, *case.rows))
    found = _holds_with(case, kind, scalar, missing) if missing else None
    return None if found is None else Decided(True, f"{found.from_start}{values_told(missing)}{while_(found.held)}")


def meant_by_numbers(case: Case, written: HandEquation, scalars: Sequence[Scalar]) -> dict[Node, Scalar]:
    """Values of parameters in scalars that an equation does not name; {} where none of its numbers is one of these."""
    parameters = case.system.symbols.parameters
    known = {name: exact(x) for name, x in exact_parameters(case.model).items() if not isinstance(x, float)}
    missing: dict[Node, Scalar] = {
        x: known[n]
        for n, x in parameters.items()
        if n in known and n not in written.names and depends_on_one(scalars, x)
    }
    sides = (written.left, written.right)
    numbers = {abs(what) for side in sides for kind, what in side.code if kind == "number"}
    return missing if numbers & {abs(x) for x in missing.values() if x not in (0, 1, -1)} else {}


def values_told(values: Mapping[Node, Scalar]) -> str:
    """the values of the file: m = 1, g = 9.81"""
    return "the values of the file: " + ", ".join(f"{x.name} = {readable_text(value)}" for x, value in values.items())


def with_definitions(case: Case, kind: str, scalar: Scalar) -> Decided | None:
    """Right where parameters are replaced by the formulas that the file gives for them."""
    known = case.definitions
    used = [x for x in known if depends_on_one((scalar, *case.rows), x)]
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
    """Right where it follows from the ties, or from given motions, of coordinates that hang on others or on time."""
    parts = {name.rstrip("'"): case.model.coordinates.get(name.rstrip("'")) for name in written.names}
    given = [f"the given motion of {name}" for name, part in parts.items() if part is not None and part.driven]
    tied = ["the ties"] if any(part is not None and part.dependent for part in parts.values()) else []
    return Decided(True, " and ".join([*tied, *given])) if tied or given else None


@dataclass(frozen=True)
class HoldsWith:
    """That an equation holds with nodes replaced.

    Args:
        held: in which pieces.
        from_start: "the motion from the start, with " where it does in that motion alone, else "".
    """

    held: Extent = EVERYWHERE
    from_start: str = ""


FROM_START = "the motion from the start, with "


def _holds_with(case: Case, kind: str, scalar: Scalar, known: Mapping[Node, Scalar]) -> HoldsWith | None:
    """How it holds with nodes replaced, in the equations of the case too; None: it does not.

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
            return HoldsWith(EVERYWHERE if found.holds else found.held)
    held = _by_integrals(case, scalar, known)[1] if kind in ("motion", "rate") else NOWHERE
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


def depends_on_one(scalars: Sequence[Scalar], x: Node) -> bool:
    return any(depends_on(each, (x,)) for each in scalars)


def on_one_side(case: Case, written: HandEquation, kind: str, scalar: Scalar) -> Decided | None:
    """Right where sizes |x| of the model, which the author wrote as x or -x, have that sign; None: that is not so."""
    sizes = sizes_in(case, written, scalar)
    if not sizes or len(sizes) > MOST_SIZES:
        return None
    for signs in product(*(_signs(case, inside) for inside in sizes.values())):
        known = {x: sign * inside for (x, inside), sign in zip(sizes.items(), signs, strict=True)}
        if found := _holds_with(case, kind, scalar, known):
            told = [
                f"{readable_text(inside)} {'>' if sign > 0 else '<'} 0"
                for inside, sign in zip(sizes.values(), signs, strict=True)
            ]
            up_to = f"{found.from_start}what holds where {' and '.join(told)}"
            return Decided(True, up_to if found.held.everywhere else f"{up_to} and {found.held.text}")
    return None


def sizes_in(case: Case, written: HandEquation, scalar: Scalar) -> dict[Node, Scalar]:
    """Sizes of the model, |x| and sqrt(x^2), by what they are of; {} where the author writes roots and sizes himself.

    The author's own are as they are written: of them no sign is chosen.
    """
    graph = case.system.scope.graph
    own = case.evaluated(
        written.difference,
        {**{name: graph.symbol(f"({name})") for name in written.names}, **case.system.scope.names},
        lambda call: graph.symbol(f"({call})"),
    )
    if any(x.op in SIDED and symbols_of((x,)) for x in order((own,))):
        return {}
    found: dict[Node, Scalar] = {}
    for x in order((scalar, *case.rows)):
        form = (
            x if x.op == "abs" else legible(x, Work.FORMULA, case.system.scope.positive, LONG) if x.op == "sqrt" else 0
        )
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
    values = {case.system.symbols.parameters[n]: float(x) for n, x in exact_parameters(case.model).items()}
    try:
        (value,) = evaluate(substituted((inside,), case.start), values, FLOAT)
    except (NoValue, ZeroDivisionError, DerivationError):
        return (1, -1)
    return (1,) if value > 0 else (-1,) if value < 0 else (1, -1)
