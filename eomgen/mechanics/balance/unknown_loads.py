"""Balance -> the same equations with the unknowns of the loads on the side of the reactions.

    sum of coefficients * reactions + sum of d(applied)/dP * P = inertia - applied at P = 0

The bodies are at rest: rates and accelerations are 0.
"""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance import Balance, BodyEquation
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.constraints.ties import holds_identically
from eomgen.mechanics.equations.system import System
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ELIMINATED_AT_50
from eomgen.symbolic.solve.linear import Solution


def with_unknowns(balance: Balance) -> tuple[list[dict[int, Scalar]], list[Scalar]]:
    """(coefficients, what they have to make up) of every equation; unknowns are counted after the components.

    Raises:
        DerivationError: an unknown does not stand linearly in the loads.
    """
    rows, needed = [], []
    zero = dict.fromkeys(balance.unknowns, 0)
    for equation in balance.equations:
        own = {len(balance.components) + k: slope(balance, equation, p) for k, p in enumerate(balance.unknowns)}
        rows.append({**equation.coefficients, **{j: x for j, x in own.items() if not is_zero(x)}})
        needed.append(substituted((equation.needed,), zero)[0] if zero else equation.needed)
    return rows, needed


def slope(balance: Balance, equation: BodyEquation, unknown: Node) -> Scalar:
    """d(applied)/dP

    Raises:
        DerivationError: an unknown stands in it: the loads are not linear.
    """
    found = derivative(equation.applied, unknown)
    if depends_on(found, balance.unknowns):
        names = ", ".join(f"'{p.name}'" for p in balance.unknowns if depends_on(found, (p,)))
        what = f"the loads on '{equation.body}' are not linear in the unknown {names}"
        raise DerivationError(what, f"unknowns.{unknown.name}", "let an unknown be one force, couple or intensity")
    return found


def still(system: System) -> dict[Node, Scalar]:
    """Rates and accelerations at rest."""
    return dict.fromkeys((*system.symbols.u, *system.symbols.a), 0)


def refuse_friction(balance: Balance) -> None:
    """At rest friction may be anything up to its limit: then no force follows from the balance.

    Raises:
        DerivationError: the contact is named.
    """
    for component in balance.components:
        if component.frictional:
            what = f"'{component.owner}' has friction: at rest it has a range, and so have the unknowns"
            raise DerivationError(what, f"constraints.{component.owner}.friction", "leave the friction out")


def is_balanced(balance: Balance, solution: Solution) -> bool:
    """Whether what the unknowns and reactions cannot change vanishes, wherever the ties hold."""
    left = solution.left
    if all(holds_identically(x) for x in left):
        return True
    if not balance.system.symbols.q:
        return False
    state = generic_state(balance.system.ties)
    try:
        sizes = [abs(x) for x in evaluate(left, state, fifty_digits())]
    except NoValue:
        return False
    return bool(max(sizes) < ELIMINATED_AT_50)


def unbalanced(balance: Balance, solution: Solution) -> DerivationError:
    """No equilibrium: more freedoms than the unknowns can hold."""
    names = ", ".join(f"'{p.name}'" for p in balance.unknowns)
    freedoms = len(balance.system.symbols.u) - len(balance.system.ties.closing)
    how_many = f"; there are {freedoms} freedoms for {len(balance.unknowns)}" if freedoms > 0 else ""
    return DerivationError(
        f"the bodies are not in balance at rest, whatever {names} may be{how_many}",
        "unknowns",
        "hold every freedom by a constraint or by an unknown in a load, or start in equilibrium",
    )
