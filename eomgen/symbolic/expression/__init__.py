"""Elements of formulas: exact numbers, nodes of the graph, the grammar of the model file, units, vectors."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
