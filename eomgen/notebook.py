"""Cells of a notebook that hold a model: `%load_ext eomgen`, then `%%eomgen crane` above its text.

The text is that of a model file (its first line, `eomgen = 1`, may be left out). The model gets the name that stands
behind `%%eomgen`, `model` where there is none, and shows itself. Of a text that is no model the problems are shown,
with the lines of the cell.
"""

from __future__ import annotations

import sys
from typing import Any

from eomgen.errors import ModelError, UsageError
from eomgen.model import Model, WrittenText, loads, warned

CELL = "<cell>"  # what stands for the file in messages


def load_ipython_extension(shell: Any) -> None:
    """Makes `%%eomgen` known to an IPython shell: what `%load_ext eomgen` calls."""

    def of_cell(line: str, cell: str) -> Model:
        name = line.strip() or "model"
        model = model_of_cell(name, cell)
        shell.user_ns[name] = model
        return model

    shell.register_magic_function(of_cell, "cell", "eomgen")


def model_of_cell(name: str, cell: str) -> Model:
    """The model of a cell's text; its warnings go to stderr.

    Raises:
        UsageError: of IPython, which shows it without a traceback: the name is none, or the text is no model.
    """
    from IPython.core.error import UsageError as Shown

    if not name.isidentifier():
        error = UsageError(f"'{name}' is no name for a model", fix="%%eomgen crane")
        raise Shown(str(error))
    head = "" if WrittenText(cell).is_model else "eomgen = 1"  # in the place of the line of %%eomgen
    text = f"{head}\n{cell}"
    try:
        model = loads(text, CELL, name)
    except ModelError as wrong:
        raise Shown(f"no model yet\n\n{wrong}") from None
    for warning in warned(model, text.encode(), CELL):
        sys.stderr.write(f"warning: {warning}\n")
    return model
