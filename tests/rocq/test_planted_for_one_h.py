"""What is wrong in an export for one H is refused where it is said, or where it is calculated."""

import pytest

from tests.helpers.rocq.session import Session
from tests.rocq.planted import Planted, check_refused, planted

pytestmark = pytest.mark.left_to_ci

CHECKED, ORDER, AGREES = "checked", "determinant_has_its_order", "map_agrees_with_flow"
DERIVED, NEAR = "derivatives_of_H", "near_every_solution"
TELESCOPES, SHOWN = "first_coefficient_telescopes", "shown"
# L, G and p' of the pendulum as a person reads them and as formulas; and something else.
L_READ = ("R := - (1 / 2 * sin q * p).", "R := - (1 / 3 * sin q * p).")
L_TOLD = ("(- (Number (1 # 2) * Name 5 * Name 1))", "(- (Number (1 # 3) * Name 5 * Name 1))")
G_READ = ("R := 1 / 2 * cos q.", "R := - (1 / 2 * cos q).")
G_TOLD = ("(Number (1 # 2) * Name 4)%formula)]) |}", "(- (Number (1 # 2) * Name 4))%formula)]) |}")
P_READ = ("- (1 / 2 * cos q * p)]", "1 / 2 * cos q * p]")
P_TOLD = ("(- (Number (1 # 2) * Name 4 * Name 1))", "(Number (1 # 2) * Name 4 * Name 1)")
COSINE = "(Cosine 5, (Name 2))"
SINE = "(Sine 4, (Name 2))"
ERRORS = [
    planted("a coefficient of L", "pendulum_lie2", CHECKED, L_READ, L_TOLD),
    planted("L as it is read", "pendulum_lie2", ORDER, L_READ),
    planted("the sign of G", "pendulum_lie2", CHECKED, G_READ, G_TOLD),
    planted("G as it is read", "pendulum_lie2", TELESCOPES, G_READ),
    planted("a sign of the map", "pendulum_lie2", CHECKED, P_READ, P_TOLD),
    planted("the map as it is read", "pendulum_lie2", AGREES, P_READ),
    planted("H as it is read", "pendulum_lie2", DERIVED, ("p ^ 2 - cos q", "p ^ 2 + cos q")),
    planted("a slope of H as it is read", "pendulum_lie2", DERIVED,
            ("R := sin q.", "R := - sin q.")),
    planted("an order more", "pendulum_lie2", CHECKED,
            ("known := 3", "known := 4"), ("order := Some 3", "order := Some 4")),
    planted("an order less", "pendulum_lie2", CHECKED, ("order := Some 3", "order := Some 2")),
    planted("an order more in the theorem", "pendulum_lie2", ORDER,
            ("L p q * h ^ 3) <= C * Rabs h ^ 4", "L p q * h ^ 4) <= C * Rabs h ^ 5")),
    planted("a bound of an order more", "pendulum_lie2", ORDER,
            ("h ^ 3) <= C * Rabs h ^ 4", "h ^ 3) <= C * Rabs h ^ 5")),
    planted("an agreement more", "pendulum_lie2", CHECKED, ("agreement := 2", "agreement := 3")),
    planted("an agreement more in the theorem", "pendulum_lie2", NEAR,
            ("<= C * Rabs h ^ 3", "<= C * Rabs h ^ 4", 2)),
    planted("an agreement more of the coefficients", "pendulum_lie2", AGREES,
            ("(k < 2)%nat", "(k < 3)%nat")),
    planted("coefficients of another factor", "pendulum_lie2", AGREES,
            ("= INR (k + 1) * nth", "= INR (k + 2) * nth")),
    planted("a flow backwards", "pendulum_lie2", AGREES,
            ("H_p p q * c_q - H_q p q * c_p", "H_q p q * c_p - H_p p q * c_q")),
    planted("another start", "pendulum_lie2", AGREES,
            ("nth 0 (p_coefficients p q) 0 = p", "nth 0 (p_coefficients p q) 0 = q")),
    planted("a time that the flow does not have", "driven_pendulum", AGREES,
            ("c_t + (H_p", "2 * c_t + (H_p")),
    planted("an agreement more in two degrees", "henon_heiles", AGREES,
            ("forall k, (k < 2)%nat ->", "forall k, (k < 3)%nat ->")),
    planted("a coefficient of two degrees as it is read", "henon_heiles", AGREES,
            ("- (2 * q1 * q2)", "- (3 * q1 * q2)")),
    planted("less left out of the map", "pendulum_lie2", ORDER,
            ("h ^ 4 * u h p q", "h ^ 3 * u h p q")),
    planted("a cos that is its own partner", "pendulum_lie2", CHECKED,
            (COSINE, "(Cosine 4, (Name 2))")),
    planted("a sin of another argument", "pendulum_lie2", CHECKED,
            (SINE, "(Sine 4, (Name 1))")),
    planted("a point at which L is 0", "pendulum_lie2", SHOWN, ("[0; 1]%nat", "[0]%nat")),
    planted("another factor", "pendulum_lie3", CHECKED,
            ("[(1%nat, (Number (1 # 6))%formula)]", "[(1%nat, (Number (1 # 5))%formula)]")),
    planted("a factor of another relation", "functions", CHECKED, ("[(1%nat,", "[(0%nat,", 2)),
    planted("no domain", "quotient", DERIVED, ("Prop := q <> 0.", "Prop := True.")),
    planted("another domain", "functions", "is_inside",
            ("(q ^ 2 + 1) <> 0 ->", "(q ^ 2 - 1) <> 0 ->")),
    planted("another domain as it is read", "functions", DERIVED,
            ("(q ^ 2 + 1) <> 0.", "(q ^ 2 - 1) <> 0.")),
    planted("a parameter less", "quotient", CHECKED, ("parameters := 1", "parameters := 0")),
    planted("a clock of another rate", "driven_pendulum", NEAR,
            ("derivable_pt_lim T s 1)", "derivable_pt_lim T s 2)")),
    planted("time that H does not see", "driven_pendulum", TELESCOPES,
            ("G_t + (H_p", "(H_p")),
    planted("another determinant", "duffing_stormer_verlet", "area_is_preserved",
            ("q_next delta h p q) p q 1.", "q_next delta h p q) p q 2.")),
    planted("a coefficient of a map without error", "duffing_stormer_verlet", CHECKED,
            ("- (3 / 2 * delta * p * q ^ 2) -", "- (5 / 2 * delta * p * q ^ 2) -"),
            ("(Number (3 # 2) * Name 4 * Name 1 * (Name 2) ^ 2) -",
             "(Number (5 # 2) * Name 4 * Name 1 * (Name 2) ^ 2) -")),
    planted("an entry of L", "henon_heiles", CHECKED,
            ("(0%nat, 3%nat, p1)", "(0%nat, 3%nat, - p1)"),
            ("(0%nat, 3%nat, (Name 1))", "(0%nat, 3%nat, (- Name 1)%formula)")),
    planted("an entry of L as it is read", "henon_heiles", "defect_has_its_order",
            ("(0%nat, 3%nat, p1)", "(0%nat, 3%nat, - p1)")),
    planted("an entry of G as it is read", "henon_heiles", TELESCOPES,
            ("(0%nat, 3%nat, q1)", "(0%nat, 3%nat, - q1)")),
    planted("another flow", "henon_heiles", TELESCOPES,
            ("lie_derivative_along_flow 2 H_slopes G z (L z).",
             "lie_derivative_along_flow 2 (fun y => map Ropp (H_slopes y)) G z (L z).")),
    planted("another form", "henon_heiles", TELESCOPES,
            ("lie_derivative_along_flow 2 H_slopes G z (L z).",
             "lie_derivative_along_flow 2 H_slopes L z (L z).")),
    planted("a flow of one degree", "henon_heiles", TELESCOPES,
            ("lie_derivative_along_flow 2 H_slopes", "lie_derivative_along_flow 1 H_slopes")),
    planted("degrees fewer", "henon_heiles", CHECKED, ("of_degrees := 2", "of_degrees := 1")),
]  # fmt: skip


@pytest.mark.sample(12)
@pytest.mark.parametrize("error", ERRORS)
def test_a_planted_error_is_refused(error: Planted, rocq: Session) -> None:
    check_refused(error, rocq)
