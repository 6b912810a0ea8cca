"""What is wrong in an export for every H is refused where it is said, or where it is calculated."""

import pytest

from tests.helpers.rocq.session import Session
from tests.rocq.planted import Planted, check_refused, planted

pytestmark = pytest.mark.left_to_ci

CHECKED, ORDER = "checked", "determinant_has_its_order"
AGREES, TELESCOPES = "map_agrees_with_flow", "first_coefficient_telescopes"
NUMBER, REALS = "determinant_at_each_number", "determinant_over_the_reals"
FORM_NUMBER, FORM_REALS = "defect_at_each_number", "defect_over_the_reals"
VANISH, KEPT, KEPT_REALS = (
    "coefficients_vanish",
    "area_is_preserved",
    "area_is_preserved_over_the_reals",
)
SHOWN = "shown"
# A term of L, of G and of p', as a person reads it and as formulas; and each with another factor.
L_READ = ("rational (1 # 2) * H_p * H_pp * H_qqq", "rational (1 # 3) * H_p * H_pp * H_qqq")
L_TOLD = (
    "Number (1 # 2) * Name 4 * Name 6 * Name 12",
    "Number (1 # 3) * Name 4 * Name 6 * Name 12",
)
G_READ = ("rational (1 # 2) * H_pp * H_qq -", "rational (1 # 2) * H_pp * H_qq +")
G_TOLD = ("Number (1 # 2) * Name 6 * Name 8 -", "Number (1 # 2) * Name 6 * Name 8 +")
P_READ = ("rational (1 # 2) * H_pq * H_q;", "rational (2 # 3) * H_pq * H_q;")
P_TOLD = ("Number (1 # 2) * Name 7 * Name 5)", "Number (2 # 3) * Name 7 * Name 5)")
ERRORS = [
    planted("a coefficient of L", "every_lie2", CHECKED, L_READ, L_TOLD),
    planted("L as it is read", "every_lie2", ORDER, L_READ),
    planted("a sign of G", "every_lie2", CHECKED, G_READ, G_TOLD),
    planted("G as it is read", "every_lie2", TELESCOPES, G_READ),
    planted("a coefficient of the map", "every_lie2", CHECKED, P_READ, P_TOLD),
    planted("the map as it is read", "every_lie2", AGREES, P_READ),
    planted(
        "an order more", "every_lie2", CHECKED,
        ("known := 3", "known := 4"), ("order := Some 3", "order := Some 4"),
    ),
    planted("an order less", "every_lie2", CHECKED, ("order := Some 3", "order := Some 2")),
    planted("no order at all", "every_lie2", CHECKED, ("order := Some 3", "order := None")),
    planted(
        "an order more in the theorem", "every_lie2", ORDER,
        ("determinant_coefficient P Q 3 == L s", "determinant_coefficient P Q 4 == L s"),
    ),
    planted(
        "no coefficient below an order more", "every_lie2", ORDER, ("(1 <= m < 3)", "(1 <= m < 4)")
    ),
    planted("an order less at a number", "every_lie2", NUMBER,
            ("one + h ^ 3 * L s", "one + h ^ 2 * L s")),
    planted("another L at a number", "every_lie2", NUMBER, ("h ^ 3 * L s +", "h ^ 3 * - L s +")),
    planted("a power more of the rest", "every_lie2", NUMBER,
            ("h ^ 4 * partial_sum K h", "h ^ 5 * partial_sum K h")),
    planted("a coefficient of the rest left out", "every_lie2", NUMBER,
            ("det (4 + k)%nat", "det (5 + k)%nat")),
    planted("what is left out of the map, left out", "every_lie2", NUMBER,
            ("+ h ^ 4 * (bracket K P w + bracket K u Q + h ^ 4 * bracket K u w).", ".")),
    planted("an h that derivations see", "every_lie2", NUMBER,
            ("forall h u w : K, is_constant K h -> let", "forall h u w : K, True -> let")),
    planted("an order less over the reals", "every_lie2", REALS,
            ("value (L s) z * h ^ 3", "value (L s) z * h ^ 2")),
    planted("another L over the reals", "every_lie2", REALS,
            ("- value (L s) z", "+ value (L s) z")),
    planted("a bound of an order more", "every_lie2", REALS,
            ("<= C * Rabs h ^ 4", "<= C * Rabs h ^ 5")),
    planted("less left out of the map", "every_lie2", REALS,
            ("+ h ^ 4 * rest c h y", "+ h ^ 3 * rest c h y")),
    planted("any slopes of what is left out", "every_lie2", REALS,
            ("slopes_bounded 1 rest z ->", "True ->")),
    planted("a point outside", "every_lie2", REALS, ("forall z, U z ->", "forall z, True ->")),
    planted("time in what is meant", "every_lie2", AGREES,
            ("timed := false; separable := false; named_derivatives := Data.derivatives",
             "timed := true; separable := false; named_derivatives := Data.derivatives")),
    planted("an agreement more", "every_lie2", CHECKED, ("agreement := 2", "agreement := 3")),
    planted("an agreement more in the theorem", "every_lie2", AGREES, ("(k <= 2)", "(k <= 3)")),
    planted("two derivatives exchanged", "every_lie2", CHECKED,
            ("[p; p]; [p; q]", "[p; q]; [p; p]")),
    planted(
        "an H for which L is 0", "every_lie2", SHOWN, ("(Number (1 # 6) * (Name 1) ^ 3 +", "(")
    ),
    planted("every H for a separable one", "every_separable", CHECKED,
            ("separable := true", "separable := false", 2)),
    planted("no time for an H with it", "every_in_time", CHECKED,
            ("timed := true", "timed := false", 2)),
    planted(
        "a leading form of other coordinates", "every_two_odd", CHECKED,
        ("(1%nat, 3%nat, (", "(1%nat, 2%nat, ("), ("(1%nat, 3%nat, H", "(1%nat, 2%nat, H"),
    ),
    planted("a form that is read of other coordinates", "every_two_odd", "defect_has_its_order",
            ("(1%nat, 3%nat, H_", "(1%nat, 2%nat, H_")),
    planted("an order less of a form at a number", "every_two_odd", FORM_NUMBER,
            ("h ^ 2 * L s a b", "h ^ 1 * L s a b")),
    planted("another entry at a number", "every_two_odd", FORM_NUMBER,
            ("h ^ 2 * L s a b", "h ^ 2 * L s b a")),
    planted("another entry over the reals", "every_two_odd", FORM_REALS,
            ("value (L s a b) z", "value (L s b a) z")),
    planted("a bound of an order more of a form", "every_two_odd", FORM_REALS,
            ("<= C * Rabs h ^ 3", "<= C * Rabs h ^ 4")),
    planted("a first coefficient of 0", "every_kick", VANISH,
            ("det 0%nat == one", "det 0%nat == zero")),
    planted("all coefficients", "every_kick", VANISH, ("(1 <= m)%nat", "(0 <= m)%nat")),
    planted("another determinant", "every_kick", KEPT,
            ("(q_next s)) == one", "(q_next s)) == zero")),
    planted("another determinant over the reals", "every_kick", KEPT_REALS,
            ("J 1%nat 0%nat = 1)%R.", "J 1%nat 0%nat = 2)%R.")),
    planted("a map that is said to end sooner", "every_kick", VANISH,
            ("member) 2 eq_refl eq_refl", "member) 1 eq_refl eq_refl", 2)),
    planted("entries in another order", "every_kick_of_two", "form_is_preserved_over_the_reals",
            ("defect_entry 2 J a b = 0", "defect_entry 2 J a b = 1")),
    planted("a kick that is longer", "every_kick", "map_agrees_with_flow",
            ("[p; - H_q]", "[p; - H_q; H_q]")),
    planted("a kick by a function of p, too", "every_kick", CHECKED,
            ("(- Name 5)", "(- (Name 5 * Name 4))")),
]  # fmt: skip


@pytest.mark.sample(14)
@pytest.mark.parametrize("error", ERRORS)
def test_a_planted_error_is_refused(error: Planted, rocq: Session) -> None:
    check_refused(error, rocq)
