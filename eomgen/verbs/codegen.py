"""eomgen codegen: a right-hand side that compiles as it is, with test vectors."""
from __future__ import annotations

from pathlib import Path

from eomgen import pipeline
from eomgen.codegen.files import write_files
from eomgen.codegen.targets.base import Description
from eomgen.codegen.vectors import vectors
from eomgen.model.parts import Model
from eomgen.verbs.outcome import Outcome
from eomgen.version import __version__


def codegen(model: Model, *, stem: str, origin: str, target: str, directory: str) -> Outcome:
    """The right-hand side as files that compile as they are, with test vectors."""
    equations = pipeline.derive(model)
    program, rhs = equations.program, equations.rhs("numpy")
    source = f"{origin} ({model.source})" if model.source else origin
    description = Description(model.name, f"Made by eomgen {__version__} from {source}.", _remarks(model),
                              vectors(program, x0=rhs.x0, p0=rhs.p0))  # fmt: skip
    paths = [str(path) for path in write_files(stem, program, description, target=target, directory=Path(directory))]
    payload = {
        "name": model.name, "target": target, "files": paths, "operations": program.count.total,
        "hoisted_operations": program.count.hoisted, "coordinates": list(rhs.coordinates), "speeds": list(rhs.speeds),
        "parameters": list(rhs.parameters), "inputs": list(rhs.inputs),
    }  # fmt: skip
    return Outcome("".join(f"{path}\n" for path in paths), payload)


def _remarks(model: Model) -> dict[str, str]:
    """Of each argument its SI unit where the file names a unit, and what it is."""
    remarks = {}
    for part_of in (model.parameters, model.coordinates, model.inputs):
        for name, part in part_of.items():
            unit = f"[{part.unit.si}]" if part.unit is not None else ""
            remarks[name] = " ".join(word for word in (unit, part.about or "") if word)
    return {name: remark for name, remark in remarks.items() if remark}
