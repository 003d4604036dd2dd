"""How far a sweep is, on a terminal: rate and time left by tqdm, where it is installed."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress_of(runs: int, done: int) -> Iterator[Callable[[int], object]]:
    """What is told of each chunk: how many runs it adds."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield lambda more: None
        return
    try:
        from tqdm import tqdm
    except ImportError:
        yield lambda more: None
        return
    with tqdm(total=runs, initial=done, unit=" runs", file=sys.stderr) as bar:
        yield bar.update
