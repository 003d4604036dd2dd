"""Sweep -> its document: what came of the runs, and its proof; one of them once more."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

from eomgen.documents import Document, Grid, plain_document, prose, proven, rendered
from eomgen.errors import EomgenError, RunFailed, UsageError
from eomgen.model import Model, Output, Requests
from eomgen.pipeline import simulate
from eomgen.proof import Certificate, Check, Tally, answered_otherwise, differing, drawn_otherwise, reported_of_all
from eomgen.questions import solve
from eomgen.sensitivities import checks_of_slope, slope_in_si
from eomgen.simulation import Trajectory
from eomgen.sweeps.design import Stepped, SweepPlan
from eomgen.sweeps.runs_of_a_plan import CRITICAL, LEDGER, PARQUET, PLAN, TABLE, Sweep, sweep_at
from eomgen.sweeps.workers import FAILED, WITHOUT_MOTION, SweepKernel, is_without_motion
from eomgen.symbolic.numeric import NoValue

FEW = 5  # failed runs that are named
MOST_IN_JSON = 10_000  # runs whose rows stand in it
COARSER = 10.0  # steps of a run, to see whether what it says depends on them
SENSITIVE = 0.1  # of the difference between two runs: by so much their steps change what a run says
MOST_PROVEN = 10_000  # runs whose rows are looked at one by one


def sweep_reported(model: Model, found: Sweep, files: list[str], *, certify: bool) -> Document:
    """The results of a sweep, with the proof of one of its runs.

    Args:
        model: with the values that all runs have.
        files: those that were written besides the sweep's own.
    """
    return proven(_reported(model, found, files), _proof(found) if certify else None)


def sweep_in_markdown(found: Sweep) -> str:
    """The results of a sweep, without a proof, as Markdown."""
    return rendered(_reported(found.plan.model, found, []), "markdown")


def _reported(model: Model, found: Sweep, files: list[str]) -> Document:
    statuses, failed = found.ledger.statuses(), found.failed
    ended = ", ".join(f"{count} {status}" for status, count in statuses.items())
    where = "" if found.folder is None else f" In {found.folder}."
    lines = [f"{model.name}: {len(found)} runs: {ended}.{where}"]
    reported = [f"run {run}, {status}: {message}" for run, status, message in found.ledger.messages(FEW)]
    sizes, heads = found.in_units()
    numbers = {name: found.ledger.summary(found.columns.index(name)) for name in found.columns[4:]}
    rows = tuple(
        (heads.get(name, name), str(n), *(_number(x, sizes.get(name, 1.0)) for x in (low, mean, high)))
        for name, (n, low, mean, high) in numbers.items()
    )
    critical = tuple(
        prose(f"  {found.plan.critical} changes its sign at {_critical(row, sizes, heads)}") for row in found.critical
    )
    without = (f"{failed} of {len(found)} runs have no result: column `message`",)
    names = (PLAN, LEDGER, TABLE, PARQUET, CRITICAL)
    there = (
        [] if found.folder is None else [str(found.folder / name) for name in names if (found.folder / name).exists()]
    )
    grid = Grid(("", "runs", "least", "mean", "largest"), rows)
    return plain_document(
        model,
        lambda: _payload(found, [*there, *files]),
        *map(prose, lines),
        grid,
        *critical,
        *(prose(f"  {line}") for line in reported),
        failed="no run came to its end" if failed == len(found) else "",
        notes=(*found.remarks, *(without if 0 < failed < len(found) else ())),
    )


def _critical(row: Mapping[str, Any], sizes: Mapping[str, float], heads: Mapping[str, str]) -> str:
    staying = {**row["at"], row["name"]: row["value"]}
    if row["value"] is None:
        return f"no place that was found: {row['message']}"
    reported = ", ".join(f"{heads.get(name, name)} = {x / sizes.get(name, 1.0):.12g}" for name, x in staying.items())
    return f"{reported} ({row['message']})" if row["message"] else reported


def _number(x: float | None, size: float) -> str:
    return "" if x is None else f"{x / size:.9g}"


def _payload(found: Sweep, files: list[str]) -> dict[str, Any]:
    numbers = {name: found.ledger.summary(found.columns.index(name)) for name in found.columns[4:]}
    summary = {
        name: {"runs": n, "least": low, "mean": mean, "largest": high} for name, (n, low, mean, high) in numbers.items()
    }
    reported: dict[str, Any] = {
        "name": found.plan.model.name,
        "runs": len(found),
        "failed": found.failed,
        "statuses": found.ledger.statuses(),
        "hash": found.plan.hash,
        "columns": list(found.columns),
        "summary": summary,
        "critical": found.critical,
        "remarks": found.remarks,
        "files": files,
    }
    if len(found) <= MOST_IN_JSON:
        rows = list(found.ledger.rows())
        reported["table"] = {name: [row[k] for row in rows] for k, name in enumerate(found.columns)}
    return reported


def _proof(found: Sweep) -> Certificate | None:
    """Proof of the first run that came to its end: its equations, its motion, its outputs, and the same run made again.

    None if no run did.
    """
    first = next((row for row in found.ledger.rows() if row[2] in ("finished", "computed")), None)
    if first is None:
        return None
    kernel, plan = SweepKernel(found.plan), found.plan
    set_ = dict(zip(plan.runs.names, first[4:], strict=False))
    model = kernel.valued(set_)
    formulas = [text for text in plan.requested if text not in plan.slopes]
    requested = {f"asked{k}": Requests(plan.model).output(text) for k, text in enumerate(formulas)}
    model = model.requesting(requested)
    run = None if first[2] == WITHOUT_MOTION else _run_anew(model, plan.how)
    certificate = solve(model).certify() if run is None else run.certify()
    slopes = [check for pair in plan.slopes.values() for check in checks_of_slope(model, *pair, plan.how.time)]
    same = found.again(first[0]) == first
    again = Check(
        "a run made again has the same bits", "holds" if same else "fails", f"run {first[0]}, by the same kernel"
    )
    answers = _answers_proven(found, kernel, {} if run is None else {first[0]: (model, run)})
    return Certificate((*certificate.checks, *slopes, again, *answers, *_rows_proven(found)))


def _answers_proven(found: Sweep, kernel: SweepKernel, made: Mapping[int, tuple[Model, Trajectory]]) -> Iterator[Check]:
    """Checks the table's rows of the first run, the last, and one between drawn by the plan: each is made anew.

    Args:
        made: (model, run) of those that are made anew already.
    """
    plan = found.plan
    done = [row for row in found.ledger.rows() if row[2] != FAILED]
    between = [Random(plan.hash).choice(done[1:-1])] if len(done) > 2 else []
    tally = Tally("the outputs of a run have the values that its samples and equations give", "first, last, between")
    for row in {row[0]: row for row in (*done[:1], *between, *done[-1:])}.values():
        reported = dict(zip(plan.requested, row[4 + len(plan.runs.names) :], strict=True))
        model, run = made.get(row[0], (None, None))
        if model is None:
            model = kernel.valued(dict(zip(plan.runs.names, row[4:], strict=False))).requesting({})
            run = None if row[2] == WITHOUT_MOTION else _run_anew(model, plan.how)
        for text, wrong in _answered_otherwise(plan, model, reported, run):
            tally.add(f"{text} of run {row[0]}", wrong)
    yield from tally.checks()


def _answered_otherwise(
    plan: SweepPlan, model: Model, reported: Mapping[str, float | None], run: Trajectory | None
) -> Iterator[tuple[str, Callable[[], str]]]:
    """(output of a run, function that says how its reported value differs): by its samples, or by `solve`."""
    how = plan.how
    outputs = {text: Requests(plan.model).output(text) for text in plan.requested if text not in plan.slopes}
    for text, output in outputs.items():
        if is_without_motion(output):
            yield text, partial(_solved_otherwise, model, replace(output, unit=None), reported[text])
        elif run is not None and run.ok:
            yield text, partial(_sampled_otherwise, model, how, run, output, reported[text])
    for text, pair in plan.slopes.items():
        yield text, partial(_slope_otherwise, model, pair, how.time, reported[text])


def _run_anew(model: Model, how: Stepped, coarser: float = 1.0) -> Trajectory:
    return simulate(model, time=how.time, rtol=coarser * how.rtol, atol=coarser * how.atol, method=how.method)


def _sampled_otherwise(model: Model, how: Stepped, run: Trajectory, output: Output, reported: float | None) -> str:
    """Difference between a reported value and the samples of the run; "" if there is none.

    Raises:
        NoValue: the run's own value is that of its samples, and differs as much from that of a run with coarser steps:
            its motion is too sensitive.
    """
    wrong = answered_otherwise(run, output, reported)
    own = run.ask(output).value if wrong else None
    if isinstance(own, float) and not answered_otherwise(run, output, own):
        coarse = _run_anew(model, how, COARSER).ask(output).value
        if reported is None or not isinstance(coarse, float) or abs(coarse - own) >= SENSITIVE * abs(reported - own):
            raise NoValue("motions from one start part by their steps")
    return wrong


def _solved_otherwise(model: Model, output: Output, reported: float | None) -> str:
    (answer,) = solve(model.requesting({"asked": output})).values()
    return _other_number(reported, answer.value)


def _slope_otherwise(model: Model, pair: tuple[str, str], time: float, reported: float | None) -> str:
    return _other_number(reported, slope_in_si(model, *pair, time)[0])


def _other_number(reported: float | None, due: float | None) -> str:
    if reported is None or due is None:
        return "" if reported is due else f"{reported} for {due}"
    return differing(reported, due)


def _rows_proven(found: Sweep) -> Iterator[Check]:
    """Checks of the parameters set in every run, and of the statistics over all of them."""
    plan, rows, names = found.plan, list(found.ledger.rows()), found.columns
    if len(rows) > MOST_PROVEN:
        return
    last = 4 + len(plan.runs.names)
    yield drawn_otherwise(plan.over, plan.random, plan.draws, plan.design, [(*row[:2], *row[4:last]) for row in rows])
    columns = {name: [row[k] for row in rows] for k, name in enumerate(names) if k >= 4}
    summary = {name: found.ledger.summary(names.index(name)) for name in columns}
    yield reported_of_all(columns, summary, found.remarks, plan.critical, plan.how.rtol, names[last:])


def replay_document(folder: str, run: int, *, output: str | None, samples: int | None) -> Document:
    """One run of a sweep once more; its results are those of the table, bit for bit."""
    if output is not None and Path(output).suffix.lower() not in (".csv", ".npz"):
        raise UsageError(f"no trajectory can be written as '{output}'", fix="endings are .csv, .npz")
    found = sweep_at(folder)
    row = found.again(run)
    stood = found.ledger.row(run)
    messages: list[str] = []
    if output is not None:
        try:
            motion = found.replay(run, samples or 1001)
        except EomgenError as error:
            raise RunFailed(f"run {run} has no motion: {error.what}", fix=error.fix) from error
        (motion.to_npz if Path(output).suffix.lower() == ".npz" else motion.to_csv)(output)
        messages.append(motion.summary())
    differ = [name for name, x, y in zip(found.columns, row, stood or row, strict=True) if x != y]
    columns = dict(zip(found.columns, row, strict=True))
    heads = tuple(
        (name, "" if x is None else repr(x) if isinstance(x, float) else str(x)) for name, x in columns.items()
    )
    same = "not in the table yet" if stood is None else "as in the table, bit for bit" if not differ else "other"
    return plain_document(
        found.plan.model,
        lambda: {"row": columns, "differ": differ, "in_table": stood is not None, "files": [output] if output else []},
        prose(f"{found.plan.model.name}: run {run}, {same}."),
        Grid(("", ""), heads),
        *(prose(message) for message in messages),
        failed=f"run {run} differs from the table in {', '.join(differ)}" if differ else "",
    )
