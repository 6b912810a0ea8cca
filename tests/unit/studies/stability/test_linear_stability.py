"""Stability intervals on the harmonic oscillator, against known ones and against powers of M."""

import math
from fractions import Fraction

import numpy as np
import pytest
import sympy

from tests.helpers.maps import by_formulas
from verify import schemes
from verify.algebra.enclosure import enclose
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.step_map import StepMap
from verify.studies.stability import linear_stability as linear
from verify.studies.stability.linear_stability import Y, stability_of_map
from verify.studies.stability.scheme_interval import linear_stability

KNOWN = {
    "lie1": 0, "lie2": 0, "lie3": sympy.sqrt(3), "lie4": 2 * sympy.sqrt(2), "lie5": 0, "lie6": 0,
    "euler": 0, "explicit-midpoint": 0, "rk4": 2 * sympy.sqrt(2), "symplectic-euler": 2,
    "stormer-verlet": 2, "position-verlet": 2, "implicit-midpoint": sympy.oo, "gauss4": sympy.oo,
    "gauss6": sympy.oo, "implicit-symplectic-euler": 2,
}  # fmt: skip
# Limits of Taylor schemes on the imaginary axis, to the digits of the literature.
PRINTED = {"lie7": 1.7644, "lie8": 3.3951, "yoshida4": 1.5734}
HARMONIC = Hamiltonian.parse("p**2/2 + q**2/2")


@pytest.mark.parametrize("name", KNOWN)
def test_the_interval_is_the_known_one(name: str) -> None:
    assert linear_stability(name).interval == KNOWN[name]


@pytest.mark.parametrize("name", PRINTED)
def test_the_interval_has_the_digits_that_are_printed_elsewhere(name: str) -> None:
    assert abs(float(linear_stability(name).decimal()) - PRINTED[name]) < 1e-4


def excess(eta: int, y: Fraction) -> Fraction:
    """|R(iy)|² − 1 of the truncated exponential, exactly."""
    real = sum((-1) ** (n // 2) * y**n / math.factorial(n) for n in range(0, eta + 1, 2))
    imaginary = sum((-1) ** (n // 2) * y**n / math.factorial(n) for n in range(1, eta + 1, 2))
    return Fraction(real) ** 2 + Fraction(imaginary) ** 2 - 1


@pytest.mark.sample(5)
@pytest.mark.parametrize("eta", range(1, 21))
def test_taylor_schemes_are_stable_up_to_there_and_not_beyond(eta: int) -> None:
    found = linear_stability(f"lie{eta}")
    if found.interval == 0:
        assert all(excess(eta, Fraction(1, n)) > 0 for n in (1, 2, 10, 1000))
        return
    end = Fraction(found.decimal(40))
    assert all(excess(eta, end * Fraction(n, 1000)) < 0 for n in range(1, 1000, 7))
    assert excess(eta, end * Fraction(999_999, 10**6)) < 0
    assert excess(eta, end * Fraction(1_000_001, 10**6)) > 0


BOUNDED = ["stormer-verlet", "yoshida4", "symplectic-euler", "rk4", "lie3", "ruth3", "suzuki4",
           "mclachlan-atela2", "mclachlan4", "mclachlan4-s4"]  # fmt: skip


@pytest.mark.parametrize("name", BOUNDED)
def test_powers_of_the_matrix_stay_bounded_inside_and_grow_outside(name: str) -> None:
    found = linear_stability(name)
    step = schemes.get(name).step_map(HARMONIC)
    matrix = sympy.lambdify(sympy.Symbol("h", real=True), step.jacobian)
    end = float(found.decimal())
    # `mclachlan4` is stable again a little farther on.
    for share, grows in ((0.4, False), (0.98, False), (1.05, True)):
        numbers = np.array(matrix(share * end), dtype=float)
        size = np.linalg.norm(np.linalg.matrix_power(numbers, 400))
        assert bool(size > 1e3) is grows, (share, size)


def test_the_determinant_is_what_the_proof_gives() -> None:
    assert sympy.expand(linear_stability("lie2").delta_j - Y**4 / 4) == 0
    assert linear_stability("yoshida4").delta_j == 0


def test_a_root_that_is_no_radical_is_named_by_its_polynomial() -> None:
    found = linear_stability("lie7")
    assert found.exact == "positive root 1 of y**6 - 35*y**4 + 504*y**2 - 1260"
    polynomial = Y**6 - 35 * Y**4 + 504 * Y**2 - 1260
    assert abs(polynomial.subs(Y, sympy.Float(found.decimal(40), 40))) < 1e-30


def test_schemes_of_high_order_end_at_the_same_root_by_bisection() -> None:
    """The roots of `lie99`, which sympy isolates in minutes, take seconds; these are fewer."""
    found = Fraction(linear_stability("lie51").decimal(30))
    low, high = found - Fraction(1, 10**28), found + Fraction(1, 10**28)
    assert excess(51, low) < 0 < excess(51, high)


@pytest.mark.parametrize(
    ("p_next", "q_next", "end"),
    [
        ("p - h*q", "q + h*p", 0),  # det 1 + y²
        ("p - h*q", "q + h*p_next*(1 + h**2/1000)", None),  # a little off symplectic Euler
        ("p", "q", sympy.oo),
        ("-p", "-q*(1 + (1 - h)**2*0)", sympy.oo),
        ("p*(1 + h*(h - 1))", "q", 1),  # det ≤ 1 just for y ≤ 1
    ],
)
def test_maps_of_ones_own(p_next: str, q_next: str, end: object) -> None:
    found = stability_of_map("own", by_formulas(HARMONIC, p_next, q_next))
    if end is None:
        assert 1.9 < float(found.decimal()) < 2
    else:
        assert found.interval == end


@pytest.mark.parametrize("name", ["kick 1", "drift 1", "kick 1; drift 0"])
def test_a_shear_is_stable_for_no_step_as_its_powers_grow(name: str) -> None:
    assert linear_stability(name).interval == 0
    nothing = linear_stability("kick 1; kick -1; drift 0")
    assert nothing.interval == sympy.oo  # the identity, of the same trace and determinant


def test_what_is_not_linear_is_refused() -> None:
    with pytest.raises(InputError, match="not linear"):
        stability_of_map("own", by_formulas(HARMONIC, "p - h*q**2", "q"))


# -- by the product of the parts' matrices --------------------------------------------------------

COMPOSED = [
    "symplectic-euler", "stormer-verlet", "yoshida4", "ruth3", "suzuki4", "mclachlan-atela2",
    "mclachlan4", "blanes-moan4", "kick 1", "kick 1; kick -1; drift 0", "kick 1; drift 0",
    "kick 1/3; drift sqrt(2); kick 2/3; drift 1 - sqrt(2)", "kick 2**(1/3); drift sqrt(3)",
]  # fmt: skip


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", COMPOSED)
def test_the_product_of_the_parts_gives_what_the_closed_form_does(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    by_product = linear_stability(name)
    monkeypatch.setattr(linear, "_stability_by_product", lambda *_: None)
    by_closed_form = linear_stability(name)
    assert by_product == by_closed_form
    assert by_product.exact == by_closed_form.exact


def test_a_wrong_product_gives_another_interval(monkeypatch: pytest.MonkeyPatch) -> None:
    right = linear.parts_of

    def without_the_last(step: StepMap) -> tuple[ClosedForm, ...]:
        parts = right(step)
        assert parts is not None
        return parts[:-1]

    assert linear_stability("stormer-verlet").interval == 2
    monkeypatch.setattr(linear, "parts_of", without_the_last)
    assert linear_stability("stormer-verlet").interval == 2 * sympy.sqrt(2)


def splitting_of(parts: int) -> str:
    """A splitting with so many rational parts that none is like another."""
    sizes = [Fraction(1 + n % 7, 20 + n) for n in range(parts)]
    kinds = ("kick", "drift")
    return "; ".join(f"{kinds[n % 2]} {size}" for n, size in enumerate(sizes))


def largest_power(name: str, y: float) -> float:
    """The size of a high power of the matrix, in floats, from the coefficients in the name."""
    total = np.eye(2)
    for part in name.split(";"):
        kind, size = part.split()
        shear = np.eye(2)
        shear[(0, 1) if kind == "kick" else (1, 0)] = float(Fraction(size)) * y
        shear[0, 1] *= -1
        total = shear @ total
    return float(np.linalg.norm(np.linalg.matrix_power(total, 2000)))


@pytest.mark.parametrize("parts", [30, 81])
def test_a_splitting_of_many_parts_ends_where_powers_of_its_matrix_grow(parts: int) -> None:
    name = splitting_of(parts)
    end = float(linear_stability(name).decimal())
    assert largest_power(name, 0.999 * end) < 1e4
    assert largest_power(name, 1.001 * end) > 1e8


def test_algebraic_coefficients_of_degree_fifteen_end_at_a_root_of_the_trace() -> None:
    found = linear_stability("triple-jump6")
    made = linear.matrix_of_step(schemes.get("triple-jump6").step_map(HARMONIC))
    assert made is not None
    ring, (a, _, _, e) = made
    point = {"p": Fraction(0), "q": Fraction(0), "h": Fraction(found.decimal(60))}
    near = enclose(ring, a + e, point, 400)
    assert near is not None
    with working_precision(400):
        assert abs(abs(near) - 2) < 1e-50
    assert found.delta_j == 0


def test_a_number_that_is_not_algebraic_has_no_product() -> None:
    step = schemes.get("kick pi; drift 1").step_map(HARMONIC)
    made = linear.matrix_of_step(step)
    assert made is not None
    ring, (a, _, _, e) = made
    assert linear.ring_polynomial(ring, a + e - 2) is None


def test_many_parts_of_a_field_of_high_degree_are_refused_at_once() -> None:
    sizes = [f"sqrt({(2, 3, 5, 7)[n % 4]})/{n + 9} + 2**(1/3)/{n + 5}" for n in range(81)]
    name = "; ".join(f"{('kick', 'drift')[n % 2]} {size}" for n, size in enumerate(sizes))
    with pytest.raises(InputError, match="too large"):
        linear_stability(name)
