"""Model -> System: motion, loads and ties of one model, over one graph."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from eomgen.mechanics.contacts import Modes
from eomgen.mechanics.elimination import Elimination, dependent_coordinates, elimination_of
from eomgen.mechanics.kinematics import Motion, motion_of
from eomgen.mechanics.loads import Loads, loads_of
from eomgen.mechanics.scope import Scope, scope_of
from eomgen.mechanics.ties import Ties, ties_of
from eomgen.model.parts import Model
from eomgen.symbolic.graph import Scalar
from eomgen.symbolic.symbols import Symbols


@dataclass(frozen=True)
class System:
    """What every formulation assembles from: the three suppliers, which do not see one another.

    Args:
        motion, loads, ties: over the independent speeds alone.
        modes: how the contacts are that can end, rub or stick, by tie.
        elimination: how the dependent coordinates follow; None where there are none.
        free: the same system before it, dependent coordinates free and all ties closing; None where there are none.
    """

    motion: Motion
    loads: Loads
    ties: Ties
    modes: Modes = field(default_factory=dict)
    elimination: Elimination | None = None
    free: System | None = None

    @property
    def scope(self) -> Scope:
        return self.motion.scope

    @property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input, in t and parameters."""
        return {name: self.scope.value(part.value) for name, part in self.scope.model.inputs.items()}

    @property
    def symbols(self) -> Symbols:
        """The symbols of the model, one multiplier for each closing row included."""
        symbols = self.scope.symbols
        lam = tuple(symbols.graph.symbol(row.label) for row in self.ties.closing)
        return replace(symbols, lam=lam)


def system_of(model: Model, modes: Modes | None = None) -> System:
    """Motion, loads and ties of a model, dependent coordinates eliminated.

    Args:
        modes: how contacts are that can end, rub or stick, by tie.
    Raises:
        NotYet: a kind of joint, force or constraint that this version does not derive.
        DerivationError: what the model says cannot be derived.
    """
    free = free_system_of(model, modes)
    return reduced(free) if dependent_coordinates(free.scope) else free


def free_system_of(model: Model, modes: Modes | None = None) -> System:
    """Motion, loads and ties of a model in which dependent coordinates are as free as others."""
    motion = motion_of(scope_of(model))
    return System(motion, loads_of(motion), ties_of(motion, modes=modes), modes or {})


def reduced(free: System) -> System:
    """The system over its independent speeds: q' = N u + nu with N = [1; A], nu = [0; b].

    Raises:
        DerivationError: a dependent coordinate that no tie determines.
    """
    elimination = elimination_of(free.ties)
    motion = motion_of(elimination.scope)
    ties = ties_of(motion, elimination.used, free.modes)
    return System(motion, loads_of(motion), ties, free.modes, elimination, free)
