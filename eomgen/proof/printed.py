"""Printed formulas -> checks of them, read back by our grammar: a derivation is proven as it is printed.

All sides of a = b = c are read and have the same value along the motion, at accelerations and multipliers from the
equations of motion. A letter that first stands on a left side is a name for the right side. A constant of motion has
the same value a step earlier and later, to first order, with 50 digits.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, exact_accelerations
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.kinematics import SystemInertia
from eomgen.model import FUNCTIONS, OutputSource
from eomgen.proof.states import refuse_open, way_through
from eomgen.symbolic.expression import LONGEST, Call, Fraction, Node, Scalar, State, Vector, gradient, inner, parse
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, of_one_length, tolerances

SPINS = ("omega_1", "omega_2", "omega_3")  # about the axes of the body
SOON = (fifty_digits().number(1) / 1000, fifty_digits().number(1) / 70)  # s after the start, in whose piece a law holds
SHORT = fifty_digits().number(1) / 10**12  # s, of differences
LAST = fifty_digits().number(1) / 10**44  # of the numbers of a state: their last digits
SHOWN = 60  # characters of one that cannot be read


@dataclass(frozen=True)
class Printed:
    """Formulas as they are printed.

    Args:
        formulas: the sides of each.
        constants: constants of motion, and the condition under which they are constant: "y >= 0 and t <= t0", "".
        letters: values, found by another way, of letters that only formulas define.
        texts: (where, text, the scalar that it stands for).
        definitions: (name, text) of parts that have a name in these texts, each before its use.
        laws: (coordinate, text) of motions from the start as functions of the time.
    """

    formulas: tuple[tuple[str, ...], ...] = ()
    constants: tuple[tuple[str, str], ...] = ()
    letters: Mapping[str, Scalar] = field(default_factory=dict)
    texts: tuple[tuple[str, str, Scalar], ...] = ()
    definitions: tuple[tuple[str, str], ...] = ()
    laws: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class ReadBack:
    """Printed formulas of a system, read back as scalars.

    Args:
        printed: the texts.
    """

    equations: EquationsOfMotion
    printed: Printed

    @property
    def equalities(self) -> list[tuple[str, Scalar, Scalar]]:
        """(text of the left side, a, b) of sides that must be equal."""
        return self._formulas[0]

    @cached_property
    def _formulas(self) -> tuple[list[tuple[str, Scalar, Scalar]], dict[str, Scalar]]:
        """(the equalities, the meaning of each name that they define)."""
        energies = {"T": self.equations.T, "V": self.equations.V}
        own, names = self._symbols, {**energies, **self._symbols}
        found = []
        for sides in self.printed.formulas:
            if sides[0] in energies and sides[0] in own:  # a parameter has the letter of an energy
                continue
            read = [self._derivatives.get(text, self._read(text, names)) for text in sides]
            known = [x for x in read if x is not None]
            known = [self.printed.letters[sides[0]], *known] if sides[0] in self.printed.letters else known
            found += [(sides[0], known[0], x) for x in known[1:]]
            if read[0] is None and known and sides[0].replace("_", "").isalnum():
                names[sides[0]] = known[0]
        return found, {name: x for name, x in names.items() if name not in energies or name in own}

    @cached_property
    def constants(self) -> list[tuple[str, Scalar, tuple[Scalar, ...]]]:
        """(text of a constant, its scalar, scalars that must be negative for it to stay constant)."""
        found = []
        for text, while_ in self.printed.constants:
            x, limits = self._read(text, self._formulas[1]), self._limits(while_)
            if x is not None and limits is not None:
                found.append((text, x, limits))
        return found

    def _limits(self, while_: str) -> tuple[Scalar, ...] | None:
        """Conditions "left <= right", joined by "and", as differences that are negative; None where one is not read."""
        found = []
        for condition in while_.split(" and ") if while_ else ():
            left, relation, right = condition.partition(" <= ") if " <= " in condition else condition.partition(" >= ")
            sides = [self._read(text, self._formulas[1]) for text in (left, right)]
            if sides[0] is None or sides[1] is None or not relation:
                return None
            found.append(sides[0] - sides[1] if relation == " <= " else sides[1] - sides[0])
        return tuple(found)

    @property
    def _symbols(self) -> Mapping[str, Scalar]:
        return {**self.equations.system.scope.names, **{x.name: x for x in self.equations.symbols.lam}}

    def _read(self, text: str, names: Mapping[str, Scalar]) -> Scalar | None:
        """A side; None where it is no formula of quantities that have a value at a state."""
        if len(text) > LONGEST:
            return None
        try:
            formula = parse(text, references=True)
        except ExpressionError:
            return None
        try:
            found: Scalar = formula.evaluate(names, self._value)
        except (ExpressionError, DerivationError, UsageError, KeyError):
            return None
        return found

    @staticmethod
    def unreadable(texts: Iterable[str]) -> str:
        """Message for the first expression that our grammar does not read; ""."""
        for text in texts:
            try:
                parse(text, references=True) if len(text) <= LONGEST else None
            except ExpressionError as error:
                return f"{text[:SHOWN]}: {error.what}"
        return ""

    @cached_property
    def data(self) -> list[tuple[str, Scalar, Scalar]]:
        """(name, scalar of the text, scalar of its quantity)."""
        names = dict(self._symbols)
        for name, text in self.printed.definitions:
            read = self._read(text, names)
            if read is not None:
                names[name] = read
        found = ((where, self._read(text, names), x) for where, text, x in self.printed.texts)
        return [(where, read, x) for where, read, x in found if read is not None]

    def _value(self, call: Call) -> Scalar:
        """A function of the motion, as outputs request it; energies, forces and angular velocities by their names."""
        of = str(call).partition("(")[2][:-1]
        known = {"V": self._potentials, "Q": self._forces}.get(call.name, {})
        if of in known:
            return known[of]
        if call.name in SPINS:
            found: Scalar = self._spin(of)[SPINS.index(call.name)]
            return found
        if call.name in FUNCTIONS and FUNCTIONS[call.name].source == OutputSource.BALANCE:
            raise DerivationError(f"'{call}' is a reaction, and proven as such")
        return Quantities(self.equations.system).value(call)

    def _spin(self, body: str) -> Vector:
        """Angular velocity of a body by its pose, in the axes of the body as a derivation prints it."""
        motion = self.equations.system.motion
        return motion.spin(motion.link(body))

    @cached_property
    def _derivatives(self) -> dict[str, Scalar]:
        """dT/du_k, its rate and dT/dq_k by their texts; where rates depend on others T is not that of the equations."""
        T, symbols = self.equations.T, self.equations.symbols
        if self.equations.system.free is not None:
            return {}
        momenta = gradient(T, symbols.u)
        gained = SystemInertia(self.equations.system.motion).carried_momenta
        moved = zip(self.equations.system.scope.with_accelerations(momenta), gained, strict=True)
        rates = [rate - gain for rate, gain in moved]
        found = {f"dT/d{q.name}": x for q, x in zip(symbols.q, gradient(T, symbols.q), strict=True)}
        for u, p, rate in zip(symbols.u, momenta, rates, strict=True):
            found |= {f"dT/d{u.name}": p, f"d/dt(dT/d{u.name})": rate}
        return found

    @cached_property
    def _potentials(self) -> dict[str, Scalar]:
        return {
            force.name: force.potential for force in self.equations.system.loads.applied if force.potential is not None
        }

    @cached_property
    def _forces(self) -> dict[str, Scalar]:
        """Generalized forces by coordinate, where no coordinate depends on others and there is no friction."""
        names = (u.name.removesuffix("'") for u in self.equations.symbols.u)
        whole = self.equations.system.free is None and not self.equations.friction
        return dict(zip(names, self.equations.Q, strict=True)) if whole else {}

    def wrong(self, state: State) -> str:
        """Message that names a formula which does not hold at a state of the motion; ""."""
        return _unequal(self.equalities, state | least_multipliers(self.equations, state))

    def wrong_data(self, state: State) -> str:
        """Message that names a text whose value at a state is not that of its quantity, with some a and lam; ""."""
        symbols = self.equations.symbols
        some = {x: fifty_digits().number(1 + 1 / k) for k, x in enumerate((*symbols.a, *symbols.lam), start=2)}
        return self.unreadable(text for _, text, _ in self.printed.texts) or _unequal(self.data, {**some, **state})

    def drifting(self, state: State) -> str:
        """Message that names a constant whose rate is not 0 at a state of the motion; "".

        Raises:
            NoValue: none of them is said to stay in the piece in which the state lies.
        """
        refuse_open(self.equations.system, state)
        said = [(text, x) for text, x, limits in self.constants if self._is_met(limits, state)]
        if not said:
            raise NoValue("nothing is said of this piece")
        values, rates, _ = way_through(self.equations.system, state).along([x for _, x in said])
        for (text, _), value, rate in zip(said, values, rates, strict=True):
            if abs(rate) > tolerances.COMPUTED * (1 + abs(value)):
                return f"{text} changes by {float(rate):.3g} in a second"
        return ""

    def wrong_law(self) -> str:
        """Message that names a law of motion with another start or acceleration, or one that violates a constraint; "".

        Raises:
            NoValue: no law is read, or something has no value soon after the start.
        """
        e, names = self.equations, {x.name: x for x in self.equations.symbols.q}
        read = {names[q]: self._read(text, self._formulas[1]) for q, text in self.printed.laws if q in names}
        laws = {q: x for q, x in read.items() if x is not None}
        speeds = {u.name: u for u in e.symbols.u}
        if not laws or e.friction or any(f"{q.name}'" not in speeds for q in e.symbols.q):
            raise NoValue("no law is read")
        start = self._declared_start()
        closed = not e.J or not _broken(e, start)
        for instant in (fifty_digits().number(0),) if closed else ():
            for q, (value, rate, _) in _along(laws, start, instant).items():
                for what, found, due in (("is", value, start[q]), ("moves by", rate, start[speeds[f"{q.name}'"]])):
                    if abs(found - due) > tolerances.COMPUTED * (1 + abs(due)):
                        return f"{q.name} {what} {float(found):.9g} at the start, not {float(due):.9g}"
        for instant in SOON:
            moved = _along(laws, start, instant)
            state = {**start, e.symbols.t: instant, **{q: value for q, (value, _, _) in moved.items()}}
            state |= {speeds[f"{q.name}'"]: rate for q, (_, rate, _) in moved.items()}
            if len(laws) == len(names) and (constraint := _broken(e, state)):
                return f"'{constraint}' does not hold at t = {float(instant):.3g} s"
            a = dict(zip(speeds, exact_accelerations(e, state), strict=True))
            for q, (_, _, found) in moved.items():
                due = a[f"{q.name}'"]
                if abs(found - due) > tolerances.COMPUTED * (1 + abs(found)):
                    return f"{q.name} is accelerated by {float(found):.9g}, not {float(due):.9g}"
        return ""

    def _declared_start(self) -> dict[Node, Any]:
        """Values of t, parameters (random without a value), coordinates and speeds at the start, as declared."""
        scope, symbols = self.equations.system.scope, self.equations.symbols
        known, parts = scope.model.exact_parameters(), scope.model.coordinates
        values: dict[Node, Any] = {
            symbols.t: fifty_digits().number(0),
            **dict.fromkeys(symbols.inputs.values(), fifty_digits().number(0)),
        }
        for k, (name, node) in enumerate(symbols.parameters.items()):
            values[node] = fifty_digits().number(float(known.get(name, 1 + Fraction(1, k + 2))))
        for suffix, nodes in (("", symbols.q), ("'", symbols.u)):
            for x in nodes:
                part = parts.get(x.name.removesuffix("'"))
                given = None if part is None else part.speed if suffix else part.start or part.near
                values[x] = (
                    fifty_digits().number(0)
                    if given is None
                    else evaluate((scope.value(given),), values, fifty_digits())[0]
                )
        return values

    @staticmethod
    def _is_met(limits: Sequence[Scalar], state: State) -> bool:
        return all(x < 0 for x in evaluate(limits, state, fifty_digits()))


def _along(laws: Mapping[Node, Scalar], values: State, instant: Any) -> dict[Node, tuple[Any, Any, Any]]:
    """(value, rate, acceleration) of each law at an instant, by differences."""
    (t,) = (x for x in values if x.name == "t")
    early, here, late = (
        evaluate(tuple(laws.values()), {**values, t: instant + h}, fifty_digits()) for h in (-SHORT, 0 * SHORT, SHORT)
    )
    return {
        q: (b, (c - a) / (2 * SHORT), (c - 2 * b + a) / SHORT**2)
        for q, a, b, c in zip(laws, early, here, late, strict=True)
    }


def _broken(equations: EquationsOfMotion, state: State) -> str:
    """The first constraint that is open at a state, or opens; ""."""
    rows = equations.system.constraints.closing
    rates = (inner(line, equations.symbols.u) + rest for line, rest in zip(equations.J, equations.sigma, strict=True))
    gaps = (0 if row.gap is None else row.gap for row in rows)
    found = evaluate((*gaps, *rates), state, fifty_digits())
    names = [row.constraint for row in rows] * 2
    return next((constraint for constraint, x in zip(names, found, strict=False) if abs(x) > tolerances.COMPUTED), "")


def _unequal(pairs: Sequence[tuple[str, Scalar, Scalar]], state: State) -> str:
    """Message for the first pair that is not equal at a state, to nine digits; a side that is 0/0 is left out; ""."""
    values = iter(evaluate([x for _, *sides in pairs for x in sides], state, fifty_digits()))
    for where, *sides in pairs:
        a, b = next(values), next(values)
        if abs(a - b) > tolerances.COMPUTED * (1 + abs(a) + abs(b)) and all(_has_value(x, state) for x in sides):
            return f"{where}: {float(a):.10g} against {float(b):.10g}"
    return ""


def _has_value(x: Scalar, state: State) -> bool:
    """True if its value hardly changes with the last digits of all numbers, which 0/0 does."""
    nearby = {node: value * (1 + (k + 1) * LAST) for k, (node, value) in enumerate(state.items())}
    (a,), (b,) = (evaluate((x,), each, fifty_digits()) for each in (state, nearby))
    return bool(abs(a - b) <= tolerances.COMPUTED * (1 + abs(a)))


def least_multipliers(equations: EquationsOfMotion, state: State) -> dict[Node, Any]:
    """Multipliers of least norm that satisfy J^T lam = M a - forcing, at a state of the motion."""
    if not equations.J:
        return {}
    n, k, symbols = len(equations.M), len(equations.J), equations.symbols
    entries = (*(x for row in (*equations.M, *equations.J) for x in row), *equations.forcing)
    wide = np.array(evaluate(entries, state, fifty_digits()), dtype=object)
    M, J, forcing = np.split(wide, [n * n, n * (n + k)])
    needed = (M.reshape(n, n) @ np.array([state[a] for a in symbols.a], dtype=object) - forcing).astype(float)
    J = J.reshape(k, n).astype(float)
    sizes = np.linalg.norm(J, axis=1)
    scaled = np.linalg.lstsq(of_one_length(J).T, needed, rcond=tolerances.COMPUTED)[0]
    lam = scaled / np.where(sizes > 0, sizes, 1.0)
    return {node: fifty_digits().number(float(x)) for node, x in zip(symbols.lam, lam, strict=True)}
