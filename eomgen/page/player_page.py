"""PlayedRun -> its player as parts of a page, and as a page of its own, which asks nothing of anybody."""

from __future__ import annotations

import html
import json
import re
from importlib import resources
from typing import Any, Protocol

from eomgen.codegen.targets.javascript import javascript_expression
from eomgen.errors import ToolMissing, visible
from eomgen.model.parts import Model
from eomgen.page.live import Live
from eomgen.page.markup import in_a_script, packed
from eomgen.page.player_data import PlayedRun, PlayerOptions
from eomgen.records import dataclass
from eomgen.simulation.result import Trajectory
from eomgen.version import __version__

SCRIPTS = ("columns.mjs", "integrator.mjs", "ties.mjs", "motion.mjs", "plane.mjs", "space.mjs", "player.mjs")
IN_SPACE = "space.mjs"
_LAID_OUT = re.compile(r"\n +")

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


_UNPACKED = """\
(async () => {{
    try {{
        const bytes = Uint8Array.from(atob("{packed}"), c => c.charCodeAt(0));
        const text = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
        new Function(text)();
    }} catch (error) {{
        document.getElementById("{identity}").textContent = `No motion in this browser: ${{error.message}}.`;
    }}
}})();"""
"""A program among other things of a page: packed, it takes half or less."""


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


class Playable(Protocol):
    """What a player shows.

    Attributes:
        live: the model as the page evaluates it, or None: what was computed is played.
        moves: whether it lives in the page.
    """

    @property
    def model(self) -> Model: ...
    @property
    def live(self) -> Live | None: ...
    @property
    def moves(self) -> bool: ...
    def told(self) -> dict[str, Any]: ...


def player_page(run: Trajectory, options: PlayerOptions | None = None) -> str:
    """The player of a run as a page."""
    return player_page_of(PlayedRun(run, options or PlayerOptions()))


def player_page_of(played: Playable) -> str:
    """A player as a page."""
    parts = player_parts_of(played, "player", page=True)
    return _PAGE.format(
        version=__version__,
        title=html.escape(visible(played.model.name)),
        style=_asset("colours.css") + _asset("page.css") + parts.style,
        body=parts.body,
        script=parts.script,
    )


def player_parts_of(played: Playable, identity: str, *, page: bool = False) -> PlayerParts:
    """A player, to be put into a page, or alone in one."""
    library = {} if played.model.space == "plane" else {"three": three_js()}
    told = json.dumps({**played.told(), **library, "page": page}, separators=(",", ":"), allow_nan=False)
    for letter in "<>&\u2028\u2029":
        told = told.replace(letter, f"\\u{ord(letter):04x}")
    live = played.live
    needed = () if live is None else live.programs if played.moves else ("begin", "rate", "frame")
    programs = ",\n".join(f"{name}: {javascript_expression(live.programs[name])}" for name in needed) if live else ""
    programs = _LAID_OUT.sub("\n", programs)
    text = "\n".join(in_a_script(_asset(name)) for name in SCRIPTS if library or name != IN_SPACE)
    begin = f'begun(document.getElementById("{identity}"), {told}, {{{programs}}});'
    body = f'<div class="eomgen-player" id="{identity}"></div>'
    whole = f"(() => {{\n{_harmless(text)}\n{begin}\n}})();"
    if not page:
        whole = _UNPACKED.format(packed=packed(whole.encode()), identity=identity)
    return PlayerParts(_asset("player.css"), body, f"<script>\n{whole}\n</script>")


def three_js() -> str:
    """The library that draws in space: its text, gzip, then base64.

    Raises:
        ToolMissing: it is not installed.
    """
    try:
        folder = resources.files("jupyter_threejs_sage")
    except ModuleNotFoundError:
        mend = "pip install 'eomgen[space]'"
        raise ToolMissing("there is no library for pictures in space in a page", mend=mend) from None
    return packed(folder.joinpath("static", "r130", "three.min.js").read_bytes())


def _asset(name: str) -> str:
    """A file of the player."""
    return resources.files("eomgen.page").joinpath("player", name).read_text(encoding="utf-8")


def _harmless(text: str) -> str:
    """A program that cannot end the element it stands in."""
    return text.replace("</script", "<\\/script").replace("<!--", "<\\!--")
