"""Truncation and rounding of Λ over drawn Hamiltonians: exact sums, and parts against rationals."""

import math
from fractions import Fraction
from itertools import pairwise

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import monomial, polynomials, rationals
from tests.helpers.sampled.separations import AreaChains, area_chains
from tests.helpers.stepping.exact_separation import links
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.separation.chain import PARTS, QUANTITIES, Chain
from verify.studies.separation.mixed_run import Stopped

starts = st.fractions(min_value=-1, max_value=1, max_denominator=30)
step_sizes = st.fractions(min_value="1/50", max_value="1/3", max_denominator=50)
SHORT = Fraction(1, 2**3000)  # what the oracle rounds off
quick = drawn(40)


def chains(text: str, eta: int, start: dict[str, Fraction], steps: int) -> AreaChains:
    run = Hamiltonian.parse(text), f"lie{eta}", start, steps
    try:
        return area_chains(*run, 17, "mpfr")
    except Stopped:
        assume(False)
        raise


def bent(draw: st.DrawFn) -> str:
    """A polynomial H that moves: kinetic energy, and something of degree 3 or more."""
    extra = draw(polynomials(degree=4, most_terms=2))
    return f"p**2/2 + {monomial(draw(rationals(4)), 'pq', (0, 3))} + {extra}"


hamiltonians = st.composite(bent)()


@quick
@given(hamiltonians, st.integers(1, 3), starts, starts, step_sizes, st.integers(1, 6))
def test_parts_add_up_exactly_and_contain_what_rationals_give(
    text: str, eta: int, p: Fraction, q: Fraction, h: Fraction, steps: int
) -> None:
    start = {"p": p, "q": q, "h": h}
    found = chains(text, eta, start, steps)
    true = links(text, eta, start, steps)
    for name in ("plain", "closed_form"):
        chain: Chain | None = getattr(found, name)
        if chain is None:
            continue
        for k in range(len(chain.marks)):
            whole = sum(chain.trail(part)[0][k] for part in ("truncation", *PARTS))
            assert whole == chain.trail("lambda_working")[0][k]
            assert whole - chain.trail("truncation")[0][k] == chain.trail("total")[0][k]
        exact = dict(zip(("truncation", *PARTS), differences(true[name]), strict=True))
        exact |= {"lambda_working": true[name][4], "total": true[name][4] - true[name][0]}
        for part in QUANTITIES:
            value, bound = chain.final(part)
            slack = SHORT
            if name == "closed_form" and part in ("product", "total", "lambda_working"):
                slack = Fraction(math.ulp(float(true[name][4]))) * 2 + SHORT
            assert abs(value - exact[part]) <= bound + slack, (name, part)


def differences(values: list[Fraction]) -> list[Fraction]:
    return [values[0], *(b - a for a, b in pairwise(values))]


dyadic = st.builds(lambda n, k: Fraction(n, 2**k), st.integers(-40, 40), st.integers(3, 6))


@quick
@given(hamiltonians, dyadic, dyadic, st.integers(4, 12), st.integers(1, 6))
def test_inputs_that_are_binary_have_no_rounding_at_all(
    text: str, p: Fraction, q: Fraction, k: int, steps: int
) -> None:
    found = chains(text, 2, {"p": p, "q": q, "h": Fraction(1, 2**k)}, steps)
    assert found.plain.links[0] is found.plain.links[1]
    assert found.plain.final("input") == (0, 0)
