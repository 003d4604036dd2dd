# %% [markdown]
# # 4 · One instant of a mechanism
#
# A crank turns about O. A rod joins its end A to a slider B, which moves along a horizontal line. The position
# is that of the drawing, and the crank turns with 2 rad/s: how fast is the slider? No coordinates are needed
# for that.

# %%
import eomgen

linkage = eomgen.loads("""
eomgen = 1
name = "Crank, rod and slider"
space = "plane"

[bodies.crank]
points = { O = [0, 0], A = [3, 4] }

[bodies.rod]
points = { A = [3, 4], B = [15, -1] }

[constraints]
O = { kind = "pin", points = ["crank.O"] }
A = { kind = "pin", points = ["crank.A", "rod.A"] }
B = { kind = "support", point = "rod.B", normal = [0, 1] }

[given]
velocity = "omega(crank) = 2"
acceleration = "epsilon(crank) = 0"

[outputs]
x_C = "rotation_center_x(rod)"
y_C = "rotation_center_y(rod)"
omega = "omega(rod)"
v_B = "vx(rod.B)"
a_B = "ax(rod.B)"
""")
motion = eomgen.kinematics(linkage)
motion.picture

# %% [markdown]
# ## Velocities, centres, accelerations
#
# The picture shows the velocities, the centres about which the bodies turn at this instant, and beside them how
# the velocity changes along x and along y. The numbers with their equations:

# %%
motion

# %% [markdown]
# ## The same on paper
#
# A moves at right angles to the crank, B along its line. The rod turns about the point C where the normals of
# both velocities meet: the line OA, and the vertical through B.

# %%
answers = eomgen.solve(linkage)
assert (answers["x_C"].exact, answers["y_C"].exact) == ("15", "20")
answers

# %% [markdown]
# From C the speeds follow as in a drawing. A is 5 from O, so its speed is 2 · 5 = 10. A is 20 from C, so the
# rod turns with 10/20 = 1/2, the other way round. B is 21 below C, so the slider moves with 21/2, to the left:

# %%
v_A = 2 * 5
omega = -v_A / 20
v_B = 21 * omega
assert (answers["omega"].value, answers["v_B"].value) == (omega, v_B)
print(f"omega = {omega}, v_B = {v_B}")

# %% [markdown]
# Next: [what a hinge carries during a motion](5_falling_rod.ipynb).
