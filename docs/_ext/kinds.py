"""Pages of the reference: one for each joint, constraint, force, shape and output function, from its class.

What a kind is comes from its class (docstring, fields and their rules) and from the reference's lines on it; its
example is docs/examples/KIND.toml, and the picture, the counts and the equations are what eomgen makes of that file.
EOMGEN_GALLERY=quick makes a few pages.
"""

from __future__ import annotations

import os
import re
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any

from gallery import answer_row, parts_of, reported
from papers import linked, papers, write
from reference import PLACE as REFERENCE
from reference import REGION, SEAMS, fields_table, gist, prose, safe

import eomgen
from eomgen.mechanics.free_bodies.wrenches import Axes
from eomgen.model import outputs
from eomgen.model.outputs.base import OutputFunction, OutputSource
from eomgen.page.figure import rest_figure
from eomgen.simulation import WholeRun

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "docs" / "examples"
PLACE, FUNCTIONS = REFERENCE / "kinds", REFERENCE / "functions"
QUICK = ("revolute", "screw", "rolling", "clamp", "spring", "cone", "vx", "period")


def kinds() -> dict[str, str]:
    """Kind -> the section of the reference in which it stands."""
    return {cls.kind: seam for seam, members in SEAMS.items() for cls in members}


def class_of(kind: str) -> type[Any]:
    """Its class."""
    return next(cls for members in SEAMS.values() for cls in members if cls.kind == kind)


def chosen() -> list[str]:
    """The kinds that get a page."""
    return [kind for kind in kinds() if os.environ.get("EOMGEN_GALLERY") != "quick" or kind in QUICK]


# -- what the reference says -------------------------------------------------------------------------


def sayings(kind: str, seam: str) -> list[str]:
    """What people wrote in the reference on a kind: the items and paragraphs that begin with it, made tables apart."""
    text = REGION.sub("", (REFERENCE / f"{seam.lower()}.md").read_text(encoding="utf-8"))
    blocks = [block for block in re.split(r"\n(?=- )|\n\n", text) if re.match(rf"(- |\*\*)`{kind}`", block)]
    return [re.sub(r"^- ", "", block).replace("\n  ", "\n") for block in blocks]


# -- what eomgen says of the example -----------------------------------------------------------------


def example(kind: str) -> eomgen.Model:
    """The model that shows it."""
    return eomgen.load(EXAMPLES / f"{kind}.toml")


def counted(kind: str, model: eomgen.Model) -> str:
    """What a joint leaves free and what it carries; what a constraint asks and carries; of forces and shapes
    nothing."""
    section = kinds()[kind]
    if section in ("Forces", "Shapes"):
        return ""
    if section == "Joints" and not class_of(kind).carries_reaction:
        return "It says where the body is, and carries no reaction."
    system = model.scene().system
    every = Axes(system.motion).components_of(system)
    if section == "Joints":
        links = [x for x in system.motion.links if x.joint is not None and x.joint.kind == kind]
        owner, free = links[0].name, len(links[0].s)
        said = f"It leaves {plural(free, 'freedom')}, and carries "
    else:
        owner = next(name for name, constraint in model.constraints.items() if constraint.kind == kind)
        rows = [row for row in system.constraints.rows if row.constraint == owner]
        said = f"It is {plural(len(rows), 'row')}, and carries "
    names = [f"`{each.name}`" for each in every if each.owner == owner and each.label != "drive"]
    where = "in the plane" if model.space == "plane" else "in space"
    return f"{said}{', '.join(names) or 'no force or couple of its own'} ({where}, as below)."


def plural(count: int, noun: str) -> str:
    """1 row, 2 rows."""
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"


# -- pages -------------------------------------------------------------------------------------------


def page(kind: str, homes: dict[str, str]) -> str:
    """The Markdown of a kind."""
    cls, model, seam = class_of(kind), example(kind), kinds()[kind]
    source, here = f"docs/reference/{seam.lower()}.md", f"reference/kinds/{kind}"
    blocks = [
        f"# `{kind}`",
        safe(gist(cls)),
        f"![{model.name}]({kind}.svg)",
        safe(prose(cls).partition("\n")[2].strip()),
    ]
    blocks += [counted(kind, model), *(linked(text, source, homes, here) for text in sayings(kind, seam))]
    blocks += ["## Keys", fields_table(cls), "## An example"]
    blocks += [f"```{{literalinclude}} ../../examples/{kind}.toml\n:language: toml\n```"]
    blocks += (re.sub(r"^## ", "### ", reported(part, model), flags=re.M) for part in parts_of(model))
    return "\n\n".join(filter(None, blocks)) + "\n"


FOUND = {
    OutputSource.STATE: "the state: places, rates, and accelerations by the equations of motion",
    OutputSource.BALANCE: "the balance of the bodies, which is solved twice",
    OutputSource.MASSES: "how mass is spread in the bodies",
    OutputSource.SMALL_MOTIONS: "the small motions, which `linearize` proves",
    OutputSource.OF_A_RUN: "a run, whose samples must agree",
}


@cache
def requested() -> dict[Path, dict[str, set[str]]]:
    """Example -> its outputs by name -> the functions that each calls."""
    models = {path: eomgen.load(path) for path in sorted((EXAMPLES / "outputs").glob("*.toml"))}
    return {
        path: {name: {call.name for call in output.value.calls} for name, output in model.outputs.items()}
        for path, model in models.items()
    }


def requested_in(function: OutputFunction) -> dict[Path, list[str]]:
    """Example -> the names of its outputs that call a function."""
    found = {path: [n for n, c in calls.items() if c & {*function.names}] for path, calls in requested().items()}
    return {path: names for path, names in found.items() if names}


def function_page(function: OutputFunction, homes: dict[str, str]) -> str:
    """The Markdown of an output function: what it gives, of what, in which unit, how it is found; answers."""
    here = f"reference/functions/{function.names[0]}"
    gives = linked(function.gives, "docs/reference/outputs.md", homes, here)
    twice = "" if function.second is None else " A second way, which shares poses and masses alone with it, proves it."
    blocks = [
        f"# {', '.join(f'`{name}`' for name in function.names)}",
        f"{gives[0].upper() if gives[:2].islower() else gives[0]}{gives[1:]}.",
    ]
    blocks += [f"- called with: {safe(function.arguments)}\n- unit: {safe(function.in_unit)}"]
    blocks += [f"Found from {FOUND[function.source]}.{twice}"]
    for path, names in requested_in(function).items():
        model = eomgen.load(path)
        requested = "\n".join(
            line for line in path.read_text("utf-8").splitlines() if line.partition(" = ")[0] in names
        )
        blocks += [f"## {safe(model.name)}", f"```{{code-block}} toml\n[outputs]\n{requested}\n```"]
        blocks += [reported(partial(answered, names=names), model)]
        blocks += [
            f"```{{literalinclude}} ../../examples/outputs/{path.name}\n:language: toml\n:caption: the model\n```"
        ]
    return "\n\n".join(blocks) + "\n"


def answered(model: eomgen.Model, names: list[str]) -> str:
    """The answers to some of what a model asks."""
    if any(WholeRun.answers(model.outputs[name]) for name in names):
        found = eomgen.simulate(model, time=10).quantities
        units = model.units_of(names)
        rows = [f"| `{name}` | | {found[name].value / units[name].size:.6g} {units[name]} |" for name in names]
    else:
        answers = eomgen.solve(replace(model, outputs={name: model.outputs[name] for name in names}))
        rows = [answer_row(name, answers[name]) for name in names]
    return "\n".join(["| output | exact | value |", "|---|---|---|", *rows])


def function_contents(listed: list[OutputFunction]) -> str:
    """The page that lists the output functions."""
    items = [f"- [{', '.join(f'`{name}`' for name in each.names)}]({each.names[0]}.md)" for each in listed]
    tree = "\n".join(each.names[0] for each in listed)
    blocks = [
        "# Functions of the outputs",
        "A page each, in the order of [their table](../outputs.md):",
        "\n".join(items),
    ]
    return "\n\n".join([*blocks, f"```{{toctree}}\n:hidden:\n\n{tree}\n```"]) + "\n"


def contents(names: list[str]) -> str:
    """The page that lists all others, by their sections, with their pictures."""
    blocks = [
        "# Joints, constraints, forces, shapes",
        "A page each: a picture, the fields, a small model, and what follows of it.",
    ]
    for seam, members in SEAMS.items():
        here = [cls.kind for cls in members if cls.kind in names]
        listed = "\n".join(here)
        blocks += [f"## {seam}", gallery(here), f"```{{toctree}}\n:hidden:\n\n{listed}\n```"]
    return "\n\n".join(blocks) + "\n"


def gallery(names: list[str], columns: int = 3) -> str:
    """Pictures that lead to their pages."""
    cells = [f"[![]({kind}.svg){{width=220px}}]({kind}.md)<br>[`{kind}`]({kind}.md)" for kind in names]
    cells += [""] * (-len(cells) % columns)
    rows = [cells[k : k + columns] for k in range(0, len(cells), columns)]
    lines = [[" "] * columns, ["---"] * columns, *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def generate(app: Any) -> None:
    """All pages and pictures; those of a build with more kinds go."""
    names, (_, homes) = chosen(), papers()
    for kind in names:
        write(PLACE / f"{kind}.md", page(kind, homes))
        rest_figure(example(kind)).save(PLACE / f"{kind}.svg")
    for path in PLACE.iterdir():
        if path.stem not in (*names, "index"):
            path.unlink()
    write(PLACE / "index.md", contents(names))
    listed = [each for each in outputs.ALL if set(each.names) & set(QUICK) or len(names) > len(QUICK)]
    for function in listed:
        write(FUNCTIONS / f"{function.names[0]}.md", function_page(function, homes))
    for path in FUNCTIONS.iterdir():
        if path.stem not in (*(each.names[0] for each in listed), "index"):
            path.unlink()
    write(FUNCTIONS / "index.md", function_contents(listed))


def named(app: Any, where: str, source: list[str]) -> None:
    """In the tables of the reference a kind, and a function, leads to its page."""
    for path in sorted(FUNCTIONS.glob("*.md")) if where == "reference/outputs" else ():
        source[0] = re.sub(rf"\n\| (`{path.stem}(?: [^`]*)?`) ", rf"\n| [\1](functions/{path.name}) ", source[0])
    for kind in chosen() if where in {f"reference/{seam.lower()}" for seam in SEAMS} else ():
        source[0] = source[0].replace(f"\n| `{kind}` |", f"\n| [`{kind}`](kinds/{kind}.md) |")


def setup(app: Any) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.connect("builder-inited", generate)
    app.connect("source-read", named)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
