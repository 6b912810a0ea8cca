"""The theory, compiled once for all of pytest's processes, and a Rocq for each that reads texts."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.helpers.programs.compilers import needed
from tests.helpers.rocq.coqc import compile_theory, made_once
from tests.helpers.rocq.session import Session


@pytest.fixture(scope="session")
def theory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its folder, compiled."""
    needed("coqc")
    return made_once(tmp_path_factory, "theory", compile_theory)


@pytest.fixture(scope="session")
def rocq(tmp_path_factory: pytest.TempPathFactory, theory: Path) -> Iterator[Session]:
    """Which reads each text as if it were the first."""
    with Session(theory, tmp_path_factory.mktemp("session")) as session:
        yield session
