"""Certificates of all kinds as files for Rocq: what the small checker accepts, `coqc` does.

    python -m tests.campaigns.rocq --count 100 --seed 1

The theory is compiled once, and each file imports it. The certificates are those that
`tests.campaigns.certificates` makes its mutants of.
"""

import argparse
import json
import random
import subprocess
import tempfile
import time
from pathlib import Path

from tests.campaigns.certificates import seeds
from verify.errors import InputError
from verify.proof.assistant.export import exported
from verify.proof.assistant.shipped import LOGICAL, install

SLOWEST = 60.0  # seconds for a file


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    made = list(seeds(40_000))
    random.Random(given.seed).shuffle(made)  # noqa: S311 - no secret
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        theory = folder / "theory"
        for path in install(theory):
            subprocess.run(
                ["coqc", "-q", "-Q", theory, LOGICAL, path],
                check=True,
            )
        left, bad = 0, 0
        for k, data in enumerate(made[: given.count]):
            file = folder / f"certificate{k}.json"
            file.write_text(json.dumps(data), encoding="utf-8")
            try:
                text = exported(file, stands_alone=False).text
            except InputError as error:
                left += 1
                print(f"{k}: not exported: {error}")
                continue
            out = file.with_suffix(".v")
            out.write_text(text, encoding="utf-8")
            start = time.perf_counter()
            ended = subprocess.run(
                ["coqc", "-q", "-Q", theory, LOGICAL, out],
                capture_output=True,
                text=True,
                timeout=SLOWEST,
                check=False,
            )
            if ended.returncode:
                bad += 1
                print(f"{k}: refused: {ended.stderr[:400]}\n{json.dumps(data)[:400]}")
            took = time.perf_counter() - start
            print(f"{k}: {took:.1f} s", flush=True)
    print(f"{min(given.count, len(made))} certificates, {left} not exported, {bad} refused by coqc")


if __name__ == "__main__":
    main()
