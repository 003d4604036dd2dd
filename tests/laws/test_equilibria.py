"""Places of rest: all of them, exact, with their stability; forces that hold a system; each against another way."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from each import each
from slow_run import sampled, usual

import eomgen
from eomgen.documents import rendered
from eomgen.documents.json_form import as_dict
from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.equilibrium.reactions import holding_of
from eomgen.mechanics.equilibrium.search import Equilibria, Equilibrium
from eomgen.model.model import Model
from eomgen.questions.reactions import reactions_document
from eomgen.study import Study
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

HEAD = 'eomgen = 1\nname = "system"\nspace = "plane"\n'
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'


def model_of(text: str, **parameters: float | str) -> Model:
    table = "".join(f"{name} = {value}\n" for name, value in parameters.items())
    return eomgen.loads(f"{HEAD}[parameters]\n{table}{text}")


def found_in(model: Model) -> Equilibria:
    return Study(System.of(model)).equilibria


def exact(place: Equilibrium) -> dict[str, str]:
    return {node.name: to_text(x) for node, x in place.exact.items()}


def number(place: Equilibrium, name: str) -> float:
    (value,) = (x for node, x in place.numbers.items() if node.name == name)
    return value


def accelerations(model: Model, place: Equilibrium) -> np.ndarray:
    """Of the equations of motion, which know nothing of the search, at rest in the place."""
    rhs = eomgen.derive(model).rhs("numpy")
    x = np.array([number(place, name) for name in rhs.coordinates] + [0.0] * len(rhs.speeds))
    return rhs(0.0, x, rhs.p0)


# -- one freedom -------------------------------------------------------------------------------------

UPRIGHT = """
[coordinates]
a = 0.1
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "a", turned = { axis = [0, 0, 1], angle = "pi/2" }, stiffness = "k" }
"""


SLIDER = """
[coordinates]
x = 0
[bodies.slider]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[forces.push]
kind = "generalized"
coordinate = "x"
value = "VALUE"
"""


@each("l", usual(["1e-8", "1", "1e-3", "1e-6"], 2))
@pytest.mark.parametrize(
    ("force", "places"),
    [
        ("-k*(x/l - 1)*(x/l - 2)*(x/l - 3)", (1, 2, 3)),
        ("-k*(x/l)*(x/l - 1)^3", (0, 1)),
        ("k*(exp(-x/l) - 3*exp(-2*x/l))", (math.log(3),)),
        ("k*exp(-x/l)", ()),
        ("k/(1 + (x/l)^2)", ()),
    ],
)
def test_places_of_rest_are_so_many_in_every_unit_of_length(force, places, l):
    """F(x/l) = 0 at x = l s: as many s for every l, and where a force only gets small there is none."""
    found = found_in(model_of(SLIDER.replace("VALUE", force), k=2, l=l))
    assert sorted(number(e, "x") / float(l) for e in found.found) == pytest.approx(places, abs=1e-9)


NET = """
[points]
A = [0, 0]
B = ["5*l", 0]
[coordinates]
x1 = { near = "l" }
y1 = {}
x2 = { near = "2*l" }
y2 = {}
x3 = { near = "4*l" }
y3 = {}
"""


def test_many_coordinates_rest_in_the_same_places_in_every_unit_of_length():
    """Three weights on four springs, F/k a function of r/l alone: the same places, r/l, are found for every l."""
    text, ends = NET, ("A", "p1.center", "p2.center", "p3.center", "B")
    for n in (1, 2, 3):
        text += f'[bodies.p{n}]\nshape = {{ kind = "particle", mass = {n} }}\n'
        text += f'joint = {{ kind = "placed", at = ["x{n}", "y{n}"] }}\n'
    for n, pair in enumerate(pairwise(ends)):
        text += f'[forces.s{n}]\nkind = "spring"\npoints = {list(pair)}\nstiffness = "k/l"\nlength = "0.9*l"\n'
    places = []
    for l in ("1", "1e-4", "1e4"):
        found = found_in(model_of(text + WEIGHT, k=150, g=9.81, l=l)).found
        places.append([[x / float(l) for x in each.numbers.values()] for each in found])
    assert len(places[0]) > 1
    assert np.array(places[1]) == pytest.approx(np.array(places[0]), abs=1e-9)
    assert np.array(places[2]) == pytest.approx(np.array(places[0]), abs=1e-9)


def test_a_pendulum_rests_below_and_above():
    """m g l sin(theta) = 0: theta = 0 stable, theta = pi unstable."""
    found = found_in(eomgen.load("models/simple_pendulum.toml"))
    assert found.complete
    assert [(exact(e)["theta"], e.stability.kind) for e in found.found] == [("0", "stable"), ("pi", "unstable")]
    assert [to_text(e.stability.K[0][0]) for e in found.found] == ["m*g*l", "-m*g*l"]


@pytest.mark.parametrize("k", [0.4, 1.2, 3, 4.9, 5.1, 8])
def test_an_upright_bar_on_a_spring_has_the_places_of_a_dense_scan(k):
    """k a = m g l/2 sin(a): one place for k > m g l/2, else more; the upright one is then unstable."""
    found = found_in(model_of(UPRIGHT + WEIGHT, m=1, l=1, g=10, k=k))
    a = np.linspace(0.1 - 2 * math.pi, 0.1 + 2 * math.pi, 200_000)
    force = k * a - 5 * np.sin(a)
    assert found.complete and len(found.found) == np.count_nonzero(np.diff(np.sign(force)))
    (upright,) = (e for e in found.found if exact(e).get("a") == "0")
    assert upright.stability.kind == ("stable" if k > 5 else "unstable")
    for e in found.found:
        assert abs(k * number(e, "a") - 5 * math.sin(number(e, "a"))) < 1e-12


def test_at_the_critical_stiffness_the_fourth_derivative_decides():
    """k = m g l/2: V'' = V''' = 0, V'''' = m g l/2 > 0."""
    (upright,) = found_in(model_of(UPRIGHT + WEIGHT, m=1, l=1, g=10, k=5)).found
    assert exact(upright)["a"] == "0" and upright.stability.kind == "stable" and "number 4" in upright.stability.why


TRUSS = """
[coordinates]
y = "h"
[points]
A = ["-a", 0]
B = ["a", 0]
[bodies.p]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = [0, "y"] }
[forces]
left = { kind = "spring", points = ["p.center", "A"], stiffness = "k", length = "sqrt(a^2 + h^2)" }
right = { kind = "spring", points = ["p.center", "B"], stiffness = "k", length = "sqrt(a^2 + h^2)" }
"""
LOAD = '[forces.load]\nkind = "force"\npoint = "p.center"\nforce = [0, "-P"]\n'


def test_a_flat_truss_of_two_springs_snaps_through():
    """Without a load y = h, 0, -h; loaded beyond its limit it rests below alone."""
    free = found_in(model_of(TRUSS, m=1, a=1, h=0.4, k=1000))
    assert free.complete
    assert [(exact(e)["y"], e.stability.kind) for e in free.found] == [
        ("h", "stable"),
        ("0", "unstable"),
        ("-h", "stable"),
    ]
    assert len(found_in(model_of(TRUSS + LOAD, m=1, a=1, h=0.4, k=1000, P=10)).found) == 3
    (below,) = found_in(model_of(TRUSS + LOAD, m=1, a=1, h=0.4, k=1000, P=100)).found
    assert number(below, "y") < -0.4 and below.stability.kind == "stable"


ROCKER = """
[coordinates]
p = 0
[bodies.top]
mass = "m"
inertia = "m*r^2"
joint = { kind = "placed", at = ["(R + r)*sin(p) - e*sin((R + r)/r*p)", "(R + r)*cos(p) - e*cos((R + r)/r*p)"] }
"""


@pytest.mark.parametrize(("e", "kind"), [(0.55, "stable"), (0.45, "unstable"), (0.5, "unstable")])
def test_a_rocker_on_a_cylinder(e, kind):
    """Stable where its mass centre is lower above the contact than R r/(R + r); at equality V'''' < 0."""
    found = found_in(model_of(ROCKER + WEIGHT, m=1, R=1, r=1, g=10, e=e))
    assert found.found[0].exact and exact(found.found[0])["p"] == "0"
    assert found.found[0].stability.kind == kind


@pytest.mark.parametrize("seed", range(6))
def test_no_place_is_missed(seed):
    """Of a force that is a random Fourier sum, as many places as a dense scan shows, half of them stable."""
    rng = np.random.default_rng(seed)
    n = np.arange(1, 5)
    a, b = (np.round(rng.uniform(-1, 1, 4), 3) for _ in range(2))
    terms = "".join(f" + ({x})*cos({k}*q) + ({y})*sin({k}*q)" for k, x, y in zip(n, a, b, strict=True))
    text = f"""
[coordinates]
q = 0
[bodies.d]
shape = {{ kind = "disc", mass = "m", radius = "r" }}
joint = {{ kind = "revolute", angle = "q" }}
[forces.f]
kind = "couple"
body = "d"
couple = "0.2{terms}"
"""
    found = found_in(model_of(text, m=1, r=1))
    q = np.linspace(-math.pi, math.pi, 100_001)
    force = 0.2 + np.sum([x * np.cos(k * q) + y * np.sin(k * q) for k, x, y in zip(n, a, b, strict=True)], axis=0)
    crossings = np.flatnonzero(np.diff(np.sign(force)))
    assert found.complete and len(found.found) == len(crossings)
    places = sorted(number(e, "q") for e in found.found)
    assert places == pytest.approx(sorted(q[crossings]), abs=1e-4)
    assert sum(e.stability.kind == "stable" for e in found.found) == len(crossings) / 2


# -- several degrees of freedom --------------------------------------------------------------------------------


def chain(n: int) -> str:
    """n rods, each hung on the one before, pulled aside at the end; angles against the ground."""
    text = "[coordinates]\n" + "".join(f"q{k} = {0.1 * k}\n" for k in range(n))
    for k in range(n):
        on, angle = ("", "q0") if k == 0 else (f'on = "b{k - 1}.end", ', f"q{k} - q{k - 1}")
        joint = f'joint = {{ kind = "revolute", {on}angle = "{angle}" }}'
        text += f'[bodies.b{k}]\nshape = {{ kind = "rod", mass = "m", length = "l" }}\n{joint}\n'
    return text + f'[forces.F]\nkind = "force"\npoint = "b{n - 1}.end"\nforce = ["F", 0]\n' + WEIGHT


@pytest.mark.parametrize("n", [2, 3])
def test_a_chain_pulled_aside(n):
    """tan(q_k) = -(n - k - 1/2) m g/F for rods counted from 0; each hangs or stands: 2^n places, one of them stable."""
    found = found_in(model_of(chain(n), m=1, l=1, g=10, F=5))
    assert found.complete and len(found.found) == 2**n
    (stable,) = (e for e in found.found if e.stability.kind == "stable")
    for k in range(n):
        assert math.tan(number(stable, f"q{k}")) == pytest.approx(-(n - k - 0.5) * 2, abs=1e-12)
    assert all(e.is_exact for e in found.found)


def test_a_linear_system_has_one_place_and_it_is_exact():
    """Two masses that hang on springs one below the other: x1 = (m1 + m2) g/k1, x2 = x1 + m2 g/k2."""
    text = """
[coordinates]
x1 = {}
x2 = {}
[points]
O = [0, 0]
[bodies.a]
shape = { kind = "particle", mass = "m1" }
joint = { kind = "placed", at = [0, "-x1"] }
[bodies.b]
shape = { kind = "particle", mass = "m2" }
joint = { kind = "placed", at = [0, "-x2"] }
[forces]
s1 = { kind = "spring", points = ["O", "a.center"], stiffness = "k1", length = 0, along = [0, 1] }
s2 = { kind = "spring", points = ["a.center", "b.center"], stiffness = "k2", length = 0, along = [0, 1] }
"""
    positive = dict.fromkeys(("m1", "m2", "k1", "k2", "g"), "{ positive = true }")
    found = found_in(model_of(text + WEIGHT, **positive))
    (place,) = found.found
    assert found.complete and exact(place) == {"x1": "(m1 + m2)*g/k1", "x2": "(m1*k2 + m2*k1 + m2*k2)*g/(k1*k2)"}
    assert place.stability.kind == "stable"


FOLLOWER = """
[coordinates]
a = 0
b = 0
[bodies.one]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "a", stiffness = "k" }
[bodies.two]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "one.end", angle = "b", stiffness = "k" }
[forces.P]
kind = "force"
point = "two.end"
force = ["-P", 0]
"""


def test_a_follower_load_has_no_potential_energy():
    """Its K is not symmetric and decides nothing; the same load of fixed direction has one."""
    follower = found_in(model_of(FOLLOWER + 'axes = "two"\n', m=1, l=1, k=1, P=1)).found[0]
    assert exact(follower) == {"a": "0", "b": "0"} and follower.stability.kind == "no potential energy"
    dead = found_in(model_of(FOLLOWER, m=1, l=1, k=10, P=1)).found[0]
    assert dead.stability.kind == "stable" and dead.stability.K[0][1] == dead.stability.K[1][0]


def test_what_no_force_holds_is_left_where_it_starts():
    """The cart of an inverted pendulum."""
    found = found_in(eomgen.load("models/cart_pole.toml"))
    assert [q.name for q in found.indifferent] == ["x"]
    assert {exact(e)["theta"]: e.stability.kind for e in found.found} == {"0": "unstable", "pi": "stable"}


# -- constraints --------------------------------------------------------------------------------------------


def four_bar_energy(alpha: float, near: np.ndarray) -> tuple[float, np.ndarray]:
    """(V, (beta, gamma)) of models/four_bar.toml with its crank at alpha, the loop closed by Newton's method."""
    a, b, c, d, m, g = 0.4, 1.0, 0.8, 1.1, 1.0, 9.81
    x = near.copy()
    for _ in range(30):
        beta, gamma = x
        gap = [
            a * math.cos(alpha) + b * math.cos(beta) - c * math.cos(gamma) - d,
            a * math.sin(alpha) + b * math.sin(beta) - c * math.sin(gamma),
        ]
        J = [[-b * math.sin(beta), c * math.sin(gamma)], [b * math.cos(beta), -c * math.cos(gamma)]]
        x = x - np.linalg.solve(J, gap)
    heights = a / 2 * math.sin(alpha), a * math.sin(alpha) + b / 2 * math.sin(x[0]), c / 2 * math.sin(x[1])
    return m * g * (heights[0] + 2 * heights[1] + heights[2]), x


def test_a_four_bar_rests_where_its_energy_is_stationary():
    """dV/d alpha = 0 and d2V/d alpha2 = K along the loop, by differences of an energy of our own."""
    found = found_in(eomgen.load("models/four_bar.toml"))
    assert found.complete and len(found.found) == 4
    for e in found.found:
        x = np.array([number(e, "beta"), number(e, "gamma")])
        alpha, h = number(e, "alpha"), 1e-4
        below, here, above = (four_bar_energy(alpha + s, x)[0] for s in (-h, 0, h))
        assert abs(above - below) / (2 * h) < 1e-6
        assert (above - 2 * here + below) / h**2 == pytest.approx(e.stability.K[0][0], rel=1e-5)
        assert e.stability.kind == ("stable" if e.stability.K[0][0] > 0 else "unstable")


@pytest.mark.parametrize(
    "path",
    [
        "four_bar",
        "slider_crank",
        "elastic_pendulum",
        "double_pendulum",
        "cart_pole",
        "rolling_disc_and_bar",
        "two_mass_oscillator",
    ],
)
def test_at_rest_the_equations_of_motion_have_no_acceleration(path):
    """u = 0 and a = 0 solve them, each place, dependent coordinates and closing constraints included."""
    model = eomgen.load(f"models/{path}.toml")
    found = found_in(model)
    assert found.found
    for e in found.found:
        assert np.max(np.abs(accelerations(model, e)), initial=0) < 1e-11


SCISSOR = """
[coordinates]
a = 0.6
b = { dependent = true, near = 2.5 }
x = { dependent = true, near = 1 }
[bodies.I]
shape = { kind = "rod", mass = 0, length = "2*l" }
joint = { kind = "revolute", angle = "a" }
[bodies.II]
shape = { kind = "rod", mass = 0, length = "2*l" }
joint = { kind = "placed", at = ["x", 0], angle = "b" }
[constraints.pin]
kind = "pin"
points = ["I.center", "II.center"]
[forces.G]
kind = "force"
point = "II.end"
force = [0, "-G"]
[forces.s]
kind = "spring"
points = ["I.start", "II.start"]
stiffness = "k"
length = 1
along = [1, 0]
"""


def test_forces_without_limit_hold_nothing():
    """Both bars upright one pin has no arm: det [Q; J] = 0, and no multiplier balances it. G cot = k(2 l cos - 1).

    Slow: from each box about the place without limit a hundred steps of 50 digits lead to no root.
    """
    found = found_in(model_of(SCISSOR, l=1, G=100, k=300))
    assert len(found.found) == 4
    for e in found.found:
        a = number(e, "a")
        assert number(e, "x") == pytest.approx(2 * math.cos(a), abs=1e-12)
        assert 300 * (2 * math.cos(a) - 1) * math.sin(a) == pytest.approx(100 * math.cos(a), abs=1e-9)


# -- what holds a system -----------------------------------------------------------------------------

TOGGLE = """
[unknowns]
P = "of the press"
[coordinates]
th = { start = "b" }
ph = { dependent = true, near = 2.5 }
y = { dependent = true, near = 1.6 }
[bodies.one]
shape = { kind = "rod", mass = 0, length = "l" }
joint = { kind = "revolute", angle = "pi/2 - th" }
[bodies.two]
shape = { kind = "rod", mass = 0, length = "l" }
joint = { kind = "revolute", on = "one.end", angle = "ph" }
[bodies.ram]
mass = 0
joint = { kind = "placed", at = [0, "y"] }
[constraints.pin]
kind = "pin"
points = ["two.end", "ram.origin"]
[forces.F]
kind = "force"
point = "one.end"
force = ["-F", 0]
[forces.P]
kind = "force"
point = "ram.origin"
force = [0, "-P"]
[outputs]
P = { value = "P", at = "equilibrium" }
"""


def test_a_toggle_press():
    """P = F/(2 tan b)"""
    model = model_of(TOGGLE, l="{ value = 1, positive = true }", F=10, b="{ value = 0.6, positive = true }")
    (P,) = holding_of(System.of(model)).unknowns.values()
    assert to_text(P) == "F/(2*tan(b))"
    assert eomgen.solve(model)["P"].value == pytest.approx(5 / math.tan(0.6), abs=1e-12)


LADDER = """
[unknowns]
S = "in the string"
[coordinates]
th = "b"
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "placed", at = ["l*cos(th)", 0], angle = "pi - th" }
[constraints]
floor = { kind = "support", point = "bar.start", normal = [0, 1], at = [0, 0] }
wall = { kind = "support", point = "bar.end", normal = [1, 0], at = [0, 0] }
[forces.S]
kind = "force"
point = "bar.start"
force = ["-S", 0]
[outputs]
S = { value = "S", at = "equilibrium" }
S_by_balance = "S"
N = { value = "reaction_n(floor)", at = "equilibrium" }
"""


def test_a_ladder_on_a_smooth_wall_held_by_a_string():
    """S = m g/(2 tan b), by virtual work and by the balance of the ladder; N = m g."""
    answers = eomgen.solve(model_of(LADDER + WEIGHT, m=10, l=4, g=10, b=1))
    assert answers["N"].exact == "m*g"
    for name in ("S", "S_by_balance"):
        assert answers[name].value == pytest.approx(50 / math.tan(1), rel=1e-12)


def test_more_unknowns_than_freedoms_are_refused():
    text = LADDER.replace("[coordinates]", 'T = "another"\n[coordinates]').replace('["-S", 0]', '["-S - T", 0]')
    with pytest.raises(DerivationError, match="more unknowns than degrees of freedom"):
        holding_of(System.of(model_of(text + WEIGHT, m=10, l=4, g=10, b=1)))


def test_an_unknown_that_does_no_work_holds_nothing():
    text = LADDER.replace('["-S", 0]', '[0, "S"]')
    with pytest.raises(DerivationError, match="no unknown load does work"):
        holding_of(System.of(model_of(text + WEIGHT, m=10, l=4, g=10, b=1)))


# -- what is asked -----------------------------------------------------------------------------------


def test_outputs_and_reactions_at_rest():
    """At the nearest place, exact: the pendulum hangs, and its hinge carries m g."""
    model = model_of(
        UPRIGHT.replace('turned = { axis = [0, 0, 1], angle = "pi/2" }, ', "").replace('"m"', '"m"')
        + '[forces.weight]\nkind = "gravity"\nacceleration = ["g", 0]\n[outputs]\n'
        'a = { value = "a", at = "equilibrium" }\nX = { value = "reaction_x(bar)", at = "equilibrium" }\n',
        **dict.fromkeys(("m", "l", "k", "g"), "{ positive = true }"),
    )
    answers = eomgen.solve(model)
    assert answers["a"].exact == "0" and answers["X"].exact == "-m*g"
    found = reactions_document(model, at="equilibrium")
    assert not found.wrong and as_dict(found)["reactions"]["reaction_x(bar)"]["exact"] == "-m*g"


def test_the_verb_of_statics_gives_the_places_of_rest():
    model = eomgen.load("models/simple_pendulum.toml")
    payload = eomgen.statics(model).as_dict()
    assert [e["coordinates"]["theta"]["exact"] for e in payload["equilibria"]] == ["0", "pi"]
    assert payload["complete"] and payload["reactions"]["reaction_y(rod)"]["exact"] == "m*g"
    document = eomgen.statics(model).document
    text = rendered(document)
    assert "There are 2 equilibria" in text and "stable" in text
    assert r"\frac{\partial^{2} V}{\partial q^{2}}" in rendered(document, "latex")
    with pytest.raises(UsageError, match="structures that stand"):
        eomgen.statics(model, reaction="reaction_x(rod)")


# -- what has no places ------------------------------------------------------------------------------

BOX = """
[coordinates]
y = 0
[bodies.b]
shape = { kind = "rectangle", mass = "m", width = 1, height = 1 }
joint = { kind = "planar", x = "x", y = "y", angle = "th" }
"""


def test_a_contact_that_would_have_to_pull_is_named():
    box = BOX.replace("y = 0", "y = 0\nx = 0\nth = 0")
    text = (
        box
        + """
[constraints.floor]
kind = "support"
point = "b.center"
normal = [0, 1]
unilateral = true
[forces]
up = { kind = "force", point = "b.center", force = ["1 - x", "20*x"] }
turn = { kind = "torsion_spring", body = "b", stiffness = 3 }
[outputs]
th = { value = "th", at = "equilibrium" }
"""
    )
    assert "'floor' would have to pull" in (eomgen.solve(model_of(text + WEIGHT, m=1, g=10))["th"].message or "")


ON_AN_END = """
[coordinates]
y = START
[points]
hook = [0, "L"]
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
CARRIED
[forces.spring]
kind = "spring"
points = ["hook", "block.center"]
along = [0, 1]
length = 0
stiffness = "k"
END
[outputs]
y = { value = "y", at = "equilibrium" }
N = { value = "FORCE", at = "equilibrium" }
"""
FLOOR = """[constraints.end]
kind = "support"
point = "block.center"
at = [0, 0]
normal = [0, 1]
unilateral = true
"""
THREAD = """[constraints.end]
kind = "link"
points = ["hook", "block.center"]
length = "L"
unilateral = true
"""
RIDER = """[coordinates.x]
start = 0.1
[bodies.rider]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "block", axis = [1, 0], displacement = "x" }
[forces.back]
kind = "spring"
points = ["block.center", "rider.center"]
along = [1, 0]
length = 0
stiffness = "k"
"""
ENDS = [(end, L) for end in (FLOOR, THREAD) for L in (0.05, 0.5)]


@sampled(3)
@pytest.mark.parametrize("start", ["0", "{ start = 0, speed = 1 }", "0.06"])
@pytest.mark.parametrize(("end", "L"), ENDS, ids=["floor", "above floor", "thread", "slack thread"])
@pytest.mark.parametrize("carried", ["", RIDER], ids=["alone", "carrying"])
def test_a_contact_at_rest_pushes_or_is_open_whatever_the_start(end, L, start, carried):
    """A block of weight W on a spring k that ends at the height L, above a floor or on a thread of length L:

        y = max(0, L - W/k),   N = max(0, W - k L)

    Statics, `solve` at equilibrium and small motions rest there, where it starts above the floor or leaves it at once
    too.
    """
    force = "reaction_n(end)" if end == FLOOR else "tension(end)"
    text = ON_AN_END.replace("START", start).replace("CARRIED", carried).replace("END", end).replace("FORCE", force)
    model = model_of(text + WEIGHT, m=1, g=9.81, k=100, L=L)
    W = 9.81 * (2 if carried else 1)
    y, N = max(0.0, L - W / 100), max(0.0, W - 100 * L)
    answers = eomgen.solve(model)
    assert [answers[name].value for name in ("y", "N")] == pytest.approx([y, N], abs=1e-12)
    assert answers.certify().ok
    found = eomgen.statics(model)
    assert found.certify().ok
    if N and not carried:
        with pytest.raises(DerivationError, match="no degree of freedom"):
            eomgen.linearize(model)
        return
    place = found.as_dict()["equilibria"][0]
    assert place["coordinates"]["y"]["value"] == pytest.approx(y, abs=1e-12)
    assert (place["pulling"], place["passed"]) == ([], [])
    assert ("Open at rest, without a force: end." in rendered(found.document)) == (N == 0)
    small = eomgen.linearize(model)
    assert small.as_dict()["state"]["y"]["value"] == pytest.approx(y, abs=1e-12)
    assert small.certify().ok


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            BOX.replace('x = "x"', 'x = "0"').replace('angle = "th"', 'angle = "0"') + WEIGHT,
            "nothing balances the force",
        ),
        (
            BOX.replace("y = 0", "y = 0\nx = 0\nth = 0") + WEIGHT + '[constraints.f]\nkind = "support"\n'
            'point = "b.center"\nnormal = [0, 1]\nfriction = 0.3\n',
            "'f' has friction",
        ),
        (
            BOX.replace("y = 0", 'y = 0\nx = { motion = "2*t" }').replace('angle = "th"', 'angle = "0"') + WEIGHT,
            "moves at a constant rate",
        ),
    ],
)
def test_what_rests_nowhere_or_anywhere_is_refused(text, words):
    with pytest.raises(DerivationError, match=words):
        found_in(model_of(text, m=1, g=10))


def test_a_drive_is_held_where_it_starts():
    """A shaken mass: at rest the seat of its spring is where it is at t = 0, and that is said."""
    text = """
[coordinates]
y = { motion = "0.3*cos(2*t)" }
x = 0
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", 0] }
[bodies.seat]
mass = 0
joint = { kind = "placed", at = ["y", 0] }
[forces.s]
kind = "spring"
points = ["seat.origin", "b.center"]
stiffness = "k"
length = 0
along = [1, 0]
"""
    text = text.replace("cos(2*t)", "(1 + sin(2*t))")
    found = found_in(model_of(text, m=1, k=2))
    assert found.statics.held == ("y",) and exact(found.found[0]) == {"y": "3/10", "x": "3/10"}


# -- equilibria at which V'' vanishes, known in numbers only --------------------------------------

FLAT = """
[coordinates]
x = {near}
[bodies.b]
mass = "m"
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x" }}
[forces.well]
kind = "force"
point = "b.center"
force = ["-c*({gap})^{order}*({slope})", 0]
"""
GAPS = {
    "cos(x/l) - x/l": ("-sin(x/l) - 1", 0.739085133215161),
    "exp(x/l) - 2 - x/l": ("exp(x/l) - 1", 1.14619322062058),
}


@pytest.mark.parametrize(
    ("gap", "order", "scale"),
    usual([(gap, order, scale) for gap in GAPS for scale in (1.0, 50.0) for order in (2, 1, 3)], 4),
)
def test_a_place_where_the_stiffness_vanishes_is_judged_by_the_force_beside_it(gap, order, scale):
    """V = c f^(n+1)/(n+1): stable for odd n, a point of inflection for even n; to first order only n = 1 holds it"""
    slope, root = GAPS[gap]
    text = FLAT.format(near=(root + 0.1) * scale, gap=gap, slope=slope, order=order)
    model = model_of(text, m=2, c=3, l=scale)
    small = eomgen.linearize(model)
    assert small.certify().ok
    stiffness = small.K[0, 0]
    assert (stiffness > 0) if order == 1 else (stiffness == 0)
    statics = eomgen.statics(model)
    assert statics.certify().ok
    place = min(found_in(model).found, key=lambda each: abs(number(each, "x") - root * scale))
    assert number(place, "x") == pytest.approx(root * scale, rel=1e-6)
    assert place.stability.kind == ("stable" if order % 2 else "unstable")


BUNGEE = """
eomgen = 1
space = "plane"
parameters = { m = 75, k = 90, L = 18, g = 9.81 }
coordinates = { y = { start = START } }
points = { bridge = [0, 0] }
bodies.jumper.shape = { kind = "particle", mass = "m" }
bodies.jumper.joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
forces.cord = { kind = "rope", path = ["bridge", "jumper.center"], stiffness = "k", length = "L", damping = 12 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.parametrize("start", ["-0.01", "-3", "-20"])
def test_rest_is_found_in_another_piece_of_a_law_than_the_start(start):
    """A cord that is slack at the start holds its weight at L + m g/k below, in the piece where it is taut."""
    found = Study(System.of(eomgen.loads(BUNGEE.replace("START", start)))).equilibria.found
    assert [x for place in found for x in place.numbers.values()] == pytest.approx([-(18 + 75 * 9.81 / 90)])
