"""Equations: what a user holds after `derive`: matrices, proof, code and the derivation that reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.documents import (
    Document,
    Grid,
    Result,
    Step,
    Texts,
    assumption_steps,
    derivation_of,
    equations_latex,
    equations_payload,
    letters_of,
    payload_texts,
    printed_formulas,
    proven,
)
from eomgen.errors import DerivationError, MissingValues, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System, derived_by
from eomgen.mechanics.free_bodies import Inverse, Reactions, equations_of_motion
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.start import Start
from eomgen.model import Model, nearest
from eomgen.proof import Certificate, Printed, certify
from eomgen.resources import doing
from eomgen.study import InverseDynamics, Matrices, ReactionFunction, RequestedOutputs, Study
from eomgen.symbolic.exact import equal_at_random_states, readable_all
from eomgen.symbolic.expression import (
    Fraction,
    Scalar,
    ScalarRow,
    ScalarRows,
    as_expression,
    depends_on,
    inner,
    jacobian,
    operations,
)
from eomgen.symbolic.numeric import FLOAT, Work, evaluate
from eomgen.symbolic.print import text_size

if TYPE_CHECKING:
    pass

FEW = 200  # operations of a matrix that a person reads


SHOWN = 6  # coordinates of a line
HEADS = {"names": "name", "equations": "equation of motion along", "reactions": "reaction", "outputs": "output"}


@dataclass(frozen=True, repr=False)
class Equations(Result):
    """The equations of motion of a model: q' = N u + nu, M a = forcing + J^T lam, J a + gamma = 0.

    `graph` holds N, nu, M, c, Q, forcing, J, sigma, gamma, phi, T, V as graph scalars; the same names on the
    equations themselves are their sympy forms, made on first use.

    Args:
        model: the model.
        method: by which they are derived: one of `formulations.METHODS`. `derived` has them by the method's own way;
            `graph` the same functions in their shortest form, the recursion over the tree, which code runs.
        study: what is derived of the model with its contacts in one mode, `graph` among it.
    """

    model: Model
    method: str
    study: Study

    @property
    def graph(self) -> EquationsOfMotion:
        """The equations as graph scalars."""
        return self.study.derived

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Assumptions about massless nodes and contacts: "floor assumed closed: h has no value"."""
        return self.study.assumptions

    def __repr__(self) -> str:
        names = self.coordinates[:SHOWN] + ("...",) * (len(self.coordinates) > SHOWN)
        size = f"{len(self.speeds)} equations of motion, {len(self.graph.J)} constraint rows"
        return f"<equations of {self.model.name!r} ({self.method}): {size}; coordinates {', '.join(names) or 'none'}>"

    @property
    def system(self) -> System:
        """Motion, loads and constraints."""
        return self.study.system

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(q.name for q in self.graph.symbols.q)

    @property
    def speeds(self) -> tuple[str, ...]:
        return tuple(u.name for u in self.graph.symbols.u)

    @property
    def states(self) -> tuple[str, ...]:
        """The states of first order, the last part of x = (q, u, z)."""
        return tuple(z.name for z in self.graph.symbols.z)

    @property
    def parameters(self) -> tuple[str, ...]:
        return tuple(self.graph.symbols.parameters)

    @property
    def inputs(self) -> tuple[str, ...]:
        return tuple(self.graph.symbols.inputs)

    @cached_property
    def symbols(self) -> dict[str, Any]:
        """{name: sympy symbol} of t, parameters, inputs, q, u, a and multipliers; they are real.

        equations.M.subs({equations.symbols["m"]: 2})
        """
        from eomgen.symbolic.print import to_sympy

        own = self.graph.symbols
        named = (own.t, *own.parameters.values(), *own.inputs.values(), *own.q, *own.u, *own.a, *own.z, *own.lam)
        return dict(zip((node.name for node in named), to_sympy(named), strict=True))

    N = cached_property(lambda self: _matrix(self.graph.N, len(self.speeds)))
    nu = cached_property(lambda self: _column(self.graph.nu))
    M = cached_property(lambda self: _matrix(self.graph.M, len(self.speeds)))
    c = cached_property(lambda self: _column(self.graph.c))
    Q = cached_property(lambda self: _column(self.graph.Q))
    forcing = cached_property(lambda self: _column(self.graph.forcing))
    J = cached_property(lambda self: _matrix(self.graph.J, len(self.speeds)))
    sigma = cached_property(lambda self: _column(self.graph.sigma))
    gamma = cached_property(lambda self: _column(self.graph.gamma))
    phi = cached_property(lambda self: tuple(None if x is None else _expression(x) for x in self.graph.phi))
    T = cached_property(lambda self: _expression(self.graph.T))
    V = cached_property(lambda self: _expression(self.graph.V))

    @cached_property
    def gravity(self) -> Any:
        """g(q): minus the generalized forces of gravity, a column."""
        return _column(_gravity_of(self.system))

    @cached_property
    def coriolis(self) -> Any:
        """C(q, u) with C u = c, by Christoffel's symbols: M' - 2 C is skew.

        Raises:
            DerivationError: speeds are not the rates of all coordinates, or something moves as a function of time.
        """
        return _matrix(_coriolis_of(self.graph), len(self.speeds))

    def point_jacobian(self, point: str) -> Any:
        """J of v = J u + what moves as given, the velocity of a point in ground axes: 2 rows in the plane, 3 in space.

        Raises:
            UsageError: no such point.
        """
        return _matrix(_jacobian_of_point(self.system, point), len(self.speeds))

    def rhs_jacobian(
        self,
        t: float = 0.0,
        x: Sequence[float] | None = None,
        p: Sequence[float] | None = None,
        inputs: Sequence[float] | None = None,
        *,
        single: bool = False,
    ) -> tuple[np.ndarray, np.ndarray]:
        """(A, B) of dx' = A dx + B dw near any motion: the Jacobian of the right-hand side in x = (q, u) and inputs.

        Args:
            x, p: None: the model's start and values.
            inputs: None: the model's own.
            single: nan where a change opens redundant constraints, which no acceleration then satisfies.
        Raises:
            MissingValues: parameters without values.
        """

        s = self.graph.symbols
        values = (
            t,
            *(RightHandSide.parameter_values(self.model) if p is None else p),
            *(self.start() if x is None else x),
        )
        nodes = (s.t, *s.parameters.values(), *s.x)
        known: dict[Any, Any] = dict(zip(nodes, map(float, values), strict=True))
        own = evaluate(tuple(self.graph.inputs.values()), known, FLOAT) if inputs is None else inputs
        return self.study.first_order.slopes_at(known | dict(zip(s.inputs.values(), own, strict=True)), single=single)

    def to_sympy_system(self) -> Any:
        """A SymbolicSystem of sympy.physics.mechanics: q' by q and u, M and forcing; theta' is theta_dot(t).

        States of first order stand behind its coordinates.

        Where constraints close, their multipliers are the derivatives of further speeds, the impulses of the
        constraints.

        Raises:
            DerivationError: friction that depends on the reactions.
        """
        return _sympy_system(self.graph)

    def subs(self, values: Mapping[Any, Any] | None = None, /, **more: Any) -> Substituted:
        """The matrices with some names replaced, all at once: equations.subs(m=2).M, equations.subs({"theta'": 0}).c.

        Args:
            values, more: numbers, sympy expressions, or texts of the grammar, by name or by symbol.
        Raises:
            UsageError: a name that the equations do not have.
        """
        return Substituted(self, {self._named(key): self._value(x) for key, x in {**(values or {}), **more}.items()})

    def _named(self, key: Any) -> Any:
        if str(key) not in self.symbols:
            fix = nearest(str(key), self.symbols) or f"one of {', '.join(self.symbols)}"
            raise UsageError(f"nothing is called '{key}' in the equations", fix=fix)
        return self.symbols[str(key)]

    def _value(self, given: Any) -> Any:
        """The sympy expression that replaces a name."""
        import sympy

        from eomgen.symbolic.print import to_sympy

        if isinstance(given, str):
            return to_sympy([self.system.scope.value(as_expression(given))])[0]
        return sympy.sympify(given, strict=True)

    @cached_property
    def derived(self) -> EquationsOfMotion:
        """The equations by the method's own way, friction left out: what the derivation writes."""
        return derived_by(self.method, self.system)

    @property
    def program(self) -> Program:
        """The right-hand side as a straight-line program.

        Raises:
            ModelError: a free coordinate moves no mass.
        """
        return self.study.program

    @property
    def reactions(self) -> Reactions:
        """Every reaction of joints and constraints, in q, u and the accelerations.

        Raises:
            DerivationError: a body is unsupported; a force has no point of application.
        """
        return self.study.reactions

    @property
    def reactions_program(self) -> tuple[tuple[str, ...], Program]:
        """(names, program) of the reactions that have a single value; accelerations as in the right-hand side."""
        return self.study.reactions_program

    @property
    def reaction_values(self) -> dict[str, Scalar]:
        """{name: value in q, u and a} of the reactions that have a single value, finite where nothing slides."""
        return self.study.reaction_values

    @property
    def requested_outputs(self) -> RequestedOutputs:
        """The outputs of the model that are functions of the state, in q, u and a; for each other one the reason."""
        return self.study.requested_outputs

    @property
    def outputs_program(self) -> Program:
        """The outputs that are functions of the state; accelerations as in the right-hand side."""
        return self.study.outputs_program

    @property
    def slopes(self) -> Matrices:
        """A = d x'/d x, B = d x'/d inputs as graph scalars, and the systems behind the unknowns that they hold.

        Raises:
            DerivationError: the mass matrix is singular whatever the state.
        """
        return self.study.slopes

    def certify(self, target: str | None = "numpy", printed: Printed | None = None) -> Certificate:
        """Check the equations by independent routes, and the code that `target` emits against the symbols.

        Args:
            printed: the derivation as it is printed, to be read back.
        """
        derived = None if self.method == "lagrange" else self.derived
        return certify(self.graph, RightHandSide.of(self.program, target), derived, printed=printed)

    def proven(self, document: Document, *, data: bool = False) -> Document:
        """A derivation with its proof: the equations', and of its own formulas as they are printed.

        Args:
            data: what `derive --json` carries, too, read back.
        """
        printed = replace(printed_formulas(document), letters=self._letters)
        if data:
            found = self._texts
            texts = tuple((name, text, x) for (name, x), text in zip(found.scalars, found.texts, strict=True))
            printed = replace(printed, texts=texts, definitions=tuple(found.definitions))
        return proven(document, self.certify(printed=printed))

    @cached_property
    def _texts(self) -> Texts:
        return payload_texts(self.graph)

    @property
    def _letters(self) -> dict[str, Scalar]:
        """The letters of printed reactions, with what the balance of all bodies gives; {} where there is friction."""
        if self.graph.friction:
            return {}
        letters = letters_of(self.system)
        if isinstance(letters, str):
            return {}
        solved = self.reactions
        known = (j for j in range(len(letters.symbols)) if solved.solution.determined(j))
        return {letters.symbols[j].name: solved.combined({j: 1}, "") for j in known}

    def rhs(self, target: str | None = None) -> RightHandSide:
        """The right-hand side `rhs(t, x, p, inputs=())`, x = q, then u, then z.

        Args:
            target: "numpy", "c", or None: C where there is a compiler, else numpy, said once on stderr.
        Raises:
            ToolMissing: "c" without a compiler.
            ModelError: a free coordinate moves no mass.
        """
        p0, x0 = self._known_values()
        return RightHandSide.of(self.program, target, x0=x0, p0=p0)

    def reaction_rhs(self, target: str | None = None) -> ReactionFunction:
        """The reactions `reactions(t, x, p, inputs=())`, with `.names`; what has no single value is not among them.

        Args:
            target: as of `rhs`.
        Raises:
            DerivationError: a body is unsupported; a force has no point of application.
        """
        names, program = self.reactions_program
        return ReactionFunction(names, RightHandSide.of(program, target))

    def inverse_dynamics(self, actuated: Sequence[str] = ()) -> InverseDynamics:
        """The forces and torques that given accelerations take, as expressions and as code.

        Args:
            actuated: coordinates, speeds, inputs, or bodies in their joint, one for each degree of freedom; () for all
                speeds of a system without closing constraints.
        Raises:
            UsageError: an unknown name; too few or too many actuators.
            DerivationError: Coulomb friction; an input that does not act linearly.
        """
        return InverseDynamics(Inverse.of(self.system, actuated))

    @cached_property
    def in_print(self) -> EquationsOfMotion:
        """The equations in which long rates and accelerations of what is driven stand by their names, psi' and psi''.

        The same as `graph` where there are none, or where it takes their laws to see that a constraint holds.
        """
        if not any(part.driven for part in self.model.coordinates.values()):
            return self.graph
        system = Quantities.put_into_rates(System.of(self.model, self.system.modes, with_laws=True))
        alike = len(system.constraints.closing) == len(self.system.constraints.closing) and len(
            system.symbols.u
        ) == len(self.speeds)
        return equations_of_motion(system) if system.scope.laws and alike else self.graph

    @cached_property
    def derivation(self) -> Document:
        """The derivation, step by step."""
        return self._derivation(full=False)

    def derivation_of_motion(self) -> Document:
        """The derivation without the reactions, whose formulas take the longest."""
        return self._derivation(full=False, reactions=False)

    def _derivation(self, *, full: bool, reactions: bool = True) -> Document:
        in_time = None if self.in_print is self.graph else self.graph
        found = derivation_of(self.in_print, self.method, full=full, in_time=in_time, reactions=reactions)
        return self._with_assumptions(found)

    def _with_assumptions(self, derivation: Document) -> Document:
        """The derivation with a first step that lists the assumptions."""
        return replace(derivation, steps=(*assumption_steps(self.assumptions), *derivation.steps))

    @doing("the derivation, step by step")
    def written(self, *, full: bool, units: bool = False) -> Document:
        """The document.

        Args:
            full: everything is printed, however long.
            units: those of names, equations, reactions and outputs too, for people and for machines.
        """
        document = self._derivation(full=True) if full else self.derivation
        if not units:
            return replace(document, entries=self.entries)
        found = self.study.units
        grids = tuple(Grid((HEADS[key], "unit"), tuple(found[key].items())) for key in HEADS if found[key])
        steps = (*document.steps, Step("units", "Units", grids))
        return replace(document, steps=steps, entries=lambda: {**self.entries(), "units": found})

    def entries(self) -> dict[str, Any]:
        """The fields of the JSON of `derive --json`."""
        payload = equations_payload(self.graph, self.method, self._texts)
        return {**payload, "assumptions": list(self.assumptions)}

    def _repr_latex_(self) -> str:
        return equations_latex(self.derivation)

    def start(
        self, parameters: Mapping[str, float] | None = None, start: Mapping[str, float] | None = None
    ) -> np.ndarray:
        """x at the start, q, u and z, from the model's start values and those that replace them; the constraints hold
        there.

        Raises:
            UsageError: a name in `start` that is no coordinate and no speed.
            MissingValues: a start value needs a parameter without a value.
            DerivationError: a constraint that does not close at the start.
        """
        return np.array(list(Start.of(self.system, parameters, start).values.values()), dtype=float)

    def _known_values(self) -> tuple[np.ndarray | None, np.ndarray | None]:
        """(p0, x0) of the model, None where a value is missing, or the constraints do not close at the start."""
        try:
            p = RightHandSide.parameter_values(self.model)
        except MissingValues:
            p = None
        try:
            return p, self.start()
        except (MissingValues, DerivationError):
            return p, None


MATRICES = ("N", "nu", "M", "c", "Q", "forcing", "J", "sigma", "gamma", "phi", "T", "V", "gravity", "coriolis")


@dataclass(frozen=True)
class Substituted:
    """The matrices of equations of motion with some names replaced, by their own names: N, nu, M, c, Q, ...

    Args:
        equations: the equations.
        values: what stands for each symbol.
    """

    equations: Equations
    values: Mapping[Any, Any]

    def __getattr__(self, name: str) -> Any:
        if name not in MATRICES:
            raise AttributeError(f"the equations have no matrix '{name}': there are {', '.join(MATRICES)}")
        found = getattr(self.equations, name)
        if name == "phi":
            return tuple(None if gap is None else gap.subs(self.values, simultaneous=True) for gap in found)
        return found.subs(self.values, simultaneous=True)

    def __repr__(self) -> str:
        said = ", ".join(f"{symbol} = {value}" for symbol, value in self.values.items())
        return f"<matrices of {self.equations!r}, with {said}>"


def _matrix(rows: Sequence[Sequence[Any]], columns: int) -> Any:
    """Graph scalars as a sympy matrix: as a person writes them where they are few, else sub-expressions shared."""
    import sympy

    from eomgen.symbolic.print import to_sympy

    entries = [x for row in rows for x in row]
    written = _written(entries) if operations(entries).total <= FEW else entries
    return sympy.ImmutableDenseMatrix(len(rows), columns, to_sympy(written))


def _written(entries: Sequence[Any]) -> list[Any]:
    """The entries, each multiplied out where that is shorter."""
    return [min(x, y, key=text_size) for x, y in zip(readable_all(entries, Work.ENTRY), entries, strict=True)]


def _column(entries: tuple[Any, ...]) -> Any:
    return _matrix(tuple((x,) for x in entries), 1)


def _expression(scalar: Any) -> Any:
    return _matrix(((scalar,),), 1)[0]


# -------- matrices --------------------------------------------------------------------------------------------
# EquationsOfMotion -> g(q) and C(q, u) of M u' + C u + g = everything else, and Jacobians of points.
#
# C_ij = 1/2 sum_k (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) u_k,   so that M' - 2 C is skew


def _gravity_of(system: System) -> ScalarRow:
    """g(q): minus the generalized forces of the uniform fields on every mass."""
    rows = [system.loads.load_row(weight) for weight in system.loads.weights]
    return tuple(-sum(column, start=0) for column in zip(*rows, strict=True)) if rows else (0,) * len(system.symbols.u)


def _coriolis_of(equations: EquationsOfMotion) -> ScalarRows:
    """C with C u = c, by Christoffel's symbols of M.

    Raises:
        DerivationError: speeds are not the rates of the coordinates, or something moves as given.
    """
    q, u, n = equations.symbols.q, equations.symbols.u, len(equations.symbols.u)
    rates = tuple(x.name for x in u) == tuple(f"{x.name}'" for x in q)
    if not rates:
        what = "C of C u = c is that of Christoffel where the speeds are the rates of all coordinates"
        raise DerivationError(what, fix="take c, or a model without dependent or driven coordinates and other speeds")
    slopes = [jacobian(row, q) for row in equations.M]  # slopes[i][j][k] = dM_ij/dq_k
    half = Fraction(1, 2)
    C = tuple(
        tuple(
            half * inner([slopes[i][j][k] + slopes[i][k][j] - slopes[j][k][i] for k in range(n)], u) for j in range(n)
        )
        for i in range(n)
    )
    if not equal_at_random_states(zip((inner(row, u) for row in C), equations.c, strict=True)).equal:
        raise DerivationError("c has terms besides C u: something moves as a function of time", fix="take c")
    return C


def _jacobian_of_point(system: System, point: str) -> ScalarRows:
    """J_P of v_P = J_P u + what moves as given, ground axes: 2 rows in the plane, 3 in space.

    Raises:
        UsageError: no such point.
    """
    model = system.scope.model
    if point not in model.named_points:
        raise UsageError(f"no point '{point}'", fix=nearest(point, model.named_points))
    velocity = system.motion.velocity(system.motion.place(point))
    return jacobian(velocity[: 2 if model.space == "plane" else 3], system.symbols.u)


# -------- sympy system ----------------------------------------------------------------------------------------
# EquationsOfMotion -> a SymbolicSystem of sympy.physics.mechanics.
#
# q' = N u + nu,  [[M, -J^T], [J, 0]] (u', lam) = (forcing, -gamma).
#
# sympy knows no multipliers: they are the derivatives of further speeds, the impulses of the constraints.


def _sympy_system(equations: EquationsOfMotion) -> Any:
    """Coordinates, speeds and inputs are functions of time of their names, theta' is theta_dot; parameters are real.

    Raises:
        DerivationError: friction, which hangs on the reactions.
    """
    from sympy import Function, ImmutableDenseMatrix
    from sympy.physics.mechanics import SymbolicSystem
    from sympy.physics.vector import dynamicsymbols

    from eomgen.symbolic.print import to_sympy

    if equations.friction:
        raise DerivationError("friction that hangs on the reactions has no mass matrix", fix="take `rhs`, or codegen")
    own, t = equations.symbols, dynamicsymbols._t
    n, k = len(own.u), len(equations.J)
    if any(depends_on(x, own.a) for x in equations.state_rates):
        equations.system.refuse_states("sympy's systems hold no rates by accelerations", "take `rhs`, or codegen")
    moving = (*own.q, *own.u, *own.z, *own.inputs.values())
    functions = {x: Function(x.name.replace("'", "_dot"))(t) for x in moving}
    impulses = [Function(f"impulse_{row.constraint}_{row.number}")(t) for row in equations.system.constraints.closing]
    rows: list[ScalarRow] = [(*row, *(-J[i] for J in equations.J)) for i, row in enumerate(equations.M)]
    rows += [(*row, *(0 for _ in equations.J)) for row in equations.J]
    rates = (*equations.system.scope.rates, *equations.state_rates)
    right = (*equations.forcing, *(-x for x in equations.gamma))
    known = dict(zip(to_sympy((*functions, own.t)), (*functions.values(), t), strict=True))
    entries = [x.xreplace(known) for x in to_sympy([*(x for row in rows for x in row), *right, *rates])]
    return SymbolicSystem(
        [functions[x] for x in own.places],
        ImmutableDenseMatrix(n + k, 1, entries[(n + k) ** 2 : (n + k) * (n + k + 1)]),
        speeds=[*(functions[x] for x in own.u), *impulses],
        mass_matrix=ImmutableDenseMatrix(n + k, n + k, entries[: (n + k) ** 2]),
        coordinate_derivatives=ImmutableDenseMatrix(len(rates), 1, entries[(n + k) * (n + k + 1) :]),
    )
