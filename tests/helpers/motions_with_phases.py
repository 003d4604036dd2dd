"""Models whose contacts change, of every kind whose phases run in C, by name."""

from __future__ import annotations

from pathlib import Path

import eomgen
from eomgen import Model

MODELS = Path(__file__).parent.parent.parent / "models"

BLOCK = """
eomgen = 1
space = "plane"
coordinates.s = 0
[parameters]
mu = 0.5
[bodies]
block = { shape = { kind = "particle", mass = 2 }, joint = { kind = "placed", at = ["s", 0] } }
[constraints]
floor = { kind = "support", point = "block.center", normal = [0, 1], friction = "mu" }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
push = { kind = "force", point = "block.center", force = ["11.772*sin(2*pi*t)", 0] }
"""

FUNNEL = """
eomgen = 1
space = "plane"
coordinates = { x = 0.3, y = { start = 1, speed = -1 } }
[parameters]
e = 0.9
[bodies]
ball = { shape = { kind = "particle", mass = 1 }, joint = { kind = "placed", at = ["x", "y"] } }
[constraints.left]
kind = "support"
point = "ball.center"
normal = [1, 1]
at = [0, 0]
unilateral = true
restitution = "e"
[constraints.right]
kind = "support"
point = "ball.center"
normal = [-1, 2]
at = [0, 0]
unilateral = true
restitution = 0.7
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""

HOPPER = """
eomgen = 1
space = "plane"
coordinates = { y = 0.4, l = 0.5 }
[parameters]
k = 2000
[bodies]
foot = { shape = { kind = "particle", mass = 0.5 }, joint = { kind = "placed", at = [0, "y"] } }
body = { shape = { kind = "particle", mass = 2 }, joint = { kind = "placed", at = [0, "y + l"] } }
[constraints]
floor = { kind = "support", point = "foot.center", normal = [0, 1], at = [0, 0], unilateral = true }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
leg = { kind = "spring", points = ["foot.center", "body.center"], stiffness = "k", length = 0.5 }
loss = { kind = "damper", points = ["foot.center", "body.center"], damping = 5 }
"""

ARM = """
eomgen = 1
space = "plane"
coordinates = { a = { start = 1, speed = 2 }, b = -0.5 }
[parameters]
T = 1.5
[bodies.upper]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", angle = "a - pi/2", friction = { torque = "T" } }
[bodies.lower]
shape = { kind = "rod", mass = 1, length = 0.7 }
joint = { kind = "revolute", on = "upper.end", angle = "b", friction = { torque = 0.8 } }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""

CRANK = """
eomgen = 1
space = "plane"
coordinates = { phi = { start = 1, speed = 3 }, psi = { dependent = true, near = -0.3 } }
[parameters]
x_0 = 0.85
[bodies]
crank = { shape = { kind = "rod", mass = 1, length = 0.3 }, joint = { kind = "revolute", angle = "phi" } }
[bodies.rod]
shape = { kind = "rod", mass = 1, length = 0.7 }
joint = { kind = "revolute", on = "crank.end", angle = "psi - phi" }
[constraints]
slot = { kind = "support", point = "rod.end", normal = [0, 1], at = [0, 0] }
[constraints.stop]
kind = "support"
point = "rod.end"
normal = [-1, 0]
at = ["x_0", 0]
unilateral = true
restitution = 0.5
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""

WRITTEN = {"block": BLOCK, "funnel": FUNNEL, "hopper": HOPPER, "arm": ARM, "crank": CRANK}
FILES = ("bouncing_ball", "pendulum_on_stop", "stick_slip", "sliding_ladder", "bowling_ball")
TIMES = {"block": 1.2, "funnel": 1.2, "hopper": 1.5, "arm": 3.0, "crank": 1.5, "bouncing_ball": 1.7, "stick_slip": 4.0}
NAMES = (*WRITTEN, *FILES)


def model_with_phases(name: str) -> Model:
    """One of them, written here or from models/."""
    return eomgen.loads(WRITTEN[name]) if name in WRITTEN else eomgen.load(MODELS / f"{name}.toml")


def duration(name: str) -> float:
    """How long it moves through phases that are well apart [s]."""
    return TIMES.get(name, 2.0)
