"""Large coefficients have a name in the equations of motion where that halves one of them; proven through the names."""

from __future__ import annotations

from dataclasses import replace

import pytest
from each import each

import eomgen
from eomgen.documents import reading as coefficient_names
from eomgen.documents import rendered
from eomgen.documents.text import side_text
from eomgen.proof.check import Certificate

TRAIN = """
eomgen = 1
name = "Reverted gear train"
space = "plane"
[parameters]
{first} = {{ positive = true }}
J2 = {{ positive = true }}
J3 = {{ positive = true }}
r1 = {{ positive = true }}
r2 = {{ positive = true }}
r3 = {{ positive = true }}
r4 = {{ positive = true }}
M = {{}}
[coordinates]
theta = {{}}
phi = {{ dependent = true }}
psi = {{ dependent = true }}
[bodies.input]
mass = 1
inertia = "{first}"
joint = {{ kind = "revolute", angle = "theta", torque = "M" }}
[bodies.lay]
mass = 1
inertia = "J2"
joint = {{ kind = "revolute", at = ["r1 + r2", 0], angle = "phi" }}
[bodies.output]
mass = 1
inertia = "J3"
joint = {{ kind = "revolute", angle = "psi" }}
[constraints.first]
kind = "equation"
rate = "r1*theta' + r2*phi'"
[constraints.second]
kind = "equation"
rate = "r3*phi' + r4*psi'"
"""


def train(first: str = "J1") -> eomgen.Equations:
    return eomgen.derive(eomgen.loads(TRAIN.format(first=first)))


def test_an_inertia_reduced_to_the_shaft_has_a_name() -> None:
    """I_1 theta'' = M,  I_1 = J1 + J2 (r1/r2)^2 + J3 (r1 r3/(r2 r4))^2"""
    derivation = train().derivation
    (equation,) = derivation.equations
    assert f"{side_text(equation.left)} = {side_text(equation.right)}" == "I_1*theta'' = M"
    ((name, value),) = derivation.definitions
    assert name.name == "I_1" and side_text(value) == "J1 + J2*r1^2/r2^2 + J3*r1^2*r3^2/(r2^2*r4^2)"


@each("taken", ["I_1", "I1"])
def test_a_name_is_none_of_the_model_nor_set_like_one(taken: str) -> None:
    """I1 is set as I_1"""
    ((name, _),) = train(taken).derivation.definitions
    assert name.name == "I_2"


@pytest.mark.slow
@each(
    "form, definition",
    [("text", "    I_1 = J1"), ("latex", "I_{1} &= J_{1}"), ("markdown", "I_{1} &= J_{1}"), ("json", '"I_1"')],
)
def test_the_name_is_defined_in_every_form(form: str, definition: str) -> None:
    """Once, before its use; the table of symbols has its unit."""
    equations = train()
    text = rendered(equations.derivation, form)
    assert definition in text
    if form == "text":
        assert text.count("I_1 = ") == 1 and text.index("I_1 = ") < text.index("I_1*theta''")


def test_the_name_stands_wherever_a_multiple_of_the_coefficient_does() -> None:
    """T = I_1 theta'^2/2, dT/dtheta' = I_1 theta': the definition comes before the first of them"""
    text = rendered(train().derivation, "text")
    for use in ("T = 1/2*I_1*theta'^2", "dT/dtheta' = I_1*theta'", "T + V - W = 1/2*I_1*theta'^2 - M*theta"):
        assert text.index("I_1 = ") < text.index(use)
        assert "coefficient in the equations of motion" in text and "kg·m²" in text


def test_the_proof_sees_through_the_names(monkeypatch: pytest.MonkeyPatch) -> None:
    """A definition that is twice what it should be is noticed."""
    named = coefficient_names.with_coefficients_named

    def twice(*args: object) -> object:
        found = named(*args)  # type: ignore[arg-type]
        return replace(found, definitions=tuple((name, 2 * value) for name, value in found.definitions))

    def proof() -> Certificate:
        equations = train()
        found = equations.proven(equations.derivation).certificate
        assert found is not None
        return found

    assert proof().ok
    monkeypatch.setattr("eomgen.documents.equation_steps.with_coefficients_named", twice)
    monkeypatch.setattr("eomgen.documents.energy_steps.with_coefficients_named", twice)
    assert proof().ok is False


def test_a_short_coefficient_has_none() -> None:
    """(M + m)*x'' stays"""
    assert not eomgen.derive("models/cart_pole.toml").derivation.definitions
