"""Budgets of work for one formula, in one unit.

They are counted, never timed: what is printed is the same on every machine.
"""

from __future__ import annotations

from enum import IntEnum


class Work(IntEnum):
    """Products of terms that may be formed for one expression; one that needs more stays as it came.

    Near 200 000 products take one second.
    """

    PART = 1_000  # a part of many: a constant, one coefficient of a row
    ENTRY = 2_000  # an entry of a matrix, or a formula among many that are printed
    FORMULA = 5_000  # one formula, where there are a few
    VALUE = 20_000  # one value at an instant or place, one equation that is then solved
    ANSWER = 50_000  # one value that the user asked for by name, or a question whose answer decides what is true


READ_BACK = 30_000  # commands, numbers and letters of the formulas of one page that are read back
LARGEST_OF_50_DIGITS = 20_000  # in bits, of what a function is taken at with 50 digits; doubles end at 1024
