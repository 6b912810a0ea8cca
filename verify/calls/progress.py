"""A progress bar in a notebook: tqdm's where that is installed, else one line that is written anew.

Nothing is imported before a bar is shown, and none is shown in a script unless it is asked for.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from verify.errors import InputError

Progress = Callable[[int], None] | bool | None
_SECONDS = 0.5  # until a bar appears, and between two lines


def in_notebook() -> bool:
    """Whether this is a notebook's kernel, as Jupyter has it."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextmanager
def progress_of(
    progress: Progress, label: str, total: int, *, adding: bool = False
) -> Iterator[Callable[[int], None] | None]:
    """Yields what is called with the number of steps done, of `total`; None where nobody looks.

    `progress`: None for a bar in a notebook, True for one anywhere, False for none, or a function
    of the caller's own, which is called itself. `adding`: it is called with those just done.
    """
    if callable(progress):
        yield progress
        return
    if progress is not None and not isinstance(progress, bool):
        raise InputError("progress", progress, "allowed: True, False, None, or a function")
    shown = in_notebook() or (progress and sys.stderr is not None)  # None: it is closed
    if progress is False or not shown:
        yield None
        return
    bar = _bar(label, total)
    try:
        yield _Counter(bar, adding)
    finally:
        bar.close()


class _Counter:
    """Tells a bar how far the work is; a run that is done again begins again."""

    def __init__(self, bar: Any, adding: bool) -> None:
        self.bar, self.adding = bar, adding

    def __call__(self, done: int) -> None:
        self.bar.update(done if self.adding else done - self.bar.n)


def _bar(label: str, total: int) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Lines(label, total)
    return tqdm(total=total, desc=label, unit_scale=True, delay=_SECONDS, leave=False)


class _Lines:
    """A bar as tqdm has it, in one line that is written anew: in a notebook, else on stderr."""

    def __init__(self, label: str, total: int) -> None:
        self.label, self.total, self.n = label, total, 0
        self.shown: Any = None
        self.last = time.monotonic()

    def update(self, more: int) -> None:
        self.n += more
        if time.monotonic() - self.last >= _SECONDS:
            self.last = time.monotonic()
            self._show(f"{self.label}: {self.n:,} of {self.total:,} ({self.n / self.total:.0%})")

    def close(self) -> None:
        if self.shown is not None:
            self._show("")

    def _show(self, line: str) -> None:
        if not in_notebook():
            self.shown = True
            sys.stderr.write(f"\r{line:78}")
            sys.stderr.flush()
            return
        content = {"text/plain": line}
        if self.shown is None:
            self.shown = sys.modules["IPython"].display.display(content, raw=True, display_id=True)
        else:
            self.shown.update(content, raw=True)
