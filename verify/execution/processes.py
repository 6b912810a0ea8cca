"""Processes on this machine, as a place where functions are called.

Each is a pool of one of `concurrent.futures`. Pebble's pool names a lost call too, but begins its
workers in a thread of its own: neither signals can be held meanwhile nor the path be made safe, and
its workers go on after a parent that is killed (both tried with pebble 5.2.3).
"""

import gc
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from functools import cached_property
from multiprocessing import connection, forkserver, resource_tracker
from typing import Any

_TO_END = 5.0  # seconds in which a process that is ended is no more
_SAFE_PATH = "PYTHONSAFEPATH"  # Python's own variable, read as it starts


class Processes:
    """See `verify.execution.executors.Place`. Each process is a pool of one, which has one call at
    a time.

    A pool of several is broken as a whole when one of its workers is killed, and does not tell
    which call that was; of a pool of one nothing else is lost, and there is nothing to guess.
    """

    local, attempts, names_lost_call = True, 3, True

    def __init__(self, workers: int, modules: Sequence[str] = ()) -> None:
        """`modules`: what the processes have imported before their first call."""
        self.room, self._modules = workers, modules
        self._idle: list[ProcessPoolExecutor] = []
        self._busy: dict[Future[Any], ProcessPoolExecutor] = {}

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Begin the call in an idle process, or in a new one."""
        context = self._context  # made before both are held, which workers would inherit
        # What is half begun could not be ended.
        with safe_path(), _hold_signals(signal.SIGINT, signal.SIGTERM):
            pool = self._idle.pop() if self._idle else _process(context)
            try:
                future = pool.submit(function, *arguments)
            except BrokenExecutor:  # lost while it was idle
                pool = _process(context)
                future = pool.submit(function, *arguments)
            self._busy[future] = pool
        return future

    @cached_property
    def _context(self) -> Any:
        return _fork_server(self._modules)

    def release(self, future: "Future[Any]") -> None:
        """Release the process of a call that has ended: it is idle, or lost."""
        pool = self._busy.pop(future)
        if isinstance(future.exception(), BrokenExecutor):
            pool.shutdown(wait=False)
        else:
            self._idle.append(pool)

    def lost(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def check(self) -> None: ...

    def end(self) -> list[int]:
        """End the processes at once, whatever they are doing; return their numbers.

        When it returns they write nothing any more.
        """
        sentinels, pools = {}, [*self._idle, *self._busy.values()]
        for pool in pools:
            # The executor has no public way to end a task that is running.
            for process in (pool._processes or {}).values():
                process.terminate()
                sentinels[process.pid] = process.sentinel
        # A terminated process may still be writing; the store's unfinished files can be removed
        # only once it is gone.
        alive = list(sentinels.values())
        until = time.monotonic() + _TO_END
        while alive and time.monotonic() < until:
            done = connection.wait(alive, until - time.monotonic())
            alive = [sentinel for sentinel in alive if sentinel not in done]
        for pool in pools:  # whose thread, not waited for, may close what Python's exit writes to
            pool.shutdown(wait=not alive, cancel_futures=True)
        return [pid for pid in sentinels if pid is not None]

    def close(self) -> None:
        """End the processes, which are idle, together."""
        if self._idle:
            with ThreadPoolExecutor(len(self._idle)) as threads:
                list(threads.map(ProcessPoolExecutor.shutdown, self._idle))


def _process(context: Any) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(
        1, mp_context=context, initializer=_begin, initargs=gc.get_threshold()
    )


def _fork_server(modules: Sequence[str]) -> Any:
    """Return the way in which processes start: forked, but not from this one.

    This one may have threads (the progress bar's, a kernel's). One beside it has none, has imported
    once what every worker needs, and ends with this one. Where there is none, each is spawned.
    """
    methods = multiprocessing.get_all_start_methods()
    if sys.platform == "darwin" or "forkserver" not in methods:  # macOS's libraries start threads
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    # A forked worker shares the imported modules' memory with the server, and starts in
    # milliseconds.
    context.set_forkserver_preload(list(modules))
    with safe_path(), _hold_signals(signal.SIGINT):  # which it and the workers then never get
        forkserver.ensure_running()
    return context


class _SafePathState:
    """The value of the variable before it was set, and the number of users of the safe path."""

    def __init__(self) -> None:
        self.lock, self.users = threading.Lock(), 0
        self.before: str | None = None


_SAFE = _SafePathState()


@contextmanager
def safe_path() -> Iterator[None]:
    """Make processes that are started meanwhile import nothing from the current folder.

    Python puts it first on the path of `python -c`, which is how `multiprocessing` starts the fork
    server, the resource tracker and spawned workers: a `random.py` that lies there would be run.
    Once a worker is there, its path is this process's own. Of several threads that start some, the
    first sets what the last restores. Where Python was told to ignore the environment (`-E`), so
    are they, and this does nothing.
    """
    with _SAFE.lock:
        if not _SAFE.users:
            _SAFE.before = os.environ.get(_SAFE_PATH)
        _SAFE.users += 1
        os.environ[_SAFE_PATH] = "1"
    try:
        yield
    finally:
        with _SAFE.lock:
            _SAFE.users -= 1
            if not _SAFE.users:
                del os.environ[_SAFE_PATH]
                if _SAFE.before is not None:
                    os.environ[_SAFE_PATH] = _SAFE.before


@contextmanager
def _hold_signals(*signals: signal.Signals) -> Iterator[None]:
    """Hold these signals until the block ends; a process that is started meanwhile does not get
    them."""
    resource_tracker.ensure_running()  # begun later, it would let them through
    before = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(*between_collections: int) -> None:
    """Begin a new process, in which cycles are collected as seldom as in this one."""
    gc.set_threshold(*between_collections)
    gc.freeze()  # what was imported stays
    # Ctrl-C reaches the whole process group; the parent alone answers it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})  # held where it was spawned
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """End this worker with its parent: one that is killed can end no worker, and none would
    notice."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
