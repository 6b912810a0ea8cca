"""What a run reports: values that were computed elsewhere, honest bounds, runs of parts.

`tests/data/vectors.json` was made with MPFR at 500 bits. The loop with gmpy2 below shares no code
with `verify`. See test_run_range.py for orbits that escape and for series.
"""

import random
from fractions import Fraction
from functools import cache
from math import prod
from typing import Any

import gmpy2
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.paths import vectors
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs import float64_bounds as float_bounds
from verify.runs.float64_bounds import DIRECT_STEPS
from verify.runs.requested_run import run
from verify.scenes.observables import CLOSED_FORM, REPORTED
from verify.scenes.results.run import RunResult

VECTORS = vectors()
VALUES = ("lambda", "mse", "delta_j_max", "q", "p")
vectors = pytest.mark.parametrize("case", VECTORS, ids=["duffing-lie2", "pendulum", "duffing-lie3"])

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")


def run_case(case: dict[str, Any], **options: Any) -> RunResult:
    hamiltonian = Hamiltonian.parse(case["hamiltonian"], case["parameters"])
    return run(hamiltonian, case["scheme"], q=case["q0"], p=case["p0"],
               step_size=case["step_size"], steps=case["steps"], **options)  # fmt: skip


def digits_of(value: str) -> int:
    """How many significant digits are printed."""
    return len(value.partition("e")[0].replace("-", "").replace(".", "").lstrip("0"))


def unit_of(value: str) -> Fraction:
    """The unit of the last printed digit."""
    return Fraction(10) ** (int(value.partition("e")[2]) - digits_of(value) + 1)


# -- against values from elsewhere ----------------------------------------------------------------


@vectors
def test_mpmath_at_50_digits_gives_all_the_digits_of_the_vectors(case: dict[str, Any]) -> None:
    found = run_case(case, arithmetic="mpmath", digits=50)
    assert (found.status, found.error_kind) == ("finished", "enclosed")
    assert set(found.values) == set(VALUES)
    for name in VALUES:
        value, true = found.values[name], Fraction(case[name])
        assert digits_of(value.value) >= 49, name
        error = abs(Fraction(value.value) - true)
        assert error <= unit_of(value.value) + unit_of(case[name]), name
        assert error <= Fraction(value.bound) + unit_of(case[name]), name


@vectors
def test_float64_contains_the_true_value_and_knows_many_digits(case: dict[str, Any]) -> None:
    found = run_case(case, observables=REPORTED)
    known = {name: digits_of(v.value) for name, v in found.values.items()}
    for name in (*VALUES, "lambda_plain"):
        true = Fraction(case["lambda" if name == "lambda_plain" else name])
        value = found.values[name]
        assert abs(Fraction(value.value) - true) <= Fraction(value.bound), name
        assert 2 * Fraction(value.bound) <= 2 * unit_of(value.value), "a printed digit is known"
    assert known["lambda"] >= 9
    assert known["lambda_plain"] >= 3
    assert min(known["mse"], known["delta_j_max"]) >= 9
    assert min(known["q"], known["p"]) >= 8
    assert known["lambda_plain"] < known["lambda"], "the plain way loses what det − 1 cancels"


Loop = dict[str, Fraction]
START = Fraction(3, 2), Fraction(0), Fraction(1, 1000)  # q, p, h


def duffing_loop(
    q: Fraction, p: Fraction, h: Fraction, d: Fraction, marks: list[int]
) -> list[Loop]:
    """lie2 on Duffing by Eq. 19 with ΔJ = 3h³δpq + h⁴(1 + 3δq²)²/4, at 140 bits."""
    found = []
    with gmpy2.context(precision=140):
        q, p, h, d = (gmpy2.mpfr(gmpy2.mpq(x.numerator, x.denominator)) for x in (q, p, h, d))
        h2, h3, h4, d3 = h * h / 2, 3 * d * h**3, h**4 / 4, 3 * d
        lam = mse = top = gmpy2.mpfr(0)
        for k in range(1, max(marks) + 1):
            qq = q * q
            f, g = q * (1 + d * qq), 1 + d3 * qq
            dj = h3 * p * q + h4 * g * g
            lam, mse, top = lam + dj + lam * dj, mse + dj * dj, max(top, abs(dj))
            p, q = p - h * f - h2 * p * g, q + h * p - h2 * f
            if k in marks:
                state = {"lambda": lam, "mse": mse / k, "delta_j_max": top, "q": q, "p": p}
                found.append({n: Fraction(*x.as_integer_ratio()) for n, x in state.items()})
    return found


def broken(found: RunResult, true: Loop) -> dict[str, float]:
    """error / bound of each value whose error is greater than its bound."""
    ratios = {n: abs(Fraction(v.value) - true[n]) / Fraction(v.bound)
              for n, v in found.values.items()}  # fmt: skip
    return {n: float(r) for n, r in ratios.items() if r > 1}


def test_the_loop_of_this_file_agrees_with_the_vectors() -> None:
    (found,) = duffing_loop(*START, Fraction(1), [20000])
    for name, true in ((n, Fraction(VECTORS[0][n])) for n in VALUES):
        assert abs(found[name] - true) <= abs(true) / 10**30, name


def test_estimated_bounds_hold_for_many_steps() -> None:
    (q, p, h), counts = START, [100_000, 200_000]
    for count, true in zip(counts, duffing_loop(*START, Fraction(1), counts), strict=True):
        found = run(DUFFING.with_values({"delta": 1}), "lie2", q=q, p=p, step_size=h, steps=count)
        assert not broken(found, true), f"N = {count}"
        assert min(digits_of(found.values[n].value) for n in CLOSED_FORM) >= 6


@pytest.mark.parametrize(
    ("steps", "count", "direct"),
    [(2_000, 15, DIRECT_STEPS), (4_000, 36, 0)],
    ids=["certified", "compensated"],
)
def test_bounds_hold_for_every_one_of_many_random_runs(
    monkeypatch: pytest.MonkeyPatch, steps: int, count: int, direct: int
) -> None:
    monkeypatch.setattr(float_bounds, "DIRECT_STEPS", direct)
    draw = random.Random(4)  # noqa: S311 - repeatable, not secret
    wrong = []
    for index in range(count):
        q, p = (Fraction(draw.randint(-2000, 2000), 1000) for _ in "qp")
        h, d = Fraction(draw.randint(1, 100), 10007), Fraction(draw.randint(1, 7), 7)
        (true,) = duffing_loop(q, p, h, d, [steps])
        found = run(DUFFING.with_values({"delta": d}), "lie2", q=q, p=p, step_size=h, steps=steps)
        if ratios := broken(found, true):
            wrong.append((index, ratios))
    assert not wrong, f"{len(wrong)} of {count} runs break a bound: {wrong}"


CHAOTIC = [(Fraction(n, 7), Fraction(n * n % 11 - 5, 9)) for n in range(1, 9)]


KICKS: dict[str, Any] = {"step_size": 2, "steps": 300}


@cache
def chaotic(q: Fraction, p: Fraction) -> RunResult:
    return run(PENDULUM, "symplectic-euler", q=q, p=p, **KICKS, arithmetic="mpmath", digits=500)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("arithmetic", ["float64", "mpmath"])
def test_a_chaotic_orbit_is_not_given_digits_that_are_not_known(arithmetic: str) -> None:
    """Symplectic Euler at h = 2 is the standard map with K = 4: a digit is lost a step or two."""
    wrong = []
    for q, p in CHAOTIC:
        true = chaotic(q, p)
        assert digits_of(true.values["q"].value) > 100
        found = run(PENDULUM, "symplectic-euler", q=q, p=p, **KICKS, arithmetic=arithmetic,
                    digits=10)  # fmt: skip
        for n in "qp":
            error = abs(Fraction(found.values[n].value) - Fraction(true.values[n].value))
            if error > Fraction(found.values[n].bound):
                wrong.append((str(q), n, found.values[n], float(Fraction(true.values[n].value))))
    assert not wrong, f"{len(wrong)} of {2 * len(CHAOTIC)} values break their bounds: {wrong}"


# -- composition ----------------------------------------------------------------------------------

SYSTEMS = [DUFFING.with_values({"delta": "7/3"}), PENDULUM, Hamiltonian.parse("p**4/4 + p*q**2")]
starts = st.fractions(min_value=-1, max_value=1, max_denominator=30)


@drawn(40)
@given(
    hamiltonian=st.sampled_from(SYSTEMS),
    scheme=st.sampled_from(["lie1", "lie2", "lie3"]),
    q=starts,
    p=starts,
    h=st.fractions(min_value="1/50", max_value="1/5", max_denominator=50),
    n1=st.integers(1, 30),
    n2=st.integers(1, 30),
)
def test_lambda_over_n1_and_n2_steps_composes(
    hamiltonian: Hamiltonian, scheme: str, q: Fraction, p: Fraction, h: Fraction, n1: int, n2: int
) -> None:
    def go(q: str | Fraction, p: str | Fraction, steps: int) -> dict[str, Fraction]:
        found = run(hamiltonian, scheme, q=q, p=p, step_size=h, steps=steps, arithmetic="mpmath",
                    digits=60)  # fmt: skip
        return {n: Fraction(v.value) for n, v in found.values.items()}

    whole = go(q, p, n1 + n2)
    assume(whole and max(abs(whole["q"]), abs(whole["p"])) < 100)  # lie1 spirals outwards
    first = go(q, p, n1)
    second = go(first["q"], first["p"], n2)
    small, composed = Fraction(1, 10**45), (1 + first["lambda"]) * (1 + second["lambda"]) - 1
    assert abs(whole["lambda"] - composed) <= small * (1 + abs(composed))
    assert abs(whole["q"] - second["q"]) <= small * (1 + abs(second["q"]))
    assert abs(whole["p"] - second["p"]) <= small * (1 + abs(second["p"]))
    top = max(first["delta_j_max"], second["delta_j_max"])
    assert abs(whole["delta_j_max"] - top) <= small * top
    squares = n1 * first["mse"] + n2 * second["mse"]
    assert abs((n1 + n2) * whole["mse"] - squares) <= small * squares


PARTS: dict[str, tuple[str, dict[str, tuple[Any, Any]], dict[str, Any]]] = {
    "one-degree-by-a-number": (
        "p1**2/2 + q1**4/4", {"p**2/2 + q**4/4": ("1/2", "1/3")}, {"steps": 500},
    ),
    "side-by-side": (
        "p1**2/2 + q1**4/4 + p2**2/2 - cos(q2)",
        {"p**2/2 + q**4/4": ("1/2", "1/3"), "p**2/2 - cos(q)": (1, 0)}, {"steps": 100},
    ),
    "in-time-beside-one-at-rest": (
        "p1**2/2 + q1**2*cos(t)/2 + p2**2/2 + q2**2/2",
        {"p**2/2 + q**2*cos(t)/2": ("1/2", "1/3"), "p**2/2 + q**2/2": (0, 0)},
        {"steps": 100, "t0": "1/3"},
    ),
}  # fmt: skip


@pytest.mark.parametrize(("formula", "parts", "more"), PARTS.values(), ids=PARTS)
def test_parts_that_are_not_coupled_run_as_each_does_in_the_plane(
    formula: str, parts: dict[str, tuple[Any, Any]], more: dict[str, Any]
) -> None:
    """det J is the product of theirs, and S has their ΔJ on its diagonal blocks."""
    keys = {"step_size": "1/50", "arithmetic": "mpfr", "digits": 25} | more
    qs, ps = zip(*parts.values(), strict=True)
    whole = run(Hamiltonian.parse(formula), "lie2", q=[*qs], p=[*ps], **keys).values
    planes = [run(Hamiltonian.parse(text), "lie2", q=q, p=p, **keys).values
              for text, (q, p) in parts.items()]  # fmt: skip
    for k, plane in enumerate(planes, 1):
        assert all(whole[f"{name}{k}"].value == plane[name].value for name in "pq")
    products = [Fraction(plane["lambda"].value) for plane in planes]
    changes = [Fraction(plane["delta_j_max"].value) for plane in planes]
    assert abs(Fraction(whole["lambda"].value) - (prod(1 + x for x in products) - 1)) < 1e-24
    assert Fraction(whole["symplectic_defect"].value) == max(map(abs, products))
    assert Fraction(whole["symplectic_defect_max"].value) == max(changes)
    if len(planes) == 1:
        assert all(whole[name].value == planes[0][name].value for name in CLOSED_FORM)
