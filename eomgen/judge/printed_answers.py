"""Verdicts on what `linearize` and `statics` print under names of their own.

State matrices and their entries, transfer functions, the characteristic equation and the conditions of Hurwitz, as they
are printed; of an author also a polynomial in s or lambda that is 0 where the characteristic one is. Section forces
M(2*a), V(x), N(x) of the only beam, the extremes of M and their places; the shares Delta(A_x) of reactions that are
statically indeterminate.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from itertools import groupby, islice
from math import isfinite
from typing import Any

from eomgen.documents import lettered
from eomgen.errors import DerivationError, EomgenError, ExpressionError, MissingValues
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.comparison import excess
from eomgen.judge.decision import is_zero_everywhere, states_of
from eomgen.judge.reading import DERIVED, HandEquation, side_value
from eomgen.judge.terms import short_text
from eomgen.judge.verdict import IMPACT, RIGHT, UNDECIDED, WRONG, Cause, Verdict
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.impacts import ImpactEquations
from eomgen.mechanics.linearization import Modes
from eomgen.mechanics.statics import SectionForces
from eomgen.proof import JudgedEquation
from eomgen.results import linearize
from eomgen.symbolic.exact import Polynomial
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Fraction,
    Node,
    Reference,
    Scalar,
    depends_on,
    gradient,
    is_zero,
    over,
    parse,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, evaluate, tolerances
from eomgen.symbolic.print import readable_text, to_text

LETTERS = ("A", "B", "C_y", "D_y", "D", "G", "H", "E", "F")
ENTRY = re.compile(r"(?P<letter>[A-Z](?:_y|_\{y\})?)\s*(?:[\[(](?P<text>[^\[\]()=]+)[\])]|_\{(?P<index>.*)\})\s*$")
DETERMINANT = re.compile(r"\\?det\b.*\bs\w*\b.*$", re.S)
CONDITION = re.compile(r"h_\{?(\d+)\}?$")
EIGENVALUE = ("s", "lambda", "p", "r")
"""letters of an exponent exp(s t) that an author may have"""
CIRCULAR = ("omega", "w")
"""letters of a frequency, s = i omega"""
Named = tuple[Sequence[str], Sequence[str], Sequence[Sequence[Any]]]
TRIED = Fraction(3, 7)  # a value of s at which polynomials are compared
DEFINES = "what the characteristic equation is"


@dataclass(frozen=True)
class SmallMatrices:
    """The matrices of small motions, over the symbols of a case; in floats where they are not known exactly."""

    case: Case
    modes: Modes

    @staticmethod
    def of(case: Case) -> SmallMatrices | None:
        """Matrices of a case; None where it has no small motions."""
        with suppress(DerivationError, MissingValues):
            return SmallMatrices(case, linearize(case.model).modes)
        return None

    @cached_property
    def s(self) -> Node:
        """s of exp(s t), over the symbols of the case."""
        return self.case.system.scope.graph.symbol(self._variable.name)

    @property
    def _variable(self) -> Node:
        return self.modes.small.equations.laplace_variable

    def named(self, letter: str) -> list[Named]:
        """(names of the rows, of the columns, entries) of every matrix of that letter: B is one of two."""
        small = self.modes.small
        e = small.equations
        q, u, w = ([x.name for x in some] for some in (e.coordinates, e.speeds, e.inputs))
        rows = q if small.is_second_order else u
        plain: dict[str, Named] = {"B": (rows, w, e.B), "E": (q, u, e.E), "F": (q, q, e.F)}
        found: list[Named] = [plain[letter]] if letter in plain else []
        if letter in ("D", "G", "H"):
            found.append((rows, q if letter == "H" else rows, self.modes.symmetric_parts[letter]))
        if letter in ("A", "B", "C_y", "D_y"):
            exact, numbers = self.modes.state_spaces([x.name for x in e.coordinates])
            if (space := exact or numbers) is not None:
                along = {"A": space.states, "B": space.inputs, "C_y": space.states, "D_y": space.inputs}[letter]
                down = space.outputs if letter in ("C_y", "D_y") else space.states
                found.append((down, along, getattr(space, letter)))
        return found

    def own(self, x: Any) -> Scalar:
        """A scalar of the linearized system over the symbols of the case."""
        if type(x) is not Node:
            return x if not isinstance(x, float) else Fraction(x)
        text = to_text(x)
        names = {**self.case.system.scope.names, self._variable.name: self.s}
        return parse(text, longest=len(text) + 1, tables=self.case.model.functions).evaluate(names)

    def characteristic(self, *, circular: bool = False) -> Scalar | None:
        """det(s^2 M + s C + K) of s; of a frequency, s = i s', where no odd power is in it. None: it is not known."""
        found = self.modes.polynomial
        if found is None:
            return None
        coefficients = [self.own(c) for c in found.coefficients]
        if circular and not all(map(is_zero, coefficients[1::2])):
            return None
        signs = [(-1) ** (k // 2) if circular else 1 for k in range(len(coefficients))]
        return sum((sign * c * self.s**k for k, (sign, c) in enumerate(zip(signs, coefficients, strict=True))), start=0)


def of_small_motions(case: Case, given: str) -> Verdict | None:
    """The verdict on an entry, a transfer function, the characteristic equation or a condition; None: it is no such."""
    left, sign, right = (part.strip() for part in given.partition("="))
    is_law, condition, entry = DETERMINANT.match(left), CONDITION.match(left), ENTRY.match(left)
    if not sign or not (is_law or condition or entry) or (entry and entry["letter"][0] not in "ABCDEFGHW"):
        return None
    if condition and f"h_{condition[1]}" in case.system.scope.names:
        return None
    names = _names(case, entry) if entry else ()
    if names is None or (small := SmallMatrices.of(case)) is None:
        return None
    if is_law:
        if right == "0":
            return Verdict(given, "frequency", RIGHT, DEFINES)
        true = small.characteristic()
    elif condition:
        found = small.modes.conditions.expressions
        k = int(condition[1]) - 1
        true = small.own(found[k]) if 0 <= k < len(found) else None
    else:
        assert entry is not None
        true = _entry(small, entry, *names)
    return None if true is None else _compared_entry(small, given, left, right, true)


def _entry(small: SmallMatrices, entry: re.Match[str], row: str, column: str) -> Scalar | None:
    """The true entry of a matrix, or the transfer function; None: there is none of that letter."""
    letter = entry["letter"].replace("{", "").replace("}", "")
    if letter == "W":
        for f in small.modes.transfers:
            if (f.coordinate.name, f.input.name) == (row, column):
                return small.own(over(f.above.at(small._variable), f.below.at(small._variable)))
        return None
    for rows, columns, entries in small.named(letter):
        if row in rows and column in columns:
            return small.own(entries[list(rows).index(row)][list(columns).index(column)])
    return None


def _names(case: Case, entry: re.Match[str]) -> tuple[str, str] | None:
    """Names of row and column as the model has them, \\dot\\theta as theta'; None: it has none of these."""
    model = case.model
    known = {
        *model.inputs,
        *(f"{q}{dot}" for q in model.coordinates for dot in ("", "'")),
        *model.speeds,
        *model.states,
    }
    pieces = [piece.strip() for piece in (entry["text"] or entry["index"]).split(",")]
    found = []
    for piece in pieces if len(pieces) == 2 else ():
        with suppress(ExpressionError):
            code = case.reading.read(f"{piece} = 0").left.code
            found += [str(code[0][1])] if len(code) == 1 and code[0][1] in known else []
    return (found[0], found[1]) if len(found) == 2 else None


def of_matrix(case: Case, given: str, letter: str, rows: Sequence[Sequence[str]]) -> Verdict | None:
    """The verdict on a matrix that is given by its rows; None: there is none of that letter.

    Raises:
        ExpressionError: one of another size; an entry cannot be read.
    """
    plain = re.sub(r"[{}\s]", "", letter)
    if plain not in LETTERS or (small := SmallMatrices.of(case)) is None:
        return None
    known = [x for x in small.named(plain) if x[2] and x[2][0]]
    sized = [x for x in known if [len(row) for row in rows] == [len(x[1])] * len(x[0])]
    if known and not sized:
        sizes = " or ".join(f"{len(x[0])} rows and {len(x[1])} columns" for x in known)
        raise ExpressionError(f"{letter} has {sizes}", 0)
    verdict: Verdict | None = None
    for down, along, entries in sized:
        for name, true_row, row in zip(down, entries, rows, strict=True):
            for other, true, entry in zip(along, true_row, row, strict=True):
                verdict = _compared_entry(small, given, f"{plain}[{name}, {other}]", entry, small.own(true))
                if not verdict:
                    break
            if not verdict:
                break
        if verdict:
            return verdict
    return verdict


def _compared_entry(small: SmallMatrices, given: str, name: str, right: str, true: Scalar) -> Verdict:
    """The verdict on what an author has for a true value.

    Raises:
        ExpressionError: it cannot be read, or has an unknown name.
    """
    case = small.case
    written = case.reading.read(f"{right} = 0").left
    author = case.value(written, {small.s.name: small.s})
    if is_zero_everywhere(case.system, true - author).holds:
        return Verdict(given, "frequency", RIGHT)
    if _agree_in_numbers(small, true, author):
        return Verdict(given, "frequency", RIGHT, "the values of the file")
    difference = excess(case, true - author)
    text = f"it is {name} = {readable_text(true)}"
    return Verdict(given, "frequency", WRONG, difference=difference, causes=(Cause("other", text, quantity=name),))


def _agree_in_numbers(small: SmallMatrices, true: Scalar, author: Scalar) -> bool:
    """True if one of both is known in numbers alone, and they agree to what is printed of it."""
    names = small.case.system.symbols.parameters.values()
    if all(any(depends_on(x, (p,)) for p in names) for x in (true, author)):
        return False
    exact = {p: x for p, x in small.case.system.scope.known_parameters.items()}
    sizes = []
    for s in (0.37, 1.9):
        try:
            sizes.append([float(x) for x in evaluate((true, author), {**exact, small.s: s}, FLOAT)])
        except (NoValue, ZeroDivisionError, KeyError, TypeError):
            return False
    return all(abs(a - b) <= tolerances.SEVEN_DIGITS * max(abs(a), abs(b)) for a, b in sizes)


def of_eigenvalue(case: Case, written: HandEquation, unknown: Sequence[str]) -> Verdict | None:
    """The verdict on a polynomial in an exponent that is 0, s^2 + omega_0^2 = 0; None: it is no such."""
    if len(unknown) != 1 or unknown[0] not in (*EIGENVALUE, *CIRCULAR) or written.calls:
        return None
    if any(name.endswith("'") or name in case.model.coordinates for name in written.names):
        return None
    small = SmallMatrices.of(case)
    if small is None or (true := small.characteristic(circular=unknown[0] in CIRCULAR)) is None:
        return None
    author = case.value(written.difference, {unknown[0]: small.s})
    at = [substituted((x,), {small.s: TRIED})[0] for x in (true, author)]
    if is_zero(at[1]):
        return None
    if is_zero_everywhere(case.system, true * at[1] - author * at[0]).holds:
        return Verdict(written.given, "frequency", RIGHT, "the characteristic equation")
    mine = Polynomial.of(author, small.s, case.system.scope.positive)
    known = small.modes.polynomial
    if mine is None or known is None or len(mine.coefficients) != len(known.coefficients):
        return None
    text = f"the characteristic equation is {readable_text(true)} = 0"
    return Verdict(written.given, "frequency", WRONG, causes=(Cause("other", text, quantity="the determinant"),))


# -------- sections and self-stresses --------------------------------------------------------------------------
# M at a place, or as a function of x in the part of the beam where it is so.


FUNCTIONS = {"N": "axial_force", "V": "shear_force", "Q": "shear_force", "M": "bending_moment"}
AT = re.compile(
    r"\s*(?P<letter>[NVQM])(?:_\{?b\}?)?\s*(?:\\left)?\((?P<place>[^()=]+?)(?:\\right)?\)\s*=(?P<right>.*)", re.S
)
_EXTREME = r"(?:\\mathrm\{extreme\}|extreme)"
_GREATEST = r"\\?(?:max|mathrm\{max\}|text\{max\})"
EXTREME = re.compile(
    rf"\s*(?:M\(extreme\)|M_\{{?{_EXTREME}\}}?|(?P<greatest>M_\{{?{_GREATEST}\}}?|max\(\|?M\|?\))"
    r"|(?P<place>[a-z_]+))\s*=(?P<right>.*)",
    re.S,
)
DELTA = re.compile(
    r"\s*(?:\\?Delta|Δ)(?:_\{(?P<index>.+)\}|\((?P<letter>.+)\)|\s*(?P<plain>[A-Z]\w*))\s*&?=(?P<right>.*)", re.S
)
BREAK = "\\ "  # \\\\ at the end of a row
PLACE = "the place of an extreme of M"


def of_sections(case: Case, given: str) -> Verdict | None:
    """The verdict on a section force, an extreme or a share of a self-stress; None: it is no such."""
    model = case.model
    if (found := DELTA.match(given)) is not None:
        return _of_share(case, given, found)
    if model.coordinates or model.space != "plane":
        return None
    with suppress(ExpressionError, DerivationError):
        if (extreme := EXTREME.match(given)) is not None:
            return _of_extreme(case, given, extreme)
        if (at := AT.match(given)) is not None:
            return _of_course(case, given, at)
    return None


def _beams(case: Case) -> Iterator[tuple[str, SectionForces]]:
    """Section forces of every body that is a beam; where lines are declared, of those that have one."""
    bodies = case.model.bodies
    lined = [name for name, body in bodies.items() if body.line]
    for body in lined or bodies:
        with suppress(EomgenError):
            yield body, SectionForces.of(case.quantities.reactions, body)


def section_at(case: Case, given: str) -> tuple[str, dict[str, Expression]] | None:
    """M(2*a) = ... of the only beam as an equation with a letter, and what that stands for; None: it is no such."""
    at = AT.match(given)
    if at is None or case.model.coordinates or case.model.space != "plane" or at["letter"] in case.system.scope.names:
        return None
    with suppress(ExpressionError):
        place, beams = case.reading.read(f"{at['place']} = 0").left, list(_beams(case))
        if len(beams) == 1 and place.names <= case.system.scope.names.keys() and not place.calls:
            call = Call(FUNCTIONS[at["letter"]], (Reference(beams[0][0]), place))
            letter = f"{at['letter']}_section"
            return f"{letter} = {at['right']}", {letter: Expression(str(call), (("call", call),), (0,))}
    return None


def _of_course(case: Case, given: str, at: re.Match[str]) -> Verdict | None:
    """M as a function of x along the only beam."""
    letter, names = at["letter"], case.system.scope.names
    place = case.reading.read(f"{at['place']} = 0").left
    unknown = sorted(place.names - names.keys() - {"pi"})
    beams = list(_beams(case)) if len(unknown) == len(place.code) == 1 and letter not in names else []
    if len(beams) != 1:
        return None
    x, pieces = case.system.scope.graph.symbol(unknown[0]), beams[0][1].pieces
    author = case.value(case.reading.read(f"{at['right']} = 0").left, {x.name: x})
    parts = [f"{readable_text(case.own(p.start))} < {x.name} < {readable_text(case.own(p.end))}" for p in pieces]
    true = [case.own(piece.value(FUNCTIONS[letter], x)) for piece in pieces]
    return _in_a_part(case, given, true, author, parts, f"{letter}({x.name})")


def _in_a_part(case: Case, given: str, true: list[Scalar], author: Scalar, parts: list[str], name: str) -> Verdict:
    """Right where one of the true values is the author's, in its part of the beam."""
    for each, part in zip(true, parts, strict=True):
        if is_zero_everywhere(case.system, each - author).holds:
            return Verdict(given, "statics", RIGHT, f"{part}" if part and len(true) > 1 else "")
    values = [f"{readable_text(x)}{f' in {part}' if part else ''}" for x, part in zip(true, parts, strict=True)]
    difference = excess(case, true[0] - author) if len(true) == 1 else ""
    cause = Cause("other", f"it is {name} = {'; '.join(values)}", quantity="the section force")
    return Verdict(given, "statics", WRONG, difference=difference, causes=(cause,))


def _of_extreme(case: Case, given: str, found: re.Match[str]) -> Verdict | None:
    """An extreme of M, its greatest size, or the place of an extreme; None where it is none of these."""
    letter = given.partition("=")[0].strip()
    if letter in case.system.scope.names or letter in case.reading.letters:
        return None
    author = case.value(case.reading.read(f"{found['right']} = 0").left)
    beams = [forces for _, forces in _beams(case)]
    if found["place"]:
        places = [case.own(extreme.x) for forces in beams for extreme in forces.extremes]
        right = any(is_zero_everywhere(case.system, true - author).holds for true in places)
        return Verdict(given, "statics", RIGHT, PLACE) if right else None  # x may be something else
    values = [x for forces in beams for x in (_greatest(forces) if found["greatest"] else _of_extremes(forces))]
    if not values:
        return None
    true = list(dict.fromkeys(case.own(x) for x in values))
    if found["greatest"] and any(is_zero_everywhere(case.system, x + author).holds for x in true):
        return Verdict(given, "statics", RIGHT, "the sign of M")
    return _in_a_part(case, given, true, author, [""] * len(true), letter)


def _of_extremes(forces: SectionForces) -> list[Scalar]:
    return [extreme.M for extreme in forces.extremes]


def _greatest(forces: SectionForces) -> list[Scalar]:
    """The moments of the greatest size along a beam; of those whose order nobody knows all."""
    sizes, found = forces.sizes, _of_extremes(forces)
    for piece in forces.pieces:
        found += [piece.value("bending_moment", x) for x in (piece.start, piece.end)]
    kept: list[Scalar] = []
    for x in map(sizes.shortest, found):
        larger, smaller = False, list[Scalar]()
        for other in kept:
            with suppress(DerivationError):
                more = sizes.sign(x * x - other * other)
                larger, smaller = larger or more <= 0, [*smaller, *([other] if more > 0 else [])]
        kept = [each for each in kept if each not in smaller] + ([] if larger else [x])
    return kept


def _of_share(case: Case, given: str, found: re.Match[str]) -> Verdict | None:
    """The share of a reaction in a self-stress of any size k."""
    reactions = case.quantities.reactions
    with suppress(ExpressionError, DerivationError):
        letter = found["letter"] or found["index"] or found["plain"]
        calls = case.reading.read(f"{letter} = 0").left.calls
        right = case.reading.read(f"{found['right'].rstrip(BREAK)} = 0").left
        unknown = sorted(right.names - case.system.scope.names.keys() - {"pi"})
        if len(unknown) > 1 or len(calls) != 1 or not reactions.null_space:
            return None
        name = unknown[0] if unknown else "k1"
        k = case.system.scope.graph.symbol(name)
        author = case.value(right, {name: k})
        key = _component_of(case, calls[0])
        shares = [case.own(x) * k for space in reactions.null_space for y, x in space.items() if y == key]
        if not shares:
            case.called(calls[0])  # what is not determined has no value
        if any(is_zero_everywhere(case.system, author - share).holds for share in shares or [0]):
            return Verdict(given, "statics", RIGHT, f"the self-stress {name}, of any size" if shares else "")
        true = " or ".join(f"Delta({letter}) = {readable_text(share)}" for share in shares)
        if shares and not is_zero(author):
            text = f"the size of a self-stress is free: with the {name} that eomgen prints it is {true}"
            return Verdict(given, "statics", UNDECIDED, reason=text)
        text = f"it is {true}" if shares else f"the balance determines {letter}: no self-stress changes it"
        return Verdict(given, "statics", WRONG, causes=(Cause("other", text, quantity=f"Delta({letter})"),))
    return None


def _component_of(case: Case, call: Call) -> str:
    """The component of a reaction that a function or a name of derivations asks for, as self-stresses have it."""
    reactions, names = case.quantities.reactions, case.system.scope.names
    if call.name == DERIVED:
        letters = [x.name for x in lettered(reactions, names).symbols]
        asked = call.name_at(0)
        return reactions.components[letters.index(asked)].name if asked in letters else ""
    of_body = len(call.args) == 2 and call.args[0] == call.args[1]  # along its own axes, as derivations have it
    return str(replace(call, args=call.args[:1])) if of_body else str(call)


# -------- impacts ---------------------------------------------------------------------------------------------
# Lambda_floor, y_after', T_before - T_after, impulse_x(rod): what `derive --impact` prints, with the solution put in.


LATER = re.compile(r"(?P<speed>\\dot\s*(?:\{\s*\\?\w+\s*\}|\\?\w+)|\b[A-Za-z]\w*')\s*\^\s*\{?\s*(?P<when>[-+])\s*\}?")
_WORD = r"(?:\\\w+\s*\{)?\s*"  # \mathrm{
ENERGY_WHEN = re.compile(rf"(?<![A-Za-z_])T\s*(?:\^|_)\s*\{{?\s*(?:(?P<later>\+|{_WORD}after)|-|{_WORD}before)\s*\}}*")
OF_IMPACT = re.compile(
    rf"_\s*\{{?\s*{_WORD}(?:after|before)\b|_after'|Lambda_|T_(?:before|after)\b|\bimpulse(?:_[xyz])?\s*\("
)
OF_CASES = re.compile(r"\b(?:D_(?:nn|nt|tt)|p_s|v_s|a_[sb])\b")  # letters of an impact that rubs
SAYS_NOTHING = "it holds whatever impulses and speeds are"
ENERGIES = ("T_before", "T_after")
MOST_CONTACTS = 4  # of a model of which also several that close at once are meant
LARGEST_FACTOR = 24


@dataclass(frozen=True)
class OfImpact:
    """An equation of an impact, over the symbols of that impact.

    Args:
        given: as it was written.
        written: with the names of the derivation.
        equations: of the impact.
        difference: left minus right, over impulses, speeds before and after.
    """

    given: str
    written: HandEquation
    equations: ImpactEquations
    difference: Scalar

    @staticmethod
    def of(case: Case, given: str, defined: Mapping[str, Expression] | None = None) -> Iterator[OfImpact]:
        """The equation in each impact that has its names, the simplest first; none where it is of no impact."""
        ending = [contact.name for contact in case.model.contacts if contact.unilateral]
        text = _named_when(given)
        if not ending or not (OF_IMPACT.search(text) or OF_CASES.search(text)):
            return
        written = case.reading.read(text, defined)
        if not _further(case, written) and not any(call.name.startswith("impulse") for call in written.calls):
            return  # the model's own names win
        own = [name for name in ending if any(_is_of(x, name) for x in written.names)]
        own += [
            x.name for call in written.calls if call.name == "impulse" for x in call.args if isinstance(x, Reference)
        ]
        named = [name for name in ending if name in own]
        further = [name for name in ending if name not in named]
        several = [[*named, name] for name in further] if len(ending) <= MOST_CONTACTS else []
        tried = [*([named] if named else []), *several, *([ending] if len(ending) <= MOST_CONTACTS else [])]
        for contacts in dict.fromkeys(tuple(x for x in ending if x in own) for own in tried):
            slides = case.impact(contacts)
            for found in (slides, *slides.others):
                with suppress(ExpressionError):
                    yield OfImpact.over(given, written, found)

    @staticmethod
    def over(given: str, written: HandEquation, found: ImpactEquations) -> OfImpact:
        """The equation in an impact, or in one of its courses.

        Raises:
            ExpressionError: a name in it is none of that impact.
        """
        scope, cases = found.system.scope, found.all_cases
        T = found.kinetic_energy
        later = substituted((T,), dict(zip(found.u, found.after, strict=True)))[0]
        own: dict[str, Scalar] = {x.name: cases.written_out(x) for x, _ in cases.letters}
        own |= {x.name: x for x in (*found.after, *found.along, *(row.impulse for row in found.rows))}
        names = {**scope.names, **own, **dict(zip(ENERGIES, (T, later), strict=True))}

        def called(call: Call) -> Scalar:
            owner, axis = call.args[0] if call.args else None, "xyz".find(call.name[-1])
            if call.name == "impulse" and isinstance(owner, Reference):
                row = next((row for row in found.rows if row.name == owner.name), None)
                if row is not None:
                    return row.impulse
            vector = found.of_joints.get(owner.name) if isinstance(owner, Reference) else None
            if call.name.startswith("impulse_") and vector is not None:
                known: Scalar = vector[axis]
                return known
            raise ExpressionError(f"'{call}' is no part of an impact", max(call.column, 0))

        left, right = (side_value(side, names, called, lambda x: x) for side in (written.left, written.right))
        return OfImpact(given, written, found, left - right)

    @property
    def system(self) -> System:
        return self.equations.system

    def solved(self, difference: Scalar, changed: Mapping[Node, Scalar] | None = None) -> Scalar:
        """The difference with impulses and speeds after it as the impact gives them, with changed parameters."""
        solution = self.equations.solution
        values = substituted(tuple(solution.values()), changed) if changed else tuple(solution.values())
        difference = substituted((difference,), self.equations.along)[0]
        return substituted((difference,), dict(zip(solution, values, strict=True)))[0]

    @cached_property
    def holds(self) -> bool | None:
        return is_zero_everywhere(self.system, self.solved(self.difference)).holds

    @property
    def verdict(self) -> Verdict:
        given = self.given
        if self.holds and self._is_identity:
            return Verdict(given, IMPACT, WRONG, causes=(Cause("other", SAYS_NOTHING, quantity="what is equated"),))
        if self.holds is not False:
            return Verdict(given, IMPACT, RIGHT if self.holds else UNDECIDED, self.of_contacts + self.within)
        left = short_text(self.solved(self.difference), self.system.scope.positive)
        return Verdict(given, IMPACT, WRONG, difference=left, causes=(self.cause,))

    @property
    def of_contacts(self) -> str:
        """ "the impact of floor", where it may be of others, or friction has a part; "" elsewhere."""
        several = sum(x.unilateral for x in self.system.scope.model.contacts) > 1 or self.equations.own_course
        return f"the impact of {', '.join(self.equations.contacts)}" if several else ""

    @property
    def within(self) -> str:
        """The course of friction in words, with its bounds; "" where there is one."""
        course = self.equations.own_course
        name = " as long as it slides on" if course is None or not self.equations.slides else f" where it {course.name}"
        return "" if course is None else f"{name}, while {' and '.join(course.within)}"

    @property
    def _is_identity(self) -> bool:
        """True if it holds whatever impulses and speeds are, and has some of them."""
        has = {x.name for x in self.equations.solution} | {*ENERGIES}
        return bool(has & self.written.names) and is_zero_everywhere(self.system, self.difference).holds is True

    @property
    def cause(self) -> Cause:
        """Why it is wrong: one sign, one factor, the restitution left out; else what is right."""
        e = [x for row in self.equations.rows if row.e is not None for x in symbols_of((row.e,))]
        for symbol in dict.fromkeys(e):
            (turned,) = substituted((self.difference,), {symbol: -symbol})
            if self._vanishes(turned):
                text = f"{symbol.name} has the other sign"
                return Cause("sign", text, term=symbol.name, quantity=f"the restitution {symbol.name}")
        if e and self._vanishes(self.difference, {symbol: 0 for symbol in e}):
            text = "this is the impact without rebound: the restitution is missing"
            return Cause("missing_term", text, term=e[0].name, quantity="the restitution")
        for x in self.equations.solution:
            if (found := self._of_factor(x)) is not None:
                return found
        left = self.written.left.code
        (kind, name), alone = left[0], len(left) == 1
        for x, known in self.equations.solution.items():
            if alone and kind == "name" and x.name == name:
                return Cause("other", f"it is {name} = {readable_text(known)}", quantity=str(name))
        return Cause("other", "impulses and speeds of the impact do not satisfy it", quantity="the balance")

    def _vanishes(self, difference: Scalar, changed: Mapping[Node, Scalar] | None = None) -> bool:
        return bool(is_zero_everywhere(self.system, self.solved(difference, changed)).holds)

    def _of_factor(self, x: Node) -> Cause | None:
        """The cause that an unknown stands with a wrong factor in it; None: no one number makes it right."""
        (slope,) = gradient(self.difference, (x,))
        if is_zero(slope) or depends_on(slope, (x,)):
            return None
        (rest,) = substituted((self.difference,), {x: 0})
        found: list[float] = []
        for state in islice(
            states_of(self.system, (self.difference,), on_constraints=bool(self.system.constraints.J)), 3
        ):
            values = {node: float(value) for node, value in state.items()}
            try:
                a, b = evaluate((self.solved(rest), self.solved(slope * x)), values, FLOAT)
                found.append(float(-a / b))
            except (NoValue, ZeroDivisionError, KeyError):
                return None
        factor = Fraction(found[0]).limit_denominator(LARGEST_FACTOR) if found and isfinite(found[0]) else Fraction(0)
        if factor in (0, 1) or not self._vanishes(rest + slope * factor * x):
            return None
        alone = self.written.left.code == (("name", x.name),)
        if factor == -1:
            text = "the right side has the other sign" if alone else f"{x.name} has the other sign"
            return Cause("sign", text, term=x.name, quantity=x.name)
        text = f"the right side has the factor {factor} too much" if alone else f"{x.name} lacks the factor {factor}"
        return Cause("factor", text, term=x.name, quantity=x.name)


def of_impact(
    case: Case, judged: Callable[[str], Verdict] | None, given: str, defined: Mapping[str, Expression] | None = None
) -> Verdict | None:
    """The verdict on an equation of an impact, as `derive --impact` prints it; None: it is no such.

    Args:
        judged: of what speaks of an instant the judge of it, with the formula in the place of its impulse or speed.
    Raises:
        ExpressionError: it cannot be read.
    """
    try:
        found = [list(x) for _, x in groupby(OfImpact.of(case, given, defined), lambda x: x.equations.contacts)]
        if judged is not None:
            formula = next((x for x in map(_in_state, found) if x), "")
            return replace(judged(formula), given=given) if formula else None
        verdicts = list(map(_of_one_impact, found))
    except DerivationError as error:
        return Verdict(given, IMPACT, UNDECIDED, reason=error.what)
    return next(filter(None, verdicts), verdicts[0]) if verdicts else _of_other_names(case, given, defined)


def _of_one_impact(found: Sequence[OfImpact]) -> Verdict:
    """The verdict on an equation in an impact: of a contact that rubs, in which of its courses it is right."""
    verdicts = [each.verdict for each in found]
    right = [each for each, verdict in zip(found, verdicts, strict=True) if verdict]
    if not right:
        return verdicts[0]
    partly = len(right) < len(right[0].equations.all_cases.courses)
    within = " or".join(each.within for each in right) if partly else ""
    return Verdict(found[0].given, IMPACT, RIGHT, right[0].of_contacts + within)


def _of_other_names(case: Case, given: str, defined: Mapping[str, Expression] | None) -> Verdict | None:
    """The verdict on an equation with names as those of impacts which no impact has; None: it has none."""
    text = _named_when(given)
    if not any(contact.unilateral for contact in case.model.contacts) or not OF_IMPACT.search(text):
        return None
    unknown = [x for x in _further(case, case.reading.read(text, defined)) if OF_IMPACT.search(f"{x}'")]
    reason = "; ".join(f"unknown name '{x}': no impact has it" for x in unknown)
    return Verdict(given, IMPACT, UNDECIDED, reason=reason, unknown=tuple(unknown)) if unknown else None


def _in_state(found: Sequence[OfImpact]) -> str:
    """An equation for one impulse or speed after an impact, with its formula (of each course) there; "": no such."""
    value: Scalar = 0
    for each in found:
        solution = {**each.equations.solution, **each.equations.along}
        x = next((x for x in solution if each.written.left.code == (("name", x.name),)), None)
        if x is None or each.written.right.names & {y.name for y in solution}:
            return ""
        value = value + each.solved(x) * each.equations.counts
    return f"{to_text(value)} = {found[0].written.given.partition('=')[2]}"


def impact_judged(case: Case, verdict: Verdict, defined: Mapping[str, Expression] | None) -> JudgedEquation | None:
    """The equation of an impact as its verdict is decided again by numbers; None: nothing was decided."""
    equations = case.parts.equations
    if verdict.verdict == UNDECIDED or equations is None or any(x.text == SAYS_NOTHING for x in verdict.causes):
        return None
    found = list(OfImpact.of(case, verdict.given, defined))
    x = next((x for x in found if x.holds is (verdict.verdict == RIGHT)), found[0])
    sides = (verdict.given, x.written.left, x.written.right)
    struck = (x.equations, x.difference)
    return JudgedEquation(*sides, IMPACT, verdict.verdict == RIGHT, verdict.up_to, equations, impact=struck)


def _further(case: Case, written: HandEquation) -> list[str]:
    """Names that the model does not have."""
    return [name for name in written.names if name not in case.system.scope.names and name not in ("t", "pi")]


def _named_when(given: str) -> str:
    """y'^+ as y_after', y'^- as y', T^+ as T_after."""

    def speed(found: re.Match[str]) -> str:
        bare = re.sub(r"\\dot|[{}\s']", "", found["speed"]).lstrip("\\")
        return f"{bare}_after'" if found["when"] == "+" else f"{bare}'"

    text = ENERGY_WHEN.sub(lambda found: ENERGIES[found["later"] is not None], given)
    return LATER.sub(speed, text)


def _is_of(symbol: str, contact: str) -> bool:
    return symbol == f"Lambda_{contact}" or symbol.startswith(f"Lambda_{contact}_")
