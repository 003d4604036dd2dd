"""Coordinates as functions of time -> states and accelerations at instants: rates by derivatives, or of a spline."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import compiled
from eomgen.errors import ExpressionError, UsageError
from eomgen.mechanics.equations.system import System
from eomgen.model.findings import nearest
from eomgen.model.ranges import TypedNumbers, are_several, typed_values
from eomgen.model.replaced import time_law
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, tangent
from eomgen.symbolic.numeric.tolerances import OPEN_GAP


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
                raise UsageError(f"there is no coordinate '{name}'", mend=nearest(name, model.coordinates))
        found = {}
        for name, part in model.coordinates.items():
            law = self.motion.get(name, part.motion)
            if law is None:
                raise UsageError(f"'{name}' has no motion", mend=f'give an expression of t: {{"{name}": "sin(t)"}}')
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
                raise UsageError(f"the values of '{name}': {what}", mend=getattr(error, "mend", "")) from error
            return self._through(name, values)
        scope, symbols = self.system.scope, self.system.symbols
        scalar = scope.value(time_law(model, name, law, "motion").named(name))
        rate = tangent((scalar,), {symbols.t: 1})
        scalars = (scalar, *rate, *tangent(rate, {symbols.t: 1}))
        strangers = [x.name for x in (*symbols.q, *symbols.u) if depends_on(scalar, (x,))]
        if strangers:
            raise UsageError(f"the motion of '{name}' depends on '{strangers[0]}'", mend="give it as a function of t")
        program = program_of(scalars, symbols, inputs=self.system.inputs)
        states = np.zeros((len(self.t), len(symbols.q) + len(symbols.u)))
        values = compiled(program, "numpy").many(self.t, states, self.p)
        return values[:, 0], values[:, 1], values[:, 2]

    def _through(self, name: str, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        from scipy.interpolate import CubicSpline

        if values.shape != self.t.shape or len(values) < 2:
            raise UsageError(
                f"'{name}' has {values.size} values at {len(self.t)} instants",
                mend="give one value for each instant of t",
            )
        spline = CubicSpline(self.t, values)
        return spline(self.t), spline(self.t, 1), spline(self.t, 2)

    @cached_property
    def x(self) -> np.ndarray:
        """(q, u), n x states.

        Raises:
            UsageError: a speed that is no rate; ties that are open.
        """
        symbols, columns = self.system.symbols, self._columns
        strange = [u.name for u in symbols.u if u.name.removesuffix("'") not in columns]
        if strange:
            raise UsageError(
                f"'{strange[0]}' is a speed of its own: the motion gives coordinates", mend="take .function()"
            )
        places = [columns[q.name][0] for q in symbols.q]
        found = np.column_stack([*places, *(columns[u.name[:-1]][1] for u in symbols.u)])
        gaps = tuple(row.gap for row in self.system.ties.closing if row.gap is not None)
        if gaps:
            program = program_of(gaps, symbols, inputs=self.system.inputs)
            open_ = np.abs(compiled(program, "numpy").many(self.t, found, self.p))
            if not np.max(open_, initial=0.0) <= OPEN_GAP:
                raise UsageError(f"the motion opens the ties by {np.max(open_):.3g}", mend="give one that they allow")
        return found

    @property
    def a(self) -> np.ndarray:
        """The accelerations, n x speeds."""
        return np.column_stack([self._columns[u.name[:-1]][2] for u in self.system.symbols.u])
