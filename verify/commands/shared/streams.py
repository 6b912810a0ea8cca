"""Standard output and error as the command uses them: text that any terminal may be given."""

import io
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
    """Both streams so, while the command runs; one that is closed stays None."""
    before = sys.stdout, sys.stderr
    out, err = (stream and Printable(stream) for stream in before)
    sys.stdout, sys.stderr = out, err
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
