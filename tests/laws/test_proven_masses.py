"""The proof of `inertia`: it sees errors that are planted in formulas of shapes, parts and sums."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from known_answers import MODELS

import eomgen
from eomgen.cli import main
from eomgen.documents.json_form import as_dict
from eomgen.documents.proven_documents import shown
from eomgen.mechanics.kinematics import principal_axes as rows
from eomgen.mechanics.kinematics import symbols as composition
from eomgen.model.shapes import MassProperties, Rod, Sector
from eomgen.proof.masses import FILLED
from eomgen.results.mass_properties import result
from eomgen.results.mass_properties.result import inertia as verb

PLATE = MODELS / "seeds" / "ch13_p1.toml"
FRAME = MODELS / "seeds" / "ch18_p2.toml"


def wrong_checks(path: Any, **requested: Any) -> list[str]:
    """The checks that fail."""
    return [
        check.name for check in eomgen.inertia(eomgen.load(path), **requested).certify().checks if check.ok is False
    ]


@pytest.fixture
def heavy_rods(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rod of m l^2 / 3 about its middle."""
    right = Rod.of_mass

    def planted(self: Any, m: Any, value: Any) -> MassProperties:
        found = right(self, m, value)
        return replace(found, I=4 * found.I)

    monkeypatch.setattr(Rod, "of_mass", planted)


@pytest.mark.usefixtures("heavy_rods")
def test_a_wrong_shape_is_seen() -> None:
    assert any(name.startswith("every shape") for name in wrong_checks(MODELS / "sliding_ladder.toml"))


VERBS = [
    "derive sliding_ladder",
    "solve sliding_ladder",
    "solve seeds/ch13_p1",
    "reactions sliding_ladder",
    "statics a_frame",
    "linearize double_pendulum",
]


@pytest.mark.slow
@pytest.mark.parametrize("run", VERBS)
@pytest.mark.usefixtures("heavy_rods")
def test_a_wrong_shape_is_seen_by_every_verb(run: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Equations, outputs and small motions of a rod of m l^2 / 3 are those of another body."""
    verb, name = run.split()
    monkeypatch.setenv("EOMGEN_FRESH", "1")
    found = CliRunner().invoke(main, [verb, str(MODELS / f"{name}.toml")])
    assert found.exit_code == 3 and f"FAIL {FILLED}" in found.stdout


def test_parts_that_do_not_add_up_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """m r_C = sum m_k r_k, I = sum (I_k + m_k d_k^2)"""
    assert eomgen.inertia(eomgen.load(PLATE)).certify()
    right = composition._put_together

    def planted(*given: Any) -> Any:
        made = right(*given)
        return replace(made, whole=replace(made.whole, com=(made.whole.com[0] * 2, *made.whole.com[1:])))

    monkeypatch.setattr(composition, "_put_together", planted)
    assert "the parts of every body add up" in wrong_checks(PLATE)


def test_wrong_parallel_axes_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """I_P = I_C + m (d.d 1 - d d^T)"""
    right = rows.InertiaRow.shift
    monkeypatch.setattr(
        rows.InertiaRow, "shift", lambda self, point: tuple(tuple(-x for x in r) for r in right(self, point))
    )
    assert any(name.startswith("masses, centres") for name in wrong_checks(FRAME))


def test_wrong_principal_axes_and_radii_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """R I R^T = diag(I_1, I_2, I_3), k = sqrt(I/m)"""
    right = rows.InertiaAbout.axes_in_numbers
    monkeypatch.setattr(rows.InertiaAbout, "axes_in_numbers", lambda about: [[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    assert any(name.startswith("principal axes") for name in wrong_checks(FRAME))
    monkeypatch.setattr(rows.InertiaAbout, "axes_in_numbers", right)
    monkeypatch.setattr(rows.InertiaAbout, "radius", lambda about, moment: moment)
    assert any(name.startswith("masses, centres") for name in wrong_checks(FRAME))


def test_principal_axes_are_unit_vectors_where_a_product_vanishes_at_the_start() -> None:
    """sin(theta) cos(theta) = 0 there, by whose sign the axes are told apart in closed form."""
    for name in ("ball_on_free_hemisphere", "car_axis"):
        axes = np.array(eomgen.inertia(eomgen.load(MODELS / f"{name}.toml")).axes["together"])
        assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)


def test_sizes_that_no_body_has_are_not_called_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """What could not be looked at is `unchecked`."""
    text = '[bodies.b]\nshape = { kind = "sector", mass = 1, radius = 1, opening = 1 }\n'
    model = eomgen.loads('eomgen = 1\nname = "s"\nspace = "plane"\n' + text)
    monkeypatch.setattr(Sector, "impossible", lambda self, value: "more than a turn")
    certificate = eomgen.inertia(model).certify()
    assert certificate.checks[0].status == "unchecked"


def test_the_verb_carries_its_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    """`certificate` in JSON, null where none is asked; a contradiction is a failure."""
    model = eomgen.load(FRAME)
    assert as_dict(shown(verb(model)))["certificate"]["ok"] is True
    assert as_dict(shown(verb(model), certify=False))["certificate"] is None
    monkeypatch.setattr(result, "polar_results", lambda section: [section.named("J", "P", 1, "kg*m^2")])
    assert "do not trust" in shown(verb(model, about="AB.end")).wrong
