"""Area, the symplectic form of the plane: its defect is one number, ΔJ = det J − 1."""

from verify.structures.structure import Structure

AREA = Structure(
    name="area",
    state="(p, q)",
    defect="ΔJ",
    accumulated="Λ",
    size="|Λ|",
    zero="function",
    vanishes="ΔJ is the zero function: det J ≡ 1",
    identity="ΔJ ≡ 0",
    claim="det J ≡ 1",
    of_step="delta_j_max",
    of_run="lambda",
    over_run="lambda_max",
)
