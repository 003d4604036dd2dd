"""Forces that somebody lists on bodies cut free -> which are right, missing, too many, or point the wrong way.

A weight, a load, a pull of a string, a push of a support and sliding friction have the sense that they have. What a
letter defines, the reaction of a joint or of a two-sided support, a spring, a damper, a drive, may be entered in either
sense: but what has one name on two bodies must be opposite on them. The components of a reaction may lie along any
directions that together carry the same: along the bar and across it, for x and y. A force may stand anywhere on its
line of action. What is 0 then, and inertia forces, may be left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import four_figures
from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.judge.verdict import EXIT_CODES, RIGHT, WRONG
from eomgen.model import nearest
from eomgen.results import BodyForce, FreeBodies
from eomgen.scene import named_points
from eomgen.symbolic.numeric import tolerances

MISSING, EXTRA, WRONG_DIRECTION, WRONG_PLACE, WRONG_KIND = (
    "missing",
    "extra",
    "wrong_direction",
    "wrong_place",
    "wrong_kind",
)
KINDS: Mapping[str, str] = {
    **{kind: kind for kind in ("weight", "spring", "damper", "drive", "applied", "reaction", "inertia")},
    **dict.fromkeys(("gravity", "field"), "weight"),
    **dict.fromkeys(("load", "external", "force", "couple", "moment"), "applied"),
    **dict.fromkeys(("joint", "support", "contact", "normal", "friction", "tension", "rope", "string"), "reaction"),
    **dict.fromkeys(("motor", "torque"), "drive"),
}
"""Kinds as people call them."""
WAYS: Mapping[str, tuple[float, float, float]] = {
    "right": (1.0, 0.0, 0.0),
    "left": (-1.0, 0.0, 0.0),
    "up": (0.0, 1.0, 0.0),
    "down": (0.0, -1.0, 0.0),
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
}
TURNS: Mapping[str, float] = {
    **dict.fromkeys(("ccw", "counter-clockwise", "counterclockwise"), 1.0),
    **dict.fromkeys(("cw", "clockwise"), -1.0),
}


@dataclass(frozen=True)
class ListedForce:
    """A force or couple as somebody lists it.

    Args:
        at: its place, ground axes, 3 [m]; None where it is not said.
        direction: unit vector, 3.
        kind: one of the values of KINDS; "" where it is not said.
        given: the entry as it was read.
    """

    body: str
    name: str
    kind: str
    at: np.ndarray | None
    direction: np.ndarray
    turns: bool
    given: Mapping[str, Any]


@dataclass(frozen=True)
class ForceVerdict:
    """Verdict on one force.

    Args:
        verdict: right, missing, extra, wrong_direction, wrong_place or wrong_kind.
        force: the force of the model that it is, or should be; None of one too many.
        listed: the entry; None of a missing one.
        text: the sentence.
    """

    verdict: str
    body: str
    force: BodyForce | None
    listed: ListedForce | None
    text: str

    @property
    def entry(self) -> dict[str, Any]:
        """Entry for machines."""
        found: dict[str, Any] = {"body": self.body, "verdict": self.verdict, "text": self.text}
        found["given"] = None if self.listed is None else dict(self.listed.given)
        own = self.force
        found["force"] = own and {
            "name": own.name,
            "kind": own.kind,
            "at": list(own.at),
            "direction": list(own.direction),
            "unit": own.unit,
        }
        return found


@dataclass(frozen=True)
class FreeBodyVerdict:
    """Verdict on a list of forces.

    Args:
        found: on each force that is listed, then on each that is missing.
    """

    found: tuple[ForceVerdict, ...]

    @property
    def verdict(self) -> str:
        return RIGHT if all(each.verdict == RIGHT for each in self.found) else WRONG

    @property
    def exit_code(self) -> int:
        return EXIT_CODES[self.verdict]

    @property
    def entries(self) -> dict[str, Any]:
        """Entries for machines: the verdict, each listed force, each missing one, the count of each fault."""
        listed = [each.entry for each in self.found if each.listed is not None]
        missing = [each.entry for each in self.found if each.listed is None]
        faults = (MISSING, EXTRA, WRONG_DIRECTION, WRONG_PLACE, WRONG_KIND)
        counts = {fault: sum(each.verdict == fault for each in self.found) for fault in faults}
        return {"verdict": self.verdict, "forces": listed, "missing": missing, "counts": counts}

    @property
    def lines(self) -> tuple[str, ...]:
        """The verdict in words."""
        wrong = [each.text for each in self.found if each.verdict != RIGHT]
        right = sum(each.verdict == RIGHT for each in self.found)
        return (f"free bodies: {self.verdict}, {right} of {right + len(wrong)} forces", *(f"  {x}" for x in wrong))


def judged_forces(free: FreeBodies, listed: Sequence[Any]) -> FreeBodyVerdict:
    """The verdict on a list of `{body, at, direction, kind, name}`.

    Raises:
        UsageError: an entry that cannot be read.
    """
    reader = _Reader(free)
    forces = [reader.read(k, entry) for k, entry in enumerate(listed, start=1)]
    found: list[ForceVerdict] = []
    for name in free.bodies:
        found += _Sheet(free, name, [force for force in forces if force.body == name]).verdicts
    return FreeBodyVerdict(tuple(_with_opposites(found)))


# -- reading ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Reader:
    free: FreeBodies

    def read(self, number: int, entry: Any) -> ListedForce:
        """One entry.

        Raises:
            UsageError: something in it is wrong; it is named.
        """
        if not isinstance(entry, Mapping) or "body" not in entry or "direction" not in entry:
            raise UsageError(f"force {number} needs a body and a direction", fix=f'write {{"body": ..., {FORM}}}')
        body = str(entry["body"])
        if body not in self.free.bodies:
            raise UsageError(f"force {number}: there is no body '{body}'", fix=nearest_of(body, self.free.bodies))
        kind = str(entry.get("kind") or "").strip().lower()
        if kind and kind not in KINDS:
            raise UsageError(
                f"force {number}: no kind '{kind}'", fix=f"kinds are {', '.join(dict.fromkeys(KINDS.values()))}"
            )
        direction, turns = self._direction(number, entry)
        at = self._place(number, body, entry.get("at"))
        return ListedForce(body, str(entry.get("name") or ""), KINDS.get(kind, ""), at, direction, turns, entry)

    def _direction(self, number: int, entry: Mapping[str, Any]) -> tuple[np.ndarray, bool]:
        way, flat = entry["direction"], self.free.state.system.scope.model.space == "plane"
        turns = str(entry.get("kind") or "").lower() in ("couple", "moment", "torque") or str(
            entry.get("unit") or ""
        ).replace(" ", "") in ("N*m", "Nm", "N·m")
        if isinstance(way, str):
            word = way.strip().lower()
            if word in TURNS:
                return np.array([0.0, 0.0, TURNS[word]]), True
            if word in WAYS:
                return np.array(WAYS[word]), turns
            way = _degrees(word)
        numbers = [float(x) for x in way] if _are_numbers(way) else []
        vector = np.array([*numbers, 0.0, 0.0, 0.0][:3])
        size = float(np.linalg.norm(vector))
        if len(numbers) not in (2, 3) or not math.isfinite(size) or size == 0:
            raise UsageError(f"force {number}: no direction {entry['direction']!r}", fix=DIRECTIONS)
        along_z = flat and len(numbers) == 3 and not np.any(vector[:2])
        return vector / size, turns or along_z

    def _place(self, number: int, body: str, at: Any) -> np.ndarray | None:
        if at is None:
            return None
        if isinstance(at, str):
            for name in (at, f"{body}.{at}"):
                if name in self.points:
                    return self.points[name]
            raise UsageError(f"force {number}: there is no point '{at}'", fix=nearest_of(at, self.points))
        if not _are_numbers(at) or len(at) not in (2, 3):
            raise UsageError(f"force {number}: no place {at!r}", fix='a point of the body, "end", or [x, y] in metres')
        return np.array([*map(float, at), 0.0][:3])

    @cached_property
    def points(self) -> dict[str, np.ndarray]:
        """Every named point, and each mass centre."""
        state = self.free.state
        motion = state.system.motion
        found = dict(named_points(state.system))
        for link in motion.links:
            found.setdefault(f"{link.name}.center", link.pose.point(state.system.scope.mass_properties(link.name).com))
        numbers = iter(state.numbers([x for at in found.values() for x in at]))
        return {name: np.array([next(numbers) for _ in range(3)]) for name in found}


FORM = '"at": "end", "direction": [0, 1], "kind": "reaction", "name": "A_y"'
DIRECTIONS = 'two or three numbers, or "up", "down", "left", "right", "30 deg"; of a couple "ccw" or "cw"'


def nearest_of(name: str, known: Mapping[str, Any]) -> str:
    """The name that was probably meant, or all that there are."""
    near = nearest(name, list(known))
    return f"did you mean '{near}'?" if near else f"there are {', '.join(known)}"


def _degrees(word: str) -> Any:
    number = word.removesuffix("deg").removesuffix("°").strip()
    try:
        angle = math.radians(float(number))
    except ValueError:
        return None
    return [math.cos(angle), math.sin(angle)] if number != word else None


def _are_numbers(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and all(
        isinstance(x, (int, float)) and not isinstance(x, bool) for x in value
    )


# -- one body --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Group:
    """Forces of one origin at one place: a joint's, a constraint's, or a load by itself."""

    forces: tuple[BodyForce, ...]
    taken: list[tuple[ListedForce, np.ndarray]] = field(default_factory=list)

    @property
    def kind(self) -> str:
        return self.forces[0].kind

    @property
    def turns(self) -> bool:
        return self.forces[0].turns

    @property
    def span(self) -> np.ndarray:
        """Directions that it carries, n x 3."""
        return np.array([_three(force.direction) for force in self.forces])

    def holds(self, direction: np.ndarray) -> bool:
        """True if a direction is one of those that it carries."""
        left = direction - self.span.T @ np.linalg.lstsq(self.span.T, direction, rcond=None)[0]
        return float(np.linalg.norm(left)) < tolerances.WRITTEN_BY_HAND

    def points(self, listed: ListedForce) -> bool:
        """True if the sense is right too: of what has one alone, or as the letter of formulas has it."""
        if len(self.forces) > 1 or not self.forces[0].has_sense or self.forces[0].value == 0:
            return True
        own = self.forces[0]
        sense = -1.0 if own.value is not None and own.value < 0 else 1.0
        along = float(listed.direction @ _three(own.direction))
        return along * sense > 0 or (along > 0 and listed.name == own.name)

    def adds(self, direction: np.ndarray) -> bool:
        """True if the direction is linearly independent of those of the forces that were matched before."""
        before = np.array([way for _, way in self.taken]).reshape(-1, 3)
        return _rank(np.vstack([before, direction])) > _rank(before)

    def is_on_line(self, listed: ListedForce, near: float) -> bool:
        """True if a force stands on its line of action; a couple may stand anywhere."""
        if listed.at is None or self.turns:
            return True
        for own in self.forces:
            away = listed.at - _three(own.at)
            along = away @ listed.direction * listed.direction
            if float(np.linalg.norm(away)) < near or (
                len(self.forces) == 1 and float(np.linalg.norm(away - along)) < near
            ):
                return True
        return False

    @property
    def missing(self) -> list[BodyForce]:
        """The forces that nothing listed stands for; those that are 0 may be left out."""
        ways = [way for _, way in self.taken]
        found = []
        for own in sorted(self.forces, key=lambda force: force.value == 0):
            way = _three(own.direction)
            if _rank(np.array([*ways, way])) > _rank(np.array(ways).reshape(-1, 3)):
                ways.append(way)
                if own.value != 0 and own.kind != "inertia":
                    found.append(own)
        return found


@dataclass(frozen=True)
class _Sheet:
    """The forces that are listed on one body, beside those that it has."""

    free: FreeBodies
    body: str
    listed: Sequence[ListedForce]

    @cached_property
    def groups(self) -> list[_Group]:
        found: dict[tuple[Any, ...], list[BodyForce]] = {}
        for k, force in enumerate(self.free.bodies[self.body].forces):
            joined = force.kind == "reaction" and not force.has_sense
            owner = force.name.partition("(")[2].rstrip(")") if joined else k
            found.setdefault((force.kind, owner, force.turns, force.at if joined else ()), []).append(force)
        return [_Group(tuple(forces)) for forces in found.values()]

    @property
    def near(self) -> float:
        """Distance by which a place may be off [m]."""
        places = [_three(force.at) for body in self.free.bodies.values() for force in body.forces]
        size = float(np.ptp(np.array(places), axis=0).max()) if places else 0.0
        return tolerances.WRITTEN_BY_HAND * (size or 1.0)

    @property
    def verdicts(self) -> Iterator[ForceVerdict]:
        """Verdict on each that is listed, then on each that is missing."""
        judged = [self._judged(each) for each in self.listed]
        yield from judged
        for group in self.groups:
            for force in group.missing:
                yield ForceVerdict(MISSING, self.body, force, None, f"{self.body}: missing {_said(force)}")

    def _judged(self, listed: ListedForce) -> ForceVerdict:
        """Verdict on one force: of the fit that lacks least."""
        ways = (self._fit(listed, group) for group in self.groups if group.turns == listed.turns)
        fits = sorted((fit for fit in ways if fit is not None), key=lambda fit: fit[0])
        if not fits:
            return ForceVerdict(EXTRA, self.body, None, listed, f"{self.body}: {_called(listed)} does not act on it")
        lacks, group, force = fits[0]
        group.taken.append((listed, listed.direction if lacks != 3 else _three(force.direction)))
        verdict, words = (
            (RIGHT, ""),
            (WRONG_KIND, f"is of the kind {group.kind}"),
            (WRONG_PLACE, f"acts at {_place(force)}"),
            (WRONG_DIRECTION, f"acts {_way(force)}"),
        )[lacks]
        return ForceVerdict(verdict, self.body, force, listed, f"{self.body}: {_called(listed)} {words}".rstrip())

    def _fit(self, listed: ListedForce, group: _Group) -> tuple[int, _Group, BodyForce] | None:
        """(0 right, 1 other kind, 2 other place, 3 other direction; the group; its force), or None."""
        alike = listed.kind in ("", group.kind) or {listed.kind, group.kind} <= {"reaction", "drive"}
        there = group.is_on_line(listed, self.near)
        along = group.holds(listed.direction) and group.points(listed)
        own = max(group.forces, key=lambda force: abs(float(_three(force.direction) @ listed.direction)))
        named = listed.name != "" and listed.name in (own.name, *(force.name for force in group.forces))
        if not group.adds(listed.direction if along else _three(own.direction)):
            return None
        if alike and there and along:
            return 0, group, own
        if there and along and listed.at is not None and not group.taken:
            return 1, group, own
        if alike and along and (group.kind != "reaction" or named):
            return 2, group, own
        at_it = listed.at is not None and there
        if alike and (at_it or named or group.kind == "weight"):
            return 3, group, own
        return None


def _with_opposites(found: Sequence[ForceVerdict]) -> Iterator[ForceVerdict]:
    """The verdicts; wrong is what does not push oppositely to what the same name pushes on a body before."""
    before: dict[str, ForceVerdict] = {}
    for each in found:
        own, listed = each.force, each.listed
        if each.verdict == RIGHT and own is not None and listed is not None and listed.name and not own.has_sense:
            first = before.setdefault(listed.name, each)
            if first.body != each.body and _is_same_way(first, each):
                text = f"{each.body}: {listed.name} acts oppositely to {listed.name} on {first.body}"
                each = replace(each, verdict=WRONG_DIRECTION, text=text)
        yield each


def _is_same_way(first: ForceVerdict, second: ForceVerdict) -> bool:
    """True if two entries point alike, and the forces that they are oppositely."""
    assert first.listed is not None and second.listed is not None and first.force is not None
    assert second.force is not None
    drawn = float(first.listed.direction @ second.listed.direction)
    due = float(_three(first.force.direction) @ _three(second.force.direction))
    return drawn > 1 - tolerances.WRITTEN_BY_HAND and due < 0


def _rank(ways: np.ndarray) -> int:
    return int(np.linalg.matrix_rank(ways, tol=tolerances.WRITTEN_BY_HAND)) if ways.size else 0


def _three(numbers: Sequence[float]) -> np.ndarray:
    return np.array([*numbers, 0.0][:3], dtype=float)


# -- in words --------------------------------------------------------------------------------------


def _called(listed: ListedForce) -> str:
    return listed.name or f"the {listed.kind or 'force'} {listed.given['direction']}"


def _said(force: BodyForce) -> str:
    return f"{force.name} ({force.kind}) at {_place(force)}, {_way(force)}"


def _place(force: BodyForce) -> str:
    return f"({', '.join(map(four_figures, force.at))})"


def _way(force: BodyForce) -> str:
    if force.turns and len(force.at) == 2:
        return "counter-clockwise" if force.direction[-1] > 0 else "clockwise"
    return f"along ({', '.join(map(four_figures, force.direction))})"
