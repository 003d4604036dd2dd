"""The verdict on one equation, and the kind of the equation.

What the judge says of one equation: right, wrong or undecided, up to what, and why.
"""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

from eomgen.frozen import dataclass
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import Explanation, Share
from eomgen.judge.reading import MULTIPLIER, HandEquation
from eomgen.judge.terms import FEW, short_text
from eomgen.model import FUNCTIONS, Model, OutputSource
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Fraction,
    Reference,
    Scalar,
    depends_on,
    is_zero,
    over,
    substituted,
)

if TYPE_CHECKING:
    from eomgen.judge.case import Case


RIGHT, WRONG, UNDECIDED = "right", "wrong", "undecided"
EXIT_CODES = {RIGHT: 0, WRONG: 5, UNDECIDED: 3}
UNREADABLE = 2  # an equation that cannot be read, or whose names mean nothing
LEVELS = (1, 2, 3)


@dataclass(frozen=True)
class Cause:
    """One mistake.

    Args:
        kind: missing_term, extra_term, sign, factor, wrong_axis, wrong_point, coriolis, constraint_force, unit,
            wrong_quantity (another one in its place), approximation, wrong_formula; other: unexplained.
        text: the sentence.
        term: what it concerns, as a formula, "".
        body, force: whose it is, "".
        quantity: what it concerns, in words: for a hint that does not tell all.
        others: kinds that would explain it as well.
        or_else: another sentence that would, and is believed nearly as readily; "".
    """

    kind: str
    text: str
    term: str = ""
    body: str = ""
    force: str = ""
    quantity: str = ""
    others: tuple[str, ...] = ()
    or_else: str = ""

    def as_dict(self) -> dict[str, Any]:
        return {
            "kind": self.kind,
            "term": self.term or None,
            "body": self.body or None,
            "force": self.force or None,
            "text": self.text,
            "other_kinds": list(self.others),
            "or_else": self.or_else or None,
        }

    @property
    def lines(self) -> tuple[str, ...]:
        """The sentence, and the other one."""
        return (self.text, f"or else: {self.or_else}") if self.or_else else (self.text,)

    def hint(self, level: int) -> str:
        """1: where to look; 2: which quantity; 3: all of it."""
        if level >= 3:
            return " ".join(self.lines)
        place = self.body or self.force
        if level == 2:
            return (
                f"Look at {self.quantity or 'the terms'}{f', {place}' if place and place not in self.quantity else ''}."
            )
        return f"Look at {place}." if place else f"Look at {AREAS.get(self.kind, 'the terms one by one')}."


FIRST_ORDER = "first order"
AREAS = {
    "sign": "the signs",
    "factor": "the numbers before the terms",
    "missing_term": "what may be missing",
    "extra_term": "what there is too much",
    "wrong_axis": "the angles, and from where they are counted",
    "wrong_point": "the points: where things act and turn",
    "coriolis": "the products of speeds",
    "constraint_force": "which forces do work",
    "unit": "the units",
    "wrong_quantity": "which quantity stands where",
    "approximation": "what is taken as small",
    "wrong_formula": "which formula holds here",
}


@dataclass(frozen=True, repr=False)
class Verdict:
    """The verdict on one equation.

    Args:
        given: as it was written.
        kind: motion, energy, force, reaction, velocity, acceleration, inertia, frequency, equilibrium, statics, law,
            impact.
        verdict: "right", "wrong" or "undecided".
        up_to: what had to be used to see that it is right, in words; of what is wrong in some pieces of the model
            alone, in which it is right: "while y >= 0"; "" where nothing.
        substitution: what names had to be replaced by, {theta: "phi - pi/2"}.
        difference: left minus right that is too much, in the names of the model; "".
        causes: why it is wrong.
        reason: why it is undecided, in words.
        unknown: names in it that mean nothing; where there are some it is undecided.
        parts: of a chain or a matrix the verdicts on its equations, up to the first that is not right.
    """

    given: str
    kind: str
    verdict: str
    up_to: str = ""
    substitution: Mapping[str, str] = field(default_factory=dict)
    difference: str = ""
    causes: tuple[Cause, ...] = ()
    reason: str = ""
    unknown: tuple[str, ...] = ()
    parts: tuple[Verdict, ...] = ()

    def __bool__(self) -> bool:
        return self.verdict == RIGHT

    def __repr__(self) -> str:
        return "\n".join(self.lines())

    def _repr_html_(self) -> str:
        """The text of the command line, as HTML."""
        return f"<pre>{html.escape(repr(self))}</pre>"

    @property
    def exit_code(self) -> int:
        return UNREADABLE if self.unknown else EXIT_CODES[self.verdict]

    def in_letters(self, letters: Mapping[str, str]) -> Verdict:
        """The same, functions by the letters that the author has for them: N_B for reaction_n(B).

        Where a letter does not say of what it is, the first in a sentence does: the tension S (cable).
        """

        def reported(text: str) -> str:
            for function, letter in letters.items():
                of = "" if "/" in letter else function.partition("(")[2].removesuffix(")")
                whole = letter if of in letter else f"{letter} ({of})"
                text = text.replace(f" {function}", f" {whole}", 1).replace(function, letter)
            return text

        causes = (
            replace(x, text=reported(x.text), term=reported(x.term), or_else=reported(x.or_else)) for x in self.causes
        )
        causes = (replace(x, quantity=reported(x.quantity)) for x in causes)
        return replace(self, difference=reported(self.difference), causes=tuple(causes)) if letters else self

    def hint(self, level: int = 3) -> str:
        """Help for the author: 1 where to look, 2 at which quantity, 3 the cause."""
        return " ".join(dict.fromkeys(cause.hint(level) for cause in self.causes))

    def as_dict(self, hint: int | None = None) -> dict[str, Any]:
        """The verdict for machines; with a hint only what that level says."""
        reported = {
            "given": self.given,
            "kind": self.kind,
            "verdict": self.verdict,
            "up_to": [self.up_to] if self.up_to else [],
            "substitution": dict(self.substitution) or None,
            "difference": self.difference or None,
            "causes": [cause.as_dict() for cause in self.causes],
            "hint": self.hint(hint or 3) or None,
        }
        if hint is not None and hint < 3 and self.verdict == WRONG:
            reported |= {"difference": None, "causes": []}
        more: dict[str, Any] = {"unknown": list(self.unknown)} if self.unknown else {}
        return reported | more | ({"reason": self.reason} if self.reason else {})

    def lines(self, hint: int | None = None) -> tuple[str, ...]:
        """The verdict as lines of text."""
        found = [f"{self.verdict}: {self.given}"]
        if self.verdict == WRONG and self.up_to.startswith(FIRST_ORDER):
            found = [f"right to {self.up_to}: {self.given}", "    it is wrong of the whole motion:"]
        elif self.up_to:
            found.append(f"    {'right' if self.verdict == WRONG else 'up to'} {self.up_to}")
        found += [f"    with {name} = {value}" for name, value in self.substitution.items()]
        if self.reason:
            found.append(f"    {self.reason}")
        if hint is None or hint >= 3:
            found += [f"    {line}" for cause in self.causes for line in cause.lines]
            if self.difference:
                found.append(f"    too much on the left: {self.difference}")
        elif self.causes:
            found.append(f"    {self.hint(hint)}")
        return tuple(found)

    def __str__(self) -> str:
        return "\n".join(self.lines())


# -------- kinds -----------------------------------------------------------------------------------------------
# An equation -> what it is about: an equation of motion, an energy, a reaction, ... by what stands in it.


KINDS = (
    "motion",
    "energy",
    "force",
    "reaction",
    "velocity",
    "acceleration",
    "inertia",
    "frequency",
    "equilibrium",
    "statics",
    "law",
    "impact",
)
IMPACT = KINDS[-1]
_OF = {
    **dict.fromkeys(("kinetic_energy", "potential_energy", "power"), "energy"),
    "generalized_force": "force",
    **dict.fromkeys(("ax", "ay", "az", "acceleration", "tangential_acceleration"), "acceleration"),
    **dict.fromkeys(("normal_acceleration", "curvature_radius"), "acceleration"),
    **dict.fromkeys(("epsilon", "epsilon_x", "epsilon_y", "epsilon_z"), "acceleration"),
}
_BY_SOURCE = {OutputSource.BALANCE: "reaction", OutputSource.MASSES: "inertia", OutputSource.SMALL_MOTIONS: "frequency"}
FUNCTION_KINDS = {
    name: _OF.get(name) or _BY_SOURCE.get(function.source) or "velocity" for name, function in FUNCTIONS.items()
}


def kind_of_equation(written: HandEquation, model: Model) -> str:
    """The kind of an equation: what it is about."""
    names = written.names
    speeds = {f"{name}'" for name in model.speeds}
    accelerated = written.takes_rates or any(name.endswith("''") or name in speeds for name in names)
    if any(call.name == "frequency" for call in written.left.calls):
        return "frequency"
    alone = written.left.code[0] if len(written.left.code) == 1 else None
    if alone is not None and alone[0] == "call":
        return _of_call(alone[1].name, model)
    if accelerated:
        return "motion"
    for call in written.calls:
        if call.name == MULTIPLIER:
            return "motion"
        return _of_call(call.name, model)
    if not model.coordinates or names & model.unknowns.keys():
        return "statics"
    moving = any(name.endswith("'") or name in model.speeds for name in names)
    if moving or "t" in names:
        return "law"
    return "equilibrium"


def _of_call(name: str, model: Model) -> str:
    kind = FUNCTION_KINDS.get(name, "velocity")
    return "statics" if kind == "reaction" and not model.coordinates else kind


# -------- causes ----------------------------------------------------------------------------------------------
# An explanation -> its causes, in sentences.


def causes_of(case: Case, found: Sequence[Explanation], *, moving: bool, rooted: bool = False) -> tuple[Cause, ...]:
    """The causes of the first explanation; the kinds of others with as many mistakes beside them.

    Args:
        moving: it is about accelerations: products of two speeds are Coriolis terms.
        rooted: what is compared is the square of what was requested.
    """
    found = [each for each in found if not _replaces_by_itself(case, each)]
    if not found:
        return ()
    best = found[0]
    causes = _joined(case, best, [cause_of(case, share, best.row, moving=moving) for share in best.shares])
    others = [e for e in found[1:] if len(e.shares) == len(best.shares)]
    if len(causes) == 1:
        also = [cause_of(case, e.shares[0], e.row, moving=moving) for e in others]
        kinds = dict.fromkeys(x.kind for x in also)
        another = next((x for x in also if _is_another(causes[0], x)), None)
        causes[0] = replace(
            causes[0],
            others=tuple(kind for kind in kinds if kind != causes[0].kind),
            or_else="" if another is None else another.text,
        )
    return tuple(replace(x, text=f"under the root {x.text}") for x in causes) if rooted else tuple(causes)


def _is_another(one: Cause, other: Cause) -> bool:
    """True if two causes are of different things, not two sentences of one."""
    ends = {x.text.rpartition(", ")[2] for x in (one, other)}  # "is missing"
    return one.kind != other.kind and one.quantity != other.quantity and len(ends) == 2


def _joined(case: Case, found: Explanation, causes: list[Cause]) -> list[Cause]:
    """The causes; what is missing and what stands there in its place as one."""
    swapped = _swapped(found)
    if swapped is None:
        return causes
    k, j = swapped
    rows = found.shares[k].mistake.rows
    ratio = (
        over(found.shares[j].mistake.rows[0], rows[max(found.row, 0)]) if not is_zero(rows[max(found.row, 0)]) else 0
    )
    symbols = case.system.symbols
    constant = not depends_on(
        case.edits.written((ratio,))[0],
        (symbols.t, *symbols.x, *case.forced),
    )
    name, term = causes[k].quantity, causes[k].term
    what = f"{name}, {term}," if term and term not in name else name
    stands = _standing(found, j)
    text = f"{what} stands there as {short_text(stands, case.system.scope.positive)}"
    joined = replace(causes[k], kind="factor" if constant else "wrong_quantity", text=text)
    return [joined if i == k else cause for i, cause in enumerate(causes) if i != j]


def _swapped(found: Explanation) -> tuple[int, int] | None:
    """(the share that is missing, the one that stands there in its place); None where there is no such pair."""
    gone = [k for k, share in enumerate(found.shares) if share.mistake.open and share.factor == 0 and not share.unit]
    extra = [k for k, share in enumerate(found.shares) if share.mistake.kind == "extra_term"]
    return (gone[0], extra[0]) if len(gone) == len(extra) == 1 else None


def _standing(found: Explanation, j: int) -> Scalar:
    """The term that stands in the equation beside what belongs there."""
    return found.shares[j].mistake.rows[0] * (-1 if found.scale == "opposite" else 1)


def _replaces_by_itself(case: Case, found: Explanation) -> bool:
    """True if what is missing and what stands in its place would read the same: that explains nothing."""
    swapped = _swapped(found)
    if swapped is None:
        return False
    k, j = swapped
    positive = case.system.scope.positive
    gone = found.shares[k].mistake.rows[max(found.row, 0)]
    return short_text(gone, positive) == short_text(_standing(found, j), positive) != ""


def cause_of(case: Case, share: Share, row: int, *, reported: bool = True, moving: bool = True) -> Cause:
    """The cause that one mistake is."""
    mistake, x = share.mistake, share.factor
    rows = (mistake.rows[row],) if row >= 0 else mistake.rows
    term = (
        next(filter(None, (short_text(x, case.system.scope.positive) for x in rows if not is_zero(x))), "")
        if reported
        else ""
    )
    kind, text = mistake.kind, mistake.text
    if mistake.open:
        whole = mistake.kind if moving else "factor"
        if moving and reported and whole == "factor" and _is_coriolis(case, rows):
            whole = "coriolis"
        speeds = whole == "coriolis" and mistake.name.startswith("all that holds speeds")
        name = "the Coriolis term" if speeds else mistake.name
        kind, text = _of_factor(whole, name, x, share.unit, term)
    body, force = mistake.body, mistake.force
    is_term = mistake.name.startswith(("the term ", "the product "))
    if reported and not body and not force and is_term:
        total = sum((x for x in rows if not is_zero(x)), start=0)
        held = case.parts.holding(total, FEW, "T" if depends_on(total, case.system.symbols.a) else "")
        if len(held) == 1:
            whose = f": it is a term of {held[0].name}" if kind == "extra_term" else f" ({held[0].name})"
            body, force, text = held[0].body, held[0].force, f"{text}{whose}"
    return Cause(kind, text, term, body, force, mistake.name)


def _of_factor(kind: str, name: str, x: Fraction, unit: str, term: str) -> tuple[str, str]:
    """(kind, sentence) of a contribution with a wrong factor."""
    what = f"{name}, {term}," if term and term not in name else name
    if unit:
        return "unit", f"{what} stands with the factor {unit}: a unit is not converted"
    if x == 0:
        return ("missing_term" if kind == "factor" else kind), f"{what} is missing"
    if x == -1:
        return ("sign" if kind == "factor" else kind), f"{what} has the wrong sign"
    if kind == "coriolis" and x == Fraction(1, 2):
        return kind, f"{what} is counted once, and stands there twice"
    wrong = "a minus sign and " if x < 0 else ""
    return kind, f"{what} stands with {wrong}the factor {abs(x)}, which does not belong there"


def _is_coriolis(case: Case, rows: Sequence[Scalar]) -> bool:
    """True if the rows are products of different speeds alone: nothing is left of them where only one moves."""
    symbols = case.system.symbols
    rows = case.edits.written(tuple(rows))
    if any(depends_on(x, case.forced) for x in rows) or not any(depends_on(x, symbols.u) for x in rows):
        return False
    alone = [x for u in symbols.u for x in substituted(tuple(rows), {w: 0 for w in symbols.u if w is not u})]
    return all(map(is_zero, alone)) or bool(is_zero_everywhere(case.system, *alone).holds)


def other_calls(case: Case, call: Call) -> Iterator[Call]:
    """The same function of other points, bodies or constraints, one argument changed."""
    model = case.model
    for k, argument in enumerate(call.args):
        if not isinstance(argument, Reference):
            number = argument.literal
            for other in (number - 1, number + 1) if isinstance(number, int) else ():
                yield replace(call, args=(*call.args[:k], Expression.number(other), *call.args[k + 1 :]))
            continue
        tables: list[Sequence[str]] = [
            tuple(model.named_points),
            tuple(model.bodies),
            tuple(model.constraints),
            tuple(model.coordinates),
        ]
        for names in tables:
            if argument.name not in names:
                continue
            for name in names:
                if name != argument.name:
                    yield replace(call, args=(*call.args[:k], Reference(name), *call.args[k + 1 :]))
