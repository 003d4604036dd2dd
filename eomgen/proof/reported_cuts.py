"""Forces where bodies are cut, as they leave -> checks: of bodies cut free, and of sections along a body."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System, exact_accelerations
from eomgen.mechanics.free_bodies import NamedReaction
from eomgen.mechanics.kinematics import SystemScene
from eomgen.mechanics.statics import SectionForces, StaticReactions
from eomgen.proof.check import Check, Tally, differing
from eomgen.proof.declared_loads import CarriedFluid, balanced_least, declared_pushes, fluids_carried
from eomgen.proof.states import SECOND_STEP, InNumbers, way_through, with_inputs
from eomgen.symbolic.expression import LONGEST, Node, Scalar, State, parse, symbols_of
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

HOW = "wrenches about the ground's origin from the numbers that leave; loads as declared, accelerations by differences"
INERTIA = "inertia"


@dataclass(frozen=True)
class ReportedForce:
    """A force, or a couple, as it leaves, ground axes.

    Args:
        body, name, kind: as reported.
        at: its place, 3 [m].
        force, couple: 3 each, one of them 0; None where it has no single value.
    """

    body: str
    name: str
    kind: str
    at: np.ndarray
    force: np.ndarray | None
    couple: np.ndarray | None

    @property
    def wrench(self) -> np.ndarray | None:
        """(moment about the ground's origin, force)."""
        if self.force is None or self.couple is None:
            return None
        return np.concatenate([self.couple + np.cross(self.at, self.force), self.force])


def cuts_reported(
    system: System,
    equations: EquationsOfMotion | None,
    numbers: Mapping[Node, float],
    pushes: Iterable[tuple[str, str, str, np.ndarray, np.ndarray | None, np.ndarray | None]],
) -> Iterator[Check]:
    """Checks of the forces on all bodies at a state.

    Args:
        equations: of motion; None where nothing moves.
        numbers: t, q, u, the parameters and the unknowns of loads.
        pushes: (body, name, kind, place, force, couple) of each force as it leaves.
    """
    known = with_inputs(system, {x: fifty_digits().number(float(v)) for x, v in numbers.items()})
    proof = _Cut(system, known, equations, tuple(ReportedForce(*push) for push in pushes))
    return iter((*proof.equilibrium(), *proof.opposites(), *proof.loads(), *proof.inertia()))


@dataclass(frozen=True)
class _Cut(InNumbers):
    """Reported forces at their state."""

    equations: EquationsOfMotion | None
    pushes: tuple[ReportedForce, ...]

    def _on(self, body: str, pushes: Iterable[ReportedForce] | None = None) -> list[ReportedForce]:
        return [push for push in (self.pushes if pushes is None else pushes) if push.body == body]

    @cached_property
    def size(self) -> float:
        """Size of the forces and of their moments."""
        wrenches = [abs(w).max() for push in self.pushes if (w := push.wrench) is not None]
        return max(wrenches, default=0.0) or 1.0

    def _apart(self, pushes: Iterable[ReportedForce], due: Any = 0.0) -> str:
        """Message if wrenches do not add up to one that is due; "" where they do, or one has no value."""
        wrenches = [push.wrench for push in pushes]
        known = [wrench for wrench in wrenches if wrench is not None]
        if len(known) < len(wrenches):
            return ""
        left = float(np.abs(np.sum(known, axis=0) - due).max()) if known else float(np.abs(due).max(initial=0.0))
        return "" if left <= tolerances.COMPUTED * self.size + tolerances.SOLVED else f"{left:.3g} is left over"

    def equilibrium(self) -> Iterator[Check]:
        tally = Tally("each body that is cut free is in equilibrium", HOW)
        for body in dict.fromkeys(push.body for push in self.pushes):
            tally.add(f"'{body}'", partial(self._apart, self._on(body)))
        return tally.checks()

    def opposites(self) -> Iterator[Check]:
        tally = Tally("action and reaction are opposite", HOW)
        joints = {link.name for link in self.motion.links if link.parent >= 0}
        names = {push.name: push for push in self.pushes}
        for name in names:
            owner = name.partition("(")[2].rstrip(")").partition(",")[0]
            mine = [push for push in self.pushes if push.name == name and push.kind != INERTIA]
            if owner in joints and {push.body for push in mine} > {owner}:
                tally.add(name, partial(self._apart, mine))
        return tally.checks()

    def loads(self) -> Iterator[Check]:
        tally = Tally("loads push as their fields declare", HOW)
        for name in self.system.scope.model.forces:
            mine = [push for push in self.pushes if name in push.name.split(" + ")]
            if any(" + " in push.name for push in mine) or self.system.scope.model.forces[name].placeless:
                continue
            tally.add(f"'{name}'", partial(self._load, name, mine))
        return tally.checks()

    def _load(self, name: str, mine: Sequence[ReportedForce]) -> str:
        due = declared_pushes(self.system, self.state, name)
        for body in dict.fromkeys((*due, *(push.body for push in mine))):
            moment, force = due.get(body, ((0, 0, 0), (0, 0, 0)))
            wrong = self._apart(self._on(body, mine), np.array([float(x) for x in (*moment, *force)]))
            if wrong:
                return f"on '{body}' {wrong}"
        return ""

    def inertia(self) -> Iterator[Check]:
        tally = Tally("inertia forces are those of the motion", HOW)
        if self.equations is not None:
            for link in self.motion.links:
                tally.add(f"'{link.name}'", partial(self._inertia, link.name))
            for name, fluid in fluids_carried(self.system).items():
                tally.add(f"the fluid of '{name}'", partial(self._of_fluid, name, fluid))
        return tally.checks()

    def _of_fluid(self, name: str, fluid: CarriedFluid) -> str:
        """-p' and -(L' + v x p) by differences of the momenta of a fluid."""
        rates = way_through(self.system, self._moving, SECOND_STEP).rates((*fluid.p, *fluid.L))
        at, v, p = (np.array([float(x) for x in self.vector(each)]) for each in (fluid.place, fluid.v, fluid.p))
        force, turning = np.array([float(x) for x in rates]).reshape(2, 3)
        due = np.concatenate([turning + np.cross(v, p) + np.cross(at, force), force])
        return self._apart([push for push in self.pushes if push.name == f"fluid({name})"], -due)

    def _inertia(self, body: str) -> str:
        """-m a_C and -dL/dt by differences of the mass centre's places and of L = R I w."""
        link, mass = self.motion.link(body), self.system.scope.mass_properties(body)
        own = (f"inertia({body})", f"inertia_couple({body})")
        mine = [push for push in self.pushes if push.name in own]
        place = link.pose.point(mass.com)
        R, w = link.pose.R, link.twist.w
        L = R @ (mass.I @ w)
        way = way_through(self.system, self._moving, SECOND_STEP, order=2)
        at, _, a = way.along(place)
        rates = way.rates(L)
        m = self.one(mass.m)
        force = -np.array([float(m * x) for x in a])
        moment = -np.array([float(x) for x in rates]) + np.cross([float(x) for x in at], force)
        flat = self.system.scope.model.space == "plane"
        due = np.concatenate([moment * ([0, 0, 1] if flat else [1, 1, 1]), force])
        return self._apart(mine, due)

    @cached_property
    def _moving(self) -> dict[Node, Any]:
        assert self.equations is not None
        a = exact_accelerations(self.equations, self.state)
        return {**self.state, **dict(zip(self.equations.symbols.a, a, strict=True))}


# -------- reported sections -----------------------------------------------------------------------------------
# Reported section forces -> a check: by the names of their columns they are those that were found.
#
#     dM/dx = V between the ends of each piece,   V = 0 and M as stated at an extreme,   N, V, M the piece's polynomials
#
# Taken as they stand, at random values of all symbols: each under the head that it is printed under, and for machines.

SECTIONS, HOW_SECTIONS = "reported section forces are those that were found", "heads and texts read back, random values"
Reported = Scalar | str
SectionRows = Sequence[Mapping[str, Reported]]


def sections_reported(
    found: Mapping[str, SectionForces],
    reported: Iterable[tuple[str, str, SectionRows, SectionRows]],
    values: Mapping[str, Any],
) -> Iterator[Check]:
    """Checks of the reported section forces of each body, of every report of it.

    Args:
        reported: (body; the distance along its axis; of each piece "from", "to", "N", "V", "M"; of each extreme "x",
            "M").
        values: of parameters: near to them everything has a value.
    """
    tally, near = Tally(SECTIONS, HOW_SECTIONS), {name: float(x) for name, x in values.items()}
    for body, variable, pieces, extremes in reported:
        tally.add(body, partial(_wrong, found[body], pieces, extremes, _Values(variable, near)))
    return tally.checks()


def _wrong(forces: SectionForces, pieces: SectionRows, extremes: SectionRows, values: _Values) -> str:
    if len(pieces) != len(forces.pieces) or len(extremes) != len(forces.extremes):
        return f"{len(pieces)} pieces and {len(extremes)} extremes are reported"
    for piece, row in zip(forces.pieces, pieces, strict=True):
        start, end = values.of(piece.start), values.of(piece.end)
        ends = (("from", start), ("to", end))
        wrong = [differing(values.of(row[name]), right, tolerances.CARRIED) for name, right in ends]
        x, h = start + (end - start) * 0.37, (end - start) * 0.25
        for name, coefficients in zip("NVM", piece.series.values(), strict=True):
            right = sum(values.of(c) * (x - start) ** k for k, c in enumerate(coefficients))
            size = sum(abs(values.of(c) * (x - start) ** k) for k, c in enumerate(coefficients))
            at = values.of(row[name], x)
            wrong.append(
                f"{name}: {at:.10g} for {right:.10g}" if abs(at - right) > tolerances.CARRIED * (1 + size) else ""
            )
        slope = (8 * _rise(values, row, x, h / 2) - _rise(values, row, x, h)) / (6 * h)  # exact to the fourth power
        V = values.of(row["V"], x)
        if not any(wrong) and abs(slope - V) > tolerances.CARRIED * (1 + abs(V) + abs(values.of(row["M"], x) / h)):
            wrong.append(f"dM/dx = {slope:.10g}, V = {V:.10g}")
        if any(wrong):
            return next(filter(None, wrong))
    for extreme, one in zip(extremes, forces.extremes, strict=True):
        for name, due in (("x", one.x), ("M", one.M)):
            if apart := differing(values.of(extreme[name]), values.of(due), tolerances.CARRIED):
                return f"{name} of an extreme: {apart}"
    return ""


def _rise(values: _Values, row: Mapping[str, Reported], x: float, h: float) -> float:
    return values.of(row["M"], x + h) - values.of(row["M"], x - h)


class _Values:
    """Random values of symbols, the same of one name.

    Args:
        variable: the distance along the axis.
        near: values of symbols that have one; the random values lie near them.
    """

    def __init__(self, variable: str, near: Mapping[str, float]) -> None:
        self.variable, self.near, self.random = variable, near, Random(3)
        self.known = dict[str, float]()

    def of(self, reported: Reported, x: float = 0.0) -> float:
        """A scalar, or a text of the grammar, in numbers.

        Raises:
            NoValue: it has none.
        """
        if isinstance(reported, str):
            found = self._of_text(reported, x)
        elif type(reported) is Node:
            symbols = symbols_of((reported,))
            found = evaluate((reported,), {s: self._symbol(s.name, x) for s in symbols})[0]
        else:
            found = float(reported)
        if not math.isfinite(found):
            raise NoValue("at random values it has none")
        return float(found)

    def _of_text(self, text: str, x: float) -> Any:
        if len(text) > LONGEST:
            raise NoValue("too long to be read back")
        try:
            expression = parse(text, longest=len(text))
        except ExpressionError as error:
            raise NoValue(error.what) from error
        names = {name: self._symbol(name, x) for name in expression.names - {"pi"}}
        return expression.evaluate({**names, "pi": math.pi})

    def _symbol(self, name: str, x: float) -> float:
        if name == self.variable:
            return x
        if name not in self.known:
            value = self.near.get(name)
            self.known[name] = self.random.uniform(0.5, 2) if value is None else value * self.random.uniform(0.98, 1.02)
        return self.known[name]


# -------- reported works --------------------------------------------------------------------------------------
# Reported steps of virtual work -> a check of the motions of the blocks and of the works of the loads.
#
# Taken as they stand, tables by their heads and texts for machines, at one choice of the parameters, delta = 1:
#
#     v(P) = v_0 + w x P of each block,    w x C = -v_0 at its centre
#     sum of the wrenches of component j with it = along k_j        where R = sum k_j rho_j: nothing else does work
#     work of each force as its fields declare it,    along (R - given) + sum of works = 0,    R by the free bodies


WORKS_NAME = "reported virtual displacements and works are right"
WORKS_HOW = "wrenches of every constraint, declared forces, equilibrium of the bodies"
MIDDLE = "middle of "
SaidWork = Scalar | str
_Shift = Sequence[SaidWork]
_Moved = tuple[
    _Shift | None, SaidWork, _Shift, str
]  # (centre, None at infinity; turn; shift; where a load acts, in words)


@dataclass(frozen=True)
class ReportedWork:
    """Reported derivation of one reaction by virtual work.

    Args:
        name: of the reaction.
        blocks, along, works, value: as machines get them; blocks are (bodies, members "T n1-n2" and nodes; turn
            about z; shift of the point at the ground's origin), works (load, work).
        rows: of the printed table of blocks, by its heads; places: of the printed loads that have one.
        printed: the works as they are printed; left, right: of the printed equation R delta_R + ... = 0; last: R.
    """

    name: str
    blocks: Sequence[tuple[Sequence[str], SaidWork, _Shift]]
    along: SaidWork
    works: Sequence[tuple[str, SaidWork]]
    value: SaidWork
    rows: Sequence[_Moved]
    places: Sequence[_Moved]
    printed: Sequence[tuple[str, SaidWork]]
    left: SaidWork
    last: SaidWork


def works_reported(found: StaticReactions, state: State, reported: Iterable[ReportedWork]) -> Iterator[Check]:
    """Checks of reported reactions by virtual work, of structures in the plane.

    Args:
        state: every symbol with 50 digits.
    """
    tally, proof = (
        Tally(WORKS_NAME, WORKS_HOW),
        _Works(found, {**state, **dict.fromkeys(found.structure.unknowns, 0)}, state),
    )
    for each in reported:
        tally.add(each.name, partial(proof.wrong, each))
    return tally.checks()


@dataclass(frozen=True)
class _Works:
    """
    Args:
        state: with unknown loads 0; whole: with their values.
    """

    found: StaticReactions
    state: State
    whole: State

    def wrong(self, reported: ReportedWork) -> str:
        reaction = self.found.by_name[reported.name]
        field = _Field(self, reported)
        along, R = self.value_of(reported.along), self.balanced(reaction.name, reaction.named)
        factors = self.factors(reaction.name, reaction.named)
        for j, (owner, _) in enumerate(self.found.structure.pushes):
            work, size = field.work_of(j)
            if abs(work - along * factors.get(j, 0.0)) > tolerances.CARRIED * (size + abs(along)):
                return f"the constraint does the work {work:.6g} along {self.found.structure.names[j]} of {owner}"
        if wrong := field.wrong_works():
            return wrong
        given = 0.0 if reaction.work is None else self.value_of(reaction.work.given)
        total = sum(self.value_of(work) for _, work in reported.works)
        size = sum(abs(self.value_of(work)) for _, work in reported.works) + abs(along * R)
        if abs(along * (R - given) + total) > tolerances.CARRIED * (1 + size):
            return f"the works add up to {total:.6g}, for {-along * (R - given):.6g}"
        values = (("machines", reported.value), ("people", reported.last))
        if off := next((who for who, x in values if abs(self.value_of(x) - R) > tolerances.CARRIED * (1 + abs(R))), ""):
            return f"another value is reported to {off} than {R:.10g}"
        far = 1 + abs(R)  # a step that its digits show
        here, nearby = (self.value_of(reported.left, x, reported.name) for x in (R, R + far))
        slope = abs(nearby - here) / far
        if abs(here) > tolerances.CARRIED * (1 + size) or abs(slope - abs(along)) > tolerances.CARRIED * (
            1 + abs(along)
        ):
            return "the equation that is printed is another one"
        return field.wrong_rows()

    @cached_property
    def numbers(self) -> dict[Node, float]:
        return {node: float(x) for node, x in self.state.items()}

    def value_of(self, reported: SaidWork, R: float = 0.0, requested: str = "") -> float:
        """Value of a work with delta = 1; R is the value of the unknown, which an unknown load has by its own name."""
        if isinstance(reported, str):
            return self._of_text(reported)
        if not isinstance(reported, Node):
            return float(reported)
        known = {x: self.numbers.get(x, 1.0 if x.name.startswith("\u03b4") else R) for x in symbols_of((reported,))}
        known |= {x: R for x in known if x.name == requested}
        return float(evaluate((reported,), known)[0])

    def _of_text(self, text: str) -> float:
        if len(text) > LONGEST:
            raise NoValue("too long to be read back")
        try:
            expression = parse(text)
        except ExpressionError as error:
            raise NoValue(error.what) from error
        named = {node.name: x for node, x in self.numbers.items()}
        if not expression.names <= named.keys() | {"pi"}:
            raise NoValue(f"'{text[:60]}' is not of parameters alone")
        return float(expression.evaluate({**named, "pi": np.pi}))

    def vector(self, v: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(tuple(v), self.numbers)])

    def factors(self, name: str, named: NamedReaction | None) -> dict[int, float]:
        """k_j of R = sum k_j rho_j."""
        if named is None:
            return {self.found.structure.index(name): 1.0}
        return {j: float(self.vector((k,))[0]) for j, k in named.combination.items()}

    @cached_property
    def _least(self) -> np.ndarray:
        return balanced_least(self.found.balance.balance, self.whole)[0]

    def balanced(self, name: str, named: NamedReaction | None) -> float:
        """R by the equilibrium of the bodies in numbers."""
        given = 0 if named is None else named.given
        (own,) = evaluate((given,), self.whole, fifty_digits())
        return float(sum(k * self._least[j] for j, k in self.factors(name, named).items())) + float(own)

    @cached_property
    def centers(self) -> dict[str, np.ndarray]:
        """Mass centres, ground axes."""
        system = self.found.system
        coms = ((link, system.scope.mass_properties(link.name).com) for link in system.motion.links)
        return {link.name: self.vector(link.pose.point(com)) for link, com in coms}

    def place(self, words: str) -> tuple[str, np.ndarray] | None:
        """(body, place) of "beam.tip", "mass centre of beam", "T.n2"; None of other words."""
        if words.startswith("mass centre of "):
            body = words.removeprefix("mass centre of ")
            return body, self.centers[body]
        if "." not in words:
            return None
        scene = SystemScene(self.found.system.motion)
        place = scene.place(words)
        return None if place[0] is None else (place[0], self.vector(scene.position(place)))


@dataclass(frozen=True)
class _Field:
    """Velocities of all moving bodies and nodes, as the blocks are reported to machines."""

    proof: _Works
    reported: ReportedWork

    @cached_property
    def motions(self) -> dict[str, np.ndarray]:
        """body or node -> (w, v_x, v_y) of the point at the ground's origin; one that is not reported is at rest."""
        found: dict[str, np.ndarray] = {}
        ends = {f"{truss} {member}": pair for truss, member, pair in self.proof.found.system.scope.model.truss_members}
        for parts, spin, shift in self.reported.blocks:
            own = np.array([self.proof.value_of(x) for x in (spin, *shift[:2])])
            for part in parts:
                found |= dict.fromkeys(ends.get(part, (part,)), own)
        return found

    def at(self, body: str, place: np.ndarray) -> np.ndarray:
        w, vx, vy = self.motions.get(body, np.zeros(3))
        return np.array([vx - w * place[1], vy + w * place[0]])

    def work_of(self, j: int) -> tuple[float, float]:
        """(work of a unit of a component, how large its parts are)."""
        proof, total, size = self.proof, 0.0, 0.0
        for effect in proof.found.structure.pushes[j][1]:
            name = proof.found.system.motion.links[effect.link].name
            force, couple, arm = (proof.vector(v) for v in (effect.force, effect.couple, effect.arm))
            parts = [*(force[:2] * self.at(name, proof.centers[name] + arm)), couple[2] * self._spin(name)]
            total, size = total + float(sum(parts)), size + float(sum(map(abs, parts)))
        return total, size

    def _spin(self, body: str) -> float:
        return float(self.motions.get(body, np.zeros(3))[0])

    def wrong_works(self) -> str:
        """Message if the reported work of a force is not that of its declared fields; ""."""
        model = self.proof.found.system.scope.model
        for who, works in (("machines", self.reported.works), ("people", self.reported.printed)):
            stated: dict[str, float] = {}
            for name, work in works:
                stated[name] = stated.get(name, 0.0) + self.proof.value_of(work)
            for name in model.forces:
                due = 0.0
                for body, (moment, force) in declared_pushes(self.proof.found.system, self.proof.state, name).items():
                    if body is not None:
                        six = np.array([moment[2], force[0], force[1]], dtype=float)
                        due += float(six @ self.motions.get(body, np.zeros(3)))
                if abs(stated.get(name, 0.0) - due) > tolerances.CARRIED * (1 + abs(due)):
                    return f"{name} works {stated.get(name, 0.0):.6g}, as reported to {who}, for {due:.6g}"
        return ""

    def wrong_rows(self) -> str:
        """Printed centres, turns and shifts are those of the blocks; those of loads of their places."""
        if len(self.reported.rows) != len(self.reported.blocks):
            return f"{len(self.reported.rows)} blocks are printed of {len(self.reported.blocks)}"
        for k, (row, block) in enumerate(zip(self.reported.rows, self.reported.blocks, strict=True), start=1):
            own = np.array([self.proof.value_of(x) for x in (block[1], *block[2][:2])])
            center, spin, shift, _ = row
            moved = np.array([self.proof.value_of(x) for x in shift])
            if center is not None:
                x, y = (self.proof.value_of(x) for x in center)
                moved = self.proof.value_of(spin) * np.array([y, -x])
            if np.any(
                np.abs([self.proof.value_of(spin) - own[0], *(moved - own[1:])])
                > tolerances.CARRIED * (1 + abs(own).max())
            ):
                return f"block {k} is printed with another motion"
        for _, _, shift, at in self.reported.places:
            words = [at] if not at.startswith(MIDDLE) else at.removeprefix(MIDDLE).split(", ")
            places = [self.proof.place(each) for each in words]
            if all(places):
                due = np.mean([self.at(*place) for place in places if place is not None], axis=0)
                moved = np.array([self.proof.value_of(x) for x in shift])
                if np.any(np.abs(moved - due) > tolerances.CARRIED * (1 + abs(due).max())):
                    return f"{at} is printed with the shift {moved}, for {due}"
        return ""
