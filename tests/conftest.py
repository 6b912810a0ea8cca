"""How the tests' own process takes care of what it keeps."""

import gc

import pytest

# Objects; most of what an expression or a compiler makes on the way is gone by then.
gc.set_threshold(50_000, 20, 20)


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Thousands of tests stay to the end, and so do their modules: no cycle is looked for there.

    To go through them again and again would take a seventh of the time.
    """
    gc.collect()
    gc.freeze()
