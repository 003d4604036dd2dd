"""What is told machines of small motions -> whether its entries are by their names what they are called.

x' = A x + B_x w,   A = [F E; -M^-1 K, -M^-1 C],   B_x = [0; M^-1 B],   C = D + G, K = S + H
D = D^T, G = -G^T, H = -H^T;   eigenvalues of A;   f = Im lambda, f/2pi, zeta = -Re lambda/|lambda|
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from eomgen.proof.check import Check, checked, first_wrong
from eomgen.symbolic.numeric.tolerances import CARRIED, SAME_PLACE

PARTS = (("damping", "rates", 1), ("gyroscopic", "rates", -1), ("circulatory", "stiffness", -1))


def linear_entries(entries: Mapping[str, Any], A: np.ndarray, B: np.ndarray) -> Iterator[Check]:
    """None where the parameters have no values.

    Args:
        A, B: the state matrix and the input matrix, proven by themselves.
    """
    if entries["state_matrix"] is not None:
        told = _Told(entries, A, B)
        wrong = first_wrong((told.parts(), told.state_form(), told.state_space(), told.eigenvalues(), told.modes()))
        yield checked("what is told machines is what its names say, by the state matrix", wrong, "floating point")


class _Told:
    def __init__(self, entries: Mapping[str, Any], A: np.ndarray, B: np.ndarray) -> None:
        self.entries, self.A, self.B = entries, A, B

    def matrix(self, name: str) -> np.ndarray:
        return np.array(self.entries[name]["value"], dtype=float)

    def parts(self) -> str:
        for name, whole, sign in PARTS:
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
            "state_matrix": (np.array(self.entries["state_matrix"], dtype=float), self.A),
        }
        if not second or not F.any():  # else C q' has a part along the places
            rows["rates"] = -np.linalg.solve(M, C @ E if second else C), self.A[n:, n:]
        for name, (found, due) in rows.items():
            if due.size and (found.shape != due.shape or away(found, due)):
                return f"{name} is not that of the state matrix"
        return ""

    def state_space(self) -> str:
        """y are the coordinates: C_y = [1 0], D_y = 0."""
        told, n = self.entries["state_space"], len(self.entries["coordinates"])
        due = {"A": self.A, "B": self.B, "C_y": np.eye(n, len(self.A)), "D_y": np.zeros((n, self.B.shape[1]))}
        for letter, right in due.items():
            value = told[letter]["value"] if letter in told else None
            if value is not None and right.size and away(np.array(value, dtype=float), right):
                return f"{letter} of the state space is another one"
        return ""

    def eigenvalues(self) -> str:
        found = sorted((complex(*x) for x in self.entries["eigenvalues"]), key=lambda x: (abs(x), x.imag))
        right = sorted(np.linalg.eigvals(self.A), key=lambda x: (abs(x), x.imag))
        size = max(map(abs, right), default=0.0)
        for x in found:  # of a double one without two modes numpy's are apart by the root of rounding
            if np.linalg.svd(self.A - x * np.eye(len(self.A)), compute_uv=False)[-1] > CARRIED * max(size, 1.0):
                return f"{x:.6g} is no eigenvalue of the state matrix"
        return "" if len(found) == len(right) else f"{len(found)} eigenvalues for {len(right)} states"

    def modes(self) -> str:
        for k, mode in enumerate(self.entries["modes"], start=1):
            x, frequency = complex(*mode["eigenvalue"]), mode["frequency"].value
            told = [frequency, mode["hertz"], mode["damping_ratio"]]
            due = [x.imag, x.imag / math.tau, -x.real / abs(x) if x else 0.0] if x.imag else [0.0, 0.0, None]
            for name, a, b in zip(("frequency", "hertz", "damping ratio"), told, due, strict=True):
                if a is not None and b is not None and abs(a - b) > SAME_PLACE * (1 + abs(x)):
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
        told = {"flutter": swings, "divergence": bool(growing) and not swings}
        return first_wrong(f"'{word}' of {growing}" for word, so in told.items() if (word in why) != so)


def away(found: np.ndarray, right: np.ndarray) -> bool:
    """Whether two matrices differ by more than doubles make of it."""
    return bool(abs(found - right).max(initial=0) > CARRIED * (1 + abs(right).max(initial=0)))
