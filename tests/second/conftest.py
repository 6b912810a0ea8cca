"""Programs in C that several tests ask, each compiled and asked once a session."""

import os
from pathlib import Path

import pytest

from tests.helpers.programs.compilers import needed
from tests.second.long_runs import LongRuns


@pytest.fixture(scope="session")
def runs(tmp_path_factory: pytest.TempPathFactory) -> LongRuns:
    needed("gcc")
    folder: Path = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent
    (folder / "long_runs").mkdir(exist_ok=True)
    return LongRuns(folder / "long_runs")
