"""Text of a model -> its parts, each as soon as it is there: problems, picture, freedom, equations, answers, motion.

What was made for a model stays while its file changes and the model does not: then nothing is made again. Equations
stay while only values of parameters change.
"""

from __future__ import annotations

import json
import os
import queue
import signal
import sys
import threading
import time
from base64 import b64decode
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import suppress
from dataclasses import fields
from functools import cached_property
from hashlib import sha256
from typing import IO, Any

from eomgen import pipeline
from eomgen.documents import Document, Formula, equations_latex, formula_text
from eomgen.equations import Equations
from eomgen.errors import DerivationError, EomgenError, MissingValues, ModelError, Problem, UsageError
from eomgen.frozen import dataclass
from eomgen.living.state import NAMES
from eomgen.model import Model, loads, located, warned
from eomgen.page import document_html, model_svg, play
from eomgen.proof import Certificate
from eomgen.questions import reactions_document, solve
from eomgen.resources import growing, patience, seldom_from_now_on
from eomgen.results import kinematics, statics
from eomgen.study import Checked, model_to_study
from eomgen.symbolic.expression import Expression
from eomgen.symbolic.numeric import NoValue
from eomgen.verbs import typed

PATIENCE = 30.0  # s for one part
MOST_KEPT = 64  # parts
OF_THE_TEXT = ("figure", "degrees_of_freedom", "equations")
"""Parts that every model has: where one cannot be made, something is wrong with the text."""
OF_VALUES = ("data", "freedom", "coordinates")
"""Steps of a derivation that show values, and change with them."""
STILL = "nothing moves: the model has no coordinates"

Finding = dict[str, Any]
"""A part: "part", its "value", "why" it has none, "seconds"; or "problems" and "warnings" of the text."""


class Work:
    """Work on one text after the other, and the parts that were made for those before."""

    def __init__(self) -> None:
        self._kept: dict[Hashable, Any] = {}
        self._lock = threading.Lock()
        self._end: Callable[[], None] | None = None
        self._stopped = False

    def begin(self) -> None:
        """Ends no more what was stopped."""
        with self._lock:
            self._stopped = False

    def stop(self) -> None:
        """Ends what is being done, from another thread: it is out of date."""
        with self._lock:
            self._stopped = True
            if self._end is not None:
                self._end()

    @property
    def stopped(self) -> bool:
        return self._stopped

    def kept(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """make(), or what it gave before under this key; the youngest are kept."""
        found = self._kept.pop(key) if key in self._kept else make()
        if self._stopped:  # it may be a part of what was wanted
            return found
        self._kept[key] = found
        while len(self._kept) > MOST_KEPT:
            self._kept.pop(next(iter(self._kept)))
        return found

    def limited(self, seconds: float | None, make: Callable[[], Any]) -> Any:
        """make(), given up after so many seconds, or when it is stopped.

        Raises:
            OutOfPatience: it was given up.
        """
        with patience(seconds) as end, growing():
            with self._lock:
                self._end = end
                if self._stopped:
                    end()
            try:
                return make()
            finally:
                with self._lock:
                    self._end = None


def parts_made(
    data: bytes,
    name: str,
    title: str,
    work: Work,
    seconds: float | None = PATIENCE,
    values: Mapping[str, Any] | None = None,
) -> Iterator[Finding]:
    """Problems and parts of a model's text, in the order in which they are found; fewer where the work is stopped.

    Args:
        name: of the file, in problems.
        title: of a model that gives itself none.
        seconds: the time for one part; None: no limit.
        values: what was typed in the place of those of the text: "set_", "start", "variant".
    """
    try:
        model = loads(data, name, title)
        model = typed(model, values)[0].model if values else model
    except ModelError as error:
        yield {"problems": [problem.as_dict() for problem in error.problems], "good": False}
        return
    except UsageError as error:  # a value for a name that the text has no more
        yield {"problems": _dicts((Problem("", error.what, fix=error.fix),)), "good": False}
        return
    subject = WrittenModel(model)
    problems: list[Problem] = []
    yield {"problems": [], "good": True, "name": model.name, "warnings": _dicts(warned(model, data, name))}
    for part in NAMES:
        if work.stopped:
            return
        begun, value, why = time.perf_counter(), None, ""
        try:
            value = work.limited(seconds, lambda part=part: work.kept((part, subject.key(part)), subject.made(part)))  # type: ignore[misc]
        except (EomgenError, NoValue) as error:
            found = _problem(error, data, name)
            why = found.what
            if part in OF_THE_TEXT and not isinstance(error, MissingValues) and why not in [p.what for p in problems]:
                problems.append(found)
                yield {"problems": _dicts(tuple(problems))}
        if work.stopped:
            return
        if part == "degrees_of_freedom" and value is not None:
            value, cautions = value
            own = (*warned(model, data, name), *(located(each, data, name) for each in cautions))
            yield {"warnings": _dicts(own)}
        yield {"part": part, "value": value, "why": why, "seconds": round(time.perf_counter() - begun, 4)}


def _problem(error: EomgenError | NoValue, data: bytes, name: str) -> Problem:
    """The error of a part, at its place in the text."""
    if isinstance(error, ModelError):
        return located(error.problems[0], data, name, by_name=True)
    if isinstance(error, EomgenError):
        return located(Problem(error.where, error.what, fix=error.fix), data, name, by_name=True)
    return Problem("", f"a value that cannot be: {error}")


def _dicts(problems: tuple[Problem, ...]) -> list[dict[str, Any]]:
    return [problem.as_dict() for problem in problems]


def value_class(value: Expression | None) -> Hashable:
    """Property of a value on which the printed equations may depend: the sign of a number, or the whole formula.

    Parts of the page are made anew only where this changes.
    """
    if value is None or value.names - {"pi"}:
        return value
    number = value.value_at({}) or 0
    return int(number > 0) - int(number < 0)


@dataclass(frozen=True)
class WrittenModel:
    """A model of which parts are made."""

    model: Model

    @cached_property
    def studied(self) -> Model:
        """The model whose motion is studied."""
        return model_to_study(self.model)

    @cached_property
    def equations(self) -> Equations:
        return pipeline.derive(self.studied)

    def key(self, part: str) -> Hashable:
        """Key of a part: the model; of equations the signs of its values, and its contacts at the start."""
        if part != "equations" or not self.model.coordinates:
            return self.model
        model = self.model
        rest = tuple(getattr(model, f.name) for f in fields(model) if f.name not in ("parameters", "outputs"))
        constants = tuple(
            (name, value_class(p.value), p.unit, p.about, p.positive, p.symbol) for name, p in model.parameters.items()
        )
        return (*rest, constants, self.equations.assumptions, tuple(self.equations.system.modes.items()))

    def made(self, part: str) -> Callable[[], Any]:
        """The function that makes a part."""
        found: Callable[[], Any] = getattr(self, f"_{part}")
        return found

    def _figure(self) -> str:
        return str(model_svg(self.studied))

    def _degrees_of_freedom(self) -> tuple[int | None, tuple[Problem, ...]]:
        found = Checked.of(self.studied)
        return found.freedom.by_rank if self.model.coordinates else found.mobility, found.cautions

    def _equations(self) -> dict[str, Any]:
        if not self.model.coordinates:
            return {"html": "", "text": [], "latex": "", "remark": STILL}
        document = self.equations.derivation_of_motion()
        result = {"equations", "solved"}
        lines = [
            formula_text(each)
            for step in document.steps
            if step.key == "equations"
            for each in step.statements
            if isinstance(each, Formula)
        ]
        return {
            "html": document_html(document, lambda step: step.key in result),
            "derivation": document_html(document, lambda step: step.key not in {*result, *OF_VALUES}),
            "text": lines,
            "latex": equations_latex(document),
        }

    def _answers(self) -> dict[str, Any]:
        found = solve(self.studied)
        listed = {name: answer.as_dict() for name, answer in found.items()}
        return {"outputs": listed, "html": document_html(found.document) if listed else ""}

    def _motion(self) -> dict[str, Any]:
        if not self.model.coordinates:
            return {"page": None, "remark": STILL}
        found = play(self.studied)
        run = found.played.run
        words = " ".join(filter(None, (found.shorter, "" if run.ok else run.message)))
        page = found.html
        digest = sha256(page.encode()).hexdigest()[:16]
        return {"page": page, "digest": digest, "time": float(run.phases[-1].end), "remark": words}

    def _reactions(self) -> dict[str, Any]:
        document = self._at_rest()[0] if not self.model.coordinates else reactions_document(self.model, certify=False)
        found = document.entries().get("reactions", {})
        listed = {name: each.as_dict() for name, each in found.items()} if isinstance(found, dict) else {}
        return {"html": document_html(document), "found": listed}

    def _at_rest(self) -> tuple[Document, Callable[[], Certificate]]:
        """The result of a model without coordinates: of a structure its reactions, of a mechanism its velocities.

        Raises:
            DerivationError: neither fits, and why the first does not.
        """
        try:
            result: Any = statics(self.studied)
        except DerivationError as error:
            try:
                result = kinematics(self.studied)
            except DerivationError:
                raise error from None
        return result.document, result.certify

    def _certificate(self) -> dict[str, Any]:
        proof = self.equations.certify() if self.model.coordinates else self._at_rest()[1]()
        return {"ok": proof.ok, "text": proof.brief}


# -------- process ---------------------------------------------------------------------------------------------
# One process that makes the parts of models: texts come in on stdin, what is found goes out on stdout, a line each.
#
#     in:  {"revision": 3, "data": base64, "name": "crane.toml", "title": "crane"}; {"stop": true}
#     out: {"revision": 3, "part": "figure", "value": "<svg ...>", ...}; {"revision": 3, "done": true}
#
# It ends when stdin does: with the program that asks.


WARM = b"""eomgen = 1
space = "plane"
parameters = { m = { value = 1, unit = "kg" }, l = { value = 1, unit = "m" }, g = { value = 9.81, unit = "m/s^2" } }
coordinates = { theta = { start = 30, unit = "deg" } }
outputs = { T = "kinetic_energy()" }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
"""
"""A model of which every part is made once, so that all is loaded."""


def work_until_stdin_ends() -> None:
    """Works until stdin ends."""
    with suppress(ValueError):
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program that asks
    seldom_from_now_on()
    out = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)  # what a library prints is no message
    requests: queue.Queue[dict[str, Any]] = queue.Queue()
    work = Work()
    threading.Thread(target=_listen, args=(sys.stdin, requests, work), daemon=True).start()
    while True:
        request = requests.get()
        if request.get("warm"):
            for _ in parts_made(WARM, "model.toml", "model", Work()):
                pass
            continue
        work.begin()
        _make(request, work, out)


def _listen(source: IO[str], requests: queue.Queue[dict[str, Any]], work: Work) -> None:
    """Takes what comes in, while the other thread works."""
    for line in source:
        request = json.loads(line)
        if request.get("stop"):
            work.stop()
        else:
            requests.put(request)
    os._exit(0)


def _make(request: dict[str, Any], work: Work, out: IO[str]) -> None:
    revision, data = request["revision"], b64decode(request["data"])
    for finding in parts_made(data, request["name"], request["title"], work, request["seconds"], request["values"]):
        out.write(json.dumps({"revision": revision, **finding}) + "\n")
    out.write(json.dumps({"revision": revision, "done": True}) + "\n")
