"""Model -> Linearization: its small motions as a document, as data and drawn.

Model -> Linearization: its small motions as a user gets them: step by step, for machines, drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import (
    Document,
    Picture,
    Quantity,
    Result,
    assumption_steps,
    data_step,
    document_of,
    mathtext,
    notation_of,
)
from eomgen.errors import DerivationError, ToolMissing, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.linearization import (
    Frequency,
    LinearEquations,
    Modes,
    SmallMotions,
    Spectrum,
    StateMatrices,
)
from eomgen.mechanics.state import Entries
from eomgen.model import Model, ModelOrPath, Range, Values
from eomgen.proof import Certificate, Check, DrawnPanel, certify_small_motions, small_motions_drawn
from eomgen.resources import doing
from eomgen.results.small_motions.steps import linearization_steps, printed_modes
from eomgen.study import model_to_study, study_at_rest, study_of
from eomgen.symbolic.exact import Polynomial
from eomgen.symbolic.expression import Call, Expression, Fraction, Scalar
from eomgen.symbolic.numeric import numbers_of
from eomgen.symbolic.print import to_text

METHOD = "linearization"


@dataclass(frozen=True)
class Linearization(Result):
    """Small motions about an equilibrium or a steady motion.

    Args:
        model: the system.
        modes: the results of its linearized equations.
        drawn: the content of its picture: "modes", "bode", or "locus", the roots `over` a parameter.
        assumptions: those made about contacts.
    """

    model: Model
    modes: Modes
    drawn: str = "modes"
    over: Range | None = None
    assumptions: tuple[str, ...] = ()

    def __repr__(self) -> str:
        about = self.small.reference.about
        return f"<small motions of {self.model.name!r} about its {about}: {', '.join(self.coordinates)}>"

    @property
    def small(self) -> SmallMotions:
        """The equations."""
        return self.modes.small

    @property
    def equations(self) -> LinearEquations:
        """M, C, K, B, F, E: exact where they are known so, else floats."""
        return self.small.equations

    @property
    def is_exact(self) -> bool:
        return self.small.exact is not None

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(q.name for q in self.equations.coordinates)

    @property
    def speeds(self) -> tuple[str, ...]:
        return tuple(u.name for u in self.equations.speeds)

    @property
    def inputs(self) -> tuple[str, ...]:
        return tuple(w.name for w in self.equations.inputs)

    M = cached_property(lambda self: self._numbers("M"))
    C = cached_property(lambda self: self._numbers("C"))
    K = cached_property(lambda self: self._numbers("K"))
    D = cached_property(lambda self: (self.C + self.C.T) / 2)
    G = cached_property(lambda self: (self.C - self.C.T) / 2)

    @cached_property
    def exact(self) -> dict[str, Any]:
        """{"M": M, "C": C, "K": K, "B": B} as sympy matrices of the parameters; {} where only numbers are known."""
        import sympy

        from eomgen.symbolic.print import to_sympy

        letters = "MCKB" if self.is_exact else ""
        return {letter: sympy.Matrix([to_sympy(row) for row in getattr(self.equations, letter)]) for letter in letters}

    @property
    def A(self) -> np.ndarray:
        """The state matrix, x = (coordinates, speeds, states of first order)."""
        self._refuse_unvalued()
        order = self.equations.order
        return self.small.state_matrix[np.ix_(order, order)]

    @property
    def B(self) -> np.ndarray:
        """The input matrix of x' = A x + B w."""
        self._refuse_unvalued()
        return self.small.input_matrix[list(self.equations.order)]

    def state_space(self, outputs: Sequence[str] = ()) -> StateSpace:
        """x' = A x + B w, y = C_y x + D_y w, x = (coordinates, speeds, states of first order).

        Args:
            outputs: y: names of coordinates, of speeds, or of their rates (theta''); (): the coordinates.
        Raises:
            UsageError: another name.
            DerivationError: they are known in numbers only, and parameters have no values.
        """
        wanted = tuple((outputs,) if isinstance(outputs, str) else outputs) or self.coordinates
        exact, numbers = self.modes.state_spaces(wanted)
        if exact is None:
            self._refuse_unvalued()
        return state_space_of(exact, numbers)

    @property
    def spectrum(self) -> Spectrum:
        """Modes, eigenvalues, stability."""
        self._refuse_unvalued()
        return self.modes.spectrum

    @property
    def frequencies(self) -> tuple[Frequency, ...]:
        """Frequencies of the motions that oscillate, the lowest first."""
        return self.modes.frequencies

    def _numbers(self, letter: str) -> np.ndarray:
        self._refuse_unvalued()
        return np.array(getattr(self.small.numbers, letter), dtype=float)

    @property
    def valued(self) -> bool:
        return self.small.reference.valued

    def _refuse_unvalued(self) -> None:
        """Numbers need values.

        Raises:
            DerivationError: parameters have none.
        """
        if not self.valued:
            raise DerivationError(
                "numbers of small motions need values of all parameters",
                "parameters",
                fix="give every parameter a value in [parameters]",
            )

    def certify(self) -> Certificate:
        """Check the equations of motion, and the small motions against differences of these."""
        return certify_small_motions(self.modes, self.entries(), printed_modes(self.derivation))

    def drawn_checks(self, panels: Sequence[DrawnPanel]) -> Iterable[Check]:
        """Bode's diagrams and roots over a parameter, by M, C, K and B as machines get them; the modes by these."""
        if panels:
            notation, names = notation_of(self.model), (*self.coordinates, *self.inputs, *self.model.parameters)
            drawn = "locus" if self.over is not None else self.drawn
            letters = {x: mathtext(x, notation) for x in names}
            yield small_motions_drawn(drawn, self.entries(), panels, letters, self.model)

    # -- as outputs ask ------------------------------------------------------------------------------------

    def value(self, call: Call) -> tuple[Scalar, bool]:
        """(one of the functions mass, damping, stiffness, frequency, whether it is exact).

        Raises:
            DerivationError: no such coordinate or frequency; without values of all parameters there is no number.
        """
        if call.name == "frequency":
            return self._frequency(call)
        found, exact = self.modes.entry(call.name, *call.names)
        return found if exact else self._rounded(found), exact

    def frequency(self, call: Call) -> Frequency:
        """The frequency to which a call frequency(k) refers.

        Raises:
            DerivationError: there are not so many.
        """
        return self.modes.frequency(self.number_of(call))

    def number_of(self, call: Call) -> int:
        """k of frequency(k).

        Raises:
            DerivationError: it is no whole number.
        """
        (number,) = call.args
        k = number.literal if isinstance(number, Expression) else None
        if k is None or k != int(k):
            raise DerivationError(f"'{call}': frequencies are numbered 1, 2, ...", fix="frequency(1) is the lowest")
        return int(k)

    def _frequency(self, call: Call) -> tuple[Scalar, bool]:
        found = self.frequency(call)
        if found.exact is not None:
            return found.exact, True
        assert found.mode.frequency is not None
        return self._rounded(found.mode.frequency), False

    def _rounded(self, x: float) -> Fraction:
        self._refuse_unvalued()
        return Fraction(x)

    # -- as it is shown --------------------------------------------------------------------------------------

    @cached_property
    def derivation(self) -> Document:
        """The way, step by step."""
        model = self.model
        given = (*assumption_steps(self.assumptions), data_step(self.small.reference.system))
        steps = (*given, *linearization_steps(self.modes))
        return replace(document_of(model, METHOD, steps), notes=self._notes)

    @property
    def _notes(self) -> tuple[str, ...]:
        """Note that it is not about the start, which was requested; () otherwise."""
        reference = self.small.reference
        if reference.beside is None:
            return ()
        away = [(x.name, float(reference.numbers[x]), value) for x, value in reference.beside.items()]
        reported = ", ".join(f"{name} = {x:.6g} for {value:.6g} at the start" for name, x, value in away if x != value)
        return (f"The start is accelerated: linearized about the equilibrium or steady motion near it, {reported}.",)

    @property
    def picture(self) -> Picture:
        """The modes, drawn over the reference; Bode's diagrams; or the roots over a parameter.

        Raises:
            RunFailed: parameters have no values; there are no inputs; the equations are only known in numbers.
        """
        from eomgen.results.small_motions.pictures import bode_picture, locus_picture, modes_picture

        if self.over is not None:
            return locus_picture(self.small, self.over)
        return bode_picture(self.small) if self.drawn == "bode" else modes_picture(self.modes)

    def bode(self) -> Picture:
        """Size and phase of the transfer functions over the frequency.

        Raises:
            RunFailed: parameters have no values, or there are no inputs.
        """
        return replace(self, drawn="bode", over=None).picture

    def locus(self, over: str) -> Picture:
        """The eigenvalues over a parameter: "k=100:1000:50", "log:k=1:100:50", in SI, or with a unit.

        Raises:
            UsageError: no such parameter, no range.
            RunFailed: parameters have no values; the equations are only known at those.
        """
        return replace(self, drawn="locus", over=Range.of(self.model, over, declared=False)).picture

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        return self._entries

    @cached_property
    def _entries(self) -> dict[str, Any]:
        reference, equations = self.small.reference, self.equations
        parts = self.modes.symmetric_parts if self.small.is_second_order else {}
        return {
            "name": self.model.name,
            "about": reference.about,
            "assumptions": list(self.assumptions),
            "state": {
                x.name: _state(reference.exact.get(x), float(reference.numbers[x]), valued=self.valued)
                for x in reference.system.symbols.x
            },
            "beside_start": None
            if reference.beside is None or not self.valued
            else {
                x.name: {"start": value, "away": float(reference.numbers[x]) - value}
                for x, value in reference.beside.items()
            },
            "family": self._family(),
            "coordinates": list(self.coordinates),
            "speeds": list(self.speeds),
            "states": [z.name for z in self.equations.states],
            "inputs": list(self.inputs),
            "left_out": [q.name for q in self.small.left_out],
            "second_order": self.small.is_second_order,
            "exact": self.is_exact,
            **{
                name: self._matrix(getattr(equations, letter))
                for name, letter in (
                    ("mass", "M"),
                    ("rates", "C"),
                    ("stiffness", "K"),
                    ("input", "B"),
                    ("kinematic_rates", "E"),
                    ("kinematic_places", "F"),
                )
            },
            **{
                name: self._matrix(parts[letter])
                for name, letter in (("damping", "D"), ("gyroscopic", "G"), ("circulatory", "H"))
                if parts
            },
            **({"state_input": self._matrix(equations.D)} if equations.states else {}),
            "state_space": self._state_space_entry(),
            "state_matrix": self.A.tolist() if self.valued else None,
            "input_matrix": self.B.tolist() if self.valued else None,
            "characteristic_polynomial": _polynomial(self.modes.polynomial),
            "conditions": [to_text(x) for x in self.modes.conditions.expressions],
            "conditions_for": self.modes.conditions.words or None,
            "transfer_functions": [
                {
                    "coordinate": f.coordinate.name,
                    "input": f.input.name,
                    "numerator": _polynomial(f.above),
                    "denominator": _polynomial(f.below),
                }
                for f in self.modes.transfers
            ],
            "eigenvalues": [[x.real, x.imag] for x in self.spectrum.eigenvalues] if self.valued else None,
            "modes": [self._mode(k) for k in range(len(self.spectrum.modes))] if self.valued else None,
            "stability": self.spectrum.stability if self.valued else None,
            "why": self.spectrum.why if self.valued else None,
        }

    def _state_space_entry(self) -> dict[str, Any]:
        """The state space with the coordinates as outputs."""
        exact, numbers = self.modes.state_spaces(self.coordinates)
        return {
            "states": [x.name for x in self.equations.moving],
            "outputs": list(self.coordinates),
            **{
                letter: {
                    "exact": None if exact is None else self._texts(getattr(exact, letter)),
                    "value": None if numbers is None else getattr(numbers, letter),
                }
                for letter in LETTERS
            },
        }

    def _family(self) -> dict[str, Any] | None:
        """The steady motions that this one belongs to; null where it was not sought, or cannot be written."""
        family = self.small.reference.family
        if family is None:
            return None
        motions = zip(family.others, family.closed, self.modes.beside, strict=True) if self.valued else ()
        return {
            "held": [x.name for x in (*family.zeros, *family.held)],
            "conditions": [to_text(x) for x in family.conditions],
            "formulas": {x.name: to_text(value) for x, value in family.formulas.items()},
            "complete": family.complete,
            "where": family.where,
            "motions": [
                {
                    "state": {x.name: _state(closed.get(x), value, valued=True) for x, value in at.items()},
                    "stability": stability or None,
                }
                for at, closed, stability in motions
            ],
        }

    def _matrix(self, A: Entries) -> dict[str, Any]:
        if not self.is_exact:
            return {"exact": None, "value": A}
        return {"exact": self._texts(A), "value": self._values(A)}

    def _texts(self, A: Entries) -> list[list[str]]:
        return [[to_text(self.modes.written(x)) for x in row] for row in A]

    def _values(self, A: Entries) -> list[list[float]] | None:
        if not self.valued:
            return None
        flat = iter(numbers_of([x for row in A for x in row], self.small.reference.system.scope.known_exactly))
        return [[next(flat) for _ in row] for row in A]

    def _mode(self, k: int) -> dict[str, Any]:
        mode = self.spectrum.modes[k]
        shares = self.modes.participation if self.equations.states else ()
        exact = next((f.exact for f in self.frequencies if f.mode is mode), None)
        return {
            "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
            "frequency": Quantity(None if exact is None else to_text(exact), mode.frequency, unit=None),
            "hertz": mode.hertz,
            "damping_ratio": mode.damping_ratio,
            "kind": mode.kind,
            "shape": {q.name: [x.real, x.imag] for q, x in mode.shape.items()},
            **({"participation": shares[k]} if shares else {}),
        }


def _state(exact: Scalar | None, number: float, *, valued: bool) -> Quantity:
    return Quantity(None if exact is None else to_text(exact), number if valued else None, unit=None)


def _polynomial(polynomial: Polynomial | None) -> list[str] | None:
    """Coefficients, the constant first."""
    if polynomial is None:
        return None
    return [repr(c) if isinstance(c, float) else to_text(c) for c in polynomial.coefficients]


@doing("small motions")
def linearize(
    model: ModelOrPath,
    about: str | None = None,
    coordinates: Sequence[str] = (),
    *,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Linearization:
    """The small motions of a model about an equilibrium, or about its start, a steady motion.

    Args:
        about: "equilibrium", "start" (a steady motion), or "steady" (the one near the start); None: as the model says.
        coordinates: those of the linearized equations; (): as the model says, or all.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: a coordinate that the model does not have.
        DerivationError: no equilibrium; the start is no steady motion; the coordinates do not move by themselves.
    """
    model = model_to_study(model, parameters, start)
    part = model.linearize
    requested = coordinates or (part.coordinates if part is not None else None) or ()
    wanted = tuple(dict.fromkeys((requested,) if isinstance(requested, str) else requested))
    for name in wanted:
        if name not in model.coordinates:
            raise UsageError(f"no coordinate '{name}'", fix=f"one of {', '.join(model.coordinates)}")
    about = about or (part.about if part is not None else "equilibrium")
    study = study_at_rest(model) if about == "equilibrium" and not model.rough_contacts else study_of(model)
    modes = Modes(SmallMotions.of(study.system, about, wanted))
    return Linearization(model, modes, assumptions=study.assumptions)


# -------- state space -----------------------------------------------------------------------------------------
# Small motions -> StateSpace: x' = A x + B w, y = C_y x + D_y w as arrays, and in sympy where they are exact.


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
            raise ToolMissing("python-control is not installed", fix="pip install control") from None
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
                fix="give every parameter a value in [parameters]",
            )
        rows = getattr(self.numbers, letter)
        return np.array(rows, dtype=float).reshape(len(rows), columns)


def state_space_of(exact: StateMatrices | None, numbers: StateMatrices | None) -> StateSpace:
    """State space of the exact and the numeric matrices, of which one at least is known."""
    found = exact or numbers
    assert found is not None
    return StateSpace(found.states, found.inputs, found.outputs, numbers, {} if exact is None else _in_sympy(exact))


def _in_sympy(found: StateMatrices) -> dict[str, Any]:
    import sympy

    from eomgen.symbolic.print import to_sympy

    columns = {"A": len(found.states), "B": len(found.inputs), "C_y": len(found.states), "D_y": len(found.inputs)}
    return {
        letter: sympy.ImmutableDenseMatrix(
            len(rows := getattr(found, letter)), n, list(to_sympy([x for row in rows for x in row]))
        )
        for letter, n in columns.items()
    }
