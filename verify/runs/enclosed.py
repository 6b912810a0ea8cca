"""Bounds of runs in ball arithmetic: the run itself encloses the true values.

Where the digits asked for are not all known, or the balls have grown so wide that nothing is, it is
done again, in that case with twice the digits, and then with as many as the steps so far say that
all of them cost. Where twice the digits end at the same step, the orbit has left the range or the
domain there. Where too many digits or attempts would be needed, the run is "unresolved".
"""

from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.chunked_loop import Progress
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs.estimated import Bounds, digits_of, missing_of

_ATTEMPTS = 6
_MOST_TIMES = 64  # the first attempt's digits, beyond which a ball is given up


def enclosed(
    kernel_run: KernelRun, own: Arithmetic, digits: int, progress: Progress | None = None
) -> tuple[Bounds, Outcome]:
    """The values with the radii of their balls, and the run that they are of."""
    most, last = _MOST_TIMES * digits_of(own), None
    for attempt in range(1, _ATTEMPTS + 1):
        run = kernel_run.run(own, progress=progress)
        has, wanted = digits_of(own), 2 * digits_of(own)
        if run.done == kernel_run.steps:
            found = {n: (x, run.radii[n]) for n, x in run.values.items()}
            missing = max(missing_of(n, *value, digits) for n, value in found.items())
            if missing <= 0:
                return Bounds(found, f"ball arithmetic with {has} digits", rigorous=True), run
            wanted = has + missing + 5
        elif last and last[1] == run.done:
            # Twice as many digits would have carried a ball that had only grown too wide further.
            return Bounds({}, "ball arithmetic", "left range", run.done + 1), run
        elif last:  # about evenly, steps cost digits
            steps, spent = run.done - last[1], has - last[0]
            wanted = max(wanted, has + (kernel_run.steps - run.done) * spent // steps)
        if wanted > most or attempt == _ATTEMPTS:
            break
        last = has, run.done
        own = number_systems.get(own.name, wanted)
    method = f"balls that grow too wide in {has} digits; {wanted} would be tried next"
    return Bounds({}, method, "unresolved"), run
