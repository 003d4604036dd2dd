"""PlayedRun, its page -> checks: read again the page holds the run, its parameters and sliders, and draws the model."""

from __future__ import annotations

import json
import re
from base64 import b64decode
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from eomgen.codegen.rhs import compiled
from eomgen.model.contacts import contacts_of, pieces_of
from eomgen.page.player_data import PlayedRun
from eomgen.proof.at_a_state import NumericState
from eomgen.proof.check import Check, Tally, differing
from eomgen.proof.pictures_told import picture_of_page, pictures_told, states_shown
from eomgen.proof.reports_read import columns_unpacked, unpacked
from eomgen.symbolic.expression.units import parse_unit
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, SEVEN_DIGITS

NAME, HOW = "what the page is told, read back, is the run and what the model declares", "its columns and numbers"
_PACKED = re.compile(r'atob\("([A-Za-z0-9+/=]+)"\)')
_BEGUN = "begun(document.getElementById("


def player_told(page: str) -> Mapping[str, Any]:
    """What the player in a page is told.

    Raises:
        ValueError: there is none.
    """
    packed = _PACKED.search(page)
    text = page if packed is None else unpacked(packed[1]).decode()
    begin = text.index("{", text.index(_BEGUN))
    found: Mapping[str, Any] = json.JSONDecoder().raw_decode(text[begin:])[0]
    return found


def player_read_back(played: PlayedRun, page: str) -> Iterator[Check]:
    """Whether a page holds the run that it plays, and draws its model."""
    told, tally = player_told(page), Tally(NAME, HOW)
    for what, wrong in _compared(played, told):
        tally.add(what, wrong)
    yield from tally.checks()
    if not played.changes:
        yield from pictures_told(
            (state, picture_of_page(told["scene"], _slots(played, state)))
            for _, state in states_shown(played.run, played.run.t)
        )


def _named_otherwise(played: PlayedRun, columns: Mapping[str, Any]) -> str:
    """Which number of the motion is another than the run's of that name, in its middle; "".

    Args:
        columns: ("x", place) in the state, ("frame", place) in what the page's program of the frame gives.
    """
    run, live = played.run, played.live
    if live is None or not len(run.t) or played.phase.system.inputs:
        raise NoValue("it does not move by itself")
    k, names = len(run.t) // 2, (*live.phase.coordinates, *live.phase.speeds)
    own = {name: run.x[:, j] for j, name in enumerate((*run.coordinates, *run.speeds))} | dict(run.reactions)
    x = [float(own[name][k]) for name in names]
    frame = compiled(live.programs["frame"], "numpy")(float(run.t[k]), x, played.phase.p, ())
    numbers: dict[str, Sequence[float]] = {"x": x, "frame": frame.tolist()}
    if beyond := [name for name, (where, place) in columns.items() if place >= len(numbers[where])]:
        return f"there is no number of {beyond[0]}"
    found = {name: float(numbers[where][place]) for name, (where, place) in columns.items()}
    pairs = [(name, found[name], float(column[k])) for name, column in own.items() if name in found]
    if run.energy is not None:
        pairs.append(("T + V", found["T"] + found["V"], float(run.energy[k])))
    size = 1 + max((abs(right) for _, _, right in pairs if np.isfinite(right)), default=0.0)
    wrong = (f"{name} is {x:.9g} for {y:.9g}" for name, x, y in pairs if abs(x - y) > SEVEN_DIGITS * size)
    return next(wrong, "")


def _slots(played: PlayedRun, state: NumericState) -> list[float]:
    """The numbers of a frame."""
    try:
        unknowns = state.unknowns
    except NoValue:  # then what hangs on accelerations is not compared
        unknowns = {}
    known = {**dict.fromkeys((*state.equations.symbols.a, *state.equations.symbols.lam), np.nan), **unknowns}
    return [float(x) for x in evaluate(played.scene.values, state.values | known, fifty_digits(partial=True))]


def _compared(played: PlayedRun, told: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    run = played.run
    yield "time", partial(differing, told["time"], run.phases[-1].end)
    names = [*run.coordinates, *run.speeds]
    yield "what moves it", partial(_otherwise_moved, played, told)
    yield "names", lambda: "" if list(told["names"]) == names else ", ".join(told["names"])
    yield "instants", partial(_other_column, told["run"]["t"], [run.t])
    yield "states", partial(_other_column, told["run"]["x"], list(_states(played).T))
    if told.get("live") and {*played.phase.coordinates, *played.phase.speeds} <= {*names}:
        yield "numbers by their names", partial(_named_otherwise, played, told["live"]["columns"])
    model, p = played.model, dict(zip(played.phase.declared.symbols.parameters, played.phase.p, strict=True))
    for each in told["parameters"]:
        yield f"parameter {each['name']}", partial(_other_value, each, p.get(each["name"]))
    first = dict(zip(names, run.x[0].tolist(), strict=True))
    for each in told["sliders"]:
        yield f"slider {each['name']}", partial(_other_slider, each, p | first)
    parts = {**model.parameters, **model.coordinates}
    plotted = [each for each in told["plotted"] if each["name"] in model.coordinates]
    for each in (*told["sliders"], *plotted):
        unit = getattr(parts.get(each["name"]), "unit", None)
        declared = "" if unit is None else unit.text
        yield f"unit of {each['name']}", partial(_other_unit, each, declared)


def _otherwise_moved(played: PlayedRun, told: Mapping[str, Any]) -> str:
    """Whether a page says that contacts change where none is declared, or moves by itself where they do."""
    model, asked = played.model, played.options.moves
    could = bool(contacts_of(model)) or any(len(pieces_of(body)) > 1 for body in model.bodies.values())
    if asked and "contacts" in told["rests"] and not could:
        return "it says that contacts change, and none is declared"
    alone = len(played.run.phases) == 1
    return "" if alone or not told["moves"] else "it moves by itself, and the run has several phases"


def _states(played: PlayedRun) -> np.ndarray:
    """As they are integrated; of contacts that change as they are named."""
    if played.changes or played.run.phases[0].track is None:
        return played.run.x
    t, x = played.run.phases[0].track
    return np.array([x[int(np.argmin(np.abs(t - each)))] for each in played.run.t])


def _other_column(told: Mapping[str, Any], right: list[np.ndarray]) -> str:
    found = list(columns_unpacked(told, b64decode(told["content"])))
    if len(found) != len(right):
        return f"{len(found)} columns for {len(right)}"
    for k, (a, b) in enumerate(zip(found, right, strict=True)):
        size = float(np.max(np.abs(b), where=np.isfinite(b), initial=0.0))
        if len(a) != len(b) or not np.allclose(a, b, 0, SEVEN_DIGITS * size, equal_nan=True):
            return f"column {k + 1}"
    return ""


def _other_value(each: Mapping[str, Any], right: float | None) -> str:
    return "there is no such one" if right is None else differing(each["value"], float(right))


def _other_slider(each: Mapping[str, Any], known: Mapping[str, float]) -> str:
    if not each["min"] - COMPUTED <= each["value"] <= each["max"] + COMPUTED or each["min"] == each["max"]:
        return f"{each['value']:.6g} is not between {each['min']:.6g} and {each['max']:.6g}"
    return _other_value(each, known.get(each["name"]))


def _other_unit(each: Mapping[str, Any], declared: str) -> str:
    if each["unit"] != ("" if declared == "1" else declared) and declared:
        return f"[{each['unit']}] for [{declared}]"
    size = parse_unit(each["unit"]).size if each["unit"] else 1.0
    return differing(float(each["size"]), float(size))
