"""Model -> Checked: its degrees of freedom, the closure of its loops at the start, and cautions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field, replace
from functools import cached_property

from eomgen.errors import DerivationError, MissingValues, ModelError, Problem
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Freedom
from eomgen.mechanics.dynamics import System, WellPosed, assembled_by_recursion
from eomgen.mechanics.free_bodies import Structure
from eomgen.mechanics.instant import InstantKinematics
from eomgen.mechanics.kinematics import ContactMode, ContactModes, Motion, Scope, SystemScene
from eomgen.mechanics.start import Branches, Start
from eomgen.mechanics.statics import ContactsAtStart
from eomgen.model import Model, ModelOrPath, Table, Values, model_at


@dataclass(frozen=True)
class LoopStart:
    """Closure of the loops at the start.

    Args:
        begun: the start; None where nothing closes, or a value is missing.
        branches: the ways in which they close; None at a change point too.
        refused: the reason why they do not close, or "".
    """

    begun: Start | None = None
    branches: Branches | None = None
    refused: str = ""


@dataclass(frozen=True)
class Checked:
    """Results of checking a model without mistakes.

    Args:
        open: the contacts that do not touch at the start.
        mobility, structure: of a model without coordinates; None of all others.
        cautions: warnings of what other commands will refuse, or of what is probably a mistake.
        modes: the contact modes at the start.
    """

    model: Model
    freedom: Freedom
    open: tuple[str, ...]
    mobility: int | None
    structure: Structure | None
    start: LoopStart
    cautions: tuple[Problem, ...] = ()
    modes: ContactModes = field(default_factory=dict)

    @staticmethod
    def of(model: Model) -> Checked:
        """Checks a model: degrees of freedom, redundancy, closure of loops, cautions.

        Raises:
            ModelError: declared speeds that do not stand for the rates.
        """
        modes = ContactsAtStart.of(model).modes
        freedom = Freedom.of(model, modes)
        still = not model.coordinates and bool(model.constraints or model.trusses)
        start = _start_of_loops(model, modes, freedom)
        return Checked(
            model,
            freedom,
            tuple(name for name, mode in modes.items() if not mode.closed),
            mobility=_mobility_of(model) if still else None,
            structure=Structure.of(System.of(model, ContactsAtStart.at_rest(model))) if still else None,
            start=start,
            cautions=(
                *_open(model, start),
                *(_idle(model, modes) if model.coordinates else ()),
                *_locked(model, freedom, modes),
                *_unhung(model),
                *_stiff(model, modes, freedom),
                *_misplaced(model),
            ),
            modes=modes,
        )

    @property
    def missing(self) -> list[str]:
        """The parameters without a value."""
        known = self.model.exact_parameters()
        return [name for name in self.model.parameters if name not in known]

    @property
    def nodes(self) -> tuple[str, ...]:
        """Assumptions about massless nodes, in words."""
        return self.model.assumed_by_constraints

    @property
    def driven(self) -> list[str]:
        return [name for name, coordinate in self.model.coordinates.items() if coordinate.driven]

    @property
    def dependent(self) -> list[str]:
        return [name for name, coordinate in self.model.coordinates.items() if coordinate.dependent]

    @cached_property
    def unbuilt(self) -> tuple[tuple[str, str], ...]:
        """(place of its declaration, kind) of each part that is not derived yet."""
        return self.model.unbuilt

    @property
    def positions(self) -> int | None:
        """The degrees of freedom in position."""
        integrability = self.freedom.integrability
        return self.freedom.by_rank if integrability is None else integrability.positions


def freedom_of(
    model: ModelOrPath,
    modes: ContactModes | None = None,
    *,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Freedom:
    """The degrees of freedom of a model, where its kinds are built; constraints that move dependent coordinates close.

    Args:
        modes: how contacts are that can end; what is not named is closed.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        DerivationError: a constraint that cannot hold; a dependent coordinate that no constraint determines.
    """
    return Freedom.of(model_at(model, parameters, start), modes)


def _open(model: Model, start: LoopStart) -> tuple[Problem, ...]:
    """Constraints that do not close."""
    constraints = [name for name in model.constraints if f"'{name}'" in start.refused]
    return (
        (Problem(f"constraints.{constraints[0]}" if constraints else "constraints", start.refused),)
        if start.refused
        else ()
    )


def _locked(model: Model, freedom: Freedom, modes: ContactModes) -> tuple[Problem, ...]:
    """Coordinates that are to move, and constraints that let nothing move; what rests on contacts can leave them."""
    if any(c.unilateral and modes.get(c.name, ContactMode()).closed for c in model.contacts):
        return ()
    free = [name for name, q in model.coordinates.items() if not (q.driven or q.dependent)]
    given = any(leaf.path[0] == "constraints" and "t" in x.names for leaf, x in model.expressions)
    if freedom.by_rank != 0 or not free or given:
        return ()
    what = f"nothing can move: the constraints leave '{free[0]}' no freedom"
    return (Problem(f"coordinates.{free[0]}", what, fix="look for a hinge that is missing, or a constraint too many"),)


def _unhung(model: Model) -> Iterator[Problem]:
    """Problems with bodies that have mass and no joint in a model that moves: they stand still."""
    for name, body in model.bodies.items() if model.coordinates else ():
        mass = body.mass if body.shape is None else body.shape.mass
        if body.joint is None and mass is not None and mass.value_at(model.exact_parameters()) != 0:
            what = f"body '{name}' has no joint, and stands still in the ground's frame"
            yield Problem(f"bodies.{name}", what, fix="hang it by a joint; what is to stand still needs no mass")


def _stiff(model: Model, modes: ContactModes, freedom: Freedom) -> Iterator[Problem]:
    """Constraints with a direction in ground axes that would leave more degrees of freedom if it turned with one of
    their bodies."""
    for name, constraint in model.constraints.items() if freedom.by_rank is not None and model.space == "space" else ():
        for written, other in constraint.turned():
            try:
                found = Freedom.of(replace(model, constraints=Table({**model.constraints, name: other})), modes).by_rank
            except (DerivationError, ModelError):  # its constraints do not close so
                continue
            if found is not None and freedom.by_rank is not None and found > freedom.by_rank:
                count = f"{freedom.by_rank} degree{'' if freedom.by_rank == 1 else 's'} of freedom"
                what = f"the axis of '{name}' is in the ground's axes, and leaves {count}"
                fix = f"in a body's own axes it leaves {found}: {written}"
                yield Problem(f"constraints.{name}", what, fix=fix)
                break


def _misplaced(model: Model) -> Iterator[Problem]:
    """Starts that are probably a mistake: inside a bowl that is to be rolled on outside, beyond a stroke."""
    try:
        motion = Motion.of(Scope.of(model))
        known = not any(coordinate.dependent for coordinate in model.coordinates.values())
        for name, force in model.forces.items() if known else ():
            what, fix = force.misplaced(SystemScene(motion, f"forces.{name}"))
            if what:
                yield Problem(f"forces.{name}", what, fix=fix)
        for name, constraint in model.constraints.items():
            what, fix = constraint.misplaced(SystemScene(motion, f"constraints.{name}"))
            if what:
                yield Problem(f"constraints.{name}", what, fix=fix)
    except (DerivationError, ModelError):  # reported by the verbs that need equations of motion
        return


def _idle(model: Model, modes: ContactModes) -> tuple[Problem, ...]:
    """Coordinates that move no mass, or several that move none together."""
    try:
        return WellPosed(assembled_by_recursion(System.of(model, modes))).massless_motions
    except (DerivationError, ModelError):  # reported by the verbs that need equations of motion
        return ()


def _start_of_loops(model: Model, modes: ContactModes, freedom: Freedom) -> LoopStart:
    """Finds how the loops close at the start, and in which other ways they could.

    Raises:
        ModelError: declared speeds that do not stand for the rates.
    """
    if not model.coordinates or not (freedom.closing or model.speeds):
        return LoopStart()
    try:
        system = System.of(model, modes)
        if not freedom.closing:
            return LoopStart()
        begun = Start.of(system)
        return LoopStart(begun, None if begun.fork else Branches.of(system, begun.values))
    except MissingValues:
        return LoopStart()
    except ModelError:
        raise
    except DerivationError as error:  # an error of the verbs that need a start
        return LoopStart(refused=error.what)


def _mobility_of(model: Model) -> int:
    """Number of degrees of freedom at the start by rank; bodies that only constraints hold are counted as free.

    Raises:
        DerivationError: constraints that are not satisfied at the start.
    """
    return InstantKinematics.of(model.altered(given=None)).velocities.degrees_of_freedom
