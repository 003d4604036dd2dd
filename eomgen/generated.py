"""Model -> Generated: equations, reactions and inverse dynamics as files in other languages, with their proof."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from eomgen import files, pipeline
from eomgen.codegen import Emitted, Emitter, Files, RightHandSide, Role, TestVector, Written, targets_named
from eomgen.documents import Document, Lines, lines_document, plain_document, proven, with_constraints_closed
from eomgen.equations import Equations
from eomgen.errors import DerivationError, RunFailed, ToolMissing, UsageError
from eomgen.frozen import dataclass
from eomgen.identification import Regressor, groups_checked, regressor_of
from eomgen.mechanics.free_bodies import NamedReaction
from eomgen.model import Model, ModelOrPath, Values
from eomgen.proof import (
    Certificate,
    Check,
    Judged,
    PhaseMotion,
    TriedState,
    certify,
    checked,
    consistent_states,
    fmu_reported,
    start_state_tried,
    unchecked,
    unwritten,
)
from eomgen.resources import doing
from eomgen.simulation import PhaseIntegrator, PhaseModels
from eomgen.study import Matrices, model_to_study
from eomgen.symbolic.numeric import FLOAT, NoValue, evaluate, tolerances
from eomgen.version import __version__

TESTED = 3.0  # [s] of the run with which an integrator through phases is tested
FINE = tolerances.FINE_RUN  # its tolerance
NOT_SINGLE = (
    "at no state tried are the values single, as a change of the state opens redundant constraints, and which of "
    "these still hold then decides"
)
"""why slopes of some models have no right answers"""


@dataclass(frozen=True)
class Generated:
    """Code that compiles as it is, with test vectors; nothing is written yet.

    Args:
        model: the model.
        equations: as they are written; those of the model, or these pulled together by Baumgarte's rows.
        stem: NAME of the files and functions.
        origin: what the files say that they were made from.
        targets: the languages.
        actuated: the actuators of inverse dynamics, () for all speeds; None where it is not requested.
        integrator: True if the C code has its own.
        float32: True for single precision everywhere.
        slopes: True if the slopes of the right-hand side are requested.
        linear: True if the regressor is requested.
    """

    model: Model
    equations: Equations
    stem: str
    origin: str
    targets: tuple[str, ...]
    actuated: tuple[str, ...] | None = None
    integrator: bool = False
    float32: bool = False
    slopes: bool = False
    linear: bool = False

    @property
    def motion(self) -> Emitted:
        """The right-hand side, described."""
        return self._emitter.motion

    @cached_property
    def _emitter(self) -> Emitter:
        program, rhs = self.equations.program, self._start
        x0, p0 = (None if each is None else each.tolist() for each in (rhs.x0, rhs.p0))
        origin = f"Made by eomgen {__version__} from {self.origin}."
        return Emitter(self.model.name, origin, _remarks(self.model), program, x0, p0, self._held)

    @cached_property
    def _held(self) -> list[tuple[float, list[float], list[float]]]:
        """States (t, x, p) at which all constraints hold, in doubles; [] where none closes."""
        system = self.equations.graph.system
        if not (system.free or system).constraints.closing:
            return []
        symbols, found = system.symbols, []
        groups = (symbols.x, tuple(symbols.parameters.values()))
        for place in (next(iter(supply), None) for _, supply in consistent_states(system)):
            if place is not None:
                x, p = ([float(place.state[s]) for s in group] for group in groups)
                x = [0.0 if abs(each) < tolerances.BEST else each for each in x]  # what Newton's method left of 0
                found.append((float(place.state[symbols.t]), x, p))
        return found

    @property
    def note(self) -> str:
        """A line on the reactions that are not in it, or ""."""
        return self._reactions[1]

    @cached_property
    def functions(self) -> dict[Role, Emitted]:
        """Every function that is written, described, by its role, the right-hand side first.

        Raises:
            DerivationError: the regressor is requested, and a contact has Coulomb friction.
        """
        further = (self._outputs(), self._matrices(), self._jacobian(), self._inverse(), self._linear())
        found = (self.motion, self._reactions[0], *further)
        return {each[1].role: each for each in found if each is not None}

    @property
    def emitted(self) -> tuple[Emitted, ...]:
        """The same without their roles."""
        return tuple(self.functions.values())

    @property
    def reactions(self) -> Emitted | None:
        """The reactions, described; None where none has a single value."""
        return self.functions.get(Role.REACTIONS)

    @property
    def inverse(self) -> Emitted | None:
        """Inverse dynamics, described; None where it is not requested."""
        return self.functions.get(Role.INVERSE)

    def _inverse(self) -> Emitted | None:
        if self.actuated is None:
            return None
        found = self.equations.inverse_dynamics(self.actuated)
        return self._emitter.function(Role.INVERSE, found.program, found.names)

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks on what is not in the code, and why."""
        left = (f"the output {name}: {why}" for name, why in self.equations.requested_outputs.left.items())
        unfinished = ["matrices: friction depends on the reactions"] if self.equations.graph.friction else []
        open_constraints = (
            "what puts the constraints back as they open by the errors of many steps (--baumgarte lets them pull)"
        )
        one_phase = self.integrator and not self.model.changing
        drifts = one_phase and any(not row.identical for row in self.equations.graph.system.constraints.rows)
        unfinished += ["jacobian: nothing moves"] if self.slopes and Role.JACOBIAN not in self.functions else []
        unfinished += [f"test vectors of the {d.role.word}: {d.untested}" for _, d in self.emitted if d.untested]
        return (*(note for note in (self.note, open_constraints * drifts) if note), *left, *unfinished)

    def _outputs(self) -> Emitted | None:
        """The outputs that are functions of the state, described; None where there are none."""
        names = tuple(self.equations.requested_outputs.values)
        if not names:
            return None
        return self._emitter.function(Role.OUTPUTS, self.equations.outputs_program, names)

    def _matrices(self) -> Emitted | None:
        """M, forcing, J and gamma, described; None where friction is none of them, or nothing moves."""
        graph = self.equations.graph
        return None if graph.friction or not graph.M else self._written(Role.MATRICES, Matrices.of_motion(graph))

    def _jacobian(self) -> Emitted | None:
        """The slopes of the right-hand side, described; None where they are not requested, or nothing moves."""
        if not self.slopes or not self.equations.graph.symbols.q:
            return None
        program, described = self._written(Role.JACOBIAN, self.equations.slopes)
        single = tuple(v for v in described.vectors if self._are_single(v))
        return program, replace(described, vectors=single, untested="" if single else NOT_SINGLE)

    def _linear(self) -> Emitted | None:
        """The regressor and its base columns, described; None where it is not requested.

        Raises:
            DerivationError: Coulomb friction of a contact.
        """
        if not self.linear:
            return None
        found, graph = self._regressor, self.equations.graph
        matrices = Matrices(found.blocks)
        columns = {"Y": found.parameters, "Y_base": tuple(group.formula for group in found.base.groups)}
        named = tuple(columns.get(name, ()) for name in matrices.blocks)
        program = matrices.program(graph, accelerations=graph.symbols.a)
        return self._emitter.matrices(Role.REGRESSOR, program, matrices.blocks, named)

    @cached_property
    def _regressor(self) -> Regressor:
        return regressor_of(self.equations.system)

    def _are_single(self, v: TestVector) -> bool:
        """True if the slopes are unique: where a change opens redundant constraints, they depend on the pivots."""
        if not self.equations.graph.J or any(y != y for y in v.result):
            return True
        found = self.equations.rhs_jacobian(v.t, v.x, v.p, v.inputs, single=True)
        return all(np.isfinite(block).all() for block in found)

    def _written(self, role: Role, matrices: Matrices) -> Emitted:
        return self._emitter.matrices(role, matrices.program(self.equations.graph), matrices.blocks)

    @property
    def texts(self) -> dict[str, str | bytes]:
        """{path: content} of every file."""
        return self._files.texts

    @cached_property
    def _files(self) -> Files:
        begin = (self._emitter.x0, self._emitter.p0) if self.integrator else None
        run = self._phases if self.integrator and self.model.changing else {}
        return Files(self.stem, self.emitted, self.targets, self.notes, begin, self.float32, run)

    @property
    def _phases(self) -> dict[str, str]:
        """The integrator of a model whose contacts change, with eomgen's own run as its test."""
        x0, p0 = self._emitter.x0, self._emitter.p0
        tested = None
        if x0 is not None and p0 is not None:
            fine = pipeline.simulate(self.model, time=TESTED, rtol=FINE, atol=FINE, samples=2)
            end = next((x.t for x in fine.impacts if not PhaseIntegrator.decides(self.model, x)), math.inf)
            if 0 < end < math.inf:
                fine = pipeline.simulate(self.model, time=end / 2, rtol=FINE, atol=FINE, samples=2)
            struck = {impact.t for impact in fine.impacts}
            pairs = zip(fine.phases, fine.phases[1:], strict=False)
            changes = [a.end for a, b in pairs if a.end in struck or a.model.configuration != b.model.configuration]
            last = dict(zip(fine.moving, fine.x[-1].tolist(), strict=True))
            tested = (changes, float(fine.t[-1]), last) if fine.ok and end > 0 else None
        p = np.array(p0 if p0 is not None else [math.nan] * len(self.model.parameters))
        models = PhaseModels(self.model, p, "numpy")
        states = tuple(x.name for x in self.motion[0].states)
        return PhaseIntegrator(models, self.stem, states, x0, p0, tolerances.RUN, tested).files()

    def write(self, directory: str | Path) -> list[Path]:
        """Writes the files, all of them or none.

        Raises:
            WriteFailed: the folder cannot be written; nothing is then left behind.
        """
        return files.write_all(directory, self.texts)

    def certify(self) -> Certificate:
        """Checks the equations by independent routes, and every function's text, run here, against the symbols."""
        equations = pipeline.derive(self.model)
        groups = groups_checked(self._regressor) if self.linear else ()
        more = [*groups, *self._checks(equations)]
        return certify(equations.graph) + more

    def _checks(self, plain: Equations) -> Iterator[Check]:
        """Checks of every function in every language.

        Args:
            plain: the equations whose constraints do not pull, in which inverse dynamics is written.
        """
        start = start_state_tried(0.0, self._start.x0, self._start.p0)
        start = (*(TriedState(t, np.array(x), p) for t, x, p in self._held), *start)
        values = {}
        if self.reactions is not None:
            values = self.equations.reaction_values
        judged = {Role.RHS: Judged(PhaseMotion(self.equations.graph), values)}
        judged[Role.REACTIONS] = judged[Role.RHS]
        matrices = Matrices.of_motion(self.equations.graph).entries
        for role, scalars in ((Role.OUTPUTS, self.equations.requested_outputs.values), (Role.MATRICES, matrices)):
            judged[role] = Judged(PhaseMotion(self.equations.graph), scalars)
        judged[Role.JACOBIAN] = Judged(
            PhaseMotion(self.equations.graph), {}, slopes=partial(self.equations.rhs_jacobian, single=True)
        )
        if self.inverse is not None:
            judged[Role.INVERSE] = Judged(PhaseMotion(plain.graph), {}, self.inverse[1].outputs)
        if self.linear:
            entries, motion = Matrices(self._regressor.blocks).entries, PhaseMotion(self.equations.graph)
            judged[Role.REGRESSOR] = Judged(motion, entries, parameters=self._regressor.values)
        for target in self.targets:
            for function in self._files.written(target):
                yield judged[function.role].check(function, start)
        for function in self._files.functions(self.targets[0]):
            found = judged[function.role].shipped(function)
            yield from () if found is None else (found,)
        for target in self.targets:
            yield from unwritten(self._files.of(target), self._files.written(target))
        yield from self._packed()
        for target in self.targets if self.float32 else ():
            for function in self._files.functions(target):
                yield self._single(function)

    def _packed(self) -> Iterator[Check]:
        """Checks of what FMUs declare of their variables."""
        symbols = self.equations.graph.symbols
        x0, p0 = (() if each is None else each.tolist() for each in (self._start.x0, self._start.p0))
        states = dict(zip((x.name for x in symbols.x), x0, strict=bool(len(x0))))
        given = {name: x for name, x in zip(symbols.parameters, p0, strict=False) if x == x}
        nodes = (*symbols.x, *symbols.parameters.values())
        known = {symbols.t: 0.0, **dict(zip(nodes, (*x0, *p0), strict=False))}
        inputs = self.equations.graph.system.inputs
        if len(x0) + len(p0) == len(nodes) and len(given) == len(symbols.parameters):
            with suppress(NoValue, ZeroDivisionError):
                given |= dict(zip(inputs, map(float, evaluate(tuple(inputs.values()), known, FLOAT)), strict=True))
        for path, content in self.texts.items():
            if path.endswith(".fmu") and isinstance(content, bytes):
                yield fmu_reported(content, states if len(given) >= len(symbols.parameters) else {}, given)

    def _single(self, function: Written) -> Check:
        """The text in single precision, run, against its test vectors and their tolerances."""
        how = "the code in single precision, run"
        what = f"{function.name} in single precision ({function.target}) is as near as its tolerances say"
        try:
            error = self._files.single_error(function)
        except (RunFailed, ToolMissing) as failure:
            refused = isinstance(failure, RunFailed) and _runs(function)
            return checked(what, failure.what, how) if refused else unchecked(what, failure.what, how)
        return checked(what, f"{error:.2g} tolerances away" if error > 1 else "", how)

    @cached_property
    def _start(self) -> RightHandSide:
        return self.equations.rhs("numpy")

    @cached_property
    def _reactions(self) -> tuple[Emitted | None, str]:
        """(the program of the reactions, described; a line on those that are not in it)."""
        equations, described = self.equations, self.motion[1]
        try:
            names, program = equations.reactions_program
            found = self._emitter.function(Role.REACTIONS, program, names) if names else None
        except DerivationError as error:
            return None, f"no code for the reactions: {error.what}"
        if found is None:
            return None, "no code for the reactions: none has a single value" if equations.reactions.components else ""
        requested = NamedReaction.all_of(equations.reactions.balance)
        left = ", ".join(named.name for named in requested if named.name not in names)
        note = f"not in the code, statically indeterminate: {left}" if left else ""
        remarks = {**described.remarks, **{named.name: f"[{named.unit}]" for named in requested}}
        return (program, replace(found[1], remarks=remarks)), note


def _runs(function: Written) -> bool:
    """True if the same function in double precision compiles: then no tool is missing, and the text is at fault."""
    try:
        return function.called() is not None
    except (RunFailed, ToolMissing):
        return False


@doing("the code")
def generate(
    model: ModelOrPath,
    targets: Sequence[str] = ("c",),
    *,
    name: str = "model",
    origin: str | None = None,
    actuated: Sequence[str] | None = None,
    jacobian: bool = False,
    regressor: bool = False,
    baumgarte: tuple[float, float] | None = None,
    integrator: bool = False,
    float32: bool = False,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Generated:
    """The right-hand side and the reactions as code that compiles as it is; `.write(DIR)` writes it.

    Args:
        targets: the languages; the files of one lie in the directory, of several each in a folder of its name.
        name: of the functions and files.
        actuated: inverse dynamics too, of these coordinates, speeds, inputs or joints; () for all speeds.
        jacobian: the slopes of the right-hand side in x and inputs too.
        regressor: Y and y0 of tau = Y pi + y0, and the columns of the base parameters, too.
        baumgarte: alpha and beta of constraint rows that pull back what has opened [1/s]; None: they do not pull.
        integrator: an integrator of its own in C too, with a program that writes a motion as CSV.
        float32: single precision, of c, cpp, rust, fortran, wasm and jax; the tolerances of its tests are measured.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: a language that there is none; an integrator of what is not in C, or whose contacts change.
    """
    model = model_to_study(model, parameters, start)
    if integrator:
        _refuse_integrator(model, targets, float32)
    doubles = [target.name for target in targets_named(targets) if target.single is None]  # refuses what is none
    if float32 and doubles:
        some = ", ".join(target.name for target in targets_named() if target.single is not None)
        raise UsageError(f"no single precision in {', '.join(doubles)}: its numbers are doubles", fix=f"take {some}")
    equations = pipeline.derive(model)
    equations = equations if baumgarte is None else replace(equations, study=equations.study.pulled(baumgarte))
    if float32 and equations.graph.J:
        closing = ", ".join(
            f"'{name}'" for name in dict.fromkeys(row.constraint for row in equations.graph.system.constraints.closing)
        )
        what = f"no single precision for constraints that multipliers close: {closing}: which are redundant stays open"
        raise UsageError(what, fix="make coordinates `dependent`, or leave --float32 out")
    origin = origin or model.name
    source = f"{origin} ({model.source})" if model.source else origin
    acting = None if actuated is None else tuple(actuated)
    return Generated(
        model, equations, name, source, tuple(dict.fromkeys(targets)), acting, integrator, float32, jacobian, regressor
    )


def _refuse_integrator(model: Model, targets: Sequence[str], float32: bool) -> None:
    """Refuses an integrator of what cannot have one.

    Raises:
        UsageError: C is not among the languages; contacts or paths change the equations on the way.
    """
    if "c" not in targets:
        raise UsageError("an integrator is written in C", fix="ask for --target c too")
    if not model.changing:
        return
    PhaseIntegrator.refuse(model)
    if float32:
        names = ", ".join(f"'{name}'" for name in model.changing)
        raise UsageError(f"no integrator in single precision for what changes its equations: {names}", fix="doubles")


def _remarks(model: Model) -> dict[str, str]:
    """{argument: its SI unit, where the file names a unit, and its description}."""
    remarks = {}
    for part_of in (model.parameters, model.coordinates, model.states, model.inputs):
        for name, part in part_of.items():
            unit = f"[{part.unit.si}]" if part.unit is not None else ""
            remarks[name] = " ".join(word for word in (unit, part.about or "") if word)
    return {name: remark for name, remark in remarks.items() if remark}


# -------- document -------------------------------------------------------------------------------------------
# eomgen codegen: a right-hand side, and the reactions, that compile as they are, with test vectors.


def codegen_document(
    model: Model,
    *,
    stem: str,
    origin: str,
    targets: tuple[str, ...],
    directory: str,
    inverse: bool = False,
    actuated: tuple[str, ...] = (),
    jacobian: bool = False,
    regressor: bool = False,
    baumgarte: tuple[float, float] | None = None,
    integrator: bool = False,
    float32: bool = False,
    certify: bool = True,
) -> Document:
    """The right-hand side and the reactions as files that compile as they are; none where their proof fails.

    Args:
        targets: the languages; the files of one lie in the directory, of several each in a folder of its name.
        inverse: write inverse dynamics too, of the actuated coordinates, speeds, inputs or joints.
        jacobian: write the slopes of the right-hand side too.
        regressor: write Y, y0 and the columns of the base parameters too.
        baumgarte: alpha and beta of the feedback of gaps in the constraint rows [1/s]; None: without feedback.
        integrator: an integrator in C too.
        float32: single precision.
    """
    acting = actuated if inverse or actuated else None
    found = generate(
        model,
        targets,
        name=stem,
        origin=origin,
        actuated=acting,
        jacobian=jacobian,
        regressor=regressor,
        baumgarte=baumgarte,
        integrator=integrator,
        float32=float32,
    )
    certificate = found.certify() if certify else None
    refused = certificate is not None and certificate.ok is False
    paths = [] if refused else [str(path) for path in found.write(directory)]
    lines = ("no files were written",) if refused else tuple(paths)
    document = plain_document(model, lambda: _payload(found, paths), Lines(lines))
    document = with_constraints_closed(replace(document, notes=tuple(found.notes)), pipeline.derive(found.model).system)
    return proven(document, certificate)


def _payload(found: Generated, paths: list[str]) -> dict[str, object]:
    program, rhs, reactions, moved = found.motion[0], found.equations, found.reactions, found.inverse
    payload: dict[str, object] = {
        "name": found.model.name,
        "target": found.targets[0],
        "targets": list(found.targets),
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
    for role in (Role.OUTPUTS, Role.MATRICES, Role.JACOBIAN, Role.REGRESSOR):
        if role in found.functions:
            program, reported = found.functions[role]
            payload[role.word] = list(reported.outputs or [name for name, *_ in reported.blocks])
            payload[f"{role.word}_operations"] = program.count.total
    if moved:
        payload |= {"actuated": list(moved[1].outputs), "inverse_operations": moved[0].count.total}
    return payload


def languages() -> Document:
    """The targets that there are, a line each."""
    found = [{"name": target.name, "about": target.about} for target in targets_named()]
    return lines_document(lambda: {"targets": found}, *(f"{each['name']:10} {each['about']}" for each in found))
