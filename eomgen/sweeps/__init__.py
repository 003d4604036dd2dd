"""Many runs of one model: the plan, the design of experiments, the ledger, workers."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
