"""Names and directions that somebody chose otherwise than the model -> what they would stand for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from heapq import heappop, heappush
from itertools import islice, product

from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.reading import HandEquation
from eomgen.judge.terms import ANGLES
from eomgen.symbolic.expression import Node, Scalar, is_zero, order, over
from eomgen.symbolic.print import to_text

MOST = 600  # ways to read names that are not the model's
FEW = 60  # of them are tried whatever it takes
NODES = 60_000  # of the equations of motion that all ways together may evaluate: each is compared with them


@dataclass(frozen=True)
class Renaming:
    """Meaning of names that the model does not have.

    Args:
        values: of each name, with its primes, the scalar.
        reported: of each name without primes the text: {phi: "theta - pi/2"}.
        near: whether every name is spelt as what it stands for, but for case and marks, or moves as it does.
        guessed: a name that does not move stands for a coordinate: where constraints hold that at 0, it says nothing.
    """

    values: Mapping[str, Scalar]
    reported: Mapping[str, str]
    near: bool = True
    guessed: bool = False


def renamings(case: Case, written: HandEquation, unknown: Sequence[str]) -> Iterator[Renaming]:
    """Ways to read the unknown names, the nearest first, at most MOST; fewer where the equations are long."""
    equations = case.equations
    entries = () if equations is None else (*equations.forcing, *(x for row in equations.M for x in row))
    most = max(FEW, min(MOST, NODES // max(1, len(order(entries)))))
    return islice(_renamings(case, written, unknown), most)


def _renamings(case: Case, written: HandEquation, unknown: Sequence[str]) -> Iterator[Renaming]:
    coordinates = [name for name in case.model.coordinates if name not in written.names]
    parameters = [name for name in (*case.model.parameters, *case.model.inputs) if name not in written.names]
    moving = [name for name in unknown if {f"{name}'", f"{name}''"} & written.names]
    still = [name for name in unknown if name not in moving]
    turns = cache(lambda of: list(_turns(case, of)) if of in case.model.coordinates else [(1, 0)])
    for places in _choices(moving, coordinates):
        for constants in _choices(still, [*parameters, *(q for q in coordinates if q not in places)]):
            named = dict(zip((*moving, *still), (*places, *constants), strict=True))
            for chosen in product(*map(turns, named.values())):
                near = all(name in moving or _distance(name, of) < 1 for name, of in named.items())
                ways = {name: (of, *how) for (name, of), how in zip(named.items(), chosen, strict=True)}
                guessed = any(of in case.model.coordinates and name not in moving for name, of in named.items())
                yield replace(_renaming(case, ways), near=near, guessed=guessed)


def _choices(names: Sequence[str], among: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """The choices of meanings for names; those that are spelt alike first, at most MOST."""
    if len(names) <= len(among):
        yield from islice((tuple(among[k] for k in chosen) for chosen in _nearest_first(names, among)), MOST)


def _nearest_first(names: Sequence[str], among: Sequence[str]) -> Iterator[tuple[int, ...]]:
    """Numbers of different ones of `among`, one for each name, by the sum of their distances, then by themselves.

    Best first: what is open holds beginnings, each by the least that its end can come to.
    """
    distances = [[_distance(name, other) for other in among] for name in names]
    least = [sum(map(min, distances[k:])) for k in range(len(names) + 1)]
    opened: list[tuple[float, tuple[int, ...]]] = [(least[0], ())]
    while opened:
        bound, chosen = heappop(opened)
        k = len(chosen)
        if k == len(names):
            yield chosen
            continue
        for i, distance in enumerate(distances[k]):
            if i not in chosen:
                heappush(opened, (bound - least[k] + distance + least[k + 1], (*chosen, i)))


def _distance(a: str, b: str) -> float:
    """Distance of two names; 0: they are one but for case and marks."""
    x, y = (name.lower().replace("_", "") for name in (a, b))
    if x == y:
        return 0
    digits = [[c for c in name if c.isdigit()] for name in (x, y)]
    return 1 + (x[:1] != y[:1]) + (digits[0] != digits[1])


def _turns(case: Case, name: str) -> Iterator[tuple[int, Scalar]]:
    """(sign, shift) of q = sign * own + shift: none first."""
    pi = case.system.scope.graph.pi
    quarter = over(pi, 2)
    yield 1, 0
    if case.dimension(name) in ANGLES:
        for sign in (1, -1):
            for shift in (0, quarter, -quarter, pi):
                if (sign, shift) != (1, 0):
                    yield sign, shift
        return
    yield -1, 0
    for place in case.places_of_rest:
        rest = next((x for q, x in place.items() if q.name == name), 0)
        if not is_zero(rest):
            yield 1, -rest
            yield -1, rest
    for parameter, node in case.system.symbols.parameters.items():
        if case.dimension(parameter) == case.dimension(name):
            for sign in (1, -1):
                yield from ((sign, node), (sign, -node))


def _renaming(case: Case, named: Mapping[str, tuple[str, int, Scalar]]) -> Renaming:
    names = case.system.scope.names
    values: dict[str, Scalar] = {}
    reported: dict[str, str] = {}
    for name, (of, sign, shift) in named.items():
        values[name] = sign * names[of] + shift
        for primes in ("'", "''"):
            if of + primes in names:
                values[name + primes] = sign * names[of + primes]
        if (sign, shift) != (1, 0) or of != name:
            reported[name] = to_text(values[name]) if isinstance(values[name], Node) else str(values[name])
    return Renaming(values, reported)
