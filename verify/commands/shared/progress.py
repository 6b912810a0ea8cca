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
    """Yield `advance(units)`, which does nothing where standard error is not a terminal.

    The bar shows units per second where they have a name, and the time left.
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
    """Yield `advance_to(count)`, for work that may begin anew; `count`: units done so far."""
    with progress_bar(label, total, unit) as advance:
        last = 0

        def advance_to(count: int) -> None:
            nonlocal last
            advance(count - last)
            last = count

        yield advance_to


@contextmanager
def clock(label: str, after: float = 2.0) -> Iterator[None]:
    """Show the elapsed time in a line on a terminal, from `after` seconds on."""
    if not sys.stderr.isatty():
        yield
        return
    # The work runs in this thread; another one writes the line.
    stop_event, begun = threading.Event(), time.monotonic()
    stream = getattr(sys.stderr, "stream", sys.stderr)  # which takes what moves its cursor

    def show_time() -> None:
        wait = after
        while not stop_event.wait(wait):
            print(f"\r{label} … {time.monotonic() - begun:.0f} s", end="", file=stream, flush=True)
            wait = 1.0

    thread = threading.Thread(target=show_time, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop_event.set()
        thread.join()
        if time.monotonic() - begun > after:
            print("\r\x1b[K", end="", file=stream, flush=True)
