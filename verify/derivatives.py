"""Bounds of a step map's derivatives over a box of states, by interval arithmetic."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from verify.enclosure import enclose_over
from verify.hamiltonian import Hamiltonian
from verify.ring import Poly, Ring
from verify.rounding import Ball
from verify.schemes import get
from verify.step_map import h_inside

import flint  # isort: skip

_STATE = ("p", "q")


@dataclass(frozen=True)
class Derivatives:
    """Second derivatives of (p', q'), and ΔJ by powers of h with its gradient."""

    ring: Ring
    hessians: tuple[tuple[Poly, ...], ...]
    gradients: tuple[tuple[int, tuple[Poly, ...]], ...]

    @classmethod
    def of(cls, hamiltonian: Hamiltonian, scheme: str) -> "Derivatives":
        return _derivatives(hamiltonian, scheme)

    def second(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """B with ‖Φ(z + e) − Φ(z) − DΦ(z) e‖ ≤ ½ B ‖e‖² in the box."""
        entries = [x for hessian in self.hessians for x in hessian]
        return _norm(self.ring, entries, {**fixed, **box})

    def gradient(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball], power: int) -> Ball:
        """A bound of ‖∇(ΔJ/h^power)‖ in the box."""
        total = flint.arb(0)
        for n, gradient in self.gradients:
            size = _norm(self.ring, gradient, {**fixed, **box})
            total += fixed["h"] ** (n - power) * size
        return total


@lru_cache(maxsize=64)
def _derivatives(hamiltonian: Hamiltonian, scheme: str) -> Derivatives:
    step = get(scheme).step_map(hamiltonian).flat
    ring, diff = step.ring, step.ring.diff
    hessians = tuple(
        tuple(diff(diff(x, a), b) for a in _STATE for b in _STATE)
        for x in (step.p_next, step.q_next)
    )
    whole = h_inside(ring, step.delta_j)
    parts = {0: step.delta_j} if whole else ring.powers(step.delta_j, "h")
    gradients = tuple((n, tuple(diff(x, a) for a in _STATE)) for n, x in sorted(parts.items()))
    return Derivatives(ring, hessians, gradients)


def _norm(ring: Ring, entries: Sequence[Poly], point: Mapping[str, Ball]) -> Ball:
    total = flint.arb(0)
    for x in entries:
        value = enclose_over(ring, x, point)
        if value is None:
            return flint.arb.nan()
        size = value.abs_upper()
        total += size * size
    return total.sqrt().abs_upper()
