"""Springs at the ground, driven coordinates -> marks in the plane: walls that hold the ones, arrows of the others."""

from __future__ import annotations

import math
from collections.abc import Sequence

from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.driven import driven_coordinates, driving_ties
from eomgen.scene.bodies import parameters_as_drawn
from eomgen.scene.forms import LabelForm, SymbolForm
from eomgen.scene.scene import Mark
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, is_zero
from eomgen.symbolic.expression.spatial import Vector, minus
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate


def walls(system: System, grounded: Sequence[Vector], free: Vector, of: str) -> list[Mark]:
    """The hatched lines on which a spring or damper ends at the ground, along x or y, its free end before them."""
    if system.scope.model.space == "space":
        return []
    scene, known = SystemScene(system.motion), parameters_as_drawn(system)
    found = []
    for at in grounded:
        way = tuple(map(scene.start, minus(free, at)))
        still = dict.fromkeys(symbols_of(way), 0.0)  # the share of a virtual displacement
        dx, dy, _ = (float(x) for x in evaluate(way, still | known, FLOAT))
        if math.hypot(dx, dy) > 0:
            level = abs(dy) >= abs(dx)
            along: Vector = (int(math.copysign(1, dy)), 0, 0) if level else (0, -int(math.copysign(1, dx)), 0)
            found.append(Mark(SymbolForm("wall", at, along), 0, "support", of))
    return found


def drive_marks(system: System) -> list[Mark]:
    """An arrow at the first joint that turns or slides as a driven coordinate says, and the coordinate's name."""
    if system.scope.model.space == "space":
        return []
    driven, ties = driven_coordinates(system.scope.model), driving_ties(system.scope.model)
    waiting = [q for q in system.symbols.q if q.name in driven]
    found = []
    for k, link in enumerate(system.motion.links, start=1):
        for q in [q for q in waiting if q in symbols_of(link.s)]:
            waiting.remove(q)
            of = ties.get(q.name, (link.name,))[0]
            found += [
                Mark(_arrow(link, q), k, "support", of),
                Mark(LabelForm(q.name, link.point), k, "dimension", of),
            ]
    return found


def _arrow(link: BodyLink, q: Node) -> SymbolForm:
    """Round the joint, or along what slides."""
    w, v = next(column for s, column in zip(link.s, link.S, strict=False) if q in symbols_of((s,)))
    return SymbolForm("shifted", link.point, v) if all(map(is_zero, w)) else SymbolForm("turned", link.point)
