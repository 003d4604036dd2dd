"""Assembly -> what can be said of its energy and its mass before anything moves."""

from __future__ import annotations

from eomgen.errors import ModelError, Problem
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.system import System
from eomgen.mechanics.work import from_potential
from eomgen.symbolic.derivative import depends_on
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.graph import is_zero


def is_conservative(system: System, assembly: Assembly) -> bool:
    """Whether T + V stays: nothing moves by itself, and Q is -N^T dV/dq alone."""
    t = assembly.symbols.t
    by_itself = (*assembly.nu, *assembly.sigma)
    if any(not is_zero(x) for x in by_itself) or depends_on(assembly.V, (t,)) or depends_on(assembly.T, (t,)):
        return False
    elastic = from_potential(system.motion, assembly.V)
    return equal_at_random_states(zip(assembly.Q, elastic, strict=True)).equal if elastic else True


def refuse_massless(assembly: Assembly) -> None:
    """A free coordinate that moves no mass has no acceleration.

    Raises:
        ModelError: naming every such coordinate.
    """
    held = [any(not is_zero(row[k]) for row in assembly.J) for k in range(len(assembly.M))]
    moves_nothing = [u.name for k, u in enumerate(assembly.symbols.u) if is_zero(assembly.M[k][k]) and not held[k]]
    problems = tuple(map(_massless, moves_nothing))
    if problems:
        raise ModelError(problems)


def _massless(speed: str) -> Problem:
    q = speed.rstrip("'")
    if q == speed:
        return Problem(f"speeds.{q}", f"the speed '{q}' moves no mass, so it has no derivative",
                       mend="give the bodies that it moves a mass")  # fmt: skip
    return Problem(f"coordinates.{q}", f"the free coordinate '{q}' moves no mass, so it has no acceleration",
                   mend="give the bodies that it moves a mass, or drive the coordinate by `motion`")  # fmt: skip
