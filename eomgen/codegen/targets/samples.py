"""Functions through samples -> text: their tables, and the search for the piece in which t lies."""

from __future__ import annotations

import math
from collections.abc import Iterable

from eomgen.codegen.targets.base import Layout
from eomgen.symbolic.expression.splines import Sampled, sampled_of

_PIECE_IN_C = """\
static size_t piece_of(double t, size_t n, const double *bounds)
{
    size_t low = 0, high = n;
    while (low < high) {
        const size_t middle = low + (high - low)/2;
        if (bounds[middle] <= t) low = middle + 1; else high = middle;
    }
    return low;
}
"""
_THROUGH_SAMPLES = '''
def _through_samples(bounds, origins, columns, closed):
    """A function of time by pieces: of each its origin and its coefficients, of the highest power first."""
    bounds, origins = np.array(bounds), np.array(origins)
    columns = [np.array(column) for column in columns]

    def value(t):
        k = np.searchsorted(bounds, t, side="right") - closed*(t == bounds[-1])
        total = 0.0
        for column in columns:
            total = total*(t - origins[k]) + column[k]
        return total

    return value

'''


def c_samples(bodies: Layout) -> str:
    """A static function for each."""
    if not bodies.sampled:
        return ""
    return "\n".join([_PIECE_IN_C, *(_c_function(name, sampled_of(k)) for k, name in bodies.sampled.items())])


def python_samples(bodies: Layout) -> str:
    """A function for each, of one time or of an array of times."""
    if not bodies.sampled:
        return ""
    return _THROUGH_SAMPLES + "\n".join(_python_function(name, sampled_of(k)) for k, name in bodies.sampled.items())


def _c_function(name: str, sampled: Sampled) -> str:
    bounds, origins, columns = _numbers(sampled)
    ended = f" - (t == bounds[{len(bounds) - 1}])" if sampled.spline.closed else ""
    value = "v[0][k]"
    for power in range(1, len(columns)):
        value = f"({value})*s + v[{power}][k]" if power > 1 else f"{value}*s + v[1][k]"
    lines = [
        f"static double {name}(double t) /* {sampled.name} */",
        "{",
        f"    static const double bounds[{len(bounds)}] = {_braced(bounds)};",
        f"    static const double origins[{len(origins)}] = {_braced(origins)};",
        f"    static const double v[{len(columns)}][{len(origins)}] = {{",
        *(f"        {_braced(column)}," for column in columns),
        "    };",
        f"    const size_t k = piece_of(t, {len(bounds)}, bounds){ended};",
        *(["    const double s = t - origins[k];"] if len(columns) > 1 else ["    (void)origins;"]),
        f"    return {value};",
        "}",
        "",
    ]
    return "\n".join(lines)


def _python_function(name: str, sampled: Sampled) -> str:
    bounds, origins, columns = _numbers(sampled)
    closed = sampled.spline.closed
    return f"{name} = _through_samples({bounds!r}, {origins!r}, {columns!r}, {closed})  # {sampled.name}\n"


def _numbers(sampled: Sampled) -> tuple[list[float], list[float], list[list[float]]]:
    """(bounds, origins, coefficients, of the highest power first) as doubles."""
    spline, scale = sampled.spline, math.pi**sampled.pi_power
    columns = [[float(c) * scale for c in column] for column in zip(*spline.pieces, strict=True)]
    return [float(x) for x in spline.bounds], [float(x) for x in spline.origins], columns[::-1]


def _braced(numbers: Iterable[float]) -> str:
    return "{" + ", ".join(map(repr, numbers)) + "}"
