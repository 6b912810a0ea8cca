"""The file of results, one JSON object a line, written as they come; a run goes on from it.

`kind` is "asked" (what was run, on which source), "sound" (a killer on the sound code), "mutant",
"unit" (what a survivor's unit tests say) or "shown" (a mutant for a property that killed none).
"""

import hashlib
import json
from pathlib import Path
from typing import Any

from tests.mutants.mutate import ROOT

Record = dict[str, Any]


def read(path: Path) -> list[Record]:
    """All whole lines; a last one that an interruption cut is left out."""
    if not path.exists():
        return []
    found: list[Record] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            found.append(json.loads(line))
        except ValueError:
            continue
    return found


def add(path: Path, record: Record) -> None:
    """Writes one line."""
    path.parent.mkdir(parents=True, exist_ok=True)
    cut = path.exists() and not path.read_bytes().endswith(b"\n") and path.stat().st_size > 0
    with path.open("a", encoding="utf-8") as file:
        file.write(("\n" if cut else "") + json.dumps(record, ensure_ascii=False) + "\n")


def source() -> str:
    """A name for the code under test and the tests that kill: results of others are not mixed."""
    digest = hashlib.sha256()
    for folder in ("verify", "tests/property"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()[:12]


def of_kind(records: list[Record], kind: str) -> list[Record]:
    return [r for r in records if r["kind"] == kind]
