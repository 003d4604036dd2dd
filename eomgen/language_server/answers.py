"""Text, place -> what an editor shows there: problems, what may be typed, what stands there.

Nothing is derived here: an answer takes milliseconds.
"""

from __future__ import annotations

import asyncio
import inspect
import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from eomgen.errors import EomgenError, ModelError, Problem, ToolMissing
from eomgen.frozen import dataclass
from eomgen.model import FUNCTIONS, Cursor, Model, WrittenText, loads, warned
from eomgen.symbolic.expression import NAMES
from eomgen.version import __version__

if TYPE_CHECKING:
    from lsprotocol import types
    from pygls.lsp.server import LanguageServer
    from pygls.workspace import TextDocument

MOST = 300  # offers
STARTS = ("value", "start", "speed", "rate")
"""Fields that say how large a thing is."""


@dataclass(frozen=True)
class Offer:
    """One thing that may be typed.

    Args:
        kind: "table", "kind", "field", "name", "function", "word".
        detail: in a few words.
        about: more of it.
        insert: what is put in; "" for the label.
    """

    label: str
    kind: str
    detail: str = ""
    about: str = ""
    insert: str = ""


@dataclass(frozen=True)
class TextProblem:
    """A problem at its place.

    Args:
        line, column: from 1; columns count characters.
        length: in characters.
    """

    line: int
    column: int
    length: int
    text: str
    is_warning: bool = False


def problems_of_text(text: str, name: str) -> list[TextProblem]:
    """Everything that is wrong with a text, else its warnings."""
    try:
        model = loads(text, name)
    except ModelError as error:
        return [_found(problem) for problem in error.problems]
    return [_found(problem, is_warning=True) for problem in warned(model, text.encode(), name)]


def _found(problem: Problem, *, is_warning: bool = False) -> TextProblem:
    placed = problem.as_dict()
    carets = re.search(r"\^+", problem.excerpt)
    words = f"{problem.what}\nfix: {problem.fix}" if problem.fix else problem.what
    line, column = (int(placed[key] or 1) for key in ("line", "column"))
    return TextProblem(line, column, len(carets[0]) if carets else 1, words, is_warning)


# -------- what may be typed -----------------------------------------------------------------------------------


def offers_at(written: WrittenText, offset: int) -> list[Offer]:
    """Everything that may be typed at a place."""
    cursor = written.cursor(offset)
    ways = {"header": _headers, "key": _keys, "text": _texts, "value": _values}
    found = ways[cursor.mode](written, cursor) if cursor.mode in ways else ()
    return list(dict.fromkeys(found))[:MOST]


def offers_in_text(text: str, offset: int) -> list[dict[str, str]]:
    """Everything that may be typed at a place of a text, as JSON has it; of other TOML nothing."""
    written = WrittenText(text)
    found = offers_at(written, min(max(offset, 0), len(text))) if written.is_model else []
    return [{name: getattr(each, name) for name in Offer.__dataclass_fields__} for each in found]


def _headers(written: WrittenText, cursor: Cursor) -> Iterator[Offer]:
    """Tables, and those inside them; of a table of named things the names that are there."""
    for key, (cls, slot) in written.slots_at(cursor.path).items():
        if written.holds_a_table((*cursor.path, key)):
            yield Offer(key, "table", field_meaning(cls, slot.name))
    if len(cursor.path) == 1:
        yield from (
            Offer(str(path[1]), "name", str(path[0])) for path in written.declarations if path[:-1] == cursor.path
        )


def _keys(written: WrittenText, cursor: Cursor) -> Iterator[Offer]:
    """Fields that are not there yet, `kind` first where one is needed."""
    path = cursor.path[:-1] if cursor.word else cursor.path
    if written.seam_at(path) is not None and not written.value((*path, "kind")):
        yield Offer("kind", "field", "what it is", insert='kind = "')
    for key, (cls, slot) in written.slots_at(path).items():
        if (*path, key) not in written.index.values or key == cursor.word:
            needed = "needed" if slot.required else ""
            yield Offer(key, "field", needed, field_meaning(cls, slot.name), f"{key} = ")


def _texts(written: WrittenText, cursor: Cursor) -> Iterator[Offer]:
    """Kinds, words, units; names and functions of an expression; names of what a field refers to."""
    if cursor.path[-1:] == ("kind",):
        seam = written.seam_at(cursor.path[:-1])
        yield from (Offer(cls.kind, "kind", gist(cls), about(cls)) for cls in (seam.members if seam else ()))
        return
    found = written.fitting(cursor.path)
    yield from (Offer(word, "word") for word in found.words)
    for name, declared in found.names:
        yield Offer(name, "name", kind_in_words(declared), value_said(written, declared) if declared else "")
    for name in found.functions:
        yield Offer(name, "function", _signature(name), function_about(name), f"{name}(")


def _values(written: WrittenText, cursor: Cursor) -> Iterator[Offer]:
    """The same, with quotes around it; true and false."""
    for each in _texts(written, cursor):
        if each.kind in ("kind", "word"):
            bare = each.label in ("true", "false")
            yield Offer(each.label, each.kind, each.detail, each.about, each.label if bare else f'"{each.label}"')


# -------- what stands there -----------------------------------------------------------------------------------


def said_at(written: WrittenText, offset: int) -> str:
    """Meaning of a name, a function, a field, a kind or a table at a place, Markdown; "" of all else."""
    mention = written.mention_at(offset)
    if mention is not None:
        return name_said(written, mention.declared)
    word = _word_at(written.text, offset)
    for path, span in written.index.pieces:
        if span.start <= offset <= span.end:
            return _key_said(written, path)
    for path, span in written.index.values.items():
        if path[-1:] == ("kind",) and span.start <= offset <= span.end:
            return next((f"**{cls.kind}**: {gist(cls)}\n\n{about(cls)}" for cls in written.classes_at(path[:-1])), "")
    if word in FUNCTIONS or word in NAMES:
        return f"**{_signature(word)}**\n\n{function_about(word)}"
    return ""


def _key_said(written: WrittenText, path: tuple[Any, ...]) -> str:
    cls, slot = written.slots_at(path[:-1]).get(path[-1], (None, None))
    if cls is None or slot is None:
        return ""
    return f"**{path[-1]}** of {cls.__name__}\n\n{field_meaning(cls, slot.name)}".rstrip()


def name_said(written: WrittenText, declared: tuple[Any, ...]) -> str:
    """A declared name: what it is, its value in the author's unit, the remark of the author."""
    return f"**{declared[-1]}**: {kind_in_words(declared)}\n\n{value_said(written, declared)}".rstrip()


def value_said(written: WrittenText, declared: tuple[Any, ...]) -> str:
    """The value of a name as the author wrote it, with its unit; of a formula its number too; the author's remark."""
    lines = []
    unit = written.plain((*declared, "unit"))
    for key in STARTS:
        own = declared if key == "value" and not written.value((*declared, key)) else (*declared, key)
        text = written.plain(own)
        if not text or text[0] in "{[":
            continue
        number = _number(written.text, declared, unit) if key == "value" and not _is_number(text) else ""
        each = {"speed": f"{unit}/s" if unit else "", "rate": ""}.get(key, unit)
        lines.append(f"{key} = {text} {each}".rstrip() + number)
    kind = written.plain((*declared, "kind")) or written.plain((*declared, "joint", "kind"))
    lines += [kind] if kind else []
    place = written.value(declared)
    lines += [place] if place.startswith("[") and "points" in declared and not place.startswith("[points") else []
    remark = written.plain((*declared, "about"))
    return "\n\n".join([*(f"`{line}`" for line in lines), *([remark] if remark else [])])


def _is_number(text: str) -> bool:
    try:
        float(text.replace("_", ""))
    except ValueError:
        return False
    return True


def _number(text: str, declared: tuple[Any, ...], unit: str) -> str:
    """The number of a parameter that is a formula, in its unit; "" where there is none."""
    model = _model(text)
    if model is None or declared[0] != "parameters" or declared[1] not in model.parameters:
        return ""
    value = model.exact_parameters().get(declared[1])
    own = model.parameters[declared[1]].unit or model.units_of([declared[1]]).get(declared[1])
    if value is None:
        return ""
    size = 1.0 if own is None else float(own.size)
    return f" = {float(value) / size:.6g} {'' if own is None else own.text}".rstrip()


@lru_cache(maxsize=4)
def _model(text: str) -> Model | None:
    try:
        return loads(text)
    except EomgenError:
        return None


def kind_in_words(declared: tuple[Any, ...]) -> str:
    """ "parameter", "point of arm"."""
    if len(declared) < 2:
        return "point"
    if len(declared) == 4:
        return f"point of {declared[1]}"
    singular = {"bodies": "body", "trusses": "truss"}
    return singular.get(declared[0], str(declared[0]).removesuffix("s"))


def gist(cls: type[Any]) -> str:
    """The first line of a class's docstring."""
    return (inspect.getdoc(cls) or "").partition("\n")[0]


def about(cls: type[Any]) -> str:
    """The keys of a kind, each with its meaning."""
    return "\n".join(f"- `{slot.key}`: {field_meaning(cls, slot.name)}" for slot in cls.slots() if not slot.inline)


def field_meaning(cls: type[Any], field: str) -> str:
    """The meaning of a field, as the reference has it."""
    return re.sub(r"\bNone\b", "left out", cls.meanings().get(field, ""))


def _signature(name: str) -> str:
    return f"{name}{FUNCTIONS[name].arguments}" if name in FUNCTIONS else f"{name}({', '.join('xy'[: NAMES[name]])})"


def function_about(name: str) -> str:
    """Result of a function, and its unit."""
    if name not in FUNCTIONS:
        return "an elementary function"
    function = FUNCTIONS[name]
    return f"{function.gives} [{function.in_unit}]" if function.in_unit not in ("", "1") else str(function.gives)


def _word_at(text: str, offset: int) -> str:
    start = end = offset
    while start > 0 and (text[start - 1].isalnum() or text[start - 1] == "_"):
        start -= 1
    while end < len(text) and (text[end].isalnum() or text[end] == "_"):
        end += 1
    return text[start:end]


# -------- protocol --------------------------------------------------------------------------------------------
# `eomgen lsp`: the answers of this room over the Language Server Protocol, on stdin and stdout (pygls).
#
# A text is looked at DELAY after the last change. Its columns count characters; those of an editor may count otherwise,
# which its codec translates.


DELAY = 0.08  # s
KINDS = {"table": "Module", "kind": "Class", "field": "Field", "name": "Variable", "function": "Function"}


def answer_editor() -> None:
    """Answers an editor on stdin and stdout until it is through.

    Raises:
        ToolMissing: pygls is not installed.
    """
    server_of().start_io()


def server_of() -> LanguageServer:
    """A server with all answers.

    Raises:
        ToolMissing: pygls is not installed.
    """
    try:
        from lsprotocol import types
        from pygls.exceptions import JsonRpcInvalidParams
        from pygls.lsp.server import LanguageServer
    except ModuleNotFoundError:
        raise ToolMissing("there is no package that speaks with editors", fix="pip install 'eomgen[lsp]'") from None

    server = LanguageServer("eomgen", __version__)

    async def looked_at(uri: str, version: int | None) -> None:
        await asyncio.sleep(DELAY)
        document = server.workspace.get_text_document(uri)
        if document.version == version:
            _publish(server, document, problems_of_text(document.source, uri) if _is_model(document) else [])

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    async def changed(params: Any) -> None:
        await looked_at(params.text_document.uri, server.workspace.get_text_document(params.text_document.uri).version)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: types.DidCloseTextDocumentParams) -> None:
        nothing = types.PublishDiagnosticsParams(uri=params.text_document.uri, diagnostics=[])
        server.text_document_publish_diagnostics(nothing)

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[".", "[", '"', "="]))
    def offered(params: types.CompletionParams) -> types.CompletionList:
        document, offset = _place(server, params)
        offers = offers_at(WrittenText(document.source), offset) if _is_model(document) else []
        return types.CompletionList(is_incomplete=False, items=[_item(each) for each in offers])

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def said(params: types.HoverParams) -> types.Hover | None:
        document, offset = _place(server, params)
        words = said_at(WrittenText(document.source), offset) if _is_model(document) else ""
        return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, words)) if words else None

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def declared(params: types.DefinitionParams) -> types.Location | None:
        document, offset = _place(server, params)
        written = WrittenText(document.source)
        mention = written.mention_at(offset)
        if mention is None:
            return None
        return types.Location(document.uri, _range(document, written.declarations[mention.declared]))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def mentioned(params: types.ReferenceParams) -> list[types.Location]:
        document, offset = _place(server, params)
        return [types.Location(document.uri, _range(document, span)) for span in _spans(document, offset)]

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def can_be_renamed(params: types.PrepareRenameParams) -> types.Range | None:
        document, offset = _place(server, params)
        mention = WrittenText(document.source).mention_at(offset)
        return None if mention is None else _range(document, mention.span)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def renamed(params: types.RenameParams) -> types.WorkspaceEdit | None:
        document, offset = _place(server, params)
        written = WrittenText(document.source)
        mention = written.mention_at(offset)
        if mention is None:
            return None
        try:
            spans = written.renamed(mention, params.new_name)
        except EomgenError as error:
            raise JsonRpcInvalidParams(message=f"{error.what}; {error.fix}") from error
        edits = [types.TextEdit(_range(document, span), params.new_name) for span in spans]
        return types.WorkspaceEdit(changes={document.uri: edits})

    return server


def _is_model(document: TextDocument) -> bool:
    """True if a file says that it is a model: other TOML is none of ours."""
    return WrittenText(document.source).is_model


def _spans(document: TextDocument, offset: int) -> Iterable[Any]:
    written = WrittenText(document.source)
    mention = written.mention_at(offset)
    return () if mention is None else (x.span for x in written.mentions if x.declared == mention.declared)


def _place(server: LanguageServer, params: Any) -> tuple[TextDocument, int]:
    """The document, and the place in its characters."""
    document = server.workspace.get_text_document(params.text_document.uri)
    return document, document.offset_at_position(params.position)


def _range(document: TextDocument, span: Any) -> types.Range:
    """A stretch of the text as the editor counts it."""
    from lsprotocol import types

    def position(offset: int) -> types.Position:
        before = document.source[:offset]
        return types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)

    return document.position_codec.range_to_client_units(
        document.lines, types.Range(position(span.start), position(span.end))
    )


def _publish(server: LanguageServer, document: TextDocument, found: list[TextProblem]) -> None:
    from lsprotocol import types

    severity = {False: types.DiagnosticSeverity.Error, True: types.DiagnosticSeverity.Warning}
    diagnostics = []
    for each in found:
        first = types.Position(each.line - 1, each.column - 1)
        last = types.Position(each.line - 1, each.column - 1 + each.length)
        place = document.position_codec.range_to_client_units(document.lines, types.Range(first, last))
        diagnostics.append(types.Diagnostic(place, each.text, severity=severity[each.is_warning], source="eomgen"))
    told = types.PublishDiagnosticsParams(uri=document.uri, version=document.version, diagnostics=diagnostics)
    server.text_document_publish_diagnostics(told)


def _item(offer: Offer) -> types.CompletionItem:
    from lsprotocol import types

    kind = getattr(types.CompletionItemKind, KINDS.get(offer.kind, "Value"))
    said = types.MarkupContent(types.MarkupKind.Markdown, offer.about) if offer.about else None
    return types.CompletionItem(
        offer.label, kind=kind, detail=offer.detail or None, documentation=said, insert_text=offer.insert or None
    )
