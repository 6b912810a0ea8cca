"""A finding's program in Python, run in a process of its own where its library is installed."""

import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

_SECONDS = 300.0
_ORDER = re.compile(r"^order on (.+): (-?\d+\.\d+)$", re.MULTILINE)


@dataclass(frozen=True)
class Ran:
    """What a program printed, and the orders that it names, by problem; `failed`: why it did not
    end well."""

    printed: str
    orders: dict[str, float]
    failed: str = ""


def run(program: str) -> Ran:
    """Runs the lines; nothing that it does is let through but what it prints."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "program.py"
        path.write_text(program, encoding="utf-8")
        try:
            done = subprocess.run(  # noqa: S603 - the program is ours, beside the descriptions
                [sys.executable, str(path)],
                capture_output=True,
                text=True,
                timeout=_SECONDS,
                cwd=folder,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return Ran("", {}, f"does not end within {_SECONDS:.0f} s")
    found = {name: float(order) for name, order in _ORDER.findall(done.stdout)}
    last = done.stderr.strip().splitlines()[-1:] if done.returncode else []
    return Ran(done.stdout.strip(), found, " ".join(last))
