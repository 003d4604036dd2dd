"""Everything that the model file forbids ends in exit code 1, named at file:line:column with a caret, and quickly.

A hostile file costs no more than a second, runs nothing, and leaves nothing behind.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from cpu_limit import cpu_limit

import eomgen
from eomgen.cli import main

GOOD = """eomgen = 1
name = "arm"
space = "plane"

[parameters]
m = { value = 1.5, unit = "kg" }
l = { value = 1.0, unit = "m" }
g = 9.81
J = { value = 0.2, unit = "kg*m^2" }

[coordinates]
q1 = 0.1
q2 = { start = 0.2, speed = 1 }

[inputs]
tau = "sin(t)"

[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], point = "start", angle = "q1" }

[bodies.hand]
mass = "m"
center = [0.1, 0]
inertia = "J"
points = { tip = [0.2, 0] }
joint = { kind = "revolute", on = "arm.end", angle = "q2", torque = "tau" }

[constraints.floor]
kind = "support"
point = "hand.tip"
normal = [0, 1]

[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]

[outputs]
v = "speed(hand.tip)"
a = { value = "q1''", unit = "rad/s^2" }
"""
LIMIT = 10.0  # seconds of CPU for one bad file: what grows with its square takes minutes


def run(*words: str):
    return CliRunner().invoke(main, list(words))


def checked(tmp_path: Path, data: str | bytes, verb: str = "check"):
    """(result, stderr) of a verb on a file of these bytes, and it was said soon."""
    path = tmp_path / "bad.toml"
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    with cpu_limit(LIMIT):
        result = run(verb, str(path))
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    assert "Traceback" not in result.stderr
    return result


def test_the_good_model_is_good(tmp_path):
    """Every mutation below is the only mistake in its file."""
    assert checked(tmp_path, GOOD).exit_code == 0


MISTAKES = {
    # what: (text, its replacement, culprit under the caret, word of the message)
    "unknown key": ("center = [0.1, 0]", "centre = [0.1, 0]", "centre", "did you mean 'center'"),
    "unknown kind": ('kind = "gravity"', 'kind = "gravty"', "gravty", "did you mean 'gravity'"),
    "unknown table": ("[inputs]", "[input]", "input", "did you mean 'inputs'"),
    "unknown name": ('angle = "q1"', 'angle = "2*q11"', "q11", "did you mean 'q1'"),
    "unknown body": ('on = "arm.end"', 'on = "amr.end"', "amr", "did you mean 'arm'"),
    "unknown point": ('point = "hand.tip"', 'point = "hand.top"', "top", "did you mean 'tip'"),
    "unknown function": ('"speed(hand.tip)"', '"sped(hand.tip)"', "sped", "did you mean 'speed'"),
    "unknown unit": ('unit = "rad/s^2"', 'unit = "rads/s^2"', "rads", "rad"),
    "a key twice": ("g = 9.81", "g = 9.81\ng = 9.8", "g", "twice"),
    "a name of two kinds": ('tau = "sin(t)"', 'tau = "sin(t)"\nq1 = 0', "q1", "q1"),
    "a reserved name": ("g = 9.81", "g = 9.81\npi = 3", "pi", "pi"),
    "a vector too long": ("normal = [0, 1]", "normal = [0, 1, 0]", "[0, 1, 0]", "2"),
    "a direction of no length": ("normal = [0, 1]", "normal = [0, 0]", "[0, 0]", "0"),
    "nan": ("g = 9.81", "g = nan", "nan", "nan"),
    "inf": ("g = 9.81", "g = inf", "inf", "inf"),
    "a negative mass": ('mass = "m"\ncenter', "mass = -2\ncenter", "-2", "mass"),
    "a negative length": ('length = "l"', 'length = "-l"', "-l", "length"),
    "a length of zero": ('length = "l"', "length = 0", "0", "length"),
    "a negative inertia": ('inertia = "J"', "inertia = -0.1", "-0.1", "inertia"),
    "no inertia": ('inertia = "J"\n', "", None, "inertia"),
    "a unit that does not fit": ('mass = "m", length', 'mass = "l", length', "l", "kg"),
    "a unit that does not fit inline": ('length = "l"', 'length = { value = 3, unit = "kg" }', "kg", "m"),
    "a body hung on itself": ('on = "arm.end"', 'on = "hand.tip"', "hand", "hand"),
    "an unused coordinate": ("q1 = 0.1", "q1 = 0.1\nidle = 0", "idle", "idle"),
    "an unused input": ('tau = "sin(t)"', 'tau = "sin(t)"\nidle = 0', "idle", "idle"),
    "a prime on what stays": ('angle = "q1"', 'angle = "q1 + m\'"', "m'", "m"),
    "a parameter of time": ("g = 9.81", 'g = "9.81*t"', "t", "t"),
    "parameters in a ring": ("g = 9.81", 'g = "2*h"\nh = "g/2"', "2*h", "g -> h -> g"),
    "a coordinate in a start": ("q1 = 0.1", 'q1 = "q2"', "q2", "q2"),
    "no implicit product": ('angle = "q1"', 'angle = "2 q1"', "q1", "2*q1"),
    "half an expression": ('angle = "q1"', 'angle = "sin(q1"', "(", "closed"),
    "a wrong number of arguments": ('angle = "q1"', 'angle = "atan2(q1)"', "atan2", "argument"),
    "a division by zero": ("g = 9.81", 'g = "1/0"', "/", "zero"),
    "an expression without quotes": ('angle = "q1"', "angle = q1", "q1", "TOML"),
    "an open string": ('name = "arm"', 'name = "arm', None, "TOML"),
    "another version": ("eomgen = 1", "eomgen = 2", "2", "eomgen = 1"),
    "no version": ("eomgen = 1\n", "", None, "eomgen = 1"),
    "a number for a name": ('on = "arm.end"', "on = 3", "3", "3"),
    "an accelerated force": ('torque = "tau"', "torque = \"tau*q1''\"", "q1''", "q1''"),
}


@pytest.mark.parametrize("what", MISTAKES)
def test_a_mistake_is_named_at_its_place(what, tmp_path):
    """file:line:column: what is wrong / the source line / a caret under the culprit / fix, and exit code 1."""
    old, new, culprit, word = MISTAKES[what]
    text = GOOD.replace(old, new, 1)
    assert text != GOOD
    result = checked(tmp_path, text)
    assert result.exit_code == 1, result.output
    assert result.stdout == ""
    places = re.findall(r"bad\.toml:(\d+):(\d+): ", result.stderr)
    assert places, result.stderr
    assert word in result.stderr
    line, column = map(int, places[0])
    source = (text.splitlines() or [""])[line - 1]
    shown, carets = result.stderr.splitlines()[1:3]
    assert shown.strip() == source.strip()
    assert set(carets.strip()) == {"^"}
    assert shown.index(source.strip()[0]) - source.index(source.strip()[0]) + column - 1 == carets.index("^")
    if culprit is not None:
        assert source[column - 1 :].strip('"').startswith(culprit), result.stderr


def test_all_mistakes_come_at_once(tmp_path):
    """Three mistakes, three problems, in the order of the file."""
    text = GOOD.replace("normal = [0, 1]", "normal = [0]").replace('angle = "q1"', 'angle = "q9"')
    result = checked(tmp_path, text.replace('kind = "gravity"', 'kind = "gravty"'))
    lines = [int(line) for line in re.findall(r"bad\.toml:(\d+):\d+: ", result.stderr)]
    assert len(lines) >= 3
    assert lines == sorted(lines)


HOSTILE = {
    "a tower of powers": "9^9^9^9",
    "a tower in a function": "sin(9^99999999)",
    "a huge exponent": "2**(10**10)",
    "a huge number": "1e999999999",
    "many digits": "9" * 5000,
    "deep parentheses": "(" * 5000 + "q1" + ")" * 5000,
    "deep signs": "-" * 9000 + "q1",
    "a long sum": "+".join(["q1"] * 5000),
    "an import": "__import__('os').system('touch /tmp/eomgen_was_here')",
    "a lambda": "(lambda: 0)()",
    "an attribute": "q1.__class__",
    "an index": "q1[0]",
    "a walrus": "q1 := 1",
    "a format string": "f'{q1}'",
    "a null": "q1\\u0000",
    "bidirectional text": "q1 + \\u202e1",
}


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_expression_is_refused_at_once(what, tmp_path):
    """No evaluation, no blow-up: an error with its place, or (a long sum) an ordinary answer."""
    result = checked(tmp_path, GOOD.replace('angle = "q1"', f'angle = "{HOSTILE[what]}"'))
    assert result.exit_code == 1, result.output[:500]
    assert re.search(r"bad\.toml:\d+:\d+: ", result.stderr)
    assert len(result.stderr) < 5000
    assert not Path("/tmp/eomgen_was_here").exists()


FILES = {
    "nothing": b"",
    "not UTF-8": GOOD.encode().replace(b"arm", b"\xff\xfe", 1),
    "UTF-16": GOOD.encode("utf-16"),
    "zeros": b"\0" * 1000,
    "over a megabyte": GOOD.encode() + b"#" * 1_000_001,
    "a table many times": b"eomgen = 1\n" + b"[a]\n" * 50_000,
    "a megabyte of brackets": b"eomgen = 1\nx = " + b"[" * 900_000,
    "a megabyte of quotes": b'eomgen = 1\nname = "' + b"a" * 990_000,
    "a thousand dots": b"eomgen = 1\n" + b".".join([b"a"] * 5000) + b" = 1",
    "a list of lists": b"eomgen = 1\nname = " + b"[" * 400 + b"]" * 400,
    "a picture": bytes(range(256)) * 20,
    "a program": b"import os\nos.remove('/')\n",
    "JSON": b'{"eomgen": 1}',
}


@pytest.mark.parametrize("what", FILES)
def test_a_hostile_file_is_refused_at_once(what, tmp_path):
    """Not TOML, not UTF-8, over 1 MB: exit code 1 with a message of a few lines."""
    result = checked(tmp_path, FILES[what])
    assert result.exit_code == 1, result.output[:500]
    assert "bad.toml" in result.stderr
    assert result.stderr.count("bad.toml:") <= 200


@pytest.mark.parametrize("verb", ["check", "derive", "solve", "simulate"])
def test_every_verb_says_the_same_of_a_bad_model(verb, tmp_path):
    """The model is read by one reader."""
    text = GOOD.replace('angle = "q1"', 'angle = "q9"')
    assert checked(tmp_path, text, verb).stderr == checked(tmp_path, text).stderr


@pytest.mark.parametrize(
    "words",
    [
        ("derive", "-o", "out.tex"),
        ("derive", "--json", "-o", "out.json"),
        ("solve", "-o", "out.txt"),
        ("simulate", "-o", "out.csv", "--plot", "out.png"),
        ("codegen", "--target", "c", "-o", "out"),
    ],
)
def test_a_bad_model_leaves_no_file_behind(words, tmp_path, monkeypatch):
    """Nothing is written before it can be written whole; what was there stays."""
    monkeypatch.chdir(tmp_path)
    Path("bad.toml").write_text(GOOD.replace('angle = "q1"', 'angle = "q9"'))
    Path("out.csv").write_text("precious")
    assert run(words[0], "bad.toml", *words[1:]).exit_code == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.toml", "out.csv"]
    assert Path("out.csv").read_text() == "precious"


def test_missing_values_are_listed_all_at_once_where_numbers_are_needed(tmp_path):
    """derive and codegen do not need them; simulate refuses with exit code 1."""
    text = GOOD.replace('{ value = 1.5, unit = "kg" }', "{}").replace("g = 9.81", "g = {}")
    result = checked(tmp_path, text, "simulate")
    assert result.exit_code == 1
    assert all(f"no value for parameter '{name}'" in result.stderr for name in ("m", "g"))
    assert run("codegen", str(tmp_path / "bad.toml"), "--target", "numpy", "-o", str(tmp_path / "code")).exit_code == 0


def test_a_free_coordinate_that_moves_no_mass_is_refused_where_accelerations_are_needed(tmp_path):
    """M has a row of zeros: check passes, derive and simulate name the coordinate."""
    frame = '[bodies.frame]\njoint = { kind = "revolute", angle = "idle" }\n\n[bodies.arm]'
    text = GOOD.replace("[bodies.arm]", frame).replace("q1 = 0.1", "q1 = 0.1\nidle = 0")
    assert checked(tmp_path, text).exit_code == 0
    result = checked(tmp_path, text, "simulate")
    assert result.exit_code == 1
    assert "'idle' moves no mass" in result.stderr


def test_a_spring_between_points_that_are_one_is_refused():
    """It has no direction: an honest error that names both points, not a division by zero."""
    text = """
    eomgen = 1
    space = "plane"
    [parameters]
    m = 1
    [coordinates]
    q = 0
    [bodies.A]
    shape = { kind = "rod", mass = "m", length = 1 }
    joint = { kind = "revolute", angle = "q" }
    [bodies.B]
    mass = "m"
    inertia = 0
    joint = { kind = "fixed", on = "A.end", angle = 0 }
    [forces.s]
    kind = "spring"
    points = ["A.end", "B.origin"]
    stiffness = 1
    length = 0
    """
    with pytest.raises(eomgen.DerivationError, match=r"'A\.end' and 'B\.origin' are always at one place"):
        eomgen.derive(eomgen.loads(text))


@pytest.mark.slow
def test_texts_of_a_model_stay_texts_in_emitted_code(tmp_path):
    """Names and remarks that would close a comment or a string run nothing, in Python and in C."""
    model = tmp_path / "evil.toml"
    model.write_text(r"""
eomgen = 1
name = "evil */ int x; /* \"\"\" \nraise SystemExit(9)"
space = "plane"
source = "\"\"\"\nraise SystemExit(9)\n*/"
[parameters]
m = { value = 1, unit = "kg", about = "*/\n#error out\nraise SystemExit(9)\n\"\"\"" }
class = 2
exec = 9.81
[coordinates]
lambda = { start = 0.1, about = "\nraise SystemExit(9)\n" }
[bodies.import]
shape = { kind = "rod", mass = "m", length = "class" }
joint = { kind = "revolute", angle = "lambda" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-exec"]
""")
    for target in ("numpy", "c"):
        result = CliRunner().invoke(main, ["codegen", str(model), "--target", target, "-o", str(tmp_path)])
        assert result.exit_code == 0, result.stderr
    exec(compile((tmp_path / "evil_rhs.py").read_text(), "evil_rhs.py", "exec"), {"__name__": "evil_rhs"})
    code = (tmp_path / "evil_rhs.c").read_text()
    bare = re.sub(r"/\*.*?\*/", "", code, flags=re.S)
    assert "SystemExit" in code and "SystemExit" not in bare and "#error" not in bare
    assert eomgen.simulate(eomgen.load(model), time=0.1, target="numpy").ok
