"""A system -> the quantities that a derivation prints under a name: x(bob.center), Q(x, joint of cart), M[x', y'].

Of each there is the name as text and as LaTeX have it, and what it stands for: a function of the outputs where there is
one, else its value, found by mechanics and not by the page. So a line of a derivation can be read again wherever it
comes from.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial

from eomgen.documents.document import notation_of
from eomgen.documents.energy_steps import JACOBI
from eomgen.documents.latex import side_latex
from eomgen.documents.motion_steps import axes, moved_coordinates, points_of_forces
from eomgen.documents.reaction_values import (
    AXES,
    LETTERS,
    names_of_components,
    own_symbol,
    reaction_name,
    said,
    shown_system,
)
from eomgen.documents.statements import Entry, Found, Law, Name, Quantity, Rate, Side
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Balance, NamedReaction
from eomgen.mechanics.integrals import FirstIntegrals
from eomgen.mechanics.kinematics import Applied, SystemInertia
from eomgen.model import Couple, PointForce
from eomgen.study import Study
from eomgen.symbolic.expression import Node, Scalar, derivative, gradient, inner, is_zero, sqrt
from eomgen.symbolic.print import Setter, Symbol

Value = Callable[[Study, System], Scalar]

_NAMED = re.compile(r"(?P<what>\w+)\((?P<owner>\w+)(?:\.(?P<side>\w+))?(?:, (?P<number>\w+))?\)")
WORDS = {"speed": "v", "angle": "phi", "couple": "tau"}  # letters that formulas have for these words


@dataclass(frozen=True)
class NamedQuantity:
    """A quantity by its name in derivations.

    Args:
        name: a name of the grammar that stands for it: x_bob, Q_theta.
        text: as a derivation has it in text; "" where that is `call`.
        typeset: as it has it in LaTeX, of a rate that of which it is one; "" where that is the name, typeset.
        call: the function of the outputs that it is, "x(bob.center)"; "" where none is.
        value: of it, of a study and the system whose coordinates are meant; where there is no such function.
    """

    name: str
    text: str
    typeset: str
    call: str = ""
    value: Value | None = None


def named_quantities(system: System) -> tuple[NamedQuantity, ...]:
    """Quantities that derivations of a system name, each name once, the first that has it."""
    setter = Setter(notation_of(system.scope.model))
    found: dict[str, NamedQuantity] = {}
    for side, call, value in _sides(system):
        text, typeset = _text(side), side_latex(setter, side.of if isinstance(side, Rate) else side)
        name = _plain(side)
        found.setdefault(name, NamedQuantity(name, "" if text == call else text, typeset, call, value))
    for name, value in _reactions(system):
        found.setdefault(name, NamedQuantity(name, "", "", "", value))
    return tuple(found.values())


def _plain(side: Side) -> str:
    """A name of the grammar for a quantity."""
    if isinstance(side, Rate):
        assert isinstance(side.of, Name)
        return f"{_plain(side.of)}'"
    if isinstance(side, Entry):
        return f"{side.letter}_{side.row.name}_{side.column.name}".replace("'", "")
    if isinstance(side, Law):
        return "_".join(re.findall(r"\w+", side.text))
    assert isinstance(side, Name)
    whose = [*([side.by.name.rstrip("'")] if side.by is not None else []), side.of.removesuffix(".center")]
    words = [re.sub(r"\W+", "_", each) for each in whose if each]
    return "_".join([WORDS.get(side.letter, side.letter), *words])


def _text(side: Side) -> str:
    """A quantity as text has it, blanks left out."""
    if isinstance(side, Rate):
        return f"d/dt({_text(side.of)})"
    if isinstance(side, Entry):
        return f"{side.letter}[{side.row.name}, {side.column.name}]"
    if isinstance(side, Law):
        return side.text
    assert isinstance(side, Name)
    if side.by is None and not side.of:
        return side.letter
    whose = ", ".join([*([side.by.name] if side.by is not None else []), *([side.of] if side.of else [])])
    return f"{side.letter}({whose})"


def _sides(system: System) -> Iterator[tuple[Side, str, Value | None]]:
    yield from _of_bodies(system)
    yield from _of_forces(system)
    yield from _of_equations(system)
    yield from _of_constraints(system)
    yield from _of_integrals(system)


def _of_bodies(system: System) -> Iterator[tuple[Side, str, Value | None]]:
    """Positions, velocities, angles, angular velocities and energies."""
    motion, plane = system.motion, system.scope.model.space == "plane"
    for link in motion.links:
        body, of = link.name, f"{link.name}.center"
        if not is_zero(system.scope.mass_properties(body).m):
            for axis in axes(system):
                yield Name(axis, of), f"{axis}({of})", None
                yield Name(f"v{axis}", of), f"v{axis}({of})", None
            yield Name("speed", of), f"speed({of})", None
        if plane and isinstance(link.angle, Node):
            yield Name("angle", body), f"angle({body})", None
            yield Name("omega", body), f"omega({body})", None
        for k in () if plane else range(3):
            yield Name(f"omega_{k + 1}", body), "", partial(_spin, body, k)
        rotor = not is_zero(SystemInertia(motion).rotor_energy(link))  # which has a line of its own
        yield Name("T", body), *(("", partial(_own_energy, body)) if rotor else (f"kinetic_energy({body})", None))
        yield Name("T", f"{body}, rotor"), "", partial(_rotor_energy, body)
    yield Name("T", "given"), "", lambda study, whole: SystemInertia(whole.motion).given_energy


def _spin(body: str, k: int, study: Study, whole: System) -> Scalar:
    found: Scalar = whole.motion.spin(whole.motion.link(body))[k]
    return found


def _own_energy(body: str, study: Study, whole: System) -> Scalar:
    found = next(energy for energy in SystemInertia(whole.motion).bodies if energy.body == body)
    return found.translation + found.rotation


def _rotor_energy(body: str, study: Study, whole: System) -> Scalar:
    return SystemInertia(whole.motion).rotor_energy(whole.motion.link(body))


def _of_forces(system: System) -> Iterator[tuple[Side, str, Value | None]]:
    """Potentials, generalized forces, forces and couples, and where they act."""
    coordinates = _moved(system)
    for force in system.loads.applied:
        if force.potential is not None:
            yield Name("V", force.name), f"potential_energy({force.name})", None
        for q in coordinates:
            yield Name("Q", force.name, q), "", partial(_force_share, force.name, q.name)
        for number, load in enumerate(force.loads, start=1):
            name = force.name if len(force.loads) == 1 else f"{force.name} {number}"
            if isinstance(load, PointForce):
                for k, axis in enumerate(axes(system)):
                    yield Name(f"F{axis}", name), "", partial(_load, force.name, number - 1, k)
            elif isinstance(load, Couple):
                yield Name("couple", name), "", partial(_load, force.name, number - 1, 2)
    for name, _ in points_of_forces(system):
        for k, axis in enumerate(axes(system)):
            yield Name(axis, name), "", partial(_place, name, k)
    for body in dict.fromkeys(effort.body for effort in system.loads.efforts):
        name = f"joint of {body}"
        yield Name("V", name), "", partial(_joint_energy, body)
        for q in coordinates:
            yield Name("Q", name, q), "", partial(_joint_share, body, q.name)


def _moved(system: System) -> tuple[Node, ...]:
    """The coordinates, and speeds that are no rates, of which a generalized force may be named."""
    both = (*moved_coordinates(system), *moved_coordinates(system.free or system))
    return tuple({q.name: q for q in both}.values())


def _force_share(force: str, q: str, study: Study, whole: System) -> Scalar:
    whole = _of(q, study, whole)
    return whole.loads.force_row(_applied(force, whole))[_index(whole, q)]


def _applied(force: str, whole: System) -> Applied:
    for each in whole.loads.applied:
        if each.name == force:
            return each
    raise DerivationError(f"there is no force '{force}'", fix="name one of [forces]")


def _joint_share(body: str, q: str, study: Study, whole: System) -> Scalar:
    whole = _of(q, study, whole)
    rows = [whole.loads.effort_row(each) for each in whole.loads.efforts if each.body == body]
    return sum((row[_index(whole, q)] for row in rows), start=0)


def _joint_energy(body: str, study: Study, whole: System) -> Scalar:
    return sum((each.potential for each in whole.loads.efforts if each.body == body), start=0)


def _load(force: str, number: int, k: int, study: Study, whole: System) -> Scalar:
    load = _applied(force, whole).loads[number]
    assert isinstance(load, (PointForce, Couple))
    found: Scalar = (load.force if isinstance(load, PointForce) else load.couple)[k]
    return found


def _place(name: str, k: int, study: Study, whole: System) -> Scalar:
    found: Scalar = dict(points_of_forces(whole))[name][k]
    return found


def _of(q: str, study: Study, whole: System) -> System:
    """The system in which a coordinate or speed moves: the one that is meant, else one that has it."""
    for each in (whole, study.system, study.system.free or study.system):
        if q in [x.name for x in moved_coordinates(each)]:
            return each
    raise DerivationError(f"'{q}' is no coordinate that is free here", fix="name one that moves freely")


def _index(whole: System, q: str) -> int:
    return [each.name for each in moved_coordinates(whole)].index(q)


def _of_equations(system: System) -> Iterator[tuple[Side, str, Value | None]]:
    """Generalized forces, and M and c of the equations of motion."""
    u = system.symbols.u
    own = {q.name for q in moved_coordinates(system)} & system.scope.model.coordinates.keys()
    for q in _moved(system):
        is_output = system.free is None and q.name in own
        yield Name("Q", by=q), f"generalized_force({q.name})" if is_output else "", partial(_generalized, q.name)
    for i, row in enumerate(u):
        for j, column in enumerate(u):
            yield Entry("M", row, column), "", partial(_entry, i, j)
        yield Name("c", by=row), "", partial(_rest_of_inertia, i)
    for q in system.symbols.q:
        for other in system.symbols.q:
            yield Entry("K", q, other), "", partial(_stiffness, q.name, other)


def _generalized(q: str, study: Study, whole: System) -> Scalar:
    whole = _of(q, study, whole)
    return whole.loads.generalized_forces[_index(whole, q)]


def _entry(i: int, j: int, study: Study, whole: System) -> Scalar:
    return study.equations.M[i][j]


def _stiffness(q: str, other: Node, study: Study, whole: System) -> Scalar:
    """-dQ/dq, whose value at an equilibrium is the stiffness there."""
    whole = _of(q, study, whole)
    return -derivative(whole.loads.generalized_forces[_index(whole, q)], other)


def _rest_of_inertia(i: int, study: Study, whole: System) -> Scalar:
    return study.equations.c[i]


def _of_constraints(system: System) -> Iterator[tuple[Side, str, Value | None]]:
    """Gaps of the constraint rows, and their rates."""
    for row in (system.free or system).constraints.closing:
        gap = Name("gap", f"{row.constraint}, {row.number}")
        if row.gap is not None:
            yield gap, "", partial(_gap, row.constraint, row.number)
        yield Rate(gap), "", partial(_gap_rate, row.constraint, row.number)


def _row(constraint: str, number: int, system: System) -> Row:
    for row in system.constraints.rows:
        if (row.constraint, row.number) == (constraint, number):
            return row
    raise DerivationError(f"there is no row {number} of a constraint '{constraint}'", fix="name one of [constraints]")


def _gap(constraint: str, number: int, study: Study, whole: System) -> Scalar:
    gap = _row(constraint, number, whole).gap
    if gap is None:
        raise DerivationError(f"'{constraint}' is a condition on velocities: it has no gap", fix="name its rate")
    return gap


def _gap_rate(constraint: str, number: int, study: Study, whole: System) -> Scalar:
    return _row(constraint, number, whole).velocity


def _of_integrals(system: System) -> Iterator[tuple[Side, str, Value | None]]:
    """Jacobi's integral, the work of constant forces, and the momenta of the whole that stay constant."""
    yield JACOBI, "", _jacobi
    yield Law.of_letter("W"), "", lambda study, whole: FirstIntegrals(study.equations).work_of_constant_forces
    for letter in "PL":
        for axis in axes(system):
            yield Name(f"{letter}_{axis}"), "", partial(_of_the_whole, letter, axis)
    yield Name("L"), "", lambda study, whole: sqrt(_of_the_whole("L", "", study, whole))


def _jacobi(study: Study, whole: System) -> Scalar:
    T, u = study.equations.T, study.system.symbols.u
    return inner(gradient(T, u), u) - T + study.equations.V


def _of_the_whole(letter: str, axis: str, study: Study, whole: System) -> Scalar:
    for each in FirstIntegrals(study.equations).momenta_of_the_whole(()):
        if (each.letter, each.axis) == (letter, axis):
            return each.expression
    name = f"{letter}_{axis}".rstrip("_")
    what = f"'{name}' does not stay constant, as the momentum that has this letter does"
    raise DerivationError(what, fix="declare an output for another momentum")


def _reactions(system: System) -> Iterator[tuple[str, Value]]:
    """Components of the reactions under the names that a derivation gives them."""
    try:
        names = names_of_components(Balance.of(shown_system(system)), system.scope.names)
    except DerivationError:
        return
    for name in names:
        yield name, partial(_component, name)


def _component(name: str, study: Study, whole: System) -> Scalar:
    names = names_of_components(study.reactions.balance, study.system.scope.names)
    return study.reactions.value(names.index(name))


def found_reaction(system: System, named: NamedReaction, answer: Quantity) -> Found:
    """A reaction that an output names, with its meaning in words and its letter."""
    balance = Balance.of(system)
    return Found(named.name, answer, said(balance, named), _letter_of(balance, named))


def _letter_of(balance: Balance, named: NamedReaction) -> str:
    """The name under which formulas have a reaction that an output names; "" where they have other components."""
    found = _NAMED.fullmatch(named.name)
    label = "" if found is None else found["what"].removeprefix("reaction_")
    along_ground = balance.system.scope.model.space == "space" and (label in AXES or label.startswith("couple"))
    if found is None or label not in (*AXES, *LETTERS) or along_ground or label == "drive":
        return ""
    return reaction_name(label, found["owner"], *filter(None, (found["side"], found["number"])))


@dataclass(frozen=True)
class RequestedReaction:
    """A reaction that outputs can request by one name, with the letters that it has in derivations.

    Args:
        function, argument, number: of the request, tension(rope, 2); number is "" where there is none.
        owner: the constraint, or the body whose joint it is.
        letters: B_x; of the tension of the only strand T_rope and T_rope_1; () of a couple about an axis.
        declared: the symbol that the joint or the constraint gives it.
    """

    function: str
    argument: str
    number: str
    owner: str
    letters: tuple[str, ...]
    declared: Symbol | None


def requested_reactions(system: System) -> Iterator[RequestedReaction]:
    """Reactions of a system, without those that need the name of a body too.

    Raises:
        DerivationError: something acts at no place.
    """
    balance = Balance.of(system)
    for each in NamedReaction.all_of(balance):
        function, _, arguments = each.name.removesuffix(")").partition("(")
        argument, _, number = arguments.partition(", ")
        if number and not (function == "tension" and number.isdigit()):
            continue
        label = function.removeprefix("reaction_")
        numbers = () if label.startswith("couple_") else ("", "1") if label == "tension" and not number else (number,)
        letters = tuple(reaction_name(label, each.owner, x) for x in numbers)
        yield RequestedReaction(function, argument, number, each.owner, letters, own_symbol(balance, each))
