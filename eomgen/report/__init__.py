"""Report formats: the seam of ways to print a derivation. Each gives `name` and `render(derivation)`."""

from eomgen.errors import UsageError
from eomgen.report import json_form, latex, markdown, text
from eomgen.report.document import Document

ALL = (text, latex, markdown, json_form)


def rendered(derivation: Document, format: str = "text") -> str:
    """The derivation in one of the formats of ALL: text, latex, markdown, json.

    Raises:
        UsageError: an unknown format.
    """
    formats = {member.name: member for member in ALL}
    if format not in formats:
        raise UsageError(f"unknown format '{format}'", mend=f"one of {', '.join(formats)}")
    return formats[format].render(derivation)
