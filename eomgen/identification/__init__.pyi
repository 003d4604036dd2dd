"""Door of the room: what other rooms may import from `eomgen.identification`."""

# Parameters identified from measured motions
from eomgen.identification.fit import Identified as Identified

# The parameters by least squares
from eomgen.identification.fit import identify as identify

# The parameters that fit a measured motion; without one the groups of them that motions can distinguish
from eomgen.identification.fit import identify_document as identify_document

# Y pi against Y_base K pi, and the texts of K
from eomgen.identification.proof_of_groups import groups_checked as groups_checked

# tau + J^T lam = Y pi + y0
from eomgen.identification.regressors import Regressor as Regressor

# The regressor of a mechanism
from eomgen.identification.regressors import regressor as regressor

# The same of a system
from eomgen.identification.regressors import regressor_of as regressor_of
