"""Expressions -> their derivatives, on the same graph, so that they share their sub-expressions.

Forward (one direction, all outputs) and reverse (one output, all symbols). No recursion: the loops run in
evaluation order. The rules of the functions stand once, in PARTIALS.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Mapping, Sequence
from dataclasses import field
from operator import attrgetter
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.expression.graph import CONSTANTS, Graph
from eomgen.symbolic.expression.node import Node, Owner, Scalar, argument, op_bits
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.splines import Sampled, number_of_sampled

LONG, FEWER = 10_000, 3  # nodes that sweeps meet; how many times fewer change their way


def _found_once(find: Callable[..., Any], outputs: Sequence[Scalar], *how: Any) -> Any:
    """find(outputs, *how); cached by the graph, as every route needs the derivatives of T and of the momenta."""
    graph = next((x.graph for x in outputs if type(x) is Node), None)
    if graph is None:
        return find(outputs, *how)
    known, key = graph.found(find), (tuple(outputs), *how)
    if key not in known:
        known[key] = find(outputs, *how)
    return known[key]


def tangent(outputs: Sequence[Scalar], seeds: Mapping[Node, Scalar]) -> tuple[Scalar, ...]:
    """The derivative of the outputs along a direction: sum over x of (d output / dx) seeds[x].

    With seeds {q: u, u: a, t: 1} it is the total time derivative.

    Args:
        outputs: scalars of one graph.
        seeds: the direction's component along each symbol; symbols that are left out stay still.
    """
    found: tuple[Scalar, ...] = _found_once(_tangent, outputs, frozenset(seeds.items()))
    return found


def _tangent(outputs: Sequence[Scalar], given: Collection[tuple[Node, Scalar]]) -> tuple[Scalar, ...]:
    seeds = dict(given)
    moving = {x: rate for x, rate in given if type(rate) is Node or rate != 0}
    return _swept(outputs, moving, order(outputs), seeds) if moving else (0,) * len(outputs)


def _swept(
    outputs: Sequence[Scalar], moving: Mapping[Node, Scalar], nodes: Sequence[Node], seeds: Container[Node]
) -> tuple[Scalar, ...]:
    """The rates of the outputs, from what moves through the nodes in evaluation order; those of the seeds are given."""
    rates = dict(moving)
    for x in nodes:
        if x in seeds or x.op == "symbol":
            continue
        for a in x.args:
            if type(a) is Node and a in rates:
                rate = _rate(x, [rates.get(a, 0) if type(a) is Node else 0 for a in x.args])
                if type(rate) is Node or rate != 0:
                    rates[x] = rate
                break
    return tuple(rates.get(x, 0) if type(x) is Node else 0 for x in outputs)


def tangents(outputs: Sequence[Scalar], symbols: Sequence[Node]) -> tuple[tuple[Scalar, ...], ...]:
    """The derivatives of the outputs by each symbol, in a sweep for each, through what depends on it alone."""
    nodes = order(outputs)
    return _columns(outputs, symbols, _followers(nodes, symbols))


def _columns(
    outputs: Sequence[Scalar], symbols: Sequence[Node], followers: Sequence[Sequence[Node]]
) -> tuple[tuple[Scalar, ...], ...]:
    each = zip(symbols, followers, strict=True)
    return tuple(_swept(outputs, {symbol: 1}, nodes, (symbol,)) for symbol, nodes in each)


def derivative(x: Scalar, symbol: Node) -> Scalar:
    """dx/dsymbol."""
    return tangent((x,), {symbol: 1})[0]


def gradient(x: Scalar, symbols: Sequence[Node]) -> tuple[Scalar, ...]:
    """(dx/dsymbol for each symbol), in one sweep from the result back to the symbols."""
    found: tuple[Scalar, ...] = _found_once(pullback, (x,), (1,), tuple(symbols))
    return found


def pullback(outputs: Sequence[Scalar], weights: Sequence[Scalar], symbols: Sequence[Node]) -> tuple[Scalar, ...]:
    """(sum over the outputs of weight d output/dsymbol, for each symbol), in one sweep: A^T w of the Jacobian A."""
    adjoint: dict[Node, Scalar] = {}
    for x, w in zip(outputs, weights, strict=True):
        if type(x) is Node and (type(w) is Node or w != 0):
            adjoint[x] = adjoint[x] + w if x in adjoint else w
    active = _dependents(order(adjoint), frozenset(symbols))
    for y in reversed(active):
        if y.op == "symbol" or y not in adjoint:
            continue
        for a, share in _shares(y, adjoint[y]):
            if type(a) is Node:
                adjoint[a] = adjoint[a] + share if a in adjoint else share
    return tuple(adjoint.get(symbol, 0) for symbol in symbols)


def jacobian(outputs: Sequence[Scalar], symbols: Sequence[Node]) -> tuple[tuple[Scalar, ...], ...]:
    """The matrix d outputs / d symbols, one row an output, by whichever sweeps are fewer, or meet far fewer nodes."""
    found: tuple[tuple[Scalar, ...], ...] = _found_once(_jacobian, outputs, tuple(symbols))
    return found


def _jacobian(outputs: Sequence[Scalar], symbols: Sequence[Node]) -> tuple[tuple[Scalar, ...], ...]:
    nodes = order(outputs)
    followers = _followers(nodes, symbols)
    if len(outputs) < len(symbols) or _is_shorter_backward(outputs, nodes, followers):
        return tuple(pullback((x,), (1,), symbols) for x in outputs)
    columns = _columns(outputs, symbols, followers)
    return tuple(tuple(column[i] for column in columns) for i in range(len(outputs)))


def substituted(outputs: Sequence[Scalar], replacements: Mapping[Node, Scalar]) -> tuple[Scalar, ...]:
    """The outputs with nodes replaced by scalars of the same graph, all at once; other outputs are unchanged."""
    known: dict[Node, Scalar] = dict(replacements)
    for x in order(outputs, replacements):
        if x in known or x.op == "symbol":
            continue
        if any(type(a) is Node and a in known for a in x.args):
            known[x] = rebuilt(x, [known.get(a, a) if type(a) is Node else a for a in x.args])
    return tuple(known.get(x, x) if type(x) is Node else x for x in outputs)


def rebuilt(x: Node, args: Sequence[Scalar]) -> Scalar:
    """x's operation on other arguments, folded as the graph folds."""
    graph, op = x.graph, x.op
    if op == "add":
        return graph.add(args[0], args[1])
    if op == "mul":
        return graph.mul(args[0], args[1])
    if op == "sub":
        return graph.add(args[0], graph.neg(args[1]))
    if op == "div":
        return graph.div(args[0], args[1])
    if op == "pow":
        return graph.pow(args[0], args[1])
    if op == "select":
        return graph.select(args[0], args[1], args[2])
    return graph.call(op, *args) if args else x


def symbols_of(outputs: Iterable[Scalar]) -> tuple[Node, ...]:
    """The symbols that the outputs hold, in the order of their making."""
    return tuple(x for x in order(tuple(outputs)) if x.op == "symbol")


def depends_on(scalars: Scalar | Iterable[Scalar], symbols: Collection[Node]) -> bool:
    """True where one of the symbols (or nodes) occurs in a scalar, or in one of several: shared parts are read once."""
    stack: list[Scalar] = [*scalars] if isinstance(scalars, Iterable) else [scalars]
    symbols = frozenset(symbols)
    seen: set[Node] = set()
    while stack:
        y = stack.pop()
        if type(y) is not Node or y in seen:
            continue
        if y in symbols:
            return True
        seen.add(y)
        if y.op != "symbol":
            stack += y.args
    return False


def _dependents(nodes: Sequence[Node], symbols: frozenset[Node]) -> list[Node]:
    """The nodes, out of those in evaluation order, that depend on the symbols."""
    found: list[Node] = []
    active: set[Scalar] = set(symbols)
    for x in nodes:
        if x in symbols or (x.op != "symbol" and any(type(a) is Node and a in active for a in x.args)):
            active.add(x)
            found.append(x)
    return found


def _followers(nodes: Sequence[Node], symbols: Sequence[Node]) -> list[list[Node]]:
    """The nodes that depend on each symbol, out of those in evaluation order; one list for each symbol."""
    found: list[list[Node]] = [[] for _ in symbols]
    on: dict[Scalar, int] = {}  # bit k: depends on symbol k
    for k, symbol in enumerate(symbols):
        on[symbol] = on.get(symbol, 0) | 1 << k
    for x in nodes:
        bits = on.get(x, 0)
        for a in x.args if x.op != "symbol" else ():
            bits |= on.get(a, 0) if type(a) is Node else 0
        if bits:
            on[x] = bits
        while bits:
            k = bits.bit_length() - 1
            found[k].append(x)
            bits ^= 1 << k
    return found


def _is_shorter_backward(outputs: Sequence[Scalar], nodes: Sequence[Node], followers: Sequence[Sequence[Node]]) -> bool:
    """True if reverse sweeps, one for each output, meet far fewer nodes than forward ones, one for each symbol.

    Only long matrices are counted. It is so for sums in which every symbol occurs in most of what follows: the angles
    along a chain.
    """
    forward = sum(map(len, followers))
    if forward < LONG:
        return False
    active = {x for each in followers for x in each}
    into: dict[Node, int] = {}  # bit k: output k is made of it
    for k, x in enumerate(outputs):
        if type(x) is Node:
            into[x] = into.get(x, 0) | 1 << k
    backward = 0
    for x in reversed(nodes):
        if x not in active:
            continue
        bits = into[x]
        backward += bits.bit_count()
        for a in x.args if x.op != "symbol" else ():
            if type(a) is Node:
                into[a] = into.get(a, 0) | bits
    return backward * FEWER < forward


def _rate(x: Node, rates: Sequence[Scalar]) -> Scalar:
    """The rate of x from the rates of its arguments."""
    op = x.op
    if op == "mul":
        a, b = argument(x, 0), argument(x, 1)
        return 2 * (a * rates[0]) if a is b else rates[0] * b + a * rates[1]
    if op == "add":
        return rates[0] + rates[1]
    if op == "sub":
        return rates[0] - rates[1]
    if op == "neg":
        return -rates[0]
    if op == "div":
        return x.graph.div(rates[0] - x * rates[1], x.args[1])
    if op == "select":
        return x.graph.select(x.args[0], rates[1], rates[2])
    partials = PARTIALS.get(op)
    if partials is None:
        return 0
    rate: Scalar = 0
    for partial, a_rate in zip(partials, rates, strict=True):
        if type(a_rate) is Node or a_rate != 0:
            rate = rate + partial(x.graph, x, *x.args) * a_rate
    return rate


def _shares(x: Node, w: Scalar) -> list[tuple[Scalar, Scalar]]:
    """(argument a of x, its part w dx/da of x's adjoint w), for each argument."""
    op, graph = x.op, x.graph
    if op == "mul":
        a, b = argument(x, 0), argument(x, 1)
        return [(a, 2 * (a * w))] if a is b else [(a, w * b), (b, a * w)]
    if op == "add":
        return [(a, w) for a in x.args]
    if op == "sub":
        return [(x.args[0], w), (x.args[1], -w)]
    if op == "neg":
        return [(x.args[0], -w)]
    if op == "div":
        part = graph.div(w, x.args[1])
        return [(x.args[0], part), (x.args[1], -(x * part))]
    if op == "select":
        condition, if_true, if_false = x.args
        return [(if_true, graph.select(condition, w, 0)), (if_false, graph.select(condition, 0, w))]
    return [
        (a, partial(graph, x, *x.args) * w)
        for partial, a in zip(PARTIALS.get(op, ()), x.args, strict=False)
        if type(a) is Node
    ]


def _rate_of_sampled(g: Graph, t: Scalar, k: Scalar) -> Scalar:
    rate = Sampled.of(k).derivative()
    return 0 if rate.spline.vanishes else g.call("sampled", t, number_of_sampled(rate))


def _power_in_exponent(g: Graph, x: Node, a: Scalar, n: Scalar) -> Scalar:
    return x * g.call("log", a)


# op -> for each argument, the partial derivative as a function of (graph, the node itself, its arguments);
# an op that is missing (sign and the comparisons) is constant almost everywhere.
PARTIALS: dict[str, tuple[Callable[..., Scalar], ...]] = {
    "sqrt": (lambda g, x, a: g.div(1, 2 * x),),
    "sin": (lambda g, x, a: g.call("cos", a),),
    "cos": (lambda g, x, a: -g.call("sin", a),),
    "tan": (lambda g, x, a: 1 + x * x,),
    "asin": (lambda g, x, a: g.div(1, g.sqrt(1 - a * a)),),
    "acos": (lambda g, x, a: g.div(-1, g.sqrt(1 - a * a)),),
    "atan": (lambda g, x, a: g.div(1, 1 + a * a),),
    "sinh": (lambda g, x, a: g.call("cosh", a),),
    "cosh": (lambda g, x, a: g.call("sinh", a),),
    "tanh": (lambda g, x, a: 1 - x * x,),
    "exp": (lambda g, x, a: x,),
    "log": (lambda g, x, a: g.div(1, a),),
    "abs": (lambda g, x, a: g.call("sign", a),),
    "pow": (lambda g, x, a, n: n * g.pow(a, n - 1), _power_in_exponent),
    "atan2": (
        lambda g, x, y, z: g.div(z, y * y + z * z),
        lambda g, x, y, z: -g.div(y, y * y + z * z),
    ),
    "sampled": (lambda g, x, t, k: _rate_of_sampled(g, t, k), lambda g, x, t, k: 0),
    "min": (
        lambda g, x, a, b: g.select(g.call("less_equal", a, b), 1, 0),
        lambda g, x, a, b: g.select(g.call("less_equal", a, b), 0, 1),
    ),
    "max": (
        lambda g, x, a, b: g.select(g.call("less_equal", b, a), 1, 0),
        lambda g, x, a, b: g.select(g.call("less_equal", b, a), 0, 1),
    ),
}


# -------- traversal -------------------------------------------------------------------------------------------
# Expressions -> their nodes, arguments before results, and the names of a model as symbols of one graph.
#
# Expressions -> their nodes, arguments before results; and how many operations that is.
#
# The loops run in the order of `Node.index`, never by recursion: a chain of 50 links is thousands of nodes deep.


_INDEX = attrgetter("index")


@dataclass(frozen=True)
class Count:
    """Number of operations that an evaluation takes.

    Args:
        total: at every call, once the parameters are fixed.
        hoisted: apart from those, once for given parameters.
    """

    FREE = frozenset(("symbol", "pi", "neg"))

    total: int
    hoisted: int


def order(outputs: Iterable[Scalar], given: Mapping[Node, Any] | frozenset[Node] = frozenset()) -> list[Node]:
    """Every node that the outputs need, arguments before results; what is `given` is not looked into."""
    return sorted(_needed(outputs, given), key=_INDEX)


MOST_WHOLE = 10**9  # of the whole numbers of a fraction that stands in formulas


def holds_many_digits(x: Scalar) -> bool:
    """True if a number with all its digits, as of a double, occurs in a scalar: that is a number and no formula."""
    leaves = [a for node in order((x,)) for a in node.args if isinstance(a, Fraction | int)]
    plain = [x] if isinstance(x, Fraction | int) else leaves
    return any(max(abs(Fraction(a).numerator), Fraction(a).denominator) > MOST_WHOLE for a in plain)


def _needed(outputs: Iterable[Scalar], given: Mapping[Node, Any] | frozenset[Node] = frozenset()) -> set[Node]:
    seen = {x for x in outputs if type(x) is Node}
    stack = [x for x in seen if x not in given] if given else list(seen)
    pop, push, add = stack.pop, stack.append, seen.add
    while stack:
        for a in pop().args:
            if type(a) is Node and a not in seen:
                add(a)
                if not given or a not in given:
                    push(a)
    return seen


def united(outputs: Sequence[Scalar]) -> tuple[Owner, list[Scalar]]:
    """(graph, outputs) with the constants that have no graph of their own taken into that of the others."""
    home = next((x.graph for x in outputs if type(x) is Node and x.graph is not CONSTANTS), CONSTANTS)
    return home, [home.adopted(x) for x in outputs]


def operations(outputs: Iterable[Scalar], parameters: Iterable[Node] = ()) -> Count:
    """The operations in the outputs, each sub-expression once.

    Every + - * / power and function is one; signs, symbols, pi, and what depends on exact constants only are free.
    What depends on `parameters` only is hoisted.
    """
    parameters = frozenset(parameters)
    if not parameters:
        symbol = op_bits("symbol")
        return Count(sum(1 for x in _needed(outputs) if x.op not in Count.FREE and x.ops & symbol), 0)
    constant, fixed, moving = 0, 1, 2  # what a node depends on at most: exact constants, parameters, anything
    kind: dict[Node, int] = {}
    counts = [0, 0, 0]
    for x in order(outputs):
        if x.op == "symbol":
            kind[x] = fixed if x in parameters else moving
            continue
        of = constant
        for a in x.args:
            if type(a) is Node and kind[a] > of:
                of = kind[a]
        kind[x] = of
        if x.op not in Count.FREE:
            counts[of] += 1
    return Count(total=counts[moving], hoisted=counts[fixed])


# -------- symbols ---------------------------------------------------------------------------------------------
# Names of a model -> plain symbols of one graph.
#
# q, u and a are symbols, not functions of time: the dot is a rule for printing and a total derivative for deriving.


@dataclass(frozen=True)
class Symbols:
    """The symbols of one derivation.

    Args:
        graph: the graph that owns them.
        t: time [s].
        parameters: every parameter by name, in the model's order.
        inputs: every named input by name, in the model's order.
        q: generalized coordinates, nq, named `theta`.
        u: generalized speeds, nu, named `theta'` where u is a rate, else by the speed's name.
        a: accelerations u', nu, named `theta''` or `w1'`.
        lam: multipliers of the constraint rows, k, named `lam(constraint, row)`, row from 1.
        unknowns: numbers that are requested, by name, in the model's order.
        z: states of first order, nz, by name, in the model's order.
    """

    graph: Graph
    t: Node
    parameters: dict[str, Node]
    inputs: dict[str, Node]
    q: tuple[Node, ...]
    u: tuple[Node, ...]
    a: tuple[Node, ...]
    lam: tuple[Node, ...] = ()
    unknowns: dict[str, Node] = field(default_factory=dict)
    z: tuple[Node, ...] = ()

    @property
    def x(self) -> tuple[Node, ...]:
        """The whole state, x = (q, u, z)."""
        return self.q + self.u + self.z

    @property
    def places(self) -> tuple[Node, ...]:
        """Everything that may have any value at rest, (q, z)."""
        return self.q + self.z
