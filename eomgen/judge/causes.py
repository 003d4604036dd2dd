"""An explanation -> its causes, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import Explanation, Share
from eomgen.judge.terms import LONG, short_text
from eomgen.judge.verdict import Cause
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import depends_on, depends_on_any, substituted
from eomgen.symbolic.expression.expressions import Call, Expression, Reference
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.work import Work

if TYPE_CHECKING:
    from eomgen.judge.case import Case


def causes_of(case: Case, found: Sequence[Explanation], *, moving: bool, rooted: bool = False) -> tuple[Cause, ...]:
    """The causes of the first explanation; the kinds of others with as many mistakes beside them.

    Args:
        moving: it is about accelerations: products of two speeds are Coriolis terms.
        rooted: what is compared is the square of what was asked.
    """
    best = found[0]
    causes = _joined(case, best, [cause_of(case, share, best.row, moving=moving) for share in best.shares])
    others = [e for e in found[1:] if len(e.shares) == len(best.shares)]
    if len(causes) == 1:
        also = [cause_of(case, e.shares[0], e.row, moving=moving) for e in others]
        kinds = dict.fromkeys(x.kind for x in also)
        another = next((x for x in also if _is_another(causes[0], x)), None)
        causes[0] = replace(
            causes[0],
            others=tuple(kind for kind in kinds if kind != causes[0].kind),
            or_else="" if another is None else another.text,
        )
    return tuple(replace(x, text=f"under the root {x.text}") for x in causes) if rooted else tuple(causes)


def _is_another(one: Cause, other: Cause) -> bool:
    """Whether two causes are of different things, not two sentences of one."""
    ends = {x.text.rpartition(", ")[2] for x in (one, other)}  # "is missing"
    return one.kind != other.kind and one.quantity != other.quantity and len(ends) == 2


def _joined(case: Case, found: Explanation, causes: list[Cause]) -> list[Cause]:
    """The causes; what is missing and what stands there in its place as one."""
    gone = [k for k, share in enumerate(found.shares) if share.corruption.open and share.factor == 0 and not share.unit]
    extra = [k for k, share in enumerate(found.shares) if share.corruption.kind == "extra_term"]
    if len(gone) != 1 or len(extra) != 1:
        return causes
    (k,), (j,) = gone, extra
    rows = found.shares[k].corruption.rows
    ratio = (
        over(found.shares[j].corruption.rows[0], rows[max(found.row, 0)]) if not is_zero(rows[max(found.row, 0)]) else 0
    )
    symbols = case.system.symbols
    constant = not depends_on(
        legible(ratio, Work.FORMULA, case.system.scope.positive, LONG),
        (symbols.t, *symbols.q, *symbols.u, *case.forced),
    )
    name, term = causes[k].quantity, causes[k].term
    what = f"{name}, {term}," if term and term not in name else name
    stands = found.shares[j].corruption.rows[0] * (-1 if found.scale == "opposite" else 1)
    text = f"{what} stands there as {short_text(stands, case.system.scope.positive)}"
    joined = replace(causes[k], kind="factor" if constant else "wrong_quantity", text=text)
    return [joined if i == k else cause for i, cause in enumerate(causes) if i != j]


def cause_of(case: Case, share: Share, row: int, *, told: bool = True, moving: bool = True) -> Cause:
    """The cause that one corruption is."""
    corruption, x = share.corruption, share.factor
    rows = (corruption.rows[row],) if row >= 0 else corruption.rows
    term = (
        next(filter(None, (short_text(x, case.system.scope.positive) for x in rows if not is_zero(x))), "")
        if told
        else ""
    )
    kind, text = corruption.kind, corruption.text
    if corruption.open:
        whole = corruption.kind if moving else "factor"
        if moving and told and whole == "factor" and _is_coriolis(case, rows):
            whole = "coriolis"
        speeds = whole == "coriolis" and corruption.name.startswith("all that holds speeds")
        name = "the Coriolis term" if speeds else corruption.name
        kind, text = _of_factor(whole, name, x, share.unit, term)
    body, force = corruption.body, corruption.force
    is_term = corruption.name.startswith(("the term ", "the product "))
    if told and not body and not force and is_term:
        total = sum((x for x in rows if not is_zero(x)), start=0)
        held = case.parts.holding(total, "T" if depends_on(total, case.system.symbols.a) else "")
        if len(held) == 1:
            whose = f": it is a term of {held[0].name}" if kind == "extra_term" else f" ({held[0].name})"
            body, force, text = held[0].body, held[0].force, f"{text}{whose}"
    return Cause(kind, text, term, body, force, corruption.name)


def _of_factor(kind: str, name: str, x: Fraction, unit: str, term: str) -> tuple[str, str]:
    """(kind, sentence) of a contribution with a wrong factor."""
    what = f"{name}, {term}," if term and term not in name else name
    if unit:
        return "unit", f"{what} stands with the factor {unit}: a unit is not converted"
    if x == 0:
        return ("missing_term" if kind == "factor" else kind), f"{what} is missing"
    if x == -1:
        return ("sign" if kind == "factor" else kind), f"{what} has the wrong sign"
    if kind == "coriolis" and x == Fraction(1, 2):
        return kind, f"{what} is counted once, and stands there twice"
    wrong = "a minus sign and " if x < 0 else ""
    return kind, f"{what} stands with {wrong}the factor {abs(x)}, which does not belong there"


def _is_coriolis(case: Case, rows: Sequence[Scalar]) -> bool:
    """Whether the rows are products of different speeds alone: nothing is left of them where only one moves."""
    symbols = case.system.symbols
    rows = case.edits.written(tuple(rows))
    if depends_on_any(rows, case.forced) or not depends_on_any(rows, symbols.u):
        return False
    alone = [x for u in symbols.u for x in substituted(tuple(rows), {w: 0 for w in symbols.u if w is not u})]
    return all(map(is_zero, alone)) or bool(is_zero_everywhere(case.system, *alone).holds)


def other_calls(case: Case, call: Call) -> Iterator[Call]:
    """The same function of other points, bodies or ties, one argument changed."""
    model = case.model
    for k, argument in enumerate(call.args):
        if not isinstance(argument, Reference):
            number = argument.literal
            for other in (number - 1, number + 1) if isinstance(number, int) else ():
                yield replace(call, args=(*call.args[:k], Expression.number(other), *call.args[k + 1 :]))
            continue
        tables: list[Sequence[str]] = [
            tuple(model.named_points),
            tuple(model.bodies),
            tuple(model.constraints),
            tuple(model.coordinates),
        ]
        for names in tables:
            if argument.name not in names:
                continue
            for name in names:
                if name != argument.name:
                    yield replace(call, args=(*call.args[:k], Reference(name), *call.args[k + 1 :]))
