"""What no verdict holds: a factor or a difference that is 0, a letter that means nothing, a start that is none."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each
from linear_lines import linear_lines
from slow_run import beside, in_slow_run, sampled, usual

import eomgen
from eomgen.cli import main
from eomgen.judge.case import Case
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.judge import Judge
from eomgen.judge.truth import Decided
from eomgen.mechanics.start.exact import ExactStart
from eomgen.proof.verdicts import verdicts_again
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

MODELS = Path(__file__).parent.parent / "models"

PENDULUM = r"""
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81 }
coordinates = { theta = 0.3 }
points = { O = [0, 0] }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
[constraints.rope]
kind = "link"
points = ["O", "bob.center"]
length = "l"
symbol = 'S'
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
CART = """
eomgen = 1
space = "plane"
parameters = { M = 2, m = 1, l = 1, g = 9.81 }
coordinates = { x = 0, phi = 0.1 }
[bodies.cart]
mass = "M"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.bob]
mass = "m"
inertia = 0
center = ["l", 0]
joint = { kind = "revolute", on = "cart", angle = "phi - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
WINCH = """
eomgen = 1
space = "plane"
parameters = { m1 = 3, m2 = 1, g = 9.81, r = 0.3, J = 0.2 }
coordinates = { y1 = 0, phi = 0, y2 = 0 }
points = { A = [-1, 5], B = [1, 5] }
bodies.L.shape = { kind = "particle", mass = "m1" }
bodies.L.joint = { kind = "prismatic", axis = [0, -1], at = [-1, 0], displacement = "y1" }
bodies.R.shape = { kind = "particle", mass = "m2" }
bodies.R.joint = { kind = "prismatic", axis = [0, -1], at = [1, 0], displacement = "y2" }
bodies.W.mass = 1
bodies.W.inertia = "J"
bodies.W.joint = { kind = "revolute", angle = "phi" }
constraints.rope = { kind = "string", path = ["L.center", "A", "B", "R.center"] }
forces.g = { kind = "gravity", acceleration = [0, "-g"] }
"""


@each(
    "model, equation, factor",
    [
        ("elastic_pendulum", "r*theta'' + 2*r'*theta' + g*sin(theta) = 0", "the factor 1/(m*r)"),
        ("elastic_pendulum", "r'' - r*theta'^2 - g*cos(theta) + k/m*(r - l0) = 0", "the factor 1/m"),
        ("spherical_pendulum", "l*theta'' - l*sin(theta)*cos(theta)*phi'^2 + g*sin(theta) = 0", "the factor 1/(m*l)"),
    ],
)
def test_the_factor_of_an_equation_is_that_by_which_it_was_multiplied(model, equation, factor):
    """D = f E, where the first acceleration of E by its form has the coefficient sin^2 + cos^2 - 1."""
    found = eomgen.verify(MODELS / f"{model}.toml", equation)
    assert (found.verdict, found.up_to) == ("right", factor)


def test_a_factor_beside_ties_is_of_the_equation_alone():
    """D = f E + h (J a + gamma): f is the quotient of what the constraints do not hold."""
    model = eomgen.loads(WINCH)
    for more in ("0", "5*(y1'' + y2'')", "phi*(y1'' + y2'')"):
        found = eomgen.verify(model, f"2*m1*y1'' + 2*lam(rope, 1) + {more} = 2*m1*g")
        assert found.verdict == "right" and "factor 2" in found.up_to


@pytest.mark.slow
@each(
    "equation",
    usual(
        [
            "y1'' + y2'' = g",
            "y1'' - y2'' = 0",
            "m1*y1'' = m1*g - 2*tension(rope)",
            "2*y1'' + y2'' = 0",
            "(m1 + m2)*y1'' = (m1 - 2*m2)*g",
            "y1'' + y2'' + J*phi'' = g",
            "m1*y1'' - m2*y2'' = m1*g",
        ],
        2,
    ),
)
def test_what_is_too_much_in_a_wrong_equation_is_not_zero(equation):
    """A difference that vanishes along every motion is none."""
    model = eomgen.loads(WINCH)
    found = eomgen.verify(model, equation)
    case = Case(model)
    assert found.verdict == "wrong" and found.difference
    left = case.phase.eliminated(case.value(parse(found.difference, references=True)))
    assert not is_zero_everywhere(case.system, left).holds


@each(
    "equation, verdict, unknown",
    [
        ("S = m*g*cos(theta) + m*l*theta'^2", "right", ()),
        (r"S - m g \cos\theta = m l \dot\theta^2", "right", ()),
        ("S = m*g*cos(theta) - m*l*theta'^2", "wrong", ()),
        ("F_S = m*g*cos(theta) + m*l*theta'^2", "right", ()),
        ("F_Z = m*g*cos(theta) + m*l*theta'^2", "undecided", ("F_Z",)),
        ("Q7 = m*g*cos(theta) + m*l*theta'^2", "undecided", ("Q7",)),
        ("m*l^2*theta'^2/2 + m*g*l*cos(theta) = Z + Y", "undecided", ("Y", "Z")),
        ("m*l^2*theta'^2/2 - m*g*l*cos(theta) = Z", "right", ()),  # it is a first integral, whatever Z is
        ("m*l^2*theta'^2/2 + m*g*l*cos(theta) = C", "wrong", ()),  # C is what authors call a constant
    ],
)
def test_a_letter_that_means_nothing_is_no_constant(equation, verdict, unknown):
    """A symbol that a constraint declares is its force, F_S the tension of the only rope; F_Z, Q7 are nobody's."""
    found = eomgen.verify(eomgen.loads(PENDULUM), equation)
    assert (found.verdict, found.unknown) == (verdict, unknown)


def test_an_unknown_name_stays_in_the_list_with_exit_code_2():
    """5 before 2 before 3 before 0; the entry of the only equation is there, too."""

    def judged(*equations: str) -> tuple[int, list[dict[str, object]]]:
        result = CliRunner().invoke(main, ["verify", "-", "--no-certify", "--json", *equations], input=PENDULUM)
        return result.exit_code, json.loads(result.stdout)["equations"]

    code, (entry,) = judged("F_Z = m*g*cos(theta)")
    assert (code, entry["verdict"], entry["unknown"]) == (2, "undecided", ["F_Z"])
    assert judged("F_Z = m*g*cos(theta)", "l*theta'' = -g*sin(theta)")[0] == 2
    assert judged("F_Z = m*g*cos(theta)", "l*theta'' = g*sin(theta)")[0] == 5


@in_slow_run
@pytest.mark.slow
@each(
    "equation, verdict",
    [
        ("omega = sqrt((M + m)*g/(M*l))", "right"),
        ("omega_1^2 = (M + m)*g/(M*l)", "right"),
        ("omega_2 = sqrt((M + m)*g/(M*l))", "right"),
        ("frequency(1) = 0", "right"),
        ("omega = sqrt(g/l)", "wrong"),
    ],
)
def test_the_frequency_of_a_body_that_also_moves_as_a_whole_is_that_of_its_swinging(equation, verdict):
    """det(K - omega^2 M) = 0 has the root 0 of the cart that rolls away: by its letter omega it is not counted."""
    assert eomgen.verify(eomgen.loads(CART), equation).verdict == verdict


# -- one start ----------------------------------------------------------------------------------------

ATWOOD = """
eomgen = 1
space = "plane"
parameters = { m1 = 3, m2 = 1, g = 9.81 }
coordinates = { y1 = { start = 0, speed = 1 }, y2 = 0 }
points = { A = [-1, 5], B = [1, 5] }
bodies.L.shape = { kind = "particle", mass = "m1" }
bodies.L.joint = { kind = "prismatic", axis = [0, -1], at = [-1, 0], displacement = "y1" }
bodies.R.shape = { kind = "particle", mass = "m2" }
bodies.R.joint = { kind = "prismatic", axis = [0, -1], at = [1, 0], displacement = "y2" }
constraints.rope = { kind = "string", path = ["L.center", "A", "B", "R.center"] }
forces.g = { kind = "gravity", acceleration = [0, "-g"] }
"""
SWING = """
eomgen = 1
space = "plane"
coordinates = { x = { start = 0.6, speed = 1 }, y = -0.8 }
points = { O = [0, 0] }
bodies.a.shape = { kind = "particle", mass = 1 }
bodies.a.joint = { kind = "free", x = "x", y = "y", angle = 0 }
constraints.T = { kind = "link", points = ["O", "a.center"] }
forces.g = { kind = "gravity", acceleration = [0, -10] }
outputs.S = { value = "tension(T)", at = "x = 0" }
"""
TACKLE = """
eomgen = 1
space = "plane"
parameters = { m1 = 3, m2 = 1.2, m3 = 2, g = 9.81, r = 0.1, v = 2 }
coordinates = { y1 = { start = -1, speed = "v" }, yP = -2, y2 = -3 }
[bodies.one]
shape = { kind = "particle", mass = "m1" }
joint = { kind = "placed", at = ["-r", "y1"] }
[bodies.pulley]
shape = { kind = "disc", mass = "m3", radius = "r" }
joint = { kind = "placed", at = ["2*r", "yP"] }
[bodies.two]
shape = { kind = "particle", mass = "m2" }
joint = { kind = "placed", at = ["5*r", "y2"] }
[constraints.rope]
kind = "string"
path = [
  "one.center",
  { at = [0, 0], radius = "r", turn = "cw", slip = true },
  { body = "pulley", turn = "ccw", slip = true },
  { at = ["4*r", 0], radius = "r", turn = "cw", slip = true },
  "two.center",
]
strands = ["up", "down", "up", "down"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def reported_laws(model: eomgen.Model) -> dict[str, str]:
    """The laws of motion that `derive` prints."""
    text = eomgen.derive(model).render("text")
    lines = text.partition("Laws of motion\n")[2].partition("\n\n")[0].splitlines() if "Laws of motion" in text else []
    return dict(line.strip().split(" = ") for line in lines if " = " in line)


@pytest.mark.slow
@each("text", [ATWOOD, TACKLE, ATWOOD.replace("speed = 1 }, y2 = 0", "speed = 1 }, y2 = { speed = 2 }")])
def test_the_start_that_ties_complete_is_one_for_every_verb(text):
    """The rope gives, or changes, speeds: laws of motion, x0, runs and the table of `derive` begin with the same."""
    model = eomgen.loads(text)
    equations, run = eomgen.derive(model), eomgen.simulate(model, time=0.1, samples=2, target="numpy")
    x0 = dict(zip(equations.graph.symbols.x, equations.start(), strict=True))
    start = ExactStart(equations.system)
    assert start.is_exact
    known = {equations.graph.symbols.parameters[n]: float(x) for n, x in model.exact_parameters().items()}
    for symbol, value in x0.items():
        assert evaluate((start.exact[symbol],), known, FLOAT)[0] == pytest.approx(value, abs=1e-12)
        assert run[symbol.name][0] == pytest.approx(value, abs=1e-12)
    laws = reported_laws(model)
    assert laws.keys() == model.coordinates.keys()
    for q, law in laws.items():
        at = {n: float(x) for n, x in model.exact_parameters().items()}
        found = parse(law).evaluate({**at, "t": 0.1})
        assert float(found) == pytest.approx(run[q][-1], abs=1e-9)


@pytest.mark.slow
@each(
    "text, equation, verdict",
    [
        (ATWOOD, "y1 = 5*t + (m1 - m2)*g/(2*(m1 + m2))*t^2", "wrong"),
        (ATWOOD, "y1 = t + (m1 - m2)*g/(2*(m1 + m2))*t^2", "right"),
        (ATWOOD, "y2 = -(m1 - m2)*g/(2*(m1 + m2))*t^2", "wrong"),
        (ATWOOD, "y2 = -t - (m1 - m2)*g/(2*(m1 + m2))*t^2", "right"),
        (SWING, "kinetic_energy() + 10*y = 1000", "wrong"),
        (SWING, "kinetic_energy() + 10*y = -7.21875", "right"),
        (SWING, "tension(T) = -30*y - 14.4375", "right"),
        (SWING, "tension(T) = -30*y - 14", "wrong"),
        (TACKLE, "2*yP' = y1' + y2'", "wrong"),
        (TACKLE, "2*yP' + y1' + y2' = 0", "right"),
    ],
)
def test_the_judge_starts_where_the_motion_does(text, equation, verdict):
    """x x' + y y' = 0: the rope gives y' = 0.75 at the start, and no other start is right."""
    assert eomgen.verify(eomgen.loads(text), equation).verdict == verdict


def test_a_start_without_a_closed_form_serves_by_its_numbers():
    """A rope of which two silent speeds share what the third, with a root in its slope, leaves them."""
    model = eomgen.loads(
        SWING.replace(
            "x = { start = 0.6, speed = 1 }, y = -0.8", "x = { start = 0.6 }, y = { start = -0.7, speed = 1 }"
        ).replace('"a.center"] }', '"a.center"], length = 1 }')
    )
    case = Case(model)
    assert not case.starts_exactly and case.start
    state = {x.name: float(v) for x, v in case.start.items()}
    energy = 0.5 * (state["x'"] ** 2 + state["y'"] ** 2) + 10 * state["y"]
    assert eomgen.verify(model, f"kinetic_energy() + 10*y = {energy:.15g}").verdict == "right"
    assert eomgen.verify(model, f"kinetic_energy() + 10*y = {energy + 1e-3:.15g}").verdict == "wrong"
    assert eomgen.verify(model, f"tension(T) = {2 * energy:.15g} - 30*y").verdict == "right"
    assert eomgen.verify(model, f"tension(T) = {2 * energy + 0.01:.15g} - 30*y").verdict == "wrong"


def test_a_speed_that_has_no_value_stands_in_the_start_of_the_others():
    """y1' = v, v without a value: y2' = -v, and the law of y2 says so."""
    model = eomgen.loads(
        ATWOOD.replace("g = 9.81 }", "g = 9.81, v = { unit = 'm/s' } }").replace("speed = 1", "speed = 'v'")
    )
    assert eomgen.verify(model, "y2 = -v*t - (m1 - m2)*g/(2*(m1 + m2))*t^2").verdict == "right"
    assert eomgen.verify(model, "y2 = -(m1 - m2)*g/(2*(m1 + m2))*t^2").verdict == "wrong"
    assert "v*t" in reported_laws(model)["y2"]


LEAVING = """
eomgen = 1
space = "plane"
parameters = { v = SPEED }
coordinates = { x = { start = 0, speed = 1 }, y = { start = 0, speed = "v" } }
bodies.a.shape = { kind = "particle", mass = 1 }
bodies.a.joint = { kind = "free", x = "x", y = "y", angle = 0 }
constraints.T = { kind = "support", point = "a.origin", normal = [0, 1], unilateral = true }
forces.g = { kind = "gravity", acceleration = [0, -9.81] }
outputs.y = "y''"
outputs.N = "reaction_n(T)"
"""
HILL = """
eomgen = 1
space = "plane"
parameters = { m = 2, R = 1, g = 9.81, v = SPEED }
coordinates = { x = { start = 0, speed = "v" }, y = { start = "R" } }
points = { O = [0, 0] }
bodies.a.shape = { kind = "particle", mass = "m" }
bodies.a.joint = { kind = "free", x = "x", y = "y", angle = 0 }
constraints.string = { kind = "link", points = ["O", "a.center"], length = "R", unilateral = true }
forces.g = { kind = "gravity", acceleration = [0, "-g"] }
outputs.y = "y''"
outputs.N = "tension(string)"
"""


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "speed", "force", "acceleration"),
    usual(
        [
            (LEAVING, "1.2", 0, -9.81),
            (LEAVING, "0", 9.81, 0),
            (HILL, "4", 2 * (16 - 9.81), -16),
            (HILL, "1", 0, -9.81),  # v^2 < g R: the string would have to push
            (HILL, "-1", 0, -9.81),
        ],
        2,
        1,
    ),
)
def test_a_contact_that_leaves_at_once_is_open_in_every_verb(text, speed, force, acceleration):
    """N < 0 or gap' > 0 at the start: no force, and what is free falls."""
    model = eomgen.loads(text.replace("SPEED", speed))
    call = "tension(string)" if "string" in text else "reaction_n(T)"
    answers = eomgen.solve(model)
    assert (answers["N"].value, answers["y"].value) == (pytest.approx(force), pytest.approx(acceleration))
    equations = eomgen.derive(model)
    rhs = equations.rhs("numpy")
    assert rhs.x0 is not None and rhs(0.0, rhs.x0, rhs.p0)[3] == pytest.approx(acceleration)
    assert equations.certify().ok
    found = eomgen.reactions(model)
    assert (found[call].value if call in found else 0) == pytest.approx(force)
    run = eomgen.simulate(model, time=0.01, samples=2, target="numpy")
    assert run.outputs["y"][0] == pytest.approx(acceleration)
    assert eomgen.verify(model, f"{call} = 1 + {call}/2").verdict == "wrong"
    if force == 0:
        assert eomgen.verify(model, f"{call} = 0").verdict == "right"
        assert eomgen.verify(model, "y'' = -9.81").verdict == "right"
        assert eomgen.verify(model, "y'' = 0").verdict == "wrong"
        law = "y = v*t - 9.81/2*t^2" if text is LEAVING else "y = R - g/2*t^2"
        assert eomgen.verify(model, law).verdict == "right"


def test_whether_a_contact_leaves_is_assumed_where_a_number_is_missing_and_said():
    """v^2 > g R or not: v has no value. The mass does not matter."""
    equations = eomgen.derive(eomgen.loads(HILL.replace("SPEED", "{ unit = 'm/s' }")))
    assert equations.assumptions == ("string assumed closed: v has no value",) and equations.graph.J
    equations = eomgen.derive(eomgen.loads(HILL.replace("SPEED", "1").replace("m = 2", "m = { unit = 'kg' }")))
    assert not equations.assumptions and not equations.graph.J


# -- decided again --------------------------------------------------------------------------------------


def test_each_link_of_a_chain_and_names_of_derivations_are_decided_again():
    """T = a = b is two equations; M[..] and Q of one force have scalars of their own; a turned verdict fails."""
    judge = Judge(Case(eomgen.load(MODELS / "simple_pendulum.toml")))
    chain = judge.said(judge.verdict("T = 1/2*m*v_bob^2 = 1/2*m*l^2*theta'^2"))
    entry = judge.said(judge.verdict("M[theta', theta'] = m*l^2"))
    force = judge.said(judge.verdict("Q(theta, weight) = m*g*l*sin(theta)"))
    assert (len(chain), len(entry), len(force)) == (2, 1, 1)
    for said in (*chain, *entry, *force):
        turned_round = replace(said, is_right=not said.is_right, up_to="")
        assert [check.status for check in verdicts_again([said])] == ["holds"]
        assert [check.status for check in verdicts_again([turned_round])] == ["fails"]


def turned(model: eomgen.Model, equation: str) -> list[tuple[str, str]]:
    """What the second decision says of a verdict, and of the verdict turned round."""
    judge = Judge(Case(model))
    (said,) = judge.said(judge.verdict(equation))
    both = (said, replace(said, is_right=not said.is_right, up_to="" if said.is_right else said.up_to))
    return [(check.status, check.detail) for each in both for check in verdicts_again([each])]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "equation"),
    [
        (PENDULUM, "l*theta'' = -g*sin(theta)"),
        (PENDULUM, "l*theta'' = g*sin(theta)"),
        (PENDULUM, r"l \ddot\phi = g \sin\phi"),
        (PENDULUM, "S = m*g*cos(theta) + m*l*theta'^2"),
        (PENDULUM, "S = m*g*cos(theta) - m*l*theta'^2"),
        (PENDULUM, "T = m*l^2*theta'^2/2"),
        (PENDULUM, "theta'^2 = 2*g/l*(cos(theta) - cos(3/10))"),
        (PENDULUM, "theta'^2 = 2*g/l*(cos(theta) - cos(1/10))"),
        (ATWOOD, "y1 = t + (m1 - m2)*g/(2*(m1 + m2))*t^2"),
        (ATWOOD, "y1 = 5*t + (m1 - m2)*g/(2*(m1 + m2))*t^2"),
        (SWING, "x*x'' + y*y'' + x'^2 + y'^2 = 0"),
        (SWING, "tension(T) = -30*y - 14.4375"),
        (SWING, "kinetic_energy() + 10*y = 1000"),
    ],
)
def test_a_verdict_that_is_turned_round_is_seen_by_numbers(text, equation):
    """Both sides in doubles at consistent states: they agree where it is right, and nowhere else."""
    (own, _), (other, why) = turned(eomgen.loads(text), equation)
    assert (own, other) == ("holds", "fails") and "it is judged" in why


def test_a_judge_that_errs_fails_its_certificate(monkeypatch):
    """A decision that takes everything for right: exit code 3, and what differs is said."""
    monkeypatch.setattr("eomgen.judge.judge.truth_of", lambda *_, **__: Decided(True))
    result = CliRunner().invoke(main, ["verify", "-", "l*theta'' = g*sin(theta)"], input=PENDULUM)
    assert result.exit_code == 3 and "it is judged right, and its sides differ" in result.output


PUSHED = (
    CART.replace("M = 2", "F = 30, M = 2")
    + """
[forces.push]
kind = "force"
point = "cart.origin"
force = ["F", 0]
"""
)
JIB = """
eomgen = 1
space = "plane"
parameters = { M = 10, m = 4, l = 2, b = 1.5, k = 900, g = 9.81 }
coordinates = { alpha = 0.1, beta = 0.4 }
bodies.jib.shape = { kind = "rod", mass = "M", length = "l" }
bodies.jib.joint = { kind = "revolute", point = "start", angle = "alpha" }
bodies.load.shape = { kind = "rod", mass = "m", length = "b" }
bodies.load.joint = { kind = "revolute", on = "jib.end", point = "start", angle = "beta - pi/2 - alpha" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
forces.spring = { kind = "torsion_spring", body = "jib", stiffness = "k" }
"""


@each(
    "text, equation, right",
    [
        (PENDULUM, "theta'' = -g/l*theta", True),
        (PENDULUM, "theta'' = g/l*theta", False),
        (PUSHED, "l*phi'' + x'' = -g*phi", True),  # it is pushed: 0 is no equilibrium
        (PUSHED, "(M + m)*x'' + m*l*phi'' = F", True),
        (PUSHED, "(M + m)*x'' + m*l*phi'' = 2*F", False),
        (JIB, "2*b*beta'' - 3*l*alpha''*(alpha - beta) = -3*g*beta", True),
        (JIB, "beta'' = -3*g/(2*b)*beta", False),  # alpha'' is not small where the jib does not rest
    ],
)
def test_what_is_right_to_first_order_alone_is_proven_so(text, equation, right):
    """The difference of the sides falls to a quarter where the distance from the place is halved."""
    result = CliRunner().invoke(main, ["verify", "-", equation, "--to-first-order"], input=text)
    assert result.exit_code == (0 if right else 5) and "certificate: holds" in result.output, result.output


LINEAR = ("double_pendulum", "elastic_pendulum", "n_four_bar", "rolling_disc_and_bar", "conker")  # loops among them
NAMES = [str(path.relative_to(MODELS).with_suffix("")) for path in sorted(MODELS.glob("**/*.toml"))]


@pytest.mark.parametrize("name", (*LINEAR, *beside(*(name for name in NAMES if name not in LINEAR))))
def test_what_linearize_gives_is_right_to_first_order(name):
    """Each row of M q'' + C q' + K q = 0 about the equilibrium, proven; along the constraints of loops, too."""
    path = MODELS / f"{name}.toml"
    try:
        found = eomgen.linearize(path).as_dict()
    except eomgen.EomgenError:
        assert name not in LINEAR
        return
    for right, _, about in linear_lines(found):
        result = CliRunner().invoke(main, ["verify", str(path), right, "--to-first-order", "--about", about])
        assert result.exit_code == 0 and "certificate: holds" in result.output, result.output


@in_slow_run
def test_another_stiffness_of_a_loop_is_wrong_to_first_order():
    """3 m L^2 a'' - 7/2 m g L (a - pi/2) = 0, with 5/4 of the stiffness."""
    path = MODELS / "n_four_bar.toml"
    ((_, wrong, about),) = linear_lines(eomgen.linearize(path).as_dict())
    found = eomgen.verify(path, wrong, to_first_order=True, about=about)
    assert found.verdict == "wrong" and "first order" not in found.up_to


@pytest.mark.parametrize("option", [[], ["--to-first-order"]])
def test_a_first_order_that_is_none_fails_its_certificate(monkeypatch, option):
    """Whether it is asked for that order, or told that it is right to it."""
    nowhere = lambda case, *_: dict.fromkeys(case.system.symbols.q, Fraction(0))  # noqa: E731
    monkeypatch.setattr("eomgen.judge.judge.first_order_place", nowhere)
    result = CliRunner().invoke(main, ["verify", "-", "beta'' = -3*g/(2*b)*beta", *option], input=JIB)
    assert result.exit_code == 3 and "it is judged right to the first order" in result.output


@each("equation", ["V = -m*g*l*cos(theta) + 7*m", "T + V = E", "omega = sqrt(g/l)", "theta = 0"])
def test_what_numbers_do_not_decide_is_no_alarm(equation):
    """Constants of potentials and of integration; small motions and rest, which the solver of outputs decides."""
    result = CliRunner().invoke(main, ["verify", "-", equation], input=PENDULUM)
    assert result.exit_code == 0, result.output


SLIDING = """
eomgen = 1
space = "plane"
parameters = { m = 2, mu = 0.2, g = 9.81, v = 3 }
coordinates = { x = { start = 0, speed = "v" } }
bodies.block.shape = { kind = "particle", mass = "m" }
bodies.block.joint = { kind = "placed", at = ["x", 0] }
constraints.floor = { kind = "support", point = "block.center", normal = [0, 1], friction = "mu" }
forces.g = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("equation", "verdict"),
    [("x = v*t - mu*g/2*t^2", "right"), ("x = v*t + mu*g/2*t^2", "wrong"), ("x = v*t", "wrong")],
)
def test_a_law_of_a_body_that_slides_holds_while_it_slides_on(equation, verdict):
    """sign(v - mu g t) = 1 while v >= mu g t."""
    found = eomgen.verify(eomgen.loads(SLIDING), equation)
    assert found.verdict == verdict and ("while" in found.up_to) == (verdict == "right")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "equation", "reported"),
    [
        (PENDULUM, "l*theta'' = -g*sin(theta)", {"up_to": "the factor 0"}),
        (CART, "m*x'' + m*l*phi'' = 0", {"difference": "(M + m)*x'' + m*l*(phi''*cos(phi) - phi'^2*sin(phi))"}),
    ],
)
def test_a_factor_and_a_difference_that_vanish_are_contradicted(text, equation, reported):
    """What an equation was multiplied by is not 0, and what is too much in it does not vanish by the equations."""
    judge = Judge(Case(eomgen.loads(text)))
    (said,) = judge.said(judge.verdict(equation))
    assert [check.status for check in verdicts_again([said])] == ["holds"]
    (check,) = verdicts_again([replace(said, **reported)])
    assert check.status == "fails" and "0 at every state" in check.detail
