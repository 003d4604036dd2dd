"""The command line: the verbs and their options. No physics; what a verb needs is imported inside it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from eomgen.cli_common import (
    Delivery,
    Verbs,
    deliver,
    deliver_several,
    delivery_of,
    put,
    reading,
    requested_document,
    write_requested,
    write_result,
)
from eomgen.cli_options import (
    AT,
    DURATION,
    FOLLOW,
    FORMAT,
    FROM_REST,
    JSON,
    LANGUAGE,
    MODEL,
    OF_PLOT,
    OUTPUT,
    OVER,
    UNITS,
    VIEW,
    WAY,
    WRITTEN,
    form_requested,
    proven_in_full,
    refuse_idle,
    refuse_other_endings,
    with_form,
    with_picture,
    with_proof,
    with_values,
)
from eomgen.cli_runs import RUNS
from eomgen.version import __version__

REST = "at rest"  # of --from-rest without a value

if TYPE_CHECKING:
    from eomgen.documents import Document, Result
    from eomgen.model import Model


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
    from eomgen.verbs import new_document as made

    return deliver(made(name, example), form_requested(wants_json, None))


@main.command("examples")
@JSON
@OUTPUT
def examples_command(wants_json: bool, output: str | None) -> int:
    """List the models that ship."""
    from eomgen.verbs import examples_document as shipped

    return deliver(shipped(), form_requested(wants_json, None, output), output)


@main.command("import")
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
@JSON
@WRITTEN(help="The model file, .toml.  [default: stdout]")
@click.option("--floating", is_flag=True, help="Of a URDF file: a free base.  [default: fixed to the ground]")
@click.option(
    "--model", "model", metavar="NAME", help="The model of an SDF file with several.  [default: the first that moves]"
)
def import_command(file: str, wants_json: bool, output: str | None, floating: bool, model: str | None) -> int:
    """Make a model file of a robot's URDF, MJCF or SDF.

    Bodies, joints, inertias, dampers, motors as inputs, joints that mimic others as constraints, limits as remarks.
    What has no counterpart is listed: on stderr, at the end of the file, and as left_out in JSON.
    """
    from eomgen.verbs import import_document

    if output is not None:
        refuse_other_endings(
            output, (".toml",), f"'{output}' is no name for a model file: the ending is .toml", "name it so"
        )
    document = import_document(file, output=output, floating=floating, model=model)
    return deliver(document, form_requested(wants_json, None))


@main.command("export")
@MODEL
@JSON
@WRITTEN(required=True, help="The robot's file, .urdf.")
@with_values
def export_command(model: str, wants_json: bool, output: str, strict: bool, **options: Any) -> int:
    """Write a model as URDF, for what URDF can say.

    Links on hinges, slides and free joints, inertias, dampers, motors, coordinates that follow others. What URDF cannot
    say is listed.
    """
    from eomgen.exported import export_document

    refuse_other_endings(output, (".urdf",), f"'{output}' is no name for a robot: the ending is .urdf")
    with reading(model) as source:
        document = requested_document(export_document, source, options, output=output)
    return deliver(document, form_requested(wants_json, None), strict=strict)


@main.command("check")
@click.argument("models", nargs=-1, required=True, type=click.Path(exists=True, dir_okay=False, allow_dash=True))
@JSON
@OUTPUT
@FORMAT
@click.option("--expanded", is_flag=True, help="Print the file as it is read: [repeat] and [parts] written out.")
@with_values
def check_command(
    models: tuple[str, ...],
    wants_json: bool,
    output: str | None,
    format_: str | None,
    strict: bool,
    expanded: bool,
    **options: Any,
) -> int:
    """Validate models; count their degrees of freedom.

    By rank and by formula; which constraints close loops and which only give reactions, which are redundant, which
    velocity constraints are integrable; the assembly of the loops at the start, and the other possible ones.
    """
    from eomgen.results import check_document

    if expanded:
        if len(models) > 1 or wants_json or format_ is not None:
            raise click.UsageError("--expanded prints one model file: name one, without --json and --format")
        from eomgen.robots import expanded_text
        from eomgen.verbs import typed

        with reading(models[0]) as source:
            put(expanded_text(typed(source.model, options)[0].model, source.data), output)
        return 0
    if len(models) == 1:
        options |= {"wants_json": wants_json, "output": output, "format_": format_}
        return write_requested(check_document, model=models[0], strict=strict, **options)
    form = form_requested(wants_json, format_, output)
    if form == "latex":
        raise click.UsageError("several models make no LaTeX document; take one, or another --format")
    return deliver_several(
        models, lambda source: requested_document(check_document, source, options), form, output, strict=strict
    )


@main.command("derive")
@with_form
@WAY
@LANGUAGE
@UNITS(help="The unit of every name, equation, reaction and output too.")
@click.option("--full", is_flag=True, help="Print everything, however long, with names for the long parts.")
@click.option("--section", metavar="NAME", help="Only this section: motion, positions, ...")
@click.option("--fragment", is_flag=True, help="LaTeX to paste into a document of your own; it needs amsmath alone.")
@click.option("--numbered", is_flag=True, help="Each formula of --fragment has a number.")
@click.option(
    "--impact",
    metavar="[CONTACT]",
    is_flag=False,
    flag_value="",
    help="The impact where CONTACT closes (A,B: both at once): impulses, speeds after it, loss.",
)
@click.option("--diff", metavar="OTHER", type=click.Path(exists=True, dir_okay=False), help="What differs from OTHER.")
@click.option(
    "--fresh",
    is_flag=True,
    envvar="EOMGEN_FRESH",
    help="Derive anew what was proven before, and cache nothing.",
)
@with_proof
def derive_command(*, fresh: bool, **options: Any) -> int:
    """Derive the equations of motion and certify them.

    A cached derivation and proof are reported again if the equations, derived anew, are the same.
    """
    of_one = options["diff"] is None, "is of one model, and --diff compares two"
    form = form_requested(options["wants_json"], options["format_"], options["output"])
    in_latex = form == "latex", "is of --format latex"
    refuse_idle(units=of_one, full=of_one, section=of_one, fragment=in_latex)
    if (
        fresh
        or options["model"] == "-"
        or options["impact"] is not None
        or options["diff"] is not None
        or not options["certify"]
    ):
        return write_requested(partial(_derived, data=form == "json"), **options)
    return _cached_derivation(**options)


def _derived(model: Model, **requested: Any) -> Document:
    from eomgen.verbs import derive_document

    return derive_document(model, **requested)


def _cached_derivation(
    *, model: str, wants_json: bool, output: str | None, format_: str | None, strict: bool, **options: Any
) -> int:
    """Writes the cached derivation, else makes it, and caches it where its proof holds; returns the exit code."""
    from eomgen.study import cached_derivation

    form = form_requested(wants_json, format_, output)
    with reading(model) as source:
        declared = source.model
        if options["set_"] or options["start"] or options["variant"] is not None:
            from eomgen.verbs import typed

            declared = typed(source.model, options)[0].model
        printed = {"form": form, "strict": strict, "in full": proven_in_full()}
        before = cached_derivation(source.data, source.name, declared, {**options, **printed})
        if before is not None and (known := before.found()) is not None:
            found = Delivery(*known)
        else:
            document = requested_document(partial(_derived, data=form == "json"), source, options)
            found = delivery_of(document, form, strict=strict)
            if before is not None and found.code == 0 and document.certificate is not None and document.certificate.ok:
                before.keep(found.text, found.lines, found.code)
    return found.deliver(output)


@main.command("solve")
@with_form
@FOLLOW
@with_proof
def solve_command(**options: Any) -> int:
    """Answer every entry of [outputs], exactly and in numbers."""
    from eomgen.verbs import solve_document

    return write_requested(solve_document, **options)


@main.command("reactions")
@with_picture
@AT(help='The first instant after the start at which "theta=pi/2" holds; or "equilibrium".')
@FROM_REST(metavar="NAME=VALUE", help="Start there, all speeds 0.")
@FOLLOW
@VIEW(
    type=click.Choice(["polar", "resultants"]),
    help="What --plot draws: the force of each hinge by size and direction, or sizes over time.  [default: what fits]",
)
@DURATION(
    help="How much of the motion --plot draws.  [default: one turn of a drive]",
)
def reactions_command(**options: Any) -> int:
    """Give every reaction, as formulas or at an instant.

    Each has the name by which an output requests it, and the body on which it acts: as a function of coordinates and
    rates with its number at the start; with --at, exactly and as a number at that instant. --plot draws them along the
    motion from the start.
    """
    from eomgen.questions import reactions_document

    drawn = (options["plot"] is not None, OF_PLOT)
    refuse_idle(view=drawn, time=(drawn[0], "says how much --plot draws: give both"))
    return write_requested(reactions_document, **options)


@main.command("statics")
@with_picture
@click.option("--reaction", metavar="NAME", help='By virtual work only this one: "reaction_y(A)".')
@click.option("--influence", metavar="NAME", help='Its influence line too; also of "bending_moment(beam, L)".')
def statics_command(**options: Any) -> int:
    """Give reactions at rest by virtual work, or the equilibria.

    For a structure: if it is kinematically stable and, by rank, which part is not; every reaction by virtual work, with
    the mechanism that its release leaves, and by equilibrium; members of trusses; N, V and M along its beams. For a
    system that is free to move: its equilibria and their stability.
    """
    from eomgen.results import statics

    return write_result(statics, **options)


@main.command("kinematics")
@with_picture
@AT(help='The instant: the first after the start at which "theta=pi/2" holds.')
@click.option("--given", multiple=True, metavar="EQUATION", help='A velocity that is known: "omega(crank) = 2".')
@click.option(
    "--relative",
    multiple=True,
    metavar='"POINT in BODY"',
    help="Motion of a point on a moving body: transport, relative, Coriolis.",
)
def kinematics_command(**options: Any) -> int:
    """Give velocities and centres of rotation at one instant.

    For a mechanism in the position of its file, or a motion at its start or at an instant: mobility, centres of
    rotation with the lines on which they are found, angular velocities, velocities and accelerations of points, kinds
    of motion.
    """
    from eomgen.verbs import kinematics_requested

    return write_result(kinematics_requested, at_start=True, **options)


@main.command("inertia")
@with_picture
@click.option("--body", "bodies", multiple=True, metavar="NAME", help="Only this body.  [default: each, and the whole]")
@click.option("--about", metavar="POINT", help="About this point too.")
@click.option("--axis", metavar="A,B", help="About the axis through two points, or x, y, z through the point.")
def inertia_command(**options: Any) -> int:
    """Give masses, mass centres, moments of inertia, principal axes.

    For each body and for all together; for a body of parts, the contribution of each. The products of inertia have both
    signs: that of the tensor (minus) and that of textbooks (plus).
    """
    from eomgen.results import inertia

    return write_result(inertia, at_start=True, **options)


@main.command("linearize")
@with_picture
@click.option(
    "--about",
    type=click.Choice(["equilibrium", "start", "steady"]),
    help="Rest nearest to the start; the start, if its motion is steady; or the steady motion near "
    "it.  [default: see [linearize]]",
)
@click.option("--coordinate", "coordinates", multiple=True, metavar="NAME", help="Only these.  [default: all]")
@VIEW(
    type=click.Choice(["modes", "bode", "locus"]),
    default="modes",
    show_default=True,
    help="What --plot draws: the modes, Bode's diagrams, or the roots over a parameter.",
)
@OVER(help='Of --view locus: "k=100:1000:50", "log:k=1:100:50".')
def linearize_command(view: str, over: str | None, **options: Any) -> int:
    """Give small motions about rest or a steady motion.

    M, C and K with their parts, the state matrix, characteristic polynomial, frequencies, damping and shapes of the
    modes, stability with the conditions of Hurwitz, transfer functions from the inputs.
    """
    from eomgen.model import Range
    from eomgen.results import linearize

    refuse_idle(view=(options["plot"] is not None, OF_PLOT))
    if (over is not None) != (view == "locus"):
        raise click.UsageError('--view locus and --over "k=1:10:50" go together')

    in_full = form_requested(options["wants_json"], options["format_"], options["output"]) == "json"

    def found(model: Model, **requested: Any) -> Result:
        wanted, made = None if over is None else Range.of(model, over), linearize(model, **requested)
        return replace(made, modes=replace(made.modes, in_full=in_full), drawn=view, over=wanted)

    return write_result(found, at_start=options["about"] == "start", **options)


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
    help="Equations in a file, one a line; a derivation in .tex, .md, .ipynb; all files of a folder.",
)
@click.option(
    "--free-bodies",
    type=click.Path(exists=True, dir_okay=False),
    help="Forces on bodies cut free, a JSON list of {body, at, direction, kind, name}.",
)
@click.option("--derivation", is_flag=True, help="Each --file is a derivation, whatever its ending.")
@AT(help='The instant at which they hold: "theta=pi/2"; or "equilibrium".')
@FROM_REST(
    is_flag=False,
    flag_value=REST,
    metavar="[NAME=VALUE]",
    help="The motion starts there, all speeds 0; without a value where the file says.",
)
@click.option(
    "--kind",
    type=click.Choice(
        "motion energy force reaction velocity acceleration inertia frequency equilibrium statics law".split()
    ),
    help="Their subject.  [default: by their contents]",
)
@click.option("--to-first-order", is_flag=True, help="Of a motion the first order is enough: small angles.")
@click.option(
    "--about", metavar="PLACE", help='Of --to-first-order: beside "theta=0".  [default: 0, or an equilibrium]'
)
@click.option("--hint", type=click.IntRange(1, 3), help="Show 1 the place, 2 the quantity, 3 the cause of an error.")
@with_proof
def verify_command(from_rest: tuple[str, ...], **options: Any) -> int:
    """Judge equations that somebody derived: right, or why not.

    EQUATIONS are text or LaTeX (- reads them from stdin): equations of motion, T, V, Q(theta), reactions, any function
    that an output may ask, first integrals, the motion as a function of time. Exit 0 right, 5 wrong, 3 undecided.
    """
    from eomgen.verbs import verify_document

    placed = tuple(each for each in from_rest if each != REST)

    def judged(declared: Model, **requested: Any) -> Document:
        rest = requested.pop("from_rest", None) or ({} if from_rest else None)
        return verify_document(declared, from_rest=rest, **requested)

    return write_requested(judged, from_rest=placed, **options)


for verb in RUNS:
    main.add_command(verb)
