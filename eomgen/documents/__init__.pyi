"""Door of the room: what other rooms may import from `eomgen.documents`."""

# name = readable scalar (= then), up to a page of them; the rest is counted, not read
from eomgen.documents.bounded import page as page

# A table; where its columns do not fit side by side a formula for each of its cells
from eomgen.documents.bounded import tabled as tabled

# Quantities that derivations of a system name, each name once
from eomgen.documents.derivation import NamedQuantity as NamedQuantity

# A reaction that outputs can request by one name, with the letters that it has in derivations
from eomgen.documents.derivation import RequestedReaction as RequestedReaction

# The derivation of the equations of motion of a system
from eomgen.documents.derivation import derivation_of as derivation_of

# A reaction that an output names, with its meaning in words and its letter
from eomgen.documents.derivation import found_reaction as found_reaction
from eomgen.documents.derivation import named_quantities as named_quantities

# The formulas that hold at any state, and the stated first integrals, as they are printed
from eomgen.documents.derivation import printed_formulas as printed_formulas

# Reactions of a system, without those that need the name of a body too
from eomgen.documents.derivation import requested_reactions as requested_reactions

# {name: keys} of sections that are called by one name
from eomgen.documents.document import SECTION_GROUPS as SECTION_GROUPS

# The result of a verb
from eomgen.documents.document import Document as Document

# The document of a model, under its name, its remark and its source
from eomgen.documents.document import document_of as document_of

# The catalogue of the requested language, else of that of the model, for its documents
from eomgen.documents.document import language_of as language_of

# Lines of text that are of no model
from eomgen.documents.document import lines_document as lines_document

# Notation that a model declares
from eomgen.documents.document import notation_of as notation_of

# A document of one section without a head, for results that are no derivation
from eomgen.documents.document import plain_document as plain_document

# The document with symbols for names that are not the model's: of its reactions
from eomgen.documents.document import with_symbols as with_symbols

# Writes words at places of a panel, where they cover no line and no other
from eomgen.documents.drawing import add_names as add_names

# One stroke, in its layer
from eomgen.documents.drawing import artist_of as artist_of

# The corners of the picture: all that is drawn, but for tracks, which go on
from eomgen.documents.drawing import limits as limits

# M a + c = Q + J^T lam, row by row
from eomgen.documents.equation_steps import sides_of as sides_of
from eomgen.documents.figures import KINDS as KINDS

# Settings of matplotlib with which every picture is drawn
from eomgen.documents.figures import STYLE as STYLE

# A picture that is drawn when it is saved, or shown in a notebook
from eomgen.documents.figures import Picture as Picture

# The unit in which the forces of a picture are written, and those of couples with it
from eomgen.documents.figures import Scale as Scale

# The coordinates of each unit
from eomgen.documents.figures import by_unit as by_unit

# A number with four figures, without a power of ten where it has less than eight digits: 12340, 0.05
from eomgen.documents.figures import four_figures as four_figures

# of lines of one colour
from eomgen.documents.figures import heads_in_symbols as heads_in_symbols

# {reaction: (number of its colour, kind of its line)}: a colour an owner, a kind a component, no two alike
from eomgen.documents.figures import kinds_of_lines as kinds_of_lines
from eomgen.documents.figures import largest_reaction as largest_reaction

# The joints and constraints with the largest reactions, as many as have their lines in one panel; in their order
from eomgen.documents.figures import largest_reactions as largest_reactions

# A name as matplotlib sets it: theta1' -> \dot{\theta}_{1}, x_left -> x_{\mathrm{left}}
from eomgen.documents.figures import mathtext as mathtext

# Notation that the model of a run declares; the default where the run has no model
from eomgen.documents.figures import notation_of_run as notation_of_run

# reaction_x(B.II) -> B.II; tension(rope, 2) -> rope
from eomgen.documents.figures import owner_of as owner_of
from eomgen.documents.figures import range_without_noise as range_without_noise

# {unit: reactions that have a value at some instant}; units whose reactions are all 0 are left out
from eomgen.documents.figures import reactions_by_unit as reactions_by_unit

# One of the pictures of a run
from eomgen.documents.figures import run_picture as run_picture

# The expressions of the payload as texts
from eomgen.documents.json_form import Texts as Texts

# The equations of motion as plain data, ready for JSON
from eomgen.documents.json_form import equations_payload as equations_payload

# Texts of the equations of motion in the payload, the reactions left out
from eomgen.documents.json_form import payload_texts as payload_texts
from eomgen.documents.languages import OURS as OURS
from eomgen.documents.languages import Catalogue as Catalogue
from eomgen.documents.latex import PREAMBLE as PREAMBLE

# One notation for the symbols of the whole document
from eomgen.documents.latex import DocumentSetter as DocumentSetter
from eomgen.documents.latex import Group as Group

# The formulas in aligned blocks of a few rows each
from eomgen.documents.latex import display_blocks as display_blocks

# The equations of motion in one display, for Jupyter: $$ aligned $$
from eomgen.documents.latex import equations_latex as equations_latex

# The statements, formulas in a row taken together; listings are typeset before
from eomgen.documents.latex import grouped as grouped

# Paragraphs, displays and tables; formulas that follow one another are aligned together
from eomgen.documents.latex import latex_blocks as latex_blocks

# One piece of a sentence, formulas between dollars
from eomgen.documents.latex import piece_latex as piece_latex
from eomgen.documents.latex import setter_of as setter_of

# One side of a formula
from eomgen.documents.latex import side_latex as side_latex

# The document with sentences and formulas in place of listings
from eomgen.documents.latex import with_listings_typeset as with_listings_typeset

# Quantities in a table, a row each: name, formula and number typeset; one longer than a line is shortened
from eomgen.documents.markdown import listing_markdown as listing_markdown

# Paragraphs, displays and tables
from eomgen.documents.markdown import markdown_blocks as markdown_blocks

# Plain text for Markdown: nothing in it is markup, and it stays on its line
from eomgen.documents.markdown import markdown_escaped as markdown_escaped

# First step, with the assumptions; none where nothing was assumed
from eomgen.documents.motion_steps import assumption_steps as assumption_steps

# The letters of the axes: xy in the plane
from eomgen.documents.motion_steps import axes as axes

# 1 coordinate, 2 coordinates
from eomgen.documents.motion_steps import count as count

# Step with the given data
from eomgen.documents.motion_steps import data_step as data_step

# Step with what a model file declares
from eomgen.documents.motion_steps import given_step as given_step

# The symbols, with commas between
from eomgen.documents.motion_steps import listed_symbols as listed_symbols

# Statement that names the contacts that are open where the system rests; none where all are closed
from eomgen.documents.motion_steps import open_at_rest as open_at_rest

# A step for each question of a sheet
from eomgen.documents.motion_steps import question_steps as question_steps

# Step with the words of the problem
from eomgen.documents.motion_steps import statement_step as statement_step
from eomgen.documents.pages_read import GREEK_LETTERS as GREEK_LETTERS
from eomgen.documents.pages_read import PAGES as PAGES

# One block of a page
from eomgen.documents.pages_read import PageBlock as PageBlock
from eomgen.documents.pages_read import PageLine as PageLine

# A character of a page, or a formula between dollars
from eomgen.documents.pages_read import PagePart as PagePart

# The formulas of an aligned block: a row that begins with &\quad or &= goes on with the one before it
from eomgen.documents.pages_read import displayed as displayed

# Words as they are compared: without blanks and brackets, exponents as digits, a dot for a product
from eomgen.documents.pages_read import spoken as spoken

# Names in a line of text
from eomgen.documents.proven_documents import listed as listed

# The same error with the constraint that stays open at the start and by how much, where that can be found
from eomgen.documents.proven_documents import named_open as named_open

# The name that was probably meant, or all that there are
from eomgen.documents.proven_documents import nearest_name as nearest_name

# The document with the proof of what was found, and of its printed texts; None: none was requested
from eomgen.documents.proven_documents import proven as proven

# The document with a proof of the page that is made of it, read back, where it has one
from eomgen.documents.proven_documents import proven_as as proven_as

# Document of a result, with its proof where that is requested; its picture is saved where a file is given
from eomgen.documents.proven_documents import shown as shown

# The document of a result that needs no start; with a warning where nothing closes the constraints near it
from eomgen.documents.proven_documents import with_constraints_closed as with_constraints_closed

# The document with a note on the changes where its model could not start as it is written; a warning where
from eomgen.documents.proven_documents import with_start_reported as with_start_reported

# The reactions of a system with their symbols, or why they cannot be derived
from eomgen.documents.reaction_steps import letters_of as letters_of

# The reactions of equations of motion as they are printed
from eomgen.documents.reaction_values import PrintedReactions as PrintedReactions

# A symbol for every reaction, none of them a name of the model
from eomgen.documents.reaction_values import lettered as lettered

# The symbol that a joint or a constraint gives a reaction of its own; None of sums, and where it gives none
from eomgen.documents.reaction_values import own_symbol as own_symbol

# Name of a reaction: B_x, R_stick_x, N_wall, T_rope_2, M_E
from eomgen.documents.reaction_values import reaction_name as reaction_name

# Meaning in words of a reaction that an output names
from eomgen.documents.reaction_values import said as said
from eomgen.documents.read_back import HOW as HOW

# Comparison of one document with its page
from eomgen.documents.read_back import PageComparison as PageComparison

# Required content of one block of a page
from eomgen.documents.read_back import Wanted as Wanted
from eomgen.documents.read_back import wanted_of as wanted_of

# Puts scalars into readable form, each once and with a budget of its own: none depends on those before it
from eomgen.documents.reading import Reader as Reader

# Text of an exact answer, in the grammar; None where it is too long to read
from eomgen.documents.reading import answer_text as answer_text

# Result of a verb that can be shown: a derivation, entries for JSON, and a picture where it has one
from eomgen.documents.result import Result as Result

# The document with one of its sections, or as a part of another document
from eomgen.documents.result import fragment_of as fragment_of

# The document in one of the formats of ALL: text, latex, markdown, json
from eomgen.documents.result import rendered as rendered

# A name of a picture in its box
from eomgen.documents.scene_pictures import FlatName as FlatName

# A line, a face or a dot on the page of a picture
from eomgen.documents.scene_pictures import FlatShape as FlatShape
from eomgen.documents.scene_pictures import PagePoint as PagePoint

# A system in one configuration, in numbers
from eomgen.documents.scene_pictures import Sketch as Sketch

# A scene in space on matplotlib axes; `show` sets it to another of its frames
from eomgen.documents.scene_pictures import SpacePicture as SpacePicture

# A scene at its first frame, on matplotlib axes with equal scales and no frame
from eomgen.documents.scene_pictures import draw_scene as draw_scene

# A scene at the start of its model, with its dimensions
from eomgen.documents.scene_pictures import drawing_at_rest as drawing_at_rest

# A scene at the first frame of its drawing, on its page
from eomgen.documents.scene_pictures import flat_drawing as flat_drawing

# Height over width of the page of a drawing
from eomgen.documents.scene_pictures import page_shape as page_shape

# A scene at the start of its model
from eomgen.documents.scene_pictures import picture_of_scene as picture_of_scene

# The scene of a model at its start; a parameter without a value is drawn as 1
from eomgen.documents.scene_pictures import rest_picture as rest_picture

# The rotation from the ground to the page: right, up, towards the eye
from eomgen.documents.scene_pictures import sight as sight
from eomgen.documents.statements import Cell as Cell

# Something that a user types
from eomgen.documents.statements import Code as Code

# An entry of a matrix: M[theta, phi]
from eomgen.documents.statements import Entry as Entry

# sides joined by equality signs, on a line of their own
from eomgen.documents.statements import Formula as Formula

# A quantity by its name, and its meaning in words
from eomgen.documents.statements import Found as Found

# A table of any columns
from eomgen.documents.statements import Grid as Grid

# A general law, printed as it stands: for text, and for LaTeX
from eomgen.documents.statements import Law as Law

# Text that stands as it is: paths, counts, words of a tool
from eomgen.documents.statements import Lines as Lines

# Quantities one after the other, each with its known values
from eomgen.documents.statements import Listing as Listing

# A matrix as it stands: rows of scalars or numbers
from eomgen.documents.statements import Matrix as Matrix

# A quantity by its letter: T, V, Q(theta), x(arm.center), speed(arm.center)^2
from eomgen.documents.statements import Name as Name

# Expressions that are too long to be printed
from eomgen.documents.statements import Omitted as Omitted
from eomgen.documents.statements import Piece as Piece

# A sentence, with formulas inside
from eomgen.documents.statements import Prose as Prose

# One result: exact, as a number, with the method; or the reason why it is missing
from eomgen.documents.statements import Quantity as Quantity

# A time derivative: of a coordinate, a state or a quantity
from eomgen.documents.statements import Rate as Rate
from eomgen.documents.statements import Side as Side
from eomgen.documents.statements import Statement as Statement

# One step of a derivation, a section of a document; `key` names it for machines, "" where it has no head
from eomgen.documents.statements import Step as Step

# The table with these of its columns; None: with those in which something stands
from eomgen.documents.statements import key_of as key_of
from eomgen.documents.statements import narrow_grid as narrow_grid

# A sentence of these pieces
from eomgen.documents.statements import prose as prose

# A cell of a grid
from eomgen.documents.text import cell_text as cell_text

# A formula on one line: T = 6*M*R^2*theta'^2
from eomgen.documents.text import formula_text as formula_text

# Text without blanks; exponents as digits, raised or not
from eomgen.documents.texts_read import flat as flat

# a = b; a matrix row by row, cases one below the other
from eomgen.documents.texts_read import formula_said as formula_said
