"""Door of the room: what other rooms may import from `eomgen.sweeps`."""

# Settings of the integration of each run
from eomgen.sweeps.design import Stepped as Stepped

# A sweep
from eomgen.sweeps.design import SweepPlan as SweepPlan

# (distribution of a text, "phi=normal(0, 0.1)", the reading of its numbers)
from eomgen.sweeps.design import spread_of as spread_of
from eomgen.sweeps.runs_of_a_plan import CRITICAL as CRITICAL
from eomgen.sweeps.runs_of_a_plan import LEDGER as LEDGER
from eomgen.sweeps.runs_of_a_plan import PARQUET as PARQUET
from eomgen.sweeps.runs_of_a_plan import PLAN as PLAN
from eomgen.sweeps.runs_of_a_plan import TABLE as TABLE

# Results of every run
from eomgen.sweeps.runs_of_a_plan import Sweep as Sweep

# The plan of a sweep, checked before anything is run
from eomgen.sweeps.runs_of_a_plan import planned as planned

# Many runs of a model, each by its number alone
from eomgen.sweeps.runs_of_a_plan import sweep as sweep

# The sweep in a folder, as far as it is done
from eomgen.sweeps.runs_of_a_plan import sweep_at as sweep_at

# All runs of a plan that its ledger lacks, then the table
from eomgen.sweeps.runs_of_a_plan import swept as swept
from eomgen.sweeps.workers import FAILED as FAILED
from eomgen.sweeps.workers import WITHOUT_MOTION as WITHOUT_MOTION

# The runs of a plan, one after the other
from eomgen.sweeps.workers import SweepKernel as SweepKernel

# True if `solve` answers it
from eomgen.sweeps.workers import is_without_motion as is_without_motion
