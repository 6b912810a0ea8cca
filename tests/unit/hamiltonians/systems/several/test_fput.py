"""The Fermi–Pasta–Ulam–Tsingou chain: its equation, its normal modes, and its n."""

import json
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy

import verify
from tests.end_to_end.test_command_line import here
from tests.helpers.textbook_hamiltonians import Example, example, gradients_apart
from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.scene import Scene

FPUT = systems.get("fput")


def textbook(q: Any, p: Any, _: Any, n: Any, alpha: Any, beta: Any) -> Any:
    x = [0, *q, 0]
    assert len(x) == n + 2
    springs = [x[j + 1] - x[j] for j in range(len(x) - 1)]
    return sum(v**2 for v in p) / 2 + sum(
        s**2 / 2 + alpha * s**3 / 3 + beta * s**4 / 4 for s in springs
    )


def somewhere(n: int) -> Example:
    values = {"n": Fraction(n), "alpha": Fraction(3, 7), "beta": Fraction(-2, 5)}
    q = [Fraction((-1) ** k * (k + 2), 2 * k + 3) for k in range(n)]
    p = [Fraction(5 - k, k + 1) for k in range(n)]
    return Example("fput", values, q, p)


@pytest.mark.sample(3)
@pytest.mark.parametrize("n", [2, 3, 5, 16, pytest.param(64, marks=pytest.mark.left_to_ci)])
def test_it_is_the_chain_of_n_masses(n: int) -> None:
    at = somewhere(n)
    assert at.hamiltonian.degrees == n
    assert gradients_apart(at, textbook) < 1e-30


def test_a_wrong_sign_at_the_last_spring_is_seen() -> None:
    def wrong(q: Any, p: Any, t: Any, **values: Any) -> Any:
        return textbook(q, p, t, **values) + 2 * values["alpha"] * q[-1] ** 3 / 3

    assert gradients_apart(somewhere(4), wrong) > 1e-3


@pytest.mark.parametrize("n", [2, 4, 9])
def test_small_oscillations_have_the_normal_modes_of_a_string_of_beads(n: int) -> None:
    potential = FPUT.hamiltonian({"n": n}).exact
    names = [symbol(f"q{k}") for k in range(1, n + 1)]
    at_rest = dict.fromkeys(map(symbol, FPUT.hamiltonian({"n": n}).coordinates), 0)
    stiffness = sympy.hessian(potential, names).subs(at_rest)
    with mpmath.workdps(30):
        matrix = mpmath.matrix(stiffness.tolist())
        for k in range(1, n + 1):
            turn = k * mpmath.pi / (n + 1)
            mode = mpmath.matrix([mpmath.sin(j * turn) for j in range(1, n + 1)])
            apart = matrix * mode - (2 * mpmath.sin(turn / 2)) ** 2 * mode
            assert mpmath.norm(apart) < 1e-25


def test_a_run_of_the_lowest_mode_turns_with_its_frequency() -> None:
    """After half a period of 2 sin(π/10) each mass is at the other side, with n = 4."""
    with mpmath.workdps(30):
        q = [mpmath.nstr(mpmath.sin(j * mpmath.pi / 5) / 10**6, 20) for j in range(1, 5)]
        half = mpmath.pi / (2 * mpmath.sin(mpmath.pi / 10))
        step = mpmath.nstr(half / 400, 25)
    found = verify.run("fput", "yoshida4", parameters={"n": 4, "alpha": 1, "beta": 1}, q=q,
                       p=[0] * 4, step_size=step, steps=400, digits=20)  # fmt: skip
    for k, start in enumerate(q, 1):
        assert abs(float(found.values[f"q{k}"]) + float(start)) < 2e-12
        assert abs(float(found.values[f"p{k}"])) < 2e-12


@pytest.mark.parametrize("n", ["4.5", 0, 1, -3, 65, "1/3", 10**30])
def test_an_n_that_is_no_number_of_masses_is_refused(n: Any) -> None:
    with pytest.raises(InputError, match=r"^parameter n=.*must be a whole number, 2 … 64"):
        FPUT.hamiltonian({"n": n, "alpha": 1, "beta": 0})


def test_an_n_that_is_no_number_is_refused() -> None:
    with pytest.raises(InputError, match=r"^parameter n="):
        FPUT.hamiltonian({"n": "four"})


@pytest.mark.parametrize("n", [4, "4", "4.0", "8/2", Fraction(4)])
def test_n_is_exact_however_it_is_written(n: Any) -> None:
    assert FPUT.hamiltonian({"n": n}) == FPUT.hamiltonian({"n": 4})


@pytest.mark.parametrize("values", [None, {}, {"n": None}, {"n": 3}])
def test_without_n_there_are_the_three_masses_of_its_formula(values: Any) -> None:
    assert FPUT.hamiltonian(values) == Hamiltonian.parse(FPUT.formula)
    assert FPUT.degrees == 3


def test_a_scene_gives_n_among_its_parameters() -> None:
    values: Any = {"n": 5, "alpha": "1/4", "beta": 0}
    scene = Scene(system="fput", parameters=values, schemes=("lie2",))
    assert scene.exact_hamiltonian().degrees == 5
    assert dict(scene.exact_hamiltonian().values) == {"alpha": Fraction(1, 4), "beta": Fraction(0)}


def test_the_command_line_gives_n_as_a_parameter(capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--scheme", "stormer-verlet", "--step-size", "0.1", "--steps", "3", "--q", "1,0,0,0",
             "--p", "0,0,0,0", "--param", "alpha=1/4", "--param", "beta=0"]  # fmt: skip
    status, out, _ = here(capsys, "run", "--system", "fput", "--param", "n=4", *given, "--json")
    assert (status, len(json.loads(out)["q"])) == (0, 4)
    status, _, err = here(capsys, "run", "--system", "fput", "--param", "n=5", *given)
    assert (status, "4 of 5 numbers" in err) == (2, True)
    status, _, err = here(capsys, "run", "--system", "fput", "--param", "n=4.5", *given)
    assert (status, "n=4.5: must be a whole number" in err) == (2, True)


@pytest.mark.parametrize("regime", FPUT.regimes)
def test_h_moves_in_a_run_as_the_order_of_its_scheme_says(regime: str) -> None:
    at = example("fput", regime)
    energies = []
    for steps in (100, 200):
        found = verify.run(at.hamiltonian, "stormer-verlet", q=list(at.q), p=list(at.p),
                           step_size=Fraction(10, steps), steps=steps, digits=20)  # fmt: skip
        end = {x: float(found.values[x]) for x in at.hamiltonian.coordinates}
        start = dict(zip(at.hamiltonian.coordinates, (*at.p, *at.q), strict=True))
        first, last = (at.hamiltonian.exact.subs({symbol(n): x for n, x in z.items()})
                       for z in (start, end))  # fmt: skip
        energies.append(abs(float(last) - float(first)))
    assert energies[0] < 1e-3
    assert 3.5 < energies[0] / energies[1] < 4.5
