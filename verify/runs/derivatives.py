"""Bounds of a step map's derivatives over a box of states, by interval arithmetic."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

from verify.algebra.enclosure import Enclosures
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.rounding import Ball
from verify.kernels.step.computation import step_map_of
from verify.schemes.composition import in_stages, unfolded
from verify.schemes.step_map import StepMap, Substep, h_inside

import flint  # isort: skip

_STATE = ("p", "q")
_MOST_TERMS, _MOST_OF_DELTA_J = 150, 5000  # of a map that is written out, and of its ΔJ


@dataclass(frozen=True)
class Derivatives:
    """p' and q' and their second derivatives; the gradient of ΔJ by the powers of h in `powers`."""

    values: Enclosures
    gradients: Enclosures
    powers: tuple[int, ...]

    @classmethod
    @lru_cache(maxsize=64)
    def of(cls, hamiltonian: Hamiltonian, scheme: str) -> "Derivatives | None":
        """None for a scheme that does not take this H, or is given by equations for it."""
        try:
            step_map = step_map_of(hamiltonian, scheme)
        except InputError:
            return None
        if step_map.implicit:
            return None
        step = _whole(step_map)
        ring, diff = step.ring, step.ring.diff
        values = (step.p_next, step.q_next)
        hessians = [diff(diff(x, a), b) for x in values for a in _STATE for b in _STATE]
        delta_j = ring.zero if step_map.preserves_area else step.delta_j
        whole = h_inside(ring, delta_j)
        parts = {0: delta_j} if whole else ring.powers(delta_j, "h")
        gradients = [diff(parts[n], a) for n in sorted(parts) for a in _STATE]
        found = Enclosures(ring, [*values, *hessians]), Enclosures(ring, gradients)
        return cls(*found, tuple(sorted(parts)))

    def second(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """B with ‖Φ(z + e) − Φ(z) − DΦ(z) e‖ ≤ ½ B ‖e‖² in the box.

        Not finite where Φ may be undefined in it: derivatives may be defined beyond, as those of
        log are on the other side of 0.
        """
        found = self.values.over({**fixed, **box})
        return flint.arb.nan() if found is None else norm(found[len(_STATE) :])

    def gradient(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """A bound of ‖∇ΔJ‖ in the box."""
        found = self.gradients.over({**fixed, **box})
        if found is None:
            return flint.arb.nan()
        total = flint.arb(0)
        for k, n in enumerate(self.powers):
            total += fixed["h"] ** n * norm(found[2 * k : 2 * k + 2])
        return total


def _whole(step_map: StepMap) -> Substep:
    """The whole map as one substep, written out where that is short; see `StepMap.whole`.

    A map in stages of a polynomial H is written out without sympy, which takes a hundred times as
    long.
    """
    step = step_map.substeps[0]
    elements = step.p_next, step.q_next
    if len(step_map.substeps) > 1 or not step.staged or not in_stages(step.ring, elements):
        return step_map.whole
    found = unfolded(step.ring, elements, _MOST_TERMS)
    closed = Substep(step.field, found[0], found[1]) if found else None
    return closed if closed and closed.terms_of_delta_j <= _MOST_OF_DELTA_J else step


def norm(values: Iterable[Ball]) -> Ball:
    """A bound of Euclid's norm."""
    return sum((x.abs_upper() ** 2 for x in values), flint.arb(0)).sqrt().abs_upper()
