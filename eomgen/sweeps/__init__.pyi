"""Door of the room: what other rooms may import from `eomgen.sweeps`."""

# Settings of the integration of each run
from eomgen.sweeps.design import Stepped as Stepped

# (distribution of a text, "phi=normal(0, 0.1)", the reading of its numbers)
from eomgen.sweeps.design import spread_of as spread_of

# One run of a sweep once more; its results are those of the table, bit for bit
from eomgen.sweeps.documents import replay_document as replay_document

# The results of a sweep, with the proof of one of its runs
from eomgen.sweeps.documents import sweep_reported as sweep_reported

# Results of every run
from eomgen.sweeps.runs_of_a_plan import Sweep as Sweep

# The plan of a sweep, checked before anything is run
from eomgen.sweeps.runs_of_a_plan import planned as planned

# Many runs of a model, each by its number alone
from eomgen.sweeps.runs_of_a_plan import sweep as sweep

# All runs of a plan that its ledger lacks, then the table
from eomgen.sweeps.runs_of_a_plan import swept as swept
