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

_CONNECT_SECONDS = 5.0  # the limit for each of: the scheduler's answer, the first worker
_LOGGERS = ("distributed", "tornado")
_CHECK_SECONDS = 5.0  # the interval between two counts of the workers
_MAX_SECONDS_WITHOUT_WORKER = 60.0  # afterwards the cluster is given up
_CALLS_PER_WORKER = 2  # more than one, so that a worker goes on while its last result is sent


@contextlib.contextmanager
def connect(address: str) -> Iterator["Cluster"]:
    """Connect to the cluster whose scheduler has the address; on leaving, cancel its calls.

    Raises InputError if `distributed` is missing, if no Dask scheduler answers, if there is no
    worker, or if a worker or the scheduler lacks this code or these libraries.
    """
    try:
        import distributed
    except ImportError:
        problem = "needs the package distributed: pip install 'areaproof[cluster]'"
        raise InputError("cluster", address, problem) from None
    make: Callable[..., Any] = distributed.Client
    with _quiet(), safe_path():  # distributed may start processes
        _check_scheduler(address, distributed.rpc)
        try:
            client = make(address, timeout=_CONNECT_SECONDS, set_as_default=False)
        except Exception as error:
            raise InputError("cluster", address, _describe_no_answer(error)) from None
        executor = client.get_executor(pure=False)
        try:
            _check_fingerprints(address, client)
            yield Cluster(address, client, executor)
        finally:
            executor.shutdown(wait=False)
            client.close(timeout=_CONNECT_SECONDS)


def _check_scheduler(address: str, rpc: Callable[..., Any]) -> None:
    """Raise InputError unless a scheduler answers in time.

    A Client would wait for ever if something else listens at the address and does not answer.
    """

    async def ask() -> Any:
        async with (
            asyncio.timeout(_CONNECT_SECONDS),
            rpc(address, timeout=_CONNECT_SECONDS) as scheduler,
        ):
            return await scheduler.identity()

    try:
        with ThreadPoolExecutor(1) as thread:  # in a notebook this thread has an event loop already
            kind = thread.submit(asyncio.run, ask()).result()["type"]
    except Exception as error:  # a peer that is no part of Dask may cause any exception
        raise InputError("cluster", address, _describe_no_answer(error)) from None
    if kind != "Scheduler":
        raise InputError("cluster", address, f"is a Dask {kind.lower()}; the scheduler's is needed")


def _describe_no_answer(error: Exception) -> str:
    if isinstance(error, OSError):  # TimeoutError is an OSError too
        return f"no Dask scheduler answers there within {_CONNECT_SECONDS:.0f} s"
    return f"no Dask scheduler can be spoken to there: {type(error).__name__}: {error}"


def _check_fingerprints(address: str, client: Any) -> None:
    """Raise InputError if there is no worker, or if one or the scheduler has other code."""
    try:
        client.wait_for_workers(1, timeout=_CONNECT_SECONDS)
    except TimeoutError:
        problem = f"has no workers; start one: dask worker {address} --nthreads 1"
        raise InputError("cluster", address, problem) from None
    fingerprints = client.run(fingerprint, on_error="return")
    try:  # the scheduler needs the code too, as it reads the tasks
        fingerprints["the scheduler"] = client.run_on_scheduler(fingerprint)
    except Exception as error:
        fingerprints["the scheduler"] = error
    for place, result in sorted(fingerprints.items()):
        if isinstance(result, BaseException):
            problem = f"areaproof cannot be used at {place}: {result}"
        elif result != fingerprint():
            problem = f"areaproof or a library it uses is not the same at {place} as here"
        else:
            continue
        raise InputError("cluster", address, problem)


class Cluster:
    """A Dask cluster as a `verify.execution.executors.Place`.

    Dask itself sends a call again if its worker is lost. After too many losses (`allowed-failures`)
    its error may name a call that was only waiting at those workers. So the call is tried once
    more, with no other call of ours under way.
    """

    local, attempts, names_lost_call = False, 2, False

    def __init__(self, address: str, client: Any, executor: Any) -> None:
        self._address, self._client, self._executor = address, client, executor
        self._workers = len(client.nthreads())
        self._last_look = self._last_worker = time.monotonic()

    @property
    def room(self) -> int:
        return _CALLS_PER_WORKER * max(1, self._workers)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        future: Future[Any] = self._executor.submit(function, *arguments)
        return future

    def release(self, future: "Future[Any]") -> None:
        if future.cancelled():  # not by us: calls are cancelled only after the last wait
            raise PlaceError(f"the scheduler at {self._address} is gone, or has been restarted")
        error = future.exception()
        # A worker that joined after the check may have other code, in which a name or a module is
        # missing.
        if isinstance(error, AttributeError | ImportError):
            _check_fingerprints(self._address, self._client)
            if isinstance(error, ImportError):
                raise PlaceError(f"a worker of {self._address} lacks a library: {error}")

    def is_worker_loss(self, error: BaseException) -> bool:
        from distributed import KilledWorker

        return isinstance(error, KilledWorker)

    def check(self) -> None:
        now = time.monotonic()
        if now - self._last_look < _CHECK_SECONDS:
            return
        try:
            self._workers = len(self._client.nthreads())
        except Exception:  # a client that has lost its scheduler may raise several types
            raise PlaceError(f"the scheduler at {self._address} does not answer") from None
        self._last_look = time.monotonic()
        if self._workers:
            self._last_worker = self._last_look
        # Workers may restart, so that the cluster is given up only after a minute without any.
        elif self._last_look - self._last_worker > _MAX_SECONDS_WITHOUT_WORKER:
            raise PlaceError(f"the cluster at {self._address} has had no worker for a minute")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Silence the logs of distributed and of tornado, which it uses.

    Errors are reported by the functions above, in one line.
    """
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
