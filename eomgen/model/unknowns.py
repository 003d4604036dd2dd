"""Model -> where its [unknowns] stand: in loads, which a balance can be solved for, or elsewhere."""

from collections.abc import Iterator

from eomgen.errors import DerivationError
from eomgen.model.fields import Table
from eomgen.model.part import Part
from eomgen.model.parts import Unknown
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression

REQUESTED = ("given", "outputs", "unknowns")
"""Tables in which an unknown is no load: its declaration, requested results, the kinematics of an instant."""
EFFORTS = ("torque", "force")
"""Loads at a joint."""


class Unknowns(Part):
    """Places where the unknowns of a model stand: a base of `Model`."""

    unknowns: Table[Unknown]

    def _uses(self) -> Iterator[tuple[DocumentPath, str]]:
        """(path, unknown) of every place in which an unknown stands, except in the tables REQUESTED."""
        if not self.unknowns:
            return
        for leaf in self.leaves(()):
            if leaf.path[0] not in REQUESTED and isinstance(leaf.value, Expression):
                yield from ((leaf.path, name) for name in sorted(leaf.value.names & self.unknowns.keys()))

    def unknowns_in_loads(self) -> tuple[str, ...]:
        """The unknowns that stand in loads, in the model's order.

        Raises:
            DerivationError: one stands elsewhere, where no balance can be solved for it.
        """
        found = set()
        for path, name in self._uses():
            if not _is_load(path):
                where = ".".join(map(str, path))
                what = f"the unknown '{name}' stands where no balance gives it ({where})"
                fix = "an unknown may stand in forces, couples and drives, and in [given]"
                raise DerivationError(what, f"unknowns.{name}", fix)
            found.add(name)
        return tuple(name for name in self.unknowns if name in found)

    def refuse_motion(self) -> None:
        """Refuse equations of motion in which a force is unknown.

        Raises:
            DerivationError: it is named.
        """
        for path, name in self._uses():
            where = ".".join(map(str, path))
            raise DerivationError(
                f"the unknown '{name}' stands in {where}: a motion does not follow from it",
                where,
                "make it a parameter or an input; at rest `eomgen solve` and `eomgen statics` find it",
            )


def _is_load(path: DocumentPath) -> bool:
    return path[0] == "forces" or (path[0] == "bodies" and "joint" in path and path[-1] in EFFORTS)
