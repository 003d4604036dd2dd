"""Advances of the letters of formulas [thousandths of their size]: of our pages' font, and of the one of papers.

python tests/helpers/advances_of_fonts.py > eomgen/symbolic/print/advances.json

It needs fonttools, brotli and typst, whose program carries the letters of papers.
"""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

OWN = Path(__file__).parents[2] / "eomgen/page/fonts/stix_two_math.woff2"
PAPER = "NewComputerModernMath-Regular"
ASCII = "".join(map(chr, range(0x20, 0x7F)))
ITALIC = "".join(chr(c) for c in range(0x1D434, 0x1D468) if c != 0x1D455) + "ℎ"
GREEK = "".join(map(chr, range(0x1D6FC, 0x1D716))) + "ΓΔΘΛΞΠΣΥΦΨΩ"
SIGNS = "∂∑⋅×±≤≥≠≈∞→∫…⋯∘′√°−·"
LINE = 108  # characters of a line of the table


def fonts() -> dict[str, Any]:
    """The fonts: of pages, of papers."""
    import typst
    from fontTools.ttLib import TTFont

    program = next(Path(typst.__file__).parent.glob("*.so")).read_bytes()
    place = 0
    while (place := program.find(b"OTTO", place)) >= 0:
        found = TTFont(io.BytesIO(program[place:]), lazy=True)
        if found["name"].getDebugName(4) == PAPER:
            return {"page": TTFont(OWN), "paper": found}
        place += 4
    raise ValueError(f"{PAPER} was not found")


def advances(font: Any) -> dict[str, int]:
    """character -> advance; what the font lacks is left out."""
    named, per_em = font.getBestCmap(), font["head"].unitsPerEm
    return {
        c: round(1000 * font["hmtx"][named[ord(c)]][0] / per_em)
        for c in ASCII + ITALIC + GREEK + SIGNS
        if ord(c) in named
    }


def larger(font: Any, sign: str) -> list[int]:
    """The advances of the larger forms of a sign."""
    variants = font["MATH"].table.MathVariants
    place = variants.VertGlyphCoverage.glyphs.index(font.getBestCmap()[ord(sign)])
    forms = variants.VertGlyphConstruction[place].MathGlyphVariantRecord
    return [round(1000 * font["hmtx"][form.VariantGlyph][0] / font["head"].unitsPerEm) for form in forms]


def table() -> str:
    """The file, a few letters a line."""
    found = []
    for name, font in fonts().items():
        lines = [""]
        for word in (f"{json.dumps(c)}: {advance}, " for c, advance in advances(font).items()):
            if len(lines[-1]) + len(word) > LINE:
                lines.append("")
            lines[-1] += word
        letters = "\n".join(f"    {line.rstrip()}" for line in lines).rstrip(",")
        brackets = ",\n".join(f"    {json.dumps(c)}: {larger(font, c)}" for c in "([{|√")
        found.append(f'"{name}": {{\n  "letters": {{\n{letters}\n  }},\n  "larger": {{\n{brackets}\n  }}\n}}')
    return "{\n" + ",\n".join(found) + "\n}"


if __name__ == "__main__":
    print(table())
