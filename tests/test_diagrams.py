"""Diagrams: what is drawn are the section forces and the influence line, with their values written beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import eomgen
from eomgen.documents.drawing import NamesArtist
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.reactions import Reactions
from eomgen.mechanics.free_bodies.structure import Structure
from eomgen.mechanics.statics.forces_in_sections import SectionForces
from eomgen.mechanics.statics.influence import InfluenceLine
from eomgen.proof.drawn import structure_drawn
from eomgen.results.at_rest.pictures import diagram_panels, influence_panel, pushes_on

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
    system = System.of(eomgen.loads(BEAM))
    panels = Figure().subplots(3)
    diagram_panels(panels, SectionForces.of(Reactions.of(system), "beam"), {})
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
    influence_panel(panel, InfluenceLine.of(Structure.of(System.of(eomgen.loads(BEAM))), "reaction_n(B)"), {})
    points = curves(panel)
    assert points[points[:, 1].argmax()] == pytest.approx([6, 1.5])
    assert np.interp(4, points[1:-1, 0], points[1:-1, 1]) == pytest.approx(1)
    assert written(panel) == {"1.5"}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """(statics with an influence line, its panels as they were saved)"""
    found = eomgen.statics(eomgen.loads(BEAM), influence="bending_moment(beam, 2)")
    return found, found.picture.saved(tmp_path_factory.mktemp("drawn") / "beam.svg")


def states(drawn, changed=lambda panel: panel):
    found, panels = drawn
    checks = found.drawn_checks([changed(panel) for panel in panels])
    return {check.status for check in checks if check.name.startswith("drawn")}


def test_diagrams_that_are_read_again_are_the_forces_from_the_other_end(drawn):
    """N = R . t, V = -R . n, M = T at every place of the curves; unit loads along the influence line"""
    assert states(drawn) == {"holds"}


@pytest.mark.parametrize("of", ["M of beam", "V of beam", "bending_moment(beam, 2)"])
def test_a_diagram_that_shows_another_thing_is_seen(drawn, of):
    """A curve that is turned over, or elsewhere, or in another unit; a number that is another, or missing"""

    def with_curves(panel, of_places):
        return replace(panel, curves=tuple(replace(c, places=of_places(c.places)) for c in panel.curves))

    def only(change):
        return lambda panel: change(panel) if panel.y.startswith(of) else panel

    for change in (
        lambda panel: with_curves(panel, lambda xy: xy * [1, -1]),
        lambda panel: with_curves(panel, lambda xy: xy * [0.9, 1]),
        lambda panel: replace(panel, is_turned=not panel.is_turned),
        lambda panel: replace(panel, names=panel.names[1:]),
        lambda panel: replace(panel, names=tuple((f"{text}1", place) for text, place in panel.names)),
        lambda panel: replace(panel, y=panel.y.replace("[N", "[kN")) if "[" in panel.y else replace(panel, hidden=True),
    ):
        assert states(drawn, only(change)) == {"fails"}


def test_a_way_from_truss_to_truss_names_both_nodes():
    """The line of reactions over two trusses that stand on one another is what unit loads give"""
    nodes = "nodes = { n1 = [0, 0], n2 = [2, 0], n3 = [1, 1] }"
    truss = f'{nodes}\nmembers = ["n1-n2", "n2-n3", "n1-n3"]\n'
    held = "".join(
        f'{t}1 = {{ kind = "pin", points = ["{t}.n1"] }}\n'
        f'{t}2 = {{ kind = "support", point = "{t}.n2", normal = [0, 1] }}\n'
        for t in "TU"
    )
    text = f'eomgen = 1\nname = "two"\nspace = "plane"\n[trusses.T]\n{truss}[trusses.U]\n{truss}[constraints]\n{held}'
    found = eomgen.statics(eomgen.loads(text), influence="reaction_n(T2)")
    assert found.certify().ok
    assert "T.n1-U.n1" in [span.name for span in found.influence.spans]


def laid_out(found) -> Figure:
    """The figure of a result, drawn."""
    figure = Figure(figsize=found.picture.size)
    FigureCanvasAgg(figure)
    found.picture.fill(figure)
    figure.canvas.draw()
    return figure


def named(panel) -> set[str]:
    """Names beside places that found room."""
    return {text for artist in panel.artists if isinstance(artist, NamesArtist) for text, _ in artist.areas}


GERBER = BEAM.replace(
    "[constraints]",
    "[bodies.more]\npoints = { E = [6, 0], G = [9, 0] }\n[constraints]\n"
    'E = { kind = "pin", points = ["beam.tip", "more.E"] }\n'
    'G = { kind = "support", point = "more.G", normal = [0, 1] }',
)


@pytest.mark.parametrize("text, ends", [(BEAM, [(0, 6)]), (GERBER, [(0, 6), (6, 9)])])
def test_the_diagrams_of_beams_in_a_row_stand_below_them(text, ends):
    """Each panel of N, V, M begins and ends where its beam does on the page, and all of one kind have one scale."""
    figure = laid_out(eomgen.statics(eomgen.loads(text)))
    main, *panels = figure.axes
    for number, (start, end) in enumerate(ends):
        for panel in panels[3 * number : 3 * number + 3]:
            left, right = (main.transData.transform((x, 0))[0] for x in (start, end))
            box = panel.get_window_extent()
            assert (box.x0, box.x1) == pytest.approx((left, right), abs=0.5)
    assert len({panel.get_ylim() for panel in panels[2::3]}) == 1


def test_letters_alone_have_their_diagrams_with_formulas_and_the_stated_ratio():
    """M(l/2) = q l^2/8 of a beam on two supports, drawn with l = q = 1; each reaction is named, a zero one too."""
    text = """
eomgen = 1
space = "plane"
[parameters]
l = { unit = "m", positive = true }
q = { unit = "N/m", positive = true }
[bodies.beam]
points = { A = [0, 0], B = ["l", 0] }
[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "support", point = "beam.B", normal = [0, 1] }
[forces]
load = { kind = "distributed", body = "beam", between = ["A", "B"], intensity = [0, "-q"] }
"""
    figure = laid_out(eomgen.statics(eomgen.loads(text)))
    main, N, V, M = figure.axes
    assert "drawn with l, q = 1" in [each.get_text() for each in figure.texts]
    assert {r"$A_{x} = \mathregular{0}$"} <= named(main)
    assert len([text for text in named(main) if text.startswith("$A_{y} = ")]) == 1
    assert len(named(M)) == 1 and "8" in named(M).pop()
    places = np.column_stack(M.lines[1].get_data())
    assert places[:, 1].max() == pytest.approx(1 / 8, rel=1e-2)
    assert len(named(V)) == 2 and not named(N)


def test_what_is_drawn_on_a_structure_holds_it_at_rest_by_the_numbers_beside_it(drawn):
    """sum F = 0, sum r x F + C = 0 of arrows, couples and line loads; one turned, moved or misnamed is seen"""
    pushes = list(pushes_on(drawn[0].found))
    assert [check.status for check in structure_drawn(pushes)] == ["holds"]
    load = next(k for k, push in enumerate(pushes) if push.words.startswith("F = 1"))
    for change in (
        {"way": -pushes[load].way},
        {"at": pushes[load].at + np.array([0.1, 0.0, 0.0])},
        {"words": "F = 2 N"},
    ):
        wrong = [*pushes[:load], replace(pushes[load], **change), *pushes[load + 1 :]]
        assert [check.status for check in structure_drawn(wrong)] == ["fails"]


BRACKET = """
eomgen = 1
name = "bracket"
space = "space"
[bodies.bracket]
points = { A = [0, 0, 0], B = [2, 0, 0], C = [2, 1.5, 0] }
[constraints.A]
kind = "clamp"
points = ["bracket.A"]
[forces.F]
kind = "force"
point = "bracket.C"
force = [0, 0, -800]
[forces.q]
kind = "distributed"
body = "bracket"
between = ["A", "B"]
intensity = [0, 200, 0]
"""


@pytest.fixture(scope="module")
def bracket(tmp_path_factory):
    """(statics of a bent bracket in space, its panels as they were saved)"""
    found = eomgen.statics(eomgen.loads(BRACKET))
    return found, found.picture.saved(tmp_path_factory.mktemp("drawn") / "bracket.svg")


def test_a_structure_in_space_has_its_reactions_and_the_section_forces_of_its_beams(bracket):
    """A = (0, -400, 800) N; along AB V = (400 .. 0, -800), T = -800 * 1.5, M_y = 800 * 2 .. 0, M_z = 200 * 2 .. 0"""
    found, panels = bracket
    drawn = {panel.y: panel for panel in panels}
    due = {"V_y, V_z": ((400, 0), (-800, -800)), "T": ((-1200, -1200),), "M_y, M_z": ((1600, 0), (400, 0))}
    for kinds, ends in due.items():
        panel = next(panel for words, panel in drawn.items() if words.startswith(f"{kinds} of bracket ["))
        along_ab = panel.curves[::2]
        assert [tuple(curve.places[[1, -2], 1]) for curve in along_ab] == [pytest.approx(e, abs=1e-9) for e in ends]
    words = {push.words for push in pushes_on(found.found)}
    assert r"$A_{x} = \mathregular{0}$" in named(laid_out(found).axes[0])
    assert {"reaction_y(A) = 400 N", "reaction_z(A) = 800 N", "F = 800 N", "q = 200 N/m"} <= words
    assert {"reaction_couple_x(A) = 1200 N m", "reaction_couple_y(A) = 1600 N m"} <= words
    assert {check.status for check in found.drawn_checks(panels)} == {"holds"}


def test_a_diagram_in_space_that_shows_another_thing_is_seen(bracket):
    """A curve turned over, in another unit, the two of a panel exchanged, another number beside one"""

    def turned(panel):
        return replace(panel, curves=tuple(replace(c, places=c.places * [1, -1]) for c in panel.curves))

    changes = (
        turned,
        lambda panel: replace(panel, y=panel.y.replace("[N", "[kN")),
        lambda panel: replace(panel, curves=(*panel.curves[2:], *panel.curves[:2])),
        lambda panel: replace(panel, names=tuple((f"{text}1", place) for text, place in panel.names)),
    )
    found, panels = bracket
    for change in changes:
        shown = [change(panel) if panel.y.startswith("M_y") else panel for panel in panels]
        assert "fails" in {check.status for check in found.drawn_checks(shown)}


def test_the_report_of_a_structure_in_space_has_its_picture():
    """Below the model as it stands: loads, reactions and the diagrams of its beams."""
    found = eomgen.report(eomgen.loads(BRACKET), certify=False, without=["downloads"])
    captions = {section.key: [each.caption for each in section.drawings] for section in found.sections}
    assert len(captions["figure"]) == 1 and captions["statics"][0].startswith("Loads and reactions")
