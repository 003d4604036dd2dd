"""Model, equation of somebody -> Verdict: right, up to what; wrong, and why; or undecided."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eomgen.errors import (
    DerivationError,
    EomgenError,
    ExpressionError,
    MissingValues,
    RunFailed,
    UsageError,
)
from eomgen.judge.case import Case
from eomgen.judge.causes import causes_of, depends_on_any
from eomgen.judge.comparison import LONG, Comparison, excess
from eomgen.judge.decision import combination, is_zero_everywhere, linear_row
from eomgen.judge.kinds import KINDS, kind_of_equation
from eomgen.judge.reading import HandEquation
from eomgen.judge.renaming import renamings, turnings
from eomgen.judge.verdict import RIGHT, UNDECIDED, WRONG, Cause, Verdict
from eomgen.mechanics.equilibria.search import all_equilibria
from eomgen.model.fields import AtRest, WrittenEquation
from eomgen.model.reader import ModelOrPath, model_at
from eomgen.model.replaced import equation_typed, with_values
from eomgen.model.values import exact_parameters
from eomgen.questions.answers import Answer
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import depends_on, derivative, gradient, substituted
from eomgen.symbolic.expression.exact_numbers import exact
from eomgen.symbolic.expression.expressions import Reference
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work, doing
from eomgen.symbolic.print.text import readable_text

Meanings = Mapping[str, Scalar]


def verify(
    model: ModelOrPath, equation: Any, *, at: Any = None, from_rest: bool | None = None, kind: str | None = None
) -> Verdict:
    """Whether an equation of somebody is right for a model, up to what, and if not, why.

    Args:
        equation: a text of the grammar, LaTeX, or a sympy equation (an expression is what is 0).
        at: the instant that it speaks of, an equation such as "theta = pi/2", or "equilibrium".
        from_rest: the motion starts with all speeds 0.
        kind: what it is about, one of KINDS; None: what stands in it says so.
    Raises:
        ExpressionError: it cannot be read; column and length say where.
    """
    model = model_at(model)
    return Judge(Case(model, bool(from_rest))).verdict(equation, at=at, kind=kind)


@dataclass(frozen=True)
class Judge:
    """What judges equations of one model."""

    case: Case

    @doing("the verdict")
    def verdict(self, equation: Any, *, at: Any = None, kind: str | None = None) -> Verdict:
        """The verdict on one equation.

        Raises:
            ExpressionError: it cannot be read.
            UsageError: no such kind.
        """
        if kind is not None and kind not in KINDS:
            raise UsageError(f"there is no kind '{kind}' of equations", mend=f"one of {', '.join(KINDS)}")
        written = self.case.reading.read(equation)
        known = kind or kind_of_equation(written, self.case.model)
        try:
            return self._judged(written, known, _instant(self.case, at))
        except (DerivationError, RunFailed, MissingValues) as error:
            return Verdict(written.given, known, UNDECIDED, reason=error.what)

    def _judged(self, written: HandEquation, kind: str, at: WrittenEquation | AtRest | None) -> Verdict:
        case = self.case
        unknown = case.unknown_names(written)
        if not unknown:
            case.check(written)
        if at is None and kind == "equilibrium" and not unknown:
            found = self._at_rest(written)
            if found is not None:
                return found
            kind = "motion"
        if at is not None or kind == "frequency" or (kind == "statics" and not unknown):
            return self._asked(written, kind, at)
        if unknown:
            return self._of_other_names(written, kind, unknown)
        course = self._course(written)
        if course is not None:
            return course
        scalar = case.value(written.difference)
        return self._of_scalar(written, kind, scalar)

    def _at_rest(self, written: HandEquation) -> Verdict | None:
        """Of an equation in which nothing moves: of the ties, or of rest; None: the model is at rest nowhere."""
        case = self.case
        holds, up_to = self._decided(case.value(written.difference), "law")
        if holds:
            return Verdict(written.given, "equilibrium", RIGHT, up_to)
        try:
            found = all_equilibria(case.system).found
        except (DerivationError, MissingValues):
            found = ()
        for place in found:
            exact = case.value(written.difference)
            if place.is_exact and is_zero_everywhere(case.system, *substituted((exact,), place.exact)).holds:
                return Verdict(written.given, "equilibrium", RIGHT)
        if not found and case.system.symbols.u and not _static(case):
            return None
        return self._asked(written, "equilibrium", AtRest())

    def _of_scalar(self, written: HandEquation, kind: str, scalar: Scalar) -> Verdict:
        """The verdict on an equation whose names are all known."""
        holds, up_to = self._decided(scalar, kind)
        if holds:
            return Verdict(written.given, kind, RIGHT, up_to)
        if (values := self._with_values(written, kind, scalar)) is not None:
            return values
        if (begun := self.case.as_begun) is not None:
            with suppress(EomgenError):
                holds_so, up_to_so = Judge(begun)._decided(begun.value(written.difference), kind)
                if holds_so:
                    told = "contacts that slide as they do at the start"
                    return Verdict(written.given, kind, RIGHT, f"{told} and {up_to_so}" if up_to_so else told)
        if holds is None:
            return Verdict(written.given, kind, UNDECIDED, reason=up_to or "no state of the model decides it")
        return self._wrong(written, kind, scalar)

    def _with_values(self, written: HandEquation, kind: str, scalar: Scalar) -> Verdict | None:
        """Right where the numbers in it are values of the file: of parameters that it does not name."""
        case, parameters = self.case, self.case.system.symbols.parameters
        known = {name: exact(x) for name, x in exact_parameters(case.model).items() if not isinstance(x, float)}
        missing: dict[Node, Scalar] = {
            x: known[n] for n, x in parameters.items() if n in known and n not in written.names
        }
        numbers = {what for side in (written.left, written.right) for kind_, what in side.code if kind_ == "number"}
        if not numbers & {x for x in missing.values() if x not in (0, 1)}:
            return None
        (plain, *rows) = substituted((scalar, *case.rows, *case.closing), missing)
        n = len(case.rows)
        own, closing = ([linear_row(x, case.forced)[0] for x in some] for some in (rows[:n], rows[n:]))
        row, linear = linear_row(plain, case.forced)
        if is_zero_everywhere(case.system, plain).holds:
            holds = kind != "motion"
        else:
            holds = linear and bool(combination(case.system, row, own, closing).holds)
        if not holds:
            return None
        needed = [x for x in missing if depends_on_any((scalar, *case.rows), (x,))]
        told = ", ".join(f"{x.name} = {readable_text(missing[x])}" for x in needed)
        return Verdict(written.given, kind, RIGHT, f"the values of the file: {told}")

    # -- right ------------------------------------------------------------------------------------

    def _decided(self, scalar: Scalar, kind: str) -> tuple[bool | None, str]:
        """(whether it is right, up to what)"""
        case = self.case
        found = is_zero_everywhere(case.system, scalar)
        if found.holds:
            if kind == "motion":
                return False, "identity"
            return True, "the ties" if found.on_ties else ""
        undecided = found.holds is None
        if kind == "energy" and self._is_constant_of_potential(scalar):
            return True, "a constant of the potential energy"
        if case.equations is None:
            return (None if undecided else False), ""
        if depends_on(scalar, case.forced):
            follows = case.follows(scalar)
            if follows.holds:
                return True, self._told(scalar, kind, follows.rows, follows.on_ties)
            undecided = undecided or follows.holds is None
        if kind in ("law", "energy") and (found_ := self._integral(scalar)):
            return found_
        moving = (*case.system.symbols.u, *case.system.symbols.a)
        if case.speeds and depends_on(scalar, moving) and not depends_on(scalar, case.system.symbols.lam):
            (started,) = substituted((case.phase.eliminated(scalar),), case.speeds)
            if is_zero_everywhere(case.system, started).holds:
                return True, "the energy theorem and the momenta from the start"
        return (None if undecided else False), ""

    def _is_constant_of_potential(self, scalar: Scalar) -> bool:
        symbols = self.case.system.symbols
        slopes = gradient(scalar, (symbols.t, *symbols.q, *symbols.u))
        return bool(is_zero_everywhere(self.case.system, *slopes).holds)

    def _told(self, scalar: Scalar, kind: str, rows: Sequence[int], on_ties: bool) -> str:
        """What was used, in words."""
        case, n = self.case, len(self.case.rows)
        names = [case.system.symbols.u[k].name.removesuffix("'") for k in rows if k < n]
        found = []
        if kind != "motion":
            found.append("the equations of motion")
        elif len(names) > 1:
            found.append(f"a combination of the equations of {', '.join(names)}")
        elif names:
            factor = self._factor(scalar, next(k for k in rows if k < n))
            found += [f"the factor {factor}"] if factor else []
        if on_ties or any(k >= n for k in rows):
            found.append("the ties")
        return " and ".join(found)

    def _factor(self, scalar: Scalar, row: int) -> str:
        """What the author multiplied the equation by; "" where that is 1."""
        case = self.case
        a = next((x for x in case.system.symbols.a if depends_on(case.rows[row], (x,))), None)
        if a is None:
            return ""
        below = derivative(case.rows[row], a)
        if type(below) is not Node and below == 0:
            return ""
        factor = legible(over(derivative(scalar, a), below), Work.FORMULA, case.system.scope.positive, LONG)
        return "" if type(factor) is not Node and factor == 1 else readable_text(factor) or "of the state"

    def _integral(self, scalar: Scalar) -> tuple[bool, str] | None:
        """Of what stays constant along the motion: whether it is right; None: it does not."""
        case, symbols = self.case, self.case.system.symbols
        if not depends_on(scalar, symbols.u):
            return None
        try:
            (rate,) = case.system.scope.with_accelerations((scalar,))
        except DerivationError:
            return None
        if not case.follows(rate).holds:
            return None
        constants = [x for x in (symbols.unknowns or {}).values() if depends_on(scalar, (x,))]
        if constants or not case.start:
            return True, "a first integral of the motion"
        (start,) = substituted((scalar,), case.start)
        if is_zero_everywhere(case.system, start).holds:
            return True, "the first integral from the start"
        return False, "constant"

    def _course(self, written: HandEquation) -> Verdict | None:
        """Of a coordinate as a function of time; None: it is something else."""
        case = self.case
        name = written.left.code[0][1] if len(written.left.code) == 1 and written.left.code[0][0] == "name" else ""
        coordinates = case.model.coordinates
        moving = {*coordinates, *(f"{q}'" for q in coordinates), *(f"{q}''" for q in coordinates), *case.model.speeds}
        if name not in coordinates or "t" not in written.right.names or written.right.names & moving:
            return None
        symbols, scope = case.system.symbols, case.system.scope
        course = case.value(written.right)
        q = next(x for x in symbols.q if x.name == name)
        rate = derivative(course, symbols.t)
        known = {q: course}
        for x, value in ((f"{name}'", rate), (f"{name}''", derivative(rate, symbols.t))):
            node = scope.names[x]
            if type(node) is Node and node.op == "symbol":
                known[node] = value
        if coordinates[name].driven:
            return None
        start = substituted((q - course, scope.names[f"{name}'"] - rate), {**case.start, symbols.t: 0})
        begins = not case.start or is_zero_everywhere(case.system, *start).holds
        others = [x for x in (*symbols.q, *symbols.u) if x not in known]
        left = substituted(case.rows, known)
        mine = [row for row in left if not depends_on(row, (*others, *case.forced))]
        inputs = {node: case.system.inputs[n] for n, node in symbols.inputs.items()}
        found = is_zero_everywhere(case.system, *substituted(tuple(mine), inputs)) if mine else None
        if found is None or found.holds is None:
            return Verdict(written.given, "law", UNDECIDED, reason="the equations of motion do not decide it alone")
        if found.holds and begins:
            return Verdict(written.given, "law", RIGHT, "the motion from the start")
        what = "the equations of motion do not hold with it" if not found.holds else "the start is another one"
        rest = "" if found.holds else excess(case, mine[0] if len(mine) == 1 else 0)
        cause = Cause(
            "other",
            f"{what}: put in, there is left {rest}" if rest else what,
            quantity="the start" if found.holds else "the equation of motion",
        )
        return Verdict(written.given, "law", WRONG, difference=rest, causes=(cause,))

    # -- other names ---------------------------------------------------------------------------------

    def _of_other_names(self, written: HandEquation, kind: str, unknown: list[str]) -> Verdict:
        """Of an equation with names that the model does not have: renamed, constants, or forces of constraints."""
        case = self.case
        for renaming in renamings(case, written, unknown):
            holds, up_to = self._decided(case.value(written.difference, renaming.values), kind)
            if holds and not (renaming.guessed and up_to.endswith("the ties")):
                return Verdict(written.given, kind, RIGHT, up_to, renaming.told)
        free = {name: case.system.scope.graph.symbol(f"({name})") for name in unknown}
        try:
            scalar = case.value(written.difference, free)
        except ExpressionError:
            scalar = None
        if scalar is not None:
            if kind in ("law", "energy") and not any(name + "'" in written.names for name in unknown):
                found = self._integral(scalar)
                if found and found[1] != "constant":
                    return Verdict(written.given, kind, RIGHT, f"{found[1]}, with {', '.join(unknown)} constant")
                if found and depends_on(scalar, tuple(free.values())):
                    return Verdict(
                        written.given,
                        kind,
                        RIGHT,
                        f"a first integral of the motion, with {', '.join(unknown)} constant",
                    )
            without = {name: 0 for name in unknown}
            if kind == "motion" and not any(f"{name}'" in written.names for name in unknown):
                rest = substituted((scalar,), {free[name]: 0 for name in without})[0]
                if self._decided(rest, kind)[0]:
                    told = " and ".join(unknown)
                    cause = Cause("constraint_force", _left_in(told), told, quantity=f"the force {told}")
                    return Verdict(written.given, kind, WRONG, difference=told, causes=(cause,))
        best = next((x for x in renamings(case, written, unknown) if x.near), None)
        if best is None:
            names = ", ".join(f"'{name}'" for name in unknown)
            known = ", ".join(name for name in case.system.scope.names if "'" not in name and name not in ("t", "pi"))
            column = max(written.given.find(unknown[0]), 0)
            raise ExpressionError(
                f"unknown {'name' if len(unknown) == 1 else 'names'} {names}",
                column,
                f"the model has {known}",
                len(unknown[0]),
            )
        wrong = self._wrong(written, kind, case.value(written.difference, best.values), best.values)
        return replace(wrong, substitution=best.told)

    # -- what the solver of outputs answers ------------------------------------------------------------

    def _asked(self, written: HandEquation, kind: str, at: WrittenEquation | AtRest | None) -> Verdict:
        """At an instant, at rest, of small motions, of structures: by the solver of outputs."""
        case = self.case
        unknown = case.unknown_names(written)
        if unknown:
            raise ExpressionError(
                f"unknown name '{unknown[0]}'", max(written.given.find(unknown[0]), 0), length=len(unknown[0])
            )
        try:
            left, right = case.sides(written, at)
        except ExpressionError as error:
            if case.clash(written):
                return Verdict(
                    written.given, kind, WRONG, causes=(Cause("unit", error.what, quantity="the dimensions"),)
                )
            raise
        open_ = next((each for each in (left, right) if not each.answered), None)
        if open_ is not None:
            return Verdict(written.given, kind, UNDECIDED, reason=open_.message or "it has no value")
        exact = [case.exact(each) for each in (left, right)]
        if exact[0] is not None and exact[1] is not None:
            found = is_zero_everywhere(case.system, exact[0] - exact[1])
            if found.holds:
                return Verdict(written.given, kind, RIGHT)
        if left.value is not None and right.value is not None:
            apart, rounded = abs(left.value - right.value), _rounding(written)
            if rounded is not None and apart <= rounded:
                return Verdict(written.given, kind, RIGHT, f"the rounding of {written.right.text}")
            if apart <= COMPUTED * max(abs(left.value), abs(right.value), COMPUTED):
                return self._by_numbers(written, kind, at)
        return self._wrong_value(written, kind, left, right)

    def _by_numbers(self, written: HandEquation, kind: str, at: WrittenEquation | AtRest | None) -> Verdict:
        """Whether sides that are equal in numbers are so with other values of the parameters, too."""
        case, tried = self.case, 0
        parameters = case.model.parameters
        own = {name: part.value.literal for name, part in parameters.items() if part.value is not None}
        for shares in ((1.07, 0.95, 1.02), (0.94, 1.05, 0.99)):
            values = {
                n: float(x) * shares[k % 3] * (1 + k / 300) for k, (n, x) in enumerate(own.items()) if x is not None
            }
            try:
                left, right = Case(with_values(case.model, values).model, case.at_rest).sides(written, at)
            except EomgenError:
                continue
            if left.value is None or right.value is None:
                continue
            if abs(left.value - right.value) > COMPUTED * max(abs(left.value), abs(right.value), COMPUTED):
                text = "it holds with the values of the file alone, and not with others"
                return Verdict(written.given, kind, WRONG, causes=(Cause("other", text, quantity="the value"),))
            tried += 1
        if not tried:
            return Verdict(
                written.given, kind, UNDECIDED, reason="in numbers the sides are equal; no exact form says so"
            )
        return Verdict(written.given, kind, RIGHT, f"numbers, at {tried + 1} sets of values of the parameters")

    def _wrong_value(self, written: HandEquation, kind: str, left: Answer, right: Answer) -> Verdict:
        """Both sides have values, and these differ."""
        case = self.case
        exact = [case.exact(each) for each in (left, right)]
        difference = f"{left.value - right.value:.6g}" if left.value is not None and right.value is not None else ""
        if exact[0] is not None and exact[1] is not None:
            difference = excess(case, exact[0] - exact[1]) or difference
        cause = Cause("other", f"the left side minus the right side is {difference} there", quantity="the value")
        if left.value and right.value is not None:
            ratio = right.value / left.value
            for name, (number, what) in _RATIOS.items():
                if abs(ratio - number) <= COMPUTED * abs(number):
                    quantity = "the sign" if what == "sign" else "the factor"
                    cause = Cause(what, f"the right side is {name} times the left one", quantity=quantity)
                    break
        if left.exact is not None and len(left.exact) <= LONG and len(written.left.code) == 1:
            cause = replace(cause, text=f"{cause.text}; it is {written.left.text} = {left.exact}")
        if clash := case.clash(written):
            cause = replace(cause, text=f"{cause.text} ({clash})")
        return Verdict(written.given, kind, WRONG, difference=difference, causes=(cause,))

    # -- wrong ---------------------------------------------------------------------------------------

    def _wrong(self, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None = None) -> Verdict:
        """Why an equation is wrong; or that another way to count a coordinate makes it right."""
        case = self.case
        _, what = self._decided(scalar, kind)
        if what == "identity":
            text = "it holds whatever the system does: an equation of motion it is not"
            return Verdict(written.given, kind, WRONG, causes=(Cause("other", text, quantity="what is equated"),))
        if what == "constant":
            (start,) = substituted((scalar,), case.start)
            value = excess(case, start)
            text = f"it stays constant along the motion, but it is {value} at the start, and not 0"
            cause = Cause("other", text, quantity="the constant")
            return Verdict(written.given, kind, WRONG, difference=value, causes=(cause,))
        left = self._without_reactions(written, kind, also)
        if left is not None:
            return left
        target = self._target(written, kind, scalar, also)
        found = target.explained() if target is not None else []
        turned = None
        if not found or len(found[0].shares) > 1 or found[0].cost >= FAR_FETCHED:
            turned = None if also else self._turned(written, kind)
        if turned is not None:
            return turned
        if found and target is not None:
            causes = causes_of(case, found, moving=kind in ("motion", "acceleration", "reaction", "law"))
            return Verdict(written.given, kind, WRONG, difference=target.difference(found[0]), causes=causes)
        difference, touched = target.unexplained() if target is not None else (excess(case, scalar), "")
        text = f"the sides differ by {difference}" if difference else "the sides differ"
        return Verdict(
            written.given,
            kind,
            WRONG,
            difference=difference,
            causes=(Cause("other", f"{text}{touched}", term=difference),),
        )

    def _turned(self, written: HandEquation, kind: str) -> Verdict | None:
        """Right where coordinates are counted from elsewhere, all of them in the same way."""
        case = self.case
        for renaming in turnings(case, written):
            holds, up_to = self._decided(case.value(written.difference, renaming.values), kind)
            if holds:
                return Verdict(written.given, kind, RIGHT, up_to, renaming.told)
        return None

    def _without_reactions(self, written: HandEquation, kind: str, also: Meanings | None) -> Verdict | None:
        """Right without the reactions that stand in it: these are left in."""
        from eomgen.judge.kinds import FUNCTION_KINDS

        case = self.case
        asked = {call for call in written.calls if FUNCTION_KINDS.get(call.name) == "reaction"}
        lam = case.system.symbols.lam
        if kind != "motion" or not (asked or lam):
            return None
        if asked:
            names = {**case.system.scope.names, **(also or {})}
            found = written.difference.evaluate(names, lambda call: 0 if call in asked else case.called(call))
            told = ", ".join(map(str, asked))
        else:
            return None
        if not self._decided(found, kind)[0]:
            return None
        cause = Cause("constraint_force", _left_in(told), told, force=told, quantity=told)
        return Verdict(written.given, kind, WRONG, difference=told, causes=(cause,))

    def _target(self, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None) -> Comparison | None:
        """What an equation is compared with."""
        case = self.case
        if kind == "motion" or (kind == "law" and not written.calls):
            return Comparison(case, scalar, case.rows, "motion") if case.rows else None
        calls = set(written.calls)
        if len(calls) != 1:
            return Comparison(case, scalar, (0,), "") if calls else None
        (call,) = calls
        symbol = case.system.scope.graph.symbol(f"({call})")
        left = written.difference.evaluate({**case.system.scope.names, **(also or {})}, lambda _: symbol)
        slope = derivative(left, symbol)
        if depends_on(slope, (symbol,)) or is_zero(slope):
            return None
        (rest,) = substituted((left,), {symbol: 0})
        author, true = over(-rest, slope), case.called(call)
        of = tuple(x.name for x in call.args if isinstance(x, Reference))
        return Comparison(case, author - true, (true,), _WHAT.get(call.name, ""), call, of)


FAR_FETCHED = 16.0
_WHAT = {"kinetic_energy": "T", "potential_energy": "V", "generalized_force": "Q"}
_RATIOS = {
    "-1": (-1.0, "sign"),
    "2": (2.0, "factor"),
    "1/2": (0.5, "factor"),
    "1/(2*pi)": (0.5 / np.pi, "unit"),
    "2*pi": (2 * np.pi, "unit"),
    "180/pi": (180 / np.pi, "unit"),
    "pi/180": (np.pi / 180, "unit"),
    "1000": (1000.0, "unit"),
    "1/1000": (0.001, "unit"),
    "3": (3.0, "factor"),
    "1/3": (1 / 3, "factor"),
    "4": (4.0, "factor"),
    "1/4": (0.25, "factor"),
}


def _static(case: Case) -> bool:
    """Whether unknown loads hold the model at rest."""
    return bool(case.model.unknowns)


def _left_in(force: str) -> str:
    return f"the force {force} of a constraint is left in: it does no work along the coordinate, and must drop out"


def _instant(case: Case, at: Any) -> WrittenEquation | AtRest | None:
    if at is None or isinstance(at, (WrittenEquation, AtRest)):
        return at
    if str(at).strip() == AtRest.text:
        return AtRest()
    try:
        return equation_typed(case.model, str(at))[0]
    except ExpressionError as error:
        raise UsageError(f"at {at}: {error.what}", mend=error.mend or 'write "theta = pi/2"') from error


def _rounding(written: HandEquation) -> float | None:
    """Half of the last digit of a side that is a decimal number; None where none is."""
    found = re.fullmatch(r"\s*[-+]?\d+\.(\d+)\s*", written.right.text)
    return None if found is None else 0.5000001 * 10.0 ** -len(found[1])
