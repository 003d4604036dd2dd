"""Scope -> Scope: generalized speeds that are not rates, w = Y(q, t) q' + y, in the place of the rates.

    q' = N u + nu of the rates that are left,  w = Y u + y   ->   u = Y^-1 (w - y),   q' = (N Y^-1) w + (nu - N Y^-1 y)

A coordinate whose rate stands in no declared speed keeps it for a speed. The four rates of a quaternion follow from
the angular velocity, e' = 1/2 e o (0, w), without any inverse. The speeds are the rates that are kept, in the order of
the coordinates, then the declared ones in the order of the model.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.bodies.scope import Scope
from eomgen.model.joints.orientation import rate_matrix_of
from eomgen.model.quaternions import quaternions_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, jacobian, substituted, symbols_of
from eomgen.symbolic.expression.functions import combined, inner
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.solve import cramer

SpeedRows = dict[Node, tuple[tuple[Scalar, ...], Scalar]]  # u = row . w + bias, of each rate u


@dataclass(frozen=True)
class Solved:
    """Rates that declared speeds determine together; where the determinant vanishes they are not determined."""

    rates: tuple[str, ...]
    determinant: Scalar

    def __str__(self) -> str:
        return f"the declared speeds do not determine {', '.join(self.rates)}"


def with_declared_speeds(
    scope: Scope, *, vanishes: Callable[[Scalar], bool], shorter: Callable[[Scalar], Scalar]
) -> tuple[Scope, tuple[Solved, ...]]:
    """The scope over the declared speeds, and what must stay regular.

    Args:
        scope: over the rates, dependent coordinates eliminated.
        vanishes: whether a scalar is zero at all states.
        shorter: puts a coefficient of N into a shorter form.
    Raises:
        ModelError: not one speed for each freedom; a speed that is not linear in the rates; speeds that depend on one
            another.
    """
    u, graph = scope.symbols.u, scope.graph
    declared = tuple(name for name, part in scope.model.speeds.items() if part.rate is not None)
    turning = {node.name + "'" for four in scope.quaternions for node in four}
    formulas = tuple(scope.names[name] for name in declared)
    _refuse_turning(declared, formulas, [x for x in u if x.name in turning])
    standing = set(symbols_of(formulas))
    replaced = [x for x in u if x.name not in turning and x in standing]
    _refuse_count(scope, declared, replaced)
    kept = tuple(x for x in u if x.name not in turning and x not in replaced)
    speeds = (*kept, *map(graph.symbol, scope.model.speeds))
    rates = (*(graph.symbol(f"{x.name}'") for x in kept), *(graph.symbol(f"{name}'") for name in scope.model.speeds))
    place = {x.name: k for k, x in enumerate(speeds)}
    rows: SpeedRows = {x: (_unit(place[x.name], len(speeds)), 0) for x in kept}
    solved, blocks = _rates_solved(scope, declared, replaced, place, vanishes, shorter)
    rows |= solved
    rows |= _quaternion_rates(scope, place)
    symbols = replace(scope.symbols, u=speeds, a=rates)
    return _over(scope, replace(scope, symbols=symbols), u, rows), blocks


def _unit(k: int, size: int) -> tuple[int, ...]:
    return tuple(int(j == k) for j in range(size))


# -- the rates ---------------------------------------------------------------------------------------


def _rates_solved(
    scope: Scope,
    declared: Sequence[str],
    replaced: Sequence[Node],
    place: dict[str, int],
    vanishes: Callable[[Scalar], bool],
    shorter: Callable[[Scalar], Scalar],
) -> tuple[SpeedRows, tuple[Solved, ...]]:
    """u = Y^-1 (w - y) of the rates that stand in declared speeds, by determinants."""
    formulas = tuple(scope.names[name] for name in declared)
    Y = jacobian(formulas, replaced)
    y = substituted(formulas, dict.fromkeys(replaced, 0))
    for name, row in zip(declared, Y, strict=True):
        if any(depends_on(x, replaced) for x in row):
            what = f"speed '{name}' is not linear in the rates"
            raise ModelError(what, f"speeds.{name}.rate", "give a combination of rates")
    system = [{j: x for j, x in enumerate(row) if not is_zero(x)} for row in Y]
    right = [[*_unit(place[name], len(place)), -bias] for name, bias in zip(declared, y, strict=True)]
    try:
        X, blocks = cramer.solution_by_minors(system, right, vanishes=vanishes, shorter=shorter)
        singular = any(vanishes(cramer.determinant(block.matrix)) for block in blocks)
    except (DerivationError, ZeroDivisionError, StopIteration):
        singular = True
    if singular:
        names = ", ".join(x.name for x in replaced)
        what = f"the declared speeds do not determine the rates {names}: they depend on one another"
        raise ModelError(what, "speeds", "declare independent combinations of the rates")
    found = tuple(
        Solved(tuple(replaced[j].name for j in block.unknowns), cramer.determinant(block.matrix)) for block in blocks
    )
    return {x: (tuple(row[:-1]), row[-1]) for x, row in zip(replaced, X, strict=True)}, found


def _quaternion_rates(scope: Scope, place: dict[str, int]) -> SpeedRows:
    """e' = 1/2 e o (0, w), one row for each of its rates."""
    rows: SpeedRows = {}
    for four, each in zip(scope.quaternions, quaternions_of(scope.model), strict=True):
        for e, factors in zip(four, rate_matrix_of(four), strict=True):
            row: list[Scalar] = [0] * len(place)
            for name, factor in zip(each.speeds, factors, strict=True):
                row[place[name]] = factor
            rows[scope.graph.symbol(f"{e.name}'")] = (tuple(row), 0)
    return rows


def _over(old: Scope, new: Scope, u: Sequence[Node], rows: SpeedRows) -> Scope:
    """q' = N u + nu with u = rows . w + bias put in, and the meaning of every name."""
    N = tuple(combined(row, [rows[x][0] for x in u]) for row in old.N)
    nu = tuple(bias + inner(row, [rows[x][1] for x in u]) for row, bias in zip(old.N, old.nu, strict=True))
    new = replace(new, N=N, nu=nu)
    rates = {f"{q.name}'": rate for q, rate in zip(new.symbols.q, new.rates, strict=True)}
    second = new.with_accelerations(tuple(rates.values()))
    names = {**old.names, **rates, **{f"{name}'": x for name, x in zip(rates, second, strict=True)}}
    return replace(new, names=names | {x.name: x for x in (*new.symbols.u, *new.symbols.a)})


# -- what cannot be ----------------------------------------------------------------------------------


def _refuse_turning(declared: Sequence[str], formulas: Sequence[Scalar], turning: Sequence[Node]) -> None:
    for name, formula in zip(declared, formulas, strict=True):
        if depends_on(formula, turning):
            what = f"the rate of a quaternion stands in the speed '{name}'"
            raise ModelError(what, f"speeds.{name}.rate", "the speeds of the joint's `omega` stand for these rates")


def _refuse_count(scope: Scope, declared: Sequence[str], replaced: Sequence[Node]) -> None:
    if len(declared) == len(replaced):
        return
    rates = f"{len(replaced)} rate{'s' * (len(replaced) != 1)}"
    what = f"{len(declared)} speed{' is' if len(declared) == 1 else 's are'} declared for {rates}"
    named = ", ".join(x.name for x in replaced) or "none"
    if len(declared) < len(replaced):
        mend = (
            "declare one speed for each rate that stands in them, or leave out those that keep their rate; "
            "a coordinate that ties determine may be `dependent`"
        )
    else:
        mend = "one for each freedom: leave out what follows from the others"
    raise ModelError(f"{what} ({named})", "speeds", mend)
