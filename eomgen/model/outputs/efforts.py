"""multiplier, drive: what acts along the gap of a tie, and along a driven coordinate."""

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
