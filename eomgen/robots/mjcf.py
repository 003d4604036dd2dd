"""MJCF -> tables of a model file, by MuJoCo's own reader and compiler (the extra `[mujoco]`).

What MuJoCo has compiled is what is imported: defaults are in it, inertias of geoms, names of meshes. A body's joints
become joints one after the other, with frames without mass between them; each sits at its own place in the body.
A position of a hinge or slide counts from `ref`; free and ball joints turn by quaternions, scalar first, with the
angular velocity in the body's axes, as here.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from dataclasses import field
from decimal import Decimal
from pathlib import Path
from typing import Any

from eomgen.errors import ModelError, ToolMissing
from eomgen.model.joints.orientation import rotation_of
from eomgen.records import dataclass
from eomgen.robots.drawn_up import (
    Entries,
    Imported,
    LeftOut,
    LegalNames,
    Moved,
    Seat,
    hung,
    in_file,
    signed_sum,
    without_empty,
)
from eomgen.robots.numbers import (
    ZERO,
    Nine,
    computed,
    decimal_of_double,
    decimals,
    inertia_in,
    six,
    tensor_of,
    turn_of,
)
from eomgen.robots.toml_text import decimal_text
from eomgen.robots.urdf import free_joint, turned_freely, with_mass
from eomgen.symbolic.expression.spatial import IDENTITY, apply
from eomgen.symbolic.numeric.tolerances import ROUNDING

TABLES = ("points", "coordinates", "speeds", "inputs", "bodies", "constraints", "forces")
FREE, BALL, SLIDE, HINGE = range(4)  # the numbers of MuJoCo: of joints,
CONNECT, WELD, JOINT, TENDON = range(4)  # of equalities,
ON_JOINT, IN_PARENT, ON_TENDON, ON_SITE = 0, 1, 3, 4  # of what a motor acts on,
FIXED, AFFINE = 0, 1  # of its laws,
JOINT_WRAP, AT_SITE, SITE = 1, 3, 6  # of what a tendon is of, of what an equality is of


def mjcf(path: Path) -> Imported:
    """The tables of a robot.

    Raises:
        ToolMissing: MuJoCo is not installed.
        ModelError: MuJoCo cannot read it; it says why.
    """
    return _Reading(_switched(spec_of(path).compile()), path.stem).tables()


def _switched(compiled: Any) -> Any:
    """The compiled model without what its flags switch off."""
    mujoco: Any = importlib.import_module("mujoco")
    m, off = compiled, mujoco.mjtDisableBit
    for flag, values in (
        (off.mjDSBL_GRAVITY, (m.opt.gravity,)),
        (off.mjDSBL_SPRING, (m.jnt_stiffness, m.tendon_stiffness)),
        (off.mjDSBL_DAMPER, (m.dof_damping, m.tendon_damping)),
        (off.mjDSBL_EQUALITY | off.mjDSBL_CONSTRAINT, (m.eq_active0,)),
        (off.mjDSBL_ACTUATION, (m.actuator_gainprm, m.actuator_biasprm)),
    ):
        if m.opt.disableflags & int(flag):
            for each in values:
                each[:] = 0
    return m


def spec_of(path: Path) -> Any:
    """A file as MuJoCo reads it, without what needs files of pictures.

    Raises:
        ToolMissing: MuJoCo is not installed.
        ModelError: MuJoCo cannot read it; it says why.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError as error:
        raise ToolMissing("MJCF is read by MuJoCo, which is not installed", mend="pip install mujoco") from error
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        spec.compiler.fusestatic = False
        spec.compile()
    except ValueError as error:
        why = " ".join(str(error).split())
        raise ModelError(f"MuJoCo cannot read it: {why}", str(path), "mend the file") from error
    return spec


@dataclass
class _Reading:
    """A compiled model of MuJoCo, and what is made of it."""

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
    rotors: dict[int, Decimal] = field(default_factory=dict)
    points: dict[int, Entries] = field(default_factory=dict)

    def tables(self) -> Imported:
        m = self.m
        self.found = {key: {} for key in TABLES}
        self.body = {0: None} | {k: self.bodies.new(m.body(k).name or f"body{k}", "body") for k in range(1, m.nbody)}
        self.joint = {j: self.names.new(m.joint(j).name or f"joint{j}", "q") for j in range(m.njnt)}
        self.sites = self._sites()
        self._actuators()
        for k in range(m.nbody):
            self._body(k)
        self._tendons()
        self._equalities()
        for k, own in self.points.items():  # those of ties too, which come after the bodies
            if name := self.body[k]:
                self.found["bodies"][name]["points"] = {**self.found["bodies"][name].get("points", {}), **own}
        self._rest()
        gravity = decimals(decimal_of_double(x) for x in m.opt.gravity)
        parameters = {}
        if any(gravity):
            acceleration: list[Any] = list(gravity)
            if not gravity[0] and not gravity[1]:
                g = self.names.new("g")
                parameters[g] = {"value": abs(gravity[2]), "unit": "m/s^2"}
                acceleration[2] = f"-{g}" if gravity[2] < 0 else g
            weight = {"kind": "gravity", "acceleration": acceleration}
            self.found["forces"] = {"weight": weight, **self.found["forces"]}
        head = {"eomgen": 1, "name": self.title, "space": "space"}
        left_out = tuple(LeftOut(what, tuple(where), why) for (what, why), where in self.left.items())
        return Imported({**head, **without_empty({"parameters": parameters, **self.found})}, left_out)

    def leave(self, what: str, where: Iterable[str], why: str = "eomgen has no counterpart") -> None:
        if where := list(where):
            self.left.setdefault((what, why), []).extend(where)

    # bodies and joints

    def _body(self, k: int) -> None:
        m = self.m
        if k == 0:
            self.found["points"] = self.points.setdefault(0, {})
            return
        raw, name = m.body(k).name, self.body[k]
        assert name is not None
        body: Entries = {"about": f"body {raw}"} if raw and name != raw else {}
        mass = decimal_of_double(m.body_mass[k])
        if mass:
            R, _ = _turned(m.body_iquat[k])
            xx, yy, zz = (decimal_of_double(x) for x in m.body_inertia[k])
            tensor = tensor_of(xx, yy, zz, ZERO, ZERO, ZERO)
            center = decimals(decimal_of_double(x) for x in m.body_ipos[k])
            body |= with_mass({"mass": mass}, center, six(tensor if R == IDENTITY else inertia_in(R, tensor)))
        if self.points.get(k):
            body["points"] = dict(self.points[k])
        joints = range(m.body_jntadr[k], m.body_jntadr[k] + m.body_jntnum[k])
        R, turns = _turned(m.body_quat[k])
        place = decimals(decimal_of_double(x) for x in m.body_pos[k])
        seat = Seat(self.body[int(m.body_parentid[k])], place, R, turns)
        if [m.jnt_type[j] for j in joints] == [FREE]:
            seat, turn = Seat(None), tuple(decimal_of_double(x) for x in m.body_quat[k])
            moved = [free_joint(self.found, self.joint[joints[0]], self.names, place, turn)]
            self._in_space(joints[0])
        else:
            moved = [self._joint(j) for j in joints]
        self.found["bodies"] |= hung(name, body, seat, moved, self.bodies)
        if m.body_mocapid[k] >= 0:
            self.leave("motion of a mocap body", [name], "it stands still here")
        if m.body_gravcomp[k]:
            self._held_up(name, k)

    def _joint(self, j: int) -> Moved:
        m, q = self.m, self.joint[j]
        pivot = decimals(decimal_of_double(x) for x in m.jnt_pos[j])
        if m.jnt_type[j] == BALL:
            self._in_space(j)
            keys = {"kind": "spherical", **turned_freely(self.found, q, self.names)}
            return Moved(keys, pivot, q)
        turns = m.jnt_type[j] == HINGE
        unit = "rad" if turns else "m"
        reference = decimal_of_double(m.qpos0[m.jnt_qposadr[j]])
        remark = [f"joint {m.joint(j).name}"] if m.joint(j).name not in ("", q) else []
        if m.jnt_limited[j]:
            low, high = (decimal_of_double(round(x, 6)) for x in m.jnt_range[j])
            remark.append(f"from {low.normalize():f} to {high.normalize():f} {unit}")
        start = {"start": reference} if reference else {}
        said = {"about": ", ".join(remark)} if remark else {}
        self.found["coordinates"][q] = {**start, "unit": unit, **said}
        variable = q if not reference else signed_sum([(Decimal(1), q)], -reference)
        axis = [decimal_of_double(x) for x in m.jnt_axis[j]]
        keys = {
            "kind": "revolute" if turns else "prismatic",
            "axis": axis,
            "angle" if turns else "displacement": variable,
        }
        if j in self.drives:
            keys["torque" if turns else "force"] = " + ".join(self.drives[j]).replace("+ -", "- ")
        return Moved({**keys, **self._efforts(j, reference)}, pivot if turns else decimals([0, 0, 0]), q)

    def _efforts(self, j: int, reference: Decimal) -> Entries:
        """Spring, damper and rotor of a hinge or slide."""
        m, q, d = self.m, self.joint[j], int(self.m.jnt_dofadr[j])
        keys: Entries = {}
        if m.jnt_stiffness[j]:
            keys["stiffness"] = decimal_of_double(m.jnt_stiffness[j])
            rest = decimal_of_double(m.qpos_spring[m.jnt_qposadr[j]]) - reference
            if rest:
                keys["rest"] = rest
        if m.dof_damping[d]:
            keys["damping"] = decimal_of_double(m.dof_damping[d])
        if rotor := decimal_of_double(m.dof_armature[d]) + self.rotors.get(j, ZERO):
            keys["armature"] = rotor
        if any(m.jnt_stiffnesspoly[j]) or any(m.dof_dampingpoly[d]):
            self.leave("springs and dampers that are not linear", [q])
        if m.dof_frictionloss[d]:
            self.leave(
                "frictionloss", [q], 'of Coulomb in a joint; sliding it is "... - f*sign(rate)", and cannot stick'
            )
        return keys

    def _in_space(self, j: int) -> None:
        """What a free or a ball joint has beside its freedom: dampers; springs, friction and rotors are left out."""
        m, q, d = self.m, self.joint[j], int(self.m.jnt_dofadr[j])
        free = m.jnt_type[j] == FREE
        dofs = slice(d, d + (6 if free else 3))
        kinds = {
            "springs": [m.jnt_stiffness[j]],
            "friction": m.dof_frictionloss[dofs],
            "armature": m.dof_armature[dofs],
        }
        for what, values in kinds.items():
            if any(values):
                self.leave(f"{what} of free and ball joints", [q])
        if not any(m.dof_damping[dofs]):
            return
        body, damping = int(m.jnt_bodyid[j]), [decimal_of_double(x) for x in m.dof_damping[dofs]]
        name, parent = self.body[body], self.body[int(m.body_parentid[body])]
        rates = [*(f"{q}_{x}'" for x in "xyz"[: 3 * free]), *(f"{q}_w{x}" for x in "xyz")]
        against = [signed_sum([(-c, rate)]) for c, rate in zip(damping, rates, strict=True)]
        if free:
            drag = {"kind": "force", "point": f"{name}.origin", "force": against[:3]}
            self.found["forces"][self.forces.new(f"{q}_drag")] = drag
        couple = {"kind": "couple", "body": name, "couple": against[-3:], "axes": name}
        self.found["forces"][self.forces.new(f"{q}_damper")] = couple
        if parent is not None:
            back = [signed_sum([(c, rate)]) for c, rate in zip(damping[-3:], rates[-3:], strict=True)]
            self.found["forces"][self.forces.new(f"{q}_damper")] = {**couple, "body": parent, "couple": back}

    def _held_up(self, name: str, k: int) -> None:
        """Gravity taken off: a force at the mass centre."""
        factor = -float(self.m.body_gravcomp[k]) * float(self.m.body_mass[k])
        force = [decimal_of_double(factor * x) for x in self.m.opt.gravity]
        self.found["forces"][self.forces.new(f"{name}_held_up")] = {
            "kind": "force",
            "point": f"{name}.center",
            "force": force,
        }

    # points, tendons, motors, ties

    def _point(self, k: int, wanted: str, place: Iterable[float]) -> str:
        """A point of a body (0: of the ground), its whole name."""
        names = LegalNames({"origin", "center", "joint", "pivot", *self.points.get(k, {})})
        own = names.new(wanted, "point")
        self.points.setdefault(k, {})[own] = in_file(decimal_of_double(x) for x in place)
        return own if k == 0 else f"{self.body[k]}.{own}"

    def _sites(self) -> dict[int, str]:
        """Sites as points."""
        m = self.m
        return {
            s: self._point(int(m.site_bodyid[s]), m.site(s).name or f"site{s}", m.site_pos[s]) for s in range(m.nsite)
        }

    def _length(self, t: int) -> list[tuple[Decimal, str]] | None:
        """The length of a tendon that is a sum of joints'; None of one through places."""
        m = self.m
        wraps = range(m.tendon_adr[t], m.tendon_adr[t] + m.tendon_num[t])
        if any(m.wrap_type[i] != JOINT_WRAP for i in wraps):
            return None
        return [(decimal_of_double(m.wrap_prm[i]), self.joint[int(m.wrap_objid[i])]) for i in wraps]

    def _tendon_name(self, t: int) -> str:
        return self.m.tendon(t).name or f"tendon{t}"

    def _tendons(self) -> None:
        """Springs and dampers of tendons."""
        m = self.m
        for t in range(m.ntendon):
            name, length = self._tendon_name(t), self._length(t)
            stiff, damping = decimal_of_double(m.tendon_stiffness[t]), decimal_of_double(m.tendon_damping[t])
            ends = self._ends(t)
            if length is None and not ends:
                if stiff or damping or m.tendon_limited[t]:
                    self.leave("tendons through places", [name], "say them by springs, links and strings")
                continue
            if m.tendon_limited[t]:
                self.leave("limits of tendons", [name], "no stop is declared by a limit")
            if m.tendon_armature[t] or m.tendon_frictionloss[t] or any(m.tendon_stiffnesspoly[t]):
                self.leave("armature, friction and bent springs of tendons", [name])
            low, high = (decimal_of_double(x) for x in m.tendon_lengthspring[t])
            if ends:
                self._stretched(name, ends, stiff, damping, (low, high))
                continue
            assert length is not None
            if stiff:
                stretch, beyond = signed_sum(length, -low), signed_sum(length, -high)
                square = f"({stretch})^2" if low == high else f"(min({stretch}, 0)^2 + max({beyond}, 0)^2)"
                spring = {"kind": "potential", "energy": f"{decimal_text(stiff)}/2*{square}"}
                self.found["forces"][self.forces.new(name, "tendon")] = spring
            if damping:
                rate = signed_sum((factor, f"{q}'") for factor, q in length)
                for factor, q in length:
                    self._push(f"{name}_{q}", q, f"{decimal_text(-factor * damping)}*({rate})")

    def _ends(self, t: int) -> list[str]:
        """The two places of a tendon that is straight between them; [] of another one."""
        at = range(self.m.tendon_adr[t], self.m.tendon_adr[t] + self.m.tendon_num[t])
        straight = len(at) == 2 and all(self.m.wrap_type[k] == AT_SITE for k in at)
        return [self.sites[int(self.m.wrap_objid[k])] for k in at] if straight else []

    def _stretched(
        self, name: str, ends: list[str], stiff: Decimal, damping: Decimal, rest: tuple[Decimal, Decimal]
    ) -> None:
        """The spring and the damper of a straight tendon; between two rest lengths it is slack."""
        low, high = rest
        if stiff and low == high:
            spring: Entries = {"kind": "spring", "points": ends, "stiffness": stiff, "length": low}
            self.found["forces"][self.forces.new(name, "tendon")] = spring
        elif stiff:
            beyond = f"min(r - {decimal_text(low)}, 0) + max(r - {decimal_text(high)}, 0)"
            law = {"kind": "between", "points": ends, "pull": f"{decimal_text(stiff)}*({beyond})"}
            self.found["forces"][self.forces.new(name, "tendon")] = law
        if damping:
            damper = {"kind": "damper", "points": ends, "damping": damping}
            self.found["forces"][self.forces.new(f"{name}_damper")] = damper

    def _push(self, name: str, q: str, value: str) -> None:
        """A generalized force along a coordinate."""
        law = {"kind": "generalized", "coordinate": q, "value": value}
        self.found["forces"][self.forces.new(name, "push")] = law

    def _actuators(self) -> None:
        """Motors: an input each, and force = gain w + bias along what it acts on."""
        m = self.m
        for k in range(m.nactuator):
            raw = m.actuator(k).name or f"motor{k}"
            if m.actuator_gaintype[k] not in (FIXED, AFFINE) or m.actuator_biastype[k] not in (0, AFFINE):
                self.leave("motors that are no linear laws", [raw])
                continue
            way, target, gear = int(m.actuator_trntype[k]), int(m.actuator_trnid[k][0]), m.actuator_gear[k]
            length: list[tuple[Decimal, str]] | None = None
            if way in (ON_JOINT, IN_PARENT) and m.jnt_type[target] in (SLIDE, HINGE):
                length = [(Decimal(1), self.joint[target])]
            elif way == ON_TENDON:
                length = self._length(target)
            if length is None and not (way == ON_SITE and m.actuator_trnid[k][1] < 0):
                self.leave("motors on other things than hinges, slides, sums of these, and sites", [raw])
                continue
            if m.actuator_dyntype[k]:
                self.leave("filters of motors", [raw], "the input is the activation")
            if m.actuator_forcelimited[k] or m.actuator_ctrllimited[k]:
                low, high = m.actuator_ctrlrange[k] if m.actuator_ctrllimited[k] else m.actuator_forcerange[k]
                self.leave("limits of motors", [f"{raw} ({low:g} to {high:g})"], "an input has none")
            w = self.names.new(f"motor_{raw}" if raw in self.names.given else raw, "w")
            self.found["inputs"][w] = {"value": 0, **({} if w == raw else {"about": f"motor {raw}"})}
            if length is None:
                self._thruster(k, w, target)
                continue
            ratio = decimal_of_double(gear[0])
            law = self._law(k, w, [(ratio * factor, q) for factor, q in length])
            if way in (ON_JOINT, IN_PARENT):
                self.drives.setdefault(target, []).append(law)
                if m.actuator_armature[k]:
                    rotor = ratio * ratio * decimal_of_double(m.actuator_armature[k])
                    self.rotors[target] = self.rotors.get(target, ZERO) + rotor
                continue
            for factor, q in length:
                plain = law.replace(f"{decimal_text(ratio)}*", "", 1) if ratio != 1 else law
                grouped = f"({plain})" if " " in plain else plain
                self._push(f"{raw}_{q}", q, f"{decimal_text(factor * ratio)}*{grouped}")

    def _law(self, k: int, w: str, length: list[tuple[Decimal, str]]) -> str:
        """gear (gain w + bias), both linear in the length gear L and its rate."""
        m = self.m
        rates = [(factor, f"{q}'") for factor, q in length]
        gear = (
            decimal_of_double(m.actuator_gear[k][0]) if m.actuator_trntype[k] in (ON_JOINT, IN_PARENT) else Decimal(1)
        )

        def affine(numbers: Any) -> str:
            constant, slope, rate = (decimal_of_double(x) for x in numbers[:3])
            along = [(gear * slope * factor, q) for factor, q in length]
            return signed_sum([*along, *((gear * rate * factor, q) for factor, q in rates)], gear * constant)

        gain = m.actuator_gainprm[k]
        push = signed_sum([(gear * decimal_of_double(gain[0]), w)])
        if m.actuator_gaintype[k] == AFFINE:
            push = f"({affine(gain)})*{w}"
        bias = affine(m.actuator_biasprm[k]) if m.actuator_biastype[k] == AFFINE else "0"
        damping = decimal_of_double(m.actuator_damping[k])
        terms = [push, bias, signed_sum((-gear * damping * f, q) for f, q in rates) if damping else "0"]
        return " + ".join(term for term in terms if term != "0").replace("+ -", "- ") or "0"

    def _thruster(self, k: int, w: str, site: int) -> None:
        """A force and a couple in the axes of a site."""
        m, body = self.m, int(self.m.site_bodyid[site])
        if body == 0:
            self.leave("motors on the ground", [w], "they move nothing")
            return
        R, _ = _turned(m.site_quat[site])
        size = decimal_of_double(m.actuator_gainprm[k][0])
        for kind, part in (("force", slice(0, 3)), ("couple", slice(3, 6))):
            along = apply(R, decimals(decimal_of_double(x) for x in m.actuator_gear[k][part]))
            if not any(along):
                continue
            law = [signed_sum([(computed(size * Decimal(str(x))), w)]) for x in along]
            where = {"point": self.sites[site]} if kind == "force" else {"body": self.body[body]}
            self.found["forces"][self.forces.new(w)] = {"kind": kind, **where, kind: law, "axes": self.body[body]}

    def _equalities(self) -> None:
        """Ties: of points, of bodies, of coordinates; in MuJoCo they give way, here they hold."""
        m = self.m
        for e in range(m.neq):
            raw = m.equality(e).name or f"tie{e}"
            if not m.eq_active0[e]:
                self.leave("equalities that are switched off", [raw])
                continue
            made = self._equality(e, raw)
            if made is None:
                self.leave("equalities of other kinds", [raw])
                continue
            self.found["constraints"][self.bodies.new(raw, "tie")] = made
            self.leave("softness of equalities", [raw], "here they hold exactly")

    def _equality(self, e: int, raw: str) -> Entries | None:
        m, kind = self.m, int(self.m.eq_type[e])
        first, second, data = int(m.eq_obj1id[e]), int(m.eq_obj2id[e]), m.eq_data[e]
        if kind in (CONNECT, WELD):
            if m.eq_objtype[e] == SITE:
                if kind == WELD:
                    return None
                return {"kind": "pin", "points": [self.sites[first], self.sites[second]]}
            if kind == CONNECT:
                return {
                    "kind": "pin",
                    "points": [self._point(first, raw, data[:3]), self._point(second, raw, data[3:6])],
                }
            return self._weld(first, second, raw, data)
        if kind not in (JOINT, TENDON):
            return None
        lengths = []
        for which in (first, second):
            if which < 0:
                lengths.append(("0", ZERO))
            elif kind == JOINT:
                lengths.append((self.joint[which], decimal_of_double(m.qpos0[m.jnt_qposadr[which]])))
            else:
                length = self._length(which)
                if length is None:
                    return None
                lengths.append((f"({signed_sum(length)})", decimal_of_double(m.tendon_length0[which])))
        (one, at), (other, other_at) = lengths
        away = other if not other_at else f"({other} - {decimal_text(other_at)})".replace("- -", "+ ")
        powers = [(decimal_of_double(c), away if n == 1 else f"{away}^{n}") for n, c in enumerate(data[:5]) if n]
        terms = [(Decimal(1), one), *((-c, power) for c, power in powers if c and other != "0")]
        return {"kind": "equation", "gap": signed_sum(terms, -at - decimal_of_double(data[0]))}

    def _weld(self, first: int, second: int, raw: str, data: Any) -> Entries | None:
        """Two bodies as they stand: where that is not how they are welded, there is no counterpart."""
        mujoco: Any = importlib.import_module("mujoco")
        state = mujoco.MjData(self.m)
        mujoco.mj_kinematics(self.m, state)
        back, there = state.xmat[first].reshape(3, 3).T, state.xmat[second].reshape(3, 3)
        away = back @ (state.xpos[second] + there @ data[:3] - state.xpos[first])
        turn = mujoco_matrix(mujoco, data[6:10])
        if abs(away - data[3:6]).max() > ROUNDING or abs(back @ there - turn).max() > ROUNDING:
            return None
        points = [self._point(first, raw, data[3:6]), self._point(second, raw, data[:3])]
        return {"kind": "clamp", "points": points}

    def _rest(self) -> None:
        """What else there is in the file."""
        m = self.m
        touching = [m.geom(g).name or f"geom{g}" for g in range(m.ngeom) if m.geom_contype[g] or m.geom_conaffinity[g]]
        drawn = [m.geom(g).name or f"geom{g}" for g in range(m.ngeom)]
        self.leave("geoms that touch", touching, "no contact is declared by a shape: see [constraints]")
        self.leave("geoms that are drawn", [name for name in drawn if name not in touching], "pictures only")
        if m.opt.density or m.opt.viscosity:
            self.leave(
                "fluid", [f"density {m.opt.density:g}, viscosity {m.opt.viscosity:g}"], "say its forces by [forces]"
            )
        for what, size, why in (
            ("cameras", m.ncam, "pictures only"),
            ("lights", m.nlight, "pictures only"),
            ("sensors", m.nsensor, "outputs ask for what is measured"),
            ("keyframes", m.nkey, "start values are set by --start"),
            ("flexible bodies", m.nflex, "bodies are rigid"),
            ("plugins", m.nplugin, "code of a simulator"),
        ):
            self.leave(what, [str(size)] * bool(size), why)


def mujoco_matrix(mujoco: Any, quaternion: Any) -> Any:
    """A rotation as MuJoCo has it."""
    import numpy as np

    found = np.zeros(9)
    mujoco.mju_quat2Mat(found, quaternion)
    return found.reshape(3, 3)


def _turned(quaternion: Any) -> tuple[Nine, list[Entries]]:
    """A quaternion as a rotation and as turns of a model file."""
    e = [Decimal(float(x)) for x in quaternion]
    length = sum((x * x for x in e), ZERO).sqrt()
    unit = tuple(x / length for x in e)
    turns = turn_of(unit)
    return (rotation_of("quaternion", unit) if turns else IDENTITY), turns
