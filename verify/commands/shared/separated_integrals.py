"""What `verify separate --keeps` adds: the parts of the change of first integrals."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.output import pick, print_line
from verify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from fractions import Fraction

    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.measured_structures import MeasuredStructure
    from verify.scenes.results.integral_parts import IntegralParts
    from verify.structures.reading import KeepsRequest


def integrals_of(
    hamiltonian: "Hamiltonian", keeps: "KeepsRequest"
) -> "Sequence[MeasuredStructure]":
    """Return the first integrals that are named. Raises InputError for anything else."""
    from verify.observables import find
    from verify.scenes.measured_structures import measured_structures

    measured = measured_structures(hamiltonian, keeps) if keeps else ()
    for structure in measured:
        observable = find(structure.at_end)
        if observable is None or not observable.integral:
            problem = "is split without it, or not at all; here it names first integrals"
            raise InputError("--keeps", structure.structure, problem)
    return measured


def split_changes(
    hamiltonian: "Hamiltonian", scheme: str, integrals: "Sequence[MeasuredStructure]",
    step_counts: "Sequence[tuple[Fraction, int]]", options: "Mapping[str, Any]",
) -> "list[tuple[MeasuredStructure, IntegralParts]]":  # fmt: skip
    """Return the parts of each integral's change for each step size, with its number of steps."""
    from verify.arithmetic.exact import rational
    from verify.hamiltonians.run_domain import point_of
    from verify.runs.run_start import Start
    from verify.studies.separation.integral_parts import separate_change

    point, t0 = point_of(hamiltonian, options["q"], options["p"]), rational(options["t0"], "t0")
    starts = [(Start(hamiltonian, scheme, h, point, t0), steps) for h, steps in step_counts]
    precision = {name: options[name] for name in ("digits", "arithmetic")}
    return [
        (structure, separate_change(start, steps, structure.at_end, **precision))
        for start, steps in starts
        for structure in integrals
    ]


def change_json(structure: "MeasuredStructure", parts: "IntegralParts") -> dict[str, Any]:
    """Return the keys of the parts of one integral's change."""
    from verify.scenes.results.integral_parts import PARTS

    texts = {name: parts.values[name].value if parts.values else None for name in PARTS}
    return {
        **pick(structure, "structure", "label"),
        **pick(parts, "step_size", "steps", "status"),
        **{name: texts.pop(name) for name in ("working", "truncation")},
        "rounding": texts,
        "error_bound": {name: x.bound for name, x in parts.values.items()},
        "error_kind": parts.error_kind if parts.values else None,
    }


def print_change(structure: "MeasuredStructure", parts: "IntegralParts") -> None:
    """Print the parts of one integral's change."""
    click.echo(f"{structure.label}, h = {parts.step_size}, {parts.steps} steps: {parts.status}")
    labels = {"total": "rounding"} | {n: f"  {n}" for n in ("input", "trajectory", "evaluation")}
    for name in ("working", "truncation", *labels):
        if name in parts.values:
            print_line(labels.get(name, name), str(parts.values[name]))
