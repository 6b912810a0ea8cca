"""The findings of a check: one place in the files, what should stand there, and what does."""

from dataclasses import asdict, dataclass, field

from verify.errors import without_controls

_MOST_SHOWN = 120


@dataclass(frozen=True)
class Difference:
    """A place in a file where `found` stands and the check expects `wanted`."""

    file: str
    row: str
    column: str
    wanted: str
    found: str

    def __str__(self) -> str:
        where = ": ".join(filter(None, map(without_controls, (self.file, self.row, self.column))))
        return f"{where}: should be {_short(self.wanted)}, is {_short(self.found)}"

    def as_json(self) -> dict[str, str]:
        """Return the same for JSON, with marks for bytes in a file's name that are not UTF-8."""
        return {k: v.encode(errors="replace").decode() for k, v in asdict(self).items()}


def _short(text: str) -> str:
    shown = text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}…"
    return without_controls(shown) or "nothing"


@dataclass
class DataFindings:
    """The findings of a check: the number of rows `recomputed`, the differences, and what could not
    be recomputed, with the reason."""

    recomputed: int = 0
    differences: list[Difference] = field(default_factory=list)
    not_recomputed: list[str] = field(default_factory=list)

    def add(self, other: "DataFindings") -> None:
        """Add the findings of another check to these."""
        self.recomputed += other.recomputed
        self.differences += other.differences
        self.not_recomputed += other.not_recomputed


@dataclass(frozen=True)
class DataPlace:
    """A file, or a row of it; differences in it are added to `findings`."""

    findings: DataFindings
    file: str
    row: str = ""

    def at_row(self, row: str) -> "DataPlace":
        """Return the place of a row of the file."""
        return DataPlace(self.findings, self.file, row)

    def require(self, right: object, column: str, expected: str, actual: str) -> None:
        """Add a difference unless `right` is true."""
        if not right:
            self.differs(column, expected, actual)

    def differs(self, column: str, expected: str, actual: str) -> None:
        """Add a difference."""
        self.findings.differences.append(Difference(self.file, self.row, column, expected, actual))

    def is_left_out(self, why: object) -> None:
        """Note that the row is not recomputed, and why."""
        self.findings.not_recomputed.append(f"{self.file}: {self.row}: {why}")
