"""Forces of a fluid on a body in it: drag, lift of a plate, buoyancy, and the mass that moves along."""

from collections.abc import Iterator
from itertools import product
from typing import Annotated, Any, ClassVar

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, owner_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import MOTION, TIME, FormulaRule, Leaf, VectorRule
from eomgen.model.forces.base import AXES, Act, Force, ForceTrial, of_a_body
from eomgen.model.forces.load import Fluid, Load, LoadContext, PointForce
from eomgen.model.kinds import Direction, PointName, SpaceDirection, VectorFormula
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Fraction, Scalar, Twist, Vector, Wrench, function, over, sqrt

Density = Annotated[Expression, FormulaRule("kg/m^3", "nonnegative")]
WettedArea = Annotated[Expression, FormulaRule("m^2", "nonnegative")]
DragCoefficient = Annotated[Expression, FormulaRule("1", "", MOTION)]
OfAngle = Annotated[Expression, FormulaRule("1", "", MOTION, also=("alpha",), also_in="rad")]
Stream = Annotated[VectorFormula, VectorRule(FormulaRule("m/s", "", MOTION))]
StreamInTime = Annotated[VectorFormula, VectorRule(FormulaRule("m/s", "", TIME))]
FieldInFluid = Annotated[VectorFormula, VectorRule(FormulaRule("m/s^2", "", TIME))]
SlowSpeed = Annotated[Expression, FormulaRule("m/s", "positive")]
Displaced = Annotated[Expression, FormulaRule("m^3", "nonnegative")]

HALF = Fraction(1, 2)


@dataclass(frozen=True, kw_only=True)
class InFluid(Force):
    """Base of forces of a fluid at a point of a body.

    Args:
        point: of the body, where the force acts.
        density: rho of the fluid [kg/m^3].
        medium: velocity of the fluid there, ground axes, 2 or 3 (None: at rest) [m/s].
    """

    point: PointName
    density: Density
    medium: Stream | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a point of the ground."""
        yield from of_a_body(path, self.point)

    @property
    def pushed_points(self) -> tuple[str, ...]:
        return (self.point,)

    def against(self, scene: LoadContext) -> Vector:
        """w, the velocity of the point against the fluid, ground axes [m/s]."""
        return scene.velocity(scene.place(self.point)) - scene.vector(self.medium)

    def against_in_numbers(self, here: ForceTrial) -> Vector:
        """The same in numbers, by the twist."""
        v = here.velocity_of(self.point)
        return v if self.medium is None else v - here.directed(self.medium)


# -------- drag ------------------------------------------------------------------------------------------------
# Drag: against the velocity in the fluid, with its square.


@dataclass(frozen=True, kw_only=True)
class Drag(InFluid):
    """The drag of a body in a fluid: - rho/2 c A |w| w at a point of it, w its velocity against the fluid.

    Its size is smooth where w is 0 along one direction; in several it has a derivative there with `smooth` alone, by
    which |w| is sqrt(w.w + v^2).

    Args:
        coefficient: c.
        area: A [m^2].
        smooth: v, the speed below which the drag is nearly linear [m/s].
    """

    kind: ClassVar[str] = "drag"
    coefficient: DragCoefficient
    area: WettedArea
    smooth: SlowSpeed | None = None

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """- rho/2 c A |w| w"""
        w, v = self.against(scene), scene.value(self.smooth)
        size = sqrt(w @ w + v * v)
        strength = HALF * scene.value(self.density) * scene.value(self.coefficient) * scene.value(self.area)
        return (PointForce(scene.place(self.point), -strength * size * w),)

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        w, v = self.against_in_numbers(here), here.value(self.smooth)
        rho, c, A = map(here.value, (self.density, self.coefficient, self.area))
        yield Act(*here.place(self.point), -rho * c * A * here.function("sqrt", w @ w + v * v) / 2 * w)


# -------- plate -----------------------------------------------------------------------------------------------
# Plate: lift and drag by the angle of attack.


@dataclass(frozen=True, kw_only=True)
class Plate(InFluid):
    """A plate or wing in a stream: lift rho/2 A u^2 c_L across its way in the fluid, drag rho/2 A u^2 c_D against it.

    u is the velocity against the fluid in the plane of chord and normal; both coefficients are functions of the angle
    of attack `alpha`, of the chord against that velocity, positive where the lift of a wing acts towards the normal:
    where it sinks while it goes ahead. At rest in the fluid `alpha` has no value, and the force is not defined.

    Args:
        area: A [m^2].
        lift: c_L, of `alpha` [rad]; a function of a table may stand in it.
        drag: c_D, of `alpha` (None: 0).
        chord: the direction ahead in the axes of the body, 2 or 3 (None: its x axis).
        normal: in space, the direction of the lift at alpha = 0 in the axes of the body (None: its z axis).
    """

    kind: ClassVar[str] = "plate"
    area: WettedArea
    lift: OfAngle
    drag: OfAngle | None = None
    chord: Direction | None = None
    normal: SpaceDirection | None = None

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """rho/2 A u (c_L (-u_n e + u_e n) - c_D (u_e e + u_n n)), e the chord and n the normal.

        Raises:
            DerivationError: chord and normal are not at right angles.
        """
        place, R = scene.place(self.point), scene.orientation(owner_of(self.point))
        e, n = self._axes(scene)
        if not scene.vanishes(e @ n):
            raise DerivationError("the chord and the normal are not at right angles", scene.where, "give others")
        e, n = R @ e, R @ n
        w = self.against(scene)
        ahead, up = w @ e, w @ n
        u = sqrt(ahead * ahead + up * up)
        alpha = {"alpha": function("atan2", -up, ahead)}
        c_L = scene.value_at(self.lift, alpha)
        c_D = 0 if self.drag is None else scene.value_at(self.drag, alpha)
        strength = HALF * scene.value(self.density) * scene.value(self.area) * u
        lift, drag = -up * e + ahead * n, ahead * e + up * n
        return (PointForce(place, strength * (c_L * lift - c_D * drag)),)

    def _axes(self, scene: LoadContext) -> tuple[Vector, Vector]:
        """Unit vectors of chord and normal, body axes."""
        chord = Vector((1, 0, 0)) if self.chord is None else scene.vector(self.chord)
        if scene.plane:
            normal = Vector((-chord[1], chord[0], 0))
        else:
            normal = Vector((0, 0, 1)) if self.normal is None else scene.vector(self.normal)
        e, n = (Vector(over(x, sqrt(v @ v)) for x in v) for v in (chord, normal))
        return e, n

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """The lift is drag turned by a right angle about the span."""
        body, w = owner_of(self.point), self.against_in_numbers(here)
        ground = [here.directed(axis, body) for axis in AXES]
        e = here.direction(ground[0] if self.chord is None else here.directed(self.chord, body))
        n = ground[2].cross(e)
        if not here.plane:
            n = here.direction(ground[2] if self.normal is None else here.directed(self.normal, body))
        span = e.cross(n)
        own = w - (w @ span) * span
        speed = here.function("sqrt", own @ own)
        alpha = {"alpha": here.function("atan2", -(own @ n), own @ e)}
        c_L, c_D = (0 if c is None else here.value(c, alpha) for c in (self.lift, self.drag))
        pressure = here.value(self.density) * here.value(self.area) * speed / 2
        yield Act(*here.place(self.point), pressure * (c_L * span.cross(own) - c_D * own))


# -------- buoyancy --------------------------------------------------------------------------------------------
# Buoyancy: the weight of the fluid in the place of the body.


@dataclass(frozen=True, kw_only=True)
class Buoyancy(Force):
    """The buoyancy of a body in a fluid: rho V (U' - g) at the centre of what it displaces, whole at any depth.

    With a medium whose velocity U changes it holds the pressure that drives the fluid along; its added mass is an
    `added_mass` of its own, with the same medium.

    Args:
        point: the centre of the displaced volume.
        density: rho of the fluid [kg/m^3].
        volume: V [m^3].
        acceleration: g as of a `gravity`, ground axes, 2 or 3 [m/s^2].
        medium: U of the fluid, of time, ground axes, 2 or 3 (None: at rest) [m/s].
    """

    kind: ClassVar[str] = "buoyancy"
    point: PointName
    density: Density
    volume: Displaced
    acceleration: FieldInFluid
    medium: StreamInTime | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a point of the ground."""
        yield from of_a_body(path, self.point)

    @property
    def pushed_points(self) -> tuple[str, ...]:
        return (self.point,)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """rho V (U' - g)"""
        return (PointForce(scene.place(self.point), self._weight(scene) * self._felt(scene)),)

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = - rho V (U' - g) . r"""
        return -self._weight(scene) * (self._felt(scene) @ scene.position(scene.place(self.point)))

    def _weight(self, scene: LoadContext) -> Scalar:
        return scene.value(self.density) * scene.value(self.volume)

    def _felt(self, scene: LoadContext) -> Vector:
        g = scene.vector(self.acceleration)
        rates = Vector(map(scene.rate, scene.vector(self.medium)))
        return rates - g

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        g = here.directed(self.acceleration)
        push = -g if self.medium is None else here.rate_of(self.medium) - g
        yield Act(*here.place(self.point), here.value(self.density) * here.value(self.volume) * push)


# -------- added mass ------------------------------------------------------------------------------------------
# Added mass: the kinetic energy of the fluid round a body, by Kirchhoff.


UNITS = ("kg", "kg*m", "kg*m^2")
"""of entries by how many of their row and column turn"""


@dataclass(frozen=True)
class AddedMassRule:
    """The rows of a square of 3 or 6, or its diagonal, each entry with its own unit."""

    diagonal: bool = False

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        rows = raw if isinstance(raw, (list, tuple)) else ()
        size = len(rows)
        square = self.diagonal or all(isinstance(row, (list, tuple)) and len(row) == size for row in rows)
        if size not in (3, 6) or not square:
            what = f"a list of 3 or 6 {'entries' if self.diagonal else 'rows, as long each,'} is needed here"
            found.append(Diagnostic(path, what, "3 in the plane, 6 in space: velocity first, then turns"))
            return None
        if self.diagonal:
            return tuple(self._entry(i, i, size).read(x, (*path, i), found) for i, x in enumerate(rows))
        return tuple(
            tuple(self._entry(i, j, size).read(x, (*path, i, j), found) for j, x in enumerate(row))
            for i, row in enumerate(rows)
        )

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        size = len(value)
        for i, row in enumerate(value):
            for j, x in enumerate((row,) if self.diagonal else row):
                k = i if self.diagonal else j
                yield from self._entry(i, k, size).leaves(x, (*path, i) if self.diagonal else (*path, i, j), part)

    def _entry(self, row: int, column: int, size: int) -> FormulaRule:
        """The rule of an entry: the last row, or the last three, are of turns."""
        ways = 2 if size == 3 else 3
        unit = UNITS[(row >= ways) + (column >= ways)]
        return FormulaRule(unit, "nonnegative" if row == column else "")

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        entries = {"type": "array", "items": FormulaRule().schema(definitions), "minItems": 3, "maxItems": 6}
        return entries if self.diagonal else {"type": "array", "items": entries, "minItems": 3, "maxItems": 6}


@dataclass(frozen=True, kw_only=True)
class AddedMass(Force):
    """The mass of the fluid that moves with a body: T = xi.A xi/2, xi its velocity and spin in the fluid, its own axes.

    The velocity is that of the point, less that of the fluid; A has the rows x, y, turn in the plane, and x, y, z and
    the turns about them in space. With the momentum (p, L) = A xi the fluid pushes the point with - (p' + w x p) and
    the couple - (L' + w x L + v x p) (Kirchhoff); the last turns a long hull across its way (Munk).

    Args:
        point: of the body, to which A belongs.
        matrix: A, symmetric, 3 rows in the plane and 6 in space [kg, kg m, kg m^2].
        diagonal: its diagonal, where it has no other entries.
        medium: velocity of the fluid, of time, ground axes, 2 or 3 (None: at rest) [m/s].
    """

    kind: ClassVar[str] = "added_mass"
    one_of: ClassVar[tuple[str, ...]] = ("matrix", "diagonal")
    moving: ClassVar[bool] = True
    point: PointName
    matrix: Annotated[tuple[tuple[Expression, ...], ...], AddedMassRule()] | None = None
    diagonal: Annotated[tuple[Expression, ...], AddedMassRule(True)] | None = None
    medium: StreamInTime | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a point of the ground, of the other number of rows, of a matrix that is not symmetric."""
        yield from of_a_body(path, self.point)
        size = 3 if catalog.model.space == "plane" else 6
        for key in self.one_of:
            given = getattr(self, key)
            if given is not None and len(given) != size:
                what = f"'{key}' of '{path[1]}' has {len(given)} rows"
                yield Diagnostic((*path, key), what, f"in {catalog.model.space} it has {size}", key=True)
        rows = self.matrix or ()
        for i, j in product(range(len(rows)), repeat=2):
            if i < j and (rows[i][j].literal, rows[i][j].text) != (rows[j][i].literal, rows[j][i].text):
                what = f"the added mass of '{path[1]}' is not symmetric: {rows[i][j].text} and {rows[j][i].text}"
                yield Diagnostic((*path, "matrix", j, i), what, "the work of the fluid is the same both ways")
                return

    def kinetic_energy(self, scene: LoadContext) -> Scalar:
        """T = xi.A xi/2 by the rates of the place and the axes."""
        return self._form(self._through_fluid(scene), scene.value)

    def fluid(self, scene: LoadContext) -> Fluid:
        """(p, L) = A xi"""
        xi = self._through_fluid(scene)
        six: list[Scalar] = [0] * 6
        for i, j, value in self._entries(scene.value):
            six[i] = six[i] + value * xi[j]
        v, w, p, L = (Vector(x) for x in (xi[:3], xi[3:], six[:3], six[3:]))
        return scene.place(self.point), Twist(w, v), Wrench(L, p)

    def _through_fluid(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """xi, the velocity against the fluid and the spin in the axes of the body."""
        body, place = owner_of(self.point), scene.place(self.point)
        v = scene.orientation(body).T @ (scene.velocity(place) - scene.vector(self.medium))
        return (*v, *scene.spin(body))

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """The same by the twist, its momenta by T(xi + e) - T(xi) - T(e) along each axis e."""
        v, w = here.in_stream(self.point, self.medium)
        xi = (*v, *w)
        T = self._form(xi, here.scalar)
        momenta = []
        for k in range(6):
            e = tuple(int(i == k) for i in range(6))
            more = tuple(x + y for x, y in zip(xi, e, strict=True))
            momenta.append(self._form(more, here.scalar) - T - self._form(e, here.scalar))
        fluid = (v, Vector(momenta[:3]), Vector(momenta[3:]))
        yield Act(*here.place(self.point), Vector.ZERO, kinetic=T, fluid=fluid)

    def _form(self, xi: tuple[Scalar, ...], value: Any) -> Scalar:
        found: Scalar = HALF * sum((x * xi[i] * xi[j] for i, j, x in self._entries(value)), start=0)
        return found

    def _entries(self, value: Any) -> Iterator[tuple[int, int, Scalar]]:
        """(row, column, entry) of A, 6 x 6."""
        given: Any = self.diagonal or self.matrix
        at = (0, 1, 5) if len(given) == 3 else range(6)
        if self.diagonal is not None:
            yield from ((i, i, value(m)) for i, m in zip(at, self.diagonal, strict=True))
        else:
            for (k, i), (n, j) in product(enumerate(at), repeat=2):
                yield i, j, value(given[k][n])
