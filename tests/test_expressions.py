"""The grammar of the model file: what a text means, what is refused, and where the error points."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest
from cpu_limit import cpu_limit
from each import each
from hypothesis import given, settings
from hypothesis import strategies as st

import eomgen
from eomgen.errors import ExpressionError
from eomgen.symbolic.expression.formula import Call, Expression, Reference
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import as_expression, is_name, parse, parse_equation

VALUES = {"x": Fraction(3), "y": Fraction(5), "z": Fraction(-7, 2)}


def value(text: str):
    return parse(text).evaluate(VALUES)


@each(
    "text, meaning",
    [
        ("-x^2", -9),
        ("(-x)^2", 9),
        ("2^3^2", 512),
        ("2^-x*8", 1),
        ("2**-1", Fraction(1, 2)),
        ("x - y - z", Fraction(3, 2)),
        ("x/y/2", Fraction(3, 10)),
        ("x/y*2", Fraction(6, 5)),
        ("2*-x", -6),
        ("--x", 3),
        ("+x - +y", -2),
        ("1/3", Fraction(1, 3)),
        ("4^(1/2)", 2),
        ("(1/4)^(-1/2)", 2),
        ("sqrt(9/4)", Fraction(3, 2)),
        ("abs(z) + sign(z)", Fraction(5, 2)),
        ("max(x, y, z) - min(x, y, z)", Fraction(17, 2)),
        ("sin(0) + cos(0)", 1),
    ],
)
def test_signs_bind_as_in_a_textbook(text, meaning):
    """-x^2 = -(x^2); a^b^c = a^(b^c); a - b - c = (a - b) - c; exact operands give exact values."""
    assert value(text) == meaning
    assert not isinstance(value(text), float)


@each(
    "text, exact",
    [
        ("0.0825", Fraction(33, 400)),
        ("1e-3", Fraction(1, 1000)),
        (".5", Fraction(1, 2)),
        ("2.", 2),
        ("1.5E+2", 150),
        ("1_000.5", Fraction(2001, 2)),
        ("-0.1", Fraction(-1, 10)),
    ],
)
def test_a_decimal_is_the_rational_that_it_writes(text, exact):
    """0.0825 = 33/400, no float in between."""
    assert parse(text).literal == exact


def test_greek_letters_and_names_of_other_programs_constants_are_ordinary():
    """lambda, I, E, S, N, Q, beta, gamma, θ name what the user says."""
    names = ("lambda", "I", "E", "S", "N", "Q", "beta", "gamma", "θ", "Ω_1", "e", "sin", "None", "eval")
    text = " + ".join(names)
    assert parse(text).names == frozenset(names)
    assert parse(text).evaluate(dict.fromkeys(names, 1)) == len(names)
    assert all(is_name(name) for name in names)
    assert not any(is_name(text) for text in ("2x", "x'", "a.b", "", "x²", "a b", "a-b"))


def test_primes_belong_to_the_name():
    """theta, theta' and theta'' are three names, each with its column."""
    expression = parse("theta''*2 + theta' - theta")
    assert expression.names == {"theta", "theta'", "theta''"}
    assert expression.occurrences == (("theta''", 0), ("theta'", 12), ("theta", 21))


def test_the_same_text_serves_every_scalar():
    """One tree over floats, exact numbers, the graph and sympy gives the same value."""
    import sympy

    expression = parse("sqrt(2)*x^2/3 + cos(pi/6)*x + atan2(x, 2) - 2^(1/2) + x^(1/3) + (1/2)^x + tan(x/4)")
    number = expression.evaluate({"x": 1.7, "pi": 3.141592653589793})
    symbolic = expression.evaluate({"x": sympy.Symbol("x"), "pi": sympy.pi})
    assert symbolic.has(sympy.sqrt(3)) and not symbolic.atoms(sympy.Float)
    assert float(symbolic.subs(sympy.Symbol("x"), sympy.Rational(17, 10))) == pytest.approx(number, rel=1e-14)

    from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

    graph = Graph()
    x = graph.symbol("x")
    node = expression.evaluate({"x": x, "pi": graph.pi})
    assert evaluate([node], {x: 1.7}, FLOAT)[0] == pytest.approx(number, rel=1e-14)


def test_plain_numbers_stay_exact_on_the_graph():
    """sqrt(2) and cos(pi/4) are nodes, never 1.414..."""
    graph = Graph()
    assert parse("sqrt(2)/2 - cos(pi/4)").evaluate({"pi": graph.pi}) == 0
    assert parse("(1/2)^(1/2)").evaluate({"pi": graph.pi}) is parse("1/sqrt(2)").evaluate({"pi": graph.pi})


@each(
    "text, what, column, fix",
    [
        ("2x", "no sign between '2' and 'x'", 1, "write 2*x"),
        ("a + 2 (x)", "no sign between '2' and '('", 6, "write 2*(...)"),
        ("(a)(b)", "no sign between ')' and '('", 3, "write (...)*(...)"),
        ("sin x", "no sign between 'sin' and 'x'", 4, "write sin(x)"),
        ("a*sni(x)", "unknown function 'sni'", 2, "did you mean 'sin'?"),
        ("m(x)", "unknown function 'm'", 0, "for a product write m*(...)"),
        ("", "the expression is empty", 0, ""),
        ("2 +", "a value is missing after '+'", 2, ""),
        ("2 + * x", "a value is missing after '+'", 4, ""),
        ("(a + b", "'(' is never closed", 0, ""),
        ("a + b)", "')' closes nothing", 5, ""),
        ("sin(a,b)", "sin takes one argument, not 2", 0, ""),
        ("min(a)", "min takes two or more arguments, not 1", 0, ""),
        ("atan2()", "atan2 takes two arguments, not 0", 0, ""),
        ("x'''", "more than two primes: x'''", 0, ""),
        ("t'", "'t' has no derivative", 0, "write t"),
        ("1 + nan", "'nan' is not a number that can be calculated with", 4, ""),
        ("-inf", "'inf' is not a number that can be calculated with", 1, ""),
        ("x²", "unexpected character '²'", 1, "write ^2"),
        ("x·y", "unexpected character '·'", 1, "write *"),
        ("2*arm.end", "'arm.end' is a point, not a number", 2, ""),
        ("a == b", "'=' has no place here", 2, ""),
        ("1/0", "division by zero", 1, ""),
        ("x + (2 - 2)^-1", "division by zero", 11, ""),
        ("x\x00", "unexpected character '\\x00'", 1, "not seen"),
    ],
)
def test_an_error_says_what_where_and_how_to_mend_it(text, what, column, fix):
    """STYLE 6: the culprit, its column from 0, the nearest right thing."""
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    assert (caught.value.what, caught.value.column) == (what, column)
    assert fix in caught.value.fix and bool(fix) == bool(caught.value.fix)


@each(
    "text",
    [
        "9^9^9",
        "10^(10^10)",
        "2^1000000",
        "(1/3)^99999",
        "((((((2^90)^90)^90)^90)^90)^90)",
        "x^(10^9)",
        "1e999999999",
        "1e-999999999",
        "9" * 5000,
        "(" * 5000,
        "-" * 5000 + "x",
        "2^" * 3000 + "x",
        "sin(" * 2000,
        "x+" * 20000 + "x",
        "*".join(["9^900"] * 1000),
        "+".join(f"1/{n}" for n in range(10**6, 10**6 + 900)),
    ],
)
def test_a_hostile_text_is_refused_at_once(text):
    """Length, depth, powers and digits are bounded: no text costs more than a moment."""
    with cpu_limit(5), pytest.raises(ExpressionError):
        parse(text).evaluate({"x": 3})


def test_a_power_beyond_all_size_costs_no_time():
    """9^9^9 has 369 million digits; it is refused by the size of its factors."""
    with cpu_limit(5):
        for _ in range(20):
            with pytest.raises(ExpressionError, match="too large"):
                parse("9^9^9")


def test_what_has_no_value_says_where():
    """1/(x - 3) at x = 3, sqrt of a negative number, a broken power of one: an error with its column."""
    for text, column in (
        ("1/(x - 3)", 1),
        ("2*sqrt(z)", 2),
        ("z^(1/2)", 1),
        ("log(0)", 0),
        ("10^(x*y*z*-20)*1.0^x", 2),
    ):
        with pytest.raises(ExpressionError) as caught:
            value(text)
        assert caught.value.column == column
    with pytest.raises(ExpressionError):
        parse("z^(1/3)").evaluate({"z": -2.0})


def test_an_unknown_name_is_reported_with_the_nearest_one():
    """The caret stands under the name, the fix offers the one that was meant."""
    with pytest.raises(ExpressionError) as caught:
        parse("2*lenght + 1").evaluate({"length": 1, "mass": 2})
    assert (caught.value.what, caught.value.column, caught.value.length) == ("unknown name 'lenght'", 2, 6)
    assert caught.value.fix == "did you mean 'length'?"


def test_a_flat_sum_of_a_thousand_terms_needs_no_depth():
    """Sums and products are loops: only nesting is bounded."""
    assert parse("+".join(["x"] * 1000)).evaluate({"x": 2}) == 2000
    assert parse("*".join(["x"] * 1000)).evaluate({"x": -1}) == 1
    assert parse("(" * 60 + "x" + ")" * 60).evaluate({"x": 2}) == 2


def test_two_writings_of_one_tree_are_equal():
    """Equality and hash are of the tree, not of blanks and columns."""
    assert parse("a+2*b") == parse(" a + 2 * b ") and hash(parse("a+2*b")) == hash(parse(" a + 2 * b "))
    assert parse("a+b") != parse("b+a")
    assert parse("0.1") == Expression.number(Fraction(1, 10)) == as_expression(0.1)
    assert parse(" a + b ").text == "a + b"


def test_numbers_of_python_become_exact():
    """A float means the decimal that it is written as: 0.1 is 1/10 and not 3602879701896397/2^55."""
    decimals = ((0.1, Fraction(1, 10)), (-2.5e-3, Fraction(-1, 400)), (Decimal("0.30"), Fraction(3, 10)))
    for number, exact in ((3, 3), *decimals, (Fraction(2, 6), Fraction(1, 3)), ("1/4", None)):
        assert as_expression(number).literal == exact
    assert as_expression("1/4").evaluate({}) == Fraction(1, 4)
    for wrong in (float("nan"), float("inf"), Decimal("nan"), True, None, [1], 10**400, Fraction(1, 7**9000)):
        with pytest.raises(ExpressionError):
            as_expression(wrong)


def test_outputs_may_call_functions_of_the_model():
    """Dotted names, constraints and members are references; the rest of an argument is an expression."""
    expression = parse("2*speed(arm.end)^2 - max(tension(T, n1-n2), 0) + frequency(1)", references=True)
    assert expression.calls == (
        Call("speed", (Reference("arm.end"),)),
        Call("tension", (Reference("T"), Reference("n1-n2"))),
        Call("frequency", (Expression.number(1),)),
    )
    assert [(c.column, [a.column for a in c.args if isinstance(a, Reference)]) for c in expression.calls] == [
        (2, [8]),
        (25, [33, 36]),
        (49, []),
    ]
    values = {"speed": 3, "tension": 7, "frequency": Fraction(1, 2)}
    assert expression.evaluate({}, call=lambda call: values[call.name]) == 2 * 9 - 7 + Fraction(1, 2)


def test_a_function_is_known_by_its_parenthesis():
    """`x(` is the function, `x` the coordinate."""
    expression = parse("x(A) - x", references=True)
    assert expression.names == {"x"}
    assert expression.evaluate({"x": 1}, call=lambda call: 5) == 4
    assert parse("kinetic_energy()", references=True).calls == (Call("kinetic_energy", ()),)


def test_expressions_inside_arguments_keep_their_columns():
    """The caret of a name inside an argument stands in the whole text."""
    expression = parse("f(2*a + theta', g(b+c))", references=True)
    assert expression.occurrences == (("a", 4), ("theta'", 8), ("b", 18), ("c", 20))
    assert expression.names == {"a", "theta'", "b", "c"}


def test_a_call_has_no_place_in_a_plain_expression():
    """Outside the outputs a call is an error that says so."""
    with pytest.raises(ExpressionError, match="can only stand in"):
        parse("speed(A)", references=True).evaluate({})
    with pytest.raises(ExpressionError, match="unknown function 'speed'"):
        parse("speed(A)")


def test_an_equation_has_two_sides():
    """left = right, once."""
    left, right = parse_equation("reaction_n(wall) = pi/2")
    assert left.calls == (Call("reaction_n", (Reference("wall"),)),) and right == parse("pi/2")
    for text in ("theta", "a = b = c", "= 2", "a =", "a == b", ""):
        with pytest.raises(ExpressionError):
            parse_equation(text)


def test_scaling_keeps_the_columns_of_the_source():
    """factor * pi^n * text: 90 deg is pi/2, and the caret still finds the names."""
    scaled = parse("a + b").scaled(Fraction(1, 180), 1)
    assert scaled.evaluate({"a": 90, "b": 90, "pi": 3.0}) == 3.0
    assert scaled.occurrences == (("a", 0), ("b", 4))
    assert parse(scaled.text).evaluate({"a": 9, "b": 9, "pi": 2.0}) == scaled.evaluate({"a": 9, "b": 9, "pi": 2.0})
    assert Expression.number(40).scaled(Fraction(1, 100)) == parse("0.4")


@settings(max_examples=300, deadline=None)
@given(st.text(st.sampled_from("abx'12.0e+-*/^()=, sin_min.θ²nan"), max_size=40), st.booleans())
def test_any_text_is_an_expression_or_an_expression_error(text, references):
    """Nothing else ever comes out, and the column lies in the text."""
    try:
        parse(text, references=references).evaluate({"a": 2, "b": 3, "x": 0.5, "θ": 1}, call=lambda call: 1)
    except ExpressionError as error:
        assert 0 <= error.column <= max(0, len(text))


def test_an_arm_of_250_expressions_is_read_in_a_moment():
    """arm7.toml holds about 250 short expressions: 20 ms of CPU, and at most 5 s."""
    texts = [
        f"{a}{n}*{b}/2 - {n}.25*pi" for n in range(50) for a, b in (("I", "m"), ("c", "l"), ("q", "x"), ("a", "b"))
    ]
    with cpu_limit(5):
        for text in texts:
            parse(text)


@each(
    "text, value",
    [
        ("a = x + 1; a^2", 9),
        ("a = x; b = a*a; c = b - a; c*b/a", 4),
        ("2*(a = x; a + 1) - (b = 3; b)", 3),
        ("a = x; -a^2 + max(a, 1, 3*a)", 2),
        ("a = 5; x", 2),
        ("x = 3; x", 3),
    ],
)
def test_parts_with_names_stand_for_what_they_are(text, value):
    """a = ...; b = ...; the value: as if each stood written out; no name of a part is a name of the formula."""
    expression = parse(text)
    assert expression.evaluate({"x": 2, "pi": 3}) == value
    assert expression.names <= {"x"} and set(expression.parts) <= {"a", "b", "c", "x"}
    assert (expression * 3 + expression).evaluate({"x": 2, "pi": 3}) == 4 * value
    assert parse(f"1 + ({text})").evaluate({"x": 2, "pi": 3}) == value + 1
    assert parse((expression.scaled(Fraction(1, 2))).text).evaluate({"x": 2, "pi": 3}) == Fraction(value, 2)


@each(
    "text, what",
    [
        ("a = 1; a = 2; a", "'a' cannot be the name of a part"),
        ("sin = 1; sin", "'sin' cannot be the name of a part"),
        ("a' = 1; a'", "cannot be the name of a part"),
        ("a = 1 b; a", "no sign between|has no end"),
        ("a = 1;", "a value is missing"),
        ("a = 1", "'=' has no place here"),
        ("b; a = 1", "';' has no place here"),
        ("(a = 1; a) + a; 2", "';' has no place here"),
        ("a = 1/0; x", "division by zero|no value|1/0|zero"),
        (f"a = {'x+' * 6000}x; a", "a part of the expression is longer than 10000"),
        ("a = x;" * 40_000 + "a", "longer than 200000"),
    ],
)
def test_parts_that_are_none_are_refused_where_they_stand(text, what):
    with pytest.raises(ExpressionError, match=what):
        parse(text)


def test_a_part_is_seen_outside_of_its_parentheses_by_nobody():
    """(a = 1; a) + a: the second is a name of the model."""
    assert parse("(a = 1; a) + a; 2".partition(";")[0] + "; a) + a").names == {"a"}


def test_parts_have_dimensions_and_no_name_of_the_model(tmp_path):
    """m g (l = ...): of N*m; an error in a part is told, a part that is called like a parameter is refused."""
    text = """eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 3, unit = "N/m" }
[coordinates]
x = { start = 0.1, unit = "m" }
[bodies.b]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "VALUE" }
"""
    good = eomgen.loads(text.replace("VALUE", "s = -k*x; r = s/2; r + r"))
    plain = eomgen.loads(text.replace("VALUE", "-k*x"))
    rhs = [eomgen.derive(model).rhs("numpy")(0.0, [0.2, 0.0], [2.0, 3.0], [])[1] for model in (good, plain)]
    assert rhs[0] == rhs[1] == pytest.approx(-0.3)
    with pytest.raises(eomgen.ModelError, match=r"\[N\]|kg"):
        eomgen.loads(text.replace("VALUE", "s = -k*x; s + m"))
    with pytest.raises(eomgen.ModelError, match="is called 'm', like a parameter"):
        eomgen.loads(text.replace("VALUE", "m = -k*x; m"))
