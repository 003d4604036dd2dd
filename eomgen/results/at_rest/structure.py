"""StaticReactions -> Sketch: a structure with its loads and its reactions, in the plane and in space.

An arrow points as its force does and is longer for a larger one, without a scale; its name has the value.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import Scale, Sketch, draw_model, name_along, notation_of, own_symbol, scale_of
from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import Axes, Component, Effect
from eomgen.mechanics.statics import StaticReactions
from eomgen.model import Couple, PointForce, SpreadLoad
from eomgen.results.at_rest.steps import letter_of_load, letter_of_reaction
from eomgen.scene import DrawnArrow, Mark, arrow_marks, is_freer_outward, never_short, spread_mark
from eomgen.symbolic.expression import Scalar, Vector
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import Setter, Symbol, text_size, to_text

TENSION, COMPRESSION, NOTHING = "#2457a6", "#b03a2e", "#808080"
LONGEST, SHORTEST = 0.13, 0.45  # of arrows, of the extent; of the longest
LONGEST_LABEL = 24  # characters of a formula next to an arrow
MOST = 10  # times as large is not even printed
MET = ("body", "hole", "member")  # roles of lines that an arrow should not run along


@dataclass(frozen=True)
class ActingArrow:
    """A force or couple of a structure, in numbers.

    Args:
        of: the load, or the component of a reaction, by name.
        at, vector: ground axes, 2 or 3; of a couple always 3.
        words, tex: its name and value, "" where it has none.
    """

    of: str
    role: str
    at: np.ndarray
    vector: np.ndarray
    words: str
    tex: str
    turns: bool = False

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.vector))


@dataclass(frozen=True)
class StaticScene:
    """Content of a picture of a structure.

    Args:
        statics: the structure with its reactions.
        known: all parameters have values; else those without are drawn as 1, and formulas stand for numbers.
    """

    statics: StaticReactions
    known: bool

    @cached_property
    def bare(self) -> Sketch:
        """The structure without what acts on it."""
        system, at = self.statics.system, self.statics.structure.at
        values = system.scope.model.exact_parameters()
        numbers = {node: float(values.get(name, 1)) for name, node in system.symbols.parameters.items()}
        numbers |= {p: 1.0 for p in system.symbols.unknowns.values()}
        plain = Sketch(system, numbers)
        found = dict(zip(at, plain.numbers(at.values()), strict=True))
        unknowns = self.statics.balance.unknowns
        found |= dict(zip(unknowns, plain.numbers(unknowns.values()), strict=True))
        return Sketch(system, {**numbers, **found}, dimensions=True, longest=LONGEST)

    @cached_property
    def sketch(self) -> Sketch:
        """The structure with its loads and reactions."""
        letters = {each.words: _plainly(each.words, each.tex) for each in self.acting if each.words}
        spread = [*self._spreads()]
        letters |= {words: _plainly(words, tex) for _, words, tex in spread}
        marks = (*arrow_marks(self._drawn()), *(mark for mark, _, _ in spread))
        return replace(self.bare, more=marks, letters=letters, colors=self._colors())

    @property
    def proportion(self) -> float:
        """Height over width of all that is drawn, with room for names."""
        paths = [self.bare.page(s.path[0]) for s in self.sketch.drawing.strokes if s.role != "track"]
        places = np.concatenate([path.reshape(-1, 2) for path in paths if path.size])
        wide, tall = np.ptp(places[np.isfinite(places).all(axis=1)], axis=0) + 0.2 * self.bare.extent
        return float(tall / wide)

    @property
    def balanced(self) -> bool:
        """True if all that acts is drawn, each with its size beside it."""
        components = self.statics.structure.components
        outer = [j for j, component in enumerate(components) if len(component.effects) == 1]
        solved = all(self.statics.balance.solution.determined(j) for j in outer)
        plain = not any(components[j].friction or components[j].is_wrench for j in outer)
        return self.known and solved and plain and all(acting.load is not None for acting in self.statics.loads)

    @property
    def written(self) -> Setter | None:
        """Typesetting of formulas that stand for numbers; None where numbers are known."""
        return None if self.known else Setter(notation_of(self.statics.system.scope.model))

    # -- what acts -----------------------------------------------------------------------------------------

    @cached_property
    def acting(self) -> list[ActingArrow]:
        """Every single force and couple, loads first."""
        return [*self._loads(), *self._reactions()]

    def _loads(self) -> Iterator[ActingArrow]:
        motion = self.statics.system.motion
        for acting in self.statics.loads:
            load = acting.load
            if isinstance(load, PointForce) and load.place[0] is not None:
                at = self.bare.spot(motion.position(load.place))
                force = self.bare.spot(motion.in_ground_axes(load.force, load.axes))
                size = float(np.linalg.norm(force))
                if size:
                    yield ActingArrow(acting.name, "force", at, force, *self._named(acting.name, (size,), "N"))
            elif isinstance(load, Couple):
                couple = np.array(self.bare.numbers(motion.in_ground_axes(load.couple, load.axes)))
                at = self._middle(load.body) if load.place is None else self.bare.spot(motion.position(load.place))
                size = float(np.linalg.norm(couple))
                words = self._named(acting.name, (size,), "N m")
                yield ActingArrow(acting.name, "force", at, couple, *words, turns=True)

    def _reactions(self) -> Iterator[ActingArrow]:
        """The determinate reactions of the ground."""
        motion = self.statics.system.motion
        axes, named = Axes(motion), self._named_alone()
        for j, component in enumerate(self.statics.structure.components):
            if len(component.effects) != 1 or not self.statics.balance.solution.determined(j):
                continue
            (effect,) = component.effects
            link = motion.links[effect.link]
            name, sense = named.get(j, (component.name, 1))
            reaction = self.statics.by_name.get(name)
            value = (
                sense * self.statics.balance.value(j) if reaction is None or reaction.value is None else reaction.value
            )
            for turns, own in ((False, effect.force), (True, effect.couple)):
                vector = sense * np.array(self.bare.numbers(own if axes.plane else link.pose.R @ own))
                if not vector.any():
                    continue
                number, words, tex = self._shown(name, value, "N m" if turns else "N")
                at = self._seat(component) if turns else self.place(effect)
                kept = vector if turns or not axes.plane else vector[:2]
                yield ActingArrow(name, "reaction", at, number * kept, words, tex, turns)

    def _named_alone(self) -> dict[int, tuple[str, int]]:
        """(name, sense) of the reaction that is one component alone, by the component's number."""
        found = {}
        for reaction in self.statics.reactions:
            combination = {} if reaction.named is None else reaction.named.combination
            if len(combination) == 1:
                ((j, factor),) = combination.items()
                if type(factor) is int and abs(factor) == 1:
                    found[j] = (reaction.name, factor)
        return found

    def _spreads(self) -> Iterator[tuple[Mark, str, str]]:
        """(mark, words, typeset) of line loads: the size at both ends where it changes."""
        motion = self.statics.system.motion
        for acting in self.statics.loads:
            load = acting.load
            if isinstance(load, SpreadLoad):
                sizes = [math.hypot(*self.bare.numbers(q)) for q in (load.at_start, load.at_end)]
                words, tex = self._named(acting.name, sizes, "N/m")
                yield spread_mark(motion, load, acting.name, words), words, tex

    def _drawn(self) -> list[DrawnArrow]:
        """The arrows; of a reaction that is zero the name alone."""
        largest = max((each.size for each in self.acting if not each.turns), default=0.0) or 1.0
        reach, lines = LONGEST * self.bare.extent, self.bare.lines(MET)
        drawn: list[DrawnArrow] = []
        for each in sorted(self.acting, key=lambda each: each.turns):
            zero = each.size <= tolerances.COMPUTED * (self.largest if each.turns else largest)
            if zero and each.role == "force":
                continue
            length = 0.0 if zero else 1.0 if each.turns else never_short(each.size, largest, SHORTEST)
            vector = each.vector * (length / each.size if each.size else 0.0)
            at, way = self.bare.page(each.at).tolist(), (reach * self.bare.page(vector)).tolist()
            outward = each.of.startswith("tension(") or (not each.turns and is_freer_outward(lines, at, way))
            at = each.at
            if each.turns and not self.bare.plane:
                at = at + self._beside(at, vector, drawn)
            drawn.append(DrawnArrow(each.of, at, vector, each.role, each.words, each.turns, outward))
        return drawn

    def _beside(self, at: np.ndarray, couple: np.ndarray, drawn: Sequence[DrawnArrow]) -> np.ndarray:
        """Way from the place of a couple in space to where it starts: beyond a force that is drawn along it there."""
        reach = 1.1 * LONGEST * self.bare.extent
        for force in (each for each in drawn if not each.turns and np.allclose(each.at, at)):
            taken = np.array(force.vector) * (1 if force.outward else -1)
            sizes = float(np.linalg.norm(taken) * np.linalg.norm(couple))
            if taken @ couple > (1 - tolerances.SAME_ARROW) * sizes > 0:
                beyond: np.ndarray = reach * taken
                return beyond
        return np.zeros(3)

    # -- places --------------------------------------------------------------------------------------------

    def place(self, effect: Effect) -> np.ndarray:
        """Place where a reaction acts, ground axes."""
        axes = Axes(self.statics.system.motion)
        link = axes.motion.links[effect.link]
        center = self.bare.spot(link.pose.point(axes.masses[effect.link].com))
        found: np.ndarray = center + self.bare.spot(effect.arm if axes.plane else link.pose.R @ effect.arm)
        return found

    def _seat(self, couple: Component) -> np.ndarray:
        """Place of a drawn couple: at the forces of its constraint or joint, else in the middle of the body."""
        for other in self.statics.structure.components:
            if other.owner == couple.owner and other.label != couple.label and len(other.effects) == 1:
                return self.place(other.effects[0])
        return self._middle(self.statics.system.motion.links[couple.effects[0].link].name)

    def _middle(self, body: str) -> np.ndarray:
        motion = self.statics.system.motion
        own = motion.points[body].items()
        places = [motion.position((body, r)) for name, r in own if name not in ("origin", "center")]
        spots = [self.bare.spot(place) for place in places or [motion.position((body, Vector.ZERO))]]
        found: np.ndarray = np.mean(spots, axis=0)
        return found

    # -- words ---------------------------------------------------------------------------------------------

    @property
    def scale(self) -> Scale:
        """Scale of all forces and couples, of the loads and the reactions."""
        return scale_of(self._sizes)

    @property
    def largest(self) -> float:
        """Size of the largest load and reaction."""
        return max(map(abs, self._sizes), default=0.0)

    @cached_property
    def _sizes(self) -> list[float]:
        """Sizes of the forces among the loads, and all reactions."""
        forces = [acting.load.force for acting in self.statics.loads if isinstance(acting.load, PointForce)]
        values = self.bare.numbers(each.value for each in self.statics.reactions if each.value is not None)
        return [*(math.hypot(*self.bare.numbers(force)) for force in forces), *values]

    def _named(self, load: str, sizes: Iterable[float], unit: str) -> tuple[str, str]:
        """(words, typeset): a load by its name, with its size, or sizes."""
        tex = letter_of_load(load, notation_of(self.statics.system.scope.model))
        if not self.known:
            return load, tex
        numbers = list(dict.fromkeys(self.scale.number(size) for size in sizes))
        unit = self.scale.unit(unit)
        return f"{load} = {' to '.join(numbers)} {unit}", f"{tex} = {plain(' to '.join(numbers) + ' ' + unit)}"

    def _letter(self, name: str) -> str:
        """The letter of a reaction, typeset."""
        named = next((r.named for r in self.statics.reactions if r.name == name), None)
        own = None if named is None else own_symbol(self.statics.balance.balance, named)
        notation = notation_of(self.statics.system.scope.model)
        return notation.latex(letter_of_reaction(name)) if own is None else own.tex

    def _shown(self, name: str, value: Scalar, unit: str) -> tuple[float, str, str]:
        """(a value in the sense in which its label is positive, words, typeset): a number, or a short formula."""
        (number,) = self.bare.numbers((value,))
        letter = self._letter(name)
        if abs(number) <= tolerances.COMPUTED * self.largest:
            return 0.0, f"{name} = 0", f"{letter} = {plain('0')}"
        if self.known:
            size, unit = self.scale.number(abs(number)), self.scale.unit(unit)
            return number, f"{name} = {size} {unit}", f"{letter} = {plain(f'{size} {unit}')}"
        text, written = to_text(value), self.written
        turned = text.startswith("-") and not any(sign in text[1:] for sign in (" + ", " - "))
        shown, sign = (-value, -1) if turned else (value, 1)
        if written is None or len(text) > LONGEST_LABEL:
            return abs(number), name, letter
        words, tex = f"{name} = {to_text(shown)}", f"{letter} = {plain_tex(written, shown)}"
        return math.copysign(number, sign), words, tex

    # -- members of trusses --------------------------------------------------------------------------------

    @property
    def members(self) -> list[tuple[str, tuple[str, str], Scalar]]:
        """(name, its nodes, its force) of the members of trusses whose forces are determinate."""
        found = []
        for truss, member, ends in self.statics.system.scope.model.truss_members:
            reaction = self.statics.by_name.get(f"tension({truss}, {member})")
            if reaction is not None and reaction.value is not None:
                found.append((f"{truss}.{member}", ends, reaction.value))
        return found

    def _colors(self) -> dict[str, str]:
        """Colours of the members of trusses: pulled, pushed, or neither."""
        return {name: self._color(value) for name, _, value in self.members}

    def _color(self, value: Scalar) -> str:
        (number,) = self.bare.numbers((value,))
        return NOTHING if abs(number) < tolerances.COMPUTED * self.largest else TENSION if number > 0 else COMPRESSION

    def label(self, value: Scalar) -> str:
        """A value: a number without its unit, or a short formula where parameters have no values."""
        (number,) = self.bare.numbers((value,))
        if abs(number) < tolerances.COMPUTED * self.largest:
            return "0"
        text = self.scale.number(number) if self.known else to_text(value)
        return text if len(text) <= LONGEST_LABEL else ""


def draw_structure(panel: Any, scene: StaticScene) -> None:
    """Bodies, supports, loads in red, reactions in green, member forces in blue (tension) and red (compression)."""
    sketch = scene.sketch
    draw_model(panel, sketch)
    for name, ends, value in scene.members:
        places = [sketch.position((node, Vector.ZERO)) for node in ends]
        name_along(panel, scene.label(value), places, sketch.colors[name])
    if scene.members:
        unit = f" [{scene.scale.unit('N')}]" if scene.known else ""
        panel.set_title(f"members{unit}: tension blue, compression red", fontsize=9, loc="right", color="#505050")


def label_of(written: Setter, x: Scalar) -> str:
    """A formula between dollars; "" of a long one."""
    long = text_size(x) > MOST * LONGEST_LABEL or len(to_text(x)) > LONGEST_LABEL
    return "" if long else f"${plain_tex(written, x)}$"


def plain_tex(written: Setter, x: Scalar) -> str:
    """A formula as matplotlib sets it, which knows one kind of fraction."""
    return re.sub(r"\\[td]frac", r"\\frac", written.set(x).tex)


def plain(words: str) -> str:
    """Words in a formula in the letters of all other texts, as matplotlib sets them."""
    return rf"\mathregular{{{words.replace(' ', chr(92) + ' ')}}}"


def _plainly(words: str, tex: str) -> Symbol:
    """A name whose upright words are in the letters of all other texts."""
    return Symbol(words, tex.replace(r"\mathrm{", r"\mathregular{"))
