"""A result that shares its parts is never written out as a tree."""

from __future__ import annotations

import pytest

import eomgen
from eomgen.symbolic.expression.formula import cos, sin
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.print.text import LONGEST_RESULT, readable_text, text_size, to_text

BODY = """
[bodies.b{k}]
mass = {m}
center = [0.02, 0.0{k}, 0.1]
inertia = [0.031, 0.027, 0.019, 0.0021, -0.0013, 0.0017]
points = {{ E = [0.05, 0.0{k}, 0.31] }}
joint = {{ kind = "revolute", axis = [0.{k}, 1, 0.3], angle = "q{k}"{on} }}
"""


def chain(n):
    """n bodies with full inertias about skew axes."""
    text = "eomgen = 1\nspace = 'space'\n[coordinates]\n" + "".join(f"q{k} = 0.{k}\n" for k in range(1, n + 1))
    bodies = (BODY.format(k=k, m=3 - k / 4, on=f', on = "b{k - 1}.E"' if k > 1 else "") for k in range(1, n + 1))
    return eomgen.loads(text + "".join(bodies))


@pytest.mark.slow
def test_inertia_of_many_bodies_is_a_number_where_its_formula_is_beyond_reading():
    """One 3 x 3 tensor of five bodies at the start; of its entries none is written with millions of characters."""
    found = eomgen.inertia(chain(5)).results
    together = {name: value for name, value in found.items() if not any(f"b{k}" in name for k in range(1, 6))}
    assert any(value.exact is None for value in together.values())
    for value in found.values():
        assert value.exact is None or len(value.exact) <= LONGEST_RESULT
        assert value.value is not None


@pytest.mark.parametrize("depth", [3, 10, 60])
def test_a_text_is_written_only_where_it_is_short(depth):
    """sin(y) cos(y) of itself, again and again: the graph grows by three nodes, the text doubles."""
    y = Graph().symbol("x")
    for _ in range(depth):
        y = sin(y) * cos(y) + 1
    text = readable_text(y)
    assert (text is None) == (text_size(y) > LONGEST_RESULT)
    assert text is None or text == to_text(y)
    assert (text is None) == (depth > 5)


@pytest.mark.slow
def test_what_has_no_number_and_is_longer_than_a_reader_takes_stands_on_the_page_by_its_size():
    """Two bodies at angles without values: a table of their moments as formulas was thousands of characters wide."""
    text = "eomgen = 1\nspace = 'space'\n[parameters]\na1 = {}\na2 = {}\n[coordinates]\n"
    text += "q1 = { start = 'a1' }\nq2 = { start = 'a2' }\n"
    bodies = (BODY.format(k=k, m=3 - k / 4, on=f', on = "b{k - 1}.E"' if k > 1 else "") for k in (1, 2))
    page = eomgen.inertia(eomgen.loads(text + "".join(bodies))).render("text")
    assert " operations, not printed)" in page
    assert max(map(len, page.splitlines())) < 1000
