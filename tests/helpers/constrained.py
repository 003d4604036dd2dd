"""Systems written from short pieces of text, for the laws of constraints; and the velocities of their material
points."""

from __future__ import annotations

import numpy as np
from moving import State, at, rate, solved, written

from eomgen.mechanics.dynamics.system import System

m, g, R, l = 2.0, 10.0, 0.5, 0.7  # the parameters of every model here
GIVEN = {"m": m, "g": g, "R": R, "l": l}
HEAD = """
[parameters]
m = 2
g = 10
R = 0.5
l = 0.7
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def system_with(text: str, **coordinates: object) -> System:
    """The parameters, the weight, the coordinates with their starts, and the text."""
    starts = "\n".join(f"{name} = {start}" for name, start in coordinates.items())
    return written(f"{HEAD}\n[coordinates]\n{starts}\n{text}")


def block(name: str, x: str, y: str, angle: str, mass: str = "m") -> str:
    """A body with inertia m l^2 that is free in the plane, its coordinates named, with a point P beside its centre."""
    return f"""
[bodies.{name}]
mass = "{mass}"
inertia = "m*l^2"
points = {{ P = ["-l", 0] }}
joint = {{ kind = "free", x = "{x}", y = "{y}", angle = "{angle}" }}
"""


def particle(name: str, x: str, y: str, mass: str = "m") -> str:
    shape = f'shape = {{ kind = "particle", mass = "{mass}" }}'
    return f'[bodies.{name}]\n{shape}\njoint = {{ kind = "placed", at = ["{x}", "{y}"] }}\n'


def disc(name: str, joint: str, mass: str = "m", radius: str = "R") -> str:
    shape = f'shape = {{ kind = "disc", mass = "{mass}", radius = "{radius}" }}'
    return f"[bodies.{name}]\n{shape}\njoint = {{ {joint} }}\n"


def constraint(kind: str, fields: str, name: str = "constraint") -> str:
    return f'[constraints.{name}]\nkind = "{kind}"\n{fields}\n'


AXLE = 'kind = "revolute", angle = "a"'
FREE = 'kind = "free", x = "x", y = "y", angle = "a"'


def accelerations(system: System, **values: float) -> tuple[dict[str, float], dict[str, float]]:
    """Accelerations by the names of the coordinates and multipliers by their labels, at a state."""
    a, lam = solved(system, GIVEN | values)
    names = [q.name for q in system.symbols.q]
    return dict(zip(names, a, strict=True)), {
        r.label[4:-1]: x for r, x in zip(system.constraints.closing, lam, strict=True)
    }


def frozen_velocity(system: System, body: str | None, place: np.ndarray, state: State) -> np.ndarray:
    """Velocity of the material point of a body that is at a place of the ground, by differences of poses."""
    if body is None:
        return np.zeros(3)
    pose = system.motion.link(body).pose
    flat = [*pose.p, *(x for line in pose.R for x in line)]
    values = at(flat, state)
    p, turned = values[:3], values[3:].reshape(3, 3)
    rates = rate(system, flat, state)
    return rates[:3] + rates[3:].reshape(3, 3) @ (turned.T @ (place - p))
