"""Model -> System: motion, loads and ties of one model, over one graph."""

from __future__ import annotations

from dataclasses import dataclass, replace

from eomgen.mechanics.kinematics import Motion, motion_of
from eomgen.mechanics.loads import Loads, loads_of
from eomgen.mechanics.scope import Scope, scope_of
from eomgen.mechanics.ties import Ties, ties_of
from eomgen.model.parts import Model
from eomgen.symbolic.graph import Scalar
from eomgen.symbolic.symbols import Symbols


@dataclass(frozen=True)
class System:
    """What every formulation assembles from: the three suppliers, which do not see one another."""

    motion: Motion
    loads: Loads
    ties: Ties

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


def system_of(model: Model) -> System:
    """Motion, loads and ties of a model.

    Raises:
        NotYet: a kind of joint, force or constraint that this version does not derive.
        DerivationError: what the model says cannot be derived.
    """
    motion = motion_of(scope_of(model))
    return System(motion, loads_of(motion), ties_of(motion))
