"""A moment of inertia that is asked -> what may be wrong in it, body by body.

    I = sum over the bodies of I_C + m d^2

Each part is asked of the model by the same function, of that body alone and about its mass centre.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

from eomgen.errors import DerivationError, ExpressionError
from eomgen.judge.case import Case
from eomgen.judge.corruption import EXCHANGED, PLACED, PLAIN, Corruption
from eomgen.judge.terms import wrong_parameters
from eomgen.judge.wrong_points import other_shapes
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.expressions import Call, Reference
from eomgen.symbolic.expression.graph import Scalar, is_zero


@dataclass(frozen=True)
class Inertias:
    """What may be wrong in the moments of inertia that a function asks."""

    case: Case
    call: Call

    @property
    def corruptions(self) -> Iterator[Corruption]:
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

    def _asked(self, body: str, point: str = "") -> Scalar:
        """Of one body, about another point where one is given."""
        args = [x for x in self.call.args if not (isinstance(x, Reference) and x.name in self._named)]
        if point:
            args[0] = Reference(point)
        return self.case.called(replace(self.call, args=(*args, Reference(body))))

    def _of(self, body: str) -> Iterator[Corruption]:
        whole, own = self._asked(body), self._asked(body, f"{body}.center")
        name, swept = f"the moment of inertia of {body}", whole - own
        yield Corruption(name, "factor", (whole,), PLAIN, body)
        parts = (
            (f"the moment of inertia of {body} about its own mass centre", own),
            (f"the term m d^2 of {body} (Steiner, parallel axes)", swept),
        )
        for told, part in parts if not is_zero(own) and not is_zero(swept) else ():
            yield Corruption(told, "factor", (part,), PLAIN, body)
        for ratio, text in other_shapes(self.case.system.scope, body):
            yield self._changed(name, "factor", (ratio - 1) * own, text, body)
        known = tuple(self.case.system.symbols.parameters.values())
        for told, part in parts:
            (formula,) = self.case.edits.written((part,))
            for each in self.case.edits.of((formula,)):
                text = f"in {told} {each.text}"
                yield replace(self._changed(told, each.kind, each.to[0] - formula, text, body), rank=each.rank)
            for kind, mapping, what in wrong_parameters(symbols_of((part,)), known):
                with suppress(DerivationError):
                    by = substituted((part,), mapping)[0] - part
                    yield replace(self._changed(told, kind, by, f"in {told} {what}", body), rank=EXCHANGED)
        yield from self._about_others(body, whole, own)

    def _about_others(self, body: str, whole: Scalar, own: Scalar) -> Iterator[Corruption]:
        """About another point than is asked; Steiner's term on top of what is not about the mass centre."""
        name = f"the moment of inertia of {body}"
        for point in self.case.model.named_points:
            with suppress(ExpressionError):
                other = self._asked(body, point)
                text = f"{name} is taken about {point}, and not about {self._point}"
                yield self._changed(name, "wrong_point", other - whole, text, body)
                if point.startswith(f"{body}."):
                    text = f"{name} about {point} stands where that about its mass centre is needed beside m d^2"
                    yield self._changed(name, "wrong_point", other - own, text, body)

    def _changed(self, name: str, kind: str, by: Scalar, text: str, body: str) -> Corruption:
        return Corruption(name, kind, (by,), PLACED, body, open=False, text=text)
