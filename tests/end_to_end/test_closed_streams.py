"""Every command with standard input and error closed, as some schedulers start it."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from tests.paths import ROOT
from verify.calls.progress import progress_of
from verify.commands import Commands

SCENE = """
system = "pendulum"
schemes = ["lie2"]
[[reference]]
step_sizes = [0.1]
initial_values = [{ q = 1, p = 0 }]
steps = [10]
digits = 20
"""
THEIRS = "step,q,p\n10,0.6,-0.755\n"
STEP = """
def step(q, p, h):
    print("it says so")
    return q + h * p, p - h * (q + h * p)

def turn(p, q):
    return q, -p
"""
TABLE = """
[[table]]
name = "midpoint"
kind = "runge-kutta"
a = [["0", "0"], ["1/2", "0"]]
b = ["0", "1"]
order = 2
"""
CLAIMS = """
[[claim]]
id = "order"
kind = "order"
system = "pendulum"
scheme = "lie2"
order = 3
"""
OF = "--system pendulum --scheme lie2"
FROM = f"{OF} --step-size 0.1 --q 1 --p 0"
COMMANDS = {
    "bench": f"{FROM} --step-size 0.05 --time 1",
    "certificate check": "lie2.json",
    "certificate export": "lie2.json --coq out.v",
    "certificate theory": "theory",
    "check": "claims.toml",
    "check-integrator": "mine:step --hamiltonian p**2/2+q**2/2",
    "check-map": "mine:turn",
    "check-table": "table.toml",
    "explore": "--examples 3 --workers 2",
    "export": f"{OF} --language c",
    "flow": f"{FROM} --shape cat --time 0.2",
    "init": "claims -o first.toml",
    "modified": OF,
    "plan": "scene.toml",
    "prove": f"{OF} --certificate lie2.json",
    "reference check": "data",
    "reference compare": "theirs.csv --data data --scene scene --scheme lie2",
    "reference make": "scene.toml -o data",
    "report": "scene.toml -o report --workers 2",
    "run": f"{FROM} --steps 1000",
    "schemes": "",
    "separate": f"{FROM} --steps 100",
    "stability": f"{FROM} --time 1",
    "systems": "",
}
FIRST = "prove", "reference make"  # what they write others read
FAILS = "reference compare"  # their numbers differ


def closed(command: str, folder: Path, which: str = "2>&- <&-") -> tuple[int, str]:
    """The status and the output of a command whose streams are closed so."""
    words = f"{sys.executable} -m verify {command} {COMMANDS[command]} {which}"
    done = subprocess.run(
        ["bash", "-c", words], cwd=folder, env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE, text=True, timeout=120, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("closed")
    texts = {"scene.toml": SCENE, "theirs.csv": THEIRS, "mine.py": STEP, "table.toml": TABLE}
    for name, text in (texts | {"claims.toml": CLAIMS}).items():
        (made / name).write_text(text)
    for command in FIRST:
        assert closed(command, made)[0] == 0, command
    return made


def commands_of(group: click.Group, before: str = "") -> Iterator[str]:
    for name, command in group.commands.items():
        if isinstance(command, click.Group):
            yield from commands_of(command, f"{before}{name} ")
        else:
            yield before + name


def test_every_command_is_tried_so() -> None:
    assert sorted(commands_of(click.Group(commands=Commands()))) == sorted(COMMANDS)


@pytest.mark.left_to_ci
@pytest.mark.sample(8)
@pytest.mark.parametrize("command", sorted({*COMMANDS} - {*FIRST}))
def test_a_command_answers_with_standard_input_and_error_closed(command: str, folder: Path) -> None:
    status, said = closed(command, folder)
    assert status == (1 if command == FAILS else 0)
    assert said.strip()


@pytest.mark.left_to_ci
@pytest.mark.parametrize("which", ["2>&-", "<&-"])
def test_a_run_answers_with_either_closed(which: str, folder: Path) -> None:
    status, said = closed("run", folder, which)
    assert status == 0
    assert "1000 steps" in said


OPENED = "a, b = open('/dev/null'), open('/dev/null'); print(min(a.fileno(), b.fileno()) > 2)"
HELD = "from verify.commands.main import printable_streams as held\nwith held(): "


@pytest.mark.parametrize(("code", "apart"), [(OPENED, "False"), (HELD + OPENED, "True")])
def test_no_file_is_opened_in_the_place_of_a_closed_stream(code: str, apart: str) -> None:
    """What a library in C says of an error would be written into it; as it is in plain Python."""
    done = subprocess.run(
        ["bash", "-c", f'{sys.executable} -c "$0" 2>&- <&-', code], cwd=ROOT,
        stdout=subprocess.PIPE, text=True, check=False,
    )  # fmt: skip
    assert done.stdout.strip() == apart


def test_a_bar_that_is_asked_for_in_python_is_none_where_nobody_could_see_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with progress_of(True, "steps", 10) as advance:
        assert advance is not None
    monkeypatch.setattr(sys, "stderr", None)
    with progress_of(True, "steps", 10) as advance:
        assert advance is None
