"""Model, equation of somebody -> Verdict: right, up to what; wrong, and why; or undecided."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

from eomgen.errors import DerivationError, EomgenError, ExpressionError, MissingValues, RunFailed, UsageError
from eomgen.frozen import dataclass
from eomgen.judge.answers import of_output, of_state, of_unknown, of_wrong_course, requested, without_rate
from eomgen.judge.balances import requests_reactions
from eomgen.judge.case import Case
from eomgen.judge.comparison import Comparison, excess, first_order_place, place_of, remainder
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.fixes import (
    UNDAMPED,
    Authored,
    Fixes,
    Renaming,
    is_of_kinetic_energy,
    of_forces,
    renamings,
    with_constant_forces,
    with_reactions_of_zero,
    without_damping,
)
from eomgen.judge.implied import (
    Explainable,
    Instant,
    Meanings,
    beside_rest,
    implied_by_rest,
    loosened_targets,
    simplest_explanation,
    targets_of,
)
from eomgen.judge.printed_answers import (
    impact_judged,
    of_eigenvalue,
    of_impact,
    of_matrix,
    of_sections,
    of_small_motions,
    section_at,
)
from eomgen.judge.reading import DERIVED, HandEquation, along_ground_axes, of_free_coordinates
from eomgen.judge.truth import (
    CONSTANT,
    EVERY_PIECE,
    IDENTITY,
    SIGNLESS,
    Decided,
    by_balance,
    by_what_is_given,
    course_of,
    in_its_piece,
    is_of_rest,
    on_one_side,
    other_models,
    says_nothing,
    small_motions,
    stays_constant,
    truth_of,
    values_reported,
    while_,
    with_definitions,
    with_values_of_file,
)
from eomgen.judge.verdict import (
    FIRST_ORDER,
    FUNCTION_KINDS,
    IMPACT,
    KINDS,
    RIGHT,
    UNDECIDED,
    WRONG,
    Cause,
    Verdict,
    causes_of,
    kind_of_equation,
)
from eomgen.judge.written_pages import equations_in, matrix_of, without_first
from eomgen.model import AtRest, ModelOrPath, Requests
from eomgen.proof import JudgedEquation
from eomgen.resources import doing
from eomgen.study import model_to_study
from eomgen.symbolic.expression import (
    SLOPE,
    Expression,
    Node,
    Scalar,
    depends_on,
    is_zero,
    parse,
    substituted,
)
from eomgen.symbolic.print import readable_text


def verify(
    model: ModelOrPath,
    equation: Any,
    *,
    at: Any = None,
    from_rest: bool | None = None,
    kind: str | None = None,
    to_first_order: bool = False,
    about: str | None = None,
) -> Verdict:
    """The verdict on somebody's equation for a model: right, up to what, or wrong, and why.

    Args:
        equation: a text of the grammar, LaTeX, or a sympy equation (an expression is what is 0).
        at: the instant that it speaks of, an equation such as "theta = pi/2", or "equilibrium".
        from_rest: the motion starts with all speeds 0.
        kind: what it is about, one of KINDS; None: what stands in it says so.
        to_first_order: an equation of motion is right if it is so to the first order.
        about: beside this place, "theta = 0"; None: beside 0 or an equilibrium.
    Raises:
        ExpressionError: it cannot be read; column and length say where.
    """
    case = Case(model_to_study(model), bool(from_rest))
    return Judge(case, to_first_order, place_of(case, about)).verdict(equation, at=at, kind=kind)


CONSTANT_LETTER = re.compile(r"(?:[CcEHhK]|const)_?[0-9]?")
"""what an author calls his own constant: of a law that is wrong with it no other letter is taken for one"""


BEGUN = ("the first piece of the path", "contacts that slide as they do at the start")
GROUND = "the joint's forces along the ground's axes"
MATRICES = {"M": "mass", "C": "damping", "K": "stiffness"}
"""letter of a matrix of small motions -> the function of its entries"""
AT_REST = "an equilibrium"
NO_REST = "it is the condition of an equilibrium, and none is found"
VIRTUAL = "delta"
NAMED = "names of outputs as derivations have them"
OTHERWISE = "friction as its size, v and a as those of what moves"
FREE = "energies over all coordinates, as if none followed from others"
SAYS_NOTHING = ("what is equated", "the sign")  # of what equations are wrong that hold whatever the system does


@dataclass(frozen=True)
class Judge:
    """Judges equations of one model.

    Args:
        to_first_order: equations of motion need to be right to the first order alone.
        about: beside this place; None: beside 0 or an equilibrium.
    """

    case: Case
    to_first_order: bool = False
    about: Mapping[Node, Scalar] | None = None

    @doing("the verdict")
    def verdict(
        self,
        equation: Any,
        *,
        at: Any = None,
        kind: str | None = None,
        defined: Mapping[str, Expression] | None = None,
    ) -> Verdict:
        """The verdict on one equation.

        Args:
            defined: letters of the author's own, and what they stand for.
        Raises:
            ExpressionError: it cannot be read.
            UsageError: no such kind.
        """
        if kind is not None and kind not in KINDS:
            raise UsageError(f"there is no kind '{kind}' of equations", fix=f"one of {', '.join(KINDS)}")
        several = equations_in(equation) if isinstance(equation, str) else []
        if several and several != [equation]:
            return self._of_several(equation, several, at=at, kind=kind, defined=defined)
        if (matrix := matrix_of(equation) if isinstance(equation, str) else None) is not None:
            return self._of_matrix(equation, *matrix)
        there = partial(self.verdict, at=at, kind=kind, defined=defined) if at is not None else None
        if isinstance(equation, str) and (struck := of_impact(self.case, there, equation, defined)) is not None:
            return struck
        printed = self.of_printed(equation, kind, defined) if at is None and isinstance(equation, str) else None
        if printed is not None:
            return printed
        written = self.case.reading.read(equation, defined)
        known = kind or kind_of_equation(written, self.case.model)
        answered = of_output(self.case, written, at)
        if answered:
            return answered
        try:
            found = self._of_virtual_work(written, known, at) or self._of_axes(written, known, at)
        except ExpressionError:  # it has no value of the motion; as the output that it names it may have one
            if answered is None:
                raise
            return answered
        for reported, other in self._other_readings(equation, written, defined) if not found else ():
            with suppress(ExpressionError):
                if so := self._of_axes(other, kind or kind_of_equation(other, self.case.model), at):
                    return replace(so, up_to=" and ".join(filter(None, (reported, so.up_to))))
        if not found and at is None and self._may_be_of_rest(written):
            with suppress(ExpressionError):
                if so := self._of_axes(written, "equilibrium", None):
                    return replace(so, up_to=" and ".join(filter(None, (AT_REST, so.up_to))))
            if not self.case.rests:
                return Verdict(written.given, "equilibrium", UNDECIDED, reason=NO_REST)
        is_number = written.measured is not None and bool(written.measured.unit)
        if answered is not None and (is_number or found.verdict == UNDECIDED):
            return answered
        return self._to_first_order(written, found)

    def of_printed(
        self, equation: str, kind: str | None = None, defined: Mapping[str, Expression] | None = None
    ) -> Verdict | None:
        """The verdict on what `linearize` and `statics` print under names of their own; None: it is no such.

        Raises:
            ExpressionError: its right side cannot be read.
        """
        if (named := section_at(self.case, equation)) is not None:
            text, meant = named
            verdict = self.verdict(text, kind=kind, defined={**(defined or {}), **meant})
            shown = dict.fromkeys(meant, equation.partition("=")[0].strip())
            return replace(verdict.in_letters(shown), given=equation)
        found = of_small_motions(self.case, equation)
        return found if found is not None else of_sections(self.case, equation)

    def _of_several(self, given: str, several: Sequence[str], **meant: Any) -> Verdict:
        """The verdict on a chain or on rows: that of the first that is not right, of the last where all are."""
        parts: list[Verdict] = []
        for each in several:
            parts.append(self.verdict(each, **meant))
            if not parts[-1]:
                break
        if parts[-1].unknown and (others := without_first(several, parts[-1].unknown)):
            found = self._of_several(given, others, **meant)
            up_to = f"{', '.join(parts[-1].unknown)}, which the model does not have"
            return replace(found, up_to=" and ".join(filter(None, (found.up_to, up_to)))) if found else found
        return replace(parts[-1], given=given if parts[-1] else parts[-1].given, parts=tuple(parts))

    def _to_first_order(self, written: HandEquation, found: Verdict) -> Verdict:
        """A verdict on a wrong equation of motion, with the place beside which it is right to the first order."""
        if found.verdict != WRONG or found.kind not in EVERY_PIECE or self.case.unknown_names(written):
            return found
        up_to = self._first_order(found.kind, self.case.value(written.difference))
        return replace(found, up_to=up_to) if up_to else found

    def _first_order(self, kind: str, scalar: Scalar) -> str:
        """The words for the place beside which an equation of motion is right to the first order; "" for none."""
        place = first_order_place(self.case, scalar, self.about) if kind in EVERY_PIECE else None
        if place is None:
            return ""
        return f"{FIRST_ORDER} about {', '.join(f'{q.name} = {readable_text(x)}' for q, x in place.items())}"

    def _of_matrix(self, given: str, letter: str, rows: list[list[str]]) -> Verdict:
        """The verdict on a matrix of the small motions, M, C and K entry by entry.

        Raises:
            ExpressionError: another matrix, or one of another size.
        """
        if letter not in MATRICES and (found := of_matrix(self.case, given, letter, rows)) is not None:
            return found
        names = [u.name.removesuffix("'") for u in self.case.system.symbols.u]
        if letter not in MATRICES or not {*names} <= self.case.model.coordinates.keys():
            raise ExpressionError(f"'{letter}' is no matrix that is judged", 0, f"one of {', '.join(MATRICES)}")
        if [len(row) for row in rows] != [len(names)] * len(names):
            raise ExpressionError(f"{letter} has {len(names)} rows and columns: {', '.join(names)}", 0)
        parts: list[Verdict] = []
        for name, row in zip(names, rows, strict=True):
            for other, entry in zip(names, row, strict=True):
                parts.append(self.verdict(f"{MATRICES[letter]}({name}, {other}) = {entry}", kind="frequency"))
                if not parts[-1]:
                    return replace(parts[-1], given=given, parts=tuple(parts))
        return replace(parts[-1], given=given, parts=tuple(parts))

    def _may_be_of_rest(self, written: HandEquation) -> bool:
        """True if it is the condition Q = 0 of equilibrium, or a stiffness there."""
        left = written.left.code[0]
        if len(written.left.code) > 1 or left[0] != "call":
            return False
        if left[1].name == DERIVED:
            return str(left[1]).startswith(f"{DERIVED}(K_")
        return left[1].name == "generalized_force" and written.right.literal == 0

    def _of_virtual_work(self, written: HandEquation, kind: str, at: Any) -> Verdict | None:
        """The verdict on a sum of virtual works: each virtual displacement by itself; None: there is none in it."""
        unknown = self.case.unknown_names(written)
        virtual = [name for name in unknown if name.startswith(VIRTUAL) and len(name) > len(VIRTUAL)]
        if not virtual or virtual != unknown:
            return None
        verdict: Verdict | None = None
        for name in virtual:
            meant = {each: Expression.number(int(each == name)) for each in virtual}
            verdict = self._of_axes(written.with_names(meant), kind, at)
            if not verdict:
                break
        return None if verdict is None or not verdict else replace(verdict, up_to="any virtual displacement")

    def _other_readings(
        self, given: Any, written: HandEquation, defined: Mapping[str, Expression] | None
    ) -> Iterator[tuple[str, HandEquation]]:
        """(how, the equation) of ways in which it may be meant, too."""
        along_ground = along_ground_axes(written)
        if along_ground is not written:
            yield GROUND, along_ground
        if (with_unit := self.case.reading.with_unit(given, defined)) is not None:
            yield "", with_unit
        if (derived := self.case.reading.as_derived(given, defined)) is not None:
            yield NAMED, derived
        if (otherwise := self.case.reading.otherwise(given, defined)) is not None:
            yield OTHERWISE, otherwise
        if (undamped := without_damping(self.case, written)) is not None:
            yield UNDAMPED, undamped

    def _of_axes(self, written: HandEquation, known: str, at: Any) -> Verdict:
        """Verdict on an equation whose reactions are along known axes."""
        if self.case.system.free is None or not any(call.name in (SLOPE, DERIVED) for call in written.calls):
            return self._of_reading(written, known, at)
        free = of_free_coordinates(written)
        with suppress(ExpressionError):  # it is differentiated by what follows from others
            if found := self._of_reading(written, known, at):
                return found
        found = self._of_reading(free, known, at)
        return replace(found, up_to=" and ".join(filter(None, (FREE, found.up_to)))) if found else found

    def _of_reading(self, written: HandEquation, kind: str, at: Any) -> Verdict:
        try:
            found = self._judged(written, kind, _instant(self.case, at))
            if found.verdict == WRONG and at is None and (cause := of_forces(self.case, written, kind)) is not None:
                or_else = next((x.text for x in found.causes if x.kind != "other"), "")
                found = replace(found, causes=(replace(cause, or_else=or_else),))
            return found.in_letters(self._letters_of(written))
        except (DerivationError, RunFailed, MissingValues) as error:
            return Verdict(written.given, kind, UNDECIDED, reason=error.what)

    def _letters_of(self, written: HandEquation) -> Mapping[str, str]:
        """Letters in an equation; where it has some for reactions those of other reactions too, B_x beside B_y."""
        if not any(FUNCTION_KINDS.get(text.partition("(")[0]) == "reaction" for text in written.letters):
            return written.letters
        found = dict(written.letters)
        outputs = self.case.model.outputs
        for letter, formula in sorted(self.case.reading.letters.items(), key=lambda x: x[0] not in outputs):
            (kind, what), *rest = formula.code
            if not rest and kind == "call" and FUNCTION_KINDS.get(what.name) == "reaction":
                found.setdefault(str(what), letter)
        return found

    def is_right(self, written: HandEquation, kind: str) -> bool:
        """True if an equation that was read is right."""
        return bool(self._of_axes(written, kind, None))

    def said(self, verdict: Verdict, defined: Mapping[str, Expression] | None = None) -> tuple[JudgedEquation, ...]:
        """The equations of a verdict as they are decided again by numbers; none that says nothing or is undecided."""
        if verdict.parts:
            return tuple(each for part in verdict.parts for each in self.said(part, defined))
        struck = verdict.kind == IMPACT
        found = impact_judged(self.case, verdict, defined) if struck else self._said(verdict, defined)
        return () if found is None else (found,)

    def _said(self, verdict: Verdict, defined: Mapping[str, Expression] | None) -> JudgedEquation | None:
        empty = any(x.quantity in SAYS_NOTHING or x.quantity.startswith("Delta(") for x in verdict.causes)
        if verdict.verdict == UNDECIDED or empty or "self-stress" in verdict.up_to:
            return None
        begun = self.case.as_begun if any(x in verdict.up_to for x in BEGUN) else None
        equations = (begun or self.case).parts.equations
        if equations is None:
            return None
        try:
            written = self.case.reading.read(verdict.given, defined)
        except ExpressionError:  # det(s^2 M + C s + K), an entry of A: what linearize proves
            written = HandEquation(verdict.given, Expression.number(0), Expression.number(0))
        if GROUND in verdict.up_to:
            written = along_ground_axes(written)
        if NAMED in verdict.up_to:
            written = self.case.reading.as_derived(verdict.given, defined) or written
        if OTHERWISE in verdict.up_to:
            written = self.case.reading.otherwise(verdict.given, defined) or written
        if equations.system.free is not None and (verdict.verdict == WRONG or FREE in verdict.up_to):
            written = of_free_coordinates(written)
        names = [name for name in self.case.unknown_names(written) if name not in verdict.substitution]
        return JudgedEquation(
            verdict.given,
            written.left,
            written.right,
            verdict.kind,
            verdict.verdict == RIGHT,
            verdict.up_to,
            equations,
            verdict.substitution,
            tuple(names),
            self.case.at_rest,
            verdict.difference,
            self._derived_in(written),
        )

    def _derived_in(self, written: HandEquation) -> dict[str, Scalar]:
        """The values of quantities that derivations name, by the texts of the functions that ask for them."""
        return {str(call): self.case.called(call) for call in written.calls if call.name == DERIVED}

    def _judged(self, written: HandEquation, kind: str, at: Instant) -> Verdict:
        case = self.case
        unknown = case.unknown_names(written)
        if not unknown:
            case.check(written)
        if says_nothing(case, written):
            if letter := "L" if written.name == "L" else self._output_stated(written):
                return Verdict(written.given, kind, RIGHT, f"what {letter} is")
            return self._not(written, kind, Decided(False, why=IDENTITY))
        if at is None and kind == "equilibrium" and not unknown:
            found = self._at_rest(written)
            if found is not None:
                moving = without_rate(case, written, "motion") if found.verdict == WRONG and not case.rests else None
                return found if moving is None else moving
            kind = "motion"
        if at is not None or kind == "frequency" or (kind == "statics" and not unknown):
            return requested(case, written, kind, at)
        if unknown:
            return self._of_other_names(written, kind, unknown)
        found = self._course(written)
        for way in (of_state, without_rate):
            found = way(case, written, kind) if found is None else found
        if found is not None:
            return found
        return self._of_scalar(written, kind, case.value(written.difference))

    def _output_stated(self, written: HandEquation) -> str:
        """The letter of an output of which an equation says no more than the file does: F = m*(g + s''); "" of none."""
        values = [output.value for output in self.case.model.outputs.values()]
        with suppress(ExpressionError):
            as_said = replace(written, left=parse(written.left.text), right=parse(written.right.text))
            letters = [x for x in as_said.names if self.case.reading.letters.get(x) in values]
            return letters[0] if letters and not says_nothing(self.case, as_said) else ""
        return ""

    def _at_rest(self, written: HandEquation) -> Verdict | None:
        """Verdict on an equation in which nothing moves: on constraints or equilibrium; None: nothing rests."""
        case, scalar = self.case, self.case.value(written.difference)
        found = truth_of(case, scalar, "law")
        if found.holds:
            return Verdict(written.given, "equilibrium", RIGHT, found.up_to)
        in_balance = is_of_rest(case, scalar)
        if in_balance:
            return Verdict(written.given, "equilibrium", RIGHT)
        for place in case.places_of_rest if in_balance is None else ():
            if is_zero_everywhere(case.system, *substituted((scalar,), place)).holds:
                return Verdict(written.given, "equilibrium", RIGHT)
        dependent = {name for name, q in case.model.coordinates.items() if q.dependent}
        if dependent & written.names:
            of_constraints = self._wrong(written, "equilibrium", scalar)
            if not case.system.symbols.u or of_constraints.causes[0].kind != "other":
                return of_constraints
        target = implied_by_rest(case, written)
        places = case.places_of_rest
        if any(is_zero_everywhere(case.system, *substituted((scalar,), place)).holds for place in places):
            places = ()  # it is right there: what is wrong is that it holds elsewhere, too
        fixes = [Fixes(Authored(case, written, "equilibrium", place)) for place in places]
        _, why = simplest_explanation([*([target] if target else []), *beside_rest(case, scalar)], fixes)
        if why:
            difference = excess(case, target.left) if target is not None else ""
            causes = causes_of(case, why, moving=False)
            return Verdict(written.given, "equilibrium", WRONG, difference=difference, causes=causes)
        if not case.rests and case.system.symbols.u and not case.model.unknowns and in_balance is None:
            return None
        verdict = requested(case, written, "equilibrium", AtRest())
        if in_balance is None or verdict.verdict == WRONG:
            return verdict
        text = "places at which the forces do not balance satisfy it, too"
        return Verdict(written.given, "equilibrium", WRONG, causes=(Cause("other", text, quantity="its solutions"),))

    def _of_scalar(self, written: HandEquation, kind: str, scalar: Scalar) -> Verdict:
        """The verdict on an equation whose names are all known."""
        case = self.case
        found = truth_of(case, scalar, kind, to_a_constant=not is_of_kinetic_energy(written))
        if found.why == IDENTITY:
            by_forces = Decided(True, "the balance of forces") if requests_reactions(written) else None
            found = by_forces or by_what_is_given(case, written) or found
        if not found.holds and not found.why:
            found = (
                by_balance(case, kind, scalar)
                or with_definitions(case, kind, scalar)
                or with_values_of_file(case, written, kind, scalar)
                or on_one_side(case, written, kind, scalar)
                or with_constant_forces(case, written, kind)
                or found
            )
        elif found.why == CONSTANT:  # with another value, but of the file's numbers it may be this one
            found = with_values_of_file(case, written, kind, scalar) or found
        if not found.holds and (begun := case.as_begun) is not None:
            with suppress(EomgenError):
                so = truth_of(begun, begun.value(written.difference), kind)
                if so.holds:
                    reported = BEGUN[0] if case.model.on_paths else BEGUN[1]
                    found = Decided(True, f"{reported} and {so.up_to}" if so.up_to else reported)
        if found.holds:
            return Verdict(written.given, kind, RIGHT, with_reactions_of_zero(case, written, kind, found.up_to))
        if found.holds is None:
            return Verdict(written.given, kind, UNDECIDED, reason=found.up_to or "no state of the model decides it")
        if self.to_first_order and (up_to := self._first_order(kind, scalar)):
            return Verdict(written.given, kind, RIGHT, up_to)
        solved: dict[str, Scalar] = {}
        with suppress(DerivationError):
            unknowns = case.system.symbols.unknowns if written.calls else {}
            solved = {name: case.solved(x) for name, x in unknowns.items() if depends_on(scalar, (x,))}
        wrong = self._wrong(written, kind, case.value(written.difference, solved) if solved else scalar, solved)
        return replace(wrong, up_to=in_its_piece(case, scalar)) if kind in EVERY_PIECE else wrong

    def _course(self, written: HandEquation, constants: Meanings | None = None) -> Verdict | None:
        """Verdict on a coordinate as a function of time; None: it is something else."""
        case = self.case
        course = course_of(case, written, constants or {})
        if course is None:
            return None
        if course.holds is None:
            return Verdict(written.given, "law", UNDECIDED, reason="the equations of motion do not decide it alone")
        if course.holds and course.begins is None:
            reason = "the equations of motion hold with it, but where the motion starts is not known"
            return Verdict(written.given, "law", UNDECIDED, reason=reason)
        if course.holds and course.begins:
            reported = f"any start, with {', '.join(constants)} constant" if constants else "the motion from the start"
            with_values = f", with {values_reported(course.values)}" if course.values else ""
            return Verdict(written.given, "law", RIGHT, f"{reported}{with_values}{while_(course.held)}")
        return of_wrong_course(case, written, course)

    # -- other names ---------------------------------------------------------------------------------

    def _of_other_names(self, written: HandEquation, kind: str, unknown: list[str]) -> Verdict:
        """Verdict on an equation with names that the model lacks: renamed, constants, or forces of constraints."""
        case = self.case
        if (characteristic := of_eigenvalue(case, written, unknown)) is not None:
            return characteristic
        near: Renaming | None = None
        for renaming in renamings(case, written, unknown):
            near = near or (renaming if renaming.near else None)
            scalar = case.value(written.difference, renaming.values)
            found = truth_of(case, scalar, kind)
            if not found.holds and renaming.near:
                found = on_one_side(case, written, kind, scalar) or found
            if found.holds and not (renaming.guessed and found.up_to.endswith("the constraints")):
                return Verdict(written.given, kind, RIGHT, found.up_to, renaming.reported)
        free = {name: case.system.scope.graph.symbol(name) for name in unknown}
        moving = any(f"{name}'" in written.names for name in unknown)
        with suppress(ExpressionError):
            verdict = None if moving else self._with_constants(written, kind, free)
            if verdict is not None:
                return verdict
        if near is None:
            known = not moving and not written.calls and all(map(CONSTANT_LETTER.fullmatch, unknown))
            if known and kind in ("law", "energy"):
                return self._wrong(written, kind, case.value(written.difference, free), free)
            return of_unknown(case, written, kind, unknown)
        wrong = self._wrong(written, kind, case.value(written.difference, near.values), near.values)
        return replace(wrong, substitution=near.reported)

    def _with_constants(self, written: HandEquation, kind: str, free: Mapping[str, Node]) -> Verdict | None:
        """Right with the unknown names constant, or but for the force of a constraint that they are; None: neither."""
        case = self.case
        reported = ", ".join(free)
        course = self._course(written, free)
        if course is not None and course.verdict == RIGHT:
            return course
        scalar = case.value(written.difference, free)
        if kind in ("law", "energy") and depends_on(scalar, tuple(free.values())):
            found = truth_of(case, scalar, kind)
            if found.holds:
                up_to, mark, piece = found.up_to.partition(", while ")
                return Verdict(written.given, kind, RIGHT, f"{up_to}, with {reported} constant{mark}{piece}")
            if held := stays_constant(case, scalar):
                up_to = f"a first integral of the motion, with {reported} constant{while_(held)}"
                return Verdict(written.given, kind, RIGHT, up_to)
        if kind == "motion":
            (rest,) = substituted((scalar,), dict.fromkeys(free.values(), 0))
            if truth_of(case, rest, kind).holds:
                forces = " and ".join(free)
                cause = Cause("constraint_force", _left_in(forces), forces, quantity=f"the force {forces}")
                return Verdict(written.given, kind, WRONG, difference=forces, causes=(cause,))
        return None

    # -- wrong ---------------------------------------------------------------------------------------

    def _not(self, written: HandEquation, kind: str, found: Decided, scalar: Scalar = 0) -> Verdict:
        """Wrong for a reason that is none of the contributions'."""
        difference = ""
        if found.why == IDENTITY:
            text, quantity = "it holds whatever the system does: it says nothing of it", "what is equated"
        elif found.why == SIGNLESS:
            text = "accelerations of the opposite sign satisfy it as well: it does not say which it is"
            quantity = "the sign"
        else:
            (start,) = substituted((scalar,), self.case.start)
            difference = excess(self.case, start)
            where = found.up_to or "along the motion"
            text = f"it stays constant {where}, but it is {difference} at the start, and not 0"
            quantity = "the constant"
        kind_ = "sign" if found.why == SIGNLESS else "other"
        cause = Cause(kind_, text, quantity=quantity)
        return Verdict(written.given, kind, WRONG, difference=difference, causes=(cause,))

    def _wrong(self, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None = None) -> Verdict:
        """Why an equation is wrong; that it is, where nothing of why has a value."""
        try:
            return self._explained(written, kind, scalar, also)
        except DerivationError:
            difference = excess(self.case, scalar)
            return Verdict(written.given, kind, WRONG, difference=difference, causes=(_apart(difference),))

    def _explained(self, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None) -> Verdict:
        """The same, with the mistake that makes it so."""
        case = self.case
        found = truth_of(case, scalar, kind)
        if found.why and not (found.why == CONSTANT and written.calls):
            fix = Fixes(Authored(case, written, kind)).explained(1) if found.why == CONSTANT and not also else []
            if not fix:
                return self._not(written, kind, found, scalar)
            causes = causes_of(case, fix, moving=False)
            return Verdict(written.given, kind, WRONG, difference=excess(case, scalar), causes=causes)
        left = self._without_reactions(written, kind, also)
        if left is not None:
            return left
        targets = targets_of(case, written, kind, scalar, also)
        if not also:
            targets = [*loosened_targets(case, written, kind), *targets]
        laws = case.laws_of_time if depends_on(scalar, (case.system.symbols.t,)) else {}
        targets = [each.with_known(laws) if laws and isinstance(each, Comparison) else each for each in targets]
        values = [each for each in targets if isinstance(each, Comparison)]
        known: list[Explainable] = [*targets, *(small for each in values for small in small_motions(each))]
        edits = other_models(case, written, kind, None)
        own: list[Explainable] = [] if also else [edits, Fixes(Authored(case, written, kind))]
        target, explanations = simplest_explanation(known, own, soon=kind == "law" and not case.system.constraints.rows)
        if not explanations and (begun := case.as_begun) is not None:
            with suppress(EomgenError):
                also_ = targets_of(begun, written, kind, begun.value(written.difference, also), also)
                target, explanations = simplest_explanation(also_)
        if explanations and target is not None:
            moving = kind in ("motion", "acceleration", "reaction", "law")
            rooted = isinstance(target, Comparison) and target.squared
            causes = causes_of(case, explanations, moving=moving, rooted=rooted)
            difference = target.difference(explanations[0]) or remainder(case, scalar)
            return Verdict(written.given, kind, WRONG, difference=difference, causes=causes)
        difference, touched = values[-1].unexplained() if values else ("", "")
        difference = difference or remainder(case, scalar)
        cause = _apart(difference, touched)
        nothing = [x for x in values if not x.what and not is_zero(x.rows[0]) and is_zero(x.scalar + x.rows[0])]
        if nothing and (there := excess(case, nothing[0].rows[0])):
            cause = Cause(
                "missing_term", f"it is not 0, but {there}: all of it is missing", there, quantity="whether it is 0"
            )
        elif clash := case.clash(written):
            cause = Cause("unit", clash, term=difference, quantity="the dimensions")
        return Verdict(written.given, kind, WRONG, difference=difference, causes=(cause,))

    def _without_reactions(self, written: HandEquation, kind: str, also: Meanings | None) -> Verdict | None:
        """Right without the reactions that stand in it: these are left in."""
        case = self.case
        left_in = {call for call in written.calls if FUNCTION_KINDS.get(call.name) == "reaction"}
        if kind != "motion" or not left_in:
            return None
        names = {**case.system.scope.names, **(also or {})}
        found = case.evaluated(written.difference, names, lambda call: 0 if call in left_in else case.called(call))
        if not truth_of(case, found, kind).holds:
            return None
        reported = ", ".join(map(str, left_in))
        cause = Cause("constraint_force", _left_in(reported), reported, force=reported, quantity=reported)
        return Verdict(written.given, kind, WRONG, difference=reported, causes=(cause,))


def _apart(difference: str, beside: str = "") -> Cause:
    """The cause that the sides differ, where nothing explains it."""
    text = f"the sides differ by {difference}" if difference else "the sides differ"
    return Cause("other", f"{text}{beside}", term=difference)


def _left_in(force: str) -> str:
    return f"the force {force} of a constraint is left in: it does no work along the coordinate, and must drop out"


def _instant(case: Case, at: Any) -> Instant:
    if at is None or isinstance(at, Instant):
        return at
    if str(at).strip() == AtRest.text:
        return AtRest()
    try:
        return Requests(case.model).equation(str(at))
    except ExpressionError as error:
        raise UsageError(f"at {at}: {error.what}", fix=error.fix or 'write "theta = pi/2"') from error
