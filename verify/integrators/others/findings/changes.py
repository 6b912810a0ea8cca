"""A table with entries changed, as a mend would have them."""

from collections.abc import Mapping
from functools import cache
from typing import Any

import sympy
from pydantic import ValidationError

from verify.errors import InputError
from verify.integrators.others.printed_libraries import files
from verify.integrators.tables import kinds
from verify.integrators.tables.check import read_tables
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.splittings.claims import AlternatingEntry, parts_of
from verify.scenes.mistakes.values import one_line
from verify.schemes.printed.naming import Naming

RIGHT = "right"


def entry_of(name: str) -> TableEntry:
    """The printed table of that id. InputError for none."""
    found = _entries().get(name)
    if found is None:
        raise InputError("table", name, "is none of the printed tables in reports/audits")
    return found


@cache
def _entries() -> dict[str, TableEntry]:
    """All printed tables of libraries, by id; the files are read once."""
    each = map(read_tables, files())
    return {f"{x.title.split()[0]}/{entry.name}": entry for x in each for entry, _ in x.entries}


def changed(entry: TableEntry, changes: Mapping[str, str]) -> TableEntry:
    """The same with those entries. InputError for a key that it has not."""
    data = entry.model_dump(exclude_unset=True)
    for key, value in changes.items():
        if key == "times" and value == RIGHT:
            data["times"] = _right_times(entry)
        else:
            _put(data, key, value)
    try:
        made: TableEntry = kinds.get(entry.kind).Entry.model_validate(data)
    except ValidationError as error:
        raise one_line(error, "changes", type(entry)) from None
    return made.in_folder(entry.folder)


def _put(data: dict[str, Any], key: str, value: str) -> None:
    *path, last = [int(x) - 1 if x.isdigit() else x for x in key.split(".")]
    place: Any = data
    for step in path:
        place[step] = list(place[step]) if isinstance(place[step], tuple) else place[step]
        place = place[step]
    if isinstance(last, int) and not last < len(place):
        raise InputError("changes", key, "is no entry of the table")
    place[last] = value


def _right_times(entry: TableEntry) -> list[str]:
    """Each part reads the time that the other kind's parts before it add up to."""
    if not isinstance(entry, AlternatingEntry):
        raise InputError("changes", "times", "are made right of kicks and drifts alone")
    naming = Naming(entry.numbers)
    names, sizes, _ = parts_of(entry, naming)
    totals = {"kick": sympy.S.Zero, "drift": sympy.S.Zero}
    times = []
    for name, size in zip(names, sizes, strict=True):
        other = "drift" if name == "kick" else "kick"
        times.append(str(sympy.N(totals[other], 60)))
        totals[name] += naming.printed.at_print(naming.printed.entry(size))
    return times
