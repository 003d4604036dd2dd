"""D'Alembert's derivation is true: printed balances hold along every motion, printed reactions solve them."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from derivations import LOOSE, by_every_method, derivable, entries, equations, in_time, model_called, read_back
from slow_run import sampled

from eomgen.documents import rendered
from eomgen.documents.document import Document
from eomgen.documents.reaction_steps import letters_of
from eomgen.documents.reaction_values import Lettered
from eomgen.documents.statements import Formula
from eomgen.equations import Equations
from eomgen.errors import DerivationError
from eomgen.mechanics.dynamics.explicit_accelerations import Explicit
from eomgen.mechanics.free_bodies.names_of_reactions import NamedReaction
from eomgen.mechanics.free_bodies.reactions import Reactions
from eomgen.model.reader import loads
from eomgen.pipeline import derive
from eomgen.questions.reactions import reactions
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import substituted
from eomgen.symbolic.expression.node import Node, Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

GOLDEN = Path(__file__).parent / "golden"


LONG = ("chain5", "flyball_governor", "puma560")  # whose reactions are too long to print


def is_short_tree(name: str) -> bool:
    """Nothing closes, nothing is eliminated, something reacts, and everything is printed."""
    e = derived_from(name)
    tree = not e.graph.J and e.system.free is None and bool(e.reactions.components)
    return tree and name not in LONG and Explicit(e.graph).short is not None


HELD = tuple(name for name in derivable() if name not in LOOSE)
BY_KINETOSTATICS = tuple(name for name, method in by_every_method() if method == "kinetostatic")
CLOSING = """
eomgen = 1
name = "Free bars, closed by ties"
space = "plane"
[parameters]
m = 1
l = 1
g = 9.81
[coordinates]
x1 = 0
y1 = 0
a1 = 0.4
x2 = 0
y2 = 0
a2 = 0.1
[bodies.first]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "planar", x = "x1", y = "y1", angle = "a1" }
[bodies.second]
shape = { kind = "rod", mass = "m", length = "2*l" }
joint = { kind = "planar", x = "x2", y = "y2", angle = "a2" }
[points]
O = [0, 0]
[constraints]
O = { kind = "pin", points = ["O", "first.start"] }
A = { kind = "pin", points = ["first.end", "second.start"] }
floor = { kind = "support", point = "second.end", normal = [0, 1], at = [0, 0] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
CLOSED = ("closing", "andrews_squeezer")
LADDER = """
eomgen = 1
name = "Rough ladder"
space = "plane"
[parameters]
m = 10
l = 3
mu = 0.2
g = 9.81
[coordinates]
theta = { start = 0.6, unit = "rad" }
[bodies.ladder]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "placed", at = [0, "l*cos(theta)"], angle = "theta - pi/2" }
[constraints]
wall = { kind = "support", point = "ladder.start", normal = [1, 0], friction = "mu" }
floor = { kind = "support", point = "ladder.end", normal = [0, 1], friction = "mu" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def derived_from(name: str) -> Equations:
    text = {"ladder": LADDER, "closing": CLOSING}.get(name)
    return equations(name, "kinetostatic") if text is None else derive(loads(text), "kinetostatic")


def letters(derived: Equations) -> Lettered:
    found = letters_of(derived.system)
    assert isinstance(found, Lettered)
    return found


def along_motion(derived: Equations) -> dict[Node, Scalar]:
    """The accelerations of the equations of motion."""
    found = Explicit(derived.graph).short
    assert found is not None
    return dict(zip(derived.graph.symbols.a, found, strict=True))


def reactions_along_motion(derived: Equations) -> dict[Node, Scalar]:
    """What the symbols of the reactions and of friction stand for, no acceleration left in it."""
    named, motion = letters(derived), along_motion(derived)
    values = dict(
        zip(named.symbols, substituted([x for x in derived.reactions.values if x is not None], motion), strict=True)
    )
    for contact, frictions in zip(named.contacts, named.frictions, strict=True):
        along = derived.reactions.components[contact.component].friction
        for friction, share in zip(frictions, along, strict=True):
            values[friction] = share.factor * values[named.symbols[contact.component]]
    return values


def formulas(derivation: Document, key: str) -> list[Formula]:
    steps = [step for step in derivation.steps if step.key.startswith(key)]
    return [f for step in steps for f in step.statements if isinstance(f, Formula)]


def whole(derivation: Document, x: Scalar) -> Scalar:
    """x with everything that has a name written out."""
    known: dict[Node, Scalar] = {}
    for symbol, value in derivation.definitions:
        known[symbol] = substituted((value,), known)[0]
    return substituted((x,), known)[0]


@pytest.mark.parametrize("name", ["arm3", "ch17_p3", "double_pendulum", "gimbal_gyroscope", "ladder"])
def test_what_is_printed_of_short_trees_is_looked_at(name):
    """What closes, or is too long to print, is passed over below; these are not."""
    assert is_short_tree(name)


@sampled(2)
@pytest.mark.parametrize("name", [*BY_KINETOSTATICS, "ladder"])
def test_the_printed_equations_of_every_body_hold_along_every_motion(name):
    """sum F + F_in = 0, sum M + M_in = 0 with the reactions and accelerations that the equations give"""
    if not is_short_tree(name):
        return
    derived = derived_from(name)
    motion, known = along_motion(derived), reactions_along_motion(derived)
    balances = [
        f.sides[0]
        for f in formulas(in_time(derived), "body_")
        if f.sides[-1] == 0 and len(f.sides) == 2 and not hasattr(f.sides[0], "letter")
    ]
    assert len(balances) == len(derived.reactions.balance.equations)
    left = substituted(substituted([whole(in_time(derived), x) for x in balances], known), motion)
    assert equal_at_random_states([(x, 0) for x in left]).equal


@pytest.mark.parametrize("name", [*BY_KINETOSTATICS, "ladder"])
def test_printed_inertia_forces_are_what_is_missing_in_the_balance_of_the_bodies(name):
    """F_in = -m a_C, M_in = -d/dt (I omega)"""
    if not is_short_tree(name):
        return
    derived = derived_from(name)
    shown = [f.sides[1] for f in formulas(in_time(derived), "body_") if hasattr(f.sides[0], "letter")]
    inertia = [e.inertia for e in derived.reactions.balance.equations if not is_zero(e.inertia)]
    pairs = [(whole(in_time(derived), x), -y) for x, y in zip(shown, inertia, strict=True)]
    assert equal_at_random_states(pairs).equal


@sampled(3)
@pytest.mark.parametrize(
    ("name", "method"),
    [*((name, "lagrange") for name in HELD), *((name, "kinetostatic") for name in BY_KINETOSTATICS)],
)
def test_printed_reactions_are_those_of_the_balance_by_every_method(name, method):
    """R_bar_x = -1/2*M*l*(...) = -1/4*M*(...): every side, along every motion"""
    if not is_short_tree(name):
        return
    derived = equations(name, method)
    motion, known = along_motion(derived), reactions_along_motion(derived)
    own = set(letters(derived).symbols)
    shown = [f for f in formulas(in_time(derived), "reactions") if f.sides[0] in own]  # the others are definitions
    with_friction = {letters(derived).symbols[contact.component] for contact in letters(derived).contacts}
    assert {f.sides[0] for f in shown} == own - with_friction
    pairs = [
        (substituted((whole(in_time(derived), x),), motion)[0], known[f.sides[0]]) for f in shown for x in f.sides[1:]
    ]
    assert not pairs or equal_at_random_states(pairs).equal


@pytest.mark.parametrize("name", CLOSED)
def test_multipliers_are_the_reactions_that_they_are_said_to_be(name):
    """lam(B, 1) = B_x, sign included: M a + c - Q = J^T lam and the balance of the bodies, at the same state"""
    derived = derived_from(name)
    system, named = derived.system, letters(derived)
    rng = random.Random(5)
    symbols, graph = system.symbols, derived.graph
    state = {
        x: rng.uniform(0.4, 1.1)
        for x in (*symbols.x, *symbols.parameters.values(), symbols.t, *symbols.inputs.values())
    }
    M, J = (np.array(evaluate([x for row in rows for x in row], state, FLOAT)) for rows in (graph.M, graph.J))
    n, k = len(graph.M), len(graph.J)
    M, J = M.reshape(n, n), J.reshape(k, n)
    right = np.array(evaluate((*graph.forcing, *(-x for x in graph.gamma)), state, FLOAT))
    solution = np.linalg.solve(np.block([[M, -J.T], [J, np.zeros((k, k))]]), right)
    state |= dict(zip(symbols.a, solution[:n], strict=True))
    values = dict(zip(named.symbols, named.reactions.values, strict=True))
    for row, lam in zip(system.constraints.closing, solution[n:], strict=True):
        reaction = named.of_row(row)
        assert reaction is not None
        (found,) = evaluate(substituted((reaction,), values), state, FLOAT)
        assert found == pytest.approx(lam, rel=1e-7, abs=1e-7)


def test_indeterminate_reactions_are_said_with_what_they_leave_open():
    """the null space: sum of coefficient * change = 0 in every equation of every body"""
    derived = equations("four_cranks", "kinetostatic")
    data = derived.entries()
    assert None in data["reactions"].values() and len(data["reaction_null_space"]) == 2
    names = [c.name for c in derived.reactions.components]
    a, b, c, e, d = (next(q for q in derived.graph.symbols.q if q.name == name) for name in "abced")
    closed = {b: a, c: a, e: a, d: 0}
    for space in data["reaction_null_space"]:
        change = {names.index(name): read_back(text, derived) for name, text in space.items() if name in names}
        sums = [
            sum((e.coefficients[j] * change[j] for j in e.coefficients if j in change), start=0)
            for e in derived.reactions.balance.equations
        ]
        assert equal_at_random_states([(x, 0) for x in substituted(sums, closed)]).equal
    text = " ".join(rendered(in_time(derived), "text").split())
    assert "are statically indeterminate: rigid bodies in balance leave them open" in text
    assert "Delta(P_y) = -2*k1" in text


@sampled(2)
@pytest.mark.parametrize("name", HELD)
def test_reactions_in_json_read_back_by_the_names_of_outputs(name):
    """{name: text}: the values that an output of that name has, accelerations as theta''"""
    if not is_short_tree(name):
        return
    derived, data = equations(name), entries(name)
    motion, also = along_motion(derived), {}
    for symbol, text in [*data.get("definitions", []), *data.get("reaction_definitions", [])]:
        also[symbol] = read_back(text, derived, also)
    reactions = Reactions.of(derived.system)
    requested = {named.name: named for named in NamedReaction.all_of(reactions.balance)}
    assert list(data["reactions"]) == list(requested)
    pairs = [
        (read_back(text, derived, also), reactions.combined(requested[n].combination, n) + requested[n].given)
        for n, text in data["reactions"].items()
        if text is not None
    ]
    assert equal_at_random_states([substituted(pair, motion) for pair in pairs]).equal


def test_reactions_along_the_motion_are_those_of_the_energy_theorem():
    """bar released from the horizontal: theta'^2 = 3 g sin/l, 5/2 M g below the hinge"""
    text = rendered(equations("ch17_p3", "kinetostatic").derivation, "text")
    assert "    theta'^2 = 3*g*sin(theta)/l\n" in text
    assert "    R_bar_x = -9/8*M*g*sin(2*theta)\n" in text
    assert "    R_bar_y = 1/4*M*g*(1 + 9*sin(theta)^2)\n" in text


def test_friction_is_shown_by_its_normal_reaction_against_the_sliding():
    """F = -mu N sign(v), N with the accelerations that friction itself makes"""
    text = rendered(derive(loads(LADDER), "lagrange").derivation, "text")
    assert "    F_wall = -mu*N_wall*s_wall\n" in text and "    s_floor = sign(cos(theta)*theta')\n" in text
    block = rendered(equations("ch16_p6").derivation, "text")
    assert "    N_plane = m*g*cos(alpha)\n    F_plane = -mu*N_plane*sign(x')\n" in block


def test_a_path_of_pieces_is_read_piece_by_piece():
    """m g cos(alpha) on the line, + m v^2/R on the arc"""
    text = rendered(equations("ch16_p5").derivation, "text")
    on_the_line, on_the_arc = "m*g*cos(alpha) where s <= L", "m*s'^2/R + m*g*cos(alpha - s/R + L/R) otherwise"
    assert f"    N_ball =\n        {on_the_line}\n        {on_the_arc}\n" in text
    forcing = equations("ch16_p5").entries()["forcing"][0]
    assert "select" not in forcing and "sign(s - L)" in forcing


UNHELD = LADDER.replace('floor = { kind = "support", point = "ladder.end", normal = [0, 1], friction = "mu" }', "")


@pytest.mark.parametrize(
    ("model", "word"),
    [
        (loads(UNHELD.replace(', friction = "mu"', "")), "body 'ladder' is unsupported along y"),
        (model_called("loop"), "'pot' acts on coordinates and at no place"),
    ],
)
def test_what_nothing_holds_is_told_and_has_no_kinetostatics(model, word):
    """one sentence in other derivations, an error by this method"""
    derived = derive(model)
    text = " ".join(rendered(in_time(derived), "text").split())
    assert "The reactions do not follow: " in text and word in text
    assert word in derived.entries()["reactions_message"]
    with pytest.raises(DerivationError, match=word):
        derive(model, "kinetostatic")


COUPLED = """
eomgen = 1
name = "Two cars, placed by one coordinate"
space = "plane"
[parameters]
m = 2
[coordinates]
s = 0
[bodies.one]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["s", 0] }
[bodies.two]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "placed", at = ["s + 1", 0] }
[constraints.rail]
kind = "support"
point = "one.center"
normal = [0, 1]
[constraints.second_rail]
kind = "support"
point = "two.center"
normal = [0, 1]
[forces.push]
kind = "force"
point = "one.center"
force = [6, 0]
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
LINK = '[constraints.bar]\nkind = "link"\npoints = ["one.center", "two.center"]\n'


def test_placed_bodies_that_one_coordinate_moves_need_a_constraint_between_them():
    """Each is held, but nothing named carries 2 m s'' to the second: the message says so; with a bar T = -4 N."""
    with pytest.raises(DerivationError, match="'one' is unsupported along x") as refused:
        reactions(loads(COUPLED))
    assert refused.value.fix == "'s' moves 'one' and 'two', and nothing named joins them: name the constraint that does"
    assert reactions(loads(COUPLED + LINK))["tension(bar)"].value == pytest.approx(-4)
    alone = COUPLED.replace('[constraints.rail]\nkind = "support"\npoint = "one.center"\nnormal = [0, 1]\n', "")
    with pytest.raises(DerivationError, match="'one' is unsupported along y") as refused:
        reactions(loads(alone))
    assert "a placed body carries no reaction" in refused.value.fix


def test_long_reactions_are_counted_and_not_printed():
    """chain20: no formula, no table of symbols that stand nowhere"""
    text = " ".join(rendered(equations("chain20").derivation, "text").split())
    assert "All of them are too long to print here: `eomgen reactions MODEL` evaluates them" in text
    assert "R_rod1_x" not in text


def test_the_kinetostatic_text_is_the_golden_one():
    """tests/golden: read it, and write it anew where a change is meant"""
    text = rendered(equations("ch22_p1", "kinetostatic").derivation, "text")
    assert text == (GOLDEN / "ch22_p1_kinetostatic.txt").read_text()
