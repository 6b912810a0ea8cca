"""The defect of a structure accumulated over all steps, as of N steps that are one map.

Of a form it is MᵀΩ(z_N)M − Ω(z_0), of a bracket M B(z_0) Mᵀ − B(z_N), with the product M of the
Jacobians; of volume (ρ(z_N)/ρ(z_0)) (1 + Λ) − 1. `verify.structures.accumulated` reads the text.
"""

from typing import Any

from verify.observables.observable import Observable, never


def member(text: str) -> Observable:
    """Return the observable of a structure."""
    name = f"accumulated_defect: {text}"
    of_volume: dict[str, Any] = {
        "needs": "delta_j", "lines": lambda loop: loop.product(), "carried": "lam", "shift": 1,
        "growth": 4,
    }  # fmt: skip
    of_matrix: dict[str, Any] = {
        "needs": "matrix", "lines": lambda loop: loop.matrix(), "carried": "m_", "growth": 7,
    }  # fmt: skip
    return Observable(
        name,
        f"accumulated defect, {text}",
        r"\Phi^{N*}T - T",
        order=13,
        structure=text,
        vanishes=never,
        bound=lambda at: at.bound_of_defect(name),
        most_degrees=4,
        **(of_volume if text.startswith("density") else of_matrix),
    )
