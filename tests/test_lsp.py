"""Model files in an editor: what stands where in a text that is typed, and `eomgen lsp` with a client over stdio."""

from __future__ import annotations

import asyncio
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.client import LanguageClient
from slow_run import in_slow_run
from tools import needs

import eomgen
from eomgen.errors import UsageError
from eomgen.language_server.answers import TextProblem, offers_at, problems_of_text, said_at
from eomgen.model.written_text import WrittenText, _replaced

MODELS = Path(__file__).parent.parent / "models"
EXTENSION = Path(__file__).parent.parent / "editors" / "vscode"
TEXT = """eomgen = 1
space = "plane"
[parameters]
m = { value = 15, unit = "g", about = "of the bob" }
l = "2*r"
r = { value = 15, unit = "cm" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { start = 30, unit = "deg" }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
points = { P = ["r", 0] }
joint = { kind = "revolute", angle = "theta - pi/2" }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "fixed", on = "arm.P" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
v = "speed(arm.P)"
T = "kinetic_energy(arm) + 0*theta'"
"""


def offered(more: str) -> dict[str, str]:
    """{label: kind} of what may be typed at the end of a text."""
    text = TEXT + more
    return {offer.label: offer.kind for offer in offers_at(WrittenText(text), len(text))}


def at(word: str, text: str = TEXT, more: int = 0) -> int:
    assert text.count(word) >= 1, word
    return text.index(word) + more


# -- what may be typed -----------------------------------------------------------------------------


def test_tables_are_offered_in_a_header():
    """[ and [bodies. and [bodies.arm."""
    assert {"parameters", "bodies", "points", "outputs"} <= offered("[").keys()
    assert offered("[bodies.") == {"arm": "name", "bob": "name"}
    assert {"joint", "shape"} <= offered("[bodies.arm.").keys() and "mass" not in offered("[bodies.arm.")


def test_fields_are_offered_that_are_not_there_yet():
    """Of a body; of a joint of a kind its own; of one without a kind `kind` first."""
    body = offered("[bodies.new]\nmass = 1\n")
    assert {"shape", "joint", "points"} <= body.keys() and "mass" not in body
    hinge = offered('[bodies.new]\njoint = { kind = "revolute", ')
    assert {"angle", "on", "at"} <= hinge.keys() and "displacement" not in hinge
    assert next(iter(offered("[bodies.new]\njoint = { "))) == "kind"
    assert {"value", "unit", "about"} <= offered("[inputs]\nF = { ").keys()


def test_kinds_are_offered_of_the_table_that_is_written():
    """Joints in a joint, shapes in a shape, forces in [forces]."""
    assert {"revolute", "prismatic"} <= offered('[bodies.new]\njoint = { kind = "').keys()
    assert {"rod", "disc"} <= offered('[bodies.new]\nshape = { kind = "').keys()
    assert {"gravity", "spring"} <= offered('[forces.s]\nkind = "').keys()
    assert set(offered('[bodies.new]\nshape = { kind = "').values()) == {"kind"}


def test_names_are_offered_that_may_stand_there():
    """Parameters in a mass, coordinates in an angle too, everything in an output; points where a point is named."""
    mass = offered('[bodies.new]\nmass = "')
    assert {"m", "sqrt"} <= mass.keys() and "theta" not in mass
    assert "theta" in offered('[bodies.new]\njoint = { kind = "revolute", angle = "2*the')
    output = offered('[constraints]\n[unknowns]\n[linearize]\n[given]\nvelocity = ["')
    assert {"theta'", "theta''", "omega", "arm"} <= output.keys()
    assert {"arm.P", "arm.end", "bob.origin"} <= offered('[forces.s]\nkind = "force"\npoint = "').keys()


def test_nothing_is_offered_in_a_remark():
    """# what one writes there is one's own."""
    assert offered("# the ma") == {}
    assert offered("[bodies.new]\nmass = 1 # ") == {}


# -- what stands there -----------------------------------------------------------------------------


def test_a_value_is_told_in_the_unit_of_the_author():
    """15 g, not 0.015; of a formula its number too: 2*r = 0.3 m."""
    written = WrittenText(TEXT)
    assert said_at(written, at('"m"', more=1)) == "**m**: parameter\n\n`value = 15 g`\n\nof the bob"
    assert said_at(written, at('"l"', more=1)) == "**l**: parameter\n\n`value = 2*r = 0.3 m`"
    assert "`start = 30 deg`" in said_at(written, at('"theta - pi', more=2))


def test_kinds_fields_functions_and_points_are_told():
    """By the first lines of the reference."""
    written = WrittenText(TEXT)
    assert said_at(written, at("revolute")).startswith("**revolute**: A hinge")
    assert said_at(written, at("angle")).startswith("**angle** of Revolute")
    assert "[m/s]" in said_at(written, at("speed(")) or "speed" in said_at(written, at("speed("))
    assert said_at(written, at("arm.P", more=4)).startswith("**P**: point of arm")
    assert said_at(written, at("eomgen")) == ""


# -- names -----------------------------------------------------------------------------------------


def places(word: str, more: int = 0) -> list[str]:
    """The lines in which the name at a word is used or declared."""
    written = WrittenText(TEXT)
    mention = written.mention_at(at(word, more=more))
    assert mention is not None
    spans = sorted(each.span.start for each in written.mentions if each.declared == mention.declared)
    return [TEXT[TEXT.rfind("\n", 0, start) + 1 : TEXT.index("\n", start)] for start in spans]


def test_every_use_of_a_name_is_found():
    """Of a parameter in expressions, of a body in headers, points and functions, of a point of a body with its body."""
    lines = TEXT.splitlines()
    assert places('"m"', 1) == [lines[3], lines[10], lines[14]]
    assert places("[bodies.arm]", 8) == [lines[9], lines[15], lines[19], lines[20]]
    assert places("arm.P", 4) == [lines[11], lines[15], lines[19]]
    assert places("theta'") == [lines[8], lines[12], lines[20]]


def renamed(text: str, offset: int, name: str) -> str:
    written = WrittenText(text)
    return _replaced(text, written.renamed(written.mention_at(offset), name), name)


def test_renaming_changes_the_name_and_nothing_else():
    """Every model stays the same but for the name: renamed back it is the same text."""
    new = renamed(TEXT, at('"theta - pi', more=1), "phi")
    assert "theta" not in new and eomgen.loads(new).coordinates.keys() == {"phi"}
    assert renamed(new, new.index("phi"), "theta") == TEXT


@pytest.mark.parametrize(
    ("name", "why"),
    [("2m", "is no name"), ("r", "is there already"), ("m m", "is no name"), ("pi", "means something here already")],
)
def test_a_name_that_cannot_be_is_refused(name, why):
    """No name; one that is taken; one that means something else."""
    with pytest.raises(UsageError, match=why):
        renamed(TEXT, at('"m"', more=1), name)


NAMES = ["double_pendulum", "four_bar", "fink_truss", "arm7", "rolling_disc_and_bar", "gerber_beam", "furuta_pendulum"]


@pytest.mark.parametrize("model", NAMES)
def test_each_name_of_a_model_can_be_renamed_and_back(model):
    """Parameters and coordinates, bodies and points: a model again, and the same text when it is renamed back."""
    text = (MODELS / f"{model}.toml").read_text("utf-8")
    written = WrittenText(text)
    assert written.index.end >= len(text.rstrip())
    for declared, span in list(written.declarations.items())[:12]:
        new = renamed(text, span.start, "qx9")
        assert eomgen.loads(new)
        back = WrittenText(new)
        other = next(at for path, at in back.declarations.items() if path == (*declared[:-1], "qx9"))
        assert renamed(new, other.start, str(declared[-1])) == text


def test_a_text_that_breaks_off_is_read_before_and_behind_it():
    """A line that is no TOML: the names of the others are known."""
    written = WrittenText(TEXT.replace('shape = { kind = "rod", mass = "m"', 'shape = { kind = "rod", mass = '))
    assert {("bodies", "bob"), ("outputs", "v"), ("parameters", "m")} <= written.declarations.keys()


def test_problems_have_the_length_of_what_is_wrong():
    """An unknown name of two letters: two characters; a warning is one."""
    (found,) = problems_of_text(TEXT.replace('mass = "m"', 'mass = "mm"', 1), "f.toml")
    assert (found.line, found.column, found.length, found.is_warning) == (11, 33, 2, False)
    assert isinstance(found, TextProblem) and "fix: did you mean 'm'?" in found.text


# -- over stdio ------------------------------------------------------------------------------------


URI = "file:///pendulum.toml"


class Editor(LanguageClient):
    """A client that keeps what it is told."""

    def __init__(self) -> None:
        super().__init__("test", "1")
        self.told: asyncio.Queue[types.PublishDiagnosticsParams] = asyncio.Queue()

        @self.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def heard(params: types.PublishDiagnosticsParams) -> None:
            self.told.put_nowait(params)


def with_editor(work: Callable[[Editor], Awaitable[None]]) -> None:
    """Does something with `eomgen lsp` and a client that counts columns in UTF-16, as all can."""

    async def run() -> None:
        editor = Editor()
        await editor.start_io(sys.executable, "-m", "eomgen", "lsp")
        await editor.initialize_async(types.InitializeParams(capabilities=types.ClientCapabilities()))
        editor.initialized(types.InitializedParams())
        await work(editor)
        await editor.shutdown_async(None)
        editor.exit(None)
        await asyncio.wait_for(editor.stop(), 10)

    asyncio.run(asyncio.wait_for(run(), 60))


def opened(editor: Editor, text: str) -> None:
    document = types.TextDocumentItem(URI, "toml", 1, text)
    editor.text_document_did_open(types.DidOpenTextDocumentParams(document))


def position(text: str, offset: int) -> types.Position:
    before = text[:offset]
    column = len(before[before.rfind("\n") + 1 :].encode("utf-16-le")) // 2
    return types.Position(before.count("\n"), column)


def test_an_editor_is_answered():
    """Problems on opening and typing, completion, hover, declaration, uses, renaming; the end is clean."""
    document = types.TextDocumentIdentifier(URI)
    text = TEXT.replace("of the bob", "𝑚 of the bob").replace('mass = "m"', 'mass = "mm"', 1)

    async def work(editor: Editor) -> None:
        opened(editor, text)
        told = await editor.told.get()
        (wrong,) = told.diagnostics
        assert (wrong.range.start.line, wrong.range.start.character, wrong.range.end.character) == (10, 32, 34)
        assert wrong.severity == types.DiagnosticSeverity.Error and "unknown name 'mm'" in wrong.message
        good = TEXT.replace("of the bob", "𝑚 of the bob")
        whole = types.TextDocumentContentChangeWholeDocument(good)
        versioned = types.VersionedTextDocumentIdentifier(version=2, uri=URI)
        editor.text_document_did_change(types.DidChangeTextDocumentParams(versioned, [whole]))
        told = await editor.told.get()
        assert not told.diagnostics and told.version == 2
        place = position(good, good.index('"theta - pi') + 1)
        hover = await editor.text_document_hover_async(types.HoverParams(document, place))
        assert "`start = 30 deg`" in hover.contents.value
        declared = await editor.text_document_definition_async(types.DefinitionParams(document, place))
        assert declared.range == types.Range(types.Position(8, 0), types.Position(8, 5))
        context = types.ReferenceContext(include_declaration=True)
        uses = await editor.text_document_references_async(
            types.ReferenceParams(context=context, text_document=document, position=place)
        )
        assert [use.range.start.line for use in uses] == [8, 12, 20]
        edit = await editor.text_document_rename_async(
            types.RenameParams(text_document=document, position=place, new_name="phi")
        )
        assert sorted(each.range.start.line for each in edit.changes[URI]) == [8, 12, 20]
        with pytest.raises(JsonRpcException, match="is no name"):
            await editor.text_document_rename_async(
                types.RenameParams(text_document=document, position=place, new_name="2")
            )
        place = position(good, good.index('"revolute"') + 1)
        offers = await editor.text_document_completion_async(types.CompletionParams(document, place))
        assert {"revolute", "prismatic"} <= {item.label for item in offers.items}

    with_editor(work)


def test_columns_are_those_of_the_editor():
    """Behind a letter outside the first 65536 a column of UTF-16 is one more than the number of characters."""
    text = TEXT.replace('shape = { kind = "rod", mass = "m"', 'shape = { kind = "rod𝑚", mass = "mm"')

    async def work(editor: Editor) -> None:
        opened(editor, text)
        told = await editor.told.get()
        line = text.splitlines()[10]
        wrong = {each.message.partition("\n")[0]: each.range for each in told.diagnostics}
        found = next(place for words, place in wrong.items() if "rod" in words)
        units = line.encode("utf-16-le")[2 * found.start.character : 2 * found.end.character].decode("utf-16-le")
        assert units.strip('"') == "rod𝑚"

    with_editor(work)


def test_other_toml_is_left_alone():
    """pyproject.toml has no line `eomgen =`: no problem is told, nothing is offered."""
    text = '[project]\nname = "other"\n'

    async def work(editor: Editor) -> None:
        opened(editor, text)
        assert not (await editor.told.get()).diagnostics
        place = types.CompletionParams(types.TextDocumentIdentifier(URI), types.Position(1, 2))
        assert not (await editor.text_document_completion_async(place)).items

    with_editor(work)


@in_slow_run
@needs("npm")
def test_the_extension_for_vs_code_packs(tmp_path):
    """By its usual tool, `vsce package`: the program, its data and its licence are in the file."""
    shutil.copytree(EXTENSION, tmp_path, dirs_exist_ok=True, ignore=shutil.ignore_patterns("node_modules", "*.vsix"))
    fetched = subprocess.run(["npm", "ci", "--ignore-scripts"], cwd=tmp_path, capture_output=True, text=True)
    if fetched.returncode:
        pytest.skip(f"the packages cannot be fetched: {fetched.stderr[-200:]}")
    subprocess.run(["npm", "run", "package"], cwd=tmp_path, check=True, capture_output=True)
    with zipfile.ZipFile(tmp_path / "eomgen.vsix") as packed:
        assert {"extension/extension.js", "extension/package.json", "extension/LICENSE.txt"} <= set(packed.namelist())
        program = packed.read("extension/extension.js").decode()
    assert "eomgen" in program and "onDidOpenTextDocument" in program
