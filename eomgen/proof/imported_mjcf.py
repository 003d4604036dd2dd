"""MJCF file, the model made of it, its equations -> check that it stands, weighs and accelerates as in MuJoCo.

    T of every body,    M u' = Q - c    against    M u' = actuators + passive forces - bias

at positions and speeds that are nothing special, every input 0.7: MuJoCo computes them, in doubles, by its own way.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.model import Model
from eomgen.proof.check import first_wrong
from eomgen.proof.posed_model import PosedModel, poses_differ
from eomgen.symbolic.numeric import evaluate, tolerances

FREE, BALL = 0, 1  # the numbers of MuJoCo, of joints
JOINT_WRAP, SITE_WRAP = 1, 3  # of the path of a tendon
JOINT, IN_PARENT, TENDON, SITE = 0, 1, 3, 4  # of the target of a motor
FIXED, AFFINE = 0, 1  # of its gain and bias
OTHER_THINGS = "motors on other things than joints, tendons between two places, and sites"
NO_LAWS, OFF, STANDING = "motors that are no linear laws", "motors that are switched off", "motors on the ground"
LIMITS = ("actuator_ctrl", "actuator_force", "actuator_act", "jnt_actfrc", "tendon_actfrc")
UNLIMITED = ("start beyond limits", "limits that leave no range")
PUSHED = 0.7  # of every input
# left out; they act by constraints of MuJoCo alone, which are in none of the forces that are compared
OF_CONSTRAINTS = (
    *("limits of tendons", "limits of free and ball joints", "limits of motors", "softness of frictionloss"),
    *("softness of limits", "start beyond limits", "limits that leave no range"),
    *("geoms that touch", "pairs of geoms that touch", "friction of free and ball joints", "inputs of motors"),
    *("softness of equalities", "equalities that are switched off", "motion of a mocap body"),
)

DELAYS = "delays of motors"  # act with no force where inputs are and were 0
NAMED = (OTHER_THINGS, NO_LAWS, OFF, STANDING)  # of motors each by its name: they are silenced, and the others compared
Left = tuple[str, tuple[str, ...]]  # kind of thing without a counterpart, and the names of each


def mjcf_otherwise(
    path: str, source: bytes, model: Model, equations: EquationsOfMotion | None, left_out: Sequence[Left]
) -> str:
    """Message that names a body which differs from MuJoCo's; "" where all that have the same name in both agree.

    Args:
        source: the file as it was read, where `path` is a pipe.
        equations: of the model; None: no forces are compared.
        left_out: things of the file that change the motion and have no counterpart.
    """
    mujoco: Any = importlib.import_module("mujoco")
    try:
        xml = mujoco.MjModel
        m = xml.from_xml_path(path) if Path(path).is_file() else xml.from_xml_string(source.decode())
    except ValueError:  # files of pictures are missing
        return ""
    proof = _Compiled(mujoco, m, model)
    more = {what for what, _ in left_out} - {*OF_CONSTRAINTS, *NAMED, "filters of motors"}
    push = PUSHED if not more else 0.0 if more == {DELAYS} else None
    left = proof.lacks(left_out)  # they are silenced before forces are compared
    forces = () if equations is None else proof.accelerates(equations, push)
    free = {name for what, names in left_out if what in UNLIMITED for name in names}
    own = (*proof.has([what for what, _ in left_out]), *proof.holds(free))
    return first_wrong((*left, *own, *proof.stands(), *proof.weighs(), *forces))


class _Compiled:
    """MuJoCo's model and ours, at the same positions and speeds."""

    def __init__(self, mujoco: Any, m: Any, model: Model) -> None:
        self.mujoco, self.m, self.model, self.posed = mujoco, m, model, PosedModel(model)
        self.data = mujoco.MjData(m)
        self.speeds: list[str] = []  # by the number of MuJoCo
        self.all_known = True
        for j in range(m.njnt):
            self._set(j)

    def _set(self, j: int) -> None:
        """A joint's positions are those of ours."""
        name, at = self.m.joint(j).name, int(self.m.jnt_qposadr[j])
        if self.m.jnt_type[j] not in (FREE, BALL):
            q = self.posed.coordinates.get(name or f"joint{j}")
            self.all_known &= q is not None
            self.data.qpos[at] = self.posed.values.get(q or "", 0.0)
            self.speeds.append(f"{q}'")
            return
        body = self.posed.bodies.get(self.m.body(self.m.jnt_bodyid[j]).name)
        turn = () if body is None else self.posed.quaternion(body)
        self.all_known &= bool(turn)
        if body is not None and turn:
            places = self.posed.variables(body, "position")
            self.data.qpos[at : at + len(places) + 4] = [self.posed.values[x] for x in (*places, *turn)]
            omega = getattr(self.model.bodies[body].joint, "omega", ())
            self.speeds += [*(f"{x}'" for x in places), *map(str, omega or ())]

    def lacks(self, left_out: Sequence[Left]) -> list[str]:
        """Names of motors that are left out and could be in the model; they do not push from now on."""
        m, found = self.m, []
        number = {m.actuator(k).name or f"motor{k}": k for k in range(m.nu)}
        could: dict[str, Callable[[int], bool]] = {
            OTHER_THINGS: self._is_reached,
            NO_LAWS: self._is_linear,
            OFF: self._is_on,
            STANDING: self._is_carried,
        }
        for what, names in left_out:
            for name in names if what in could else ():
                k = number.get(name)
                if k is None or could[what](k):
                    found.append(f"'{name}' is left out, and is none of '{what}'")
                else:
                    m.actuator_gaintype[k] = m.actuator_biastype[k] = FIXED
                    m.actuator_gainprm[k] = m.actuator_biasprm[k] = 0
        return found

    def _is_on(self, k: int) -> bool:
        """True if no flag and no group switches a motor off."""
        return not (self._off("ACTUATION") or int(self.m.opt.disableactuator) & 1 << int(self.m.actuator_group[k]) % 31)

    def _is_carried(self, k: int) -> bool:
        """True if a motor acts on a body that moves, or on no site."""
        return bool(self.m.actuator_trntype[k] != SITE or self.m.site_bodyid[self.m.actuator_trnid[k][0]] != 0)

    def _is_reached(self, k: int) -> bool:
        """True if a motor acts on a joint, on a tendon that is a sum of joints or straight, or at a site."""
        m, way, target = self.m, self.m.actuator_trntype[k], int(self.m.actuator_trnid[k][0])
        if way == TENDON:
            wraps = m.wrap_type[m.tendon_adr[target] :][: m.tendon_num[target]]
            return bool((wraps == JOINT_WRAP).all() or [*wraps] == [SITE_WRAP] * 2)
        if way == IN_PARENT:  # the axes of a parent are a body's, where no other joint stands between
            return bool(m.jnt_type[target] not in (FREE, BALL) or m.body_jntadr[m.jnt_bodyid[target]] == target)
        return bool(way == JOINT or (way == SITE and m.actuator_trnid[k][1] < 0))

    def _is_linear(self, k: int) -> bool:
        """True if the force of a motor along a single length is linear in it, its rate and the input."""
        m, way, target = self.m, self.m.actuator_trntype[k], int(self.m.actuator_trnid[k][0])
        along = way == TENDON or (way in (JOINT, IN_PARENT) and m.jnt_type[target] not in (FREE, BALL))
        linear = m.actuator_gaintype[k] in (FIXED, AFFINE) and m.actuator_biastype[k] in (FIXED, AFFINE)
        constants = (*m.actuator_gainprm[k][:3], *m.actuator_biasprm[k][:3])
        return bool(along and linear and np.isfinite(constants).all())

    def has(self, left_out: Sequence[str]) -> Iterator[str]:
        """Names of things that are said to be left out, and that MuJoCo has."""
        m = self.m
        there = {
            "motors by plugins": m.nplugin,
            "filters of motors": (m.actuator_dyntype != 0).any(),
            "fluid": m.opt.density or m.opt.viscosity,
            "tendons through places": (m.wrap_type != JOINT_WRAP).any(),
            "limits of motors": any(limited.any() for limited in self._limits()),
            "limits of tendons": m.tendon_limited.any(),
            "softness of limits": m.jnt_limited.any(),
            "start beyond limits": m.jnt_limited.any(),
            "softness of frictionloss": m.dof_frictionloss.any(),
            "pairs of geoms that touch": m.npair,
        }
        yield from (f"'{what}' are left out, and there are none" for what in left_out if not there.get(what, True))

    def holds(self, unlimited: Collection[str]) -> Iterator[str]:
        """Limits and friction losses of hinges and slides.

        Args:
            unlimited: coordinates that are said to have no stops here.
        """
        m = self.m
        limited = m.jnt_limited * (not self._off("LIMIT") and not self._off("CONSTRAINT"))
        rubs = m.dof_frictionloss * (not self._off("FRICTIONLOSS") and not self._off("CONSTRAINT"))
        joints = {name: part.joint for name, part in self.model.bodies.items() if part.joint is not None}
        for j in range(m.njnt):
            q = self.posed.coordinates.get(m.joint(j).name or f"joint{j}")
            ways = {body: joint.variables("space") for body, joint in joints.items()}
            own = [body for body, way in ways.items() if any(q in x.names for x in way)]
            if m.jnt_type[j] in (FREE, BALL) or len(own) != 1:
                continue
            offset = float(m.qpos0[m.jnt_qposadr[j]])
            due = m.jnt_range[j] - offset if limited[j] and q not in unlimited else np.array([-np.inf, np.inf])
            here = self.posed.stops(own[0])
            same = np.allclose(here, due, atol=tolerances.COMPUTED)
            yield "" if same else f"'{q}' has stops at {list(here)}, not at {list(due)}"
            size = next((self.posed.number(law.size) for _, _, law in joints[own[0]].frictions), 0.0)
            off = abs(size - rubs[m.jnt_dofadr[j]]) > tolerances.COMPUTED * (1 + abs(size))
            yield f"'{q}' rubs with {size:.9g}, not {rubs[m.jnt_dofadr[j]]:.9g}" if off else ""

    def _off(self, flag: str) -> bool:
        return bool(self.m.opt.disableflags & int(getattr(self.mujoco.mjtDisableBit, f"mjDSBL_{flag}")))

    def _limits(self) -> Iterator[Any]:
        """Masks of motors, joints and tendons whose motor forces are bounded; older versions of MuJoCo lack some."""
        return (getattr(self.m, f"{each}limited") for each in LIMITS if hasattr(self.m, f"{each}limited"))

    def stands(self) -> Iterator[str]:
        """Every body in the ground."""
        self.mujoco.mj_kinematics(self.m, self.data)
        for k, name in self._bodies():
            due = self.data.xmat[k].reshape(3, 3), self.data.xpos[k]
            off = self.all_known and poses_differ(self.posed.pose(name), due)
            yield f"'{name}' does not stand where MuJoCo has it" if off else ""

    def weighs(self) -> Iterator[str]:
        """Mass, mass centre, inertia."""
        for k, name in self._bodies():
            rows, m = np.zeros(9), float(self.m.body_mass[k])
            self.mujoco.mju_quat2Mat(rows, self.m.body_iquat[k])
            R = rows.reshape(3, 3)
            I = R @ np.diag(self.m.body_inertia[k]) @ R.T
            due = np.array([m, *(m * self.m.body_ipos[k]), *I.ravel()])
            yield (
                f"'{name}' has another mass, mass centre or inertia"
                if abs(self.posed.weight(name) - due).max() > _fine(due)
                else ""
            )

    def accelerates(self, equations: EquationsOfMotion, push: float | None) -> Iterator[str]:
        """M, and Q - c with every input so large; None where something else pushes."""
        s = equations.symbols
        order = [x.name for x in s.u]
        if not self.all_known or sorted(order) != sorted(self.speeds):
            return
        rates = {name: 0.2 + 0.13 * k for k, name in enumerate(self.speeds)}
        self.data.qvel[:] = list(rates.values())
        for limited in self._limits():
            limited[:] = 0
        self.data.ctrl[:] = push or 0.0
        if hasattr(self.m, "actuator_actearly"):
            self.m.actuator_actearly[:] = 0
        self.data.act[:] = push or 0.0  # behind a filter the input is the activation
        self.mujoco.mj_forward(self.m, self.data)
        full = np.zeros((self.m.nv, self.m.nv))
        for column, one in zip(full, np.eye(self.m.nv), strict=True):
            self.mujoco.mj_mulM(self.m, self.data, column, one)
        n, at = len(order), [self.speeds.index(name) for name in order]
        due = self.data.qfrc_actuator + self.data.qfrc_passive - self.data.qfrc_bias
        known = {
            **self.posed.values_in(equations.system.motion),
            **{x: rates[x.name] for x in s.u},
            **dict.fromkeys(s.inputs.values(), push or 0.0),
        }
        scalars = [
            *(x for row in equations.M for x in row),
            *(q - c for q, c in zip(equations.Q, equations.c, strict=True)),
        ]
        found = np.array([float(x) for x in evaluate(scalars, known)])
        M, forces = found[: n * n].reshape(n, n), found[n * n :]
        full, due = full[np.ix_(at, at)], due[at]
        for k, name in enumerate(order):
            yield f"the inertia that {name} meets is another one" if abs(M[k] - full[k]).max() > _fine(full) else ""
            off = push is not None and abs(forces[k] - due[k]) > _fine(due)
            yield f"{name} is pushed by {forces[k]:.9g}, not {due[k]:.9g}" if off else ""

    def _bodies(self) -> Iterator[tuple[int, str]]:
        for k in range(1, self.m.nbody):
            name = self.posed.bodies.get(self.m.body(k).name or f"body{k}")
            if name is not None:
                yield k, name


def _fine(values: np.ndarray) -> float:
    return float(tolerances.CARRIED * (1 + abs(values).max()))
