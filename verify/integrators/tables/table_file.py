"""A file of printed tables: read, and each judged by what it claims.

[[table]]
name = "Ruth 3"
kind = "splitting"              # a wrong kind lists them
order = 3
first = "kick"
sizes = ["7/24", "2/3", "3/4", "-2/3", "-1/24", "1"]
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.files import read_text
from verify.integrators.tables import kinds
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.table_claim import TableClaim
from verify.scenes.model_mistakes import describe_first_error
from verify.scenes.toml_file import Lines, check_kind, lines_of, read_toml

MOST_TABLES = 1000
_ROOT = ("table", "title", "about", "left_out")


@dataclass(frozen=True)
class TableJudgement:
    """One claim of one table, as it is judged.

    `id`: the table's name and the claim's kind, parted by a slash; `table`: the name; `line`: of
    the file, on which the table begins, None where that is not known.
    """

    id: str
    table: str
    line: int | None
    claim: TableClaim


@dataclass(frozen=True)
class TableFile:
    """The entries of a file, each with its line. `left_out`: what of the whole is missing, and
    why."""

    name: str
    title: str
    entries: tuple[tuple[TableEntry, int], ...]
    lines: Lines
    left_out: tuple[tuple[str, str], ...] = ()

    def judge(self) -> Iterator[TableJudgement]:
        """Yield every claim of every table. Raises InputError, with the line, for what is no
        table."""
        for index, (entry, line) in enumerate(self.entries):
            try:
                for claim in kinds.get(entry.kind).claims(entry):
                    yield TableJudgement(f"{entry.name}/{claim.kind}", entry.name, line, claim)
            except InputError as error:
                raise locate_error(self.name, self.lines, index, entry.name, error) from None


def read_tables(path: Path) -> TableFile:
    """Read the tables of a TOML file. InputError names the file, the line, the table and the
    problem."""
    data = read_toml(path)
    check_kind(data, "table", path.name)
    lines = lines_of(read_text(path))
    for key in sorted(set(data) - set(_ROOT)):
        line = lines.line_of("", 0, key) if lines.has("", 0, key) else lines.line_of(key)
        place = f"{path.name}:{line}: {key}"
        raise InputError(place, data[key], f"unknown; allowed: {', '.join(_ROOT)}")
    tables = data.get("table")
    if not isinstance(tables, list) or not tables:
        raise InputError("file", path.name, "must hold [[table]] tables, each with name and kind")
    if len(tables) > MOST_TABLES:
        raise InputError("file", path.name, f"has {len(tables)} tables; allowed: {MOST_TABLES}")
    entries: dict[str, tuple[TableEntry, int]] = {}
    for index, table in enumerate(tables):
        name = table.get("name") if isinstance(table, dict) else None
        label = name if isinstance(name, str) and name else f"number {index + 1}"
        try:
            entry = _model(table).model_validate(table).in_folder(path.parent)
            if label in entries:
                raise InputError("name", label, "stands twice; each table has its own")
        except ValidationError as error:
            problem = describe_first_error(error, f"table {label}", _model(table))
            raise locate_error(path.name, lines, index, label, problem) from None
        except InputError as error:
            raise locate_error(path.name, lines, index, label, error) from None
        entries[label] = entry, lines.line_of("table", index) or 1
    title = str(data.get("title", path.stem))
    return TableFile(path.name, title, tuple(entries.values()), lines, _left_out(path.name, data))


def _left_out(name: str, data: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """Read what is left out. Raises InputError where it is no list of tables with what and why."""
    value = data.get("left_out", [])
    rows = value if isinstance(value, list) else [value]
    for row in rows:
        if not isinstance(row, dict) or set(row) != {"what", "why"}:
            problem = "is a list of tables, as [{ what = …, why = … }]"
            raise InputError(f"{name}: left_out", row, problem)
    return tuple((str(row["what"]), str(row["why"])) for row in rows)


def _model(table: Any) -> type[TableEntry]:
    kind = table.get("kind") if isinstance(table, dict) else None
    if kind is None:
        kind_names = ", ".join(kinds.names())
        raise InputError("kind", NOT_GIVEN, f"is missing; allowed: {kind_names}")
    if not isinstance(kind, str) or kind not in kinds.CATALOGUE:
        raise unknown_name("kind", kind, kinds.names())
    model: type[TableEntry] = kinds.get(kind).ENTRY
    return model


def locate_error(name: str, lines: Lines, index: int, table: str, error: InputError) -> InputError:
    """Return the error with the file, the table and the line of the key that it names."""
    message = error.name.removeprefix(f"table {table}").removeprefix(": ")
    key = message.split(".")[0].split(" ")[0].split(",")[0]
    # The problem names a key, or an entry such as a31 or b_p2: its line is looked for, then that of
    # the key without indices.
    keys = [key, key.rstrip("_pq0123456789")]
    if error.value is not NOT_GIVEN:  # it may stand in a formula
        keys += ["numbers", "sizes", "half", "tableau", "a"]
    line = lines.line_of("table", index, *filter(None, keys))
    place = f"{name}:{line}: table {table}"
    return type(error)(f"{place}: {message}" if message else place, error.value, error.problem)


def check_table(path: str | PathLike[str]) -> list[TableJudgement]:
    """Judge each claim of each `[[table]]` of a TOML file.

    `path`: the file; CSV files that it names lie beside it. Returns a TableJudgement for each
    claim, in the order of the file: its `claim` has the verdict with its evidence, and of what is
    wrong the nearest right numbers and the cost. Raises InputError, one line with the file, the
    line and the table, for what is no table, or claims nothing.

    >>> import tempfile
    >>> with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
    ...     print(
    ...         '[[table]]\\nname = "Verlet"\\nkind = "splitting"\\norder = 3\\n'
    ...         'first = "kick"\\nsizes = ["1/2", "1", "1/2"]',
    ...         file=file,
    ...         flush=True,
    ...     )
    ...     (found,) = check_table(file.name)
    >>> found.id, str(found.claim.verdict), found.claim.cost.order
    ('Verlet/order', 'REFUTED', 2)
    """
    return list(read_tables(Path(path)).judge())
