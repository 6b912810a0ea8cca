"""Whatever is certified contains the true value: random H, schemes, orbits, precisions.

The true values are got by balls that share no code with the toolkit (`tests.helpers.exact_orbits`).
Where there is no certificate nothing is claimed, and nothing is checked.
"""

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.exact_orbits import OBSERVABLES, Case, assert_contained, enclosed_finely
from tests.helpers.sampled.formulas import polynomials, rationals, trigonometric
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import fixed, mpfr, mpmath
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.a_posteriori_bound import certify
from verify.runs.requested_run import run
from verify.scenes.observables import REPORTED


def polynomial(degree: int, terms: int, variables: str = "pq") -> st.SearchStrategy[str]:
    return polynomials(variables, degree, terms)


KNOWN = ["p**2/2 - q**2/2", "p**2/2 - cos(q)", "p**2/2 + 3*cos(2*q)", "p**2/2 + q**2/2 - q**3/3"]
INVOLVED = ["p**2/2 + exp(-q**2)", "sqrt(1 + p**2) + log(2 + q**2)", "p**2/(2 + q**2) + q**4/4"]
formulas = st.builds(
    "p_next = p + h*({}); q_next = q*({}) + h*({})".format,
    polynomial(3, 2),
    st.sampled_from(["1", "1/2", "2", "1 + h", "1 - h"]),
    st.one_of(polynomial(3, 2), st.just("p_next")),
)
# The higher the order, the simpler H has to be for sympy's derivatives.
maps = st.one_of(
    st.tuples(polynomial(4, 3), st.sampled_from(["lie1", "lie2", "lie3"])),
    st.tuples(trigonometric(most_terms=1), st.sampled_from(["lie1", "lie2"])),
    st.tuples(st.sampled_from(INVOLVED), st.sampled_from(["lie1", "lie2"])),
    st.tuples(
        st.one_of(polynomial(3, 2), st.sampled_from(KNOWN)), st.sampled_from(["lie4", "lie5"])
    ),
    st.tuples(
        st.builds(
            "({}) + ({})".format,
            st.one_of(st.just("p**2/2"), polynomial(3, 2, "p")),
            st.one_of(polynomial(4, 3, "q"), trigonometric("q", 1)),
        ),
        st.just("symplectic-euler"),
    ),
    st.tuples(st.just("p**2/2 + q**2/2"), formulas),
)
sizes = st.sampled_from([Fraction(x) for x in ("1/7", "3/100", "1/16", "1/2", "1", "5/2", "1e-9")])
wide = st.sampled_from([fixed.at_bits(112), fixed.at_bits(176)])
floating = st.one_of(
    st.builds(mpfr.at_bits, st.integers(12, 200)), st.builds(mpmath.at_bits, st.integers(12, 200))
)


def case_of(of: tuple[str, str], q: Fraction, p: Fraction, h: Fraction, steps: int) -> Case:
    return Case(*of, q, p, h, steps)


orbits = st.builds(
    case_of, maps, rationals(5), rationals(5), sizes, st.sampled_from([1, 2, 5, 20, 100])
)


def check(case: Case, arithmetic: Arithmetic, observables: frozenset[str]) -> None:
    """Every checkpoint of the run is contained, as far as it has a certificate."""
    try:
        kernel_run = case.kernel_run(observables)
        walked = kernel_run.run(arithmetic, tangent=True)
    except (InputError, UnsupportedError):
        assume(False)
    assume(walked.tangents)
    for note in sorted({0, len(walked.tangents) // 2, len(walked.tangents) - 1}):
        errors = certify(kernel_run, arithmetic, walked, note)
        if errors is not None:
            at = Case(
                case.text, case.scheme, case.q, case.p, case.h, int(walked.tangents[note]["done"])
            )
            true = enclosed_finely(at, errors)
            assert_contained(walked.trail[note], errors, true, at)


some = st.sets(st.sampled_from(sorted(OBSERVABLES))).map(frozenset)


@drawn(80)
@given(orbits, floating, some)
def test_what_is_certified_of_floating_point_runs_contains_the_true_value(
    case: Case, arithmetic: Arithmetic, observables: frozenset[str]
) -> None:
    check(case, arithmetic, observables)


@pytest.mark.left_to_ci
@drawn(15)
@given(orbits, wide, some)
def test_what_is_certified_of_fixed_point_runs_contains_the_true_value(
    case: Case, arithmetic: Arithmetic, observables: frozenset[str]
) -> None:
    check(case, arithmetic, observables)


@drawn(25)
@given(
    orbits,
    st.sampled_from(["mpfr", "mpmath", "auto", "float64", "ball"]),
    st.integers(1, 40),
    st.integers(0, 3),
)
def test_what_a_run_calls_enclosed_contains_the_true_value_as_it_is_printed(
    case: Case, name: str, digits: int, points: int
) -> None:
    try:
        found = run(
            Hamiltonian.parse(case.text), case.scheme, q=case.q, p=case.p, step_size=case.h,
            steps=case.steps, arithmetic=name, digits=digits, observables=REPORTED, points=points,
        )  # fmt: skip
    except InputError:
        assume(False)
    assume(found.values and found.error_kind == "enclosed")
    printed = {n: Fraction(v.value) for n, v in found.values.items()}
    errors = {n: Fraction(v.bound) for n, v in found.values.items()}
    product = errors.get("lambda", Fraction(1))
    true = enclosed_finely(
        case, {n: e for n, e in errors.items() if n != "lambda_plain"} | {"lambda": product}
    )
    assert_contained(printed, errors, {**true, "lambda_plain": true["lambda"]}, case)
