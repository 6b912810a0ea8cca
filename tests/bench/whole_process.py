"""Times and peak memory of whole processes against the targets of the command line.

    python tests/bench/whole_process.py [--report]

Each command runs in a fresh process; the median of the wall times counts. `--report` adds the
paper's whole report and both of its tables from nothing, which take longer.
"""

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence

ROUNDS = 5
_RUN = (
    "from fractions import Fraction as F; from verify import run, systems;"
    "h = systems.get('duffing').hamiltonian({'delta': 1});"
    "r = run(h, 'lie2', q=F(3, 2), p=F(0), step_size=F(1, 1000), steps=%d)"
)
_TABLES = (
    "from verify.commands.shared.input import load_target;"
    "from verify.studies.tasks_of_scenes import plan_scenes;"
    "from verify.execution.execute import Store, execute\n"
    "if __name__ == '__main__':\n"
    "    _, scenes, _ = load_target('paper')\n"
    "    scenes = [s.with_only(schemes=('lie2',), grid=s.grid.model_copy(\n"
    "        update={'arithmetic': 'float64', 'separate': False})) for s in scenes]\n"
    "    plan = plan_scenes(scenes)\n"
    "    results = execute(plan, Store(None))\n"
    "    print(sum(getattr(r, 'steps', 0) for r in results.values()), 'steps')\n"
)


_SECOND = ["run", "--system", "duffing", "--param", "delta=1", "--scheme", "lie2",
           "--step-size", "0.001", "--steps", "1000", "--q", "1", "--p", "0"]  # fmt: skip


def measure(command: Sequence[str], rounds: int = ROUNDS) -> tuple[float, int]:
    """The median wall time in seconds and the greatest peak memory in KiB."""
    seconds, peaks = [], []
    for _ in range(rounds):
        begun = time.perf_counter()
        pid = os.posix_spawn(command[0], list(command), os.environ, file_actions=_QUIET)
        _, status, usage = os.wait4(pid, 0)
        seconds.append(time.perf_counter() - begun)
        peaks.append(usage.ru_maxrss)
        if os.waitstatus_to_exitcode(status) != 0:
            raise SystemExit(f"{' '.join(command)} failed")
    return statistics.median(seconds), max(peaks)


_QUIET = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]


def show(what: str, value: str, target: str) -> None:
    print(f"{what:58} {value:>12}   target {target}")


def main() -> None:
    verify = [sys.executable, "-m", "verify"]
    help_, _ = measure([*verify, "--help"])
    show("verify --help", f"{help_:.3f} s", "< 0.2 s")
    proof, _ = measure([*verify, "prove", "--system", "duffing", "--scheme", "lie2"])
    show("verify prove --system duffing --scheme lie2, cold", f"{proof:.3f} s", "< 1.5 s")
    measure([*verify, *_SECOND], 1)  # which keeps what it has read and compiled
    again, _ = measure([*verify, *_SECOND], 3 * ROUNDS)
    anew, _ = measure([*verify, *_SECOND, "--no-cache"], 3 * ROUNDS)
    bare, _ = measure([sys.executable, "-c", "import sympy"], 3 * ROUNDS)
    show("verify run, 1,000 steps, float64, a second time", f"{again:.3f} s", "< 0.4 s")
    show("- with --no-cache; import sympy alone", f"{anew:.3f} / {bare:.3f} s", "-")
    # Python alone does runs of up to 2·10⁵ steps; the compiler is there in both of these.
    peaks = [measure([sys.executable, "-c", _RUN % n], 3)[1] for n in (400_000, 40_000_000)]
    show("peak memory, 4·10⁷ steps over 4·10⁵", f"{peaks[1] / peaks[0]:.3f}", "≤ 1.10")
    if "--report" not in sys.argv:
        return
    with tempfile.TemporaryDirectory() as folder:
        script = os.path.join(folder, "tables.py")  # noqa: PTH118 - one file, for the pool's workers
        with open(script, "w") as file:  # noqa: PTH123
            file.write(_TABLES)
        seconds, _ = measure([sys.executable, script], 1)
        show(
            "both tables in full in float64, every value with its bound",
            f"{seconds:.1f} s",
            "< 60 s",
        )
        seconds, _ = measure([*verify, "report", "paper", "-o", os.path.join(folder, "r")], 1)  # noqa: PTH118
        show("verify report paper, from nothing", f"{seconds:.1f} s", "< 240 s")


if __name__ == "__main__":
    main()
