"""A verdict that is known does not wait for the mark of who checked it."""

import time
from typing import Any

import pytest

from verify import effort
from verify.claims.base_claim import Findings
from verify.claims.kinds import models
from verify.claims.quantified_claims import marks_for_hamiltonian
from verify.claims.verdicts import judge_claim
from verify.execution.keeper import NOTHING
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.checked import proof_marks
from verify.proof.checked.proved_statement import DEFECT, ProvedStatement
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.schemes import get

# Its parts composed are h within functions of h, six deep: sympy asks whether each is real, …
WITHHELD = "sqrt(1 + p**2) + cosh(q/2)/(1 + t**2)"
SIX_PARTS = (
    "kick 1/5 at 1/10; drift 1/4 at 1/3; kick 2/5 at 1/2; drift 1/4 at 1/5; kick 2/5 at 9/10; "
    "drift 1/2 at 1/7"
)


def claim(scheme: str, kind: str = "area_preserving", **keys: Any) -> Any:
    keys = keys or {"area_preserving": True}
    return models()[kind].model_validate(
        {"id": "c", "scene": "made", "scheme": scheme, "kind": kind, **keys}
    )


def judge(formula: str, scheme: str) -> ClaimResult:
    marks_for_hamiltonian.cache_clear()
    scene = Scene(hamiltonian=formula, schemes=(scheme,), name="made")
    return judge_claim(claim(scheme), {"made": scene}, {}, NOTHING)


def test_a_verdict_comes_without_a_mark_that_would_not_end() -> None:
    begun = time.process_time()
    found = judge(WITHHELD, SIX_PARTS)
    assert (found.verdict, found.evidence) == ("PROVED", "ΔJ is the zero function: det J ≡ 1")
    assert time.process_time() - begun < 60


def test_a_second_claim_of_it_does_not_wait_again() -> None:
    judge(WITHHELD, SIX_PARTS)
    scene = Scene(hamiltonian=WITHHELD, schemes=(SIX_PARTS,), name="made")
    begun = time.process_time()
    claim(SIX_PARTS).checked_by(claim(SIX_PARTS).judge(Findings({"made": scene})),
                                Findings({"made": scene}))  # fmt: skip
    assert time.process_time() - begun < 1


@pytest.mark.parametrize("ending", [True, False])
def test_a_certificate_that_is_not_made_in_time_gives_no_mark_and_the_next_is_tried(
    ending: bool,
) -> None:
    def never() -> dict[str, Any]:
        while not ending:
            len(str(1))
        return {}

    from verify.proof.certificates.certification import certify_for_every_h
    from verify.proof.order_for_every_h import prove_for_every_h

    proof = prove_for_every_h("symplectic-euler")
    makers = (never, lambda: certify_for_every_h(proof))
    scheme = get("symplectic-euler")
    proved = ProvedStatement(
        scheme, DEFECT, True, for_every_h=True, timed=False, degrees=1, certificates=makers
    )
    marks = list(proof_marks.small_checker_marks(proved))
    assert len(marks) == (0 if ending else 1)  # what is refused gives none; what is not made, next


def test_the_mark_is_there_where_it_is_made_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    duffing = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
    marks_for_hamiltonian.cache_clear()
    assert any("small checker" in str(x) for x in marks_for_hamiltonian(duffing, "lie2", DEFECT))
    marks_for_hamiltonian.cache_clear()
    monkeypatch.setattr(proof_marks, "limit_effort", lambda *of: effort.limit_effort(*of, most=10))
    assert not any(
        "small checker" in str(x) for x in marks_for_hamiltonian(duffing, "lie2", DEFECT)
    )
    marks_for_hamiltonian.cache_clear()
