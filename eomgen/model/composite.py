"""Pieces -> Composite: mass, mass centre and inertia of a body that is put together from shapes, over any scalar.

    m = sum s_k m_k,   m c = sum s_k m_k c_k,   I = sum s_k (I_k + m_k (d_k.d_k 1 - d_k d_k^T)),   d_k = c_k - c

with s_k = -1 for a hole, which is taken to lie wholly inside the other pieces.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from eomgen.frozen import dataclass
from eomgen.model.kinds import ValueOf
from eomgen.model.shapes import MassProperties
from eomgen.symbolic.expression import Matrix, Pose, Vector, is_zero, over


@dataclass(frozen=True)
class PlacedPiece:
    """One piece where it is in the body.

    Args:
        piece: as declared.
        mass: m [kg], positive for a hole too; mass centre and inertia about it in the body's axes.
    """

    piece: Any
    mass: MassProperties

    def pose(self, value: ValueOf) -> Pose:
        """Pose of its frame in the body."""
        return self.piece.pose(value)  # type: ignore[no-any-return]

    @property
    def sign(self) -> int:
        """-1 for a hole, which removes material; 1 for anything else."""
        return -1 if self.piece.hole else 1


@dataclass(frozen=True)
class Composite:
    """A body made of pieces: its mass, mass centre and inertia about it, body axes."""

    pieces: tuple[PlacedPiece, ...]
    whole: MassProperties

    @staticmethod
    def of(pieces: Sequence[Any], mass: Any, value: ValueOf) -> Composite:
        """The whole body.

        Args:
            pieces: as declared, `Piece`s.
            mass: the net mass as an expression, or None where every piece has its own.
        """
        masses = masses_of(pieces, mass, value)
        placed = tuple(PlacedPiece(piece, _placed(piece, m, value)) for piece, m in zip(pieces, masses, strict=True))
        m = value(mass) if mass is not None else sum(part.sign * part.mass.m for part in placed)
        com = _center(placed, _weights(pieces, masses, value))
        I: Matrix = Matrix.of((Vector.ZERO, Vector.ZERO, Vector.ZERO))
        for part in placed:
            I = I + part.sign * part.mass.about(com)
        return Composite(placed, MassProperties(m, com, I))

    def written(self, form: Callable[[list[Any]], Sequence[Any]]) -> Composite:
        """The same with all its scalars, those of the whole first, in another form."""
        every = [self.whole, *(placed.mass for placed in self.pieces)]
        scalars = form([x for mass in every for x in mass.scalars])
        size = len(self.whole.scalars)
        whole, *masses = (MassProperties.of_scalars(scalars[k : k + size]) for k in range(0, len(scalars), size))
        pieces = (PlacedPiece(placed.piece, mass) for placed, mass in zip(self.pieces, masses, strict=True))
        return Composite(tuple(pieces), whole)


def masses_of(pieces: Sequence[Any], mass: Any, value: ValueOf) -> tuple[Any, ...]:
    """The mass of each piece: its own, or its share by measure (length, area or volume) in what is left [kg].

    Without the mass of the whole, a hole has the density of the one piece of its dimension.
    """
    given = [None if piece.shape.mass is None else value(piece.shape.mass) for piece in pieces]
    sharing = [k for k, m in enumerate(given) if m is None]
    measures = {k: pieces[k].shape.measure(value) for k in sharing}
    if mass is None:
        densities = {k: _density(pieces, given, sources(pieces, k), value) for k in sharing}
    else:
        left = value(mass) - sum(_sign(piece) * m for piece, m in zip(pieces, given, strict=True) if m is not None)
        net = sum(_sign(pieces[k]) * measure for k, measure in measures.items())
        densities = {k: (left, net) for k in sharing}
    shared = {k: over(densities[k][0] * measures[k], densities[k][1]) for k in sharing}
    return tuple(shared[k] if m is None else m for k, m in enumerate(given))


def sources(pieces: Sequence[Any], hole: int) -> tuple[int, ...]:
    """The pieces out of which a hole may be cut: those of its dimension that are no holes."""
    dimension = pieces[hole].shape.dimension
    return tuple(k for k, p in enumerate(pieces) if not p.hole and p.shape.dimension == dimension)


def _density(pieces: Sequence[Any], given: Sequence[Any], of: tuple[int, ...], value: ValueOf) -> tuple[Any, Any]:
    (k,) = of
    return given[k], pieces[k].shape.measure(value)


def _sign(piece: Any) -> int:
    return -1 if piece.hole else 1


def _placed(piece: Any, m: Any, value: ValueOf) -> MassProperties:
    """The mass properties of a piece in the body's axes."""
    own = piece.shape.of_mass(m, value)
    pose = piece.pose(value)
    I = pose.R @ own.I @ pose.R.T
    return MassProperties(m, pose.point(own.com), I)


def _weights(pieces: Sequence[Any], masses: Sequence[Any], value: ValueOf) -> list[Any]:
    """Weights of the mass centre: masses, or measures where all pieces share one mass, so that it is not needed."""
    if all(piece.shape.mass is None for piece in pieces):
        return [_sign(piece) * piece.shape.measure(value) for piece in pieces]
    return [_sign(piece) * m for piece, m in zip(pieces, masses, strict=True)]


def _center(placed: Sequence[PlacedPiece], weights: Sequence[Any]) -> Vector:
    total = sum(weights)
    if is_zero(total):
        return Vector.ZERO  # without mass, nothing has a centre
    first: Vector = Vector.ZERO
    for weight, part in zip(weights, placed, strict=True):
        first = first + weight * part.mass.com
    return Vector(over(x, total) for x in first)
