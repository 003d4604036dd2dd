"""Model -> Equations -> RightHandSide -> Trajectory: the whole journey on one screen."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from eomgen.certificate import Certificate, certify
from eomgen.codegen.program import Program, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import MissingValues, UsageError
from eomgen.mechanics import articulated
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.formulations import ALL, recursive
from eomgen.mechanics.system import System, system_of
from eomgen.mechanics.tree import branches_of
from eomgen.model.parts import Model

if TYPE_CHECKING:
    import sympy

METHODS = ("lagrange", "projection")


@dataclass(frozen=True)
class Equations:
    """The equations of motion of a model: q' = N u + nu, M a = forcing + J^T lam, J a + gamma = 0.

    `graph` holds N, nu, M, c, Q, forcing, J, sigma, gamma, phi, T, V as graph scalars; the same names on the
    equations themselves are their sympy forms, made on first use.

    Args:
        model: the model.
        method: by which the derivation is written; M, c, Q are the same functions by every method.
        system: motion, loads and ties.
        graph: the equations as graph scalars.
    """

    model: Model
    method: str
    system: System
    graph: Assembly
