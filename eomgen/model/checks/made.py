"""Shapes and bodies made of parts, wherever all their numbers are known: that such a body exists."""

from collections.abc import Iterator, Mapping
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.model.arithmetic import AnyNumber, value_of
from eomgen.model.catalog import Catalog
from eomgen.model.checks.triangle import possible
from eomgen.model.composite import Composite, about, composite_of
from eomgen.model.fields import VectorRule
from eomgen.model.findings import Finding
from eomgen.model.part import leaves_of
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.numeric.tolerances import SOLVED


def made(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Finding]:
    """Shapes that cannot be, parts that weigh more than the whole, holes larger than what they are cut out of."""
    for name, body in catalog.table("bodies").items():
        if body is None or ("bodies", name) in catalog.broken or not _signed_right(body, values):
            continue  # told already
        path: DocumentPath = ("bodies", name)
        shapes = [((*path, "shape"), f"the shape of body '{name}'", body.shape)] if body.shape is not None else []
        shapes += [
            ((*path, "parts", k), f"part {k + 1} of body '{name}'", piece.shape)
            for k, piece in enumerate(body.parts or ())
        ]
        wrong = [_impossible(where, what, shape, values) for where, what, shape in shapes]
        yield from filter(None, wrong)
        if body.parts is not None and not any(wrong) and _complete(body) and all(map(_placed, body.parts)):
            yield from _whole((*path, "parts"), name, body, values)


def _impossible(path: DocumentPath, what: str, shape: Any, values: Mapping[str, AnyNumber]) -> Finding | None:
    if not _known(shape, values):
        return None
    try:
        why = shape.impossible(lambda e: float(e.evaluate(values)))
    except ExpressionError:  # told where the expression stands
        return None
    return Finding(path, f"{what} ({shape.kind}) cannot be: {why}") if why else None


def _signed_right(body: Any, values: Mapping[str, AnyNumber]) -> bool:
    """Whether every mass, length and radius of a body that is known has its sign."""
    signed = [leaf for leaf in leaves_of(body, ()) if getattr(leaf.rule, "sign", "")]
    known = [(leaf.rule.sign, value_of(leaf.value, values)) for leaf in signed if isinstance(leaf.value, Expression)]
    return all(x is None or x > 0 or (x == 0 and sign == "nonnegative") for sign, x in known)


def _known(part: Any, values: Mapping[str, AnyNumber]) -> bool:
    """Whether every expression in a part has names with values only."""
    leaves = (leaf.value for leaf in leaves_of(part, ()))
    return all(e.names <= values.keys() for e in leaves if isinstance(e, Expression))


def _complete(body: Any) -> bool:
    """Whether the masses of all parts follow (else it is told where masses are checked)."""
    sharing = [piece for piece in body.parts if piece.shape.mass is None]
    return not sharing or (body.mass is not None and len({piece.shape.dimension for piece in sharing}) == 1)


def _placed(piece: Any) -> bool:
    """Whether no vector of a piece has more components than space (told where references are checked)."""
    vectors = [leaf.value for leaf in leaves_of(piece, ()) if isinstance(leaf.rule, VectorRule)]
    return all(len(components) <= 3 for components in vectors)


def _whole(path: DocumentPath, name: str, body: Any, values: Mapping[str, AnyNumber]) -> Iterator[Finding]:
    """Of a composite body all of whose numbers are known."""
    expressions = [body.mass] if body.mass is not None else []
    if not all(_known(piece, values) for piece in body.parts) or any(e.names - values.keys() for e in expressions):
        return

    def value(expression: Expression) -> float:
        return float(expression.evaluate(values))

    try:
        measures = [_signed(piece, value) for piece in body.parts if piece.shape.mass is None]
        cut = body.mass is not None and any(measure > 0 for measure in measures)
        if cut and sum(measures) <= SOLVED * max(map(abs, measures)):
            yield Finding(path, f"the holes of body '{name}' are as large as its parts, or larger", key=True)
            return
        composite = composite_of(body.parts, body.mass, value)
    except (ExpressionError, ZeroDivisionError):
        return
    yield from _masses(path, name, body, composite)


def _signed(piece: Any, value: Any) -> Any:
    return (-1 if piece.hole else 1) * piece.shape.measure(value)


def _masses(path: DocumentPath, name: str, body: Any, composite: Composite) -> Iterator[Finding]:
    total = sum(placed.sign * placed.mass.m for placed in composite.pieces)
    largest = max(placed.mass.m for placed in composite.pieces)
    negative = [k for k, placed in enumerate(composite.pieces) if placed.mass.m < 0]
    if negative:
        given = sum(p.sign * p.mass.m for p in composite.pieces if p.piece.shape.mass is not None)
        what = f"the parts of body '{name}' with a mass of their own weigh {float(given):g} kg, its 'mass' is "
        what += f"{float(composite.whole.m):g} kg: that leaves no mass for the others"
        yield Finding(path, what, "'mass' is that of the net whole", key=True)
    elif abs(total - composite.whole.m) > SOLVED * (largest or 1):
        what = f"the parts of body '{name}' weigh {float(total):g} kg, its 'mass' is {float(composite.whole.m):g} kg"
        yield Finding(path, what, "leave out 'mass', or the mass of a part", key=True)
    elif total < -SOLVED * largest or (abs(total) <= SOLVED * largest and largest > 0):
        weight = "negative" if total < -SOLVED * largest else "zero"
        what = f"the mass of body '{name}' is {weight}: its holes take away {_of_holes(composite):g} kg"
        yield Finding(path, what, "a hole cannot weigh more than what it is cut out of", key=True)
    else:
        yield from _inertia(path, name, composite)


def _of_holes(composite: Composite) -> float:
    return _float(sum(placed.mass.m for placed in composite.pieces if placed.sign < 0))


def _float(x: Any) -> float:
    return float(x)


def _inertia(path: DocumentPath, name: str, composite: Composite) -> Iterator[Finding]:
    I = composite.whole.I
    moments = [_float(x) for x in (I[0][0], I[1][1], I[2][2], I[0][1], I[1][2], I[2][0])]
    size = max(abs(_float(x)) for p in composite.pieces for row in about(p.mass, composite.whole.com) for x in row)
    if not possible(moments, size):
        told = ", ".join(f"{x:g}" for x in moments)
        what = f"no body has the inertia of '{name}': [{told}] breaks the triangle inequality"
        yield Finding(
            path, what, "a hole lies inside the other parts, and is no heavier than what it is cut out of", key=True
        )
