"""Places of rest -> a picture: the system in each place of rest, the stable ones marked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from eomgen.errors import RunFailed
from eomgen.mechanics.equilibria.search import Equilibrium
from eomgen.mechanics.initial_state.numeric_value import known_parameters
from eomgen.report.drawing import Sketch, draw_model
from eomgen.report.figures import Picture

MOST = 6  # places that are drawn
SIDE = 3.4  # of one panel [inches]


def resting_picture(places: Sequence[Equilibrium]) -> Picture:
    """The first places of rest of a plane system.

    Raises:
        RunFailed: there is none; the system is not plane; parameters have no values.
    """
    places = places[:MOST]
    if not places:
        raise RunFailed("there is no place of rest to be drawn")
    model = places[0].statics.system.scope.model
    if model.space != "plane":
        raise RunFailed("pictures of places of rest are drawn of plane systems")
    if not all(place.numbers for place in places):
        raise RunFailed("a picture needs values of all parameters", mend="give them values in [parameters]")
    columns = math.ceil(math.sqrt(len(places)))
    rows = math.ceil(len(places) / columns)

    def fill(figure: Any) -> None:
        for k, place in enumerate(places, start=1):
            panel = figure.add_subplot(rows, columns, k)
            draw_model(panel, _sketch(place), names=k == 1)
            panel.set_title(f"{k}: {place.stability.kind}", fontsize=10)

    return Picture((SIDE * columns, SIDE * rows), fill, model.name)


def _sketch(place: Equilibrium) -> Sketch:
    symbols = place.statics.system.symbols
    plain = Sketch(place.statics.system, known_parameters(place.statics.system.scope))
    inputs = {node: plain.numbers((place.statics.given[node],))[0] for node in symbols.inputs.values()}
    still = dict.fromkeys((symbols.t, *symbols.u), 0.0)
    return Sketch(place.statics.system, {**plain.values, **inputs, **still, **place.numbers})
