"""What `statics` prints of sections and of self-stresses, from somebody -> Verdict.

M(2*a), V(x), N(x) of the only beam, of x in the part of it where they are so; the extremes of M and their places; the
shares Delta(A_x) of reactions that are statically indeterminate.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress

from eomgen.errors import DerivationError, EomgenError, ExpressionError
from eomgen.judge.case import Case
from eomgen.judge.comparison import excess
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.verdict import RIGHT, WRONG, Cause, Verdict
from eomgen.mechanics.statics import SectionForces
from eomgen.symbolic.expression import Call, Expression, Reference, Scalar
from eomgen.symbolic.print import readable_text

FUNCTIONS = {"N": "axial_force", "V": "shear_force", "Q": "shear_force", "M": "bending_moment"}
AT = re.compile(
    r"\s*(?P<letter>[NVQM])(?:_\{?b\}?)?\s*(?:\\left)?\((?P<place>[^()=]+?)(?:\\right)?\)\s*=(?P<right>.*)", re.S
)
EXTREME = re.compile(
    r"\s*(?:M\(extreme\)|M_\{?(?:\\mathrm\{extreme\}|extreme)\}?|(?P<place>[a-z_]+))\s*=(?P<right>.*)", re.S
)
DELTA = re.compile(r"\s*(?:\\?Delta)(?:_\{(?P<index>.+)\}|\((?P<letter>.+)\))\s*=(?P<right>.*)", re.S)
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
    return _compared(case, given, true, author, parts, f"{letter}({x.name})")


def _compared(case: Case, given: str, true: list[Scalar], author: Scalar, parts: list[str], name: str) -> Verdict:
    """Right where one of the true values is the author's, in its part of the beam."""
    for each, part in zip(true, parts, strict=True):
        if is_zero_everywhere(case.system, each - author).holds:
            return Verdict(given, "statics", RIGHT, f"{part}" if part and len(true) > 1 else "")
    values = [f"{readable_text(x)}{f' in {part}' if part else ''}" for x, part in zip(true, parts, strict=True)]
    difference = excess(case, true[0] - author) if len(true) == 1 else ""
    cause = Cause("other", f"it is {name} = {'; '.join(values)}", quantity="the section force")
    return Verdict(given, "statics", WRONG, difference=difference, causes=(cause,))


def _of_extreme(case: Case, given: str, found: re.Match[str]) -> Verdict | None:
    """An extreme of M, or its place x; None where it is none of these: x may be something else."""
    if found["place"] and (found["place"] in case.system.scope.names or found["place"] in case.reading.letters):
        return None
    author = case.value(case.reading.read(f"{found['right']} = 0").left)
    for _, forces in _beams(case):
        for extreme in forces.extremes:
            true = case.own(extreme.x if found["place"] else extreme.M)
            if is_zero_everywhere(case.system, true - author).holds:
                return Verdict(given, "statics", RIGHT, PLACE if found["place"] else "")
    return None


def _of_share(case: Case, given: str, found: re.Match[str]) -> Verdict | None:
    """The share of a reaction in a self-stress of any size k."""
    reactions = case.quantities.reactions
    with suppress(ExpressionError):
        call = case.reading.read(f"{found['letter'] or found['index']} = 0").left.calls[0]
        right = case.reading.read(f"{found['right']} = 0").left
        unknown = sorted(right.names - case.system.scope.names.keys() - {"pi"})
        if len(unknown) != 1:
            return None
        k = case.system.scope.graph.symbol(unknown[0])
        author = case.value(right, {unknown[0]: k})
        for space in reactions.null_space:
            share = next((x for name, x in space.items() if name == str(call)), None)
            if share is not None and is_zero_everywhere(case.system, author - case.own(share) * k).holds:
                return Verdict(given, "statics", RIGHT, f"the self-stress {unknown[0]}, of any size")
    return None
