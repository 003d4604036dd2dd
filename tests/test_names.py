"""A noun is defined once: a public name stands for one thing in the whole package."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

from source_trees import modules_of, tree_of

PACKAGE = Path(__file__).parent.parent / "eomgen"
SHARE = 0.03  # of all names; what a seam's members have in common (a format's `render`) is counted too


def public_names(tree: ast.Module) -> Iterator[str]:
    """Classes, functions and type aliases at the top of a module; LIMITS in capitals are read where they stand."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found = [node.name]
        elif isinstance(node, ast.Assign):
            found = [target.id for target in node.targets if isinstance(target, ast.Name)]
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found = [node.target.id]
        else:
            continue
        yield from (name for name in found if not name.startswith("_") and not name.isupper())


def homes(modules: Iterable[tuple[str, ast.Module]]) -> dict[str, list[str]]:
    """The modules that define each public name."""
    found = defaultdict(list)
    for module, tree in modules:
        for name in dict.fromkeys(public_names(tree)):
            found[name].append(module)
    return found


def test_a_noun_is_defined_once():
    """Under 3 % of the public names are defined in more than one module."""
    found = homes((str(path.relative_to(PACKAGE)), tree_of(path)) for path in modules_of(PACKAGE))
    twice = {name: modules for name, modules in found.items() if len(modules) > 1}
    assert len(twice) < SHARE * len(found), "\n".join(f"{name}: {', '.join(where)}" for name, where in twice.items())


def test_a_name_in_two_modules_is_seen():
    """Functions, classes and aliases alike; private names and constants are not counted."""
    one = ast.parse("State = dict\nclass Row: pass\ndef solved(): pass\n_own = 1\nMOST = 2\n")
    assert {name for name, where in homes((("a", one), ("b", one))).items() if len(where) == 2} == {
        "State",
        "Row",
        "solved",
    }
