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
equations = eomgen.derive(model, method="kinetostatic")
equations

# %% [markdown]
# The method is D'Alembert's: the rod is cut free, and its weight, the force of the hinge, the inertia force and the
# inertia couple are in balance. What the hinge has no part in is the equation of motion.
#
# ## As expressions
#
# The hinge makes up what weight and inertia force leave over. They are linear in the accelerations.

# %%
import sympy

from eomgen.symbolic.print.sympy_form import to_sympy

hinge = sympy.Matrix(to_sympy(equations.reactions.force("rod")[:2]))
hinge

# %% [markdown]
# By hand, with the centre at l/2: `x = l/2 cos(theta)`, `y = -l/2 sin(theta)`, twice differentiated.

# %%
m, l, g, theta, w, e = (equations.symbols[name] for name in ("m", "l", "g", "theta", "theta'", "theta''"))
sin, cos = sympy.sin(theta), sympy.cos(theta)
by_hand = sympy.Matrix([-m * l / 2 * (e * sin + w**2 * cos), m * g - m * l / 2 * (e * cos - w**2 * sin)])
assert (hinge - by_hand).applyfunc(sympy.expand) == sympy.zeros(2, 1)

# %% [markdown]
# ## At an instant
#
# The energy theorem gives the speed where the rod hangs, so the force there is exact and needs no integration in time.

# %%
import dataclasses

below = {"value": "reaction_y(rod)", "at": "theta = pi/2", "from": "rest"}
answer = eomgen.solve(dataclasses.replace(model, outputs={"below": below}))["below"]
assert answer.exact == "5/2*m*g" and answer.method == "energy theorem"
answer

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
run.plot(view="polar")

# %% [markdown]
# ## As code
#
# The reactions are generated code like the right-hand side; `eomgen codegen` writes them as files.

# %%
reactions = equations.reaction_rhs("numpy")
value = dict(zip(reactions.names, reactions(0.0, [0.0, 0.0], [2.0, 0.6, 9.81]), strict=True))
assert abs(value["reaction_y(rod)"] - weight / 4) < 1e-12
value

# %% [markdown]
# ## A contact that ends
#
# A ladder slides down a smooth wall. The wall can only push: the ladder leaves it where the force has become 0, and the
# run goes on without the wall. It lets go at two thirds of the height from which it started.

# %%
from pathlib import Path

here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
ladder = eomgen.load(here.parent / "models" / "sliding_ladder.toml")
answers = eomgen.solve(ladder)
assert answers["cos_leaves"].exact == "2/3*cos(theta_0)"
answers["N_wall"]

# %%
run = eomgen.simulate(ladder, time=0.9, samples=451)
for phase in run.phases:
    print(f"from {phase.start:.4f} s: {phase.ended_by}")
assert abs(run.phases[0].end - answers["t_leaves"].value) < 1e-9

# %%
run.plot()
