"""Formulas for people to read: a long value stays a symbol in them, and in no verdict."""

from fractions import Fraction

import pytest
import sympy

from verify.algebra.formula import parse
from verify.execution.keeper import NOTHING
from verify.hamiltonians import systems
from verify.scenes.results.proof_result import ProofResult
from verify.studies.kinds.proofs import ProofTask

LONG = Fraction(10**12)


def proved(delta: Fraction, scheme: str = "lie2", **changes: bool) -> ProofResult:
    exact = systems.get("duffing").hamiltonian({"delta": delta})
    task = ProofTask(
        hamiltonian=exact.formula, parameters=dict(exact.values), scheme=scheme, **changes
    )
    return task.compute(NOTHING)


@pytest.mark.parametrize("field", ["leading", "delta_j", "p_next", "q_next"])
def test_with_the_value_put_in_it_is_the_formula_of_the_proof(field: str) -> None:
    found = proved(LONG)
    assert found.symbolic is not None
    assert found.symbolic.symbols == ("delta",)
    of_value, of_symbol = (
        parse(getattr(each, field), {"p", "q", "h", "delta"}) for each in (found, found.symbolic)
    )
    value = {sympy.Symbol("delta", real=True): sympy.Integer(10**12)}
    assert sympy.expand(of_symbol.subs(value) - of_value) == 0
    assert "delta" in getattr(found.symbolic, field)
    assert found.readable is found.symbolic


@pytest.mark.parametrize("value", [Fraction(1), Fraction(10**10), Fraction(1, 7)])
def test_a_value_that_can_be_read_is_put_in(value: Fraction) -> None:
    found = proved(value)
    assert found.symbolic is None
    assert found.readable is found


def test_a_long_denominator_is_long_too_and_without_formulas_there_are_none() -> None:
    assert proved(1 / LONG).symbolic is not None
    assert proved(LONG, formulas=False).symbolic is None


def test_where_the_order_for_the_value_is_another_no_leading_term_is_given() -> None:
    """Of H = p²/2 + (δ − 10¹²) q⁴ the value 10¹² leaves a free particle, whose ΔJ is 0."""
    task = ProofTask(
        hamiltonian="p**2/2 + (delta - 1000000000000)*q**4", parameters={"delta": LONG},
        scheme="lie2",
    )  # fmt: skip
    found = task.compute(NOTHING)
    assert found.area_preserving
    assert found.symbolic is not None
    assert found.symbolic.leading is None
