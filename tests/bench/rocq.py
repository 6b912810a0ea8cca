"""Certificates as files for Rocq: the time of an export, and of `coqc` for exports and the theory.

python tests/bench/rocq.py

Where `coqc` is missing the exports alone are measured.
"""

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.helpers.rocq.coqc import accepted, beside, compile_theory, each_after
from tests.helpers.rocq.exports import ALL, EVERY, ONE, export


@contextmanager
def measured(what: str, target: str = "–") -> Iterator[None]:
    """Prints the wall time, and the processor time of the processes that end within."""
    begun, used = time.perf_counter(), _seconds_of_children()
    yield
    wall, cpu = time.perf_counter() - begun, _seconds_of_children() - used
    print(f"{what:56} {wall:6.1f} s, of processors {cpu:6.1f} s   target {target}", flush=True)


def _seconds_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    verify = [sys.executable, "-m", "verify"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for case in ("every_lie2", "every_lie6", "duffing_lie2"):
            file, out = str(folder / f"{case}.json"), str(folder / f"{case}.v")
            asked = [*verify, "prove", *{**EVERY, **ONE}[case], "--certificate", file]
            subprocess.run(asked, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            exporting = [*verify, "certificate", "export", file, "--coq", out]
            with measured(f"{case} exported", "1 s"):
                subprocess.run(exporting, check=True, stdout=subprocess.DEVNULL)
        if shutil.which("coqc") is None:
            print("coqc is not installed: no more is measured")
            return
        for case, target in {"every_lie2": "–", "every_lie6": "20 s", "duffing_lie2": "–"}.items():
            alone = (folder / f"{case}.v").read_text(encoding="utf-8")
            with measured(f"coqc, {case}, standing alone", target):
                accepted(folder / f"{case}.v", alone)
        texts, theory = {case: export(case).text for case in ALL}, folder / "theory"
        with measured("coqc, two at a time, all of the following", "120 s on two cores"):
            with measured("coqc, two at a time, the theory"):
                compile_theory(theory)
            with measured(f"coqc, two at a time, {len(texts)} exports beside it"):
                each_after(
                    dict.fromkeys(texts, ()),
                    lambda case: accepted(folder / f"{case}.v", texts[case], beside(theory)),
                )


if __name__ == "__main__":
    main()
