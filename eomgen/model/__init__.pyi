"""Door of the room: what other rooms may import from `eomgen.model`."""

# A body made of pieces: its mass, mass centre and inertia about it, body axes
from eomgen.model.composite import Composite as Composite

# Two things that touch
from eomgen.model.constraints.base import Meeting as Meeting

# Equilibrium of a node without mass: nobody declares it, and its multiplier is 0
from eomgen.model.constraints.equation import NodeBalance as NodeBalance

# The two nodes of tension(T, n1-n2) or tension(T, n1, n2); None where it names no two
from eomgen.model.constraints.link import ends_requested as ends_requested

# One scalar row of a constraint
from eomgen.model.constraints.row import ConstraintRow as ConstraintRow

# A function of the configuration, positive until a motion ends where it vanishes; what is so there, in words
from eomgen.model.constraints.row import Edge as Edge

# A point of the string's path, or a round thing that it lies on
from eomgen.model.constraints.strand import Stop as Stop

# The straight string between two stops
from eomgen.model.constraints.strand import Strand as Strand

# A constraint, the joint of a body on a path, or a joint with dry friction
from eomgen.model.contacts import Contact as Contact

# "did you mean 'forearm'?", or "" where nothing is near
from eomgen.model.diagnostics import nearest as nearest
from eomgen.model.expansion import tables_read as tables_read

# Parts of the words of a problem that are no words: $formula$, {name}
from eomgen.model.fields import STATEMENT as STATEMENT

# The place at which all forces balance, instead of an instant
from eomgen.model.fields import AtRest as AtRest

# A value that a rule reads at once (an expression, a vector, a name), and where it stands
from eomgen.model.fields import Leaf as Leaf

# A read-only mapping that keeps its order; two in another order are not equal (the order of q is a fact)
from eomgen.model.fields import Table as Table

# left = right, as it was written
from eomgen.model.fields import WrittenEquation as WrittenEquation

# Action of a force in numbers: it pushes along what moves, and turns a body
from eomgen.model.forces.base import Act as Act

# Action between two points, or a couple that turns two bodies relative to one another
from eomgen.model.forces.base import Element as Element

# (body or None for the ground, place in its axes)
from eomgen.model.forces.load import BodyPoint as BodyPoint

# A couple on a body; `axes` names the body in whose axes it is written, None the ground's [N m]
from eomgen.model.forces.load import Couple as Couple

# A generalized force along a coordinate
from eomgen.model.forces.load import GeneralizedForce as GeneralizedForce

# Any load
from eomgen.model.forces.load import Load as Load

# A force on a body at a place of it; `axes` names the body in whose axes it is written, None the ground's [N]
from eomgen.model.forces.load import PointForce as PointForce

# A load at a place: a force or a couple
from eomgen.model.forces.load import Push as Push

# A force per length on a body along the straight line between two places of it, linear, ground axes [N/m]
from eomgen.model.forces.load import SpreadLoad as SpreadLoad

# An acceleration field that acts on every mass of the model: a weight m g at every mass centre [m/s^2]
from eomgen.model.forces.load import UniformField as UniformField

# The exponents of m, kg, s and of unknowns; none is 0
from eomgen.model.inference import Dimension as Dimension

# e0, e1, e2, e3, scalar first, child to parent, of norm 1
from eomgen.model.joints.ball import UnitQuaternion as UnitQuaternion

# Dry friction along a variable of a joint
from eomgen.model.kinds import JointFriction as JointFriction

# Symbols of the reactions of a joint or a constraint
from eomgen.model.kinds import ReactionSymbols as ReactionSymbols

# `friction = mu`: mu |N| against the sliding velocity; `{ viscous = c }`: -c N v
from eomgen.model.kinds import Resistance as Resistance

# A mechanical system as declared: tables of named parts, each a read-only mapping in the user's order
from eomgen.model.model import Model as Model

# The functions of the motion, by name
from eomgen.model.outputs import FUNCTIONS as FUNCTIONS
from eomgen.model.outputs.base import GROUND as GROUND

# Source of an output function: what it needs beside the motion
from eomgen.model.outputs.base import OutputSource as OutputSource

# The argument k of a call, a formula; a lone name or member reads like a reference
from eomgen.model.outputs.base import formula_at as formula_at

# A generalized coordinate q
from eomgen.model.parts import Coordinate as Coordinate

# A requested result, by name
from eomgen.model.parts import Output as Output

# A constant of the system
from eomgen.model.parts import Parameter as Parameter

# The name in messages of a body of a model in parts: body 'bar', node 'T.n1'
from eomgen.model.parts import called as called

# The path of its declaration: bodies.bar, trusses.T.nodes.n1
from eomgen.model.parts import declared_at as declared_at

# True if a body of a model in parts is a node of a truss
from eomgen.model.parts import is_node as is_node
from eomgen.model.quantities import Typed as Typed

# factor * pi^pi_power, in units of SI
from eomgen.model.quantities import Unit as Unit

# A time [s]: a number, "500 ms", (500, "ms"), a quantity of pint; a plain number is in seconds
from eomgen.model.quantities import seconds as seconds

# A model, or the path of its file
from eomgen.model.reader import ModelOrPath as ModelOrPath

# The content of a file (- is stdin), up to the length that a model may have
from eomgen.model.reader import bytes_at as bytes_at

# The model that a file declares
from eomgen.model.reader import load as load

# The model that a text declares
from eomgen.model.reader import loads as loads

# A problem that names a part of the model by its path ("bodies.arm.joint"), at that part's place in the text
from eomgen.model.reader import located as located

# A model, or the one in the file at a path; with other values of parameters and starts
from eomgen.model.reader import model_at as model_at

# The warnings of a model, each at its place in the text that the model was read from
from eomgen.model.reader import warned as warned

# Values that a parameter or start takes one after the other
from eomgen.model.replaced import Range as Range

# Reader of what is requested of a model by texts, or by values in Python
from eomgen.model.replaced import Requests as Requests

# The interpretation of something that was typed
from eomgen.model.replaced import Taken as Taken

# Numbers as a person types them for one name: "45", "45 deg", "pi/4 rad"
from eomgen.model.replaced import TypedNumbers as TypedNumbers

# A model with what was typed in it
from eomgen.model.replaced import Valued as Valued
from eomgen.model.replaced import Values as Values

# True if values given in Python are several, perhaps an array with a unit, and not one value
from eomgen.model.replaced import are_several as are_several

# (name, text) of each NAME=VALUE
from eomgen.model.replaced import assignments as assignments

# The values of what is given in Python: one, several, an array with its unit, an array of pint's
from eomgen.model.replaced import typed_values as typed_values

# The model in which what only constraints can hold has displacements; the other bodies keep their joints
from eomgen.model.restated import freed as freed

# A function of time through samples, for `motion`, `rate`, `acceleration` or an input; arrays are welcome
from eomgen.model.sampled_laws import samples as samples

# I of some bodies about a point: the integral of (r.r 1 - r r^T) dm, 3 x 3 [kg m^2]
from eomgen.model.shapes.base import InertiaMatrix as InertiaMatrix

# Mass m [kg], mass centre com (3, body axes) [m], inertia I about it (3 x 3, body axes) [kg m^2]
from eomgen.model.shapes.base import MassProperties as MassProperties

# An arc of an ellipse in the plane z = 0 of its axes
from eomgen.model.shapes.forms import ArcForm as ArcForm

# A box of edges `size` about its middle
from eomgen.model.shapes.forms import BoxForm as BoxForm

# An ellipsoid, `size` its half-axes; of a ball they are equal
from eomgen.model.shapes.forms import EllipsoidForm as EllipsoidForm

# One thing that can be drawn
from eomgen.model.shapes.forms import Form as Form

# A line from point to point; `fine`: a mark on something, thinner than an edge
from eomgen.model.shapes.forms import LineForm as LineForm

# A filled polygon; a hole shows what is behind
from eomgen.model.shapes.forms import PolygonForm as PolygonForm

# Plane faces, each by the numbers of its corners among the points; the first is the base
from eomgen.model.shapes.forms import PolyhedronForm as PolyhedronForm

# A polygon, raised along z from `low` to `high`
from eomgen.model.shapes.forms import PrismForm as PrismForm

# A body of revolution: the profile (r, z) swept about the axis z
from eomgen.model.shapes.forms import RevolutionForm as RevolutionForm

# after the name of an output's column, where another column has that name
from eomgen.model.units import OUTPUT as OUTPUT
from eomgen.model.values import in_order as in_order

# Place in a text, and what is being written there
from eomgen.model.written_text import Cursor as Cursor

# Text of a model file, and what stands where in it, also while it is being typed
from eomgen.model.written_text import WrittenText as WrittenText
