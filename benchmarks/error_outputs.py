"""What two runs print or write -> the first thing that is not the same; "" where both differ in form alone.

text            word by word; numbers to 1e-9; formulas, sides of an equation, by their worth at three states
JSON            entry by entry, each as text; none more, none less
LaTeX, Markdown as a page is read: headings, words, formulas in their signs, wherever a line is broken
HTML            unpacked, as a browser has it
TOML, URDF      by the model that is read back
PDF, FMU        stream by stream, file by file, however packed
"""

from __future__ import annotations

import json
import re
import tempfile
import tomllib
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from io import BytesIO
from itertools import zip_longest
from pathlib import Path
from typing import Any

import planted_errors as planted

NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
PACKED = re.compile(r"H4sI[A-Za-z0-9+/]{20,}=*")  # gzip, then base64
STREAM = re.compile(rb"stream\r?\n(.*?)\r?\nendstream", re.S)
OF_THING = re.compile(r"\b(?!(?:a?(?:sin|cos|tan)h?|atan2|sqrt|exp|log|abs|sign|min|max)\()(\w+)\((\w+)\)")
SIZES = frozenset((r"\left", r"\right", r"\bigl", r"\bigr", r"\big", r"\Bigl", r"\Bigr", "."))
OF_WAYS = ("message", "method", "evaluations", "arithmetic")  # how a thing was found, how long it took: no answer


def difference(found: str, right: str) -> str:
    """The first answer that is not right; "" where all are."""
    if found == right:
        return ""
    if not right.lstrip().startswith(("{", "[")):
        return _apart(found, right)
    try:
        a, b = (planted._leaves(json.loads(text)) for text in (found, right))
    except ValueError:
        return _apart(found, right)
    for key in (*b, *(x for x in a if x not in b)):
        if key.startswith((".schema", ".steps", ".symbols")) or any(f".{word}" in key for word in OF_WAYS):
            continue  # a formula in another form has other letters
        if key not in a or key not in b:
            return f"{key}: {'missing' if key in b else 'there is none'}"
        if key.endswith(".exact") and a[key] is False and b[key] is True:
            continue  # numbers where formulas might stand
        if not planted._right(a[key], b[key], True) and not _same(a[key], b[key]):
            return f"{key}: {str(a[key])[:150]} for {str(b[key])[:150]}"
    return ""


def files_apart(found: Mapping[str, bytes], right: Mapping[str, bytes]) -> str:
    """The first file that is another one, and where."""
    for name in (*right, *(x for x in found if x not in right)):
        a, b = found.get(name), right.get(name)
        if a is None or b is None:
            return f"{name}: {'missing' if a is None else 'there is none'}"
        if a != b and (said := _files_apart(Path(name).suffix.lower(), a, b)):
            return f"{name}: {said}"
    return ""


def _files_apart(ending: str, found: bytes, right: bytes) -> str:
    if ending in (".fmu", ".zip"):
        return files_apart(*map(_members, (found, right)))
    if ending == ".pdf":
        pairs = zip_longest(*map(_streams, (found, right)), fillvalue="")
        return next(filter(None, (_apart(a, b) for a, b in pairs)), "")
    a, b = (text.decode("latin-1" if ending == ".png" else "utf-8", "replace") for text in (found, right))
    if ending == ".png":
        return first_line(a, b)
    if ending in (".toml", ".urdf") and _read_back(ending, found) == _read_back(ending, right) is not None:
        return ""
    if ending == ".toml":
        return _tables_apart(a, b)
    if ending in (".html", ".htm"):
        return _apart(*map(_unpacked, (a, b)))
    return difference(a, b)


def _tables_apart(found: str, right: str) -> str:
    """Where two model files differ, entry by entry."""
    try:
        return difference(*(json.dumps(tomllib.loads(text), default=str) for text in (found, right)))
    except tomllib.TOMLDecodeError:
        return _apart(found, right)


def _members(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist() if not name.endswith((".so", ".dll", ".dylib"))}


def _streams(content: bytes) -> Iterator[str]:
    """What stands in a PDF's streams, unpacked, without the date."""
    for found in STREAM.finditer(content):
        try:
            yield zlib.decompress(found[1]).decode("latin-1")
        except zlib.error:
            yield found[1].decode("latin-1")


def _unpacked(page: str) -> str:
    """A page of HTML with all that it carries packed."""
    from eomgen.page.reports_read import copies_undone, unpacked

    def inside(found: re.Match[str]) -> str:
        try:
            content = unpacked(found[0])
            if page[: found.start()].endswith('data-packed="'):
                content = copies_undone(content)
        except (OSError, ValueError, IndexError):
            return found[0]
        return content.decode("utf-8", "replace")

    return PACKED.sub(inside, page)


def _read_back(ending: str, content: bytes) -> Any:
    """The model of a file; None where none can be read."""
    from eomgen.errors import EomgenError
    from eomgen.model.reader import loads
    from eomgen.robots.importing import imported

    try:
        if ending == ".toml":
            return loads(content.decode(), "m.toml", "m")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"m{ending}"
            path.write_bytes(content)
            return imported(path).model
    except (EomgenError, ValueError):
        return None


def _apart(found: str, right: str) -> str:
    """Where two texts differ, form left out."""
    for page in _pages(right):
        try:
            a, b = (list(page(text)) for text in (found, right))
        except (ValueError, IndexError):
            continue
        if len(a) == len(b) and all(map(_same_block, a, b)):
            return ""
        return first_line(found, right)
    a, b = (list(_statements(text)) for text in (found, right))
    if len(a) == len(b):
        return next((first_line(x, y) for x, y in zip(a, b, strict=True) if not _same(x, y)), "")
    return first_line(found, right)


def _pages(text: str) -> Iterable[Callable[[str], Iterable[Any]]]:
    """The reader of a page of LaTeX or Markdown; none of another text."""
    from eomgen.documents.pages_read import latex_page, markdown_page

    return [latex_page] if "\\begin{document}" in text else [markdown_page] if "\n$$\n" in text else []


def _same_block(one: Any, other: Any) -> bool:
    """Whether two things of a page say the same."""
    if one == other:
        return True
    bare = [[[x for x in side if x not in SIZES] for side in each.sides] for each in (one, other)]
    same_words = (one.words, one.rows) == (other.words, other.rows)
    return bool(one.kind == other.kind and same_words and bare[0] == bare[1]) and _same(
        "\n".join(one.lines), "\n".join(other.lines)
    )


def _statements(text: str) -> Iterator[str]:
    """A line and those below it that are farther in."""
    lead, lines = 0, list[str]()
    for line in text.splitlines():
        far = len(line) - len(line.lstrip())
        if lines and far > lead and line.strip():
            lines.append(line)
            continue
        yield from [" ".join(lines)] * bool(lines)
        lead, lines = far, [line]
    yield from [" ".join(lines)] * bool(lines)


def _same(one: Any, other: Any) -> bool:
    """Whether two statements say the same: in words, in numbers to 1e-9, side by side of an equation as formulas."""
    if not (isinstance(one, str) and isinstance(other, str)):
        return False
    if one.split() == other.split() or _same_but_numbers(one, other):
        return True
    sides = [x.split("=") for x in (one, other)]
    if len(sides[0]) != len(sides[1]):
        return False
    sides = [[OF_THING.sub(r"\1__\2", x) for x in each] for each in sides]  # T(arm2) is a quantity
    if all(_same_but_numbers(a, b) or planted._equal_formulas(a, b) for a, b in zip(*sides, strict=True)):
        return True
    return len(sides[0]) == 2 and planted._equal_formulas(*("(" + ")-(".join(x) + ")" for x in sides))


def _same_but_numbers(one: str, other: str) -> bool:
    words = [["".join(x.split()) for x in NUMBER.split(text)] for text in (one, other)]
    if words[0] != words[1]:
        return False
    numbers = [[float(x) for x in NUMBER.findall(text)] for text in (one, other)]
    return all(abs(a - b) <= 1e-9 * (1 + abs(b)) for a, b in zip(*numbers, strict=True))


def first_line(found: str, right: str) -> str:
    """Where two texts differ first, in both."""
    if found == right:
        return ""
    pairs = zip(found.splitlines(), right.splitlines(), strict=False)
    one, other = next(((a, b) for a, b in pairs if a != b), (f"{len(found)} characters", str(len(right))))
    at = next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), 0)
    return f"{one[max(at - 40, 0) : at + 80]} for {other[max(at - 40, 0) : at + 80]}"
