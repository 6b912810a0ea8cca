"""What one step keeps: a structure, named or by its formula, exactly; or with `defect_order = k`
but for O(h^k).

A structure is `area`, `symplectic`, `volume`, `energy`, `momentum`, `angular-momentum`,
`reversible`, `symmetric`, `conformal`, `poisson`, or the formula of a first integral such as
`q1*p2 - q2*p1`. The claim may be about equations without an H, `field = "u_dot = …; v_dot = …"`. It
is refused, before anything is judged, if the exact flow does not keep the structure. With `every`
it is claimed for every H whose flow keeps it.
"""

from typing import TYPE_CHECKING, Literal

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.claims.base_claim import Findings
from verify.claims.formula_claims import condition_text, step_map_of
from verify.claims.orders import Order
from verify.claims.quantified_claims import FamilyClaim
from verify.errors import InputError
from verify.prose import prose
from verify.scenes.keeps_section import Refinements, name_keys, read_claims
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.structures.reading import KeepsRequest

if TYPE_CHECKING:
    from verify.proof.structures.structures_proof import StructuresProof


class KeepsClaim(FamilyClaim, Refinements):
    """One step keeps a structure, exactly or to an order."""

    of_fields = True
    obstacle = "what is kept is claimed of its own system"

    kind: Literal["keeps"]
    keeps: str
    """The structure: its name, or the formula of a first integral."""
    defect_order: Order | None = None
    """The defect of one step is O(h^k) with this k; left out, it is 0."""
    degrees: int | None = None
    """With `every`, the degrees of freedom; 1 where it is left out."""

    def check_scene(self, scene: Scene) -> None:
        if self.degrees is not None:
            raise InputError("degrees", self.degrees, "goes with `every`")
        read_claims(self._request, scene.exact_hamiltonian())

    def check_every(self) -> None:
        from verify.proof.structures.structures_for_every_h import read_for_every_h

        super().check_every()
        try:
            read_for_every_h(self._request, self.degrees or 1, self.in_time)
        except InputError as error:
            raise name_keys(error) from None

    @property
    def _request(self) -> KeepsRequest:
        order = "" if self.defect_order is None else f": {self.defect_order}"
        return self.request(self.keeps + order)

    def judge_one(self, findings: Findings) -> ClaimResult:
        from verify.proof.structures.structures_proof import prove_structures

        system = findings.scene_of(self).exact_hamiltonian()
        step_map = step_map_of(system, self.scheme)
        claims = read_claims(self._request, system)
        return self._result(prove_structures(step_map, claims, get(self.scheme)), step_map.domain)

    def judge_family(self) -> ClaimResult:
        from verify.proof.structures.structures_for_every_h import prove_structures_for_every_h

        proof = prove_structures_for_every_h(
            self.scheme,
            self._request,
            self.of_separable,
            timed=self.in_time,
            degrees=self.degrees or 1,
        )
        return self._result(proof, EVERYWHERE)

    def _result(self, proof: "StructuresProof", domain: FormulaDomain) -> ClaimResult:
        for each in proof.keeps:
            domain &= each.domain
        evidence = prose(proof.reason, condition_text(domain))
        return self.result(proof.verdict, evidence, domain=domain)


CLAIM = KeepsClaim
