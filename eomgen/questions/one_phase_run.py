"""Motion from the start -> a run of it in one phase; whether it stays in the pieces in which its integrals hold."""

from __future__ import annotations

import math

import numpy as np

from eomgen.codegen.program import program_of, right_hand_side
from eomgen.codegen.rhs import compiled
from eomgen.errors import RunFailed
from eomgen.mechanics.equations.articulated import with_accelerations
from eomgen.mechanics.equations.pieces import Extent
from eomgen.mechanics.initial_state.numeric_value import known_exactly
from eomgen.questions.motion_from_start import MotionFromStart
from eomgen.simulation.constraint_drift import projection_of
from eomgen.simulation.constraint_rank import nearness_of
from eomgen.simulation.integrate import integrate
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.numeric.sure_numbers import number_of
from eomgen.symbolic.numeric.tolerances import COMPUTED, FINE_RUN

STEPS = 2000  # of a run in time that one instant is compared with
WATCHED, INSTANTS = 100.0, 8001  # s of a motion that is watched for whether it stays in its piece, and how closely
WATCHED_BRIEFLY = 10.0  # s, where a hundred take too many steps
WATCHED_STEPS = 20_000


def run_from_start(motion: MotionFromStart, time: float, samples: int | None = None, steps: int = STEPS) -> Trajectory:
    """The motion from the start, in one phase, by emitted code.

    Raises:
        RunFailed: it does not get there.
    """
    phase, p = motion.phase, parameters_in_numbers(motion)
    system, equations, symbols = phase.system, phase.equations, phase.system.symbols
    x0 = np.array([motion.numbers[node] for node in (*symbols.q, *symbols.u)])
    rhs = compiled(right_hand_side(with_accelerations(equations)), "numpy")
    run = integrate(
        rhs,
        time=time,
        x0=x0,
        p=p,
        rtol=FINE_RUN,
        atol=FINE_RUN,
        samples=samples,
        projection=projection_of(system, p, "numpy"),
        nearness=nearness_of(equations, p, system),
        most_steps=steps,
    )
    if not run.ok:
        raise RunFailed(f"the run does not get there: {run.message}", mend="ask for an earlier instant")
    return run


def parameters_in_numbers(motion: MotionFromStart) -> np.ndarray:
    """The parameters of the phase; nan of those without a value."""
    known = known_exactly(motion.phase.system.scope)
    symbols = motion.phase.system.symbols
    return np.array([number_of(known[node]) if node in known else math.nan for node in symbols.parameters.values()])


def leaves_at(motion: MotionFromStart, held: Extent) -> float | None:
    """When the motion first leaves the pieces in which something holds; None: it stays, as far as it was watched.

    Raises:
        RunFailed: it cannot be followed.
    """
    try:
        run = run_from_start(motion, WATCHED, INSTANTS, WATCHED_STEPS)
    except RunFailed:
        run = run_from_start(motion, WATCHED_BRIEFLY, INSTANTS, WATCHED_STEPS)
    system = motion.phase.system
    function = compiled(program_of(held.limits, system.symbols, inputs=system.inputs), "numpy")
    with np.errstate(all="ignore"):
        over = function.many(run.t, run.x, parameters_in_numbers(motion))
    worst = np.max(over, axis=1)
    out = worst > COMPUTED * (1 + np.max(np.abs(over), initial=0.0))
    if not out.any():
        return None
    k = max(int(np.argmax(out)), 1)
    share = -worst[k - 1] / (worst[k] - worst[k - 1]) if worst[k - 1] < 0 else 0.0  # of the way between two instants
    return float(run.t[k - 1] + share * (run.t[k] - run.t[k - 1]))
