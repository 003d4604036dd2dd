"""Derivations that are kept: told again where they are what they were, else derived anew."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from eomgen import disk_cache, verbs
from eomgen.cli import main
from eomgen.study import kept_derivations

MODEL = (Path(__file__).parents[2] / "models" / "simple_pendulum.toml").read_text(encoding="utf-8")


OTHER = MODEL.replace('acceleration = [0, "-g"]', 'acceleration = [0, "g"]')


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A cache folder of this test's own, in which derivations are kept."""
    monkeypatch.delenv("EOMGEN_FRESH", raising=False)
    monkeypatch.setattr(disk_cache.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def reported(tmp_path, capsys, monkeypatch):
    """(what `eomgen derive` of a text tells, whether it was derived for that)."""
    made, real = [], verbs.derive_document
    monkeypatch.setattr(verbs, "derive_document", lambda *of, **how: (made.append(of), real(*of, **how))[1])

    def run(text: str, *options: str) -> tuple[str, bool]:
        made.clear()
        path = tmp_path / "model.toml"
        path.write_text(text)
        with pytest.raises(SystemExit) as ended:
            main(["derive", str(path), *options])
        said = capsys.readouterr()
        return f"{ended.value.code}\n{said.out}\n{said.err}", bool(made)

    return run


def entries(place: Path) -> list[Path]:
    return sorted(place.glob("*.json")) if place.is_dir() else []


@pytest.mark.slow
def test_a_derivation_is_told_again_as_it_was(place, reported):
    """Byte by byte, what is said beside it too; each form and option by itself."""
    for options in ((), ("--json",), ("--method", "projection"), ("--units",), ("--set", "m=5")):
        first, derived = reported(MODEL, *options)
        assert derived and first.startswith("0\n")
        assert reported(MODEL, *options) == (first, False)
    assert len(entries(place)) == 5


@pytest.mark.slow
@pytest.mark.parametrize(
    "change", [("value = 9.81", "value = 9.82"), ("Simple", "Plain"), ("# The first system", "# A first system")]
)
def test_another_text_is_derived(place, reported, change):
    """A number, a name, a remark: whatever differs."""
    reported(MODEL)
    assert reported(MODEL.replace(*change))[1]
    assert not reported(MODEL)[1]


def test_nothing_is_kept_where_that_is_asked(place, reported, monkeypatch):
    """--fresh, EOMGEN_FRESH, --no-certify; neither written nor read."""
    assert reported(MODEL, "--fresh")[1] and reported(MODEL, "--no-certify")[1]
    with monkeypatch.context() as elsewhere:
        elsewhere.setenv("EOMGEN_FRESH", "1")
        assert reported(MODEL)[1]
    assert entries(place) == []
    first, _ = reported(MODEL)
    assert reported(MODEL, "--fresh") == (first, True)


def test_an_entry_that_was_turned_cut_or_opened_is_not_believed(place, reported):
    """One bit at each of many places; each length; what others may write. The derivation is made anew, and is right."""
    first, _ = reported(MODEL)
    (path,) = entries(place)
    whole = path.read_bytes()
    turned = [whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :] for at in range(0, len(whole), len(whole) // 40)]
    cut = [whole[:size] for size in (0, 1, len(whole) // 2, len(whole) - 1)]
    for content in (*turned, *cut, whole + b" "):
        path.write_bytes(content)
        assert disk_cache.content_of(path) is None
    for content in (turned[20], cut[2]):
        path.write_bytes(content)
        assert reported(MODEL) == (first, True)
        assert path.read_bytes() == whole
    path.chmod(0o777)
    assert reported(MODEL) == (first, True)


def put_alone(place: Path, name: str, entry: object) -> None:
    """An entry in the place of all of this name, its digest as it must be."""
    for path in place.glob(f"{name}-*.json"):
        path.unlink()
    made = place / "made.json"
    made.write_text(json.dumps(entry))
    assert disk_cache.content_of(disk_cache.put_whole(made, place, name)) is not None


@pytest.mark.slow
def test_an_entry_of_another_model_is_not_believed(place, reported):
    """Whole, of this user, under this model's name and key: its equations of motion have other values."""
    first, _ = reported(MODEL)
    (path,) = entries(place)
    own = json.loads(path.read_bytes())
    reported(OTHER)
    (other,) = (json.loads(x.read_bytes()) for x in entries(place) if x != path)
    name = path.name[:32]
    for entry in (other, {**other, "key": own["key"]}, {**own, "values": []}, {"key": own["key"]}, [own]):
        put_alone(place, name, entry)
        assert reported(MODEL) == (first, True)
    put_alone(place, name, own)
    assert reported(MODEL) == (first, False)


def test_an_error_in_the_laws_is_not_hidden_by_what_was_kept(place, reported, monkeypatch):
    """With gravity upside down in the laws of today, what was derived before is not told: it is derived, with them."""
    first, _ = reported(MODEL)
    real = kept_derivations.equations_of_motion
    monkeypatch.setattr(kept_derivations, "equations_of_motion", lambda of: replace(real(of), V=-real(of).V))
    assert reported(MODEL) == (first, True)
