"""System -> its configuration at rest: coordinates at the start, exact; speeds, accelerations and time 0."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.bodies.system_scene import start_values, with_unit_quaternions
from eomgen.mechanics.constraints.assembly import fixed_by_position
from eomgen.mechanics.constraints.closure import gaps_of, of_50_digits
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_state
from eomgen.model.arithmetic import in_order
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.derivative import jacobian, substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import NoValue, digits_at, evaluate, fifty_digits
from eomgen.symbolic.solve.linear_systems import LinearSystem, general_solution

TRIES = 20
DIGITS = 12  # of a speed that a start was given by its constraints


def values_where_at_rest(system: System, places: Mapping[Node, Scalar] | None = None) -> State:
    """Every symbol that moves, at rest at the start: exact scalars of the parameters.

    Args:
        places: coordinates that are elsewhere than at the start.
    Raises:
        DerivationError: the ties do not close at the start, or not in closed form.
    """
    symbols, scope = system.symbols, system.scope
    sought = fixed_by_position(system.ties)
    given = with_unit_quaternions(scope, start_values(scope, (q for q in symbols.q if q not in sought)))
    state = system.standing({**given, **(places or {})})
    left = [q for q in sought if q not in state]
    return state | (_closed_in(system, state, left) if left else {})


def _closed_in(system: System, state: State, sought: list[Node]) -> State:
    """The dependent coordinates that the ties place, in closed form."""
    numbers: dict[Node, float] = {node: float(x) for node, x in values_of_parameters(system.scope, None).items()}
    numbers |= {
        node: value
        for node, value in zip((*system.symbols.q, *system.symbols.u), start_state(system).values(), strict=True)
    }
    located = Located(numbers, system.scope.positive)
    found = places_of(substituted(gaps_of(system.ties), state), sought, located)
    missing = [q.name for q in sought if q not in found]
    if missing:
        raise DerivationError(
            f"where the ties place '{missing[0]}' has no closed form here",
            f"coordinates.{missing[0]}",
            "give start values at which it has one",
        )
    return found


def speeds_near(system: System, places: State, numbers: Mapping[Node, float]) -> State:
    """Exact speeds at exact places, for which J u + sigma = 0, next to those of a start that was put together.

    Args:
        numbers: of all speeds; as many as the rows determine follow from the others, which are rounded.
    """
    u = system.symbols.u
    rows = substituted(tuple(row.velocity for row in system.ties.closing), places | {system.symbols.t: 0})
    still = substituted(rows, dict.fromkeys(u, 0))
    lines = [{j: x for j, x in enumerate(row) if not is_zero(x)} for row in jacobian(rows, u)]
    values = digits_at(values_of_parameters(system.scope, Random(3)))
    solution = general_solution(LinearSystem(lines, [-x for x in still], len(u), values))
    known = {j: Fraction(f"{numbers[u[j]]:.{DIGITS}g}") for j in solution.free}
    found: dict[Node, Scalar] = {u[j]: x for j, x in known.items()}
    for j, x in solution.constants.items():
        found[u[j]] = x - sum((share * known[f] for f, share in solution.shares[j].items()), start=0)
    return found


def values_of_parameters(scope: Scope, rng: Random | None, *, shaken: bool = False) -> dict[Node, Any]:
    """Values of the parameters with 50 digits: the model's own, else random ones; without `rng` those with a value.

    Args:
        shaken: all near the model's own and none of them special.
    """
    model, arithmetic = scope.model, fifty_digits()
    known = exact_parameters(model)
    names, values = scope.symbols.parameters, dict[Node, Any]()
    given = {name: part.value for name, part in model.parameters.items() if part is not None}
    for name in in_order(given)[0]:
        if name in known:
            values[names[name]] = evaluate((scope.value(given[name]),), values, arithmetic)[0]
    if rng is None:
        return values
    for node in names.values():
        value = values.get(node)
        if value is None:
            values[node] = of_50_digits(rng.uniform(0.7, 1.3))
        elif shaken:
            values[node] = value * rng.uniform(0.8, 1.2) if value else of_50_digits(rng.uniform(0.05, 0.2))
    return values


def values_for(
    scope: Scope, scalars: Iterable[Scalar], near: Mapping[Node, float] | None = None, *, shaken: bool = False
) -> dict[Node, Any]:
    """Values, with 50 digits, at which all scalars have one: of the parameters, and of what else stands in them.

    Args:
        near: where symbols of the configuration are.
        shaken: as of `values_of_parameters`.
    Raises:
        DerivationError: they have none.
    """
    wanted, arithmetic = tuple(scalars), fifty_digits()
    for seed in range(1, TRIES):
        rng = Random(seed)
        values = values_of_parameters(scope, rng, shaken=shaken)
        values |= {node: arithmetic.number(Fraction(x)) for node, x in (near or {}).items()}
        values |= {x: of_50_digits(rng.uniform(0.5, 2)) for x in symbols_of(wanted) if x not in values}
        try:
            evaluate(wanted, values, arithmetic)
        except (NoValue, ZeroDivisionError):
            continue
        return values
    raise DerivationError(
        "the configuration has no value at these parameters", mend="give parameters at which lengths and roots are real"
    )
