"""A state in which something has no value: the force, joint, input or constraint is named, what it does, and where."""

from __future__ import annotations

import pytest

import eomgen

pytestmark = pytest.mark.slow

BLOCK = """eomgen = 1
space = "plane"
[parameters]
k = 2
[coordinates]
x = {start}
[bodies.b]
mass = 1
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x"{joint} }}
[points]
O = [0, 0]
{more}
"""
FORCE = '[forces.pull]\nkind = "force"\npoint = "b.origin"\nforce = ["{}", 0]'
SPRING = '[forces.pull]\nkind = "{}"\npoints = ["b.origin", "O"]\n{}'


def model(start, joint="", more=""):
    return eomgen.loads(BLOCK.format(start=start, joint=joint, more=more))


@pytest.mark.parametrize(
    ("start", "joint", "more", "reported"),
    [
        (0, "", FORCE.format("k/x"), "force 'pull' divides by zero at x = 0"),
        (0, "", FORCE.format("sin(x)/x"), "force 'pull' is 0/0 at x = 0"),
        (-2, "", FORCE.format("log(x)"), "force 'pull' takes the logarithm of what is not positive at x = -2"),
        (3, "", FORCE.format("k*sqrt(1 - x)"), "force 'pull' takes the root of a negative number at x = 3"),
        (0, "", SPRING.format("spring", "stiffness = 3\nlength = 0.5"), "force 'pull' is 0/0 at x = 0"),
        (0, "", SPRING.format("damper", "damping = 3"), "force 'pull' is 0/0 at x = 0"),
        (0, ', force = "1/x"', "", "the joint of body 'b' divides by zero at x = 0"),
        (1, ', force = "u"', '[inputs]\nu = "1/t"', "input 'u' divides by zero at t = 0"),
    ],
)
def test_a_motion_that_starts_without_a_value_says_what_has_none(start, joint, more, reported):
    """0/0, 1/0, sqrt(-2), log(-2): the culprit, why, and the state."""
    run = eomgen.simulate(model(start, joint, more), time=1)
    assert run.message == f"The motion starts where {reported}."
    assert run.status == "not finite"


def test_a_motion_that_comes_to_such_a_state_says_it_too():
    """sqrt(1 - x) pulls a block to x = 1: there the root ends."""
    run = eomgen.simulate(model(0.5, "", FORCE.format("k*sqrt(1 - x)")), time=5, samples=5)
    assert "force 'pull' takes the root of a negative number at x = 1." in run.message
    assert run.x[-1, 0] == pytest.approx(1, abs=1e-6)


def test_a_tie_without_a_value_is_named_with_its_state():
    """sin(x)/x = 1/2 at x = 0."""
    text = '[constraints.bond]\nkind = "equation"\ngap = "sin(x)/x - 1/2"'
    with pytest.raises(eomgen.EomgenError, match=r"'bond' \(row 1\) is 0/0 at x = 0, where it starts"):
        eomgen.simulate(model(0, "", text), time=1)


def test_an_answer_that_would_need_such_a_start_names_the_damper():
    """A driven crank turns, and a damper between points that coincide has no direction: not "it rests at the start"."""
    text = (
        SPRING.format("damper", "damping = 3")
        + '\n[bodies.crank]\nmass = 1\ninertia = 1\njoint = { kind = "revolute", angle = "a" }\n'
        + '[outputs]\nM = { value = "drive(a)", at = "a = 0.2" }'
    )
    found = eomgen.solve(eomgen.loads(BLOCK.format(start='0\na = { motion = "0.3*sin(2*t)" }', joint="", more=text)))
    assert "the motion starts where force 'pull' is 0/0 at x = 0" in found["M"].message


ROUGH = """
eomgen = 1
space = "{space}"
parameters = {{ m = 1, g = 9.81, mu = 0.3 }}
coordinates = {{ x = 0, y = 0, {z}s = 0 }}
bodies.p.shape = {{ kind = "particle", mass = "m" }}
bodies.p.joint = {{ kind = "placed", at = {at} }}
bodies.q.shape = {{ kind = "particle", mass = "m" }}
bodies.q.joint = {{ kind = "prismatic", axis = [1, 0{o}], displacement = "s", stiffness = 10 }}
constraints.floor = {{ kind = "support", point = "p.center", normal = [0{o}, 1], unilateral = true, friction = "mu" }}
forces.weight = {{ kind = "gravity", acceleration = [0{o}, "-g"] }}
"""
FLAT = {"space": "plane", "z": "", "at": '["x", "y"]', "o": ""}
SPACE = {"space": "space", "z": "z = 0, ", "at": '["x", "y", "z"]', "o": ", 0"}


@pytest.mark.parametrize(("how", "reported"), [(FLAT, "a corner or a jump"), (SPACE, "is 0/0 at")])
def test_small_motions_about_what_does_not_slide_name_its_friction(how, reported):
    """mu N v/|v| jumps at v = 0; on a surface its direction has no value there."""
    with pytest.raises(eomgen.EomgenError, match=reported) as refused:
        eomgen.linearize(eomgen.loads(ROUGH.format(**how)), about="start")
    assert "the friction of 'floor'" in str(refused.value)


@pytest.mark.parametrize(("length", "told"), [("z", True), ("2*z", True), ("k", False)])
def test_a_spring_whose_natural_length_is_a_parameter_of_0_is_told_what_to_write(length, told):
    """k (l - l0) d/l is 0/0 where the ends meet; `length = 0` is k d, and has a value there."""
    text = BLOCK.replace("k = 2", "k = 2\nz = 0").format(
        start=0, joint="", more=SPRING.format("spring", f'stiffness = 3\nlength = "{length}"')
    )
    run = eomgen.simulate(eomgen.loads(text), time=1, samples=2, target="numpy")
    assert "force 'pull' is 0/0 at x = 0" in run.message
    assert ("write length = 0" in run.message) == told
    written = eomgen.simulate(eomgen.loads(text.replace(f'"{length}"', "0")), time=1, samples=2, target="numpy")
    assert written.ok
