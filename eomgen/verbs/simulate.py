"""eomgen simulate: the motion from the start, as a summary, as files, as a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from eomgen import pipeline
from eomgen.codegen.accelerations import closing_accelerations
from eomgen.codegen.rhs import parameter_vector
from eomgen.equations import Equations
from eomgen.errors import ExpressionError, UsageError
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.questions.run import run as simulated
from eomgen.report.document import Document, plain_document
from eomgen.report.statements import Grid, Statement, prose
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.expression.expressions import parse
from eomgen.verbs.assignments import assignments, nearest_name
from eomgen.verbs.outcome import prepared

MOST_TOLD = 20  # phases in the text


def simulate_document(
    model: Model,
    *,
    time: float,
    given: tuple[str, ...],
    start: tuple[str, ...],
    how: Stepping,
    target: str | None,
    samples: int | None,
    until: str | None,
    output: str | None,
    plot: str | None,
    certify: bool = True,
) -> Document:
    """The motion from the start; trajectory and picture are written where they are asked for."""
    parameters = _parameters(model, given)
    _check_ending(output)
    equations = pipeline.derive(model)
    run = simulated(
        equations,
        time=time,
        parameters=parameters,
        start=_start(equations, parameters, start),
        target=target,
        samples=samples,
        how=how,
        until=until,
    )
    files = [path for path in (output, plot) if path]
    if output:
        _write_run(run, output)
    if plot:
        from eomgen.report.plots import plot_trajectory

        units = {q: part.unit.si for q, part in model.coordinates.items() if part.unit is not None}
        plot_trajectory(run, prepared(plot), title=model.name, units=units)
    assembled = f"The start was {run.assembled}." if run.assembled else ""
    notes = tuple(note for note in (assembled, run.remark if run.reactions else "") if note)
    first = _first_instant(equations, run, parameters)
    document = plain_document(
        model,
        lambda: _run_payload(model, run, files) | first,
        *_run_statements(model, run),
        failed="" if run.ok else run.message,
        notes=notes,
    )
    return document.proven(run.certify() if certify else None)


def _first_instant(equations: Equations, run: Trajectory, parameters: Mapping[str, float]) -> dict[str, Any]:
    """Accelerations and multipliers at the start; null where one has no single value."""
    if not len(run.t):
        return {"start_accelerations": {}, "start_multipliers": {}}
    phase, x = run.phases[0].model, dict(zip(run.coordinates + run.speeds, run.x[0].tolist(), strict=True))
    system, assembly = phase.declared, phase.declared_assembly
    state = np.array([x[node.name] for node in (*system.symbols.q, *system.symbols.u)])
    p = parameter_vector(equations.model, parameters)
    found = closing_accelerations(system, assembly, float(run.t[0]), state, p)
    return {"start_accelerations": found.a, "start_multipliers": found.lam}


def _check_ending(output: str | None) -> None:
    """Refuses a trajectory file that cannot be written, before the work is done.

    Raises:
        UsageError: the name ends in neither .csv nor .npz.
    """
    if output and not _is_stream(output) and Path(output).suffix.lower() not in (".csv", ".npz"):
        raise UsageError(f"no trajectory can be written as '{output}'", mend="endings are .csv, .npz")


def _is_stream(path: str) -> bool:
    """A pipe or a terminal: nothing to move into place."""
    return Path(path).exists() and not Path(path).is_file()


def _write_run(run: Trajectory, output: str) -> None:
    if Path(output).suffix.lower() == ".npz":
        run.to_npz(prepared(output))
    elif _is_stream(output):
        with open(output, "w", encoding="utf-8") as file:
            run.to_csv(file)
    else:
        run.to_csv(prepared(output))


def _run_statements(model: Model, run: Trajectory) -> tuple[Statement, ...]:
    """Where the motion ended, and how well the laws were kept."""
    shown = run.phases[:MOST_TOLD] if len(run.phases) > 1 else ()
    lines = [f"from {phase.start:.6g} s: {phase.ended_by}" for phase in shown]
    lines += [f"and {len(run.phases) - MOST_TOLD} phases more"] if len(run.phases) > MOST_TOLD else []
    rows = tuple((name, f"{x[0]:.9g}", f"{x[-1]:.9g}") for name, x in run.columns().items() if len(x))
    table = (Grid(("", "start", "end"), rows),) if rows else ()
    return (prose(f"{model.name}: {run.summary()}"), *(prose(f"  {line}") for line in lines), *table)


def _run_payload(model: Model, run: Trajectory, files: list[str]) -> dict[str, Any]:
    columns = {name: [_finite(x) for x in column.tolist()] for name, column in run.columns().items()}
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
        "remark": run.remark,
        "files": files,
        "assembled": run.assembled,
        "passages": [{"start": first, "end": last} for first, last in run.passages],
        "phases": [{"start": phase.start, "end": phase.end, "ended_by": phase.ended_by} for phase in run.phases],
    }
    return payload if files else payload | {"trajectory": columns}


def _finite(x: float | None) -> float | None:
    return float(x) if x is not None and abs(x) < float("inf") else None


def _parameters(model: Model, given: tuple[str, ...]) -> dict[str, float]:
    """The values of `--set m=2`: numbers, or expressions of numbers.

    Raises:
        UsageError: no parameter of that name, or no number.
    """
    values = {}
    for name, text in assignments(given, "--set m=2"):
        if name not in model.parameters:
            raise UsageError(f"--set: there is no parameter '{name}'", mend=nearest_name(name, model.parameters))
        values[name] = _value(text, {}, f"--set {name}={text}")
    return values


def _start(equations: Equations, parameters: Mapping[str, float], given: tuple[str, ...]) -> dict[str, float]:
    """The values of `--start theta=pi/2`, in which parameters may stand.

    Raises:
        UsageError: no coordinate or speed of that name, or no number.
    """
    known = exact_parameters(equations.model, parameters)
    names = (*equations.coordinates, *equations.speeds)
    values = {}
    for name, text in assignments(given, "--start theta=1"):
        if name not in names:
            raise UsageError(f"--start: there is no coordinate or speed '{name}'", mend=nearest_name(name, names))
        values[name] = _value(text, known, f"--start {name}={text}")
    return values


def _value(text: str, known: Mapping[str, Any], where: str) -> float:

    try:
        return float(parse(text).evaluate({**known, "pi": math.pi}))
    except (ExpressionError, OverflowError) as error:
        raise UsageError(f"{where}: {getattr(error, 'what', error)}", mend=getattr(error, "mend", "")) from error
