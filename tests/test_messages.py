"""Common mistakes and the fix that is said; one mistake is one error, and hides no other."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each
from newcomer import CRANE
from slow_run import sampled
from source_trees import modules_of, nodes_of

import eomgen
from eomgen.cli import main

JOINT, REQUESTED, ANGLE = (
    'joint = { kind = "revolute", on = "trolley", angle = "phi - pi/2" }',
    "\"phi''\"",
    '"phi - pi/2"',
)
HABITS = [
    ('"m/s^2"', '"m/s2"', "m/s^2"),
    ('"kg"', '"kgs"', "'kg'"),
    ('on = "trolley"', 'parent = "trolley"', "'on'"),
    (JOINT, 'joint = {\n  kind = "revolute",\n  on = "trolley" }', "one line; or write it as one with a head"),
    (ANGLE, '"phi - 90 deg"', "write pi/2"),
    (ANGLE, '"phi - 90*deg"', "write pi/2"),
    (ANGLE, '"135 deg + phi"', "write 3*pi/4"),
    ('{ value = 9.81, unit = "m/s^2" }', '"9,81"', "write a decimal point: 9.81"),
    ('{ value = 5, unit = "kg" }', '"5 kg"', '{ value = 5, unit = "kg" }'),
    ("value = 5,", "value = 5,0,", "write a decimal point: 5.0"),
    (CRANE, "name: crane\nbodies:\n  - a\n", 'write: name = "crane"'),
    (REQUESTED, '"phi_dot"', "write phi'"),
    (REQUESTED, '"phiddot"', "write phi''"),
    (REQUESTED, '"dphi"', "write phi'"),
    (REQUESTED, '"diff(phi, t)"', "write phi'"),
    (REQUESTED, '"diff(phi, t, 2)"', "write phi''"),
    (REQUESTED, '"ddot(phi)"', "write phi''"),
    (REQUESTED, '"sin^2(phi + (x))"', "write sin(phi + (x))^2"),
    (REQUESTED, '"x(boom.end"', "write )"),
    (ANGLE, '"phi - π/2"', "write pi"),
    (ANGLE, '"φ"', "write phi"),
    (REQUESTED, '"reaction(boom)"', "one of reaction_x, reaction_y"),
    (REQUESTED, '"velocity(boom.end)"', "one of speed, vx, vy"),
    ('"revolute"', '"hinge"', "'revolute'"),
    ('"prismatic"', '"slider"', "'prismatic'"),
    ('kind = "revolute"', 'type = "revolute"', "write kind"),
    ("start = 20", "value = 20", "'start'"),
    ("[parameters]", "[paramters]", "'parameters'"),
    ("[bodies.boom]", "[boddies.boom]", "'bodies'"),
    (JOINT, JOINT.replace(" }", ', friction = "T" }'), "torque, coefficient, radius"),
]


def problems(text: str) -> tuple[eomgen.Problem, ...]:
    with pytest.raises(eomgen.ModelError) as caught:
        eomgen.loads(text)
    return caught.value.problems


@each("old, new, fix", HABITS)
def test_a_habit_of_another_notation_is_answered_with_ours(old, new, fix):
    """One mistake, and all that is said leads to its fix."""
    assert CRANE.count(old) >= 1
    found = problems(CRANE.replace(old, new, 1))
    assert fix in found[0].fix
    assert len(found) == 1 or new == "[boddies.boom]"


def test_the_model_itself_is_good():
    """Each mistake above is the only one."""
    assert eomgen.loads(CRANE).name == "crane"


def test_a_mistyped_heading_hides_no_error_below_it():
    """[paramters] is told, and a wrong unit in it, at its place; what uses its names is no error."""
    found = problems(CRANE.replace("[parameters]", "[paramters]").replace('"N/m"', '"N/q"'))
    assert [problem.where.split(":")[1] for problem in found] == ["4", "8"]
    assert "paramters" in found[0].what and "'q'" in found[1].what


@each("key, right", [("jiont", "joint"), ("shap", "shape")])
def test_a_mistyped_key_of_a_body_hides_no_error_in_it(key, right):
    """The key and the unknown name below it: two errors, both at their places, none that follows from them."""
    text = CRANE.replace(f'{right} = {{ kind = "r', f'{key} = {{ kind = "r', 1)
    assert len(problems(text)) == 1
    name = {"joint": "phi -", "shape": '"l"'}[right]
    found = problems(text.replace(name, name.replace("phi", "psi").replace("l", "ll")))
    assert [problem.what.split("'")[1] for problem in found] == [key, {"joint": "psi", "shape": "ll"}[right]]
    assert {problem.where.split(":")[1] for problem in found} == {"18" if right == "joint" else "17"}


def test_a_mistyped_kind_hides_no_error_beside_it():
    """kind = "revolut" and on = "troley": both are told, at their places."""
    text = CRANE.replace('"revolute"', '"revolut"').replace('on = "trolley"', 'on = "troley"')
    found = problems(text)
    assert ["revolut" in found[0].what, "troley" in found[1].what, len(found)] == [True, True, 2]
    assert len(problems(CRANE.replace('kind = "gravity"', 'kind = "gravty"'))) == 1


def test_a_guess_that_does_not_fit_adds_no_error():
    """A kind far from all, and a key whose value cannot be the one that it resembles: one error each."""
    assert len(problems(CRANE.replace('"revolute"', '"xyzzy"'))) == 1
    assert len(problems(CRANE.replace("start = 20", "strt = [1, 2]"))) == 1


def test_the_line_that_is_shown_has_words():
    """A file that begins with empty lines: the first line with something in it is marked."""
    (problem,) = problems('\n# a remark\n\nspace = "plane"\n')
    assert problem.where.endswith(":4:1") and 'space = "plane"' in problem.excerpt


def test_a_strange_key_is_meant_by_the_only_one_that_is_missing():
    """One error, and what the value says is read: {needed} - {given} = {points}, {given} - {known} = {between}."""
    damper = '\n[forces.drag]\nkind = "damper"\nbetween = ["boom.end", "ground"]\ndamping = 3\n'
    with pytest.raises(eomgen.ModelError) as caught:
        eomgen.loads(CRANE + damper)
    reported = str(caught.value)
    assert "write 'points': it is needed here" in reported and "has no 'points'" not in reported
    assert "declare it in [points]: ground = [...]" in reported and reported.count("fix:") == 2


TORN = """
eomgen = 1
name = "torn"
space = "plane"
[coordinates]
phi = 0.4
psi = { dependent = true, near = 1.2 }
[bodies.one]
shape = { kind = "rod", mass = 1, length = 0.4 }
joint = { kind = "revolute", angle = "phi" }
[bodies.two]
shape = { kind = "rod", mass = 1, length = 0.4 }
joint = { kind = "revolute", at = [5, 0], angle = "psi" }
[constraints.bar]
kind = "link"
points = ["one.end", "two.end"]
length = 1
"""


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "code"),
    [(("derive", "--no-certify"), 0), (("statics",), 0), (("inertia",), 0), (("linearize",), 3), (("reactions",), 3)],
)
def test_every_verb_says_which_tie_cannot_close(tmp_path, words, code):
    """One sentence, with its place: in verbs that need no start a warning, in others the refusal."""
    path = tmp_path / "torn.toml"
    path.write_text(TORN, encoding="utf-8")
    found = CliRunner().invoke(main, [words[0], str(path), *words[1:]])
    assert found.exit_code == code
    assert f"{path}:14:14: 'bar' (row 1) does not close at the start: it is open by 3.78" in found.stderr


REFUSALS = {"DerivationError", "UsageError", "ModelError", "RunFailed", "NotYet", "ToolMissing"}
INSIDE = ("symbolic", "proof", "judge")  # what is refused there comes out of something that names the model


def test_every_refusal_that_is_written_says_what_to_do():
    """Third argument or `fix=`; an error made of problems carries theirs."""
    silent = []
    for path in modules_of(Path(eomgen.__file__).parent):
        if path.relative_to(Path(eomgen.__file__).parent).parts[0] in INSIDE:
            continue
        for node in nodes_of(path):
            if not (isinstance(node, ast.Raise) and isinstance(call := node.exc, ast.Call)):
                continue
            if not (isinstance(call.func, ast.Name) and call.func.id in REFUSALS):
                continue
            says = len(call.args) > 2 or any(word.arg == "fix" for word in call.keywords)
            text = isinstance(call.args[0], (ast.Constant, ast.JoinedStr, ast.Name)) if call.args else True
            if text and not says and not (isinstance(call.args[0], ast.Name) and call.args[0].id == "problems"):
                silent.append(f"{path.name}:{node.lineno}")
    assert not silent
