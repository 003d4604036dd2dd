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
# # A model of one's own, and an answer checked by hand
#
# A bar on a rotating hinge carries a sliding collar. The model is text; every number stays exact.

# %%
import eomgen

text = r"""
eomgen = 1
name = "Bar with a sliding collar"
space = "plane"

[parameters]
M = 1.0
l = 0.5
g = 9.81

[coordinates]
theta = { start = 0, about = "bar below the horizontal, clockwise", symbol = '\varphi' }
r = { start = 0.3, about = "collar from the hinge" }

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
v = "speed(collar.center)"
"""
model = eomgen.loads(text)
model

# %% [markdown]
# A symbol that is declared stands in every formula; text and code keep the name.

# %%
eomgen.derive(model)

# %% [markdown]
# ## What the file asks

# %%
eomgen.solve(model)

# %% [markdown]
# ## The same by hand
#
# The bar's centre is l from the hinge, the collar r: Q = 3 M g l cos + 2 M g r cos.

# %%
import sympy

equations = eomgen.derive(model)
M, l, g, r, theta = (equations.symbols[name] for name in ("M", "l", "g", "r", "theta"))
by_hand = (3 * l + 2 * r) * M * g * sympy.cos(theta)
assert sympy.expand(equations.Q[0] - by_hand) == 0
by_hand

# %% [markdown]
# ## A mistake is named where it stands

# %%
try:
    eomgen.loads(text.replace('on = "bar"', 'on = "bra"'))
except eomgen.ModelError as error:
    print(error)
