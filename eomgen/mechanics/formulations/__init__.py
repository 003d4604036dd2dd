"""Formulations: the seam of ways to the equations of motion. Each gives `name`, `title`, `applies`, `assemble`."""

from eomgen.mechanics.formulations import lagrange, projection, recursive

ALL = (lagrange, projection, recursive)
