"""Dense systems whose rows and columns have units of their own."""

from __future__ import annotations

import numpy as np
import pytest
from maximal import dense_solution

import eomgen
from eomgen.symbolic.numeric import arithmetic as modular
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.dense import independent, scaled_condition
from eomgen.symbolic.numeric.evaluation import NoValue, fifty_digits

SMALLEST = 1e-11


@pytest.mark.parametrize("unit", [1e-15, 1e-6, 1.0, 1e9])
def test_a_solution_keeps_its_digits_in_any_unit_of_mass(unit):
    """[[M, -J^T], [J, 0]] (a, lam) = (f, g): M, f and lam in the unit, a in none."""
    rng = np.random.default_rng(5)
    root, J, a, lam = rng.normal(size=(4, 4)), rng.normal(size=(2, 4)), rng.normal(size=4), rng.normal(size=2)
    M = root @ root.T
    A = np.block([[unit * M, -J.T], [J, np.zeros((2, 2))]])
    right = np.concatenate([unit * (M @ a - J.T @ lam), J @ a])
    assert independent(J, smallest=SMALLEST)
    assert dense_solution(A, right, regular=True, smallest=SMALLEST) == pytest.approx([*a, *(unit * lam)], rel=1e-11)


def test_rows_that_follow_from_others_leave_the_accelerations_as_they_are():
    """A row given twice: the multiplier is shared, a is the same."""
    J = np.array([[1.0, 1.0], [1e3, 1e3]])
    A = np.block([[np.eye(2), -J.T], [J, np.zeros((2, 2))]])
    assert not independent(J, smallest=SMALLEST)
    a = dense_solution(A, np.array([1.0, 0.0, 0.0, 0.0]), regular=False, smallest=SMALLEST)[:2]
    assert a == pytest.approx([0.5, -0.5])


def test_a_system_without_solution_has_no_value():
    """0 a = 1"""
    with pytest.raises(NoValue):
        dense_solution(np.zeros((1, 1)), np.ones(1), regular=True, smallest=SMALLEST)


def test_the_condition_of_a_mass_matrix_knows_no_units():
    """diag(1e-12, 1e9) is as good as the identity."""
    assert scaled_condition(np.diag([1e-12, 1e9])) == pytest.approx(1)
    assert scaled_condition(np.array([[1.0, 1.0], [1.0, 1.0]])) > 1e13


@pytest.mark.parametrize("seed", range(4))
def test_a_row_follows_in_the_reals_as_in_the_prime_field(seed):
    """x = sum k_i r_i of integer rows follows from them; with one entry changed it does not."""
    rng = np.random.default_rng(seed)
    rows, shares = rng.integers(-9, 10, size=(3, 5)), rng.integers(-9, 10, size=3)
    row = shares @ rows
    number = fifty_digits().number
    for requested in (row, row + np.eye(5, dtype=int)[seed], 0 * row):
        real = dense.follows_in_digits([[number(int(x)) for x in r] for r in rows], [number(int(x)) for x in requested])
        assert (
            real
            == modular.follows(rows.tolist(), requested.tolist())
            == (np.linalg.matrix_rank([*rows, requested]) == 3)
        )


def test_rows_that_are_rounding_are_no_rows():
    """1e-17 (1, -1) beside (3, 4) says nothing; (3, 4)/5 has length 1."""
    A = np.array([[3.0, 4.0], [1e-17, -1e-17]])
    assert dense.of_one_length(A) == pytest.approx(np.array([[0.6, 0.8], [0.0, 0.0]]))
    assert dense.independent_rows(A, SMALLEST) == [0]
    assert np.array_equal(dense.without_rounding(A), [[3, 4], [0, 0]])


def test_entries_that_are_noise_are_0_against_their_row_or_the_whole():
    """1e-9 is noise beside 1, and not where it stands alone in its row."""
    A = np.array([[1.0, 1e-9], [1e-9, 0.0]])
    assert np.array_equal(dense.without_noise(A, 1e-6), [[1, 0], [0, 0]])
    assert np.array_equal(dense.without_noise(A, 1e-6, axis=1), [[1, 0], [1e-9, 0]])


def test_rows_that_hold_give_a_mass_where_there_is_none():
    """M = diag(2, 0), J = (0, 5): M + tr(M)/2 J^T J/|J|^2 = diag(2, 1) is regular, and a^T M a the same on J a = 0."""
    M, J = np.diag([2.0, 0.0]), np.array([[0.0, 5.0]])
    assert dense.weighted(M, J) == pytest.approx(np.diag([2.0, 1.0]))


SMALL = """
eomgen = 1
name = "a slider-crank of nanograms, or two rods of very different size"
space = "plane"
[coordinates]
theta = 0.4
psi = -0.1
[bodies.crank]
shape = { kind = "rod", mass = 1e-12, length = 3e-4 }
joint = { kind = "revolute", angle = "theta" }
[bodies.rod]
shape = { kind = "rod", mass = 1e-12, length = 1e-3 }
joint = { kind = "revolute", on = "crank.end", angle = "psi - theta" }
[forces.push]
kind = "force"
point = "rod.end"
force = [1, 0]
"""
SLIDER = '[constraints.guide]\nkind = "support"\npoint = "rod.end"\nnormal = [0, 1]\nat = [0, 0]\n'
BESIDE_TONNES = SMALL.replace("mass = 1e-12, length = 3e-4", "mass = 1e6, length = 9")


@pytest.mark.parametrize("text", [SMALL + SLIDER, BESIDE_TONNES])
def test_the_certificate_of_a_system_of_very_small_masses_holds(text):
    """The accelerations of the free bodies agree at 1e-12 kg as at 1 kg."""
    certificate = eomgen.derive(eomgen.loads(text)).certify()
    assert certificate.ok, str(certificate)
