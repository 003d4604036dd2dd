"""System -> ActingForces: what acts on its bodies in the plane, each by its name: reactions, loads, inertia forces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from eomgen.mechanics.balance.balance import Balance, balance_of
from eomgen.mechanics.balance.components import Component
from eomgen.mechanics.balance.unit_wrenches import Axes, Effect, effects_of_load, efforts_of
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import Couple, PointForce, SpreadLoad, UniformField
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import readable
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import ZERO, Vector, cross, dot, plus, times, vector_of
from eomgen.symbolic.numeric.work import Work


@dataclass(frozen=True)
class PlacedPush:
    """Force and couple on one body, ground axes.

    Args:
        body: its index.
        place: where it acts; None of a couple of which nobody said it.
        unit: of a reaction, what one unit of it is.
        part: what is cut free with it: the body, or a part of it that has an index of its own.
    """

    body: int
    force: Vector
    couple: Scalar
    place: Vector | None
    unit: Vector | None
    part: int

    @property
    def is_couple(self) -> bool:
        return all(map(is_zero, self.force))

    @property
    def moment(self) -> Scalar:
        """About the ground's origin."""
        return self.couple if self.place is None else self.couple + cross(self.place, self.force)[2]


@dataclass(frozen=True)
class ActingForce:
    """One thing that acts.

    Args:
        name: in words.
        pushes: on each body; an inner force acts on two.
        force: the load or the tie that it is.
        symbol: of a component of a reaction.
        spread: of a line load where it is.
        kind: "reaction", "load" or "inertia".
        follows: it is friction by that component.
    """

    name: str
    pushes: tuple[PlacedPush, ...]
    force: str = ""
    symbol: Node | None = None
    spread: tuple[SpreadLoad, ...] = ()
    kind: str = "load"
    follows: bool = False

    def on(self, parts: frozenset[int]) -> tuple[PlacedPush, ...]:
        """What it does to them together; () of an inner force."""
        mine = tuple(push for push in self.pushes if push.part in parts)
        return () if self.kind == "reaction" and len({push.part for push in mine}) > 1 else mine


def symbols_of_reactions(balance: Balance) -> tuple[Node, ...]:
    """A symbol for each component, by its name."""
    return tuple(balance.system.scope.graph.symbol(c.name) for c in balance.components)


def what_acts(system: System) -> tuple[ActingForce, ...]:
    """All of it."""
    return (*_reactions(system), *_loads(system), *_inertia(system))


def _reactions(system: System) -> Iterator[ActingForce]:
    balance = balance_of(system)
    for symbol, c in zip(symbols_of_reactions(balance), balance.components, strict=True):
        yield ActingForce(_in_words(c), _pushes(system, c.effects, symbol), c.owner, symbol, kind="reaction")
        if c.friction_effects:
            pushes = _pushes(system, c.friction_effects, symbol)
            yield ActingForce(f"the friction of {c.owner}", pushes, c.owner, symbol, (), "reaction", follows=True)


def _in_words(c: Component) -> str:
    if c.label == "tension":
        return f"the {'member force' if c.side else 'tension'} {c.name}"
    what = {"drive": "drive", "t": "friction"}.get(c.label, "couple" if c.label.startswith("couple") else "reaction")
    return f"the {what} {c.name}"


def _loads(system: System) -> Iterator[ActingForce]:
    axes = Axes(system.motion)
    for force in system.loads.applied:
        for load in (load for load in force.loads if isinstance(load, UniformField)):
            for link, mass in zip(system.motion.links, axes.masses, strict=True):
                weight = PointForce((link.name, mass.com), times(mass.m, load.acceleration))
                if not is_zero(mass.m):
                    pushes = _pushes(system, effects_of_load(axes, weight))
                    yield ActingForce(f"the weight of {link.name}", pushes, force.name)
        acts = [load for load in force.loads if isinstance(load, (PointForce, Couple))]
        pushes = tuple(push for load in acts for push in _pushes(system, effects_of_load(axes, load)))
        if pushes:
            pushes = resultant(pushes) if force.spread else pushes
            held = {*symbols_of([x for push in pushes for x in (*push.force, push.couple)])}
            symbol = next((x for x in system.symbols.unknowns.values() if x in held), None)
            yield ActingForce(f"the force {force.name}", pushes, force.name, symbol, force.spread)
    for link in system.motion.links:
        if efforts := efforts_of(system, link.name):
            yield ActingForce(f"what acts in the joint of {link.name}", _pushes(system, efforts), link.name)


def _inertia(system: System) -> Iterator[ActingForce]:
    rows: dict[str, dict[int, Scalar]] = {}
    for equation in balance_of(system).equations:
        rows.setdefault(equation.body, {})[equation.direction] = -equation.inertia
    for i, (link, mass) in enumerate(zip(system.motion.links, Axes(system.motion).masses, strict=True)):
        own, center = rows.get(link.name, {}), link.pose.point(mass.com)
        force: Vector = (own.get(0, 0), own.get(1, 0), 0)
        for what, F, n in (("force", force, 0), ("couple", ZERO, own.get(5, 0))):
            push = PlacedPush(i, F, n, center, None, i)
            if not (push.is_couple and is_zero(n)):
                yield ActingForce(f"the inertia {what} of {link.name}", (push,), kind="inertia")


def _pushes(system: System, effects: Sequence[Effect], k: Scalar | None = None) -> tuple[PlacedPush, ...]:
    """The effects, of a reaction k times."""
    links, found = system.motion.links, []
    for e in effects:
        F, n = (e.force, e.couple[2]) if k is None else (times(k, e.force), k * e.couple[2])
        place = None if e.place is None else links[e.link].pose.point(e.place)
        found.append(PlacedPush(e.link, F, n, place, None if k is None else e.force, e.link))
    return tuple(found)


def resultant(pushes: tuple[PlacedPush, ...]) -> tuple[PlacedPush, ...]:
    """Parallel forces on one body as one, at p = sum p_k (F_k . F)/(F . F); as they are where that is none."""
    total = vector_of(map(sum, zip(*(push.force for push in pushes), strict=True)))
    square, places = dot(total, total), [push.place for push in pushes if push.place is not None]
    if is_zero(square) or len({push.part for push in pushes}) > 1 or len(places) < len(pushes):
        return pushes
    shares = [times(over(dot(push.force, total), square), p) for push, p in zip(pushes, places, strict=True)]
    place = ZERO
    for share in shares:
        place = plus(place, share)
    total, place = (vector_of(readable(x, Work.FORMULA) for x in v) for v in (total, place))
    return (PlacedPush(pushes[0].body, total, 0, place, None, pushes[0].part),)
