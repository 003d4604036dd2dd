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
# # The double pendulum, from a text file to a trajectory
#
# Open this file in Jupyter through jupytext, or run it as it is.

# %%
from pathlib import Path

import eomgen

here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
model = eomgen.load(here.parent / "models" / "double_pendulum.toml")
model

# %% [markdown]
# ## The equations of motion
#
# A cell that ends in the equations shows them typeset.

# %%
equations = eomgen.derive(model)
equations

# %% [markdown]
# Kinetic energy and matrices are ordinary sympy expressions, and a name stands for its symbol.

# %%
equations.T

# %%
equations.subs(m1=3, l1=1, theta2=0).M

# %% [markdown]
# Those of robotics, M q'' + C q' + g = 0, with C by Christoffel's symbols, so that M' - 2 C is skew.

# %%
equations.coriolis

# %%
equations.gravity

# %% [markdown]
# The velocity of the tip is J u; a point is asked by its name.

# %%
equations.point_jacobian("arm2.end")

# %% [markdown]
# ## The proof
#
# The same model by independent ways, compared at random exact states.

# %%
certificate = equations.certify()
assert certificate.ok
certificate

# %% [markdown]
# ## Code
#
# `rhs(t, x, p)`: x holds the coordinates, then the speeds; p the parameters in the order of the file. Its slopes beside
# any state are exact to rounding.

# %%
rhs = equations.rhs()
print(rhs)
rhs(0.0, rhs.x0, rhs.p0)

# %%
A, _ = equations.rhs_jacobian(x=rhs.x0)
A.round(3)

# %% [markdown]
# ## Motion

# %%
run = eomgen.simulate(model, time=10)
run.plot()

# %% [markdown]
# The pendulum is conservative: what the energy drifts by is the error of the integration.

# %%
assert run.t[-1] == 10
assert run.drift < 1e-6
run.plot(view="phase")

# %% [markdown]
# What the hinges have to bear, by size and direction.

# %%
run.plot(view="polar")

# %% [markdown]
# ## Small motions
#
# About the equilibrium: matrices, modes, the state space.

# %%
small = eomgen.linearize(model, parameters={"l1": 1, "l2": 1})
small.state_space().exact["A"]

# %%
small.locus("m2=0.1:5:60")
