"""What models are drawn from: factors with their levels, and pairs of levels that cannot be, each with its reason.

A pair that cannot be is refused by the product where it can be written down at all (`refused`: the model and words of
the message); it covers nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

ROUND: dict[str, Any] = {"radius": "l/2"}
SHAPES: dict[str, dict[str, Any]] = {
    "particle": {},
    "rod": {"length": "l"},
    "disc": ROUND,
    "ring": ROUND,
    "rectangle": {"width": "l", "height": "h"},
    "triangle": {"width": "l", "height": "h"},
    "polygon": {"vertices": [[0, 0], ["l", 0], ["l", "h"], [0, "2*h"]]},
    "sphere": ROUND,
    "cylinder": {"radius": "h", "length": "l"},
    "box": {"size": ["l", "h", "h/2"]},
    "cone": {"radius": "h", "height": "l"},
    "ellipsoid": {"semiaxes": ["l", "h", "h/2"]},
    "arc": {"radius": "l", "opening": 1.2},
    "annulus": {"radius": "l", "inner": "l/3"},
    "sector": {"radius": "l", "opening": 1.2},
    "ellipse": {"semiaxes": ["l", "h"]},
    "hollow_sphere": {"radius": "l", "inner": "l/2"},
    "spherical_shell": ROUND,
    "hemisphere": ROUND,
    "hemispherical_shell": ROUND,
    "tube": {"radius": "h", "inner": "h/2", "length": "l"},
    "cylindrical_shell": {"radius": "h", "length": "l"},
    "prism": {"vertices": [[0, 0], ["l", 0], [0, "h"]], "length": "h"},
    "conical_shell": {"radius": "h", "height": "l"},
    "frustum": {"radius": "l/2", "top": "h", "height": "l"},
    "pyramid": {"width": "l", "depth": "h", "height": "l"},
    "tetrahedron": {"vertices": [[0, 0, 0], ["l", 0, 0], [0, "l", 0], [0, 0, "h"]]},
    "torus": {"major": "l", "minor": "h/2"},
}
"""shape -> its sizes in a model that is drawn"""

FORCES = (
    "gravity", "force", "follower", "couple", "distributed", "spring", "spring_along", "spring_start", "spring_moved",
    "damper", "damper_along", "torsion_spring", "torsion_damper", "between", "potential", "kinetic", "generalized",
    "values", "mass_flow", "rain", "bumper", "hydraulic", "gas", "air",
    "rope", "gear_mesh", "clutch", "brake", "belt", "drag", "plate", "buoyancy", "added_mass",
    "tyre", "tyre_wheel", "none",
)  # fmt: skip

FACTORS: dict[str, tuple[str, ...]] = {
    "space": ("plane", "space"),
    "base": (
        "ground", "turning", "sliding", "by_formula", "by_rate", "by_acceleration", "by_samples", "by_samples_rate",
        "by_tie", "placed", "all_driven",
    ),
    "loop": ("none", "four_bar", "slider_crank", "two_loops", "on_base"),
    "tie": (
        "none", "support", "clamp", "guide", "slider", "link", "rolling", "skate", "string",
        "capstan", "gear", "gap", "rate",
        "points", "motion",
    ),
    "closure": ("multipliers", "dependent", "near"),
    "joint": (
        "revolute", "prismatic", "planar", "free", "placed", "path", "fixed", "cylindrical", "screw", "universal",
        "spherical", "quaternion",
    ),
    "joint_with": (
        "nothing", "spring_damper", "drive", "armature", "turned", "moving_seat", "point", "stops", "rubbing",
    ),
    "shape": (*SHAPES, "parts", "given", "massless", "leaking"),
    "force": FORCES,
    "second_force": FORCES,
    "contact": ("none", "open", "closed", "sliding", "sticking", "ending", "viscous", "bouncing"),
    "speeds": ("rates", "declared", "omega"),
    "input": ("none", "expression", "table", "steps", "controller"),
    "state": ("none", "follows", "pushes", "accelerated", "reacting"),
    "units": ("none", "si", "other"),
    "parameters": ("numbers", "formulas", "valueless"),
    "symbols": ("plain", "declared"),
    "output": ("kinematics", "energies", "reactions", "inertia", "of_a_run", "at_instant", "equilibrium", "none"),
}  # fmt: skip


@dataclass(frozen=True)
class Forbidden:
    """Two levels that cannot stand together, and why."""

    one: tuple[str, str]
    two: tuple[str, str]
    why: str
    refused: str = ""  # words of the product's message; "": nothing that could be written down


def _each(one: tuple[str, str], factor: str, levels: tuple[str, ...], why: str, refused: str = "") -> list[Forbidden]:
    return [Forbidden(one, (factor, level), why, refused) for level in levels]


FORBIDDEN: tuple[Forbidden, ...] = (
    *_each(
        ("space", "plane"),
        "joint",
        ("cylindrical", "screw", "universal", "spherical", "quaternion"),
        "a joint of space",
        "space",
    ),
    *_each(
        ("space", "space"),
        "force",
        ("torsion_spring", "torsion_damper"),
        "in space it stands in the joint",
        "no single angle in space",
    ),
    *_each(
        ("space", "space"),
        "second_force",
        ("torsion_spring", "torsion_damper"),
        "in space it stands in the joint",
        "no single angle in space",
    ),
    *(
        Forbidden(("space", "space"), (factor, kind), "about the axis of a hinge, which not every joint has")
        for factor in ("force", "second_force")
        for kind in ("clutch", "brake", "belt")
    ),
    *(
        Forbidden(("space", "space"), (factor, "gear_mesh"), "its wheels are of the plane", "turn in one plane")
        for factor in ("force", "second_force")
    ),
    Forbidden(("space", "plane"), ("speeds", "omega"), "omega needs three components", "omega"),
    *_each(
        ("speeds", "omega"),
        "joint",
        tuple(x for x in FACTORS["joint"] if x not in ("quaternion", "free", "placed")),
        "no quaternion",
        "omega",
    ),
    Forbidden(("speeds", "omega"), ("joint", "placed"), "no quaternion", "moves no mass"),
    *_each(
        ("joint_with", "spring_damper"),
        "joint",
        ("planar", "free", "placed", "path", "fixed", "cylindrical", "universal", "spherical", "quaternion"),
        "no one variable that a spring could act along",
        "unknown",
    ),
    *_each(
        ("joint_with", "rubbing"),
        "joint",
        ("planar", "free", "placed", "path", "fixed", "cylindrical", "universal", "spherical", "quaternion"),
        "no one variable that could rub",
        "unknown",
    ),
    *_each(
        ("joint_with", "stops"),
        "joint",
        ("free", "placed", "path", "fixed"),
        "no variable that a stop could hold",
        "unknown",
    ),
    Forbidden(
        ("joint_with", "stops"), ("joint", "quaternion"), "no angle that a stop could hold", "limits are of angles"
    ),
    Forbidden(("base", "all_driven"), ("joint_with", "stops"), "no stop holds a joint that is driven", "is driven"),
    *_each(
        ("joint_with", "armature"),
        "joint",
        ("planar", "free", "placed", "path", "fixed", "cylindrical", "universal", "spherical", "quaternion"),
        "no one variable that a rotor could turn with",
        "unknown",
    ),
    *_each(
        ("joint_with", "drive"),
        "joint",
        ("planar", "free", "placed", "path", "fixed", "universal", "spherical", "quaternion"),
        "no one variable that a drive could act along",
        "unknown",
    ),
    *_each(
        ("shape", "massless"),
        "joint",
        tuple(x for x in FACTORS["joint"] if x != "fixed"),
        "a free coordinate moves no mass",
        "mass",
    ),
    *_each(("base", "all_driven"), "closure", ("dependent", "near"), "nothing is free that could depend"),
    *_each(
        ("base", "all_driven"),
        "contact",
        ("open", "closed", "sliding", "sticking", "ending", "viscous", "bouncing"),
        "nothing is free that could leave a contact",
        "no free coordinate moves it",
    ),
    *_each(
        ("base", "all_driven"),
        "loop",
        ("four_bar", "slider_crank", "two_loops", "on_base"),
        "loops determine what would be driven",
        "no free coordinate moves it",
    ),
    *_each(
        ("base", "all_driven"),
        "tie",
        tuple(x for x in FACTORS["tie"] if x != "none"),
        "constraints determine what would be driven",
        "no free coordinate moves it",
    ),
    *_each(("base", "all_driven"), "joint", ("quaternion",), "a quaternion is free", "is driven"),
    *_each(("base", "all_driven"), "speeds", ("declared", "omega"), "no rate is free that a speed could stand for"),
    *_each(("base", "ground"), "loop", ("on_base",), "there is no base that moves"),
    Forbidden(("joint", "spherical"), ("shape", "particle"), "its turn about itself moves no mass", "moves no mass"),
    Forbidden(("joint", "spherical"), ("shape", "rod"), "its turn about itself moves no mass", "no inertia"),
    Forbidden(("joint", "quaternion"), ("shape", "particle"), "its turn about itself moves no mass", "moves no mass"),
    Forbidden(("joint", "quaternion"), ("shape", "rod"), "its turn about itself moves no mass", "moves no mass"),
    Forbidden(("speeds", "omega"), ("shape", "particle"), "its turn about itself moves no mass", "moves no mass"),
    Forbidden(("speeds", "omega"), ("shape", "rod"), "its turn about itself moves no mass", "moves no mass"),
    *(
        Forbidden(
            ("contact", contact),
            (factor, force),
            "friction needs reactions, which do not follow",
            "acts on coordinates",
        )
        for contact in ("sliding", "sticking", "viscous")
        for factor in ("force", "second_force")
        for force in ("potential", "kinetic", "generalized")
    ),
    *_each(
        ("tie", "gap"),
        "contact",
        ("sliding", "sticking", "viscous"),
        "friction needs reactions, which do not follow",
        "acts on coordinates",
    ),
    *_each(
        ("tie", "rate"),
        "contact",
        ("sliding", "sticking", "viscous"),
        "friction needs reactions, which do not follow",
        "acts on coordinates",
    ),
)


def forbidden(a: tuple[str, str], b: tuple[str, str]) -> Forbidden | None:
    """Why two levels cannot stand together, or None."""
    return _INDEX.get((a, b)) or _INDEX.get((b, a))


_INDEX = {(f.one, f.two): f for f in FORBIDDEN}


TRIPLES: tuple[tuple[dict[str, str], str], ...] = tuple(
    ({"space": "space", "joint": "free", "shape": shape}, "its turn about itself moves no mass")
    for shape in ("particle", "rod")
)


def fits(row: dict[str, str]) -> bool:
    """Whether no three levels of a row contradict one another."""
    return not any(all(row.get(f) == x for f, x in triple.items()) for triple, _ in TRIPLES)


Item = tuple[str, str]
Pair = tuple[Item, Item]


def all_pairs() -> list[Pair]:
    names = list(FACTORS)
    return [
        ((f, x), (g, y)) for i, f in enumerate(names) for g in names[i + 1 :] for x in FACTORS[f] for y in FACTORS[g]
    ]


def why_not(a: Item, b: Item) -> str:
    """Why two levels cannot stand together, "" where they can: forbidden, or no level of a third factor fits both."""
    own = forbidden(a, b)
    if own is not None:
        return own.why
    for f, levels in FACTORS.items():
        if f not in (a[0], b[0]) and all(forbidden((f, x), a) or forbidden((f, x), b) for x in levels):
            return f"no {f} fits both"
    return ""


@cache
def possible_pairs() -> frozenset[Pair]:
    """Every pair of levels of two factors that can be."""
    return frozenset(pair for pair in all_pairs() if not why_not(*pair))


def pairs_of(levels: dict[str, str]) -> set[Pair]:
    names = list(FACTORS)
    return {((f, levels[f]), (g, levels[g])) for i, f in enumerate(names) for g in names[i + 1 :]}
