"""Expressions -> their values at many states at once, layer after layer.

A layer is all operations of one kind whose arguments are known from the layers before: so many thousand nodes are a few
hundred operations on arrays.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.splines import sampled_of
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import Arithmetic, evaluate, nearest

_ON_ARRAYS: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": np.true_divide,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "pow": np.float_power,
    "min": np.minimum,
    "max": np.maximum,
    "select": np.where,
    "pi": lambda: np.pi,
    "sampled": np.vectorize(lambda t, k: sampled_of(k).at(t, nearest, np.pi), otypes=[float]),
    **{op: getattr(np, op) for op in "sqrt sin cos tan sinh cosh tanh exp log abs sign less less_equal".split()},
}
ARRAYS = Arithmetic("arrays", nearest, _ON_ARRAYS, lambda x: np.nan)
"""Floats, or arrays of them: many states at once."""

Layer = tuple[str, slice, tuple[np.ndarray, ...]]


@dataclass(frozen=True)
class Layers:
    """Expressions whose values are sought at many states.

    Args:
        outputs: the expressions.
        unknowns: the symbols that differ from state to state.
        values: of every other symbol.
    """

    outputs: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, float]

    def at(self, x: np.ndarray) -> np.ndarray:
        """The outputs at each state, states x outputs; nan outside their domain.

        Args:
            x: states x unknowns.
        """
        known = np.empty((self._size, len(x)))
        first = len(self.unknowns)
        known[:first] = x.T
        known[first : first + len(self._fixed)] = self._fixed[:, None]
        with np.errstate(all="ignore"):
            for op, place, arguments in self._layers:
                known[place] = _ON_ARRAYS[op](*[known[a] for a in arguments])
        return np.asarray(known[self._outputs].T)

    @cached_property
    def _moving(self) -> list[Node]:
        """The operations that depend on the unknowns, arguments before results."""
        moving: dict[Node, None] = dict.fromkeys(self.unknowns)
        for x in order(self.outputs):
            if x.op != "symbol" and any(type(a) is Node and a in moving for a in x.args):
                moving[x] = None
        return list(moving)[len(self.unknowns) :]

    @cached_property
    def _constant(self) -> tuple[Scalar, ...]:
        """What the moving operations and the outputs take that is the same at all states."""
        moving = {*self._moving, *self.unknowns}
        taken = dict.fromkeys(a for x in self._moving for a in x.args) | dict.fromkeys(self.outputs)
        return tuple(x for x in taken if type(x) is not Node or x not in moving)

    @cached_property
    def _fixed(self) -> np.ndarray:
        with np.errstate(all="ignore"):
            return np.array([float(x) for x in evaluate(self._constant, self.values, ARRAYS)])

    @cached_property
    def _kinds(self) -> dict[tuple[int, str], list[Node]]:
        """The operations by depth and kind, the least deep first."""
        depth: dict[Scalar, int] = {}
        found: dict[tuple[int, str], list[Node]] = {}
        for x in self._moving:
            depth[x] = 1 + max(depth.get(a, 0) for a in x.args)
            found.setdefault((depth[x], x.op), []).append(x)
        return dict(sorted(found.items()))

    @cached_property
    def _places(self) -> dict[Scalar, int]:
        """Where each value stands: unknowns, constants, then layer by layer."""
        ordered = [*self.unknowns, *self._constant]
        for nodes in self._kinds.values():
            ordered += nodes
        return {x: i for i, x in enumerate(ordered)}

    @property
    def _size(self) -> int:
        return len(self._places)

    @cached_property
    def _layers(self) -> list[Layer]:
        places = self._places
        found: list[Layer] = []
        for (_, op), nodes in self._kinds.items():
            start = places[nodes[0]]
            columns = zip(*(x.args for x in nodes), strict=True)
            arguments = tuple(np.array([places[a] for a in column]) for column in columns)
            found.append((op, slice(start, start + len(nodes)), arguments))
        return found

    @cached_property
    def _outputs(self) -> np.ndarray:
        return np.array([self._places[x] for x in self.outputs], dtype=int)
