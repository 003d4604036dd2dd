"""Prints the model of a row of n four-bars: python models/four_bars.py 2 > row.toml (IFToMM benchmark A02 is n = 2)"""

from __future__ import annotations

import sys


def four_bars(n: int) -> str:
    """The model file of n + 1 equal cranks side by side on the ground, a coupler between each and the next: n loops."""
    lines = ["eomgen = 1", f"name = 'Row of {n} four-bars'", "space = 'plane'", ""]
    lines += ["[parameters]", "m = 1", "L = 1", "g = 9.81", "", "[coordinates]"]
    lines += [f"a{i} = {{ start = 'pi/3', speed = -1 }}" for i in range(n + 1)] + [f"b{i} = 0" for i in range(n)]
    rod = "shape = { kind = 'rod', mass = 'm', length = 'L' }"
    for i in range(n + 1):
        lines += ["", f"[bodies.crank{i}]", rod]
        lines += [f"joint = {{ kind = 'revolute', at = ['{i}*L', 0], angle = 'a{i}' }}"]
    for i in range(n):
        lines += ["", f"[bodies.coupler{i}]", rod]
        lines += [f"joint = {{ kind = 'revolute', on = 'crank{i}.end', angle = 'b{i} - a{i}' }}"]
        lines += ["", f"[constraints.pin{i}]", "kind = 'pin'", f"points = ['coupler{i}.end', 'crank{i + 1}.end']"]
    lines += ["", "[forces.weight]", "kind = 'gravity'", "acceleration = [0, '-g']"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(four_bars(int(sys.argv[1]) if len(sys.argv) > 1 else 2))
