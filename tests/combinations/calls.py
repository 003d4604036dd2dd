"""Verbs, formats and doors, asked of a drawn model in this process; what each must keep.

A call is right when its exit code has a meaning, no internal error leaves, a certificate that is told holds, a refusal
names an object of the model or the feature, its place and what to do (`refusals.py`), and a line that `derive` printed
is not called wrong by `verify`.
"""

from __future__ import annotations

import json
import re
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

from click.testing import CliRunner
from compare import filled, quiet
from linear_lines import linear_lines
from refusals import lacking

import eomgen
import eomgen.cli_common
from eomgen.cli import main
from eomgen.judge.case import Case
from eomgen.judge.derivations import judged_derivation
from eomgen.judge.judge import Judge
from eomgen.study import model_to_study

SECONDS = 20  # of CPU that one call may take
SLOW = 8.0  # of CPU from which a call is named
FORMATS = ("text", "latex", "markdown", "json")
LANGUAGES = (
    "c",
    "numpy",
    "cpp",
    "fortran",
    "javascript",
    "julia",
    "matlab",
    "rust",
    "casadi",
    "jax",
    "numba",
    "wasm",
    "fmu",
)


@dataclass(frozen=True)
class Outcome:
    """What came of a call.

    Args:
        fault: "" or the kind of the fault: "internal error", "certificate", "exit code", "judged wrong", ...
        detail: the line that says it.
        code: exit code, or 0 and 1 of Python.
        seconds: of CPU.
    """

    call: str
    code: int
    fault: str = ""
    detail: str = ""
    seconds: float = 0.0
    note: str = ""


AGAIN = 0.5  # seconds of CPU after which a call is stopped once more: within a callback of the collector nothing is


class TooLong(BaseException):
    """The CPU of a call is used up."""


@contextmanager
def limit(seconds: float) -> Iterator[None]:
    def stop(*_: object) -> None:
        raise TooLong

    old = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, old)


SYMBOLIC = ("check", "derive", "solve", "reactions", "statics", "kinematics", "inertia", "linearize")
WEIGHTS = {
    "statics": 2, "kinematics": 2, "inertia": 2, "linearize": 2, "codegen": 3, "report": 1, "animate": 1, "play": 1,
    "sweep": 2, "export": 1, "identify": 1, "simulate": 1,
}  # fmt: skip
PAGES = ("r.html", "r.ipynb", "r.md", "r.tex", "r.pdf")


def commands(text: str, rng: Random, more: int = 3, *, every_format: bool = False) -> list[list[str]]:
    """The command lines of one model: what everybody asks, and of the rest some, with their ways in turn.

    Args:
        every_format: each in all formats, not in one that is drawn.
    """
    form = lambda: ["--format", rng.choice(FORMATS)]  # noqa: E731
    first = re.search(r"^\[coordinates\]\n(\w+) =", text, re.M)
    q = first[1] if first else "q"
    number = next((n for n in ("m", "k", "g", "l0", "m0", "h") if re.search(rf"^{n} = ", text, re.M)), "m")
    method = rng.choice(("lagrange", "projection", "kinetostatic"))
    way = rng.choice(("projection", "energy", "baumgarte", "none"))
    side = Random(len(text))  # draws of its own: what is drawn above and below stays as it was
    language = side.choice(([], ["--language", side.choice(("de", "es", "fr"))]))
    sheet = side.choice(([], ["--for", side.choice(("problem", "worksheet", "solution"))], ["--with", "free_bodies"]))
    letters = side.choice(([], ["--symbols"]))
    run = ["--time", "0.4", "--samples", "5", "--target", "numpy"]
    swept = rng.choice((["--over", f"{number}=1,1.2"], ["--random", f"{number}=uniform(1, 1.2)", "--runs", "2"]))
    found = [
        ["check", "MODEL", *rng.choice(([], ["--json"]))],
        ["derive", "MODEL", "--method", method, *form(), *rng.choice(([], ["--units"])), *language],
        ["simulate", "MODEL", *run, "--stabilize", way, *form()],
        rng.choice((["solve", "MODEL", *form()], ["reactions", "MODEL", *form()])),
    ]
    rest = {
        "statics": ["statics", "MODEL", *form()],
        "kinematics": ["kinematics", "MODEL", *form()],
        "inertia": ["inertia", "MODEL", *form()],
        "linearize": ["linearize", "MODEL", *form(), *rng.choice(([], ["--about", "start"], ["--about", "steady"]))],
        "codegen": ["codegen", "MODEL", "-o", "OUT/code", "--target", rng.choice(LANGUAGES)],
        "report": ["report", "MODEL", "-o", "OUT/" + rng.choice(PAGES), "--time", "0.3", *language, *sheet],
        "animate": ["animate", "MODEL", "-o", "OUT/a.html", "--time", "0.2", "--forces"],
        "play": ["play", "MODEL", "-o", "OUT/p.html", "--time", "0.3", *language],
        "sweep": ["sweep", "MODEL", "-o", "OUT/sweep", *swept, "--ask", f"last({q})", "--time", "0.2"],
        "export": ["export", "MODEL", "-o", "OUT/robot.urdf"],
        "identify": ["identify", "MODEL", *form()],
        "simulate": ["simulate", "MODEL", *run, "-o", "OUT/run.csv", "--units", *letters],
    }
    drawn = sorted(rest, key=lambda verb: rng.random() ** (1 / WEIGHTS[verb]), reverse=True)
    requested = found + [rest[verb] for verb in drawn[:more]]
    return [each for words in requested for each in (in_every_format(words) if every_format else [words])]


def in_every_format(words: list[str]) -> list[list[str]]:
    """The same words with each format in the place of the one they name, which comes first; else the words alone."""
    if "--format" not in words or words[0] == "simulate":
        return [words]
    place = words.index("--format") + 1
    others = [form for form in FORMATS if form != words[place]]
    return [[*words[:place], form, *words[place + 1 :]] for form in (words[place], *others)]


def by_command(text: str, words: list[str], folder: Path) -> Outcome:
    """One command line; of what runs, a parameter without a value gets one."""
    path = folder / "model.toml"
    requested = text if words[0] in SYMBOLIC else filled(text)
    path.write_text(requested, encoding="utf-8")
    (folder / "out").mkdir(exist_ok=True)
    known = {"MODEL": str(path)}
    arguments = [known.get(w, w.replace("OUT", str(folder / "out"))) for w in words]
    if words[0] not in ("check",):
        arguments += ["--patience", "none"]
    call, begin = " ".join(words), time.process_time()
    try:
        with limit(SECONDS), reported_problems() as problems:
            result = CliRunner().invoke(main, arguments)
    except TooLong:
        return Outcome(call, -1, "slow", f"more than {SECONDS} s of CPU", time.process_time() - begin)
    if result.exit_code == 130:
        raise KeyboardInterrupt
    seconds = time.process_time() - begin
    fault, detail = _fault(words, result)
    note = str(problems[0]).splitlines()[0][:200] if problems else _refusal(result)
    if result.exit_code and not fault and not result.stdout.strip():
        left = lacking(problems, requested)
        fault, detail = ("refusal", f"{left}: {note}") if left else ("", "")
    return Outcome(call, result.exit_code, fault, detail, seconds, note)


@contextmanager
def reported_problems() -> Iterator[list[Any]]:
    """What the command line tells as wrong within it."""
    own, found = eomgen.cli_common._reported, []  # type: ignore[var-annotated]

    def reported(code: int, problems: Any, *rest: Any) -> int:
        found.extend(problems)
        return own(code, problems, *rest)

    eomgen.cli_common._reported = reported  # type: ignore[assignment]
    try:
        yield found
    finally:
        eomgen.cli_common._reported = own


def _fault(words: list[str], result: Any) -> tuple[str, str]:
    out, err = result.stdout, result.stderr
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        return "internal error", f"{type(result.exception).__name__}: {str(result.exception)[:160]}"
    if "internal error" in err or "Traceback" in err or result.exit_code == 70:
        return "internal error", next((x for x in err.splitlines() if "internal error" in x), err[-200:])
    if result.exit_code not in (0, 1, 2, 3, 4):
        return "exit code", str(result.exit_code)
    if "FAILS" in out or '"ok": false' in out or "FAILS" in err:
        lines = [x for x in (out + err).splitlines() if "FAIL " in x or '"fails"' in x]
        return "certificate", (lines or ["a certificate does not hold"])[0].strip()[:300]
    if result.exit_code and not err.strip() and '"error"' not in out:
        return "said nothing", f"exit {result.exit_code} without a word"
    return "", ""


def _refusal(result: Any) -> str:
    if not result.exit_code:
        return ""
    lines = [x for x in result.stderr.splitlines() if x.strip() and not x.startswith(("warning", " ", "fix"))]
    return lines[0][:200] if lines else ""


def _refused(call: str, no: eomgen.EomgenError, text: str, seconds: float) -> Outcome:
    """A refusal in Python: as the command line's."""
    left = lacking(eomgen.cli_common.problems_of(no), text)
    first = str(no).splitlines()[0][:200]
    return Outcome(call, 1, "refusal" if left else "", f"{left}: {first}" if left else "", seconds, first)


def judged(text: str, rng: Random) -> Iterator[Outcome]:
    """`verify` of a whole derivation as derive prints it, in text or LaTeX: no line may be called wrong."""
    try:
        with quiet(), limit(SECONDS):
            model = eomgen.loads(text)
            page = eomgen.derive(model).render(rng.choice(("text", "latex")))
    except (TooLong, eomgen.EomgenError):
        return  # told by `derive`
    begin = time.process_time()
    spent = lambda: time.process_time() - begin  # noqa: E731
    try:
        with quiet(), limit(SECONDS):
            found = judged_derivation(Judge(Case(model_to_study(model))), page)
        for line in found.lines:
            fault = "judged wrong" if line.verdict.verdict == "wrong" else ""
            reported = "right" if line.defines else line.verdict.verdict
            yield Outcome("verify", 0, fault, line.equation.text[:200], spent() if fault else 0.0, reported)
        for equation, why in found.skipped:
            yield Outcome("verify", 0, "", equation.text[:200], 0.0, f"unread: {why[:160]}")
    except TooLong:
        yield Outcome("verify", -1, "slow", f"a derivation: more than {SECONDS} s of CPU", spent())
    except eomgen.EomgenError as no:
        yield Outcome("verify", 1, "", str(no).splitlines()[0][:200], spent(), "unread: the page")
    except Exception as error:
        yield Outcome("verify", 70, "internal error", f"{type(error).__name__}: {str(error)[:240]}")


def small_motions_judged(text: str) -> Iterator[Outcome]:
    """`verify` of the linearized equations: right to the first order, and wrong with another stiffness, with proof."""
    try:
        with quiet(), limit(SECONDS):
            lines = list(linear_lines(eomgen.linearize(eomgen.loads(text)).as_dict()))
    except (TooLong, eomgen.EomgenError):
        return  # told by `linearize`
    for right, wrong, about in lines[:1]:
        for equation, code in ((right, 0), (wrong, 5)):
            words = ["verify", "-", equation, "--to-first-order", "--about", about, "--json"]
            begin = time.process_time()
            with quiet():
                result = CliRunner().invoke(main, words, input=text)
            spent = time.process_time() - begin
            fault, detail = ("", "") if result.exit_code == code else _fault(words, result)
            if not fault and result.exit_code != code and '"undecided"' not in result.stdout:
                fault, detail = "judged wrong", f"exit {result.exit_code}: {equation[:200]}, about {about}"
            yield Outcome("verify --to-first-order", result.exit_code, fault, detail, spent)


PYTHON: dict[str, Callable[[Any], Any]] = {
    "derive and pickled": lambda m: _pickled(eomgen.derive(m)),
    "derive in a notebook": lambda m: _shown(eomgen.derive(m)),
    "simulate in a notebook": lambda m: _shown(eomgen.simulate(m, time=0.2, samples=4)),
    "simulate and pickled": lambda m: _pickled(eomgen.simulate(m, time=0.2, samples=4)),
    "linearize and pickled": lambda m: _pickled(eomgen.linearize(m)),
    "linearize in a notebook": lambda m: _shown(eomgen.linearize(m)),
    "statics in a notebook": lambda m: _shown(eomgen.statics(m)),
    "kinematics in a notebook": lambda m: _shown(eomgen.kinematics(m)),
    "inertia and pickled": lambda m: _pickled(eomgen.inertia(m)),
    "inertia in a notebook": lambda m: _shown(eomgen.inertia(m)),
    "solve in a notebook": lambda m: [_shown(x) for x in eomgen.solve(m).values()],
    "reactions in a notebook": lambda m: _shown(eomgen.reactions(m)),
    "model pickled": lambda m: _pickled(m),
    "sensitivity": lambda m: eomgen.sensitivity(
        m, next(iter(m.coordinates)), next(iter(m.parameters)), time=0.2, samples=3
    ),
    "animate": lambda m: eomgen.animate(eomgen.simulate(m, time=0.2, samples=4)),
    "simulate_many": lambda m: eomgen.simulate_many(m, time=0.1, parameters={next(iter(m.parameters)): [1.0, 1.1]}),
    "scene": lambda m: eomgen.scene_of(m),
    "regressor": lambda m: eomgen.regressor(m),
    "free bodies": lambda m: _shown(m.free_bodies()),
    "freedom": lambda m: eomgen.freedom_of(m),
    "as_dict": lambda m: json.dumps(eomgen.derive(m).as_dict()),
}


def _pickled(x: Any) -> Any:
    import pickle

    again = pickle.loads(pickle.dumps(x))
    assert type(again) is type(x)
    return again


def _shown(x: Any) -> Any:
    for door in ("_repr_html_", "_repr_latex_", "_repr_markdown_", "_repr_mimebundle_"):
        if hasattr(x, door):
            getattr(x, door)()
    return repr(x)


def by_python(text: str, names: list[str]) -> Iterator[Outcome]:
    """The Python doors of these names."""
    try:
        with quiet():
            model = eomgen.loads(text)
    except eomgen.EomgenError as no:
        yield _refused("python loads", no, text, 0.0)
        return
    for name in names:
        begin = time.process_time()
        try:
            with quiet(), limit(SECONDS):
                PYTHON[name](model)
            yield Outcome(f"python {name}", 0, "", "", time.process_time() - begin)
        except TooLong:
            yield Outcome(f"python {name}", -1, "slow", f"more than {SECONDS} s of CPU", time.process_time() - begin)
        except eomgen.EomgenError as no:
            yield _refused(f"python {name}", no, text, time.process_time() - begin)
        except Exception as error:
            detail = f"{type(error).__name__}: {str(error)[:160]}"
            yield Outcome(f"python {name}", 70, "internal error", detail, time.process_time() - begin)


def python_doors(rng: Random, count: int = 2) -> list[str]:
    return rng.sample(sorted(PYTHON), count)
