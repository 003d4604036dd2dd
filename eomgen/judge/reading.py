"""What somebody wrote, text, LaTeX or sympy -> both sides of an equation over the names of a model.

The text grammar of the model file is tried first, then what people write otherwise (`handwriting`). T, V, L, Q(theta),
T(rod) and the letters of reactions (B_x, N_floor) stand for functions of the outputs, unless the model has such names.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from eomgen.documents.latex_names import notation_of
from eomgen.documents.reaction_names import reaction_name
from eomgen.errors import DerivationError, ExpressionError
from eomgen.judge.handwriting import Transcript, Vocabulary, transcript, vocabulary
from eomgen.mechanics.balance.balance import balance_of
from eomgen.mechanics.balance.named_reactions import named_reactions
from eomgen.mechanics.equations.system import System
from eomgen.model.outputs import FUNCTIONS
from eomgen.symbolic.expression.expressions import Call, Expression, Reference, parse, parse_equation
from eomgen.symbolic.expression.formula import Instruction

LETTERS = {"T": "kinetic_energy", "V": "potential_energy", "Q": "generalized_force", "p": "momentum"}
"""letter -> the function that it stands for"""
_FREQUENCY = re.compile("omega_?([0-9n])")
MULTIPLIER = "lam"  # of a closing row: lam(tie, 1)


@dataclass(frozen=True)
class HandEquation:
    """An equation of somebody.

    Args:
        given: as it was written.
        left, right: its sides, letters replaced by the functions that they stand for.
    """

    given: str
    left: Expression
    right: Expression

    @property
    def difference(self) -> Expression:
        return self.left - self.right

    @property
    def names(self) -> frozenset[str]:
        return self.left.names | self.right.names

    @property
    def calls(self) -> tuple[Call, ...]:
        return (*self.left.calls, *self.right.calls)


@dataclass(frozen=True)
class Reading:
    """How equations about one system are read."""

    system: System

    @cached_property
    def vocabulary(self) -> Vocabulary:
        """Names, functions, and how names are set in LaTeX."""
        names = [*self.system.scope.names, *self.letters]
        notation = notation_of(self.system.scope.model)
        own = [name for name in self.system.scope.names if "'" not in name]
        letters = [letter for letter in LETTERS if letter not in self.system.scope.names]
        set_as = {name: notation.latex(name) for name in own}
        return vocabulary(names, (*FUNCTIONS, *letters, MULTIPLIER), set_as)

    @cached_property
    def letters(self) -> dict[str, Call]:
        """Single letters that stand for functions: T, V, and those of the reactions, B_x."""
        found = {letter: Call(LETTERS[letter], ()) for letter in ("T", "V")}
        try:
            named = named_reactions(balance_of(self.system))
        except DerivationError:
            named = ()
        for each in named:
            function, _, arguments = each.name.removesuffix(")").partition("(")
            label = function.removeprefix("reaction_")
            if "," not in arguments and not label.startswith("couple_"):
                letter = reaction_name(label, each.owner)
                found.setdefault(letter, Call(function, (Reference(arguments),)))
        for row in self.system.ties.closing:
            multiplier = Call(MULTIPLIER, (Reference(row.tie), Expression.number(row.number)))
            found[f"lambda_{row.tie}_{row.number}"] = multiplier
        return {letter: call for letter, call in found.items() if letter not in self.system.scope.names}

    def read(self, given: Any) -> HandEquation:
        """Both sides of an equation.

        Raises:
            ExpressionError: it cannot be read; column and length say where in what was given.
        """
        if not isinstance(given, str):
            given = text_of_sympy(given)
        left, right = self._sides(given)
        left = self._frequency(left, right)
        return HandEquation(given, self._meant(left), self._meant(right))

    def _frequency(self, left: Expression, right: Expression) -> Expression:
        """omega_0, omega_1, ... alone on the left, which the model does not have: a frequency of small motions."""
        found = _FREQUENCY.fullmatch(left.text.strip())
        moving = any("'" in name or name in self.system.scope.model.coordinates for name in right.names)
        if found is None or moving or left.names & self.system.scope.names.keys():
            return left
        number = Expression.number(int(found[1]) if found[1].isdigit() and found[1] != "0" else 1)
        return Expression(left.text, (("call", Call("frequency", (number,))),), (0,))

    def _sides(self, given: str) -> tuple[Expression, Expression]:
        """The sides, by the grammar where that knows all names, else as handwriting."""
        plain: ExpressionError | None = None
        try:
            found = parse_equation(given)
            if all(self._is_known(name) for side in found for name in side.names) and all(
                call.name in self.vocabulary.functions for side in found for call in side.calls
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
                    raise ExpressionError(error.what, column, error.mend, error.length) from error
                start += len(part) + 1
            return sides[0], sides[1]
        if len(parts) < 2:
            raise ExpressionError("it is no equation", 0, "write left = right", max(1, len(written.columns)))
        places = [k for k, c in enumerate(written.text) if c == "="]
        at = places[1] if len(parts) > 2 else places[0]
        what = "two equality signs" if len(parts) > 2 else "a side is missing beside '='"
        raise ExpressionError(what, written.column(at), "write one equation, left = right")

    def _is_known(self, name: str) -> bool:
        return name.rstrip("'") in self.vocabulary.names

    def _meant(self, side: Expression) -> Expression:
        """A side with letters replaced by the functions that they stand for."""
        own = self.system.scope.names
        code: list[Instruction] = []
        for kind, what in side.code:
            if kind == "name" and what not in own and what in self.letters:
                code.append(("call", self.letters[what]))
            elif kind == "name" and what == "L" and what not in own:
                code += [("call", self.letters["T"]), ("call", self.letters["V"]), ("-", None)]
            elif kind == "call" and what.name in LETTERS:
                code.append(("call", replace(what, name=LETTERS[what.name])))
            else:
                code.append((kind, what))
        columns = side.columns if len(code) == len(side.code) else (-1,) * len(code)
        return Expression(side.text, tuple(code), columns)


def text_of_sympy(given: Any) -> str:
    """The text of a sympy equation; an expression is what is 0. Functions of t are coordinates, derivatives rates.

    Raises:
        ExpressionError: it is no sympy expression, or holds what the grammar has not.
    """
    import sympy
    from sympy.core.function import AppliedUndef

    if not isinstance(given, (sympy.Expr, sympy.Equality)):
        raise ExpressionError(f"{given!r} is no equation", mend="give a text, LaTeX, or sympy.Eq(left, right)")
    rates = {}
    for each in sorted(given.atoms(sympy.Derivative), key=lambda e: -e.derivative_count):
        function, ((_, order), *rest) = each.expr, each.variable_count
        if rest or not isinstance(function, AppliedUndef):
            raise ExpressionError(f"{each} is no rate of a coordinate", mend="carry the derivative out: .doit()")
        rates[each] = sympy.Symbol(f"{type(function).__name__}{chr(39) * int(order)}")
    plain = given.xreplace(rates)
    plain = plain.xreplace({each: sympy.Symbol(type(each).__name__) for each in plain.atoms(AppliedUndef)})
    plain = plain.xreplace({x: sympy.Symbol(x.name) for x in plain.atoms(sympy.Symbol)})
    plain = plain.xreplace({x: sympy.Rational(str(x)) for x in plain.atoms(sympy.Float)})
    left, right = (plain.lhs, plain.rhs) if isinstance(plain, sympy.Equality) else (plain, sympy.Integer(0))
    text = f"{sympy.sstr(left)} = {sympy.sstr(right)}"
    return text.replace("Abs(", "abs(").replace("Max(", "max(").replace("Min(", "min(")
