"""The directive `sources`: every source that a docstring of the package names; docstrings are read as prose."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive

PACKAGE = Path(__file__).parents[2] / "eomgen"
SOURCE = re.compile(r"Sources?: (.*?)(?:\n\s*\n|\n\s*[A-Z]\w+:|\Z)", re.S)
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef)


def named() -> list[tuple[str, str]]:
    """(module, source), in the order of the modules."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        module = path.relative_to(PACKAGE).with_suffix("").as_posix().removesuffix("/__init__")
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if SOURCE.search(text) else ():
            if isinstance(node, DOCUMENTED):
                for match in SOURCE.finditer(ast.get_docstring(node) or ""):
                    found.append((module, " ".join(match[1].split())))
    return list(dict.fromkeys(found))


class Sources(Directive):
    """A list of them."""

    def run(self) -> list[nodes.Node]:
        """One item a source."""
        items = []
        for module, source in named():
            words = nodes.paragraph("", "", nodes.literal(text=module), nodes.Text(f": {source}"))
            items.append(nodes.list_item("", words))
        return [nodes.bullet_list("", *items)]


def prose(app, what, name, obj, options, lines: list[str]) -> None:
    """Docstrings are prose: |x| is a length, a * no emphasis."""
    lines[:] = [line.replace("|", "\\|") for line in lines]


def setup(app) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.add_directive("sources", Sources)
    app.connect("autodoc-process-docstring", prose)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
