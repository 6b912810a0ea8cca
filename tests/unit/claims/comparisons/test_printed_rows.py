"""Rows of printed numbers: of a time that is not told, and powers of the step size in them."""

from fractions import Fraction

import mpmath
import pytest
from pydantic import ValidationError

from tests.helpers.constructed.runs import CLAIM, FLAT, STEP_SIZES, Given, check, growing
from verify.claims.base_claim import Findings
from verify.claims.kinds.comparisons.printed_power import PrintedPowerClaim
from verify.claims.kinds.comparisons.table_until import TableUntilClaim
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

REFUTED, UNDECIDED = Verdict.REFUTED, Verdict.UNDECIDED

# -- a table of a time that is not told -----------------------------------------------------------

ROW = ["-7.3010", "-7.0000", "-6.6990", "-6.5229", "-6.3979", "-6.3010"]


def until(*row: str) -> TableUntilClaim:
    return TableUntilClaim(**CLAIM, kind="table_until", step_sizes=STEP_SIZES, printed=row)


def test_a_row_above_the_greatest_square_is_wrong_for_every_shorter_time() -> None:
    found = check(until(*ROW), growing)
    assert found.verdict is REFUTED
    assert found.evidence.startswith("all 6 printed values, from each of 3 initial values, are")


def test_a_row_that_a_shorter_run_might_have_is_not_refuted() -> None:
    """lg (max ΔJ²) is −12 at the least step size from the first start: 2·10⁻¹³ may be a mean."""
    below = ["-18.3", "-17", "-16", "-15", "-14", "-13"]
    assert check(until(*below), growing).verdict is UNDECIDED
    assert check(until(*below[:5], "-7"), growing).verdict is REFUTED


def test_a_greatest_square_that_is_not_known_refutes_nothing() -> None:
    unknown: dict[str, Given] = {**FLAT, "delta_j_max": ("0", "1")}
    assert check(until(*ROW), lambda _h, _k: unknown).verdict is UNDECIDED


def alone(h: Fraction, _: int) -> dict[str, Given]:
    """The same from every start: max |ΔJ| = h³."""
    return {**FLAT, "delta_j_max": h**3}


@pytest.mark.parametrize("places", [0, 1, 4])
def test_a_value_that_rounds_to_the_greatest_square_is_not_refuted(places: int) -> None:
    """lg (max ΔJ²) = 6 lg h and what is printed may lie half a unit above it."""
    most = [6 * mpmath.log10(mpmath.mpf(h)) for h in STEP_SIZES]
    unit = mpmath.mpf(10) ** -places

    def row(units: int) -> list[str]:
        return [f"{float(mpmath.nint(x / unit + units) * unit):.{places}f}" for x in most]

    assert check(until(*row(0)), alone).verdict is UNDECIDED
    assert check(until(*row(1)), alone).verdict is REFUTED


# -- powers of the step size in printed numbers ---------------------------------------------------


def power(row: list[str], beyond: int = 1) -> ClaimResult:
    claim = PrintedPowerClaim(
        id="c", kind="printed_power", step_sizes=STEP_SIZES, lg_printed=row, beyond_power=beyond
    )
    return claim.judge(Findings({}))


def test_a_printed_row_that_is_a_power_of_h_falls_no_faster_than_it() -> None:
    assert power(ROW).verdict is REFUTED
    assert "-4.3010" in power(ROW).evidence


@pytest.mark.parametrize("place", range(6))
def test_a_row_with_one_other_number_is_not_that_power(place: int) -> None:
    row = [*ROW]
    row[place] = f"{float(row[place]) - 0.0002:.4f}"
    assert power(row).verdict is UNDECIDED


def test_a_row_that_does_fall_faster_is_not_refuted() -> None:
    squares = [mpmath.nstr(2 * mpmath.log10(mpmath.mpf(h)), 6) for h in STEP_SIZES]
    assert power(squares).verdict is UNDECIDED
    assert power(squares, 2).verdict is REFUTED


def test_a_printed_row_has_a_value_for_each_step_size() -> None:
    with pytest.raises(ValidationError, match="lg_printed=5: give 6 values"):
        power(ROW[:5])
