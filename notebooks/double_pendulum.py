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

# %% [markdown]
# ## The equations of motion
#
# A cell that ends in the equations shows them typeset.

# %%
equations = eomgen.derive(model)
equations

# %% [markdown]
# Kinetic energy and mass matrix are ordinary sympy expressions.

# %%
equations.T

# %%
equations.M

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
# `rhs(t, x, p)`: x holds the coordinates, then the speeds; p the parameters in the order of the file.

# %%
rhs = equations.rhs()
print(rhs.coordinates, rhs.speeds, rhs.parameters)
rhs(0.0, rhs.x0, rhs.p0)

# %% [markdown]
# ## Motion

# %%
trajectory = eomgen.simulate(model, time=10)
trajectory

# %% [markdown]
# The pendulum is conservative: what the energy drifts by is the error of the integration.

# %%
assert trajectory.t[-1] == 10
assert trajectory.drift < 1e-6

# %%
import matplotlib.pyplot as plt

figure, axes = plt.subplots()
axes.plot(trajectory.t, trajectory.x[:, :2])
axes.set_xlabel("t [s]")
axes.set_ylabel("angle [rad]")
axes.legend([r"$\theta_1$", r"$\theta_2$"])
