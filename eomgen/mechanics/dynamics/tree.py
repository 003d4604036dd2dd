"""Motion -> Branches: the tree of bodies for the recursive methods, and the Newton-Euler recursion over it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import GROUND, BodyLink, Loads, Motion, shorter
from eomgen.model import Couple, PointForce
from eomgen.symbolic.expression import Fraction, Matrix, Node, Scalar, Vector, Wrench, is_zero, symbols_of, tangent

# -------- tree ------------------------------------------------------------------------------------------------
# Motion -> Branches: the tree of bodies as the recursive methods walk it.
#
# Each branch has working axes, in which its vectors are written, and its origin at its joint point. In space the
# working axes are the body's own (then its inertia is constant); in the plane they are the ground's (then nothing has
# to be turned on the way from body to body). Inertia is held as the second moments of mass m, h = int r dm, J = int r
# r^T dm, about that origin.


MotionColumn = tuple[Vector, Vector]


@dataclass(frozen=True)
class Moments:
    """Second moments of mass about a branch's origin: m [kg], h = int r dm [kg m], J = int r r^T dm [kg m^2].

    The inertia tensor is tr(J) 1 - J; the force and moment of inertia of a body whose points
    accelerate by acc + U r are f = m acc + U h and n = h x acc + vee(U J - J U^T).
    """

    m: Scalar
    h: Vector
    J: Matrix

    def plus(self, other: Moments) -> Moments:
        return Moments(self.m + other.m, self.h + other.h, self.J + other.J)

    def turned(self, R: Matrix) -> Moments:
        """The same mass in the axes to which R leads: R h, R J R^T."""
        return self if R is Matrix.IDENTITY else Moments(self.m, R @ self.h, _congruence(R, self.J))

    def moved(self, p: Vector) -> Moments:
        """About the point that sees the present origin at p: h + m p, J + p h^T + h p^T + m p p^T."""
        g = self.h + self.m * p  # p h^T + h p^T + m p p^T = p h^T + g p^T
        J = {(i, j): self.J[i][j] + (p[i] * self.h[j] + g[i] * p[j]) for i in range(3) for j in range(i, 3)}
        return Moments(self.m, g, symmetric(J))


@dataclass(frozen=True)
class Branch:
    """One body as the recursions see it, in its working axes, at its origin: the joint point.

    Args:
        link: the body.
        parent: index of the parent branch, GROUND for the ground.
        E: from the parent's working axes to its own (the rotation of vectors).
        p: from the parent's origin to its own, parent's working axes [m].
        p_rate, p_bias: apparent velocity and acceleration (at a = 0) of its origin in the parent, parent's axes.
        w, w_bias: angular velocity against the parent and its apparent rate at a = 0, own axes.
        columns: per speed index k the column of the joint's own twist, at the origin.
        moments: mass of the body, regrouped: mass that a hinge cannot distinguish from mass of its parent is put there.
        axes: from body axes to working axes.
    """

    link: BodyLink
    parent: int
    E: Matrix
    p: Vector
    p_rate: Vector
    p_bias: Vector
    w: Vector
    w_bias: Vector
    columns: dict[int, MotionColumn]
    moments: Moments
    axes: Matrix


def branches_of(motion: Motion) -> tuple[Branch, ...]:
    """The tree of bodies for the recursions, parents first."""
    plane = motion.scope.model.space == "plane"
    offsets = [offset_of(motion, link) for link in motion.links]
    moments = _regrouped(motion, offsets, plane)
    branches = []
    for i, link in enumerate(motion.links):
        branches.append(_branch(motion, link, offsets[i], moments[i], plane))
    return tuple(branches)


def origin_of(motion: Motion, link: BodyLink) -> Vector:
    """A branch's origin in body axes: the joint point, or the body's own origin where the joint slides along it."""
    return Vector.ZERO if motion.moves(link.point) else link.point


def offset_of(motion: Motion, link: BodyLink) -> Vector:
    """Vector from the parent's origin to this branch's, in the parent's body axes."""
    place = link.local.point(origin_of(motion, link) - link.point)
    return place if link.parent == GROUND else place - origin_of(motion, motion.links[link.parent])


def _branch(motion: Motion, link: BodyLink, offset: Vector, moments: Moments, plane: bool) -> Branch:
    scope = motion.scope
    parent_axes = Matrix.IDENTITY if link.parent == GROUND or not plane else motion.links[link.parent].pose.R
    axes = link.pose.R if plane else Matrix.IDENTITY
    E = Matrix.IDENTITY if plane else link.local.R.T
    rate = scope.rate_of(offset)
    bias = scope.rate_of(rate)
    directions = [axes @ w for w, _ in link.S]
    w = w_bias = Vector.ZERO
    s_bias = scope.time_derivative(link.s_rate)
    for direction, (body_direction, _), s_rate, s_acc in zip(directions, link.S, link.s_rate, s_bias, strict=True):
        w = w + s_rate * direction
        turning = axes @ scope.rate_of(body_direction)
        w_bias = w_bias + (s_acc * direction + s_rate * turning)
    own_rate = parent_axes @ rate
    if scope.combines:
        w = Vector(map(shorter, w))
        w_bias = scope.rate_of(w)
    return Branch(
        link,
        link.parent,
        E,
        parent_axes @ offset,
        own_rate,
        parent_axes @ bias,
        w,
        w_bias,
        _columns(motion, w, own_rate if plane else E @ rate),
        moments,
        axes,
    )


def _columns(motion: Motion, w: Vector, v: Vector) -> dict[int, MotionColumn]:
    """The branch's twist against its parent per unit of each speed on which it depends."""
    speeds = {u: k for k, u in enumerate(motion.scope.symbols.u)}
    columns = {}
    for symbol in symbols_of((*w, *v)):
        if symbol in speeds:
            rates = tangent((*w, *v), {symbol: 1})
            columns[speeds[symbol]] = (Vector(rates[:3]), Vector(rates[3:]))
    return dict(sorted(columns.items()))


def _regrouped(motion: Motion, offsets: list[Vector], plane: bool) -> list[Moments]:
    """Moments of every body, those that a hinge cannot feel moved to the parent.

    Mass on the line of a hinge's axis moves as if it belonged to the parent: its m, h.n and n.J n
    are carried over (in the plane: its m), which leaves fewer terms in every branch but the first.
    Source: Khalil & Dombre, Modeling, Identification and Control of Robots, §9.4 (base parameters).
    """
    moments = [_own_moments(motion, link, plane) for link in motion.links]
    for i in reversed(range(len(moments))):
        link = motion.links[i]
        k = _hinge_axis(motion, link, offsets[i])
        if k is None:
            continue
        m, h, J = moments[i].m, moments[i].h, moments[i].J
        along = 2 if plane else k
        kept_h = Vector(0 if j == along else h[j] for j in range(3))
        kept_J = Matrix.of((0 if i_ == j_ == along else J[i_][j_] for j_ in range(3)) for i_ in range(3))
        moments[i] = Moments(0, kept_h, kept_J)
        if link.parent == GROUND:
            continue
        d = Vector(row[k] for row in link.before.R)
        line = Moments(m, h[k] * d, Matrix.of(J[k][k] * a * d for a in d))
        moments[link.parent] = moments[link.parent].plus(_flat(line.moved(offsets[i]), plane))
    return [Moments(b.m, link.pose.R @ b.h, b.J) if plane else b for b, link in zip(moments, motion.links, strict=True)]


def _own_moments(motion: Motion, link: BodyLink, plane: bool) -> Moments:
    body = motion.scope.mass_properties(link.name)
    half_trace = Fraction(1, 2) * (body.I[0][0] + body.I[1][1] + body.I[2][2])
    J = Matrix.of(((half_trace if i == j else 0) - body.I[i][j] for j in range(3)) for i in range(3))
    if plane:
        J = Matrix.of(((body.I[2][2], 0, 0), Vector.ZERO, Vector.ZERO))
    com = body.com - origin_of(motion, link)
    return _flat(Moments(body.m, Vector.ZERO, J).moved(com), plane)


def _flat(moments: Moments, plane: bool) -> Moments:
    """Moments of the body; in the plane with the polar moment Jxx + Jyy in place of Jxx, which no rotation changes."""
    if not plane:
        return moments
    polar = moments.J[0][0] + moments.J[1][1]
    return Moments(moments.m, moments.h, Matrix.of(((polar, 0, 0), Vector.ZERO, Vector.ZERO)))


def _hinge_axis(motion: Motion, link: BodyLink, offset: Vector) -> int | None:
    """The coordinate axis about which a single hinge turns at a place fixed in its parent, else None."""
    if len(link.S) != 1 or any(type(x) is not int or x != 0 for x in link.S[0][1]):
        return None
    w = link.S[0][0]
    if sorted((type(x) is int, abs(x) if type(x) is int else 2) for x in w) != [(True, 0), (True, 0), (True, 1)]:
        return None
    if motion.moves((*offset, *link.point, *(x for row in link.before.R for x in row))):
        return None
    return next(k for k in range(3) if w[k] != 0)


def _congruence(R: Matrix, J: Matrix) -> Matrix:
    """R J R^T for symmetric J; the diagonal entry of the busiest row comes from the trace, which stays.

    What stands twice on the diagonal, A, is felt in no direction apart: R J R^T = R (J - A 1) R^T + A 1.
    """
    (A, times_there), *_ = Counter(J[i][i] for i in range(3)).most_common()
    if times_there > 1 and not is_zero(A):
        part = Matrix.of((J[i][j] - A if i == j else J[i][j] for j in range(3)) for i in range(3))
        turned = _congruence(R, part)
        return Matrix.of((turned[i][j] + A if i == j else turned[i][j] for j in range(3)) for i in range(3))
    last = max(range(3), key=lambda i: (sum(type(x) is Node for x in R[i]), i))
    first, second = (i for i in range(3) if i != last)
    half = {i: J.T @ R[i] for i in (first, second)}
    entry = {(i, j): half[i] @ R[j] for i, j in ((first, first), (second, second), (first, second))}
    entry |= {(i, last): half[i] @ R[last] for i in (first, second)}
    entry[last, last] = _rest_of_trace([J[i][i] for i in range(3)], [entry[first, first], entry[second, second]])
    return symmetric(entry)


def symmetric(entry: Mapping[tuple[int, int], Scalar]) -> Matrix:
    """The matrix, 3 x 3, of which one of each two equal entries is given."""
    return Matrix.of((entry[i, j] if (i, j) in entry else entry[j, i] for j in range(3)) for i in range(3))


def _rest_of_trace(terms: list[Scalar], known: list[Scalar]) -> Scalar:
    """The sum of the terms less the known ones; what stands on both sides is left out."""
    rest: Scalar = 0
    for x in known:
        same = next((k for k, term in enumerate(terms) if term is x), None)
        if same is None:
            rest = rest - x
        else:
            terms.pop(same)
    return sum(terms, start=rest)


# -------- recursion -------------------------------------------------------------------------------------------
# Branches -> bias forces and inverse dynamics (recursive Newton-Euler), mass matrix (composite bodies).
#
# Outward:   w = E w_p + w_J,  U = wd~ + w~ w~,  acc = E (acc_p + U_p p + 2 w_p x p' + p'') inward:    f = m acc + U
# h,  n = h x acc + vee(U J - J U^T), both carried to the parent.
#
# Of bias forces a = 0; of inverse dynamics wd gets w_k a_k and acc gets v_k a_k of each column (w_k, v_k). Source:
# Featherstone, Rigid Body Dynamics Algorithms (2008), §5.3 and §6.2, in second moments of mass.


InertiaSums = tuple[Vector, Matrix, Vector]


def rate_matrix(w: Vector, wd: Vector) -> Matrix:
    """U = wd~ + w~ w~: points at r accelerate by U r against the origin."""
    xx, yy, zz = w[0] * w[0], w[1] * w[1], w[2] * w[2]
    xy, xz, yz = w[0] * w[1], w[0] * w[2], w[1] * w[2]
    return Matrix.of(
        (
            (-(yy + zz), xy - wd[2], xz + wd[1]),
            (xy + wd[2], -(xx + zz), yz - wd[0]),
            (xz - wd[1], yz + wd[0], -(xx + yy)),
        )
    )


def inertia_wrench(body: Moments, acc: Vector, U: Matrix) -> Wrench:
    """Force m acc + U h and moment h x acc + vee(U J - J U^T) that the motion of a body takes."""
    J = body.J
    f = body.m * acc + U @ body.h
    x = J[1][1] * U[2][1] - J[2][2] * U[1][2] + J[1][2] * (U[2][2] - U[1][1]) + J[0][1] * U[2][0] - J[0][2] * U[1][0]
    y = J[2][2] * U[0][2] - J[0][0] * U[2][0] + J[0][2] * (U[0][0] - U[2][2]) + J[1][2] * U[0][1] - J[0][1] * U[2][1]
    z = J[0][0] * U[1][0] - J[1][1] * U[0][1] + J[0][1] * (U[1][1] - U[0][0]) + J[0][2] * U[1][2] - J[1][2] * U[0][2]
    return Wrench(body.h.cross(acc) + Vector((x, y, z)), f)


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
        wrenches[i] = Wrench(own.tau - wrench.tau, own.f - wrench.f)
    forces: list[Scalar] = [0] * size
    for i in reversed(range(len(branches))):
        branch, wrench = branches[i], wrenches[i]
        for k, (w, v) in branch.columns.items():
            forces[k] = forces[k] + w @ wrench.tau + v @ wrench.f
        if branch.parent != GROUND:
            wrenches[branch.parent] = wrenches[branch.parent].plus(wrench_on_parent(branch, wrench))
    return forces


def wrench_on_parent(branch: Branch, wrench: Wrench) -> Wrench:
    """A wrench on a branch as its parent feels it, about the parent's origin in the parent's axes."""
    turned = wrench if branch.E is Matrix.IDENTITY else wrench.turned(branch.E.T)
    return turned.moved(branch.p)


def _inertia_wrenches(branches: tuple[Branch, ...], base_acceleration: Vector, a: Sequence[Scalar]) -> list[Wrench]:
    rates: list[InertiaSums] = []
    accelerations: list[Vector] = []
    wrenches = []
    still: InertiaSums = (Vector.ZERO, Matrix((Vector.ZERO, Vector.ZERO, Vector.ZERO)), Vector.ZERO)
    for branch in branches:
        w_p, U_p, wd_p = still if branch.parent == GROUND else rates[branch.parent]
        acc_p = base_acceleration if branch.parent == GROUND else accelerations[branch.parent]
        E = branch.E
        carried_w = E @ w_p
        w = carried_w + branch.w
        wd = E @ wd_p + branch.w_bias + carried_w.cross(branch.w)
        seat = acc_p + (U_p @ branch.p + branch.p_bias)
        if any(not is_zero(x) for x in branch.p_rate):
            seat = seat + 2 * w_p.cross(branch.p_rate)
        acc = E @ seat
        if a:
            for k, (turning, sliding) in branch.columns.items():
                wd, acc = wd + a[k] * turning, acc + a[k] * sliding
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
            back = branch.E.T if branch.E is not Matrix.IDENTITY else Matrix.IDENTITY
            carried_moments = composite[i].turned(back).moved(branch.p)
            composite[branch.parent] = composite[branch.parent].plus(
                _polar(carried_moments, branch.E is Matrix.IDENTITY)
            )
    M: list[list[Scalar]] = [[0] * size for _ in range(size)]
    for i, branch in enumerate(branches):
        for k, column in branch.columns.items():
            _fill(M, k, branches, i, _unit_wrench(composite[i], column))
    return M


def _polar(moments: Moments, plane: bool) -> Moments:
    if not plane:
        return moments
    return Moments(
        moments.m, moments.h, Matrix.of(((moments.J[0][0] + moments.J[1][1], 0, 0), Vector.ZERO, Vector.ZERO))
    )


def _unit_wrench(body: Moments, column: MotionColumn) -> Wrench:
    """I S: the wrench that accelerates a body by the column (w, v): U = w~, acc = v."""
    w, v = column
    U = ((0, -w[2], w[1]), (w[2], 0, -w[0]), (-w[1], w[0], 0))
    return inertia_wrench(body, v, Matrix.of(U))


def _fill(M: list[list[Scalar]], k: int, branches: tuple[Branch, ...], i: int, wrench: Wrench) -> None:
    """Row and column k of M from the wrench at branch i, walked down to the ground."""
    own = True
    while True:
        for j, (w, v) in branches[i].columns.items():
            entry = w @ wrench.tau + v @ wrench.f
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
        found = _ground_wrench(loads, load) if _plane(motion) else motion.body_wrench(load)
        if found is None:
            continue
        body, wrench = found
        i = index[body]
        link = branches[i].link
        about_joint = wrench.moved(-(branches[i].axes @ origin_of(motion, link)))
        total[i] = total[i].plus(about_joint) if i in total else about_joint
    return total


def _plane(motion: Motion) -> bool:
    return motion.scope.model.space == "plane"


def _ground_wrench(loads: Loads, load: PointForce | Couple) -> tuple[str, Wrench] | None:
    """A load about its body's origin in ground axes."""
    motion = loads.motion
    if not isinstance(load, PointForce):
        return load.body, Wrench(motion.in_ground_axes(load.couple, load.axes), Vector.ZERO)
    body, r = load.place
    if body is None:
        return None
    f = motion.in_ground_axes(load.force, load.axes)
    return body, Wrench((motion.link(body).pose.R @ r).cross(f), f)
