"""By what and when a report was made."""

import time
from datetime import UTC, datetime

from verify.execution.machine import commit, machine, versions
from verify.scenes.results.report import Provenance


def provenance(
    command: str, begun: float, *, kept: int, computed: int, where: str = ""
) -> Provenance:
    """That of what this call made, which began at `begun` by `time.perf_counter`.

    `where`: what else computed, beside this machine.
    """
    return Provenance(
        command=command,
        versions=versions(),
        machine=f"{machine()}{where}",
        seconds=time.perf_counter() - begun,
        kept=kept,
        computed=computed,
        made=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        commit=commit(),
    )
