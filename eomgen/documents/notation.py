"""Steps -> the last step: what the letters mean that stand for quantities."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence

from eomgen.documents.statements import Entry, Meaning, Name, Partial, Rate, Statement, Step, Table, parts_of

MEANINGS = {
    "T": ("kinetic energy, of the whole or of a body", "J"),
    "V": ("potential energy, of the whole or of a force", "J"),
    "Q": ("generalized force along a coordinate, of everything applied or of one force", ""),
    "M": ("mass matrix", ""),
    "c": ("inertia terms that are left when nothing accelerates", ""),
    "x": ("position along x, ground axes", "m"),
    "y": ("position along y, ground axes", "m"),
    "z": ("position along z, ground axes", "m"),
    "vx": ("velocity along x, ground axes", "m/s"),
    "vy": ("velocity along y, ground axes", "m/s"),
    "vz": ("velocity along z, ground axes", "m/s"),
    "speed": ("magnitude of the velocity", "m/s"),
    "angle": ("angle of a body against the x axis, counter-clockwise", "rad"),
    "omega": ("angular velocity of a body, counter-clockwise", "rad/s"),
    "omega_1": ("angular velocity of a body about its own x axis", "rad/s"),
    "omega_2": ("angular velocity of a body about its own y axis", "rad/s"),
    "omega_3": ("angular velocity of a body about its own z axis", "rad/s"),
    "Fx": ("force along x, ground axes", "N"),
    "Fy": ("force along y, ground axes", "N"),
    "Fz": ("force along z, ground axes", "N"),
    "couple": ("couple on a body, counter-clockwise", "N*m"),
    "gap": ("what a constraint keeps at zero", ""),
    "Fin_x": ("inertia force of a body along x, minus mass times acceleration of the mass centre", "N"),
    "Fin_y": ("inertia force of a body along y, minus mass times acceleration of the mass centre", "N"),
    "Fin_z": ("inertia force of a body along z, minus mass times acceleration of the mass centre", "N"),
    "Min": ("inertia couple of a body, minus moment of inertia times angular acceleration", "N*m"),
    "Min_x": ("inertia couple of a body about its x axis, minus the rate of its angular momentum", "N*m"),
    "Min_y": ("inertia couple of a body about its y axis, minus the rate of its angular momentum", "N*m"),
    "Min_z": ("inertia couple of a body about its z axis, minus the rate of its angular momentum", "N*m"),
    "P_x": ("momentum of all bodies together along x, ground axes", "kg*m/s"),
    "P_y": ("momentum of all bodies together along y, ground axes", "kg*m/s"),
    "P_z": ("momentum of all bodies together along z, ground axes", "kg*m/s"),
    "L_x": ("angular momentum of all bodies together, along x, ground axes", "kg*m^2/s"),
    "L_y": ("angular momentum of all bodies together, along y, ground axes", "kg*m^2/s"),
    "L_z": ("angular momentum of all bodies together, along z, ground axes", "kg*m^2/s"),
    "L": ("magnitude of the angular momentum of all bodies together", "kg*m^2/s"),
    "Delta": ("what may be added to a reaction that is indeterminate", ""),
}
"""letter -> what it stands for, and its unit ("" where that depends on the coordinate)"""


def notation_step(steps: Sequence[Step], taken: Container[str], more: Sequence[Meaning] = ()) -> Step:
    """The letters that the steps use.

    Args:
        more: names that were given on the way.
        taken: the model's own names; where one of them is such a letter, the table says so.
    """
    letters = {name.letter for step in steps for statement in step.statements for name in quantities(statement)}
    rows = tuple(
        Meaning(Name(letter), meaning + (f"; not the model's own {letter}" if letter in taken else ""), unit)
        for letter, (meaning, unit) in MEANINGS.items()
        if letter in letters
    )
    return Step("notation", "Notation", (Table(("symbol", "meaning", "unit", ""), (*rows, *more)),))


def quantities(statement: Statement) -> Iterator[Name]:
    """The quantities that a statement names."""
    part: object
    for part in parts_of(statement):
        while isinstance(part, (Partial, Rate)):
            part = part.of
        if isinstance(part, Entry):
            yield Name(part.letter)
        elif isinstance(part, Name):
            yield part
