"""Papers of the tree as pages of the site: CHANGELOG, CONTRIBUTING, the list of models.

Links between pages follow; a link to a file of the tree that has no page becomes its name.
"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
WHOLE = {
    "CHANGELOG.md": "changelog",
    "CONTRIBUTING.md": "contributing",
    "models/README.md": "models",
}  # path of the tree: page under docs/tree
HEAD = re.compile(r"^(#{1,6}) (.*)$")
LINK = re.compile(r"(?<!!)\[([^\[\]]+)\]\(([^()\s]+)\)")


def linked(text: str, source: str, homes: dict[str, str], page: str) -> str:
    """Links of a source of the tree, turned into links of the site.

    Args:
        source: the file of the tree that the text is from, "models/README.md".
        homes: file -> page under docs.
        page: where the text will stand, under docs.
    """

    def turned(match: re.Match[str]) -> str:
        words, target = match[1], match[2]
        if "://" in target:
            return match[0]
        path, _, anchor = target.partition("#")
        file = (ROOT / source).parent / path if path else ROOT / source
        name = file.resolve().relative_to(ROOT).as_posix() if file.resolve().is_relative_to(ROOT) else path
        if name.startswith("docs/") and source == f"docs/{page}.md":
            return match[0]  # a page's own link, which Sphinx follows
        if name not in homes:
            return words
        return f"[{words}]({'../' * page.count('/')}{homes[name]}.md{'#' + anchor if anchor else ''})"

    return LINK.sub(turned, text)


def write(path: Path, text: str) -> None:
    """Only where it changes, so that a page that did not is not built again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def papers() -> tuple[dict[str, str], dict[str, str]]:
    """Page under docs -> text; the homes of what links name."""
    homes: dict[str, str] = {}
    raw: dict[str, tuple[str, str, str]] = {}  # page: (source, title, text)
    for source, name in WHOLE.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        head = next(match[2] for match in map(HEAD.match, text.splitlines()) if match)
        raw[f"tree/{name}"] = (source, head, text.partition("\n")[2])
        homes[source] = f"tree/{name}"
    for path in (ROOT / "docs").rglob("*.md"):
        page = path.relative_to(ROOT / "docs").with_suffix("").as_posix()
        homes[f"docs/{page}.md"] = page
    homes["models"] = "gallery/index"
    homes.update({f"docs/{page}.md": page for page in raw})
    found = {}
    for page, (source, title, text) in raw.items():
        found[page] = f"# {title}\n\n{linked(text, source, homes, page).strip()}\n"
    return found, homes


def generate(app) -> None:
    """All pages, before Sphinx looks for them; those of an earlier build that are none any more go."""
    pages, homes = papers()
    for page, text in pages.items():
        write(ROOT / "docs" / f"{page}.md", text)
    for path in (ROOT / "docs" / "tree").iterdir():
        if f"tree/{path.stem}" not in pages:
            path.unlink()
    app.connect("source-read", lambda _, page, source: relinked(page, source, pages, homes))


def relinked(page: str, source: list[str], pages: dict[str, str], homes: dict[str, str]) -> None:
    """Links of pages written by hand to files of the tree, which have pages here."""
    if page not in pages:
        source[0] = linked(source[0], f"docs/{page}.md", homes, page)


def setup(app) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.connect("builder-inited", generate)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
