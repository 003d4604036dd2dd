"""Equations, Stepping -> Trajectory: the motion, which satisfies its constraints, up to its end; and its document.

It ends early at a singular position, where the constraints do not determine how it goes on.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide, closing_accelerations
from eomgen.documents import Document, Grid, Picture, Statement, cell_text, plain_document, prose, proven, run_picture
from eomgen.equations import Equations
from eomgen.errors import DerivationError, ExpressionError, ModelError, Problem, UsageError
from eomgen.files import is_stream
from eomgen.frozen import with_fields
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.kinematics import Motion, Scope, SystemScene
from eomgen.model import Model, Output, Requests, Typed, WrittenEquation
from eomgen.proof import ReportedRun, RunProof, run_reported
from eomgen.resources import PatienceEnded, doing, keep_what_there_is
from eomgen.simulation import (
    Accuracy,
    PhaseModels,
    PhaseRun,
    PhaseStart,
    Plan,
    Run,
    Stepping,
    Trajectory,
    WholeRun,
    formulas_of,
    instants_of,
)
from eomgen.symbolic.expression import Expression, Scalar, is_zero, parse, symbols_of
from eomgen.symbolic.numeric import FLOAT, evaluate, number_of, tolerances

STEPS_AGAIN = 10_000  # of the finer integration across one instant


@doing("the motion in time")
def run(
    equations: Equations,
    *,
    time: float,
    parameters: Mapping[str, Any] | None = None,
    start: Mapping[str, float] | None = None,
    target: str | None = None,
    samples: int | Sequence[Typed] | None = None,
    how: Stepping | None = None,
    until: WrittenEquation | str | None = None,
    models: PhaseModels | None = None,
    reactions: bool = True,
    outputs: Mapping[str, Expression] | None = None,
) -> Trajectory:
    """The motion by equations that are derived already.

    Args:
        time: how long [s].
        parameters, start: values that replace the model's own, where equations derived at others are used again.
        target: of the emitted code.
        samples: as of `integrate`.
        how: the integrator's way; its tolerances are those of the run, and a step takes a tenth of them.
        until: an equation: the run ends where it first holds after the start.
        models: the phases of these equations at these parameters, where they are known; what they hold is used again.
        reactions: True if they are among the columns.
        outputs: formulas of further columns, by name; None: the model's outputs, those of the whole run included.
    Raises:
        MissingValues: parameters without a value, all named.
        UsageError: the request makes no sense.
    """
    how = how or Stepping()
    model = equations.model
    condition = None if until is None else _condition_of(model, until)
    how.refuse_bad_run(0.0, time)
    models = models or phase_models(equations, RightHandSide.parameter_values(model, parameters), how, target)
    here = PhaseStart.of(models, 0.0, parameters, start)
    _refuse_fork_at_rest(models, here)
    instants = instants_of(samples, 0.0, time)
    plan = Plan(
        time,
        with_fields(how.of_one_step(), breakpoints=models.breakpoints, keeps=True),
        instants,
        None if condition is None else lambda phase: condition(phase.system),
    )
    runs = _followed(plan.through(models, here))
    words = until.text if isinstance(until, WrittenEquation) else until

    def estimated(found: Trajectory) -> Accuracy | None:
        again = how.finer
        other = run(
            equations,
            time=time,
            start=start,
            samples=samples,
            how=again,
            until=until,
            models=models,
            reactions=False,
            outputs={},
        )
        return Accuracy.of(found, other, min(1.0, how.rtol / again.rtol))

    whole = WholeRun(model, runs, plan, parameters or {})
    return finished_run(
        equations,
        models,
        whole,
        how,
        None if samples is None or isinstance(samples, (int, np.integer)) else instants,
        until=words,
        reactions=reactions,
        outputs=outputs,
        estimate=estimated,
    )


PAGE_TIME = 10.0  # s
PAGE_STEPS = 100_000  # a motion that needs more is too fast to be shown as a whole
PAGE_PHASES = 500  # of contacts, for the same reason
PERIODS = 3  # of the slowest oscillation that are shown
LONGEST = 60.0  # s, of a motion that is so slow
STILL = 1e-3  # of the largest rate: slower, and it rests
SWING = 0.05  # of the largest rate: smaller changes of sign are no oscillation
ROUND = (1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 10)  # times, in powers of ten
ALIKE = (0.6, 1.3)  # of PAGE_TIME: it is taken in place of times between


def run_of_a_page(equations: Equations, time: float | None, samples: int) -> tuple[Trajectory, str]:
    """Motion that a page shows, and why it does not last PAGE_TIME; "" where it does.

    Args:
        time: how long [s]; None: PAGE_TIME, or as `page_time` has it.
    Raises:
        KeyboardInterrupt: the run was interrupted: a page that shows only a part of it is not what was requested.
    """
    if time is not None:
        return _whole(run(equations, time=time, samples=samples)), ""
    found = _whole(run(equations, time=PAGE_TIME, samples=samples, how=page_stepping()))
    time, words = page_time(found)
    return (_whole(run(equations, time=time, samples=samples)), words) if words else (found, "")


def page_stepping() -> Stepping:
    """Stepping of a motion for which no time was given."""
    return Stepping(most_steps=PAGE_STEPS, most_phases=PAGE_PHASES)


def page_time(found: Trajectory) -> tuple[float, str]:
    """Time for which a motion is shown where none is given [s], and why it is not PAGE_TIME; "".

    It is a round time: until the motion rests, or for three periods of its slowest oscillation; or before too many
    steps are taken, or before a position from which constraints or contacts do not determine how the motion goes on.
    """
    end = found.phases[-1].end if found.phases else 0.0
    if found.ok and end == PAGE_TIME:
        return _by_its_motion(found)
    if found.ended not in ("too many steps", "singular", "contact") or not end > 0:
        return PAGE_TIME, ""
    power = 10.0 ** math.floor(math.log10(end))
    time = next(factor * power for factor in (5, 2, 1) if factor * power <= end)
    if found.ended != "too many steps":
        return time, f"Followed for {time:g} s. {found.message}"
    why = f"{PAGE_TIME:g} s would take more than {PAGE_STEPS} steps; --time says otherwise."
    return time, f"Followed for {time:g} s: {why}"


def _by_its_motion(found: Trajectory) -> tuple[float, str]:
    """Time for which a motion is shown that lasted PAGE_TIME, and why it is another; ""."""
    t, rates = _rates(found)
    largest = np.max(np.abs(rates), axis=0, initial=0.0)
    moving = np.abs(rates) > STILL * largest
    last = np.flatnonzero(np.any(moving[:, largest > 0], axis=1))
    if not len(last):
        return PAGE_TIME, ""
    if last[-1] + 1 < len(t) and t[last[-1]] < ALIKE[0] * PAGE_TIME:
        time = _rounded(1.1 * float(t[last[-1]]))
        return time, f"Followed for {time:g} s, until it rests; --time says otherwise."
    periods = [period for k in np.flatnonzero(largest) if (period := _period(t, rates[:, k]))]
    wanted = PERIODS * max(periods, default=0.0)
    time = _rounded(min(wanted, LONGEST))
    if not periods or ALIKE[0] < time / PAGE_TIME < ALIKE[1]:
        return PAGE_TIME, ""
    shown = "three periods" if wanted <= time else "a part"
    return time, f"Followed for {time:g} s, {shown} of its slowest oscillation; --time says otherwise."


def _rates(found: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """(instants, rates of the coordinates): at the integrator's steps where the motion has one phase, which see what
    is faster than the instants that are given."""
    first = found.phases[0]
    if len(found.phases) == 1 and first.model is not None and first.track is not None:
        t, x = first.track
        return t, x[:, len(first.model.coordinates) :][:, : len(first.model.speeds)]
    return found.t, found.x[:, len(found.coordinates) :][:, : len(found.speeds)]


def _period(t: np.ndarray, rate: np.ndarray) -> float | None:
    """Twice the mean time between changes of sign of a rate, small swings left out, a start at rest counted as one;
    None: it does not swing."""
    large = np.flatnonzero(np.abs(rate) > SWING * np.max(np.abs(rate)))
    before, after = large[:-1], large[1:]
    turned = np.sign(rate[before]) != np.sign(rate[after])
    (t0, u0), (t1, u1) = ((t[k[turned]], rate[k[turned]]) for k in (before, after))
    changes = np.concatenate([t[:1] if large[0] else t[:0], t0 - u0 * (t1 - t0) / (u1 - u0)])
    return None if len(changes) < 2 else 2 * float(changes[-1] - changes[0]) / (len(changes) - 1)


def _rounded(time: float) -> float:
    """The next round time that is not shorter."""
    power = 10.0 ** math.floor(math.log10(time)) if time > 0 else 1.0
    return next((factor * power for factor in ROUND if factor * power >= 0.999 * time), 10 * power)


def _whole(found: Trajectory) -> Trajectory:
    if found.ended == "interrupted":
        raise KeyboardInterrupt
    return found


def finished_run(
    equations: Equations,
    models: PhaseModels,
    whole: WholeRun,
    how: Stepping,
    instants: np.ndarray | None,
    *,
    until: str | None = None,
    reactions: bool = True,
    outputs: Mapping[str, Expression] | None = None,
    estimate: Callable[[Trajectory], Accuracy | None] | None = None,
) -> Trajectory:
    """The phases of a run as one trajectory, with its columns and its proof.

    Args:
        instants: as of `Trajectory.thinned`; the others as of `run`.
    """
    model, runs = equations.model, whole.runs
    columns = formulas_of(model) if outputs is None else outputs
    found = PhaseRun.joined(models, runs, until=until, reactions=reactions, outputs=columns)
    begun = runs[0].here.begun
    proof = RunProof(equations.graph, how, models, whole)
    more = {
        "assembled": "" if begun is None else begun.words,
        "whole": whole.value,
        "quantities": whole.outputs() if outputs is None else {},
        "proof": proof,
        "watch": proof.watch,
        "estimate": estimate,
    }
    return found.thinned(instants, **more)


def phase_models(equations: Equations, p: np.ndarray, how: Stepping, target: str | None) -> PhaseModels:
    """Phases of equations that are derived already, at values of the parameters."""
    pulled = how.rates if how.stabilization == "baumgarte" else None
    return PhaseModels(equations.model, p, target, pulled, equations.graph)


def _followed(phases: Iterator[PhaseRun]) -> list[PhaseRun]:
    """Phases of a motion; those before the interruption, where it is interrupted between two of them.

    Raises:
        KeyboardInterrupt, PatienceEnded: it is interrupted before the first.
    """
    runs: list[PhaseRun] = []
    try:
        for each in phases:
            runs.append(each)
    except (KeyboardInterrupt, PatienceEnded) as stop:
        if not runs:
            raise
        runs[-1] = replace(runs[-1], run=_cut(runs[-1].run, stop), bound=None, after=None)
    return runs


def _cut(run: Run, stop: BaseException) -> Run:
    """Run with the status and message of the interruption that came after it."""
    if isinstance(stop, KeyboardInterrupt):
        return replace(run, status="interrupted", message=f"Interrupted at t = {run.end:.6g} s.")
    keep_what_there_is()
    message = f"Gave up at t = {run.end:.6g} s: the time to wait (--patience) is over."
    return replace(run, status="out of patience", message=message)


def _refuse_fork_at_rest(models: PhaseModels, here: PhaseStart) -> None:
    """Refuses a start at rest where branches meet, unless it stays at rest.

    Raises:
        DerivationError: forces move it away, and the constraints do not determine on which branch.
    """
    fork = None if here.begun is None else here.begun.fork
    if fork is None:
        return
    phase = models.of(here.configuration)
    ends = np.cumsum([len(phase.coordinates), len(phase.speeds)])
    rates, accelerations, _ = np.split(np.abs(phase.rate(here.t, phase.state(here.values))), ends)
    if np.max(rates, initial=0.0) <= tolerances.COMPUTED and np.max(accelerations, initial=0.0) > tolerances.COMPUTED:
        what = f"it starts at rest in {fork.words}: forces move it away, and nothing determines on which branch"
        raise DerivationError(
            what, f"constraints.{fork.constraints[0]}", "give it start speeds, or start near that position"
        )


def one_turn(system: System) -> float | None:
    """Longest time for one turn among the joints that are driven at a constant rate [s]; None if there is none."""
    scope, driven = system.scope, [q for q in system.symbols.q if system.scope.model.coordinates[q.name].driven]
    turned = {
        x
        for link in system.motion.links
        for s, (w, _) in zip(link.s, link.S, strict=False)
        if not all(map(is_zero, w))
        for x in symbols_of((s,))
    }
    rates = [scope.names[f"{q.name}'"] for q in driven if q in turned]
    parameters = set(system.symbols.parameters.values())
    steady = [rate for rate in rates if parameters.issuperset(symbols_of((rate,)))]
    known = scope.known_exactly
    sizes = [abs(number_of(rate, known)) for rate in steady if not is_zero(rate)]
    return math.tau / min(sizes) if sizes else None


# -------- the document of a run -------------------------------------------------------------------------------


MOST_REPORTED = 20  # phases in the text
MOST_AGAIN = 500_000  # evaluations of a run that is made again, finer, to know its error


def run_document(
    equations: Equations, run: Trajectory, *, output: str | None = None, plot: str | None = None, certify: bool = True
) -> Document:
    """The document of a run.

    Args:
        output, plot: files of its trajectory and its picture, written already.
    """
    model, files = equations.model, [path for path in (output, plot) if path]
    assembled = f"The start was {run.assembled}." if run.assembled else ""
    cut = {"interrupted": "it was interrupted", "out of patience": "there was no time left"}.get(run.status, "")
    unproven = f"Nothing of it is proven: {cut}." if certify and cut else ""
    missing = run.remark if run.reactions or run.outputs else ""
    notes = tuple(note for note in (unproven, assembled, run.still, missing) if note)
    first = _first_instant(equations, run)
    statements = _run_statements(model, run)
    payload = _run_payload(model, run, files)
    document = plain_document(
        model,
        lambda: payload | first,
        *statements,
        failed="" if run.ok else run.message,
        notes=notes,
    )
    document = replace(document, cautions=(*document.cautions, *cautions_of(model, run)))
    if cut:
        return replace(proven(document, None), interrupted=run.status == "interrupted")
    return proven(
        document, run.certify() + run_reported(run, model, _reported(statements, payload, output)) if certify else None
    )


TURN_SAMPLES = 721  # of a cycle


def reaction_picture(equations: Equations, view: str | None = None, time: float | None = None) -> Picture:
    """Reactions along the motion from the start.

    Args:
        view: "polar" or "resultants"; None: of hinges in the plane the first.
        time: the duration [s]; None: one turn of the driven joint, else as long as a page shows it.
    Raises:
        RunFailed: nothing carries such a force; the motion ends at once.
    """
    found, _ = run_of_a_page(equations, time or one_turn(equations.graph.system), TURN_SAMPLES)
    model = equations.model
    return run_picture(found, view or ("polar" if model.space == "plane" else "resultants"), title=model.name)


def cautions_of(model: Model, run: Trajectory) -> tuple[Problem, ...]:
    """Warnings: samples that a run goes beyond, and limits of coordinates that it passes."""
    left = model.left_tables(float(run.t[-1]) if len(run.t) else 0.0)
    return (*left, *_limits_passed(model, run.t, run.x[:, : len(run.coordinates)]))


def _reported(statements: Sequence[Statement], payload: Mapping[str, Any], output: str | None) -> ReportedRun:
    """The reported values of a run, as they stand in the text, the entries and the file."""
    grids = {
        cell_text(grid.head[-1]): [list(map(cell_text, row)) for row in grid.rows]
        for grid in statements
        if isinstance(grid, Grid)
    }
    table = None
    if output and not is_stream(output) and Path(output).suffix.lower() == ".csv":
        head, *lines = csv.reader(io.StringIO(Path(output).read_text(encoding="utf-8")))
        table = head, lines
    return ReportedRun(grids.get("end", ()), grids.get("at", ()), payload, table)


def _first_instant(equations: Equations, run: Trajectory) -> dict[str, Any]:
    """Accelerations and multipliers at the start; null where one has no single value."""
    if not len(run.t):
        return {"start_accelerations": {}, "start_multipliers": {}}
    phase, x = run.phases[0].model, dict(zip(run.moving, run.x[0].tolist(), strict=True))
    declared = phase.declared_equations
    state = np.array([x[node.name] for node in declared.symbols.x])
    p = RightHandSide.parameter_values(equations.model)
    found = closing_accelerations(declared, float(run.t[0]), state, p)
    return {"start_accelerations": found.a, "start_multipliers": found.lam}


def _run_statements(model: Model, run: Trajectory) -> tuple[Statement, ...]:
    """Statements of a run: its phases, the values at start and end, and how well the conservation laws hold."""
    shown = run.phases[:MOST_REPORTED] if len(run.phases) > 1 else ()
    lines = [f"from {phase.start:.6g} s: {phase.ended_by}" for phase in shown]
    lines += [f"and {len(run.phases) - MOST_REPORTED} phases more"] if len(run.phases) > MOST_REPORTED else []
    units, columns = model.units_of(run.columns()), run.columns()
    columns = {name: x / units[name].size if name in units else x for name, x in columns.items()}
    heads = {name: f"{name} [{units[name]}]" if name in units else name for name in columns}
    rows = tuple((heads[name], f"{x[0]:.9g}", f"{x[-1]:.9g}") for name, x in columns.items() if len(x))
    grids = (Grid(("", "start", "end"), rows), Grid(("of the run", "", "at"), _rows_of_outputs(model, run)))
    table = tuple(grid for grid in (*grids, Grid(("impact", "impulses", "loss"), _rows_of_impacts(run))) if grid.rows)
    accuracy = _accuracy(run)
    reported = [] if accuracy is None else [str(accuracy)]
    return (
        prose(" ".join([f"{model.name}: {run.summary()}", *reported])),
        *(prose(f"  {line}") for line in lines),
        *table,
    )


def _rows_of_impacts(run: Trajectory) -> tuple[tuple[str, str, str], ...]:
    """A row for each impact: what closed and when, the impulses that are not 0, the loss of kinetic energy."""
    rows = []
    for impact in run.impacts[:MOST_REPORTED]:
        least = tolerances.SOLVED * max((abs(x) for x in impact.impulses.values() if math.isfinite(x)), default=0.0)
        known = {name: x for name, x in impact.impulses.items() if not abs(x) <= least}
        values = [f"{name} {f'{x:.6g}' if math.isfinite(x) else 'has no single value'}" for name, x in known.items()]
        rows.append((f"{impact.contact} at t = {impact.t:.6g} s", ", ".join(values), f"{impact.loss:.6g} J"))
    more = len(run.impacts) - MOST_REPORTED
    return (*rows, (f"and {more} more", "", "")) if more > 0 else tuple(rows)


def _accuracy(run: Trajectory) -> Accuracy | None:
    """Estimate of the correct digits; None where the run was cut short or the second run would take too long."""
    cut = run.status in ("interrupted", "out of patience") or run.evaluations > MOST_AGAIN
    return None if cut or not len(run.t) else run.accuracy


def _rows_of_outputs(model: Model, run: Trajectory) -> tuple[tuple[str, str, str], ...]:
    """A row for each output of the whole run; of every event one."""
    units = model.units_of(run.quantities)
    rows: list[tuple[str, str, str]] = []
    for name, found in run.quantities.items():
        unit = units.get(name)
        size, head = (1.0, name) if unit is None else (unit.size, f"{name} [{unit}]")
        values = found.value if isinstance(found.value, tuple) else (found.value,)
        for k, value in enumerate(values):
            when = f"t = {found.t[k]:.9g} s" if k < len(found.t) else ""
            rows.append((head, found.message if value is None else f"{value / size:.9g}", when))
    return tuple(rows)


def _quantities(model: Model, run: Trajectory) -> dict[str, Any]:
    """The same for machines, in the output's unit."""
    reported: dict[str, Any] = {}
    units = model.units_of(run.quantities)
    for name, found in run.quantities.items():
        unit = units.get(name)
        size = 1.0 if unit is None else unit.size
        value = [x / size for x in found.value] if isinstance(found.value, tuple) else found.value
        value = value / size if isinstance(value, float) else value
        reported[name] = {"value": value, "unit": "" if unit is None else unit.text, "t": list(found.t)}
        reported[name]["message"] = found.message or None
    return reported


def _run_payload(model: Model, run: Trajectory, files: list[str]) -> dict[str, Any]:
    columns = {name: [_finite(x) for x in column.tolist()] for name, column in run.columns().items()}
    accuracy = _accuracy(run)
    payload = {
        "name": model.name,
        "status": run.status,
        "message": run.message,
        "time": _finite(run.phases[-1].end),
        "start": {name: column[0] for name, column in columns.items() if column},
        "end": {name: column[-1] for name, column in columns.items() if column},
        "energy_drift": _finite(run.drift),
        "gap": _finite(run.gap),
        "gap_rate": _finite(run.gap_rate),
        "steps": run.steps,
        "evaluations": run.evaluations,
        "accuracy": None if accuracy is None else accuracy.as_dict(),
        "remark": run.remark,
        "files": files,
        "quantities": _quantities(model, run),
        "assembled": run.assembled,
        "passages": [{"start": first, "end": last} for first, last in run.carried],
        "impacts": [impact.as_dict() for impact in run.impacts],
        "phases": [{"start": phase.start, "end": phase.end, "ended_by": phase.ended_by} for phase in run.phases],
    }
    return payload if files else payload | {"trajectory": columns}


def _finite(x: float | None) -> float | None:
    return float(x) if x is not None and abs(x) < float("inf") else None


LOOKED = 200  # rows of a run at which limits are looked at


def _limits_passed(model: Model, t: np.ndarray, q: np.ndarray) -> tuple[Problem, ...]:
    """The limits of constraints beyond which a run goes, with the first instant that is seen, of LOOKED rows.

    Args:
        t, q: instants, n; coordinates in the model's order, n x nq.
    """
    if not len(t) or not any(constraint.thread() for constraint in model.constraints.values()):
        return ()
    motion, found = Motion.of(Scope.of(model)), []
    symbols, known = motion.scope.symbols, model.exact_parameters()
    p = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
    looked = np.unique(np.linspace(0, len(t) - 1, LOOKED).round().astype(int))
    for name, constraint in model.constraints.items():
        for limit in constraint.limits(SystemScene(motion, f"{constraint.table}.{name}")):
            for k in looked:
                state = p | {symbols.t: float(t[k])} | dict(zip(symbols.q, map(float, q[k]), strict=True))
                if evaluate((limit.vanishes,), state, FLOAT)[0] < 0:
                    what = (
                        f"{limit.words} at t = {t[k]:.4g} s: from there on it is led straight on, which it would not be"
                    )
                    found.append(Problem(f"{constraint.table}.{name}", what, fix="end the run before"))
                    break
    return tuple(found)


def _condition_of(model: Model, until: WrittenEquation | str) -> Callable[[System], Scalar]:
    """Left side minus right side of an equation such as "theta = pi/2" or "reaction_n(wall) = 0".

    Raises:
        UsageError: it is no equation, or holds a name that the model does not have.
    """
    text = until.text if isinstance(until, WrittenEquation) else until
    try:
        equation = Requests(model).equation(until)
        model.requesting({"until": Output(value=parse("t"), at=equation)})
    except ExpressionError as error:
        raise UsageError(f"until '{text}': {error.what}", fix=error.fix or 'write "theta = pi/2"') from error
    except ModelError as error:
        raise UsageError(f"until '{text}': {error.problems[0].what}", fix=error.problems[0].fix) from error

    def difference(system: System) -> Scalar:
        names, value = system.scope.names, Quantities(system).value
        return equation.left.evaluate(names, value) - equation.right.evaluate(names, value)

    return difference
