"""The verbs of runs, and of what is written of a model: files, pages, code. No physics."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eomgen.cli_common import (
    Lasting,
    Verb,
    deliver,
    reading,
    requested_document,
    write_requested,
)
from eomgen.cli_options import (
    ATOL,
    BAUMGARTE,
    FOLLOW,
    FORCES,
    FORMAT,
    JSON,
    LANGUAGE,
    MODEL,
    OF_PLOT,
    OF_TABLE,
    OUTPUT,
    OVER,
    PAGE_TIME,
    PLOT,
    RTOL,
    SAMPLES,
    SET,
    SPEED,
    START,
    TIME,
    TRAIL,
    UNITS,
    VARIANT,
    VIEW,
    WAY,
    WRITTEN,
    folder,
    form_requested,
    refuse_beside,
    refuse_idle,
    refuse_other_endings,
    with_form,
    with_proof,
    with_values,
    words,
)

if TYPE_CHECKING:
    from eomgen.documents import Document

VERB = partial(click.command, cls=Verb)


@VERB("simulate")
@MODEL
@JSON
@FORMAT
@WRITTEN(help="Write the trajectory as .csv or .npz.")
@PLOT
@TIME
@with_values
@RTOL
@ATOL
@click.option(
    "--method",
    default="auto",
    show_default=True,
    metavar="NAME",
    help="auto (DOP853, and Radau where it is stiff), DOP853, taylor (power series), RK45, RK23; "
    "for stiff systems Radau, BDF, LSODA; heyoka (extra).",
)
@click.option("--until", metavar="EQUATION", help='End where it first holds: "theta = pi/2", "reaction_n(A) = 0".')
@click.option(
    "--stabilize",
    type=click.Choice(["projection", "energy", "baumgarte", "none"]),
    default="projection",
    show_default=True,
    help="Stabilization of the constraints.",
)
@click.option(
    "--project-every",
    type=click.IntRange(min=1),
    metavar="STEPS",
    help="Project every so many steps.  [default: where a constraint error exceeds atol/10]",
)
@BAUMGARTE(
    help="Rates of Baumgarte's stabilization [1/s].  [default: 10 10]",
)
@FOLLOW
@VIEW(
    type=click.Choice(["time", "outputs", "phase", "resultants", "polar"]),
    default="time",
    show_default=True,
    help="What --plot draws: all over time, outputs, rates over coordinates, sizes of forces, forces of hinges.",
)
@UNITS(help='In the .csv "theta [deg]", as the file declares it, for names and SI.')
@click.option("--symbols", is_flag=True, help=r'In the .csv the letters of formulas, "$\vartheta$", for names.')
@SAMPLES(help="How many instants are given.  [default: 1001]")
@click.option(
    "--target", metavar="NAME", help="Language that evaluates the equations, of codegen --list.  [default: the fastest]"
)
@with_proof
def simulate_command(
    model: str,
    wants_json: bool,
    format_: str | None,
    output: str | None,
    method: str,
    rtol: float,
    atol: float,
    stabilize: str,
    project_every: int | None,
    baumgarte: tuple[float, float] | None,
    follow: tuple[str, ...],
    strict: bool,
    **options: Any,
) -> int:
    """Integrate the motion from the start values.

    The run continues through every change of contact: opening, closing, sliding, sticking. Reactions and outputs are
    columns. Constraints are stabilized; their errors and that of the energy are reported.
    """
    from eomgen.simulation import Stepping
    from eomgen.verbs import simulate_document as simulated

    if baumgarte and stabilize != "baumgarte":
        raise click.UsageError(f"--baumgarte goes with --stabilize baumgarte, not {stabilize}")
    in_table = output is not None and not output.lower().endswith(".npz")
    refuse_idle(view=(options["plot"] is not None, OF_PLOT), units=(in_table, OF_TABLE), symbols=(in_table, OF_TABLE))
    if project_every and stabilize != "projection":
        raise click.UsageError(f"--project-every goes with --stabilize projection, not {stabilize}")
    rates = baumgarte or Stepping().rates
    options["how"] = Stepping(method, rtol, atol, stabilization=stabilize, every=project_every, rates=rates)
    with reading(model) as source:
        document = requested_document(simulated, source, options, follow, output=output)
    requested = wants_json or format_ is not None
    return deliver(
        document, form_requested(wants_json, format_), on_stderr=output is not None and not requested, strict=strict
    )


@VERB("sweep")
@click.argument("where", metavar="MODEL", type=click.Path(exists=True, allow_dash=True))
@JSON
@click.option("-o", "--output", metavar="DIR", type=click.Path(), help="The folder of the sweep; of --replay a .csv.")
@OVER(multiple=True, help='"k=100:1000:10" (both ends, how many), "log:k=1:9:5".')
@click.option("--random", multiple=True, metavar="LAW", help='"phi=normal(0, 0.1)", uniform, loguniform, lognormal.')
@click.option("--runs", type=click.IntRange(min=1), metavar="N", help="How many are drawn.  [default: 1]")
@click.option(
    "--design",
    type=click.Choice(["random", "sobol", "lhs"]),
    default="random",
    show_default=True,
    help="How they are drawn: random, quasi-random, or a Latin hypercube.",
)
@click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of all random numbers of the sweep."
)
@click.option(
    "--ask",
    multiple=True,
    metavar="EXPR",
    help='An output, as "max(reaction_x(A))", "x at y = 0", "frequency(1)".  [default: all of [outputs]]',
)
@click.option("--critical", default="", metavar="EXPR", help="Find where it changes sign along the first range.")
@TIME
@RTOL
@ATOL
@click.option(
    "--method", default="DOP853", show_default=True, metavar="NAME", help="Integration method, as of simulate."
)
@click.option("--workers", type=click.IntRange(min=1), default=1, show_default=True, help="Processes here.")
@with_values
@click.option("--replay", type=click.IntRange(min=0), metavar="RUN", help="Repeat this run of the sweep in DIR.")
@SAMPLES(help="Number of instants of --replay.  [default: 1001]")
@PLOT
@VIEW(type=click.Choice(["lines", "heat", "scatter"]), help="What --plot draws.  [default: what fits]")
@UNITS(help='In table.csv "k [N/m]", as the file declares it, for names and SI.')
@with_proof
def sweep_command(where: str, wants_json: bool, output: str | None, strict: bool, **options: Any) -> int:
    """Make many runs over parameters, resumably.

    Every parameter and start of --over with every other, and draws of --random at each point; a row for each run in
    DIR/table.csv, a failed one with its message. The same command continues where it was stopped. `--replay RUN DIR`
    repeats one run.
    """
    from eomgen.sweeps import Stepped, replay_document
    from eomgen.verbs import SweepRequested, sweep_document

    form, drawn = form_requested(wants_json, None), bool(options["random"])
    refuse_idle(
        view=(options["plot"] is not None, OF_PLOT),
        units=(output is not None, OF_TABLE),
        design=(drawn, "says how --random is drawn: give both"),
        seed=(drawn, "says what --random draws: give both"),
        samples=(options["replay"] is not None, "is of --replay"),
    )
    replay, samples = options.pop("replay"), options.pop("samples")
    shown = {name: options.pop(name) for name in ("plot", "view", "units", "certify")}
    if replay is not None:
        heeded = ("replay", "where", "output", "samples", "wants_json", "strict", "certify", "patience")
        refuse_beside("--replay", heeded)
        return deliver(replay_document(where, replay, output=output, samples=samples), form, strict=strict)
    if Path(where).is_dir():
        raise click.UsageError(f"'{where}' is a folder: give a model, or --replay RUN")
    if output is not None:
        folder(click.get_current_context(), click.Option(["-o"]), output)
    how = Stepped(**{name: options.pop(name) for name in ("time", "rtol", "atol", "method")})
    with reading(where) as source:
        title = "model" if where == "-" else Path(where).stem
        requested = SweepRequested(how=how, **options)
        text = source.data.decode()
        document = sweep_document(source.model, requested, text=text, title=title, output=output, **shown)
        document = source.warned(document, source.model)
    return deliver(document, form, strict=strict)


@VERB("identify")
@with_form
@with_proof
@click.option(
    "--data",
    type=click.Path(exists=True, dir_okay=False),
    help="A CSV in SI: t, coordinates, rates (q'), accelerations (q''), inputs.",
)
def identify_command(**options: Any) -> int:
    """Fit masses, inertias, friction to a measured motion.

    The base parameters by least squares, with their formulas and deviations; how well the motion identifies them; and
    parameters of bodies of positive density that fit. Without --data, the groups that motions can identify.
    """
    from eomgen.identification import identify_document

    return write_requested(identify_document, **options)


@VERB("animate")
@MODEL
@JSON
@FORMAT
@WRITTEN(required=True, help="Write .gif, .mp4, .html, or a strip .png.")
@PAGE_TIME
@with_values
@click.option("--fps", type=float, default=25.0, show_default=True, help="Frames a second.")
@SPEED
@TRAIL(multiple=True, help="A point that leaves a trail: arm2.end.")
@FORCES(help="Show forces and reactions as arrows.")
@click.option("--modes", type=click.IntRange(min=1), metavar="N", help="Show the N slowest small motions instead.")
@click.option("--virtual", metavar="REACTION", help="Show the virtual displacement that gives it: reaction_y(A).")
@click.option("--frames", type=click.IntRange(min=1), default=6, show_default=True, help="Number of frames of a strip.")
def animate_command(model: str, wants_json: bool, format_: str | None, output: str, **options: Any) -> int:
    """Show the motion, small motions, or a virtual displacement."""
    from eomgen.page import Showing, animate_document, refuse_ending

    refuse_ending(output)
    ending, swings = Path(output).suffix.lower(), options["modes"] is not None or options["virtual"] is not None
    motion = (not swings, "is of the motion in time, which --modes and --virtual do not show")
    refuse_idle(
        **{name: motion for name in ("time", "speed", "trail", "forces")},
        fps=(ending in (".gif", ".mp4"), "is of a .gif and an .mp4"),
        frames=(ending == ".png", "says how many frames a strip has: give -o FILE.png"),
    )
    strict = options.pop("strict")
    shown = {name: options.pop(name) for name in ("fps", "speed", "trail", "forces", "frames")}
    options["showing"] = Showing(**shown)
    with reading(model) as source:
        document = requested_document(animate_document, source, options, output=output)
    return deliver(
        document, form_requested(wants_json, format_), on_stderr=not wants_json and format_ is None, strict=strict
    )


@VERB("codegen")
@click.argument("model", required=False, type=click.Path(exists=True, dir_okay=False, allow_dash=True))
@JSON
@click.option(
    "--target", "targets", multiple=True, default=("c",), show_default=True, help="Language; several: each in DIR/NAME."
)
@click.option("--list", "wants_list", is_flag=True, help="List the languages, and write no code.")
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), callback=folder, help="Where to.")
@FOLLOW
@with_values
@click.option("--inverse", is_flag=True, help="Inverse dynamics too: the forces that given accelerations take.")
@click.option("--jacobian", is_flag=True, help="The Jacobian of the right-hand side in x and inputs too.")
@click.option("--regressor", is_flag=True, help="Y of tau = Y pi + y0 too, and the columns of the base parameters.")
@click.option("--actuated", metavar="NAMES", help='Which coordinates, inputs or joints act: "q1,q2".  [default: all]')
@click.option("--integrator", is_flag=True, help="In C too: an integrator, and a program that writes a motion as CSV.")
@click.option(
    "--float32",
    is_flag=True,
    help="Single precision; the tolerances of its tests are measured.",
)
@with_proof
@BAUMGARTE(
    help="Baumgarte's stabilization of the constraints, with these rates [1/s].",
)
def codegen_command(
    model: str | None,
    wants_json: bool,
    targets: tuple[str, ...],
    wants_list: bool,
    output: str | None,
    inverse: bool,
    integrator: bool,
    float32: bool,
    jacobian: bool,
    regressor: bool,
    actuated: str | None,
    follow: tuple[str, ...],
    baumgarte: tuple[float, float] | None,
    certify: bool,
    strict: bool,
    **options: Any,
) -> int:
    """Write equations and reactions as code, with test vectors."""
    from eomgen.generated import codegen_document as generated
    from eomgen.generated import languages

    if wants_list:
        refuse_beside("--list", ("wants_list", "wants_json", "strict"))
        return deliver(languages(), form_requested(wants_json, None))
    if model is None or output is None:
        raise click.UsageError(f"Missing {'argument MODEL' if model is None else 'option -o DIR'}.")
    stem = "model" if model == "-" else Path(model).stem
    names = tuple(name.strip() for name in actuated.split(",")) if actuated else ()
    with reading(model) as source:
        document = requested_document(
            generated,
            source,
            options,
            follow,
            stem=stem,
            origin=Path(model).name,
            targets=tuple(dict.fromkeys(targets)),
            directory=output,
            inverse=inverse,
            integrator=integrator,
            float32=float32,
            jacobian=jacobian,
            regressor=regressor,
            actuated=names,
            baumgarte=baumgarte,
            certify=certify,
        )
    return deliver(document, form_requested(wants_json, None), strict=strict)


@VERB("play")
@MODEL
@JSON
@WRITTEN(required=True, help="The page: a file .html.")
@PAGE_TIME
@with_values
@click.option(
    "--slider",
    "sliders",
    multiple=True,
    metavar="NAME=FROM:TO",
    help='What gets a slider: "m=0.1:5", or a name alone.  [default: everything]',
)
@TRAIL(default="", help="A point that leaves a trail from the start.")
@FORCES(help="Show arrows of forces from the start.")
@SPEED
@LANGUAGE
@with_proof
def play_command(model: str, wants_json: bool, output: str, strict: bool, **options: Any) -> int:
    """Write an interactive page of a model.

    Sliders for parameters and starts, bodies to drag, plots, energy; it needs no network. Models whose contacts change
    play the recorded run.
    """
    from eomgen.page import play_document

    refuse_other_endings(output, (".html", ".htm"), f"no page can be written as '{output}'", "the ending is .html")
    with reading(model) as source:
        document = requested_document(play_document, source, options, output=output)
    return deliver(document, form_requested(wants_json, None), strict=strict)


@VERB("report")
@MODEL
@JSON
@WRITTEN(
    help="The file: .html, .pdf, .tex, .md or .ipynb.  [required]",
)
@PAGE_TIME
@with_values
@click.option(
    "--for",
    "for_",
    type=click.Choice(["problem", "worksheet", "solution"]),
    help="A sheet: without any answer, the same with room to write in, or with the steps to the answers.",
)
@click.option(
    "--steps", metavar="LIST", callback=words, help='Its steps: "positions,energies"; help lists those of the model.'
)
@WAY
@LANGUAGE
@click.option("--with", "with_", metavar="LIST", callback=words, help='Further sections: "linearize,statics".')
@click.option("--without", metavar="LIST", callback=words, help='Sections that are left out: "motion,downloads".')
@with_proof
def report_command(model: str, wants_json: bool, output: str | None, strict: bool, **options: Any) -> int:
    """Write a page, paper, notebook or sheet of a model.

    Its problem in words, figure, data, derivation, reactions, answers, proof, plots and motion, as far as they fit the
    model. Sections: statement figure data questions derivation reactions free_bodies statics kinematics inertia
    outputs linearize plots motion certificate downloads. `--variant 1:30 --for problem` writes the sheets of a class
    and their key.
    """
    from eomgen.page import form_of, report_document, sheets_document

    listed = options["steps"] == ("help",)
    if output is None and not listed:
        raise click.UsageError("Missing option '-o' / '--output'.")
    if not listed:
        form_of(output or "")  # refused before any work
    options["for_"] = options["for_"] or ""
    with reading(model) as source:
        name = "" if model == "-" else Path(model).name
        text = source.data.decode()
        made: Callable[..., Document] = report_document
        if isinstance(options["variant"], range):
            made = partial(sheets_document, variants=tuple(options.pop("variant")))
        document = requested_document(made, source, options, output=output or "", origin=name, text=text)
    return deliver(document, form_requested(wants_json, None), strict=strict)


@click.command("live", cls=Lasting)
@click.argument("model", type=click.Path(exists=True, dir_okay=False))
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="The port of 127.0.0.1.  [default: a free one]")
@click.option("--no-browser", is_flag=True, help="Open no browser.")
@click.option("--edit", is_flag=True, help="A pane to edit the file in the page.")
@SET
@START
@VARIANT
def live_command(model: str, port: int, no_browser: bool, edit: bool, patience: float | None, **values: Any) -> int:
    """Show a model in a page that follows its file.

    On each save: figure, problems, degrees of freedom, equations, answers, motion, reactions, each as soon as it is
    there. The address is printed; Ctrl-C ends it. --patience is the time for one part. The values of --set and --start
    stay in the place of the file's, and are not written into it.
    """
    from eomgen.living import serve

    if isinstance(values["variant"], range):
        raise click.UsageError("one page shows one variant", click.get_current_context())
    given = values if any(values.values()) else None
    serve(model, port=port, edits=edit, opens=not no_browser, seconds=patience, values=given, say=click.echo)
    return 0


@click.command("lsp", cls=Lasting)
def lsp_command() -> int:
    """Answer an editor about model files, on stdin and stdout.

    By the Language Server Protocol: problems as one types, completion, what a name means and its value, renaming, where
    a name is declared. It needs the extra lsp.
    """
    from eomgen.language_server import answer_editor

    answer_editor()
    return 0


@VERB("schema")
@JSON
@OUTPUT
def schema_command(wants_json: bool, output: str | None) -> int:
    """Write the JSON Schema of a model file, for editors."""
    from eomgen.verbs import schema_document as written

    form_requested(wants_json, None, output)  # refuses other endings; of .json the text is one already
    return deliver(written(), form_requested(wants_json, None), output)


@VERB("doctor")
@JSON
@OUTPUT
def doctor_command(wants_json: bool, output: str | None) -> int:
    """Report what this machine can do."""
    from eomgen.verbs import doctor_document as examined

    return deliver(examined(), form_requested(wants_json, None, output), output)


RUNS = (
    simulate_command,
    sweep_command,
    identify_command,
    animate_command,
    codegen_command,
    play_command,
    report_command,
    live_command,
    lsp_command,
    schema_command,
    doctor_command,
)
