"""Equations of motion of mechanical systems: derived, certified, typeset, simulated, compiled.

    model = eomgen.load("pendulum.toml")      # or loads(text), or Model(space="plane", bodies={...}, ...)
    equations = eomgen.derive(model)          # Equations: M, forcing, J, T, V, ... as sympy; latex(), str()
    equations.certify().ok                    # Certificate: the proof
    equations.rhs()(0.0, x, p)                # the right-hand side, x = coordinates then speeds; C or numpy
    eomgen.simulate(model, time=10)           # Trajectory: t, x, energy, drift, status, message
    eomgen.simulator(model)(time=10)          # the same as often as one likes: derived and compiled once
    eomgen.simulate_many(model, time=10, parameters={"m": [1, 2]})  # Runs: many of them at once
    eomgen.sweep(model, over={"k": [1, 2]}, ask="max(x)")  # Sweep: a row for each run, to_pandas(), plot()
    eomgen.sensitivity(model, "frequency(1)", "k")        # Sensitivity: exact derivatives by parameters and starts
    eomgen.generate(model, ("c", "numpy"))    # Generated: texts, write(directory)
    eomgen.inverse_dynamics(model)            # InverseDynamics: the forces that given accelerations take, as code
    eomgen.solve(model)                       # {name: Answer} of the model's outputs: exact, value
    eomgen.statics(model)                     # Statics: reactions by virtual work and by equilibrium, diagrams
    eomgen.kinematics(model, at="t = 2")      # Kinematics: centres of rotation, velocities, accelerations, plot
    eomgen.inertia(model, about="O")          # Inertia: masses, mass centres, tensors, principal moments and axes
    eomgen.linearize(model)                   # Linearization: M, C, K, state matrix, modes, stability
    eomgen.play(model, "play.html")           # a page in which the model is alive, offline
    eomgen.scene_of(model)                    # Scene: what can be drawn at a state, as data over the parameters
    eomgen.report(model, "report.html")       # Report: a page, a paper (.pdf, .tex), text (.md), a notebook (.ipynb)
    eomgen.import_robot("robot.urdf")         # Model of a robot's file of another program
    eomgen.from_sympy(system)                 # Model of a System, KanesMethod or LagrangesMethod of sympy
    eomgen.verify(model, "T = m*v^2/2")       # Verdict: is an equation of somebody right, up to what, and if not, why
    eomgen.regressor(model)                   # Regressor: tau = Y pi + y0, .parameters, .base: what motions tell apart
    eomgen.identify(model, data)              # Identified: parameters from measured motions, of bodies that can be
    eomgen.freedom_of(model)                  # Freedom: degrees of freedom by rank, redundant constraints
    %load_ext eomgen                          # in a notebook: then %%eomgen NAME above the text of a model
    with eomgen.patience(30): ...             # any of these, for 30 s at the most

Parts of a model: Body, Parameter, Coordinate, Input, Output, ..., and the kinds in `shapes`, `joints`, `constraints`
and `forces` (eomgen.joints.Revolute). Mistakes are exceptions of the family EomgenError: ModelError holds every problem
of a model, each with its place and its fix. docs/reference is the reference of the fields.

All names are imported on first use, so that `import eomgen` costs nothing.
"""

from eomgen.doors import door
from eomgen.version import __version__ as __version__

__getattr__, __dir__, __all__ = door(__name__)
