"""The proof of `kinematics` sees errors that are planted in velocities, accelerations, centres and relative motion."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from known_answers import MODELS

import eomgen
from eomgen.documents.json_form import as_dict
from eomgen.documents.proven_documents import shown
from eomgen.mechanics.instant import kinematic_state as relative_motion
from eomgen.mechanics.instant import mechanism
from eomgen.mechanics.kinematics.motion import Motion, VelocityField
from eomgen.study import instant as velocities
from eomgen.verbs.kinematics import kinematics_requested as verb

pytestmark = pytest.mark.slow

CRANK = MODELS / "slider_crank.toml"
HOOP = MODELS / "bead_on_turning_hoop.toml"


def wrong_checks(path: Any, **requested: Any) -> str:
    """The names of the checks that fail."""
    certificate = eomgen.kinematics(eomgen.load(path), **requested).certify()
    return "; ".join(check.name for check in certificate.checks if check.ok is False)


def test_a_mechanism_and_a_motion_hold() -> None:
    """One configuration with given velocities, and a motion with accelerations and a relative motion."""
    assert eomgen.kinematics(eomgen.load(CRANK)).certify()
    certificate = eomgen.kinematics(eomgen.load(HOOP), relative=[RELATIVE]).certify()
    assert certificate
    assert any("a_t + a_r + a_C" in check.name for check in certificate.checks)


RELATIVE = ("bead.center", "hoop")


def test_a_wrong_field_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """omega and epsilon against R(t)."""
    right = Motion.field
    monkeypatch.setattr(Motion, "field", lambda *given: replace(f := right(*given), w=2 * f.w))
    assert "spins and angular" in wrong_checks(CRANK)
    monkeypatch.setattr(Motion, "field", lambda *given: replace(f := right(*given), e=2 * f.e))
    assert "spins and angular" in wrong_checks(MODELS / "double_pendulum.toml", at="t = 1/2")


def test_a_wrong_centre_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """v(centre) = 0"""
    right = mechanism.homogeneous_center

    def planted(field: Any) -> Any:
        x, y, w = right(field)
        return (x, -y, w)

    monkeypatch.setattr(mechanism, "homogeneous_center", planted)
    assert "no velocity against" in wrong_checks(CRANK)


def test_a_wrong_pole_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """a(pole) = 0"""
    model = MODELS / "seeds" / "ch9_p11.toml"
    assert not wrong_checks(model)
    monkeypatch.setattr(VelocityField, "acceleration_pole", lambda field: field.p)
    assert "poles" in wrong_checks(model)


@pytest.mark.parametrize("part", ["coriolis", "transport_acceleration", "relative_acceleration"])
def test_a_wrong_part_of_a_relative_motion_is_seen(monkeypatch: pytest.MonkeyPatch, part: str) -> None:
    """a = a_t + a_r + a_C"""
    right = getattr(relative_motion.Composition, part).fget
    monkeypatch.setattr(relative_motion.Composition, part, property(lambda self: 3 * right(self)))
    assert "a_t + a_r + a_C" in wrong_checks(HOOP, at="t = 1/4", relative=[RELATIVE])


def test_wrong_accelerations_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """M a = forcing + J^T lam"""
    right = velocities._with_accelerations

    def planted(phase: Any, *given: Any) -> Any:
        state, rounded = right(phase, *given)
        return {**state, **{a: 2 * state[a] for a in phase.system.symbols.a}}, rounded

    monkeypatch.setattr(velocities, "_with_accelerations", planted)
    assert "equations of motion" in wrong_checks(MODELS / "double_pendulum.toml")


def test_the_verb_carries_its_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    """`certificate` in JSON, null where none is asked; a contradiction is a failure."""
    model = eomgen.load(CRANK)
    assert as_dict(shown(verb(model)))["certificate"]["ok"] is True
    assert as_dict(shown(verb(model), certify=False))["certificate"] is None
    right = Motion.field
    monkeypatch.setattr(Motion, "field", lambda *given: replace(f := right(*given), v=2 * f.v))
    assert "do not trust" in shown(verb(model)).wrong


def test_points_that_meet_with_one_velocity_and_part_again_stand_apart() -> None:
    """The slider of a governor passes the middle of its shaft at rest, and falls."""
    found = eomgen.kinematics(eomgen.load(MODELS / "flyball_governor.toml"))
    accelerations = {name: a for names, _, _, a in found.state.points for name in names.split(", ")}
    assert not found.state.values.vanish(accelerations["slider.center"])
    assert found.state.values.vanish(accelerations["shaft.center"])
    assert found.certify()
