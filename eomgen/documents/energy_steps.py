"""Steps of Lagrange's method, of Newton-Euler projected, of Maggi's equations, and first integrals.

System -> the steps of Lagrange's method: energies, work and generalized forces, the three derivatives.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from eomgen.documents.bounded import page
from eomgen.documents.equation_steps import (
    EquationSteps,
    Sides,
    closing,
    multiplier_forces,
    printed,
    readable_equations,
    taken_in,
)
from eomgen.documents.motion_steps import (
    Pair,
    axes,
    component_pairs,
    is_still,
    listed_symbols,
    moved_coordinates,
    spins,
)
from eomgen.documents.reading import Reader, with_coefficients_named
from eomgen.documents.statements import (
    Entry,
    Formula,
    Law,
    Name,
    Omitted,
    Partial,
    Piece,
    Prose,
    Rate,
    Side,
    Statement,
    Step,
    prose,
)
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import (
    EquationsOfMotion,
    Explicit,
    Extent,
    System,
)
from eomgen.mechanics.integrals import (
    Constant,
    FirstIntegrals,
    Integral,
    laws_of_motion,
)
from eomgen.mechanics.kinematics import (
    Applied,
    BodyEnergy,
    JointEffort,
    SystemInertia,
)
from eomgen.mechanics.start import ExactStart
from eomgen.model import Couple, Load, PointForce
from eomgen.symbolic.expression import Node, Scalar, ScalarRow, depends_on, gradient, inner, is_zero, jacobian, order
from eomgen.symbolic.print import text_size, to_text

T, V = Name("T"), Name("V")
HELD = "Masses are held as they are in d/dt: what leaves a body or enters it has its velocity there, but for a thrust:"

KINETIC = Law(
    "T = 1/2*m*v^2 + 1/2*omega*I*omega", r"T = \tfrac{1}{2} m v^{2} + \tfrac{1}{2} \omega^{\mathsf{T}} I \omega"
)
WORK = Law(
    "Q_k = sum F*dr/dq_k - dV/dq_k",
    r"Q_{k} = \sum F \cdot \frac{\partial r}{\partial q_{k}} - \frac{\partial V}{\partial q_{k}}",
)


@dataclass(frozen=True)
class Momenta:
    """The derivatives of the kinetic energy, one entry a speed, each readable where it is short enough.

    Args:
        T: the kinetic energy that was differentiated.
        momenta: dT/du.
        rates: d/dt dT/du with the masses as they are, linear in the accelerations.
        held: N^T dT/dq.
    """

    T: Scalar
    momenta: tuple[Scalar, ...]
    rates: tuple[Scalar, ...]
    held: tuple[Scalar, ...]


def momenta_of(system: System, reader: Reader, T: Scalar) -> Momenta:
    """The three derivatives of T for each speed."""
    scope = system.scope
    momenta = reader.short(gradient(T, scope.symbols.u))
    gained = SystemInertia(system.motion).carried_momenta
    moved = zip(scope.with_accelerations(momenta), gained, strict=True)
    rates = reader.short(tuple(rate - gain for rate, gain in moved))
    held = reader.short(system.motion.scope.per_speed(gradient(T, scope.symbols.q)))
    return Momenta(T, momenta, rates, held)


def kinetic_energy_step(system: System, reader: Reader, energies: tuple[BodyEnergy, ...], total: Scalar) -> Step:
    """T of each body, then of the whole."""
    formulas = _of_bodies(system, energies)
    if len(formulas) <= 1:
        law = prose(KINETIC if energies else "As it is given", ":")
        return Step("kinetic_energy", "Kinetic energy", (law, *page(reader, [(T, total)])))
    statements = (prose("Of each body ", KINETIC, ":"), *page(reader, formulas), prose("Together:"))
    together = reader.as_sum(total, [x for _, x in formulas])
    return Step("kinetic_energy", "Kinetic energy", (*statements, *page(reader, [(T, together)])))


def _of_bodies(system: System, energies: Sequence[BodyEnergy]) -> list[Pair]:
    """The kinetic energy of each body, of each rotor, and given kinetic energies."""
    formulas: list[Pair] = []
    for link, energy in zip(system.motion.links, energies, strict=True):
        of_body = energy.translation + energy.rotation
        if not is_zero(of_body):
            formulas.append((Name("T", link.name), of_body))
        rotor = SystemInertia(system.motion).rotor_energy(link)
        if not is_zero(rotor):
            formulas.append((Name("T", f"{link.name}, rotor"), rotor))
    given = SystemInertia(system.motion).given_energy
    return formulas if is_zero(given) else [*formulas, (Name("T", "given"), given)]


def energies_by_parts(system: System, reader: Reader, T: Scalar) -> tuple[Scalar, Scalar]:
    """(T, V), each as the sum over bodies or forces where that is shorter."""
    bodies = [x for _, x in _of_bodies(system, SystemInertia(system.motion).bodies)]
    V, loads = system.loads.potential_energy, system.loads
    held = [*(force.potential for force in loads.applied), *(effort.potential for effort in loads.efforts)]
    potentials = [reader.as_square(x) for x in held if x is not None and not is_zero(x)]
    return reader.as_sum(T, bodies), reader.as_sum(V, potentials)


def work_step(system: System, reader: Reader, forces: tuple[Scalar, ...]) -> Step:
    """The work of each force, and the generalized forces of everything applied."""
    names = moved_coordinates(system)
    formulas = [f for force in system.loads.applied for f in _force(system, force)]
    formulas += [f for effort in system.loads.efforts for f in _effort(system, effort)]
    formulas = [(name, reader.as_square(x) if _is_potential(name) else x) for name, x in formulas]
    statements: list[Statement] = []
    if not system.loads.applied and not system.loads.efforts:
        statements.append(prose("Nothing is applied."))
    elif names or formulas:
        statements.append(prose("Potentials and virtual work, ", WORK, ":"))
    else:
        statements.append(prose("Nothing is free to move: what is applied enters the reactions alone."))
    statements += [said for force in system.loads.applied for said in _flowing(system, force)]
    statements += page(reader, formulas)
    potentials = [x for name, x in formulas if _is_potential(name)]
    if len(potentials) > 1:
        statements += [prose("The potential energy together:")]
        statements += page(reader, [(V, reader.as_sum(system.loads.potential_energy, potentials))])
    if names:
        statements.append(prose("The generalized forces of everything applied:"))
        statements += page(reader, [(Name("Q", by=q), Q) for q, Q in zip(names, forces, strict=True)])
    return Step("work", "Work and generalized forces", tuple(statements))


def _flowing(system: System, force: Applied) -> Iterator[Statement]:
    """Sentence that says of a thrust whose mass it is, and how much of it flows."""
    flow = system.scope.model.forces[force.name].flow
    if flow is not None:
        body, said = flow
        rate = system.scope.unsaid_rate(body) if said is None else system.scope.value(said)
        words = f"Mass enters {body} at {force.name}, {to_text(rate)} per second. "
        yield prose(words, "The force is that times its velocity relative to the body there:")


def _is_potential(name: Side) -> bool:
    return isinstance(name, Name) and name.letter == "V"


def _force(system: System, force: Applied) -> list[Pair]:
    """The potential of a force, or its kind and its virtual work."""
    if force.potential is not None:
        return [(Name("V", force.name), force.potential)]
    formulas: list[Pair] = []
    for number, load in enumerate(force.loads, start=1):
        formulas += _load(system, load, force.name if len(force.loads) == 1 else f"{force.name} {number}")
    return formulas + _contributions(system, force.name, system.loads.force_row(force))


def _load(system: System, load: Load, name: str) -> list[Pair]:
    if isinstance(load, PointForce) and load.place[0] is not None and load.axes is None:
        return component_pairs(system, "F", name, load.force)
    if isinstance(load, Couple) and len(axes(system)) == 2:
        return [(Name("couple", name), load.couple[2])]
    return []


def _contributions(system: System, name: str, row: tuple[Scalar, ...]) -> list[Pair]:
    names = moved_coordinates(system)
    return [(Name("Q", name, q), x) for q, x in zip(names, row, strict=True) if not is_zero(x)]


def _effort(system: System, effort: JointEffort) -> list[Pair]:
    """A joint's spring, and the virtual work of its drive and damper."""
    name = f"joint of {effort.body}"
    formulas: list[Pair] = [] if is_zero(effort.potential) else [(Name("V", name), effort.potential)]
    if is_zero(effort.drive):
        return formulas
    return formulas + _contributions(system, name, system.loads.effort_row(effort))


def derivatives_step(system: System, reader: Reader, momenta: Momenta) -> Step:
    """dT/du, d/dt dT/du and dT/dq of each speed."""
    formulas: list[Pair] = []
    for k, (u, q) in enumerate(zip(system.symbols.u, moved_coordinates(system), strict=True)):
        momentum = Partial(T, u)
        formulas += [
            (momentum, momenta.momenta[k]),
            (Rate(momentum), momenta.rates[k]),
            (Partial(T, q), momenta.held[k]),
        ]
    words = (prose(HELD),) if SystemInertia(system.motion).changes else ()
    return Step("derivatives", "Derivatives of the kinetic energy", (*words, *page(reader, formulas)))


# -------- projection steps ------------------------------------------------------------------------------------
# System -> the steps of the projection of Newton-Euler: velocities by twists, M, c and Q as projected wrenches.


BALANCE = Law(
    "m*a = F, I*epsilon + omega x I*omega = tau",
    r"m a = F, \quad I \varepsilon + \omega \times I \omega = \tau",
)
PROJECTED = Law(
    "sum (m*a - F)*dv/du_k + (I*epsilon + omega x I*omega - tau)*domega/du_k = 0",
    r"\sum \left(m a - F\right) \cdot \frac{\partial v}{\partial u_{k}}"
    r" + \left(I \varepsilon + \omega \times I \omega - \tau\right) \cdot \frac{\partial \omega}{\partial u_{k}} = 0",
)


def twists_step(system: System, reader: Reader) -> Step:
    """Velocities of the mass centres and angular velocities, from body to body along the tree."""
    formulas: list[Pair] = []
    for link in system.motion.links:
        body = system.scope.mass_properties(link.name)
        if not is_zero(body.m):
            velocity = system.motion.velocity((link.name, body.com))
            if not is_still(velocity):
                formulas += component_pairs(system, "v", f"{link.name}.center", velocity)
        formulas += spins(system, link.name, link.twist.w)
    words = "Each body moves with the body that carries it and by its own joint:"
    return Step("velocities", "Velocities", (prose(words), *page(reader, formulas)))


def balance_step(equations: EquationsOfMotion, reader: Reader) -> Step:
    """M, c and Q: the balance of momentum of every body along the motions that the joints allow."""
    u, q = equations.system.symbols.u, moved_coordinates(equations.system)
    inertia: list[Pair] = [
        (Entry("M", u[i], u[j]), equations.M[i][j])
        for i in range(len(u))
        for j in range(i, len(u))
        if not is_zero(equations.M[i][j])
    ]
    inertia += [(Name("c", by=x), c) for x, c in zip(u, equations.c, strict=True)]
    forces: list[Pair] = [(Name("Q", by=x), Q) for x, Q in zip(q, equations.Q, strict=True)]
    statements = (
        prose("For each body ", BALANCE, ". Ideal joints do no work on the motions that they allow, so that"),
        Formula((PROJECTED,)),
        prose("Sorted by accelerations:"),
        *page(reader, inertia),
        *page(reader, forces),
    )
    return Step("balance", "Balance of momentum along the free motions", statements)


# -------- maggi steps -----------------------------------------------------------------------------------------
# System with dependent coordinates -> Maggi's equations: Lagrange's of all coordinates, put together along the
# constraints.
#
#     sum_i N_ik (d/dt dT/dq_i' - dT/dq_i - Q_i) = (J^T lam)_k
#
# They need no T in which the dependent rates were replaced, and hold where constraints restrict velocities only.
# Source:
# Neimark & Fufaev, Dynamics of Nonholonomic Systems (1972), chapter III.


MAGGI = Law(
    "sum_i N_ik*(d/dt(dT/dq_i') - dT/dq_i) = sum_i N_ik*Q_i",
    r"\sum_{i} N_{ik} \left(\frac{d}{dt} \frac{\partial T}{\partial \dot{q}_{i}}"
    r" - \frac{\partial T}{\partial q_{i}}\right) = \sum_{i} N_{ik} Q_{i}",
)
WITH_CONSTRAINTS = Law(MAGGI.text + " + (J^T*lam)_k", MAGGI.latex + r" + \left(J^{\mathsf{T}} \lambda\right)_{k}")


def maggi_equations(
    equations: EquationsOfMotion, free: System, reader: Reader, momenta: Momenta, forces: ScalarRow
) -> EquationSteps | None:
    """The equations in the rates of all coordinates, and those of the dependent ones; None where they are long.

    Args:
        momenta, forces: of the free system, one entry a coordinate.
    """
    system = equations.system
    N = jacobian(system.free_rates(free), system.scope.symbols.u)
    inertia = [rate - held for rate, held in zip(momenta.rates, momenta.held, strict=True)]
    columns = list(zip(*N, strict=True))
    constraints = multiplier_forces(equations)
    sides = [
        Sides(inner(column, inertia), inner(column, forces) + constraint)
        for column, constraint in zip(columns, constraints, strict=True)
    ]
    written = readable_equations(reader, equations, sides)
    followers = _followers(system, free, N)
    shown = [(symbol, reader.shown(x)) for symbol, x in followers]
    if written is None or any(isinstance(x, Omitted) for _, x in shown):
        return None
    law = WITH_CONSTRAINTS if equations.J else MAGGI
    words = "Lagrange's equations of all coordinates, put together along the motions that the constraints allow, "
    named = with_coefficients_named(system.scope, written, taken_in(equations))
    statements = (
        prose(words, law, ":"),
        *printed(system, named.equations),
        *closing(reader, equations),
        prose("The dependent coordinates follow, their rates as above:"),
        *map(Formula, shown[len(shown) // 2 :]),
    )
    definitions = tuple((symbol, x) for symbol, x in shown if not isinstance(x, Omitted))
    definitions = (*named.definitions, *definitions)
    steps = (Step("equations", "Equations of motion", statements),)
    return EquationSteps(named.equations, definitions, steps, named.meanings)


def _followers(system: System, free: System, N: Sequence[ScalarRow]) -> list[tuple[Node, Scalar]]:
    """u_d = A u + b, then a_d = A a + A' u + b', in the rates of all coordinates, of each dependent one."""
    rates = dict(zip(free.symbols.u, system.free_rates(free), strict=True))
    dependent = [k for k, u in enumerate(free.symbols.u) if u not in system.symbols.u]
    found = [(free.symbols.u[k], rates[free.symbols.u[k]]) for k in dependent]
    for k in dependent:
        bias = dict(zip(system.symbols.q, system.scope.nu, strict=True))
        own = next(x for q, x in bias.items() if f"{q.name}'" == free.symbols.u[k].name)
        *slopes, drift = free.scope.time_derivative((*N[k], own))
        found.append((free.symbols.a[k], inner(N[k], system.symbols.a) + inner(slopes, system.symbols.u) + drift))
    return found


# -------- integral steps --------------------------------------------------------------------------------------
# Equations of motion -> the steps after the equations of motion: cyclic coordinates, energy, laws of motion.


MOST_SPEEDS = 6  # of a system whose laws of motion are sought
LONGEST_LAW = 400  # characters of a law that is printed

ENERGY = Law("T + V", "T + V")
ENERGY_AND_WORK = Law("T + V - W", "T + V - W")
AT_MOST, AT_LEAST = Law("<=", r"\leq"), Law(">=", r"\geq")
JACOBI = Law("sum u_k*dT/du_k - T + V", r"\sum u_{k} \frac{\partial T}{\partial u_{k}} - T + V")


def integral_steps(
    equations: EquationsOfMotion, reader: Reader, in_time: EquationsOfMotion | None = None
) -> tuple[Step, ...]:
    """First integrals, and laws of motion from the model's start; no step where there are none.

    Args:
        in_time: the same with all that is driven as functions of time; None: they are so.
    """
    laws = (
        _laws(equations, reader)
        if in_time is None
        else _laws(in_time, Reader(gathers=reader.gathers, positive=reader.positive))
    )
    return (*_integrals(equations, reader), *laws)


def _integrals(equations: EquationsOfMotion, reader: Reader) -> tuple[Step, ...]:
    symbols = equations.symbols
    cyclic = [each for each in FirstIntegrals(equations).of_momentum if not depends_on(each.expression, (symbols.t,))]
    statements: list[Statement] = []
    if cyclic:
        moving = {q.name: q for q in symbols.q}
        speeds = {u.name.removesuffix("'"): u for u in symbols.u}
        rates = [each for each in cyclic if speeds[each.coordinate].name != each.coordinate]
        for held, group in groupby(rates, key=lambda each: each.held):
            each_held = tuple(group)
            statements.append(_cyclic(tuple(moving[each.coordinate] for each in each_held), held))
            pairs = [(Partial(Name("T"), speeds[each.coordinate]), each.expression) for each in each_held]
            statements += page(reader, pairs)
        for each in (other for other in cyclic if other not in rates):
            words = ("The momentum of the speed ", speeds[each.coordinate], " stays constant")
            statements.append(prose(*words, *while_words(each.held), ":"))
            statements += page(reader, [(Partial(Name("T"), speeds[each.coordinate]), each.expression)])
    energies = FirstIntegrals(equations).of_energy
    for energy in energies:
        statements += _energy(reader, equations, energy)
    statements += _of_the_whole(equations, reader, [each.expression for each in (*cyclic, *energies)])
    return (Step("integrals", "First integrals", tuple(statements)),) if statements else ()


def _of_the_whole(equations: EquationsOfMotion, reader: Reader, known: Sequence[Scalar]) -> list[Statement]:
    """Momentum and angular momentum of all bodies together, ground axes, where they stay."""
    statements: list[Statement] = []
    found = FirstIntegrals(equations).momenta_of_the_whole(known)
    for about, group in groupby(found, key=lambda each: (each.letter, each.about)):
        what = "momentum" if about[0] == "P" else f"angular momentum about {about[1]}"
        statements.append(prose(f"The {what}, in the axes of the ground, stays constant:"))
        statements += page(reader, [(_side(each), each.expression) for each in group])
    return statements


def _side(each: Constant) -> Name:
    return Name(f"{each.letter}_{each.axis}") if each.axis else Name(each.letter, power=2)


def _cyclic(coordinates: tuple[Node, ...], held: Extent) -> Prose:
    many = len(coordinates) > 1
    verb = ("s ", " are cyclic: their momenta stay") if many else (" ", " is cyclic: its momentum stays")
    if not held.everywhere:
        verb = ("s ", ": their momenta stay") if many else (" ", ": its momentum stays")
    return prose(
        f"The coordinate{verb[0]}", *listed_symbols(coordinates), f"{verb[1]} constant", *while_words(held), ":"
    )


def while_words(held: Extent) -> tuple[Piece, ...]:
    """ " while y >= 0" of what holds in some pieces alone."""
    words: list[Piece] = []
    for each in held.within:
        left, right = (x if type(x) is Node else to_text(x) for x in (each.left, each.right))
        words += [
            " and " if words else " while ",
            left,
            " ",
            AT_MOST if each.relation == "<=" else AT_LEAST,
            " ",
            right,
        ]
    return tuple(words)


def _energy(reader: Reader, equations: EquationsOfMotion, energy: Integral) -> list[Statement]:
    """T + V, or T + V - W, and that it stays constant; in words alone where it is written piece by piece."""
    law = ENERGY
    words: tuple[Piece, ...] = ("The energy ", ENERGY, " stays constant")
    if energy.name == "jacobi":
        law = JACOBI
        words = ("What moves by itself does so at a steady rate, and Jacobi's integral ", JACOBI, " stays constant")
    elif energy.expression is not equations.T + equations.V:
        law = ENERGY_AND_WORK
        words = ("The energy less the work of the constant forces, ", law, ", stays constant")
    words = (*words, *while_words(energy.held))
    if any(node.op == "select" for node in order((energy.expression,))):
        return [prose(*words, ".")]
    if law is not JACOBI:
        T, V = energies_by_parts(equations.system, reader, equations.T)
        parts = [T, V, *([-FirstIntegrals(equations).work_of_constant_forces] if law is ENERGY_AND_WORK else [])]
        return [prose(*words, ":"), *page(reader, [(law, reader.as_sum(energy.expression, parts))])]
    return [prose(*words, ":"), *page(reader, [(law, energy.expression)])]


def _laws(equations: EquationsOfMotion, reader: Reader) -> tuple[Step, ...]:
    """q(t) of the coordinates whose equations are solved in closed form."""
    system = equations.system
    symbols = system.symbols
    if not 0 < len(symbols.u) <= MOST_SPEEDS or symbols.inputs or system.free is not None:
        return ()
    accelerations = Explicit(equations).short
    start = None if accelerations is None else ExactStart(system).known
    laws = {} if accelerations is None or start is None else laws_of_motion(system, accelerations, start)
    free = {u.name.removesuffix("'") for u in symbols.u}
    found = [(q, laws[q]) for q in symbols.q if q in laws and q.name in free and text_size(laws[q]) <= LONGEST_LAW]
    if not found:
        return ()
    words = prose("From the start values, in closed form:")
    return (Step("laws", "Laws of motion", (words, *(Formula((q, _law(reader, x))) for q, x in found))),)


def _law(reader: Reader, x: Scalar) -> Scalar:
    """A law as it was found, which is shorter than multiplied out, with symbols for its roots."""
    return reader.with_symbols((x,))[0]
