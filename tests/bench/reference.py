"""Reference data against their targets: the committed set made from nothing, and checked.

python tests/bench/reference.py            # both targets, from process start
python tests/bench/reference.py --all      # and everything computed again
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
MAKE, CHECK = 600.0, 30.0  # seconds, on 2 cores
LIMIT = 5_000_000  # bytes


def timed(*given: str) -> tuple[float, str]:
    """Seconds of the command from process start, and what it printed last."""
    command = [sys.executable, "-m", "verify", "reference", *given]
    begun = time.perf_counter()
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return time.perf_counter() - begun, done.stdout.splitlines()[-1]


def told(what: str, seconds: float, most: float, printed: str) -> None:
    missed = "" if seconds <= most else "   MISSED"
    print(f"{what:24}{seconds:7.1f} s   target ≤ {most:g} s{missed}   {printed}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--all", action="store_true", help="compute everything again, too")
    everything = parser.parse_args().all
    with tempfile.TemporaryDirectory() as folder:
        made = timed("make", "-o", folder, "--workers", "2")
        told("make, 2 workers", made[0], MAKE, made[1])
        names = {path.name for path in Path(folder).iterdir()}
        size = sum(path.stat().st_size for path in Path(folder).iterdir())
        print(f"size {size:,} bytes   target ≤ {LIMIT:,}")
        kept = ROOT / "reference" / "data"
        other = [
            n for n in sorted(names) if (kept / n).read_bytes() != Path(folder, n).read_bytes()
        ]
        print("as committed" if not other else f"NOT as committed: {', '.join(other)}")
    for seed in ("1", "2", "3"):
        told(f"check, seed {seed}", *_pair(timed("check", "--seed", seed), CHECK))
    if everything:
        told("check --all, 2 workers", *_pair(timed("check", "--all", "--workers", "2"), MAKE))


def _pair(found: tuple[float, str], most: float) -> tuple[float, float, str]:
    return found[0], most, found[1]


if __name__ == "__main__":
    main()
