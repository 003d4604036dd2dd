"""Motors of a compiled model of MuJoCo -> inputs and forces of a model file."""

from __future__ import annotations

import importlib
from decimal import Decimal
from typing import Any

import numpy as np

from eomgen.robots.drawn_up import in_file, signed_sum
from eomgen.robots.mjcf_reading import HINGE, SLIDE, CompiledRobot, turn_by
from eomgen.robots.numbers import decimal_of_double, decimals
from eomgen.robots.toml_text import decimal_text
from eomgen.symbolic.expression.spatial import apply

ON_JOINT, IN_PARENT, ON_TENDON, ON_SITE = 0, 1, 3, 4  # the numbers of MuJoCo: of what a motor acts on,
FIXED, AFFINE = 0, 1  # of its laws
LIMITS = ("ctrl", "force", "act")
Length = list[tuple[Decimal, str]]


def motors(r: CompiledRobot) -> None:
    """Motors: an input each, and force = gain w + bias along what it acts on."""
    m = r.m
    for k in range(len(m.actuator_trntype)):
        raw = m.actuator(k).name or f"motor{k}"
        if _switched_off(m, k):
            r.leave("motors that are switched off", [raw], "they push nothing")
            continue
        way, target = int(m.actuator_trntype[k]), int(m.actuator_trnid[k][0])
        length: Length | None = None
        if way in (ON_JOINT, IN_PARENT) and m.jnt_type[target] in (SLIDE, HINGE):
            length = [(Decimal(1), r.joint[target])]
        elif way == ON_TENDON:
            length = r.length(target)
        at_site = way == ON_SITE and m.actuator_trnid[k][1] < 0
        if length is None and not at_site:
            r.leave("motors on other things than hinges, slides, sums of these, and sites", [raw])
        elif not _linear(r, k, at_site):
            r.leave("motors that are no linear laws", [raw])
        else:
            _motor(r, k, raw, length)


def _switched_off(m: Any, k: int) -> bool:
    """By a flag, or by the group to which it belongs."""
    mujoco: Any = importlib.import_module("mujoco")
    flag = m.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    group = int(m.actuator_group[k])
    return bool(flag or (0 <= group < 31 and m.opt.disableactuator >> group & 1))


def _linear(r: CompiledRobot, k: int, at_site: bool) -> bool:
    """Whether a law is gain w + bias, linear in the length and its rate; the rate of a site has no name in a file."""
    m = r.m
    known = m.actuator_gaintype[k] in (FIXED, AFFINE) and m.actuator_biastype[k] in (0, AFFINE)
    known = known and bool(np.isfinite([*m.actuator_gainprm[k][:3], *m.actuator_biasprm[k][:3]]).all())
    bent = any(r.numbers(["actuator_dampingpoly"], k))
    by_rate = [m.actuator_gainprm[k][2] * m.actuator_gaintype[k], m.actuator_biasprm[k][2] * m.actuator_biastype[k]]
    return bool(known) and not bent and not (at_site and any([*by_rate, *r.numbers(["actuator_damping"], k)]))


def _motor(r: CompiledRobot, k: int, raw: str, length: Length | None) -> None:
    """One motor, its input and what of it has no counterpart."""
    m, target = r.m, int(r.m.actuator_trnid[k][0])
    if length is None and m.site_bodyid[target] == 0:
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
    if _thrust(r, k, w) if length is None else _push(r, k, raw, w, length):
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
        for armature in r.numbers(["actuator_armature"], k):
            r.rotors[target] = r.rotors.get(target, Decimal(0)) + ratio * ratio * decimal_of_double(armature)
        return driven
    grouped = f"({law})" if " " in law else law
    for factor, q in length if ratio and law != "0" else ():
        r.push(f"{raw}_{q}", q, f"{decimal_text(factor * ratio)}*{grouped}")
    return driven and bool(ratio)


def _law(r: CompiledRobot, k: int, w: str, length: Length, gear: Decimal) -> tuple[str, bool]:
    """gear times the force of a motor, and whether it holds w."""
    m = r.m
    rates = [(factor, f"{q}'") for factor, q in length]

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
    damping = sum(map(decimal_of_double, r.numbers(["actuator_damping"], k)), Decimal(0))
    resisting = signed_sum(((-gear * damping * f, q) for f, q in rates), weighed=True)
    terms = [term for term in (push, bias, resisting) if term != "0"]
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
