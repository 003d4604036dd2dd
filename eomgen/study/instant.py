"""Model, instant -> its state then: places, velocities, accelerations; each body cut free, with its forces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import islice
from math import isfinite, pi
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Balance, CutForce, ForceKind, NamedReaction
from eomgen.mechanics.instant import Centrodes, InstantKinematics, KinematicState
from eomgen.mechanics.start import Start
from eomgen.model import AtRest, Model, Requests, WrittenEquation
from eomgen.simulation import ReactionColumns
from eomgen.study.motion import MotionFromStart, StateAtInstant, StateInNumbers
from eomgen.study.study import Study, exact_numbers, study_at_rest, study_of, study_of_modes
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Scalar,
    State,
    Vector,
    depends_on,
    is_zero,
    order,
    substituted,
)
from eomgen.symbolic.numeric import FLOAT, evaluate, numbers_of, tolerances
from eomgen.symbolic.print import text_size

# -------- motion at an instant --------------------------------------------------------------------------------
# Model -> KinematicState: places, velocities and accelerations at one instant, however the model gives them.
#
# A model with [given], or of bodies and constraints alone, has one configuration; its velocities follow from
# constraints and given equations. A model with coordinates is taken at its start, or where a condition is first met.

LONG = 600  # characters of a state, and of accelerations, from which numbers stand in their place


def kinematic_state(
    model: Model, at: WrittenEquation | str | None = None, given: Sequence[WrittenEquation | str] = ()
) -> KinematicState:
    """The motion of a model at an instant.

    Args:
        at: the condition that is first met then; None: the start.
        given: velocities in addition to those of the model: "omega(crank) = 2".
    Raises:
        ExpressionError: a text is no equation.
        ModelError: an equation contains unknown names.
        UsageError: an instant of a model that has no motion in time.
        DerivationError: nothing can move; more than one rate is missing; given velocities contradict one another.
    """
    model = model.with_given_velocities(tuple(Requests(model).equation(text) for text in given))
    at = None if at is None else Requests(model).equation(at)
    if model.given is None and (model.coordinates or at is not None):
        return _on_the_way(model, at)
    if at is not None:
        raise UsageError(
            "[given] speaks of one configuration: there is no other instant",
            fix="leave --at out, or move the model by coordinates",
        )
    return _of_instant_kinematics(model)


# -- one configuration, given velocities -------------------------------------------------------------


def _of_instant_kinematics(model: Model) -> KinematicState:
    instant_kinematics = InstantKinematics.of(model)
    known = instant_kinematics.velocities
    instant_kinematics.refuse_several()
    rate, symbol = instant_kinematics.open_rate, None
    if rate:
        symbol = _symbol(instant_kinematics, rate)
        instant_kinematics = instant_kinematics.assuming(rate, symbol)
    own = model.given
    given = () if own is None else (*(own.velocity or ()), *(own.acceleration or ()))
    found = KinematicState(
        instant_kinematics.system,
        instant_kinematics.moving,
        {} if rate else _accelerated(instant_kinematics),
        known.degrees_of_freedom,
        Rank(instant_kinematics.system.constraints).counted(),
        "in this configuration",
        tuple(equation.text for equation in given),
        rate,
        symbol,
        instant_kinematics.exact,
    )
    if known.degrees_of_freedom == 0 and _rests(found):
        raise DerivationError(
            f"nothing can move: {_held(model)} as a structure, with 0 degrees of freedom",
            fix="for reactions: eomgen statics MODEL; for a mechanism take a constraint away",
        )
    return found


def _held(model: Model) -> str:
    constraints = ", ".join(f"'{name}'" for name in (*model.constraints, *model.trusses))
    return f"{constraints} hold the bodies" if constraints else "the joints hold the bodies"


def _accelerated(instant_kinematics: InstantKinematics) -> State:
    """State with the accelerations; {} where constraints and given equations do not determine them all."""
    return {} if instant_kinematics.accelerations.free else instant_kinematics.state


def _symbol(instant_kinematics: InstantKinematics, rate: str) -> Node:
    """Symbol of the undetermined rate: omega_I for omega(I), vx_I for vx(I.A); with "_" where the name is taken."""
    function, _, rest = rate.removesuffix(")").partition("(")
    name = f"{function}_{rest}" if function.startswith("omega") else f"{function}_{rest.partition('.')[0]}"
    while name in instant_kinematics.system.scope.names:
        name += "_"
    return instant_kinematics.system.scope.graph.symbol(name)


def _rests(state: KinematicState) -> bool:
    """True if no body moves."""
    return all(is_zero(x) for field in state.fields.values() for x in (*field.v, *field.w))


# -- a motion in time ---------------------------------------------------------------------------------


def _on_the_way(model: Model, at: WrittenEquation | None) -> KinematicState:
    motion = MotionFromStart(model, at_rest=False)
    moment = motion.at_start if at is None else motion.until(at)
    when = "at the start" if at is None else f"when {at.text}"
    phase, exact, numbers = moment.phase, moment.exact, moment.numbers
    symbols = phase.system.symbols
    Start.refuse_lost({q: numbers[q] for q in symbols.q if q in numbers})
    needed = (*symbols.x, *([symbols.t] if _sees_time(phase) else []))
    whole = all(node in exact for node in needed) and (not numbers or sum(map(text_size, exact.values())) <= LONG)
    moving = dict(exact) if whole else exact_numbers(numbers)
    if not moving and (symbols.q or symbols.u):
        model = phase.system.scope.model
        known = model.exact_parameters()
        names = ", ".join(f"'{name}'" for name in model.parameters if name not in known) or "all parameters"
        raise DerivationError(
            f"the state has no closed form, and without values of {names} no number",
            "parameters",
            "give the parameters values",
        )
    moving = {**{symbols.t: 0}, **moving}
    phase.system.refuse_undetermined(moving, when)
    free = Rank(phase.system.constraints).degrees_of_freedom()
    count = Rank((phase.system.free or phase.system).constraints).counted()
    found = KinematicState(phase.system, moving, {}, free, count, when, exact=whole)
    if at is None and free == 1 == len(symbols.u) and _rests(found):
        (u,) = symbols.u
        return replace(found, moving={**moving, u: u}, rate=u.name, symbol=u)
    accelerated, rounded = _with_accelerations(phase, moving, numbers)
    equations = phase.equations if accelerated else None
    return replace(found, accelerated=accelerated, rounded=rounded, equations=equations)


def _sees_time(phase: Study) -> bool:
    """True if poses or velocities of bodies depend on time explicitly."""
    links, t = phase.system.motion.links, phase.system.symbols.t
    return any(depends_on(x, (t,)) for link in links for x in (*link.pose.p, *link.twist.w, *link.twist.v, *link.s))


def _with_accelerations(phase: Study, moving: State, numbers: Mapping[Node, float]) -> tuple[State, bool]:
    """State with the accelerations of the equations of motion, {} without them; True if they are numbers.

    They are numbers where their formulas would be long, and missing where no motion follows or no values are known.
    """
    symbols = phase.system.symbols
    if not symbols.u:
        return moving, False
    try:
        raw = substituted(phase.accelerations, moving)
        if not numbers or sum(map(text_size, raw)) <= LONG:
            state = phase.complete(moving)
            return (state if all(a in state for a in symbols.a) else {}), False
        values = {**phase.numeric_parameters, **numbers}
        found = phase.numbers([Expression(a.name, (("name", a.name),), (-1,)) for a in symbols.a], values)
    except (ModelError, DerivationError):  # no motion goes on from there, or no numbers are known
        return {}, False
    if not all(map(isfinite, found)):
        return {}, False
    inputs = phase.complete(moving, Expression.number(0))
    return {**inputs, **dict(zip(symbols.a, map(Fraction, found), strict=True))}, True


# -- centrodes in numbers -----------------------------------------------------------------------------
# Centrodes, an instant -> the curve in the ground, and the body's own that rolls on it, as it lies then.


STEPS = 240  # to each side


@dataclass(frozen=True)
class CentrodeCurves:
    """The centrodes of a body in the plane, places n x 2.

    Args:
        fixed, moving: in the ground.
        now: the centre of rotation at the instant, 2.
        size: of the mechanism [m].
    """

    body: str
    fixed: np.ndarray
    moving: np.ndarray
    now: np.ndarray
    size: float

    @staticmethod
    def of(system: System, centrodes: Centrodes, values: State) -> CentrodeCurves:
        """The fixed and the moving centrode, computed for some time before and after an instant.

        Args:
            values: numbers of t, the coordinates, speeds and parameters then.
        """
        way, body = _configurations(system, centrodes.body, values), centrodes.body
        moving = _in_ground(system, body, _places(centrodes.moving, way), values)
        now = _places(centrodes.fixed, [values])[0]
        return CentrodeCurves(body, _places(centrodes.fixed, way), moving, now, _size(system, values))


def _places(place: tuple[Scalar, ...], way: list[State]) -> np.ndarray:
    """A place in the plane at each of the configurations."""
    return np.array([evaluate(place[:2], values) for values in way], dtype=float)


def _in_ground(system: System, body: str, places: np.ndarray, values: State) -> np.ndarray:
    """Places of a body, where they are in the ground at the instant."""
    pose = system.motion.link(body).pose
    turn = np.array(evaluate([x for row in pose.R[:2] for x in row[:2]], values), dtype=float).reshape(2, 2)
    moved: np.ndarray = places @ turn.T + np.array(evaluate(pose.p[:2], values), dtype=float)
    return moved


def _size(system: System, values: State) -> float:
    """The size of the mechanism: the largest distance of a point from its body's origin."""
    points = [x for body in system.motion.points.values() for place in body.values() for x in place]
    found = [abs(x) for x in evaluate(points, values) if isfinite(x)]
    return max(found, default=0.0) or 1.0


def _configurations(system: System, body: str, values: State) -> list[State]:
    """Configurations before and after the instant, of the one freedom, or in time."""
    symbols, scope = system.symbols, system.scope
    if symbols.u:
        rates, length = (0, *(row[0] for row in scope.N)), _reach(system, values)
    else:
        spin = abs(float(evaluate((system.motion.field(body).w[2],), values)[0]))
        rates, length = (1, *scope.rates), pi / spin if spin > tolerances.COMPUTED else 1.0
    slope = _slope(system, rates, values)
    before, after = (_followed(system, slope, values, sign * length / STEPS) for sign in (-1, 1))
    return [*reversed(before), values, *after]


def _reach(system: System, values: State) -> float:
    """Range to each side over which the one degree of freedom is followed: half a turn, or twice the size."""
    symbols = system.symbols
    leading = next(q for q, rate in zip(symbols.q, system.scope.rates, strict=True) if rate is symbols.u[0])
    poses = [x for link in system.motion.links for row in link.pose.R for x in row]
    turns = any(node.op in ("sin", "cos") and depends_on(node, (leading,)) for node in order(poses))
    return pi if turns else 2 * _size(system, values)


PlaneSlope = Callable[[np.ndarray], np.ndarray]


def _slope(system: System, rates: tuple[Scalar, ...], values: State) -> PlaneSlope:
    """The rates as functions of t and the coordinates."""
    symbols = system.symbols
    function = RightHandSide.of(Program.of(rates, symbols), "numpy")
    p = np.array([values[node] for node in symbols.parameters.values()])
    speeds = np.ones(len(symbols.u))
    return lambda x: np.asarray(function(float(x[0]), np.append(x[1:], speeds), p), dtype=float)


def _followed(system: System, slope: PlaneSlope, values: State, step: float) -> list[State]:
    """Configurations one after the other, by Runge and Kutta's method, as far as there are any."""
    moving = (system.symbols.t, *system.symbols.q)
    x = np.array([values[node] for node in moving], dtype=float)
    found: list[State] = []
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            k1 = slope(x)
            k2 = slope(x + step / 2 * k1)
            k3 = slope(x + step / 2 * k2)
            x = x + step / 6 * (k1 + 2 * k2 + 2 * k3 + slope(x + step * k3))
            if not np.all(np.isfinite(x)):
                break
            found.append({**values, **dict(zip(moving, map(float, x), strict=True))})
    return found


# -------- cut bodies -------------------------------------------------------------------------------------------
# Model, instant -> CutState: the bodies cut free, with numbers for every reaction and all that acts on each.
#
# In motion the accelerations are those of the equations of motion, and the reactions follow from the equations of
# the bodies with them; at rest both follow from the balance alone, unknown loads too. A parameter without a value is
# taken as 1: places and directions are then drawn for that ratio of lengths, and no value leaves.

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

    @staticmethod
    def of(model: Model, at: WrittenEquation | AtRest | None = None) -> CutState:
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
        system, missing = (
            moment.phase.system,
            [name for name in model.parameters if name not in model.exact_parameters()],
        )
        if missing or not moment.numbers:
            raise MissingValues(tuple(missing) or ("the parameters",))
        numbers = {**moment.phase.numeric_parameters, **moment.numbers}
        return CutState(moment.phase, StateInNumbers.of(system, numbers), when, False)

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
