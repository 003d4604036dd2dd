"""Model -> KinematicState: places, velocities and accelerations at one instant, however the model gives them.

A model with [given], or of bodies and constraints alone, has one configuration; its velocities follow from constraints
and given equations. A model with coordinates is taken at its start, or where a condition is first met.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import isfinite, pi

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant import Centrodes, InstantKinematics, KinematicState
from eomgen.mechanics.start import Start
from eomgen.model import Given, Model, WrittenEquation, equation_in
from eomgen.study.motion import MotionFromStart
from eomgen.study.study import Study, exact_numbers
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Scalar,
    State,
    depends_on,
    is_zero,
    order,
    substituted,
)
from eomgen.symbolic.numeric import evaluate, tolerances
from eomgen.symbolic.print import text_size

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
    model = _with_given(model, tuple(equation_in(model, text) for text in given))
    at = None if at is None else equation_in(model, at)
    if model.given is None and (model.coordinates or at is not None):
        return _on_the_way(model, at)
    if at is not None:
        raise UsageError(
            "[given] speaks of one configuration: there is no other instant",
            fix="leave --at out, or move the model by coordinates",
        )
    return _of_instant_kinematics(model)


def _with_given(model: Model, equations: tuple[WrittenEquation, ...]) -> Model:
    """Model with these given velocities added, checked as a whole."""
    if not equations:
        return model
    own = model.given or Given.of_values({})
    return replace(model, given=own.altered(velocity=(*(own.velocity or ()), *equations)))


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
        """Both curves, followed to either side of an instant.

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
