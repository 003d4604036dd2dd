"""Small motions -> StateSpace: x' = A x + B w, y = C_y x + D_y w as arrays, and in sympy where they are exact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, ToolMissing
from eomgen.mechanics.small_motions.state_space import StateMatrices
from eomgen.records import dataclass

LETTERS = ("A", "B", "C_y", "D_y")


@dataclass(frozen=True)
class StateSpace:
    """x' = A x + B w, y = C_y x + D_y w.

    Args:
        states, inputs, outputs: names of x, w and y.
        exact: {"A": A, "B": B, "C_y": C_y, "D_y": D_y} as sympy matrices of the parameters; {} where only numbers are
            known.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    numbers: StateMatrices | None = field(repr=False)
    exact: Mapping[str, Any] = field(repr=False)

    @property
    def A(self) -> np.ndarray:
        return self._array("A", len(self.states))

    @property
    def B(self) -> np.ndarray:
        return self._array("B", len(self.inputs))

    @property
    def C_y(self) -> np.ndarray:
        return self._array("C_y", len(self.states))

    @property
    def D_y(self) -> np.ndarray:
        return self._array("D_y", len(self.inputs))

    def __iter__(self) -> Any:
        """A, B, C_y, D_y: scipy.signal.StateSpace(*small.state_space())."""
        return iter([self.A, self.B, self.C_y, self.D_y])

    def to_scipy(self) -> Any:
        """scipy.signal.lti: bode, step, impulse, poles.

        Raises:
            DerivationError: parameters have no values; there is no input.
        """
        from scipy.signal import lti

        self._refuse_without_inputs()
        return lti(*self)

    def to_control(self) -> Any:
        """control.StateSpace of the package python-control, its states, inputs and outputs by their names.

        Raises:
            DerivationError: parameters have no values; there is no input.
            ToolMissing: the package is not there.
        """
        self._refuse_without_inputs()
        try:
            import control
        except ImportError:
            raise ToolMissing("python-control is not installed", mend="pip install control") from None
        # its names have no dots; a rate's prime stays
        names = {"states": self.states, "inputs": self.inputs, "outputs": self.outputs}
        return control.ss(*self, **{key: [name.replace(".", "_") for name in each] for key, each in names.items()})

    def _refuse_without_inputs(self) -> None:
        if not self.inputs:
            raise DerivationError("a system without inputs has no transfer functions", "inputs", "declare an input")

    def _array(self, letter: str, columns: int) -> np.ndarray:
        """
        Raises:
            DerivationError: parameters have no values.
        """
        if self.numbers is None:
            raise DerivationError(
                "numbers of small motions need values of all parameters",
                "parameters",
                mend="give every parameter a value in [parameters]",
            )
        rows = getattr(self.numbers, letter)
        return np.array(rows, dtype=float).reshape(len(rows), columns)


def state_space_of(exact: StateMatrices | None, numbers: StateMatrices | None) -> StateSpace:
    """What is known of it: one of them at least."""
    found = exact or numbers
    assert found is not None
    return StateSpace(found.states, found.inputs, found.outputs, numbers, {} if exact is None else _in_sympy(exact))


def _in_sympy(found: StateMatrices) -> dict[str, Any]:
    import sympy

    from eomgen.symbolic.print.sympy_form import to_sympy

    columns = {"A": len(found.states), "B": len(found.inputs), "C_y": len(found.states), "D_y": len(found.inputs)}
    return {
        letter: sympy.ImmutableDenseMatrix(
            len(rows := getattr(found, letter)), n, list(to_sympy([x for row in rows for x in row]))
        )
        for letter, n in columns.items()
    }
