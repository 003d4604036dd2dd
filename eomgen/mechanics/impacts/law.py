"""M, rows of what touches, u- -> Jump: the speeds after an impact and its impulses, by numbers alone.

An impact lasts no time: positions stay, impulses change the speeds.

    M (u+ - u-) = J_b^T Lam_b + J^T Lam             J_b u+ + sigma_b = 0      (constraints: they take part)
    0 <= Lam,   0 <= v+ + e min(v-, 0),   Lam (v+ + e min(v-, 0)) = 0         v = J u + sigma   (contacts: Newton's law)

All at once this is a linear complementarity problem: with M = L L^T and the constraints' directions taken out, the
nearest point of a cone. u+ is unique, impulses of dependent rows are not.

Source: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); Glocker, Set-valued force laws
(2001), ch. 8.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field, replace
from itertools import combinations
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.impacts.friction import ENERGETIC, NEWTON, POISSON, Rubbing, alone, together
from eomgen.symbolic.numeric import tolerances

MOST_PIVOTS = 1000  # of a complementarity problem
MOST_IMPACTS = 20_000  # one after the other at one instant


@dataclass(frozen=True)
class Hit:
    """A contact that touches.

    Args:
        name: of it.
        rows: (J, sigma) of its rows, k x (n + 1); the first can only push, the others hold while it pushes.
        e: its coefficient of restitution.
        rests: it comes to rest here, as it would after bounces without end: all of its rows hold.
        mu: of its friction in the impact; 0: none.
        tangents: (J, sigma) of the sliding velocities, one in the plane, in space two; None: it has none.
    """

    name: str
    rows: np.ndarray
    e: float = 0.0
    rests: bool = False
    mu: float = 0.0
    tangents: np.ndarray | None = None

    def speed(self, u: np.ndarray) -> float:
        """v = J u + sigma of the first row; negative where it is approached."""
        return float(self.rows[0, :-1] @ u + self.rows[0, -1])


@dataclass(frozen=True)
class Jump:
    """Speeds after an impact, and its impulses.

    Args:
        u: the speeds after it.
        impulses: of each contact that touches its rows' impulses; nan where one has no single value.
        held: those of the constraints' rows.
        friction: of each contact with friction the impulses along its tangents.
    """

    u: np.ndarray
    impulses: dict[str, np.ndarray] = field(default_factory=dict)
    held: np.ndarray = field(default_factory=lambda: np.zeros(0))
    friction: dict[str, np.ndarray] = field(default_factory=dict)

    @staticmethod
    def of(
        M: np.ndarray, held: np.ndarray, touching: Sequence[Hit], u: np.ndarray, law: ImpactLaw | None = None
    ) -> Jump:
        """Speeds after the impact of the contacts that touch, and the impulses.

        Args:
            held: (J, sigma) of the constraints, k x (n + 1).
            law: None: Newton's, all at once.
        Raises:
            DerivationError: no impulses satisfy the law, or it says nothing on this.
        """
        law = law or ImpactLaw()
        if law.order == SEQUENTIAL:
            return _one_by_one(M, held, touching, u, law.law)
        if any(hit.mu and not hit.rests for hit in touching):
            return _rough(M, held, touching, u, law.law)
        if law.law == NEWTON or sum(not hit.rests for hit in touching) < 2:
            return _at_once(M, held, touching, u)
        if law.law == ENERGETIC:
            raise DerivationError(
                f"the energetic law is one of single contacts, and {_names(touching)} touch at once",
                "impact",
                'law = "newton" or "poisson", or order = "sequential"',
            )
        return _compressed(M, held, touching, u)


SIMULTANEOUS, SEQUENTIAL = "simultaneous", "sequential"


@dataclass(frozen=True)
class ImpactLaw:
    """Law by which restitution ends, and the order of what happens at one instant.

    Args:
        law: "newton" (v+ = -e v-), "poisson" (an impulse e times that of the compression), "energetic" (work e^2 times
            that of the compression).
        order: all contacts at once, or one after the other, the one approached fastest first.
    """

    law: str = NEWTON
    order: str = SIMULTANEOUS

    @staticmethod
    def of(rules: Any, rough: bool) -> ImpactLaw:
        """The declared law; where none is, Newton's, and of contacts with friction Poisson's."""
        usual = POISSON if rough else NEWTON
        return ImpactLaw(usual) if rules is None else ImpactLaw(rules.law or usual, rules.order)


def _names(touching: Sequence[Hit]) -> str:
    return ", ".join(f"'{hit.name}'" for hit in touching)


def _compressed(M: np.ndarray, held: np.ndarray, touching: Sequence[Hit], u: np.ndarray) -> Jump:
    """The jump by Poisson's law of all contacts: compression to rest, then e times its impulses, or more where needed.

    Source: Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts (1996), ch. 8.
    """
    first = _at_once(M, held, [replace(hit, e=0.0) for hit in touching], u)
    if any(not np.all(np.isfinite(x)) for x in first.impulses.values()):
        raise DerivationError(
            f"the impulses of {_names(touching)} in the compression have no single value, and Poisson's law needs them",
            "impact",
            'law = "newton"',
        )
    returned = {hit.name: hit.e * first.impulses[hit.name] for hit in touching}
    J = np.vstack([held[:, :-1], *(hit.rows[:, :-1] for hit in touching)])
    given = np.concatenate([np.zeros(len(held)), *(returned[hit.name] for hit in touching)])
    thrown = first.u + np.linalg.solve(M, J.T @ given)
    second = _at_once(M, held, [replace(hit, e=0.0) for hit in touching], thrown)
    impulses = {name: x + returned[name] + second.impulses[name] for name, x in first.impulses.items()}
    return Jump(second.u, impulses, first.held + second.held)


def _one_by_one(M: np.ndarray, held: np.ndarray, touching: Sequence[Hit], u: np.ndarray, law: str) -> Jump:
    """The jump of one contact after the other, the one approached fastest first, until none is approached.

    Raises:
        DerivationError: two are approached equally fast, and their order decides; or it does not end.
    """
    found = [_sequence(M, held, touching, u, law, first) for first in (1, -1)]
    apart = float(np.max(np.abs(found[0].u - found[1].u), initial=0.0))
    if apart > tolerances.CARRIED * _size(u):
        raise DerivationError(
            f"{_names(touching)} are approached equally fast, and the order of their impacts decides what follows",
            "impact",
            'order = "simultaneous", or a start in which one is hit first',
        )
    return found[0]


def _sequence(M: np.ndarray, held: np.ndarray, touching: Sequence[Hit], u: np.ndarray, law: str, first: int) -> Jump:
    """The jump where of contacts approached equally fast the first (1) or the last (-1) is hit."""
    size = _size(u)
    impulses = {hit.name: np.zeros(len(hit.rows)) for hit in touching}
    friction = {hit.name: np.zeros(0 if hit.tangents is None else len(hit.tangents)) for hit in touching if hit.mu}
    of_held, resting = np.zeros(len(held)), [hit for hit in touching if hit.rests]
    now, others = (_at_once(M, held, resting, u).u if resting else u), [hit for hit in touching if not hit.rests]
    for _ in range(MOST_IMPACTS):
        speeds = [hit.speed(now) for hit in others]
        fastest = min(speeds, default=0.0)
        if fastest >= -tolerances.COMPUTED * size:
            return Jump(now, impulses, of_held, friction)
        equal = [h for h, v in zip(others, speeds, strict=True) if v <= fastest + tolerances.SOLVED * size]
        hit = equal[0 if first > 0 else -1]
        after = Jump.of(M, held, [hit], now, ImpactLaw(law))
        now, of_held = after.u, of_held + after.held
        impulses[hit.name] = impulses[hit.name] + after.impulses[hit.name]
        for name, x in after.friction.items():
            friction[name] = friction[name] + x
    raise DerivationError(
        f"after {MOST_IMPACTS} impacts at one instant {_names(touching)} are still approached",
        "impact",
        'order = "simultaneous", or a larger restitution',
    )


def _size(u: np.ndarray) -> float:
    return max(1.0, float(np.max(np.abs(u), initial=0.0)))


def _at_once(M: np.ndarray, held: np.ndarray, touching: Sequence[Hit], u: np.ndarray) -> Jump:
    """The jump by Newton's law, without friction.

    Contacts with further rows (rolling ones) hold these only while they push: of all sets of such contacts the first
    that agrees is taken, the largest before smaller ones.
    """
    resting = [hit for hit in touching if hit.rests]
    space = _Space.of(M, np.vstack([held, *(hit.rows for hit in resting)]).reshape(-1, len(u) + 1), u)
    tied = [hit for hit in touching if len(hit.rows) > 1 and not hit.rests]
    plain = [hit for hit in touching if len(hit.rows) == 1 and not hit.rests]
    for count in range(len(tied), -1, -1):
        for chosen in combinations(tied, count):
            found = space.jump([*chosen, *plain], chosen)
            left = [hit for hit in tied if hit not in chosen]
            if found is not None and all(_stays_apart(hit, u, found.u) for hit in left):
                zeros = {hit.name: np.zeros(len(hit.rows)) for hit in left}
                ends = np.cumsum([len(held), *(len(hit.rows) for hit in resting)])
                own = dict(zip((hit.name for hit in resting), np.split(found.held, ends)[1:], strict=False))
                return Jump(found.u, {**zeros, **found.impulses, **own}, found.held[: len(held)])
    raise DerivationError(
        f"no impulses of the contacts {_names(touching)} satisfy the law of impact",
        fix="other restitutions, or let the contacts close one after the other",
    )


def _stays_apart(hit: Hit, before: np.ndarray, after: np.ndarray) -> bool:
    least = -hit.e * min(hit.speed(before), 0.0)
    return hit.speed(after) >= least - tolerances.COMPUTED * max(1.0, float(np.max(np.abs(before), initial=0.0)))


@dataclass(frozen=True)
class _Space:
    """Speeds in which the kinetic energy is w^T w/2: w = L^T u, M = L L^T.

    Args:
        L: lower triangular.
        held: the constraints' rows.
    """

    L: np.ndarray
    held: np.ndarray
    u: np.ndarray

    @staticmethod
    def of(M: np.ndarray, held: np.ndarray, u: np.ndarray) -> _Space:
        try:
            return _Space(np.linalg.cholesky(M), held, u)
        except np.linalg.LinAlgError:
            raise DerivationError(
                "the mass matrix is singular where contacts close, and impulses are not determined",
                fix="give every moving part a mass",
            ) from None

    def whitened(self, rows: np.ndarray) -> np.ndarray:
        """J L^-T of rows (J, sigma)."""
        return np.asarray(np.linalg.solve(self.L, rows[:, :-1].T).T)

    def jump(self, pushing: Sequence[Hit], tied: Sequence[Hit]) -> Jump | None:
        """The jump with the further rows of some contacts held; None where one of these would have to pull."""
        w, n = self.L.T @ self.u, len(self.u)
        H = np.vstack([self.held, *(hit.rows[1:] for hit in tied)]).reshape(-1, n + 1)
        A_H = self.whitened(H)
        back = _inverse(A_H)
        w_held = w - back @ (A_H @ w + H[:, -1])
        free = np.eye(n) - back @ A_H
        normals = np.array([hit.rows[0] for hit in pushing]).reshape(-1, n + 1)
        A = self.whitened(normals)
        before = A @ w + normals[:, -1]
        q = A @ w_held + normals[:, -1] + np.array([hit.e for hit in pushing]) * np.minimum(before, 0.0)
        impulses = complementary(A @ free, q)
        if impulses is None:
            return None
        w_after = w_held + free @ A.T @ impulses
        left = q + A @ (w_after - w_held)
        size = max(1.0, float(np.max(np.abs(self.u), initial=0.0)))
        if any(left[k] > tolerances.COMPUTED * size for k in range(len(tied))):
            return None
        u = np.linalg.solve(self.L.T, w_after)
        tight = [k for k in range(len(pushing)) if left[k] <= tolerances.COMPUTED * size]
        of_held = back.T @ (w_after - w - A.T @ impulses)
        alone = _determined(np.vstack([A_H, A[tight]]))
        of_held[~alone[: len(H)]] = np.nan
        impulses[[k for k, one in zip(tight, alone[len(H) :], strict=True) if not one]] = np.nan
        return Jump(u, dict(_shared(pushing, tied, impulses, of_held[len(self.held) :])), of_held[: len(self.held)])


def _shared(
    pushing: Sequence[Hit], tied: Sequence[Hit], normal: np.ndarray, further: np.ndarray
) -> Iterator[tuple[str, np.ndarray]]:
    """(contact, its impulses), those of its further rows after that of the first."""
    first = 0
    for k, hit in enumerate(pushing):
        more = len(hit.rows) - 1 if k < len(tied) else 0
        yield hit.name, np.concatenate([normal[k : k + 1], further[first : first + more]])
        first += more


def _inverse(rows: np.ndarray) -> np.ndarray:
    """A^+ of rows that are scaled to length 1, of their rank where the place itself is known to rounding only."""
    if not len(rows):
        return np.zeros((rows.shape[1], 0))
    lengths = np.linalg.norm(rows, axis=1)
    lengths = np.where(lengths > 0, lengths, 1.0)
    return np.asarray(np.linalg.pinv(rows / lengths[:, None], rcond=tolerances.RANK_NEARBY) / lengths)


def _determined(rows: np.ndarray) -> np.ndarray:
    """True for each row whose multiplier has one value: it is no combination of the others."""
    if not len(rows):
        return np.zeros(0, dtype=bool)
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    _, s, V = np.linalg.svd((rows / np.where(lengths > 0, lengths, 1.0)).T)
    rank = int(np.sum(s > tolerances.RANK_NEARBY))
    return np.asarray(np.max(np.abs(V[rank:]), axis=0, initial=0.0) <= tolerances.SHARE)


# -------- complementarity -------------------------------------------------------------------------------------


def complementary(A: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """z >= 0 with A A^T z + q >= 0 and z^T (A A^T z + q) = 0; None where there is none.

    With A y = q, A^T z is the point of a cone nearest to -y. Where q is no combination of the columns (unlike
    restitutions of dependent contacts) Lemke's method decides.
    """
    from scipy.optimize import nnls

    if not len(q):
        return np.zeros(0)
    y = np.linalg.lstsq(A, q, rcond=tolerances.RANK_NEARBY)[0]
    size = max(1.0, float(np.max(np.abs(q))))
    if np.max(np.abs(A @ y - q)) <= tolerances.COMPUTED * size:
        return np.asarray(nnls(A.T, -y)[0])
    return lemke(A @ A.T, q)


def lemke(G: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """z >= 0, w = G z + q >= 0, z^T w = 0 by Lemke's method, equal ratios lexicographically; None: it ends on a ray.

    Source: Cottle, Pang & Stone, The Linear Complementarity Problem (1992), algorithm 4.4.5.
    """
    n = len(q)
    if np.all(q >= 0):
        return np.zeros(n)
    size, least_cover = float(np.max(np.abs(G))), tolerances.COMPUTED * float(np.max(np.abs(q)))
    # columns: w (n), z (n), cover z0, right side q;   w - G z - z0 = q
    table = np.hstack([np.eye(n), -G, -np.ones((n, 1)), q[:, None]])
    basis = list(range(n))
    row, entering = min(range(n), key=lambda i: (q[i], i)), 2 * n
    for _ in range(MOST_PIVOTS):
        table[row] /= table[row, entering]
        others = np.arange(n) != row
        table[others] -= np.outer(table[others, entering], table[row])
        leaving, basis[row] = basis[row], entering
        if leaving == 2 * n:
            return _solved(table, basis)
        entering = leaving + n if leaving < n else leaving - n
        column = table[:, entering]
        falling = [i for i in range(n) if column[i] > tolerances.COMPUTED * size]
        if not falling:
            return _solved(table, basis) if table[basis.index(2 * n), -1] <= least_cover else None
        ratios = {i: [table[i, -1] / column[i], *(table[i, :n] / column[i])] for i in falling}
        least = min(ratio[0] for ratio in ratios.values())
        tied = [i for i in falling if ratios[i][0] <= least + tolerances.SOLVED * max(1.0, abs(least))]
        cover = [i for i in tied if basis[i] == 2 * n]
        row = cover[0] if cover else min(tied, key=lambda i: ratios[i][1:])
    return None


def _solved(table: np.ndarray, basis: list[int]) -> np.ndarray:
    """z of a table whose cover is 0."""
    n = len(table)
    found = np.zeros(2 * n + 1)
    found[basis] = table[:, -1]
    return np.maximum(found[n : 2 * n], 0.0)


# -------- friction --------------------------------------------------------------------------------------------
# Contacts that rub -> their jump: those that act on one another together, any other alone.


def _rough(M: np.ndarray, held: np.ndarray, touching: Sequence[Hit], u: np.ndarray, law: str) -> Jump:
    """The jump where friction has a part.

    Raises:
        DerivationError: a law says nothing on it, or more than one thing, it jams, or it gains energy.
    """
    moving = [hit for hit in touching if not hit.rests]
    tied = [hit for hit in moving if len(hit.rows) > 1]
    if tied:
        raise DerivationError(
            f"{_names(tied)} rolls, and friction has a part in the same impact: that is not derived",
            "impact",
            'order = "sequential", or `slip = true` with a friction',
        )
    space = _Space.of(M, np.vstack([held, *(h.rows for h in touching if h.rests)]).reshape(-1, len(u) + 1), u)
    rows = [np.vstack([hit.rows, *([hit.tangents] if hit.tangents is not None else [])]) for hit in moving]
    first = np.cumsum([0, *map(len, rows)])
    whole = np.vstack(rows)
    A_H, free = space.whitened(space.held), space.whitened(whole)
    back, w = _inverse(A_H), space.L.T @ u
    w = w - back @ (A_H @ w + space.held[:, -1])
    A = free @ (np.eye(len(u)) - back @ A_H)
    D, v = A @ A.T, A @ w + whole[:, -1]
    p, sure = np.zeros(len(v)), np.ones(len(v), dtype=bool)
    for own in _acting_together(D, first):
        places = np.concatenate([np.arange(first[k], first[k + 1]) for k in own])
        contacts = [Rubbing(moving[k].name, moving[k].mu, moving[k].e, len(rows[k])) for k in own]
        if len(own) > 1:
            p[places], sure[places] = together(D[np.ix_(places, places)], v[places], contacts, law)
        else:
            p[places] = alone(D[np.ix_(places, places)], v[places], contacts[0], law)
    after = w + A.T @ p
    if not np.any(whole[:, -1]) and not np.any(space.held[:, -1]):
        _refuse_gain(float(after @ after - w @ w) / 2, float(w @ w) / 2, touching, law)
    of_held = back.T @ (after - space.L.T @ u - free.T @ p)
    of_held[~_determined(A_H)] = np.nan
    p[~sure] = np.nan
    found = np.linalg.solve(space.L.T, after)
    impulses = {h.name: np.full(len(h.rows), np.nan) for h in touching if h.rests}
    friction: dict[str, np.ndarray] = {}
    for hit, k, end in zip(moving, first, first[1:], strict=False):
        impulses[hit.name] = p[k : k + 1]
        friction |= {hit.name: p[k + 1 : end]} if hit.mu else {}
    return Jump(found, impulses, of_held[: len(held)], friction)


def _acting_together(D: np.ndarray, first: np.ndarray) -> Iterator[list[int]]:
    """The contacts in groups: an impulse at one of a group changes no speed of another group's."""
    n = len(first) - 1
    scale = np.sqrt(np.maximum(np.diag(D), tolerances.TINIEST))
    acts = np.abs(D / np.outer(scale, scale)) > tolerances.COMPUTED
    left = set(range(n))
    while left:
        own, new = set[int](), {min(left)}
        while new:
            own |= new
            blocks = ((j, acts[first[k] : first[k + 1], first[j] : first[j + 1]]) for k in new for j in left - own)
            new = {j for j, block in blocks if np.any(block)}
        left -= own
        yield sorted(own)


def _refuse_gain(gained: float, before: float, touching: Sequence[Hit], law: str) -> None:
    """Refuses an impact against what is at rest that gains kinetic energy [J].

    Raises:
        DerivationError: it does.
    """
    if gained > tolerances.CARRIED * before:
        what = f"by {law.capitalize()}'s law with friction the impact of {_names(touching)} gains {gained:.3g} J"
        raise DerivationError(what, "impact", 'law = "poisson" or order = "sequential"')
