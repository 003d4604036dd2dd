"""Reported small motions -> checks: what is printed is what machines get, and texts have the values of their numbers.

Texts are read as they stand, {"exact": [["c_f + c_r"]], "value": [[0.0]]}, M = [m  0], "mode 2", "oscillates and
fades". The entries for machines are proven by themselves (`linear_entries`), except shapes and transfer functions:

    (A - lambda) (v, u) = 0 with some u,     W = (s 1 - A)^-1 B at a number s
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.model import Model, Unit
from eomgen.proof.check import Check, Tally, attempted, checked, differing, first_wrong
from eomgen.proof.drawn import ColouredPoints, DrawnPanel, said_of
from eomgen.symbolic.expression import LONGEST, Expression, parse
from eomgen.symbolic.numeric import NoValue, tolerances

NAME, HOW = "printed small motions are those that machines get", "texts and numbers read back"
MATRICES = ("mass", "rates", "stiffness", "input", "kinematic_rates", "kinematic_places")
PARTS = ("damping", "gyroscopic", "circulatory")


@dataclass(frozen=True)
class PrintedModes:
    """Printed texts of small motions.

    Args:
        matrices: in numbers, by their letters.
        modes: the cells of the table of modes, without its head: by the words of the head.
        shapes: of each coordinate the cells of its row.
        conditions: in numbers, in their order.
    """

    matrices: Mapping[str, Sequence[Sequence[float]]]
    modes: Sequence[Mapping[str, str]] = ()
    shapes: Mapping[str, Sequence[str]] = ()  # type: ignore[assignment]
    conditions: Sequence[float] = ()


def small_motions_reported(
    entries: Mapping[str, Any], printed: PrintedModes, values: Mapping[str, Any]
) -> Iterator[Check]:
    """Whatever has numbers.

    Args:
        entries: as machines get them.
        values: of the parameters.
    """
    if entries["state_matrix"] is None:
        return
    reported = ReportedMotions(entries, printed, {name: float(x) for name, x in values.items()})
    tally = Tally(NAME, HOW)
    for what, wrong in reported.everything():
        tally.add(what, wrong)
    yield from tally.checks()


@dataclass(frozen=True)
class ReportedMotions:
    """Small motions as machines get them: their matrices by name, in the shapes that they should have."""

    entries: Mapping[str, Any]
    printed: PrintedModes
    values: Mapping[str, float]

    def everything(self) -> Iterator[tuple[str, Callable[[], str]]]:
        for name in (*MATRICES, *PARTS):
            if name in self.entries:
                yield name, lambda name=name: self._texts(self.entries[name])  # type: ignore[misc]
        for name in ("A", "B", "C_y", "D_y"):
            yield name, lambda name=name: self._texts(self.entries["state_space"][name])  # type: ignore[misc]
        for k in range(len(self.entries["modes"])):
            yield f"the shape of mode {k + 1}", lambda k=k: self._shape(self.entries["modes"][k])  # type: ignore[misc]
        yield "matrices as they are printed", self._printed_matrices
        yield "modes as they are printed", self._printed_modes
        yield "conditions as they are printed", self._printed_conditions
        for transfer in self.entries["transfer_functions"]:
            yield f"{transfer['coordinate']}/{transfer['input']}", lambda t=transfer: self._transfer(t)  # type: ignore[misc]

    def matrix(self, name: str) -> np.ndarray:
        """Matrix of this name in numbers."""
        return self.shaped(name, np.array(self.entries[name]["value"], dtype=float))

    def shaped(self, name: str, found: np.ndarray) -> np.ndarray:
        shape = {"input": (self.n, len(self.entries["inputs"])), "kinematic_rates": (self.m, self.n)}.get(name)
        return found.reshape(shape) if shape is not None and not found.size else found

    @property
    def n(self) -> int:
        return len(self.entries["speeds"])

    @property
    def m(self) -> int:
        return len(self.entries["coordinates"])

    def _texts(self, entry: Mapping[str, Any]) -> str:
        """Checks that each exact text has the value of its number."""
        if entry["exact"] is None or entry["value"] is None:
            return ""
        numbers = np.array(entry["value"], dtype=float)
        size = float(np.max(np.abs(numbers), initial=0.0))
        for row, right in zip(entry["exact"], entry["value"], strict=True):
            for text, number in zip(row, right, strict=True):
                found = self._value(text, self.values)
                if abs(found - number) > tolerances.COMPUTED * (size + abs(found)):
                    return f"{text[:60]}: {differing(found, number) or found}"
        return ""

    def _value(self, text: str, values: Mapping[str, float]) -> float:
        """A text of the grammar in numbers.

        Raises:
            NoValue: it contains a symbol without a value.
        """
        if len(text) > 10 * LONGEST:
            raise NoValue("too long to be read back")
        try:
            expression = parse(text, longest=len(text))
        except ExpressionError as error:
            raise NoValue(error.what) from error
        if expression.calls or not expression.names <= values.keys() | {"pi"}:
            raise NoValue(f"'{text[:60]}' is not of parameters alone")
        return float(expression.evaluate({**values, "pi": math.pi}))

    # -- modes ---------------------------------------------------------------------------------------------

    @cached_property
    def A(self) -> np.ndarray:
        """State matrix as it is reported, in the order of coordinates and speeds; it is proven by itself."""
        return in_order(self.entries, np.array(self.entries["state_matrix"], dtype=float))

    def _shape(self, mode: Mapping[str, Any]) -> str:
        """(A - lambda) (v, u) = 0 with some u."""
        x, shape, names = complex(*mode["eigenvalue"]), mode["shape"], self.entries["coordinates"]
        if not x or not all(name in shape for name in names):
            return ""
        v = np.array([complex(*shape[name]) for name in names])
        if not np.any(v):
            return ""
        pencil = self.A - x * np.eye(len(self.A))
        pencil = pencil / (abs(pencil).max(axis=1) + tolerances.SLOW * abs(x))[:, None]
        u = np.linalg.lstsq(pencil[:, self.m :], -pencil[:, : self.m] @ v, rcond=None)[0]
        whole = np.concatenate([v, u])
        left, size = abs(pencil @ whole), abs(pencil) @ abs(whole)
        return (
            "its shape is no motion of that eigenvalue"
            if np.any(left > tolerances.CARRIED * (size + abs(whole).max()))
            else ""
        )

    # -- as they are printed ---------------------------------------------------------------------------------

    def _printed_matrices(self) -> str:
        letters = dict(zip("MCKEFDGH", (*MATRICES[:3], *MATRICES[4:], *PARTS), strict=True))
        space = self.entries["state_space"]
        for letter, rows in self.printed.matrices.items():
            if letter == "B_z":
                rights = [self.matrix("state_input")]
            elif letter == "B":
                rights = [self.matrix("input"), np.array(space["B"]["value"], dtype=float)]
            elif letter in letters and letters[letter] in self.entries:
                rights = [self.matrix(letters[letter])]
            elif letter in ("A", "C_y", "D_y"):
                rights = [np.array(space[letter]["value"], dtype=float)]
            else:
                continue
            found = np.array(rows, dtype=float)
            if all(found.shape != right.shape or _differ(found, right, tolerances.SEVEN_DIGITS) for right in rights):
                return f"{letter} is another for machines"
        return ""

    def _printed_modes(self) -> str:
        modes = self.entries["modes"]
        if not self.printed.modes:
            return ""
        if len(self.printed.modes) != len(modes):
            return f"{len(self.printed.modes)} rows for {len(modes)} modes"
        for k, (row, mode) in enumerate(zip(self.printed.modes, modes, strict=True)):
            frequency = getattr(mode["frequency"], "value", mode["frequency"])
            wanted = {
                "omega [rad/s]": frequency,
                "f [Hz]": mode["hertz"],
                "damping ratio": mode["damping_ratio"],
            }
            for head, right in wanted.items():
                text = row.get(head, "")
                if (text == "") != (right is None) or (
                    text and differing(float(text), right or 0.0, tolerances.SEVEN_DIGITS)
                ):
                    return f"mode {k + 1}, {head}: {text} for {right}"
            if row.get("", "") != mode["kind"] or row.get("mode") != str(k + 1):
                return f"mode {k + 1}: '{row.get('', '')}' for '{mode['kind']}'"
            if not _is_complex(row.get("eigenvalue [1/s]", ""), complex(*mode["eigenvalue"])):
                return f"mode {k + 1}: {row.get('eigenvalue [1/s]')} for {complex(*mode['eigenvalue']):.7g}"
        for name, cells in self.printed.shapes.items():
            for k, cell in enumerate(cells):
                if not _is_complex(cell, complex(*modes[k]["shape"][name]), 2 * tolerances.SEVEN_DIGITS):
                    return f"mode {k + 1}, {name}: {cell} for {complex(*modes[k]['shape'][name]):.7g}"
        return ""

    def _printed_conditions(self) -> str:
        reported = self.entries["conditions"]
        if len(reported) != len(self.printed.conditions):
            return f"{len(self.printed.conditions)} are printed of {len(reported)}" if self.printed.conditions else ""
        for text, number in zip(reported, self.printed.conditions, strict=True):
            if not math.isnan(number) and (
                wrong := differing(number, self._value(text, self.values), tolerances.SEVEN_DIGITS)
            ):
                return wrong
        return ""

    def _transfer(self, reported: Mapping[str, Any]) -> str:
        """(s 1 - A)^-1 B at a number s."""
        i, j = (
            self.entries["coordinates"].index(reported["coordinate"]),
            self.entries["inputs"].index(reported["input"]),
        )
        B = in_order(self.entries, np.array(self.entries["input_matrix"]).astype(complex), columns=False)
        sizes = abs(np.linalg.eigvals(self.A))
        rate = float(np.mean(sizes[sizes > 0])) if np.any(sizes > 0) else 1.0
        for s in (rate * (0.7 + 0.9j), rate * (-0.4 + 2.3j)):
            answers = np.linalg.solve(s * np.eye(len(self.A)) - self.A, B)[:, j]
            above, below = (
                sum(self._value(text, self.values) * s**k for k, text in enumerate(reported[part]))
                for part in ("numerator", "denominator")
            )
            if abs(above / below - answers[i]) > tolerances.SAME_PLACE * abs(answers).max():
                return f"{above / below:.6g} for {answers[i]:.6g} at s = {s:.4g}"
        return ""


def in_order(entries: Mapping[str, Any], A: np.ndarray, *, columns: bool = True) -> np.ndarray:
    """Rows, and columns, of a matrix over x = (q, u, z) in the order of coordinates and states, then speeds."""
    states = list(entries["state_space"]["states"])
    places = [states.index(name) for name in (*entries["coordinates"], *entries["speeds"])]
    return np.asarray(A[np.ix_(places, places)] if columns else A[places])


def _differ(a: np.ndarray, b: np.ndarray, share: float = tolerances.COMPUTED) -> bool:
    """Entries are compared on the scale of the largest of their rows and columns."""
    if a.size == b.size == 0:
        return False
    if a.shape != b.shape:
        return True
    size = np.maximum(abs(a), abs(b))
    usual = np.minimum.outer(size.max(axis=1), size.max(axis=0))
    return bool(np.any(abs(a - b) > share * (size + usual) + tolerances.SOLVED * size.max()))


def _is_complex(text: str, right: complex, share: float = tolerances.SEVEN_DIGITS) -> bool:
    """True if a text like 1.2 +- 3.4i is that number, or its conjugate."""
    pieces = text.replace("+-", "+").replace("+ ", "+").replace("- ", "-").replace("i", "j").replace(" ", "")
    try:
        found = complex(pieces)
    except ValueError:
        return False
    return abs(found - right) <= share * (1 + abs(right))


# -------- small motions drawn ---------------------------------------------------------------------------------
# Drawn small motions -> checks: curves, roots and bars are those of the matrices that machines get.
#
# Curves are read from their picture; W and the roots s follow from the reported M, C and K, not from A:
#
#     [s 1 - F, -E; K, s M + C] (q, u) = (0, B w),    det = 0,    sum s = tr A,    sum s^2 = tr A^2


DRAWN, BY_PENCIL = "drawn small motions are those of the equations", "by M, C, K and B at what is drawn"
MOST_CURVES, MOST_MODES = 8, 9  # pairs of which Bode's diagrams are drawn, modes that are drawn
MOST_VALUES = 60  # of a parameter at which its roots are looked at


def small_motions_drawn(
    drawn: str, entries: Mapping[str, Any], panels: Sequence[DrawnPanel], letters: Mapping[str, str], model: Model
) -> Check:
    """Check of a picture of small motions.

    "modes": the headings above each mode, and the bars of those that are not animated; "bode": |W| and the phase of W
    at every frequency that is drawn; "locus": the roots over a parameter, each drawn at the value of its colour, and no
    others.

    Args:
        letters: how the names of coordinates, inputs and parameters are set.
    """
    if drawn == "modes":
        return attempted(DRAWN, "modes as machines get them", lambda: _wrong_modes(entries["modes"], panels))
    pencil = _Drawn(ReportedMotions(entries, PrintedModes({}), {}), letters)
    wrong = partial(pencil.wrong_roots, panels, model) if drawn == "locus" else partial(pencil.wrong_responses, panels)
    return attempted(DRAWN, BY_PENCIL, wrong)


def _wrong_modes(modes: Sequence[Mapping[str, Any]], panels: Sequence[DrawnPanel]) -> str:
    if len(panels) != min(len(modes), MOST_MODES):
        return f"{len(panels)} of {len(modes)} modes"
    for k, (mode, panel) in enumerate(zip(modes, panels, strict=False), start=1):
        frequency = getattr(mode["frequency"], "value", mode["frequency"])
        said = f"{k}: " if frequency is not None else f"{k}: {mode['kind']}, "
        number, _, unit = panel.title.removeprefix(said).partition(" ")
        right = mode["eigenvalue"][0] if frequency is None else frequency
        known = panel.title.startswith(said) and unit == ("1/s" if frequency is None else "rad/s")
        if not known or abs(float(number) - right) > tolerances.FOUR_DIGITS * abs(right):
            return f"'{panel.title}' stands above mode {k}, {right:.6g} {unit}"
        heights = [height for _, height in panel.bars]
        if heights and not np.allclose(
            heights, [x for x, _ in mode["shape"].values()], rtol=0, atol=tolerances.COMPUTED
        ):
            return f"the bars of mode {k} are not its shape"
    return ""


@dataclass(frozen=True)
class Pencil:
    """s P - Q, of the states (q, u): P = [1 0; 0 M], Q = [F E; -K -C]."""

    P: np.ndarray
    Q: np.ndarray

    def at(self, s: complex) -> np.ndarray:
        found: np.ndarray = s * self.P - self.Q
        return found

    @property
    def A(self) -> np.ndarray:
        """Matrix A of x' = A x."""
        return np.linalg.solve(self.P, self.Q)

    def answers(self, omega: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(x of (i w P - Q) x = right at each frequency, its rounding error: the difference from the solution by A)."""
        A, forced = self.A, np.linalg.solve(self.P, right)
        found = np.array([np.linalg.solve(self.at(1j * w), right) for w in omega])
        by_A = np.array([np.linalg.solve(1j * w * np.eye(len(A)) - A, forced) for w in omega])
        return found, np.abs(found - by_A)


@dataclass(frozen=True)
class _Drawn:
    reported: ReportedMotions
    letters: Mapping[str, str]

    def pencil(self, matrix: Callable[[str], np.ndarray]) -> Pencil:
        """Pencil s P - Q of matrices by their names."""
        M, C, K, E, F = map(matrix, ("mass", "rates", "stiffness", "kinematic_rates", "kinematic_places"))
        if self.reported.entries["second_order"]:
            if F.any():
                raise NoValue("rates have parts along the places")
            C = C @ E
        n, m = len(M), len(F)
        zero = np.zeros((m, n))
        return Pencil(np.block([[np.eye(m), zero], [zero.T, M]]), np.block([[F, E], [-K, -C]]))

    # -- Bode's diagrams -----------------------------------------------------------------------------------

    def wrong_responses(self, panels: Sequence[DrawnPanel]) -> str:
        entries = self.reported.entries
        sizes, phases = panels
        if (sizes.scales, phases.scales) != (("log", "log"), ("log", "linear")) or sizes.hidden or phases.hidden:
            return "the axes are not those of the curves"
        names = {
            f"${self.letters[q]}/{self.letters[w]}$": (j, k)
            for j, q in enumerate(entries["coordinates"])
            for k, w in enumerate(entries["inputs"])
        }
        omega = sizes.curves[0].places[:, 0] if sizes.curves else np.ones(1)
        pencil, B = self.pencil(self.reported.matrix), self.reported.matrix("input")
        of_states = self.reported.matrix("state_input") if "state_input" in entries else None
        right = np.concatenate([np.zeros((self.reported.m, B.shape[1])) if of_states is None else of_states, B])
        answers, rounding = pencil.answers(omega, right)
        of_colour = {curve.color: curve.places for curve in phases.curves}
        for curve in sizes.curves:
            if curve.label not in names:
                return f"no quantity is known as {curve.label}"
            j, k = names.pop(curve.label)
            turned = of_colour.get(curve.color, np.zeros((0, 2)))
            if not np.array_equal(curve.places[:, 0], omega) or not np.array_equal(turned[:, 0], omega):
                return f"{curve.label} is drawn at other frequencies than its phase"
            W, size = answers[:, j, k], np.abs(answers[:, :, k]).max(axis=1)
            near = tolerances.CARRIED * np.abs(W) + tolerances.ITERATED * size + 10 * rounding[:, j, k]
            for what, found in (
                ("|W|", curve.places[:, 1] * np.exp(1j * np.angle(W))),
                ("phase", np.abs(W) * np.exp(1j * np.radians(turned[:, 1]))),
            ):
                if np.any(off := np.abs(found - W) > near):
                    i = int(np.argmax(off))
                    return f"{what} of {curve.label} at {omega[i]:.4g} rad/s: {found[i]:.6g} for {W[i]:.6g}"
        left = [label for label, (j, k) in names.items() if np.abs(answers[:, j, k]).max() > tolerances.CARRIED]
        if left and len(sizes.curves) < MOST_CURVES:
            return f"{left[0]} is not drawn"
        rates = np.abs([complex(*x) for x in entries["eigenvalues"]])
        moving = rates[rates > tolerances.ITERATED * rates.max(initial=0.0)]
        outside = moving[(moving < omega[0]) | (moving > omega[-1])]
        return f"the mode of {outside[0]:.4g} 1/s is not within the frequencies" if len(outside) else ""

    # -- roots over a parameter ----------------------------------------------------------------------------

    def wrong_roots(self, panels: Sequence[DrawnPanel], model: Model) -> str:
        (panel,) = panels
        (points,) = panel.points
        what, unit = said_of(points.label)
        name = next((x for x in model.parameters if what == f"${self.letters[x]}$"), None)
        if name is None or panel.scales != ("linear", "linear") or panel.hidden:
            return f"no quantity is known as {what}" if name is None else "the axes are not those of the points"
        begun = {complex(*x) for curve in panel.curves for x in curve.places}
        values = list(dict.fromkeys(points.values.tolist()))
        for value in values[:: 1 + (len(values) - 1) // MOST_VALUES]:
            known = model.exact_parameters({name: value * (Unit.parse(unit).size if unit else 1.0)})
            roots = _roots(points, value)
            found = self.pencil(lambda x, known=known: self._exact(x, known))  # type: ignore[misc]
            if wrong := _no_roots(found, roots):
                return f"at {name} = {value:.6g} {unit}: {wrong}"
            if value == values[0] and set(roots) != begun:
                return f"the crosses are not at {name} = {value:.6g} {unit}"
        return ""

    def _exact(self, name: str, known: Mapping[str, Any]) -> np.ndarray:
        """A matrix at other values of the parameters."""
        values = {x: float(value) for x, value in known.items()} | {"pi": math.pi}
        rows = [[float(x.evaluate(values)) for x in row] for row in self._read(name)]
        return self.reported.shaped(name, np.array(rows, dtype=float))

    def _read(self, name: str) -> list[list[Expression]]:
        if name not in self._expressions:
            exact = self.reported.entries[name]["exact"]
            texts = [text for row in exact for text in row]
            if sum(map(len, texts)) > 10 * LONGEST:
                raise NoValue("too long to be read back")
            self._expressions[name] = [[parse(text, longest=len(text)) for text in row] for row in exact]
        return self._expressions[name]

    @cached_property
    def _expressions(self) -> dict[str, list[list[Expression]]]:
        return {}


def _roots(points: ColouredPoints, value: float) -> list[complex]:
    return [complex(*x) for x in points.places[points.values == value] if np.isfinite(x).all()]


def _no_roots(pencil: Pencil, roots: Sequence[complex]) -> str:
    """Message if these are not all the roots of det(s P - Q), with their multiplicities; ""."""
    A = pencil.A
    if not np.isfinite(A).all():
        return ""
    if len(roots) != len(A):
        return f"{len(roots)} roots for {len(A)}"
    size = max(map(abs, roots), default=0.0) or 1.0
    for s in roots:
        rows = A - s * np.eye(len(A))
        if np.linalg.svd(rows, compute_uv=False)[-1] > tolerances.CARRIED * max(size, 1.0):
            return f"{s:.6g} is no root"
    found, sums = np.array(roots), (np.trace(A), np.sum(A * A.T))
    if any(
        abs(np.sum(found**k) - right) > tolerances.CARRIED * len(A) * size**k for k, right in enumerate(sums, start=1)
    ):
        return "a root is drawn in place of another"
    return ""


# -------- linear entries --------------------------------------------------------------------------------------
# Entries for machines of small motions -> checks that they have the meaning of their names.
#
# x' = A x + B_x w,   A = [F E; -M^-1 K, -M^-1 C],   B_x = [0; M^-1 B],   C = D + G, K = S + H D = D^T, G = -G^T, H =
# -H^T;   eigenvalues of A;   f = Im lambda, f/2pi, zeta = -Re lambda/|lambda|


ENTRY_PARTS = (("damping", "rates", 1), ("gyroscopic", "rates", -1), ("circulatory", "stiffness", -1))


def linear_entries(entries: Mapping[str, Any], A: np.ndarray, B: np.ndarray) -> Iterator[Check]:
    """None where the parameters have no values.

    Args:
        A, B: the state matrix and the input matrix, proven by themselves.
    """
    if entries["state_matrix"] is not None:
        reported = _Reported(entries, A, B)
        wrong = first_wrong(
            (reported.parts(), reported.state_form(), reported.state_space(), reported.eigenvalues(), reported.modes())
        )
        yield checked("numbers for machines are those of their names, by the state matrix", wrong, "floating point")


class _Reported:
    def __init__(self, entries: Mapping[str, Any], A: np.ndarray, B: np.ndarray) -> None:
        self.entries, self.A, self.B = entries, A, B

    def matrix(self, name: str) -> np.ndarray:
        return np.array(self.entries[name]["value"], dtype=float)

    def parts(self) -> str:
        for name, whole, sign in ENTRY_PARTS:
            if name in self.entries:
                C = self.matrix(whole)
                if away(self.matrix(name), (C + sign * C.T) / 2):
                    return f"{name} is not its part of {whole}"
        return ""

    def state_form(self) -> str:
        """The rows of A and B_x by the matrices as they are named."""
        M, C, K, E, F = map(self.matrix, ("mass", "rates", "stiffness", "kinematic_rates", "kinematic_places"))
        n, second = K.shape[1], self.entries["second_order"]
        rows = {
            "kinematic_places": (F, self.A[:n, :n]),
            "kinematic_rates": (E, self.A[:n, n:]),
            "stiffness": (-np.linalg.solve(M, K), self.A[n:, :n]),
            "input": (np.linalg.solve(M, self.matrix("input")), self.B[n:]),
            "state_matrix": (in_order(self.entries, np.array(self.entries["state_matrix"], dtype=float)), self.A),
        }
        if "state_input" in self.entries:
            rows["state_input"] = self.matrix("state_input"), self.B[:n]
        if not second or not F.any():  # else C q' has a part along the places
            rows["rates"] = -np.linalg.solve(M, C @ E if second else C), self.A[n:, n:]
        for name, (found, due) in rows.items():
            if due.size and (found.shape != due.shape or away(found, due)):
                return f"{name} is not that of the state matrix"
        return ""

    def state_space(self) -> str:
        """y are the coordinates: C_y = [1 0], D_y = 0."""
        reported, n = self.entries["state_space"], len(self.entries["coordinates"])
        places = [reported["states"].index(x) for x in (*self.entries["coordinates"], *self.entries["speeds"])]
        back = np.argsort(places)
        due = {"A": self.A[np.ix_(back, back)], "B": self.B[back], "C_y": np.eye(n, len(self.A))[:, back]}
        due["D_y"] = np.zeros((n, self.B.shape[1]))
        for letter, right in due.items():
            value = reported[letter]["value"] if letter in reported else None
            if value is not None and right.size and away(np.array(value, dtype=float), right):
                return f"{letter} of the state space is another one"
        return ""

    def eigenvalues(self) -> str:
        found = sorted((complex(*x) for x in self.entries["eigenvalues"]), key=lambda x: (abs(x), x.imag))
        right = sorted(np.linalg.eigvals(self.A), key=lambda x: (abs(x), x.imag))
        size = max(map(abs, right), default=0.0)
        for x in found:  # of a double one without two modes numpy's are apart by the root of rounding
            if np.linalg.svd(self.A - x * np.eye(len(self.A)), compute_uv=False)[-1] > tolerances.CARRIED * max(
                size, 1.0
            ):
                return f"{x:.6g} is no eigenvalue of the state matrix"
        return "" if len(found) == len(right) else f"{len(found)} eigenvalues for {len(right)} states"

    def modes(self) -> str:
        for k, mode in enumerate(self.entries["modes"], start=1):
            x, frequency = complex(*mode["eigenvalue"]), mode["frequency"].value
            reported = [frequency, mode["hertz"], mode["damping_ratio"]]
            due = [x.imag, x.imag / math.tau, -x.real / abs(x) if x else 0.0] if x.imag else [0.0, 0.0, None]
            for name, a, b in zip(("frequency", "hertz", "damping ratio"), reported, due, strict=True):
                if a is not None and b is not None and abs(a - b) > tolerances.SAME_PLACE * (1 + abs(x)):
                    return f"the {name} of mode {k} is {a:.10g} for {b:.10g}"
                if x.imag and a is None:
                    return f"mode {k} oscillates, and has no {name}"
            words = {"grows": x.real > 0, "fades": x.real < 0, "oscillates": x.imag != 0}
            if wrong := [word for word, so in words.items() if (word in mode["kind"]) != so]:
                return f"mode {k}, of {x:.6g}, is said to be one that '{mode['kind']}': {wrong[0]}"
        return self._stability()

    def _stability(self) -> str:
        values = [complex(*x) for x in self.entries["eigenvalues"]]
        growing, said, why = [x for x in values if x.real > 0], self.entries["stability"], self.entries["why"]
        if growing and said != "unstable":
            return f"a motion grows, and is said to be {said}"
        if said == "asymptotically stable" and not all(x.real < 0 for x in values):
            return "not all motions fade"
        swings = any(x.imag for x in growing)
        reported = {"flutter": swings, "divergence": bool(growing) and not swings}
        return first_wrong(f"'{word}' of {growing}" for word, so in reported.items() if (word in why) != so)


def away(found: np.ndarray, right: np.ndarray) -> bool:
    """True if two matrices differ by more than rounding in doubles."""
    return bool(abs(found - right).max(initial=0) > tolerances.CARRIED * (1 + abs(right).max(initial=0)))
