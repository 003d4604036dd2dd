"""A model that lives while it is written: a page that follows its file, and what is shown of it as it comes."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
