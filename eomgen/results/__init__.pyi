"""Door of the room: what other rooms may import from `eomgen.results`."""

# Velocities, accelerations and centres of rotation at one instant
from eomgen.results.at_instant.result import Kinematics as Kinematics

# Velocities, accelerations, centres of rotation and kinds of motion at one instant
from eomgen.results.at_instant.result import kinematics as kinematics

# The parameters without a value
from eomgen.results.at_rest.pictures import missing_values as missing_values

# A structure at rest: every reaction by virtual work and by equilibrium
from eomgen.results.at_rest.result import Statics as Statics

# A structure at rest; of a system that is free to move, its equilibria
from eomgen.results.at_rest.result import statics as statics

# Message if contacts of bodies without coordinates cannot hold them at rest; "" where they do
from eomgen.results.at_rest.result import why_not_at_rest as why_not_at_rest

# Step that derives one reaction from the virtual work of the mechanism that its release leaves
from eomgen.results.at_rest.steps import virtual_work_step as virtual_work_step

# A force or a couple on a body that is cut free
from eomgen.results.bodies_cut_free import BodyForce as BodyForce

# Every body of a model cut free, at one instant
from eomgen.results.bodies_cut_free import FreeBodies as FreeBodies

# Each body of a model cut free, with its forces, reactions and inertia
from eomgen.results.bodies_cut_free import free_bodies as free_bodies

# The impact where contacts close: its equations, impulses, the speeds after it, the loss of energy
from eomgen.results.closing_contacts import impact as impact

# The model's parts and its degrees of freedom, by rank and by the counting formula
from eomgen.results.declared import check_document as check_document

# Differences of the second of two models from the first, not proven yet
from eomgen.results.declared import difference_document as difference_document

# Mass, mass centre, tensor, principal moments and axes of bodies, each about its mass centre in its own axes
from eomgen.results.mass_properties.result import inertia as inertia

# Small motions about an equilibrium or a steady motion
from eomgen.results.small_motions.result import Linearization as Linearization

# The small motions of a model about an equilibrium, or about its start, a steady motion
from eomgen.results.small_motions.result import linearize as linearize
