"""Forces, springs and strings at a state -> checks that they act as their fields declare."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.free_bodies import Balance, Reactions
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.kinematics import (
    BodyLink,
    ContactMode,
    SystemScene,
)
from eomgen.model import Act
from eomgen.proof.declared_threads import RopeInNumbers
from eomgen.proof.states import (
    STEP,
    InNumbers,
    Pushes,
    Way,
    add_push,
    direction_at,
    pushed_otherwise,
    pushes_of,
    way_through,
)
from eomgen.symbolic.expression import Call, Node, Scalar, State, Vector, is_zero
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

# -------- declared work ---------------------------------------------------------------------------------------
# System, state -> whether all that is applied acts as its fields declare it, in numbers: no load is looked at twice.
#
#     sum F . dr + sum tau . w + sum Q_i dq_i + sum f ds - dV  =  Q . d,      dq = N d,  d at random
#
# dr, w = vee(dR R^T), ds and dV are central differences of the places, axes, joint variables and energies at q +- h N
# d. F, tau, Q and V are those that a force declares in numbers (`Force.acts`). Before the whole, each force by itself,
# on every body: moment about the ground's origin and force, ground axes.


Term = tuple[Scalar, Any]
"""(a scalar that moves, the work for a unit of it)"""
Placed = tuple[str | None, tuple[Scalar, ...], Vector]
"""(body, a place of it as a function of the coordinates, the force there in ground axes)"""


def acting_otherwise(system: System, state: State) -> str:
    """Message if a force pushes a body otherwise than it is declared, at a state; "".

    Raises:
        NoValue: something has no value there.
    """
    proof = Declared(system, state)
    for applied in system.loads.applied:
        if applied.is_field:
            continue
        due = proof.pushes(proof.acts_of(applied.name))
        if body := pushed_otherwise(pushes_of(system.motion, state, applied.loads), due, _size(due)):
            return f"forces.{applied.name} pushes '{body}' otherwise than it is declared"
    due = proof.pushes(proof.acts)
    stated = pushes_of(system.motion, state, (*system.loads.placed, *system.loads.weights))
    if body := pushed_otherwise(stated, due, _size(due)):
        return f"all forces together push '{body}' otherwise than they are declared"
    return ""


def declared_pushes(system: System, state: State, force: str) -> Pushes:
    """Wrench (moment about the ground's origin, force) of one force on each body, as its fields declare it.

    Raises:
        NoValue: it has none at the state.
    """
    declared = Declared(system, state)
    return declared.pushes(declared.acts_of(force))


@dataclass(frozen=True)
class CarriedFluid:
    """The fluid that moves with a body, over the motion, ground axes.

    Args:
        body: its name.
        place: to which its momenta belong [m].
        v: velocity of the place in the fluid [m/s].
        p, L: momentum, and angular momentum about the place [kg m/s, kg m^2/s].
    """

    body: str
    place: Vector
    v: Vector
    p: Vector
    L: Vector

    def rates_about_origin(self, system: System) -> tuple[Scalar, ...]:
        """(p', L' + v x p + r x p'), accelerations in them: the opposite of its push on the body."""
        rates = system.scope.with_accelerations((*self.p, *self.L))
        p, L = Vector(rates[:3]), Vector(rates[3:])
        return (*p, *(L + self.v.cross(self.p) + self.place.cross(p)))


def rates_of_fluids(system: System) -> tuple[tuple[Scalar, ...], ...]:
    """Rates of momentum, and of moment of momentum about the origin, of all of them."""
    return tuple(fluid.rates_about_origin(system) for fluid in fluids_carried(system).values())


def fluids_carried(system: System) -> dict[str, CarriedFluid]:
    """{force: what moves with its body}, as forces declare it, by the twists; found once."""
    if fluids_carried not in system.found:
        declared, found = Declared(system, {}), dict[str, CarriedFluid]()
        for name, force in system.scope.model.forces.items():
            for act in force.acts(declared) if force.moving else ():
                if act.fluid and act.body is not None:
                    R = system.motion.link(act.body).pose.R
                    found[name] = CarriedFluid(act.body, Vector(act.moving), *(R @ x for x in act.fluid))
        system.found[fluids_carried] = found
    known: dict[str, CarriedFluid] = system.found[fluids_carried]
    return known


def placed_pushes(system: System, state: State, forces: Iterable[str]) -> Iterator[Placed]:
    """Forces that push at places, of some forces by name.

    Raises:
        NoValue: something has no value there.
    """
    declared = Declared(system, state)
    for act in (act for name in forces for act in declared.acts_of(name)):
        if len(act.moving) == 3:
            yield act.body, act.moving, Vector(act.force)


def working_otherwise(equations: EquationsOfMotion, state: State) -> str:
    """Message if the work of Q along a random direction is not that of the declared loads; "".

    Raises:
        NoValue: something has no value there.
    """
    proof, u = Declared(equations.system, state), equations.symbols.u
    rng = Random(23)
    d = [fifty_digits().number(rng.choice((-1, 1)) * rng.randint(50, 100)) / 100 for _ in u]
    friction = equations.friction or (0,) * len(u)
    Q = proof.at(tuple(x - f for x, f in zip(equations.Q, friction, strict=True)))
    stated = sum((x * y for x, y in zip(Q, d, strict=True)), start=0)
    works = proof.works(proof.along(d))
    due, size = sum(works, start=0), 1 + sum(map(abs, works)) + sum(abs(x * y) for x, y in zip(Q, d, strict=True))
    if abs(stated - due) <= tolerances.DIFFERENCE_AT_50 * size:
        return ""
    return f"Q does the work {float(stated):.10g} for {float(due):.10g} of all that is declared"


def _size(pushes: Pushes) -> Any:
    return 1 + sum(abs(x) for both in pushes.values() for v in both for x in v)


@dataclass(frozen=True)
class Declared(InNumbers):
    """All that is declared, at one state: the trial of forces."""

    @property
    def scene(self) -> SystemScene:
        return SystemScene(self.motion, begun=self.system.loads.begun)

    def along(self, d: Sequence[Any]) -> Way:
        """The states at q +- h N d; nothing else changes."""
        symbols, scope = self.system.symbols, self.system.scope
        flat = self.at([x for row in scope.N for x in row])
        n = len(symbols.u)
        moved = [
            sum((x * y for x, y in zip(flat[n * i : n * i + n], d, strict=True)), start=0) for i in range(len(scope.N))
        ]

        def nearby(h: Any) -> State:
            return {**self.state, **{q: self.state[q] + h * x for q, x in zip(symbols.q, moved, strict=True)}}

        return Way((nearby(-STEP), self.state, nearby(STEP)), STEP)

    # -- work ------------------------------------------------------------------------------------------------

    def works(self, way: Way) -> list[Any]:
        """Virtual work of every act and every joint, along a direction of motion."""
        terms = [term for act in self.acts for term in self._terms(act)]
        terms += [self._of_joint(link, k) for link, k in self._in_joints]
        rates = way.rates([moving for moving, _ in terms])
        return [k * x for (_, k), x in zip(terms, rates, strict=True)]

    @property
    def acts(self) -> Iterator[Act]:
        for force in self.system.scope.model.forces.values():
            yield from force.acts(self)

    def acts_of(self, force: str) -> Iterator[Act]:
        return self.system.scope.model.forces[force].acts(self)

    @property
    def _in_joints(self) -> Iterator[tuple[BodyLink, int]]:
        for link in self.system.motion.links:
            yield from () if link.joint is None else ((link, k) for k in range(len(link.joint.pushes())))

    def _terms(self, act: Act) -> Iterator[Term]:
        yield from zip(act.moving, act.force, strict=True)
        if act.body is not None and any(act.couple):
            yield from self._of_couple(act.body, act.couple)

    def _of_couple(self, body: str, couple: Sequence[Any]) -> Iterator[Term]:
        """tau . vee(dR R^T), entry by entry of dR."""
        R = self.motion.link(body).pose.R
        now = self.at([x for row in R for x in row])
        for i, j, axis in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
            if couple[axis]:
                yield from ((R[i][k], couple[axis] * now[3 * j + k]) for k in range(3))

    def _of_joint(self, link: BodyLink, variable: int) -> Term:
        """(push - c s' - k (s - rest) and dry friction) ds, s' along the motion."""
        scope, push = self.system.scope, link.joint.pushes()[variable]
        s = scope.value(push.way)
        f, k, c, rest, now = self.at((*map(scope.value, (push.push, push.stiffness, push.damping, push.rest)), s))
        moves = c or push.friction is not None
        rate = way_through(self.system, self.state).rates((s,))[0] if moves else 0
        return s, f - c * rate - k * (now - rest) + _in_its_joint(self.system, self.state, (link, variable), rate)

    # -- loads on bodies -------------------------------------------------------------------------------------

    def pushes(self, acts: Iterable[Act]) -> Pushes:
        """Wrench (moment about the ground's origin, force) of acts on each body."""
        found: Pushes = {}
        for act in acts:
            force = Vector(act.force) if act.body is not None and act.moving else Vector.ZERO
            moment = self.vector(act.moving).cross(force) if any(force) else Vector.ZERO
            add_push(found, act.body, moment + act.couple, force)
        return found

    # -- the trial of forces ---------------------------------------------------------------------------------

    def value(self, x: Any, also: Mapping[str, Any] | None = None) -> Any:
        """Number of a declared expression, in which further names stand for given numbers; 0 of None."""
        scope = self.system.scope
        if also is None:
            return self.one(scope.value(x))
        own = {scope.graph.symbol(f"({name})"): number for name, number in also.items()}
        law = self.scene.value_at(x, dict(zip(also, own, strict=True)))
        return evaluate((law,), {**self.state, **own}, fifty_digits())[0]

    def directed(self, xs: tuple[Any, ...], axes: str = "ground") -> Vector:
        """A declared vector in the axes of the ground or of a body, in ground axes."""
        return self.carried(None if axes == "ground" else axes, self.vector(self.scene.vector(xs)), direction=True)

    def scalar(self, x: Any) -> Scalar:
        return self.system.scope.names[x] if isinstance(x, str) else self.system.scope.value(x)

    def place(self, point: str) -> tuple[str | None, Vector]:
        place = self.scene.place(point)
        return place[0], self.scene.position(place)

    def at_start(self, moving: Sequence[Scalar]) -> list[Any]:
        return self.at([self.scene.start(x) for x in moving])

    def velocity_of(self, point: str) -> Vector:
        return self.vector(self.motion.velocity(self.scene.place(point)))

    def angle(self, body: str) -> Scalar:
        return self.scene.angle(body)

    def turned(self, body: str | None) -> tuple[Any, Any]:
        """Angle of the axes about z, with the whole turns of the body, and its rate."""
        if body is None:
            return 0, 0
        link = self.motion.link(body)
        c, s, w = self.at((link.pose.R[0][0], link.pose.R[1][0], link.twist.w[2]))
        angle = fifty_digits().functions["atan2"](s, c)
        return angle if link.angle is None else _by_whole_turns(angle, self.one(link.angle)), w

    def masses(self, bodies: tuple[str, ...] | None) -> Iterator[tuple[str, Any, Vector]]:
        for name in bodies or [link.name for link in self.motion.links]:
            mass = self.system.scope.mass_properties(name)
            yield name, self.one(mass.m), self.scene.position((name, mass.com))

    def mass_that_enters(self, body: str, rate: Any) -> Any:
        return self.value(rate) if rate is not None else mass_that_enters(self.system, self.state, body)

    def rope(self, stops: tuple[Any, ...], slack: Any) -> RopeInNumbers:
        return RopeInNumbers(self.system, self.state, stops, slack)

    def spin(self, body: str) -> Vector:
        link = self.motion.link(body)
        return self.vector(link.pose.R @ link.twist.w)

    def axis(self, body: str) -> Vector:
        if self.scene.plane:
            return self.vector((0, 0, 1))
        link = self.motion.link(body)
        (w,) = (w for w, _ in link.S if not all(map(is_zero, w)))
        return direction_at(self.vector(link.pose.R @ w))

    def in_joint(self, body: str) -> tuple[Any, tuple[Act, ...]]:
        link = self.motion.link(body)
        parent = None if link.parent < 0 else self.motion.links[link.parent].name
        w, v = (self.vector(link.pose.R @ x) for x in link.S[0])
        along = w if any(w) else v
        square: Any = along @ along
        unit = (1 / square) * along
        if any(w):
            acts = (Act(body, couple=unit), Act(parent, couple=-unit))
        else:
            at = self.scene.position((body, link.point))
            acts = Act(body, at, tuple(unit)), self._opposite(parent, at, unit)
        return _joint_motion(self.system, self.state, link, 0)[1], acts

    def _opposite(self, parent: str | None, at: Vector, force: Vector) -> Act:
        """The opposite of a force on the material of the parent that is there."""
        if parent is None:
            return Act(None, (), ())
        origin = self.scene.position((parent, Vector.ZERO))
        return Act(parent, origin, tuple(-force), -(self.vector(at) - self.vector(origin)).cross(force))

    def rubs(self, force: Any, size: Any, rate: Any) -> Any:
        forces = self.system.scope.model.forces
        (name,) = (name for name, each in forces.items() if each is force)
        speed = None if force.smooth is None else self.value(force.smooth)
        return _dry_friction(self.system, name, (size, speed), rate)

    def direction(self, v: Vector) -> Vector:
        return direction_at(v)

    def function(self, name: str, *x: Any) -> Any:
        return fifty_digits().functions[name](*x)

    def rate_of(self, xs: tuple[Any, ...]) -> Vector:
        return Vector(way_through(self.system, self.state).rates(self.scene.vector(xs)))

    def in_stream(self, point: str, medium: tuple[Any, ...] | None) -> tuple[Vector, Vector]:
        body, r = self.scene.place(point)
        link, stream = self.motion.link(body or ""), self.scene.vector(medium)
        own = link.twist.at(r)
        return own.v + Vector(self.system.scope.time_derivative(r)) - link.pose.R.T @ stream, own.w

    @property
    def plane(self) -> bool:
        return self.scene.plane


# -------- reactions in numbers --------------------------------------------------------------------------------
# Balance of bodies, a state -> reactions in numbers, by its equations as they stand there: nothing is eliminated.


REFINEMENTS = 4  # of components: each adds the digits that doubles are sure of


def balanced_least(balance: Balance, known: Mapping[Node, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Components of least norm with which every body is in equilibrium, and, by columns, those that may be added.

    Args:
        known: all symbols with 50 digits, accelerations included.
    """
    A, b = (x.astype(float) for x in _rows(balance, known))
    U, sizes, V, rank = _parts(A)
    return V[:rank].T @ ((U[:, :rank].T @ b) / sizes[:rank]), V[rank:].T


def _rows(balance: Balance, known: Mapping[Node, Any]) -> tuple[np.ndarray, np.ndarray]:
    """A, b of A x = b: the equations of the bodies, and components that are given, with 50 digits."""
    rows: list[tuple[Mapping[int, Scalar], Scalar]] = [(e.coefficients, e.needed) for e in balance.equations]
    rows += [({j: 1}, x) for j, x in balance.given.items()]
    A, b = np.full((len(rows), len(balance.names)), 0, dtype=object), np.full(len(rows), 0, dtype=object)
    for i, (row, needed) in enumerate(rows):
        *entries, b[i] = evaluate((*row.values(), needed), known, fifty_digits())
        A[i, list(row)] = entries
    return A, b


def _parts(A: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    U, sizes, V = np.linalg.svd(A)
    return U, sizes, V, int(np.sum(sizes > tolerances.RANK_NEARBY * max(sizes, default=0.0)))


def reaction_at(system: System, known: State, call: Call) -> Any:
    """A reaction at a state with its accelerations, by components that hold every body in equilibrium there.

    Args:
        known: all symbols with 50 digits.
    """
    if reaction_at not in system.found:
        system.found[reaction_at] = Reactions.of(system, short=True)
    reactions: Reactions = system.found[reaction_at]
    by_components, symbols = reactions.by_components
    A, b = _rows(reactions.balance, known)
    U, sizes, V, rank = _parts(A.astype(float))
    inverse, digits = (V[:rank].T / sizes[:rank]) @ U[:, :rank].T, fifty_digits()
    x = np.full(A.shape[1], digits.number(0), dtype=object)
    for _ in range(REFINEMENTS):
        left = b - A @ x
        size = max(map(abs, left), default=0)
        if size == 0:
            break
        step = inverse @ np.array([float(y / size) for y in left])
        x = x + np.array([digits.number(y) * size for y in step.tolist()], dtype=object)
    numbers = dict(zip(symbols, x, strict=False))
    return evaluate((Quantities(system, balance=by_components).value(call),), {**known, **numbers}, digits)[0]


# -------- rates of states -------------------------------------------------------------------------------------


def declared_state_rates(system: System, known: State) -> dict[str, Any]:
    """{state: z'} of the states of first order at a state with its accelerations, by the file's own texts.

    Each name in a text is put in as a number, the rate of another state by its own text: nothing of the system's graph
    stands between. Those that forces bring along are worked in numbers (`Force.rates`), and a reaction is that with
    which the equations of the bodies balance in numbers.
    """
    names = system.scope.names
    of_forces = {f"{name}'": rate for name, rate in _rates_in_forces(system, known).items()}
    declared = {f"{name}'": part.rate for name, part in system.scope.model.states.items()}
    laws = {name: law for name, law in declared.items() if law is not None}
    standing = frozenset[str]().union(*(law.names for law in laws.values())) - {"pi"}
    needed = tuple(standing & names.keys() - declared.keys())
    graph, digits = system.scope.graph, fifty_digits()
    own = {name: graph.symbol(f"({name})") for name in standing}  # no name of a model has parentheses
    values = dict(zip((own[x] for x in needed), evaluate([names[x] for x in needed], known, digits), strict=True))
    values |= {own[name]: rate for name, rate in of_forces.items() if name in own}
    reactions = system.scope.reactions_in_rates
    values |= {symbol: reaction_at(system, known, call) for symbol, call in reactions.items()}
    found: dict[str, Any] = {name[:-1]: rate for name, rate in of_forces.items()}
    while laws:
        name = next(x for x, law in laws.items() if law.names.isdisjoint(laws))  # by rates that are there
        tables = {key: x for key, x in names.items() if key.endswith("(")}
        scalar = laws.pop(name).evaluate({**own, **tables, "pi": graph.pi}, lambda call: graph.symbol(str(call)))
        found[name[:-1]] = evaluate((scalar,), values, digits)[0]
        if name in own:
            values[own[name]] = found[name[:-1]]
    return {name: found[name] for name in system.scope.model.states}


def _rates_in_forces(system: System, known: State) -> dict[str, Any]:
    """{state: z'} of those that forces bring along."""
    found: dict[str, Any] = {}
    for name, force in system.scope.model.forces.items():
        if force.own_states:
            names = (f"{name}_{own.name}" for own in force.own_states)
            found |= dict(zip(names, force.rates(Declared(system, known)), strict=True))
    return found


def mass_that_enters(system: System, known: State, body: str) -> Any:
    """Mass that enters a body per second by flows that do not say it: the rate of its mass less what is said of others.

    That rate is a central difference of the declared mass, along t and the states of first order.
    """
    scope, symbols, digits = system.scope, system.symbols, fifty_digits()
    moving = declared_state_rates(system, known)
    steps = {symbols.t: 1, **{z: moving[z.name] for z in symbols.z}}
    ways = [{x: known[x] + h * rate for x, rate in steps.items()} for h in (-STEP, STEP)]
    m = scope.mass_properties(body).m
    early, late = (evaluate((m,), {**known, **way}, digits)[0] for way in ways)
    said = (force.flow for force in scope.model.forces.values())
    others = [scope.value(x[1]) for x in said if x is not None and x[0] == body and x[1] is not None]
    return (late - early) / (2 * STEP) - sum(evaluate(others, known, digits), start=0)


# -------- elements --------------------------------------------------------------------------------------------
# System, state -> whether springs, dampers, pulls and what joints do act as they are declared, in numbers: their loads
# and their energies.


def has_elements(system: System) -> bool:
    """True if a spring, a damper or a pull acts."""
    return any(system.scope.model.forces[applied.name].element is not None for applied in system.loads.applied)


def undeclared(system: System, state: State) -> str:
    """Message that names an element which acts otherwise than it is declared, at a state; "".

    Raises:
        NoValue: something has no value there.
    """
    return next(_wrong_elements(Declared(system, state)), "") or next(_wrong_in_joints(system, state), "")


def acting(system: System, state: State, force: str) -> Any:
    """Pull of an element [N], or its moment on the second body [N m], by its declaration at a state."""
    return system.scope.model.forces[force].pulled(Declared(system, state))


def _wrong_elements(proof: Declared) -> Iterator[str]:
    """Messages of elements whose loads or energy are not those of their law."""
    for applied in proof.system.loads.applied:
        element = proof.system.scope.model.forces[applied.name].element
        if element is None:
            continue
        pull, energy = element.law(proof)
        reach: Any = 1 + max((proof.vector(proof.place(point)[1]).largest for point in element.points), default=0)
        stated = pushes_of(proof.motion, proof.state, applied.loads)
        if body := pushed_otherwise(stated, proof.pushes(element.acts(proof)), (1 + abs(pull)) * reach):
            yield f"forces.{applied.name} pushes '{body}' otherwise than its length and rate say"
        elif energy is not None and applied.potential is not None:
            wrong = _energy(proof.one(applied.potential), energy)
            yield from [f"forces.{applied.name} {wrong}"] if wrong else []


def _wrong_in_joints(system: System, state: State) -> Iterator[str]:
    """Messages where not effort = drive - c s' - k (s - rest), V = k (s - rest)^2 / 2, s by poses, s' by twists.

    Raises:
        NoValue: the joint turns about several axes; a pose does not determine its angles.
    """
    for effort in system.loads.efforts:
        link, scope = system.motion.link(effort.body), system.scope
        law = link.joint.pushes()[effort.variable]
        declared = tuple(map(scope.value, (law.push, law.damping, law.stiffness, law.rest)))
        drive, c, k, rest, stated, V = evaluate((*declared, effort.effort, effort.potential), state, fifty_digits())
        s, rate = _joint_motion(system, state, link, effort.variable)
        stretch, drive = s - rest, drive + _in_its_joint(system, state, (link, effort.variable), rate)
        if _turns(link, effort.variable) and k != 0:
            stretch = _by_whole_turns(stretch, (drive - c * rate - stated) / k)
        left, energy = stated - (drive - c * rate - k * stretch), k * stretch * stretch / 2
        wrong = "pushes otherwise than its drive, rate and place say"
        wrong = wrong if abs(left) > tolerances.ZERO_AT_50 * (1 + abs(stated)) else _energy(V, energy)
        yield from [f"bodies.{effort.body}.joint {wrong}"] if wrong else []


def _in_its_joint(system: System, state: State, acting: tuple[BodyLink, int], rate: Any) -> Any:
    """The dry friction of a given size along a variable of a joint; 0 without."""
    link, variable = acting
    law = link.joint.pushes()[variable].friction
    if law is None or law.size is None:
        return 0
    (name,) = (link.joint.named_contact(link.name, field) for _, field, each in link.joint.frictions if each is law)
    size, speed = evaluate(tuple(map(system.scope.value, (law.size, law.smooth))), state, fifty_digits())
    return _dry_friction(system, name, (size, None if law.smooth is None else speed), rate)


def _dry_friction(system: System, name: str, law: tuple[Any, Any], rate: Any) -> Any:
    """- T sign(s'), in a phase of the sense of its mode, or - T tanh(s'/v): T as it is declared, never below 0."""
    size, speed = max(law[0], 0 * law[0]), law[1]
    if speed is not None:
        return -size * fifty_digits().functions["tanh"](rate / speed)
    sense = system.modes.get(name, ContactMode()).sense
    return -size * ((rate > 0) - (rate < 0) if sense is None else sense)


def _energy(stated: Any, due: Any) -> str:
    """Message if a stated energy differs from the due one; ""."""
    same = abs(stated - due) <= tolerances.ZERO_AT_50 * (1 + abs(due))
    return "" if same else f"has the energy {float(stated):.10g} for {float(due):.10g}"


def _turns(link: BodyLink, variable: int) -> bool:
    return not all(map(is_zero, link.S[variable][0]))


def _joint_motion(system: System, state: State, link: BodyLink, variable: int) -> tuple[Any, Any]:
    """(s, s') of a joint's variable in numbers.

    A turn by s about n: 2 sin s = n . vee(R - R^T), 2 cos s = tr R - 1; a way s along v: s v.v = v . p.
    """
    if sum(_turns(link, j) for j in range(len(link.S))) > 1:
        raise NoValue("a joint that turns about several axes")
    home, here = link.joint.pose((0,) * len(link.S), system.scope.value), link.relative
    turning = _turns(link, variable)
    column = link.S[variable][0 if turning else 1]
    n, Q = here.R @ column, here.R @ home.R.T
    own = link.twist.w if turning else link.twist.v + link.twist.w.cross(link.point)
    against = link.pose.R @ own
    if link.parent >= 0:
        parent = system.motion.links[link.parent]
        carried = parent.twist.at(link.local.p)
        against = against - parent.pose.R @ (carried.w if turning else carried.v)
    requested = (
        n @ Vector((Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1])),
        Q[0][0] + Q[1][1] + Q[2][2] - 1,
        n @ (here.p - home.p),
        column @ column,
        against @ (link.pose.R @ column),
    )
    sine, cosine, way, square, rate = evaluate(requested, state, fifty_digits())
    size = square**0.5
    return fifty_digits().functions["atan2"](sine / size, cosine) / size if turning else way / square, rate / square


def _by_whole_turns(angle: Any, other: Any) -> Any:
    """Angle with the number of whole turns that brings it nearest to another."""
    turn = 2 * fifty_digits().functions["pi"]()
    return angle + turn * round((other - angle) / turn)
