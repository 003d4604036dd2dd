"""Model -> FreeBodies: each body cut free with its forces, reactions and inertia, in numbers, as a text, drawn."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import islice
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
from eomgen.mechanics.free_bodies import Balance, CutForce, ForceKind, forces_on_bodies, named_reactions
from eomgen.model import AtRest, ModelOrPath, Values, WrittenEquation, equation_in
from eomgen.proof import Certificate, ReportedForce, certify, cuts_reported
from eomgen.resources import doing
from eomgen.results.at_rest.steps import letter_of_load, letter_of_reaction
from eomgen.results.bodies_cut_free.cut_state import CutState, cut_state
from eomgen.scene import (
    ARROW,
    Drawing,
    DrawnArrow,
    Scene,
    SceneNumbers,
    frame_at,
    is_freer_outward,
    never_short,
    plane_drawing,
    scene_of_cut_body,
    scene_of_system,
    space_drawing,
)
from eomgen.study import model_to_study
from eomgen.symbolic.expression import Scalar, Vector, is_zero
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import Notation, Setter, Symbol, text_size, to_text

STAYING = (ForceKind.REACTION, ForceKind.SPRING, ForceKind.DAMPER, ForceKind.DRIVE)  # listed where they are 0
NEWTON, NEWTON_METER = "N", "N*m"
NOISE = 10 * tolerances.ROUNDING  # of the largest, which rounding leaves of a 0


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
        for each in self.numbered:
            found[each.push.body].append(self._force(each))
        return {name: FreeBody(name, tuple(forces)) for name, forces in found.items() if forces}

    @cached_property
    def numbered(self) -> tuple[NumberedForce, ...]:
        """All that acts, in numbers, at the parameters as they are drawn; what is nothing there is left out."""
        made = _with_resultants(numbered_forces(self.state, forces_on_bodies(self.state.balance)))
        sizes = (abs(each.value) for each in made if each.value is not None)
        noise = NOISE * max(sizes, default=0.0)
        quiet = [replace(e, value=0.0) if e.value is not None and abs(e.value) <= noise else e for e in made]
        return tuple(each for each in quiet if each.value != 0 or each.stays)

    def _force(self, each: NumberedForce) -> BodyForce:
        push, count = each.push, 2 if self.state.system.scope.model.space == "plane" else 3
        direction = each.direction if push.turns else each.direction[:count]
        value = None if self.state.drawn.assumed else each.value
        unit = NEWTON_METER if push.turns else NEWTON
        letter = letter_of_force(self.state.balance, push)
        at, way = _plain(each.at[:count]), _plain(direction)
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
        reported = [each.reported for each in self.numbered]
        return base + cuts_reported(state.system, equations, state.begun_with_unknowns, reported)

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
        at = AtRest() if at.strip() == AtRest.text else equation_in(model, at)
    found = FreeBodies(cut_state(model, at))
    _ = found.bodies  # what cannot be cut free is refused here
    return found


# -------- in numbers ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class NumberedForce:
    """A push in numbers, ground axes.

    Args:
        at: 3 [m].
        direction: unit vector, 3; zeros where there is none.
        value: along it; None where it has no single value.
    """

    push: CutForce
    at: np.ndarray
    direction: np.ndarray
    value: float | None

    @property
    def stays(self) -> bool:
        """True if it is listed where it is 0: a reaction, a spring, a damper."""
        return self.push.kind in STAYING and bool(np.any(self.direction))

    @property
    def reported(self) -> ReportedForce:
        """The force as the proof reads it."""
        push, vector = self.push, None if self.value is None else self.value * self.direction
        force, couple = (np.zeros(3), vector) if push.turns else (vector, np.zeros(3))
        return ReportedForce(push.body, push.name, push.kind, self.at, force, couple)


def numbered_forces(state: CutState, pushes: Sequence[CutForce]) -> list[NumberedForce]:
    """Pushes at a state."""
    flat: list[Scalar] = []
    for push in pushes:
        flat += [*push.at, *push.direction, *(push.along or Vector.ZERO), push.given, *push.shares.values()]
    numbers = iter(state.numbers(flat))
    return [_numbered(push, numbers, state.components) for push in pushes]


def _numbered(push: CutForce, numbers: Iterator[float], components: Sequence[float | None]) -> NumberedForce:
    at, vector, along = (np.array(list(islice(numbers, 3))) for _ in range(3))
    value: float | None = next(numbers)
    for j, share in zip(push.shares, islice(numbers, len(push.shares)), strict=True):
        known = components[j]
        value = None if value is None or known is None else value + share * known
    line = along if np.any(along) else vector
    length = float(np.linalg.norm(line))
    unit = line / length if length > 0 and math.isfinite(length) else np.zeros(3)
    size = float(vector @ unit)
    value = None if value is None or not math.isfinite(value * size) else value * size
    return NumberedForce(push, at, unit, value)


def _with_resultants(pushes: Sequence[NumberedForce]) -> list[NumberedForce]:
    """The pushes, with one force for the two that replace a load along a line, where these have one direction."""
    found: list[NumberedForce] = []
    for each in pushes:
        twin = found[-1] if found and each.push.spread and found[-1].push.spread else None
        if twin is not None and (twin.push.name, twin.push.body) == (each.push.name, each.push.body):
            a, b = twin.value or 0.0, each.value or 0.0
            if a + b > 0 and min(a, b) >= 0 and np.allclose(twin.direction, each.direction, atol=tolerances.COMPUTED):
                found[-1] = replace(twin, at=(a * twin.at + b * each.at) / (a + b), value=a + b)
                continue
        found.append(each)
    return found


def _plain(numbers: np.ndarray) -> tuple[float, ...]:
    """Numbers without what rounding leaves."""
    return tuple(0.0 if abs(x) < NOISE else float(x) for x in numbers)


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
    drawings = [_drawing(state, scene, body) for body in bodies.values()]
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


def _drawing(state: CutState, scene: Scene, body: FreeBody) -> Drawing:
    """A body with the arrows of its forces."""
    bare = _drawn(scene_of_cut_body(scene, body.name), state)
    lines = [s.path[0] for s in bare.strokes if s.of == body.name] if scene.plane else []
    arrows = _arrows(body.forces, lines, bare.sizes.extent)
    return _drawn(scene_of_cut_body(scene, body.name, arrows), state)


def _drawn(scene: Scene, state: CutState) -> Drawing:
    numbers = SceneNumbers(scene, frame_at(scene, state.drawn)[None, :])
    return (plane_drawing if scene.plane else space_drawing)(numbers, symbol=SYMBOL)


def _arrows(forces: Sequence[BodyForce], lines: Sequence[np.ndarray], extent: float) -> Iterator[DrawnArrow]:
    """The forces, along the directions in which their letters are positive."""
    largest = max((abs(force.value or 0.0) for force in forces if not force.turns), default=0.0) or 1.0
    for force in forces:
        size = largest if force.value is None or force.turns else abs(force.value)
        way = never_short(size, largest, SHORTEST) * np.array(force.direction)
        at = (force.at[0], force.at[1])
        x, y = (float(v) for v in ARROW * extent * way[:2])
        outward = not lines or not is_freer_outward(lines, at, (-x, -y))
        role = "reaction" if force.kind == ForceKind.REACTION else "force"
        yield DrawnArrow(force.name, force.at, way, role, force.name, force.turns, outward)


# -------- letters ---------------------------------------------------------------------------------------------


def letter_of_force(balance: Balance, push: CutForce) -> str:
    """The letter of a force in LaTeX: of a reaction as derivations have it, of a load its formula where it is short."""
    notation = notation_of(balance.system.scope.model)
    if push.kind == ForceKind.INERTIA:
        return r"-I\,\alpha" if push.turns else r"-m\,a"
    if push.shares:
        named = next((each for each in named_reactions(balance) if each.name == push.name), None)
        own = None if named is None else own_symbol(balance, named)
        return own.tex if own is not None else notation.latex(letter_of_reaction(push.name))
    if push.kind in (ForceKind.WEIGHT, ForceKind.APPLIED):
        name = "G" if push.kind == ForceKind.WEIGHT else letter_of_load(push.name, notation)
        return _formula(push, notation) or name
    owner = push.name.partition("(")[2].rstrip(")") or push.name
    return notation.latex(f"{'M' if push.turns else 'F'}_{owner}")


def _formula(push: CutForce, notation: Notation) -> str:
    """The size of a load along an axis, m g; "" where it is long, or along none."""
    parts = [x for x in push.direction if not is_zero(x)]
    if len(parts) != 1:
        return ""
    (x,) = parts
    size = -x if to_text(x).startswith("-") else x
    return Setter(notation).set(size).tex if text_size(size) <= SHORT else ""
