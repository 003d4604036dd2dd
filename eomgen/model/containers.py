"""Rules made of rules: a list of things, a table of named things, one thing or another."""

from collections.abc import Iterator, Mapping
from typing import Any

from eomgen.model.fields import Leaf, read_items
from eomgen.model.findings import Decimal, Finding, shown
from eomgen.model.positions import DocumentPath
from eomgen.model.table import Table
from eomgen.records import dataclass


@dataclass(frozen=True)
class ListRule:
    """A list of things of one rule (`single`: one of them may stand for itself)."""

    item: Any
    least: int = 1
    most: int | None = None
    single: bool = False

    def read(self, raw: Any, path: DocumentPath, found: list[Finding]) -> tuple[Any, ...] | None:
        if self.single and not isinstance(raw, (list, tuple)):
            one = self.item.read(raw, path, found)
            return None if one is None else (one,)
        if not isinstance(raw, (list, tuple)):
            found.append(Finding(path, f"a list is needed here, not {shown(raw)}"))
            return None
        if len(raw) < self.least or (self.most is not None and len(raw) > self.most):
            count = str(self.least) if self.least == self.most else f"at least {self.least}"
            count = f"at most {self.most}" if self.most is not None and len(raw) > self.most > self.least else count
            found.append(Finding(path, f"{count} entries are needed here, not {len(raw)}"))
            return None
        return read_items(self.item, raw, path, found)

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        for i, x in enumerate(value):
            yield from self.item.leaves(x, path if self.single and len(value) == 1 else (*path, i), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        many: dict[str, Any] = {"type": "array", "items": self.item.schema(definitions), "minItems": self.least}
        if self.most is not None:
            many["maxItems"] = self.most
        return {"anyOf": [self.item.schema(definitions), many]} if self.single else many


@dataclass(frozen=True)
class TableRule:
    """A table of named things of one rule; `what` names one of them in messages."""

    item: Any
    what: str

    def read(self, raw: Any, path: DocumentPath, found: list[Finding]) -> Table[Any] | None:
        if not isinstance(raw, Mapping):
            found.append(Finding(path, f"a table of {self.what}s is needed here, not {shown(raw)}"))
            return None
        return Table({str(name): self.item.read(x, (*path, name), found) for name, x in raw.items()})

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        for name, x in value.items():
            if x is not None:
                yield from self.item.leaves(x, (*path, name), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": self.item.schema(definitions)}


@dataclass(frozen=True)
class EitherRule:
    """A text is read by one rule, anything else by another."""

    text: Any
    other: Any

    def _rule(self, value: Any) -> Any:
        return self.text if isinstance(value, str) and not isinstance(value, Decimal) else self.other

    def read(self, raw: Any, path: DocumentPath, found: list[Finding]) -> Any:
        return self._rule(raw).read(raw, path, found)

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield from self._rule(value).leaves(value, path, part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"anyOf": [self.text.schema(definitions), self.other.schema(definitions)]}
