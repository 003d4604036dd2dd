"""The page of every joint, tie and force: an example that holds, a picture of the kind, words for each field."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from each import each

import eomgen
from eomgen.model.part import slots_of
from eomgen.page.figure import rest_figure
from eomgen.scene.scene import Mark, Scene, drawn_start, frame_at

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "docs" / "_ext"))

import kinds  # noqa: E402  the site's own extension

pytestmark = pytest.mark.slow

EVERY = list(kinds.kinds())
NOT_DRAWN = {
    *("planar", "free", "placed"),  # nothing is there that could be drawn
    *("equation", "generalized", "kinetic", "potential"),  # of coordinates
    *("gear", "torsion_damper"),  # seen by its bodies
}


def shown_by(model: eomgen.Model, kind: str) -> list[str]:
    """The names of the parts of a model that are of a kind; of a joint its body's."""
    hung = {name: body.joint for name, body in model.bodies.items() if body.joint is not None}
    parts = {"Joints": hung, "Constraints": model.constraints, "Forces": model.forces}[kinds.kinds()[kind]]
    return [name for name, part in parts.items() if part.kind == kind]


@each("kind", EVERY)
def test_every_kind_has_an_example_that_is_proven(kind):
    """docs/examples/KIND.toml has it, and what is derived of it holds by its certificate."""
    path = kinds.EXAMPLES / f"{kind}.toml"
    assert path.exists(), f"'{kind}' has no example: write {path.relative_to(ROOT)}"
    model = eomgen.load(path)
    assert shown_by(model, kind), f"the example of '{kind}' does not use it"
    found = eomgen.derive(model) if model.coordinates else eomgen.statics(model)
    certificate = found.certify()
    assert certificate.ok is True and certificate.checks


@pytest.mark.parametrize("kind", EVERY)
def test_every_kind_has_a_picture(kind, tmp_path):
    """Of lengths above 0, with finite numbers, and with marks of the kind itself where it can be seen."""
    scene = kinds.example(kind).scene()
    rest_figure(kinds.example(kind)).save(tmp_path / "it.svg")
    assert (tmp_path / "it.svg").read_text("utf-8").count("<path") > 5
    frame = frame_at(scene, drawn_start(scene.system))
    assert np.isfinite(frame).all()
    assert kind in NOT_DRAWN or marks_of(kind, scene), f"no mark of it in the picture of '{kind}'"


def marks_of(kind: str, scene: Scene) -> list[Mark]:
    """The marks that show a joint, a tie or a force, and not the bodies at it."""
    if kind == "gravity":
        return [mark for mark in scene.marks if mark.form.kind == "field"]
    names, roles = shown_by(kinds.example(kind), kind), ("body", "inertia", "label", "point", "dimension", "axes")
    return [mark for mark in scene.marks if mark.of in names and mark.role not in roles]


def test_no_example_is_left_over():
    """Each file of docs/examples is one of a kind."""
    assert {path.stem for path in kinds.EXAMPLES.iterdir()} == set(EVERY)


@each("kind", EVERY)
def test_every_field_is_explained(kind):
    """By the docstrings of the class and its bases, and by its rule; the reference has a line on the kind."""
    cls = kinds.class_of(kind)
    known = kinds.meanings(cls)
    assert not [slot.key for slot in slots_of(cls) if not known.get(slot.name)]
    assert all(kinds.value_of(slot.rule) for slot in slots_of(cls))
    assert kinds.sayings(kind, kinds.kinds()[kind])[0] and kinds.prose(cls)


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
    said = kinds.counted(kind, kinds.example(kind).scene().system)
    assert said.startswith(f"It leaves {kinds.plural(free, 'freedom')},") and said.count("`") == 2 * held
    assert free + held == (3 if "plane" in said else 6)
