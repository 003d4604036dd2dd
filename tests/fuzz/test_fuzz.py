"""Whatever is typed, a sentence comes back: random formulas, changed models, verbs with random options; fixed seeds.

Of ten shares two are drawn, in the slow run (EOMGEN_ALL_MODELS=1) all; `python tests/fuzz/long_run.py` draws many
more; what either found once stays in `regressions/` with the law it broke.
"""

from __future__ import annotations

import os
import shlex
import warnings
from pathlib import Path
from random import Random

import fuzzed_expressions
import fuzzed_verbs
import mutated_models
import pytest
from slow_run import sampled, usual

pytestmark = pytest.mark.slow

REGRESSIONS = sorted((Path(__file__).parent / "regressions").iterdir())
"""first line "# law: ..." (fixed) or "# open: ..." (not yet), second "# run: ...", then what it is done with"""
SEED, EXPRESSIONS, LOADS, VERBS, SHARES = 12, 10_000, 5_000, 300, 10


@pytest.mark.parametrize("share", usual(range(SHARES), 10))
def test_any_formula_means_what_it_says_prints_and_reads_back_or_is_refused_at_its_place(share):
    """parse(text) = the tree that wrote it, parse(print(parse(text))) = parse(text), at 50 digits; else a refusal."""
    rng = Random(f"expressions {SEED} {share}")
    for _ in range(EXPRESSIONS // SHARES):
        text, tree = fuzzed_expressions.one(rng)
        assert not fuzzed_expressions.broken_law(text, tree), repr(text)


@pytest.mark.parametrize("share", usual(range(SHARES), 10))
def test_any_file_is_a_model_or_a_list_of_problems_at_their_places(share):
    """loads(text) gives a Model or a ModelError, soon; each problem has its line and column and is told once."""
    rng = Random(f"loads {SEED} {share}")
    for _ in range(LOADS // SHARES):
        text = mutated_models.mutated(rng)
        assert not mutated_models.broken_law(text), text


@pytest.mark.parametrize("share", usual(range(SHARES), 10))
def test_any_verb_ends_in_its_result_or_a_sentence(share, tmp_path, monkeypatch):
    """Within its --patience, with a code of the table; --json is JSON; the proof of what loads and derives holds."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    rng = Random(f"verbs {SEED} {share}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for _ in range(VERBS // SHARES):
            text = mutated_models.loadable(rng, fuzzed_verbs.LONGEST)
            words = fuzzed_verbs.words(text, rng)
            if (shlex.join(words), text) in open_finds():
                continue
            assert not fuzzed_verbs.broken_law(text, words, tmp_path), f"{shlex.join(words)}\n{text}"


def read(path: Path) -> tuple[str, str, str]:
    """(law, or "open", what is run, with which text)."""
    law, command, text = path.read_bytes().decode("utf-8", "surrogatepass").split("\n", 2)
    assert law.startswith(("# law: ", "# open: ")) and command.startswith("# run: ")
    return law, command.removeprefix("# run: "), text


def open_finds() -> list[tuple[str, str]]:
    """What is known not to hold: it does not end the search for others."""
    return [(command, text) for law, command, text in map(read, REGRESSIONS) if law.startswith("# open: ")]


@sampled(3)
@pytest.mark.parametrize("path", REGRESSIONS, ids=lambda path: path.stem)
def test_what_was_found_once_does_not_come_back(path, tmp_path, monkeypatch, request):
    """The law that each file broke; one that is open may still break it."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    law, command, text = read(path)
    if law.startswith("# open: "):
        request.applymarker(pytest.mark.xfail(reason=law))  # not strict: on a busy machine patience may end first
    match shlex.split(command):
        case ["expression"]:
            broken = fuzzed_expressions.broken_law(text.removesuffix("\n"))
        case ["load"]:
            broken = mutated_models.broken_law(text)
        case words:
            broken = fuzzed_verbs.broken_law(text, words, tmp_path)
    assert not broken


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the limit of CPU needs the timers of POSIX")
def test_the_suite_sees_what_it_is_there_to_see(monkeypatch):
    """A minus that binds too strongly, a printer without parentheses, a reader with a bug: each breaks a law."""
    assert "means what it says" in fuzzed_expressions.broken_law("-x^2", ("^", ("neg", "x"), "2"))
    printed = fuzzed_expressions.to_text
    monkeypatch.setattr(fuzzed_expressions, "to_text", lambda x: printed(x).replace("(", "").replace(")", ""))
    assert "reads back to the same value" in fuzzed_expressions.broken_law("x*(y + 1)")
    monkeypatch.setattr(mutated_models, "loads", lambda *_, **__: 1 / 0)
    assert "only EomgenError" in mutated_models.broken_law("eomgen = 1")
