"""What a check finds: one place in the files, what should stand there, and what does."""

from dataclasses import asdict, dataclass, field

from verify.errors import without_controls

_MOST_SHOWN = 120


@dataclass(frozen=True)
class Difference:
    """`wanted` is what the check has, `found` what stands in the file."""

    file: str
    row: str
    column: str
    wanted: str
    found: str

    def __str__(self) -> str:
        where = ": ".join(filter(None, map(without_controls, (self.file, self.row, self.column))))
        return f"{where}: should be {_short(self.wanted)}, is {_short(self.found)}"

    def as_json(self) -> dict[str, str]:
        """The same for JSON, with marks for what in a file's name is no UTF-8."""
        return {k: v.encode(errors="replace").decode() for k, v in asdict(self).items()}


def _short(text: str) -> str:
    shown = text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}…"
    return without_controls(shown) or "nothing"


@dataclass
class Findings:
    """What was found: rows `recomputed`, differences, what could not be recomputed, and why."""

    recomputed: int = 0
    differences: list[Difference] = field(default_factory=list)
    not_recomputed: list[str] = field(default_factory=list)

    def add(self, other: "Findings") -> None:
        """Takes up what another one found."""
        self.recomputed += other.recomputed
        self.differences += other.differences
        self.not_recomputed += other.not_recomputed


@dataclass(frozen=True)
class Place:
    """A file, or a row of it; what is found there is taken up among the findings."""

    findings: Findings
    file: str
    row: str = ""

    def at(self, row: str) -> "Place":
        """A row of the file."""
        return Place(self.findings, self.file, row)

    def must(self, right: object, column: str, wanted: str, found: str) -> None:
        """Takes up a difference unless it is right."""
        if not right:
            self.differs(column, wanted, found)

    def differs(self, column: str, wanted: str, found: str) -> None:
        """Takes up a difference."""
        self.findings.differences.append(Difference(self.file, self.row, column, wanted, found))

    def is_left_out(self, why: object) -> None:
        """Takes up that the row is not recomputed."""
        self.findings.not_recomputed.append(f"{self.file}: {self.row}: {why}")
