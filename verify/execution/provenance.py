"""The provenance of results: the versions, the machine and the commit that computed them."""

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

_VERSIONED_PACKAGES = ("areaproof", "sympy", "python-flint", "gmpy2", "mpmath", "llvmlite", "numpy")
_PROCESSOR = Path("/proc/cpuinfo")
_GIT_SECONDS = 5.0  # the limit for git's answer
_COMMIT_LETTERS = 12  # of the hash of a commit


def versions() -> dict[str, str]:
    """Return the versions that a result depends on."""
    python = ".".join(map(str, sys.version_info[:3]))
    return {"Python": python} | {name: version(name) for name in _VERSIONED_PACKAGES}


def machine() -> str:
    """Describe the machine of this process, as a report prints it."""
    system = f"{platform.system()} {platform.machine()}"
    return ", ".join(filter(None, (system, _processor(), f"{os.cpu_count()} cores")))


def commit() -> str:
    """Return the commit of the checkout in which this code lies, or "" if it lies in none.

    If files differ from the commit, "and changes" follows.
    """
    root = checkout()
    if root is None or not (root / ".git").exists():
        return ""
    head = _git(root, "rev-parse", f"--short={_COMMIT_LETTERS}", "HEAD")
    status = head and _git(root, "status", "--porcelain", "--untracked-files=no")
    return f"{head} and changes" if status else head


def _git(root: Path, *command: str) -> str:
    """Return git's output; "" if there is no git, or if the folder is no checkout."""
    try:
        ran = subprocess.run(  # noqa: S603 - words of our own
            ("git", "-C", str(root), *command),  # noqa: S607 - whichever git the user has
            capture_output=True, text=True, timeout=_GIT_SECONDS, check=True,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError, UnicodeDecodeError):
        return ""
    return ran.stdout.strip()


def _processor() -> str:
    """Return the name of the processor; "" if the system does not tell it."""
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
    """Return the provenance of the results of a call that began at `start_time`, a value of
    `time.perf_counter`.

    `kept`, `computed`: the numbers of results that were read from the store, and computed.
    `where`: a description of the cluster, if one computed, to be appended to the machine.
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
