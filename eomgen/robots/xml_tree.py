"""XML -> elements that know their place in the file and which of their parts were read: nothing is dropped silently."""

from __future__ import annotations

import codecs
from collections.abc import Callable, Iterator, Mapping
from dataclasses import field
from decimal import Decimal, InvalidOperation
from xml.parsers import expat

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import LARGEST_EXPONENT, MOST_DIGITS, Vector

DEEPEST = 200  # elements one within the other


@dataclass(eq=False)
class XmlElement:
    """An element of an XML file. Asking for a child or an attribute marks it as read.

    Args:
        tag: its name.
        attributes: as they are written.
        where: "file:line:column" at which it begins.
        text: its text, without blanks at the ends.
    """

    tag: str
    attributes: Mapping[str, str]
    where: str
    children: list[XmlElement] = field(default_factory=list)
    text: str = ""
    read: set[str] = field(default_factory=set)
    seen: bool = False

    def get(self, key: str, default: str | None = None) -> str | None:
        """Attribute, or its default where it is not given."""
        self.read.add(key)
        return self.attributes.get(key, default)

    def need(self, key: str) -> str:
        """An attribute that must be there.

        Raises:
            ModelError: it is not.
        """
        found = self.get(key)
        if found is None:
            raise ModelError(f"<{self.tag}> has no '{key}'", self.where, f'give {key}="..."')
        return found

    def number(self, key: str, default: str | None = None) -> Decimal:
        """A number among the attributes, exactly as it is written."""
        return self._decimals(self.get(key, default) if default is not None else self.need(key), 1, key)[0]

    def vector(self, key: str, default: str) -> Vector:
        """Three numbers in an attribute."""
        return Vector(self._decimals(self.get(key, default) or default, 3, key))

    def value(self, size: int = 1) -> tuple[Decimal, ...]:
        """The numbers that stand in the element."""
        return self._decimals(self.text, size, "")

    def all(self, tag: str) -> list[XmlElement]:
        """Its children of this name."""
        found = [child for child in self.children if child.tag == tag]
        for child in found:
            child.seen = True
        return found

    def one(self, tag: str) -> XmlElement | None:
        """Its child of this name, None where there is none; of several the first."""
        found = next((child for child in self.children if child.tag == tag), None)
        if found is not None:
            found.seen = True
        return found

    def left(self) -> Iterator[tuple[XmlElement, str]]:
        """Parts of it and below that were not read: an element whole ("" for its name), or an attribute by its name."""
        if not self.seen:
            yield self, ""
            return
        yield from ((self, key) for key in self.attributes if key not in self.read)
        for child in self.children:
            yield from child.left()

    def _decimals(self, text: str | None, size: int, key: str) -> tuple[Decimal, ...]:
        try:
            found = tuple(Decimal(word) for word in (text or "").split())
        except InvalidOperation:
            found = ()
        beyond = next((x for x in found if x.is_finite() and x and not _is_double(x)), None)
        if beyond is not None:
            what = f"a number beyond the range of computation in <{self.tag}>: {(text or '').strip()[:30]}"
            raise ModelError(what, self.where, f"at most {LARGEST_EXPONENT} digits, and as many zeros")
        if len(found) != size or not all(x.is_finite() for x in found):
            needed = "a number is" if size == 1 else f"{size} numbers are"
            place = f"'{key}' of <{self.tag}>" if key else f"<{self.tag}>"
            raise ModelError(f"{needed} needed in {place}, not {text!r}", self.where, "write decimals, blanks between")
        return found


def _is_double(x: Decimal) -> bool:
    return abs(x.adjusted()) <= LARGEST_EXPONENT and len(x.as_tuple().digits) <= MOST_DIGITS


def xml_tree(data: bytes, name: str) -> XmlElement:
    """The root of an XML text; blank lines may stand before it.

    A document type is refused: entities can blow up a text, and no robot needs them.

    Raises:
        ModelError: no well-formed XML, or one with a document type.
    """
    parser = expat.ParserCreate()
    begun = data.removeprefix(codecs.BOM_UTF8).lstrip()
    before = data[: len(data) - len(begun)].count(b"\n")
    top = XmlElement("", {}, name, seen=True)
    open_: list[XmlElement] = [top]

    def here() -> str:
        return f"{name}:{before + parser.CurrentLineNumber}:{parser.CurrentColumnNumber + 1}"

    def start(tag: str, attributes: dict[str, str]) -> None:
        if len(open_) > DEEPEST:
            raise ModelError(f"more than {DEEPEST} elements stand one in the other", here(), "make it flatter")
        element = XmlElement(tag, attributes, here())
        open_[-1].children.append(element)
        open_.append(element)

    def end(tag: str) -> None:
        element = open_.pop()
        element.text = element.text.strip()

    def text(found: str) -> None:
        open_[-1].text += found

    def refuse(*given: object) -> None:
        raise ModelError("a document type (<!DOCTYPE>) is not read", here(), "take it out: entities are not needed")

    handlers: dict[str, Callable[..., None]] = {
        "StartElementHandler": start,
        "EndElementHandler": end,
        "CharacterDataHandler": text,
        "StartDoctypeDeclHandler": refuse,
    }
    for key, handler in handlers.items():
        setattr(parser, key, handler)
    parser.buffer_text = True
    try:
        parser.Parse(begun, True)
    except expat.ExpatError as error:
        where = f"{name}:{before + error.lineno}:{error.offset + 1}"
        raise ModelError(f"no well-formed XML: {expat.ErrorString(error.code)}", where, "fix the file") from error
    root = top.children[0]
    root.seen = True
    return root
