"""Whether the leading term of a user's proved step telescopes."""

from verify.integrators.results import Finding
from verify.proof.potential import Potential, potential_of
from verify.schemes.scheme import Scheme


def potential_of_finding(found: Finding) -> Potential:
    """As of a scheme that is known by its proof alone."""
    proof = found.proof
    if proof is None:
        if found.area_preserving and found.how == "proof":
            return Potential(True, "ΔJ ≡ 0")
        return Potential(None, "the leading coefficient is not proved")
    alone = Scheme(
        name="step",
        order=1,
        area_preserving=False,
        explicit=False,
        symmetric=False,
        source="the user's function",
        build=lambda _: proof.step_map,
    )
    return potential_of(proof, alone)
