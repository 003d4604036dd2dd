"""PlayedRun -> its player as parts of a page, and as a page of its own, which asks nothing of anybody."""

from __future__ import annotations

import html
import json
import re
from dataclasses import dataclass
from importlib import resources

from eomgen.codegen.targets.javascript import javascript_expression
from eomgen.errors import visible
from eomgen.page.player_data import PlayedRun, PlayerOptions
from eomgen.simulation.result import Trajectory
from eomgen.version import __version__

SCRIPTS = ("integrator.mjs", "ties.mjs", "motion.mjs", "plane.mjs", "space.mjs", "player.mjs")
_MODULE_LINES = re.compile(r"^import .*\n|^export (?=const|class|function)", re.MULTILINE)

_PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="eomgen {version}">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<header><h1>{title}</h1><button type="button" id="theme">light or dark</button></header>
<main>{body}</main>
{script}
<script>
document.getElementById("theme").addEventListener("click", () => {{
    const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
}});
</script>
</body>
</html>
"""


@dataclass(frozen=True)
class PlayerParts:
    """What a page holds of a player.

    Args:
        style: style sheet; colours are the page's own variables (`colours.css`).
        body: where it stands.
        script: elements that come after the body.
    """

    style: str
    body: str
    script: str


def player_parts(run: Trajectory, options: PlayerOptions | None = None, identity: str = "player") -> PlayerParts:
    """The player of a run, to be put into a page.

    Args:
        identity: of its element; no two in a page are alike.
    """
    return _parts(PlayedRun(run, options or PlayerOptions()), identity, page=False)


def player_page(run: Trajectory, options: PlayerOptions | None = None) -> str:
    """The player of a run as a page."""
    played = PlayedRun(run, options or PlayerOptions())
    parts = _parts(played, "player", page=True)
    return _PAGE.format(
        version=__version__,
        title=html.escape(visible(played.model.name)),
        style=_asset("colours.css") + _asset("page.css") + parts.style,
        body=parts.body,
        script=parts.script,
    )


def _parts(played: PlayedRun, identity: str, *, page: bool) -> PlayerParts:
    told = json.dumps({**played.told(), "page": page}, separators=(",", ":"), allow_nan=False)
    for letter in "<>&\u2028\u2029":
        told = told.replace(letter, f"\\u{ord(letter):04x}")
    live = played.live
    needed = () if live is None else live.programs if played.options.moves and not played.rests else ("rate", "frame")
    programs = ",\n".join(f"{name}: {javascript_expression(live.programs[name])}" for name in needed) if live else ""
    text = "\n".join(_MODULE_LINES.sub("", _asset(name)) for name in SCRIPTS)
    begin = f'begun(document.getElementById("{identity}"), {told}, {{{programs}}});'
    body = f'<div class="eomgen-player" id="{identity}"></div>'
    return PlayerParts(_asset("player.css"), body, f"<script>\n(() => {{\n{_harmless(text)}\n{begin}\n}})();\n</script>")


def _asset(name: str) -> str:
    """A file of the player."""
    return resources.files("eomgen.page").joinpath("player", name).read_text(encoding="utf-8")


def _harmless(text: str) -> str:
    """A program that cannot end the element it stands in."""
    return text.replace("</script", "<\\/script").replace("<!--", "<\\!--")
