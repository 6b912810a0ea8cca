"""How the tests' own process takes care of what it keeps."""

import gc
import os
import shutil
import tempfile

import pytest

from tests import examples, sampling
from verify.code_cache import VARIABLE

# Objects; most of what an expression or a compiler makes on the way is gone by then.
gc.set_threshold(50_000, 20, 20)


def pytest_addoption(parser: pytest.Parser) -> None:
    sampling.add_option(parser)


def pytest_configure(config: pytest.Config) -> None:
    """A folder for kernels that this session compiles, of which none is of an earlier one.

    All its processes share it: each kernel is compiled by the first of them that calls it.
    """
    sampling.add_markers(config)
    if config.getoption("--whole"):
        examples.draw_all()
    if not hasattr(config, "workerinput"):  # which a worker has, and the environment besides
        folder = tempfile.mkdtemp(prefix="verify-tests-")
        os.environ[VARIABLE] = folder
        config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))


def pytest_xdist_auto_num_workers() -> int:
    """Half as many again as there are cores: a third of the workers waits for processes at any
    time, and leaves a core to another one."""
    asked = os.environ.get("PYTEST_XDIST_AUTO_NUM_WORKERS")
    return int(asked) if asked else max(1, (os.cpu_count() or 1) * 3 // 2)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    sampling.leave_out(config, items)


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Thousands of tests stay to the end, and so do their modules: no cycle is looked for there.

    To go through them again and again would take a seventh of the time.
    """
    gc.collect()
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish() -> None:
    """pytest looks for cycles five times when all is done, which takes seconds in each process."""
    gc.freeze()
