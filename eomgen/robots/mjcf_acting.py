"""Tendons and equalities of a compiled model of MuJoCo -> forces and ties of a model file."""

from __future__ import annotations

import importlib
from decimal import Decimal
from typing import Any

from eomgen.robots.drawn_up import (
    Entries,
    gap,
)
from eomgen.robots.mjcf_reading import CompiledRobot
from eomgen.robots.numbers import ZERO, decimal_of_double
from eomgen.robots.toml_text import decimal_text
from eomgen.symbolic.numeric.tolerances import ROUNDING

CONNECT, WELD, JOINT, TENDON = range(4)  # the numbers of MuJoCo: of equalities,
AT_SITE, SITE = 3, 6  # of what a tendon goes through, of what an equality is of
TURNING = 10  # where a weld says how much its turning counts beside its place
BEYOND = (
    *("tendon_armature", "tendon_frictionloss", "tendon_stiffnesspoly", "tendon_dampingpoly", "tendon_springyield"),
)
"""of tendons, what has no counterpart"""


def tendons(r: CompiledRobot) -> None:
    """Springs and dampers of tendons."""
    m = r.m
    for t in range(m.ntendon):
        name, length = _tendon_name(r, t), r.length(t)
        stiff, damping = decimal_of_double(m.tendon_stiffness[t]), decimal_of_double(m.tendon_damping[t])
        ends = _ends(r, t)
        if length is None and not ends:
            if stiff or damping or m.tendon_limited[t] or any(r.numbers(BEYOND, t)):
                r.leave("tendons through places", [name], "say them by springs, links and strings")
            continue
        if m.tendon_limited[t]:
            r.leave("limits of tendons", [name], "no stop is declared by a limit")
        if any(r.numbers(BEYOND, t)):
            r.leave("armature, friction, bent springs and dampers of tendons", [name])
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
    sides: list[tuple[str, Decimal, set[str]]] = []  # what it counts, where it starts, its units
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
    told = [(c, power) for c, power in powers if c and other]
    same = unit == other_unit and len(unit) == 1 and all(power == away for _, power in told)
    return {"kind": "equation", "gap": gap(one, told, -at - decimal_of_double(data[0]), weighed=not same)}


def _weld(r: CompiledRobot, first: int, second: int, raw: str, data: Any) -> Entries | None:
    """Two bodies as they stand: where that is not how they are welded, there is no counterpart."""
    mujoco: Any = importlib.import_module("mujoco")
    state = mujoco.MjData(r.m)
    mujoco.mj_kinematics(r.m, state)
    back, there = state.xmat[first].reshape(3, 3).T, state.xmat[second].reshape(3, 3)
    away = back @ (state.xpos[second] + there @ data[:3] - state.xpos[first])
    turn = mujoco_matrix(mujoco, data[6:10])
    turns = data[TURNING] != 0  # else it holds a point alone
    if abs(away - data[3:6]).max() > ROUNDING or (turns and abs(back @ there - turn).max() > ROUNDING):
        return None
    points = [r.point(first, raw, data[3:6]), r.point(second, raw, data[:3])]
    return {"kind": "clamp" if turns else "pin", "points": points}


def _tendon_name(r: CompiledRobot, t: int) -> str:
    return r.m.tendon(t).name or f"tendon{t}"


def mujoco_matrix(mujoco: Any, quaternion: Any) -> Any:
    """A rotation as MuJoCo has it."""
    import numpy as np

    found = np.zeros(9)
    mujoco.mju_quat2Mat(found, quaternion)
    return found.reshape(3, 3)
