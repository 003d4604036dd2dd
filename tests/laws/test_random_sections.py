"""N, V, M and influence lines of random frames: what all that acts before a section says, in floats."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from random_frames import stiff_frame

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.structure import Structure
from eomgen.mechanics.statics.forces_in_sections import SectionForces
from eomgen.mechanics.statics.influence import InfluenceLine
from eomgen.mechanics.statics.virtual_work import StaticReactions
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

FRAMES = [(1, 1), (2, 1), (3, 2), (4, 2), (5, 3), (6, 3), (7, 4), (8, 4)]


def numbers(system, *scalars) -> list[float]:
    ones = dict.fromkeys(system.symbols.parameters.values(), 1.0)
    return [float(x) for x in evaluate(scalars, ones, FLOAT)]


def between(rng: Random, length: int) -> Fraction:
    """A place along a member at which nothing acts."""
    return rng.randrange(length) + Fraction(rng.randint(1, 16), 17)


@pytest.mark.parametrize(("seed", "members"), FRAMES)
def test_a_section_carries_what_acts_before_it(seed, members):
    """N = -F_t, V = F_n, M = sum of F_n (x - s) - couples, at two random places of every member."""
    frame, rng = stiff_frame(seed, members), Random(seed)
    system = System.of(eomgen.loads(frame.text))
    found = StaticReactions.of(system)
    assert not found.disagreeing
    a = system.scope.names["a"]
    for i, length in enumerate(frame.length):
        forces = SectionForces.of(found.balance, f"m{i}")
        for _ in range(2):
            x = between(rng, length)
            values = numbers(system, *(forces.value(kind, x * a) for kind in SectionForces.KINDS))
            assert values == pytest.approx(frame.section(i, float(x)), abs=1e-8), (frame.text, i, x)


@pytest.mark.parametrize(("seed", "members"), FRAMES[2:])
def test_an_influence_line_is_the_force_under_a_load_of_1_at_any_place(seed, members):
    """N, V or M at a section of one member, the load anywhere on any other or on the same one."""
    frame, rng = stiff_frame(seed, members), Random(seed)
    system = System.of(eomgen.loads(frame.text))
    structure = Structure.of(system)
    kind, i = rng.choice(SectionForces.KINDS), rng.randrange(members)
    x = between(rng, frame.length[i])
    way = ", ".join(f"m{j}" for j in range(members))
    spans = InfluenceLine.of(structure, f"{kind}(m{i}, {x}*a): {way}").spans
    assert {span.name for span in spans} == {f"m{j}" for j in range(members)}
    for span in spans:
        share, j = Fraction(rng.randint(1, 9), 10), int(span.name[1:])
        value, *ends = numbers(system, span.at_start + share * (span.at_end - span.at_start), *span.start, *span.end)
        along, _ = frame.axes(j)
        s = sum(
            (p + float(share) * (q - p) - o) * t
            for p, q, o, t in zip(ends[:3], ends[3:], (*frame.place(j, 0), 0.0), along, strict=True)
        )
        expected = frame.under_unit_load(j, s).section(i, float(x))[SectionForces.KINDS.index(kind)]
        assert value == pytest.approx(expected, abs=1e-8), (frame.text, kind, i, x, span.name, s)
