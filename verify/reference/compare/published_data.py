"""The reference data with which others' numbers are compared, found by scene and inputs."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import chain
from pathlib import Path

from pydantic import ValidationError

from verify.arithmetic.exact import rational
from verify.arithmetic.systems.float64 import nearest_double
from verify.errors import InputError, unknown_name
from verify.files import read_bytes
from verify.formats import check_format
from verify.hamiltonians.coordinates import coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of
from verify.reference.compare.setting import numbers_of
from verify.reference.make import models
from verify.reference.make.data_files import MANIFEST, SCHEMAS
from verify.reference.make.file_contents import json_of
from verify.reference.make.orbit_computation import Bounded
from verify.reference.make.row_values import orbit_columns, values_of
from verify.runs.run_start import Start
from verify.scenes.results.reference import OrbitRow, Rounded

_EXPONENT_DIGITS = 6
_NO_DATA_TEXTS = {
    models.DATA_FORMAT: "has no reference data; give a folder that `verify reference make` wrote",
    models.DATA_IN_DEGREES_FORMAT: (
        "has no reference data of p1 … pn, q1 … qn, as the table's columns are"
    ),
}
Inputs = Mapping[str, str | float]  # the scheme, and h and the start to the nearest double


@dataclass(frozen=True)
class PublishedRun:
    """One run of the reference data, in the plane or in n degrees of freedom."""

    scene: str
    hamiltonian: Hamiltonian
    run: models.AnyRun

    @cached_property
    def texts(self) -> dict[str, str]:
        """The texts that identify a run of a scene, by a table's columns.

        They are scheme, step_size, and q0 and p0, or q0_1 … p0_n.
        """
        return {"scheme": self.run.scheme, "step_size": self.run.step_size, **self.run.texts}

    @cached_property
    def exact(self) -> dict[str, Fraction]:
        """The numbers h, q and p at the start."""
        return {name: rational(x) for name, x in self.texts.items() if name != "scheme"}

    @cached_property
    def inputs(self) -> Inputs:
        """The inputs by which a run is found."""
        return {"scheme": self.run.scheme} | {n: nearest_double(x) for n, x in self.exact.items()}

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of its numbers, the state first."""
        degrees = self.hamiltonian.degrees
        return *coordinates_in(degrees), *orbit_columns(degrees)

    @property
    def label(self) -> str:
        """The scene, the scheme and the inputs, in words."""
        return f"{self.scene}: {self.run.label}"

    @cached_property
    def orbit(self) -> Start:
        """The orbit that was run."""
        hamiltonian, run, h = self.hamiltonian, self.run, self.exact["step_size"]
        point = point_of(hamiltonian, run.q, run.p)
        return Start(hamiltonian, run.scheme, h, point, self.t0 or Fraction(0))

    @property
    def t0(self) -> Fraction | None:
        """The time at which it starts, if H depends on time."""
        return None if self.run.begins is None else rational(self.run.begins, "t0")

    @cached_property
    def rows(self) -> dict[int, OrbitRow]:
        """Its rows by step."""
        return {row.step: row for row in self.run.rows}

    def numbers(self, step: int) -> dict[str, Bounded]:
        """Return the numbers of a row, by their columns' names."""
        return numbers_of(self.rows[step], self.hamiltonian.degrees)


class Published:
    """The runs of some scenes, found by their inputs."""

    def __init__(self, runs: Sequence[PublishedRun]) -> None:
        self.by_scene: dict[str, list[PublishedRun]] = defaultdict(list)
        for run in runs:
            self.by_scene[run.scene].append(run)
        widest = max(runs, key=lambda run: run.hamiltonian.degrees)
        self.structure = widest.hamiltonian.structure
        self.keys = tuple(widest.texts)  # the columns that identify a run of a scene
        self.columns = widest.columns

    def scene(self, name: str) -> list[PublishedRun]:
        """Return a scene's runs; InputError for a scene that does not exist."""
        if name not in self.by_scene:
            raise unknown_name("scene", name, sorted(self.by_scene))
        return self.by_scene[name]

    def fitting(self, scene: str, inputs: Inputs) -> list[PublishedRun]:
        """Return the scene's runs that have these inputs."""
        return [x for x in self.by_scene.get(scene, ()) if inputs.items() <= x.inputs.items()]

    def runs(self) -> Iterator[PublishedRun]:
        """Return all runs."""
        return chain.from_iterable(self.by_scene.values())

    def values_of(self, scene: str, key: str) -> list[str]:
        """Return the values that the scene's runs have for one of `keys`, each once."""
        return list(dict.fromkeys(x.texts[key] for x in self.scene(scene) if key in x.texts))


def load(folder: Path, scene: str | None, *, planar: bool = True) -> Published:
    """Load the runs of a folder's scenes in the plane, or of those in n degrees of freedom.

    If the folder has a file of the name `scene`, only that one is read.

    Raises InputError for a folder that does not exist or has no such reference data, and for a file
    of another format, or not as it must be.

    >>> from verify.reference.make.data_folder import PUBLISHED
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
    form = models.DATA_FORMAT if planar else models.DATA_IN_DEGREES_FORMAT
    names = {name for name in names if models.format_at(folder / name) == form}
    runs = [run for name in sorted(names) for run in _read_runs(folder / name, form)]
    if not runs:
        raise InputError("--data", str(folder), _NO_DATA_TEXTS[form])
    return Published(runs)


def _read_runs(path: Path, form: str) -> Iterator[PublishedRun]:
    data, name = _read_data(path, form), path.name
    hamiltonian = Hamiltonian.parse(data.hamiltonian, data.parameters)
    has_start_times = data.time_dependent and all(run.begins is not None for run in data.runs)
    if hamiltonian.time_dependent and not has_start_times:
        problem = "is no reference data: its H depends on t, and its runs have no t0"
        raise InputError("file", name, problem)
    for run in data.runs:
        point_of(hamiltonian, run.q, run.p)
        for row in run.rows:
            for number in values_of(row, hamiltonian.degrees).values():
                _check_exponents(number, name)
        yield PublishedRun(data.name, hamiltonian, run)


def _read_data(path: Path, form: str) -> models.AnyData:
    raw = check_format(json_of(read_bytes(path), path.name), form, path.name)
    try:
        return models.MODELS[form].model_validate(raw)
    except ValidationError as error:
        first_error = error.errors(include_url=False)[0]
        location = ".".join(map(str, first_error["loc"]))
        problem = f"is no reference data: {location}: {first_error['msg']}"
        raise InputError("file", path.name, problem) from None


def _check_exponents(number: Rounded | None, name: str) -> None:
    """Raise InputError for an exponent whose power of ten would fill the memory."""
    for text in (number.value, number.radius) if number else ():
        exponent = text.partition("e")[2].lstrip("+-0")
        # The number is never made a rational before this check.
        if len(exponent) > _EXPONENT_DIGITS:
            raise InputError("file", name, f"has the number {text[:40]}, beyond all sizes")
