"""Model -> Generated: equations, reactions and inverse dynamics as files in other languages, with their proof."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from eomgen import files, pipeline
from eomgen.certificate import certify
from eomgen.codegen.files import texts_of
from eomgen.codegen.names import identifier
from eomgen.codegen.rhs import RightHandSide, target_named
from eomgen.codegen.targets.base import INVERSE, REACTIONS, RHS, Description, Emitted, FileContent
from eomgen.codegen.vectors import vectors
from eomgen.equations import Equations
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.named_reactions import named_reactions
from eomgen.model.parts import Model
from eomgen.model.reader import ModelOrPath, model_at
from eomgen.model.replaced import Values
from eomgen.proof.check import Certificate, Check
from eomgen.proof.emitted_code import PhaseMotion
from eomgen.proof.written_code import Judged, Written, start_state_tried
from eomgen.questions.run import pulling
from eomgen.symbolic.numeric.work import doing
from eomgen.version import __version__


@dataclass(frozen=True)
class Generated:
    """Code that compiles as it is, with test vectors; nothing is written yet.

    Args:
        model: the model.
        equations: as they are written; those of the model, or these pulled together by Baumgarte's rows.
        stem: NAME of the files and functions.
        origin: what the files say that they were made from.
        targets: the languages.
        actuated: the actuators of inverse dynamics, () for all speeds; None where these are not asked for.
    """

    model: Model
    equations: Equations
    stem: str
    origin: str
    targets: tuple[str, ...]
    actuated: tuple[str, ...] | None = None

    @cached_property
    def motion(self) -> Emitted:
        """The right-hand side, described."""
        program, rhs = self.equations.program, self._start
        remarks = _remarks(self.model)
        origin = f"Made by eomgen {__version__} from {self.origin}."
        answers = vectors(program, x0=rhs.x0, p0=rhs.p0)
        return program, Description(self.model.name, origin, remarks, answers)

    @cached_property
    def reactions(self) -> Emitted | None:
        """The reactions, described; None where none has a single value."""
        return self._reactions[0]

    @property
    def note(self) -> str:
        """A line on the reactions that are not in it, or ""."""
        return self._reactions[1]

    @cached_property
    def inverse(self) -> Emitted | None:
        """Inverse dynamics, described; None where it is not asked for."""
        if self.actuated is None:
            return None
        found = self.equations.inverse_dynamics(self.actuated)
        answers = vectors(found.program, x0=self._start.x0, p0=self._start.p0)
        return found.program, replace(self.motion[1], vectors=answers, role=INVERSE, outputs=found.names)

    @cached_property
    def emitted(self) -> tuple[Emitted, ...]:
        """Every function that is written, the right-hand side first."""
        return tuple(each for each in (self.motion, self.reactions, self.inverse) if each is not None)

    @cached_property
    def texts(self) -> dict[str, FileContent]:
        """{path: content} of every file."""
        return texts_of(self.stem, self.emitted, targets=self.targets, notes=[self.note] if self.note else [])

    def write(self, directory: str | Path) -> list[Path]:
        """The files, all of them or none.

        Raises:
            WriteFailed: the folder cannot be written; nothing is then left behind.
        """
        return files.write_all(directory, self.texts)

    def certify(self) -> Certificate:
        """The equations by independent routes; every function's text, run here, against the symbols."""
        equations = pipeline.derive(self.model)
        return certify(equations.graph) + self._checks(equations)

    def _checks(self, plain: Equations) -> Iterator[Check]:
        """Of every function in every language.

        Args:
            plain: the equations whose ties do not pull, in which inverse dynamics is written.
        """
        start = start_state_tried(0.0, self._start.x0, self._start.p0)
        values = {}
        if self.reactions is not None:
            values = self.equations.reaction_values
        judged = {RHS: Judged(PhaseMotion(self.equations.graph), values)}
        judged[REACTIONS] = judged[RHS]
        if self.inverse is not None:
            judged[INVERSE] = Judged(PhaseMotion(plain.graph), {}, self.inverse[1].outputs)
        for target in self.targets:
            for emitted in self.emitted:
                yield judged[emitted[1].role].check(self._written(target, emitted), start)

    def _written(self, target: str, emitted: Emitted) -> Written:
        program, told = emitted
        folder = "" if len(self.targets) == 1 else f"{target}/"
        texts = {path.removeprefix(folder): text for path, text in self.texts.items() if path.startswith(folder)}
        return Written(target, texts, program, identifier(self.stem), told.role, told.vectors)

    @cached_property
    def _start(self) -> RightHandSide:
        return self.equations.rhs("numpy")

    @cached_property
    def _reactions(self) -> tuple[Emitted | None, str]:
        """(the program of the reactions, described; a line on those that are not in it)."""
        equations, told = self.equations, self.motion[1]
        try:
            names, program = equations.reactions_program
            answers = vectors(program, x0=self._start.x0, p0=self._start.p0) if names else ()
        except DerivationError as error:
            return None, f"no code for the reactions: {error.what}"
        if not names:
            return None, "no code for the reactions: none has a single value" if equations.reactions.components else ""
        asked = named_reactions(equations.reactions.balance)
        left = ", ".join(named.name for named in asked if named.name not in names)
        note = f"not in the code, statically indeterminate: {left}" if left else ""
        remarks = {**told.remarks, **{named.name: f"[{named.unit}]" for named in asked}}
        return (program, replace(told, vectors=answers, role=REACTIONS, outputs=names, remarks=remarks)), note


@doing("the code")
def generate(
    model: ModelOrPath,
    targets: Sequence[str] = ("c",),
    *,
    name: str = "model",
    origin: str | None = None,
    actuated: Sequence[str] | None = None,
    baumgarte: tuple[float, float] | None = None,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Generated:
    """The right-hand side and the reactions as code that compiles as it is; `.write(DIR)` writes it.

    Args:
        targets: the languages; the files of one lie in the directory, of several each in a folder of its name.
        name: of the functions and files.
        actuated: inverse dynamics too, of these coordinates, speeds, inputs or joints; () for all speeds.
        baumgarte: alpha and beta of closing rows that pull back what has opened [1/s]; None: they do not pull.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: a language that there is none.
    """
    model = model_at(model, parameters, start)
    for target in targets:
        target_named(target)  # refuses what is none before anything is derived
    equations = pipeline.derive(model)
    equations = equations if baumgarte is None else pulling(equations, baumgarte)
    origin = origin or model.name
    source = f"{origin} ({model.source})" if model.source else origin
    acting = None if actuated is None else tuple(actuated)
    return Generated(model, equations, name, source, tuple(dict.fromkeys(targets)), acting)


def _remarks(model: Model) -> dict[str, str]:
    """Of each argument its SI unit where the file names a unit, and what it is."""
    remarks = {}
    for part_of in (model.parameters, model.coordinates, model.inputs):
        for name, part in part_of.items():
            unit = f"[{part.unit.si}]" if part.unit is not None else ""
            remarks[name] = " ".join(word for word in (unit, part.about or "") if word)
    return {name: remark for name, remark in remarks.items() if remark}
