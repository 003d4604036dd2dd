"""Door of the room: what other rooms may import from `eomgen.questions`."""

# One output: exact, as a number, or why there is none
from eomgen.questions.outputs_answered import Answer as Answer

# Answers to the outputs of a model, with their proof
from eomgen.questions.outputs_answered import Answers as Answers

# Every output of the model, in its order
from eomgen.questions.outputs_answered import solve as solve
