"""The languages that programs are written in; adding one is one file and one name here."""

from eomgen.codegen.targets import (
    c,
    casadi,
    cpp,
    fmu,
    fortran,
    javascript,
    jax,
    julia,
    matlab,
    numba,
    numpy,
    rust,
    wasm,
)

ALL = (
    *(numpy.TARGET, c.TARGET, cpp.TARGET, rust.TARGET, fortran.TARGET, javascript.TARGET, wasm.TARGET),
    *(matlab.TARGET, julia.TARGET, jax.TARGET, casadi.TARGET, numba.TARGET, fmu.TARGET),
)
