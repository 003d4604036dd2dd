"""The tables of the reference, from the classes that read a model file: their docstrings, fields and rules.

In docs/reference/*.md a table stands between two comments, `<!-- made: bodies -->` and `<!-- end -->`;
`python docs/_ext/reference.py` writes them anew (with `--check` it only says which are not as they must be).
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from functools import singledispatch
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT)]

from eomgen.model import constraints, forces, joints, outputs, shapes  # noqa: E402
from eomgen.model.constraints.rolling import Circle, Track  # noqa: E402
from eomgen.model.diagnostics import article  # noqa: E402
from eomgen.model.expansion import PartsRule, RepetitionRule  # noqa: E402
from eomgen.model.fields import (  # noqa: E402
    PARAMETERS,
    AxialRule,
    CountRule,
    EitherRule,
    EquationRule,
    EventRule,
    FlagRule,
    FormulaRule,
    InstantRule,
    ListRule,
    NameRule,
    NumbersRule,
    OutputRule,
    ParsedTextRule,
    StatementRule,
    TableRule,
    TextRule,
    VectorRule,
)
from eomgen.model.forces.cylinders import GasValve, Valve  # noqa: E402
from eomgen.model.forces.fluid import AddedMassRule  # noqa: E402
from eomgen.model.forces.tyre import TyreLaw  # noqa: E402
from eomgen.model.joints.base import Turned  # noqa: E402
from eomgen.model.joints.path import PathPiece  # noqa: E402
from eomgen.model.kinds import (  # noqa: E402
    HingeFriction,
    LimitsRule,
    PushFriction,
    ReactionSymbolsRule,
    Resistance,
    SlideFriction,
    ThreadFriction,
    TurnFriction,
    Wrap,
)
from eomgen.model.model import Model  # noqa: E402
from eomgen.model.part import PartRule, SeamRule, Slot  # noqa: E402
from eomgen.model.parts import (  # noqa: E402
    Body,
    Coordinate,
    Given,
    ImpactRules,
    Input,
    Linearize,
    Output,
    Parameter,
    Piece,
    Question,
    Speed,
    StateVariable,
    Truss,
    Unknown,
)
from eomgen.model.quantities import UNITS  # noqa: E402
from eomgen.model.sampled_laws import TimeLawRule  # noqa: E402
from eomgen.model.value_tables import NumbersRow, ValueTable  # noqa: E402
from eomgen.symbolic.expression.formula import NAMES  # noqa: E402

PLACE = ROOT / "docs" / "reference"
SEAMS: Mapping[str, tuple[type[Any], ...]] = {
    "Joints": joints.ALL,
    "Constraints": constraints.ALL,
    "Forces": forces.ALL,
    "Shapes": shapes.ALL,
}
BASES: Mapping[str, type[Any]] = {
    "Joints": joints.Joint,
    "Constraints": constraints.Constraint,
    "Forces": forces.Force,
    "Shapes": shapes.Shape,
}
TABLES: Mapping[str, type[Any]] = {
    "parameters": Parameter,
    "coordinates": Coordinate,
    "speeds": Speed,
    "states": StateVariable,
    "tables": ValueTable,
    "inputs": Input,
    "bodies": Body,
    "valve": Valve,
    "gas valve": GasValve,
    "law of a tyre": TyreLaw,
    "pieces": Piece,
    "friction": Resistance,
    "friction of a hinge": HingeFriction,
    "friction of a slide": SlideFriction,
    "friction of a thread": ThreadFriction,
    "friction of a turn": TurnFriction,
    "friction of a push": PushFriction,
    "track": Track,
    "circle": Circle,
    "wrap": Wrap,
    "path piece": PathPiece,
    "turned": Turned,
    "trusses": Truss,
    "impact": ImpactRules,
    "linearize": Linearize,
    "given": Given,
    "unknowns": Unknown,
    "outputs": Output,
    "questions": Question,
    "model": Model,
}
NAMED = {
    "seat": "name of a body, or of a point of one",
    "own point": "name of a point of this body",
    "axes": '"ground" or the name of a body',
    "member": '"n1-n2", by two nodes',
}
REGION = re.compile(r"(<!-- made: (.+?) -->\n).*?(<!-- end -->)", re.S)

# -- what the class says -----------------------------------------------------------------------------


def prose(cls: type[Any]) -> str:
    """A class's docstring before its fields."""
    return re.split(r"^(?:Args|Raises|Source):", inspect.getdoc(cls) or "", maxsplit=1, flags=re.M)[0].strip()


@singledispatch
def value_of(rule: Any) -> str:
    """What may stand in a field."""
    raise TypeError(f"nobody says what {type(rule).__name__} takes")


@value_of.register
def _(rule: RepetitionRule) -> str:
    return 'INDEX = 20 (from 1), [first, last], or "n" (an integer parameter)'


@value_of.register
def _(rule: NumbersRow) -> str:
    return "a list of numbers"


@value_of.register
def _(rule: PartsRule) -> str:
    return "NAME = { file, on, at, turned, set }"


@value_of.register
def _(rule: FormulaRule) -> str:
    words = "".join(f'"{word}" or ' for word in rule.words)
    names = "" if rule.scope == PARAMETERS else f" of {rule.scope}"
    unit = f" [{rule.unit}]" if rule.unit not in (None, "1") else ""
    return f"{words}{rule.sign} expression{names}{unit}".strip()


@value_of.register
def _(rule: LimitsRule) -> str:
    return f'2 of: "inf", or {value_of(rule.item)}'


@value_of.register
def _(rule: VectorRule) -> str:
    return f"{rule.length or '2 or 3'} components, {value_of(rule.item)}" + " or a point of the ground" * rule.point


@value_of.register
def _(rule: AxialRule) -> str:
    return f"1 or {' or '.join(map(str, rule.lengths))} components, {value_of(rule.item)}"


@value_of.register
def _(rule: ListRule) -> str:
    if rule.single and rule.most is not None:
        return f"one, or up to {rule.most} of: {value_of(rule.item)}"
    count = "list" if rule.most is None else str(rule.most)
    return f"{'one or a ' if rule.single else ''}{count} of: {value_of(rule.item)}"


@value_of.register
def _(rule: AddedMassRule) -> str:
    return f"{'3 or 6' if rule.diagonal else 'the rows of a square of 3 or 6'} of: {value_of(FormulaRule())}"


@value_of.register
def _(rule: EitherRule) -> str:
    return f"{value_of(rule.text)}, or {value_of(rule.other)}"


@value_of.register
def _(rule: NameRule) -> str:
    return NAMED.get(rule.of, f"name of {article(rule.of)}")


@value_of.register
def _(rule: TextRule) -> str:
    return " or ".join(f'"{word}"' for word in rule.options) or "text"


@value_of.register
def _(_rule: FlagRule) -> str:
    return "true or false"


@value_of.register
def _(rule: PartRule) -> str:
    return "table of " + ", ".join(f"`{slot.key}`" for slot in rule.cls.slots())


@value_of.register
def _(rule: SeamRule) -> str:
    return f"table of a {rule.what}, by its `kind`"


@value_of.register
def _(rule: TableRule) -> str:
    return f"names, each of one {rule.what}"


@value_of.register
def _(_rule: StatementRule) -> str:
    return "text with $formulas$ and {names}"


@value_of.register
def _(_rule: NumbersRule) -> str:
    return "two ends, or a list of values"


@value_of.register
def _(rule: CountRule) -> str:
    return f"whole number from {rule.least} to {rule.most}"


@value_of.register
def _(rule: ParsedTextRule) -> str:
    return f"{rule.needed}, {rule.like}"


@value_of.register
def _(rule: TimeLawRule) -> str:
    return f"number, expression of {rule.scope}, or samples"


@value_of.register
def _(_rule: OutputRule) -> str:
    return "expression that may call functions"


@value_of.register
def _(_rule: EquationRule) -> str:
    return "equation"


@value_of.register
def _(_rule: InstantRule) -> str:
    return 'equation, or "equilibrium"'


@value_of.register
def _(_rule: EventRule) -> str:
    return 'number from 1 on, or "every"'


@value_of.register
def _(_rule: ReactionSymbolsRule) -> str:
    return "LaTeX"


def gist(cls: type[Any]) -> str:
    """The first line of a class's docstring, as `eomgen schema` tells it, and what this version leaves out."""
    spaces, works = getattr(cls, "spaces", ("plane", "space")), getattr(cls, "works", True)
    where = {0: " Not derived yet.", 1: f" In the {spaces[0]} alone." if spaces else ""}.get(
        len(spaces) if works else 0, ""
    )
    return (inspect.getdoc(cls) or "").partition("\n")[0] + where


def law(cls: type[Any]) -> str:
    """What a class's docstring says below its first line and before its fields, as one paragraph."""
    return " ".join(prose(cls).partition("\n")[2].split())


def keys_of(cls: type[Any], seam: str) -> list[str]:
    """The keys that a member has beside those of its whole seam."""
    common = {slot.key for slot in BASES[seam].slots()}
    return [slot.key for slot in cls.slots() if slot.key not in common]


# -- tables ------------------------------------------------------------------------------------------


def row(*cells: str) -> str:
    """A line of a table."""
    return f"| {' | '.join(map(safe, cells))} |"


def safe(words: str) -> str:
    """Plain words as Markdown: what would end a cell, or begin an emphasis or a link, is escaped, but inside code."""
    parts = re.split(r"(`[^`]*`)", words)
    return "".join(x if x[:1] == "`" else re.sub(r"[|*<$]|(?<!\w)_|_(?!\w)", r"\\\g<0>", x) for x in parts)


def field_row(slot: Slot, meaning: str) -> str:
    """A line of the table of fields."""
    plain = slot.default is not None and not isinstance(slot.default, Mapping)
    default = "required" if slot.required else str(slot.default).lower() if plain else ""
    key = "`kind` and its keys" if slot.inline else f"`{slot.key}`"
    return row(key, default, value_of(slot.rule), re.sub(r"\bNone\b", "left out", meaning))


def fields_table(cls: type[Any]) -> str:
    """All fields, those that every such part has last."""
    known, own = cls.meanings(), inspect.get_annotations(cls)
    slots = sorted(cls.slots(), key=lambda slot: slot.name not in own)
    rows = [field_row(slot, known.get(slot.name, "")) for slot in slots]
    return "\n".join([row("key", "default", "value", "meaning"), row(*["---"] * 4), *rows])


def kinds_table(seam: str) -> str:
    """A line for each member of a seam: its kind, its own keys, what it is."""
    rows = [row(f"`{cls.kind}`", ", ".join(f"`{key}`" for key in keys_of(cls, seam)), gist(cls)) for cls in SEAMS[seam]]
    return "\n".join([row("kind", "keys", "meaning"), row(*["---"] * 3), *rows])


def laws_list(seam: str) -> str:
    """An item for each member of a seam that has a law beyond its first line."""
    known = [(cls.kind, law(cls)) for cls in SEAMS[seam] if law(cls)]
    return "\n".join(f"- `{kind}`: {safe(words)}" for kind, words in known)


def functions_table() -> str:
    """A line for each output function, as it says itself."""
    return "\n".join([row("function", "gives", "SI"), row(*["---"] * 3), *(each.row for each in outputs.ALL)])


# -- the cheat sheet ---------------------------------------------------------------------------------


def short_keys(slots: Iterable[Slot]) -> str:
    """The keys in one line, those that are required in bold."""
    return " ".join(f"**{slot.key}**" if slot.required else slot.key for slot in slots if not slot.inline)


def short_table(name: str, cls: type[Any]) -> str:
    """One table of the file: its name, what a bare value is, its keys."""
    bare = f"a bare value is its {cls.shorthand}; " if cls.shorthand else ""
    return f"`{name}` {bare}{short_keys(cls.slots())}"


def short_tables() -> str:
    """Every table of the file with its keys, and the tables in them."""
    own = [slot for slot in Model.slots() if not isinstance(slot.rule, (TableRule, PartRule))]
    lines = [f"`eomgen = 1` {short_keys(own)}"]
    for slot in Model.slots():
        cls, item = TABLES.get(slot.key), getattr(slot.rule, "item", None)
        if isinstance(item, SeamRule):
            lines.append(f"`[{slot.key}.NAME]` **kind** and its keys, below")
        elif isinstance(item, VectorRule):
            lines.append(f"`[{slot.key}]` NAME = [x, y], in space [x, y, z]")
        elif cls is not None:
            many = item is not None and not cls.shorthand
            lines.append(short_table(f"[{slot.key}{'.NAME' if many else ''}]", cls))
    inner = ("pieces", "turned", "path piece", "track", "circle", "wrap", "friction")
    return "\n".join(f"- {line}" for line in (*lines, *(short_table(name, TABLES[name]) for name in inner)))


def short_kinds(seam: str) -> str:
    """Every kind of a seam with its own keys, in one paragraph."""
    common = {slot.key for slot in BASES[seam].slots()}
    words = [
        f"`{cls.kind}` {short_keys(slot for slot in cls.slots() if slot.key not in common)}".strip()
        for cls in SEAMS[seam]
    ]
    every = f" Each also: {' '.join(sorted(common))}." if common else ""
    return f"{' · '.join(words)}.{every}"


def short_functions() -> str:
    """Every output function with its arguments and its unit, in one paragraph."""
    return " · ".join(f"`{' '.join(each.names)}` {safe(f'{each.arguments} {each.in_unit}')}" for each in outputs.ALL)


def cheat_sheet() -> str:
    """The model file on one page."""
    blocks = {
        "Tables": short_tables(),
        **{seam: short_kinds(seam) for seam in SEAMS},
        "Expressions": f"`+ - * / ^ ( )` `t` `pi` `theta'` `theta''` `s = sin(q); s^2 + s`, {' '.join(sorted(NAMES))}",
        "Units": " ".join(UNITS),
        "Functions of outputs": short_functions(),
    }
    return "\n\n".join(f"**{head}.**\n{text}" if head != "Tables" else text for head, text in blocks.items())


MADE: Mapping[str, Callable[[], str]] = {
    **{name: lambda cls=cls: fields_table(cls) for name, cls in TABLES.items()},
    **{f"all {seam.lower()}": lambda seam=seam: kinds_table(seam) for seam in SEAMS},
    **{f"laws of {seam.lower()}": lambda seam=seam: laws_list(seam) for seam in SEAMS},
    **{f"every {seam.lower()[:-1]}": lambda cls=cls: fields_table(cls) for seam, cls in BASES.items() if cls.slots()},
    "functions": functions_table,
    "cheat sheet": cheat_sheet,
}


def filled(text: str) -> str:
    """A page with its tables as they are now."""
    return REGION.sub(lambda match: f"{match[1]}\n{MADE[match[2]]()}\n\n{match[3]}", text)


def pages() -> list[Path]:
    """The pages of the reference, in the order of their contents."""
    listed = re.search(r"^```\{toctree\}\n(?::.*\n)*\n(.*?)^```$", (PLACE / "index.md").read_text("utf-8"), re.M | re.S)
    paths = [PLACE / f"{name}.md" for name in (listed[1].split() if listed else ())]
    return [PLACE / "index.md", *(path for path in paths if path.parent == PLACE)]


def main(only_check: bool) -> int:
    """How many pages were not as they must be; without `only_check` they are then."""
    wrong = {path: filled(path.read_text("utf-8")) for path in sorted(PLACE.glob("*.md"))}
    wrong = {path: text for path, text in wrong.items() if path.read_text("utf-8") != text}
    for path, text in wrong.items():
        print(path.relative_to(ROOT))
        if not only_check:
            path.write_text(text, encoding="utf-8")
    return len(wrong) if only_check else 0


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv))
