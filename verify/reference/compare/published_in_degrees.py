"""Reference data in n degrees of freedom → what others' numbers are held against."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path

from pydantic import ValidationError

from verify.arithmetic.exact import rational
from verify.errors import InputError, unknown
from verify.files import opened, read_bytes
from verify.formats import check_format
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import point_of
from verify.kernels.step.tangent_map import nearest_double
from verify.reference.make.columns import values_of
from verify.reference.make.models_in_degrees import (
    DATA_IN_DEGREES_FORMAT,
    DataInDegrees,
    RunInDegrees,
    is_of_degrees,
)
from verify.reference.make.reading import json_of
from verify.scenes.results.reference import Rounded
from verify.scenes.results.reference_in_degrees import OrbitPointInDegrees

_HEAD = 200  # bytes of a file
_EXPONENT_DIGITS = 6
Bounded = tuple[Fraction, Fraction]  # a value and its radius


@dataclass(frozen=True, eq=False)
class RunOfDegrees:
    """One run of the reference data."""

    scene: str
    hamiltonian: Hamiltonian
    run: RunInDegrees

    @property
    def label(self) -> str:
        """Scene, scheme and inputs, in words."""
        return f"{self.scene}: {self.run.label}"

    @cached_property
    def rows(self) -> dict[int, OrbitPointInDegrees]:
        """Its rows by step."""
        return {row.step: row for row in self.run.rows}

    @cached_property
    def inputs(self) -> dict[str, str]:
        """Each column that tells the run, as the tables have it: scheme, step_size, q0_1 …"""
        found = {"scheme": self.run.scheme, "step_size": self.run.step_size}
        for letter, own in (("q", self.run.q), ("p", self.run.p)):
            found |= {f"{letter}0_{k}": x for k, x in enumerate(own, start=1)}
        return found | ({} if self.run.t0 is None else {"t0": self.run.t0})

    def fits(self, given: dict[str, str | float]) -> bool:
        """Whether its inputs are those; a number is that where it is the same double."""
        mine = self.inputs
        return all(
            name in mine
            and (mine[name] == x if name == "scheme" else nearest_double(Fraction(mine[name])) == x)
            for name, x in given.items()
        )

    def numbers(self, step: int) -> dict[str, Bounded]:
        """Those of a row, by their columns' names."""
        degrees = self.hamiltonian.degrees
        known = values_of(self.rows[step], degrees).items()
        return {name: (Fraction(x.value), Fraction(x.radius)) for name, x in known if x}


def check_exponents(known: Rounded | None, name: str) -> None:
    """InputError for an exponent whose power of ten would fill the memory."""
    for text in (known.value, known.radius) if known else ():
        exponent = text.partition("e")[2].lstrip("+-0")
        if len(exponent) > _EXPONENT_DIGITS:
            raise InputError("file", name, f"has the number {text[:40]}, beyond all sizes")


def is_file_of_degrees(path: Path) -> bool:
    """Whether a file's format is that of data in n degrees of freedom."""
    try:
        with opened(path) as file:
            return is_of_degrees(file.read(_HEAD))
    except InputError:  # whoever reads it says so
        return False


def load_in_degrees(folder: Path, scene: str | None) -> list[RunOfDegrees]:
    """The runs of a folder's scenes in n degrees of freedom, or of that one.

    InputError for a folder that has none, and for a file that is not as it must be.
    """
    found = [run for path in sorted(folder.glob("*.json")) if is_file_of_degrees(path)
             for run in _runs(path)]  # fmt: skip
    names = sorted({run.scene for run in found})
    if not found:
        problem = "has no reference data of p1 … pn, q1 … qn, as the table's columns are"
        raise InputError("--data", str(folder), problem)
    if scene is not None and scene not in names:
        raise unknown("scene", scene, names)
    return [run for run in found if scene in (None, run.scene)]


def _runs(path: Path) -> Iterator[RunOfDegrees]:
    raw = check_format(json_of(read_bytes(path), path.name), DATA_IN_DEGREES_FORMAT, path.name)
    try:
        data = DataInDegrees.model_validate(raw)
    except ValidationError as error:
        told = error.errors(include_url=False)[0]
        where = ".".join(map(str, told["loc"]))
        problem = f"is no reference data: {where}: {told['msg']}"
        raise InputError("file", path.name, problem) from None
    hamiltonian = Hamiltonian.parse(data.hamiltonian, data.parameters)
    for run in data.runs:
        point_of(hamiltonian, run.q, run.p)
        for text in (run.step_size, run.t0 or "0"):
            rational(text, path.name)
        for row in run.rows:
            for known in values_of(row, hamiltonian.degrees).values():
                check_exponents(known, path.name)
        yield RunOfDegrees(data.name, hamiltonian, run)
