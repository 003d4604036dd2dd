"""PhaseModel, starts and parameters of many runs -> their states, in C: a run costs no Python at all.

In lanes of vectors runs go side by side, for models x' = f(t, x, p) without constraints, contacts that change and
dependent quaternions, whose start follows from numbers. Marches are for models with constraints that hold throughout:
each thread has one march, which takes the runs one after the other, each as `CompiledSteps` takes a run of its own. A
run of which a step wants a look (near a singular position, a constraint that does not close, stiff, no value) is left
undone.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property, partial

import numpy as np

from eomgen.codegen import Batch, BatchOptions, in_c, order_for
from eomgen.errors import RunFailed, ToolMissing
from eomgen.frozen import dataclass
from eomgen.resources import check_patience, in_threads, pieces_of
from eomgen.simulation.compiled_phases import CompiledPhases, CompiledRuns, is_in_phases
from eomgen.simulation.compiled_steps import CompiledSteps
from eomgen.simulation.constraint_drift import RankLookout
from eomgen.simulation.integration import drift_of
from eomgen.simulation.integrator import Stepping, ended_words, reached_words
from eomgen.simulation.many_runs import BATCHED, ManyStarts, library_of_march
from eomgen.simulation.phase_change import contacts_away, plain_configuration
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_models import DerivedAt, PhaseModels
from eomgen.simulation.singular import NEARNESS, vanishing_after
from eomgen.simulation.solvers import SEEN, TAYLOR
from eomgen.symbolic.numeric import tolerances

AT_ONCE = 20_000  # steps in a call, a few hundredths of a second: between two calls somebody may have lost patience
_SIZE, _AT = ctypes.c_size_t, ctypes.c_void_p


@dataclass(frozen=True)
class FoundRuns:
    """Results of many runs.

    Args:
        names: of the columns.
        x: runs x instants x columns.
        status, message: of each run, in words.
        steps: the number that each took.
        alone: numbers of the runs that are to be run alone: of these nothing is known.
    """

    names: tuple[str, ...]
    x: np.ndarray
    status: np.ndarray
    message: np.ndarray
    steps: np.ndarray
    alone: np.ndarray


@dataclass(frozen=True)
class ManyRuns:
    """Runs of one phase, from t = 0 to one end, as they are made in C.

    Args:
        phase: without bounds.
        how: the integrator's options, with the tolerances of one step and its breakpoints.
        instants: at which states are given [s].
        end: of all runs [s].
        parameters: () -> runs x parameters.
        threads: among which the runs are divided.
    """

    phase: PhaseModel
    how: Stepping
    instants: np.ndarray
    end: float
    parameters: Callable[[], np.ndarray]
    threads: int

    @cached_property
    def p(self) -> np.ndarray:
        """Runs x parameters."""
        return self.parameters()

    def in_lanes(self, starts: Callable[[], np.ndarray], *, required: bool) -> FoundRuns | None:
        """The runs in lanes, of which those that are stiff are to be run alone; None where no compiler makes them.

        Args:
            starts: () -> runs x states.
            required: True if that is an error.
        Raises:
            RunFailed, ToolMissing: no compiler makes what is required.
        """
        rhs, how = self.phase.functions.rhs, self.how
        series = how.method == TAYLOR and not rhs.without_series
        try:
            batch = Batch(rhs.program, BATCHED, order_for(how.rtol) if series else None)
        except (RunFailed, ToolMissing):
            if required:
                raise
            return None
        requested = BatchOptions(
            *((0.0, self.end), self.instants, how.rtol, how.atol, how.most_steps, how.breakpoints),
            rhs.unit_quaternions,
        )
        p, x0 = self.p, starts()
        found = batch.runs(x0, p, requested, threads=self.threads, check=check_patience)
        ends = zip(found.words, found.reached, found.steps, strict=True)
        message = np.array([ended_words(word, float(t), int(n)) for word, t, n in ends], dtype=object)
        names, alone = (
            self.phase.coordinates + self.phase.shown + self.phase.states,
            np.flatnonzero(found.words == "stiff"),
        )
        return FoundRuns(names, found.x, found.words, message, found.steps, alone)

    def in_marches(self, derived: DerivedAt, given: Mapping[str, np.ndarray]) -> FoundRuns | None:
        """The runs in marches; None where not all that they need is in C.

        Those are to be run alone whose start is not known in doubles, or of which a step wants a look.

        Args:
            derived: values at which the phase was derived.
            given: starts in place of the model's, a number a run.
        """
        phase, p = self.phase, self.p
        columns, names = [*phase.moving], phase.coordinates + phase.shown + phase.states
        if phase.functions.rhs.target != "c" or not {*names} <= {*columns} or not len(phase.speeds):
            return None
        x0, places, known = ManyStarts(phase).at(p, given)
        known &= derived.holds(p, places) & derived.is_regular(p, x0)
        known &= (
            np.max(np.abs(x0[:, : len(phase.coordinates + phase.speeds)]), axis=1)
            < tolerances.COMPUTED / np.finfo(float).eps
        )
        which, found = np.flatnonzero(known), None
        if len(which):
            march = partial(marched, replace(self, parameters=lambda: p[which]), x0[which])
            found = in_c(march, "runs are made one by one")
        if found is None:
            return None
        runs = len(p)
        x, steps = np.full((runs, len(self.instants), len(names)), np.nan), np.zeros(runs, dtype=int)
        x[which], steps[which] = found.x[:, :, [columns.index(name) for name in names]], found.steps
        status, message = np.full(runs, "finished", object), np.full(runs, reached_words(self.end), object)
        return FoundRuns(names, x, status, message, steps, np.setdiff1d(np.arange(runs), which[found.is_done]))

    def in_phases(
        self, models: PhaseModels, first: Mapping[str, float], derived: DerivedAt, given: Mapping[str, np.ndarray]
    ) -> FoundRuns | None:
        """The runs of a model whose contacts change; None where the model does not allow it.

        Args:
            models: its phases, at the values of the first run.
            first: the start of the first run.
            derived, given: as of `in_marches`.
        """
        runs = _PhasedRuns(models, self.how, self.instants, self.end, self.parameters, self.threads, first)
        return runs.in_c(derived, given)

    def drifts(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Drift of the energy of each run; x: runs x instants x states."""
        energies = self.phase.functions.energies
        return np.array([drift_of(*energies.many(t, each, own).T) for each, own in zip(x, self.p, strict=True)])


# -------- phases ----------------------------------------------------------------------------------------------
# Runs whose contacts change -> their states: in each thread one after the other, by `phases.c`.


@dataclass(frozen=True)
class _PhasedRuns:
    """Many runs through phases, from t = 0 to one end, as they are made in C.

    Args:
        models: the phases, at the values of the first run.
        how, instants, end, parameters, threads: as of `ManyRuns`.
        first: the start of the first run.
    """

    models: PhaseModels
    how: Stepping
    instants: np.ndarray
    end: float
    parameters: Callable[[], np.ndarray]
    threads: int
    first: Mapping[str, float]

    def in_c(self, derived: DerivedAt, given: Mapping[str, np.ndarray]) -> FoundRuns | None:
        """The runs; None where the model does not allow it.

        Those are to be run alone that begin otherwise than the first (with other contacts open), whose start is not
        known in doubles, or that C leaves to others.

        Args:
            derived: values at which the equations were derived.
            given: starts in place of the model's, a number a run.
        """
        models, p = self.models, np.ascontiguousarray(self.parameters(), dtype=float)
        if not is_in_phases(models, self.how):
            return None
        away = contacts_away(models, 0.0, self.first)
        before = plain_configuration(models.model, {}, away)
        phase = models.of(before)
        if phase.functions.rhs.target != "c" or not len(phase.speeds):
            return None
        names, runs = phase.coordinates + phase.shown + phase.states, len(p)
        made = in_c(lambda: [CompiledPhases(models, self.how, names)], "runs are made one by one")
        if made is None:
            return None
        x, places, known = ManyStarts(phase).at(p, given)
        columns = dict(zip(phase.moving, x.T, strict=True))
        rates = phase.functions.kinematic(phase.system.scope.rates).many(0.0, x, p)
        columns = {f"{q}'": rate for q, rate in zip(phase.coordinates, rates.T, strict=True)} | columns
        known &= derived.holds(p, places) & np.all(np.isfinite(x), axis=1)
        known &= self._begin_alike(columns, p, away)
        which = np.flatnonzero(known)
        values = np.ascontiguousarray(made[0].values(columns, runs)[which])
        own, count = np.ascontiguousarray(p[which]), len(which)
        found = CompiledRuns(
            np.zeros((count, len(self.instants), len(names))), np.zeros(count, np.int32), np.zeros(count, np.uintp)
        )
        pieces = pieces_of(count, min(self.threads, max(count, 1)))
        made += [CompiledPhases(models, self.how, names) for _ in pieces[1:]]
        for each in made[1:]:
            each.with_names(columns)
        starts = values, own, before
        work = [partial(each.runs, starts, self.instants, self.end, found, piece)
                for each, piece in zip(made, pieces, strict=False)]  # fmt: skip
        in_threads(work if count else [], check_patience)
        states, steps = np.full((runs, len(self.instants), len(names)), np.nan), np.zeros(runs, dtype=int)
        states[which], steps[which] = found.x, found.steps
        status, message = np.full(runs, "finished", object), np.full(runs, reached_words(self.end), object)
        alone = np.setdiff1d(np.arange(runs), which[found.is_done.astype(bool)])
        return FoundRuns(names, states, status, message, steps, alone)

    def _begin_alike(self, columns: Mapping[str, np.ndarray], p: np.ndarray, away: tuple[str, ...]) -> np.ndarray:
        """True for each run whose contacts are open at the start, or closed, as those of the first."""
        free, n = self.models.without_contacts, len(p)
        if not free.contacts:
            return np.ones(n, dtype=bool)
        zero = np.zeros(n)
        x = np.column_stack([columns.get(node.name, zero) for node in free.system.symbols.x])
        found = free.functions()["gaps"].many(0.0, x, p).reshape(n, -1, 2)
        rates = [np.abs(v) for name, v in columns.items() if name.endswith("'")]
        places = [np.abs(v) for name, v in columns.items() if not name.endswith("'")]
        length, still = (tolerances.COMPUTED * np.max([np.ones(n), *sizes], axis=0) for sizes in (places, rates))
        length *= 1e2
        gap, rate = found[:, :, 0], found[:, :, 1]
        apart = (gap > length[:, None]) | (np.abs(rate) > still[:, None])
        alike = np.all(gap >= -length[:, None], axis=1)
        if away:
            return np.asarray(alike & np.all(apart == [name in away for name in free.contacts], axis=1))
        return np.asarray(alike & ~np.any(apart, axis=1))


# -------- marches ---------------------------------------------------------------------------------------------
# Runs, their states at the start -> their states, each by one march.


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


def marched(runs: ManyRuns, x0: np.ndarray) -> MarchedRuns | None:
    """The runs from x0 (runs x states); None where not all that is watched is in C."""
    x0, p = (np.ascontiguousarray(each, dtype=float) for each in (x0, runs.p))
    phase, n = runs.phase, len(x0)
    found = MarchedRuns(np.zeros((n, len(runs.instants), x0.shape[1])), np.zeros(n, np.int32), np.zeros(n, np.uintp))
    pieces = pieces_of(n, min(runs.threads, n))
    marches = [_march(phase.at(p[first]), x0[first], runs) for first, _ in pieces]
    if any(each.struct.is_blind for each in marches):
        return None
    most = runs.how.most_steps
    work = [partial(_runs, m, (x0, p), found, piece, most) for m, piece in zip(marches, pieces, strict=True)]
    in_threads(work, check_patience)
    done = found.is_done.astype(bool) & _determined(phase, found.x, p, runs.instants)
    return MarchedRuns(found.x, done, found.steps)


def _march(phase: PhaseModel, x: np.ndarray, runs: ManyRuns) -> CompiledSteps:
    """A march with the checks of a single run."""
    nearness = phase.nearness
    lookout = None if nearness is None else RankLookout(nearness, NEARNESS[0], 0.0, x)
    hold = runs.how.hold(phase.functions.rhs.unit_quaternions, phase.projection)
    span, watched = (0.0, runs.end), (hold, None, lookout)
    return CompiledSteps(
        phase.rate, span, x, how=runs.how, instants=runs.instants, watched=watched, slope=lambda: phase.slope
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
