"""What a run has found, counted: for the terminal, and for the page that `table` writes."""

import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.mutants.mutate import mutants, path_of
from tests.mutants.records import Record, of_kind

SURVIVORS = Path(__file__).parent / "survivors.toml"


@dataclass(frozen=True)
class Found:
    """The results of a sample, each mutant once."""

    mutants: tuple[Record, ...]
    unit: dict[str, Record]

    @property
    def killed(self) -> int:
        return sum(r["killed"] for r in self.mutants)

    @property
    def survivors(self) -> tuple[Record, ...]:
        return tuple(r for r in self.mutants if not r["killed"])

    def per(self, what: str) -> dict[str, tuple[int, int, int]]:
        """(mutants, killed, of which by a hang) by module or by operator."""
        names = sorted({r[what] for r in self.mutants})
        rows = {name: [r for r in self.mutants if r[what] == name] for name in names}
        return {
            name: (len(row), sum(r["killed"] for r in row), sum(_hung(r) for r in row))
            for name, row in rows.items()
        }

    def per_killer(self) -> dict[str, list[Record]]:
        """The mutants by what killed them: a property of the battery, or a test."""
        found: dict[str, list[Record]] = {}
        for record in self.mutants:
            if record["killed"] and record["how"] in ("violated", "failed"):
                found.setdefault(record["by"], []).append(record)
        return dict(sorted(found.items()))

    def ways(self) -> Counter[str]:
        """How the killed ones ended."""
        return Counter(r["how"] for r in self.mutants if r["killed"])


def _hung(record: Record) -> bool:
    return bool(record["killed"] and record["how"] == "timeout")


def found_in(records: list[Record], wanted: set[str] | None = None) -> Found:
    """The results of the wanted mutants, or of all."""
    mutants = {r["key"]: r for r in of_kind(records, "mutant")}
    kept = tuple(r for key, r in sorted(mutants.items()) if wanted is None or key in wanted)
    return Found(kept, {r["key"]: r for r in of_kind(records, "unit")})


def explanations(path: Path = SURVIVORS) -> dict[str, str]:
    """Why a survivor lives, by its key in today's source, as written by hand."""
    return {key: entry["why"] for entry, keys in explained(path) for key in keys}


def no_errors(path: Path = SURVIVORS) -> set[str]:
    """The keys of those that are explained as no error: no value or verdict depends on them."""
    return {k for entry, keys in explained(path) if entry.get("no_error", False) for k in keys}


def explained(path: Path = SURVIVORS) -> Iterator[tuple[Record, tuple[str, ...]]]:
    """Each entry with the key of its mutant in today's source; none where that has no such line."""
    if not path.exists():
        return
    entries: list[Record] = tomllib.loads(path.read_text(encoding="utf-8")).get("survivor", [])
    for entry in entries:
        yield entry, _keys(entry)


def _keys(entry: Record) -> tuple[str, ...]:
    try:
        lines = path_of(entry["module"]).read_text(encoding="utf-8").splitlines()
    except LookupError:
        return ()
    alike = [
        m.key
        for m in mutants(entry["module"])
        if f"{m.operator} {m.change}" == entry["change"]
        and lines[m.line - 1].strip() == entry["line"]
    ]
    return tuple(alike[entry["nth"] : entry["nth"] + 1] if "nth" in entry else alike)


def share(killed: int, total: int) -> str:
    """Rounded down, so that 90 % is 90 % at least."""
    return f"{killed} of {total} ({1000 * killed // max(total, 1) / 10} %)"


def summary(records: list[Record], wanted: set[str]) -> str:
    """The totals, those of each module, what each property killed, who lives unexplained."""
    found = found_in(records, wanted)
    lines = [f"killed {share(found.killed, len(found.mutants))}; {dict(found.ways())}"]
    lines += [f"  {name}: {share(k, n)}" for name, (n, k, _) in found.per("module").items()]
    lines += [
        f"  {name} killed {len(rows)}, as {rows[0]['key']}"
        for name, rows in found.per_killer().items()
    ]
    why = explanations()
    unexplained = [r["key"] for r in found.survivors if r["key"] not in why]
    lines.append(f"{len(unexplained)} survivors without an explanation in {SURVIVORS.name}")
    for key in unexplained:
        by = found.unit.get(key, {}).get("by")
        lines.append(f"  {key}" + (f" (a unit test kills it: {by})" if by else ""))
    return "\n".join(lines)
