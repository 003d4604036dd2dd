"""A wrong equation between reactions in space -> the reaction that is missing in it, or has the wrong sign.

In the plane all balances are written and searched (`balances`); in space an equation between reactions is linear in
them: one of the author's is turned round, or another of the same kind is added with the factor of one that is there.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from eomgen.errors import EomgenError
from eomgen.judge.case import Case
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.reading import HandEquation
from eomgen.judge.verdict import FUNCTION_KINDS, Cause
from eomgen.symbolic.expression import Call, Node, Scalar, depends_on, derivative, is_zero, substituted


def of_forces_in_space(case: Case, written: HandEquation) -> Cause | None:
    """The one reaction by which a wrong equation would be right; None: it is none of these."""
    calls = list(dict.fromkeys(call for call in written.calls if FUNCTION_KINDS.get(call.name) == "reaction"))
    if case.model.space != "space" or not calls or case.unknown_names(written):
        return None
    with suppress(EomgenError):
        return next(_causes(case, written, calls), None)
    return None


def _causes(case: Case, written: HandEquation, calls: list[Call]) -> Iterator[Cause]:
    graph = case.system.scope.graph
    symbols = {call: graph.symbol(f"({call})") for call in calls}

    def opaque(call: Call) -> Scalar:
        return symbols[call] if call in symbols else case.called(call)

    def holds(x: Scalar) -> bool:
        return bool(is_zero_everywhere(case.system, *substituted((x,), values)).holds)

    left, right = (case.evaluated(side, case.names, opaque) for side in (written.left, written.right))
    values: dict[Node, Scalar] = {symbol: case.called(call) for call, symbol in symbols.items()}
    slopes = {call: derivative(left - right, symbol) for call, symbol in symbols.items()}
    if any(depends_on(slope, tuple(values)) for slope in slopes.values()) or all(map(is_zero, values.values())):
        return
    for call, slope in slopes.items():
        if not is_zero(values[symbols[call]]) and holds(left - right - 2 * slope * symbols[call]):
            yield Cause("sign", f"the force {call} has the wrong sign", str(call), force=str(call), quantity=str(call))
    if not is_zero(right) and holds(left + right):
        yield Cause("sign", "one of the sides has the wrong sign", quantity="the signs")
    for call, slope in slopes.items():
        for _, other in case.reading.requested:
            if other.name == call.name and other not in symbols:
                more = slope * case.called(other)
                if not is_zero(more) and any(holds(left - right + sign * more) for sign in (1, -1)):
                    text = f"the force {other} is missing, which stands with the same factor as {call}"
                    yield Cause("missing_term", text, str(other), force=str(other), quantity=str(other))
