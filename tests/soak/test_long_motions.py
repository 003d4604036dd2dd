"""The short form of the long motions: the same laws over a few periods."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from slow_run import ALL, sampled

sys.path.insert(0, str(Path(__file__).parent))

import long_motions

pytestmark = pytest.mark.slow


SHORT = [("stick_slip", 20), ("impacts", 20), ("stiffness", 3.0), ("chaos", 0.4 if ALL else 0.1)]


@sampled(2)
@pytest.mark.parametrize(("motion", "length"), SHORT)
def test_a_long_motion_keeps_its_law(motion, length):
    """Instants of events and places to 1e-8 (s, m, rad) beside closed forms, a chaotic angle beside its series."""
    reported = getattr(long_motions, motion)(length)
    off = [float(x) for x in re.findall(r"\d\.\de[-+]\d+", reported)]
    assert off and max(off) < 1e-8, reported
