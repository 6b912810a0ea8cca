"""Places where functions are called: this process, other processes here, or a Dask cluster.

In each of them, a result is yielded once, as soon as it is finished. No more calls are under way
than the place has room for, so that memory does not grow with the number of calls. A call whose
worker is lost is sent again, a limited number of times. A worker whose code or libraries differ
from those of this process raises an error in place of a result.
"""

import contextlib
import os
import re
import socket
import threading
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from verify.errors import InputError, PlaceError
from verify.execution.keeper import fingerprint
from verify.execution.processes import Processes

_ADDRESS = re.compile(r"(tcp|tls)://[^\s/]+:\d{1,5}")
_CHECK_SECONDS = 5.0  # the place is checked after this time, even if no call has finished


@dataclass(frozen=True)
class Placement:
    """The place where tasks run: processes on this machine, or the Dask cluster at an address.

    `workers`: their number; 1 means this process itself, and None as many processes as the calls
    need, up to one for each CPU. Raises InputError if both fields are set, if `workers` < 1, or if
    `cluster` is not tcp://HOST:PORT or tls://HOST:PORT.
    """

    workers: int | None = None
    cluster: str | None = None

    def __post_init__(self) -> None:
        if self.workers is not None and self.workers < 1:
            raise InputError("workers", self.workers, "must be at least 1")
        if self.cluster is None:
            return
        if self.workers is not None:
            raise InputError("cluster", self.cluster, "has its own workers; leave out --workers")
        if not _ADDRESS.fullmatch(self.cluster):
            problem = "must be the address of a Dask scheduler, tcp://HOST:PORT"
            raise InputError("cluster", self.cluster, problem)


LOCAL_DEFAULT = Placement()
THIS_PROCESS = Placement(workers=1)


class FunctionCall(NamedTuple):
    """A call `function(*arguments)`, identified by its name.

    `description`: its name in an error message; if it is empty, `name` stands there.
    """

    name: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()
    description: str = ""


class Place(Protocol):
    """A place for calls.

    `local`: True if the calls run on this machine, with its files and its clock. `attempts`: how
    often a call is tried before the loss of its worker is an error. `names_lost_call`: True if the
    loss of a worker fails only the call that ran there; otherwise it fails others too, and all of
    them are tried again one at a time.
    """

    local: bool
    attempts: int
    names_lost_call: bool

    @property
    def room(self) -> int:
        """The number of calls that may be under way.

        If it is 0, nothing is submitted: each function is called in this process when its result
        is requested.
        """

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Submit a call, as an executor does."""

    def release(self, future: "Future[Any]") -> None:
        """Release a finished future; called for each, before the next call is submitted."""

    def is_worker_loss(self, error: BaseException) -> bool:
        """Return True if the error of a call means that its worker was lost."""

    def check(self) -> None:
        """Check the place once; called every few seconds while calls are under way.

        Raises PlaceError if no call can finish any more.
        """


@contextlib.contextmanager
def open_place(
    placement: Placement,
    modules: Sequence[str] = (),
    after_end: Callable[[Sequence[int]], None] = lambda _: None,
) -> Iterator[Place]:
    """Open the place where functions are called; on an exception, end the calls under way at once.

    `modules`: the modules that processes import before their first call; if several places are
    opened in turn, those of the first one apply to all. `after_end` is called after an exception,
    with the process ids of the processes here that were ended.

    Processes are started as they are needed. Raises InputError if the cluster does not answer, has
    no workers, or has other code than this process.
    """
    if placement.cluster is not None:
        from verify.execution.cluster import connect

        with connect(placement.cluster) as place:
            yield place
    elif placement.workers == 1:
        yield _ThisProcess()
    else:
        processes = Processes(placement.workers or os.cpu_count() or 1, modules)
        try:
            yield processes
        except BaseException:
            after_end(processes.end())
            raise
        processes.close()


def results_of(
    place: Place, calls: Iterable[FunctionCall], *, one_by_one: bool = False
) -> Iterator[tuple[str, Any]]:
    """Yield (name, result) of each call as soon as it is finished.

    `one_by_one`: no call is sent while another is under way. The calls are taken from their
    iterator when there is room. An exception of a call is raised here, and PlaceError if a call has
    lost its worker in every attempt. Before any exception leaves this function, an interruption
    too, the other results that are finished are yielded.
    """
    if place.room == 0:
        for call in calls:
            yield call.name, call.function(*call.arguments)
        return
    queue = _CallQueue(place, calls, one_by_one)
    try:
        while queue.send():
            queue.collect()
            while queue.ready:
                name, future = queue.ready.popleft()
                yield name, future.result()
    # The consumer has stopped: yielding the rest would be an error.
    except GeneratorExit:
        raise
    except BaseException:
        yield from queue.finished_results()
        raise


class _CallQueue:
    """The calls of one `results_of`: those under way, those lost, and those that are finished."""

    def __init__(self, place: Place, calls: Iterable[FunctionCall], one_by_one: bool) -> None:
        self.place, self.calls, self.one_by_one = place, iter(calls), one_by_one
        self.under_way: dict[Future[Any], FunctionCall] = {}
        self.requeued: deque[FunctionCall] = deque()
        self.ready: deque[tuple[str, Future[Any]]] = deque()
        self.losses: Counter[str] = Counter()

    def send(self) -> bool:
        """Send as many calls as there is room for; return True if any is under way."""
        while len(self.under_way) < self._room():
            call = self.requeued.popleft() if self.requeued else next(self.calls, None)
            if call is None:
                break
            future = self.place.submit(call_in_worker, fingerprint(), call.function, call.arguments)
            self.under_way[future] = call
        return bool(self.under_way)

    def _room(self) -> int:
        # If the place does not name the call that killed a worker, all calls that have lost one are
        # sent one at a time. This finds the call that kills its worker, and no other call reaches
        # the limit of attempts.
        names = (call.name for call in self.under_way.values())
        has_suspects = bool(self.requeued) or any(name in self.losses for name in names)
        sends_singly = self.one_by_one or (has_suspects and not self.place.names_lost_call)
        return 1 if sends_singly else self.place.room

    def collect(self) -> None:
        """Move finished calls to `ready`, and requeue those that lost their worker.

        Waits until a call is finished, but no longer than `_CHECK_SECONDS`; then the place is
        checked.
        """
        done, _ = wait(self.under_way, timeout=_CHECK_SECONDS, return_when=FIRST_COMPLETED)
        for future in done:
            call = self.under_way.pop(future)
            self.place.release(future)
            # `exception` would raise CancelledError here, but `results_of` raises it, when it reads
            # the result of a cancelled call.
            error = None if future.cancelled() else future.exception()
            # An ordinary exception of the call is a result like others: it is raised where the
            # caller reads it.
            if error is None or not self.place.is_worker_loss(error):
                self.ready.append((call.name, future))
                continue
            self.losses[call.name] += 1
            if self.losses[call.name] >= self.place.attempts:
                problem = "its worker was lost again and again: killed, or out of memory?"
                raise PlaceError(f"{call.description or call.name}: {problem}")
            self.requeued.append(call)
        self.place.check()

    def finished_results(self) -> Iterator[tuple[str, Any]]:
        """Yield the finished results that were not yielded yet, without those that are errors."""
        finished = [(call.name, future) for future, call in self.under_way.items() if future.done()]
        for name, future in (*self.ready, *finished):
            if not future.cancelled() and future.exception() is None:
                yield name, future.result()


# -- in the worker --------------------------------------------------------------------------------

# Libraries have settings, such as a precision, that all threads of a process share.
_CALL_LOCK = threading.Lock()


def call_in_worker(
    expected_fingerprint: str, function: Callable[..., Any], arguments: tuple[Any, ...]
) -> Any:
    """Call the function in the worker, while no other call runs in its process.

    Raises PlaceError if the worker's code or libraries are not those of the caller.
    """
    # The worker may have joined the cluster, or been restarted, since the cluster was checked.
    if fingerprint() != expected_fingerprint:
        worker = f"{socket.gethostname()}, process {os.getpid()}"
        raise PlaceError(f"worker {worker}: its areaproof or a library is not the one used here")
    with _CALL_LOCK:
        return function(*arguments)


# -- in this process -------------------------------------------------------------------------------


class _ThisProcess:
    """This process: it has room for no call, so that a function is called when its result is
    requested."""

    local, attempts, names_lost_call, room = True, 1, True, 0

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        raise NotImplementedError  # `results_of` submits nothing to a place without room

    def release(self, future: "Future[Any]") -> None: ...

    def is_worker_loss(self, error: BaseException) -> bool:
        return False

    def check(self) -> None: ...
