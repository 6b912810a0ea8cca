"""Certificates of all kinds as files for Rocq: what the small checker accepts, `coqc` does.

    python -m tests.campaigns.rocq --count 100 --seed 1

The theory is compiled once, and each file imports it. Half of the certificates are those that
`tests.campaigns.certificates` makes its mutants of, half are mutants that the checker accepts.
"""

import argparse
import json
import random
import tempfile
import time
from collections.abc import Iterator
from itertools import count, islice
from pathlib import Path
from typing import Any

from tests.campaigns.certificates import mutant, seeds
from tests.helpers.rocq.coqc import beside, compile_theory, coqc
from verify.errors import InputError
from verify.proof.assistant.certificate_export import export_certificate
from verify.proof.certificates.checker import check

SLOWEST = 60.0  # seconds for a file


def accepted_mutants(seed: int) -> Iterator[dict[str, Any]]:
    """Mutants that the small checker accepts, each other data than those before it."""
    seen = set(map(json.dumps, seeds()))
    for k in count():
        data = mutant(random.Random(f"{seed}:{k}"))  # noqa: S311 - no secret
        text = json.dumps(data)
        try:
            check(data)
        except (ValueError, RecursionError):
            continue
        if text not in seen:
            seen.add(text)
            yield data


def chosen(number: int, seed: int) -> list[dict[str, Any]]:
    """So many certificates, half of them as they are."""
    whole = list(seeds(40_000))
    random.Random(seed).shuffle(whole)  # noqa: S311 - no secret
    found = whole[: number // 2]
    return [*found, *islice(accepted_mutants(seed), number - len(found))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    certificates = chosen(given.count, given.seed)
    left, bad = 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        compile_theory(folder / "theory")
        for k, data in enumerate(certificates):
            file = folder / f"certificate{k}.json"
            file.write_text(json.dumps(data), encoding="utf-8")
            try:
                text = export_certificate(file, stands_alone=False).text
            except InputError as error:
                left += 1
                print(f"{k}: not exported: {error}")
                continue
            out = file.with_suffix(".v")
            out.write_text(text, encoding="utf-8")
            begun = time.perf_counter()
            found = coqc(out, beside(folder / "theory"))
            took = time.perf_counter() - begun
            if found.status or took > SLOWEST:
                bad += 1
                print(f"{k}: {took:.1f} s, {found.complaints[:400]}\n{json.dumps(data)[:400]}")
            print(f"{k}: {took:.1f} s", flush=True)
    print(f"{len(certificates)} certificates, {left} not exported, {bad} refused or slow")
    raise SystemExit(bool(bad))


if __name__ == "__main__":
    main()
