"""Reported texts of a run -> checks: names, units, starts and ends, tables and files are those of its states.

A reported text is read as it stands, "theta1 [deg]", "-1.27834046", a line of a file, and compared with the state of
its name; a column has the right name if it is the integral of the column that is its rate.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.model import FUNCTIONS, OUTPUT, Model, Unit
from eomgen.proof.at_a_state import NumericState, off_by
from eomgen.proof.check import Check, Tally, checked, differing
from eomgen.proof.emitted_code import WORK
from eomgen.proof.instant import second_definition
from eomgen.simulation import Phase, Trajectory
from eomgen.symbolic.expression import Expression, Fraction, Scalar, order
from eomgen.symbolic.numeric import NoValue, tolerances

NAME, HOW = "reported values of the run are those of its states", "states by their names, texts read back"
ROWS = 3  # of a file or table that are looked at: its first, middle and last
FINE = 50  # instants that show how a coordinate goes between them
_DOTS = re.compile(r"\\(dot)\{((?:[^{}]|\{[^{}]*\})*)\}")
_HEAD = re.compile(r"(?P<name>.*?)(?: \[(?P<unit>[^\]]*)\])?")


def _plain(letters: str) -> str:
    r"""The letters and digits of a name, or of its LaTeX: those of \varphi are phi."""
    return re.sub(r"\\(?:var|mathrm|mathit|operatorname)?|[^A-Za-z0-9]", "", letters)


@dataclass(frozen=True)
class ReportedRun:
    """Reported texts of a run.

    Args:
        rows: (name with its unit, the start, the end) as texts.
        whole: (name with its unit, value or why there is none, "t = 1 s" or "").
        entries: for machines.
        table: of a file: its heads, and lines of texts.
    """

    rows: Sequence[Sequence[str]] = ()
    whole: Sequence[Sequence[str]] = ()
    entries: Mapping[str, Any] = field(default_factory=dict)
    table: tuple[Sequence[str], Sequence[Sequence[str]]] | None = None


def run_reported(run: Trajectory, model: Model, reported: ReportedRun) -> Iterator[Check]:
    """Checks of all reported texts of a run against its states."""
    return _RunReported(run, model, reported).checks()


@dataclass(frozen=True)
class _RunReported:
    run: Trajectory
    model: Model
    reported: ReportedRun

    def checks(self) -> Iterator[Check]:
        tally = Tally(NAME, HOW)
        for head, *texts in self.reported.rows:
            tally.add(head, partial(self._ends, head, texts))
        tally.add("the reported columns", self._complete)
        for name in self.run.coordinates:
            if f"{name}'" in self.own and len(self.run.t) > FINE:
                tally.add(f"{name}'", partial(self._is_rate, name))
        if self.reported.table is not None:
            for k, head in enumerate(self.reported.table[0]):
                tally.add(f"column {head}", partial(self._column, head, [row[k] for row in self.reported.table[1]]))
        for what, wrong in self._of_entries():
            tally.add(what, wrong)
        if self.run.energy is not None and len(self.run.t):
            tally.add("energy", self._energy)
        return tally.checks()

    @cached_property
    def own(self) -> dict[str, np.ndarray]:
        """Columns of the run by their names."""
        found = {"t": self.run.t}
        for k, name in enumerate(self.run.moving):
            found[name] = self.run.x[:, k]
        if self.run.energy is not None:
            found["energy"] = self.run.energy
        found.update(self.run.reactions)
        for name, column in self.run.outputs.items():
            found[name + (OUTPUT if name in found else "")] = column
        return found

    def _of_head(self, head: str) -> tuple[str, float]:
        """(name, size of its unit), where that is a unit that it can have."""
        match = _HEAD.fullmatch(head)
        assert match is not None
        name = match["name"]
        if name.startswith("$"):
            letters, dots = _DOTS.subn(r"\2", name.strip("$"))
            name = self._by_letters(letters) + "'" * dots
        if name not in self.own:
            raise NoValue(f"'{match['name']}' is no column of the run")
        unit = match["unit"]
        if unit is None:
            return name, 1.0
        wanted = self._unit(name)
        if wanted is not None and Unit.parse(wanted).dimension != Unit.parse(unit).dimension:
            raise _Unlike(f"[{unit}] for [{wanted}]")
        return name, Unit.parse(unit).size

    def _by_letters(self, tex: str) -> str:
        """The name for which the model declares a symbol, else that of the same letters."""
        tables = (self.model.coordinates, self.model.speeds, self.model.states, self.model.outputs)
        declared = {x.symbol.tex: name for table in tables for name, x in table.items() if x.symbol is not None}
        alike = {_plain(name): name for name in self.own if not name.endswith("'")}
        return declared.get(tex) or alike.get(_plain(tex), tex)

    def _unit(self, name: str) -> str | None:
        """Unit of a column by the kind of its quantity."""
        if name in ("t", "energy"):
            return {"t": "s", "energy": "J"}[name]
        if name.startswith("drive("):  # J by the unit of its coordinate, which may be inferred alone
            return None
        if name in self.run.units:
            return self.run.units[name]
        tables = ((self.run.coordinates, self.model.coordinates), (self.run.states, self.model.states))
        part = next((table.get(name) for names, table in tables if name in names), None)
        return None if part is None or part.unit is None else part.unit.text

    def _ends(self, head: str, texts: Sequence[str]) -> str:
        try:
            name, size = self._of_head(head)
        except _Unlike as error:
            return str(error)
        column = self.own[name]
        for place, text in zip((0, -1), texts, strict=True):
            if wrong := _apart(float(text) * size, float(column[place]), tolerances.NINE_DIGITS):
                return f"{('start', 'end')[place]}: {wrong}"
        return ""

    def _complete(self) -> str:
        """Message if a column is left out, or reported twice; ""."""
        named = [match["name"] for head, *_ in self.reported.rows if (match := _HEAD.fullmatch(head))]
        if len(self.run.t) and sorted(named) != sorted(self.own):
            return ", ".join(set(self.own).symmetric_difference(named)) or "one is reported twice"
        return ""

    def _column(self, head: str, texts: Sequence[str]) -> str:
        try:
            name, size = self._of_head(head)
        except NoValue as error:
            return str(error)
        except _Unlike as error:
            return str(error)
        column = self.own[name]
        if len(texts) != len(column):
            return f"{len(texts)} lines for {len(column)} instants"
        places = dict.fromkeys(np.linspace(0, len(column) - 1, ROWS).astype(int).tolist()) if len(column) else ()
        found = (_apart(float(texts[k]) * size, float(column[k]), tolerances.COMPUTED) for k in places)
        return next(filter(None, found), "")

    def _is_rate(self, name: str) -> str:
        """The steps of a coordinate are the means of its rate, to second order; jumps of the rate are a few."""
        q, u, h = self.own[name], self.own[f"{name}'"], np.diff(self.run.t)
        apart = np.abs(np.diff(q) - h * (u[1:] + u[:-1]) / 2)
        allowed = (
            h * np.abs(np.diff(u)) + h * _usual_change(u) + tolerances.COMPUTED * (1 + np.max(np.abs(q), initial=0.0))
        )
        wrong = np.isfinite(apart) & (apart > allowed)
        return f"it is not the rate of {name}" if np.sum(wrong) > len(h) / 2 else ""

    def _energy(self) -> str:
        """T + V in the middle of a phase."""
        for phase in self.run.phases:
            row = sum(phase.rows) // 2
            if phase.model is None or phase.track is None or phase.rows[1] - phase.rows[0] < ROWS:
                continue
            state = state_of_row(self.run, phase, row)
            T, V = (state.number(x) for x in (phase.model.equations.T, phase.model.equations.V))
            found = float(self.own["energy"][row])
            if abs(found - T - V) > tolerances.COMPUTED * (1 + abs(T) + abs(V)):
                return f"{found:.10g} for {T + V:.10g} at t = {self.run.t[row]:.6g} s"
            return ""
        raise NoValue("no phase is long enough")

    def _of_entries(self) -> Iterator[tuple[str, Callable[[], str]]]:
        reported, own = self.reported.entries, self.own
        for key, place in (("start", 0), ("end", -1)):
            for name, x in reported.get(key, {}).items():
                yield f"{key} of {name}", partial(self._entry, name, [x], [place])
        for name, column in reported.get("trajectory", {}).items():
            places = [0, len(column) // 2, -1] if len(column) else []
            yield f"trajectory of {name}", partial(self._entry, name, [column[k] for k in places], places)
        if reported and len(self.run.t):
            yield "time", lambda: _apart(reported["time"], self.run.phases[-1].end, tolerances.COMPUTED)
            yield "energy drift", lambda: _none_apart(reported["energy_drift"], self.run.drift)
            yield "gap", lambda: _none_apart(reported["gap"], self.run.gap)
            yield "gap rate", lambda: _none_apart(reported["gap_rate"], self.run.gap_rate)
        for name, value in reported.get("quantities", {}).items():
            yield f"{name} for machines", partial(self._quantity, name, value)
        for name in self.run.quantities if self.reported.whole or reported else ():
            rows = [row for row in self.reported.whole if (m := _HEAD.fullmatch(row[0])) and m["name"] == name]
            yield f"{name} of the run", partial(self._rows_of, name, rows)
        if reported and len(reported.get("trajectory", own)) != len(own):
            yield "trajectory", lambda: f"{len(reported['trajectory'])} columns for {len(own)}"

    def _entry(self, name: str, values: Sequence[float | None], places: Sequence[int]) -> str:
        if name not in self.own:
            return "there is no such column"
        return next(filter(None, (_none_apart(x, self.own[name][k]) for x, k in zip(values, places, strict=True))), "")

    def _quantity(self, name: str, reported: Mapping[str, Any]) -> str:
        found = self.run.quantities[name]
        size = Unit.parse(reported["unit"]).size if reported["unit"] else 1.0
        values = reported["value"] if isinstance(reported["value"], list) else [reported["value"]]
        rights = found.value if isinstance(found.value, tuple) else (found.value,)
        if len(values) != len(rights) or len(reported["t"]) != len(found.t):
            return "another number of values"
        pairs = [*zip(values, rights, strict=True)]
        wrong = [_none_apart(None if x is None else x * size, right) for x, right in pairs]
        wrong += [_apart(x, right, tolerances.COMPUTED) for x, right in zip(reported["t"], found.t, strict=True)]
        return next(filter(None, wrong), "")

    def _rows_of(self, name: str, rows: Sequence[Sequence[str]]) -> str:
        """A row for each value, under its unit, at its instant."""
        found = self.run.quantities[name]
        rights = found.value if isinstance(found.value, tuple) else (found.value,)
        if len(rows) != len(rights):
            return f"{len(rows)} rows for {len(rights)}"
        for k, ((head, text, when), right) in enumerate(zip(rows, rights, strict=True)):
            unit = _HEAD.fullmatch(head)
            size = Unit.parse(unit["unit"]).size if unit is not None and unit["unit"] else 1.0
            wrong = "" if right is None else _apart(float(text) * size, right, tolerances.NINE_DIGITS)
            if right is not None and k < len(found.t):
                instant = re.fullmatch(r"t = (.*) s", when)
                wrong = wrong or (
                    "no instant" if instant is None else _apart(float(instant[1]), found.t[k], tolerances.NINE_DIGITS)
                )
            if wrong:
                return wrong
        return ""


class _Unlike(Exception):
    """A unit of another dimension."""


def _usual_change(u: np.ndarray) -> float:
    return float(np.nanmedian(np.abs(np.diff(u)))) if len(u) > 1 else 0.0


def _apart(found: float, right: float, share: float) -> str:
    if np.isnan(found) and np.isnan(right):
        return ""
    if np.isnan(found) or np.isnan(right):
        return f"{found} for {right}"
    return "" if np.isinf(found) and found == right else differing(found, right, share)


def _none_apart(found: float | None, right: float | None) -> str:
    """Difference of two values that may be missing, in words; null stands for a value that is not finite."""
    if right is None or not np.isfinite(right):
        return "" if found is None else f"{found:.10g} for none"
    return f"nothing for {right:.10g}" if found is None else _apart(found, float(right), tolerances.COMPUTED)


# -------- run columns -----------------------------------------------------------------------------------------
# A run -> checks: its columns of reactions and outputs are those of free bodies, formulas and second definitions.


COLUMN_ROWS, EXACTLY = "a run has a row at every requested instant", "floating point"
MOST = 4  # phases that are looked at, each in its middle


def rows_left_out(run: Trajectory, instants: np.ndarray | None) -> Iterator[Check]:
    """A failing check where a requested instant, which the run passed, has no row, or rows do not ascend; else none.

    Args:
        instants: requested instants; None: the run's own.
    """
    if instants is None or not len(run.t):
        return
    end = run.phases[-1].end if run.status == "finished" and run.phases else run.t[-1]
    passed = instants[instants <= end]
    missing = passed[~np.isin(passed, run.t)]
    if len(missing):
        yield checked(COLUMN_ROWS, f"none at t = {missing[0]:.6g} s", EXACTLY)
    elif (np.diff(run.t) <= 0).any():
        yield checked(COLUMN_ROWS, "they do not go on in time", EXACTLY)


def _middles(run: Trajectory) -> Iterator[tuple[Phase, int]]:
    """(phase, its middle row) of some phases spread over the run."""
    for phase in run.phases[:: max(1, len(run.phases) // MOST)]:
        first, last = phase.rows
        if phase.model is not None and phase.track is not None and last - first >= 3:
            yield phase, (first + last) // 2


def reaction_columns_hold(run: Trajectory) -> Iterator[Check]:
    """A(q) rho = b solved by rank in doubles, against its solution in symbols with 50 digits; () where none reacts.

    Both share A and b, which the equilibrium of every body proves at other states.
    """
    tally = Tally("columns of reactions are those of the free bodies", "symbols with 50 digits")
    work = 0
    if not run.reactions:
        return iter(())
    for phase, row in _middles(run):
        formulas = phase.model.reactions.determinate()
        work += len(order(tuple(formulas.values())))
        if work > WORK:
            tally.left[f"from {phase.start:.6g} s"] = "its formulas are too long to be evaluated with 50 digits"
            continue
        tally.add(f"t = {run.t[row]:.6g} s", partial(_wrong_reaction, run, phase, row, formulas))
    return tally.checks()


def _wrong_reaction(run: Trajectory, phase: Phase, row: int, formulas: Mapping[str, Scalar]) -> str:
    """Message that names a column whose value in a row differs from that of the symbols; ""."""
    state = state_of_row(run, phase, row)
    columns = {name: float(run.reactions[name][row]) for name in formulas if name in run.reactions}
    known = {name: x for name, x in columns.items() if np.isfinite(x)}
    if not known:
        raise NoValue("no reaction has a single value there")
    size = max(map(abs, known.values()))
    for name, found in known.items():
        right = state.number(formulas[name])
        if abs(found - right) > tolerances.COMPUTED * (1 + size):
            wrong = off_by(found, right, [near.number(formulas[name]) for near in state.nearby()])
            if wrong:
                return f"{name}: {wrong}"
    return ""


def state_of_row(run: Trajectory, phase: Phase, row: int) -> NumericState:
    """The state of a row, in the coordinates and speeds of its phase."""
    assert phase.track is not None
    t, x = phase.track
    equations = phase.model.equations
    symbols, here = equations.symbols, x[int(np.argmin(np.abs(t - run.t[row])))]
    parameters = {
        node: Fraction(float(value)) for node, value in zip(symbols.parameters.values(), phase.model.p, strict=True)
    }
    numbers = {node: float(value) for node, value in zip(symbols.x, here, strict=False)}
    return NumericState(equations, parameters, {symbols.t: float(run.t[row]), **numbers})


def output_columns_hold(run: Trajectory, formulas: Mapping[str, Expression]) -> Iterator[Check]:
    """Compiled programs over all rows, against the formulas with 50 digits and the second definitions at single rows.

    Accelerations come from dense equations with 50 digits, functions of motion from differences of poses and from
    particles.
    """
    values = Tally("columns of outputs are those of the formulas", "50 digits, reactions in doubles")
    meanings = Tally("functions of the motion hold by their second definitions", "differences of poses, particles")
    for phase, row in _middles(run):
        if phase.model.declared is not phase.model.system:
            continue
        state = state_of_row(run, phase, row)
        for name in run.outputs:
            found, when = float(run.outputs[name][row]), f"{name} at t = {run.t[row]:.6g} s"
            if not np.isfinite(found):
                continue
            values.add(when, partial(_wrong_output, state, found, formulas[name]))
            for call in formulas[name].calls:
                if FUNCTIONS[call.name].second is not None:
                    meanings.add(f"{call} at t = {run.t[row]:.6g} s", partial(second_definition, state, call))
    return iter((*values.checks(), *meanings.checks()))


def _wrong_output(state: NumericState, found: float, formula: Expression) -> str:
    right = state.value_of(formula)
    if not differing(found, right):
        return ""
    return off_by(found, right, [near.value_of(formula) for near in state.nearby()])
