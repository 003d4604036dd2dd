"""Ranges, distributions, seed -> values of run k, by its number alone, in any order and on any machine.

The values do not depend on the runs made before, or on the process that makes them.

A run is a point of the grid and a draw: k = point * draws + draw. Draws are u in (0, 1)^d, and a distribution gives the
value that belongs to a share u of all.
"""

from __future__ import annotations

import hashlib
import json
import math
import pickle
import platform
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, field, replace
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np

from eomgen.errors import ExpressionError, UsageError
from eomgen.files import json_text
from eomgen.frozen import dataclass
from eomgen.model import Model, Requests, Taken, TypedNumbers, Valued, loads, nearest
from eomgen.sensitivities import slope_requested
from eomgen.symbolic.numeric import tolerances
from eomgen.version import __version__

DesignKind = Literal["random", "sobol", "lhs"]
DESIGNS: tuple[str, ...] = get_args(DesignKind)
LIKE = '"phi=normal(0, 0.1)" or "m=uniform(1, 2)"'
ORDERS = 1  # the first number of a spawn key that is of no run


@dataclass(frozen=True)
class Distribution:
    """A distribution.

    Args:
        arguments: their names; those in `plain` have no unit.
        quantile: (u, arguments) -> the value below which the probability is u.
    """

    arguments: tuple[str, ...]
    quantile: Callable[..., np.ndarray]
    plain: frozenset[str] = frozenset()
    positive: frozenset[str] = frozenset()


def _normal(u: np.ndarray, mean: float, deviation: float) -> np.ndarray:
    from scipy.special import ndtri

    return np.asarray(mean + deviation * ndtri(u))


def _triangular(u: np.ndarray, low: float, mode: float, high: float) -> np.ndarray:
    share = (mode - low) / (high - low)
    rising = low + np.sqrt(u * (high - low) * (mode - low))
    falling = high - np.sqrt((1 - u) * (high - low) * (high - mode))
    return np.where(u < share, rising, falling)


LAWS: dict[str, Distribution] = {
    "normal": Distribution(("mean", "deviation"), _normal, positive=frozenset(["deviation"])),
    "uniform": Distribution(("low", "high"), lambda u, low, high: low + (high - low) * u),
    "loguniform": Distribution(
        ("low", "high"), lambda u, low, high: low * (high / low) ** u, positive=frozenset(["low", "high"])
    ),
    "lognormal": Distribution(
        ("median", "deviation"),
        lambda u, median, deviation: median * np.exp(_normal(u, 0.0, deviation)),
        frozenset(["deviation"]),
        frozenset(["median", "deviation"]),
    ),
    "triangular": Distribution(("low", "mode", "high"), _triangular),
}


@dataclass(frozen=True)
class DrawnValues:
    """Distribution of one name: its law and its arguments in SI."""

    name: str
    law: str
    arguments: tuple[float, ...]

    def at(self, u: np.ndarray) -> np.ndarray:
        """Values at the cumulative probabilities u (quantiles)."""
        return LAWS[self.law].quantile(u, *self.arguments)


def spread_of(model: Model, text: str, *, declared: bool = True) -> tuple[DrawnValues, Taken]:
    """(distribution of a text, "phi=normal(0, 0.1)", the reading of its numbers).

    Raises:
        UsageError: no parameter or start has that name, the law is unknown, or its arguments are wrong.
    """
    name, equals, law = (part.strip() for part in text.partition("="))
    word, opened, inside = law.partition("(")
    if not equals or not opened or not inside.endswith(")"):
        raise UsageError(f"'{text}' is no distribution", fix=LIKE)
    Requests(model).refuse_what_is_not_set(name, starts=True)
    known = LAWS.get(word.strip())
    if known is None:
        raise UsageError(f"'{text}': no distribution '{word}'", fix=nearest(word, LAWS) or f"one of {', '.join(LAWS)}")
    given = inside[:-1].split(",")
    shown = f"{word}({', '.join(known.arguments)})"
    if len(given) != len(known.arguments):
        raise UsageError(f"'{text}' has {len(given)} arguments", fix=shown)
    typed = TypedNumbers(model, name, declared)
    try:
        pairs = tuple(zip(known.arguments, given, strict=True))
        numbers = tuple(float(x) if what in known.plain else typed.number(x) for what, x in pairs)
    except ValueError as error:
        raise UsageError(f"'{text}': its arguments are no numbers", fix=shown) from error
    except ExpressionError as error:
        raise UsageError(f"'{text}': {error.what}", fix=error.fix) from error
    _refuse_no_law(text, known, numbers)
    drawn = DrawnValues(name, word.strip(), numbers)
    with_unit = [x.strip() for what, x in pairs if what not in known.plain]
    plain = {k: x.strip() for k, (what, x) in enumerate(pairs) if what in known.plain}

    def reported(words: list[str]) -> str:
        rest = iter(words)
        return f"{drawn.law}({', '.join(plain.get(k) or next(rest) for k in range(len(pairs)))})"

    taken = typed.taken(law, with_unit, reported)
    values = iter(taken.value if isinstance(taken.value, tuple) else ())
    return drawn, replace(taken, value=tuple(numbers[k] if k in plain else next(values) for k in range(len(pairs))))


def _refuse_no_law(text: str, law: Distribution, numbers: Sequence[float]) -> None:
    by_name = dict(zip(law.arguments, numbers, strict=True))
    if not all(map(math.isfinite, numbers)):
        raise UsageError(f"'{text}': its arguments are no finite numbers", fix=LIKE)
    for what in law.positive:
        if by_name[what] <= 0:
            raise UsageError(f"'{text}': its {what} is not above 0", fix=LIKE)
    ordered = [x for what, x in by_name.items() if what in ("low", "mode", "high")]
    if ordered != sorted(ordered) or (ordered and ordered[0] == ordered[-1]):
        raise UsageError(f"'{text}': {', '.join(law.arguments)} do not ascend", fix=LIKE)


@dataclass(frozen=True)
class Design:
    """All runs of a sweep.

    Args:
        grid: the values of each name over which it goes, in SI.
        spreads: of each name that is drawn.
        draws: at each point of the grid.
        kind: how they are drawn.
    """

    grid: Mapping[str, tuple[float, ...]]
    spreads: tuple[DrawnValues, ...]
    draws: int
    kind: str
    seed: int

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the values that are set, in order."""
        return (*self.grid, *(spread.name for spread in self.spreads))

    @property
    def points(self) -> int:
        return math.prod(len(values) for values in self.grid.values())

    @property
    def count(self) -> int:
        """Number of runs."""
        return self.points * self.draws

    def runs(self, first: int, last: int) -> tuple[list[int], np.ndarray]:
        """(seeds below 2^63, values that are set [SI], runs x names) of the runs from `first` up to `last`."""
        runs = np.arange(first, last)
        seeds = [_seed_of(self.seed, int(k)) for k in runs]
        columns, point = [], runs // self.draws
        for values in reversed(tuple(self.grid.values())):
            point, place = np.divmod(point, len(values))
            columns.append(np.asarray(values)[place])
        drawn = self._drawn(runs, seeds)
        columns = columns[::-1] + [spread.at(drawn[:, k]) for k, spread in enumerate(self.spreads)]
        return seeds, np.column_stack(columns) if columns else np.zeros((len(runs), 0))

    def _drawn(self, runs: np.ndarray, seeds: Sequence[int]) -> np.ndarray:
        """u of each run, runs x spreads."""
        many, draws = len(self.spreads), runs % self.draws
        if not many or self.kind == "random":
            return _chance(seeds, many)
        if self.kind == "sobol":
            return self._sobol(draws)
        own = seeds if self.draws == self.count else [_seed_of(self.seed, int(k)) for k in draws]
        strata = np.column_stack([order[draws] for order in self._orders])
        return np.asarray((strata + _chance(own, many)) / self.draws)

    def _sobol(self, draws: np.ndarray) -> np.ndarray:
        """Points of a scrambled Sobol sequence by their numbers."""
        from scipy.stats import qmc

        found = np.empty((len(draws), len(self.spreads)))
        start = 0
        for stop in [*(np.flatnonzero(np.diff(draws) != 1) + 1).tolist(), len(draws)]:
            sequence = qmc.Sobol(len(self.spreads), scramble=True, bits=MOST_BITS, seed=self._order_generator(0))
            if draws[start]:
                sequence.fast_forward(int(draws[start]))
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)  # so many runs as the user wants, a power of 2 or not
                found[start:stop] = sequence.random(stop - start)
            start = stop
        half = 0.5**MOST_BITS / 2
        return np.clip(found, half, 1 - half)

    @cached_property
    def _orders(self) -> list[np.ndarray]:
        """Order in which the strata of each name are drawn."""
        return [self._order_generator(d).permutation(self.draws) for d in range(len(self.spreads))]

    def _order_generator(self, d: int) -> np.random.Generator:
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(ORDERS, d)))


MOST_BITS = 30
_GOLDEN = 0x9E3779B97F4A7C15


def _seed_of(seed: int, run: int) -> int:
    """Seed of a run by its number: numpy's SeedSequence with the number as its spawn key."""
    return int(np.random.SeedSequence(seed, spawn_key=(0, run)).generate_state(1, np.uint64)[0] >> np.uint64(1))


def _chance(seeds: Sequence[int], many: int) -> np.ndarray:
    """Random numbers in the open interval (0, 1), so many for each seed, by the generator SplitMix64.

    Source: Steele, Lea & Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
    """
    z = np.asarray(seeds, dtype=np.uint64)[:, None] + np.arange(1, many + 1, dtype=np.uint64) * np.uint64(_GOLDEN)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z ^= z >> np.uint64(31)
    return np.asarray(((z >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53)


def refuse_bad_design(kind: Any, runs: Any, seed: Any) -> None:
    """Refuses a wrong design.

    Raises:
        UsageError: its kind, the number of its runs or its seed is wrong.
    """
    if kind not in DESIGNS:
        raise UsageError(f"no design '{kind}'", fix=f"one of {', '.join(DESIGNS)}")
    if not isinstance(runs, int) or isinstance(runs, bool) or runs < 1:
        raise UsageError(f"{runs} runs make no sense", fix="give 1 or more")
    if not isinstance(seed, int) or isinstance(seed, bool) or seed < 0:
        raise UsageError(f"the seed {seed} is no whole number from 0 on", fix="--seed 1")


# -------- plan ------------------------------------------------------------------------------------------------
# SweepPlan: everything on which the numbers of a sweep depend, as a file that a person can read.


FIXED = ("run", "seed", "status", "message")  # columns before the values set and requested
SCHEMA = 1


@dataclass(frozen=True)
class Stepped:
    """Settings of the integration of each run."""

    time: float = 10.0
    rtol: float = tolerances.RUN
    atol: float = tolerances.RUN
    method: str = "DOP853"


@dataclass(frozen=True)
class SweepPlan:
    """A sweep.

    Args:
        text: the model file; "" for a model that was made in Python.
        title: the name of a model that has none of its own.
        given, start: values that hold in every run, as they were typed; plain numbers are in the unit of the file.
        over: the values of each name over which it goes [SI].
        random: (name, law, arguments [SI]) of each name that is drawn.
        ask, critical: requests of each run, and the expression that changes its sign at a critical value; "": none.
        made: the model that was made in Python.
    """

    text: str
    title: str
    over: Mapping[str, tuple[float, ...]]
    random: tuple[tuple[str, str, tuple[float, ...]], ...]
    draws: int
    design: str
    seed: int
    ask: tuple[str, ...]
    critical: str
    how: Stepped
    given: Mapping[str, str] = field(default_factory=dict)
    start: Mapping[str, str] = field(default_factory=dict)
    made: Model | None = None

    @cached_property
    def model(self) -> Model:
        """The model at the values that hold in every run."""
        declared = self.made if self.made is not None else loads(self.text, "plan.json", self.title)
        options = ("--set", "--start")
        return Valued.of(declared, self.given, self.start, options=options, declared=True).model

    @cached_property
    def slopes(self) -> dict[str, tuple[str, str]]:
        """Requested derivatives, "d(frequency(1))/d(k)": (formula, name) by the text of the request."""
        pairs = ((text, slope_requested(text)) for text in self.requested)
        return {text: pair for text, pair in pairs if pair is not None}

    @cached_property
    def runs(self) -> Design:
        """All runs."""
        spreads = tuple(DrawnValues(name, law, tuple(arguments)) for name, law, arguments in self.random)
        return Design({name: tuple(x) for name, x in self.over.items()}, spreads, self.draws, self.design, self.seed)

    @property
    def requested(self) -> tuple[str, ...]:
        """Requests of each run, the critical expression included."""
        return tuple(dict.fromkeys((*self.ask, *filter(None, [self.critical]))))

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the table; a request with the name of a value that is set gets ` (asked)` behind it."""
        names = self.runs.names
        return (*FIXED, *names, *(f"{ask} (asked)" if ask in names else ask for ask in self.requested))

    @property
    def hash(self) -> str:
        """Hash of everything on which the numbers depend; a plan of another hash is another sweep."""
        reported = {name: x for name, x in self.as_dict().items() if name not in ("hash", "versions")}
        return hashlib.sha256(json.dumps(reported, sort_keys=True).encode()).hexdigest()[:16]

    def as_dict(self) -> dict[str, Any]:
        """Content of plan.json, and of a part of the sweep for another process."""
        reported = {name: x for name, x in asdict_of(self).items() if name != "made"}
        reported["model_hash"] = "" if self.made is None else hashlib.sha256(pickle.dumps(self.made)).hexdigest()
        return {"schema": SCHEMA, **reported}

    def written(self) -> str:
        """plan.json."""
        versions = {"eomgen": __version__, "numpy": np.__version__, "python": platform.python_version()}
        versions |= {"machine": platform.machine(), "system": platform.system()}
        reported = {"hash": self.hash, "runs": self.runs.count, "columns": list(self.columns), **self.as_dict()}
        return json_text(reported | {"versions": versions}, indent=1) + "\n"


def asdict_of(plan: SweepPlan) -> dict[str, Any]:
    """Its fields as plain values."""
    names = ("text", "title", "draws", "design", "seed", "critical")
    reported: dict[str, Any] = {name: getattr(plan, name) for name in names}
    reported |= {
        "over": [[name, list(x)] for name, x in plan.over.items()],
        "ask": list(plan.ask),
        "how": asdict(plan.how),
    }
    reported["random"] = [[name, law, list(arguments)] for name, law, arguments in plan.random]
    return reported | {"given": dict(plan.given), "start": dict(plan.start)}


def plan_of(reported: Mapping[str, Any], made: Model | None = None) -> SweepPlan:
    """Plan written by `as_dict` or `written`.

    Raises:
        UsageError: it is none.
    """
    try:
        return SweepPlan(
            text=reported["text"],
            title=reported["title"],
            over={name: tuple(map(float, values)) for name, values in reported["over"]},
            random=tuple((name, law, tuple(map(float, arguments))) for name, law, arguments in reported["random"]),
            draws=int(reported["draws"]),
            design=reported["design"],
            seed=int(reported["seed"]),
            ask=tuple(reported["ask"]),
            critical=reported["critical"],
            how=Stepped(**reported["how"]),
            given=reported["given"],
            start=reported["start"],
            made=made,
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UsageError(
            f"plan.json is no plan of a sweep: {error}", fix="begin the sweep anew in another folder"
        ) from error


def texts(values: Sequence[str] | str) -> tuple[str, ...]:
    """One text, or several."""
    return (values,) if isinstance(values, str) else tuple(values)
