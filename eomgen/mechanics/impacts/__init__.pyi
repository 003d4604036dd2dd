"""Door of the folder: what other folders may import from `eomgen.mechanics.impacts`."""

# The jump where contacts close as equations, with its impulses, speeds and loss
from eomgen.mechanics.impacts.equations import ImpactEquations as ImpactEquations

# One contact that touches in an impact: its rows, its restitution
from eomgen.mechanics.impacts.law import Hit as Hit

# Where restitution ends, and the order of what happens at one instant
from eomgen.mechanics.impacts.law import ImpactLaw as ImpactLaw

# What an impact changes: the speeds after it, its impulses, the kinetic energy lost
from eomgen.mechanics.impacts.law import Jump as Jump
