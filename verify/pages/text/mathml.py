"""Formula text → MathML Core, by a small printer.

The text is read by the whitelist parser and never evaluated. What that parser refuses (a formula
longer than its limit, say) is shown as it is written. In which order sums and products go is said
in `verify.pages.text.terms`.

sympy's own printers, to MathML and to LaTeX, order sums and factors by sympy's rules (3δq² + 1,
δh³), put every argument in growing brackets, and the first writes a minus as a hyphen.
latex2mathml, over the second, keeps that order, and sets the index of k_max as three letters.
"""

import re
from collections.abc import Iterable, Sequence
from typing import TypeAlias

import sympy
from markupsafe import Markup, escape

from verify.algebra.formula import FUNCTIONS, parse
from verify.errors import InputError
from verify.functions import by_name
from verify.hamiltonians.coordinates import PLANE, coordinates_of
from verify.pages.text.inline_math import in_line
from verify.pages.text.terms import Term, factor_key, terms_of

Expr: TypeAlias = sympy.Expr

LONGEST_SHOWN = 600  # characters of a formula that is shown as text
_STACKED_FROM = 4  # terms from which a sum is set one term a line, where it is
_LONGEST_LINE = 40  # signs and names longer than that

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "iota": "ι", "kappa": "κ", "lamda": "λ", "mu": "μ", "nu": "ν",
    "xi": "ξ", "omicron": "ο", "rho": "ρ", "sigma": "σ", "tau": "τ", "upsilon": "υ", "phi": "φ",
    "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ",
    "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω",
}  # fmt: skip
_TAGS = re.compile("<[^>]*>")
_TIMES = "<mo>\u2062</mo>"
_TIMES_THIN = '<mo lspace="0.17em" rspace="0">\u2062</mo>'  # before a function's name
_APPLY = '<mo lspace="0" rspace="0">\u2061</mo>'
_APPLY_THIN = '<mo lspace="0" rspace="0.17em">\u2061</mo>'  # where no parenthesis follows
_OPEN, _CLOSE = '<mo stretchy="false">(</mo>', '<mo stretchy="false">)</mo>'
_SLASH = '<mo lspace="0" rspace="0">/</mo>'


# -- what the pages ask for -----------------------------------------------------------------------


def formula(text: str) -> Markup:
    """The formula as inline markup."""
    expression = read(text)
    return plain(text) if expression is None else _math(in_line(_sum(expression)))


def equation(left: str, text: str) -> Markup:
    """`left` = formula as a display; `left` is markup, see `NAMED`; a long sum is stacked."""
    expression = read(text)
    if expression is None:
        return _math(f"{left}<mo>=</mo>") + plain(text)
    terms = terms_of(expression)
    line = _sum(expression)
    if len(terms) < _STACKED_FROM or len(_TAGS.sub("", line)) <= _LONGEST_LINE:
        return _math(f"{left}<mo>=</mo>{line}", display=True)
    rows = []
    for index, term in enumerate(terms):
        sign = _sign(term, first=index == 0)
        if index:  # a line that goes on from the one above, not one that starts with a sign
            sign = sign.replace("<mo>", '<mo form="infix">')
        start = f"{left}<mo>=</mo>" if index == 0 else ""
        body = f"<mrow>{sign}{_product(term)}</mrow>"
        rows.append(
            f'<mtr><mtd class="r">{_row(start)}</mtd><mtd class="l">{_row(body)}</mtd></mtr>'
        )
    return _math(f'<mtable displaystyle="true">{"".join(rows)}</mtable>', display=True)


def matrix(left: str, rows: Sequence[Sequence[str]]) -> Markup | None:
    """`left` = matrix of formulas as a display; None where an entry cannot be read."""
    expressions = [[read(entry) for entry in row] for row in rows]
    if any(entry is None for row in expressions for entry in row):
        return None
    cells = "".join(
        "<mtr>" + "".join(f"<mtd>{_sum(entry)}</mtd>" for entry in row) + "</mtr>"
        for row in expressions
    )
    # The style sheet draws them: without a font for mathematics parentheses do not stretch.
    left_one, right_one = (f'<mo class="drawn">{sign}</mo>' for sign in "()")
    table = f'{left_one}<mtable class="matrix" displaystyle="true">{cells}</mtable>{right_one}'
    return _math(f"{left}<mo>=</mo><mrow>{table}</mrow>", display=True)


NAMED = {
    "H": "<mi>H</mi>",
    "H(p, q)": f"<mrow><mi>H</mi>{_OPEN}<mi>p</mi><mo>,</mo><mi>q</mi>{_CLOSE}</mrow>",
    "H(p, q, t)": f"<mrow><mi>H</mi>{_OPEN}<mi>p</mi><mo>,</mo><mi>q</mi><mo>,</mo><mi>t</mi>"
    f"{_CLOSE}</mrow>",
    # A text font's prime is raised already; math fonts differ in theirs.
    "p′": '<mrow><mi>p</mi><mtext class="prime">′</mtext></mrow>',
    "q′": '<mrow><mi>q</mi><mtext class="prime">′</mtext></mrow>',
    "J": "<mi>J</mi>",
    "ΔJ": '<mrow><mi mathvariant="normal">Δ</mi><mi>J</mi></mrow>',
}


def name(text: str) -> Markup:
    """A parameter's name as inline markup."""
    return _math(identifier(text))


def order_equation(leading: str, order: int) -> Markup | None:
    """ΔJ = leading · h^order + O(h^(order+1)) as a display."""
    expression = read(leading)
    if expression is None:
        return None
    h = sympy.Symbol("h", real=True)
    body = _sum(h**order * expression)
    rest = f"<mi>O</mi>{_OPEN}{_power(h ** (order + 1))}{_CLOSE}"
    return _math(f"{NAMED['ΔJ']}<mo>=</mo><mrow>{body}<mo>+</mo>{rest}</mrow>", display=True)


def free_names(text: str) -> tuple[str, ...]:
    """The names in a formula other than p, q, h and functions, in order of first appearance."""
    known = {"p", "q", "h", "pi", *FUNCTIONS}
    return tuple(n for n in dict.fromkeys(_identifiers(text)) if n not in known)


def hamiltonian(text: str) -> Markup:
    """H(p, q) = …, or H(p, q, t) = … of a formula with t."""
    names = free_names(text)
    left = "H(p, q, t)" if "t" in names else "H(p, q)"
    plane = coordinates_of({*names, *_identifiers(text)}) == PLANE
    return equation(NAMED[left if plane else "H"], text)


def read(text: str) -> Expr | None:
    """The expression, or None where the whitelist parser refuses the text."""
    try:
        return parse(text, {n for n in _identifiers(text) if n not in FUNCTIONS})
    except InputError:
        return None


def plain(text: str) -> Markup:
    """A formula as the text it is, cut where it is too long for any reader."""
    if len(text) > LONGEST_SHOWN:
        kept = text[:LONGEST_SHOWN]
        return Markup("<code>{}</code>… ({:,} characters; all of them in results.json)").format(
            kept, len(text)
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


def _sign(term: Term, *, first: bool) -> str:
    if term.negative:
        return "<mo>−</mo>"
    return "" if first else "<mo>+</mo>"


# -- products -------------------------------------------------------------------------------------


def _product(term: Term) -> str:
    """The term without its sign."""
    size = abs(term.coefficient)
    factors = sorted(term.factors, key=factor_key)
    if term.divisors:
        below = _joined(size.q, sorted(term.divisors, key=factor_key))
        return f"<mfrac>{_joined(size.p, factors)}{below}</mfrac>"
    if size.q == 1:
        return _joined(size.p, factors)
    # Over a bare number stand the powers of h, else those of all symbols: (h³/2) p sin q, δq⁴/4.
    over = [f for f in factors if str(f.as_base_exp()[0]) == "h"]
    over = over or [f for f in factors if f.as_base_exp()[0].is_Symbol]
    rest = [f for f in factors if f not in over]
    fraction = f"<mfrac>{_joined(size.p, over)}<mn>{size.q}</mn></mfrac>"
    return _joined(1, rest, before=fraction)


def _joined(number: int, factors: Iterable[Expr], *, before: str = "") -> str:
    """number · factors in a row, the number left out where it is 1 and something follows."""
    factors = list(factors)
    alone = number == 1 and len(factors) == 1 and not before
    parts = [before] if before else []
    if number != 1 or not (factors or before):
        parts.append(f"<mn>{number}</mn>")
    for factor in factors:
        base, _ = factor.as_base_exp()
        if parts:
            parts.append(_TIMES_THIN if base.is_Function and base is not sympy.E else _TIMES)
        parts.append(_factor(factor, alone=alone))
    return parts[0] if len(parts) == 1 else _row("".join(parts))


def _factor(factor: Expr, *, alone: bool) -> str:
    if factor.is_Add:
        return _sum(factor) if alone else _bracketed(factor)
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
    return _bracketed(base)


def _call(function: Expr, power: str) -> str:
    text = type(function).__name__
    label = _word(by_name()[text].shown if text in by_name() else text)
    head = f"<msup>{label}{power}</msup>" if power else label
    (argument,) = function.args
    if argument.is_Symbol or argument is sympy.pi or (argument.is_Integer and argument >= 0):
        return _row(f"{head}{_APPLY_THIN}{_atom(argument)}")
    return _row(f"{head}{_APPLY}{_bracketed(argument)}")


def _bracketed(expression: Expr) -> str:
    """In brackets; they grow only where a fraction or a root needs it, not for an exponent."""
    inside = _sum(expression)
    if any(tall in inside for tall in ("<mfrac>", "<msqrt>", "<mroot>")):
        return f"<mrow><mo>(</mo>{inside}<mo>)</mo></mrow>"
    return f"<mrow>{_OPEN}{inside}{_CLOSE}</mrow>"


def identifier(text: str, power: str = "") -> str:
    """A name as markup: Greek where it names a Greek letter, trailing digits as a subscript.

    `power`: markup that stands above the subscript.
    """
    stem, below = _parts(text)
    letter = _word(GREEK.get(stem, stem))
    if not below:
        return f"<msup>{letter}{power}</msup>" if power else letter
    index = f"<mn>{below}</mn>" if below.isdigit() else _word(GREEK.get(below, below))
    if power:
        return f"<msubsup>{letter}{index}{power}</msubsup>"
    return f"<msub>{letter}{index}</msub>"


def _word(text: str) -> str:
    """A letter slants, a word stands upright; see the style sheet."""
    upright = ' mathvariant="normal"' if len(text) > 1 else ""
    return f"<mi{upright}>{escape(text)}</mi>"


def _parts(text: str) -> tuple[str, str]:
    """A name's letter and its index: omega0 → omega, 0; k_max → k, max."""
    match = re.fullmatch(r"([A-Za-z]+)_?([0-9]+)|([A-Za-z]+)_([A-Za-z0-9]+)", text)
    return (match[1] or match[3], match[2] or match[4]) if match else (text, "")
