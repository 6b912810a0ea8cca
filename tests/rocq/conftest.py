"""The theory, and exports beside it, compiled once a session for all of its processes."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.compilers import needed
from tests.helpers.exports import export
from tests.helpers.rocq import accepted, beside, compile_theory, made_once
from tests.helpers.rocq_assumptions import ASKED


@pytest.fixture(scope="session")
def theory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its folder, compiled."""
    needed("coqc")
    return made_once(tmp_path_factory, "theory", compile_theory)


@pytest.fixture(scope="session")
def compiled(tmp_path_factory: pytest.TempPathFactory, theory: Path) -> Callable[[str], Path]:
    """Of an export's name, the folder with it compiled; the test fails where `coqc` refuses it.

    What exports assume is asked of many together, as to print it takes half of the time of one.
    """

    def folder_of(name: str) -> Path:
        text = ASKED.sub("", export(name).text)
        return made_once(
            tmp_path_factory,
            f"export_{name}",
            lambda folder: accepted(folder / f"{name}.v", text, beside(theory)),
        )

    return folder_of
