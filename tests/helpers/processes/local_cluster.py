"""A Dask cluster of this machine, whose workers are begun at once, also after a loss."""

import multiprocessing
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import forkserver
from typing import Any

# What each worker would import by itself, in two seconds.
_NEEDED = ["distributed", "verify.studies.tasks_of_scenes", "verify.exploration.exploring",
           "verify.exploration.hunting", "verify.claims.verdicts",
           "tests.helpers.processes.worker_functions"]  # fmt: skip


@contextmanager
def local_cluster(**configured: Any) -> Iterator[Any]:
    """Two processes of one thread each, on any free ports, forked from one beside this process.

    There is one such process for all uses, so it is begun anew: an earlier one has imported less.
    """
    import dask
    import distributed
    from distributed.utils import get_mp_context

    method = {"distributed.worker.multiprocessing-method": "forkserver"}
    forkserver._forkserver._stop()
    with dask.config.set(method | configured):
        get_mp_context()  # which sets what is imported once, at its first call
        multiprocessing.get_context("forkserver").set_forkserver_preload(_NEEDED)
        try:
            with distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs="CRITICAL"
            ) as made:
                yield made
        finally:
            forkserver._forkserver._stop()
