"""Door of the room: what other rooms may import from `eomgen.page`."""

# A file inside a report
from eomgen.page.contents import PLAYER as PLAYER
from eomgen.page.contents import SECTIONS as SECTIONS
from eomgen.page.contents import Attachment as Attachment

# A model and the results for it
from eomgen.page.contents import Report as Report

# A picture of a report
from eomgen.page.contents import ReportFigure as ReportFigure

# A part of a report
from eomgen.page.contents import ReportSection as ReportSection

# A page inside another, as notebooks show it
from eomgen.page.contents import framed as framed

# The proofs of several results as one
from eomgen.page.contents import joint_proof as joint_proof

# A picture as a figure
from eomgen.page.figure import figure_of as figure_of

# Coordinates over time, one drawing a unit
from eomgen.page.figure import motion_drawings as motion_drawings

# A model where it starts, with its coordinates and lengths
from eomgen.page.figure import rest_figure as rest_figure
from eomgen.page.formats import FORMATS as FORMATS
from eomgen.page.formats import FilesByName as FilesByName

# The files of a report by name
from eomgen.page.formats import written_as as written_as

# Text that is markup already
from eomgen.page.markup import Html as Html

# <tag attribute="value">inside</tag>
from eomgen.page.markup import element as element

# Parts one after the other
from eomgen.page.markup import in_a_row as in_a_row

# A motion that a player can show
from eomgen.page.player import Playable as Playable

# Virtual displacements of one structure, to be played
from eomgen.page.player import PlayedDisplacements as PlayedDisplacements

# A run and its player's options
from eomgen.page.player import PlayedRun as PlayedRun

# Options of a player
from eomgen.page.player import PlayerOptions as PlayerOptions

# A player as a page
from eomgen.page.player import player_page_of as player_page_of

# A player, to be put into a page, or alone in one
from eomgen.page.player import player_parts_of as player_parts_of

# Checks that a page holds the run that it plays, and draws its model
from eomgen.page.player import player_read_back as player_read_back

# A model's page
from eomgen.page.playing import Played as Played

# The model alive in a page
from eomgen.page.playing import play as play

# The page of a model whose values stand
from eomgen.page.playing import played as played

# ({slider
from eomgen.page.playing import slider_ranges as slider_ranges

# Checks that the files of a report say what it holds
from eomgen.page.read_back import report_read_back as report_read_back
