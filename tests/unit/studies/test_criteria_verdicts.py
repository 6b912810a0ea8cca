"""The four criteria: from proofs where there are proofs, else from slopes that can bear it."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest

from tests.helpers.constructed.runs import STEP_SIZES, Given, made_proof, made_run
from verify.execution.execute import compute_task
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.run import RunResult
from verify.studies.criteria_verdicts import judge, measured_slopes
from verify.studies.kinds.proofs import ProofTask
from verify.verdict import Verdict

PROVED, MEASURED, REFUTED, UNDECIDED = (
    Verdict.PROVED, Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED,
)  # fmt: skip
HARMONIC = "p**2/2 + q**2/2"
DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
PENDULUM = "p**2/2 - cos(q)"


def proof_of(hamiltonian: str, scheme: str) -> ProofResult:
    values = {"delta": "7/3"} if "delta" in hamiltonian else {}
    found = compute_task(ProofTask(hamiltonian=hamiltonian, parameters=values, scheme=scheme))
    assert isinstance(found, ProofResult)
    return found


# -- by proof -------------------------------------------------------------------------------------

ONLY_NOT_EXACT = (REFUTED, PROVED, PROVED, PROVED)  # criteria 1, 2, 3, 4
ALL = (PROVED,) * 4
NONE = (REFUTED,) * 4
# Damped: consistent to order 1 with det J = 1 + 2h². Squeezed: det J = 1, but not this flow.
DAMPED = "p_next = p - h*q + h**2*p; q_next = q + h*p"
CASES = {
    **{f"lie{n}-{name}": (h, f"lie{n}", ONLY_NOT_EXACT)
       for n in (1, 2, 3) for name, h in (("duffing", DUFFING), ("pendulum", PENDULUM))},
    "euler-duffing": (DUFFING, "symplectic-euler", ALL),
    "euler-pendulum": (PENDULUM, "symplectic-euler", ALL),
    "euler-by-formula": (HARMONIC, "p_next = p - h*q; q_next = q + h*p_next", ALL),
    "explicit-euler": (HARMONIC, "p_next = p - h*q; q_next = q + h*p", ONLY_NOT_EXACT),
    "damped-in-h-squared": (HARMONIC, DAMPED, ONLY_NOT_EXACT),
    "frozen": (DUFFING, "p_next = p; q_next = q", NONE),
    "of-order-h": (HARMONIC, "p_next = p*(1 + h); q_next = q", NONE),
    "of-order-h-beside-the-flow": (HARMONIC, "p_next = p - h*q + h*p; q_next = q + h*p", NONE),
    "squeezed": (HARMONIC, "p_next = p*(1 + h); q_next = q/(1 + h)", NONE),
    "turning-the-wrong-way": (HARMONIC, "p_next = p + h*q; q_next = q - h*p_next", NONE),
    "of-another-speed": (HARMONIC, "p_next = p - 2*h*q; q_next = q + 2*h*p_next", NONE),
    "not-near-at-h-0": (HARMONIC, "p_next = -q; q_next = p", NONE),
    "exact-rotation": (HARMONIC, "p_next = p*cos(h) - q*sin(h); q_next = q*cos(h) + p*sin(h)", ALL),
}  # fmt: skip


@pytest.mark.parametrize(("hamiltonian", "scheme", "expected"), CASES.values(), ids=CASES)
def test_what_is_proved_decides_the_criteria(
    hamiltonian: str, scheme: str, expected: tuple[Verdict, ...]
) -> None:
    proof = proof_of(hamiltonian, scheme)
    judged = [judge(n, proof, []) for n in (1, 2, 3, 4)]
    assert tuple(c.verdict for c in judged) == expected
    assert [(c.number, c.scheme) for c in judged] == [(n, scheme) for n in (1, 2, 3, 4)]
    assert all(c.evidence for c in judged)


@pytest.mark.parametrize("eta", [1, 2, 3])
def test_the_evidence_names_the_proved_orders(eta: int) -> None:
    proof = proof_of(DUFFING, f"lie{eta}")
    one, two, three, four = (judge(n, proof, []).evidence for n in (1, 2, 3, 4))
    assert f"h^{eta + 1}" in one
    assert f"h^{eta + 1}" in two
    assert f"O(h^{2 * eta + 2})" in three
    assert f"O(h^{eta})" in four


def test_a_frozen_map_is_refuted_for_not_being_a_scheme() -> None:
    proof = proof_of(DUFFING, "p_next = p; q_next = q")
    assert proof.area_preserving
    assert "exact flow" in judge(1, proof, []).evidence


@pytest.mark.parametrize("number", [1, 2, 3, 4])
@pytest.mark.parametrize("convergence", [0, -1])
def test_a_map_whose_consistency_is_open_satisfies_nothing(number: int, convergence: int) -> None:
    proof = made_proof(convergence_order=convergence, area_preserving=True)
    runs = power_runs(mse=6, lam=2)
    assert judge(number, proof, runs).verdict is UNDECIDED


@pytest.mark.parametrize("number", [1, 2])
def test_no_run_proves_what_is_said_of_every_point(number: int) -> None:
    assert judge(number, made_proof(), power_runs(mse=6, lam=2)).verdict is UNDECIDED


@pytest.mark.parametrize("number", [2, 3, 4])
@pytest.mark.parametrize("agreement", [1, 2, None])
def test_agreement_with_the_flow_proves_criteria_2_to_4_where_delta_j_is_open(
    number: int, agreement: int | None
) -> None:
    found = judge(number, made_proof(convergence_order=agreement), [])
    assert found.verdict is PROVED
    least = 13 if agreement is None else agreement + 1
    assert f"O(h^{ {2: least, 3: 2 * least, 4: least - 1}[number] })" in found.evidence


# -- by slope -------------------------------------------------------------------------------------

OPEN = made_proof()
Shape = Callable[[Fraction], Given]


def runs_of(step_sizes: Any = STEP_SIZES, start: str = "1", **shapes: Shape) -> list[RunResult]:
    """One run a step size, its values by functions of h."""
    return [
        made_run(h, {("lambda" if n == "lam" else n): f(Fraction(h)) for n, f in shapes.items()},
                 q=start)
        for h in step_sizes
    ]  # fmt: skip


def power_runs(mse: int, lam: int, **options: Any) -> list[RunResult]:
    return runs_of(mse=lambda h: 3 * h**mse, lam=lambda h: -2 * h**lam, **options)


@pytest.mark.parametrize(
    ("mse", "expected"),
    [(6, MEASURED), (4, MEASURED), (2, MEASURED), (1, REFUTED), (0, REFUTED), (-1, REFUTED)],
)
def test_criterion_3_asks_for_a_slope_of_more_than_1(mse: int, expected: Verdict) -> None:
    judged = judge(3, OPEN, power_runs(mse=mse, lam=2))
    assert judged.verdict is expected
    assert f"{mse:.2f}" in judged.evidence


@pytest.mark.parametrize(
    ("lam", "expected"), [(3, MEASURED), (2, MEASURED), (1, MEASURED), (0, REFUTED), (-1, REFUTED)]
)
def test_criterion_4_asks_for_a_slope_of_more_than_0(lam: int, expected: Verdict) -> None:
    assert judge(4, OPEN, power_runs(mse=6, lam=lam)).verdict is expected


def test_lambda_that_tends_to_a_constant_is_not_measured_to_vanish() -> None:
    """With ΔJ = −h on [0, 1], Λ = (1 − h)^(1/h) − 1 → 1/e − 1, and |Λ| grows with h a little."""
    step_sizes = ("0.001", "0.002", "0.004", "0.005", "0.008", "0.01")
    runs = runs_of(step_sizes, lam=lambda h: (1 - h) ** int(1 / h) - 1)
    judged = judge(4, OPEN, runs)
    assert judged.verdict is not MEASURED, judged.evidence


def test_an_mse_of_order_h_is_not_measured_to_be_of_higher_order() -> None:
    judged = judge(3, OPEN, runs_of(mse=lambda h: h * (1 + h)))
    assert judged.verdict is not MEASURED, judged.evidence


@pytest.mark.parametrize("excess", ["0.05", "0.09"])
@pytest.mark.parametrize(("number", "name", "least"), [(3, "mse", 1), (4, "lam", 0)])
def test_a_slope_a_little_above_what_is_asked_for_refutes_nothing(
    number: int, name: str, least: int, excess: str
) -> None:
    """h^1.05 is of higher order than h: to say that it is not would be false."""

    def shape(h: Fraction) -> Given:
        with mpmath.workdps(30):
            base = mpmath.mpf(h.numerator) / h.denominator
            return mpmath.nstr(base ** (least + mpmath.mpf(excess)), 25)

    judged = judge(number, OPEN, runs_of(**{name: shape}))
    assert judged.verdict in (MEASURED, UNDECIDED), judged.evidence


@pytest.mark.parametrize("number", [3, 4])
def test_one_initial_value_that_fails_refutes_for_all(number: int) -> None:
    good, bad = power_runs(mse=6, lam=2), power_runs(mse=1, lam=-1, start="2")
    assert judge(number, OPEN, good).verdict is MEASURED
    assert judge(number, OPEN, good + bad).verdict is REFUTED


@pytest.mark.parametrize("number", [3, 4])
@pytest.mark.parametrize("count", [0, 1, 3])
def test_fewer_than_four_step_sizes_decide_nothing(number: int, count: int) -> None:
    runs = power_runs(mse=6, lam=2, step_sizes=STEP_SIZES[:count])
    assert judge(number, OPEN, runs).verdict is UNDECIDED
    assert judge(number, OPEN, [*runs, *runs]).verdict is UNDECIDED, "a repeated run is no point"


@pytest.mark.parametrize("number", [3, 4])
def test_noise_leaves_a_slope_undecided(number: int) -> None:
    noise = {Fraction(h): Fraction(k % 2 * 60 + 1) for k, h in enumerate(STEP_SIZES)}
    runs = runs_of(mse=lambda h: h**2 * noise[h], lam=lambda h: h * noise[h])
    assert judge(number, OPEN, runs).verdict is UNDECIDED


# -- the plateau ----------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [Fraction(11, 1000), Fraction(1, 2), Fraction(3)])
def test_points_on_the_rounding_plateau_do_not_count(share: Fraction) -> None:
    """Below h = 0.004 only rounding is left: a constant, with a bound of its size."""

    def lam(h: Fraction) -> Given:
        return (Fraction(1, 10**6), share / 10**6) if h < Fraction(4, 1000) else h**2

    slopes = measured_slopes("lambda", runs_of(lam=lam))
    assert len(slopes) == 1
    assert slopes[0][0] == pytest.approx(2, abs=1e-9)
    assert judge(4, OPEN, runs_of(lam=lam)).verdict is MEASURED
    assert judge(4, OPEN, runs_of(lam=lam, step_sizes=STEP_SIZES[:-1])).verdict is UNDECIDED


def test_a_point_with_a_bound_below_one_percent_counts() -> None:
    runs = runs_of(lam=lambda h: (h**2, h**2 / 200))
    assert len(measured_slopes("lambda", runs)) == 1


def test_zeros_unknown_values_and_orbits_that_left_do_not_count() -> None:
    good = power_runs(mse=6, lam=2)
    zero = runs_of(step_sizes=("0.0005",), lam=lambda _: 0)
    unknown = runs_of(step_sizes=("0.0006",), lam=lambda _: (0, 1))
    left = [made_run("0.0007", {}, status="left range", failed_step=3)]
    expected = measured_slopes("lambda", good)
    assert measured_slopes("lambda", [*good, *zero, *unknown, *left]) == expected


def test_each_initial_value_has_its_own_slope() -> None:
    runs = power_runs(mse=6, lam=2) + power_runs(mse=6, lam=3, start="2")
    assert sorted(s for s, _ in measured_slopes("lambda", runs)) == pytest.approx([2, 3])
