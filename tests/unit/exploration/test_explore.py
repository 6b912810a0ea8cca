"""Exploring: scenes by seed and number, what is counted, shrunk and kept; claims as properties."""

from pathlib import Path

import pytest

from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.exploration import properties
from verify.exploration.exploring import Exploration, explore, load_failures, save_failures
from verify.exploration.property import Property, Violation
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes_of_seed import sample_scene
from verify.exploration.tasks import ExploreTask
from verify.hamiltonians.canonical_field import canonical_field
from verify.scenes.results.exploration import ExploreReport
from verify.scenes.scene import load_scene, scene_text

CHEAP = ("quadratic-hamiltonians", "time-scaling")
LIES = SampleSpace(schemes=("lie1", "lie2"), degree=3)


def exploration(**changes: object) -> Exploration:
    given = {"seed": 7, "examples": 30, "properties": CHEAP, "drawn": LIES}
    return Exploration(**(given | changes))  # type: ignore[arg-type]


def plant(monkeypatch: pytest.MonkeyPatch, planted: Property) -> None:
    """The property is in the catalogue under its name."""
    others = properties.get

    def get(name: str) -> Property:
        return planted if name == planted.name else others(name)

    monkeypatch.setattr(properties, "get", get)


@pytest.fixture
def odd_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """A property with a planted falsehood: no H has q³ in it."""

    def holds(sample: Sample) -> None:
        if "q**3" in (sample.scene.hamiltonian or ""):
            raise Violation("it has q**3")

    made = Property("no-cubes", "No H has q³ in it, which is wrong.", holds)
    plant(monkeypatch, made)


# -- scenes ---------------------------------------------------------------------------------------


def test_scene_k_of_a_seed_is_always_the_same() -> None:
    forwards = [scene_text(sample_scene(LIES, 7, k)) for k in range(12)]
    backwards = [scene_text(sample_scene(LIES, 7, k)) for k in reversed(range(12))]
    assert forwards == backwards[::-1]
    assert len(set(forwards)) > 8
    assert forwards != [scene_text(sample_scene(LIES, 8, k)) for k in range(12)]


def test_what_is_asked_for_is_drawn() -> None:
    scenes = [sample_scene(LIES, 3, k) for k in range(40)]
    assert {scene.schemes for scene in scenes} == {("lie1",), ("lie2",)}
    rational = SampleSpace(kinds=("rational",), schemes=("lie1",))
    assert all("/(" in (sample_scene(rational, 3, k).hamiltonian or "") for k in range(10))


def test_separable_schemes_get_separable_hamiltonians() -> None:
    asked = SampleSpace(schemes=("stormer-verlet",), degree=4)
    for k in range(20):
        assert canonical_field(sample_scene(asked, 1, k).exact_hamiltonian())[0].separable


# -- counting, shrinking --------------------------------------------------------------------------


def test_examples_are_counted_and_properties_hold() -> None:
    report = explore(exploration(), Store(None), where=THIS_PROCESS)
    assert (report.seed, report.examples, report.failures) == (7, 30, ())
    assert [p.name for p in report.properties] == list(CHEAP)
    assert all(p.failures == 0 and 0 < p.looked_at <= 30 for p in report.properties)


def test_how_the_work_is_cut_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = explore(exploration(), Store(None), where=THIS_PROCESS)
    monkeypatch.setattr("verify.exploration.exploring._MIN_SCENES_OF_TASK", 7)
    assert len(exploration().plan.tasks) == 5
    assert explore(exploration(), Store(None), where=THIS_PROCESS) == whole


@pytest.mark.parametrize("examples", [1, 50, 51, 49_999, 1_000_000, 1_000_003])
def test_the_plan_of_a_million_scenes_is_that_of_some_thousand_tasks(examples: int) -> None:
    tasks = list(exploration(examples=examples).plan.tasks.values())
    assert len(tasks) <= 1000
    held = [(task.first, task.count) for task in tasks if isinstance(task, ExploreTask)]
    ends = [0, *(first + count for first, count in held)]
    assert [first for first, _ in held] == ends[:-1], "each scene once, and none left out"
    assert ends[-1] == examples


def failing(**changes: object) -> ExploreReport:
    asked = exploration(properties=("no-cubes",), examples=30, **changes)
    return explore(asked, Store(None), where=THIS_PROCESS)


@pytest.mark.left_to_ci
@pytest.mark.usefixtures("odd_is_wrong")
def test_a_failure_is_shrunk_to_the_simplest_scene(tmp_path: Path) -> None:
    report = failing()
    (summary,), (failure,) = report.properties, report.failures
    assert summary.looked_at == 30
    assert 0 < summary.failures < 30
    assert failure.message == "it has q**3"
    (path,) = save_failures(report, tmp_path)
    scene = load_scene(path)
    assert "q**3" in (scene.hamiltonian or "")
    assert len(scene.hamiltonian or "") <= 20, "shrunk"
    assert scene.schemes == ("lie1",)
    assert scene.grid is not None
    assert scene.grid.steps == 1
    assert failing() == report, "the same each time"


@pytest.mark.usefixtures("odd_is_wrong")
def test_found_scenes_are_looked_at_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    save_failures(failing(), tmp_path)
    asked = exploration(properties=("no-cubes",), examples=1)
    report = explore(asked, Store(None), where=THIS_PROCESS, earlier=load_failures(tmp_path))
    assert [again.message for again in report.again] == ["it has q**3"]
    mended = Property("no-cubes", "Now anything goes with it.", lambda _: None)
    plant(monkeypatch, mended)
    report = explore(asked, Store(None), where=THIS_PROCESS, earlier=load_failures(tmp_path))
    assert [again.message for again in report.again] == [""]


def test_an_exception_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    def holds(_: Sample) -> None:
        raise ZeroDivisionError("by\nzero")

    made = Property("raises", "It divides by zero in every scene.", holds)
    plant(monkeypatch, made)
    report = explore(
        exploration(properties=("raises",), examples=2), Store(None), where=THIS_PROCESS
    )
    assert report.properties[0].failures == 2
    assert report.failures[0].message == "raised ZeroDivisionError: by zero"


def test_kept_results_are_taken_up_and_give_the_same_report(tmp_path: Path) -> None:
    first = explore(exploration(), Store(tmp_path), where=THIS_PROCESS)
    store = Store(tmp_path)
    assert explore(exploration(), store, where=THIS_PROCESS) == first
    assert store.taken == len(exploration().plan.tasks)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"examples": 0}, "examples"),
        ({"seed": -1}, "seed"),
        ({"properties": ("nothing",)}, "property"),
        ({"properties": ()}, "properties"),
        ({"drawn": SampleSpace(kinds=("blue",))}, "kinds"),
        ({"drawn": SampleSpace(degree=0)}, "degree"),
        ({"drawn": SampleSpace(schemes=("lie0",))}, "scheme"),
    ],
)
def test_bad_arguments_are_named(changes: dict[str, object], name: str) -> None:
    with pytest.raises(InputError) as error:
        exploration(**changes)
    assert error.value.name == name


def test_other_files_in_the_folder_are_no_found_scenes(tmp_path: Path) -> None:
    (tmp_path / "claims.toml").write_text("[[claim]]\n")
    (tmp_path / "worst-1.toml").write_text("x =")
    assert load_failures(tmp_path) == []
    broken = tmp_path / "time-scaling.0123abcd.toml"
    broken.write_text("x =")
    with pytest.raises(InputError, match="is not TOML"):
        load_failures(tmp_path)
    broken.write_text('hamiltonian = "p**2"\nschemes = ["lie1"]\n')
    with pytest.raises(InputError, match=r"time-scaling.0123abcd.toml: has no \[grid\]"):
        load_failures(tmp_path)
