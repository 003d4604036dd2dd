"""eomgen solve: what the file asks in [outputs]."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.questions import answers
from eomgen.report.answer import table
from eomgen.verbs.outcome import Outcome, listed


def solve(model: Model) -> Outcome:
    """Every entry of [outputs]."""
    found = answers.solve(model)
    unanswered = [name for name, answer in found.items() if not answer.answered]
    payload = {"name": model.name, "outputs": {name: answer.as_dict() for name, answer in found.items()}}
    failed = f"not answered: {listed(unanswered)}" if unanswered else ""
    notes = () if found else ("the model asks nothing: it has no [outputs]",)
    return Outcome(table(found) if found else "", payload, failed, notes)
