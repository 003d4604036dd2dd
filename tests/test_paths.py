"""Paths of SVG in few letters: the same places, and no bend that one could see is left out."""

from __future__ import annotations

import re

import numpy as np
import pytest

from eomgen.page.markup import SEEN, curve_path, stepped

WORD = re.compile(r"[a-zA-Z]|-?(?:\d+\.?\d*|\.\d+)")
TAKES = {"m": 2, "l": 2, "q": 4, "c": 6}


def places(path: str) -> list[tuple[str, list[float]]]:
    """The absolute places of a path, as a browser reads it: M L Q C in either case; after m come lines."""
    words, found, at, start, command, k = WORD.findall(path), [], (0.0, 0.0), (0.0, 0.0), "", 0
    while k < len(words):
        if words[k].isalpha():
            command, k = words[k], k + 1
        if command in "zZ":
            found.append(("z", []))
            at = start
            continue
        kind, own = command.lower(), (0.0, 0.0) if command.isupper() else at
        numbers = [float(word) for word in words[k : k + TAKES[kind]]]
        k += TAKES[kind]
        to = [value + own[i % 2] for i, value in enumerate(numbers)]
        at = (to[-2], to[-1])
        if kind == "m":
            start, command = at, "l" if command == "m" else "L"
        found.append((kind, to))
    return found


@pytest.mark.parametrize("seed", range(5))
def test_a_path_by_steps_goes_to_the_same_places(seed):
    """Each place to half of the last digit, however many steps lead to it."""
    dice = np.random.default_rng(seed)
    path = "".join(
        f"{letter}{' '.join(f'{x:.6f}' for x in dice.normal(0, 100, 2 * count))}" + "z" * (letter == "C" and k % 3 == 0)
        for k in range(60)
        for letter, count in (("M", 1), ("L", 1), ("L", 1), ("Q", 2), ("C", 3))
    )
    short = stepped(path)
    assert len(short) < 0.8 * len(path)
    for (kind, there), (other, here) in zip(places(path), places(short), strict=True):
        assert kind == other and np.allclose(there, here, atol=0.00501)


def test_a_curve_passes_every_point_by_less_than_one_sees_and_breaks_where_it_has_no_value():
    """|y - curve| <= SEEN + half a tenth upwards and along, at each instant that has a value."""
    x = np.linspace(58, 712, 401)
    y = 90 + 70 * np.sin(x / 40) + 3 * np.sin(x / 3)
    steepest = np.max(np.abs(np.diff(y) / np.diff(x)))
    y[100:120] = np.nan
    found = places(curve_path(x, y))
    assert [kind for kind, _ in found].count("m") == 2 and len(found) < 400
    pieces, k = [], -1
    for kind, at in found:
        k += kind == "m"
        pieces += [[]] if kind == "m" else []
        pieces[k].append(at)
    for piece, part in zip(pieces, (slice(0, 100), slice(120, 401)), strict=True):
        line = np.array(piece)
        assert np.max(np.abs(np.interp(x[part], line[:, 0], line[:, 1]) - y[part])) < SEEN + 0.05 * (1 + steepest)
        assert np.allclose([line[0, 0], line[-1, 0]], [x[part][0], x[part][-1]], atol=0.06)
