"""The provenance of a report: the command, versions and machine that made it, and when."""

import time
from datetime import UTC, datetime

from verify.execution.machine import commit, machine, versions
from verify.scenes.results.report import Provenance


def provenance(
    command: str, start_time: float, *, kept: int, computed: int, where: str = ""
) -> Provenance:
    """Return the provenance of the results of this call, which began at `start_time` by
    `time.perf_counter`.

    `where`: what else computed, beside this machine.
    """
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
