"""Equations: what is typed in them has a unit that fits, and no two meanings."""

from collections.abc import Iterator

from eomgen.errors import ExpressionError
from eomgen.model.catalog import Catalog
from eomgen.model.fields import WrittenEquation
from eomgen.model.findings import Finding
from eomgen.model.typed import typing_of


def equations(catalog: Catalog) -> Iterator[Finding]:
    """Units that do not fit the other side; numbers that may be meant in two units."""
    for leaf in catalog.leaves:
        if isinstance(leaf.value, WrittenEquation) and leaf.value.units is not None:
            try:
                typing_of(catalog.model, str(leaf.path[0])).equation(leaf.value)
            except ExpressionError as error:
                yield Finding(leaf.path, error.what, error.mend, error.column, error.length)
