"""Table of the advances of the letters of formulas: of our pages' font, and of the one that papers are set in.

python tests/helpers/advances_of_fonts.py > eomgen/symbolic/print/advances.py

It needs fonttools, brotli and typst, whose program carries the letters of papers.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

OWN = Path(__file__).parents[2] / "eomgen/page/fonts/stix_two_math.woff2"
PAPER = "NewComputerModernMath-Regular"
ASCII = "".join(map(chr, range(0x20, 0x7F)))
ITALIC = "".join(chr(c) for c in range(0x1D434, 0x1D468) if c != 0x1D455) + "ℎ"
GREEK = "".join(map(chr, range(0x1D6FC, 0x1D716))) + "ΓΔΘΛΞΠΣΥΦΨΩ"
SIGNS = "∂∑⋅×±≤≥≠≈∞→∫…⋯∘′√°−·"
LINE = 108  # characters of a line of the table

HEAD = '''"""Advances of the letters of formulas, in thousandths of their size; made by the command below.

python tests/helpers/advances_of_fonts.py > eomgen/symbolic/print/advances.py

A letter that is slanted in a formula stands there as that letter of its own, h as \\u210e; after each bracket stand the
larger ones that are drawn for it.
"""

# fmt: off
'''


def fonts() -> dict[str, Any]:
    """The fonts: of pages, of papers."""
    import typst
    from fontTools.ttLib import TTFont

    program = next(Path(typst.__file__).parent.glob("*.so")).read_bytes()
    place = 0
    while (place := program.find(b"OTTO", place)) >= 0:
        found = TTFont(io.BytesIO(program[place:]), lazy=True)
        if found["name"].getDebugName(4) == PAPER:
            return {"PAGE": TTFont(OWN), "PAPER": found}
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
    """The module."""
    lines = [HEAD]
    for name, font in fonts().items():
        lines.append(f"{name} = {{")
        line = ""
        for c, advance in advances(font).items():
            word = f"{c!a}: {advance}, "
            if len(line) + len(word) > LINE:
                lines.append(f"    {line.rstrip()}")
                line = ""
            line += word
        lines += [f"    {line.rstrip()}", "}"]
        lines.append(f"{name}_LARGER = {{")
        lines += [f"    {c!a}: {tuple(larger(font, c))}," for c in "([{|√"]
        lines.append("}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
