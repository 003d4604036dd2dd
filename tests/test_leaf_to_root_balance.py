"""Blocks solved from the leaves inwards against least squares of the whole."""

from __future__ import annotations

import numpy as np
import pytest

from eomgen.simulation.reaction_columns import balanced_from_leaves, steps_of


def _bodies(parents: list[int], loops: list[tuple[int, int]], rng: np.random.Generator) -> tuple[np.ndarray, list]:
    """(matrices of 4 states, rows of each body): a joint of 5 components a body, constraints of 2 between bodies."""
    pairs = [(body, parent, 5) for body, parent in enumerate(parents)] + [(a, b, 2) for a, b in loops]
    A = np.zeros((4, 6 * len(parents), sum(k for *_, k in pairs)))
    place = 0
    for a, b, k in pairs:
        for body in (a, b):
            if body >= 0:
                A[:, 6 * body : 6 * body + 6, place : place + k] = rng.normal(size=(4, 6, k))
        place += k
    return A, [list(range(6 * i, 6 * i + 6)) for i in range(len(parents))]


@pytest.mark.parametrize(
    "parents, loops, core",
    [
        ([-1, 0, 1, 1, 3], [], 0),  # a tree: nothing is left over
        ([-1, 0, 1, -1, 3, 4], [(2, -1)], 17),  # one loop: three joints and the constraint are solved as one
        ([-1, 0, -1, 2], [(1, 3), (1, -1)], 24),
    ],
)
def test_blocks_give_what_the_whole_gives(parents, loops, core):
    A, groups = _bodies(parents, loops, np.random.default_rng(2))
    rho = np.random.default_rng(3).normal(size=(4, A.shape[2]))
    b = (A @ rho[:, :, None])[:, :, 0]
    steps = steps_of(A[0], (A != 0).any(axis=0), groups)
    found, regular = balanced_from_leaves(A, b, steps)
    assert regular.all()
    assert found == pytest.approx(rho, abs=1e-10)
    assert sorted(np.concatenate([step.columns for step in steps])) == list(range(A.shape[2]))
    assert len(steps[-1].columns) == core


def test_a_state_in_which_a_block_is_singular_is_told():
    A, groups = _bodies([-1, 0], [], np.random.default_rng(4))
    A[2, :, 7] = A[2, :, 6]
    _, regular = balanced_from_leaves(A, np.ones(A.shape[:2]), steps_of(A[0], A[0] != 0, groups))
    assert list(regular) == [True, True, False, True]
