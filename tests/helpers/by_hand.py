"""Systems beside laws written down by hand: numpy and mpmath alone, no line of the product in the expected numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import mpmath
import numpy as np
import pytest

import eomgen

EXACT, RUN = 1e-10, 2e-7  # relative to the largest number of its kind: of an instant, of a run at rtol 1e-9
GRAVITY = {"plane": '[0, "-g"]', "space": '[0, 0, "-g"]'}

Numbers = Mapping[str, float]
Place = tuple[float, float, float]  # mass centre x, y and angle of a body in the plane


@dataclass(frozen=True)
class Known:
    """What the law says: of `solve`, of `reactions` at the start, of `linearize`, and of a run at its end."""

    outputs: Numbers = field(default_factory=dict)
    reactions: Numbers = field(default_factory=dict)
    frequencies: Sequence[float] = ()
    time: float = 0.0
    run: Numbers = field(default_factory=dict)


@dataclass(frozen=True)
class Case:
    """A model file and the law, to be worked out when its test runs."""

    text: str
    law: Callable[[], Known]


class Collection(dict[str, Case]):
    """The systems of one file by name; a name for each set of numbers."""

    def system(self, space: str, text: str, parameters: dict, *variants: dict) -> Callable:
        """Takes in a system under the name of its law, which is called with the parameters as numbers."""

        def known(law: Callable[..., Known]) -> Callable[..., Known]:
            for variant in variants or ({},):
                given = parameters | variant
                name = " ".join([law.__name__, *(f"{key}={value}" for key, value in variant.items())])
                numbers = {key: number(value) for key, value in given.items()}
                self[name] = Case(model_text(law.__name__, space, given, text), lambda n=numbers: law(**n))
            return law

        return known


def number(value: float | str) -> float:
    """A parameter as a number: 0.5, "pi/6", "-pi/4", "2*pi/3"."""
    return float(mpmath.mpmathify(eval(value, {"pi": mpmath.pi}))) if isinstance(value, str) else float(value)


def model_text(name: str, space: str, parameters: dict, text: str) -> str:
    """The whole file; weights act where the parameters have a g."""
    lines = [f'"{key}" = {f"{value!r}".replace(chr(39), chr(34))}' for key, value in parameters.items()]
    head = f'eomgen = 1\nname = "{name}"\nspace = "{space}"\n[parameters]\n' + "\n".join(lines) + "\n"
    weight = f'[forces.weight]\nkind = "gravity"\nacceleration = {GRAVITY[space]}\n' if "g" in parameters else ""
    return head + text + weight


def agree(case: Case) -> None:
    """Every verb that the law speaks of says the same, and none of them doubts its own proof."""
    model, known = eomgen.loads(case.text), case.law()
    if known.outputs:
        answers = eomgen.solve(model)
        assert answers.keys() == known.outputs.keys()
        assert answers.certify().ok is not False, str(answers.certify())
        same({name: answers[name].value for name in known.outputs}, known.outputs, EXACT)
    if known.reactions:
        found = eomgen.reactions(model)
        assert found.certify().ok is not False, str(found.certify())
        same({name: found[name].value for name in known.reactions}, known.reactions, EXACT)
    if len(known.frequencies):
        small = eomgen.linearize(model)
        assert small.certify().ok is not False, str(small.certify())
        found_frequencies = sorted(mode.frequency for mode in small.spectrum.modes)
        assert found_frequencies == pytest.approx(sorted(known.frequencies), rel=1e-9, abs=1e-7)
    if known.run:
        run = eomgen.simulate(model, time=known.time)
        assert run.status == "finished", run.message
        assert run.certify().ok is not False, str(run.certify())
        same({name: float(run[name][-1]) for name in known.run}, known.run, RUN)


def same(found: Numbers, expected: Numbers, tolerance: float) -> None:
    """Equal but for a part of each number, and of the largest for those that are nothing."""
    largest = max(abs(value) for value in expected.values())
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=tolerance, abs=tolerance * largest), name


def differences(path: Callable, t: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places, rates and accelerations at t of what path(t) places, by differences in 40 digits."""
    with mpmath.workdps(40):
        count = len(path(mpmath.mpf(t)))
        rows = [[mpmath.diff(lambda s, k=k: path(s)[k], t, n) for k in range(count)] for n in (0, 1, 2)]
        return tuple(np.array([float(value) for value in row]) for row in rows)  # type: ignore[return-value]


def meeting(a: tuple, r: float, b: tuple, s: float, side: int) -> tuple:
    """Where circles about a and b meet: side +1 lies left of the way from a to b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    d2 = dx * dx + dy * dy
    along = (d2 + r * r - s * s) / (2 * d2)
    across = side * mpmath.sqrt(r * r / d2 - along**2)
    return a[0] + along * dx - across * dy, a[1] + along * dy + across * dx


@dataclass(frozen=True)
class Free:
    """A body cut free: its mass, its inertia, its mass centre with its accelerations, what else acts at the centre."""

    m: float
    J: float
    G: tuple[float, float]
    a: tuple[float, float, float]
    load: tuple[float, float, float] = (0, 0, 0)


def balance(bodies: dict[str, Free], cuts: dict[str, tuple], g: float = 0.0) -> dict[str, float]:
    """The forces in the cuts from m a = sum F and J eps = sum M of every body (Newton and Euler).

    A cut is (body, other body or None, point, direction); a couple has the direction None.
    """
    names = list(bodies)
    A, b = np.zeros((3 * len(names), len(cuts))), np.zeros(3 * len(names))
    for i, body in enumerate(bodies.values()):
        inertia = np.array([body.m * body.a[0], body.m * (body.a[1] + g), body.J * body.a[2]])
        b[3 * i : 3 * i + 3] = inertia - np.array(body.load)
    for column, (on, against, point, direction) in enumerate(cuts.values()):
        for name, sign in ((on, 1), (against, -1)):
            if name is not None:
                i, G = names.index(name), bodies[name].G
                A[3 * i : 3 * i + 3, column] += sign * wrench(point, direction, G)
    return dict(zip(cuts, np.linalg.solve(A, b), strict=True))


def wrench(point: tuple, direction: tuple | None, G: tuple) -> np.ndarray:
    """Force and moment about G of a unit force at a point, or a unit couple."""
    if direction is None:
        return np.array([0.0, 0.0, 1.0])
    return np.array([*direction, (point[0] - G[0]) * direction[1] - (point[1] - G[1]) * direction[0]])
