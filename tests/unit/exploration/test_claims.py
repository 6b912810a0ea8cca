"""Claims as properties: what a paper says of its own scene, asked of drawn ones."""

import json
from pathlib import Path

import pytest

from tests.paths import ROOT
from tests.unit.exploration.test_explore import exploration
from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.exploration.claim_properties import claim_property, claim_texts, claims_left_out
from verify.exploration.exploring import explore, load_failures, save_failures
from verify.exploration.property import Violation
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes_of_seed import sample_scene
from verify.scenes.scene import load_scene, scene_from

PAPER = ROOT / "reports" / "paper"

CLAIMS = """
[defaults]
scheme = "lie2"
system = "duffing"
parameters = { delta = 1 }

[[claim]]
id = "third-order"
kind = "order"
order = 3
at_least = true

[[claim]]
id = "fourth-order"
kind = "order"
order = 4
at_least = true

[[claim]]
id = "small"
kind = "bounded"
bound = "1e300"
step_size = 0.01
steps = 5
q = 1
p = 0
"""


def claims_of(tmp_path: Path, text: str = CLAIMS) -> tuple[str, ...]:
    path = tmp_path / "claims.toml"
    path.write_text(text)
    return claim_texts(load_claims(path).claims)


def test_a_claim_is_asked_of_drawn_scenes(tmp_path: Path) -> None:
    texts = claims_of(tmp_path, CLAIMS[: CLAIMS.index('[[claim]]\nid = "small"')])
    asked = exploration(properties=(), claims=texts, examples=9)
    report = explore(asked, Store(None), where=THIS_PROCESS)
    true, false = report.properties
    assert (true.name, true.failures) == ("third-order", 0)
    assert true.looked_at == 9
    assert (false.name, false.failures > 0) == ("fourth-order", True)
    assert [f.property for f in report.failures] == ["fourth-order"]
    shrunk = json.dumps(report.failures[0].scene)
    assert "p**2/2 + q**2/2" not in shrunk, "for that H the claim holds: ΔJ is of order 4"


def test_a_claim_on_a_run_is_asked_of_the_drawn_run(tmp_path: Path) -> None:
    text = CLAIMS.partition("[[claim]]")[0] + CLAIMS[CLAIMS.index('[[claim]]\nid = "small"') :]
    (claim,) = claims_of(tmp_path, text)
    scene = sample_scene(SampleSpace(schemes=("lie2",), degree=3), 5, 0)
    assert claim_property(claim).holds(Sample.from_scene(scene))
    (zero,) = claims_of(tmp_path, text.replace("1e300", "0"))
    with pytest.raises(Violation):
        claim_property(zero).holds(Sample.from_scene(scene))


OF_EVERY = (
    """
[defaults]
scheme = "lie2"
every = "hamiltonian"

[[claim]]
id = "not-passed"
kind = "order"
order = 3

[[claim]]
id = "wrong-order"
kind = "order"
order = 4

[[claim]]
id = "agrees"
kind = "convergence_order"
convergence_order = 2

[[claim]]
id = "leading"
kind = "delta_j"
formula = """
    + (
        '"h**3/2*(H_q*(2*H_pq*H_ppq - H_ppp*H_qq - H_pp*H_qqp)'
        ' + H_p*(H_ppq*H_qq + H_pp*H_qqq - 2*H_pq*H_pqq))"'
    )
    + """
up_to = 4

[[claim]]
id = "a-lost-term"
kind = "delta_j"
formula = "h**3/2*H_p*H_pp*H_qqq"
up_to = 4

[[claim]]
id = "separable"
kind = "area_preserving"
area_preserving = true
scheme = "stormer-verlet"
every = "separable hamiltonian"
"""
)


@pytest.mark.left_to_ci
def test_a_true_claim_of_every_h_holds_of_each_and_a_false_one_fails(tmp_path: Path) -> None:
    """Some H pass an order that not every H passes, and some H are not separable."""
    asked = exploration(
        properties=(),
        claims=claims_of(tmp_path, OF_EVERY),
        examples=9,
        drawn=SampleSpace(degree=3),
    )
    report = explore(asked, Store(None), where=THIS_PROCESS)
    failing = {each.name for each in report.properties if each.failures}
    assert failing == {"wrong-order", "a-lost-term"}
    looked_at = {each.name: each.looked_at for each in report.properties}
    assert 0 < looked_at["separable"] < looked_at["leading"]


def test_that_not_every_h_preserves_area_says_nothing_of_one(tmp_path: Path) -> None:
    text = """[[claim]]
id = "not-all"
kind = "area_preserving"
scheme = "lie2"
every = "hamiltonian"
area_preserving = false
"""
    with pytest.raises(InputError, match=r"not-all.*nothing of a single one"):
        claims_of(tmp_path, text)


def test_a_claim_on_step_sizes_compares_two(tmp_path: Path) -> None:
    made = """[[claim]]
id = "mse"
kind = "monotone"
quantity = "mse"
direction = "DIRECTION"
scheme = "lie2"
hamiltonian = "p**2/2 - cos(q)"
step_sizes = [0.01, 0.02]
steps = 5
q = 1
p = 0
"""
    sample = Sample.from_scene(
        scene_from(
            {
                "hamiltonian": "p**2/2 + q**4/4",
                "schemes": ["lie1"],
                "grid": {"steps": 4, "step_sizes": ["0.1"], "initial_values": [{"q": 1, "p": 1}]},
            },
            "scene",
        )
    )
    (true,) = claims_of(tmp_path, made.replace("DIRECTION", "increases"))
    (false,) = claims_of(tmp_path, made.replace("DIRECTION", "decreases"))
    assert claim_property(true).holds(sample)
    with pytest.raises(Violation, match=r"at h = 0\.05 to .* at h = 0\.1"):
        claim_property(false).holds(sample)


def test_claims_of_one_scene_are_left_out_with_the_reason() -> None:
    claims = load_claims(PAPER / "claims.toml").claims
    texts, without = claim_texts(claims), claims_left_out(claims)
    asked = {json.loads(text)["kind"] for text in texts}
    assert asked == {"monotone", "less", "criteria", "growth", "defect_order", "area_preserving"}
    assert len(texts) + sum(map(len, without.values())) == len(claims)
    assert "table-1" in without["printed numbers are those of its own runs"]
    assert "eq-19" in without["a printed formula is that of its own Hamiltonian"]


def test_two_of_one_name_are_refused(tmp_path: Path) -> None:
    text = '[[claim]]\nid = "time-scaling"\nkind = "order"\norder = 3\nscheme = "lie2"\n'
    claims = claims_of(tmp_path, f'{text}hamiltonian = "p**2 + q**4"\n')
    with pytest.raises(InputError, match="properties=time-scaling: 2 of them"):
        exploration(claims=claims)


def test_a_claim_is_written_under_a_name_that_a_file_can_have(tmp_path: Path) -> None:
    text = CLAIMS.partition('[[claim]]\nid = "small"')[0].replace("fourth-order", "../§2/eq.3")
    asked = exploration(properties=(), claims=claims_of(tmp_path, text), examples=6,
                        drawn=SampleSpace(schemes=("lie1",), degree=3))  # fmt: skip
    report = explore(asked, Store(None), where=THIS_PROCESS)
    folder = tmp_path / "found"
    (path,) = save_failures(report, folder)
    assert path.parent == folder
    assert load_scene(path).schemes == ("lie2",), "the claim's, not the one drawn"
    again = explore(asked, Store(None), where=THIS_PROCESS, earlier=load_failures(folder))
    assert [found.property for found in again.again] == ["../§2/eq.3"]
    assert again.again[0].message


def test_a_claim_of_a_theorem_is_refused(tmp_path: Path) -> None:
    text = '[[claim]]\nid = "t"\nkind = "theorem"\nname = "matrix-vector"\nscheme = "lie2"\n'
    with pytest.raises(InputError, match="t"):
        claims_of(tmp_path, text)


def test_a_claim_keeps_its_own_scheme(tmp_path: Path) -> None:
    (text, *_) = claims_of(tmp_path, CLAIMS[: CLAIMS.index('[[claim]]\nid = "fourth')])
    scene = sample_scene(SampleSpace(schemes=("lie1",)), 5, 0)
    assert claim_property(text).holds(Sample.from_scene(scene)), "of lie2, though lie1 was drawn"
