"""Damaged kept results and checkpoints: each is noticed, and none is taken up.

    python -m tests.campaigns.kept_results --count 1000 --seed 1

A file has a bit turned, a digit or a word changed, is cut off or lengthened, or is swapped with
another one that is as well kept.
"""

import argparse
import random
import re
import tempfile
from pathlib import Path

from verify.execution.execute import Store
from verify.execution.keeper import NOTHING, Keeper
from verify.studies.kinds.every import EveryTask

TASKS = [EveryTask(scheme=name) for name in ("lie1", "lie2", "symplectic-euler", "rk4")]


def damaged(raw: bytes, other: bytes, rng: random.Random) -> bytes:
    """The content with one thing in it changed."""
    at = rng.randrange(len(raw))
    digits = [found.start() for found in re.finditer(rb"\d", raw)]
    match rng.randrange(6):
        case 0:
            return raw[:at] + bytes([raw[at] ^ 1 << rng.randrange(8)]) + raw[at + 1 :]
        case 1:
            at = rng.choice(digits)
            return raw[:at] + bytes([48 + (raw[at] - 47) % 10]) + raw[at + 1 :]
        case 2:
            return raw[:at]
        case 3:
            return raw[:at] + rng.randbytes(rng.randrange(1, 9)) + raw[at:]
        case 4 if b"PROVED" in raw:
            return raw.replace(b"PROVED", b"REFUTED")
        case _:
            return other


def kept_results(count: int, seed: int) -> list[str]:
    """What was taken up although it was damaged."""
    rng = random.Random(seed)  # noqa: S311 - no secret
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        store, results = Store(Path(folder)), [task.compute(NOTHING) for task in TASKS]
        for task, result in zip(TASKS, results, strict=True):
            store.put(task.key, result)
        keepers = [Keeper(Path(folder), name) for name in ("one", "two")]
        for k, keeper in enumerate(keepers):
            keeper.save("plain", {"done": 5 + k, "values": ["1/3", "2f/7"]})
        files = sorted(Path(folder).iterdir())
        contents = {path: path.read_bytes() for path in files}

        def taken() -> list[object]:
            return [
                *(store.get(task.key, task) for task in TASKS),
                *(keeper.load("plain") for keeper in keepers),
            ]

        whole = taken()
        for k in range(count):
            path = rng.choice(files)
            other = contents[rng.choice([each for each in files if each != path])]
            changed = damaged(contents[path], other, rng)
            if changed == contents[path]:
                continue
            path.write_bytes(changed)
            if sum(a != b for a, b in zip(taken(), whole, strict=True)) != 1:
                wrong.append(f"{k}: {path.name}")
            path.write_bytes(contents[path])
        if None in whole or taken() != whole:
            wrong.append("what is whole")
    return wrong


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    wrong = kept_results(given.count, given.seed)
    print(f"{given.count} damaged files: {len(wrong)} were taken up")
    print(*wrong, sep="\n")
    raise SystemExit(bool(wrong))


if __name__ == "__main__":
    main()
