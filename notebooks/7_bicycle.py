# %% [markdown]
# # 7 · A bicycle that balances by itself
#
# Push a bicycle and let it go: at the right speed it does not fall. This is the bicycle of the published
# benchmark (Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463, 2007): four rigid bodies, two wheels
# that roll without slip. The contact points have no formula; eomgen finds them.

# %%
import eomgen

bicycle = eomgen.load("../models/whipple_bicycle.toml")
bicycle

# %% [markdown]
# ## Small motions
#
# It rides straight on, and lean and steer stay small: $M\ddot q + C\dot q + Kq = 0$. The matrices are exact,
# with the speed $v$ as a symbol.

# %%
small = eomgen.linearize(bicycle)
print(small.spectrum.stability, "at 5 m/s")

# %% [markdown]
# The benchmark gives the matrices as $C = vC_1$ and $K = gK_0 + v^2K_2$. Ours have the same numbers to twelve
# digits. This is $K_2$:

# %%
import numpy as np

M, C, K = (small.exact[letter] for letter in "MCK")
s = {symbol.name: symbol for symbol in (M + C + K).free_symbols}
v, g = s.pop("v"), s.pop("g")
known = {symbol: bicycle.parameters[name].value.text for name, symbol in s.items()}
M, C, K = (matrix.subs(known) for matrix in (M, C, K))
C1, K0, K2 = C.diff(v), K.diff(g), K.diff(v).diff(v) / 2
published = {
    "C1": [[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]],
    "K0": [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]],
    "K2": [[0, 76.59734589573222], [0, 2.65431523794604]],
}
for name, matrix in (("C1", C1), ("K0", K0), ("K2", K2)):
    ours = np.array(matrix, dtype=float)
    assert np.allclose(ours, published[name], rtol=1e-12, atol=1e-12), name
K2.evalf(12)

# %% [markdown]
# ## At which speeds it balances
#
# A positive real part means that a small motion grows. Left of the green band the bicycle weaves more and more;
# right of it, it falls slowly to one side. Within the band, from 4.3 to 6.0 m/s, nobody need steer.

# %%
import matplotlib.pyplot as plt
import sympy

matrices = sympy.lambdify(v, [M, C, K.subs(g, 9.81)])


def eigenvalues(speed):
    """s of det(s^2 M + s C + K) = 0"""
    m, c, k = matrices(speed)
    rates = -np.linalg.solve(m, np.hstack([k, c]))
    return np.linalg.eigvals(np.vstack([np.eye(2, 4, 2), rates]))


speeds = np.linspace(0.01, 10, 600)
found = np.array([np.sort_complex(eigenvalues(speed)) for speed in speeds])
growing = found.real.max(axis=1) > 0
weave, capsize = speeds[~growing][0], speeds[~growing][-1]
assert abs(weave - 4.292) < 0.02 and abs(capsize - 6.024) < 0.02

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
oscillates = abs(found.imag) > 1e-9
for shown, color in ((~oscillates, "tab:blue"), (oscillates, "tab:red")):
    parts = np.where(shown, found.real, np.nan)
    axes.plot(speeds, parts, ".", color=color, markersize=2)
axes.axvspan(weave, capsize, color="tab:green", alpha=0.15)
axes.axhline(0, color="grey", linewidth=0.8)
axes.text(1.6, 4.2, "weave", color="tab:red")
axes.text(7.6, 0.8, "capsize", color="tab:blue")
axes.text(3.4, -9.4, "castering", color="tab:blue")
axes.text(weave + 0.1, -4.5, "balances\nby itself", color="tab:green")
axes.set(xlabel="v [m/s]", ylabel="real part of the eigenvalue [1/s]")
axes.set(xlim=(0, 10), ylim=(-11, 11))
plt.show()

# %% [markdown]
# ## The whole bicycle
#
# Now the same bicycle without linearization is pushed to the side, below the band and in it. A simulator is derived
# and compiled once, and then called as often as one likes.

# %%
ride = eomgen.simulator(bicycle)
figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
for speed in (3.8, 5.0):
    run = ride(time=3, start={"phi'": 0.2}, parameters={"v": speed})
    assert run.drift < 1e-6 and run.gap < 1e-8
    axes.plot(run.t, np.degrees(run["phi"]), label=f"v = {speed} m/s")
axes.set(xlabel="t [s]", ylabel="lean [deg]")
axes.legend()
plt.show()

# %% [markdown]
# A harder push at 5 m/s: the bicycle leans, steers into the fall, and comes up again.

# %%
from IPython.display import Image

run = ride(time=1.2, start={"phi'": 1})
run.animate("bicycle.gif", fps=12, speed=0.6, trail="front_wheel.center")
Image("bicycle.gif", alt="The bicycle leans, steers and comes up again")
