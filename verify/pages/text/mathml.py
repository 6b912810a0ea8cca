"""Conversion of a formula's text to MathML Core by a small printer.

The text is read by the whitelist parser and never evaluated. A text that the parser refuses, such
as a formula longer than its limit, is shown as plain text. The order of terms and factors is
defined in `verify.pages.text.formula_parts`.

sympy's printers to MathML and to LaTeX order sums and factors by sympy's rules (3δq² + 1, δh³), and
put every argument in growing brackets; that to MathML writes a minus as a hyphen. latex2mathml,
applied to the LaTeX, keeps that order, and sets the index of k_max as three letters.
"""

import re
from collections.abc import Iterable, Sequence

import sympy
from markupsafe import Markup, escape

from verify.algebra.formula import FUNCTIONS, parse
from verify.errors import InputError
from verify.functions import by_name
from verify.hamiltonians.coordinates import PLANE, coordinates_of
from verify.hamiltonians.equations import are_equations
from verify.pages.text.formula_parts import Expr, FormulaTerm, factor_key, split_name, terms_of
from verify.pages.text.inline_math import flatten_fractions

# The limit on characters of a formula that is shown as plain text; the rest is cut off.
LONGEST_SHOWN = 600
# A sum of at least this number of terms is set with one term in a line, if it is long enough.
_MIN_STACKED_TERMS = 4
# The limit on characters, without tags, of a sum that is set on one line.
_MAX_LINE_CHARACTERS = 40
_TAGS = re.compile("<[^>]*>")
_TIMES = "<mo>\u2062</mo>"
# A thin space stands before a function's name, as in p sin q.
_TIMES_THIN = '<mo lspace="0.17em" rspace="0">\u2062</mo>'
_APPLY = '<mo lspace="0" rspace="0">\u2061</mo>'
# A thin space stands after a function's name if no parenthesis follows, as in sin q.
_APPLY_THIN = '<mo lspace="0" rspace="0.17em">\u2061</mo>'
_OPEN, _CLOSE = '<mo stretchy="false">(</mo>', '<mo stretchy="false">)</mo>'
_SLASH = '<mo lspace="0" rspace="0">/</mo>'


# -- whole formulas -------------------------------------------------------------------------------


def formula(text: str) -> Markup:
    """Return the formula as inline markup."""
    expression = read(text)
    return plain(text) if expression is None else _math(flatten_fractions(_sum(expression)))


def equation(left: str, text: str) -> Markup:
    """Return `left` = formula as a display, a long sum in lines; `left`: markup, as in `NAMED`."""
    expression = read(text)
    if expression is None:
        return _math(f"{left}<mo>=</mo>") + plain(text)
    terms = terms_of(expression)
    line = _sum(expression)
    if len(terms) < _MIN_STACKED_TERMS or len(_TAGS.sub("", line)) <= _MAX_LINE_CHARACTERS:
        return _math(f"{left}<mo>=</mo>{line}", display=True)
    rows = []
    for index, term in enumerate(terms):
        sign = _sign(term, first=index == 0)
        # By default MathML sets a sign at the start of a line as a prefix, without space.
        if index:
            sign = sign.replace("<mo>", '<mo form="infix">')
        start = f"{left}<mo>=</mo>" if index == 0 else ""
        body = f"<mrow>{sign}{_product(term)}</mrow>"
        rows.append(
            f'<mtr><mtd class="r">{_row(start)}</mtd><mtd class="l">{_row(body)}</mtd></mtr>'
        )
    return _math(f'<mtable displaystyle="true">{"".join(rows)}</mtable>', display=True)


def matrix(left: str, rows: Sequence[Sequence[str]]) -> Markup | None:
    """Return `left` = matrix of formulas as a display; None if an entry cannot be read."""
    expressions = [[read(entry) for entry in row] for row in rows]
    if any(entry is None for row in expressions for entry in row):
        return None
    cells = "".join(
        "<mtr>" + "".join(f"<mtd>{_sum(entry)}</mtd>" for entry in row) + "</mtr>"
        for row in expressions
    )
    # The style sheet draws the parentheses, which stretch only in a font for mathematics.
    opening, closing = (f'<mo class="drawn">{sign}</mo>' for sign in "()")
    table = f'{opening}<mtable class="matrix" displaystyle="true">{cells}</mtable>{closing}'
    return _math(f"{left}<mo>=</mo><mrow>{table}</mrow>", display=True)


NAMED = {
    "H": "<mi>H</mi>",
    "H(p, q)": f"<mrow><mi>H</mi>{_OPEN}<mi>p</mi><mo>,</mo><mi>q</mi>{_CLOSE}</mrow>",
    "H(p, q, t)": f"<mrow><mi>H</mi>{_OPEN}<mi>p</mi><mo>,</mo><mi>q</mi><mo>,</mo><mi>t</mi>"
    f"{_CLOSE}</mrow>",
    # The prime of a text font is raised; those of fonts for mathematics differ.
    "p′": '<mrow><mi>p</mi><mtext class="prime">′</mtext></mrow>',
    "q′": '<mrow><mi>q</mi><mtext class="prime">′</mtext></mrow>',
    "J": "<mi>J</mi>",
    "ΔJ": '<mrow><mi mathvariant="normal">Δ</mi><mi>J</mi></mrow>',
}


def name(text: str) -> Markup:
    """Return a parameter's name as inline markup."""
    return _math(identifier(text))


def order_equation(leading: str, order: int) -> Markup | None:
    """Return ΔJ = leading · h^order + O(h^(order+1)) as a display, or None if it is unreadable."""
    expression = read(leading)
    if expression is None:
        return None
    h = sympy.Symbol("h", real=True)
    body = _sum(h**order * expression)
    remainder = f"<mi>O</mi>{_OPEN}{_power(h ** (order + 1))}{_CLOSE}"
    return _math(f"{NAMED['ΔJ']}<mo>=</mo><mrow>{body}<mo>+</mo>{remainder}</mrow>", display=True)


def free_names(text: str) -> tuple[str, ...]:
    """Return the names in a formula other than p, q, h and functions, in order of appearance."""
    reserved = {"p", "q", "h", "pi", *FUNCTIONS}
    return tuple(n for n in dict.fromkeys(_identifiers(text)) if n not in reserved)


def hamiltonian(text: str) -> Markup:
    """Return H(p, q) = …, or H(p, q, t) = … for a formula with t, as a display; of equations
    without an H each with a dot on the left."""
    if are_equations(text):
        pairs = (line.split(" = ", 1) for line in text.split("; "))
        return Markup("").join(
            equation(_put_dot(left.removesuffix("_dot")), right) for left, right in pairs
        )
    names = free_names(text)
    left = "H(p, q, t)" if "t" in names else "H(p, q)"
    plane = coordinates_of({*names, *_identifiers(text)}) == PLANE
    return equation(NAMED[left if plane else "H"], text)


def _put_dot(variable: str) -> str:
    # A dot that combines with the letter before it, which is understood in TeX as well.
    return identifier(variable).replace("</mi>", "\u0307</mi>", 1)


def read(text: str) -> Expr | None:
    """Return the expression, or None if the whitelist parser refuses the text."""
    try:
        return parse(text, {n for n in _identifiers(text) if n not in FUNCTIONS})
    except InputError:
        return None


def plain(text: str) -> Markup:
    """Return a formula as plain text, cut if it is longer than `LONGEST_SHOWN`."""
    if len(text) > LONGEST_SHOWN:
        beginning = text[:LONGEST_SHOWN]
        return Markup("<code>{}</code>… ({:,} characters; all of them in results.json)").format(
            beginning, len(text)
        )
    return Markup("<code>{}</code>").format(text)


def _identifiers(text: str) -> list[str]:
    return re.findall(r"[A-Za-z_]\w*", text, re.ASCII)


def _math(content: str, *, display: bool = False) -> Markup:
    block = ' display="block"' if display else ""
    return Markup(f"<math{block}>{_row(content)}</math>")  # noqa: S704 - leaves are escaped below


def _row(content: str) -> str:
    return f"<mrow>{content}</mrow>"


# -- sums -----------------------------------------------------------------------------------------


def _sum(expression: Expr) -> str:
    parts = []
    for index, term in enumerate(terms_of(expression)):
        parts += [_sign(term, first=index == 0), _product(term)]
    return _row("".join(parts)) if len(parts) > 2 or parts[0] else parts[1]


def _sign(term: FormulaTerm, *, first: bool) -> str:
    if term.is_negative:
        return "<mo>−</mo>"
    return "" if first else "<mo>+</mo>"


# -- products -------------------------------------------------------------------------------------


def _product(term: FormulaTerm) -> str:
    """Return the term without its sign."""
    size = abs(term.coefficient)
    factors = sorted(term.factors, key=factor_key)
    if term.divisors:
        denominator = _join_factors(size.q, sorted(term.divisors, key=factor_key))
        return f"<mfrac>{_join_factors(size.p, factors)}{denominator}</mfrac>"
    if size.q == 1:
        return _join_factors(size.p, factors)
    # Above a number stand the powers of h, without h those of all symbols: (h³/2) p sin q, δq⁴/4.
    numerator = [f for f in factors if str(f.as_base_exp()[0]) == "h"]
    numerator = numerator or [f for f in factors if f.as_base_exp()[0].is_Symbol]
    other_factors = [f for f in factors if f not in numerator]
    fraction = f"<mfrac>{_join_factors(size.p, numerator)}<mn>{size.q}</mn></mfrac>"
    return _join_factors(1, other_factors, before=fraction)


def _join_factors(number: int, factors: Iterable[Expr], *, before: str = "") -> str:
    """Return before · number · factors in a row, without a number 1 if there is anything else."""
    factors = list(factors)
    is_alone = number == 1 and len(factors) == 1 and not before
    parts = [before] if before else []
    if number != 1 or not (factors or before):
        parts.append(f"<mn>{number}</mn>")
    for factor in factors:
        base, _ = factor.as_base_exp()
        if parts:
            parts.append(_TIMES_THIN if base.is_Function and base is not sympy.E else _TIMES)
        parts.append(_factor(factor, alone=is_alone))
    return parts[0] if len(parts) == 1 else _row("".join(parts))


def _factor(factor: Expr, *, alone: bool) -> str:
    if factor.is_Add:
        return _sum(factor) if alone else _in_brackets(factor)
    return _power(factor)


# -- powers, functions, names ---------------------------------------------------------------------


def _power(factor: Expr) -> str:
    if isinstance(factor, sympy.exp) or factor is sympy.E:
        argument = factor.args[0] if factor.args else sympy.S.One
        return "<mi>e</mi>" if argument == 1 else f"<msup><mi>e</mi>{_sum(argument)}</msup>"
    base, exponent = factor.as_base_exp()
    if exponent == 1:
        return _atom(base)
    if exponent.is_Rational and exponent.p == 1:
        if exponent.q == 2:
            return f"<msqrt>{_sum(base)}</msqrt>"
        return f"<mroot>{_sum(base)}<mn>{exponent.q}</mn></mroot>"
    upper = _exponent(exponent)
    if base.is_Function:
        return _call(base, upper)
    if base.is_Symbol:
        return identifier(str(base), upper)
    return f"<msup>{_atom(base)}{upper}</msup>"


def _exponent(value: Expr) -> str:
    if value.is_Integer:
        return f"<mn>{value}</mn>"
    return f"<mrow><mn>{value.p}</mn>{_SLASH}<mn>{value.q}</mn></mrow>"


def _atom(base: Expr) -> str:
    if base.is_Symbol:
        return identifier(str(base))
    if base is sympy.pi:
        return "<mi>π</mi>"
    if base.is_Function:
        return _call(base, "")
    if base.is_Integer and base >= 0:
        return f"<mn>{base}</mn>"
    return _in_brackets(base)


def _call(function: Expr, power: str) -> str:
    text = type(function).__name__
    label = _word(by_name()[text].shown if text in by_name() else text)
    head = f"<msup>{label}{power}</msup>" if power else label
    (argument,) = function.args
    if argument.is_Symbol or argument is sympy.pi or (argument.is_Integer and argument >= 0):
        return _row(f"{head}{_APPLY_THIN}{_atom(argument)}")
    return _row(f"{head}{_APPLY}{_in_brackets(argument)}")


def _in_brackets(expression: Expr) -> str:
    """Return the expression in brackets, which grow for fractions and roots, not for exponents."""
    inside = _sum(expression)
    if any(tall in inside for tall in ("<mfrac>", "<msqrt>", "<mroot>")):
        return f"<mrow><mo>(</mo>{inside}<mo>)</mo></mrow>"
    return f"<mrow>{_OPEN}{inside}{_CLOSE}</mrow>"


def identifier(text: str, power: str = "") -> str:
    """Return a name as markup: Greek letters for their names, trailing digits as a subscript.

    `power`: markup of an exponent, which is set above the subscript.
    """
    letter_text, index_text = split_name(text)
    letter = _word(letter_text)
    if not index_text:
        return f"<msup>{letter}{power}</msup>" if power else letter
    index = f"<mn>{index_text}</mn>" if index_text.isdigit() else _word(index_text)
    if power:
        return f"<msubsup>{letter}{index}{power}</msubsup>"
    return f"<msub>{letter}{index}</msub>"


def _word(text: str) -> str:
    """Return a name as markup; a letter is slanted, a word upright (see the style sheet)."""
    upright = ' mathvariant="normal"' if len(text) > 1 else ""
    return f"<mi{upright}>{escape(text)}</mi>"
