"""Motors of a compiled model of MuJoCo -> inputs and forces of a model file."""

from __future__ import annotations

import importlib
from decimal import Decimal
from typing import Any

import numpy as np

from eomgen.robots.drawn_up import in_file, signed_sum
from eomgen.robots.mjcf_reading import BALL, HINGE, SLIDE, CompiledRobot, turn_by
from eomgen.robots.numbers import decimal_of_double, decimals
from eomgen.robots.toml_text import decimal_text
from eomgen.symbolic.expression.spatial import apply

ON_JOINT, IN_PARENT, ON_TENDON, ON_SITE = 0, 1, 3, 4  # the numbers of MuJoCo: of what a motor acts on,
FIXED, AFFINE = 0, 1  # of its laws
LIMITS = ("ctrl", "force", "act")
Length = list[tuple[Decimal, str]]


def rotors(r: CompiledRobot) -> None:
    """What motors add to inertia and damping of their joints and tendons, pushing or not: gear^2 times theirs.

    The rotor of a tendon that is a multiple f of one joint is that joint's, f^2 times.
    """
    m = r.m
    for k in range(len(m.actuator_trntype)):
        way, target = int(m.actuator_trntype[k]), int(m.actuator_trnid[k][0])
        of = "joint" if way in (ON_JOINT, IN_PARENT) else "tendon"
        if way not in (ON_JOINT, IN_PARENT, ON_TENDON):
            continue
        square = decimal_of_double(m.actuator_gear[k][0]) ** 2
        for field, found in (("actuator_armature", r.rotors), ("actuator_damping", r.dampers)):
            for value in r.numbers([field], k):
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
    """Motors: an input each, and force = gain w + bias along what it acts on."""
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
                    along = in_file(apply(turn, decimals(along)))
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
    """By a flag, or by the group to which it belongs."""
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
    """One motor, its input and what of it has no counterpart."""
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
        told = said[0][1] if len(said) == 1 else ", ".join(f"{kind} {span}" for kind, span in said)
        r.leave("limits of motors", [f"{raw} ({told})"], "an input has none")
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
    """A motor on a free or ball joint, kept for when its rates have names; whether it moves anything by w."""
    m, j = r.m, int(r.m.actuator_trnid[k][0])
    r.in_space[k] = w
    return bool(m.actuator_gainprm[k][0]) and any(m.actuator_gear[k][: 3 if m.jnt_type[j] == BALL else 6])


def _pull(r: CompiledRobot, k: int, w: str, ends: list[str]) -> bool:
    """A motor on a tendon straight between two places: it draws them together by what it shortens."""
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
    """A force and a couple in the axes of a site, whose length is 0; whether they hold w."""
    m, site = r.m, int(r.m.actuator_trnid[k][0])
    body, R = int(m.site_bodyid[site]), turn_by(m.site_quat[site])[0]
    gain = decimal_of_double(m.actuator_gainprm[k][0])
    bias = decimal_of_double(m.actuator_biasprm[k][0]) if m.actuator_biastype[k] == AFFINE else Decimal(0)
    pushed = False
    for kind, part in (("force", slice(0, 3)), ("couple", slice(3, 6))):
        along = in_file(apply(R, decimals(decimal_of_double(x) for x in m.actuator_gear[k][part])))
        if not any(along) or not (gain or bias):
            continue
        law = [signed_sum([(gain * x, w)], bias * x) for x in along]
        where = {"point": r.sites[site]} if kind == "force" else {"body": r.body[body]}
        r.found["forces"][r.forces.new(w)] = {"kind": kind, **where, kind: law, "axes": r.body[body]}
        pushed = pushed or bool(gain)
    return pushed
