"""Equations that were judged -> checks of the verdicts, decided once more by numbers alone.

Both sides are evaluated in doubles, with a bound of their rounding, at consistent states: near the start with the
model's own parameters, at random ones with others, or along a run from the start (Runge-Kutta, order 4, the step
halved). Accelerations come from dense linear algebra, reactions from the free bodies in doubles, functions of the
motion from their second definitions. A right equation has sides that agree at all of them; a wrong one does not. What
is right to the first order about a place has a difference that falls to a quarter where the way there is halved.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import islice
from random import Random
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, with_accelerations
from eomgen.mechanics.impacts import ImpactEquations
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.start import Start
from eomgen.model import FUNCTIONS, OutputSource
from eomgen.proof.at_a_state import NumericState, state_in_numbers
from eomgen.proof.certificate import certify
from eomgen.proof.check import Certificate, Check, Tally
from eomgen.proof.impacts import sides_differ
from eomgen.proof.instant import NearbyStates
from eomgen.proof.states import STEP, closed_near, refuse_open
from eomgen.proof.trials import Trials
from eomgen.symbolic.expression import SLOPE, Call, Expression, Fraction, Node, Scalar, parse
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

NEAR, FAR = 5, 2  # states near the start, and at random with other parameters
STEPS, TIMES = 48, 4  # of a run; at how many of its instants the sides are compared
LENGTHS = (0.4, 0.1, 0.02)  # s
STILL = 1e-3  # of the size of a coordinate or speed: a motion that changes less decides nothing
EPSILON = float(np.finfo(float).eps)
SURE = 30  # times the bound of rounding, from which on two numbers differ
OF_THE_FILE = ("the values of the file", "what the file says", "rounding", "numbers")
NOT_DECIDED = ("frequency", "equilibrium", "statics", "inertia")
MULTIPLIER = "lam"
NAME = "verdicts, decided again, are the same"
HOW = "both sides in doubles, at consistent states and along runs from the start"


@dataclass(frozen=True)
class JudgedEquation:
    """An equation with its verdict.

    Args:
        text: as it was given.
        left, right: its sides, as they were read.
        kind: kind of its quantity.
        is_right: the verdict.
        up_to: condition under which it is right, in words.
        stands_for: names of the author and what they stand for, as texts.
        constants: names of the author that stand for nothing.
        equations: the equations of motion against which it was judged.
        at_rest: the motion starts with all speeds 0.
        difference: what is reported as too much on the left, as a text; "".
        impact: of an equation of an impact that impact, and left minus right over its unknowns.
        derived: scalars of quantities that derivations name, M[x', y'], by the texts of what asks for them.
    """

    text: str
    left: Expression
    right: Expression
    kind: str
    is_right: bool
    up_to: str
    equations: EquationsOfMotion
    stands_for: Mapping[str, str] = field(default_factory=dict)
    constants: tuple[str, ...] = ()
    at_rest: bool = False
    difference: str = ""
    derived: Mapping[str, Scalar] = field(default_factory=dict)
    impact: tuple[ImpactEquations, Scalar] | None = None

    @property
    def is_of_start(self) -> bool:
        """True if it holds in the motion from the start alone, or something is driven by a law of time."""
        words = ("from the start", "at the start", "first piece", "first integral", "any start")
        driven = any(q.motion is not None for q in self.equations.system.scope.model.coordinates.values())
        reported = driven or any(word in self.up_to for word in words)
        names = self.left.names | self.right.names
        of_places = self.kind not in ("energy", "force", "inertia") and not any(name.endswith("'") for name in names)
        return reported or (not self.is_right and (self.kind == "law" or of_places or self._gains))

    @property
    def _gains(self) -> bool:
        """True if it is an energy theorem: more than one energy stands on its left."""
        return self.kind == "energy" and len(self.left.code) > 1

    @property
    def may_differ_by_a_constant(self) -> bool:
        return bool(self.constants) or "a first integral" in self.up_to or "a constant of the potential" in self.up_to


def certify_judged(equations: EquationsOfMotion, judged: Iterable[JudgedEquation]) -> Certificate:
    """The proof of the equations against which others are judged, and of these verdicts by another decision."""
    return certify(equations) + verdicts_again(judged)


def verdicts_again(judged: Iterable[JudgedEquation]) -> tuple[Check, ...]:
    """Checks of all verdicts; those that numbers cannot decide are unchecked."""
    tally = Tally(NAME, HOW)
    for each in judged:
        tally.add(each.text, _Again(each).wrong)
    return tuple(tally.checks())


@dataclass(frozen=True)
class _Again:
    judged: JudgedEquation

    def wrong(self) -> str:
        """Message if the verdict does not hold; "".

        Raises:
            NoValue: the numbers do not decide it.
        """
        each = self.judged
        if each.impact is not None:
            apart = sides_differ(*each.impact)
            return "" if apart is not each.is_right else f"its sides {'differ' if apart else 'agree'} by numbers"
        if each.kind in NOT_DECIDED:
            raise NoValue(f"of a {each.kind} the solver of outputs decides, whose numbers `solve` proves")
        if not each.is_right and "while" in each.up_to:
            raise NoValue(f"it holds {each.up_to}, and not elsewhere")
        if len(each.constants) > 1 or (each.constants and not each.is_right):
            raise NoValue("constants of the author's own")
        if self._place:
            return ("" if each.is_right else self._of_wrong()) or self._of_first_order()
        return (self._of_right() if each.is_right else self._of_wrong()) or self._of_reported()

    def _of_right(self) -> str:
        states = list(self._along() if self.judged.is_of_start else self._nearby())
        apart = [found for state in states if (found := self._apart(state)) is not None]
        if not apart:
            raise NoValue("no state has values for it")
        if self.judged.may_differ_by_a_constant:
            first = apart[0]
            apart = [Rounded(x.value - first.value, x.error + first.error) for x in apart[1:]]
        off = next((x for x in apart if not x.may_vanish), None)
        return "" if off is None else f"it is judged right, and its sides differ by {off.value:.6g}"

    def _of_wrong(self) -> str:
        own = list(self._along() if self.judged.is_of_start else self._nearby())
        apart = [found for state in own if (found := self._apart(state)) is not None]
        if len(apart) < 2:
            raise NoValue("no state has values for it")
        return "it is judged wrong, and its sides agree" if all(x.may_vanish for x in apart) else ""

    @cached_property
    def _place(self) -> dict[str, str]:
        """{coordinate: its value} of the place about which it is right to the first order; {}: of another verdict."""
        found = self.judged.up_to.partition("first order about ")[2]
        return dict(each.split(" = ") for each in _NEXT.split(found)) if found else {}

    def _of_first_order(self) -> str:
        """Message if the difference of the sides does not fall faster than the distance from the place; ""."""
        decided = False
        for k, base in enumerate(self._nearby()):
            at = {name: self._reported(text, base) for name, text in self._place.items()}
            if any(x is None for x in at.values()):
                continue
            rng = Random(k)
            way = {x: rng.uniform(-1, 1) for x in base.equations.symbols.x}
            whole, half = (self._apart(_beside(base, at, way, part * tolerances.BESIDE_A_PLACE)) for part in (1.0, 0.5))  # type: ignore[arg-type]
            if whole is None or half is None:
                continue
            decided = True
            if not Rounded(max(abs(half.value) - abs(whole.value) / 3, 0.0), whole.error + half.error).may_vanish:
                sizes = f"{whole.value:.6g} and {half.value:.6g} at half the distance"
                return f"it is judged right to the first order, and its sides differ by {sizes}"
        if not decided:
            raise NoValue("no state beside the place has values for it")
        return ""

    def _of_reported(self) -> str:
        """Message if the reported factor, or the reported difference, is 0 at every state; ""."""
        each, factor = self.judged, _FACTOR.search(self.judged.up_to)
        if each.is_of_start:
            return ""
        for what, text in (("factor", factor[1] if factor else ""), ("difference", each.difference)):
            found = [x for state in self._nearby() if (x := self._reported(text, state)) is not None] if text else []
            if found and all(x.may_vanish for x in found):
                return f"its {what} is reported as {text}, which is 0 at every state"
        return ""

    def _reported(self, text: str, state: NumericState) -> Rounded | None:
        """Value of a reported text at a state; None where it has none."""
        try:
            return Sides(state, self.judged.stands_for, tolerances.ITERATED).worked(parse(text, references=True))
        except (ExpressionError, NoValue, ZeroDivisionError, OverflowError, ValueError, KeyError):
            return None

    def _apart(self, state: NumericState) -> Rounded | None:
        return _at(state, self.judged)

    # -- states ------------------------------------------------------------------------------------

    def _nearby(self) -> Iterator[NumericState]:
        """States that satisfy the constraints: near the start, then random ones."""
        equations, up_to = self.judged.equations, self.judged.up_to
        own = any(word in up_to for word in (*OF_THE_FILE, "holds where", "a constant of"))
        own |= any(text != "0" for text in self._place.values())  # it may be that of the file's values alone
        for name, supply in Trials(equations).states.supplies:
            if name != "at random" or not own:
                count = NEAR if name == "at the start" else FAR
                yield from (state_in_numbers(equations, place) for place in islice(supply, count))

    def _along(self) -> Iterator[NumericState]:
        """States of the motion from the start, with the model's parameters; for a wrong verdict with others too."""
        own = self.judged.equations.system.scope.model.exact_parameters()
        missing = [name for name in self.judged.equations.system.symbols.parameters if name not in own]
        if missing:
            raise NoValue(f"{', '.join(missing)} has no value")
        yield from self._run({})
        if not self.judged.is_right:
            rng, parts = Random(4), self.judged.equations.system.scope.model.parameters
            given = {n: x for n, x in own.items() if (part := parts.get(n)) is not None and not part.formula}
            yield from self._run({name: float(x) * rng.uniform(0.9, 1.1) for name, x in given.items()})

    def _run(self, changed: Mapping[str, float]) -> Iterator[NumericState]:
        """The motion from the start with changed parameters.

        Raises:
            NoValue: it does not move, or is too fast for these steps.
        """
        equations = self.judged.equations
        system, symbols = equations.system, equations.symbols
        known = system.scope.model.exact_parameters(changed)
        parameters = {node: Fraction(float(known[name])) for name, node in symbols.parameters.items()}
        begun = Start.of(system, changed, {u.name: 0.0 for u in symbols.u} if self.judged.at_rest else {}).values
        moving = symbols.x
        x0 = np.array([begun[node.name] for node in moving])
        rhs = RightHandSide.of(Program.right_hand_side(with_accelerations(equations)), "numpy")
        p = np.array([float(x) for x in parameters.values()])

        def rate(t: float, x: np.ndarray) -> np.ndarray:
            with np.errstate(all="ignore"):
                return np.asarray(rhs(t, x, p))[: len(x)]

        for length in LENGTHS:
            rough, fine = (_runge_kutta(rate, x0, length, steps) for steps in (STEPS, 2 * STEPS))
            size = np.max(np.abs(fine), axis=0, initial=0.0) + 1e-3
            if np.all(np.isfinite(fine)) and np.all(np.abs(rough - fine) <= tolerances.CARRIED * size):
                break
        else:
            raise NoValue("the motion from the start is too fast for the steps of this check")
        if np.max(np.abs(fine - x0) / size) < STILL:
            raise NoValue("nothing moves from the start")
        for k in range(1, TIMES + 1):
            numbers = {symbols.t: length * k / TIMES} | dict(zip(moving, fine[k].tolist(), strict=True))
            yield NumericState(equations, parameters, numbers)


def _beside(base: NumericState, at: Mapping[str, Rounded], way: Mapping[Node, float], part: float) -> NumericState:
    """The state that lies a part of a way from a place at rest, where the constraints hold."""
    equations, system = base.equations, base.equations.system
    start = {x: at[x.name].value if x.name in at else 0.0 for x in way}
    numbers = {system.symbols.t: base.numbers[system.symbols.t]} | {x: start[x] + part * way[x] for x in way}
    values = closed_near(system, NumericState(equations, base.parameters, numbers).values)
    refuse_open(system, values)
    return NumericState(equations, base.parameters, {x: float(values[x]) for x in numbers})


def _runge_kutta(
    rate: Callable[[float, np.ndarray], np.ndarray], x: np.ndarray, length: float, steps: int
) -> np.ndarray:
    """x at TIMES + 1 instants from the start on."""
    found, h = [x], length / steps
    for k in range(steps):
        t = k * h
        a = rate(t, x)
        b = rate(t + h / 2, x + h / 2 * a)
        c = rate(t + h / 2, x + h / 2 * b)
        d = rate(t + h, x + h * c)
        x = x + h / 6 * (a + 2 * b + 2 * c + d)
        if (k + 1) % (steps // TIMES) == 0:
            found.append(x)
    return np.array(found)


# -- both sides in doubles ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Rounded:
    """A number and a bound of its error."""

    value: float
    error: float

    @property
    def may_vanish(self) -> bool:
        return abs(self.value) <= SURE * self.error


def _at(state: NumericState, judged: JudgedEquation) -> Rounded | None:
    """Left side minus right side at a state; None where it has no value there, or is stated for another piece."""
    error = tolerances.CARRIED if judged.is_of_start else tolerances.ITERATED
    sides = Sides(state, judged.stands_for, error, derived=judged.derived)
    try:
        if any(sides.worked(condition).value < 0 for condition in _conditions(judged.up_to)):
            return None
        return _constant(sides, judged) if judged.constants else sides.difference(judged)
    except (ZeroDivisionError, OverflowError, ValueError, KeyError):
        return None


def _constant(sides: Sides, judged: JudgedEquation) -> Rounded:
    """The author's constant C at a state, by D(C) = D(0) + C (D(1) - D(0)) = 0."""
    none, one, two = (replace(sides, constants=dict.fromkeys(judged.constants, float(c))) for c in range(3))
    D = [each.difference(judged) for each in (none, one, two)]
    slope = D[1].value - D[0].value
    if not Rounded(D[2].value - D[0].value - 2 * slope, sum(x.error for x in D)).may_vanish:
        raise NoValue("the author's constant does not stand there by itself")
    return _rounded(_BINARY["/"], [Rounded(-D[0].value, D[0].error), Rounded(slope, D[0].error + D[1].error)])


def _conditions(up_to: str) -> list[Expression]:
    """Expressions that are not negative where the verdict holds.

    They are x and -y for `what holds where x > 0 and y < 0`, and L - r for `while r <= L`.

    Raises:
        NoValue: the words are no such conditions.
    """
    reported = next((up_to.partition(words)[2] for words in ("what holds where ", "while ") if words in up_to), "")
    found = []
    for each in reported.split(" and ") if reported else ():
        sides = _COMPARED.fullmatch(each.strip())
        if sides is None:
            raise NoValue(f"where it holds is said in other words: {each}")
        low, high = (sides[3], sides[1]) if sides[2] in (">", ">=") else (sides[1], sides[3])
        try:
            found.append(parse(high) - parse(low))
        except ExpressionError as error:
            raise NoValue(error.what) from error
    return found


_NEXT = re.compile(r", (?=[^\s=,]+ = )")
_FACTOR = re.compile(r"the factor (\S+(?: [-+] \S+)*)")
_COMPARED = re.compile(r"([^<>=]+?)\s*(<=|>=|<|>)\s*([^<>=]+)")


@dataclass(frozen=True)
class Sides:
    """The sides of equations at a state.

    Args:
        state: where.
        stands_for: names of the author and what they stand for.
        error: of what is known of the state, relative.
        constants: values for names of the author that stand for nothing.
        impact: of an equation of an impact that impact, and left minus right over its unknowns.
        derived: scalars of quantities that derivations name.
    """

    state: NumericState
    stands_for: Mapping[str, str]
    error: float
    constants: Mapping[str, float] = field(default_factory=dict)
    derived: Mapping[str, Scalar] = field(default_factory=dict)

    def difference(self, judged: JudgedEquation) -> Rounded:
        """Left minus right."""
        left, right = self.worked(judged.left), self.worked(judged.right)
        return Rounded(left.value - right.value, left.error + right.error)

    def worked(self, side: Expression) -> Rounded:
        """A side, piece by piece."""
        stack: list[Rounded] = []
        for kind, what in side.code:
            if kind == "number":
                stack.append(Rounded(float(what), 0.0 if float(what) == what else EPSILON * abs(float(what))))
            elif kind == "name":
                stack.append(self._named(what))
            elif kind == "call":
                stack.append(self._called(what))
            elif kind == "neg":
                x = stack.pop()
                stack.append(Rounded(-x.value, x.error))
            elif kind == "function":
                name, count = what
                stack[-count:] = [_function(name, stack[-count:])]
            elif kind in _BINARY:
                stack[-2:] = [_rounded(_BINARY[kind], stack[-2:])]
            else:
                raise NoValue("samples stand in it")
        return stack[0]

    def _named(self, name: str) -> Rounded:
        """Value of a name with its primes; of a name of the author by the text that defines it."""
        bare = name.rstrip("'")
        if bare in self.stands_for:
            return self._renamed(parse(self.stands_for[bare]), len(name) - len(bare))
        if name in self.constants:
            return Rounded(self.constants[name], 0.0)
        if name == "pi":
            return Rounded(math.pi, EPSILON)
        if name not in self.state.equations.system.scope.names:
            raise NoValue(f"'{name}' has no value")
        return self._known(name)

    def _known(self, name: str) -> Rounded:
        (value,) = evaluate((self.state.equations.system.scope.names[name],), self._values, fifty_digits())
        return Rounded(float(value), self.error * (abs(float(value)) + self._scale(name)) + tolerances.ZERO_AT_50)

    def _scale(self, name: str) -> float:
        """Usual size of values of the same kind: smaller ones are known no better than a share of it."""
        symbols = self.state.equations.symbols
        kinds = ((*symbols.a, *symbols.lam), symbols.u, symbols.q)
        node = self.state.equations.system.scope.names[name]
        held = next((some for some in kinds if node in some), ())
        return 1e-3 * max((abs(float(self._values[x])) for x in held), default=0.0)

    def _renamed(self, meant: Expression, dots: int) -> Rounded:
        """Value of k q + c, or of its rate k q' by the derivative of the defining text."""
        if not dots:
            return self.worked(meant)
        total, names = Rounded(0.0, 0.0), self.state.equations.system.scope.names
        for name in (x for x in meant.names if x + "'" * dots in names):
            slope = self._shifted(meant, name, 1.0) - self._shifted(meant, name, 0.0)
            rate = self._known(name + "'" * dots)
            total = Rounded(total.value + slope * rate.value, total.error + abs(slope) * rate.error)
        return total

    def _shifted(self, meant: Expression, name: str, by: float) -> float:
        """Value of a formula with one name shifted."""
        lookup = {x: self._named(x).value for x in meant.names}
        lookup = {**lookup, "pi": math.pi, name: lookup[name] + by}
        return float(meant.evaluate(lookup))

    @cached_property
    def _values(self) -> Mapping[Node, Any]:
        """Values of every symbol; accelerations and multipliers by dense linear algebra, where the state has them."""
        try:
            return {**self.state.values, **self.state.unknowns}
        except NoValue:
            return self.state.values

    def _called(self, call: Call) -> Rounded:
        """A function of the motion, by its second definition where it has one."""
        if call.name == MULTIPLIER:
            label = str(call)
            node = next(x for x in self.state.equations.symbols.lam if x.name == label)
            return Rounded(float(self._values[node]), self.error * abs(float(self._values[node])))
        if call.name == SLOPE:
            slope = self._slope(call)
            return Rounded(slope, tolerances.COMPUTED * abs(slope) + self.error * self._size(call))
        if (derived := self.derived.get(str(call))) is not None:
            known = float(evaluate((derived,), self._values, fifty_digits())[0])
            return Rounded(known, tolerances.COMPUTED * abs(known) + self.error * self._size(call))
        if call.name not in FUNCTIONS:
            raise NoValue(f"'{call.name}' is no function of the outputs")
        function = FUNCTIONS[call.name]
        if function.source == OutputSource.BALANCE:
            forces = [abs(x) for x in self.state.reactions.values()]
            value = self.state.reactions.get(str(call))
            if value is None:
                value = self.state.value_of(Expression(str(call), (("call", call),), (0,)))
            return Rounded(value, self.error * max(forces, default=abs(value)))
        if function.second is not None:
            value = float(function.second(NearbyStates(self.state), call))
        else:
            value = float(
                evaluate((Quantities(self.state.equations.system).value(call),), self._values, fifty_digits())[0]
            )
        if not math.isfinite(value):
            raise NoValue(f"{call} has no value there")
        return Rounded(value, tolerances.COMPUTED * abs(value) + self.error * self._size(call))

    def _slope(self, call: Call) -> float:
        """Derivative of an energy by a speed, or by a coordinate with all that this moves: a central difference."""
        own, values = self.state.equations.system, dict(self._values)
        energy, by, *free = call.args
        system = own.free if free and own.free else own
        along, arithmetic = dict[Node, Any](), fifty_digits()
        assert isinstance(energy, Expression)
        if system is not own:
            values |= zip(system.symbols.u, evaluate(own.free_rates(system), self._values, arithmetic), strict=True)
        names = [u.name for u in system.symbols.u]
        if str(by) in names:
            along[system.symbols.u[names.index(str(by))]] = 1
        else:
            column = tuple(row[names.index(f"{by}'")] for row in system.scope.N)
            along |= zip(system.symbols.q, evaluate(column, values, arithmetic), strict=True)
        scalar = Quantities(system).of(energy)
        aside = ({x: values[x] + s * STEP * d for x, d in along.items()} for s in (1, -1))
        above, below = (evaluate((scalar,), {**values, **each}, arithmetic) for each in aside)
        return float((above[0] - below[0]) / (2 * STEP))

    def _size(self, call: Call) -> float:
        """Size by which the rounding of a value is measured: that of the speeds of the state."""
        return 1e-3 * max((abs(float(self._values[x])) for x in self.state.equations.symbols.u), default=0.0)


_BINARY: Mapping[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "^": lambda a, b: a**b if a >= 0 or b == round(b) else math.nan,
}
_FUNCTIONS: Mapping[str, Callable[..., float]] = {
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp")},
    **{name: getattr(math, name) for name in ("sinh", "cosh", "tanh", "log")},
    "ln": math.log,
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: (x > 0) - (x < 0),
}


def _function(name: str, args: Sequence[Rounded]) -> Rounded:
    if name not in _FUNCTIONS:
        raise NoValue(f"{name} is not worked out here")
    return _rounded(_FUNCTIONS[name], args)


def _rounded(operation: Callable[..., float], args: Sequence[Rounded]) -> Rounded:
    """Value and error bound of a function of arguments with error bounds."""
    values = [x.value for x in args]
    value, error = float(operation(*values)), 0.0
    for k, x in enumerate(args):
        moved = [*values[:k], x.value + x.error, *values[k + 1 :]]
        try:
            error += abs(float(operation(*moved)) - value)
        except (ValueError, ZeroDivisionError, OverflowError):
            moved[k] = x.value - x.error
            error += abs(float(operation(*moved)) - value)
    if not math.isfinite(value):
        raise ValueError("no value")
    return Rounded(value, error + 4 * EPSILON * abs(value))
