"""The command line: verbs, their options, and the conventions that all of them share. No physics.

Results go to stdout, everything else to stderr. Exit codes: 0 ok, 1 the model is wrong, 2 usage,
3 derivation or run failed, 4 an optional tool is missing. What a verb needs is imported inside it.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eomgen.errors import EomgenError, ModelError, Problem, ToolMissing
from eomgen.version import __version__

if TYPE_CHECKING:
    from eomgen.model.parts import Model
    from eomgen.verbs.outcome import Outcome

SCHEMA_VERSION = 1
INTERRUPTED = 130  # as a shell has it for Ctrl-C
CLOSED_PIPE = 141  # as a shell has it for a reader that went away
LATER = ("verify", "sweep")
FORMATS = {".tex": "latex", ".md": "markdown", ".json": "json"}


class Verbs(click.Group):
    """The group of all verbs: what goes wrong in any of them becomes a message and an exit code."""

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        name = args[0]
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            raise click.UsageError(_unknown_verb(name, self.list_commands(ctx)), ctx)
        return super().resolve_command(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)  # in the order in which they are used

    def main(
        self, args: Sequence[str] | None = None, prog_name: str | None = None, complete_var: str | None = None,
        standalone_mode: bool = True, **extra: Any,
    ) -> Any:  # fmt: skip
        words = list(sys.argv[1:] if args is None else args)
        name = prog_name or "eomgen"
        if not standalone_mode:
            return super().main(words, name, complete_var, standalone_mode=False, **extra)
        sys.exit(self._run(words, name, complete_var, extra))

    def _run(self, words: list[str], name: str, complete_var: str | None, extra: dict[str, Any]) -> int:
        wants_json = "--json" in words
        try:
            return super().main(words, name, complete_var, standalone_mode=False, **extra) or 0
        except click.ClickException as error:
            error.show()
            return _told(error.exit_code, (Problem("", error.format_message()),), wants_json)
        except EomgenError as error:
            return self._failed(error.exit_code, _problems(error), wants_json)
        except _Placed as error:
            return self._failed(error.exit_code, error.problems, wants_json)
        except ModuleNotFoundError as error:
            if (error.name or "").split(".")[0] == "eomgen":
                raise
            missing = ToolMissing(f"the package '{error.name}' is not installed", mend=f"pip install {error.name}")
            return self._failed(missing.exit_code, _problems(missing), wants_json)
        except (click.Abort, KeyboardInterrupt):
            return INTERRUPTED

    def _failed(self, code: int, problems: tuple[Problem, ...], wants_json: bool) -> int:
        click.echo("\n\n".join(str(problem) for problem in problems), err=True)
        return _told(code, problems, wants_json)


class _Placed(Exception):
    """What went wrong with a model, at its places in the file."""

    def __init__(self, exit_code: int, problems: tuple[Problem, ...]) -> None:
        self.exit_code, self.problems = exit_code, problems


def _unknown_verb(name: str, verbs: list[str]) -> str:
    import difflib

    if name in LATER:
        return f"'{name}' comes with a later version."
    near = difflib.get_close_matches(name, verbs, n=1)
    return f"There is no command '{name}'." + (f" Did you mean '{near[0]}'?" if near else "")


def _problems(error: EomgenError) -> tuple[Problem, ...]:
    if isinstance(error, ModelError):
        return error.problems
    return (Problem(error.where, error.what, mend=error.mend),)


def _told(code: int, problems: tuple[Problem, ...], wants_json: bool) -> int:
    """The problems for machines, where they are asked for."""
    if wants_json:
        error = {"exit_code": code, "problems": [_as_dict(problem) for problem in problems]}
        _say(json.dumps({"schema_version": SCHEMA_VERSION, "error": error}, ensure_ascii=False, indent=1) + "\n")
    return code


def _as_dict(problem: Problem) -> dict[str, Any]:
    """A problem with its place taken apart: file, line and column where there are any."""
    file, line, column = (*problem.where.rsplit(":", 2), "", "")[:3]
    placed = line.isdigit() and column.isdigit()
    return {
        "where": problem.where, "file": file if placed else None, "line": int(line) if placed else None,
        "column": int(column) if placed else None, "what": problem.what, "excerpt": problem.excerpt,
        "mend": problem.mend,
    }  # fmt: skip


def _say(text: str) -> None:
    """On stdout; a reader that went away ends the program quietly."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left in the buffer goes nowhere
        sys.exit(CLOSED_PIPE)


def _deliver(outcome: Outcome, wants_json: bool, output: str | None = None) -> int:
    """The result to stdout or into a file, the rest to stderr; the exit code."""
    from eomgen.verbs.outcome import write_text

    result = outcome.json if wants_json else outcome.text
    if output is None:
        _say(result)
    else:
        write_text(output, result)
    for line in (*outcome.notes, outcome.failed):
        if line:
            click.echo(line, err=True)
    return 3 if outcome.failed else 0


@contextmanager
def _reading(path: str) -> Iterator[Model]:
    """The model of a file (- is stdin); what a verb finds wrong with one of its parts is told at its place there."""
    from eomgen.model.reader import load, loads, located

    data = sys.stdin.buffer.read() if path == "-" else None
    try:
        yield load(path) if data is None else loads(data, "<stdin>")
    except EomgenError as error:
        text = data if data is not None else Path(path).read_bytes() if os.access(path, os.R_OK) else b""
        name = path if data is None else "<stdin>"
        problems = tuple(located(problem, text, name) for problem in _problems(error))
        raise _Placed(error.exit_code, problems) from error


# -- the verbs -------------------------------------------------------------------------------------

MODEL = click.argument("model", type=click.Path(exists=True, dir_okay=False, allow_dash=True))
JSON = click.option("--json", "wants_json", is_flag=True, help="Write the result for machines.")
OUTPUT = click.option("-o", "--output", type=click.Path(dir_okay=False), help="Write the result into a file.")


def _common(function: Callable[..., int]) -> Callable[..., int]:
    return MODEL(JSON(OUTPUT(function)))


def _written(function: Callable[..., int]) -> Callable[..., int]:
    """Options of what is written step by step, and drawn."""
    format_ = click.option("--format", "format_", type=click.Choice(["text", "latex", "markdown", "json"]),
                           help="Form of the result.  [default: by the ending of -o, else text]")  # fmt: skip
    plot = click.option("--plot", type=click.Path(dir_okay=False), help="Draw it as .png, .svg or .pdf.")
    return _common(format_(plot(function)))


def _form(wants_json: bool, format_: str | None, output: str | None) -> str:
    """The form of a result: as asked, else by the ending of the file."""
    return "json" if wants_json else format_ or FORMATS.get(Path(output or "").suffix.lower(), "text")


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="eomgen")
def main() -> None:
    """Mechanical systems: equations of motion, reactions, structures at rest, mechanisms; exact, step by step.

    MODEL is a text file that declares the system (- reads it from stdin); begin with `eomgen new NAME`.
    """


@main.command()
@click.argument("name")
@JSON
def new(name: str, wants_json: bool) -> int:
    """Write a commented starter model NAME.toml."""
    from eomgen.verbs.new import new as made

    return _deliver(made(name), wants_json)


@main.command()
@_common
def check(model: str, wants_json: bool, output: str | None) -> int:
    """Validate a model; count its degrees of freedom."""
    from eomgen.verbs.check import check as checked

    with _reading(model) as declared:
        outcome = checked(declared)
    return _deliver(outcome, wants_json, output)


@main.command()
@_common
@click.option("--method", type=click.Choice(["lagrange", "projection", "kinetostatic"]), default="lagrange",
              show_default=True, help="By energies, by projection, or body by body with every reaction.")  # fmt: skip
@click.option("--format", "format_", type=click.Choice(["text", "latex", "markdown", "json"]),
              help="Form of the result.  [default: by the ending of -o, else text]")  # fmt: skip
@click.option("--full", is_flag=True, help="Print everything, however long, with names for the long parts.")
@click.option("--no-certify", is_flag=True, help="Make no certificate.")
def derive(
    model: str, wants_json: bool, output: str | None, method: str, format_: str | None, full: bool, no_certify: bool
) -> int:
    """Derive the equations of motion and certify them."""
    from eomgen.verbs.derive import derive as derived

    form = _form(wants_json, format_, output)
    with _reading(model) as declared:
        outcome = derived(declared, method=method, format=form, certify=not no_certify, full=full)
    return _deliver(outcome, form == "json", output)


@main.command()
@_common
def solve(model: str, wants_json: bool, output: str | None) -> int:
    """Answer every entry of [outputs], exactly and in numbers."""
    from eomgen.verbs.solve import solve as solved

    with _reading(model) as declared:
        outcome = solved(declared)
    return _deliver(outcome, wants_json, output)


@main.command()
@_common
@click.option("--at", metavar="EQUATION",
              help='The first instant after the start at which "theta=pi/2" holds; or "equilibrium".')  # fmt: skip
@click.option("--from-rest", multiple=True, metavar="NAME=VALUE", help="Start there, all speeds 0.")
def reactions(
    model: str, wants_json: bool, output: str | None, at: str | None, from_rest: tuple[str, ...]
) -> int:
    """Give every reaction, as formulas or at an instant.

    Each stands under the name by which an output asks for it, and with the body on which it acts: as a function of
    coordinates and rates with its number at the start; with --at, exactly and as a number at that instant.
    """
    from eomgen.verbs.reactions import reactions as found

    with _reading(model) as declared:
        outcome = found(declared, at=at, from_rest=from_rest)
    return _deliver(outcome, wants_json, output)


@main.command()
@_written
@click.option("--reaction", metavar="NAME", help='By virtual work only this one: "reaction_y(A)".')
@click.option("--influence", metavar="NAME", help='Its influence line too; also of "bending_moment(beam, L)".')
def statics(model: str, wants_json: bool, output: str | None, format_: str | None, plot: str | None,
            **options: Any) -> int:  # fmt: skip
    """Give reactions at rest by virtual work, or the places of rest.

    Of a structure: whether it stands, and by rank which part does not; every reaction by virtual work, with the
    mechanism that is left when it is released, and by equilibrium; members of trusses; N, V and M along its beams. Of a
    system that is free to move: where it is at rest, and whether that is stable.
    """
    from eomgen.verbs.statics import statics as found

    form = _form(wants_json, format_, output)
    with _reading(model) as declared:
        outcome = found(declared, format=form, plot=plot, **options)
    return _deliver(outcome, form == "json", output)


@main.command()
@_written
@click.option("--at", metavar="EQUATION", help='The instant: the first after the start at which "theta=pi/2" holds.')
@click.option("--given", multiple=True, metavar="EQUATION", help='A velocity that is known: "omega(crank) = 2".')
@click.option("--relative", multiple=True, metavar='"POINT in BODY"',
              help="Motion of a point on a moving body: transport, relative, Coriolis.")  # fmt: skip
def kinematics(model: str, wants_json: bool, output: str | None, format_: str | None, plot: str | None,
               **options: Any) -> int:  # fmt: skip
    """Give velocities and centres of rotation at one instant.

    Of a mechanism in the one position of its file, or of a motion at its start or at an instant: mobility, centres of
    rotation with the lines on which they are found, spins, velocities and accelerations of points, kinds of motion.
    """
    from eomgen.verbs.kinematics import kinematics as found

    form = _form(wants_json, format_, output)
    with _reading(model) as declared:
        outcome = found(declared, format=form, plot=plot, **options)
    return _deliver(outcome, form == "json", output)


@main.command()
@_written
@click.option("--body", "bodies", multiple=True, metavar="NAME", help="Only this body.  [default: each, and the whole]")
@click.option("--about", metavar="POINT", help="About this point too.")
@click.option("--axis", metavar="A,B", help="About the axis through two points, or x, y, z through the point.")
def inertia(model: str, wants_json: bool, output: str | None, format_: str | None, plot: str | None,
            **options: Any) -> int:  # fmt: skip
    """Give masses, mass centres, moments of inertia, principal axes.

    Of each body and of all together; of a body of parts what each adds. Both signs of the products are given: of the
    tensor (minus) and of the textbook (plus).
    """
    from eomgen.verbs.inertia import inertia as found

    form = _form(wants_json, format_, output)
    with _reading(model) as declared:
        outcome = found(declared, format=form, plot=plot, **options)
    return _deliver(outcome, form == "json", output)


@main.command()
@_written
@click.option("--about", type=click.Choice(["equilibrium", "start"]),
              help="The nearest place of rest, or the start, a steady motion.  [default: see [linearize]]")  # fmt: skip
@click.option("--coordinate", "coordinates", multiple=True, metavar="NAME", help="Only these.  [default: all]")
def linearize(model: str, wants_json: bool, output: str | None, format_: str | None, plot: str | None,
              **options: Any) -> int:  # fmt: skip
    """Give small motions about rest or a steady motion.

    M, C and K with their parts, the state matrix, characteristic polynomial, frequencies, damping and shapes of the
    modes, stability with the conditions of Hurwitz, transfer functions from the inputs.
    """
    from eomgen.verbs.linearize import linearize as found

    form = _form(wants_json, format_, output)
    with _reading(model) as declared:
        outcome = found(declared, format=form, plot=plot, **options)
    return _deliver(outcome, form == "json", output)


@main.command()
@MODEL
@JSON
@click.option("-o", "--output", type=click.Path(dir_okay=False), help="Write the trajectory as .csv or .npz.")
@click.option("--plot", type=click.Path(dir_okay=False), help="Draw it as .png, .svg or .pdf.")
@click.option("--time", type=float, default=10.0, show_default=True, help="How long [s].")
@click.option("--set", "given", multiple=True, metavar="NAME=VALUE", help="Another value of a parameter.")
@click.option("--start", multiple=True, metavar="NAME=VALUE", help="Another start of a coordinate or rate.")
@click.option("--rtol", type=float, default=1e-9, show_default=True, help="Relative tolerance of a step.")
@click.option("--atol", type=float, default=1e-9, show_default=True, help="Absolute tolerance of a step.")
@click.option("--samples", type=click.IntRange(min=2), help="How many instants are given.  [default: 1001]")
@click.option("--target", type=click.Choice(["numpy", "c"]), help="What runs the equations.  [default: the fastest]")
def simulate(model: str, wants_json: bool, output: str | None, **options: Any) -> int:
    """Integrate the motion from the start values.

    It goes on through every change of contact: what opens, closes, slides or sticks. Reactions are columns.
    """
    from eomgen.verbs.simulate import simulate as simulated

    with _reading(model) as declared:
        outcome = simulated(declared, output=output, **options)
    if output and not wants_json:
        click.echo(outcome.text, err=True, nl=False)
        return _deliver(type(outcome)("", failed=outcome.failed, notes=outcome.notes), False)
    return _deliver(outcome, wants_json)


@main.command()
@MODEL
@JSON
@click.option("--target", type=click.Choice(["numpy", "c"]), default="c", show_default=True, help="Language.")
@click.option("-o", "--output", required=True, metavar="DIR", type=click.Path(file_okay=False), help="Where to.")
def codegen(model: str, wants_json: bool, target: str, output: str) -> int:
    """Write equations and reactions as code, with test vectors."""
    from eomgen.verbs.codegen import codegen as generated

    stem = "model" if model == "-" else Path(model).stem
    with _reading(model) as declared:
        outcome = generated(declared, stem=stem, origin=Path(model).name, target=target, directory=output)
    return _deliver(outcome, wants_json)


@main.command()
@JSON
@OUTPUT
def schema(wants_json: bool, output: str | None) -> int:
    """Write the JSON Schema of a model file, for editors."""
    from eomgen.verbs.schema import schema as written

    return _deliver(written(), wants_json, output)


@main.command()
@JSON
@OUTPUT
def doctor(wants_json: bool, output: str | None) -> int:
    """Tell what this machine can do."""
    from eomgen.verbs.doctor import doctor as examined

    return _deliver(examined(), wants_json, output)
