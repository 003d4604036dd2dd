"""The gallery: a page for each model of models/, made by eomgen itself: picture, equations, answers, file.

EOMGEN_GALLERY=quick makes the pages of a few models. A page is made again where its model or eomgen has changed.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any

from papers import write

import eomgen
from eomgen.documents import markdown
from eomgen.documents.document import Document
from eomgen.page.figure import rest_figure
from eomgen.page.player import player_page
from eomgen.page.report import Subject

ROOT = Path(__file__).parents[2]
MODELS = ROOT / "models"
PLACE = ROOT / "docs" / "gallery"
# what moves, what stands, a mechanism, a seed
QUICK = ("double_pendulum", "gerber_beam", "quick_return", "seeds/ch13_p2")
PATIENCE = 60.0  # seconds of one model
LONGEST = 4000  # letters of a section
SECONDS = 6.0  # of a motion
MOTION = "<iframe class='gallery-motion' title='The motion of {title}' src='{file}' loading='lazy'></iframe>"
GROUPS = {"": "Models", "seeds": "Exercises of a textbook"}


def chosen() -> list[str]:
    """The models, by their path below models/ without its ending."""
    every = sorted(path.relative_to(MODELS).with_suffix("").as_posix() for path in MODELS.rglob("*.toml"))
    return [name for name in every if os.environ.get("EOMGEN_GALLERY") != "quick" or name in QUICK]


def version_of_package() -> str:
    """Changes with any line of eomgen."""
    found = hashlib.sha256()
    for path in sorted((ROOT / "eomgen").rglob("*.py")):
        found.update(path.read_bytes())
    return found.hexdigest()[:16]


def cut(document: Document, keys: tuple[str, ...]) -> str:
    """Some sections of a document in Markdown."""
    steps = tuple(step for step in document.steps if step.key in keys)
    text = markdown.render(replace(document, steps=steps, about="", source="", certificate=None))
    return text.partition("\n")[2].strip() if steps else ""


def equations(model: eomgen.Model) -> str:
    """Of what moves."""
    return cut(eomgen.derive(model).derivation, ("equations", "integrals"))


def reactions(model: eomgen.Model) -> str:
    """Of what stands."""
    return cut(eomgen.statics(model).derivation, ("structure", "reactions", "agreement"))


def velocities(model: eomgen.Model) -> str:
    """Of a mechanism at its instant."""
    return cut(eomgen.kinematics(model).derivation, ("centers", "velocities", "accelerations"))


def moments(model: eomgen.Model) -> str:
    """Of bodies alone."""
    derivation = eomgen.inertia(model).derivation
    return cut(derivation, tuple(step.key for step in derivation.steps if step.key.startswith("inertia")))


AT_REST = {"statics": reactions, "kinematics": velocities, "inertia": moments}  # as a report chooses


def answers(model: eomgen.Model) -> str:
    """What the file asks, and what comes out."""
    rows = [answer_row(name, answer) for name, answer in eomgen.solve(model).items()]
    return "\n".join(["## What the file asks", "", "| output | exact | value |", "|---|---|---|", *rows])


def answer_row(name: str, answer: eomgen.Answer) -> str:
    """A line of the table; a bar inside code would end its cell."""
    value = "" if answer.value is None else f"{answer.value:.6g} {answer.unit or ''}".strip()
    exact = (answer.exact or "").replace("|", "\\|")
    return f"| `{name}` | {f'`{exact}`' if 0 < len(exact) < 200 else ''} | {value} |"


def parts_of(model: eomgen.Model) -> Iterator[Callable[[eomgen.Model], str]]:
    """What a page tells of a model, besides its picture and its file."""
    has_mass = any(body.mass is not None or body.shape is not None for body in model.bodies.values())
    free = any(coordinate.motion is None for coordinate in model.coordinates.values())
    if free and has_mass:
        yield equations
    elif model.coordinates:
        yield velocities
    elif model.bodies or model.trusses:
        yield AT_REST[Subject(model, 0.0, certify=False, origin="", source="").main[0]]
    if model.outputs:
        yield answers


def reported(part: Callable[[eomgen.Model], str], model: eomgen.Model) -> str:
    """A section; where a verb refuses, its own words."""
    try:
        with eomgen.patience(PATIENCE):
            text = part(model)
    except (eomgen.EomgenError, eomgen.OutOfPatience) as error:
        return f"eomgen says: {markdown.markdown_escaped(str(error).splitlines()[0])}"
    return text if len(text) <= LONGEST else "It is long: the verbs below print all of it."


def moves(model: eomgen.Model) -> bool:
    """Whether there is something to be seen of its motion."""
    return any(body.mass is not None or body.shape is not None for body in model.bodies.values()) and bool(
        model.coordinates
    )


def shown(model: eomgen.Model, path: Path) -> list[str]:
    """The picture, and where it moves the motion; their files stand beside the page."""
    found = []
    try:
        with eomgen.patience(PATIENCE):
            rest_figure(model).save(path.with_suffix(".svg"))
            found.append(f"```{{image}} {path.stem}.svg\n:class: gallery-picture\n:alt: {model.name} at rest\n```")
            if moves(model):
                run = eomgen.simulate(model, time=SECONDS, samples=301)
                write(path.with_suffix(".motion.html"), player_page(run))
                frame = MOTION.format(title=escape(model.name, quote=True), file=f"{path.stem}.motion.html")
                found.append(f"```{{raw}} html\n{frame}\n```")
    except (eomgen.EomgenError, eomgen.OutOfPatience) as error:
        found.append(f"eomgen says: {markdown.markdown_escaped(str(error).splitlines()[0])}")
    return found


def page(name: str) -> str:
    """The Markdown of a model; its picture and its motion are written beside it."""
    model = eomgen.load(MODELS / f"{name}.toml")
    up = "../" * (name.count("/") + 2)
    remarks = (model.about or "", f"Source: {model.source}." if model.source else "")
    blocks = [f"# {markdown.markdown_escaped(model.name)}", *map(markdown.markdown_escaped, filter(None, remarks))]
    blocks += shown(model, PLACE / f"{name}.md")
    blocks += filter(None, (reported(part, model) for part in parts_of(model)))
    blocks.append(f"## Its file\n\n```{{literalinclude}} {up}models/{name}.toml\n:language: toml\n```")
    blocks.append(f"A copy to work on: `eomgen new mine --example {Path(name).name}`.")
    return "\n\n".join(blocks) + "\n"


def contents(names: list[str]) -> str:
    """The page that lists all others."""
    blocks = ["# Gallery", "Every model that ships, worked out by eomgen itself when this site was built."]
    for folder, title in GROUPS.items():
        here = [name for name in names if str(Path(name).parent.as_posix()).removeprefix(".") == folder]
        listed, cards = "\n".join(here), "\n\n".join(map(card, here))
        tree = f"```{{toctree}}\n:hidden:\n\n{listed}\n```"
        blocks += [f"## {title}\n\n{tree}\n\n:::{{container}} shelf\n{cards}\n:::"] if here else []
    return "\n\n".join(blocks) + "\n"


def card(name: str) -> str:
    """The picture of a model, where there is one, and its name, which lead to its page."""
    title = (PLACE / f"{name}.md").read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
    drawn = f"![]({name}.svg) " if (PLACE / f"{name}.svg").exists() else ""
    return f"[{drawn}{title}]({name}.md)"


def generate(app: Any) -> None:
    """All pages that are not there as they must be."""
    names, version = chosen(), version_of_package()
    for name in names:
        path = PLACE / f"{name}.md"
        stamp = path.with_suffix(".made")
        made = hashlib.sha256(version.encode() + (MODELS / f"{name}.toml").read_bytes()).hexdigest()
        if not path.exists() or not stamp.exists() or stamp.read_text() != made:
            path.parent.mkdir(parents=True, exist_ok=True)
            write(path, page(name))
            stamp.write_text(made)
    for path in PLACE.rglob("*.md"):
        if path.relative_to(PLACE).with_suffix("").as_posix() not in [*names, "index"]:
            path.unlink()
    write(PLACE / "index.md", contents(names))


def put_motions(app: Any, failed: Exception | None) -> None:
    """The pages of motions stand beside the pages of their models."""
    for path in PLACE.rglob("*.motion.html") if failed is None else ():
        to = Path(app.outdir) / "gallery" / path.relative_to(PLACE)
        if to.with_name(path.name.replace(".motion", "")).exists():
            shutil.copy(path, to)


def setup(app: Any) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.connect("builder-inited", generate)
    app.connect("build-finished", put_motions)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
