"""Scenes and results are the same after a round trip through JSON, and are frozen."""

from pathlib import Path

import pytest
from pydantic import ValidationError

from tests.helpers.constructed.galleries import gallery, shown
from tests.helpers.constructed.scenes import GOOD, HEAD, PAPER, load
from verify.claims.claims_file import load_claims
from verify.claims.verdicts import make_report
from verify.execution import execute
from verify.execution.executors import THIS_PROCESS
from verify.prose import read_prose
from verify.scenes.frozen import Frozen, OfScheme, WithProse
from verify.scenes.paper_sections import Alternative, Assumption, Cause
from verify.scenes.results import (
    bounded_value,
    claim,
    growth,
    proof_result,
    separation,
    separation_parts,
)
from verify.scenes.results import bounded_value as value
from verify.scenes.results import orbit_points as orbit_results
from verify.scenes.results import regions as flow_results
from verify.scenes.results import report as scene_results
from verify.scenes.results import run as run_results
from verify.scenes.results import stability as stability_results
from verify.scenes.results import work_precision as work_precision_results
from verify.scenes.results.exploration import GalleryScene
from verify.scenes.results.kept import StructureResult
from verify.scenes.results.proof_result import Formulas
from verify.scenes.results.report import Report, SceneResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.work_precision import RatioResult
from verify.scenes.scene import Scene, load_scene

RESULTS = (
    claim,
    growth,
    orbit_results,
    proof_result,
    separation,
    separation_parts,
    bounded_value,
    value,
    run_results,
    scene_results,
    stability_results,
    work_precision_results,
    flow_results,
)
FULL = """
title = "Two <schemes> & δ"
system = "duffing"
parameters = { delta = "7/3" }
schemes = ["lie2", "symplectic-euler", "p_next = p - h*q*(1 + delta*q^2); q_next = q + h*p"]
criteria = [1, 2, 3, 4]
every_hamiltonian = true
keeps = ["energy: 3", "reversible"]
[grid]
steps = 30
step_sizes = [0.01, "1/30"]
initial_values = [{ q = 1.5, p = "-1/3" }, { q = 0, p = 1 }]
observables = ["delta_j_max", "mse", "lambda", "lambda_plain"]
separate = true
growth = true
growth_explains = "a <figure>"
[[separation]]
steps = 20
step_sizes = [0.01, 0.1]
initial_value = { q = 1, p = 0 }
[[series]]
step_size = 0.25
steps = 40
points = 8
initial_value = { q = 1, p = 0 }
[[stability]]
steps = 100
step_sizes = [0.1]
initial_values = [{ q = 1, p = 0 }]
schemes = ["lie2"]
[[largest_step]]
time = 2
initial_value = { q = 1, p = 0 }
schemes = ["lie2"]
[[stability_map]]
parameter = "delta"
values = [1]
step_sizes = [0.1]
steps = 100
initial_value = { q = 1, p = 0 }
schemes = ["lie2"]
[[flow]]
shape = "circle"
centre = { q = 1, p = 0 }
scale = 0.25
step_size = 0.1
steps = [3]
schemes = ["lie2"]
[work_precision]
time = 1
step_sizes = [0.02, 0.01, 0.005, 0.0025]
initial_value = { q = 1, p = 0 }
repeats = 1
number_systems = ["mpfr"]
digits = [20]
peers = false
"""
CLAIMS = """
[[claim]]
id = "map"
source = "here"
statement = "It is this map."
scene = "mine"
scheme = "lie2"
kind = "step_map"
p_next = "p"
q_next = "q"
[[claim]]
id = "less"
source = "here"
statement = "It is less."
reading = "always"
scene = "mine"
scheme = "lie2"
kind = "less"
quantity = "mse"
than = "abs_lambda"
[[figure]]
label = "Figure 1"
scene = "mine"
shows = "runs"
claims = ["less"]
"""


@pytest.mark.parametrize("content", [HEAD, GOOD, FULL], ids=["least", "good", "full"])
def test_a_scene_is_the_same_after_a_round_trip_through_json(tmp_path: Path, content: str) -> None:
    scene = load(tmp_path, content)
    assert Scene.model_validate_json(scene.model_dump_json()) == scene


@pytest.mark.parametrize("name", ["duffing", "pendulum"])
def test_the_scenes_of_the_paper_survive_json_too(name: str) -> None:
    scene = load_scene(PAPER / f"{name}.toml")
    assert Scene.model_validate_json(scene.model_dump_json()) == scene


DRIVEN = """
name = "driven"
hamiltonian = "p**2/2 - cos(2*pi*t)*cos(q)"
schemes = ["lie2"]

[grid]
steps = 9
step_sizes = [0.1]
initial_values = [{ q = 1, p = 0 }]
separate = true

[[stroboscopic]]
period = 1
step_size = 0.1
periods = 3
initial_values = [{ q = 1, p = 0 }]
"""

SEVERAL = """
name = "several"
hamiltonian = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
schemes = ["lie2"]

[grid]
steps = 9
step_sizes = [0.1]
initial_values = [{ q = [0.1, 0], p = [0, 0.1] }]
separate = true

[[flow]]
shape = "circle"
centre = { q = [0.1, 0], p = [0, 0.1] }
step_size = 0.1
steps = [3]
exact = false

[[orbit_map]]
axes = ["q2", "p2"]
across = { from = 0, to = 0.5, count = 3 }
upwards = [0.1]
initial_value = { q = [0, 0], p = [0.1, 0] }
step_size = 0.1
steps = 20

[[poincare]]
step_size = 0.1
steps = 90
initial_values = [{ q = [0.1, 0], p = [0, 0.1] }]
"""
SEVERAL_IN_TIME = (
    SEVERAL.partition("[[poincare]]")[0]  # of an H that does not depend on time
    .replace("q2**3/3", "q2**3/3 - q1*cos(t)")
    .replace("several", "timed")
)


@pytest.fixture(scope="module")
def full_report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    folder = tmp_path_factory.mktemp("full")
    scene = load(folder, FULL)
    (folder / "claims.toml").write_text(CLAIMS)
    file = load_claims(folder / "claims.toml")
    store, figures = execute.Store(None), file.figures
    others = [load(folder, each) for each in (DRIVEN, SEVERAL, SEVERAL_IN_TIME)]
    made = make_report(
        "All", [scene, *others], file.claims, store,
        figures=figures, command="test", where=THIS_PROCESS,
    )  # fmt: skip
    first, *more = made.scenes
    scenes = (_with_symbols(_with_ratio(first)), *more)
    causes = (Cause(says=read_prose("It is `1/N`."), explains=("a",)),)
    pair = Alternative(claim="map", otherwise="less")
    assumptions = (Assumption(says=read_prose("It ends at `T`."), decides=(pair,)),)
    sections = {"gallery": gallery(shown()), "causes": causes, "assumptions": assumptions}
    return made.model_copy(update={"scenes": scenes, **sections})


def _with_symbols(scene: SceneResult) -> SceneResult:
    """A long value of a parameter is rare: the formulas that are read then stand here."""
    first, *others = scene.proofs
    symbolic = Formulas(
        symbols=("delta",), leading=None, delta_j=None, p_next="p", q_next="q", jacobian=None
    )
    return scene.model_copy(
        update={"proofs": (first.model_copy(update={"symbolic": symbolic}), *others)}
    )


def _with_ratio(scene: SceneResult) -> SceneResult:
    """Times that were measured may not overlap on a busy machine; then there is no ratio."""
    ratio, work = RatioResult(at="2", least="1.5", most="2.5"), scene.work_precision
    assert work is not None
    known = tuple(one.model_copy(update={"error": ratio}) for one in work.comparisons)
    compared = work.model_copy(update={"comparisons": known})
    return scene.model_copy(update={"work_precision": compared})


def models(value: object) -> set[type]:
    """The model classes that occur in a result."""
    found = set()
    if isinstance(value, Frozen):
        found.add(type(value))
        for name in type(value).model_fields:
            found |= models(getattr(value, name))
    elif isinstance(value, dict | tuple):
        for item in value.values() if isinstance(value, dict) else value:
            found |= models(item)
    return found


def is_generic(model: type[Frozen]) -> bool:
    """Whether others are made of it, and no result itself; or it is one of these."""
    generic = model.__pydantic_generic_metadata__
    return bool(generic["parameters"] or generic["origin"])


@pytest.mark.left_to_ci
def test_every_result_is_the_same_after_a_round_trip_through_json(full_report: Report) -> None:
    report = full_report
    named = [m for file in RESULTS for m in vars(file).values()]
    every = {m for m in named if isinstance(m, type) and issubclass(m, Frozen)}
    every = {m for m in {*every, GalleryScene, Alternative, StructureResult} if not is_generic(m)}
    bases = {Frozen, OfScheme, WithProse, separation.Separation, separation_parts.PartsOfRun}
    assert models(report) == every - bases, "the report holds an example of every model"
    assert Report.model_validate_json(report.model_dump_json()) == report
    for one in (*report.scenes[0].proofs, *report.scenes[0].runs, *report.scenes[0].series):
        assert type(one).model_validate_json(one.model_dump_json()) == one


def test_results_are_frozen_and_refuse_unknown_keys(full_report: Report) -> None:
    run = full_report.scenes[0].runs[0]
    with pytest.raises(ValidationError, match="frozen"):
        run.steps = 3  # type: ignore[misc]
    with pytest.raises(ValidationError, match="extra"):
        RunResult.model_validate({**run.model_dump(), "speed": 1})
