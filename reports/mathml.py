"""Formula text (as `verify.formula.to_text` prints it) → MathML Core, by a small printer.

The text is read by the whitelist parser and never evaluated. What that parser refuses (a formula
longer than its limit, say) is shown as it is written. Sums go by ascending powers of h, then by
degree; a factor of h leads its product, sums and functions close it: −(h²/2) p (1 + 3q²).
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import sympy
from markupsafe import Markup, escape

from verify.errors import InputError
from verify.formula import FUNCTIONS, parse

Expr = Any  # sympy.Expr, which has no type stubs

LONGEST_SHOWN = 2000  # characters of a formula that is shown as text
_STACKED_FROM = 4  # terms from which a sum is set one term a line

_NAMES = {"log": "ln", "atan": "arctan"}
_GREEK = dict(
    zip(
        "alpha beta gamma delta epsilon zeta eta theta iota kappa lamda mu nu xi omicron rho sigma"
        " tau upsilon phi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega".split(),
        "αβγδεζηθικλμνξορστυφχψωΓΔΘΛΞΠΣΦΨΩ",
        strict=True,
    )
)
_TIMES = "<mo>\u2062</mo>"
_TIMES_THIN = '<mo lspace="0.17em" rspace="0">\u2062</mo>'  # before a function's name
_APPLY = '<mo lspace="0" rspace="0">\u2061</mo>'
_APPLY_THIN = '<mo lspace="0" rspace="0.17em">\u2061</mo>'  # where no parenthesis follows
_INNER = ("p", "q")


# -- what the pages ask for -----------------------------------------------------------------------


def formula(text: str) -> Markup:
    """The formula as inline markup."""
    expression = read(text)
    return plain(text) if expression is None else _math(_sum(expression))


def equation(left: str, text: str) -> Markup:
    """`left` = formula as a display; `left` is markup, see `NAMED`; a long sum is stacked."""
    expression = read(text)
    if expression is None:
        return _math(Markup(f"{left}<mo>=</mo>")) + plain(text)
    terms = _terms(expression)
    if len(terms) < _STACKED_FROM:
        return _math(f"{left}<mo>=</mo>{_sum(expression)}", display=True)
    rows = []
    for index, term in enumerate(terms):
        sign = _sign(term, first=index == 0)
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
    table = f'<mo>(</mo><mtable displaystyle="true">{cells}</mtable><mo>)</mo>'
    return _math(f"{left}<mo>=</mo><mrow>{table}</mrow>", display=True)


NAMED = {
    "H": "<mi>H</mi>",
    "H(p, q)": "<mrow><mi>H</mi><mo>(</mo><mi>p</mi><mo>,</mo><mi>q</mi><mo>)</mo></mrow>",
    "p′": "<msup><mi>p</mi><mo>′</mo></msup>",
    "q′": "<msup><mi>q</mi><mo>′</mo></msup>",
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
    rest = f"<mi>O</mi><mo>(</mo>{_power_of_h(order + 1)}<mo>)</mo>"
    return _math(f"{NAMED['ΔJ']}<mo>=</mo><mrow>{body}<mo>+</mo>{rest}</mrow>", display=True)


def _power_of_h(n: int) -> str:
    return "<mi>h</mi>" if n == 1 else f"<msup><mi>h</mi><mn>{n}</mn></msup>"


def free_names(text: str) -> tuple[str, ...]:
    """The names in a formula other than p, q, h and functions, in order of first appearance."""
    known = {"p", "q", "h", "pi", *FUNCTIONS}
    return tuple(n for n in dict.fromkeys(_identifiers(text)) if n not in known)


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


@dataclass(frozen=True)
class _Term:
    """coefficient · factors / divisors, the coefficient rational and not yet signed."""

    coefficient: Expr
    factors: tuple[Expr, ...] = ()
    divisors: tuple[Expr, ...] = ()

    @property
    def negative(self) -> bool:
        return bool(self.coefficient < 0)


def _sum(expression: Expr) -> str:
    parts = []
    for index, term in enumerate(_terms(expression)):
        parts += [_sign(term, first=index == 0), _product(term)]
    return _row("".join(parts)) if len(parts) > 2 or parts[0] else parts[1]


def _sign(term: _Term, *, first: bool) -> str:
    if term.negative:
        return "<mo>−</mo>"
    return "" if first else "<mo>+</mo>"


def _terms(expression: Expr) -> list[_Term]:
    """The sum's terms in reading order."""
    keyed = sorted(((_sort_key(t), t) for t in sympy.Add.make_args(expression)), key=lambda x: x[0])
    terms = [(key[0], _term(t)) for key, t in keyed]
    lowest = [term for power, term in terms if power == terms[0][0]]
    if lowest[0].negative:  # −1 + q² reads better as q² − 1
        lowest.sort(key=lambda term: term.negative)
    return [*lowest, *(term for _, term in terms[len(lowest) :])]


def _sort_key(term: Expr) -> tuple[Any, ...]:
    powers = {str(b): e for b, e in _powers(term) if b.is_Symbol}
    others = [b for b, _ in _powers(term) if not b.is_Symbol and not b.is_number]
    degree = sum(powers.get(name, 0) for name in _INNER)
    inner = tuple(-powers.get(name, 0) for name in _INNER)
    return powers.get("h", 0), bool(others), degree, inner, str(term)


def _powers(term: Expr) -> list[tuple[Expr, Expr]]:
    return [f.as_base_exp() for f in sympy.Mul.make_args(term)]


def _term(expression: Expr) -> _Term:
    """The term with the rational content, and the sign, of its sums drawn to the front."""
    coefficient, factors, divisors = sympy.S.One, [], []
    for factor in sympy.Mul.make_args(expression):
        base, exponent = factor.as_base_exp()
        if factor.is_Rational:
            coefficient *= factor
        elif factor.is_Add:
            content, rest = factor.primitive()
            if all(t.could_extract_minus_sign() for t in rest.args):
                content, rest = -content, -rest
            coefficient *= content
            factors.append(rest)
        elif exponent.is_Rational and exponent < 0 and base is not sympy.E:
            divisors.append(base**-exponent)
        else:
            factors.append(factor)
    return _Term(coefficient, tuple(factors), tuple(divisors))


# -- products -------------------------------------------------------------------------------------


def _product(term: _Term) -> str:
    """The term without its sign."""
    size = abs(term.coefficient)
    factors = sorted(term.factors, key=_factor_key)
    if term.divisors:
        above, below = _joined(size.p, factors), _joined(size.q, sorted(term.divisors, key=_factor_key))
        return f"<mfrac>{above}{below}</mfrac>"
    if size.q == 1:
        return _joined(size.p, factors)
    # Over a bare number stand the powers of h, else those of all symbols: (h³/2) p sin q, δq⁴/4.
    over = [f for f in factors if str(f.as_base_exp()[0]) == "h"]
    over = over or [f for f in factors if f.as_base_exp()[0].is_Symbol]
    rest = [f for f in factors if f not in over]
    fraction = f"<mfrac>{_joined(size.p, over)}<mn>{size.q}</mn></mfrac>"
    return _joined(1, rest, before=fraction)


def _factor_key(factor: Expr) -> tuple[Any, ...]:
    base, _ = factor.as_base_exp()
    name = str(base)
    if base.is_number:
        kind = 4 if base is sympy.E else 0
    elif base.is_Symbol:
        kind = 1 if name == "h" else 3 if name in _INNER else 2
    else:
        kind = 4 if base.is_Add else 5
    return kind, name


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
    return f"<msup>{_atom(base)}{upper}</msup>"


def _exponent(value: Expr) -> str:
    if value.is_Integer:
        return f"<mn>{value}</mn>"
    return f"<mrow><mn>{value.p}</mn><mo>/</mo><mn>{value.q}</mn></mrow>"


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
    label = f"<mi>{_NAMES.get(text, text)}</mi>"
    head = f"<msup>{label}{power}</msup>" if power else label
    (argument,) = function.args
    if argument.is_Symbol or argument is sympy.pi or (argument.is_Integer and argument >= 0):
        return _row(f"{head}{_APPLY_THIN}{_atom(argument)}")
    return _row(f"{head}{_APPLY}{_bracketed(argument)}")


def _bracketed(expression: Expr) -> str:
    return f"<mrow><mo>(</mo>{_sum(expression)}<mo>)</mo></mrow>"


def identifier(text: str) -> str:
    """A name as markup: Greek where it names a Greek letter, trailing digits as a subscript."""
    stem, below = text, ""
    match = re.fullmatch(r"([A-Za-z]+)_?([0-9]+)|([A-Za-z]+)_([A-Za-z0-9]+)", text)
    if match:
        stem, below = match[1] or match[3], match[2] or match[4]
    letter = f"<mi>{escape(_GREEK.get(stem, stem))}</mi>"
    if not below:
        return letter
    tag = "mn" if below.isdigit() else "mi"
    return f"<msub>{letter}<{tag}>{escape(_GREEK.get(below, below))}</{tag}></msub>"
