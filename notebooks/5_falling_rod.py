# %% [markdown]
# # 5 · What the hinge of a falling rod carries
#
# A rod on a hinge falls from the horizontal. At the bottom the hinge carries more than the weight, at the start
# less. How much?

# %%
import eomgen

model = eomgen.loads("""
eomgen = 1
name = "Falling rod"
space = "plane"

[parameters]
m = { value = 2.0, unit = "kg" }
l = { value = 0.6, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
theta = { start = 0, unit = "rad", about = "rod below the horizontal" }

[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }

[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]

[outputs]
below = { value = "reaction_y(rod)", at = "theta = pi/2", from = "rest" }
""")
model

# %% [markdown]
# ## As a problem of equilibrium
#
# The rod is cut free from its hinge. By d'Alembert's principle its weight, the force of the hinge, the inertia
# force and the inertia couple are in equilibrium. The moments about the hinge give the equation of motion, the
# forces give the reaction.

# %%
equations = eomgen.derive(model, method="kinetostatic")
equations

# %% [markdown]
# ## At the bottom, exactly
#
# The file asks for the vertical force where the rod hangs down. The energy theorem gives the speed there, so no
# integration over time is needed: the hinge carries 5/2 of the weight.

# %%
answers = eomgen.solve(model)
assert answers["below"].exact == "5/2*m*g"
assert answers["below"].method == "energy theorem"
answers

# %% [markdown]
# ## Along the motion
#
# In a simulation each reaction is a column of numbers. At the start the hinge carries a quarter of the weight.

# %%
run = eomgen.simulate(model, time=0.8)
weight = 2.0 * 9.81
assert abs(run["reaction_y(rod)"][0] - weight / 4) < 1e-9
assert abs(run["reaction_y(rod)"].max() - 5 / 2 * weight) < 1e-3 * weight
run.plot()

# %% [markdown]
# The same force by size and direction: this is what the bearing has to take. The dot is the start.

# %%
run.plot(view="polar")

# %% [markdown]
# The motion at a quarter of its speed. The green arrow is the force of the hinge on the rod:

# %%
from IPython.display import Image

run.animate("rod.gif", fps=10, speed=0.25, forces=True)
Image("rod.gif", alt="The rod falls; an arrow shows the force")

# %% [markdown]
# Next: [a closed loop in space](6_closed_loop.ipynb).
