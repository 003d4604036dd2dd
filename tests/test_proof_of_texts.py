"""What leaves as text is read back: formulas of a derivation, and what `derive --json` carries."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner
from slow_run import usual

import eomgen
from eomgen.cli import main
from eomgen.documents import proven_documents as proof_of_texts
from eomgen.documents import rendered
from eomgen.documents.derivation import printed_formulas
from eomgen.documents.document import Document
from eomgen.documents.text import cases_text
from eomgen.equations import Equations
from eomgen.proof import masses
from eomgen.proof.certificate import certify
from eomgen.proof.check import Certificate, checked
from eomgen.proof.printed import Printed
from eomgen.symbolic.print import text
from eomgen.symbolic.print.layout import Product

MODELS = Path(__file__).parent.parent / "models"


@cache
def equations() -> Equations:
    return eomgen.derive(MODELS / "elastic_pendulum.toml", method="lagrange")


def carried() -> Printed:
    """What is printed, and what the file for machines holds."""
    found = equations()
    texts = found._texts
    named = tuple((name, text, x) for (name, x), text in zip(texts.scalars, texts.texts, strict=True))
    return replace(printed_formulas(found.derivation), texts=named, definitions=tuple(texts.definitions))


def failing(printed: Printed) -> list[str]:
    return [check.name for check in certify(equations().graph, printed=printed).checks if check.status == "fails"]


def test_texts_of_a_derivation_and_of_its_file_hold():
    """Each text, read back, is worth at any state what it stands for."""
    assert carried().texts and not failing(carried())


@pytest.mark.parametrize("entry", ["mass_matrix", "forcing", "kinetic_energy", "generalized_forces", "equations"])
def test_a_wrong_text_for_machines_is_a_contradiction(entry: str):
    """Twice the text of one entry is not that entry."""
    printed = carried()
    k = next(k for k, (name, text, _) in enumerate(printed.texts) if name == entry and text != "0")
    name, text, scalar = printed.texts[k]
    texts = (*printed.texts[:k], (name, f"2*({text})", scalar), *printed.texts[k + 1 :])
    assert failing(replace(printed, texts=texts)) == ["texts for machines, read back, are the equations"]


def test_cases_are_read_back_one_by_one(monkeypatch: pytest.MonkeyPatch):
    """V of a bead on a path of two pieces, "... where s <= L; ...": its expressions, and where each holds."""
    found = eomgen.derive(MODELS / "loop_the_loop.toml").document
    assert " where " in rendered(found, "text") and reported(found) == ["holds"]
    monkeypatch.setattr(proof_of_texts, "cases_text", lambda x: [case.replace("<=", "<") for case in cases_text(x)])
    assert reported(found) == ["fails"]


SAMPLED = """
eomgen = 1
space = "plane"
parameters = { m = 2, l = 0.5, g = 9.81 }
coordinates = { q = 0.3, arm = { motion = { samples = [[0, 0], [1, 0.7], [2, 0.2], [3, 0.4]] } } }
bodies.crank = { points = { tip = ["l", 0] }, joint = { kind = "revolute", angle = "arm" } }
bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
bodies.rod.joint = { kind = "revolute", on = "crank.tip", angle = "q" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.slow
def test_rates_of_samples_are_read_back_by_their_names(monkeypatch: pytest.MonkeyPatch):
    """arm' and arm'' of a motion through samples; one printed for the other is a contradiction."""
    found = eomgen.derive(eomgen.loads(SAMPLED)).document
    assert reported(found) == ["holds"]
    print_side = proof_of_texts.side_text
    monkeypatch.setattr(proof_of_texts, "side_text", lambda x: print_side(x).replace("arm''", "arm'"))
    assert reported(found) == ["fails"]


VERBS = [
    ("statics", "gerber_beam"),
    *(
        pytest.param(verb, name, marks=pytest.mark.slow)
        for verb, name in (
            ("derive", "elastic_pendulum"),
            ("kinematics", "epicyclic_gear"),
            ("inertia", "double_pendulum"),
            ("linearize", "double_pendulum"),
            ("reactions", "three_hinged_arch"),
            ("solve", "seeds/ch22_p1"),
        )
    ),
]


@pytest.mark.parametrize(("verb", "name"), usual([*VERBS], 3, 2))
def test_a_sign_lost_in_printing_is_a_contradiction_of_every_verb(
    verb: str, name: str, monkeypatch: pytest.MonkeyPatch
):
    """Printed with the other sign a term is not what was found: exit 3, whatever the verb and its format."""
    requested = [verb, str(MODELS / f"{name}.toml")]
    monkeypatch.setenv("EOMGEN_FRESH", "1")
    assert CliRunner().invoke(main, requested).exit_code == 0
    monkeypatch.setattr(text, "summands", partial(_turned, text.summands))
    assert [CliRunner().invoke(main, [*requested, *form]).exit_code for form in ([], ["--json"])] == [3, 3]


def _turned(summands: Callable[..., list[Product]], *requested: Any) -> list[Product]:
    """The summands, the first with the other sign where there are several."""
    first, *others = summands(*requested)
    return [replace(first, coefficient=-first.coefficient), *others] if others else [first]


def reported(document: Document) -> list[str]:
    """What the proof of what is printed says, by itself."""
    other = checked("another", "", "by another way")
    certificate = proof_of_texts.proven(document, Certificate((other,))).certificate
    assert certificate is not None
    return [check.status for check in certificate.checks if check != other]


def test_a_couple_that_is_printed_is_read_back():
    """couple(turn) = -F*c of a force of this kind is what is declared, another text a contradiction."""
    found = eomgen.derive(MODELS / "beam_with_overhang.toml")
    printed = printed_formulas(found.derivation)
    assert ("couple(turn)", "-F*c") in printed.formulas
    changed = replace(printed, formulas=(("couple(turn)", "F*c"),))
    (wrong,) = (check for check in certify(found.graph, printed=changed).checks if check.status == "fails")
    assert "couple(turn)" in wrong.detail
    assert all(check.ok for check in certify(found.graph, printed=printed).checks)


@pytest.mark.parametrize("letter", ["T", "V"])
def test_an_energy_with_a_constant_part_is_a_contradiction(letter: str):
    """T = sum of (m v.v + w.I w)/2, V = - sum of f.r: no derivative, and so no equation of motion, knows a constant."""
    graph = equations().graph
    assert certify(graph)
    found = certify(replace(graph, **{letter: getattr(graph, letter) + 1})).checks
    assert [check.name for check in found if check.status == "fails"] == ["T and V are the energies of the bodies"]


@pytest.mark.parametrize(("verb", "name"), VERBS[:5])
def test_numbers_of_other_parameters_are_a_contradiction(verb: str, name: str, monkeypatch: pytest.MonkeyPatch):
    """What is proven at values that are not the file's is proven of another system."""
    own = masses._other_parameters

    def others(scope):
        found = {x: 2 * y + 1 for x, y in scope.model.exact_parameters().items()}
        model = SimpleNamespace(exact_parameters=lambda: found)
        return own(SimpleNamespace(model=model, values_of_parameters=scope.values_of_parameters))

    monkeypatch.setattr(masses, "_other_parameters", others)
    monkeypatch.setenv("EOMGEN_FRESH", "1")
    found = CliRunner().invoke(main, [verb, str(MODELS / f"{name}.toml")])
    assert found.exit_code == 3 and "FAIL parameters have the values of the file" in found.stdout


FAR = """
eomgen = 1
space = "plane"
parameters = { v = 2, w = 1.04719755, k = "pi/3" }
coordinates = { x = { start = 0, speed = "v" }, phi = { start = 0, speed = "w - k" } }
bodies.a.shape = { kind = "disc", mass = 1, radius = 0.2 }
bodies.a.joint = { kind = "planar", x = "x", y = 0, angle = "phi" }
"""


def test_texts_are_read_back_with_parameters_as_exact_as_their_numbers(tmp_path: Path):
    """v/(w - pi/3) is 1.7e9 m: with pi/3 as a double it has 7 digits, and a true text would be contradicted."""
    path = tmp_path / "far.toml"
    path.write_text(FAR)
    reported = CliRunner().invoke(main, ["kinematics", str(path), "--format", "json"])
    assert reported.exit_code == 0
    assert '"exact": "v/(w - k)"' in reported.stdout
