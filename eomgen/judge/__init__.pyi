"""Door of the room: what other rooms may import from `eomgen.judge`."""

# One equation to be judged
from eomgen.judge.derivations import Answered as Answered

# The verdicts on equations, each with the relations used or the reason why it is wrong
from eomgen.judge.derivations import judged as judged

# The verdict on a list of forces on bodies cut free
from eomgen.judge.free_body_lists import judged_forces as judged_forces

# Whether an equation of somebody is right for a model, up to what, and if not, why
from eomgen.judge.judge import verify as verify

# What the judge says of one equation
from eomgen.judge.verdict import Verdict as Verdict
