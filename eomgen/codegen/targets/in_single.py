"""Files of a language in doubles -> the same in single precision, by a table of words; remarks and strings stay."""

from __future__ import annotations

import re
from collections.abc import Mapping

from eomgen.codegen.targets.base import FileContent
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import NAMES

QUOTED = r'"(?:\\.|[^"\\])*"'
FUNCTIONS = "|".join(sorted({*NAMES, "pow", "fabs", "fmin", "fmax"} - {"abs", "sign", "min", "max"}))
SUFFIXED = (r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+|\.\d+(?:e[+-]?\d+)?)(?![\w.])", r"\1f")


@dataclass(frozen=True)
class SingleWords:
    """What becomes of the words of a language; what they became stays as it is.

    Args:
        changes: (pattern, replacement), one after the other.
        kept: remarks and strings.
        paths: of the files that are changed, a pattern.
    """

    changes: tuple[tuple[str, str], ...]
    kept: str
    paths: str

    def text(self, text: str) -> str:
        """A text in single precision."""
        found, at = [], 0
        for kept in re.finditer(self.kept, text, re.DOTALL):
            found += [self._changed(text[at : kept.start()]), kept.group()]
            at = kept.end()
        return "".join([*found, self._changed(text[at:])])

    def _changed(self, code: str) -> str:
        for pattern, replacement in self.changes:
            code = re.sub(pattern, replacement, code, flags=re.MULTILINE)
        return code

    def files(self, files: Mapping[str, FileContent]) -> dict[str, FileContent]:
        """Files of one function or of all, by path."""
        return {path: self.text(str(x)) if re.search(self.paths, path) else x for path, x in files.items()}
