"""Bounds of a step map's derivatives over a box of states, by interval arithmetic.

z', det J − 1 and the entries of S are differentiated operation by operation
(`verify.kernels.step.program_algebra`), and enclosed over the box.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import flint

from verify.algebra.enclosure import Enclosures
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.rounding import Ball, Rounded, analyse
from verify.kernels.step.computation import Observed, computed, step_map_of
from verify.kernels.step.partials import Partials
from verify.kernels.step.program import Program
from verify.observables.observable import Need

_ZERO = flint.arb(0)


def norm(values: Iterable[Ball]) -> Ball:
    """A bound of Euclid's norm."""
    return sum((x.abs_upper() ** 2 for x in values), flint.arb(0)).sqrt().abs_upper()


@dataclass(frozen=True)
class Derivatives:
    """Indices in `program`: of z' and det J − 1 `values`, of second derivatives of z', and of the
    gradients of det J − 1 and of S's entries, one after the other."""

    hamiltonian: Hamiltonian
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
    ) -> "Derivatives | None":
        """None for a scheme that does not take this H, or is given by equations for it. `volume`,
        `form`: whether det J and S are looked at; else theirs are 0 and none."""
        try:
            step = step_map_of(hamiltonian, scheme)
        except InputError:
            return None
        if step.implicit:
            return None
        needs: dict[Need, bool] = {"delta_j": volume, "symplectic": form}
        needed = frozenset(need for need, asked in needs.items() if asked)
        asked = Observed(pipelined=False, scaled=False, tangent=False, needs=needed, slopes=True)
        made = computed(step, asked)
        program = made.program.copy()
        partials = Partials(program, [program.input(n, static=False) for n in made.coordinates])
        second = [x for row in made.slopes for at in row for x in partials.gradient(at)]
        defect = tuple(made.defect.values())
        return cls(
            hamiltonian,
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

    def energy(self, fixed: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """A bound of ‖∇H‖ in the box."""
        found = _gradient_of_energy(self.hamiltonian).over({**fixed, **box})
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


@lru_cache(maxsize=32)
def _gradient_of_energy(hamiltonian: Hamiltonian) -> Enclosures:
    field, _ = canonical_field(hamiltonian)
    return Enclosures(field.ring, field.gradient(field.energy))
