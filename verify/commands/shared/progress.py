"""A progress bar on standard error, and only on a terminal."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Advance = Callable[[int], None]


@contextmanager
def progress_bar(label: str, total: int, unit: str = "steps") -> Iterator[Advance]:
    """Yields `advance(units)`; it does nothing where standard error is not a terminal.

    Shows units per second where they have a name, and the time left.
    """
    if not (total > 0 and sys.stderr.isatty()):
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        ProgressColumn,
        TaskProgressColumn,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Speed(ProgressColumn):
        def render(self, task: Any) -> Text:
            return Text(f"{task.speed:,.0f} {unit}/s" if task.speed and task.speed > 0 else "")

    stream = getattr(sys.stderr, "stream", sys.stderr)  # which takes what moves its cursor
    columns: list[ProgressColumn | str] = ["{task.description}", BarColumn(), TaskProgressColumn()]
    columns += [Speed()] if unit else []
    columns.append(TimeRemainingColumn())
    with Progress(*columns, console=Console(file=stream), transient=True) as bar:
        task = bar.add_task(label, total=total)
        yield lambda units: bar.advance(task, units)


@contextmanager
def counting_bar(label: str, total: int, unit: str = "steps") -> Iterator[Callable[[int], None]]:
    """Yields `tell(done)`, the number of units done so far, of what may be begun anew."""
    with progress_bar(label, total, unit) as advance:
        last = 0

        def tell(done: int) -> None:
            nonlocal last
            advance(done - last)
            last = done

        yield tell


@contextmanager
def clock(label: str, after: float = 2.0) -> Iterator[None]:
    """A line on a terminal that says how long it has taken, from `after` seconds on."""
    if not sys.stderr.isatty():
        yield
        return
    ended, begun = threading.Event(), time.monotonic()
    stream = getattr(sys.stderr, "stream", sys.stderr)  # which takes what moves its cursor

    def tell() -> None:
        wait = after
        while not ended.wait(wait):
            print(f"\r{label} … {time.monotonic() - begun:.0f} s", end="", file=stream, flush=True)
            wait = 1.0

    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        if time.monotonic() - begun > after:
            print("\r\x1b[K", end="", file=stream, flush=True)
