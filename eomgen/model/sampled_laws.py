"""A function of time given by samples: `{ samples = [[0, 0.1], [0.5, 0.2]], between = "cubic", ends = "rest" }`."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from eomgen.errors import ExpressionError, ModelError, Problem
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Diagnostic, shown, unknown_keys
from eomgen.model.fields import FormulaRule, Leaf, TextRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import (
    DeclaredSamples,
    Expression,
    Fraction,
    Sampled,
    as_expression,
    is_exact,
    spline_of,
)

MOST = 10_000  # samples of one function: more make code that is long to compile
KEYS = ("samples", "between", "ends")
EXAMPLE = "like samples = [[0, 0.1], [0.5, 0.2]], each time with its value"


@dataclass(frozen=True)
class TimeLawRule(FormulaRule):
    """A function of time: a number, the text of an expression, or samples.

    Args:
        ways: how the function may go between samples: what is differentiated twice must be smooth.
    """

    ways: tuple[str, ...] = Sampled.WAYS

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        if isinstance(raw, Mapping) and "samples" in raw:
            return self._sampled(raw, path, found)
        return FormulaRule.read(self, raw, path, found)

    def _sampled(self, raw: Mapping[str, Any], path: DocumentPath, found: list[Diagnostic]) -> Expression | None:
        unknown_keys(raw, KEYS, path, found, "samples")
        way = TextRule(self.ways).read(raw.get("between", "cubic"), (*path, "between"), found)
        ends = TextRule(Sampled.ENDS).read(raw.get("ends", Sampled.ENDS[0]), (*path, "ends"), found)
        if way in self.ways and way != "cubic" and "ends" in raw:
            found.append(Diagnostic((*path, "ends"), f"'ends' is for 'cubic', not for {way}", "leave it out"))
        pairs = _pairs(raw["samples"], (*path, "samples"), found)
        if pairs is None or way is None or ends is None:
            return None
        times, values = zip(*pairs, strict=True)
        text = f"{way} through {len(pairs)} samples from {_short(times[0])} to {_short(times[-1])} s"
        function = spline_of(times, values, way, ends)
        declared = DeclaredSamples(times, values, way, ends, ends_given="ends" in raw)
        return Expression.through_samples(Sampled("f(t)", function, 0, declared), text)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        pair = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
        samples = {
            "type": "object",
            "required": ["samples"],
            "additionalProperties": False,
            "properties": {
                "samples": {"type": "array", "items": pair, "minItems": 2, "maxItems": MOST},
                "between": {"enum": list(self.ways)},
                "ends": {"enum": list(Sampled.ENDS)},
            },
        }
        return {"anyOf": [FormulaRule.schema(self, definitions), samples]}


def samples(
    times: Iterable[Any], values: Iterable[Any], between: str = "cubic", ends: str = Sampled.ENDS[0]
) -> Expression:
    """A function of time through samples, for `motion`, `rate`, `acceleration` or an input; arrays are welcome.

    Raises:
        ModelError: times that do not ascend, too few or too many of them, what is no number.
    """
    found: list[Diagnostic] = []
    pairs = [[_plain(t), _plain(value)] for t, value in zip(times, values, strict=True)]
    law: Expression = TimeLawRule().read({"samples": pairs, "between": between, **_given_ends(ends)}, (), found)
    if found:
        raise ModelError(tuple(Problem(".".join(["samples", *map(str, f.path)]), f.what, fix=f.fix) for f in found))
    return law


def laws_through_samples(parts: Any) -> Iterator[tuple[DocumentPath, Sampled, DeclaredSamples]]:
    """(its path, the function, its samples) of every one that values hold, each with its path."""
    for path, value in parts:
        law = value.sampled if isinstance(value, Expression) else None
        if law is not None and law.declared is not None:
            yield path, law, law.declared


def given_samples(model: Any) -> Iterator[tuple[DocumentPath, Sampled, DeclaredSamples]]:
    """The same of what a model gives as a function of time."""
    tables = ("coordinates", "inputs", "constraints")
    yield from laws_through_samples(
        (leaf.path, leaf.value) for table in tables for leaf in leaves_of_table(model, table)
    )


def left_tables(model: Any, end: float) -> tuple[Problem, ...]:
    """Warnings of samples that a run from 0 goes beyond: there a cubic goes straight on, which is hardly intended."""
    found = []
    for path, _, given in given_samples(model):
        first, last = float(given.times[0]), float(given.times[-1])
        if given.way in Sampled.SMOOTH and not given.ends_given and (first > 0 or last < end):
            what = f"samples from {first:g} to {last:g} s in a run from 0 to {end:g} s: beyond them it goes on straight"
            found.append(Problem(".".join(map(str, path)), what, fix="give samples for all of it, or say its `ends`"))
    return tuple(found)


def leaves_of_table(model: Any, table: str) -> Iterator[Leaf]:
    """Every value of a table of a model."""
    for name, part in getattr(model, table).items():
        yield from part.leaves((table, name))


def _given_ends(ends: str) -> dict[str, str]:
    return {} if ends == Sampled.ENDS[0] else {"ends": ends}


def _plain(value: Any) -> Any:
    """A number of an array as Python's own."""
    return value.item() if hasattr(value, "item") else value


def _pairs(raw: Any, path: DocumentPath, found: list[Diagnostic]) -> list[tuple[Fraction, Fraction]] | None:
    """The samples as exact numbers, times ascending."""
    if not isinstance(raw, (list, tuple)) or not 2 <= len(raw) <= MOST:
        given = f"{len(raw)}" if isinstance(raw, (list, tuple)) else shown(raw)
        found.append(Diagnostic(path, f"a list of 2 to {MOST} samples is needed here, not {given}", EXAMPLE))
        return None
    pairs: list[tuple[Fraction, Fraction]] = []
    for i, pair in enumerate(raw):
        if not isinstance(pair, (list, tuple)) or len(pair) != 2:
            found.append(Diagnostic((*path, i), f"a time and a value are needed here, not {shown(pair)}", EXAMPLE))
            return None
        time, value = (number_given(x, (*path, i, j), found) for j, x in enumerate(pair))
        if time is None or value is None:
            return None
        if pairs and time <= pairs[-1][0]:
            what = f"the times of samples ascend, but {_short(time)} comes after {_short(pairs[-1][0])}"
            found.append(Diagnostic((*path, i, 0), what))
            return None
        pairs.append((time, value))
    return pairs


def number_given(raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Fraction | None:
    """A plain number as it is written, exactly; None, and a diagnostic, of what is none."""
    value: Any = None
    try:
        value = None if isinstance(raw, bool) else as_expression(raw).evaluate({})
    except ExpressionError as error:
        found.append(Diagnostic(path, error.what, "samples are plain numbers", error.column, error.length, raw=raw))
        return None
    if not is_exact(value):
        found.append(Diagnostic(path, f"samples are plain numbers, not {shown(raw)}"))
        return None
    return Fraction(value)


def _short(a: Fraction) -> str:
    return f"{float(a):g}"
