"""Motion in time: integrators, drift correction, events, phases of contacts, trajectories."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
