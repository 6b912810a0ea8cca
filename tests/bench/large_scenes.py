"""A scene of 100, 1,000 and 10,000 runs: seconds, peak memory of the main process, and the page.

    python tests/bench/large_scenes.py [--runs 100 1000 10000]

Each scene is a grid of lie2 and lie4 on the Duffing oscillator at five step sizes, 1,000 steps a
run, with 20 certified digits, reported from nothing by the command line. What is kept of kernels is
left as it is.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

_STEP_SIZES = (0.001, 0.002, 0.005, 0.01, 0.02)
_SCHEMES = ("lie2", "lie4")


def scene(runs: int) -> str:
    starts = runs // (len(_STEP_SIZES) * len(_SCHEMES))
    values = ", ".join(f"{{ q = {0.5 + k / starts:.6f}, p = 0 }}" for k in range(starts))
    return f"""system = "duffing"
parameters = {{ delta = 1 }}
schemes = {json.dumps(_SCHEMES)}
[grid]
steps = 1000
step_sizes = {json.dumps(_STEP_SIZES)}
initial_values = [{values}]
digits = 20
"""


def measured(runs: int, folder: Path) -> tuple[float, int, int, int]:
    """Seconds, the main process' greatest kilobytes, and bytes of the page and of the data."""
    path, to = folder / f"runs{runs}.toml", folder / f"report{runs}"
    path.write_text(scene(runs), encoding="utf-8")
    command = [sys.executable, "-m", "verify", "report", str(path), "-o", str(to)]
    begun = time.perf_counter()
    process = os.posix_spawn(sys.executable, command, dict(os.environ))
    _, status, used = os.wait4(process, 0)
    if status:
        raise SystemExit(f"{' '.join(command)} ended with {status}")
    page, data = (to / name for name in ("index.html", "results.json"))
    return time.perf_counter() - begun, used.ru_maxrss, page.stat().st_size, data.stat().st_size


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--runs", type=int, nargs="+", default=[100, 1000, 10_000])
    asked = parser.parse_args()
    print("  runs   seconds   ms a run   peak MB   page kB   results.json kB")
    with tempfile.TemporaryDirectory() as folder:
        for runs in asked.runs:
            seconds, most, page, data = measured(runs, Path(folder))
            print(
                f"{runs:6} {seconds:9.1f} {1000 * seconds / runs:10.1f} {most / 1024:9.0f}"
                f" {page / 1000:9.0f} {data / 1000:17.0f}"
            )


if __name__ == "__main__":
    main()
