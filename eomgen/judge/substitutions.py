"""Contributions -> what they change by where something stands in them in the place of something else.

An angle taken from another axis, in degrees or as a small one; a speed or a coordinate left out, turned round, relative
for absolute; a parameter left out, with the wrong sign or factor, or another of its kind in its place.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from eomgen.errors import DerivationError
from eomgen.judge.contributions import Contribution, Contributions
from eomgen.judge.corruption import EXCHANGED, ODD, PLACED, SHARED, SHORTER, TERMS
from eomgen.judge.terms import angles_in, term_text, turned_angles, wrong_parameters
from eomgen.judge.wrong_points import Altered
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero

EVERYTHING = "everything"
ANGLES = ("1", "rad", "")  # dimensions of angles


def substitutions_in(parts: Contributions, whole: Sequence[Contribution]) -> Iterator[Altered]:
    """Every substitution in every contribution, in all of one body, and in everything."""
    groups, search = _groups(whole), _Substitutions(parts)
    for what in (search.angles, search.motions, search.parameters):
        for part in groups:
            together = not any(part is each for each in whole)
            for found in what(part):
                yield replace(found, rank=max(found.rank, SHARED + SHORTER)) if together else found


@dataclass(frozen=True)
class _Substitutions:
    parts: Contributions

    def _change(
        self, part: Contribution, kind: str, mapping: Mapping[Node, Scalar], what: str, rank: float
    ) -> Iterator[Altered]:
        try:
            T, V, *Q = substituted((part.T, part.V, *part.Q), mapping)
        except DerivationError:
            return  # it has no value there
        Q_ = tuple(x - y for x, y in zip(Q, part.Q, strict=True))
        changed = Contribution("", part.body, part.force, T - part.T, V - part.V, Q_)
        yield Altered(part.name, kind, what, changed, rank)

    def angles(self, part: Contribution) -> Iterator[Altered]:
        """Sines and cosines of one angle."""
        formulas = (part.T, part.V, *part.Q)
        for angle in angles_in(formulas):
            told = term_text(angle)
            for kind, mapping, what in turned_angles(angle, formulas):
                rank = PLACED if is_zero(part.T) else EXCHANGED
                if part.name == EVERYTHING or what.endswith("as zero"):
                    rank = ODD
                elif kind in ("factor", "approximation"):
                    rank = max(rank, TERMS if kind == "approximation" else EXCHANGED)
                yield from self._change(part, kind, mapping, f"in {part.name} {what.format(told)}", rank)

    def motions(self, part: Contribution) -> Iterator[Altered]:
        """Speeds and coordinates."""
        symbols = self.parts.operator.base.symbols
        named = {x.name: x for x in symbols.u}
        rates: dict[Node, Node | None] = {q: named.get(f"{q.name}'") for q in symbols.q}
        moved, acting = symbols_of((part.T,)), symbols_of((part.V, *part.Q))
        for u in symbols.u:
            if u in moved:
                still = Contribution("", part.body, part.force, substituted((part.T,), {u: 0})[0] - part.T)
                text = f"the velocity in {part.name} leaves out what {u.name} does"
                yield Altered(part.name, "missing_term", text, still, SHARED)
            if u in acting:
                text = f"{part.name} leaves out what {u.name} does: the velocity is a relative one"
                yield from self._change(part, "missing_term", {u: 0}, text, SHARED)
        for q, rate in rates.items():
            if q in acting and part.name != EVERYTHING:
                text = f"{part.name} leaves out what {q.name} does"
                yield from self._change(part, "missing_term", {q: 0}, text, EXCHANGED)
            if {q, rate} & {*acting, *moved}:
                yield from self._coordinate(part, q, rate, rates)

    def _coordinate(
        self, part: Contribution, q: Node, u: Node | None, rates: Mapping[Node, Node | None]
    ) -> Iterator[Altered]:
        """A coordinate in the opposite direction, relative for absolute, or another one in its place."""
        opposite: dict[Node, Scalar] = {q: -q} if u is None else {q: -q, u: -u}
        text = f"in {part.name} {q.name} is taken in the opposite direction"
        yield from self._change(part, "sign", opposite, text, EXCHANGED)
        if part.name == EVERYTHING or u is None:
            return
        for p, w in rates.items():
            if p is q or w is None or not self._alike(p.name, q.name):
                continue
            meant = f"stands where {q.name} alone is meant"
            for mapping, what in (
                ({q: q + p, u: u + w}, f"{q.name} + {p.name} {meant}: it is no relative one"),
                ({q: q - p, u: u - w}, f"{q.name} - {p.name} {meant}: it is a relative one"),
                ({q: p, u: w}, f"{p.name} stands where {q.name} is meant"),
            ):
                yield from self._change(part, "wrong_quantity", mapping, f"in {part.name} {what}", EXCHANGED)

    def parameters(self, part: Contribution) -> Iterator[Altered]:
        """Masses, lengths and other constants."""
        known = tuple(self.parts.system.symbols.parameters.values())
        for kind, mapping, what in wrong_parameters(symbols_of((part.T, part.V, *part.Q)), known):
            x, y = next(iter(mapping.items()))
            length = kind == "factor" and str(self.parts.dimensions.get(x.name)) == "m"
            if kind != "wrong_quantity" or (type(y) is Node and self._alike(y.name, x.name)):
                angle = kind == "missing_term" and str(self.parts.dimensions.get(x.name)) in ANGLES
                rank = ODD if kind == "factor" or angle else EXCHANGED
                yield from self._change(
                    part, "wrong_point" if length else kind, mapping, f"in {part.name} {what}", rank
                )
        for x in (x for x in known if str(self.parts.dimensions.get(x.name)) == "1"):
            what = f"in {part.name} {x.name} is turned over: 1/{x.name} stands where {x.name} is meant"
            yield from self._change(part, "factor", {x: over(1, x)}, what, EXCHANGED)

    def _alike(self, a: str, b: str) -> bool:
        """Whether two names stand for the same kind of quantity."""
        return str(self.parts.dimensions.get(a, a)) == str(self.parts.dimensions.get(b, b))


def _groups(whole: Sequence[Contribution]) -> list[Contribution]:
    """Every contribution, and all of one body together."""
    found = [part for part in whole if part.row is None]
    bodies: dict[str, list[Contribution]] = {}
    forces: dict[str, list[Contribution]] = {}
    for part in found:
        if part.body:
            bodies.setdefault(part.body, []).append(part)
        if part.force and is_zero(part.T):
            forces.setdefault(part.force, []).append(part)
    joined = [_joined(f"all that belongs to {body}", members, body) for body, members in bodies.items()]
    joined += [_joined(f"the force {force}", members, force=force) for force, members in forces.items()]
    joined.append(_joined(EVERYTHING, found))
    return [*found, *(each for each in joined if each is not None)]


def _joined(name: str, members: Sequence[Contribution], body: str = "", force: str = "") -> Contribution | None:
    """Several contributions as one; None where it is one."""
    if len(members) < 2:
        return None
    T, V = (sum((getattr(part, x) for part in members), start=0) for x in ("T", "V"))
    rows = [part.Q for part in members if part.Q]
    return Contribution(name, body, force, T, V, tuple(sum(x, start=0) for x in zip(*rows, strict=True)))
