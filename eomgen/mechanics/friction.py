"""System, Assembly -> Assembly with friction: the contacts' own reactions solved together with the accelerations.

    M a + c = Q + J^T lam + sum f_r N_r,   J a + gamma = 0,   f_r = factor_r dv_r/du

N_r of a closing row is its multiplier; of a row or joint that only reacts it follows from the balance of the bodies,
N_r = n_r + m_r a. What comes out is friction as a generalized force of q, u and t.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from eomgen.errors import DerivationError
from eomgen.mechanics.assembly import Assembly, Row
from eomgen.mechanics.components import joint_friction
from eomgen.mechanics.freedom import redundant_rows
from eomgen.mechanics.reactions import Reactions, reactions_of, values_at_a_state
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import holds_identically
from eomgen.symbolic import cramer, linear
from eomgen.symbolic.derivative import gradient, substituted
from eomgen.symbolic.graph import Scalar


@dataclass(frozen=True)
class Rub:
    """One rubbing contact.

    Args:
        name: the tie, or the body on a path.
        component: index of its normal reaction among the components of the reactions.
        force: generalized force for a unit of N.
        factor: the friction along the contact's tangent for a unit of N, for instance -mu sign(v).
    """

    name: str
    component: int
    force: Row
    factor: Scalar


def with_friction(system: System, assembly: Assembly) -> Assembly:
    """The equations of motion, friction in Q and forcing, and the accelerations explicit; the same where nothing rubs.

    Raises:
        DerivationError: the normal reaction of a contact that rubs is indeterminate.
    """
    if not rubs(system):
        return assembly
    reactions = reactions_of(system)
    found = rubbing_contacts(system, reactions)
    a, forces = _solved(system, assembly, reactions, found)
    friction = tuple(sum((rub.force[k] * N for rub, N in zip(found, forces, strict=True)), start=0)
                     for k in range(len(assembly.M)))  # fmt: skip
    return replace(
        assembly,
        Q=tuple(x + f for x, f in zip(assembly.Q, friction, strict=True)),
        forcing=tuple(x + f for x, f in zip(assembly.forcing, friction, strict=True)),
        friction=friction,
        accelerations=a,
    )


def rubs(system: System) -> bool:
    """Whether anything rubs."""
    return bool(frictions(system))


def frictions(system: System) -> list[tuple[str, Scalar, Scalar]]:
    """(contact, what a unit of N rubs with, the sliding velocity) of everything that rubs."""
    found = [(row.tie, row.friction, row.sliding) for row in system.ties.rows]
    for link in system.motion.links:
        found.append((link.name, joint_friction(system, link), link.s_rate[0] if link.s_rate else 0))
    return [(name, factor, sliding) for name, factor, sliding in found if factor is not None]


def rubbing_contacts(system: System, reactions: Reactions) -> list[Rub]:
    """Every contact that rubs, in the order of the components."""
    u = system.symbols.u
    found = []
    for j, component in enumerate(reactions.components):
        if not component.rubbing:
            continue
        if component.kind == "joint":
            link = system.motion.link(component.owner)
            factor, sliding = joint_friction(system, link), link.s_rate[0]
        else:
            row = next(r for r in system.ties.rows if (r.tie, r.number) == (component.owner, component.number))
            factor, sliding = row.friction, row.sliding
        assert factor is not None, "what has an effect of friction has its factor"
        found.append(Rub(component.owner, j, tuple(factor * d for d in gradient(sliding, u)), factor))
    return found


def _solved(system: System, assembly: Assembly, reactions: Reactions, found: Sequence[Rub]) -> tuple[Row, Row]:
    """(a, N of every rub) from the equations of motion, the closing rows and the balance of the bodies."""
    symbols = system.symbols
    n, closing = len(assembly.M), system.ties.closing
    dropped = {(r.tie, r.number) for r in redundant_rows(system.ties)}
    kept = [i for i, row in enumerate(closing) if (row.tie, row.number) not in dropped]
    place = {(closing[i].tie, closing[i].number): n + k for k, i in enumerate(kept)}
    size = n + len(kept) + len(found)
    of_rub = []
    for k, rub in enumerate(found):
        c = reactions.components[rub.component]
        if (c.owner, c.number) in dropped and c.kind == "tie":
            raise DerivationError(f"the normal reaction of '{rub.name}', which rubs, is indeterminate")
        of_rub.append(place.get((c.owner, c.number), n + len(kept) + k) if c.kind == "tie" else n + len(kept) + k)
    rows: list[dict[int, Scalar]] = []
    right: list[Scalar] = []
    for i in range(n):
        row = {j: assembly.M[i][j] for j in range(n)}
        row |= {n + k: -assembly.J[m][i] for k, m in enumerate(kept)}
        for rub, j in zip(found, of_rub, strict=True):
            row[j] = row.get(j, 0) - rub.force[i]
        rows.append(row)
        right.append(assembly.forcing[i])
    for m in kept:
        rows.append(dict(enumerate(assembly.J[m])))
        right.append(-assembly.gamma[m])
    for k, rub in enumerate(found):
        own = n + len(kept) + k
        if of_rub[k] != own:
            rows.append({own: 1, of_rub[k]: -1})
            right.append(0)
            continue
        value = reactions.value(rub.component)
        m_r = gradient(value, symbols.a)
        (n_r,) = substituted((value,), {a: 0 for a in symbols.a})
        rows.append({own: 1} | {j: -m for j, m in enumerate(m_r)})
        right.append(n_r)
    if size <= cramer.LARGEST_BLOCK:
        values = [x for (x,) in cramer.solved(rows, [(x,) for x in right], vanishes=holds_identically)[0]]
        return tuple(values[:n]), tuple(values[n + len(kept) :])
    entries = [x for row in rows for x in row.values()]
    solution = linear.solved(rows, right, size, values_at_a_state(system, entries))
    if solution.free:
        raise DerivationError("the equations with friction have no single solution")
    a = tuple(solution.constants[i] for i in range(n))
    return a, tuple(solution.constants[n + len(kept) + k] for k in range(len(found)))
