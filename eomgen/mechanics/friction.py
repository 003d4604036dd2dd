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
from eomgen.mechanics.explicit import bordered_rows, regular_rows
from eomgen.mechanics.reacting.balance_solution import values_at_a_state
from eomgen.mechanics.reacting.components import joint_friction, rubbing_of
from eomgen.mechanics.reacting.reactions import Reactions, reactions_of
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
        factor, sliding = rubbing_of(system, component)
        found.append(Rub(component.owner, j, tuple(factor * d for d in gradient(sliding, u)), factor))
    return found


def _solved(system: System, assembly: Assembly, reactions: Reactions, found: Sequence[Rub]) -> tuple[Row, Row]:
    """(a, N of every rub) from the equations of motion, the closing rows and the balance of the bodies.

    The unknowns: a, lam of the rows that do not follow from others, N of every rub.
    """
    kept = regular_rows(system)
    rows, right = bordered_rows(assembly, kept)
    n, first = len(assembly.M), len(right)
    for k, rub in enumerate(found):
        multiplier = _multiplier(system, reactions, rub, kept)
        normal = first + k if multiplier is None else n + multiplier
        for row, force in zip(rows[:n], rub.force, strict=True):
            row[normal] = row.get(normal, 0) - force
        same: tuple[dict[int, Scalar], Scalar] = ({normal: -1}, 0)
        known, value = _by_balance(system, reactions, rub) if multiplier is None else same
        rows.append({first + k: 1} | known)
        right.append(value)
    values = _values(system, rows, right)
    return tuple(values[:n]), tuple(values[first:])


def _multiplier(system: System, reactions: Reactions, rub: Rub, kept: Sequence[int]) -> int | None:
    """Which of the kept rows has the normal reaction for its multiplier; None where it follows from the balance.

    Raises:
        DerivationError: its row follows from others, so that it is indeterminate.
    """
    component, closing = reactions.components[rub.component], system.ties.closing
    label = (component.owner, component.number)
    rows = [i for i, row in enumerate(closing) if component.kind == "tie" and (row.tie, row.number) == label]
    if not rows:
        return None
    if rows[0] not in kept:
        raise DerivationError(f"the normal reaction of '{rub.name}', which rubs, is indeterminate")
    return kept.index(rows[0])


def _by_balance(system: System, reactions: Reactions, rub: Rub) -> tuple[dict[int, Scalar], Scalar]:
    """(-m, n) of N = n + m a: the coefficients of the accelerations in N - m a = n, and its right side."""
    a = system.symbols.a
    value = reactions.value(rub.component)
    slopes = gradient(value, a)
    return {j: -slope for j, slope in enumerate(slopes)}, substituted((value,), dict.fromkeys(a, 0))[0]


def _values(system: System, rows: list[dict[int, Scalar]], right: list[Scalar]) -> list[Scalar]:
    """The unknowns: by determinants where they are few, else by elimination."""
    if len(right) <= cramer.LARGEST_BLOCK:
        return [x for (x,) in cramer.solved(rows, [(x,) for x in right], vanishes=holds_identically)[0]]
    entries = [x for row in rows for x in row.values()]
    solution = linear.solved(rows, right, len(right), values_at_a_state(system, entries))
    if solution.free:
        raise DerivationError("the equations with friction have no single solution")
    return [solution.constants[i] for i in range(len(right))]
