"""Each body that is cut free is in equilibrium with its inertia forces, and a list of forces is judged by that."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from slow_run import sampled, usual_models

import eomgen
from eomgen.cli import main
from eomgen.judge import judged_forces
from eomgen.results import FreeBodies

pytestmark = pytest.mark.slow  # the law over models: 0.2 s each

MODELS = Path(__file__).parent.parent / "models"
PATHS = sorted([*MODELS.glob("*.toml"), *MODELS.glob("seeds/*.toml")])
AT_NO_PLACE = ("balancing_robot", "foucault_pendulum", "delta_robot")  # whose reactions are refused


def vector(force: eomgen.FreeBodies) -> np.ndarray:
    """Value times direction, 3."""
    return force.value * np.array([*force.direction, 0.0][:3])


def three(at: tuple[float, ...]) -> np.ndarray:
    return np.array([*at, 0.0][:3])


def entries(free: FreeBodies) -> list[dict]:
    """The forces of a model as a student lists them who forgets nothing."""
    return [
        {
            "body": name,
            "name": f.name,
            "kind": f.kind,
            "at": list(f.at),
            "direction": list(f.direction),
            "unit": f.unit,
        }
        for name, body in free.bodies.items()
        for f in body.forces
    ]


@sampled(4)
@pytest.mark.parametrize("path", usual_models(PATHS), ids=lambda path: path.stem)
def test_forces_and_moments_on_each_free_body_vanish_with_its_inertia(path):
    """sum F = 0, sum (r - c) x F + M = 0, by the numbers that are given alone; so does the certificate say."""
    if path.stem in AT_NO_PLACE:
        with pytest.raises(eomgen.DerivationError):
            eomgen.free_bodies(path)
        return
    free = eomgen.free_bodies(path)
    known = [f for b in free.bodies.values() for f in b.forces if f.value is not None]
    size = max((abs(f.value) for f in known), default=0.0)
    for body in free.bodies.values():
        assert all(np.linalg.norm(f.direction) == pytest.approx(1) for f in body.forces)
        if any(f.value is None for f in body.forces):
            continue
        center = three(body.forces[0].at)
        force = sum((vector(f) for f in body.forces if not f.turns), start=np.zeros(3))
        moment = sum((vector(f) for f in body.forces if f.turns), start=np.zeros(3))
        moment = moment + sum(np.cross(three(f.at) - center, vector(f)) for f in body.forces if not f.turns)
        arm = max(float(np.linalg.norm(three(f.at) - center)) for f in body.forces)
        assert np.abs(force).max() <= 1e-9 * size + 1e-12, body.name
        assert np.abs(moment).max() <= 1e-9 * size * (1 + arm) + 1e-12, body.name


@pytest.mark.parametrize("name", ["double_pendulum", "slider_crank", "arm3", "tower_crane", "seeds/ch22_p1"])
def test_a_joint_pushes_both_bodies_oppositely_under_one_name(name):
    """On body and parent the same value, direction and its opposite, at one place; as `eomgen reactions` has it."""
    model = eomgen.load(MODELS / f"{name}.toml")
    free, values = model.free_bodies(), eomgen.derive(model).study.reactions_at_start
    seen: dict[str, list] = {}
    for body in free.bodies.values():
        for f in body.forces:
            if f.kind == "reaction":
                seen.setdefault(f.name, []).append(f)
    twice = [two for two in seen.values() if len(two) == 2]
    assert twice
    for one, other in twice:
        assert one.value == pytest.approx(other.value)
        assert np.array(one.direction) == pytest.approx(-np.array(other.direction))
        assert one.at == pytest.approx(other.at)
    for key, (one, *_) in seen.items():
        assert one.value == pytest.approx(values[key], abs=1e-9), key


def test_an_instant_and_rest_are_taken_as_elsewhere():
    """A pendulum let go at theta_0 = 1: at rest its rod carries m g, at the lowest point m g (3 - 2 cos(theta_0))."""
    model = eomgen.load(MODELS / "simple_pendulum.toml")
    for at, force in (("equilibrium", 9.81), ("theta = 0", 9.81 * (3 - 2 * np.cos(1.0)))):
        bob = {f.name: f for f in model.free_bodies(at).bodies["bob"].forces}
        assert bob["reaction_y(bob)"].value == pytest.approx(force)
        assert bob["weight"].direction == (0.0, -1.0)
        assert ("inertia(bob)" in bob) == (at != "equilibrium")


def test_directions_are_known_without_values():
    """Letters alone: places and directions for lengths of 1, no value, and nothing that the proof contradicts."""
    text = (MODELS / "simple_pendulum.toml").read_text()
    bare = eomgen.loads(text.replace('m = { value = 1.0, unit = "kg" }', 'm = { unit = "kg" }'))
    free = bare.free_bodies()
    forces = [f for body in free.bodies.values() for f in body.forces]
    assert free.as_dict()["assumed"] == ["m"]
    assert all(f.value is None and np.linalg.norm(f.direction) == pytest.approx(1) for f in forces)
    assert free.certify().ok


@pytest.mark.parametrize("name", ["double_pendulum", "beam_with_overhang", "slider_crank", "a_frame"])
def test_the_certificate_of_free_bodies_holds(name):
    assert eomgen.load(MODELS / f"{name}.toml").free_bodies().certify().ok


def test_the_picture_shows_each_body_with_the_letters_of_the_formulas():
    free = eomgen.load(MODELS / "beam_with_overhang.toml").free_bodies()
    assert {f.letter for f in free.bodies["beam"].forces} >= {"A_{x}", "A_{y}", "F"}
    assert free.picture.svg.lstrip().startswith("<?xml") and "<svg" in free._repr_svg_()


# -- lists that somebody hands in --------------------------------------------------------------------


@sampled(4)
@pytest.mark.parametrize("path", usual_models(PATHS, 1), ids=lambda path: path.stem)
def test_a_list_that_forgets_nothing_is_right(path):
    if path.stem not in AT_NO_PLACE:
        free = eomgen.free_bodies(path)
        found = judged_forces(free, entries(free))
        assert found.verdict == "right", found.lines


@pytest.fixture(scope="module")
def pendulum() -> FreeBodies:
    return eomgen.load(MODELS / "double_pendulum.toml").free_bodies()


def fault(free: FreeBodies, listed: list[dict]) -> dict[str, int]:
    return {key: count for key, count in judged_forces(free, listed).entries["counts"].items() if count}


def test_a_missing_force_one_too_many_and_a_wrong_direction_are_named(pendulum):
    listed = entries(pendulum)
    weight = next(k for k, e in enumerate(listed) if e["kind"] == "weight")
    assert fault(pendulum, [e for k, e in enumerate(listed) if k != weight]) == {"missing": 1}
    assert fault(pendulum, [*listed, {**listed[weight], "name": "again"}]) == {"extra": 1}
    up = [{**e, "direction": [0, 1]} if k == weight else e for k, e in enumerate(listed)]
    assert fault(pendulum, up) == {"wrong_direction": 1}
    away = [{**e, "at": [5.0, 0.0]} if k == weight else e for k, e in enumerate(listed)]
    assert fault(pendulum, away) == {"wrong_place": 1}
    kind = [{**e, "kind": "applied"} if k == weight else e for k, e in enumerate(listed)]
    assert fault(pendulum, kind) == {"wrong_kind": 1}


def test_a_reaction_may_be_entered_in_either_sense_but_oppositely_on_both_bodies(pendulum):
    """What a letter defines: the pair turned round is right, one of it alone is wrong."""
    listed = entries(pendulum)
    both = [k for k, e in enumerate(listed) if e["name"] == "reaction_x(arm2)"]

    def turned(some):
        return [{**e, "direction": [-x for x in e["direction"]]} if k in some else e for k, e in enumerate(listed)]

    assert fault(pendulum, turned(both)) == {}
    assert fault(pendulum, turned(both[:1])) == {"wrong_direction": 1}


def test_components_along_other_directions_stand_for_the_same_reaction(pendulum):
    """x and y, or along the bar and across it: two directions carry what two do, one does not."""
    listed = [e for e in entries(pendulum) if e["kind"] != "inertia"]
    c, s = np.cos(0.4), np.sin(0.4)
    ways = {"reaction_x(arm1)": [c, s], "reaction_y(arm1)": [-s, c]}
    assert fault(pendulum, [{**e, "direction": ways.get(e["name"], e["direction"])} for e in listed]) == {}
    alone = [e for e in listed if e["name"] != "reaction_y(arm1)"]
    assert fault(pendulum, alone) == {"missing": 1}


def test_a_string_pulls_and_what_is_zero_may_be_left_out():
    free = eomgen.load(MODELS / "atwood.toml").free_bodies()
    listed = entries(free)
    rope = next(k for k, e in enumerate(listed) if e["body"] == "left" and "tension" in e["name"])
    pushed = [{**e, "direction": [-x for x in e["direction"]]} if k == rope else e for k, e in enumerate(listed)]
    assert fault(free, pushed) == {"wrong_direction": 1}
    zero = {f.name for b in free.bodies.values() for f in b.forces if f.value == 0}
    assert zero and fault(free, [e for e in listed if e["name"] not in zero]) == {}


def test_verify_judges_a_list_of_forces(tmp_path):
    """Exit 0 of a right list, 5 of a wrong one, 2 of one that cannot be read; JSON for graders."""
    path, sheet = MODELS / "beam_with_overhang.toml", tmp_path / "forces.json"
    listed = [
        {"body": "beam", "at": "A", "direction": "right", "kind": "support", "name": "A_x"},
        {"body": "beam", "at": "A", "direction": "up", "kind": "support", "name": "A_y"},
        {"body": "beam", "at": "B", "direction": [0, 1], "kind": "support", "name": "B"},
        {"body": "beam", "at": [4, 0], "direction": "down", "kind": "load", "name": "Q"},
        {"body": "beam", "at": "D", "direction": "down", "kind": "load", "name": "F"},
        {"body": "beam", "at": "D", "direction": "ccw", "kind": "load", "name": "M"},
    ]

    def judged(forces):
        sheet.write_text(json.dumps(forces))
        run = CliRunner().invoke(main, ["verify", str(path), "--free-bodies", str(sheet), "--json"])
        return run.exit_code, json.loads(run.output) if run.exit_code != 2 else {}

    code, found = judged(listed)
    assert (code, found["free_bodies"]["counts"]["wrong_direction"]) == (5, 1)  # the couple turns the other way
    listed[-1]["direction"] = "cw"
    code, found = judged(listed)
    assert (code, found["free_bodies"]["verdict"], found["equations"]) == (0, "right", [])
    assert judged([{"body": "beem", "direction": "up"}])[0] == 2


def test_a_report_shows_free_bodies_where_they_are_asked_for(tmp_path):
    path = MODELS / "beam_with_overhang.toml"
    plain = eomgen.report(path, certify=False, without=["downloads"])
    asked = eomgen.report(path, certify=False, with_=["free_bodies"], without=["downloads"])
    keys = [section.key for section in asked.sections]
    assert "free_bodies" in keys and "free_bodies" not in [section.key for section in plain.sections]
    (section,) = (each for each in asked.sections if each.key == "free_bodies")
    assert section.drawings and section.steps
