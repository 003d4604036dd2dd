"""Model -> Statics: a structure at rest: solved, written step by step, as JSON entries."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import (
    Cell,
    Document,
    Entry,
    Formula,
    Law,
    Name,
    Picture,
    Piece,
    Quantity,
    Rate,
    Reader,
    Result,
    Sketch,
    Statement,
    Step,
    count,
    data_step,
    document_of,
    listed_symbols,
    narrow_grid,
    open_at_rest,
    page,
    prose,
    said,
)
from eomgen.errors import RunFailed, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.equilibrium import Equilibria, Equilibrium, RestingReactions
from eomgen.mechanics.linearization import Modes
from eomgen.mechanics.start import shown_numbers
from eomgen.mechanics.statics import (
    ContactsAtStart,
    InfluenceLine,
    StaticReactions,
    WorkEquation,
)
from eomgen.model import Model, ModelOrPath, Values, model_at
from eomgen.proof import (
    Certificate,
    Check,
    DrawnPanel,
    ReportedWork,
    certify_equilibria,
    certify_structure,
)
from eomgen.resources import doing
from eomgen.results.at_rest.section_steps import (
    Sections,
    influence_payload,
    influence_step,
    reported_sections,
    section_payload,
    section_steps,
    sections_of,
)
from eomgen.results.at_rest.steps import contacts_step, ranges_step, reported_work, statics_derivation, sum_name
from eomgen.study import study_at_rest
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import to_text

MOST_REPORTED = 8  # reactions whose virtual work is read again


@dataclass(frozen=True)
class Statics(Result):
    """A structure at rest: every reaction by virtual work and by equilibrium.

    Args:
        model: the structure.
        found: its reactions.
        influence: an influence line, where one was requested.
    """

    model: Model
    found: StaticReactions
    influence: InfluenceLine | None = None

    def __repr__(self) -> str:
        return f"<statics of {self.model.name!r}: {len(self.found.reactions)} reactions>"

    @property
    def ok(self) -> bool:
        """True if virtual work and equilibrium agree."""
        return not self.found.disagreeing

    @property
    def failed(self) -> str:
        """Errors or open questions of the result, in words; "" if there are none."""
        if self.ok:
            return "; ".join((*self._open, *self.broken))
        wrong = ", ".join(reaction.name for reaction in self.found.disagreeing)
        return f"virtual work and equilibrium do not agree: {wrong}"

    @property
    def _open(self) -> tuple[str, ...]:
        """Sentence that names statically indeterminate reactions; () without any."""
        names = [reaction.name for reaction in self.found.open]
        if not names:
            return ()
        degree = self.found.structure.indeterminacy
        return (
            f"the structure is statically indeterminate, to the degree {degree}: the balance of rigid bodies "
            f"leaves {', '.join(names)} open; take a redundant constraint away, or let something give",
        )

    @cached_property
    def broken(self) -> tuple[str, ...]:
        """Violated conditions of contacts, in words: then the structure is not at rest like this."""
        margins = self._numbers([(c.broken, c.margin) for c in self.found.conditions])
        found = [words for words, margin in margins.items() if margin < -tolerances.COMPUTED]
        if not found and (excluded := self.found.excluded):
            found.append(f"no equilibrium has all of this: {', '.join(excluded)}")
        return tuple(found)

    @cached_property
    def sections(self) -> Sections:
        """N, V and M of every body that is a beam."""
        return sections_of(self.found)

    @cached_property
    def exact(self) -> dict[str, str | None]:
        """{reaction: its value as text}, None where it is statically indeterminate."""
        return {r.name: None if r.value is None else to_text(r.value) for r in self.found.reactions}

    @cached_property
    def values(self) -> dict[str, float]:
        """{reaction: its number} [N, N m], of those that have one."""
        sums = [(sum_name(self.found, each.combination), each.value) for each in self.found.sums]
        return self._numbers([(r.name, r.value) for r in self.found.reactions if r.value is not None] + sums)

    def _numbers(self, pairs: Sequence[tuple[str, Scalar]]) -> dict[str, float]:
        """The scalars in numbers, those whose parameters have values."""
        names, scalars = zip(*pairs, strict=True) if pairs else ((), ())
        found = shown_numbers(scalars, self.found.system.scope.known_exactly)
        return {name: x for name, x in zip(names, found, strict=True) if x is not None}

    def certify(self) -> Certificate:
        """Check the two ways, every body's balance, section forces from the other end, influence lines by loads."""
        reported = reported_sections(self.sections, self.derivation.steps, section_payload(self.sections))
        sections, works = self.sections.found, self._reported_works()
        return certify_structure(self.found, sections, self.influence, reported=reported, works=works)

    def _reported_works(self) -> Iterator[ReportedWork]:
        """Works of some reactions in the plane, evenly spread over all."""
        by_key = {step.key: step for step in self.derivation.steps}
        worked = [(r.name, r.work) for r in self.found.reactions if r.work is not None]
        for name, work in worked[:: 1 + len(worked) // MOST_REPORTED] if self.model.space == "plane" else ():
            reported = reported_work(name, by_key[f"work {name}"], _work(work))
            if reported is not None:
                yield reported

    def drawn_checks(self, panels: Sequence[DrawnPanel]) -> Iterable[Check]:
        """N, V, M and the influence line as they are drawn, from the other end and by unit loads; the arrows."""
        from eomgen.results.at_rest.pictures import picture_checks

        return picture_checks(self.found, self.sections, self.influence, panels) if panels else ()

    @cached_property
    def derivation(self) -> Document:
        """The solution, step by step."""
        contacts = (*contacts_step(self.found, self.broken), *ranges_step(self.found))
        influence = () if self.influence is None else (influence_step(self.influence),)
        return statics_derivation(self.found, self.values, (*contacts, *section_steps(self.sections), *influence))

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        structure = self.found.structure
        return {
            "name": self.model.name,
            "structure": {
                "velocities": len(structure.columns),
                "reactions": len(structure.rows),
                "rank": structure.rank,
                "mobility": structure.mobility,
                "indeterminacy": structure.indeterminacy,
                "count": self.found.count[0],
                "formula": self.found.count[1],
            },
            "reactions": {reaction.name: self._reaction(reaction.name) for reaction in self.found.reactions},
            "self_stresses": [
                {structure.names[j]: to_text(x) for j, x in stress.items()} for stress in structure.stresses
            ],
            "sums": {
                (name := sum_name(self.found, each.combination)): Quantity(
                    to_text(each.value), self.values.get(name), each.unit, "equilibrium"
                )
                for each in self.found.sums
            },
            "sections": section_payload(self.sections),
            "influence": None if self.influence is None else influence_payload(self.influence),
            "contacts": [
                {"tie": c.constraint, "kind": c.kind, "margin": to_text(c.margin)} for c in self.found.conditions
            ],
            "broken": list(self.broken),
            "rest_range": [vars(each) for each in self.found.ranges],
            "agree": self.ok,
        }

    def _reaction(self, name: str) -> Quantity:
        reaction = self.found.by_name[name]
        beside = {
            "by_equilibrium": _text(reaction.balanced),
            "work": None if reaction.work is None else _work(reaction.work),
            "agree": reaction.agree,
        }
        method = "equilibrium" if reaction.work is None else "virtual work"
        message = None if reaction.value is not None else "statically indeterminate"
        exact, value = self.exact[name], self.values.get(name)
        return Quantity(exact, value, reaction.unit, method, message, beside)

    @property
    def picture(self) -> Picture:
        """The structure with its loads and reactions, N, V and M."""
        from eomgen.results.at_rest.pictures import statics_picture

        return statics_picture(self.found, self.sections, self.influence)


def why_not_at_rest(model: Model, system: System) -> str:
    """Message if contacts of bodies without coordinates cannot hold them at rest; "" where they do.

    Raises:
        DerivationError: bodies can move.
    """
    if model.coordinates or not model.contacts:
        return ""
    return "; ".join(Statics(model, StaticReactions.of(system)).broken)


def _text(value: Scalar | None) -> str | None:
    return None if value is None else to_text(value)


def _work(equation: WorkEquation) -> dict[str, Any]:
    """The released mechanism, per unit of its scale, and the equation of virtual work: along * R + sum of terms = 0."""
    return {
        "mechanism": list(_blocks(equation)),
        "along": to_text(equation.along),
        "terms": [{"load": term.acting.name, "work": to_text(term.work)} for term in equation.terms],
        "value": to_text(equation.value),
    }


def _blocks(equation: WorkEquation) -> Iterator[dict[str, Any]]:
    """JSON entries of what moves as one: parts, spin, velocity at the origin; in the plane its centre too."""
    plan = equation.plan
    for block in plan.blocks:
        moved: dict[str, Any] = {
            "parts": list(block.parts),
            "rotation": [to_text(x) for x in block.spin],
            "shift_at_origin": [to_text(plan.simple(x)) for x in block.velocity],
        }
        if plan.system.scope.model.space == "plane":
            center = block.center(plan)
            found = {"center": center.place, "direction": center.direction}
            moved |= {key: v and [to_text(plan.simple(x)) for x in v[:2]] for key, v in found.items()}
        yield moved


@doing("the forces at rest")
def statics(
    model: ModelOrPath,
    *,
    reaction: str | None = None,
    influence: str | None = None,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Statics | Resting:
    """A structure at rest; of a system that is free to move, its equilibria.

    Args:
        influence: the reaction, member force or section force whose influence line is requested too.
        reaction: the only one that is found by virtual work too; None: all.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: no reaction of that name; one is requested by itself of a system that is free to move.
        DerivationError: bodies can move; a force acts at no place.
    """
    model = model_at(model, parameters, start)
    study = study_at_rest(model)
    if study.system.has_degrees_of_freedom:
        from eomgen.results.at_rest.result import Resting

        _refuse_for_resting(reaction=reaction, influence=influence)
        return Resting(model, Modes.decided(study.equilibria))
    held, _ = study.system.with_drives_held()  # what the model drives is held where it starts
    ContactsAtStart.refuse_open(held)
    found = StaticReactions.of(held, only=reaction)
    line = None if influence is None else InfluenceLine.of(found.structure, influence)
    return Statics(model, found, line)


def _refuse_for_resting(**requested: str | None) -> None:
    """Refuses options that only structures have.

    Raises:
        UsageError: it is named.
    """
    for name, value in requested.items():
        if value is not None:
            raise UsageError(
                f"--{name} is of structures that stand, and this system is free to move",
                fix="without it the equilibria are given",
            )


# -------- equilibrium result ----------------------------------------------------------------------------------
# Model -> Resting: where a system with degrees of freedom is at rest, as a user gets it: step by step, and for
# machines.


METHOD = "equilibrium"


@dataclass(frozen=True)
class Resting(Result):
    """The equilibria of a system with degrees of freedom.

    Args:
        model: the system.
        found: every place, the nearest to the start first.
    """

    model: Model
    found: Equilibria

    def __repr__(self) -> str:
        return f"<statics of {self.model.name!r}: {len(self.places)} equilibria>"

    @property
    def places(self) -> tuple[Equilibrium, ...]:
        return self.found.found

    @cached_property
    def reactions(self) -> RestingReactions | None:
        """Reactions at the first equilibrium; None without any equilibrium."""
        return RestingReactions.of(self.places[0]) if self.places else None

    def certify(self) -> Certificate:
        """Check the places by the balance of forces, and by the equations of motion: nothing is accelerated there."""
        return certify_equilibria(self.places)

    @cached_property
    def derivation(self) -> Document:
        """The way to them, step by step."""
        model = self.model
        steps = (data_step(self.found.statics.system), *equilibrium_steps(self.found, self.reactions))
        return document_of(model, METHOD, steps)

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        return {
            "name": self.model.name,
            "equilibria": [_place(place) for place in self.places],
            **(_reaction_entries(self.places[0], self.reactions) if self.reactions else {}),
            "complete": self.found.complete,
            "where": self.found.where,
            "indifferent": [q.name for q in self.found.indifferent],
            "chosen": [q.name for q in self.found.chosen],
            "held": list(self.found.statics.held),
        }

    @property
    def picture(self) -> Picture:
        """The system in each equilibrium.

        Raises:
            RunFailed: there is none; the system is in space; parameters have no values.
        """
        return resting_picture(self.places)


def _place(place: Equilibrium) -> dict[str, Any]:
    return {
        "coordinates": {q.name: _of(place, q) for q in place.statics.system.symbols.q},
        "states": {z.name: _of(place, z) for z in place.statics.system.symbols.z},
        "multipliers": {lam.name: _of(place, lam) for lam in place.statics.lam},
        "stability": _stability_entry(place),
        "pulling": list(place.pulling),
        "passed": list(place.passed),
        "family": _family(place),
    }


def _family(place: Equilibrium) -> dict[str, Any] | None:
    """The places of the curve that were met along it, by coordinate [SI]; None of a place by itself."""
    curve = place.curve
    if curve is None:
        return None
    columns = {q.name: curve.points[:, k].tolist() for k, q in enumerate(place.statics.q)}
    return {"closed": curve.closed, "places": columns}


def _reaction_entries(place: Equilibrium, those: RestingReactions) -> dict[str, Any]:
    """JSON entries of the reactions at the first equilibrium."""
    _, reactions, why = those
    numbers = shown_numbers([each.value for each in reactions], place.statics.system.scope.known_exactly)
    return {
        "reactions": {
            each.named.name: Quantity(
                to_text(each.value) if place.is_exact and each.value is not None else None,
                number,
                each.named.unit,
                "balance of the bodies at rest",
                None if each.value is not None else "statically indeterminate",
            )
            for each, number in zip(reactions, numbers, strict=True)
        },
        "message": why or None,
    }


def _of(place: Equilibrium, node: Node) -> Quantity:
    exact = to_text(place.exact[node]) if node in place.exact else None
    return Quantity(exact, place.numbers.get(node), unit=None)


def _stability_entry(place: Equilibrium) -> dict[str, Any]:
    stability = place.stability
    return {
        "kind": stability.kind,
        "why": stability.why,
        "along": [q.name for q in stability.along],
        "K": [[_entry(x) for x in row] for row in stability.K],
        "minors": [to_text(x) for x in stability.minors],
    }


def _entry(x: Scalar | float) -> str | float:
    return x if isinstance(x, float) else to_text(x)


MOST = 6  # places that are drawn
SIDE = 3.4  # of one panel [inches]


def resting_picture(places: Sequence[Equilibrium]) -> Picture:
    """The first equilibria of a plane system.

    Raises:
        RunFailed: there is none; the system is not plane; parameters have no values.
    """
    places = places[:MOST]
    if not places:
        raise RunFailed("there is no equilibrium to be drawn", fix="give a start near one")
    model = places[0].statics.system.scope.model
    if model.space != "plane":
        raise RunFailed("pictures of equilibria are drawn of plane systems", fix="take them by value: .places")
    if not all(place.numbers for place in places):
        raise RunFailed("a picture needs values of all parameters", fix="give them values in [parameters]")
    columns = math.ceil(math.sqrt(len(places)))
    rows = math.ceil(len(places) / columns)

    def fill(figure: Any) -> None:
        for k, place in enumerate(places, start=1):
            panel = figure.add_subplot(rows, columns, k)
            _sketch(place).draw(panel, names=k == 1)
            panel.set_title(f"{k}: {place.stability.kind}", fontsize=10)

    return Picture((SIDE * columns, SIDE * rows), fill, model.name)


def _sketch(place: Equilibrium) -> Sketch:
    symbols = place.statics.system.symbols
    plain = Sketch(place.statics.system, place.statics.system.scope.known_parameters)
    inputs = {node: plain.numbers((place.statics.given[node],))[0] for node in symbols.inputs.values()}
    still = dict.fromkeys((symbols.t, *symbols.u), 0.0)
    return Sketch(place.statics.system, {**plain.values, **inputs, **still, **place.numbers})


# -------- equilibrium steps -----------------------------------------------------------------------------------
# Equilibria -> the steps that lead to them: the balance at rest, the places, their stability, the reactions there.


REST = Law("Q_k = 0", "Q_{k} = 0")
REST_WITH_CONSTRAINTS = Law("Q_k + (J^T*lam)_k = 0", r"Q_{k} + \left(J^{\mathsf{T}} \lambda\right)_{k} = 0")
STIFFNESS = Law(
    "K = -Z^T*d(Q + J^T*lam)/dq*Z",
    r"K = -Z^{\mathsf{T}} \frac{\partial (Q + J^{\mathsf{T}} \lambda)}{\partial q} Z",
)
SECOND = Law("K = d2V/dq2", r"K = \frac{\partial^{2} V}{\partial q^{2}}")
ALONG = Law("J*Z = 0", r"J Z = 0")
MOST_SHOWN = 4  # coordinates of a K that is printed


def equilibrium_steps(found: Equilibria, reactions: RestingReactions | None) -> tuple[Step, ...]:
    """The balance at rest, every place, its stability, and the reactions at the nearest one."""
    scope = found.statics.system.scope
    reader = Reader(positive=scope.positive)
    steps: tuple[Step, ...] = (rest_balance_step(found, reader), _places(found))
    if reactions:
        steps = (*steps, _stability_step(found), *_reaction_steps(found.found[0], reactions))
    return reader.with_names(steps, scope)


def rest_balance_step(found: Equilibria, reader: Reader) -> Step:
    """Step with the equations by which the virtual work vanishes for every displacement."""
    statics, empty = found.statics, _nowhere(reader, found)
    if not statics.q:
        return Step("balance", "Balance at rest", empty or (prose("No force changes with the place."),))
    law = REST_WITH_CONSTRAINTS if statics.lam else REST
    words = "At rest the virtual work of all forces vanishes for every displacement"
    words += ", those of the constraints included: " if statics.lam else ": "
    rates_too = prose("The rates of the states of first order vanish with the forces.")
    held = [*([rates_too] if statics.system.symbols.z else []), *open_at_rest(statics.system)]
    if statics.held:
        held += [prose(f"Driven coordinates are held at their start: {', '.join(statics.held)}.")]
    forces = _all_forces(reader, found)
    own = len(statics.phi) - statics.norms
    constraints = [Formula((reader.shown(x), 0)) for x in statics.phi[:own]]
    constraints += [Formula((x + 1, 1)) for x in statics.phi[own:]]  # of quaternions, which are read with it
    between = [prose("The constraints hold the coordinates by")] if constraints else []
    rates = [Formula((reader.shown(x), 0)) for x in statics.sigma]
    still = [prose("The constraints of velocities leave, where no speed is,")] if rates else []
    lines = (*held, prose(words, law, "."), *forces, *between, *constraints, *still, *rates, *empty)
    return Step("balance", "Balance at rest", lines)


def _nowhere(reader: Reader, found: Equilibria) -> tuple[Statement, ...]:
    """The forces that the values of the parameters make vanish wherever the system is."""
    pairs = [(Name("Q", by=q), force) for q, force in found.statics.nowhere]
    if not pairs:
        return ()
    return (
        prose("The values of the parameters make vanish, wherever the system is:"),
        *page(reader, pairs, then=(0,)),
    )


def _all_forces(reader: Reader, found: Equilibria) -> tuple[Statement, ...]:
    """The equation along every coordinate; with constraints the multipliers stand in it next to Q."""
    statics = found.statics
    if not statics.lam:
        z = statics.system.symbols.z
        balance = zip(statics.q, statics.forces, strict=True)
        pairs = [(Rate(q) if q in z else Name("Q", by=q), force) for q, force in balance]
        others = tuple(Formula((reader.shown(x), 0)) for x in statics.beside)
        return (*page(reader, pairs, then=(0,)), *others)
    return tuple(Formula((reader.shown(x), 0)) for x in (*statics.forces, *statics.beside))


# -- the places ------------------------------------------------------------------------------------


def _places(found: Equilibria) -> Step:
    statements: list[Statement] = []
    if found.indifferent:
        symbols = found.indifferent
        stay = "it stays where it starts" if len(symbols) == 1 else "they stay where they start"
        statements.append(prose("No force holds ", *listed_symbols(symbols), f": {stay}."))
    if found.chosen:
        stay = "its start: it stays" if len(found.chosen) == 1 else "their start: they stay"
        any_ = "The velocity constraints let it rest at any "
        statements.append(prose(any_, *listed_symbols(found.chosen), f" near {stay} there."))
    if not found.found:
        statements.append(prose(_how_many(found)))
        return Step("places", "Equilibria", tuple(statements))
    rows = [row for k, place in enumerate(found.found, start=1) for row in _rows(k, place)]
    grid = narrow_grid(("place", "coordinate", "exact", "value", "unit", "stability"), rows)
    curves = [line for k, place in enumerate(found.found, start=1) for line in _curve(k, place)]
    passed = [_passed(k, name) for k, place in enumerate(found.found, start=1) for name in place.passed]
    return Step("places", "Equilibria", (*statements, prose(_how_many(found)), grid, *passed, *curves))


def _passed(number: int, name: str) -> Statement:
    return prose(f"But place {number} lies behind '{name}', which lets nothing pass: it does not hold.")


def _curve(number: int, place: Equilibrium) -> Iterator[Statement]:
    """Statement on a curve of equilibria: the coordinate that moves along it, those that follow, those that stay."""
    curve = place.curve
    if curve is None:
        return
    model, names = place.statics.system.scope.model, [q.name for q in place.statics.q]
    points = curve.points[:, : len(names)]
    moved = np.max(points, axis=0) - np.min(points, axis=0)
    first = int(np.flatnonzero(moved >= np.max(moved) / 2)[0])
    low, high = (model.in_own_unit(names[first], float(end(points[:, first])), 4) for end in (np.min, np.max))
    reported = [
        f"{names[first]} may be anything" if curve.closed else f"{names[first]} was followed from {low} to {high}"
    ]
    for k, name in enumerate(names):
        if k == first:
            continue
        if moved[k] <= tolerances.SAME_PLACE:
            reported.append(f"{name} = {model.in_own_unit(name, place.numbers.get(place.statics.q[k], 0.0), 9)} stays")
            continue
        offsets = {sign: points[:, k] - sign * points[:, first] for sign in (1, -1)}
        sign = next((s for s, x in offsets.items() if np.ptp(x) <= tolerances.SAME_PLACE), 0)
        away = model.in_own_unit(name, float(abs(offsets[sign or 1][0])), 9)
        plus = "+" if float(offsets[sign or 1][0]) >= 0 else "-"
        other = f"{'-' if sign < 0 else ''}{names[first]} {plus} {away}"
        reported.append(f"{name} = {other}" if sign else f"{name} follows it")
    yield prose(f"Place {number} is one of a curve of equilibria, a family: {', '.join(reported)}.")


def _how_many(found: Equilibria) -> str:
    where = f" ({found.where})" if found.where else ""
    if found.complete:
        return (
            f"There is {_places_in_words(len(found.found))}{where}."
            if len(found.found) == 1
            else (f"There are {_places_in_words(len(found.found))}{where}.")
        )
    many = _places_in_words(len(found.found))
    return f"Found: {many}{where}. That there are no others is not proved."


def _places_in_words(n: int) -> str:
    return "none" if n == 0 else count(n, "equilibrium", "equilibria")


def _rows(number: int, place: Equilibrium) -> list[tuple[Cell, ...]]:
    """A coordinate a row, in the unit that the file declares."""
    model = place.statics.system.scope.model
    units = {name: q.unit for name, q in model.coordinates.items()} | {n: z.unit for n, z in model.states.items()}
    rows: list[tuple[Cell, ...]] = []
    for k, q in enumerate(place.statics.system.symbols.places):
        exact: Cell = place.exact.get(q, "")
        unit = units.get(q.name)
        number_there = place.numbers.get(q)
        if number_there is not None and unit is not None:
            number_there = float(unit.from_si(number_there, math.pi))
        value = "" if number_there is None else f"{number_there:.9g}"
        shown = "" if unit is None or not value else unit.text
        rows.append((str(number) if k == 0 else "", q, exact, value, shown, place.stability.kind if k == 0 else ""))
    return rows


# -- stability -------------------------------------------------------------------------------------


def _stability_step(found: Equilibria) -> Step:
    constraints = bool(found.statics.lam)
    law: tuple[Piece, ...] = (STIFFNESS, ", ", ALONG) if constraints else (SECOND,)
    words = prose("The second variation of the potential energy decides: ", *law, ".")
    if found.statics.system.symbols.z:
        words = prose("The small motions of coordinates and states together decide, by their eigenvalues.")
    statements: list[Statement] = [words]
    for number, place in enumerate(found.found, start=1):
        statements += _verdict(number, place)
    return Step("stability", "Stability", tuple(statements))


def _verdict(number: int, place: Equilibrium) -> list[Statement]:
    stability = place.stability
    words: list[Statement] = [prose(f"Place {number}: {stability.kind}; {stability.why}.")]
    if not stability.K or len(stability.along) > MOST_SHOWN:
        return words
    symmetric = stability.kind != "no potential energy"
    entries: list[Statement] = []
    for i, row in enumerate(stability.along):
        for j, column in enumerate(stability.along):
            if j >= i or not symmetric:
                value = stability.K[i][j]
                shown: Scalar | Law = Law(f"{value:.7g}", f"{value:.7g}") if isinstance(value, float) else value
                entries.append(Formula((Entry("K", row, column), shown)))
    minors = [Formula((_leading(n), x)) for n, x in enumerate(stability.minors, start=1) if n > 1]
    return [*words, *entries, *minors]


def _leading(n: int) -> Law:
    return Law(f"det K_{n}", rf"\det K_{{{n}}}")


# -- the reactions ---------------------------------------------------------------------------------


def _reaction_steps(place: Equilibrium, those: RestingReactions) -> tuple[Step, ...]:
    reactions, found, why = those
    title = "Reactions at place 1"
    if reactions is None:
        return (Step("reactions", title, (prose(f"The reactions do not follow: {why}."),)),)
    if not found:
        return ()
    numbers = shown_numbers([each.value for each in found], place.statics.system.scope.known_exactly)
    rows: list[tuple[Cell, ...]] = []
    for reaction, number in zip(found, numbers, strict=True):
        named, value = reaction.named, reaction.value
        exact: Cell = "indeterminate" if value is None else value if place.is_exact else ""
        decimal = "" if number is None else f"{number:.7g}"
        rows.append((named.name, said(reactions.balance, named), exact, decimal, named.unit))
    grid = narrow_grid(("reaction", "meaning", "exact", "value", "unit"), rows)
    pulls = [prose(f"But '{name}' would have to pull there: it does not hold.") for name in place.pulling]
    return (Step("reactions", title, (prose("By the balance of every body:"), grid, *pulls)),)
