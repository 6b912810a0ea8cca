"""Text to exact expression: what is read, and that all else is one clear InputError."""

import contextlib
import warnings

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st
from sympy.core.cache import clear_cache

from tests.examples import drawn
from tests.helpers.sampled.formulas import NAMES, evaluate, formulas, is_real, plain, points
from verify.algebra.embedding import embed
from verify.algebra.formula import FUNCTIONS, _Reader, parse, symbol, to_text
from verify.algebra.monomials import Monomials
from verify.errors import InputError

P, Q = symbol("p"), symbol("q")
HALF, THIRD = sympy.Rational(1, 2), sympy.Rational(1, 3)

READ = {
    "decimal": ("0.1", sympy.Rational(1, 10)),
    "decimal beyond a float": (
        "0.1234567890123456789",
        sympy.Rational(1234567890123456789, 10**19),
    ),
    "scientific": ("1e-3", sympy.Rational(1, 1000)),
    "capital exponent": ("2E2", sympy.Integer(200)),
    "no leading zero": (".5", HALF),
    "no trailing digits": ("5.", sympy.Integer(5)),
    "quotient": ("1/3", THIRD),
    "caret": ("q^2", Q**2),
    "caret to a negative power": ("q^-2", Q**-2),
    "power before sign": ("-q**2", -(Q**2)),
    "power before sign, constant": ("-2**2", sympy.Integer(-4)),
    "power from the right": ("2**3**2", sympy.Integer(512)),
    "caret from the right": ("2^3^2", sympy.Integer(512)),
    "minus from the left": ("p - q - 1", P - Q - 1),
    "quotient from the left": ("p/q/2", P / Q / 2),
    "quotient before product": ("1/2*q", Q / 2),
    "signs in a row": ("p*-+-q", P * Q),
    "exponent of an exact sum": ("q**(1/2 + 1/3)", Q ** sympy.Rational(5, 6)),
    "root of a square": ("4**(1/2)", sympy.Integer(2)),
    "square of a root": ("sqrt(q)**2", Q),
    "root of a fourth power": ("sqrt(q**4)", Q**2),
    "root of an odd power": ("(q**3)**(1/3)", (Q**3) ** THIRD),
    "root of a product": ("(p*q)**(1/3)", (P * Q) ** THIRD),
    "exponential of a logarithm": ("exp(log(q))", Q),
    "power zero": ("q**0", sympy.Integer(1)),
    "pi": ("cos(pi)", sympy.Integer(-1)),
    "nested": ("sin(cos(exp(q)))", sympy.sin(sympy.cos(sympy.exp(Q)))),
    "space and new lines": (" p **2\n\t+ q ", P**2 + Q),
    "parameter": ("delta*q", symbol("delta") * Q),
    "E is a parameter": ("E*q", symbol("E") * Q),
    "I is a parameter": ("I*q", symbol("I") * Q),
    "S and N are parameters": ("S*N", symbol("S") * symbol("N")),
    "Python's lambda_ is a parameter": ("lambda_", symbol("lambda_")),
}


@pytest.mark.parametrize(("text", "expected"), READ.values(), ids=READ.keys())
def test_a_formula_is_read_exactly(text: str, expected: sympy.Expr) -> None:
    assert parse(text) == expected


def test_a_symbol_is_real_so_that_a_hidden_modulus_is_seen() -> None:
    assert parse("q").is_real


def test_names_may_allow_time_and_the_step() -> None:
    assert parse("t*h", ("t", "h")) == symbol("t") * symbol("h")


REFUSED = {
    "empty": ("", "empty"),
    "blank": (" \n\t ", "empty"),
    "long": ("q+" * 4000 + "q", "longer than"),
    "not ASCII": ("δ*q", "ASCII"),
    "digits of another script": ("٣*q", "ASCII"),
    "null byte": ("q\x00", "not a formula"),
    "null bytes alone": ("\x00\x00", "not a formula"),
    "two formulas": ("p; q", "not a formula"),
    "unbalanced": ("(q", "not a formula"),
    "operator missing": ("2q", "not a formula"),
    "operand missing": ("q+", "not a formula"),
    "two carets": ("q^^2", "not a formula"),
    "product sign and caret": ("q*^2", "not a formula"),
    "deep parentheses": ("(" * 3900, "not a formula"),
    "balanced deep parentheses": ("(" * 1900 + "q" + ")" * 1900, ""),
    "deep signs": ("-" * 3900 + "q", ""),
    "deep functions": ("sin(" * 150 + "q" + ")" * 150, ""),
    "deep powers": ("q" + "**q" * 1300, "nested"),
    "deep calls": ("q" + "()" * 1900, ""),
    "deep attributes": ("q" + ".a" * 1900, "not allowed"),
    "unknown function": ("foo(q)", "unknown function 'foo'"),
    "product sign missing": ("q(p + 1)", "at column 1: q is no function; write q*(p + 1)"),
    "number called": ("2(q)", "write 2*(q)"),
    "function by attribute": ("math.sin(q)", "unknown function"),
    "import": ("__import__('os')", "unknown function"),
    "eval": ("eval('1')", "unknown function"),
    "absolute value": ("abs(q)", "not smooth"),
    "sign": ("sign(q)", "not smooth"),
    "floor": ("floor(q)", "not smooth"),
    "maximum": ("max(p, q)", "not smooth"),
    "root of a square": ("sqrt(q**2)", "not smooth"),
    "root of a square by power": ("(q**2)**(1/2)", "not smooth"),
    "root of a square, cubed": ("(q**2)**(3/2)", "not smooth"),
    "fourth root of a square": ("(q**2)**(1/4)", "not smooth"),
    "root of a square by logarithm": ("exp(log(q**2)/2)", "not smooth"),
    "root of a square in a product": ("sqrt((p - q)**2*(p + 1))", "not smooth"),
    "quotient by zero": ("1/0", "zero"),
    "quotient by a hidden zero": ("1/(q - q)", "zero"),
    "zero over zero": ("0/0", "zero"),
    "zero to a negative power": ("0**-1", "zero"),
    "zero to the power zero": ("0**0", "0**0"),
    "logarithm of zero": ("log(q - q)", "zero"),
    "tangent at its pole": ("tan(pi/2)", "zero"),
    "tangent at a hidden pole": ("q + 0*tan(3*pi/2)", "zero"),
    "quotient by cos at its zero": ("1/cos(pi/2)", "zero"),
    "infinite literal": ("1e999999", "exponent"),
    "large exponent of a decimal": ("1e1001", "exponent"),
    "tower": ("10**10**10", "exponent"),
    "huge power": ("q**65", "exponent"),
    "huge negative power": ("q**-65", "exponent"),
    "huge root": ("q**(1/65)", "exponent"),
    "huge power in steps": ("(q**64)**64", "exponent"),
    "huge number": ("(2**64)**64", "bits"),
    "huge product": ("1e999*1e999", "bits"),
    "root of a huge number": ("sqrt(3e999)", "root"),
    "root of a huge number in a product": ("(3e700*q)**(1/2)", "root"),
    "root of a root of a huge number": ("((1e300 - 64)**(-5/3))**(1/64)", "root"),
    "root of the inverse of a huge number": ("(1/(1e1000 - 64))**(1/64)", "root"),
    "root of a constant out of reach": ("cosh(pi**64)**(1/2)", "too large"),
    "variable exponent": ("2**q", "exponent"),
    "irrational exponent": ("q**pi", "exponent"),
    "root of a negative constant": ("sqrt(-2)", "not real"),
    "logarithm of a negative constant": ("log(1 - 2)", "not real"),
    "logarithm of a negative cosine": ("log(cos(3))", "not real"),
    "attribute": ("q.real", "not allowed"),
    "dunder attribute": ("().__class__", "not allowed"),
    "subscript": ("q[0]", "not allowed"),
    "lambda": ("lambda: q", "not allowed"),
    "list comprehension": ("[q for q in p]", "not allowed"),
    "generator": ("sin(q for q in p)", "not allowed"),
    "list": ("[q]", "not allowed"),
    "tuple": ("p, q", "not allowed"),
    "dictionary": ("{p: q}", "not allowed"),
    "conditional": ("p if q else 1", "not allowed"),
    "walrus": ("(p := q)", "not allowed"),
    "yield": ("(yield q)", ""),
    "f-string": ("f'{q}'", "not allowed"),
    "string": ("'q'", "not a number"),
    "ellipsis": ("...", "not a number"),
    "comparison": ("p < q", "not allowed"),
    "equation": ("p = q", "not a formula"),
    "boolean operation": ("p and q", "not allowed"),
    "not": ("not q", "not allowed"),
    "inversion": ("~q", "not allowed"),
    "true": ("True", "not a number"),
    "none": ("None", "not a number"),
    "complex": ("1j*q", "not a number"),
    "hexadecimal": ("0x10", ""),
    "octal": ("0o17", ""),
    "digit grouping": ("1_000", ""),
    "remainder": ("p % q", "operator"),
    "floor division": ("p // q", "operator"),
    "matrix product": ("p @ q", "operator"),
    "two arguments": ("sin(p, q)", "one argument"),
    "no argument": ("sin()", "one argument"),
    "keyword argument": ("sin(x=q)", "one argument"),
    "star argument": ("sin(*q)", "one argument"),
    "double star argument": ("sin(**q)", "one argument"),
    "function without argument list": ("sin + q", "sin"),
    "step": ("q*h", "'h'"),
    "leading underscore": ("_q", "parameter"),
    "dunder name": ("__builtins__", "parameter"),
    "long name": ("a" * 33, "parameter"),
    "not a number": ("nan", ""),
    "infinity": ("q + inf", ""),
    "comment": ("p**2/2 # + q**2/2", ""),
    "comment before a new line": ("p**2/2 # kinetic\n + q**2/2", ""),
    "real root of no real number": ("(-1)**(1/3)", ""),
    "root of a negative cosine": ("q*sqrt(cos(3))", ""),
    "root of a negative root": ("sqrt(sqrt(2) - 2)", ""),
    "root of a negative function": ("sqrt(-1 - q**2)", ""),
    "logarithm of a negative function": ("log(-exp(q))", ""),
    "logarithm of what is never positive": ("log(-q**2)", ""),
}


def one_line(error: InputError, source: str) -> str:
    """The error's message, held to its contract: short, one line, names the input and its value."""
    message = str(error)
    assert isinstance(error.value, str)
    assert message.isprintable(), "control characters, or more than one line"
    assert len(message) <= 320
    assert message.startswith(f"{source}=")
    assert " ".join(error.value.replace("\x00", " ").split())[:30] in message.replace("\x00", " ")
    assert error.problem
    return message


@pytest.mark.parametrize(("text", "fragment"), REFUSED.values(), ids=REFUSED.keys())
def test_bad_input_is_one_clear_line(text: str, fragment: str) -> None:
    with pytest.raises(InputError) as info:
        parse(text, source="hamiltonian")
    assert fragment in one_line(info.value, info.value.name)


@pytest.mark.parametrize("text", ["1if q else p", "0xfor q in p", "'\\d'"])
def test_python_does_not_warn_beside_the_error(text: str) -> None:
    # Where a warning is an error Python says it by a SyntaxError, so it is recorded instead.
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with pytest.raises(InputError):
            parse(text)
    assert not caught, "it would be a second line on standard error"


@pytest.mark.parametrize("text", ["x", "P", "nan", "inf", "delta2", "sin", "abs", "True_"])
def test_a_name_that_is_not_given_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="allowed: delta, p, q"):
        parse(f"q + {text}", ("p", "q", "delta"))


@pytest.mark.parametrize("value", [None, 1, 0.5, b"q", ["q"], sympy.Symbol("q")], ids=repr)
def test_what_is_not_text_is_refused(value: object) -> None:
    with pytest.raises(InputError):
        parse(value)  # type: ignore[arg-type]


def test_an_escape_sequence_does_not_reach_the_terminal() -> None:
    with pytest.raises(InputError) as info:
        parse("q + \x1b[31m")
    assert str(info.value).isprintable()


def test_a_long_flat_sum_is_not_deeply_nested() -> None:
    text = " + ".join(f"q**{n % 60 + 1}/{n + 1}" for n in range(100))
    assert parse(text) == plain(text)


@pytest.mark.parametrize("error", [OverflowError, ValueError, TypeError, RecursionError])
@pytest.mark.parametrize("text", ["tan(q/3)", "(p + 1)*q", "(q + 1)/p", "(q + 1)**(1/3)"])
def test_where_sympy_fails_the_line_says_so(
    text: str, error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error("int too large to convert to float")

    clear_cache()  # sympy remembers powers that another test has made
    monkeypatch.setitem(FUNCTIONS, "tan", fail)
    for name in ("_eval_power", "__mul__", "__truediv__"):
        monkeypatch.setattr(sympy.Add, name, fail)
    with pytest.raises(InputError, match="cannot be handled exactly"):
        parse(text)


@given(text=formulas(), point=points("p", "q", "a"))
@drawn(80)
def test_a_formula_has_the_value_that_sympy_gives_it(text: str, point: dict) -> None:
    try:
        ours = parse(text)
    except InputError:
        return
    expected = evaluate(plain(text), point)
    assert not is_real(expected) or abs(evaluate(ours, point) - expected) <= 1e-30 * abs(expected)


@given(text=formulas())
@drawn(80)
def test_what_is_printed_reads_back_as_the_same_expression(text: str) -> None:
    try:
        expression = parse(text)
    except InputError:
        return
    again = parse(to_text(expression))
    if again == expression:
        return
    # sympy spreads a minus sign or a factor over a sum as it builds: then equal, not the same.
    ring, (gap,) = embed([again - expression], NAMES)
    assert ring.decide(gap).zero is True


@given(text=st.text(alphabet="pq019.e+-*/^()sincoxlgqrt ,_[]:=#'\"\\\n", max_size=40))
@drawn(200)
def test_any_text_is_a_formula_or_an_input_error(text: str) -> None:
    with contextlib.suppress(InputError):
        assert isinstance(parse(text), sympy.Expr)


# -- monomials ------------------------------------------------------------------------------------

_numbers = st.sampled_from(
    ["0", "1", "2", "13/4", "(-3/5)", "0.25", "1e-3", "(2/0)", "0x10", "1_0", "(1/3/2)", "007",
     "99999999999999999999999", "(-(-2))", "2**-1", "10**3", "1j"]
)  # fmt: skip
_names = st.sampled_from(["p", "q", "p", "q", "a", "b", "pi", "t", "h", "E", "inf", "sin"])
_powers = st.sampled_from(["0", "1", "2", "6", "40", "70", "-1", "(1/2)", "2.0"])
_factors = st.one_of(
    _numbers,
    _names,
    st.builds("{}**{}".format, _names, _powers),
    st.builds("sin({})".format, _names),
    st.builds("({}-{})".format, _numbers, _names),
)
_products = st.builds(
    "{}{}".format,
    st.sampled_from(["", "-", "+", "--"]),
    st.lists(_factors, min_size=1, max_size=4).map("*".join)
    | st.lists(_factors, min_size=1, max_size=3).map("/".join),
)


@drawn(300)
@given(st.lists(st.tuples(st.sampled_from("+-"), _products), min_size=1, max_size=5))
def test_a_sum_of_monomials_is_what_it_is_when_read_node_by_node(
    terms: list[tuple[str, str]],
) -> None:
    text = "".join(sign + term for sign, term in terms)
    with pytest.MonkeyPatch.context() as ordinary:
        ordinary.setattr(Monomials, "take", lambda *_: False)
        expected = read_or_refused(text)
    found = read_or_refused(text)
    assert found == expected
    assert str(found) == str(expected)  # 2 + 1/2 kept apart would have been equal in value alone


def read_or_refused(text: str) -> sympy.Expr | str:
    try:
        return parse(text)
    except InputError as error:
        return str(error)


@pytest.mark.parametrize("text", ["p + q*2/3", "-p**2/2 - 3*q", "p**3*q**2*4 + 1"])
def test_sums_of_monomials_are_read_at_once(text: str) -> None:
    with pytest.MonkeyPatch.context() as watched:
        watched.setattr(_Reader, "power", None)
        assert parse(text) == parse(text)


@pytest.mark.parametrize(
    ("text", "is_"),
    [
        ("3*sqrt(-2*p)*sqrt(-2*p) + p", "-5*p"),
        ("1 - 2*sqrt(-p)*sqrt(-p)", "1 + 2*p"),
        ("q*sqrt(-3*p)*sqrt(-3*p)*2 - q*p", "-7*p*q"),
        ("2*(-p)**(1/3)*(-p)**(2/3) - p", "-3*p"),
    ],
)
def test_products_of_roots_that_sympy_leaves_nested_are_what_they_are(text: str, is_: str) -> None:
    """Of √(−2p)·√(−2p) sympy makes a product in a product, or one with several numbers."""
    assert parse(text) == parse(is_)
    ring, (x, y) = embed([parse(text), parse(is_)], ["p", "q"])
    assert ring.decide(x - y).zero is True


def test_a_product_with_several_numbers_is_their_product() -> None:
    p = symbol("p")
    nested = sympy.Add(p, sympy.Mul(6, -1, p, evaluate=False), evaluate=False)
    ring, (x,) = embed([nested], ["p"])
    assert ring.text(x) == "-5*p"
