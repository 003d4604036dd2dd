"""Door of the room: what other rooms may import from `eomgen.verbs`."""

# The model with the values that were typed, and their record; the other options, equations in SI
from eomgen.verbs.assignments import typed as typed

# The derivation, and its certificate
from eomgen.verbs.derive import derive_document as derive_document

# Versions of the tools and packages that are there, and what is not possible without the missing ones
from eomgen.verbs.doctor import doctor_document as doctor_document

# Name and title of each, a line
from eomgen.verbs.examples import examples_document as examples_document

# The model file, written where an output is given; and the parts of the robot's file without a counterpart in it
from eomgen.verbs.importing import import_document as import_document

# The motion at one instant
from eomgen.verbs.kinematics import kinematics_requested as kinematics_requested

# A commented starter model NAME.toml, or the example as it is; never over a file that is there
from eomgen.verbs.new import new_document as new_document

# The JSON Schema of a model file
from eomgen.verbs.schema import schema_document as schema_document

# The motion from the start; trajectory and picture are written where files are given
from eomgen.verbs.simulate import simulate_document as simulate_document

# Every entry of [outputs]
from eomgen.verbs.solve import solve_document as solve_document

# Options of a sweep, as typed
from eomgen.verbs.sweep import SweepRequested as SweepRequested

# The runs that the folder lacks are made; the document states their results
from eomgen.verbs.sweep import sweep_document as sweep_document

# The verdicts, each with the relations used or the reason why it is wrong
from eomgen.verbs.verify import verify_document as verify_document
