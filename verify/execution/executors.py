"""Places where functions are called: this process, processes beside it, or a Dask cluster.

Wherever that is, each result is yielded once and as it comes, and no more calls are under way than
the place has room for: memory does not grow with their number. A call whose worker is lost is sent
again. What another process gives is that of this same code, or an error.
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
_LOOK = 5.0  # seconds after which the place is looked at, though nothing is finished


@dataclass(frozen=True)
class Placement:
    """The place where tasks run: so many processes here, or the Dask cluster at that address.

    `workers`: 1 stays in this process, None goes by the work there is. InputError where both are
    given, where `workers` < 1, and where `cluster` is not tcp://HOST:PORT or tls://HOST:PORT.
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


ANYWHERE = Placement()
THIS_PROCESS = Placement(workers=1)


class FunctionCall(NamedTuple):
    """A call `function(*arguments)`, identified by its name; `description` is its name in an
    error."""

    name: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()
    description: str = ""


class Place(Protocol):
    """A place for calls. `local`: they have this machine's files and clock.

    `attempts`: so often may a call lose its worker. `names_lost_call`: a lost worker tells which
    call lost it; where it does not, that call and others are tried again one at a time.
    """

    local: bool
    attempts: int
    names_lost_call: bool

    @property
    def room(self) -> int:
        """The number of calls that may be under way; 0: a function is called where its result is
        requested."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Submit a call, as an executor does."""

    def release(self, future: "Future[Any]") -> None:
        """Release a future that is finished; called for each before the next call is submitted."""

    def lost(self, error: BaseException) -> bool:
        """Return True if that error of a call says that its worker was lost."""

    def check(self) -> None:
        """Check the place every few seconds. Raises PlaceError where nothing can be finished any
        more."""


@contextlib.contextmanager
def open_place(
    placement: Placement,
    modules: Sequence[str] = (),
    after_end: Callable[[Sequence[int]], None] = lambda _: None,
) -> Iterator[Place]:
    """Open the place where functions are called; on an exception, end all calls under way at once.

    `modules`: what processes have imported before their first call; of several places, the first
    decides for all. `after_end` is called with the numbers of processes here that were ended.

    Processes are started as they are needed. Raises InputError where the cluster does not answer,
    has no workers, or has other code than this.
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
    """Yield (name, result) of each call as it is finished; `one_by_one`: with no other under way.

    The calls are taken from their iterator as there is room. What a call raises is raised here,
    and so is PlaceError where a call loses its worker again and again; but first, as after an
    interruption, what else has been finished is yielded.
    """
    if place.room == 0:
        for call in calls:
            yield call.name, call.function(*call.arguments)
        return
    queue = _CallQueue(place, calls, one_by_one)
    try:
        while queue.send():
            queue.take()
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
        """Send as many as there is room for; return True if any is under way."""
        while len(self.under_way) < self._room():
            call = self.requeued.popleft() if self.requeued else next(self.calls, None)
            if call is None:
                break
            future = self.place.submit(call_in_worker, fingerprint(), call.function, call.arguments)
            self.under_way[future] = call
        return bool(self.under_way)

    def _room(self) -> int:
        # Where a place does not tell which call killed its worker, the suspects go one at a time:
        # so the guilty one is found, and no innocent one reaches the limit of attempts.
        names = (call.name for call in self.under_way.values())
        suspects = bool(self.requeued) or any(name in self.losses for name in names)
        alone = self.one_by_one or (suspects and not self.place.names_lost_call)
        return 1 if alone else self.place.room

    def take(self) -> None:
        """Wait until some are finished, and requeue those that lost their worker."""
        done, _ = wait(self.under_way, timeout=_LOOK, return_when=FIRST_COMPLETED)
        for future in done:
            call = self.under_way.pop(future)
            self.place.release(future)
            error = None if future.cancelled() else future.exception()
            # An ordinary exception of the call is a result like others: it is raised where the
            # caller reads it.
            if error is None or not self.place.lost(error):
                self.ready.append((call.name, future))
                continue
            self.losses[call.name] += 1
            if self.losses[call.name] >= self.place.attempts:
                problem = "its worker was lost again and again: killed, or out of memory?"
                raise PlaceError(f"{call.description or call.name}: {problem}")
            self.requeued.append(call)
        self.place.check()

    def finished_results(self) -> Iterator[tuple[str, Any]]:
        """Yield the results that are finished and were not yet yielded; errors among them are
        left out."""
        finished = [(call.name, future) for future, call in self.under_way.items() if future.done()]
        for name, future in (*self.ready, *finished):
            if not future.cancelled() and future.exception() is None:
                yield name, future.result()


# -- in the worker --------------------------------------------------------------------------------

_ONE_AT_A_TIME = (
    threading.Lock()
)  # libraries below have settings that all threads of a process share


def call_in_worker(source: str, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """Call the function in the worker, one at a time, and only where its code is that of the
    caller."""
    if fingerprint() != source:  # it may have joined the others, or been started again, since
        worker = f"{socket.gethostname()}, process {os.getpid()}"
        raise PlaceError(f"worker {worker}: its areaproof or a library is not the one used here")
    with _ONE_AT_A_TIME:
        return function(*arguments)


# -- in this process -------------------------------------------------------------------------------


class _ThisProcess:
    """This process: a function is called when its result is asked for."""

    local, attempts, names_lost_call, room = True, 1, True, 0

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        raise NotImplementedError  # there is no room for any

    def release(self, future: "Future[Any]") -> None: ...

    def lost(self, error: BaseException) -> bool:
        return False

    def check(self) -> None: ...
