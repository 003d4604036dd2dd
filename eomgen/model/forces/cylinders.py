"""Hydraulic and pneumatic cylinders between two points."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import MOTION, TIME, FormulaRule, ListRule
from eomgen.model.forces.base import Element, ForceTrial, OwnState
from eomgen.model.forces.bumper import Exponent
from eomgen.model.forces.elements import Reach, Straight
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import Length, NaturalLength
from eomgen.model.part import Part, PartRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Fraction, Scalar, Vector, as_expression, function, over, sqrt
from eomgen.symbolic.numeric import tolerances

Many = tuple[Expression, ...]
Areas = Annotated[Many, ListRule(FormulaRule("m^2", "positive"), 1, 2, single=True)]
Volumes = Annotated[Many, ListRule(FormulaRule("m^3", "nonnegative"), 1, 2, single=True)]
Pressures = Annotated[Many, ListRule(FormulaRule("Pa"), 1, 2, single=True)]
Flows = Annotated[Many, ListRule(FormulaRule("m^3/s", "", MOTION), 1, 2, single=True)]
MassFlows = Annotated[Many, ListRule(FormulaRule("kg/s", "", MOTION), 1, 2, single=True)]
Modulus = Annotated[Expression, FormulaRule("Pa", "positive")]
Pressure = Annotated[Expression, FormulaRule("Pa", "nonnegative")]
GivenPressure = Annotated[Expression, FormulaRule("Pa", "", MOTION)]
Leakage = Annotated[Expression, FormulaRule("m^4*s/kg", "nonnegative")]
GasConstant = Annotated[Expression, FormulaRule("J/(kg*K)", "positive")]
Temperature = Annotated[Expression, FormulaRule("K", "positive", TIME)]
SpoolOpening = Annotated[Expression, FormulaRule("1", "", MOTION)]
RatedFlow = Annotated[Expression, FormulaRule("m^3/s", "positive")]
Conductance = Annotated[Expression, FormulaRule("m^4*s/kg", "positive")]
CriticalRatio = Annotated[Expression, FormulaRule("1", "nonnegative")]

AIR = Fraction(1185, 1000), Fraction(29315, 100)
"""density and temperature of the reference atmosphere of ISO 6358 [kg/m^3, K]"""


@dataclass(frozen=True, kw_only=True)
class Valve(Part):
    """A spool valve: Q = flow y sqrt(dp/drop) at each edge, from the supply into the first chamber where y > 0.

    Where y > 0 the second chamber empties into the tank, where y < 0 the first, and the second is filled.

    Args:
        opening: y, a share of the stroke of the spool, between -1 and 1.
        flow: through one edge of the valve that is wide open, at the pressure `drop` [m^3/s].
        drop: the difference of pressure at which that is rated [Pa].
        supply: pressure of the supply [Pa].
        tank: pressure of the tank (None: 0) [Pa].
        smooth: p, where the flow is dp/(dp^2 + p^2)^(1/4) in place of the root, which is steep at dp = 0 [Pa].
    """

    title: ClassVar[str] = "valve"
    opening: SpoolOpening
    flow: RatedFlow
    drop: Modulus
    supply: GivenPressure
    tank: GivenPressure | None = None
    smooth: Modulus | None = None

    def flows(self, scene: LoadContext, pressures: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
        """Q into each chamber [m^3/s]."""
        y, supply, tank = map(scene.value, (self.opening, self.supply, self.tank))
        opened = function("max", 0, y), function("max", 0, -y)
        found = []
        for p, (filling, emptying) in zip(pressures, (opened, opened[::-1]), strict=False):
            found.append(filling * self._edge(scene, supply - p) - emptying * self._edge(scene, p - tank))
        return tuple(found)

    def let_through(self, here: ForceTrial, pressures: list[Any]) -> list[Any]:
        """The same in numbers: each chamber is open to the supply or to the tank."""
        given = (self.opening, self.flow, self.drop, self.supply, self.tank, self.smooth)
        y, flow, drop, supply, tank, smooth = map(here.value, given)
        found = []
        for p, sense in zip(pressures, (1, -1), strict=False):
            ahead = sense * y > 0
            dp = supply - p if ahead else p - tank
            size = here.function("sqrt", here.function("sqrt", dp * dp + smooth * smooth))
            shared = dp / size if dp else dp
            found.append((1 if ahead else -1) * abs(y) * flow / here.function("sqrt", drop) * shared)
        return found

    def _edge(self, scene: LoadContext, dp: Scalar) -> Scalar:
        """Q over y of one edge, in the sense of the difference of pressure."""
        rated = over(scene.value(self.flow), sqrt(scene.value(self.drop)))
        if self.smooth is None:
            return rated * function("sign", dp) * sqrt(function("abs", dp))
        p = scene.value(self.smooth)
        return over(rated * dp, sqrt(sqrt(dp * dp + p * p)))


@dataclass(frozen=True, kw_only=True)
class GasValve(Part):
    """A valve for gas, by ISO 6358: m' = y C rho_0 sqrt(T_0/T) p_u w(p_d/p_u) at each edge, where y > 0 into chamber 1.

    Of the absolute pressures at an edge p_u is the higher and p_d the lower. w(r) = 1 up to the critical ratio b, where
    the flow is choked, then sqrt(1 - ((r - b)/(1 - b))^2), which is smooth at b. rho_0 = 1.185 kg/m^3 and
    T_0 = 293.15 K are those of the standard. Where y > 0 the second chamber empties into the exhaust, where y < 0 the
    first, and the second is filled.

    Args:
        opening: y, a share of the stroke of the spool, between -1 and 1.
        conductance: C, sonic, of an edge that is wide open [m^3/(s Pa)].
        critical: b, below 1: 0.528 of a nozzle for air, less of a valve.
        supply: pressure of the supply, absolute [Pa].
        exhaust: pressure behind the exhaust, absolute [Pa].
        smooth: p, where the root of the difference dp of pressure is dp/(dp^2 + p^2)^(1/4): it is steep at 0 [Pa].
    """

    title: ClassVar[str] = "gas valve"
    opening: SpoolOpening
    conductance: Conductance
    critical: CriticalRatio
    supply: GivenPressure
    exhaust: GivenPressure
    smooth: Modulus | None = None

    def flows(self, scene: LoadContext, pressures: tuple[Scalar, ...], T: Scalar) -> tuple[Scalar, ...]:
        """m' into each chamber [kg/s]."""
        y, supply, exhaust = map(scene.value, (self.opening, self.supply, self.exhaust))
        opened = function("max", 0, y), function("max", 0, -y)
        rated = AIR[0] * scene.value(self.conductance) * sqrt(over(AIR[1], T))
        found = []
        for p, (filling, emptying) in zip(pressures, (opened, opened[::-1]), strict=False):
            found.append(rated * (filling * self._edge(scene, supply, p) - emptying * self._edge(scene, p, exhaust)))
        return tuple(found)

    def _edge(self, scene: LoadContext, p_1: Scalar, p_2: Scalar) -> Scalar:
        """p_u w, from the first pressure to the second: by q = p_1 - p_2, held where the flow is choked."""
        b, high = scene.value(self.critical), function("max", p_1, p_2)
        choked = (1 - b) * high
        q = function("max", -choked, function("min", p_1 - p_2, choked))
        size = function("abs", q)
        if self.smooth is None:
            root = function("sign", q) * sqrt(size)
        else:
            p = scene.value(self.smooth)
            root = over(q, sqrt(sqrt(q * q + p * p)))
        return over(root * sqrt(2 * choked - size), 1 - b)

    def let_through(self, here: ForceTrial, pressures: list[Any], T: Any) -> list[Any]:
        """The same in numbers, by the ellipse of the standard: each chamber is open to the supply or to the exhaust."""
        given = (self.opening, self.conductance, self.critical, self.supply, self.exhaust, self.smooth)
        y, C, b, supply, exhaust, smooth = map(here.value, given)
        found = []
        for p, sense in zip(pressures, (1, -1), strict=False):
            ahead = sense * y > 0
            start, end = (supply, p) if ahead else (p, exhaust)
            high, low = max(start, end), min(start, end)
            r = max(low / high, b)
            w, q = here.function("sqrt", 1 - ((r - b) / (1 - b)) ** 2), high * (1 - r)
            steep = here.function("sqrt", q / here.function("sqrt", q * q + smooth * smooth)) if q else q
            m = abs(y) * C * AIR[0] * here.function("sqrt", AIR[1] / T) * high * w * steep
            found.append(m if ahead == (start > end) else -m)
        return found


@dataclass(frozen=True, kw_only=True)
class PressedCylinder(Straight):
    """Base of both kinds of cylinder: chambers that push two points apart.

    Args:
        points: its two ends: the bottom of the barrel, the end of the rod.
        areas: of the piston, A_1 and, where the rod's side is a chamber too, A_2 [m^2].
        volumes: of each chamber where its piston is at its end, pipes included [m^3].
        retracted: the distance of the points where the piston is at the bottom, x = 0 [m].
        stroke: h of the piston, of a cylinder with two chambers [m].
    """

    areas: Areas
    volumes: Volumes
    retracted: Length
    stroke: Length | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, pressed=self)

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of lists of other lengths, and of a stroke that is missing or that nothing needs."""
        n = len(self.areas or ())
        for key in ("volumes", "pressures", "flows"):
            given = getattr(self, key)
            if given is not None and n and len(given) != n:
                what = f"'{path[1]}' has {_counted(n)} and {len(given)} {key}"
                yield Diagnostic((*path, key), what, f"give one for each area: {n}", key=True)
        if n == 2 and self.stroke is None and (*path, "stroke") not in catalog.broken:
            yield Diagnostic(path, f"'{path[1]}' has two chambers and no stroke", "give 'stroke'")
        if n == 1 and self.stroke is not None:
            what = f"'{path[1]}' has one chamber, whose volume needs no stroke"
            yield Diagnostic((*path, "stroke"), what, "leave it out, or give two areas", key=True)

    def misplaced(self, scene: LoadContext) -> tuple[str, str]:
        """A piston that starts beyond an end of its stroke."""
        x, h = (
            None if length is None else scene.value_at_start(length)
            for length in (
                self.line(scene).length - scene.value(self.retracted),
                None if self.stroke is None else scene.value(self.stroke),
            )
        )
        if x is None:
            return "", ""
        beyond = max(-x, x - h if h is not None else -x)
        if beyond <= tolerances.COMPUTED * (1 if h is None else h):
            return "", ""
        ends = "below 0" if x < 0 else f"above the stroke of {h:.6g} m"
        what = f"the piston of '{scene.where.partition('.')[2]}' starts at x = {x:.6g} m, {ends}"
        return what, "give 'retracted' or 'stroke' another value, or start elsewhere"

    def law(self, scene: LoadContext, line: Reach) -> Scalar:
        """- (A_1 p_1 - A_2 p_2), pressures against that outside."""
        pressures = self.pressed(scene, line)
        return sum((-s * scene.value(A) * p for s, A, p in zip((1, -1), self.areas, pressures, strict=False)), start=0)

    def pressed(self, scene: LoadContext, line: Reach) -> tuple[Scalar, ...]:
        """The pressures by which the chambers push [Pa]."""
        return self.own_pressures(scene)

    def own_pressures(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """The states p_1, p_2 [Pa]."""
        return tuple(scene.value(as_expression(f"{self.name}_{own.name}")) for own in self.own_states)

    def own_volumes(self, scene: LoadContext, length: Scalar) -> tuple[Scalar, ...]:
        """V_1 + A_1 x, V_2 + A_2 (h - x) [m^3]."""
        x = length - scene.value(self.retracted)
        ways = (x,) if self.stroke is None else (x, scene.value(self.stroke) - x)
        return tuple(
            scene.value(V) + scene.value(A) * s for V, A, s in zip(self.volumes, self.areas, ways, strict=True)
        )

    def volume_rates(self, scene: LoadContext, line: Reach) -> tuple[Scalar, ...]:
        """A_1 x', -A_2 x' [m^3/s]."""
        return tuple(s * scene.value(A) * line.rate for s, A in zip((1, -1), self.areas, strict=False))

    # -- in numbers ------------------------------------------------------------------------------------------

    def push(self, here: ForceTrial, length: Any) -> Any:
        """A_1 p_1 on the side of the bottom less A_2 p_2 on that of the rod, pressures against that outside [N]."""
        forces = [here.value(A) * p for A, p in zip(self.areas, self.felt(here, length), strict=True)]
        return forces[0] - sum(forces[1:], start=0)

    def felt(self, here: ForceTrial, length: Any) -> list[Any]:
        """The pressures in the chambers less that outside [Pa]."""
        return self.held(here)

    def held(self, here: ForceTrial) -> list[Any]:
        """The pressures that are states [Pa]."""
        return [here.value(as_expression(f"{self.name}_{own.name}")) for own in self.own_states]

    def filled(self, here: ForceTrial, length: Any) -> list[Any]:
        """The volume of each chamber [m^3]."""
        out = length - here.value(self.retracted)
        ways = (out, here.value(self.stroke) - out)
        return [here.value(V) + here.value(A) * way for V, A, way in zip(self.volumes, self.areas, ways, strict=False)]

    def grows(self, here: ForceTrial, rate: Any) -> list[Any]:
        """The rate of each volume by the piston [m^3/s]."""
        return [side * here.value(A) * rate for side, A in zip((1, -1), self.areas, strict=False)]

    # -- states ----------------------------------------------------------------------------------------------

    def pressure_states(self, starts: Many | None, what: str) -> tuple[OwnState, ...]:
        """p_1 and p_2."""
        begun = (None, None) if starts is None else (*starts, None)
        return tuple(
            OwnState(f"p_{k}", "Pa", f"{what} in chamber {k}", start)
            for k, (_, start) in enumerate(zip(self.areas or (), begun, strict=False), start=1)
        )


def _power(x: Any, n: Any) -> Scalar:
    found: Scalar = x**n
    return found


def _counted(n: int) -> str:
    return f"{n} area" if n == 1 else f"{n} areas"


@dataclass(frozen=True, kw_only=True)
class HydraulicCylinder(PressedCylinder):
    """A hydraulic cylinder between two points, which pushes them apart by A_1 p_1 - A_2 p_2.

    Its pressures, against that outside, are states of the model, NAME_p_1 and NAME_p_2 of the cylinder NAME. With the
    extension x, the distance less `retracted`, and the flows into the chambers, those of the valve included,
    p_1' = E/(V_1 + A_1 x) (Q_1 - A_1 x' - k (p_1 - p_2)) and
    p_2' = E/(V_2 + A_2 (h - x)) (Q_2 + A_2 x' + k (p_1 - p_2)); of one chamber k p_1 leaks out.

    Args:
        bulk: E, the bulk modulus of the fluid [Pa].
        flows: Q_1 and Q_2 into the chambers (None: none but those of the valve) [m^3/s].
        valve: a valve to a supply and a tank.
        leakage: k from one chamber to the other [m^4 s/kg, which is m^3/s per Pa].
        pressures: p_1 and p_2 at the start (None: 0) [Pa].
    """

    kind: ClassVar[str] = "hydraulic_cylinder"
    bulk: Modulus
    flows: Flows | None = None
    valve: Annotated[Valve, PartRule(Valve)] | None = None
    leakage: Leakage | None = None
    pressures: Pressures | None = None

    @property
    def own_states(self) -> tuple[OwnState, ...]:
        return self.pressure_states(self.pressures, "pressure")

    def state_rates(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """E/V (Q - V')"""
        line, pressures = self.line(scene), self.own_pressures(scene)
        lost = scene.value(self.leakage) * (pressures[0] - (pressures[1] if len(pressures) > 1 else 0))
        coming: tuple[Scalar, ...] = tuple(-s * lost for s, _ in zip((1, -1), pressures, strict=False))
        given = (0, 0) if self.flows is None else tuple(map(scene.value, self.flows))
        through = (0, 0) if self.valve is None else self.valve.flows(scene, pressures)
        V, V_rates = self.own_volumes(scene, line.length), self.volume_rates(scene, line)
        E = scene.value(self.bulk)
        rows = zip(V, V_rates, given, through, coming, strict=False)
        return tuple(over(E * (q + y + k - rate), v) for v, rate, q, y, k in rows)

    def rates(self, here: ForceTrial) -> tuple[Any, ...]:
        """E/V of what comes, through valve and leaks too, less the volume that the piston makes."""
        length, way = self.element.measured(here)
        pressures = self.held(here)
        leaks = here.value(self.leakage) * (pressures[0] - sum(pressures[1:], start=0))
        comes = [0 * leaks for _ in pressures] if self.flows is None else [here.value(Q) for Q in self.flows]
        if self.valve is not None:
            comes = [a + b for a, b in zip(comes, self.valve.let_through(here, pressures), strict=True)]
        lost = zip(comes, (leaks, -leaks), strict=False)
        rows = zip(self.filled(here, length), lost, self.grows(here, way), strict=True)
        return tuple(here.value(self.bulk) / V * (come - leak - more) for V, (come, leak), more in rows)


@dataclass(frozen=True, kw_only=True)
class PneumaticCylinder(PressedCylinder):
    """A cylinder with gas, which pushes two points apart by A_1 (p_1 - p_0) - A_2 (p_2 - p_0), p_0 outside.

    Closed chambers follow p V^n = constant: a gas spring, with an energy. With mass flows m' or a valve the absolute
    pressures are states of the model, NAME_p_1 and NAME_p_2 of the cylinder NAME:
    p_1' = n/(V_1 + A_1 x) (R T m_1' - p_1 A_1 x') and p_2' = n/(V_2 + A_2 (h - x)) (R T m_2' + p_2 A_2 x'), x the
    distance less `retracted`.

    Args:
        pressures: p_1 and p_2, absolute, at the start; of closed chambers where the cylinder has its `length` [Pa].
        exponent: n: 1 where the temperature stays, 1.4 of air without exchange of heat.
        outside: p_0, absolute (None: 0) [Pa].
        length: at which closed chambers have their `pressures` [m], or "start": the distance at the start (None).
        flows: m_1' and m_2' into the chambers (None: none but those of the valve) [kg/s].
        valve: a valve to a supply and an exhaust.
        gas: R of the gas that flows [J/(kg K)].
        temperature: T of it [K].
    """

    kind: ClassVar[str] = "pneumatic_cylinder"
    pressures: Pressures
    exponent: Exponent
    outside: Pressure | None = None
    length: NaturalLength | None = None
    flows: MassFlows | None = None
    valve: Annotated[GasValve, PartRule(GasValve)] | None = None
    gas: GasConstant | None = None
    temperature: Temperature | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of the same, of gas that flows without its constants, and of constants that nothing needs."""
        yield from PressedCylinder.diagnostics(self, path, catalog)
        for key in ("gas", "temperature"):
            if not self.is_closed and getattr(self, key) is None and (*path, key) not in catalog.broken:
                yield Diagnostic(path, f"gas flows in '{path[1]}', and its '{key}' is not given", f"give '{key}'")
            elif self.is_closed and getattr(self, key) is not None:
                what = f"'{path[1]}' is closed: no gas flows whose '{key}' matters"
                yield Diagnostic((*path, key), what, "leave it out, or give 'flows'", key=True)
        b = None if self.valve is None else self.valve.critical.literal
        if b is not None and b >= 1:
            what = f"the valve of '{path[1]}' has the critical ratio {b}"
            yield Diagnostic((*path, "valve", "critical"), what, "it is below 1: 0.528 of a nozzle for air")
        if not self.is_closed and self.length is not None:
            what = f"the pressures of '{path[1]}' are those at the start, where gas flows"
            yield Diagnostic((*path, "length"), what, "leave it out", key=True)

    @property
    def is_closed(self) -> bool:
        """True if no gas flows in and out."""
        return self.flows is None and self.valve is None

    @property
    def own_states(self) -> tuple[OwnState, ...]:
        return () if self.is_closed else self.pressure_states(self.pressures, "absolute pressure")

    @property
    def slack_at_start(self) -> bool:
        return False  # it has its pressures there

    @property
    def of_the_start(self) -> bool:
        return self.is_closed and self.length in (None, "start")

    def pressed(self, scene: LoadContext, line: Reach) -> tuple[Scalar, ...]:
        """p - p_0; of closed chambers p = p_1 (V_0/V)^n."""
        found = self.own_pressures(scene)
        if self.is_closed:
            n = scene.value(self.exponent)
            given = zip(self.pressures, self._shrunk(scene, line.length), strict=True)
            found = tuple(scene.value(p) * _power(ratio, n) for p, (_, ratio) in given)
        return tuple(p - scene.value(self.outside) for p in found)

    def state_rates(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """n/V (R T m' - p V')"""
        if self.is_closed:
            return ()
        line, n, p = self.line(scene), scene.value(self.exponent), self.own_pressures(scene)
        T = scene.value(self.temperature)
        warm = scene.value(self.gas) * T
        coming: tuple[Scalar, ...] = (0,) * len(p) if self.flows is None else tuple(map(scene.value, self.flows))
        if self.valve is not None:
            coming = tuple(a + b for a, b in zip(coming, self.valve.flows(scene, p, T), strict=True))
        V, V_rates = self.own_volumes(scene, line.length), self.volume_rates(scene, line)
        rows = zip(V, V_rates, p, coming, strict=True)
        return tuple(over(n * (warm * m - p * rate), v) for v, rate, p, m in rows)

    def rates(self, here: ForceTrial) -> tuple[Any, ...]:
        """n (R T m' - p V')/V"""
        length, way = self.element.measured(here)
        n, R, T = map(here.value, (self.exponent, self.gas, self.temperature))
        pressures = self.held(here)
        comes = [0 * T for _ in pressures] if self.flows is None else [here.value(m) for m in self.flows]
        if self.valve is not None:
            comes = [a + b for a, b in zip(comes, self.valve.let_through(here, pressures, T), strict=True)]
        rows = zip(self.filled(here, length), self.grows(here, way), pressures, comes, strict=True)
        return tuple(n * (R * T * m - p * more) / V for V, more, p, m in rows)

    def felt(self, here: ForceTrial, length: Any) -> list[Any]:
        outside, found = here.value(self.outside), self.held(here)
        if self.is_closed:
            begun, n = here.value(None if self.length == "start" else self.length), here.value(self.exponent)
            if self.of_the_start:
                first, second = (here.place(point)[1] for point in self.points)
                apart = Vector(here.at_start(second - first))
                begun = here.function("sqrt", apart @ apart)
            ratios = zip(self.filled(here, begun), self.filled(here, length), strict=True)
            found = [here.value(p) * (V_0 / V) ** n for p, (V_0, V) in zip(self.pressures, ratios, strict=True)]
        return [p - outside for p in found]

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = sum of p_1 V_0 ((V_0/V)^(n - 1) - 1)/(n - 1) of closed chambers, and p_0 (A_1 - A_2) x."""
        if not self.is_closed:
            return None
        n = scene.value(self.exponent)
        isothermal = scene.value_at_start(n) == 1
        length = self.line(scene).length
        areas = (*map(scene.value, self.areas), 0)
        total = scene.value(self.outside) * (areas[0] - areas[1]) * (length - scene.value(self.retracted))
        for p, (V_0, ratio) in zip(self.pressures, self._shrunk(scene, length), strict=True):
            work = function("log", ratio) if isothermal else over(_power(ratio, n - 1) - 1, n - 1)
            total = total + scene.value(p) * V_0 * work
        return total

    def _shrunk(self, scene: LoadContext, length: Scalar) -> tuple[tuple[Scalar, Scalar], ...]:
        """(V_0, V_0/V) of each closed chamber."""
        given = scene.start(length) if self.length in (None, "start") else scene.value(self.length)
        pairs = zip(self.own_volumes(scene, given), self.own_volumes(scene, length), strict=True)
        return tuple((V_0, over(V_0, V)) for V_0, V in pairs)
