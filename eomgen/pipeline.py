"""Model -> Equations -> RightHandSide -> Trajectory: the whole journey on one screen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.certificate import Certificate, certify
from eomgen.codegen.program import Program, program_of, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import MissingValues, UsageError
from eomgen.mechanics import articulated
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.energy import is_conservative, refuse_massless
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.system import System, system_of
from eomgen.mechanics.tree import branches_of
from eomgen.model.parts import Model
from eomgen.model.values import numeric_parameters, start_values
from eomgen.simulation.integrate import SAMPLES, integrate
from eomgen.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from eomgen.report.derivation import Derivation

METHODS = ("lagrange", "projection")


@dataclass(frozen=True)
class Equations:
    """The equations of motion of a model: q' = N u + nu, M a = forcing + J^T lam, J a + gamma = 0.

    `graph` holds N, nu, M, c, Q, forcing, J, sigma, gamma, phi, T, V as graph scalars; the same names on the
    equations themselves are their sympy forms, made on first use.

    Args:
        model: the model.
        method: by which the derivation is written: "lagrange" or "projection". The equations are the same functions
            by every method, and are held in their shortest form, the recursion over the tree.
        system: motion, loads and ties.
        graph: the equations as graph scalars.
    """

    model: Model
    method: str
    system: System
    graph: Assembly

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(q.name for q in self.graph.symbols.q)

    @property
    def speeds(self) -> tuple[str, ...]:
        return tuple(u.name for u in self.graph.symbols.u)

    @property
    def parameters(self) -> tuple[str, ...]:
        return tuple(self.graph.symbols.parameters)

    @property
    def inputs(self) -> tuple[str, ...]:
        return tuple(self.graph.symbols.inputs)

    @property
    def N(self) -> Any:
        return _matrix(self.graph.N, len(self.speeds))

    @property
    def nu(self) -> Any:
        return _column(self.graph.nu)

    @cached_property
    def M(self) -> Any:
        return _matrix(self.graph.M, len(self.speeds))

    @cached_property
    def c(self) -> Any:
        return _column(self.graph.c)

    @cached_property
    def Q(self) -> Any:
        return _column(self.graph.Q)

    @cached_property
    def forcing(self) -> Any:
        return _column(self.graph.forcing)

    @cached_property
    def J(self) -> Any:
        return _matrix(self.graph.J, len(self.speeds))

    @cached_property
    def sigma(self) -> Any:
        return _column(self.graph.sigma)

    @cached_property
    def gamma(self) -> Any:
        return _column(self.graph.gamma)

    @cached_property
    def phi(self) -> tuple[Any, ...]:
        """Gaps of the closing rows, None for a row that has none."""
        return tuple(None if gap is None else _expressions((gap,))[0] for gap in self.graph.phi)

    @cached_property
    def T(self) -> Any:
        return _expressions((self.graph.T,))[0]

    @cached_property
    def V(self) -> Any:
        return _expressions((self.graph.V,))[0]

    @cached_property
    def program(self) -> Program:
        """The right-hand side as a straight-line program.

        Raises:
            ModelError: a free coordinate moves no mass.
        """
        refuse_massless(self.graph)
        return right_hand_side(_with_accelerations(self.system, self.graph), input_expressions(self.system))

    def certify(self, target: str | None = "numpy") -> Certificate:
        """Check the equations by independent routes, and the code that `target` emits against the symbols."""
        return certify(self.system, self.graph, self.rhs(target))

    def rhs(self, target: str | None = None) -> RightHandSide:
        """The right-hand side `rhs(t, x, p, inputs=())`, x = q then u.

        Args:
            target: "numpy", "c", or None: C where there is a compiler, else numpy, said once on stderr.
        Raises:
            ToolMissing: "c" without a compiler.
            ModelError: a free coordinate moves no mass.
        """
        p0, x0 = _known_values(self)
        return compiled(self.program, target, x0=x0, p0=p0)

    @cached_property
    def derivation(self) -> Derivation:
        """The derivation, step by step."""
        from eomgen.report.derivation import derivation_of

        return derivation_of(self.system, self.graph, self.method)

    def latex(self) -> str:
        """The derivation as LaTeX (amsmath)."""
        return self.render("latex")

    def render(self, format: str = "text") -> str:
        """The derivation as text, latex, markdown or json."""
        from eomgen.report import rendered

        return rendered(self.derivation, format)

    def __str__(self) -> str:
        return self.render("text")

    def _repr_latex_(self) -> str:
        from eomgen.report.latex import equations_latex

        return equations_latex(self.derivation)

    def _repr_markdown_(self) -> str:
        return self.render("markdown")


def derive(model: Model, method: str = "lagrange") -> Equations:
    """The equations of motion of a model; no certificate is made.

    Args:
        method: by which the derivation is written, one of METHODS.
    Raises:
        UsageError: an unknown method.
        NotYet: a kind that this version does not derive.
        DerivationError: the model has no equations of motion.
    """
    if method not in METHODS:
        raise UsageError(f"unknown method '{method}'", mend=f"one of {', '.join(METHODS)}")
    system = system_of(model)
    return Equations(model, method, system, recursive.assemble(system))


def simulate(
    model: Model,
    *,
    time: float,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-9,
    target: str | None = None,
    samples: int | None = None,
) -> Trajectory:
    """The motion from the start values of the model.

    Args:
        time: how long [s].
        parameters: values that replace the model's.
        start: start values and speeds (`theta`, `theta'`) that replace the model's.
        rtol, atol: tolerances of the integration.
        target: of the emitted code: "numpy", "c", or None for the fastest there is.
    Raises:
        MissingValues: parameters without a value, all named.
    """
    return simulated(derive(model), time=time, parameters=parameters, start=start, rtol=rtol, atol=atol,
                     target=target, samples=samples)  # fmt: skip


def simulated(
    equations: Equations,
    *,
    time: float,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-9,
    target: str | None = None,
    samples: int | None = None,
) -> Trajectory:
    """The motion by equations that are derived already; see `simulate`."""
    model, assembly = equations.model, equations.graph
    p = numeric_parameters(model, parameters)
    rhs = equations.rhs(target)
    values = np.array(list(p.values()), dtype=float)
    gaps = tuple(gap for gap in assembly.phi if gap is not None)
    return integrate(
        rhs,
        time=time,
        x0=state_vector(equations, parameters, start),
        p=values,
        rtol=rtol,
        atol=atol,
        samples=SAMPLES if samples is None else samples,
        energy=_along(equations, (assembly.T, assembly.V), values),
        conservative=is_conservative(equations.system, assembly),
        gaps=_along(equations, gaps, values) if gaps else None,
    )


def _along(equations: Equations, outputs: tuple[Any, ...], p: np.ndarray) -> Any:
    """(t n, x n x states) -> the outputs at each state, n x outputs."""
    program = program_of(outputs, equations.graph.symbols, inputs=input_expressions(equations.system))
    function = compiled(program, "numpy")
    return lambda t, x: function.many(t, x, p).T if len(outputs) == 2 else function.many(t, x, p)


def input_expressions(system: System) -> dict[str, Any]:
    """The model's own expression of each input, in t and parameters."""
    return {name: system.scope.value(part.value) for name, part in system.scope.model.inputs.items()}


def state_vector(
    equations: Equations, parameters: Mapping[str, float] | None = None, start: Mapping[str, float] | None = None
) -> np.ndarray:
    """x at the start, q then u, from the model's start values and those that replace them.

    Raises:
        UsageError: a name in `start` that is no coordinate and no speed.
        MissingValues: a start value needs a parameter without a value.
    """
    names = (*equations.coordinates, *equations.speeds)
    unknown = [name for name in start or {} if name not in names]
    if unknown:
        raise UsageError(f"no coordinate or speed '{unknown[0]}'", mend=f"one of {', '.join(names)}")
    q, u = start_values(equations.model, parameters)
    values = {**q, **u, **(start or {})}
    return np.array([values[name] for name in names], dtype=float)


def _known_values(equations: Equations) -> tuple[np.ndarray | None, np.ndarray | None]:
    """(p0, x0) of the model, None where a value is missing."""
    try:
        p = np.array(list(numeric_parameters(equations.model).values()), dtype=float)
    except MissingValues:
        p = None
    try:
        return p, state_vector(equations)
    except MissingValues:
        return p, None


def _with_accelerations(system: System, assembly: Assembly) -> Assembly:
    """The assembly with explicit accelerations of the tree, where articulated bodies give them."""
    branches = branches_of(system.motion)
    if assembly.J or not articulated.applies(system.motion, branches):
        return assembly
    return replace(assembly, accelerations=articulated.accelerations(system.loads, branches))


def _expressions(scalars: tuple[Any, ...]) -> list[Any]:
    from eomgen.symbolic.sympy_form import to_sympy

    return to_sympy(scalars)


def _matrix(rows: tuple[tuple[Any, ...], ...], columns: int) -> Any:
    import sympy

    return sympy.ImmutableDenseMatrix(len(rows), columns, _expressions(tuple(x for row in rows for x in row)))


def _column(entries: tuple[Any, ...]) -> Any:
    return _matrix(tuple((x,) for x in entries), 1)
