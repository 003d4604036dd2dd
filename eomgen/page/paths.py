"""Places -> the paths of SVG in few letters: steps instead of places, no digit and no point that nobody sees."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

import numpy as np

SEEN = 0.05  # [units of the picture] a curve may pass a point by that much
_WORD = re.compile(r"[A-Za-z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
_PAIRS = {"M": 1, "L": 1, "Q": 2, "C": 3}  # places of a command


def curve_path(x: np.ndarray, y: np.ndarray) -> str:
    """A line through the points; where there is no value it is broken."""
    y = np.where(np.isfinite(y), y, np.nan)
    pieces = np.split(np.arange(len(y)), np.flatnonzero(np.diff(np.isnan(y))) + 1)
    seen = (piece[_bends(x[piece], y[piece])] for piece in pieces if len(piece) and not np.isnan(y[piece[0]]))
    words = (f"{'L' if k else 'M'}{x[i]} {y[i]}" for piece in seen for k, i in enumerate(piece.tolist()))
    return stepped("".join(words), digits=1)


def _bends(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Which points a line needs so that it passes none by more than what is seen (Douglas and Peucker)."""
    kept, open_ = {0, len(x) - 1}, [(0, len(x) - 1)]
    while open_:
        a, b = open_.pop()
        if b - a < 2:
            continue
        inner = slice(a + 1, b)
        off = np.abs(y[inner] - y[a] - (y[b] - y[a]) * (x[inner] - x[a]) / ((x[b] - x[a]) or 1.0))
        if off.max() > SEEN:
            middle = a + 1 + int(off.argmax())
            kept.add(middle)
            open_ += [(a, middle), (middle, b)]
    return np.array(sorted(kept))


def stepped(path: str, digits: int = 2) -> str:
    """A path of absolute commands M, L, Q, C and Z by steps from place to place: the same to these digits."""
    words, said, before = _WORD.findall(path), [], ""
    at = start = (0, 0)  # in units of the last digit, so that errors do not add up
    k, size = 0, 10**digits
    command = ""
    while k < len(words):
        if words[k].isalpha():
            command, k = words[k], k + 1
        if command in "Zz":
            said.append("z")
            at, before = start, "z"
            continue
        many = 2 * _PAIRS[command]
        places = [round(float(word) * size) for word in words[k : k + many]]
        k += many
        steps = [value - at[i % 2] for i, value in enumerate(places)]
        letter = command.lower()
        if letter == "l" and at == (places[0], places[1]) and before != "m":
            continue
        implied = letter == before or (letter == "l" and before == "m")
        said.append(_joined(("" if implied else letter), (step / size for step in steps), said[-1] if implied else ""))
        at, before = (places[-2], places[-1]), letter
        if letter == "m":
            start = at
    return "".join(said)


def _joined(letter: str, values: Iterable[float], before: str) -> str:
    """Numbers one after the other, apart where they would be read as one."""
    text = letter
    for value in values:
        word = short(value)
        last = text or before
        text += word if not last or last[-1].isalpha() or word.startswith("-") else f" {word}"
    return text


def short(value: float) -> str:
    """A number of two digits at most, without the 0 before its point."""
    if not math.isfinite(value):
        return "0"
    word = f"{value:.2f}".rstrip("0").rstrip(".")
    sign, word = ("-", word[1:]) if word.startswith("-") else ("", word)
    return "0" if word in ("0", "") else sign + (word[1:] if word.startswith("0.") else word)
