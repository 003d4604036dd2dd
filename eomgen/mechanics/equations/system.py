"""Model -> System: motion, loads and ties of one model, over one graph."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import Any

from eomgen.mechanics.bodies.contact_modes import ContactModes
from eomgen.mechanics.bodies.declared_speeds import Solved, with_declared_speeds
from eomgen.mechanics.bodies.kinematics import Motion, motion_of
from eomgen.mechanics.bodies.loads import Loads, loads_of
from eomgen.mechanics.bodies.scope import Scope, scope_of
from eomgen.mechanics.bodies.simplify import shorter
from eomgen.mechanics.constraints.assembly import begun_places
from eomgen.mechanics.constraints.elimination import Elimination, dependent_coordinates, elimination_of
from eomgen.mechanics.constraints.ties import Ties, holds_identically, ties_of
from eomgen.model.parts import Model
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.symbols import Symbols
from eomgen.symbolic.numeric.transplant import transplanted


@dataclass(frozen=True)
class System:
    """What every formulation assembles from: the three suppliers, which do not see one another.

    Args:
        motion, loads, ties: over the independent speeds alone.
        modes: how the contacts are that can end, slide or stick, by tie.
        elimination: how the dependent coordinates follow; None where there are none.
        free: the same system with every rate a speed, dependent coordinates free and all ties closing; None where it
            is the same.
        declared: the rates that follow from declared speeds, and where these do not determine them.
    """

    motion: Motion
    loads: Loads
    ties: Ties
    modes: ContactModes = field(default_factory=dict)
    elimination: Elimination | None = None
    free: System | None = None
    declared: tuple[Solved, ...] = ()

    def __repr__(self) -> str:
        return f"<system of {self.scope.model.name!r}>"

    @property
    def scope(self) -> Scope:
        return self.motion.scope

    @cached_property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input, in t and parameters."""
        return {name: self.scope.value(part.value.named(name)) for name, part in self.scope.model.inputs.items()}

    @cached_property
    def found(self) -> dict[Any, Any]:
        """What was found of it once, and is asked by many: its reactions."""
        return {}

    def standing(self, places: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """At t = 0, nothing moving: the coordinates where they are said to be, and the inputs there."""
        symbols = self.symbols
        still = {symbols.t: 0, **dict.fromkeys((*symbols.u, *symbols.a), 0), **places}
        own = substituted(tuple(self.inputs[name] for name in symbols.inputs), still)
        return still | dict(zip(symbols.inputs.values(), own, strict=True))

    @cached_property
    def symbols(self) -> Symbols:
        """The symbols of the model, one multiplier for each closing row included."""
        symbols = self.scope.symbols
        lam = tuple(symbols.graph.symbol(row.label) for row in self.ties.closing)
        return replace(symbols, lam=lam)


def system_of(
    model: Model, modes: ContactModes | None = None, *, with_laws: bool = False, begun_as: System | None = None
) -> System:
    """Motion, loads and ties of a model, dependent coordinates eliminated.

    Args:
        modes: how contacts are that can end, slide or stick, by tie.
        begun_as: the system of the same start whose model this one was, before something in it was let go: what stands
            as it did at the start stands as it does there.
        with_laws: for print: long rates and accelerations of driven coordinates are names (`Scope.laws`).
    Raises:
        NotYet: a kind of joint, force or constraint that this version does not derive.
        DerivationError: what the model says cannot be derived.
    """
    free = free_system_of(model, modes, with_laws=with_laws, begun_as=begun_as)
    return reduced_system(free) if dependent_coordinates(free.scope) or model.speeds else free


def free_system_of(
    model: Model, modes: ContactModes | None = None, *, with_laws: bool = False, begun_as: System | None = None
) -> System:
    """Motion, loads and ties of a model in which dependent coordinates are as free as others."""
    motion = motion_of(scope_of(model, with_laws=with_laws))
    ties = ties_of(motion, modes=modes)
    begun: Mapping[Node, Scalar] = {}
    if begun_as is not None:
        begun = _carried_places(begun_as, motion.scope)
    elif any(force.of_the_start for force in model.forces.values()):
        begun = begun_places(ties)
    return System(motion, loads_of(motion, begun), ties, modes or {})


def _carried_places(system: System, scope: Scope) -> dict[Node, Scalar]:
    """Where coordinates of a system start that do not start where they are declared to, in another scope."""
    places = system.loads.begun
    values = transplanted(tuple(places.values()), scope.graph, scope.names)
    own = {q.name: q for q in scope.symbols.q}
    return {own[q.name]: x for q, x in zip(places, values, strict=True) if q.name in own}


def reduced_system(free: System) -> System:
    """The system over its independent speeds: N = [1; A], nu = [0; b] of dependent coordinates, then as declared.

    Raises:
        DerivationError: a dependent coordinate that no tie determines.
        ModelError: declared speeds that do not determine the rates.
    """
    elimination = elimination_of(free.ties) if dependent_coordinates(free.scope) else None
    scope = free.scope if elimination is None else elimination.scope
    solved: tuple[Solved, ...] = ()
    if scope.model.speeds:
        scope, solved = with_declared_speeds(scope, vanishes=holds_identically, shorter=shorter)
    motion = motion_of(scope)
    ties = ties_of(motion, {} if elimination is None else elimination.used, free.modes)
    return System(motion, loads_of(motion, free.loads.begun), ties, free.modes, elimination, free, solved)
