"""The notebooks as pages of the site: their texts, code and what it showed, pictures beside them."""

from __future__ import annotations

import json
import re
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from papers import write

from eomgen.page.markup import words_apart  # a dollar inside a formula would end it

ROOT = Path(__file__).parents[2]
NOTEBOOKS = ROOT / "notebooks"
PLACE = ROOT / "docs" / "notebooks"
FORMS = ("text/markdown", "text/latex", "image/png", "text/plain")  # the first that an output has is shown
LINK = re.compile(r"\]\((\w+)\.ipynb\)")


def stems() -> list[str]:
    """The names of the notebooks, in their order."""
    return sorted(path.stem for path in NOTEBOOKS.glob("*.ipynb"))


def page_of(stem: str) -> tuple[str, dict[str, bytes]]:
    """(the page of a notebook, its pictures by file)."""
    blocks, pictures = [], {}
    for cell in json.loads((NOTEBOOKS / f"{stem}.ipynb").read_text(encoding="utf-8"))["cells"]:
        text = "".join(cell["source"])
        blocks.append(LINK.sub(r"](\1.md)", text) if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
        for output in cell.get("outputs", ()):
            file = f"{stem}-{len(pictures) + 1}.png"
            form, shown = shown_of(output)
            if form == "image/png":
                pictures[file] = b64decode(shown)
            blocks.append(block_of(form, shown, file, output))
    return "\n\n".join(blocks) + "\n", pictures


def shown_of(output: dict[str, Any]) -> tuple[str, str]:
    """(form, content) in which a page shows an output."""
    data = output.get("data") or {"text/plain": output["text"]}
    form = next(form for form in FORMS if form in data)
    return form, "".join(data[form])


def block_of(form: str, shown: str, file: str, output: dict[str, Any]) -> str:
    """An output as Markdown."""
    if form == "image/png":
        said = "".join(output["data"].get("text/plain", ())).strip("<>")
        return f"![{output['metadata'].get(form, {}).get('alt', said)}]({file})"
    if form == "text/latex":
        return "$$\n" + shown.strip().strip("$").removeprefix("\\displaystyle ") + "\n$$"
    return words_apart(shown) if form == "text/markdown" else f"```text\n{shown.rstrip()}\n```"


def pages() -> Iterator[tuple[str, str, dict[str, bytes]]]:
    """(name, text, pictures) of the pages, that of all first."""
    index = LINK.sub(r"](\1.md)", (NOTEBOOKS / "README.md").read_text(encoding="utf-8"))
    yield "index", "\n".join([index, "```{toctree}", ":hidden:", "", *stems(), "```", ""]), {}
    for stem in stems():
        yield stem, *page_of(stem)


def generate(app) -> None:
    """All pages, before Sphinx looks for them; those of an earlier build that are none any more go."""
    files = set()
    for name, text, pictures in pages():
        write(PLACE / f"{name}.md", text)
        for file, content in pictures.items():
            (PLACE / file).write_bytes(content)
        files |= {f"{name}.md", *pictures}
    for path in PLACE.iterdir():
        if path.name not in files:
            path.unlink()


def setup(app) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.connect("builder-inited", generate)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
