"""MJCF -> tables of a model file, by MuJoCo's own reader and compiler (the extra `[mujoco]`).

The model as MuJoCo has compiled it is imported, with defaults, inertias of geoms, names of meshes. A body's joints
become joints one after the other, with frames without mass between them; each sits at its own place in the body.
A position of a hinge or slide counts from `ref`; free and ball joints turn by quaternions, scalar first, with the
angular velocity in the body's axes, as here.
"""

from __future__ import annotations

import importlib
import math
import re
import warnings
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

from eomgen.errors import ModelError, ToolMissing
from eomgen.files import read
from eomgen.model import InertiaMatrix
from eomgen.robots.mjcf_acting import (
    BALL,
    FREE,
    HINGE,
    CompiledRobot,
    equalities,
    motors,
    motors_in_space,
    rotors,
    start_of,
    tendons,
    turn_by,
)
from eomgen.robots.sdf_models import LARGEST
from eomgen.robots.tables import (
    NO_RANGE,
    STARTS_BEYOND,
    ZERO,
    Entries,
    Imported,
    Moved,
    Range,
    Seat,
    decimal_of_double,
    decimal_text,
    decimals,
    hung,
    inertia_in,
    reported_left,
    signed_sum,
    six,
    without_empty,
)
from eomgen.robots.urdf import free_joint, turned_freely, with_mass
from eomgen.symbolic.expression import Matrix
from eomgen.symbolic.numeric import tolerances

TABLES = ("points", "coordinates", "speeds", "inputs", "bodies", "constraints", "forces")


def mjcf(path: Path, data: bytes) -> Imported:
    """The tables of a robot; `data` is the text of the file, which may be a pipe.

    Raises:
        ToolMissing: MuJoCo is not installed.
        ModelError: MuJoCo cannot read it; it says why.
    """
    return _tables(CompiledRobot(_switched(compiled(spec_of(path, data))), path.stem))


def _switched(m: Any) -> Any:
    """Compiled model without the parts that its flags switch off."""
    mujoco: Any = importlib.import_module("mujoco")
    kinds = ("jnt_stiffness", "tendon_stiffness"), ("dof_damping", "tendon_damping", "actuator_damping")
    springs, dampers = (
        tuple(getattr(m, f"{name}{of}") for name in names for of in ("", "poly") if hasattr(m, f"{name}{of}"))
        for names in kinds
    )
    for flag, values in (
        ("GRAVITY", (m.opt.gravity,)),
        ("SPRING", springs),
        ("DAMPER", dampers),
        ("PASSIVE", springs + dampers),  # so before MuJoCo 3.4
        ("EQUALITY", (m.eq_active0,)),
        ("LIMIT", (m.jnt_limited, m.tendon_limited)),
        ("FRICTIONLOSS", (m.dof_frictionloss,)),
        ("CONSTRAINT", (m.eq_active0, m.jnt_limited, m.tendon_limited, m.dof_frictionloss)),
    ):
        if m.opt.disableflags & int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}", 0)):
            for each in values:
                each[:] = 0
    return m


def _tables(r: CompiledRobot) -> Imported:
    m = r.m
    r.found = {key: {} for key in TABLES}
    r.body = {0: None} | {k: r.bodies.new(m.body(k).name or f"body{k}", "body") for k in range(1, m.nbody)}
    r.joint = {j: r.names.new(m.joint(j).name or f"joint{j}", "q") for j in range(m.njnt)}
    r.sites = _sites(r)
    r.start = start_of(r)
    rotors(r)
    motors(r)
    for k in range(m.nbody):
        _body(r, k)
    motors_in_space(r)
    tendons(r)
    equalities(r)
    for k, own in r.points.items():  # those of constraints too, which come after the bodies
        if name := r.body[k]:
            r.found["bodies"][name]["points"] = {**r.found["bodies"][name].get("points", {}), **own}
    _rest(r)
    gravity = decimals(decimal_of_double(x) for x in m.opt.gravity)
    parameters = {}
    if any(gravity):
        acceleration: list[Any] = list(gravity)
        if not gravity[0] and not gravity[1]:
            g = r.names.new("g")
            parameters[g] = {"value": abs(gravity[2]), "unit": "m/s^2"}
            acceleration[2] = f"-{g}" if gravity[2] < 0 else g
        weight = {"kind": "gravity", "acceleration": acceleration}
        r.found["forces"] = {"weight": weight, **r.found["forces"]}
    head = {"eomgen": 1, "name": r.title, "space": "space"}
    left_out = tuple(reported_left(what, where, why) for (what, why), where in r.left.items())
    return Imported({**head, **without_empty({"parameters": parameters, **r.found})}, left_out)


def _body(r: CompiledRobot, k: int) -> None:
    m = r.m
    if k == 0:
        r.found["points"] = r.points.setdefault(0, {})
        return
    raw, name = m.body(k).name, r.body[k]
    assert name is not None
    body: Entries = {"about": f"body {raw}"} if raw and name != raw else {}
    mass = decimal_of_double(m.body_mass[k])
    if mass:
        R, _ = turn_by(m.body_iquat[k])
        xx, yy, zz = (decimal_of_double(x) for x in m.body_inertia[k])
        tensor = InertiaMatrix.of_moments(xx, yy, zz, ZERO, ZERO, ZERO)
        center = decimals(decimal_of_double(x) for x in m.body_ipos[k])
        body |= with_mass({"mass": mass}, center, six(tensor if R == Matrix.IDENTITY else inertia_in(R, tensor)))
    if r.points.get(k):
        body["points"] = dict(r.points[k])
    joints = range(m.body_jntadr[k], m.body_jntadr[k] + m.body_jntnum[k])
    R, turns = turn_by(m.body_quat[k])
    place = decimals(decimal_of_double(x) for x in m.body_pos[k])
    seat = Seat(r.body[int(m.body_parentid[k])], place, R, turns)
    if [m.jnt_type[j] for j in joints] == [FREE]:
        first = m.jnt_qposadr[joints[0]]
        seat, turn = Seat(None), tuple(decimal_of_double(x) for x in r.start[first + 3 : first + 7])
        place = decimals(decimal_of_double(x) for x in r.start[first : first + 3])
        moved = [free_joint(r.found, r.joint[joints[0]], r.names, place, turn)]
        _in_space(r, joints[0], moved[0].keys)
    else:
        moved = [_joint(r, j) for j in joints]
    r.found["bodies"] |= hung(name, body, seat, moved, r.bodies)
    if m.body_mocapid[k] >= 0:
        r.leave("motion of a mocap body", [name], "it stands still here")
    if m.body_gravcomp[k] and mass:
        _held_up(r, name, k)


def _joint(r: CompiledRobot, j: int) -> Moved:
    m, q = r.m, r.joint[j]
    pivot = decimals(decimal_of_double(x) for x in m.jnt_pos[j])
    if m.jnt_type[j] == BALL:
        turn = tuple(decimal_of_double(x) for x in r.start[m.jnt_qposadr[j] : m.jnt_qposadr[j] + 4])
        keys = {"kind": "spherical", **turned_freely(r.found, q, r.names, turn)}
        _in_space(r, j, keys)
        return Moved(keys, pivot, q)
    turns = m.jnt_type[j] == HINGE
    unit = "rad" if turns else "m"
    reference = decimal_of_double(m.qpos0[m.jnt_qposadr[j]])
    remark = [f"joint {m.joint(j).name}"] if m.joint(j).name not in ("", q) else []
    begun = decimal_of_double(r.start[m.jnt_qposadr[j]])
    stops = _stops(r, j, begun, unit, remark).moved(-reference).limits()
    start = {"start": begun} if begun else {}
    said = {"about": ", ".join(remark)} if remark else {}
    r.found["coordinates"][q] = {**start, "unit": unit, **said}
    variable = q if not reference else signed_sum([(Decimal(1), q)], -reference)
    axis = [decimal_of_double(x) for x in m.jnt_axis[j]]
    keys = {
        "kind": "revolute" if turns else "prismatic",
        "axis": axis,
        "angle" if turns else "displacement": variable,
    }
    if j in r.drives:
        keys["torque" if turns else "force"] = " + ".join(r.drives[j]).replace("+ -", "- ")
    return Moved({**keys, **_efforts(r, j, reference), **stops}, pivot if turns else decimals([0, 0, 0]), q)


def _stops(r: CompiledRobot, j: int, begun: Decimal, unit: str, remark: list[str]) -> Range:
    """The range of a hinge or slide; where the start is on or beyond its limits they are a remark."""
    if not r.m.jnt_limited[j]:
        return Range()
    own = Range(*(decimal_of_double(x) for x in r.m.jnt_range[j]))
    q, short = r.joint[j], Range(*(decimal_of_double(round(x, 6)) for x in r.m.jnt_range[j]))
    if own.empty:
        r.leave(NO_RANGE, [q], "the upper one is not above the lower one")
    elif not own.holds(begun):
        r.leave(STARTS_BEYOND, [q], "it starts on or beyond one of them, and MuJoCo pushes it back")
    else:
        r.leave("softness of limits", [q], "stops are rigid; those of MuJoCo yield by solref and solimp")
        return own
    remark += short.remark(unit)
    return Range()


def _efforts(r: CompiledRobot, j: int, reference: Decimal) -> Entries:
    """Spring, damper and rotor of a hinge or slide."""
    m, q, d = r.m, r.joint[j], int(r.m.jnt_dofadr[j])
    keys: Entries = {}
    if m.jnt_stiffness[j]:
        keys["stiffness"] = decimal_of_double(m.jnt_stiffness[j])
        rest = decimal_of_double(m.qpos_spring[m.jnt_qposadr[j]]) - reference
        if rest:
            keys["rest"] = rest
    if damping := r.added("joint", j, m.dof_damping[d], r.dampers):
        keys["damping"] = damping
    if rotor := r.added("joint", j, m.dof_armature[d], r.rotors):
        keys["armature"] = rotor
    away = decimal_of_double(m.qpos_spring[m.jnt_qposadr[j]])
    _bent(r, j, signed_sum([(Decimal(1), q)], -away))
    if any(r.numbers(["jnt_springyield"], j)):
        r.leave("springs that yield", [q])
    if m.jnt_actfrclimited[j]:
        low, high = m.jnt_actfrcrange[j]
        r.leave("limits of motors", [f"all at {q} ({low:g} to {high:g})"], "an input has none")
    if m.dof_frictionloss[d]:
        keys["friction"] = {"torque" if m.jnt_type[j] == HINGE else "force": decimal_of_double(m.dof_frictionloss[d])}
        r.leave("softness of frictionloss", [q], "it holds where it sticks; that of MuJoCo yields a little")
    return keys


def _in_space(r: CompiledRobot, j: int, keys: Mapping[str, Any]) -> None:
    """Reads dampers and rotors of a free or a ball joint; springs, friction and limits are left out."""
    m, q, d = r.m, r.joint[j], int(r.m.jnt_dofadr[j])
    places = keys.get("position", [])
    dofs = slice(d, d + len(places) + 3)
    kinds = {
        "yielding springs": r.numbers(["jnt_springyield"], j),
        "friction": m.dof_frictionloss[dofs],
        "limits": [m.jnt_limited[j]],
        "dampers that are not linear": r.numbers(["dof_dampingpoly"], dofs),
    }
    for what, values in kinds.items():
        if any(values):
            r.leave(f"{what} of free and ball joints", [q])
    rates = [*(f"{x}'" for x in places), *keys["omega"]]
    r.omega[j] = rates
    _spring_in_space(r, j, keys)
    damping, rotor = (
        [r.added("joint", j, x, of) for x in values[dofs]]
        for values, of in ((m.dof_damping, r.dampers), (m.dof_armature, r.rotors))
    )
    if any(rotor):
        energy = signed_sum([(a / 2, f"{rate}^2") for a, rate in zip(rotor, rates, strict=True)], weighed=True)
        r.found["forces"][r.forces.new(f"{q}_rotor", "rotor")] = {"kind": "kinetic", "energy": energy}
    if not any(damping):
        return
    body = int(m.jnt_bodyid[j])
    name, parent = r.body[body], r.body[int(m.body_parentid[body])]
    against = [signed_sum([(-c, rate)], weighed=True) for c, rate in zip(damping, rates, strict=True)]
    if places:
        drag = {"kind": "force", "point": f"{name}.origin", "force": against[:3]}
        r.found["forces"][r.forces.new(f"{q}_drag")] = drag
    couple = {"kind": "couple", "body": name, "couple": against[-3:], "axes": name}
    r.found["forces"][r.forces.new(f"{q}_damper")] = couple
    if parent is not None:
        back = [signed_sum([(c, rate)], weighed=True) for c, rate in zip(damping[-3:], rates[-3:], strict=True)]
        r.found["forces"][r.forces.new(f"{q}_damper")] = {**couple, "body": parent, "couple": back}


def _spring_in_space(r: CompiledRobot, j: int, keys: Mapping[str, Any]) -> None:
    """-(k + k1 |d| + k2 |d|^2) d of the way d of a free joint, and of the turn d of both, a vector in the body's axes.

    d = 2 atan2(|v|, w)/|v| v of the quaternion (w, v) from where the spring rests; |v| has a slope at rest:
    sqrt(v^2 + SLOPE_AT_REST).
    """
    m, adr, body = r.m, int(r.m.jnt_qposadr[j]), int(r.m.jnt_bodyid[j])
    k = [decimal_of_double(x) for x in (m.jnt_stiffness[j], *r.numbers(["jnt_stiffnesspoly"], j), 0, 0)][:3]
    if not any(k):
        return
    name, parent, places = r.body[body], r.body[int(m.body_parentid[body])], keys.get("position", [])
    rest = [decimal_of_double(x) for x in m.qpos_spring[adr : adr + len(places) + 4]]
    w, x, y, z, n, a = (r.names.new(f"{r.joint[j]}_{letter}") for letter in "wxyzna")

    def law(size: str) -> str:
        return signed_sum([(-k[1], size), (-k[2], f"{size}^2")], -k[0], weighed=True)

    if places:
        away = [
            f"{one} = {signed_sum([(Decimal(1), q)], -at)}" for one, q, at in zip((x, y, z), places, rest, strict=False)
        ]
        head = "; ".join([*away, f"{n} = sqrt({x}^2 + {y}^2 + {z}^2 + {tolerances.SLOPE_AT_REST:g})"])
        force = [f"{head}; ({law(n)})*{one}" for one in (x, y, z)]
        r.found["forces"][r.forces.new(f"{r.joint[j]}_spring")] = {
            "kind": "force",
            "point": f"{name}.origin",
            "force": force,
        }
    p, e = rest[-4:], keys["quaternion"]
    turn = [  # conj(p) e
        signed_sum(zip(factors, e, strict=True), weighed=True)
        for factors in (
            (p[0], p[1], p[2], p[3]),
            (-p[1], p[0], p[3], -p[2]),
            (-p[2], -p[3], p[0], p[1]),
            (-p[3], p[2], -p[1], p[0]),
        )
    ]
    head = "; ".join(
        [
            *(f"{one} = {text}" for one, text in zip((w, x, y, z), turn, strict=True)),
            f"{n} = sqrt({x}^2 + {y}^2 + {z}^2 + {tolerances.SLOPE_AT_REST:g})",
            f"{a} = 2*atan2({w}*{n}, {w}^2)/{n}",
        ]
    )
    size = f"(abs({a})*{n})"
    for owner, sign in ((name, ""), (parent, "-")):
        if owner is not None and (owner == name or not places):
            couple = [f"{head}; {sign}({law(size)})*{a}*{one}" for one in (x, y, z)]
            found = {"kind": "couple", "body": owner, "couple": couple, "axes": name}
            r.found["forces"][r.forces.new(f"{r.joint[j]}_spring")] = found


def _bent(r: CompiledRobot, j: int, x: str) -> None:
    """Reads the nonlinear part of springs and dampers of a hinge or slide.

    V = k1 x^3/3 + k2 x^4/4;  Q = -(c1 |q'| + c2 q'^2) q'
    """
    q = r.joint[j]
    for at, field in ((j, "jnt_stiffnesspoly"), (int(r.m.jnt_dofadr[j]), "dof_dampingpoly")):
        k1, k2 = ([decimal_of_double(x) for x in r.numbers([field], at)] + [ZERO] * 2)[:2]
        if not k1 and not k2:
            continue
        if at == j and field == "jnt_stiffnesspoly":
            terms = [f"{decimal_text(k)}/{n}*({x})^{n}" for k, n in ((k1, 3), (k2, 4)) if k]
            r.found["forces"][r.forces.new(f"{q}_spring")] = {"kind": "potential", "energy": " + ".join(terms)}
        else:
            value = signed_sum([(-k1, f"abs({q}')*{q}'"), (-k2, f"{q}'^3")], weighed=True)
            r.push(f"{q}_damper", q, value)


def _held_up(r: CompiledRobot, name: str, k: int) -> None:
    """Gravity taken off: a force at the mass centre."""
    factor = -float(r.m.body_gravcomp[k]) * float(r.m.body_mass[k])
    force = [decimal_of_double(factor * x) for x in r.m.opt.gravity]
    r.found["forces"][r.forces.new(f"{name}_held_up")] = {
        "kind": "force",
        "point": f"{name}.center",
        "force": force,
    }


def _sites(r: CompiledRobot) -> dict[int, str]:
    """Sites as points."""
    m = r.m
    return {s: r.point(int(m.site_bodyid[s]), m.site(s).name or f"site{s}", m.site_pos[s]) for s in range(m.nsite)}


def _rest(r: CompiledRobot) -> None:
    """Reports everything else in the file as left out."""
    m = r.m
    touching = [m.geom(g).name or f"geom{g}" for g in range(m.ngeom) if m.geom_contype[g] or m.geom_conaffinity[g]]
    drawn = [m.geom(g).name or f"geom{g}" for g in range(m.ngeom)]
    r.leave("geoms that touch", touching, "no contact is declared by a shape: see [constraints]")
    r.leave("geoms that are drawn", [name for name in drawn if name not in touching], "pictures only")
    pairs = [f"{drawn[m.pair_geom1[k]]} and {drawn[m.pair_geom2[k]]}" for k in range(m.npair)]
    r.leave("pairs of geoms that touch", pairs, "no contact is declared by a shape: see [constraints]")
    if m.opt.density or m.opt.viscosity:
        r.leave("fluid", [f"density {m.opt.density:g}, viscosity {m.opt.viscosity:g}"], "say its forces by [forces]")
    for what, size, why in (
        ("cameras", m.ncam, "pictures only"),
        ("lights", m.nlight, "pictures only"),
        ("sensors", m.nsensor, "outputs request measured quantities"),
        ("keyframes", m.nkey, "start values are set by --start"),
        ("flexible bodies", m.nflex, "bodies are rigid"),
        ("plugins", m.nplugin - sum(r.by_plugin(k) for k in range(len(m.actuator_trntype))), "code of a simulator"),
    ):
        r.leave(what, [str(size)] * bool(size), why)


# -------- mjcf files ------------------------------------------------------------------------------------------
# An MJCF file -> MuJoCo's own reading of it, pictures left away.


MOST_MADE = (
    3_000  # elements that <replicate> makes: MuJoCo takes the square of it, of 3000 some 3 s, and cannot be stopped
)
MOST_VALUES = 10_000_000  # values of one array that a file requests
SIZES = {  # elements with arrays as large as a number in the file, or as the product of several
    "hfield": ("nrow", "ncol"),
    "texture": ("width", "height"),
    "flexcomp": ("count",),
    "composite": ("count",),
    "numeric": ("size",),
    "size": ("nkey", "nuser_body", "nuser_jnt", "nuser_geom", "nuser_site", "nuser_cam", "nuser_tendon"),
}
ALONE = ("size",)  # of these each attribute is an array of its own
COMMENT = re.compile(r"<!--.*?-->", re.S)
TAG = re.compile(r"<\s*(/?)\s*([A-Za-z_]+)([^<>]*?)(/?)>", re.S)
ATTRIBUTE = re.compile(r"""([A-Za-z_]+)\s*=\s*["']([^"']*)["']""")
DEEPEST = 30  # files that include one another
NOT_THERE = "Error opening file"  # so MuJoCo says it


def spec_of(path: Path, data: bytes) -> Any:
    """Model of a file as MuJoCo reads it, without files of pictures, and of meshes that give no mass.

    Raises:
        ToolMissing: MuJoCo is not installed.
        ModelError: MuJoCo cannot read it; it says why.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError as error:
        raise ToolMissing("MJCF is read by MuJoCo, which is not installed", fix="pip install mujoco") from error
    _refuse_endless(path, data, path, 1, 0)
    try:
        try:
            return _read(mujoco, path, data)
        except ValueError as error:
            if NOT_THERE not in str(error):
                raise
        return _read(mujoco, path, data, meshes=False)
    except (ValueError, RuntimeError) as error:
        why = " ".join(str(error).split())
        fix = "put the file there" if NOT_THERE in why else "fix the file"
        raise ModelError(f"MuJoCo cannot read it: {why}", str(path), fix) from error


def _refuse_endless(path: Path, data: bytes, first: Path, times: int, depth: int) -> int:
    """Number of elements that replicas make of a file, and of those that it includes.

    Args:
        first: the first file; included files lie next to it.
        times: number of copies of this file.
    Raises:
        ModelError: too many elements; MuJoCo would request the memory for them, or work for hours.
    """
    text = data.decode("utf-8", "replace")
    text = COMMENT.sub(lambda found: "\n" * found[0].count("\n"), text)
    made, copies = 0, [times]
    for found in TAG.finditer(text):
        closes, tag, inner, closed = found.groups()
        if closes:
            if tag == "replicate" and len(copies) > 1:
                copies.pop()
            continue
        given = dict(ATTRIBUTE.findall(inner))
        where = f"{path}:{text.count(chr(10), 0, found.start()) + 1}:1"
        if tag == "replicate" and not closed:
            copies.append(copies[-1] * _product(given.get("count", "1")))
        elif tag == "include" and depth < DEEPEST and "file" in given:
            part = first.parent / given["file"]
            made += _refuse_endless(part, _included(part), first, copies[-1], depth + 1)
        made += copies[-1] if copies[-1] > 1 and tag != "replicate" else 0
        if made > MOST_MADE:
            what = f"replicas make more than {MOST_MADE} elements"
            raise ModelError(what, where, "make fewer: equations of so many bodies are not derived")
        sizes = [_product(given[key]) for key in SIZES.get(tag, ()) if key in given]
        if sizes and max(max(sizes), 1 if tag in ALONE else math.prod(sizes)) > MOST_VALUES:
            what = f"<{tag}> requests more than {MOST_VALUES} values"
            raise ModelError(what, where, "make it smaller: no equation depends on it")
    return made


def _included(path: Path) -> bytes:
    """Part of a file; empty where it is missing, which MuJoCo reports."""
    try:
        return read(path, LARGEST)
    except OSError:
        return b""


def _product(text: str) -> int:
    """Product of whole numbers; other values count as 1, as MuJoCo reports them."""
    words = text.split()
    return math.prod(int(word) for word in words) if all(word.isdigit() and len(word) < 20 for word in words) else 1


def compiled(spec: Any) -> Any:
    """Compiled model of MuJoCo, without its warnings of deprecated features."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()


def _read(mujoco: Any, path: Path, data: bytes, *, meshes: bool = True) -> Any:
    """Model of MuJoCo without textures.

    Without `meshes`, a mesh on a body whose mass is given, or that stands still, is replaced by a ball.
    """
    pipe = not path.is_file()
    spec = mujoco.MjSpec.from_string(data.decode()) if pipe else mujoco.MjSpec.from_file(str(path))
    spec.compiler.fusestatic = False
    for material in spec.materials:
        material.textures = ["" for _ in material.textures]
    for texture in list(spec.textures):
        _delete(spec, texture)
    if not meshes:
        by_geoms = spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
        _without_meshes(spec, mujoco.mjtGeom.mjGEOM_SPHERE, by_geoms)
    compiled(spec)
    return spec


def _without_meshes(spec: Any, ball: Any, by_geoms: bool) -> None:
    needed = set()
    for body in spec.bodies:
        for geom in body.geoms:
            if geom.meshname and (body.name == "world" or (body.explicitinertial and not by_geoms)):
                geom.type, geom.size[0], geom.meshname = ball, 1, ""
            needed.add(geom.meshname)
    for mesh in list(spec.meshes):
        if mesh.name not in needed:
            _delete(spec, mesh)


def _delete(spec: Any, what: Any) -> None:
    """Deletes an element, by the function that this version of MuJoCo has."""
    if hasattr(spec, "delete"):
        spec.delete(what)
    else:
        what.delete()
