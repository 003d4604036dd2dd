"""Small motions about an equilibrium or a steady motion: M, C, K, the state matrix, modes, stability."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
