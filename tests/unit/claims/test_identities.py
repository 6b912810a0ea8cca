"""Claims printed by another identity than the one that is computed with, and false ones."""

import pytest

from tests.unit.claims.test_domains import judged
from verify.verdict import Verdict

# H, the printed p' of symplectic Euler, and a false one.
PRINTED = {
    "phase": ("p**2/2-cos(q+pi/6)", "p-h*(cos(q)+sqrt(3)*sin(q))/2", "p-h*(cos(q)-sin(q))/2"),
    "root": ("p**2/2+sqrt(4+4*sinh(q)**2)", "p-2*h*sinh(q)", "p-h*sinh(q)"),
    "logarithm": ("p**2/2+log(8)*q", "p-3*h*log(2)", "p-2*h*log(2)"),
    "denested": ("p**2/2+sqrt(3+2*sqrt(2))*q", "p-h*(1+sqrt(2))", "p-h*(sqrt(2)-1)"),
    "arctangent": ("p**2/2+pi*q", "p-4*h*(atan(1/2)+atan(1/3))", "p-4*h*(atan(2)+atan(3))"),
}  # fmt: skip


@pytest.mark.parametrize("sort", PRINTED)
def test_a_step_map_printed_otherwise_is_proved_and_a_wrong_one_refuted(sort: str) -> None:
    hamiltonian, right, wrong = PRINTED[sort]
    for printed, verdict in ((right, Verdict.PROVED), (wrong, Verdict.REFUTED)):
        keys = {"p_next": printed, "q_next": "q+h*p_next"}
        found = judged(hamiltonian, "step_map", "symplectic-euler", **keys)
        assert found.verdict == verdict, found.evidence
