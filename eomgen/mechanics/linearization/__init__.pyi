"""Door of the folder: what other folders may import from `eomgen.mechanics.linearization`."""

from eomgen.mechanics.linearization.linearization import CORNERS as CORNERS

# The equations of small motions about a reference
from eomgen.mechanics.linearization.linearization import SmallMotions as SmallMotions

# One frequency: the mode in numbers, and in closed form where it has one
from eomgen.mechanics.linearization.modes import Frequency as Frequency

# Eigenvalues, frequencies, shapes, transfer functions and stability that follow from small motions
from eomgen.mechanics.linearization.modes import Modes as Modes

# All modes: those that oscillate first, the slowest of them first
from eomgen.mechanics.linearization.modes import Spectrum as Spectrum
from eomgen.mechanics.linearization.reduction import NAME as NAME

# M du_i' + C du_i + K dq_i = B dw, dq_i' = F dq_i + E du_i
from eomgen.mechanics.linearization.reduction import LinearEquations as LinearEquations

# The equations of motion of a system, and their first derivatives, as graph scalars
from eomgen.mechanics.linearization.reference import FirstOrder as FirstOrder

# Derivatives of the reference and of the matrices with respect to a parameter
from eomgen.mechanics.linearization.responses import ParameterSlopes as ParameterSlopes

# A, B, C_y, D_y as rows, of scalars of the parameters or of floats
from eomgen.mechanics.linearization.responses import StateMatrices as StateMatrices
