"""Verbs with options drawn at random, run in this process; and what every one of them must keep."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from random import Random

from click.testing import CliRunner
from cpu_limit import TooLong, within_cpu
from mutated_models import WORD

from eomgen.cli import main
from eomgen.model.reader import loads

PATIENCE, SECONDS = 2, 8.0  # what a verb is given, and the CPU that it may take until it has told what it has
LONGEST = 3_000  # characters of a model that a verb is given
CODES = (0, 1, 2, 3, 4)
STEPS = {  # verb: its share, options that it may be given
    "check": (2, ()),
    "derive": (4, ("--method lagrange", "--method projection", "--method kinetostatic", "--full")),
    "solve": (3, ()),
    "reactions": (2, ("--at NAME=VALUE", "--from-rest NAME=VALUE", "--at equilibrium")),
    "statics": (3, ("--reaction reaction_y(NAME)",)),
    "kinematics": (2, ("--at NAME=VALUE", "--given omega(NAME)=VALUE")),
    "inertia": (2, ("--about NAME.center", "--body NAME", "--axis x")),
    "linearize": (3, ("--about equilibrium", "--about start", "--about steady", "--coordinate NAME")),
    "simulate": (4, ("--until NAME=VALUE", "--method Radau", "--method RK45", "--stabilize none", "--rtol 1e-6")),
    "codegen": (1, ("--inverse", "--target numpy")),
}
NAMED = {
    "parameters": ("--set",),
    "coordinates": ("--start", "--at", "--until", "--from-rest", "--coordinate"),
    "bodies": ("--given", "--about", "--body"),
}
TYPED = (
    "0",
    "1",
    "-2",
    "45 deg",
    "3 kN",
    "1e300",
    "1e-300",
    "pi/4",
    "nan",
    "x",
    "1/0",
    "2 m",
    "",
    "0.1",
    "1e9",
    "30 rpm",
)
BESIDE = {"simulate": ["--time", "0.3", "--target", "numpy", "--samples", "5"], "codegen": ["-o", "OUT"]}


def words(text: str, rng: Random) -> list[str]:
    """A verb with options for a model of this text; MODEL and OUT stand for paths."""
    verb = rng.choices(list(STEPS), [share for share, _ in STEPS.values()])[0]
    names = _names(text, rng)
    found = [verb, "MODEL", *BESIDE.get(verb, [])]
    drawn = [option for option in STEPS[verb][1] if rng.random() < 0.3]
    drawn += [option for option in ("--set NAME=VALUE", "--start NAME=VALUE") if rng.random() < 0.15]
    for option in drawn:
        name, _, value = option.partition(" ")
        found.append(name)
        if value:
            kind = next((kind for kind, options in NAMED.items() if name in options), "")
            found.append(value.replace("NAME", rng.choice(names[kind])).replace("VALUE", rng.choice(TYPED)))
    return [*found, "--patience", str(PATIENCE), *(["--json"] if rng.random() < 0.7 else [])]


def _names(text: str, rng: Random) -> dict[str, list[str]]:
    """What an option may name, by the table that it is declared in; "": any word."""
    model = loads(text.encode("utf-8", "surrogatepass"))
    words = sorted({match[0] for match in WORD.finditer(text)})
    named = {kind: [*getattr(model, kind)] or words for kind in ("parameters", "coordinates", "bodies")}
    named["coordinates"] += [f"{name}'" for name in named["coordinates"]]
    return {kind: own if rng.random() < 0.8 else words for kind, own in named.items()} | {"": words}


def broken_law(text: str, command: Sequence[str], folder: Path) -> str:
    """The law that a verb breaks on a model of this text, in words; "" where it keeps them all."""
    path = folder / "model.toml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    known = {"MODEL": str(path), "OUT": str(folder / "out")}
    try:
        result = within_cpu(SECONDS, lambda: CliRunner().invoke(main, [known.get(word, word) for word in command]))
    except TooLong:
        return f"a verb ends at its --patience {PATIENCE}, at most {SECONDS} s of CPU"
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        return f"only EomgenError leaves: {type(result.exception).__name__}: {result.exception}"
    if "internal error" in result.stderr or "Traceback" in result.stderr:
        return f"only EomgenError leaves: {_line(result.stderr)}"
    if result.exit_code not in CODES:
        return f"an exit code has a meaning: {result.exit_code}"
    if result.exit_code and not result.stderr.strip():
        return "what fails says why"
    if "--json" in command:
        return _broken_json(result.stdout, result.exit_code)
    return "" if "FAILS" not in result.stdout else f"what derives has a proof that holds: {_failing(result.stdout)}"


def _line(text: str) -> str:
    return next(line for line in text.splitlines() if "internal error" in line or "Traceback" in line)


def _failing(text: str) -> str:
    return next(line for line in text.splitlines() if "FAILS" in line)


def _broken_json(text: str, code: int) -> str:
    try:
        reported = json.loads(text, parse_constant=_constant)
    except ValueError as error:
        return f"--json is JSON: {error}: {text[:80]!r}"
    if not isinstance(reported, dict) or "schema_version" not in reported:
        return f"--json has its version: {text[:80]!r}"
    if "error" in reported:
        error = reported["error"]
        return "" if (error["exit_code"], bool(error["problems"])) == (code, True) else "the JSON tells the exit code"
    certificate = reported.get("certificate") or {}
    if certificate.get("ok") is False:
        wrong = next(check for check in certificate["checks"] if check["status"] == "fails")
        return f"what derives has a proof that holds: {wrong['name']}: {wrong['detail']}"
    return ""


def _constant(name: str) -> None:
    raise ValueError(f"{name} is no JSON")


def shape_of(law: str) -> str:
    """The law without what differs from find to find, so that each kind is told once."""
    return re.sub(r"\d+|'[^']*'|\"[^\"]*\"", "*", law)[:120]
