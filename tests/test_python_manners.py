"""What a person does with equations in Python: names that just work, g, C and Jacobians, short words on a line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sympy

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"


@pytest.fixture(scope="module")
def pendulum() -> eomgen.Equations:
    return eomgen.derive(MODELS / "double_pendulum.toml")


@pytest.mark.parametrize(
    "key", ["m1", sympy.Symbol("m1"), sympy.Symbol("m1", real=True)], ids=["text", "plain", "real"]
)
def test_a_name_replaces_its_symbol(pendulum, key):
    """x.subs("m1", 0), of matrices and of scalars; it was found nowhere, in silence"""
    for x in (pendulum.M, pendulum.T, pendulum.Q):
        assert "m1" in {s.name for s in x.free_symbols} and "m1" not in {s.name for s in x.subs({key: 5}).free_symbols}
    assert pendulum.T.subs({"theta1'": 0, "theta2'": 0}) == 0


@pytest.mark.parametrize("name", ["E", "I", "N", "S", "beta", "lambda", "gamma", "q'"])
def test_names_that_mean_something_else_to_sympy_are_names_here(name):
    symbol = eomgen.symbolic.print.sympy_form.symbol(name)
    assert (sympy.sin(symbol) * symbol).subs({name: 2}) == 2 * sympy.sin(2)


def test_a_symbol_is_the_real_symbol_of_its_name(pendulum):
    """What is written by hand with real symbols is equal, and sorted alike."""
    m1, m2, l1 = sympy.symbols("m1 m2 l1", real=True)
    assert pendulum.M[0, 0] - (m1 / 3 + m2) * l1**2 == 0 or sympy.expand(pendulum.M[0, 0] - (m1 / 3 + m2) * l1**2) == 0
    assert hash(pendulum.symbols["m1"]) == hash(m1) and pendulum.symbols["m1"] != sympy.Symbol("m1")


def test_substitution_takes_names_numbers_and_texts_at_once(pendulum):
    found = pendulum.subs({"theta1": 0}, m1=6, m2="2*m1")
    m1, l1 = pendulum.symbols["m1"], pendulum.symbols["l1"]
    assert sympy.expand(found.M[0, 0] - (2 + 2 * m1) * l1**2) == 0 and found.gravity[0] == 0
    with pytest.raises(eomgen.UsageError, match="nothing is called 'm3' in the equations") as caught:
        pendulum.subs(m3=1)
    assert "one of t, m1, m2" in str(caught.value)
    with pytest.raises(AttributeError, match="no matrix 'MM'"):
        found.MM  # noqa: B018


@pytest.mark.parametrize("name", ["double_pendulum", "elastic_pendulum", "cart_pole", "heavy_top", "arm3"])
def test_coriolis_makes_c_and_is_skew_beside_the_rate_of_M(name):
    """C u = c, and u^T (M' - 2 C) u' vanishes for every pair, M' - 2 C = -(M' - 2 C)^T, at random states"""
    e = eomgen.derive(MODELS / f"{name}.toml")
    rng = np.random.default_rng(1)
    values = {symbol: sympy.Rational(int(rng.integers(1, 60)), 37) for symbol in e.symbols.values()}
    q, u = ([e.symbols[x] for x in names] for names in (e.coordinates, e.speeds))
    rate = sum((e.M.diff(x) * v for x, v in zip(q, u, strict=True)), start=sympy.zeros(len(u)))
    S = np.array((rate - 2 * e.coriolis).xreplace(values).evalf(), dtype=float)
    assert np.allclose(S, -S.T, atol=1e-10)
    short = np.array((e.coriolis * sympy.Matrix(u) - e.c).xreplace(values).evalf(), dtype=float)
    assert np.allclose(short, 0, atol=1e-10)


def test_where_c_is_no_matter_of_christoffel_it_is_said():
    with pytest.raises(eomgen.DerivationError, match="where the speeds are the rates of all coordinates"):
        eomgen.derive(MODELS / "four_bar.toml").coriolis  # noqa: B018
    with pytest.raises(eomgen.DerivationError, match=r"the rates of all coordinates|function of time"):
        eomgen.derive(MODELS / "bead_on_turning_hoop.toml").coriolis  # noqa: B018


def test_gravity_is_what_holds_up_the_weight(pendulum):
    """g = N^T dV/dq where gravity alone has a potential; a spring is no part of it"""
    q = [pendulum.symbols[name] for name in pendulum.coordinates]
    assert sympy.simplify(pendulum.gravity - sympy.Matrix([pendulum.V.diff(x) for x in q])) == sympy.zeros(2, 1)
    elastic = eomgen.derive(MODELS / "elastic_pendulum.toml")
    assert "k" not in {s.name for s in elastic.gravity.free_symbols} < {s.name for s in elastic.V.free_symbols}


@pytest.mark.parametrize(
    "name", ["double_pendulum", "four_bar", "cart_pole", "heavy_top", "rolling_disc_and_bar", "stewart_platform"]
)
def test_slopes_of_the_right_hand_side_are_its_differences(name):
    """A = df/dx and B = df/dw by central differences, constraints and dependent speeds included"""
    e = eomgen.derive(MODELS / f"{name}.toml")
    rhs, x, h = e.rhs("numpy"), e.start(), 1e-6
    w = np.zeros(len(e.inputs))
    A, B = e.rhs_jacobian(inputs=w)

    def slopes(f, at):
        return np.array([(f(at + h * d) - f(at - h * d)) / (2 * h) for d in np.eye(len(at))]).T.reshape(len(x), -1)

    assert np.allclose(A, slopes(lambda y: rhs(0.0, y, rhs.p0, w), x), rtol=1e-5, atol=1e-5 * abs(A).max())
    if len(w):
        assert np.allclose(B, slopes(lambda v: rhs(0.0, x, rhs.p0, v), w), rtol=1e-5, atol=1e-5 * abs(B).max())


def test_the_jacobian_of_a_point_gives_its_velocity(pendulum):
    """v = J u: of the end of the second arm, by hand"""
    s = pendulum.symbols
    by_hand = [
        [s["l1"] * sympy.cos(s["theta1"]), s["l2"] * sympy.cos(s["theta2"])],
        [s["l1"] * sympy.sin(s["theta1"]), s["l2"] * sympy.sin(s["theta2"])],
    ]
    assert pendulum.point_jacobian("arm2.end") == sympy.Matrix(by_hand)
    assert pendulum.point_jacobian("O").is_zero_matrix if "O" in pendulum.model.points else True
    with pytest.raises(eomgen.UsageError, match=r"no point 'arm2\.ende'"):
        pendulum.point_jacobian("arm2.ende")


def test_every_repr_is_a_line_or_two(pendulum):
    """At most 240 characters, and no line breaks, whatever the size of what it stands for"""
    model = pendulum.model
    run = eomgen.simulate(model, time=0.1, samples=11)
    found = [
        *(pendulum, pendulum.graph, pendulum.system, pendulum.program, pendulum.reactions, pendulum.derivation),
        *(pendulum.certify(), pendulum.subs(m1=1), pendulum.rhs("numpy"), pendulum.inverse_dynamics()),
        *(model, model.parameters, model.bodies["arm2"], model.bodies["arm2"].joint, model.coordinates["theta1"]),
        *(eomgen.linearize(model), eomgen.statics(model), eomgen.inertia(model), eomgen.solve(model)),
        *(eomgen.reactions(model), eomgen.freedom_of(model), model.scene(), run),
    ]
    for each in found:
        assert "\n" not in repr(each) and len(repr(each)) <= 240, repr(each)
    assert repr(model.bodies["arm2"].joint) == "Revolute(on='arm1.end', point='start', angle='theta2 - theta1')"


def test_the_help_of_a_part_names_its_fields_and_not_their_rules():
    import pydoc

    text = pydoc.plain(pydoc.render_doc(eomgen.joints.Revolute))
    head = "Revolute(*, on=None, at=None, point=None, turned=None, symbol=None, angle, axis=None"
    assert head in " ".join(text.replace("|", " ").split()).replace("( ", "(")  # Python 3.13 breaks long signatures
    assert "Annotated" not in text[:1200] and "angle: of the child against the parent" in text


def test_results_show_themselves_in_notebooks(pendulum):
    """A model by its picture, equations and answers typeset, a formula that no line holds by its size"""
    assert pendulum.model._repr_png_().startswith(b"\x89PNG")
    assert r"\ddot{\theta}_{1}" in pendulum._repr_latex_()
    answers = eomgen.solve(MODELS / "seeds" / "ch22_p1.toml")._repr_markdown_()
    assert r"| `Q_theta` | $6 M R g \sin\theta" in answers or r"\sin\theta" in answers
    assert "| `reaction_x(arm1)` |" in eomgen.reactions(pendulum.model)._repr_markdown_()
