"""Model -> the picture of its reactions over a cycle: of each hinge by size and direction, or sizes over time."""

from __future__ import annotations

import math

from eomgen import pipeline
from eomgen.documents import Picture, run_picture
from eomgen.mechanics.dynamics import System
from eomgen.model import Model
from eomgen.runs import run_of_a_page
from eomgen.symbolic.expression import is_zero, symbols_of
from eomgen.symbolic.numeric import number_of

SAMPLES = 721  # of a cycle


def reaction_picture(model: Model, view: str | None = None, time: float | None = None) -> Picture:
    """Reactions along the motion from the start.

    Args:
        view: "polar" or "resultants"; None: of hinges in the plane the first.
        time: the duration [s]; None: one turn of the driven joint, else as long as a page shows it.
    Raises:
        RunFailed: nothing carries such a force; the motion ends at once.
    """
    equations = pipeline.derive(model)
    run, _ = run_of_a_page(equations, time or turn_of(equations.graph.system), SAMPLES)
    return run_picture(run, view or ("polar" if model.space == "plane" else "resultants"), title=model.name)


def turn_of(system: System) -> float | None:
    """Longest time for one turn among the joints that are driven at a constant rate [s]; None if there is none."""
    scope, driven = system.scope, [q for q in system.symbols.q if system.scope.model.coordinates[q.name].driven]
    turned = {
        x
        for link in system.motion.links
        for s, (w, _) in zip(link.s, link.S, strict=False)
        if not all(map(is_zero, w))
        for x in symbols_of((s,))
    }
    rates = [scope.names[f"{q.name}'"] for q in driven if q in turned]
    parameters = set(system.symbols.parameters.values())
    steady = [rate for rate in rates if parameters.issuperset(symbols_of((rate,)))]
    known = scope.known_exactly
    sizes = [abs(number_of(rate, known)) for rate in steady if not is_zero(rate)]
    return math.tau / min(sizes) if sizes else None
