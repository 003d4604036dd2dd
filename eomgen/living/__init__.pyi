"""Door of the room: what other rooms may import from `eomgen.living`."""

# The page of a model's file, until Ctrl-C ends it
from eomgen.living.session import serve as serve
