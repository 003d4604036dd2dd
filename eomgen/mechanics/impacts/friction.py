"""D, v of contacts that rub -> their impulses: D = [n; t] M^-1 [n; t]^T changes their speeds v = (v_n, v_t).

A contact alone: the impulses grow from 0, the normal one p steadily (Routh's graph; v_t has two components in space).

    v_n' = D_nn + D_nt F,   v_t' = D_tn + D_tt F       by p
    slides:  F = - mu v_t/|v_t|       sticks:  F = - D_tt^-1 D_tn where |F| <= mu

Where it can neither stick nor slides yet, it leaves along the one direction s that stays:  D_tn - mu D_tt s = k s,
k > 0 (|(k + mu D_tt)^-1 D_tn| falls with k: one k makes it 1). Compression ends where v_n = 0. Restitution ends, with
e, where

    Newton  v_n = - e v_n(0)     Poisson  p = (1 + e) p_c     Stronge  W = W_c - e^2 W_c,   W = integral of v_n dp

Contacts that act on one another: by their speeds at the end of compression (Poisson: and at that of restitution, which
gives at least e p_c), complementary, with Coulomb's law for the same speeds, its cone round in space. Each set of modes
(open, sticks, slides on, slides back; in space slides, along the direction s of the speed that it leaves) is tried, and
several may agree. So one step stands for each phase: how the directions of sliding turn within it is not followed.

Source: Routh, Dynamics of a System of Rigid Bodies, Elementary Part (1905), art. 187-198; Keller, Impact with friction
(1986); Batlle, The sliding velocity flow of rigid-body impacts (1996); Stronge, Impact Mechanics (2000), ch. 8;
Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts (1996), ch. 8; Moreau, Unilateral contact and dry
friction in finite freedom dynamics (1988).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.numeric import tolerances

NEWTON, POISSON, ENERGETIC = "newton", "poisson", "energetic"
MOST_PIECES = 20  # of an impact with friction: compression, sliding, sticking, sliding back, restitution
MOST_TOGETHER, MOST_IN_SPACE = 5, 4  # contacts that act on one another in one impact
JAMS = 1e6  # times the impulse that ends the approach without friction: no impulse ends it
HALVINGS = 200  # of an interval with one root
SIDES = 64  # of a polygon around a round cone, within which impulses that are not single are sought
STARTS, MOST_STARTS = 4, 64  # directions from which these are sought; where nothing is found
MOST_TURNS = 12  # steps of Newton's method for directions of sliding
LARGEST_TURN = 0.5  # of one of them [rad]
OFF_ANGLE = 1e-3  # by which the search begins aside, where all would be symmetric [rad]


@dataclass(frozen=True)
class Rubbing:
    """A contact in an impact.

    Args:
        name: of it.
        mu: of its friction; 0: none.
        e: its coefficient of restitution.
        size: how many speeds it has: v_n, and those along its tangents.
    """

    name: str
    mu: float
    e: float
    size: int = 2


# -------- one contact -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Grown:
    """An impact so far: speeds (v_n, v_t), impulses (p_n, p_t), W; p and W at the end of compression."""

    v: np.ndarray
    p: np.ndarray
    W: float = 0.0
    compressed: tuple[float, float] | None = None

    def by(self, D: np.ndarray, F: np.ndarray, p: float) -> Grown:
        """The impact a normal impulse p later, where friction F for a unit of it stays the same."""
        push = np.concatenate([[1.0], F])
        work = self.v[0] * p + D[0] @ push * p * p / 2
        return replace(self, v=self.v + D @ push * p, p=self.p + push * p, W=self.W + float(work))


def alone(D: np.ndarray, v: np.ndarray, contact: Rubbing, law: str = POISSON) -> np.ndarray:
    """The impulses (p_n, p_t) of a contact that is hit alone.

    Args:
        D: of (v_n, v_t) for unit impulses [1/kg]; one tangent in the plane, two in space.
        v: (v_n, v_t) before it.
    Raises:
        DerivationError: it jams: no impulse ends the compression, or the restitution.
    """
    if v[0] >= 0:
        return np.zeros(len(v))
    begun, now = float(v[0]), Grown(np.array(v, dtype=float), np.zeros(len(v)))
    for _ in range(MOST_PIECES):
        was = now.compressed
        end = "v_n", 0.0
        if was is not None:
            end = {
                NEWTON: ("v_n", -contact.e * begun),
                POISSON: ("p", (1 + contact.e) * was[0]),
                ENERGETIC: ("W", (1 - contact.e**2) * was[1]),
            }[law]
        now, is_over = _piece(D, now, contact, end)
        if is_over and was is not None:
            return now.p
        if is_over:
            now = replace(now, compressed=(float(now.p[0]), now.W))
            if contact.e == 0:
                return now.p
    raise DerivationError(
        f"the impact of '{contact.name}' does not end", f"constraints.{contact.name}", "another restitution"
    )


def _piece(D: np.ndarray, now: Grown, contact: Rubbing, end: tuple[str, float]) -> tuple[Grown, bool]:
    """(the impact where it ends, or sliding does; True if it is its end)."""
    v_t = now.v[1:]
    if len(v_t) == 2 and np.any(v_t) and contact.mu:
        return _curved(D, now, contact, end)
    F = _friction(D, v_t, contact.mu)
    slope = D @ np.concatenate([[1.0], F])
    to_stick = math.inf
    if len(v_t) == 1 and v_t[0] * slope[1] < 0:
        to_stick = float(-v_t[0] / slope[1])
    to_end = _to(end, now, float(slope[0]))
    step = min(to_end, to_stick)
    if not math.isfinite(step):
        raise _jams(contact)
    after = now.by(D, F, step)
    if step == to_stick:
        return replace(after, v=np.array([after.v[0], 0.0])), False
    return (replace(after, v=np.array([0.0, *after.v[1:]])) if end == ("v_n", 0.0) else after), True


def _jams(contact: Rubbing) -> DerivationError:
    what = f"'{contact.name}' jams in its impact: with mu = {contact.mu:.4g} no impulse ends the approach"
    return DerivationError(what, f"constraints.{contact.name}", "less friction, or another position (Painleve)")


def _friction(D: np.ndarray, v_t: np.ndarray, mu: float) -> np.ndarray:
    """F for a unit of the normal impulse: it slides, sticks, or leaves the state of sticking."""
    if not mu or not len(v_t):
        return np.zeros(len(v_t))
    if np.any(v_t):
        return np.asarray(-mu * v_t / np.linalg.norm(v_t))
    sticks = -np.linalg.lstsq(D[1:, 1:], D[1:, 0], rcond=tolerances.RANK_NEARBY)[0]
    return sticks if np.linalg.norm(sticks) <= mu else -mu * leaving(D, mu)


def leaving(D: np.ndarray, mu: float) -> np.ndarray:
    """The direction s in which a contact begins to slide that cannot stick: D_tn - mu D_tt s = k s, k > 0."""
    found, V = np.linalg.eigh(D[1:, 1:])
    b = V.T @ D[1:, 0]

    def length(k: float) -> float:
        return float(np.linalg.norm(b / (k + mu * found)))

    low, high = 0.0, float(np.linalg.norm(b))
    for _ in range(HALVINGS):
        k = (low + high) / 2
        if k in (low, high):
            break
        low, high = (k, high) if length(k) > 1 else (low, k)
    s = V @ (b / (high + mu * found))
    return np.asarray(s / np.linalg.norm(s))


def _to(end: tuple[str, float], now: Grown, slope: float) -> float:
    """Normal impulse that is left to an end, where friction stays the same; inf where it does not come."""
    what, value = end
    v = float(now.v[0])
    if what == "p":
        return value - float(now.p[0])
    if what == "v_n":
        return (value - v) / slope if slope > 0 else math.inf
    missing = value - now.W  # v x + slope x^2/2 = missing, the first root above 0
    discriminant = v * v + 2 * slope * missing
    if discriminant < 0 or missing < 0:
        return 0.0 if missing < 0 else math.inf
    root = math.sqrt(discriminant)
    return 2 * missing / (v + root) if v + root > 0 else math.inf


# -- sliding in space: v_t = |v_t| s(theta) turns, and slows down
#
#     |v_t|' = b . s,   |v_t| theta' = b . s_theta,   b = D_tn - mu D_tt s     by p;  with dp = |v_t| dtau it has no end


def _curved(D: np.ndarray, now: Grown, contact: Rubbing, end: tuple[str, float]) -> tuple[Grown, bool]:
    """The same, of a contact that slides in space."""
    from scipy.integrate import solve_ivp

    mu, v_t = contact.mu, now.v[1:]
    unit_v, unit_D = float(np.max(np.abs(now.v))), float(np.max(np.diag(D)))
    unit_p = unit_v / unit_D
    A, speed = D / unit_D, float(np.linalg.norm(v_t)) / unit_v
    scales = {"v_n": unit_v, "p": unit_p, "W": unit_v * unit_p}
    begun = {"v_n": now.v[0], "p": now.p[0], "W": now.W}
    place = {"p": 2, "v_n": 3, "W": 4}[end[0]]
    target = (end[1] - float(begun[end[0]])) / scales[end[0]] + (float(now.v[0]) / unit_v if end[0] == "v_n" else 0.0)

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        s = np.array([math.cos(y[1]), math.sin(y[1])])
        F = -mu * s
        grown = math.exp(y[0])
        slope = A @ np.array([1.0, *F])
        along, across = slope[1:] @ s, s[0] * slope[2] - s[1] * slope[1]
        return np.array([along, across, grown, grown * slope[0], grown * y[3], grown * F[0], grown * F[1]])

    left = math.log(speed)
    y = np.array([left, math.atan2(v_t[1], v_t[0]), 0.0, float(now.v[0]) / unit_v, 0.0, 0.0, 0.0])
    ends: list[Callable[[float, np.ndarray], float]] = [
        lambda _, y: float(y[place] - target),
        lambda _, y: float(y[0] - left - math.log(tolerances.ROUNDING)),
        lambda _, y: float(y[2] - JAMS),
    ]
    for each in ends:
        vars(each)["terminal"] = True
    found = solve_ivp(
        rate, (0.0, math.inf), y, method="DOP853", rtol=tolerances.LEAST_RTOL, atol=tolerances.SUMMED, events=ends
    )
    y, which = found.y[:, -1], [len(times) > 0 for times in found.t_events]
    if which[2] or not any(which):
        raise _jams(contact)
    if which[0]:
        for _ in range(3):  # to the end itself, from where a polynomial has it
            slope = rate(0.0, y)
            step = (target - y[place]) / slope[place]
            y = y + step * rate(0.0, y + step / 2 * slope)
    after = Grown(
        np.array([y[3], math.exp(y[0]) * math.cos(y[1]), math.exp(y[0]) * math.sin(y[1])]) * unit_v,
        now.p + np.array([y[2], y[5], y[6]]) * unit_p,
        now.W + float(y[4]) * unit_v * unit_p,
        now.compressed,
    )
    if not which[0]:
        return replace(after, v=np.array([after.v[0], 0.0, 0.0])), False
    return (replace(after, v=np.array([0.0, *after.v[1:]])) if end == ("v_n", 0.0) else after), True


# -------- several contacts that act on one another ------------------------------------------------------------


@dataclass(frozen=True)
class Way:
    """One way in which contacts go through a phase of an impact.

    Args:
        modes: of each contact in words.
        v, p: speeds after it and impulses.
        sure: True for each impulse that has one value.
    """

    modes: tuple[str, ...]
    v: np.ndarray
    p: np.ndarray
    sure: np.ndarray


def together(D: np.ndarray, v: np.ndarray, contacts: Sequence[Rubbing], law: str) -> tuple[np.ndarray, np.ndarray]:
    """(impulses (p_n, p_t) of the contacts one after the other, True for each that has one value).

    Raises:
        DerivationError: several ways agree with the law, or none; too many contacts; another law.
    """
    names = _names(contacts)
    if law == ENERGETIC:
        what = f"the energetic law is one of single contacts, and {names} touch at once"
        raise DerivationError(what, "impact", 'law = "newton" or "poisson", or order = "sequential"')
    in_space = any(contact.size > 2 for contact in contacts)
    most = MOST_IN_SPACE if in_space else MOST_TOGETHER
    if len(contacts) > most:
        where = f"of more than {most}{' in space' if in_space else ''}"
        what = f"friction in an impact of several contacts at once {where} ({names}) is not derived"
        fix = 'order = "sequential", or no restitution and no [impact]: then friction has no part in impacts'
        raise DerivationError(what, "impact", fix)
    unit_v, unit_D = float(np.max(np.abs(v), initial=0.0)) or 1.0, float(np.max(np.diag(D)))
    p, sure = _by_phases(D / unit_D, v / unit_v, contacts, law)
    return p * unit_v / unit_D, sure


def _by_phases(D: np.ndarray, v: np.ndarray, contacts: Sequence[Rubbing], law: str) -> tuple[np.ndarray, np.ndarray]:
    """The same without units; by Newton's law in one phase, by Poisson's in two."""
    first = _places(contacts)
    none, normals = np.zeros(len(contacts)), v[first]
    e = np.array([contact.e for contact in contacts])
    if law == NEWTON:
        found = _one_way(D, v, contacts, none, e * np.minimum(normals, 0.0))
        return found.p, found.sure
    pressed = _one_way(D, v, contacts, none, none)
    if np.any(~pressed.sure[first] & (e > 0)):
        what = (
            f"the impulses of {_names(contacts)} in the compression have no single value, and Poisson's law needs them"
        )
        raise DerivationError(what, "impact", 'law = "newton"')
    returned = e * np.where(e > 0, pressed.p[first], 0.0)
    found = _one_way(D, pressed.v, contacts, returned, none)
    return pressed.p + found.p, pressed.sure & found.sure


def _names(contacts: Sequence[Rubbing]) -> str:
    return ", ".join(f"'{contact.name}'" for contact in contacts)


def _places(contacts: Sequence[Rubbing]) -> np.ndarray:
    """Place of each contact's v_n."""
    return np.cumsum([0, *(contact.size for contact in contacts)])[:-1]


def _one_way(D: np.ndarray, v: np.ndarray, contacts: Sequence[Rubbing], given: np.ndarray, returns: np.ndarray) -> Way:
    """The one way through a phase:  0 <= p_n - given,  0 <= v_n + returns,  one of them 0;  Coulomb's law for v_t.

    Raises:
        DerivationError: there are several, or none.
    """
    size = max(1.0, float(np.max(np.abs(v))))
    ways: list[Way] = []
    found = list(_ways(D, v, contacts, given, returns, STARTS))
    if not found and any(contact.size > 2 for contact in contacts):
        found = list(_ways(D, v, contacts, given, returns, MOST_STARTS))
    for way in found:
        near = [k for k, w in enumerate(ways) if np.max(np.abs(w.v - way.v)) <= tolerances.CARRIED * size]
        if near:
            alike = np.abs(ways[near[0]].p - way.p) <= tolerances.SHARE * size
            ways[near[0]] = replace(ways[near[0]], sure=ways[near[0]].sure & alike)
        else:
            ways.append(way)
    if len(ways) == 1:
        return ways[0]
    if not ways:
        what = f"no impulses of the contacts {_names(contacts)} satisfy the law of impact"
        raise DerivationError(what, fix="less friction")
    said = "; or ".join(
        ", ".join(f"'{contact.name}' {mode}" for contact, mode in zip(contacts, way.modes, strict=True)) for way in ways
    )
    what = f"friction leaves {len(ways)} ways for the impact of {_names(contacts)}: {said}"
    raise DerivationError(what, "impact", 'less friction, or order = "sequential"')


OPENS, STICKS, SLIDES_ON, SLIDES_BACK, STAYS = "opens", "sticks", "slides on", "slides back", "stays"
SLIDES = "slides"  # in space, along a direction that is to be found
_SENSES = {SLIDES_ON: np.array([1.0]), SLIDES_BACK: np.array([-1.0])}


def _ways(
    D: np.ndarray, v: np.ndarray, contacts: Sequence[Rubbing], given: np.ndarray, returns: np.ndarray, count: int
) -> Iterator[Way]:
    """Every way, those with one speed after it more than once where it is a border.

    Args:
        count: directions of sliding, in space, from which its own is sought.
    """
    offered = []
    for contact, least in zip(contacts, given, strict=True):
        slides = (SLIDES,) if contact.size > 2 else (SLIDES_ON, SLIDES_BACK)
        rubs = (STICKS, *slides) if contact.mu and contact.size > 1 else (STAYS,)
        own = [(True, mode) for mode in rubs]
        offered.append([*own, *([(False, mode) for mode in rubs] if least > 0 else [(False, OPENS)])])
    for modes in product(*offered):
        phase = Phase(D, v, tuple(contacts), modes, given, returns)
        for senses in phase.senses(count):
            way = phase.way(senses)
            if way is not None:
                yield way


@dataclass(frozen=True)
class Phase:
    """A phase of an impact in which each contact has a mode: linear equations for its impulses, sliding along s.

    Args:
        modes: of each contact (closed, how it rubs).
        given: normal impulses at least.
        returns: what is added to v_n of what is closed: it leaves with minus that.
    """

    D: np.ndarray
    v: np.ndarray
    contacts: tuple[Rubbing, ...]
    modes: tuple[tuple[bool, str], ...]
    given: np.ndarray
    returns: np.ndarray

    def senses(self, count: int) -> Iterator[dict[int, np.ndarray]]:
        """The directions along which contacts slide, {number of it: s}: in space each that a search comes to.

        Args:
            count: directions from which it is sought.
        """
        known = {i: _SENSES[mode] for i, (_, mode) in enumerate(self.modes) if mode in _SENSES}
        turning = [i for i, (_, mode) in enumerate(self.modes) if mode == SLIDES]
        if not turning:
            yield known
            return
        found: list[np.ndarray] = []
        for reached in self._turned(known, turning, self._starts(count)):
            if all(np.max(np.abs(_wrapped(reached - x))) > tolerances.SAME_PLACE for x in found):
                found.append(reached)
                yield {**known, **_directions(turning, reached)}

    def _starts(self, count: int) -> np.ndarray:
        """Angles from which directions are sought, of those before the impact: each turned by itself, or all alike."""
        first = _places(self.contacts)
        own = [k + 1 for k, (_, mode) in zip(first, self.modes, strict=True) if mode == SLIDES]
        before = np.array([math.atan2(self.v[k + 1], self.v[k]) for k in own]) + OFF_ANGLE
        turns = [2 * math.pi * k / count for k in range(count)]
        alike = count ** len(own) > MOST_STARTS or len(own) > 2
        return np.asarray(
            before + ([[x] * len(own) for x in turns] if alike else list(product(turns, repeat=len(own))))
        )

    def _turned(self, known: dict[int, np.ndarray], turning: Sequence[int], angles: np.ndarray) -> Iterator[np.ndarray]:
        """Angles of leaving along the own direction, v_t x s = 0, v_t . s >= 0, by Newton's method from many at once.

        E p = right; of another angle E' p + E p' = 0, E' = mu s' in the rows of that contact's friction.
        """
        first, size = _places(self.contacts), max(1.0, float(np.max(np.abs(self.v))))
        across = np.array([[first[i] + 1, first[i] + 2] for i in turning])
        n, m, number = len(self.v), len(turning), np.arange(len(turning))
        mu = np.array([self.contacts[i].mu for i in turning])
        base, right, _ = self._equations({**known, **_directions(turning, angles[0])})
        regular = np.linalg.matrix_rank(base, tol=tolerances.NEARLY_SINGULAR) == n
        for _ in range(MOST_TURNS):
            s = np.stack([np.cos(angles), np.sin(angles)], axis=2)
            turned = np.stack([-s[..., 1], s[..., 0]], axis=2)
            E = np.repeat(base[None], len(angles), axis=0)
            E[:, across, (across[:, 0] - 1)[:, None]] = mu[:, None] * s
            inverse = np.linalg.inv(E) if regular else np.linalg.pinv(E, rcond=tolerances.RANK_NEARBY)
            p = inverse @ right
            aside = np.zeros((len(angles), n, m))
            aside[:, across, number[:, None]] = (mu * p[:, across[:, 0] - 1])[..., None] * turned
            v, slopes = self.v + p @ self.D.T, -self.D @ inverse @ aside
            left, along = np.sum(turned * v[:, across], axis=2), np.sum(s * v[:, across], axis=2)
            done = np.max(np.abs(left), axis=1) <= tolerances.SOLVED * size
            yield from angles[done & np.all(along >= -tolerances.COMPUTED * size, axis=1)]
            go = ~done & np.all(np.isfinite(left), axis=1)
            if not np.any(go):
                return
            growth = np.einsum("aik,aikj->aij", turned, slopes[:, across])[go]
            growth[:, number, number] -= along[go]
            change = -(np.linalg.pinv(growth, rcond=tolerances.RANK_NEARBY) @ left[go][..., None])[..., 0]
            largest = np.maximum(np.max(np.abs(change), axis=1, keepdims=True), tolerances.TINIEST)
            angles = angles[go] + change * np.minimum(1.0, LARGEST_TURN / largest)

    def _equations(self, senses: dict[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
        """(E, right, rows) of E p = right, and rows (a, b) of a p + b >= 0."""
        n, first, unit = len(self.v), _places(self.contacts), np.eye(len(self.v))
        E, right, at_least = np.zeros((n, n)), np.zeros(n), list[np.ndarray]()
        for i, (k, contact, (closed, mode)) in enumerate(zip(first, self.contacts, self.modes, strict=True)):
            leaves = self.v[k] + self.returns[i]
            E[k], right[k] = (self.D[k], -leaves) if closed else (unit[k], self.given[i])
            at_least.append(np.append(unit[k], -self.given[i]) if closed else np.append(self.D[k], leaves))
            along = slice(k + 1, k + contact.size)
            if mode == STICKS:
                E[along], right[along] = self.D[along], -self.v[along]
            else:
                E[along] = unit[along]
            if i in senses:
                E[along] += contact.mu * np.outer(senses[i], unit[k])
                at_least.append(senses[i] @ np.hstack([self.D[along], self.v[along, None]]))
        return E, right, at_least

    def way(self, senses: dict[int, np.ndarray]) -> Way | None:
        """The way along these directions; None where it does not agree with the law.

        Raises:
            DerivationError: friction leaves it no single value.
        """
        E, right, at_least = self._equations(senses)
        lengths = np.linalg.norm(E, axis=1)
        E, right = E / lengths[:, None], right / lengths
        U, s, V = np.linalg.svd(E)
        rank = int(np.sum(s > tolerances.RANK_NEARBY))
        p = V[:rank].T @ ((U[:, :rank].T @ right) / s[:rank])
        size = max(1.0, float(np.max(np.abs(right), initial=0.0)))
        if np.max(np.abs(E @ p - right), initial=0.0) > tolerances.COMPUTED * size:
            return None
        rows = np.array([*at_least, *(self._sides if rank < len(p) else ())])
        rows = rows / np.maximum(np.linalg.norm(rows[:, :-1], axis=1), tolerances.TINIEST)[:, None]
        turning = [i for i, (_, mode) in enumerate(self.modes) if mode == SLIDES]
        Z = V[rank:].T
        if turning:  # other impulses may not change the speeds: the directions are those of the ones that were found
            _, s, V = np.linalg.svd(np.vstack([E, self.D]))
            Z = V[int(np.sum(s > tolerances.RANK_NEARBY)) :].T
        found = _inside(rows, p, Z)
        if found is None or not self._holds(found):
            return None
        first, after = _places(self.contacts), self.v + self.D @ found
        if any(senses[i] @ after[first[i] + 1 : first[i] + 3] <= tolerances.COMPUTED * size for i in turning):
            return None  # it sticks, at the border of its cone
        if np.max(np.abs(self.D @ Z), initial=0.0) > tolerances.SHARE:
            what = f"friction leaves the impact of {_names(self.contacts)} no single value"
            raise DerivationError(what, "impact", 'less friction, or order = "sequential"')
        sure = np.max(np.abs(Z), axis=1, initial=0.0) <= tolerances.SHARE
        words = tuple(_in_words(mode, senses.get(i)) for i, (_, mode) in enumerate(self.modes))
        return Way(words, after, found, sure)

    def _holds(self, p: np.ndarray) -> bool:
        """True if what sticks does so by impulses inside its cone, which is round in space."""
        places = zip(_places(self.contacts), self.contacts, self.modes, strict=True)
        size = tolerances.COMPUTED * max(1.0, float(np.max(np.abs(p))))
        own = ((k, each) for k, each, (_, mode) in places if mode == STICKS)
        return all(float(np.linalg.norm(p[k + 1 : k + each.size])) <= each.mu * p[k] + size for k, each in own)

    @property
    def _sides(self) -> Iterator[np.ndarray]:
        """Rows (a, b) of what sticks: a p >= 0 of the two sides of its cone, in space of a polygon around it."""
        for k, contact, (_, mode) in zip(_places(self.contacts), self.contacts, self.modes, strict=True):
            if mode == STICKS and contact.size > 1:
                turns = 2 * math.pi * np.arange(SIDES) / SIDES if contact.size > 2 else np.array([0.0, math.pi])
                rows = np.zeros((len(turns), len(self.v) + 1))
                rows[:, k] = contact.mu
                rows[:, k + 1 : k + contact.size] = np.stack([np.cos(turns), np.sin(turns)], axis=1)[
                    :, : contact.size - 1
                ]
                yield from rows


def _directions(turning: Sequence[int], angles: np.ndarray) -> dict[int, np.ndarray]:
    return {i: np.array([math.cos(x), math.sin(x)]) for i, x in zip(turning, angles.tolist(), strict=True)}


def _wrapped(angles: np.ndarray) -> np.ndarray:
    return np.asarray((angles + math.pi) % (2 * math.pi) - math.pi)


def _in_words(mode: str, s: np.ndarray | None) -> str:
    """The mode, in space with the direction in which it slides."""
    return f"{mode} along ({s[0]:.3g}, {s[1]:.3g})" if mode == SLIDES and s is not None else mode


def _inside(rows: np.ndarray, p: np.ndarray, Z: np.ndarray) -> np.ndarray | None:
    """p + Z y that satisfies a p + b >= 0, p itself if it does (else deep inside); None where none does."""
    from scipy.optimize import linprog

    size, k = max(1.0, float(np.max(np.abs(p)))), Z.shape[1]
    moves, left = rows[:, :-1] @ Z, rows[:, :-1] @ p + rows[:, -1]
    stays = np.max(np.abs(moves), axis=1, initial=0.0) <= tolerances.SHARE
    least = -tolerances.COMPUTED * size
    if np.all(left >= least):
        return p
    if not k or np.any(left[stays] < least):
        return None
    A = np.hstack([-moves[~stays], np.ones((int(np.sum(~stays)), 1))])
    bounds = [(-JAMS * size, JAMS * size)] * k + [(None, size)]
    found = linprog(np.append(np.zeros(k), -1.0), A, left[~stays], bounds=bounds, method="highs")
    return np.asarray(p + Z @ found.x[:-1]) if found.success and found.x[-1] >= least else None
