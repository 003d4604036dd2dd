"""System -> Scene: the drawable elements of a model at a state, as data; and the frame at one state.

All numbers of a picture are slots of one frame: scalars of (t, q, u, a, lam, parameters) that one `Program` computes.
Python runs it by numpy or C, a page by JavaScript; a drawer reads marks whose numbers are constants or slots.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.model import Form
from eomgen.scene.forms import symbols_used
from eomgen.study import StateInNumbers
from eomgen.symbolic.expression import Node, Pose, Scalar, Vector, symbols_of
from eomgen.symbolic.numeric import FLOAT, evaluate

FORMAT = 1


@dataclass(frozen=True)
class SceneFrame:
    """Axes in which marks stand.

    Args:
        name: the body's; "" of the ground.
        parent: the place of the frame in which the pose is given among the frames; -1: the ground.
    """

    name: str
    parent: int = -1
    pose: Pose = Pose()


@dataclass(frozen=True)
class Mark:
    """Something that is drawn.

    Args:
        frame: the place of its axes among the scene's frames, 0 the ground.
        role: its meaning, one of `ROLES`: drawers choose its colours by it.
        of: the body, constraint, joint or force that it belongs to, by name; or "".
    """

    form: Form
    frame: int = 0
    role: str = "body"
    of: str = ""


ROLES = (
    "ground",
    "track",
    "axes",
    "member",
    "spring",
    "damper",
    "cylinder",
    "body",
    "hole",
    "inertia",
    "rim",
    "string",
    "joint",
    "support",
    "contact",
    "point",
    "dimension",
    "center",
    "velocity",
    "force",
    "reaction",
    "label",
)
"""What a mark can be, in the order in which they are drawn: later ones lie on top."""


@dataclass(frozen=True, repr=False)
class Scene:
    """Drawable elements of a model at a state.

    Args:
        system: whose scalars its numbers are.
        frames: the ground, the bodies, the pieces of bodies.
        points: named points of the ground and of bodies, in the ground's axes; each can leave a trail.
        marks: in the order in which they are drawn.
        equations: of motion, where forces are drawn that depend on accelerations; else None.
    """

    system: System
    frames: tuple[SceneFrame, ...]
    points: tuple[tuple[str, Vector], ...]
    marks: tuple[Mark, ...]
    equations: EquationsOfMotion | None = None

    def __repr__(self) -> str:
        where = "in the plane" if self.plane else "in space"
        return f"<scene of {self.name!r} {where}: {len(self.frames) - 1} frames, {len(self.marks)} marks>"

    @property
    def name(self) -> str:
        return self.system.scope.model.name

    @property
    def plane(self) -> bool:
        return self.system.scope.model.space == "plane"

    @cached_property
    def values(self) -> tuple[Scalar, ...]:
        """The scalars of a frame, each once: slot i of `to_json` is the i-th."""
        return tuple(dict.fromkeys(x for x in self._scalars() if is_moving(x)))

    @cached_property
    def program(self) -> Program:
        """The values of a frame as a program of (t, x, p, inputs)."""
        if self.equations is not None:
            return Program.in_motion(self.values, self.equations)
        return Program.of(self.values, self.system.symbols, inputs=self.system.inputs)

    def to_json(self) -> dict[str, Any]:
        """The scene as data; the numbers of a frame are those of `values`.

        A value is a number, or [i]: slot i of the frame. A point is [x, y] in the plane, [x, y, z] in space [m].

            {"format": 1, "name", "space": "plane" | "space", "slots": how many,
             "frames": [{"name", "parent", "pose"}], "points": [{"name", "at"}],
             "marks": [...], "symbols": {...}}

        A pose is [x, y, cos, sin] in the plane, [x, y, z, r11, r12, r13, r21, ..., r33] in space (rows of R), in the
        axes of the frame `parent` (-1: the ground); null of the ground itself. A mark is {"kind", "frame", "role",
        "of"} and the fields of its form, as `forms.ALL` has them: those in its `spots` hold points, others values or
        text. "symbols" holds marks of the symbols that are used, without slots, in symbol units, x to the right and y
        up (in space z along the axis). A slot that is nan hides its mark.
        """
        return {
            "format": FORMAT,
            "name": self.name,
            "space": "plane" if self.plane else "space",
            "slots": len(self.values),
            "frames": [
                {"name": f.name, "parent": f.parent, "pose": self._pose(f.pose) if k else None}
                for k, f in enumerate(self.frames)
            ],
            "points": [{"name": name, "at": self._spot(at)} for name, at in self.points],
            "marks": [self._mark(mark) for mark in self.marks],
            "symbols": {
                name: [{"role": role, **self._fields(form)} for role, form in forms]
                for name, forms in symbols_used(self.marks_of_kind("symbol"), self.plane).items()
            },
        }

    def marks_of_kind(self, kind: str) -> tuple[Mark, ...]:
        """The marks of one kind."""
        return tuple(mark for mark in self.marks if mark.form.kind == kind)

    # -- scalars and slots ---------------------------------------------------------------------------

    def _scalars(self) -> Iterator[Scalar]:
        for frame in self.frames[1:]:
            yield from self.pose_entries(frame.pose)
        for _, at in self.points:
            yield from at
        for mark in self.marks:
            yield from scalars_of(mark.form)

    def pose_entries(self, pose: Pose) -> tuple[Scalar, ...]:
        """The numbers of a pose in the order of `to_json`."""
        R, p = pose.R, pose.p
        return (p[0], p[1], R[0][0], R[1][0]) if self.plane else (*p, *R[0], *R[1], *R[2])

    @cached_property
    def _slots(self) -> dict[Scalar, int]:
        return {x: k for k, x in enumerate(self.values)}

    def _value(self, x: Any) -> Any:
        if x is None or isinstance(x, (str, bool)):
            return x
        return [self._slots[x]] if is_moving(x) else plain_number(x)

    def _pose(self, pose: Pose) -> list[Any]:
        return [self._value(x) for x in self.pose_entries(pose)]

    def _spot(self, at: Any) -> Any:
        """A place, or several; None where there is none."""
        if at is None:
            return None
        if at and isinstance(at[0], tuple):
            return [self._spot(each) for each in at]
        return [self._value(x) for x in (at[:2] if self.plane else at)]

    def _mark(self, mark: Mark) -> dict[str, Any]:
        own = self._fields(mark.form)
        return {"kind": own.pop("kind"), "frame": mark.frame, "role": mark.role, "of": mark.of, **own}

    def _fields(self, form: Form) -> dict[str, Any]:
        found: dict[str, Any] = {"kind": form.kind}
        for slot in fields(form):
            value = getattr(form, slot.name)
            found[slot.name] = self._spot(value) if slot.name in form.spots else mapped(value, self._value)
        return found


def is_moving(x: Any) -> bool:
    """True if a scalar holds a symbol."""
    return type(x) is Node and bool(symbols_of((x,)))


def plain_number(x: Any) -> float | int:
    """A scalar without symbols, as a number."""
    number = float(evaluate((x,), {}, FLOAT)[0]) if type(x) is Node else float(x)
    return int(number) if number.is_integer() else number


def mapped(value: Any, change: Callable[[Any], Any]) -> Any:
    """Nested lists of the entries of tuples, each changed."""
    return [mapped(x, change) for x in value] if isinstance(value, tuple) else change(value)


def scalars_of(form: Form) -> Iterator[Scalar]:
    """Every number of a form."""
    waiting: list[Any] = [getattr(form, slot.name) for slot in reversed(fields(form))]
    while waiting:
        value = waiting.pop()
        if isinstance(value, tuple):
            waiting += reversed(value)
        elif value is not None and not isinstance(value, (str, bool)):
            yield value


# -------- instant ---------------------------------------------------------------------------------------------
# Scene -> numbers: the frame at one state.


def frame_at(scene: Scene, state: StateInNumbers) -> np.ndarray:
    """The numbers of the scene's frame at a state: slot i is that of `scene.values[i]`; nan where there is none."""
    found: np.ndarray = frames_along(scene, np.array([state.t]), state.x[None, :], state.p)[0]
    return found


def frames_along(scene: Scene, t: np.ndarray, x: np.ndarray, p: np.ndarray, target: str | None = "numpy") -> np.ndarray:
    """The same along a motion: n x slots.

    Args:
        t, x: n instants and their states.
        target: as of `Equations.rhs`.
    """
    if not scene.values:
        return np.zeros((len(t), 0))
    with np.errstate(all="ignore"):
        return RightHandSide.of(scene.program, target).many(t, x, p)
