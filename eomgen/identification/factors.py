"""Transfers of mass -> the factors of base parameters as formulas of the lengths."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, islice
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import EomgenError
from eomgen.identification.tied_rows import Reduced, columns_along, in_50_digits, tied_states
from eomgen.identification.transfers import Transfer, transfers_of
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import ScalarRow, State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import FOLLOWS_AT_50
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import to_text
from eomgen.symbolic.solve.linear import LinearSystem, Pivots, sparse_solution

SHAKEN, TRIALS = 3, 3  # the seed and the number of states at which transfers are tried
LARGEST_PLAIN = 1000  # denominator of a factor that holds no length


@dataclass(frozen=True)
class Dependence:
    """How columns of W follow from others: W_j = sum K_ij W_i.

    Args:
        kept, follow: the columns i and j; of neither is one that is 0.
        K: with 50 digits, where it is not 0.
        state: one of those at which it was found.
    """

    kept: list[int]
    follow: list[int]
    K: dict[tuple[int, int], Any]
    state: State


def by_transfers(
    system: System, names: Sequence[str], rows: Sequence[ScalarRow], moving: Sequence[int], dependence: Dependence
) -> dict[tuple[int, int], str]:
    """The entries of K as formulas, where all of it comes of masses that change their body, and of plain numbers.

    {} where something else makes columns follow from others. A transfer is tried on Y with other lengths than the
    model's, a formula is compared with its number.
    """
    kept, follow, K, here = dependence.kept, dependence.follow, dependence.K, dependence.state
    place = {names[moving[j]]: j for j in (*kept, *follow)}
    plain: list[Mapping[int, Scalar | None]]
    plain = [{j: 1} | {i: _plain(-K[i, j]) for i in kept if (i, j) in K} for j in follow]
    found: list[dict[int, Scalar]] = []
    reduced = Reduced({})
    try:
        tried = list(islice(tied_states(system, Random(SHAKEN), shaken=True), TRIALS))
        Y = [columns_along(system, rows, moving, state, along) for state, along in tried]
        for said in chain(_of_columns(transfers_of(system, [state for state, _ in tried]), place), plain):
            transfer = {j: x for j, x in said.items() if x is not None}
            if len(found) == len(follow):
                break
            if not transfer or len(transfer) < len(said):
                continue
            worth = [
                evaluate(tuple(transfer.values()), state, fifty_digits()) for state in (here, *(s for s, _ in tried))
            ]
            if all(_vanishes(W[:, list(transfer)], by) for W, by in zip(Y, worth[1:], strict=True)):
                found += [transfer] if reduced.takes(dict(zip(transfer, worth[0], strict=True))) else []
    except (EomgenError, NoValue):  # with other lengths nothing closes
        return {}
    if len(found) < len(follow):
        return {}
    values = partial(evaluate, values=here, arithmetic=fifty_digits())
    solved = sparse_solution(LinearSystem(found, [0] * len(found), len(moving), values), Pivots(last=kept))
    texts = {}
    for j in follow:
        for i, share in solved.shares.get(j, {}).items():
            form = simplest(-share, Work.VALUE)
            (worth,) = evaluate((form,), here, fifty_digits())
            if abs(worth - in_50_digits(K.get((i, j), 0))) > FOLLOWS_AT_50 * (1 + abs(worth)):
                return {}
            texts[i, j] = to_text(form)
    return texts if texts.keys() == K.keys() else {}


def _of_columns(transfers: Iterable[Transfer], place: Mapping[str, int]) -> Iterator[Mapping[int, Scalar | None]]:
    """Transfers between parameters that there are, by their columns; those that no motion feels are left out."""
    for each in transfers:
        yield {place[name]: x for name, x in each.items() if name in place}


def _vanishes(W: np.ndarray, by: Sequence[Any]) -> bool:
    """Whether a combination of columns is 0."""
    terms = W * np.array(by, dtype=object)
    return not terms.size or max(map(abs, terms.sum(axis=1))) <= FOLLOWS_AT_50 * max(map(abs, terms.flat))


def number_text(x: Any) -> str:
    """A factor that no formula is known of."""
    near = _plain(x)
    return f"{float(x):.10g}" if near is None else str(near)


def _plain(x: Any) -> Fraction | None:
    """The number with small numerator and denominator that it surely is."""
    if isinstance(x, Fraction | int):
        return Fraction(x)
    near = Fraction(float(x)).limit_denominator(LARGEST_PLAIN)
    return near if abs(x - x.context.mpf(near.numerator) / near.denominator) <= FOLLOWS_AT_50 else None
