"""Robot files that nobody here wrote, imported, against MuJoCo and Pinocchio: mass matrix, bias and gravity terms.

    python benchmarks/robots.py                     # every file in the wheels that are installed
    python benchmarks/robots.py --only panda
    python benchmarks/robots.py --within FOLDER     # every URDF and MJCF file below a folder: of a wheel unpacked

needs, beside eomgen, an environment with the wheels: pip install mujoco pin example-robot-data dm_control gymnasium.
A row is a file: its degrees of freedom, the time of the import and of the derivation, and the largest difference of M
and of
M a + c - Q at random states, over the largest entry: against each oracle. Exit code 1 where one is above 1e-10.
"""

from __future__ import annotations

import argparse
import importlib.util
import re
import sys
import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

import eomgen
from eomgen.robots.importing import imported
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

BOUND = 1e-10
STATES = 3
G = 9.81
PICTURES = ("visual", "collision", "material", "gazebo", "transmission", "sensor", "ros2_control")


@dataclass
class Row:
    name: str
    degrees_of_freedom: int = 0
    seconds: tuple[float, ...] = ()
    differences: dict[str, float | str] | None = None

    def __str__(self) -> str:
        said = [
            f"{key} {x:.1e}" if isinstance(x, float) else f"{key}: {x}" for key, x in (self.differences or {}).items()
        ]
        spent = " ".join(f"{x:5.2f}" for x in self.seconds)
        return f"{self.name:34.34} {self.degrees_of_freedom:4d} {spent:12} {'; '.join(said)}"

    @property
    def wrong(self) -> bool:
        found = (self.differences or {}).values()
        return not any(isinstance(x, float) for x in found) or any(
            isinstance(x, float) and not x < BOUND for x in found
        )


class Ours:
    """The imported robot as functions of numbers, by the names of its coordinates."""

    def __init__(self, model: Any) -> None:
        self.model = model
        self.equations = eomgen.derive(model)
        self.graph = self.equations.graph
        self.symbols = self.graph.symbols

    def at(self, q: dict[str, float], u: dict[str, float], w: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
        """(M, c - Q) at a state, rows by the order of `speeds`."""
        s = self.symbols
        values = {s.t: 0.0, **dict(zip(s.parameters.values(), self._parameters(), strict=True))}
        values |= {node: q[node.name] for node in s.q} | {node: u[node.name] for node in s.u}
        values |= {node: w[name] if w else 0.0 for name, node in s.inputs.items()}
        n = len(s.u)
        entries = [x for row in self.graph.M for x in row]
        found = evaluate((*entries, *self.graph.c, *self.graph.Q), values, FLOAT)
        M = np.array(found[: n * n], dtype=float).reshape(n, n)
        c, Q = np.array(found[n * n : n * n + n]), np.array(found[n * n + n :])
        return M, np.array(c - Q, dtype=float)

    def _parameters(self) -> Any:
        from eomgen.codegen.rhs import RightHandSide

        return RightHandSide.parameter_values(self.model)


def legal(name: str) -> str:
    plain = re.sub("[^A-Za-z0-9_]+", "_", name).strip("_")
    return plain if plain[0].isalpha() else f"q_{plain}"


def distance(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.max(np.abs(found - expected), initial=0.0) / max(1.0, np.max(np.abs(expected), initial=0.0)))


def against_pinocchio(path: Path, ours: Ours, rng: Any, floating: bool) -> float:
    """M by the composite rigid body algorithm, c - Q by the recursion of Newton and Euler, dampers by the file."""
    import pinocchio as pin

    base = (pin.JointModelFreeFlyer(),) if floating else ()
    model = pin.buildModelFromUrdf(str(path), *base)
    data = model.createData()
    damping = {j.get("name"): float(j.find("dynamics").get("damping", 0)) for j in ElementTree.parse(path).getroot()
               if j.tag == "joint" and j.find("dynamics") is not None}  # fmt: skip
    worst = 0.0
    for _ in range(STATES):
        q, v = pin.neutral(model), rng.uniform(-1, 1, model.nv)
        own_q, own_u, rows = {}, {}, {}
        T, Tdot_v = np.eye(model.nv), np.zeros(model.nv)
        d = np.zeros(model.nv)
        for k in range(1, model.njoints):
            joint, name = model.joints[k], legal(model.names[k])
            iq, iv = joint.idx_q, joint.idx_v
            if joint.nv == 6:
                e = rng.normal(size=4)
                e /= np.linalg.norm(e)
                place, R = rng.uniform(-1, 1, 3), pin.Quaternion(e[0], e[1], e[2], e[3]).toRotationMatrix()
                q[iq : iq + 7] = [*place, e[1], e[2], e[3], e[0]]
                stem = next(c for c in ours.model.coordinates if c.endswith("_e0"))[:-3]
                parts = [f"{stem}_{x}" for x in ("x", "y", "z", "e0", "e1", "e2", "e3")]
                own_q |= dict(zip(parts, [*place, *e], strict=True))
                fast = [f"{stem}_x'", f"{stem}_y'", f"{stem}_z'", f"{stem}_wx", f"{stem}_wy", f"{stem}_wz"]
                u = rng.uniform(-1, 1, 6)
                own_u |= dict(zip(fast, u, strict=True))
                rows |= {name_: iv + i for i, name_ in enumerate(fast)}
                T[iv : iv + 3, iv : iv + 3] = R.T
                v[iv : iv + 3], v[iv + 3 : iv + 6] = R.T @ u[:3], u[3:]
                Tdot_v[iv : iv + 3] = -np.cross(u[3:], R.T @ u[:3])
                continue
            angle = rng.uniform(-2, 2)
            q[iq : iq + joint.nq] = [angle] if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
            own_q[name], own_u[f"{name}'"], rows[f"{name}'"] = angle, v[iv], iv
            d[iv] = damping.get(model.names[k], 0.0)
        M, h = ours.at(own_q, own_u, {})
        full = pin.crba(model, data, q)
        full = np.triu(full) + np.triu(full, 1).T - np.diag(np.asarray(model.armature))
        bias = pin.rnea(model, data, q, v, Tdot_v) + d * v
        order = [rows[u.name] for u in ours.symbols.u]
        worst = max(worst, distance(M, (T.T @ full @ T)[np.ix_(order, order)]), distance(h, (T.T @ bias)[order]))
    return worst


def stripped(path: Path) -> str:
    """A URDF without what needs other files."""
    root = ElementTree.parse(path).getroot()
    for parent in [root, *root.iter("link")]:
        for child in [c for c in parent if c.tag in PICTURES]:
            parent.remove(child)
    settings = ElementTree.SubElement(root, "mujoco")
    ElementTree.SubElement(settings, "compiler", fusestatic="false", discardvisual="true", strippath="true")
    return ElementTree.tostring(root, encoding="unicode")


def against_mujoco(text_or_path: str | Path, ours: Ours, rng: Any) -> float:
    """M by mj_fullM; c - Q is qfrc_bias less what springs, dampers and motors give."""
    import mujoco

    spec = mujoco.MjSpec.from_string(text_or_path) if isinstance(text_or_path, str) else _spec(text_or_path)
    for joint in spec.joints:  # rotors of free and ball joints are among what is left out
        if joint.type in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL):
            joint.armature = 0
    model = spec.compile()
    for limited in (model.actuator_forcelimited, model.jnt_actfrclimited, model.tendon_actfrclimited):
        limited[:] = 0
    model.actuator_actearly[:] = False
    data = mujoco.MjData(model)
    worst = 0.0
    for _ in range(STATES):
        own_q, own_u, rows = {}, {}, {}
        for j in range(model.njnt):
            name = legal(model.joint(j).name or f"joint{j}")
            iq, iv, kind = model.jnt_qposadr[j], model.jnt_dofadr[j], model.jnt_type[j]
            if kind in (2, 3):  # slide, hinge
                own_q[name], own_u[f"{name}'"], rows[f"{name}'"] = rng.uniform(-2, 2), rng.uniform(-1, 1), iv
                data.qpos[iq], data.qvel[iv] = own_q[name], own_u[f"{name}'"]
                continue
            e = rng.normal(size=4)
            e /= np.linalg.norm(e)
            size = 3 if kind == 0 else 0
            place, u = rng.uniform(-1, 1, size), rng.uniform(-1, 1, size + 3)
            data.qpos[iq : iq + size + 4], data.qvel[iv : iv + size + 3] = [*place, *e], u
            parts = [f"{name}_{x}" for x in (*"xyz"[:size], "e0", "e1", "e2", "e3")]
            own_q |= dict(zip(parts, [*place, *e], strict=True))
            fast = [*(f"{name}_{x}'" for x in "xyz"[:size]), *(f"{name}_w{x}" for x in "xyz")]
            own_u |= dict(zip(fast, u, strict=True))
            rows |= {name_: iv + i for i, name_ in enumerate(fast)}
        w = {}
        for k in range(model.nactuator):
            push, raw = 0.3 * rng.uniform(-1, 1), model.actuator(k).name or f"motor{k}"
            reported = [x for x, part in ours.model.inputs.items() if x == raw or part.about == f"motor {raw}"]
            if not reported:
                continue
            filtered = model.actuator_actadr[k] >= 0
            where = data.act if filtered else data.ctrl
            where[model.actuator_actadr[k] if filtered else model.actuator_ctrladr[k]] = push
            w[reported[0]] = push
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CLAMPCTRL
        mujoco.mj_forward(model, data)
        full = np.zeros((model.nv, model.nv))
        try:
            mujoco.mj_fullM(model, data, full)
        except TypeError:
            mujoco.mj_fullM(model, full, data.qM)
        bias = data.qfrc_bias - data.qfrc_spring - data.qfrc_damper - data.qfrc_gravcomp - data.qfrc_actuator
        M, h = ours.at(own_q, own_u, w)
        order = [rows[u.name] for u in ours.symbols.u]
        worst = max(worst, distance(M, full[np.ix_(order, order)]), distance(h, bias[order]))
    return worst


def _spec(path: Path) -> Any:
    from eomgen.robots.mjcf import spec_of

    return spec_of(path)


def files(only: str, within: str) -> list[Path]:
    """The robot files of a folder, or of the wheels."""
    found: list[Path] = []
    if within:
        texts = [*Path(within).rglob("*.urdf"), *Path(within).rglob("*.xml")]
        found = [path for path in texts if b"<robot" in (text := path.read_bytes()) or b"<worldbody" in text]
        return sorted(path for path in found if only in str(path))
    for package, ending in (("dm_control", "xml"), ("gymnasium", "xml"), ("mujoco", "xml")):
        where = importlib.util.find_spec(package)
        if where is not None and where.origin:
            found += sorted(Path(where.origin).parent.rglob(f"*.{ending}"))
    for folder in {Path(p) / "cmeel.prefix" / "share" / "example-robot-data" for p in sys.path}:
        found += sorted(folder.rglob("*.urdf"))
    return [path for path in found if only in str(path)]


def looked_at(path: Path, rng: Any, floating: bool, certify: bool) -> Row:
    row, began = Row(path.stem), time.perf_counter()
    try:
        robot = imported(path, floating=floating) if path.suffix == ".urdf" else imported(path)
    except eomgen.EomgenError as error:
        row.differences = {"no robot": error.what}
        return row
    read = time.perf_counter()
    ours = Ours(robot.model)
    row.degrees_of_freedom, row.differences = len(ours.symbols.u), {}
    row.seconds = (read - began, time.perf_counter() - read)
    oracles = {"pinocchio": lambda: against_pinocchio(path, ours, rng, floating)} if path.suffix == ".urdf" else {}
    if not floating:
        source = stripped(path) if path.suffix == ".urdf" else path
        oracles["mujoco"] = lambda: against_mujoco(source, ours, rng)
    for name, oracle in oracles.items():
        try:
            row.differences[name] = oracle()
        except (ValueError, RuntimeError) as error:
            row.differences[name] = f"refuses ({str(error).splitlines()[0][:60]})"
    if certify:
        began = time.perf_counter()
        row.differences["certificate"] = f"{ours.equations.certify().ok} in {time.perf_counter() - began:.1f} s"
    return row


def main() -> int:
    requested = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    requested.add_argument("--only", default="", help="files whose path holds this text")
    requested.add_argument("--within", default="", help="a folder, instead of the wheels that are installed")
    requested.add_argument("--floating", action="store_true", help="URDF with a free base")
    requested.add_argument("--certify", action="store_true", help="the proof too")
    requested.add_argument("--seed", type=int, default=1)
    given = requested.parse_args()
    warnings.simplefilter("ignore")
    rng, bad = np.random.default_rng(given.seed), 0
    print(f"{'file':34} free import derive  largest difference, over the largest entry")
    for path in files(given.only, given.within):
        if given.floating and path.suffix != ".urdf":
            continue
        row = looked_at(path, rng, given.floating, given.certify)
        print(row, flush=True)
        bad += row.wrong
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
