"""Model -> FreeBodies: each body cut free with its forces, reactions and inertia, in numbers, as a text, drawn."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import (
    Document,
    Picture,
    Result,
    Step,
    document_of,
    draw_scene,
    four_figures,
    narrow_grid,
    notation_of,
    own_symbol,
    page_shape,
    prose,
)
from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import ForceKind
from eomgen.model import AtRest, ModelOrPath, Requests, Values, WrittenEquation
from eomgen.proof import Certificate, certify, cuts_reported
from eomgen.resources import doing
from eomgen.results.at_rest.steps import letter_of_load, letter_of_reaction
from eomgen.scene import (
    ARROW,
    DrawnArrow,
    SceneNumbers,
    drawing_of,
    scene_of_cut_body,
    scene_of_system,
)
from eomgen.study import CutState, model_to_study
from eomgen.symbolic.expression import Vector, is_zero
from eomgen.symbolic.print import Notation, Setter, Symbol, text_size, to_text

NEWTON, NEWTON_METER = "N", "N*m"


@dataclass(frozen=True)
class BodyForce:
    """A force or a couple on a body that is cut free: value times direction.

    Args:
        name: of a reaction as an output writes it, reaction_x(A); of a load its own.
        at: its place, ground axes [m].
        direction: the unit vector along which its value is positive, ground axes; of a couple always 3 numbers.
        value: in `unit`; None where it has no single value, or a parameter has none.
        kind: weight, spring, damper, drive, applied, reaction or inertia.
        unit: "N", of a couple "N*m".
        letter: by which formulas and pictures have it, in LaTeX.
        has_sense: its sense is no matter of a letter: of loads, pulls of strings, pushes of contacts, sliding friction.
    """

    name: str
    at: tuple[float, ...]
    direction: tuple[float, ...]
    value: float | None
    kind: str
    unit: str
    letter: str
    has_sense: bool = False

    @property
    def turns(self) -> bool:
        """True of a couple."""
        return self.unit == NEWTON_METER


@dataclass(frozen=True)
class FreeBody:
    """A body with all that acts on it.

    Args:
        name: the body's.
        forces: weights, loads, springs, dampers, drives, reactions, inertia.
    """

    name: str
    forces: tuple[BodyForce, ...]


@dataclass(frozen=True)
class FreeBodies(Result):
    """Every body of a model cut free, at one instant.

    Args:
        state: the bodies then.
    """

    state: CutState

    def __repr__(self) -> str:
        return f"<free bodies of {self.state.system.scope.model.name!r}: {', '.join(self.bodies)}>"

    @cached_property
    def bodies(self) -> dict[str, FreeBody]:
        """Each body by its name, in the order of the model, with what acts on it."""
        found: dict[str, list[BodyForce]] = {link.name: [] for link in self.state.system.motion.links}
        for k, each in enumerate(self.state.forces):
            found[each.push.body].append(self._force(k))
        return {name: FreeBody(name, tuple(forces)) for name, forces in found.items() if forces}

    def _force(self, k: int) -> BodyForce:
        each = self.state.forces[k]
        push, count = each.push, 2 if self.state.system.scope.model.space == "plane" else 3
        direction = each.direction if push.turns else each.direction[:count]
        value = None if self.state.drawn.assumed else each.value
        unit = NEWTON_METER if push.turns else NEWTON
        letter = letter_of_force(self.state, k)
        at, way = tuple(each.at[:count].tolist()), tuple(direction.tolist())
        return BodyForce(push.name, at, way, value, push.kind, unit, letter, push.has_sense)

    @property
    def picture(self) -> Picture:
        """Each body by itself, with its forces under their letters."""
        return free_bodies_picture(self.state, self.bodies)

    def _repr_svg_(self) -> str:
        """The picture, for notebooks."""
        return self.picture.svg

    def certify(self) -> Certificate:
        """Check the equations of motion; of the numbers that leave: equilibrium, opposites, loads, inertia."""
        state = self.state
        equations = None if state.rests else state.study.equations
        base = Certificate(()) if equations is None else certify(equations)
        return base + cuts_reported(state.system, equations, state.begun_with_unknowns, self._reported())

    def _reported(self) -> Iterator[tuple[str, str, str, np.ndarray, np.ndarray | None, np.ndarray | None]]:
        """(body, name, kind, place, force, couple) of each force, as the proof reads it."""
        for each in self.state.forces:
            push, vector = each.push, None if each.value is None else each.value * each.direction
            force, couple = (np.zeros(3), vector) if push.turns else (vector, np.zeros(3))
            yield push.body, push.name, push.kind, each.at, force, couple

    @cached_property
    def derivation(self) -> Document:
        """A table of the forces on each body."""
        state, assumed = self.state, self.state.drawn.assumed
        drawn = f", with {', '.join(assumed)} = 1" if assumed else ""
        words = f"Each body cut free {state.when}{drawn}; what joins two bodies pushes both, with opposite directions."
        steps = [Step("free bodies", "Free bodies", (prose(words),))]
        for name, body in self.bodies.items():
            grid = narrow_grid(HEAD, [_row(force) for force in body.forces])
            steps.append(Step(f"free body {name}", f"Forces on {name}", (grid,)))
        return document_of(state.system.scope.model, "free bodies", tuple(steps))

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        return {
            "name": self.state.system.scope.model.name,
            "when": self.state.when,
            "assumed": list(self.state.drawn.assumed),
            "bodies": {name: [_entry(force) for force in body.forces] for name, body in self.bodies.items()},
        }


@doing("the free bodies")
def free_bodies(
    model: ModelOrPath,
    at: WrittenEquation | AtRest | str | None = None,
    *,
    parameters: Values | None = None,
    start: Values | None = None,
) -> FreeBodies:
    """Each body of a model cut free, with its forces, reactions and inertia.

    Args:
        at: the instant: an equation that is first met then, or "equilibrium"; None: the start, of a structure at rest.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        DerivationError: something acts at no place; a body is unsupported; there is no such instant.
        MissingValues: an instant later than the start needs values of all parameters.
    """
    model = model_to_study(model, parameters, start)
    if isinstance(at, str):
        at = AtRest() if at.strip() == AtRest.text else Requests(model).equation(at)
    found = FreeBodies(CutState.of(model, at))
    _ = found.bodies  # what cannot be cut free is refused here
    return found


# -------- as text ---------------------------------------------------------------------------------------------


HEAD = ("force", "kind", "at [m]", "direction", "value")


def _row(force: BodyForce) -> tuple[str, ...]:
    value = "" if force.value is None else f"{four_figures(force.value)} {force.unit.replace('*', ' ')}"
    turn = "counter-clockwise" if force.direction[-1] > 0 else "clockwise"
    way = (turn,) if force.turns and len(force.at) == 2 else map(four_figures, force.direction)
    return force.name, force.kind, _listed(map(four_figures, force.at)), _listed(way), value


def _listed(words: Iterable[str]) -> str:
    found = list(words)
    return found[0] if len(found) == 1 else f"({', '.join(found)})"


def _entry(force: BodyForce) -> dict[str, Any]:
    return {
        "name": force.name,
        "kind": force.kind,
        "at": list(force.at),
        "direction": list(force.direction),
        "value": force.value,
        "unit": force.unit,
        "letter": force.letter,
    }


# -------- drawn -----------------------------------------------------------------------------------------------
# Each body by itself, drawn as in the scene; an arrow points where its letter is positive, and is never very short.


COLUMNS, SIDE, TITLE = 3, 3.1, 0.3  # panels side by side; their width; height of what is written [inches]
SYMBOL = 0.045  # size of symbols, of the extent
TALLEST, FLATTEST = 1.25, 0.5  # of a panel, height over width
SHORTEST = 0.55  # of arrows, of the longest
SHORT = 16  # characters of a formula that stands for the name of a load


def free_bodies_picture(state: CutState, bodies: Mapping[str, FreeBody]) -> Picture:
    """A panel for each body."""
    scene = scene_of_system(state.system)
    drawings = []
    for body in bodies.values():
        bare = drawing_of(SceneNumbers.at(scene_of_cut_body(scene, body.name), state.drawn), symbol=SYMBOL)
        lines = [s.path[0] for s in bare.strokes if s.of == body.name] if scene.plane else []
        arrows = _arrows(body.forces, lines, bare.sizes.extent)
        whole = scene_of_cut_body(scene, body.name, arrows)
        drawings.append(drawing_of(SceneNumbers.at(whole, state.drawn), symbol=SYMBOL))
    columns = max(1, min(COLUMNS, len(drawings)))
    rows = max(1, math.ceil(len(drawings) / columns))
    tall = [float(np.clip(page_shape(each), FLATTEST, TALLEST)) for each in drawings]
    heights = [max(tall[columns * k : columns * (k + 1)], default=FLATTEST) for k in range(rows)]
    notation = notation_of(scene.system.scope.model)

    def fill(figure: Any) -> None:
        panels = list(figure.subplots(rows, columns, squeeze=False, height_ratios=heights).flat)
        for panel, body, drawing in zip(panels, bodies.values(), drawings, strict=False):
            letters = {force.name: Symbol(force.name, force.letter) for force in body.forces}
            draw_scene(panel, drawing, notation.with_symbols(letters))
            panel.set_title(body.name.replace("$", r"\$"), fontsize=10)
        for panel in panels[len(drawings) :]:
            panel.axis("off")

    return Picture((SIDE * columns, sum(SIDE * height + TITLE for height in heights) + TITLE), fill, scene.name)


def _arrows(forces: Sequence[BodyForce], lines: Sequence[np.ndarray], extent: float) -> Iterator[DrawnArrow]:
    """The forces, along the directions in which their letters are positive."""
    largest = max((abs(force.value or 0.0) for force in forces if not force.turns), default=0.0) or 1.0
    for force in forces:
        size = largest if force.value is None or force.turns else abs(force.value)
        way = DrawnArrow.never_short(size, largest, SHORTEST) * np.array(force.direction)
        at = (force.at[0], force.at[1])
        x, y = (float(v) for v in ARROW * extent * way[:2])
        outward = not lines or not DrawnArrow.is_freer_outward(lines, at, (-x, -y))
        role = "reaction" if force.kind == ForceKind.REACTION else "force"
        yield DrawnArrow(force.name, force.at, way, role, force.name, force.turns, outward)


# -------- letters ---------------------------------------------------------------------------------------------


def letter_of_force(state: CutState, k: int) -> str:
    """The letter of a force in LaTeX: of a reaction as derivations have it, of a load its formula where it is short."""
    push, notation = state.forces[k].push, notation_of(state.system.scope.model)
    if push.kind == ForceKind.INERTIA and not push.name.startswith("fluid("):
        return r"-I\,\alpha" if push.turns else r"-m\,a"
    if push.shares:
        named = next((each for each in state.study.named_reactions if each.name == push.name), None)
        own = None if named is None else own_symbol(state.balance, named)
        return own.tex if own is not None else notation.latex(letter_of_reaction(push.name))
    if push.kind in (ForceKind.WEIGHT, ForceKind.APPLIED):
        name = "G" if push.kind == ForceKind.WEIGHT else letter_of_load(push.name, notation)
        return _formula(push.direction, notation) or name
    owner = push.name.partition("(")[2].rstrip(")") or push.name
    return notation.latex(f"{'M' if push.turns else 'F'}_{owner}")


def _formula(load: Vector, notation: Notation) -> str:
    """The size of a load along an axis, m g; "" where it is long, or along none."""
    parts = [x for x in load if not is_zero(x)]
    if len(parts) != 1:
        return ""
    (x,) = parts
    size = -x if to_text(x).startswith("-") else x
    return Setter(notation).set(size).tex if text_size(size) <= SHORT else ""
