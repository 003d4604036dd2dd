"""SweepPlan, numbers of runs -> their rows. It runs in any process, and knows nothing of the other runs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Any

from eomgen.errors import EomgenError
from eomgen.mechanics.instant.outputs import asks_of
from eomgen.model.fields import AtRest
from eomgen.model.outputs.base import SMALL_MOTIONS
from eomgen.model.parts import Model, Output
from eomgen.model.replaced import with_values
from eomgen.model.table import Table
from eomgen.pipeline import simulator
from eomgen.questions.answers import solve
from eomgen.questions.of_a_run import asked_of
from eomgen.questions.simulator import Simulator
from eomgen.records import dataclass
from eomgen.sensitivities.sensitivity import slope_in_si
from eomgen.simulation.result import Trajectory
from eomgen.sweeps.plan import SweepPlan, plan_of
from eomgen.symbolic.numeric.work import PatienceEnded

FAILED = "failed"
WITHOUT_MOTION = "computed"
CUT: dict[str, type[BaseException]] = {"interrupted": KeyboardInterrupt, "out of patience": PatienceEnded}
SampleRow = tuple[Any, ...]
"""run, seed, status, message, what was set, what was asked; None where it has no value"""


@dataclass(frozen=True)
class SweepKernel:
    """The runs of a plan, one after the other; derived and compiled once.

    Args:
        plan: of them.
    """

    plan: SweepPlan

    def rows(self, first: int, last: int) -> list[SampleRow]:
        """The rows of the runs from `first` up to `last`."""
        seeds, values = self.plan.runs.runs(first, last)
        found = []
        for run, seed, set_ in zip(range(first, last), seeds, values.tolist(), strict=True):
            status, message, asked = self.asked(dict(zip(self.plan.runs.names, set_, strict=True)))
            found.append((run, seed, status, message, *set_, *asked))
        return found

    def asked(self, set_: Mapping[str, float]) -> tuple[str, str, list[float | None]]:
        """(status, message, what is asked) of a run; what goes wrong is its message."""
        told: dict[str, float | None] = dict.fromkeys(self.plan.asked)
        status, messages = WITHOUT_MOTION, list[str]()
        for part in (self._in_motion_told, self._without_motion, self._slopes_told):
            try:
                status = part(set_, told, messages) or status
            except (EomgenError, ArithmeticError, ValueError) as error:
                status, messages = FAILED, [*messages, _sentence(error)]
        return status, "; ".join(messages), [finite(x) for x in told.values()]

    def _in_motion_told(self, set_: Mapping[str, float], told: dict[str, float | None], messages: list[str]) -> str:
        """What is asked of the motion; how that ended."""
        if not self._in_motion:
            return ""
        run = self.motion(set_)
        if run.status in CUT:  # no row: the same command makes it then
            raise CUT[run.status]
        if not run.ok:
            messages.append(run.message)
            return run.status
        for text, output in self._in_motion.items():
            found = run.ask(output)
            told[text] = found.value if isinstance(found.value, float) else None
            messages += [f"{text}: {found.message}"] if found.message else []
        return run.status

    def motion(self, set_: Mapping[str, float], samples: int = 2, columns: Sequence[str] = ()) -> Trajectory:
        """One run from these values [SI]."""
        parameters, start = self._parted(set_)
        return self._simulator(self.plan.how.time, parameters, start, samples, columns)

    def valued(self, set_: Mapping[str, float]) -> Model:
        """The model at these values [SI]."""
        parameters, start = self._parted(set_)
        return with_values(self.plan.model, parameters, start).model

    def _parted(self, set_: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
        names = self.plan.model.parameters
        parameters = {name: x for name, x in set_.items() if name in names}
        return parameters, {name: x for name, x in set_.items() if name not in names}

    def _without_motion(self, set_: Mapping[str, float], told: dict[str, float | None], messages: list[str]) -> str:
        """What is asked at rest, by the energy theorem, of small motions: as `solve` answers it."""
        if not self._solved:
            return ""
        asked = list(self._solved)
        outputs = {f"asked{k}": replace(self._solved[text], unit=None) for k, text in enumerate(asked)}
        answers = dict(zip(asked, solve(replace(self.valued(set_), outputs=Table(outputs))).values(), strict=True))
        for text, answer in answers.items():
            told[text] = answer.value
            messages += [f"{text}: {answer.message}"] if answer.value is None else []
        return ""

    def _slopes_told(self, set_: Mapping[str, float], told: dict[str, float | None], messages: list[str]) -> str:
        """The derivatives that are asked, by the equations themselves."""
        if not self.plan.slopes:
            return ""
        model = self.valued(set_)
        for text, pair in self.plan.slopes.items():
            found, message = slope_in_si(model, *pair, self.plan.how.time)
            told[text] = found
            messages += [f"{text}: {message}"] if message else []
        return ""

    @cached_property
    def _simulator(self) -> Simulator:
        how = self.plan.how
        model = replace(self.plan.model, outputs=Table({}))
        return simulator(model, rtol=how.rtol, atol=how.atol, method=how.method)

    @cached_property
    def _outputs(self) -> dict[str, Output]:
        return {text: asked_of(self.plan.model, text) for text in self.plan.asked if text not in self.plan.slopes}

    @cached_property
    def _in_motion(self) -> dict[str, Output]:
        return {text: output for text, output in self._outputs.items() if not is_without_motion(output)}

    @cached_property
    def _solved(self) -> dict[str, Output]:
        return {text: output for text, output in self._outputs.items() if is_without_motion(output)}


def is_without_motion(output: Output) -> bool:
    """True if `solve` answers it: at rest, from another start, of the linearized system."""
    return isinstance(output.at, AtRest) or output.from_ is not None or asks_of(output.value, SMALL_MOTIONS)


def _sentence(error: Exception) -> str:
    if isinstance(error, EomgenError):
        return f"{error.what}; {error.mend}" if error.mend else error.what
    return f"{type(error).__name__}: {error}"


def finite(x: float | None) -> float | None:
    """A number; None where it has no value."""
    return x if x is not None and math.isfinite(x) else None


# -- in any process ------------------------------------------------------------------------------------------

Payload = tuple[str, Any]
"""(the plan as JSON, the model that was made in Python or None): what another process needs"""


def payload_of(plan: SweepPlan) -> Payload:
    """What another process needs to run a part of a plan."""
    return json.dumps(plan.as_dict(), sort_keys=True), plan.made


def rows_of_runs(payload: Payload, first: int, last: int) -> list[SampleRow]:
    """The rows of some runs, in this process."""
    return _kernel(*payload).rows(first, last)


def value_of_run(payload: Payload, set_: Mapping[str, float], text: str) -> float | None:
    """What one asked expression is worth at some values [SI]."""
    kernel = _kernel(*payload)
    _, _, asked = kernel.asked(set_)
    return finite(asked[kernel.plan.asked.index(text)])


@lru_cache(maxsize=2)
def _kernel(told: str, made: Any) -> SweepKernel:
    return SweepKernel(plan_of(json.loads(told), made))
