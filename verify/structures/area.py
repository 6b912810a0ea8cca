"""Area, the symplectic form of the plane: its defect is one number, ΔJ = det J − 1."""

from dataclasses import replace

from verify.structures.symplectic import CanonicalForm

AREA = CanonicalForm(
    name="area",
    label="area",
    state="(p, q)",
    symbol="ΔJ",
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

# Of a system without H: volume in all of its coordinates, which has the same defect.
PLAIN_VOLUME = replace(AREA, name="volume", label="volume", state="z")
