"""tension: of a link, of a strand of a string, or of a member of a truss."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.errors import DerivationError
from eomgen.model.catalog import Catalog
from eomgen.model.constraints.members import ends_asked
from eomgen.model.fields import Leaf
from eomgen.model.findings import Finding, nearest
from eomgen.model.outputs.base import BALANCE, OutputFunction, name_at
from eomgen.model.outputs.context import OutputContext
from eomgen.symbolic.expression.expressions import Call, Expression, Reference
from eomgen.symbolic.expression.spatial import AnyScalar


def _tension(scene: OutputContext, call: Call) -> AnyScalar:
    """tension(rope), tension(rope, 2), or tension(T, n1-n2) of a truss."""
    name, strand = name_at(call, 0), call.args[1:]
    if scene.is_truss(name):
        return scene.reactions.member(name, *_ends(call))
    number = strand[0].literal if strand and isinstance(strand[0], Expression) else 1
    if not isinstance(number, int) or len(strand) > 1:
        raise DerivationError(
            f"'{call}': the second argument is the number of the strand, from 1", mend="tension(string, 1)"
        )
    return scene.reactions.tension(name, number)


def _ends(call: Call) -> tuple[str, str]:
    """The nodes of the member that an output asks for."""
    ends = ends_asked(call)
    if ends is None:
        raise DerivationError(f"'{call}' names no member of a truss", mend=f"write tension({call.args[0]}, n1-n2)")
    return ends


def _findings(catalog: Catalog, leaf: Leaf, call: Call) -> Iterator[Finding]:
    """Of a truss the tension of one of its members can be asked."""
    owner = call.args[0]
    if not isinstance(owner, Reference):
        return
    truss = catalog.table("trusses").get(owner.name)
    if truss is None or truss.members is None:
        return
    ends = ends_asked(call)
    if ends is None or set(ends) not in [set(member.split("-")) for member in truss.members]:
        what = f"truss '{owner.name}' has no member '{'-'.join(ends)}'" if ends else f"'{call}' names no member"
        mend = nearest("-".join(ends or ()), truss.members) or f"tension({owner.name}, {truss.members[0]})"
        yield Finding(leaf.path, what, mend, call.column, len(call.name))


TENSION = OutputFunction(
    names=("tension",),
    kinds=("tie or truss", "any", "any"),
    least=1,
    shown="(tie[, number]) or (truss, n1-n2)",
    unit="N",
    gives="of a link; of a strand of a string, from 1 (default); of a member of a [truss](#trusses), by its two nodes",
    value=_tension,
    source=BALANCE,
    findings=_findings,
)
