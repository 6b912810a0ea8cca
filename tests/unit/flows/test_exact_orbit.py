"""How the exact orbit runs: closed, round, leaving; at any scale. The oracles: closed forms."""

from fractions import Fraction

import mpmath
import pytest

from verify.arithmetic.exact import rational
from verify.flows.exact_orbit import ExactOrbit, exact_orbit
from verify.hamiltonians.hamiltonian import Hamiltonian

HARMONIC = "p**2/2 + w**2*q**2/2"
PENDULUM = "p**2/2 - cos(q)"
CUBIC = "p**2/2 + q**2/2 - q**3/3"


def orbit(text: str, q: str, p: str = "0", time: str = "100", **values: str) -> ExactOrbit:
    hamiltonian = Hamiltonian.parse(text, values)
    return exact_orbit(hamiltonian, rational(p), rational(q), rational(time))


@pytest.mark.parametrize("size", ["1e-300", "1", "1e150"])
@pytest.mark.parametrize("omega", ["1", "1e-3", "1e8"])
def test_an_orbit_closes_at_any_scale(size: str, omega: str) -> None:
    found = orbit(HARMONIC, size, time=f"{100 / Fraction(omega)}", w=omega)
    assert found.kind == "closed"
    assert found.period is not None
    assert abs(found.period * Fraction(omega) - Fraction("6.283")) < Fraction(1, 4)
    assert abs(found.stiffness / Fraction(omega) ** 2 - 1) < Fraction(1, 10**20)
    p, q = found.reach
    assert Fraction(9, 10) < q / rational(size) <= 1
    assert Fraction(9, 10) < p / (rational(size) * Fraction(omega)) <= 1


@pytest.mark.parametrize(
    ("text", "q", "p", "kind"),
    [
        (PENDULUM, "1", "0", "closed"),
        (PENDULUM, "100000000", "1", "closed"),
        (PENDULUM, "0", "3", "rotates"),
        (PENDULUM, "0", "2", "open"),
        (PENDULUM, "0", "0", "at rest"),
        (CUBIC, "1/2", "0", "closed"),
        (CUBIC, "3/2", "0", "escapes"),
        (CUBIC, "1", "0", "at rest"),
        ("p**2/2", "0", "1", "rotates"),
        ("sin(q)", "1", "0", "rotates"),
        ("0*p", "1", "1", "at rest"),
        ("p*q", "1", "1", "escapes"),
        ("(p**2 + q**2)**2/4", "1", "1", "closed"),
        ("p**2/2 + 1/q", "0", "1", "unknown"),
    ],
)
def test_each_kind_of_orbit_is_told(text: str, q: str, p: str, kind: str) -> None:
    assert orbit(text, q, p).kind == kind


def test_only_a_coordinate_that_the_orbit_runs_through_is_without_bound() -> None:
    assert orbit(PENDULUM, "0", "3").turns == (False, True)
    assert orbit(PENDULUM, "1").turns == (False, False)
    assert orbit("sin(q)", "1").turns == (True, False)


def test_a_blow_up_is_told_with_its_time() -> None:
    # q'' = −q + q² from 3/2 at rest: q = 3/2 sec²(t/2), which ends at t = π.
    assert orbit(CUBIC, "3/2").summary == "blows up at t = 3.14159"


def test_before_its_end_a_solution_that_blows_up_is_still_under_way() -> None:
    found = orbit(CUBIC, "3/2", time="1")
    assert found.kind == "open"
    assert found.reach[1] < 2


def test_the_stiffest_point_is_found() -> None:
    assert orbit("p**2/2 + q**2/2 + q**4/4", "1").stiffness == 4  # 1 + 3 q²


@pytest.mark.left_to_ci
def test_near_a_saddle_the_digits_of_the_initial_value_count() -> None:
    # Libration from π − ε has a quarter period near log(8/ε); at the saddle itself nothing moves.
    pi = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")
    found = exact_orbit(
        Hamiltonian.parse(PENDULUM), Fraction(0), pi - Fraction(1, 10**20), Fraction(300)
    )
    assert found.kind == "closed"
    assert found.period is not None
    assert abs(found.period - 4 * Fraction("48.13")) < 2


@pytest.mark.parametrize("q", ["1/10", "1", "2", "3"])
def test_the_period_is_that_of_the_elliptic_integral(q: str) -> None:
    found = orbit(PENDULUM, q).period
    assert found is not None
    true = 4 * mpmath.ellipk(mpmath.sin(mpmath.mpf(float(Fraction(q))) / 2) ** 2)
    assert abs(float(found) / float(true) - 1) < 1e-3
