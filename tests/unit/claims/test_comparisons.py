"""Claims that compare runs with each other, with the exact solution or with a table of its own.

Each kind has a true instance, a planted falsehood, and values too uncertain to tell.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from pydantic import ValidationError

from tests.helpers.constructed.runs import (
    CLAIM,
    FLAT,
    STARTS,
    STEP_SIZES,
    Given,
    check,
    made_findings,
    one_changed,
)
from verify.arithmetic.arb import precision
from verify.claims.check import prepare
from verify.claims.file import load_claims
from verify.claims.findings import Findings
from verify.claims.kinds.comparisons.alike import AlikeClaim
from verify.claims.kinds.comparisons.depends import DependsClaim
from verify.claims.kinds.comparisons.no_pattern import NoPatternClaim
from verify.claims.kinds.comparisons.printed_power import PrintedPowerClaim
from verify.claims.kinds.comparisons.shifted import ShiftedClaim
from verify.claims.kinds.comparisons.solution_error import SolutionErrorClaim
from verify.claims.kinds.comparisons.table_until import TableUntilClaim
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.flows.solution import exact_solution
from verify.hamiltonians import systems
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import scene_from
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
H = [Fraction(h) for h in STEP_SIZES]
LAST = (H[-1], len(STARTS) - 1)


def growing(h: Fraction, k: int) -> dict[str, Given]:
    """Like lie2's: MSE and Λ grow with h, and from start to start."""
    size = k + 1
    return {"mse": h**6 * size, "lambda": -(h**3) * size, "delta_j_max": h**3 * size}


# -- depends --------------------------------------------------------------------------------------


def depends(*on: Any) -> DependsClaim:
    of = ("mse", "abs_lambda", "delta_j_max")
    return DependsClaim(**CLAIM, kind="depends", of=of, on=on or ("step_size", "initial_value"))


def test_values_that_are_apart_by_more_than_their_bounds_depend() -> None:
    assert check(depends(), growing).verdict is MEASURED
    assert check(depends(), lambda _h, _k: FLAT).verdict is REFUTED


def test_what_depends_on_one_alone_is_refuted_of_the_other() -> None:
    def by_step_size(h: Fraction, _k: int) -> dict[str, Given]:
        return growing(h, 0)

    assert check(depends("step_size"), by_step_size).verdict is MEASURED
    assert check(depends("initial_value"), by_step_size).verdict is REFUTED


def test_values_whose_bounds_overlap_are_not_told_apart() -> None:
    wide: dict[str, Given] = {name: (given, "1") for name, given in FLAT.items()}
    assert check(depends(), lambda _h, _k: wide).verdict is UNDECIDED


# -- alike ----------------------------------------------------------------------------------------


def alike() -> AlikeClaim:
    return AlikeClaim(**CLAIM, kind="alike", quantity="mse")


def test_a_pattern_is_alike_where_all_go_one_way_up_or_down() -> None:
    def falling(h: Fraction, k: int) -> dict[str, Given]:
        return {**FLAT, "mse": (k + 1) / h}

    assert check(alike(), growing).verdict is MEASURED
    assert check(alike(), falling).verdict is MEASURED


def test_one_initial_value_that_goes_another_way_refutes_that_they_are_alike() -> None:
    assert check(alike(), one_changed(LAST, "mse", H[-1] ** 7, growing)).verdict is REFUTED
    wide = one_changed(LAST, "mse", ("0", "1"), growing)
    assert check(alike(), wide).verdict is UNDECIDED


# -- a table of a time that is not told -----------------------------------------------------------

ROW = ["-7.3010", "-7.0000", "-6.6990", "-6.5229", "-6.3979", "-6.3010"]


def until(*row: str) -> TableUntilClaim:
    return TableUntilClaim(**CLAIM, kind="table_until", step_sizes=STEP_SIZES, printed=row)


def test_a_row_above_the_greatest_square_is_wrong_for_every_shorter_time() -> None:
    found = check(until(*ROW), growing)
    assert found.verdict is REFUTED
    assert found.evidence.startswith("18 of 18 printed values")


def test_a_row_that_a_shorter_run_might_have_is_not_refuted() -> None:
    """lg (max ΔJ²) is −12 at the least step size from the first start: 2·10⁻¹³ may be a mean."""
    below = ["-18.3", "-17", "-16", "-15", "-14", "-13"]
    assert check(until(*below), growing).verdict is UNDECIDED
    assert check(until(*below[:5], "-7"), growing).verdict is REFUTED


def test_a_greatest_square_that_is_not_known_refutes_nothing() -> None:
    unknown: dict[str, Given] = {**FLAT, "delta_j_max": ("0", "1")}
    assert check(until(*ROW), lambda _h, _k: unknown).verdict is UNDECIDED


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


# -- the error of the solution --------------------------------------------------------------------


START = ("1.5", "0")  # its reach in q is 1.5, nearly
ONE = {"step_sizes": ["0.01"], "starts": [START]}


def at_end(off: str, *starts: tuple[str, str]) -> Callable[[Fraction, int], dict[str, Given]]:
    """p and q of the exact pendulum at the end, q off by so much."""
    exact = systems.get("pendulum").hamiltonian()

    def values(h: Fraction, k: int) -> dict[str, Given]:
        q, p = (Fraction(x) for x in (starts or (START,))[k])
        time = (20000 // h) * h
        found = exact_solution(exact, p=p, q=q, time=time, digits=15)
        return {**FLAT, "p": found.p, "q": found.q + Fraction(off)}

    return values


def solution_error(**keys: Any) -> SolutionErrorClaim:
    return SolutionErrorClaim(**CLAIM, kind="solution_error", **keys)


@pytest.mark.parametrize(
    ("off", "keys", "expected"),
    [
        ("0.1", {"within": "0.1"}, MEASURED),
        ("0.1", {"within": "0.05"}, REFUTED),
        ("0.1", {"beyond": "0.05"}, MEASURED),
        ("0.1", {"beyond": "0.1"}, REFUTED),
        ("0", {"within": "1e-9"}, MEASURED),
    ],
)
def test_an_error_is_measured_by_the_orbits_reach(
    off: str, keys: dict[str, str], expected: Verdict
) -> None:
    assert check(solution_error(**keys), at_end(off), **ONE).verdict is expected


def test_some_error_and_every_error_are_told_apart() -> None:
    """Off by 0.1, which is more than the whole reach of the orbit from (0.1, 0)."""
    two = {"step_sizes": ["0.01"], "starts": STARTS[:2]}
    for quantifier, expected in (("every", REFUTED), ("some", MEASURED)):
        claim = solution_error(within="0.1", quantifier=quantifier)
        assert check(claim, at_end("0.1", *STARTS), **two).verdict is expected


def test_an_error_within_its_bounds_is_undecided() -> None:
    def wide(h: Fraction, k: int) -> dict[str, Given]:
        exact = at_end("0")(h, k)
        return {**exact, "q": (exact["q"], "1")}

    assert check(solution_error(within="0.1"), wide, **ONE).verdict is UNDECIDED


def test_an_error_is_within_or_beyond_one_number() -> None:
    with pytest.raises(ValidationError, match="give one of the two"):
        solution_error()
    with pytest.raises(ValidationError, match="give one of the two"):
        solution_error(within="1", beyond="1")


# -- counted from 1 -------------------------------------------------------------------------------

FIXED = {"q": Fraction(1), "p": Fraction(0)}


def shifted(*again: dict[str, Any]) -> ShiftedClaim:
    return ShiftedClaim(**CLAIM, kind="shifted", again=again)


MONOTONE = {"kind": "monotone", "quantity": "abs_lambda", "direction": "increases"}


def test_a_verdict_that_one_step_more_or_less_does_not_change() -> None:
    def values(h: Fraction, k: int) -> dict[str, Given]:
        return {**growing(h, k), "lambda": h * (k + 1), **FIXED}

    found = check(shifted(MONOTONE), values)
    assert found.verdict is MEASURED
    assert "1 of 1 verdicts are the same" in found.evidence


def test_a_verdict_that_hangs_on_one_step_is_refuted() -> None:
    """ΔJ of the pendulum is about h⁴/4 at the ends: Λ of that size turns with the count."""

    def values(h: Fraction, k: int) -> dict[str, Given]:
        return {**growing(h, k), "lambda": Fraction("1e-10") + h * Fraction("1e-16"), **FIXED}

    found = check(shifted(MONOTONE), values)
    assert found.verdict is REFUTED
    assert "0 of 1 verdicts are the same" in found.evidence


def test_the_other_count_is_that_of_the_run_itself_one_step_on(tmp_path: Any) -> None:
    """Λ and MSE over z_1 … z_N, by a run of N steps that starts at z_1."""
    from verify.claims.kinds.comparisons import shifted as module
    from verify.runs.run import run
    from verify.studies.kinds.grid import grid_task

    exact, steps = systems.get("pendulum").hamiltonian(), 50
    scene = scene_from(
        {"name": "made", "system": "pendulum", "schemes": ["lie2"],
         "grid": {"steps": steps, "step_sizes": ["0.1"], "initial_values": [{"q": "1", "p": "0"}]}},
        "by hand",
    )  # fmt: skip
    task = grid_task(scene, "lie2", Fraction(1, 10), 0)
    first = run(exact, "lie2", q=1, p=0, step_size="0.1", steps=steps, digits=25)
    onward = run(exact, "lie2", q=1, p=0, step_size="0.1", steps=1, digits=30)
    later = run(
        exact, "lie2", q=onward.values["q"].value, p=onward.values["p"].value,
        step_size="0.1", steps=steps, digits=25,
    )  # fmt: skip
    findings = Findings({"made": scene}, {task.key: first})
    with precision():
        changed, _ = module._shifted(findings, [task], exact, "lie2")
    for name in ("lambda", "mse"):
        by_shift = Fraction(changed[task.key].values[name].value)
        assert abs(by_shift / Fraction(later.values[name].value) - 1) < Fraction(1, 10**15)
        assert abs(by_shift / Fraction(first.values[name].value) - 1) > Fraction(1, 10**6)


@pytest.mark.parametrize(
    ("table", "problem"),
    [
        ({"kind": "order", "order": 3}, "is no kind of claim on runs"),
        ({"kind": "monotonous"}, "is no kind of claim on runs"),
        ({"kind": "shifted", "again": []}, "is no kind of claim on runs"),
        ({**MONOTONE, "quantity": "delta_j_max"}, "is not made of lambda and mse"),
    ],
)
def test_only_claims_on_lambda_and_mse_are_made_again(table: dict[str, Any], problem: str) -> None:
    with pytest.raises(ValidationError, match=problem):
        shifted(table)


# -- no pattern -----------------------------------------------------------------------------------

PATTERN = """
[[claim]]
id = "c"
kind = "no_pattern"
scheme = "{scheme}"
system = "duffing"
parameters = {{ delta = 1 }}
step_sizes = [0.01, 0.02]
initial_values = [{{ q = 0.5, p = 0 }}, {{ q = 0, p = 1.5 }}]
time = 20
within = {within}
"""


@pytest.mark.parametrize(
    ("scheme", "within", "expected"), [("lie2", "0.1", REFUTED), ("lie2", "1e-9", UNDECIDED)]
)
def test_values_that_follow_their_growth_law_have_a_pattern(
    tmp_path: Any, scheme: str, within: str, expected: Verdict
) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(PATTERN.format(scheme=scheme, within=within))
    found = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    assert [claim.verdict for claim in found] == [expected]


@pytest.mark.left_to_ci
def test_values_that_do_not_follow_the_law_are_not_refuted(tmp_path: Any) -> None:
    """The same runs with another Λ at the end of one of them."""
    path = tmp_path / "claims.toml"
    path.write_text(PATTERN.format(scheme="lie2", within="0.1"))
    check_ = prepare(load_claims(path))
    (claim,) = check_.claims
    assert isinstance(claim, NoPatternClaim)
    store = Store(None)
    check_.run(store, where=THIS_PROCESS)
    from verify.execution.execute import execute
    from verify.scenes.results.run import RunResult

    results = dict(execute(check_.plan, store, where=THIS_PROCESS))
    key = next(k for k, each in results.items() if isinstance(each, RunResult))
    run = results[key]
    assert isinstance(run, RunResult)
    lam = run.values["lambda"]
    doubled = lam.model_copy(update={"value": f"{float(lam.value) * 2:.12f}"})
    values = {**run.values, "lambda": doubled}
    results[key] = run.model_copy(update={"values": values})
    assert claim.judge(Findings(check_.file.scenes, results)).verdict is UNDECIDED


def test_findings_made_by_hand_hold_what_they_are_told() -> None:
    scene = scene_from({"name": "made", "system": "pendulum", "schemes": ["lie2"],
                        "grid": {"time": 20000, "step_sizes": ["0.01"],
                                 "initial_values": [{"q": "1", "p": "0"}]}}, "by hand")  # fmt: skip
    findings = made_findings(scene, growing)
    assert len(findings.runs(scene, "lie2")) == 1
