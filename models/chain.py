"""Prints the model of an n-link chain of rods in relative angles: python models/chain.py 20 > models/chain20.toml"""

from __future__ import annotations

import sys


def chain(n: int) -> str:
    """The model file of n rods hinged end to start, the first one to the ground; q1 from the downward vertical."""
    return f"""\
eomgen = 1
name = 'Chain of {n} rods'
space = 'plane'
forces.weight = {{ kind = "gravity", acceleration = [0, "-g"] }}

[repeat]
i = {n}
k = [2, {n}]

[parameters]
g = 9.81
"m{{i}}" = 1.0
"l{{i}}" = 0.5

[coordinates]
"q{{i}}" = 0.1

[bodies.rod1]
shape = {{ kind = "rod", mass = "m1", length = "l1" }}
joint = {{ kind = "revolute", at = [0, 0], angle = "q1 - pi/2" }}

[bodies."rod{{k}}"]
shape = {{ kind = "rod", mass = "m{{k}}", length = "l{{k}}" }}
joint = {{ kind = "revolute", on = "rod{{k-1}}.end", angle = "q{{k}}" }}
"""


if __name__ == "__main__":
    sys.stdout.write(chain(int(sys.argv[1]) if len(sys.argv) > 1 else 3))
