# %% [markdown]
# # 6 · A closed loop in space
#
# A crank moves a rocker about an axis askew to its own. A coupler joins them: it hangs on the crank by a
# universal joint and on the rocker by a ball joint. The crank has a second bearing, which no motion needs. What
# does it take to turn the crank steadily?

# %%
import eomgen

linkage = eomgen.load("../models/spatial_four_bar.toml")
linkage

# %% [markdown]
# ## How many ways to move?
#
# The usual formula counts −4 degrees of freedom, because it takes the five components of the second bearing
# away again. The rank of the constraints knows that they were gone already: the linkage moves in one way.

# %%
freedom = eomgen.freedom_of(linkage)
print(freedom.by_rank, "by rank,", freedom.by_formula, "by the formula", freedom.formula)
assert (freedom.by_rank, freedom.by_formula) == (1, -4)

# %% [markdown]
# ## Turned steadily
#
# Two bearings on one axis share their load, and rigid bodies do not say how. So the second bearing is taken
# away. The file says where the crank starts, and the places of the other bodies follow from the loop. Now the
# crank is driven with 10 rad/s for one turn.

# %%
from dataclasses import replace

import numpy as np
from IPython.display import Image

single = replace(linkage, constraints={"ball": linkage.constraints["ball"]})
driven = {**single.coordinates, "theta": {"motion": "10*t"}}
turning = replace(single, coordinates=driven)
run = eomgen.simulate(turning, time=2 * np.pi / 10, samples=361)
assert run.gap < 1e-9
run.animate("linkage.gif", fps=10, speed=0.2, trail="coupler.end")
Image("linkage.gif", alt="The crank turns once, the rocker swings")

# %% [markdown]
# ## The torque of the drive
#
# The drive is a reaction like any other, the torque that keeps the motion as it is given.

# %%
import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
axes.plot(np.degrees(run["theta"]), run["drive(theta)"])
axes.axhline(0, color="grey", linewidth=0.8)
axes.set(xlabel="crank [deg]", ylabel="torque of the drive [N m]")
axes.set_xticks(range(0, 361, 45))
plt.show()

# %% [markdown]
# After one turn everything is as it was, so the drive has done no work in total.

# %%
from scipy.integrate import trapezoid

work = trapezoid(run["drive(theta)"], run["theta"])
assert abs(work) < 1e-4 * abs(run["drive(theta)"]).max()
print(f"work in one turn: {abs(work):.4f} J")

# %% [markdown]
# ## The torque as a function
#
# Inverse dynamics gives the same torque from positions, speeds and accelerations, without a simulation. `eomgen
# codegen --inverse` writes this function in C for a controller.

# %%
torque = eomgen.inverse_dynamics(single, actuated=["theta"]).function()
rhs = eomgen.derive(turning).rhs()
rates = rhs.many(run.t, run.x, rhs.p0)
crank = np.full((len(run.t), 1), 10.0)  # its speed, which is given
states = np.hstack([run.x[:, :4], crank, run.x[:, 4:]])
accelerations = np.hstack([0 * crank, rates[:, 4:]])
found = torque.many(run.t, states, accelerations, rhs.p0)[:, 0]
assert np.allclose(found, run["drive(theta)"], atol=1e-9)
print(f"at most {abs(found).max():.4f} N m")

# %% [markdown]
# Next: [a bicycle that balances by itself](7_bicycle.ipynb).
