"""Our LaTeX -> the mathematics of Typst, which sets papers without TeX: the same commands, one after the other."""

from __future__ import annotations

import re
from collections.abc import Callable

TOKEN = re.compile(r"\\[a-zA-Z]+\*?|\\.|\d+(?:\.\d+)?|[^\s]", re.DOTALL)
SMALL = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi"
    " omega varphi vartheta varepsilon varrho varpi varsigma varkappa"
).split()
LARGE = "Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega".split()
GREEK = dict(zip(SMALL + LARGE, "αβγδϵζηθικλμνξπρστυϕχψωφϑεϱϖςϰΓΔΘΛΞΠΣΥΦΨΩ", strict=True))
NAMED = (
    "partial sum cdot times pm leq geq neq approx infty to int ldots cdots dots circ langle rangle ell nabla ast star"
    " bullet dagger parallel perp hbar prime vdots ddots"
).split()
SIGNS = dict(zip(NAMED, "∂∑⋅×±≤≥≠≈∞→∫…⋯…∘⟨⟩ℓ∇∗⋆∙†∥⟂ℏ′⋮⋱", strict=True))
SIGNS |= {"quad": "quad", "qquad": "quad quad", **dict.fromkeys(("lvert", "rvert", "mid"), r"\|")}
SIGNS |= {"lbrace": r"\{", "rbrace": r"\}", "lbrack": r"\[", "rbrack": r"\]"}
WORDS = "sin cos tan sinh cosh tanh arcsin arccos arctan ln log exp min max det".split()
SPACES = {",": "thin", ":": "med", ";": "thick", " ": "space", "!": ""}
ACCENTS = {"dot": "dot", "ddot": "dot.double", "dddot": "dot.triple", "vec": "arrow", "bar": "macron"}
ACCENTS |= {"hat": "hat", "widehat": "hat", "tilde": "tilde", "widetilde": "tilde", "overline": "overline"}
UPRIGHT = {"mathrm": "upright", "mathsf": "sans", "mathbf": "bold", "mathit": "italic", "mathcal": "cal"}
UPRIGHT |= {"operatorname": "op", "text": "", "textrm": ""}
DELIMITERS = {"pmatrix": '"("', "bmatrix": '"["', "vmatrix": '"|"', "matrix": "#none"}
ESCAPED = set("\\/#$\"_^&()[]{}|,;:`@~*'=")  # what means something to Typst


class UnknownCommand(ValueError):
    """A command that is none of ours."""


def typst_math(tex: str) -> str:
    """A formula between Typst's dollars.

    Raises:
        UnknownCommand: a command that is none of ours.
    """
    return _Reader(tex).until()


def string(text: str) -> str:
    """A text as Typst's string: nothing in it is markup."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


class _Reader:
    """Tokens, one after the other."""

    def __init__(self, tex: str) -> None:
        self._tex, self._place = tex, 0

    def _next(self) -> str | None:
        """The next token, and past it; None at the end."""
        found = TOKEN.search(self._tex, self._place)
        if found is None:
            return None
        self._place = found.end()
        return found[0]

    def _seen(self) -> str | None:
        place = self._place
        found = self._next()
        self._place = place
        return found

    def until(self, *ends: str) -> str:
        """Everything up to one of these tokens, which is taken."""
        parts: list[str] = []
        while (token := self._next()) is not None and token not in ends:
            parts.append(self._one(token))
        return " ".join(part for part in parts if part)

    def _one(self, token: str) -> str:
        if token in "_^" and len(token) == 1:
            return f"{token}({self._argument()})"
        if token == "{":
            return self.until("}")
        if token == "&":
            return "&"
        if token == "\\\\":
            return "\\\n"
        if token.startswith("\\"):
            return self._command(token[1:])
        return f"\\{token}" if token in ESCAPED - {"=", "'", "*", ":"} else token

    def _argument(self) -> str:
        token = self._next()
        return "" if token is None else self._one(token)

    def _words(self) -> str:
        """What stands between the next braces, as words."""
        start = self._tex.index("{", self._place) + 1
        depth, place = 1, start
        while depth:
            place += 2 if self._tex[place] == "\\" else 1
            depth += {"{": 1, "}": -1}.get(self._tex[place - 1], 0) if self._tex[place - 2] != "\\" else 0
        self._place = place
        return _plain(self._tex[start : place - 1])

    def _command(self, name: str) -> str:
        if name in GREEK or name in SIGNS:
            return GREEK.get(name) or SIGNS[name]
        if name in WORDS:
            return name
        if name in SPACES:
            return SPACES[name]
        if name in ACCENTS:
            return f"{ACCENTS[name]}({self._argument()})"
        if name in UPRIGHT:
            return f"{UPRIGHT[name]}({string(self._words())})" if UPRIGHT[name] else string(self._words())
        if name in STRUCTURES:
            return STRUCTURES[name](self)
        if len(name) == 1 and not name.isalnum():  # \_ \{ \%
            return f"\\{name}"
        raise UnknownCommand(f"\\{name}")

    def fraction(self, inline: bool = False) -> str:
        above, below = self._argument(), self._argument()
        whole = f"frac({above}, {below})"
        return f"inline({whole})" if inline else whole

    def root(self) -> str:
        return f"sqrt({self._argument()})"

    def grown(self) -> str:
        """\\left( ... \\right)"""
        opening = self._delimiter()
        inside = self.until("\\right")
        return f"lr({opening} {inside} {self._delimiter()})"

    def big(self) -> str:
        return f"lr(size: #130%, {self._delimiter()})"

    def _delimiter(self) -> str:
        token = self._next() or "."
        return "" if token == "." else self._one(token)

    def environment(self) -> str:
        """\\begin{aligned} ... \\end{aligned}"""
        name = self._words()
        inside = self.until("\\end")
        self._words()
        rows = [row.strip() for row in inside.split("\\\n")]
        if name == "aligned":
            return " \\\n".join(LEADING.sub(r'\1 "" \2', row) for row in rows)
        if name == "cases":
            return f"cases({', '.join(rows)})"
        if name in DELIMITERS:
            return f"mat(delim: {DELIMITERS[name]}, {'; '.join(row.replace('&', ',') for row in rows)})"
        raise UnknownCommand(f"\\begin{{{name}}}")


LEADING = re.compile(r"^(& ?(?:quad)?) ([+-])")  # a sign that goes on with the row above stands apart from its term

STRUCTURES: dict[str, Callable[[_Reader], str]] = {
    "frac": _Reader.fraction,
    "tfrac": lambda reader: reader.fraction(inline=True),
    "dfrac": _Reader.fraction,
    "sqrt": _Reader.root,
    "left": _Reader.grown,
    **{name: _Reader.big for name in ("big", "bigl", "bigr")},
    "begin": _Reader.environment,
}


def _plain(tex: str) -> str:
    r"""The words of \mathrm{...} and \text{...}: escapes undone, Greek letters by themselves."""
    tex = re.sub(r"\\([a-zA-Z]+)(?:\{\})?", lambda found: GREEK.get(found[1]) or SIGNS.get(found[1], ""), tex)
    return re.sub(r"\\(.)", r"\1", tex).replace("$", "").replace("^{", "^").replace("{", "").replace("}", "")
