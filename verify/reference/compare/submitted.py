"""Somebody's table of numbers → the rows that the reference data have, too.

Only what is compared is kept, so that memory does not grow with the file (see
`verify.reference.compare.table`).
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from pathlib import Path

from verify.errors import NOT_GIVEN, InputError
from verify.kernels.step.tangent_map import nearest_double
from verify.reference.compare.published import KEYS, Published, PublishedRun
from verify.reference.compare.rows import (
    COUNTED,
    Row,
    Theirs,
    cells_of,
    number_of,
    places_of,
    printable,
    step_of,
)
from verify.reference.compare.table import Table, opened
from verify.reference.make.columns import orbit_columns, state_columns

_MOST_KNOWN = 10_000  # of the inputs' texts that are remembered
_BEGINS = "t0"  # of an H in time; a scene has one, so that it need not be told
VALUES = (*state_columns(1), *orbit_columns(1))
COLUMNS = ("scene", *KEYS, _BEGINS, *COUNTED, *VALUES)


def read(
    path: Path, ours: Published, given: Mapping[str, str], names: Mapping[str, str]
) -> Theirs[PublishedRun]:
    """The table's rows that `ours` has.

    `given`: what holds for all rows, by column: scene, and `KEYS`. `names`: what the table calls a
    column, by ours. InputError where it cannot be read, or does not tell which run a row is of.
    """
    found = Theirs[PublishedRun]()
    with opened(path) as lines:
        places = places_of(lines, names, COLUMNS, VALUES, found)
        keys = _Keys(ours, given, places, lines)
        texts = [(name, places[name]) for name in VALUES if name in places]
        for row in lines:
            found.rows += 1
            run = keys.run_of(cells_of(lines, row))
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
        return step_of(self.lines, row, self.places, run.t0 or Fraction(0), run.run.step_size)

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
        return number_of(self.lines, text, name)


def _option(name: str) -> str:
    return {"q0": "q", "p0": "p"}.get(name, name).replace("_", "-")
