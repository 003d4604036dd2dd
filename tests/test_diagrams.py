"""Diagrams: what is drawn are the section forces and the influence line, with their values written beside them."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

import eomgen
from eomgen.documents.letters_artist import NamesArtist
from eomgen.documents.statics.diagrams import diagram_panels, influence_panel
from eomgen.mechanics.equations.system import system_of
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.mechanics.statics.influence import influence_line
from eomgen.mechanics.statics.section_forces import section_forces
from eomgen.mechanics.structures.structure import structure_of

BEAM = """
eomgen = 1
name = "beam"
space = "plane"
[bodies.beam]
points = { A = [0, 0], B = [4, 0], tip = [6, 0] }
[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "support", point = "beam.B", normal = [0, 1] }
[forces]
q = { kind = "distributed", body = "beam", between = ["A", "B"], intensity = [0, -2] }
F = { kind = "force", point = "beam.tip", force = [0, -1] }
"""


def curves(panel) -> np.ndarray:
    """Every point of the curves: two columns; the line of zeros left out."""
    return np.vstack([np.column_stack(line.get_data()) for line in panel.lines[1:]])


def written(panel) -> set[str]:
    return {name.text for artist in panel.artists if isinstance(artist, NamesArtist) for name in artist.names}


def test_the_diagrams_show_the_section_forces_and_write_their_corners():
    """V: 7/2 to -9/2, then 1; M: 49/16 at x = 7/4 where V = 0, -2 over the roller, drawn downward where positive."""
    system = system_of(eomgen.loads(BEAM))
    panels = Figure().subplots(3)
    diagram_panels(panels, section_forces(reactions_of(system), "beam"), {})
    N, V, M = (curves(panel) for panel in panels)
    assert not N[:, 1].any() and written(panels[0]) == set()
    assert (V[:, 1].max(), V[:, 1].min()) == pytest.approx((3.5, -4.5))
    assert M[:, 1].max() == pytest.approx(49 / 16, rel=1e-3) and M[:, 1].min() == pytest.approx(-2)
    assert M[M[:, 1].argmax(), 0] == pytest.approx(7 / 4, abs=0.06) and M[M[:, 1].argmin(), 0] == pytest.approx(4)
    assert written(panels[1]) == {"3.5", "-4.5", "1"} and written(panels[2]) == {"3.062", "-2"}
    assert panels[2].yaxis_inverted() and not panels[1].yaxis_inverted()


def test_an_influence_line_is_drawn_over_the_way_of_the_load():
    """The force of the roller: 0 at A, 1 at B, 3/2 at the tip."""
    panel = Figure().subplots()
    influence_panel(panel, influence_line(structure_of(system_of(eomgen.loads(BEAM))), "reaction_n(B)"), {})
    points = curves(panel)
    assert points[points[:, 1].argmax()] == pytest.approx([6, 1.5])
    assert np.interp(4, points[1:-1, 0], points[1:-1, 1]) == pytest.approx(1)
    assert written(panel) == {"1.5"}
