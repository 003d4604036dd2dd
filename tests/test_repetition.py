"""What repeats in a model file stands for what one would write out; parts of other files are like one's own."""

from __future__ import annotations

import math
import pickle
import time
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each
from slow_run import usual

import eomgen
from eomgen.cli import main
from eomgen.model import model_at

MODELS = Path(__file__).parent.parent / "models"

CHAIN = """
eomgen = 1
name = "Chain"
space = "plane"
repeat = { i = "n" }
points = { O = [0, 0] }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }

[parameters]
n = 3
m = { value = 1, unit = "kg" }
l = { value = 50, unit = "cm" }

[coordinates]
"q{i}" = { start = "10*{i}", unit = "deg" }

[bodies."rod{i}"]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = ["rod{i-1}.end", "O"], angle = "q{i}", symbol = 'A_{i}' }
"""

FOUR_BARS = """
eomgen = 1
name = "Row of four-bars on one shaft"
space = "plane"
repeat = { i = 4, k = [2, 4] }
parameters = { m = 1, a = 1, b = 3 }
coordinates = { phi = 1, "r{i}" = { dependent = true, near = -0.4 }, "s{i}" = { dependent = true, near = 1.4 } }
points = { "O{i}" = ["5*{i}", 0], "C{i}" = ["5*{i} + 3", 0] }
constraints."closes{i}" = { kind = "pin", points = ["coupler{i}.end", "rocker{i}.end"] }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }

[bodies."crank{i}"]
shape = { kind = "rod", mass = "m", length = "a" }
joint = { kind = "revolute", at = "O{i}", angle = "phi" }

[bodies."coupler{i}"]
shape = { kind = "rod", mass = "m", length = "b" }
joint = { kind = "revolute", on = "crank{i}.end", angle = "r{i} - phi" }

[bodies."rocker{i}"]
shape = { kind = "rod", mass = "m", length = "2*a" }
joint = { kind = "revolute", at = "C{i}", angle = "s{i}" }
"""

BRIDGE = """
eomgen = 1
name = "Bridge of n bays"
space = "plane"
repeat = { i = "n", k = [0, "n"], e = [1, "n-1"], d = [1, "n-2"] }
parameters = { n = 4, a = { value = 2, unit = "m" }, F = { value = 10, unit = "kN" } }
outputs = { first = "tension(T, L0-L1)" }

[trusses.T]
nodes = { "L{k}" = ["{k}*a", 0], "U{e}" = ["{e}*a", "a"] }
members = ["L{i-1}-L{i}", "U{e}-L{e}", "L0-U1", "U{n-1}-L{n}", "L{d}-U{d+1}", "U{d}-U{d+1}"]

[constraints]
A = { kind = "pin", points = ["T.L0"] }
B = { kind = "support", point = "T.L{n}", normal = [0, 1] }

[forces]
"load{e}" = { kind = "force", point = "T.L{e}", force = [0, "-F"] }
"""

LEG = """
eomgen = 1
name = "Leg"
space = "space"
parameters = { m = { value = 1, unit = "kg" }, l = { value = 40, unit = "cm" }, g = 9.81, n = 2 }
points = { H = [0, 0, 0] }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
repeat = { j = "n" }

[coordinates]
"q{j}" = { start = "0.1*{j}", unit = "rad" }

[bodies."limb{j}"]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = ["limb{j-1}.end", "H"], axis = [0, 1, 0], angle = "q{j}" }

[outputs]
height = "z(limb{n}.end)"
"""

HEXAPOD = """
eomgen = 1
name = "Hexapod"
space = "space"
repeat = { i = 6 }
parameters = { M = 5, R = 0.3, l_leg = 0.5, g = 9.81 }
coordinates = { h = { start = 1, unit = "m" } }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }

[bodies.trunk]
shape = { kind = "disc", mass = "M", radius = "R" }
joint = { kind = "prismatic", axis = [0, 0, 1], displacement = "h" }

[parts."leg{i}"]
file = "leg.toml"
on = "trunk"
at = ["R*cos({i}*pi/3)", "R*sin({i}*pi/3)", 0]
turned = "{i}*pi/3"
set = { l = "l_leg", m = 0.5 }
"""


def apart(model: eomgen.Model) -> eomgen.Model:
    """A model without the text that it was read from."""
    return replace(model, repeat=None)


def read(tmp_path: Path, text: str, **parts: str) -> Path:
    for name, part in parts.items():
        (tmp_path / f"{name}.toml").write_text(part)
    path = tmp_path / "model.toml"
    path.write_text(text)
    return path


def written_out(path: Path, *options: str) -> str:
    found = CliRunner().invoke(main, ["check", str(path), "--expanded", *options])
    assert found.exit_code == 0, found.output
    return found.output


@each("text", [CHAIN, FOUR_BARS, BRIDGE, HEXAPOD])
def test_what_is_written_out_is_the_same_model(text, tmp_path):
    """`check --expanded` prints a file without repetition that is read as the same model."""
    path = read(tmp_path, text, leg=LEG)
    plain = written_out(path)
    assert "{i" not in plain and "[repeat]" not in plain and "[parts" not in plain
    assert apart(eomgen.loads(plain, title=eomgen.load(path).name)) == apart(eomgen.load(path))


def test_a_chain_is_the_one_that_a_person_writes():
    """Names, references, symbols and numbers by hand."""
    found = eomgen.loads(CHAIN)
    assert [*found.bodies] == ["rod1", "rod2", "rod3"] and [*found.coordinates] == ["q1", "q2", "q3"]
    assert [body.joint.on for body in found.bodies.values()] == [None, "rod1.end", "rod2.end"]
    starts = [q.start.value_at({"pi": math.pi}) for q in found.coordinates.values()]
    assert starts == pytest.approx([math.pi / 18, math.pi / 9, math.pi / 6])
    assert found.bodies["rod3"].joint.symbol.letter.text == "A_{3}"


@each("count", [1, 2, 5])
def test_the_count_is_set_like_a_value(count, tmp_path):
    """`--set n=5`, parameters={"n": 5} and the number in the file make the same model; what else was set stays."""
    other = eomgen.loads(CHAIN.replace("n = 3", f"n = {count}"))
    found = model_at(eomgen.loads(CHAIN), {"n": count, "m": 2})
    assert [*found.bodies] == [*other.bodies] and found.exact_parameters()["m"] == 2
    again = model_at(model_at(eomgen.loads(CHAIN), {"m": 2}), {"n": count})
    assert apart(again) == apart(found)
    plain = written_out(read(tmp_path, CHAIN), "--set", f"n={count}")
    assert [*eomgen.loads(plain).bodies] == [*other.bodies]
    assert pickle.loads(pickle.dumps(found)) == found


def test_a_count_is_no_quantity(tmp_path):
    """Nothing is differentiated by it, it takes no range and is not drawn, and half a rod is refused."""
    model = eomgen.loads(CHAIN)
    with pytest.raises(eomgen.UsageError, match="counts things"):
        eomgen.sensitivity(model, "q1''", "n")
    with pytest.raises(eomgen.UsageError, match="counts things"):
        model_at(model, {"n": 1.5})
    with pytest.raises(eomgen.ModelError, match="not drawn at random"):
        eomgen.loads(CHAIN.replace("n = 3", "n = { value = 3, range = [1, 5] }"))
    path = tmp_path / "chain.toml"
    path.write_text(CHAIN)
    found = CliRunner().invoke(main, ["sweep", str(path), "--over", "n=1:3:3"])
    assert found.exit_code == 2 and "'n' counts things of the model" in found.output


def test_a_row_of_four_bars_moves_as_one():
    """n linkages of the same crank angle have n times the kinetic energy of one, in the same motion."""
    one, four = (eomgen.loads(FOUR_BARS.replace("i = 4", f"i = {n}")) for n in (1, 4))
    runs = [eomgen.simulate(each, time=0.5, target="numpy") for each in (one, four)]
    assert runs[1]["phi"][-1] == pytest.approx(runs[0]["phi"][-1], rel=1e-7)
    assert runs[1].energy[0] == pytest.approx(4 * runs[0].energy[0], rel=1e-9)


@each("bays", [2, 4, 6])
def test_a_bridge_of_bays(bays):
    """The lower chord at the support carries F (n - 1)/2 a/a, the moment there over the height."""
    found = eomgen.solve(model_at(eomgen.loads(BRIDGE), {"n": bays}))
    assert found["first"].value == pytest.approx(1e4 * (bays - 1) / 2)


def test_parts_are_things_of_the_model(tmp_path):
    """A hexapod of six legs in twenty lines: mass and height of the legs' ends by hand; weights count once."""
    model = eomgen.load(read(tmp_path, HEXAPOD, leg=LEG))
    assert len(model.bodies) == 1 + 6 * 3 and len(model.coordinates) == 1 + 6 * 2
    assert [*model.forces] == ["weight"] and "leg1_g" not in model.parameters
    found = eomgen.solve(model)
    height = 1 - 0.5 * (math.sin(0.1) + math.sin(0.3))
    assert [found[f"leg{i}_height"].value for i in range(1, 7)] == pytest.approx([height] * 6, abs=1e-9)


@each(
    "text, at, what",
    [
        (CHAIN.replace('"q{i}" = { start', '"q" = { start'), "15:", "stands in a thing whose name does not hold it"),
        (CHAIN.replace("rod{i-1}.end", "rod{i/2}.end"), "19:", "no whole number"),
        (CHAIN.replace('i = "n"', 'i = "k"'), "5:", "unknown parameter 'k'"),
        (CHAIN.replace("n = 3", "n = 1e9"), "5:", "no whole number"),
        (CHAIN.replace("n = 3", "n = 1000000000"), "5:", "more than"),
        (CHAIN.replace('angle = "q{i}"', 'angle = "p{i}"'), "15:", "coordinate 'q1' is used by nothing (i = 1)"),
        (CHAIN.replace("repeat = { i", "repeat = { m"), "5:", "a thing of the model has that name"),
        (
            CHAIN.replace('on = ["rod{i-1}.end", "O"]', 'on = ["O", "rod{i-1}.end"]'),
            "19:",
            "is needed here, not a list",
        ),
        (HEXAPOD.replace("leg.toml", "arm.toml"), "15:", "cannot be read"),
        (HEXAPOD.replace("m = 0.5", "mass = 0.5"), "19:", "no parameter 'mass'"),
        (HEXAPOD.replace('on = "trunk"', 'on = "trunc"'), "16:", "never declared: 'trunc'"),
        (HEXAPOD.replace('on = "trunk"', 'onto = "trunk"'), "16:", "unknown key 'onto'"),
    ],
)
def test_mistakes_are_told_where_they_are_written(text, at, what, tmp_path):
    with pytest.raises(eomgen.ModelError) as error:
        eomgen.load(read(tmp_path, text, leg=LEG))
    told = str(error.value)
    assert f"model.toml:{at}" in told and what in told, told


def test_a_mistake_in_a_part_is_told_in_its_file(tmp_path):
    with pytest.raises(eomgen.ModelError, match=r"leg\.toml:15:.* no point 'ende' .*\(j = 2\)\n"):
        eomgen.load(read(tmp_path, HEXAPOD, leg=LEG.replace("limb{j-1}.end", "limb{j-1}.ende")))


@each(
    "text",
    [
        CHAIN.replace('i = "n"', "i = [-5, 100000000000]"),
        CHAIN.replace('{ i = "n" }', "{ i = 2000, a = 2000, b = 2000 }").replace("q{i}", "q{i}_{a}_{b}"),
        CHAIN.replace('angle = "q{i}"', 'angle = "q{i}", a = [[[["{j}", "{j}"]]]]').replace(
            'i = "n"', 'i = "n", j = 1999'
        ),
    ],
)
def test_no_text_asks_for_a_million_things(text):
    """Refused before anything is built."""
    begun = time.process_time()
    with pytest.raises(eomgen.ModelError):
        eomgen.loads(text)
    assert time.process_time() - begun < 2


def test_parts_within_parts_end(tmp_path):
    with pytest.raises(eomgen.ModelError, match="deep"):
        eomgen.load(read(tmp_path, HEXAPOD, leg=LEG + '[parts.own]\nfile = "leg.toml"\n'))


def test_only_a_file_repeats():
    with pytest.raises(eomgen.ModelError, match="in Python make the parts in a loop"):
        eomgen.Model(space="plane", repeat={"i": 3})


def answers(model: eomgen.Model) -> dict[str, object]:
    """The number of each output, or that it has none."""
    return {name: answer.value for name, answer in eomgen.solve(model).items()}


@pytest.mark.slow
@each("path", usual(sorted(MODELS.rglob("*.toml")), 12, 3))
def test_a_model_is_the_same_as_a_part_of_another(path, tmp_path):
    """Where it stands, and moved by nothing, all that the names of its file can be: the same answers to its outputs."""
    own = eomgen.load(path)
    told = answers(own) if own.outputs and own.given is None and own.linearize is None else {}
    for at in ("", f"at = {[0] * (2 if own.space == 'plane' else 3)}"):
        text = f'eomgen = 1\nspace = "{own.space}"\n[parts.P]\nfile = "{path}"\n{at}\n'
        whole = eomgen.load(read(tmp_path, text))
        assert [*whole.bodies] == [f"P_{name}" for name in own.bodies]
        found = answers(whole) if told else {}
        assert [*found] == [f"P_{name}" for name in told]
        for name, value in told.items():
            assert found[f"P_{name}"] == (None if value is None else pytest.approx(value, rel=1e-8, abs=1e-9)), name


def test_a_table_of_a_part_is_called_by_its_name(tmp_path):
    """And a function of a formula, sin(q), stays one, where a coordinate is called sin_ or q."""
    part = LEG.replace("[coordinates]", "tables.M = { at = [0, 1], values = [0, 2] }\n\n[coordinates]").replace(
        'height = "z(limb{n}.end)"', 'height = "z(limb{n}.end)"\nlaw = "M(q1) + M\'(q1) + sin(q1)"'
    )
    found = eomgen.solve(eomgen.load(read(tmp_path, HEXAPOD, leg=part)))
    assert found["leg2_law"].value == pytest.approx(0.2 + 2 + math.sin(0.1))


@pytest.mark.slow
def test_a_report_of_parts_holds(tmp_path):
    """Its legends name coordinates of parts, leg1_q1, whose letters a page sets with an index in an index."""
    two = HEXAPOD.replace("i = 6", "i = 2")
    path, page = read(tmp_path, two, leg=LEG), tmp_path / "page.html"
    found = CliRunner().invoke(main, ["report", str(path), "-o", str(page), "--time", "0.3"])
    assert found.exit_code == 0, found.output


def test_a_vector_whose_components_are_texts_is_no_list_of_references():
    """at = ["{i}*a", "b"] is a place, beside on = ["rod{i-1}.end", "O"]; so is a force that calls a table."""
    text = CHAIN.replace("[coordinates]", "b = 0.5\n\n[tables]\nT = { at = [0, 1], values = [2, 4] }\n\n[coordinates]")
    text += """
[bodies."post{i}"]
joint = { kind = "placed", at = ["{i}*l", "b"] }

[forces."push{i}"]
kind = "force"
point = "rod{i}.end"
force = ["T(0.5*{i})", "b"]
"""
    found = eomgen.loads(text)
    assert [[x.text for x in found.bodies[f"post{i}"].joint.at] for i in (1, 2)] == [["1*l", "b"], ["2*l", "b"]]
    push = found.forces["push2"].force
    assert push[0].evaluate({"pi": math.pi}) == 4 and push[1].text == "b"
