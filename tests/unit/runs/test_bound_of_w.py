"""The bound of W is near its error for short runs, and grows as it says for long ones.

It takes from M how large M⁻¹ may be.
"""

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Any

import flint
import pytest

from tests.helpers import run_bounds
from tests.helpers.run_bounds import ctx, drawn
from verify import arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs import matrix_growth
from verify.runs.a_posteriori_bound import certify
from verify.runs.digits_on_demand import METHOD_OF_W, difference_of_w
from verify.runs.requested_run import run

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
PENDULUMS = "p1**2/2 + p2**2/2 - cos(q1) - cos(q2) + (q1 - q2)**2/4"
CHAIN = "(p1**2 + p2**2 + p3**2)/2 + q1**2/2 + (q2 - q1)**2/2 + (q3 - q2)**4/4 + q3**2/3"
DRIVEN = "p1**2/2 + p2**2/2 - cos(q1)*(1 + cos(t)/3) + (q1 - q2)**2/2"
W = "symplectic_defect"
CASES = [(HENON, "lie2"), (HENON, "rk4"), (PENDULUMS, "lie2"), (PENDULUMS, "lie1"), (CHAIN, "lie2"),
         (DRIVEN, "explicit-midpoint")]  # fmt: skip


def started(formula: str, scheme: str, h: str, steps: int) -> KernelRun:
    hamiltonian = Hamiltonian.parse(formula)
    n = hamiltonian.degrees
    start = {f"p{k}": Fraction(k, 10) for k in range(1, n + 1)}
    start |= {f"q{k}": Fraction(1, 6 + k) for k in range(1, n + 1)}
    start |= {"h": Fraction(h), "t": Fraction(1, 3)}
    return KernelRun(hamiltonian, scheme, start, steps, frozenset({W}), 0)


@pytest.mark.left_to_ci
@pytest.mark.sample(8)
@pytest.mark.parametrize("name", ["mpfr", "fixed", "mpmath"])
@pytest.mark.parametrize("steps", [1, 10, 100, 1000])
@pytest.mark.parametrize("h", ["1/10", "1/100"])
@pytest.mark.parametrize(("formula", "scheme"), CASES)
def test_the_bound_of_a_short_run_holds_and_is_near_the_error(
    formula: str, scheme: str, h: str, steps: int, name: str
) -> None:
    kernel_run, own = started(formula, scheme, h, steps), arithmetic.get(name, 33)
    outcome = kernel_run.run(own, tangent=True)
    if name == "fixed" and outcome.done < steps:  # M, or the orbit, leaves the format
        return
    assert outcome.done == steps
    certificate = certify(kernel_run, own, outcome)
    near = run_alone(difference_of_w(kernel_run, own, outcome))
    if near is None:  # errors grow too fast for a certificate with so many digits
        assert certificate is None or W not in certificate
        return
    true = kernel_run.run(arithmetic.get("mpfr", 120)).values[W]
    error = abs(outcome.values[W] - true)
    assert error <= near <= max(1000 * error, Fraction(1, 10**50))
    # Half of it would not do: what is said is nearly the error.
    assert not error or error > near / 2
    # Its looseness is why there is another: the certificate's own is far larger.
    assert certificate is None or W not in certificate or certificate[W] >= near


def test_a_mistake_of_w_that_a_loose_bound_would_hide_is_outside() -> None:
    """A W that is off by a part in 10²⁴, of a run to 33 digits: within its certificate, and not
    within what is said."""
    kernel_run, own = started(HENON, "lie2", "1/100", 1000), arithmetic.get("mpfr", 33)
    outcome = kernel_run.run(own, tangent=True)
    near, certificate = (
        run_alone(difference_of_w(kernel_run, own, outcome)),
        certify(kernel_run, own, outcome),
    )
    assert near is not None
    assert certificate is not None
    mistake = abs(outcome.values[W]) / 10**24
    assert near < mistake < certificate[W]


@pytest.mark.parametrize(("steps", "said"), [(1000, True), (1001, False)])
def test_of_a_long_run_the_certificate_is_said(steps: int, said: bool) -> None:
    asked: dict[str, Any] = {"q": ["1/7", "1/8"], "p": ["1/10", "1/5"], "step_size": "1/100"}
    found = run(Hamiltonian.parse(HENON), "lie2", **asked, steps=steps, arithmetic="mpfr",
                digits=12, observables=(W,))  # fmt: skip
    assert found.error_kind == "enclosed"
    assert (found.error_method == METHOD_OF_W) is said


def test_where_the_tangent_map_grows_like_n_the_certificate_grows_like_n_to_the_ninth() -> None:
    """‖M_k‖ = c k: Σ ‖M_k‖² is c² N³/3, and its greatest term c² N²."""

    def bound(steps: int) -> Any:
        noted = drawn(3, 4)
        top = ctx.mpf(steps) ** 2 / 100
        seen = dict(noted.seen) | {"growth_top": top, "growth": top * steps / 3}
        small = ctx.mpf(10) ** -60
        return run_bounds.of_defect(
            replace(
                noted, steps=steps, seen=seen, start=small, state=small, tangent=small,
                second=lambda _: ctx.mpf(1), form=lambda _: (ctx.mpf(1), ctx.mpf(0)),
                of_matrix=ctx.mpf(0), of_entry=ctx.mpf(0),
            )
        )  # fmt: skip

    exponent = ctx.log(bound(10_000) / bound(1000), 10)
    assert abs(exponent - 9) < ctx.mpf("0.05")


@pytest.mark.parametrize(
    "rows",
    [
        [[3, 1], [0, 2]],
        [[3, 1, 0, 1], [0, 2, -1, 1], [1, 0, 3, 0], [1, 1, 0, 2]],
    ],
    ids=["plane", "two-degrees"],
)
def test_the_inverse_of_a_matrix_is_no_larger_than_is_said(rows: list[list[int]]) -> None:
    """‖M⁻¹‖ ≤ ‖M‖/d with d by the Pfaffian, of matrices that are far from symplectic."""
    size = len(rows)
    n = size // 2
    exact = flint.fmpq_mat(size, size, [flint.fmpq(x) for row in rows for x in row])
    columns = [[row[k] for row in rows] for k in range(size)]
    above = [
        sum(u[i] * v[n + i] - u[n + i] * v[i] for i in range(n))
        for u, v in combinations(columns, 2)
    ]
    noted = {
        "growth_top": flint.arb(sum(x * x for row in rows for x in row)),
        "det_low": flint.arb(int(exact.det().p)),
        "form_top": flint.arb(sum(x * x for x in above)),
    }
    least = matrix_growth.least_of(size, noted)
    assert least > 0
    inverse = exact.inv()
    norm = sum(float(int(x.p)) ** 2 / float(int(x.q)) ** 2 for x in inverse.entries()) ** 0.5
    # Frobenius' norm of M⁻¹ is at most twice Euclid's.
    assert norm <= 2 * float((noted["growth_top"].sqrt() / least).upper())
    assert float(exact.det().p) != 1
