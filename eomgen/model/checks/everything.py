"""All checks, in the order in which they are told of one place."""

from eomgen.model.checks.bodies import bodies
from eomgen.model.checks.equations import equations
from eomgen.model.checks.formulas import formulas
from eomgen.model.checks.names import names
from eomgen.model.checks.numbers import numbers
from eomgen.model.checks.outputs import outputs
from eomgen.model.checks.references import references
from eomgen.model.checks.speeds import speeds
from eomgen.model.checks.ties import coordinates, idle, ties
from eomgen.model.dimensions import dimensions

ALL = (names, references, formulas, dimensions, equations, outputs, numbers, bodies, ties, coordinates, speeds, idle)
