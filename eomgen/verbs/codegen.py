"""eomgen codegen: a right-hand side, and the reactions, that compile as they are, with test vectors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from eomgen import pipeline
from eomgen.codegen.files import Emitted, write_files
from eomgen.codegen.rhs import RightHandSide, target_named
from eomgen.codegen.targets import ALL
from eomgen.codegen.targets.base import INVERSE, REACTIONS, Description
from eomgen.codegen.vectors import vectors
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.named_reactions import named_reactions
from eomgen.model.parts import Model
from eomgen.report.document import lines_document, plain_document
from eomgen.report.statements import Lines
from eomgen.running import pulling
from eomgen.verbs.outcome import Outcome, listed
from eomgen.version import __version__


def codegen(
    model: Model,
    *,
    stem: str,
    origin: str,
    targets: tuple[str, ...],
    directory: str,
    inverse: bool = False,
    actuated: tuple[str, ...] = (),
    baumgarte: tuple[float, float] | None = None,
) -> Outcome:
    """The right-hand side and the reactions as files that compile as they are, with test vectors.

    Args:
        targets: the languages; the files of one lie in the directory, of several each in a folder of its name.
        inverse: write inverse dynamics too, of the actuated coordinates, speeds, inputs or joints.
        baumgarte: alpha and beta of closing rows that pull back what has opened [1/s]; None: they do not pull.
    """
    for name in targets:
        target_named(name)  # refuses what is none before anything is derived
    equations = pipeline.derive(model)
    equations = equations if baumgarte is None else pulling(equations, baumgarte)
    program, rhs = equations.program, equations.rhs("numpy")
    source = f"{origin} ({model.source})" if model.source else origin
    description = Description(
        model.name,
        f"Made by eomgen {__version__} from {source}.",
        _remarks(model),
        vectors(program, x0=rhs.x0, p0=rhs.p0),
    )
    reactions, note = _reactions(equations, description, rhs)
    moved = _inverse(equations, description, rhs, actuated) if inverse or actuated else None
    paths = [
        str(path)
        for path in write_files(
            stem, program, description, targets=targets, directory=Path(directory), reactions=reactions, inverse=moved
        )
    ]
    payload = {
        "name": model.name,
        "target": targets[0],
        "targets": list(targets),
        "files": paths,
        "operations": program.count.total,
        "hoisted_operations": program.count.hoisted,
        "coordinates": list(rhs.coordinates),
        "speeds": list(rhs.speeds),
        "parameters": list(rhs.parameters),
        "inputs": list(rhs.inputs),
        "reactions": list(reactions[1].outputs) if reactions else None,
        "reaction_operations": reactions[0].count.total if reactions else None,
    }
    if moved:
        payload |= {"actuated": list(moved[1].outputs), "inverse_operations": moved[0].count.total}
    return Outcome(plain_document(model, lambda: payload, Lines(tuple(paths))), (note,) if note else ())


def languages() -> Outcome:
    """The targets that there are, a line each."""
    found = [{"name": target.name, "about": target.about} for target in ALL]
    return Outcome(lines_document(lambda: {"targets": found}, *(f"{target.name:10} {target.about}" for target in ALL)))


def _reactions(
    equations: pipeline.Equations, description: Description, rhs: RightHandSide
) -> tuple[Emitted | None, str]:
    """(the program of the reactions, described; a line on those that are not in it)."""
    try:
        names, program = equations.reactions_program
        answers = vectors(program, x0=rhs.x0, p0=rhs.p0) if names else ()
    except DerivationError as error:
        return None, f"no code for the reactions: {error.what}"
    if not names:
        return None, "no code for the reactions: none has a single value" if equations.reactions.components else ""
    left = [named.name for named in named_reactions(equations.reactions.balance) if named.name not in names]
    note = f"not in the code, statically indeterminate: {listed(left)}" if left else ""
    units = {named.name: f"[{named.unit}]" for named in named_reactions(equations.reactions.balance)}
    remarks = {**description.remarks, **units}
    told = replace(description, vectors=answers, role=REACTIONS, outputs=names, remarks=remarks)
    return (program, told), note


def _inverse(
    equations: pipeline.Equations, description: Description, rhs: RightHandSide, actuated: tuple[str, ...]
) -> Emitted:
    """The program of inverse dynamics, described."""
    found = equations.inverse_dynamics(actuated)
    answers = vectors(found.program, x0=rhs.x0, p0=rhs.p0)
    return found.program, replace(description, vectors=answers, role=INVERSE, outputs=found.names)


def _remarks(model: Model) -> dict[str, str]:
    """Of each argument its SI unit where the file names a unit, and what it is."""
    remarks = {}
    for part_of in (model.parameters, model.coordinates, model.inputs):
        for name, part in part_of.items():
            unit = f"[{part.unit.si}]" if part.unit is not None else ""
            remarks[name] = " ".join(word for word in (unit, part.about or "") if word)
    return {name: remark for name, remark in remarks.items() if remark}
