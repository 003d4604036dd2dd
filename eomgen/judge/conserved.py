"""An energy or a momentum that somebody takes as constant -> that it changes, and what changes it."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.errors import DerivationError
from eomgen.judge.case import Case
from eomgen.judge.contributions import Contribution
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.terms import short_text
from eomgen.judge.verdict import Cause
from eomgen.symbolic.expression.derivative import depends_on, derivative, gradient
from eomgen.symbolic.expression.formula import over
from eomgen.symbolic.expression.node import Scalar, is_zero


def not_conserved(case: Case, scalar: Scalar) -> Cause | None:
    """Of a scalar that is, but for a factor and a constant, an energy or a momentum: that it changes.

    None: it is neither, or it does not change.
    """
    symbols = case.system.symbols
    if case.equations is None or not depends_on(scalar, symbols.u) or depends_on(scalar, case.forced):
        return None
    for name, x, by in _integrals(case):
        try:
            (rate,) = case.system.scope.with_accelerations((x,))
            steady = case.follows(rate).holds is not False or not _is_multiple(case, scalar, x)
        except DerivationError:
            continue
        if not steady:
            who = f": {' and '.join(by)}" if by else ""
            text = f"{name}, {shown}," if (shown := short_text(x, case.system.scope.positive)) else name
            return Cause(
                "wrong_formula", f"{text} is not constant along the motion{who}", quantity=f"whether {name} is constant"
            )
    return None


def _integrals(case: Case) -> Iterator[tuple[str, Scalar, list[str]]]:
    """What may be taken as constant, in words; what changes it."""
    operator, parts, symbols = case.parts.operator, case.parts.elementary, case.system.symbols
    T = sum((operator.energy(part.T) for part in parts), start=0)
    V = sum((part.V for part in parts), start=0)
    driven = [f"what drives {name} does work" for name, q in case.model.coordinates.items() if q.driven]
    works = [f"{part.name} does work" for part in parts if _acts(part) and part.kind != "constraint"]
    yield "the energy", T + V, driven + works
    if not is_zero(V):
        falls = [f"{part.name} does work" for part in parts if not is_zero(part.V)]
        yield "the kinetic energy", T, driven + works + falls
    for k, u in enumerate(symbols.u):
        along = [
            f"{part.name} acts along it" for part in parts if part.kind != "constraint" and _changes(case, part, k)
        ]
        q = u.name.removesuffix("'")
        yield f"the momentum of {q}", derivative(T, u), along


def _acts(part: Contribution) -> bool:
    return part.row is not None or not all(map(is_zero, part.Q))


def _changes(case: Case, part: Contribution, k: int) -> bool:
    return is_zero(part.T) and not is_zero(case.parts.operator.rows(part)[k])


def _is_multiple(case: Case, scalar: Scalar, x: Scalar) -> bool:
    """Whether the scalar is x times a constant, but for a constant."""
    symbols = case.system.symbols
    moving = (symbols.t, *symbols.q, *symbols.u)
    slopes = [
        (a, b) for a, b in zip(gradient(scalar, symbols.u), gradient(x, symbols.u), strict=True) if not is_zero(b)
    ]
    if not slopes:
        return False
    factor = over(*slopes[0])
    steady = [*gradient(factor, moving), *gradient(scalar - factor * x, moving)]
    return bool(is_zero_everywhere(case.system, *steady).holds)
