"""|Λ| ≤ c1 h^η + c2 h^(η+1) T: each term of the bound by itself, and of real runs."""

from fractions import Fraction
from math import cos, exp, log1p, sin
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.runs import CLAIM, Given, check, made_findings, made_scene
from verify.claims.claims_file import load_claims
from verify.claims.kinds.comparisons.growth_bound import GrowthBoundClaim
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
T = 20000  # of the runs by hand
SIZES = ("0.01", "0.02")
BELOW = 1 - Fraction(1, 10**9)
HOLDS = {"eta": 2, "c1": "5", "c2": "11"}


def claim(**keys: Any) -> GrowthBoundClaim:
    return GrowthBoundClaim(**CLAIM, kind="growth_bound", **(HOLDS | keys))


def greatest(h: Fraction, _: int) -> dict[str, Given]:
    """Λ that lies closely below the bound that holds."""
    return {"lambda": -BELOW * (5 * h**2 + 11 * h**3 * T)}


def first_term(h: Fraction, _: int) -> dict[str, Given]:
    return {"lambda": -BELOW * 5 * h**2}


def second_term(h: Fraction, _: int) -> dict[str, Given]:
    return {"lambda": BELOW * 11 * h**3 * T}


# -- by hand --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "keys", "expected"),
    [
        (greatest, {}, MEASURED),
        (greatest, {"c1": "4.999"}, REFUTED),
        (greatest, {"c2": "10.999"}, REFUTED),
        (greatest, {"eta": 3}, REFUTED),
        (greatest, {"eta": 1}, MEASURED),
        (first_term, {"c2": "0"}, MEASURED),
        (first_term, {"c1": "4.999", "c2": "0"}, REFUTED),
        (first_term, {"eta": 3, "c2": "0"}, REFUTED),
        (second_term, {"c1": "0"}, MEASURED),
        (second_term, {"c1": "0", "c2": "10.999"}, REFUTED),
        (second_term, {"eta": 3, "c1": "0"}, REFUTED),
    ],
)
def test_each_term_of_the_bound_is_refuted_by_itself_where_it_is_too_small(
    values: Any, keys: dict[str, Any], expected: Verdict
) -> None:
    assert check(claim(**keys), values, step_sizes=SIZES).verdict is expected


@pytest.mark.parametrize("run", [(Fraction(h), start) for h in SIZES for start in range(2)])
def test_one_run_beyond_the_bound_refutes_it(run: tuple[Fraction, int]) -> None:
    def values(h: Fraction, start: int) -> dict[str, Given]:
        return {"lambda": "1" if (h, start) == run else "0"}

    starts = (("1", "0"), ("2", "0"))
    assert (
        check(claim(c1="1", c2="0.01"), values, step_sizes=SIZES, starts=starts).verdict is REFUTED
    )


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (("0.0005", "0.0001"), UNDECIDED),
        (("0.0003", "0.0001"), MEASURED),
        (("0.0007", "0.0001"), REFUTED),
        (("-0.0007", "0.0001"), REFUTED),
    ],
)
def test_a_bound_within_the_error_of_lambda_is_undecided(value: Given, expected: Verdict) -> None:
    result = check(claim(c2="0"), lambda _h, _k: {"lambda": value}, step_sizes=("0.01",))
    assert result.verdict is expected


def test_the_length_of_a_run_is_that_of_its_steps() -> None:
    """Where h does not divide the time, the run ends before it."""
    scene = made_scene(("0.01",), (("1", "0"),))
    for steps, expected in ((300, MEASURED), (299, REFUTED)):
        findings = made_findings(
            scene, lambda h, _: {"lambda": Fraction("2.995") * h**3}, steps=steps
        )
        assert claim(c1="0", c2="1").judge(findings).verdict is expected


def test_the_evidence_names_the_run_that_comes_closest_to_the_bound() -> None:
    def values(h: Fraction, _: int) -> dict[str, Given]:
        return {"lambda": 4 * h**2 if h == Fraction(1, 50) else h**2}

    result = check(claim(c2="0"), values, step_sizes=SIZES, starts=(("1", "0"),))
    assert result.evidence.startswith("|Λ| is at most 8.00e-01 times the bound in 2 runs")
    assert result.details == (
        ("initial value", "h", "T", "|Λ|", "bound"),
        ("q₀ = 1, p₀ = 0", "0.01", "20000", "1.000e-04", "5.000e-04"),
        ("q₀ = 1, p₀ = 0", "0.02", "20000", "1.600e-03", "2.000e-03"),
    )


# -- of a file ------------------------------------------------------------------------------------

FILE = """
[[claim]]
id = "growth"
kind = "growth_bound"
scheme = "lie2"
system = "pendulum"
step_size = 0.1
time = 10
q = 1
p = 0
eta = {eta}
c1 = {c1}
c2 = {c2}
"""


def size_of_lambda() -> float:
    """|Λ| of lie2 by a plain loop in doubles: ΔJ = det J − 1, and 1 + Λ is the product."""
    p, q, h, total = 0.0, 1.0, 0.1, 0.0
    for _ in range(100):
        p_by_p, p_by_q = 1 - h * h / 2 * cos(q), -h * cos(q) + h * h / 2 * p * sin(q)
        q_by_p, q_by_q = h, 1 - h * h / 2 * cos(q)
        total += log1p(p_by_p * q_by_q - p_by_q * q_by_p - 1)
        force, slope = sin(q), cos(q)
        p, q = p - h * force - h * h / 2 * p * slope, q + h * p - h * h / 2 * force
    return abs(exp(total) - 1)


def written(folder: Path, **keys: Any) -> Path:
    path = folder / "claims.toml"
    path.write_text(FILE.format(**(HOLDS | keys)))
    return path


@pytest.mark.parametrize("term", ["c1", "c2"])
@pytest.mark.parametrize(("share", "expected"), [(1.001, Verdict.ENCLOSED), (0.999, REFUTED)])
def test_a_real_run_is_judged_by_either_term_alone(
    tmp_path: Path, term: str, share: float, expected: Verdict
) -> None:
    unit = {"c1": 0.1**2, "c2": 0.1**3 * 10}[term]
    constant = f"{share * size_of_lambda() / unit:.9f}"
    path = written(tmp_path, **({"c1": "0", "c2": "0"} | {term: constant}))
    (result,) = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    assert result.verdict is expected


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"c1": "-1"}, "claims.toml:12: claim growth: c1=-1: "),
        ({"c2": "-0.5"}, "claims.toml:13: claim growth: c2=-0.5: "),
        ({"c1": "nan"}, "claims.toml:12: claim growth: c1: number=nan: "),
        ({"c1": "0", "c2": "0"}, "claims.toml:12: claim growth: c1, c2=0: give one that is not 0"),
        ({"eta": "0"}, "claims.toml:11: claim growth: eta=0: "),
        ({"eta": "2.5"}, "claims.toml:11: claim growth: eta=2.5: "),
        ({"eta": "21"}, "claims.toml:11: claim growth: eta=21: "),
    ],
)
def test_constants_that_bound_nothing_are_refused(
    tmp_path: Path, keys: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError) as error:
        load_claims(written(tmp_path, **keys))
    assert str(error.value).startswith(message)
    assert "\n" not in str(error.value)
