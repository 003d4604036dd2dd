"""All calls of one drawn model share what the product keeps with a frozen model, and its proofs.

A call by the command line reads the file anew; here the same text gives the same frozen model, so that its equations
are derived once (`records.recalled`), and the proof of the same equations is made once. What a call adds (its printed
formulas, its code, another way of derivation) is proven in each.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import eomgen.model.reader
import eomgen.proof.certificate
from eomgen.proof import identities
from eomgen.proof.check import Certificate


@contextmanager
def one_model() -> Iterator[None]:
    """Within it a text is read once and equations are proven once."""
    read, prove, trials_of = (
        eomgen.model.reader._loads,
        eomgen.proof.certificate.certify,
        eomgen.proof.certificate.Trials,
    )
    models: dict[bytes, Any] = {}
    proofs: dict[bool, dict[int, tuple[Any, Certificate]]] = {False: {}, True: {}}
    trials: dict[int, tuple[Any, Any]] = {}

    def loads(data: bytes, *more: Any) -> Any:
        if data not in models:
            models[data] = read(data, *more)
        return models[data]

    def shared_trials(equations: Any) -> Any:
        return _once(trials, equations, trials_of)

    def certify(
        equations: Any, rhs: Any = None, derived: Any = None, *, printed: Any = None, begins: bool = True
    ) -> Certificate:
        checks = _once(proofs[begins], equations, lambda e: prove(e, begins=begins)).checks
        known = shared_trials(equations)
        if derived is not None:
            checks += tuple(identities.compared([identities.derivation(equations, derived)], known.states))
        if printed is not None:
            checks += tuple(known.printed(printed))
        return Certificate(checks if rhs is None else (*checks, known.code(rhs)))

    _replace("certify", prove, certify)
    eomgen.model.reader._loads, eomgen.proof.certificate.Trials = loads, shared_trials
    try:
        yield
    finally:
        _replace("certify", certify, prove)
        eomgen.model.reader._loads, eomgen.proof.certificate.Trials = read, trials_of


def _once(known: dict[int, tuple[Any, Any]], key: Any, make: Callable[[Any], Any]) -> Any:
    """make(key), once for each object."""
    if id(key) not in known:
        known[id(key)] = (key, make(key))
    return known[id(key)][1]


def _replace(name: str, old: Any, new: Any) -> None:
    """Another function under a name, wherever the product has taken it in."""
    for module in [m for key, m in sys.modules.items() if key.partition(".")[0] == "eomgen"]:
        if module.__dict__.get(name) is old:
            setattr(module, name, new)
