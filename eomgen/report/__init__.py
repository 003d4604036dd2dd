"""Report formats: the seam of ways to print a document. Each gives `name` and `render(document)`."""

import sys
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any

from eomgen.errors import UsageError, visible
from eomgen.report import json_form, latex, markdown, text
from eomgen.report.document import Document

ALL = (text, latex, markdown, json_form)


def rendered(document: Document, format: str = "text") -> str:
    """The document in one of the formats of ALL: text, latex, markdown, json.

    Raises:
        UsageError: an unknown format.
    """
    formats: dict[str, Callable[[Document], str]] = {member.name: member.render for member in ALL}
    if format not in formats:
        raise UsageError(f"unknown format '{format}'", mend=f"one of {', '.join(formats)}")
    return visible(formats[format](document))


class _Room(ModuleType):
    """This room has the name of a verb: `eomgen.report(model, path)` is that of `eomgen.verbs.report`."""

    @property
    def __wrapped__(self) -> Callable[..., Any]:
        verb: Callable[..., Any] = import_module("eomgen.verbs.report").report
        return verb

    def __call__(self, *given: Any, **options: Any) -> Any:
        return self.__wrapped__(*given, **options)


sys.modules[__name__].__class__ = _Room
