"""Scenes: what can be drawn, where mechanics has it."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import eomgen
from eomgen.scene import forms
from eomgen.scene.instant import drawn_start, frame_at
from eomgen.scene.scene import ROLES, Scene
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

MODELS = Path(__file__).parent.parent / "models"
ALL = [str(path.relative_to(MODELS))[:-5] for path in sorted((*MODELS.glob("*.toml"), *MODELS.glob("seeds/*.toml")))]
SOME = ("double_pendulum", "four_bar", "puma560", "whipple_bicycle")


class Reader:
    """A scene as a drawer reads it: from its JSON and the numbers of one frame."""

    def __init__(self, scene: Scene, shift: float = 0.0) -> None:
        state = drawn_start(scene.system)
        unit = {e for four in scene.system.scope.quaternions for e in four}
        free = [node not in unit for node in scene.system.symbols.q] + [False] * len(scene.system.symbols.u)
        x = state.x + shift * np.sin(1 + np.arange(len(state.x))) * free
        self.data: dict[str, Any] = json.loads(json.dumps(scene.to_json()))
        self.state = type(state)(0.3 * shift, x, state.p)
        self.frame = frame_at(scene, self.state)
        self.plane = self.data["space"] == "plane"

    def value(self, x: Any) -> float:
        return self.frame[x[0]] if isinstance(x, list) else x

    def spot(self, at: Any) -> np.ndarray:
        return np.array([self.value(x) for x in at], dtype=float)

    def pose(self, frame: int) -> tuple[np.ndarray, np.ndarray]:
        """(R, p) in the ground."""
        entry = self.data["frames"][frame]
        size = 2 if self.plane else 3
        if entry["pose"] is None:
            return np.eye(size), np.zeros(size)
        numbers = self.spot(entry["pose"])
        if self.plane:
            x, y, c, s = numbers
            R, p = np.array([[c, -s], [s, c]]), np.array([x, y])
        else:
            R, p = numbers[3:].reshape(3, 3), numbers[:3]
        if entry["parent"] >= 0:
            above, origin = self.pose(entry["parent"])
            return above @ R, origin + above @ p
        return R, p

    def in_ground(self, mark: dict[str, Any], field: str) -> np.ndarray:
        R, p = self.pose(mark["frame"])
        return p + R @ self.spot(mark[field])


def scene_named(name: str) -> Scene:
    return eomgen.load(MODELS / f"{name}.toml").scene()


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in SOME else pytest.mark.slow) for n in ALL])
def test_a_scene_shows_bodies_where_mechanics_has_them(name):
    """R^T R = 1, det R = 1; p + R r of a body's named points, by the data, is the position that mechanics has.

    And every mark is one that drawers know.
    """
    scene = scene_named(name)
    reader, system = Reader(scene, shift=0.2), scene.system
    symbols, motion = system.symbols, system.motion
    numbers = dict(zip((*symbols.q, *symbols.u), reader.state.x, strict=True)) | {symbols.t: reader.state.t}
    numbers |= dict(zip(symbols.parameters.values(), reader.state.p, strict=True))
    place = {each["name"]: reader.spot(each["at"]) for each in reader.data["points"]}
    assert all(each["parent"] < k for k, each in enumerate(reader.data["frames"]))
    for k, link in enumerate(motion.links, start=1):
        R, p = reader.pose(k)
        assert np.allclose(R.T @ R, np.eye(len(R))) and math.isclose(np.linalg.det(R), 1)
        for point, r in motion.points[link.name].items():
            own = np.array(evaluate(r, numbers, FLOAT))[: len(R)]
            if f"{link.name}.{point}" in place:
                assert np.allclose(p + R @ own, place[f"{link.name}.{point}"]), point
    refuse_what_drawers_do_not_know(reader, scene)


def refuse_what_drawers_do_not_know(reader: Reader, scene: Scene) -> None:
    """Kinds of `forms.ALL`, roles of `ROLES`, frames that are there, one slot a value, symbols that are given."""
    kinds = {form.kind: form for form in forms.ALL}
    assert len(kinds) == len(forms.ALL) and reader.data["slots"] == len(scene.values) == len(reader.frame)
    order = [ROLES.index(mark["role"]) for mark in reader.data["marks"]]
    assert order == sorted(order)
    for mark in reader.data["marks"]:
        assert mark["frame"] < len(reader.data["frames"])
        assert set(mark) == {"kind", "frame", "role", "of", *(f.name for f in fields(kinds[mark["kind"]]))}
        if mark["kind"] == "symbol":
            assert mark["symbol"] in reader.data["symbols"]


@pytest.mark.parametrize("name", ("double_pendulum", "four_bar", "slider_crank", "arm3", "chain20", "spatial_four_bar"))
def test_the_symbol_of_a_joint_is_where_both_bodies_have_it(name):
    """p_A + R_A (the joint's place in the parent) = p_B + R_B (its place in the child), wherever it is drawn."""
    scene = scene_named(name)
    reader, motion = Reader(scene), scene.system.motion
    joints = [m for m in reader.data["marks"] if m["kind"] == "symbol" and m["of"] in motion.index]
    assert joints
    symbols = scene.system.symbols
    numbers = dict(zip((*symbols.q, *symbols.u), reader.state.x, strict=True)) | {symbols.t: 0.0}
    numbers |= dict(zip(symbols.parameters.values(), reader.state.p, strict=True))
    for mark in joints:
        link = motion.link(mark["of"])
        R, p = reader.pose(motion.index[link.name] + 1)
        own = np.array(evaluate(link.point, numbers, FLOAT))[: len(R)]
        assert np.allclose(reader.in_ground(mark, "at"), p + R @ own)


def test_the_ends_of_a_double_pendulum_are_where_trigonometry_puts_them():
    """x_1 = l1 sin th1, y_1 = -l1 cos th1; the tip adds l2 (sin th2, -cos th2): by hand, lengths as parameters."""
    scene = scene_named("double_pendulum")
    reader, q = Reader(scene, shift=0.4), [node.name for node in scene.system.symbols.q]
    angles = dict(zip(q, reader.state.x, strict=False))
    lengths = dict(zip(scene.system.symbols.parameters, reader.state.p, strict=True))
    place = {each["name"]: reader.spot(each["at"]) for each in reader.data["points"]}
    model = scene.system.scope.model
    absolute = 0.0
    at = np.zeros(2)
    for body in ("arm1", "arm2"):
        joint = model.bodies[body].joint
        turn = joint.angle.evaluate({**angles, **lengths, "pi": math.pi})
        absolute = turn + (absolute if joint.on else 0.0)
        length = model.bodies[body].shape.length.evaluate(lengths)
        at = at + length * np.array([math.cos(absolute), math.sin(absolute)])
        assert np.allclose(place[f"{body}.end"], at)
    assert {"l1", "l2"} <= {str(name) for name in lengths}


def test_a_parameter_moves_lengths():
    """The slots of a frame are functions of the parameters: a longer arm ends elsewhere."""
    scene = scene_named("double_pendulum")
    state = drawn_start(scene.system)
    longer = type(state)(state.t, state.x, 2 * state.p)
    assert not np.allclose(frame_at(scene, state), frame_at(scene, longer))
