"""What a derivation prints is true: every printed formula reads back and is the function that it says."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from itertools import pairwise
from math import prod
from pathlib import Path

import pytest
from derivations import (
    LARGE,
    at_unit_norms,
    by_every_method,
    by_methods,
    derivable,
    entries,
    equations,
    free_system,
    in_time,
    model_called,
    read_back,
    residuals,
    symbols_named,
)
from slow_run import ALL as ALL_MODELS
from slow_run import sampled, usual

from eomgen.documents.derivation import derivation_of
from eomgen.documents.document import Document
from eomgen.documents.json_form import as_dict
from eomgen.documents.latex import symbols_in
from eomgen.documents.motion_steps import moved_coordinates
from eomgen.documents.proven_documents import proven
from eomgen.documents.reading import Reader
from eomgen.documents.result import ALL, rendered
from eomgen.documents.statements import MEANINGS, Entry, Formula, Name, Partial, Prose, Rate, Step, quantities
from eomgen.documents.text import WIDTH, broken, formula_text
from eomgen.equations import Equations
from eomgen.errors import UsageError
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.kinematics.inertia import SystemInertia
from eomgen.proof.check import Certificate
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import gradient, substituted
from eomgen.symbolic.expression.formula import sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node, Scalar
from eomgen.symbolic.print.layout import MOST_DIGITS
from eomgen.symbolic.print.text import to_text

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

GOLDEN = Path(__file__).parent / "golden"
SMALL = tuple(name for name in derivable() if name not in LARGE)
DEAR = () if ALL_MODELS else ("car_axis",)
FORMATS = tuple(member.name for member in ALL)

KINETIC_ENERGIES = {
    "ch17_p3": "1/6*M*l^2*theta'^2",
    "ch18_p4": "2*M*(2*x'^2 + 3*l*cos(phi)*x'*phi' + 2*l^2*phi'^2)",
    "ch22_p1": "3/2*M*R^2*(4 + 9*cos(theta)^2)*theta'^2",
    "ch22_p2": "M*(2*l^2 + r^2)*theta'^2 + M*r'^2",
    "ch22_p5": "M*(3*x'^2 + 6*R*cos(theta)*x'*theta' + 8*R^2*theta'^2)",
}


def step(derivation: Document, key: str) -> Step:
    return next(step for step in derivation.steps if step.key == key)


def printed_formulas(text: str, sides: Sequence[int] = (2,)) -> list[tuple[str, str]]:
    """(left, last) of each formula of a rendered text that has so many sides, continued lines and cases joined."""
    text = re.sub(r"\n {16}", " ", text)
    text = re.sub(r"(?<= =)((?:\n {8}\S.*)+)", lambda cases: " " + "; ".join(cases[0].split("\n        ")[1:]), text)
    lines = [line.strip() for line in re.sub(r"\n {8}", " ", text).splitlines() if line.startswith("    ")]
    return [(line.split(" = ")[0], line.split(" = ")[-1]) for line in lines if line.count(" = ") + 1 in sides]


def printed_equations(text: str) -> list[tuple[str, str]]:
    """(left, right) of each formula of the step of the equations of motion."""
    section = re.split(r"\n\n\d+\. ", text.split("Equations of motion\n")[1])[0]
    return printed_formulas(section.split("The constraints, differentiated")[0])


def printed_definitions(text: str, derived: Equations, derivation: Document) -> dict[str, Scalar]:
    """What the printed names of sub-expressions stand for; each is printed once, before its use."""
    names = {symbol.name for symbol, _ in derivation.definitions}
    found: dict[str, Scalar] = {}
    friction = re.split(r"\n\n\d+\. ", text.partition("Friction\n---")[2])[0]
    single = printed_formulas(text)
    sized = dict(printed_formulas(friction, (3,)))  # F = -mu sign(s') |N| = ...
    for left, right in printed_formulas(text, (2, 3)):
        if right != sized.get(left, right) or (left not in sized and (left, right) not in single):
            continue
        if left in names:
            assert left not in found
            found[left] = read_back(right, derived, found)
    assert list(found) == [symbol.name for symbol, _ in derivation.definitions]
    free, own = free_system(derived).symbols, derived.graph.symbols
    dependent = {symbol.name for symbol in (*free.u, *free.a) if symbol not in (*own.u, *own.a)}
    assert not names & (symbols_named(derived).keys() - dependent)
    return found


def without_names(derivation: Document, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """The scalars with everything that has a name written out."""
    known: dict[Node, Scalar] = {}
    for symbol, value in derivation.definitions:
        known[symbol] = substituted((value,), known)[0]
    return substituted(scalars, known)


@sampled(3)
@pytest.mark.parametrize(("name", "method"), [pair for pair in by_every_method() if pair[0] in SMALL])
def test_printed_equations_read_back_as_the_equations_of_motion(name, method):
    """divisor (left - right) = M a + c - Q - J^T lam"""
    derived = equations(name, method)
    assert_printed_equations_are_those_of_motion(derived, in_time(derived))


@pytest.mark.parametrize("name", ["arm7", "chain20"])
def test_a_full_derivation_of_a_large_model_reads_back_as_its_equations_of_motion(name):
    """M a + c = Q through all of z1, z2, ..., each printed once, before its use"""
    derived = equations(name)
    full = derivation_of(derived.graph, "lagrange", full=True)
    text = rendered(full, "text")
    assert "too long" not in text
    assert all(len(line) <= WIDTH for line in text.splitlines())
    assert_printed_equations_are_those_of_motion(derived, full)
    energy = next(f for f in step(full, "kinetic_energy").statements[::-1] if isinstance(f, Formula))
    assert equal_at_random_states([(without_names(full, energy.sides[1:])[0], derived.graph.T)]).equal


def assert_printed_equations_are_those_of_motion(derived: Equations, derivation: Document) -> None:
    """divisor (left - right) = M a + c - Q - J^T lam; with friction, whose N hold accelerations, along every motion"""
    text = rendered(derivation, "text")
    also = printed_definitions(text, derived, derivation)
    printed = [(left, right) for left, right in printed_equations(text) if left not in also]
    assert len(derivation.equations) == len(derived.graph.symbols.u)
    pairs = [
        (equation.divisor * (read_back(left, derived, also) - read_back(right, derived, also)), residual)
        for (left, right), equation, residual in zip(printed, derivation.equations, residuals(derived), strict=True)
    ]
    if derived.graph.friction:
        motion = dict(zip(derived.graph.symbols.a, derived.graph.accelerations or (), strict=True))
        pairs = [substituted(pair, motion) for pair in pairs]
    assert equal_at_random_states(at_unit_norms(derived, pairs)).equal


def is_complete(part: Step) -> bool:
    """Whether nothing of a step is too long to print."""
    words = [piece for s in part.statements if isinstance(s, Prose) for piece in s.pieces if isinstance(piece, str)]
    return "too long to print" not in "".join(words)


def by_energies(name: str) -> bool:
    """Whether the derivation goes by energies: with declared speeds it goes by projection."""
    return not model_called(name).speeds


@pytest.mark.parametrize(
    "name", usual([name for name in SMALL if name not in ("chain5", *DEAR) and by_energies(name)], 2, 1)
)
def test_printed_derivatives_are_derivatives_of_the_printed_kinetic_energy(name):
    """dT/du, d/dt dT/du and dT/dq of T = sum of the bodies' T, all as printed"""
    derived = equations(name)
    also = printed_definitions(rendered(in_time(derived), "text"), derived, in_time(derived))
    energy = step(in_time(derived), "kinetic_energy")
    system = _printed_system(derived)
    for free in (*system.symbols.u, *system.symbols.a):  # rates of dependent coordinates, as they stand there
        also.pop(free.name, None)
    T = SystemInertia(system.motion).kinetic_energy
    pairs = []
    if is_complete(energy):
        total = next(f for f in energy.statements[::-1] if isinstance(f, Formula))
        pairs.append((read_back(to_text(total.sides[1]), derived, also), T))
    for formula in _derivatives(in_time(derived)):
        of, x = formula.sides
        momentum = of.of if isinstance(of, Rate) else of
        expected = gradient(T, (momentum.by,))[0]
        if isinstance(of, Rate):
            expected = system.scope.with_accelerations((expected,))[0]
        elif isinstance(of, Partial) and of.by in system.symbols.q:
            expected = system.motion.scope.per_speed(gradient(T, system.symbols.q))[
                moved_coordinates(system).index(of.by)
            ]
        pairs.append((read_back(to_text(x), derived, also), expected))
    if all(map(is_complete, in_time(derived).steps)):
        assert len(pairs) == 1 + 3 * len(system.symbols.u)
    assert equal_at_random_states(at_unit_norms(derived, pairs)).equal


def _printed_system(derived: Equations) -> System:
    """The system that the derivatives are printed of: the free one where dependent rates stand in them."""
    by = {of.by for f in _derivatives(in_time(derived)) for of in f.sides if isinstance(of, Partial)}
    return derived.system if by <= {*derived.system.symbols.x} else free_system(derived)


def _derivatives(derivation: Document) -> list[Formula]:
    steps = [step for step in derivation.steps if step.key == "derivatives"]
    return [f for step in steps for f in step.statements if isinstance(f, Formula)]


@pytest.mark.parametrize("name", [name for name in SMALL if by_energies(name) and name not in DEAR])
def test_printed_generalized_forces_are_those_of_the_equations(name):
    """Q(theta) as printed = Q of the equations"""
    derived = equations(name)
    formulas = [f for f in step(in_time(derived), "work").statements if isinstance(f, Formula)]
    total = [
        f.sides[1]
        for f in formulas
        if isinstance(f.sides[0], Name) and f.sides[0].letter == "Q" and f.sides[0].of == ""
    ]
    also = printed_definitions(rendered(in_time(derived), "text"), derived, in_time(derived))
    forces = _printed_system(derived).loads.generalized_forces
    pairs = [(read_back(to_text(x), derived, also), Q) for x, Q in zip(total, forces, strict=True)]
    assert equal_at_random_states(at_unit_norms(derived, pairs)).equal


@pytest.mark.parametrize("name", [name for name in SMALL if not by_energies(name)])
def test_printed_balance_of_momentum_is_that_of_the_equations(name):
    """M, c and Q of the declared speeds, as printed"""
    derived = equations(name)
    also = printed_definitions(rendered(in_time(derived), "text"), derived, in_time(derived))
    formulas = [f for f in step(in_time(derived), "balance").statements if isinstance(f, Formula)]
    printed = dict(f.sides for f in formulas if len(f.sides) == 2)
    graph = derived.graph
    u, q = graph.symbols.u, moved_coordinates(derived.system)
    known = {Entry("M", u[i], u[j]): row[j] for i, row in enumerate(graph.M) for j in range(i, len(row))}
    known |= {Name("c", by=x): c for x, c in zip(u, graph.c, strict=True)}
    known |= {Name("Q", by=x): Q for x, Q in zip(q, graph.Q, strict=True)}
    pairs = [(read_back(to_text(printed.get(name, 0)), derived, also), x) for name, x in known.items()]
    assert equal_at_random_states(at_unit_norms(derived, pairs)).equal


@pytest.mark.parametrize("name", [name for name in SMALL if name != "loop"])
def test_printed_accelerations_solve_the_printed_equations(name):
    """M a = Q - c with a as printed (over the printed determinant)"""
    derived = equations(name)
    solved = [s for s in in_time(derived).steps if s.key == "solved"]
    if not solved:
        one = len(derived.graph.symbols.u) == 1 and _printed_system(derived) is derived.system
        assert not one, "one equation is always solved"
        return
    formulas = [f for f in solved[0].statements if isinstance(f, Formula)]
    a = derived.graph.symbols.a
    if len(formulas) == len(a):
        values, scale = [f.sides[1] for f in formulas], 1
    else:
        scale, values = formulas[0].sides[1], [f.sides[1] for f in formulas[1:]]
    scale, *values = without_names(in_time(derived), (scale, *values))
    rows = [
        (sum((m * x for m, x in zip(row, values, strict=True)), start=0), scale * force)
        for row, force in zip(derived.graph.M, derived.graph.forcing, strict=True)
    ]
    assert equal_at_random_states(rows).equal


@pytest.mark.parametrize("name", KINETIC_ENERGIES)
def test_kinetic_energies_come_out_as_a_textbook_prints_them(name):
    """T = 3/2*M*R^2*(4 + 9*cos(theta)^2)*theta'^2, in the text and in JSON"""
    derived = equations(name)
    text = re.sub(r"\n {8}", " ", rendered(in_time(derived), "text"))
    printed = re.search(r"^    T = (.*)$", text, re.M)
    assert printed is not None
    assert printed[1] == derived.entries()["kinetic_energy"] == KINETIC_ENERGIES[name]


@sampled(2)
@pytest.mark.parametrize("name", usual([*derivable()], 3, 1))
def test_the_payload_reads_back_as_the_equations(name):
    """N, nu, M, forcing, J, sigma, gamma, phi, T, V, Q and each `lhs = rhs`, through text and back

    Slow: all that is written of the largest models is parsed again.
    """
    derived, data = equations(name), entries(name)
    graph, also = derived.graph, {}
    for symbol, text in data.get("definitions", []):
        assert symbol not in symbols_named(derived)
        also[symbol] = read_back(text, derived, also)
    pairs = [
        (read_back(text, derived, also), x)
        for key, rows in (("kinematic_matrix", graph.N), ("mass_matrix", graph.M), ("constraint_jacobian", graph.J))
        for texts, row in zip(data[key], rows, strict=True)
        for text, x in zip(texts, row, strict=True)
    ]
    for key, vector in (
        ("kinematic_bias", graph.nu),
        ("forcing", graph.forcing),
        ("velocity_bias", graph.sigma),
        ("constraint_bias", graph.gamma),
        ("gaps", graph.phi),
    ):
        texts = data[key]
        assert [text is None for text in texts] == [x is None for x in vector]
        pairs += [(read_back(t, derived, also), x) for t, x in zip(texts, vector, strict=True) if t is not None]
    pairs += [(read_back(data["kinetic_energy"], derived, also), graph.T)]
    pairs += [(read_back(data["potential_energy"], derived, also), graph.V)]
    pairs += [
        (read_back(data["generalized_forces"][u], derived, also), Q)
        for u, Q in zip(data["speeds"], graph.Q, strict=True)
    ]
    for equation, residual in zip(data["equations"], residuals(derived), strict=True):
        left, right = equation.split(" = ")
        pairs.append((read_back(left, derived, also) - read_back(right, derived, also), residual))
    assert equal_at_random_states(at_unit_norms(derived, pairs)).equal


def test_the_payload_has_the_keys_that_others_rely_on():
    """Names and shapes of DESIGN 5"""
    data = as_dict(proven(equations("loop").document, Certificate(())))
    assert data["schema_version"] == 1
    assert data["coordinates"] == ["theta1", "phi", "x_c", "lambda"]
    assert data["speeds"] == ["theta1'", "phi'", "x_c'"]
    assert data["unknowns"] == ["theta1''", "phi''", "x_c''", "lam(B, 1)", "lam(B, 2)", "lam(eq, 1)"]
    assert data["parameters"]["l_max"] == 0.4 and data["parameters"]["k"] is None
    assert data["inputs"] == {"F": "5*sin(2*t)"}
    assert data["kinematic_matrix"][3] == ["0", "0", "0"]
    assert data["kinematic_bias"][3] == "theta_1*Omega*cos(Omega*t)"
    assert data["gaps"][2] is None and data["gaps"][1] is not None
    assert data["certificate"] == {"ok": None, "checks": []}
    assert as_dict(proven(equations("loop").document, None))["certificate"] is None
    assert "definitions" not in data


@sampled(2)
@pytest.mark.parametrize(("name", "method"), by_methods())
def test_every_symbol_that_is_used_is_named_in_the_nomenclature(name, method):
    """symbols of the formulas are rows of a table or defined; letters are in the notation"""
    derivation = equations(name, method).derivation
    named = {row.symbol.name for row in derivation.nomenclature if isinstance(row.symbol, Node)}
    named |= {symbol.name for symbol, _ in derivation.definitions} | {"D"}
    letters = {row.symbol.letter for row in derivation.nomenclature if isinstance(row.symbol, Name)}
    for part in derivation.steps:
        for statement in part.statements:
            assert {symbol.name for symbol in symbols_in(statement)} <= named
            assert {quantity.letter for quantity in quantities(statement)} <= letters
    parameters = equations(name, method).parameters
    assert all(row.meaning or row.symbol.name in parameters for row in derivation.nomenclature)
    assert letters <= MEANINGS.keys()


@sampled(2)
@pytest.mark.parametrize("name", derivable())
def test_rendering_is_the_same_on_every_run_and_stays_readable(name):
    """No report is longer than a short chapter, whatever the size of the model and the format"""
    for format in FORMATS:
        text = rendered(equations(name).derivation, format)
        assert text == rendered(equations(name).derivation, format), format
        assert len(text) < 80_000, format
        assert text.endswith("\n"), format


def root_twice(text: str) -> str:
    """A root that a product of the text has twice, sqrt(x)*a*sqrt(x) or sqrt(x)^2; "" where none has."""
    products: list[set[str]] = [set()]
    k = 0
    while k < len(text):
        if text.startswith("sqrt(", k):
            depth, end = 1, k + 5
            while depth and end < len(text):
                depth += {"(": 1, ")": -1}.get(text[end], 0)
                end += 1
            root = text[k:end]
            if root in products[-1] or re.match(r"\^\d", text[end:]):
                return root
            products[-1].add(root)
            k += 5
            products.append(set())
            continue
        if text[k] == "(":
            products.append(set())
        elif text[k] == ")":
            products = products[:-1] or [set()]
        elif not re.match(r"[\w*/^.']", text[k]):
            products[-1] = set()
        k += 1
    return ""


@pytest.mark.parametrize("name", derivable())
def test_no_product_has_the_same_root_twice(name):
    """sqrt(x)*sqrt(x) = x"""
    assert not list(filter(None, map(root_twice, rendered(equations(name).derivation, "text").splitlines())))


def test_a_root_that_stands_twice_is_seen_and_is_not_printed():
    graph = Graph()
    a, b, x = (graph.symbol(name) for name in "abx")
    root = sqrt(a + x)
    assert to_text((root * a) * (root * b)) == "a*b*(a + x)"
    assert to_text((root * a) * (root * b) * root) == "a*b*(a + x)*sqrt(a + x)"
    assert to_text(a / (root * b) / root) == "a/(b*(a + x))"
    assert root_twice("2*sqrt(x)*(a + b)*sqrt(x)") and root_twice("c - sqrt(x)^2") and root_twice("(sqrt(a)*sqrt(a))")
    assert not root_twice("sqrt(x) + sqrt(x)") and not root_twice("sqrt(x)*(1 - sqrt(x))")


@pytest.mark.parametrize("name", LARGE)
def test_what_is_too_long_to_print_is_said_with_its_size(name):
    """operations, and where to get them"""
    text = rendered(equations(name).derivation, "text")
    assert re.search(r"The equations take \d{3,5} operations and are too long to print here", text)
    assert "`eomgen derive MODEL --full`" in text
    assert equations(name).derivation.equations == ()


@pytest.mark.parametrize("name", SMALL)
def test_text_fits_a_page_of_a_hundred_columns(name):
    """a piece that cannot be broken may stand out; nothing else"""
    for line in rendered(equations(name).derivation, "text").splitlines():
        assert len(line) <= WIDTH or not re.search(r" [-+=] ", line.strip()[2:])


def test_a_long_formula_is_broken_before_signs_of_the_least_depth():
    """a + (b + c) breaks before the outer plus"""
    assert broken("T = aaaa*(bbb + ccc) + dddd", "  ", 24) == ["  T = aaaa*(bbb + ccc)", "    + dddd"]
    assert broken("T = aaaa*(bbb + ccc)", "  ", 18) == ["  T = aaaa*(bbb", "    + ccc)"]
    assert broken("T = short", "  ", 40) == ["  T = short"]


def test_a_divisor_that_can_vanish_is_said_to():
    """m r^2 theta'' + ... over m r holds where r is not zero"""
    text = rendered(equations("elastic_pendulum").derivation, "text")
    assert "divided by m*r (where that is not zero)" in text


@pytest.mark.parametrize("name", derivable())
def test_decimals_in_formulas_are_exact_and_short(name):
    """0.0825 stands for 33/400: no float is in a formula, and no number is cut off"""
    for part in equations(name).derivation.steps:
        for statement in part.statements:
            if isinstance(statement, Formula):
                assert not any(isinstance(side, float) for side in statement.sides)
                for decimal in re.findall(r"\d+\.\d+", formula_text(statement)):
                    assert len(decimal.replace(".", "").lstrip("0")) <= MOST_DIGITS


def test_equations_with_numbers_for_lengths_are_not_multiplied_by_huge_ones():
    """0.00018125*m2*beta'' in metres, not 453125*m2*beta'' after a multiplication by 2500000000"""
    text = rendered(equations("andrews_squeezer").derivation, "text")
    assert "multiplied by" not in text
    assert not re.search(r"(?<![\d.])\d{5}", text.split("Equations of motion")[1].split("Reactions\n")[0])
    assert "(8.464e-7*m1 + 0.00018125*m2 + I1 + I2 - 0.000161*m2*cos(Theta))*beta''" in text


def test_the_force_of_a_spring_keeps_its_form():
    """Q = c0*(1 - l0/r1)*..., r1 the length of the spring; a damper pulls with b*v1, v1 the rate of r1"""
    text = rendered(equations("andrews_squeezer").derivation, "text")
    assert "    r1 = sqrt(0.0048012554 - 0.00060028*cos(gamma) - 0.0033834*sin(gamma))\n" in text
    assert "    V(spring) = 1/2*c0*(r1 - l0)^2\n" in text
    assert "    Q(gamma) = c0*(1 - l0/r1)*(0.0016917*cos(gamma) - 0.00030014*sin(gamma))\n" in text
    text = rendered(equations("springs").derivation, "text")
    assert "    Fy(damper 1) = l*b*v1*(cos(alpha) - cos(beta))/(2*r1)\n" in text
    assert "(l*sin(alpha - beta) - 2*d*cos(alpha))*(k - k*l0/r1 + b*v1/r1)" in text
    assert "    V(middle) = 1/2*k2*(x1 - x2)^2\n" in rendered(equations("two_mass_oscillator").derivation, "text")


def test_a_letter_that_is_also_a_name_of_the_model_is_told_apart():
    """LOOP has a parameter T beside the kinetic energy T"""
    text = rendered(equations("loop").derivation, "text")
    assert "not the model's own T" in text


def test_long_equations_are_printed_with_named_parts():
    """z1, z2, ... stand before the equations that use them, and are no names of the model"""
    derived = equations("chain5")
    assert len(in_time(derived).definitions) > 20
    assert not {symbol.name for symbol, _ in in_time(derived).definitions} & symbols_named(derived).keys()
    text = rendered(in_time(derived), "text")
    assert text.index("\n    z1 = ") < text.index("\n    z2 = ") < text.index("q5'' = ")


def test_values_are_shown_in_the_units_of_the_user():
    """40 cm, not 0.4 cm"""
    assert re.search(r"l_max +cm +40\n", rendered(equations("loop").derivation, "text"))


def test_momenta_by_the_printed_letters_are_partial_derivatives():
    """dT/dtheta' is printed by its own sign"""
    formula = _derivatives(equations("ch22_p1").derivation)[0]
    assert isinstance(formula.sides[0], Partial)
    text = rendered(equations("ch22_p1").derivation, "text")
    assert "    dT/dtheta' = 3*M*R^2*(4 + 9*cos(theta)^2)*theta'\n" in text


def test_an_unknown_format_is_refused_with_those_that_there_are():
    with pytest.raises(UsageError, match="unknown format 'pdf'") as error:
        rendered(equations("ch22_p1").derivation, "pdf")
    assert "text, latex, markdown, json" in str(error.value)


def test_json_steps_carry_every_formula_as_text():
    """json.loads(render) = title, method, steps, equations"""
    data = json.loads(rendered(equations("ch22_p1").derivation, "json"))
    assert data["schema_version"] == 1 and data["method"] == "lagrange"
    keys = [part["key"] for part in data["steps"]]
    assert keys == [
        "data",
        "freedom",
        "coordinates",
        "positions",
        "velocities",
        "constraints",
        "kinetic_energy",
        "work",
        "derivatives",
        "equations",
        "solved",
        "integrals",
        "reactions",
        "notation",
    ]
    equation = data["equations"][0]
    assert equation["divisor"] == "3*M*R" and equation["right"] == "2*g*sin(theta)"


@pytest.mark.parametrize("name", ["double_pendulum", "ch22_p1"])
def test_the_text_of_a_derivation_is_the_golden_one(name):
    """tests/golden: read it, and write it anew where a change is meant"""
    assert rendered(equations(name).derivation, "text") == (GOLDEN / f"{name}.txt").read_text()


def test_what_a_formula_prints_does_not_depend_on_those_before_it():
    """A product of sums that is too much work is left as it is; the next formula has a budget of its own."""
    graph = Graph()
    names = [graph.symbol(f"a{k}") for k in range(60)]
    plain = [(x + y) * (x - y) + y * y for x, y in pairwise(names)]  # x^2, multiplied out
    hard = [prod((sum(names[k::5]) for k in range(5)), start=1 + x) for x in names] * 2
    reader = Reader()
    reader.short([x * (k + 1) for k, x in enumerate(hard)])
    assert reader.short(plain) == Reader().short(plain) == tuple(x * x for x in names[:-1])
