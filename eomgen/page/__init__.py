"""Pages: reports as HTML, PDF, LaTeX, Markdown and notebooks, drawn from the documents of the verbs. No physics."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
