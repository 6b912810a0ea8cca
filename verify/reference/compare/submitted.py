"""Somebody's table of numbers → the rows that the reference data have, too.

Its columns are those of the reference data's runs, in the plane or in n degrees of freedom. Only
what is compared is kept, so that memory does not grow with the file (see
`verify.reference.compare.rows`).
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

from verify.arithmetic.systems.float64 import nearest_double
from verify.errors import NOT_GIVEN, InputError, unknown, without_controls
from verify.reference.compare.published import Inputs, Published, PublishedRun
from verify.reference.compare.rows import Row, Table, Theirs, opened
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


def has_degrees(path: Path, names: Mapping[str, str]) -> bool:
    """Whether a table has a column p1, q1, …, or is said to call one so."""
    with opened(path) as lines:
        return any(_OF_SEVERAL.fullmatch(x) for x in (*lines.header, *names))


def read(path: Path, ours: Published, given: Mapping[str, str], names: Mapping[str, str]) -> Theirs:
    """The table's rows that `ours` has.

    `given`: what holds for all rows, by column: scene, and the inputs, of which q0 and p0 may be
    lists. `names`: what the table calls a column, by ours. InputError where it cannot be read, or
    does not tell which run a row is of.
    """
    found = Theirs()
    with opened(path) as lines:
        places = _places(lines, names, ours, found)
        keys = _Keys(ours, _each(given, ours), places, lines)
        texts = [(name, places[name]) for name in found.columns]
        for row in lines:
            found.rows += 1
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
            found.keep(run, step, Row(lines.line, {name: row[at] for name, at in texts}), lines)
        found.read_as = keys.read_as
    return found


def _each(given: Mapping[str, str], ours: Published) -> dict[str, str]:
    """The options by the data's columns: lists of q and p part at their commas."""
    parted: dict[str, str] = {}
    for name, text in given.items():
        if name in ("q0", "p0") and name not in ours.keys:
            parted |= {f"{name}_{k}": x.strip() for k, x in enumerate(text.split(","), start=1)}
        else:
            parted[name] = text
    return parted


def _places(
    lines: Table, names: Mapping[str, str], ours: Published, found: Theirs
) -> dict[str, int]:
    """Where each column of ours stands; `names`: what the table calls a column, by ours. `found`
    gets those that are compared, and those that mean nothing."""
    known, values = ("scene", *ours.keys, _BEGINS, *_COUNTED, *ours.columns), ours.columns
    own_names = {alias: name for name, aliases in _ALIASES.items() for alias in aliases}
    own_names |= {name: name for name in known}
    for name, theirs in names.items():
        if name not in known:
            raise unknown("--column", name, known)
        if theirs not in lines.header:
            has = ", ".join(lines.header)
            raise InputError("--column", theirs, f"is no column of the table; it has: {has}")
    own = {theirs: name for name, theirs in names.items()}
    places: dict[str, int] = {}
    ignored = []
    for at, head in enumerate(lines.header):
        column = own.get(head) or own_names.get(head.casefold())
        means_nothing = column not in known or (column in own.values() and head not in own)
        if column is None or means_nothing:
            ignored.append(_printable(head))
        elif column in places:
            raise lines.error(f"has two columns for {column}; --column {column}=… says which")
        else:
            places[column] = at
    if not any(name in places for name in values):
        raise lines.error(f"names no column of {', '.join(values)}; it has {_listed(lines.header)}")
    if not any(name in places for name in _COUNTED):
        raise lines.error(f"names no column step or time; it has {_listed(lines.header)}")
    found.columns = tuple(name for name in values if name in places)
    found.ignored = tuple(ignored)
    return places


def _printable(text: str) -> str:
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
        if "scene" in given:
            ours.scene(given["scene"])  # a misspelt one has no rows, and is the reason for none
        self.named = tuple(n for n in ("scene", *ours.keys, _BEGINS) if n in places)
        self.at = tuple(places[name] for name in self.named)
        self._known = lru_cache(_MOST_KNOWN)(lambda texts: self._find(self._inputs(texts)))

    def describe(self, row: list[str]) -> str:
        """What is said of a row's run, by options and by its cells."""
        said = self._inputs(row[at] for at in self.at)
        return ", ".join(f"{name} = {_printable(text)}" for name, text in said.items())

    def run_of(self, row: list[str]) -> PublishedRun | None:
        return self._known(tuple([row[at] for at in self.at]))

    def _inputs(self, texts: Iterable[str]) -> dict[str, str]:
        named = zip(self.named, texts, strict=True)
        return {**self.given, **{name: text.strip() for name, text in named}}

    def step_of(self, row: list[str], run: PublishedRun) -> int | None:
        """How many steps a row is of; None where its time is no multiple of the step size."""
        if "step" in self.places:
            text = row[self.places["step"]]
            if _WHOLE.fullmatch(text):
                return int(text)
            count = self.lines.number(text, "step")  # 1e3 and 1000.0 are whole numbers, too
            if count.denominator != 1:
                raise self.lines.error(f"has the step {text[:40]!r}, which is not a whole number")
            return int(count)
        time = self.lines.number(row[self.places["time"]], "time")
        count = (time - (run.t0 or 0)) / run.exact["step_size"]
        near = round(count)
        return near if abs(count - near) <= _SAME_NUMBER * max(1, abs(near)) else None

    def _find(self, inputs: dict[str, str]) -> PublishedRun | None:
        """The run of these inputs, or of the same doubles where these tell one."""
        told = {name: inputs[name] for name in self.ours.keys if name in inputs}
        told |= {name: x for name, x in inputs.items() if name not in ("scene", _BEGINS)}
        exact = {name: self.lines.number(x, name) for name, x in told.items() if name != "scheme"}
        doubles: Inputs = {**told, **{name: nearest_double(x) for name, x in exact.items()}}
        scene = inputs.get("scene") or self._scene(doubles)
        if scene is None:
            return None
        fitting = self.ours.fitting(scene, doubles)
        for name in self.ours.keys:
            if name not in told:
                self._check_left(name, scene, fitting)
        if len(fitting) > 1:
            fitting = [x for x in fitting if exact.items() <= x.exact.items()]
        if not fitting or not self._begins(fitting[0], inputs):
            return None
        run = fitting[0]
        for name, theirs in exact.items():
            if run.exact[name] != theirs:
                self.read_as[name] = theirs, run.exact[name]
        return run

    def _check_left(self, name: str, scene: str, fitting: Sequence[PublishedRun]) -> None:
        """InputError where an input is not told and the scene has several; in n degrees of freedom,
        where the runs that fit have."""
        values = self.ours.values_of(scene, name)
        left = {AREA: values, SYMPLECTIC: {x.texts.get(name) for x in fitting}}
        if len(left[self.ours.structure]) > 1:
            has = f"{scene} has: {', '.join(values[:8])}"
            wanted = f"is wanted, as no column of {self.lines.name} is {name}; {has}"
            raise InputError(f"--{_option(name)}", NOT_GIVEN, wanted)

    def _begins(self, run: PublishedRun, inputs: Mapping[str, str]) -> bool:
        """Whether it begins at the time that is told, if one is and H depends on time."""
        if run.t0 is None or _BEGINS not in inputs:
            return True
        return nearest_double(self.lines.number(inputs[_BEGINS], _BEGINS)) == nearest_double(run.t0)

    def _scene(self, inputs: Inputs) -> str | None:
        """The one scene that has such runs; InputError where several have."""
        every = sorted(self.ours.by_scene)
        if len(every) == 1:
            return every[0]
        matching = [scene for scene in every if self.ours.fitting(scene, inputs)]
        if len(matching) > 1:
            names = ", ".join(matching)
            raise InputError(
                "--scene", NOT_GIVEN, f"is wanted: {len(matching)} have such runs: {names}"
            )
        return matching[0] if matching else None


def _option(name: str) -> str:
    """What says one of the inputs of all rows."""
    return name[0] if name.startswith(("q0", "p0")) else name.replace("_", "-")
