"""Model, instant -> CutState: the bodies cut free, with numbers for every reaction and all that acts on each.

In motion the accelerations are those of the equations of motion, and the reactions follow from the equations of the
bodies with them; at rest both follow from the balance alone, unknown loads too. A parameter without a value is taken
as 1: places and directions are then drawn for that ratio of lengths, and no value leaves.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide
from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Balance, CutForce, ForceKind, NamedReaction
from eomgen.model import AtRest, Model, WrittenEquation
from eomgen.simulation import ReactionColumns
from eomgen.study.motion import MotionFromStart, StateAtInstant, StateInNumbers
from eomgen.study.study import Study, study_at_rest, study_of, study_of_modes
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import FLOAT, evaluate, numbers_of, tolerances

STAYING = (ForceKind.REACTION, ForceKind.SPRING, ForceKind.DAMPER, ForceKind.DRIVE)  # listed where they are 0
NOISE = 10 * tolerances.ROUNDING  # of the largest, which rounding leaves of a 0


@dataclass(frozen=True)
class CutState:
    """The bodies of a model at one instant.

    Args:
        study: of the contacts as they are then.
        drawn: t, q, u, z and the parameters.
        when: the instant in words.
        rests: nothing moves, and the balance alone gives all reactions.
    """

    study: Study
    drawn: StateInNumbers
    when: str
    rests: bool

    @property
    def system(self) -> System:
        return self.study.system

    @cached_property
    def balance(self) -> Balance:
        """The equations of the bodies.

        Raises:
            DerivationError: something acts at no place.
        """
        return self.study.reactions.balance

    @cached_property
    def begun(self) -> dict[Node, float]:
        """Values of t, q, u and the parameters."""
        symbols = self.system.symbols
        x = dict(zip(symbols.x, map(float, self.drawn.x), strict=True))
        p = dict(zip(symbols.parameters.values(), map(float, self.drawn.p), strict=True))
        return {symbols.t: self.drawn.t, **x, **p}

    @cached_property
    def known(self) -> dict[Node, float]:
        """The same with inputs, accelerations, and the unknowns of loads."""
        symbols, values = self.system.symbols, dict(self.begun)
        inputs = {node: self.system.inputs[name] for name, node in symbols.inputs.items()}
        values |= _numbers(inputs, values)
        if not self.rests:
            return values | dict(zip(symbols.a, self._accelerations, strict=True))
        reactions = self.study.reactions
        values |= dict.fromkeys((*symbols.u, *symbols.a), 0.0)
        values |= _numbers({x: y for x, y in reactions.at.items() if x not in symbols.parameters.values()}, values)
        return values | _numbers(reactions.unknowns, values)

    @property
    def begun_with_unknowns(self) -> dict[Node, float]:
        """Values of t, q, u, the parameters and the unknowns of loads."""
        return {**self.begun, **{x: self.known[x] for x in self.system.symbols.unknowns.values() if x in self.known}}

    @cached_property
    def components(self) -> tuple[float | None, ...]:
        """Every component of the reactions; None of one that has no single value."""
        reactions = self.study.reactions
        count, solution = len(reactions.components), reactions.solution
        single = [solution.determined(j) for j in range(count)]
        if self.rests:
            found = _numbers({j: solution.constants[j] for j in range(count) if single[j]}, self.known)
            return tuple(found.get(j) for j in range(count))
        given = tuple(NamedReaction(c.name, c.owner, c.unit, {j: 1}) for j, c in enumerate(reactions.components))
        columns = ReactionColumns(reactions, self._right_hand_side, given)
        t, x, p = np.array([self.drawn.t]), self.drawn.x[None, :], self.drawn.p
        values = columns.along(t, x, p)[0] if given else np.zeros(0)
        return tuple(float(v) if one and np.isfinite(v) else None for v, one in zip(values, single, strict=True))

    def numbers(self, scalars: Sequence[Scalar]) -> list[float]:
        """Values of scalars there."""
        return numbers_of(scalars, self.known)

    @cached_property
    def forces(self) -> tuple[NumberedForce, ...]:
        """All that acts, in numbers, at the parameters as they are drawn; what is nothing there is left out.

        Raises:
            DerivationError: something acts at no place.
        """
        pushes = CutForce.on_bodies(self.balance)
        flat: list[Scalar] = []
        for push in pushes:
            flat += [*push.at, *push.direction, *(push.along or Vector.ZERO), push.given, *push.shares.values()]
        numbers = iter(self.numbers(flat))
        made = _with_resultants([_numbered(push, numbers, self.components) for push in pushes])
        sizes = (abs(each.value) for each in made if each.value is not None)
        noise = NOISE * max(sizes, default=0.0)
        quiet = [replace(e, value=0.0) if e.value is not None and abs(e.value) <= noise else e for e in made]
        shown = (each for each in quiet if each.value != 0 or each.stays)
        return tuple(replace(each, at=_plain(each.at), direction=_plain(each.direction)) for each in shown)

    @cached_property
    def _right_hand_side(self) -> RightHandSide:
        return RightHandSide.of(self.study.program, "numpy")

    @property
    def _accelerations(self) -> Iterable[float]:
        symbols = self.system.symbols
        if not symbols.u:
            return ()
        rates = self._right_hand_side(self.drawn.t, self.drawn.x, self.drawn.p)
        return [float(x) for x in rates[len(symbols.q) :][: len(symbols.u)]]


def _numbers(scalars: Mapping[Any, Scalar], known: Mapping[Node, float]) -> dict[Any, float]:
    return dict(zip(scalars, map(float, evaluate(tuple(scalars.values()), known, FLOAT)), strict=True))


@dataclass(frozen=True)
class NumberedForce:
    """A push in numbers, ground axes.

    Args:
        at: 3 [m].
        direction: unit vector, 3; zeros where there is none.
        value: along it; None where it has no single value.
    """

    push: CutForce
    at: np.ndarray
    direction: np.ndarray
    value: float | None

    @property
    def stays(self) -> bool:
        """True if it is listed where it is 0: a reaction, a spring, a damper."""
        return self.push.kind in STAYING and bool(np.any(self.direction))


def _numbered(push: CutForce, numbers: Iterator[float], components: Sequence[float | None]) -> NumberedForce:
    at, vector, along = (np.array(list(islice(numbers, 3))) for _ in range(3))
    value: float | None = next(numbers)
    for j, share in zip(push.shares, islice(numbers, len(push.shares)), strict=True):
        known = components[j]
        value = None if value is None or known is None else value + share * known
    line = along if np.any(along) else vector
    length = float(np.linalg.norm(line))
    unit = line / length if length > 0 and math.isfinite(length) else np.zeros(3)
    size = float(vector @ unit)
    value = None if value is None or not math.isfinite(value * size) else value * size
    return NumberedForce(push, at, unit, value)


def _with_resultants(pushes: Sequence[NumberedForce]) -> list[NumberedForce]:
    """The pushes, with one force for the two that replace a load along a line, where these have one direction."""
    found: list[NumberedForce] = []
    for each in pushes:
        twin = found[-1] if found and each.push.spread and found[-1].push.spread else None
        if twin is not None and (twin.push.name, twin.push.body) == (each.push.name, each.push.body):
            a, b = twin.value or 0.0, each.value or 0.0
            if a + b > 0 and min(a, b) >= 0 and np.allclose(twin.direction, each.direction, atol=tolerances.COMPUTED):
                found[-1] = replace(twin, at=(a * twin.at + b * each.at) / (a + b), value=a + b)
                continue
        found.append(each)
    return found


def _plain(numbers: np.ndarray) -> np.ndarray:
    """Numbers without what rounding leaves."""
    return np.where(np.abs(numbers) < NOISE, 0.0, numbers)


def cut_state(model: Model, at: WrittenEquation | AtRest | None = None) -> CutState:
    """The bodies of a model at its start, where an equation is first met, or in equilibrium.

    Raises:
        MissingValues: an instant of a model whose parameters have no values.
        DerivationError, RunFailed: there is no such instant.
    """
    if model.unknowns_in_loads():
        study = study_of_modes(model)
        return CutState(study, StateInNumbers.at_start(study.system), "at rest", True)
    if at is None:
        return _at_start(model)
    if isinstance(at, AtRest):
        moment, when = StateAtInstant.resting(study_at_rest(model)), "in equilibrium"
    else:
        moment, when = MotionFromStart(model, at_rest=False).until(at), f"when {at.text}"
    system, missing = moment.phase.system, [name for name in model.parameters if name not in model.exact_parameters()]
    if missing or not moment.numbers:
        raise MissingValues(tuple(missing) or ("the parameters",))
    numbers = {**moment.phase.numeric_parameters, **moment.numbers}
    return CutState(moment.phase, StateInNumbers.of(system, numbers), when, False)


def _at_start(model: Model) -> CutState:
    missing = any(name not in model.exact_parameters() for name in model.parameters)
    study = study_of(model) if missing or not model.has_phases else MotionFromStart(model, at_rest=False).phase
    driven = any(part.driven for part in model.coordinates.values()) or bool(model.driving_constraints)
    rests = not study.system.symbols.u and not driven
    if not rests and not driven:
        rests = _stands(study.system)
    return CutState(study, StateInNumbers.at_start(study.system), "at rest" if rests else "at the start", rests)


def _stands(system: System) -> bool:
    """True if the constraints leave no degree of freedom."""
    try:
        return not system.has_degrees_of_freedom
    except (DerivationError, MissingValues):
        return False
