"""Rows of a sweep -> critical values: where what is asked changes its sign along the first of its ranges.

And what was asked in vain.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from eomgen.errors import RunFailed
from eomgen.sweeps.kernel import Payload, SampleRow, payload_of, value_of_run
from eomgen.sweeps.ledger import SweepLedger
from eomgen.sweeps.plan import SweepPlan
from eomgen.sweeps.workers import Pool
from eomgen.symbolic.numeric.tolerances import SOLVED

JUMP = 1e-3  # of what it was at both ends of the bracket: more is left where a function jumps or has a pole


def critical_values(plan: SweepPlan, ledger: SweepLedger, pool: Pool | None) -> list[SampleRow]:
    """(number, what stays, name, value, left, message) for each change of sign between two neighbours of the grid."""
    known = {row[0] for row in ledger.critical()}
    tasks = [task for task in _brackets(plan, ledger) if task[0] not in known]
    payload = payload_of(plan)
    if pool is None:
        return [bisected(payload, *task) for task in tasks]
    futures = [pool.submit(bisected, payload, *task) for task in tasks]
    return [future.result() for future in futures]


Bracket = tuple[int, dict[str, float], str, tuple[float, float], tuple[float, float], str]
"""(number, what stays, the name, its two values, what is asked at them, the expression)"""


def _brackets(plan: SweepPlan, ledger: SweepLedger) -> Iterator[Bracket]:
    """Neighbours along the first range at which what is asked has different signs; every other value stays."""
    design, name = plan.runs, next(iter(plan.over))
    many = design.count // len(plan.over[name])
    k = len(plan.columns) - len(plan.asked) + plan.asked.index(plan.critical)
    before: dict[int, Any] = {}
    for row in ledger.rows():
        place = row[0] % many
        one, value = before.get(place), row[k]
        before[place] = row
        names = plan.columns[4 : 4 + len(design.names)]
        staying = {other: x for other, x in zip(names, row[4:], strict=False) if other != name}
        if one is None or one[k] is None or value is None or row[0] - one[0] != many:
            continue
        if one[k] * value < 0 or (value == 0) != (one[k] == 0):
            if one[k]:
                yield row[0], staying, name, (one[4], row[4]), (one[k], value), plan.critical
            elif one[0] < many:  # 0 where the range begins
                yield one[0], staying, name, (one[4], one[4]), (0.0, 0.0), plan.critical


def remarks_of(plan: SweepPlan, ledger: SweepLedger) -> tuple[str, ...]:
    """What is asked in vain: what is the same in all runs, and what changes its sign nowhere."""
    remarks = []
    for column, name in enumerate(plan.columns[-len(plan.asked) :], len(plan.columns) - len(plan.asked)):
        count, low, _, high = ledger.summary(column)
        if count < 2 or low is None or high is None:
            continue
        same = high - low <= plan.how.rtol * max(abs(low), abs(high))
        told = f"'{name}' is {high:.9g} in all runs: nothing that is set changes it"
        if plan.asked[column - len(plan.columns)] == plan.critical and not ledger.critical():
            told = told if same else f"it goes from {low:.9g} to {high:.9g}"
            remarks.append(f"'{plan.critical}' changes its sign nowhere along {next(iter(plan.over))}: {told}")
        elif same:
            remarks.append(told)
    return tuple(remarks)


def bisected(
    payload: Payload,
    number: int,
    staying: Mapping[str, float],
    name: str,
    ends: tuple[float, float],
    values: tuple[float, float],
    text: str,
) -> SampleRow:
    """The critical value between two, enclosed until nothing is left between them (Brent's method)."""
    from scipy.optimize import brentq

    (a, b), (low, high) = ends, values
    told = json.dumps(dict(staying))
    if high == 0:
        return number, told, name, b, 0.0, ""
    values_at = {a: low, b: high}

    def value(x: float) -> float:
        found = values_at[x] if x in values_at else value_of_run(payload, {**staying, name: x}, text)
        if found is None:
            raise RunFailed(f"no value at {name} = {x:.12g}", mend="narrow the range to where it has values")
        values_at[x] = found
        return found

    try:
        root = float(brentq(value, a, b, xtol=SOLVED * max(abs(a), abs(b)), rtol=SOLVED))
        left = abs(value(root))
    except RunFailed as error:
        return number, told, name, None, None, error.what
    return number, told, name, root, left, "it jumps there" if left > JUMP * max(map(abs, values)) else ""
