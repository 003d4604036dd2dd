"""A tolerance stands in one place, with its reason."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from pathlib import Path

from each import each

PACKAGE = Path(__file__).parent.parent / "eomgen"
HOME = PACKAGE / "symbolic" / "numeric" / "tolerances.py"
WRITTEN = re.compile(r"[\d.][eE]-|\.0_?0_?0")  # how such a literal is written: only sources with it are parsed
LARGEST = 1e-4  # smaller numbers are tolerances; larger ones are quantities that a text may state
DECIMAL = re.compile(r"\S.*\b\d+e-0*(?:[4-9]|[1-9]\d)", re.S)  # in a text, not a text that is a unit's factor


def small_numbers(source: str) -> list[int]:
    """Lines with a float literal of at most 1e-4, in code or in a text that becomes code; docstrings are prose."""
    if not WRITTEN.search(source):
        return []
    tree = ast.parse(source)
    prose = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    found = []
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or id(node) in prose:
            continue
        is_small = isinstance(node.value, float) and 0 < abs(node.value) <= LARGEST
        if is_small or (isinstance(node.value, str) and DECIMAL.search(node.value)):
            found.append(node.lineno)
    return found


def wrong_lines(found: Callable[[str], list[int]], *, but: Path | None = None) -> list[str]:
    """path:line of all that is found in the modules of the package."""
    paths = (path for path in sorted(PACKAGE.rglob("*.py")) if path != but)
    return [f"{path.relative_to(PACKAGE)}:{line}" for path in paths for line in found(path.read_text())]


def test_no_module_holds_a_tolerance_of_its_own():
    """1e-n with n of 4 and more stands in eomgen/symbolic/numeric/tolerances.py only."""
    assert not wrong_lines(small_numbers, but=HOME), f"a name in {HOME.name}, with its reason, stands for it"


def test_every_tolerance_has_its_reason():
    """A comment says what it is a share of and why it is that large; no two names stand for one value unsaid."""
    lines = HOME.read_text().splitlines()
    for node in ast.parse(HOME.read_text()).body[2:]:
        assert isinstance(node, ast.Assign), "only tolerances stand here"
        reason = lines[node.lineno - 1].partition("#")[2].strip()
        assert len(reason.split()) >= 4, f"line {node.lineno} has no reason"


def test_every_tolerance_is_used():
    """What nobody asks for is not kept."""
    text = "\n".join(path.read_text() for path in PACKAGE.rglob("*.py") if path != HOME)
    names = {node.targets[0].id for node in ast.parse(HOME.read_text()).body if isinstance(node, ast.Assign)}
    assert names - set(re.findall(r"\w+", text)) == set()


@each("planted", ["x = 1e-9", "def f(tol=5e-16): pass", "g(rcond=0.0001)", "c = 'if (x < 1e-12)'"])
def test_a_planted_tolerance_is_seen(planted):
    assert small_numbers(planted) == [1]


BUDGETED = set(
    "normal_form equal readable readable_all collected_in common_factor cancelled simplest legible "
    "with_squares book_form roots readable_over expanded Expansion reactions_of solution_of_balance".split()
)

CALLED = re.compile(rf"\b(?:{'|'.join(sorted(BUDGETED))})\(")  # only sources with such a call are parsed


def own_budgets(source: str) -> list[int]:
    """Lines where a budget of work is a number of the module: a literal, or a constant that is no level of Work."""
    found = []
    for node in ast.walk(ast.parse(source)) if CALLED.search(source) else ():
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in BUDGETED):
            continue
        given = [*node.args[1:], *(k.value for k in node.keywords if k.arg in ("limit", "work"))]
        numbers = [x for x in given if isinstance(x, ast.Constant) and type(x.value) is int and x.value >= 100]
        names = [x for x in given if isinstance(x, ast.Name) and x.id in ("WORK", "LIMIT")]
        found += [x.lineno for x in (*numbers, *names)]
    return found


def test_no_module_holds_a_budget_of_its_own():
    """Products of terms come in the levels of eomgen/symbolic/numeric/work.py."""
    assert wrong_lines(own_budgets) == []


@each("planted", ["readable(x, 2000)", "reactions_of(s, work=300)", "cancelled(x, WORK)"])
def test_a_planted_budget_is_seen(planted):
    assert own_budgets(planted) == [1]
