"""Model -> ImpactResult: the impact where a contact closes, as equations, solved, with the energy that it takes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

from eomgen.documents import (
    Document,
    Formula,
    Grid,
    Law,
    Name,
    Piece,
    Reader,
    Result,
    Statement,
    Step,
    document_of,
    page,
    prose,
)
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.impacts import ImpactEquations
from eomgen.mechanics.statics import ContactsAtStart
from eomgen.model import Model
from eomgen.proof import Certificate, impact_checks
from eomgen.resources import doing
from eomgen.study import MotionFromStart
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.print import to_text

LOSS = Law("T_before - T_after", r"T^{-} - T^{+}")
AT_MOST = Law("<=", r"\leq")


@dataclass(frozen=True)
class ImpactResult(Result):
    """The impact where contacts of a model close.

    Args:
        model: whose.
        equations: its jump.
        full: everything is printed, however long.
    """

    model: Model
    equations: ImpactEquations
    full: bool = False

    def __repr__(self) -> str:
        return f"<impact of {', '.join(self.equations.contacts)} in {self.model.name!r}>"

    @property
    def derivation(self) -> Document:
        """Document with the equations of the impact, and their solution."""
        return document_of(self.model, "impact", (self._equations_step, self._solution_step, *self._cases_step))

    @property
    def _reader(self) -> Reader:
        return Reader(full=self.full, positive=self.equations.system.scope.positive)

    @property
    def _equations_step(self) -> Step:
        found = self.equations
        reader = self._reader
        closing = ", ".join(found.contacts)
        held = [row.name for row in found.rows if row.e is None]
        statements: list[Statement] = [
            prose(f"Closing: {closing}."),
            prose("Positions stay, and impulses change the speeds from those before to those after the impact:"),
            *(Formula((reader.shown(left), reader.shown(right))) for left, right in found.balances),
            prose("What closes leaves with e times the speed of its approach:"),
            *(Formula((reader.shown(a), reader.shown(b))) for a, b in self._conditions(closes=True)),
        ]
        if held:
            statements += [
                prose("What holds stays at rest:"),
                *(Formula((reader.shown(a), reader.shown(b))) for a, b in self._conditions(closes=False)),
            ]
        named = [(row.impulse, f"impulse of {row.name}", row.unit) for row in found.rows]
        later = [(x, f"{u.name} after the impact", "") for u, x in zip(found.u, found.after, strict=True)]
        if found.rubbing:
            said = ", ".join(found.rubbing)
            statements.append(
                prose(f"Friction pushes {said} against its sliding by mu times the normal impulse, if it slides on.")
            )
        table = Grid(("symbol", "meaning", "unit"), (*named, *later))
        return Step("impact", "Impact", (*statements, table))

    def _conditions(self, *, closes: bool) -> list[tuple[Any, Any]]:
        pairs = zip(self.equations.rows, self.equations.conditions, strict=True)
        return [condition for row, condition in pairs if (row.e is not None) == closes]

    @property
    def _solution_step(self) -> Step:
        found, reader = self.equations, self._reader
        impulses = [(row.impulse, found.solution[row.impulse]) for row in found.rows]
        joints = [
            (Name(f"impulse_{axis}", body), x)
            for body, vector in found.of_joints.items()
            for axis, x in zip("xyz"[: 2 if self.model.space == "plane" else 3], vector, strict=False)
        ]
        of_joints = (prose("The impulses of the joints, each on its body:"), *page(reader, joints)) if joints else ()
        statements = (
            prose("The impulses, which must push or pull as their contacts can:"),
            *page(reader, impulses),
            *of_joints,
            prose("The speeds after the impact:"),
            *page(reader, [(x, found.solution[x]) for x in found.after]),
            prose("The kinetic energy that is lost:"),
            *page(reader, [(LOSS, found.loss)]),
            *self._sliding(reader),
        )
        return Step("impulses", "Impulses, speeds and loss", statements)

    @property
    def _cases_step(self) -> tuple[Step, ...]:
        """The cases of a contact that rubs, each with its bounds, and which of them the model's numbers choose."""
        found, reader, cases = self.equations, self._reader, self.equations.cases
        if not cases.courses:
            return ()
        (name,), first = found.contacts, cases.courses[0]
        statements: list[Statement] = [
            prose(f"What stands above holds while {name} slides on, where ", *_within(first.bounds), ".")
        ]
        if cases.letters:
            statements += [
                prose(
                    "D is what unit impulses change of v_n and v_t. By the normal impulse v_n grows by a, while it"
                    " slides (the size of v_t by a_t), sticks (s), slides back (b). At p_s, with v_s, sliding ends:"
                ),
                *page(reader, cases.letters[:5]),
                *map(Formula, cases.letters[5:]),
            ]
        for each, course in zip(found.others, cases.courses[1:], strict=True):
            impulses = [row.impulse for row in each.rows[:2]]
            statements.append(prose(f"{name} {course.name}, where ", *_within(course.bounds), ":"))
            if cases.short:
                known = [(x, each.solution[x]) for x in (*impulses, *each.after)]
                statements += page(reader, [*known, (LOSS, each.loss)])
            else:
                statements += map(Formula, zip(impulses, course.impulses, strict=True))
        if cases.letters:
            statements.append(prose("In these cases the speeds after the impact are those that the impulses make:"))
            statements += page(reader, list(zip(found.after, self._changed, strict=False)))
            statements += [Formula((LOSS, loss)) for loss in found.loss_in_letters]
        if self.chosen:
            statements.append(prose(f"At the first impact from the start of the model {name} {self.chosen}."))
        return (Step("cases", "Cases", tuple(statements)),)

    @property
    def _changed(self) -> tuple[Scalar, ...]:
        """Speeds after it in the impulses of a contact that rubs."""
        rows = self.equations.others[0].rows
        return self.equations.changed([row.impulse for row in rows[:2]])

    @cached_property
    def chosen(self) -> str:
        """Name of the case at the first impact from the model's start; "" where there is none, or parameters lack."""
        found, (name, *_) = self.equations, self.equations.contacts
        if not found.cases.courses:
            return ""
        at = MotionFromStart(self.model, False).before_closing(name)
        return found.course_at(at) if at else ""

    def _sliding(self, reader: Reader) -> tuple[Statement, ...]:
        """Statements of when a contact that rubs slides on."""
        found: list[Statement] = []
        for name, (before, later) in self.equations.slides_on.items():
            found.append(
                prose(f"This holds where {name} slides on: its sliding velocities before and after have one sign:")
            )
            found += page(reader, [(Name("v_t", name), before), (Name("v_t_after", name), later)])
        return tuple(found)

    def certify(self) -> Certificate:
        """Check momenta of the bodies, restitution, energies, and the law in numbers."""
        return Certificate(tuple(impact_checks(self.equations)))

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        found = self.equations
        axes = 2 if self.model.space == "plane" else 3
        equations = [f"{to_text(a)} = {to_text(b)}" for a, b in (*found.balances, *found.conditions)]
        return {
            "name": self.model.name,
            "impact": {
                "contacts": list(found.contacts),
                "equations": equations,
                "unknowns": [x.name for x in found.solution],
                "impulses": {name: to_text(x) for name, x in found.impulses.items()},
                "joints": {name: [to_text(x) for x in vector][:axes] for name, vector in found.of_joints.items()},
                "after": {u.name: to_text(found.solution[x]) for u, x in zip(found.u, found.after, strict=True)},
                "loss": to_text(found.loss),
                "cases": self._cases_entries(),
                "slides_on": {name: [to_text(x) for x in pair] for name, pair in found.slides_on.items()},
            },
        }

    def _cases_entries(self) -> dict[str, Any]:
        """The cases of a contact that rubs: their letters, their bounds and formulas, and the chosen one."""
        found, cases = self.equations, self.equations.cases
        if not cases.courses:
            return {}
        own = [
            {
                "name": course.name,
                "while": list(course.within),
                "impulses": {
                    row.name: to_text(each.solution[row.impulse] if cases.short else x)
                    for row, x in zip(each.rows, course.impulses, strict=False)
                },
                "after": {
                    u.name: to_text(each.solution[x] if cases.short else changed)
                    for u, x, changed in zip(found.u, found.after, self._changed, strict=False)
                },
                **({"loss": to_text(each.loss)} if cases.short else {}),
            }
            for each, course in zip(found.others, cases.courses[1:], strict=True)
        ]
        slides = list(cases.courses[0].within)
        letters = {x.name: to_text(formula) for x, formula in cases.letters}
        return {"letters": letters, "slides_on": slides, "others": own, "chosen": self.chosen}


def _within(bounds: Sequence[tuple[Scalar, Scalar]]) -> Iterator[Piece]:
    """a <= b and c <= d."""
    for k, sides in enumerate(bounds):
        left, right = (x if type(x) is Node else to_text(x) for x in sides)
        yield from (*((" and ",) if k else ()), left, " ", AT_MOST, " ", right)


@doing("the equations of the impact")
def impact(model: Model, contacts: Sequence[str] = (), *, full: bool = False) -> ImpactResult:
    """The impact where contacts close: its equations, impulses, the speeds after it, the loss of energy.

    Contacts that are closed at the start stay so.

    Args:
        contacts: by name; (): the one that can end.
        full: everything is printed, however long.
    Raises:
        UsageError, DerivationError: as of `ImpactEquations.of`.
    """
    modes = ContactsAtStart.of(model).modes
    ending = [contact.name for contact in model.contacts if contact.unilateral]
    closed = [name for name in ending if name not in modes or modes[name].closed] if len(ending) > 1 else []
    found = ImpactEquations.of(model, contacts, closed, slides=True)
    if not found.u:
        raise DerivationError("nothing of the model can move", fix="give it a coordinate")
    return ImpactResult(model, found, full)
