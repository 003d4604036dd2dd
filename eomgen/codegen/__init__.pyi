"""Door of the room: what other rooms may import from `eomgen.codegen`."""

# Path of a compiler (the environment's, as CC, else cc, gcc, clang, or ziglang's), or None
from eomgen.codegen.build import compiler as compiler

# The functions of a C text by their names, compiled for this machine
from eomgen.codegen.build import functions_in_c as functions_in_c

# A function of (t, x, p, inputs), its statements in the order in which they are run
from eomgen.codegen.program import Program as Program
from eomgen.codegen.program import QuaternionPlaces as QuaternionPlaces

# A linear system in the midst of a program
from eomgen.codegen.program import Solve as Solve

# The letters, digits and underscores nearest to a name: 'ω₁' -> 'omega1', 'arm-7' -> 'arm_7'
from eomgen.codegen.program import identifier as identifier
from eomgen.codegen.rhs import Batch as Batch

# Options that are the same for all runs
from eomgen.codegen.rhs import BatchOptions as BatchOptions

# (t, x) -> dx of a right-hand side; `address` is where a compiled one lies, None of others
from eomgen.codegen.rhs import RateFunction as RateFunction

# A program as a function; safe to call from several threads
from eomgen.codegen.rhs import RightHandSide as RightHandSide

# The accelerations and multipliers at one state; none has a single value where branches meet
from eomgen.codegen.rhs import closing_accelerations as closing_accelerations

# Result of a compiler; None where there is none, or it fails: that, and what is done instead, is said once
from eomgen.codegen.rhs import in_c as in_c

# The targets of these names, all where none are given; UsageError where there is none of a name
from eomgen.codegen.rhs import targets_named as targets_named

# Addresses of a compiled right-hand side and its constants; `kept` keeps them alive
from eomgen.codegen.targets.base import Address as Address
from eomgen.codegen.targets.base import Emitted as Emitted

# Role of a program, and the names in its text
from eomgen.codegen.targets.base import Role as Role

# A right answer: the result at (t, x, p), and a where it is an argument, by the model's own inputs or given ones
from eomgen.codegen.targets.base import TestVector as TestVector

# Several programs, compiled as one text
from eomgen.codegen.targets.c import c_together as c_together

# STEM_constants and STEM_evaluate of a program, which no other file sees, the number of the constants
from eomgen.codegen.targets.c import hidden_in_c as hidden_in_c

# An object of the functions `constants` and `evaluate`, for scripts that are no modules
from eomgen.codegen.targets.javascript import javascript_expression as javascript_expression

# The order that costs least at a relative tolerance: 1 + p, p (p + beside) exp(-ln(rtol)/p) least
from eomgen.codegen.taylor import order_for as order_for

# The right-hand side of a model, and what is written of further functions beside it
from eomgen.codegen.written_files import Emitter as Emitter

# Files of functions in languages
from eomgen.codegen.written_files import Files as Files

# One function of generated code
from eomgen.codegen.written_files import Written as Written

# The program's outputs in any arithmetic
from eomgen.codegen.written_files import outputs_at as outputs_at

# Right answers near the start (else near 0), half of them with inputs given where there are any; and there
from eomgen.codegen.written_files import vectors as vectors
