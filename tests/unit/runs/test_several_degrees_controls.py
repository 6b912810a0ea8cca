"""The rigorous bound in 2n dimensions with its parts left out: the true values are then outside."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import flint
import pytest

from verify import arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.kernels.step import tangent_map
from verify.kernels.stepping import KernelRun
from verify.runs import matrix_growth
from verify.runs.a_posteriori_bound import certify

Patch = pytest.MonkeyPatch
# Errors grow like e^t along p1, q1, while p2, q2 turn around and are coupled to them.
SADDLE = Hamiltonian.parse("p1**2/2 - q1**2/2 + p2**2/2 + q2**2/2 + q1**2*q2/5")
START = {"p1": Fraction(0), "p2": Fraction(1, 3), "q1": Fraction(1, 10**9), "q2": Fraction(1, 7),
         "h": Fraction(1, 10), "t": Fraction(0)}  # fmt: skip
ALL = frozenset({"symplectic_defect_max", "symplectic_defect", "lambda", "delta_j_max", "mse"})
FAR, NEAR = 130, 55  # steps; beyond the second M leaves the range of fixed point


@pytest.fixture
def afresh() -> Iterator[None]:
    """Kernels are made anew, and forgotten afterwards."""
    kernel_for.cache_clear()
    yield
    kernel_for.cache_clear()


def outside(name: str, digits: int, steps: int = FAR) -> set[str]:
    """The values that are not within the bounds of a run of few digits, by one of many."""
    asked = ALL if steps <= NEAR else ALL - {"symplectic_defect"}
    run = KernelRun(SADDLE, "lie2", START, steps, asked, 0)
    own = arithmetic.get(name, digits)
    outcome = run.run(own, tangent=True)
    assert outcome.done == steps
    errors = certify(run, own, outcome)
    assert errors is not None
    assert set(errors) == set(outcome.values)
    true = run.run(arithmetic.get("mpfr", 120)).values
    return {n for n, x in outcome.values.items() if abs(x - true[n]) > errors[n]}


both = pytest.mark.parametrize(("name", "digits"), [("fixed", 33), ("mpfr", 25)])


@pytest.mark.left_to_ci
@both
def test_nothing_is_outside(name: str, digits: int) -> None:
    assert not outside(name, digits)
    assert not outside(name, digits, NEAR)


@pytest.mark.usefixtures("afresh")
def test_a_tangent_map_that_stays_the_identity_is_caught(monkeypatch: Patch) -> None:
    own: Callable[..., list[str]] = tangent_map.statements
    monkeypatch.setattr(tangent_map, "statements", lambda change, names: own(["0"] * 16, names))
    assert outside("fixed", 33) & {"p1", "q1"}


@pytest.mark.usefixtures("afresh")
def test_a_row_that_is_left_out_is_caught(monkeypatch: Patch) -> None:
    own: Callable[..., list[str]] = tangent_map.statements

    def lying(change: Any, names: Any) -> list[str]:
        return own([c if k // 4 else "0" for k, c in enumerate(change)], names)

    monkeypatch.setattr(tangent_map, "statements", lying)
    assert outside("fixed", 33) & {"p1", "q1"}


@both
def test_a_defect_without_the_rounding_of_its_matrix_is_caught(
    name: str, digits: int, monkeypatch: Patch
) -> None:
    own: Callable[..., flint.arb] = matrix_growth.bound_total_defect
    zero = flint.arb(0)

    def lying(motion: Any, **given: Any) -> flint.arb:
        nothing = {"second": zero, "slope": zero, "matrix_rounding": zero, "entry_rounding": zero}
        return own(motion, **given | nothing)

    monkeypatch.setattr(matrix_growth, "bound_total_defect", lying)
    assert outside(name, digits, NEAR) == {"symplectic_defect"}


def test_the_inverse_of_a_matrix_is_no_larger_than_is_said() -> None:
    """‖M⁻¹‖ ≤ ‖M‖/d with d by the Pfaffian, of matrices that are far from symplectic."""
    rows = [[3, 1, 0, 1], [0, 2, -1, 1], [1, 0, 3, 0], [1, 1, 0, 2]]
    exact = flint.fmpq_mat(4, 4, [flint.fmpq(x) for row in rows for x in row])
    columns = [[row[k] for row in rows] for k in range(4)]
    form = [
        [sum(u[i] * v[2 + i] - u[2 + i] * v[i] for i in (0, 1)) for v in columns] for u in columns
    ]
    above = [form[a][b] for a in range(4) for b in range(a + 1, 4)]
    seen = {
        "growth_top": flint.arb(sum(x * x for row in rows for x in row)),
        "det_low": flint.arb(int(exact.det().p)),
        "form_top": flint.arb(sum(x * x for x in above)),
    }
    least = matrix_growth.least_of(4, seen)
    assert least > 0
    inverse = exact.inv()
    size = sum(float(int(x.p)) ** 2 / float(int(x.q)) ** 2 for x in inverse.entries()) ** 0.5
    # Frobenius' norm of M⁻¹ is at most twice Euclid's.
    assert size <= 2 * float((seen["growth_top"].sqrt() / least).upper())
    assert float(exact.det().p) != 1
