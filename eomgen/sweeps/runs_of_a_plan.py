"""Model, ranges, distributions -> Sweep: a row for each run, in a ledger with which an interrupted sweep goes on."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import IO, Any

import numpy as np

from eomgen import files
from eomgen.errors import ExpressionError, RunFailed, UsageError
from eomgen.frozen import dataclass
from eomgen.model import (
    Model,
    ModelOrPath,
    Range,
    Requests,
    Typed,
    TypedNumbers,
    bytes_at,
    loads,
    seconds,
    typed_values,
)
from eomgen.resources import another_stretch
from eomgen.sensitivities import unit_of_slope
from eomgen.simulation import Stepping, Trajectory
from eomgen.sweeps.design import FIXED, Stepped, SweepPlan, plan_of, refuse_bad_design, spread_of, texts
from eomgen.sweeps.workers import (
    UNKNOWN_WORKERS,
    Chunk,
    Payload,
    Pool,
    SampleRow,
    SweepKernel,
    SweepLedger,
    ledger_at,
    payload_of,
    progress_of,
    rows_by,
    rows_here,
    value_of_run,
)
from eomgen.symbolic.numeric import tolerances

PLAN, LEDGER, TABLE, PARQUET, CRITICAL = "plan.json", "ledger.sqlite", "table.csv", "table.parquet", "critical.csv"
BLOCK = 100_000  # runs whose rows are looked for at once
ROWS_OF_PARQUET = 50_000


@dataclass(frozen=True, repr=False)
class Sweep:
    """Results of every run.

    Args:
        plan: the plan of the runs.
        ledger: the rows.
        folder: folder of the files; None: in memory.
    """

    plan: SweepPlan
    ledger: SweepLedger
    folder: Path | None = None

    @property
    def columns(self) -> tuple[str, ...]:
        """run, seed, status, message, values set, values requested."""
        return self.plan.columns

    @property
    def table(self) -> dict[str, np.ndarray]:
        """Every column as an array, by the numbers of the runs; SI, nan where a run has no value."""
        rows = list(self.ledger.rows())
        kinds = (np.int64, np.int64, object, object, *[float] * (len(self.columns) - len(FIXED)))
        pairs = zip(self.columns, kinds, strict=True)
        return {name: np.array([row[k] for row in rows], dtype=kind) for k, (name, kind) in enumerate(pairs)}

    def __getitem__(self, name: str) -> np.ndarray:
        return self.table[name]

    def __len__(self) -> int:
        return self.ledger.count

    @property
    def critical(self) -> list[dict[str, Any]]:
        """Critical values: the values that stay, the name, its value, the residual there, a message."""
        names = ("at", "name", "value", "left", "message")
        return [dict(zip(names, (json.loads(row[1]), *row[2:]), strict=True)) for row in self.ledger.critical()]

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on requests without an effect."""
        return remarks_of(self.plan, self.ledger)

    @property
    def failed(self) -> int:
        """Number of runs that failed."""
        good = ("finished", "event", "computed")
        return sum(count for status, count in self.ledger.statuses().items() if status not in good)

    def to_pandas(self) -> Any:
        """The table as a DataFrame over the runs (needs pandas)."""
        import pandas

        table = self.table
        return pandas.DataFrame(table).set_index("run")

    def to_csv(self, path: str | Path, *, units: bool = False) -> None:
        """A header line and a line for each run; SI, or (`units`) in the units of the file, "k [N/m]"."""
        files.write(path, lambda file: _write_csv(file, self, units))

    @property
    def table_file(self) -> Path | None:
        """The file of the table; None of a sweep in memory."""
        return None if self.folder is None else self.folder / TABLE

    def in_units(self) -> tuple[dict[str, float], dict[str, str]]:
        """(the size in SI, the head "k [N/m]") of every column that has a unit, as the file declares it."""
        model = self.plan.model
        slopes, texts = self.plan.slopes, self.plan.requested
        requested = {f"asked{k}": Requests(model).output(text) for k, text in enumerate(texts) if text not in slopes}
        found = model.requesting(requested).units_of(requested)
        found |= {f"asked{k}": unit_of_slope(model, *slopes[text]) for k, text in enumerate(texts) if text in slopes}
        units = model.units_of(self.plan.runs.names)
        columns = enumerate(self.columns[-len(texts) :])
        units |= {column: found[f"asked{k}"] for k, column in columns if f"asked{k}" in found}
        sizes = {name: unit.size for name, unit in units.items()}
        return sizes, {name: f"{name} [{unit}]" for name, unit in units.items()}

    def plot(self, path: str | Path | None = None, view: str = "") -> Any:
        """A picture: "lines", "heat", "scatter"; "" takes what fits."""
        from eomgen.sweeps.pictures import sweep_picture

        picture = sweep_picture(self, view)
        if path is not None:
            picture.save(path)
        return picture

    def replay(self, run: int, samples: int = 1001) -> Trajectory:
        """One run repeated, with all its columns.

        Raises:
            UsageError: there is no such run.
            RunFailed: the sweep requests no motion, or its model is not known here.
        """
        _refuse_no_run(self.plan, run)
        kernel = SweepKernel(_known(self.plan))
        _, values = self.plan.runs.runs(run, run + 1)
        set_ = dict(zip(self.plan.runs.names, values[0].tolist(), strict=True))
        return kernel.motion(set_, samples, ("reactions",))

    def again(self, run: int) -> SampleRow:
        """The row of a run, computed once more by the same kernel."""
        _refuse_no_run(self.plan, run)
        return SweepKernel(_known(self.plan)).rows(run, run + 1)[0]

    def _repr_markdown_(self) -> str:
        """Results for notebooks: how the runs ended, and of each value the least, the mean and the largest."""
        told = import_module("eomgen.sweeps.documents")  # which is made of sweeps, and comes later
        text: str = told.sweep_in_markdown(self)
        return text

    def __repr__(self) -> str:
        where = "" if self.folder is None else f" in {self.folder}"
        return f"<sweep of {', '.join(self.plan.runs.names)}: {len(self)} of {self.plan.runs.count} runs{where}>"


def _known(plan: SweepPlan) -> SweepPlan:
    if not plan.text and plan.made is None:
        raise RunFailed("the model of this sweep was made in Python", fix="call eomgen.sweep with it, and .replay(run)")
    return plan


def _refuse_no_run(plan: SweepPlan, run: int) -> None:
    if not 0 <= run < plan.runs.count:
        raise UsageError(f"there is no run {run}", fix=f"from 0 to {plan.runs.count - 1}")


# -- as a user requests it ---------------------------------------------------------------------------------


def sweep(
    model: ModelOrPath,
    *,
    over: Mapping[str, Any] | None = None,
    random: Mapping[str, str] | None = None,
    runs: int | None = None,
    design: str = "random",
    seed: int = 0,
    ask: Sequence[str] | str = (),
    critical: str = "",
    time: Typed = 10.0,
    workers: int = 1,
    executor: Any = None,
    out: str | Path | None = None,
    rtol: float = tolerances.RUN,
    atol: float = tolerances.RUN,
    method: str = "DOP853",
) -> Sweep:
    """Many runs of a model, each by its number alone; runs that are done in `out` are not repeated.

    Args:
        over: values of parameters and starts, every one with every other: numbers in SI, or a text "100:1000:10",
            "log:1:100:5".
        random: distributions: "normal(0, 0.1)", "uniform(1, 2)", "loguniform", "lognormal", "triangular".
        runs: how many are drawn (at each point of the grid).
        design: "random", "sobol" or "lhs" (Latin hypercube).
        ask: requests of each run: outputs by name, "max(reaction_x(A))", "theta' at theta = 0", "frequency(1)";
            without requests, and without `critical`, all [outputs].
        critical: an expression whose changes of sign are sought along the first name of `over`.
        workers: processes here.
        executor: anything with `submit`, instead of them: of dask.distributed, loky, mpi4py.futures.
        out: a folder for plan.json, ledger.sqlite, table.csv.
    Raises:
        UsageError: the request makes no sense; another plan is in `out`.
    """
    text, title, made = _source(model)
    declared = made if made is not None else loads(text, str(model), title)
    grid = {name: _values(declared, name, values) for name, values in (over or {}).items()}
    spreads = [spread_of(declared, f"{name}={law}", declared=False)[0] for name, law in (random or {}).items()]
    plan = planned(
        declared,
        text=text,
        title=title,
        made=made,
        over=grid,
        random=tuple((spread.name, spread.law, spread.arguments) for spread in spreads),
        runs=runs,
        design=design,
        seed=seed,
        ask=texts(ask),
        critical=critical,
        how=Stepped(seconds(time), rtol, atol, method),
    )
    return swept(plan, workers=workers, executor=executor, out=out)


def _source(model: ModelOrPath) -> tuple[str, str, Model | None]:
    """(text, title, the model where there is no text)."""
    if isinstance(model, Model):
        return "", model.name, model
    return bytes_at(str(model)).decode(), Path(model).stem, None


def _values(model: Model, name: str, given: Any) -> tuple[float, ...]:
    """Values of a name in SI; a plain number in Python is."""
    if isinstance(given, str):
        logarithmic = given.startswith("log:")
        text = f"{'log:' * logarithmic}{name}={given.removeprefix('log:')}"
        return Range.of(model, text, starts=True, declared=False).values
    Requests(model).refuse_what_is_not_set(name, starts=True)
    typed = TypedNumbers(model, name, declared=False)
    try:
        values = tuple(map(typed.number, typed_values(given)))
    except (ValueError, TypeError, ExpressionError) as error:
        what, fix = (error.what, error.fix) if isinstance(error, ExpressionError) else ("they are no numbers", "")
        raise UsageError(f"over: the values of '{name}': {what}", fix=fix or Range.LIKE) from error
    if not values or not all(map(math.isfinite, values)):
        raise UsageError(f"over: the values of '{name}' are no numbers", fix="give one or more")
    return values


def planned(model: Model, *, runs: int | None, **fields: Any) -> SweepPlan:
    """The plan of a sweep, checked before anything is run.

    Raises:
        UsageError: the request makes no sense.
    """
    draws = 1 if runs is None else runs
    refuse_bad_design(fields["design"], draws, fields["seed"])
    if not fields["over"] and not fields["random"]:
        raise UsageError("nothing changes from run to run", fix='--over "k=100:1000:10", --random "phi=normal(0, 0.1)"')
    if runs is not None and runs > 1 and not fields["random"]:
        raise UsageError(
            f"{runs} runs of the same values", fix='give --random "phi=normal(0, 0.1)", or leave --runs out'
        )
    fixed = [*fields.get("given", ()), *fields.get("start", ())]
    names = [*fields["over"], *(name for name, _, _ in fields["random"]), *fixed]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        fix = "leave its --set or --start out" if twice[0] in fixed else "once in --over or once in --random"
        raise UsageError(f"'{twice[0]}' is set twice", fix=fix)
    if fields["critical"] and not fields["over"]:
        raise UsageError("a critical value is sought along a range", fix='give --over "k=100:1000:10"')
    if fields["critical"] and fields["random"] and fields["design"] == "random":
        what = "neighbours of the grid have other draws: nothing but the first range may change where a sign is sought"
        raise UsageError(what, fix="--design sobol or lhs, which draw the same at every point")
    if not fields["ask"] and not fields["critical"]:
        fields["ask"] = tuple(name for name, output in model.outputs.items() if output.event != "every")
    plan = SweepPlan(draws=draws, **fields)
    if not plan.requested:
        raise UsageError("nothing is requested of the runs", fix='--ask "max(theta)", or give the model [outputs]')
    how = fields["how"]
    if not how.time > 0:
        raise UsageError(f"the time {how.time:g} s makes no sense", fix="give one above 0")
    Stepping(how.method, how.rtol, how.atol).refuse_bad_run(0.0, how.time)
    for text in plan.requested:
        of, to = plan.slopes.get(text, (text, ""))
        output = Requests(model).output(of)
        moving = (*model.coordinates, *model.speeds, *model.states)
        if to and to.removesuffix("'") not in (*model.parameters, *moving):
            raise UsageError(f"'{text}': no parameter, coordinate, speed or state '{to}'", fix="name one of the model")
        if output.event is not None and not isinstance(output.event, int):
            raise UsageError(f"'{text}' is of several instants", fix="request one of them: event 1")
    return plan


def swept(plan: SweepPlan, *, workers: int = 1, executor: Any = None, out: str | Path | None = None) -> Sweep:
    """All runs of a plan that its ledger lacks, then the table.

    Raises:
        UsageError: another plan is in the folder.
    """
    if workers < 1:
        raise UsageError(f"{workers} workers make no sense", fix="give 1 or more")
    folder = None if out is None else Path(out)
    if folder is not None:
        _begun(plan, folder)
    ledger = ledger_at(None if folder is None else folder / LEDGER, plan)
    found = Sweep(plan, ledger, folder)
    pool = Pool(workers if executor is None else _workers_of(executor), executor)
    payload = payload_of(plan)
    try:
        with progress_of(plan.runs.count, ledger.count) as reported:
            if workers == 1 and executor is None:
                rows = rows_here(payload, _missing(ledger))
            else:
                rows = rows_by(pool, payload, _missing(ledger), lambda run: plan.runs.runs(run, run + 1)[0][0])
            for some in rows:
                reported(ledger.add([_whole(plan, row) for row in some]))
                another_stretch(_kept(ledger.count, folder))
        if plan.critical:
            ledger.add_critical(critical_values(plan, ledger, pool if pool.workers > 1 else None))
    except KeyboardInterrupt:
        raise KeyboardInterrupt(_kept(ledger.count, folder)) from None
    finally:
        pool.close()
        if folder is not None:
            ledger.settle()
            _write_tables(found, folder)
    return found


def _kept(count: int, folder: Path | None) -> str:
    return "nothing is kept" if folder is None else f"{count} runs are kept in {folder}, the same command goes on"


def _whole(plan: SweepPlan, row: SampleRow) -> SampleRow:
    """Row of a run; where every worker died of it, the row has the values set and no results."""
    if len(row) == len(plan.columns):
        return row
    values = plan.runs.runs(row[0], row[0] + 1)[1][0].tolist()
    return (*row, *values, *[None] * len(plan.requested))


def _workers_of(executor: Any) -> int:
    return int(getattr(executor, "_max_workers", 0) or UNKNOWN_WORKERS)


def _missing(ledger: SweepLedger) -> Iterator[Chunk]:
    """Stretches of runs that are not done, block by block."""
    count = ledger.plan.runs.count
    for first in range(0, count, BLOCK):
        yield from ledger.missing(first, min(first + BLOCK, count))


def _begun(plan: SweepPlan, folder: Path) -> None:
    """plan.json, written before the first run.

    Raises:
        UsageError: that of another plan is there.
    """
    path = folder / PLAN
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"'{folder}' is a file", fix="-o names the folder of the sweep")
    if not path.exists():
        if (folder / LEDGER).exists():
            raise UsageError(f"'{folder}' has a ledger and no {PLAN}", fix="give -o another folder")
        files.write(path, plan.written())
        return
    there = _plan_reported(folder)
    if there.get("hash") != plan.hash:
        changed = _changed(plan.as_dict(), there)
        raise UsageError(f"'{folder}' holds another plan: {changed}", fix="give -o another folder, or the same plan")


def _plan_reported(folder: Path) -> dict[str, Any]:
    try:
        reported = json.loads((folder / PLAN).read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(
            f"'{folder}' holds no {PLAN}: no sweep was begun there", fix="begin it: eomgen sweep MODEL -o DIR"
        ) from error
    except ValueError as error:
        raise UsageError(f"'{folder / PLAN}' is no plan of a sweep: {error}", fix="take another folder") from error
    if not isinstance(reported, dict):
        raise UsageError(f"'{folder / PLAN}' is no plan of a sweep", fix="take another folder")
    return reported


def _changed(mine: Mapping[str, Any], there: Mapping[str, Any]) -> str:
    names = [name for name, x in mine.items() if there.get(name) != json.loads(json.dumps(x))]
    return ", ".join("the model" if name in ("text", "model_hash") else name for name in names) or "its hash"


def sweep_at(folder: str | Path) -> Sweep:
    """The sweep in a folder, as far as it is done.

    Raises:
        UsageError: there is none.
    """
    folder = Path(folder)
    plan = plan_of(_plan_reported(folder))
    if not (folder / LEDGER).exists():
        raise UsageError(f"'{folder}' holds no {LEDGER}: no run was begun", fix="begin it: eomgen sweep MODEL -o DIR")
    reported = _plan_reported(folder)["hash"]
    if plan.hash != reported and plan.text:
        raise UsageError(
            f"'{folder / PLAN}' was changed by hand: its hash is not that of its content",
            fix="begin the sweep again in another folder",
        )
    object.__setattr__(plan, "hash", reported) if not plan.text else None
    return Sweep(plan, ledger_at(folder / LEDGER, plan), folder)


# -- files --------------------------------------------------------------------------------------------------


def _write_tables(found: Sweep, folder: Path) -> None:
    found.to_csv(folder / TABLE)
    if found.plan.critical:
        rows = found.critical
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        staying = [name for name in found.plan.over][1:]
        writer.writerow([*staying, next(iter(found.plan.over)), found.plan.critical, "message"])
        for row in rows:
            writer.writerow([*(repr(row["at"][name]) for name in staying), row["value"], row["left"], row["message"]])
        files.write(folder / CRITICAL, text.getvalue())
    _write_parquet(found, folder / PARQUET)


def _write_csv(file: IO[bytes], found: Sweep, units: bool) -> None:
    sizes, heads = found.in_units() if units else ({}, {})
    text = io.TextIOWrapper(file, encoding="utf-8", newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(heads.get(name, name) for name in found.columns)
    factors = [sizes.get(name, 1.0) for name in found.columns]
    for row in found.ledger.rows():
        writer.writerow(_reported(x, size) for x, size in zip(row, factors, strict=True))
    text.flush()
    text.detach()


def _reported(x: Any, size: float) -> str:
    if x is None:
        return "nan"
    return repr(x if size == 1.0 else x / size) if isinstance(x, float) else str(x)


def _write_parquet(found: Sweep, path: Path) -> None:
    """table.parquet, where pyarrow is."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        return
    kinds = [pyarrow.int64(), pyarrow.int64(), pyarrow.string(), pyarrow.string()]
    kinds += [pyarrow.float64()] * (len(found.columns) - len(FIXED))
    schema = pyarrow.schema(list(zip(found.columns, kinds, strict=True)))

    def fill(file: IO[bytes]) -> None:
        with pyarrow.parquet.ParquetWriter(file, schema) as writer:
            for some in _several(found.ledger.rows(), ROWS_OF_PARQUET):
                columns = [
                    pyarrow.array(column, kind) for column, kind in zip(zip(*some, strict=True), kinds, strict=True)
                ]
                writer.write_table(pyarrow.Table.from_arrays(columns, schema=schema))

    files.write(path, fill)


def _several(rows: Iterable[SampleRow], many: int) -> Iterator[list[SampleRow]]:
    some: list[SampleRow] = []
    for row in rows:
        some.append(row)
        if len(some) == many:
            yield some
            some = []
    if some:
        yield some


# -------- critical --------------------------------------------------------------------------------------------
# Rows of a sweep -> critical values: where an expression changes its sign along the first of the ranges; and remarks on
# requests without an effect.


JUMP = 1e-3  # share of the values at both ends of the bracket: a larger residual is a jump or a pole


def critical_values(plan: SweepPlan, ledger: SweepLedger, pool: Pool | None) -> list[SampleRow]:
    """(number, values that stay, name, value, residual, message) of each change of sign between grid neighbours."""
    known = {row[0] for row in ledger.critical()}
    tasks = [task for task in _brackets(plan, ledger) if task[0] not in known]
    payload = payload_of(plan)
    if pool is None:
        return [bisected(payload, *task) for task in tasks]
    futures = [pool.submit(bisected, payload, *task) for task in tasks]
    return [future.result() for future in futures]


Bracket = tuple[int, dict[str, float], str, tuple[float, float], tuple[float, float], str]
"""(number, values that stay, the name, its two values, results at them, the expression)"""


def _brackets(plan: SweepPlan, ledger: SweepLedger) -> Iterator[Bracket]:
    """Neighbours along the first range at which the expression has different signs; every other value stays."""
    design, name = plan.runs, next(iter(plan.over))
    many = design.count // len(plan.over[name])
    k = len(plan.columns) - len(plan.requested) + plan.requested.index(plan.critical)
    before: dict[int, Any] = {}
    for row in ledger.rows():
        place = row[0] % many
        one, value = before.get(place), row[k]
        before[place] = row
        names = plan.columns[4 : 4 + len(design.names)]
        staying = {other: x for other, x in zip(names, row[4:], strict=False) if other != name}
        if one is None or one[k] is None or value is None or row[0] - one[0] != many:
            continue
        if one[k] * value < 0 or (value == 0) != (one[k] == 0):
            if one[k]:
                yield row[0], staying, name, (one[4], row[4]), (one[k], value), plan.critical
            elif one[0] < many:  # 0 where the range begins
                yield one[0], staying, name, (one[4], one[4]), (0.0, 0.0), plan.critical


def remarks_of(plan: SweepPlan, ledger: SweepLedger) -> tuple[str, ...]:
    """Remarks on requests without an effect: results that are the same in all runs, and no critical value."""
    remarks = []
    for column, name in enumerate(plan.columns[-len(plan.requested) :], len(plan.columns) - len(plan.requested)):
        count, low, _, high = ledger.summary(column)
        if count < 2 or low is None or high is None:
            continue
        same = high - low <= plan.how.rtol * max(abs(low), abs(high))
        reported = f"'{name}' is {high:.9g} in all runs: none of the values set changes it"
        if plan.requested[column - len(plan.columns)] == plan.critical and not ledger.critical():
            reported = reported if same else f"it goes from {low:.9g} to {high:.9g}"
            remarks.append(f"'{plan.critical}' changes its sign nowhere along {next(iter(plan.over))}: {reported}")
        elif same:
            remarks.append(reported)
    return tuple(remarks)


def bisected(
    payload: Payload,
    number: int,
    staying: Mapping[str, float],
    name: str,
    ends: tuple[float, float],
    values: tuple[float, float],
    text: str,
) -> SampleRow:
    """Critical value between two values, by Brent's method."""
    from scipy.optimize import brentq

    (a, b), (low, high) = ends, values
    reported = json.dumps(dict(staying))
    if high == 0:
        return number, reported, name, b, 0.0, ""
    values_at = {a: low, b: high}

    def value(x: float) -> float:
        found = values_at[x] if x in values_at else value_of_run(payload, {**staying, name: x}, text)
        if found is None:
            raise RunFailed(f"no value at {name} = {x:.12g}", fix="narrow the range to where it has values")
        values_at[x] = found
        return found

    try:
        root = float(brentq(value, a, b, xtol=tolerances.SOLVED * max(abs(a), abs(b)), rtol=tolerances.SOLVED))
        left = abs(value(root))
    except RunFailed as error:
        return number, reported, name, None, None, error.what
    return number, reported, name, root, left, "it jumps there" if left > JUMP * max(map(abs, values)) else ""
