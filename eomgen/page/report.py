"""eomgen report: the results of the verbs for one model, joined to one page, paper or notebook."""

from __future__ import annotations

import csv
import io
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from eomgen import files, pipeline
from eomgen.codegen import identifier
from eomgen.documents import (
    SECTION_GROUPS,
    Catalogue,
    Document,
    Lines,
    Result,
    Step,
    document_of,
    drawing_at_rest,
    given_step,
    language_of,
    lines_document,
    nearest_name,
    plain_document,
    proven,
    question_steps,
    statement_step,
    with_listings_typeset,
    with_start_reported,
)
from eomgen.equations import Equations
from eomgen.errors import DerivationError, MissingValues, RunFailed, ToolMissing, UsageError
from eomgen.frozen import dataclass
from eomgen.generated import Generated
from eomgen.model import Model, ModelOrPath, Typed, Values, bytes_at, loads, seconds
from eomgen.page.contents import PLAYER, SECTIONS, Attachment, Report, ReportFigure, ReportSection, joint_proof
from eomgen.page.figure import figure_of, motion_drawings, rest_figure
from eomgen.page.formats import FORMATS, FilesByName, written_as
from eomgen.page.markup import Html, element, in_a_row
from eomgen.page.player import (
    Playable,
    PlayedDisplacements,
    PlayedRun,
    PlayerOptions,
    player_parts_of,
    player_read_back,
)
from eomgen.page.read_back import report_read_back
from eomgen.proof import Certificate, Check, pictures_reported, states_shown
from eomgen.questions import solve, variant_of
from eomgen.resources import doing
from eomgen.results import Statics, free_bodies, inertia, kinematics, linearize, statics
from eomgen.runs import PAGE_TIME, run_of_a_page
from eomgen.scene import VirtualDisplacement, picture_reported, scene_of
from eomgen.simulation import Trajectory
from eomgen.study import model_to_study

SAMPLES = 401  # instants of the motion, in drawings and in the table that is offered
MOST_RELEASED = 8  # reactions whose virtual displacement a page plays
LANGUAGES = ("c", "numpy")
SETTING = ("assumptions", "data", "freedom", "coordinates")  # steps that say what is given
UNFIT = (DerivationError, MissingValues, RunFailed)  # reasons that leave a section empty that nobody requested
CAPTIONS = {
    "statics": "Loads and reactions; normal force N, shear force V and bending moment M along the beams.",
    "kinematics": "Centres of rotation and velocities.",
    "inertia": "Bodies, mass centres and principal axes.",
    "linearize": "Shapes of the modes.",
}
EPOCH = (1980, 1, 1, 0, 0, 0)  # of files in archives: the same bytes at any time


SOLUTION = "solution"
AUDIENCES = ("problem", "worksheet", SOLUTION)
STEPS_LISTED = "help"  # in place of the keys of steps
OPEN = ("statement", "figure", "data", "questions")  # sections that hold no answer
SOLVING = ("reactions", "outputs")  # sections of a solution beside its main one


@dataclass(frozen=True)
class Sheet:
    """Readers of a report, and the method of its derivation.

    Args:
        audience: one of AUDIENCES; "" for a whole report.
        steps: keys of the steps that stand in it; () for all.
        method: of the derivation, as `derive` takes it.
        language: of all that it says; "" for that of the model.
    """

    audience: str = ""
    steps: tuple[str, ...] = ()
    method: str = "lagrange"
    language: str = ""

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of its steps, those of groups one by one."""
        return tuple(key for name in self.steps for key in SECTION_GROUPS.get(name, (name,)))

    @property
    def is_open(self) -> bool:
        """True if it is handed out before anybody has solved the problem."""
        return self.audience in ("problem", "worksheet")

    def chosen(self, steps: Iterable[Step]) -> tuple[Step, ...]:
        """The requested steps among these."""
        return tuple(step for step in steps if not self.steps or step.key in self.keys)


@dataclass(frozen=True)
class Subject:
    """A model and the options of its report; each result is found once.

    Args:
        time: the duration of the motion [s]; None: as `run_of_a_page` has it.
        certify: results are proven.
        origin: the name of the model's file, "" for none.
        source: its text.
        sheet: its readers.
    """

    model: Model
    time: float | None
    certify: bool
    origin: str
    source: str
    sheet: Sheet = Sheet()

    @property
    def language(self) -> Catalogue:
        """Words of the language that is requested, else of that of the model.

        Raises:
            UsageError: there are no words in that language.
        """
        return language_of(self.model, self.sheet.language)

    @property
    def stem(self) -> str:
        """Stem of the names under which files are offered."""
        return identifier(Path(self.origin).stem if self.origin else self.model.name)

    @cached_property
    def main(self) -> tuple[str, Document]:
        """(section, document) of the main result: of a motion its derivation, of a structure its reactions, of a
        mechanism its velocities, of bodies that nothing holds their inertia.

        Raises:
            DerivationError: none of them fits, and why the first does not.
        """
        ways = (("derivation",) if self.model.coordinates else ()) + ("statics", "kinematics", "inertia")
        refused: list[DerivationError] = []
        for key in ways:
            try:
                return key, self.document(key)
            except DerivationError as error:
                refused.append(error)
        raise refused[0]

    @cached_property
    def documents(self) -> dict[str, Document]:
        """The documents found so far, by section."""
        return {}

    def document(self, key: str) -> Document:
        """The document of a verb, proven if `certify` is set; its listings are typeset."""
        if key not in self.documents:
            self.documents[key] = with_listings_typeset(_derived(self) if key == "derivation" else self._reported(key))
        return self.documents[key]

    @cached_property
    def found(self) -> dict[str, Result]:
        """The results of those that have one, by section."""
        return {}

    def _reported(self, key: str) -> Document:
        found = self.found[key] = FOUND[key](self.model)
        return proven(found.document, found.certify() if self.certify else None)

    @cached_property
    def equations(self) -> Equations:
        return pipeline.derive(self.model, self.sheet.method)

    @cached_property
    def followed(self) -> tuple[Trajectory, str]:
        """(the motion from the start, why it is shorter than others).

        Raises:
            MissingValues: parameters without a value.
        """
        return run_of_a_page(self.equations, self.time, SAMPLES)

    @property
    def run(self) -> Trajectory:
        """The motion from the start."""
        return self.followed[0]

    @cached_property
    def code(self) -> Generated:
        origin = self.origin or self.model.name
        return Generated(self.model, self.equations, self.stem, origin, LANGUAGES)


def _derived(subject: Subject) -> Document:
    document = subject.equations.written(full=False)
    return subject.equations.proven(document) if subject.certify else proven(document, None)


FOUND: dict[str, Callable[[Model], Result]] = {
    "statics": statics,
    "free_bodies": free_bodies,
    "kinematics": kinematics,
    "inertia": inertia,
    "linearize": linearize,
    "outputs": solve,
}


@doing("the report")
def report(
    model: ModelOrPath,
    path: str | Path | None = None,
    *,
    time: Typed | None = None,
    parameters: Values | None = None,
    start: Values | None = None,
    with_: Sequence[str] = (),
    without: Sequence[str] = (),
    certify: bool = True,
    for_: str = "",
    steps: Sequence[str] = (),
    method: str = "lagrange",
    language: str = "",
) -> Report:
    """A model and the results for it, as a page (.html), a paper (.pdf, .tex), text (.md) or an executed notebook.

    Args:
        path: the file that is written; None: nothing is.
        time: the duration of the motion: 5 s or "500 ms"; None: three periods, until it rests, or
            10 s; less where it stops or takes too many steps.
        parameters, start: values that replace the model's, each as `model_at` takes it.
        with_, without: sections besides those that fit the model, or not among them: the keys of `SECTIONS`.
        certify: its results are proven.
        for_: "problem" for a sheet without any answer, "worksheet" for one with room to write in, "solution".
        steps: keys of the steps of its sections that stand in it; () for all.
        method: of the derivation, as `derive` takes it.
        language: of all that it says, "de", "fr", "es", or a file .po; "" for that of the model.
    Raises:
        UsageError: no format has that ending; there is no such section, step or reader.
        ToolMissing: the program that runs notebooks is not installed.
    """
    form = None if path is None else form_of(str(path))
    is_file = not isinstance(model, Model)
    source = bytes_at(str(model)).decode() if is_file else ""
    origin = Path(str(model)).name if is_file else ""
    lasts = None if time is None else seconds(time)
    sheet = Sheet(for_, tuple(steps), method, language)
    subject = Subject(model_to_study(model, parameters, start), lasts, certify, origin, source, sheet)
    found = report_of(subject, with_, without)
    if form is not None and path is not None:
        found, texts = _read_back(subject, found, form, Path(path).name)
        files.write_all(Path(path).parent, texts)
    return found


def _read_back(subject: Subject, found: Report, form: str, name: str) -> tuple[Report, FilesByName]:
    """(the report with the contradictions of its files, read again; its files)."""
    texts = written_as(found, form, name)
    if found.certificate is None:
        return found, texts
    run = subject.run if "followed" in vars(subject) and not found.head.language.messages else None
    checks = [*report_read_back(found, texts, form, run)]
    checks += [] if form != ".html" or run is None else _player_read_back(subject, found)
    checks += [] if run is None else _figure_read_back(subject, run)
    proof = found.certificate + (c for c in checks if found.certificate.ok is not None or c.ok is False)
    read = replace(found, head=proven(replace(found.head, certificate=None), proof))
    return read, texts if proof.ok is not False or found.certificate.ok is False else written_as(read, form, name)


def form_of(path: str) -> str:
    """The ending of a report's file.

    Raises:
        UsageError: no report is written so.
    """
    form = Path(path).suffix.lower()
    if form not in FORMATS:
        raise UsageError(f"no report can be written as '{path}'", fix=f"endings are {', '.join(FORMATS)}")
    return form


def _figure_read_back(subject: Subject, run: Trajectory) -> Iterator[Check]:
    """Checks that the picture of the model shows it where its motion starts."""
    scene = scene_of(subject.model)
    for _, state in states_shown(run, run.t[:1]):
        if [q.name for q in state.equations.symbols.q] == [q.name for q in scene.system.symbols.q]:
            yield from pictures_reported([(state, picture_reported(drawing_at_rest(scene), scene, 0))])


def _player_read_back(subject: Subject, found: Report) -> Iterator[Check]:
    """Checks that the player of the page holds the run."""
    live = next((section.live for section in found.sections if section.key == "motion" and section.live), None)
    try:
        page = "" if live is None else live()
    except ToolMissing:  # the page says so
        return iter(())
    return player_read_back(PlayedRun(subject.run, PlayerOptions()), page) if page else iter(())


def report_document(
    model: Model,
    *,
    output: str,
    time: float | None,
    with_: Sequence[str] = (),
    without: Sequence[str] = (),
    origin: str = "",
    text: str = "",
    certify: bool = True,
    for_: str = "",
    steps: Sequence[str] = (),
    method: str = "lagrange",
    language: str = "",
) -> Document:
    """Writes the report; the document names its files, or its steps where these are requested."""
    sheet = Sheet(for_, () if STEPS_LISTED in steps else tuple(steps), method, language)
    if STEPS_LISTED in steps:
        titles = step_titles(Subject(model, time, False, origin, text, replace(sheet, audience=SOLUTION)))
        return lines_document(lambda: {"steps": titles}, *(f"{key:<16}{title}" for key, title in titles.items()))
    form = form_of(output)
    subject = Subject(model, time, certify, origin, text, sheet)
    found, texts = _read_back(subject, report_of(subject, with_, without), form, Path(output).name)
    paths = files.write_all(Path(output).parent, texts)
    sections = [section.key for section in found.sections]
    remarks = {section.key: section.remark for section in found.sections if section.remark}
    names = [str(path) for path in paths]
    document = plain_document(
        model,
        lambda: {"name": model.name, "files": names, "sections": sections, "remarks": remarks},
        Lines(tuple(names)),
        failed=found.head.failed,
        notes=tuple(f"{key}: {remark}" for key, remark in remarks.items()),
    )
    return proven(with_start_reported(document, model), found.certificate)


def sheets_document(
    model: Model,
    *,
    variants: Sequence[int],
    output: str,
    certify: bool = True,
    for_: str = "",
    **options: Any,
) -> Document:
    """Writes the sheets of a class, FILE_1, FILE_2, ..., and the data and answers of each as FILE_key.csv."""
    path, names, rows = Path(output), list[str](), list[list[str]]()
    proofs: dict[str, Certificate | None] = {}
    for number in variants:
        drawn = variant_of(model, number)
        sheet = str(path.with_name(f"{path.stem}_{number}{path.suffix}"))
        made = report_document(drawn.model, output=sheet, certify=certify, for_=for_, **options)
        answers = solve(drawn.model)
        proofs[str(number)] = answers.certify() if certify else None
        names += made.entries()["files"]
        heads = [*(f"{x.name} [{x.unit}]" for x in drawn.taken), *(f"{k} [{x.unit}]" for k, x in answers.items())]
        values = [*(x.value for x in drawn.taken), *(x.value for x in answers.values())]
        rows += [] if rows else [["variant", *(head.removesuffix(" []") for head in heads)]]
        rows.append([str(number), *("" if x is None else f"{x:.10g}" for x in values)])
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    names += map(str, files.write_all(path.parent, {f"{path.stem}_key.csv": text.getvalue()}))
    entries = {"name": model.name, "files": names, "variants": list(variants)}
    return proven(plain_document(model, lambda: entries, Lines(tuple(names))), joint_proof(proofs))


def report_of(subject: Subject, with_: Sequence[str] = (), without: Sequence[str] = ()) -> Report:
    """The report of a model: the sections that fit it, and those that are requested.

    Raises:
        UsageError: there is no such section; one is wanted and left out.
    """
    for name in (*with_, *without):
        if name not in SECTIONS:
            raise UsageError(f"there is no section '{name}'", fix=nearest_name(name, SECTIONS))
        if name in with_ and name in without:
            raise UsageError(f"the section '{name}' is wanted and left out", fix="say one of the two")
    sheet, model = subject.sheet, subject.model
    if sheet.audience not in ("", *AUDIENCES):
        raise UsageError(f"no sheet is written for '{sheet.audience}'", fix=f"one of {', '.join(AUDIENCES)}")
    if sheet.is_open and (told := [name for name in with_ if name not in OPEN]):
        raise UsageError(f"the section '{told[0]}' holds answers", fix="write it for the solution")
    keys = [key for key in SECTIONS if key not in without and (key in with_ or key in fitting(subject))]
    made = [_made(subject, key, key in with_) for key in keys]
    sections = tuple(section for section in made if section is not None)
    if sheet.is_open:
        open_ = Report(replace(document_of(model, "", ()), about="", source=""), sections, is_open=True)
        return in_language(open_, subject)
    _refuse_unknown_steps(subject)
    proofs: dict[str, Certificate | None] = {key: each.certificate for key, each in subject.documents.items()}
    if "followed" in vars(subject):
        proofs["motion"] = subject.run.certify() if subject.certify else None
    if "code" in vars(subject):
        proofs["code"] = subject.code.certify() if subject.certify else None
    failures = [document.failed for document in subject.documents.values()]
    failures += [subject.run.message] if "followed" in vars(subject) and not subject.run.ok else []
    failed = "; ".join(filter(None, failures))
    main = subject.main[1]
    head = replace(document_of(model, main.method, ()), failed=failed, notation=main.notation)
    values = replaced(subject)
    lasted = float(subject.run.t[-1]) if "followed" in vars(subject) and len(subject.run.t) else PAGE_TIME
    lasted = subject.time or lasted
    whole = Report(proven(head, joint_proof(proofs)), sections, subject.origin, subject.source, values, lasted)
    return in_language(whole, subject)


def in_language(report: Report, subject: Subject) -> Report:
    """The report in the language that is requested, else in that of the model; the user's own words stay as they are.

    Raises:
        UsageError: there are no words in that language.
    """
    model, language = subject.model, subject.language
    if not language.messages:
        return report
    kept = ("statement", *(f"question_{k}" for k in range(1, len(model.questions or ()) + 1)))
    head = report.head.said_in(language)
    sections = tuple(section.said_in(language, kept) for section in report.sections)
    return replace(report, head=replace(head, title=language.say(head.title)), sections=sections)


def step_titles(subject: Subject) -> dict[str, str]:
    """{key: title} of every step of the sections of a report, in their order."""
    documents = [subject.main[1], *(subject.document(key) for key in fitting(subject) if key in FOUND)]
    known = {step.key: step.title for document in documents for step in document.steps if step.title}
    groups = {name: ", ".join(known[key] for key in keys if key in known) for name, keys in SECTION_GROUPS.items()}
    return known | {name: titles for name, titles in groups.items() if titles}


def _refuse_unknown_steps(subject: Subject) -> None:
    """Refuses the name of a step that there is not.

    Raises:
        UsageError: it is named.
    """
    known = step_titles(subject) if subject.sheet.steps else {}
    for name in subject.sheet.steps:
        if name not in known:
            fix = nearest_name(name, known) or "`--steps help` lists them"
            raise UsageError(f"the solution has no step '{name}'", fix=fix)


def replaced(subject: Subject) -> dict[str, dict[str, str]]:
    """The parameters and starts of the model that its text has otherwise, as expressions in SI."""
    if not subject.source:
        return {}
    model = subject.model
    own = loads(subject.source) if model.repeat is None else loads(subject.source, model.repeat.name)
    parameters = _other(own.parameters, model.parameters, "value")
    tables = ((own.coordinates, model.coordinates), (own.speeds, model.speeds), (own.states, model.states))
    starts = {name: text for there, here in tables for name, text in _other(there, here, "start").items()}
    starts |= {f"{name}'": text for name, text in _other(own.coordinates, model.coordinates, "speed").items()}
    return {key: found for key, found in (("parameters", parameters), ("start", starts)) if found}


def _other(before: Mapping[str, Any], after: Mapping[str, Any], field: str) -> dict[str, str]:
    """{name: text} of the parts that have another value in a field."""
    pairs = ((name, getattr(before[name], field), getattr(part, field)) for name, part in after.items())
    return {name: new.text for name, old, new in pairs if new is not None and new != old}


def fitting(subject: Subject) -> tuple[str, ...]:
    """The sections that fit a model, for the readers of the sheet."""
    model, sheet = subject.model, subject.sheet
    asked = bool(model.questions or (sheet.audience and model.outputs))
    told = [*(["statement"] if model.text else []), *(["questions"] if asked else [])]
    if sheet.is_open:
        return ("figure", "data", *told)
    main, _ = subject.main
    if sheet.audience:
        return ("figure", "data", *told, main, *(key for key in SOLVING if key == "reactions" or model.outputs))
    keys = ["figure", "data", *told, main, "certificate", "downloads"]
    keys += ["reactions"] if main in ("derivation", "statics") else []
    keys += ["outputs"] if model.outputs else []
    keys += ["linearize"] if model.linearize is not None else []
    keys += ["plots", "motion"] if main == "derivation" else ["motion"] if main == "statics" else []
    return tuple(keys)


def _made(subject: Subject, key: str, requested: bool) -> ReportSection | None:
    """A section; one that fits but is not possible says why. None: there is nothing in it.

    Raises:
        DerivationError, MissingValues, RunFailed: the reason that a requested one is not possible.
    """
    try:
        section = MADE[key](subject)
    except UNFIT as error:
        if requested or key == subject.main[0]:
            raise
        return ReportSection(key, remark=f"Not here: {error.what}.")
    return section


def _statement(subject: Subject) -> ReportSection | None:
    step = statement_step(subject.model)
    return ReportSection("statement", (step,)) if step.statements else None


def _questions(subject: Subject) -> ReportSection | None:
    steps = question_steps(subject.model, room=subject.sheet.audience == "worksheet")
    return ReportSection("questions", steps) if steps else None


def _setting(subject: Subject) -> ReportSection | None:
    if subject.sheet.audience:
        return ReportSection("data", (given_step(subject.model),))
    steps = tuple(step for step in subject.main[1].steps if step.key in SETTING)
    return ReportSection("data", steps) if steps else None


def _steps(key: str) -> Callable[[Subject], ReportSection]:
    """Function that makes the section of a verb, without the steps that have sections of their own."""

    def made(subject: Subject) -> ReportSection:
        own = [*(("assumptions", "data") if subject.sheet.audience else SETTING)]
        own += ["reactions"] if key == subject.main[0] else []
        steps = subject.sheet.chosen(step for step in subject.document(key).steps if step.key not in own)
        return ReportSection(key, steps, _pictures(subject, key))

    return made


def _pictures(subject: Subject, key: str) -> tuple[ReportFigure, ...]:
    """The picture of a result, in space of a structure alone; none where it has none: parameters without values."""
    if key == "derivation" or (subject.model.space == "space" and key != "statics"):
        return ()
    try:
        picture = subject.found[key].picture
    except (UsageError, RunFailed):
        return ()
    return (figure_of(replace(picture, title="", language=subject.language), key, CAPTIONS[key]),)


def _reactions(subject: Subject) -> ReportSection | None:
    steps = subject.sheet.chosen(step for step in subject.main[1].steps if step.key == "reactions")
    return ReportSection("reactions", steps) if steps else None


def _free_bodies(subject: Subject) -> ReportSection | None:
    """Each body cut free, as a picture and as a table of its forces."""
    steps = subject.document("free_bodies").steps
    picture = replace(subject.found["free_bodies"].picture, title="", language=subject.language)
    caption = "Each body cut free; an arrow points where its letter is positive."
    return ReportSection("free_bodies", steps, (figure_of(picture, "free_bodies", caption),))


def _outputs(subject: Subject) -> ReportSection | None:
    document = subject.document("outputs")
    return ReportSection("outputs", document.steps) if subject.model.outputs else None


def _plots(subject: Subject) -> ReportSection | None:
    run = subject.run
    drawings = motion_drawings(run, subject.model.units_of((*run.coordinates, *run.states)))
    ended = "" if run.ok else f"The run ended early: {run.message.rstrip('.')}."
    words = " ".join(filter(None, (ended, subject.followed[1], run.still)))
    return ReportSection("plots", drawings=drawings, remark=words)


def _figure(subject: Subject) -> ReportSection | None:
    return ReportSection("figure", drawings=(rest_figure(subject.model, subject.language),))


def _motion(subject: Subject) -> ReportSection | None:
    """The motion as a player; of a structure the virtual displacements that give its reactions."""
    if subject.main[0] == "statics":
        return _released(subject.found["statics"], subject.sheet.language)
    if subject.main[0] != "derivation":
        return None
    played = PlayedRun(subject.run, PlayerOptions(language=subject.sheet.language))
    return replace(_played(played), computed=played.computed)


def _released(found: Result, language: str) -> ReportSection | None:
    """One released reaction after the other; of a system that finds its rest nothing."""
    if not isinstance(found, Statics):
        return None
    structure, reactions = found.found.structure, found.found.reactions
    moved = [r for r in reactions if r.work is not None and r.work.plan.moving]
    if not moved:
        return None
    shown = PlayedDisplacements(tuple(VirtualDisplacement(structure, r) for r in moved[:MOST_RELEASED]), language)
    left = [r.name for r in moved[MOST_RELEASED:]]
    more = f"Not shown: {', '.join(left)}; `eomgen animate --virtual` shows each." if left else ""
    return _played(shown, f"The virtual displacement of each released reaction, to the first order. {more}".strip())


def _played(played: Playable, words: str = "") -> ReportSection:
    """Section with a player of a motion, under words of its own."""

    @cache
    def live() -> Html:
        parts = player_parts_of(played, PLAYER)
        above = [element("p", language_of(played.model, played.language).say(words))] if words else []
        return in_a_row(*above, Html(f"<style>{parts.style}</style>{parts.body}{parts.script}"))

    return ReportSection("motion", live=live)


def _certificate(subject: Subject) -> ReportSection | None:
    return ReportSection("certificate") if subject.certify else None


def _downloads(subject: Subject) -> ReportSection | None:
    stem, found = subject.stem, []
    if subject.source:
        found.append(Attachment(f"{stem}.toml", "text/plain", subject.source.encode(), "the model"))
    if "followed" in vars(subject):
        about = "the motion: a header, then a line an instant, in SI, 9 digits of the largest number of each column"
        found.append(Attachment(f"{stem}.csv", "text/csv", subject.run.columns(), about))
    if "equations" in vars(subject) and subject.equations.speeds:
        about = "the equations and reactions as code in C and for numpy, with test vectors"
        found.append(Attachment(f"{stem}_code.zip", "application/zip", _archive(subject.code.texts), about))
    return ReportSection("downloads", attachments=tuple(found)) if found else None


def _archive(texts: Mapping[str, str | bytes]) -> bytes:
    """Files by path as one file; the page packs it whole."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as packed:
        for path, text in texts.items():
            packed.writestr(zipfile.ZipInfo(path, EPOCH), text, zipfile.ZIP_STORED)
    return archive.getvalue()


MADE: dict[str, Callable[[Subject], ReportSection | None]] = {
    "statement": _statement,
    "figure": _figure,
    "data": _setting,
    "questions": _questions,
    **{key: _steps(key) for key in ("derivation", "statics", "kinematics", "inertia", "linearize")},
    "reactions": _reactions,
    "free_bodies": _free_bodies,
    "outputs": _outputs,
    "plots": _plots,
    "motion": _motion,
    "certificate": _certificate,
    "downloads": _downloads,
}
