"""Door of the room: what other rooms may import from `eomgen.questions`."""

# The runs, each as `simulator(time, parameters, start)` gives it
from eomgen.questions.batch_of_runs import many_runs as many_runs

# One output: exact, as a number, or why there is none
from eomgen.questions.outputs_answered import Answer as Answer

# Answers to the outputs of a model, with their proof
from eomgen.questions.outputs_answered import Answers as Answers

# Every output of the model, in its order
from eomgen.questions.outputs_answered import solve as solve
from eomgen.questions.simulator import OUTPUTS as OUTPUTS
from eomgen.questions.simulator import REACTIONS as REACTIONS

# Many motions of one model
from eomgen.questions.simulator import Runs as Runs

# simulator(time=10) -> Trajectory, again and again
from eomgen.questions.simulator import Simulator as Simulator

# Motion of a model in which the inputs set by controllers are parameters
from eomgen.questions.simulator import controlled_run as controlled_run

# Controllers among the inputs
from eomgen.questions.simulator import controllers_of as controllers_of

# Model in which the inputs that controllers set are parameters
from eomgen.questions.simulator import with_controlled as with_controlled

# time of a motion that a page shows [s]
from eomgen.questions.single_run import PAGE_TIME as PAGE_TIME

# Difference in words between a reported value of an output and the samples of the run
from eomgen.questions.single_run import answered_otherwise as answered_otherwise

# Stepping of a motion for which no time was given
from eomgen.questions.single_run import page_stepping as page_stepping

# Time for which a motion is shown where none is given [s], and why it is shorter than PAGE_TIME
from eomgen.questions.single_run import page_time as page_time

# Equations with stabilized constraints after Baumgarte
from eomgen.questions.single_run import pulling as pulling

# The motion by equations that are derived already
from eomgen.questions.single_run import run as run

# Motion that a page shows, and why it is shorter than PAGE_TIME
from eomgen.questions.single_run import run_of_a_page as run_of_a_page
