"""The whole stiff and extreme suites, every case to its verdict, as `verify stability` does them.

    python tests/bench/stability_suites.py

Process start and compilation are counted. Target: under 300 s on 2 cores for both together.
"""

import json
import subprocess
import sys
import time
from collections import Counter

TARGET = 300.0


def main() -> None:
    whole = 0.0
    for suite in ("stiff", "extreme"):
        begun = time.perf_counter()
        command = [sys.executable, "-m", "verify", "stability", suite, "--json"]
        found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        took = time.perf_counter() - begun
        whole += took
        cells = [cell["kind"] for m in found["maps"] for row in m["cells"] for cell in row]
        print(f"{suite}: {took:.1f} s, {len(found['cases'])} cases, {len(cells)} cells of maps")
        for kind, n in Counter([case["kind"] for case in found["cases"]] + cells).most_common():
            print(f"  {n:5} {kind}")
    print(f"both: {whole:.1f} s (≤ {TARGET:.0f})")


if __name__ == "__main__":
    main()
