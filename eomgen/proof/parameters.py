"""Motion -> checks of the data: parameters by the reader's arithmetic, shapes by quadrature."""

from __future__ import annotations

import math
from collections.abc import Iterator

from eomgen.mechanics.kinematics import Motion, Scope
from eomgen.proof.check import Check, checked
from eomgen.proof.declared_numbers import other_functions
from eomgen.proof.masses import other_masses
from eomgen.symbolic.numeric import tolerances


def other_data(motion: Motion) -> Iterator[Check]:
    """A failing check of parameters or masses that are not those of the file; the check of sampled functions."""
    yield from other_parameters(motion.scope)
    yield from other_masses(motion)
    yield from other_functions(motion.scope.model)


def other_parameters(scope: Scope) -> Iterator[Check]:
    """A failing check where the numbers used by all other checks are not those of the file; else none."""
    known, found = scope.model.exact_parameters(), scope.values_of_parameters(None)
    there = {x.name: float(value) for x, value in found.items()}
    pairs = [(name, there.get(name, math.nan), float(right)) for name, right in known.items()]
    wrong = [
        f"'{name}': {x:.10g} for {y:.10g}" for name, x, y in pairs if not abs(x - y) <= tolerances.COMPUTED * abs(y)
    ]
    if wrong:
        yield checked("parameters have the values of the file", "; ".join(wrong[:3]), "floating point")
