"""StaticReactions, section forces, influence lines -> checks of a structure at rest, in numbers.

    N = R . t,  V = -R . n,  M = T        of all that acts behind the section (R, and T about it): from the other end
    dM/dx = V,   dV/dx = q . n,   dN/dx = -q . t
    G rho = -e                            reactions to a unit load at a place of an influence line, by equilibrium

Diagrams are read from their picture: every place of a curve, and every number next to one, in the unit at its axis.

Reactions are found in two ways before they come here, by virtual work and by the equilibrium of the bodies.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain, combinations, pairwise
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import NamedReaction, imbalance
from eomgen.mechanics.statics import InfluenceLine, SectionForces, SectionPiece, StaticReactions
from eomgen.proof.check import Certificate, Check, Tally, attempted, checked, first_wrong
from eomgen.proof.declared_loads import acting_otherwise, balanced_least, rates_of_fluids
from eomgen.proof.declared_threads import STRUNG, has_threads, strung_otherwise
from eomgen.proof.drawn import DrawnCurve, DrawnPanel, ReportedPush, said_of, space_sections_drawn, structure_drawn
from eomgen.proof.free_bodies import named_otherwise
from eomgen.proof.masses import other_data
from eomgen.proof.posed_model import apart, meetings_of
from eomgen.proof.reported_cuts import ReportedWork, SectionRows, sections_reported, works_reported
from eomgen.symbolic.expression import Node, Scalar, Vector, parse, symbols_of
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

IN_NUMBERS = "floating point"
MOST_PLANS = 4  # released structures whose blocks are looked at, evenly spread
PARTS = tuple((2 * k + 1) / 16 for k in range(8))  # of a piece, at which the sign of V is looked at
QUARTERS = (0.25, 0.75)  # of a straight piece, at which straight lines are compared
DRAWN = "drawn N, V, M and influence lines are right"
HOW_DRAWN = "curves and numbers of the picture, from the other end and by unit loads"
PREFIXES = {"": 1.0, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}  # of N and N m


def certify_structure(
    found: StaticReactions,
    sections: Mapping[str, SectionForces],
    influence: InfluenceLine | None = None,
    *,
    reported: Iterable[tuple[str, str, SectionRows, SectionRows]] = (),
    works: Iterable[ReportedWork] = (),
) -> Certificate:
    """Check the two ways, every body's balance, section forces from the other end, influence lines by loads.

    Args:
        sections: the section forces by body; reported: every report of them.
        works: reported derivations of reactions by virtual work, of a structure in the plane.
    """
    values = found.system.scope.model.exact_parameters()
    return Certificate(
        (
            *_structure_checks(found, sections, influence),
            *other_data(found.system.motion),
            *sections_reported(sections, reported, values),
            *works_reported(found, state_of(found), works),
        )
    )


def _structure_checks(
    found: StaticReactions, sections: Mapping[str, SectionForces], influence: InfluenceLine | None
) -> Iterator[Check]:
    """Checks of every reaction, of the section forces by body, and of an influence line."""
    wrong = ", ".join(reaction.name for reaction in found.disagreeing)
    both = [reaction for reaction in found.reactions if reaction.work is not None]
    if both:
        yield checked("virtual work and the equilibrium of the bodies give the same reactions", wrong, "exact")
    yield from _left_out(found)
    proof = _Proof(found)
    name = "every body, every pair and the whole are in equilibrium"
    fluids = rates_of_fluids(found.structure.system)
    yield attempted(name, IN_NUMBERS, lambda: imbalance(found.balance, proof.state, Random(7), fluids))
    name = "reactions named by x, y and z are those along the ground's axes"
    yield attempted(name, "50 digits", lambda: named_otherwise(found.balance.balance, proof.state))
    system = found.structure.system
    if meetings_of(system):
        name = "contacts lie on both surfaces, and push by 1 N for each unit of their force"
        yield attempted(name, "50 digits", lambda: apart(system, proof.state))
    if has_threads(system):
        yield attempted(STRUNG, "50 digits", lambda: strung_otherwise(system, proof.state))
    if found.sums and not found.structure.unknowns:
        name = "stated sums have one value, whatever the self-stress"
        yield checked(name, first_wrong(proof.wrong_sums()), IN_NUMBERS)
    if (differs := proof.wrong_contacts()) is not None:
        yield checked("an equilibrium that all contacts allow exists, or is denied, as reported", differs, IN_NUMBERS)
    if system.loads.applied:
        name = "applied loads act as their fields declare"
        yield attempted(name, "50 digits", lambda: acting_otherwise(system, proof.state))
    if sections:
        for name, wrong_one in (
            ("N, V and M are the same from the other end", proof.wrong_from_behind),
            ("dM/dx = V, dV/dx = q . n, dN/dx = -q . t", proof.wrong_slopes),
            ("where M has an extreme V is 0, within a part", proof.wrong_extremes),
        ):
            yield checked(name, first_wrong(map(wrong_one, sections.values())), IN_NUMBERS)
    blocks = proof.wrong_blocks()
    if blocks is not None:
        yield checked("blocks of released structures move as one each, and differ", blocks, IN_NUMBERS)
    if influence is not None:
        wrong = proof.wrong_influence(influence)
        yield checked("the influence line is what unit loads give at places of it", wrong, IN_NUMBERS)


def structure_pictured(
    found: StaticReactions,
    sections: Mapping[str, SectionForces],
    influence: InfluenceLine | None,
    panels: Sequence[DrawnPanel],
    pushes: Iterable[ReportedPush],
) -> Iterator[Check]:
    """Checks of a picture of a structure: its diagrams and influence line by their panels, the arrows together.

    Args:
        sections: the section forces by body.
        pushes: all that is drawn to act on the structure; () where sizes are not all known.
    """
    if found.system.scope.model.space == "plane":
        yield from _diagrams_drawn(found, sections, influence, panels)
    else:
        yield from space_sections_drawn(state_of(found), sections, panels)
    yield from structure_drawn(pushes)


def _diagrams_drawn(
    found: StaticReactions,
    sections: Mapping[str, SectionForces],
    influence: InfluenceLine | None,
    panels: Sequence[DrawnPanel],
) -> Iterator[Check]:
    """Check of every panel titled N, V or M of a body, or influence line."""
    proof, tally = _Proof(found), Tally(DRAWN, HOW_DRAWN)
    drawn = set[str]()
    for panel in panels:
        what, unit = said_of(panel.y)
        letter, _, body = what.partition(" of ")
        if letter in ("N", "V", "M") and body in sections:
            drawn.add(body)
            tally.add(what, partial(_Diagram(proof, sections[body], letter, panel, unit).wrong))
        elif influence is not None and panel.y == influence.name:
            drawn.add(influence.name)
            tally.add(what, partial(proof.wrong_line, influence, panel))
    if influence is not None and drawn:
        tally.add(influence.name, lambda: "" if influence.name in drawn else "it is not drawn")
    yield from tally.checks()


def state_of(found: StaticReactions) -> dict[Node, Any]:
    """Every symbol with 50 digits; parameters without a value are random, unknown loads have their solution."""
    return _Proof(found).state


def _left_out(found: StaticReactions) -> Iterator[Check]:
    """A failing check where a component that holds the bodies is in none of the reported reactions; else none."""
    reported = {j for reaction in found.reactions if reaction.named for j in reaction.named.combination}
    missing = [c.name for j, c in enumerate(found.structure.components) if j not in reported]
    if missing:
        yield checked("every reaction is reported", ", ".join(missing), "exact")


@dataclass(frozen=True)
class _Proof:
    """Tests of a structure's results; each gives what is wrong in words, or "".

    Args:
        found: the structure and its reactions.
    """

    found: StaticReactions

    # -- numbers ---------------------------------------------------------------------------------------------

    @cached_property
    def state(self) -> dict[Node, Any]:
        """Every symbol with 50 digits; parameters without a value are random, unknown loads have their solution."""
        structure = self.found.structure
        known: dict[Node, Any] = structure.system.scope.values_of_parameters(Random(3))
        for given in (structure.at, self.found.balance.unknowns):
            known |= dict(zip(given, evaluate(tuple(given.values()), known, fifty_digits()), strict=True))
        return {**dict.fromkeys(structure.unknowns, 0), **known}

    @cached_property
    def values(self) -> dict[Node, float]:
        return {node: float(x) for node, x in self.state.items()}

    def numbers(self, scalars: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(tuple(scalars), self.values)])

    @cached_property
    def _balancing(self) -> tuple[np.ndarray, np.ndarray]:
        return balanced_least(self.found.balance.balance, self.state)

    def wrong_sums(self) -> Iterator[str]:
        """Sums that have another value by the reactions of least norm, or change with a self-stress."""
        least, added = self._balancing
        for each in self.found.sums:
            factors = np.zeros(len(least))
            factors[list(each.combination)] = self.numbers(tuple(each.combination.values()))
            size = np.abs(factors) @ np.abs(least) + np.abs(factors).max() * np.abs(least).max(initial=0.0)
            off = abs(factors @ least - self.one(each.value)) > tolerances.COMPUTED * size
            names = " + ".join(self.found.structure.names[j] for j in each.combination)
            if off or np.any(np.abs(factors @ added) > tolerances.COMPUTED * np.abs(factors).sum()):
                yield f"the sum of {names}"

    def wrong_contacts(self) -> str | None:
        """Contradiction of a report with the equilibria of the bodies; None where no contact is indeterminate.

        The equilibria are the reactions of least norm and what may be added; the largest margin that all contacts have
        in one of them is sought anew.
        """
        from scipy.optimize import linprog

        scope = self.found.system.scope
        if scope.numbers(tuple(scope.symbols.parameters.values())) is None:
            return None
        least, added = self._balancing
        rows = np.array([*self._contact_margins()]).reshape(-1, len(least) + 1)
        margins, slopes = rows[:, :-1] @ least + rows[:, -1], rows[:, :-1] @ added
        if np.all(np.abs(slopes) <= tolerances.COMPUTED):
            return None
        size = 1.0 + np.abs(least).max(initial=0.0)
        above = np.column_stack([-slopes, np.ones(len(rows))])
        bounds = [(None, None)] * added.shape[1] + [(None, size)]
        best = linprog(np.eye(added.shape[1] + 1)[-1] * -1, above, margins, bounds=bounds, method="highs")
        exists = best.status == 0 and -best.fun >= -tolerances.COMPUTED * size
        if exists and self.found.excluded:
            return "one exists, and none is said to"
        return "" if exists or self.found.excluded else "none exists, and this is not said"

    def _contact_margins(self) -> Iterator[np.ndarray]:
        """Rows of what may not be negative, linear in the components, last a constant: N, mu N - |t|, T - |f|."""
        named = {each.name: each for each in NamedReaction.all_of(self.found.balance.balance)}
        width = len(self._balancing[0]) + 1

        def row(*names: str) -> np.ndarray | None:
            for name in names:
                if name in named:
                    found = np.zeros(width)
                    found[list(named[name].combination)] = self.numbers(tuple(named[name].combination.values()))
                    found[-1] = self.one(named[name].given)
                    return found
            return None

        for contact in self.found.system.scope.model.contacts:
            name, most = contact.name, np.zeros(width)
            along = row(f"friction({name})", f"reaction_t({name})")
            normal = row(f"reaction_n({name})", f"tension({name})", f"reaction_couple({name})")
            if contact.size is not None and contact.grip is not None:
                most[-1] = max(0.0, self.one(self.found.system.scope.value(contact.grip)))
            elif contact.unilateral and normal is not None:
                yield normal
                if contact.mu is None or contact.surface:
                    continue
                most = self.one(self.found.system.scope.value(contact.mu)) * normal
            else:
                continue
            if along is not None:
                yield most - along
                yield most + along

    def one(self, x: Scalar) -> float:
        return float(self.numbers((x,))[0])

    # -- section forces --------------------------------------------------------------------------------------

    @cached_property
    def _loads(self) -> dict[str, _Along]:
        return {}

    def along(self, forces: SectionForces) -> _Along:
        """Loads along a body, in numbers."""
        body = forces.axis.body
        if body not in self._loads:
            loads = forces.loads
            actions = [
                (self._x(forces, place), self.numbers(place), self.numbers(force), self.one(couple[2]))
                for place, force, couple in loads.actions
            ]
            spreads = []
            for start, end, at_start, at_end in loads.spreads:
                ends = [self._x(forces, place) for place in (start, end)]
                spreads.append((ends, *map(self.numbers, (start, end, at_start, at_end))))
            self._loads[body] = _Along(tuple(actions), tuple(spreads))
        return self._loads[body]

    def _x(self, forces: SectionForces, place: Vector) -> float:
        """Distance of a place along the axis of its body; 0 off the axis, where no section forces act."""
        x = forces.axis.distance(place)
        return 0.0 if x is None else self.one(x)

    def wrong_from_behind(self, forces: SectionForces) -> str:
        along = self.along(forces)
        for piece in forces.pieces:
            start, end = self.one(piece.start), self.one(piece.end)
            leg = piece.leg
            origin, x0 = self.numbers(leg.start), self.one(leg.x)
            t, n = self.numbers(leg.along), self.numbers(leg.left)
            for part in QUARTERS:
                x = start + part * (end - start)
                R, T, size, moment = along.behind(x, origin + (x - x0) * t)
                found = {"axial_force": R @ t, "shear_force": -R @ n, "bending_moment": T}
                for kind, value in found.items():
                    stated = self._value(piece, kind, x)
                    if abs(stated - value) > tolerances.COMPUTED * (moment if kind == "bending_moment" else size):
                        return f"{kind}({forces.axis.body}, {x:.6g}): {stated:.10g} against {value:.10g}"
        return ""

    def _value(self, piece: SectionPiece, kind: str, x: float) -> float:
        """Value at x of a section force as it is printed."""
        section = self.found.system.scope.graph.symbol("(x of a section)")
        return float(evaluate((piece.value(kind, section),), {**self.values, section: x})[0])

    def wrong_extremes(self, forces: SectionForces) -> str:
        """Message if V is not 0 at an extreme, M is not the stated one, or an extreme is missing; ""."""
        stated = [self.numbers((extreme.x, extreme.M)) for extreme in forces.extremes]
        for x, M in stated:
            mine = [p for p in forces.pieces if self.one(p.start) < x < self.one(p.end)]
            if not mine:
                return f"x = {x:.6g} lies in no part of '{forces.axis.body}'"
            V, T, size, moment = self._behind(forces, mine[0], x)
            if abs(V) > tolerances.COMPUTED * size or abs(T - M) > tolerances.COMPUTED * moment:
                return f"at x = {x:.6g} of '{forces.axis.body}' V = {V:.6g} and M = {T:.10g} for {M:.10g}"
        for a, b in self._turns(forces):
            if not any(a < x < b for x, _ in stated):
                return f"M has an extreme between x = {a:.6g} and {b:.6g} of '{forces.axis.body}', not reported"
        return ""

    def _behind(self, forces: SectionForces, piece: SectionPiece, x: float) -> tuple[float, float, float, float]:
        """(V, M, size of each) at a place of a piece, from the other end."""
        leg = piece.leg
        t, n = self.numbers(leg.along), self.numbers(leg.left)
        R, T, size, moment = self.along(forces).behind(x, self.numbers(leg.start) + (x - self.one(leg.x)) * t)
        return float(-R @ n), T, size, moment

    def _turns(self, forces: SectionForces) -> Iterator[tuple[float, float]]:
        """(a, b) between which V surely changes its sign within a piece, of pieces whose place is known."""
        sizes = forces.sizes
        for piece in forces.pieces:
            if (
                not set(symbols_of((piece.start, piece.end, *piece.series["shear_force"])))
                <= sizes.values.keys() | sizes.at.keys()
            ):
                continue
            start, end = self.one(piece.start), self.one(piece.end)
            places = [start + part * (end - start) for part in PARTS]
            signs = [
                (x, V)
                for x in places
                for V, _, size, _ in (self._behind(forces, piece, x),)
                if abs(V) > tolerances.COMPUTED * size
            ]
            yield from ((a, b) for (a, V), (b, W) in pairwise(signs) if V * W < 0)

    def wrong_slopes(self, forces: SectionForces) -> str:
        """Message if a polynomial's derivative at some x is not its load: dM/dx = V, dV/dx = q n, dN/dx = -q t; ""."""
        along = self.along(forces)
        for piece in forces.pieces:
            start, end = self.one(piece.start), self.one(piece.end)
            N, V, M = (self.numbers(series)[::-1] for series in piece.series.values())
            t, n = self.numbers(piece.leg.along), self.numbers(piece.leg.left)
            for part in QUARTERS:
                s = part * (end - start)
                q, scale = along.load_at(start + s), abs(V).max() + along.largest * (end - start) + along.force
                pairs = (("dM/dx", M, np.polyval(V, s)), ("dV/dx", V, q @ n), ("dN/dx", N, -q @ t))
                for what, series, value in pairs:
                    unit = scale if what == "dM/dx" else scale / (end - start)
                    if abs(np.polyval(np.polyder(series), s) - value) > tolerances.COMPUTED * unit:
                        return f"{what} of '{forces.axis.body}' at x = {start + s:.6g}"
        return ""

    # -- released structures -----------------------------------------------------------------------------------

    def wrong_blocks(self) -> str | None:
        """Message if parts of a block move otherwise than v = v_0 + w x r, or two blocks move alike; "".

        None where no reaction is found by virtual work.
        """
        plans = [(each.name, each.work.plan) for each in self.found.reactions if each.work is not None]
        for name, plan in plans[:: 1 + len(plans[1:]) // MOST_PLANS]:
            blocks = plan.blocks
            fields = [np.array(plan.numbers((*block.spin, *block.velocity)), float) for block in blocks]
            for block, field in zip(blocks, fields, strict=True):
                for part, places in self._ends(block.bodies, block.members):
                    for place in places:
                        both = plan.numbers((*plan.position(place), *plan.raw_velocity(place)))
                        r, v = np.split(np.array(both, float), 2)
                        if abs(field[3:] + np.cross(field[:3], r) - v).max() > tolerances.COMPUTED * (1 + abs(v).max()):
                            return f"{part} does not move with its block, {name} released"
            for one, other in combinations([f for f, b in zip(fields, blocks, strict=True) if not b.nodes], 2):
                if abs(one - other).max() <= tolerances.COMPUTED * (1 + abs(one).max()):
                    return f"two blocks move alike, {name} released"
        return "" if plans else None

    def _ends(
        self, bodies: Iterable[str], members: Iterable[tuple[str, str]]
    ) -> Iterator[tuple[str, list[tuple[str, Vector]]]]:
        ends = {(truss, member): pair for truss, member, pair in self.found.system.scope.model.truss_members}
        yield from ((body, [(body, Vector.ZERO), (body, Vector((1, 2, 0)))]) for body in bodies)
        yield from ((member[1], [(node, Vector.ZERO) for node in ends[member]]) for member in members)

    # -- influence lines -------------------------------------------------------------------------------------

    def wrong_influence(self, line: InfluenceLine) -> str:
        for span in line.spans:
            ends = [self.numbers(place) for place in (span.start, span.end)]
            stated = [self.one(x) for x in (span.at_start, span.at_end)]
            for part, body in self._stops(span.name):
                place = ends[0] + part * (ends[1] - ends[0])
                value = self._by_load(line, body, place)
                expected = stated[0] + part * (stated[1] - stated[0])
                if abs(value - expected) > tolerances.COMPUTED * (1 + abs(value)):
                    return f"at ({place[0]:.6g}, {place[1]:.6g}): {expected:.10g} against {value:.10g}"
        return ""

    def _stops(self, span: str) -> Iterator[tuple[float, str]]:
        """(part of a span, body or node that takes the load there), by its name."""
        if span in self.found.system.motion.index:
            yield from ((part, span) for part in QUARTERS)
            return
        first, _, last = span.rpartition("-")
        yield from ((0.0, first), (1.0, last if "." in last else f"{first.partition('.')[0]}.{last}"))

    def _by_load(self, line: InfluenceLine, body: str, place: np.ndarray) -> float:
        """Force due to the unit load at a place of a body, by the equilibrium of all bodies."""
        load = self.numbers(line.load)
        i = self.found.system.motion.index[body]
        right = np.zeros(self._G.shape[0])
        right[3 * i : 3 * i + 3] = _wrench(load, place - self._centers[i])
        scale = 1 / np.maximum(abs(self._G).max(axis=0, initial=0), tolerances.RANK)
        x = scale * np.linalg.lstsq(self._G * scale, -right, rcond=tolerances.RANK)[0]
        if line.cut is None:
            return self._named(line.name, x)
        return self._in_section(line, x, (body, place, load))

    def wrong_line(self, line: InfluenceLine, panel: DrawnPanel) -> str:
        """The curve of each span, over x or over the way that the load has gone."""
        if len(panel.curves) != len(line.spans) or panel.is_turned or panel.hidden:
            return "other spans are drawn, or hidden"
        way, over_x = 0.0, panel.x.startswith("x ")
        for curve, span in zip(panel.curves, line.spans, strict=True):
            a, b = (self.numbers(place) for place in (span.start, span.end))
            length = float(np.linalg.norm(b - a))
            due = (a[0], b[0]) if over_x else (way, way + length)
            way += length
            x, y = curve.places[1:-1].T
            if _far((x[0], x[-1]), due, way) or np.any(curve.places[[0, -1], 1]):
                return f"{span.name} is drawn from {x[0]:.6g} to {x[-1]:.6g}, not from {due[0]:.6g} to {due[1]:.6g}"
            for part, body in self._stops(span.name):
                value, found = self._by_load(line, body, a + part * (b - a)), y[0] + part * (y[-1] - y[0])
                if abs(value - found) > tolerances.CARRIED * (1 + abs(value)):
                    return f"in {span.name}: {found:.6g} for {value:.6g}"
        return _misnamed(panel)

    @cached_property
    def _centers(self) -> list[np.ndarray]:
        system = self.found.system
        coms = ((link.pose, system.scope.mass_properties(link.name).com) for link in system.motion.links)
        return [self.numbers(pose.point(com)) for pose, com in coms]

    @cached_property
    def _G(self) -> np.ndarray:
        """(force, moment about the mass centre) of a unit of each component and unknown load on each body."""
        G = np.zeros((3 * len(self._centers), len(self.found.structure.pushes)))
        for j, (_, effects) in enumerate(self.found.structure.pushes):
            for e in effects:
                force, couple, arm = (self.numbers(v) for v in (e.force, e.couple, e.arm))
                G[3 * e.link : 3 * e.link + 3, j] += _wrench(force, arm) + np.array([0, 0, couple[2]])
        return G

    def _named(self, name: str, x: np.ndarray) -> float:
        table = {n.name: n for n in NamedReaction.all_of(self.found.structure.balance)}
        known = {str(parse(n, references=True).call): n for n in table} | {n: n for n in table}
        combination = table[known[name]].combination
        return float(sum(self.one(k) * x[j] for j, k in combination.items()))

    def _in_section(self, line: InfluenceLine, x: np.ndarray, load: tuple[str, np.ndarray, np.ndarray]) -> float:
        """N, V or M of the loads before the section."""
        cut = line.cut
        assert cut is not None
        motion = self.found.system.motion
        i, at, section = motion.index[cut.axis.body], self.numbers(cut.place), self.one(cut.x)
        R, T = np.zeros(3), 0.0
        for j, (owner, effects) in enumerate(self.found.structure.pushes):
            for e in effects:
                mine = (c.effects for c in self.found.structure.components if c.owner == owner)
                places = (each.place for each in (e, *chain(*mine)) if each.link == e.link)
                place = next((place for place in places if place is not None), None)
                s = None if place is None else cut.axis.distance(place)
                if e.link != i or place is None or s is None or not cut.before(s):
                    continue
                force = self.numbers(e.force) * x[j]
                arm = self.numbers(motion.position((cut.axis.body, place))) - at
                R, T = R + force, T + _wrench(force, arm)[2] + self.one(e.couple[2]) * x[j]
        body, place_, force = load
        if body == cut.axis.body and self._distance(line, place_) < section:
            R, T = R + force, T + _wrench(force, place_ - at)[2]
        leg = next((leg for leg in reversed(cut.axis.legs) if self.one(leg.x) <= section), cut.axis.legs[0])
        ends = [self._on(cut.axis.body, leg.place(x)) for x in (leg.x, leg.x + leg.length)]
        t = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        left = np.array([-t[1], t[0], 0.0])
        found = {"axial_force": -R @ t, "shear_force": R @ left, "bending_moment": -T}
        return float(found[line.name.partition("(")[0]])

    def _distance(self, line: InfluenceLine, place: np.ndarray) -> float:
        """Distance of a place along the axis of the cut body."""
        assert line.cut is not None
        axis = line.cut.axis
        best, away = 0.0, np.inf
        for leg in axis.legs:
            ends = [self._on(axis.body, leg.place(x)) for x in (leg.x, leg.x + leg.length)]
            along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
            s = (place - ends[0]) @ along
            off = float(np.linalg.norm(place - ends[0] - s * along))
            if off < away:
                best, away = self.one(leg.x) + s, off
        return float(best)

    def _on(self, body: str, place: Vector) -> np.ndarray:
        return self.numbers(self.found.system.motion.position((body, place)))


# -- as they are drawn ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Diagram:
    """Check of N, V or M of one body as it is drawn.

    Args:
        letter: which of them; unit: in which.
    """

    proof: _Proof
    forces: SectionForces
    letter: str
    panel: DrawnPanel
    unit: str

    def wrong(self) -> str:
        panel, pieces = self.panel, self.forces.pieces
        if panel.hidden or panel.is_turned != (self.letter == "M"):
            return "it is not drawn on the side of the stretched fibre" if self.letter == "M" else "it is turned"
        if len(panel.curves) != len(pieces):
            return f"{len(panel.curves)} pieces are drawn of {len(pieces)}"
        for curve, piece in zip(panel.curves, pieces, strict=True):
            if wrong := self._wrong_curve(curve, piece):
                return wrong
        if self.letter == "M":
            for a, b in self.proof._turns(self.forces):
                if not any(a < place[0] < b for _, place in panel.names):
                    return f"no number stands at the extreme between x = {a:.6g} and {b:.6g}"
        return _misnamed(panel)

    def _wrong_curve(self, curve: DrawnCurve, piece: SectionPiece) -> str:
        start, end = self.proof.one(piece.start), self.proof.one(piece.end)
        x, y = curve.places[1:-1].T
        if _far((x[0], x[-1]), (start, end), end) or np.any(np.diff(x) < 0) or np.any(curve.places[[0, -1], 1]):
            return f"drawn from {x[0]:.6g} to {x[-1]:.6g}, not from {start:.6g} to {end:.6g}"
        for at, value in zip(x, y * PREFIXES[self.unit.partition("N")[0]], strict=True):
            inside = min(
                max(at, start + tolerances.COMPUTED * (end - start)), end - tolerances.COMPUTED * (end - start)
            )
            right, size = self._from_behind(piece, inside)
            if abs(value - right) > tolerances.CARRIED * (size + 1):
                return f"at x = {at:.6g} {value:.6g} for {right:.6g}"
        return ""

    def _from_behind(self, piece: SectionPiece, x: float) -> tuple[float, float]:
        """(value, its size)."""
        leg, proof = piece.leg, self.proof
        t, n = proof.numbers(leg.along), proof.numbers(leg.left)
        R, T, size, moment = proof.along(self.forces).behind(x, proof.numbers(leg.start) + (x - proof.one(leg.x)) * t)
        return {"N": (float(R @ t), size), "V": (float(-R @ n), size), "M": (T, moment)}[self.letter]


def _far(found: tuple[float, float], due: tuple[float, float], size: float) -> bool:
    return bool(np.any(np.abs(np.subtract(found, due)) > tolerances.SAME_PLACE * (1 + abs(size))))


def _misnamed(panel: DrawnPanel) -> str:
    """Message if a number stands where no curve is, or differs from the curve, or is missing at a corner; ""."""
    corners = np.concatenate([curve.places[[1, -2]] for curve in panel.curves])
    size = np.abs(np.concatenate([curve.places for curve in panel.curves])).max(axis=0)
    for text, place in panel.names:
        if abs(float(text) - place[1]) > tolerances.FOUR_DIGITS * abs(place[1]):
            return f"{text} stands at {place[1]:.6g}"
        if not any(_is_on(curve.places[1:-1], place, size) for curve in panel.curves):
            return f"{text} stands next to the curve"
    for corner in corners:
        near = any(np.all(np.abs(place - corner) <= tolerances.SAME_PLACE * size) for _, place in panel.names)
        if abs(corner[1]) > tolerances.COMPUTED * size[1] and not near:
            return f"no number stands at the corner ({corner[0]:.6g}, {corner[1]:.6g})"
    return ""


def _is_on(places: np.ndarray, place: np.ndarray, size: np.ndarray) -> bool:
    """True if a place is on a curve; between two of its points the tolerance is the bend of the curve there."""
    x, y = places.T
    if not x[0] - tolerances.SAME_PLACE * size[0] <= place[0] <= x[-1] + tolerances.SAME_PLACE * size[0]:
        return False
    if x[-1] - x[0] <= tolerances.SAME_PLACE * size[0]:  # a jump
        return bool(y.min() - tolerances.SAME_PLACE * size[1] <= place[1] <= y.max() + tolerances.SAME_PLACE * size[1])
    bent = float(np.abs(np.diff(y, 2)).max(initial=0.0)) if len(y) > 2 else 0.0
    return bool(abs(np.interp(place[0], x, y) - place[1]) <= bent + tolerances.SAME_PLACE * size[1])


def _wrench(force: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """(f_x, f_y, moment)"""
    return np.array([force[0], force[1], arm[0] * force[1] - arm[1] * force[0]])


@dataclass(frozen=True)
class _Along:
    """Loads along a body, in body axes, in numbers.

    Args:
        actions: (x, place, force, couple) each.
        spreads: ((x of the start, of the end), start, end, load per length at the start, at the end) each.
    """

    actions: tuple[tuple[float, np.ndarray, np.ndarray, float], ...]
    spreads: tuple[Any, ...]

    def behind(self, x: float, section: np.ndarray) -> tuple[np.ndarray, float, float, float]:
        """Resultant R and moment T of all loads beyond x, and the size of each.

        The moment is about the section. Line loads are integrated by Simpson's rule, which is exact for them.
        """
        R, T, size, moment = np.zeros(3), 0.0, self.force, 0.0
        for at, place, force, couple in self.actions:
            T_here = _wrench(force, place - section)[2] + couple
            moment += abs(couple) + float(np.linalg.norm(force) * np.linalg.norm(place - section))
            if at > x:
                R, T = R + force, T + T_here
        for (a, b), start, end, at_start, at_end in self.spreads:
            begin = min(max((x - a) / (b - a), 0.0), 1.0)
            if a > b:
                begin = 1 - min(max((x - b) / (a - b), 0.0), 1.0)
            first, last = (0.0, begin) if a > b else (begin, 1.0)
            length = abs(last - first) * abs(b - a)
            moment += self.largest * abs(b - a) * float(np.linalg.norm(end - section) + np.linalg.norm(start - section))
            for part, weight in ((first, 1), ((first + last) / 2, 4), (last, 1)):
                q, r = at_start + part * (at_end - at_start), start + part * (end - start) - section
                R, T = R + weight * length / 6 * q, T + weight * length / 6 * _wrench(q, r)[2]
        return R, float(T), size, moment

    def load_at(self, x: float) -> np.ndarray:
        """The load per length."""
        q = np.zeros(3)
        for (a, b), _, _, at_start, at_end in self.spreads:
            if min(a, b) <= x <= max(a, b):
                q = q + at_start + (x - a) / (b - a) * (at_end - at_start)
        return q

    @cached_property
    def largest(self) -> float:
        return max((float(np.linalg.norm(q)) for s in self.spreads for q in s[3:]), default=0.0)

    @cached_property
    def force(self) -> float:
        """Size of the forces along the body, the sum of their norms [N]."""
        spread = sum(self.largest * abs(b - a) for (a, b), *_ in self.spreads)
        return float(sum(np.linalg.norm(force) for _, _, force, _ in self.actions) + spread)
