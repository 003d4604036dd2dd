"""Model, equation of somebody -> Verdict: right, up to what; wrong, and why; or undecided."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, EomgenError, ExpressionError, MissingValues, ModelError, RunFailed, UsageError
from eomgen.judge.case import Case
from eomgen.judge.causes import causes_of
from eomgen.judge.corruptions import Corruption, Corruptions, corrupted_terms
from eomgen.judge.decision import vanishes
from eomgen.judge.diagnosis import Explanation, Samples, Search, explained, samples_of
from eomgen.judge.kinds import KINDS, kind_of
from eomgen.judge.reading import Written
from eomgen.judge.renaming import Renaming, renamings, turnings
from eomgen.judge.verdict import RIGHT, UNDECIDED, WRONG, Cause, Verdict
from eomgen.model.fields import AtRest, WrittenEquation
from eomgen.model.reader import ModelOrPath, model_at
from eomgen.model.replaced import equation_typed
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import depends_on, derivative, gradient, substituted
from eomgen.symbolic.expression.expressions import Call, Expression
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED
from eomgen.symbolic.numeric.work import Work, doing
from eomgen.symbolic.print.text import readable_text

LONG = 400  # characters of a difference that is shown


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
        known = kind or kind_of(written, self.case.model)
        try:
            return self._judged(written, known, _instant(self.case, at))
        except (DerivationError, RunFailed, MissingValues) as error:
            return Verdict(written.given, known, UNDECIDED, reason=error.what)

    def _judged(self, written: Written, kind: str, at: WrittenEquation | AtRest | None) -> Verdict:
        case = self.case
        unknown = case.unknown_names(written)
        if not unknown:
            case.check(written)
        if at is None and kind == "equilibrium":
            at = AtRest()
            tie = self._decided(case.value(written.difference), "law") if not unknown else (False, "")
            if tie[0]:
                return Verdict(written.given, kind, RIGHT, tie[1])
        if at is not None or kind == "frequency" or (kind == "statics" and not unknown):
            return self._asked(written, kind, at)
        if unknown:
            return self._of_other_names(written, kind, unknown)
        if course := self._course(written):
            return course
        scalar = case.value(written.difference)
        return self._of_scalar(written, kind, scalar)

    def _of_scalar(self, written: Written, kind: str, scalar: Scalar) -> Verdict:
        """The verdict on an equation whose names are all known."""
        holds, up_to = self._decided(scalar, kind)
        if holds:
            return Verdict(written.given, kind, RIGHT, up_to)
        if holds is None:
            return Verdict(written.given, kind, UNDECIDED, reason=up_to or "no state of the model decides it")
        return self._wrong(written, kind, scalar)

    # -- right ------------------------------------------------------------------------------------

    def _decided(self, scalar: Scalar, kind: str) -> tuple[bool | None, str]:
        """(whether it is right, up to what)"""
        case = self.case
        found = vanishes(case.system, scalar)
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
        if case.speeds and depends_on(scalar, (*case.system.symbols.u, *case.forced)):
            (started,) = substituted((case.phase.eliminated(scalar),), case.speeds)
            if vanishes(case.system, started).holds:
                return True, "the energy theorem and the momenta from the start"
        return (None if undecided else False), ""

    def _is_constant_of_potential(self, scalar: Scalar) -> bool:
        symbols = self.case.system.symbols
        slopes = gradient(scalar, (symbols.t, *symbols.q, *symbols.u))
        return bool(vanishes(self.case.system, *slopes).holds)

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
        factor = legible(derivative(scalar, a) / below, Work.FORMULA, case.system.scope.positive, LONG)
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
        if constants or not case.motion.start:
            return True, "a first integral of the motion"
        (start,) = substituted((scalar,), case.motion.start)
        if vanishes(case.system, start).holds:
            return True, "the first integral from the start"
        return False, "constant"

    def _course(self, written: Written) -> Verdict | None:
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
        start = substituted((q - course, scope.names[f"{name}'"] - rate), {**case.motion.start, symbols.t: 0})
        begins = not case.motion.start or vanishes(case.system, *start).holds
        others = [x for x in (*symbols.q, *symbols.u) if x not in known]
        left = substituted(case.rows, known)
        mine = [row for row in left if not depends_on(row, (*others, *case.forced))]
        inputs = {node: case.system.inputs[n] for n, node in symbols.inputs.items()}
        found = vanishes(case.system, *substituted(tuple(mine), inputs)) if mine else None
        if found is None or found.holds is None:
            return Verdict(written.given, "law", UNDECIDED, reason="the equations of motion do not decide it alone")
        if found.holds and begins:
            return Verdict(written.given, "law", RIGHT, "the motion from the start")
        what = "the equations of motion do not hold with it" if not found.holds else "the start is another one"
        rest = "" if found.holds else _shown(case, mine[0] if len(mine) == 1 else 0)
        cause = Cause("other", f"{what}: put in, there is left {rest}" if rest else what, quantity="the start" if found.holds else "the equation of motion")
        return Verdict(written.given, "law", WRONG, difference=rest, causes=(cause,))

    # -- other names ---------------------------------------------------------------------------------

    def _of_other_names(self, written: Written, kind: str, unknown: list[str]) -> Verdict:
        """Of an equation with names that the model does not have: renamed, constants, or forces of constraints."""
        case = self.case
        for renaming in renamings(case, written, unknown):
            holds, up_to = self._decided(case.value(written.difference, renaming.values), kind)
            if holds:
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
                    return Verdict(written.given, kind, RIGHT, f"a first integral of the motion, with {', '.join(unknown)} constant")
            without = {name: 0 for name in unknown}
            if kind == "motion" and not any(f"{name}'" in written.names for name in unknown):
                rest = substituted((scalar,), {free[name]: 0 for name in without})[0]
                if self._decided(rest, kind)[0]:
                    told = " and ".join(unknown)
                    term = _shown(case, scalar - rest).replace("(", "").replace(")", "") if False else told
                    text = f"the force {told} of a constraint is left in: it does no virtual work along the coordinate, and must drop out"
                    cause = Cause("constraint_force", text, term, quantity=f"the force {told}")
                    return Verdict(written.given, kind, WRONG, difference=told, causes=(cause,))
        best = next(iter(renamings(case, written, unknown)), None)
        if best is None:
            names = ", ".join(f"'{name}'" for name in unknown)
            known = ", ".join(name for name in case.system.scope.names if "'" not in name and name not in ("t", "pi"))
            column = max(written.given.find(unknown[0]), 0)
            raise ExpressionError(f"unknown {'name' if len(unknown) == 1 else 'names'} {names}", column, f"the model has {known}", len(unknown[0]))
        wrong = self._wrong(written, kind, case.value(written.difference, best.values))
        return replace(wrong, substitution=best.told)

    # -- what the solver of outputs answers ------------------------------------------------------------

    def _asked(self, written: Written, kind: str, at: WrittenEquation | AtRest | None) -> Verdict:
        """At an instant, at rest, of small motions, of structures: what the solver of outputs says of the difference."""
        case = self.case
        unknown = case.unknown_names(written)
        if unknown:
            raise ExpressionError(f"unknown name '{unknown[0]}'", max(written.given.find(unknown[0]), 0), length=len(unknown[0]))
        found = case.answer(written.difference, at)
        if not found.answered:
            return Verdict(written.given, kind, UNDECIDED, reason=found.message or "it has no value")
        if found.exact == "0":
            return Verdict(written.given, kind, RIGHT)
        size = self._size(written, at)
        rounded = _rounding(written)
        if found.value is not None and rounded is not None and abs(found.value) <= rounded:
            return Verdict(written.given, kind, RIGHT, f"the rounding of {written.right.text}")
        if found.value is not None and abs(found.value) <= COMPUTED * max(size, COMPUTED):
            return self._by_numbers(written, kind, at)
        return self._wrong_value(written, kind, at, found.exact or f"{found.value:.6g}")

    def _size(self, written: Written, at: WrittenEquation | AtRest | None) -> float:
        values = [self.case.answer(side, at).value for side in (written.left, written.right)]
        return max((abs(x) for x in values if x is not None), default=1.0)

    def _by_numbers(self, written: Written, kind: str, at: WrittenEquation | AtRest | None) -> Verdict:
        """Whether a difference that is 0 in numbers is so with other values of the parameters, too."""
        from eomgen.model.replaced import with_values
        from eomgen.model.values import exact_parameters

        case = self.case
        own = {name: float(x) for name, x in exact_parameters(case.model).items() if case.model.parameters[name].value is not None}
        own = {name: x for name, x in own.items() if case.model.parameters[name].value.literal is not None}  # type: ignore[union-attr]
        tried = 0
        for shares in ((1.07, 0.95, 1.02), (0.94, 1.05, 0.99)):
            values = {name: x * shares[k % 3] * (1 + 0.003 * k) for k, (name, x) in enumerate(own.items())}
            try:
                other = Case(with_values(case.model, values).model, case.at_rest)
                found = other.answer(written.difference, at)
                size = max(abs(other.answer(side, at).value or 0.0) for side in (written.left, written.right))
            except EomgenError:
                continue
            if found.value is None:
                continue
            if abs(found.value) > COMPUTED * max(size, COMPUTED):
                return Verdict(written.given, kind, WRONG, causes=(Cause("other", "it holds with the values of the file alone, and not with others"),))
            tried += 1
        if not tried:
            return Verdict(written.given, kind, UNDECIDED, reason="in numbers the sides are equal; no exact form says so")
        return Verdict(written.given, kind, RIGHT, f"numbers, at {tried + 1} sets of values of the parameters")

    def _wrong_value(self, written: Written, kind: str, at: WrittenEquation | AtRest | None, difference: str) -> Verdict:
        case = self.case
        cause = Cause("other", f"the left side minus the right side is {difference} there", quantity="the value")
        left, right = (case.answer(side, at) for side in (written.left, written.right))
        if left.value and right.value is not None:
            ratio = right.value / left.value
            for name, (number, what) in _RATIOS.items():
                if abs(ratio - number) <= COMPUTED * abs(number):
                    cause = Cause(what, f"the right side is {name} times the left one", quantity="its factor" if what != "sign" else "its sign")
                    break
        if left.exact is not None and len(left.exact) <= LONG:
            cause = replace(cause, text=f"{cause.text}; it is {written.left.text} = {left.exact}")
        return Verdict(written.given, kind, WRONG, difference=difference, causes=(cause,))

    # -- wrong ---------------------------------------------------------------------------------------

    def _wrong(self, written: Written, kind: str, scalar: Scalar) -> Verdict:
        """Why an equation is wrong; or that another way to count a coordinate makes it right."""
        case = self.case
        holds, what = self._decided(scalar, kind)
        if what == "identity":
            text = "it holds whatever the system does: an equation of motion it is not"
            return Verdict(written.given, kind, WRONG, causes=(Cause("other", text, quantity="what is equated"),))
        if what == "constant":
            (start,) = substituted((scalar,), case.motion.start)
            shown = _shown(case, start)
            text = f"it stays constant along the motion, but it is {shown} at the start, and not 0"
            return Verdict(written.given, kind, WRONG, difference=shown, causes=(Cause("other", text, quantity="the constant"),))
        left = self._without_reactions(written, kind)
        if left is not None:
            return left
        target = self._target(written, kind, scalar)
        found = target.explained() if target is not None else []
        turned = None
        if not found or len(found[0].shares) > 1 or found[0].cost >= FAR_FETCHED:
            turned = self._turned(written, kind)
        if turned is not None:
            return turned
        if found and target is not None:
            causes = causes_of(case, target.rows, found)
            return Verdict(written.given, kind, WRONG, difference=target.difference(found[0]), causes=causes)
        difference, touched = target.unexplained() if target is not None else (_shown(case, scalar), "")
        text = f"the sides differ by {difference}" if difference else "the sides differ"
        return Verdict(written.given, kind, WRONG, difference=difference, causes=(Cause("other", f"{text}{touched}", term=difference),))

    def _turned(self, written: Written, kind: str) -> Verdict | None:
        """Right where coordinates are counted from elsewhere, all of them in the same way."""
        case = self.case
        for renaming in turnings(case, written):
            holds, up_to = self._decided(case.value(written.difference, renaming.values), kind)
            if holds:
                return Verdict(written.given, kind, RIGHT, up_to, renaming.told)
        return None

    def _without_reactions(self, written: Written, kind: str) -> Verdict | None:
        """Right without the reactions that stand in it: these are left in."""
        from eomgen.judge.kinds import FUNCTION_KINDS

        case = self.case
        asked = {call for call in written.calls if FUNCTION_KINDS.get(call.name) == "reaction"}
        lam = case.system.symbols.lam
        if kind != "motion" or not (asked or lam):
            return None
        if asked:
            found = written.difference.evaluate(case.system.scope.names, lambda call: 0 if call in asked else case._called(call))
            told = ", ".join(map(str, asked))
        else:
            return None
        if not self._decided(found, kind)[0]:
            return None
        text = f"the force of a constraint is left in, {told}: it does no virtual work along the coordinate, and must drop out"
        cause = Cause("constraint_force", text, told, force=told, quantity=told)
        return Verdict(written.given, kind, WRONG, difference=told, causes=(cause,))

    def _target(self, written: Written, kind: str, scalar: Scalar) -> Target | None:
        """What an equation is compared with."""
        case = self.case
        if kind == "motion":
            return Target(case, scalar, case.rows, "motion") if case.rows else None
        calls = set(written.calls)
        if len(calls) != 1:
            if kind == "law" and case.equations is not None:
                return None
            return Target(case, scalar, (0,), "") if calls else None
        (call,) = calls
        symbol = case.system.scope.graph.symbol(f"({call})")
        left = written.difference.evaluate(case.system.scope.names, lambda _: symbol)
        slope = derivative(left, symbol)
        if depends_on(slope, (symbol,)) or is_zero(slope):
            return None
        (rest,) = substituted((left,), {symbol: 0})
        author, true = -rest / slope, case._called(call)
        return Target(case, author - true, (true,), _WHAT.get(call.name, "") if not call.args else "", call)

    @cached_property
    def known(self) -> dict[str, Corruptions]:
        return {}


FAR_FETCHED = 13.0
_WHAT = {"kinetic_energy": "T", "potential_energy": "V"}
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


@dataclass(frozen=True)
class Target:
    """What an equation is compared with.

    Args:
        case: the model.
        scalar: of an equation of motion its left minus its right side; else what the author's value is too much.
        rows: the model's equations of motion; else its value alone.
        what: "motion", "T", "V", or "" of other values.
        call: what the value is of.
    """

    case: Case
    scalar: Scalar
    rows: tuple[Scalar, ...]
    what: str
    call: Call | None = None

    @cached_property
    def corruptions(self) -> tuple[Corruption, ...]:
        """What may be wrong, the most believable first."""
        system = self.case.system
        structural: list[Corruption] = []
        if self.what:
            structural += Corruptions(self.case.parts, self.what).all
        else:
            structural += self._other_arguments()
        if self.what != "motion":
            structural.append(Corruption("the whole", "factor", self.rows, 1))
        rates = frozenset((*system.symbols.u, *system.symbols.a))
        terms = corrupted_terms(self.rows, system.symbols.parameters.values(), system.scope.positive, rates)
        return (*structural, *sorted(terms, key=lambda each: each.rank))

    def _other_arguments(self) -> Iterator[Corruption]:
        """The same function of another point, body or tie."""
        from eomgen.judge.causes import other_calls

        assert self.call is not None or True
        for call in other_calls(self.case, self.call) if self.call is not None else ():
            try:
                other = self.case._called(call)
            except ExpressionError:
                continue
            text = f"it is {call} that stands there, and {self.call} that is asked"
            yield Corruption(str(self.call), "wrong_point", (other - self.rows[0],), 1, open=False, text=text)

    @cached_property
    def _samples(self) -> tuple[Samples, bool] | None:
        """States of the comparison, and whether they lie on ties."""
        case = self.case
        tied = bool(case.closing) and not depends_on(self.scalar, case.system.symbols.lam)
        flat = [self.scalar, *self.rows]
        found = samples_of(case.system, flat, on_ties=tied and self.what == "motion")
        return None if found is None else (found, tied)

    @cached_property
    def searches(self) -> tuple[Search, ...]:
        """The comparison with every equation, and with the combination that the author's accelerations make."""
        if self._samples is None:
            return ()
        samples, tied = self._samples
        known, n = self.corruptions, len(self.rows)
        flat = samples.of(self._moving([self.scalar, *self.rows, *(x for each in known for x in each.rows)]))
        D, E, C = flat[0], flat[1 : n + 1], flat[n + 1 :].reshape(len(known), n, *flat.shape[1:])
        if self.what != "motion":
            return (Search(None, -D, C[:, 0], known, 0),)
        found = [] if tied else [Search(D, E[k], C[:, k], known, k) for k in range(n)]
        if n > 1:
            mixed = self._mixed(samples)
            if mixed is not None:
                whole = np.einsum("kpv,kpv->pv", mixed, E)
                found.append(Search(D, whole, np.einsum("kpv,ckpv->cpv", mixed, C), known, -1))
        elif tied:
            found = [Search(D, E[0], C[:, 0], known, 0)]
        return tuple(found)

    def _moving(self, scalars: Sequence[Scalar]) -> Sequence[Scalar]:
        """The scalars; of potentials, which hold a free constant, their rates."""
        return self.case.system.scope.time_derivative(tuple(scalars)) if self.what == "V" else scalars

    def _mixed(self, samples: Samples) -> np.ndarray | None:
        """f with f M + h J = dD/da and f J^T = -dD/dlam: the combination whose accelerations are the author's."""
        e, case = self.case.equations, self.case
        assert e is not None
        slopes = gradient(self.scalar, case.forced)
        if any(depends_on(x, case.forced) for x in slopes):
            return None
        n, k = len(e.M), len(e.J)
        flat = samples.of([*slopes, *(x for row in e.M for x in row), *(x for row in e.J for x in row)])
        flat = flat.reshape(len(flat), -1)
        found = []
        for values in flat.T:
            M = values[n + k : n + k + n * n].reshape(n, n)
            J = values[n + k + n * n :].reshape(k, n)
            matrix = np.block([[M, -J.T], [J, np.zeros((k, k))]]) if k else M
            if not np.all(np.isfinite(values)):
                return None
            f, *_ = np.linalg.lstsq(matrix.T, values[: n + k], rcond=None)
            found.append(f[:n])
        sizes = np.abs(np.array(found))
        if not k and np.all(np.sort(sizes, axis=1)[:, :-1] < CARRIED * sizes.max(axis=1, keepdims=True)):
            return None  # it is one of the equations
        return np.array(found).T.reshape(n, samples.places, -1)

    def explained(self) -> list[Explanation]:
        return explained(self.searches, self.proves)

    def proves(self, explanation: Explanation) -> bool:
        """Whether the explanation makes the author's equation, exactly."""
        case = self.case
        added = [share.added(case.system.scope.graph.pi) for share in explanation.shares]
        if self.what != "motion":
            total = sum((x[0] for x in added), start=0)
            return bool(vanishes(case.system, *self._moving([self.scalar - total])).holds)
        rows = tuple(row + sum((x[k] for x in added), start=0) for k, row in enumerate(self.rows))
        return bool(case.follows(self.scalar, rows).holds)

    def difference(self, explanation: Explanation) -> str:
        """What is too much in the equation, as it stands in the model's own."""
        added = [share.added(self.case.system.scope.graph.pi) for share in explanation.shares]
        rows = [sum(column, start=0) for column in zip(*added, strict=True)]
        shown = rows[explanation.row] if explanation.row >= 0 else next((x for x in rows if not is_zero(x)), 0)
        return _shown(self.case, shown)

    def unexplained(self) -> tuple[str, str]:
        """(the difference, what it touches), where nothing explains it."""
        case = self.case
        if self.what != "motion" or not self.searches:
            return _shown(case, self.scalar), ""
        best = min(self.searches, key=lambda search: _misfit(search))
        if best.row < 0:
            return _shown(case, case.phase.eliminated(self.scalar)), ""
        row = self.rows[best.row]
        a = next((x for x in case.system.symbols.a if depends_on(row, (x,))), None)
        name = case.system.symbols.u[best.row].name.removesuffix("'")
        if a is None or is_zero(derivative(self.scalar, a)):
            return _shown(case, self.scalar), f" (beside the equation of {name})"
        factor = legible(derivative(self.scalar, a) / derivative(row, a), Work.FORMULA, case.system.scope.positive, LONG)
        return _shown(case, self.scalar - factor * row), f", beside the equation of {name}{_touched(self, best)}"


def _misfit(search: Search) -> float:
    left, *_ = search._projection
    return float(np.linalg.norm(left)) if np.all(np.isfinite(left)) else float("inf")


def _touched(target: Target, search: Search) -> str:
    """The contributions that lie nearest to what is left."""
    left, A, kept = search._projection
    with np.errstate(all="ignore"):
        along = np.abs(A @ left) / max(float(np.linalg.norm(left)), COMPUTED)
    named = [(float(along[i]), search.corruptions[kept[i]]) for i in range(len(kept)) if search.corruptions[kept[i]].open]
    best = sorted((x for x in named if x[0] > 0.5), key=lambda x: -x[0])[:2]
    return f"; it lies nearest to {' and '.join(each.name for _, each in best)}" if best else ""


def _shown(case: Case, scalar: Scalar) -> str:
    """A difference as a text; "" where nobody would read it."""
    form = legible(scalar, Work.ANSWER, case.system.scope.positive, LONG)
    return readable_text(form) or ""


def _instant(case: Case, at: Any) -> WrittenEquation | AtRest | None:
    if at is None or isinstance(at, (WrittenEquation, AtRest)):
        return at
    if str(at).strip() == AtRest.text:
        return AtRest()
    try:
        return equation_typed(case.model, str(at))[0]
    except ExpressionError as error:
        raise UsageError(f"at {at}: {error.what}", mend=error.mend or 'write "theta = pi/2"') from error


def _rounding(written: Written) -> float | None:
    """Half of the last digit of a side that is a decimal number; None where none is."""
    found = re.fullmatch(r"\s*[-+]?\d+\.(\d+)\s*", written.right.text)
    return None if found is None else 0.5000001 * 10.0 ** -len(found[1])


__all__ = ["Judge", "Renaming", "verify"]
_: tuple[Any, ...] = (Expression, Mapping, ModelError)
