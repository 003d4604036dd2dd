"""Model -> Scope: the symbols of one derivation, and the scalars for which the names of expressions stand."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property, partial
from math import isfinite
from random import Random
from typing import Any

from eomgen.errors import DerivationError, EomgenError, ExpressionError, ModelError
from eomgen.frozen import dataclass
from eomgen.model import Composite, Coordinate, MassProperties, Model, Unit, UnitQuaternion, in_order
from eomgen.symbolic.exact import cancelled, readable_all
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Fraction,
    Graph,
    Matrix,
    Node,
    Sampled,
    Scalar,
    ScalarRow,
    State,
    Symbols,
    Vector,
    as_expression,
    depends_on,
    gradient,
    holds_op,
    is_zero,
    operations,
    order,
    over,
    sqrt,
    substituted,
    symbols_of,
    tangent,
    through_samples,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate, fifty_digits, numbers_of
from eomgen.symbolic.print import length_of, text_size, to_text

# -------- scope -----------------------------------------------------------------------------------------------
# Model -> Scope: the symbols of one derivation, and the scalars for which the names of expressions stand.
#
# q' = N u + nu. A free coordinate has its rate for a speed (a unit row of N); a driven one is a zero row of N and its
# given rate in nu; a dependent one has the row that the constraints give, and is free until then. Declared speeds take
# the place of rates last of all (`begun_speeds`); until then their names mean what they are in the rates.


TRIES = 20  # of values at random of what has none
LONGEST_LAW = 3  # marks of a constant rate or acceleration that is put in where it stands: 2 n


_BY_UNIT = {Unit.parse(unit).dimension: place for place, unit in enumerate(("1", "kg", "m/s^2"))}
_LENGTH = Unit.parse("m").dimension
_BY_NAME = (re.compile(r"mu(_.*|\d*)"), re.compile(r"[mM](_.*|\d*)"), re.compile("g"))
OTHERS, LENGTHS = len(_BY_UNIT), len(_BY_UNIT) + 1


def _place(model: Model, name: str) -> int:
    """Place of a parameter in a product: coefficients, masses, the acceleration of gravity, others, lengths, angles:
    mu*m*g, k*l^2; by its unit, else by its name."""
    unit = model.parameters[name].unit
    if unit is not None and unit.angle and not unit.time:
        return LENGTHS + 1
    if unit is not None:
        return LENGTHS if unit.dimension == _LENGTH else _BY_UNIT.get(unit.dimension, OTHERS)
    return next((place for place, form in enumerate(_BY_NAME) if form.fullmatch(name)), OTHERS)


@dataclass(frozen=True)
class Scope:
    """The symbols of a model and its kinematic equations.

    Args:
        model: the model, its trusses taken apart.
        symbols: its symbols.
        N, nu: q' = N u + nu; N has nq rows of nu entries.
        names: what each name of an expression stands for: parameters, unknowns, q, u, `theta'`, `theta''`, inputs,
            states z and their rates `i'`, t, pi.
        quaternions: four coordinates each, whose squares add up to 1.
        laws: {psi': law, psi'': law} of driven coordinates whose rates and accelerations are names, for print.
    """

    model: Model
    symbols: Symbols
    N: tuple[tuple[Scalar, ...], ...]
    nu: tuple[Scalar, ...]
    names: dict[str, Scalar]
    quaternions: tuple[tuple[Node, ...], ...] = ()
    laws: Mapping[Node, Scalar] = field(default_factory=dict)

    @property
    def graph(self) -> Graph:
        return self.symbols.graph

    @cached_property
    def positive(self) -> frozenset[Node]:
        """The parameters whose value is positive, that the model calls `positive`, or that are a mass or a length.

        Roots may be taken of their squares.
        """
        values, sizes = self.model.exact_parameters(), _sizes(self.model)
        return frozenset(
            node
            for name, node in self.symbols.parameters.items()
            if self.model.parameters[name].positive or (values[name] > 0 if name in values else name in sizes)
        )

    @property
    def zero(self) -> frozenset[str]:
        """The parameters whose value is 0."""
        return parameters_of_zero(self.model)

    @property
    def combines(self) -> bool:
        """True if some of its speeds are combinations of rates."""
        return any(self.model.speeds[u.name].rate is not None for u in self.symbols.u if u.name in self.model.speeds)

    @property
    def rates(self) -> tuple[Scalar, ...]:
        """q' = N u + nu, nq."""
        return tuple(
            sum((n * u for n, u in zip(row, self.symbols.u, strict=True) if not _zero(n)), start=bias)
            for row, bias in zip(self.N, self.nu, strict=True)
        )

    @property
    def state_rates(self) -> ScalarRow:
        """z' of the states of first order, nz, in q, u, a, z, inputs and t."""
        return tuple(self.names[f"{z.name}'"] for z in self.symbols.z)

    @property
    def reactions_in_rates(self) -> dict[Node, Call]:
        """The reactions in the rates of states, by the symbols that stand for them until the bodies are cut free."""
        laws = (part.rate for part in self.model.states.values() if part.rate is not None)
        calls = (call for law in laws for call in law.all_calls if f"{call.name}(" not in self.names)
        return {self._symbol_of(call): call for call in calls}

    def _symbol_of(self, call: Call) -> Node:
        return self.graph.symbol(str(call))  # no name of a model has parentheses

    @property
    def flow(self) -> dict[Node, Scalar]:
        """The seeds of d/dt at a = 0: q -> q', z -> z', t -> 1, psi' -> psi'' of what has a law."""
        derivatives = {x: tangent((law,), {self.symbols.t: 1})[0] for x, law in self.laws.items()}
        derivatives = {x: self.names.get(f"{x.name}'", rate) for x, rate in derivatives.items()}
        further = {z: self.names[f"{z.name}'"] for z in self.symbols.z if f"{z.name}'" in self.names}
        return {self.symbols.t: 1, **dict(zip(self.symbols.q, self.rates, strict=True)), **further, **derivatives}

    @property
    def over_rates(self) -> Scope:
        """The scope whose speeds are names w of the rates of all coordinates, driven ones too."""
        w = tuple(self.graph.symbol(f"({q.name}')") for q in self.symbols.q)  # no name of a model has parentheses
        names = self.names | {f"{q.name}'": x for q, x in zip(self.symbols.q, w, strict=True)}
        N = tuple(tuple(int(i == k) for k in range(len(w))) for i in range(len(w)))
        names |= _speeds_by_rates(self.model, names)
        return replace(self, symbols=replace(self.symbols, u=w), N=N, nu=(0,) * len(w), names=names)

    @cached_property
    def composites(self) -> dict[str, Composite]:
        """Bodies made of parts that were put together already, by name (`Scope.made_of` fills it)."""
        return {}

    def value(self, expression: Expression | None) -> Scalar:
        """An expression of the model in the symbols (absent: 0)."""
        return 0 if expression is None else expression.evaluate(self.names)

    def vector(self, expressions: tuple[Expression, ...] | None) -> Vector:
        """A vector of the model, 3, with z = 0 in the plane (absent: 0)."""
        values = [self.value(e) for e in expressions or ()]
        return Vector(values + [0] * (3 - len(values)))

    def time_derivative(self, outputs: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
        """d/dt of functions of q, u and t where a = 0: the part that stays when nothing accelerates."""
        inputs = tuple(self.symbols.inputs.values())
        if inputs and any(depends_on(x, inputs) for x in outputs):
            raise DerivationError(
                "an input stands where a time derivative is needed, and a caller may replace it by anything",
                fix="let inputs act in forces and torques only; drive a coordinate by `motion`",
            )
        return tangent(outputs, self.flow)

    def rate_of(self, vector: Vector) -> Vector:
        """d/dt of a vector, 3, where a = 0."""
        return Vector(self.time_derivative(vector))

    def with_accelerations(self, outputs: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
        """d/dt of functions of q, u and t, the accelerations included: linear in a."""
        flow = {**self.flow, **dict(zip(self.symbols.u, self.symbols.a, strict=True))}
        return tangent(outputs, flow)

    # -- at the start ------------------------------------------------------------------------------

    def start_values(self, among: Iterable[Node] | None = None) -> dict[Node, Scalar]:
        """Start values of coordinates and states, as expressions of the parameters; of all coordinates for None."""
        return {q: self.start_value(q) for q in (self.symbols.q if among is None else among)}

    def start_value(self, q: Node) -> Scalar:
        """Start value of a coordinate or state, as an expression of the parameters."""
        if q.name in self.model.states:
            return self.value(self.model.states[q.name].start)
        coordinate = self.model.coordinates[q.name]
        if coordinate.motion is not None:
            return substituted((self.value(coordinate.motion),), {self.symbols.t: 0})[0]
        return self.value(coordinate.near if coordinate.start is None else coordinate.start)

    def with_unit_quaternions(self, start: dict[Node, Scalar]) -> dict[Node, Scalar]:
        """Start values with every quaternion over its norm that stands in them as a whole.

        Raises:
            ModelError: one is 0.
        """
        found = dict(start)
        for four, part in zip(self.quaternions, self.model.quaternions, strict=True):
            if not start.keys() >= {*four}:
                continue
            norm = sqrt(sum((start[e] * start[e] for e in four), start=0))
            if is_zero(norm):
                raise part.no_orientation()
            found |= {e: over(start[e], norm) for e in four}
        return found

    def on_unit_norms(self, state: State) -> State:
        """The symbols of quaternions, whose squares add up to 1, over their norm."""
        found: State = {}
        for four in self.quaternions:
            (norm,) = evaluate((sqrt(sum((x * x for x in four), start=0)),), state, fifty_digits())
            found |= {x: state[x] / norm for x in four}
        return found

    def let_go(self, name: str) -> Coordinate:
        """A driven coordinate without what drives it: one like others, which starts where it is driven from."""
        part = self.model.coordinates[name]
        (q,) = (x for x in self.symbols.q if x.name == name)
        start = part.start if part.motion is None else _written(self, self.start_value(q))
        return part.altered(motion=None, rate=None, acceleration=None, start=start)

    def ground_place(self, at: Any) -> Vector:
        """A place on the ground: coordinates, or the name of a ground point [m]."""
        return self.vector(self.model.points[at] if isinstance(at, str) else at)

    # -- values of parameters ----------------------------------------------------------------------

    @property
    def known_parameters(self) -> dict[Node, float]:
        """The parameters that have values."""
        return {self.symbols.parameters[name]: float(x) for name, x in self.model.exact_parameters().items()}

    @property
    def known_exactly(self) -> dict[Node, Scalar]:
        """The parameters that have values, as exact constants: 1/3, sqrt(2), pi/6."""
        return {self.symbols.parameters[name]: x for name, x in self.model.constant_parameters(self.graph).items()}

    def values_of_parameters(self, rng: Random | None, *, shaken: bool = False) -> dict[Node, Any]:
        """Values of the parameters with 50 digits: the model's own, else random ones; without `rng` those with a value.

        Args:
            shaken: all near the model's own and none of them special.
        """
        model, arithmetic = self.model, fifty_digits()
        known = model.exact_parameters()
        names, values = self.symbols.parameters, dict[Node, Any]()
        given = {name: part.value for name, part in model.parameters.items() if part is not None}
        for name in in_order(given)[0]:
            if name in known:
                values[names[name]] = evaluate((self.value(given[name]),), values, arithmetic)[0]
        if rng is None:
            return values
        for node in names.values():
            value = values.get(node)
            if value is None:
                values[node] = fifty_digits().number(rng.uniform(0.7, 1.3))
            elif shaken:
                values[node] = value * rng.uniform(0.8, 1.2) if value else fifty_digits().number(rng.uniform(0.05, 0.2))
        return values

    def values_for(
        self, scalars: Iterable[Scalar], near: Mapping[Node, float] | None = None, *, shaken: bool = False
    ) -> dict[Node, Any]:
        """Values, with 50 digits, at which all scalars have one: of the parameters, and of what else stands in them.

        Args:
            near: where symbols of the configuration are.
            shaken: as of `Scope.values_of_parameters`.
        Raises:
            DerivationError: they have none.
        """
        wanted, arithmetic = tuple(scalars), fifty_digits()
        for seed in range(1, TRIES):
            rng = Random(seed)
            values = self.values_of_parameters(rng, shaken=shaken)
            values |= {node: arithmetic.number(Fraction(x)) for node, x in (near or {}).items()}
            values |= {x: fifty_digits().number(rng.uniform(0.5, 2)) for x in symbols_of(wanted) if x not in values}
            try:
                evaluate(wanted, values, arithmetic)
            except (NoValue, ZeroDivisionError):
                continue
            return values
        raise DerivationError(
            "the configuration has no value at these parameters",
            fix="give parameters at which lengths and roots are real",
        )

    def numbers(self, scalars: Sequence[Scalar], state: Mapping[Node, float] | None = None) -> list[float] | None:
        """Values of scalars; None where they depend on a symbol without a value.

        Args:
            state: values of symbols other than parameters; None: these have none.
        """
        known = {**(state or {}), **self.known_exactly}
        return None if any(symbol not in known for symbol in symbols_of(tuple(scalars))) else numbers_of(scalars, known)

    def parameter_seeds(self, name: str) -> dict[Node, Scalar]:
        """Derivatives of the parameters by one of them: its own, and those of parameters that depend on it."""
        given = {other: part.value for other, part in self.model.parameters.items() if part is not None}
        found: dict[Node, Scalar] = {self.symbols.parameters[name]: 1}
        for other in in_order(given)[0]:
            value = given[other]
            if other != name and value is not None:
                (rate,) = tangent((self.value(value),), found)
                found |= {self.symbols.parameters[other]: rate} if rate != 0 else {}
        return found

    # -- bodies ------------------------------------------------------------------------------------

    def mass_properties(self, body: str) -> MassProperties:
        """Mass properties of one body; a body without mass has zeros.

        Raises:
            ModelError: a body that can turn has a mass and no inertia.
        """
        part = self.model.bodies[body]
        if part.parts is not None:
            return self.made_of(body).whole
        if part.shape is not None:
            return part.shape.mass_properties(self.value)
        m = self.value(part.mass)
        return MassProperties(m, self.vector(part.center), _inertia(self, body, part.inertia))

    def mass_rates(self, body: str) -> MassProperties | None:
        """(m', mass centre, I') of a body whose mass is an expression of t or of states; None of a constant mass.

        Raises:
            DerivationError: a rate holds an acceleration.
        """
        own = self.mass_properties(body)
        held = (own.m, *(x for row in own.I for x in row))
        if not depends_on(held, (self.symbols.t, *self.symbols.z)):
            return None
        rates = self.time_derivative(held)
        if depends_on(rates, (*self.symbols.a, *self.reactions_in_rates)):
            raise DerivationError(
                f"the rate of the mass of body '{body}' depends on an acceleration or a reaction",
                f"bodies.{body}",
                "let the rate of the state that is its mass depend on speeds and places alone",
            )
        return MassProperties(rates[0], own.com, Matrix.of((rates[1:4], rates[4:7], rates[7:10])))

    def unsaid_rate(self, body: str) -> Scalar:
        """Rate of a body's mass less what the flows with a rate of their own bring [kg/s]."""
        rates = self.mass_rates(body)
        flows = (force.flow for force in self.model.forces.values())
        said = [self.value(flow[1]) for flow in flows if flow is not None and flow[0] == body and flow[1] is not None]
        return sum((-x for x in said), start=0 if rates is None else rates.m)

    def made_of(self, body: str) -> Composite:
        """The pieces of a body and the whole of them, each formula in readable form; made once for a scope."""
        if body not in self.composites:
            self.composites[body] = _put_together(self, body)
        return self.composites[body]

    # -- generalized forces ------------------------------------------------------------------------

    def per_speed(self, row: ScalarRow) -> ScalarRow:
        """N^T applied to a row over the coordinates."""
        size = len(self.symbols.u)
        return tuple(sum((self.N[i][k] * x for i, x in enumerate(row)), start=0) for k in range(size))

    def from_potential(self, V: Scalar) -> ScalarRow:
        """-N^T dV/dq."""
        return tuple(-x for x in self.per_speed(gradient(V, self.symbols.q)))

    def with_speeds_named(self) -> Scope:
        """The scope in which declared speeds, and their derivatives, stand for what they are in its own speeds."""
        names = self.names
        found = _speeds_by_rates(self.model, names)
        rates = self.with_accelerations(tuple(found.values()))
        found |= {f"{name}'": rate for name, rate in zip(found, rates, strict=True)}
        return replace(self, names={**names, **found}).with_states_named()

    def with_states_named(self, of_forces: Mapping[str, Scalar] | None = None) -> Scope:
        """The scope in which the rates of states of first order stand for what they are in its own speeds.

        Args:
            of_forces: {"jack_p_1'": rate} of the states that forces bring along, which need the places of bodies; rates
                that hold one of them are named then.
        """
        laws = {f"{name}'": part.rate for name, part in self.model.states.items()}
        names = {**self.names, **(of_forces or {})}
        waiting = {name for name, law in laws.items() if law is None and name not in names}
        for name in in_order(laws)[0]:
            law = laws[name]
            if law is not None and waiting.isdisjoint(law.names):
                names[name] = law.evaluate(names, self._symbol_of)
            elif law is not None:
                waiting.add(name)
        return replace(self, names=names) if laws else self

    @property
    def dependent(self) -> tuple[str, ...]:
        """The names of the coordinates that are eliminated, in the model's order."""
        return tuple(name for name, part in self.model.coordinates.items() if part.dependent)

    @staticmethod
    def of(model: Model, *, with_laws: bool = False) -> Scope:
        """The symbols of a model, its kinematic equations, and the meaning of its names.

        Every rate is a speed of its own here, of dependent coordinates and of those of a quaternion too.

        Args:
            with_laws: rates and accelerations of driven coordinates are names, psi' and psi'', where they are long.
        Raises:
            DerivationError: a given acceleration whose integral has no closed form.
        """
        model = model.in_parts
        zero = parameters_of_zero(model)
        graph = Graph()
        t = graph.symbol("t")
        made = {name: graph.constant(name) for name in sorted(model.parameters, key=partial(_place, model))}
        parameters = {name: made[name] for name in model.parameters}
        q = tuple(graph.symbol(name) for name in model.coordinates)
        free = [name for name, c in model.coordinates.items() if not c.driven]
        u = tuple(graph.symbol(name + "'") for name in free)
        a = tuple(graph.symbol(name + "''") for name in free)
        inputs = {name: graph.symbol(name) for name in model.inputs}
        unknowns = {name: graph.symbol(name) for name in model.unknowns}
        states = {name: graph.symbol(name) for name in model.states}
        symbols = Symbols(graph, t, parameters, inputs, q, u, a, unknowns=unknowns, z=tuple(states.values()))
        names: dict[str, Scalar] = {**parameters, **unknowns, **inputs, **states, "t": t, "pi": graph.pi}
        tables: dict[str, Any] = {f"{name}(": table for name, table in model.functions.items()}  # looked up by calls
        names |= tables
        names |= {name: symbol for name, symbol in zip(model.coordinates, q, strict=True)}
        N: list[tuple[Scalar, ...]] = []
        nu: list[Scalar] = []
        laws: dict[Node, Scalar] = {}
        speed = dict(zip(free, range(len(free)), strict=True))
        for name, coordinate in model.coordinates.items():
            if name in speed:
                names[name + "'"], names[name + "''"] = u[speed[name]], a[speed[name]]
                N.append(tuple(int(k == speed[name]) for k in range(len(free))))
                nu.append(0)
            else:
                rate = driven_rate(coordinate, names, t, f"coordinates.{name}", zero)
                given = {name + "'": rate, name + "''": tangent((rate,), {t: 1})[0]}
                long = {graph.symbol(each): law for each, law in given.items() if with_laws and _is_long(law, t)}
                laws |= long
                names |= {**given, **{x.name: x for x in long}}
                N.append((0,) * len(free))
                nu.append(names[name + "'"])
        quaternions = tuple(tuple(graph.symbol(e) for e in each.coordinates) for each in model.quaternions)
        for four in quaternions:
            graph.hold_on_sphere(four)
        graph.hold_near(_own_numbers(model, symbols))
        return Scope(model, symbols, tuple(N), tuple(nu), names, quaternions, laws).with_speeds_named()


def _own_numbers(model: Model, symbols: Symbols) -> dict[Node, float]:
    """Parameters, coordinates and rates at the start, as far as the file says them in numbers."""
    known = model.exact_parameters()
    found = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
    with suppress(EomgenError, OverflowError):
        q, rates = model.start_values()
        found |= {node: q[node.name] for node in symbols.q if node.name in q}
        found |= {node: rates[node.name] for node in symbols.u if node.name in rates}
    return {node: value for node, value in found.items() if isfinite(value)}


def _speeds_by_rates(model: Model, names: Mapping[str, Scalar]) -> dict[str, Scalar]:
    """Declared speeds as they are declared, in what the names of rates stand for."""
    found = {name: part.rate.evaluate(names) for name, part in model.speeds.items() if part.rate is not None}
    for each in model.quaternions:
        e, rates = (tuple(names[name + prime] for name in each.coordinates) for prime in ("", "'"))
        found |= dict(zip(each.speeds, UnitQuaternion(*e).spin(rates), strict=True))
    return found


def _is_long(law: Scalar, t: Node) -> bool:
    """True if a given rate or acceleration is named to be readable: a function of t or a long constant, no samples."""
    if type(law) is not Node or law.op == "sampled":
        return False
    return depends_on(law, (t,)) or length_of(law) > LONGEST_LAW


def driven_rate(coordinate: Coordinate, names: dict[str, Scalar], t: Node, where: str, zero: Container[str]) -> Scalar:
    """The rate of a driven coordinate: f' for `motion`, f for `rate`, speed + integral of f for `acceleration`."""
    name = where.rpartition(".")[2]
    if coordinate.motion is not None:
        return tangent((coordinate.motion.named(name).evaluate(names),), {t: 1})[0]
    if coordinate.rate is not None:
        return coordinate.rate.named(f"{name}'").evaluate(names)
    assert coordinate.acceleration is not None
    start = 0 if coordinate.speed is None else coordinate.speed.evaluate(names)
    if (sampled := coordinate.acceleration.sampled) is not None:
        return _speed_by_samples(sampled.named(f"{name}''"), start, t)
    return start + integral_from_zero(coordinate.acceleration.evaluate(names), t, where, zero)


def _speed_by_samples(acceleration: Sampled, start: Scalar, t: Node) -> Scalar:
    """start + the integral of samples from 0 to t: one function, where the start is as plain a number as they are."""
    change = acceleration.integral()
    if type(start) is not Node and not change.pi_power:
        return through_samples(change.raised(Fraction(start)), t)
    return start + through_samples(change.named(f"integral({acceleration.name})"), t)


def integral_from_zero(f: Scalar, t: Node, where: str, zero: Container[str] | None = None) -> Scalar:
    """The integral of f from 0 to t in closed form; zero: as of `primitive`.

    Raises:
        DerivationError: none was found.
    """
    F = primitive(f, t, zero)
    if F is None:
        raise DerivationError(
            "the given acceleration has no integral in closed form",
            where,
            "give the coordinate's `motion` or `rate` instead",
        )
    return F - substituted((F,), {t: 0})[0]


def parameters_of_zero(model: Model) -> frozenset[str]:
    """The parameters whose value is 0."""
    return frozenset(name for name, value in model.exact_parameters().items() if value == 0)


LONGEST_INTEGRAND = 300  # operations: rules are sought for every part of it, and for products of parts
LONGEST_ROOTED = 16  # operations, where sines stand under a root: most have no closed form, which takes seconds to see


def primitive(f: Scalar, x: Node, zero: Container[str] | None = None) -> Scalar | None:
    """A function of x whose derivative is f, or None where no closed form was found.

    Args:
        zero: the parameters that are 0. Where none of them stands in it, a form that holds at k = 0 alone, as of
            exp(k x)/k, is left out; None: it is always part of it.
    """
    if not depends_on(f, (x,)):
        return f * x
    if len(order((f,))) > (LONGEST_ROOTED if _has_rooted_sines(f, x) else LONGEST_INTEGRAND):
        return None
    from sympy import Eq, Integral, Ne, Piecewise, false, true
    from sympy.integrals.manualintegrate import manualintegrate

    from eomgen.symbolic.print import scalar_from_sympy, to_sympy

    expression, variable = to_sympy((f, x))
    if any(case.has(variable) for each in expression.atoms(Piecewise) for _, case in each.args):
        return None  # there is no rule for what changes its form along x: of a function through samples that takes 10 s
    found = None if zero is None else _over_a_line(expression, variable, zero)
    found = manualintegrate(expression, variable) if found is None else found
    if found.has(Integral):
        return None
    if zero is not None and not any(symbol.name in zero for symbol in found.free_symbols):
        found = found.subs({**dict.fromkeys(found.atoms(Eq), false), **dict.fromkeys(found.atoms(Ne), true)})
    lookup = {symbol.name: symbol for symbol in symbols_of((f, x))}
    try:
        return scalar_from_sympy(found, lookup)
    except DerivationError:  # a function that the graph does not have
        return None


def _over_a_line(f: Any, x: Any, zero: Container[str]) -> Any | None:
    """P(x)/(a + b x) -> integral of the polynomial in it + r/b log(1 + b x/a), and of logarithms of such lines.

    None of others, and where a or b is 0. Between the places where a + b x vanishes the logarithm of the ratio is real.
    """
    from sympy import Add, Poly, PolynomialError, div, expand, fraction, integrate, log, together

    found, rest = 0, 0
    try:
        for term in Add.make_args(expand(f)):
            c, varying = term.as_independent(x, as_Add=False)
            if varying.func is log and Poly(varying.args[0], x).degree() == 1:
                b, a = Poly(varying.args[0], x).all_coeffs()
                found += c * ((x + a / b) * varying - x)
            else:
                rest += term
        over, under = fraction(together(rest))
        top, line = Poly(over, x), Poly(under, x)
    except PolynomialError:
        return None
    if line.degree() > 1 or (found == 0 and line.degree() == 0) or any(s.name in zero for s in f.free_symbols):
        return None
    whole, left = div(top, line)
    found += integrate(whole.as_expr(), x)
    if line.degree() == 0:
        return found
    b, a = line.all_coeffs()
    return None if a == 0 else found + left.as_expr() / b * log(1 + b * x / a)


def _has_rooted_sines(f: Scalar, x: Node) -> bool:
    """True if sines or cosines of x are under a root: integrals of these are elliptic, with few exceptions."""
    under = [a for node in order((f,)) if node.op == "sqrt" for a in node.args if holds_op(a, "sin", "cos")]
    return any(depends_on(node, (x,)) for node in order(under) if node.op in ("sin", "cos"))


def _zero(a: Scalar) -> bool:
    return type(a) is int and a == 0


def _sizes(model: Model) -> frozenset[str]:
    """The names that stand alone where a negative number is an error: masses, lengths and radii of bodies."""
    leaves = (leaf for body in model.bodies.values() for leaf in body.leaves(()))
    signed = (leaf.value for leaf in leaves if getattr(leaf.rule, "sign", "") and isinstance(leaf.value, Expression))
    return frozenset(value.text for value in signed if len(value.code) == 1 and value.literal is None)


# -------- simplify --------------------------------------------------------------------------------------------
# Scalar -> the same in a shorter form: what is divided by what dependent rates or declared speeds bring in.


LONGEST = 600  # characters of a scalar that is made readable
MOST = 9  # symbols in it


def shorter(x: Scalar) -> Scalar:
    """x as one quotient without common factors, where that takes fewer operations and x is not long."""
    if type(x) is not Node or text_size(x) > LONGEST or len(symbols_of((x,))) > MOST:
        return x
    short = cancelled(x, Work.ENTRY)
    return short if operations((short,)).total <= operations((x,)).total else x


def _written(scope: Scope, scalar: Scalar) -> Expression:
    """A scalar of the parameters as a formula; as a number where it is one of samples, which have no formula."""
    try:
        return as_expression(to_text(scalar))
    except ExpressionError:
        known = scope.model.exact_parameters()
        values = {node: float(known[name]) for name, node in scope.symbols.parameters.items() if name in known}
        return as_expression(Fraction(evaluate((scalar,), values, FLOAT)[0]))


# -------- mass properties -------------------------------------------------------------------------------------
# Scope -> the mass properties of a body: as they are given, or of its parts together, short.


def _inertia(scope: Scope, body: str, inertia: tuple[Expression, ...] | None) -> Matrix:
    if inertia is None:
        return Matrix.of((Vector.ZERO, Vector.ZERO, Vector.ZERO))
    values = [scope.value(e) for e in inertia]
    if len(values) == 1:
        return Matrix.of((Vector.ZERO, Vector.ZERO, (0, 0, values[0])))
    if len(values) not in (3, 6):
        raise ModelError(
            f"the inertia of body '{body}' has {len(values)} values",
            f"bodies.{body}.inertia",
            fix="give 1, 3 or 6 of them",
        )
    xx, yy, zz, xy, yz, xz = (*values, 0, 0, 0)[:6] if len(values) == 3 else values
    return Matrix.of(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))


def _put_together(scope: Scope, body: str) -> Composite:
    part = scope.model.bodies[body]
    composite = Composite.of(part.parts or (), part.mass, scope.value)
    return composite.written(lambda scalars: readable_all(scalars, Work.VALUE, scope.positive))
