"""Text, LaTeX or sympy of somebody -> both sides of an equation over the names of a model.

The text grammar of the model file is tried first, then what people write otherwise (`handwriting`). T, V, L, Q(theta),
T(rod) and the letters of reactions (B_x, N_floor) stand for functions of the outputs, unless the model has such names.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from typing import Any

from eomgen.documents import NamedQuantity, RequestedReaction, named_quantities, notation_of, requested_reactions
from eomgen.errors import DerivationError, ExpressionError
from eomgen.frozen import dataclass
from eomgen.judge.alphabet import Vocabulary, vocabulary
from eomgen.judge.handwriting import RATE, Transcript, transcript
from eomgen.judge.written_pages import WrittenNumber, in_one_formula, measured
from eomgen.mechanics.dynamics import System
from eomgen.model import FUNCTIONS
from eomgen.symbolic.expression import (
    SLOPE,
    Call,
    Expression,
    Reference,
    Scalar,
    is_zero,
    parse,
    parse_equation,
)

LETTERS = {"T": "kinetic_energy", "V": "potential_energy", "Q": "generalized_force", "p": "momentum"}
"""letter -> the function that it stands for"""
FREQUENCY = re.compile("(omega|f|T|tau)(?:_?([0-9n]))?")
"""the letter of a frequency of small motions, in radians or cycles, or of its period, and its number"""
ALONE = {"K": "kinetic_energy", "W": "potential_energy"}
"""letters that stand for energies where they are the left side"""
ONLY = {"reaction_n": ("N",), "tension": ("S", "F_S", "F_T", "S_1", "S1"), "reaction_t": ("F_f", "F_R", "R")}
"""function of a reaction -> letters of the only one there is"""
FRICTION = frozenset(ONLY["reaction_t"])
MULTIPLIER = "lam"  # of a constraint row: lam(constraint, 1)
DERIVED = "derived"  # what a derivation names and no output is: derived(Q_theta_motor)


@dataclass(frozen=True)
class HandEquation:
    """An equation of somebody.

    Args:
        given: as it was written.
        left, right: its sides, letters replaced by the functions that they stand for.
        letters: those in it that stand for one function, by its text.
        name: the letter that is its left side; "" where that is a formula.
        measured: its right side, where that is a number, with a unit or without.
    """

    given: str
    left: Expression
    right: Expression
    letters: Mapping[str, str] = field(default_factory=dict)
    name: str = ""
    measured: WrittenNumber | None = None

    @property
    def difference(self) -> Expression:
        return self.left - self.right

    @property
    def names(self) -> frozenset[str]:
        return self.left.names | self.right.names

    @property
    def calls(self) -> tuple[Call, ...]:
        """The functions of the motion in it, those whose rate is taken too."""
        return (*calls_in(self.left), *calls_in(self.right))

    def with_names(self, meanings: Mapping[str, Expression]) -> HandEquation:
        """The same, formulas in the place of names."""

        def meant(kind: str, what: Any) -> Expression | None:
            return meanings.get(what) if kind == "name" else None

        return replace(self, left=_replaced(self.left, meant), right=_replaced(self.right, meant))

    def with_calls(self, meanings: Mapping[str, Expression]) -> HandEquation:
        """The same, formulas in the place of functions by their texts, also where one is differentiated."""

        def meant(kind: str, what: Any) -> Expression | None:
            if kind != "call":
                return None
            if str(what) not in meanings and what.name in (SLOPE, RATE):
                args = tuple(_replaced(x, meant) if isinstance(x, Expression) else x for x in what.args)
                return _of_call(replace(what, args=args))
            return meanings.get(str(what))

        return replace(self, left=_replaced(self.left, meant), right=_replaced(self.right, meant))

    @property
    def takes_rates(self) -> bool:
        """True if the rate of something else than a coordinate stands in it."""
        return any(call.name == RATE for call in (*self.left.calls, *self.right.calls))


def _replaced(side: Expression, meant: Callable[[str, Any], Expression | None]) -> Expression:
    """A side with formulas in the place of some of its pieces.

    Args:
        meant: (kind, what) of a piece -> the formula; None: the piece stays.
    """
    pieces = (((kind, what), meant(kind, what)) for kind, what in side.code)
    code = tuple(x for piece, formula in pieces for x in ((piece,) if formula is None else formula.code))
    return Expression(side.text, code, (-1,) * len(code))


def calls_in(side: Expression) -> Iterator[Call]:
    for call in side.calls:
        if call.name != RATE:
            yield call
        for argument in call.args if call.name == RATE else ():
            yield from calls_in(argument) if isinstance(argument, Expression) else ()


def of_free_coordinates(written: HandEquation) -> HandEquation:
    """The same, energies differentiated as if no coordinate followed from others."""
    letters = dict(written.letters)

    def freed(side: Expression) -> Expression:
        return replace(side, code=tuple((kind, called(x) if kind == "call" else x) for kind, x in side.code))

    def called(call: Call) -> Call:
        if call.name == RATE:
            return replace(call, args=tuple(freed(x) if isinstance(x, Expression) else x for x in call.args))
        if call.name not in (SLOPE, DERIVED):
            return call
        other = replace(call, args=(*call.args, Reference("free")))
        letters[str(other)] = letters[str(call)]
        return other

    left, right = freed(written.left), freed(written.right)
    return replace(written, left=left, right=right, letters=letters)


def along_ground_axes(written: HandEquation) -> HandEquation:
    """The same, letters of a joint's forces in space along the ground's axes; itself where it has none of these."""
    letters = dict(written.letters)

    def along(call: Call) -> Call:
        if str(call) not in letters or not call.name.startswith("reaction_") or len(set(call.args)) == len(call.args):
            return call
        other = replace(call, args=call.args[:1])
        letters[str(other)] = letters[str(call)]
        return other

    left, right = (
        replace(side, code=tuple((kind, along(x) if kind == "call" else x) for kind, x in side.code))
        for side in (written.left, written.right)
    )
    return replace(written, left=left, right=right, letters=letters) if len(letters) > len(written.letters) else written


def side_value(
    side: Expression, names: Mapping[str, Scalar], called: Callable[[Call], Scalar], rate: Callable[[Scalar], Scalar]
) -> Scalar:
    """A side over scalars; d/dt of a formula is taken of its value.

    Raises:
        ExpressionError: an unknown name or function.
    """

    def value(call: Call) -> Scalar:
        if call.name != RATE:
            return called(call)
        if len(call.args) != 1:
            raise ExpressionError("d/dt is of one formula", max(call.column, 0))
        (argument,) = call.args
        if not isinstance(argument, Expression):
            argument = parse(argument.name)
        return rate(argument.evaluate(names, value))

    return side.evaluate(names, value)


@dataclass(frozen=True)
class DerivedNames:
    """Names that derivations have for quantities.

    Args:
        quantities: all of them by name.
        taken: names of the model, and letters: of these the model's meaning comes first.
        meanings: what each name stands for.
        pattern: of names that text alone has, Q(x, joint of cart); None where there is none.
        texts: {such a name without blanks: its name of the grammar}.
    """

    quantities: Mapping[str, NamedQuantity]
    taken: frozenset[str]
    meanings: Mapping[str, Expression]
    pattern: re.Pattern[str] | None
    texts: Mapping[str, str]

    @classmethod
    def of(cls, system: System, taken: Iterable[str]) -> DerivedNames:
        """The names of a system, beside those that are taken."""
        quantities, known = {x.name: x for x in named_quantities(system)}, frozenset(taken)
        meanings = {
            name: parse(x.call, references=True) if x.call else _called(DERIVED, Reference(name))
            for name, x in quantities.items()
        }
        texts = {_flat(x.text): name for name, x in quantities.items() if x.text and name not in known}
        spaced = [r"\s*".join(map(re.escape, re.findall(r"\w+|\S", quantities[name].text))) for name in texts.values()]
        longest = "|".join(sorted(spaced, key=len, reverse=True))
        pattern = re.compile(rf"(?<![\w.])(?:{longest})(?!\w)") if texts else None
        return cls(quantities, known, meanings, pattern, texts)

    @property
    def typeset(self) -> dict[str, str]:
        """{as derivations set it: name}, of what is not taken."""
        free = [x for name, x in self.quantities.items() if name not in self.taken]
        return {x.typeset: x.name for x in free if x.typeset} | {x.name: x.name for x in free}

    def shown(self, name: str) -> str:
        """A letter as its author has it: of a derivation its own text."""
        return (self.quantities[name].text or name) if name in self.quantities and name not in self.taken else name

    def named_in(self, text: str, c_is_taken: bool) -> str:
        """The text with names of the grammar; beside more c(x') is a product where c is a name of the model."""

        def named(found: re.Match[str]) -> str:
            alone = not text[: found.start()].strip() and text[found.end() :].lstrip().startswith("=")
            may_be_product = found[0].startswith("c") and c_is_taken and not alone
            return found[0] if may_be_product else self.texts.get(_flat(found[0]), found[0])

        return text if self.pattern is None else self.pattern.sub(named, text)


@dataclass(frozen=True)
class Reading:
    """Reads equations about one system."""

    system: System

    @property
    def vocabulary(self) -> Vocabulary:
        """Names, functions, and how names are set in LaTeX."""
        own_names = [name for name in self.system.scope.names if "(" not in name]  # M( is a table
        names = [*own_names, *self.letters, *self.system.scope.model.outputs]
        notation = notation_of(self.system.scope.model)
        own = [name for name in own_names if "'" not in name]
        letters = [letter for letter in LETTERS if letter not in (*own_names, *self.system.scope.model.tables)]
        set_as = {name: notation.latex(name) for name in own}
        tables = self.system.scope.model.tables
        return vocabulary(names, (*FUNCTIONS, *letters, MULTIPLIER), set_as, self.derived.typeset, tables)

    @cached_property
    def derived(self) -> DerivedNames:
        """Names that derivations of the model have for its quantities."""
        return DerivedNames.of(self.system, {*self.system.scope.names, *self.letters})

    def as_derived(self, given: Any, defined: Mapping[str, Expression] | None = None) -> HandEquation | None:
        """The same equation, names of outputs taken for what derivations name so: omega_disc; None where none is."""
        outputs = self.system.scope.model.outputs
        taken = outputs.keys() | self._energies.keys()  # L, the Lagrangian, is an angular momentum too
        doubly = {name: formula for name, formula in self.derived.meanings.items() if name in taken}
        doubly |= {letter: formula for letter, formula in self._energies.items() if letter in outputs}
        if not doubly or not isinstance(given, str):
            return None
        sides, _ = self._written_sides(given)
        if not any(name in doubly for side in sides for name in side.names):
            return None
        return self._read_sides(given, *sides, {**(defined or {}), **doubly})

    def _plain(self, given: str) -> str:
        """The text with names of the grammar for those that stand in texts of derivations alone."""
        given = in_one_formula(given)
        return given if "\\" in given else self.derived.named_in(given, "c" in self.system.scope.names)

    @property
    def letters(self) -> dict[str, Expression]:
        """Names that stand for formulas, the first that says so: outputs of the file and their symbols, symbols of
        reactions, T, V, L, letters of reactions and inertias, B_x, J_O.
        """
        model = self.system.scope.model
        own = {*self.system.scope.names, *model.tables}
        found = {name: output.value for name, output in model.outputs.items() if output.at is None and not output.from_}
        for name, symbol in ((name, model.outputs[name].symbol) for name in tuple(found)):
            if symbol is not None:
                found.setdefault(plain_name(symbol.base, symbol.below), found[name])
        for letter, call in self._declared_letters():
            found.setdefault(letter, _called(call.name, *call.args))
        found = {**self._energies, **found}
        for letter, call in self._reactions():
            found.setdefault(letter, _called(call.name, *call.args))
        for kind, letters in ONLY.items():
            of_kind = [_called(x.name, *x.args) for each, x in self.requested if each.function == kind]
            for letter in letters if len(of_kind) == 1 else ():
                found.setdefault(letter, of_kind[0])
            for k, formula in enumerate(of_kind if kind == "tension" and len(of_kind) > 1 else (), start=1):
                found = {f"S_{k}": formula, f"S{k}": formula} | found
        for letter, formula in self._plain_letters:
            found.setdefault(letter, formula)
        points = model.named_points if model.space == "plane" and model.bodies else ()
        found |= {f"{letter}_{x}": _called("inertia_point", Reference(x)) for x in points for letter in "JI"} | found
        return {letter: formula for letter, formula in found.items() if letter not in own}

    @property
    def _plain_letters(self) -> Iterator[tuple[str, Expression]]:
        """Letters that stand for what is alone of its kind.

        B for the only force of the support B, A_H and A_V for those along x and y of A, S_AC for the member of the
        only truss, J_S for the moment of inertia of the only body with mass about its mass centre, M for the torque of
        the only drive.
        """
        model = self.system.scope.model
        forces: dict[str, list[Call]] = {}
        for each, call in self.requested:
            forces.setdefault(each.owner, []).append(call)
        for owner, calls in forces.items():
            if len(calls) == 1 and owner in model.constraints:
                yield owner, _called(calls[0].name, *calls[0].args)
            for letter, axis in (("H", "x"), ("V", "y")) if model.space == "plane" else ():
                yield f"{owner}_{letter}", _called(f"reaction_{axis}", Reference(owner))
        trusses: dict[str, tuple[str, ...]] = {
            name: getattr(part, "members", ()) for name, part in model.constraints.items() if part.kind == "truss"
        }
        for truss, members in trusses.items() if len(trusses) == 1 else ():
            for member in members:
                tension, (a, _, b) = parse(f"tension({truss}, {member})", references=True), member.partition("-")
                yield from ((f"{x}_{ends}", tension) for x in "SFN" for ends in (f"{a}{b}", f"{b}{a}", f"{a}_{b}"))
        driven = [name for name, q in model.coordinates.items() if q.driven]
        joints = (body.joint for body in model.bodies.values() if body.joint is not None)
        turns = [str(getattr(joint, "angle", None)) for joint in joints if joint.kind == "revolute"]
        if len(driven) == 1 and driven[0] in turns:
            yield "M", _called("drive", Reference(driven[0]))
        heavy = [body for body in model.bodies if not is_zero(self.system.scope.mass_properties(body).m)]
        if len(heavy) == 1 and model.space == "plane":
            center = _called("inertia_point", Reference(f"{heavy[0]}.center"), Reference(heavy[0]))
            yield from ((f"{letter}_{of}", center) for letter in ("J", "I", "Theta") for of in "SCG")

    @property
    def _energies(self) -> dict[str, Expression]:
        T, V = (_called(LETTERS[letter]) for letter in ("T", "V"))
        letters = dict.fromkeys(("E_kin", "E_k", "Ekin"), T) | dict.fromkeys(("E_pot", "E_p", "Epot", "U"), V)
        return {"T": T, "V": V, "L": T - V, **letters}

    @cached_property
    def requested(self) -> tuple[tuple[RequestedReaction, Call], ...]:
        """(a reaction that can be requested, how); none where something acts at no place."""
        found = []
        with suppress(DerivationError):
            for each in requested_reactions(self.system):
                strand = (Expression.number(int(each.number)),) if each.number else ()
                found.append((each, Call(each.function, (Reference(each.argument), *strand))))
        return tuple(found)

    def _declared_letters(self) -> Iterator[tuple[str, Call]]:
        """The symbols that joints and constraints give their reactions, as plain names, and what each stands for."""
        for each, call in self.requested:
            if each.declared is not None:
                yield plain_name(each.declared.base, each.declared.below), call

    def _as_derived(self, call: Call, owner: str) -> Call:
        """A component in the axes in which derivations have it: in space a joint's along those of its body."""
        model = self.system.scope.model
        of_joint = model.space == "space" and owner in model.bodies and call.args == (Reference(owner),)
        forces = ("reaction_x", "reaction_y", "reaction_z")
        return replace(call, args=(*call.args, Reference(owner))) if of_joint and call.name in forces else call

    def _reactions(self) -> Iterator[tuple[str, Call]]:
        """Letters of reactions and multipliers, and the function that each stands for."""
        model = self.system.scope.model
        for each, call in self.requested:
            yield from ((letter, self._as_derived(call, each.owner)) for letter in each.letters)
        joints = {name: body.joint.symbol for name, body in model.bodies.items() if body.joint is not None}
        owners = {**dict.fromkeys(model.constraints), **joints}
        for name, symbol in owners.items():
            letter = name if symbol is None or symbol.letter is None else symbol.letter.text
            for axis in ("x", "y", "z") if model.space == "space" else ("x", "y"):
                yield f"{letter}_{axis}", self._as_derived(Call(f"reaction_{axis}", (Reference(name),)), name)
            if model.space == "plane":
                yield f"M_{letter}", Call("reaction_couple", (Reference(name),))
        for row in self.system.constraints.closing:
            multiplier = Call(MULTIPLIER, (Reference(row.constraint), Expression.number(row.number)))
            yield f"lambda_{row.constraint}_{row.number}", multiplier

    def read(self, given: Any, defined: Mapping[str, Expression] | None = None) -> HandEquation:
        """Both sides of an equation.

        Args:
            defined: letters of the author's own, and what they stand for.
        Raises:
            ExpressionError: it cannot be read; column and length say where in what was given.
        """
        if not isinstance(given, str):
            given = text_of_sympy(given)
        sides, number = self._written_sides(given)
        return replace(self._read_sides(given, *sides, defined), measured=number)

    def _written_sides(self, given: str) -> tuple[tuple[Expression, Expression], WrittenNumber | None]:
        """(both sides as they are written, the right one where it is a number), a number with its unit in SI."""
        plain = self._plain(given)
        head, sign, tail = plain.rpartition("=")
        number = measured(tail) if sign and "=" not in head else None
        if number is not None and not (number.unit and self._may_be_product(number.unit)):
            plain = f"{head}= {number.exact if number.unit else number.text}"
        return self._sides(plain), number

    def _may_be_product(self, unit: str) -> bool:
        """True if what stands behind a number may be a product of names of the model: 2 m."""
        return all(word in self.system.scope.names for word in re.findall(r"[^\W\d_]+", unit))

    def otherwise(self, given: Any, defined: Mapping[str, Expression] | None = None) -> HandEquation | None:
        """The same, letters as they are often meant: friction the other way, a and v of the only coordinate or body."""
        if not isinstance(given, str):
            return None
        sides, _ = self._written_sides(given)
        names = {name for side in sides for name in side.names} - self.system.scope.names.keys()
        model, meant = self.system.scope.model, dict[str, Expression]()
        for letter in names & FRICTION & self.letters.keys():
            meant[letter] = Expression.number(0) - self.letters[letter]
        free = [q for q, x in model.coordinates.items() if not x.driven and not x.dependent]
        if len(free) == 1:
            rates = (("a", "''"), ("v", "'"), ("v'", "''"))
            meant |= {x: parse(free[0] + dots) for x, dots in rates if x in names - {*self.letters}}
        heavy = [body for body in model.bodies if not is_zero(self.system.scope.mass_properties(body).m)]
        if "v" in names - {*self.letters} and len(free) > 1 and len(heavy) == 1:
            meant["v"] = _called("speed", Reference(f"{heavy[0]}.center"))
        return self._read_sides(given, *sides, {**(defined or {}), **meant}) if meant else None

    def with_unit(self, given: Any, defined: Mapping[str, Expression] | None = None) -> HandEquation | None:
        """The same, what stands behind the number on the right taken for its unit; None where that is so already."""
        if not isinstance(given, str):
            return None
        head, sign, tail = self._plain(given).rpartition("=")
        number = measured(tail) if sign and "=" not in head else None
        if number is None or not number.unit or not self._may_be_product(number.unit):
            return None
        return replace(self._read_sides(given, *self._sides(f"{head}= {number.exact}"), defined), measured=number)

    def _read_sides(
        self, given: str, left: Expression, right: Expression, meanings: Mapping[str, Expression] | None = None
    ) -> HandEquation:
        """The equation of two sides; letters by `meanings` first."""
        name = left.code[0][1] if len(left.code) == 1 and left.code[0][0] == "name" else ""
        left = self._alone(left, right)
        known = {**self.derived.meanings, **self.letters, **(meanings or {})}
        used = {name: formula for name, formula in known.items() if name in left.names | right.names}
        letters = {
            str(x.calls[0]): self.derived.shown(name) for name, x in used.items() if len(x.code) == 1 and x.calls
        }
        left, right = self._meant(left, known), self._meant(right, known)
        slopes = (call for side in (left, right) for call in calls_in(side) if call.name == SLOPE)
        letters |= {str(call): f"d{call.args[0]}/d{call.args[1]}" for call in slopes}
        return HandEquation(given, left, right, letters, name)

    def _alone(self, left: Expression, right: Expression) -> Expression:
        """A letter alone on the left that the model does not have.

        omega_0 or its square, f and T are a frequency of small motions and its period, K and W energies, v and a rate
        and acceleration of the one free coordinate.
        """
        names = self.system.scope.names
        moving = any("'" in name or name in self.system.scope.model.coordinates for name in right.names)
        letter = left.code[0][1] if left.code and left.code[0][0] == "name" else ""
        rest = left.code[1:]
        if letter in names or rest not in ((), (("number", 2), ("^", None))):
            return left
        formula = None if moving else _of_small_motions(letter, right, letter in self.letters)
        if formula is None and letter in self.letters:
            return left
        if formula is None and letter in ALONE and letter not in self.system.scope.model.outputs:
            formula = _called(ALONE[letter])
        if formula is not None:
            return Expression(left.text, (*formula.code, *rest), (-1,) * (len(formula.code) + len(rest)))
        free = [q for q, x in self.system.scope.model.coordinates.items() if not x.driven]
        dots = {"v": "'", "a": "''"}.get(letter)
        if dots is None or len(free) != 1 or free[0] + dots not in names:
            return left
        return Expression(left.text, (("name", free[0] + dots), *rest), (0, *(-1 for _ in rest)))

    def _sides(self, given: str) -> tuple[Expression, Expression]:
        """The sides, by the grammar where that knows all names, else as handwriting."""
        plain: ExpressionError | None = None
        try:
            found = parse_equation(given)
            if all(self._is_known(name) for side in found for name in side.names) and all(
                call.name in self.vocabulary.functions and not self._is_of_time(call)
                for side in found
                for call in side.calls
            ):
                return found
        except ExpressionError as error:
            plain, found = error, None
        try:
            written = transcript(given, self.vocabulary)
            return self._parsed(written)
        except ExpressionError as error:
            if found is not None:
                return found
            raise (error if plain is None or "\\" in given else plain) from None

    def _parsed(self, written: Transcript) -> tuple[Expression, Expression]:
        parts = written.text.split("=")
        if len(parts) == 2 and all(part.strip() for part in parts):
            sides, start = [], 0
            for part in parts:
                try:
                    sides.append(parse(part, references=True))
                except ExpressionError as error:
                    column = written.column(start + error.column)
                    raise ExpressionError(error.what, column, error.fix, error.length) from error
                start += len(part) + 1
            return sides[0], sides[1]
        if len(parts) < 2:
            raise ExpressionError("it is no equation", 0, "write left = right", max(1, len(written.columns)))
        places = [k for k, c in enumerate(written.text) if c == "="]
        at = places[1] if len(parts) > 2 else places[0]
        what = "two equality signs" if len(parts) > 2 else "a side is missing beside '='"
        raise ExpressionError(what, written.column(at), "write one equation, left = right")

    def _is_of_time(self, call: Call) -> bool:
        """x(t): a coordinate, and no function of a point."""
        return call.name in self.system.scope.names and call.args == (Reference("t"),)

    def _is_known(self, name: str) -> bool:
        return name.rstrip("'") in self.vocabulary.names

    def _energy(self, argument: Reference | Expression) -> Expression:
        """T, V, L or T(rod) of which a derivative is taken, under the text that the author has for it."""
        written = _formula(argument) if isinstance(argument, Reference) else argument
        T, V = (_called(LETTERS[letter]) for letter in ("T", "V"))
        formula = {"T": T, "V": V, "L": T - V}.get(written.text) or self._meant(written)
        return Expression(written.text, formula.code, formula.columns)

    def _meant(self, side: Expression, known: Mapping[str, Expression] | None = None) -> Expression:
        """A side with letters replaced by the functions that they stand for."""
        own = self.system.scope.names
        known = {**self.derived.meanings, **self.letters} if known is None else known
        tables = self.system.scope.model.tables

        def meant(kind: str, what: Any) -> Expression | None:
            if kind == "name" and what not in own and what in known:
                return known[what]
            if kind == "name" and what not in own and what.rstrip("'") in known:  # the rate of a letter
                rate = known[what.rstrip("'")]
                for _ in range(len(what) - len(what.rstrip("'"))):
                    rate = _called(RATE, rate)
                return rate
            if kind != "call":
                return None
            if what.name == RATE:
                args = (self._meant(_formula(x), known) for x in what.args)
                return _of_call(replace(what, args=tuple(args)))
            if what.name == SLOPE:
                return _of_call(replace(what, args=(self._energy(what.args[0]), _formula(what.args[1]))))
            is_letter = what.name in LETTERS and what.name not in tables
            return _of_call(replace(what, name=LETTERS[what.name])) if is_letter else None

        found = _replaced(side, meant)
        return replace(found, columns=side.columns) if len(found.code) == len(side.code) else found


def _flat(text: str) -> str:
    return "".join(text.split())


def _of_small_motions(letter: str, right: Expression, taken: bool) -> Expression | None:
    """The frequency, or the period, that a letter stands for beside such a right side; None where it is none.

    Args:
        taken: the letter has another meaning: T of an energy is a period where pi and a root stand behind it.
    """
    found = FREQUENCY.fullmatch(letter)
    rooted = any(kind in ("call", "function") and "sqrt" in str(what) for kind, what in right.code)
    if found is None or (found[1] != "omega" and not ("pi" in right.names and rooted)) or (taken and found[1] != "T"):
        return None
    number = Expression.number(int(found[2]) if (found[2] or "").isdigit() and found[2] != "0" else 1)
    frequency, circle = _called("frequency", number), parse("2*pi")
    if found[1] == "omega":
        return frequency
    return frequency / circle if found[1] == "f" else circle / frequency


def _formula(argument: Reference | Expression) -> Expression:
    return argument if isinstance(argument, Expression) else parse(argument.name)


def plain_name(*parts: str) -> str:
    """A symbol, its base and its index, as a name of the text grammar: F_{\\mathrm{S}} is F_S."""
    pieces = (re.sub(r"\\(?:mathrm|text|mathit|mathbf|mathsf)\b|[^\w]", "", x) for x in parts)
    return "_".join(filter(None, pieces))


def _called(name: str, *args: Any) -> Expression:
    return _of_call(Call(name, tuple(args)))


def _of_call(call: Call) -> Expression:
    return Expression(str(call), (("call", call),), (0,))


def text_of_sympy(given: Any) -> str:
    """The text of a sympy equation; an expression is what is 0. Functions of t are coordinates, derivatives rates.

    Raises:
        ExpressionError: it is no sympy expression, or holds what the grammar has not.
    """
    import sympy
    from sympy.core.function import AppliedUndef

    if not isinstance(given, (sympy.Expr, sympy.Equality)):
        raise ExpressionError(f"{given!r} is no equation", fix="give a text, LaTeX, or sympy.Eq(left, right)")
    rates = {}
    for each in sorted(given.atoms(sympy.Derivative), key=lambda e: -e.derivative_count):
        function, ((_, order), *rest) = each.expr, each.variable_count
        if rest or not isinstance(function, AppliedUndef):
            raise ExpressionError(f"{each} is no rate of a coordinate", fix="carry the derivative out: .doit()")
        rates[each] = sympy.Symbol(f"{type(function).__name__}{chr(39) * int(order)}")
    plain = given.xreplace(rates)
    plain = plain.xreplace({each: sympy.Symbol(type(each).__name__) for each in plain.atoms(AppliedUndef)})
    plain = plain.xreplace({x: sympy.Symbol(x.name) for x in plain.atoms(sympy.Symbol)})
    plain = plain.xreplace({x: sympy.Rational(str(x)) for x in plain.atoms(sympy.Float)})
    left, right = (plain.lhs, plain.rhs) if isinstance(plain, sympy.Equality) else (plain, sympy.Integer(0))
    text = f"{sympy.sstr(left)} = {sympy.sstr(right)}"
    return text.replace("Abs(", "abs(").replace("Max(", "max(").replace("Min(", "min(")
