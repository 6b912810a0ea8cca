"""Text that is no formula, or none that is smooth and real: one clear InputError."""

import contextlib
import warnings

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st
from sympy.core.cache import clear_cache

from tests.examples import drawn
from verify.algebra import formula
from verify.algebra.formula import parse
from verify.errors import InputError

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


@pytest.mark.parametrize("error", [OverflowError, ValueError, TypeError, RecursionError])
@pytest.mark.parametrize("text", ["tan(q/3)", "(p + 1)*q", "(q + 1)/p", "(q + 1)**(1/3)"])
def test_where_sympy_fails_the_line_says_so(
    text: str, error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error("int too large to convert to float")

    clear_cache()  # sympy remembers powers that another test has made
    monkeypatch.setattr(formula, "function", lambda _: fail)
    for name in ("_eval_power", "__mul__", "__truediv__"):
        monkeypatch.setattr(sympy.Add, name, fail)
    with pytest.raises(InputError, match="cannot be handled exactly"):
        parse(text)


@given(text=st.text(alphabet="pq019.e+-*/^()sincoxlgqrt ,_[]:=#'\"\\\n", max_size=40))
@drawn(200)
def test_any_text_is_a_formula_or_an_input_error(text: str) -> None:
    with contextlib.suppress(InputError):
        assert isinstance(parse(text), sympy.Expr)
