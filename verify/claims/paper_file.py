"""A paper as a claims file describes it beside its claims.

`about` lines describe the paper at the head of a report, and `[[left_out]]` tables name, with
`what` and `why`, the parts of it that no claim covers. `verify.scenes.paper_sections` has the
others: `[[assumption]]`, `[[cause]]` and `[[figure]]`.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from verify.claims.base_claim import Claim
from verify.errors import NOT_GIVEN, InputError
from verify.prose import read_prose
from verify.scenes.model_mistakes import describe_first_error
from verify.scenes.paper_sections import Assumption, Cause, PaperFigure
from verify.scenes.scene import Scene
from verify.scenes.toml_file import Lines, tables_of

TABLES = ("about", "left_out", "assumption", "cause", "figure")


@dataclass
class PaperFile:
    """The sayings of a file on its paper.

    `about`: the first lines of a report; `left_out`: what is not claimed, and why.
    """

    name: str
    title: str
    lines: Lines = field(default_factory=lambda: Lines({}))
    about: tuple[str, ...] = ()
    left_out: tuple[tuple[str, str], ...] = ()
    assumptions: list[Assumption] = field(default_factory=list)
    causes: list[Cause] = field(default_factory=list)
    figures: list[PaperFigure] = field(default_factory=list)

    def add_tables(
        self, data: Mapping[str, Any], claims: Sequence[Claim], scene: Callable[[str], Scene]
    ) -> None:
        """Add all that is said beside the claims. InputError names the line and the problem."""
        ids = {claim.id for claim in claims}
        statements = {claim.reading_of for claim in claims if claim.reading_of}
        self.about = self.texts("about", data.get("about", []))
        self.left_out = self._left_out(data.get("left_out", []))
        for table, place in self._tables(data, "assumption"):
            with errors_located_at(place):
                assumption = Assumption.model_validate(_with_prose(table, "says", "silence"))
                assumption.check(ids)
                self.assumptions.append(assumption)
        for table, place in self._tables(data, "cause"):
            with errors_located_at(place):
                cause = Cause.model_validate(_with_prose(table, "says", "disfavours", "origin"))
                cause.check(statements, ids)
                self.causes.append(cause)
        for table, place in self._tables(data, "figure"):
            with errors_located_at(place):
                figure = PaperFigure.model_validate(table)
                if figure.label in {other.label for other in self.figures}:
                    raise InputError("label", figure.label, "stands twice")
                figure.check(scene(figure.scene), ids)
                self.figures.append(figure)

    def _tables(self, data: Mapping[str, Any], key: str) -> Iterator[tuple[Any, str]]:
        """Yield the tables of that key, each with its place in the file."""
        for index, table in enumerate(tables_of(self.name, key, data.get(key, []))):
            yield table, f"{self.name}:{self.lines.line_of(key, index)}: {key}"

    def texts(self, key: str, value: Any) -> tuple[str, ...]:
        """Check a list of texts that stands under a top-level key of the file."""
        if not isinstance(value, list) or not all(isinstance(text, str) for text in value):
            line = self.lines.line_of("", 0, key)
            raise InputError(f"{self.name}:{line}: {key}", value, "is not a list of texts")
        return tuple(value)

    def _left_out(self, tables: Any) -> tuple[tuple[str, str], ...]:
        """Return what is not claimed, each with the reason."""
        for index, table in enumerate(tables_of(self.name, "left_out", tables)):
            if not isinstance(table, dict) or set(table) != {"what", "why"}:
                line = self.lines.line_of("left_out", index)
                problem = "has `what` and `why`, both"
                raise InputError(f"{self.name}:{line}: left_out", table, problem)
        return tuple((str(table["what"]), str(table["why"])) for table in tables)


def _with_prose(table: Any, required: str, *optional: str) -> dict[str, Any]:
    """Return the table with the formulas in these sentences marked.

    Raises InputError if the required sentence is missing, or if one is no text.
    """
    problem = "is a sentence; none stands here"
    if not isinstance(table, dict) or not table.get(required):
        raise InputError(required, NOT_GIVEN, problem)
    sentences = {}
    for key in (key for key in (required, *optional) if key in table):
        if not isinstance(table[key], str):
            raise InputError(key, table[key], problem)
        sentences[key] = read_prose(table[key])
    return {**table, **sentences}


@contextmanager
def errors_located_at(place: str) -> Iterator[None]:
    """Add the place in the file to the errors raised inside."""
    try:
        yield
    except ValidationError as error:
        raise describe_first_error(error, place) from None
    except InputError as error:
        raise InputError(f"{place}: {error.name}", error.value, error.problem) from None
