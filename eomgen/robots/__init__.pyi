"""Door of the room: what other rooms may import from `eomgen.robots`."""

# A robot of another program's file
from eomgen.robots.importing import ImportedRobot as ImportedRobot

# Model of a robot in a file of another program
from eomgen.robots.importing import import_robot as import_robot

# The robot in a file
from eomgen.robots.importing import imported as imported

# The model of a system of sympy.physics.mechanics
from eomgen.robots.sympy_mechanics import from_sympy as from_sympy

# written by an export where a format needs a limit and there is none
from eomgen.robots.tables import UNLIMITED as UNLIMITED

# Things of one sort in a file that a model has no counterpart for
from eomgen.robots.tables import LeftOut as LeftOut

# Legal names, each given once, like those that the file uses
from eomgen.robots.tables import LegalNames as LegalNames

# The file of a model as it is read: what repeats, and the parts of other files, written out
from eomgen.robots.tables import expanded_text as expanded_text

# Data of a remark written by an import
from eomgen.robots.tables import remarked as remarked
