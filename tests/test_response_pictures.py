"""Bode's diagrams, roots over a parameter, phase portraits, forces of hinges: the curves are right, and drawn."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from slow_run import in_slow_run, sampled

import eomgen
from eomgen.cli import main
from eomgen.documents.figures import VIEWS, resultants
from eomgen.model.replaced import Range
from eomgen.results.small_motions.pictures import dashes
from eomgen.runs.single_run import one_turn

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"
TWO_MASSES = """
eomgen = 1
name = "two masses"
space = "plane"
parameters = { k = { value = 20, unit = "kN/m" }, c = 300 }
coordinates = { x = {}, y = {} }
inputs = { F = { value = 0, unit = "N" } }
[bodies.first]
shape = { kind = "particle", mass = 40 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", damping = "c" }
[bodies.second]
shape = { kind = "particle", mass = 15 }
joint = { kind = "prismatic", on = "first", axis = [1, 0], displacement = "y", stiffness = "2*k" }
[forces]
push = { kind = "force", point = "second.origin", force = ["F", 0] }
"""


def test_curves_that_are_one_take_turns():
    """Dashes side by side, so that each is seen; a curve of its own is solid"""
    x = np.linspace(1, 2, 5)
    one, alone, other = dashes([x, 2 * x, x * (1 + 1e-12)])
    assert alone == "-" and one == (0, (8.0, 8.0)) and other == (-8.0, (8.0, 8.0))


def test_roots_on_the_imaginary_axis_are_drawn_on_it():
    """Two undamped masses: real parts that are rounding are not spread over the picture"""
    from matplotlib.figure import Figure

    model = eomgen.load(MODELS / "two_mass_oscillator.toml")
    figure = Figure()
    eomgen.linearize(model).locus("k1=1:200:9").fill(figure)
    left, right = figure.axes[0].get_xlim()
    assert right - left > 1


@pytest.mark.parametrize("view", ["bode", "locus", "modes"])
def test_small_motions_that_are_drawn_otherwise_are_seen(tmp_path, view):
    """(s 1 - F, -E; K, s M + C)(q, u) = (0, B w) at what is drawn; det = 0 at roots of the values at the colours"""
    found = eomgen.linearize(eomgen.loads(TWO_MASSES))
    found = replace(found, drawn=view, over=Range.of(found.model, "k=20:30:3") if view == "locus" else None)
    panels = found.picture.saved(tmp_path / "a.svg")

    def states(changed):
        return {check.status for check in found.drawn_checks(changed)}

    assert states(panels) == {"holds"}
    for change in {
        "bode": (
            lambda p: [p[0], replace(p[1], curves=[replace(c, places=c.places * [1, -1]) for c in p[1].curves])],
            lambda p: [replace(p[0], curves=[replace(c, label=p[0].curves[0].label) for c in p[0].curves]), p[1]],
            lambda p: [replace(p[0], scales=("log", "linear")), p[1]],
        ),
        "locus": (
            lambda p: [replace(p[0], points=[replace(x, values=x.values * 1.1) for x in p[0].points])],
            lambda p: [replace(p[0], points=[replace(x, label="$k$ [N/m]") for x in p[0].points])],
            lambda p: [replace(p[0], points=[replace(x, places=x.places + 0.01) for x in p[0].points])],
        ),
        "modes": (lambda p: p[::-1], lambda p: p[1:], lambda p: [replace(x, title=f"{x.title}1") for x in p]),
    }[view]:
        assert states(change(panels)) == {"fails"}


def test_values_at_the_colours_are_in_their_unit(tmp_path):
    """alpha = 0.3 rad is 17.19 under [deg], from Python as from the command line"""
    found = eomgen.linearize(MODELS / "rolling_cone.toml")
    drawn = replace(found, drawn="locus", over=Range.of(found.model, "alpha=0.3:0.4:2", declared=False))
    (panel,) = drawn.picture.saved(tmp_path / "a.svg")
    assert sorted({*panel.points[0].values}) == pytest.approx(np.degrees([0.3, 0.4]))


@in_slow_run
def test_reactions_are_drawn_over_one_turn_of_the_drive(tmp_path):
    """phi = n t turns in 2 pi / n; at rates that change, or without a drive, there is no such time"""
    for name, turn in (("scotch_yoke", 2 * np.pi / 5), ("seeds/ch9_p6", None), ("four_bar", None)):
        found = one_turn(eomgen.derive(MODELS / f"{name}.toml").graph.system)
        assert found == (None if turn is None else pytest.approx(turn, rel=1e-12)), name
    path = tmp_path / "forces.svg"
    reported = CliRunner().invoke(
        main, ["reactions", str(MODELS / "four_bar.toml"), "--plot", str(path), "--time", "0.3"]
    )
    assert reported.exit_code == 0 and "crank [N]" in path.read_text()
    idle = CliRunner().invoke(main, ["reactions", str(MODELS / "four_bar.toml"), "--view", "polar"])
    assert idle.exit_code == 2 and "--plot" in idle.stderr


@pytest.fixture(scope="module")
def run() -> eomgen.Trajectory:
    return eomgen.simulate(MODELS / "four_bar.toml", time=0.3, samples=31)


def test_roots_over_a_parameter_are_those_of_the_model_with_it():
    """The weave and capsize of the bicycle at 3 and 6 m/s: the exact equations are those linearized anew"""
    found = eomgen.linearize(MODELS / "whipple_bicycle.toml")
    for v, roots in zip((3.0, 6.0), found.small.roots_over("v", (3.0, 6.0)), strict=True):
        anew = eomgen.linearize(MODELS / "whipple_bicycle.toml", parameters={"v": v})
        assert np.allclose(np.poly(roots), np.poly(anew.spectrum.eigenvalues), rtol=1e-9)


def test_a_parameter_takes_those_with_it_that_are_expressions_of_it():
    """k2 = k1/2: over k1 the roots are those of both, not of one alone"""
    text = (MODELS / "two_mass_oscillator.toml").read_text()
    lines = ['k2 = "k1/2"' if line.startswith("k2 =") else line for line in text.splitlines()]
    model = eomgen.loads("\n".join(lines))
    (roots,) = eomgen.linearize(model).small.roots_over("k1", (7.0,))
    both = eomgen.linearize(eomgen.loads(text), parameters={"k1": 7.0, "k2": 3.5})
    assert np.allclose(np.poly(roots), np.poly(both.spectrum.eigenvalues))


def test_the_resultant_of_a_hinge_is_the_length_of_its_force(run):
    """sqrt(F_x^2 + F_y^2)"""
    found = resultants(run)
    assert np.allclose(found["crank"], np.hypot(run["reaction_x(crank)"], run["reaction_y(crank)"]))


@sampled(2)
@pytest.mark.parametrize("view", VIEWS)
def test_every_view_of_a_run_is_drawn(run, view, tmp_path):
    path = tmp_path / "a.svg"
    picture = run.plot(path, view)
    assert path.read_text().count("<path") > 3 and picture._repr_png_().startswith(b"\x89PNG")


def test_a_view_of_nothing_is_refused_in_words(run):
    with pytest.raises(eomgen.UsageError, match="no view 'phases' of a run"):
        run.plot(view="phases")
    with pytest.raises(eomgen.RunFailed, match="without inputs there is no transfer function"):
        eomgen.linearize(MODELS / "double_pendulum.toml").bode()._repr_png_()


@pytest.mark.parametrize(
    ("text", "name", "first", "last", "count"),
    [("l1=1:3:5", "l1", 1, 3, 5), ("log:l1=1:100:3", "l1", 1, 100, 3), ("l1=0.5,2", "l1", 0.5, 2, 2)],
)
def test_a_range_has_its_ends(text, name, first, last, count):
    found = Range.of(eomgen.load(MODELS / "double_pendulum.toml"), text)
    assert (found.name, found.values[0], found.values[-1], len(found.values)) == (name, first, last, count)
    if text.startswith("log"):
        assert found.values[1] == pytest.approx(10)


@pytest.mark.parametrize("text", ["l1", "l1=1:2", "l1=1:2:1", "log:l1=0:2:5", "x=1:2:3", "l1=nan", "l1=1:inf:4", "l1="])
def test_what_is_no_range_is_refused(text):
    with pytest.raises(eomgen.UsageError) as caught:
        Range.of(eomgen.load(MODELS / "double_pendulum.toml"), text)
    assert caught.value.fix


def test_the_command_draws_them(tmp_path):
    """--view bode, --view locus --over RANGE; one without the other is a mistake"""
    cart = str(MODELS / "cart_pole.toml")
    for words in (["--view", "bode"], ["--view", "locus", "--over", "m=0.1:1:20"]):
        path = tmp_path / f"{words[1]}.png"
        result = CliRunner().invoke(main, ["linearize", cart, "--no-certify", "--plot", str(path), *words])
        assert result.exit_code == 0, result.stderr
        assert path.read_bytes().startswith(b"\x89PNG")
    for words in (["--view", "locus"], ["--over", "m=1:2:3"]):
        assert CliRunner().invoke(main, ["linearize", cart, *words]).exit_code == 2
