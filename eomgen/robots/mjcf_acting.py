"""Tendons, equalities and motors of a compiled model of MuJoCo -> forces, constraints and inputs of a model file."""

from __future__ import annotations

import copy
import importlib
from collections.abc import Iterable
from dataclasses import field
from decimal import Decimal
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.robots.tables import (
    NO_COUNTERPART,
    ZERO,
    Entries,
    LegalNames,
    decimal_of_double,
    decimal_text,
    decimals,
    gap,
    in_file,
    signed_sum,
    turn_of,
    turned_by,
)
from eomgen.symbolic.expression import Matrix
from eomgen.symbolic.numeric import tolerances

CONNECT, WELD, JOINT, TENDON = range(4)  # the numbers of MuJoCo: of equalities,
SITE = 6  # of the objects that they connect
NEWTON_STEPS = 50
TURNING = 10  # index of the weight of the rotation of a weld relative to its position
BEYOND = (*("tendon_frictionloss", "tendon_stiffnesspoly", "tendon_dampingpoly", "tendon_springyield"),)
"""Properties of tendons without a counterpart."""


def tendons(r: CompiledRobot) -> None:
    """Springs and dampers of tendons."""
    m = r.m
    for t in range(m.ntendon):
        name, length = _tendon_name(r, t), r.length(t)
        stiff, damping = decimal_of_double(m.tendon_stiffness[t]), r.added("tendon", t, m.tendon_damping[t], r.dampers)
        rotor = r.added("tendon", t, sum(r.numbers(["tendon_armature"], t)), r.rotors)
        ends = r.ends(t)
        if any(r.numbers(["tendon_actfrclimited"], t)):
            low, high = m.tendon_actfrcrange[t]
            r.leave("limits of motors", [f"all at {name} ({low:g} to {high:g})"], "an input has none")
        if length is None and not ends:
            if stiff or damping or rotor or m.tendon_limited[t] or any(r.numbers(BEYOND, t)):
                r.leave("tendons through places", [name], "over more than two places")
            continue
        if m.tendon_limited[t]:
            r.leave("limits of tendons", [name], "no stop is declared by a limit")
        if any(r.numbers(BEYOND, t)):
            r.leave("friction, bent springs and dampers of tendons", [name])
        if rotor and length is None:
            r.leave("armature of tendons between places", [name])
        elif rotor and length and len(length) > 1:
            _tendon_rotor(r, name, length, rotor)
        low, high = (decimal_of_double(x) for x in m.tendon_lengthspring[t])
        if ends:
            _stretched(r, name, ends, stiff, damping, (low, high))
            continue
        assert length is not None
        if stiff:
            stretch, beyond = r.sum_of(length, -low), r.sum_of(length, -high)
            square = f"({stretch})^2" if low == high else f"(min({stretch}, 0)^2 + max({beyond}, 0)^2)"
            spring = {"kind": "potential", "energy": f"{decimal_text(stiff)}/2*{square}"}
            r.found["forces"][r.forces.new(name, "tendon")] = spring
        if damping:
            rate = r.sum_of(length, rate=True)
            for factor, q in length:
                r.push(f"{name}_{q}", q, f"{decimal_text(-factor * damping)}*({rate})")


def _tendon_rotor(r: CompiledRobot, name: str, length: list[tuple[Decimal, str]], rotor: Decimal) -> None:
    """a L'^2/2 of a tendon whose length L is a sum of joints'.

    MuJoCo has no entry of M between joints of which neither carries the other; nor has this energy.
    """
    number = {q: j for j, q in r.joint.items()}
    terms = []
    for k, (factor, q) in enumerate(length):
        terms.append((rotor * factor * factor / 2, f"{q}'^2"))
        for other, p in length[:k]:
            if _carries(r.m, number[q], number[p]) or _carries(r.m, number[p], number[q]):
                terms.append((rotor * factor * other, f"{p}'*{q}'"))
    energy = signed_sum(terms, weighed=True)
    r.found["forces"][r.forces.new(f"{name}_rotor", "rotor")] = {"kind": "kinetic", "energy": energy}


def _carries(m: Any, one: int, other: int) -> bool:
    """True if a joint moves the body of another."""
    dof, wanted = int(m.jnt_dofadr[other]), int(m.jnt_dofadr[one])
    while dof >= 0:
        if dof == wanted:
            return True
        dof = int(m.dof_parentid[dof])
    return False


def _stretched(
    r: CompiledRobot, name: str, ends: list[str], stiff: Decimal, damping: Decimal, rest: tuple[Decimal, Decimal]
) -> None:
    """The spring and the damper of a straight tendon; between two rest lengths it is slack."""
    low, high = rest
    if stiff and low == high:
        spring: Entries = {"kind": "spring", "points": ends, "stiffness": stiff, "length": low}
        r.found["forces"][r.forces.new(name, "tendon")] = spring
    elif stiff:
        beyond = f"min(r - {decimal_text(low)}, 0) + max(r - {decimal_text(high)}, 0)"
        law = {"kind": "between", "points": ends, "pull": f"{decimal_text(stiff)}*({beyond})"}
        r.found["forces"][r.forces.new(name, "tendon")] = law
    if damping:
        damper = {"kind": "damper", "points": ends, "damping": damping}
        r.found["forces"][r.forces.new(f"{name}_damper")] = damper


def equalities(r: CompiledRobot) -> None:
    """Constraints: of points, of bodies, of coordinates; in MuJoCo they give way, here they hold."""
    m = r.m
    for e in range(m.neq):
        raw = m.equality(e).name or f"tie{e}"
        if not m.eq_active0[e]:
            r.leave("equalities that are switched off", [raw])
            continue
        made = _equality(r, e, raw)
        if made is None:
            welded = int(m.eq_type[e]) == WELD
            r.leave("welds that cannot close" if welded else "equalities of other kinds", [raw])
            continue
        r.found["constraints"][r.bodies.new(raw, "tie")] = made
        r.leave("softness of equalities", [raw], "here they hold exactly")


def _equality(r: CompiledRobot, e: int, raw: str) -> Entries | None:
    m, kind = r.m, int(r.m.eq_type[e])
    first, second, data = int(m.eq_obj1id[e]), int(m.eq_obj2id[e]), m.eq_data[e]
    if kind in (CONNECT, WELD):
        if m.eq_objtype[e] == SITE:
            if kind == WELD:
                return _weld_of_sites(r, first, second, data)
            return {"kind": "pin", "points": [r.sites[first], r.sites[second]]}
        if kind == CONNECT:
            return {
                "kind": "pin",
                "points": [r.point(first, raw, data[:3]), r.point(second, raw, data[3:6])],
            }
        return _weld(r, first, second, raw, data)
    if kind not in (JOINT, TENDON):
        return None
    sides: list[tuple[str, Decimal, set[str]]] = []  # its variables, start and units
    for which in (first, second):
        if which < 0:
            sides.append(("", ZERO, set()))
        elif kind == JOINT:
            q = r.joint[which]
            sides.append((q, decimal_of_double(m.qpos0[m.jnt_qposadr[which]]), r.units([q])))
        else:
            length = r.length(which)
            if length is None:
                return None
            start = decimal_of_double(m.tendon_length0[which])
            sides.append((f"({r.sum_of(length)})", start, r.units(q for _, q in length)))
    (one, at, unit), (other, other_at, other_unit) = sides
    away = other if not other_at else f"({other} - {decimal_text(other_at)})".replace("- -", "+ ")
    powers = [(-decimal_of_double(c), away if n == 1 else f"{away}^{n}") for n, c in enumerate(data[:5]) if n]
    reported = [(c, power) for c, power in powers if c and other]
    same = unit == other_unit and len(unit) == 1 and all(power == away for _, power in reported)
    return {"kind": "equation", "gap": gap(one, reported, -at - decimal_of_double(data[0]), weighed=not same)}


def _weld(r: CompiledRobot, first: int, second: int, raw: str, data: Any) -> Entries | None:
    """Weld of two bodies in their positions at the start; None where they are welded in others."""
    mujoco, state = _at_start(r)
    back, there = state.xmat[first].reshape(3, 3).T, state.xmat[second].reshape(3, 3)
    away = back @ (state.xpos[second] + there @ data[:3] - state.xpos[first])
    turn = mujoco_matrix(mujoco, data[6:10])
    turns = data[TURNING] != 0  # else it holds a point alone
    if abs(away - data[3:6]).max() > tolerances.ROUNDING or (
        turns and abs(back @ there - turn).max() > tolerances.ROUNDING
    ):
        return None
    points = [r.point(first, raw, data[3:6]), r.point(second, raw, data[:3])]
    return {"kind": "clamp" if turns else "pin", "points": points}


def _weld_of_sites(r: CompiledRobot, first: int, second: int, data: Any) -> Entries | None:
    """Weld of two sites in their positions at the start; None where they are welded in others."""
    _, state = _at_start(r)
    turns, apart = data[TURNING] != 0, abs(state.site_xmat[first] - state.site_xmat[second]).max()
    away = abs(state.site_xpos[first] - state.site_xpos[second]).max()
    if away > tolerances.ROUNDING or (turns and apart > tolerances.ROUNDING):
        return None
    return {"kind": "clamp" if turns else "pin", "points": [r.sites[first], r.sites[second]]}


def _at_start(r: CompiledRobot) -> tuple[Any, Any]:
    """(MuJoCo, its state where the model starts)."""
    mujoco: Any = importlib.import_module("mujoco")
    state = mujoco.MjData(r.m)
    state.qpos[:] = r.start
    mujoco.mj_kinematics(r.m, state)
    return mujoco, state


def start_of(r: CompiledRobot) -> Any:
    """Positions that satisfy the welds, by Newton's steps on all equalities; else those of MuJoCo.

    dq = -J^+ phi
    """
    import numpy as np

    m = r.m
    if not any(m.eq_active0[e] and m.eq_type[e] == WELD for e in range(m.neq)):
        return m.qpos0
    mujoco: Any = importlib.import_module("mujoco")
    own = copy.copy(m)
    own.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    own.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    state = mujoco.MjData(own)
    for step in range(NEWTON_STEPS):
        mujoco.mj_fwdPosition(own, state)
        rows = state.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        gaps = state.efc_pos[rows]
        if abs(gaps).max(initial=0) < tolerances.ROUNDING / 10:
            if step:
                moved = [r.joint[j] for j in range(m.njnt) if state.qpos[m.jnt_qposadr[j]] != m.qpos0[m.jnt_qposadr[j]]]
                r.leave("start where constraints gape", moved, "the start is moved to where they close")
            return state.qpos.copy() if step else m.qpos0
        J = state.efc_J.reshape(-1, m.nv)[rows]
        mujoco.mj_integratePos(own, state.qpos, -np.linalg.lstsq(J, gaps, rcond=tolerances.RANK_NEARBY)[0], 1)
    return m.qpos0


def _tendon_name(r: CompiledRobot, t: int) -> str:
    return r.m.tendon(t).name or f"tendon{t}"


def mujoco_matrix(mujoco: Any, quaternion: Any) -> Any:
    """A rotation as MuJoCo has it."""
    import numpy as np

    found = np.zeros(9)
    mujoco.mju_quat2Mat(found, quaternion)
    return found.reshape(3, 3)


# -------- mjcf motors -----------------------------------------------------------------------------------------
# Motors of a compiled model of MuJoCo -> inputs and forces of a model file.


ON_JOINT, IN_PARENT, ON_TENDON, ON_SITE = 0, 1, 3, 4  # the numbers of MuJoCo: of the target of a motor,
FIXED, AFFINE = 0, 1  # of its laws
LIMITS = ("ctrl", "force", "act")
Length = list[tuple[Decimal, str]]


def rotors(r: CompiledRobot) -> None:
    """Reads what motors add to inertia and damping of joints and tendons, even without a force: gear^2 times theirs.

    The rotor of a tendon that is a multiple f of one joint is that joint's, f^2 times.
    """
    m = r.m
    for k in range(len(m.actuator_trntype)):
        way, target = int(m.actuator_trntype[k]), int(m.actuator_trnid[k][0])
        of = "joint" if way in (ON_JOINT, IN_PARENT) else "tendon"
        if way not in (ON_JOINT, IN_PARENT, ON_TENDON):
            continue
        square = decimal_of_double(m.actuator_gear[k][0]) ** 2
        for kind, found in (("actuator_armature", r.rotors), ("actuator_damping", r.dampers)):
            for value in r.numbers([kind], k):
                found[of, target] = found.get((of, target), Decimal(0)) + square * decimal_of_double(value)
        if any(r.numbers(["actuator_dampingpoly"], k)):
            r.leave("springs and dampers that are not linear", [m.actuator(k).name or f"motor{k}"])
    number = {q: j for j, q in r.joint.items()}
    for t in range(m.ntendon):
        length = r.length(t) or []
        if len(length) == 1:
            factor, at = length[0][0], ("joint", number[length[0][1]])
            own = r.rotors.pop(("tendon", t), Decimal(0)) + sum(
                map(decimal_of_double, r.numbers(["tendon_armature"], t))
            )
            r.rotors[at] = r.rotors.get(at, Decimal(0)) + factor * factor * own


def motors(r: CompiledRobot) -> None:
    """Reads motors: an input each, and force = gain w + bias along their target."""
    m = r.m
    for k in range(len(m.actuator_trntype)):
        raw = m.actuator(k).name or f"motor{k}"
        if _switched_off(m, k):
            r.leave("motors that are switched off", [raw], "they push nothing")
            continue
        if r.by_plugin(k):
            r.leave("motors by plugins", [raw], "code of a simulator")
            continue
        way, target = int(m.actuator_trntype[k]), int(m.actuator_trnid[k][0])
        length: Length | None = None
        ends: list[str] = []
        in_space = way in (ON_JOINT, IN_PARENT) and m.jnt_type[target] not in (SLIDE, HINGE)
        if way in (ON_JOINT, IN_PARENT) and not in_space:
            length = [(Decimal(1), r.joint[target])]
        elif way == ON_TENDON:
            length, ends = r.length(target), r.ends(target)
        at_site = way == ON_SITE and m.actuator_trnid[k][1] < 0
        reached = length is not None or at_site or bool(ends)
        if in_space:  # the axes of a parent are those of a body, not of a frame between two joints
            reached = way == ON_JOINT or m.body_jntadr[m.jnt_bodyid[target]] == target
        if not reached:
            r.leave("motors on other things than joints, tendons between two places, and sites", [raw])
        elif not _linear(r, k, at_site=at_site, in_space=in_space):
            r.leave("motors that are no linear laws", [raw])
        else:
            _motor(r, k, raw, length, ends)


def motors_in_space(r: CompiledRobot) -> None:
    """The forces and couples of motors on free and ball joints, whose rates have their names now."""
    for k, w in r.in_space.items():
        m, j = r.m, int(r.m.actuator_trnid[k][0])
        body, gear = int(m.jnt_bodyid[j]), [decimal_of_double(x) for x in m.actuator_gear[k]]
        rates = r.omega[j]
        law, _ = _law(r, k, w, [], Decimal(1), list(zip(gear, rates, strict=False)))
        name, parent = r.body[body], r.body[int(m.body_parentid[body])]
        parts = [("force", gear[:3], None), ("couple", gear[3:6], name)] if len(rates) == 6 else []
        for kind, along, axes in parts or [("couple", gear[:3], name)]:
            if kind == "couple" and m.actuator_trntype[k] == IN_PARENT:
                axes = parent
                if m.jnt_type[j] == BALL:
                    turn = turn_by(m.body_quat[body])[0]
                    along = in_file(turn @ decimals(along))
            if not any(along) or law == "0":
                continue
            pushed = [_times(x, law) for x in along]
            where = {"point": f"{name}.origin"} if kind == "force" else {"body": name}
            own = {"axes": axes} if axes else {}
            r.found["forces"][r.forces.new(w)] = {"kind": kind, **where, kind: pushed, **own}
            if kind == "couple" and parent is not None:
                back = [_times(-x, law) for x in along]
                r.found["forces"][r.forces.new(w)] = {"kind": kind, "body": parent, kind: back, **own}


def _times(x: Decimal, law: str) -> str:
    grouped = f"({law})" if " " in law else law
    return "0" if not x else grouped if x == 1 else f"{decimal_text(x)}*{grouped}"


def _switched_off(m: Any, k: int) -> bool:
    """True if a motor is switched off, by a flag or by its group."""
    mujoco: Any = importlib.import_module("mujoco")
    flag = m.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    group = int(m.actuator_group[k])
    return bool(flag or (0 <= group < 31 and m.opt.disableactuator >> group & 1))


def _linear(r: CompiledRobot, k: int, *, at_site: bool, in_space: bool) -> bool:
    """True if a law is gain w + bias, linear in the length and its rate.

    The rate of a site has no name in a file, nor has the length of a free or ball joint, or its rate in the parent.
    """
    m = r.m
    known = m.actuator_gaintype[k] in (FIXED, AFFINE) and m.actuator_biastype[k] in (0, AFFINE)
    known = known and bool(np.isfinite([*m.actuator_gainprm[k][:3], *m.actuator_biasprm[k][:3]]).all())
    constants = [m.actuator_gainprm[k], m.actuator_biasprm[k]]
    used = [m.actuator_gaintype[k], m.actuator_biastype[k]]
    by_length, by_rate = ([x[i] * kind for x, kind in zip(constants, used, strict=True)] for i in (1, 2))
    unnamed = [*by_rate] if at_site or (in_space and m.actuator_trntype[k] == IN_PARENT) else []
    unnamed += [*by_length] if in_space else []
    return bool(known) and not any(unnamed)


def _motor(r: CompiledRobot, k: int, raw: str, length: Length | None, ends: list[str]) -> None:
    """Reads one motor and its input, and reports its parts without a counterpart."""
    m, target = r.m, int(r.m.actuator_trnid[k][0])
    at_site = m.actuator_trntype[k] == ON_SITE
    if at_site and m.site_bodyid[target] == 0:
        r.leave("motors on the ground", [raw], "they move nothing")
        return
    if m.actuator_dyntype[k]:
        r.leave("filters of motors", [raw], "the input is the activation")
    if any(r.numbers(["actuator_delay"], k)):
        r.leave("delays of motors", [raw])
    said = [
        (kind, "{:g} to {:g}".format(*getattr(m, f"actuator_{kind}range")[k]))
        for kind in LIMITS
        if getattr(m, f"actuator_{kind}limited")[k]
    ]
    if said:
        reported = said[0][1] if len(said) == 1 else ", ".join(f"{kind} {span}" for kind, span in said)
        r.leave("limits of motors", [f"{raw} ({reported})"], "an input has none")
    w = r.names.new(f"motor_{raw}" if raw in r.names.given else raw, "w")
    if at_site:
        driven = _thrust(r, k, w)
    elif ends:
        driven = _pull(r, k, w, ends)
    else:
        driven = _in_space(r, k, w) if length is None else _push(r, k, raw, w, length)
    if driven:
        r.found["inputs"][w] = {"value": 0, **({} if w == raw else {"about": f"motor {raw}"})}
    else:
        r.leave("inputs of motors", [raw], "by its gain it moves nothing")


def _push(r: CompiledRobot, k: int, raw: str, w: str, length: Length) -> bool:
    """gear (gain w + bias), both linear in the length gear L and its rate; whether it holds w."""
    m, target, ratio = r.m, int(r.m.actuator_trnid[k][0]), decimal_of_double(r.m.actuator_gear[k][0])
    on_joint = m.actuator_trntype[k] in (ON_JOINT, IN_PARENT)
    law, driven = _law(r, k, w, [(ratio * factor, q) for factor, q in length], ratio if on_joint else Decimal(1))
    if on_joint:
        if law != "0":
            r.drives.setdefault(target, []).append(law)
        return driven
    grouped = f"({law})" if " " in law else law
    for factor, q in length if ratio and law != "0" else ():
        r.push(f"{raw}_{q}", q, f"{decimal_text(factor * ratio)}*{grouped}")
    return driven and bool(ratio)


def _in_space(r: CompiledRobot, k: int, w: str) -> bool:
    """Reads a motor on a free or ball joint, to be added when its rates have names; True if its input has an effect."""
    m, j = r.m, int(r.m.actuator_trnid[k][0])
    r.in_space[k] = w
    return bool(m.actuator_gainprm[k][0]) and any(m.actuator_gear[k][: 3 if m.jnt_type[j] == BALL else 6])


def _pull(r: CompiledRobot, k: int, w: str, ends: list[str]) -> bool:
    """Reads a motor on a tendon that is straight between two places: it pulls them together."""
    gear = decimal_of_double(r.m.actuator_gear[k][0])
    law, driven = _law(r, k, w, [(gear, "r")], -gear)
    if law != "0":
        r.found["forces"][r.forces.new(w)] = {"kind": "between", "points": ends, "pull": law}
    return driven and bool(gear)


def _law(
    r: CompiledRobot, k: int, w: str, length: Length, gear: Decimal, rates: Length | None = None
) -> tuple[str, bool]:
    """gear times the force of a motor, and whether it holds w."""
    m = r.m
    rates = [(factor, f"{q}'") for factor, q in length] if rates is None else rates

    def affine(numbers: Any) -> str:
        constant, slope, rate = (decimal_of_double(x) for x in numbers[:3])
        along = [(gear * slope * factor, q) for factor, q in length]
        along += [(gear * rate * factor, q) for factor, q in rates]
        return signed_sum(along, gear * constant, weighed=True)

    gain = m.actuator_gainprm[k]
    push = signed_sum([(gear * decimal_of_double(gain[0]), w)])
    if m.actuator_gaintype[k] == AFFINE and any(gain[1:3]):
        push = f"({affine(gain)})*{w}" if affine(gain) != "0" else "0"
    bias = affine(m.actuator_biasprm[k]) if m.actuator_biastype[k] == AFFINE else "0"
    terms = [term for term in (push, bias) if term != "0"]
    return " + ".join(terms).replace("+ -", "- ") or "0", push != "0"


def _thrust(r: CompiledRobot, k: int, w: str) -> bool:
    """Reads force and couple of a motor in the axes of a site, whose length is 0; True if they depend on w."""
    m, site = r.m, int(r.m.actuator_trnid[k][0])
    body, R = int(m.site_bodyid[site]), turn_by(m.site_quat[site])[0]
    gain = decimal_of_double(m.actuator_gainprm[k][0])
    bias = decimal_of_double(m.actuator_biasprm[k][0]) if m.actuator_biastype[k] == AFFINE else Decimal(0)
    pushed = False
    for kind, part in (("force", slice(0, 3)), ("couple", slice(3, 6))):
        along = in_file(R @ decimals(decimal_of_double(x) for x in m.actuator_gear[k][part]))
        if not any(along) or not (gain or bias):
            continue
        law = [signed_sum([(gain * x, w)], bias * x) for x in along]
        where = {"point": r.sites[site]} if kind == "force" else {"body": r.body[body]}
        r.found["forces"][r.forces.new(w)] = {"kind": kind, **where, kind: law, "axes": r.body[body]}
        pushed = pushed or bool(gain)
    return pushed


# -------- mjcf reading ----------------------------------------------------------------------------------------
# A compiled model of MuJoCo, and the tables made of it, shared by the readers of bodies and of forces.


FREE, BALL, SLIDE, HINGE = range(4)  # the numbers of MuJoCo: of joints,
JOINT_WRAP, SITE_WRAP = 1, 3  # of what a tendon is of


@dataclass
class CompiledRobot:
    """Compiled model of MuJoCo, and the tables that are made of it.

    Args:
        rotors, dampers: inertia and damping that motors add to joints and tendons, by ("joint" or "tendon", number).
        in_space: motors on free and ball joints, with their inputs.
        omega: the rates of free and ball joints: of places, about the axes of the body.
        start: the positions at which the model starts.
    """

    m: Any
    title: str
    names: LegalNames = field(default_factory=LegalNames)
    bodies: LegalNames = field(default_factory=LegalNames)
    found: Entries = field(default_factory=dict)
    left: dict[tuple[str, str], list[str]] = field(default_factory=dict)
    forces: LegalNames = field(default_factory=lambda: LegalNames({"weight"}))
    body: dict[int, str | None] = field(default_factory=dict)
    joint: dict[int, str] = field(default_factory=dict)
    sites: dict[int, str] = field(default_factory=dict)
    drives: dict[int, list[str]] = field(default_factory=dict)
    rotors: dict[tuple[str, int], Decimal] = field(default_factory=dict)
    dampers: dict[tuple[str, int], Decimal] = field(default_factory=dict)
    omega: dict[int, list[str]] = field(default_factory=dict)
    in_space: dict[int, str] = field(default_factory=dict)
    start: Any = None
    points: dict[int, Entries] = field(default_factory=dict)

    def leave(self, what: str, where: Iterable[str], why: str = NO_COUNTERPART) -> None:
        if where := list(where):
            self.left.setdefault((what, why), []).extend(where)

    def point(self, k: int, wanted: str, place: Iterable[float]) -> str:
        """A point of a body (0: of the ground), its whole name."""
        names = LegalNames({"origin", "center", "joint", "pivot", *self.points.get(k, {})})
        own = names.new(wanted, "point")
        self.points.setdefault(k, {})[own] = in_file(decimal_of_double(x) for x in place)
        return own if k == 0 else f"{self.body[k]}.{own}"

    def by_plugin(self, k: int) -> bool:
        """True if the law of a motor is code of a plugin."""
        return any(x >= 0 for x in self.numbers(["actuator_plugin"], k))

    def added(self, of: str, k: int, own: Any, motors: dict[tuple[str, int], Decimal]) -> Decimal:
        """Own value of a joint or tendon, plus that of its motors."""
        return decimal_of_double(own) + motors.get((of, k), ZERO)

    def push(self, name: str, q: str, value: str) -> None:
        """A generalized force along a coordinate."""
        law = {"kind": "generalized", "coordinate": q, "value": value}
        self.found["forces"][self.forces.new(name, "push")] = law

    def length(self, t: int) -> list[tuple[Decimal, str]] | None:
        """The length of a tendon that is a sum of joints'; None of one through places."""
        m = self.m
        wraps = range(m.tendon_adr[t], m.tendon_adr[t] + m.tendon_num[t])
        if any(m.wrap_type[i] != JOINT_WRAP for i in wraps):
            return None
        return [(decimal_of_double(m.wrap_prm[i]), self.joint[int(m.wrap_objid[i])]) for i in wraps]

    def ends(self, t: int) -> list[str]:
        """Places of a tendon that is straight between two; [] for another one."""
        at = range(self.m.tendon_adr[t], self.m.tendon_adr[t] + self.m.tendon_num[t])
        straight = len(at) == 2 and all(self.m.wrap_type[k] == SITE_WRAP for k in at)
        return [self.sites[int(self.m.wrap_objid[k])] for k in at] if straight else []

    def units(self, coordinates: Iterable[str]) -> set[str]:
        """Units of coordinates, once each."""
        return {self.found["coordinates"][q]["unit"] for q in coordinates}

    def sum_of(self, length: list[tuple[Decimal, str]], constant: Decimal = ZERO, *, rate: bool = False) -> str:
        """A length that is a sum of joints', or its rate."""
        terms = [(factor, f"{q}'" if rate else q) for factor, q in length]
        return signed_sum(terms, constant, weighed=len(self.units(q for _, q in length)) > 1)

    def numbers(self, fields: Iterable[str], k: int | slice) -> list[float]:
        """Values of fields of the compiled model for its k-th element; without fields that an older MuJoCo lacks."""
        given = (getattr(self.m, field, None) for field in fields)
        return [float(x) for values in given if values is not None for x in np.ravel(values[k])]


def turn_by(quaternion: Any) -> tuple[Matrix, list[Entries]]:
    """A quaternion as a rotation and as turns of a model file."""
    e = [Decimal(float(x)) for x in quaternion]
    length = sum((x * x for x in e), ZERO).sqrt()
    turns = turn_of([x / length for x in e])
    return (turned_by(e) if turns else Matrix.IDENTITY), turns
