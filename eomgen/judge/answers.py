"""Both sides as the solver of outputs answers them -> Verdict: instants, rest, small motions, structures.

Sides are equal exactly, or in numbers at several sets of values of the parameters. A side that is a number alone speaks
of the values of the file, and is right if it is rounded rightly.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import chain

from eomgen.errors import DerivationError, EomgenError, ExpressionError
from eomgen.judge.balances import Balances, requests_reactions
from eomgen.judge.case import Case
from eomgen.judge.comparison import Comparison, excess
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import BELIEVED, PLAINEST
from eomgen.judge.fixes import Authored, Fixes
from eomgen.judge.implied import Instant, implied_by, implied_by_course, simplest_explanation
from eomgen.judge.reading import FREQUENCY, HandEquation
from eomgen.judge.terms import LONG, short_text, terms_of
from eomgen.judge.truth import Course, on_one_side, other_models, truth_of
from eomgen.judge.verdict import RIGHT, UNDECIDED, WRONG, Cause, Verdict, causes_of, kind_of_equation
from eomgen.judge.written_pages import WrittenNumber
from eomgen.model import Output, Unit, Valued
from eomgen.questions import Answer
from eomgen.symbolic.expression import (
    Expression,
    Node,
    Scalar,
    depends_on,
    derivative,
    is_zero,
    over,
    parse,
    substituted,
)
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import to_text

ROUNDED = 1.000001  # of half of the last digit: a number that was rounded lies within
SURE = PLAINEST + 0.5  # the cost of a mistake in a balance up to which nothing else is looked at


def requested(case: Case, written: HandEquation, kind: str, at: Instant) -> Verdict:
    """The verdict on an equation about an instant, rest, small motions or a structure."""
    if unknown := case.unknown_names(written):
        return of_unknown(case, written, kind, unknown)
    if kind == "frequency" and FREQUENCY.match(written.left.text):
        return _of_letter(case, written, at)
    return _answered(case, written, kind, at)


def of_output(case: Case, written: HandEquation, at: Instant) -> Verdict | None:
    """The verdict on an output of the file by its name, at the instant that the file says; None: it is none of these.

    A number is compared with the value there, of what has no instant with that at the start.
    """
    output = case.model.outputs.get(written.name)
    if at is not None:
        return None
    if output is not None and _is_its_answer(case, written, output):
        return Verdict(written.given, kind_of_equation(replace(written, left=output.value), case.model), RIGHT)
    number = written.measured
    if number is not None and (output is not None or (number.unit and len(written.left.code) == 1)):
        return _measured(case, written, number, output)
    if output is None or output.at is None or output.event is not None:
        return None
    placed = replace(case, at_rest=case.at_rest or output.from_ == "rest", side=output.side)
    meant = replace(written, left=output.value)
    return requested(placed, meant, kind_of_equation(meant, case.model), output.at)


def _is_its_answer(case: Case, written: HandEquation, output: Output) -> bool:
    """True if the right side is the exact answer to an output."""
    if written.right.calls or case.unknown_names(written)[1:]:
        return False
    with suppress(EomgenError):
        exact = case.exact(case.answer(output))
        return exact is not None and bool(is_zero_everywhere(case.system, exact - case.value(written.right)).holds)
    return False


def _measured(case: Case, written: HandEquation, number: WrittenNumber, output: Output | None) -> Verdict | None:
    """The verdict on a number: it is that of the output, or at the start; None: it is no output, and another number."""
    requests = output or Output(value=written.left)
    kind = kind_of_equation(replace(written, left=requests.value), case.model)
    try:
        answer = case.answer(requests)
    except EomgenError:
        return None
    if answer.value is None:
        reason = answer.message or "it has no value"
        return None if output is None else Verdict(written.given, kind, UNDECIDED, reason=reason)
    unit = Unit.parse(answer.unit or "1")
    value = answer.value * float(unit.factor) * math.pi**unit.pi_power
    where = "" if requests.at is not None or requests.from_ is not None else "its value at the start"
    fits = number.dimension in (None, unit.dimension)
    apart, noise = abs(value - number.value), tolerances.NINE_DIGITS * abs(value)
    if fits and apart <= max(number.half * ROUNDED, noise):
        rounding = f"the rounding of {written.given.rpartition('=')[2].strip()}" if apart > noise else ""
        return Verdict(written.given, kind, RIGHT, " and ".join(filter(None, (where, rounding))))
    if output is None:
        return None
    text = f"it is {written.name} = {answer.number}{' at the start' if where else ''}"
    if not fits:
        text = f"it is given in {number.unit}, and is in {answer.unit or 'no unit'}"
    cause = Cause("other" if fits else "unit", text, quantity="the value" if fits else "the unit")
    return Verdict(written.given, kind, WRONG, causes=(cause,))


def _of_letter(case: Case, written: HandEquation, at: Instant) -> Verdict:
    """Verdict on a frequency that is given by its letter: not everybody counts motions of the whole, of frequency 0."""
    call = next(what for kind, what in written.left.code if kind == "call")
    number, whole = int(call.args[0].text), _motions_of_the_whole(case, written, at)
    if not whole:
        return _answered(case, written, "frequency", at)
    reported = "the motions of the whole, whose frequency is 0, not counted"
    ways = [("", written), (reported, _with_frequency(written, number + whole))]
    verdicts = []
    for up_to, each in ways if number > whole else reversed(ways):
        verdicts.append(found := _answered(case, each, "frequency", at))
        if found:
            return replace(found, up_to=" and ".join(filter(None, (up_to, found.up_to))))
    return verdicts[0]


def _motions_of_the_whole(case: Case, written: HandEquation, at: Instant) -> int:
    """Number of frequencies that are 0."""
    call = next(what for kind, what in written.left.code if kind == "call")
    for whole in range(len(case.system.symbols.u)):
        numbered = replace(call, args=(Expression.number(whole + 1),))
        frequency = Expression(str(numbered), (("call", numbered),), (0,))
        (value, _) = case.sides(replace(written, left=frequency, right=frequency), at)
        exact = case.exact(value)
        if value.value != 0 if exact is None else not is_zero(exact):
            return whole
    return 0


def _with_frequency(written: HandEquation, number: int) -> HandEquation:
    """The same of another frequency."""
    numbered = Expression.number(number)
    code = tuple((kind, replace(x, args=(numbered,)) if kind == "call" else x) for kind, x in written.left.code)
    return replace(written, left=Expression(written.left.text, code, written.left.columns))


def _answered(case: Case, written: HandEquation, kind: str, at: Instant) -> Verdict:
    """The verdict by what the solver of outputs answers."""
    try:
        left, right = case.sides(written, at)
    except (ExpressionError, DerivationError) as error:
        clash, sides = case.clash(written), _one_by_one(case, written, at)
        if sides is not None:
            return _wrong(case, written, kind, at, *sides)
        if clash:
            return Verdict(written.given, kind, WRONG, causes=(Cause("unit", error.what, quantity="the dimensions"),))
        raise
    open_ = next((each for each in (left, right) if not each.answered), None)
    if open_ is not None:
        return Verdict(written.given, kind, UNDECIDED, reason=open_.message or "it has no value")
    exact = [case.exact(each) for each in (left, right)]
    if exact[0] is not None and exact[1] is not None and is_zero_everywhere(case.system, exact[0] - exact[1]).holds:
        return Verdict(written.given, kind, RIGHT)
    if left.value is not None and right.value is not None:
        apart, rounded = abs(left.value - right.value), _rounding(written)
        if rounded is not None and apart <= rounded:
            return Verdict(written.given, kind, RIGHT, f"the rounding of {written.right.text}")
        if apart <= tolerances.COMPUTED * max(abs(left.value), abs(right.value), tolerances.COMPUTED):
            if not written.right.names - {"pi"} and not written.right.calls:
                return Verdict(written.given, kind, RIGHT, "the values of the file")
            return _by_numbers(case, written, kind, at)
    return _wrong(case, written, kind, at, left, right)


def of_unknown(case: Case, written: HandEquation, kind: str, unknown: Sequence[str]) -> Verdict:
    """The verdict where names mean nothing: it is undecided."""
    names = ", ".join(f"'{name}'" for name in unknown)
    known = ", ".join(name for name in case.system.scope.names if not {"'", "("} & {*name} and name not in ("t", "pi"))
    reason = f"unknown {'name' if len(unknown) == 1 else 'names'} {names}; the model has {known}"
    return Verdict(written.given, kind, UNDECIDED, reason=reason, unknown=tuple(unknown))


def _one_by_one(case: Case, written: HandEquation, at: Instant) -> tuple[Answer, Answer] | None:
    """The answer on the left, and on the right a formula of parameters that has no value; None: it is none."""
    if written.right.calls or not written.right.names <= {*case.model.parameters, "pi"}:
        return None
    with suppress(EomgenError):
        left = case.sides(replace(written, right=written.left), at)[0]
        return left, Answer(unit=left.unit, exact=to_text(case.value(written.right)))
    return None


def _by_numbers(case: Case, written: HandEquation, kind: str, at: Instant) -> Verdict:
    """Verdict on sides that are equal in numbers: right if they are so with other values of the parameters, too."""
    tried = 0
    parts = case.model.parameters  # those that are formulas of others follow them
    own = {name: x for name, x in case.model.exact_parameters().items() if name in parts and not parts[name].formula}
    for shares in ((1.07, 0.95, 1.02), (0.94, 1.05, 0.99)):
        values = {n: float(x) * shares[k % 3] * (1 + k / 300) for k, (n, x) in enumerate(own.items())}
        try:
            left, right = replace(case, model=Valued.of(case.model, values).model).sides(written, at)
        except EomgenError:
            continue
        if left.value is None or right.value is None:
            continue
        if abs(left.value - right.value) > tolerances.COMPUTED * max(
            abs(left.value), abs(right.value), tolerances.COMPUTED
        ):
            text = "it holds with the values of the file alone, and not with others"
            return Verdict(written.given, kind, WRONG, causes=(Cause("other", text, quantity="the value"),))
        tried += 1
    if not tried:
        return Verdict(written.given, kind, UNDECIDED, reason="in numbers the sides are equal; no exact form says so")
    return Verdict(written.given, kind, RIGHT, f"numbers, at {tried + 1} sets of values of the parameters")


def _wrong(case: Case, written: HandEquation, kind: str, at: Instant, left: Answer, right: Answer) -> Verdict:
    """Both sides have values, and these differ: by what the author put into the equations, or in the answer itself."""
    difference = f"{left.value - right.value:.6g}" if left.value is not None and right.value is not None else ""
    causes: tuple[Cause, ...] = ()
    true = case.exact(left)
    fixes = [] if true is None or len(written.left.code) != 1 else [Fixes(Authored(case, written, kind, true=true))]
    place = _place(case, written, at) if kind == "statics" or requests_reactions(written) else None
    balances = (
        ()
        if place is None
        else tuple(Balances(case, written, finely, place) for finely in (False, True)[: 1 if place else 2])
    )
    edits = other_models(case, written, kind, at)
    implied = chain(balances[:1], implied_by(case, written, kind, at, left, right), balances[1:])
    target, found = simplest_explanation(implied, [*fixes, edits], at_once=SURE if balances else BELIEVED)
    clash = case.clash(written)
    if found and not (clash and len(found[0].shares) > 1):
        causes = causes_of(case, found, moving=False, rooted=isinstance(target, Comparison) and target.squared)
    elif clash:
        causes = (Cause("unit", clash, quantity="the dimensions"),)
    true, author = (case.exact(each) for each in (left, right))
    if true is not None and author is not None:
        difference = excess(case, true - author) or difference
    it_is = ""
    if left.exact is not None and len(left.exact) <= LONG and len(written.left.code) == 1:
        it_is = f"it is {written.left.text} = {left.exact}"
    if not causes:
        causes = (Cause("other", f"the left side minus the right side is {difference} there", quantity="the value"),)
    if it_is:
        causes = (*causes[:-1], replace(causes[-1], text=f"{causes[-1].text}; {it_is}"))
    return Verdict(written.given, kind, WRONG, difference=difference, causes=causes)


# -------- states ----------------------------------------------------------------------------------------------
# An equation for the rate of a state of first order -> what is wrong with it, term by term of the declared rate.


def of_wrong_course(case: Case, written: HandEquation, course: Course) -> Verdict:
    """The verdict on a course with which the equations of motion or the rate of a state do not hold, or the start."""
    rest = "" if course.holds else excess(case, course.left[0] if len(course.left) == 1 else 0)
    target = implied_by_course(case, course.known) if not course.holds else None
    found = simplest_explanation([target] if target is not None else [])[1]
    if found:
        causes = causes_of(case, found, moving=False)
    elif course.holds:
        text = f"the equations of motion hold with it, but at the start {_of_the_start(case, course)}"
        causes = (Cause("wrong_quantity", text, quantity="the start"),)
    else:
        law = f"the rate of {course.state}" if course.state else "the equation of motion"
        text = f"{law} does not hold with it" if course.state else "the equations of motion do not hold with it"
        text = f"{text}: put in, there is left {rest}" if rest else text
        causes = (Cause("other", text, quantity=law),)
    return Verdict(written.given, "law", WRONG, difference=rest, causes=causes)


def _of_the_start(case: Case, course: Course) -> str:
    """The differences at the start, in words: x is 0 there, and not x0."""
    reported, at = [], {case.system.symbols.t: 0}
    for x, value in course.known.items():
        if x in case.start and not x.name.endswith("''"):
            mine, own = substituted((value, case.start[x]), at)
            if not case.starts_at_zero(x - mine):
                texts = (short_text(y, case.system.scope.positive) or "another one" for y in (mine, own))
                reported.append("{} is {}, and not {}".format(x.name, *texts))
    return " and ".join(reported) or "it is another"


def of_state(case: Case, written: HandEquation, kind: str) -> Verdict | None:
    """The verdict on an equation for z'; None where it is right for other reasons, or about more than one such rate."""
    scope = case.system.scope
    asked = [z for z in scope.symbols.z if f"{z.name}'" in written.names]
    if len(asked) != 1 or case.unknown_names(written) or truth_of(case, case.value(written.difference), kind).holds:
        return None
    z, declared = asked[0], scope.names[f"{asked[0].name}'"]
    rate = z.graph.symbol(f"({z.name}')")  # no name of a model has parentheses
    scalar = case.value(written.difference, {f"{z.name}'": rate})
    slope, (rest,) = derivative(scalar, rate), substituted((scalar,), {rate: 0})
    accelerated = depends_on(scalar, scope.symbols.a) and not depends_on(declared, scope.symbols.a)
    if is_zero(slope) or depends_on(slope, (rate,)) or accelerated:
        return None
    apart = over(-rest, slope) - declared
    if (found := is_zero_everywhere(case.system, apart)).holds is not False:
        return Verdict(written.given, kind, RIGHT) if found.holds else None
    if one_side := on_one_side(case, written, "law", case.value(written.difference)):
        return Verdict(written.given, kind, RIGHT, up_to=one_side.up_to)
    difference = short_text(-apart, scope.positive)
    cause = next((x for x in _causes_of_state(case, z, declared, apart)), None)
    text = f"{z.name}' is another one: {short_text(declared, scope.positive)}"
    cause = cause or Cause("other", text, quantity=f"the rate of {z.name}")
    return Verdict(written.given, kind, WRONG, difference=difference, causes=(cause,))


def without_rate(case: Case, written: HandEquation, kind: str) -> Verdict | None:
    """The verdict on an equation of a state that leaves out its rate, i = U/R of L i' + R i + k theta' = U; None: it is
    no such: beside the rate at most one term of it is missing, or wrong.

    An equation e = 0 that is linear in z is Z/s - z'/s = 0 without z', s = Z_z/e_z.
    """
    system, scope = case.system, case.system.scope
    scalar = case.value(written.difference)
    if depends_on(scalar, system.symbols.a) or truth_of(case, scalar, kind).holds is not False:
        return None
    for z in (z for z in scope.symbols.z if depends_on(scalar, (z,))):
        declared = scope.names[f"{z.name}'"]
        own, slope = derivative(scalar, z), derivative(declared, z)
        if any(is_zero(x) or depends_on(x, system.symbols.x) for x in (own, slope)):
            continue
        s = over(slope, own)
        apart = s * scalar - declared
        zero = is_zero_everywhere(system, apart).holds
        more = [] if zero else list(_causes_of_state(case, z, declared, apart))[:1]
        if not zero and not more:
            continue
        left = over(-z.graph.symbol(f"{z.name}'"), s)
        shown, excess_left = (short_text(x, scope.positive) for x in (left, over(apart, s) - left))
        text = f"{shown} is missing: as it stands this holds only where {z.name} does not change"
        cause = Cause("missing_term", text, term=shown, quantity=f"the rate of {z.name}")
        return Verdict(written.given, kind, WRONG, difference=excess_left, causes=(cause, *more))
    return None


def _causes_of_state(case: Case, z: Node, declared: Scalar, apart: Scalar) -> Iterator[Cause]:
    """A term of the declared rate that is missing, or has another sign or factor; a term too much."""
    positive = case.system.scope.positive
    quantity = f"the rate of {z.name}"

    def vanishes(x: Scalar) -> bool:
        return is_zero_everywhere(case.system, x).holds is True

    terms = terms_of(declared, positive)
    ways = (("missing_term", -1, "is missing"), ("sign", -2, "has the other sign"))
    for kind, factor, what in ways:
        for term in terms:
            if vanishes(apart - factor * term):
                shown = short_text(term, positive)
                yield Cause(kind, f"the term {shown} of {quantity} {what}", term=shown, quantity=quantity)
    for term in terms:
        (ratio,) = case.edits.written((over(apart, term),))
        if type(ratio) is not Node:
            shown, words = short_text(term, positive), f"has the factor {to_text(ratio + 1)}"
            yield Cause("factor", f"the term {shown} of {quantity} {words}", term=shown, quantity=quantity)
    if len(extra := terms_of(apart, positive)) == 1:
        shown = short_text(extra[0], positive)
        yield Cause("extra_term", f"the term {shown} is too much in {quantity}", term=shown, quantity=quantity)


def _place(case: Case, written: HandEquation, at: Instant) -> dict[Node, Scalar] | None:
    """Coordinates, speeds, accelerations at an instant; {} without them; None where they have no closed form."""
    found = dict[Node, Scalar]()
    for x in case.system.symbols.x:
        with suppress(EomgenError):
            name = parse(x.name)
            value = case.exact(case.sides(replace(written, left=name, right=name), at)[0])
            found |= {} if value is None else {x: value}
        if x not in found:
            return None
    with suppress(EomgenError):
        return dict(case.phase.complete(found)) if found else {}
    return None


def _rounding(written: HandEquation) -> float | None:
    """Half of the last digit of a side that is a decimal number; None where none is."""
    found = re.fullmatch(r"\s*[-+]?\d+\.(\d+)\s*", written.right.text)
    return None if found is None else 0.5000001 * 10.0 ** -len(found[1])
