"""Processes on this machine, as a place where functions are called.

Each process is a `concurrent.futures` pool with one worker. Pebble's pool names a lost call too,
but starts its workers in a thread of its own, where we can neither hold signals nor set a safe
path; and its workers go on after their parent is killed (both tried with pebble 5.2.3).
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

_MAX_SECONDS_TO_END = 5.0  # the wait for processes that were terminated
_SAFE_PATH = "PYTHONSAFEPATH"  # Python's own variable, read as it starts


class Processes:
    """Processes as a `verify.execution.executors.Place`; each is a pool with one worker.

    If a pool has several workers and one is killed, the whole pool is broken, and it does not tell
    which call killed it. In a pool with one worker that call is the only one.
    """

    local, attempts, names_lost_call = True, 3, True

    def __init__(self, workers: int, modules: Sequence[str] = ()) -> None:
        """Prepare for `workers` processes, which import `modules` before their first call."""
        self.room, self._modules = workers, modules
        self._idle: list[ProcessPoolExecutor] = []
        self._busy: dict[Future[Any], ProcessPoolExecutor] = {}

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Begin the call in an idle process, or in a new one."""
        # The context is created first: the fork server would pass on the held signals to workers.
        context = self._context
        # An interruption between the start of a process and its entry in `_busy` would leave the
        # process behind: signals are held until then.
        with safe_path(), _hold_signals(signal.SIGINT, signal.SIGTERM):
            pool = self._idle.pop() if self._idle else _start_pool(context)
            try:
                future = pool.submit(function, *arguments)
            except BrokenExecutor:  # the process was lost while it was idle
                pool = _start_pool(context)
                future = pool.submit(function, *arguments)
            self._busy[future] = pool
        return future

    @cached_property
    def _context(self) -> Any:
        return _fork_server(self._modules)

    def release(self, future: "Future[Any]") -> None:
        """Make the process of a finished call idle, or forget it if it was lost."""
        pool = self._busy.pop(future)
        if isinstance(future.exception(), BrokenExecutor):
            pool.shutdown(wait=False)
        else:
            self._idle.append(pool)

    def is_worker_loss(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def check(self) -> None: ...

    def end(self) -> list[int]:
        """End the processes at once, whatever they are doing; return their process ids.

        After the return they write nothing any more, unless one survives `_MAX_SECONDS_TO_END`.
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
        until = time.monotonic() + _MAX_SECONDS_TO_END
        while alive and time.monotonic() < until:
            done = connection.wait(alive, until - time.monotonic())
            alive = [sentinel for sentinel in alive if sentinel not in done]
        # A pool's thread that is not waited for may close a pipe to which Python's exit writes.
        for pool in pools:
            pool.shutdown(wait=not alive, cancel_futures=True)
        return [pid for pid in sentinels if pid is not None]

    def close(self) -> None:
        """End the processes, all of which have to be idle, in parallel."""
        if self._idle:
            with ThreadPoolExecutor(len(self._idle)) as threads:
                list(threads.map(ProcessPoolExecutor.shutdown, self._idle))


def _start_pool(context: Any) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(
        1, mp_context=context, initializer=_initialize_worker, initargs=gc.get_threshold()
    )


def _fork_server(modules: Sequence[str]) -> Any:
    """Return the multiprocessing context: a fork server, or "spawn" if the system has none.

    Workers are not forked from this process, since it may have threads (the progress bar's, a
    kernel's). The fork server has none, has imported the modules once for all workers, and ends
    with this process.
    """
    methods = multiprocessing.get_all_start_methods()
    # The libraries of macOS start threads, so that forking is unsafe even in the fork server.
    if sys.platform == "darwin" or "forkserver" not in methods:
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    # A forked worker shares the imported modules' memory with the server, and starts in
    # milliseconds.
    context.set_forkserver_preload(list(modules))
    # The server and its workers inherit the blocked SIGINT: Ctrl-C is for this process alone.
    with safe_path(), _hold_signals(signal.SIGINT):
        forkserver.ensure_running()
    return context


class _SafePathState:
    """The value of the variable before it was set, and the number of users of the safe path."""

    def __init__(self) -> None:
        self.lock, self.users = threading.Lock(), 0
        self.previous_value: str | None = None


_SAFE = _SafePathState()


@contextmanager
def safe_path() -> Iterator[None]:
    """Make processes that are started in the block import nothing from the current folder.

    `multiprocessing` starts the fork server, the resource tracker and spawned workers by
    `python -c`, for which Python puts the current folder first on the path: a `random.py` in it
    would be run. A worker that has started takes over the path of this process. If several threads
    are in such a block, the first sets the variable, and the last restores it. If this Python
    ignores the environment (`-E`), the processes do so too, and the variable has no effect.
    """
    with _SAFE.lock:
        if not _SAFE.users:
            _SAFE.previous_value = os.environ.get(_SAFE_PATH)
        _SAFE.users += 1
        os.environ[_SAFE_PATH] = "1"
    try:
        yield
    finally:
        with _SAFE.lock:
            _SAFE.users -= 1
            if not _SAFE.users:
                del os.environ[_SAFE_PATH]
                if _SAFE.previous_value is not None:
                    os.environ[_SAFE_PATH] = _SAFE.previous_value


@contextmanager
def _hold_signals(*signals: signal.Signals) -> Iterator[None]:
    """Hold these signals until the block ends; a process that is started in it blocks them."""
    # If the tracker were started in the block, it would unblock the signals afterwards.
    resource_tracker.ensure_running()
    previous_mask = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous_mask)


def _initialize_worker(*between_collections: int) -> None:
    """Initialize a new worker, with this process's thresholds of garbage collection."""
    gc.set_threshold(*between_collections)
    gc.freeze()  # the imported modules stay: collections need not look at them
    # Ctrl-C reaches the whole process group; the parent alone answers it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # A spawned worker has inherited the block of `submit`.
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """End this worker when its parent ends: a parent that is killed ends no worker itself."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
