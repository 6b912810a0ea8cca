"""Nothing that a program starts outlives it, however it was started."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.unit.integrators.foreign.programs import HERE, IN_STEP, THERE, program, python, said
from verify.errors import InputError
from verify.integrators.foreign import process
from verify.integrators.foreign.foreign_function import step_of_command
from verify.integrators.user_code.user_map import DOUBLE

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Linux gives orphans to the guard")

# A daemon: forked twice, in a session of its own, without a pipe of ours, so that nothing ends it.
DAEMON = """
import os, sys, time
def daemon(work):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            for stream in range(3):
                os.dup2(os.open(os.devnull, os.O_RDWR), stream)
            with open(sys.argv[1], "w") as file:
                file.write(str(os.getpid()))
            work()
            time.sleep(3600)
        os._exit(0)
    os.wait()
    while not (os.path.exists(sys.argv[1]) and open(sys.argv[1]).read()):
        time.sleep(0.01)
"""
STAYS = DAEMON + "daemon(lambda: None)\n"


def lives(pid: int) -> bool:
    """Whether it runs, and is not only still to be waited for."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(") ")[2][:1] != "Z"
    except OSError:
        return False


def ends(pid: int) -> bool:
    until = time.monotonic() + 10
    while lives(pid) and time.monotonic() < until:
        time.sleep(0.02)
    return not lives(pid)


def test_a_daemon_ends_with_the_program_that_started_it(tmp_path: Path) -> None:
    file = tmp_path / "pid"
    with program(STAYS + IN_STEP, str(file)) as function:
        assert function(*HERE) == THERE
        pid = int(file.read_text())
        assert lives(pid)
    assert ends(pid)


def test_a_daemon_ends_where_its_program_has_ended_before(tmp_path: Path) -> None:
    file = tmp_path / "pid"
    with program(STAYS + "sys.stdin.readline()\n", str(file)) as function:
        assert "ends with status 0" in said(function.several([HERE])[0])
        assert ends(int(file.read_text()))


def test_a_daemons_memory_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(process, "MOST_MEMORY", 2**27)
    file = tmp_path / "pid"
    takes = DAEMON + "daemon(lambda: bytearray(b'x') * 2**28)\n" + "time.sleep(3600)\n"
    with program(takes, str(file)) as function:
        assert "GiB of memory" in said(function.several([HERE])[0])
        assert ends(int(file.read_text()))


def test_a_program_and_its_daemon_end_where_we_are_killed(tmp_path: Path) -> None:
    file = tmp_path / "pid"
    ours = (
        "import os, signal, sys\n"
        "from verify.integrators.foreign.foreign_function import step_of_command\n"
        "from verify.integrators.user_code.user_map import DOUBLE\n"
        "step = step_of_command(sys.argv[1], DOUBLE, 60).function\n"
        "step(0.5, 0.25, 0.0, 0.125)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    # It does not end with its input, as most do.
    hostile = STAYS + IN_STEP + "while True: time.sleep(1)\n"
    done = subprocess.run(
        [sys.executable, "-c", ours, python(hostile, str(file))], check=False, timeout=60
    )
    assert done.returncode == -signal.SIGKILL
    assert ends(int(file.read_text()))


def test_what_a_program_starts_in_its_group_ends_with_it(tmp_path: Path) -> None:
    file = tmp_path / "pid"
    starts = (
        "import subprocess, sys\n"
        "child = subprocess.Popen(['sleep', '3600'])\n"
        "open(sys.argv[1], 'w').write(str(child.pid))\n"
    )
    with program(starts + IN_STEP, str(file)) as function:
        assert function(*HERE) == THERE
    assert ends(int(file.read_text()))


def test_a_program_that_the_system_does_not_start_is_told(tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    broken.write_text("no program of any kind")
    broken.chmod(0o755)
    with pytest.raises(InputError, match="does not start: Exec format error"):
        step_of_command(str(broken), DOUBLE, 60)


def test_no_file_or_process_of_ours_is_left_open() -> None:
    def open_files() -> set[tuple[str, str]]:
        """Each with what it is of: others that close meanwhile hide none that is left."""
        every = Path("/proc/self/fd").iterdir()
        return {(fd.name, str(fd.readlink())) for fd in every if fd.is_symlink()}

    before = open_files()
    for _ in range(5):
        with program(IN_STEP) as function:
            function(*HERE)
    time.sleep(0.2)  # for the threads that listen to standard error
    left = open_files() - before
    assert not [of for _, of in left if not of.startswith("/proc/")], left
