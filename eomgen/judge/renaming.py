"""Names, directions and conventions that somebody chose otherwise than the model -> what they would stand for.

The work of a constant force may stand among the potential energies; a natural frequency may be that without damping.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from heapq import heappop, heappush
from itertools import islice, product

from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.reading import HandEquation
from eomgen.judge.terms import ANGLES
from eomgen.judge.truth import IDENTITY, Decided, on_one_side, truth_of
from eomgen.judge.verdict import FUNCTION_KINDS
from eomgen.symbolic.expression import Call, Expression, Node, Scalar, is_zero, order, over, parse
from eomgen.symbolic.print import to_text

MOST = 600  # ways to read names that are not the model's
FEW = 60  # of them are tried whatever it takes
NODES = 60_000  # of the equations of motion that all ways together may evaluate: each is compared with them

POTENTIAL, KINETIC = "potential_energy", "kinetic_energy"
WORK = "the work of constant forces counted as a potential energy"
UNDAMPED = "the frequency without the damping"
NATURAL = ("omega_0", "omega0", "omega_n", "omegan", "f_0", "f0", "T_0", "T0")
"""letters of a natural frequency, or its period, which books have for the motion without damping"""


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
    equations = case.parts.equations
    entries = () if equations is None else (*equations.forcing, *(x for row in equations.M for x in row))
    most = max(FEW, min(MOST, NODES // max(1, len(order(entries)))))
    return islice(_renamings(case, written, unknown), most)


def _renamings(case: Case, written: HandEquation, unknown: Sequence[str]) -> Iterator[Renaming]:
    coordinates = [name for name in case.model.coordinates if name not in written.names]
    still_named = (*case.model.parameters, *case.model.inputs, *case.model.states)
    parameters = [name for name in still_named if name not in written.names]
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


# -------- conventions -----------------------------------------------------------------------------------------
# What authors count otherwise -> whether an equation is right in that sense.


def is_of_kinetic_energy(written: HandEquation) -> bool:
    """True if kinetic energies stand in it and no potential one: no constant may be added to these."""
    names = {call.name for call in written.calls}
    return KINETIC in names and POTENTIAL not in names


def potential_of_constant_forces(case: Case, written: HandEquation) -> Scalar:
    """The negative work of constant forces, which the model does not count among its potential energies; 0 of none."""
    if not any(call.name == POTENTIAL and not call.args for call in written.calls):
        return 0
    return sum((part.V for part in case.parts.elementary if part.kind == "constant"), start=0)


def with_constant_forces(case: Case, written: HandEquation, kind: str) -> Decided | None:
    """Right where V holds the work of constant forces, too; None: it is not so."""
    work = potential_of_constant_forces(case, written) if kind in ("energy", "law") else 0
    if is_zero(work):
        return None

    def called(call: Call) -> Scalar:
        return case.called(call) + (work if call.name == POTENTIAL and not call.args else 0)

    scalar = case.evaluated(written.difference, case.names, called)
    found = truth_of(case, scalar, kind)
    if not found.holds:
        found = on_one_side(case, written, kind, scalar) or found
    return Decided(True, " and ".join(filter(None, (WORK, found.up_to)))) if found.holds else None


def with_reactions_of_zero(case: Case, written: HandEquation, kind: str, up_to: str) -> str:
    """Words for what an equation is right up to; of one of motion also its reactions that are 0 in every motion."""
    calls = written.calls if kind == "motion" else ()
    asked = [call for call in calls if FUNCTION_KINDS.get(call.name) == "reaction"]
    found = {call: truth_of(case, case.called(call), "motion") for call in asked}
    idle = [call for call, x in found.items() if x.holds or x.why == IDENTITY]
    letters = ", ".join(written.letters.get(str(call), str(call)) for call in idle)
    reported = f"{letters}, which {'is' if len(idle) == 1 else 'are'} 0 in every motion" if idle else ""
    return " and ".join(filter(None, (up_to, reported)))


def without_damping(case: Case, written: HandEquation) -> HandEquation | None:
    """The same, omega_0 as sqrt(K/M) of the one motion; None: it is another letter, or there are several motions."""
    speeds = case.system.symbols.u
    asked = [call for call in written.left.calls if call.name == "frequency"]
    letter = re.match(r"\w+", written.left.text)
    if letter is None or letter[0] not in NATURAL or len(speeds) != 1 or len(asked) != 1:
        return None
    q = speeds[0].name.removesuffix("'")
    if q not in case.model.coordinates:
        return None
    root = parse(f"sqrt(stiffness({q}, {q})/mass({q}, {q}))", references=True)
    code = tuple(x for kind, what in written.left.code for x in (root.code if what == asked[0] else ((kind, what),)))
    return replace(written, left=Expression(str(root.text), code, (-1,) * len(code)))
