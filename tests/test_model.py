"""Python -> Model: the same frozen value as a file gives, with the same checks; and its numbers."""

import pickle
from dataclasses import FrozenInstanceError, replace
from fractions import Fraction
from pathlib import Path

import pytest
from each import each

import eomgen
from eomgen.errors import MissingValues, ModelError
from eomgen.model.fields import Table
from eomgen.model.forces import Distributed, Gravity
from eomgen.model.joints import Placed, Revolute
from eomgen.model.model import Model
from eomgen.model.parts import Body, Coordinate, Output, Parameter, Piece
from eomgen.model.reader import loads
from eomgen.model.shapes import Disc, Rod

TEXT = """
eomgen = 1
name = "Pendulum"
space = "plane"
[parameters]
m = 1.5
l = { value = 40, unit = "cm" }
g = 9.81
[coordinates]
theta = { start = "pi/2", speed = "2*l" }
[points]
O = [0, "l"]
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = "O", point = "start", angle = "theta - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
v = { value = "speed(rod.end)", at = "theta = 0", from = "start" }
"""


def pendulum(**changes) -> Model:
    tables = {
        "name": "Pendulum",
        "space": "plane",
        "parameters": {"m": 1.5, "l": Parameter(value=40, unit="cm"), "g": "9.81"},
        "coordinates": {"theta": Coordinate(start="pi/2", speed="2*l")},
        "points": {"O": [0, "l"]},
        "bodies": {
            "rod": Body(
                shape=Rod(mass="m", length="l"),
                joint=Revolute(at="O", point="start", angle="theta - pi/2"),
            )
        },
        "forces": {"weight": Gravity(acceleration=(0, "-g"))},
        "outputs": {"v": Output(value="speed(rod.end)", at="theta = 0", from_="start")},
    }
    return Model(**{**tables, **changes})


def test_a_model_made_in_python_is_the_model_of_the_file():
    """One value, however it was declared; equal, with equal hashes, and it travels."""
    made, read = pendulum(), loads(TEXT)
    assert made == read and hash(made) == hash(read)
    assert pickle.loads(pickle.dumps(made)) == made


def test_plain_tables_in_python_are_read_like_those_of_a_file():
    """A joint may be a dict with its kind."""
    joint = {"kind": "revolute", "at": "O", "point": "start", "angle": "theta - pi/2"}
    rod = {"shape": {"kind": "rod", "mass": "m", "length": "l"}, "joint": joint}
    assert pendulum(bodies={"rod": rod}) == pendulum()


def test_a_model_cannot_be_changed():
    model = pendulum()
    with pytest.raises(FrozenInstanceError):
        model.name = "other"
    with pytest.raises(TypeError):
        model.parameters["m"] = 2


def test_replacing_a_field_converts_no_unit_twice():
    """A value in SI stays in SI: replace(40 cm, about=...) is 0.4 m still."""
    part = replace(Parameter(value=40, unit="cm"), about="of the rod")
    assert part.value.evaluate({}) == Fraction(2, 5)


def test_mistakes_in_python_are_told_by_their_path():
    """bodies.rod.joint.on, all at once."""
    rod = Body(shape=Rod(mass=-1, length="l"), joint=Revolute(on="rud", angle="theta"))
    with pytest.raises(ModelError) as caught:
        pendulum(bodies={"rod": rod}, outputs={})
    assert [p.where for p in caught.value.problems] == ["bodies.rod.joint.on", "bodies.rod.shape.mass"]


def test_a_part_that_cannot_be_read_says_so_when_it_is_made():
    with pytest.raises(ModelError, match=r"rod\.length: a value is missing after '\*'"):
        Rod(mass=1, length="2*")
    with pytest.raises(ModelError, match=r"nan is not a number"):
        Rod(mass=float("nan"), length=1)


def test_a_float_means_the_decimal_that_it_is_written_as():
    """0.1 is 1/10."""
    assert Rod(mass=0.1, length=1).mass.evaluate({}) == Fraction(1, 10)


def test_points_are_resolved_and_listed():
    """`arm.end` is (body, point), `O` a point of the ground; a joint at `O` knows its coordinates."""
    model = pendulum()
    assert model.resolve_point("rod.end") == ("rod", "end") and model.resolve_point("O") == (None, "O")
    assert model.body_points("rod") == ("origin", "start", "end", "center")
    assert model.bodies["rod"].joint.at == model.points["O"] == model.place("O")


def test_own_points_may_be_written_with_their_body():
    """`rod.start` in the rod's own table and beside `body` is `start`."""
    bodies = {
        "rod": Body(
            shape=Rod(mass="m", length="l"),
            line=("rod.start", "end"),
            joint=Revolute(at="O", point="rod.start", angle="theta - pi/2"),
        )
    }
    load = Distributed(body="rod", between=("start", "rod.end"), intensity=(0, -1))
    model = pendulum(bodies=bodies, forces={"load": load})
    assert model.bodies["rod"].line == ("start", "end") and model.bodies["rod"].joint.point == "start"
    assert model.forces["load"].between == ("start", "end")


def test_parameters_are_exact_until_floats_are_asked():
    """l = 2/5, whatever the order in which expressions of parameters stand."""
    model = pendulum(parameters={"a": "2*l", "m": 1.5, "l": Parameter(value=40, unit="cm"), "g": "a*pi"})
    values = model.exact_parameters()
    assert (values["a"], values["l"]) == (Fraction(4, 5), Fraction(2, 5))
    assert model.numeric_parameters({"l": 1}) == {"a": 2.0, "m": 1.5, "l": 1.0, "g": pytest.approx(6.283185307179586)}


def test_missing_values_are_all_named_and_only_the_needed_ones():
    """A number that nobody gave is an error; a parameter that depends on one is missing too."""
    model = pendulum(parameters={"m": {}, "l": 1, "g": "2*m", "unused": {}})
    with pytest.raises(MissingValues) as caught:
        model.numeric_parameters(needed=("m", "l", "g"))
    assert caught.value.names == ("m", "g")
    assert model.numeric_parameters({"m": 3, "unused": 0})["g"] == 6.0


def test_an_override_of_nothing_is_told():
    with pytest.raises(ModelError, match=r"there is no parameter 'mm'[\s\S]*did you mean 'm'"):
        pendulum().numeric_parameters({"mm": 1})


def test_starts_are_expressions_of_parameters():
    """theta = pi/2, theta' = 2 l; what is not given is 0."""
    q, u = pendulum().start_values()
    assert q == {"theta": pytest.approx(1.5707963267948966)} and u == {"theta'": 0.8}
    assert pendulum().start_values({"l": 3})[1] == {"theta'": 6.0}


@each(
    "law, start",
    [
        ({"motion": "3*sin(2*t) + 1"}, (1.0, 6.0)),
        ({"rate": "5 + t", "start": 2}, (2.0, 5.0)),
        ({"acceleration": "t", "start": 2, "speed": 4}, (2.0, 4.0)),
        ({"dependent": True, "near": 7}, (7.0, 0.0)),
    ],
)
def test_a_driven_coordinate_starts_where_its_law_says(law, start):
    """q(0) = f(0), q'(0) = f'(0) for a motion f."""
    q, u = pendulum(coordinates={"theta": Coordinate(**law)}).start_values()
    assert (q["theta"], u["theta'"]) == start


def test_the_order_of_a_table_is_kept_and_counts():
    """The order of q is a fact about the model."""
    assert Table({"a": 1, "b": 2}) != Table({"b": 2, "a": 1}) and Table({"a": 1}) == {"a": 1}
    assert list(pendulum(parameters={"l": 1, "g": 2, "m": 3}).parameters) == ["l", "g", "m"]


def test_no_kind_waits_for_a_later_version():
    """(where, kind), so that a verb can say what it cannot do; a body made of parts is not among them."""
    piece = Piece(shape=Disc(radius=1), at=[0, 0], hole=True)
    model = pendulum(
        bodies={
            "rod": pendulum().bodies["rod"],
            "plate": Body(mass=1, parts=[Piece(shape=Disc(radius=2)), piece], joint=Placed(at=["theta", 0])),
        },
        constraints={"s": {"kind": "pin", "points": ["rod.end"]}},
        trusses={"T": {"nodes": {"n1": [0, 0], "n2": [1, 0]}, "members": ["n1-n2"]}},
    )
    assert model.unbuilt == ()
    bar = {"kind": "cylindrical", "axis": [0, 0, 1], "displacement": "s", "angle": "q"}
    waiting = Model(
        space="space",
        coordinates={"s": 0, "q": 0},
        bodies={"bar": {"shape": {"kind": "rod", "mass": 1, "length": 1}, "joint": bar}},
        constraints={"g": {"kind": "guide", "point": "bar.end", "along": [1, 0, 0]}},
    )
    assert waiting.unbuilt == waiting.unbuilt_constraints == ()


@each("name", ["simple_pendulum", "stewart_platform", "gerber_beam"])
def test_a_model_and_its_equations_show_themselves_in_one_line(name):
    """In a session: what it is and how large, not all of it."""
    model = eomgen.load(Path(__file__).parent.parent / "models" / f"{name}.toml")
    shown = [repr(model)] if name == "gerber_beam" else [repr(model), repr(eomgen.derive(model))]
    for text in shown:
        assert "\n" not in text and len(text) < 300 and model.name in text
    assert str(len(model.bodies)) in shown[0]
