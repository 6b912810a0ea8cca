"""Bounds of a step map's derivatives over a box of states, by interval arithmetic."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from verify.enclosure import enclose_over
from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.ring import Poly, Ring
from verify.rounding import Ball
from verify.schemes import get
from verify.step_map import h_inside

import flint  # isort: skip

_STATE = ("p", "q")


@dataclass(frozen=True)
class Derivatives:
    """(p', q') and their second derivatives, and the gradient of ΔJ by powers of h."""

    ring: Ring
    values: tuple[Poly, ...]
    hessians: tuple[tuple[Poly, ...], ...]
    gradients: tuple[tuple[int, tuple[Poly, ...]], ...]

    @classmethod
    def of(cls, hamiltonian: Hamiltonian, scheme: str) -> "Derivatives | None":
        """None for a scheme that does not take this H, or is given by equations for it."""
        return _derivatives(hamiltonian, scheme)

    def second(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """B with ‖Φ(z + e) − Φ(z) − DΦ(z) e‖ ≤ ½ B ‖e‖² in the box.

        Not finite where Φ may be undefined in it: derivatives may be defined beyond, as those of
        log are on the other side of 0.
        """
        if not _norm(self.ring, self.values, {**fixed, **box}).is_finite():
            return flint.arb.nan()
        entries = [x for hessian in self.hessians for x in hessian]
        return _norm(self.ring, entries, {**fixed, **box})

    def gradient(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """A bound of ‖∇ΔJ‖ in the box."""
        total = flint.arb(0)
        for n, gradient in self.gradients:
            size = _norm(self.ring, gradient, {**fixed, **box})
            total += fixed["h"] ** n * size
        return total


@lru_cache(maxsize=64)
def _derivatives(hamiltonian: Hamiltonian, scheme: str) -> Derivatives | None:
    try:
        step_map = get(scheme).step_map(hamiltonian)
    except InputError:
        return None
    if step_map.solved:
        return None
    step = step_map.whole
    ring, diff = step.ring, step.ring.diff
    hessians = tuple(
        tuple(diff(diff(x, a), b) for a in _STATE for b in _STATE)
        for x in (step.p_next, step.q_next)
    )
    delta_j = ring.zero if step_map.preserves_area else step.delta_j
    whole = h_inside(ring, delta_j)
    parts = {0: delta_j} if whole else ring.powers(delta_j, "h")
    gradients = tuple((n, tuple(diff(x, a) for a in _STATE)) for n, x in sorted(parts.items()))
    return Derivatives(ring, (step.p_next, step.q_next), hessians, gradients)


def _norm(ring: Ring, entries: Sequence[Poly], point: Mapping[str, Ball]) -> Ball:
    total, known = flint.arb(0), dict[int, Ball]()
    for x in entries:
        value = enclose_over(ring, x, point, known)
        if value is None:
            return flint.arb.nan()
        size = value.abs_upper()
        total += size * size
    return total.sqrt().abs_upper()
