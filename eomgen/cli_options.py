"""Options that several verbs share, and the file endings that they write."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import click
from click.core import ParameterSource

from eomgen.symbolic.numeric import tolerances

OTHERS = (".html", ".htm", ".pdf", ".docx", ".doc", ".odt", ".png", ".svg", ".csv", ".npz", ".xlsx", ".ipynb", ".toml")
"""endings of files of other kinds: no text goes under their name, whatever --format says"""

FORMATS = {"": "text", ".txt": "text", ".tex": "latex", ".md": "markdown", ".json": "json"}
"""ending of a file -> the form of what is written into it"""

IN_FULL = "eomgen: every check of the proof"
PICTURES = (".png", ".svg", ".pdf")
OF_PLOT = "says what --plot draws: give both"
OF_TABLE = "says how the heads of a .csv are written: give -o too"
SOURCES = (".c", ".h", ".py", ".cpp", ".hpp", ".rs", ".f90", ".js", ".mjs", ".m", ".jl", ".zip", ".fmu")
"""endings of files that `codegen` makes, or might"""


def picture(context: click.Context, option: click.Parameter, path: str | None) -> str | None:
    """The path of a picture, refused before any work where it ends in something else.

    Raises:
        UsageError: it does.
    """
    if path is not None and Path(path).suffix.lower() not in PICTURES:
        raise click.UsageError(f"no picture can be written as '{path}': endings are {', '.join(PICTURES)}")
    return path


def folder(context: click.Context, option: click.Parameter, path: str | None) -> str | None:
    """The path of a folder; one that is not there and is called like a file is a mistake.

    Raises:
        UsageError: it is.
    """
    ending = Path(path or "").suffix.lower()
    if path and ending in (*filter(None, FORMATS), *OTHERS, *SOURCES) and not Path(path).exists():
        raise click.UsageError(f"'{path}' is called like a file: -o names the folder for the files")
    return path


def _keep(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    context.meta[IN_FULL] = wanted


def words(context: click.Context, option: click.Parameter, text: str | None) -> tuple[str, ...]:
    """The words of a list with commas."""
    return tuple(word.strip() for word in (text or "").split(",") if word.strip())


def refuse_beside(option: str, heeded: tuple[str, ...]) -> None:
    """Refuses what was typed together with an option and would have no effect.

    Raises:
        UsageError: something was; all of it is named.
    """
    context, by_hand = click.get_current_context(), ParameterSource.COMMANDLINE
    typed = [each for each in context.command.params if context.get_parameter_source(each.name or "") is by_hand]
    idle = [each.opts[-1] for each in typed if each.name not in heeded]
    if idle:
        raise click.UsageError(f"{option} takes no {', '.join(idle)}: leave that out")


def time_typed(typed: object) -> float:
    """A time: seconds, or a number with its unit, "500 ms".

    Raises:
        BadParameter: it is none.
    """
    from eomgen.errors import UsageError
    from eomgen.model import seconds

    try:
        return seconds(typed)
    except UsageError as error:
        raise click.BadParameter(f"{error.what}; {error.fix}") from None


def refuse_other_endings(path: str, endings: tuple[str, ...], what: str, fix: str = "name it so") -> None:
    """Refuses the name of a file that has none of these endings, before any work.

    Raises:
        UsageError: it has another; `what` says that, `fix` names those.
    """
    from eomgen.errors import UsageError

    if Path(path).suffix.lower() not in endings:
        raise UsageError(what, fix=fix)


def refuse_idle(**heeded: tuple[bool, str]) -> None:
    """Refuses what was typed and would change nothing.

    Args:
        heeded: {name of the option's argument: (whether it changes something, what it is for)}.
    Raises:
        UsageError: such a one was typed.
    """
    context, by_hand = click.get_current_context(), ParameterSource.COMMANDLINE
    for parameter in context.command.params:
        changes, purpose = heeded.get(parameter.name or "", (True, ""))
        if not changes and context.get_parameter_source(parameter.name or "") is by_hand:
            raise click.UsageError(f"{max(parameter.opts, key=len)} {purpose}")


MODEL = click.argument("model", type=click.Path(exists=True, dir_okay=False, allow_dash=True))
JSON = click.option("--json", "wants_json", is_flag=True, help="Write the result for machines.")
WRITTEN = partial(click.option, "-o", "--output", type=click.Path(dir_okay=False))  # its help says what is written
OUTPUT = WRITTEN(help="Write the result into a file.")
FORMAT = click.option(
    "--format",
    "format_",
    type=click.Choice(["text", "latex", "markdown", "json"]),
    help="Form of the result.  [default: by the ending of -o, else text]",
)
PLOT = click.option("--plot", type=click.Path(dir_okay=False), callback=picture, help="Draw it as .png, .svg or .pdf.")
NO_CERTIFICATE = click.option(
    "--no-certify", "certify", is_flag=True, flag_value=False, default=True, help="Make no proof."
)
CERTIFICATE = click.option(
    "--certificate", is_flag=True, expose_value=False, callback=_keep, help="Print every check of the proof."
)


def with_proof(function: Callable[..., int]) -> Callable[..., int]:
    """Options of what has a proof."""
    return NO_CERTIFICATE(CERTIFICATE(function))


def proven_in_full() -> bool:
    """True if every check of the proof is to be printed."""
    context = click.get_current_context(silent=True)
    return bool(context is not None and context.meta.get(IN_FULL))


WAY = click.option(
    "--method",
    type=click.Choice(["lagrange", "projection", "kinetostatic"]),
    default="lagrange",
    show_default=True,
    help="By energies, by projection, or body by body with every reaction.",
)
LANGUAGE = click.option(
    "--language",
    default="",
    metavar="NAME",
    help="en, de, fr, es, or a .po file.  [default: the file's, else en]",
)
DURATION = partial(click.option, "--time", type=time_typed, metavar="TIME")
TIME = DURATION(default=10.0, show_default=True, help='How long: 5 is in s, or "500 ms".')
PAGE_TIME = DURATION(help='How long: 5 is in s, or "500 ms".  [default: three periods, until it rests, or 10 s]')
AT = partial(click.option, "--at", metavar="EQUATION")
FROM_REST = partial(click.option, "--from-rest", multiple=True)
VIEW = partial(click.option, "--view")
UNITS = partial(click.option, "--units", is_flag=True)
OVER = partial(click.option, "--over", metavar="RANGE")
SAMPLES = partial(click.option, "--samples", type=click.IntRange(min=2))
BAUMGARTE = partial(click.option, "--baumgarte", nargs=2, type=float, metavar="ALPHA BETA")
RTOL = click.option(
    "--rtol", type=float, default=tolerances.RUN, show_default=True, help="Relative tolerance of a run."
)
ATOL = click.option(
    "--atol", type=float, default=tolerances.RUN, show_default=True, help="Absolute tolerance of a run."
)
SPEED = click.option("--speed", type=float, default=1.0, show_default=True, help="Seconds of the motion in a second.")
TRAIL = partial(click.option, "--trail", metavar="POINT")
FORCES = partial(click.option, "--forces", is_flag=True)
FOLLOW = click.option(
    "--follow",
    multiple=True,
    metavar="NAME=FILE",
    help="Drive a coordinate or an input through the samples of a CSV file.",
)


SET = click.option(
    "--set",
    "set_",
    multiple=True,
    metavar="NAME=VALUE",
    help='Another value of a parameter: "45", in the unit of the file, or "45 deg".',
)
START = click.option(
    "--start", multiple=True, metavar="NAME=VALUE", help="Another start of a coordinate, rate or speed."
)


def variants(context: click.Context, option: click.Parameter, text: str | None) -> int | range | None:
    """The number of a variant; of a report also several, "1:30".

    Raises:
        BadParameter: it is none.
    """
    if text is None:
        return None
    first, colon, last = text.partition(":")
    if not (first.isdecimal() and (last.isdecimal() or not colon)) or (colon and int(last) < int(first)):
        raise click.BadParameter(f"'{text}' is no number of a variant: write 7, or 1:30 for a class", context, option)
    if colon and context.info_name != "report":
        raise click.BadParameter("several variants are written by `eomgen report`", context, option)
    return range(int(first), int(last) + 1) if colon else int(first)


VARIANT = click.option(
    "--variant", callback=variants, metavar="N", help="Draw the data of this variant from the file's ranges."
)
STRICT = click.option("--strict", is_flag=True, help="Warnings end in exit 1.")


def with_values(function: Callable[..., int]) -> Callable[..., int]:
    """Options of all that computes."""
    return SET(START(VARIANT(STRICT(function))))


def with_form(function: Callable[..., int]) -> Callable[..., int]:
    """Options of every result of a model."""
    return MODEL(JSON(OUTPUT(FORMAT(with_values(function)))))


def with_picture(function: Callable[..., int]) -> Callable[..., int]:
    """Options of what has a picture and a proof, too."""
    return with_form(PLOT(with_proof(function)))


def form_requested(wants_json: bool, format_: str | None, output: str | None = None) -> str:
    """The requested form, else that of the ending of the file.

    Raises:
        UsageError: no form has that ending.
    """
    ending = Path(output or "").suffix.lower()
    requested = "json" if wants_json else format_
    if ending in OTHERS or (ending not in FORMATS and not requested):
        known = ", ".join(filter(None, FORMATS))
        other = "" if ending in OTHERS else "; or say --format"
        raise click.UsageError(f"'{output}' ends in no form that is known here: {known}{other}")
    return requested or FORMATS[ending]
