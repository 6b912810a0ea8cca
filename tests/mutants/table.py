"""Writes README.md from the results and from what is said of survivors by hand.

python -m tests.mutants.table
"""

import argparse
from collections.abc import Set
from pathlib import Path

from tests.mutants import records
from tests.mutants.run import RESULTS
from tests.mutants.summary import SURVIVORS, Found, explanations, found_in, no_errors, share

PAGE = Path(__file__).parent / "README.md"
_INTRODUCTION = """\
# Mutants of the code under test

A mutant is a module of `verify` with one thing in it changed: a sign, a comparison, a constant by
one, a condition. A property that holds for the code and is violated by a mutant says something.
`python -m tests.mutants.table` writes this page from the results; do not edit it.

- A mutant is killed where a property is violated, a test fails, something unexpected is raised, or
  the work hangs: it takes five times the processor time that the sound code takes, a minute at
  least. A check that the sound code does not pass ends the run.
- Killers that never enter the function in which a mutant stands are not run on it; it then lives.
- Once a minute of the processor is spent on a mutant, no other killer is asked, and it lives.
- `mutate.py` says what is not changed: texts, types, imports, what is raised, bounds of effort.
- Unit tests kill nothing here; they only help to explain who lives.
"""
_BY_HAND = "none of those tried; what `tests/unit/exploration/properties/test_properties.py` plants"


def page(found: list[records.Record], why: dict[str, str], same: Set[str] = frozenset()) -> str:
    """The whole page; `same`: the survivors that are no errors."""
    results = found_in(found)
    parts = [_INTRODUCTION, _what_was_run(found), _totals(results, same)]
    parts += [_table_of(results, "module"), _table_of(results, "operator")]
    parts += [_properties(results, found), _survivors(results, why)]
    return "\n".join(parts)


def _what_was_run(found: list[records.Record]) -> str:
    asked = {r["command"]: r for r in records.of_kind(found, "asked")}
    lines = ["## What was run", ""]
    for command, r in asked.items():
        lines.append(f"- `{command}` on the source {r['source']}")
    stages = {1: "the battery of properties", 2: "tests/property", 3: "tests/unit, to explain"}
    killers = records.of_kind(found, "sound")
    for stage, name in stages.items():
        of_stage = [r for r in killers if r["stage"] == stage]
        if of_stage:
            lines.append(f"- stage {stage}: {name}; {len(of_stage)} passed on the sound code")
    if not any(r["stage"] == 1 for r in killers):
        lines.append("- stage 1, the battery of properties, was not there to be run")
    return "\n".join([*lines, ""])


def _totals(results: Found, same: Set[str]) -> str:
    ways = ", ".join(f"{n} {how}" for how, n in sorted(results.ways().items()))
    killed = share(results.killed, len(results.mutants))
    lines = ["## Totals", "", f"Killed: **{killed}**. How: {ways or 'none'}.", ""]
    count = sum(record["key"] in same for record in results.survivors)
    if count:
        others = share(results.killed, len(results.mutants) - count)
        lines.append(
            f"{count} of the survivors are explained below as no errors: no value and no verdict "
            f"depends on what was changed. Of the others, **{others}** are killed.\n"
        )
    return "\n".join(lines)


def _table_of(results: Found, what: str) -> str:
    lines = [f"## By {what}", "", f"| {what} | mutants | killed | of these by a hang | % |",
             "|---|---|---|---|---|"]  # fmt: skip
    for name, (n, killed, hung) in results.per(what).items():
        lines.append(f"| `{name}` | {n} | {killed} | {hung} | {100 * killed // n} |")
    return "\n".join([*lines, ""])


def _properties(results: Found, found: list[records.Record]) -> str:
    lines = ["## Each property and a mutant that it kills", ""]
    lines += ["| property or test | mutants killed | the first of them |", "|---|---|---|"]
    shown = {r["property"]: r for r in records.of_kind(found, "shown")}
    killed = {name: (str(len(rows)), rows[0]["key"]) for name, rows in results.per_killer().items()}
    for name, record in shown.items():
        if name not in killed:
            key = record["key"]
            killed[name] = ("by itself" if key else "by hand", key)
    for name, (n, key) in sorted(killed.items()):
        lines.append(f"| {_cell(name)} | {n} | {_code(key) if key else _BY_HAND} |")
    return "\n".join([*lines, ""])


def _survivors(results: Found, why: dict[str, str]) -> str:
    lines = ["## Survivors, and why they live", ""]
    if not results.survivors:
        return "\n".join([*lines, "None.", ""])
    lines += ["| mutant | why | a unit test that kills it |", "|---|---|---|"]
    for record in results.survivors:
        key = record["key"]
        unit = results.unit.get(key, {}).get("by") or "–"
        lines.append(f"| {_code(key)} | {_cell(why.get(key, '**not explained**'))} | {unit} |")
    stale = sorted(set(why) - {r["key"] for r in results.survivors})
    if stale:
        lines += ["", f"Explained in {SURVIVORS.name}, but no survivors here:", ""]
        lines += [f"- {_code(key)}" for key in stale]
    return "\n".join([*lines, ""])


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _code(text: str) -> str:
    """As code in a table's cell; it may hold backticks, and `|` ends a cell even in code."""
    ticks = "``" if "`" in text else "`"
    return f"{ticks}{_cell(text)}{ticks}"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--into", type=Path, default=PAGE)
    asked = parser.parse_args()
    found = records.read(asked.results)
    if not records.of_kind(found, "mutant"):
        raise SystemExit(f"{asked.results} holds no results; run tests.mutants.run first")
    asked.into.write_text(page(found, explanations(), no_errors()), encoding="utf-8")
    print(f"wrote {asked.into}")


if __name__ == "__main__":
    main()
