"""The command line: the verbs and their options. No physics; what a verb needs is imported inside it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eomgen.cli_common import Delivery, Source, Verbs, deliver, deliver_several, delivery_of, reading
from eomgen.cli_options import (
    CERTIFY,
    FOLLOW,
    FORMAT,
    JSON,
    MODEL,
    OF_PLOT,
    OF_TABLE,
    OUTPUT,
    PAGE_TIME,
    PLOT,
    TIME,
    folder,
    form_asked,
    refuse_beside,
    refuse_idle,
    with_form,
    with_picture,
    with_values,
    words,
)
from eomgen.symbolic.numeric.tolerances import RUN
from eomgen.version import __version__

REST = "at rest"  # of --from-rest without a value

if TYPE_CHECKING:
    from eomgen.documents.document import Document
    from eomgen.documents.result import Result
    from eomgen.model.parts import Model


def _followed(declared: Model, follow: tuple[str, ...]) -> Model:
    """The model, coordinates and inputs through the samples of files."""
    from eomgen.verbs.csv_inputs import following

    return following(declared, follow) if follow else declared


def _write(
    made: Callable[..., Document],
    *,
    model: str,
    wants_json: bool,
    output: str | None,
    format_: str | None,
    follow: tuple[str, ...] = (),
    strict: bool = False,
    **options: Any,
) -> int:
    """The document of a verb, in the form that is asked."""
    form = form_asked(wants_json, format_, output)
    with reading(model) as source:
        document = _asked(made, source, options, follow)
    return deliver(document, form, output, strict=strict)


def _asked(
    made: Callable[..., Document],
    source: Source,
    options: dict[str, Any],
    follow: tuple[str, ...] = (),
    **more: Any,
) -> Document:
    """The document of a verb for what was typed, in the units of the file; what was taken, and warnings, are in it."""
    from eomgen.verbs.assignments import typed

    valued, rest = typed(_followed(source.model, follow), options)
    document = made(valued.model, **rest, **more)
    document = replace(document, taken=(*valued.taken, *document.taken))
    return source.warned(document, valued.model)


def _write_result(
    found: Callable[..., Result], *, plot: str | None, certify: bool, at_start: bool = False, **options: Any
) -> int:
    """What a verb finds, at the start or elsewhere, drawn and proven where that is asked."""
    from eomgen.verbs.outcome import shown, with_start_told

    def made(declared: Model, **asked: Any) -> Document:
        document = shown(found(declared, **asked), plot=plot, certify=certify)
        return with_start_told(document, declared) if at_start else document

    return _write(made, **options)


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="eomgen")
def main() -> None:
    """Mechanical systems: equations of motion, reactions, small motions, structures at rest, mechanisms; exact, step by
    step.

    MODEL is a text file that declares the system (- reads it from stdin); begin with `eomgen new NAME`.
    """


@main.command("new")
@click.argument("name")
@click.option("--example", metavar="EXAMPLE", help="Begin with this one of `eomgen examples`.")
@JSON
def new_command(name: str, example: str | None, wants_json: bool) -> int:
    """Write a commented starter model NAME.toml."""
    from eomgen.verbs.new import new_document as made

    return deliver(made(name, example), form_asked(wants_json, None))


@main.command("examples")
@JSON
@OUTPUT
def examples_command(wants_json: bool, output: str | None) -> int:
    """List the models that ship."""
    from eomgen.verbs.examples import examples_document as shipped

    return deliver(shipped(), form_asked(wants_json, None, output), output)


@main.command("import")
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
@JSON
@click.option("-o", "--output", type=click.Path(dir_okay=False), help="The model file, .toml.  [default: stdout]")
@click.option("--floating", is_flag=True, help="Of URDF: nothing holds the base; else it is fixed to the ground.")
def import_command(file: str, wants_json: bool, output: str | None, floating: bool) -> int:
    """Make a model file of a robot's URDF, MJCF or SDF.

    Bodies, joints, inertias, dampers, motors as inputs, joints that mimic others as constraints, limits as remarks.
    What has no counterpart is listed: on stderr, at the end of the file, and as left_out in JSON.
    """
    from eomgen.verbs.importing import import_document, refuse_other_endings

    refuse_other_endings(output)
    document = import_document(file, output=output, floating=floating)
    return deliver(document, form_asked(wants_json, None))


@main.command("export")
@MODEL
@JSON
@click.option("-o", "--output", required=True, type=click.Path(dir_okay=False), help="The robot's file, .urdf.")
@with_values
def export_command(model: str, wants_json: bool, output: str, strict: bool, **options: Any) -> int:
    """Write a model as URDF, for what URDF can say.

    Links on hinges, slides and free joints, inertias, dampers, motors, coordinates that follow others. What URDF cannot
    say is listed.
    """
    from eomgen.verbs.exporting import export_document, refuse_strange_endings

    refuse_strange_endings(output)
    with reading(model) as source:
        document = _asked(export_document, source, options, output=output)
    return deliver(document, form_asked(wants_json, None), strict=strict)


@main.command("check")
@click.argument("models", nargs=-1, required=True, type=click.Path(exists=True, dir_okay=False, allow_dash=True))
@JSON
@OUTPUT
@FORMAT
@with_values
def check_command(
    models: tuple[str, ...], wants_json: bool, output: str | None, format_: str | None, strict: bool, **options: Any
) -> int:
    """Validate models; count their degrees of freedom.

    By rank and by formula; which ties close and which only react, what is redundant, which velocity ties are
    integrable; how the loops close at the start, and in which other ways they could.
    """
    from eomgen.verbs.check import check_document

    if len(models) == 1:
        options |= {"wants_json": wants_json, "output": output, "format_": format_}
        return _write(check_document, model=models[0], strict=strict, **options)
    form = form_asked(wants_json, format_, output)
    if form == "latex":
        raise click.UsageError("several models make no LaTeX document; take one, or another --format")
    return deliver_several(models, lambda source: _asked(check_document, source, options), form, output, strict=strict)


@main.command("derive")
@with_form
@click.option(
    "--method",
    type=click.Choice(["lagrange", "projection", "kinetostatic"]),
    default="lagrange",
    show_default=True,
    help="By energies, by projection, or body by body with every reaction.",
)
@click.option("--units", is_flag=True, help="The unit of every name, equation, reaction and output too.")
@click.option("--full", is_flag=True, help="Print everything, however long, with names for the long parts.")
@click.option("--diff", metavar="OTHER", type=click.Path(exists=True, dir_okay=False), help="What differs from OTHER.")
@click.option(
    "--fresh",
    is_flag=True,
    envvar="EOMGEN_FRESH",
    help="Derive anew what was proven before, and keep nothing.",
)
@CERTIFY
def derive_command(*, fresh: bool, **options: Any) -> int:
    """Derive the equations of motion and certify them.

    What was derived and proven before is told again, if its equations, derived anew, are the same.
    """
    told = options["diff"] is None, "is of one model, and --diff tells what differs between two"
    refuse_idle(units=told, full=told)
    if fresh or options["model"] == "-" or options["diff"] is not None or not options["certify"]:
        return _write(_derived, **options)
    return _kept_derivation(**options)


def _derived(model: Model, **asked: Any) -> Document:
    from eomgen.verbs.derive import derive_document

    return derive_document(model, **asked)


def _kept_derivation(
    *, model: str, wants_json: bool, output: str | None, format_: str | None, strict: bool, **options: Any
) -> int:
    """The derivation as it was told before, else made, and kept where its proof holds."""
    from eomgen.verbs.kept_derivation import kept_derivation

    form = form_asked(wants_json, format_, output)
    with reading(model) as source:
        declared = source.model
        if options["set_"] or options["start"]:
            from eomgen.verbs.assignments import typed

            declared = typed(source.model, options)[0].model
        before = kept_derivation(source.data, source.name, declared, {**options, "form": form, "strict": strict})
        if before is not None and (known := before.found()) is not None:
            found = Delivery(*known)
        else:
            document = _asked(_derived, source, options)
            found = delivery_of(document, form, strict=strict)
            if before is not None and found.code == 0 and document.certificate is not None and document.certificate.ok:
                before.keep(found.text, found.lines, found.code)
    return found.deliver(output)


@main.command("solve")
@with_form
@FOLLOW
@CERTIFY
def solve_command(**options: Any) -> int:
    """Answer every entry of [outputs], exactly and in numbers."""
    from eomgen.verbs.solve import solve_document

    return _write(solve_document, **options)


@main.command("reactions")
@with_form
@click.option(
    "--at", metavar="EQUATION", help='The first instant after the start at which "theta=pi/2" holds; or "equilibrium".'
)
@click.option("--from-rest", multiple=True, metavar="NAME=VALUE", help="Start there, all speeds 0.")
@FOLLOW
@CERTIFY
def reactions_command(**options: Any) -> int:
    """Give every reaction, as formulas or at an instant.

    Each stands under the name by which an output asks for it, and with the body on which it acts: as a function of
    coordinates and rates with its number at the start; with --at, exactly and as a number at that instant.
    """
    from eomgen.verbs.reactions import reactions_document

    return _write(reactions_document, **options)


@main.command("statics")
@with_picture
@click.option("--reaction", metavar="NAME", help='By virtual work only this one: "reaction_y(A)".')
@click.option("--influence", metavar="NAME", help='Its influence line too; also of "bending_moment(beam, L)".')
def statics_command(**options: Any) -> int:
    """Give reactions at rest by virtual work, or the places of rest.

    Of a structure: whether it stands, and by rank which part does not; every reaction by virtual work, with the
    mechanism that is left when it is released, and by equilibrium; members of trusses; N, V and M along its beams. Of a
    system that is free to move: where it is at rest, and whether that is stable.
    """
    from eomgen.documents.statics.result import statics

    return _write_result(statics, **options)


@main.command("kinematics")
@with_picture
@click.option("--at", metavar="EQUATION", help='The instant: the first after the start at which "theta=pi/2" holds.')
@click.option("--given", multiple=True, metavar="EQUATION", help='A velocity that is known: "omega(crank) = 2".')
@click.option(
    "--relative",
    multiple=True,
    metavar='"POINT in BODY"',
    help="Motion of a point on a moving body: transport, relative, Coriolis.",
)
def kinematics_command(**options: Any) -> int:
    """Give velocities and centres of rotation at one instant.

    Of a mechanism in the one position of its file, or of a motion at its start or at an instant: mobility, centres of
    rotation with the lines on which they are found, spins, velocities and accelerations of points, kinds of motion.
    """
    from eomgen.verbs.kinematics import kinematics_asked

    return _write_result(kinematics_asked, at_start=True, **options)


@main.command("inertia")
@with_picture
@click.option("--body", "bodies", multiple=True, metavar="NAME", help="Only this body.  [default: each, and the whole]")
@click.option("--about", metavar="POINT", help="About this point too.")
@click.option("--axis", metavar="A,B", help="About the axis through two points, or x, y, z through the point.")
def inertia_command(**options: Any) -> int:
    """Give masses, mass centres, moments of inertia, principal axes.

    Of each body and of all together; of a body of parts what each adds. Both signs of the products are given: of the
    tensor (minus) and of the textbook (plus).
    """
    from eomgen.documents.inertia.result import inertia

    return _write_result(inertia, at_start=True, **options)


@main.command("linearize")
@with_picture
@click.option(
    "--about",
    type=click.Choice(["equilibrium", "start", "steady"]),
    help="Rest nearest to the start; the start, if its motion is steady; or the steady motion near "
    "it.  [default: see [linearize]]",
)
@click.option("--coordinate", "coordinates", multiple=True, metavar="NAME", help="Only these.  [default: all]")
@click.option(
    "--view",
    type=click.Choice(["modes", "bode", "locus"]),
    default="modes",
    show_default=True,
    help="What --plot draws: the modes, Bode's diagrams, or the roots over a parameter.",
)
@click.option("--over", metavar="RANGE", help='Of --view locus: "k=100:1000:50", "log:k=1:100:50".')
def linearize_command(view: str, over: str | None, **options: Any) -> int:
    """Give small motions about rest or a steady motion.

    M, C and K with their parts, the state matrix, characteristic polynomial, frequencies, damping and shapes of the
    modes, stability with the conditions of Hurwitz, transfer functions from the inputs.
    """
    from eomgen.documents.linearize.result import linearize
    from eomgen.model.ranges import range_of

    refuse_idle(view=(options["plot"] is not None, OF_PLOT))
    if (over is not None) != (view == "locus"):
        raise click.UsageError('--view locus and --over "k=1:10:50" go together')

    def found(model: Model, **asked: Any) -> Result:
        wanted = None if over is None else range_of(model, over)
        return replace(linearize(model, **asked), drawn=view, over=wanted)

    return _write_result(found, at_start=options["about"] == "start", **options)


@main.command("verify")
@MODEL
@click.argument("equations", nargs=-1)
@JSON
@OUTPUT
@FORMAT
@with_values
@click.option(
    "--file",
    "answers",
    multiple=True,
    type=click.Path(exists=True, allow_dash=True),
    help="Equations in a file, one a line; all files of a folder.",
)
@click.option("--at", metavar="EQUATION", help='The instant of which they speak: "theta=pi/2"; or "equilibrium".')
@click.option(
    "--from-rest",
    is_flag=False,
    flag_value=REST,
    multiple=True,
    metavar="[NAME=VALUE]",
    help="The motion starts there, all speeds 0; without a value where the file says.",
)
@click.option(
    "--kind",
    type=click.Choice(
        "motion energy force reaction velocity acceleration inertia frequency equilibrium statics law".split()
    ),
    help="What they are about.  [default: by what stands in them]",
)
@click.option("--hint", type=click.IntRange(1, 3), help="Tell 1 where to look, 2 at which quantity, 3 the cause.")
@CERTIFY
def verify_command(from_rest: tuple[str, ...], **options: Any) -> int:
    """Judge equations that somebody derived: right, or why not.

    EQUATIONS are text or LaTeX (- reads them from stdin): equations of motion, T, V, Q(theta), reactions, any function
    that an output may ask, first integrals, the motion as a function of time. Exit 0 right, 5 wrong, 3 undecided.
    """
    from eomgen.verbs.verify import verify_document

    placed = tuple(each for each in from_rest if each != REST)

    def judged(declared: Model, **asked: Any) -> Document:
        rest = asked.pop("from_rest", None) or ({} if from_rest else None)
        return verify_document(declared, from_rest=rest, **asked)

    return _write(judged, from_rest=placed, **options)


@main.command("simulate")
@MODEL
@JSON
@FORMAT
@click.option("-o", "--output", type=click.Path(dir_okay=False), help="Write the trajectory as .csv or .npz.")
@PLOT
@TIME
@with_values
@click.option("--rtol", type=float, default=RUN, show_default=True, help="Relative tolerance of the run.")
@click.option("--atol", type=float, default=RUN, show_default=True, help="Absolute tolerance of the run.")
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
    help="What keeps ties closed.",
)
@click.option(
    "--project-every",
    type=click.IntRange(min=1),
    metavar="STEPS",
    help="Project at each so many steps.  [default: where a tie opens by atol/10]",
)
@click.option(
    "--baumgarte", nargs=2, type=float, metavar="ALPHA BETA", help="Rates of Baumgarte's rows [1/s].  [default: 10 10]"
)
@FOLLOW
@click.option(
    "--view",
    type=click.Choice(["time", "outputs", "phase", "resultants", "polar"]),
    default="time",
    show_default=True,
    help="What --plot draws: all over time, outputs, rates over coordinates, sizes of forces, forces of hinges.",
)
@click.option("--units", is_flag=True, help='In the .csv "theta [deg]", as the file declares it, for names and SI.')
@click.option("--samples", type=click.IntRange(min=2), help="How many instants are given.  [default: 1001]")
@click.option("--target", metavar="NAME", help="What runs the equations, as of codegen --list.  [default: the fastest]")
@CERTIFY
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

    It goes on through every change of contact: what opens, closes, slides or sticks. Reactions and outputs are
    columns. Ties are kept closed, and how well, and how well energy is kept, is said.
    """
    from eomgen.simulation.integrator import RATES, Stepping
    from eomgen.verbs.simulate import simulate_document as simulated

    if baumgarte and stabilize != "baumgarte":
        raise click.UsageError(f"--baumgarte goes with --stabilize baumgarte, not {stabilize}")
    in_table = output is not None and not output.lower().endswith(".npz")
    refuse_idle(view=(options["plot"] is not None, OF_PLOT), units=(in_table, OF_TABLE))
    if project_every and stabilize != "projection":
        raise click.UsageError(f"--project-every goes with --stabilize projection, not {stabilize}")
    rates = baumgarte or RATES
    options["how"] = Stepping(method, rtol, atol, stabilization=stabilize, every=project_every, rates=rates)
    with reading(model) as source:
        document = _asked(simulated, source, options, follow, output=output)
    asked = wants_json or format_ is not None
    return deliver(document, form_asked(wants_json, format_), on_stderr=output is not None and not asked, strict=strict)


@main.command("sweep")
@click.argument("where", metavar="MODEL", type=click.Path(exists=True, allow_dash=True))
@JSON
@click.option("-o", "--output", metavar="DIR", type=click.Path(), help="The folder of the sweep; of --replay a .csv.")
@click.option("--over", multiple=True, metavar="RANGE", help='"k=100:1000:10" (both ends, how many), "log:k=1:9:5".')
@click.option("--random", multiple=True, metavar="LAW", help='"phi=normal(0, 0.1)", uniform, loguniform, lognormal.')
@click.option("--runs", type=click.IntRange(min=1), metavar="N", help="How many are drawn.  [default: 1]")
@click.option(
    "--design",
    type=click.Choice(["random", "sobol", "lhs"]),
    default="random",
    show_default=True,
    help="How they are drawn: by chance, quasi-random, or a Latin hypercube.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of all chance in the sweep.")
@click.option(
    "--ask", multiple=True, metavar="EXPR", help='An output, "max(reaction_x(A))", "x at y = 0", "frequency(1)".'
)
@click.option("--critical", default="", metavar="EXPR", help="Seek where it changes its sign along the first range.")
@TIME
@click.option("--rtol", type=float, default=RUN, show_default=True, help="Relative tolerance of a run.")
@click.option("--atol", type=float, default=RUN, show_default=True, help="Absolute tolerance of a run.")
@click.option("--method", default="DOP853", show_default=True, metavar="NAME", help="As of simulate.")
@click.option("--workers", type=click.IntRange(min=1), default=1, show_default=True, help="Processes here.")
@with_values
@click.option(
    "--replay", type=click.IntRange(min=0), metavar="RUN", help="Make this run of the sweep in DIR once more."
)
@click.option("--samples", type=click.IntRange(min=2), help="Of --replay, how many instants.  [default: 1001]")
@PLOT
@click.option(
    "--view", type=click.Choice(["lines", "heat", "scatter"]), help="What --plot draws.  [default: what fits]"
)
@click.option("--units", is_flag=True, help='In table.csv "k [N/m]", as the file declares it, for names and SI.')
@CERTIFY
def sweep_command(where: str, wants_json: bool, output: str | None, strict: bool, **options: Any) -> int:
    """Make many runs over parameters, resumably.

    Every parameter and start of --over with every other, and draws of --random at each point; a row for each run in
    DIR/table.csv, what failed with its message. The same command goes on where it was stopped. `--replay RUN DIR` makes
    one run once more.
    """
    from eomgen.sweeps.plan import Stepped
    from eomgen.verbs.sweep import SweepAsked, replay_document, sweep_document

    form, drawn = form_asked(wants_json, None), bool(options["random"])
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
        asked = SweepAsked(how=how, **options)
        text = source.data.decode()
        document = sweep_document(source.model, asked, text=text, title=title, output=output, **shown)
        document = source.warned(document, source.model)
    return deliver(document, form, strict=strict)


@main.command("identify")
@with_form
@click.option(
    "--data",
    required=True,
    type=click.Path(exists=True, dir_okay=False),
    help="A CSV in SI: t, coordinates, rates (q'), accelerations (q''), inputs.",
)
def identify_command(**options: Any) -> int:
    """Fit masses, inertias, friction to a measured motion.

    The base parameters by least squares, with their formulas and deviations; how well the motion tells them apart; and
    parameters of bodies of positive density that fit.
    """
    from eomgen.verbs.identify import identify_document

    return _write(identify_document, **options)


@main.command("animate")
@MODEL
@JSON
@FORMAT
@click.option(
    "-o", "--output", required=True, type=click.Path(dir_okay=False), help="Write .gif, .mp4, .html, or a strip .png."
)
@TIME
@with_values
@click.option("--fps", type=float, default=25.0, show_default=True, help="Frames a second.")
@click.option("--speed", type=float, default=1.0, show_default=True, help="Seconds of the motion in a second.")
@click.option("--trail", multiple=True, metavar="POINT", help="A point that leaves a trail: arm2.end.")
@click.option("--forces", is_flag=True, help="Show forces and reactions as arrows.")
@click.option("--modes", type=click.IntRange(min=1), metavar="N", help="Show the N slowest small motions instead.")
@click.option("--virtual", metavar="REACTION", help="Show the virtual displacement that gives it: reaction_y(A).")
@click.option("--frames", type=click.IntRange(min=1), default=6, show_default=True, help="Of a strip.")
def animate_command(model: str, wants_json: bool, format_: str | None, output: str, **options: Any) -> int:
    """Show the motion, small motions, or a virtual displacement."""
    from eomgen.verbs.animate import Showing, animate_document, refuse_ending

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
        document = _asked(animate_document, source, options, output=output)
    return deliver(
        document, form_asked(wants_json, format_), on_stderr=not wants_json and format_ is None, strict=strict
    )


@main.command("codegen")
@click.argument("model", required=False, type=click.Path(exists=True, dir_okay=False, allow_dash=True))
@JSON
@click.option(
    "--target", "targets", multiple=True, default=("c",), show_default=True, help="Language; several: each in DIR/NAME."
)
@click.option("--list", "wants_list", is_flag=True, help="The languages that there are, and no code.")
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), callback=folder, help="Where to.")
@FOLLOW
@with_values
@click.option("--inverse", is_flag=True, help="Inverse dynamics too: the forces that given accelerations take.")
@click.option("--jacobian", is_flag=True, help="The slopes of the right-hand side in x and inputs too.")
@click.option("--regressor", is_flag=True, help="Y of tau = Y pi + y0 too, and the columns of the base parameters.")
@click.option("--actuated", metavar="NAMES", help='Which coordinates, inputs or joints act: "q1,q2".  [default: all]')
@click.option("--integrator", is_flag=True, help="In C too: an integrator, and a program that writes a motion as CSV.")
@click.option(
    "--float32",
    is_flag=True,
    help="Single precision; the tolerances of its tests are measured.",
)
@CERTIFY
@click.option(
    "--baumgarte",
    nargs=2,
    type=float,
    metavar="ALPHA BETA",
    help="Closing rows that pull back what has opened, with these rates [1/s].",
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
    from eomgen.verbs.codegen import codegen_document as generated
    from eomgen.verbs.codegen import languages

    if wants_list:
        refuse_beside("--list", ("wants_list", "wants_json", "strict"))
        return deliver(languages(), form_asked(wants_json, None))
    if model is None or output is None:
        raise click.UsageError(f"Missing {'argument MODEL' if model is None else 'option -o DIR'}.")
    stem = "model" if model == "-" else Path(model).stem
    names = tuple(name.strip() for name in actuated.split(",")) if actuated else ()
    with reading(model) as source:
        document = _asked(
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
    return deliver(document, form_asked(wants_json, None), strict=strict)


@main.command("play")
@MODEL
@JSON
@click.option("-o", "--output", required=True, type=click.Path(dir_okay=False), help="The page: a file .html.")
@PAGE_TIME
@with_values
@click.option(
    "--slider",
    "sliders",
    multiple=True,
    metavar="NAME=FROM:TO",
    help='What can be moved: "m=0.1:5", or a name alone.  [default: everything]',
)
@click.option("--trail", default="", metavar="POINT", help="A point that leaves a trail from the start.")
@click.option("--forces", is_flag=True, help="Show arrows of forces from the start.")
@click.option("--speed", type=float, default=1.0, show_default=True, help="How fast its time goes.")
@CERTIFY
def play_command(model: str, wants_json: bool, output: str, strict: bool, **options: Any) -> int:
    """Write a page in which the model is alive.

    Sliders for parameters and starts, bodies that one can take by hand, plots, energy; it needs no network. Models
    whose contacts change play the recorded run.
    """
    from eomgen.verbs.play import play_document, refuse_other_endings

    refuse_other_endings(output)
    with reading(model) as source:
        document = _asked(play_document, source, options, output=output)
    return deliver(document, form_asked(wants_json, None), strict=strict)


@main.command("report")
@MODEL
@JSON
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False),
    help="The file: .html, .pdf, .tex, .md or .ipynb.",
)
@PAGE_TIME
@with_values
@click.option("--with", "with_", metavar="LIST", callback=words, help='Sections besides: "linearize,statics".')
@click.option("--without", metavar="LIST", callback=words, help='Sections that are left out: "motion,downloads".')
@CERTIFY
def report_command(model: str, wants_json: bool, output: str, strict: bool, **options: Any) -> int:
    """Write a page, paper or notebook of a model.

    Its figure, data, derivation, reactions, answers, proof, plots and motion, as far as they fit the model. Sections:
    figure data derivation reactions statics kinematics inertia outputs linearize plots motion certificate downloads.
    """
    from eomgen.verbs.report import form_of, report_document

    form_of(output)  # refused before any work
    with reading(model) as source:
        name = "" if model == "-" else Path(model).name
        text = source.data.decode()
        document = _asked(report_document, source, options, output=output, origin=name, text=text)
    return deliver(document, form_asked(wants_json, None), strict=strict)


@main.command("schema")
@JSON
@OUTPUT
def schema_command(wants_json: bool, output: str | None) -> int:
    """Write the JSON Schema of a model file, for editors."""
    from eomgen.verbs.schema import schema_document as written

    form_asked(wants_json, None, output)  # refuses other endings; of .json the text is one already
    return deliver(written(), form_asked(wants_json, None), output)


@main.command("doctor")
@JSON
@OUTPUT
def doctor_command(wants_json: bool, output: str | None) -> int:
    """Tell what this machine can do."""
    from eomgen.verbs.doctor import doctor_document as examined

    return deliver(examined(), form_asked(wants_json, None, output), output)
