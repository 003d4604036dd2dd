"""Syntax trees of sources and the figures of the house: parsed once for all tests that read them."""

from __future__ import annotations

import ast
import runpy
from functools import cache
from pathlib import Path

HOUSE = runpy.run_path(str(Path(__file__).parents[2] / "benchmarks" / "house.py"))
house = HOUSE["house"]  # the figures of a package, by default of eomgen


def tree_of(path: Path) -> ast.Module:
    """The tree of a module; of a path, once."""
    tree: ast.Module = HOUSE["tree_of"](path)
    return tree


@cache
def nodes_of(path: Path) -> tuple[ast.AST, ...]:
    """All nodes of a module, as `ast.walk` gives them."""
    return tuple(ast.walk(tree_of(path)))


@cache
def modules_of(package: Path) -> tuple[Path, ...]:
    """The modules of a package, sorted."""
    return tuple(sorted(package.rglob("*.py")))
