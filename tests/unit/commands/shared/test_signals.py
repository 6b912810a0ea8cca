"""An interruption or a termination is heard wherever it comes."""

import gc
import signal
import sys
import time
from pathlib import Path

import pytest

from verify.commands.main import TERMINATED, hear_signals

WAIT = 10  # seconds


def signalled_in_a_callback(number: signal.Signals) -> None:
    """Python prints and forgets what is raised in a callback of the garbage collector."""

    def once(phase: str, _: object) -> None:
        if phase == "stop":
            gc.callbacks.remove(once)
            signal.raise_signal(number)

    with hear_signals():
        gc.callbacks.append(once)
        gc.collect(
            0
        )  # the youngest objects; a full collection of all that tests leave takes seconds
        until = time.monotonic() + WAIT
        while time.monotonic() < until:
            time.sleep(0.01)


def test_an_interruption_in_a_callback_is_heard(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(KeyboardInterrupt):
        signalled_in_a_callback(signal.SIGINT)
    assert capsys.readouterr() == ("", "")


def test_a_signal_that_comes_while_it_is_sent_again_is_not_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As on a busy machine, where ten milliseconds may pass between two lines."""
    monkeypatch.setattr("verify.commands.main._RESEND_DELAY", 0.0)
    for _ in range(20):
        with pytest.raises(KeyboardInterrupt):
            signalled_in_a_callback(signal.SIGINT)


def test_and_so_is_a_termination(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        signalled_in_a_callback(signal.SIGTERM)
    assert ended.value.code == TERMINATED
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)]
)
def test_what_a_library_makes_of_a_signal_while_it_is_imported_is_that_signal(
    number: signal.Signals, raised: type[BaseException]
) -> None:
    """As pybind11 does: "ImportError: initialization failed"."""

    def import_library() -> None:
        try:
            signal.raise_signal(number)
        except BaseException as error:
            raise ImportError("initialization failed") from error

    with pytest.raises(raised), hear_signals():
        import_library()


SWALLOWS = """
import signal
try:
    signal.raise_signal(signal.{name})
except BaseException:
    pass
{more}
"""


def imported(folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, more: str = "") -> None:
    """A module that clears what is raised as it is imported, as gmpy2 does."""
    (folder / f"{folder.name}.py").write_text(SWALLOWS.format(name=name, more=more))
    monkeypatch.syspath_prepend(folder)
    with hear_signals():
        __import__(folder.name)
        time.sleep(WAIT)
        raise AssertionError("the signal is lost")


@pytest.mark.parametrize(
    ("name", "raised"), [("SIGINT", KeyboardInterrupt), ("SIGTERM", SystemExit)]
)
def test_a_signal_that_an_import_would_clear_waits_for_its_end(
    name: str, raised: type[BaseException], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = time.monotonic()
    with pytest.raises(raised):
        imported(tmp_path, monkeypatch, name)
    assert tmp_path.name in sys.modules
    assert time.monotonic() - begun < WAIT / 2


@pytest.mark.left_to_ci
def test_an_import_that_does_not_end_is_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        imported(tmp_path, monkeypatch, "SIGINT", "import time\ntime.sleep(60)")
    assert time.monotonic() - begun < WAIT


def test_an_error_without_a_signal_stays_that_error() -> None:
    with pytest.raises(ImportError), hear_signals():
        raise ImportError


def test_handlers_are_given_back() -> None:
    before = [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]
    with hear_signals():
        pass
    assert [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)] == before


def test_what_else_is_raised_there_is_told_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", lambda ignored: told.append(ignored.exc_type))
    before = sys.unraisablehook

    def once(*_: object) -> None:
        gc.callbacks.remove(once)
        raise ValueError

    with hear_signals():
        gc.callbacks.append(once)
        gc.collect(
            0
        )  # the youngest objects; a full collection of all that tests leave takes seconds
    assert told == [ValueError]
    assert sys.unraisablehook is before
