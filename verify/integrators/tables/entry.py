"""One [[table]] as a file has it: its keys, its numbers, and tableaux as text or in CSV files.

Numbers from any paper or program are rewritten in the signs of formulas:

plain("−½ × 10⁻³")           -(1/2)*10^(-3)
plain("\\frac{\\sqrt{3}}{6}")   ((sqrt(3))/(6))
plain("0.5d-1")              0.5e-1

Butcher's tableau is read as it is printed:

    0    |
    1/2  | 1/2
    1    | -1   2
    -----+----------------
         | 1/6  2/3  1/6

Times stand left of a bar, or in the first column; the weights below a rule, or in lines whose first
column is empty. The first line of weights is b, the second that of the embedded method. Columns are
parted by `&`, tabs, commas, semicolons, or blanks.
"""

import csv
import re
import unicodedata
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PrivateAttr, StrictBool, StringConstraints

from verify.errors import InputError
from verify.files import read_text
from verify.scenes.frozen import Frozen

LONGEST = 2000  # characters of a number, or of a formula
_SIGNS = {
    **dict.fromkeys("−–‒‐‑﹣－", "-"),
    **dict.fromkeys("⁄∕÷", "/"),
    **dict.fromkeys("×·⋅∗•", "*"),
    **dict.fromkeys(" \u00a0\u2009\u202f\u2002\u2003", " "),
    "＋": "+", "π": "pi",
}  # fmt: skip
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_LATEX = (
    (re.compile(r"\\(?:left|right|displaystyle|,|;|!|quad|hfill)|[$~]"), " "),
    (re.compile(r"\\(?:cdot|times)\b"), "*"),
    (re.compile(r"\\pi\b"), "pi"),
)
_FRACTION = re.compile(r"\\[dt]?frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}|\\[dt]?frac\s*(\d)\s*(\d)")
_ROOT = re.compile(r"\\sqrt\s*\{([^{}]*)\}")
_SIGN_OF_ROOT = re.compile(r"√\s*(\d+(?:\.\d+)?|\([^()]*\))")
_TEN = re.compile(r"(?<=\d)\s*\*\s*10\s*(?:\^|\*\*)\s*[({]?\s*([+-]?\d+)\s*[)}]?")
_FORTRAN = re.compile(r"(?<=[\d.])[dD](?=[+-]?\d)")
_GROUPED = re.compile(r"\d*\.\d+(?: \d+)+(?![\d/.])")


def plain(text: str) -> str:
    """Write the same number in the signs of formulas; leave any other text to their reader."""
    text = "".join(_SIGNS.get(x, x) for x in text)
    text = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺]+", lambda m: f"^({m[0].translate(_RAISED)})", text)
    text = "".join(_vulgar(x) for x in text)
    for pattern, instead in _LATEX:
        text = pattern.sub(instead, text)
    for _ in range(8):  # from the inside out
        before = text
        text = _ROOT.sub(r"(sqrt(\1))", text)
        text = _FRACTION.sub(lambda m: f"(({m[1] or m[3]})/({m[2] or m[4]}))", text)
        if text == before:
            break
    text = _SIGN_OF_ROOT.sub(r"sqrt(\1)", text)
    text = re.sub(r"(?<=[\d)])\s*(?=\(*sqrt)", "*", text)
    text = _TEN.sub(r"e\1", text)
    text = _FORTRAN.sub("e", text)
    text = _GROUPED.sub(lambda m: m[0].replace(" ", ""), text.strip())
    return re.sub(r"\s*([/*()+-])\s*", r"\1", text)


def _vulgar(x: str) -> str:
    """Write ½ and the like, which stand for two numbers and a bar, as a quotient."""
    parts = unicodedata.normalize("NFKC", x)
    return f"({parts.replace(chr(0x2044), '/')})" if chr(0x2044) in parts and len(parts) > 1 else x


# -- the keys -------------------------------------------------------------------------------------


def normalize_number(value: Any) -> Any:
    """Write a number of the file in our signs; return what is no text or whole number as it is."""
    if isinstance(value, bool):
        return value
    if isinstance(value, int):
        return str(value)
    return plain(value) if isinstance(value, str) and len(value) <= LONGEST else value


NumberText = Annotated[
    str, StringConstraints(max_length=LONGEST), BeforeValidator(normalize_number)
]
Row = tuple[NumberText, ...]
Order = Annotated[int, Field(ge=1, le=20)]


class Block(Frozen):
    """One tableau. `tableau`: pasted text, in place of the others; `csv`: the name of a file."""

    a: tuple[Row, ...] | None = None
    b: Row | None = None
    c: Row | None = None
    embedded: Row | None = None
    tableau: str | None = None
    csv: str | None = None


class TableEntry(Frozen):
    """One [[table]]: `numbers` by name, `source` who claims it, `read` where it was read."""

    name: Annotated[str, Field(min_length=1, max_length=200)]
    kind: str
    source: str = ""
    read: str = ""
    numbers: dict[str, NumberText] = Field(default_factory=dict)
    symplectic: StrictBool = False
    symmetric: StrictBool = False
    csv: str | None = None
    _folder: Path = PrivateAttr(default=Path())

    def in_folder(self, folder: Path) -> "TableEntry":
        """Return the entry with the folder in which its other files lie."""
        self._folder = folder
        return self

    @property
    def folder(self) -> Path:
        """The folder of its files."""
        return self._folder


# -- a tableau that is pasted ---------------------------------------------------------------------

_RULE = re.compile(r"[\s|+:─━—_=-]*")
_BARS = "│┃∣"
_MOST_BYTES = 1 << 20
_BLANKS = re.compile(r"\s{2,}")
Line = tuple[str | None, list[str]]  # what stands left of a bar, None without one; and the columns


def parse_tableau(text: str, name: str = "tableau") -> Block:
    """Parse a tableau that is pasted as text. Raises InputError where it is none."""
    lines = []
    text = re.sub(r"\\\\\s*(\[[^]]*\])?", "\n", text).replace(r"\hline", "\n----\n")  # LaTeX's
    for line in text.translate({ord(bar): "|" for bar in _BARS}).splitlines():
        if line.strip():
            lines.append(None if _is_rule(line) else line)
    return _build_block(
        *_split_lines([line if line is None else _cells(line) for line in lines]), name
    )


def _is_rule(line: str) -> bool:
    return bool(re.search(r"[-─━—_=]{2}", line)) and _RULE.fullmatch(line) is not None


def _cells(line: str) -> tuple[str | None, list[str]]:
    """Split a line into the part left of a bar, None where there is none, and the columns."""
    left: str | None = None
    if "|" in line:
        left, _, line = line.partition("|")
        left = left.strip().rstrip("&").strip()
    elif line.lstrip().startswith("&"):
        left, line = "", line.lstrip()[1:]
    return left, columns(line)


def columns(line: str) -> list[str]:
    """Return the numbers of a line, in our signs."""
    for mark in ("&", "\t", ";", ","):
        if mark in line:
            parts = line.split(mark)
            break
    else:
        closer = re.sub(r"\s*([/×·*])\s*", r"\1", line.strip())
        wide = _BLANKS.split(closer)
        parts = wide if any(" " in part for part in wide) and len(wide) > 1 else closer.split()
    numbers = [plain(part) for part in parts if part.strip()]
    for number in numbers:
        if len(number) > LONGEST:
            raise InputError("number", number, f"is longer than {LONGEST} characters")
    return numbers


def _split_lines(lines: Sequence[Line | None]) -> tuple[list[Line], list[Line]]:
    """Split the lines into stages and weights: weights stand below the last rule, or have nothing
    before their bar."""
    rules = [k for k, line in enumerate(lines) if line is None]
    inner = [k for k in rules if 0 < k < len(lines) - 1]
    if inner:
        cut = inner[0]
        stages = [x for x in lines[:cut] if x is not None]
        return stages, [x for x in lines[cut:] if x is not None]
    present = [x for x in lines if x is not None]
    cut = next((k for k, (left, _) in enumerate(present) if left == ""), len(present))
    return present[:cut], present[cut:]


def _build_block(stages: Sequence[Line], weights: Sequence[Line], name: str) -> Block:
    if not stages or not weights:
        problem = "has no weights; write them below a line of ---, or after an empty first column"
        raise InputError(name, f"{len(stages)} lines", problem)
    if len(weights) > 2:
        raise InputError(
            name, f"{len(weights)} lines of weights", "has one, or two: b and embedded"
        )
    timed = any(left for left, _ in stages)
    count = len(weights[0][1])
    if not timed and all(left is None for left, _ in stages):
        # Without bars the times are the first column, where rows are longer by one.
        lengths = [len(cells) for _, cells in stages]
        explicit = lengths[0] == 1 and all(
            n in (k + 1, k + 2, count + 1) for k, n in enumerate(lengths)
        )
        if explicit or all(n == count + 1 for n in lengths):
            stages, timed = [(cells[0], cells[1:]) for _, cells in stages], True
    times = tuple(plain(left or "0") for left, _ in stages) if timed else None
    rows = tuple(tuple(cells) for _, cells in stages)
    (_, b), *embedded_lines = weights
    embedded = next(((*x, *["0"] * (count - len(x))) for _, x in embedded_lines), None)
    return Block(a=rows, b=tuple(b), c=times, embedded=embedded)


# -- CSV files ------------------------------------------------------------------------------------


def csv_rows(folder: Path, name: str) -> list[list[str]]:
    """Read the rows of a CSV file in that folder. Raises InputError where it does not lie there, or
    is none."""
    if Path(name).name != name or name in ("", ".", ".."):
        raise InputError("csv", name, "is no name of a file beside the table's")
    text = read_text(folder / name, _MOST_BYTES).lstrip("\ufeff")
    first = text.splitlines()[0] if text.strip() else ""
    # Spreadsheets write semicolons where the decimal sign is a comma.
    mark = next((x for x in ("\t", ";") if x in first), ",")
    try:
        table = list(csv.reader(text.splitlines(), delimiter=mark, strict=True))
    except csv.Error as error:
        raise InputError("csv", name, f"is no CSV file: {error}") from None
    return [[cell.strip() for cell in row] for row in table if any(cell.strip() for cell in row)]


def block_of_csv(folder: Path, name: str) -> Block:
    """Read a tableau from a CSV file: times first, weights in rows whose first cell is empty."""
    rows = csv_rows(folder, name)
    if rows and not any(x.isdigit() for x in "".join(rows[0])):
        rows = rows[1:]  # a header
    lines: list[Line] = [(row[0], columns("\t".join(x for x in row[1:] if x))) for row in rows]
    stages = [x for x in lines if x[0]]
    return _build_block(stages, [x for x in lines if not x[0]], name)


def named_columns(folder: Path, name: str, allowed: Sequence[str]) -> dict[str, list[str]]:
    """Read the columns of a CSV file by its header. Raises InputError for a header that is not
    allowed."""
    rows = csv_rows(folder, name)
    header = [cell.lower() for cell in rows[0]] if rows else []
    unknown = [cell for cell in header if cell not in allowed]
    if not header or unknown:
        problem = f"begins with a line of names, of these: {', '.join(allowed)}"
        raise InputError(name, unknown[0] if unknown else "", problem)
    return {
        key: [plain(row[k]) if k < len(row) else "" for row in rows[1:]]
        for k, key in enumerate(header)
    }


def one_column(text: str) -> Iterator[str]:
    """Yield all numbers of a text, line by line."""
    for line in text.splitlines():
        yield from columns(line)
