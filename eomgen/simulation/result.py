"""Results of a simulation: states over time, errors of the conservation laws and constraints, and how it ended."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cache, cached_property
from importlib import import_module
from pathlib import Path
from typing import IO, Any, Literal

import numpy as np

from eomgen import files
from eomgen.errors import UsageError
from eomgen.frozen import Pickled, dataclass, with_fields
from eomgen.model import OUTPUT, Unit
from eomgen.symbolic.numeric import tolerances

SHOWN = 80  # characters of names on a line

RunStatus = Literal[
    "finished",
    "not finite",
    "step too small",
    "too many steps",
    "out of patience",
    "interrupted",
    "event",
    "contact",
    "singular",
    "contradicted",
]


class OnDemand(Mapping[str, np.ndarray]):
    """Columns by name, computed when one of them is read; a pickle holds all of them."""

    def __init__(self, names: Sequence[str], make: Callable[[], Mapping[str, np.ndarray]]) -> None:
        self.names, self.make = dict.fromkeys(names), make

    @cached_property
    def _made(self) -> Mapping[str, np.ndarray]:
        return self.make()

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.names:
            raise KeyError(name)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"<columns {', '.join(self.names)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return dict, (dict(self),)


@dataclass(frozen=True)
class Phase:
    """A stretch of time in which the model stays the same.

    Args:
        start, end: its times [s].
        ended_by: the reason of its end, in words.
        rows: its first row in the trajectory, and the one after its last; where it ends and another begins the row is
            that of the other, in the state after.
        model: its equations, contacts and reactions, where contacts are that change; else None.
        tracked: -> `track`, put together on demand.
        edges: -> `first`, `last`: every column at its beginning and at its end, where contacts are that change.
    """

    start: float
    end: float
    ended_by: str
    rows: tuple[int, int] = (0, 0)
    model: Any = field(default=None, repr=False, compare=False)
    tracked: Callable[[], tuple[np.ndarray, np.ndarray]] | None = field(default=None, repr=False, compare=False)
    edges: Callable[[], tuple[Mapping[str, float], Mapping[str, float]]] | None = field(
        default=None, repr=False, compare=False
    )

    @cached_property
    def track(self) -> tuple[np.ndarray, np.ndarray] | None:
        """(instants, states) of the phase: those requested and the integrator's steps, in order; None where unknown."""
        return None if self.tracked is None else self.tracked()

    @cached_property
    def _edges(self) -> tuple[Mapping[str, float], Mapping[str, float]]:
        return ({}, {}) if self.edges is None else self.edges()

    @property
    def first(self) -> Mapping[str, float]:
        """Every column at its beginning; empty where no contacts are that change."""
        return self._edges[0]

    @property
    def last(self) -> Mapping[str, float]:
        """The same at its end."""
        return self._edges[1]

    def __getstate__(self) -> dict[str, Any]:
        """State to be pickled: the numbers, without equations and compiled code."""
        own = {name: self.__dict__[name] for name in ("start", "end", "ended_by", "rows")}
        made = {"tracked": self.track, "edges": self._edges if self.edges is not None else None}
        return own | {"model": None} | {name: None if x is None else Pickled(x) for name, x in made.items()}


@dataclass(frozen=True)
class Kept:
    """Errors of energy and constraints, at the instants given and at the integrator's steps.

    Args:
        drift: largest |E - E(0)| over the largest T and |V - V(0)|; None where energy need not be constant.
        gap, gap_rate: largest |phi| and |J u + sigma| of the constraints that close; None where none closes.
    """

    drift: float | None = None
    gap: float | None = None
    gap_rate: float | None = None


@dataclass(frozen=True)
class Impact:
    """One impact of a motion.

    Args:
        t: the instant [s].
        contact: what closed; of several at once all names, with commas between.
        impulses: of contacts by name, of further rows and constraints with more rows than one "NAME component", of
            joints on their bodies "impulse_x(rod)", "impulse_couple(rod)" [N s, of couples N m s]; nan where only
            their sum has a value.
        loss: of kinetic energy [J].
    """

    t: float
    contact: str
    impulses: dict[str, float]
    loss: float

    def __getitem__(self, name: str) -> Any:
        """A field by its name, as in the entries for machines."""
        return self.as_dict()[name]

    def as_dict(self) -> dict[str, Any]:
        """Its fields; an impulse without a single value is None."""
        impulses = {name: float(x) if np.isfinite(x) else None for name, x in self.impulses.items()}
        return {"t": self.t, "contact": self.contact, "impulses": impulses, "loss": self.loss}


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory:
    """A motion. One that ended early holds its results so far and the reason.

    Args:
        t: times, n [s], one row each: strictly later from row to row.
        x: states (q, u, z), n x (nq + nu + nz), in the order of `coordinates`, `speeds`, `states`.
        coordinates, speeds, states: the names; of the last those of first order.
        energies: -> `energy`, found on demand; None where it is not given.
        measure: -> the errors of energy and constraints, found on demand.
        phases: in order.
        ended: "finished" or the reason of an earlier end.
        words: the same as a sentence.
        steps, evaluations: taken by the integrator.
        reactions: of joints and constraints, n each [N, N m]: nan where one has no single value; {} where there are
            none.
        units: of the reactions, by name.
        outputs: of the model, n each [SI]: nan where one has no value; one that has no column is in the remark.
        reported: text on those that are missing at every state, with the reason; or "".
        gaps: -> the same of single states, found on demand.
        carried: the start and the end of each crossing of a singular position (a change point, a dead centre).
        impacts: where velocities jumped: instant, contact, impulses, loss of energy, each an Impact.
        assembled: text on the changes of the start values by which the constraints hold there; or "".
        proof: the run -> its certificate; None where its equations are not known.
        whole: text -> its value over the whole run (a RunValue); None where its equations are not known.
        quantities: of the model's outputs those that are of the whole run, each a RunValue.
        estimate: the run -> its Accuracy, by another run; None where its equations are not known.
        watch: the run -> the checks of what it watches anyway: energy against power, constraints, norms; None: nobody
            does.
    """

    NO_EQUATIONS = "nothing is known of the equations behind these numbers"
    """why there is no proof of a run that was given by hand, or read from a pickle"""
    t: np.ndarray
    x: np.ndarray
    coordinates: tuple[str, ...]
    speeds: tuple[str, ...]
    energies: Callable[[], np.ndarray] | None = field(repr=False)
    measure: Callable[[], Kept] = field(repr=False)
    phases: tuple[Phase, ...]
    ended: RunStatus
    words: str
    steps: int
    evaluations: int
    reactions: Mapping[str, np.ndarray] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    outputs: Mapping[str, np.ndarray] = field(default_factory=dict)
    reported: str = ""
    gaps: Callable[[], str] = field(default=Pickled(""), repr=False)
    carried: tuple[tuple[float, float], ...] = ()
    impacts: tuple[Impact, ...] = ()
    assembled: str = ""
    proof: Callable[[Trajectory], Any] | None = None
    whole: Callable[[Any], Any] | None = field(default=None, repr=False)
    quantities: Mapping[str, Any] = field(default_factory=dict)
    estimate: Callable[[Trajectory], Any] | None = None
    watch: Callable[[Trajectory], tuple[Any, ...]] | None = field(default=None, repr=False)
    states: tuple[str, ...] = ()

    @property
    def moving(self) -> tuple[str, ...]:
        """Everything in x = (q, u, z) by name."""
        return self.coordinates + self.speeds + self.states

    def __getstate__(self) -> dict[str, Any]:
        """All its numbers. What needs the equations again (`certify`, `ask`, `accuracy`) does not go into a pickle."""
        own = {name: self.__dict__[name] for name in self.__dataclass_fields__}
        own |= {"energies": None if self.energies is None else Pickled(self.energy), "measure": Pickled(self.kept)}
        own["gaps"] = Pickled(self.gaps())
        return own | {"proof": None, "whole": None, "estimate": None, "watch": Pickled(self.watched)}

    @cached_property
    def energy(self) -> np.ndarray | None:
        """T + V, n [J]; None where it is not given."""
        return None if self.energies is None else self.energies()

    @cached_property
    def kept(self) -> Kept:
        """Errors of energy and constraints."""
        return self.measure()

    @property
    def drift(self) -> float | None:
        """Drift of the energy, as of `Kept`; None where energy need not be constant."""
        return self.kept.drift

    @property
    def gap(self) -> float | None:
        """Largest gap of the constraints, as of `Kept`; None where none closes."""
        return self.kept.gap

    @property
    def gap_rate(self) -> float | None:
        """Largest gap rate of the constraints, as of `Kept`; None where none closes."""
        return self.kept.gap_rate

    @cached_property
    def remark(self) -> str:
        """Text that names the missing reactions and outputs, and the reason; or ""."""
        return " ".join(filter(None, (self.reported, self.gaps())))

    def thinned(self, instants: np.ndarray | None, **more: Any) -> Trajectory:
        """The motion with one row an instant; one that ended early keeps its last row.

        Args:
            instants: no others have a row; None: those at which phases change have one too.
            more: fields that are replaced in the trajectory.

        Where one phase ends and another begins the row is the state after; both are in the phases, `last` and `first`.
        """
        if not len(self.t):
            return replace(self, **more)
        kept = np.ones(len(self.t), dtype=bool)
        kept[:-1] = self.t[1:] > self.t[:-1]
        if instants is not None and not np.array_equal(self.t, instants):
            kept &= np.isin(self.t, instants)
            kept[-1] |= self.ended != "finished"
        all_kept = bool(kept.all())
        before = range(len(kept) + 1) if all_kept else [0, *np.cumsum(kept).tolist()]
        columns = cache(self.columns)

        def of(phase: Phase) -> Phase:
            begin, end = phase.rows

            def edges() -> tuple[dict[str, float], dict[str, float]]:
                first, last = ({n: float(c[i]) for n, c in columns().items()} for i in (begin, end - 1))
                return first, last

            found: Phase = with_fields(phase, rows=(before[begin], before[end]), edges=edges if end > begin else None)
            return found

        more["phases"] = tuple(map(of, self.phases))
        if all_kept:
            whole: Trajectory = with_fields(self, **more)
            return whole
        reactions, outputs = (_at_rows(table, kept) for table in (self.reactions, self.outputs))
        energies = None if self.energies is None else lambda: self["energy"][kept]
        more |= {"t": self.t[kept], "x": self.x[kept], "energies": energies, "reactions": reactions, "outputs": outputs}
        return replace(self, **more)

    @property
    def known_remark(self) -> str:
        """The remark, without what it says of reactions that still wait to be read."""
        return self.reported if isinstance(self.reactions, OnDemand) else self.remark

    @cached_property
    def accuracy(self) -> Any:
        """Its `Accuracy`: the correct digits at the end, by a run with finer tolerances; None where none compares.

        Raises:
            UsageError: as of `certify`.
        """
        if self.estimate is None:
            raise UsageError(self.NO_EQUATIONS, fix="take eomgen.simulate(model), in the process that needs it")
        return self.estimate(self)

    def certify(self) -> Any:
        """The Certificate of the run: its equations, the code that ran, its steps, energy, constraints and reactions.

        Raises:
            UsageError: it was integrated without the equations of a model.
        """
        if self.proof is None:
            raise UsageError(self.NO_EQUATIONS, fix="take eomgen.simulate(model), in the process that needs it")
        return self.proof(self)

    def ask(self, text: Any) -> Any:
        """Value over the whole run: "max(reaction_x(A))", "mean(power())", "theta' at theta = 0, event 2".

        A RunValue, also of an Output: value in SI, the instants t at which it is, the message where there is none.

        Raises:
            UsageError: it cannot be read; or the run is of no model.
        """
        if self.whole is None:
            raise UsageError(self.NO_EQUATIONS, fix="take eomgen.simulate(model), in the process that needs it")
        return self.whole(text)

    def plot(self, path: str | Path | None = None, view: str = "time") -> Any:
        """A picture of the run, shown in a notebook; written where a path is given.

        Args:
            path: .png, .svg or .pdf.
            view: "time", "phase" (rates over coordinates), "resultants" (sizes of forces), "polar" (forces of hinges).
        Raises:
            UsageError: another ending or view.
            RunFailed: the run has nothing of the kind.
        """
        picture = import_module("eomgen").run_picture(
            self, view
        )  # the package's front door: pictures are a later room's
        if path is not None:
            picture.save(path)
        return picture

    @property
    def picture(self) -> Any:
        """Its curves over time: shows itself in a notebook."""
        return self.plot()

    @cached_property
    def watched(self) -> tuple[Any, ...]:
        """Checks of what a run watches anyway, made when `status` is read."""
        return () if self.watch is None else self.watch(self)

    @property
    def contradiction(self) -> str:
        """First failed check of energy, constraints or norms in a run that reached its end, in words; "" if none."""
        if self.ended not in ("finished", "event"):
            return ""
        return next((f"{check.name}: {check.detail}" for check in self.watched if check.ok is False), "")

    @property
    def status(self) -> RunStatus:
        """Status of the run: "finished", "event", what stopped it; "contradicted" if a check of the run fails."""
        return "contradicted" if self.contradiction else self.ended

    @property
    def message(self) -> str:
        """The same as a sentence."""
        why = self.contradiction
        return f"{self.words} It contradicts what it watches ({why}): do not trust it." if why else self.words

    @property
    def ok(self) -> bool:
        """True where the end was reached, or the condition that was to end it, and nothing that is watched says no."""
        return self.status in ("finished", "event")

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, name: str) -> np.ndarray:
        """The column of a coordinate, speed or state, of "t", "energy", a reaction ("reaction_x(B)") or an output."""
        columns = self.columns()
        if name not in columns:
            raise KeyError(f"no column '{name}'; there are {', '.join(columns)}")
        return columns[name]

    def columns(self) -> dict[str, np.ndarray]:
        """Every column by name: t, what moves, energy, reactions, outputs ("theta (output)" next to theta)."""
        named = {"t": self.t} | dict(zip(self.moving, self.x.T, strict=True))
        named |= ({} if self.energy is None else {"energy": self.energy}) | dict(self.reactions)
        return named | {f"{name}{OUTPUT}" if name in named else name: y for name, y in self.outputs.items()}

    def to_csv(
        self,
        path: str | Path | IO[str],
        units: Mapping[str, Unit] | None = None,
        heads: Mapping[str, str] | None = None,
    ) -> None:
        """A header line and one line an instant.

        Args:
            units: of the columns, "theta [deg]"; None: plain names, and SI.
            heads: what stands in the place of names.
        Raises:
            WriteFailed: the file cannot be written; the old file is then unchanged.
        """
        import csv

        columns = self.columns()
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        reported = dict[str, Unit]() if units is None else units
        known = {name: (heads or {}).get(name, name) for name in columns}
        writer.writerow(f"{head} [{reported[name]}]" if name in reported else head for name, head in known.items())
        given = (x / reported[name].size if name in reported else x for name, x in columns.items())
        writer.writerows(zip(*(column.tolist() for column in given), strict=True))
        if isinstance(path, (str, Path)):
            files.write(path, text.getvalue())
        else:
            path.write(text.getvalue())

    def to_npz(self, path: str | Path) -> None:
        """numpy's archive: t, x, names in x, energy, reactions, outputs (n x names) and their names, status.

        Raises:
            WriteFailed: the file cannot be written; the old file is then unchanged.
        """
        arrays: dict[str, Any] = {"t": self.t, "x": self.x, "status": self.status, "message": self.message}
        arrays |= {"coordinates": np.array(self.coordinates, dtype=str), "speeds": np.array(self.speeds, dtype=str)}
        if self.states:
            arrays["states"] = np.array(self.states, dtype=str)
        if self.energy is not None:
            arrays["energy"] = self.energy
        for what, table in (("reaction", self.reactions), ("output", self.outputs)):
            if table:
                arrays[f"{what}s"] = np.column_stack(list(table.values()))
                arrays[f"{what}_names"] = np.array(list(table), dtype=str)
        files.write(path, lambda file: np.savez_compressed(file, **arrays))

    def to_pandas(self) -> Any:
        """The columns as a DataFrame over t (needs pandas)."""
        import pandas

        columns = self.columns()
        times = columns.pop("t")
        return pandas.DataFrame(columns, index=pandas.Index(times, name="t"))

    def to_xarray(self) -> Any:
        """The columns as a Dataset over time (needs xarray)."""
        import xarray

        columns = self.columns()
        times = columns.pop("t")
        reported = {"status": self.status, "message": self.message}
        return xarray.Dataset(
            {name: ("time", x) for name, x in columns.items()}, coords={"time": times}, attrs=reported
        )

    def animate(self, path: str | Path | None = None, **how: Any) -> Any:
        """The motion as a moving picture: .gif, .mp4, .png (a strip), .html; without a path its player shows itself.

        Args:
            how: options fps, speed, trail, forces, frames, as of `eomgen animate`.
        """
        return import_module("eomgen").animate(self, path, **how)  # the package's front door: pictures come later

    def summary(self) -> str:
        """Summary of the run in a line or two."""
        parts = [f"{self.message} {self.steps} steps, {self.evaluations} evaluations."]
        if self.carried:
            parts.append(f"Carried across {_singular_positions(self.carried)}.")
        if len(self.phases) > 1:
            parts.append(f"{len(self.phases)} phases.")
        if self.drift is not None:
            parts.append(f"Energy drift {_size(self.drift)} of the energy that moves.")
        if self.gap is not None:
            speed = "" if self.gap_rate is None else f", their velocities by {_size(self.gap_rate)}"
            parts.append(f"Constraints open by at most {_size(self.gap)}{speed}.")
        return " ".join(parts if self.reactions or self.outputs or not self.remark else [*parts, self.remark])

    @property
    def still(self) -> str:
        """Sentence that the start is an equilibrium, with what to do; "" where something moves."""
        if len(self.t) < 2 or not self.coordinates or np.max(np.abs(self.x - self.x[0])) > tolerances.SOLVED:
            return ""
        near = f"--start {self.coordinates[0]}=..."
        return f"From this start nothing moves: it is an equilibrium. Start near it ({near}), or with a speed."

    def __repr__(self) -> str:
        names = ", ".join(self.moving)
        names = names if len(names) < SHOWN else f"{len(self.coordinates)} coordinates, {len(self.speeds)} speeds"
        return f"<trajectory of {names}: {len(self.t)} instants. {self.summary()}>"

    def _repr_html_(self) -> str:
        import html

        shown: list[int] = sorted({round(i * (len(self.t) - 1) / 5) for i in range(6)}) if len(self.t) else []
        columns = self.columns()
        head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
        rows = ("".join(f"<td>{column[i]:.6g}</td>" for column in columns.values()) for i in shown)
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        return f"<p>{html.escape(self.summary())}</p><table><tr>{head}</tr>{body}</table>"


def _size(x: float) -> str:
    """2.5e-15; a bare 0 where nothing is left of it."""
    return f"{x:.1e}" if x else "0"


def _singular_positions(carried: Sequence[tuple[float, float]]) -> str:
    """ "a singular position at t = 0.7 s", or how many, and when the first."""
    first = f"{sum(carried[0]) / 2:.6g} s"
    many = len(carried)
    return f"a singular position at t = {first}" if many == 1 else f"{many} singular positions, first at t = {first}"


def _at_rows(table: Mapping[str, np.ndarray], kept: np.ndarray) -> Mapping[str, np.ndarray]:
    """The columns at these rows; columns computed on demand stay so."""

    def found() -> dict[str, np.ndarray]:
        return {name: column[kept] for name, column in table.items()}

    return OnDemand(tuple(table), found) if isinstance(table, OnDemand) else found()
