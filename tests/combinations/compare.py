"""The product against the oracle on one model: what every function that leaves says, at consistent states.

Each fault is a line: (kind, what differs, by how much).
"""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any

import laws
import numpy as np
from declared import NotCovered
from oracle import NoAnswer, Oracle, State

import eomgen

CLOSE = 1e-6


@dataclass
class Found:
    """What a comparison found: faults, and how many numbers were looked at."""

    faults: list[tuple[str, str]] = field(default_factory=list)
    numbers: int = 0
    skipped: list[str] = field(default_factory=list)

    def same(self, kind: str, what: str, got: Any, want: Any, scale: float = 1.0, close: float = CLOSE) -> None:
        got, want = float(got), float(want)
        self.numbers += 1
        if not np.isfinite(want):
            self.skipped.append(f"{kind} {what}: the oracle has no number")
        elif not abs(got - want) <= close * (scale + abs(want)):
            self.faults.append((kind, f"{what}: {got!r} where the oracle has {want!r}"))


def filled(text: str) -> str:
    """The model with numbers for parameters that have none."""
    import re
    import tomllib

    for name, x in tomllib.loads(text).get("parameters", {}).items():
        if isinstance(x, dict) and "value" not in x:
            inside = re.search(rf"^{name} = \{{(.*)\}}$", text, re.M)
            assert inside is not None
            rest = inside[1].strip()
            text = text.replace(inside[0], f"{name} = {{ value = 1.3{', ' + rest if rest else ''} }}")
    return text


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    with warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield


def states(oracle: Oracle, e: Any, x0: np.ndarray, seed: int, count: int = 2) -> Iterator[tuple[str, State]]:
    """The start, and states near it that keep every constraint."""
    nq = len(e.coordinates)
    start = oracle.of_speeds(0.0, x0[:nq], e.speeds, x0[nq:])
    yield "start", start
    rng = Random(seed)
    v0 = start.v
    for k in range(count):
        t = round(0.37 * (k + 1), 3)
        q = x0[:nq] + np.array([rng.uniform(-0.15, 0.15) for _ in range(nq)])
        v = v0 + np.array([rng.uniform(-0.8, 0.8) for _ in range(nq)])
        try:
            z = start.z + np.array([rng.uniform(-0.5, 0.5) for _ in start.z])
            yield f"t = {t}", replace(oracle.consistent(t, q, v, oracle.closed_at_start()), z=z)
        except NoAnswer:
            continue


@dataclass(frozen=True)
class Product:
    """What the product says of a model: its equations and its right-hand sides by language."""

    text: str
    equations: Any
    functions: dict[str, Any]


def product_of(text: str, targets: tuple[str, ...] = ("numpy",)) -> Product:
    text = filled(text)
    with quiet():
        e = eomgen.derive(eomgen.loads(text))
        return Product(text, e, {target: e.rhs(target) for target in targets})


def of_model(text: str, seed: int, *, count: int = 2, targets: tuple[str, ...] = ("numpy",)) -> Found:
    """Right-hand side, reactions, energies of a model against the oracle."""
    return against(product_of(text, targets), seed, count)


def against(product: Product, seed: int, count: int = 2) -> Found:
    """The product's numbers held against the oracle's, at the start and at states near it that keep every
    constraint."""
    found, e = Found(), product.equations
    x0 = next(iter(product.functions.values())).x0
    if x0 is None:
        found.skipped.append("no start")
        return found
    try:
        oracle = Oracle(product.text, x0[: len(e.coordinates)])
        oracle.modes = laws.modes_at_start(oracle, x0, e)
        for name, s in states(oracle, e, x0, seed, count):
            _at(found, name, s, oracle, e, product.functions)
    except (NoAnswer, NotCovered, laws.NoSliding, laws.NoStrand) as no:
        found.skipped.append(f"oracle: {type(no).__name__} {no}")
    return found


def _at(found: Found, name: str, s: State, oracle: Oracle, e: Any, functions: dict) -> None:
    solved = oracle.solve(s)
    if solved.sticks:
        found.skipped.append("a contact sticks: code has friction by the law of sliding, runs and `solve` stick")
        return
    if any(
        oracle.modes[constraint] and not laws.agrees(constraint, oracle, s, solved)
        for constraint in solved.pressed
        if constraint in oracle.modes
    ):
        found.skipped.append("a contact that rubs and can end would have to pull: it is not closed there")
        return
    u, du = oracle.speeds_of(s, e.speeds, solved.a)
    x = np.concatenate([s.q, u, s.z])
    now = oracle.maximal(s)
    inputs = [oracle.model.input(i, now) for i in e.inputs]
    p = next(iter(functions.values())).p0
    unsure = [q for q, sure in zip(oracle.names, solved.sure, strict=True) if not sure]
    if unsure:
        raise NoAnswer(f"no single acceleration of {', '.join(unsure)}")
    size = 1.0 + 1e-3 * float(np.max(np.abs(du), initial=0.0))
    names = [*e.coordinates, *e.speeds, *e.states]
    want = [*s.v, *du, *oracle.state_rates(s, solved.a)]
    for target, rhs in functions.items():
        with quiet():
            got = rhs(s.t, x, p, inputs)
        for label, a, b in zip(names, got, want, strict=True):
            found.same("acceleration", f"{label}' at {name} by {target}", a, b, size)
    _reactions(found, name, s, oracle, e, solved, (s.t, x, p, inputs))
    _energies(found, name, s, oracle, e, (s.t, x, p, inputs))


def _reactions(found: Found, name: str, s: State, oracle: Oracle, e: Any, solved: Any, at: tuple) -> None:
    try:
        with quiet():
            function = e.reaction_rhs("numpy")
            got = dict(zip(function.names, function(*at), strict=True))
    except eomgen.EomgenError as no:
        found.skipped.append(f"reactions: {str(no).splitlines()[0][:100]}")
        return
    try:
        want = oracle.reactions(solved, s)
    except NoAnswer as no:
        found.skipped.append(f"oracle's reactions: {no}")
        return
    size = 1.0 + 1e-3 * max((abs(x) for x in want.values()), default=0.0)
    for key in sorted(want.keys() & got.keys()):
        found.same("reaction", f"{key} at {name}", got[key], want[key], size)


def _energies(found: Found, name: str, s: State, oracle: Oracle, e: Any, at: tuple) -> None:
    from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

    t, x, p, inputs = at
    g = e.graph.symbols
    known = dict(
        zip((g.t, *g.parameters.values(), *g.x, *g.inputs.values()), map(float, (t, *p, *x, *inputs)), strict=True)
    )
    T, V = oracle.energy(s)
    got = evaluate((e.graph.T, e.graph.V), known, FLOAT)
    found.same("energy", f"T at {name}", got[0], T)
    if V is not None:
        found.same("energy", f"V at {name}", got[1], V)
