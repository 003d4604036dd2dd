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
from eomgen.mechanics.statics.forces_in_sections import KINDS as KINDS

# What a beam in space has: N, V_y, V_z, T, M_y, M_z
from eomgen.mechanics.statics.forces_in_sections import SPACE_KINDS as SPACE_KINDS

# Extreme of the bending moment within a piece, where V = 0
from eomgen.mechanics.statics.forces_in_sections import Extreme as Extreme

# Everything that acts on one body, in its own axes, with the values of the reactions
from eomgen.mechanics.statics.forces_in_sections import MemberLoads as MemberLoads

# The section forces of a beam in space between two stations
from eomgen.mechanics.statics.forces_in_sections import PieceInSpace as PieceInSpace

# N, V and M along one body
from eomgen.mechanics.statics.forces_in_sections import SectionForces as SectionForces

# The section forces between two stations, polynomials in s = x - start
from eomgen.mechanics.statics.forces_in_sections import SectionPiece as SectionPiece

# N, V, T and M along one body in space
from eomgen.mechanics.statics.forces_in_sections import SectionsInSpace as SectionsInSpace

# Place of a reaction, body axes: of a couple that of the forces of the same constraint, None where it has none
from eomgen.mechanics.statics.forces_in_sections import place_of as place_of

# t, e_y, e_z of a leg, body axes
from eomgen.mechanics.statics.forces_in_sections import triad as triad

# X for a unit load that travels along the spans
from eomgen.mechanics.statics.influence import InfluenceLine as InfluenceLine

# A straight part of the way of the load, on which the influence line is straight
from eomgen.mechanics.statics.influence import InfluenceSpan as InfluenceSpan

# The axis of a body
from eomgen.mechanics.statics.member_axis import MemberAxis as MemberAxis

# One load of the structure
from eomgen.mechanics.statics.virtual_work import Acting as Acting

# Condition for a contact to be in the assumed state
from eomgen.mechanics.statics.virtual_work import RestCondition as RestCondition

# One reaction, or one unknown of the loads
from eomgen.mechanics.statics.virtual_work import StaticReaction as StaticReaction

# A structure at rest
from eomgen.mechanics.statics.virtual_work import StaticReactions as StaticReactions

# A sum of indeterminate reactions that is determinate
from eomgen.mechanics.statics.virtual_work import StaticSum as StaticSum

# along * R + sum of works = 0
from eomgen.mechanics.statics.virtual_work import WorkEquation as WorkEquation

# The virtual work of one load, not 0
from eomgen.mechanics.statics.virtual_work import WorkTerm as WorkTerm

# One reaction, or unknown of the loads, by its virtual work alone; the other degrees of freedom are at rest
from eomgen.mechanics.statics.virtual_work import released_in as released_in
