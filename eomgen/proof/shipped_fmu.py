"""An FMU as it is shipped -> whether its description says of every variable what its name says.

der(x) is the derivative of x; the derivatives of the states are all states' and nothing else; each state and parameter
starts where it does in the model.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping

from eomgen.proof.check import Check, attempted
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import SOLVED


def fmu_told(packed: bytes, states: Mapping[str, float], parameters: Mapping[str, float]) -> Check:
    """The description of variables.

    Args:
        states, parameters: where they start, by name; {} where the model has no start, or no values.
    """
    name = "the FMU's variables are what their names say, and start as the model does"
    return attempted(name, "its description, read back", lambda: _wrong(_description(packed), states, parameters))


def _description(packed: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        return archive.read("modelDescription.xml").decode()


def _wrong(text: str, states: Mapping[str, float], parameters: Mapping[str, float]) -> str:
    from xml.etree import ElementTree

    found = ElementTree.fromstring(text)
    variables = {v.get("valueReference"): v for v in found.iter("Float64")}
    named = {str(v.get("name")): v for v in variables.values()}
    if len(named) != len(variables):
        return "two variables have one name"
    rates = {reference: v for reference, v in variables.items() if v.get("derivative") is not None}
    for v in rates.values():
        of = variables.get(v.get("derivative"))
        if of is None or v.get("name") != f"der({of.get('name')})":
            return f"'{v.get('name')}' is said to be the derivative of '{'' if of is None else of.get('name')}'"
    listed = {each.get("valueReference") for each in found.iter("ContinuousStateDerivative")}
    if listed != set(rates):
        return "the derivatives that are listed are not those of the states"
    if not states and not parameters:
        raise NoValue("the model has no start")
    for name, right in (*states.items(), *parameters.items()):
        told = named[name].get("start") if name in named else None
        if told is None or abs(float(told) - right) > SOLVED * (1 + abs(right)):
            return f"'{name}' starts at {told} for {right:.12g}"
    missing = [name for name in states if f"der({name})" not in named]
    return f"'{missing[0]}' has no derivative" if missing else ""
