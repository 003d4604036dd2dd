"""Door of the room: what other rooms may import from `eomgen.sensitivities`."""

# Requested formulas and their derivatives
from eomgen.sensitivities.derivatives import Sensitivity as Sensitivity

# Its proof
from eomgen.sensitivities.derivatives import checks_of_slope as checks_of_slope

# Exact derivatives of formulas of a model
from eomgen.sensitivities.derivatives import sensitivity as sensitivity

# (one derivative in SI, the reason why there is none)
from eomgen.sensitivities.derivatives import slope_in_si as slope_in_si

# ("frequency(1)", "k") of "d(frequency(1))/d(k)"
from eomgen.sensitivities.derivatives import slope_requested as slope_requested

# The unit of a derivative
from eomgen.sensitivities.derivatives import unit_of_slope as unit_of_slope
