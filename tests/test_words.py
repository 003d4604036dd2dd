"""The field's words: old words of our own stand in no public name, message or page; docstrings name what comes back."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from source_trees import modules_of, nodes_of

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "eomgen"
OPENERS = frozenset(  # with these a sentence begins that is neither a noun nor a verb
    "What Whether Of Where How Which Who Whose That Those These As At By In It If When On From To With Beside".split()
    + "Nothing Not Also Only So Here There Against Along Without Because For After Before While Between Until".split()
)
NAMES = {  # pieces of public names -> what is said instead
    "tie": "constraint",
    "ties": "constraints",
    "mend": "fix",
    "mends": "fixes",
    "told": "reported",
    "asked": "requested",
    "freedoms": "degrees_of_freedom",
    "worth": "value",
    "lowered": "statements",
    "corruption": "mistake",
    "finding": "diagnostic",
    "findings": "diagnostics",
    "snapshot": "instant_kinematics",
}
SENTENCES = {  # in messages and on pages
    r"\bties?\b(?! (?:them|it|up|to|in|together)\b)": "constraint",
    r"\bmend(?:s|ed|ing)?\b": "fix",
    r"\bfreedoms\b": "degrees of freedom",
    r"\bplaces? of rest\b": "equilibrium",
    r"\bheld by nothing\b": "unsupported",
    r"\bstays closed\b": "is satisfied",
    r"\bclosing rows?\b": "constraint row",
}
FROZEN = re.compile(r"lam\(tie, row\)|`[^`\n]*`")  # spellings that stay, and code


def named(path: Path) -> Iterator[tuple[int, str]]:
    """Public names of a module: its classes, functions, methods, fields and arguments."""
    for node in nodes_of(path):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith("_"):
            yield node.lineno, node.name
            if isinstance(node, ast.FunctionDef):
                yield from ((x.lineno, x.arg) for x in (*node.args.args, *node.args.kwonlyargs))
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.lineno, node.target.id


def pieces(name: str) -> list[str]:
    return [x.lower() for x in re.findall(r"[A-Z]?[a-z0-9]+|[A-Z]+", name)]


def test_public_names_are_the_fields_words():
    """tie -> constraint, mend -> fix, told -> reported ...; the old piece stands in no public name."""
    assert not [
        f"{path.relative_to(ROOT)}:{line}: {name}: say {NAMES[piece]}"
        for path in modules_of(PACKAGE)
        for line, name in named(path)
        for piece in pieces(name)
        if piece in NAMES
    ]


def test_messages_and_docstrings_are_in_the_fields_words():
    """Every text of the package that is a sentence."""
    found = []
    for path in modules_of(PACKAGE):
        for node in nodes_of(path):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value.strip():
                text = FROZEN.sub("", node.value)
                found += [
                    f"{path.relative_to(ROOT)}:{node.lineno}: {m[0]}: say {said}"
                    for old, said in SENTENCES.items()
                    for m in re.finditer(old, text)
                ]
    assert not found


def test_pages_are_in_the_fields_words():
    """docs/, README, CONTRIBUTING, models/README and the templates."""
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "models").glob("*.md")]
    pages += [path for path in (PACKAGE / "templates").rglob("*.*") if path.suffix in (".toml", ".md")]
    found = []
    for page in pages:
        if page.name == "versions.md":  # which says what was renamed
            continue
        text = FROZEN.sub("", re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.S | re.M))
        found += [
            f"{page.relative_to(ROOT)}: {m[0]}: say {said}"
            for old, said in SENTENCES.items()
            for m in re.finditer(old, text)
        ]
    assert not found


def test_a_docstring_begins_with_a_noun_or_a_verb():
    """\"True if the quantity is conserved\", not \"Whether it is\"."""
    kinds = (ast.FunctionDef, ast.ClassDef, ast.Module)
    found = [
        f"{path.relative_to(ROOT)}:{getattr(node, 'lineno', 1)}: {said.splitlines()[0]}"
        for path in modules_of(PACKAGE)
        for node in nodes_of(path)
        if isinstance(node, kinds) and (said := ast.get_docstring(node)) and said.split()[0].strip("`(),.:;") in OPENERS
    ]
    assert not found, "say first what comes back or what is done: a noun or a verb"
