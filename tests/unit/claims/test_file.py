"""What a claim needs: criteria, runs that are there and finished, and a file that says enough."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.runs import (
    CLAIM,
    FLAT,
    made_findings,
    made_proof,
    made_run,
    made_scene,
)
from verify.claims.base_claim import Claim, Findings
from verify.claims.claims_file import load_claims
from verify.claims.kinds.criteria import CriteriaClaim
from verify.claims.kinds.less import LessClaim
from verify.claims.kinds.magnitude import MagnitudeClaim
from verify.claims.kinds.monotone import MonotoneClaim
from verify.claims.kinds.spread import SpreadClaim
from verify.claims.kinds.step_map import StepMapClaim
from verify.claims.kinds.table import PrintedTableClaim
from verify.errors import InputError
from verify.studies.kinds.grid import grid_task
from verify.verdict import Verdict

PROVED, MEASURED, REFUTED, UNDECIDED = (
    Verdict.PROVED, Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED,
)  # fmt: skip

# -- criteria -------------------------------------------------------------------------------------

THIRD_ORDER = made_proof(verdict=PROVED, order=3, area_preserving=False, convergence_order=2)
NO_AREA = made_proof(verdict=PROVED, order=None, area_preserving=True, convergence_order=2)
OPEN = made_proof()


@pytest.mark.parametrize(
    ("numbers", "proof", "power", "expected"),
    [
        ((2, 4), THIRD_ORDER, 0, PROVED),
        ((1,), THIRD_ORDER, 2, REFUTED),
        ((2, 1, 4), THIRD_ORDER, 2, REFUTED),
        ((1, 2, 3, 4), NO_AREA, 0, PROVED),
        ((3, 4), OPEN, 2, MEASURED),
        ((2, 3), OPEN, 2, UNDECIDED),
        ((3, 4), OPEN, 0, REFUTED),
        ((1, 4), OPEN, 0, REFUTED),
    ],
)
def test_criteria_hold_together_and_the_weakest_counts(
    numbers: tuple[int, ...], proof: Any, power: int, expected: Verdict
) -> None:
    claim = CriteriaClaim(**CLAIM, kind="criteria", numbers=numbers)

    def values(h: Fraction, _: int) -> dict[str, Any]:
        return {"mse": h**power, "lambda": h**power}

    findings = made_findings(made_scene(), values, proof)
    (found,) = [claim.judge(findings)]
    assert found.verdict is expected
    assert all(f"criterion {n}: " in found.evidence for n in numbers)


# -- runs -----------------------------------------------------------------------------------------

H = (Fraction(1, 100), Fraction(1, 50))
ON_RUNS: dict[str, Claim] = {
    "table": PrintedTableClaim(
        **CLAIM, kind="table", step_sizes=H, printed=("-20.0000", "-20.0000")
    ),
    "spread": SpreadClaim(**CLAIM, kind="spread", quantity="mse", factor=2),
    "monotone": MonotoneClaim(**CLAIM, kind="monotone", quantity="mse", direction="increases"),
    "less": LessClaim(**CLAIM, kind="less", quantity="mse", than="abs_lambda"),
    "magnitude": MagnitudeClaim(**CLAIM, kind="magnitude", step_size=H[0],
                                exponents={"mse": -20}, quantifier="every"),
}  # fmt: skip
on_runs = pytest.mark.parametrize("claim", ON_RUNS.values(), ids=ON_RUNS)


def two_runs(*runs: Any) -> Findings:
    """A scene of two step sizes and one initial value with these runs."""
    scene = made_scene(("0.01", "0.02"), (("1", "0"),))
    names = [grid_task(scene, "lie2", h, 0).key for h in H]
    return Findings({"made": scene}, dict(zip(names, runs, strict=False)))


@on_runs
def test_a_claim_on_runs_that_were_not_made_is_an_input_error(claim: Claim) -> None:
    with pytest.raises(InputError, match="has no runs"):
        [claim.judge(two_runs())]


@on_runs
def test_an_orbit_that_left_the_range_leaves_a_claim_undecided_or_refuted(claim: Claim) -> None:
    left = made_run("0.02", {}, status="left range", failed_step=7)
    first = made_run("0.01", FLAT)
    found = [claim.judge(two_runs(first, left))][0]
    assert found.verdict in (UNDECIDED, REFUTED) or claim.kind == "magnitude"
    other_way = [claim.judge(two_runs(made_run("0.01", {}, status="left range"), first))]
    assert other_way[0].verdict in (UNDECIDED, REFUTED)


@on_runs
def test_a_claim_on_an_observable_that_was_not_asked_for_is_an_input_error(claim: Claim) -> None:
    runs = [made_run(h, {"delta_j_max": "1e-9"}) for h in H]
    with pytest.raises(InputError, match="mse"):
        [claim.judge(two_runs(*runs))]


def test_a_claim_on_a_scene_that_is_not_there_is_an_input_error() -> None:
    claim = LessClaim(**{**CLAIM, "scene": "lorenz"}, kind="less", quantity="mse", than="mse")
    with pytest.raises(InputError, match=r"claim.scene=lorenz: unknown; allowed: made"):
        [claim.judge(two_runs())]


PROOFS: dict[str, Claim] = {
    "step_map": StepMapClaim(**CLAIM, kind="step_map", p_next="p", q_next="q"),
    "criteria": CriteriaClaim(**CLAIM, kind="criteria", numbers=(1,)),
}


@pytest.mark.parametrize("claim", PROOFS.values(), ids=PROOFS)
def test_a_claim_on_a_scheme_that_its_scene_does_not_have_is_an_input_error(claim: Claim) -> None:
    with pytest.raises(InputError, match="lie3"):
        [claim.model_copy(update={"scheme": "lie3"}).judge(two_runs())]


# -- the file -------------------------------------------------------------------------------------

HEAD = """
[[claim]]
id = "mine"
source = "here"
statement = "so it is"
scene = "made"
scheme = "lie2"
"""
BAD_CLAIMS = {
    "no-kind": "",
    "unknown-kind": 'kind = "feeling"',
    "unknown-key": 'kind = "less"\nquantity = "mse"\nthan = "abs_lambda"\nspeed = 1',
    "missing-key": 'kind = "less"\nquantity = "mse"',
    "unknown-quantity": 'kind = "less"\nquantity = "energy"\nthan = "mse"',
    "factor-nan": 'kind = "spread"\nquantity = "mse"\nfactor = nan',
    "step-size-zero": 'kind = "table"\nstep_sizes = [0]\nprinted = ["1"]',
    "printed-no-number": 'kind = "table"\nstep_sizes = [0.1]\nprinted = ["about 3"]',
    "printed-too-many": 'kind = "table"\nstep_sizes = [0.1]\nprinted = ["1.0", "2.0"]',
    "nothing-printed": 'kind = "table"\nstep_sizes = []\nprinted = []',
    "no-criterion": 'kind = "criteria"\nnumbers = []',
    "criterion-7": 'kind = "criteria"\nnumbers = [7]',
    "no-exponent": 'kind = "magnitude"\nstep_size = 1\nexponents = {}\nquantifier = "some"',
    "up-to-0": 'kind = "delta_j"\nformula = "0"\nup_to = 0',
    "three-entries": 'kind = "jacobian"\nentries = [["1", "0"], ["0"]]',
}


@pytest.mark.parametrize("body", BAD_CLAIMS.values(), ids=BAD_CLAIMS)
def test_a_claim_that_says_too_little_or_too_much_is_named_when_it_is_read(
    tmp_path: Path, body: str
) -> None:
    """An empty table or list of criteria would be true of everything."""
    path = tmp_path / "claims.toml"
    path.write_text(HEAD + body)
    with pytest.raises(InputError, match=r"claims\.toml:\d+: claim mine") as caught:
        load_claims(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "content", ["", "x = 1", "[claim]\n", "claim = 3", "claim = [3]", "claim = ["]
)
def test_a_file_without_claims_is_named(tmp_path: Path, content: str) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(content)
    with pytest.raises(InputError, match=r"claims\.toml"):
        load_claims(path)


def test_two_claims_of_one_id_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    path.write_text((HEAD + 'kind = "criteria"\nnumbers = [1]\n') * 2)
    with pytest.raises(InputError, match="mine"):
        load_claims(path)


def test_a_claims_section_is_carried_to_its_result(tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(
        '[defaults]\nkind = "area_preserving"\nscheme = "lie2"\nevery = "hamiltonian"\n'
        'area_preserving = true\nsection = "2 Area"\n'
        '[[claim]]\nid = "a"\n[[claim]]\nid = "b"\nsection = "3.1 More"\n'
    )
    found = [claim.judge(Findings({})) for claim in load_claims(path).claims]
    assert [c.section for c in found] == ["2 Area", "3.1 More"]
    path.write_text(path.read_text().replace('section = "2 Area"\n', ""))
    found = [claim.judge(Findings({})) for claim in load_claims(path).claims]
    assert [c.section for c in found] == ["", "3.1 More"]
