"""One thing that was checked."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """One thing that was checked.

    Args:
        name: what must hold, in words.
        ok: whether it does.
        how: by which arithmetic ("prime field" is exact; "50 digits"; "floating point").
        detail: what differs, or "".
    """

    name: str
    ok: bool
    how: str
    detail: str = ""
