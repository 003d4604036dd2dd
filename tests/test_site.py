"""The site: every command on its pages runs and prints what stands there; it builds without a warning."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html import unescape
from pathlib import Path

import pytest
from pages import ellipsis, run_page
from slow_run import sampled

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
WRITTEN = sorted([*DOCS.glob("*.md"), *DOCS.glob("how_to/*.md")])
PAGES = [page for page in WRITTEN if re.search(r"^```(sh$|text\n\$ eomgen )", page.read_text("utf-8"), re.M)]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site with a gallery of a few models, built by its own command, where a warning is an error."""
    place = tmp_path_factory.mktemp("site")
    quick = {**os.environ, "EOMGEN_GALLERY": "quick", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, str(DOCS / "build.py"), str(place)]
    done = subprocess.run(command, env=quick, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return place


def test_a_reader_needs_no_network(site):
    """No page asks for anything from elsewhere; every formula is set; every link leads to a page.

    Slow: Sphinx builds all pages once, each with its formulas and pictures; the tests below read the same.
    """
    pages = list(site.rglob("*.html"))
    assert len(pages) > 50
    for page in pages:
        text = page.read_text("utf-8")
        requested = re.findall(r"<(?:script|img|iframe|link|source)\b[^>]*?\b(?:src|href)=\"([^\"]+)\"", text)
        assert not [each for each in requested if "//" in each], page
        assert "merror" not in text and "latex-error" not in text, page
        for target in re.findall(r"<a [^>]*?href=\"([^\"#?]+)", text):
            if "://" not in target and not target.startswith("mailto:"):
                assert (page.parent / target).exists(), f"{page}: {target}"


def test_every_page_is_three_clicks_from_the_start(site):
    """By the links of the pages, the start's own among them."""
    start = (site / "index.html").resolve()
    reached, edge = {start}, {start}
    for _ in range(3):
        found = {to for page in edge for to in linked_from(page)}
        edge = found - reached
        reached |= edge
    pages = {page for page in start.parent.rglob("*.html") if not page.stem.endswith(".motion")}
    pages = {page for page in pages if "_static" not in page.parts and page.stem != "search"}  # the theme's own
    assert not {page.relative_to(start.parent).as_posix() for page in pages - reached}


def linked_from(page: Path) -> set[Path]:
    """The pages to which a page leads."""
    targets = re.findall(r"<a [^>]*?href=\"([^\"#?:]+)", page.read_text("utf-8"))
    return {to for to in ((page.parent / target).resolve() for target in targets) if to.suffix == ".html"}


def test_a_kind_has_a_page_with_its_picture(site):
    """Its keys, its example, what follows of it; the reference's table and the list of kinds lead there."""
    found = {path.stem: path.read_text("utf-8") for path in site.glob("reference/kinds/*.html")}
    assert "_images/rolling.svg" in found["rolling"] and (site / "_images" / "rolling.svg").stat().st_size > 2000
    words = unescape(re.sub("<[^>]+>", "", found["rolling"]))
    assert "Disc on a slope" in words and "Equations of motion" in words and "nonnegative expression [m]" in words
    assert 'href="kinds/rolling.html"' in (site / "reference" / "constraints.html").read_text("utf-8")
    assert all(f'href="{name}.html"' in found["index"] for name in found if name != "index")


def test_a_page_of_the_gallery_tells_what_eomgen_finds(site):
    """Its equations as formulas, its answers, its file; the page of all has the picture of each, which leads there."""
    pages = [path for path in site.glob("gallery/**/*.html") if not path.stem.endswith(".motion")]
    found = {path.stem: path.read_text("utf-8") for path in pages}
    assert (site / "gallery" / "double_pendulum.motion.html").exists() and "<iframe" in found["double_pendulum"]
    assert "<math" in found["double_pendulum"] and "Equations of motion" in found["double_pendulum"]
    assert "<mn>20</mn>" in found["gerber_beam"] and "eomgen says" not in "".join(found.values())
    assert all(
        "eomgen new mine --example" in re.sub("<[^>]+>", "", text) for name, text in found.items() if name != "index"
    )
    cards = re.findall(
        r'<a [^>]*href="(?:seeds/)?(\w+)\.html"><span[^>]*><img [^>]*src="[^"]*/(\w+)\.svg"', found["index"]
    )
    assert all(name == picture for name, picture in cards) and {name for name, _ in cards} == found.keys() - {"index"}


def test_a_notebook_is_a_page_with_what_it_showed(site):
    """Its code, formulas, and each of its pictures; the page of all leads there."""
    found = {path.stem: path.read_text("utf-8") for path in site.glob("notebooks/*.html")}
    kept = {path.stem: path.read_text("utf-8") for path in (ROOT / "notebooks").glob("*.ipynb")}
    assert found.keys() == kept.keys() | {"index"} and all(f'href="{name}.html"' in found["index"] for name in kept)
    assert all(found[name].count("<img") == text.count('"image/png": "') for name, text in kept.items())
    assert "<math" in found["1_first_motion"] and "eomgen.derive" in re.sub("<[^>]+>", "", found["1_first_motion"])


def test_a_search_asks_for_no_other_page(site):
    """A browser lets no page of a file fetch another: what is found is listed by its title."""
    assert "SHOW_SEARCH_SUMMARY: false" in (site / "_static" / "documentation_options.js").read_text("utf-8")


@sampled(3)
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_of_a_page_does_what_stands_there(page, tmp_path, monkeypatch):
    """In a new folder, one after the other.

    Slow: pages show models as readers have them, Bricard's linkage among them.
    """
    monkeypatch.chdir(tmp_path)
    assert run_page(page.read_text("utf-8")) > 0


def test_a_page_that_says_what_was_not_printed_is_found(tmp_path, monkeypatch):
    """One digit wrong, one line left out."""
    monkeypatch.chdir(tmp_path)
    page = (DOCS / "first_hour.md").read_text("utf-8")
    for old, new in (("= 49.05 N", "= 49.06 N"), ("space: plane\n", "")):
        assert old in page
        with pytest.raises(AssertionError):
            run_page(page.replace(old, new))


def test_dots_stand_for_what_is_left_out():
    """Lines, or a part of one."""
    assert re.fullmatch(ellipsis("a\n...\nb ... d\n"), "a\n1\n2\nb c d\n")
    assert not re.fullmatch(ellipsis("a\nb\n"), "a\n1\nb\n")
