"""The provenance of results: the versions, machine and commit that they are computed by."""

import os
import platform
import subprocess
import sys
import time
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from verify.content import checkout

if TYPE_CHECKING:
    from verify.scenes.results.report import Provenance

_VERSIONED = ("areaproof", "sympy", "python-flint", "gmpy2", "mpmath", "llvmlite", "numpy")
_PROCESSOR = Path("/proc/cpuinfo")
_SECONDS = 5.0  # for git to answer
_LETTERS = 12  # of a commit


def versions() -> dict[str, str]:
    """Return the versions that a result depends on."""
    python = ".".join(map(str, sys.version_info[:3]))
    return {"Python": python} | {name: version(name) for name in _VERSIONED}


def machine() -> str:
    """Describe the machine of this process, as a report prints it."""
    system = f"{platform.system()} {platform.machine()}"
    return ", ".join(filter(None, (system, _processor(), f"{os.cpu_count()} cores")))


def commit() -> str:
    """Return the commit of the checkout this code lies in, "and changes" where files differ; ""
    without one."""
    root = checkout()
    if root is None or not (root / ".git").exists():
        return ""
    head = _git(root, "rev-parse", f"--short={_LETTERS}", "HEAD")
    status = head and _git(root, "status", "--porcelain", "--untracked-files=no")
    return f"{head} and changes" if status else head


def _git(root: Path, *command: str) -> str:
    """Return git's output, or "" where there is no git, or it has nothing to say of this folder."""
    try:
        ran = subprocess.run(  # noqa: S603 - words of our own
            ("git", "-C", str(root), *command),  # noqa: S607 - whichever git the user has
            capture_output=True, text=True, timeout=_SECONDS, check=True,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError, UnicodeDecodeError):
        return ""
    return ran.stdout.strip()


def _processor() -> str:
    """Return the processor's name, where the system tells it."""
    try:
        description = _PROCESSOR.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return platform.processor()
    names = (
        line.partition(":")[2].strip() for line in description.splitlines() if "model name" in line
    )
    return next(names, "")


def provenance(
    command: str, start_time: float, *, kept: int, computed: int, where: str = ""
) -> "Provenance":
    """Return the provenance of the results of this call, which began at `start_time` by
    `time.perf_counter`.

    `where`: what else computed, beside this machine.
    """
    # Imported here, since a single run needs the versions alone, and none of a report's models.
    from verify.scenes.results.report import Provenance

    return Provenance(
        command=command,
        versions=versions(),
        machine=f"{machine()}{where}",
        seconds=time.perf_counter() - start_time,
        kept=kept,
        computed=computed,
        # In UTC, so that reports made in different places can be ordered.
        made=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        commit=commit(),
    )
