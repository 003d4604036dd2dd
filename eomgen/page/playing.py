"""Model -> Played: the model alive in a page that needs no network, with its proof."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from eomgen import files, pipeline
from eomgen.codegen import RightHandSide, TestVector
from eomgen.documents import Document, Lines, language_of, plain_document, proven, with_start_reported
from eomgen.errors import ExpressionError, RunFailed, ToolMissing, UsageError
from eomgen.frozen import dataclass
from eomgen.model import Model, ModelOrPath, Taken, Typed, TypedNumbers, Values, seconds
from eomgen.page.contents import framed
from eomgen.page.player import PlayedRun, PlayerOptions, SliderRange, player_page_of, player_read_back
from eomgen.proof import Certificate, Check, checked, unchecked
from eomgen.resources import doing
from eomgen.runs import run_of_a_page
from eomgen.study import model_to_study

SAMPLES = 401  # of a run in a page
LIKE = "write --slider m=0.1:5"
SUBJECTS = {"rate": "motion", "frame": "picture"}


@dataclass(frozen=True)
class Played:
    """A model's page.

    Args:
        played: the run that it begins with, and the player's options.
        shorter: the reason why it is shorter than others, or "".
    """

    played: PlayedRun
    shorter: str = ""

    @cached_property
    def html(self) -> str:
        """The page."""
        return player_page_of(self.played)

    @property
    def rests(self) -> str:
        """Why the sliders rest, or ""."""
        return self.played.rests

    def write(self, path: str | Path) -> None:
        """The page as a file.

        Raises:
            WriteFailed: it cannot be written; the old file is then unchanged.
        """
        files.write(path, self.html)

    def __repr__(self) -> str:
        return f"<page of {self.played.model.name!r}, {len(self.html) // 1024} KB{': ' * bool(self.rests)}{self.rests}>"

    def _repr_html_(self) -> str:
        """The page in a frame of its own, for notebooks."""
        return framed(self.html)

    def certify(self) -> Certificate:
        """The proof of the run that the page begins with, and of the programs in the page, run by node."""
        certificate: Certificate = self.played.run.certify()
        return certificate + chain(self._programs(), player_read_back(self.played, self.html))

    def _programs(self) -> Iterator[Check]:
        live, how = self.played.live, "run by node at the page's own test vectors, of 50 digits"
        for name, rows in self.played.vectors.items() if live else ():
            assert live is not None
            title = f"the page's program of the {SUBJECTS[name]} gives the symbols' numbers"
            try:
                function = RightHandSide.of(live.programs[name], "javascript")
                wrong = next((w for v in rows if (w := _wrong(v, function(v.t, v.x, v.p, v.inputs or ())))), "")
            except (ToolMissing, RunFailed) as error:
                yield unchecked(title, error.what, how)
                continue
            yield checked(title, wrong, how)


def _wrong(v: TestVector, found: np.ndarray) -> str:
    """Largest deviation of a result from the vector's, in words; "" if it is within the tolerance."""
    right: np.ndarray = np.array(v.result)
    missing = np.isnan(right)
    largest = float(np.max(np.abs(right[~missing]), initial=1.0))
    off: np.ndarray = np.where(missing, ~np.isnan(found), ~(np.abs(found - right) <= v.tolerance * largest))
    return f"number {off.argmax()} is {found[off][0]:.9g}, not {right[off][0]:.9g}" if off.any() else ""


def play(
    model: ModelOrPath,
    path: str | Path | None = None,
    *,
    time: Typed | None = None,
    sliders: Sequence[str] = (),
    parameters: Values | None = None,
    start: Values | None = None,
    trail: str = "",
    forces: bool = False,
    speed: float = 1.0,
    language: str = "",
) -> Played:
    """The model alive in a page: sliders, bodies that one can take, plots; no network is needed.

    Args:
        path: the file of the page; None: it is not written.
        time: the duration of the motion: 5 s or "500 ms"; None: three periods, until it rests, or
            10 s; less where it stops or takes too many steps.
        sliders: names with a slider, each "NAME" or "NAME=FROM:TO", numbers in SI or with a unit; () for everything.
        parameters, start: values that replace the model's, each as `model_at` takes it.
        trail: a point that leaves a trail from the start.
        forces: arrows of forces are shown from the start.
        speed: of the time.
        language: of the words in the page: "de", or a file .po; "": that of the model.
    Raises:
        UsageError: nothing moves; a slider of an unknown name; there are no words in that language.
    """
    model = model_to_study(model, parameters, start)
    ranges, _ = slider_ranges(model, sliders, declared=False)
    options = PlayerOptions(ranges, True, trail, forces, speed, language)
    found = played(model, None if time is None else seconds(time), options)
    if path is not None:
        found.write(path)
    return found


@doing("the page of the model")
def played(model: Model, time: float | None, options: PlayerOptions) -> Played:
    """The page of a model whose values stand."""
    if not model.coordinates:
        raise UsageError("nothing moves: the model has no coordinates", fix="`statics` and `kinematics` answer it")
    if not (options.speed > 0 and math.isfinite(options.speed)):
        raise UsageError(f"a speed of {options.speed:g} makes no sense", fix="1 is as fast as it moves")
    found, shorter = run_of_a_page(pipeline.derive(model), time, SAMPLES)
    made = Played(PlayedRun(found, options), shorter)
    language_of(model, options.language)
    points = [point["name"] for point in made.played.drawn[0]["points"]]
    if options.trail and options.trail not in points:
        raise UsageError(f"there is no point '{options.trail}'", fix=f"there are {', '.join(points)}")
    return made


def slider_ranges(
    model: Model, sliders: Sequence[str], *, declared: bool = True
) -> tuple[dict[str, SliderRange | None], tuple[Taken, ...]]:
    """({slider: its range in SI}, the values that were read from what was typed).

    Args:
        declared: plain numbers are in the unit that the file declares; else in SI.
    Raises:
        UsageError: an item is not NAME=FROM:TO.
    """
    found: dict[str, SliderRange | None] = {}
    taken: list[Taken] = []
    for text in sliders:
        name, equals, ends = (part.strip() for part in text.partition("="))
        first, colon, last = (part.strip() for part in ends.partition(":"))
        rates = (f"{q}'" for q in model.coordinates)
        known = (*model.parameters, *model.coordinates, *rates, *model.speeds, *model.states)
        if name not in known:
            raise UsageError(f"there is no slider for '{name}'", fix=f"there are {', '.join(known)}")
        if name in found:
            raise UsageError(f"the slider '{name}' is given twice", fix="give it once")
        if equals and not (colon and first and last):
            raise UsageError(f"'{text}' is no slider", fix=LIKE)
        found[name] = None
        if equals:
            typed = TypedNumbers(model, name, declared)
            try:
                low, high = typed.number(first), typed.number(last)
            except ValueError as error:
                raise UsageError(f"'{text}' is no slider: its ends are no numbers", fix=LIKE) from error
            except ExpressionError as error:
                raise UsageError(f"'{text}' is no slider: {error.what}", fix=error.fix or LIKE) from error
            if not low < high < math.inf:
                raise UsageError(f"the slider '{name}' ends before it begins", fix=LIKE)
            found[name] = (low, high)
            taken.append(typed.taken(ends, [first, last], " to ".join))
    return found, tuple(taken)


# -------- document -------------------------------------------------------------------------------------------
# eomgen play: the model alive in a page of its own.


def play_document(
    model: Model,
    *,
    output: str,
    time: float | None,
    sliders: tuple[str, ...],
    trail: str,
    forces: bool,
    speed: float,
    language: str = "",
    certify: bool = True,
) -> Document:
    """Writes the page; the document describes its content."""
    ranges, taken = slider_ranges(model, sliders)
    options = PlayerOptions(ranges, True, trail, forces, speed, language)
    found = played(model, time, options)
    found.write(output)

    def payload() -> dict[str, Any]:
        reported = found.played.reported()
        names = [slider["name"] for slider in reported["sliders"]]
        return {"name": model.name, "files": [output], "sliders": names, "rests": found.rests or None}

    run = found.played.run
    document = plain_document(model, payload, Lines((output,)), failed="" if run.ok else run.message)
    document = replace(document, taken=taken, notes=tuple(filter(None, (found.rests, found.shorter))))
    return proven(with_start_reported(document, model, run), found.certify() if certify else None)
