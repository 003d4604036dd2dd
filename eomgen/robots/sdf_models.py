"""The models of an SDF file -> the one that is imported, with its nested and included models as links of its own.

A nested model `arm` gives links, joints and frames called `arm::...`, and a frame `arm`, from which their poses count.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import field
from pathlib import Path

from eomgen.errors import ModelError
from eomgen.files import read
from eomgen.model.findings import nearest
from eomgen.records import dataclass
from eomgen.robots.xml_tree import XmlElement, xml_tree

LARGEST = 20_000_000  # bytes of a file
DEEPEST = 30  # models one within the other
PLACED = ("link", "joint", "frame")
REFERRING = ("relative_to", "attached_to", "expressed_in", "joint")  # attributes that name something of the model


@dataclass(frozen=True)
class ModelScope:
    """Where elements of a model stand.

    Args:
        frame: that of their model, from which poses count.
        files: that include one another, theirs last.
        old: an axis is given in that frame.
        prefix: of their names.
    """

    frame: str = "__model__"
    files: tuple[str, ...] = ()
    old: bool = False
    prefix: str = ""

    def named(self, name: str) -> str:
        """What a name in the model means in the whole."""
        if name in ("", "world"):
            return name
        return self.frame if name == "__model__" else f"{self.prefix}{name}"


@dataclass
class FlatModel:
    """A model whose nested models are frames, their links, joints and frames its own.

    Args:
        scopes: by the identity of an element, where it stands; those that are not there stand in `scope`.
        nested: the models within it, by the names of their frames.
        canonical: the link with which each of these frames moves.
    """

    model: XmlElement
    scope: ModelScope
    scopes: dict[int, ModelScope] = field(default_factory=dict)
    nested: dict[str, XmlElement] = field(default_factory=dict)
    canonical: dict[str, str] = field(default_factory=dict)

    def scope_of(self, element: XmlElement) -> ModelScope:
        return self.scopes.get(id(element), self.scope)


@dataclass(frozen=True)
class SdfChoice:
    """A model of a file that may be imported: itself or what includes it, and the gravity of its world."""

    element: XmlElement
    gravity: XmlElement | None
    scope: ModelScope

    @property
    def name(self) -> str:
        if self.element.tag == "model":
            return self.element.attributes.get("name", "")
        given = {child.tag: child.text for child in self.element.children}
        return given.get("name") or given.get("uri", "").rpartition("/")[2]

    def is_called(self, name: str) -> bool:
        """By its own name, or by that of the file's model which it includes."""
        if self.name == name:
            return True
        try:
            return self.element.tag == "include" and included(self.element, self.scope)[0].attributes["name"] == name
        except (ModelError, KeyError):
            return False

    def flat(self) -> FlatModel:
        """Raises: ModelError: what it includes is not there."""
        model, scope = self.element, self.scope
        model.seen = True
        if model.tag == "include":
            model, scope = included(model, scope)
            self.element.children.append(model)  # what nobody reads of it is left out
        found = FlatModel(model, scope)
        _flatten(found, model, scope)
        return found


def choices(root: XmlElement, file: str) -> list[SdfChoice]:
    """The models of a file, of its worlds, and those that worlds include, in their order."""
    scope = ModelScope(files=(str(Path(file).resolve()),), old=_is_old(root))
    found = []
    for top in root.all("world") or [root]:
        top.get("name")
        gravity = None if top is root else top.one("gravity")
        found += [SdfChoice(x, gravity, scope) for x in top.children if x.tag in ("model", "include")]
    return found


def choice_named(choices: list[SdfChoice], name: str, root: XmlElement) -> SdfChoice:
    """The model of a name.

    Raises:
        ModelError: there is none.
    """
    found = next((each for each in choices if each.is_called(name)), None)
    if found is None:
        names = [each.name for each in choices]
        raise ModelError(
            f"no model is called '{name}'", root.where, nearest(name, names) or f"one of {', '.join(names)}"
        )
    return found


def included(include: XmlElement, scope: ModelScope) -> tuple[XmlElement, ModelScope]:
    """The model of the file that an <include> names; <name>, <static>, <pose> are the include's.

    Raises:
        ModelError: no such file, or no model in it.
    """
    uri = include.one("uri")
    where = plain_path("" if uri is None else uri.text)
    file = file_of(where, scope.files)
    if file is None:
        raise ModelError(f"no file is there for '{where}'", include.where, "put it into this folder, or one above it")
    if str(file) in scope.files:
        raise ModelError(f"'{where}' includes itself", include.where, "take one <include> out")
    root = xml_tree(read(file, LARGEST), str(file))
    model = root.one("model")
    if model is None:
        raise ModelError("the file holds no <model>", root.where, "include one with a model")
    title, own = include.one("name"), [x for x in (include.one("static"), include.one("pose")) if x is not None]
    attributes = dict(model.attributes) if title is None else {**model.attributes, "name": title.text}
    if frame := include.get("placement_frame"):
        attributes["placement_frame"] = frame
    kept = [child for child in model.children if child.tag not in {x.tag for x in own}]
    made = XmlElement("model", attributes, model.where, [*own, *kept], seen=True)
    return made, ModelScope(files=(*scope.files, str(file)), old=_is_old(root))


def file_of(uri: str, files: tuple[str, ...]) -> Path | None:
    """The file, or the folder's model, that an address means: beside the last of `files`, or above it."""
    where = plain_path(uri)
    places = [folder / where for folder in Path(files[-1]).parents]
    return next((x for place in places for x in (place, place / "model.sdf") if where and x.is_file()), None)


def plain_path(uri: str) -> str:
    """An address without its scheme."""
    return re.sub(r"^(model|file|package)://", "", uri)


def _is_old(root: XmlElement) -> bool:
    text = root.get("version", "1.10") or "1.10"
    return tuple(int(part) for part in text.split(".") if part.isdigit()) < (1, 5)


def _flatten(found: FlatModel, model: XmlElement, scope: ModelScope) -> None:
    """Moves what models within a model hold into the whole, under its name there."""
    if scope.prefix.count("::") > DEEPEST:
        raise ModelError(f"more than {DEEPEST} models stand one in the other", model.where, "make it flatter")
    for within, own, merged in list(_within(model, scope)):
        title = within.get("name") or "model"
        frame = scope.named(f"_merged__{title}__model__" if merged else title)
        inner = ModelScope(frame, own.files, own.old, scope.prefix if merged else f"{scope.named(title)}::")
        within.attributes = {**within.attributes, "name": frame}
        for key in ("placement_frame", "canonical_link"):
            if key in within.attributes:
                within.attributes = {**within.attributes, key: inner.named(within.attributes[key])}
        for pose in (child for child in within.children if child.tag == "pose"):
            _rename(pose, scope)
        found.scopes[id(within)] = scope
        if frame in found.nested:
            raise ModelError(f"two models within one are called '{title}'", within.where, "give each a name of its own")
        found.nested[frame] = within
        moved = [child for child in within.children if child.tag in PLACED]
        within.children = [child for child in within.children if child.tag not in PLACED]
        for child in moved:
            child.attributes = {**child.attributes, "name": inner.named(child.need("name"))}
            _rename(child, inner)
            found.scopes[id(child)] = inner
        found.model.children += moved
        count = len(found.model.children)
        _flatten(found, within, inner)
        links = [x for x in (*moved, *found.model.children[count:]) if x.tag == "link"]
        first = links[0].attributes["name"] if links else ""
        found.canonical[frame] = within.get("canonical_link") or first


def _within(model: XmlElement, scope: ModelScope) -> Iterator[tuple[XmlElement, ModelScope, bool]]:
    """The models within a model, where they come from, whether they are merged into it."""
    for child in [*model.children]:
        if child.tag == "model":
            child.seen = True
            yield child, scope, False
        elif child.tag == "include":
            uri = next((x.text for x in child.children if x.tag == "uri"), "")
            if file_of(uri, scope.files) is None:
                continue  # it is told among what is left out
            child.seen = True
            inner, own = included(child, scope)
            child.children.append(inner)
            yield inner, own, child.get("merge") in ("true", "1")


def _rename(element: XmlElement, scope: ModelScope) -> None:
    """Whatever an element and those in it name of their model, by its name in the whole."""
    told: Mapping[str, str] = element.attributes
    element.attributes = {key: scope.named(x) if key in REFERRING else x for key, x in told.items()}
    if element.tag in ("parent", "child"):
        element.text = scope.named(element.text)
    for child in element.children:
        _rename(child, scope)
