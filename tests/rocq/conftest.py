"""The theory, and all exports beside it, compiled once a session for all of its processes."""

from pathlib import Path

import pytest

from tests.helpers.compilers import needed
from tests.helpers.exports import ALL, export
from tests.helpers.rocq import accepted, beside, compile_theory, each_after, made_once
from tests.helpers.rocq_assumptions import ASKED


@pytest.fixture(scope="session")
def theory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its folder, compiled."""
    needed("coqc")
    return made_once(tmp_path_factory, "theory", compile_theory)


@pytest.fixture(scope="session")
def exports(tmp_path_factory: pytest.TempPathFactory, theory: Path) -> Path:
    """Those that `coqc` takes are compiled there; what it says of the others lies beside them.

    What they assume is asked of all together, as to print it takes half of the time of an export.
    """

    def compile_exports(folder: Path) -> None:
        texts = {name: export(name).text for name in ALL}

        def compile_one(name: str) -> None:
            try:
                accepted(folder / f"{name}.v", ASKED.sub("", texts[name]), beside(theory))
            except AssertionError as error:
                (folder / f"{name}.refused").write_text(str(error), encoding="utf-8")

        # What takes longest begins first.
        long_first = sorted(texts, key=lambda name: -len(texts[name]))
        each_after(dict.fromkeys(long_first, ()), compile_one)

    return made_once(tmp_path_factory, "exports", compile_exports)
