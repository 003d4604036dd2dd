"""Prints the model of an n-link chain of rods in relative angles: python models/chain.py 20 > models/chain20.toml"""

from __future__ import annotations

import sys


def chain(n: int) -> str:
    """The model file of n rods hinged end to start, the first one to the ground; q1 from the downward vertical."""
    lines = ["eomgen = 1", f"name = 'Chain of {n} rods'", "space = 'plane'", "", "[parameters]", "g = 9.81"]
    for i in range(1, n + 1):
        lines += [f"m{i} = 1.0", f"l{i} = 0.5"]
    lines += ["", "[coordinates]", *(f"q{i} = 0.1" for i in range(1, n + 1))]
    for i in range(1, n + 1):
        at = 'at = [0, 0], angle = "q1 - pi/2"' if i == 1 else f'on = "rod{i - 1}.end", angle = "q{i}"'
        lines += ["", f"[bodies.rod{i}]", f'shape = {{ kind = "rod", mass = "m{i}", length = "l{i}" }}']
        lines += [f'joint = {{ kind = "revolute", {at} }}']
    lines += ["", "[forces.weight]", 'kind = "gravity"', 'acceleration = [0, "-g"]']
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(chain(int(sys.argv[1]) if len(sys.argv) > 1 else 3))
