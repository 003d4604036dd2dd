"""Equations, Stepping -> Trajectory: the motion, kept on its ties, ended where these do not say how it goes on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from eomgen.certificate import certify
from eomgen.codegen.rhs import parameter_vector
from eomgen.equations import Equations
from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.balance.friction import with_friction
from eomgen.mechanics.equations.stabilization import stabilized
from eomgen.mechanics.formulations import recursive
from eomgen.model.parts import Model
from eomgen.proof import motion
from eomgen.proof.check import Certificate
from eomgen.proof.run_reactions import reaction_columns_hold
from eomgen.simulation.integrate import SAMPLES, instants_of, refuse_bad_run
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.joined import joined, thinned, with_reactions
from eomgen.simulation.motion import Plan, through
from eomgen.simulation.phase_change import Course, PhaseStart, at_start, course_of
from eomgen.simulation.phase_run import condition_of
from eomgen.simulation.result import Phase, Trajectory
from eomgen.simulation.solvers import knots_of
from eomgen.symbolic.numeric.tolerances import COMPUTED

STEPS_AGAIN = 10_000  # of the finer integration across one instant


@dataclass(frozen=True)
class RunProof:
    """What a run is proven by: a trajectory -> its certificate.

    Args:
        equations: as they were derived.
        how: the tolerances of the run.
    """

    equations: Equations
    p: np.ndarray
    how: Stepping

    def __call__(self, found: Trajectory) -> Certificate:
        """The proof of the equations, then that of the run."""
        certificate = certify(self.equations.system, self.equations.graph)
        legs = [leg for phase in found.phases for leg in self._legs(phase, found)]
        promise = motion.Promise(self.how.rtol, self.how.atol, found.steps)
        return certificate + motion.run_checks(legs, promise) + reaction_columns_hold(found, self.p)

    def _legs(self, phase: Phase, found: Trajectory) -> Iterator[motion.Leg]:
        """The states that a phase went through, none of them after the run was cut."""
        if phase.track is None or not len(found.t):
            return
        phased = phase.model
        system, assembly, rhs = phased.system, phased.assembly, phased.rhs
        t, x = phase.track
        here = t <= max(found.t[-1], phase.start)
        inner = np.ascontiguousarray(x[here, : len(rhs.coordinates) + len(rhs.speeds)])
        pulled = self.how.stabilization == "baumgarte"
        yield motion.Leg(system, assembly, self.p, rhs, t[here], inner, found.passages, pulled)


def run(
    equations: Equations,
    *,
    time: float,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    target: str | None = None,
    samples: int | Sequence[float] | None = None,
    how: Stepping | None = None,
    until: str | None = None,
) -> Trajectory:
    """The motion by equations that are derived already.

    Args:
        time: how long [s].
        parameters, start: values, start values and speeds that replace the model's.
        target: of the emitted code.
        samples: as of `integrate`.
        how: the integrator's way; its tolerances are those of the run, and a step takes a tenth of them.
        until: an equation: the run ends where it first holds after the start.
    Raises:
        MissingValues: parameters without a value, all named.
        UsageError: what is asked makes no sense.
    """
    how, samples = how or Stepping(), SAMPLES if samples is None else samples
    model, p = equations.model, parameter_vector(equations.model, parameters)
    condition = None if until is None else condition_of(model, until)
    refuse_bad_run(0.0, time, how)
    _refuse_given(model, start or {})
    pulled = how.rates if how.stabilization == "baumgarte" else None
    course = course_of(model, p, target, pulled, (equations.system, equations.graph))
    here = at_start(course, 0.0, parameters, start)
    _refuse_fork_at_rest(course, here)
    plan = Plan(
        time,
        replace(how.of_one_step(), knots=knots_of(model)),
        instants_of(samples, 0.0, time),
        None if condition is None else lambda phase: condition(phase.system),
    )
    runs = list(through(course, here, plan))
    found = with_reactions(_told(joined(course, runs), until), runs)
    found = replace(found, assembled="" if here.begun is None else here.begun.words)
    return thinned(replace(found, proof=RunProof(equations, p, how)), samples)


def _refuse_given(model: Model, start: Mapping[str, float]) -> None:
    """Refuses a start of what is given at every instant.

    Raises:
        UsageError: a coordinate with a `motion`.
    """
    for name in start:
        if name in model.coordinates and model.coordinates[name].motion is not None:
            raise UsageError(f"'{name}' starts where its `motion` says", mend="give no other start")


def _refuse_fork_at_rest(course: Course, here: PhaseStart) -> None:
    """Refuses a start at rest where branches meet, unless it stays at rest.

    Raises:
        DerivationError: forces pull it away, and the ties do not say on which branch.
    """
    fork = None if here.begun is None else here.begun.fork
    if fork is None:
        return
    phase = course.phase_models.of(here.configuration)
    rates, accelerations = np.split(np.abs(phase.rate(here.t, phase.state(here.values))), [len(phase.coordinates)])
    if np.max(rates, initial=0.0) <= COMPUTED and np.max(accelerations, initial=0.0) > COMPUTED:
        what = f"it starts at rest in {fork.words}: forces pull it away, on which branch nothing says"
        raise DerivationError(
            what, f"constraints.{fork.ties[0]}", "give it start speeds, or start beside that position"
        )


def pulling(equations: Equations, rates: tuple[float, float]) -> Equations:
    """The equations with rows that pull back what has opened, after Baumgarte.

    Args:
        rates: alpha, beta [1/s].
    Raises:
        UsageError: see `stabilized`.
    """
    system = equations.system
    return replace(
        equations, graph=with_friction(system, stabilized(system, recursive.assembled_by_recursion(system), rates))
    )


def _told(found: Trajectory, until: str | None) -> Trajectory:
    """The run, its message in the words of the condition."""
    if until is None or found.status not in ("event", "finished"):
        return found
    end = found.phases[-1].end
    met = f"{until} at t = {end:.6g} s." if found.status == "event" else f"{found.message} '{until}' did not come."
    return replace(found, message=met, phases=(*found.phases[:-1], replace(found.phases[-1], ended_by=met)))
