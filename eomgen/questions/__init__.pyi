"""Door of the room: what other rooms may import from `eomgen.questions`."""

# One output: exact, as a number, or why there is none
from eomgen.questions.outputs_answered import Answer as Answer

# Every output of the model, in its order
from eomgen.questions.outputs_answered import solve as solve

# Positions from which a motion starts at rest, by name
from eomgen.questions.reactions import positions_at_rest as positions_at_rest

# Every reaction, as `reactions` finds it, in words and for machines
from eomgen.questions.reactions import reactions_document as reactions_document

# The model with the data of a variant, and a record of what was drawn
from eomgen.questions.variants import variant_of as variant_of
