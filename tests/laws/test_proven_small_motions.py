"""The proof of `linearize` sees an error planted in any part of the way from the equations of motion to the modes."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from click.testing import CliRunner
from known_answers import MODELS

import eomgen
from eomgen.cli import main
from eomgen.mechanics.linearization import linearization, reduction
from eomgen.mechanics.linearization.modes import Modes
from eomgen.proof.small_motions import small_motion_checks

PENDULUM = MODELS / "double_pendulum.toml"


def wrong_checks(path: Any = PENDULUM) -> list[str]:
    """The checks that fail."""
    return [check.name for check in eomgen.linearize(eomgen.load(path)).certify().checks if check.ok is False]


def scaled(rows: Any, factor: float = 2) -> Any:
    return [[x * factor for x in row] for row in rows]


@pytest.mark.slow
@pytest.mark.parametrize(("letter", "what"), [("K", "motions near"), ("M", "kinetic energy"), ("C", "motions near")])
def test_a_wrong_matrix_is_seen(monkeypatch: pytest.MonkeyPatch, letter: str, what: str) -> None:
    """M q'' + C q' + K q = 0 of motions beside the reference; d . M d of the kinetic energy."""
    right = reduction.Reducing.equations.func

    def planted(self: Any) -> Any:
        e = right(self)
        wrong = scaled(e.K) if letter == "C" else scaled(getattr(e, letter))
        return replace(e, **{letter: wrong})

    monkeypatch.setattr(reduction.Reducing, "equations", property(planted))
    assert any(what in name for name in wrong_checks())


def test_a_wrong_state_matrix_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """x' = A x"""
    right = reduction.LinearEquations.state_matrix.fget
    monkeypatch.setattr(reduction.LinearEquations, "state_matrix", property(lambda e: right(e) * 1.001))
    assert "they satisfy x' = A x + B w" in wrong_checks()


def test_a_place_that_is_no_reference_is_seen() -> None:
    """a = 0 there"""
    small = eomgen.linearize(eomgen.load(PENDULUM)).small
    q = small.reference.system.symbols.q[0]
    aside = {**small.reference.numbers, q: small.reference.numbers[q] + 1e-3}
    moved = replace(small, reference=replace(small.reference, numbers=aside))
    first, *_ = small_motion_checks(Modes(moved))
    assert first.name.endswith("without acceleration")
    assert not first.ok


def test_coordinates_asked_alone_move_as_in_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """Routh's reduction of the cart under a pendulum: K = K_cc, M = M_cc - M_co M_oo^-1 M_oc."""
    model = eomgen.load(MODELS / "cart_pole.toml")
    requested = next(name for name in model.coordinates if name not in ("x", "s"))
    assert eomgen.linearize(model, coordinates=(requested,)).certify()
    right = linearization.restricted

    def planted(*given: Any) -> Any:
        found = right(*given)
        return replace(found, M=scaled(found.M))

    monkeypatch.setattr(linearization, "restricted", planted)
    assert not eomgen.linearize(model, coordinates=(requested,)).certify()


@pytest.mark.slow
def test_the_verb_carries_its_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    """`certificate` in JSON, null with --no-certify, exit 3 where it fails."""
    run = CliRunner().invoke
    proven = json.loads(run(main, ["linearize", str(PENDULUM), "--json"]).stdout)["certificate"]
    assert proven["ok"] is True
    assert {"name", "status", "ok", "how", "detail"} <= proven["checks"][-1].keys()
    assert json.loads(run(main, ["linearize", str(PENDULUM), "--json", "--no-certify"]).stdout)["certificate"] is None
    right = reduction.LinearEquations.state_matrix.fget
    monkeypatch.setattr(reduction.LinearEquations, "state_matrix", property(lambda e: right(e) * 1.001))
    failed = run(main, ["linearize", str(PENDULUM)])
    assert failed.exit_code == 3
    assert "do not trust this result" in failed.stdout
