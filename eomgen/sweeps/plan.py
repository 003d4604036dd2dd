"""SweepPlan: everything on which the numbers of a sweep depend, as a file that a person can read."""

from __future__ import annotations

import hashlib
import json
import pickle
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, field
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import UsageError
from eomgen.model.parts import Model
from eomgen.model.reader import loads
from eomgen.model.replaced import with_values
from eomgen.records import dataclass
from eomgen.sensitivities.sensitivity import slope_asked
from eomgen.sweeps.design import Design, DrawnValues
from eomgen.symbolic.numeric.tolerances import RUN
from eomgen.version import __version__

FIXED = ("run", "seed", "status", "message")  # columns before what is set and what is asked
SCHEMA = 1


@dataclass(frozen=True)
class Stepped:
    """How each run is integrated."""

    time: float = 10.0
    rtol: float = RUN
    atol: float = RUN
    method: str = "DOP853"


@dataclass(frozen=True)
class SweepPlan:
    """A sweep.

    Args:
        text: the model file; "" of a model that was made in Python.
        title: the name of a model that gives itself none.
        given, start: values that hold in every run, as they were typed; plain numbers are in the unit of the file.
        over: the values of each name over which it goes [SI].
        random: (name, law, arguments [SI]) of each name that is drawn.
        ask, critical: what is asked of each run, and what changes its sign at a critical value; "" is nothing.
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
        return with_values(declared, self.given, self.start, options=options, declared=True).model

    @cached_property
    def slopes(self) -> dict[str, tuple[str, str]]:
        """What is asked as a derivative, "d(frequency(1))/d(k)": of what, by what."""
        pairs = ((text, slope_asked(text)) for text in self.asked)
        return {text: pair for text, pair in pairs if pair is not None}

    @cached_property
    def runs(self) -> Design:
        """All runs."""
        spreads = tuple(DrawnValues(name, law, tuple(arguments)) for name, law, arguments in self.random)
        return Design({name: tuple(x) for name, x in self.over.items()}, spreads, self.draws, self.design, self.seed)

    @property
    def asked(self) -> tuple[str, ...]:
        """What is asked of each run, the critical expression too."""
        return tuple(dict.fromkeys((*self.ask, *filter(None, [self.critical]))))

    @property
    def columns(self) -> tuple[str, ...]:
        """Of the table. What is asked under the name of what is set has `(asked)` behind it."""
        names = self.runs.names
        return (*FIXED, *names, *(f"{ask} (asked)" if ask in names else ask for ask in self.asked))

    @cached_property
    def hash(self) -> str:
        """Of everything on which the numbers depend; a plan of another hash is another sweep."""
        told = {name: x for name, x in self.as_dict().items() if name not in ("hash", "versions")}
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:16]

    def as_dict(self) -> dict[str, Any]:
        """For plan.json, and for those who run a part of it."""
        told = {name: x for name, x in asdict_of(self).items() if name != "made"}
        told["model_hash"] = "" if self.made is None else hashlib.sha256(pickle.dumps(self.made)).hexdigest()
        return {"schema": SCHEMA, **told}

    def written(self) -> str:
        """plan.json."""
        versions = {"eomgen": __version__, "numpy": np.__version__, "python": platform.python_version()}
        versions |= {"machine": platform.machine(), "system": platform.system()}
        told = {"hash": self.hash, "runs": self.runs.count, "columns": list(self.columns), **self.as_dict()}
        return json.dumps(told | {"versions": versions}, indent=1) + "\n"


def asdict_of(plan: SweepPlan) -> dict[str, Any]:
    """Its fields as plain values."""
    names = ("text", "title", "draws", "design", "seed", "critical")
    told: dict[str, Any] = {name: getattr(plan, name) for name in names}
    told |= {"over": [[name, list(x)] for name, x in plan.over.items()], "ask": list(plan.ask), "how": asdict(plan.how)}
    told["random"] = [[name, law, list(arguments)] for name, law, arguments in plan.random]
    return told | {"given": dict(plan.given), "start": dict(plan.start)}


def plan_of(told: Mapping[str, Any], made: Model | None = None) -> SweepPlan:
    """The plan that `as_dict` or `written` tells.

    Raises:
        UsageError: it is none.
    """
    try:
        return SweepPlan(
            text=told["text"],
            title=told["title"],
            over={name: tuple(map(float, values)) for name, values in told["over"]},
            random=tuple((name, law, tuple(map(float, arguments))) for name, law, arguments in told["random"]),
            draws=int(told["draws"]),
            design=told["design"],
            seed=int(told["seed"]),
            ask=tuple(told["ask"]),
            critical=told["critical"],
            how=Stepped(**told["how"]),
            given=told["given"],
            start=told["start"],
            made=made,
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UsageError(
            f"plan.json is no plan of a sweep: {error}", mend="begin the sweep anew in another folder"
        ) from error


def texts(values: Sequence[str] | str) -> tuple[str, ...]:
    """One text, or several."""
    return (values,) if isinstance(values, str) else tuple(values)
