"""What one phase of a motion was."""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.simulation.course import Standing
from eomgen.simulation.stage import Stage
from eomgen.simulation.stepping import Run
from eomgen.simulation.watching import Bound


@dataclass(frozen=True)
class Stretch:
    """One phase as it was run.

    Args:
        here: its start.
        stage: its equations.
        run: what the integrator left.
        bound: what ended it; None where the time, a condition or a failure did.
        after: what follows the bound.
    """

    here: Standing
    stage: Stage
    run: Run
    bound: Bound | None
    after: Standing | None
