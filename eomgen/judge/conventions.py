"""What authors count otherwise than the model does -> whether an equation is right in that sense.

The work of a constant force may stand among the potential energies; a natural frequency may be that without the
damping.
"""

from __future__ import annotations

import re
from dataclasses import replace

from eomgen.judge.case import Case
from eomgen.judge.reading import HandEquation
from eomgen.judge.truth import Decided, on_one_side, truth_of
from eomgen.symbolic.expression import Call, Expression, Scalar, is_zero, parse

POTENTIAL, KINETIC = "potential_energy", "kinetic_energy"
WORK = "the work of constant forces counted as a potential energy"
UNDAMPED = "the frequency without the damping"
NATURAL = ("omega_0", "omega0", "omega_n", "omegan", "f_0", "f0", "T_0", "T0")
"""letters of a natural frequency, or its period, which books have for the motion without damping"""


def is_of_kinetic_energy(written: HandEquation) -> bool:
    """True if kinetic energies stand in it and no potential one: no constant may be added to these."""
    names = {call.name for call in written.calls}
    return KINETIC in names and POTENTIAL not in names


def potential_of_constant_forces(case: Case, written: HandEquation) -> Scalar:
    """The negative work of constant forces, which the model does not count among its potential energies; 0 of none."""
    if not any(call.name == POTENTIAL and not call.args for call in written.calls):
        return 0
    return sum((part.V for part in case.parts.elementary if part.kind == "constant"), start=0)


def with_constant_forces(case: Case, written: HandEquation, kind: str) -> Decided | None:
    """Right where V holds the work of constant forces, too; None: it is not so."""
    work = potential_of_constant_forces(case, written) if kind in ("energy", "law") else 0
    if is_zero(work):
        return None

    def called(call: Call) -> Scalar:
        return case.called(call) + (work if call.name == POTENTIAL and not call.args else 0)

    scalar = case.evaluated(written.difference, case.names, called)
    found = truth_of(case, scalar, kind)
    if not found.holds:
        found = on_one_side(case, written, kind, scalar) or found
    return Decided(True, " and ".join(filter(None, (WORK, found.up_to)))) if found.holds else None


def without_damping(case: Case, written: HandEquation) -> HandEquation | None:
    """The same, omega_0 as sqrt(K/M) of the one motion; None: it is another letter, or there are several motions."""
    speeds = case.system.symbols.u
    asked = [call for call in written.left.calls if call.name == "frequency"]
    letter = re.match(r"\w+", written.left.text)
    if letter is None or letter[0] not in NATURAL or len(speeds) != 1 or len(asked) != 1:
        return None
    q = speeds[0].name.removesuffix("'")
    if q not in case.model.coordinates:
        return None
    root = parse(f"sqrt(stiffness({q}, {q})/mass({q}, {q}))", references=True)
    code = tuple(x for kind, what in written.left.code for x in (root.code if what == asked[0] else ((kind, what),)))
    return replace(written, left=Expression(str(root.text), code, (-1,) * len(code)))
