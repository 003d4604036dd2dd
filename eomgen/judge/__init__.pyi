"""Door of the room: what other rooms may import from `eomgen.judge`."""

# A model whose equations are judged
from eomgen.judge.case import Case as Case

# What judges equations of one model
from eomgen.judge.judge import Judge as Judge

# Whether an equation of somebody is right for a model, up to what, and if not, why
from eomgen.judge.judge import verify as verify
from eomgen.judge.verdict import EXIT_CODES as EXIT_CODES
from eomgen.judge.verdict import RIGHT as RIGHT
from eomgen.judge.verdict import UNDECIDED as UNDECIDED

# an equation that cannot be read, or whose names mean nothing
from eomgen.judge.verdict import UNREADABLE as UNREADABLE
from eomgen.judge.verdict import WRONG as WRONG

# What the judge says of one equation
from eomgen.judge.verdict import Verdict as Verdict
