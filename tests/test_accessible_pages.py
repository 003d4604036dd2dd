"""Reports and players by the rules of WCAG, as axe-core checks them in a browser; light and dark."""

from __future__ import annotations

from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path

import pytest
from browser import visited
from slow_run import beside, in_slow_run, sampled
from tools import REQUIRED, needs

import eomgen
from eomgen.page.html import html_page

pytestmark = [
    pytest.mark.slow,
    needs("chromium"),
    pytest.mark.skipif(find_spec("axe_core_python") is None and not REQUIRED, reason="not installed: axe-core-python"),
]
MODELS = Path(__file__).parent.parent / "models"
SCRIPT = """
const found = [];
for (const theme of ["light", "dark"]) {
    document.documentElement.dataset.theme = theme;
    await new Promise(done => setTimeout(done, 100));
    const { violations, passes } = await axe.run(document, { resultTypes: ["violations"] });
    found.push([passes.length, violations.map(v => [v.id, v.nodes.map(n => n.target.join(" ")).slice(0, 5)])]);
}
return found;
"""


@cache
def report(name: str) -> str:
    return html_page(eomgen.report(MODELS / f"{name}.toml", time=0.5))


def player(name: str) -> str:
    return eomgen.play(MODELS / f"{name}.toml", time=0.5, trail="", forces=True).html


@sampled(3)
@pytest.mark.parametrize(
    ("made", "name"),
    [
        (report, "double_pendulum"),  # a motion
        *beside((report, "a_frame")),  # a structure, its released motions
        *beside((player, "four_bar")),  # sliders
        (player, "sliding_ladder"),  # sliders that rest
        (player, "heavy_top"),  # space
    ],
)
def test_axe_finds_no_fault_in_a_page(made, name):
    """No violation of any rule, many rules passed, no request, a silent console."""
    axe = resources.files("axe_core_python").joinpath("axe.min.js").read_text(encoding="utf-8")
    page = made(name).replace("</head>", f"<script>{axe}</script></head>")
    seen = visited(page, SCRIPT)
    assert seen.requests == () and seen.console == ()
    for passed, violations in seen.found:
        assert violations == [] and passed > 20


@in_slow_run
def test_axe_finds_a_planted_fault():
    """A control without a name, letters too pale."""
    axe = resources.files("axe_core_python").joinpath("axe.min.js").read_text(encoding="utf-8")
    faults = '<input type="range"><p style="color:#ccc;background:#fff">pale</p>'
    page = (
        report("double_pendulum")
        .replace("</head>", f"<script>{axe}</script></head>")
        .replace("</h1>", f"</h1>{faults}")
    )
    found = {name for _, violations in visited(page, SCRIPT).found for name, _ in violations}
    assert {"label", "color-contrast"} <= found
