"""The page in which a model is alive, in a browser: its motion is a simulation's, and it asks nobody for anything."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest
from browser import visited
from click.testing import CliRunner
from each import each
from slow_run import sampled, usual
from tools import needs

import eomgen
from eomgen.cli import main
from eomgen.page.animation import Showing, player
from eomgen.page.playing import play
from eomgen.scene.frames_of_phases import phase_frames

pytestmark = [pytest.mark.slow, needs("chromium")]

MODELS = Path(__file__).parent.parent / "models"
GIVEN = {  # of each model: what is set in the page, and the same for a simulation
    "double_pendulum": {"m1": 3.0, "l2": 0.7, "theta1": 0.4},
    "four_bar": {"b": 1.1, "alpha": 1.3, "alpha'": 3.0},
    "cart_pole": {"M": 2.5, "x'": 0.5},
    "trifilar_pendulum": {"l": 1.0, "gamma'": 0.3},
    "tumbling_body": {},
}
END = 1.5


def page(name: str, **options) -> str:
    return play(MODELS / f"{name}.toml", time=END, **options).html


@sampled(2)
@pytest.mark.parametrize("name", usual([*GIVEN], 2))
def test_the_page_moves_as_a_simulation_says(name):
    """state(t) of the recorded run, then of one with other parameters and starts, equals eomgen.simulate's to 1e-6."""
    model, given = eomgen.load(MODELS / f"{name}.toml"), GIVEN[name]
    sets = "".join(f"eomgen.set({json.dumps(key)}, {value});" for key, value in given.items())
    script = f"""
        const first = eomgen.state({END});
        eomgen.seek({END / 2}); const scrubbed = [eomgen.t, eomgen.x];
        {sets}
        const second = [{END / 2}, {END}].map(t => eomgen.state(t));
        return {{ names: eomgen.names, first, scrubbed, second, check: document.body.dataset.selfcheck }};
    """
    seen = visited(page(name), script)
    assert seen.console == () and seen.requests == ()
    found = seen.found
    assert found["check"] == "ok"
    before = eomgen.simulate(model, time=END, samples=[0, END / 2, END])
    assert tuple(found["names"]) == before.coordinates + before.speeds
    assert found["first"] == pytest.approx(before.x[-1].tolist(), abs=1e-6, rel=1e-6)
    assert found["scrubbed"][0] == END / 2
    assert found["scrubbed"][1] == pytest.approx(before.x[1].tolist(), abs=1e-6, rel=1e-6)
    parameters = {key: value for key, value in given.items() if key in model.parameters}
    start = {key: value for key, value in given.items() if key not in model.parameters}
    after = eomgen.simulate(model, time=END, samples=[0, END / 2, END], parameters=parameters, start=start)
    assert np.array(found["second"]) == pytest.approx(after.x[1:], abs=1e-6, rel=1e-6)


def test_a_link_holds_what_was_set():
    """#m1=3&theta1=0.4: the page begins with them, and `set` writes them there."""
    text = page("double_pendulum")
    script = f"const there = eomgen.state({END}); eomgen.set('m2', 2); return [there, location.hash];"
    there, link = visited(text, script, fragment="#m1=3&theta1=0.4").found
    after = eomgen.simulate(MODELS / "double_pendulum.toml", time=END, parameters={"m1": 3}, start={"theta1": 0.4})
    assert there == pytest.approx(after.x[-1].tolist(), abs=1e-6)
    assert link == "#m1=3&theta1=0.4&m2=2"


def test_a_wrong_program_in_the_page_shows():
    """One sign of the right-hand side turned: data-selfcheck is "failed", and the page says so in red."""
    text = page("double_pendulum")
    turned = re.sub(r"(rate: [\s\S]*?const v\d+ = [^;]*?) - ", r"\1 + ", text, count=1)
    assert turned != text
    seen = visited(
        turned, "return [document.body.dataset.selfcheck, document.querySelector('[role=alert]').textContent];"
    )
    assert seen.found[0] == "failed" and "rate, vector 0" in seen.found[1]


def test_what_cannot_be_assembled_is_said():
    """A coupler that is too short closes no four-bar: the page says so, and goes on when it is long enough."""
    script = """
        const note = document.querySelector(".note"), said = [];
        for (const b of [0.05, 1.0]) { eomgen.set("b", b); said.push(note.hidden ? "" : note.textContent); }
        return said;
    """
    said = visited(page("four_bar"), script).found
    assert "cannot be closed" in said[0] and said[1] == ""


def test_contacts_that_change_play_the_recorded_run_and_the_sliders_rest():
    """state(t) is the trajectory's, every slider is disabled, and the page says why."""
    script = f"""
        let refused = "";
        try {{ eomgen.set("m", 2); }} catch (error) {{ refused = error.message; }}
        const sliders = [...document.querySelectorAll(".slider input")];
        const why = document.querySelector(".rests").textContent;
        return [eomgen.state({END}), sliders.length, sliders.every(s => s.disabled), why, refused];
    """
    seen = visited(page("sliding_ladder"), script)
    assert seen.console == ()
    state, sliders, resting, why, refused = seen.found
    right = eomgen.simulate(MODELS / "sliding_ladder.toml", time=END)
    assert state == pytest.approx(right.x[-1].tolist(), abs=1e-6)
    assert sliders and resting and "contacts" in why and why == refused


@pytest.mark.parametrize("name", ["four_bar", "flyball_governor"])
def test_a_narrow_screen_scrolls_down_alone_and_every_control_has_a_name(name):
    """At 360 px nothing is wider than the screen; each input, button and select is reached by Tab and labelled."""
    script = """
        await new Promise(done => setTimeout(done, 2500));  // three.js is unpacked beside the page
        const inner = document.querySelector("iframe").contentDocument;
        const controls = [...inner.querySelectorAll("button, input, select, summary")];
        const named = c => (c.getAttribute("aria-label") || c.closest("label")?.textContent || c.textContent).trim();
        return {
            wide: inner.documentElement.scrollWidth, screen: inner.documentElement.clientWidth,
            nameless: controls.filter(c => !named(c)).map(c => c.outerHTML),
            skipped: controls.filter(c => c.tabIndex < 0).length,
            drawn: inner.querySelectorAll(".stage canvas, .stage path").length,
        };
    """
    frame = f'<iframe style="width: 360px; height: 800px" srcdoc="{html.escape(page(name))}"></iframe>'
    found = visited(f"<!doctype html><body>{frame}</body>", script).found
    assert found["wide"] <= found["screen"] <= 360 and found["drawn"] > 0
    assert found["nameless"] == [] and found["skipped"] == 0


def contrast(one: str, other: str) -> float:
    """Of two colours, as WCAG 2.2 has it."""

    def light(colour: str) -> float:
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
        return 0.2126 * r + 0.7152 * g + 0.0722 * b

    a, b = sorted((light(one), light(other)))
    return (b + 0.05) / (a + 0.05)


def test_words_stand_out_from_their_ground_light_and_dark():
    """4.5 : 1 of every colour that text or a curve has, on both grounds."""
    text = (Path(eomgen.__file__).parent / "page" / "player" / "colours.css").read_text()
    blocks = [
        dict(re.findall(r"--([\w]+): (#[0-9a-f]{6})", block)) for block in re.findall(r"\{[^{}]*--paper[^{}]*\}", text)
    ]
    assert len(blocks) == 3 and blocks[1] == blocks[2]
    for colours in blocks:
        for name in ("ink", "soft", "link", "good", "bad", *(f"c{k}" for k in range(8))):
            for ground in ("paper", "card"):
                assert contrast(colours[name], colours[ground]) >= 4.5, (name, ground)


def test_a_strangers_text_is_text_in_a_page(tmp_path):
    """A model called </script><script>: the page runs, and shows the name."""
    name = "</script><script>window.stolen = 1</script> <b>&amp;"
    text = (MODELS / "simple_pendulum.toml").read_text()
    model = tmp_path / "m.toml"
    model.write_text(re.sub(r'^name = ".*"$', f"name = {json.dumps(name)}", text, flags=re.MULTILINE))
    script = (
        "return [document.body.dataset.selfcheck, window.stolen ?? null, document.querySelector('h1').textContent];"
    )
    assert visited(play(model, time=0.5).html, script).found == ["ok", None, name]


DRAG = """
    const stage = document.querySelector(".stage"), box = () => stage.getBoundingClientRect();
    await new Promise(done => setTimeout(done, 400));
    const point = (type, clientX, clientY, on = stage) =>
        on.dispatchEvent(new PointerEvent(type, { clientX, clientY, pointerId: 1, bubbles: true, cancelable: true }));
    const before = eomgen.state(0);
    %s
    for (let k = 1; k <= 8; k++) point("pointermove", x + k*dx/8, y + k*dy/8);
    point("pointerup", x + dx, y + dy);
    return { before, after: eomgen.state(0), names: eomgen.names, box: [box().width, box().height] };
"""
IN_THE_PLANE = """
    const body = document.querySelector('[data-frame="%d"].body');
    const { left, top, width, height } = body.getBoundingClientRect();
    const [x, y, dx, dy] = [left + width/2, top + height/2, %d, %d];
    point("pointerdown", x, y, body.firstChild);
"""
IN_SPACE = """
    const { left, top, width, height } = box();
    let x, y, taken = false;
    for (let i = 0; i < 400 && !taken; i++) {
        [x, y] = [left + width*(0.1 + 0.04*(i % 20)), top + height*(0.1 + 0.04*Math.floor(i/20))];
        taken = !point("pointerdown", x, y);
        if (!taken) point("pointerup", x, y);
    }
    if (!taken) throw new Error("no body is under any place of the picture");
    const [dx, dy] = [60, -25];
"""


@pytest.mark.parametrize(
    ("name", "taken"),
    usual(
        [
            ("double_pendulum", IN_THE_PLANE % (2, 40, -30)),
            ("four_bar", IN_THE_PLANE % (1, 30, -20)),  # a closed loop
            ("heavy_top", IN_SPACE),
            ("arm3", IN_SPACE),
        ],
        2,
    ),
)
def test_a_body_is_drawn_to_where_the_pointer_goes(name, taken):
    """The start is another then, one at which the constraints hold; the motion from there is a simulation's."""
    seen = visited(page(name), DRAG % taken)
    assert seen.console == ()
    found, model = seen.found, eomgen.load(MODELS / f"{name}.toml")
    before, after = (dict(zip(found["names"], found[key], strict=True)) for key in ("before", "after"))
    moved = {q: after[q] for q in model.coordinates if q in after}
    assert max(abs(after[q] - before[q]) for q in moved) > 0.02
    start = {q: x for q, x in moved.items() if not model.coordinates[q].dependent}
    run = eomgen.simulate(model, time=0.01, start=start)
    assert run.x[0, : len(run.coordinates)] == pytest.approx([after[q] for q in run.coordinates], abs=1e-6)


def test_names_are_shown_in_space():
    """Beside their bodies, on the screen, once they are asked for."""
    script = """
        const box = [...document.querySelectorAll("label")].find(each => each.textContent.includes("names")).firstChild;
        await new Promise(done => setTimeout(done, 400));
        const stage = document.querySelector(".stage").getBoundingClientRect();
        const shown = [...document.querySelectorAll(".word.label")];
        const seen = () => shown.filter(each => each.offsetParent !== null).map(each => {
            const { left, top } = each.getBoundingClientRect();
            const inside = left > stage.left && left < stage.right && top > stage.top - 20 && top < stage.bottom;
            return [each.textContent, inside];
        });
        const before = seen();
        box.click();
        return { before, after: seen() };
    """
    seen = visited(page("arm3"), script)
    assert seen.console == () and seen.found["before"] == []
    names = dict(seen.found["after"])
    assert set(names) >= set(eomgen.load(MODELS / "arm3.toml").bodies) and all(names.values())


def test_play_writes_its_page_and_proves_its_programs(tmp_path):
    """The certificate has the page's programs; the same bytes twice; a slider that makes no sense is refused."""
    path, model = tmp_path / "p.html", str(MODELS / "cart_pole.toml")
    words = ("play", model, "--time", "1", "--slider", "m=0.1:5", "--slider", "theta", "-o", str(path), "--json")
    done = CliRunner().invoke(main, words)
    payload = json.loads(done.stdout)
    assert done.exit_code == 0 and payload["sliders"] == ["m", "theta"] and payload["files"] == [str(path)]
    names = [check["name"] for check in payload["certificate"]["checks"]]
    assert sum("page's program" in name for name in names) == 2
    first = path.read_bytes()
    assert CliRunner().invoke(main, words).exit_code == 0 and path.read_bytes() == first
    for slider, words_ in (("mass=1:2", "no slider for 'mass'"), ("m=1", "write --slider"), ("m=5:1", "ends before")):
        wrong = CliRunner().invoke(main, ("play", model, "--slider", slider, "-o", str(path)))
        assert wrong.exit_code == 2 and words_ in wrong.stderr


@each("name", ["loop_the_loop", "sliding_ladder"])
def test_each_phase_is_drawn_by_its_own_coordinates(name):
    """A body's place goes on from phase to phase: between neighbouring pictures it makes no leap."""
    run = eomgen.simulate(MODELS / f"{name}.toml", time=3 if name == "loop_the_loop" else 2, samples=801)
    numbers = phase_frames(run, run.t)
    reported, frames = numbers.scene.to_json(), numbers.frames
    assert len(run.phases) > 1
    pose = next(frame["pose"] for frame in reported["frames"] if frame["name"])
    places = np.column_stack([frames[:, v[0]] if isinstance(v, list) else np.full(len(frames), v) for v in pose[:2]])
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert np.isfinite(steps).all() and steps.max() < 0.2


def test_a_page_in_the_plane_goes_with_what_goes_far():
    """A cart at 20 m/s for 4 s: the machine fills the picture all the time, its middle stays in the middle."""
    run = eomgen.simulate(MODELS / "cart_pole.toml", time=4, start={"x'": 20.0})
    script = """
        const svg = document.querySelector("svg.stage"), stage = svg.getBoundingClientRect();
        return [0, 2, 4].map(t => {
            eomgen.seek(t);
            const boxes = [...svg.querySelectorAll("g.mark.body")].map(g => g.getBoundingClientRect());
            const left = Math.min(...boxes.map(b => b.left)), right = Math.max(...boxes.map(b => b.right));
            const tall = Math.max(...boxes.map(b => b.bottom)) - Math.min(...boxes.map(b => b.top));
            return [(left - stage.left)/stage.width, (right - stage.left)/stage.width, tall/stage.height];
        });
    """
    seen = visited(player(run, Showing()), script)
    assert seen.console == ()
    for left, right, tall in seen.found:
        assert 0 < left < right < 1 and tall > 0.2


def test_a_belt_lies_on_the_far_sides_of_its_pulleys_and_a_cylinder_keeps_its_length():
    """The box of all strings is that of both rims, from -r to a + R; the barrel is as long at both ends of a motion."""
    text = """eomgen = 1
space = "plane"
coordinates = { phi = { start = 0, speed = 1 }, s = { start = 1, speed = 0.4 } }
[bodies.small]
shape = { kind = "disc", mass = 1, radius = 0.1 }
joint = { kind = "revolute", angle = "phi", torque = 0.1 }
[bodies.large]
shape = { kind = "disc", mass = 4, radius = 0.3 }
joint = { kind = "revolute", at = [1, 0], angle = "phi/3" }
[bodies.arm]
mass = 1
inertia = 0.1
center = [0.2, 0]
joint = { kind = "revolute", at = [0, 1], angle = "0.2*phi" }
[bodies.rod]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", on = "arm", axis = [1, 0], displacement = "s", force = 0.1 }
[constraints.belt]
kind = "gear"
bodies = ["small", "large"]
ratio = 3
"""
    run = eomgen.simulate(eomgen.loads(text), time=1)
    script = """
        const svg = document.querySelector("svg.stage"), box = css => {
            const all = [...svg.querySelectorAll(css)].map(g => g.getBoundingClientRect());
            return [Math.min(...all.map(b => b.left)), Math.max(...all.map(b => b.right))];
        };
        const ends = d => d.match(/[-\\d.]+ [-\\d.]+/g).map(p => p.split(" ").map(Number));
        return [0, 1].map(t => {
            eomgen.seek(t);
            const d = svg.querySelector("g.mark.cylinder path").getAttribute("d").split("M")[2], [a, b] = ends(d);
            return [box("g.mark.string"), box("g.mark.body.arc"), Math.hypot(a[0] - b[0], a[1] - b[1])];
        });
    """
    seen = visited(player(run, Showing()), script)
    assert seen.console == ()
    (strings, rims, first), (_, _, last) = seen.found
    assert strings == pytest.approx(rims, abs=2)
    assert first == pytest.approx(last, rel=0.02)
