"""One document carries every verb's result: what it shows and what machines get are the same quantities."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

import pytest

import eomgen
from eomgen.documents import rendered
from eomgen.documents.document import Document
from eomgen.questions.reactions import reactions_document
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.verbs.solve import solve_document

MODELS = Path(__file__).parent.parent / "models"


def document(verb: str, name: str) -> Document:
    """What a verb gives of a model."""
    model = eomgen.load(MODELS / f"{name}.toml")
    if verb in ("solve", "reactions"):
        return {"solve": solve_document, "reactions": reactions_document}[verb](model)
    return getattr(eomgen, verb)(model).document


def number_of(exact: str, values: Mapping[str, Fraction]) -> float | None:
    """A printed text in numbers, read by the grammar of the model file; None: it moves, or a value is missing."""
    graph = Graph()
    expression = parse(exact, longest=len(exact))
    if not expression.names <= values.keys() | {"pi"}:
        return None
    names = {name: graph.symbol(name) for name in expression.names - {"pi"}}
    scalar = expression.evaluate({**names, "pi": graph.pi})
    return evaluate((scalar,), {symbol: float(values[name]) for name, symbol in names.items()}, FLOAT)[0]


CASES = [
    pytest.param("solve", "seeds/ch10_p1", marks=pytest.mark.slow),
    ("reactions", "three_hinged_arch"),
    ("statics", "gerber_beam"),
    ("statics", "simple_pendulum"),
    ("kinematics", "slider_crank"),
    ("inertia", "double_pendulum"),
    ("linearize", "double_pendulum"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("verb", "name"), CASES)
def test_the_exact_text_of_every_quantity_gives_its_number(verb, name):
    """value = exact, read back by the grammar with the parameters put in; a unit of an output scales it."""
    model = eomgen.load(MODELS / f"{name}.toml")
    values, compared = model.exact_parameters(), 0
    for key, quantity in document(verb, name).quantities.items():
        found = None if quantity.exact is None else number_of(quantity.exact, values)
        if found is not None and quantity.value is not None:
            assert quantity.value == pytest.approx(found, rel=1e-12, abs=1e-300), key
            compared += 1
    assert compared


def test_the_answers_of_python_are_drawn_as_those_of_the_verb():
    """eomgen.solve(model): text, LaTeX, Markdown and JSON are those of `eomgen solve --no-certify`."""
    model = eomgen.load(MODELS / "seeds" / "ch22_p1.toml")
    found, reported = eomgen.solve(model), solve_document(model, certify=False)
    assert [found.render(form) for form in ("text", "latex", "markdown")] == [
        rendered(reported, form) for form in ("text", "latex", "markdown")
    ]
    assert str(found).startswith("kinetic_energy  = ") and r"\dot{\theta}^{2}" in found.latex()
    assert found.as_dict()["outputs"]["Q_theta"]["exact"] == found["Q_theta"].exact == "6*M*g*R*sin(theta)"


def test_an_equation_of_numbers_alone_is_printed():
    """A couple on what has no inertia: 0 = 2, which no acceleration can fix."""
    text = """
    eomgen = 1
    space = "plane"
    coordinates = { x = 0, y = 0, f = 0.3 }
    bodies.tool.shape = { kind = "particle", mass = 2 }
    bodies.tool.joint = { kind = "free", x = "x", y = "y", angle = "f" }
    forces.turn = { kind = "couple", body = "tool", couple = 2 }
    """
    assert "    0 = 2\n" in eomgen.derive(eomgen.loads(text)).render("text")
