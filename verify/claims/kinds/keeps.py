"""What one step keeps: a structure, named or by its formula, exactly; or with `defect_order = k`
but for O(h^k).

A structure is `area`, `symplectic`, `volume`, `energy`, `momentum`, `angular-momentum`,
`reversible`, `symmetric`, `conformal`, `poisson`, or the formula of a first integral such as
`q1*p2 - q2*p1`. The claim may be about equations without an H, `field = "u_dot = …; v_dot = …"`. It
is refused, before anything is judged, if the exact flow does not keep the structure.
"""

from collections.abc import Sequence
from typing import Literal

from verify.claims.base_claim import Claim, Findings
from verify.claims.formula_claims import condition_text, step_map_of
from verify.claims.orders import Order
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import prose
from verify.scenes.keeps_section import Refinements, read_claims
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.structures.reading import ClaimedStructure


class KeepsClaim(Claim, Refinements):
    """One step keeps a structure, exactly or to an order."""

    of_fields = True
    obstacle = "what is kept is claimed of its own system"

    kind: Literal["keeps"]
    keeps: str
    """The structure: its name, or the formula of a first integral."""
    defect_order: Order | None = None
    """The defect of one step is O(h^k) with this k; left out, it is 0."""

    def check_scene(self, scene: Scene) -> None:
        self._read(scene.exact_hamiltonian())

    def _read(self, system: Hamiltonian) -> Sequence[ClaimedStructure]:
        order = "" if self.defect_order is None else f": {self.defect_order}"
        return read_claims(self.request(self.keeps + order), system)

    def judge(self, findings: Findings) -> ClaimResult:
        """Judge by the proof for the scene's system."""
        from verify.proof.structures.structures_proof import prove_structures

        system = findings.scene_of(self).exact_hamiltonian()
        step_map = step_map_of(system, self.scheme)
        proof = prove_structures(step_map, self._read(system), get(self.scheme))
        domain = step_map.domain
        for each in proof.keeps:
            domain &= each.domain
        evidence = prose(proof.reason, condition_text(domain))
        return self.result(proof.verdict, evidence, domain=domain)


CLAIM = KeepsClaim
