"""eomgen simulate: the motion from the start, as a summary, as files, as a picture."""

from __future__ import annotations

from pathlib import Path

from eomgen import pipeline
from eomgen.documents import Document, heads_in_symbols, run_picture
from eomgen.errors import UsageError
from eomgen.files import is_stream
from eomgen.model import Model, WrittenEquation
from eomgen.runs import run as simulated
from eomgen.runs import run_document
from eomgen.simulation import Stepping


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
    symbols: bool = False,
    certify: bool = True,
) -> Document:
    """The motion from the start; trajectory and picture are written where files are given."""
    _check_ending(output)
    equations = pipeline.derive(model)
    run = simulated(equations, time=time, target=target, samples=samples, how=how, until=until)
    if output and Path(output).suffix.lower() == ".npz":
        run.to_npz(output)
    elif output:
        heads = heads_in_symbols(run) if symbols else None
        run.to_csv(output, model.units_of(run.columns()) if units else None, heads)
    if plot:
        run_picture(run, view, title=model.name, units=model.units_of(run.columns())).save(plot)
    return run_document(equations, run, output=output, plot=plot, certify=certify)


def _check_ending(output: str | None) -> None:
    """Refuses a trajectory file that cannot be written, before the work is done.

    Raises:
        UsageError: the name ends in neither .csv nor .npz.
    """
    if output and not is_stream(output) and Path(output).suffix.lower() not in (".csv", ".npz"):
        raise UsageError(f"no trajectory can be written as '{output}'", fix="endings are .csv, .npz")
