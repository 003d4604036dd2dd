"""Equations of motion -> Document: the way to them, step by step, as a teacher would write it; the names in it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from eomgen.documents import energy_steps, motion_steps
from eomgen.documents.document import Document, document_of, notation_of, with_symbols
from eomgen.documents.energy_steps import (
    JACOBI,
    MAGGI,
    Momenta,
    balance_step,
    integral_steps,
    maggi_equations,
    twists_step,
)
from eomgen.documents.equation_steps import EquationSteps, Sides, equations_of, multiplier_forces, sides_of
from eomgen.documents.latex import side_latex
from eomgen.documents.motion_steps import axes, moved_coordinates, points_of_forces, setting_steps, states_step
from eomgen.documents.reaction_steps import (
    along_the_motion,
    kinetostatic_steps,
    letters_of,
    rates_in_letters,
    reactions_step,
    reactions_table_step,
)
from eomgen.documents.reaction_values import (
    AXES,
    LETTERS,
    Lettered,
    lettered,
    names_of_components,
    own_symbol,
    reaction_name,
    said,
    shown_system,
)
from eomgen.documents.reading import Reader, Written, with_coefficients_throughout, with_parts_named, with_roots_named
from eomgen.documents.statements import (
    Entry,
    Formula,
    Found,
    Law,
    Name,
    Prose,
    Quantity,
    Rate,
    Side,
    Step,
    notation_step,
)
from eomgen.documents.text import prose_text, side_text
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System, derived_by, inertia_by_energies
from eomgen.mechanics.free_bodies import Balance, NamedReaction, Reactions
from eomgen.mechanics.integrals import FirstIntegrals
from eomgen.mechanics.kinematics import Applied, BodyEnergy, SystemInertia
from eomgen.model import Couple, PointForce
from eomgen.proof import Printed
from eomgen.study import Study
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.expression import Node, Scalar, derivative, gradient, inner, is_zero, sqrt
from eomgen.symbolic.print import Setter, Symbol, text_size

LAGRANGE = Law(
    "d/dt(dT/dq_k') - dT/dq_k = Q_k",
    r"\frac{d}{dt} \frac{\partial T}{\partial \dot{q}_{k}} - \frac{\partial T}{\partial q_{k}} = Q_{k}",
)
MATRICES = Law("M*a + c = Q", r"M a + c = Q")
LAGRANGE_WITH_CONSTRAINTS = Law(
    f"{LAGRANGE.text} + (J^T*lam)_k", LAGRANGE.latex + r" + \left(J^{\mathsf{T}} \lambda\right)_{k}"
)
MATRICES_WITH_CONSTRAINTS = Law(f"{MATRICES.text} + J^T*lam", MATRICES.latex + r" + J^{\mathsf{T}} \lambda")

FROM_THE_START = frozenset(("data", "freedom", "coordinates", "constraints", "along", "laws"))
"""Steps whose formulas hold on the motion from the start alone, or define what the others use."""
SHORT = 900  # characters of the derivatives of T that are printed where rates of dependent coordinates stand in them


def derivation_of(
    equations: EquationsOfMotion,
    method: str,
    *,
    full: bool = False,
    in_time: EquationsOfMotion | None = None,
    reactions: bool = True,
) -> Document:
    """The derivation of the equations of motion of a system.

    By "lagrange" the energies are differentiated in the form in which they are printed, so that each step follows
    from the one before; by "projection" the balance of momentum of every body is projected on its free motions.
    Equations that are too long to print are replaced by their size, unless `full` is set.

    Args:
        equations: those that a user gets; printed with named sub-expressions where the method's own are long.
        full: everything is printed, however long, the long and the repeated parts with names of their own.
        in_time: the same with all that is driven as functions of time; None: they are so.
        reactions: those of joints and constraints follow at the end.
    """
    system = equations.system
    model = system.scope.model
    reader = Reader(full=full, gathers=model.space == "space", positive=system.scope.positive)
    letters = letters_of(system)
    steps, result = _by_method(equations, reader, method, letters)
    known = method == "kinetostatic" or bool(equations.friction)  # the table of the reactions stands further up
    last = reactions_step(equations, reader, letters, table=not known) if reactions else ()
    if method == "kinetostatic" and not isinstance(letters, str):
        last = (*last, *along_the_motion(equations, reader, letters))
    last = (*integral_steps(equations, reader, in_time), *last)
    written = Written(
        (
            *setting_steps(system),
            *steps,
            *result.steps,
            *states_step(system, reader, rates_in_letters(system, letters)),
            *last,
        ),
        result.equations,
        result.definitions,
    )
    graph, taken = equations.symbols.graph, {*system.scope.names, *(symbol.name for symbol, _ in result.definitions)}
    taken |= set() if isinstance(letters, str) else letters.names
    written = with_coefficients_throughout(written, result.coefficients)
    written = with_roots_named(written, graph, taken, reader.roots)
    if full:
        written = with_parts_named(written, graph, taken, reader.raw)
    notation = notation_step(written.steps, system.scope.names, result.meanings)
    declared = {} if isinstance(letters, str) else letters.declared
    document = with_symbols(document_of(model, method, (*written.steps, notation)), declared)
    return replace(document, equations=written.equations, definitions=written.definitions)


def _by_method(
    equations: EquationsOfMotion, reader: Reader, method: str, letters: Lettered | str
) -> tuple[tuple[Step, ...], EquationSteps]:
    """The method's own steps, and its equations of motion.

    Raises:
        DerivationError: by "kinetostatic", where the reactions cannot carry the motion.
    """
    system = equations.system
    if method == "kinetostatic":
        if isinstance(letters, str):
            letters = lettered(Reactions.of(system.free or system), system.scope.names)  # raises what it says
        return kinetostatic_steps(equations, reader, letters)
    steps, result = _BY_METHOD[method](equations, reader)
    if equations.friction and not isinstance(letters, str):
        steps = (*steps, reactions_table_step(letters))
    return steps, result


def _lagrange(equations: EquationsOfMotion, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    """Derivation by the energies; by Maggi's equations where dependent rates make those long or are nonholonomic.

    Speeds that are no rates have no equation of Lagrange's: there the balances are projected (Kane's way).
    """
    system = equations.system
    if system.scope.model.speeds:
        return _projection(equations, reader)
    if system.free is None:
        return _by_energies(equations, reader)
    if _is_integrable(equations):
        momenta = energy_steps.momenta_of(system, reader, _whole(system, reader, SystemInertia(system.motion).bodies))
        if sum(text_size(x) for x in (*momenta.momenta, *momenta.rates, *momenta.held)) <= SHORT:
            return _by_energies(equations, reader)
    return _by_maggi(equations, system.free, reader)


def _is_integrable(equations: EquationsOfMotion) -> bool:
    """True if Lagrange's equations hold in the independent speeds alone, as they do with holonomic constraints."""
    _, c = inertia_by_energies(equations.system.motion, SystemInertia(equations.system.motion).kinetic_energy)
    return equal_at_random_states(zip(c, equations.c, strict=True)).equal


def _by_energies(equations: EquationsOfMotion, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    system = equations.system
    energies = SystemInertia(system.motion).bodies
    T = _whole(system, reader, energies)
    momenta = energy_steps.momenta_of(system, reader, T)
    forces = reader.short_with_symbols(system.loads.generalized_forces)
    velocities = (motion_steps.velocities_step(system, reader, energies),) if energies else ()
    constraints = motion_steps.constraints_step(system, reader)
    steps = (
        *((motion_steps.positions_step(system, reader),) if energies else ()),
        *((*velocities, *constraints) if system.free is None else (*constraints, *velocities)),
        energy_steps.kinetic_energy_step(system, reader, energies, T),
        energy_steps.work_step(system, reader, forces),
    )
    if momenta.momenta:
        steps = (*steps, energy_steps.derivatives_step(system, reader, momenta))
    sides = _lagrange_sides(equations, momenta, forces)
    law = LAGRANGE_WITH_CONSTRAINTS if equations.J else LAGRANGE
    return steps, equations_of(equations, reader, sides, ("Lagrange's equations ", law, ":"))


def _by_maggi(equations: EquationsOfMotion, free: System, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    """Lagrange's equations as if all coordinates were free, put together along the motions that the constraints
    allow."""
    system = equations.system
    energies = SystemInertia(free.motion).bodies
    T = _whole(free, reader, energies)
    momenta = energy_steps.momenta_of(free, reader, T)
    forces = reader.short_with_symbols(free.loads.generalized_forces)
    steps = (
        motion_steps.positions_step(system, reader),
        motion_steps.velocities_step(free, reader, energies),
        *motion_steps.constraints_step(system, reader),
        energy_steps.kinetic_energy_step(free, reader, energies, T),
        energy_steps.work_step(free, reader, forces),
        energy_steps.derivatives_step(free, reader, momenta),
    )
    result = None if equations.friction else maggi_equations(equations, free, reader, momenta, forces)
    if result is None:
        own = derived_by("lagrange", system)
        rule = ("Put together along the motions that the constraints allow, ", MAGGI, ":")
        result = equations_of(equations, reader, sides_of(equations, own.M, own.c, own.Q), rule)
    return steps, result


def _whole(system: System, reader: Reader, energies: tuple[BodyEnergy, ...]) -> Scalar:
    """T of the whole, readable where it is short enough."""
    total = SystemInertia(system.motion).given_energy
    for link, energy in zip(system.motion.links, energies, strict=True):
        total = total + energy.translation + energy.rotation + SystemInertia(system.motion).rotor_energy(link)
    return reader.short((total,))[0]


def _lagrange_sides(equations: EquationsOfMotion, momenta: Momenta, forces: tuple[Scalar, ...]) -> list[Sides]:
    """d/dt dT/du - N^T dT/dq = Q + J^T lam"""
    constraints = multiplier_forces(equations)
    rows = zip(momenta.rates, momenta.held, forces, constraints, strict=True)
    return [Sides(rate - held, force + constraint) for rate, held, force, constraint in rows]


def _projection(equations: EquationsOfMotion, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    system = equations.system
    own = derived_by("projection", system)
    steps: tuple[Step, ...] = (
        motion_steps.positions_step(system, reader),
        *motion_steps.speeds_step(system, reader),
        twists_step(system, reader),
        *motion_steps.constraints_step(system, reader),
    )
    if own.Q:
        steps = (*steps, balance_step(own, reader))
    sides = sides_of(equations, own.M, own.c, own.Q)
    law = MATRICES_WITH_CONSTRAINTS if equations.J else MATRICES
    return steps, equations_of(equations, reader, sides, ("The equations ", law, ":"))


_BY_METHOD = {"lagrange": _lagrange, "projection": _projection}


def printed_formulas(document: Document) -> Printed:
    """The formulas that hold at any state, and the stated first integrals, as they are printed."""
    formulas: list[tuple[str, ...]] = []
    constants: list[tuple[str, str]] = []
    laws = [x for step in document.steps if step.key == "laws" for x in step.statements if isinstance(x, Formula)]
    for step in (step for step in document.steps if step.key not in FROM_THE_START):
        while_ = ""
        for statement in step.statements:
            if isinstance(statement, Prose):
                while_ = prose_text(statement).rstrip(":.").partition(" while ")[2]
            if not isinstance(statement, Formula):
                continue
            sides = tuple(map(side_text, statement.sides))
            if step.key == "integrals" and type(statement.sides[0]) is not Node:  # a symbol is a part of what follows
                constants.append((sides[-1], while_))
            else:
                formulas.append(sides)
    reported = tuple((side_text(x.sides[0]), side_text(x.sides[-1])) for x in laws)
    return Printed(tuple(formulas), tuple(constants), laws=reported)


# -------- names derived ----------------------------------------------------------------------------------------
# A system -> the quantities that a derivation prints under a name: x(bob.center), Q(x, joint of cart), M[x', y'].
#
# Of each there is the name as text and as LaTeX have it, and what it stands for: a function of the outputs where
# there is one, else its value, found by mechanics and not by the page. So a line of a derivation can be read again
# wherever it comes from.

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
