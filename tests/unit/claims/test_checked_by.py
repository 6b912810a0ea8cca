"""Who checked a claim's proof: what is said of it is true, and nothing is said where nobody did."""

from typing import Any

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.quantified_claims import marks_for_every, marks_for_hamiltonian
from verify.claims.verdicts import prepare
from verify.execution.execute import Store
from verify.proof.certificates import checker
from verify.proof.certificates import established_statement as certificates
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


def judged(tmp_path: Any, **keys: Any) -> ClaimResult:
    """The one claim of a file with these keys."""
    lines = ["[[claim]]", 'id = "it"', *(f"{key} = {_toml(x)}" for key, x in keys.items())]
    path = tmp_path / "claims.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    (found,) = prepare(load_claims(path)).run(Store(None))
    return found


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {_toml(x)}" for k, x in value.items()) + " }"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value)


def who(found: ClaimResult) -> list[str]:
    return [str(mark).split(":")[0].split(",")[0] for mark in found.checked_by]


BOTH = ["small checker", "Rocq"]


@pytest.mark.parametrize(
    ("keys", "verdict", "expected"),
    [
        ({"kind": "order", "order": 3, "every": "hamiltonian", "scheme": "lie2"}, "PROVED", BOTH),
        ({"kind": "order", "order": 4, "every": "hamiltonian", "scheme": "lie2"}, "REFUTED", BOTH),
        (
            {"kind": "order", "order": 3, "every": "hamiltonian in time", "scheme": "lie2"},
            "PROVED",
            BOTH,
        ),
        ({"kind": "order", "order": 3, "system": "duffing", "scheme": "lie2"}, "PROVED", BOTH),
        (
            {"kind": "area_preserving", "area_preserving": True, "system": "pendulum",
             "scheme": "stormer-verlet"}, "PROVED", BOTH,
        ),
        (
            {"kind": "area_preserving", "area_preserving": True, "system": "henon-heiles",
             "scheme": "stormer-verlet"}, "PROVED", ["small checker"],
        ),
        (
            {"kind": "area_preserving", "area_preserving": False, "system": "henon-heiles",
             "scheme": "lie2"}, "PROVED", ["Rocq"],
        ),
        (
            {"kind": "convergence_order", "convergence_order": 2, "system": "pendulum",
             "scheme": "lie2"}, "PROVED", BOTH,
        ),
        (
            {"kind": "convergence_order", "convergence_order": 4, "every": "hamiltonian",
             "scheme": "rk4"}, "PROVED", ["small checker"],
        ),
        (
            {"kind": "symplectic", "symplectic": True, "system": "henon-heiles",
             "scheme": "stormer-verlet"}, "PROVED", BOTH,
        ),
        (
            {"kind": "defect_order", "defect_order": 3, "system": "henon-heiles",
             "scheme": "lie2"}, "PROVED", BOTH,
        ),
        (
            {"kind": "delta_j", "formula": "3*h**3*delta*p*q", "up_to": 4, "system": "duffing",
             "scheme": "lie2"}, "PROVED", BOTH,
        ),
        (
            {"kind": "order", "order": 6, "system": "pendulum", "scheme": "rk4"}, "PROVED", [],
        ),
    ],
)  # fmt: skip
def test_a_claim_is_marked_by_who_checked_what_it_says(
    tmp_path: Any, keys: dict[str, Any], verdict: str, expected: list[str]
) -> None:
    found = judged(tmp_path, **keys)
    assert found.verdict == verdict
    assert who(found) == expected


def test_a_formula_is_certified_with_its_own_symbols_and_as_far_as_it_is_printed(
    tmp_path: Any,
) -> None:
    keys = {"kind": "delta_j", "system": "duffing", "scheme": "lie2"}
    exact = "3*h**3*delta*p*q + h**4*(1 + 3*delta*q**2)**2/4"
    printed = {"formula": exact, "parameters": {"delta": 1}}
    (mark, _) = judged(tmp_path, **keys, **printed, up_to=4).checked_by
    assert mark.endswith("L = 3*delta*p*q")
    beyond = judged(tmp_path, **keys, **printed, up_to=5)
    whole = judged(tmp_path, **keys, **printed)
    assert [beyond.verdict, whole.verdict] == [Verdict.PROVED] * 2
    assert [beyond.checked_by, whole.checked_by] == [(), ()]


def test_what_runs_show_has_no_mark(tmp_path: Any) -> None:
    run = {"system": "pendulum", "scheme": "lie2", "step_size": 0.1, "steps": 10, "q": 1, "p": 0}
    found = judged(tmp_path, kind="bounded", bound=1, **run)
    assert found.verdict in (Verdict.ENCLOSED, Verdict.MEASURED)
    assert found.checked_by == ()


def test_criteria_have_the_order_and_what_follows_for_lambda(tmp_path: Any) -> None:
    found = judged(tmp_path, kind="criteria", numbers=[2], system="pendulum", scheme="lie2")
    assert who(found) == BOTH
    assert not any("error_over_many_steps" in mark for mark in found.checked_by)


# -- planted errors -------------------------------------------------------------------------------


def test_a_claim_whose_certificate_is_refused_has_no_mark_of_the_small_checker(
    tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(data: object) -> None:
        raise ValueError("det 1 is not zero")

    keys = {"kind": "order", "order": 3, "every": "hamiltonian", "scheme": "lie2"}
    monkeypatch.setattr(certificates, "check", refuse)
    marks_for_every.cache_clear()
    refused = judged(tmp_path, **keys)
    monkeypatch.setattr(certificates, "check", checker.check)
    marks_for_every.cache_clear()
    accepted = judged(tmp_path, **keys)
    assert refused.verdict is accepted.verdict is Verdict.PROVED
    assert who(refused) == ["Rocq"]
    assert who(accepted) == BOTH


def test_a_certificate_of_another_h_is_not_taken_for_that_of_this_one(tmp_path: Any) -> None:
    """Marks are kept by the H, its values and the scheme that they are of."""
    marks_for_hamiltonian.cache_clear()
    keys = {"kind": "order", "order": 3, "scheme": "lie2", "system": "duffing"}
    first, second = (judged(tmp_path, **keys, parameters={"delta": d}) for d in (1, 2))
    assert first.checked_by[0].endswith("L = 3*p*q")
    assert second.checked_by[0].endswith("L = 6*p*q")
