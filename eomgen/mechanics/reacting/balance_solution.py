"""Balance -> Solution: the equations of the bodies, solved for the reactions and for unknowns of the loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.loops.closure import generic_state
from eomgen.mechanics.loops.freedom import rank_of_ties
from eomgen.mechanics.reacting.balance import Balance, BodyEquation
from eomgen.mechanics.reacting.ground_balance import along_ground
from eomgen.mechanics.statics.unknown_loads import with_unknowns
from eomgen.mechanics.system import System
from eomgen.symbolic.derivative import substituted
from eomgen.symbolic.evaluation import NoValue, evaluate, fifty_digits, order
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.linear import Solution
from eomgen.symbolic.normal_form import readable_all
from eomgen.symbolic.scaling import solved

TRIES = 20


def solution_of_balance(balance: Balance, at: Mapping[Node, Scalar], sure: int | None = 1) -> Solution:
    """The reactions, and unknowns of the loads, that balance all bodies.

    Args:
        at: what stands in place of coordinates, speeds, accelerations and t; {}: as functions of them.
        sure: pivots that may vanish at some state are only taken from so many kinds on (see `linear.solved`).
    """
    coefficients, needed = with_unknowns(balance)
    if not at:
        coefficients, needed = along_ground(balance, coefficients, needed)
    entries = [x for row in coefficients for x in row.values()]
    pushes = [_pushes(balance, e) for e in balance.equations]
    if at:
        entries = list(readable_all(substituted(tuple(entries), at)))
        needed = list(readable_all(substituted(tuple(needed), at)))
        pushes = [dict(zip(row, readable_all(substituted(tuple(row.values()), at)), strict=True)) for row in pushes]
    flat = iter(entries)
    rows = [{j: next(flat) for j in row} for row in coefficients]
    parameters = frozenset(balance.system.symbols.parameters.values())

    def simple(a: Scalar) -> int:
        """Numbers, products of parameters, and what may vanish at some state or for some angle."""
        return 0 if type(a) is not Node else 1 if _is_product(a, parameters) else 2

    last = [j for j, c in enumerate(balance.components) if c.rubbing]
    values = values_at_a_state(balance.system, entries)
    return solved(rows, needed, len(balance.names), values, simple=simple, last=last, sure=sure,
                  tests=pushes, sure_symbols=parameters)  # fmt: skip


def _pushes(balance: Balance, equation: BodyEquation) -> dict[int, Scalar]:
    """The coefficients of the components that rub as they would be without friction."""
    link = balance.system.motion.index[equation.body]
    rubbing = [j for j in equation.coefficients if balance.components[j].rubbing]
    return {j: sum((e.six[equation.direction] for e in balance.components[j].effects if e.link == link), start=0)
            for j in rubbing}  # fmt: skip


def _is_product(a: Node, parameters: frozenset[Node]) -> bool:
    return all(x in parameters or x.op in ("mul", "div", "neg") for x in order((a,)))


def values_at_a_state(system: System, entries: Sequence[Scalar]) -> Any:
    """Values at the first generic state at which all entries have one."""
    for seed in range(1, TRIES):
        state = _generic_state(system, seed)
        try:
            evaluate(entries, state, fifty_digits())
        except NoValue:
            continue
        return lambda scalars, state=state: evaluate(scalars, state, fifty_digits())
    raise DerivationError(f"no state with values for the reactions was found in {TRIES} tries")


def _generic_state(system: System, seed: int) -> dict[Node, Any]:
    """A state off any special position, parameters off any special value unless the ties are redundant for these alone.

    Two cranks are a parallelogram only where they have one length: then the values are the model's.
    """
    own = generic_state(system.ties, Random(seed))
    try:
        shaken = generic_state(system.ties, Random(seed), shaken=True)
        return shaken if rank_of_ties(system.ties, shaken) == rank_of_ties(system.ties, own) else own
    except (DerivationError, NoValue):
        return own
