"""Small systems written by hand, for tests that need equations of motion and no model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from eomgen.mechanics.dynamics.system import EquationsOfMotion
from eomgen.symbolic.expression.derivatives import Symbols
from eomgen.symbolic.expression.formula import cos, sin
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Scalar


def symbols(
    coordinates: str, parameters: str = "", inputs: str = "", constraints: int = 0, *, states: str = ""
) -> Symbols:
    """Symbols of coordinates whose speeds are their rates."""
    graph = Graph()
    q = coordinates.split()
    return Symbols(
        graph,
        graph.symbol("t"),
        {name: graph.symbol(name) for name in parameters.split()},
        {name: graph.symbol(name) for name in inputs.split()},
        tuple(graph.symbol(name) for name in q),
        tuple(graph.symbol(f"{name}'") for name in q),
        tuple(graph.symbol(f"{name}''") for name in q),
        tuple(graph.symbol(f"lam(constraint, {row + 1})") for row in range(constraints)),
        z=tuple(graph.symbol(name) for name in states.split()),
    )


@dataclass(frozen=True)
class Bare:
    """What code generation asks of a system: its symbols, and the model's own expression of each input."""

    symbols: Symbols
    inputs: Mapping[str, Scalar] = field(default_factory=dict)
    state_rates: tuple[Scalar, ...] = ()

    @property
    def scope(self) -> Bare:
        """Where equations of motion look for rates of states."""
        return self


def equations_of(
    symbols: Symbols,
    M: Sequence[Sequence[Scalar]],
    c: Sequence[Scalar],
    Q: Sequence[Scalar],
    *,
    T: Scalar = 0,
    V: Scalar = 0,
    J: Sequence[Sequence[Scalar]] = (),
    gamma: Sequence[Scalar] = (),
    phi: Sequence[Scalar] = (),
    accelerations: Sequence[Scalar] | None = None,
    inputs: Mapping[str, Scalar] | None = None,
    state_rates: Sequence[Scalar] = (),
) -> EquationsOfMotion:
    """Equations with q' = u."""
    n = len(symbols.q)
    return EquationsOfMotion(
        Bare(symbols, inputs or {}, tuple(state_rates)),
        N=tuple(tuple(int(i == j) for j in range(n)) for i in range(n)),
        nu=(0,) * n,
        M=tuple(map(tuple, M)),
        c=tuple(c),
        Q=tuple(Q),
        forcing=tuple(a - b for a, b in zip(Q, c, strict=True)),
        J=tuple(map(tuple, J)),
        sigma=(0,) * len(J),
        gamma=tuple(gamma),
        phi=tuple(phi),
        T=T,
        V=V,
        accelerations=None if accelerations is None else tuple(accelerations),
    )


def pendulum() -> EquationsOfMotion:
    """A point mass on a massless rod: theta'' = -g/l sin(theta)."""
    s = symbols("theta", "m l g")
    m, l, g = s.parameters.values()
    theta, rate = s.q[0], s.u[0]
    T, V = Fraction(1, 2) * m * l**2 * rate**2, -m * g * l * cos(theta)
    return equations_of(s, [[m * l**2]], [0], [-m * g * l * sin(theta)], T=T, V=V)


def cart_pole(**inputs: Scalar) -> EquationsOfMotion:
    """A cart M pushed by F, a point mass m on a rod l below it, theta from the vertical; inputs: F of its own."""
    s = symbols("x theta", "M m l g", "F")
    M, m, l, g = s.parameters.values()
    (_, theta), (v, w) = s.q, s.u
    T = Fraction(1, 2) * (M * v**2 + m * (v**2 + 2 * l * cos(theta) * v * w + l**2 * w**2))
    inertia = [[M + m, m * l * cos(theta)], [m * l * cos(theta), m * l**2]]
    Q = [s.inputs["F"], -m * g * l * sin(theta)]
    return equations_of(s, inertia, [-m * l * sin(theta) * w**2, 0], Q, T=T, V=-m * g * l * cos(theta), inputs=inputs)


def tied_pendulum(copies: int = 1) -> EquationsOfMotion:
    """The pendulum in x, y with its rod as a closing constraint, said `copies` times: phi = (x^2 + y^2 - l^2)/2."""
    s = symbols("x y", "m l g", constraints=copies)
    m, l, g = s.parameters.values()
    (x, y), (vx, vy) = s.q, s.u
    T, V = Fraction(1, 2) * m * (vx**2 + vy**2), m * g * y
    rows = [(k * x, k * y) for k in range(1, copies + 1)]
    gamma = [k * (vx**2 + vy**2) for k in range(1, copies + 1)]
    phi = [k * (x**2 + y**2 - l**2) / 2 for k in range(1, copies + 1)]
    return equations_of(s, [[m, 0], [0, m]], [0, 0], [0, -m * g], T=T, V=V, J=rows, gamma=gamma, phi=phi)


def motor() -> EquationsOfMotion:
    """A rotor with a current that its speed induces, and a sensor that follows its acceleration: x = (q, u, z)."""
    s = symbols("theta", "J R L k", states="i y")
    J, R, L, k = s.parameters.values()
    (rate,), (a,), (i, y) = s.u, s.a, s.z
    rates = ((-R * i - k * rate) / L, (a - y) / L)
    return equations_of(s, [[J]], [0], [k * i - sin(s.q[0])], T=Fraction(1, 2) * J * rate**2, state_rates=rates)


def spring_row(n: int) -> EquationsOfMotion:
    """n unit masses in a row between n + 1 unit springs, with a mass matrix made full: M = 1 + e e^T, K = M K0."""
    s = symbols(" ".join(f"q{i}" for i in range(n)))
    q = s.q
    force = [(q[i - 1] if i else 0) - 2 * q[i] + (q[i + 1] if i + 1 < n else 0) for i in range(n)]
    total: Scalar = 0
    for f in force:
        total = total + f
    M = [[2 if i == j else 1 for j in range(n)] for i in range(n)]
    return equations_of(s, M, [0] * n, [f + total for f in force])


PUSHED = """
eomgen = 1
name = "pushed"
space = "plane"
parameters = { m = 2.0 }
coordinates = { x = 0.5 }
inputs.F.value = { samples = [[0, 1], [0.5, 3], [1, -2], [2, 0.5]] }
bodies.b = { mass = "m", joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
forces.f = { kind = "force", point = "b.origin", force = ["F", 0] }
"""
