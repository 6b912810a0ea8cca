"""Claims on numbers that stand alone: printed values, tables, a bound of |Λ|, its growth."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.constructed.runs import CLAIM, Given, made_findings, made_run, made_scene
from verify.claims.base_claim import Findings
from verify.claims.kinds.bounded import BoundedClaim
from verify.claims.kinds.growth import GrowthClaim
from verify.claims.kinds.numbers.value import ValueClaim
from verify.claims.kinds.table import PrintedTableClaim
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
H = Fraction(1, 100)


def on_runs(claim: Any, values: dict[str, Given], *, starts: int = 1) -> ClaimResult:
    """The claim's result where each run at h = 0.01 has these values."""
    scene = made_scene(("0.01",), [(str(k), "0") for k in range(1, starts + 1)])
    return claim.judge(made_findings(scene, lambda h, k: values))


# -- one value ------------------------------------------------------------------------------------


def printed(text: Any, kind: Any = "mse", lg: bool = False) -> ValueClaim:
    key_ = "lg_printed" if lg else "printed"
    return ValueClaim(**CLAIM, kind=kind, **{key_: text})


@pytest.mark.parametrize(
    ("text", "given", "expected"),
    [
        ("1.53e-17", "1.5297518454e-17", MEASURED),
        ("1.5298e-17", "1.5297518454e-17", MEASURED),
        ("1.52e-17", "1.5297518454e-17", REFUTED),
        ("1.5297e-17", "1.5297518454e-17", REFUTED),
        ("1.53e-16", "1.5297518454e-17", REFUTED),
        ("2e-17", "1.5297518454e-17", MEASURED),
        ("0.0000000000000000153", "1.5297518454e-17", MEASURED),
        ("1.5E-17", "1.5297518454e-17", MEASURED),
        ("153e-19", "1.5297518454e-17", MEASURED),
        ("1.53e-17", ("1.5297518454e-17", "1e-19"), UNDECIDED),
        ("1.5e-17", ("1.5297518454e-17", "1e-19"), MEASURED),
        ("1.7e-17", ("1.5297518454e-17", "1e-19"), REFUTED),
        ("1.5", "1.5", MEASURED),
        ("1", "1.5", MEASURED),  # on the border, both are right
        ("2", "1.5", MEASURED),
        ("1.6e-17", ("1.55e-17", "1e-40"), UNDECIDED),
        (0, "0", MEASURED),
        ("1.5e-17", "0", REFUTED),
    ],
)
def test_a_printed_value_is_true_where_the_whole_ball_rounds_to_it(
    text: Any, given: Given, expected: Verdict
) -> None:
    assert on_runs(printed(text), {"mse": given}).verdict is expected


@pytest.mark.parametrize("sign", ["-", "\N{MINUS SIGN}"])
def test_the_sign_of_a_value_counts_and_may_be_a_minus_sign(sign: str) -> None:
    found = {s: on_runs(printed(s + "2.666e-06", "lambda"), {"lambda": "-2.66639e-6"}).verdict
             for s in ("", sign)}  # fmt: skip
    assert found == {"": REFUTED, sign: MEASURED}


@pytest.mark.parametrize(
    ("kind", "given", "text", "expected"),
    [
        ("mse", "1e-17", "-17.0000", MEASURED),
        ("mse", "1.001e-17", "-17.0000", REFUTED),
        ("mse", "1.001e-17", "-16.9996", MEASURED),
        ("mse", "1.001e-17", "\N{MINUS SIGN}17", MEASURED),
        ("mse", ("1e-17", "1e-20"), "-17.0000", UNDECIDED),
        ("mse", ("1e-17", "2e-17"), "-17.0000", UNDECIDED),
        ("mse", "0", "-17.0000", REFUTED),
        ("lambda", "-1e-5", "-5.00", MEASURED),
        ("lambda", "-1e-5", "-5.01", REFUTED),
    ],
)
def test_a_printed_logarithm_is_of_mse_or_of_the_size_of_lambda(
    kind: str, given: Given, text: str, expected: Verdict
) -> None:
    assert on_runs(printed(text, kind, lg=True), {kind: given}).verdict is expected


@pytest.mark.parametrize("place", range(2, 9))
def test_every_digit_that_is_changed_refutes_a_value(place: int) -> None:
    true = "-2.6663913e-06"
    assert on_runs(printed(true, "lambda"), {"lambda": "-2.66639128641007e-6"}).verdict is MEASURED
    at = place + 1 if place > 1 else place
    wrong = true[:at] + str((int(true[at]) + 1) % 10) + true[at + 1 :]
    assert on_runs(printed(wrong, "lambda"), {"lambda": "-2.66639128641007e-6"}).verdict is REFUTED


# -- tables of several rows -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("quantity", "rows", "expected"),
    [
        ("mse", (("2.0e-9",), ("3.0e-9",)), MEASURED),
        ("mse", (("2.0e-9",), ("2.0e-9",)), REFUTED),
        ("mse", (("3.0e-9",), ("2.0e-9",)), REFUTED),
        ("lambda", (("-2e-3",), ("-3e-3",)), MEASURED),
        ("lambda", (("-2e-3",), ("3e-3",)), REFUTED),
        ("lg_mse", (("-8.6990",), ("-8.5229",)), MEASURED),
        ("lg_abs_lambda", (("-2.699",), ("-2.523",)), MEASURED),
        ("lg_abs_lambda", (("-2.699",), ("-2.524",)), REFUTED),
    ],
)
def test_a_table_has_a_row_for_each_initial_value(
    quantity: Any, rows: Any, expected: Verdict
) -> None:
    claim = PrintedTableClaim(**CLAIM, kind="table", quantity=quantity, step_sizes=(H,), rows=rows)
    scene = made_scene(("0.01",), [("1", "0"), ("2", "0")])

    def values(_: Fraction, k: int) -> dict[str, Given]:
        return {"mse": (k + 2) * Fraction(1, 10**9), "lambda": -(k + 2) * Fraction(1, 10**3)}

    assert claim.judge(made_findings(scene, values)).verdict is expected


# -- a bound --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bound", "given", "expected"),
    [
        ("1e-3", "9.9e-4", MEASURED),
        ("0.125", "0.125", MEASURED),
        ("1e-3", "1.0001e-3", REFUTED),
        ("1e-3", ("1e-3", "1e-9"), UNDECIDED),
        ("1e-3", ("9.9e-4", "1e-5"), UNDECIDED),
        ("0", "0", MEASURED),
        ("0", "1e-300", REFUTED),
    ],
)
def test_a_bound_holds_for_the_greatest_lambda(bound: str, given: Given, expected: Verdict) -> None:
    claim = BoundedClaim(**CLAIM, kind="bounded", bound=bound)
    assert on_runs(claim, {"lambda_max": given}).verdict is expected


# -- growth, by hand ------------------------------------------------------------------------------


def growing(growth: Any, *sizes: Given, **run: Any) -> ClaimResult:
    claim = GrowthClaim(**CLAIM, kind="growth", growth=growth)
    scene = made_scene(("0.01",), [("1", "0")])
    runs = [
        made_run(t.step_size, {"lambda_max": size}, steps=t.steps, **run)
        for t, size in zip(claim.tasks(scene), sizes, strict=True)
    ]
    names = [task.key for task in claim.tasks(scene)]
    return claim.judge(Findings({"made": scene}, dict(zip(names, runs, strict=True))))


@pytest.mark.parametrize(
    ("sizes", "bounded", "linear"),
    [
        (("1", "2", "4", "8"), REFUTED, MEASURED),
        (("1", "2.1", "4.1", "8.0"), REFUTED, MEASURED),
        (("1", "1", "1", "1"), MEASURED, REFUTED),
        (("1", "1.05", "1.06", "1.06"), MEASURED, REFUTED),
        (("1", "1.4", "2", "2.8"), UNDECIDED, UNDECIDED),
        (("1", "4", "16", "64"), UNDECIDED, UNDECIDED),
        (("1", "1", "2", "4"), UNDECIDED, UNDECIDED),
        (("0", "0", "0", "0"), UNDECIDED, UNDECIDED),
        (("1", ("2", "1"), "4", "8"), UNDECIDED, UNDECIDED),
        (("1", ("2", "2"), "4", "8"), UNDECIDED, UNDECIDED),
    ],
)
def test_growth_is_read_from_three_doublings(
    sizes: tuple[Given, ...], bounded: Verdict, linear: Verdict
) -> None:
    assert growing("bounded", *sizes).verdict is bounded
    assert growing("linear", *sizes).verdict is linear


def test_growth_of_an_orbit_that_leaves_the_range_is_undecided() -> None:
    found = growing("linear", *"1111", status="left range", failed_step=9)
    assert found.verdict is UNDECIDED
    assert "left the range at step 9" in found.evidence
