"""Claims that values depend on step sizes and initial values, and do so alike."""

from fractions import Fraction
from typing import Any

from tests.helpers.constructed.runs import (
    CLAIM,
    FLAT,
    STARTS,
    STEP_SIZES,
    Given,
    check,
    growing,
    made_findings,
    one_changed,
)
from verify.claims.kinds.comparisons.alike import AlikeClaim
from verify.claims.kinds.comparisons.depends import DependsClaim
from verify.scenes.scene import scene_from
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
H = [Fraction(h) for h in STEP_SIZES]
LAST = (H[-1], len(STARTS) - 1)

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


# -- runs that are made by hand -------------------------------------------------------------------


def test_findings_made_by_hand_hold_what_they_are_told() -> None:
    scene = scene_from({"name": "made", "system": "pendulum", "schemes": ["lie2"],
                        "grid": {"time": 20000, "step_sizes": ["0.01"],
                                 "initial_values": [{"q": "1", "p": "0"}]}}, "by hand")  # fmt: skip
    findings = made_findings(scene, growing)
    assert len(findings.runs(scene, "lie2")) == 1
