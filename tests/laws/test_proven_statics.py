"""The proof of `statics` sees errors that are planted in reactions, section forces, influence lines, equilibria."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from known_answers import MODELS

import eomgen
from eomgen.documents.json_form import as_dict
from eomgen.documents.proven_documents import shown
from eomgen.mechanics.equilibrium import search
from eomgen.mechanics.statics import forces_in_sections as section_forces
from eomgen.mechanics.statics import influence
from eomgen.mechanics.statics import virtual_work as two_ways
from eomgen.results.at_rest.result import statics as verb

BEAM = MODELS / "gerber_beam.toml"
PENDULUM = MODELS / "simple_pendulum.toml"


def wrong_checks(path: Any, **requested: Any) -> str:
    """The names of the checks that fail."""
    certificate = eomgen.statics(eomgen.load(path), **requested).certify()
    return "; ".join(check.name for check in certificate.checks if check.ok is False)


def test_a_beam_an_influence_line_and_places_of_rest_hold() -> None:
    """Each with its own checks."""
    body = next(iter(eomgen.load(BEAM).bodies))
    for requested in (None, "reaction_y(E)", f"bending_moment({body}, 1)", f"shear_force({body}, 1)"):
        assert eomgen.statics(eomgen.load(BEAM), influence=requested).certify()
    assert eomgen.statics(eomgen.load(PENDULUM)).certify()


def test_a_wrong_reaction_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """By virtual work and by the balance of the bodies."""
    right = two_ways.by_virtual_work

    def planted(*given: Any) -> Any:
        found = right(*given)
        return None if found is None else replace(found, value=found.value * 2)

    monkeypatch.setattr(two_ways, "by_virtual_work", planted)
    assert "virtual work" in wrong_checks(BEAM)


@pytest.mark.parametrize(("series", "what"), [("shear_force", "other end"), ("bending_moment", "dM/dx")])
def test_wrong_section_forces_are_seen(monkeypatch: pytest.MonkeyPatch, series: str, what: str) -> None:
    """N, V, M of what acts behind; dM/dx = V."""
    right = section_forces._piece

    def planted(*given: Any) -> Any:
        piece = right(*given)
        c0, c1, *others = piece.series[series]
        wrong = (c0, 2 * c1, *others) if series == "bending_moment" else (2 * c0, c1, *others)
        return replace(piece, series={**piece.series, series: wrong})

    monkeypatch.setattr(section_forces, "_piece", planted)
    assert what in wrong_checks(BEAM)


@pytest.mark.parametrize("name", ["gerber_beam", "shear_legs", "a_frame"])
def test_a_reaction_that_is_not_told_is_seen(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Each component of what holds the bodies is in one of the reactions."""
    right = two_ways.requested_reactions
    monkeypatch.setattr(two_ways, "requested_reactions", lambda structure: dict(list(right(structure).items())[1:]))
    assert "every reaction is reported" in wrong_checks(MODELS / f"{name}.toml")


@pytest.mark.parametrize("name", ["gerber_beam", "three_hinged_arch", "seeds/ch21_p2"])
def test_an_extreme_that_is_not_told_is_seen(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Where V changes its sign within a piece M has an extreme."""
    monkeypatch.setattr(section_forces, "_roots", lambda *given: [])
    assert wrong_checks(MODELS / f"{name}.toml") == "where M has an extreme V is 0, within a part"


def test_a_wrong_influence_line_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """X(P) = -e . v(P)"""
    right = influence._Travelling._value
    monkeypatch.setattr(influence._Travelling, "_value", lambda *given: -right(*given))
    assert "influence line" in wrong_checks(BEAM, influence="reaction_y(E)")


def test_a_place_that_is_none_of_rest_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """a = 0, and Q = 0"""
    found = eomgen.statics(eomgen.load(PENDULUM))
    first, *others = found.places
    q = first.statics.system.symbols.q[0]
    moved = replace(first, exact={**first.exact, q: first.exact[q] + 1})
    wrong = replace(found, found=replace(found.found, found=(moved, *others))).certify()
    failing = [check.name for check in wrong.checks if check.ok is False]
    assert "no acceleration at the equilibria" in failing
    assert "forces balance and constraints are satisfied at every equilibrium" in failing


def test_a_wrong_word_of_stability_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """-w^2 are the eigenvalues of da/dq."""
    right = search.stability_of
    other = {"stable": "unstable", "unstable": "stable"}

    def planted(*given: Any) -> Any:
        found = right(*given)
        return replace(found, kind=other.get(found.kind, found.kind))

    monkeypatch.setattr(search, "stability_of", planted)
    assert "stated stability" in wrong_checks(PENDULUM)


def test_the_verb_carries_its_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    """`certificate` in JSON, null where none is asked; a contradiction is a failure."""
    model = eomgen.load(BEAM)
    assert as_dict(shown(verb(model)))["certificate"]["ok"] is True
    assert as_dict(shown(verb(model), certify=False))["certificate"] is None
    monkeypatch.setattr(section_forces, "SIXTH", 1)
    monkeypatch.setattr(section_forces, "HALF", 1)
    assert "do not trust" in shown(verb(model)).wrong
