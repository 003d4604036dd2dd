"""x' = f(t, x) by Taylor series of an order that the tolerance says: heyoka's integrator (the extra `heyoka`).

It differentiates the equations themselves, so that these must be smooth and written out, without a linear solve.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

import numpy as np

from eomgen.codegen.program import Program, Solve
from eomgen.codegen.vectors import outputs_at
from eomgen.errors import ToolMissing, UsageError
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, Arithmetic
from eomgen.symbolic.numeric.tolerances import SOLVED

PIECES = frozenset("abs sign min max less less_equal select sampled".split())
LONG = 1000  # operations from which on heyoka is asked for code with loops: else its compiler takes long


class HeyokaSteps:
    """One step of heyoka a call.

    Args:
        program, p: the equations, and the parameters' values.
        span, x0: the first and the last instant, and the state at the first.
        tolerance: of one step.
        breakpoints: instants across which no step goes.
    Raises:
        UsageError: the equations are not smooth, or solve a linear system.
        ToolMissing: heyoka is not installed.
    """

    stiff_from, words = None, ""

    def __init__(
        self,
        program: Program | None,
        p: Sequence[float],
        span: tuple[float, float],
        x0: np.ndarray,
        *,
        tolerance: float,
        breakpoints: Sequence[float],
    ) -> None:
        self._end, self._breakpoints = span[1], breakpoints
        self._taylor = _integrator(smooth(program), p, span[0], x0, tolerance)
        self.t, self.t_old, self.status, self.nfev = span[0], span[0], "running", 0

    def advance(self, _: int) -> tuple[int, bool]:
        """(1, False), or no step where it failed."""
        k = bisect_right(self._breakpoints, self.t + SOLVED * max(1.0, abs(self.t)))
        bound = min([self._end, *self._breakpoints[k : k + 1]])
        outcome, length = self._taylor.step(bound - self.t, write_tc=True)
        self.nfev += 1
        if not (length > 0 and np.all(np.isfinite(self._taylor.state))) or "nf_state" in str(outcome):
            self.status = "failed"
            return 0, False
        at_bound = "time_limit" in str(outcome)
        self.t_old, self.t = self.t, bound if at_bound else float(self._taylor.time)
        self._taylor.time = self.t
        self.status = "finished" if self.t >= self._end else "running"
        return 1, False

    @property
    def y(self) -> np.ndarray:
        return np.array(self._taylor.state)

    def dense_output(self) -> Callable[[Any], np.ndarray]:
        """t -> x in the last step, by its series."""

        def at(t: Any) -> np.ndarray:
            found = np.array([self._taylor.update_d_output(float(each)).copy() for each in np.atleast_1d(t)])
            return found[0] if np.ndim(t) == 0 else found.T

        return at

    def put(self, x: np.ndarray) -> None:
        """Go on from another state nearby."""
        self._taylor.state[:] = x


def smooth(program: Program | None) -> Program:
    """The program, where a Taylor series can be made of it.

    Raises:
        UsageError: it cannot.
    """
    why = _hindrance(program)
    if why or program is None:
        raise UsageError(f"no Taylor series of these equations: {why}", mend="leave --method out, or take another")
    return program


def _hindrance(program: Program | None) -> str:
    """Why there is no series; "" where there is one."""
    if program is None:
        return "more than the equations of motion is stepped"
    if any(type(s) is Solve for s in program.statements):
        return "they solve a linear system at every instant"
    parameters = {*program.symbols.parameters.values()}
    fixed: set[Node] = set()
    for x in order([*program.outputs, *program.defaults]):
        if x in parameters or (x.op != "symbol" and all(type(a) is not Node or a in fixed for a in x.args)):
            fixed.add(x)
        elif x.op in PIECES:
            return f"they are made of pieces ('{x.op}')"
    return ""


def _integrator(program: Program, p: Sequence[float], t: float, x: np.ndarray, tolerance: float) -> Any:
    try:
        import heyoka
    except ImportError as error:
        raise ToolMissing(
            f"heyoka cannot be imported: {error}", mend="pip install 'eomgen[heyoka]', or take another --method"
        ) from None
    symbols = program.symbols
    names = heyoka.make_vars(*(f"x{k}" for k in range(len(x)))) if len(x) > 1 else [heyoka.make_vars("x0")]
    values: dict[Node, Any] = dict(zip(program.states, names, strict=True))
    values |= dict(zip(symbols.parameters.values(), map(float, p), strict=True)) | {symbols.t: heyoka.time}
    rates = [heyoka.expression(rate) if type(rate) is float else rate for rate in _rates(program, values, heyoka)]
    return heyoka.taylor_adaptive(
        list(zip(names, rates, strict=True)),
        x.tolist(),
        time=t,
        tol=tolerance,
        compact_mode=program.count.total > LONG,
    )


def _rates(program: Program, values: dict[Node, Any], heyoka: ModuleType) -> list[Any]:
    """The right-hand side in heyoka's expressions; what parameters alone determine are floats."""

    def either(op: str, made: Callable[..., Any]) -> Callable[..., Any]:
        known = FLOAT.functions[op]
        return lambda *args: known(*args) if all(type(a) is float for a in args) else made(*args)

    names = "sqrt sin cos tan asin acos atan sinh cosh tanh exp log atan2".split()
    functions = {op: either(op, getattr(heyoka, op)) for op in names} | {"pow": lambda a, b: a**b}
    return outputs_at(
        program, values, Arithmetic("heyoka", FLOAT.number, {**FLOAT.functions, **functions}, lambda _: math.nan)
    )
