"""The defect of a structure that has accumulated over the N steps of a run.

N steps are one map: of z_0, z_N, the product M of the Jacobians and c^N a structure makes its
defect, MᵀΩ(z_N)M − c^N Ω(z_0), as of those of one step. In a run it is named by a text, such as
`density = 1/(u*v)`, `form = 2*dv^dx`, `factor = exp(-h); form = dv^dx`, `poisson = 0, u; -u, 0`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, reduce
from typing import Protocol

import flint

from verify.algebra.embedding import embed
from verify.algebra.enclosure import Ball, Enclosures, power_of
from verify.arithmetic.arb import UNKNOWN, rational_ball
from verify.errors import InputError
from verify.lazy_sympy import sympy
from verify.structures.reading import KeepsRequest, System, read_structures
from verify.structures.structure import Structure

_KEY = re.compile(r"(?:^|;)\s*(form|density|poisson|factor)\s*=")


@dataclass(frozen=True)
class RunValues:
    """The values of N steps as of one, in balls: `StepValues` of a run.

    `start`, `end`: balls of z_0 and z_N, and of the times if the system depends on t; `jacobian`:
    the product of the Jacobians, or for volume any matrix of its determinant.
    """

    names: tuple[str, ...]
    start: Mapping[str, Ball]
    end: Mapping[str, Ball]
    jacobian: Sequence[Sequence[Ball]]
    step_size: Ball
    steps: int

    def number(self, x: Fraction) -> Ball:
        """Return a constant."""
        return rational_ball(x)

    def before(self, formula: sympy.Expr) -> Ball:
        """Return a formula's value at z_0; not finite if it may be undefined there."""
        return _enclose(formula, self.start)

    def after(self, formula: sympy.Expr) -> Ball:
        """Return a formula's value at z_N."""
        return _enclose(formula, self.end)

    def factor(self, formula: sympy.Expr) -> Ball:
        """Return the product of a factor of one step over the steps."""
        return power_of(_enclose(formula, {"h": self.step_size}), self.steps)

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> Sequence[Ball]:
        """Raise NotImplementedError: the way back is another run."""
        raise NotImplementedError


class RunSystem(System, Protocol):
    """A system whose parameters have values."""

    @property
    def value_substitutions(self) -> Mapping[sympy.Symbol, sympy.Expr]: ...


def accumulate(structure: Structure, steps: RunValues) -> Ball:
    """Return the accumulated defect, of several components the greatest absolute value."""
    first, *others = structure.total_defect(steps)
    largest: Ball = reduce(flint.arb.max, map(abs, others), abs(first)) if others else first
    return largest


def _enclose(formula: sympy.Expr, box: Mapping[str, Ball]) -> Ball:
    balls = _enclosures(formula, tuple(box)).enclose_over(box)
    return balls[0] if balls else UNKNOWN


@lru_cache(maxsize=256)
def _enclosures(formula: sympy.Expr, names: tuple[str, ...]) -> Enclosures:
    return Enclosures(*embed([formula], names))


@lru_cache(maxsize=64)
def read_accumulated(text: str, system: RunSystem) -> Structure:
    """Return the structure of a text, with the values of the system's parameters.

    Raises InputError, one line, for a bad one.
    """
    _, *parts = _KEY.split(text)
    pairs = dict(zip(parts[::2], map(str.strip, parts[1::2]), strict=True))
    try:
        claims = read_structures(KeepsRequest(**pairs), system)  # type: ignore[arg-type]
    except InputError as error:
        raise type(error)("accumulated_defect", text, error.problem.replace("--", "")) from None
    if len(claims) != 1 or 2 * len(pairs) != len(parts):
        problem = "is none; write form = …, density = …, poisson = … or factor = …"
        raise InputError("accumulated_defect", text, problem)
    structure = claims[0].structure.with_values(system.value_substitutions)
    if mistake := structure.mistake(system.coordinates):
        raise InputError("accumulated_defect", text, mistake)
    return structure
