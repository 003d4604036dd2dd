"""The page of every joint, constraint, force and shape: an example that holds, a picture, words for each field."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from each import each
from slow_run import sampled

import eomgen
from eomgen.page.figure import rest_figure
from eomgen.page.paper import typst_text
from eomgen.scene.scene import Mark, Scene, frame_at
from eomgen.study import StateInNumbers

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "docs" / "_ext"))

import kinds  # noqa: E402  the site's own extensions
import reference  # noqa: E402

pytestmark = pytest.mark.slow

EVERY = list(kinds.kinds())
SHOWN = [kind for kind in EVERY if (kinds.EXAMPLES / f"{kind}.toml").exists()]  # the first test names the others
NOT_DRAWN = {
    *("planar", "free", "placed"),  # nothing is there that could be drawn
    *("equation", "generalized", "kinetic", "potential", "added_mass"),  # of coordinates
    *("gear", "torsion_damper"),  # seen by its bodies
}


def shown_by(model: eomgen.Model, kind: str) -> list[str]:
    """The names of the parts of a model that are of a kind; of a joint its body's."""
    hung = {name: body.joint for name, body in model.bodies.items() if body.joint is not None}
    shaped = {name: body.shape for name, body in model.bodies.items() if body.shape is not None}
    rooms = {"Joints": hung, "Constraints": model.constraints, "Forces": model.forces, "Shapes": shaped}
    parts = rooms[kinds.kinds()[kind]]
    return [name for name, part in parts.items() if part.kind == kind]


@each("kind", EVERY)
def test_every_kind_has_an_example_that_is_proven(kind):
    """docs/examples/KIND.toml has it, and what is derived of it holds by its certificate."""
    path = kinds.EXAMPLES / f"{kind}.toml"
    assert path.exists(), f"'{kind}' has no example: write {path.relative_to(ROOT)}, a small model that uses it"
    model = eomgen.load(path)
    assert shown_by(model, kind), f"the example of '{kind}' does not use it"
    at_rest = eomgen.inertia if kinds.kinds()[kind] == "Shapes" else eomgen.statics
    found = eomgen.derive(model) if model.coordinates else at_rest(model)
    certificate = found.certify()
    assert certificate.ok is True and certificate.checks


@sampled(3)
@pytest.mark.parametrize("kind", SHOWN)
def test_every_kind_has_a_picture(kind, tmp_path):
    """Of lengths above 0, with finite numbers, and with marks of the kind itself where it can be seen."""
    scene = kinds.example(kind).scene()
    if kinds.kinds()[kind] != "Shapes":  # a shape is drawn here by its marks alone, in full when the site is built
        rest_figure(kinds.example(kind)).save(tmp_path / "it.svg")
        assert (tmp_path / "it.svg").read_text("utf-8").count("<path") > 5
    frame = frame_at(scene, StateInNumbers.at_start(scene.system))
    assert np.isfinite(frame).all()
    assert kind in NOT_DRAWN or marks_of(kind, scene), f"no mark of it in the picture of '{kind}'"


@sampled(10)
@pytest.mark.parametrize("kind", SHOWN)
def test_what_is_said_of_a_kind_can_be_set_on_paper(kind):
    """Every command in its formulas has a word in Typst."""
    report = eomgen.report(kinds.EXAMPLES / f"{kind}.toml", certify=False)
    assert "$" in typst_text(report)


def marks_of(kind: str, scene: Scene) -> list[Mark]:
    """The marks that show a joint, a constraint or a force, and not the bodies at it."""
    if kind == "gravity":
        return [mark for mark in scene.marks if mark.form.kind == "field"]
    roles = ("inertia", "label", "point", "dimension", "axes", *(["body"] if kinds.kinds()[kind] != "Shapes" else []))
    names = shown_by(kinds.example(kind), kind)
    return [mark for mark in scene.marks if mark.of in names and mark.role not in roles]


def test_no_example_is_left_over():
    """Each file of docs/examples is one of a kind."""
    assert not {path.stem for path in kinds.EXAMPLES.glob("*.toml")} - {*EVERY}


@each("kind", EVERY)
def test_every_field_is_explained(kind):
    """By the docstrings of the class and its bases, and by its rule; its first line says what it is."""
    cls = kinds.class_of(kind)
    known = cls.meanings()
    assert not [slot.key for slot in cls.slots() if not known.get(slot.name)]
    assert all(reference.value_of(slot.rule) for slot in cls.slots())
    assert reference.gist(cls)


@each(
    "kind, free, held",
    [
        ("revolute", 1, 2),
        ("prismatic", 1, 2),
        ("fixed", 0, 3),
        ("screw", 1, 5),
        ("universal", 2, 4),
        ("spherical", 3, 3),
    ],
)
def test_what_a_joint_leaves_and_carries_fills_its_space(kind, free, held):
    """f + (reactions) = 3 in the plane, 6 in space, as the page counts them."""
    said = kinds.counted(kind, kinds.example(kind))
    assert said.startswith(f"It leaves {kinds.plural(free, 'freedom')},") and said.count("`") == 2 * held
    assert free + held == (3 if "plane" in said else 6)


@each("example", sorted(path.stem for path in (kinds.EXAMPLES / "outputs").glob("*.toml")))
def test_what_the_example_of_a_function_asks_is_answered(example):
    """docs/examples/outputs: each of its outputs has a value."""
    model = eomgen.load(kinds.EXAMPLES / "outputs" / f"{example}.toml")
    reported = kinds.answered(model, list(model.outputs))
    assert all(
        re.search(rf"^\| `{name}` \|.*\| -?[\d.]+(e[+-]\d+)?( \S+)* \|$", reported, re.M) for name in model.outputs
    ), reported


def test_every_output_function_has_an_example():
    """Each of `ALL` is asked in one of docs/examples/outputs."""
    assert not [function.names for function in kinds.outputs.ALL if not kinds.requested_in(function)]
