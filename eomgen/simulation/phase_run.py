"""What one phase of a motion was."""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.simulation.contact_events import EventFunction
from eomgen.simulation.integrator import Run
from eomgen.simulation.phase_change import PhaseStart
from eomgen.simulation.phase_model import PhaseModel


@dataclass(frozen=True)
class PhaseRun:
    """One phase as it was run.

    Args:
        here: its start.
        phase: its equations.
        run: what the integrator left.
        bound: what ended it; None where the time, a condition or a failure did.
        after: what follows the bound.
    """

    here: PhaseStart
    phase: PhaseModel
    run: Run
    bound: EventFunction | None
    after: PhaseStart | None
