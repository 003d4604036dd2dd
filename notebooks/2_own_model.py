# %% [markdown]
# # 2 · A model of your own
#
# A bar turns about a hinge and carries a collar that slides along it. You write this as text, see whether it is
# what you meant, and compare one result with a calculation by hand.

# %%
import eomgen

text = r"""
eomgen = 1
name = "Bar with a sliding collar"
space = "plane"

[parameters]
M = { value = 1, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
theta = { start = 20, unit = "deg", about = "below the horizontal", symbol = '\varphi' }
r = { start = 0.3, unit = "m", about = "collar from the hinge" }

[bodies.bar]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }

[bodies.collar]
shape = { kind = "particle", mass = "2*M" }
joint = { kind = "prismatic", on = "bar", axis = [1, 0], displacement = "r" }

[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]

[outputs]
Q_theta = "generalized_force(theta)"
theta_dd = "theta''"
"""
model = eomgen.loads(text)
model

# %% [markdown]
# Each body hangs by one joint, on the ground or on another body. The picture shows the start.
#
# ## A mistake is shown where it stands
#
# Here the collar is put on a body that does not exist. The message shows the place, and what was probably
# meant.

# %%
try:
    eomgen.loads(text.replace('on = "bar"', 'on = "bra"'))
except eomgen.ModelError as error:
    print(error)

# %% [markdown]
# ## The equations of motion
#
# The file calls the angle `theta` and gives it the symbol φ, which stands in all formulas.

# %%
equations = eomgen.derive(model)
equations

# %% [markdown]
# ## The questions of the file
#
# `[outputs]` holds questions: the generalized force of the angle, and the angular acceleration. Each answer is
# a formula with its value at the start.

# %%
eomgen.solve(model)

# %% [markdown]
# ## The same by hand
#
# The weight $3Mg$ of the bar acts at the distance $l$ along the bar, the weight $2Mg$ of the collar at the
# distance $r$. Their moment about the hinge is the generalized force of the angle. Results are sympy
# expressions, so both can be compared exactly.

# %%
import sympy

names = "M", "l", "g", "r", "theta"
M, l, g, r, theta = (equations.symbols[name] for name in names)
by_hand = (3 * M * g * l + 2 * M * g * r) * sympy.cos(theta)
assert sympy.expand(equations.Q[0] - by_hand) == 0
by_hand

# %% [markdown]
# ## What happens
#
# The bar falls, and the collar slides outwards. The bar has no end stop: the collar goes on along its line.

# %%
from IPython.display import Image

eomgen.simulate(model, time=0.6).animate("collar.gif", fps=10, speed=0.25)
Image("collar.gif", alt="The bar turns down and the collar slides outwards")

# %% [markdown]
# Next: [what holds a frame up](3_virtual_work.ipynb).
