"""Standard output and error: where they cannot be written, nobody reads, or letters are lacking."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here
from tests.paths import ROOT

PROVE = [sys.executable, "-m", "verify", "prove", "--system", "pendulum", "--scheme", "lie2"]
HERE = os.environ | {"PYTHONPATH": str(ROOT)}


def shell(text: str, tmp_path: Path, **more: str) -> subprocess.CompletedProcess[str]:
    command = " ".join(PROVE)
    return subprocess.run(
        ["bash", "-c", text.replace("PROVE", command)],
        cwd=tmp_path, env=HERE | more, capture_output=True, text=True, errors="replace",
        timeout=120, check=False,
    )  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("text", "status", "said"),
    [
        ("PROVE > /dev/full", 2, "verify: standard output: No space left on device\n"),
        ("PROVE --json > /dev/full", 2, "verify: standard output: No space left on device\n"),
        ("PROVE >&-", 2, "verify: standard output: is closed\n"),
        ("PROVE 2>&- > /dev/null", 0, ""),
        ("PROVE | true; exit ${PIPESTATUS[0]}", 141, ""),
        ("PROVE --json | head -c 1 > /dev/null; exit ${PIPESTATUS[0]}", 0, ""),
    ],
)
def test_what_cannot_be_written_is_status_2_and_what_nobody_reads_141(
    text: str, status: int, said: str, tmp_path: Path
) -> None:
    done = shell(text, tmp_path)
    assert (done.returncode, done.stderr) == (status, said)


@pytest.mark.sample(1)
@pytest.mark.parametrize("encoding", ["latin-1", "ascii", "cp1252"])
def test_a_terminal_without_greek_letters_is_given_their_escapes(
    encoding: str, tmp_path: Path
) -> None:
    done = shell("PROVE", tmp_path, PYTHONIOENCODING=encoding)
    assert (done.returncode, done.stderr) == (0, "")
    assert "\\u0394J" in done.stdout


def test_json_is_the_same_on_a_terminal_without_greek_letters(tmp_path: Path) -> None:
    done = shell("PROVE --json", tmp_path, PYTHONIOENCODING="ascii")
    assert "ΔJ" in json.loads(done.stdout)["reason"] or "h^3" in json.loads(done.stdout)["reason"]


def test_no_control_character_reaches_the_terminal(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "a\x1b[31mb\x9b.toml"
    Path(name).write_text('hamiltonian = "p**2/2"\nschemes = ["lie1"]\n')
    for arguments in (["plan", name], ["plan", f"none-{name}"], ["prove", "--x\x1b[2J"]):
        _, out, err = here(capsys, *arguments)
        said = out + err
        assert said
        assert all(c.isprintable() or c in "\n\t" for c in said), repr(said)


@pytest.mark.left_to_ci
def test_an_interruption_at_any_time_is_130_and_no_traceback(tmp_path: Path) -> None:
    """Also while the command is still imported; before that it is Python's own.

    By one process: `test_report_command.py` interrupts workers, too.
    """
    ended = []
    for wait in (0.3, 0.7, 2.0):
        process = subprocess.Popen(
            [*PROVE[:3], "explore", "--examples", "100000", "--workers", "1"], cwd=tmp_path,
            env=HERE, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=120)
        if process.returncode == 130:
            ended.append(wait)
            assert "Traceback" not in error
        else:
            assert "/verify/commands" not in error, error
    assert 2.0 in ended
