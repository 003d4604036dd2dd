"""Model -> System: motion, loads and constraints of one model; its generalized forces and equations of motion."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import (
    Assembly,
    Closure,
    Constraints,
    DependentBlock,
    Elimination,
    Rank,
    holds_identically,
)
from eomgen.mechanics.kinematics import (
    ContactModes,
    Loads,
    Motion,
    Scope,
    SystemScene,
    shorter,
)
from eomgen.model import Contact, Model, Table, UnitQuaternion
from eomgen.symbolic.exact import cramer, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    Symbols,
    as_expression,
    depends_on,
    fraction_of,
    inner,
    is_zero,
    jacobian,
    order,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances, transplanted
from eomgen.symbolic.print import to_text

# -------- system ----------------------------------------------------------------------------------------------
# Model -> System: motion, loads and constraints of one model, over one graph.


@dataclass(frozen=True)
class System:
    """Motion, loads and constraints from which every formulation assembles the equations; none of them uses another.

    Args:
        motion, loads, constraints: over the independent speeds alone.
        modes: states of the contacts that can end, slide or stick, by constraint.
        elimination: that of the dependent coordinates; None where there are none.
        free: the same system with every rate a speed, dependent coordinates free and all constraints closing; None
            where it is the same.
        declared: the rates that follow from declared speeds, with the places where these do not determine them.
    """

    motion: Motion
    loads: Loads
    constraints: Constraints
    modes: ContactModes = field(default_factory=dict)
    elimination: Elimination | None = None
    free: System | None = None
    declared: tuple[Solved, ...] = ()

    def __repr__(self) -> str:
        return f"<system of {self.scope.model.name!r}>"

    @property
    def scope(self) -> Scope:
        return self.motion.scope

    def sliding_velocity(self, contact: Contact) -> Scalar:
        """Sliding velocity of a closed contact with friction, along its tangent; of a joint or force its slip [m/s]."""
        if contact.of_joint or contact.of_force:
            return SystemScene(self.motion).slip(contact)
        return next(r.sliding for r in self.constraints.rows if r.constraint == contact.name and r.tangent)

    def held_by_others(self) -> System:
        """The system in which everything sticks that others hold at rest, over the same symbols; itself without such.

        What is taken to slip in a sense has no velocity in any motion that the rows allow, J u + sigma = 0, where what
        sticks beside it, or a drive, holds it: its direction depends on theirs, so that they share what holds in any
        way, and none of them has one value.
        """
        if System.held_by_others not in self.found:
            self.found[System.held_by_others] = self._with_held(self._at_rest_among_others)
        found: System = self.found[System.held_by_others]
        return found

    @property
    def _at_rest_among_others(self) -> list[str]:
        rough = (c for c in self.scope.model.rough_contacts if not c.surface and c.name in self.modes)
        slipping = [c for c in rough if self.modes[c.name].closed and self.modes[c.name].sense]
        if not slipping:
            return []
        try:
            state = Closure(self.constraints).generic()
            rates = evaluate([self.sliding_velocity(c) for c in slipping], state, fifty_digits())
        except (DerivationError, MissingValues, NoValue):  # then it is taken as it is
            return []
        return [c.name for c, v in zip(slipping, rates, strict=True) if abs(v) < tolerances.COMPUTED]

    def _with_held(self, names: Sequence[str]) -> System:
        if not names:
            return self
        modes = {**self.modes, **{name: replace(self.modes[name], sense=0) for name in names}}
        used = {} if self.elimination is None else self.elimination.used
        rows = Constraints.of(self.motion, used, modes)
        free = None if self.free is None else self.free._with_held(names)
        loads = Loads.of(self.motion, self.loads.begun, modes)
        return replace(self, loads=loads, constraints=rows, modes=modes, free=free)

    def let_go(self, coordinate: str) -> System:
        """The system with a driven coordinate free, which starts where it is driven from; found once.

        A system over all rates stays one: rates that its constraints would give need not be those of a state.
        """
        key = ("let go", coordinate)
        if key not in self.found:
            coordinates = self.scope.model.coordinates
            model = self.scope.model.altered(
                coordinates=Table({**coordinates, coordinate: self.scope.let_go(coordinate)})
            )
            over_all = self.free is None and self.scope.dependent
            self.found[key] = (System.free_of if over_all else System.of)(model, self.modes, begun_as=self)
        free: System = self.found[key]
        return free

    @cached_property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input, in t and parameters."""
        return {name: self.scope.value(part.value.named(name)) for name, part in self.scope.model.inputs.items()}

    @cached_property
    def found(self) -> dict[Any, Any]:
        """Cache of results that several stages use, as its reactions."""
        return {}

    def standing(self, places: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """State at t = 0 with all speeds and accelerations 0: the given coordinates, and the inputs there."""
        symbols = self.symbols
        still = {symbols.t: 0, **dict.fromkeys((*symbols.u, *symbols.a), 0), **places}
        own = substituted(tuple(self.inputs[name] for name in symbols.inputs), still)
        return still | dict(zip(symbols.inputs.values(), own, strict=True))

    @cached_property
    def symbols(self) -> Symbols:
        """The symbols of the model, one multiplier for each constraint row included."""
        symbols = self.scope.symbols
        lam = tuple(symbols.graph.symbol(row.label) for row in self.constraints.closing)
        return replace(symbols, lam=lam)

    def free_rates(self, free: System) -> ScalarRow:
        """The speeds of the free system by those that are left: N u + nu without the driven coordinates."""
        rates = {q.name: rate for q, rate in zip(self.scope.symbols.q, self.scope.rates, strict=True)}
        return tuple(rates[u.name[:-1]] for u in free.scope.symbols.u)

    @property
    def still(self) -> dict[Node, Scalar]:
        """Rates and accelerations at rest."""
        return dict.fromkeys((*self.symbols.u, *self.symbols.a), 0)

    def reduced(self) -> System:
        """The system over its independent speeds: N = [1; A], nu = [0; b] of dependent coordinates, then as declared.

        Raises:
            DerivationError: a dependent coordinate that no constraint determines.
            ModelError: declared speeds that do not determine the rates.
        """
        elimination = Elimination.of(self.constraints) if self.scope.dependent else None
        scope = self.scope if elimination is None else elimination.scope
        solved: tuple[Solved, ...] = ()
        if scope.model.speeds:
            scope, solved = with_declared_speeds(scope, vanishes=holds_identically, shorter=shorter)
        motion = SystemScene.motion_of(scope)
        constraints = Constraints.of(motion, {} if elimination is None else elimination.used, self.modes)
        return System(
            motion, Loads.of(motion, self.loads.begun, self.modes), constraints, self.modes, elimination, self, solved
        )

    @property
    def singular_blocks(self) -> tuple[DependentBlock, ...]:
        """The blocks by whose determinant rates are still divided; of the others it has cancelled for good."""
        scope = self.scope
        moving = (*scope.symbols.q, scope.symbols.t)
        rates = {q.name: rate for q, rate in zip(scope.symbols.q, scope.rates, strict=True)}

        def divided(block: DependentBlock) -> bool:
            nodes = order([rates[name] for name in block.coordinates])
            return any(node.op == "div" and depends_on(node.args[1], moving) for node in nodes)

        return () if self.elimination is None else tuple(filter(divided, self.elimination.blocks))

    def refuse_undetermined(self, place: Mapping[Node, Scalar], when: str) -> None:
        """Refuse a place at which rates of dependent coordinates are divided by zero.

        Args:
            place: values of coordinates and t, exact.
            when: the place, in words.
        Raises:
            DerivationError: the constraints and coordinates are named.
        """
        for block in self.singular_blocks:
            if is_zero(substituted((block.determinant,), place)[0]):
                fix = "start near it, or leave out `dependent`: then their rates belong to the state"
                raise DerivationError(f"{block} {when} ({DependentBlock.PLACE})", fix=fix)

    def refuse_states(self, what: str, fix: str) -> None:
        """Refuse what is not made where states of first order move too.

        Args:
            what: the refused thing, a plural: "steady motions are not sought".
        Raises:
            DerivationError: the model has such states: the first is named.
        """
        states = self.symbols.z
        if states:
            raise DerivationError(f"{what} where states of first order move", f"states.{states[0].name}", fix)

    @property
    def has_degrees_of_freedom(self) -> bool:
        """True if the constraints and drives leave degrees of freedom, and no unknown load acts along them."""
        unknowns = self.symbols.unknowns.values()
        forces = self.loads.generalized_forces
        return Rank(self.constraints).degrees_of_freedom() > 0 and not depends_on(forces, unknowns)

    def with_drives_held(self) -> tuple[System, tuple[str, ...]]:
        """(the system with driven coordinates at rest where they start, the names of those that the model moves)."""
        scope = self.scope
        bias = dict(zip((q.name for q in scope.symbols.q), scope.nu, strict=True))
        starts = {q.name: x for q, x in scope.start_values().items()}
        table = dict(scope.model.coordinates)
        moved = [name for name, part in table.items() if part.driven and not vanishes(bias[name])]
        if not moved:
            return self, ()
        free = any(not part.driven for part in table.values())
        for name in moved:
            if free and not depends_on(bias[name], (scope.symbols.t,)):
                what = f"'{name}' moves at a constant rate: there is no equilibrium"
                raise DerivationError(what, f"coordinates.{name}", "hold it by a `motion` that does not change")
            place = as_expression(to_text(starts[name]))
            table[name] = table[name].altered(motion=place, rate=None, acceleration=None, start=None, speed=None)
        model = scope.model.altered(coordinates=Table(table))
        return System.of(model, self.modes), tuple(moved)

    @staticmethod
    def free_of(
        model: Model, modes: ContactModes | None = None, *, with_laws: bool = False, begun_as: System | None = None
    ) -> System:
        """Motion, loads and constraints of a model in which dependent coordinates are as free as others."""
        motion = SystemScene.motion_of(Scope.of(model, with_laws=with_laws))
        _refuse_loops(motion.scope)
        constraints = Constraints.of(motion, modes=modes)
        begun: Mapping[Node, Scalar] = {}
        if begun_as is not None:
            begun = _carried_places(begun_as, motion.scope)
        elif any(force.of_the_start for force in model.forces.values()):
            begun = Assembly(constraints).begun_places()
        return System(motion, Loads.of(motion, begun, modes), constraints, modes or {})

    @classmethod
    def of(
        cls, model: Model, modes: ContactModes | None = None, *, with_laws: bool = False, begun_as: System | None = None
    ) -> System:
        """Motion, loads and constraints of a model, dependent coordinates eliminated.

        Args:
            modes: how contacts are that can end, slide or stick, by constraint.
            begun_as: the system of the same start whose model this one was, before something in it was let go: what
                stands as it did at the start stands as it does there.
            with_laws: for print: long rates and accelerations of driven coordinates are names (`Scope.laws`).
        Raises:
            NotYet: a kind of joint, force or constraint that this version does not derive.
            DerivationError: what the model says cannot be derived.
        """
        free = System.free_of(model, modes, with_laws=with_laws, begun_as=begun_as)
        return free.reduced() if free.scope.dependent or model.speeds else free


def _refuse_loops(scope: Scope) -> None:
    """Refuses what pushes by the rate of a state that follows from accelerations or reactions, and these from the push.

    Raises:
        DerivationError: the part that holds such a rate is named.
    """
    rates = {f"{z.name}'": rate for z, rate in zip(scope.symbols.z, scope.state_rates, strict=True)}
    forces = scope.reactions_in_rates
    looped = {name for name, rate in rates.items() if depends_on(rate, (*scope.symbols.a, *forces))}
    for leaf, expression in scope.model.expressions if looped else ():
        held = sorted(looped & expression.names)
        if held and leaf.path[0] not in ("states", "outputs", "given", "questions", "linearize"):
            of = "reactions" if depends_on(rates[held[0]], forces) else "accelerations"
            what = f"an algebraic loop: it pushes by {held[0]}, which follows from the {of}, and these from it"
            fix = f"let the rate of '{held[0][:-1]}' hold no {of[:-1]}, or let the push depend on the state itself"
            raise DerivationError(what, ".".join(map(str, leaf.path[:2])), fix)


def _carried_places(system: System, scope: Scope) -> dict[Node, Scalar]:
    """Start values, in another scope, of the coordinates of a system whose start is not the declared one."""
    places = system.loads.begun
    values = transplanted(tuple(places.values()), scope.graph, scope.names)
    own = {q.name: q for q in scope.symbols.q}
    return {own[q.name]: x for q, x in zip(places, values, strict=True) if q.name in own}


# -------- equations of motion ---------------------------------------------------------------------------------
# What every formulation gives: the equations of motion of a system, as graph scalars.


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion: q' = N u + nu,  M a + c = Q + J^T lam,  J a + gamma = 0.

    Args:
        system: whose motion, loads and constraints they are put together from.
        N, nu: kinematic matrix, nq rows of nu entries, and bias, nq.
        M: mass matrix, nu rows of nu entries.
        c: inertia terms left when a = 0, nu.
        Q: generalized forces of everything applied, nu.
        forcing: Q - c, nu (of its own: it can be cheaper than the difference).
        J, sigma, gamma: constraint rows, k rows of nu entries; velocity bias, k; acceleration bias, k.
        phi: gaps, k (None for a row that has none).
        T, V: kinetic and potential energy [J].
        accelerations: a as explicit expressions where the formulation gives them (articulated body), else None.
        friction: the part of Q that contacts with friction make, nu; () where there is no friction.
        alike: of each constraint row the number of its group of alike rows (`Rank.alike`); () of few.
    """

    system: System
    N: tuple[ScalarRow, ...]
    nu: ScalarRow
    M: tuple[ScalarRow, ...]
    c: ScalarRow
    Q: ScalarRow
    forcing: ScalarRow
    J: tuple[ScalarRow, ...]
    sigma: ScalarRow
    gamma: ScalarRow
    phi: tuple[Scalar | None, ...]
    T: Scalar
    V: Scalar
    accelerations: ScalarRow | None = None
    friction: ScalarRow = ()
    alike: tuple[int, ...] = ()

    def __repr__(self) -> str:
        name = self.system.scope.model.name
        return f"<equations of motion of {name!r}: {len(self.M)} speeds, {len(self.J)} constraint rows>"

    @property
    def symbols(self) -> Symbols:
        """The symbols in which everything is written."""
        return self.system.symbols

    @cached_property
    def residual(self) -> tuple[ScalarRow, ScalarRow]:
        """(M a - forcing - J^T lam, J a + gamma) with a and lam as symbols: zero in every motion."""
        a, lam = self.symbols.a, self.symbols.lam
        pushes = list(zip(*self.J, strict=True)) if self.J else [()] * len(self.M)
        balance = tuple(
            inner(row, a) - force - inner(push, lam)
            for row, force, push in zip(self.M, self.forcing, pushes, strict=True)
        )
        return balance, tuple(inner(row, a) + bias for row, bias in zip(self.J, self.gamma, strict=True))

    @property
    def kinematic_rates(self) -> ScalarRow:
        """q' = N u + nu"""
        rates = []
        for row, value in zip(self.N, self.nu, strict=True):
            for entry, speed in zip(row, self.symbols.u, strict=True):
                if not is_zero(entry):
                    value = value + entry * speed
            rates.append(value)
        return tuple(rates)

    @property
    def state_rates(self) -> ScalarRow:
        """z' of the states of first order, nz, in q, u, a, z, inputs and t."""
        return self.system.scope.state_rates if self.symbols.z else ()

    @property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input."""
        return self.system.inputs

    def stabilized(self, rates: tuple[float, float]) -> EquationsOfMotion:
        """The equations of motion with rows that pull.

        Args:
            rates: alpha, beta [1/s].
        Raises:
            UsageError: a rate that is no positive number; a constraint that has no multiplier to pull by.
        """
        alpha, beta = (_exact(rate) for rate in rates)
        taken = dict.fromkeys(row.constraint for row in self.system.constraints.rows if row.status == "eliminated")
        if taken:
            names = ", ".join(f"'{name}'" for name in taken)
            raise UsageError(
                f"Baumgarte's rows pull by multipliers, and {names} has none: it gives dependent coordinates",
                fix="take the projection, or declare no coordinate dependent",
            )
        rows = zip(self.gamma, self.system.constraints.closing, self.phi, strict=True)
        pulling = (g + 2 * alpha * row.velocity + (0 if phi is None else beta * beta * phi) for g, row, phi in rows)
        return replace(self, gamma=tuple(pulling))


def assembled(
    system: System, *, M: tuple[ScalarRow, ...], c: ScalarRow, Q: ScalarRow, T: Scalar, forcing: ScalarRow | None = None
) -> EquationsOfMotion:
    """The formulation's M, c, Q and T with what all formulations share: kinematics, constraint rows, V."""
    scope, constraints = system.scope, system.constraints
    if forcing is None:
        forcing = tuple(force - inertia for force, inertia in zip(Q, c, strict=True))
    return EquationsOfMotion(
        system,
        scope.N,
        scope.nu,
        M,
        c,
        Q,
        forcing,
        constraints.J,
        constraints.sigma,
        constraints.gamma,
        constraints.phi,
        T,
        system.loads.potential_energy,
        alike=_alike(system),
    )


def _alike(system: System) -> tuple[int, ...]:
    if len(system.constraints.closing) < 2:
        return ()
    if Rank not in system.found:
        system.found[Rank] = Rank(system.constraints).alike
    found: tuple[int, ...] = system.found[Rank]
    return found


# -------- declared speeds -------------------------------------------------------------------------------------
# Scope -> Scope: generalized speeds that are not rates, w = Y(q, t) q' + y, in the place of the rates.
#
#     q' = N u + nu of the rates that are left,  w = Y u + y   ->   u = Y^-1 (w - y),   q' = (N Y^-1) w + (nu - N Y^-1
#         y)
#
# A coordinate whose rate occurs in no declared speed has this rate as a speed. The four rates of a quaternion follow
# from the angular velocity, e' = 1/2 e o (0, w), without any inverse. The speeds are the remaining rates, in the order
# of the coordinates, then the declared ones in the order of the model.


SpeedRows = dict[Node, tuple[tuple[Scalar, ...], Scalar]]  # u = row . w + bias, of each rate u


@dataclass(frozen=True)
class Solved:
    """Rates that declared speeds determine together; where the determinant vanishes they are not determined."""

    rates: tuple[str, ...]
    determinant: Scalar

    def __str__(self) -> str:
        return f"the declared speeds do not determine {', '.join(self.rates)}"


def with_declared_speeds(
    scope: Scope, *, vanishes: Callable[[Scalar], bool], shorter: Callable[[Scalar], Scalar]
) -> tuple[Scope, tuple[Solved, ...]]:
    """The scope over the declared speeds, and what must stay regular.

    Args:
        scope: over the rates, dependent coordinates eliminated.
        vanishes: whether a scalar is zero at all states.
        shorter: puts a coefficient of N into a shorter form.
    Raises:
        ModelError: not one speed for each degree of freedom; a speed that is not linear in the rates; speeds that
            depend on one another.
    """
    u, graph = scope.symbols.u, scope.graph
    declared = tuple(name for name, part in scope.model.speeds.items() if part.rate is not None)
    turning = {node.name + "'" for four in scope.quaternions for node in four}
    formulas = tuple(scope.names[name] for name in declared)
    _refuse_turning(declared, formulas, [x for x in u if x.name in turning])
    standing = set(symbols_of(formulas))
    replaced = [x for x in u if x.name not in turning and x in standing]
    _refuse_count(scope, declared, replaced)
    kept = tuple(x for x in u if x.name not in turning and x not in replaced)
    speeds = (*kept, *map(graph.symbol, scope.model.speeds))
    rates = (*(graph.symbol(f"{x.name}'") for x in kept), *(graph.symbol(f"{name}'") for name in scope.model.speeds))
    place = {x.name: k for k, x in enumerate(speeds)}
    rows: SpeedRows = {x: (_unit(place[x.name], len(speeds)), 0) for x in kept}
    solved, blocks = _rates_solved(scope, declared, replaced, place, vanishes, shorter)
    rows |= solved
    rows |= _quaternion_rates(scope, place)
    symbols = replace(scope.symbols, u=speeds, a=rates)
    return _over(scope, replace(scope, symbols=symbols), u, rows), blocks


def _unit(k: int, size: int) -> tuple[int, ...]:
    return tuple(int(j == k) for j in range(size))


# -- the rates ---------------------------------------------------------------------------------------


def _rates_solved(
    scope: Scope,
    declared: Sequence[str],
    replaced: Sequence[Node],
    place: dict[str, int],
    vanishes: Callable[[Scalar], bool],
    shorter: Callable[[Scalar], Scalar],
) -> tuple[SpeedRows, tuple[Solved, ...]]:
    """u = Y^-1 (w - y) of the rates that stand in declared speeds, by determinants."""
    formulas = tuple(scope.names[name] for name in declared)
    Y = jacobian(formulas, replaced)
    y = substituted(formulas, dict.fromkeys(replaced, 0))
    for name, row in zip(declared, Y, strict=True):
        if any(depends_on(x, replaced) for x in row):
            what = f"speed '{name}' is not linear in the rates"
            raise ModelError(what, f"speeds.{name}.rate", "give a combination of rates")
    system = [{j: x for j, x in enumerate(row) if not is_zero(x)} for row in Y]
    right = [[*_unit(place[name], len(place)), -bias] for name, bias in zip(declared, y, strict=True)]
    try:
        X, blocks = cramer.solution_by_minors(system, right, vanishes=vanishes, shorter=shorter)
        singular = any(vanishes(cramer.determinant(block.matrix)) for block in blocks)
    except (DerivationError, ZeroDivisionError, StopIteration):
        singular = True
    if singular:
        names = ", ".join(x.name for x in replaced)
        what = f"the declared speeds do not determine the rates {names}: they depend on one another"
        raise ModelError(what, "speeds", "declare independent combinations of the rates")
    found = tuple(
        Solved(tuple(replaced[j].name for j in block.unknowns), cramer.determinant(block.matrix)) for block in blocks
    )
    return {x: (tuple(row[:-1]), row[-1]) for x, row in zip(replaced, X, strict=True)}, found


def _quaternion_rates(scope: Scope, place: dict[str, int]) -> SpeedRows:
    """e' = 1/2 e o (0, w), one row for each of its rates."""
    rows: SpeedRows = {}
    for four, each in zip(scope.quaternions, scope.model.quaternions, strict=True):
        for e, factors in zip(four, UnitQuaternion(*four).rates_by_spin, strict=True):
            row: list[Scalar] = [0] * len(place)
            for name, factor in zip(each.speeds, factors, strict=True):
                row[place[name]] = factor
            rows[scope.graph.symbol(f"{e.name}'")] = (tuple(row), 0)
    return rows


def _over(old: Scope, new: Scope, u: Sequence[Node], rows: SpeedRows) -> Scope:
    """q' = N u + nu with u = rows . w + bias put in, and the meaning of every name."""
    N = tuple(_combined(row, [rows[x][0] for x in u]) for row in old.N)
    nu = tuple(bias + inner(row, [rows[x][1] for x in u]) for row, bias in zip(old.N, old.nu, strict=True))
    new = replace(new, N=N, nu=nu)
    rates = {f"{q.name}'": rate for q, rate in zip(new.symbols.q, new.rates, strict=True)}
    second = new.with_accelerations(tuple(rates.values()))
    names = {**old.names, **rates, **{f"{name}'": x for name, x in zip(rates, second, strict=True)}}
    return replace(new, names=names | {x.name: x for x in (*new.symbols.u, *new.symbols.a)}).with_states_named()


# -- what cannot be ----------------------------------------------------------------------------------


def _refuse_turning(declared: Sequence[str], formulas: Sequence[Scalar], turning: Sequence[Node]) -> None:
    for name, formula in zip(declared, formulas, strict=True):
        if depends_on(formula, turning):
            what = f"the rate of a quaternion stands in the speed '{name}'"
            raise ModelError(what, f"speeds.{name}.rate", "the speeds of the joint's `omega` stand for these rates")


def _refuse_count(scope: Scope, declared: Sequence[str], replaced: Sequence[Node]) -> None:
    if len(declared) == len(replaced):
        return
    rates = f"{len(replaced)} rate{'s' * (len(replaced) != 1)}"
    what = f"{len(declared)} speed{' is' if len(declared) == 1 else 's are'} declared for {rates}"
    named = ", ".join(x.name for x in replaced) or "none"
    if len(declared) < len(replaced):
        fix = (
            "declare one speed for each rate that stands in them, or leave out those that keep their rate; "
            "a coordinate that constraints determine may be `dependent`"
        )
    else:
        fix = "declare one for each degree of freedom: leave out those that follow from the others"
    raise ModelError(f"{what} ({named})", "speeds", fix)


def _combined(factors: Iterable[Any], rows: Iterable[Sequence[Any]]) -> tuple[Any, ...]:
    """The sum of f_k row_k; what is multiplied by 0 is not looked at. At least one row."""
    total: list[Any] = []
    for factor, row in zip(factors, rows, strict=True):
        total = total or [0] * len(row)
        if not is_zero(factor):
            for i, x in enumerate(row):
                if not is_zero(x):
                    total[i] = total[i] + factor * x
    return tuple(total)


def _exact(rate: float) -> Fraction:
    """A decimal as it was written."""
    if not 0 < rate < float("inf"):
        raise UsageError(f"Baumgarte's rates must be positive, not {rate:g}", fix="give alpha and beta in 1/s")
    return fraction_of(repr(float(rate)))
