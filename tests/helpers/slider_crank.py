"""A driven slider-crank whose pin force cancels in exact forms at nice angles: outputs are added by who asks."""

SLIDER_CRANK = """
eomgen = 1
space = "plane"
[parameters]
r = 0.24
L = 0.35
w = 110
m = 0.9
[coordinates]
a = { rate = "w" }
phi = { dependent = true }
s = { dependent = true, near = "r + L" }
[bodies.crank]
points = { A = ["r", 0] }
joint = { kind = "revolute", angle = "a" }
[bodies.rod]
points = { B = ["L", 0] }
joint = { kind = "revolute", on = "crank.A", angle = "phi" }
[bodies.piston]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
[constraints.B]
kind = "pin"
points = ["rod.B", "piston.center"]
[outputs]
"""
