"""Derivations of every model that this version derives, and ways to read printed formulas back."""

from __future__ import annotations

import json
import re
import runpy
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from covering_models import declared
from slow_run import usual, usual_models

from eomgen import solve
from eomgen.documents.derivation import derivation_of
from eomgen.documents.document import Document
from eomgen.equations import Equations
from eomgen.mechanics.dynamics.formulations import METHODS
from eomgen.mechanics.dynamics.system import System
from eomgen.model.model import Model
from eomgen.model.reader import load, loads
from eomgen.pipeline import derive
from eomgen.questions.outputs_answered import Answers
from eomgen.symbolic.expression.derivatives import substituted
from eomgen.symbolic.expression.formula import Call, Reference, over
from eomgen.symbolic.expression.node import Node, Scalar
from eomgen.symbolic.expression.text import parse

MODELS = Path(__file__).parent.parent.parent / "models"
PATHS = sorted([*MODELS.glob("*.toml"), *MODELS.glob("seeds/*.toml")])
LARGE = (
    "arm7",
    "bennett",
    "bricard",
    "chain20",
    "delta_robot",
    "puma560",
    "space_manipulator",
    "spatial_slider_crank",
    "stewart_platform",
    "whipple_bicycle",
)

# closing constraints, a driven coordinate, inputs, springs, and names that look alike or are special in a markup
# language
LOOP = r"""
eomgen = 1
name = "Loop & 50% of_everything"
space = "plane"
about = "A $test$ of #all {kinds} \\ with <b>markup</b> | pipes *and* stars ~^"
source = "none_of_them"
[parameters]
m = { value = 1, unit = "kg", about = "mass of the _crank_ & more" }
theta_1 = 1.0
l_max = { value = 40, unit = "cm" }
k = {}
T = 0.1
Omega = 2
[coordinates]
theta1 = { start = 0.3, unit = "rad" }
phi = 0.5
x_c = { start = 0.1, unit = "m" }
lambda = { motion = "theta_1*sin(Omega*t)" }
[inputs]
F = { value = "5*sin(2*t)", unit = "N" }
[bodies.crank_a]
shape = { kind = "rod", mass = "m", length = "l_max" }
joint = { kind = "revolute", at = [0, 0], point = "start", angle = "theta1", stiffness = "k", torque = "F*l_max" }
[bodies.bar]
shape = { kind = "rod", mass = "2*m", length = "theta_1" }
joint = { kind = "revolute", on = "crank_a.end", point = "start", angle = "phi - theta1" }
[bodies.slider]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x_c" }
[bodies.table]
mass = 1
inertia = "m*l_max^2"
joint = { kind = "revolute", at = [3, 0], angle = "lambda" }
[constraints.B]
kind = "pin"
points = ["bar.end", "slider.center"]
[constraints.eq]
kind = "equation"
rate = "theta1' - 2*phi'*cos(theta1)"
[forces.push]
kind = "force"
point = "slider.center"
force = ["-F*sign(x_c')*abs(x_c)/l_max", 0]
[forces.spring]
kind = "spring"
points = ["crank_a.center", "slider.center"]
stiffness = "k"
length = "l_max"
[forces.drag]
kind = "couple"
body = "bar"
couple = "-T*phi'*max(phi', 0)^2"
[forces.pot]
kind = "potential"
energy = "k*exp(-phi)*atan2(phi, 2)/sqrt(1 + theta1^2)^3"
"""

# lengths of springs and their rates stand under roots; one spring's natural length is its length at the start
SPRINGS = """
eomgen = 1
name = "Two pendulums with springs"
space = "plane"
[parameters]
m = 1
l = 1
d = { value = 0.5, about = "distance of the pivots" }
k = 50
l0 = 0.5
b = 2
g = 9.81
[coordinates]
alpha = 0.3
beta = -0.1
[bodies.first]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], point = "start", angle = "alpha - pi/2" }
[bodies.second]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = ["d", 0], point = "start", angle = "beta - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.spring]
kind = "spring"
points = ["first.center", "second.center"]
stiffness = "k"
length = "l0"
[forces.damper]
kind = "damper"
points = ["first.center", "second.center"]
damping = "b"
[forces.other]
kind = "spring"
points = ["first.end", "second.end"]
stiffness = "k"
length = "start"
"""


LOOSE = ("balancing_robot", "delta_robot", "foucault_pendulum", "loop")
"""Models in which nothing holds a body, or a force acts at no place: they have no kineto-statics."""


@cache
def equations(name: str, method: str = "lagrange") -> Equations:
    """The equations of a model by its name, derived once in a process; see `model_called`."""
    return derive(model_called(name), method)


@cache
def entries(name: str) -> dict[str, Any]:
    """What the derivation of a model carries as JSON, through text and back."""
    return json.loads(json.dumps(equations(name).entries()))


def model_path(name: str) -> Path:
    """Where a model of models/ stands, by its file's stem."""
    return next(path for path in PATHS if path.stem == name)


@cache
def answers(path: Path) -> Answers:
    """What `solve` answers of a model of models/, once in a process."""
    return solve(loaded(path))


@cache
def loaded(path: Path) -> Model:
    """A model of models/, read once in a process: it is frozen."""
    return load(path)


@cache
def moving() -> tuple[Path, ...]:
    """Models that have equations of motion, so many that they hold each feature twice; in the slow run all of them.

    Where a force is asked for there is rest, and no motion.
    """
    known = usual_models(path for path in PATHS if "unknowns" not in declared(path))
    return tuple(path for path in known if not loaded(path).unbuilt)


def model_called(name: str) -> Model:
    """A model by its file's stem; LOOP; SPRINGS; or "chain5", long enough to need named sub-expressions."""
    if name in ("loop", "springs"):
        return loads(LOOP if name == "loop" else SPRINGS)
    if name == "chain5":
        return loads(runpy.run_path(str(MODELS / "chain.py"))["chain"](5))
    return loaded(model_path(name))


def derivable() -> tuple[str, ...]:
    """The stems of the models of `moving`, and those written here."""
    return ("loop", "springs", "chain5", *(path.stem for path in moving()))


def by_every_method() -> tuple[tuple[str, str], ...]:
    """(model, method) of everything derivable, by energies all, by the other methods a fourth, in the slow run all.

    What nothing holds has no kineto-statics. How a model reads by a method is proven with each derivation besides.
    """
    energies, *others = METHODS
    requested = set(usual(derivable(), 4))
    pairs = ((name, method) for name in derivable() for method in (energies, *(others if name in requested else ())))
    return tuple(pair for pair in pairs if pair[0] not in LOOSE or pair[1] != "kinetostatic")


def by_methods() -> tuple[tuple[str, str], ...]:
    """The same, large models by one method alone."""
    return tuple((name, method) for name, method in by_every_method() if name not in LARGE or method == "lagrange")


def read_back(text: str, equations: Equations, also: dict[str, Scalar] | None = None) -> Scalar:
    """A printed expression as a scalar of the equations' own graph; `lam(constraint, row)` is a multiplier.

    Cases are printed one after the other, a where x <= y; b otherwise, and by to_text as two functions more than the
    grammar has: select(less_equal(x, y), a, b).
    """
    *cases, last = text.split("; ")
    if cases:
        value, x, relation, y = re.fullmatch(r"(.*?)(?: else)? where (.*) (<=?) (.*)", cases[0]).groups()
        if_true, low, high = (read_back(part, equations, also) for part in (value, x, y))
        otherwise = read_back("; ".join([*cases[1:], last]), equations, also)
        graph = equations.graph.symbols.graph
        return graph.select(graph.call({"<": "less", "<=": "less_equal"}[relation], low, high), if_true, otherwise)
    text = last.removesuffix(" otherwise")
    symbols = equations.graph.symbols
    free = free_system(equations).symbols
    own = (symbols.t, *symbols.parameters.values(), *symbols.inputs.values(), *symbols.q, *free.u, *free.a)
    own += (*symbols.u, *symbols.a, *symbols.z)
    names: dict[str, Any] = {symbol.name: symbol for symbol in own}
    multipliers = {symbol.name: symbol for symbol in symbols.lam}
    expression = parse(text, references=True, longest=2_000_000)
    given = {name: x for name, x in equations.system.scope.names.items() if name.endswith("'")}
    lookup = {**given, **names, "pi": symbols.graph.pi, **(also or {})}

    def called(call: Call) -> Scalar:
        if str(call) in multipliers:
            return multipliers[str(call)]
        args = [lookup[x.name] if isinstance(x, Reference) else x.evaluate(lookup, call=called) for x in call.args]
        graph = symbols.graph
        return graph.select(*args) if call.name == "select" else graph.call(call.name, *args)

    return expression.evaluate(lookup, call=called)


def at_unit_norms(equations: Equations, pairs: Sequence[tuple[Scalar, Scalar]]) -> list[tuple[Scalar, Scalar]]:
    """The pairs where every quaternion has norm 1: its points by their stereographic image."""
    found: dict[Node, Scalar] = {}
    for e0, *others in equations.system.scope.quaternions:
        square = sum((e * e for e in others), start=0)
        found |= {e0: over(1 - square, 1 + square)} | {e: over(2 * e, 1 + square) for e in others}
    return [substituted(pair, found) for pair in pairs] if found else list(pairs)


def in_time(equations: Equations) -> Document:
    """The derivation with what is driven as functions of time, in the symbols of the equations."""
    if equations.in_print is equations.graph:
        return equations.derivation
    if id(equations) not in _IN_TIME:
        _IN_TIME[id(equations)] = equations, derivation_of(equations.graph, equations.method)
    return _IN_TIME[id(equations)][1]


_IN_TIME: dict[int, tuple[Equations, Document]] = {}  # equations are told apart by what they are: no hash looks at all


def free_system(equations: Equations) -> System:
    """The system in whose rates the steps may be written: those of dependent coordinates too."""
    return equations.system.free or equations.system


def residuals(equations: Equations) -> list[Scalar]:
    """M a + c - Q - J^T lam of each speed."""
    graph = equations.graph
    rows = []
    for k in range(len(graph.symbols.u)):
        row = sum((m * a for m, a in zip(graph.M[k], graph.symbols.a, strict=True)), start=graph.c[k] - graph.Q[k])
        constraints = (J[k] * lam for J, lam in zip(graph.J, graph.symbols.lam, strict=True))
        rows.append(row - sum(constraints, start=0))
    return rows


def symbols_named(equations: Equations) -> dict[str, Node]:
    """Every symbol of the equations by its name."""
    s, free = equations.graph.symbols, free_system(equations).symbols
    own = (s.t, *s.parameters.values(), *s.inputs.values(), *s.q, *free.u, *free.a, *s.u, *s.a, *s.z, *s.lam)
    return {symbol.name: symbol for symbol in own}
