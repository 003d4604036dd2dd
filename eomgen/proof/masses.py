"""Bodies, stated mass properties -> checks: each shape against a quadrature of the points that it fills.

A shape is the image of [0, 1]^d under maps of its own (`cells`), which know nothing of mass or inertia. With weights
w of Gauss and Legendre times the measure of the map, and from them alone,

    S = sum w [r; 1] [r; 1]^T      (4 x 4; of a body that is elsewhere X S X^T, of several the sum)

holds m, m r_C and the second moments P of a body about any origin; I = tr(P) 1 - P. No parallel axes are used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, cached_property
from itertools import product, starmap
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import Motion, Scope
from eomgen.proof.check import Check, attempted, checked, first_wrong, unchecked
from eomgen.proof.declared_numbers import other_functions
from eomgen.symbolic.expression import Expression, Node, Scalar, Vector
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, floats_of, tolerances

NODES = (32, 32, 16)  # of Gauss and Legendre in each direction, for lines, surfaces and volumes
QUADRATURE = "quadrature"
FILLED = "every shape has the mass centre and the inertia of the points that it fills"
AXES = "xyz"
Map = Callable[[Sequence[Any]], Sequence[Any]]
"""[0, 1]^d -> places of a shape"""


@dataclass(frozen=True)
class Stated:
    """Stated mass properties of bodies about a point.

    Args:
        of: how they are called.
        bodies: by name, of which the sum is taken.
        in_ground: in ground axes; else in those of the one body.
        point: about which, in these axes.
        values: by name without its argument: "m", "x_C", "I_xx", "J_xy", "I_1", "k_1", "P_x", "J_P", "J_axis".
        axes: the principal axes, the rows of R, in numbers; None where they are not known.
        axis: (a point of it, its direction) of "J_axis".
    """

    of: str
    bodies: tuple[str, ...]
    in_ground: bool
    point: Vector
    values: Mapping[str, Scalar]
    axes: Sequence[Sequence[float]] | None = None
    axis: tuple[Vector, Vector] | None = None


def mass_checks(motion: Motion, stated: Sequence[Stated], start: Mapping[Node, float]) -> Iterator[Check]:
    """Checks of every shape, of the parts of bodies, of all stated mass properties, and of the parameters.

    Args:
        start: numbers of all symbols that stand in it; {} where the start is not known.
    """
    proof = _Proof(motion, start or _tried(motion.scope))
    bodies = tuple(dict.fromkeys(body for each in stated for body in each.bodies))
    yield from proof.shapes(bodies)
    composite = [body for body in bodies if motion.scope.model.bodies[body].parts is not None]
    if composite:
        yield checked("the parts of every body add up", first_wrong(map(proof.wrong_parts, composite)), QUADRATURE)
    name = "masses, centres, moments and products of inertia are those of the bodies' points"
    found = attempted(
        name,
        QUADRATURE,
        lambda: first_wrong(f"{x} of {each.of or 'all'}{why}" for each in stated for x, why in proof.wrong(each)),
    )
    yield found
    principal = [each for each in stated if each.axes is not None]
    if principal and found.ok is not None:
        name = "principal axes are right-handed and make the tensor diagonal"
        yield checked(name, first_wrong(map(proof.wrong_axes, principal)), "floating point")
    yield from _other_parameters(motion.scope)


def other_data(motion: Motion) -> Iterator[Check]:
    """A failing check of parameters or masses that are not those of the file; the check of sampled functions."""
    yield from _other_parameters(motion.scope)
    yield from _other_masses(motion)
    yield from other_functions(motion.scope.model)


def _other_parameters(scope: Scope) -> Iterator[Check]:
    """A failing check where the numbers used by all other checks are not those of the file; else none."""
    known, found = scope.model.exact_parameters(), scope.values_of_parameters(None)
    there = {x.name: float(value) for x, value in found.items()}
    pairs = [(name, there.get(name, math.nan), float(right)) for name, right in known.items()]
    wrong = [
        f"'{name}': {x:.10g} for {y:.10g}" for name, x, y in pairs if not abs(x - y) <= tolerances.COMPUTED * abs(y)
    ]
    if wrong:
        yield checked("parameters have the values of the file", "; ".join(wrong[:3]), "floating point")


def _other_masses(motion: Motion) -> Iterator[Check]:
    """A contradiction where bodies have not the masses of the points that they fill, each kind tried once."""
    proof, bodies = _Proof(motion, _tried(motion.scope)), motion.scope.model.bodies
    shapes = {shape.kind: (body, k) for body, part in bodies.items() for k, shape in enumerate(part.shapes)}
    made = [body for body, part in bodies.items() if part.parts is not None]
    possible = ((x, k) for x, k in shapes.values() if not bodies[x].shapes[k].impossible(proof.value))
    with np.errstate(all="ignore"):  # beyond doubles nothing can be compared
        found = attempted(
            FILLED,
            QUADRATURE,
            lambda: first_wrong((*starmap(proof.wrong_shape, possible), *map(proof.wrong_parts, made))),
        )
    yield from (x for x in (found,) if x.status == "fails")


def _tried(scope: Scope) -> dict[Node, float]:
    """Values of parameters without one, and of coordinates: mass properties hold at any orientation."""
    rng, symbols = Random(3), scope.symbols
    known = {x: float(v) for x, v in scope.values_of_parameters(rng).items()}
    known |= {x: rng.uniform(0.2, 1) for x in (symbols.t, *symbols.q, *symbols.inputs.values())}
    return known | {e: float(v) for e, v in scope.on_unit_norms(known).items()}


# -- quadrature ----------------------------------------------------------------------------------------------------


def filled(maps: Iterable[Map], dimension: int) -> tuple[float, np.ndarray]:
    """(length, area or volume, S of a shape with mass 1); of dimension 0 a point."""
    if not dimension:
        return 0.0, np.diag([0.0, 0.0, 0.0, 1.0])
    parts = [_cell(cell, dimension) for cell in maps]
    weights, places = np.concatenate([w for w, _ in parts]), np.concatenate([r for _, r in parts])
    measure = float(weights.sum())
    rows = np.hstack([places, np.ones((len(places), 1))])
    return abs(measure), (rows * (weights / measure)[:, None]).T @ rows


def _cell(cell: Map, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """(weights, places) of the nodes of Gauss and Legendre in one cell."""
    s, weights = _nodes(dimension)
    slopes = np.array([_at(cell, s + _step(dimension, k)).imag / tolerances.IMAGINARY_STEP for k in range(dimension)])
    return weights * _measure(slopes), _at(cell, s.astype(complex)).real.T


@cache
def _nodes(dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """(places in [0, 1]^d, weights)"""
    x, w = np.polynomial.legendre.leggauss(NODES[dimension - 1])
    s = np.array(list(product((x + 1) / 2, repeat=dimension))).T
    return s, np.prod(np.array(list(product(w / 2, repeat=dimension))), axis=1)


def _step(dimension: int, k: int) -> np.ndarray:
    return np.array([[tolerances.IMAGINARY_STEP * 1j * (i == k)] for i in range(dimension)])


def _at(cell: Map, s: np.ndarray) -> np.ndarray:
    return np.array([np.broadcast_to(x, s.shape[1:]) for x in cell(tuple(s))])


def _measure(slopes: np.ndarray) -> np.ndarray:
    """det(dr/ds) of a volume, and of a surface in the plane, with its sign; else sqrt(det(dr/ds . dr/ds))."""
    columns = np.moveaxis(slopes, -1, 0)  # nodes x parts x 3
    if columns.shape[1] == 3:
        found: np.ndarray = np.linalg.det(columns)
    elif columns.shape[1] == 2 and not columns[:, :, 2].any():
        found = np.linalg.det(columns[:, :, :2])
    else:
        found = np.sqrt(np.linalg.det(columns @ np.swapaxes(columns, 1, 2)))
    return found


def _moments_of(stated: Sequence[float]) -> np.ndarray:
    """S of the stated m, c and I: P = tr(I) 1 / 2 - I + m c c^T."""
    m, *flat = stated
    c, I = np.array(flat[:3]), np.reshape(flat[3:], (3, 3))
    P = np.trace(I) / 2 * np.eye(3) - I + m * np.outer(c, c)
    return np.block([[P, m * c[:, None]], [m * c[None, :], np.array([[m]])]])


def _tensor(P: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.trace(P) * np.eye(3) - P
    return found


def _in_order(found: Mapping[str, float]) -> dict[str, float]:
    """Principal moments and radii in ascending order, as their order may depend on the values."""
    groups = [[name for name in (f"{letter}_{k}" for k in (1, 2, 3)) if name in found] for letter in "Ik"]
    ordered = [dict(zip(names, sorted(found[name] for name in names), strict=True)) for names in groups]
    return {**found, **ordered[0], **ordered[1]}


def _differs(A: np.ndarray, B: np.ndarray) -> bool:
    """True if two 4 x 4 matrices differ, each entry compared with the mass and the radius of the body."""
    radius, mass = (
        max(abs(x) for x in pair) ** 0.5 for pair in ((np.trace(A[:3, :3]), np.trace(B[:3, :3])), (A[3, 3], B[3, 3]))
    )
    sizes = np.array([radius, radius, radius, mass])
    return bool(np.any(abs(A - B) > tolerances.COMPUTED * np.outer(sizes, sizes)))


@dataclass(frozen=True)
class _Proof:
    """Tests of mass properties; each gives what is wrong in words, or "".

    Args:
        motion: of the bodies.
        values: of all symbols.
    """

    motion: Motion
    values: Mapping[Node, float]

    def numbers(self, scalars: Sequence[Scalar]) -> list[float]:
        found = [float(x) for x in evaluate(tuple(scalars), self.values)]
        if all(map(math.isfinite, found)):
            return found
        try:  # 1e300^2 * 0
            values = {x: fifty_digits().number(v) for x, v in self.values.items()}
            return floats_of(evaluate(tuple(scalars), values, fifty_digits()))
        except (NoValue, ZeroDivisionError):
            return found

    def value(self, expression: Expression) -> float:
        return self.numbers((self.motion.scope.value(expression),))[0]

    # -- shapes ----------------------------------------------------------------------------------------------

    def shapes(self, bodies: Sequence[str]) -> Iterator[Check]:
        """Checks of the shapes of all parts of these bodies."""
        wrong, impossible, any_ = "", "", False
        for body in bodies:
            for k, shape in enumerate(self.motion.scope.model.bodies[body].shapes):
                if shape.impossible(self.value):
                    impossible = f"the sizes of a {shape.kind} of '{body}' have no values that it can have"
                    continue
                any_ = True
                wrong = wrong or self.wrong_shape(body, k)
        if any_:
            yield checked(FILLED, wrong, QUADRATURE)
        elif impossible:
            yield unchecked(FILLED, impossible, QUADRATURE)

    def wrong_shape(self, body: str, k: int) -> str:
        """Message if the k-th shape of a body has other moments, or another size, than what it fills; ""."""
        shape = self.motion.scope.model.bodies[body].shapes[k]
        measure, S = filled(shape.cells(self.value), shape.dimension)
        if _differs(S, _moments_of(self.numbers(shape.of_mass(1, self.motion.scope.value).scalars))):
            return f"the {shape.kind} of '{body}'"
        (size,) = self.numbers((shape.measure(self.motion.scope.value),))
        return (
            f"the size of the {shape.kind} of '{body}'" if abs(size - measure) > tolerances.COMPUTED * measure else ""
        )

    # -- bodies ----------------------------------------------------------------------------------------------

    def own(self, body: str) -> np.ndarray:
        """S of a body about its origin, in its axes: by quadrature of shapes; declared numbers as they are."""
        if body not in self._known:
            part = self.motion.scope.model.bodies[body]
            if part.parts is not None:
                self._known[body] = np.sum(list(self._pieces(body)), axis=0)
            elif part.shape is not None:
                (m,) = self.numbers((self.motion.scope.mass_properties(body).m,))
                self._known[body] = m * filled(part.shape.cells(self.value), part.shape.dimension)[1]
            else:
                self._known[body] = _moments_of(self.numbers(self.motion.scope.mass_properties(body).scalars))
        return self._known[body]

    @cached_property
    def _known(self) -> dict[str, np.ndarray]:
        return {}

    def _pieces(self, body: str) -> Iterator[np.ndarray]:
        for placed in self.motion.scope.made_of(body).pieces:
            pose = placed.pose(self.motion.scope.value)
            X = self._matrix(pose.R, pose.p)
            (m,) = self.numbers((placed.mass.m,))
            shape = placed.piece.shape
            yield placed.sign * m * (X @ filled(shape.cells(self.value), shape.dimension)[1] @ X.T)

    def _matrix(self, R: Sequence[Vector], p: Vector) -> np.ndarray:
        """X of [r; 1]"""
        flat = self.numbers((*(x for row in R for x in row), *p))
        return np.block(
            [[np.reshape(flat[:9], (3, 3)), np.array(flat[9:])[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]
        )

    def wrong_parts(self, body: str) -> str:
        """The whole against the sum; parts that share a mass have one density."""
        made = self.motion.scope.made_of(body)
        if _differs(self.own(body), _moments_of(self.numbers(made.whole.scalars))):
            return f"those of '{body}'"
        shared = [p for p in made.pieces if p.piece.shape.mass is None]
        if self.motion.scope.model.bodies[body].mass is None or not shared:
            return ""
        filling = ((p.mass.m, p.piece.shape) for p in shared)
        densities = [self.numbers((m,))[0] / filled(x.cells(self.value), x.dimension)[0] for m, x in filling]
        return (
            f"the densities of '{body}' differ"
            if np.ptp(densities) > tolerances.COMPUTED * max(map(abs, densities))
            else ""
        )

    # -- stated values ---------------------------------------------------------------------------------------

    def about(self, stated: Stated, point: Sequence[float] | np.ndarray) -> np.ndarray:
        """S of its bodies about a point, in its axes."""
        shift = np.eye(4)
        shift[:3, 3] = -np.array(point)
        S = np.zeros((4, 4))
        for body in stated.bodies:
            link = self.motion.link(body)
            X = shift @ (self._matrix(link.pose.R, link.pose.p) if stated.in_ground else np.eye(4))
            S = S + X @ self.own(body) @ X.T
        return S

    def wrong(self, stated: Stated) -> Iterator[tuple[str, str]]:
        """(name, difference) of stated values that are not those of the points of the bodies.

        Raises:
            NoValue: doubles do not hold it.
        """
        expected, sizes = self._expected(stated)
        names = [name for name in stated.values if name in expected]
        found = dict(zip(names, self.numbers([stated.values[name] for name in names]), strict=True))
        for name, x in _in_order(found).items():
            kind = name.partition("_")[0]
            power = 2 if kind == "k" else 1  # the root of a rounding error is no rounding error
            if not abs(x**power - expected[name] ** power) <= tolerances.COMPUTED * sizes[kind] ** power:
                yield name, f": {x:.10g} against {expected[name]:.10g}"

    def _expected(self, stated: Stated) -> tuple[dict[str, float], dict[str, float]]:
        """(each value, the size of its kind)"""
        origin, S = self.about(stated, (0, 0, 0)), self.about(stated, self.numbers(stated.point))
        m, P = S[3, 3], S[:3, :3]
        if not np.all(np.abs(np.stack([origin, S])) < tolerances.LARGEST_SQUARED):
            raise NoValue("moments of inertia are beyond doubles")
        I, moments = _tensor(P), np.linalg.eigvalsh(_tensor(P))
        found = {"m": m, "J_P": float(np.trace(P))}
        for i, x in enumerate(AXES):
            found |= {f"P_{x}": P[i, i], f"I_{i + 1}": moments[i]}
            found |= {f"I_{x}{y}": I[i, j] for j, y in enumerate(AXES)}
            found |= {f"J_{x}{y}": P[i, j] for j, y in enumerate(AXES) if i != j}
            if m:
                found |= {f"{x}_C": origin[i, 3] / m, f"k_{i + 1}": np.sqrt(max(moments[i], 0.0) / m)}
        if stated.axis is not None:
            start, along = (np.array(self.numbers(v)) for v in stated.axis)
            n = along / np.linalg.norm(along)
            found["J_axis"] = n @ _tensor(self.about(stated, start)[:3, :3]) @ n
        passed = max(float(np.trace(abs(S[:3, :3]))) for S in (origin, *map(self.own, stated.bodies)))
        large = (
            float(np.trace(abs(I))) + tolerances.ROUNDING / tolerances.COMPUTED * passed
        )  # about a far origin I is a small difference
        radius = np.sqrt(np.trace(abs(origin[:3, :3])) / abs(m)) if m else 1.0
        return found, {"m": abs(m), "k": radius, **dict.fromkeys("IJP", large), **dict.fromkeys(AXES, radius)}

    def wrong_axes(self, stated: Stated) -> str:
        """R R^T = 1, det R = 1, R I R^T = diag(I_1, I_2, I_3)."""
        assert stated.axes is not None
        R = np.array(stated.axes)
        I, large = _tensor(self.about(stated, self.numbers(stated.point))[:3, :3]), self._expected(stated)[1]["I"]
        if abs(R @ R.T - np.eye(3)).max() > tolerances.COMPUTED or np.linalg.det(R) < 0:
            return f"those of {stated.of or 'all'} are not three unit vectors, right-handed"
        moments = self.numbers([stated.values[f"I_{k}"] for k in (1, 2, 3)])
        left = R @ I @ R.T - np.diag(moments)
        return f"those of {stated.of or 'all'}" if abs(left).max() > tolerances.COMPUTED * large else ""
