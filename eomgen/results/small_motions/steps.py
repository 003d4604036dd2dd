"""The steps of a linearization.

Modes -> the steps of a linearization: the reference, the equations to first order, modes, stability.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents import (
    Cell,
    Document,
    Formula,
    Grid,
    Law,
    Matrix,
    Prose,
    Side,
    Statement,
    Step,
    cell_text,
    listed_symbols,
    narrow_grid,
    open_at_rest,
    prose,
)
from eomgen.documents import Entry as Place
from eomgen.errors import DerivationError
from eomgen.mechanics.linearization import (
    LinearEquations,
    Modes,
)
from eomgen.mechanics.state import Entries
from eomgen.proof import PrintedModes
from eomgen.symbolic.exact import Polynomial
from eomgen.symbolic.expression import Node, Scalar, depends_on, is_zero, over, symbols_of
from eomgen.symbolic.numeric import numbers_of, tolerances
from eomgen.symbolic.print import text_size, to_text

SECOND_ORDER = Law("M*q'' + C*q' + K*q = B*w", r"M \ddot{q} + C \dot{q} + K q = B w")
FREE = Law("M*q'' + C*q' + K*q = 0", r"M \ddot{q} + C \dot{q} + K q = 0")
FORCED = (
    "Forces that change with time are taken as they are at t = 0; what they change by stands on the right side, as an "
    "input would, and the modes do not depend on it."
)
UNDAMPED = Law("M*q'' + K*q = 0", r"M \ddot{q} + K q = 0")
FIRST_ORDER = Law("M*u' + C*u + K*q = B*w,  q' = E*u + F*q", r"M \dot{u} + C u + K q = B w,\quad \dot{q} = E u + F q")
WITH_STATES = Law(f"{FIRST_ORDER.text} + B_z*w", FIRST_ORDER.latex + r" + B_{z} w")
WHERE = Law(
    "R = M*a - Q + c - J^T*lam",
    r"R = M a - Q + c - J^{\mathsf{T}} \lambda",
)
ALONG = Law(
    "K = Z^T*(R_q*P + R_u*Y + M*X_q),  C = Z^T*(R_u*Z + M*X_u)",
    r"K = Z^{\mathsf{T}}\left(R_{q} P + R_{u} Y + M X_{q}\right),\quad "
    r"C = Z^{\mathsf{T}}\left(R_{u} Z + M X_{u}\right)",
)
FOLLOW = Law(
    "dq = P*dq_i,  du = Z*du_i + Y*dq_i,  da = Z*da_i + X_u*du_i + X_q*dq_i",
    r"\delta q = P\, \delta q_{i},\quad \delta u = Z\, \delta u_{i} + Y\, \delta q_{i},\quad "
    r"\delta a = Z\, \delta a_{i} + X_{u}\, \delta u_{i} + X_{q}\, \delta q_{i}",
)
PLAIN = Law("K = dR/dq,  C = dR/du", r"K = \frac{\partial R}{\partial q},\quad C = \frac{\partial R}{\partial u}")
DETERMINANT = ("det({s}^2*M + {s}*C + K)", r"\det\left({s}^{{2}} M + {s} C + K\right)")
STATE_DETERMINANT = ("det(M)*det({s}*1 - A)", r"\det M \det\left({s} \mathbf{{1}} - A\right)")
LONG = 1200  # characters of one formula
WIDEST = 88  # characters of a row of a matrix


def linearization_steps(modes: Modes) -> tuple[Step, ...]:
    """Reference, equations, characteristic polynomial, modes, stability, transfer functions."""
    steps = [reference_step(modes), _equations(modes), *_characteristic(modes)]
    steps.append(_modes(modes))
    return (*steps, *_stability(modes), *_state_space(modes), *_transfers(modes))


# -- the equations --------------------------------------------------------------------------------------------


def _equations(modes: Modes) -> Step:
    small = modes.small
    e = small.equations
    constrained = len(e.coordinates) < len(e.all) or bool(small.reference.system.constraints.closing)
    statements: list[Statement] = [
        prose(
            "The equations of motion ",
            Law("R = 0", "R = 0"),
            ", ",
            WHERE,
            ", to first order in the displacements ",
            *listed_symbols(e.coordinates),
            " from it",
            ", along the constraints" if constrained else "",
            ": ",
            ALONG if constrained else PLAIN,
            ".",
        )
    ]
    undamped = all(is_zero(x) for row in e.C for x in row)
    turns = tuple(q for q in e.coordinates if q not in e.all)
    if turns:
        words = " are small turns about the axes of the body that spins, of which its speeds are the rates."
        statements.append(prose(*listed_symbols(turns), words))
    if constrained:
        statements.append(prose("The constraints, differentiated, say what follows: ", FOLLOW, "."))
    law = (SECOND_ORDER if e.inputs else UNDAMPED if undamped else FREE) if small.is_second_order else FIRST_ORDER
    law = WITH_STATES if e.states and e.inputs else law
    statements.append(prose(law, "."))
    if small.forced:
        statements.append(prose(FORCED))
    if len(e.speeds) > Modes.MOST_WRITTEN:
        statements.append(prose(f"M, C and K of {len(e.speeds)} coordinates stand in the result for machines."))
        return Step("equations", "Equations to first order", tuple(statements))
    rows = _rows(modes)
    if len(rows) > 1:
        statements.append(prose("Rows and columns in the order ", *listed_symbols(tuple(map(_plain, rows))), ":"))
    statements += _entries(modes, "M", e.M, rows, rows, mirrored=1)
    statements += _rates(modes, undamped)
    symmetric = small.is_second_order and _symmetric(modes, e.K)
    statements += _entries(modes, "K", e.K, rows, e.coordinates, mirrored=int(symmetric))
    if small.is_second_order and not symmetric:
        statements.append(prose("The skew part H = (K - K^T)/2 of K is circulatory."))
        statements += _entries(modes, "H", modes.symmetric_parts["H"], rows, e.coordinates, mirrored=-1)
    statements += _entries(modes, "B", e.B, rows, e.inputs)
    if not small.is_second_order:
        statements += _entries(modes, "E", e.E, e.coordinates, e.speeds)
        statements += _entries(modes, "F", e.F, e.coordinates, e.coordinates)
    if e.states:
        statements += _entries(modes, "B_z", e.D, e.coordinates, e.inputs)
    return Step("equations", "Equations to first order", tuple(statements))


def _rows(modes: Modes) -> Sequence[Node]:
    """Symbols of the rows: the coordinates for equations of second order, else the speeds."""
    e = modes.small.equations
    return e.coordinates if modes.small.is_second_order else e.speeds


def _rates(modes: Modes, undamped: bool) -> list[Statement]:
    """C, in its damping and its gyroscopic part where it has both."""
    e = modes.small.equations
    if undamped:
        return []
    if not modes.small.is_second_order:
        return _entries(modes, "C", e.C, e.speeds, e.speeds)
    parts = {letter: modes.symmetric_parts[letter] for letter in "DG"}
    upper = {letter: [modes.written(x) for k, row in enumerate(A) for x in row[k:]] for letter, A in parts.items()}
    there = [letter for letter, entries in upper.items() if not all(map(is_zero, entries))]
    words = {
        "D": "C = D, of damping (symmetric).",
        "G": "C = G, gyroscopic (skew).",
        "DG": "C = D + G, of damping (symmetric) and gyroscopic (skew).",
    }
    shown: list[Statement] = [prose(words.get("".join(there), ""))] if there else []
    for letter in there:
        shown += _entries(
            modes, letter, parts[letter], e.coordinates, e.coordinates, mirrored={"D": 1, "G": -1}[letter]
        )
    return shown


def _symmetric(modes: Modes, A: Entries) -> bool:
    if modes.small.exact is None:
        n = range(len(A))
        largest = max((abs(x) for row in A for x in row), default=0)
        return all(abs(A[i][j] - A[j][i]) <= tolerances.COMPUTED * largest for i in n for j in n)
    return all(is_zero(modes.tidy(A[i][j] - A[j][i])) for i in range(len(A)) for j in range(i))


def _entries(
    modes: Modes, letter: str, A: Entries, rows: Sequence[Node], columns: Sequence[Node], *, mirrored: int = 0
) -> list[Statement]:
    """The matrix; where it is too wide for a line its entries that are not zero.

    Args:
        mirrored: 1 or -1 of a symmetric or skew one: below the diagonal is what stands above it, times this.
    """
    if not columns:
        return []
    upper = [[0 if mirrored and j < i else modes.written(x) for j, x in enumerate(row)] for i, row in enumerate(A)]
    full = [[mirrored * upper[j][i] if mirrored and j < i else x for j, x in enumerate(r)] for i, r in enumerate(upper)]
    whole = matrix_of(full)
    if whole is not None:
        return [Formula((Law(letter, letter), whole))]
    found: list[Statement] = []
    for row, entries in zip(rows, upper, strict=True):
        for column, x in zip(columns, entries, strict=True):
            if not is_zero(x):
                found.append(Formula((Place(letter, _plain(row), _plain(column)), _side(x))))
    return found


def matrix_of(A: Entries) -> Matrix | None:
    """The matrix as it is printed; None where a line does not hold a row of it."""
    rows = tuple(tuple(_number(x) if isinstance(x, float) else x for x in row) for row in A)
    texts = [[x.text if isinstance(x, Law) else to_text(x) for x in row] for row in rows]
    width = sum(max(map(len, column)) + 2 for column in zip(*texts, strict=True))
    return Matrix(rows) if rows and rows[0] and width <= WIDEST else None


def _plain(x: Node) -> Node:
    """The coordinate of a rate."""
    plain: Node = x.graph.symbol(x.name.removesuffix("'"))
    return plain


def _side(x: Any) -> Side:
    if isinstance(x, float):
        return _number(x)
    return x if text_size(x) <= LONG else Law("(too long to print)", r"\text{(too long to print)}")


def _number(x: float) -> Law:
    text = f"{x + 0.0:.7g}"  # no minus before 0
    return Law(text, _latex_number(text))


# -- modes ------------------------------------------------------------------------------------------------------


def _characteristic(modes: Modes) -> tuple[Step, ...]:
    shown = _polynomial(modes)
    if shown is None:
        return ()
    exact, s = modes.small.exact, "s"
    if exact is not None and not isinstance(shown, Law):
        s = exact.laplace_variable.name
    law = Law(*(x.format(s=s) for x in (DETERMINANT if modes.small.is_second_order else STATE_DETERMINANT)))
    statements = (prose(f"With displacements that go as exp({s} t):"), Formula((law, shown, 0)))
    return (Step("characteristic", "Characteristic equation", statements),)


def _polynomial(modes: Modes) -> Side | None:
    """Exact where that is short enough to print, else in numbers; None where there are neither."""
    small = modes.small
    found = modes.polynomial
    if found is not None and (not small.reference.valued or sum(map(text_size, found.coefficients)) <= LONG):
        return _side(_written(modes, found))
    if not small.reference.valued or len(small.state_matrix) > Modes.MOST_WRITTEN:
        return None
    scale = np.linalg.det(np.array(small.numbers.M, dtype=float))
    return _in_numbers(scale * np.poly(small.state_matrix))


def _in_numbers(coefficients: np.ndarray) -> Law:
    """The highest power first."""
    n = len(coefficients) - 1
    largest = abs(coefficients).max()
    terms = [
        (f"{x:.7g}".replace("+0", "").replace("-0", "-"), n - k)
        for k, x in enumerate(coefficients)
        if abs(x) > tolerances.SOLVED * largest
    ]
    plain = [c + {0: "", 1: "*s"}.get(k, f"*s^{k}") for c, k in terms]
    latex = [_latex_number(c) + {0: "", 1: " s"}.get(k, f" s^{{{k}}}") for c, k in terms]
    one = (("1*s", "s"), ("1 s", "s"))
    found = [
        [re.sub(rf"^(-?){re.escape(a)}", rf"\1{b}", x) for x in written]
        for written, (a, b) in zip((plain, latex), one, strict=True)
    ]
    return Law(*(" + ".join(x).replace("+ -", "- ") for x in found))


def _latex_number(text: str) -> str:
    mantissa, _, power = text.partition("e")
    return rf"{mantissa} \cdot 10^{{{int(power)}}}" if power else text


def _written(modes: Modes, polynomial: Polynomial) -> Scalar:
    """The highest power first."""
    assert modes.small.exact is not None
    s, coefficients = modes.small.exact.laplace_variable, [modes.written(c) for c in polynomial.coefficients]
    total: Scalar = sum((c * s**n for n, c in reversed(list(enumerate(coefficients)))), start=0)
    if isinstance(total, Node) and total.op == "neg":
        return total
    total = 0
    for n, c in reversed(list(enumerate(coefficients))):
        power = c * s**n
        if isinstance(total, Node) and isinstance(power, Node):  # a sum that was written before keeps its own order
            total = s.graph.held("add", (total, power))
        else:
            total += power
    return total


def _modes(modes: Modes) -> Step:
    """Frequencies in closed form, and a table of the modes in numbers."""
    statements: list[Statement] = []
    for k, exact in enumerate(_exact_frequencies(modes), start=1):
        if exact is not None and not is_zero(exact):
            statements.append(Formula((Law(f"omega_{k}", rf"\omega_{{{k}}}"), _side(modes.written(exact)))))
    if modes.small.reference.valued:
        rows = list(_mode_rows(modes))
        head = ("mode", "eigenvalue [1/s]", "omega [rad/s]", "f [Hz]", "damping ratio", "")
        statements += [narrow_grid(head, rows), _shapes(modes)]
        if modes.small.numbers.states and modes.participation:
            names = [f"mode {k}" for k in range(1, len(rows) + 1)]
            every = modes.small.numbers.moving
            shares: list[tuple[Cell, ...]] = [(x, *(f"{y[x.name]:.3f}" for y in modes.participation)) for x in every]
            statements.append(prose("What takes part in each mode, of x the shares abs(V o V^-T):"))
            statements.append(Grid(("share", *names), tuple(shares)))
    if not statements:
        statements.append(prose("The modes depend on the values of the parameters."))
    return Step("modes", "Modes", tuple(statements))


def _exact_frequencies(modes: Modes) -> list[Scalar | None]:
    """Each in closed form, None where it has none; [] where their order depends on the parameters."""
    try:
        return [found.exact for found in modes.frequencies]
    except DerivationError:
        return []


def _mode_rows(modes: Modes) -> Iterator[tuple[Cell, ...]]:
    for k, mode in enumerate(modes.spectrum.modes, start=1):
        sizes = (mode.frequency, mode.hertz, mode.damping_ratio)
        shown = ("" if x is None else f"{x:.7g}" for x in sizes)
        yield str(k), _complex(mode.eigenvalue, pair=mode.pair), *shown, mode.kind


def _complex(x: complex, *, pair: bool = False) -> Cell:
    if not x.imag:
        return f"{x.real:.7g}"
    sign = "+-" if pair else "+" if x.imag > 0 else "-"
    text = f"{x.real:.7g} {sign} {abs(x.imag):.7g}i" if x.real else f"{sign}{abs(x.imag):.7g}i"
    latex = " ".join(_latex_number(part) for part in text.removesuffix("i").split())
    return Law(text, latex.replace("+-", r"\pm ") + r"\,\mathrm{i}")


def _shapes(modes: Modes) -> Grid:
    """A column for each mode, the largest displacement 1."""
    shapes = [mode.shape for mode in modes.spectrum.modes]
    rows: list[tuple[Cell, ...]] = [(q, *(_complex(_tidied(each[q])) for each in shapes)) for q in (shapes or [{}])[0]]
    return Grid(("shape", *(f"mode {k}" for k in range(1, len(shapes) + 1))), tuple(rows))


def _tidied(x: complex) -> complex:
    return complex(round(x.real, 6) + 0.0, round(x.imag, 6) + 0.0)


# -- stability, inputs ----------------------------------------------------------------------------------------


def _stability(modes: Modes) -> tuple[Step, ...]:
    statements: list[Statement] = []
    if modes.small.reference.valued:
        statements.append(prose(f"{modes.spectrum.stability.capitalize()}: {modes.spectrum.why}."))
    conditions = modes.conditions
    if conditions.expressions:
        which = "all motions but those that stay as they are" if conditions.zeros else "all motions"
        statements.append(prose(f"By Routh and Hurwitz {which} {conditions.words} where these are positive:"))
        sides = _or_numbers(modes, conditions.expressions)
        statements += [Formula((Law(f"h_{k}", f"h_{{{k}}}"), side)) for k, side in enumerate(sides, start=1)]
    return (Step("stability", "Stability", tuple(statements)),) if statements else ()


def _or_numbers(modes: Modes, scalars: Sequence[Scalar]) -> list[Side]:
    """Formulas, or their values where they are too long to print."""
    reference = modes.small.reference
    long = [x for x in scalars if reference.valued and text_size(x) > LONG]
    values = dict(zip(long, numbers_of(long, reference.system.scope.known_exactly), strict=True))
    return [_number(values[x]) if x in values else _side(modes.written(x)) for x in scalars]


def _state_space(modes: Modes) -> tuple[Step, ...]:
    """A, B, C_y, D_y of the coordinates as outputs, exact where they are short, else in numbers; without inputs A."""
    e = modes.small.equations
    shown = _state_matrices(modes) if len(e.speeds) <= Modes.MOST_WRITTEN else ()
    if not shown:
        return ()
    words = prose(Law("x' = A*x", r"\dot{x} = A x"), ", with x = (", *listed_symbols(e.moving), "):")
    if e.inputs:
        words = _with_inputs(e)
    letters = ("A", "B", "C_y", "D_y")
    formulas = [Formula((Law(x, x.replace("_y", "_{y}")), m)) for x, m in zip(letters, shown, strict=False)]
    return (Step("state_space", "State space", (words, *formulas)),)


def _with_inputs(e: LinearEquations) -> Prose:
    return prose(
        Law("x' = A*x + B*w,  y = C_y*x + D_y*w", r"\dot{x} = A x + B w,\quad y = C_{y} x + D_{y} w"),
        ", with x = (",
        *listed_symbols(e.moving),
        "), w = (",
        *listed_symbols(e.inputs),
        ") and y = (",
        *listed_symbols(e.coordinates),
        "):",
    )


def _state_matrices(modes: Modes) -> tuple[Matrix, ...]:
    """State matrices that are not empty: exact where all can be printed, else in numbers; () without either."""
    small = modes.small
    outputs = tuple(q.name for q in small.numbers.coordinates)
    for found in modes.state_spaces(outputs):
        if found is not None:
            parts = (found.A, found.B, found.C_y, found.D_y) if found.inputs else (found.A,)
            shown = [matrix_of([[modes.written(x) for x in row] for row in part]) for part in parts]
            if None not in shown:
                return tuple(x for x in shown if x is not None)
    return ()


def _transfers(modes: Modes) -> tuple[Step, ...]:
    if not modes.transfers:
        return ()
    exact = modes.small.exact
    s = "s" if exact is None else exact.laplace_variable.name
    statements: list[Statement] = [prose(f"From inputs to coordinates, as functions of {s}:")]
    for f in modes.transfers:
        statements.append(Formula((Place("W", f.coordinate, f.input), _quotient(modes, f.above, f.below))))
    return (Step("transfer", "Transfer functions", tuple(statements)),)


def _quotient(modes: Modes, above: Polynomial, below: Polynomial) -> Side:
    exact = modes.small.exact
    if exact is not None and not any(isinstance(c, float) for c in below.coefficients):
        return _side(over(_written(modes, above), _written(modes, below)))
    if not any(above.coefficients):
        return 0
    up, down = (_in_numbers(np.array(p.coefficients[::-1], dtype=float)) for p in (above, below))
    return Law(f"({up.text})/({down.text})", rf"\frac{{{up.latex}}}{{{down.latex}}}")


# -------- printed modes ---------------------------------------------------------------------------------------
# The steps of a linearization -> what is printed of its matrices, modes and conditions, in numbers.


def printed_modes(derivation: Document) -> PrintedModes:
    """Formulas at the values of the parameters; where one has none, nan."""
    statements = [s for step in derivation.steps for s in step.statements]
    named = list(_named(statements))
    values = {name: _parameter_number(x) for name, x in derivation.parameters.items() if x is not None}
    matrices: dict[str, Any] = {}
    for name, side in named:
        if isinstance(side, Matrix):
            rows = [[_value(x, values) for x in row] for row in side.rows]
            if not any(math.isnan(x) for row in rows for x in row):
                matrices[name] = rows  # of the two that are called B that of the states, the last
    grids = {cell_text(s.head[0]): s for s in statements if isinstance(s, Grid)}
    modes, shapes = grids.get("mode"), grids.get("shape")
    return PrintedModes(
        matrices,
        []
        if modes is None
        else [dict(zip(map(cell_text, modes.head), map(cell_text, r), strict=True)) for r in modes.rows],
        {} if shapes is None else {cell_text(q): list(map(cell_text, cells)) for q, *cells in shapes.rows},
        [_value(side, values) for name, side in named if name.startswith("h_")],
    )


def _named(statements: list[Any]) -> Iterator[tuple[str, Side]]:
    """(M, its meaning) of formulas that begin with a letter."""
    for statement in statements:
        if isinstance(statement, Formula) and isinstance(statement.sides[0], Law) and len(statement.sides) == 2:
            yield statement.sides[0].text, statement.sides[1]


def _parameter_number(value: Any) -> float:
    """The value of a parameter: an angle in degrees is an expression of pi."""
    return numbers_of((value,))[0] if isinstance(value, Node) else float(value)


def _value(side: Any, values: Mapping[str, float]) -> float:
    if isinstance(side, Law):
        try:
            return float(side.text)
        except ValueError:
            return math.nan
    if not isinstance(side, Node):
        return float(side)
    symbols = symbols_of((side,))
    if any(x.name not in values for x in symbols):
        return math.nan
    return numbers_of((side,), {x: values[x.name] for x in symbols})[0]


# -------- reference step --------------------------------------------------------------------------------------
# Modes -> the step that says about what the equations are linearized: equilibrium or steady motion.


LONG_CONDITION = 400  # characters of a condition or formula of a family
SHORT = 90  # characters of a formula in a table
NOTHING_DEPENDS = "nothing depends on them, and they have no speed of their own"


def reference_step(modes: Modes) -> Step:
    """The state, how it was found, and the family that a steady motion belongs to."""
    small, reference = modes.small, modes.small.reference
    symbols = reference.system.symbols
    shown = symbols.places if reference.about_equilibrium else symbols.x
    rows: list[tuple[Cell, ...]] = []
    for x in shown:
        exact: Cell = reference.exact.get(x, "")
        value, beside = float(reference.numbers[x]), reference.beside or {}
        from_start = (_digits(beside[x]), _digits(value - beside[x])) if x in beside and reference.valued else ("", "")
        rows.append((x, exact, _digits(value) if reference.valued else "", *from_start))
    head = ("quantity", "exact", "value", "start", "away from it")
    statements: list[Statement] = [prose(_words(modes)), narrow_grid(head, rows)]
    statements += _family(modes)
    if reference.place is not None and reference.place.statics.held:
        statements.append(prose(f"Driven coordinates are held there: {', '.join(reference.place.statics.held)}."))
    if reference.about_equilibrium:
        statements += open_at_rest(reference.system)
    if small.left_out:
        one = len(small.left_out) == 1
        why = "nothing depends on it, and it has no speed of its own" if one else NOTHING_DEPENDS
        statements.append(prose("Left out: ", *listed_symbols(small.left_out), f"; {why}."))
    return Step("reference", "Reference", tuple(statements))


def _words(modes: Modes) -> str:
    reference = modes.small.reference
    if reference.beside is not None:
        near = "The steady motion" if reference.about_steady_motion else "The equilibrium"
        return f"The start is accelerated. {near} near it, about which this is:"
    if reference.about_steady_motion:
        return "The steady motion nearest to the start:"
    if not reference.about_equilibrium:
        return "The steady motion from the start:"
    if reference.moving:
        return "The relative equilibrium in the steady motion, nearest to the start:"
    return "The equilibrium nearest to the start:"


def _family(modes: Modes) -> list[Statement]:
    """The conditions of its family, the dependent values, and all motions with the same given values."""
    found, family = list[Statement](), modes.small.reference.family
    if family is None:
        return found
    if family.conditions and max(map(text_size, family.conditions)) <= LONG_CONDITION:
        words = "it rests where" if _at_rest(modes) else "a motion is steady where"
        zeros = [piece for x in family.zeros for piece in (x, " = 0, ")]
        found.append(Prose(("With ", *zeros, words) if zeros else (words.capitalize(),)))
        found += [Formula((condition, 0)) for condition in family.conditions]
    formulas = {x: value for x, value in family.formulas.items() if text_size(value) <= LONG_CONDITION}
    formulas = {x: value for x, value in formulas.items() if depends_on(value, family.held)}
    if formulas:
        found.append(prose("As a function of ", *listed_symbols(family.held), ":"))
        found += [Formula((x, value)) for x, value in formulas.items()]
    if len(family.others) > 1 and modes.small.reference.valued:
        found += _others(modes)
    return found


def _others(modes: Modes) -> list[Statement]:
    """A row for each of the family: values, closed forms, stability."""
    family = modes.small.reference.family
    assert family is not None
    kind = "equilibria" if _at_rest(modes) else "steady motions"
    words = f"All {kind}" if family.complete else f"{kind.capitalize()} that were found"
    where = f" ({family.where})" if family.where else ""
    held = (" with the same ", *listed_symbols((*family.zeros, *family.held))) if family.zeros or family.held else ()
    head: list[Cell] = []
    rows: list[list[Cell]] = [[] for _ in family.others]
    for x in family.following:
        head += [x, "exact"]
        for row, at, closed in zip(rows, family.others, family.closed, strict=True):
            short = x in closed and text_size(closed[x]) <= SHORT
            row += [_digits(at[x]), closed[x] if short else ""]
    table = [(*row, stability) for row, stability in zip(rows, modes.beside, strict=True)]
    return [prose(words, *held, f"{where}:"), narrow_grid((*head, "stability"), table)]


def _at_rest(modes: Modes) -> bool:
    return modes.small.reference.about_equilibrium


def _digits(x: float) -> str:
    return f"{x:.9g}"
