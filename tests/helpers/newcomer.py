"""More than a hundred mistakes of a newcomer, none of them in the other tables, and the word that fixes each."""

from __future__ import annotations

from collections.abc import Callable

CRANE = """eomgen = 1
name = "crane"
space = "plane"
[parameters]
M = { value = 5, unit = "kg" }
m = { value = 2, unit = "kg" }
l = { value = 1.2, unit = "m" }
k = { value = 20, unit = "N/m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { start = 0, unit = "m" }
phi = { start = 20, unit = "deg" }
[bodies.trolley]
mass = "M"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k" }
[bodies.boom]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "trolley", angle = "phi - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
a = "phi''"
"""
IN_FILES = {
    # what is meant: (text, what a newcomer writes instead, what the message has in it)
    "the version as a text": ("eomgen = 1", 'eomgen = "1"', "eomgen = 1"),
    "a version of the package": ("eomgen = 1", 'eomgen = "0.1.0"', "eomgen = 1"),
    "the dimension as a number": ('space = "plane"', "space = 2", "plane"),
    "2D": ('space = "plane"', 'space = "2D"', "plane"),
    "3D": ('space = "plane"', 'space = "3d"', "space"),
    "no space at all": ('space = "plane"\n', "", "space"),
    "a body's name in capitals": ('on = "trolley"', 'on = "Trolley"', "did you mean 'trolley'"),
    "a table in the singular": ("[bodies.boom]", "[body.boom]", "did you mean 'bodies'"),
    "bodies without names": ("[bodies.boom]", "[[bodies]]", "[bodies.boom]"),
    "a blank in a name": ("[bodies.boom]", '[bodies."long boom"]', "name"),
    "a hyphen in a name": ("[bodies.boom]", "[bodies.long-boom]", "name"),
    "a coordinate for the start": ("start = 20", 'start = "x"', "start"),
    "a start in radians by sign": ('start = 20, unit = "deg"', 'start = "20°"', "deg"),
    "degrees in full": ('unit = "deg"', 'unit = "degrees"', "deg"),
    "radians in full": ('unit = "deg"', 'unit = "radians"', "rad"),
    "seconds in full": ('unit = "N/m"', 'unit = "N*sec/m"', "s"),
    "a dot for a product of units": ('unit = "N/m"', 'unit = "kg.m/s^2"', "*"),
    "Newton in full": ('unit = "N/m"', 'unit = "Newton/m"', "N"),
    "the mass as a text of its unit": ('mass = "M"', 'mass = "5kg"', 'unit = "kg"'),
    "the mass twice": ('mass = "m", length', 'mass = "m", m = "m", length', "unknown key 'm'"),
    "the length by one letter": ('length = "l"', 'l = "l"', "length"),
    "a bar": ('kind = "rod"', 'kind = "bar"', "rod"),
    "a box in the plane": ('kind = "rod", mass = "m", length = "l"', 'kind = "box", mass = "m", length = "l"', "box"),
    "a point mass": ('kind = "rod", mass = "m", length = "l"', 'kind = "point", mass = "m"', "particle"),
    "a pin for a joint": ('kind = "revolute"', 'kind = "pin"', "revolute"),
    "a rotation": ('kind = "revolute"', 'kind = "rotational"', "revolute"),
    "a translation": ('kind = "prismatic"', 'kind = "translational"', "prismatic"),
    "an axis by its letter": ("axis = [1, 0]", 'axis = "x"', "[1, 0]"),
    "an axis of three components": ("axis = [1, 0]", "axis = [1, 0, 0]", "2 components"),
    "theta for the angle": ('angle = "phi - pi/2"', 'theta = "phi - pi/2"', "angle"),
    "the coordinate's key": ('displacement = "x"', 'coordinate = "x"', "displacement"),
    "degrees into sin": ("\"phi''\"", '"sin(30 deg)"', "pi/6"),
    "a dot above by a dot": ("\"phi''\"", '"phi.dot"', "phi'"),
    "three primes": ("\"phi''\"", "\"phi'''\"", "two primes"),
    "an arcsine by its short name": ("\"phi''\"", '"arcsin(x/l)"', "asin"),
    "the logarithm": ("\"phi''\"", '"ln(x)"', "log"),
    "absolute bars": ("\"phi''\"", '"|phi|"', "abs"),
    "a square root by its sign": ("\"phi''\"", '"√(x)"', "sqrt"),
    "a power in Python": ("\"phi''\"", '"pow(phi, 2)"', "write phi^2"),
    "a module of Python": ("\"phi''\"", '"np.sin(phi)"', "write sin(...)"),
    "brackets for parentheses": ("\"phi''\"", '"2*[phi + 1]"', "round parentheses"),
    "an output without quotes": ("\"phi''\"", "phi", "quotes"),
    "curly quotes": ("\"phi''\"", "“phi”", '"'),
    "gravity as one number": ('[0, "-g"]', '"g"', "["),
    "a semicolon at the end": ("eomgen = 1", "eomgen = 1;", "leave it out"),
    "a remark in C": ("eomgen = 1", "eomgen = 1 // version", "#"),
    "a semicolon in a list": ("axis = [1, 0]", "axis = [1; 0]", "a comma stands between two of a list"),
    "a name without quotes": ('space = "plane"', "space = plane", 'space = "plane"'),
    "quotes of a book": ('space = "plane"', "space = “plane”", "quotes are straight"),
    "a coordinate as a function of time": ("\"phi''\"", '"phi(t)"', "phi"),
    "degrees by their sign in a formula": ("phi - pi/2", "phi - 90°", "write pi/2"),
    "an instant by two signs": ("a = \"phi''\"", 'a = { value = "phi", at = "t == 3" }', "an equation has one ="),
    "an instant by an inequality": (
        "a = \"phi''\"",
        'a = { value = "phi", at = "t > 3" }',
        "an instant is an equation",
    ),
    "a condition as in C": ("\"phi''\"", '"phi ? 1 : 0"', "max, min, abs, sign"),
    "a function without its brackets": ("\"phi''\"", '"kinetic_energy"', "kinetic_energy(...)"),
    "a force without a name": ("[forces.weight]", "[forces]", "[forces.NAME]"),
    "a value for a name": ("eomgen = 1", "eomgen: 1", "="),
    "a minus of a book": ("start = 20", "start = \u221220", "write -"),
    "a minus of a book in a formula": ("phi - pi/2", "phi \u2212 pi/2", "write -"),
    "thousands with a point": ("value = 5,", "value = 5.000,0,", "5000.0"),
    "a blank that is none": ("space = ", "space\u00a0= ", "U+00A0"),
    "a letter that is not seen": ("\"phi''\"", '"phi\u200b"', "U+200B"),
    "wide figures": ("\"phi''\"", '"\uff12*phi"', "write 2"),
    "a control character": ("[outputs]", "\x00[outputs]", "U+0000"),
    "lines that end in CR alone": (CRANE, CRANE.replace("\n", "\r"), "LF or CRLF"),
    "another format, JSON": (CRANE, '{"eomgen": 1, "space": "plane"}', "JSON"),
    "another format, XML": (CRANE, '<robot name="crane"/>', "eomgen import"),
    "another format, Python": (CRANE, "import eomgen", "Python"),
    "another format, an archive": (CRANE, "PK\x03\x04", "no text"),
    "a text that does not end": ('"phi - pi/2"', '"phi - pi/2', "its quote"),
    "a comma too many": ('displacement = "x", stiffness = "k" }', 'displacement = "x", }', "leave out the comma"),
    "round brackets of a list": ('[0, "-g"]', '(0, "-g")', "[0, 1]"),
    "round brackets of a head": ("[outputs]", "(outputs)", "[outputs]"),
    "brackets of two kinds": ('"phi - pi/2"', '"(phi - pi/2]"', "round parentheses"),
    "a path of Windows": ("eomgen = 1", 'eomgen = 1\nsource = "C:\\Users\\crane"', "single quotes"),
    "a line that is no assignment": ("[outputs]", "outputs\n[outputs]", "NAME = VALUE"),
    "a share in percent": ("\"phi''\"", '"5%*phi"', "/100"),
    "a factorial": ("\"phi''\"", '"phi!"', "factorial"),
    "a body that hangs on itself": ('on = "trolley"', 'on = "boom.end"', "hang on the ground"),
    "bodies in a ring": ('kind = "prismatic", axis', 'kind = "prismatic", on = "boom", axis', "ring"),
    "parameters in a ring": ('k = { value = 20, unit = "N/m" }', 'k = "c"\nc = "k"', "ring"),
    "a name for two things": ("m = { value = 2", "phi = { value = 2", "another name"),
    "time as a parameter": ("k = { value", "t = { value", "reserved"),
    "a coordinate that is driven twice": ('x = { start = 0, unit = "m" }', 'x = { motion = "t", rate = "1" }', "twice"),
    "an axis without a length": ("axis = [1, 0]", "axis = [0, 0]", "direction"),
    "a truth for a number": ("value = 9.81", "value = true", "number"),
    "a date for a number": ("value = 9.81", "value = 2024-01-01", "number"),
    "weight for mass": ('m = { value = 2, unit = "kg" }', 'm = { value = 2, unit = "N" }', "kg"),
    "another file of the model": ("eomgen = 1", 'eomgen = 1\ninclude = "other.toml"', "unknown key"),
}
"""of the model file"""
IN_COMMANDS = {
    "a verb in other words": (["run", "MODEL"], "simulate"),
    "the model's name without its ending": (["derive", "model"], "does not exist"),
    "a value by a colon": (["derive", "MODEL", "--set", "m:3"], "--set m=2"),
    "a value of what is no parameter": (["derive", "MODEL", "--set", "mass=3"], "mass"),
    "a start of a parameter": (["derive", "MODEL", "--start", "m=3"], "--set"),
    "a parameter of a coordinate": (["derive", "MODEL", "--set", "phi=3"], "--start"),
    "a model called like a page": (["new", "crane.html"], ".toml"),
    "a method that there is not, of many runs": (
        ["sweep", "MODEL", "--over", "m=1,2", "--ask", "max(phi)", "--method", "euler"],
        "euler",
    ),
    "a name that is set and swept": (
        ["sweep", "MODEL", "--over", "m=1,2", "--set", "m=3", "--ask", "max(phi)"],
        "set twice",
    ),
    "a view of no picture": (["simulate", "MODEL", "--view", "phase"], "--plot"),
    "a moving picture of no time": (["animate", "MODEL", "-o", "OUT.gif", "--time", "0"], "0 s"),
    "a slider that goes back": (["play", "MODEL", "-o", "OUT.html", "--slider", "m=2:1"], "ends before"),
    "a section that is wanted and left out": (
        ["report", "MODEL", "-o", "OUT.md", "--with", "motion", "--without", "motion"],
        "motion",
    ),
    "a time in a unit of length": (["simulate", "MODEL", "--time", "5m"], "5m"),
    "a time that goes back": (["simulate", "MODEL", "--time", "-1"], "time"),
    "an end without an equation": (["simulate", "MODEL", "--until", "phi"], "="),
    "a method of another program": (["simulate", "MODEL", "--method", "ode45"], "RK45"),
    "a picture into a table": (["simulate", "MODEL", "-o", "run.png"], ".csv"),
    "a view of no picture, of small motions": (["linearize", "MODEL", "--view", "bode"], "--plot"),
    "chance where nothing is drawn": (["sweep", "MODEL", "--over", "m=1,2", "--ask", "phi", "--seed", "3"], "--random"),
    "how nothing is drawn": (["sweep", "MODEL", "--over", "m=1,2", "--ask", "phi", "--design", "lhs"], "--random"),
    "instants of no replay": (["sweep", "MODEL", "--over", "m=1,2", "--ask", "phi", "--samples", "9"], "--replay"),
    "heads of no table": (["simulate", "MODEL", "--units"], "-o"),
    "a strip that moves": (["animate", "MODEL", "-o", "OUT.gif", "--frames", "3"], ".png"),
    "a rate of a page": (["animate", "MODEL", "-o", "OUT.html", "--fps", "9"], ".gif"),
    "frames without end": (["animate", "MODEL", "-o", "OUT.gif", "--fps", "inf"], "1000"),
    "a picture faster than its format": (["animate", "MODEL", "-o", "OUT.gif", "--fps", "60"], "--fps 50"),
    "a time for small motions": (["animate", "MODEL", "-o", "OUT.gif", "--modes", "1", "--time", "3"], "--modes"),
    "a model for the list of languages": (["codegen", "MODEL", "--list"], "leave that out"),
    "units of a difference": (["derive", "MODEL", "--diff", "MODEL", "--units"], "--diff"),
    "a language by its ending": (["codegen", "MODEL", "--target", "py", "-o", "OUT"], "numpy"),
}
"""of the command line"""


def of_python() -> dict[str, tuple[Callable[[], object], str]]:
    """Of Python: (what is called, what the message has in it)."""
    import eomgen

    model = eomgen.loads(CRANE)
    return {
        "a file that is not there": (lambda: eomgen.derive("cranes.toml"), "cranes.toml"),
        "the text for the path": (lambda: eomgen.load(CRANE), "loads"),
        "a parameter that is none": (lambda: eomgen.derive(model, parameters={"mass": 3}), "mass"),
        "a unit that does not fit": (lambda: eomgen.derive(model, parameters={"m": (3, "m")}), "does not fit"),
        "a method by the wrong man": (lambda: eomgen.derive(model, method="newton"), "lagrange"),
        "a time of zero length": (lambda: eomgen.simulate(model, time=-1), "time"),
        "a time in a unit of mass": (lambda: eomgen.simulate(model, time="5 kg"), "5 s"),
        "a number of instants that is none": (lambda: eomgen.simulate(model, time=1, samples="3"), "how many"),
        "a tolerance as a text": (lambda: eomgen.simulate(model, time=1, rtol="1e-9"), "positive"),
        "an instant as a number": (lambda: eomgen.reactions(model, at=5), "theta = pi/2"),
        "an end as a number": (lambda: eomgen.simulate(model, time=1, until=5), "theta = pi/2"),
        "a number for a model": (lambda: eomgen.derive(0), "eomgen.load"),
        "nothing for a model": (lambda: eomgen.derive(None), "eomgen.load"),
    }
