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
# # Mechanisms at one instant, relative motion, moments of inertia
#
# A crank turns; a rod leads from it to a slider. The position is that of the drawing, no coordinate is needed.

# %%
import eomgen

linkage = eomgen.loads("""
eomgen = 1
name = "Crank, rod and slider"
space = "plane"

[bodies.crank]
points = { O = [0, 0], A = [3, 4] }

[bodies.rod]
points = { A = [3, 4], B = [15, -1] }

[constraints]
O = { kind = "pin", points = ["crank.O"] }
A = { kind = "pin", points = ["crank.A", "rod.A"] }
B = { kind = "support", point = "rod.B", normal = [0, 1] }

[given]
velocity = "omega(crank) = 2"
acceleration = "epsilon(crank) = 0"

[outputs]
x_C = "rotation_center_x(rod)"
y_C = "rotation_center_y(rod)"
omega = "omega(rod)"
v_B = "vx(rod.B)"
a_B = "ax(rod.B)"
""")
linkage

# %% [markdown]
# Its velocities, the centres of rotation, and the diagrams of the projections:

# %%
motion = eomgen.kinematics(linkage)
motion.picture

# %% [markdown]
# The rod turns about the point where the line of the crank meets the normal of the slide. From there the speeds follow
# as in a drawing: v_A = 2 * 5, and A is 20 from the centre of the rod.

# %%
motion

# %%
answers = {name: answer.exact for name, answer in eomgen.solve(linkage).items()}
assert (answers["x_C"], answers["y_C"]) == ("15", "20")
assert answers["omega"] == "-1/2"  # 10/20, the other way round
assert answers["v_B"] == "-21/2"  # B is 21 below the centre
answers

# %% [markdown]
# ## Relative motion
#
# A collar slides along a bar that turns. Transport, relative and Coriolis part of its acceleration:

# %%
from pathlib import Path

here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
collar = eomgen.loads("""
eomgen = 1
name = "Collar on a turning bar"
space = "plane"

[parameters]
w = { value = 3, unit = "rad/s" }
c = { value = 0.5, unit = "m/s" }

[coordinates]
theta = { motion = "w*t" }
s = { motion = "c*t" }

[bodies.bar]
joint = { kind = "revolute", angle = "theta" }
points = { end = [2, 0] }

[bodies.collar]
joint = { kind = "prismatic", on = "bar", axis = [1, 0], displacement = "s" }

[outputs]
a_C = "coriolis_ay(collar.origin, bar, bar)"
""")
answers = eomgen.solve(collar)
assert answers["a_C"].exact == "2*w*c"
answers["a_C"]

# %% [markdown]
# Both coordinates are driven, and the collar draws a spiral.

# %%
eomgen.simulate(collar, time=2).animate(trail="collar.origin")

# %%
eomgen.kinematics(collar, at="t = 1", relative=[("collar.origin", "bar")])

# %% [markdown]
# ## Moments of inertia of a composite
#
# A plate with a wing and a hole; its mass is that of the net whole, so the density follows from the net area.

# %%
plate = eomgen.inertia(eomgen.load(here.parent / "models" / "seeds" / "ch13_p2.toml"), about="O", axis="O,D")
plate.picture

# %% [markdown]
# The tensor has minus the products, the textbooks' J_xy plus: both are given, under names of their own.

# %%
assert plate["J_xy(O)"].value == -plate["I_xy(O)"].value
plate
