"""`verify reference compare` of a million rows against its targets: right ones, and swapped ones.

python -m tests.bench.compare
"""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.helpers.programs.submitted_programs import (
    Program,
    kick_drift_kick,
    kick_first,
    lie1,
    lie2,
    lie3,
)

ROOT = Path(__file__).parents[2]
SECONDS, MEGABYTES = 20.0, 500.0
ROWS = 1_000_000
SCHEMES = {"lie1": lie1, "lie2": lie2, "lie3": lie3, "symplectic-euler": kick_first,
           "stormer-verlet": kick_drift_kick}  # fmt: skip
STEP_SIZES = (0.001, 0.002, 0.004, 0.006, 0.008, 0.01)
STARTS = ((0.1, 0.0), (0.5, 0.0), (1.5, 0.0), (1.5, 1.5), (0.0, 1.5))
STEPS = 5001  # of an orbit; none leaves the range of doubles by then


def rows(swapped: bool) -> Iterator[str]:
    """Every step of each of the scene's runs, until there are enough."""
    yield "scheme,step_size,q0,p0,step,p,q\n"
    count = 0
    while count < ROWS:  # the orbits are fewer: rows may stand twice
        for name, step in SCHEMES.items():
            for h in STEP_SIZES:
                for q, p in STARTS:
                    shown = (lambda z: z[::-1]) if swapped else (lambda z: z)
                    program = Program(step=step, h=h, q=q, p=p, shown=shown)
                    lines = program.rows(range(min(STEPS, ROWS - count)))
                    next(lines)
                    for line in lines:
                        yield f"{name},{h},{q},{p},{line}\n"
                        count += 1
                    if count >= ROWS:
                        return


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "theirs.csv"
        for what, swapped in (("as they should be", False), ("p and q swapped", True)):
            with path.open("w") as file:
                file.writelines(rows(swapped))
            command = ["reference", "compare", str(path), "--scene", "duffing"]
            begun = time.perf_counter()
            done = subprocess.run(
                [sys.executable, "-m", "verify", *command],
                cwd=ROOT, capture_output=True, text=True, check=False,
            )  # fmt: skip
            seconds = time.perf_counter() - begun
            used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
            missed = "" if seconds <= SECONDS and used <= MEGABYTES else "   MISSED"
            print(f"{what}: {seconds:.1f} s (target ≤ {SECONDS:g}), at most {used:.0f} MB "
                  f"(target ≤ {MEGABYTES:g}){missed}; {done.stdout.splitlines()[0]}, "
                  f"status {done.returncode}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
