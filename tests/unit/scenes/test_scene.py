"""Scenes: exact numbers, every bad key or value named in one line; the same after JSON."""

from fractions import Fraction
from pathlib import Path

import pytest
from pydantic import ValidationError

from tests.helpers.constructed.galleries import gallery, shown
from tests.paths import ROOT
from verify.claims.file import load_claims
from verify.claims.report import make_report
from verify.errors import InputError
from verify.execution import execute
from verify.execution.executors import THIS_PROCESS
from verify.scenes.frozen import Frozen, OfScheme, WithProse
from verify.scenes.results import bounded_value as value
from verify.scenes.results import claim, growth, proof, separation, separation_in_degrees
from verify.scenes.results import poincare as poincare_results
from verify.scenes.results import regions as flow_results
from verify.scenes.results import report as scene_results
from verify.scenes.results import run as run_results
from verify.scenes.results import stability as stability_results
from verify.scenes.results import stroboscopic as stroboscopic_results
from verify.scenes.results import work_precision as work_precision_results
from verify.scenes.results.exploration import GalleryScene
from verify.scenes.results.proof import Formulas
from verify.scenes.results.report import Report, SceneResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.work_precision import RatioResult
from verify.scenes.scene import Scene, load_scene
from verify.scenes.values import MAX_STEPS
from verify.studies.plan import plan_scenes

PAPER = ROOT / "reports" / "paper"
H = "p**2/2 + q**4/4"
HEAD = f'hamiltonian = "{H}"\nschemes = ["lie2"]\n'
START = "initial_values = [{ q = 1.5, p = 0 }]"
GRID = f"[grid]\ntime = 1\nstep_sizes = [0.1]\n{START}\n"
SERIES = "[[series]]\ntime = 1\nstep_size = 0.1\ninitial_value = { q = 1.5, p = 0 }\n"
GOOD = HEAD + GRID + SERIES
DUFFING = 'system = "duffing"\nschemes = ["lie2"]\n'


def load(folder: Path, content: str | bytes) -> Scene:
    path = folder / "mine.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return load_scene(path)


# name -> (content, what the message must hold)
BAD: dict[str, tuple[str | bytes, str]] = {
    "unknown-key": (HEAD + "speed = 3\n", "speed=3: unknown key"),
    "unknown-key-in-grid": (HEAD + GRID + "fast = true\n", "grid.fast=True: unknown key"),
    "unknown-key-in-series": (HEAD + SERIES + "x = 1\n", "series.0.x=1: unknown key"),
    "unknown-key-in-start": (HEAD + GRID.replace("p = 0", "p = 0, r = 1"), "r=1: unknown key"),
    "unknown-table": (GOOD + "[gird]\n", "gird={}: unknown key"),
    "q-nan": (HEAD + GRID.replace("1.5", "nan"), "initial_values.0.q: number=nan"),
    "q-inf": (HEAD + GRID.replace("1.5", "-inf"), "initial_values.0.q: number=-inf"),
    "q-true": (HEAD + GRID.replace("1.5", "true"), "number=True"),
    "q-date": (HEAD + GRID.replace("1.5", "1979-05-27"), "datetime.date(1979, 5, 27)"),
    "p-missing": (HEAD + GRID.replace(", p = 0", ""), "initial_values.0.p"),
    "h-zero": (HEAD + GRID.replace("0.1", "0"), "step_size=0: must be greater than 0"),
    "h-negative": (HEAD + GRID.replace("0.1", "-0.1"), "step_size=-0.1: must be greater"),
    "h-inf": (HEAD + GRID.replace("0.1", "inf"), "step_size=inf"),
    "h-exponent": (HEAD + GRID.replace("0.1", "1e-99999"), "step_size=1e-99999: exponent"),
    "h-not-a-list": (HEAD + GRID.replace("[0.1]", "0.1"), "grid.step_sizes=0.1"),
    "h-none": (HEAD + GRID.replace("[0.1]", "[]"), "grid.step_sizes=[]"),
    "h-beyond-time": (HEAD + GRID.replace("0.1", "1.5"), "step_size=1.5: makes 0 steps"),
    "h-too-small": (HEAD + GRID.replace("0.1", "1e-13"), "step_size=0.0000000000001: makes"),
    "h-4301-digits": (HEAD + GRID.replace("0.1", "1" * 4301), "is not TOML"),
    "h-huge-hex": (HEAD + GRID.replace("0.1", "0x" + "f" * 9000), "step_size"),
    "q-huge-hex": (HEAD + GRID.replace("1.5", "0x" + "f" * 9000), "number"),
    "time-negative": (HEAD + GRID.replace("time = 1", "time = -1"), "grid.time"),
    "time-zero": (HEAD + GRID.replace("time = 1", "time = 0"), "grid.time"),
    "time-and-steps": (HEAD + GRID.replace("time", "steps = 5\ntime"), "give one of the two"),
    "neither-time-nor-steps": (HEAD + GRID.replace("time = 1\n", ""), "give one of the two"),
    "n-zero": (HEAD + GRID.replace("time = 1", "steps = 0"), "grid.steps=0"),
    "n-negative": (HEAD + GRID.replace("time = 1", "steps = -5"), "grid.steps=-5"),
    "n-fraction": (HEAD + GRID.replace("time = 1", "steps = 2.5"), "grid.steps=2.5"),
    "n-true": (HEAD + GRID.replace("time = 1", "steps = true"), "grid.steps=True"),
    "n-huge": (HEAD + GRID.replace("time = 1", f"steps = {MAX_STEPS + 1}"), "grid.steps"),
    "series-h-zero": (HEAD + SERIES.replace("0.1", "0"), "series.0.step_size"),
    "series-n-zero": (HEAD + SERIES.replace("time = 1", "steps = 0"), "series.0.steps"),
    "series-h-beyond-time": (HEAD + SERIES.replace("0.1", "1.5"), "step_size=1.5"),
    "series-too-many-steps": (HEAD + SERIES.replace("0.1", "1e-300"), "steps"),
    "series-one-point": (HEAD + SERIES + "points = 1\n", "series.0.points=1"),
    "series-a-table": (HEAD + SERIES.replace("[[series]]", "[series]"), "series="),
    "unknown-scheme": (HEAD.replace("lie2", "rk5"), "scheme=rk5: unknown; is rk4 meant"),
    "scheme-lie0": (HEAD.replace("lie2", "lie0"), "scheme=lie0: η must be 1 … 100"),
    "scheme-not-a-list": (HEAD.replace('["lie2"]', '"lie2"'), "schemes=lie2"),
    "no-scheme": (HEAD.replace('["lie2"]', "[]"), "schemes=[]"),
    "scheme-half-a-map": (HEAD.replace("lie2", "p_next = p"), "scheme=p_next = p"),
    "scheme-of-unknown-names": (HEAD.replace("lie2", "p_next = x; q_next = q"), "name 'x'"),
    "scheme-not-separable": (
        'hamiltonian = "p*q**2"\nschemes = ["symplectic-euler"]', "hamiltonian=p*q**2"),
    "unknown-system": ('system = "lorenz"\nschemes = ["lie2"]', "system=lorenz: unknown; allowed"),
    "unknown-observable": (HEAD + GRID + 'observables = ["energy"]', "observable=energy: unknown"),
    "unknown-arithmetic": (HEAD + GRID + 'arithmetic = "float16"', "arithmetic=float16: unknown"),
    "digits-zero": (HEAD + GRID + "digits = 0", "grid.digits=0"),
    "criterion-5": (HEAD + "criteria = [5]\n", "criteria.0=5"),
    "criterion-true": (HEAD + "criteria = [true]\n", "criteria.0=True"),
    "system-and-hamiltonian": (HEAD + 'system = "duffing"\n', "give one of the two"),
    "neither-system-nor-hamiltonian": ('schemes = ["lie2"]', "give one of the two"),
    "parameter-nan": (DUFFING + "parameters = { delta = nan }", "delta"),
    "parameter-unknown": (DUFFING + "parameters = { eps = 1 }", "parameter=eps"),
    "symbol-with-a-grid": (DUFFING + GRID, "parameter=delta"),
    "symbol-with-a-series": (DUFFING + SERIES, "parameter=delta"),
    "formula-code": (HEAD.replace(H, "__import__('os').getcwd()"), "hamiltonian="),
    "formula-not-smooth": (HEAD.replace(H, "abs(q)"), "abs is not smooth"),
    "formula-nested": (HEAD.replace(H, "(" * 3000 + "q" + ")" * 900), "hamiltonian="),
    "name-a-number": ("name = 3\n" + HEAD, "name=3"),
    "not-utf8": (b"\xff\xfe" + HEAD.encode(), "is not UTF-8"),
    "not-toml": ("hamiltonian = \n", "is not TOML"),
    "key-twice": (HEAD + HEAD, "is not TOML"),
    "nested-lists": ("a = " + "[" * 20000, "is not TOML"),
    "nested-tables": ("a = " + "{a=" * 20000, "is not TOML"),
    "dotted-deeply": (".".join("a" * 3000) + " = 1", "mine.toml"),
    "empty": ("", "schemes"),
}  # fmt: skip


@pytest.mark.parametrize(("content", "named"), BAD.values(), ids=BAD)
def test_a_bad_scene_is_an_input_error_that_names_it_in_one_line(
    tmp_path: Path, content: str | bytes, named: str
) -> None:
    with pytest.raises(InputError) as caught:
        load(tmp_path, content)
    message = str(caught.value)
    assert named in message
    assert "mine.toml" in message
    assert "\n" not in message
    assert len(message) < 500


def test_the_scene_that_the_bad_ones_are_made_of_is_good(tmp_path: Path) -> None:
    scene = load(tmp_path, GOOD)
    assert (scene.name, len(scene.series)) == ("mine", 1)


@pytest.mark.parametrize("path", ["missing.toml", ".", "/dev/null/x"])
def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, path: str) -> None:
    with pytest.raises(InputError, match=r"^file="):
        load_scene(tmp_path / path)


# -- exactness ------------------------------------------------------------------------------------


def test_decimals_of_a_scene_are_exact(tmp_path: Path) -> None:
    scene = load(tmp_path, 'system = "duffing"\nschemes = ["lie2"]\nparameters = { delta = 0.1 }\n'
                 '[grid]\ntime = 3\nstep_sizes = [0.001, 2e-3, "1/3"]\n'
                 'initial_values = [{ q = 0.7, p = "-7/3" }]')  # fmt: skip
    assert scene.grid is not None
    assert scene.grid.step_sizes == (Fraction(1, 1000), Fraction(1, 500), Fraction(1, 3))
    assert scene.parameters == {"delta": Fraction(1, 10)}
    start = scene.grid.initial_values[0]
    assert (start.q, start.p) == (Fraction(7, 10), Fraction(-7, 3))
    assert [scene.grid.steps_for(h) for h in scene.grid.step_sizes] == [3000, 1500, 9]


@pytest.mark.parametrize(
    ("asked", "arithmetic"),
    [
        ("", "float64"),
        ("digits = 30\n", "auto"),
        ('arithmetic = "float64"\ndigits = 30\n', "float64"),
        ('arithmetic = "mpfr"\n', "mpfr"),
    ],
)
def test_digits_alone_ask_for_the_fastest_arithmetic_that_certifies_them(
    tmp_path: Path, asked: str, arithmetic: str
) -> None:
    scene = load(tmp_path, HEAD + GRID + asked + SERIES + asked)
    assert scene.grid is not None
    assert {scene.grid.arithmetic, *(x.arithmetic for x in scene.series)} == {arithmetic}
    assert {task["arithmetic"] for task in plan_scenes([scene]).as_json()["tasks"]
            if task["kind"] == "run"} == {arithmetic}  # fmt: skip


def test_the_steps_are_the_whole_ones_that_fit_into_the_time(tmp_path: Path) -> None:
    grid = load(tmp_path, HEAD + GRID.replace("[0.1]", "[0.3, 0.5, 1]")).grid
    assert grid is not None
    assert [grid.steps_for(h) for h in grid.step_sizes] == [3, 2, 1]


# -- JSON -----------------------------------------------------------------------------------------

RESULTS = (
    claim,
    growth,
    poincare_results,
    proof,
    separation,
    separation_in_degrees,
    value,
    run_results,
    scene_results,
    stability_results,
    stroboscopic_results,
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
    return made.model_copy(update={"gallery": gallery(shown()), "scenes": scenes})


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


@pytest.mark.left_to_ci
def test_every_result_is_the_same_after_a_round_trip_through_json(full_report: Report) -> None:
    report = full_report
    named = [m for file in RESULTS for m in vars(file).values()]
    every = {m for m in named if isinstance(m, type) and issubclass(m, Frozen)} | {GalleryScene}
    assert models(report) == every - {Frozen, OfScheme, WithProse}, (
        "the report holds an example of every model"
    )
    assert Report.model_validate_json(report.model_dump_json()) == report
    for one in (*report.scenes[0].proofs, *report.scenes[0].runs, *report.scenes[0].series):
        assert type(one).model_validate_json(one.model_dump_json()) == one


def test_results_are_frozen_and_refuse_unknown_keys(full_report: Report) -> None:
    run = full_report.scenes[0].runs[0]
    with pytest.raises(ValidationError, match="frozen"):
        run.steps = 3  # type: ignore[misc]
    with pytest.raises(ValidationError, match="extra"):
        RunResult.model_validate({**run.model_dump(), "speed": 1})
