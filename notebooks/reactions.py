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
# # Every reaction
#
# A rod on a hinge falls from the horizontal. What does the hinge carry on the way?

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
""")
equations = eomgen.derive(model)
equations

# %% [markdown]
# ## As expressions
#
# D'Alembert: the hinge makes up what weight and inertia force leave over. They are linear in the accelerations.

# %%
import sympy

from eomgen.symbolic.sympy_form import to_sympy

hinge = sympy.Matrix(to_sympy(equations.reactions.force("rod")[:2]))
hinge

# %% [markdown]
# By hand, with the centre at l/2: `x = l/2 cos(theta)`, `y = -l/2 sin(theta)`, twice differentiated.

# %%
s = {symbol.name: symbol for symbol in hinge.free_symbols}
m, l, g, theta, w, e = (s[name] for name in ("m", "l", "g", "theta", "theta'", "theta''"))
sin, cos = sympy.sin(theta), sympy.cos(theta)
by_hand = sympy.Matrix([-m * l / 2 * (e * sin + w**2 * cos), m * g - m * l / 2 * (e * cos - w**2 * sin)])
assert (hinge - by_hand).applyfunc(sympy.expand) == sympy.zeros(2, 1)

# %% [markdown]
# ## Along the motion
#
# In a simulation each reaction is a column of the trajectory. At the start the hinge carries m g/4, below 5/2 m g.

# %%
run = eomgen.simulate(model, time=0.8, samples=401)
run

# %%
weight = 2.0 * 9.81
assert abs(run["reaction_y(rod)"][0] - weight / 4) < 1e-9
assert abs(run["reaction_y(rod)"].max() - 5 / 2 * weight) < 1e-3 * weight

# %%
import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(7, 3))
for name in run.reactions:
    axes.plot(run["theta"], run[name], label=name)
axes.set_xlabel("theta [rad]")
axes.set_ylabel("reaction [N]")
axes.legend()
figure

# %% [markdown]
# ## As code
#
# The reactions are generated code like the right-hand side; `eomgen codegen` writes them as files.

# %%
reactions = equations.reaction_rhs("numpy")
value = dict(zip(reactions.names, reactions(0.0, [0.0, 0.0], [2.0, 0.6, 9.81]), strict=True))
assert abs(value["reaction_y(rod)"] - weight / 4) < 1e-12
value
