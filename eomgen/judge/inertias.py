"""A moment of inertia that is asked -> what may be wrong in it, body by body.

    I = sum over the bodies of I_C + m d^2

Each part is asked of the model by the same function, of that body alone and about its mass centre.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

from eomgen.errors import DerivationError, EomgenError, ExpressionError
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.contributions import other_shapes
from eomgen.judge.diagnosis import EXCHANGED, PLACED, PLAIN, Mistake
from eomgen.judge.terms import wrong_parameters
from eomgen.mechanics.kinematics.inertia import mass_properties
from eomgen.mechanics.kinematics.motion import made_of
from eomgen.model.composite import PlacedPiece
from eomgen.model.fields import Table
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.formula import Call, Reference
from eomgen.symbolic.expression.node import Scalar, is_zero
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.print.text import to_text


@dataclass(frozen=True)
class Inertias:
    """What may be wrong in the moments of inertia that a function asks."""

    case: Case
    call: Call

    @property
    def mistakes(self) -> Iterator[Mistake]:
        for body in self._bodies:
            with suppress(ExpressionError):
                yield from self._of(body)

    @cached_property
    def _named(self) -> tuple[str, ...]:
        names = (x.name for x in self.call.args[1:] if isinstance(x, Reference))
        return tuple(name for name in names if name in self.case.model.bodies)

    @property
    def _point(self) -> str:
        first = self.call.args[0]
        return first.name if isinstance(first, Reference) else str(first)

    @property
    def _bodies(self) -> tuple[str, ...]:
        known = self._named or tuple(self.case.model.bodies)
        return tuple(b for b in known if not is_zero(mass_properties(self.case.system.scope, b).m))

    def _requested(self, body: str, point: str = "", piece: PlacedPiece | None = None) -> Scalar:
        """Of one body, about another point where one is given; of one of its pieces alone."""
        args = [x for x in self.call.args if not (isinstance(x, Reference) and x.name in self._named)]
        if point:
            args[0] = Reference(point)
        call = replace(self.call, args=(*args, Reference(body)))
        if piece is None:
            return self.case.called(call)
        shape = replace(piece.piece.shape, mass=parse(to_text(piece.mass.m)))
        alone = replace(self.case.model.bodies[body], mass=None, parts=(replace(piece.piece, hole=False, shape=shape),))
        bodies = Table({**self.case.model.bodies, body: alone})
        model = replace(self.case.model, bodies=bodies, outputs=Table())
        return piece.sign * self.case.own(replace(self.case, model=model).called(call))

    def _of(self, body: str) -> Iterator[Mistake]:
        pieces = made_of(self.case.system.scope, body).pieces if self.case.model.bodies[body].parts else ()
        for number, piece in enumerate(pieces, start=1) if self._point != f"{body}.center" else ():
            kind = f"the hole, a {piece.piece.shape.kind}" if piece.piece.hole else piece.piece.shape.kind
            with suppress(EomgenError):
                whole, own = (self._requested(body, point, piece) for point in ("", f"{body}.center"))
                yield from self._of_part(f"part {number} of {body} ({kind})", body, whole, own)
        whole, own = self._requested(body), self._requested(body, f"{body}.center")
        yield from self._of_part(body, body, whole, own, together=not pieces)
        for ratio, text in other_shapes(self.case.system.scope, body):
            yield self._changed(f"the moment of inertia of {body}", "factor", (ratio - 1) * own, text, body)
        yield from self._about_others(body, whole, own)

    def _of_part(self, part: str, body: str, whole: Scalar, own: Scalar, *, together: bool = True) -> Iterator[Mistake]:
        """What may be wrong with that of a body or of a piece of it: about its mass centre, and Steiner's term."""
        name, swept = f"the moment of inertia of {part}", whole - own
        if together:
            yield Mistake(name, "factor", (whole,), PLAIN, body)
        parts = (
            (f"the moment of inertia of {part} about its own mass centre", own),
            (f"the term m d^2 of {part} (Steiner, parallel axes)", swept),
        )
        for reported, share in parts if not is_zero(own) and not is_zero(swept) else ():
            yield Mistake(reported, "factor", (share,), PLAIN, body)
        known = tuple(self.case.system.symbols.parameters.values())
        for reported, share in parts:
            (formula,) = self.case.edits.written((share,))
            for each in self.case.edits.of((formula,)):
                text = f"in {reported} {each.text}"
                yield replace(self._changed(reported, each.kind, each.to[0] - formula, text, body), rank=each.rank)
            for kind, mapping, what in wrong_parameters(symbols_of((share,)), known):
                with suppress(DerivationError):
                    by = substituted((share,), mapping)[0] - share
                    yield replace(self._changed(reported, kind, by, f"in {reported} {what}", body), rank=EXCHANGED)

    def _about_others(self, body: str, whole: Scalar, own: Scalar) -> Iterator[Mistake]:
        """About another point than is asked; Steiner's term on top of what is not about the mass centre."""
        name = f"the moment of inertia of {body}"
        for point in self.case.model.named_points:
            with suppress(ExpressionError):
                other = self._requested(body, point)
                text = f"{name} is taken about {point}, and not about {self._point}"
                yield self._changed(name, "wrong_point", other - whole, text, body)
                if point.startswith(f"{body}."):
                    text = f"{name} about {point} stands where that about its mass centre is needed beside m d^2"
                    yield self._changed(name, "wrong_point", other - own, text, body)

    def _changed(self, name: str, kind: str, by: Scalar, text: str, body: str) -> Mistake:
        return Mistake(name, kind, (by,), PLACED, body, open=False, text=text)
