"""Somebody's table of numbers: the rows of it that the reference data have, too.

Its columns are those of the reference data's runs, in the plane or in n degrees of freedom. Only
what is compared is kept, so that memory does not grow with the file.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

from verify.arithmetic.systems.float64 import nearest_double
from verify.errors import NOT_GIVEN, InputError, unknown_name, without_controls
from verify.reference.compare.published_data import Inputs, Published, PublishedRun
from verify.reference.make.file_contents import CellLines, open_table
from verify.structures import AREA, SYMPLECTIC

_MOST_KNOWN = 10_000  # of the inputs' texts that are remembered
_BEGINS = "t0"  # of an H in time; a scene has one, so that it need not be told
_SAME_NUMBER = Fraction(1, 10**6)  # of a step, by which N·h may miss a time
_WHOLE = re.compile(r"[0-9]{1,40}")
_SHOWN = 60  # characters of a text
_COUNTED = ("step", "time")
_ALIASES = {
    "step": ("n", "k", "i", "index", "steps"),
    "time": ("t",),
    "step_size": ("h", "dt"),
    "delta_j": ("Δj", "dj", "deltaj", "delta-j"),
    "lambda": ("λ", "lam"),
}
_OF_SEVERAL = re.compile(r"[pq][1-9][0-9]?")


@dataclass(frozen=True)
class SubmittedRow:
    """A row of the table: its line, and the texts of its values."""

    line: int
    cells: dict[str, str]


@dataclass
class SubmittedTable:
    """The part of a table that is in the reference data. `rows`: of the table; `runs`: by run and
    step.

    `other_steps`: rows of runs that the reference data have, though not at that step. `outside`:
    rows of other runs, of which `first_outside` is one.
    `ignored`: columns that mean nothing here. `read_as`: inputs that are not written exactly as
    in the data, though they are the same double: the table's, the data's.
    """

    columns: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    rows: int = 0
    other_steps: int = 0
    outside: int = 0
    first_outside: str = ""
    runs: dict[str, tuple[PublishedRun, dict[int, SubmittedRow]]] = field(default_factory=dict)
    read_as: dict[str, tuple[Fraction, Fraction]] = field(default_factory=dict)

    def keep(self, run: PublishedRun, step: int, row: SubmittedRow, lines: CellLines) -> None:
        """Add a row; InputError if another one of this step differs."""
        rows = self.runs.setdefault(run.label, (run, {}))[1]
        before = rows.setdefault(step, row)
        if before.cells != row.cells:
            raise lines.error(f"says of step {step} of {run.label} other than line {before.line}")

    def all_rows(self) -> list[SubmittedRow]:
        """Return all rows of all runs. Raises InputError if there is none."""
        if not self.runs:
            steps = f"{self.other_steps} rows of other steps" if self.other_steps else "no rows"
            raise InputError("table", self.first_outside or steps, "has no row of these data")
        return [row for _, rows in self.runs.values() for row in rows.values()]


def has_degrees(path: Path, names: Mapping[str, str]) -> bool:
    """Return True if a table has a column p1, q1, …, or one is said to stand for such a column."""
    with open_table(path) as lines:
        return any(_OF_SEVERAL.fullmatch(x) for x in (*lines.header, *names))


def read(
    path: Path, published: Published, options: Mapping[str, str], names: Mapping[str, str]
) -> SubmittedTable:
    """Return the table's rows that `published` has.

    `options`: what holds for all rows, by column: the scene, and the inputs, of which q0 and p0 may
    be lists. `names`: what the table calls a column, by our name. Raises InputError if the table
    cannot be read, or does not tell which run a row belongs to.
    """
    table = SubmittedTable()
    with open_table(path) as lines:
        places = _place_columns(lines, names, published, table)
        keys = _Keys(published, _split_lists(options, published), places, lines)
        texts = [(name, places[name]) for name in table.columns]
        for row in lines:
            table.rows += 1
            run = keys.run_of(row)
            step = run and keys.step_of(row, run)
            if run is None:
                table.outside += 1
                if table.outside == 1:
                    table.first_outside = f"line {lines.line}: {keys.describe(row)}"
                continue
            if step not in run.rows:
                table.other_steps += 1
                continue
            table.keep(
                run,
                step,
                SubmittedRow(lines.line, {name: row[index] for name, index in texts}),
                lines,
            )
        table.read_as = keys.read_as
    return table


def _split_lists(options: Mapping[str, str], published: Published) -> dict[str, str]:
    """Return the options by the data's columns: lists of q and p are split at their commas."""
    columns: dict[str, str] = {}
    for name, text in options.items():
        if name in ("q0", "p0") and name not in published.keys:
            columns |= {f"{name}_{k}": x.strip() for k, x in enumerate(text.split(","), start=1)}
        else:
            columns[name] = text
    return columns


def _place_columns(
    lines: CellLines, names: Mapping[str, str], published: Published, table: SubmittedTable
) -> dict[str, int]:
    """Return the place of each published column; note in `table` which are compared or ignored.

    `names`: what the table calls a column, by our name.
    """
    values = published.columns
    published_names = ("scene", *published.keys, _BEGINS, *_COUNTED, *values)
    published_by_name = {alias: name for name, aliases in _ALIASES.items() for alias in aliases}
    published_by_name |= {name: name for name in published_names}
    for name, column_name in names.items():
        if name not in published_names:
            raise unknown_name("--column", name, published_names)
        if column_name not in lines.header:
            has = ", ".join(lines.header)
            raise InputError("--column", column_name, f"is no column of the table; it has: {has}")
    renamed = {column_name: name for name, column_name in names.items()}
    places: dict[str, int] = {}
    ignored = []
    for index, head in enumerate(lines.header):
        column = renamed.get(head) or published_by_name.get(head.casefold())
        means_nothing = column not in published_names or (
            column in renamed.values() and head not in renamed
        )
        if column is None or means_nothing:
            ignored.append(_printable(head))
        elif column in places:
            raise lines.error(f"has two columns for {column}; --column {column}=… says which")
        else:
            places[column] = index
    if not any(name in places for name in values):
        raise lines.error(
            f"names no column of {', '.join(values)}; it has {_join_names(lines.header)}"
        )
    if not any(name in places for name in _COUNTED):
        raise lines.error(f"names no column step or time; it has {_join_names(lines.header)}")
    table.columns = tuple(name for name in values if name in places)
    table.ignored = tuple(ignored)
    return places


def _printable(text: str) -> str:
    """Return a text of a file as it may be shown: short, and without control characters."""
    short = text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
    return without_controls(short)


def _join_names(names: tuple[str, ...]) -> str:
    return ", ".join(names[:12]) + (", …" if len(names) > 12 else "")


class _Keys:
    """The columns and options that tell which run and which step a row belongs to."""

    def __init__(
        self,
        published: Published,
        options: Mapping[str, str],
        places: Mapping[str, int],
        lines: CellLines,
    ) -> None:
        self.published, self.options, self.places, self.lines = published, options, places, lines
        self.read_as: dict[str, tuple[Fraction, Fraction]] = {}
        for name in options:
            if name in places:
                raise InputError(
                    f"--{_option_for(name)}", options[name], "is a column of the table, too"
                )
        if "scene" in options:
            published.scene(
                options["scene"]
            )  # a misspelt one has no rows, and is the reason for none
        self.key_names = tuple(n for n in ("scene", *published.keys, _BEGINS) if n in places)
        self.key_places = tuple(places[name] for name in self.key_names)
        self._run_of_texts = lru_cache(_MOST_KNOWN)(lambda texts: self._find(self._inputs(texts)))

    def describe(self, row: list[str]) -> str:
        """Return the inputs of a row's run, by options and by its cells."""
        inputs = self._inputs(row[index] for index in self.key_places)
        return ", ".join(f"{name} = {_printable(text)}" for name, text in inputs.items())

    def run_of(self, row: list[str]) -> PublishedRun | None:
        """Return the run that a row belongs to; None if the reference data have no such run."""
        return self._run_of_texts(tuple([row[index] for index in self.key_places]))

    def _inputs(self, texts: Iterable[str]) -> dict[str, str]:
        pairs = zip(self.key_names, texts, strict=True)
        return {**self.options, **{name: text.strip() for name, text in pairs}}

    def step_of(self, row: list[str], run: PublishedRun) -> int | None:
        """Return the number of steps of a row; None if its time is no multiple of the step
        size."""
        if "step" in self.places:
            text = row[self.places["step"]]
            if _WHOLE.fullmatch(text):
                return int(text)
            count = self.lines.number(text, "step")  # 1e3 and 1000.0 are whole numbers, too
            if count.denominator != 1:
                raise self.lines.error(f"has the step {text[:40]!r}, which is not a whole number")
            return int(count)
        # A program adds up t ← t + h and prints few digits, so a time may miss N h by a small part
        # of a step.
        time = self.lines.number(row[self.places["time"]], "time")
        count = (time - (run.t0 or 0)) / run.exact["step_size"]
        near = round(count)
        return near if abs(count - near) <= _SAME_NUMBER * max(1, abs(near)) else None

    def _find(self, inputs: dict[str, str]) -> PublishedRun | None:
        """Return the run of these inputs, or of the same doubles if these identify one."""
        texts = {name: inputs[name] for name in self.published.keys if name in inputs}
        texts |= {name: x for name, x in inputs.items() if name not in ("scene", _BEGINS)}
        exact = {name: self.lines.number(x, name) for name, x in texts.items() if name != "scheme"}
        doubles: Inputs = {**texts, **{name: nearest_double(x) for name, x in exact.items()}}
        scene = inputs.get("scene") or self._scene(doubles)
        if scene is None:
            return None
        # A user's 0.1 may be the decimal or its double: both identify the same run.
        fitting = self.published.fitting(scene, doubles)
        for name in self.published.keys:
            if name not in texts:
                self._check_left(name, scene, fitting)
        if len(fitting) > 1:
            fitting = [x for x in fitting if exact.items() <= x.exact.items()]
        if not fitting or not self._begins(fitting[0], inputs):
            return None
        run = fitting[0]
        for name, number in exact.items():
            if run.exact[name] != number:
                self.read_as[name] = number, run.exact[name]
        return run

    def _check_left(self, name: str, scene: str, fitting: Sequence[PublishedRun]) -> None:
        """Raise InputError if an input is missing and the scene has several values of it; in
        n degrees of freedom, where the runs that fit have several."""
        values = self.published.values_of(scene, name)
        choices = {AREA: values, SYMPLECTIC: {x.texts.get(name) for x in fitting}}
        if len(choices[self.published.structure]) > 1:
            has = f"{scene} has: {', '.join(values[:8])}"
            problem = f"is wanted, as no column of {self.lines.name} is {name}; {has}"
            raise InputError(f"--{_option_for(name)}", NOT_GIVEN, problem)

    def _begins(self, run: PublishedRun, inputs: Mapping[str, str]) -> bool:
        """Return True if the run begins at the given time, if one is given and H depends on
        time."""
        if run.t0 is None or _BEGINS not in inputs:
            return True
        return nearest_double(self.lines.number(inputs[_BEGINS], _BEGINS)) == nearest_double(run.t0)

    def _scene(self, inputs: Inputs) -> str | None:
        """Return the one scene that has such runs; InputError if several have."""
        scenes = sorted(self.published.by_scene)
        if len(scenes) == 1:
            return scenes[0]
        matching = [scene for scene in scenes if self.published.fitting(scene, inputs)]
        if len(matching) > 1:
            names = ", ".join(matching)
            raise InputError(
                "--scene", NOT_GIVEN, f"is wanted: {len(matching)} have such runs: {names}"
            )
        return matching[0] if matching else None


def _option_for(name: str) -> str:
    """Return the name of the option that sets an input of all rows."""
    return name[0] if name.startswith(("q0", "p0")) else name.replace("_", "-")
