"""Bounds of a step map's derivatives over a box of states, by interval arithmetic.

In n degrees of freedom z', det J − 1 and the entries of S are differentiated operation by operation
(`verify.kernels.step.program_algebra`), and enclosed over the box.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import flint

from verify.algebra.enclosure import Enclosures
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.rounding import Ball, Rounded, analyse
from verify.kernels.step.computation import Observed, step_map_of
from verify.kernels.step.in_degrees import computed_in_degrees, map_of, with_slopes
from verify.kernels.step.program import Program
from verify.schemes.composition import in_stages, unfolded
from verify.schemes.step_map import StepMap, Substep, h_inside

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


_ZERO = flint.arb(0)


@dataclass(frozen=True)
class DerivativesInDegrees:
    """Indices in `program`: of z' and det J − 1 `values`, of second derivatives of z', and of the
    gradients of det J − 1 and of S's entries, one after the other."""

    program: Program
    parameters: tuple[str, ...]
    values: tuple[int, ...]
    hessians: tuple[int, ...]
    of_volume: tuple[int, ...]
    defect: tuple[int, ...]
    of_defect: tuple[int, ...]

    @classmethod
    @lru_cache(maxsize=32)
    def of(
        cls, hamiltonian: Hamiltonian, scheme: str, *, volume: bool, form: bool
    ) -> "DerivativesInDegrees | None":
        """None for a scheme that does not take this H, or is given by equations for it. `volume`,
        `form`: whether det J and S are looked at; else theirs are 0 and none."""
        try:
            step = map_of(hamiltonian, scheme)
        except InputError:
            return None
        if step.implicit or isinstance(step, StepMap):
            return None
        asked = Observed(
            pipelined=False, scaled=False, delta_j=volume, determinant=False, tangent=False,
            symplectic=form,
        )  # fmt: skip
        made = computed_in_degrees(step, asked)
        program, partials, slopes = with_slopes(made)
        second = [x for row in slopes for at in row for x in partials.gradient(at)]
        defect = tuple(made.defect.values())
        return cls(
            program,
            made.parameters,
            (*(made.outputs[f"d{name}"] for name in made.coordinates), made.outputs["dj"]),
            tuple(second),
            tuple(partials.gradient(made.outputs["dj"])),
            defect,
            tuple(x for at in defect for x in partials.gradient(at)),
        )

    def second(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """B with ‖Φ(z + e) − Φ(z) − DΦ(z) e‖ ≤ ½ B ‖e‖² and ‖DΦ(z + e) − DΦ(z)‖ ≤ B ‖e‖ in the box;
        not finite where Φ may be undefined in it."""
        found = self._over((*self.hessians, *self.values), fixed, box)
        return flint.arb.nan() if found is None else norm(found[: len(self.hessians)])

    def gradient(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """A bound of ‖∇ det J‖ in the box."""
        found = self._over(self.of_volume, fixed, box)
        return flint.arb.nan() if found is None else norm(found)

    def form(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> tuple[Ball, Ball]:
        """Bounds in the box of Frobenius' norm of S, and of that of its gradients."""
        found = self._over((*self.defect, *self.of_defect), fixed, box)
        if found is None:
            return flint.arb.nan(), flint.arb.nan()
        count, twice = len(self.defect), flint.arb(2).sqrt()  # an entry stands in S twice
        return twice * norm(found[:count]), twice * norm(found[count:])

    def _over(
        self, wanted: Sequence[int], fixed: Mapping[str, Ball], box: Mapping[str, Ball]
    ) -> list[Ball] | None:
        parameters = {f"x{k}": fixed[n] for k, n in enumerate(self.parameters)}
        others = {n: x for n, x in fixed.items() if n in ("h", "t")}
        inputs = {n: Rounded(x, _ZERO) for n, x in {**box, **parameters, **others}.items()}
        found = analyse(self.program, self.program.live(wanted), inputs, lambda *_: _ZERO)
        return None if found is None else [found[at].interval for at in wanted]
