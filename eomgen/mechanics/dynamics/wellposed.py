"""Equations of motion -> statements on energy and mass before any motion, and places where a force has no value."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues, ModelError, Problem
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics.pieces import Extent, where_continuous, where_holds
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System
from eomgen.mechanics.kinematics import BodyLink
from eomgen.mechanics.state import Doubles
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Scalar,
    State,
    depends_on,
    gradient,
    is_zero,
    order,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, evaluate, fifty_digits, of_one_length, tolerances
from eomgen.symbolic.print import text_size, to_text

# -------- wellposed -------------------------------------------------------------------------------------------
# Equations of motion -> what can be said of its energy and its mass before anything moves.


LONG = 120  # characters of a balance that is printed


@dataclass(frozen=True)
class WellPosed:
    """Properties of equations of motion known before anything moves: conservation of energy, motions without mass."""

    equations: EquationsOfMotion

    @property
    def is_conservative(self) -> bool:
        """True if T + V is conserved: nothing moves as prescribed, and Q is -N^T dV/dq alone, in every piece."""
        return self.where_conservative.everywhere

    @property
    def where_conservative(self) -> Extent:
        """Extent, in pieces of min, max, abs, sign, cases and samples, in which T + V is conserved."""
        t = self.equations.symbols.t
        by_itself = (*self.equations.nu, *self.equations.sigma)
        if (
            any(not is_zero(x) for x in by_itself)
            or depends_on(self.equations.V, (t, *self.equations.symbols.z))
            or depends_on(self.equations.T, (t, *self.equations.symbols.z))
            or self.moves_at_rest
        ):
            return Extent(False)
        elastic = self.equations.system.motion.scope.from_potential(self.equations.V)
        if not elastic:
            return Extent(True)
        n = len(elastic)
        return where_continuous(self.equations, self.equations.V) & where_holds(
            self.equations,
            (*self.equations.Q, *elastic),
            lambda x: equal_at_random_states(zip(x[:n], x[n:], strict=True)).equal,
        )

    @property
    def moves_at_rest(self) -> bool:
        """True if a given kinetic energy is there without speeds, as of a fluid that streams past: T + V may change."""
        scope, T = self.equations.system.scope, self.equations.T
        if not any(force.moving for force in scope.model.forces.values()):
            return False
        still = dict.fromkeys(self.equations.symbols.u, 0)
        return any(not is_zero(x) for x in substituted((T, *gradient(T, self.equations.symbols.u)), still))

    @property
    def why_not_conservative(self) -> str:
        """Reason in words why T + V is not conserved everywhere; "" where it is."""
        held = self.where_conservative
        if held.everywhere:
            return ""
        if held:
            return f"T + V stays constant only while {held.text}"
        model, loads = self.equations.system.scope.model, self.equations.system.loads
        carried = [f"'{name}' moves by itself" for name, part in model.coordinates.items() if part.driven]
        pushed = [f"'{each.name}' has no potential" for each in loads.applied if each.potential is None and each.loads]
        turned = [f"something drives or brakes the joint of '{e.body}'" for e in loads.efforts if not is_zero(e.drive)]
        rubbed = ["contacts rub"] if self.equations.friction else []
        rows = zip(self.equations.system.constraints.closing, self.equations.sigma, strict=True)
        moving = [f"'{row.constraint}' moves by itself" for row, sigma in rows if not is_zero(sigma)]
        found = tuple(dict.fromkeys((*carried, *pushed, *turned, *rubbed, *moving)))
        return ", ".join(found) or "something drives, brakes or carries the model"

    def refuse_massless(self) -> None:
        """Refuses free coordinates that move no mass, alone or together: they have no acceleration.

        Raises:
            ModelError: naming every such coordinate, or the body that can turn idly.
        """
        if problems := self.massless_motions:
            raise ModelError(problems)

    @property
    def massless_motions(self) -> tuple[Problem, ...]:
        """The motions that move no mass; () where every acceleration is determined."""
        held = [any(not is_zero(row[k]) for row in self.equations.J) for k in range(len(self.equations.M))]
        moves_nothing = [k for k in range(len(held)) if is_zero(self.equations.M[k][k]) and not held[k]]
        return tuple(_massless(self.equations, k) for k in moves_nothing) or _idle(self.equations)


def _massless(equations: EquationsOfMotion, k: int) -> Problem:
    speed = equations.symbols.u[k].name
    q = speed.rstrip("'")
    if q == speed:
        return Problem(
            f"speeds.{q}",
            f"the speed '{q}' moves no mass, so it has no derivative",
            fix="give the bodies that it moves a mass",
        )
    return Problem(
        f"coordinates.{q}",
        f"the free coordinate '{q}' moves no mass, so it has no acceleration",
        fix="give the bodies that it moves a mass, or drive the coordinate by `motion`" + _by_its_balance(equations, k),
    )


def _by_its_balance(equations: EquationsOfMotion, k: int) -> str:
    """Advice to let a node between springs and dampers follow from its own balance; "" where no such force acts."""
    force, u = equations.forcing[k], equations.symbols.u[k]
    q = next((q for q in equations.symbols.q if f"{q.name}'" == u.name), None)
    if q is None or is_zero(force) or text_size(force) > LONG or not depends_on(force, (q, u)):
        return ""
    field = "rate" if depends_on(force, equations.symbols.u) else "gap"
    constraint = f'kind = "equation", {field} = "{to_text(force)}"'
    return f"; where springs and dampers alone push it, mark it `dependent` and give its balance: {{ {constraint} }}"


# -- motions that move no mass -----------------------------------------------------------------------


def _idle(equations: EquationsOfMotion) -> tuple[Problem, ...]:
    """A motion that the constraints allow and that moves no mass, M u = 0 and J u = 0, at a generic state."""
    system = equations.system
    if not equations.M or _is_full(system):
        return ()
    try:
        if _has_energy(equations, Closure(system.constraints).scattered()):
            return ()
        state = Closure(system.constraints).generic()
        u = _without_energy(equations, state)
        return () if u is None else (_idle_problem(system, u, state),)
    except (MissingValues, DerivationError, NoValue):
        return ()  # whoever needs accelerations says what is missing


def _is_full(system: System) -> bool:
    """True if every body has inertia in all directions, and every speed is that of one joint: M is regular."""
    rates = [rate for link in system.motion.links for rate in link.s_rate]
    own = len(rates) == len(set(rates)) and set(rates) == set(system.symbols.u)
    return own and not any(_is_lean(system, link) for link in system.motion.links)


def _is_lean(system: System, link: BodyLink) -> bool:
    """True if the mass or a diagonal entry of the inertia of a body is 0: motions without kinetic energy."""
    mass = system.scope.mass_properties(link.name)
    axes = (2,) if system.scope.model.space == "plane" else range(3)
    return is_zero(mass.m) or any(is_zero(mass.I[k][k]) for k in axes)


def _has_energy(equations: EquationsOfMotion, state: State) -> bool:
    """True if all motions have kinetic energy, those that the constraints forbid too: M is regular in the state."""
    M = Doubles({node: float(x) for node, x in state.items()}).array(equations.M, len(equations.M))
    sizes = np.diag(M)
    if not np.all(np.isfinite(M)) or not np.all(sizes > tolerances.SOLVED * max(sizes)):
        return False
    return bool(np.linalg.eigvalsh(M / np.outer(np.sqrt(sizes), np.sqrt(sizes)))[0] > tolerances.RANK)


def _without_energy(equations: EquationsOfMotion, state: State) -> dict[Node, float] | None:
    """Speeds with M u = 0 and J u = 0, the largest 1; None where there are none."""
    u = equations.symbols.u
    entries = evaluate([x for row in (*equations.M, *equations.J) for x in row], state, fifty_digits())
    rows = np.array(entries, dtype=object).reshape(-1, len(u))
    sizes = np.diag(rows[: len(u)])
    counts = sizes > tolerances.SQUARED_AT_50 * max(sizes)
    scale = np.array([1 / x**0.5 if counted else 1 for x, counted in zip(sizes, counts, strict=True)])
    rows = rows * scale  # in numbers of any size: M of a length of 1e300 m is no double
    rows[: len(u)] *= scale[:, None]
    longest = np.array([max(map(abs, row)) or 1 for row in rows])
    rows[len(u) :] /= longest[len(u) :, None]
    rows = rows.astype(float)
    _, values, directions = np.linalg.svd(np.vstack([rows[: len(u)], of_one_length(rows[len(u) :])]))
    if values[-1] > tolerances.SUMMED * values[0]:
        return None
    least = scale.astype(float) * directions[-1]
    return dict(zip(u, least / np.max(np.abs(least)), strict=True))


def _idle_problem(system: System, u: Mapping[Node, float], state: State) -> Problem:
    """Problem that names a body that turns without inertia, or coordinates that move no mass."""
    moving = [node.name.rstrip("'") for node, x in u.items() if abs(x) > tolerances.SHARE]
    names = ", ".join(f"'{name}'" for name in moving)
    for link in system.motion.links:
        if max(abs(w) for w in _spin(link, u, state)) > tolerances.SHARE:
            what = f"body '{link.name}' can turn about an axis about which it has no inertia"
            fix = "give it an inertia there (a cylinder, not a rod), or a joint that does not turn it so: 'universal'"
            return Problem(f"bodies.{link.name}", f"{what}: nothing determines the accelerations of {names}", fix=fix)
    what = f"the free coordinates {names} can move together without moving a mass"
    fix = "give the bodies that they move a mass, or leave out what moves nothing of its own"
    return Problem("coordinates", f"{what}: nothing determines their accelerations", fix=fix)


def _spin(link: BodyLink, u: Mapping[Node, float], state: State) -> list[float]:
    """The part of a body's angular velocity that is linear in u, at these speeds."""
    ways = [state | {node: fifty_digits().number(k * x) for node, x in u.items()} for k in (1, 0)]
    with_u, without = (evaluate(link.twist.w, way, fifty_digits()) for way in ways)
    return [float(x - y) for x, y in zip(with_u, without, strict=True)]


# -------- no value --------------------------------------------------------------------------------------------
# System, a state in which its equations have no value -> what has none there: a force, a joint, a constraint, an input.


REASONS = {
    "div": "divides by zero",
    "sqrt": "takes the root of a negative number",
    "log": "takes the logarithm of what is not positive",
    "pow": "takes a power that is no number",
}


@dataclass(frozen=True)
class Valueless:
    """Part of a model that has no value in a state.

    Args:
        where: its path in the model.
        what: "force 'pull' is 0/0 at x = 0".
    """

    where: str
    what: str

    @staticmethod
    def in_state(system: System, values: Mapping[Node, float]) -> Valueless | None:
        """The first part of a system that has no finite value in a state; None where each has one.

        Args:
            values: of t, q, u and the parameters.
        """
        for where, name, part in _parts(system):
            for scalar in _scalars(part):
                reason = Valueless.reason(scalar, values)
                if reason:
                    return Valueless(where, f"{name} {reason}{_slack_at_zero(system, where, values)}")
        return None

    @staticmethod
    def overlarge(system: System, values: Mapping[Node, float]) -> Valueless | None:
        """The largest part of a system in a state, where it is too large to be calculated with; None where none is."""
        sizes = [(_size(part, values), where, name) for where, name, part in _parts(system)]
        size, where, name = max(sizes, default=(0.0, "", ""))
        if not tolerances.LARGEST_SQUARED < size < math.inf:
            return None
        what = f"{name} is of the size {size:.3g} there, beyond what doubles can follow; give it a smaller value"
        return Valueless(where, what)

    @staticmethod
    def reason(scalar: Scalar, values: Mapping[Node, float]) -> str:
        """Reason why a scalar has no finite value, and where; "" where it has one, or needs what is not known."""
        symbols = symbols_of((scalar,))
        if not all(symbol in values for symbol in symbols):
            return ""
        nodes = order((scalar,))
        known = dict(zip(nodes, evaluate(nodes, values, FLOAT), strict=True))
        culprit = next((node for node in nodes if not math.isfinite(known[node])), None)
        if culprit is None or culprit in values:  # a state that is no number is nobody's here
            return ""
        operands = [known[a] if type(a) is Node else float(a) for a in culprit.args]
        reason = REASONS.get(culprit.op, "has no finite value")
        reason = "is 0/0" if culprit.op == "div" and not any(operands) else reason
        held = symbols_of((culprit,))
        state = [symbol for symbol in held if not symbol.graph.is_constant(symbol)] or held
        return (
            f"{reason} at {', '.join(f'{symbol.name} = {values[symbol]:.6g}' for symbol in state)}" if state else reason
        )


def _slack_at_zero(system: System, where: str, values: Mapping[Node, float]) -> str:
    """Remark on a spring whose natural length is a parameter that is 0; "" of anything else.

    Its law k (l - l0) d/l keeps the length l as a divisor, since the parameter may be changed; that of a 0 that is
    written is k d, d the vector from end to end.
    """
    table, _, name = where.partition(".")
    element = system.scope.model.forces[name].element if table == "forces" else None
    if element is None or not isinstance(element.slack, Expression) or element.along is not None or element.bodies:
        return ""
    length = system.scope.value(element.slack)
    if type(length) is not Node or not all(x in values for x in symbols_of((length,))):
        return ""
    zero = evaluate((length,), values, FLOAT)[0] == 0
    return " (its natural length is a parameter that is 0: write length = 0, and it has a value there)" if zero else ""


def _size(part: Any, values: Mapping[Node, float]) -> float:
    """The largest number of a load or row in a state, in SI; 0 where the state does not give it."""
    scalars = tuple(x for x in _scalars(part) if all(symbol in values for symbol in symbols_of((x,))))
    return max((abs(x) for x in evaluate(scalars, values, FLOAT) if not math.isnan(x)), default=0.0)


def _parts(system: System) -> Iterator[tuple[str, str, Any]]:
    for name, value in system.inputs.items():
        yield f"inputs.{name}", f"input '{name}'", value
    for force in system.loads.applied:
        yield f"forces.{force.name}", f"force '{force.name}'", force.loads
    for effort in system.loads.efforts:
        yield f"bodies.{effort.body}.joint", f"the joint of body '{effort.body}'", effort.effort
    for row in system.constraints.rows:
        yield f"constraints.{row.constraint}", f"constraint '{row.constraint}'", (row.gap, row.velocity, row.wrenches)
        yield f"constraints.{row.constraint}", f"the friction of '{row.constraint}'", (row.friction, row.shares)


def _scalars(part: Any) -> Iterator[Scalar]:
    """The formulas in a load or a row."""
    if type(part) in (Node, int, Fraction):
        yield part
    elif isinstance(part, (tuple, list)):
        for each in part:
            yield from _scalars(each)
    elif is_dataclass(part):
        for field in fields(part):
            yield from _scalars(getattr(part, field.name))
