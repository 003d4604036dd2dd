"""Inverse -> Program: the forces and torques that accelerations take, as a function of (t, x, a, p, inputs)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.given_motion import GivenMotion
from eomgen.codegen.program import Program, Solve, program_of
from eomgen.codegen.rhs import RightHandSide, compiled, parameter_vector
from eomgen.mechanics.reactions.inverse import Inverse
from eomgen.records import dataclass


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
        """At one state [N, N m]."""
        return self.function(t, [*x, *a], p, inputs)

    def many(self, t: Any, x: Any, a: Any, p: Any, inputs: Any = ()) -> np.ndarray:
        """At n states at once: t n or one number, x n x states, a n x speeds -> n x names."""
        return self.function.many(t, np.hstack([x, a]), p, inputs)


@dataclass(frozen=True)
class InverseDynamics:
    """What moves a system with given accelerations: A tau + J^T lam = M a + c - Q.

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
            DerivationError: too many ties hang together for formulas, or they share their forces.
        """
        from eomgen.symbolic.print.sympy_form import to_sympy

        return dict(zip(self.names, to_sympy(self.graph.explicit()), strict=True))

    @cached_property
    def program(self) -> Program:
        """tau as a straight-line program: the recursion, and where ties close one solve."""
        symbols = self.graph.system.symbols
        own = {name: node for name, node in symbols.inputs.items() if name in self.graph.inputs}
        return program_of(
            self.graph.tau,
            replace(symbols, inputs=own),
            inputs=self.graph.inputs,
            solve=_least(self.graph),
            accelerations=symbols.a,
        )

    def function(self, target: str | None = None) -> InverseFunction:
        """`inverse(t, x, a, p, inputs=())`; the target as of `Equations.rhs`."""
        return InverseFunction(self.names, compiled(self.program, target))

    def along(
        self, t: Any, motion: Mapping[str, Any], parameters: Mapping[str, float] | None = None
    ) -> dict[str, np.ndarray]:
        """{actuator: what it has to give at each instant} of a given motion, n each [N, N m].

        Args:
            t: the instants, n, ascending.
            motion: of every coordinate that moves freely: an expression of t and the parameters, `eomgen.samples(...)`,
                or its values at the instants, through which a cubic spline goes.
            parameters: values that replace the model's [SI].
        Raises:
            UsageError: a coordinate without a motion, an unknown name; the motion opens the ties.
        """
        times = np.atleast_1d(np.asarray(t, dtype=float))
        p = parameter_vector(self.graph.system.scope.model, parameters)
        given = GivenMotion(self.graph.system, times, motion, p)
        tau = self.function("numpy").many(times, given.x, given.a, p)
        return dict(zip(self.names, tau.T, strict=True))


def _least(found: Inverse) -> Solve | None:
    """The least z of  rows z = right: of ties that follow from others each carries its share.

    z - rows^T mu = 0,   rows z = right
    """
    if not found.unknowns:
        return None
    n, graph = len(found.unknowns), found.system.symbols.graph
    one = tuple(tuple(int(i == j) for j in range(n)) for i in range(n))
    mu = tuple(graph.symbol(f"mu({k + 1})") for k in range(len(found.rows)))
    return Solve(one, found.rows, (*(0 for _ in range(n)), *found.right), (*found.unknowns, *mu))
