"""`verify explore`: the same from a seed everywhere, interrupted and resumed, claims, bad input."""

import errno
import time
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import apart, here, json_of
from tests.end_to_end.test_report_command import ended, interrupt, started

QUICK = ("explore", "--property", "quadratic-hamiltonians", "--property", "time-scaling",
         "--scheme", "lie2", "--degree", "3", "--seed", "5", "--json")  # fmt: skip
FALSE = """
[[claim]]
id = "fourth-order"
statement = "ΔJ of lie2 is O(h⁴)."
kind = "order"
scheme = "lie2"
hamiltonian = "p**2/2 + q**2/2"
order = 4
at_least = true
"""


@pytest.mark.left_to_ci
def test_the_same_seed_gives_the_same_bytes_on_one_worker_and_on_two(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = (*QUICK, "--examples", "55")  # of two tasks
    one, two = (
        apart(*asked, "--workers", "1", cwd=tmp_path),
        here(capsys, *asked, "--workers", "2"),
    )
    assert (one.returncode, one.stdout, one.stderr) == two
    assert two[::2] == (0, "")
    found = json_of(one.stdout)
    assert (found["examples"], found["seed"], found["failures"]) == (55, 5, [])
    assert not (tmp_path / "explored").exists(), "nothing failed, nothing is written"


@pytest.mark.left_to_ci
def test_an_interrupted_exploration_goes_on_to_the_same_bytes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = (*QUICK, "--examples", "85", "--keep", str(tmp_path / "kept"), "--workers", "1",
             "-o", str(tmp_path / "found"))  # fmt: skip
    with started(*asked) as process:
        until = time.monotonic() + 60
        while not list((tmp_path / "kept").glob("*.json")):
            assert time.monotonic() < until
            assert process.poll() is None, "it is done before it is interrupted"
            time.sleep(0.02)
        status, out, err = interrupt(process)
    assert (status, out) == (130, "")
    assert "1 of 2 tasks are kept in" in err
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "kept").glob("*.json")}
    resumed = here(capsys, *asked)
    assert resumed[0] == 0
    assert {p: p.stat().st_mtime_ns for p in kept} == kept, "what was finished is not done again"
    fresh = here(capsys, *QUICK, "--examples", "85", "--workers", "1")
    assert resumed == fresh


@pytest.mark.left_to_ci
def test_a_terminated_exploration_leaves_no_process_and_keeps_what_is_finished(
    tmp_path: Path,
) -> None:
    """As a job's manager ends it: SIGTERM, to the one process that it knows."""
    kept = tmp_path / "kept"
    asked = (*QUICK, "--examples", "100000", "--keep", str(kept), "--workers", "2")
    with started(*asked) as process:
        until = time.monotonic() + 60
        while len(list(kept.glob("*.json"))) < 2:
            assert time.monotonic() < until
            time.sleep(0.05)
        process.terminate()
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (143, "", "")
    assert ended(process.pid, 30), "others are left behind"


def test_a_false_claim_is_shrunk_to_a_scene_that_report_takes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("claims.toml").write_text(FALSE)
    asked = ("explore", "claims.toml", "--examples", "20", "--seed", "1", "--degree", "3",
             "--kind", "polynomial", "--workers", "1", "--json")  # fmt: skip
    status, out, _ = here(capsys, *asked)
    assert status == 1
    (failure,) = json_of(out)["failures"]
    assert failure["property"] == "fourth-order"
    path = Path(failure["file"])
    assert path.read_text() == failure["scene"]
    assert 'schemes = ["lie2"]' in failure["scene"], "the scheme that the claim speaks of"
    assert here(capsys, "report", str(path), "-o", "page", "--workers", "1")[0] == 0
    assert Path("page/index.html").exists()
    status, out, _ = here(capsys, *asked[:-1])
    assert status == 1
    assert "still fails" in out
    assert "FAILS for" in out
    assert "1 property fails" in out


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--examples", "0"), "examples=0"),
        (("--examples", "1e6"), "--examples=1e6: must be a whole number; write 1000000"),
        (("--seed", "-1"), "seed=-1"),
        (("--property", "nothing"), "property=nothing: unknown; allowed: area-errors-compose"),
        (("--kind", "blue"), "--kind=blue: unknown; allowed: polynomial"),
        (("--degree", "0"), "degree=0"),
        (("--degrees", "0"), "degrees=0: must be a whole number, 1 … 8"),
        (("--degrees", "2", "--maximise", "rounding-share"), "is of one degree of freedom"),
        (("--scheme", "lie0"), "scheme=lie0"),
        (("missing.toml",), "CLAIMS=missing.toml: is no file"),
        (("--maximise", "size"), "maximise=size: unknown; allowed: rounding-share"),
        (("--maximise", "growth", "--property", "time-scaling"), "--maximise=growth: takes no"),
        (("--maximise", "growth", "--steps", "1"), "steps=1"),
        (("--maximise", "growth", "--examples", "0"), "examples=0"),
        (("--workers", "0"), "--workers"),
    ],
)
def test_bad_input_is_one_line(
    more: tuple[str, ...],
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    status, out, err = here(capsys, "explore", *more)
    assert (status, out) == (2, "")
    assert said in err
    assert err.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("option", ["-o", "--keep"])
def test_where_nothing_can_be_written_nothing_is_begun(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    for folder in ("file", "file/below"):
        status, out, err = here(capsys, "explore", "--examples", "1", option, folder)
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert f"{'--output' if option == '-o' else option}={folder}: " in err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.left_to_ci
def test_what_cannot_be_written_is_told_all_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.chdir(tmp_path)
    Path("claims.toml").write_text(FALSE)
    monkeypatch.setattr("verify.exploration.exploring.write_atomically", full)
    status, out, err = here(capsys, "explore", "claims.toml", "--examples", "20", "--seed", "1",
                            "--degree", "3", "--workers", "1")  # fmt: skip
    assert status == 2
    assert "fourth-order fails at example" in out
    assert "→ not written" in out
    assert err == "verify: --output=explored: No space left on device\n"


def test_claims_that_no_other_scene_can_be_asked_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    own = FALSE.replace("fourth-order", "formula").replace("order = 4", 'formula = "0"')
    own = own.replace('"order"', '"delta_j"').replace("at_least = true", "")
    asked = ("explore", "claims.toml", "--examples", "1", "--seed", "1", "--workers", "1")
    Path("claims.toml").write_text(own)
    status, out, err = here(capsys, *asked)
    assert (status, out) == (2, "")
    assert "claim=formula: a printed formula is that of its own Hamiltonian" in err
    Path("claims.toml").write_text(FALSE.replace("order = 4", "order = 3") + own)
    status, out, _ = here(capsys, *asked)
    assert status == 0
    assert "left out, as a printed formula is that of its own Hamiltonian: formula\n" in out
    found = json_of(here(capsys, *asked, "--json")[1])
    assert [each["claim"] for each in found["left_out"]] == ["formula"]


def test_without_a_seed_one_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    asked = ("explore", "--property", "quadratic-hamiltonians", "--examples", "1", "--json")
    seeds = {json_of(here(capsys, *asked)[1])["seed"] for _ in range(2)}
    assert len(seeds) == 2


# -- several degrees of freedom -------------------------------------------------------------------


def test_scenes_of_two_degrees_are_drawn_and_the_properties_speak(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    asked = ("explore", "--degrees", "2", "--kind", "polynomial", "--degree", "3",
             "--time-dependent", "--examples", "12", "--seed", "3", "--json",
             "--property", "uncoupled-systems", "--property", "extended-system",
             "--property", "growth-laws")  # fmt: skip
    status, out, err = here(capsys, *asked)
    assert (status, err) == (0, "")
    found = {each["name"]: each for each in json_of(out)["properties"]}
    assert found["uncoupled-systems"]["looked_at"] > 2
    assert found["extended-system"]["looked_at"] > 0
    assert found["growth-laws"]["looked_at"] == 0, "it is of the plane"
    assert not sum(each["failures"] for each in found.values())


@pytest.mark.left_to_ci
def test_a_false_claim_fails_for_two_degrees_and_its_scene_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("claims.toml").write_text(FALSE)
    status, out, _ = here(capsys, "explore", "claims.toml", "--degrees", "2", "--examples", "8",
                          "--kind", "polynomial", "--degree", "3", "--seed", "1")  # fmt: skip
    assert status == 1
    assert "fourth-order  FAILS for" in out
    (written,) = Path("explored").glob("*.toml")
    assert "q1" in written.read_text()


def test_a_hunt_of_two_degrees_writes_scenes_and_their_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    asked = ("explore", "--degrees", "2", "--kind", "polynomial", "--degree", "3", "--maximise",
             "defect", "--examples", "12", "--steps", "5", "--seed", "3",
             "-o", "worst")  # fmt: skip
    status, out, _ = here(capsys, *asked, "--json")
    found = json_of(out)
    assert status == 0
    values = [float(each["value"]) for each in found["worst"]]
    assert values == sorted(values, reverse=True)
    assert values
    assert Path("worst/worst-1.toml").read_text() == found["worst"][0]["scene"]
    assert Path("worst/index.html").exists()
    again = here(capsys, *asked, "--json")[1]
    assert json_of(again)["worst"] == found["worst"], "the same seed finds the same"
