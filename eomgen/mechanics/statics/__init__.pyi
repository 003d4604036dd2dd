"""Door of the folder: what other folders may import from `eomgen.mechanics.statics`."""

# States of the contacts of a model at its start
from eomgen.mechanics.statics.contacts import ContactsAtStart as ContactsAtStart

# One thing that acts
from eomgen.mechanics.statics.cut_bodies import ActingForce as ActingForce

# One equation: the balance of forces along e, or of moments about p, of parts that are cut free
from eomgen.mechanics.statics.cut_bodies import CutBalance as CutBalance

# The parts that can be cut free, and their balances
from eomgen.mechanics.statics.cut_bodies import FreeBodies as FreeBodies

# Force and couple on one body, ground axes
from eomgen.mechanics.statics.cut_bodies import PlacedPush as PlacedPush

# A section force that is requested
from eomgen.mechanics.statics.cut_bodies import RequestedSection as RequestedSection

# N, V and M along one body
from eomgen.mechanics.statics.forces_in_sections import SectionForces as SectionForces

# The section forces between two stations, polynomials in s = x - start
from eomgen.mechanics.statics.forces_in_sections import SectionPiece as SectionPiece

# X for a unit load that travels along the spans
from eomgen.mechanics.statics.influence import InfluenceLine as InfluenceLine

# One reaction, or one unknown of the loads
from eomgen.mechanics.statics.virtual_work import StaticReaction as StaticReaction

# A structure at rest
from eomgen.mechanics.statics.virtual_work import StaticReactions as StaticReactions

# along * R + sum of works = 0
from eomgen.mechanics.statics.virtual_work import WorkEquation as WorkEquation
