# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Structures at rest: virtual work, influence lines, trusses
#
# A frame of two bodies stands on two hinges. No coordinates: the bodies stand where their points are.

# %%
import eomgen

frame = eomgen.loads("""
eomgen = 1
name = "Portal with three hinges"
space = "plane"

[parameters]
P = { value = 12, unit = "kN" }
q = { value = 3, unit = "kN/m" }
a = { value = 2, unit = "m" }

[bodies.left]
points = { A = [0, 0], corner = [0, "2*a"], C = ["2*a", "2*a"] }

[bodies.right]
points = { C = ["2*a", "2*a"], knee = ["4*a", "2*a"], B = ["4*a", 0] }

[constraints]
A = { kind = "pin", points = ["left.A"] }
B = { kind = "pin", points = ["right.B"] }
C = { kind = "pin", points = ["left.C", "right.C"] }

[forces]
wind = { kind = "force", point = "left.corner", force = ["P", 0] }
roof = { kind = "distributed", body = "right", between = ["C", "knee"], intensity = [0, "-q"] }
""")
found = eomgen.statics(frame)
found.picture

# %% [markdown]
# Every reaction has been found twice, by virtual work and by the balance of the bodies. They agree, exactly.

# %%
assert found.ok
found.exact

# %% [markdown]
# ## One reaction by virtual work
#
# Without the thrust at A the frame is a mechanism: this is how it moves.

# %%
eomgen.virtual_displacement(frame, "reaction_x(A)")

# %% [markdown]
# The angles, the centres, the works of the loads, and the equation:

# %%
thrust = eomgen.statics(frame, reaction="reaction_x(A)")
thrust

# %% [markdown]
# The left part turns about a point above A, since A can only slide; C moves across the line from there, which goes
# through B as well: the right part turns by the same angle in the other sense. By hand, from moments about B, and of
# the left part about C:

# %%
P, q, a = 12_000.0, 3_000.0, 2.0
A_y = (2 * q * a * a - P * 2 * a) / (4 * a)
A_x = A_y * 2 * a / (2 * a)
assert abs(found.values["reaction_y(A)"] - A_y) < 1e-6
assert abs(found.values["reaction_x(A)"] - A_x) < 1e-6

# %% [markdown]
# ## An influence line
#
# A unit load travels along a beam with an inner hinge: how does the couple of the clamp depend on where it stands? The
# line is the displacement of the mechanism that is left without that couple; nothing is sampled.

# %%
from pathlib import Path

here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
beam = eomgen.load(here.parent / "models" / "gerber_beam.toml")
line = eomgen.statics(beam, reaction="reaction_couple(E)", influence="reaction_couple(E)")
assert line.exact["reaction_couple(E)"] == "-20*p*a^2"
line.picture

# %%
line.as_dict()["influence"]

# %% [markdown]
# ## A truss
#
# Members are two-force bars, tension is positive.

# %%
truss = eomgen.statics(eomgen.load(here.parent / "models" / "fink_truss.toml"), reaction="tension(roof, L-R)")
truss.picture

# %% [markdown]
# The bar that is cut lets the two halves of the roof turn against each other:

# %%
eomgen.virtual_displacement(here.parent / "models" / "fink_truss.toml", "tension(roof, L-R)")

# %% [markdown]
# ## Something that can move
#
# A structure that does not stand is an error that names what moves, and how.

# %%
import dataclasses

loose = dataclasses.replace(
    frame, constraints={name: constraint for name, constraint in frame.constraints.items() if name != "B"}
)
try:
    eomgen.statics(loose)
except eomgen.DerivationError as error:
    print(error)

# %% [markdown]
# A system with coordinates is free to move. Then the equilibria are asked, and whether they are stable.

# %%
eomgen.statics(eomgen.load(here.parent / "models" / "elastic_pendulum.toml"))
