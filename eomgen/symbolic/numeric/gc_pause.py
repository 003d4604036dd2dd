"""A rest for the cycle collector while a graph grows."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def growing() -> Iterator[None]:
    """Expressions are made, and all of them stay: to look for cycles among them takes longer than to make them.

    Python's own counting of references goes on; what hangs in a ring is found afterwards.
    """
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()
