"""Tendons and equalities of a compiled model of MuJoCo -> forces and ties of a model file."""

from __future__ import annotations

import copy
import importlib
from decimal import Decimal
from typing import Any

from eomgen.robots.drawn_up import (
    Entries,
    gap,
    signed_sum,
)
from eomgen.robots.mjcf_reading import CompiledRobot
from eomgen.robots.numbers import ZERO, decimal_of_double
from eomgen.robots.toml_text import decimal_text
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY, ROUNDING

CONNECT, WELD, JOINT, TENDON = range(4)  # the numbers of MuJoCo: of equalities,
SITE = 6  # of what an equality is of
NEWTON_STEPS = 50
TURNING = 10  # where a weld says how much its turning counts beside its place
BEYOND = (*("tendon_frictionloss", "tendon_stiffnesspoly", "tendon_dampingpoly", "tendon_springyield"),)
"""of tendons, what has no counterpart"""


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
    """True if a joint moves what another is of."""
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
    """Ties: of points, of bodies, of coordinates; in MuJoCo they give way, here they hold."""
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
    mujoco, state = _at_start(r)
    back, there = state.xmat[first].reshape(3, 3).T, state.xmat[second].reshape(3, 3)
    away = back @ (state.xpos[second] + there @ data[:3] - state.xpos[first])
    turn = mujoco_matrix(mujoco, data[6:10])
    turns = data[TURNING] != 0  # else it holds a point alone
    if abs(away - data[3:6]).max() > ROUNDING or (turns and abs(back @ there - turn).max() > ROUNDING):
        return None
    points = [r.point(first, raw, data[3:6]), r.point(second, raw, data[:3])]
    return {"kind": "clamp" if turns else "pin", "points": points}


def _weld_of_sites(r: CompiledRobot, first: int, second: int, data: Any) -> Entries | None:
    """Two sites with their axes as they stand."""
    _, state = _at_start(r)
    turns, apart = data[TURNING] != 0, abs(state.site_xmat[first] - state.site_xmat[second]).max()
    away = abs(state.site_xpos[first] - state.site_xpos[second]).max()
    if away > ROUNDING or (turns and apart > ROUNDING):
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
    """The positions at which bodies that are welded stand so, by Newton's steps on all equalities; else MuJoCo's own.

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
        if abs(gaps).max(initial=0) < ROUNDING / 10:
            if step:
                moved = [r.joint[j] for j in range(m.njnt) if state.qpos[m.jnt_qposadr[j]] != m.qpos0[m.jnt_qposadr[j]]]
                r.leave("start where ties gape", moved, "the start is moved to where they close")
            return state.qpos.copy() if step else m.qpos0
        J = state.efc_J.reshape(-1, m.nv)[rows]
        mujoco.mj_integratePos(own, state.qpos, -np.linalg.lstsq(J, gaps, rcond=RANK_NEARBY)[0], 1)
    return m.qpos0


def _tendon_name(r: CompiledRobot, t: int) -> str:
    return r.m.tendon(t).name or f"tendon{t}"


def mujoco_matrix(mujoco: Any, quaternion: Any) -> Any:
    """A rotation as MuJoCo has it."""
    import numpy as np

    found = np.zeros(9)
    mujoco.mju_quat2Mat(found, quaternion)
    return found.reshape(3, 3)
