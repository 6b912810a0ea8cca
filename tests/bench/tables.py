"""How long `verify check-table` and `check-integrator` of other languages take, start and all.

    python -m tests.bench.tables

One table of each kind; of order 8 a composition of 15 decimals and a tableau of doubles; a step in
C and a program that answers lines. Each is started three times as a user does; the least is told.
"""

import shlex
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

from tests.helpers.programs.compilers import library
from tests.paths import ROOT

HELPERS = ROOT / "tests" / "helpers"
PROGRAM = HELPERS / "programs" / "bad_program.py"
STEP = """#include <math.h>
void step(int n, double t, double h, double *p, double *q)
{ *p -= h / 2 * sin(*q); *q += h * *p; *p -= h / 2 * sin(*q); }
"""


def seconds(*arguments: str) -> float:
    """The least of three."""
    found = []
    for _ in range(3):
        begun = time.perf_counter()
        command = [sys.executable, "-m", "verify", *arguments]
        subprocess.run(command, cwd=ROOT, capture_output=True, check=False)
        found.append(time.perf_counter() - begun)
    return min(found)


def tables() -> dict[str, str]:
    """The first of each kind, and those of order 8, each as a file's text."""
    found: dict[str, str] = {}
    texts = [HELPERS / "tables" / "right.toml", ROOT / "reports" / "audits" / "literature.toml"]
    for path in texts:
        whole = path.read_text(encoding="utf-8")
        for entry, part in zip(
            tomllib.loads(whole)["table"], whole.split("[[table]]")[1:], strict=True
        ):
            name = entry["kind"]
            if entry["name"] == "Yoshida 8, solution A":
                name = "composition, order 8"
            found.setdefault(name, f"[[table]]{part}")
    order_8 = (HELPERS / "tables" / "order_8.toml").read_text(encoding="utf-8")
    return {**found, "runge-kutta, order 8": f"[[table]]\n{order_8}"}


def main() -> None:
    """Prints a row for each."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "table.toml")
        for name, text in tables().items():
            path.write_text(text, encoding="utf-8")
            print(f"check-table, {name:24} {seconds('check-table', str(path)):5.2f} s")
        made = library(Path(folder), "step.c", STEP, "-lm")
        more = ("--system", "pendulum", "--order", "2", "--symplectic")
        taken = seconds("check-integrator", f"{made}:step", *more)
        print(f"a step in C                           {taken:5.2f} s")
        program = shlex.join([sys.executable, str(PROGRAM), "right"])
        taken = seconds("check-integrator", "--command", program, *more)
        print(f"a program                             {taken:5.2f} s")


if __name__ == "__main__":
    main()
