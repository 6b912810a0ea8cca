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
from verify.kernels.step.computation import Observed, computation_of, step_map_of
from verify.kernels.step.partials import Partials
from verify.kernels.step.program import Program
from verify.observables.observable import Need

_ZERO = flint.arb(0)


def norm(values: Iterable[Ball]) -> Ball:
    """Return a bound of the Euclidean norm."""
    return sum((x.abs_upper() ** 2 for x in values), flint.arb(0)).sqrt().abs_upper()


@dataclass(frozen=True)
class Derivatives:
    """Derivatives of a step, by their indices in `program`.

    `values` are z' and det J − 1; `hessians` the second derivatives of z'; `of_volume` and
    `of_defect` the gradients of det J − 1 and of S's entries, one after the other.
    """

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
    def from_scheme(
        cls, hamiltonian: Hamiltonian, scheme: str, *, volume: bool, form: bool
    ) -> "Derivatives | None":
        """Return the derivatives of a scheme's step.

        None for a scheme that does not take this H, or is given by equations for it. `volume`,
        `form`: True if det J and S are needed; otherwise their derivatives are 0 and none.
        """
        try:
            step = step_map_of(hamiltonian, scheme)
        except InputError:
            return None
        # The outputs of an implicit step come from an iteration, whose operations have no
        # derivatives of the exact map.
        if step.implicit:
            return None
        is_needed: dict[Need, bool] = {"delta_j": volume, "symplectic": form}
        needs = frozenset(need for need, needed in is_needed.items() if needed)
        request = Observed(pipelined=False, scaled=False, tangent=False, needs=needs, slopes=True)
        computation = computation_of(step, request)
        program = computation.program.copy()
        # Slopes are the entries of DΦ; their gradients by the coordinates are the second
        # derivatives.
        partials = Partials(
            program, [program.input(n, static=False) for n in computation.coordinates]
        )
        second = [
            x for row in computation.slopes for index in row for x in partials.gradient(index)
        ]
        defect = tuple(computation.defect.values())
        return cls(
            hamiltonian,
            program,
            computation.parameters,
            (
                *(computation.outputs[f"d{name}"] for name in computation.coordinates),
                computation.outputs["dj"],
            ),
            tuple(second),
            tuple(partials.gradient(computation.outputs["dj"])),
            defect,
            tuple(x for index in defect for x in partials.gradient(index)),
        )

    def second(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """Return B with ‖Φ(z + e) − Φ(z) − DΦ(z) e‖ ≤ ½ B ‖e‖² in the box, a bound of ‖D²Φ‖.

        Then ‖DΦ(z + e) − DΦ(z)‖ ≤ B ‖e‖, too. Not finite where Φ may be undefined in the box.
        """
        values = self._enclose((*self.hessians, *self.values), constants, box)
        return flint.arb.nan() if values is None else norm(values[: len(self.hessians)])

    def gradient(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """Return a bound of ‖∇ det J‖ in the box."""
        values = self._enclose(self.of_volume, constants, box)
        return flint.arb.nan() if values is None else norm(values)

    def energy(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """Return a bound of ‖∇H‖ in the box."""
        values = _gradient_of_energy(self.hamiltonian).enclose_over({**constants, **box})
        return flint.arb.nan() if values is None else norm(values)

    def form(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> tuple[Ball, Ball]:
        """Return bounds in the box of the Frobenius norm of S, and of that of its gradients."""
        values = self._enclose((*self.defect, *self.of_defect), constants, box)
        if values is None:
            return flint.arb.nan(), flint.arb.nan()
        count, twice = len(self.defect), flint.arb(2).sqrt()  # an entry stands in S twice
        return twice * norm(values[:count]), twice * norm(values[count:])

    def _enclose(
        self, indices: Sequence[int], constants: Mapping[str, Ball], box: Mapping[str, Ball]
    ) -> list[Ball] | None:
        parameters = {f"x{k}": constants[n] for k, n in enumerate(self.parameters)}
        others = {n: x for n, x in constants.items() if n in ("h", "t")}
        inputs = {n: Rounded(x, _ZERO) for n, x in {**box, **parameters, **others}.items()}
        results = analyse(self.program, self.program.live(indices), inputs, lambda *_: _ZERO)
        return None if results is None else [results[index].interval for index in indices]


@lru_cache(maxsize=32)
def _gradient_of_energy(hamiltonian: Hamiltonian) -> Enclosures:
    field, _ = canonical_field(hamiltonian)
    return Enclosures(field.ring, field.gradient(field.energy))
