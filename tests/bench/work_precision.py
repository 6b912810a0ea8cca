"""`verify bench` for one system, 8 schemes and 8 step sizes: how long, and how steady.

    python tests/bench/work_precision.py

Two processes, one after the other, each from a cold start. Targets: under 60 s each on 2 cores; the
order of the schemes by the median run time at each step size is the same in both, wherever two
schemes differ by more than 15 %; and no median differs by more than 15 %. On a machine with other
work to do the medians do not keep that, the order mostly does.
"""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

SCENE = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2"]
[work_precision]
time = 20
step_sizes = [0.1, 0.05, 0.025, 0.0125, 0.00625, 0.003125, 0.0015625, 0.00078125]
initial_value = { q = 1.5, p = 0 }
schemes = [
    "lie1", "lie2", "lie3", "lie4", "symplectic-euler", "stormer-verlet", "explicit-midpoint",
    "rk4",
]
peers = false
"""
SECONDS, APART = 60.0, 0.15
Medians = dict[tuple[str, str], float]  # by step size and scheme


def benched(path: Path) -> tuple[float, Medians]:
    """Seconds of the whole process, and the medians of the finished points."""
    begun = time.perf_counter()
    command = [sys.executable, "-m", "verify", "bench", str(path), "--json"]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    taken = time.perf_counter() - begun
    points: list[dict[str, Any]] = json.loads(done.stdout)["points"]
    known = (p for p in points if p["seconds_median"])
    return taken, {(p["step_size"], p["scheme"]): float(p["seconds_median"]) for p in known}


def turned(one: Medians, other: Medians) -> Iterator[tuple[str, str, str]]:
    """Pairs of schemes at a step size that are the other way round, and clearly so."""
    for (h, a), (g, b) in combinations(one, 2):
        if h == g:
            first, second = one[h, a] / one[h, b], other[h, a] / other[h, b]
            clear = max(first, 1 / first) > 1 + APART and max(second, 1 / second) > 1 + APART
            if clear and (first > 1) != (second > 1):
                yield h, a, b


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.toml"
        path.write_text(SCENE)
        (first, one), (second, other) = benched(path), benched(path)
    gaps = {key: abs(one[key] / other[key] - 1) for key in one}
    (h, scheme), worst = max(gaps.items(), key=lambda item: item[1])
    crossed = list(turned(one, other))
    steady = sum(gap <= APART for gap in gaps.values())
    print(f"{first:.1f} s and {second:.1f} s (target {SECONDS:g} s)")
    print(f"{steady} of {len(gaps)} medians within {APART:.0%}")
    print(f"worst {worst:.1%}: {scheme}, h = {h}")
    print(f"schemes that changed their order: {crossed or 'none'}")
    return int(max(first, second) > SECONDS or worst > APART or bool(crossed))


if __name__ == "__main__":
    sys.exit(main())
