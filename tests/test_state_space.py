"""linearize: the state space x' = A x + B w, y = C_y x + D_y w, and how matrices are printed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from each import each
from tools import needs

import eomgen
from eomgen.documents.statements import Law, Matrix
from eomgen.documents.text import statement_lines

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"


@pytest.fixture(scope="module")
def cart() -> eomgen.Linearization:
    return eomgen.linearize(MODELS / "cart_pole.toml")


def test_a_state_space_has_the_transfer_functions(cart):
    """C_y (s 1 - A)^-1 B + D_y = W(s), of a place and of an acceleration, which is s^2 times it"""
    system = cart.state_space(["x", "theta", "theta''"])
    s = 1.7 + 0.4j
    W = system.C_y @ np.linalg.solve(s * np.eye(4) - system.A, system.B) + system.D_y
    M, g, m, length = 1.0, 9.81, 0.1, 1.0
    theta = 6 / (length * (4 * M + m) * s**2 - 6 * g * (M + m))
    x = (4 * length * s**2 - 6 * g) / (length * (4 * M + m) * s**4 - 6 * g * (M + m) * s**2)
    assert np.allclose(W[:, 0], [x, theta, s**2 * theta])


@each("name", ["cart_pole", "half_car", "double_pendulum", "balancing_robot", "furuta_pendulum"])
def test_the_exact_state_space_is_that_in_numbers(name):
    """A and B of the parameters' values, and their eigenvalues those of the modes"""
    found = eomgen.linearize(MODELS / f"{name}.toml")
    system = found.state_space()
    values = {str(symbol): symbol for A in system.exact.values() for symbol in A.free_symbols}
    known = {symbol: float(found.model.parameters[name].value.evaluate({})) for name, symbol in values.items()}
    for letter, A in system.exact.items():
        exact = np.array(A.subs(known).evalf(), dtype=float).reshape(getattr(system, letter).shape)
        assert np.allclose(exact, getattr(system, letter), rtol=1e-12, atol=1e-12)
    assert np.allclose(np.poly(system.A), np.poly(found.spectrum.eigenvalues), atol=1e-9)
    assert np.array_equal(np.vstack([*system][:1]), found.A) and found.C.shape == found.M.shape


def test_what_is_no_output_is_refused(cart):
    with pytest.raises(eomgen.errors.UsageError, match="no output 'phi' of small motions"):
        cart.state_space("phi")


def test_matrices_stand_as_matrices_in_every_format(cart):
    """Rows below one another, \\begin{pmatrix}, and [[...], [...]] for machines"""
    text = str(cart)
    assert "    M = [M + m     -1/2*m*l ]\n        [-1/2*m*l  1/3*m*l^2]\n" in text
    assert (
        r"M &= \begin{pmatrix} M + m & - \frac{1}{2} m l \\ - \frac{1}{2} m l & \frac{1}{3} m l^{2} \end{pmatrix}"
        in (cart.latex())
    )
    found = cart.as_dict()
    assert "A = [[0, 0, 1, 0], [0, 0, 0, 1]," in str(found["steps"])
    assert found["state_space"]["A"]["exact"][2][1] == "3*m*g/(4*M + m)"
    assert found["state_space"]["outputs"] == ["x", "theta"] and found["state_space"]["D_y"]["value"] == [[0], [0]]


def test_a_matrix_that_no_line_holds_stands_entry_by_entry():
    text = str(eomgen.linearize(MODELS / "whipple_bicycle.toml"))
    assert "K[phi, phi] = " in text and max(map(len, text.splitlines())) <= 100


def test_columns_of_a_matrix_stand_below_one_another():
    formula = eomgen.documents.statements.Formula((Law("A", "A"), Matrix(((1, 20), (300, 4)))))
    assert statement_lines(formula) == ["    A = [1    20]", "        [300  4 ]"]


def test_a_state_space_goes_to_scipy(cart):
    """scipy's lti has the transfer function of theta: W(i w) by its own bode."""
    lti = cart.state_space(["theta"]).to_scipy()
    _, size, _ = lti.bode([2.0])
    theta = 6 / ((4 * 1.0 + 0.1) * (2j) ** 2 - 6 * 9.81 * (1.0 + 0.1))
    assert size[0] == pytest.approx(20 * np.log10(abs(theta)), rel=1e-9)


@needs(".control", what="control")
def test_a_state_space_goes_to_python_control(cart):
    """The same number out of control's own evaluation, and the names are kept."""
    system = cart.state_space(["x", "theta"]).to_control()
    theta = 6 / ((4 * 1.0 + 0.1) * (1 + 2j) ** 2 - 6 * 9.81 * (1.0 + 0.1))
    assert system(1 + 2j)[1, 0] == pytest.approx(theta, rel=1e-9)
    assert list(system.state_labels) == ["x", "theta", "x'", "theta'"] and list(system.input_labels) == ["F"]


def test_a_state_space_without_inputs_is_refused_by_name():
    """No input, no transfer function: what is wrong, and what fixes it."""
    with pytest.raises(eomgen.EomgenError, match="without inputs"):
        eomgen.linearize(MODELS / "double_pendulum.toml").state_space().to_scipy()
