"""What several verbs say of one quantity is one number, and it is the oracle's.

At the start: `solve`, `reactions`, `reaction_rhs` and the first row of a run; along a run: its columns; small motions
against differences of the oracle; inverse dynamics; the right-hand side in C and JavaScript.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import impacts
import laws
import numpy as np
from compare import Found, Product, quiet
from declared import NotCovered
from oracle import NoAnswer, Oracle, Solved, State

import eomgen

NO = (NoAnswer, NotCovered, laws.NoSliding, laws.NoStrand)


def across(product: Product, *, languages: tuple[str, ...] = (), parts: tuple[str, ...] = ()) -> Found:
    """The verbs of one model against the oracle and so against one another.

    Args:
        parts: which of PARTS, () for all.
    """
    return _parts(product, [PARTS[part] for part in parts or PARTS] + [LANGUAGES[name] for name in languages])


def _parts(product: Product, parts: list[Any]) -> Found:
    found, e = Found(), product.equations
    x0 = next(iter(product.functions.values())).x0
    if x0 is None:
        return found
    n = len(e.coordinates)
    try:
        oracle = Oracle(product.text, x0[:n])
        oracle.modes = laws.modes_at_start(oracle, x0, e)
        s = oracle.of_speeds(0.0, x0[:n], e.speeds, x0[n:])
        solved = oracle.solve(s)
    except NO as no:
        found.skipped.append(f"oracle: {no}")
        return found
    for part in parts:
        try:
            with quiet():
                part(found, e.model, product, oracle, s, solved)
        except eomgen.EomgenError as no:
            found.skipped.append(f"{part.__name__[1:]}: {str(no).splitlines()[0][:120]}")
        except NO as no:
            found.skipped.append(f"oracle in {part.__name__[1:]}: {no}")
    return found


def expected(oracle: Oracle, s: State, solved: Solved) -> dict[str, float]:
    """Everything that the oracle says at a state, by the names of columns."""
    said = {f"acc_{q}": float(a) for q, a, sure in zip(oracle.names, solved.a, solved.sure, strict=True) if sure}
    said |= {f"rate_{z}": float(x) for z, x in zip(oracle.model.states, oracle.state_rates(s, solved.a), strict=True)}
    return said | oracle.reactions(solved, s)


def kinematic(oracle: Oracle, s: State, solved: Solved) -> dict[str, float]:
    """Outputs that are functions of the motion, by the oracle's own poses."""
    now, said = oracle.reduced(s, solved.a), {}
    for name, text in oracle.model.outputs.items():
        if isinstance(text, str) and text.startswith(("x(", "vy(", "speed(", "ax(", "angle(", "omega_z(")):
            said[name] = float(now.value(text).c[0][0])
        if text == "kinetic_energy()":
            said[name] = oracle.energy(s)[0]
        if text == "power()":
            said[name] = sum(oracle.power(s).values())
    return said


def _answers(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    want = expected(oracle, s, solved) | kinematic(oracle, s, solved)
    for name, answer in eomgen.solve(model).items():
        if name in want and answer.value is not None:
            found.same("solve", f"{name} at the start", answer.value, want[name], _size(want))


def _size(want: dict[str, float]) -> float:
    return 1.0 + 1e-3 * max((abs(x) for x in want.values()), default=0.0)


def _reactions(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    want = oracle.reactions(solved, s)
    for name, reported in eomgen.reactions(model).items():
        if name in want and reported.value is not None:
            found.same("reactions", f"{name} at the start", reported.value, want[name], _size(want))


def _run(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    """Columns of a run at the states that it visits."""
    run = eomgen.simulate(model, time=0.6, samples=4)
    columns = run.columns()
    n = len(run.coordinates)
    energy: list[tuple[float, float]] = []
    for i, t in enumerate(run.t):
        x = run.x[i]
        try:  # with what is closed at the start, which may determine dependent rates
            here = oracle.of_speeds(float(t), x[:n], run.speeds, x[n:], loose=1e-5)
        except NoAnswer:
            if not oracle.modes:
                raise
            here = oracle.of_all_rates(float(t), x[:n], run.speeds, x[n:])
        reported = oracle.contacts(here) if oracle.modes else oracle.solve(here)
        want = expected(oracle, here, reported) | kinematic(oracle, here, reported)
        at = Found()
        for name in sorted(want.keys() & columns.keys()):
            got = columns[name][i]
            if not np.isfinite(got):
                found.skipped.append(f"run: {name} is nan")
                continue
            at.same("run", f"{name} at t = {t:.3g}", got, want[name], 10 * _size(want))
        if at.faults and _beyond(oracle, here, reported, columns, i):
            found.skipped.append(f"run at t = {t:.3g}: on the other side of a switch")
            at.faults.clear()
        found.numbers += at.numbers
        found.faults += at.faults
        T, V = oracle.energy(here)
        if V is not None and "energy" in columns:
            energy.append((float(columns["energy"][i]), T + V))
    for got, want_E in energy[1:]:
        found.same("run", "energy against the start's", got - energy[0][0], want_E - energy[0][1], 1 + abs(want_E))


def _impacts(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    """Impacts of a run at a contact with friction: by Routh's graph; in the cone; no energy gained but by Newton."""
    law = (oracle.model.impact or {}).get("law", "poisson")
    rough = [x for x, c in oracle.model.constraints.items() if "restitution" in c and "friction" in c]
    if not rough or oracle.model.impact is None:
        return
    run, n = eomgen.simulate(model, time=0.6, samples=4), len(oracle.names)
    begun = {phase.start: phase for phase in run.phases}
    for impact in run.impacts:
        if impact.contact not in rough:
            continue
        name, at = impact.contact, f"at t = {impact.t:.3g}"
        ended = next(phase for phase in run.phases if phase.end == impact.t)
        states = []
        for edge in (ended.last, begun[impact.t].first):
            x = np.array([edge[x] for x in run.moving])
            states.append(oracle.of_all_rates(impact.t, x[:n], run.speeds, x[n:]))
        one, two = states
        along = [x for key, x in impact.impulses.items() if key.startswith(f"{name} t")]
        p_n, mu = impact.impulses[name], oracle.model.number(oracle.model.constraints[name]["friction"])
        if p_n < 0 or np.linalg.norm(along) > mu * p_n * (1 + 1e-9) or (law != "newton" and impact.loss < -1e-9):
            found.faults.append(("impact", f"{impact} is outside its cone, or gains energy"))
        T = [oracle.energy(each)[0] for each in states]
        found.same("impact", f"loss {at}", impact.loss, T[0] - T[1], 1 + abs(T[0]), 1e-6)
        if begun[impact.t].model.configuration.modes[name].closed:
            found.skipped.append(f"impact {at}: it rests")
            continue
        want, p = impacts.after(oracle, one, name, law)
        size = float(np.max(np.abs(one.v))) + 1e-3
        for q, a, b in zip(oracle.names, two.v, want.v, strict=True):
            found.same("impact", f"{q}' after {at}", a, b, size, 1e-5)
        found.same("impact", f"{name} {at}", p_n, p[0], p[0], 1e-5)
        found.same("impact", f"friction of {name} {at}", np.linalg.norm(along), np.linalg.norm(p[1:]), p[0], 1e-5)


def _beyond(oracle: Oracle, s: State, solved: Solved, columns: Any, i: int) -> bool:
    """Whether a row of a run holds the values of one side of its instant, where a law or a path changes its piece.

    f(t +- 0) = 2 f(t +- h) - f(t +- 2h): as close as elsewhere, however fast f changes.
    """
    for h in (1e-6, -1e-6):
        one, two = (_expected_beside(oracle, s, solved, dt) for dt in (h, 2 * h))
        want = {name: 2 * one[name] - two[name] for name in one.keys() & two.keys()}
        beside = Found()
        for name in sorted(want.keys() & columns.keys()):
            if np.isfinite(columns[name][i]):
                beside.same("run", name, columns[name][i], want[name], 10 * _size(want))
        if not beside.faults:
            return True
    return False


def _expected_beside(oracle: Oracle, s: State, solved: Solved, dt: float) -> dict[str, float]:
    """Everything that the oracle says a little before or after a state, on its motion."""
    z = s.z + dt * oracle.state_rates(s, solved.a)
    near = State(s.t + dt, s.q + dt * s.v + dt**2 / 2 * solved.a, s.v + dt * solved.a, z)
    reported = oracle.contacts(near) if oracle.modes else oracle.solve(near)
    return expected(oracle, near, reported) | kinematic(oracle, near, reported)


def _small(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    """Eigenvalues of the small motions against those of the oracle's differences."""
    if (
        not oracle.stands()
        or oracle.modes
        or any(
            "rate" in constraint
            or (constraint["kind"] in ("rolling", "skate", "motion", "gear") and not constraint.get("slip"))
            for constraint in oracle.model.constraints.values()
        )
    ):
        return
    reported = eomgen.linearize(model).as_dict()
    at = {name: x["value"] for name, x in reported["state"].items()}
    at |= {q: float(oracle.model.driven_at(q, 0.0)[0]) for q in oracle.model.driven}
    if any(name not in at for name in (*oracle.names, *oracle.model.states)):
        return
    A = oracle.small(*(np.array([at[name] for name in names]) for names in (oracle.names, oracle.model.states)))
    own = np.array([complex(*x) for x in reported["eigenvalues"]])
    if len(own) != len(A):
        found.skipped.append("linearize: other states")
        return
    scale = max(1.0, float(np.max(np.abs(own))))
    got, want = np.poly(own / scale), np.poly(A / scale)
    for k, (a, b) in enumerate(zip(got, want, strict=True)):
        found.same("linearize", f"coefficient {k} of the characteristic polynomial", np.real(a), np.real(b), 1.0, 1e-4)


def _inverse(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    """tau of given accelerations: of all that is free, with constraints along what these leave free."""
    e = product.equations
    if oracle.model.speeds or oracle.modes or not {f"{q}'" for q in oracle.names} >= set(e.speeds):
        return
    a, actuated = oracle.other_accelerations(s, solved)
    inverse = e.inverse_dynamics(actuated if oracle.model.constraints else ())
    x, p, inputs = _given(product, oracle, s)
    got = inverse.function("numpy")(0.0, x, [a[oracle.names.index(u[:-1])] for u in e.speeds], p, inputs)
    want = oracle.wanted(s, a, actuated)
    size = 1.0 + 1e-3 * max((abs(x) for x in want.values()), default=0.0)
    for q, tau in zip(inverse.tau, got, strict=True):
        if q in want:
            found.same("inverse dynamics", f"tau of {q}", tau, want[q], size)


def _right(found: Found, language: str, got: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    e = product.equations
    if solved.sticks:
        return  # code has friction by the law of sliding
    _, du = oracle.speeds_of(s, e.speeds, solved.a)
    want = [*s.v, *du, *oracle.state_rates(s, solved.a)]
    size = 1.0 + 1e-3 * float(np.max(np.abs(du), initial=0.0))
    for k, (a, b) in enumerate(zip(got, want, strict=True)):
        found.same("code", f"dx[{k}] at the start by {language}", a, b, size)


def _given(product: Product, oracle: Oracle, s: State) -> tuple[Any, Any, list[float]]:
    e = product.equations
    u, _ = oracle.speeds_of(s, e.speeds)
    now = oracle.maximal(s)
    p = next(iter(product.functions.values())).p0
    return np.concatenate([s.q, u, s.z]), p, [oracle.model.input(i, now) for i in e.inputs]


def _c(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    x, p, inputs = _given(product, oracle, s)
    _right(found, "C", product.equations.rhs("c")(0.0, x, p, inputs), product, oracle, s, solved)


def _javascript(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    node = shutil.which("node")
    if node is None:
        return
    x, p, inputs = _given(product, oracle, s)
    with tempfile.TemporaryDirectory() as folder:
        eomgen.generate(model, ("javascript",)).write(folder)
        module = next(Path(folder).glob("*_rhs.mjs"))
        say = (
            f'import {{ evaluate, constants }} from "{module}";'
            f"const p = {json.dumps(list(map(float, p)))};"
            f"console.log(JSON.stringify([...evaluate(0, {json.dumps(list(map(float, x)))}, p, constants(p),"
            f" {json.dumps(inputs) if inputs else 'null'})]));"
        )
        script = Path(folder) / "ask.mjs"
        script.write_text(say)
        reported = subprocess.run([node, str(script)], capture_output=True, text=True, timeout=60, check=False)
    if reported.returncode:
        found.faults.append(("code", f"JavaScript: {reported.stderr.strip().splitlines()[-1][:200]}"))
        return
    _right(found, "JavaScript", json.loads(reported.stdout), product, oracle, s, solved)


def _as_part(found: Found, model: Any, product: Product, oracle: Oracle, s: State, solved: Solved) -> None:
    """The model as a part of another file, on the ground as it is: the same rates of the same state."""
    rhs = product.functions["numpy"] if "numpy" in product.functions else next(iter(product.functions.values()))
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "part.toml").write_text(product.text)
        text = f'eomgen = 1\nspace = "{model.space}"\n[parts.P]\nfile = "part.toml"\n'
        whole = eomgen.derive(eomgen.loads(text, str(Path(folder) / "whole.toml"))).rhs("numpy")
    inputs = [oracle.model.input(i, oracle.maximal(s)) for i in product.equations.inputs]
    ours, theirs = (np.asarray(each(0.0, each.x0, each.p0, inputs)) for each in (rhs, whole))
    size = 1.0 + float(np.max(np.abs(ours), initial=0.0))
    for k, (a, b) in enumerate(zip(theirs, ours, strict=True)):
        found.same("as a part", f"rate {k} at the start", a, b, size)


PARTS = {
    "answers": _answers,
    "reactions": _reactions,
    "run": _run,
    "impacts": _impacts,
    "small motions": _small,
    "inverse": _inverse,
    "as a part": _as_part,
}
LANGUAGES = {"c": _c, "javascript": _javascript}
