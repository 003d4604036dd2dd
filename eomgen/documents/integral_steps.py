"""Equations of motion -> the steps after the equations of motion: cyclic coordinates, energy, laws of motion."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from eomgen.documents.bounded import page
from eomgen.documents.energy_steps import energies_by_parts
from eomgen.documents.reading import Reader
from eomgen.documents.setting_steps import listed_symbols
from eomgen.documents.statements import Formula, Law, Name, Partial, Piece, Prose, Statement, Step, prose
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.explicit_accelerations import short_accelerations
from eomgen.mechanics.equations.pieces import Extent
from eomgen.mechanics.first_integrals.constants_of_motion import Constant, momenta_of_the_whole
from eomgen.mechanics.first_integrals.integrals import (
    Integral,
    energy_integral,
    momentum_integrals,
    work_of_constant_forces,
)
from eomgen.mechanics.first_integrals.laws import laws_of_motion
from eomgen.mechanics.initial_state.exact_start import known_start
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.print.text import text_size, to_text

MOST_SPEEDS = 6  # of a system whose laws of motion are sought
LONGEST_LAW = 400  # characters of a law that is printed

ENERGY = Law("T + V", "T + V")
ENERGY_AND_WORK = Law("T + V - W", "T + V - W")
AT_MOST, AT_LEAST = Law("<=", r"\le"), Law(">=", r"\ge")
JACOBI = Law("sum u_k*dT/du_k - T + V", r"\sum u_{k} \frac{\partial T}{\partial u_{k}} - T + V")


def integral_steps(
    equations: EquationsOfMotion, reader: Reader, in_time: EquationsOfMotion | None = None
) -> tuple[Step, ...]:
    """First integrals, and laws of motion from the model's start; no step where there are none.

    Args:
        in_time: the same with all that is driven as functions of time; None: they are so.
    """
    laws = (
        _laws(equations, reader)
        if in_time is None
        else _laws(in_time, Reader(gathers=reader.gathers, positive=reader.positive))
    )
    return (*_integrals(equations, reader), *laws)


def _integrals(equations: EquationsOfMotion, reader: Reader) -> tuple[Step, ...]:
    symbols = equations.symbols
    cyclic = [each for each in momentum_integrals(equations) if not depends_on(each.expression, (symbols.t,))]
    statements: list[Statement] = []
    if cyclic:
        moving = {q.name: q for q in symbols.q}
        speeds = {u.name.removesuffix("'"): u for u in symbols.u}
        rates = [each for each in cyclic if speeds[each.coordinate].name != each.coordinate]
        for held, group in groupby(rates, key=lambda each: each.held):
            each_held = tuple(group)
            statements.append(_cyclic(tuple(moving[each.coordinate] for each in each_held), held))
            pairs = [(Partial(Name("T"), speeds[each.coordinate]), each.expression) for each in each_held]
            statements += page(reader, pairs)
        for each in (other for other in cyclic if other not in rates):
            words = ("The momentum of the speed ", speeds[each.coordinate], " stays constant")
            statements.append(prose(*words, *while_words(each.held), ":"))
            statements += page(reader, [(Partial(Name("T"), speeds[each.coordinate]), each.expression)])
    energies = energy_integral(equations)
    for energy in energies:
        statements += _energy(reader, equations, energy)
    statements += _of_the_whole(equations, reader, [each.expression for each in (*cyclic, *energies)])
    return (Step("integrals", "First integrals", tuple(statements)),) if statements else ()


def _of_the_whole(equations: EquationsOfMotion, reader: Reader, known: Sequence[Scalar]) -> list[Statement]:
    """Momentum and angular momentum of all bodies together, ground axes, where they stay."""
    statements: list[Statement] = []
    found = momenta_of_the_whole(equations, known)
    for about, group in groupby(found, key=lambda each: (each.letter, each.about)):
        what = "momentum" if about[0] == "P" else f"angular momentum about {about[1]}"
        statements.append(prose(f"The {what}, in the axes of the ground, stays constant:"))
        statements += page(reader, [(_side(each), each.expression) for each in group])
    return statements


def _side(each: Constant) -> Name:
    return Name(f"{each.letter}_{each.axis}") if each.axis else Name(each.letter, power=2)


def _cyclic(coordinates: tuple[Node, ...], held: Extent) -> Prose:
    many = len(coordinates) > 1
    verb = ("s ", " are cyclic: their momenta stay") if many else (" ", " is cyclic: its momentum stays")
    if not held.everywhere:
        verb = ("s ", ": their momenta stay") if many else (" ", ": its momentum stays")
    return prose(
        f"The coordinate{verb[0]}", *listed_symbols(coordinates), f"{verb[1]} constant", *while_words(held), ":"
    )


def while_words(held: Extent) -> tuple[Piece, ...]:
    """ " while y >= 0" of what holds in some pieces alone."""
    words: list[Piece] = []
    for each in held.within:
        left, right = (x if type(x) is Node else to_text(x) for x in (each.left, each.right))
        words += [
            " and " if words else " while ",
            left,
            " ",
            AT_MOST if each.relation == "<=" else AT_LEAST,
            " ",
            right,
        ]
    return tuple(words)


def _energy(reader: Reader, equations: EquationsOfMotion, energy: Integral) -> list[Statement]:
    """T + V, or T + V - W, and that it stays constant; in words alone where it is written piece by piece."""
    law = ENERGY
    words: tuple[Piece, ...] = ("The energy ", ENERGY, " stays constant")
    if energy.name == "jacobi":
        law = JACOBI
        words = ("What moves by itself does so at a steady rate, and Jacobi's integral ", JACOBI, " stays constant")
    elif energy.expression is not equations.T + equations.V:
        law = ENERGY_AND_WORK
        words = ("The energy less the work of the constant forces, ", law, ", stays constant")
    words = (*words, *while_words(energy.held))
    if any(node.op == "select" for node in order((energy.expression,))):
        return [prose(*words, ".")]
    if law is not JACOBI:
        T, V = energies_by_parts(equations.system, reader, equations.T)
        parts = [T, V, *([-work_of_constant_forces(equations.system)] if law is ENERGY_AND_WORK else [])]
        return [prose(*words, ":"), *page(reader, [(law, reader.as_sum(energy.expression, parts))])]
    return [prose(*words, ":"), *page(reader, [(law, energy.expression)])]


def _laws(equations: EquationsOfMotion, reader: Reader) -> tuple[Step, ...]:
    """q(t) of the coordinates whose equations are solved in closed form."""
    system = equations.system
    symbols = system.symbols
    if not 0 < len(symbols.u) <= MOST_SPEEDS or symbols.inputs or system.free is not None:
        return ()
    accelerations = short_accelerations(equations)
    start = None if accelerations is None else known_start(system)
    laws = {} if accelerations is None or start is None else laws_of_motion(system, accelerations, start)
    free = {u.name.removesuffix("'") for u in symbols.u}
    found = [(q, laws[q]) for q in symbols.q if q in laws and q.name in free and text_size(laws[q]) <= LONGEST_LAW]
    if not found:
        return ()
    words = prose("From the start values, in closed form:")
    return (Step("laws", "Laws of motion", (words, *(Formula((q, _law(reader, x))) for q, x in found))),)


def _law(reader: Reader, x: Scalar) -> Scalar:
    """A law as it was found, which is shorter than multiplied out, with symbols for its roots."""
    return reader.with_symbols((x,))[0]
