"""The change of a first integral of a float64 run, split into truncation and rounding."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest

import verify
from tests.end_to_end.test_command_line import here, json_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.run_start import Start
from verify.scenes.results.integral_parts import IntegralParts
from verify.studies.separation.integral_parts import separate_change

FORMULA, DELTA = "p**2/2 + q**2/2 + delta*q**4/4", "0.3"
KEYS: dict[str, Any] = {"q": "1.1", "p": "0.7", "step_size": "0.07"}
STEPS = 60


def energy(p: Any, q: Any, delta: Any) -> Any:
    return p**2 / 2 + q**2 / 2 + delta * q**4 / 4


def number(x: Fraction) -> Any:
    return mpmath.mpf(x.numerator) / x.denominator


def change_of_taylor2(numbers: dict[str, Fraction]) -> Any:
    """H − H₀ after N steps of lie2, by 50 digits."""
    p, q, h, delta = (number(numbers[n]) for n in ("p", "q", "step_size", "delta"))
    first = energy(p, q, delta)
    for _ in range(STEPS):
        f, g = -q - delta * q**3, (-1 - 3 * delta * q**2) * p
        p, q = p + h * f + h * h / 2 * g, q + h * p + h * h / 2 * f
    return energy(p, q, delta) - first


def split(**more: Any) -> IntegralParts:
    start = Start(
        Hamiltonian.parse(FORMULA, {"delta": DELTA}), "lie2", Fraction(KEYS["step_size"]),
        {"p": Fraction(KEYS["p"]), "q": Fraction(KEYS["q"])}, Fraction(0),
    )  # fmt: skip
    return separate_change(start, STEPS, "energy_error", digits=17, **more)


def test_each_part_is_what_it_stands_for() -> None:
    found = split().values
    orbit = verify.run(FORMULA, "lie2", parameters={"delta": DELTA}, steps=STEPS, **KEYS).orbit
    with mpmath.workdps(50):
        exact = {**{n: Fraction(x) for n, x in KEYS.items()}, "delta": Fraction(DELTA)}
        rounded = {n: Fraction(float(x)) for n, x in exact.items()}
        truncation = change_of_taylor2(exact)
        input_ = change_of_taylor2(rounded) - truncation
        delta = number(rounded["delta"])
        ends = [[number(Fraction(float(orbit.texts(n)[k]))) for n in ("p", "q")] for k in (0, -1)]
        states = energy(*ends[1], delta) - energy(*ends[0], delta)
        true = {"truncation": truncation, "input": input_,
                "trajectory": states - input_ - truncation}  # fmt: skip
        for name, x in true.items():
            value = found[name]
            assert abs(mpmath.mpf(value.value) - x) <= mpmath.mpf(value.bound) + 1e-30, name
            assert abs(mpmath.mpf(value.value)) > 10 * mpmath.mpf(value.bound), name


@pytest.mark.parametrize("arithmetic", ["auto", "mpfr", "fixed"])
def test_the_parts_add_up_to_what_is_printed(arithmetic: str) -> None:
    found = split(arithmetic=arithmetic)
    assert (found.status, found.error_kind) == ("finished", "enclosed")
    parts = [found.values[n] for n in ("truncation", "input", "trajectory", "evaluation")]
    slack = sum((Fraction(x.bound) for x in parts), Fraction(found.values["working"].bound))
    assert abs(sum(x.exact for x in parts) - found.values["working"].exact) <= slack
    rounding = sum(x.exact for x in parts[1:]) - found.values["total"].exact
    assert abs(rounding) <= slack
    assert slack < abs(found.values["truncation"].exact) / 10**15


def test_the_command_splits_integrals_and_refuses_others(
    capsys: pytest.CaptureFixture[str],
) -> None:
    command = ["separate", "--system", "pendulum", "--scheme", "lie2", "--step-size", "0.1",
               "--steps", "20", "--q", "1", "--p", "0"]  # fmt: skip
    status, out, _ = here(capsys, *command, "--keeps", "energy", "--keeps", "p**2", "--json")
    found = json_of(out)["keeps"]
    assert (status, [x["label"] for x in found]) == (0, ["energy", "p**2"])
    assert {"input", "trajectory", "evaluation", "total"} == found[0]["rounding"].keys()
    assert abs(Fraction(found[0]["rounding"]["total"])) < Fraction(1, 10**12)
    status, _, err = here(capsys, *command, "--keeps", "reversible")
    assert status == 2
    assert len(err.splitlines()) == 1
