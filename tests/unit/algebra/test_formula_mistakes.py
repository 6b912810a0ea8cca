"""What a refused formula is told: where the mistake stands, and what to write, which is right."""

import pytest
import sympy

from verify.algebra.formula import parse, symbol
from verify.algebra.node_mistakes import _REPLACEMENTS
from verify.algebra.text_mistakes import format_place, index_of
from verify.errors import InputError

# What is wrong, where, what to write; and the whole formula with that, which is read.
TOLD = {
    "2q": ("column 1: write 2*q for 2q", "2*q"),
    "p**2/2 + 2q": ("column 10: write 2*q for 2q", "p**2/2 + 2*q"),
    "p^2/2 + 2q": ("column 9: write 2*q", "p^2/2 + 2*q"),
    "  p  +  2 q": ("column 9: write 2*q for 2 q", "p + 2*q"),
    "p\n + 2q": ("line 2, column 4: write 2*q", "p\n + 2*q"),
    "1/2 p**2": ("column 3: write 2*p for 2 p", "1/2*p**2"),
    "q q": ("column 1: write q*q", "q*q"),
    "(p)(q)": ("column 1: p is no function; write p*(q)", "p*(q)"),
    "(p + 1)(q)": ("(p + 1) is no function; write (p + 1)*(q)", "(p + 1)*(q)"),
    "p**2 + p*p(1)": ("column 10: p is no function; write p*(1)", "p**2 + p*(1)"),
    "(q**2/2": ("column 1: this ( is not closed", "(q**2/2)"),
    "sin(q": ("column 4: this ( is not closed; write )", "sin(q)"),
    "q**2/2)": ("column 7: this ) closes nothing", "q**2/2"),
    "(q]": ("column 1: this ( is closed by ]; write ( )", "(q)"),
    "sin[q]": ("column 1: 'sin[q]' is not allowed; write sin(q)", "sin(q)"),
    "p[0]": ("one degree of freedom is covered; write p", "p"),
    "{q}": ("write ( ) for brackets", "(q)"),
    "q + ()": ("column 5: '()' is not allowed; something is missing", "q"),
    "lambda*q": ("column 1: lambda is a reserved word of Python; write another name", "lambda_*q"),
    "ω*q": ("column 1: ω (greek small letter omega) is outside ASCII; write omega", "omega*q"),
    "q + δ": ("column 5: δ (greek small letter delta)", "q + delta"),
    "λ*q": ("write lambda_", "lambda_*q"),
    "Ω*q": ("write Omega", "Omega*q"),
    "ϕ*q": ("write phi", "phi*q"),
    "ς*q": ("write sigma", "sigma*q"),
    "𝜔*q": ("write omega", "omega*q"),
    "𝑞": ("write q", "q"),
    "µ*q": ("write mu", "mu*q"),
    "ħ*q": ("write hbar", "hbar*q"),
    "cos(π*q)": ("write pi", "cos(pi*q)"),
    "p²": ("column 2: ² (superscript two) is outside ASCII; write **2", "p**2"),
    "p⁻¹²": ("write **-12", "p**-12"),
    "½*q": ("write (1/2)", "(1/2)*q"),
    "2·q": ("· (middle dot) is outside ASCII; write *", "2*q"),
    "2×q": ("write *", "2*q"),
    "q÷2": ("write /", "q/2"),
    "p − q": ("column 3: − (minus sign) is outside ASCII; write -", "p - q"),
    "p – q": ("– (en dash)", "p - q"),
    "“q”": ("leave it out", "q"),
    "p\u00a0+ q": ("U+00A0 (no-break space)", "p + q"),
    "\ufeffq": ("U+FEFF (zero width no-break space)", "q"),
    "q + \u200bp": ("U+200B (zero width space)", "q + p"),
    "√q": ("√ (square root) is outside ASCII; write sqrt(…)", "sqrt(q)"),
    "q\x00": ("U+0000 at column 2 is not allowed; leave it out", "q"),
    "np.cos(q)": ("column 1: unknown function 'np.cos'; write cos(q)", "cos(q)"),
    "math.cos(2*q)": ("write cos(2*q)", "cos(2*q)"),
    "tah(q)": ("unknown function 'tah'; is tanh meant? allowed: asinh, atan", "tanh(q)"),
    "COS(q)": ("is cos meant?", "cos(q)"),
    "V(q)": ("unknown function 'V'; allowed: asinh, atan, cos", "q"),
    "ln(q)": ("write log(q)", "log(q)"),
    "pow(q, 2)": ("write (q**2)", "(q**2)"),
    "log(q, 10)": ("log takes one argument; write (log(q)/log(10))", "(log(q)/log(10))"),
    "cos q": ("column 1: cos takes its argument in parentheses; write cos(q)", "cos(q)"),
    "p + exp q": ("column 5: exp takes", "p + exp(q)"),
    "cos^2(q)": ("'cos' is a function; write cos(q), and cos(q)**2", "cos(q)**2"),
    "e**q": ("column 4: exponent q must be a rational number; write exp(q)", "exp(q)"),
    "e^(-q)": ("write exp(-q)", "exp(-q)"),
    "q**n": ("write a number, or exp(n*log(q))", "exp(n*log(q))"),
    "2**(q + 1)": ("exp((q + 1)*log(2))", "exp((q + 1)*log(2))"),
    "2e^q": ("column 1: write exponents as 2e-3, and e to a power as 2*exp(…)", "2*exp(q)"),
    "1d-3*q": ("column 1: write 1e-3 for 1d-3", "1e-3*q"),
    "0,5*q": ("column 2: '0,5*q' is not allowed; write a decimal with a point", "0.5*q"),
    "2.5.3*q": ("2.5.3 is no number", "2.53*q"),
    "007*q": ("write 7 for 007", "7*q"),
    "1j*q": ("'1j' is not a number; H is real", "q"),
    "|q|": ("column 1: |…| is an absolute value, which is not smooth", "sqrt(q**2 + 1)"),
    "abs(q)": ("abs is not smooth, and H must be; allowed: asinh, atan", "sqrt(q**2 + 1)"),
    "q!": ("column 2: ! is not allowed; write a factorial", "q"),
    "p'**2": ("column 2: a prime is no part of a name", "p**2"),
    "'q'": ("leave out the quotation marks", "q"),
    'q + "p': ("column 5: leave out the quotation mark", "q + p"),
    "H = q": ("column 3: a formula has no =; write its right side alone", "q"),
    "H(p, q) = q": ("column 9: a formula has no =", "q"),
    "q < 0": ("column 1: 'q < 0' is not allowed; a formula has no cases", "q"),
    "q if q else p": ("has no cases", "q"),
    "if(q, p)": ("column 1: a formula has no cases", "q"),
    "p; q": ("column 2: one formula is wanted; leave out the ;", "p"),
    "$q$": ("column 1: leave out the $", "q"),
    "q # kinetic": ("column 3: a formula has no comment; leave out the #", "q"),
    "q // kinetic": ("column 3: an operator is not allowed; write / for a quotient; //", "q"),
    "q % 2": ("column 3: an operator is not allowed; % is a remainder", "q/2"),
    "p & q": ("column 3: an operator is not allowed; write *", "p*q"),
    "\\omega*q": ("column 1: this is LaTeX; write omega without the backslash", "omega*q"),
    "\\frac{p}{2}": ("column 1: this is LaTeX; write (a)/(b) for \\frac{a}{b}", "(p)/(2)"),
    "q +": ("column 3: something is missing after +", "q"),
    "* q": ("column 1: something is missing before *", "q"),
    "p + * q": ("column 3: something is missing in + *", "p + q"),
    "h*q": ("column 1: 'h' stands for something else here: the step size", "q"),
    "q + inf": ("column 5: 'inf' stands for something else here", "q"),
    "p + 1/(q - q)": ("column 8: division by zero", "1/q"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "told"), TOLD.items(), ids=[ascii(text) for text in TOLD])
def test_a_mistake_is_named_with_its_place_and_what_to_write(
    text: str, told: tuple[str, str]
) -> None:
    fragment, instead = told
    with pytest.raises(InputError) as info:
        parse(text)
    assert fragment in info.value.problem
    assert "at " in info.value.problem
    assert len(str(info.value)) <= 320
    parse(instead)


# As sympy knows those whose names are none of its own.
_SYMPY = {
    "arsinh": sympy.asinh, "arsh": sympy.asinh,
    "tg": sympy.tan, "atg": sympy.atan, "sh": sympy.sinh, "ch": sympy.cosh, "th": sympy.tanh,
    "cosec": sympy.csc, "ctg": sympy.cot, "square": lambda x: x**2,
    "expm1": lambda x: sympy.exp(x) - 1,
    "log10": lambda x: sympy.log(x, 10), "log2": lambda x: sympy.log(x, 2),
    "log1p": lambda x: sympy.log(1 + x),
    "hypot": lambda x, y: sympy.sqrt(x**2 + y**2), "power": sympy.Pow, "pow": sympy.Pow,
}  # fmt: skip
_OF_TWO = ("hypot", "log", "pow", "power")


@pytest.mark.parametrize("name", [*_REPLACEMENTS, "arctan", "arcsin"])
def test_what_is_written_instead_is_the_same_function(name: str) -> None:
    """Of a sum, and squared, so that missing parentheses would show."""
    more = (3,) if name in _OF_TWO else ()
    with pytest.raises(InputError) as info:
        parse(f"{name}(q - 1{', 3' if more else ''})")
    remedy = info.value.problem.partition("; write ")[2]
    x = sympy.Rational(7 if name == "acosh" else 2, 5)
    expected = (_SYMPY.get(name) or getattr(sympy, name.replace("arc", "a")))(x, *more) ** 2
    assert abs(sympy.N(parse(f"{remedy}**2").subs(symbol("q"), 1 + x) - expected, 30)) < 1e-25


def test_a_place_is_a_column_and_a_line_where_there_are_several() -> None:
    assert format_place("abc", 0) == "column 1"
    assert format_place("ab\ncd", 3) == "line 2, column 1"
    assert format_place("\nabc", 2) == "column 2"


@pytest.mark.parametrize("text", ["p^2 + q", "  p  ^  2\n\t+ q ", "^^ ^", "q"])
def test_an_offset_in_pythons_line_is_one_in_the_text(text: str) -> None:
    line = " ".join(text.replace("^", "**").split())
    for offset, c in enumerate(line):
        found = text[index_of(text, offset)]
        assert found == c or (found == "^" and c == "*") or (c == " ")
