"""Model -> JSON Schema: what the reader accepts the schema accepts, and mistakes of form it refuses."""

import tomllib
from pathlib import Path

import pytest
from each import each

from eomgen.model import Model

jsonschema = pytest.importorskip("jsonschema")

MODELS = sorted((Path(__file__).parents[1] / "models").rglob("*.toml"))
VALIDATOR = jsonschema.Draft202012Validator(Model.schema())
BODY = {"eomgen": 1, "space": "plane", "bodies": {"b": {"shape": {"kind": "rod", "mass": 1, "length": "l"}}}}


def test_the_schema_is_one():
    """It obeys the metaschema of draft 2020-12."""
    jsonschema.Draft202012Validator.check_schema(Model.schema())


@pytest.mark.slow
@each("path", MODELS)
def test_every_model_of_the_gallery_obeys_the_schema(path):
    errors = list(VALIDATOR.iter_errors(tomllib.loads(path.read_text())))
    assert errors == []


@each(
    "change",
    [
        {"eomgen": 2},
        {"space": "line"},
        {"bodys": {}},
        {"bodies": {"b": {"shape": {"kind": "rodd"}}}},
        {"bodies": {"b": {"shape": {"kind": "rod", "mass": 1}}}},
        {"bodies": {"b": {"mass": [1]}}},
        {"constraints": {"c": {"kind": "pin", "points": []}}},
        {"coordinates": {"q": {"strat": 1}}},
        {"bodies": {"b": {"mass": 1, "parts": [{"kind": "disc", "radius": 1, "hole": "no"}]}}},
    ],
)
def test_a_mistake_of_form_is_refused(change):
    """Unknown keys and kinds, missing keys, values of the wrong kind."""
    assert VALIDATOR.is_valid(BODY)
    assert not VALIDATOR.is_valid(BODY | change)


@each(
    "change",
    [
        {"parameters": {"m": 1.5, "k": {}, "l": {"value": 40, "unit": "cm", "about": "of the rod", "positive": True}}},
        {"outputs": {"v": {"value": "speed(b.end)", "at": "t = 2", "from": "rest", "unit": "cm/s"}, "w": "1"}},
        {"bodies": {"b": {"mass": 1, "parts": [{"kind": "disc", "radius": 1, "at": [0, 0], "hole": True}]}}},
        {"forces": {"s": {"kind": "spring", "points": ["b.end", "O"], "stiffness": 3, "length": "start"}}},
    ],
)
def test_what_the_model_file_allows_is_accepted(change):
    assert VALIDATOR.is_valid(BODY | change)
