"""Model -> the same model in bodies and constraints alone: nodes of trusses are massless points, their members
constraints.

A node "T.n1" is a body of that name: a particle without mass, placed where the node is. The members of truss T are
the rows of one constraint T.
"""

from typing import Any

from eomgen.model.constraints.link import Members
from eomgen.model.fields import Table
from eomgen.model.joints.placed import Placed
from eomgen.model.parts import Body, Truss
from eomgen.model.shapes.lines import Particle
from eomgen.symbolic.expression import Expression


def in_parts(model: Any) -> Any:
    """The model with its trusses replaced by bodies and constraints; the model itself where it has none."""
    if not model.trusses:
        return model
    nodes = {f"{name}.{node}": _node(at) for name, truss in model.trusses.items() for node, at in truss.nodes.items()}
    members = {name: _members(name, truss) for name, truss in model.trusses.items() if truss.members}
    return model.altered(
        bodies=Table({**model.bodies, **nodes}),
        constraints=Table({**model.constraints, **members}),
        trusses=Table(),
    )


def _node(at: tuple[Expression, ...]) -> Body:
    point = Particle.of_values({"mass": Expression.number(0)})
    return Body.of_values({"shape": point, "joint": Placed.of_values({"at": at})})


def _members(name: str, truss: Truss) -> Members:
    return Members.of_values({"truss": name, "members": truss.members})


def is_node(body: str) -> bool:
    """True if a body of a model in parts is a node of a truss."""
    return "." in body


def called(body: str) -> str:
    """The name in messages of a body of a model in parts: body 'bar', node 'T.n1'."""
    return f"node '{body}'" if is_node(body) else f"body '{body}'"


def declared_at(body: str) -> str:
    """The path of its declaration: bodies.bar, trusses.T.nodes.n1."""
    truss, dot, node = body.partition(".")
    return f"trusses.{truss}.nodes.{node}" if dot else f"bodies.{body}"
