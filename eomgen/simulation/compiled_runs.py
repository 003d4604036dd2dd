"""PhaseModel, starts and parameters of many runs -> their states, by marches in C: a run costs no Python at all.

Each thread has one march, which takes the runs one after the other, each as `CompiledSteps` takes a run of its own. A
run of which a step wants a look (near a singular position, a constraint that does not close, stiff, no value) is left
undone.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from functools import partial

import numpy as np

from eomgen.codegen import in_threads, pieces_of
from eomgen.frozen import dataclass
from eomgen.simulation.compiled_steps import CompiledSteps
from eomgen.simulation.constraint_drift import RankLookout
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.many_runs import library_of_march
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.singular import NEARNESS, vanishing_after
from eomgen.simulation.solvers import SEEN

AT_ONCE = 20_000  # steps in a call, a few hundredths of a second: between two calls somebody may have lost patience
_SIZE, _AT = ctypes.c_size_t, ctypes.c_void_p


class _Runs(ctypes.Structure):
    """`struct runs` of march.c, in its order."""

    _fields_ = (
        *((name, _SIZE) for name in "next last is_begun functions parameters most_steps most_seen begins".split()),
        ("start", ctypes.c_double),
        *((name, _AT) for name in "x0 p x is_done steps rates constants stops".split()),
        ("n_stops", _SIZE),
    )


@dataclass(frozen=True)
class MarchedRuns:
    """Results of runs.

    Args:
        x: runs x instants x states.
        is_done: True for each run that came to its end without a look; of the others nothing is known.
        steps: the number that each took.
    """

    x: np.ndarray
    is_done: np.ndarray
    steps: np.ndarray


def marched(
    phase: PhaseModel,
    starts: tuple[np.ndarray, np.ndarray],
    how: Stepping,
    instants: np.ndarray,
    end: float,
    *,
    threads: int,
    check: Callable[[], None],
) -> MarchedRuns | None:
    """The runs of a phase without bounds; None where not all that is watched is in C.

    Args:
        starts: states, runs x states, and parameters, runs x parameters.
        how: the integrator's options, with the tolerances of one step.
        check: called now and then; its exceptions end all runs.
    """
    x0, p = (np.ascontiguousarray(each, dtype=float) for each in starts)
    n = len(x0)
    found = MarchedRuns(np.zeros((n, len(instants), x0.shape[1])), np.zeros(n, np.int32), np.zeros(n, np.uintp))
    pieces = pieces_of(n, min(threads, n))
    marches = [_march(phase.at(p[first]), x0[first], how, instants, end) for first, _ in pieces]
    if any(each.struct.is_blind for each in marches):
        return None
    work = [partial(_runs, m, (x0, p), found, piece, how.most_steps) for m, piece in zip(marches, pieces, strict=True)]
    in_threads(work, check)
    return MarchedRuns(found.x, found.is_done.astype(bool) & _determined(phase, found.x, p, instants), found.steps)


def _march(phase: PhaseModel, x: np.ndarray, how: Stepping, instants: np.ndarray, end: float) -> CompiledSteps:
    """A march with the checks of a single run."""
    nearness = phase.nearness
    lookout = None if nearness is None else RankLookout(nearness, NEARNESS[0], 0.0, x)
    hold = how.hold(phase.functions.rhs.unit_quaternions, phase.projection)
    watched = (hold, None, lookout)
    return CompiledSteps(
        phase.rate, (0.0, end), x, how=how, instants=instants, watched=watched, slope=lambda: phase.slope
    )


def _runs(
    march: CompiledSteps,
    starts: tuple[np.ndarray, np.ndarray],
    found: MarchedRuns,
    piece: tuple[int, int],
    most_steps: int,
    stop: threading.Event,
) -> None:
    """The runs from one number up to another, in one thread."""
    (x0, p), m, first = starts, march.struct, ctypes.addressof(march.struct)
    rates = np.array([first + offset for offset, _ in march.placed], dtype=np.uintp)
    constants = np.array([address.constants for _, address in march.placed], dtype=np.uintp)
    r = _Runs(next=piece[0], last=piece[1], functions=len(rates), parameters=p.shape[1], most_steps=most_steps)
    r.most_seen, r.start, r.begins, r.stops, r.n_stops = SEEN, m.t, found.x.shape[1] - m.n_instants, m.stops, m.n_stops
    arrays = {"x0": x0, "p": p, "x": found.x, "is_done": found.is_done, "steps": found.steps}
    for name, array in (arrays | {"rates": rates, "constants": constants}).items():
        setattr(r, name, array.ctypes.data)
    while not stop.is_set() and library_of_march()[4](ctypes.byref(m), ctypes.byref(r), AT_ONCE):
        pass


def _determined(phase: PhaseModel, x: np.ndarray, p: np.ndarray, instants: np.ndarray) -> np.ndarray:
    """True for each run on whose way no determinant vanishes that the motion depends on and that no march watches."""
    found = np.ones(len(x), dtype=bool)
    for what in phase.undetermined:
        if what.is_watched:
            continue
        for i, states in enumerate(x):
            with np.errstate(all="ignore"):
                values = np.nan_to_num(what.at(p[i]).determinants(instants, states)).reshape(len(instants), -1)
            found[i] &= not any(vanishing_after(column) for column in values.T)
    return found
