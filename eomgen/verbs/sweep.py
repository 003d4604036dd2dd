"""eomgen sweep: many runs, a row for each."""

from __future__ import annotations

from dataclasses import replace

from eomgen.documents import Document
from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.model import Model, Range, Requests, assignments
from eomgen.questions import variant_of
from eomgen.sweeps import Stepped, planned, spread_of, sweep_reported, swept
from eomgen.verbs.assignments import typed


@dataclass(frozen=True)
class SweepRequested:
    """Options of a sweep, as typed."""

    over: tuple[str, ...]
    random: tuple[str, ...]
    runs: int | None
    design: str
    seed: int
    ask: tuple[str, ...]
    critical: str
    how: Stepped
    workers: int
    set_: tuple[str, ...] = ()
    variant: int | None = None
    start: tuple[str, ...] = ()


def sweep_document(
    model: Model,
    requested: SweepRequested,
    *,
    text: str,
    title: str,
    output: str | None,
    plot: str | None = None,
    view: str = "",
    units: bool = False,
    certify: bool = True,
) -> Document:
    """The runs that the folder lacks are made; the document states their results."""
    if requested.variant is not None:
        drawn = variant_of(model, requested.variant).taken
        requested = replace(requested, set_=(*(f"{x.name}={x.typed}" for x in drawn), *requested.set_))
    valued, _ = typed(model, {"set_": requested.set_, "start": requested.start})
    ranges = [Range.of(valued.model, word, starts=True) for word in requested.over]
    spreads = [spread_of(valued.model, word) for word in requested.random]
    ask = [Requests(valued.model).output_taken(text) for text in requested.ask]
    critical = Requests(valued.model).output_taken(requested.critical)
    names = [each.name for each in ranges]
    if len(set(names)) < len(names):
        raise UsageError("--over: one name twice", fix="give each range once")
    plan = planned(
        valued.model,
        text=text,
        title=title,
        over={each.name: each.values for each in ranges},
        random=tuple((each.name, each.law, each.arguments) for each, _ in spreads),
        runs=requested.runs,
        design=requested.design,
        seed=requested.seed,
        ask=tuple(text for text, _ in ask),
        critical=critical[0],
        how=requested.how,
        given=dict(assignments(requested.set_, "--set m=2")),
        start=dict(assignments(requested.start, "--start theta=1")),
    )
    found = swept(plan, workers=requested.workers, out=output)
    if units and found.table_file is not None:
        found.to_csv(found.table_file, units=True)
    if plot:
        found.plot(plot, view)
    document = sweep_reported(valued.model, found, [plot] if plot else [], certify=certify)
    taken = [*valued.taken, *(each.taken for each in ranges), *(each for _, each in spreads)]
    taken += [each for _, of_one in (*ask, critical) for each in of_one]
    return replace(document, taken=tuple(taken))
