"""Quantities of a whole run, and of the linearized system."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import OutputContext, OutputFunction, OutputSource
from eomgen.symbolic.expression import Call, Scalar

# -------- of a run --------------------------------------------------------------------------------------------
# max, min, mean, rms, last, period, ...: what a formula does along a run, which no single state gives.
#
# They are found by `simulate`; their second way is the run itself, of which no state may be above its maximum.


def _of_no_state(context: OutputContext, call: Call) -> Scalar:
    raise DerivationError(
        f"'{call}' is of a run, not of a state", fix="`eomgen simulate` gives it, its slopes `sweep`: d(last(x))/d(m)"
    )


def _of(names: tuple[str, ...], gives: str, unit: str = "1", like: int | None = 0) -> OutputFunction:
    return OutputFunction(
        names=names,
        kinds=("formula",),
        least=1,
        unit=unit,
        like=like,
        gives=gives,
        value=_of_no_state,
        source=OutputSource.OF_A_RUN,
    )


ALONG_A_RUN = (
    _of(("max", "min"), "[of a run](#of-a-run): the largest and the least value, also between its samples"),
    _of(("mean", "rms"), "mean over the time of a run, and root of the mean square"),
    _of(("last",), "the value at its end"),
    _of(("time_of_max", "time_of_min"), "when it is largest, least", "s", None),
    _of(("period",), "from one upward passage through its mean to the next, the mean of all", "s", None),
)


# -------- small motions ---------------------------------------------------------------------------------------
# mass, damping, stiffness, frequency: of the linearized system, which is none of a state; proven as `linearize` is.


def _of_linearization(scene: OutputContext, call: Call) -> Scalar:
    raise DerivationError(f"'{call}' is of the linearized system, not of a state", fix="ask it by itself")


def _entry(name: str, unit: str, letter: str) -> OutputFunction:
    return OutputFunction(
        names=(name,),
        kinds=("coordinate", "coordinate"),
        least=2,
        unit=unit,
        per=(0, 1),
        gives=f"entry of {letter} of the [small motions](small_motions.md)",
        value=_of_linearization,
        source=OutputSource.SMALL_MOTIONS,
    )


ENTRIES = (_entry("mass", "J*s^2", "M"), _entry("damping", "J*s", "C"), _entry("stiffness", "J", "K"))
FREQUENCY = OutputFunction(
    names=("frequency",),
    kinds=("number",),
    least=1,
    unit="rad/s",
    gives="the k-th frequency Im λ of the [small motions](small_motions.md), ascending",
    value=_of_linearization,
    source=OutputSource.SMALL_MOTIONS,
)
