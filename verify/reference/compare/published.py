"""Reference data → what others' numbers are held against: each run by its scene and its inputs."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import chain
from pathlib import Path

from pydantic import ValidationError

from verify.arithmetic.exact import rational
from verify.errors import InputError, unknown
from verify.files import read_bytes
from verify.formats import check_format
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.orbit import Orbit
from verify.kernels.step.tangent_map import nearest_double
from verify.reference.compare.published_in_degrees import check_exponents, is_file_of_degrees
from verify.reference.make.columns import values_of
from verify.reference.make.models import DATA_FORMAT, Data, Run
from verify.reference.make.reading import json_of
from verify.reference.make.writing import MANIFEST, SCHEMAS
from verify.scenes.results.reference import OrbitPoint

KEYS = ("scheme", "step_size", "q0", "p0")  # what a run of a scene is told by
Inputs = tuple[str, float, float, float]  # scheme, h, q0, p0: the numbers to the nearest double


@dataclass(frozen=True)
class PublishedRun:
    """One run of the reference data."""

    scene: str
    hamiltonian: Hamiltonian
    run: Run

    @property
    def inputs(self) -> Inputs:
        """What it is found by."""
        h, q, p = map(nearest_double, self.exact)
        return self.run.scheme, h, q, p

    @cached_property
    def exact(self) -> tuple[Fraction, ...]:
        """h, q and p at the start."""
        return tuple(rational(x) for x in (self.run.step_size, self.run.q, self.run.p))

    @property
    def label(self) -> str:
        """Scene, scheme and inputs, in words."""
        return f"{self.scene}: {self.run.label}"

    @cached_property
    def orbit(self) -> Orbit:
        """What was run."""
        h, q, p = self.exact
        return Orbit(self.hamiltonian, self.run.scheme, h, q, p, t0=self.t0 or Fraction(0))

    @property
    def t0(self) -> Fraction | None:
        """When it starts, where H depends on time."""
        return self.run.start.get("t")

    @cached_property
    def rows(self) -> dict[int, OrbitPoint]:
        """Its rows by step."""
        return {row.step: row for row in self.run.rows}


class Published:
    """The runs of some scenes, found by their inputs."""

    def __init__(self, runs: Iterator[PublishedRun]) -> None:
        self.by_scene: dict[str, list[PublishedRun]] = defaultdict(list)
        self._by_inputs: dict[tuple[str, Inputs], list[PublishedRun]] = defaultdict(list)
        for run in runs:
            self.by_scene[run.scene].append(run)
            self._by_inputs[run.scene, run.inputs].append(run)

    def scene(self, name: str) -> list[PublishedRun]:
        """Its runs; InputError for a scene that is not there."""
        if name not in self.by_scene:
            raise unknown("scene", name, sorted(self.by_scene))
        return self.by_scene[name]

    def run(self, scene: str, inputs: Inputs, exact: tuple[Fraction, ...]) -> PublishedRun | None:
        """The scene's run of these inputs, or of the same doubles where these tell one."""
        found = self._by_inputs.get((scene, inputs), [])
        if len(found) == 1:
            return found[0]
        return next((x for x in found if x.exact == exact), None)

    def runs(self) -> Iterator[PublishedRun]:
        """All of them."""
        return chain.from_iterable(self.by_scene.values())

    def values_of(self, scene: str, key: str) -> list[str]:
        """What the scene's runs have for one of `KEYS`, each once."""
        name = {"q0": "q", "p0": "p"}.get(key, key)
        return list(dict.fromkeys(getattr(x.run, name) for x in self.scene(scene)))


def load(folder: Path, scene: str | None) -> Published:
    """The runs of a folder's scenes, or of one where there is a file of that name.

    InputError for a folder that is not there or has no reference data, and for a file that is of
    another format, or not as it must be.

    >>> from verify.reference.make.make import PUBLISHED
    >>> load(PUBLISHED, "duffing").values_of("duffing", "q0")
    ['0.1', '0.5', '1.5', '0']
    """
    if not folder.is_dir():
        raise InputError(
            "--data", str(folder), "is no folder; give one that `verify reference make` wrote"
        )
    names = {path.name for path in folder.glob("*.json")} - {MANIFEST, *SCHEMAS}
    if scene is not None and f"{scene}.json" in names:
        names = {f"{scene}.json"}
    names = {name for name in names if not is_file_of_degrees(folder / name)}
    if not names:
        raise InputError(
            "--data",
            str(folder),
            "has no reference data; give a folder that `verify reference make` wrote",
        )
    return Published(run for name in sorted(names) for run in _runs(folder, name))


def _runs(folder: Path, name: str) -> Iterator[PublishedRun]:
    raw = check_format(json_of(read_bytes(folder / name), name), DATA_FORMAT, name)
    try:
        data = Data.model_validate(raw)
    except ValidationError as error:
        told = error.errors(include_url=False)[0]
        where = ".".join(map(str, told["loc"]))
        raise InputError("file", name, f"is no reference data: {where}: {told['msg']}") from None
    hamiltonian = Hamiltonian.parse(data.hamiltonian, data.parameters)
    if hamiltonian.time_dependent and not data.timed:
        problem = "is no reference data: its H depends on t, and its runs have no t0"
        raise InputError("file", name, problem)
    for run in data.runs:
        _check_exponents(run, name)
        yield PublishedRun(data.name, hamiltonian, run)


def _check_exponents(run: Run, name: str) -> None:
    """InputError for an exponent whose power of ten would fill the memory."""
    for row in run.rows:
        for known in values_of(row, 1).values():
            check_exponents(known, name)
