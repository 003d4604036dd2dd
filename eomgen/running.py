"""Equations, Stepping -> Trajectory: the motion, kept on its ties, ended where these do not say how it goes on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eomgen.certificate import certify
from eomgen.codegen.program import bordered, program_of
from eomgen.codegen.rhs import RightHandSide, compiled, parameter_vector
from eomgen.equations import Equations
from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.balance.friction import with_friction
from eomgen.mechanics.bodies.gimbal import locks_of
from eomgen.mechanics.constraints.edges import edges_of, left_of, stopped_at
from eomgen.mechanics.constraints.elimination import singular_blocks
from eomgen.mechanics.equations.stabilization import stabilized
from eomgen.mechanics.equations.wellposed import is_conservative
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.initial_state.initial_state import Start, start_of_motion
from eomgen.model.parts import Model
from eomgen.proof import motion
from eomgen.proof.check import Certificate
from eomgen.simulation.breakpoints import knots_of
from eomgen.simulation.conditions import Condition, condition_of
from eomgen.simulation.configuration import has_phases
from eomgen.simulation.contact_phases import run_phases
from eomgen.simulation.event_location import TOUCH, Events
from eomgen.simulation.integrate import SAMPLES, check, integrate
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.joined import thinned
from eomgen.simulation.measures import independence_of, measure, nearness_of
from eomgen.simulation.projection import Projection, projection_of
from eomgen.simulation.reaction_columns import with_reactions
from eomgen.simulation.result import Phase, Trajectory
from eomgen.simulation.singular import ended_where_singular
from eomgen.simulation.slopes import slope_of
from eomgen.simulation.solvers import IMPLICIT
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.tolerances import AT_AN_EDGE, COMPUTED, FINEST_RUN

CHOOSE = "declare other speeds"
STEPS_AGAIN = 10_000  # of the finer integration across one instant
LOCKED = "gimbal lock: choose another `orientation`, or a quaternion"


@dataclass(frozen=True)
class RunProof:
    """What a run is proven by: a trajectory -> its certificate.

    Args:
        equations: as they ran, of a model whose contacts do not change.
        rhs: the code that ran these.
        how: the tolerances of the run.
    """

    equations: Equations
    p: np.ndarray
    rhs: RightHandSide
    how: Stepping

    def __call__(self, found: Trajectory) -> Certificate:
        """The proof of the equations, then that of the run."""
        certificate = certify(self.equations.system, self.equations.graph)
        legs = [leg for phase in found.phases for leg in self._legs(phase, found)]
        return certificate + motion.checks(legs, motion.Promise(self.how.rtol, self.how.atol, found.steps))

    def _legs(self, phase: Phase, found: Trajectory) -> Iterator[motion.Leg]:
        """The states that a phase went through, none of them after the run was cut."""
        if phase.track is None or not len(found.t):
            return
        phased, equations = phase.model, self.equations
        system, assembly, rhs = (equations.system, equations.graph, self.rhs)
        if phased is not None:
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
    asked = how
    p = parameter_vector(equations.model, parameters)
    condition = None if until is None else condition_of(equations.model, until)
    check(0.0, time, how)
    _refuse_given(equations.model, start or {})
    how = replace(how.of_one_step(), knots=knots_of(equations.model))
    if has_phases(equations.model):
        found = run_phases(
            equations.model,
            time=time,
            p=p,
            parameters=parameters,
            start=start,
            target=target,
            samples=samples,
            how=how,
            until=condition,
        )
        rhs, phase = equations.rhs(target), found.phases[0].model
        begun = None if phase is None else start_of_motion(phase.system, parameters, start)
        found = found if begun is None else replace(found, assembled=begun.words)
    else:
        begun = start_of_motion(equations.system, parameters, start)
        x0 = np.array(list(begun.values.values()))
        _refuse_fork_at_rest(equations, begun, x0, p)
        rhs, found = _one_phase(equations, time, x0, p, how=how, target=target, samples=samples, condition=condition)
        found = replace(found, assembled=begun.words)
    found = with_reactions(_told(found, until), lambda: equations.reactions, rhs, p)
    ran = pulling(equations, how.rates) if how.stabilization == "baumgarte" else equations
    found = replace(found, proof=RunProof(ran, p, rhs, asked))
    return thinned(found, samples) if has_phases(equations.model) else found


def _refuse_given(model: Model, start: Mapping[str, float]) -> None:
    """Refuses a start of what is given at every instant.

    Raises:
        UsageError: a coordinate with a `motion`.
    """
    for name in start:
        if name in model.coordinates and model.coordinates[name].motion is not None:
            raise UsageError(f"'{name}' starts where its `motion` says", mend="give no other start")


def _refuse_fork_at_rest(equations: Equations, begun: Start, x0: np.ndarray, p: np.ndarray) -> None:
    """Refuses a start at rest where branches meet, unless it stays at rest.

    Raises:
        DerivationError: forces pull it away, and the ties do not say on which branch.
    """
    if begun.fork is None:
        return
    dx = equations.rhs("numpy")(0.0, x0, p)
    rates, accelerations = np.split(np.abs(dx), [len(equations.coordinates)])
    if np.max(rates, initial=0.0) <= COMPUTED and np.max(accelerations, initial=0.0) > COMPUTED:
        what = f"it starts at rest in {begun.fork.words}: forces pull it away, on which branch nothing says"
        raise DerivationError(
            what, f"constraints.{begun.fork.ties[0]}", "give it start speeds, or start beside that position"
        )


def _one_phase(
    equations: Equations,
    time: float,
    x0: np.ndarray,
    p: np.ndarray,
    *,
    how: Stepping,
    target: str | None,
    samples: int | Sequence[float],
    condition: Condition | None,
) -> tuple[RightHandSide, Trajectory]:
    """(the right-hand side, the motion) of a model whose contacts do not change."""
    equations = pulling(equations, how.rates) if how.stabilization == "baumgarte" else equations
    system, assembly, rhs = equations.system, equations.graph, equations.rhs(target)
    projection, energies = projection_of(system, p, target), measure(system, (assembly.T, assembly.V), p)
    found = integrate(
        rhs,
        time=time,
        x0=x0,
        p=p,
        energy=lambda t, x: energies(t, x).T,
        conservative=is_conservative(system, assembly),
        projection=projection,
        samples=samples,
        method=how.method,
        rtol=how.rtol,
        atol=how.atol,
        stabilization=how.stabilization,
        every=how.every,
        most_steps=how.most_steps,
        events=_events(equations, p, condition, TOUCH * how.rtol),
        slope=slope_of(system, assembly, p, target) if how.method in IMPLICIT else None,
        nearness=nearness_of(system, assembly, p),
        knots=how.knots,
    )
    found = _at_edge(equations, found, p)
    return rhs, found if found.status == "singular" else _watched(equations, found, rhs, p, how, projection)


def pulling(equations: Equations, rates: tuple[float, float]) -> Equations:
    """The equations with rows that pull back what has opened, after Baumgarte.

    Args:
        rates: alpha, beta [1/s].
    Raises:
        UsageError: see `stabilized`.
    """
    system = equations.system
    return replace(equations, graph=with_friction(system, stabilized(system, recursive.assemble(system), rates)))


def _events(equations: Equations, p: np.ndarray, condition: Condition | None, touch: float) -> Events | None:
    """The edges of the ties, and last the condition; None without any."""
    system = equations.system
    solve = bordered(equations.graph) if system.symbols.u else None
    values = left_of(edges_of(system.motion))
    asked = [] if condition is None else [condition(system)]
    if any(type(x) is not Node for x in asked):
        raise UsageError("nothing in the condition moves: it holds always or never", mend='write "theta = pi/2"')
    if not values and not asked:
        return None
    function = compiled(program_of((*values, *asked), system.symbols, inputs=system.inputs, solve=solve), "numpy")
    last = (len(values),) if asked else ()
    floors = np.full(len(values) + len(asked), COMPUTED)
    return Events(lambda t, x: function.many(t, x, p), floors, either=last, touch=touch)


def _at_edge(equations: Equations, found: Trajectory, p: np.ndarray) -> Trajectory:
    """The run; where it came to an edge of a tie, that is why it ended."""
    edges = edges_of(equations.system.motion)
    if found.status != "event" or not edges:
        return found
    left = measure(equations.system, tuple(edge.vanishes for edge in edges), p)(found.t[-1:], found.x[-1:])[0]
    k = int(np.argmin(left))
    if left[k] > 2 * AT_AN_EDGE:
        return found
    message = stopped_at(edges[k], found.t[-1])
    phases = (*found.phases[:-1], replace(found.phases[-1], ended_by=message))
    return replace(found, status="singular", message=message, phases=phases)


def _told(found: Trajectory, until: str | None) -> Trajectory:
    """The run, its message in the words of the condition."""
    if until is None or found.status not in ("event", "finished"):
        return found
    end = found.phases[-1].end
    met = f"{until} at t = {end:.6g} s." if found.status == "event" else f"{found.message} '{until}' did not come."
    return replace(found, message=met, phases=(*found.phases[:-1], replace(found.phases[-1], ended_by=met)))


def _watched(
    equations: Equations,
    found: Trajectory,
    rhs: RightHandSide,
    p: np.ndarray,
    how: Stepping,
    projection: Projection | None,
) -> Trajectory:
    """The run, ended where dependent coordinates or closing ties do not say how it goes on, and it went astray."""
    system = equations.system
    rtol, atol = (max(tolerance / 1000, FINEST_RUN) for tolerance in (how.rtol, how.atol))

    def again(start: float, x: np.ndarray, end: float) -> np.ndarray:
        finer = integrate(
            rhs,
            time=(start, end),
            x0=x,
            p=p,
            rtol=rtol,
            atol=atol,
            samples=2,
            projection=projection,
            most_steps=STEPS_AGAIN,
        )
        return finer.x[-1] if finer.ok else np.full_like(x, np.nan)

    def ended(run: Trajectory, determinants: Any, what: Sequence[str], **told: str) -> Trajectory:
        return ended_where_singular(run, determinants, what, again, rtol=how.rtol, **told)

    blocks = singular_blocks(system.elimination, system.scope)
    if blocks:
        determinants = measure(system, tuple(block.determinant for block in blocks), p)
        found = ended(found, determinants, [str(block) for block in blocks])
    if system.declared:
        determinants = measure(system, tuple(solved.determinant for solved in system.declared), p)
        found = ended(found, determinants, list(map(str, system.declared)), place=CHOOSE)
    locks = locks_of(system.motion)
    if locks:
        determinants = measure(system, tuple(lock.determinant for lock in locks), p)
        found = ended(found, determinants, list(map(str, locks)), place=LOCKED)
    rows = independence_of(system, equations.graph, p)
    if rows is not None and len(found.t):
        found = ended(found, rows, [rows.words(found.t, found.x)])
    return found
