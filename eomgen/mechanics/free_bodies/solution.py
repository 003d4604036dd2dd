"""Balance -> Solution: the equations of the bodies, solved for the reactions and for unknowns of the loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.constraints import Closure, Rank, holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.balance import (
    Balance,
    BodyEquation,
    along_carriers,
    along_ground,
    along_ground_again,
    with_unknowns,
    with_what_is_carried,
)
from eomgen.mechanics.free_bodies.wrenches import Effect
from eomgen.symbolic.exact import LinearSystem, Pivots, Solution, readable_all, sign_of_terms
from eomgen.symbolic.expression import Node, Scalar, SparseRow, is_zero, substituted
from eomgen.symbolic.numeric import NoValue, Work, evaluate, fifty_digits

TRIES = 20
SURE = 1  # the largest rank of what vanishes at no state: numbers, products of parameters that are not 0
Combination = dict[int, Scalar]


class Indeterminate(DerivationError):
    """A reaction that the equations of the rigid bodies do not determine."""


def solution_of_balance(
    balance: Balance, at: Mapping[Node, Scalar], sure: int | None = SURE, work: int = Work.ANSWER
) -> Solution:
    """The reactions, and unknowns of the loads, that balance all bodies.

    Args:
        at: what stands in place of coordinates, speeds, accelerations and t; {}: as functions of them.
        sure: pivots that may vanish at some state are only taken from so many kinds on (see `Pivots`).
        work: products of terms by which an entry is made readable.
    """
    coefficients, needed = with_unknowns(balance)
    pushes = [_pushes(balance, e) for e in balance.equations]
    if at:
        return _solved(balance, coefficients, needed, pushes, at, sure=sure, work=work)
    solution = _solved(balance, *along_ground(balance, coefficients, needed), pushes, sure=sure)
    if sure is None or not solution.unsure:
        return solution
    coefficients, turned = along_carriers(balance, coefficients)
    rows, needed = with_what_is_carried(balance, coefficients, needed)
    pushes, _ = with_what_is_carried(balance, pushes, [0] * len(pushes))
    solution = _solved(balance, *along_ground(balance, rows, needed), pushes, sure=sure, regular=True)
    return along_ground_again(solution, turned)


def _solved(
    balance: Balance,
    coefficients: list[SparseRow],
    needed: list[Scalar],
    pushes: list[SparseRow],
    at: Mapping[Node, Scalar] | None = None,
    *,
    sure: int | None = SURE,
    work: int = Work.ANSWER,
    regular: bool = False,
) -> Solution:
    """The solution of such equations.

    Args:
        pushes: of each the components with friction as they would be without friction.
        regular: what has no sure pivot is solved by normal equations of any size.
    """
    coefficients = coefficients + [{j: 1} for j in balance.given]
    needed = [*needed, *balance.given.values()]
    entries = [x for row in coefficients for x in row.values()]
    tests: list[SparseRow] = [*pushes, *({} for _ in balance.given)]
    if at:
        entries = list(readable_all(substituted(tuple(entries), at), work))
        needed = list(readable_all(substituted(tuple(needed), at), work))
        tests = [dict(zip(row, readable_all(substituted(tuple(row.values()), at), work), strict=True)) for row in tests]
    flat = iter(entries)
    rows = [{j: next(flat) for j in row} for row in coefficients]
    parameters = frozenset(balance.system.symbols.parameters.values())
    steady = _steady_parameters(balance.system)

    @cache
    def simple(a: Scalar) -> int:
        """Numbers, products of parameters that are not 0, and what may vanish at some state or for some angle."""
        return 0 if type(a) is not Node else 1 if _is_product(a, steady) else 2

    def has_sign(a: Node) -> bool:
        """True if the scalar is a parameter that is not 0, or a sum or root of terms of one sign."""
        return bool(sign_of_terms(a, steady))

    last = [j for j, c in enumerate(balance.components) if c.friction_effects]
    values = values_at_a_state(balance.system, entries)
    return LinearSystem(rows, needed, len(balance.names), values).solution(
        Pivots(rank=simple, last=last, sure=sure, tests=tests, factors=parameters, steady=has_sign, regular=regular),
    )


def combined_reaction(balance: Balance, solution: Solution, combination: Combination, name: str) -> Scalar:
    """sum of k_j x_j.

    Raises:
        Indeterminate: it has no single value; `name` says what it is.
    """
    constants, shares = solution.constants, solution.shares
    total: Scalar = 0
    open_: dict[int, Scalar] = {}
    for j, k in combination.items():
        if j not in constants:
            open_[j] = open_.get(j, 0) + k
            continue
        total = total + k * constants[j]
        for f, share in shares[j].items():
            open_[f] = open_.get(f, 0) - k * share
    left = {f for f, k in open_.items() if not is_zero(k) and not holds_identically(k)}
    if left:
        partners = [
            other
            for j, other in enumerate(balance.names)
            if other != name and (j in left or left & shares.get(j, {}).keys())
        ]
        raise Indeterminate(
            f"{name} is statically indeterminate: the balance of rigid bodies leaves it open"
            + (", together with " + ", ".join(partners) if partners else ""),
            fix="take a redundant constraint away, or let something give",
        )
    return total


def friction_as_load(balance: Balance, normals: Mapping[int, Node]) -> Balance:
    """The same balance, the friction of each contact a load factor * N of a symbol for its normal reaction.

    Args:
        normals: the symbols, by the components that have friction.
    """
    equations = []
    for equation in balance.equations:
        i, d = balance.system.motion.index[equation.body], equation.direction
        pushes, applied = dict(equation.coefficients), equation.applied
        for j, N in normals.items():
            pushes[j] = _along(balance.components[j].effects, i, d)
            applied = applied + _along(balance.components[j].friction_effects, i, d) * N
        coefficients = {j: x for j, x in pushes.items() if not is_zero(x)}
        equations.append(replace(equation, coefficients=coefficients, applied=applied))
    components = tuple(replace(c, friction=()) if j in normals else c for j, c in enumerate(balance.components))
    return replace(balance, components=components, equations=tuple(equations))


def _along(effects: Sequence[Effect], link: int, direction: int) -> Scalar:
    return sum((e.six[direction] for e in effects if e.link == link), start=0)


def _pushes(balance: Balance, equation: BodyEquation) -> dict[int, Scalar]:
    """The coefficients of the components with friction as they would be without friction."""
    link = balance.system.motion.index[equation.body]
    with_friction = [j for j in equation.coefficients if balance.components[j].friction_effects]
    return {j: _along(balance.components[j].effects, link, equation.direction) for j in with_friction}


def _steady_parameters(system: System) -> frozenset[Node]:
    """The parameters that are not 0 in the model, and those that have no value."""
    values = system.scope.model.exact_parameters()
    return frozenset(x for name, x in system.symbols.parameters.items() if values.get(name, 1) != 0)


def _is_product(a: Node, parameters: frozenset[Node]) -> bool:
    left: list[Scalar] = [a]
    while left:
        x = left.pop()
        if type(x) is not Node or x in parameters:
            continue
        if x.op not in ("mul", "div", "neg"):
            return False
        left += x.args
    return True


def values_at_a_state(system: System, entries: Sequence[Scalar]) -> Any:
    """Values at the first generic state at which all entries have one."""
    for seed in range(1, TRIES):
        state = _generic_state(system, seed)
        try:
            evaluate(entries, state, fifty_digits())
        except NoValue:
            continue
        return lambda scalars, state=state: evaluate(scalars, state, fifty_digits())
    raise DerivationError(
        f"no state with values for the reactions was found in {TRIES} tries",
        fix="give a start, and parameters, at which they have values",
    )


def _generic_state(system: System, seed: int) -> dict[Node, Any]:
    """A state off any special position, parameters off any special value unless the constraints are redundant for
    these alone.

    Two cranks are a parallelogram only where they have one length: then the values are the model's.
    """
    own = Closure(system.constraints).generic(seed)
    try:
        shaken = Closure(system.constraints).generic(seed, shaken=True)
        return shaken if Rank(system.constraints).rank(shaken) == Rank(system.constraints).rank(own) else own
    except (DerivationError, NoValue):
        return own
