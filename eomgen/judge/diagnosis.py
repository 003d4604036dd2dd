"""An equation that is wrong -> why: the least set of named mistakes that makes the model's equations the author's.

    sigma D = E + sum y_j C_j

D is the author's difference of sides, E the model's equation, C_j what the mistake j adds, y_j how often it is there
(a simple number), sigma a function of the configuration alone: the author may have divided by anything. At a few
configurations with several speeds and accelerations each this is linear in sigma and y; sets are searched in doubles,
the cheapest that leaves nothing is proven exactly, and only then stated.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import islice
from random import Random

import numpy as np

from eomgen.frozen import dataclass
from eomgen.judge.decision import states_of
from eomgen.mechanics.dynamics import System
from eomgen.model import Dimension
from eomgen.symbolic.expression import Fraction, Node, Scalar, ScalarRow, over
from eomgen.symbolic.numeric import ARRAYS, evaluate, tolerances

BELIEVED = 12.5  # the cost of one mistake up to which nothing else is looked at
FAR_FETCHED = 16.0  # the cost of one mistake from which on something else is rather believed
PLAINEST = 10.0  # the cost of the most believable mistake
WELL_KNOWN = 4  # the largest numerator and denominator by which somebody takes all of an answer wrongly
WHOLE = "the whole of"  # what is requested, as one contribution
PLACES, VARIANTS = 5, 8  # configurations, and speeds and accelerations at each
SIMPLE = 12  # the largest numerator and denominator of a factor that somebody wrote by mistake
ALIKE = 7  # digits to which directions are compared before pairs are sought
MOST_PLAIN = 40  # contributions beside whose usual factors one more mistake is sought
PAIRED, TRIPLED = 900, 120  # mistakes of which pairs and triples are sought
MOST_MISTAKES = 3  # in one explanation
DEAREST = {1: 30.0, 2: 33.0, 3: 40.5}  # the cost up to which so many mistakes are believed
PROVEN = 24  # explanations that are proven before it is given up
SQUARED = 3.0  # how much less it is believed that a square has the wrong sign
WHOLE_MOTION = 0.2  # how much less a wrong factor of all that a motion does is believed than one of a force
MINUS = 5.0  # how much less a sign is believed beside a factor
USUAL = (  # factors that people write by mistake, and how much less each is believed than a term left out
    ((Fraction(1),), 0.0),
    ((Fraction(2), Fraction(1, 2)), 1.5),
    ((Fraction(3), Fraction(4), Fraction(1, 3), Fraction(1, 4)), 2.5),
)
UNUSUAL = 9.0  # of other factors
TURNED = 0.3  # of an equation whose sides are exchanged
MIXED = 6.0  # how much less a combination of equations is believed than one of them
NEARLY = 2.0  # by how much less an explanation may be believed that is stated in addition to the first
MOST_NEAR = 6  # of these are proven
INSTEAD = 2.0  # how much less it is believed that something unknown stands in the place of a contribution
UNITS = {  # factors of wrong units: as a number, as a scalar of pi, in words
    "pi/180": (np.pi / 180, (Fraction(1, 180), 1)),
    "180/pi": (180 / np.pi, (Fraction(180), -1)),
    "2*pi": (2 * np.pi, (Fraction(2), 1)),
    "1/(2*pi)": (0.5 / np.pi, (Fraction(1, 2), -1)),
    "1000": (1000.0, (Fraction(1000), 0)),
    "1/1000": (0.001, (Fraction(1, 1000), 0)),
    "100": (100.0, (Fraction(100), 0)),
    "1/100": (0.01, (Fraction(1, 100), 0)),
    "60": (60.0, (Fraction(60), 0)),
    "1/60": (1 / 60.0, (Fraction(1, 60), 0)),
}


@dataclass(frozen=True)
class Share:
    """One mistake in an explanation.

    Args:
        mistake: the mistake.
        factor: x, by which the contribution stands in the author's equation (1 is right); of a change how often it is
            there: once, or as often as the contribution in which it is made.
        unit: the name of the factor of a wrong unit, "".
    """

    mistake: Mistake
    factor: Fraction
    unit: str = ""

    def added(self, graph_pi: Scalar) -> tuple[Scalar, ...]:
        """y C_j, of each row."""
        y: Scalar = self.factor if not self.mistake.open else self.factor - 1
        if self.unit:
            number, power = UNITS[self.unit][1]
            y = number * (graph_pi if power == 1 else over(1, graph_pi) if power == -1 else 1) - 1
        return tuple(y * x for x in self.mistake.rows)


@dataclass(frozen=True)
class Explanation:
    """Why an equation differs: mistakes that together make the model's equation the author's.

    Args:
        shares: the mistakes.
        row: whose equation it is, its place; -1: a combination.
        cost: how much has to be believed.
        scale: "", "opposite", "constant" or "function": what the author multiplied the equation by.
    """

    shares: tuple[Share, ...]
    row: int
    cost: float
    scale: str = ""


@dataclass(frozen=True)
class Samples:
    """States of a system in doubles: PLACES configurations with VARIANTS speeds and accelerations each."""

    values: dict[Node, np.ndarray]
    places: int

    def of(self, scalars: Sequence[Scalar]) -> np.ndarray:
        """The scalars there, (len(scalars), places, variants)."""
        return self.flat(scalars).reshape(len(scalars), self.places, VARIANTS)

    def flat(self, scalars: Sequence[Scalar]) -> np.ndarray:
        """The scalars at all states in one row, (len(scalars), places * variants)."""
        size = self.places * VARIANTS
        with np.errstate(all="ignore"):
            found = evaluate(tuple(scalars), self.values, ARRAYS)
        return np.array([np.broadcast_to(np.asarray(x, dtype=float), (size,)) for x in found]).reshape(len(found), size)

    def with_values(self, known: Mapping[Node, np.ndarray]) -> Samples:
        """The same states with these values of some symbols."""
        return Samples({**self.values, **known}, self.places)


def samples_of(
    system: System, flat: Sequence[Scalar], *, on_constraints: bool = False, places: int = PLACES
) -> Samples | None:
    """States at which the scalars can be compared; on the constraints where these restrict coordinates or speeds."""
    rng = Random(3)
    rows: list[dict[Node, float]] = []
    found = 0
    for state in islice(states_of(system, flat, on_constraints=on_constraints, seed=5), places):
        plain = {x: float(value) for x, value in state.items()}
        variants = [_variant(system, plain, rng, on_constraints) for _ in range(VARIANTS)]
        rows += variants
        found += 1
    if not found:
        return None
    names = rows[0].keys()
    return Samples({x: np.array([row[x] for row in rows]) for x in names}, found)


UNITS_OF_OTHERS = {
    "kg": 1.7,
    "m": 0.83,
    "s": 1.31,
    "A": 1.17,
    "K": 0.77,
}  # the units of somebody who measures otherwise, in ours


def in_other_units(samples: Samples, dimensions: Mapping[str, Dimension]) -> Samples | None:
    """The same states in other units; None where a symbol's dimension is not known."""
    found = dict[Node, np.ndarray]()
    for x, values in samples.values.items():
        name = x.name.rstrip("'")
        dimension = Dimension.of_time() if name == "t" else dimensions.get(name)
        if dimension is None or dimension.unknowns:
            return None
        powers = dimension.times(Dimension.of_time(), len(name) - len(x.name))
        found[x] = values * float(np.prod([UNITS_OF_OTHERS[base] ** float(n) for base, n in powers.items()]))
    return Samples(found, samples.places)


def fitting(ours: np.ndarray, others: np.ndarray, given: int, rows: int) -> np.ndarray:
    """True for each mistake with the dimension of the equation; for all of them where the author's equation has none.

    Args:
        ours, others: the author's equation and what else is given, then the rows of each mistake, at the same states
            in two sets of units.
        given: how many there are before the mistakes, the last ones the rows.
    """
    ours, others = (x.reshape(len(x), -1) for x in (ours, others))
    places = np.argmax(np.abs(ours), axis=1)[:, None]
    with np.errstate(all="ignore"):
        largest = np.take_along_axis(ours, places, 1)
        ratios = np.take_along_axis(others, places, 1) / largest
        first = np.where(np.abs(largest) > tolerances.COMPUTED * np.abs(ours[:given]).max(), ratios, 0.0)[:, 0]
        alike = np.all(np.abs(others - ratios * ours) <= tolerances.CARRIED * np.abs(ratios * largest), axis=1) | (
            first == 0
        )
    factors = np.where(alike, first, np.nan)
    equation, mistakes = factors[given - rows : given], factors[given:].reshape(-1, rows)
    if np.isnan(factors[:given]).any():
        return np.ones(len(mistakes), dtype=bool)
    same = np.abs(mistakes - equation) <= tolerances.CARRIED * np.abs(equation)
    fits: np.ndarray = np.all(same | (mistakes == 0) | (equation == 0), axis=1)
    return fits


def _variant(system: System, state: dict[Node, float], rng: Random, on_constraints: bool) -> dict[Node, float]:
    symbols, constraints = system.symbols, system.constraints
    moving = (*symbols.u, *symbols.a, *symbols.lam)
    state = state | {x: rng.uniform(0.4, 2) * rng.choice((-1, 1)) for x in moving}
    if not (on_constraints and constraints.J):
        return state
    for unknowns, bias in ((symbols.u, constraints.sigma), (symbols.a, constraints.gamma)):
        flat = [*(x for row in constraints.J for x in row), *bias]
        values = np.array([float(x) for x in evaluate(flat, {k: np.float64(v) for k, v in state.items()}, ARRAYS)])
        J, rest = (
            values[: len(constraints.J) * len(unknowns)].reshape(len(constraints.J), -1),
            values[len(constraints.J) * len(unknowns) :],
        )
        x = np.array([state[each] for each in unknowns])
        x = x - np.linalg.lstsq(J, J @ x + rest, rcond=None)[0]
        state |= dict(zip(unknowns, x.tolist(), strict=True))
    return state


@dataclass(frozen=True)
class Search:
    """One comparison in numbers: sigma D = E + sum y C.

    Args:
        D, E: (places, variants); D None: sigma E is 1 and E is what is left, with the opposite sign.
        C: (mistakes, places, variants).
        mistakes: the mistakes.
        row: whose equation E is.
        true: where D is None what the model says, of which something must be left.
        resisting: of E and of each C what must not vanish together.
        opposite: where D is None whether the author's sides are exchanged.
    """

    D: np.ndarray | None
    E: np.ndarray
    C: np.ndarray
    mistakes: Sequence[Mistake]
    row: int
    true: np.ndarray | None = None
    resisting: tuple[np.ndarray, np.ndarray] | None = None
    opposite: bool = False

    def explanations(self, number: int) -> list[Explanation]:
        """The explanations by so many mistakes, one to three."""
        if not len(self.C):
            return []
        left, A, kept = self.projection
        size = float(np.linalg.norm(left))
        if not np.isfinite(size) or size == 0:
            return []
        some = list(range(len(A))) if number == 1 else self._distinct
        if number == MOST_MISTAKES:
            chosen = self._triples(left, A[some], [self.mistakes[kept[i]].rank for i in some])
        else:
            chosen = (self._single, self._pairs)[number - 1](left, A[some])
        found = [self._explained([kept[some[i]] for i in each]) for each in chosen]
        if number == 2:
            found += [self._explained([i, j], y) for i, j, y in self._beside_usual(left, A, kept)]
        return [x for x in found if x is not None]

    def _beside_usual(self, left: np.ndarray, A: np.ndarray, kept: list[int]) -> Iterator[tuple[int, int, float]]:
        """(i, j, y_i): beside a whole contribution that is missing or turned one more mistake, though both do alike."""
        plain = [k for k, i in enumerate(kept) if self.mistakes[i].open and self.mistakes[i].rank == PLAIN]
        for k in plain[:MOST_PLAIN]:
            i = kept[k]
            for y in (-1.0, -2.0):
                beside = left + y * self._length(i, A[k]) * A[k]
                for (j,) in (
                    self._single(beside, A)
                    if np.linalg.norm(beside) > tolerances.CARRIED * np.linalg.norm(left)
                    else ()
                ):
                    if j != k:
                        yield i, kept[j], y

    @cached_property
    def _distinct(self) -> list[int]:
        """The most believable of the mistakes that do the same, the most believable first."""
        _, A, kept = self.projection
        if not kept:
            return []
        with np.errstate(all="ignore"):
            lengths = np.linalg.norm(self._flat(self.C[kept]), axis=1)
        leading = np.take_along_axis(
            A, np.argmax(np.abs(A) > np.abs(A).max(axis=1, keepdims=True) / 2, axis=1)[:, None], 1
        )
        alike = np.round(A * np.sign(leading), ALIKE) + 0.0
        found: dict[tuple[bytes, float], int] = {}
        for k in sorted(range(len(kept)), key=lambda k: self.mistakes[kept[k]].rank):
            often = 0.0 if self.mistakes[kept[k]].open else float(f"{lengths[k] * np.sign(leading[k, 0]):.6g}")
            found.setdefault((alike[k].tobytes(), often), k)
        return list(found.values())

    def _length(self, i: int, direction: np.ndarray) -> float:
        """Length of a mistake along its direction in the projection."""
        (along,) = self._flat(self.C[i : i + 1])
        return float(along @ direction)

    @cached_property
    def projection(self) -> tuple[np.ndarray, np.ndarray, list[int]]:
        """(E, the C that matter) without their shares along D, each of length 1."""
        with np.errstate(all="ignore"):
            A, raw = self._flat(self.C), (self.C / self._size[:, None]).reshape(len(self.C), -1)
        lengths, sizes = np.linalg.norm(A, axis=1), np.linalg.norm(raw, axis=1)
        kept = [
            i
            for i in range(len(A))
            if np.isfinite(lengths[i]) and lengths[i] > tolerances.CARRIED * max(sizes[i], tolerances.COMPUTED)
        ]
        return self._flat(self.E), A[kept] / lengths[kept, None], kept

    @cached_property
    def _size(self) -> np.ndarray:
        """Magnitude of the equation at each configuration; 1 where the author may not have divided."""
        if self.D is None:
            return np.ones(len(self.E))
        sizes: np.ndarray = np.maximum(np.linalg.norm(self.E, axis=1), tolerances.COMPUTED)
        return sizes

    def _flat(self, X: np.ndarray) -> np.ndarray:
        """The array without its share along D at each configuration, in one row."""
        X = X / self._size[:, None]
        if self.D is not None:
            D = self.D / np.maximum(
                np.linalg.norm(self.D, axis=1, keepdims=True), tolerances.COMPUTED * tolerances.COMPUTED
            )
            X = X - np.sum(X * D, axis=-1, keepdims=True) * D
        flat: np.ndarray = X.reshape(*X.shape[:-2], -1)
        return flat

    @property
    def misfit(self) -> float:
        """The part of the equation that is not the author's, as a norm."""
        left, *_ = self.projection
        return float(np.linalg.norm(left)) if np.all(np.isfinite(left)) else float("inf")

    def _single(self, left: np.ndarray, A: np.ndarray) -> Iterator[list[int]]:
        along = A @ left
        for i in np.flatnonzero(
            np.linalg.norm(left - along[:, None] * A, axis=1) < tolerances.SAME_EIGENVALUE * np.linalg.norm(left)
        ):
            yield [int(i)]

    def _pairs(self, left: np.ndarray, A: np.ndarray, among: int = PAIRED, room: int = 2000) -> Iterator[list[int]]:
        A = A[:among]
        G, b, size = A @ A.T, A @ left, float(left @ left)
        free = 1 - G * G
        with np.errstate(all="ignore"):
            explained = (b[:, None] ** 2 + b[None, :] ** 2 - 2 * G * b[:, None] * b[None, :]) / free
        good = np.triu((free > tolerances.SAME_EIGENVALUE) & (size - explained < tolerances.SAME_EIGENVALUE * size), 1)
        found = np.argwhere(good)
        for i, j in found[np.argsort(found.sum(axis=1))][:room]:
            yield [int(i), int(j)]

    def _triples(self, left: np.ndarray, A: np.ndarray, ranks: Sequence[float]) -> Iterator[list[int]]:
        """Three mistakes whose cost is not too high together; the ranks increase."""
        A, room = A[:TRIPLED], DEAREST[3] - 3 * PLAINEST
        for i in range(len(A)):
            believed = bisect_right(ranks, room - sum(ranks[i : i + 2]), 0, len(A))
            rest = A[i + 1 : believed] - np.outer(A[i + 1 : believed] @ A[i], A[i])
            lengths = np.linalg.norm(rest, axis=1)
            kept = np.flatnonzero(lengths > tolerances.CARRIED)
            if len(kept) < 2:
                continue
            without = left - (A[i] @ left) * A[i]
            for pair in self._pairs(without, rest[kept] / lengths[kept, None], TRIPLED, 20):
                yield [i, *(int(kept[k]) + i + 1 for k in pair)]

    def _explained(self, chosen: Sequence[int], first: float | None = None) -> Explanation | None:
        """The explanation of these mistakes, where their factors are simple.

        Args:
            first: y of the first one; None: it is sought.
        """
        if sum(PLAINEST + self.mistakes[i].rank for i in chosen) > DEAREST[len(chosen)]:
            return None  # a factor only makes it dearer
        C, scale = self.C[list(chosen)], self._size
        columns: list[np.ndarray] = [(c / scale[:, None]).ravel() for c in C]
        if self.D is not None:
            for k in range(len(self.D)):
                column = np.zeros_like(self.D)
                column[k] = -self.D[k] / scale[k]
                columns.append(column.ravel() / max(1.0, float(np.linalg.norm(column))))
        target = -(self.E / scale[:, None]).ravel()
        if first is not None:
            target = target - first * columns.pop(0)
        matrix = np.array(columns).T
        lengths: np.ndarray = np.maximum(np.linalg.norm(matrix, axis=0), tolerances.COMPUTED * tolerances.COMPUTED)
        y: np.ndarray = np.linalg.lstsq(matrix / lengths, target, rcond=None)[0]
        if np.linalg.norm(matrix / lengths @ y - target) > tolerances.CARRIED * max(
            float(np.linalg.norm(target)), tolerances.COMPUTED
        ):
            return None
        y = y / lengths if first is None else np.concatenate([[first], y / lengths])
        y = y[: len(chosen)]
        shares = _shares([self.mistakes[i] for i in chosen], y.tolist())
        if shares is None:
            return None
        if not self._is_there([share.mistake.kind != "extra_term" for share in shares], C, y):
            return None
        if self.resisting is not None:
            whole, each = self.resisting
            left = whole + np.tensordot(y, each[list(chosen)], axes=1)
            if not np.all(np.abs(left) > tolerances.CARRIED * np.abs(whole)):
                return None
        scaled, dear = self._scale(C, y)
        gone = any(x.mistake.open and not x.unit and x.factor == 0 for x in shares)
        instead = INSTEAD if gone and any(x.mistake.kind == "extra_term" for x in shares) else 0
        cost = sum(map(cost_of, shares)) + dear + instead + (MIXED if self.row < 0 else 0)
        return Explanation(tuple(shares), self.row, cost, scaled)

    def _is_there(self, own: Sequence[bool], C: np.ndarray, y: np.ndarray) -> bool:
        """True if something is left of the model's equation with all these mistakes, terms of the author apart."""
        true = self.E if self.D is not None else self.true
        if true is None:
            return True
        changed = (
            np.tensordot(y * np.array(own, dtype=float), C, axes=1) if self.D is None else np.tensordot(y, C, axes=1)
        )
        whole = np.linalg.norm(true + changed, axis=1)
        return bool(np.all(whole > tolerances.CARRIED * np.linalg.norm(true, axis=1)))

    def _scale(self, C: np.ndarray, y: np.ndarray) -> tuple[str, float]:
        """The factor by which the author multiplied, and its cost."""
        if self.D is None:
            return ("opposite", TURNED) if self.opposite else ("", 0.0)
        whole = self.E + np.tensordot(y, C, axes=1)
        with np.errstate(all="ignore"):
            sigma = np.sum(whole * self.D, axis=1) / np.sum(self.D * self.D, axis=1)
        if np.allclose(np.abs(sigma), 1, rtol=tolerances.CARRIED):
            return ("", 0.0) if sigma[0] > 0 else ("opposite", TURNED)
        if np.allclose(sigma, sigma[0], rtol=tolerances.CARRIED):
            known = simple_factor(float(sigma[0])) is not None
            return "constant", 1.2 if known else 2.0
        return "function", 1.0 if np.mean(sigma) > 0 else 1.3


def _shares(mistakes: Sequence[Mistake], factors: Sequence[float]) -> list[Share] | None:
    """The mistakes with their factors, where these are such as people write; None where one is not."""
    found: dict[int, Share] = {}
    for k in sorted(range(len(mistakes)), key=lambda k: not mistakes[k].open):
        whole = [x.factor for x in found.values() if x.mistake.open and x.mistake.name == mistakes[k].name]
        share = _share(mistakes[k], factors[k], [1, *whole])
        if share is None:
            return None
        found[k] = share
    return [found[k] for k in range(len(mistakes))]


def _share(mistake: Mistake, y: float, often: Sequence[Fraction | int]) -> Share | None:
    """The mistake with its factor.

    Args:
        often: how often a change may be there.
    """
    if mistake.name.startswith(WHOLE) and abs(1 + y) < tolerances.SAME_EIGENVALUE:
        return None  # something else would have to be there in its place
    if not mistake.open:
        times = next((x for x in often if x and abs(y - x) < tolerances.SAME_EIGENVALUE), None)
        return None if times is None else Share(mistake, Fraction(times))
    for name, (number, _) in UNITS.items():
        if abs(1 + y - number) < tolerances.SAME_EIGENVALUE * number:
            return Share(mistake, Fraction(1), name)
    factor = simple_factor(1 + y)
    if (
        mistake.name.startswith(WHOLE)
        and factor is not None
        and max(abs(factor.numerator), factor.denominator) > WELL_KNOWN
    ):
        return None
    return None if factor is None or factor == 1 else Share(mistake, factor)


def simple_factor(x: float, largest: int = SIMPLE) -> Fraction | None:
    """The fraction that x is, where it is one of small numbers."""
    if not np.isfinite(x) or abs(x) > largest:
        return None
    near = Fraction(x).limit_denominator(largest)
    return near if abs(float(near) - x) < tolerances.SAME_EIGENVALUE and abs(near.numerator) <= largest * 2 else None


def cost_of(share: Share) -> float:
    """The cost of one mistake: the higher, the less readily it is believed."""
    cost = PLAINEST + share.mistake.rank
    if share.unit:
        return cost + 1.5
    if not share.mistake.open:
        return cost
    x = share.factor
    if x == 0:
        return cost
    if x < 0:
        cost += (SQUARED if share.mistake.squares else 0.0) + (MINUS if x != -1 else 0.0)
    cost += WHOLE_MOTION if share.mistake.squares else 0.0
    size = abs(x)
    return cost + next((more for known, more in USUAL if size in known), UNUSUAL)


def explained(
    searches: Sequence[Search],
    proves: Callable[[Explanation], bool],
    number: int,
    dearer: Callable[[Explanation], float] = lambda _: 0.0,
) -> list[Explanation]:
    """The cheapest explanation by so many mistakes that is proven, then others nearly as good; [] where none is.

    Args:
        dearer: how much less than by its cost one is believed; infinity: not at all.
    """
    known = ((x.cost + dearer(x), x) for search in searches for x in search.explanations(number))
    found = [x for cost, x in sorted(known, key=lambda each: each[0]) if cost < np.inf]
    for k, each in enumerate(found[:PROVEN]):
        if proves(each):
            near = [x for x in found[k + 1 :] if x.cost <= each.cost + NEARLY][:MOST_NEAR]
            return [each, *(x for x in near if proves(x))]
    return []


# -------- mistake ---------------------------------------------------------------------------------------------
# One thing that may have gone wrong in an equation, and how readily it is believed.


# how readily a mistake is believed, the smaller the sooner
PLAIN, PLACED, SHARED, PIECES, TERMS, EXCHANGED, ODD = range(7)
SHORTER = 0.3  # of what a shorter name tells as well


@dataclass(frozen=True)
class Mistake:
    """One thing that may have gone wrong.

    Args:
        name: what it concerns, in words; of a wrong factor the contribution.
        kind: of the cause: "factor" where the factor is open, else as in `AREAS`.
        rows: what one unit of it adds to each equation.
        rank: how readily it is believed.
        body, force: whose it is.
        open: whether any simple factor is possible; else it is there once.
        text: the sentence, of what is there once.
        squares: it is made of squares of speeds, of which nobody takes the wrong sign.
    """

    name: str
    kind: str
    rows: ScalarRow
    rank: float
    body: str = ""
    force: str = ""
    open: bool = True
    text: str = ""
    squares: bool = False
