"""Measured motions -> parameters: least squares of the base parameters, then physically possible bodies.

applied = Y pi + y0        (along the motions that the constraints allow)

The base parameters are fitted first: they are all that the data determine. The parameters of the bodies then fit as
well, are those of bodies of positive density, and are near the model's where the data do not determine them.

Rates and accelerations that were not measured are those of a spline, which amplifies the noise of the positions. Least
squares takes W as exact, so that noise in it makes the parameters wrong however many samples there are, and their
standard deviations do not show it. This bias is estimated: noise of the same size is added again, which gives the
squares of the noise in W^T W; without them the normal equations give other parameters.
Source: Fuller, Measurement Error Models, 1987, section 2.2 (the moments of the errors are drawn here).
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

from eomgen.codegen import Program, RightHandSide
from eomgen.documents import Document, Lines, plain_document, prose, proven
from eomgen.errors import UsageError
from eomgen.files import read
from eomgen.frozen import dataclass
from eomgen.identification.proof_of_groups import (
    StackedSamples,
    bias_checked,
    fit_checked,
    samples_checked,
    spread_checked,
)
from eomgen.identification.regressors import Regressor, regressor, regressor_of
from eomgen.model import Model, ModelOrPath, model_at
from eomgen.pipeline import derive
from eomgen.proof import Certificate, Check, checked
from eomgen.symbolic.expression import Symbols, substituted
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances

Data = Mapping[str, Any]


@dataclass(frozen=True)
class Identified:
    """Parameters identified from measured motions.

    Args:
        regressor: the model's.
        base: value and standard deviation of each base parameter, by its formula.
        values: the inertial and other parameters, of bodies with positive density.
        condition: condition number of the base parameters' columns, each divided by its length: a motion with more
            than 100 excites them poorly.
        samples: number of instants.
        residual: root mean square of the residual of the forces [N or N m].
        consistent_residual: the same with `values`.
        bias: estimated bias of each base parameter by the noise of rates that were not measured; {} where all were.
        fit: checks that least squares found the optimum.
    """

    regressor: Regressor
    base: dict[str, tuple[float, float]]
    values: dict[str, float]
    condition: float
    samples: int
    residual: float
    consistent_residual: float
    bias: Mapping[str, float] = field(default_factory=dict)
    fit: tuple[Check, ...] = ()

    def certify(self) -> Certificate:
        """Proof of the regressor and its groups, and of the optimum of least squares."""
        return self.regressor.certify() + self.fit

    @property
    def biased(self) -> tuple[str, ...]:
        """The base parameters that noise has moved by more than their standard deviation."""
        return tuple(name for name, shift in self.bias.items() if abs(shift) > self.base[name][1])

    def __repr__(self) -> str:
        return f"<{len(self.base)} base parameters from {self.samples} samples: residual {self.residual:.3g}>"


@dataclass(frozen=True)
class Stacked:
    """System W pi = b of all samples, stacked; `sizes` gives the number of rows of each sample."""

    W: np.ndarray
    b: np.ndarray
    sizes: tuple[int, ...]


Stacking = Callable[[Data], Stacked]
NEIGHBOURS = (-3, -2, -1, 1, 2, 3)
LEAST_SAMPLES = 20  # from which the noise can be estimated
DRAWS = 4  # of noise: n samples each
NORMAL_MEDIAN = 1.4826  # standard deviation over the median of |x|


def identify(model: ModelOrPath, data: Data) -> Identified:
    """The parameters by least squares.

    Args:
        data: arrays by name, in SI: t, the coordinates, their rates (`q'`), accelerations (`q''`) and the inputs. Rates
            and accelerations that are not there are those of a cubic spline; inputs that are not there the model's.
    Raises:
        UsageError: a coordinate without samples, fewer samples than parameters, or nothing known that acts.
    """
    found = regressor_of(derive(model_at(model)).system)
    stacking = stacking_of(found)
    stacked = stacking(data)
    base = found.base
    K = base.matrix(found.parameters)
    kept = [found.parameters.index(group.name) for group in base.groups]
    W = stacked.W[:, kept]
    if len(W) < len(kept):
        raise UsageError(f"{len(W)} equations do not determine {len(kept)} parameters", fix="give more samples")
    lengths = np.linalg.norm(W, axis=0)
    if not lengths.all():
        names = ", ".join(base.groups[k].name for k in np.flatnonzero(lengths == 0))
        raise UsageError(f"this motion does not excite {names}", fix="move every coordinate, with accelerations")
    if not stacked.b.any():
        raise UsageError(
            "no known force acts in this motion: it determines only ratios of the parameters, and zeros fit it too",
            fix="measure a motion with a force or couple of known size: an input, a spring, a load",
        )
    scaled = W / lengths
    beta = np.linalg.lstsq(scaled, stacked.b, rcond=None)[0]
    left = stacked.b - scaled @ beta
    spread = np.linalg.pinv(scaled.T @ scaled)
    variance = float(left @ left) / max(1, len(W) - len(kept))
    deviations = np.sqrt(np.maximum(np.diag(spread) * variance, 0)) / lengths
    values = _consistent(found, K, scaled, lengths, stacked.b)
    again = stacked.b - W @ (K @ np.array([values[name] for name in found.parameters]))
    formulas = [group.formula for group in base.groups]
    shifts, moved = _shifts(stacking, data, kept, beta / lengths, _splined(found.system.symbols, data))
    condition, residual = float(np.linalg.cond(scaled)), float(np.sqrt(np.mean(left**2)))
    return Identified(
        found,
        {name: (float(x), float(s)) for name, x, s in zip(formulas, beta / lengths, deviations, strict=True)},
        values,
        condition,
        len(np.atleast_1d(data["t"])),
        residual,
        float(np.sqrt(np.mean(again**2))),
        dict(zip(formulas, shifts, strict=True)) if shifts else {},
        (
            fit_checked(W, stacked.b, beta / lengths),
            spread_checked(W, stacked.b, deviations, condition, residual),
            *([bias_checked(np.array(shifts), moved, deviations)] if shifts else []),
            _begun_checked(found),
            samples_checked(found, _samples(found, data, stacked)),
        ),
    )


def _samples(found: Regressor, data: Data, stacked: Stacked) -> StackedSamples:
    """Stacked samples, and the model's values."""
    t, states, _ = _measured(found.system.symbols, data)
    given = {name: np.asarray(data[name], dtype=float) for name in found.system.symbols.inputs if name in data}
    ends = np.cumsum(stacked.sizes)[:-1]
    rows = [*zip(np.split(stacked.W, ends), np.split(stacked.b, ends), strict=True)]
    own = _own_values(found)
    pi, p = np.array([own[name] for name in found.parameters]), RightHandSide.parameter_values(found.model)
    return StackedSamples(t, states, given, rows, pi, p.tolist())


def _splined(symbols: Symbols, data: Data) -> list[str]:
    """Columns whose rates are those of a spline."""
    wanted = [x.name[:-1] for x in (*symbols.u, *symbols.a) if x.name not in data]
    return list(dict.fromkeys(name if name in data else name[:-1] for name in wanted))


def _shifts(
    stacking: Stacking, data: Data, kept: Sequence[int], beta: np.ndarray, names: Sequence[str]
) -> tuple[list[float], np.ndarray]:
    """(estimated bias of the base parameters by the noise of those columns, their change in fits to noisier columns).

    Both are empty without such columns.

    beta - (W^T W - E D^T D)^-1 (W^T b - E D^T d), D and d the changes of W and b by noise of the same size; where the
    noise is as large as W^T W, all of beta.
    """
    t = np.asarray(data["t"], dtype=float)
    if not names or len(t) < LEAST_SAMPLES:
        return [], np.zeros((0, len(beta)))
    noise = {name: noise_of(t, np.asarray(data[name], dtype=float)) for name in names}
    plain, moments, moved = stacking(data), [], []
    W = np.column_stack([plain.W[:, kept], plain.b])
    for seed in range(DRAWS):
        rng = np.random.default_rng(seed)
        noisier = {name: np.asarray(data[name], dtype=float) + rng.normal(size=len(t)) * x for name, x in noise.items()}
        stacked = stacking({**data, **noisier})
        D = np.column_stack([stacked.W[:, kept], stacked.b]) - W
        moments.append(D.T @ D)
        moved.append(np.linalg.lstsq(stacked.W[:, kept], stacked.b, rcond=None)[0] - beta)
    left = W.T @ W - np.mean(moments, axis=0)
    A, c = left[:-1, :-1], left[:-1, -1]
    known = np.linalg.eigvalsh(A)[0] > 0
    return [float(x) for x in (beta - np.linalg.solve(A, c) if known else beta)], np.array(moved)


def noise_of(t: np.ndarray, y: np.ndarray) -> float:
    """Standard deviation of the noise of samples, by the distance of each from a quintic through three on each side.

    The median of |y_i - w.y| / sqrt(1 + w.w), over that of a normal distribution: jumps do not count.
    """
    i = np.arange(3, len(t) - 3)
    nearby = [t[i + k] for k in NEIGHBOURS]
    off, size = y[i].copy(), np.ones(len(i))
    for a, k in zip(nearby, NEIGHBOURS, strict=True):
        w = np.prod([(t[i] - b) / (a - b) for b in nearby if b is not a], axis=0)
        off -= w * y[i + k]
        size += w * w
    return float(NORMAL_MEDIAN * np.median(np.abs(off) / np.sqrt(size)))


def stacking_of(found: Regressor) -> Stacking:
    """data -> W and b, along the motions that the constraints allow; UsageError where a coordinate has no samples."""
    system, symbols = found.system, found.system.symbols
    still = dict.fromkeys(symbols.inputs.values(), 0)
    Q = system.loads.generalized_forces
    applied = tuple(x - y for x, y in zip(Q, substituted(Q, still), strict=True))
    J = tuple(x for row in system.constraints.J for x in row)
    outputs = (*(x for row in found.rows for x in row), *found.known, *applied, *J)
    function = RightHandSide.of(Program.of(outputs, symbols, inputs=system.inputs, accelerations=symbols.a), "numpy")
    size, width, p = len(symbols.u), len(found.parameters), RightHandSide.parameter_values(found.model)

    def stacked(data: Data) -> Stacked:
        t, states, inputs = _measured(symbols, data)
        values = np.asarray(function.many(t, states, p, inputs))
        Y = values[:, : size * width].reshape(-1, size, width)
        known = values[:, size * width : size * width + size]
        pushed = values[:, size * width + size : size * width + 2 * size]
        constraints = values[:, size * width + 2 * size :].reshape(len(values), -1, size)
        parts = [
            (_along(J_k, size), Y_k, p_k - k_k)
            for J_k, Y_k, p_k, k_k in zip(constraints, Y, pushed, known, strict=True)
        ]
        W, b = np.vstack([Z @ Y_k for Z, Y_k, _ in parts]), np.concatenate([Z @ b for Z, _, b in parts])
        return Stacked(W, b, tuple(len(Z) for Z, _, _ in parts))

    return stacked


def _measured(symbols: Symbols, data: Data) -> tuple[np.ndarray, np.ndarray, Any]:
    """(t, states with accelerations, inputs) of the samples."""
    t, columns = np.asarray(_column(data, "t"), dtype=float), {}
    for q in symbols.places:
        columns[q.name] = np.asarray(_column(data, q.name), dtype=float)
    for speed, rate in zip(symbols.u, symbols.a, strict=True):
        columns[speed.name] = _rate(data, t, speed.name, columns)
        columns[rate.name] = _rate(data, t, rate.name, columns)
    names = list(symbols.inputs)
    given = {name: np.asarray(data[name], dtype=float) for name in names if name in data}
    if given and len(given) < len(names):
        missing = next(name for name in names if name not in given)
        raise UsageError(f"the data have no column '{missing}'", fix="give all inputs, or none")
    inputs: Any = np.column_stack([given[name] for name in names]) if given else ()
    return t, np.column_stack([columns[x.name] for x in (*symbols.x, *symbols.a)]), inputs


def _along(J: np.ndarray, size: int) -> np.ndarray:
    """A basis of the motions that the constraints allow, a row each."""
    if not len(J):
        return np.eye(size)
    _, s, Vt = np.linalg.svd(J)
    rank = int(np.sum(s > tolerances.RANK_NEARBY * s[0])) if len(s) and s[0] else 0
    basis: np.ndarray = Vt[rank:]
    return basis


def _column(data: Data, name: str) -> Any:
    if name not in data:
        raise UsageError(f"the data have no column '{name}'", fix=f"columns are {', '.join(map(str, data))}")
    return data[name]


def _rate(data: Data, t: np.ndarray, name: str, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Measured rate, else the derivative of a cubic spline through the samples."""
    if name in data:
        return np.asarray(data[name], dtype=float)
    of = name[:-1]
    if of not in columns:
        raise UsageError(f"the data have no column '{name}'", fix="give it: it is no rate of another column")
    rate: np.ndarray = CubicSpline(t, columns[of])(t, 1)
    return rate


def _consistent(
    found: Regressor, K: np.ndarray, scaled: np.ndarray, lengths: np.ndarray, b: np.ndarray
) -> dict[str, float]:
    """The parameters of bodies of positive density, positive rotors, dampers and springs, that fit best."""
    size = 2 if found.model.space == "plane" else 3
    own = _own_values(found)
    bodies = [name[2:-1] for name in found.parameters if name.startswith("m(")]
    alone = [name for name in found.parameters if not _of_body(name, bodies)]
    parts = [{n.split("(")[0]: own[n] for n in found.parameters if _of_body(n, [body])} for body in bodies]
    begin = [numbers_of(part, size) for part in parts]
    width = len(begin[0]) if begin else 0
    rest = np.log([max(abs(own[name]), tolerances.LEAST_DENSITY) for name in alone])
    z0 = np.concatenate([*begin, rest])
    triangle: Any = np.linalg.qr(np.column_stack([scaled, b]), mode="r")
    R, d = triangle[:, :-1], triangle[:, -1]
    signs = {name: -1.0 if own[name] < 0 else 1.0 for name in alone}

    def values(z: np.ndarray) -> dict[str, float]:
        made: dict[str, float] = {}
        for k, body in enumerate(bodies):
            part = parameters_of(z[k * width : (k + 1) * width], size)
            made |= {f"{name}({body})": x for name, x in part.items()}
        return made | {n: signs[n] * float(x) for n, x in zip(alone, np.exp(z[len(bodies) * width :]), strict=True)}

    weight = tolerances.TOWARD_THE_MODEL * max(1.0, float(np.linalg.norm(d)))

    def left(z: np.ndarray) -> np.ndarray:
        made = values(z)
        pi = np.array([made[name] for name in found.parameters])
        return np.concatenate([R @ (lengths * (K @ pi)) - d, weight * (z - z0)])

    best = least_squares(left, z0, method="trf", x_scale="jac", max_nfev=200)
    return values(best.x)


def _begun_checked(found: Regressor) -> Check:
    """The bodies of the model, by the numbers from which the search begins, are those of the model.

    Of bodies of positive density in every direction; others begin as small ones.
    """
    size, own = 2 if found.model.space == "plane" else 3, _own_values(found)
    wrong = []
    for body in (name[2:-1] for name in found.parameters if name.startswith("m(")):
        part = {n.split("(")[0]: own[n] for n in found.parameters if _of_body(n, [body])}
        again, largest = parameters_of(numbers_of(part, size), size), max(map(abs, part.values()))
        if _least_extent(part, size) > tolerances.NEARLY_A_POINT * largest:
            wrong += [
                f"{n}({body}) is {again[n]:.6g}"
                for n, x in part.items()
                if abs(again[n] - x) > tolerances.CARRIED * largest
            ]
    return checked("the search for bodies begins at those of the model", "; ".join(wrong[:2]), "floating point")


def _least_extent(part: Mapping[str, float], size: int) -> float:
    """The least principal integral of x^2 dm about the mass centre; in the plane that of r^2."""
    if part["m"] <= 0:
        return 0.0
    h = np.array([part[name] for name in ("mx", "my", "mz")[:size]])
    if size == 2:
        return float(part["Izz"] - h @ h / part["m"])
    rows = (("Ixx", "Ixy", "Izx"), ("Ixy", "Iyy", "Iyz"), ("Izx", "Iyz", "Izz"))
    I = np.array([[part[name] for name in row] for row in rows])
    return float(np.linalg.eigvalsh(np.trace(I) / 2 * np.eye(3) - I - np.outer(h, h) / part["m"])[0])


def _of_body(name: str, bodies: Sequence[str]) -> bool:
    kind, _, body = name.rstrip(")").partition("(")
    return kind in ("m", "mx", "my", "mz", "Ixx", "Iyy", "Izz", "Ixy", "Iyz", "Izx") and body in bodies


def _own_values(found: Regressor) -> dict[str, float]:
    """The parameters of the model."""
    p = RightHandSide.parameter_values(found.model)
    known = dict(zip(found.system.symbols.parameters.values(), map(float, p), strict=True))
    return dict(zip(found.parameters, map(float, evaluate(found.values, known, FLOAT)), strict=True))


# -------- consistent ------------------------------------------------------------------------------------------
# Inertial parameters that a body can have: its masses are positive, wherever they are.
#
# With Sigma = integral of r r^T dm and h = m c, the pseudo-inertia [[Sigma, h], [h^T, m]] = L L^T is positive for
# every lower triangular L with a diagonal exp(.): so any numbers z give a body of positive density, I = tr(Sigma) 1 -
# Sigma. In the plane Sigma is 2 x 2 and Izz its trace. Source: Rucker & Wensing, Smooth parameterization of
# rigid-body inertia, IEEE RA-L 7 (2022).


ENTRIES = {"Ixy": (0, 1), "Iyz": (1, 2), "Izx": (0, 2)}
MOMENTS = ("mx", "my", "mz")


def parameters_of(z: np.ndarray, size: int) -> dict[str, float]:
    """m, m c and the inertia about the origin that the numbers z give; `size` 3 in space, 2 in the plane."""
    L = np.zeros((size + 1, size + 1))
    L[np.tril_indices(size + 1)] = z
    L[np.diag_indices(size + 1)] = np.exp(np.diag(L))
    J = L @ L.T
    Sigma, found = J[:size, :size], {"m": J[size, size]}
    found |= {name: J[k, size] for k, name in enumerate(MOMENTS[:size])}
    if size == 2:
        return found | {"Izz": float(np.trace(Sigma))}
    I = np.trace(Sigma) * np.eye(3) - Sigma
    found |= {"Ixx": I[0, 0], "Iyy": I[1, 1], "Izz": I[2, 2]}
    return found | {name: I[i, j] for name, (i, j) in ENTRIES.items()}


def numbers_of(own: Mapping[str, float], size: int) -> np.ndarray:
    """z of a body; of one without extent that of a small one."""
    m = float(max(own["m"], tolerances.LEAST_DENSITY))
    h = np.array([own[name] for name in MOMENTS[:size]])
    if size == 2:
        center = h / m
        Sigma = np.eye(2) * max(float(own["Izz"] - m * center @ center), 0.0) / 2 + np.outer(h, h) / m
    else:
        I = np.diag([own["Ixx"], own["Iyy"], own["Izz"]])
        for name, (i, j) in ENTRIES.items():
            I[i, j] = I[j, i] = own[name]
        Sigma = np.trace(I) / 2 * np.eye(3) - I
    about_center = Sigma - np.outer(h, h) / m
    values, axes = np.linalg.eigh(about_center)
    least = tolerances.LEAST_DENSITY * max(float(np.abs(values).max()), m * tolerances.LEAST_DENSITY)
    Sigma = axes @ np.diag(np.maximum(values, least)) @ axes.T + np.outer(h, h) / m
    J = np.block([[Sigma, h[:, None]], [h[None, :], np.array([[m]])]])
    L = np.linalg.cholesky(J)
    L[np.diag_indices(size + 1)] = np.log(np.diag(L))
    z: np.ndarray = L[np.tril_indices(size + 1)]
    return z


# -------- document -------------------------------------------------------------------------------------------
# eomgen identify: parameters from a measured motion.


LARGEST = 200_000_000  # bytes of a file
BIASED = (
    "rates come of noisy columns, which moves parameters by more than their deviations say, by about as far as each "
    "line says: measure rates and accelerations, or filter all columns alike"
)
POOR = 100.0  # a condition number beyond which parameters can hardly be distinguished


def identify_document(model: Model, *, data: str | None = None, certify: bool = True) -> Document:
    """The parameters that fit a measured motion; without one the groups of them that motions can distinguish.

    Raises:
        UsageError: the file holds no samples of the coordinates.
    """
    if data is None:
        groups = regressor(model)
        return proven(_groups_reported(groups), groups.certify() if certify else None)
    found = identify(model, columns_of(data))
    width = max(map(len, (*found.base, *found.values)), default=0)
    poor = f" (poor: beyond {POOR:g})" if found.condition > POOR else ""
    lines = [
        f"{len(found.base)} base parameters from {found.samples} samples, residual {found.residual:.6g}",
        f"condition of the motion: {found.condition:.6g}{poor}",
        "",
        "base parameters (least squares, standard deviation)",
        *(
            f"    {name:{width}}  {x:.9g} +- {deviation:.2g}{_shift(found, name)}"
            for name, (x, deviation) in found.base.items()
        ),
        "",
        f"parameters of bodies of positive density, residual {found.consistent_residual:.6g}",
        *(f"    {name:{width}}  {x:.9g}" for name, x in found.values.items()),
    ]
    document = plain_document(model, lambda: _entries(found), Lines(tuple(lines)))
    document = replace(document, notes=(*document.notes, *([BIASED] if found.biased else [])))
    return proven(document, found.certify() if certify else None)


def _groups_reported(found: Regressor) -> Document:
    """The base parameters of any motion."""
    base = found.base
    width = max((len(group.name) for group in base.groups), default=0)
    lines = [
        f"{len(base)} base parameters of {len(found.parameters)} parameters, as many as the rank of Y in "
        f"tau + J^T lam = Y pi + y0 ({base.arithmetic})",
        "",
        *(f"    {group.name:{width}}  {group.formula}" for group in base.groups),
        "",
    ]
    rest = [prose(f"Without effect: {', '.join(base.without_effect)}.")] if base.without_effect else []
    entries = {
        "name": found.model.name,
        "parameters": list(found.parameters),
        "base": {group.name: {"formula": group.formula, "factors": group.numbers} for group in base.groups},
        "without_effect": list(base.without_effect),
        "arithmetic": base.arithmetic,
    }
    return plain_document(found.model, lambda: entries, Lines(tuple(lines)), *rest)


def _shift(found: Identified, name: str) -> str:
    return f", noise moved it by about {found.bias[name]:.2g}" if name in found.biased else ""


def _entries(found: Identified) -> dict[str, Any]:
    return {
        "name": found.regressor.model.name,
        "samples": found.samples,
        "condition": found.condition,
        "residual": found.residual,
        "base": {name: {"value": x, "deviation": deviation} for name, (x, deviation) in found.base.items()},
        "bias": dict(found.bias),
        "values": found.values,
        "consistent_residual": found.consistent_residual,
    }


def columns_of(path: str) -> dict[str, np.ndarray]:
    """The columns of a CSV by the names in its first line.

    Raises:
        UsageError: it cannot be read, or something in it is no number.
    """
    try:
        lines = read(path, LARGEST).decode("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"cannot be read: {error}", path, "name a CSV file") from error
    rows = [row for row in csv.reader(lines) if row and not row[0].lstrip().startswith("#")]
    names = [name.strip() for name in rows[0]] if rows else []
    try:
        numbers = np.array([[float(x) for x in row] for row in rows[1:]])
    except ValueError as error:
        raise UsageError(
            f"a value is no number: {error}", path, "write names in the first line, then numbers"
        ) from error
    if len(numbers) < 2:
        raise UsageError("it has fewer than two rows of numbers", path, "write names in the first line, then numbers")
    if numbers.ndim != 2 or numbers.shape[1] != len(names):
        raise UsageError("its rows are not as long as its first line", path, "write a number under every name")
    return {name: numbers[:, k] for k, name in enumerate(names)}
