# %% [markdown]
# # 3 · What holds a frame up
#
# A portal frame of two bodies stands on two hinges and has a third at the top. The wind pushes at its left
# corner, and the right half of the roof carries a load. One reaction is found by virtual work and checked by
# hand. A structure needs no coordinates: the bodies are where their points are.

# %%
import eomgen

frame = eomgen.loads("""
eomgen = 1
name = "Portal with three hinges"
space = "plane"

[parameters]
P = { value = 12, unit = "kN" }
q = { value = 3, unit = "kN/m" }
a = { value = 2, unit = "m" }

[bodies.left]
points = { A = [0, 0], corner = [0, "2*a"], C = ["2*a", "2*a"] }

[bodies.right]
points = { C = ["2*a", "2*a"], knee = ["4*a", "2*a"], B = ["4*a", 0] }

[constraints]
A = { kind = "pin", points = ["left.A"] }
B = { kind = "pin", points = ["right.B"] }
C = { kind = "pin", points = ["left.C", "right.C"] }

[forces]
wind = { kind = "force", point = "left.corner", force = ["P", 0] }
roof = { kind = "distributed", body = "right", between = ["C", "knee"], intensity = [0, "-q"] }
""")
found = eomgen.statics(frame)
found.picture

# %% [markdown]
# All reactions are exact, and each is found twice: by virtual work and by the equilibrium of the bodies.

# %%
assert found.ok
found.exact

# %% [markdown]
# ## The frame becomes a mechanism
#
# How large is the thrust at A, the horizontal force of the left hinge? Let A slide, and the frame can move in
# exactly one way. This is how:

# %%
from IPython.display import Image

eomgen.virtual_displacement(frame, "reaction_x(A)", "thrust.gif", fps=10)
Image("thrust.gif", alt="A slides, both halves turn")

# %% [markdown]
# In this small displacement all forces together do no work. The thrust is the only unknown force that does any,
# so one equation gives it:

# %%
eomgen.statics(frame, reaction="reaction_x(A)")

# %% [markdown]
# ## The same by hand
#
# Moments of the whole frame about B give the vertical force at A; moments of the left half about C give the
# thrust.

# %%
P, q, a = 12_000.0, 3_000.0, 2.0
A_y = (2 * q * a * a - P * 2 * a) / (4 * a)
A_x = A_y * 2 * a / (2 * a)
assert abs(found.values["reaction_y(A)"] - A_y) < 1e-6
assert abs(found.values["reaction_x(A)"] - A_x) < 1e-6
print(f"A_x = {A_x} N, A_y = {A_y} N")

# %% [markdown]
# ## Without the hinge at B
#
# A structure that can move is an error. The message says what moves, and how.

# %%
import dataclasses

others = {name: frame.constraints[name] for name in ("A", "C")}
loose = dataclasses.replace(frame, constraints=others)
try:
    eomgen.statics(loose)
except eomgen.DerivationError as error:
    print(error)

# %% [markdown]
# Next: [one instant of a mechanism](4_one_instant.ipynb).
