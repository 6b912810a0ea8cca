"""No scheme's own claim is refuted: its order of convergence, and det J ≡ 1 where it claims that.

Its ΔJ then has at least one order more than the scheme, as the exact flow has det J = 1.
"""

from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.verdict import Verdict


def holds(sample: Sample) -> None:
    """Check the orders of the map and of S, which in the plane is ΔJ·Ω."""
    only_if(sample.ordinary)
    proof, scheme = sample.proof, sample.scheme
    if proof.verdict is Verdict.REFUTED:
        raise Violation(f"{scheme.name} is refuted: {proof.reason}")
    only_if(proof.verdict is not Verdict.UNDECIDED)
    if proof.convergence_order is not None and proof.convergence_order < scheme.order:
        raise Violation(f"{scheme.name} is proved, and has order {proof.convergence_order}")
    if proof.order is not None and proof.order <= scheme.order:
        raise Violation(f"{scheme.name} has order {scheme.order}, and its S {proof.order}")
    volume = proof.volume_order
    if volume is not None and proof.order is not None and volume < proof.order:
        raise Violation(f"S has order {proof.order}, and det J − 1 {volume}")
