"""The order in h of the defect of any structure, for one step map, by exact algebra.

It is asked first whether the exact flow keeps the structure. Then a theorem on the scheme's
coefficients, the series of the step in h, or the step written out, show whether the step does, and
where its defect begins.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.expressions.function_nodes import requirements_of_expression
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import Leading
from verify.proof.order_for_one_h import FIRST_ORDERS, nearby_of_scheme, telescoping_of
from verify.proof.plane.potential import potential_along
from verify.proof.structures.energy_potential import energy_potential
from verify.proof.structures.printed_coefficients import judge_printed, prints_decimals
from verify.proof.structures.structure_leading import leading_of_structure
from verify.proof.structures.structure_theorems import flow_defect
from verify.prose import Prose, prose, read_prose
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures import AREA, SYMPLECTIC, Structure
from verify.structures.first_integral import FirstIntegral
from verify.structures.volume import Volume
from verify.verdict import Verdict


@dataclass(frozen=True)
class StructureProof:
    """A proof on one structure, for one step map.

    `claimed`: the claimed order of the defect; None if it is claimed to vanish. `first`: the
    leading coefficient of the defect, in its component `component`. `telescopes`: True if it is the
    derivative of `potential` along the flow. `domain`: where all of it holds. `example`: in a proof
    for every H the one of `first`.
    """

    structure: Structure
    verdict: Verdict
    reason: Prose
    first: Leading
    component: str = ""
    claimed: int | None = None
    telescopes: bool | None = None
    potential: str | None = None
    domain: FormulaDomain = EVERYWHERE
    example: str = ""

    @property
    def order(self) -> int | None:
        """The power of h at which the defect begins; None if it vanishes or is not decided."""
        return self.first.power if self.first.decision.zero is False else None

    @property
    def is_kept(self) -> bool | None:
        """True if the defect is the zero function; None if that is not decided."""
        return self.first.decision.zero

    @property
    def leading(self) -> str:
        """The leading coefficient as a formula; empty if there is none."""
        return self.first.text if self.order is not None and self.first.element else ""


def check_structure(hamiltonian: Hamiltonian, structure: Structure) -> bool:
    """Return True if it is shown that the exact flow keeps the structure, else False.

    Raises InputError if the formulas make no structure, or one that the flow does not keep.
    """
    label = structure.label
    if mistake := structure.mistake(hamiltonian.coordinates):
        raise InputError("--keeps", label, mistake)
    if isinstance(structure, Volume) and structure.density == 1 and hamiltonian.energy is not None:
        return True  # Liouville's theorem; a large determinant is not expanded
    shown = True
    for name, series in flow_defect(hamiltonian, structure).items():
        ring, slope = series.ring, series.coefficients[1]
        zero = ring.vanishes(slope)
        if zero is False:
            term = f"{name}: {ring.text(slope)}" if name else ring.text(slope)
            what = f"its defect begins with h^1, times {term}"
            raise InputError("--keeps", label, f"is not kept by the exact flow: {what}")
        shown = shown and zero is True
    return shown


def prove_structure(
    step_map: StepMap,
    structure: Structure,
    scheme: Scheme | None = None,
    claimed: int | None = None,
) -> StructureProof:
    """Prove the order of the structure's defect, and judge that it is at least `claimed`.

    Without `claimed` the claim is that the defect vanishes. Raises InputError as `check_structure`.
    """
    hamiltonian = step_map.hamiltonian
    structure = structure.with_values(hamiltonian.value_substitutions)
    of_flow = check_structure(hamiltonian, structure)
    smooth = FormulaDomain.from_requirements(
        r for x in structure.formulas for r in requirements_of_expression(x, smooth=True)
    )
    domain = step_map.domain & smooth
    component, leading = leading_of_structure(step_map, structure, scheme, of_flow)
    leading = leading.restrict_to(domain)
    verdict, reason = _judge(structure, leading, claimed)
    if verdict is Verdict.REFUTED and scheme and prints_decimals(scheme, hamiltonian):
        near = nearby_of_scheme(scheme, hamiltonian) if of_flow else None
        printed = judge_printed(scheme, hamiltonian, structure, claimed, near, leading)
        cause = "; the scheme prints rounded coefficients, which may be the cause"
        verdict, reason = Verdict.UNDECIDED, prose(reason, cause)
        if printed is not None:
            verdict, reason, leading = printed.verdict, printed.reason, printed.leading
    proof = StructureProof(
        structure, verdict, reason, leading, component, claimed, domain=domain & leading.domain
    )
    telescopes, potential = _telescoping(step_map, proof)
    return replace(proof, telescopes=telescopes, potential=potential)


# -- the verdict -----------------------------------------------------------------------------------


def _judge(structure: Structure, leading: Leading, claimed: int | None) -> tuple[Verdict, Prose]:
    formula, power, zero = structure.defect_formula, leading.power, leading.decision.zero
    if zero is True:
        return Verdict.PROVED, read_prose(f"`{formula}` is 0 at every step")
    if zero is False and power is not None:
        holds = claimed is not None and power >= claimed
        begins = read_prose(f"`{formula}` begins with `h^{power}`")
        return (Verdict.PROVED if holds else Verdict.REFUTED), begins
    if zero is False:  # the defect is known as a whole alone, without its first power
        somewhere = f"`{formula}` is not 0; the power of `h` with which it begins is not found"
        return (Verdict.UNDECIDED if claimed else Verdict.REFUTED), read_prose(somewhere)
    if power is None:
        return Verdict.UNDECIDED, read_prose(f"whether `{formula}` is 0 is not decided")
    holds = claimed is not None and power >= claimed
    unknown = f"the coefficients of `{formula}` below `h^{power}` vanish"
    reason = read_prose(unknown if holds else f"{unknown}; whether all do is not decided")
    return (Verdict.PROVED if holds else Verdict.UNDECIDED), reason


# -- telescoping -----------------------------------------------------------------------------------


def _telescoping(step_map: StepMap, proof: StructureProof) -> tuple[bool | None, str | None]:
    """Decide whether the leading coefficient is a derivative along the flow; return its potential.

    It is decided for scalar defects, and for the symplectic form where `telescoping_of` does.
    """
    structure, first = proof.structure, proof.first
    if proof.is_kept:
        return True, "0"
    if structure is SYMPLECTIC:
        telescopes, text = telescoping_of(step_map, FIRST_ORDERS, first)
        return telescopes, text or None
    is_volume = isinstance(structure, Volume) and structure.density == 1
    is_scalar = isinstance(structure, FirstIntegral) or is_volume or structure is AREA
    if proof.order is None or first.element is None or not is_scalar:
        return None, None
    ring, leading = first.element
    flow = step_map.field
    if ring is not flow.ring:
        flow, (leading,) = field_of(step_map.hamiltonian, first.coefficient)
    eta = step_map.flow_up_to
    formula = None
    if structure.name == "energy" and eta % 2 == 0 and isinstance(flow, CanonicalField):
        formula = partial(energy_potential, flow, eta)
    potential = potential_along(flow, leading, formula, proof.domain)
    if potential.holds is None and formula:  # formulas that agree with lieη need not be lieη
        potential = potential_along(flow, leading, domain=proof.domain)
    return potential.holds, potential.text
