"""Branches -> bias forces and inverse dynamics (recursive Newton-Euler), mass matrix (composite bodies).

Outward:   w = E w_p + w_J,  U = wd~ + w~ w~,  acc = E (acc_p + U_p p + 2 w_p x p' + p'')
inward:    f = m acc + U h,  n = h x acc + vee(U J - J U^T), both carried to the parent.

Of bias forces a = 0; of inverse dynamics wd gets w_k a_k and acc gets v_k a_k of each column (w_k, v_k).
Source: Featherstone, Rigid Body Dynamics Algorithms (2008), §5.3 and §6.2, in second moments of mass.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.mechanics.bodies.kinematics import GROUND, Motion
from eomgen.mechanics.bodies.loads import Loads, body_wrench, in_ground_axes
from eomgen.mechanics.bodies.tree import Branch, Moments, MotionColumn, origin_of
from eomgen.model.forces.load import Couple, PointForce
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    ZERO,
    Matrix,
    Vector,
    Wrench,
    apply,
    cross,
    dot,
    in_turned_axes,
    minus,
    plus,
    times,
    transposed,
)

InertiaSums = tuple[Vector, Matrix, Vector]


def rate_matrix(w: Vector, wd: Vector) -> Matrix:
    """U = wd~ + w~ w~: points at r accelerate by U r against the origin."""
    xx, yy, zz = w[0] * w[0], w[1] * w[1], w[2] * w[2]
    xy, xz, yz = w[0] * w[1], w[0] * w[2], w[1] * w[2]
    return (
        (-(yy + zz), xy - wd[2], xz + wd[1]),
        (xy + wd[2], -(xx + zz), yz - wd[0]),
        (xz - wd[1], yz + wd[0], -(xx + yy)),
    )


def inertia_wrench(body: Moments, acc: Vector, U: Matrix) -> Wrench:
    """Force m acc + U h and moment h x acc + vee(U J - J U^T) that the motion of a body takes."""
    J = body.J
    f = plus(times(body.m, acc), apply(U, body.h))
    x = J[1][1] * U[2][1] - J[2][2] * U[1][2] + J[1][2] * (U[2][2] - U[1][1]) + J[0][1] * U[2][0] - J[0][2] * U[1][0]
    y = J[2][2] * U[0][2] - J[0][0] * U[2][0] + J[0][2] * (U[0][0] - U[2][2]) + J[1][2] * U[0][1] - J[0][1] * U[2][1]
    z = J[0][0] * U[1][0] - J[1][1] * U[0][1] + J[0][1] * (U[1][1] - U[0][0]) + J[0][2] * U[1][2] - J[1][2] * U[0][2]
    return Wrench(plus(cross(body.h, acc), (x, y, z)), f)


def bias_forces(
    branches: tuple[Branch, ...],
    size: int,
    *,
    base_acceleration: Vector,
    applied: dict[int, Wrench],
    a: Sequence[Scalar] = (),
) -> list[Scalar]:
    """Generalized forces that the motion takes: M a + c - Q of the wrenches, the ground accelerating up for weight.

    Args:
        base_acceleration: minus the field of gravity, ground axes [m/s^2].
        applied: wrenches on branches, working axes, about the joint point.
        a: accelerations, size of them; () where all are 0.
    """
    wrenches = _inertia_wrenches(branches, base_acceleration, a)
    for i, wrench in applied.items():
        own = wrenches[i]
        wrenches[i] = Wrench(minus(own.tau, wrench.tau), minus(own.f, wrench.f))
    forces: list[Scalar] = [0] * size
    for i in reversed(range(len(branches))):
        branch, wrench = branches[i], wrenches[i]
        for k, (w, v) in branch.columns.items():
            forces[k] = forces[k] + dot(w, wrench.tau) + dot(v, wrench.f)
        if branch.parent != GROUND:
            wrenches[branch.parent] = wrenches[branch.parent].plus(wrench_on_parent(branch, wrench))
    return forces


def wrench_on_parent(branch: Branch, wrench: Wrench) -> Wrench:
    """A wrench on a branch as its parent feels it, about the parent's origin in the parent's axes."""
    turned = wrench if branch.E is IDENTITY else wrench.turned(transposed(branch.E))
    return turned.moved(branch.p)


def _inertia_wrenches(branches: tuple[Branch, ...], base_acceleration: Vector, a: Sequence[Scalar]) -> list[Wrench]:
    rates: list[InertiaSums] = []
    accelerations: list[Vector] = []
    wrenches = []
    still: InertiaSums = (ZERO, (ZERO, ZERO, ZERO), ZERO)
    for branch in branches:
        w_p, U_p, wd_p = still if branch.parent == GROUND else rates[branch.parent]
        acc_p = base_acceleration if branch.parent == GROUND else accelerations[branch.parent]
        E = branch.E
        carried_w = in_turned_axes(E, w_p)
        w = plus(carried_w, branch.w)
        wd = plus(plus(in_turned_axes(E, wd_p), branch.w_bias), cross(carried_w, branch.w))
        seat = plus(acc_p, plus(apply(U_p, branch.p), branch.p_bias))
        if any(not is_zero(x) for x in branch.p_rate):
            seat = plus(seat, times(2, cross(w_p, branch.p_rate)))
        acc = in_turned_axes(E, seat)
        if a:
            for k, (turning, sliding) in branch.columns.items():
                wd, acc = plus(wd, times(a[k], turning)), plus(acc, times(a[k], sliding))
        U = rate_matrix(w, wd)
        rates.append((w, U, wd))
        accelerations.append(acc)
        wrenches.append(inertia_wrench(branch.moments, acc, U))
    return wrenches


def composite_mass_matrix(branches: tuple[Branch, ...], size: int) -> list[list[Scalar]]:
    """M by composite bodies: the wrench that a unit acceleration of a joint takes, felt down the tree."""
    composite = [branch.moments for branch in branches]
    for i in reversed(range(len(branches))):
        branch = branches[i]
        if branch.parent != GROUND:
            back = transposed(branch.E) if branch.E is not IDENTITY else IDENTITY
            carried_moments = composite[i].turned(back).moved(branch.p)
            composite[branch.parent] = composite[branch.parent].plus(_polar(carried_moments, branch.E is IDENTITY))
    M: list[list[Scalar]] = [[0] * size for _ in range(size)]
    for i, branch in enumerate(branches):
        for k, column in branch.columns.items():
            _fill(M, k, branches, i, _unit_wrench(composite[i], column))
    return M


def _polar(moments: Moments, plane: bool) -> Moments:
    if not plane:
        return moments
    return Moments(moments.m, moments.h, ((moments.J[0][0] + moments.J[1][1], 0, 0), ZERO, ZERO))


def _unit_wrench(body: Moments, column: MotionColumn) -> Wrench:
    """I S: the wrench that accelerates a body by the column (w, v): U = w~, acc = v."""
    w, v = column
    U = ((0, -w[2], w[1]), (w[2], 0, -w[0]), (-w[1], w[0], 0))
    return inertia_wrench(body, v, U)


def _fill(M: list[list[Scalar]], k: int, branches: tuple[Branch, ...], i: int, wrench: Wrench) -> None:
    """Row and column k of M from the wrench at branch i, walked down to the ground."""
    own = True
    while True:
        for j, (w, v) in branches[i].columns.items():
            entry = dot(w, wrench.tau) + dot(v, wrench.f)
            if own:
                M[k][j] = M[k][j] + entry
            elif j == k:
                M[k][k] = M[k][k] + 2 * entry
            else:
                M[k][j] = M[k][j] + entry
                M[j][k] = M[j][k] + entry
        if branches[i].parent == GROUND:
            return
        wrench = wrench_on_parent(branches[i], wrench)
        i, own = branches[i].parent, False


def applied_wrenches(loads: Loads, branches: tuple[Branch, ...]) -> dict[int, Wrench]:
    """Forces and couples at bodies, as wrenches on branches in working axes about the joint point."""
    motion = loads.motion
    index = motion.index
    total: dict[int, Wrench] = {}
    for load in loads.placed:
        found = _ground_wrench(loads, load) if _plane(motion) else body_wrench(motion, load)
        if found is None:
            continue
        body, wrench = found
        i = index[body]
        link = branches[i].link
        about_joint = wrench.moved(times(-1, apply(branches[i].axes, origin_of(motion, link))))
        total[i] = total[i].plus(about_joint) if i in total else about_joint
    return total


def _plane(motion: Motion) -> bool:
    return motion.scope.model.space == "plane"


def _ground_wrench(loads: Loads, load: PointForce | Couple) -> tuple[str, Wrench] | None:
    """A load about its body's origin in ground axes."""
    motion = loads.motion
    if not isinstance(load, PointForce):
        return load.body, Wrench(in_ground_axes(motion, load.couple, load.axes), ZERO)
    body, r = load.place
    if body is None:
        return None
    f = in_ground_axes(motion, load.force, load.axes)
    return body, Wrench(cross(apply(motion.link(body).pose.R, r), f), f)
