"""Structures at rest, without coordinates: beams, frames, trusses, in the plane and in space; drawn, and the balance.

The oracle's part: every body is free but for its constraints, a truss is its nodes and links between them:

    J^T lam + F = 0

by least squares; a reaction has a value where nothing may be added to it. N, V and M of a straight member are what
holds the part before a cut. The oracle's part imports nothing of eomgen.
"""

from __future__ import annotations

import json
import tomllib
from random import Random
from typing import Any

import formulas
import laws
import numpy as np
from drawn import toml
from oracle import NoAnswer, Oracle, Row, State, least_squares

LOADS = ("force", "couple", "distributed", "gravity")


# drawn


def structure(kind: str, rng: Random) -> str:
    """The text of a structure of a kind, with its numbers and loads by chance."""
    model: dict[str, Any] = {"eomgen": 1, "name": kind, "space": "space" if kind.endswith("in_space") else "plane"}
    bodies: dict[str, Any] = {}
    drawing: dict[str, Any] = {"parameters": {"P": 5.0, "w": 1.5}, "trusses": {}, "bodies": bodies, "constraints": {}}
    KINDS[kind](drawing, rng)
    forces: dict[str, Any] = {}
    flat = model["space"] == "plane"
    for name, body in bodies.items():
        for k in range(2):
            how = rng.choice(LOADS)
            forces[f"{name}_{k}"] = _load(name, body, how, rng, flat)
    for name, truss in drawing["trusses"].items():
        for node in rng.sample(sorted(truss["nodes"]), 2):
            forces[f"{name}_{node}"] = {"kind": "force", "point": f"{name}.{node}", "force": _vector(rng, flat)}
    return toml({**model, **drawing, "forces": forces})


def _vector(rng: Random, flat: bool) -> list:
    return [f"{round(rng.uniform(-1, 1), 2)}*P" for _ in range(2 if flat else 3)]


def _load(name: str, body: dict, how: str, rng: Random, flat: bool) -> dict[str, Any]:
    points = sorted(body["points"])
    if how == "gravity":
        body.setdefault("mass", round(rng.uniform(0.5, 2), 2))
        body.setdefault("center", body["points"][points[-1]])
        return {"kind": "gravity", "acceleration": [0, -9.81] if flat else [0, 0, -9.81], "bodies": [name]}
    if how == "couple":
        return {"kind": "couple", "body": name, "couple": "P/2" if flat else ["P/2", "P/3", "-P"]}
    if how == "distributed":
        ends = [[f"{round(rng.uniform(-1, 1), 2)}*w" for _ in range(2 if flat else 3)] for _ in range(2)]
        return {"kind": "distributed", "body": name, "between": points[:2], "intensities": ends}
    return {"kind": "force", "point": f"{name}.{rng.choice(points)}", "force": _vector(rng, flat)}


FLAT, UP, STEEP, DOWN, BACK = (1, 0), (0.8, 0.6), (0.28, 0.96), (0.8, -0.6), (-0.6, 0.8)


def _bar(x: float, y: float, along: tuple[float, float], length: float) -> dict[str, Any]:
    """A straight member with four points along it."""
    at = [np.array([x, y]) + length * part * np.array(along) for part in (0.0, 0.35, 0.7, 1.0)]
    return {"points": {f"s{k}": [round(float(v), 6) for v in p] for k, p in enumerate(at)}}


def _beam(d: dict, rng: Random) -> None:
    d["bodies"]["beam"] = _bar(0.2, 0.1, rng.choice((FLAT, UP)), 3.0)
    d["constraints"] |= {
        "A": {"kind": "pin", "points": ["beam.s0"]},
        "B": {"kind": "support", "point": rng.choice(("beam.s2", "beam.s3")), "normal": [-0.3, 1]},
    }


def _cantilever(d: dict, rng: Random) -> None:
    d["bodies"]["beam"] = _bar(0, 0, rng.choice((FLAT, DOWN)), 2.0)
    d["constraints"]["A"] = {"kind": "clamp", "points": ["beam.s0"]}


def _gerber(d: dict, rng: Random) -> None:
    d["bodies"] |= {"one": _bar(0, 0, FLAT, 2.0), "two": _bar(2, 0, FLAT, 1.5)}
    d["constraints"] |= {
        "A": {"kind": "clamp", "points": ["one.s0"]},
        "G": {"kind": "pin", "points": ["one.s3", "two.s0"]},
        "B": {"kind": "support", "point": "two.s2", "normal": [0, 1]},
    }


def _arch(d: dict, rng: Random) -> None:
    d["bodies"] |= {"left": _bar(0, 0, STEEP, 2.0), "right": _bar(3, 0, BACK, 1.5)}
    top = d["bodies"]["left"]["points"]["s3"]
    d["bodies"]["right"]["points"]["s4"] = top
    d["constraints"] |= {
        "A": {"kind": "pin", "points": ["left.s0"]},
        "B": {"kind": "pin", "points": ["right.s0"]},
        "G": {"kind": "pin", "points": ["left.s3", "right.s4"]},
    }


def _strut(d: dict, rng: Random) -> None:
    d["bodies"] |= {"mast": _bar(0, 0, (0, 1), 2.0), "boom": _bar(0, 1, UP, 2.0)}
    d["bodies"]["mast"]["points"]["t"] = [0, 1]
    d["constraints"] |= {
        "A": {"kind": "clamp", "points": ["mast.s0"]},
        "G": {"kind": "pin", "points": ["mast.t", "boom.s0"]},
        "strut": {"kind": "link", "points": ["mast.s3", "boom.s2"]},
    }


def _sliding(d: dict, rng: Random) -> None:
    d["bodies"] |= {"wall": _bar(0, 0, STEEP, 2.0), "slide": _bar(0.5, 1.5, FLAT, 1.5)}
    x, y = d["bodies"]["wall"]["points"]["s2"]
    d["bodies"]["slide"]["points"]["t"] = [x, y]
    d["bodies"]["wall"]["line"] = ["s0", "s3"]
    d["constraints"] |= {
        "A": {"kind": "clamp", "points": ["wall.s0"]},
        "E": {"kind": "slider", "point": "slide.t", "on": "wall"},
        "B": {"kind": "pin", "points": ["slide.s3"]},
    }


def _guided(d: dict, rng: Random) -> None:
    d["bodies"]["beam"] = _bar(0, 0, UP, 2.0)
    d["constraints"] |= {
        "A": {"kind": "guide", "point": "beam.s0", "along": [1, 2]},
        "B": {"kind": "support", "point": "beam.s3", "normal": [1, 0.5]},
    }


def _too_many(d: dict, rng: Random) -> None:
    _beam(d, rng)
    d["constraints"]["B"] = {"kind": "support", "point": "beam.s2", "normal": [0, 1]}
    d["constraints"]["C"] = {"kind": "support", "point": "beam.s3", "normal": [0, 1]}


def _truss(d: dict, rng: Random) -> None:
    top = round(rng.uniform(0.8, 1.4), 2)
    nodes = {"a": [0, 0], "b": [1, top], "c": [2, 0], "e": [3, top], "f": [4, 0]}
    members = ["a-b", "b-c", "a-c", "b-e", "c-e", "c-f", "e-f"]
    d["trusses"]["T"] = {"nodes": nodes, "members": members}
    d["constraints"] |= {
        "A": {"kind": "pin", "points": ["T.a"]},
        "B": {"kind": "support", "point": "T.f", "normal": [0, 1]},
    }


def _truss_on_beam(d: dict, rng: Random) -> None:
    d["bodies"]["beam"] = _bar(0, 0, FLAT, 4.0)
    d["trusses"]["T"] = {"nodes": {"a": [1.4, 0], "b": [2, 1], "c": [5, 1]}, "members": ["a-b", "b-c", "a-c"]}
    d["constraints"] |= {
        "A": {"kind": "clamp", "points": ["beam.s0"]},
        "G": {"kind": "pin", "points": ["beam.s1", "T.a"]},
        "H": {"kind": "link", "points": ["beam.s3", "T.c"]},
    }


def _frame_in_space(d: dict, rng: Random) -> None:
    d["bodies"] |= {
        "post": {"points": {"A": [0, 0, 0], "C": [0, 1, 2], "D": [1, 0.5, 1]}},
        "arm": {"points": {"C": [0, 1, 2], "E": [-1, 3, 2.5], "F": [-0.5, 2, 1.5]}},
    }
    d["constraints"] |= {
        "A": {"kind": "clamp", "points": ["post.A"]},
        "C": {"kind": "pin", "points": ["post.C", "arm.C"]},
        **{
            f"strut{k}": {"kind": "link", "points": [f"arm.{a}", f"post.{b}"]}
            for k, (a, b) in enumerate((("E", "A"), ("E", "D"), ("F", "D")))
        },
    }


def _legs_in_space(d: dict, rng: Random) -> None:
    up = [[0, 0, 1], [1, 0, 1.1], [0.3, 1, 1.2]]
    down = [[-0.5, 0, 0], [0.6, -0.8, 0], [1.6, 0.2, 0], [0.9, 1.4, 0]]
    legs = [(0, 0), (0, 1), (1, 1), (1, 2), (2, 2), (2, 3)]
    d["bodies"]["plate"] = {"points": {f"p{k}": v for k, v in enumerate(up)}}
    d["points"] = {f"g{k}": v for k, v in enumerate(down)}
    d["constraints"] |= {
        f"leg{k}": {"kind": "link", "points": [f"g{b}", f"plate.p{a}"]} for k, (a, b) in enumerate(legs)
    }


def _on_supports_in_space(d: dict, rng: Random) -> None:
    d["bodies"]["plate"] = {"points": {"a": [0, 0, 1], "b": [2, 0, 1], "c": [0, 1.5, 1], "e": [1, 1, 1.2]}}
    d["constraints"] |= {
        "A": {"kind": "pin", "points": ["plate.a"]},
        "B": {"kind": "support", "point": "plate.b", "normal": [0, 0, 1]},
        "B2": {"kind": "support", "point": "plate.b", "normal": [0, 1, 0]},
        "C": {"kind": "support", "point": "plate.c", "normal": [0.2, 0, 1]},
    }


KINDS = {
    "beam": _beam, "cantilever": _cantilever, "gerber": _gerber, "arch": _arch, "strut": _strut, "sliding": _sliding,
    "guided": _guided, "too_many": _too_many, "truss": _truss, "truss_on_beam": _truss_on_beam,
    "frame_in_space": _frame_in_space, "legs_in_space": _legs_in_space, "supports_in_space": _on_supports_in_space,
}  # fmt: skip


# by the balance


def expanded(text: str) -> tuple[str, dict[str, str]]:
    """(the model with its trusses as nodes and links, {name of a link: that of the member's tension})."""
    model = tomllib.loads(text)
    named = {}
    for truss, table in model.pop("trusses", {}).items():
        for node, at in table["nodes"].items():
            model.setdefault("bodies", {})[f"{truss}__{node}"] = {"points": {"o": at}}
        for member in table["members"]:
            a, b = member.split("-")
            link = f"{truss}__{a}__{b}"
            named[link] = f"tension({truss}, {member})"
            model["constraints"][link] = {"kind": "link", "points": [f"{truss}.{a}", f"{truss}.{b}"]}
        said = json.dumps({key: model.get(key, {}) for key in ("constraints", "forces")})
        for node in sorted(table["nodes"], key=len, reverse=True):
            said = said.replace(f'"{truss}.{node}"', f'"{truss}__{node}.o"')
        model |= json.loads(said)
    return toml(model), named


class Structure:
    """The balance of all bodies of a model without coordinates."""

    def __init__(self, text: str) -> None:
        text, self.members = expanded(text)
        self.o = Oracle(text, np.zeros(0))
        s = State(0.0, np.zeros(0), np.zeros(0))
        self.now = self.o.maximal(s)
        self.rows: list[Row] = self.o.constraint_rows(self.now)
        self.J = np.array([row.parts()[0] for row in self.rows])
        self.loads = laws.loads(self.o, self.now, s)
        F = sum((load.on(self.o, self.now) for load in self.loads), np.zeros(6 * len(self.o.bodies)))
        due = [k for i, name in enumerate(self.o.bodies) for k in self._due(i, name)]
        self.lam, self.null = least_squares(self.J.T[due], -F[due])
        left = self.J.T[due] @ self.lam + F[due]
        if np.max(np.abs(left), initial=0.0) > 1e-7 * (1 + np.max(np.abs(F))):
            raise NoAnswer("the loads move it")

    def _due(self, i: int, name: str) -> list[int]:
        """The components of the balance of a body; a node has no couples."""
        own = (0, 1, 5) if self.o.model.plane else range(6)
        return [6 * i + k for k in own if k < 3 or "__" not in name]

    def reactions(self) -> dict[str, float]:
        """Those that have one value, by the product's names."""
        found: dict[str, float] = {}
        for name, constraint in self.o.model.constraints.items():
            mine = [k for k, row in enumerate(self.rows) if row.owner == name]
            said = laws._of_constraint(name, constraint, self.now, [(self.rows[k].role, k) for k in mine])
            if constraint["kind"] == "clamp" and not self.o.model.plane:
                couples = [k for k in mine if self.rows[k].role == "couple"]
                said = {f"reaction_{self.rows[k].role}({name})": k for k in mine if k not in couples}
                said |= {f"reaction_couple_{'xyz'[j]}({name})": k for j, k in enumerate(couples)}
            for key, k in said.items():
                if not len(self.null) or np.max(np.abs(self.null[:, k])) < 1e-9:
                    found[self.members.get(name, key)] = float(self.lam[k])
        return found

    def section(self, body: str, begin: np.ndarray, along: np.ndarray, x: float) -> tuple[float, float, float] | None:
        """(N, V, M) of a straight member at x from its beginning, in the plane; None where they have no one value."""
        i = self.o.bodies.index(body)
        cut, left = begin + x * along, np.array([-along[1], along[0], 0.0])
        f, m = np.zeros(3), 0.0

        def add(place: np.ndarray, force: np.ndarray, couple: float = 0.0) -> None:
            nonlocal f, m
            if (place - begin) @ along < x:
                f = f + force
                m += couple + float(np.cross(place - cut, force)[2])

        for part in self._distributed(body):
            for place, force in part(x, begin, along):
                add(place, force)
        for load in self.loads:
            if load.body == body and self.o.model.forces[load.name]["kind"] != "distributed":
                if load.place is None:
                    return None  # a couple stands nowhere along the member
                add(load.place, load.force)
        center = self.now.poses[body][0].c[0][:, 0] + self.o.model.mass[body][1]
        for name, constraint in self.o.model.constraints.items():
            mine = [k for k, row in enumerate(self.rows) if row.owner == name]
            W = self.J[mine][:, 6 * i : 6 * i + 6].T
            if not np.any(W):
                continue
            if len(self.null) and np.max(np.abs(self.null[:, mine])) > 1e-9:
                return None
            w = W @ self.lam[mine]
            named = constraint.get("points") or [constraint["point"]]
            own = next((p for p in named if p.startswith(f"{body}.")), named[0])  # of a rail: the point that slides
            place = self.now.point(own).c[0][:, 0]
            add(place, w[:3], float(w[5] - np.cross(place - center, w[:3])[2]))
        return -float(f @ along), float(f @ left), -m

    def _distributed(self, body: str) -> list[Any]:
        found = []
        for f in self.o.model.forces.values():
            if f["kind"] != "distributed" or f["body"] != body:
                continue
            a, b = (self.now.point(f"{body}.{x}").c[0][:, 0] for x in f["between"])
            p, q = (self.now.vector(x).c[0][:, 0] for x in f["intensities"])

            def part(x: float, begin: np.ndarray, along: np.ndarray, a=a, b=b, p=p, q=q) -> list:
                """By Gauss' points as far as the cut."""
                start, length = float((a - begin) @ along), float(np.linalg.norm(b - a))
                sense = 1.0 if (b - a) @ along > 0 else -1.0
                lo, hi = (0.0, (x - start) / length) if sense > 0 else ((start - x) / length, 1.0)
                lo, hi = max(lo, 0.0), min(max(hi, 0.0), 1.0)
                if hi <= lo:
                    return []
                s, w = np.polynomial.legendre.leggauss(3)
                at = lo + (hi - lo) * (s + 1) / 2
                return [
                    (a + (b - a) * u, (p + (q - p) * u) * length * wi * (hi - lo) / 2)
                    for u, wi in zip(at, w, strict=True)
                ]

            found.append(part)
        return found


# the product against it


def reported(text: str) -> dict[str, dict]:
    """What the product says of a structure: reactions by two verbs, section forces."""
    from compare import quiet

    import eomgen

    with quiet():
        model = eomgen.loads(text)
        reactions = {name: x.value for name, x in eomgen.reactions(model).items() if x.value is not None}
        statics = eomgen.statics(model).as_dict()
    by_work = {name: x["value"] for name, x in statics["reactions"].items() if x.get("value") is not None}
    return {"reactions": reactions, "statics": by_work, "sections": statics["sections"]}


def compared(text: str, said: dict[str, dict] | None = None) -> Any:
    """The reactions and section forces of the product against the balance of the bodies."""
    from compare import Found

    found, said = Found(), reported(text) if said is None else said
    oracle = Structure(text)
    want = oracle.reactions()
    size = 1.0 + 1e-3 * max((abs(x) for x in want.values()), default=0.0)
    for kind in ("reactions", "statics"):
        for name in sorted(want.keys() & said[kind].keys()):
            found.same(kind, name, said[kind][name], want[name], size)
        missing = sorted(want.keys() - said[kind].keys())
        if missing:
            found.faults.append((kind, f"{', '.join(missing)}: no value where the balance has one"))
    if oracle.o.model.plane:
        _sections(found, said["sections"], oracle, size)
    return found


def _sections(found: Any, said: dict[str, Any], oracle: Structure, size: float) -> None:
    model = oracle.o.model
    for body, table in said.items():
        points = [model.numbers(p) for p in model.bodies[body]["points"].values()] if body in model.bodies else []
        if "pieces" not in table or len(points) < 2:
            continue
        begin, along = points[0], points[1] - points[0]
        along = along / np.linalg.norm(along)
        if any(abs(np.cross(p - begin, along)[2]) > 1e-5 for p in points) or any(
            (p - begin) @ along < 0 for p in points
        ):
            continue
        for piece in table["pieces"]:
            x = (model.number(piece["from"]) + model.number(piece["to"])) / 2
            want = oracle.section(body, begin, along, x)
            if want is None:
                continue
            known = {**{name: float(v) for name, v in model.parameters.items()}, "x": x, "pi": np.pi}
            for name, value in zip("NVM", want, strict=True):
                got = _number(piece[name], known)
                found.same("sections", f"{name} of {body} at {x:.4g}", got, value, size)


def _number(text: str, known: dict[str, float]) -> float:
    from taylor import FUNCTIONS, jet

    def call(function: str, trees: tuple) -> Any:
        return FUNCTIONS[function](*(formulas.evaluated(x, lambda n, _: known[n], call) for x in trees))

    found = formulas.evaluated(formulas.parsed(str(text)), lambda name, _: known[name], call)
    return found if isinstance(found, float) else float(jet(found).value)
