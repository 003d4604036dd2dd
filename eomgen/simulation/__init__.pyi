"""Door of the room: what other rooms may import from `eomgen.simulation`."""

# The outputs that are functions of the state: at no given instant, and of no linearized system
from eomgen.simulation.columns import formulas_of as formulas_of

# Results of many runs
from eomgen.simulation.compiled_runs import FoundRuns as FoundRuns

# Runs of one phase, from t = 0 to one end, as they are made in C
from eomgen.simulation.compiled_runs import ManyRuns as ManyRuns

# The requested instants: so many, evenly spaced; or the instants themselves, in SI or with a unit
from eomgen.simulation.integration import instants_of as instants_of

# The motion from a start while the equations hold, put back onto their constraints
from eomgen.simulation.integration import integrate_one_phase as integrate_one_phase

# Result of an integration
from eomgen.simulation.integrator import Run as Run

# Options of an integrator
from eomgen.simulation.integrator import Stepping as Stepping

# A motion in one phase, and the condition sought on it
from eomgen.simulation.motion import FirstTime as FirstTime

# Options of the integration of a motion
from eomgen.simulation.motion import Plan as Plan

# State in which a phase begins, and the configuration of its contacts
from eomgen.simulation.phase_change import PhaseStart as PhaseStart

# An integrator of its own for a model whose contacts change, in C
from eomgen.simulation.phase_integrator import PhaseIntegrator as PhaseIntegrator

# The model of one phase. Its state is x = (q, u), and after these the slack of each string that hangs loose
from eomgen.simulation.phase_model import PhaseModel as PhaseModel

# A system that was derived at values of its parameters
from eomgen.simulation.phase_models import DerivedAt as DerivedAt

# The phases of a model
from eomgen.simulation.phase_models import PhaseModels as PhaseModels

# One phase as it was run
from eomgen.simulation.phase_run import PhaseRun as PhaseRun

# The reactions of one system along its motion
from eomgen.simulation.reaction_columns import ReactionColumns as ReactionColumns

# A stretch of time in which the model stays the same
from eomgen.simulation.result import Phase as Phase

# A motion. One that ended early holds its results so far and the reason
from eomgen.simulation.result import Trajectory as Trajectory

# Accuracy of the states of a run
from eomgen.simulation.solvers import Accuracy as Accuracy

# The states of a smooth motion at instants, k x n, by steps of fine tolerance
from eomgen.simulation.solvers import states_along as states_along

# Outputs of a whole motion
from eomgen.simulation.whole_run import WholeRun as WholeRun
