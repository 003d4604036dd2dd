"""Formulas as wide as their letters make them: broken so that none leaves its block, on pages and on papers."""

from __future__ import annotations

import html
import re
import statistics
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from browser import visited
from slow_run import ALL, sampled, usual
from tools import needs, tool

import eomgen
from eomgen.page.contents import Report
from eomgen.page.html import html_page
from eomgen.page.paper import pdf_of
from eomgen.page.report import Subject, report_of
from eomgen.symbolic.print import PAPER, PHONE

MODELS = Path(__file__).parent.parent / "models"
NAMES = ["quick_return", "tower_crane", "bolt_cutter", "slewing_crane", "heavy_top", "gerber_beam", "stewart_platform"]
QUICK = "beam_with_overhang"
LATER = sorted(p.stem for p in MODELS.rglob("*.toml") if p.stem != QUICK) if ALL else usual(NAMES, 3)
ASKED = [QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in LATER)]
MARGIN, PAGE = 68.0, 595.28  # of a paper [points]: 24 mm, and the width of A4


@cache
def made(name: str) -> Report:
    path = next(MODELS.rglob(f"{name}.toml"))
    subject = Subject(eomgen.load(path), 0.2, False, path.name, path.read_text("utf-8"))
    return report_of(subject, without=["motion", "downloads", "plots"])


BROKEN = [
    ("a + b - c", 99.0, ["a + b - c"]),
    ("a + b - c", 2.0, ["a", "+ b", "- c"]),
    (r"- a \left(b + \frac{c}{d} + e\right)^{2}", 4.0, [r"- a \bigl(b", r"+ \frac{c}{d}", r"+ e\bigr)^{2}"]),
    (r"a_{1} b_{1} c_{1} d_{1}", 3.0, [r"a_{1} b_{1} c_{1}", r"\cdot d_{1}"]),
    (r"\sin(\alpha + \beta) \cos\gamma", 4.5, [r"\sin(\alpha + \beta)", r"\cos\gamma"]),
    (r"\frac{a + b + c + d}{e + f}", 5.0, [r"\bigl(a", "+ b", "+ c", r"+ d\bigr)", r"\big/ \bigl(e + f\bigr)"]),
    (r"\sqrt{a + b + c + d}", 5.0, [r"\bigl(a", "+ b", "+ c", r"+ d\bigr)^{1/2}"]),
    (r"\frac{a + b}{c} d", 2.0, [r"\bigl(\bigl(a", r"+ b\bigr)", r"\big/ c\bigr)", r"\cdot d"]),
    (r"12 m_{1}", 1.0, ["12", r"\cdot m_{1}"]),
    (r"\varphi(t) + f(x)", 1.0, [r"\varphi(t)", "+ f(x)"]),
]


@pytest.mark.parametrize(("tex", "room", "wanted"), BROKEN)
def test_a_formula_is_broken_at_signs_then_in_brackets_then_between_factors(tex: str, room: float, wanted: list[str]):
    """Each piece begins with what joins it; functions keep their argument, numbers their digits."""
    assert [piece.tex for piece in PHONE.pieces(tex, room)] == wanted


def test_the_width_is_that_of_the_font():
    """m is wider than i; 2/9 stand on both sides of +; an exponent is 0.7 as large."""
    assert PAPER.width("m") == 0.878
    assert PAPER.width("i + i") == pytest.approx(2 * PAPER.width("i") + 0.778 + 4 / 9)
    assert PAPER.width("m^{m}") == pytest.approx(1.7 * 0.878)


BOXES = """
const found = [];
for (const frame of document.querySelectorAll("iframe")) {
    const page = frame.contentDocument, root = page.documentElement;
    while (root.dataset.typeset !== "yes") await new Promise((go) => setTimeout(go, 20));
    await page.fonts.ready;
    const shown = [...page.querySelectorAll("math")].filter((each) => each.getClientRects().length);
    const block = (each) => each.closest(".scroll") ?? each.closest("p, li, figcaption");
    const alone = shown.filter((each) => each.getAttribute("display") === "block");
    found.push({
        page: root.scrollWidth, screen: frame.clientWidth, count: alone.length,
        wide: shown.filter((each) => block(each) && !each.closest("table"))
            .map((each) => [each, block(each)].map((x) => x.getBoundingClientRect().right))
            .filter(([formula, box]) => formula > box + 0.5),
        rows: alone.flatMap((each) => {
            const size = parseFloat(page.defaultView.getComputedStyle(each).fontSize);
            const tex = each.querySelector("annotation").textContent.split("\\n").slice(1, -1);
            const width = each.querySelector("mtable").getBoundingClientRect().width / size;
            return tex.length === 1 ? [[tex[0], width]] : [];
        }),
    });
}
return found;
"""


@cache
def seen(name: str) -> list[Any]:
    """What a browser finds in the page, on a screen of 360 and of 1200 pixels."""
    inner = html.escape(html_page(made(name)))
    frames = "".join(
        f'<iframe style="width:{w}px;height:640px;border:0" srcdoc="{inner}"></iframe>' for w in (360, 1200)
    )
    found = visited(f"<!doctype html><meta charset=utf-8><body>{frames}</body>", BOXES).found
    assert isinstance(found, list), found
    return found


@sampled(2)
@needs("chromium")
@pytest.mark.parametrize("name", ASKED)
def test_no_formula_of_a_page_is_wider_than_its_block(name: str):
    """Its box ends where its block ends, on a telephone and on a wide screen; so does the page."""
    for screen in seen(name):
        assert screen["count"] and screen["page"] <= screen["screen"]
        assert screen["wide"] == []


@needs("chromium")
def test_widths_are_those_of_a_browser():
    """Of one row: ours / Chromium's."""
    rows = [row for screen in seen(QUICK) for row in screen["rows"]]
    ratios = [PHONE.width(tex.replace("&", "")) / width for tex, width in rows]
    assert len(ratios) > 3 and 0.98 < statistics.median(ratios) < 1.03
    assert 0.93 < min(ratios) and max(ratios) < 1.07


@sampled(2)
@needs("pdftotext")
@pytest.mark.parametrize("name", ASKED)
def test_nothing_of_a_paper_passes_the_margin(name: str, tmp_path: Path):
    """The boxes of all words of the PDF."""
    path = tmp_path / "paper.pdf"
    path.write_bytes(pdf_of(made(name)))
    text = subprocess.run([tool("pdftotext"), "-bbox", path, "-"], capture_output=True, text=True, check=True).stdout
    words = re.findall(r'<word xMin="([\d.]+)" yMin="[\d.]+" xMax="([\d.]+)" yMax="[\d.]+">(.*?)</word>', text)
    outside = [word for left, right, word in words if float(left) < MARGIN - 1 or float(right) > PAGE - MARGIN + 1]
    assert len(words) > 80 and outside == []
