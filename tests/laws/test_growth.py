"""What grows with a system grows no faster than it must: counted in nodes and calls, never in time."""

from __future__ import annotations

import runpy
from dataclasses import replace
from random import Random
from typing import Any

import pytest
from known_answers import MODELS

import eomgen
from eomgen.documents.equation_steps import simple_constants
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.free_bodies import velocity_plan as blocks
from eomgen.mechanics.free_bodies.structure import Structure
from eomgen.mechanics.linearization.reference import FirstOrder
from eomgen.mechanics.statics.virtual_work import by_virtual_work, requested_reactions
from eomgen.symbolic.exact.equality import real_values
from eomgen.symbolic.expression.derivatives import order, substituted
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.evaluation import fifty_digits

chain = runpy.run_path(str(MODELS / "chain.py"))["chain"]


def at_rest(model: eomgen.Model) -> FirstOrder:
    return replace(FirstOrder.of(System.of(model)), at_rest=True)


def nodes_of(rows: Any) -> int:
    return len(order([x for row in rows for x in row]))


def test_stiffness_of_a_hanging_chain_grows_with_its_links() -> None:
    """At rest R_q is d/dq of the forces alone, which share their sums: about 13 nodes a link, not n^2 of M_q a."""
    short, long = (nodes_of(at_rest(eomgen.loads(chain(n))).derivatives["R_q"]) for n in (12, 24))
    assert long < 2.5 * short


def test_forces_at_rest_of_a_long_chain_are_not_written_out() -> None:
    """n forces of n terms, each of n angles: they stay as they came, a few nodes a link."""
    n = 40
    assert nodes_of([StaticEquations.of(System.of(eomgen.loads(chain(n)))).equations]) < 20 * n


@pytest.mark.parametrize("name", ["four_bar", "cart_pole", "slider_crank", "spatial_four_bar", "gimbal_gyroscope"])
def test_derivatives_at_rest_are_those_of_motions_without_speeds(name: str) -> None:
    """d/dq of equations with u = 0 (and a = 0, where gamma = 0) is d/dq of the equations, then u = 0."""
    still = at_rest(eomgen.load(MODELS / f"{name}.toml"))
    moving, s = replace(still, at_rest=False), still.system.symbols
    zeros = dict.fromkeys((*s.u, *s.a), 0)
    for letter in ("R_q", "R_u", "S_q", "V_q", "A_q", "A_u"):
        pairs = [
            x
            for rows in zip(moving.derivatives[letter], still.derivatives[letter], strict=True)
            for pair in zip(*rows, strict=True)
            for x in substituted(pair, zeros)
        ]
        values = real_values(pairs, Random(5), fifty_digits()) if pairs else []
        assert all(abs(x - y) < 1e-30 * (1 + abs(y)) for x, y in zip(values[::2], values[1::2], strict=True)), letter


def test_members_have_closed_forms_only_where_they_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """A released truss moves as a few blocks: one closed form for each, and one for its scale, not one a member."""
    requested: list[tuple[str, str]] = []
    right = blocks._of_ends
    monkeypatch.setattr(blocks, "_of_ends", lambda plan, ends: requested.append(ends) or right(plan, ends))
    structure = Structure.of(System.of(eomgen.load(MODELS / "k_truss.toml")))
    for named in requested_reactions(structure).values():
        requested.clear()
        work = by_virtual_work(structure, named)
        assert work is not None and len(requested) <= 1, named.name
        reported = work.plan.blocks
        assert len(requested) <= len(reported) + 1 < len(structure.system.scope.model.truss_members) / 2


def test_constants_are_made_of_parameters_alone() -> None:
    """(2 A + C)/2 - A is C/2; what holds a coordinate is no constant."""
    g = Graph()
    A, C, q = (g.symbol(x) for x in ("A", "C", "q"))
    constant = (2 * A + C) / 2 - A
    assert simple_constants([constant * g.call("sin", q) + q], (A, C)) == {constant: C / 2}
