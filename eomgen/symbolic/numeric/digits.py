"""Numbers of many digits, all by Arb: real numbers of 50 digits, balls around numbers, linear algebra of both.

A ball holds the true value: its middle, and how far from it that may be. A `LongReal` is the middle of one, with the
digits of the precision in force: what cancels in it to its last digit leaves a rounding error, as it does in doubles.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from decimal import Context, Decimal
from typing import Any

from flint import acb_mat, arb, arb_mat, arf, ctx

from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.work import LARGEST_OF_50_DIGITS

BITS = 169  # those of 50 digits and a few more
SOLVING = 256  # bits: as many more as an elimination takes
SURE = 100  # bits of a value, or of its sum with 1, that must be left
ZERO = arb(0)
LEAST = arb(arf((1, -SURE)))
ROWS = 8  # from which on elimination is handed over
SWEEPS = 40  # of rotations, of which each doubles the digits in the end
ctx.prec = BITS
precision = ctx.workprec  # Arb works with so many bits meanwhile

_Step = tuple[Any, str, tuple[int, ...]]


class LongReal:
    """A real number with the digits of the precision in force, or nan.

    Args:
        ball: it, of no width.
    """

    __slots__ = ("ball",)

    def __init__(self, ball: arb) -> None:
        self.ball = ball

    def __reduce__(self) -> tuple[Any, ...]:
        return (_read_again, () if self.ball.is_nan() else tuple(map(int, self.ball.man_exp())))

    # -- arithmetic --------------------------------------------------------------------------------

    def __neg__(self) -> LongReal:
        return LongReal(-self.ball)

    def __pos__(self) -> LongReal:
        return self

    def __abs__(self) -> LongReal:
        return LongReal(abs(self.ball))

    def __add__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else LongReal((self.ball + other).mid())

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else LongReal((self.ball - other).mid())

    def __rsub__(self, other: Any) -> Any:
        other = _operand(other)
        return other if other is NotImplemented else LongReal((other - self.ball).mid())

    def __mul__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else LongReal((self.ball * other).mid())

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else _quotient(self.ball, other)

    def __rtruediv__(self, other: Any) -> Any:
        other = _operand(other)
        return other if other is NotImplemented else _quotient(other, self.ball)

    def __pow__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        if other is NotImplemented:
            return other
        if self.ball.is_zero() and other < 0:
            raise ZeroDivisionError("a negative power of 0")
        return LongReal((self.ball**other).mid())

    def __rpow__(self, other: Any) -> Any:
        other = _operand(other)
        return other if other is NotImplemented else LongReal(arb(other)) ** self

    # -- comparison --------------------------------------------------------------------------------

    def __eq__(self, other: object) -> Any:
        given = other.ball if type(other) is LongReal else _operand(other)
        return given if given is NotImplemented else self.ball == given

    def __ne__(self, other: object) -> Any:
        equal = self == other
        return equal if equal is NotImplemented else not equal

    def __lt__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else self.ball < other

    def __le__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else self.ball <= other

    def __gt__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else self.ball > other

    def __ge__(self, other: Any) -> Any:
        other = other.ball if type(other) is LongReal else _operand(other)
        return other if other is NotImplemented else self.ball >= other

    def __bool__(self) -> bool:
        return not self.ball.is_zero()

    def __hash__(self) -> int:
        return hash(float(self))

    # -- other forms -------------------------------------------------------------------------------

    def __float__(self) -> float:
        return float(self.ball)

    def __int__(self) -> int:
        man, exp = map(int, self.ball.man_exp())
        return man << exp if exp >= 0 else (man >> -exp if man >= 0 else -(-man >> -exp))

    def __round__(self, *digits: int) -> Any:
        return round(float(self), *digits)

    def __repr__(self) -> str:
        return str(self.ball.str(50, radius=False))

    @property
    def _mpf_(self) -> Any:
        """The number as mpmath and sympy ask for it, of whoever hands one to them."""
        return self.ball._mpf_

    def sqrt(self) -> LongReal:
        """Square root, nan of a negative number; numpy calls it by this name."""
        return LongReal(self.ball.sqrt().mid())

    def decimal(self, digits: int) -> Decimal:
        """The number rounded to so many decimal digits."""
        man, exp = map(int, self.ball.man_exp())
        scale = 1 << abs(exp)
        whole = Context(prec=digits)
        return whole.divide(Decimal(man), Decimal(scale)) if exp < 0 else whole.plus(Decimal(man * scale))


def _read_again(man: int | None = None, exp: int = 0) -> LongReal:
    """A number out of a pickle."""
    return LongReal(arb.nan() if man is None else arb(arf((man, exp))))


def _operand(x: Any) -> Any:
    """Another number as one that Arb calculates with."""
    if isinstance(x, int):
        return int(x)
    if isinstance(x, float):
        return float(x)
    return arb(int(x.numerator)) / int(x.denominator) if hasattr(x, "denominator") else NotImplemented


def _quotient(a: Any, b: Any) -> LongReal:
    if b == 0:
        raise ZeroDivisionError("a division by 0")
    return LongReal((a / b).mid())


def real(x: Any) -> LongReal:
    """A number as a real one of the precision in force: itself, where it is one."""
    return x if type(x) is LongReal else LongReal(ball_of(x).mid())


def ball_of(x: Any, radius: float = 0) -> arb:
    """The ball of a number: as wide as its rounding, where it is no double and none of these, and by a radius more."""
    if type(x) is LongReal:
        ball = x.ball
    else:
        ball = arb(int(x.numerator)) / int(x.denominator) if hasattr(x, "denominator") else arb(x)
    return arb(ball, radius) if radius else ball


# -------- steps of an evaluation ------------------------------------------------------------------------------

OPERATIONS: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "pow": operator.pow,
    "abs": abs,
    "pi": arb.pi,
    "atan2": arb.atan2,
    **{op: getattr(arb, op) for op in "sqrt sin cos tan asin acos atan sinh cosh tanh exp log".split()},
}


def by_balls(given: Sequence[Any], steps: Sequence[_Step], outputs: Sequence[int]) -> list[Any] | None:
    """The values at the places `outputs`, those given first, then one a step; None where they are not sure.

    They are worked with the digits of the numbers, no more: what cancels to the last of them there does so here.

    Args:
        steps: each its operation, and the places of its arguments.
    """
    known = list(map(ball_of, given))
    value = known.__getitem__
    try:
        for _, op, places in steps:
            known.append(OPERATIONS[op](*map(value, places)))
    except KeyError:
        return None
    first, found = len(given), list[Any]()
    for i in outputs:
        ball = known[i]
        if i < first:
            found.append(given[i])
        elif ball.is_finite() and (ball.rel_accuracy_bits() >= SURE or ball.rad() < LEAST):
            found.append(LongReal(ball.mid()))
        else:
            return None
    return found


# -------- functions -------------------------------------------------------------------------------------------

NAN = LongReal(arb.nan())
BEYOND = arb(2) ** LARGEST_OF_50_DIGITS
WHOLE = arb(2) ** BITS  # what is larger has no digit behind its point


def _power(a: arb, b: arb) -> arb:
    """a ^ b; of an exponent with no digit behind its point the power has no sure digit."""
    return arb.nan() if abs(a) != 1 and a != 0 and abs(b) >= WHOLE else a**b


def _of_reals(function: Callable[..., arb]) -> Callable[..., LongReal]:
    """The function of real numbers: nan outside its domain, and of a number beyond all size."""

    def of(*arguments: Any) -> LongReal:
        balls = [real(x).ball for x in arguments]
        if not all(abs(x) < BEYOND for x in balls):
            return NAN
        value = function(*balls)
        return LongReal(value.mid()) if value.is_finite() else NAN

    return of


FUNCTIONS: dict[str, Callable[..., LongReal]] = {
    op: _of_reals(_power if op == "pow" else function)
    for op, function in OPERATIONS.items()
    if op not in ("neg", "add", "sub", "mul", "div", "abs")
}


# -------- linear algebra --------------------------------------------------------------------------------------


def solved_quickly(rows: Sequence[Sequence[Any]]) -> list[Any] | None:
    """x of as many rows [A | b] as unknowns, with 50 digits; None where they are few, or A is nearly singular."""
    n = len(rows)
    if n < ROWS or len(rows[0]) != n + 1:
        return None
    with precision(SOLVING):
        A = arb_mat([[ball_of(x) for x in row[:n]] for row in rows])
        try:
            found = A.solve(arb_mat([[ball_of(row[n])] for row in rows]))
        except ZeroDivisionError:
            return None
    balls = [found[i, 0] for i in range(n)]
    if not all(x.is_finite() and (x.rel_accuracy_bits() >= SURE or x.rad() < LEAST) for x in balls):
        return None
    return [_rounded(x) for x in balls]


def sums_of_products(rows: Sequence[Sequence[Any]], columns: Sequence[Sequence[Any]]) -> list[list[tuple[Any, Any]]]:
    """(row column, |row| |column|) with 50 digits, for each row, in a list for each column."""
    if not rows or not columns:
        return [[] for _ in columns]
    with precision(SOLVING):
        A, B = (arb_mat([[ball_of(x) for x in row] for row in M]) for M in (rows, columns))
        sums = A * B.transpose()
        sizes = _sizes(A) * _sizes(B).transpose()
    return [[(_rounded(sums[i, j]), _rounded(sizes[i, j])) for i in range(len(rows))] for j in range(len(columns))]


def eigenpairs_in_digits(A: Sequence[Sequence[Any]], M: Sequence[Sequence[Any]] | None = None) -> tuple[Any, Any]:
    """(w, V) of A V = V diag(w), V the columns of a matrix, the largest entry of each 1, complex; found with 50 digits.

    Args:
        M: positive definite, A symmetric: A V = M V diag(w), V^T M V = 1, w ascending, with 50 digits.
    """
    if M is not None:
        return _symmetric_eigenpairs(A, M)
    found, vectors = acb_mat([list(map(ball_of, row)) for row in A]).eig(right=True, algorithm="approx")
    columns = zip(*vectors.tolist(), strict=True)
    scaled = [[x / max(column, key=lambda y: LongReal(abs(y).mid())) for x in column] for column in columns]
    return list(map(_complex, found)), [list(map(_complex, row)) for row in zip(*scaled, strict=True)]


def _symmetric_eigenpairs(A: Sequence[Sequence[Any]], M: Sequence[Sequence[Any]]) -> tuple[Any, Any]:
    """The same by Jacobi's rotations of L^-1 A L^-T, M = L L^T, whose eigenvectors times L^-T are those of A and M.

    Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 8.5, 8.7.
    """
    n = range(len(A))
    V = list(map(list, zip(*_inverse_of_root(M), strict=True)))
    A = _product(list(zip(*V, strict=True)), _product([list(map(real, row)) for row in A], V))
    pairs = [(p, q) for p in n for q in n if p < q]
    for _ in range(SWEEPS):
        largest = max((abs(A[i][i]) for i in n), default=0)
        if all(abs(A[p][q]) <= tolerances.MET_AT_50 * largest for p, q in pairs):
            break
        for p, q in pairs:
            if A[p][q]:
                _rotate(A, V, p, q)
    order = sorted(n, key=lambda i: A[i][i])
    return [A[i][i] for i in order], [[V[k][i] for i in order] for k in n]


def _inverse_of_root(M: Sequence[Sequence[Any]]) -> list[list[LongReal]]:
    """L^-1 of M = L L^T, L lower triangular."""
    rows, known = [list(map(real, row)) for row in M], list[list[LongReal]]()
    for i, row in enumerate(rows):
        # of row i of [M | 1] what the rows before it leave, scaled: L^-1 M is L^T, its own diagonal the scale
        own = [real(int(j == i)) for j in range(len(rows))]
        for each in known:
            part = sum((x * y for x, y in zip(each, row, strict=True)), start=real(0))
            own = [x - part * y for x, y in zip(own, each, strict=True)]
        size = sum((x * y for x, y in zip(own, row, strict=True)), start=real(0)).sqrt()
        known.append([x / size for x in own])
    return known


def _product(A: Sequence[Sequence[LongReal]], B: Sequence[Sequence[LongReal]]) -> list[list[LongReal]]:
    columns = list(zip(*B, strict=True))
    return [[sum((x * y for x, y in zip(row, c, strict=True)), start=real(0)) for c in columns] for row in A]


def _rotate(A: list[list[LongReal]], V: list[list[LongReal]], p: int, q: int) -> None:
    """The rotation of the axes p and q by which A_pq is 0, in place."""
    half = (A[q][q] - A[p][p]) / (2 * A[p][q])
    t = (1 if half >= 0 else -1) / (abs(half) + (half * half + 1).sqrt())
    c = 1 / (t * t + 1).sqrt()
    s = t * c
    for row in (*A, *V):
        row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
    A[p], A[q] = (
        [c * x - s * y for x, y in zip(A[p], A[q], strict=True)],
        [s * x + c * y for x, y in zip(A[p], A[q], strict=True)],
    )


def _sizes(A: arb_mat) -> arb_mat:
    return arb_mat([[abs(A[i, j]) for j in range(A.ncols())] for i in range(A.nrows())])


def _rounded(x: arb) -> LongReal:
    """The middle of a ball with the digits in force."""
    return LongReal((x.mid() + 0).mid())


def _complex(x: Any) -> complex:
    return complex(float(x.real), float(x.imag))
