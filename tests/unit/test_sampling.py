"""Which parameters of a costly test are run."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT

CONFTEST = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from tests import sampling

def pytest_addoption(parser):
    sampling.add_option(parser)

def pytest_configure(config):
    sampling.add_markers(config)

def pytest_collection_modifyitems(config, items):
    sampling.leave_out(config, items)
"""
TEST = """
import pytest

@pytest.mark.sample(3)
@pytest.mark.parametrize("a", range(3))
@pytest.mark.parametrize("b", range(3))
def test_much(a, b): ...

@pytest.mark.parametrize("a", range(4))
def test_little(a): ...

@pytest.mark.sample(3)
@pytest.mark.parametrize("a", range(2))
def test_less(a): ...

@pytest.mark.left_to_ci
def test_dear(): ...

@pytest.mark.parametrize("a", [0, pytest.param(1, marks=pytest.mark.left_to_ci)])
def test_partly_dear(a): ...
"""


def collected(folder: Path, *options: str, **variables: str) -> list[str]:
    """What pytest would run there."""
    (folder / "conftest.py").write_text(CONFTEST)
    (folder / "test_it.py").write_text(TEST)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-q", "--collect-only"]
    env = {name: value for name, value in os.environ.items() if name != "CI"} | variables
    done = subprocess.run([*command, *options], cwd=folder, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return [line for line in done.stdout.splitlines() if "::" in line]


@pytest.mark.left_to_ci
def test_a_sample_has_so_many_and_each_value_of_a_parameter_if_it_can(tmp_path: Path) -> None:
    found = collected(tmp_path)
    much = [x.partition("[")[2].rstrip("]").split("-") for x in found if "much" in x]
    assert len(much) == 3
    assert [{x[k] for x in much} for k in (0, 1)] == [{"0", "1", "2"}] * 2
    assert len([x for x in found if "little" in x]) == 4
    assert len([x for x in found if "less" in x]) == 2
    assert [x.partition("::test_")[2] for x in found if "dear" in x] == ["partly_dear[0]"]
    assert collected(tmp_path) == found, "the same each time"


@pytest.mark.left_to_ci
@pytest.mark.parametrize("option", ["--whole", "test_it.py::test_much[0-1]"])
def test_all_are_run_where_they_are_asked_for(tmp_path: Path, option: str) -> None:
    much = [x for x in collected(tmp_path, option) if "much" in x]
    assert len(much) == (9 if option == "--whole" else 1)


@pytest.mark.parametrize(
    ("options", "names"),
    [
        (["--whole"], ["dear", "partly_dear[0]", "partly_dear[1]"]),
        (["-m", "left_to_ci"], ["dear", "partly_dear[1]"]),
        (["test_it.py::test_dear"], ["dear"]),
    ],
)
def test_what_is_left_to_ci_is_run_where_it_is_asked_for(
    tmp_path: Path, options: list[str], names: list[str]
) -> None:
    found = [x.partition("::test_")[2] for x in collected(tmp_path, *options)]
    assert [x for x in found if "dear" in x] == names
    assert (len(found) == len(names)) == (options[0] != "--whole")


@pytest.mark.left_to_ci
def test_what_is_left_to_ci_is_run_there_and_samples_stay_samples(tmp_path: Path) -> None:
    by_hand, there = collected(tmp_path), collected(tmp_path, CI="true")
    assert {x.partition("::test_")[2] for x in set(there) - set(by_hand)} == {
        "dear",
        "partly_dear[1]",
    }
    assert set(by_hand) < set(there)
