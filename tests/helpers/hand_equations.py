"""Equations as people derive them, right in odd disguises and wrong in the usual ways, made from models.

What is wrong is made here with sympy from T, V and Q of the model, or by editing the model itself, never from the
contributions in which the judge thinks: so what the judge finds is found and not looked up. `HELD_OUT` are kinds of
mistakes that it was not written for.

    python tests/helpers/hand_equations.py            # the judge's table over all models: 300 wrong, 300 right
"""

from __future__ import annotations

import random
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import sympy
from sympy import Rational, Symbol, cos, diff, expand, pi, sin, sstr

import eomgen
from eomgen.errors import EomgenError
from eomgen.mechanics.instant.quantities import Quantities
from eomgen.symbolic.print.sympy_form import to_sympy

MODELS = Path(__file__).parent.parent.parent / "models"
LONGEST = 2500  # characters of the equations of a model that somebody might derive by hand
SLOW = {"andrews_squeezer", "foucault_pendulum", "trifilar_pendulum", "robot_with_trailer"}


@dataclass(frozen=True)
class Hand:
    """An equation of somebody.

    Args:
        model: the name of the file.
        text: what was written.
        what: the kind of mistake, or the disguise.
        causes: kinds of causes that name the mistake; () of what is right.
        about: bodies, forces or parts of terms of which one must stand in the cause.
    """

    model: str
    text: str
    what: str
    causes: tuple[str, ...] = ()
    about: tuple[str, ...] = ()


class ByHand:
    """A model as somebody sees it who derives by hand: T, V, Q and Lagrange's equations in sympy."""

    def __init__(self, path: Path) -> None:
        self.path, self.name = path, str(path.relative_to(MODELS).with_suffix(""))
        self.model = eomgen.load(path)
        self.equations = eomgen.derive(self.model)
        s = self.equations.symbols
        graph = self.equations.graph.symbols
        self.q = [s[x.name] for x in graph.q]
        self.u = [s[x.name] for x in graph.u]
        self.a = [s[x.name] for x in graph.a]
        self.lam = [s[x.name] for x in graph.lam]
        self.t = s["t"]
        self.parameters = [s[x] for x in graph.parameters]

    @property
    def is_plain(self) -> bool:
        """Whether every coordinate is free and its rate a speed."""
        return [f"{q.name}'" for q in self.q] == [u.name for u in self.u] and self.equations.system.free is None

    @cached_property
    def rows(self) -> list[sympy.Expr]:
        """M a + c - Q - J^T lam."""
        e = self.equations
        left = e.M * sympy.Matrix(self.a) - e.forcing if self.a else sympy.Matrix([])
        if self.lam:
            left = left - e.J.T * sympy.Matrix(self.lam)
        return list(left)

    @cached_property
    def pushed(self) -> list[sympy.Expr]:
        """What of Q has no potential."""
        return [Q + diff(self.equations.V, q) for Q, q in zip(self.equations.Q, self.q, strict=True)]

    def dot(self, x: sympy.Expr) -> sympy.Expr:
        """d/dt"""
        found = diff(x, self.t)
        for q, u, a in zip(self.q, self.u, self.a, strict=True):
            found += diff(x, q) * u + diff(x, u) * a
        return found

    def lagrange(self, T: sympy.Expr, V: sympy.Expr, k: int) -> sympy.Expr:
        return self.dot(diff(T, self.u[k])) - diff(T, self.q[k]) + diff(V, self.q[k]) - self.pushed[k]

    @cached_property
    def bodies(self) -> dict[str, dict[str, sympy.Expr]]:
        """Of each body its kinetic energy, that of its mass centre, and its potential energy."""
        quantities, found = Quantities(self.equations.system), {}
        for body in quantities.bodies:
            T = quantities.kinetic_energy(body)
            m = quantities.mass(body)
            v = quantities.rate(self.equations.system.motion.position((body, m.com)))
            moved = m.m * sum((x * x for x in v), start=0)
            try:
                V = quantities.potential_energy(body)
            except EomgenError:
                V = 0
            T, moved, V, m = to_sympy((T, moved, V, m.m))
            found[body] = {"T": T, "moved": moved / 2, "turned": sympy.expand(T - moved / 2), "V": V, "m": m}
        return found

    # -- numbers ---------------------------------------------------------------------------------

    def is_right(self, D: sympy.Expr) -> bool:
        """Whether a linear equation in a is a combination of the model's, at random numbers."""
        rng = np.random.default_rng(2)
        unknowns = [*self.a, *self.lam]
        rows = [D, *self.rows, *self._closing]
        parts = [[diff(row, x) for x in unknowns] + [row.subs(dict.fromkeys(unknowns, 0))] for row in rows]
        names = sorted(set().union(*(x.free_symbols for row in parts for x in row)), key=str)
        f = sympy.lambdify(names, sympy.Matrix(parts), "numpy", cse=True)
        for _ in range(2):
            table = np.array(f(*self._constrained(names, rng.uniform(0.4, 1.9, len(names)))), dtype=float)
            table /= np.linalg.norm(table, axis=1, keepdims=True) + 1e-300
            own, mine = table[1:], table[0]
            share, *_ = np.linalg.lstsq(own.T, mine, rcond=None)
            if np.linalg.norm(own.T @ share - mine) > 1e-8:
                return False
        return True

    def _constrained(self, names: list[Symbol], values: np.ndarray) -> np.ndarray:
        """The values with speeds that the constraints allow."""
        e = self.equations
        if not len(e.graph.J):
            return values
        known = dict(zip(names, values, strict=True))
        others = {x: 1.3 for x in (e.J.free_symbols | e.sigma.free_symbols) - known.keys()}
        J, sigma = (np.array(x.subs(known | others).tolist(), dtype=float) for x in (e.J, e.sigma))
        u = np.array([known.get(x, 1.0) for x in self.u])
        u = u - np.linalg.lstsq(J, J @ u + sigma.ravel(), rcond=None)[0]
        known |= {x: v for x, v in zip(self.u, u, strict=True) if x in known}
        return np.array([known[x] for x in names])

    @cached_property
    def _closing(self) -> list[sympy.Expr]:
        e = self.equations
        return list(e.J * sympy.Matrix(self.a) + e.gamma) if len(e.graph.J) else []


# -- wrong ---------------------------------------------------------------------------------------------

TRIG = (sympy.sin, sympy.cos)


def terms_of(x: sympy.Expr) -> list[sympy.Expr]:
    return list(sympy.Add.make_args(expand(x)))


def with_term(x: sympy.Expr, old: sympy.Expr, new: sympy.Expr) -> sympy.Expr:
    return sympy.Add(*[new if term == old else term for term in terms_of(x)])


def exchanged(x: sympy.Expr) -> sympy.Expr:
    """sin for cos and cos for sin."""
    return x.replace(lambda e: isinstance(e, TRIG), lambda e: cos(*e.args) if isinstance(e, sin) else sin(*e.args))


def power(term: sympy.Expr, u: Symbol) -> sympy.Expr:
    return term.as_powers_dict().get(u, sympy.Integer(0))


def is_coriolis(hand: ByHand, term: sympy.Expr) -> bool:
    return sum(power(term, u) == 1 for u in hand.u) == 2


def of_terms(hand: ByHand, rng: random.Random) -> Iterator[tuple[str, sympy.Expr, tuple[str, ...], tuple[str, ...]]]:
    """(kind, wrong row, causes, about) of mistakes in single terms of a result."""
    for k, row in enumerate(hand.rows):
        terms = terms_of(row)
        if len(terms) < 2 or len(terms) > 30:
            continue
        term = rng.choice(terms)
        coriolis = ("coriolis",) if is_coriolis(hand, term) else ()
        yield "a term forgotten", with_term(row, term, sympy.Integer(0)), ("missing_term", "wrong_point", *coriolis), ()
        term = rng.choice(terms)
        coriolis = ("coriolis",) if is_coriolis(hand, term) else ()
        yield "a sign", with_term(row, term, -term), ("sign", *coriolis), ()
        term, factor = rng.choice(terms), rng.choice([2, Rational(1, 2)])
        coriolis = ("coriolis",) if is_coriolis(hand, term) else ()
        yield "a factor", with_term(row, term, factor * term), ("factor", "wrong_point", *coriolis), ()
        if turning := [x for x in terms if x.has(*TRIG)]:
            term = rng.choice(turning)
            yield "sin for cos", with_term(row, term, exchanged(term)), ("wrong_axis",), ()
            term = rng.choice(turning)
            scaled = term.replace(lambda e: isinstance(e, TRIG), lambda e: e.func(e.args[0] * pi / 180))
            yield "degrees", with_term(row, term, scaled), ("unit",), ()
        products = [x for x in terms if is_coriolis(hand, x)]
        if products:
            term = rng.choice(products)
            factor = rng.choice([Rational(1, 2), -1, 0])
            yield "Coriolis", with_term(row, term, factor * term), ("coriolis",), ()
        term = rng.choice(terms)
        yield "a unit", with_term(row, term, term / 1000), ("unit",), ()
        extra = rng.choice(terms)
        others = [x for x in hand.q if not extra.has(x)] or [hand.q[0]]
        wave = rng.choice(TRIG)(rng.choice(others))
        yield "a term too many", row + extra * wave / 3, ("extra_term",), ()
        yield "a reaction left in", row + Symbol("N"), ("constraint_force", "extra_term"), ("N",)
        pairs = [(x, y) for x in hand.parameters for y in hand.parameters if x is not y and _alike(hand, x, y)]
        pairs = [(x, y, z) for x, y in pairs for z in terms if z.has(x)]
        if pairs:
            x, y, term = rng.choice(pairs)
            yield "a wrong parameter", with_term(row, term, term.subs(x, y)), ("wrong_quantity",), (y.name, x.name)
        if hand.a and k >= 0:
            speeds = [x for x in terms if any(power(x, u) == 2 for u in hand.u)]
            if speeds:
                term = rng.choice(speeds)
                u = next(u for u in hand.u if power(term, u) == 2)
                yield "held out: a square lost", with_term(row, term, term / u), ("factor",), (u.name,)
        if len(hand.u) > 1:
            moving = [(x, u, w) for x in terms for u in hand.u for w in hand.u if u is not w and x.has(u)]
            if moving:
                term, u, w = rng.choice(moving)
                other = with_term(row, term, term.subs(u, w))
                yield "held out: a wrong speed", other, ("wrong_quantity",), (u.name, w.name)
        lengths = [(x, p) for x in terms for p in hand.parameters if x.has(p)]
        if lengths:
            term, p = rng.choice(lengths)
            yield (
                "held out: a factor lost",
                with_term(row, term, term / p),
                ("factor", "missing_term", "wrong_point"),
                (p.name,),
            )
        doubles = [x for x in terms if x.has(*TRIG)]
        if doubles:
            term = rng.choice(doubles)
            small = term.replace(sin, lambda x: x).replace(cos, lambda x: 1)
            yield "held out: small angle", with_term(row, term, small), ("approximation",), ()


def _alike(hand: ByHand, x: Symbol, y: Symbol) -> bool:
    units = {name: (p.unit.text if p.unit else "") for name, p in hand.model.parameters.items()}
    return units[x.name] == units[y.name] and (units[x.name] != "" or x.name[0] == y.name[0])


def of_energies(hand: ByHand, rng: random.Random) -> Iterator[tuple[str, sympy.Expr, tuple[str, ...], tuple[str, ...]]]:
    """Mistakes in energies, from which the equations then follow."""
    if not hand.is_plain or hand.lam:
        return
    e = hand.equations
    for body, parts in hand.bodies.items():
        k = rng.randrange(len(hand.u))
        if parts["turned"] != 0:
            T = e.T - parts["turned"]
            yield "a rotation forgotten", hand.lagrange(T, e.V, k), ("missing_term", "wrong_point"), (body,)
            shape = getattr(hand.model.bodies[body].shape, "kind", "")
            about = {"rod": 3, "disc": 2}.get(shape)
            if about:
                T = e.T + about * parts["turned"]
                yield "Steiner twice", hand.lagrange(T, e.V, k), ("wrong_point", "factor"), (body,)
        if parts["T"] != 0:
            factor = rng.choice([2, Rational(1, 2)])
            T = e.T + (factor - 1) * parts["T"]
            yield "a half in T", hand.lagrange(T, e.V, k), ("factor", "wrong_point", "missing_term"), (body,)
        if parts["V"] != 0:
            j = next((j for j, q in enumerate(hand.q) if parts["V"].has(q)), k)
            yield "the sign of a weight", hand.lagrange(e.T, e.V - 2 * parts["V"], j), ("sign",), (body,)
            if parts["V"].has(*TRIG):
                V = e.V - parts["V"] + exchanged(parts["V"])
                yield "a height by the other axis", hand.lagrange(e.T, V, j), ("wrong_axis",), (body,)
        if len(hand.u) > 1 and parts["T"] != 0:
            crossed = [t for t in terms_of(parts["T"]) if sum(t.has(u) for u in hand.u) == 2]
            if crossed:
                T = e.T - 2 * sympy.Add(*crossed)
                yield "held out: the direction of a velocity", hand.lagrange(T, e.V, k), ("sign",), (body,)
                T = e.T - sympy.Add(*crossed)
                yield (
                    "held out: (a + b)^2 = a^2 + b^2",
                    hand.lagrange(T, e.V, k),
                    ("missing_term", "other", "factor"),
                    (body,),
                )
    for k in range(len(hand.u)):
        momentum, held = diff(e.T, hand.u[k]), diff(e.T, hand.q[k])
        static = diff(e.V, hand.q[k]) - hand.pushed[k]
        accelerated = sum((diff(momentum, u) * a for u, a in zip(hand.u, hand.a, strict=True)), start=sympy.Integer(0))
        if held != 0:
            yield "dT/dq forgotten", hand.dot(momentum) + static, ("missing_term", "coriolis"), ()
            yield "the sign of dT/dq", hand.dot(momentum) + held + static, ("sign", "coriolis"), ()
        yield (
            "M differentiated as a constant",
            accelerated - held + static,
            ("missing_term", "coriolis", *(("sign",) if len(hand.u) == 1 else ())),
            (),
        )
        yield "the sign of V", hand.lagrange(e.T, -e.V, k), ("sign",), ()


def of_models(hand: ByHand, rng: random.Random) -> Iterator[tuple[str, sympy.Expr, tuple[str, ...], tuple[str, ...]]]:
    """The equations of another model: what was drawn wrongly."""
    if not hand.is_plain or hand.lam:
        return
    model = hand.model
    for what, other, causes, about in _edited(model):
        try:
            wrong = eomgen.derive(other)
        except EomgenError:
            continue
        if len(wrong.speeds) != len(hand.u):
            continue
        rows = list(wrong.M * sympy.Matrix(hand.a) - wrong.forcing)
        k = next((k for k in range(len(rows)) if expand(rows[k] - hand.rows[k]) != 0), 0)
        yield what, rows[k], causes, about


def _edited(model: eomgen.Model) -> Iterator[tuple[str, eomgen.Model, tuple[str, ...], tuple[str, ...]]]:
    def with_(table: str, name: str, **changes) -> eomgen.Model | None:
        try:
            parts = dict(getattr(model, table))
            parts[name] = replace(parts[name], **changes)
            return replace(model, **{table: parts})
        except (EomgenError, TypeError):
            return None

    for name, force in model.forces.items():
        fields = {f for f in getattr(type(force), "__dataclass_fields__", {})}
        if force.kind == "gravity":
            opposite = tuple(f"-({x.text})" for x in force.acceleration)
            yield "gravity upwards", with_("forces", name, acceleration=opposite), ("sign",), (name,)
        if {"stiffness", "rest"} <= fields and getattr(force, "rest", None) is not None:
            yield "a spring without its rest length", with_("forces", name, rest="0"), ("missing_term", "sign"), (name,)
        if "stiffness" in fields and getattr(force, "stiffness", None) is not None:
            text = f"2*({force.stiffness.text})"
            yield "a spring twice as stiff", with_("forces", name, stiffness=text), ("factor",), (name,)
        if getattr(force, "damping", None) is not None:
            yield "a damper that drives", with_("forces", name, damping=f"-({force.damping.text})"), ("sign",), (name,)
        if "at" in fields and isinstance(force.at, str) and "." in force.at:
            body = force.at.split(".")[0]
            for point in ("center", "end", "origin"):
                if force.at != f"{body}.{point}":
                    moved = with_("forces", name, at=f"{body}.{point}")
                    yield "a force at the wrong point", moved, ("wrong_point", "missing_term", "factor"), (name, body)
    for name, body in model.bodies.items():
        joint = body.joint
        value = getattr(joint, "angle", None)
        if value is not None and len(value.names & model.coordinates.keys()) == 1:
            turned = with_("bodies", name, joint=replace(joint, angle=f"{value.text} + pi/2"))
            yield "an angle from the other axis", turned, ("wrong_axis", "other"), ()
    for name, other in list(_placed(model)):
        yield "held out: the mass centre elsewhere", other, ("wrong_point", "factor", "missing_term"), (name,)


def _placed(model: eomgen.Model) -> Iterator[tuple[str, eomgen.Model]]:
    for name, body in model.bodies.items():
        if body.shape is not None and body.shape.kind == "rod":
            length = body.shape.length.text
            try:
                longer = replace(body.shape, length=f"2*({length})")
                yield name, replace(model, bodies={**model.bodies, name: replace(body, shape=longer)})
            except (EomgenError, TypeError):
                continue


def wrong_of(hand: ByHand, rng: random.Random) -> list[Hand]:
    """Every wrong equation of a model; what is right by chance is left out."""
    found = []
    for source in (of_terms, of_energies, of_models):
        for what, row, causes, about in source(hand, rng):
            plain = row.subs(Symbol("N"), 0) if what == "a reaction left in" else row
            if row is None or len(str(row)) > LONGEST or row == 0 or row.has(sympy.Piecewise):
                continue
            if not any(row.has(x) for x in (*hand.u, *hand.a)):
                continue  # an equation of rest
            try:
                right = what != "a reaction left in" and hand.is_right(sympy.sympify(plain))
                if what == "an angle from the other axis":  # all of it: then it is another way to count, and right
                    groups = [(q,) for q in hand.q] + [tuple(hand.q)]
                    turned = [{q: q + s * pi / 2 for q in some} for some in groups for s in (1, -1)]
                    right = right or any(hand.is_right(row.subs(each, simultaneous=True)) for each in turned)
            except (TypeError, ValueError, ZeroDivisionError):
                continue
            if not right:
                found.append(Hand(hand.name, written(row, rng), what, causes, about))
    return found


# -- right ---------------------------------------------------------------------------------------------


def right_of(hand: ByHand, rng: random.Random) -> list[Hand]:
    """Right equations in odd disguises."""
    found: list[Hand] = []

    def add(what: str, D: sympy.Expr, *, latex: bool = False) -> None:
        if D != 0 and len(str(D)) <= LONGEST:
            found.append(Hand(hand.name, written(D, rng, latex), what))

    for row in hand.rows:
        if row == 0 or not any(row.has(a) for a in hand.a) or row.has(sympy.Piecewise):
            continue
        add("multiplied out", expand(row))
        add("in LaTeX", row, latex=True)
        p = rng.choice(hand.parameters) if hand.parameters else sympy.Integer(3)
        add("divided by a parameter", expand(row / p))
        add("times a cosine", expand(row * cos(rng.choice(hand.q))))
        add("minus everything", expand(-3 * row / 7))
        add("by double angles", _doubled(row))
        name = {q: q for q in hand.q}
        for q in hand.q:
            base = "phi" if "phi" not in {x.name for x in hand.q} and hand.model.coordinates[q.name] else "psi"
            name[q] = Symbol(f"{base}{q.name[-1] if q.name[-1].isdigit() else ''}")
            break
        if hand.is_plain:
            q = next(iter(name))
            if row.has(q) or any(row.has(x) for x in (hand.u[0], hand.a[0])):
                new = name[q]
                taken = {str(x) for x in row.free_symbols} | set(hand.model.parameters)
                if new.name not in taken:
                    add("another name", _renamed(hand, row, q, new, 1, 0))
                    add("another direction", _renamed(hand, row, q, new, -1, 0))
                    if _is_angle(hand, q):
                        add(
                            "from another axis",
                            _renamed(hand, row, q, new, rng.choice([1, -1]), rng.choice([pi / 2, -pi / 2, pi])),
                        )
    if len(hand.rows) > 1 and len(hand.rows) <= 4:
        first, second = rng.sample(hand.rows, 2)
        add("two equations together", expand(first + second * 2))
        add("two equations together", expand(first * cos(hand.q[0]) - second))
    if 1 <= len(hand.rows) <= 2 and not hand.lam and not any(row.has(sympy.Piecewise) for row in hand.rows):
        solved = hand.equations.M.LUsolve(hand.equations.forcing)
        add("solved for an acceleration", hand.a[0] - sympy.together(solved[0]))
    T, V = hand.equations.T, hand.equations.V
    for letter, value in (("T", T), ("V", V)):
        if (
            value != 0
            and not value.has(sympy.Piecewise)
            and letter not in {*hand.model.parameters, *hand.model.inputs}
            and len(str(value)) < LONGEST
        ):
            extra = rng.choice(hand.parameters) if letter == "V" and hand.parameters else 0
            found.append(Hand(hand.name, f"{letter} = {sstr(expand(value) + extra * 0)}", f"{letter} multiplied out"))
            found.append(
                Hand(
                    hand.name,
                    f"2*{letter} = {sympy.latex(2 * value, symbol_names=_latex_names(hand))}",
                    f"{letter} in LaTeX",
                )
            )
    return found


def _is_angle(hand: ByHand, q: Symbol) -> bool:
    return any(q in e.free_symbols for row in hand.rows for e in row.atoms(sin, cos))


def _doubled(x: sympy.Expr) -> sympy.Expr:
    """sin^2 and sin cos by the double angle."""
    a = sympy.Wild("a")
    x = expand(x).replace(sin(a) * cos(a), sin(2 * a) / 2)
    return x.replace(sin(a) ** 2, (1 - cos(2 * a)) / 2).replace(cos(a) ** 2, (1 + cos(2 * a)) / 2)


def _renamed(hand: ByHand, row: sympy.Expr, q: Symbol, new: Symbol, sign: int, shift: sympy.Expr | int) -> sympy.Expr:
    k = hand.q.index(q)
    rates = {hand.u[k]: sign * Symbol(f"{new.name}'"), hand.a[k]: sign * Symbol(f"{new.name}''")}
    return row.subs(rates).subs(q, sign * new + shift)


# -- written -------------------------------------------------------------------------------------------


def _latex_names(hand: ByHand | None) -> dict[Symbol, str]:
    return {}


def written(D: sympy.Expr, rng: random.Random, latex: bool = False) -> str:
    """D = 0, some of its terms on the other side."""
    terms = list(sympy.Add.make_args(D))
    moved = [x for x in terms if rng.random() < 0.35] if len(terms) > 1 else []
    left = sympy.Add(*[x for x in terms if x not in moved])
    right = -sympy.Add(*moved)
    if latex:
        return f"{_latex(left)} = {_latex(right)}"
    return f"{sstr(left)} = {sstr(right)}"


def _latex(x: sympy.Expr) -> str:
    """As sympy prints it, rates with dots."""
    names = {}
    for s in x.free_symbols:
        bare = s.name.rstrip("'")
        dots = len(s.name) - len(bare)
        if dots:
            letter, _, rest = sympy.latex(Symbol(bare)).partition("_")
            names[s] = f"\\{'d' * dots}ot{{{letter}}}" + (f"_{rest}" if rest else "")
    return sympy.latex(x, symbol_names=names)


# -- the table -----------------------------------------------------------------------------------------


def hands() -> Iterator[ByHand]:
    """Models whose equations a person may derive by hand."""
    for path in sorted([*MODELS.glob("*.toml"), *MODELS.glob("seeds/*.toml")]):
        if path.stem in SLOW:
            continue
        try:
            model = eomgen.load(path)
            if not model.coordinates:
                continue
            hand = ByHand(path)
            from eomgen.symbolic.print.text import text_size

            graph = hand.equations.graph
            size = sum(text_size(x) for row in (*graph.M, *graph.J, graph.forcing) for x in row)
            if graph.M and size < LONGEST:
                yield hand
        except (EomgenError, RecursionError):
            continue


def sample(cases: list[Hand], number: int, rng: random.Random) -> list[Hand]:
    """So many, every kind as often as it can be, every model too."""
    groups: dict[str, list[Hand]] = defaultdict(list)
    for each in rng.sample(cases, len(cases)):
        groups[each.what].append(each)
    chosen: list[Hand] = []
    used: Counter[str] = Counter()
    while len(chosen) < number and any(groups.values()):
        for what in sorted(groups):
            if groups[what] and len(chosen) < number:
                best = min(groups[what], key=lambda each: used[each.model])
                groups[what].remove(best)
                used[best.model] += 1
                chosen.append(best)
    return chosen


def named(case: Hand, verdict: eomgen.Verdict) -> bool:
    """Whether the mistake is named: one cause of a kind that tells it, and about the right thing."""
    if len(verdict.causes) != 1 or verdict.causes[0].kind not in case.causes:
        return False
    cause = verdict.causes[0]
    reported = f"{cause.text} {cause.term} {cause.body} {cause.force}"
    return not case.about or any(word in reported for word in case.about)


def cases(seed: int = 1) -> tuple[list[Hand], list[Hand]]:
    """Every wrong and every right equation of all models."""
    rng, wrong, right = random.Random(seed), list[Hand](), list[Hand]()
    for hand in hands():
        wrong += wrong_of(hand, rng)
        right += right_of(hand, rng)
    return wrong, right


def main(number: int = 300, seed: int = 1) -> None:
    from eomgen.judge.case import Case
    from eomgen.judge.judge import Judge

    wrong, right = cases(seed)
    rng, judges = random.Random(seed), {}
    print(
        f"{len({x.model for x in wrong})} models, {len(wrong)} wrong and {len(right)} right equations", file=sys.stderr
    )
    for title, some in (("wrong", sample(wrong, number, rng)), ("right", sample(right, number, rng))):
        table: dict[str, Counter[str]] = defaultdict(Counter)
        started = time.process_time()
        for case in some:
            row = table[case.what]
            row["all"] += 1
            if case.model not in judges:
                judges[case.model] = Judge(Case(eomgen.load(MODELS / f"{case.model}.toml")))
            try:
                began = time.process_time()
                with eomgen.patience(60):
                    verdict = judges[case.model].verdict(case.text)
                took = time.process_time() - began
            except EomgenError as error:
                row["error"] += 1
                print(f"ERROR {case.model}: {case.text}\n    {error.what}")
                continue
            row[verdict.verdict] += 1
            if title == "wrong" and verdict.verdict == "wrong":
                row["named"] += named(case, verdict)
            if verdict.verdict != title or (title == "wrong" and not named(case, verdict)) or took > 5:
                shown = "; ".join(f"[{cause.kind}] {cause.text}" for cause in verdict.causes)
                print(
                    f"{verdict.verdict.upper()} {case.what} | {case.model}: {case.text} ({took:.1f} s)\n"
                    f"    {verdict.up_to} {dict(verdict.substitution)} {verdict.reason} {shown}"
                )
        keys = ("all", "right", "wrong", "undecided", "error", "named")
        models = len({c.model for c in some})
        print(f"\n{title}: {len(some)} equations of {models} models, {time.process_time() - started:.0f} s")
        for what in sorted(table):
            print(f"  {what:45} " + " ".join(f"{key} {table[what][key]}" for key in keys))
        total = sum(table.values(), Counter())
        print(f"  {'together':45} " + " ".join(f"{key} {total[key]}" for key in keys) + "\n", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
