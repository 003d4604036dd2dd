"""Model-file kinds as pages: one for each joint, tie and force, from the classes that read them.

What a kind is comes from its class (docstring, fields and their rules) and from the reference's lines on it; its
example is docs/examples/KIND.toml, and the picture, the counts and the equations are what eomgen makes of that file.
EOMGEN_GALLERY=quick makes a few pages.
"""

from __future__ import annotations

import inspect
import os
import re
from collections.abc import Iterator, Mapping
from functools import cache, singledispatch
from pathlib import Path
from typing import Any

from cut_reference import cut, linked, sections, write
from gallery import parts_of, told

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.wrenches import Axes, components_of
from eomgen.model import constraints, forces, joints
from eomgen.model.fields import (
    PARAMETERS,
    AxialRule,
    EitherRule,
    FlagRule,
    FormulaRule,
    ListRule,
    NameRule,
    TextRule,
    VectorRule,
)
from eomgen.model.kinds import ReactionSymbolsRule
from eomgen.model.part import PartRule, Slot, slots_of
from eomgen.page.figure import rest_figure

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "docs" / "examples"
PLACE = ROOT / "docs" / "model_file" / "kinds"
SEAMS: Mapping[str, tuple[type[Any], ...]] = {
    "Joints": joints.ALL,
    "Constraints": constraints.ALL,
    "Forces": forces.ALL,
}
QUICK = ("revolute", "screw", "rolling", "clamp", "spring")
ENTRY = re.compile(r"^(\w[\w, ]*): (.*)$")


def kinds() -> dict[str, str]:
    """Kind -> the section of the reference in which it stands."""
    return {cls.kind: seam for seam, members in SEAMS.items() for cls in members}


def class_of(kind: str) -> type[Any]:
    """Its class."""
    return next(cls for members in SEAMS.values() for cls in members if cls.kind == kind)


def chosen() -> list[str]:
    """The kinds that get a page."""
    return [kind for kind in kinds() if os.environ.get("EOMGEN_GALLERY") != "quick" or kind in QUICK]


# -- what the class says -----------------------------------------------------------------------------


def prose(cls: type[Any]) -> str:
    """A class's docstring before its fields."""
    return re.split(r"^(?:Args|Raises|Source):", inspect.getdoc(cls) or "", maxsplit=1, flags=re.M)[0].strip()


def meanings(cls: type[Any]) -> dict[str, str]:
    """Field -> what it means, by the docstrings of the class and of its bases; the nearest counts."""
    found: dict[str, str] = {}
    for base in reversed(cls.__mro__):
        found |= dict(_entries(inspect.cleandoc(base.__doc__ or "")))
    return found


def _entries(text: str) -> Iterator[tuple[str, str]]:
    names: list[str] = []
    words = ""
    for line in text.partition("\nArgs:\n")[2].splitlines():
        match = ENTRY.match(line.removeprefix("    "))
        if not line.startswith("    "):
            break
        if match and not line.startswith("     "):
            yield from ((name, words) for name in names)
            names, words = match[1].split(", "), match[2]
        else:
            words += f" {line.strip()}"
    yield from ((name, words) for name in names)


@singledispatch
def value_of(rule: Any) -> str:
    """What may stand in a field."""
    raise TypeError(f"nobody says what {type(rule).__name__} takes")


@value_of.register
def _(rule: FormulaRule) -> str:
    words = "".join(f'"{word}" or ' for word in rule.words)
    names = "" if rule.scope == PARAMETERS else f" of {rule.scope}"
    unit = f" [{rule.unit}]" if rule.unit not in (None, "1") else ""
    return f"{words}{rule.sign} expression{names}{unit}".strip()


@value_of.register
def _(rule: VectorRule) -> str:
    return f"{rule.length or '2 or 3'} components, {value_of(rule.item)}" + " or a point of the ground" * rule.point


@value_of.register
def _(rule: AxialRule) -> str:
    return f"1 or {' or '.join(map(str, rule.lengths))} components, {value_of(rule.item)}"


@value_of.register
def _(rule: ListRule) -> str:
    count = "list" if rule.most is None else str(rule.most)
    return f"{'one or a ' if rule.single else ''}{count} of: {value_of(rule.item)}"


@value_of.register
def _(rule: EitherRule) -> str:
    return f"{value_of(rule.text)}, or {value_of(rule.other)}"


@value_of.register
def _(rule: NameRule) -> str:
    return f"name of {'an' if rule.of[0] in 'aeio' else 'a'} {rule.of}"


@value_of.register
def _(rule: TextRule) -> str:
    return " or ".join(f'"{word}"' for word in rule.options) or "text"


@value_of.register
def _(_rule: FlagRule) -> str:
    return "true or false"


@value_of.register
def _(rule: PartRule) -> str:
    return "table of " + ", ".join(slot.key for slot in slots_of(rule.cls))


@value_of.register
def _(_rule: ReactionSymbolsRule) -> str:
    return "LaTeX"


def field_row(slot: Slot, meaning: str) -> str:
    """A line of the table of fields."""
    default = "required" if slot.required else "" if slot.default is None else str(slot.default).lower()
    cells = (f"`{slot.key}`", default, value_of(slot.rule), meaning)
    return "| " + " | ".join(re.sub(r"[|*]", r"\\\g<0>", cell) for cell in cells) + " |"


def fields_table(cls: type[Any]) -> str:
    """All fields, those that every such part has last."""
    known, own = meanings(cls), inspect.get_annotations(cls)
    slots = sorted(slots_of(cls), key=lambda slot: slot.name not in own)
    rows = [field_row(slot, known.get(slot.name, "")) for slot in slots]
    return "\n".join(["| field | default | value | meaning |", "|---|---|---|---|", *rows])


# -- what the reference says -------------------------------------------------------------------------


@cache
def reference() -> dict[str, list[str]]:
    """Section -> its lines."""
    return dict(sections((ROOT / "models" / "README.md").read_text(encoding="utf-8")))


def sayings(kind: str, section: str) -> list[str]:
    """The reference's lines on a kind: its row in the table, and the items and paragraphs that begin with it."""
    lines = reference()[section]
    row = next(line for line in lines if line.startswith(f"| `{kind}` |"))
    found = [row.rstrip(" |").rpartition(" | ")[2]]
    for block in re.split(r"\n(?=- )|\n\n", "\n".join(lines)):
        if re.match(rf"(- |\*\*)`{kind}`", block):
            found.append(re.sub(r"^- ", "", block).replace("\n  ", "\n"))
    return found


# -- what eomgen says of the example -----------------------------------------------------------------


def example(kind: str) -> eomgen.Model:
    """The model that shows it."""
    return eomgen.load(EXAMPLES / f"{kind}.toml")


def counted(kind: str, system: System) -> str:
    """What a joint leaves free and what it carries; what a tie asks and carries; of forces nothing."""
    section = kinds()[kind]
    if section == "Forces":
        return ""
    if section == "Joints" and not class_of(kind).carries_reaction:
        return "It says where the body is, and carries no reaction."
    every = components_of(system, Axes(system.motion))
    if section == "Joints":
        links = [x for x in system.motion.links if x.joint is not None and x.joint.kind == kind]
        owner, free = links[0].name, len(links[0].s)
        said = f"It leaves {plural(free, 'freedom')}, and carries "
    else:
        model = system.scope.model
        owner = next(name for name, tie in model.constraints.items() if tie.kind == kind)
        rows = [row for row in system.ties.rows if row.tie == owner]
        said = f"It is {plural(len(rows), 'row')}, and carries "
    names = [f"`{each.name}`" for each in every if each.owner == owner and each.label != "drive"]
    where = "in the plane" if system.scope.model.space == "plane" else "in space"
    return f"{said}{', '.join(names) or 'no force or couple of its own'} ({where}, as below)."


def plural(count: int, noun: str) -> str:
    """1 row, 2 rows."""
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"


# -- pages -------------------------------------------------------------------------------------------


def page(kind: str, homes: dict[tuple[str, str], str]) -> str:
    """The Markdown of a kind."""
    cls, model, here = class_of(kind), example(kind), f"model_file/kinds/{kind}"
    lead, *more = (linked(text, "models/README.md", homes, here) for text in sayings(kind, kinds()[kind]))
    blocks = [f"# `{kind}`", f"{lead[0].upper()}{lead[1:]}.", f"![{model.name}]({kind}.svg)", *more]
    blocks += [f"```{{code-block}} text\n{prose(cls)}\n```", counted(kind, model.scene().system)]
    blocks += ["## Fields", fields_table(cls), "## An example"]
    blocks += [f"```{{literalinclude}} ../../examples/{kind}.toml\n:language: toml\n```"]
    blocks += (re.sub(r"^## ", "### ", told(part, model), flags=re.M) for part in parts_of(model))
    return "\n\n".join(filter(None, blocks)) + "\n"


def contents(names: list[str]) -> str:
    """The page that lists all others, by their sections, with their pictures."""
    blocks = [
        "# Joints, constraints, forces",
        "A page each: a picture, the fields, a small model, and what follows of it.",
    ]
    for seam, members in SEAMS.items():
        here = [cls.kind for cls in members if cls.kind in names]
        listed = "\n".join(here)
        blocks += [f"## {seam}", gallery(here), f"```{{toctree}}\n:hidden:\n\n{listed}\n```"]
    blocks.append("What has a mass stands in one table: [shapes](../shapes.md).")
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
    names, (_, homes) = chosen(), cut()
    for kind in names:
        write(PLACE / f"{kind}.md", page(kind, homes))
        rest_figure(example(kind)).save(PLACE / f"{kind}.svg")
    for path in PLACE.iterdir():
        if path.stem not in (*names, "index"):
            path.unlink()
    write(PLACE / "index.md", contents(names))


def named(app: Any, where: str, source: list[str]) -> None:
    """In the tables of the reference a kind leads to its page."""
    for kind in chosen() if where in {f"model_file/{seam.lower()}" for seam in SEAMS} else ():
        source[0] = source[0].replace(f"\n| `{kind}` |", f"\n| [`{kind}`](kinds/{kind}.md) |")


def setup(app: Any) -> dict[str, bool]:
    """Sphinx asks for it."""
    app.connect("builder-inited", generate)
    app.connect("source-read", named)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
