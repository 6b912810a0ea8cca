"""The scheme of a printed table, as a text that `verify.schemes.get` reads.

`--scheme heun.toml` is the one [[table]] of the file, a Runge–Kutta method or a splitting, with its
numbers as they are printed, and its name as the title.
"""

import re
from collections.abc import Iterable
from pathlib import Path

from verify.algebra.expressions.formula_text import to_text
from verify.errors import InputError
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.splitting_claims import AlternatingEntry, parts_of
from verify.integrators.tables.table_file import read_tables
from verify.integrators.tables.tableau_claims import BlocksEntry, block_of
from verify.schemes.printed.naming import Naming


def scheme_from_file(path: Path) -> str:
    """Return the scheme of the one table in a TOML file, with a title.

    Raises InputError if the file holds several tables, or one of another kind.
    """
    entries = [entry for entry, _ in read_tables(path).entries]
    if len(entries) > 1:
        raise InputError("scheme", path.name, f"holds {len(entries)} tables; a scheme is one")
    (entry,) = entries
    title = re.sub(r"[\W_]+", "-", entry.name, flags=re.ASCII).strip("-")
    title = title if title[:1].isalpha() else f"table-{title}"
    lines = [*_lines(entry), *(f"order {x}" for x in [getattr(entry, "order", None)] if x)]
    return f"{title}: {'; '.join(lines)}"


def _lines(entry: TableEntry) -> Iterable[str]:
    naming = Naming(entry.numbers)
    if isinstance(entry, AlternatingEntry) and entry.first != "both":
        kinds, sizes, times = parts_of(entry, naming)
        moments = [f" at {x}" if x else "" for x in _values(naming, times or ())]
        moments = moments or [""] * len(kinds)
        pairs = zip(kinds, _values(naming, sizes), moments, strict=True)
        return [f"{kind} {size}{moment}" for kind, size, moment in pairs]
    if isinstance(entry, BlocksEntry) and len(entry.blocks) == 1:
        tableau = block_of(entry.blocks[0], naming, "", entry.folder).printed
        rows = [_values(naming, row) for row in tableau.matrix]
        clock = _values(naming, tableau.times or map(" + ".join, tableau.matrix))
        stages = [f"{c} | {' '.join(row)}" for c, row in zip(clock, rows, strict=True)]
        return [*stages, f"| {' '.join(_values(naming, tableau.weights))}"]
    allowed = "runge-kutta, or splitting with first = kick or drift"
    raise InputError("scheme", entry.name, f"is a table of kind {entry.kind}; allowed: {allowed}")


def _values(naming: Naming, texts: Iterable[str | None]) -> list[str]:
    """Return the numbers as printed, exact and without blanks; "" for a time that is missing."""
    printed = naming.printed_numbers
    exact = ("" if x is None else to_text(printed.at_print(printed.entry(x))) for x in texts)
    return [x.replace(" ", "") for x in exact]
