"""What is wrong with a run's arguments is said before anything runs."""

from typing import Any

import pytest

from tests.helpers.kernel_requests import record_kernel_requests
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
BAD: dict[str, dict[str, Any]] = {
    "h-zero": {"step_size": 0}, "h-negative": {"step_size": "-0.1"}, "h-nan": {"step_size": "nan"},
    "h-inf": {"step_size": float("inf")}, "h-text": {"step_size": "fast"}, "n-zero": {"steps": 0},
    "n-negative": {"steps": -1}, "n-huge": {"steps": 10**13}, "n-float": {"steps": 10.0},
    "n-bool": {"steps": True}, "q-nan": {"q": "nan"}, "p-inf": {"p": float("-inf")},
    "q-none": {"q": None}, "digits-zero": {"digits": 0}, "digits-huge": {"digits": 10**6},
    "observable": {"observables": ["energy"]}, "extremes": {"observables": ["extremes"]},
    "arithmetic": {"arithmetic": "float32"}, "points-negative": {"points": -1},
}  # fmt: skip
HENON = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3")
FIVE = Hamiltonian.parse(" + ".join(f"p{k}**2/2 + q{k}**4" for k in range(1, 6)))
SEVERAL_BAD: dict[str, tuple[Hamiltonian, dict[str, Any], str]] = {
    "q-short": (HENON, {"q": [1], "p": [1, 2]}, "q=1: has 1 of 2 numbers; H is of q1, q2"),
    "p-long": (HENON, {"p": [1, 2, 3]}, "p=1, 2, 3: has 3 of 2 numbers; H is of p1, p2"),
    "q-a-number": (HENON, {"q": "1", "p": [1, 2]}, "q=1: has 1 of 2 numbers"),
    "q-text-in-a-list": (HENON, {"q": ["x", 2], "p": [1, 2]}, "q1=x"),
    "plain-in-two-degrees": (HENON, {"observables": ["lambda_plain"]}, "^observables?="),
    "delta-j": (HENON, {"observables": ["delta_j"]}, "^observables?="),
    "cut-short": (HENON, {"observables": ["symplectic"]}, "^observables?="),
    "five-degrees": (FIVE, {"observables": ["symplectic_defect"]},
                     "symplectic_defect: is for up to 4 degrees of freedom"),
    "defect-in-the-plane": (PENDULUM, {"observables": ["symplectic_defect"]},
                            r"symplectic_defect: is \|lambda\| in one degree"),
}  # fmt: skip
BAD_RUNS = SEVERAL_BAD | {
    name: (PENDULUM, bad, rf"^{next(iter(bad)).removesuffix('s')}s?=") for name, bad in BAD.items()
}


@pytest.mark.parametrize(("hamiltonian", "bad", "problem"), BAD_RUNS.values(), ids=BAD_RUNS)
def test_a_bad_argument_is_named_before_anything_runs(
    monkeypatch: pytest.MonkeyPatch, hamiltonian: Hamiltonian, bad: dict[str, Any], problem: str
) -> None:
    requests, n = record_kernel_requests(monkeypatch, allowed=False), hamiltonian.degrees
    good: dict[str, Any] = {"q": [1] * n, "p": [0] * n} if n > 1 else {"q": 1, "p": 0}
    with pytest.raises(InputError, match=problem) as caught:
        run(hamiltonian, "lie2", **{**good, "step_size": "0.1", "steps": 10, **bad})
    assert "\n" not in str(caught.value)
    assert not requests


def test_what_is_for_few_degrees_is_left_out_of_many_where_nothing_is_asked_for() -> None:
    values = run(FIVE, "lie2", q=[1] * 5, p=[0] * 5, step_size="0.1", steps=2).values
    assert "symplectic_defect_max" in values
    assert "lambda" not in values


def test_a_parameter_without_a_value_is_named() -> None:
    with pytest.raises(InputError, match=r"^parameter=delta: has no value"):
        run(DUFFING, "lie2", q=1, p=0, step_size="0.1", steps=10)
