"""Model -> Freedom: the degrees of freedom by rank, beside the count by formula; redundant ties by name.

By rank:     f = nu - rank J  at a generic configuration in which the ties hold.
By formula:  f = 3 Nb + 2 Np - sum of the components of joints, ties and given motions
             (in space 6 Nb + 3 Np); it counts redundant components too, and then says too little.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, EomgenError, MissingValues, NotYet
from eomgen.mechanics.kinematics import Link, Motion, motion_of
from eomgen.mechanics.scope import Scope, scope_of
from eomgen.mechanics.ties import Ties, ties_of
from eomgen.model.parts import Model
from eomgen.model.unbuilt import unbuilt_ties
from eomgen.model.values import exact_parameters, start_values
from eomgen.symbolic.derivative import jacobian
from eomgen.symbolic.evaluation import FLOAT, evaluate
from eomgen.symbolic.graph import Node, is_zero

STEPS = 50  # of Newton's method
CLOSED = 1e-10  # of a gap, against a size of 1
DEPENDENT = 1e-7  # what is left of a unit row that the rows before it make up
SPREADS = (0.1, 0.01, 0.001)  # how far from the start a generic configuration is looked for


@dataclass(frozen=True)
class Redundant:
    """A closing row that follows from others.

    Args:
        tie, number: the row, from 1.
        others: the ties from which it follows.
    """

    tie: str
    number: int
    others: tuple[str, ...]


@dataclass(frozen=True)
class Freedom:
    """Degrees of freedom of a model.

    Args:
        by_rank: nu - rank J, None where it was not counted.
        by_formula: 3 Nb + 2 Np - the components, None where it was not counted.
        formula: the same as text.
        redundant: closing rows that follow from those declared before them.
        identical: ties that the coordinates satisfy by themselves: they only carry a reaction.
        closing: ties with rows that close.
        not_counted: why not, or "".
    """

    by_rank: int | None = None
    by_formula: int | None = None
    formula: str = ""
    redundant: tuple[Redundant, ...] = ()
    identical: tuple[str, ...] = ()
    closing: tuple[str, ...] = ()
    not_counted: str = ""


def freedom_of(model: Model) -> Freedom:
    """The degrees of freedom of a model, where its kinds are built."""
    waiting = dict.fromkeys(kind for _, kind in unbuilt_ties(model))
    if waiting:
        return Freedom(not_counted=", ".join(waiting))
    try:
        ties = ties_of(motion_of(scope_of(model)))
    except NotYet as error:
        return Freedom(not_counted=error.what)
    count, formula = counted(ties)
    identical = tuple(dict.fromkeys(row.tie for row in ties.rows if row.identical))
    closing = tuple(dict.fromkeys(row.tie for row in ties.closing))
    try:
        redundant = redundant_rows(ties)
    except EomgenError as error:
        return Freedom(None, count, formula, (), identical, closing, error.what)
    rank = len(ties.closing) - len(redundant)
    return Freedom(len(ties.motion.scope.symbols.u) - rank, count, formula, redundant, identical, closing)


# -- by formula ------------------------------------------------------------------------------------


def counted(ties: Ties) -> tuple[int, str]:
    """3 Nb + 2 Np - sum of components (in space 6 Nb + 3 Np), as a number and as text."""
    motion = ties.motion
    of_body, of_particle = (3, 2) if motion.scope.model.space == "plane" else (6, 3)
    particles = [link for link in motion.links if _is_particle(motion, link)]
    bodies = [link for link in motion.links if link not in particles]
    free = [(of_body, len(bodies), "bodies"), (of_particle, len(particles), "particles")]
    joints = sum(_components(link, of_body) for link in bodies)
    joints += sum(_components(link, of_particle) for link in particles)
    driven = sum(coordinate.driven for coordinate in motion.scope.model.coordinates.values())
    taken = [(joints, "joints"), (len(ties.rows), "ties"), (driven, "given motions")]
    total = sum(each * many for each, many, _ in free) - sum(value for value, _ in taken)
    text = " + ".join(f"{each}*{many} ({what})" for each, many, what in free if many)
    return total, text + "".join(f" - {value} ({what})" for value, what in taken if value)


def _is_particle(motion: Motion, link: Link) -> bool:
    """A point mass that its joint does not turn."""
    shape = motion.scope.model.bodies[link.name].shape
    turns = any(not is_zero(x) for w, _ in link.S for x in w)
    return shape is not None and shape.kind == "particle" and (_is_placed(link) or not turns)


def _is_placed(link: Link) -> bool:
    return link.joint is None or not link.joint.carries_reaction


def _components(link: Link, free: int) -> int:
    """How many components of motion the joint takes; what is placed, or has no joint, keeps all."""
    return 0 if _is_placed(link) else free - len(link.S)


# -- by rank ---------------------------------------------------------------------------------------


def redundant_rows(ties: Ties) -> tuple[Redundant, ...]:
    """The closing rows that follow from those before them, at a generic configuration in which the ties hold.

    Raises:
        MissingValues: the ties cannot be closed without values for the parameters.
        DerivationError: they do not close near the start.
    """
    closing = ties.closing
    if not closing:
        return ()
    J = np.array(evaluate([x for row in ties.J for x in row], generic_state(ties), FLOAT))
    J = J.reshape(len(closing), len(ties.motion.scope.symbols.u))
    found, basis = [], np.zeros((0, J.shape[1]))
    kept: list[tuple[str, np.ndarray]] = []
    for row, line in zip(closing, J, strict=True):
        size = float(np.linalg.norm(line))
        left = line - basis.T @ (basis @ line)
        left = left - basis.T @ (basis @ left)
        if size == 0 or np.linalg.norm(left) < DEPENDENT * size:
            found.append(Redundant(row.tie, row.number, _others(row.tie, line, kept)))
        else:
            basis = np.vstack([basis, left / np.linalg.norm(left)])
            kept.append((row.tie, line))
    return tuple(found)


def _others(tie: str, line: np.ndarray, kept: list[tuple[str, np.ndarray]]) -> tuple[str, ...]:
    """The ties that make up a redundant row."""
    if not kept:
        return ()
    shares = np.linalg.lstsq(np.array([row for _, row in kept]).T, line, rcond=None)[0]
    names = (name for (name, _), share in zip(kept, shares, strict=True) if abs(share) > 1e-6)
    return tuple(name for name in dict.fromkeys(names) if name != tie)


def generic_state(ties: Ties) -> dict[Node, float]:
    """Numbers for every symbol: near the start, off any special position, with phi = 0.

    Parameters without a value get one. Inputs are as at t = 0.

    Raises:
        DerivationError: the ties do not close there.
    """
    scope, rng = ties.motion.scope, Random(1)
    model, symbols = scope.model, scope.symbols
    known = exact_parameters(model)
    p = {name: float(known[name]) if name in known else rng.uniform(0.7, 1.3) for name in symbols.parameters}
    q, _ = start_values(model, p)
    state = {node: p[name] for name, node in symbols.parameters.items()} | {symbols.t: 0.0}
    for name, node in symbols.inputs.items():
        state[node] = evaluate([scope.value(model.inputs[name].value)], state, FLOAT)[0]
    state |= {node: rng.uniform(-1, 1) for node in symbols.u}
    for spread in SPREADS:
        near = {node: q[node.name] + _shift(scope, node, spread, rng) for node in symbols.q}
        closed = _closed(ties, state | near)
        if closed is not None:
            return closed
    raise _open(ties, known)


def _shift(scope: Scope, node: Node, spread: float, rng: Random) -> float:
    return 0.0 if scope.model.coordinates[node.name].driven else rng.uniform(-spread, spread)


def _open(ties: Ties, known: Mapping[str, Any]) -> EomgenError:
    missing = tuple(name for name in ties.motion.scope.symbols.parameters if name not in known)
    if missing:
        return MissingValues(missing)
    names = ", ".join(dict.fromkeys(row.tie for row in ties.closing))
    return DerivationError(f"the ties do not close near the start values: {names}", mend="change the start values")


def _closed(ties: Ties, state: dict[Node, float]) -> dict[Node, float] | None:
    """The nearest state with phi = 0, by Newton steps of least norm; None where none is near."""
    scope = ties.motion.scope
    gaps = [gap for gap in ties.phi if gap is not None]
    free = [q for q in scope.symbols.q if not scope.model.coordinates[q.name].driven]
    slopes = [x for row in jacobian(tuple(gaps), free) for x in row] if gaps else []
    for _ in range(STEPS):
        values = np.array(evaluate([*gaps, *slopes], state, FLOAT))
        phi, slope = values[: len(gaps)], values[len(gaps) :].reshape(len(gaps), len(free))
        if not np.all(np.isfinite(values)):
            return None
        if np.max(np.abs(phi), initial=0.0) < CLOSED:
            return state
        step = np.linalg.lstsq(slope, -phi, rcond=1e-12)[0]
        state = state | {q: state[q] + float(d) for q, d in zip(free, step, strict=True)}
    return None

