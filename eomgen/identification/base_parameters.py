"""Y -> base parameters: groups of parameters that the forces can tell apart, with factors as formulas of lengths.

The columns of Y at many states, one above the other, are W. Taken in order, a column that follows from those before
it is left out: W_j = sum K_ij W_i, and with it the parameter of each column i that stays becomes a group,

    pi_i + sum_j K_ij pi_j

Without closing constraints the states are random points of a prime field: the rank is exact, and so is K, made of
monomials of the lengths of the model and then proven at further points. With closing constraints the states satisfy the
constraints, with 50 digits, and W is projected onto the motions that they allow.
Source: Gautier & Khalil, Direct calculation of minimum set of inertial parameters of serial robots, 1990; Gautier,
Numerical calculation of the base inertial parameters of robots, 1991.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, combinations, combinations_with_replacement, islice
from math import isqrt, prod
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import EomgenError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import System
from eomgen.symbolic.exact import LinearSystem, Pivots, exact_state, simplest
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Scalar,
    ScalarRow,
    SpatialInertia,
    State,
    Vector,
    is_zero,
    jacobian,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import PRIME, PRIME_FIELD, NoMeaning, NoValue, Work, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import to_text

MOST_LENGTHS = 8  # of a formula: more have too many monomials


LengthTerms = list[tuple[Fraction, list[str]]]
"""(factor, names of the lengths in the product) of each term."""


@dataclass(frozen=True)
class Group:
    """A base parameter: one parameter of the model, and the parameters that are added to it with factors.

    Args:
        name: of the parameter that leads it.
        terms: of each parameter in it the factor, as a text in the model's lengths, else as a number.
        numbers: the factors for the model's own lengths.
    """

    name: str
    terms: dict[str, str]
    numbers: dict[str, float]

    @property
    def formula(self) -> str:
        """Izz(arm) + l^2*m(hand)"""
        pieces: list[str] = []
        for parameter, factor in self.terms.items():
            grouped = f"({factor})" if " " in factor else factor
            shown = parameter if factor == "1" else f"-{parameter}" if factor == "-1" else f"{grouped}*{parameter}"
            pieces.append(f"- {shown[1:]}" if pieces and shown.startswith("-") else f"+ {shown}" if pieces else shown)
        return " ".join(pieces)


@dataclass(frozen=True)
class BaseParameters:
    """Base parameters: all that motions can determine of the parameters.

    Args:
        groups: the base parameters, as many as the rank.
        without_effect: the parameters on which no force depends.
        arithmetic: arithmetic in which the rank was found: "prime field" (exact) or "50 digits".
    """

    groups: tuple[Group, ...]
    without_effect: tuple[str, ...]
    arithmetic: str

    def __len__(self) -> int:
        return len(self.groups)

    def matrix(self, parameters: Sequence[str]) -> np.ndarray:
        """K of base = K pi, by the order of the parameters."""
        place = {name: j for j, name in enumerate(parameters)}
        K = np.zeros((len(self.groups), len(parameters)))
        for i, group in enumerate(self.groups):
            for name, factor in group.numbers.items():
                K[i, place[name]] = factor
        return K


def base_of(system: System, names: Sequence[str], rows: Sequence[ScalarRow], seed: int = 1) -> BaseParameters:
    """The base parameters of a regressor."""
    moving = [j for j in range(len(names)) if not all(is_zero(row[j]) for row in rows)]
    entries = tuple(row[j] for row in rows for j in moving)
    closed = system.constraints.closing or system.scope.quaternions
    kept, states = (None, 0) if closed else _kept_in_field(system, entries, moving, seed)
    found = _numbers(system, rows, moving, seed, kept or ())
    exact = found.kept == kept
    if kept is not None and not exact:
        found = _numbers(system, rows, moving, seed)
    texts = by_transfers(system, names, rows, moving, found)
    if exact and not texts:
        texts = _polynomials(system, entries, found, (states, len(moving)), seed)
    return _grouped(names, moving, found, texts, PRIME_FIELD.name if exact else "50 digits")


def _kept_in_field(system: System, entries: ScalarRow, moving: list[int], seed: int) -> tuple[list[int] | None, int]:
    """(the columns that stay, by random points of the prime field, the states that this takes).

    None: a root, a sign or a curve has no value there. The states are enough where the last adds no independent row.
    """
    own = {system.symbols.parameters[name]: x for name, x in system.scope.model.exact_parameters().items()}
    given = substituted(entries, {x: Fraction(own[x]) for x in own})
    width = len(moving)
    height = len(entries) // max(width, 1)
    states = (width + MORE) // max(height, 1) + 2
    try:
        while True:
            W = _sampled(system, given, (states, width), seed)
            kept, fewer = (_echelon_form(rows)[0] for rows in (W, W[:-height]))
            if kept == fewer or states > width + MORE:
                return kept, states
            states *= 2
    except (NoMeaning, NoValue, ValueError):
        return None, 0


def _polynomials(
    system: System, entries: ScalarRow, found: Dependence, size: tuple[int, int], seed: int
) -> dict[tuple[int, int], str]:
    """Factors as polynomials in the lengths; {} where they are not, or have other values than their numbers."""
    lengths = [node for node in system.symbols.parameters.values() if node in set(symbols_of(entries))]
    few = len(lengths) <= MOST_LENGTHS
    formulas = _formulas(system, entries, lengths, found.kept, size, seed) if few else {}
    values = {x.name: value for x, value in found.state.items() if x in lengths}
    same = (_agree(found.K.get(place, 0), terms, values) for place, terms in formulas.items())
    return {place: _polynomial(terms) for place, terms in formulas.items()} if all(same) else {}


def _agree(number: Any, terms: LengthTerms, values: Mapping[str, Any]) -> bool:
    """True if the value of a polynomial is this number."""
    value = sum((in_50_digits(factor) * prod(values[name] for name in names) for factor, names in terms), start=0)
    return bool(abs(value - number) <= tolerances.FOLLOWS_AT_50 * (1 + abs(number)))


def _sampled(
    system: System, entries: ScalarRow, size: tuple[int, int], seed: int, given: Any = None
) -> list[list[int]]:
    """W modulo the prime at a number of states, rows of a given width; the parameters are the same at all states.

    The states are one: each has coordinates, speeds and accelerations of its own name.
    """
    symbols = system.symbols
    copies, width = size
    own = (symbols.t, *symbols.x, *symbols.a)
    flat: list[Scalar] = []
    for k in range(copies):
        other = {x: symbols.graph.symbol(f"({x.name}, {k})") for x in own}
        flat += substituted(entries, other)
    state = exact_state(flat, Random(seed))
    values = {**state.values, **(given or {})}
    found = evaluate(flat, values, PRIME_FIELD)
    return [[int(x) % PRIME for x in found[i : i + width]] for i in range(0, len(found), width)]


def _echelon_form(W: Sequence[Sequence[int]]) -> tuple[list[int], dict[tuple[int, int], int]]:
    """(the columns that stay, K of the others by (column that stays, column)), modulo the prime."""
    left = [list(row) for row in W]
    kept: list[int] = []
    K: dict[tuple[int, int], int] = {}
    for j in range(len(left[0]) if left else 0):
        r = len(kept)
        pivot = next((i for i in range(r, len(left)) if left[i][j]), None)
        if pivot is None:
            K |= {(kept[i], j): left[i][j] for i in range(r) if left[i][j]}
            continue
        left[r], left[pivot] = left[pivot], left[r]
        inverse = pow(left[r][j], -1, PRIME)
        top = left[r] = [x * inverse % PRIME for x in left[r]]
        for i, row in enumerate(left):
            if i != r and row[j]:
                factor = row[j]
                left[i] = [(x - factor * y) % PRIME if y else x for x, y in zip(row, top, strict=True)]
        kept.append(j)
    return kept, K


def _rational(x: int) -> Fraction:
    """The fraction with small numerator and denominator that a residue is (Wang's algorithm)."""
    bound = isqrt(PRIME // 2)
    (a, b), (u, v) = (PRIME, x % PRIME), (0, 1)
    while b > bound:
        quotient = a // b
        (a, b), (u, v) = (b, a - quotient * b), (v, u - quotient * v)
    return Fraction(b, v)


def _formulas(
    system: System, entries: ScalarRow, lengths: list[Node], kept: list[int], size: tuple[int, int], seed: int
) -> dict[tuple[int, int], LengthTerms]:
    """The entries of K as polynomials of second degree in the model's lengths; {} where other columns stay, or they
    are no such polynomials: proven at as many points more.
    """
    rng = Random(seed)
    monomials = [(), *((x,) for x in range(len(lengths))), *combinations_with_replacement(range(len(lengths)), 2)]
    points, found = [], []
    for k in range(len(monomials) + 2):
        point = [rng.randrange(1, PRIME) for _ in lengths]
        W = _sampled(system, entries, size, seed + k, dict(zip(lengths, point, strict=True)))
        own, K = _echelon_form(W)
        if own != kept:
            return {}
        points.append([_product(point, m) for m in monomials])
        found.append(K)
    formulas: dict[tuple[int, int], LengthTerms] = {}
    for place in {key for K in found for key in K}:
        rows = [[*row, K.get(place, 0)] for row, K in zip(points, found, strict=True)]
        own, solution = _echelon_form(rows)
        if len(monomials) in own:
            return {}
        factors = {j: _rational(x) for (j, last), x in solution.items() if last == len(monomials)}
        formulas[place] = [(factors[j], [lengths[i].name for i in monomials[j]]) for j in sorted(factors)]
    return formulas


def _product(point: Sequence[int], places: Sequence[int]) -> int:
    value = 1
    for i in places:
        value = value * point[i] % PRIME
    return value


def _polynomial(terms: LengthTerms) -> str:
    pieces: list[str] = []
    for factor, names in terms:
        powers = [f"{name}^2" if names.count(name) == 2 else name for name in dict.fromkeys(names)]
        size = [] if abs(factor) == 1 and powers else [str(abs(factor))]
        text = "*".join([*size, *powers])
        sign = "-" if factor < 0 else "+"
        pieces.append(f"{sign} {text}" if pieces else f"-{text}" if sign == "-" else text)
    return " ".join(pieces) or "0"


def _numbers(
    system: System, rows: Sequence[ScalarRow], moving: list[int], seed: int, kept: Sequence[int] = ()
) -> Dependence:
    """Dependence of columns, by states that satisfy the constraints, with 50 digits; columns of `kept` come first."""
    order = [*kept, *(j for j in range(len(moving)) if j not in set(kept))]
    W, state = sampled_rows(system, rows, [moving[j] for j in order], seed)
    sizes = [max(map(abs, column)) for column in zip(*W, strict=True)]
    largest = max(sizes, default=0)
    scaled = np.array(W, dtype=object)
    for j, size in enumerate(sizes):
        scaled[:, j] = scaled[:, j] / size if size > tolerances.ROUNDED_AWAY * largest else 0 * scaled[:, j]
    stay, K = echelon_in_digits(scaled)
    follow = [order[j] for j, size in enumerate(sizes) if j not in stay and size > tolerances.ROUNDED_AWAY * largest]
    numbers = {(order[i], order[j]): x * sizes[j] / sizes[i] for (i, j), x in K.items()}
    return Dependence([order[i] for i in stay], follow, numbers, state)


def _grouped(
    names: Sequence[str],
    moving: Sequence[int],
    found: Dependence,
    texts: Mapping[tuple[int, int], str],
    arithmetic: str,
) -> BaseParameters:
    groups = []
    for i in found.kept:
        leader = names[moving[i]]
        own: dict[str, str] = {leader: "1"}
        values: dict[str, float] = {leader: 1.0}
        for (k, j), value in found.K.items():
            if k == i:
                own[names[moving[j]]] = texts.get((k, j)) or coefficient_text(value)
                values[names[moving[j]]] = float(value)
        groups.append(Group(leader, own, values))
    still = tuple(name for j, name in enumerate(names) if j not in set(moving))
    seen = {parameter for group in groups for parameter in group.terms}
    return BaseParameters(tuple(groups), (*still, *(names[j] for j in moving if names[j] not in seen)), arithmetic)


# -------- factors ---------------------------------------------------------------------------------------------
# Transfers of mass -> the factors of base parameters as formulas of the lengths.


SHAKEN, TRIALS = 3, 3  # the seed and the number of states at which transfers are tried
LARGEST_PLAIN = 1000  # denominator of a factor that holds no length


@dataclass(frozen=True)
class Dependence:
    """Dependence of columns of W on others: W_j = sum K_ij W_i.

    Args:
        kept, follow: the columns i and j; columns that are 0 are in neither.
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
    """Entries of K as formulas, where they follow from masses moved between bodies and plain numbers.

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
        tried = list(islice(constrained_states(system, Random(SHAKEN), shaken=True), TRIALS))
        Y = [columns_along(system, rows, moving, state, along) for state, along in tried]
        for said in chain(_of_columns(transfers_of(system, [state for state, _ in tried]), place), plain):
            transfer = {j: x for j, x in said.items() if x is not None}
            if len(found) == len(follow):
                break
            if not transfer or len(transfer) < len(said):
                continue
            value = [
                evaluate(tuple(transfer.values()), state, fifty_digits()) for state in (here, *(s for s, _ in tried))
            ]
            if all(_vanishes(W[:, list(transfer)], by) for W, by in zip(Y, value[1:], strict=True)):
                found += [transfer] if reduced.takes(dict(zip(transfer, value[0], strict=True))) else []
    except (EomgenError, NoValue):  # with other lengths nothing closes
        return {}
    if len(found) < len(follow):
        return {}
    values = partial(evaluate, values=here, arithmetic=fifty_digits())
    solved = LinearSystem(found, [0] * len(found), len(moving), values).eliminated(Pivots(last=kept))
    texts = {}
    for j in follow:
        for i, share in solved.shares.get(j, {}).items():
            form = simplest(-share, Work.VALUE)
            (value,) = evaluate((form,), here, fifty_digits())
            if abs(value - in_50_digits(K.get((i, j), 0))) > tolerances.FOLLOWS_AT_50 * (1 + abs(value)):
                return {}
            texts[i, j] = to_text(form)
    return texts if texts.keys() == K.keys() else {}


def _of_columns(transfers: Iterable[Transfer], place: Mapping[str, int]) -> Iterator[Mapping[int, Scalar | None]]:
    """Existing transfers between parameters, by their columns; those without an effect on any motion are left out."""
    for each in transfers:
        yield {place[name]: x for name, x in each.items() if name in place}


def _vanishes(W: np.ndarray, by: Sequence[Any]) -> bool:
    """True if a combination of columns is 0."""
    terms = W * np.array(by, dtype=object)
    return not terms.size or max(map(abs, terms.sum(axis=1))) <= tolerances.FOLLOWS_AT_50 * max(map(abs, terms.flat))


def coefficient_text(x: Any) -> str:
    """A number as text: a fraction with small numerator and denominator where it surely is one, else ten digits."""
    near = _plain(x)
    return f"{float(x):.10g}" if near is None else str(near)


def _plain(x: Any) -> Fraction | None:
    """The number with small numerator and denominator that it surely is."""
    if isinstance(x, Fraction | int):
        return Fraction(x)
    near = Fraction(float(x)).limit_denominator(LARGEST_PLAIN)
    return near if abs(x - fifty_digits().number(near)) <= tolerances.FOLLOWS_AT_50 else None


# -------- transfers -------------------------------------------------------------------------------------------
# Mass that may change its body unfelt -> base parameters as formulas of the lengths, of mechanisms with loops too.
#
# Where a point of one body always meets a point of another, a particle there may belong to either; where they have an
# axis together, so may the dipole and the quadrupole along it; bodies that turn alike may exchange moments of
# inertia:
#
#     particle:    m = 1,   m c = r,   I = r.r E - r r^T
#     dipole:      m = 0,   m c = n,   I = 2 r.n E - r n^T - n r^T
#     quadrupole:  m = 0,   m c = 0,   I = n.n E - n n^T
#
# One body loses what the other gains: a combination of the columns of Y that vanishes on every motion. It is found by
# points that meet at a few states, and tried on Y there, with 50 digits and other lengths than the model's. As many
# of them as there are columns that follow from others give these by exact elimination.


PLACES = {"Ixx": (0, 0), "Iyy": (1, 1), "Izz": (2, 2), "Ixy": (0, 1), "Iyz": (1, 2), "Izx": (0, 2)}
MOMENTS = {"mx": 0, "my": 1, "mz": 2}

Transfer = Mapping[str, Scalar]
"""Of each parameter by how much it changes."""


def named_entries(inertia: SpatialInertia) -> dict[str, Scalar]:
    """m, m c and I of a body by the names of its parameters."""
    found = {"m": inertia.m} | {name: inertia.h[k] for name, k in MOMENTS.items()}
    return found | {name: inertia.I[i][j] for name, (i, j) in PLACES.items()}


def particle(r: Vector) -> SpatialInertia:
    """Inertia of a particle of mass 1 at r."""
    return SpatialInertia(1, r, _crossed(r, r))


def dipole(r: Vector, n: Vector) -> SpatialInertia:
    """The slope of a particle at r along n."""
    return SpatialInertia(0, n, _crossed(r, n) + _crossed(n, r))


def quadrupole(n: Vector) -> SpatialInertia:
    """Half of the second slope along n: a moment of inertia about all that is across it."""
    return SpatialInertia(0, Vector.ZERO, _crossed(n, n))


def _crossed(a: Vector, b: Vector) -> Matrix:
    """a.b E - a b^T"""
    size = a @ b
    return Matrix.of([(size if i == j else 0) - a[i] * b[j] for j in range(3)] for i in range(3))


@dataclass(frozen=True)
class SharedPoint:
    """Point that two bodies share, r in the axes of each, and axes through it; None: the ground."""

    bodies: tuple[str | None, str | None]
    at: tuple[Vector, Vector]
    axes: tuple[tuple[Vector, Vector], ...] = ()

    def transfers(self) -> Iterator[Transfer]:
        """Transfers from the second body to the first, or from the ground."""
        for first, second in [
            tuple(map(particle, self.at)),
            *((dipole(self.at[0], m), dipole(self.at[1], n)) for m, n in self.axes),
            *((quadrupole(m), quadrupole(n)) for m, n in self.axes),
        ]:
            yield _exchanged(self.bodies, first, second)


def _exchanged(bodies: tuple[str | None, str | None], first: SpatialInertia, second: SpatialInertia) -> Transfer:
    sides = [(body, x) for body, x in zip(bodies, (first, second), strict=True) if body is not None]
    signed = ((body, 1 if body == bodies[0] else -1, named_entries(x)) for body, x in sides)
    return {f"{name}({body})": sign * x for body, sign, own in signed for name, x in own.items() if not is_zero(x)}


def transfers_of(system: System, states: Sequence[State]) -> Iterator[Transfer]:
    """Candidates for transfers: points that meet at all states, axes of joints, bodies that turn alike."""
    motion = system.motion
    yield from (x for shared in _shared(system, states) for x in shared.transfers())
    for link in motion.links:
        parent = None if link.parent < 0 else motion.links[link.parent].name
        if link.joint is None or len(link.S) > 1:
            continue
        R = link.before.R @ link.joint.pose((0,) * len(link.S), motion.scope.value).R
        own = [n for column in link.S for n in column if not all(map(is_zero, n))] or Matrix.IDENTITY
        axes = tuple((R @ n, n) for n in own)
        yield from SharedPoint((parent, link.name), (link.before.p, link.point), axes).transfers()
        for i in range(3):
            for j in range(i + 1):
                E = Matrix.of([int({r, c} == {i, j}) for c in range(3)] for r in range(3))
                turned = R @ E @ R.T
                yield _exchanged(
                    (parent, link.name), SpatialInertia(0, Vector.ZERO, turned), SpatialInertia(0, Vector.ZERO, E)
                )
    yield from _alike(system, states)


def _shared(system: System, states: Sequence[State]) -> Iterator[SharedPoint]:
    """Points of bodies that coincide at all states, and points that are fixed in the ground."""
    motion = system.motion
    places: list[tuple[str, Vector]] = []
    for link in motion.links:
        places += [(link.name, r) for r in (*motion.points[link.name].values(), link.point)]
        places += [(motion.links[link.parent].name, link.before.p)] if link.parent >= 0 else []
    places = [place for place in dict.fromkeys(places) if not motion.moves(place[1])]
    met: dict[Any, dict[str, Vector]] = defaultdict(dict)
    for name, r in places:
        met[_seen(motion.position((name, r)), states)].setdefault(name, r)
    for there in met.values():
        yield from (SharedPoint((a, b), (r, s)) for (a, r), (b, s) in combinations(there.items(), 2))
        for name, r in there.items():
            if not any(any(rates) for rates in _seen(motion.velocity((name, r)), states)):
                yield SharedPoint((name, None), (r, Vector.ZERO))


def _seen(scalars: Sequence[Scalar], states: Sequence[State]) -> tuple[tuple[int, ...], ...]:
    """Values of scalars at each state, as whole multiples of their sure accuracy."""
    return tuple(
        tuple(int(x / tolerances.FOLLOWS_AT_50 + 0.5) for x in evaluate(scalars, s, fifty_digits())) for s in states
    )


def _alike(system: System, states: Sequence[State]) -> Iterator[Transfer]:
    """Transfers between bodies with the same angular velocity at all states, in the plane."""
    if system.scope.model.space != "plane":
        return
    groups: dict[Any, list[str]] = defaultdict(list)
    for link in system.motion.links:
        groups[_seen((link.twist.w[2],), states)].append(link.name)
    for names in groups.values():
        yield from ({f"Izz({names[0]})": 1, f"Izz({other})": -1} for other in names[1:])


# -------- rows under constraints ------------------------------------------------------------------------------
# System -> rows of Y at states that keep the constraints, along the motions that these allow, with 50 digits.


MORE = 6  # beyond its columns
QUIET = 2  # states in succession that must add no independent row: then no state does
FAR = (0.4,)  # distance from the start of states that distinguish columns: near to it columns are nearly dependent
STEPS = 3  # of Newton's method from a root with 30 digits: each doubles them


def sampled_rows(
    system: System, rows: Sequence[ScalarRow], columns: Sequence[int], seed: int
) -> tuple[np.ndarray, State]:
    """(W at generic states that keep the constraints, along the motions that these allow, the last of these); 50
    digits.

    Of a part that moves by itself a state gives only as many rows as that has motions, however many the system has:
    states are added until they add no independent row.
    """
    parts: list[np.ndarray] = []
    have = quiet = 0
    reduced = Reduced({})
    for state, along in constrained_states(system, Random(seed)):
        parts.append(columns_along(system, rows, columns, state, along))
        have += len(along)
        least = tolerances.ROUNDED_AWAY * max(map(abs, parts[-1].flat), default=0)
        new = [reduced.takes({j: x for j, x in enumerate(row) if abs(x) > least}) for row in parts[-1]]
        quiet = 0 if any(new) else quiet + 1
        reported_apart = len(reduced.rows) == len(columns) or quiet >= QUIET
        if not len(along) or (reported_apart and have >= len(columns) + MORE):
            break
    return np.vstack(parts) if have else np.zeros((0, len(columns)), dtype=object), state


def columns_along(
    system: System, rows: Sequence[ScalarRow], columns: Sequence[int], state: State, along: np.ndarray
) -> np.ndarray:
    """Columns of Y at a state along the motions that the constraints allow."""
    entries = tuple(row[j] for row in rows for j in columns)
    Y = np.array(evaluate(entries, state, fifty_digits()), dtype=object).reshape(len(rows), len(columns))
    found: np.ndarray = along.dot(Y)
    return found


def constrained_states(system: System, rng: Random, *, shaken: bool = False) -> Iterator[tuple[State, np.ndarray]]:
    """Endless pairs (generic state that satisfies the constraints, the motions that they allow there)."""
    symbols, constraints = system.symbols, system.constraints
    size = len(symbols.u)
    J = tuple(x for row in constraints.J for x in row)
    given = {} if shaken else system.scope.values_of_parameters(None)
    while True:
        state = _closed_to_the_last_digit(system, Closure(constraints).generic(rng, shaken=shaken, spreads=FAR) | given)
        numbers = np.array(evaluate((*J, *constraints.sigma), state, fifty_digits()), dtype=object)
        there, sigma = numbers[: len(J)].reshape(-1, size), numbers[len(J) :]
        along, u = _allowed(there, sigma, size, rng)
        state = state | dict(zip(symbols.u, u, strict=True))
        gamma = np.array(evaluate(constraints.gamma, state, fifty_digits()), dtype=object)
        _, a = _allowed(there, gamma, size, rng)
        yield state | dict(zip(symbols.a, a, strict=True)), along


def _closed_to_the_last_digit(system: System, state: State) -> State:
    """A state whose gaps are closed, by Newton's method with 50 digits; of gaps that follow from others any."""
    gaps, free = (*system.constraints.gaps, *system.constraints.norms), system.constraints.movable
    if not gaps:
        return state
    slopes = tuple(x for row in jacobian(gaps, free) for x in row)
    for _ in range(STEPS):
        found = np.array(evaluate((*slopes, *gaps), state, fifty_digits()), dtype=object)
        S, phi = found[: len(slopes)].reshape(-1, len(free)), found[len(slopes) :]
        step = _allowed(S, phi, len(free), None)[1]
        state = state | {q: state[q] + d for q, d in zip(free, step, strict=True)}
    return state


def _allowed(J: np.ndarray, right: np.ndarray, size: int, rng: Random | None) -> tuple[np.ndarray, list[Any]]:
    """(a motion that the constraints allow in each row, an x with J x + right = 0, random where it is free)."""
    number = fifty_digits().number
    kept, K = echelon_in_digits(J, right)
    free = [j for j in range(size) if j not in kept]
    along = np.full((len(free), size), number(0), dtype=object)
    for row, j in enumerate(free):
        along[row, j] = number(1)
        for i in kept:
            along[row, i] = -K.get((i, j), number(0))
    pushed = [number(Fraction(rng.randrange(-1000, 1000), 1000) if rng else 0) for _ in free]
    x = [sum((p * row[k] for p, row in zip(pushed, along, strict=True)), start=number(0)) for k in range(size)]
    for i in kept:
        x[i] = x[i] - K.get((i, size), number(0))
    return along, x


@dataclass(frozen=True)
class Reduced:
    """Sparse rows of 50 digits, each without the pivots of those before it."""

    rows: dict[int, dict[int, Any]]

    def takes(self, row: Mapping[int, Any]) -> bool:
        """True if a row does not follow from these rows; it is then added."""
        left = dict(row)
        for pivot, other in self.rows.items():
            if factor := left.pop(pivot, 0):
                for j, x in other.items():
                    left[j] = left.get(j, 0) - factor * x
        pivot = max(left, key=lambda j: abs(left[j]), default=-1)
        if pivot < 0 or abs(left[pivot]) <= tolerances.FOLLOWS_AT_50 * max(map(abs, row.values()), default=0):
            return False
        size = left.pop(pivot)
        self.rows[pivot] = {j: x / size for j, x in left.items()}
        return True


def echelon_in_digits(W: np.ndarray, right: np.ndarray | None = None) -> tuple[list[int], dict[tuple[int, int], Any]]:
    """Echelon form as of `_echelon_form`, of numbers with 50 digits; a right side becomes one more column."""
    width = W.shape[1]
    if not len(W):
        return [], {}
    left = W.copy() if right is None else np.column_stack([W, right])
    kept: list[int] = []
    K: dict[tuple[int, int], Any] = {}
    for j in range(width):
        r = len(kept)
        pivot = max(range(r, len(left)), key=lambda i: abs(left[i, j]), default=None)
        if pivot is None or not abs(left[pivot, j]) > tolerances.FOLLOWS_AT_50:
            K |= {(kept[i], j): left[i, j] for i in range(r) if abs(left[i, j]) > tolerances.FOLLOWS_AT_50}
            continue
        left[[r, pivot]] = left[[pivot, r]]
        left[r] = left[r] / left[r, j]
        for i in range(len(left)):
            if i != r and left[i, j] != 0:
                left[i] = left[i] - left[i, j] * left[r]
        kept.append(j)
    if right is not None:
        K |= {(kept[i], width): left[i, width] for i in range(len(kept))}
    return kept, K


def in_50_digits(x: Any) -> Any:
    """An exact number, or one that has as many digits already."""
    return fifty_digits().number(x)
