"""Masses, moments of inertia and angular momenta of bodies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import (
    AXES,
    OutputContext,
    OutputFunction,
    OutputSource,
    SecondOf,
    Trial,
    ValueOf,
    along,
    component,
    number_at,
)
from eomgen.model.shapes.base import InertiaMatrix
from eomgen.symbolic.expression import Call, Fraction, Matrix, Scalar, Vector, is_zero

# -------- bodies meant ----------------------------------------------------------------------------------------
# Bodies to which a function of masses applies, and whether enough is known of them.


def bodies_from(scene: OutputContext, call: Call, first: int) -> tuple[str, ...]:
    """The bodies from the argument `first` on; without any, all of them."""
    named = tuple(call.name_at(k) for k in range(first, len(call.args)))
    if len(set(named)) < len(named):
        raise DerivationError(f"'{call}' names a body twice", fix="name each once")
    if "ground" in named:
        raise DerivationError(f"'{call}': the ground has no mass", fix="name bodies")
    return named or scene.bodies


def refuse_unknown(scene: OutputContext, call: Call, bodies: Sequence[str], *, about_z: bool) -> None:
    """Refuses a function of which the bodies' masses or moments are not known.

    Args:
        about_z: the moments about z are enough.
    Raises:
        DerivationError: naming a body of which it is not known.
    """
    if unknown := scene.without_inertia(bodies):
        raise DerivationError(
            f"'{call}': body '{unknown[0]}' has a mass and no inertia",
            f"bodies.{unknown[0]}",
            "give 'inertia' (0 for a point), or a shape",
        )
    if not about_z and (unknown := scene.known_about_z(bodies)):
        what = f"'{call}': of body '{unknown[0]}' only the moment about z is known, its 'inertia'"
        raise DerivationError(what, f"bodies.{unknown[0]}", "give it a shape, or parts")


# -------- mass of ---------------------------------------------------------------------------------------------
# mass_of: of a body, or of one of its parts (of a hole: what it takes away).


def _mass(scene: OutputContext, call: Call) -> Scalar:
    body = call.name_at(0)
    if body == "ground":
        raise DerivationError(f"'{call}': the ground has no mass", fix="name a body")
    if len(call.args) == 1:
        whole: Scalar = scene.mass(body).m
        return whole
    parts = scene.parts(body)
    if parts is None:
        raise DerivationError(f"'{call}': body '{body}' is not made of parts", fix=f"write mass_of({body})")
    return scene.mass_of_part(body, number_at(call, 1, parts))


MASS_OF = OutputFunction(
    names=("mass_of",),
    kinds=("body", "number"),
    least=1,
    unit="kg",
    gives="of a body, or of one of its parts (of a hole: what it takes away)",
    value=_mass,
    source=OutputSource.MASSES,
)


# -------- moments of inertia ----------------------------------------------------------------------------------
# inertia_point, _axis, _plane, _product, _tensor, principal_moment: of bodies about a point, ground axes.
#
#     tensor    I_P = integral (r.r 1 - r r^T) dm        axis     n.I_P n,  n a unit vector along it
#     point     integral r.r dm = tr(I_P) / 2            plane    integral x^2 dm = tr(I_P) / 2 - I_xx
#     product   + integral x y dm = -I_xy
#
# The tensor's products carry a minus, those of the textbooks a plus; no function gives both. By the second way the
# same integrals are sums over particles; no parallel axes, and no tensor is turned.


HALF = Fraction(1, 2)


def _tensor(scene: OutputContext, call: Call, first: int, *, about_z: bool = False) -> InertiaMatrix:
    """I_P of the bodies from the argument `first` on, at the state."""
    bodies = bodies_from(scene, call, first)
    refuse_unknown(scene, call, bodies, about_z=about_z)
    return InertiaMatrix(scene.placed(*scene.tensor(scene.position(call.name_at(0)), bodies)))


def _axis_at(call: Call, k: int) -> int:
    return AXES[call.name_at(k)]


def _direction(scene: OutputContext, call: Call) -> Vector:
    """Direction along x, y or z, or from the point to another one."""
    name = call.name_at(1)
    if name in AXES:
        return Matrix.IDENTITY[AXES[name]]
    ((x, y, z),) = scene.placed(scene.position(name) - scene.position(call.name_at(0)))
    if all(is_zero(c) for c in (x, y, z)):
        raise DerivationError(
            f"'{call}': both points are in one place, so they are on no single axis",
            fix="name two points that are apart",
        )
    return Vector((x, y, z))


def _about_axis(scene: OutputContext, call: Call) -> Scalar:
    along = _direction(scene, call)
    return _tensor(scene, call, 2, about_z=is_zero(along[0]) and is_zero(along[1])).about_axis(along)


def _about_point(scene: OutputContext, call: Call) -> Scalar:
    """A body of the plane that is given by its moment about z counts as thin: its I_xx + I_yy is I_zz."""
    thin = scene.known_about_z(bodies_from(scene, call, 1))
    missing = HALF * sum(scene.mass(body).I[2][2] for body in thin)
    found: Scalar = _tensor(scene, call, 1, about_z=True).polar + missing
    return found


def _second_moment(scene: OutputContext, call: Call, i: int, j: int, first: int) -> Scalar:
    found: Scalar = _tensor(scene, call, first).second_moments[i][j]
    return found


def _entry(scene: OutputContext, call: Call) -> Scalar:
    i, j = _axis_at(call, 1), _axis_at(call, 2)
    found: Scalar = _tensor(scene, call, 3, about_z=i == j == 2)[i][j]
    return found


def _principal(scene: OutputContext, call: Call) -> Scalar:
    return scene.principal_moments(_tensor(scene, call, 2))[number_at(call, 1, 3) - 1]


# -- by particles -------------------------------------------------------------------------------------


def _from_point(trial: Trial, call: Call, first: int) -> Iterator[tuple[Any, Vector]]:
    """(mass, place from the point) of the particles of the bodies that are meant."""
    point = Vector(trial.along(trial.scene.position(call.name_at(0)))[0])
    for body in bodies_from(trial.scene, call, first):
        for m, r, _ in trial.particles(body, still=True):
            yield m, r - point


def _sum_of_axis(trial: Trial, call: Call) -> Any:
    """sum m |n x r|^2 / n.n"""
    n = Vector(trial.along(_direction(trial.scene, call))[0])
    squares = ((m, n.cross(r)) for m, r in _from_point(trial, call, 2))
    return sum(m * (d @ d) for m, d in squares) / (n @ n)


def _sum_of_products(trial: Trial, call: Call, i: int, j: int, first: int) -> Any:
    return sum(m * r[i] * r[j] for m, r in _from_point(trial, call, first))


def _sum_of_entry(trial: Trial, call: Call) -> Any:
    i, j = _axis_at(call, 1), _axis_at(call, 2)
    if i != j:
        return -_sum_of_products(trial, call, i, j, 3)
    return sum(_sum_of_products(trial, call, k, k, 3) for k in range(3) if k != i)


def _eigenvalue(trial: Trial, call: Call) -> Any:
    P = [[_sum_of_products(trial, call, i, j, 2) for j in range(3)] for i in range(3)]
    whole = P[0][0] + P[1][1] + P[2][2]
    tensor = [[(whole if i == j else 0) - P[i][j] for j in range(3)] for i in range(3)]
    return trial.eigenvalues(tensor)[number_at(call, 1, 3) - 1]


def _moment(name: str, kinds: tuple[str, ...], gives: str, value: ValueOf, second: SecondOf) -> OutputFunction:
    return OutputFunction(
        names=(name,),
        kinds=kinds,
        least=len(kinds),
        more="body",
        unit="kg*m^2",
        gives=gives,
        value=value,
        second=second,
        source=OutputSource.MASSES,
    )


INERTIA_POINT = _moment(
    "inertia_point",
    ("point",),
    "integral of r^2 dm, of the bodies named or of all, where they are",
    _about_point,
    lambda trial, call: sum(m * (r @ r) for m, r in _from_point(trial, call, 1)),
)
INERTIA_AXIS = _moment(
    "inertia_axis",
    ("point", "point or axis"),
    "about the axis through both points, or along x, y, z through the first",
    _about_axis,
    _sum_of_axis,
)
INERTIA_PLANE = _moment(
    "inertia_plane",
    ("point", "axis"),
    "about the plane across that axis: integral of x^2 dm",
    lambda scene, call: _second_moment(scene, call, _axis_at(call, 1), _axis_at(call, 1), 2),
    lambda trial, call: _sum_of_products(trial, call, _axis_at(call, 1), _axis_at(call, 1), 2),
)
INERTIA_PRODUCT = _moment(
    "inertia_product",
    ("point", "axis", "axis"),
    "the textbook's: + integral of x y dm",
    lambda scene, call: _second_moment(scene, call, _axis_at(call, 1), _axis_at(call, 2), 3),
    lambda trial, call: _sum_of_products(trial, call, _axis_at(call, 1), _axis_at(call, 2), 3),
)
INERTIA_TENSOR = _moment(
    "inertia_tensor",
    ("point", "axis", "axis"),
    "an entry of the tensor: x, y is - integral of x y dm",
    _entry,
    _sum_of_entry,
)
PRINCIPAL_MOMENT = _moment("principal_moment", ("point", "number"), "1, 2, 3, ascending", _principal, _eigenvalue)


# -------- angular momentum ------------------------------------------------------------------------------------
# angular_momentum_x, _y, _z: L_P = sum (R I_C R^T w + m d x v_C). By the second way sum m r x v over particles.


def _momentum(scene: OutputContext, call: Call) -> Scalar:
    bodies, axis = bodies_from(scene, call, 1), component(call)
    turning = [b for b in bodies if any(not is_zero(w) for w in scene.spin(b))]
    refuse_unknown(scene, call, turning, about_z=axis == 2)
    found: Scalar = scene.angular_momentum(scene.position(call.name_at(0)), bodies)[axis]
    return found


def _sum(trial: Trial, call: Call) -> Any:
    point = Vector(trial.along(trial.scene.position(call.name_at(0)))[0])
    bodies, axis = bodies_from(trial.scene, call, 1), component(call)
    return sum(m * (r - point).cross(v)[axis] for body in bodies for m, r, v in trial.particles(body, still=True))


ANGULAR_MOMENTUM = OutputFunction(
    names=along("angular_momentum_*"),
    kinds=("point",),
    least=1,
    more="body",
    unit="kg*m^2/s",
    gives="sum of r x m v and I w about the point, ground axes, of the velocities against the ground",
    value=_momentum,
    second=_sum,
    source=OutputSource.MASSES,
    moves=True,
)
