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
# # Closed loops: a linkage in space, put together, driven, and what it takes
#
# A crank moves a rocker about an axis askew to its own. A coupler hangs on the crank by a universal joint and on the
# rocker by a ball joint, and the crank has a second bearing that no motion needs.

# %%
from pathlib import Path

import eomgen

here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
linkage = eomgen.load(here.parent / "models" / "spatial_four_bar.toml")
linkage

# %%
freedom = eomgen.freedom_of(linkage)
print(freedom.by_rank, "by rank,", freedom.by_formula, "by the formula", freedom.formula)
assert (freedom.by_rank, freedom.by_formula) == (1, -4)

# %% [markdown]
# The formula takes away the five components of the second bearing; the rank knows that they were there already.
#
# ## Put together
#
# The file says where the crank starts. Where the others are follows, by Newton's method on the loop.

# %%
import warnings

warnings.filterwarnings("ignore", message=".*Statically indeterminate")
run = eomgen.simulate(linkage, time=2)
assert run.gap < 1e-9 and run.drift < 1e-7
print(run.assembled)

# %% [markdown]
# It moves: a player in the page, which one can turn.

# %%
run.animate(trail="coupler.end")

# %% [markdown]
# From another guess the loop closes in another way.

# %%
from dataclasses import replace

guess = {name: {"near": value} for name, value in {"a": -1, "b": -0.3, "phi": 2}.items()}
folded = replace(linkage, coordinates={**linkage.coordinates, **guess})
other = eomgen.simulate(folded, time=2)
assert other.gap < 1e-9
print(other.assembled)

# %%
other.animate(trail="coupler.end")

# %% [markdown]
# ## What the joints carry
#
# Two bearings on one axis share their load, and rigid bodies do not say how: those components have no value. All others
# do.

# %%
import numpy as np

unknown = [name for name, column in run.reactions.items() if np.isnan(column).any()]
assert all(name.endswith(("(crank)", "(bearing)")) for name in unknown)
run.plot(view="resultants")

# %% [markdown]
# ## What it takes to turn the crank steadily
#
# The crank is driven, and the drive is a reaction like any other.

# %%
turning = replace(linkage, coordinates={**linkage.coordinates, "theta": {"motion": "10*t"}})
driven = eomgen.simulate(turning, time=2 * np.pi / 10, samples=361)
import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
axes.plot(np.degrees(driven["theta"]), driven["drive(theta)"])
axes.axhline(0, color="grey", linewidth=0.8)
axes.set(xlabel="crank [deg]", ylabel="torque of the drive [N m]", xticks=range(0, 361, 45))
figure

# %% [markdown]
# Over one turn the drive does no work: nothing is left of it but the linkage as it was.

# %%
from scipy.integrate import trapezoid

work = trapezoid(driven["drive(theta)"], driven["theta"])
assert abs(work) < 1e-4 * abs(driven["drive(theta)"]).max()
work

# %% [markdown]
# Inverse dynamics gives the same torque, as a function of positions, speeds and accelerations, without a simulation.
# `eomgen codegen --inverse` writes it in C.

# %%
inverse = eomgen.inverse_dynamics(linkage, actuated=["theta"])
rhs = eomgen.derive(turning).rhs()
q, u = driven.x[:, :4], driven.x[:, 4:]
a = rhs.many(driven.t, driven.x, rhs.p0)[:, 4:]
steady = np.full((len(q), 1), 10.0)
tau = inverse.function().many(driven.t, np.hstack([q, steady, u]), np.hstack([0 * steady, a]), rhs.p0)[:, 0]
assert np.allclose(tau, driven["drive(theta)"], atol=1e-9)
print(f"at most {abs(tau).max():.4f} N m")

# %% [markdown]
# ## A loop of six hinges that should not move
#
# Bricard's mechanism: the formula counts no freedom at all. One row of the last hinge follows from the others; the
# engine finds which, says so, and carries it along.

# %%
bricard = eomgen.load(here.parent / "models" / "bricard.toml")
freedom = eomgen.freedom_of(bricard)
print(freedom.by_rank, "by rank,", freedom.by_formula, "by the formula;", freedom.redundant)
run = eomgen.simulate(bricard, time=10, samples=1001)
assert freedom.by_rank == 1 and run.gap < 1e-8 and run.drift < 1e-6
run.animate()

# %%
run.plot()
