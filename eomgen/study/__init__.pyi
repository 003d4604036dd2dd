"""Door of the room: what other rooms may import from `eomgen.study`."""

# Results of checking a model without mistakes
from eomgen.study.checked import Checked as Checked

# The centrodes of a body in numbers
from eomgen.study.instant import CentrodeCurves as CentrodeCurves

# The bodies of a model at one instant, cut free
from eomgen.study.instant import CutState as CutState

# The motion of a model at an instant, however the model gives it
from eomgen.study.instant import kinematic_state as kinematic_state

# The entry of a derivation in the cache; None where this package is not made of files
from eomgen.study.kept_derivations import cached_derivation as cached_derivation

# The motion of a model from its start
from eomgen.study.motion import MotionFromStart as MotionFromStart

# State of a motion at one instant, exact and in numbers
from eomgen.study.motion import StateAtInstant as StateAtInstant

# A state as it is drawn: t, x and the parameters, with what is assumed of them
from eomgen.study.motion import StateInNumbers as StateInNumbers

# Efforts that move a system with given accelerations: A tau + J^T lam = M a + c - Q
from eomgen.study.programs import InverseDynamics as InverseDynamics

# Matrices as functions of the state, by name, one after the other, each row after row
from eomgen.study.programs import Matrices as Matrices

# `reactions(t, x, p, inputs=())` -> the reactions of the motion through a state, in the order of `names`
from eomgen.study.programs import ReactionFunction as ReactionFunction

# Outputs in q, u, a, t, parameters and inputs [SI], and why the others are none
from eomgen.study.programs import RequestedOutputs as RequestedOutputs

# Lazy value of a model in one configuration of its contacts
from eomgen.study.study import Study as Study

# The model whose motion is studied: each massless node is held by the balance of what pushes it
from eomgen.study.study import model_to_study as model_to_study

# The study of a model with its contacts as they are where it rests
from eomgen.study.study import study_at_rest as study_at_rest

# The study of a model with its contacts as they are at the start
from eomgen.study.study import study_of as study_of

# The study of a model with its contacts as they are named, what is not named closed
from eomgen.study.study import study_of_modes as study_of_modes
