"""Levels -> the text of a model: pieces that each feature brings, hung together by a seed."""

from __future__ import annotations

import math
from copy import deepcopy
from random import Random
from typing import Any

from features import SHAPES


def text_of(levels: dict[str, str], seed: int) -> str:
    """The model of a row of levels; the numbers in it by the seed."""
    older = {factor: level for factor, level in levels.items() if (factor, level) != ("state", "none")}
    return toml(Drawing(levels, Random(f"{sorted(older.items())}{seed}")).model())


def toml(model: dict[str, Any]) -> str:
    """A dictionary as TOML: the tables of its first two levels as tables, all below inline."""
    head = [f"{key} = {_inline(x)}" for key, x in model.items() if not isinstance(x, dict)]
    parts = []
    for key, table in model.items():
        if not isinstance(table, dict) or (not table and key != "impact"):
            continue
        if key in ("bodies", "constraints", "forces"):
            for name, entry in table.items():
                parts.append(f"\n[{key}.{name}]")
                parts += [f"{k} = {_inline(x)}" for k, x in entry.items()]
        else:
            parts.append(f"\n[{key}]")
            parts += [f"{k} = {_inline(x)}" for k, x in table.items()]
    return "\n".join([*head, *parts]) + "\n"


def _inline(x: Any) -> str:
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, str):
        return "'" + x + "'" if "\\" in x else '"' + x + '"'
    if isinstance(x, dict):
        return "{ " + ", ".join(f"{k} = {_inline(y)}" for k, y in x.items()) + " }"
    if isinstance(x, (list, tuple)):
        return "[" + ", ".join(_inline(y) for y in x) + "]"
    return repr(x)


DIMENSIONS = {
    "m": ("kg", "g", 1e3),
    "I": ("kg*m^2", "kg*cm^2", 1e4),
    "l": ("m", "cm", 100),
    "h": ("m", "mm", 1e3),
    "g": ("m/s^2", "m/s^2", 1),
    "k": ("N/m", "N/mm", 1e-3),
    "c": ("N*s/m", "kN*s/m", 1e-3),
    "kt": ("N*m/rad", "kN*m", 1e-3),
    "ct": ("N*m*s", "N*m*s", 1),
    "A": ("rad", "deg", 180 / math.pi),
    "B": ("m", "cm", 100),
    "w": ("rad/s", "rpm", 30 / math.pi),
    "F0": ("N", "kN", 1e-3),
    "M0": ("N*m", "kN*m", 1e-3),
    "mu": ("1", "1", 1),
    "d": ("m", "dm", 10),
}


def _square(size: int) -> list[list[str]]:
    """A symmetric added mass."""
    ways = 2 if size == 3 else 3
    units = ("m", "m*d", "I")
    return [
        [
            f"{units[(i >= ways) + (j >= ways)]}*{1 + i / 4 if i == j else round(0.3 / (1 + i + j), 3)}"
            for j in range(size)
        ]
        for i in range(size)
    ]


RUBS = ("sliding", "sticking", "viscous")


class Drawing:
    """A model under construction."""

    def __init__(self, levels: dict[str, str], rng: Random) -> None:
        self.levels, self.rng = levels, rng
        self.plane = levels["space"] == "plane"
        self.used: set[str] = set()
        self.coordinates: dict[str, Any] = {}
        self.kinds: dict[str, str] = {}  # of a coordinate: angle or length
        self.bodies: dict[str, dict] = {}
        self.points: dict[str, Any] = {}
        self.constraints: dict[str, dict] = {}
        self.forces: dict[str, dict] = {}
        self.inputs: dict[str, Any] = {}
        self.tables: dict[str, Any] = {}
        self.speeds: dict[str, Any] = {}
        self.states: dict[str, Any] = {}
        self.outputs: dict[str, Any] = {}
        self.host: str | None = None
        self.impact: dict[str, str] | None = None
        self.side = Random(f"rough{sorted(levels.items())}")  # draws of its own: what else is drawn stays as it was

    # pieces of text

    def number(self, low: float, high: float) -> float:
        return round(self.rng.uniform(low, high), 2)

    def v(self, *entries: Any) -> list:
        """A vector: in the plane its first two entries."""
        return list(entries[:2] if self.plane else entries)

    def coordinate(self, name: str, kind: str, start: float = 0.0, speed: float | None = None) -> str:
        self.kinds[name] = kind
        other = self.levels["units"] == "other"
        unit = {"angle": "deg", "length": "cm", "pure": None}[kind] if other else None
        if self.levels["units"] == "si":
            unit = {"angle": "rad", "length": "m", "pure": None}[kind]
        scale = {"deg": 180 / math.pi, "cm": 100.0}.get(unit or "", 1.0)
        declared: dict[str, Any] = {"start": round(start * scale, 12)}
        if speed is not None:
            declared["speed"] = round(speed * scale, 6)
        if unit is not None:
            declared["unit"] = unit
        self.coordinates[name] = declared if len(declared) > 1 else declared["start"]
        return name

    def depends(self, *names: str) -> None:
        """These coordinates follow from a constraint, as the level of closure says."""
        how = self.levels["closure"]
        if how == "multipliers":
            return
        for name in names:
            old = self.coordinates[name]
            old = dict(old) if isinstance(old, dict) else {"start": old}
            start = old.pop("start")
            old.pop("speed", None)
            if how == "near":
                self.coordinates[name] = {"dependent": True, "near": round(start * 1.02 + 0.01, 6), **old}
            else:
                self.coordinates[name] = {"dependent": True, "start": start, **old}

    def rates(self, *names: str) -> None:
        """Speeds at the start of what is free."""
        for name in names:
            old = self.coordinates[name]
            if not isinstance(old, dict):
                old = {"start": old}
            scale = {"deg": 180 / math.pi, "cm": 100.0}.get(old.get("unit", ""), 1.0)
            self.coordinates[name] = {**old, "speed": round(self.number(-1, 1) * scale, 6)}

    def joint(self, kind: str, **fields: Any) -> dict:
        return {"kind": kind, **({"on": self.host} if self.host else {}), **fields}

    def axis(self) -> dict:
        if self.plane:
            return {}
        return self.rng.choice([{}, {"axis": [1, 0, 0]}, {"axis": [0, 3, 4]}, {"axis": [1, 2, 2]}])

    def body(self, name: str, joint: dict, shape: str = "given", **more: Any) -> str:
        self.bodies[name] = {**self.shaped(shape), **more, "joint": joint}
        return name

    # shapes

    def shaped(self, kind: str) -> dict[str, Any]:
        """Mass, shape or inertia of a body."""
        P = {"points": {"P": self.v("l/2", "h", "h/2")}}
        if kind == "given":
            inertia = (
                "I"
                if self.plane
                else self.rng.choice([["I", "I", "1.5*I"], ["I", "1.2*I", "0.9*I", "I/20", "-I/15", "I/30"]])
            )
            return {"mass": "m", "center": self.v("l/3", "h/2", "-h/3"), "inertia": inertia, **P}
        if kind == "massless":
            return P
        if kind == "leaking":
            inertia = "I*(1 + t/9)" if self.plane else ["I*(1 + t/9)", "1.2*I*(1 + t/9)", "0.9*I*(1 + t/9)"]
            return {"mass": "m*(1 + t/9)", "center": self.v("l/3", "h/2", "-h/3"), "inertia": inertia, **P}
        if kind == "parts":
            parts = [
                {"kind": "rod", "length": "l", "mass": "m"},
                {"kind": "disc", "radius": "h", "mass": "2*m", "at": self.v("l", "h", "0"), "angle": 0.4},
            ]
            return {"parts": parts, **P}
        return {"shape": {"kind": kind, "mass": "m", **deepcopy(SHAPES[kind])}, **P}

    # the base that carries the rest

    def base(self) -> None:
        how = self.levels["base"]
        if how in ("ground",):
            return
        sliding = how in ("sliding", "by_samples_rate")
        kind = "length" if sliding else "angle"
        amplitude, size = ("B", 0.2) if sliding else ("A", 0.4)
        name = self.coordinate("b", kind, self.number(0.05, 0.4), self.number(-1, 1))
        laws: dict[str, Any] = {
            "by_formula": {"motion": f"{amplitude}*sin(w*t) + {amplitude}*w*t/2"},
            "all_driven": {"motion": f"{amplitude}*sin(w*t)"},
            "by_rate": {"start": 0.2, "rate": f"{amplitude}*w*cos(w*t)"},
            "by_acceleration": {"start": 0.1, "speed": 0.3, "acceleration": f"{amplitude}*w^2*cos(w*t)"},
            "by_samples": {"motion": {"samples": [[0, 0.1], [0.3, 0.3], [0.8, 0.2], [1.2, 0.5], [2, 0.4]]}},
            "by_samples_rate": {
                "start": 0.1,
                "rate": {
                    "samples": [[0, 0], [0.5, size], [1, 0.1], [2, 0]],
                    "between": self.rng.choice(["linear", "cubic"]),
                },
            },
        }
        if how in laws:
            self.coordinates[name] = laws[how]
        if how == "placed":
            self.coordinates[name] = self.rng.choice([laws["by_formula"], laws["by_samples"]])
        if how == "by_samples" and self.rng.random() < 0.5:
            self.coordinates[name]["motion"]["ends"] = self.rng.choice(["natural", "rest"])
        if how == "by_tie":
            self.coordinate("b", kind, 0.0)
            self.constraints["drive"] = {"kind": "motion", "coordinate": "b", "value": f"{amplitude}*sin(w*t)"}
        if how == "placed":
            turning = {"angle": name} if self.plane else {"orientation": "xyz", "angles": [name, "A*sin(w*t)", 0.2]}
            joint = self.joint("placed", at=self.v("B*sin(w*t)", "h", "h/2"), **turning)
        elif sliding:
            joint = self.joint("prismatic", axis=self.v(3, 4, 0) if self.plane else [2, 1, 2], displacement=name)
        else:
            joint = self.joint("revolute", at=self.v("0.1", "h", "0"), angle=name, **self.axis())
        self.body("base", joint, "given")
        self.host = "base"

    # loops

    def seat(self, x: Any = 0, y: Any = 0) -> dict:
        """Where a mechanism of a plane sits: in space its plane is turned."""
        found: dict[str, Any] = {"at": self.v(x, y, 0)}
        if not self.plane:
            found["turned"] = {"axis": [1, 0, 0], "angle": "pi/2"}
        return found

    def four_bar(self, tag: str, a: float, b: float, c: float, d: float, alpha: float, x: float) -> None:
        """A crank, a coupler, a rocker; closed at the start by two circles."""
        ax, ay = a * math.cos(alpha), a * math.sin(alpha)
        dx, dy = d - ax, -ay
        r = math.hypot(dx, dy)
        u = (r * r + b * b - c * c) / (2 * r)
        v = math.sqrt(b * b - u * u)
        bx, by = ax + (u * dx - v * dy) / r, ay + (u * dy + v * dx) / r
        names = [f"{n}{tag}" for n in ("al", "be", "ga")]
        one = self.coordinate(names[0], "angle", alpha, self.number(-1, 1))
        two = self.coordinate(names[1], "angle", math.atan2(by - ay, bx - ax))
        three = self.coordinate(names[2], "angle", math.atan2(by, bx - d))
        bars = [f"{n}{tag}" for n in ("crank", "coupler", "rocker")]
        rod = lambda length: {"shape": {"kind": "rod", "mass": "m", "length": length}}  # noqa: E731
        if not self.plane:
            rod = lambda length: {  # noqa: E731
                "mass": "m",
                "center": [length / 2, 0, 0],
                "inertia": ["I/8", "I", "I"],
                "points": {"end": [length, 0, 0]},
            }
        turned = {} if self.plane else {"turned": {"axis": [1, 0, 0], "angle": "pi/2"}}
        self.bodies[bars[0]] = {**rod(a), "joint": self.joint("revolute", at=self.v(x, 0.1, 0), angle=one, **turned)}
        self.bodies[bars[1]] = {
            **rod(b),
            "joint": {"kind": "revolute", "on": f"{bars[0]}.end", "angle": f"{two} - {one}"},
        }
        self.bodies[bars[2]] = {
            **rod(c),
            "joint": self.joint("revolute", at=self.v(x + d, 0.1, 0), angle=three, **turned),
        }
        self.constraints[f"B{tag}"] = {"kind": "pin", "points": [f"{bars[1]}.end", f"{bars[2]}.end"]}
        self.depends(two, three)

    def slider_crank(self, a: float = 0.4, b: float = 1.1, alpha: float = 0.7) -> None:
        one = self.coordinate("cr", "angle", alpha, self.number(-1, 1))
        beta = math.asin(-a * math.sin(alpha) / b)
        two = self.coordinate("ro", "angle", beta)
        three = self.coordinate("pi1", "length", a * math.cos(alpha) + b * math.cos(beta))
        turned = {} if self.plane else {"turned": {"axis": [1, 0, 0], "angle": "pi/2"}}
        inertia: dict[str, Any] = {"inertia": "I"} if self.plane else {"inertia": ["I/8", "I", "I"]}
        self.bodies["crank"] = {
            "mass": "m",
            "center": self.v(a / 2, 0, 0),
            **inertia,
            "points": {"end": self.v(a, 0, 0)},
            "joint": self.joint("revolute", at=self.v(0.1, 0.2, 0), angle=one, **turned),
        }
        self.bodies["rod"] = {
            "mass": "m",
            "center": self.v(b / 2, 0, 0),
            **inertia,
            "points": {"end": self.v(b, 0, 0)},
            "joint": {"kind": "revolute", "on": "crank.end", "angle": f"{two} - {one}"},
        }
        self.bodies["piston"] = {
            "shape": {"kind": "particle", "mass": "2*m"},
            "joint": self.joint(
                "prismatic", at=self.v(0.1, 0.2, 0), axis=self.v(1, 0, 0), displacement=three, **turned
            ),
        }
        self.constraints["wrist"] = {"kind": "pin", "points": ["rod.end", "piston.center"]}
        self.depends(two, three)

    def loops(self) -> None:
        how = self.levels["loop"]
        on_ground = how in ("four_bar", "two_loops", "slider_crank") and self.rng.random() < 0.5
        host, self.host = self.host, None if on_ground else self.host
        if how in ("four_bar", "two_loops", "on_base"):
            self.four_bar("1", 0.4, 1.1, 0.9, 1.2, self.number(0.6, 1.2), 0.2)
        if how == "two_loops":
            self.four_bar("2", 0.35, 0.9, 0.8, 1.0, self.number(0.6, 1.2), 1.6)
        if how == "slider_crank":
            self.slider_crank()
        self.host = host

    # constraints

    def constraint(self) -> None:
        how = self.levels["tie"]
        if how != "none":
            getattr(self, f"tie_{how}")()

    def particle(self, name: str, joint: dict, mass: str = "m") -> None:
        self.bodies[name] = {"shape": {"kind": "particle", "mass": mass}, "joint": joint}

    def box(self, name: str, joint: dict, **points: Any) -> None:
        inertia: Any = "I" if self.plane else ["I", "1.1*I", "1.3*I"]
        self.bodies[name] = {"mass": "m", "inertia": inertia, "points": points, "joint": joint}

    def floating(self, name: str, x: float, y: float, angle: float, **points: Any) -> list[str]:
        """A body that nothing holds, and its coordinates."""
        a = self.coordinate(f"{name}x", "length", x, self.number(-0.5, 0.5))
        b = self.coordinate(f"{name}y", "length", y)
        f = self.coordinate(f"{name}f", "angle", angle, self.number(-0.5, 0.5))
        if self.plane:
            self.box(name, self.joint("free", x=a, y=b, angle=f), **points)
            return [a, b, f]
        c = self.coordinate(f"{name}z", "length", 0.3)
        g = self.coordinate(f"{name}g", "angle", 0.4)
        h = self.coordinate(f"{name}h", "angle", -0.3)
        self.box(name, self.joint("free", position=[a, b, c], orientation="xyz", angles=[g, h, f]), **points)
        return [a, b, c, g, h, f]

    def tie_support(self) -> None:
        one = self.coordinate("s1", "angle", 0.5, self.number(-1, 1))
        two = self.coordinate("s2", "angle", 0.7)
        extra = {} if self.plane else {"axis": [0, 1, 0]}
        self.box("leg", self.joint("revolute", at=self.v(-0.5, 0, 0), angle=one, **extra), end=self.v("l", 0, 0))
        self.box("foot", {"kind": "revolute", "on": "leg.end", "angle": two, **extra}, end=self.v("l", "h", "h"))
        self.constraints["wall"] = {"kind": "support", "point": "foot.end", "normal": self.v(1, -2, 2)}
        self.depends(two)

    def tie_clamp(self) -> None:
        one = self.coordinate("s1", "angle", 0.5, self.number(-1, 1))
        self.box("leg", self.joint("revolute", at=self.v(-0.5, 0, 0), angle=one), end=self.v("l", 0, 0))
        names = self.floating("block", 0.1, 0.4, 0.2, P=self.v("h", 0, 0))
        for name in names:
            x = self.coordinates[name]
            if isinstance(x, dict):
                x.pop("speed", None)
        self.constraints["weld"] = {"kind": "clamp", "points": ["leg.end", "block.P"]}
        closed = self.levels["closure"]
        if closed == "multipliers":  # it stands where it is welded on: a part of the arm from the start
            return
        self.depends(*names)

    def tie_guide(self) -> None:
        names = self.floating("block", 0.1, 0.4, 0.2, P=self.v("h", 0, 0))
        self.constraints["rail"] = {"kind": "guide", "point": "block.P", "along": self.v(2, 1, 0)}
        self.depends(*names[1:])

    def tie_slider(self) -> None:
        one = self.coordinate("s1", "angle", 0.5, self.number(-1, 1))
        x = self.coordinate("s2", "length", round(0.6 * math.cos(0.5), 9), None)
        y = self.coordinate("s3", "length", round(0.6 * math.sin(0.5), 9), None)
        self.box("rail", self.joint("revolute", at=self.v(0, 0, 0), angle=one), A=self.v(0, 0, 0), B=self.v("l", 0, 0))
        self.bodies["rail"]["line"] = ["A", "B"]
        if self.plane:
            self.particle("bead", self.joint("planar", x=x, y=y, angle=0))
        else:
            z = self.coordinate("s4", "length", 0.0)
            self.particle("bead", self.joint("placed", at=[x, y, z], angle=0))
        self.constraints["eye"] = {"kind": "slider", "point": "bead.center", "on": "rail"}
        self.depends(*(["s3"] if self.plane else ["s3", "s4"]))

    def tie_link(self) -> None:
        one = self.coordinate("s1", "length", 0.5, self.number(-1, 1))
        two = self.coordinate("s2", "length", 0.8)
        self.particle("left", self.joint("prismatic", axis=self.v(1, 0, 0), displacement=one))
        self.particle(
            "right", self.joint("prismatic", at=self.v(0, 0, "h"), axis=self.v(1, 2, 0), displacement=two), "2*m"
        )
        self.constraints["rod0"] = {"kind": "link", "points": ["left.center", "right.center"]}
        if self.rng.random() < 0.3:
            self.constraints["rod0"]["length"] = 0.62
        self.depends(two)

    def tie_rolling(self) -> None:
        on = {"on": "base"} if self.host else {}
        x = self.coordinate("s1", "length", 0.3, self.number(-1, 1))
        if self.plane:
            f = self.coordinate("s2", "angle", 0.2)
            self.bodies["wheel"] = {
                "shape": {"kind": "disc", "mass": "m", "radius": "h"},
                "joint": self.joint("planar", x=x, y="h", angle=f),
            }
            self.constraints["track"] = {
                "kind": "rolling",
                "body": "wheel",
                "line": {"at": [0, 0], "normal": [0, 1]},
                **on,
            }
            self.depends(f)
            return
        y = self.coordinate("s2", "length", 0.1, self.number(-1, 1))
        angles = [self.coordinate(f"s{k}", "angle", 0.3 * k - 0.5) for k in (3, 4, 5)]
        self.bodies["wheel"] = {
            "shape": {"kind": "sphere", "mass": "m", "radius": "h"},
            "joint": self.joint("free", position=[x, y, "h"], orientation="xyz", angles=angles),
        }
        self.constraints["track"] = {
            "kind": "rolling",
            "body": "wheel",
            "plane": {"at": [0, 0, 0], "normal": [0, 0, 1]},
            **on,
        }
        self.depends(x, y)

    def tie_skate(self) -> None:
        names = self.floating("sledge", 0.1, 0.4, 0.3, P=self.v("h", 0, 0))
        self.constraints["edge"] = {"kind": "skate", "point": "sledge.P", "along": self.v(1, 0, 0)}
        self.coordinates[names[0]] = self.coordinates[names[0]]
        self.depends(names[1])

    def tie_string(self) -> None:
        one = self.coordinate("s1", "length", -0.6, self.number(-1, 1))
        two = self.coordinate("s2", "length", -0.8)
        three = self.coordinate("s3", "angle", 0.0)
        up = self.v(0, 1, 0)
        self.particle("left", self.joint("prismatic", at=self.v("-h", 0, 0), axis=up, displacement=one))
        self.particle("right", self.joint("prismatic", at=self.v("h", 0, 0), axis=up, displacement=two), "2*m")
        self.bodies["pulley"] = {
            "shape": {"kind": "disc", "mass": "m", "radius": "h"},
            "joint": self.joint("revolute", angle=three),
        }
        self.constraints["rope"] = {
            "kind": "string",
            "path": ["left.center", {"body": "pulley", "turn": "cw"}, "right.center"],
        }
        self.depends(two, three)

    def tie_capstan(self) -> None:
        one = self.coordinate("s1", "length", -0.6, 0.5)
        two = self.coordinate("s2", "length", -0.8)
        up = self.v(0, 1, 0)
        self.particle("left", self.joint("prismatic", at=self.v("-h", 0, 0), axis=up, displacement=one))
        self.particle("right", self.joint("prismatic", at=self.v("h", 0, 0), axis=up, displacement=two), "2*m")
        self.bodies["pulley"] = {
            "shape": {"kind": "disc", "mass": "m", "radius": "h"},
            "joint": self.joint("revolute", angle=self.coordinate("s3", "angle", 0.0)),
        }
        self.constraints["rope"] = {
            "kind": "capstan",
            "path": ["left.center", {"body": "pulley", "turn": "cw"}, "right.center"],
            "coefficient": 0.2,
            "angle": "pi",
        }
        self.depends(two)

    def tie_gear(self) -> None:
        one = self.coordinate("s1", "angle", 0.2, self.number(-1, 1))
        two = self.coordinate("s2", "angle", 0.1)
        shape = {"kind": "disc", "mass": "m", "radius": "h"}
        more = {} if self.plane else {"axis": [0, 3, 4]}
        self.bodies["small"] = {"shape": shape, "joint": self.joint("revolute", angle=one)}
        self.bodies["large"] = {
            "shape": {**shape, "mass": "3*m"},
            "joint": self.joint("revolute", at=self.v("3*h", 0, 0), angle=two, **more),
        }
        self.constraints["mesh"] = {"kind": "gear", "bodies": ["small", "large"], "ratio": -2}
        self.depends(two)

    def _two_slides(self) -> tuple[str, str]:
        one = self.coordinate("s1", "length", 0.4, self.number(-1, 1))
        two = self.coordinate("s2", "length", 0.32)
        self.particle("left", self.joint("prismatic", axis=self.v(1, 0, 0), displacement=one))
        self.particle("right", {"kind": "prismatic", "on": "left", "axis": self.v(1, 2, 0), "displacement": two}, "2*m")
        return one, two

    def tie_gap(self) -> None:
        one, two = self._two_slides()
        self.constraints["cam"] = {"kind": "equation", "gap": f"{two} - 2*{one}^2/d"}
        self.depends(two)

    def tie_rate(self) -> None:
        one, two = self._two_slides()
        self.constraints["law"] = {"kind": "equation", "rate": f"{two}' - sin({one}/d)*{one}' - {two}*{one}'/d"}
        self.depends(two)

    def tie_points(self) -> None:
        one = self.coordinate("s1", "length", 0.4, self.number(-1, 1))
        two = self.coordinate("s2", "length", 0.16)
        self.particle("bead", self.joint("placed", at=self.v(one, two, 0), angle=0))
        seen = ", base" if self.host and self.rng.random() < 0.5 else ""
        self.constraints["curve"] = {"kind": "equation", "gap": f"y(bead.center{seen}) - x(bead.center{seen})^2/d"}
        self.depends(two)

    def tie_motion(self) -> None:
        one, _ = self._two_slides()
        value: Any = "0.4 + B*sin(w*t)" if self.levels["units"] == "none" else "d/3 + B*sin(w*t)"
        self.constraints["push"] = {"kind": "motion", "coordinate": one, "value": value}
        self.depends(one)

    # the joint that is looked at

    @property
    def _is_cut_free(self) -> bool:
        """Whether every reaction of a joint in the plane follows."""
        placeless = {"potential", "kinetic", "generalized", "added_mass"}
        alone = all(self.levels[x] == "none" for x in ("loop", "tie", "contact"))
        steady = self.levels["base"] in ("ground", "turning", "sliding")
        return (
            self.plane and alone and steady and placeless.isdisjoint(self.levels[x] for x in ("force", "second_force"))
        )

    def featured(self) -> None:
        how, extra = self.levels["joint"], self.levels["joint_with"]
        rng, host = self.rng, self.host
        if "coupler1" in self.bodies and rng.random() < 0.4:
            host = "coupler1"
        joint: dict[str, Any] = {"kind": how, **({"on": host} if host else {})}
        moving = [q for q, kind in self.kinds.items() if kind == "length" and q in self.coordinates]
        fixed_at = self.v("l/4", "h", "-h/2")
        joint["at"] = self.v(f"l/4 + {moving[0]}/5", "h", "0") if extra == "moving_seat" and moving else fixed_at
        if extra == "moving_seat" and (not moving or self.levels["contact"] in RUBS):
            joint["at"] = self.v("l/4", "h + B*sin(w*t)", "0")
        if extra == "turned":
            joint["turned"] = {"angle": "pi/5"} if self.plane else {"axis": [1, 2, 2], "angle": 0.6}
        if extra == "point":
            joint["point"] = "P"
        getattr(self, f"joint_{how}", self.joint_revolute)(joint)
        if self.levels["speeds"] == "omega" and "omega" not in joint:  # refused by the product
            joint["omega"] = ["w0", "w1", "w2"]
            self.speeds |= {f"w{k}": {"start": 0.1} for k in range(3)}
        if extra == "spring_damper":
            turning = how in ("revolute", "screw")
            joint |= {"stiffness": "kt" if turning else "k", "rest": 0.1, "damping": "ct" if turning else "c"}
            if self.levels["units"] != "none":
                joint["rest"] = {"value": 0.1, "unit": "rad" if turning else "m"}
        if extra == "stops":  # wide: a run within them moves as one without
            several = {"planar": ("x", "angle"), "cylindrical": ("displacement", "angle")}.get(how, ())
            wide: Any = [-1000, "inf"]
            if how in ("universal", "spherical", "quaternion"):
                several, wide = ("angles",), [wide] * (2 if how == "universal" else 3)
            joint |= {"limits": dict.fromkeys(several, wide) if several else wide, "restitution": 0.3}
        if extra == "rubbing":
            joint["friction"] = {"torque" if how in ("revolute", "screw") else "force": 0.4, "smooth": 0.3}
            if how == "prismatic" and self._is_cut_free and rng.random() < 0.7:
                joint["friction"] = {"coefficient": 0.2, "length": "2*l", "smooth": 0.3}
        if extra == "armature":
            joint["armature"] = "I/2" if how in ("revolute", "screw") else "m/2"
        if extra == "drive":
            turning = how in ("revolute", "screw", "cylindrical")
            if not turning and "displacement" not in joint:  # refused by the product
                joint["torque"] = "M0"
            elif turning:
                joint["torque"] = f"M0*sin(w*t) - ct*{joint['angle']}'"
            else:
                joint["force"] = f"F0 - c*{joint['displacement']}'"
        self.bodies["tool"] = {**self.shaped(self.levels["shape"]), "joint": joint}

    def joint_revolute(self, joint: dict) -> None:
        joint |= {"angle": self.coordinate("j1", "angle", 0.4, self.number(-1, 1)), **self.axis()}

    def joint_prismatic(self, joint: dict) -> None:
        s = self.coordinate("j1", "length", 0.3, self.number(-1, 1))
        joint |= {"displacement": s, "axis": self.v(3, 4, 0) if self.plane else [1, 2, 2]}

    def joint_planar(self, joint: dict) -> None:
        x, y = (self.coordinate(f"j{k}", "length", 0.2 * k, self.number(-1, 1)) for k in (1, 2))
        joint |= {"x": x, "y": y, "angle": self.coordinate("j3", "angle", 0.3, self.number(-1, 1))}

    def joint_free(self, joint: dict) -> None:
        if self.plane:
            self.joint_planar(joint)
            return
        place = [self.coordinate(f"j{k}", "length", 0.2 * k, self.number(-1, 1)) for k in (1, 2, 3)]
        joint |= {"position": place}
        omega = self.levels["speeds"] == "omega"
        self.orientation(joint, "quaternion" if omega else self.rng.choice(["zxz", "xyz", "zyx"]))

    def orientation(self, joint: dict, sequence: str) -> None:
        omega = sequence == "quaternion"
        if sequence == "quaternion":
            four = [self.coordinate(f"e{k}", "pure", x) for k, x in enumerate((0.9, 0.3, -0.2, 0.25))]
            joint |= {"orientation": "quaternion", "quaternion": four}
        else:
            three = [self.coordinate(f"a{k}", "angle", x, self.number(-1, 1)) for k, x in enumerate((0.3, 0.7, -0.4))]
            joint |= {"orientation": sequence, "angles": three}
        if omega:
            for k in range(3):
                self.speeds[f"w{k}"] = {"start": self.number(-1, 1)}
            joint["omega"] = ["w0", "w1", "w2"]

    def joint_placed(self, joint: dict) -> None:
        q = self.coordinate("j1", "angle", 0.3, self.number(-1, 1))
        joint |= {"at": self.v(f"l*cos({q})", f"h*{q}^2", f"l*sin(2*{q})"), "angle": f"2*{q}"}
        if self.levels["joint_with"] == "moving_seat":
            joint["angle"] = f"2*{q} - w*t"

    def joint_path(self, joint: dict) -> None:
        s = self.coordinate("j1", "length", 0.3, self.number(0.2, 1))
        pieces = [{"line": 0.5}, {"arc": "l", "turn": "ccw", "angle": 1.2}, {"line": "l"}]
        if self.rng.random() < 0.5:
            pieces = pieces[1:]
        if self.levels["units"] != "none":
            pieces = [{**p, **({"line": {"value": 0.5, "unit": "m"}} if p.get("line") == 0.5 else {})} for p in pieces]
        joint |= {"along": s, "heading": 0.3, "pieces": pieces}

    def joint_fixed(self, joint: dict) -> None:
        joint |= {"angle": 0.3}
        if not self.coordinates:
            name = self.coordinate("b", "angle", 0.2, 0.5)
            self.body("base", self.joint("revolute", angle=name), "given")
            joint["on"] = self.host = "base"

    def joint_cylindrical(self, joint: dict) -> None:
        s = self.coordinate("j1", "length", 0.2, self.number(-1, 1))
        joint |= {
            "displacement": s,
            "angle": self.coordinate("j2", "angle", 0.4, self.number(-1, 1)),
            "axis": [1, 2, 2],
        }

    def joint_screw(self, joint: dict) -> None:
        joint |= {"angle": self.coordinate("j1", "angle", 0.4, self.number(-1, 1)), "pitch": "h/3", "axis": [0, 3, 4]}

    def joint_universal(self, joint: dict) -> None:
        two = [self.coordinate(f"j{k}", "angle", 0.3 * k, self.number(-1, 1)) for k in (1, 2)]
        joint |= {"axes": [[1, 0, 0], self.rng.choice([[0, 1, 0], [0, 3, 4]])], "angles": two}

    def joint_spherical(self, joint: dict) -> None:
        self.orientation(joint, self.rng.choice(["zxz", "xyz"]))

    def joint_quaternion(self, joint: dict) -> None:
        joint["kind"] = "spherical"
        self.orientation(joint, "quaternion")

    # contacts

    def contact(self) -> None:
        how = self.levels["contact"]
        if how == "none":
            return
        x = self.coordinate("p1", "length", 0.0, {"open": 0.2, "bouncing": 0.2, "sticking": 0.0}.get(how, 0.8))
        down = self.v(0, "-g") if self.plane else [0, 0, "-g"]
        self.forces["own_weight"] = {"kind": "gravity", "acceleration": down, "bodies": ["puck"]}
        if how == "ending":
            y = self.coordinate("p2", "length", -0.5, 0.0)
            if self.plane:
                self.particle("puck", {"kind": "planar", "x": x, "y": y, "angle": 0})
            else:
                z = self.coordinate("p3", "length", 0.0, 0.3)
                self.particle("puck", {"kind": "placed", "at": [x, z, y], "angle": 0})
            self.points["peg"] = self.v(0, 0, 0)
            self.constraints["thread"] = {
                "kind": "link",
                "points": ["peg", "puck.center"],
                "length": 0.5,
                "unilateral": True,
            }
            if self.levels["units"] != "none":
                self.constraints["thread"]["length"] = {"value": 0.5, "unit": "m"}
            old = self.coordinates["p1"]
            scale = 100.0 if isinstance(old, dict) and old.get("unit") == "cm" else 1.0
            self.coordinates["p1"] = {**old, "speed": round(4.4 * scale, 6)}
            return
        if how == "bouncing" and self._is_rough:
            del self.coordinates["p1"]
            self.rough_contact()
            return
        y = self.coordinate("p2", "length", 0.06 if how in ("open", "bouncing") else 0.0)
        place: list = [x, y]
        normal: list = [0, 1]
        if not self.plane:
            z = self.coordinate("p3", "length", 0.0, 0.0 if how == "sticking" else 0.3)
            place, normal = [x, z, y], [0, 0, 1]
        self.particle("puck", {"kind": "placed", "at": place, "angle": 0})
        constraint = {
            "kind": "support",
            "point": "puck.center",
            "at": self.v(0, 0, 0),
            "normal": normal,
            "unilateral": True,
        }
        if how == "bouncing":
            constraint["restitution"] = 0.5
        if how in ("sliding", "sticking"):
            constraint["friction"] = "mu"
        if how == "sticking":
            side = self.v("mu*m*g/3", "-mu*m*g/4") if self.plane else ["mu*m*g/3", "mu*m*g/4", "-mu*m*g/5"]
            self.forces["own_push"] = {"kind": "force", "point": "puck.center", "force": side}
        if how == "viscous":
            constraint["friction"] = {"viscous": 0.3}
            if self.levels["units"] != "none":
                constraint["friction"] = {"viscous": {"value": 0.3, "unit": "s/m"}}
        self.constraints["floor"] = constraint

    @property
    def _is_rough(self) -> bool:
        """Whether what rebounds rubs too: not where friction is refused, of the rest two of three."""
        acting = {self.levels["force"], self.levels["second_force"]}
        if acting & {"potential", "kinetic", "generalized"} or self.levels["tie"] in ("gap", "rate"):
            return False
        return self.side.random() < 2 / 3

    def rough_contact(self) -> None:
        """A corner that rebounds with friction: of a point, a body in flight, an arm on a carrier that slides."""
        how = self.side.choice(("point", "tumbling", "arm"))
        if how == "arm" and self.plane:
            x = self.coordinate("p1", "length", 0.0, 0.4)
            angle = self.coordinate("p2", "angle", self.side.choice((-0.9, -2.0)))
            self.particle("carrier", {"kind": "prismatic", "at": [0, 0.55], "axis": [1, 0], "displacement": x})
            self.box("puck", self.joint("revolute", on="carrier.center", angle=angle), corner=[0.6, 0])
            self.bodies["puck"]["center"] = [0.3, 0.05]
        elif how == "point":
            x, y = self.coordinate("p1", "length", 0.0, 0.2), self.coordinate("p2", "length", 0.06)
            place = [x, y] if self.plane else [x, self.coordinate("p3", "length", 0.0, 0.3), y]
            self.particle("puck", {"kind": "placed", "at": place, "angle": 0})
        else:
            self.floating("puck", 0.0, 0.22, 0.5, corner=self.v(-0.15, -0.1, -0.1))
        self.constraints["floor"] = {
            "kind": "support",
            "point": "puck.center" if how == "point" else "puck.corner",
            "at": self.v(0, 0, 0),
            "normal": [0, 1] if self.plane else [0, 0, 1],
            "unilateral": True,
            "restitution": self.side.choice((0.5, 0.5, 0.2)),
            "friction": self.side.choice(("mu", "2*mu")),
        }
        law = self.side.choice(("poisson", "poisson", "energetic", "newton", None))
        self.impact = {} if law is None else {"law": law}

    # forces

    def force(self, name: str, how: str) -> None:
        rng, plane = self.rng, self.plane
        names = list(self.bodies)
        body = "tool" if rng.random() < 0.6 else rng.choice(names)
        others = [b for b in names if b != body]
        pointed = [b for b in names if "P" in self.bodies[b].get("points", {})]
        point = f"{body}.P" if body in pointed else f"{body}.origin"
        other = f"{rng.choice(others)}.origin" if others and rng.random() < 0.5 else "anchor"
        free = [
            q
            for q, x in self.coordinates.items()
            if not (isinstance(x, dict) and x.keys() & {"motion", "rate", "acceleration"})
        ]
        q = rng.choice([x for x in free if self.kinds[x] != "pure"] or list(self.coordinates))
        unit = "d*" if self.kinds[q] == "length" else ""
        strength = "F1" if "F1" in self.inputs else "F0*sin(w*t)"
        if other == "anchor" and how.startswith(
            ("spring", "damper", "between", "bumper", "rope", "hydraulic", "gas", "air")
        ):
            self.points["anchor"] = self.v(-1.3, 0.9, 0.7)
        two, own = [other, point], Random(f"{name}{how}{point}")
        cylinder = {
            "points": two,
            "areas": ["d^2/3", "d^2/7"],
            "volumes": ["3*d^3", "d^3"],
            "retracted": "d/9",
            "stroke": "12*d",
            "pressures": ["F0/d^2", "F0/(2*d^2)"],
        }
        gas = {"opening": own.choice(("sin(w*t)", 0.4, -0.7)), "conductance": "m*w*d^2/(9*F0)", "critical": 0.3}
        gas |= {"supply": own.choice(("F0/d^2", "9*F0/d^2")), "exhaust": "F0/(9*d^2)"}
        magic = {"B": 2.5, "C": 1.4, "D": "F0"}
        rated = {"opening": "0.4*sin(w*t)", "flow": "d^3*w/9", "drop": "F0/d^2", "supply": "3*F0/d^2"}
        if how == "spring_moved":
            self.bodies["tool"].setdefault("points", {})["S"] = self.v(
                f"l/3 + {unit or 'h*'}{q}/5".replace("d*", ""), "h", 0
            )
        made: dict[str, Any] | None = {
            "gravity": {"kind": "gravity", "acceleration": self.v(0, "-g", 0) if plane else [0, 0, "-g"]},
            "force": {
                "kind": "force",
                "point": point,
                "force": self.v(strength, f"-c*{q}'{'' if unit else '*d'}", "F0/2"),
            },
            "follower": {"kind": "force", "point": point, "force": self.v("F0", strength, "F0/3"), "axes": body},
            "couple": {
                "kind": "couple",
                "body": body,
                "couple": f"{strength}*d" if plane else ["M0", f"{strength}*d", "M0/2"],
            },
            "distributed": {
                "kind": "distributed",
                "body": body,
                "between": ["P", "origin"],
                "intensities": [self.v("F0/d", "0", "0"), self.v("F0/d", "-F0/(2*d)", "F0/d")],
            },
            "spring": {"kind": "spring", "points": two, "stiffness": "k", "length": "l"},
            "spring_along": {
                "kind": "spring",
                "points": two,
                "stiffness": "k",
                "length": "l",
                "along": self.v(3, 4, 0),
            },
            "spring_start": {"kind": "spring", "points": two, "stiffness": "k", "length": "start"},
            "spring_moved": {"kind": "spring", "points": [other, "tool.S"], "stiffness": "k", "length": "l"},
            "damper": {"kind": "damper", "points": two, "damping": "c"},
            "damper_along": {"kind": "damper", "points": two, "damping": "c", "along": self.v(1, 2, 2)},
            "torsion_spring": {"kind": "torsion_spring", "body": body, "stiffness": "kt", "rest": 0.1},
            "torsion_damper": {"kind": "torsion_damper", "body": body, "damping": "ct"},
            "between": {"kind": "between", "points": two, "pull": "k*d^3/r^2 + c*r'"},
            "potential": {"kind": "potential", "energy": f"k*{q}^2/2" if unit else f"kt*{q}^2/2 + kt*cos({q})"},
            "kinetic": {"kind": "kinetic", "energy": f"m*{q}'^2/4" if unit else f"I*(2 + sin({q}))*{q}'^2/4"},
            "generalized": {
                "kind": "generalized",
                "coordinate": q,
                "value": f"-c*{q}'" if unit else f"-ct*{q}' + {strength}*d",
            },
            "values": {"kind": "force", "point": point, "force": self.v(f"K_{name}({q})", f"K_{name}'({q})/2", "F0/3")},
            "bumper": {
                "kind": "bumper",
                "points": two,
                "stiffness": "k",
                "length": "4*d",
                **rng.choice(({}, {"exponent": 1.5, "dissipation": 0.3}, {"damping": "c/5"})),
            },
            "hydraulic": {
                "kind": "hydraulic_cylinder",
                **cylinder,
                "bulk": "9*k/d",
                **own.choice(({}, {"leakage": "d^5*w/(9*F0)"})),
                **own.choice(
                    (
                        {"flows": [f"d^3*w/9*sin(w*t) - d^5*w/F0/7*{name}_p_1", "d^3*w/9"]},
                        {"valve": rated},
                        {"valve": {**rated, "tank": "F0/(9*d^2)", "smooth": "F0/d^2"}},
                    )
                ),
            },
            "gas": {
                "kind": "pneumatic_cylinder",
                **cylinder,
                "exponent": own.choice((1, 1.3)),
                **own.choice(({}, {"outside": "F0/(3*d^2)", "length": "2*d"})),
            },
            "air": {
                "kind": "pneumatic_cylinder",
                **cylinder,
                "exponent": 1.3,
                **own.choice(
                    (
                        {"flows": ["m*w/9*sin(w*t)", f"m*w/9*({name}_p_1 - {name}_p_2)*d^2/F0"]},
                        {"valve": {**gas, "smooth": "F0/d^2"}},
                        {"valve": gas, "flows": ["m*w/9", 0]},
                    )
                ),
                "gas": 2,
                "temperature": 3,
            },
            "drag": {
                "kind": "drag",
                "point": point,
                "density": "m/d^3",
                "area": "d^2/3",
                "coefficient": 0.7,
                **own.choice(
                    ({}, {"medium": self.v("d*w", f"d*w*sin({q}{'/d' if unit else ''})", "d*w/3"), "smooth": "d*w"})
                ),
            },
            "plate": {
                "kind": "plate",
                "point": point,
                "density": "m/d^3",
                "area": "d^2/3",
                "lift": "1.5*sin(alpha) + 0.2*alpha",
                "medium": self.v("3*d*w", "d*w*sin(w*t)", "d*w/3"),
                **own.choice(({}, {"drag": "0.2 + alpha^2/9", "chord": self.v(3, 4, 0)})),
                **({} if plane else {"normal": [0, 0, -2]}),
            },
            "buoyancy": {
                "kind": "buoyancy",
                "point": point,
                "density": "m/d^3",
                "volume": "d^3/4",
                "acceleration": self.v(0, "-g", 0),
                **own.choice(({}, {"medium": self.v("d*w*sin(w*t)", "d*w", "d*w^2*t")})),
            },
            "added_mass": {
                "kind": "added_mass",
                "point": point,
                **own.choice(({}, {"medium": self.v("d*w*sin(w*t)", "d*w", "d*w^2*t")})),
                **(
                    {"diagonal": ["m/5", "m", "I/4"] if plane else ["m/5", "m", "m/2", "I/4", "I", "I/9"]}
                    if own.random() < 0.5
                    else {"matrix": _square(3 if plane else 6)}
                ),
            },
            "tyre": {
                "kind": "tyre",
                "point": point,
                "lateral": own.choice(
                    (
                        {"stiffness": "3*F0"},
                        {**magic, "relaxation": "d/3"},
                        {**magic, "E": -0.3},
                        {"stiffness": "3*F0", "grip": "F0"},
                    )
                ),
                **own.choice(({}, {"longitudinal": {**magic, "relaxation": "d/2"}, "rolling": "d*w*sin(w*t)"})),
                **own.choice(({}, {"combined": 0.01, "rolling": "d*w*sin(w*t)"})),
                "heading": self.v(*own.choice(((1, 0, 0), (3, 4, 0), (1, 2, 2)))),
                "smooth": "d*w",
            },
            "tyre_wheel": {
                "kind": "tyre",
                "point": point,
                "radius": "d/4",
                "longitudinal": own.choice(({"stiffness": "3*F0"}, magic, {**magic, "relaxation": "d/2"})),
                **({} if plane else {"lateral": {"stiffness": "2*F0", "relaxation": "d"}, "axle": [1, 2, 0]}),
                **own.choice(({}, {"combined": 0.02})),
                **own.choice(({}, {"up": self.v(3, 4, 1)})),
                "smooth": "d*w",
            },
            "rope": {
                "kind": "rope",
                "path": two,
                "stiffness": "k",
                "length": rng.choice(["l/5", "l*(1 + w*t)/9", "start"]),
                **rng.choice(({}, {"damping": "c/5"})),
            },
            "gear_mesh": {
                "kind": "gear_mesh",
                "bodies": [rng.choice(others), body] if others else [body, body],
                "ratio": rng.choice([-2, 1.5]),
                "stiffness": "kt",
                **rng.choice(({}, {"backlash": 0.1}, {"damping": "ct/5"})),
                **rng.choice(({}, {"efficiency": 0.9, "smooth": 0.7})),
            },
            "brake": {
                "kind": "brake",
                "body": body,
                "smooth": 0.7,
                "force" if self.bodies[body]["joint"]["kind"] == "prismatic" else "torque": "F0*sin(w*t)"
                if self.bodies[body]["joint"]["kind"] == "prismatic"
                else "kt*sin(w*t)",
            }
            if self.bodies[body]["joint"]["kind"] in ("revolute", "prismatic", "screw")
            else None,
            "belt": {
                "kind": "belt",
                "bodies": [rng.choice(others), body],
                "radii": ["h/9", "h/7"],
                "tension": "F0*(1 + sin(w*t))",
                "coefficient": 0.3,
                "wrap": 2.5,
                "smooth": {"value": 0.7, "unit": "m/s"} if self.levels["units"] != "none" else 0.7,
                **own.choice(({}, {"crossed": True})),
            }
            if others
            else None,
            "clutch": {
                "kind": "clutch",
                "bodies": [rng.choice(others), body],
                "smooth": 0.7,
                **own.choice(
                    ({"torque": "kt*sin(w*t)"}, {"normal": "F0", "coefficient": 0.3, "radius": "h", "faces": 2})
                ),
            }
            if others
            else None,
            "mass_flow": {
                "kind": "mass_flow",
                "point": point,
                "velocity": self.v("d*w", f"{q}'{'' if unit else '*d'}", "d*w/3"),
                "axes": body,
                "rate": "-m*w/7",
            },
            "rain": {"kind": "mass_flow", "point": point, "absolute": self.v("d*w/2", "-d*w", 0), "rate": "m*w/5"},
            "none": None,
        }[how]
        if how == "values":
            declared = self.coordinates[q]
            at_unit = declared.get("unit") if isinstance(declared, dict) else None
            scale = {"deg": 180 / math.pi, "cm": 100.0}.get(at_unit or "", 1.0)
            at = [round(x * scale, 3) for x in (-0.8, 0.1, 0.9, 2.0)]
            way = rng.choice(({}, {"between": "cubic"}, {"between": "linear"}))
            self.tables[f"K_{name}"] = {"at": at, "values": [-2.5, 1, 2.5, 7], **way}
            if at_unit:
                self.tables[f"K_{name}"] |= {"at_unit": at_unit}
            if self.levels["units"] == "si" and at_unit:
                made["force"][1] = made["force"][1].replace("/2", "*d/2" if unit else "/2")
                self.tables[f"K_{name}"] |= {"unit": "N"}
        if made is None:
            return
        if how == "distributed" and body not in pointed:
            made["body"] = "tool"
        if how.startswith("torsion") and self.levels["joint"] in ("free", "planar") and made["body"] == "tool":
            made["rest"] = made.get("rest", 0.1)
            made = {k: x for k, x in made.items() if not (k == "rest" and how == "torsion_damper")}
        if how == "torsion_spring" and len(others) > 0 and rng.random() < 0.4:
            made = {"kind": "torsion_spring", "bodies": [rng.choice(others), body], "stiffness": "kt"}
        self.forces[name] = made

    def input(self) -> None:
        how = self.levels["input"]
        N = {} if self.levels["units"] == "none" else {"unit": "N"}
        if how == "expression":
            self.inputs["F1"] = "F0*cos(w*t)"
        if how in ("table", "controller"):
            self.inputs["F1"] = {"value": {"samples": [[0, 0], [0.4, 2.5], [1, -1], [2, 1]]}, **N}
        if how == "steps":
            self.inputs["F1"] = {"value": {"samples": [[0, 1], [0.4, 2.5], [1, -1]], "between": "steps"}, **N}
        if how == "controller":
            self.inputs["F1"] = {"value": 0.5, **N}

    def used_input(self) -> None:
        """An input that nothing uses is an error."""
        if "F1" in self.inputs and "F1" not in repr(self.forces) + repr(self.bodies):
            body = "tool"
            self.forces["push"] = {"kind": "force", "point": f"{body}.origin", "force": self.v("F1", "0.2*F1", "-F1/3")}

    def declared_speed(self) -> None:
        free = [
            q
            for q, x in self.coordinates.items()
            if self.kinds[q] != "pure"
            and not (isinstance(x, dict) and x.keys() & {"motion", "rate", "acceleration", "dependent"})
        ]
        if self.levels["speeds"] != "declared" or not free:
            return
        q = self.rng.choice(free)
        same = [x for x in free if x != q and self.kinds[x] == self.kinds[q]]
        same = same[:1]
        more = f" + {same[0]}'/3" if same else ""
        self.speeds["u1"] = {"rate": f"2*{q}'{more}", "start": 0.3}
        if same:
            self.speeds["u2"] = {"rate": f"{same[0]}' - {q}'/2", "start": -0.2}
        for name in (q, *same):
            old = self.coordinates[name]
            if isinstance(old, dict):
                old.pop("speed", None)

    def state(self) -> None:
        """What follows a coordinate late, or its acceleration, or a reaction; what pushes by it."""
        how = self.levels["state"]
        if how == "none":
            return
        q = self.rng.choice([x for x in self.coordinates if self.kinds[x] != "pure"])
        unit = "m" if self.kinds[q] == "length" else "rad"
        held = [b for b, x in self.bodies.items() if x["joint"]["kind"] not in ("placed", "free", "planar")]
        if how == "reacting" and held:
            declared = {"rate": f"w*(reaction_x({held[0]})/F0 - z1)", "unit": "1"}
        elif how in ("accelerated", "reacting"):
            declared = {"rate": f"{q}'' - w*z1", "unit": f"{unit}/s"}
        else:
            declared = {"rate": f"w*({q} - z1) + {q}'/3" if self.rng.random() < 0.5 else f"w*({q} - z1)", "unit": unit}
        if self.levels["units"] == "none":
            del declared["unit"]
        self.states["z1"] = {**declared, "start": self.number(-0.5, 0.5)}
        self.outputs["rate_z1"] = "z1'"
        if how == "pushes":
            push = "k*z1" if unit == "m" else "F0*z1"
            point = f"{self.rng.choice(list(self.bodies))}.origin"
            self.forces["lag"] = {"kind": "force", "point": point, "force": self.v(push, f"-{push}/2", f"{push}/3")}

    def ask(self) -> None:
        how = self.levels["output"]
        first = next(iter(self.coordinates))
        self.outputs |= {f"acc_{q}": f"{q}''" for q in list(self.coordinates)[:6]}
        if how == "kinematics":
            self.outputs |= {"o1": "x(tool.P)", "o2": "vy(tool.P)", "o3": "speed(tool.P)", "o4": "ax(tool.P)"}
            self.outputs["o5"] = "angle(tool)" if self.plane else "omega_z(tool)"
        if how == "energies":
            self.outputs |= {"o1": "kinetic_energy()", "o2": "power()", "o3": "kinetic_energy(tool)"}
        if how == "reactions":
            held = [b for b, x in self.bodies.items() if x["joint"]["kind"] not in ("placed", "free", "planar")]
            self.outputs |= {"o1": f"reaction_x({held[0]})", "o2": f"reaction_y({held[-1]})"} if held else {}
        if how == "inertia":
            self.outputs |= {
                "o1": "mass_of(tool)",
                "o2": "angular_momentum_z(tool.P)",
                "o3": "inertia_tensor(tool.P, z, z, tool)",
            }
        if how == "of_a_run":
            self.outputs |= {"o1": f"max({first})", "o2": f"mean({first}^2)", "o3": f"last({first}')"}
        if how == "at_instant":
            self.outputs |= {
                "o1": {"value": f"{first}", "at": "t = 0.2"},
                "o2": {"value": f"{first}'", "at": "t = 0.1"},
            }
        if how == "equilibrium":
            self.outputs |= {"o1": {"value": first, "at": "equilibrium"}}

    def parameters(self, text: str) -> dict[str, Any]:
        import re

        words = set(re.findall(r"[A-Za-z_]\w*", text))
        values = {
            "m": self.number(0.5, 3),
            "I": self.number(0.5, 1.5),
            "l": self.number(0.6, 1.2),
            "h": self.number(0.15, 0.3),
            "g": 9.81,
            "k": self.number(5, 40),
            "c": self.number(0.1, 0.8),
            "kt": self.number(2, 20),
            "ct": self.number(0.1, 0.8),
            "A": self.number(0.2, 0.6),
            "B": self.number(0.05, 0.2),
            "w": self.number(0.8, 2.5),
            "F0": self.number(1, 5),
            "M0": self.number(0.5, 2),
            "mu": self.number(0.1, 0.4),
            "d": 1.0,
        }
        found: dict[str, Any] = {}
        for name, x in values.items():
            if name in words:
                found[name] = self.parameter(name, x)
        if self.levels["parameters"] == "formulas" and "l" in found:
            found["l0"] = found.pop("l")
            found["l"] = "1.5*l0 - l0/3"
        if self.levels["parameters"] == "formulas" and "m" in found:
            found["m0"] = found.pop("m")
            found["m"] = "m0*sqrt(2)"
        if self.levels["parameters"] == "valueless":
            name = self.rng.choice([x for x in ("m", "g", "k", "F0", "c", "I") if x in found])
            found[name] = (
                {k: x for k, x in found[name].items() if k != "value"} if isinstance(found[name], dict) else {}
            )
            if self.levels["units"] != "none":
                found[name] |= {"unit": DIMENSIONS[name][0]}
        if self.levels["symbols"] == "declared":
            for name, mark in (("m", r"m_C"), ("k", r"\hat k"), ("w", r"\Omega")):
                if name in found and not isinstance(found[name], str):
                    old = found[name] if isinstance(found[name], dict) else {"value": found[name]}
                    found[name] = {**old, "symbol": mark}
        return found

    def parameter(self, name: str, x: float) -> Any:
        how = self.levels["units"]
        if how == "none":
            return x
        si, other, scale = DIMENSIONS[name]
        return {"value": x, "unit": si} if how == "si" else {"value": round(x * scale, 6), "unit": other}

    def model(self) -> dict[str, Any]:
        self.base()
        self.loops()
        self.constraint()
        self.featured()
        self.contact()
        if self.levels["base"] == "all_driven":
            self.all_driven()
        self.input()
        self.force("f1", self.levels["force"])
        self.force("f2", self.levels["second_force"])
        self.used_input()
        self.declared_speed()
        self.state()
        self.ask()
        if self.levels["symbols"] == "declared":
            self.bodies["tool"]["symbol"] = "T"
            self.bodies["tool"]["joint"]["symbol"] = "Q"
        body = {
            "coordinates": self.coordinates,
            "speeds": self.speeds,
            "states": self.states,
            "inputs": self.inputs,
            "tables": self.tables,
            "points": self.points,
            "bodies": self.bodies,
            "constraints": self.constraints,
            "forces": self.forces,
            "outputs": self.outputs,
        }
        head: dict[str, Any] = {"eomgen": 1, "name": "drawn", "space": self.levels["space"]}
        if self.impact is not None:
            body["impact"] = self.impact
        return {**head, "parameters": self.parameters(toml(body)), **body}

    def all_driven(self) -> None:
        """Everything that is still free moves as given."""
        for k, (q, kind) in enumerate(self.kinds.items()):
            if q != "b":
                amplitude = "A" if kind == "angle" else "B"
                self.coordinates[q] = {"motion": f"{amplitude}*sin(w*t + {k})"}
