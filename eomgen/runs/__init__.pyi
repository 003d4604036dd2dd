"""Door of the room: what other rooms may import from `eomgen.runs`."""

# The runs, each as `simulator(time, parameters, start)` gives it
from eomgen.runs.batch_of_runs import many_runs as many_runs
from eomgen.runs.simulator import OUTPUTS as OUTPUTS
from eomgen.runs.simulator import REACTIONS as REACTIONS

# Many motions of one model
from eomgen.runs.simulator import Runs as Runs

# simulator(time=10) -> Trajectory, again and again
from eomgen.runs.simulator import Simulator as Simulator

# Motion of a model in which the inputs set by controllers are parameters
from eomgen.runs.simulator import controlled_run as controlled_run

# Controllers among the inputs
from eomgen.runs.simulator import controllers_of as controllers_of

# Model in which the inputs that controllers set are parameters
from eomgen.runs.simulator import with_controlled as with_controlled

# time of a motion that a page shows [s]
from eomgen.runs.single_run import PAGE_TIME as PAGE_TIME

# Warnings: samples that a run goes beyond, and limits of coordinates that it passes
from eomgen.runs.single_run import cautions_of as cautions_of

# Stepping of a motion for which no time was given
from eomgen.runs.single_run import page_stepping as page_stepping

# Time for which a motion is shown where none is given [s], and why it is shorter than PAGE_TIME
from eomgen.runs.single_run import page_time as page_time

# Reactions along the motion from the start
from eomgen.runs.single_run import reaction_picture as reaction_picture

# The motion by equations that are derived already
from eomgen.runs.single_run import run as run

# The document of a run
from eomgen.runs.single_run import run_document as run_document

# Motion that a page shows, and why it is shorter than PAGE_TIME
from eomgen.runs.single_run import run_of_a_page as run_of_a_page
