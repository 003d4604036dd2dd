"""Formulas -> their terms, and what may stand in them in the place of a name or an angle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_form import TooLarge, legible, readable
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import linear_terms
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import readable_text

MOST_TERMS = 60  # of an equation that is looked at term by term


def terms_of(x: Scalar, positive: frozenset[Node]) -> tuple[Scalar, ...]:
    """The terms of a sum multiplied out, as they are written; () where they are too many."""
    if type(x) is not Node:
        return () if x == 0 else (x,)
    expansion = Expansion(x.graph, Work.FORMULA, positive)
    writer = Writer(expansion)
    try:
        written = writer.written(expansion.of(x))
    except TooLarge:
        return ()
    return tuple(writer.term(*each) for each in written) if len(written) <= MOST_TERMS else ()


LONG = 400  # characters of a term or a difference that is shown


def short_text(x: Scalar, positive: frozenset[Node]) -> str:
    """A scalar in its most legible form; "" where nobody would read it."""
    text = readable_text(legible(x, Work.FORMULA, positive, LONG)) or ""
    return text if len(text) <= LONG else ""


def is_product(t: Scalar, others: Sequence[Scalar]) -> bool:
    """Whether a term is what the square of a sum has beside its squares: t^2 = 4 a b, a cosine of an angle apart."""
    if type(t) is not Node:
        return False
    square = powers_of(t * t)
    for a, b in combinations([x for x in others if type(x) is Node and x is not t], 2):
        left = powers_of(over(t * t, a * b))
        if square and all(f.op in ("sin", "cos") for f in left):
            return True
    return False


def term_text(x: Scalar) -> str:
    """A term or an angle as a text."""
    return readable_text(readable(x, Work.FORMULA)) or "that is too long to be shown"


def wrong_parameters(held: Iterable[Node], known: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """What may happen to the parameters that are held: (kind of the cause, what replaces what, in words)."""
    mine = [x for x in known if x in {*held}]
    for x in mine:
        yield "missing_term", {x: 0}, f"{x.name} is left out"
        yield "sign", {x: -x}, f"{x.name} has the wrong sign"
        yield "factor", {x: 2 * x}, f"2*{x.name} stands where {x.name} is meant"
        yield "factor", {x: over(x, 2)}, f"{x.name}/2 stands where {x.name} is meant"
        for y in known:
            if y is not x:
                yield "wrong_quantity", {x: y}, f"{y.name} stands where {x.name} is meant"
                if y in mine and x.name < y.name:
                    yield "wrong_quantity", {x: y, y: x}, f"{x.name} and {y.name} are exchanged"


Powers = dict[Node, Fraction]


def powers_of(x: Scalar) -> Powers:
    """A product as {factor: power}, its number apart; of a root of a product with halves."""
    found: Powers = {}

    def gather(y: Scalar, k: Fraction) -> None:
        if type(y) is not Node:
            return
        if y.op == "neg":
            gather(y.args[0], k)
        elif y.op in ("mul", "div"):
            gather(y.args[0], k)
            gather(y.args[1], k if y.op == "mul" else -k)
        elif y.op == "pow" and type(y.args[1]) is not Node:
            gather(y.args[0], k * Fraction(y.args[1]))
        elif y.op == "sqrt":
            gather(y.args[0], k / 2)
        else:
            found[y] = found.get(y, Fraction(0)) + k

    gather(x, Fraction(1))
    return {f: k for f, k in found.items() if k}


# -- angles ------------------------------------------------------------------------------------------


def angles_in(scalars: Sequence[Scalar]) -> list[Node]:
    """What stands under sines and cosines."""
    found = [x.args[0] for x in order(scalars) if x.op in ("sin", "cos")]
    return list(dict.fromkeys(x for x in found if type(x) is Node))


def turned_angles(angle: Node, scalars: Sequence[Scalar]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """What may happen to an angle in scalars: (kind of the cause, what replaces sine and cosine, in words).

    What replaces one of them alone comes first; where the other does not stand there, no more is told.
    """
    held, seen = {x for x in order(scalars) if x.op in ("sin", "cos")}, list[dict[Node, Scalar]]()
    for kind, mapping, what in sorted(_turned(angle), key=lambda each: len(each[1])):
        there = {x: y for x, y in mapping.items() if x in held}
        if there and there not in seen:
            seen.append(there)
            yield kind, there, what


def _turned(angle: Node) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    graph = angle.graph
    sin, cos = graph.held("sin", (angle,)), graph.held("cos", (angle,))
    yield "wrong_axis", {sin: cos, cos: sin}, "sin and cos of {0} are exchanged: the angle is taken from the other axis"
    axis = "{0} is taken from the other axis"
    yield "wrong_axis", {sin: cos, cos: -sin}, f"cos stands for sin, sin with the opposite sign for cos: {axis}"
    yield "wrong_axis", {sin: -cos, cos: sin}, f"sin stands for cos, cos with the opposite sign for sin: {axis}"
    yield "wrong_axis", {sin: cos}, "cos stands for sin({0}): the angle is taken from the other axis"
    yield "wrong_axis", {cos: sin}, "sin stands for cos({0}): the angle is taken from the other axis"
    yield "sign", {sin: -sin}, "the sign of sin({0}) is wrong"
    yield "sign", {cos: -cos}, "the sign of cos({0}) is wrong"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        scaled = factor * angle
        mapping = {sin: graph.call("sin", scaled), cos: graph.call("cos", scaled)}
        yield "unit", mapping, f"{{0}} is taken in {how}"
    yield "factor", {cos: 1}, "cos({0}) is left out"
    yield "approximation", {sin: angle, cos: 1}, "sin({0}) and cos({0}) are those of a small angle"
    yield "approximation", {sin: angle}, "sin({0}) is replaced by the angle, as that of a small angle"
    yield "approximation", {sin: 0, cos: 1}, "{0} is taken as zero"
    yield "factor", {sin: 1}, "sin({0}) is left out"
    terms = linear_terms(angle)
    if len(terms) > 1:
        for atom in terms:
            if type(atom) is Node and atom.op == "symbol":
                other = substituted((angle,), {atom: -atom})[0]
                mapping = {sin: graph.call("sin", other), cos: graph.call("cos", other)}
                yield "sign", mapping, f"the sign of {atom.name} in the angle {{0}} is wrong"


def all_turned(angles: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """The same for several angles at once."""
    graph = angles[0].graph
    sines, cosines = ([graph.held(op, (x,)) for x in angles] for op in ("sin", "cos"))
    exchanged: dict[Node, Scalar] = {**dict(zip(sines, cosines, strict=True)), **dict(zip(cosines, sines, strict=True))}
    yield "wrong_axis", exchanged, "sin and cos are exchanged: the angles are taken from the other axes"
    small: dict[Node, Scalar] = {**dict(zip(sines, angles, strict=True)), **dict.fromkeys(cosines, 1)}
    yield "approximation", small, "sines and cosines are those of small angles"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        mapping: dict[Node, Scalar] = {
            graph.held(op, (x,)): graph.call(op, factor * x) for x in angles for op in ("sin", "cos")
        }
        yield "unit", mapping, f"the angles are taken in {how}"
