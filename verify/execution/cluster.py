"""A Dask cluster that the user has started, as a place where functions are called."""

import asyncio
import contextlib
import logging
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from verify.errors import InputError, PlaceError
from verify.execution.keeper import fingerprint
from verify.execution.processes import safe_path

_PATIENCE = 5.0  # seconds for a scheduler to answer, and to have a worker
_LOGGERS = ("distributed", "tornado")
_LOOK = 5.0  # seconds between two looks at who is there
_FORSAKEN = 60.0  # seconds without any worker after which none is waited for
_AHEAD = 2  # calls for each worker, so that it has the next while a result is on its way


@contextlib.contextmanager
def connect(address: str) -> Iterator["Cluster"]:
    """Connect to the cluster whose scheduler has the address; on leaving, all calls under way are
    cancelled.

    Raises InputError where `distributed` is missing, where nothing or something else answers, where
    there is no worker, and where one of them or the scheduler lacks this code or these libraries.
    """
    try:
        import distributed
    except ImportError:
        problem = "needs the package distributed: pip install 'areaproof[cluster]'"
        raise InputError("cluster", address, problem) from None
    make: Callable[..., Any] = distributed.Client
    with _quiet(), safe_path():  # whatever distributed may start beside this process
        _meet(address, distributed.rpc)
        try:
            client = make(address, timeout=_PATIENCE, set_as_default=False)
        except Exception as error:
            raise InputError("cluster", address, _no_answer(error)) from None
        executor = client.get_executor(pure=False)
        try:
            _check(address, client)
            yield Cluster(address, client, executor)
        finally:
            executor.shutdown(wait=False)
            client.close(timeout=_PATIENCE)


def _meet(address: str, rpc: Callable[..., Any]) -> None:
    """Raise InputError unless a scheduler answers in time: for a mute one a Client waits for
    ever."""

    async def ask() -> Any:
        async with asyncio.timeout(_PATIENCE), rpc(address, timeout=_PATIENCE) as scheduler:
            return await scheduler.identity()

    try:
        with ThreadPoolExecutor(1) as thread:  # a notebook has a loop of its own in this one
            kind = thread.submit(asyncio.run, ask()).result()["type"]
    except Exception as error:  # what does not speak Dask's language can raise anything
        raise InputError("cluster", address, _no_answer(error)) from None
    if kind != "Scheduler":
        raise InputError("cluster", address, f"is a Dask {kind.lower()}; the scheduler's is needed")


def _no_answer(error: Exception) -> str:
    if isinstance(error, OSError):  # a time-out is one too
        return f"no Dask scheduler answers there within {_PATIENCE:.0f} s"
    return f"no Dask scheduler can be spoken to there: {type(error).__name__}: {error}"


def _check(address: str, client: Any) -> None:
    """Raise InputError where there is no worker, or one that has other code."""
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
    except TimeoutError:
        problem = f"has no workers; start one: dask worker {address} --nthreads 1"
        raise InputError("cluster", address, problem) from None
    fingerprints = client.run(fingerprint, on_error="return")
    try:  # it reads the tasks that it hands on
        fingerprints["the scheduler"] = client.run_on_scheduler(fingerprint)
    except Exception as error:
        fingerprints["the scheduler"] = error
    for place, source in sorted(fingerprints.items()):
        if isinstance(source, BaseException):
            problem = f"areaproof cannot be used at {place}: {source}"
        elif source != fingerprint():
            problem = f"areaproof or a library it uses is not the same at {place} as here"
        else:
            continue
        raise InputError("cluster", address, problem)


class Cluster:
    """See `verify.execution.executors.Place`. Dask itself sends a call again whose worker is lost.

    Its error for a call that has lost too many (`allowed-failures`) names also one that was only
    waiting at those workers; so that call is tried once more, with no other of ours under way.
    """

    local, attempts, names_lost_call = False, 2, False

    def __init__(self, address: str, client: Any, executor: Any) -> None:
        self._address, self._client, self._executor = address, client, executor
        self._workers = len(client.nthreads())
        self._last_look = self._last_worker = time.monotonic()

    @property
    def room(self) -> int:
        return _AHEAD * max(1, self._workers)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        future: Future[Any] = self._executor.submit(function, *arguments)
        return future

    def release(self, future: "Future[Any]") -> None:
        if future.cancelled():  # we cancel none that we wait for
            raise PlaceError(f"the scheduler at {self._address} is gone, or has been restarted")
        error = future.exception()
        # A worker that joined after the check may have other code, in which a name or a module is
        # missing.
        if isinstance(error, AttributeError | ImportError):  # of one that joined later, perhaps
            _check(self._address, self._client)
            if isinstance(error, ImportError):
                raise PlaceError(f"a worker of {self._address} lacks a library: {error}")

    def lost(self, error: BaseException) -> bool:
        from distributed import KilledWorker

        return isinstance(error, KilledWorker)

    def check(self) -> None:
        now = time.monotonic()
        if now - self._last_look < _LOOK:
            return
        try:
            self._workers = len(self._client.nthreads())
        except Exception:  # of a client that has lost its scheduler: no one kind
            raise PlaceError(f"the scheduler at {self._address} does not answer") from None
        self._last_look = time.monotonic()
        if self._workers:
            self._last_worker = self._last_look
        # Workers may restart; only after a minute without any is the cluster given up.
        elif self._last_look - self._last_worker > _FORSAKEN:
            raise PlaceError(f"the cluster at {self._address} has had no worker for a minute")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Silence distributed's log, and that of tornado below it: errors are reported in one line,
    where they occur."""
    loggers = [
        logging.getLogger(name)
        for name in (*_LOGGERS, *logging.root.manager.loggerDict)
        if name.partition(".")[0] in _LOGGERS
    ]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)
