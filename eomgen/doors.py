"""Doors of rooms: a room gives to others what the stub of its package names, and loads each name on its first use.

The stub `__init__.pyi` is the one list: type checkers read it, and at run time so does this.

    from eomgen.scene.making import scene_of as scene_of
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

NAMED = re.compile(r"^from (\S+) import (\w+) as \2$", re.M)


def door(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package, by the stub beside its `__init__.py`."""
    own = sys.modules[package]
    stub = Path(str(own.__file__)).with_suffix(".pyi").read_text("utf-8")
    homes = {name: home for home, name in NAMED.findall(stub)}

    def given(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        home = import_module(homes[name])
        in_home = home is not own and hasattr(home, name)
        value = getattr(home, name) if in_home else import_module(f"{homes[name]}.{name}")
        setattr(own, name, value)
        return value

    return given, lambda: sorted({*vars(own), *homes}), sorted(homes)
