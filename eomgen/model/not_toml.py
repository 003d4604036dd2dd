"""What tomllib refuses -> what is wrong and how it is mended: other formats, other habits of writing."""

from __future__ import annotations

import re

from eomgen.symbolic.expression.habits import invisible

_TABLES = 'write: name = "crane", and [bodies.boom] for a table'
_OTHERS = (
    (re.compile(r"(?:\s|#[^\n]*\n|---)*[A-Za-z_]\w*:(?:\s|$)"), "this looks like YAML", _TABLES),
    (re.compile(r"\s*\{"), "this looks like JSON", _TABLES),
    (re.compile(r"\s*<"), "this looks like XML", "`eomgen import` makes a model of a robot's file"),
    (re.compile(r"\s*(?:import|from) \w|\s*def \w+\("), "this looks like Python", "a model made there is run there"),
    (re.compile(r"PK\x03\x04"), "this is an archive, no text", "give the model, a file .toml"),
)
_WORDS = re.compile(r"\s*(name|about|source|space)\s*=\s*([A-Za-z][\w ]*)$")
_COMMA = re.compile(r"=\s*([-+]?\d+(?:\.\d{3})*),(\d+)\b")


def told_of_toml(what: str, text: str, offset: int) -> tuple[str, str]:
    """(what is wrong, how to mend it) where tomllib stops.

    Args:
        what: it says.
        offset: of the place at which it stops.
    """
    for begins, looks, mend in _OTHERS:
        if begins.match(text):
            return looks, mend
    before, culprit = text[:offset], text[offset : offset + 1]
    return what, _of_character(before, culprit) or _of_line(what, text, before, culprit) or _of_words(what)


def _of_character(before: str, culprit: str) -> str:
    """By the character at which it stops."""
    if culprit in ("\n", "#") and before.rfind("{") > max(before.rfind("}"), before.rfind("\n[")):
        return "a table in braces stands in one line; or write it as one with a head, like [bodies.boom.joint]"
    if culprit == ";" and before.count("[") > before.count("]"):
        return "a comma stands between two of a list: [1, 0]"
    if culprit in tuple("“”„‘’"):
        return 'quotes are straight: "'
    if culprit in tuple("−–—"):
        return "write -"
    if culprit == "\r":
        return "its lines end in CR alone: let them end in LF or CRLF"
    if culprit == "(":
        return "brackets of a list and of a head are square: [0, 1], [outputs]"
    if culprit == "}" and before.rstrip(" \t").endswith(","):
        return "leave out the comma before }"
    return invisible(culprit)


def _of_line(what: str, text: str, before: str, culprit: str) -> str:
    """By the line in which it stops."""
    line = text[before.rfind("\n") + 1 :].split("\n", 1)[0]
    if found := _COMMA.search(line):
        return f"write a decimal point: {found[1].replace('.', '')}.{found[2]}"
    if words := _WORDS.match(line):
        return f'a text stands in quotes: {words[1]} = "{words[2].strip()}"'
    if culprit in ("/", ";"):
        return "a remark begins with #" if culprit == "/" else "leave it out: a line ends by itself"
    if line.lstrip().startswith("[["):
        return "a table has a name and single brackets: [bodies.boom]"
    if culprit.isalpha() and not culprit.isascii():
        return f'as a key a name with such letters stands in quotes: "{culprit}" = 1'
    if "\\" in line and ("'\\'" in what or "hex" in what):
        return r"in single quotes a backslash is one: symbol = '\theta_A'"
    if culprit == "\n" and line.count('"') % 2:
        return "a text ends with its quote, in the same line"
    return ""


def _of_words(what: str) -> str:
    """By what tomllib says."""
    if "digits" in what or "deep" in what:
        return "make it smaller"
    if "Expected '='" in what:
        return 'a line is NAME = VALUE: angle = "theta - pi/2"'
    return (
        'an expression stands in quotes: angle = "theta - pi/2"' if "value" in what.lower() else "see https://toml.io"
    )
