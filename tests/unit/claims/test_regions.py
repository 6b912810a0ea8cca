"""Claims about regions that maps carry, each verdict beside its opposite."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from verify.claims.base_claim import Findings
from verify.claims.claims_file import load_claims
from verify.claims.kinds.flow_area import FlowAreaClaim, conserves_area
from verify.claims.kinds.flow_distance import FlowDistanceClaim
from verify.claims.verdicts import add_claims
from verify.errors import InputError
from verify.execution.keeper import NOTHING
from verify.execution.plan import Plan, plan_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.regions import EXACT_FLOW, FlowImage
from verify.scenes.scene import Scene, scene_from
from verify.studies.kinds.regions import FlowTask, need_flows
from verify.verdict import Verdict

PROVED, REFUTED = Verdict.PROVED, Verdict.REFUTED
MEASURED, UNDECIDED = Verdict.MEASURED, Verdict.UNDECIDED
SECTION = {
    "source": "Figure 6", "shape": "circle", "centre": {"q": 1, "p": 0}, "scale": "0.5",
    "step_size": "0.1", "steps": [10, 20],
}  # fmt: skip
SCENE = {
    "name": "made", "hamiltonian": "p**2/2 + q**2/2 + q**4/4",
    "schemes": ["lie2", "symplectic-euler"], "flow": [SECTION],
}  # fmt: skip


def made_scene(**section: Any) -> Scene:
    return scene_from({**SCENE, "flow": [{**SECTION, **section}]}, "by hand")


def image(task: FlowTask, **given: Any) -> FlowImage:
    fields = {
        "map": task.map, "steps": task.steps, "time": "1", "seconds": 0.0, "probe_error": "1e-12",
        "area_preserving": task.map != "lie2", "area_change": "1e-3", "agree": True,
    }  # fmt: skip
    return FlowImage(**{**fields, **given})


def findings(scene: Scene, given: Any = None) -> Findings:
    """By the real code, or by hand: `given` has what is changed of each image of lie2."""
    results: dict[str, Any] = {}
    count = 0
    for task in plan_of([scene], need_flows).tasks.values():
        assert isinstance(task, FlowTask)
        if given is None:
            results[task.key] = task.compute(NOTHING)
        else:
            results[task.key] = image(task, **given[count % len(given)])
            count += 1
    return Findings({scene.name: scene}, results)


def area(scheme: str = "lie2", within: Any = None) -> FlowAreaClaim:
    return FlowAreaClaim(id="c", source="s", statement="t", scene="made", scheme=scheme,
                         kind="flow_area", flows=("Figure 6",), within=within)  # fmt: skip


def near(within: Any, scheme: str = "lie2") -> FlowDistanceClaim:
    return FlowDistanceClaim(id="c", source="s", statement="t", scene="made", scheme=scheme,
                             kind="flow_distance", flows=("Figure 6",), within=within)  # fmt: skip


@pytest.fixture(scope="module")
def carried() -> Findings:
    return findings(made_scene())


def verdict(claim: Any, found: Findings) -> Verdict:
    result = claim.judge(found)
    assert isinstance(result, ClaimResult)
    assert result.evidence
    return result.verdict


def test_what_preserves_area_is_proved_to_and_what_does_not_is_refuted(carried: Findings) -> None:
    assert verdict(area(EXACT_FLOW), carried) is PROVED
    assert verdict(area("symplectic-euler"), carried) is PROVED
    assert verdict(area("lie2"), carried) is REFUTED


def test_a_change_is_within_what_is_allowed_or_refuted(carried: Findings) -> None:
    changes = [abs(Fraction(i.area_change or 0)) for i in carried.results.values()
               if isinstance(i, FlowImage) and i.map == "lie2"]  # fmt: skip
    most = max(changes)
    assert verdict(area(within=most * Fraction(101, 100)), carried) is MEASURED
    assert verdict(area(within=most * Fraction(99, 100)), carried) is REFUTED
    assert min(changes) < most * Fraction(99, 100), "one of them would have been within"


def test_a_distance_is_within_what_is_allowed_or_refuted(carried: Findings) -> None:
    most = max(Fraction(i.distance or 0) for i in carried.results.values()
               if isinstance(i, FlowImage) and i.map == "lie2")  # fmt: skip
    assert verdict(near(most * Fraction(101, 100)), carried) is MEASURED
    assert verdict(near(most * Fraction(99, 100)), carried) is REFUTED


GIVEN = [
    ({"area_change": "1e-3"}, None, REFUTED),
    ({"area_change": "0", "probe_error": "1e-3"}, None, UNDECIDED),
    ({"area_change": "1e-3", "probe_error": "1e-3"}, None, UNDECIDED),
    ({"area_change": "-1e-3"}, None, REFUTED),
    ({"area_change": "-1e-3"}, "1e-4", REFUTED),
    ({"area_change": "-1e-3"}, "2e-3", MEASURED),
    ({"area_change": "1e-3", "probe_error": "1e-4"}, "1e-3", UNDECIDED),
    ({"area_change": "1e-3", "probe_error": "0"}, "1e-3", MEASURED),
    ({"agree": False}, "1", UNDECIDED),
    ({"agree": None}, "1", MEASURED),
    ({"area_change": None, "problem": "it left"}, "1", UNDECIDED),
    ({"area_change": None, "probe_error": None, "problem": "it left"}, None, UNDECIDED),
]


@pytest.mark.parametrize(("given", "within", "expected"), GIVEN)
def test_areas_by_hand(given: dict[str, Any], within: Any, expected: Verdict) -> None:
    found = findings(made_scene(), [given])
    assert verdict(area(within=within), found) is expected


def test_one_image_that_is_not_known_leaves_what_the_others_say_open_unless_they_refute() -> None:
    good, bad = {"area_change": "1e-3"}, {"area_change": None, "problem": "it left"}
    assert verdict(area(within="1e-2"), findings(made_scene(), [good, bad])) is UNDECIDED
    assert verdict(area(within="1e-2"), findings(made_scene(), [good, good])) is MEASURED
    assert verdict(area(within="1e-4"), findings(made_scene(), [good, bad])) is REFUTED
    assert verdict(area(), findings(made_scene(), [good, bad])) is REFUTED
    wrong = {"area_change": "1e-3", "agree": False}  # what is in doubt refutes nothing
    assert verdict(area(within="1e-4"), findings(made_scene(), [wrong, bad])) is UNDECIDED


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ([{"distance": "0.1", "distance_error": "0.01"}], MEASURED),
        ([{"distance": "0.3", "distance_error": "0.01"}], REFUTED),
        ([{"distance": "0.2", "distance_error": "0.01"}], UNDECIDED),
        ([{"distance": None, "problem": "it left"}], UNDECIDED),
        ([{"distance": "0.1", "distance_error": "0"}, {"distance": "0.3", "distance_error": "0"}],
         REFUTED),
        ([{"distance": "0.1", "distance_error": "0"}, {"distance": None}], UNDECIDED),
        ([{"distance": "0.3", "distance_error": "0"}, {"distance": None}], REFUTED),
    ],
)  # fmt: skip
def test_distances_by_hand(given: list[dict[str, Any]], expected: Verdict) -> None:
    assert verdict(near("0.2"), findings(made_scene(), given)) is expected
    details = near("0.2").judge(findings(made_scene(), given)).details
    assert {len(row) for row in details} == {len(details[0])}


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ([{"distance": "0.3", "distance_error": "0.01"}], MEASURED),
        ([{"distance": "0.1", "distance_error": "0.01"}], REFUTED),
        ([{"distance": "0.2", "distance_error": "0.01"}], UNDECIDED),
        ([{"distance": "0.1", "distance_error": "0"}, {"distance": "0.3", "distance_error": "0"}],
         MEASURED),
        ([{"distance": "0.1", "distance_error": "0"}, {"distance": None}], UNDECIDED),
        ([{"distance": "0.3", "distance_error": "0"}, {"distance": None}], MEASURED),
    ],
)  # fmt: skip
def test_one_distance_beyond_is_enough(given: list[dict[str, Any]], expected: Verdict) -> None:
    claim = near("0.2").model_copy(update={"within": None, "beyond": Fraction(1, 5)})
    assert verdict(claim, findings(made_scene(), given)) is expected


def test_a_distance_is_within_or_beyond_one_number() -> None:
    for keys in ({}, {"within": 1, "beyond": 1}):
        with pytest.raises(ValidationError, match="give one of the two"):
            FlowDistanceClaim(**{**near("1").model_dump(exclude={"within", "beyond"}), **keys})


def test_a_claim_without_results_is_undecided() -> None:
    scene = made_scene()
    empty = Findings({scene.name: scene}, {})
    assert verdict(area(within="1"), empty) is UNDECIDED
    assert verdict(near("1"), empty) is UNDECIDED


def test_liouvilles_theorem_is_checked_for_each_h() -> None:
    for formula in ("p**2/2 - cos(q)", "p**3*q**2 + sin(p*q)", "exp(p*q)/(1 + q**2)"):
        assert conserves_area(Hamiltonian.parse(formula))


# -- a file of claims -----------------------------------------------------------------------------

FILE = """
[[scene]]
name = "made"
hamiltonian = "p**2/2 + q**4/4"
schemes = ["lie2"]
[[scene.flow]]
source = "Figure 6"
shape = "circle"
step_size = 0.1
steps = [10]
[[claim]]
id = "c"
source = "s"
statement = "t"
scene = "made"
scheme = "lie2"
kind = "flow_area"
flows = ["Figure 6"]
within = 0.1
"""
WRONG = {
    "scheme": (('scheme = "lie2"', 'scheme = "lie"'), "lie"),
    "scheme-not-in-it": (('scheme = "lie2"', 'scheme = "rk4"'), "rk4"),
    "flow": (('flows = ["Figure 6"]', 'flows = ["Figure 7"]'), r"has no such \[\[flow\]\]"),
    "no-flow": (('flows = ["Figure 6"]', "flows = []"), "flows"),
    "within-zero": (("within = 0.1", "within = 0"), "within"),
    "within-missing": (('kind = "flow_area"\n', 'kind = "flow_distance"\n#'), "flows"),
    "scene": (('scene = "made"\ns', 'scene = "other"\ns'), "other"),
    "key": (("within = 0.1", "bound = 0.1"), "bound"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_claim_is_one_line_that_names_it(name: str, tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(FILE)
    file = load_claims(path)
    planned = Plan()
    add_claims(planned, file.claims, file.scenes)
    assert [t.map for t in planned.tasks.values() if isinstance(t, FlowTask)] == ["lie2"]
    (old, new), problem = WRONG[name]
    assert old in FILE
    path.write_text(FILE.replace(old, new))
    with pytest.raises(InputError, match=problem) as info:
        load_claims(path)
    assert "\n" not in str(info.value)
