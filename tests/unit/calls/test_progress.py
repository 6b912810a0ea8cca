"""A progress bar: only where somebody looks, by tqdm where it is installed."""

import sys
from collections.abc import Callable
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from verify.calls import progress
from verify.calls.progress import in_notebook, progress_of


class Shell:
    """As a notebook's kernel has it."""


Shell.__name__ = "ZMQInteractiveShell"


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """A notebook without tqdm; what it displays."""
    shown: list[Any] = []

    def display(content: Any, **_: object) -> Any:
        shown.append(content)
        return SimpleNamespace(update=lambda later, **_: shown.append(later))

    ipython: Any = ModuleType("IPython")
    ipython.get_ipython = Shell
    ipython.display = SimpleNamespace(display=display)
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(progress, "_SHOW_INTERVAL", 0)
    return shown


def test_a_script_shows_none_unless_it_is_asked_for() -> None:
    assert not in_notebook()
    for given in (None, False):
        with progress_of(given, "steps", 10) as tell:
            assert tell is None


def test_a_notebook_without_tqdm_has_one_line_that_is_written_anew(notebook: list[Any]) -> None:
    assert in_notebook()
    with progress_of(None, "steps", 2000) as tell:
        assert tell
        tell(500)
        tell(2000)
        tell(1000)  # a run that is done again begins again
    lines = [content["text/plain"] for content in notebook]
    assert lines == ["steps: 500 of 2,000 (25%)", "steps: 2,000 of 2,000 (100%)",
                     "steps: 1,000 of 2,000 (50%)", ""]  # fmt: skip


def test_what_adds_is_added(notebook: list[Any]) -> None:
    with progress_of(None, "steps", 10, adding=True) as tell:
        assert tell
        tell(3)
        tell(4)
    assert notebook[1]["text/plain"] == "steps: 7 of 10 (70%)"


def test_a_short_run_shows_nothing(notebook: list[Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "_SHOW_INTERVAL", 60)
    with progress_of(None, "steps", 10) as tell:
        assert tell
        tell(10)
    assert not notebook


def test_false_is_none_in_a_notebook_too(notebook: list[Any]) -> None:
    with progress_of(False, "steps", 10) as tell:
        assert tell is None
    assert not notebook


def test_tqdm_is_taken_where_it_is_installed(
    notebook: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Any] = []

    class Bar:
        n = 0
        closed = False

        def __init__(self, **options: object) -> None:
            self.options = options
            made.append(self)

        def update(self, more: int) -> None:
            self.n += more

        def close(self) -> None:
            self.closed = True

    auto: Any = ModuleType("tqdm.auto")
    auto.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", auto)
    with pytest.raises(KeyboardInterrupt), progress_of(None, "steps", 10) as tell:
        _tell_then_stop(tell)
    (bar,) = made
    assert (bar.n, bar.closed, bar.options["total"]) == (7, True, 10)
    assert not notebook


def _tell_then_stop(tell: Callable[[int], None] | None) -> None:
    assert tell
    tell(4)
    tell(7)
    raise KeyboardInterrupt


def test_on_a_terminal_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(progress, "_SHOW_INTERVAL", 0)
    with progress_of(True, "steps", 10) as tell:
        assert tell
        tell(5)
    out, err = capsys.readouterr()
    assert out == ""
    assert "steps: 5 of 10 (50%)" in err
