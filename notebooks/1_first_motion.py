# %% [markdown]
# # 1 · From a text file to a motion
#
# Two rods hang one below the other: a double pendulum. Its file says what the bodies are, how they hang
# together, and where they start. Everything else follows from it: the picture, the equations of motion, their
# proof, the motion.

# %%
import eomgen

model = eomgen.load("../models/double_pendulum.toml")
model

# %% [markdown]
# ## The equations of motion
#
# `derive` gives them with all steps in between, as in a solved problem.

# %%
equations = eomgen.derive(model)
equations

# %% [markdown]
# ## Are they right?
#
# eomgen derives the same equations by other methods, which share nothing with the first, and compares all
# results at random exact states. Each line is one such check.

# %%
certificate = equations.certify()
assert certificate.ok
certificate

# %% [markdown]
# ## The motion
#
# The pendulum is let go from rest, 115° from the downward vertical. The picture shows the angles, the energies,
# and what the two hinges carry. No energy is lost, so the drift of the energy shows how exact the integration
# is.

# %%
run = eomgen.simulate(model, time=5)
assert run.drift < 1e-6
run.plot()

# %%
from IPython.display import Image

run.animate("pendulum.gif", fps=10, speed=1.5, trail="arm2.end")
Image("pendulum.gif", alt="Both arms swing; the lower end leaves a trail")

# %% [markdown]
# Without a file name, `run.animate()` shows the motion on a page that you can stop, step and zoom. Change a
# length with `eomgen.simulate(model, parameters={"l2": 1.5})` and look at both again. Next: [a model of your
# own](2_own_model.ipynb).
