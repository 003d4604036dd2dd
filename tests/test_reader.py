"""Text -> Model, or every problem at once with its place, its culprit and its fix."""

# ruff: noqa: E501 - a message stands on the line on which it is told

from fractions import Fraction
from pathlib import Path

import pytest
from cpu_limit import cpu_limit
from each import each

import eomgen
from eomgen.errors import ModelError
from eomgen.model.checks.plausible import warnings_of
from eomgen.model.reader import load, loads

MODELS = sorted((Path(__file__).parents[1] / "models").rglob("*.toml"))

HEAD = 'eomgen = 1\nname = "m"\nspace = "{space}"\n'
ARM = """
[coordinates]
q = 0.1
[bodies.arm]
shape = { kind = "rod", mass = 1, length = 2 }
joint = { kind = "revolute", angle = "q" }
"""


def problems(text: str, space: str = "plane") -> list[str]:
    """Each problem of a model as "line:column: what / fix"."""
    with pytest.raises(ModelError) as caught:
        loads(HEAD.format(space=space) + text, name="m")
    return [f"{p.where.removeprefix('m:')}: {p.what} / {p.fix}" for p in caught.value.problems]


def only_problem(text: str, space: str = "plane") -> str:
    (one,) = problems(text, space)
    return one


@pytest.mark.slow
@each("path", MODELS)
def test_every_model_of_the_gallery_loads(path):
    """models/**/*.toml -> Model, with the names of the tables in the order of the text."""
    model = load(path)
    text = path.read_text()
    places = [text.index(f"\n{name} ") for name in model.parameters if f"\n{name} " in text]
    assert places == sorted(places)


def test_an_error_is_told_as_the_style_asks():
    """file:line:column: what / source line / caret under the culprit inside the text / fix."""
    text = (
        HEAD.format(space="plane")
        + ARM.replace("bodies.arm", "bodies.forearm")
        + (
            '[bodies.hand]\nshape = { kind = "particle", mass = 1 }\n'
            'joint = { kind = "revolute", on = "forarm.end", angle = "q" }\n'
        )
    )
    with pytest.raises(ModelError) as caught:
        loads(text, name="models/robot.toml")
    assert str(caught.value) == (
        "models/robot.toml:12:36: joint of body 'hand' hangs on a body that was never declared: 'forarm'\n"
        '    joint = { kind = "revolute", on = "forarm.end", angle = "q" }\n'
        "                                       ^^^^^^\n"
        "fix: did you mean 'forearm'?"
    )


def test_all_problems_come_at_once_in_the_order_of_the_file():
    """An unknown key, an unknown name, an idle coordinate and a negative mass: four problems, one error."""
    reported = problems(
        '[coordinates]\nq = 0\nidle = 0\n[bodies.b]\nshape = { kind = "rod", mass = -1, length = 1, lenght = 2 }\n'
        'joint = { kind = "revolute", angle = "q + k" }\n'
    )
    assert [line.split(":")[0] for line in reported] == ["6", "8", "8", "9"]
    assert "'idle' is used by nothing" in reported[0] and "negative: -1" in reported[1]
    assert "unknown key 'lenght' in the shape of body 'b' / did you mean 'length'?" in reported[2]
    assert "unknown name 'k' in the angle of the joint of body 'b'" in reported[3]


BODY = '[bodies.b]\nshape = {{ kind = "{}", {} }}\n'
WRONG = {
    "unknown table": ("[bodys.b]\n", "4:1: unknown key 'bodys' in the model / did you mean 'bodies'?"),
    "unknown kind": (BODY.format("rodd", "mass = 1"), "5:18: unknown kind of shape: 'rodd' / did you mean 'rod'?"),
    "missing key": (BODY.format("rod", "mass = 1"), "5:9: the shape of body 'b' has no 'length' / give 'length'"),
    "missing mass": (
        BODY.format("rod", "length = 1"),
        "5:9: the shape of body 'b' has no 'mass' / give 'mass' (0 for a massless body)",
    ),
    "two masses": (
        BODY.format("particle", "mass = 1") + "mass = 2\n",
        "6:1: body 'b' has both 'shape' and 'mass' / 'shape' gives the mass already: leave out 'mass'",
    ),
    "vector too long": (
        '[forces.w]\nkind = "gravity"\nacceleration = [0, 0, 1]\n',
        "6:16: the acceleration of force 'w': 2 components are needed, not 3 / the model is in the plane",
    ),
    "nan": ("[parameters]\na = nan\n", "5:5: 'nan' is not a number that can be calculated with / "),
    "infinity in a text": ("[parameters]\na = '-inf'\n", "5:7: 'inf' is not a number that can be calculated with / "),
    "zero radius": (
        BODY.format("disc", "mass = 1, radius = 0"),
        "5:45: 'radius' in the shape of body 'b' is zero: 0 / ",
    ),
    "negative length by a parameter": (
        "[parameters]\nl = -2\n" + BODY.format("rod", 'mass = 1, length = "l/2"'),
        "7:44: 'length' in the shape of body 'b' is negative: 'l/2' = -1 / ",
    ),
    "unknown unit": (
        "[parameters]\na = { value = 1, unit = 'meter' }\n",
        "5:26: there is no unit 'meter' / did you mean 'm'?",
    ),
    "mass in metres": (
        "[parameters]\na = { value = 1, unit = 'm' }\n" + BODY.format("particle", 'mass = "a"'),
        "7:38: parameter 'a' is in m, but the mass of the shape of body 'b' is in kg / "
        "give another parameter, or fix its unit",
    ),
    "a unit in the field": (
        BODY.format("particle", "mass = { value = 1, unit = 's' }"),
        "5:57: the unit 's' does not fit: this is in kg / ",
    ),
    "a unit beside parameters": (
        "[parameters]\na = 1\nb = { value = '2*a', unit = 'cm' }\n",
        "6:15: '2*a' has names in it, which are in SI, but the unit 'cm' is not / "
        "leave the unit out, or give it to the numbers",
    ),
    "itself as parent": (
        BODY.format("particle", "mass = 1") + 'joint = { kind = "fixed", on = "b" }\n',
        "6:32: body 'b' hangs on itself / one of them must hang on the ground",
    ),
    "idle input": ("[inputs]\nF = 0\n", "5:1: input 'F' is used by nothing / use it, or leave it out"),
    "idle speed": (
        "[speeds]\nw = {}\n",
        "5:1: speed 'w' has no 'rate' and no joint names it in 'omega' / give its 'rate', an expression in the rates",
    ),
    "a prime on a parameter": (
        '[parameters]\na = 1\n[outputs]\no = "a\'"\n',
        "7:6: a prime on what does not move: a' ('a' is a parameter) / write a",
    ),
    "a cycle of parameters": (
        "[parameters]\na = 'b'\nb = '2*a'\n",
        "5:5: parameters in a ring: a -> b -> a / give one of them a number",
    ),
    "a reserved name": ("[parameters]\nt = 1\n", "5:1: 't' is reserved: it means time / take another name"),
    "no name at all": (
        '[parameters]\n"a b" = 1\n',
        "5:1: 'a b' cannot name a parameter / a name is made of letters, digits and _, a letter first",
    ),
    "a name for two things": (
        "[parameters]\na = 1\n[inputs]\na = 1\n[outputs]\no = 'a'\n",
        "7:1: 'a' is declared twice: as a parameter and as an input / give one of them another name",
    ),
    "a point that the shape has": (
        BODY.format("rod", "mass = 1, length = 1") + "points = { end = [1, 0] }\n",
        "6:12: body 'b' has a point 'end' of its own already / take another name, or leave it out",
    ),
    "a point that nobody has": (
        BODY.format("rod", "mass = 1, length = 1") + '[constraints.p]\nkind = "pin"\npoints = ["b.edn"]\n',
        "8:14: body 'b' has no point 'edn' (in the points of constraint 'p') / did you mean 'end'?",
    ),
    "a body for a point": (
        BODY.format("particle", "mass = 1") + '[constraints.p]\nkind = "pin"\npoints = ["b"]\n',
        "8:12: 'b' is a body, not a point (in the points of constraint 'p') / one of its points: 'b.origin', 'b.center'",
    ),
    "no gap and no rate": (
        '[constraints.c]\nkind = "equation"\n',
        "4:1: one of 'gap' and 'rate' is needed (constraints.c) / ",
    ),
    "an unknown function": ('[outputs]\no = "sped(x)"\n', "5:6: unknown function 'sped' / did you mean 'speed'?"),
    "an output in an output": (
        '[outputs]\na = "1"\no = "a"\n',
        "6:6: unknown name 'a' in the value of output 'o' / outputs do not refer to outputs: write its expression here",
    ),
    "too many arguments": (
        '[outputs]\no = "kinetic_energy(a, b)"\n',
        "5:6: kinetic_energy takes 0 to 1 arguments, not 2 / kinetic_energy([body])",
    ),
    "reaction of a placed body": (
        BODY.format("particle", "mass = 1") + 'joint = { kind = "placed" }\n[outputs]\no = "reaction_x(b)"\n',
        "8:17: body 'b' is placed, which is geometry: it has no reaction of its own (in reaction_x(b)) / "
        "name the constraint that holds it",
    ),
    "an implicit product": (
        "[parameters]\na = 1\nb = '2a'\n",
        "6:7: no sign between '2' and 'a' / there is no implicit product: write 2*a",
    ),
    "a hostile power": ("[parameters]\na = '9^9^9'\n", "5:7: the power is too large / "),
    "a parameter that has no value": (
        "[parameters]\na = 0\nb = '1/a'\n",
        "6:7: parameter 'b': division by zero / ",
    ),
    "a flag that is none": (
        "[parameters]\na = { value = 1, positive = 'yes' }\n",
        "5:29: true or false is needed here, not 'yes' / ",
    ),
    "a negative inertia": (
        "[bodies.b]\nmass = 1\ninertia = -1\n",
        "6:11: a moment of inertia of body 'b' is negative: -1 / ",
    ),
    "positive and negative": (
        "[parameters]\na = { value = -1, positive = true }\n",
        "5:15: parameter 'a' is declared positive but is -1 / ",
    ),
    "driven twice": (
        "[coordinates]\nq = { motion = 't', rate = '1' }\n[outputs]\no = 'q'\n",
        "5:21: coordinate 'q' is driven twice: motion, rate / keep one",
    ),
    "a coordinate in a given motion": (
        "[coordinates]\np = 0\nq = { motion = 'p' }\n[outputs]\no = 'q + p'\n",
        "6:17: 'p' (a coordinate) cannot stand in the motion of coordinate 'q' / only parameters and time can stand here",
    ),
    "friction without sliding": (
        BODY.format("disc", "mass = 1, radius = 1")
        + '[constraints.r]\nkind = "rolling"\nbody = "b"\nline = { at = [0, 0], normal = [0, 1] }\nfriction = 0.1\n',
        "10:1: friction needs sliding / slip = true, or leave 'friction' out",
    ),
    "a direction of length zero": (
        BODY.format("particle", "mass = 1")
        + '[constraints.s]\nkind = "support"\npoint = "b.center"\nnormal = [0, 0]\n',
        "9:10: the normal of constraint 's': a direction cannot be zero / give a direction",
    ),
    "a direction that parameters make zero": (
        "[parameters]\na = 0\n"
        + BODY.format("particle", "mass = 1")
        + '[constraints.s]\nkind = "support"\npoint = "b.center"\nnormal = ["a", "2*a"]\n',
        "11:10: the normal of constraint 's': a direction cannot be zero / give a direction",
    ),
    "a start that is no number": (
        "[parameters]\na = 2\n[coordinates]\nq = { start = 'asin(a)' }\n[outputs]\no = 'q'\n",
        "7:16: the start of coordinate 'q': 'asin' has no value here: math domain error / ",
    ),
    "a space joint in the plane": (
        BODY.format("particle", "mass = 1")
        + "joint = { kind = 'spherical', orientation = 'zxz', angles = [0, 0, 0] }\n",
        '6:18: a spherical joint needs space, but the model is in the plane / use "revolute", "prismatic" or "free"',
    ),
}


@each("text, reported", WRONG.values())
def test_each_mistake_has_its_place_its_words_and_its_mend(text, reported):
    """One mistake, one problem: "line:column: what / fix"."""
    assert only_problem(text) == reported


def test_a_ring_of_bodies_is_told_once():
    """a -> b -> a, although both hang in it."""
    text = "".join(f'[bodies.{a}]\njoint = {{ kind = "fixed", on = "{b}" }}\n' for a, b in ("ab", "ba"))
    assert "bodies hang on one another in a ring: a -> b -> a" in only_problem(text)


@each(
    "inertia, possible",
    [
        ("[1, 2, 3]", True),
        ("[1, 2, 3.001]", False),
        ("[1, 1, 1, 0, 0, 0.5]", True),
        ("[1, 1, 1, 0.6, 0, 0]", False),
    ],
)
def test_the_triangle_inequality_holds_for_principal_moments(inertia, possible):
    """I_1 <= I_2 + I_3, equality allowed: tr(I)/2 - I has no negative eigenvalue."""
    text = f'[coordinates]\nq = 0\n[bodies.b]\nmass = 1\ninertia = {inertia}\njoint = {{ kind = "revolute", angle = "q" }}\n'
    reported = [x.what for x in warnings_of(loads(HEAD.format(space="space") + text))]
    assert (not possible) == any("breaks the triangle inequality" in what for what in reported)
    measured = loads(HEAD.format(space="space") + text.replace("mass = 1", "mass = 1\nmeasured = true"))
    assert not any("triangle" in x.what for x in warnings_of(measured))


@each(
    "joint, needed",
    [
        ('{ kind = "revolute", angle = "q" }', True),
        ('{ kind = "prismatic", axis = [1, 0], displacement = "q" }', False),
        ('{ kind = "fixed", on = "arm" }', True),
        ('{ kind = "placed", at = ["q", 0], angle = 1 }', False),
    ],
)
def test_an_inertia_is_needed_once_the_body_can_turn(joint, needed):
    """A body that turns, or hangs on one that does, has no inertia that may be left out."""
    text = ARM + f"[bodies.b]\nmass = 1\njoint = {joint}\n"
    if needed:
        assert "body 'b' can turn but has no 'inertia'" in only_problem(text)
    else:
        loads(HEAD.format(space="plane") + text)


def test_values_are_exact_and_in_si():
    """40 cm = 2/5 m, 90 deg = pi/2, 0.1 = 1/10: no float in between."""
    model = loads(
        HEAD.format(space="plane") + "[parameters]\na = { value = 40, unit = 'cm' }\nb = 0.1\nc = 1_000.5e-3\n"
        "[coordinates]\nq = { start = 90, speed = 180, unit = 'deg' }\n"
        "[bodies.b]\nshape = { kind = 'rod', mass = 1, length = { value = 5, unit = 'mm' } }\n"
        "joint = { kind = 'revolute', angle = 'q' }\n"
    )
    values = [part.value.evaluate({}) for part in model.parameters.values()]
    assert values == [Fraction(2, 5), Fraction(1, 10), Fraction(2001, 2000)]
    q = model.coordinates["q"]
    assert (q.start.evaluate({"pi": 2}), q.speed.evaluate({"pi": 2})) == (1, 2)
    assert model.bodies["b"].shape.length.evaluate({}) == Fraction(1, 200)


def test_a_key_given_twice_does_not_hide_the_rest():
    """The second `m` is told with the line of the first, and what else is wrong too."""
    reported = problems("[parameters]\nm = 1\nm = 2\n[bodies.b]\nshape = { kind = 'rodd' }\n")
    assert reported[0] == "6:1: 'm' is given twice / first given in line 5" and "'rodd'" in reported[1]


def test_text_that_is_not_toml_is_told_with_its_place():
    """An expression without quotes is the usual case."""
    assert only_problem('[bodies.b.joint]\nkind = "revolute"\nangle = theta\n').startswith(
        "6:9: not TOML: Invalid value"
    )


def test_bytes_that_are_not_utf8_are_told_with_their_place():
    with pytest.raises(ModelError, match=r"m:2:9: not UTF-8: byte 0xff"):
        loads(b'eomgen = 1\nname = "\xff"\n', name="m")


def test_a_byte_order_mark_and_windows_line_ends_do_no_harm():
    text = HEAD.format(space="plane") + ARM
    assert loads(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode()) == loads(text)


@each(
    "first, reported",
    [
        ("", "the file does not say that it is a model"),
        ("eomgen = 2\n", "version 2 of the model file is not known here"),
        ("eomgen = true\n", "version true of the model file is not known here"),
    ],
)
def test_the_version_must_be_there_and_known(first, reported):
    with pytest.raises(ModelError, match=reported):
        loads(first + 'space = "plane"\n')


def test_a_file_that_is_not_there_is_told_by_its_path(tmp_path):
    with pytest.raises(ModelError, match=r"nowhere\.toml: cannot be read"):
        load(tmp_path / "nowhere.toml")


def test_carets_point_into_strings_with_escapes_and_multiple_lines():
    """The column counts in the file, not in the text that the file stands for."""
    assert only_problem('[parameters]\na = "\\u0031 + foo"\n').startswith("5:15: unknown name 'foo'")
    assert only_problem('[parameters]\na = """\n1 +\n  foo"""\n').startswith("7:3: unknown name 'foo'")


HOSTILE = {
    "too long": "x" * 1_000_001,
    "deep lists": "a=" + "[" * 100_000,
    "deep tables": "a=" + "{a=" * 100_000,
    "deep keys": ".".join(["a"] * 100_000) + "=1",
    "an endless string": 'a="""' + "x" * 900_000,
    "a huge number": "eomgen = 1\nspace='plane'\n[parameters]\na=" + "9" * 100_000,
    "many mistakes": "eomgen = 1\nspace='plane'\n[parameters]\n" + "".join(f"p{i}='z{i}'\n" for i in range(5_000)),
    "a key many times": "eomgen = 1\nspace='plane'\n[parameters]\n" + "p=1\n" * 50_000,
    "a long ring": "eomgen = 1\nspace='plane'\n[parameters]\np0='p4999'\n"
    + "".join(f"p{i}='p{i - 1}+1'\n" for i in range(1, 5_000)),
    "growing numbers": "eomgen = 1\nspace='plane'\n[parameters]\np0=2\n"
    + "".join(f"p{i}='p{i - 1}^2'\n" for i in range(1, 100)),
}


@pytest.mark.slow
@each("text", HOSTILE.values())
def test_a_hostile_text_costs_little_and_ends_in_an_error(text):
    """A clear error, never a traceback, in about a second."""
    with cpu_limit(20), pytest.raises(ModelError):  # about 1 by itself
        loads(text)


def test_a_slider_whose_point_is_no_name_is_a_model_error():
    """`point = 0` is told, not followed by a crash in what the slider says of its fields together."""
    text = 'eomgen = 1\nspace = "plane"\n[bodies.b]\n[constraints.C]\nkind = "slider"\npoint = 0\non = "b"\n'
    with pytest.raises(ModelError):
        loads(text)


ROLLS = """
[parameters]
r = 0.3
e = { value = 0.05, unit = "m" }
[coordinates]
x = 0
y = 0.3
phi = 0.2
[bodies.wheel]
mass = 2
inertia = 0.1
POINTS
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.contact]
kind = "rolling"
body = "wheel"
line = { at = [0, 0], normal = [0, 1] }
radius = "r"
center = CENTER
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""


def test_the_center_of_what_rolls_may_be_a_place_of_the_body():
    """center = ["e", 0] is a point of the body there: the same equations; a wrong length is told at its place."""
    head = HEAD.format(space="plane")
    place = loads(head + ROLLS.replace("POINTS\n", "").replace("CENTER", '["e", 0]'))
    point = loads(head + ROLLS.replace("POINTS", 'points = { hub = ["e", 0] }').replace("CENTER", '"hub"'))
    assert place.constraints["contact"].center == "center_of_contact"
    assert [x.text for x in place.bodies["wheel"].points["center_of_contact"]] == ["e", "0"]
    found = [eomgen.derive(model) for model in (place, point)]
    assert [str(row) for row in found[0].forcing] == [str(row) for row in found[1].forcing]
    assert loads(head + ROLLS.replace("POINTS\n", "").replace("CENTER", '["e", 0]')) == place
    with pytest.raises(ModelError, match="2 components are needed, not 3"):
        loads(head + ROLLS.replace("POINTS\n", "").replace("CENTER", '["e", 0, 0]'))
    with pytest.raises(ModelError, match="has no point 'hubb'"):
        loads(head + ROLLS.replace("POINTS", 'points = { hub = ["e", 0] }').replace("CENTER", '"hubb"'))
