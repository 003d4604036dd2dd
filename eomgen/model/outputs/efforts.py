"""multiplier, drive, pull, couple: along the gap of a tie, a driven coordinate, a spring, a damper."""

from eomgen.model.outputs.base import BALANCE, OutputFunction, name_at

MULTIPLIER = OutputFunction(
    names=("multiplier",),
    kinds=("tie",),
    least=1,
    unit="J",
    per=(0,),
    gives="of a tie of one row",
    value=lambda scene, call: scene.multiplier(name_at(call, 0)),
    second=lambda trial, call: trial.held(name_at(call, 0)),
    source=BALANCE,
)
DRIVE = OutputFunction(
    names=("drive",),
    kinds=("coordinate",),
    least=1,
    unit="J",
    per=(0,),
    gives="force or couple that moves a driven coordinate as given",
    value=lambda scene, call: scene.drive(name_at(call, 0)),
    second=lambda trial, call: trial.demanded(name_at(call, 0)),
    source=BALANCE,
)
PULL = OutputFunction(
    names=("pull",),
    kinds=("force between points",),
    least=1,
    unit="N",
    gives="of a spring, a damper, a `between`: what draws its points together",
    value=lambda scene, call: scene.effort(name_at(call, 0)),
    second=lambda trial, call: trial.acting(name_at(call, 0)),
    moves=True,
)
COUPLE = OutputFunction(
    names=("couple",),
    kinds=("force between bodies",),
    least=1,
    unit="N*m",
    gives="of a torsion spring or damper: on its second body, counter-clockwise",
    value=lambda scene, call: scene.effort(name_at(call, 0)),
    second=lambda trial, call: -trial.acting(name_at(call, 0)),
    moves=True,
)
