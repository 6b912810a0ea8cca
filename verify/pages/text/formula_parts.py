"""Parts of a formula as its printer needs them: terms in reading order, names by letter and index.

Sums are ordered by ascending powers of h, then by degree in p and q; a factor of h leads its
product, and sums and functions end it: −(h²/2) p (1 + 3q²).
"""

import re
from dataclasses import dataclass
from typing import TypeAlias

import sympy

Expr: TypeAlias = sympy.Expr

_COORDINATES = ("p", "q")
# The names that sympy uses; it has `lamda`, as `lambda` is a keyword of Python.
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "iota": "ι", "kappa": "κ", "lamda": "λ", "mu": "μ", "nu": "ν",
    "xi": "ξ", "omicron": "ο", "rho": "ρ", "sigma": "σ", "tau": "τ", "upsilon": "υ", "phi": "φ",
    "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ",
    "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω",
}  # fmt: skip


@dataclass(frozen=True)
class FormulaTerm:
    """coefficient · factors / divisors, with a rational coefficient, which has the sign."""

    coefficient: Expr
    factors: tuple[Expr, ...] = ()
    divisors: tuple[Expr, ...] = ()

    @property
    def is_negative(self) -> bool:
        return bool(self.coefficient < 0)


def terms_of(expression: Expr) -> list[FormulaTerm]:
    """Return the sum's terms in reading order."""
    keyed = sorted(((_sort_key(t), t) for t in sympy.Add.make_args(expression)), key=lambda x: x[0])
    terms = [(key[0], _term(t)) for key, t in keyed]
    lowest_terms = [term for power, term in terms if power == terms[0][0]]
    if lowest_terms[0].is_negative:  # q² − 1 reads better than −1 + q²
        lowest_terms.sort(key=lambda term: term.is_negative)
    return [*lowest_terms, *(term for _, term in terms[len(lowest_terms) :])]


def _sort_key(term: Expr) -> tuple[object, ...]:
    powers = {str(b): e for b, e in _powers(term) if b.is_Symbol}
    other_bases = [b for b, _ in _powers(term) if not b.is_Symbol and not b.is_number]
    # Ascending powers of h come first, since h is small; then ascending degree in p and q.
    degree = sum(powers.get(name, 0) for name in _COORDINATES)
    negative_powers = tuple(-powers.get(name, 0) for name in _COORDINATES)
    return powers.get("h", 0), bool(other_bases), degree, negative_powers, str(term)


def _powers(term: Expr) -> list[tuple[Expr, Expr]]:
    return [f.as_base_exp() for f in sympy.Mul.make_args(term)]


def _term(expression: Expr) -> FormulaTerm:
    """Return the term, with the rational content and the sign of its sums in the coefficient."""
    coefficient, factors, divisors = sympy.S.One, [], []
    for factor in sympy.Mul.make_args(expression):
        base, exponent = factor.as_base_exp()
        if factor.is_Rational:
            coefficient *= factor
        elif factor.is_Add:
            content, primitive_part = _primitive(factor, sympy.S.One)
            coefficient *= content
            factors.append(primitive_part)
        elif exponent.is_Rational and exponent < 0 and base is not sympy.E:
            content, primitive_part = _primitive(base, exponent)
            coefficient *= content**exponent
            divisors.append(primitive_part**-exponent)
        else:
            factors.append(factor)
    return FormulaTerm(coefficient, tuple(factors), tuple(divisors))


def _primitive(base: Expr, exponent: Expr) -> tuple[Expr, Expr]:
    """Return a sum's rational content, negative if all its terms are, and the other factor."""
    if not base.is_Add or not exponent.is_Integer:
        return sympy.S.One, base
    content, primitive_part = base.primitive()
    if all(t.could_extract_minus_sign() for t in primitive_part.args):
        return -content, -primitive_part
    return content, primitive_part


def factor_key(factor: Expr) -> tuple[object, ...]:
    """Return a key that sorts the factors of a product into reading order."""
    base, _ = factor.as_base_exp()
    name = str(base)
    if base.is_number:
        rank = 4 if base is sympy.E else 0
    elif base.is_Symbol:
        rank = 1 if name == "h" else 3 if name in _COORDINATES else 2
    else:
        rank = 4 if base.is_Add else 5
    return rank, name


def split_name(name: str) -> tuple[str, str]:
    """Return a name's letter and its index, or "" for no index; Greek letters replace their names.

    >>> split_name("omega0"), split_name("k_max"), split_name("x")
    (('ω', '0'), ('k', 'max'), ('x', ''))
    """
    match = re.fullmatch(r"([A-Za-z]+)_?([0-9]+)|([A-Za-z]+)_([A-Za-z0-9]+)", name)
    letter, index = (match[1] or match[3], match[2] or match[4]) if match else (name, "")
    return GREEK.get(letter, letter), GREEK.get(index, index)
