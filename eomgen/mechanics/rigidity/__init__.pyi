"""Door of the folder: what other folders may import from `eomgen.mechanics.rigidity`."""

# Bodies and the reactions on them, at one configuration
from eomgen.mechanics.rigidity.structure import Structure as Structure

# body 'AC' can turn about (4*a, 0), with it body 'CD' about (16*a, 0)
from eomgen.mechanics.rigidity.structure import motion_in_words as motion_in_words

# Refuse bodies that would move in a way that no coordinate describes
from eomgen.mechanics.rigidity.structure import refuse_loose as refuse_loose

# The structure at a configuration, at rest
from eomgen.mechanics.rigidity.structure import structure_of as structure_of

# Parts that move as one rigid body
from eomgen.mechanics.rigidity.velocity_plan import RigidBlock as RigidBlock

# A field of velocities of rigid bodies, a velocity plan
from eomgen.mechanics.rigidity.velocity_plan import VelocityPlan as VelocityPlan

# The blocks that move, in the order of the model; what is in none of them stays at rest
from eomgen.mechanics.rigidity.velocity_plan import blocks_of as blocks_of

# (truss, member, its two nodes) of every truss
from eomgen.mechanics.rigidity.velocity_plan import members_of as members_of

# Roman numeral by which textbooks name a block: I, II, III, IV,
from eomgen.mechanics.rigidity.velocity_plan import numeral as numeral

# Names of the bodies and trusses that are at rest
from eomgen.mechanics.rigidity.velocity_plan import resting_blocks as resting_blocks

# 1/w of the first block that turns about one axis; 1 where none does
from eomgen.mechanics.rigidity.velocity_plan import turning_by_one as turning_by_one
