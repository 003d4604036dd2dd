"""PhaseModel, formulas -> their values along a phase: all of them by one program, at all states at once.

    y = f(q, u, a, lam, rho, t, p),   a and lam of the equations of motion,   rho of the balance, solved by rank

A function of the balance is linear in the components of the reactions, and these are found at every state as the
columns of reactions are: where one has no single value its column is nan there, and all others stay.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import field, replace
from functools import cached_property

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, ExpressionError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Indeterminate, NamedReaction, Reactions
from eomgen.mechanics.instant import Quantities
from eomgen.model import FUNCTIONS, Model, OutputSource
from eomgen.simulation.contacts import PhaseFunctions
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.reaction_columns import ReactionColumns, begun
from eomgen.symbolic.expression import Call, Expression, Node, Scalar, depends_on, derivative, substituted


@dataclass(frozen=True)
class OutputColumns:
    """Formulas of a model along one phase of its motion.

    Args:
        formulas: by name, over coordinates, rates, accelerations and functions of the motion.
    """

    phase: PhaseModel
    formulas: Mapping[str, Expression]

    def along(self, t: np.ndarray, x: np.ndarray) -> dict[str, np.ndarray]:
        """Each formula at n states of the phase, n x states; nan where one has no value; `refused` ones are left out.

        Args:
            t: their instants, n.
        """
        model = self.phase
        inner = model.functions.inner(x)
        moving = begun(t, inner, model.functions.rhs.at(model.p), model.slowest)
        names, p = model.moving, model.parameters_along(t, x)
        found: dict[str, np.ndarray] = {}
        for part in self._parts:
            kept = [names.index(node.name) for node in part.states]
            whole = len(kept) == len(names)
            found |= part.along(t, inner if whole else inner[:, kept], moving if whole else moving[:, kept], p)
        return {name: found[name] for name in self.formulas if name in found}

    @property
    def refused(self) -> dict[str, str]:
        """The formulas that have no meaning in the phase, and why."""
        return {name: why for part in self._parts for name, why in part.refused.items()}

    @property
    def _parts(self) -> tuple[_Columns, ...]:
        """Over the speeds that are integrated, and over those that the model declares; made once for all parameters."""
        key = ("columns", tuple(self.formulas.items()))
        if key not in self.phase.known:
            self.phase.known[key] = tuple(self._made())
        found: tuple[_Columns, ...] = self.phase.known[key]
        return found

    def _made(self) -> Iterator[_Columns]:
        phase, apart = self.phase, self._along_degrees_of_freedom
        own = {name: x for name, x in self.formulas.items() if name not in apart}
        if own:
            yield _Columns(phase.system, phase.functions, own, lambda: phase.reactions)
        if apart:
            functions = PhaseFunctions(phase.declared_equations, phase.p, phase.target)
            formulas = {name: self.formulas[name] for name in apart}
            yield _Columns(phase.declared, functions, formulas, lambda: Reactions.of(phase.declared))

    @property
    def _along_degrees_of_freedom(self) -> tuple[str, ...]:
        """The formulas that depend on which coordinates are free, where these are not those of the integration."""
        if self.phase.declared is self.phase.system:
            return ()
        requested = ((name, call) for name, formula in self.formulas.items() for call in formula.calls)
        return tuple(
            dict.fromkeys(name for name, call in requested if FUNCTIONS[call.name].is_along_degrees_of_freedom)
        )


@dataclass
class _Formulas:
    """Scalars of formulas, and the reactions that stand in them as symbols."""

    scalars: dict[str, Scalar] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    reactions: dict[Node, NamedReaction] = field(default_factory=dict)


@dataclass(frozen=True)
class _Columns:
    """Formulas over the states of one system.

    Args:
        balance: () -> the reactions of the system.
    """

    system: System
    functions: PhaseFunctions
    formulas: Mapping[str, Expression]
    balance: Callable[[], Reactions]

    @property
    def states(self) -> tuple[Node, ...]:
        symbols = self.system.symbols
        return symbols.x

    @property
    def refused(self) -> dict[str, str]:
        return self._made.refused

    def along(self, t: np.ndarray, x: np.ndarray, moving: np.ndarray, p: np.ndarray) -> dict[str, np.ndarray]:
        """Each formula at n states.

        Args:
            moving: the same states, those at which sliding begins a little later: for accelerations and reactions.
            p: the parameters' values.
        """
        made, symbols = self._made, self.system.symbols
        if not made.scalars:
            return {}
        columns = [x]
        with np.errstate(all="ignore"):
            if symbols.u:
                rates = self.functions.rhs.many(t, moving, p)
                columns.append(rates[:, len(symbols.q) : len(symbols.q) + len(symbols.u)])
            if self._multipliers:
                columns.append(self.functions.function(self._multipliers).many(t, moving, p))
            if made.reactions:
                columns.append(self._reactions.along(t, moving, p))
            found = self._program.many(t, np.hstack(columns), p) + 0.0  # -0 is 0
        return dict(zip(made.scalars, found.T, strict=True))

    @cached_property
    def _made(self) -> _Formulas:
        made = _Formulas()
        for name, formula in self.formulas.items():
            try:
                scalar = self._scalar(formula, made)
                open_ = [x.name for x in self.system.symbols.unknowns.values() if depends_on(scalar, (x,))]
                if open_:
                    made.refused[name] = f"'{open_[0]}' is known at rest alone"
                else:
                    made.scalars[name] = scalar
            except (DerivationError, ExpressionError, MissingValues) as error:
                made.refused[name] = error.what
        return made

    def _scalar(self, formula: Expression, made: _Formulas) -> Scalar:
        """A formula, its reactions as symbols; those that have a single value only together, as one.

        Raises:
            DerivationError: it has no meaning, or no single value at any state.
        """
        try:
            return formula.evaluate(self.system.scope.names, lambda call: self._value(call, made))
        except Indeterminate:
            found = self._balance.together(Quantities(self.system, balance=self._balance).over_components(formula))
            if found is None:
                raise
            return self._requested(found[0], 0, formula.text, made) + found[1]

    def _value(self, call: Call, made: _Formulas) -> Scalar:
        """One function; a reaction as a symbol, or as a function of its components where it is not linear in these.

        Raises:
            DerivationError: it has no meaning, or no single value at any state.
        """
        if FUNCTIONS[call.name].source != OutputSource.BALANCE:
            return self._quantities.value(call)
        components = self._balance.by_components[1]
        scalar = self._over_components.value(call)
        standing = [j for j, x in enumerate(components) if depends_on(scalar, (x,))]
        factors = {j: derivative(scalar, components[j]) for j in standing}
        if not standing:
            return scalar
        if any(depends_on(k, components) for k in factors.values()):
            parts = {components[j]: self._requested({j: 1}, 0, f"{call}, component {j}", made) for j in standing}
            return substituted((scalar,), parts)[0]
        (given,) = substituted((scalar,), {components[j]: 0 for j in standing})
        return self._requested(factors, given, str(call), made)

    def _requested(self, combination: dict[int, Scalar], given: Scalar, name: str, made: _Formulas) -> Node:
        """The symbol of a reaction, which stands for one more column of the balance."""
        self._balance.combined(combination, name)
        symbol = self.system.scope.graph.symbol(name)
        made.reactions[symbol] = NamedReaction(name, "", "", combination, given)
        return symbol

    @cached_property
    def _balance(self) -> Reactions:
        return self.balance()

    @cached_property
    def _quantities(self) -> Quantities:
        return Quantities(self.system)

    @cached_property
    def _over_components(self) -> Quantities:
        return Quantities(self.system, balance=self._balance.by_components[0])

    @cached_property
    def _multipliers(self) -> tuple[Node, ...]:
        """The multipliers that stand in a formula."""
        scalars = self._made.scalars.values()
        return tuple(lam for lam in self.system.symbols.lam if any(depends_on(x, (lam,)) for x in scalars))

    @cached_property
    def _reactions(self) -> ReactionColumns:
        return ReactionColumns(self._balance, self.functions.rhs, tuple(self._made.reactions.values()))

    @cached_property
    def _program(self) -> RightHandSide:
        """Every formula as a function of t, (q, u, z, a, lam, rho) and p."""
        symbols = self.system.symbols
        beside = (*symbols.a, *self._multipliers, *self._made.reactions)
        symbols = replace(symbols, z=symbols.z + beside)
        return RightHandSide.of(
            Program.of(tuple(self._made.scalars.values()), symbols, inputs=self.system.inputs), "numpy"
        )


def formulas_of(model: Model) -> dict[str, Expression]:
    """The outputs that are functions of the state: at no given instant, and of no linearized system."""
    requested = ((name, part) for name, part in model.outputs.items() if part.at is None and part.from_ is None)
    others = (OutputSource.SMALL_MOTIONS, OutputSource.OF_A_RUN)
    return {
        name: part.value
        for name, part in requested
        if not any(Quantities.requested_by(part.value, other) for other in others)
    }
