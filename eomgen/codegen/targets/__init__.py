"""The languages that programs are written in; adding one is one file and one name here."""

from eomgen.codegen.targets import c, javascript, numpy

ALL = (numpy.TARGET, c.TARGET, javascript.TARGET)
