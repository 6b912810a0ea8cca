"""What a proof says is 0 of a run is what each observable says of the map, and nothing else."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.kernel_requests import record_kernel_requests
from tests.unit.runs.test_run_exact import HENON, MIXED
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.observables import by_name
from verify.runs import requested_run as runs
from verify.runs.proved_values import prove_observables
from verify.scenes.observables import CLOSED_FORM, names

PLANE = Hamiltonian.parse("p**2/2 - cos(q)")
TWO_DEGREES = Hamiltonian.parse("(p1**2 + p2**2)/2 + q1**2*q2 + q1**2 + q2**2")
QUADRATIC = Hamiltonian.parse("(p1**2 + p2**2)/2 + q1**2 + q1*q2 + q2**2")


def proved(hamiltonian: Hamiltonian, scheme: str) -> set[str]:
    asked = names(planar=hamiltonian.planar)
    found = prove_observables(step_map_of(hamiltonian, scheme), asked, Fraction(1, 10), 10, 20)
    assert set(map(tuple, found.values())) <= {(0, 0)}
    return {*found}


ENERGIES = {"energy_error", "energy_error_max"}


@pytest.mark.parametrize("hamiltonian", [PLANE, TWO_DEGREES])
def test_what_may_be_asked_beside_the_defect_is_not_said_to_be_0(hamiltonian: Hamiltonian) -> None:
    known = proved(hamiltonian, "stormer-verlet")
    assert {"lambda", "lambda_max", "mse", "delta_j_max"} <= known
    assert not known & {*ENERGIES, "lambda_plain"}


def test_what_is_said_to_be_0_is_0_in_a_run_that_steps() -> None:
    """A run of a scheme whose defect is not 0 has none of them at 0, so that 0 says something."""
    known = proved(TWO_DEGREES, "stormer-verlet")
    assert {"symplectic_defect_max", "symplectic_defect"} <= known
    keys = {"q": [1, Fraction(1, 2)], "p": [0, 1], "steps": 5, "digits": 20, "t0": 0}
    asked = {**keys, "step_size": Fraction(1, 10), "observables": sorted(known)}
    kept = runs.run(TWO_DEGREES, "stormer-verlet", **asked)
    lost = runs.run(TWO_DEGREES, "lie2", **asked)
    for name in known:
        assert Fraction(kept.values[name].value) == 0
        assert Fraction(lost.values[name].value) != 0
    assert proved(TWO_DEGREES, "lie2") == set()


PENDULUM_RUN: dict[str, Any] = {"q": 1, "p": "1/3", "step_size": "0.1"}
TWO_DEGREES_RUN: dict[str, Any] = {
    "q": ["1/8", "4/9"], "p": ["3/7", "-2/5"], "step_size": "1/20", "steps": 5, "digits": 25,
    "observables": names(planar=False),
}  # fmt: skip
OF_DEFECT = {*names(planar=False)} - ENERGIES
SYMPLECTIC = {
    **{
        f"plane-{arithmetic}-{steps}": (
            "p**2/2 - cos(q)", "symplectic-euler", arithmetic, PENDULUM_RUN | {"steps": steps},
            {*CLOSED_FORM},
        )
        for arithmetic in ("float64", "mpmath")
        for steps in (1, 50, 20_001)
    },
    "two-degrees-explicit": (HENON, "stormer-verlet", "mpfr", TWO_DEGREES_RUN, OF_DEFECT),
    "two-degrees-implicit": (MIXED, "implicit-midpoint", "mpfr", TWO_DEGREES_RUN, OF_DEFECT),
}  # fmt: skip


@pytest.mark.parametrize("case", SYMPLECTIC.values(), ids=SYMPLECTIC)
def test_where_the_map_is_symplectic_exact_zeros_are_given_that_no_kernel_computes(
    monkeypatch: pytest.MonkeyPatch, case: tuple[str, str, str, dict[str, Any], set[str]]
) -> None:
    formula, scheme, arithmetic, keys, zeros = case
    requests = record_kernel_requests(monkeypatch)
    result = runs.run(Hamiltonian.parse(formula), scheme, arithmetic=arithmetic, points=5, **keys)
    assert all((result.values[n].value, result.values[n].bound) == ("0", "0") for n in zeros)
    assert set(result.exact) == zeros
    # A series is there for the energy alone.
    has_energy = bool(ENERGIES & {*keys.get("observables", ())})
    series = {"extremes"} if has_energy else set()
    assert set().union(*requests) <= {"tangent", *series, *keys.get("observables", ())} - zeros
    assert {(*x.delta_j, *x.lam) for x in result.series} <= {("0",) * 4}
    assert bool(result.series) == has_energy


CONSERVED = [("p**2/2 + q**2/2", "implicit-midpoint"), ("p*q", "gauss4"), ("cos(q)", "lie2"),
             ("exp(p)", "rk4"), (str(QUADRATIC.expression), "gauss6")]  # fmt: skip
NOT_CONSERVED = [("p**2/2 + q**2/2", "lie3"), ("p**2/2 + q**2/2", "stormer-verlet"),
                 ("p**2/2 + q**3/3", "implicit-midpoint"), ("exp(p) + q", "stormer-verlet"),
                 ("p**2/2 + cos(t)*q**2", "implicit-midpoint"),
                 (str(QUADRATIC.expression), "stormer-verlet")]  # fmt: skip


@pytest.mark.parametrize(("formula", "scheme"), CONSERVED)
def test_the_energy_is_kept_where_a_proof_says_so(formula: str, scheme: str) -> None:
    exact = Hamiltonian.parse(formula)
    assert step_map_of(exact, scheme).conserves_energy
    start = {"q": 1, "p": Fraction(1, 2)} if exact.planar else {"q": [1, 2], "p": [0, 3]}
    found = runs.run(exact, scheme, **start, step_size=Fraction(1, 8), steps=9, digits=20,
                     arithmetic="mpfr", observables=sorted(ENERGIES))  # fmt: skip
    assert {*found.exact} == ENERGIES
    assert {found.values[name].value for name in ENERGIES} == {"0"}


@pytest.mark.parametrize(("formula", "scheme"), NOT_CONSERVED)
def test_no_energy_is_said_to_be_kept_that_is_not(formula: str, scheme: str) -> None:
    assert not step_map_of(Hamiltonian.parse(formula), scheme).conserves_energy


def test_each_observable_says_itself_when_it_vanishes() -> None:
    class Keeping:
        preserves_area, conserves_energy = True, False

    class Conserving:
        preserves_area, conserves_energy = False, True

    vanishing = {name for name, each in by_name().items() if each.vanishes(Keeping())}
    assert vanishing == {*by_name()} - {"lambda_plain", *ENERGIES}
    conserved = {name for name, each in by_name().items() if each.vanishes(Conserving())}
    assert conserved == ENERGIES


def harmonic_lambda(eta: int, x: Fraction, steps: int) -> Fraction:
    """|R_η(ix)|^(2N) − 1 for the truncated exponential R_η, exactly."""
    even = odd = Fraction(0)
    term = Fraction(1)
    for n in range(eta + 1):
        term = term * x / n if n else term
        if n % 2:
            odd += term if n % 4 == 1 else -term
        else:
            even += term if n % 4 == 0 else -term
    return (even**2 + odd**2) ** steps - 1


@pytest.mark.parametrize("arithmetic", ["float64", "mpmath"])
@pytest.mark.parametrize("eta", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("steps", [1, 7, 60])
def test_a_constant_delta_j_gives_lambda_in_closed_form(
    monkeypatch: pytest.MonkeyPatch, eta: int, steps: int, arithmetic: str
) -> None:
    requests = record_kernel_requests(monkeypatch)
    harmonic = Hamiltonian.parse("p**2/2 + omega**2*q**2/2", {"omega": "7/3"})
    at = {"q": "0.3", "p": 1, "step_size": "1/7", "steps": steps, "digits": 40}
    result = runs.run(harmonic, f"lie{eta}", **at, arithmetic=arithmetic)
    assert set().union(*requests) <= {"tangent"}
    true = harmonic_lambda(eta, Fraction(1, 3), steps)
    one = harmonic_lambda(eta, Fraction(1, 3), 1)
    expected = {"lambda": true, "delta_j_max": abs(one), "mse": one**2}
    for name, exact in expected.items():
        value = result.values[name]
        assert abs(Fraction(value.value) - exact) <= Fraction(value.bound), name
        assert len(value.value.partition("e")[0].replace(".", "").lstrip("-0")) == 40
    keys = at | {"arithmetic": "mpmath", "observables": ["lambda_plain"]}
    plain = runs.run(harmonic, f"lie{eta}", **keys).values["lambda_plain"]
    assert abs(Fraction(plain.value) - true) <= Fraction(plain.bound)


UNIFORM = [("p**2/2 + q**2/2", "rk4"), ("p**2/2 + q**2/2", "lie2"), ("p*q + q**3/3", "rk4"),
           ("p*q + q**3/3", "explicit-midpoint")]  # fmt: skip


@pytest.mark.parametrize(("formula", "scheme"), UNIFORM)
def test_where_delta_j_is_a_number_its_observables_are_known_without_a_run(
    formula: str, scheme: str
) -> None:
    exact, h = Hamiltonian.parse(formula), Fraction(1, 8)
    asked = ["delta_j_max", "mse", "lambda", "lambda_max"]
    keys = {"q": 1, "p": Fraction(1, 2), "step_size": h, "steps": 9, "digits": 20}
    found = runs.run(exact, scheme, **keys, observables=asked)
    assert set(found.exact) == {*asked}
    plain = runs.run(exact, scheme, **keys, arithmetic="mpfr", observables=["lambda_plain"])
    seen, known = plain.values["lambda_plain"], found.values["lambda"]
    apart = abs(Fraction(known.value) - Fraction(seen.value))
    assert apart <= Fraction(known.bound) + Fraction(seen.bound)
    assert Fraction(known.value) != 0


@pytest.mark.parametrize("formula", ["p**2/2 - cos(q)", "p**2/2 + (1 + cos(t)/3)*q**2/2"])
@pytest.mark.parametrize("scheme", ["rk4", "explicit-midpoint", "lie2"])
def test_a_delta_j_that_changes_from_step_to_step_is_not_called_a_number(
    formula: str, scheme: str
) -> None:
    assert step_map_of(Hamiltonian.parse(formula), scheme).uniform_delta_j is None
