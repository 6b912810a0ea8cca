"""The data that programs' tables are compared with: Duffing's, and Hénon and Heiles' in degrees."""

import pytest

from tests.helpers.constructed.reference import IN_DEGREES, made, put
from tests.helpers.programs.submitted_programs import HeilesProgram, Program
from verify.reference.compare.published_data import Published, load
from verify.reference.make.data_folder import PUBLISHED


@pytest.fixture(scope="session")
def ours() -> Published:
    return load(PUBLISHED, "duffing")


@pytest.fixture(scope="session")
def in_degrees(tmp_path_factory: pytest.TempPathFactory) -> Published:
    folder = tmp_path_factory.mktemp("reference")
    put(folder, made(IN_DEGREES), IN_DEGREES)
    return load(folder, None, planar=False)


@pytest.fixture(scope="session")
def each_ours(ours: Published, in_degrees: Published) -> dict[type, Published]:
    """By the programs whose numbers they are."""
    return {Program: ours, HeilesProgram: in_degrees}
