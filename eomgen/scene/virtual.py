"""WorkEquation -> picture of a virtual displacement: a structure with one reaction released, moved and back.

Every body is displaced by its part of the velocity plan, to the first order as the principle of virtual work has it:

    p -> p + s v,   R -> R + s w x R

so that joints and constraints stay closed exactly; s swings once to each side.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Axes, Effect, Structure, numeral
from eomgen.mechanics.kinematics import BodyLink, SystemScene
from eomgen.mechanics.statics import StaticReaction, WorkEquation
from eomgen.model import UniformField
from eomgen.scene.bodies import parameters_as_drawn
from eomgen.scene.forms import ArrowForm, CoupleForm, SymbolForm
from eomgen.scene.making import center_marks, scene_of_system
from eomgen.scene.scene import Mark, Scene
from eomgen.scene.space_strokes import drawing_of
from eomgen.scene.strokes import SceneNumbers
from eomgen.symbolic.expression import Matrix, Node, Pose, Scalar, Vector, is_zero
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances

SWING = 0.12  # of the extent, by which the point that moves most is swung out
IN_SIGHT = 0.5  # of the extent: centres of rotation farther outside are not drawn
SOLID = frozenset(("body", "inertia", "member"))
SHARE = "(share of the virtual displacement)"


def swing_of(numbers: SceneNumbers, step: float) -> float:
    """Size of the displacement at which the body that moves most moves by SWING of the picture's extent."""
    drawing = drawing_of(numbers)
    solid = [s.path.reshape(numbers.size, -1) for s in drawing.strokes if s.role in SOLID]
    moved = max((float(np.nanmax(np.abs(path - path[0]))) for path in solid if path.size), default=0.0)
    return SWING * drawing.sizes.extent * step / moved if moved > 0 else 0.0


@dataclass(frozen=True)
class VirtualDisplacement:
    """A structure of which one reaction is released.

    Args:
        structure: as it stands.
        reaction: the one released, with its equation of virtual work.
    """

    structure: Structure
    reaction: StaticReaction

    @property
    def equation(self) -> WorkEquation:
        assert self.reaction.work is not None, "an indeterminate reaction has no displacement"
        return self.reaction.work

    @property
    def moves(self) -> bool:
        """True if the release lets anything move."""
        return bool(self.equation.plan.moving)

    def along(self, phases: np.ndarray) -> SceneNumbers:
        """Frames at phases of the swing; phase 0 is the structure at rest [rad]."""
        step = np.array([0.0, tolerances.WIDE_STEP])
        size = swing_of(SceneNumbers(self.scene, self._frames(step)), tolerances.WIDE_STEP)
        return SceneNumbers(self.scene, self._frames(size * np.sin(phases)))

    @cached_property
    def scene(self) -> Scene:
        """Bodies displaced by the share s, loads that work, the reaction in its positive sense."""
        system = self._displaced
        scene = scene_of_system(system)
        constraints = system.scope.model.constraints
        named = self.reaction.named
        owner = named.owner if named is not None and named.owner in constraints else None
        kept = [m for m in scene.marks if not (m.of == owner and isinstance(m.form, SymbolForm))]
        return replace(scene, marks=(*kept, *self._weights(system), *self._released(system), *self._centers()))

    # -- the bodies ------------------------------------------------------------------------------------

    @property
    def _share(self) -> Node:
        share: Node = self.structure.system.symbols.graph.symbol(SHARE)
        return share

    @cached_property
    def _displaced(self) -> System:
        system = self.equation.plan.system
        links = tuple(replace(link, pose=self._pose(link)) for link in system.motion.links)
        return replace(system, motion=replace(system.motion, links=links))

    def _pose(self, link: BodyLink) -> Pose:
        plan, s, pose = self.equation.plan, self._share, link.pose
        if link.name not in plan.moving:
            return pose
        v, w = plan.raw_velocity((link.name, Vector.ZERO)), plan.raw_spin(link.name)
        axes = [e + s * w.cross(e) for e in pose.R.T]
        return Pose(Matrix.of((axes[0], axes[1], axes[2])).T, pose.p + s * v)

    def _frames(self, shares: np.ndarray) -> np.ndarray:
        system, scene = self._displaced, self.scene
        own = {**system.inputs, SHARE: 0}
        symbols = replace(system.symbols, inputs={**system.symbols.inputs, SHARE: self._share})
        program = Program.of(scene.values, symbols, inputs=own)
        x, inputs = self._numbers(system.symbols.x), self._numbers(tuple(own.values()))
        table = np.tile(inputs, (len(shares), 1))
        table[:, -1] = shares
        p = list(parameters_as_drawn(system).values())
        with np.errstate(all="ignore"):
            found: np.ndarray = RightHandSide.of(program, "numpy").many(0.0, np.tile(x, (len(shares), 1)), p, table)
        return found

    # -- forces ----------------------------------------------------------------------------------------

    def _weights(self, system: System) -> Iterator[Mark]:
        """Arrows of the weights of all bodies with mass."""
        for force in system.loads.applied:
            for load in force.loads:
                if isinstance(load, UniformField):
                    for place, m in SystemScene(system.motion).masses(None):
                        if not is_zero(m):
                            at = system.motion.position(place)
                            yield Mark(ArrowForm(at, m * load.acceleration, "N"), 0, "force", force.name)

    def _released(self, system: System) -> Iterator[Mark]:
        """A unit of the reaction on every body that it acts on, its name at the first."""
        axes, name = Axes(system.motion), self.reaction.name
        text, pulls = name, name.startswith("tension(")
        for effect in self.effects:
            place = axes.masses[effect.link].com if effect.place is None else effect.place
            frame = 0 if axes.plane else effect.link + 1
            at = system.motion.links[effect.link].pose.point(place) if axes.plane else place
            if not all(map(is_zero, effect.force)):
                yield Mark(ArrowForm(at, effect.force, "1", outward=pulls, text=text), frame, "reaction", name)
            elif not all(map(is_zero, effect.couple)):
                yield Mark(CoupleForm(at, effect.couple, text), frame, "reaction", name)
            text = ""

    @property
    def effects(self) -> list[Effect]:
        """Effects of a unit of the reaction, summed once for each body at each place."""
        named, found = self.reaction.named, dict[tuple[int, Vector | None], Effect]()
        for j, k in named.combination.items() if named is not None else ():
            for effect in self.structure.components[j].effects:
                key, more = (effect.link, effect.place), effect.times(k)
                had = found.get(key)
                if had is not None:
                    more = replace(more, force=had.force + more.force, couple=had.couple + more.couple)
                found[key] = more
        return list(found.values())

    def _centers(self) -> Iterator[Mark]:
        """The centres of rotation of the blocks that are in sight, by the blocks' numbers; in the plane."""
        plan, system = self.equation.plan, self.equation.plan.system
        if system.scope.model.space != "plane":
            return
        places = [at for name, at in scene_of_system(system).points]
        spots = np.array(self._numbers([x for place in places for x in place[:2]])).reshape(-1, 2)
        low, high = (spots.min(axis=0), spots.max(axis=0)) if len(spots) else (np.zeros(2), np.zeros(2))
        reach = IN_SIGHT * float(np.max(high - low))
        for number, block in enumerate(plan.blocks, start=1):
            place = block.center(plan).place
            if place is None:
                continue
            spot = np.array(self._numbers(place[:2]))
            if np.all(spot > low - reach) and np.all(spot < high + reach):
                yield from center_marks([(numeral(number), place)])

    def _numbers(self, scalars: Sequence[Scalar]) -> list[float]:
        """Scalars where the structure stands."""
        system = self.equation.plan.system
        known: dict[Node, Any] = {**parameters_as_drawn(system)}
        nodes = system.symbols.x
        at = evaluate([self.structure.at.get(node, 0) for node in nodes], known, FLOAT)
        known |= {system.symbols.t: 0.0, **dict(zip(nodes, at, strict=True))}
        return [float(x) for x in evaluate(scalars, known, FLOAT)]
