"""Trajectory -> its player: data, page, and the page read back."""

from __future__ import annotations

import base64
import html
import json
import re
from base64 import b64decode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property, partial
from importlib import resources
from typing import Any, Protocol

import numpy as np

from eomgen.codegen import RightHandSide, TestVector, javascript_expression, vectors
from eomgen.documents import Catalogue, language_of, notation_of
from eomgen.errors import ToolMissing, UsageError, visible
from eomgen.frozen import dataclass
from eomgen.model import Model, Unit
from eomgen.page.live import Live, live_of, single_reactions
from eomgen.page.markup import in_a_script, mathml, packed
from eomgen.page.packing import packed_columns
from eomgen.page.reports_read import columns_unpacked, unpacked
from eomgen.proof import (
    Check,
    NumericState,
    Tally,
    differing,
    picture_of_page,
    pictures_reported,
    states_shown,
)
from eomgen.scene import Scene, VirtualDisplacement, force_marks, joined, phase_frames, resultants, scene_of_system
from eomgen.simulation import PhaseModel, Trajectory
from eomgen.study import Study
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances
from eomgen.version import __version__

# -------- player data -----------------------------------------------------------------------------------------
# Trajectory -> data of its player: scene, recorded run, units, sliders; programs by which the page moves it.


VECTORS = 3  # of each program in the page
CHECKED = (0.02, 0.05)  # of the time: where the page's own motion is held against the recorded one
MOST_CHECKED = 0.5  # s
STATES, DRAWN = 12, 7  # digits of the recorded states, and of what is only drawn
PLOTTED = 3  # coordinates, from the start
ROUND = 4.0  # m, rad: how far a start value that is 0 may be moved
SliderRange = tuple[float, float]


@dataclass(frozen=True)
class PlayerOptions:
    """Options of a player.

    Args:
        sliders: parameters and starts that have one, with its range in SI, or None: the default; () for all.
        moves: the model lives in the page, where it can; else the recorded run is played.
        trail: a point that leaves a trail from the start, "" for none.
        forces: arrows are shown from the start.
        speed: of the time.
        language: of the words in the page; "": that of the model.
    """

    sliders: Mapping[str, SliderRange | None] = field(default_factory=dict)
    moves: bool = False
    trail: str = ""
    forces: bool = False
    speed: float = 1.0
    language: str = ""


@dataclass(frozen=True)
class PlayedRun:
    """A run and its player's options."""

    run: Trajectory
    options: PlayerOptions

    @property
    def phase(self) -> PhaseModel:
        """The first phase, the only one of many runs."""
        found: PhaseModel = self.run.phases[0].model
        return found

    @property
    def model(self) -> Model:
        return self.phase.declared.scope.model

    @property
    def changes(self) -> bool:
        """True if contacts change in it, or could."""
        return self.phase.changes

    @cached_property
    def study(self) -> Study:
        """Study of the system of the first phase."""
        return Study(self.phase.system, replaced=self.phase.equations)

    @property
    def rests(self) -> str:
        """Why the sliders rest: the page cannot move the model by itself; "" where it can."""
        if self.changes:
            return "The contacts of this model change from phase to phase: the page plays the run as it was computed."
        if self.run.carried:
            return "This run crosses a singular position, which the page cannot: it plays the run as it was computed."
        return ""

    @cached_property
    def live(self) -> Live | None:
        """The model as the page evaluates it; None of contacts that change."""
        return None if self.changes else live_of(self.phase, self.study, self.scene)

    @cached_property
    def drawn(self) -> tuple[dict[str, Any], np.ndarray | None]:
        """(the scene as data, its numbers at the instants of the run where no program in the page gives them)."""
        if not self.changes:
            return self.scene.to_json(), None
        numbers = phase_frames(self.run, self.run.t)
        return numbers.scene.to_json(), numbers.frames

    @cached_property
    def scene(self) -> Scene:
        """Scene with reactions of a model whose contacts do not change."""
        scene = scene_of_system(self.study.system, self.study.derived)
        values = single_reactions(self.study)
        found = resultants(self.study.system, values)
        arrows = force_marks(self.study.system, ((resultant, resultant.of(values)) for resultant in found))
        return replace(scene, marks=(*scene.marks, *arrows))

    @property
    def computed(self) -> frozenset[str]:
        """The columns of the run that the page computes."""
        return frozenset() if self.live is None else frozenset((*self.live.columns, "t", "energy")) - {"T", "V"}

    @property
    def moves(self) -> bool:
        """True if the model lives in the page."""
        return self.options.moves and not self.rests

    @property
    def language(self) -> str:
        """Language of the words in the page; "" for that of the model."""
        return self.options.language

    def reported(self) -> dict[str, Any]:
        """Data of the player in the page, as JSON."""
        run, names = self.run, self.run.moving
        moves = self.moves
        columns = self.live.columns if self.live else {name: ("x", k) for k, name in enumerate(names)}
        plotted = [name for name in columns if not name.endswith("'") or name in names]
        units = self.model.units_of([*plotted, "energy"])
        energy = self.live is not None
        shown = [
            {"name": name, **_unit(units.get("energy" if name in ("T", "V", "E") else name))}
            for name in [*(("E",) if energy else ()), *plotted]
        ]
        return {
            "name": self.model.name,
            "time": float(run.phases[-1].end),
            "rtol": tolerances.CARRIED,
            "scene": self.drawn[0],
            "names": names,
            "columns": columns,
            "conservative": run.drift is not None,
            "energy": energy,
            "run": self._recorded(),
            "live": self.live.reported() if self.live else None,
            "moves": moves,
            "parameters": self._parameters(),
            "sliders": self._sliders() if self.options.moves else [],
            "rests": self.rests if self.options.moves else "",
            "plotted": shown,
            "signs": self._signs(plotted),
            "plots": [*run.coordinates[:PLOTTED], *(("E",) if energy and run.drift is None else ())],
            "vectors": {name: list(map(_vector, rows)) for name, rows in self.vectors.items()} if moves else {},
            "check": self._checked() if moves else [],
            "trail": self.options.trail,
            "forces": self.options.forces,
            "speed": self.options.speed,
        }

    def _signs(self, plotted: Sequence[str]) -> dict[str, str]:
        """The names as formulas have them, MathML."""
        names = dict.fromkeys((*self.run.moving, *self.model.parameters))
        notation = notation_of(self.model).reported_apart(names)
        return {name: mathml(notation.latex(name)) for name in names if name in plotted or self.options.moves}

    def _recorded(self) -> dict[str, Any]:
        """The run: states as they are integrated, or of contacts that change as they are named, with frames."""
        run = self.run
        reported = {"t": rows_reported(run.t[:, None]), "message": "" if run.ok else run.message}
        if self.live is not None:
            assert run.phases[0].track is not None
            times, states = run.phases[0].track
            x = states[np.searchsorted(times, run.t)]
            return {**reported, "x": rows_reported(x)}
        frames = self.drawn[1]
        assert frames is not None
        return {**reported, "x": rows_reported(run.x), "frames": rows_reported(frames, DRAWN)}

    def _parameters(self) -> list[dict[str, Any]]:
        names = self.phase.declared.symbols.parameters
        return [{"name": name, "value": float(value)} for name, value in zip(names, self.phase.p, strict=True)]

    @cached_property
    def vectors(self) -> dict[str, tuple[TestVector, ...]]:
        """Right answers of the programs that give the motion and the picture; {} where the page has none."""
        if self.live is None:
            return {}
        assert self.run.phases[0].track is not None
        x0, p0 = self.run.phases[0].track[1][0], self.phase.p
        programs = {name: self.live.programs[name] for name in ("rate", "frame")}
        return {name: vectors(program, x0=x0, p0=p0, count=VECTORS) for name, program in programs.items()}

    def _checked(self) -> list[float]:
        """Instants of the recorded run."""
        t = self.run.t
        wanted = [min(share * float(t[-1]), MOST_CHECKED) for share in CHECKED]
        return sorted({float(t[min(int(np.searchsorted(t, each)), len(t) - 1)]) for each in wanted if each > 0})

    # -- sliders -----------------------------------------------------------------------------------

    def _sliders(self) -> list[dict[str, Any]]:
        """Sliders of numeric parameters and free initial values; only the requested ones, if any are requested."""
        parts = self.model.parameters
        derived = self.live.derived if self.live else ()
        values = {
            name: (float(value), "parameter", getattr(parts[name], "about", None) or "")
            for name, value in zip(self.phase.declared.symbols.parameters, self.phase.p, strict=True)
            if name not in derived
        }
        first = dict(zip(self.run.moving, self.run.x[0].tolist(), strict=True))
        unit_quaternions = {e.name for four in self.phase.declared.scope.quaternions for e in four}
        for name, part in self.model.coordinates.items():
            if name in first and not part.driven and not part.dependent and name not in unit_quaternions:
                values[name] = (first[name], "coordinate", part.about or "")
        values |= {
            name: (first[name], "speed", "") for name in self.run.speeds if name.rstrip("'") not in unit_quaternions
        }
        values |= {name: (first[name], "speed", part.about or "") for name, part in self.model.states.items()}
        requested = self.options.sliders
        unknown = [name for name in requested if name not in values]
        if unknown:
            raise UsageError(f"there is no slider for '{unknown[0]}'", fix=f"there are {', '.join(values)}")
        units = self.model.units_of(values)
        chosen = {name: values[name] for name in requested} if requested else values
        return [
            self._slider(name, *reported, units.get(name), requested.get(name)) for name, reported in chosen.items()
        ]

    def _slider(
        self, name: str, value: float, kind: str, about: str, unit: Any, range_: SliderRange | None
    ) -> dict[str, Any]:
        low, high = range_ or _default_range(
            value, kind, angular=unit is not None and bool(unit.angle) and not unit.time
        )
        return {
            "name": name,
            "kind": kind,
            "value": value,
            "min": low,
            "max": high,
            "about": about,
            **_unit(unit),
        }


def _default_range(value: float, kind: str, *, angular: bool) -> SliderRange:
    """Default range of a slider: a fifth to three times of a parameter, a full turn of an angle."""
    if kind == "parameter" and value:
        return (0.2 * value, 3 * value) if value > 0 else (3 * value, 0.2 * value)
    if kind == "coordinate" and angular:
        return value - np.pi, value + np.pi
    reach = 2 * abs(value) or ROUND
    return value - reach, value + reach


def _vector(v: TestVector) -> dict[str, Any]:
    result = [value if value == value else None for value in v.result]
    return {
        "t": v.t,
        "x": v.x,
        "p": v.p,
        "inputs": v.inputs,
        "result": result,
        "tolerance": max(v.tolerance, tolerances.CARRIED),
    }


def _unit(unit: Any) -> dict[str, Any]:
    return {"unit": "" if unit is None else unit.text, "size": 1.0 if unit is None else float(unit.size)}


def rows_reported(rows: np.ndarray, digits: int = STATES) -> dict[str, Any]:
    """Numbers as a page reads them.

    Args:
        rows: n x columns.
        digits: of the largest of a column.
    """
    packed = packed_columns(rows.T, digits)
    return packed.head(content=base64.b64encode(packed.content).decode("ascii"))


# -------- player page -----------------------------------------------------------------------------------------
# PlayedRun -> its player as parts of a page, and as a page of its own, which loads nothing from elsewhere.


SCRIPTS = (
    "words.mjs",
    "columns.mjs",
    "integrator.mjs",
    "ties.mjs",
    "motion.mjs",
    "plane.mjs",
    "space.mjs",
    "player.mjs",
)
IN_SPACE = "space.mjs"
_LAID_OUT = re.compile(r"\n +")
SAID = re.compile(r'\bsay\("((?:[^"\\]|\\.)*)"')  # sentences of the scripts

_PAGE = """\
<!doctype html>
<html lang="{language}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="eomgen {version}">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<header><h1>{title}</h1><button type="button" id="theme">{theme}</button></header>
<main>{body}</main>
{script}
<script>
document.getElementById("theme").addEventListener("click", () => {{
    const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
}});
</script>
</body>
</html>
"""


_UNPACKED = """\
(async () => {{
    try {{
        const bytes = Uint8Array.from(atob("{packed}"), c => c.charCodeAt(0));
        const text = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
        new Function(text)();
    }} catch (error) {{
        document.getElementById("{identity}").textContent = `No motion in this browser: ${{error.message}}.`;
    }}
}})();"""
"""A program among other things of a page: packed, it takes half or less."""


@dataclass(frozen=True)
class PlayerParts:
    """Parts of a page that make up a player.

    Args:
        style: style sheet; colours are the page's own variables (`colours.css`).
        body: the element of the player.
        script: elements that come after the body.
    """

    style: str
    body: str
    script: str


class Playable(Protocol):
    """A motion that a player can show.

    Attributes:
        live: the model as the page evaluates it, or None: the computed run is played.
        moves: the model lives in the page.
        language: of its words; "": that of the model.
    """

    @property
    def model(self) -> Model: ...
    @property
    def language(self) -> str: ...
    @property
    def live(self) -> Live | None: ...
    @property
    def moves(self) -> bool: ...
    def reported(self) -> dict[str, Any]: ...


def player_page(run: Trajectory, options: PlayerOptions | None = None) -> str:
    """The player of a run as a page."""
    return player_page_of(PlayedRun(run, options or PlayerOptions()))


def player_page_of(played: Playable) -> str:
    """A player as a page."""
    words = language_of(played.model, played.language)
    parts = player_parts_of(played, "player", page=True)
    return _PAGE.format(
        version=__version__,
        language=words.language,
        theme=html.escape(words.say("light or dark")),
        title=html.escape(visible(played.model.name)),
        style=asset("colours.css") + asset("page.css") + parts.style,
        body=parts.body,
        script=parts.script,
    )


def player_parts_of(played: Playable, identity: str, *, page: bool = False) -> PlayerParts:
    """A player, to be put into a page, or alone in one."""
    library = {} if played.model.space == "plane" else {"three": three_js()}
    scripts = {name: asset(name) for name in SCRIPTS if library or name != IN_SPACE}
    said = _in_language(played.reported(), language_of(played.model, played.language), scripts.values())
    reported = json.dumps({**said, **library, "page": page}, separators=(",", ":"), allow_nan=False)
    for letter in "<>&\u2028\u2029":
        reported = reported.replace(letter, f"\\u{ord(letter):04x}")
    live = played.live
    needed = () if live is None else live.programs if played.moves else ("begin", "rate", "frame")
    programs = ",\n".join(f"{name}: {javascript_expression(live.programs[name])}" for name in needed) if live else ""
    programs = _LAID_OUT.sub("\n", programs)
    text = "\n".join(map(in_a_script, scripts.values()))
    begin = f'begun(document.getElementById("{identity}"), {reported}, {{{programs}}});'
    body = f'<div class="eomgen-player" id="{identity}"></div>'
    whole = f"(() => {{\n{_harmless(text)}\n{begin}\n}})();"
    if not page:
        whole = _UNPACKED.format(packed=packed(whole.encode()), identity=identity)
    return PlayerParts(asset("player.css"), body, f"<script>\n{whole}\n</script>")


def _in_language(reported: dict[str, Any], language: Catalogue, scripts: Iterable[str]) -> dict[str, Any]:
    """Data of a player with its words in a language, and those words that its scripts say by themselves."""
    sentences = (sentence for script in scripts for sentence in SAID.findall(script))
    said = {text: language.say(text) for text in dict.fromkeys(sentences)}
    found = reported | {"words": {text: words for text, words in said.items() if words != text}}
    found |= {"comma": language.comma, "rests": language.say(reported["rests"])}
    if run := reported["run"]:
        found["run"] = run | {"message": language.say(run["message"])}
    if live := reported["live"]:
        found["live"] = live | {"edges": list(map(language.say, live["edges"]))}
    if "captions" in reported:
        found["captions"] = [[from_, language.say(words)] for from_, words in reported["captions"]]
    return found


def three_js() -> str:
    """The library that draws in space: its text, gzip, then base64.

    Raises:
        ToolMissing: it is not installed.
    """
    try:
        folder = resources.files("jupyter_threejs_sage")
    except ModuleNotFoundError:
        fix = "pip install 'eomgen[space]'"
        raise ToolMissing("there is no library for pictures in space in a page", fix=fix) from None
    return packed(folder.joinpath("static", "r130", "three.min.js").read_bytes())


def asset(name: str) -> str:
    """A file of the player."""
    return resources.files("eomgen.page").joinpath("player", name).read_text(encoding="utf-8")


def _harmless(text: str) -> str:
    """A program that cannot end the element it stands in."""
    return text.replace("</script", "<\\/script").replace("<!--", "<\\!--")


# -------- player read back ------------------------------------------------------------------------------------
# PlayedRun, its page -> checks: read again the page holds the run, its parameters and sliders, and draws the model.


NAME, HOW = "the data of the page, read back, are the run and what the model declares", "its columns and numbers"
_PACKED = re.compile(r'atob\("([A-Za-z0-9+/=]+)"\)')
_BEGUN = "begun(document.getElementById("


def player_reported(page: str) -> Mapping[str, Any]:
    """Data of the player in a page.

    Raises:
        ValueError: there is none.
    """
    packed = _PACKED.search(page)
    text = page if packed is None else unpacked(packed[1]).decode()
    begin = text.index("{", text.index(_BEGUN))
    found: Mapping[str, Any] = json.JSONDecoder().raw_decode(text[begin:])[0]
    return found


def player_read_back(played: PlayedRun, page: str) -> Iterator[Check]:
    """Checks that a page holds the run that it plays, and draws its model."""
    reported, tally = player_reported(page), Tally(NAME, HOW)
    for what, wrong in _compared(played, reported):
        tally.add(what, wrong)
    yield from tally.checks()
    if not played.changes:
        yield from pictures_reported(
            (state, picture_of_page(reported["scene"], _slots(played, state)))
            for _, state in states_shown(played.run, played.run.t)
        )


def _named_otherwise(played: PlayedRun, columns: Mapping[str, Any]) -> str:
    """First number of the page's motion that is not the run's of that name, half-way through the run; "" if none.

    Args:
        columns: ("x", place) in the state, ("frame", place) in the results of the page's frame program.
    """
    run, live = played.run, played.live
    if live is None or not len(run.t) or played.phase.system.inputs:
        raise NoValue("it does not move by itself")
    k, names = len(run.t) // 2, live.phase.moving
    own = {name: run.x[:, j] for j, name in enumerate(run.moving)} | dict(run.reactions)
    x = [float(own[name][k]) for name in names]
    frame = RightHandSide.of(live.programs["frame"], "numpy")(float(run.t[k]), x, played.phase.p, ())
    numbers: dict[str, Sequence[float]] = {"x": x, "frame": frame.tolist()}
    if beyond := [name for name, (where, place) in columns.items() if place >= len(numbers[where])]:
        return f"there is no number of {beyond[0]}"
    found = {name: float(numbers[where][place]) for name, (where, place) in columns.items()}
    pairs = [(name, found[name], float(column[k])) for name, column in own.items() if name in found]
    if run.energy is not None:
        pairs.append(("T + V", found["T"] + found["V"], float(run.energy[k])))
    size = 1 + max((abs(right) for _, _, right in pairs if np.isfinite(right)), default=0.0)
    wrong = (f"{name} is {x:.9g} for {y:.9g}" for name, x, y in pairs if abs(x - y) > tolerances.SEVEN_DIGITS * size)
    return next(wrong, "")


def _slots(played: PlayedRun, state: NumericState) -> list[float]:
    """The numbers of a frame."""
    try:
        unknowns = state.unknowns
    except NoValue:  # then what depends on accelerations is not compared
        unknowns = {}
    known = {**dict.fromkeys((*state.equations.symbols.a, *state.equations.symbols.lam), np.nan), **unknowns}
    return [float(x) for x in evaluate(played.scene.values, state.values | known, fifty_digits(partial=True))]


def _compared(played: PlayedRun, reported: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    run = played.run
    yield "time", partial(differing, reported["time"], run.phases[-1].end)
    names = [*run.moving]
    yield "what moves it", partial(_otherwise_moved, played, reported)
    yield "names", lambda: "" if list(reported["names"]) == names else ", ".join(reported["names"])
    yield "instants", partial(_other_column, reported["run"]["t"], [run.t])
    yield "states", partial(_other_column, reported["run"]["x"], list(_states(played).T))
    if reported.get("live") and {*played.phase.moving} <= {*names}:
        yield "numbers by their names", partial(_named_otherwise, played, reported["live"]["columns"])
    model, p = played.model, dict(zip(played.phase.declared.symbols.parameters, played.phase.p, strict=True))
    for each in reported["parameters"]:
        yield f"parameter {each['name']}", partial(_other_value, each, p.get(each["name"]))
    first = dict(zip(names, run.x[0].tolist(), strict=True))
    for each in reported["sliders"]:
        yield f"slider {each['name']}", partial(_other_slider, each, p | first)
    parts = {**model.parameters, **model.coordinates, **model.states}
    plotted = [each for each in reported["plotted"] if each["name"] in model.coordinates]
    for each in (*reported["sliders"], *plotted):
        unit = getattr(parts.get(each["name"]), "unit", None)
        declared = "" if unit is None else unit.text
        yield f"unit of {each['name']}", partial(_other_unit, each, declared)


def _otherwise_moved(played: PlayedRun, reported: Mapping[str, Any]) -> str:
    """Message if a page says that contacts change where none is declared, or moves by itself where they do; else ""."""
    model, requested = played.model, played.options.moves
    paths = [name for name in played.phase.configuration.pieces if model.bodies[name].path_pieces]
    could = bool(model.contacts or paths)  # the model of a phase has the one piece on which a body is
    if requested and reported["rests"] and not (could or played.run.carried):
        return "it says that contacts change, and none is declared"
    alone = len(played.run.phases) == 1
    return "" if alone or not reported["moves"] else "it moves by itself, and the run has several phases"


def _states(played: PlayedRun) -> np.ndarray:
    """States of the run as they are integrated; as they are named where contacts change."""
    if played.changes or played.run.phases[0].track is None:
        return played.run.x
    t, x = played.run.phases[0].track
    return np.array([x[int(np.argmin(np.abs(t - each)))] for each in played.run.t])


def _other_column(reported: Mapping[str, Any], right: list[np.ndarray]) -> str:
    found = list(columns_unpacked(reported, b64decode(reported["content"])))
    if len(found) != len(right):
        return f"{len(found)} columns for {len(right)}"
    for k, (a, b) in enumerate(zip(found, right, strict=True)):
        size = float(np.max(np.abs(b), where=np.isfinite(b), initial=0.0))
        if len(a) != len(b) or not np.allclose(a, b, 0, tolerances.SEVEN_DIGITS * size, equal_nan=True):
            return f"column {k + 1}"
    return ""


def _other_value(each: Mapping[str, Any], right: float | None) -> str:
    return "there is no such one" if right is None else differing(each["value"], float(right))


def _other_slider(each: Mapping[str, Any], known: Mapping[str, float]) -> str:
    if (
        not each["min"] - tolerances.COMPUTED <= each["value"] <= each["max"] + tolerances.COMPUTED
        or each["min"] == each["max"]
    ):
        return f"{each['value']:.6g} is not between {each['min']:.6g} and {each['max']:.6g}"
    return _other_value(each, known.get(each["name"]))


def _other_unit(each: Mapping[str, Any], declared: str) -> str:
    if each["unit"] != ("" if declared == "1" else declared) and declared:
        return f"[{each['unit']}] for [{declared}]"
    size = Unit.parse(each["unit"]).size if each["unit"] else 1.0
    return differing(float(each["size"]), float(size))


# -------- released --------------------------------------------------------------------------------------------
# VirtualDisplacements -> data of a player: one released reaction after the other, each to and fro.


PERIOD = 2.0  # of one displacement [s]
STEPS = 12  # of a period


@dataclass(frozen=True)
class PlayedDisplacements:
    """Virtual displacements of one structure, to be played.

    Args:
        found: one or several.
        language: of the words beside them; "": that of the model.
    """

    found: tuple[VirtualDisplacement, ...]
    language: str = ""
    live: None = None
    moves: bool = False

    @property
    def model(self) -> Model:
        return self.found[0].structure.system.scope.model

    def reported(self) -> dict[str, Any]:
        """Data of the player in the page, as JSON."""
        share = np.arange(STEPS + 1) / STEPS
        size = len(share)
        pieces = [
            (found.along(2 * np.pi * share), np.arange(k * size, (k + 1) * size)) for k, found in enumerate(self.found)
        ]
        numbers = joined(pieces)
        t = PERIOD * np.concatenate([k + share for k in range(len(pieces))])
        states = rows_reported(np.empty((len(t), 0)))
        run = {
            "t": rows_reported(t[:, None]),
            "message": "",
            "x": states,
            "frames": rows_reported(numbers.frames, DRAWN),
        }
        return {
            "name": self.model.name,
            "time": float(t[-1]),
            "scene": numbers.scene.to_json(),
            "names": [],
            "columns": {},
            "energy": False,
            "run": run,
            "live": None,
            "moves": False,
            "parameters": [],
            "sliders": [],
            "rests": "",
            "plotted": [],
            "signs": {},
            "plots": [],
            "vectors": {},
            "check": [],
            "forces": True,
            "captions": [[k * PERIOD, f"{found.reaction.name} released"] for k, found in enumerate(self.found)],
        }
