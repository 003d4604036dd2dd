"""eomgen simulate: the motion from the start, as a summary, as files, as a picture."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from eomgen import pipeline
from eomgen.codegen import closing_accelerations, parameter_vector
from eomgen.documents import Document, Grid, Statement, cell_text, plain_document, prose, proven
from eomgen.equations import Equations
from eomgen.errors import UsageError
from eomgen.files import is_stream
from eomgen.mechanics.constraints import limits_passed
from eomgen.model import Model, Unit, WrittenEquation
from eomgen.proof import ReportedRun, run_reported
from eomgen.runs import run as simulated
from eomgen.simulation import Accuracy, Stepping, Trajectory

MOST_REPORTED = 20  # phases in the text
MOST_AGAIN = 500_000  # evaluations of a run that is made again, finer, to know its error


def simulate_document(
    model: Model,
    *,
    time: float,
    how: Stepping,
    target: str | None,
    samples: int | None,
    until: WrittenEquation | None,
    output: str | None,
    plot: str | None,
    view: str = "time",
    units: bool = False,
    certify: bool = True,
) -> Document:
    """The motion from the start; trajectory and picture are written where files are given."""
    _check_ending(output)
    equations = pipeline.derive(model)
    run = simulated(
        equations,
        time=time,
        target=target,
        samples=samples,
        how=how,
        until=until,
    )
    files = [path for path in (output, plot) if path]
    if output:
        _write_run(run, output, model.units_of(run.columns()) if units else None)
    if plot:
        from eomgen.documents import run_picture

        run_picture(run, view, title=model.name, units=model.units_of(run.columns())).save(plot)
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
    left = model.left_tables(float(run.t[-1]) if len(run.t) else 0.0)
    passed = limits_passed(model, run.t, run.x[:, : len(run.coordinates)])
    document = replace(document, cautions=(*document.cautions, *left, *passed))
    if cut:
        return replace(proven(document, None), interrupted=run.status == "interrupted")
    return proven(
        document, run.certify() + run_reported(run, model, _reported(statements, payload, output)) if certify else None
    )


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
    phase, x = run.phases[0].model, dict(zip(run.coordinates + run.speeds, run.x[0].tolist(), strict=True))
    declared = phase.declared_equations
    state = np.array([x[node.name] for node in (*declared.symbols.q, *declared.symbols.u)])
    p = parameter_vector(equations.model)
    found = closing_accelerations(declared, float(run.t[0]), state, p)
    return {"start_accelerations": found.a, "start_multipliers": found.lam}


def _check_ending(output: str | None) -> None:
    """Refuses a trajectory file that cannot be written, before the work is done.

    Raises:
        UsageError: the name ends in neither .csv nor .npz.
    """
    if output and not is_stream(output) and Path(output).suffix.lower() not in (".csv", ".npz"):
        raise UsageError(f"no trajectory can be written as '{output}'", fix="endings are .csv, .npz")


def _write_run(run: Trajectory, output: str, units: Mapping[str, Unit] | None) -> None:
    if Path(output).suffix.lower() == ".npz":
        run.to_npz(output)
    else:
        run.to_csv(output, units)


def _run_statements(model: Model, run: Trajectory) -> tuple[Statement, ...]:
    """Statements of a run: its phases, the values at start and end, and how well the conservation laws hold."""
    shown = run.phases[:MOST_REPORTED] if len(run.phases) > 1 else ()
    lines = [f"from {phase.start:.6g} s: {phase.ended_by}" for phase in shown]
    lines += [f"and {len(run.phases) - MOST_REPORTED} phases more"] if len(run.phases) > MOST_REPORTED else []
    units, columns = model.units_of(run.columns()), run.columns()
    columns = {name: x / units[name].size if name in units else x for name, x in columns.items()}
    heads = {name: f"{name} [{units[name]}]" if name in units else name for name in columns}
    rows = tuple((heads[name], f"{x[0]:.9g}", f"{x[-1]:.9g}") for name, x in columns.items() if len(x))
    grids = (Grid(("", "start", "end"), rows), Grid(("of the run", "", "at"), _whole(model, run)))
    table = tuple(grid for grid in grids if grid.rows)
    accuracy = _accuracy(run)
    reported = [] if accuracy is None else [str(accuracy)]
    return (
        prose(" ".join([f"{model.name}: {run.summary()}", *reported])),
        *(prose(f"  {line}") for line in lines),
        *table,
    )


def _accuracy(run: Trajectory) -> Accuracy | None:
    """Estimate of the correct digits; None where the run was cut short or the second run would take too long."""
    cut = run.status in ("interrupted", "out of patience") or run.evaluations > MOST_AGAIN
    return None if cut or not len(run.t) else run.accuracy


def _whole(model: Model, run: Trajectory) -> tuple[tuple[str, str, str], ...]:
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
        "phases": [{"start": phase.start, "end": phase.end, "ended_by": phase.ended_by} for phase in run.phases],
    }
    return payload if files else payload | {"trajectory": columns}


def _finite(x: float | None) -> float | None:
    return float(x) if x is not None and abs(x) < float("inf") else None
