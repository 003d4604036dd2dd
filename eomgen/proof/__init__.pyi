"""Door of the room: what other rooms may import from `eomgen.proof`."""

# Solver from which answers came
from eomgen.proof.answers import AnswerSolver as AnswerSolver

# Proof of the equations, where an answer needs them, then of every answer
from eomgen.proof.answers import certify_answers as certify_answers

# A system in one phase, at a state
from eomgen.proof.at_a_state import NumericState as NumericState

# Check the equations of a system
from eomgen.proof.certificate import certify as certify

# Check the places by the balance of forces, and by the equations of motion: nothing is accelerated there
from eomgen.proof.certificate import certify_equilibria as certify_equilibria

# Check the equations, every formula of a reaction, and its number at the start
from eomgen.proof.certificate import certify_reactions as certify_reactions
from eomgen.proof.check import SIGNS as SIGNS

# The proof that comes with a result
from eomgen.proof.check import Certificate as Certificate

# One thing that was checked
from eomgen.proof.check import Check as Check
from eomgen.proof.check import Status as Status

# Count of comparisons made so far, with their outcomes
from eomgen.proof.check import Tally as Tally

# A check that could not be made where its quantities have no value
from eomgen.proof.check import attempted as attempted

# A check that holds where nothing is wrong; `wrong` says what differs, or is ""
from eomgen.proof.check import checked as checked

# Difference of two numbers in words, where it is more than a share of the larger; ""
from eomgen.proof.check import differing as differing

# The first thing that is wrong, or ""
from eomgen.proof.check import first_wrong as first_wrong

# A check for which there is no state, no value or no time
from eomgen.proof.check import unchecked as unchecked

# Message that names a number which differs between the file and the model; "" where all agree
from eomgen.proof.declared_numbers import numbers_otherwise as numbers_otherwise

# Message if the count of degrees of freedom, or the rank of a structure, is another in numbers; ""
from eomgen.proof.degrees_of_freedom import counted_otherwise as counted_otherwise

# Message if a count is printed, or reported to machines, otherwise than it was found; ""
from eomgen.proof.degrees_of_freedom import lines_otherwise as lines_otherwise

# Rows of constraints that keep a value of the start, with their gaps
from eomgen.proof.degrees_of_freedom import rows_that_stay as rows_that_stay

# Content of one panel of a diagram
from eomgen.proof.drawn import DrawnPanel as DrawnPanel

# A force, a couple or a line load as it is drawn
from eomgen.proof.drawn import ReportedPush as ReportedPush

# Check that the values set in each run are of their ranges and laws
from eomgen.proof.drawn import drawn_otherwise as drawn_otherwise

# Its panels, bars of colours left out
from eomgen.proof.drawn import panels_of as panels_of

# Check of count, least, mean and largest value of each column, and of the columns reported the same in all runs
from eomgen.proof.drawn import reported_of_all as reported_of_all

# Reference values by which a function of generated code is checked
from eomgen.proof.emitted_code import Judged as Judged

# The equations of one phase
from eomgen.proof.emitted_code import PhaseMotion as PhaseMotion

# A state at which code is tried
from eomgen.proof.emitted_code import TriedState as TriedState

# The description of variables
from eomgen.proof.emitted_code import fmu_reported as fmu_reported

# The model's own start; () where a value is missing
from eomgen.proof.emitted_code import start_state_tried as start_state_tried

# A failing check where a number of the test vectors is missing in the self-test of a language; else none
from eomgen.proof.emitted_code import unwritten as unwritten

# Checks of impulses, speeds and loss of an impact
from eomgen.proof.impacts import impact_checks as impact_checks

# Message that names a body which differs from the file; "" where all that have the same name in both agree
from eomgen.proof.imported import imported_otherwise as imported_otherwise

# First difference between a robot's file, read in another way, and the model; "" if there is none
from eomgen.proof.imported import robot_otherwise as robot_otherwise

# Message for a declared part of a model that its URDF neither contains nor reports as left out; ""
from eomgen.proof.imported import unsaid_otherwise as unsaid_otherwise

# Checks of a printed kinematic state
from eomgen.proof.instant import instant_checks as instant_checks

# Stated mass properties of bodies about a point
from eomgen.proof.masses import Stated as Stated

# Checks of every shape, of the parts of bodies, and of all stated mass properties
from eomgen.proof.masses import mass_checks as mass_checks

# Accuracy that a run promises: an error of at most 10 (rtol size + atol) for each step
from eomgen.proof.motion import Promise as Promise

# Message that names a pin which is on the other side of its links' hinges than reported; ""
from eomgen.proof.posed_model import branches_otherwise as branches_otherwise

# Formulas as they are printed
from eomgen.proof.printed import Printed as Printed

# Reported derivation of one reaction by virtual work
from eomgen.proof.reported_cuts import ReportedWork as ReportedWork

# Checks of the forces on all bodies at a state
from eomgen.proof.reported_cuts import cuts_reported as cuts_reported

# An arrow
from eomgen.proof.reported_pictures import ReportedArrow as ReportedArrow

# Content of a picture at one state, places in ground axes, d = 2 or 3 coordinates each
from eomgen.proof.reported_pictures import ReportedPicture as ReportedPicture

# Picture that a page draws by its scene, with the numbers of a frame in its slots
from eomgen.proof.reported_pictures import picture_of_page as picture_of_page

# Check of the pictures of some states
from eomgen.proof.reported_pictures import pictures_reported as pictures_reported

# (frame, state) of the first, the middle and the last frame, where it is a row of the run
from eomgen.proof.reported_pictures import states_shown as states_shown

# Reported texts of a run
from eomgen.proof.reported_run import ReportedRun as ReportedRun

# Checks of all reported texts of a run against its states
from eomgen.proof.reported_run import run_reported as run_reported

# Printed texts of small motions
from eomgen.proof.reported_small_motions import PrintedModes as PrintedModes

# Check of a picture of small motions
from eomgen.proof.reported_small_motions import small_motions_drawn as small_motions_drawn

# Proof of a run: a trajectory -> its certificate
from eomgen.proof.runs import RunProof as RunProof

# Difference in words between a reported value of an output and the samples of the run; "" without one
from eomgen.proof.runs import answered_otherwise as answered_otherwise

# Check the equations of motion, the small motions against differences of these, and what is reported of them
from eomgen.proof.small_motions import certify_small_motions as certify_small_motions

# States in motion at which every constraint holds, positions and speeds, by where dependent coordinates are free
from eomgen.proof.states import consistent_states as consistent_states

# Check the two ways, every body's balance, section forces from the other end, influence lines by loads
from eomgen.proof.structure import certify_structure as certify_structure

# Checks of a picture of a structure: its diagrams and influence line by their panels, the arrows together
from eomgen.proof.structure import structure_pictured as structure_pictured

# An equation with its verdict
from eomgen.proof.verdicts import JudgedEquation as JudgedEquation

# The proof of the equations against which others are judged, and of these verdicts by another decision
from eomgen.proof.verdicts import certify_judged as certify_judged
