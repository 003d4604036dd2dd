"""Report formats: the seam of ways to print a document. Each gives `name` and `render(document)`."""

from collections.abc import Callable

from eomgen.documents import json_form, latex, markdown, text
from eomgen.documents.document import Document
from eomgen.errors import UsageError, visible

ALL = (text, latex, markdown, json_form)


def rendered(document: Document, format: str = "text") -> str:
    """The document in one of the formats of ALL: text, latex, markdown, json.

    Raises:
        UsageError: an unknown format.
    """
    return visible(drawn(document, format))


def drawn(document: Document, format: str) -> str:
    """Document in a format, as of `rendered` but with control characters left in; this text is read back."""
    formats: dict[str, Callable[[Document], str]] = {member.name: member.render for member in ALL}
    if format not in formats:
        raise UsageError(f"unknown format '{format}'", fix=f"one of {', '.join(formats)}")
    return formats[format](document)
