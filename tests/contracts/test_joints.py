"""Contract of the joints: the subspace is the rate of the pose, and the complement is what it leaves."""

import math

import numpy as np
import pytest

from eomgen.model.joints import ALL, Fixed, Free, Joint, Placed, Planar, Prismatic, Revolute

HERE = {"alpha": 0.7, "pi": math.pi}
STEP = 1e-6

JOINTS = {
    "fixed": (Fixed(axis=[1, 2, 2], angle="alpha"), "space"),
    "revolute about z": (Revolute(angle="q"), "plane"),
    "revolute about any axis": (Revolute(axis=[1, -2, 3], angle="q"), "space"),
    "revolute about a symbolic axis": (Revolute(axis=["sin(alpha)", 0, "cos(alpha)"], angle="q"), "space"),
    "prismatic in the plane": (Prismatic(axis=[3, 4], displacement="q", angle="alpha"), "plane"),
    "prismatic in space": (Prismatic(axis=[1, 2, -1], displacement="q", angle="alpha"), "space"),
    "planar": (Planar(x="x", y="y", angle="q"), "space"),
    "free": (Free(x="x", y="y", angle="q"), "plane"),
    "placed in the plane": (Placed(at=["x", "y"], angle="q"), "plane"),
    "placed in space": (Placed(at=["x", "y", "z"], angle="q", axis=[1, 1, 0]), "space"),
    "placed by zxz": (Placed(at=["x", "y", "z"], orientation="zxz", angles=["a", "b", "c"]), "space"),
    "placed by xyz": (Placed(orientation="xyz", angles=["a", "b", "c"]), "space"),
}


def value(expression):
    return float(expression.evaluate(HERE))


def state(joint: Joint, space: str) -> tuple[float, ...]:
    """Some values of the joint's variables."""
    return tuple(0.3 + 0.4 * k for k in range(len(joint.variables(space))))


def twist_by_difference(joint: Joint, s: tuple[float, ...], k: int) -> np.ndarray:
    """(w, v) in the child's axes at the joint point from the poses at s +- h e_k: w~ = R^T R', v = R^T p'."""
    ends = []
    for h in (STEP, -STEP):
        pose = joint.pose(tuple(x + h * (i == k) for i, x in enumerate(s)), value)
        ends.append((np.array(pose.R, dtype=float), np.array(pose.p, dtype=float)))
    R = np.array(joint.pose(s, value).R, dtype=float)
    spin = R.T @ (ends[0][0] - ends[1][0]) / (2 * STEP)
    v = R.T @ (ends[0][1] - ends[1][1]) / (2 * STEP)
    return np.array([spin[2, 1], spin[0, 2], spin[1, 0], *v])


@pytest.mark.parametrize(("joint", "space"), JOINTS.values(), ids=JOINTS.keys())
def test_the_subspace_is_the_rate_of_the_pose(joint, space):
    """S s' = d/dt pose, column by column; R is a rotation."""
    s = state(joint, space)
    S = joint.subspace(s, value)
    assert len(S) == len(s)
    for k, column in enumerate(S):
        assert np.array(column, dtype=float) == pytest.approx(twist_by_difference(joint, s, k), abs=1e-8)
    R = np.array(joint.pose(s, value).R, dtype=float)
    assert R.T @ R == pytest.approx(np.eye(3)) and np.linalg.det(R) == pytest.approx(1)


@pytest.mark.parametrize(("joint", "space"), JOINTS.values(), ids=JOINTS.keys())
def test_the_complement_does_no_work_on_the_subspace_and_spans_the_rest(joint, space):
    """S^T W = 0 and rank S + rank W = 6; a joint that carries no reaction has no W."""
    s = state(joint, space)
    S = np.array(joint.subspace(s, value), dtype=float).reshape(-1, 6)
    W = np.array(joint.complement(s, value), dtype=float).reshape(-1, 6)
    assert np.linalg.matrix_rank(S) == len(S) if len(S) else True
    if not joint.carries_reaction:
        assert len(W) == 0
        return
    assert S @ W.T == pytest.approx(np.zeros((len(S), len(W))), abs=1e-12)
    assert len(S) + np.linalg.matrix_rank(W) == 6 == len(S) + len(W)


@pytest.mark.parametrize(("joint", "space"), JOINTS.values(), ids=JOINTS.keys())
def test_in_the_plane_the_turn_is_the_angle_of_the_pose(joint, space):
    """R = Rot(z, turn) where the model is in the plane."""
    if space == "plane":
        s = state(joint, space)
        R, turn = joint.pose(s, value).R, joint.turn(s, value)
        assert (R[0][0], R[1][0]) == pytest.approx((math.cos(turn), math.sin(turn)))


def test_the_orientation_is_the_product_of_the_turns():
    """zxz: R = Rz(psi) Rx(theta) Rz(phi), child to parent."""
    joint = JOINTS["placed by zxz"][0]
    psi, theta, phi = 0.3, 0.5, 0.9

    def about(k: int, a: float) -> np.ndarray:
        i, j = (k + 1) % 3, (k + 2) % 3
        R = np.eye(3)
        R[i, i] = R[j, j] = math.cos(a)
        R[j, i], R[i, j] = math.sin(a), -math.sin(a)
        return R

    R = np.array(joint.pose((0, 0, 0, psi, theta, phi), value).R, dtype=float)
    assert R == pytest.approx(about(2, psi) @ about(0, theta) @ about(2, phi))


def test_efforts_belong_to_the_variables():
    """One effort (or none) a variable; a hinge's torque, spring, damper and rotor."""
    effort = Revolute(angle="q", torque="tau", stiffness="k", damping="c", rest=1, armature="J").efforts()[0]
    assert [e.text for e in (effort.drive, effort.stiffness, effort.damping, effort.rest, effort.armature)] == [
        "tau", "k", "c", "1", "J",
    ]  # fmt: skip
    assert Prismatic(axis=[1, 0], displacement="s", force="F").efforts()[0].drive.text == "F"


def test_every_joint_is_tried_here_or_says_that_it_waits():
    """A member of ALL either works and keeps this contract, or is marked."""
    tried = {type(joint) for joint, _ in JOINTS.values()}
    assert {cls for cls in ALL if cls.works} == tried
