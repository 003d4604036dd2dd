"""The languages that programs are written in; adding one is one file and one name here."""

from eomgen.codegen.targets import c, cpp, fortran, javascript, numpy, rust

ALL = (numpy.TARGET, c.TARGET, cpp.TARGET, rust.TARGET, fortran.TARGET, javascript.TARGET)
