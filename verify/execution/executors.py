"""Where functions are called: in this process, in processes beside it, or on a Dask cluster.

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
from verify.execution.keeping import fingerprint
from verify.execution.processes import Processes

_ADDRESS = re.compile(r"(tcp|tls)://[^\s/]+:\d{1,5}")
_LOOK = 5.0  # seconds after which the place is looked at, though nothing is finished


@dataclass(frozen=True)
class Placement:
    """Where tasks run: in so many processes here, or on the Dask cluster at that address.

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
    """`function(*arguments)`, to be found again by its name; `description` is what an error calls
    it.
    """

    name: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()
    description: str = ""


class Place(Protocol):
    """Where calls go. `local`: this machine's files and clock are theirs.

    `attempts`: so often may a call lose its worker. `names_lost_call`: a lost worker tells which
    call lost it; where it does not, that call and others are tried again one at a time.
    """

    local: bool
    attempts: int
    names_lost_call: bool

    @property
    def room(self) -> int:
        """So many calls may be under way; 0: a function is called where its result is asked for."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """As an executor's."""

    def release(self, future: "Future[Any]") -> None:
        """Called with each future that is finished, before the next call is submitted."""

    def lost(self, error: BaseException) -> bool:
        """Whether that error of a call says that its worker was lost."""

    def check(self) -> None:
        """Called every few seconds. PlaceError where nothing can be finished any more."""


@contextlib.contextmanager
def open_place(
    where: Placement,
    modules: Sequence[str] = (),
    after_end: Callable[[Sequence[int]], None] = lambda _: None,
) -> Iterator[Place]:
    """Opens the place where functions are called; left by an exception, it ends what is under way
    at once.

    `modules`: what processes have imported before their first call; of several places, the first
    says it for all. `after_end` hears the numbers of processes here that were ended.

    Processes are started as they are needed. InputError where the cluster does not answer, has no
    workers, or has other code than this.
    """
    if where.cluster is not None:
        from verify.execution.cluster import connected

        with connected(where.cluster) as place:
            yield place
    elif where.workers == 1:
        yield _ThisProcess()
    else:
        processes = Processes(where.workers or os.cpu_count() or 1, modules)
        try:
            yield processes
        except BaseException:
            after_end(processes.end())
            raise
        processes.close()


def results_of(
    place: Place, calls: Iterable[FunctionCall], *, one_by_one: bool = False
) -> Iterator[tuple[str, Any]]:
    """(name, result) of each call as it is finished; `one_by_one`: with no other under way.

    The calls are taken from their iterator as there is room. What a call raises is raised here,
    and so is PlaceError where a call loses its worker again and again; but first, as after an
    interruption, what else has been finished is yielded.
    """
    if place.room == 0:
        for call in calls:
            yield call.name, call.function(*call.arguments)
        return
    course = _Course(place, calls, one_by_one)
    try:
        while course.send():
            course.take()
            while course.ready:
                name, future = course.ready.popleft()
                yield name, future.result()
    except GeneratorExit:
        raise
    except BaseException:
        yield from course.rest()
        raise


class _Course:
    """The calls of one `results_of`: those under way, those lost, and those that are finished."""

    def __init__(self, place: Place, calls: Iterable[FunctionCall], one_by_one: bool) -> None:
        self.place, self.calls, self.one_by_one = place, iter(calls), one_by_one
        self.under_way: dict[Future[Any], FunctionCall] = {}
        self.again: deque[FunctionCall] = deque()
        self.ready: deque[tuple[str, Future[Any]]] = deque()
        self.losses: Counter[str] = Counter()

    def send(self) -> bool:
        """Sends as many as there is room for; whether any is under way."""
        while len(self.under_way) < self._room():
            call = self.again.popleft() if self.again else next(self.calls, None)
            if call is None:
                break
            future = self.place.submit(call_in_worker, fingerprint(), call.function, call.arguments)
            self.under_way[future] = call
        return bool(self.under_way)

    def _room(self) -> int:
        suspects = bool(self.again) or any(c.name in self.losses for c in self.under_way.values())
        alone = self.one_by_one or (suspects and not self.place.names_lost_call)
        return 1 if alone else self.place.room

    def take(self) -> None:
        """Waits until some are finished, and puts those that lost their worker among the others."""
        done, _ = wait(self.under_way, timeout=_LOOK, return_when=FIRST_COMPLETED)
        for future in done:
            call = self.under_way.pop(future)
            self.place.release(future)
            error = None if future.cancelled() else future.exception()
            if error is None or not self.place.lost(error):
                self.ready.append((call.name, future))
                continue
            self.losses[call.name] += 1
            if self.losses[call.name] >= self.place.attempts:
                problem = "its worker was lost again and again: killed, or out of memory?"
                raise PlaceError(f"{call.description or call.name}: {problem}")
            self.again.append(call)
        self.place.check()

    def rest(self) -> Iterator[tuple[str, Any]]:
        """What is finished and was not yet yielded; errors among it are left out."""
        finished = [(call.name, future) for future, call in self.under_way.items() if future.done()]
        for name, future in (*self.ready, *finished):
            if not future.cancelled() and future.exception() is None:
                yield name, future.result()


# -- in the worker --------------------------------------------------------------------------------

_ONE = threading.Lock()  # libraries below have settings that all threads of a process share


def call_in_worker(source: str, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """The call in the worker, one at a time, and only where its code is that of the caller."""
    if fingerprint() != source:  # it may have joined the others, or been started again, since
        worker = f"{socket.gethostname()}, process {os.getpid()}"
        raise PlaceError(f"worker {worker}: its areaproof or a library is not the one used here")
    with _ONE:
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
