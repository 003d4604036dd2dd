"""The notebooks from their scripts, executed: `python notebooks/build.py [NAME ...]` writes NAME.ipynb beside NAME.py.

A script is text in cells, each below a line `# %%` (code) or `# %% [markdown]`, as editors know them. A notebook is the
same cells with what they show. It is shown by code hosts, which run no program: a moving picture is kept as an animated
PNG, since GIFs are not shown everywhere. Nothing in it depends on when, where or how often it was made.
`tests/test_notebooks.py` runs each script and compares what it finds with the notebook (`differences`).
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import math
import re
import sys
import tempfile
import warnings
from base64 import b64decode, b64encode
from collections.abc import Iterator
from itertools import count, zip_longest
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
COLORS, NEARLY_WHITE = 64, 246  # of a picture; what is lighter is paper
SAME = 1e-6  # numbers that differ by less, as a part of themselves or alone, say the same
NUMBER = re.compile(r"(?<![\w.])(\d+(?:\.\d*)?(?:e[-+]?\d+)?)(?![\w.])")
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
}
Cell = dict[str, Any]


def scripts() -> list[Path]:
    """The scripts of the notebooks, in the order in which they are read."""
    return sorted(HERE.glob("[0-9]_*.py"))


def cells_of(text: str) -> list[tuple[bool, str]]:
    """(true of code, text) of each cell of a script."""
    found = []
    for part in re.split(r"^# %%", text, flags=re.MULTILINE)[1:]:
        kind, _, lines = part.partition("\n")
        is_code = kind.strip() != "[markdown]"
        found.append((is_code, (lines if is_code else re.sub(r"^# ?", "", lines, flags=re.MULTILINE)).strip("\n")))
    return found


def notebook_of(script: Path) -> dict[str, Any]:
    """The notebook of a script, run from its first cell to its last, in an empty folder beside the models.

    Raises:
        Exception: whatever a cell raises, its warnings among it.
    """
    import matplotlib

    matplotlib.use("Agg")
    names: dict[str, Any] = {"__name__": "__main__"}
    cells: list[Cell] = []
    counted = count(1)
    with tempfile.TemporaryDirectory() as place, warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        warnings.simplefilter("error", RuntimeWarning)
        warnings.filterwarnings("ignore", message=".*non-interactive")  # plt.show(): what it shows is taken below
        (Path(place) / "models").symlink_to(HERE.parent / "models")
        here = Path(place) / "notebooks"
        here.mkdir()
        with contextlib.chdir(here):
            for is_code, text in cells_of(script.read_text(encoding="utf-8")):
                cell: Cell = {"id": f"cell-{len(cells) + 1}", "metadata": {}, "source": lines_of(text)}
                if is_code:
                    number = next(counted)
                    outputs = list(outputs_of(text, names, number))
                    cells.append({**cell, "cell_type": "code", "execution_count": number, "outputs": outputs})
                else:
                    cells.append({**cell, "cell_type": "markdown"})
    return {"cells": cells, "metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}


def outputs_of(text: str, names: dict[str, Any], number: int) -> Iterator[Cell]:
    """The outputs of a cell of code, run among these names: what it prints, its figures, the value that it ends in."""
    tree = ast.parse(text)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, f"cell {number}", "exec"), names)
        value = None if last is None else eval(compile(ast.Expression(last.value), f"cell {number}", "eval"), names)
    if printed.getvalue():
        yield {"output_type": "stream", "name": "stdout", "text": lines_of(printed.getvalue())}
    for image in figures_drawn():
        yield {"output_type": "display_data", "data": {"image/png": image}, "metadata": {}}
    if value is not None:
        data, metadata = forms_of(value)
        yield {"output_type": "execute_result", "execution_count": number, "data": data, "metadata": metadata}


def figures_drawn() -> Iterator[bytes]:
    """The figures that the cell has drawn with pyplot, as Jupyter shows them."""
    if "matplotlib.pyplot" in sys.modules:
        pyplot = sys.modules["matplotlib.pyplot"]
        for number in pyplot.get_fignums():
            page = io.BytesIO()
            pyplot.figure(number).savefig(page, format="png", dpi=100)
            pyplot.close(number)
            yield page.getvalue()


def forms_of(value: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """The forms in which a value shows itself, and what is said of them, as a Jupyter kernel makes them."""
    from IPython.core.formatters import DisplayFormatter

    data, metadata = DisplayFormatter().format(value)
    if "image/gif" in data:
        data["image/png"], metadata = data.pop("image/gif"), {"image/png": metadata.get("image/gif", {})}
    return {form: as_kept(form, data[form]) for form in sorted(data)}, metadata


def as_kept(form: str, shown: str | bytes) -> list[str] | bytes:
    """Lines of a text; the bytes of a picture."""
    if form == "image/png":
        return b64decode(shown) if isinstance(shown, str) else shown
    assert isinstance(shown, str)
    return lines_of(shown)


def coded(image: bytes) -> str:
    """A picture, moving or not, as a PNG of few colours in base64."""
    from PIL import Image, ImageSequence

    opened = Image.open(io.BytesIO(image))
    frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(opened)]
    palette = frames[len(frames) // 2].quantize(COLORS, dither=Image.Dither.NONE)
    levels = palette.getpalette() or []
    colors = [levels[k : k + 3] for k in range(0, len(levels), 3)]
    palette.putpalette([x for color in colors for x in ([255] * 3 if min(color) > NEARLY_WHITE else color)])
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    pace = {"save_all": True, "append_images": others, "duration": opened.info["duration"], "loop": 0} if others else {}
    page = io.BytesIO()
    first.save(page, format="PNG", optimize=True, **pace)
    return b64encode(page.getvalue()).decode() + "\n"


def lines_of(text: str) -> list[str]:
    """A text as notebooks hold it: its lines, each with its end."""
    return text.splitlines(keepends=True)


def differences(notebook: dict[str, Any], other: dict[str, Any]) -> Iterator[str]:
    """What two notebooks tell otherwise, cell by cell: sources, texts and numbers; of pictures, that there are some."""
    for cell, found in zip_longest(notebook["cells"], other["cells"], fillvalue={}):
        name = cell.get("id") or found.get("id")
        if cell.get("source") != found.get("source") or cell.get("cell_type") != found.get("cell_type"):
            yield f"{name}: another source"
            continue
        for output, made in zip_longest(map(told, cell.get("outputs", ())), map(told, found.get("outputs", ()))):
            if output is None or made is None or output.keys() != made.keys():
                yield f"{name}: outputs of other kinds"
            else:
                yield from (f"{name}: another {form}" for form in output if not says_the_same(output[form], made[form]))


def told(output: Cell) -> dict[str, str]:
    """The texts of an output by their form; a picture is one without a word."""
    data = output.get("data") or {output["name"]: output["text"]}
    return {form: "" if form.startswith("image/") else "".join(lines) for form, lines in data.items()}


def says_the_same(text: str, other: str) -> bool:
    """True if two texts have the same words, and numbers that differ by rounding at most."""
    pieces, found = NUMBER.split(text), NUMBER.split(other)
    if pieces[::2] != found[::2]:
        return False
    pairs = zip(pieces[1::2], found[1::2], strict=True)
    return all(math.isclose(float(x), float(y), rel_tol=SAME, abs_tol=SAME) for x, y in pairs)


def written(notebook: dict[str, Any]) -> str:
    """The text of its file, its pictures coded."""
    return json.dumps(notebook, indent=1, sort_keys=True, ensure_ascii=False, default=coded) + "\n"


def main(asked: list[str]) -> None:
    """Writes the notebooks that are named, or all."""
    for script in scripts():
        if not asked or script.stem in asked:
            text = written(notebook_of(script))
            script.with_suffix(".ipynb").write_text(text, encoding="utf-8")
            print(f"{script.with_suffix('.ipynb').name}: {len(text) // 1024} KB")


if __name__ == "__main__":
    main(sys.argv[1:])
