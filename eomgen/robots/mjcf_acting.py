"""Tendons, motors and equalities of a compiled model of MuJoCo -> forces, inputs and ties of a model file."""

from __future__ import annotations

import importlib
from decimal import Decimal
from typing import Any

from eomgen.robots.drawn_up import (
    Entries,
    signed_sum,
)
from eomgen.robots.mjcf_reading import HINGE, SLIDE, CompiledRobot, turn_by
from eomgen.robots.numbers import (
    ZERO,
    computed,
    decimal_of_double,
    decimals,
)
from eomgen.robots.toml_text import decimal_text
from eomgen.symbolic.expression.spatial import apply
from eomgen.symbolic.numeric.tolerances import ROUNDING

CONNECT, WELD, JOINT, TENDON = range(4)  # the numbers of MuJoCo: of equalities,
ON_JOINT, IN_PARENT, ON_TENDON, ON_SITE = 0, 1, 3, 4  # of what a motor acts on,
FIXED, AFFINE = 0, 1  # of its laws,
AT_SITE, SITE = 3, 6  # of what a tendon goes through, of what an equality is of


def tendons(r: CompiledRobot) -> None:
    """Springs and dampers of tendons."""
    m = r.m
    for t in range(m.ntendon):
        name, length = _tendon_name(r, t), r.length(t)
        stiff, damping = decimal_of_double(m.tendon_stiffness[t]), decimal_of_double(m.tendon_damping[t])
        ends = _ends(r, t)
        if length is None and not ends:
            if stiff or damping or m.tendon_limited[t]:
                r.leave("tendons through places", [name], "say them by springs, links and strings")
            continue
        if m.tendon_limited[t]:
            r.leave("limits of tendons", [name], "no stop is declared by a limit")
        if m.tendon_armature[t] or m.tendon_frictionloss[t] or any(m.tendon_stiffnesspoly[t]):
            r.leave("armature, friction and bent springs of tendons", [name])
        low, high = (decimal_of_double(x) for x in m.tendon_lengthspring[t])
        if ends:
            _stretched(r, name, ends, stiff, damping, (low, high))
            continue
        assert length is not None
        if stiff:
            stretch, beyond = signed_sum(length, -low), signed_sum(length, -high)
            square = f"({stretch})^2" if low == high else f"(min({stretch}, 0)^2 + max({beyond}, 0)^2)"
            spring = {"kind": "potential", "energy": f"{decimal_text(stiff)}/2*{square}"}
            r.found["forces"][r.forces.new(name, "tendon")] = spring
        if damping:
            rate = signed_sum((factor, f"{q}'") for factor, q in length)
            for factor, q in length:
                r.push(f"{name}_{q}", q, f"{decimal_text(-factor * damping)}*({rate})")


def _ends(r: CompiledRobot, t: int) -> list[str]:
    """The two places of a tendon that is straight between them; [] of another one."""
    at = range(r.m.tendon_adr[t], r.m.tendon_adr[t] + r.m.tendon_num[t])
    straight = len(at) == 2 and all(r.m.wrap_type[k] == AT_SITE for k in at)
    return [r.sites[int(r.m.wrap_objid[k])] for k in at] if straight else []


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


def motors(r: CompiledRobot) -> None:
    """Motors: an input each, and force = gain w + bias along what it acts on."""
    m = r.m
    for k in range(m.nactuator):
        raw = m.actuator(k).name or f"motor{k}"
        if m.actuator_gaintype[k] not in (FIXED, AFFINE) or m.actuator_biastype[k] not in (0, AFFINE):
            r.leave("motors that are no linear laws", [raw])
            continue
        way, target, gear = int(m.actuator_trntype[k]), int(m.actuator_trnid[k][0]), m.actuator_gear[k]
        length: list[tuple[Decimal, str]] | None = None
        if way in (ON_JOINT, IN_PARENT) and m.jnt_type[target] in (SLIDE, HINGE):
            length = [(Decimal(1), r.joint[target])]
        elif way == ON_TENDON:
            length = r.length(target)
        if length is None and not (way == ON_SITE and m.actuator_trnid[k][1] < 0):
            r.leave("motors on other things than hinges, slides, sums of these, and sites", [raw])
            continue
        if m.actuator_dyntype[k]:
            r.leave("filters of motors", [raw], "the input is the activation")
        if m.actuator_forcelimited[k] or m.actuator_ctrllimited[k]:
            low, high = m.actuator_ctrlrange[k] if m.actuator_ctrllimited[k] else m.actuator_forcerange[k]
            r.leave("limits of motors", [f"{raw} ({low:g} to {high:g})"], "an input has none")
        w = r.names.new(f"motor_{raw}" if raw in r.names.given else raw, "w")
        r.found["inputs"][w] = {"value": 0, **({} if w == raw else {"about": f"motor {raw}"})}
        if length is None:
            _thruster(r, k, w, target)
            continue
        ratio = decimal_of_double(gear[0])
        law = _law(r, k, w, [(ratio * factor, q) for factor, q in length])
        if way in (ON_JOINT, IN_PARENT):
            r.drives.setdefault(target, []).append(law)
            if m.actuator_armature[k]:
                rotor = ratio * ratio * decimal_of_double(m.actuator_armature[k])
                r.rotors[target] = r.rotors.get(target, ZERO) + rotor
            continue
        for factor, q in length:
            plain = law.replace(f"{decimal_text(ratio)}*", "", 1) if ratio != 1 else law
            grouped = f"({plain})" if " " in plain else plain
            r.push(f"{raw}_{q}", q, f"{decimal_text(factor * ratio)}*{grouped}")


def _law(r: CompiledRobot, k: int, w: str, length: list[tuple[Decimal, str]]) -> str:
    """gear (gain w + bias), both linear in the length gear L and its rate."""
    m = r.m
    rates = [(factor, f"{q}'") for factor, q in length]
    gear = decimal_of_double(m.actuator_gear[k][0]) if m.actuator_trntype[k] in (ON_JOINT, IN_PARENT) else Decimal(1)

    def affine(numbers: Any) -> str:
        constant, slope, rate = (decimal_of_double(x) for x in numbers[:3])
        along = [(gear * slope * factor, q) for factor, q in length]
        along += [(gear * rate * factor, q) for factor, q in rates]
        return signed_sum(along, gear * constant, weighed=True)

    gain = m.actuator_gainprm[k]
    push = signed_sum([(gear * decimal_of_double(gain[0]), w)])
    if m.actuator_gaintype[k] == AFFINE:
        push = f"({affine(gain)})*{w}"
    bias = affine(m.actuator_biasprm[k]) if m.actuator_biastype[k] == AFFINE else "0"
    damping = decimal_of_double(m.actuator_damping[k])
    terms = [push, bias, signed_sum(((-gear * damping * f, q) for f, q in rates), weighed=True) if damping else "0"]
    return " + ".join(term for term in terms if term != "0").replace("+ -", "- ") or "0"


def _thruster(r: CompiledRobot, k: int, w: str, site: int) -> None:
    """A force and a couple in the axes of a site."""
    m, body = r.m, int(r.m.site_bodyid[site])
    if body == 0:
        r.leave("motors on the ground", [w], "they move nothing")
        return
    R, _ = turn_by(m.site_quat[site])
    size = decimal_of_double(m.actuator_gainprm[k][0])
    for kind, part in (("force", slice(0, 3)), ("couple", slice(3, 6))):
        along = apply(R, decimals(decimal_of_double(x) for x in m.actuator_gear[k][part]))
        if not any(along):
            continue
        law = [signed_sum([(computed(size * Decimal(str(x))), w)]) for x in along]
        where = {"point": r.sites[site]} if kind == "force" else {"body": r.body[body]}
        r.found["forces"][r.forces.new(w)] = {"kind": kind, **where, kind: law, "axes": r.body[body]}


def equalities(r: CompiledRobot) -> None:
    """Ties: of points, of bodies, of coordinates; in MuJoCo they give way, here they hold."""
    m = r.m
    for e in range(m.neq):
        raw = m.equality(e).name or f"tie{e}"
        if not m.eq_active0[e]:
            r.leave("equalities that are switched off", [raw])
            continue
        made = _equality(r, e, raw)
        if made is None:
            r.leave("equalities of other kinds", [raw])
            continue
        r.found["constraints"][r.bodies.new(raw, "tie")] = made
        r.leave("softness of equalities", [raw], "here they hold exactly")


def _equality(r: CompiledRobot, e: int, raw: str) -> Entries | None:
    m, kind = r.m, int(r.m.eq_type[e])
    first, second, data = int(m.eq_obj1id[e]), int(m.eq_obj2id[e]), m.eq_data[e]
    if kind in (CONNECT, WELD):
        if m.eq_objtype[e] == SITE:
            if kind == WELD:
                return None
            return {"kind": "pin", "points": [r.sites[first], r.sites[second]]}
        if kind == CONNECT:
            return {
                "kind": "pin",
                "points": [r.point(first, raw, data[:3]), r.point(second, raw, data[3:6])],
            }
        return _weld(r, first, second, raw, data)
    if kind not in (JOINT, TENDON):
        return None
    lengths = []
    for which in (first, second):
        if which < 0:
            lengths.append(("0", ZERO))
        elif kind == JOINT:
            lengths.append((r.joint[which], decimal_of_double(m.qpos0[m.jnt_qposadr[which]])))
        else:
            length = r.length(which)
            if length is None:
                return None
            lengths.append((f"({signed_sum(length)})", decimal_of_double(m.tendon_length0[which])))
    (one, at), (other, other_at) = lengths
    away = other if not other_at else f"({other} - {decimal_text(other_at)})".replace("- -", "+ ")
    powers = [(decimal_of_double(c), away if n == 1 else f"{away}^{n}") for n, c in enumerate(data[:5]) if n]
    terms = [(Decimal(1), one), *((-c, power) for c, power in powers if c and other != "0")]
    return {"kind": "equation", "gap": signed_sum(terms, -at - decimal_of_double(data[0]))}


def _weld(r: CompiledRobot, first: int, second: int, raw: str, data: Any) -> Entries | None:
    """Two bodies as they stand: where that is not how they are welded, there is no counterpart."""
    mujoco: Any = importlib.import_module("mujoco")
    state = mujoco.MjData(r.m)
    mujoco.mj_kinematics(r.m, state)
    back, there = state.xmat[first].reshape(3, 3).T, state.xmat[second].reshape(3, 3)
    away = back @ (state.xpos[second] + there @ data[:3] - state.xpos[first])
    turn = mujoco_matrix(mujoco, data[6:10])
    if abs(away - data[3:6]).max() > ROUNDING or abs(back @ there - turn).max() > ROUNDING:
        return None
    points = [r.point(first, raw, data[3:6]), r.point(second, raw, data[:3])]
    return {"kind": "clamp", "points": points}


def _tendon_name(r: CompiledRobot, t: int) -> str:
    return r.m.tendon(t).name or f"tendon{t}"


def mujoco_matrix(mujoco: Any, quaternion: Any) -> Any:
    """A rotation as MuJoCo has it."""
    import numpy as np

    found = np.zeros(9)
    mujoco.mju_quat2Mat(found, quaternion)
    return found.reshape(3, 3)
