"""Mutants of the code under test, against the tests that reach the line.

    python -m tests.mutants.reach          # once: which tests reach which lines
    python -m tests.campaigns.mutants --count 300 --seed 7

draws mutants of the files where a mistake makes a wrong verdict (`--rooms`: of every room), plants
each in the tests' process and in those that it starts, and runs the tests that reach its line, the
cheapest first, until one fails. What lives is printed, and kept in `--into`, from where the same
command goes on; survivors that are no errors are told in tests/mutants/survivors.toml.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

from tests.mutants import records
from tests.mutants.mutate import ROOT, Mutant
from tests.mutants.reach import Reach
from tests.mutants.records import Record
from tests.mutants.summary import found_in, no_errors, share
from tests.mutants.targets import ROOMS, SOUNDNESS, modules, sample

RESULTS = ROOT / "tests/mutants/campaign.jsonl"
_MOST = 90.0  # seconds of tests, as they take with the sound code
_SLOWER = 6  # times that, after which a mutant is said to hang
_START = 40.0  # seconds that a process may take beside its tests
_MEMORY = 24 << 20  # KiB


def reaching(mutant: Mutant, reach: Reach, most: float = _MOST) -> list[str]:
    """The tests that reach the mutant's line: those of its room first, and as many as fit.

    Then some that reach the module. What is run at its import is in no test, and what is made once
    for a process is in the first of them alone.
    """
    room = "/".join(mutant.module.split(".")[1:-1])
    chosen: dict[str, None] = {}
    spent = 0.0
    for line, limit in ((mutant.line, most), (None, most / 3)):
        found = reach.tests(mutant.module, line)
        for test in sorted(found, key=lambda name: f"/{room}/" not in name):
            if test not in chosen and spent + reach.seconds[test] <= limit:
                chosen[test] = None
                spent += reach.seconds[test]
    return list(chosen)


def attempt(mutant: Mutant, reach: Reach) -> Record:
    """What the tests say of a mutant."""
    chosen = reaching(mutant, reach)
    record: Record = {
        "kind": "mutant", "key": mutant.key, "module": mutant.module, "operator": mutant.operator,
        "index": mutant.index, "tests": len(chosen), "killed": False, "by": None,
    }  # fmt: skip
    if not chosen:
        return record | {"how": "no test reaches it", "seconds": 0}
    begun = time.monotonic()
    limit = _START + _SLOWER * sum(reach.seconds[test] for test in chosen)
    status, said = _run(mutant, chosen, limit)
    record["seconds"] = round(time.monotonic() - begun, 1)
    if status == 0:
        return record
    failed = [line for line in said.splitlines() if line.startswith(("FAILED", "ERROR"))]
    by = failed[0].split(" - ")[0] if failed else "a process that ends" if status else "a hang"
    how = "timeout" if status is None else "failed"
    return record | {"killed": True, "by": by, "how": how}


def _run(mutant: Mutant, chosen: list[str], limit: float) -> tuple[int | None, str]:
    """The status that pytest ends with, None where it does not in time; and what it printed."""
    with tempfile.TemporaryDirectory(prefix="mutant-") as made:
        listed = Path(made) / "tests"
        listed.write_text("\n".join(chosen), encoding="utf-8")
        environment = {
            **os.environ,
            "VERIFY_MUTANT": f"{mutant.module}:{mutant.index}",
            "VERIFY_MUTANT_ROOT": str(ROOT),
            "PYTHONPATH": str(ROOT / "tests/mutants/site"),
            "CI": "true",
            "TMPDIR": made,
            "XDG_CACHE_HOME": made,
        }
        command = ["bash", "-c", f'ulimit -v {_MEMORY}; exec "$@"', "-", sys.executable, "-m",
                   "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", "--tb=no", "-rfE",
                   f"@{listed}"]  # fmt: skip
        with subprocess.Popen(
            command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, start_new_session=True,
        ) as process:  # fmt: skip
            try:
                said, _ = process.communicate(timeout=limit)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, 9)
                process.communicate()
                return None, ""
        return process.returncode, said


def main() -> None:
    asked = _arguments()
    reach = Reach()
    chosen = modules(ROOMS if asked.rooms else SOUNDNESS)
    wanted = sample(asked.count, asked.seed, tuple(asked.module) or chosen)
    done = {r["key"] for r in records.of_kind(records.read(asked.into), "mutant")}
    waiting = [m for m in wanted if m.key not in done]
    with ThreadPoolExecutor(asked.workers) as pool:
        work = [pool.submit(attempt, mutant, reach) for mutant in waiting]
        for n, future in enumerate(as_completed(work), 1):
            record = future.result()
            records.add(asked.into, record)
            said = record["by"] if record["killed"] else f"LIVES ({record['tests']} tests)"
            print(
                f"{n}/{len(waiting)} {record['seconds']:6.1f} s {record['key']}: {said}", flush=True
            )
    found, same = found_in(records.read(asked.into), {m.key for m in wanted}), no_errors()
    living = [r for r in found.survivors if r["key"] not in same]
    total = len(found.mutants) - (len(found.survivors) - len(living))
    print(f"killed {share(found.killed, total)} of those that change something")
    for record in living:
        print(f"  lives: {record['key']}")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--rooms", action="store_true", help="of every room")
    parser.add_argument("--module", action="append", default=[], help="of these alone")
    parser.add_argument("--into", type=Path, default=RESULTS)
    return parser.parse_args()


if __name__ == "__main__":
    main()
