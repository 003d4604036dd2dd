"""Mathematics of a page as MathML, which browsers set by themselves: no script, no request."""

from __future__ import annotations

from docutils import nodes
from math_core import LatexToMathML

_set = LatexToMathML()


def visit_math(self, node: nodes.Element) -> None:
    """In a line."""
    self.body.append(_set.convert_with_local_state(node.astext(), displaystyle=False))
    raise nodes.SkipNode


def visit_displayed(self, node: nodes.Element) -> None:
    """On lines of its own."""
    text = node.astext().strip()
    self.body.append(f'<div class="formula">{_set.convert_with_local_state(text, displaystyle=True)}</div>')
    raise nodes.SkipNode


def setup(app) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_displayed, None))
    app.config.html_math_renderer = "mathml"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
