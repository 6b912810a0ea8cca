"""`verify flow`: its JSON keys, its text, what is kept, an interruption, exit statuses."""

from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import apart, here, json_of
from verify.execution.keeper import Keeper
from verify.scenes.results.regions import FlowImage
from verify.studies.kinds.regions import FlowTask

SCENE = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2", "symplectic-euler"]

[[flow]]
shape = "circle"
centre = { q = 1, p = 0 }
scale = 0.5
step_size = 0.1
steps = [10]
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(SCENE)
    return path


def test_json_has_the_change_the_probes_error_and_the_mean(
    capsys: pytest.CaptureFixture[str], scene: Path
) -> None:
    status, out, err = here(capsys, "flow", str(scene), "--json", "--workers", "1")
    assert (status, err) == (0, "")
    found = json_of(out)
    assert found["map"] == "lie2"
    assert abs(float(found["area_change"])) > 100 * float(found["probe_error"]) > 0
    assert abs(float(found["mean_lambda"]) / float(found["area_change"]) - 1) < 1e-2
    assert [image["map"] for image in found["images"]] == ["exact flow", "lie2", "symplectic-euler"]


def test_the_text_says_what_preserves_area_and_what_does_not(
    capsys: pytest.CaptureFixture[str], scene: Path
) -> None:
    status, out, _ = here(capsys, "flow", str(scene), "--workers", "1")
    assert status == 0
    title, head, exact, lie2, euler = out.splitlines()
    assert "circle at (q, p) = (1, 0), scale 0.5, h = 0.1" in title
    assert head.split("  ")[-1] == "from the exact flow"
    assert exact.split()[:6] == ["exact", "flow", "10", "1", "0,", "proved"]
    assert euler.split()[:5] == ["symplectic-euler", "10", "1", "0,", "proved"]
    assert lie2.split()[:3] == ["lie2", "10", "1"]
    assert "proved" not in lie2
    assert lie2.count("±") == 3
    assert "NOT THE SAME" not in out


def test_the_text_says_where_the_plane_of_a_pair_lies(capsys: pytest.CaptureFixture[str]) -> None:
    region = "--system henon-heiles --q 0,1/10 --p 2/5,0 --scale 1/10 --plane 1"
    steps = "--scheme lie2 --step-size 1/10 --steps 6"
    status, out, _ = here(capsys, "flow", *region.split(), *steps.split())
    assert status == 0
    assert "circle at (q1, p1) = (0, 0.4), scale 0.1, p2 = 0, q2 = 0.1" in out
    assert "∮ p·dq changes by" in out
    assert "NOT THE SAME" not in out


def test_a_map_whose_points_leave_has_status_1_and_says_so(
    capsys: pytest.CaptureFixture[str], scene: Path
) -> None:
    soft = SCENE.replace("delta = 1", "delta = -1").replace("[10]", "[300]").replace("0.5", "2")
    scene.write_text(soft)
    status, out, err = here(capsys, "flow", str(scene), "--workers", "1")
    assert (status, err) == (1, "")
    assert "blows up at t = " in out
    assert "leaves the range of float64" in out
    status, out, _ = here(capsys, "flow", str(scene), "--json", "--workers", "1")
    assert (status, json_of(out)["area_change"]) == (1, None)


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("circle", "dog", "dog"),
        ("[10]", "[0]", "steps"),
        ("scale = 0.5", "scale = 0", "must be greater than 0"),
        (SCENE[SCENE.index("[[flow]]") :], "", "asks for no [[flow]]"),
    ],
)
def test_bad_input_is_one_line(
    capsys: pytest.CaptureFixture[str], scene: Path, old: str, new: str, problem: str
) -> None:
    scene.write_text(SCENE.replace(old, new))
    status, out, err = here(capsys, "flow", str(scene))
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert problem in err


def test_an_interruption_keeps_what_is_finished(
    capsys: pytest.CaptureFixture[str],
    scene: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    keep, right, done = tmp_path / "kept", FlowTask.compute, list[str]()

    def third(task: FlowTask, keeper: Keeper) -> FlowImage:
        if len(done) == 2:
            raise KeyboardInterrupt
        done.append(task.map)
        return right(task, keeper)

    given = ("flow", str(scene), "--json", "--workers", "1", "--keep", str(keep))
    with monkeypatch.context() as patch:
        patch.setattr(FlowTask, "compute", third)
        status, out, err = here(capsys, *given)
    assert (status, out) == (130, "")
    assert f"interrupted: 2 of 3 tasks are kept in {keep}" in err
    with monkeypatch.context() as patch:
        done.clear()
        patch.setattr(FlowTask, "compute", third)
        status, out, _ = here(capsys, *given)
    assert (status, len(done)) == (0, 1)
    assert here(capsys, *given)[:2] == (0, out)


@pytest.mark.left_to_ci
def test_the_installed_command_carries_and_plans(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "carry circle by lie2, 10 steps of 0.1" in here(capsys, "plan", str(scene))[1]
    assert apart("flow", str(scene)).returncode == 0
