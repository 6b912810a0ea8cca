"""Verdicts over random scenes: always one of them, and the right one where it is known."""

from fractions import Fraction

from hypothesis import example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import formulas, rationals
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.stability import KINDS
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import StabilityRun
from verify.studies.stability.verdict_on_run import judge

SIZES = st.builds(lambda n: Fraction(10) ** n, st.integers(-200, 100))
STEPS = st.builds(lambda m, n: m * Fraction(10) ** n, st.integers(1, 9), st.integers(-12, 2))
SYMPLECTIC = st.sampled_from(["symplectic-euler", "stormer-verlet"])
HARMONIC = Hamiltonian.parse("p**2/2 + w**2*q**2/2", {"w": 1})


@drawn(40)
@given(
    formulas(),
    st.sampled_from(["lie1", "lie2", "lie3", "stormer-verlet", "rk4"]),
    STEPS, st.integers(1, 300), rationals(), rationals(),
)  # fmt: skip
@example("p**2/2 + log(q)", "lie2", Fraction(1, 10), 50, Fraction(1), Fraction(-1))
@example("exp(exp(q)) + p**2", "lie1", Fraction(1), 50, Fraction(1), Fraction(9))
def test_every_case_ends_in_a_verdict(
    text: str, scheme: str, h: Fraction, steps: int, p: Fraction, q: Fraction
) -> None:
    try:
        hamiltonian = Hamiltonian.parse(text)
        hamiltonian = hamiltonian.with_values(dict.fromkeys(hamiltonian.parameters, Fraction(1, 2)))
        found = judge(RunMotion(StabilityRun(hamiltonian, scheme, h, (p, q), steps)))
    except InputError:
        return  # no H, or one that the scheme does not take
    assert found.kind in KINDS
    assert found.detail
    if found.step is not None:
        assert 1 <= found.step <= steps


@drawn(30)
@given(SYMPLECTIC, SIZES, SIZES, st.integers(1, 95))
def test_below_their_limit_symplectic_schemes_are_stable_at_any_size_and_frequency(
    scheme: str, size: Fraction, omega: Fraction, percent: int
) -> None:
    hamiltonian = HARMONIC.with_values({"w": omega})
    h = 2 * Fraction(percent, 100) / omega
    found = judge(RunMotion(StabilityRun(hamiltonian, scheme, h, (Fraction(0), size), 400)))
    # p is ω times as large as q; where either leaves float64's range that is the verdict.
    assert found.kind in ("stable", "overflow", "underflow")
    ordinary = all(Fraction(1, 10**100) < x < 10**100 for x in (size, omega, size * omega**2))
    assert found.kind == "stable" or not ordinary


@drawn(30)
@given(SYMPLECTIC, SIZES, SIZES, st.integers(110, 1000))
def test_beyond_it_the_scheme_is_to_blame_at_any_size_and_frequency(
    scheme: str, size: Fraction, omega: Fraction, percent: int
) -> None:
    hamiltonian = HARMONIC.with_values({"w": omega})
    h = 2 * Fraction(percent, 100) / omega
    found = judge(RunMotion(StabilityRun(hamiltonian, scheme, h, (Fraction(0), size), 400)))
    assert found.kind == "unstable: scheme"
    assert found.step is not None
