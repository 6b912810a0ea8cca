"""Formulas made of every H: in h, p, q and the derivatives of H, such as H_pq or H_11."""

import re

import sympy

from verify.algebra.domain import Domain
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import read as read_formula
from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian

_NAME = re.compile(r"[A-Za-z]\w*")
_DERIVATIVE = re.compile(r"H_([pq]+|\d\d)")  # ∂²H/∂p∂q is H_pq, H_qp or H_11


def read(formula: str, claim: str) -> tuple[sympy.Expr, Domain]:
    """The formula of that claim as an expression, and where it is defined.

    InputError where it names more than derivatives of H.
    """
    derivatives = {name for name in _NAME.findall(formula) if _DERIVATIVE.fullmatch(name)}
    key = f"claim {claim}: formula"
    try:
        found, asked = read_formula(formula, ("p", "q", "h", *derivatives), source=key)
        return found, Domain.of(asked)
    except InputError as error:
        if "unknown name" not in error.problem:
            raise
        problem = f"{error.problem.partition(';')[0]}; allowed: h and derivatives such as H_pq"
        raise InputError(key, formula, problem) from None


def normal(formula: sympy.Expr, domain: Domain, *, separable: bool) -> tuple[sympy.Expr, Domain]:
    """The same with one name for each derivative; of a separable H the mixed ones are zero."""
    put = {}
    for s, (p_times, q_times) in _derivatives(formula).items():
        zero = separable and p_times and q_times
        put[s] = sympy.S.Zero if zero else symbol("H_" + "p" * p_times + "q" * q_times)
    return formula.xreplace(put), domain.replaced(put)


def of_hamiltonian(formula: sympy.Expr, hamiltonian: Hamiltonian) -> str:
    """The formula's text with the derivatives of this H put in. InputError where it is too long."""
    p, q = symbol("p"), symbol("q")
    put = {
        s: hamiltonian.exact.diff((p, p_times), (q, q_times))
        for s, (p_times, q_times) in _derivatives(formula).items()
    }
    return to_text(formula.xreplace(put))


def _derivatives(formula: sympy.Expr) -> dict[sympy.Symbol, tuple[int, int]]:
    """The derivatives of H in it, with how often each is taken by p, and by q."""
    found = {}
    for s in formula.free_symbols:
        if match := _DERIVATIVE.fullmatch(s.name):
            by = match[1]
            digits = (int(by[0]), int(by[1])) if by.isdecimal() else None
            found[s] = digits or (by.count("p"), by.count("q"))
    return found
