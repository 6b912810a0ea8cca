"""[work_precision] from the scene to the command: keys, tasks, peers, what runs alone, JSON."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from tests.helpers.constructed.scenes import DUFFING, GRID, HEAD, load
from tests.paths import ROOT
from verify.commands import main as cli
from verify.errors import InputError
from verify.execution import execute as execution
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.studies.kinds import work_precision as section_plan
from verify.studies.kinds.work_precision import WorkPrecisionTask
from verify.studies.tasks_of_scenes import Plan, plan_scenes

START = "initial_value = { q = 1, p = 0 }"
SECTION = f"[work_precision]\ntime = 1\nstep_sizes = [0.01, 0.005]\n{START}\n"
GOOD = HEAD + SECTION


def task_of(plan: Plan) -> WorkPrecisionTask:
    (found,) = (t for t in plan.tasks.values() if isinstance(t, WorkPrecisionTask))
    return found


# -- the scene ------------------------------------------------------------------------------------

BAD = {
    "unknown-key": (GOOD + "speed = 3", "work_precision.speed=3: unknown key"),
    "no-time": (HEAD + SECTION.replace("time = 1\n", ""), "work_precision.time"),
    "longer-than-time": (GOOD.replace("0.005", "2"), "step_size=2: makes 0 steps"),
    "too-many-steps": (GOOD.replace("0.005", "1e-9"), "makes 1000000000 steps"),
    "one-step-size": (GOOD.replace("0.01, ", ""), "work_precision.step_sizes"),
    "twice": (GOOD.replace("0.005", '"1/100"'), "step_sizes=2: one of them stands twice"),
    "no-repeat": (GOOD + "repeats = 0", "work_precision.repeats=0"),
    "unknown-scheme": (GOOD + 'schemes = ["rk5"]', "scheme=rk5: unknown"),
    "not-its-h": (
        GOOD.replace("p**2/2 + q**4/4", "p*q**2") + 'schemes = ["stormer-verlet"]',
        "hamiltonian=p*q**2",
    ),
    "systems-alone": (GOOD + 'number_systems = ["mpfr"]', "give both or neither"),
    "digits-alone": (GOOD + "digits = [20]", "give both or neither"),
    "auto": (GOOD + 'number_systems = ["auto"]\ndigits = [20]', "number_systems=auto: name the"),
    "unknown-system": (GOOD + 'number_systems = ["float16"]\ndigits = [20]', "arithmetic=float16"),
    "systems-scheme": (GOOD + 'number_systems_scheme = "rk5"', "scheme=rk5: unknown"),
    "systems-step": (GOOD + "number_systems_step_size = 3", "step_size=3: makes 0 steps"),
    "symbol": (DUFFING + SECTION, "parameter=delta"),
}


@pytest.mark.parametrize(("content", "named"), BAD.values(), ids=BAD)
def test_a_bad_section_is_an_input_error_that_names_it_in_one_line(
    tmp_path: Path, content: str, named: str
) -> None:
    with pytest.raises(InputError) as caught:
        load(tmp_path, content)
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_section_that_the_bad_ones_are_made_of_is_good(tmp_path: Path) -> None:
    assert load(tmp_path, GOOD).work_precision is not None


def test_what_is_left_out_is_taken_from_the_scene(tmp_path: Path) -> None:
    own = task_of(plan_scenes([load(tmp_path, GOOD)]))
    assert own.schemes == ("lie2",)
    assert own.number_systems_scheme == "lie2"
    other = task_of(plan_scenes([load(tmp_path, GOOD + 'schemes = ["rk4", "euler"]')]))
    assert other.schemes == ("rk4", "euler")
    assert other.number_systems_scheme == "rk4"


# -- peers ----------------------------------------------------------------------------------------


def without(monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    real = section_plan.find_spec
    monkeypatch.setattr(
        section_plan, "find_spec", lambda name: None if name == library else real(name)
    )


def test_peers_that_are_not_installed_are_left_out_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without(monkeypatch, "scipy")
    plan = plan_scenes([load(tmp_path, GOOD)])
    assert "DOP853" not in task_of(plan).peers
    assert dict(plan.left_out)["mine: DOP853 beside the schemes"].startswith("scipy is not inst")


def test_peers_that_are_not_wanted_are_left_out_and_named(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, GOOD + "peers = false")])
    assert task_of(plan).peers == ()
    assert "not asked for" in dict(plan.left_out)["mine: DOP853 beside the schemes"]


def test_peers_that_must_be_there_and_are_not_are_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without(monkeypatch, "heyoka")
    without(monkeypatch, "scipy")
    with pytest.raises(InputError, match="peers=true: scipy is not installed"):
        plan_scenes([load(tmp_path, GOOD + "peers = true")])


@pytest.mark.left_to_ci
def test_without_peers_their_libraries_are_not_imported(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(GOOD + "peers = false\nrepeats = 1")
    code = (
        "import sys; from pathlib import Path; from verify.scenes.scene import load_scene;"
        "from verify.studies.tasks_of_scenes import plan_scenes;"
        "from verify.execution.execute import Store, execute;"
        "from verify.execution.executors import THIS_PROCESS;"
        f"execute(plan_scenes([load_scene(Path({str(path)!r}))]), Store(None), where=THIS_PROCESS);"
        "assert not {'scipy.integrate', 'heyoka', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


def test_the_plan_tells_what_is_timed(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(GOOD)
    done = CliRunner().invoke(cli.cli, ["plan", str(path)])
    assert "error against run time of 1 schemes at 2 step sizes over [0, 1]" in done.stdout


# -- what runs when -------------------------------------------------------------------------------


def test_what_is_timed_runs_when_all_else_is_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[Any] = []
    perform = execution.compute_all

    def noting(task: Any, *more: Any) -> list[tuple[str, Frozen]]:
        seen.append(task)
        return perform(task, *more)

    monkeypatch.setattr(execution, "compute_all", noting)
    both = [load(tmp_path, GOOD + "peers = false\nrepeats = 1\n"), load(tmp_path, HEAD + GRID)]
    plan = plan_scenes(both)
    assert not isinstance(list(plan.tasks.values())[-1], WorkPrecisionTask)
    results = execute(plan, Store(None), where=THIS_PROCESS)
    assert set(results) == set(plan.tasks)
    assert isinstance(seen[-1], WorkPrecisionTask)
    assert [t.alone for t in seen] == [False] * (len(seen) - 1) + [True]
    assert not RunTask.alone


# -- the command ----------------------------------------------------------------------------------


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(
        DUFFING
        + "parameters = { delta = 1 }\n"
        + SECTION.replace("q = 1", "q = 30").replace("0.01, 0.005", "0.125, 0.01, 0.001, 0.0005")
        + 'schemes = ["lie1", "stormer-verlet", "lie2"]\nrepeats = 1\npeers = false\n'
        + 'number_systems = ["mpfr"]\ndigits = [20]\nnumber_systems_step_size = 0.0005\n'
        + 'number_systems_scheme = "stormer-verlet"\n'
    )
    return path


def test_json_has_the_keys_that_scripts_rely_on_and_failed_runs_too(scene_file: Path) -> None:
    done = CliRunner().invoke(cli.cli, ["bench", str(scene_file), "--json"])
    assert done.exit_code == 0, done.output
    data = json.loads(done.stdout)
    keys = {
        "scheme", "step_size", "error", "lambda", "seconds_min", "seconds_median", "limited_by",
        "lambda_limited_by", "rounding", "truncation", "energy_error", "lambda_plain", "tolerance",
    }  # fmt: skip
    assert len(data["points"]) == 12
    for point in data["points"]:
        assert keys <= set(point)
        for name in ("step_size", "error", "lambda", "seconds_min", "seconds_median"):
            assert point[name] is None or isinstance(point[name], str)
            assert point[name] is None or float(point[name]) is not None
    failed = [p for p in data["points"] if p["limited_by"] == "failed"]
    assert failed
    assert all(p["error"] is None and p["failed_step"] >= 1 for p in failed)
    (rest,) = data["scenes"]
    assert rest["comparisons"]
    assert len(rest["lines"]) == 3


def test_the_table_shows_failed_runs_and_what_follows(scene_file: Path) -> None:
    done = CliRunner().invoke(cli.cli, ["bench", str(scene_file)])
    assert done.exit_code == 0, done.output
    text = " ".join(done.stdout.split())
    assert "failed" in text
    assert "At equal run time" in text
    assert "not drawn: DOP853 (not asked for; `peers = true` in a scene asks, --peers" in text


def test_what_is_measured_in_one_line_says_how_peers_are_asked_for() -> None:
    line = "bench --system harmonic --param omega=1 --scheme lie1 --q 1 --p 0 --time 1 --repeats 1"
    given = [*line.split(), "--step-size", "0.5", "--step-size", "0.25"]
    done = CliRunner().invoke(cli.cli, given)
    assert done.exit_code == 0, done.output
    text = " ".join(done.stdout.split())
    assert "not drawn: DOP853 (not asked for; " in text
    assert "--peers in one line" in text


@pytest.mark.left_to_ci
def test_the_plot_is_written_as_one_svg(scene_file: Path, tmp_path: Path) -> None:
    from xml.etree import ElementTree

    path = tmp_path / "plot.svg"
    done = CliRunner().invoke(cli.cli, ["bench", str(scene_file), "-o", str(path)])
    assert done.exit_code == 0, done.output
    root = ElementTree.parse(path).getroot()  # noqa: S314 - our own
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    shown = "".join(root.itertext())
    for title in ("(a) error against run time", "(b) error against h", "(c) |Λ|", "(d) certified"):
        assert title in shown


@pytest.mark.parametrize(
    ("content", "more", "named"),
    [(HEAD, [], "has no [work_precision]"), (GOOD, ["-o", "x.png"], "must end in .svg")],
)
def test_what_cannot_be_benched_is_one_line(
    tmp_path: Path, content: str, more: list[str], named: str
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(content)
    done = CliRunner().invoke(cli.cli, ["bench", str(path), *more])
    assert isinstance(done.exception, InputError)
    assert named in str(done.exception)
