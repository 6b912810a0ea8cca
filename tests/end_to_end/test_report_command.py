"""`verify report` on a user's own scene: what it writes, keeps, and does when it is interrupted."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import RUN, SCENE, apart, arguments, here
from verify.commands.main import main
from verify.scenes.results.report import read_report

VERIFY = Path(sys.executable).with_name("verify")
# Twelve runs of a fifth of a second or more, so that an interruption that comes late still comes
# amid them, and of so few steps that none waits for a compiler; a series, two proofs.
TASKS = 15
LONG = SCENE.replace("p**2/2 + q**4/4", "p**2/2 - cos(q)").replace(
    'steps = 200\nstep_sizes = [0.01, "1/30", 0.05, 0.1]',
    "steps = 40000\nstep_sizes = [0.001, 0.002, 0.003, 0.004, 0.005, 0.006]",
)


def findings(folder: Path) -> Any:
    """The report's results without what tells of the call that made them."""

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {k: plain(v) for k, v in value.items() if k not in ("seconds", "provenance")}
        return [plain(v) for v in value] if isinstance(value, list) else value

    return plain(json.loads((folder / "results.json").read_text()))


def provenance(folder: Path) -> Any:
    return read_report(folder / "results.json").provenance


def kept(folder: Path) -> list[Path]:
    return sorted((folder / "kept").glob("*.json"))


@pytest.fixture
def scene(tmp_path: Path) -> str:
    path = tmp_path / "mine.toml"
    path.write_text(SCENE)
    return str(path)


# -- what is written ------------------------------------------------------------------------------


def test_a_report_of_a_users_scene_is_a_page_and_its_results(
    capsys: pytest.CaptureFixture[str], scene: str, tmp_path: Path
) -> None:
    folder = tmp_path / "out" / "deep"
    folder.parent.mkdir()
    status, out, err = here(capsys, "report", scene, "-o", str(folder))
    assert (status, err) == (0, "")
    assert "criterion 1" in out
    assert {f.name for f in folder.iterdir()} == {"index.html", "results.json", "kept"}
    page = (folder / "index.html").read_text()
    assert "<script>alert(1)" not in page, "the title is escaped"
    assert "&lt;script&gt;alert(1)" in page
    report = read_report(folder / "results.json")
    (found,) = report.scenes
    assert len(found.proofs) == 2
    assert (len(found.runs), len(found.series), len(found.criteria)) == (8, 1, 8)
    assert len(kept(folder)) == report.provenance.computed == 2 + 8 + 1


@pytest.mark.left_to_ci
def test_a_report_for_a_repository_is_markdown_with_its_figures(
    capsys: pytest.CaptureFixture[str], scene: str, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    status, out, err = here(capsys, "report", scene, "-o", str(folder), "--format", "md")
    assert (status, err) == (0, "")
    assert str(folder / "report.md") in out
    assert {f.name for f in folder.iterdir()} == {"report.md", "figures", "results.json", "kept"}
    text = (folder / "report.md").read_text(encoding="utf-8")
    assert "<script>" not in text
    paths = set(re.findall(r"\]\((figures/[^)]+)\)", text))
    assert paths == {f"figures/{f.name}" for f in (folder / "figures").iterdir()}
    assert provenance(folder).command.endswith("-o out --format md")
    both = ("--format", "html", "--format", "md")
    assert here(capsys, "report", scene, "-o", str(folder), *both)[0] == 0
    assert (folder / "index.html").exists()
    status, _, err = here(capsys, "report", scene, "-o", str(folder), "--format", "pdf")
    assert (status, err.count("\n")) == (2, 1)
    assert "pdf" in err


def test_a_report_in_json_is_one_object_with_its_claims(
    capsys: pytest.CaptureFixture[str], scene: str, tmp_path: Path
) -> None:
    status, out, err = here(capsys, "report", scene, "-o", str(tmp_path / "out"), "--json")
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert out.count("\n") == 1
    assert found["claims"] == []
    assert len(found["scenes"][0]["runs"]) == 8


def test_a_report_again_takes_up_what_is_kept_and_finds_the_same(
    capsys: pytest.CaptureFixture[str], scene: str, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    here(capsys, "report", scene, "-o", str(folder))
    first = findings(folder)
    kept(folder)[0].write_text("damaged")
    here(capsys, "report", scene, "-o", str(folder))
    assert (provenance(folder).kept, provenance(folder).computed) == (10, 1)
    assert findings(folder) == first


def test_an_orbit_that_leaves_the_range_does_not_end_the_report(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "wild.toml"
    path.write_text(SCENE.replace("q**4/4", "q**4").replace("0.1]", "2]"))
    status, _, err = here(capsys, "report", str(path), "-o", str(tmp_path / "out"))
    assert (status, err) == (0, "")
    runs = read_report(tmp_path / "out" / "results.json").scenes[0].runs
    assert "left range" in {run.status for run in runs}


def test_a_map_with_a_pole_at_h_0_is_bad_input(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert_pole_is_told(*here(capsys, *report_with_pole(tmp_path), "--workers", "1"))


@pytest.mark.left_to_ci
def test_nor_does_a_pole_end_workers_otherwise(tmp_path: Path) -> None:
    done = apart(*report_with_pole(tmp_path), "--workers", "2")
    assert_pole_is_told(done.returncode, done.stdout, done.stderr)


def report_with_pole(folder: Path) -> tuple[str, ...]:
    path = folder / "pole.toml"
    path.write_text(SCENE.replace('"symplectic-euler"', '"p_next = p + q*sqrt(h); q_next = q"'))
    return "report", str(path), "-o", str(folder / "out")


def assert_pole_is_told(status: int, out: str, err: str) -> None:
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert "not smooth in h" in err


# -- interruption ---------------------------------------------------------------------------------


@contextmanager
def started(*given: str) -> Iterator["subprocess.Popen[str]"]:
    """The command in a process group of its own, as a terminal starts it."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # these tests run in the background
        signal.signal(signal.SIGINT, signal.default_int_handler)
    process = subprocess.Popen([VERIFY, *given], start_new_session=True, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)  # fmt: skip
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def ended(group: int, seconds: float = 5) -> bool:
    """Whether all processes of the group end within that time."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.05)
    return False


def interrupt(process: "subprocess.Popen[str]") -> tuple[int, str, str]:
    """Ctrl-C: SIGINT to the whole group; what the command then says."""
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert ended(process.pid), "a worker goes on after the interruption"
    # click ends the line on which a terminal shows ^C.
    return process.returncode, out, err.removesuffix("\n")


def wait_for_one_kept(process: "subprocess.Popen[str]", folder: Path) -> None:
    """Until the first of a report's results is kept."""
    until = time.monotonic() + 60
    while not kept(folder) and time.monotonic() < until:
        assert process.poll() is None
        time.sleep(0.02)


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the long scene's report, made in one go by one process."""
    folder = tmp_path_factory.mktemp("uninterrupted")
    (folder / "long.toml").write_text(LONG)
    with redirect_stdout(StringIO()):
        main(["report", str(folder / "long.toml"), "-o", str(folder / "out"), "--workers", "1"])
    return folder / "out"


@pytest.mark.left_to_ci
@pytest.mark.parametrize("workers", ["1", "2"])
def test_an_interrupted_report_goes_on_from_what_it_kept(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, uninterrupted: Path, workers: str
) -> None:
    path, folder = tmp_path / "long.toml", tmp_path / "out"
    path.write_text(LONG)
    call = ["report", str(path), "-o", str(folder), "--workers", workers]
    with started(*call) as process:
        wait_for_one_kept(process, folder)
        status, out, err = interrupt(process)
    assert (status, out) == (130, "")
    finished = len(kept(folder))
    assert 1 <= finished < TASKS
    assert err.startswith("interrupted: ")
    assert err.count("\n") == 1
    assert f"{finished} of {TASKS} tasks are kept" in err
    assert {f.name for f in folder.iterdir()} == {"kept"}
    suffixes = {f.suffix for f in (folder / "kept").iterdir()}
    assert suffixes <= {".json", ".checkpoint"}, "no temporary file is left"
    status, _, err = here(capsys, *call)
    assert (status, err) == (0, "")
    assert {f.suffix for f in (folder / "kept").iterdir()} == {".json"}, "nor a checkpoint"
    assert provenance(folder).kept == finished
    assert findings(folder) == findings(uninterrupted)


@pytest.mark.left_to_ci
def test_an_interruption_while_workers_are_begun_is_told_in_a_line(tmp_path: Path) -> None:
    """Those that are begun have imports to do, and say nothing of an interruption amid them."""
    path, folder = tmp_path / "long.toml", tmp_path / "out"
    path.write_text(LONG)
    with started("report", str(path), "-o", str(folder), "--workers", "2") as process:
        until = time.monotonic() + 60
        while not any("forkserver" in name for name in group(process.pid)):
            assert time.monotonic() < until
            time.sleep(0.01)
        time.sleep(0.3)
        status, out, err = interrupt(process)
    assert (status, out) == (130, "")
    assert err.startswith(f"interrupted: 0 of {TASKS} tasks are kept")
    assert err.count("\n") == 1


def group(leader: int) -> list[str]:
    """The command lines of the processes of a group."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if os.getpgid(int(folder.name)) == leader:
                found.append((folder / "cmdline").read_text())
    return found


@pytest.mark.left_to_ci
@pytest.mark.parametrize("digits", [None, "30"], ids=["float64", "mpmath"])
def test_an_interrupted_run_says_nothing_and_ends_with_130(digits: str | None) -> None:
    changes = {"steps": "100000000000", "digits": digits}
    with started(*arguments("run", RUN, **changes), "--json") as process:
        time.sleep(2)
        assert process.poll() is None
        status, out, err = interrupt(process)
    assert (status, out, err) == (130, "", "")
