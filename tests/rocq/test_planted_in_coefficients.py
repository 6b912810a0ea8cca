"""What is wrong in an export by coefficients is refused: weights, shares, roots, kicks and drifts.

Of kicks and drifts the weights are free: with any of them the step is symplectic.
"""

import pytest

from tests.helpers.rocq.session import Session
from tests.rocq.planted import Planted, check_refused, planted

pytestmark = pytest.mark.left_to_ci

CHECKED, FIT, ROOT, HOLD = "checked", "weights_fit", "there_is_w", "relations_hold"
STEP, AREA = "step_is_symplectic", "area_is_preserved"
EVERYWHERE = "step_is_symplectic_everywhere"
POINT, INTERVAL = ("1 <= w <= 2", "2 <= w <= 3"), ("]%Z (1 # 1) (2 # 1)", "]%Z (2 # 1) (3 # 1)")
B_READ = ("nth i [1 / 2; 1 / 2]", "nth i [1 / 3; 1 / 2]")
B_TOLD = (
    "b : list formula := [(Number (1 # 2))",
    "b : list formula := [(Number (1 # 3))",
)
A_READ = ("[1 / 6 * w + 1 / 4; 1 / 4]]", "[1 / 6 * w + 1 / 3; 1 / 4]]")
A_TOLD = (
    "[(Number (1 # 6) * Name 1 + Number (1 # 4))",
    "[(Number (1 # 6) * Name 1 + Number (1 # 3))",
)
KICK_AT_T = "Kick (1 / 12 * w ^ 2 + 1 / 6 * w + 1 / 3) (V t) (V1 t)"
ERRORS = [
    planted("a weight", "gauss4", CHECKED, B_READ, B_TOLD),
    planted("a weight as it is read", "gauss4", FIT, B_READ),
    planted("an entry of the tableau", "gauss4", CHECKED, A_READ, A_TOLD),
    planted("an entry as it is read", "gauss4", FIT, A_READ),
    planted("a stage less in the theorem", "gauss4", STEP,
            ("near (2 * 1) x (solves_method 1 2 h", "near (2 * 1) x (solves_method 1 1 h")),
    planted("a root of another polynomial", "gauss4", HOLD,
            ("[((Name 1) ^ 2 - Number (3 # 1))", "[((Name 1) ^ 2 - Number (2 # 1))")),
    planted("another equation of the root", "gauss4", ROOT,
            ("w ^ 2 - 3 = 0 /\\", "w ^ 2 - 2 = 0 /\\")),
    planted("an interval that has no root", "gauss4", ROOT, POINT, INTERVAL),
    planted("an interval as it is read", "gauss4", ROOT, POINT),
    planted("a polynomial without a root", "gauss4", ROOT,
            ("[-3; 0; 1]%Z", "[3; 0; 1]%Z", 2), ("w ^ 2 - 3 = 0 /\\", "w ^ 2 + 3 = 0 /\\")),
    planted("another factor", "fit_by_a_root", CHECKED,
            ("(Number (1 # 2))%formula)]; []]", "(Number (1 # 3))%formula)]; []]")),
    planted("another relation", "fit_by_a_root", CHECKED,
            ("[((Name 1) ^ 2 - Number (2 # 1))", "[((Name 1) ^ 2 - Number (5 # 1))"),
            ("w ^ 2 - 2 = 0 ->", "w ^ 2 - 5 = 0 ->"),
            ("w ^ 2 - 2 = 0 /\\ 1 <= w <= 2", "w ^ 2 - 5 = 0 /\\ 1 <= w <= 3"),
            ("[-2; 0; 1]%Z", "[-5; 0; 1]%Z", 2), ("]%Z (1 # 1) (2 # 1)", "]%Z (1 # 1) (3 # 1)")),
    planted("a share", "two_roots", CHECKED, ("share_p := 1 / 3", "share_p := 1 / 2"),
            ("(Number (1 # 3))", "(Number (1 # 2))")),
    planted("a share as it is read", "two_roots", STEP, ("share_p := 1 / 3", "share_p := 1 / 2")),
    planted("a root that is read for the other", "two_roots", STEP,
            ("kick_by := w; drift_by := v", "kick_by := v; drift_by := w")),
    planted("every H for a separable one", "two_roots", CHECKED,
            ("(stage_gaps true)", "(stage_gaps false)")),
    planted("no parts of H", "two_roots", STEP,
            ("(forall t, sum_of_parts 1 (H t)) ->", "True ->", 2)),
    planted("a kick of its own", "implicit_euler", CHECKED,
            ("kick_by := 1", "kick_by := 2"), ("[[(Number (1 # 1))", "[[(Number (2 # 1))")),
    planted("a kick by a function of p", "yoshida4", EVERYWHERE,
            ("[Kick (1 / 12 * w ^ 2 + 1 / 6 * w + 1 / 3) V V1;",
             "[Kick (1 / 12 * w ^ 2 + 1 / 6 * w + 1 / 3) T T1;")),
    planted("slopes of another function", "yoshida4", EVERYWHERE,
            ("Drift (- (1 / 3 * w ^ 2) - 2 / 3 * w - 1 / 3) T T1",
             "Drift (- (1 / 3 * w ^ 2) - 2 / 3 * w - 1 / 3) T V1")),
    planted("a T that depends on q", "yoshida4", EVERYWHERE,
            ("only_momenta 1", "only_positions 1")),
    planted("nothing asked of V and T", "yoshida4", STEP,
            ("shears_of_hamiltonian 1 h (scheme w V T V1 T1) x ->", "True ->", 2)),
    planted("another point than the step's", "yoshida4", STEP,
            ("(step w V T V1 T1 h) x. Proof. intros w E_w V T V1 T1 h x.",
             "(step w V T V1 T1 h) (fun _ => 0). Proof. intros w E_w V T V1 T1 h x.")),
    planted("another determinant", "yoshida4", AREA,
            ("P_p * Q_q - P_q * Q_p = 1", "P_p * Q_q + P_q * Q_p = 1")),
    planted("slopes of another time", "yoshida4_in_time", EVERYWHERE,
            (f"[{KICK_AT_T}", f"[{KICK_AT_T[:-2]}0)")),
]  # fmt: skip


@pytest.mark.sample(9)
@pytest.mark.parametrize("error", ERRORS)
def test_a_planted_error_is_refused(error: Planted, rocq: Session) -> None:
    check_refused(error, rocq)
