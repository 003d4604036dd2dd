"""Programs in addition to the right-hand side: outputs, inverse dynamics, matrices, reactions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide, Solve
from eomgen.errors import DerivationError, ExpressionError, MissingValues, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import EquationsOfMotion, Explicit, System
from eomgen.mechanics.free_bodies import Inverse, by_independent
from eomgen.mechanics.instant import Quantities
from eomgen.model import Output, OutputSource, Requests, TypedNumbers, are_several, nearest, typed_values
from eomgen.symbolic.exact import cramer, factor_solution
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRow,
    ScalarRows,
    depends_on,
    inner,
    is_zero,
    jacobian,
    substituted,
    tangent,
)
from eomgen.symbolic.numeric import tolerances

# -------- requested outputs -----------------------------------------------------------------------------------
# System -> the [outputs] of its model as functions of the state, for emitted code.


@dataclass(frozen=True)
class RequestedOutputs:
    """Outputs in q, u, a, t, parameters and inputs [SI], and why the others are none.

    Args:
        values: by name.
        left: name -> why it is no function of the state.
    """

    values: dict[str, Scalar] = field(default_factory=dict)
    left: dict[str, str] = field(default_factory=dict)


def outputs_of_state(system: System) -> RequestedOutputs:
    """The outputs of the model."""
    found, quantities, symbols = RequestedOutputs(), Quantities(system), system.symbols
    unknown = (*symbols.lam, *symbols.unknowns.values())
    for name, output in system.scope.model.outputs.items():
        why = _of_an_instant(output)
        if not why:
            try:
                scalar = quantities.of(output.value)
                why = "it holds a multiplier or an unknown load" if depends_on(scalar, unknown) else ""
            except (DerivationError, ExpressionError, MissingValues) as error:
                why = error.what
        if why:
            found.left[name] = why
        else:
            found.values[name] = scalar
    return found


def _of_an_instant(output: Output) -> str:
    """Why an output is no function of the state, "" where it may be one."""
    if output.at is not None or output.from_ is not None or output.side is not None or output.event is not None:
        return "it is requested at an instant"
    if Quantities.requested_by(output.value, OutputSource.SMALL_MOTIONS):
        return "it is of the linearized system"
    return "it is of a whole run" if Quantities.requested_by(output.value, OutputSource.OF_A_RUN) else ""


# -------- inverse ---------------------------------------------------------------------------------------------
# Inverse -> Program: the forces and torques that accelerations take, as a function of (t, x, a, p, inputs).


@dataclass(frozen=True)
class InverseFunction:
    """`inverse(t, x, a, p, inputs=())` -> tau, in the order of `names`; x = (q, u), a the accelerations.

    Args:
        names: the actuators.
        function: the program in memory.
    """

    names: tuple[str, ...]
    function: RightHandSide

    def __call__(self, t: float, x: Any, a: Any, p: Any, inputs: Sequence[float] = ()) -> np.ndarray:
        """Values at one state [N, N m]."""
        return self.function(t, [*x, *a], p, inputs)

    def many(self, t: Any, x: Any, a: Any, p: Any, inputs: Any = ()) -> np.ndarray:
        """Values at n states at once: t n or one number, x n x states, a n x speeds -> n x names."""
        return self.function.many(t, np.hstack([x, a]), p, inputs)


@dataclass(frozen=True)
class InverseDynamics:
    """Efforts that move a system with given accelerations: A tau + J^T lam = M a + c - Q.

    Args:
        graph: the same as graph scalars.
    """

    graph: Inverse

    def __repr__(self) -> str:
        return f"<inverse dynamics: {', '.join(self.names)}>"

    @property
    def names(self) -> tuple[str, ...]:
        """The actuators, in the order of tau."""
        return self.graph.names

    @property
    def inputs(self) -> tuple[str, ...]:
        """The inputs that are arguments: those that are no actuators."""
        return tuple(self.graph.inputs)

    @cached_property
    def tau(self) -> dict[str, Any]:
        """{actuator: its force or torque} as sympy expressions in q, u, a, t, parameters and inputs.

        Raises:
            DerivationError: too many coupled constraints for formulas, or indeterminate constraint forces.
        """
        from eomgen.symbolic.print import to_sympy

        return dict(zip(self.names, to_sympy(self.graph.explicit()), strict=True))

    @cached_property
    def program(self) -> Program:
        """tau as a straight-line program: the recursion, and where constraints close one solve."""
        symbols = self.graph.system.symbols
        own = {name: node for name, node in symbols.inputs.items() if name in self.graph.inputs}
        return Program.of(
            self.graph.tau,
            replace(symbols, inputs=own),
            inputs=self.graph.inputs,
            solve=_least(self.graph),
            accelerations=symbols.a,
        )

    def function(self, target: str | None = None) -> InverseFunction:
        """`inverse(t, x, a, p, inputs=())`; the target as of `Equations.rhs`."""
        return InverseFunction(self.names, RightHandSide.of(self.program, target))

    def along(
        self, t: Any, motion: Mapping[str, Any], parameters: Mapping[str, float] | None = None
    ) -> dict[str, np.ndarray]:
        """{actuator: its force or torque at each instant} of a given motion, n each [N, N m].

        Args:
            t: the instants, n, ascending.
            motion: of every coordinate that moves freely: an expression of t and the parameters, `eomgen.samples(...)`,
                or its values at the instants, through which a cubic spline goes.
            parameters: values that replace the model's [SI].
        Raises:
            UsageError: a coordinate without a motion, an unknown name; the motion opens the constraints.
        """
        times = np.atleast_1d(np.asarray(t, dtype=float))
        p = RightHandSide.parameter_values(self.graph.system.scope.model, parameters)
        given = GivenMotion(self.graph.system, times, motion, p)
        tau = self.function("numpy").many(times, given.x, given.a, p)
        return dict(zip(self.names, tau.T, strict=True))


def _least(found: Inverse) -> Solve | None:
    """The least z of  rows z = right: of constraints that follow from others each carries its share.

    z - rows^T mu = 0,   rows z = right
    """
    if not found.unknowns:
        return None
    n, graph = len(found.unknowns), found.system.symbols.graph
    one = tuple(tuple(int(i == j) for j in range(n)) for i in range(n))
    mu = tuple(graph.symbol(f"mu({k + 1})") for k in range(len(found.rows)))
    return Solve(one, found.rows, (*(0 for _ in range(n)), *found.right), (*found.unknowns, *mu))


# -------- matrices --------------------------------------------------------------------------------------------
# Equations of motion -> Programs of their matrices, and of the slopes of the right-hand side.


@dataclass(frozen=True)
class Matrices:
    """Matrices as functions of the state, by name, one after the other, each row after row.

    Args:
        blocks: their entries.
        motion: the system behind a and lam; None where none of them stands in the entries.
        solves: the systems behind further unknowns in the entries.
    """

    blocks: Mapping[str, ScalarRows]
    motion: Solve | None = None
    solves: tuple[Solve, ...] = ()

    @staticmethod
    def of_motion(equations: EquationsOfMotion) -> Matrices:
        """M and forcing of M a = forcing + J^T lam, and where constraints close J and gamma of J a + gamma = 0."""
        blocks: dict[str, ScalarRows] = {"M": equations.M, "forcing": tuple((x,) for x in equations.forcing)}
        if equations.J:
            blocks |= {"J": equations.J, "gamma": tuple((x,) for x in equations.gamma)}
        return Matrices(blocks)

    @property
    def entries(self) -> dict[str, Scalar]:
        """Every entry by its name and place, "M[0, 1]"."""
        return {
            f"{name}[{i}, {j}]": x
            for name, rows in self.blocks.items()
            for i, row in enumerate(rows)
            for j, x in enumerate(row)
        }

    def program(self, equations: EquationsOfMotion, accelerations: tuple[Node, ...] = ()) -> Program:
        """The entries as one program; the systems behind them as of `Program.of`."""
        return Program.of(
            tuple(self.entries.values()),
            equations.symbols,
            inputs=equations.inputs,
            solve=self.motion,
            further=self.solves,
            accelerations=accelerations,
        )


def slopes_of(equations: EquationsOfMotion) -> Matrices:
    """The slopes of x' = (N u + nu, a, z'): A = d x'/d x and, where there are inputs, B = d x'/d inputs.

    From the matrix of the motion itself, factored once, with its pivots where constraints close:

        [[M, -J^T], [J, 0]] [da; dlam] = -d(M a - J^T lam - forcing, J a + gamma) at fixed a, lam
        dz' = Z_x dx + Z_a da

    Where no constraints close and it takes fewer operations, those of the accelerations written out.

    Raises:
        DerivationError: the mass matrix is singular at all states.
    """
    if equations.J and not equations.friction:
        return _solved(equations)
    a = equations.accelerations or factor_solution(equations.M, equations.forcing)
    known = dict(zip(equations.symbols.a, a, strict=True))
    rates = (*equations.kinematic_rates, *a, *substituted(equations.state_rates, known))
    found = [Matrices({name: jacobian(rates, x) for name, x in _columns(equations).items()})]
    if not equations.friction:
        found.append(_written_out(equations, a) if Program.unrolls(equations) else _solved(equations))
    return min(found, key=lambda found: found.program(equations).count.total)


def _written_out(equations: EquationsOfMotion, a: ScalarRow) -> Matrices:
    """M da = -d(M a - forcing) by one factorization, that of all columns."""
    rates, (left, _) = equations.kinematic_rates, equations.residual
    known, blocks = dict(zip(equations.symbols.a, a, strict=True)), {}
    for name, states in _columns(equations).items():
        changes = zip(*jacobian(left, states), strict=True)
        slopes = [factor_solution(equations.M, [-y for y in substituted(column, known)]) for column in changes]
        da = tuple(zip(*slopes, strict=True))
        blocks[name] = (*jacobian(rates, states), *da, *_of_states(equations, states, da, known))
    return Matrices(blocks)


def _of_states(
    equations: EquationsOfMotion, states: Sequence[Node], da: ScalarRows, known: Mapping[Node, Scalar]
) -> list[ScalarRow]:
    """dz' = Z_x + Z_a da of the states of first order, one row each.

    Args:
        states: by which the slopes are taken.
        da: those of the accelerations, one row each.
        known: accelerations that have a formula.
    """
    rates, a = equations.state_rates, equations.symbols.a
    direct = [substituted(row, known) for row in jacobian(rates, states)]
    along = [substituted(row, known) for row in jacobian(rates, a)]
    columns = [tuple(row[j] for row in da) for j in range(len(states))]
    return [
        tuple(x + inner(by_a, column) for x, column in zip(row, columns, strict=True))
        for row, by_a in zip(direct, along, strict=True)
    ]


def _columns(equations: EquationsOfMotion) -> dict[str, tuple[Node, ...]]:
    """Variables with respect to which A and B are derivatives, by the name of the block."""
    symbols = equations.symbols
    columns: dict[str, tuple[Node, ...]] = {"A": symbols.x}
    return columns | ({"B": tuple(symbols.inputs.values())} if symbols.inputs else {})


def _solved(equations: EquationsOfMotion) -> Matrices:
    """Slopes by the `Solve` of the motion, with one more right-hand side for each column that is not zero."""
    symbols, rates, motion = equations.symbols, equations.kinematic_rates, Solve.bordered(equations)
    left = dict(zip((*symbols.a, *symbols.lam), (x for rows in equations.residual for x in rows), strict=True))
    solves: dict[Node, Solve] = {}
    blocks: dict[str, ScalarRows] = {}
    for name, states in _columns(equations).items():
        changes = jacobian([left[y] for y in motion.unknowns], states)
        solves |= {
            x: _change(motion, x, column)
            for x, column in zip(states, zip(*changes, strict=True), strict=True)
            if not all(map(is_zero, column))
        }
        moved = {x: dict(zip(motion.unknowns, solves[x].unknowns, strict=True)) for x in states if x in solves}
        below = tuple(tuple(moved[x][a] if x in moved else 0 for x in states) for a in symbols.a)
        blocks[name] = (*jacobian(rates, states), *below, *_of_states(equations, states, below, {}))
    return Matrices(blocks, motion, tuple(solves.values()))


def _change(motion: Solve, x: Node, change: ScalarRow) -> Solve:
    """The system behind d(a, lam)/dx, by the derivative of that behind (a, lam) with respect to x."""
    unknowns = tuple(x.graph.symbol(f"{y.name} by {x.name}") for y in motion.unknowns)
    return replace(motion, right=tuple(-y for y in change), unknowns=unknowns)


# -------- reactions -------------------------------------------------------------------------------------------
# Reactions, equations of motion -> Program: every reaction that has a single value, along the motion.


@dataclass(frozen=True)
class ReactionFunction:
    """`reactions(t, x, p, inputs=())` -> the reactions of the motion through a state, in the order of `names`.

    Args:
        names: their names in outputs.
        function: the program in memory.
    """

    names: tuple[str, ...]
    function: RightHandSide

    def __call__(self, t: float, x: Any, p: Any, inputs: Sequence[float] = ()) -> np.ndarray:
        """Values at one state [N, N m]."""
        return self.function(t, x, p, inputs)

    def many(self, t: Any, x: Any, p: Any, inputs: Any = ()) -> np.ndarray:
        """Values at n states at once: n x names."""
        return self.function.many(t, x, p, inputs)


def reactions_program(values: Mapping[str, Scalar], equations: EquationsOfMotion) -> tuple[tuple[str, ...], Program]:
    """(names, the program of their values), the accelerations from the same equations as in the right-hand side.

    Args:
        values: as of `determinate`.
    """
    return tuple(values), Program.in_motion(tuple(values.values()), equations)


# -------- solved equations ------------------------------------------------------------------------------------
# Equations of motion -> accelerations and multipliers as expressions of q, u and t.
#
# Where the equations are few by determinants, where degrees of freedom are few over the independent accelerations, else
# by factors.


def accelerations_and_multipliers(equations: EquationsOfMotion) -> dict[Node, Scalar]:
    """a and lam of M a = forcing + J^T lam, J a + gamma = 0, as expressions; redundant rows are left out, their lam 0.

    Raises:
        DerivationError: the mass matrix is singular at all states.
    """
    symbols = equations.system.symbols
    if equations.friction and equations.accelerations is not None:
        found = dict(zip(symbols.a, equations.accelerations, strict=True))
        return found | _multipliers(equations, found)
    if not equations.J:
        return dict(zip(symbols.a, factor_solution(equations.M, equations.forcing), strict=True))
    kept = Rank(equations.system.constraints).regular()
    if len(symbols.a) + len(kept) <= cramer.LARGEST_BLOCK:
        return Explicit(equations).by_determinants(kept)
    with suppress(DerivationError):
        return by_independent(equations, kept)
    return _by_factors(equations, kept)


def _by_factors(equations: EquationsOfMotion, kept: Sequence[int]) -> dict[Node, Scalar]:
    symbols = equations.symbols
    ((a, lam),) = Explicit(equations).by_factors(kept)
    multipliers = {symbols.lam[i]: value for i, value in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def _multipliers(equations: EquationsOfMotion, a: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """lam of J^T lam = M a - forcing with the accelerations known."""
    system = equations.system
    if not equations.J:
        return {}
    kept = Rank(system.constraints).regular()
    n = len(equations.M)
    if n + len(kept) <= cramer.LARGEST_BLOCK:  # what divides by a pivot of J has no value where that vanishes
        found = Explicit(equations).by_determinants(kept)
        return {x: found[x] for x in system.symbols.lam}
    ((_, lam),) = Explicit(equations).by_factors(kept)
    found = {system.symbols.lam[m]: value for m, value in zip(kept, lam, strict=True)}
    return {x: found.get(x, 0) for x in system.symbols.lam}


@dataclass(frozen=True)
class GivenMotion:
    """Coordinates as functions of time -> (q, u) and accelerations at instants."""

    system: System
    t: np.ndarray
    motion: Mapping[str, Any]
    p: np.ndarray

    @cached_property
    def _columns(self) -> dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """{coordinate: (q, q', q'')}"""
        model = self.system.scope.model
        for name in self.motion:
            if name not in model.coordinates:
                raise UsageError(f"there is no coordinate '{name}'", fix=nearest(name, model.coordinates))
        found = {}
        for name, part in model.coordinates.items():
            law = self.motion.get(name, part.motion)
            if law is None:
                raise UsageError(f"'{name}' has no motion", fix=f'give an expression of t: {{"{name}": "sin(t)"}}')
            found[name] = self._of(name, law)
        return found

    def _of(self, name: str, law: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """One coordinate with its rates, n each."""
        model = self.system.scope.model
        if are_several(law):
            typed = TypedNumbers(model, name, declared=False)
            try:
                values = np.array([typed.number(x) for x in typed_values(law)])
            except (ValueError, TypeError, ExpressionError) as error:
                what = error.what if isinstance(error, ExpressionError) else "they are no numbers"
                raise UsageError(f"the values of '{name}': {what}", fix=getattr(error, "fix", "")) from error
            return self._through(name, values)
        scope, symbols = self.system.scope, self.system.symbols
        scalar = scope.value(Requests(model).law(name, law, "motion").named(name))
        rate = tangent((scalar,), {symbols.t: 1})
        scalars = (scalar, *rate, *tangent(rate, {symbols.t: 1}))
        strangers = [x.name for x in symbols.x if depends_on(scalar, (x,))]
        if strangers:
            raise UsageError(f"the motion of '{name}' depends on '{strangers[0]}'", fix="give it as a function of t")
        program = Program.of(scalars, symbols, inputs=self.system.inputs)
        states = np.zeros((len(self.t), len(symbols.x)))
        values = RightHandSide.of(program, "numpy").many(self.t, states, self.p)
        return values[:, 0], values[:, 1], values[:, 2]

    def _through(self, name: str, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        from scipy.interpolate import CubicSpline

        if values.shape != self.t.shape or len(values) < 2:
            raise UsageError(
                f"'{name}' has {values.size} values at {len(self.t)} instants",
                fix="give one value for each instant of t",
            )
        spline = CubicSpline(self.t, values)
        return spline(self.t), spline(self.t, 1), spline(self.t, 2)

    @cached_property
    def x(self) -> np.ndarray:
        """(q, u), n x states.

        Raises:
            UsageError: a speed that is no rate; constraints that are open.
        """
        self.system.refuse_states("forces along a given motion are not found", "take .function(), with x = (q, u, z)")
        symbols, columns = self.system.symbols, self._columns
        strange = [u.name for u in symbols.u if u.name.removesuffix("'") not in columns]
        if strange:
            raise UsageError(
                f"'{strange[0]}' is a speed of its own: the motion gives coordinates", fix="take .function()"
            )
        places = [columns[q.name][0] for q in symbols.q]
        found = np.column_stack([*places, *(columns[u.name[:-1]][1] for u in symbols.u)])
        gaps = tuple(row.gap for row in self.system.constraints.closing if row.gap is not None)
        if gaps:
            program = Program.of(gaps, symbols, inputs=self.system.inputs)
            open_ = np.abs(RightHandSide.of(program, "numpy").many(self.t, found, self.p))
            if not np.max(open_, initial=0.0) <= tolerances.OPEN_GAP:
                raise UsageError(
                    f"the motion opens the constraints by {np.max(open_):.3g}", fix="give one that they allow"
                )
        return found

    @property
    def a(self) -> np.ndarray:
        """The accelerations, n x speeds."""
        return np.column_stack([self._columns[u.name[:-1]][2] for u in self.system.symbols.u])
