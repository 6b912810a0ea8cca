"""Processes on this machine, as a place where calls are performed."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any


class Processes:
    """See `verify.executors.Place`. Each process is a pool of one, which has one call at a time.

    A pool of several is broken as a whole when one of its workers is killed, and does not tell
    which call that was; of a pool of one nothing else is lost, and there is nothing to guess.
    """

    local, attempts, blames = True, 3, True

    def __init__(self, workers: int) -> None:
        self.room = workers
        self._idle: list[ProcessPoolExecutor] = []
        self._busy: dict[Future[Any], ProcessPoolExecutor] = {}

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        pool = self._idle.pop() if self._idle else _process()
        try:
            future = pool.submit(function, *arguments)
        except BrokenExecutor:  # lost while it was idle
            pool = _process()
            future = pool.submit(function, *arguments)
        self._busy[future] = pool
        return future

    def release(self, future: "Future[Any]") -> None:
        pool = self._busy.pop(future)
        if isinstance(future.exception(), BrokenExecutor):
            pool.shutdown(wait=False)
        else:
            self._idle.append(pool)

    def lost(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def look(self) -> None: ...

    def end(self) -> None:
        """Ends the processes at once, whatever they are at."""
        for pool in (*self._idle, *self._busy.values()):
            # The executor has no public way to end a task that is running.
            for process in (pool._processes or {}).values():
                process.terminate()
            pool.shutdown(wait=False, cancel_futures=True)

    def close(self) -> None:
        """Ends the processes, which are idle, together."""
        if self._idle:
            with ThreadPoolExecutor(len(self._idle)) as threads:
                list(threads.map(ProcessPoolExecutor.shutdown, self._idle))


def _process() -> ProcessPoolExecutor:
    # Spawned, not forked: this process may have threads (the progress bar's, a kernel's).
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(1, mp_context=context, initializer=_begin)


def _begin() -> None:
    # Ctrl-C reaches the whole process group; the parent alone answers it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """A parent that is killed can end no worker, and none would see that no more calls come."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
