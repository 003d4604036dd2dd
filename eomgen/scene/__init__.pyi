"""Door of the room: what other rooms may import from `eomgen.scene`."""

# An arrow in numbers
# Weights, forces of springs and dampers, and the resultant force of every joint and constraint
from eomgen.scene.bodies import force_marks as force_marks

# Resultants of the joints and constraints all of whose forces are among the names
from eomgen.scene.bodies import resultants as resultants

# A load along a line with its name
from eomgen.scene.bodies import spread_mark as spread_mark

# Scenes of the same bodies, one after the other, as one
from eomgen.scene.frames_of_phases import joined as joined

# Scene of a run and its numbers at given instants
from eomgen.scene.frames_of_phases import phase_frames as phase_frames

# Places of bodies, ends of springs and arrows that the strokes of a drawing show at a frame
from eomgen.scene.frames_of_phases import picture_reported as picture_reported

# Forces, couples and line loads that the strokes of a drawing show at its first frame, with their words
from eomgen.scene.frames_of_phases import pushes_reported as pushes_reported
from eomgen.scene.making import DrawnArrow as DrawnArrow

# A structure of which one reaction is released
from eomgen.scene.making import VirtualDisplacement as VirtualDisplacement

# The marks of arrows
from eomgen.scene.making import arrow_marks as arrow_marks

# Principal axes through a mass centre, each with its number at one end
from eomgen.scene.making import axis_marks as axis_marks

# Marks of centres, of rotation or of mass, by their names
from eomgen.scene.making import center_marks as center_marks

# Every named point of the ground and of bodies by its whole name, ground axes [m]
from eomgen.scene.making import named_points as named_points

# Scene of a model
from eomgen.scene.making import scene_of as scene_of

# The scene of one body by itself, with its forces
from eomgen.scene.making import scene_of_cut_body as scene_of_cut_body

# Bodies in space and about their mass centres x I x = c, of half-axes sqrt(c/I_k): of a ball the ball
from eomgen.scene.making import scene_of_inertia as scene_of_inertia

# Scene of a system: its drawable elements at a state
from eomgen.scene.making import scene_of_system as scene_of_system

# A scene with more marks, each in the place that its role has
from eomgen.scene.making import scene_with as scene_with

# Size of the displacement at which the body that moves most moves by SWING of the picture's extent
from eomgen.scene.making import swing_of as swing_of

# Something that is drawn
from eomgen.scene.scene import Mark as Mark

# Drawable elements of a model at a state
from eomgen.scene.scene import Scene as Scene

# Axes in which marks stand
from eomgen.scene.scene import SceneFrame as SceneFrame

# The same along a motion
from eomgen.scene.scene import frames_along as frames_along

# The strokes of a scene, in the plane or in space
from eomgen.scene.space_strokes import drawing_of as drawing_of

# The longest arrow, of the extent
from eomgen.scene.strokes import ARROW as ARROW

# Everything of a picture, in the order in which it is drawn
from eomgen.scene.strokes import Drawing as Drawing

# A name and the place next to which it stands, n x d
from eomgen.scene.strokes import Letter as Letter

# The numbers of a scene over n frames
from eomgen.scene.strokes import SceneNumbers as SceneNumbers

# A path to draw
from eomgen.scene.strokes import Stroke as Stroke

# The lowest and the highest corner of points,
from eomgen.scene.strokes import corners_of as corners_of
