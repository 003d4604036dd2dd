"""Orientation in space by three angles about the body's own successive axes, over any scalar.

For the sequence "zxz" with angles psi, theta, phi: R = Rz(psi) Rx(theta) Rz(phi), child to parent.
"""

from itertools import product as combinations
from typing import Annotated, Any

from eomgen.model.containers import ListRule
from eomgen.model.fields import CONFIGURATION, FormulaRule, NameRule, TextRule
from eomgen.model.joints.base import Column, X, Y, Z, angular
from eomgen.symbolic.expressions import Expression
from eomgen.symbolic.functions import cos, sin
from eomgen.symbolic.spatial import IDENTITY, Matrix, apply, product, rotation, transposed

AXES = {"x": X, "y": Y, "z": Z}
SEQUENCES = tuple("".join(s) for s in combinations("xyz", repeat=3) if s[0] != s[1] != s[2])

Sequence = Annotated[str, TextRule((*SEQUENCES, "quaternion"))]
Angles = Annotated[tuple[Expression, ...], ListRule(FormulaRule("rad", "", CONFIGURATION), 3, 3)]
Quaternion = Annotated[tuple[str, ...], ListRule(NameRule("coordinate"), 4, 4)]
Omega = Annotated[tuple[str, ...], ListRule(NameRule("speed"), 3, 3)]


def rotation_by(sequence: str, angles: tuple[Any, ...]) -> Matrix:
    """R = R1(a1) R2(a2) R3(a3), child to parent."""
    R = IDENTITY
    for axis, angle in zip(sequence, angles, strict=True):
        R = product(R, rotation(AXES[axis], cos(angle), sin(angle)))
    return R


def turning_columns(sequence: str, angles: tuple[Any, ...]) -> tuple[Column, ...]:
    """The columns of S of the three angles, child's axes: each axis seen through the turns after it."""
    columns = []
    for k, axis in enumerate(sequence):
        after = rotation_by(sequence[k + 1 :], angles[k + 1 :])
        columns.append(angular(apply(transposed(after), AXES[axis])))
    return tuple(columns)
