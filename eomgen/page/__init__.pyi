"""Door of the room: what other rooms may import from `eomgen.page`."""

# Options of a moving picture
from eomgen.page.animation import Showing as Showing

# Writes the picture; the document describes its content
from eomgen.page.animation import animate_document as animate_document

# Refuses a file that no picture is written into
from eomgen.page.animation import refuse_ending as refuse_ending

# A model and the results for it
from eomgen.page.contents import Report as Report

# The picture of a model at its start, as one element <svg>
from eomgen.page.figure import model_svg as model_svg

# The steps of a document as a part of a page
from eomgen.page.html import document_html as document_html

# Parts of a page one after the other; texts are escaped
from eomgen.page.markup import in_a_row as in_a_row

# The style sheet of a report, with the letters of its formulas
from eomgen.page.markup import page_style as page_style

# The path of ffmpeg: the system's, else that of the package imageio-ffmpeg
from eomgen.page.moving_picture import ffmpeg as ffmpeg

# A model's page
from eomgen.page.playing import Played as Played

# The model alive in a page
from eomgen.page.playing import play as play

# Writes the page; the document describes its content
from eomgen.page.playing import play_document as play_document

# The ending of a report's file
from eomgen.page.report import form_of as form_of

# Writes the report; the document names its files
from eomgen.page.report import report_document as report_document

# Writes the sheets of a class, and their key
from eomgen.page.report import sheets_document as sheets_document
