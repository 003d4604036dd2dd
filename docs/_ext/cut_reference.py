"""The reference of the model file and other papers of the tree as pages of the site: one source, cut at its heads.

`models/README.md` becomes a page for each of its sections; CHANGELOG and CONTRIBUTING are pages.
Links between sections follow; a link to a file of the tree that has no page becomes its name.
"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
WHOLE = {"CHANGELOG.md": "changelog", "CONTRIBUTING.md": "contributing"}  # path of the tree: page under docs/tree
HEAD = re.compile(r"^(#{1,6}) (.*)$")
LINK = re.compile(r"(?<!!)\[([^\[\]]+)\]\(([^()\s]+)\)")
FENCE = re.compile(r"^```")


def slug(head: str) -> str:
    """The anchor of a head, as it stands in links of the source."""
    kept = re.sub(r"[^\w\- ]", "", head.replace("`", "").lower())
    return kept.strip().replace(" ", "-")


def sections(text: str, level: int = 2) -> list[tuple[str, list[str]]]:
    """(head, lines after it) for each head of a level; what stands before the first has the head ""."""
    found: list[tuple[str, list[str]]] = [("", [])]
    fenced = False
    for line in text.splitlines():
        fenced ^= bool(FENCE.match(line))
        match = None if fenced else HEAD.match(line)
        if match and len(match[1]) == level:
            found.append((match[2], []))
        else:
            found[-1][1].append(line)
    return found


def anchors(head: str, lines: list[str]) -> list[str]:
    """Of a section, and of the heads inside it."""
    inner, fenced = [], False
    for line in lines:
        fenced ^= bool(FENCE.match(line))
        match = None if fenced else HEAD.match(line)
        if match:
            inner.append(slug(match[2]))
    return [slug(head), *inner]


def raised(lines: list[str]) -> list[str]:
    """Heads one level higher: the section's own is the title of its page."""
    found, fenced = [], False
    for line in lines:
        fenced ^= bool(FENCE.match(line))
        match = None if fenced else HEAD.match(line)
        found.append(line[1:] if match and len(match[1]) > 2 else line)
    return found


def linked(text: str, source: str, homes: dict[tuple[str, str], str], page: str) -> str:
    """Links of a source of the tree, turned into links of the site.

    Args:
        source: the file of the tree that the text is from, "models/README.md".
        homes: (file, anchor) -> page under docs; anchor "" is the file as a whole.
        page: where the text will stand, under docs.
    """

    def turned(match: re.Match[str]) -> str:
        words, target = match[1], match[2]
        if "://" in target:
            return match[0]
        path, _, anchor = target.partition("#")
        file = (ROOT / source).parent / path if path else ROOT / source
        name = file.resolve().relative_to(ROOT).as_posix() if file.resolve().is_relative_to(ROOT) else path
        home = homes.get((name, anchor)) or homes.get((name, ""))
        if home is None:
            return words
        up = "../" * page.count("/")
        same = anchor if (name, anchor) in homes and slug_is_inner(homes, name, anchor, home) else ""
        return f"[{words}]({up}{home}.md{'#' + same if same else ''})"

    return LINK.sub(turned, text)


def slug_is_inner(homes: dict[tuple[str, str], str], name: str, anchor: str, home: str) -> bool:
    """Whether an anchor is a head inside its page, and not the page's title."""
    return next((a for (n, a), h in homes.items() if n == name and h == home and a), "") != anchor


def write(path: Path, text: str) -> None:
    """Only where it changes, so that a page that did not is not built again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def cut() -> tuple[dict[str, str], dict[tuple[str, str], str]]:
    """Page under docs -> text, of all that is cut; the homes of what links name."""
    homes: dict[tuple[str, str], str] = {}
    raw: dict[str, tuple[str, str, str]] = {}  # page: (source, title, text)
    reference = sections((ROOT / "models" / "README.md").read_text(encoding="utf-8"))
    names = []
    for head, lines in reference[1:]:
        page = f"model_file/{slug(head).replace('-', '_')}"
        names.append(slug(head).replace("-", "_"))
        raw[page] = ("models/README.md", head, "\n".join(raised(lines)))
        homes.update({("models/README.md", anchor): page for anchor in anchors(head, lines)})
    homes["models/README.md", ""] = "model_file/index"
    for source, name in WHOLE.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        head = next(match[2] for match in map(HEAD.match, text.splitlines()) if match)
        raw[f"tree/{name}"] = (source, head, text.partition("\n")[2])
        homes[source, ""] = f"tree/{name}"
    for path in (ROOT / "docs").glob("*.md"):
        homes[f"docs/{path.name}", ""] = path.stem
    homes["models", ""] = "gallery/index"
    raw["model_file/index"] = ("models/README.md", "The model file", before_contents(reference[0][1]))
    homes.update({(f"docs/{page}.md", ""): page for page in raw})
    found = {}
    for page, (source, title, text) in raw.items():
        found[page] = f"# {title}\n\n{linked(text, source, homes, page).strip()}\n"
    listed = "\n".join([*names, "kinds/index"])  # those are written by `kinds`
    found["model_file/index"] += f"\n```{{toctree}}\n:maxdepth: 2\n\n{listed}\n```\n"
    return found, homes


def before_contents(lines: list[str]) -> str:
    """What stands before the sections, without the list of them: the site has its own."""
    paragraphs = "\n".join(lines[1:]).strip().split("\n\n")
    return "\n\n".join(paragraph for paragraph in paragraphs if not paragraph.startswith("Contents:"))


def generate(app) -> None:
    """All pages, before Sphinx looks for them."""
    pages, homes = cut()
    for page, text in pages.items():
        write(ROOT / "docs" / f"{page}.md", text)
    app.connect("source-read", lambda _, page, source: relinked(page, source, pages, homes))


def relinked(page: str, source: list[str], pages: dict[str, str], homes: dict[tuple[str, str], str]) -> None:
    """Links of pages written by hand to files of the tree, which have pages here."""
    if page not in pages:
        source[0] = linked(source[0], f"docs/{page}.md", homes, page)


def setup(app) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.connect("builder-inited", generate)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
