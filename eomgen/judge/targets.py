"""An equation of somebody -> what it is compared with, the most telling first."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress

from eomgen.errors import DerivationError, EomgenError
from eomgen.judge.balances import Balances, asks_reactions
from eomgen.judge.case import Case
from eomgen.judge.comparison import Comparison
from eomgen.judge.implied import Explainable
from eomgen.judge.reading import HandEquation
from eomgen.judge.replays import replays
from eomgen.judge.right import directions_at_start, signs_at_start, sizes_in
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted, symbols_of
from eomgen.symbolic.expression.expressions import Reference
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.traversal import order

Meanings = Mapping[str, Scalar]
MOST_FORMS = 6  # of a value that is compared in others than its own
MOST_BODIES = 10  # of a model whose reactions are derived anew
_WHAT = {"kinetic_energy": "T", "potential_energy": "V", "generalized_force": "Q"}


def targets_of(
    case: Case, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None
) -> list[Explainable]:
    """What an equation is compared with, the most telling first."""
    if kind in ("reaction", "motion") and not also and asks_reactions(written):
        begun = case.as_begun or case  # it slides as the author says, not by the sign of a speed
        balances = (Balances(begun, written), Balances(begun, written, finely=True))
        return [balances[0], *_values_of(case, written, kind, scalar, also), balances[1]]
    return [*_values_of(case, written, kind, scalar, also)]


def _values_of(case: Case, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None) -> list[Comparison]:
    """Its values and the equations of motion."""
    calls = set(written.calls)
    if kind == "motion" or (kind in ("law", "energy") and not calls):
        if not case.rows or not depends_on(scalar, (*case.system.symbols.u, *case.forced)):
            return []  # of a place alone any equation without motion is some multiple
        of_energy = _energies(case, scalar) if kind in ("law", "energy") else []
        of_law = () if depends_on(scalar, case.forced) else _rates(case, scalar)
        sizes = {**signs_at_start(case, sizes_in(case, written, scalar)), **directions_at_start(case, written)}
        rows = substituted(case.rows, sizes)
        return of_energy + [
            Comparison(case, each, rows, "motion", sizes=sizes) for each in substituted((*of_law, scalar), sizes)
        ]
    if len(calls) != 1:
        return _sums(case, written, scalar) if calls else []
    (call,) = calls
    symbol = case.system.scope.graph.symbol(f"({call})")
    left = case.evaluated(written.difference, {**case.names, **(also or {})}, lambda _: symbol)
    slope = derivative(left, symbol)
    if depends_on(slope, (symbol,)) or is_zero(slope):
        return [] if is_zero(slope) else _sums(case, written, scalar)
    (rest,) = substituted((left,), {symbol: 0})
    author, true = over(-rest, slope), case.called(call)
    sizes = sizes_in(case, written, author - true)
    if sizes:  # of a speed the author wrote without its sign
        (true,) = substituted((true,), {**sizes, **signs_at_start(case, sizes)})
    of = tuple(x.name for x in call.args if isinstance(x, Reference))
    found = [Comparison(case, author - true, (true,), _WHAT.get(call.name, ""), call, of)]
    moving = (*case.system.symbols.a, *case.system.symbols.lam)
    forms = _in_names_of(case, author, true) if kind == "reaction" else []
    if depends_on(true, moving) and not depends_on(author, moving):
        with suppress(EomgenError):
            so = case.phase.simple(case.phase.eliminated(true))
            if sizes := sizes_in(case, written, author - so):
                so = case.phase.simple(substituted((so,), {**sizes, **signs_at_start(case, sizes)})[0])
            found.append(Comparison(case, author - so, (so,), "", call, of))
            true = so
    found += [Comparison(case, author - x, (x,), "", call, of) for x in forms]
    if any(x.op == "sqrt" for x in order((author, true))) and not depends_on(true, moving):
        found.append(Comparison(case, author * author - true * true, (true * true,), "", squared=True))
    if kind == "reaction" and len(case.model.bodies) <= MOST_BODIES:
        found.append(
            Comparison(case, author - true, (true,), "", more=lambda: replays(case, true, case.called_by(call)))
        )
    return found


def _sums(case: Case, written: HandEquation, scalar: Scalar) -> list[Comparison]:
    """Several functions: where all stand on one side, the other is the author's value of what is there."""
    author, of = (written.right, written.left) if not written.right.calls else (written.left, written.right)
    if author.calls:
        return [Comparison(case, scalar, (0,), "")]
    true, theirs = case.value(of), case.value(author)
    found = [Comparison(case, theirs - true, (true,), "")]
    with suppress(EomgenError):
        so = case.phase.simple(case.phase.eliminated(true)) if depends_on(true, case.forced) else true
        found = [Comparison(case, theirs - so, (so,), "")] if not depends_on(theirs, case.forced) else found
    return found


def _in_names_of(case: Case, author: Scalar, true: Scalar) -> list[Scalar]:
    """A value by the equations of motion in other forms: without names that the author has not."""
    mine, forms = {*symbols_of((author,))}, [true]
    for row in case.rows:
        for form in forms[:MOST_FORMS]:
            for x in {*symbols_of((row,))} & {*symbols_of((form,))} - mine:
                ours, slope = (derivative(each, x) for each in (row, form))
                if not depends_on(ours, (x,)) and not depends_on(slope, (x,)) and not is_zero(slope):
                    with suppress(DerivationError):  # it has no value there
                        other = case.phase.simple(form - over(slope, ours) * row)
                        forms += [other] if other not in forms else []
    return forms[1:]


def loosened_targets(case: Case, written: HandEquation, kind: str) -> list[Comparison]:
    """The same where rates of what is driven or dependent stand by their names, as the author has them."""
    loose, coordinates = case.loosened, case.model.coordinates
    bound = {f"{q}{dots}" for q, x in coordinates.items() if x.driven or x.dependent for dots in ("'", "''")}
    if loose is None or "t" in written.names or kind == "reaction" or not bound & written.names:
        return []
    with suppress(EomgenError):
        scalar, a = loose.value(written.difference), loose.system.symbols.a
        found = []
        if not written.calls and loose.system.ties.J:
            rows = loose.tied_rates[depends_on(scalar, a)]
            found = [Comparison(loose, scalar, rows, "ties")]
        if written.calls or not any(x.dependent for x in coordinates.values()):
            found += _values_of(loose, written, kind, scalar, None)
        known = {x: 0 for x in a if x.name in case.steady}
        return [x.with_known(known) for x in found]
    return []


def _energies(case: Case, scalar: Scalar) -> list[Comparison]:
    """The energy theorem, of a law with squares of speeds."""
    u = case.system.symbols.u
    if depends_on(scalar, case.forced) or not any(depends_on(derivative(scalar, x), (x,)) for x in u):
        return []
    return [] if case.gained is None else [Comparison(case, scalar, (case.gained,), "energy")]


def _rates(case: Case, scalar: Scalar) -> tuple[Scalar, ...]:
    """The equation of motion that a law follows from: its rate."""
    if not depends_on(scalar, case.system.symbols.u):
        return ()
    with suppress(DerivationError):
        (rate,) = case.system.scope.with_accelerations((scalar,))
        if len(case.system.symbols.a) == 1:
            slope = derivative(rate, case.system.symbols.a[0])
            rate = rate if is_zero(slope) else over(rate, slope)
        return (rate,)
    return ()
