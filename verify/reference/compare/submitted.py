"""Somebody's table of numbers → the rows that the reference data have, too.

Only what is compared is kept, so that memory does not grow with the file (see
`verify.reference.compare.table`).
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from verify.arithmetic.exact import rational
from verify.errors import NOT_GIVEN, InputError, unknown, without_controls
from verify.kernels.step.tangent_map import nearest_double
from verify.reference.compare.published import KEYS, Published, PublishedRun
from verify.reference.compare.table import Table, opened
from verify.reference.make.models import VALUES

_SHOWN = 60  # characters of a text
_MOST_KNOWN = 10_000  # of the inputs' texts that are remembered
_SAME_NUMBER = Fraction(1, 10**6)  # of a step, by which N·h may miss a time
_ALIASES = {
    "step": ("n", "k", "i", "index", "steps"),
    "time": ("t",),
    "step_size": ("h", "dt"),
    "delta_j": ("Δj", "dj", "deltaj", "delta-j"),
    "lambda": ("λ", "lam"),
}
_COUNTED = ("step", "time")
_WHOLE = re.compile(r"[0-9]{1,40}")
_BEGINS = "t0"  # of an H in time; a scene has one, so that it need not be told
COLUMNS = ("scene", *KEYS, _BEGINS, *_COUNTED, *VALUES)


@dataclass(frozen=True)
class Row:
    """A row of theirs: where it stands, and the texts of its values."""

    line: int
    cells: dict[str, str]


@dataclass
class Theirs:
    """What of a table is in the reference data. `rows`: of the table; `runs`: by run and step.

    `other_steps`: rows of runs that the reference data have, though not at that step. `outside`:
    rows of other runs, of which `first_outside` is one.
    `ignored`: columns that mean nothing here. `read_as`: inputs that are not written exactly as
    ours are, though they are the same double: theirs, ours.
    """

    columns: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    rows: int = 0
    other_steps: int = 0
    outside: int = 0
    first_outside: str = ""
    runs: dict[str, tuple[PublishedRun, dict[int, Row]]] = field(default_factory=dict)
    read_as: dict[str, tuple[Fraction, Fraction]] = field(default_factory=dict)


def read(path: Path, ours: Published, given: Mapping[str, str], names: Mapping[str, str]) -> Theirs:
    """The table's rows that `ours` has.

    `given`: what holds for all rows, by column: scene, and `KEYS`. `names`: what the table calls a
    column, by ours. InputError where it cannot be read, or does not tell which run a row is of.
    """
    found = Theirs()
    with opened(path) as lines:
        places = _header(lines, names, found)
        keys = _Keys(ours, given, places, lines)
        texts = [(name, places[name]) for name in VALUES if name in places]
        for row in lines:
            found.rows += 1
            if len(row) < lines.width:
                raise lines.error(f"has {len(row)} cells, and the header {lines.width}")
            run = keys.run_of(row)
            step = run and keys.step_of(row, run)
            if run is None:
                found.outside += 1
                if found.outside == 1:
                    found.first_outside = f"line {lines.line}: {keys.describe(row)}"
                continue
            if step not in run.rows:
                found.other_steps += 1
                continue
            _keep(found, run, step, Row(lines.line, {name: row[at] for name, at in texts}), lines)
        found.read_as = keys.read_as
    return found


def _keep(found: Theirs, run: PublishedRun, step: int, row: Row, lines: Table) -> None:
    rows = found.runs.setdefault(run.label, (run, {}))[1]
    before = rows.setdefault(step, row)
    if before.cells != row.cells:
        raise lines.error(f"says of step {step} of {run.label} other than line {before.line}")


def _header(lines: Table, names: Mapping[str, str], found: Theirs) -> dict[str, int]:
    """Where each known column stands."""
    known = {alias: name for name, aliases in _ALIASES.items() for alias in aliases}
    known |= {name: name for name in COLUMNS}
    for name, theirs in names.items():
        if name not in COLUMNS:
            raise unknown("--column", name, COLUMNS)
        if theirs not in lines.header:
            has = ", ".join(lines.header)
            raise InputError("--column", theirs, f"is no column of the table; it has: {has}")
    own = {theirs: name for name, theirs in names.items()}
    places: dict[str, int] = {}
    ignored = []
    for at, head in enumerate(lines.header):
        column = own.get(head) or known.get(head.casefold())
        if column is None or (column in own.values() and head not in own):
            ignored.append(printable(head))
        elif column in places:
            raise lines.error(f"has two columns for {column}; --column {column}=… says which")
        else:
            places[column] = at
    if not any(name in places for name in VALUES):
        raise lines.error(f"names no column of {', '.join(VALUES)}; it has {_listed(lines.header)}")
    if not any(name in places for name in _COUNTED):
        raise lines.error(f"names no column step or time; it has {_listed(lines.header)}")
    found.columns = tuple(name for name in VALUES if name in places)
    found.ignored = tuple(ignored)
    return places


def printable(text: str) -> str:
    """A text of a file as it may be shown: short, and without control characters."""
    short = text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
    return without_controls(short)


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(names[:12]) + (", …" if len(names) > 12 else "")


class _Keys:
    """Which run and which step a row is of."""

    def __init__(
        self, ours: Published, given: Mapping[str, str], places: Mapping[str, int], lines: Table
    ) -> None:
        self.ours, self.given, self.places, self.lines = ours, given, places, lines
        self.read_as: dict[str, tuple[Fraction, Fraction]] = {}
        for name in given:
            if name in places:
                raise InputError(f"--{_option(name)}", given[name], "is a column of the table, too")
        self.named = tuple(n for n in ("scene", *KEYS, _BEGINS) if n in places)
        self.at = tuple(places[name] for name in self.named)
        self._known: dict[tuple[str, ...], PublishedRun | None] = {}

    def describe(self, row: list[str]) -> str:
        """What is said of a row's run, by options and by its cells."""
        said = self._inputs(row[at] for at in self.at)
        return ", ".join(f"{name} = {printable(text)}" for name, text in said.items())

    def run_of(self, row: list[str]) -> PublishedRun | None:
        texts = tuple([row[at] for at in self.at])
        if texts not in self._known:
            if len(self._known) > _MOST_KNOWN:
                self._known.clear()
            self._known[texts] = self._find(self._inputs(texts))
        return self._known[texts]

    def _inputs(self, texts: Iterable[str]) -> dict[str, str]:
        named = zip(self.named, texts, strict=True)
        return {**self.given, **{name: text.strip() for name, text in named}}

    def step_of(self, row: list[str], run: PublishedRun) -> int | None:
        if "step" in self.places:
            text = row[self.places["step"]]
            if _WHOLE.fullmatch(text):
                return int(text)
            count = self._number(text, "step")  # 1e3 and 1000.0 are whole numbers, too
            if count.denominator != 1:
                raise self.lines.error(f"has the step {text[:40]!r}, which is not a whole number")
            return int(count)
        time = self._number(row[self.places["time"]], "time")
        count = (time - (run.t0 or 0)) / rational(run.run.step_size)
        near = round(count)
        return near if abs(count - near) <= _SAME_NUMBER * max(1, abs(near)) else None

    def _find(self, inputs: dict[str, str]) -> PublishedRun | None:
        scene = inputs.get("scene") or self._scene(inputs)
        if scene is None:
            return None
        for name in KEYS:
            if name not in inputs:
                values = self.ours.values_of(scene, name)
                if len(values) > 1:
                    has = f"{scene} has: {', '.join(values[:8])}"
                    wanted = f"is wanted, as no column of {self.lines.name} is {name}; {has}"
                    raise InputError(f"--{_option(name)}", NOT_GIVEN, wanted)
                inputs[name] = values[0]
        exact = tuple(self._number(inputs[n], n) for n in KEYS[1:])
        h, q, p = map(nearest_double, exact)
        run = self.ours.run(scene, (inputs["scheme"], h, q, p), exact)
        if run is not None and run.t0 is not None and _BEGINS in inputs:
            begins = self._number(inputs[_BEGINS], _BEGINS)
            if nearest_double(begins) != nearest_double(run.t0):
                return None
        if run is not None:
            for name, theirs, mine in zip(KEYS[1:], exact, run.exact, strict=True):
                if mine != theirs:
                    self.read_as[name] = theirs, mine
        return run

    def _scene(self, inputs: dict[str, str]) -> str | None:
        """The one scene that has such runs; InputError where several have."""
        every = sorted(self.ours.by_scene)
        if len(every) == 1:
            return every[0]
        known = [name for name in KEYS if name in inputs]

        def fits(run: PublishedRun) -> bool:
            return all(self._is(run, name, inputs[name]) for name in known)

        matching = [scene for scene in every if any(map(fits, self.ours.scene(scene)))]
        if len(matching) > 1:
            names = ", ".join(matching)
            raise InputError(
                "--scene", NOT_GIVEN, f"is wanted: {len(matching)} have such runs: {names}"
            )
        return matching[0] if matching else None

    def _is(self, run: PublishedRun, name: str, text: str) -> bool:
        mine = run.inputs[KEYS.index(name)]
        if name == "scheme":
            return mine == text
        return mine == nearest_double(self._number(text, name))

    def _number(self, text: str, name: str) -> Fraction:
        try:
            return rational(text, name)
        except InputError as error:
            raise self.lines.error(f"has the {name} {text[:40]!r}: {error.problem}") from None


def _option(name: str) -> str:
    return {"q0": "q", "p0": "p"}.get(name, name).replace("_", "-")
