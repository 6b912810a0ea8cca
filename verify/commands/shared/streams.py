"""Standard output and error as the command uses them: text that any terminal may be given."""

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from verify.errors import CONTROL


class Printable(io.TextIOBase):
    """A text stream without control characters, and without what its encoding does not have.

    Each is written as its escape (`\\u001b`), which in JSON's strings means the same.
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self._encoding = getattr(stream, "encoding", None) or "utf-8"

    def write(self, given: str | bytes) -> int:
        if isinstance(given, bytes) and not given:  # how click asks whether this takes bytes
            raise TypeError("a stream of texts")
        # Yet what it tells a shell, to complete a line, are bytes.
        text = given if isinstance(given, str) else bytes(given).decode()
        shown = CONTROL.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
        raw = shown.encode(self._encoding, "backslashreplace")
        self.stream.write(raw.decode(self._encoding))
        return len(given)

    def flush(self) -> None:
        self.stream.flush()

    def isatty(self) -> bool:
        return self.stream.isatty()

    def fileno(self) -> int:
        return self.stream.fileno()

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return self._encoding


@contextmanager
def printable_streams() -> Iterator[None]:
    """Makes both streams printable while the command runs; a closed output stays None.

    Where standard input or error is closed, nothing is read, and what is written is dropped.
    """
    before = sys.stdin, sys.stdout, sys.stderr
    _take_closed_numbers()
    with open(os.devnull, "r+") as nowhere:  # noqa: PTH123
        sys.stdin, sys.stderr = sys.stdin or nowhere, Printable(sys.stderr or nowhere)
        sys.stdout = sys.stdout and Printable(sys.stdout)
        try:
            yield
        finally:
            sys.stdin, sys.stdout, sys.stderr = before


def _take_closed_numbers() -> None:
    """Opens the null device at those of the numbers 0, 1 and 2 that are closed, for good.

    A file opened later would get that number, and what libraries in C and started processes write.
    """
    while (handle := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(handle, True)
    os.close(handle)
