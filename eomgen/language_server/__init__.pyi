"""Door of the room: what other rooms may import from `eomgen.language_server`."""

# Answers an editor on stdin and stdout until it is through
from eomgen.language_server.answers import answer_editor as answer_editor

# What may be typed at a place of a text, as JSON has it
from eomgen.language_server.answers import offers_in_text as offers_in_text
