"""A progress bar in a notebook: that of tqdm if it is installed, else one line that is rewritten.

tqdm is imported only for a bar. A script shows a bar only if the caller requests one.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from verify.errors import InputError

Progress = Callable[[int], None] | bool | None
_SHOW_INTERVAL = 0.5  # seconds before a bar appears, and between two updates of a line


def in_notebook() -> bool:
    """Return True in a kernel of Jupyter, where a notebook runs."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextmanager
def progress_of(
    progress: Progress, label: str, total: int, *, adding: bool = False
) -> Iterator[Callable[[int], None] | None]:
    """Yield the function to call with the number of steps done, of `total`; None without a bar.

    `progress`: None for a bar in a notebook, True for one anywhere, False for none; or a function
    of the caller's own, which is yielded itself. `adding`: the function is called with the number
    of steps since its last call, not with the number of all steps.
    """
    if callable(progress):
        yield progress
        return
    if progress is not None and not isinstance(progress, bool):
        raise InputError("progress", progress, "allowed: True, False, None, or a function")
    is_visible = in_notebook() or (progress and sys.stderr is not None)  # None if it is closed
    if progress is False or not is_visible:
        yield None
        return
    bar = _create_bar(label, total)
    try:
        yield _Counter(bar, adding)
    finally:
        bar.close()


class _Counter:
    """The function that moves a bar; a smaller count moves it back, as when a run begins anew."""

    def __init__(self, bar: Any, adding: bool) -> None:
        self.bar, self.adding = bar, adding

    def __call__(self, count: int) -> None:
        self.bar.update(count if self.adding else count - self.bar.n)


def _create_bar(label: str, total: int) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Lines(label, total)
    return tqdm(total=total, desc=label, unit_scale=True, delay=_SHOW_INTERVAL, leave=False)


class _Lines:
    """A bar with tqdm's methods: a line that is rewritten, in a notebook or on standard error."""

    def __init__(self, label: str, total: int) -> None:
        self.label, self.total, self.n = label, total, 0
        self.display: Any = None
        self.last_shown = time.monotonic()

    def update(self, steps: int) -> None:
        self.n += steps
        # A notebook renders each line, so there are two a second at most.
        if time.monotonic() - self.last_shown >= _SHOW_INTERVAL:
            self.last_shown = time.monotonic()
            self._show(f"{self.label}: {self.n:,} of {self.total:,} ({self.n / self.total:.0%})")

    def close(self) -> None:
        if self.display is not None:
            self._show("")

    def _show(self, line: str) -> None:
        if not in_notebook():
            self.display = True  # a line is shown, which `close` blanks
            sys.stderr.write(f"\r{line:78}")
            sys.stderr.flush()
            return
        content = {"text/plain": line}
        if self.display is None:
            self.display = sys.modules["IPython"].display.display(
                content, raw=True, display_id=True
            )
        else:
            self.display.update(content, raw=True)
